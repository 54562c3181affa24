// Plane sections of trimmed surfaces: lines and circles trimmed by outlines.

#include "tests/geom/polynomial_support.h"

#include "geom/meet/section.h"
#include "geom/surface/trimmed.h"

// A ring around the center, whose outlines trim lines and circles.
static CagSurface *ring_of(const Polynomial *p, double wide, double narrow) {
  const double per[2] = {1, 1}, radius[2] = {wide, narrow};
  const CagTransform stay = cag_transform_identity();
  CagSurface *s = graph(p, per, &stay), *out;
  CagCurve *loops[2];
  CagRegion *region;
  for (int k = 0; k < 2; k++) {
    CagTransform frame = cag_translate(cag_vec3(0.5, 0.5, 0));
    frame.planar = true;
    OK(cag_curve_arc(radius[k], radius[k], 0, 2 * M_PI, &frame, &loops[k], &err));
  }
  OK(cag_region_new(loops[0], &loops[1], 1, &region, &err));
  OK(cag_surface_trimmed(s, region, &out, &err));
  for (int k = 0; k < 2; k++) cag_curve_release(loops[k]);
  cag_region_release(region);
  cag_surface_release(s);
  return out;
}

static double chord(double radius, double off) {
  return off < radius ? 2 * sqrt(radius * radius - off * off) : 0;
}

static void sections_end_on_outlines(void **state) {
  (void)state;
  seed = 64;
  for (int round = 0; round < 12; round++) {
    const double wide = uniform(0.3, 0.49), narrow = uniform(0.05, 0.25);
    const double turn = uniform(0, 6), c = cos(turn), d = sin(turn);
    Polynomial p;
    double length;
    int count, closed = 0;
    if (round % 3 < 2) {
      // A line at some distance from the center, multiplied by the polynomial 1 + x^2 + y^2.
      const double off = uniform(0, 1) * 1.1 * wide;
      if (fabs(off - wide) < 0.01 || fabs(off - narrow) < 0.01) continue;
      p = (Polynomial){{{-c * 0.5 - d * 0.5 - off, d}, {c}}};
      length = chord(wide, off) - chord(narrow, off);
      count = off > wide ? 0 : off > narrow ? 1 : 2;
    } else {
      // A circle that is inside the ring, or crosses one of its outlines.
      const double off = uniform(0, 0.4), r = uniform(0.05, 0.4);
      const double most = off + r, least = fabs(off - r);
      if (fabs(most - wide) < 0.02 || fabs(least - wide) < 0.02 || fabs(most - narrow) < 0.02 ||
          fabs(least - narrow) < 0.02)
        continue;
      p = circle(0.5 + c * off, 0.5 + d * off, r);
      // Half the angle, about the circle's center, of its part inside a disk about the ring's
      // center.
      double within[2];
      for (int k = 0; k < 2; k++) {
        const double disk = k ? narrow : wide;
        within[k] = most < disk ? M_PI
                    : least > disk || off < 0.01
                        ? 0
                        : acos((off * off + r * r - disk * disk) / (2 * off * r));
      }
      length = 2 * r * (within[0] - within[1]);
      const bool cut_wide =
          within[0] > 0 && within[0]<M_PI, cut_narrow = within[1]> 0 && within[1] < M_PI;
      closed = !cut_wide && !cut_narrow && within[0] > within[1];
      count = closed ? 1 : cut_wide && cut_narrow ? 2 : cut_wide || cut_narrow;
    }
    const Polynomial factor = {{{1, 0, 1}, {0}, {1}}};
    p = product(&p, &factor);
    CagSurface *s = ring_of(&p, wide, narrow);
    const CagPlane plane = {{0, 0, 0}, {0, 0, round % 2 ? 1 : -1}};
    CagCurveList list = {0};
    OK(cag_surface_section(s, &plane, 0, &list, &err));
    double found = 0;
    int closed_found = 0;
    for (size_t i = 0; i < list.count; i++) {
      const CagCurve *curve = list.items[i];
      double own;
      OK(cag_curve_length(curve, curve->start, curve->end, &own, &err));
      found += own;
      closed_found += curve->closed;
      for (int k = 0; k <= 20; k++) {
        CagVec3 q;
        OK(cag_curve_point(curve, curve->start + (curve->end - curve->start) * k / 20, &q, &err));
        const double out = hypot(q.x - 0.5, q.y - 0.5);
        assert_true(out < wide + 1e-7 && out > narrow - 1e-7 && fabs(value(&p, q.x, q.y)) < 2e-5);
        if ((k == 0 || k == 20) && !curve->closed)
          NEAR(fmin(fabs(out - wide), fabs(out - narrow)), 0, 1e-9);
      }
    }
    if ((int)list.count != count || closed != closed_found || !(fabs(found - length) < 1e-5))
      fail_msg("round %d: %zu curves of length %g, not %d of %g", round, list.count, found, count,
               length);
    cag_curve_list_free(&list);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(sections_end_on_outlines)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
