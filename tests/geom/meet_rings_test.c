// Intersections of surfaces with trimmed surfaces, compared with samples.

#include "tests/geom/ring_support.h"

#include "geom/meet/meet_surface.h"

// Vertical cylinders and planes meet a plane or curved ring in arcs and lines over x and y.
// Compares their number and length with dense samples, and checks that they end on the outlines.
static void rings_are_met_within_their_outlines(void **state) {
  (void)state;
  seed = 6;
  int told = 0, cut = 0;
  for (int round = 0; round < 16; round++) {
    double disk[3], hole[3];
    static const double LOW[] = {1.2, 0.9, 0.6, 1.25, 0.95, 0.2},
                        HIGH[] = {1.4, 1.1, 0.85, 1.35, 1.05, 0.5};
    for (int i = 0; i < 3; i++) disk[i] = uniform(LOW[i], HIGH[i]);
    for (int i = 0; i < 3; i++) hole[i] = uniform(LOW[3 + i], HIGH[3 + i]);
    CagSurface *base = round % 2 ? graph() : NULL, *s = ring(base, disk, hole), *wall;
    // The foot of the wall: an arc or a line.
    const double x = uniform(0.7, 1.9), y = uniform(0.4, 1.6), r = uniform(0.2, 1);
    const bool round_wall = round % 4 < 2;
    CagCurve *foot;
    const CagVec3 a = {x - 2, y - 2 * uniform(-1, 1), 0}, b = {2 * x - a.x, 2 * y - a.y, 0};
    if (round_wall) foot = circle(x, y, r);
    else OK(cag_curve_line(a, b, 3, &foot, &err));
    CagCurve *low;
    const CagTransform down = cag_translate(cag_vec3(0, 0, -2));
    OK(cag_curve_transform(foot, &down, &low, &err));
    OK(cag_surface_extrude(low, cag_vec3(0, 0, 4), 0, 1, &wall, &err));
    // Samples along the foot.
    enum { SAMPLES = 1500 };
    double length = 0, least = INFINITY, before = 0, first = 0;
    int runs = 0;
    CagVec3 last = {0, 0, 0};
    for (int i = 0; i <= SAMPLES; i++) {
      CagVec3 p, q;
      OK(cag_curve_point(foot, foot->start + (foot->end - foot->start) * i / SAMPLES, &p, &err));
      const double in = inside_of(p.x, p.y, disk, hole);
      q = cag_vec3(p.x, p.y, 0);
      if (base && in > -0.02) OK(cag_surface_point(base, p.x, p.y, &q, &err));
      if (i > 0 && in > 0 && before > 0) length += cag_norm(cag_sub(q, last));
      // The fraction of a step inside the outline.
      if (i > 0 && (in > 0) != (before > 0))
        length += cag_norm(cag_sub(q, last)) * fmax(in, before) / fabs(in - before);
      if (i > 0 && in > 0 && before <= 0) runs++;
      if (i == 0) first = in;
      // Skips cases with extrema close to the outline.
      if (i > 0 && fabs(in) < 0.02) least = fmin(least, fabs(in - before) * SAMPLES);
      before = in;
      last = q;
    }
    if (first > 0) runs = runs ? runs : 1;
    if (least > 0.3) {
      CagCurveList list = {0};
      OK(cag_surface_intersect(round % 3 ? s : wall, round % 3 ? wall : s, 0, NULL, &list, &err));
      double found = 0;
      for (size_t i = 0; i < list.count; i++) {
        double one;
        const CagCurve *c = list.items[i];
        OK(cag_curve_length(c, c->start, c->end, &one, &err));
        found += one;
        for (int end = 0; end < 2 && !c->closed; end++) {
          CagVec3 p;
          OK(cag_curve_point(c, end ? c->end : c->start, &p, &err));
          NEAR(inside_of(p.x, p.y, disk, hole), 0, 1e-8);
          cut++;
        }
      }
      if (list.count != (size_t)runs || fabs(found - length) > 2e-3 * length)
        fail_msg("round %d: %zu curves of length %g, not %d of %g", round, list.count, found, runs,
                 length);
      cag_curve_list_free(&list);
      told++;
    }
    cag_surface_release(base);
    cag_surface_release(s);
    cag_surface_release(wall);
    cag_curve_release(foot);
    cag_curve_release(low);
  }
  assert_true(told > 8 && cut > 16);
}

// A circular wall that does not cross the outlines meets the ring in a full circle, or not at all.
static void walls_within_rings_meet_them_in_whole_circles(void **state) {
  (void)state;
  seed = 7;
  for (int round = 0; round < 12; round++) {
    const double disk[3] = {uniform(-1, 1), 0.5, 5}, hole[3] = {1, uniform(-1, 1), 1.5};
    // Around the hole, beside it, inside it, or around everything.
    static const double OF[4][2] = {{2, 3}, {0.5, 1}, {0.3, 1}, {7, 9}};
    const double *of = OF[round % 4], r = uniform(of[0], of[1]);
    const double off = round % 4 == 1 ? 3 : 0, x = hole[0], y = hole[1] + off;
    CagSurface *s = ring(NULL, disk, hole), *wall;
    CagCurve *foot = circle(x, y, r), *low;
    const CagTransform down = cag_translate(cag_vec3(0, 0, -2));
    OK(cag_curve_transform(foot, &down, &low, &err));
    OK(cag_surface_extrude(low, cag_vec3(0, 0, 4), 0, 1, &wall, &err));
    CagCurveList list = {0};
    OK(cag_surface_intersect(round % 3 ? s : wall, round % 3 ? wall : s, 0, NULL, &list, &err));
    assert_int_equal(list.count, round % 4 < 2);
    if (list.count) {
      double length;
      const CagCurve *c = list.items[0];
      assert_true(c->closed);
      OK(cag_curve_length(c, c->start, c->end, &length, &err));
      NEAR(length, 2 * M_PI * r, 1e-4);
    }
    cag_curve_list_free(&list);
    cag_surface_release(s);
    cag_surface_release(wall);
    cag_curve_release(foot);
    cag_curve_release(low);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rings_are_met_within_their_outlines),
      cmocka_unit_test(walls_within_rings_meet_them_in_whole_circles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
