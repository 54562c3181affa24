// Loops of set operations are divided only at corners, and at the start of a circle.

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/curve/region.h"

// The starts of the circles of a round.
static CagVec3 seams[8];
static int seam_count;

static CagRegion *disc(void) {
  const double x = uniform(-2, 2), y = uniform(-2, 2), radius = uniform(0.8, 2);
  CagTransform turn, frame;
  CagCurve *c;
  CagRegion *r;
  OK(cag_rotate(cag_vec3(0, 0, 1), uniform(0, 6), cag_vec3(0, 0, 0), &turn, &err));
  const CagTransform move = cag_translate(cag_vec3(x, y, 0));
  frame = cag_transform_multiply(&move, &turn);
  frame.planar = true;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_curve_point(c, c->start, &seams[seam_count++], &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  return r;
}

// A polygon with corners in order around a center.
static CagRegion *polygon(void) {
  enum { MOST = 6 };
  const int n = 3 + (int)uniform(0, MOST - 2.01);
  const double x = uniform(-1.5, 1.5), y = uniform(-1.5, 1.5);
  CagVec3 p[MOST];
  CagCurve *c;
  CagRegion *r;
  for (int i = 0; i < n; i++) {
    const double angle = 2 * M_PI * (i + uniform(-0.3, 0.3)) / n, far = uniform(1, 2.5);
    p[i] = cag_vec3(x + far * cos(angle), y + far * sin(angle), 0);
  }
  OK(cag_curve_polyline(p, (size_t)n, true, 2, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  return r;
}

// Whether the curve has a corner or a seam at two parameters with the same point.
static bool is_corner(const CagCurve *c, double before, double after) {
  CagVec3 in, out, p;
  OK(cag_curve_tangent(c, before, CAG_SIDE_LEFT, &in, &err));
  OK(cag_curve_tangent(c, after, CAG_SIDE_RIGHT, &out, &err));
  OK(cag_curve_point(c, after, &p, &err));
  bool is = cag_norm(cag_sub(out, in)) > 1e-5;
  for (int i = 0; i < seam_count; i++) is |= cag_norm(cag_sub(p, seams[i])) < 1e-9;
  return is;
}

static size_t check_corners(const CagRegion *r) {
  enum { MOST = 100 };
  size_t corners = 0;
  for (size_t k = 0; k < r->count; k++) {
    const CagCurve *c = r->loops[k];
    double at[MOST];
    const size_t n = c->kind->breaks(c, at, MOST);
    assert_true(n <= MOST);
    for (size_t i = 0; i < n; i++) assert_true(is_corner(c, at[i], at[i]));
    assert_true(is_corner(c, c->end, c->start));
    corners += n;
  }
  return corners;
}

static void loops_are_divided_where_they_turn(void **state) {
  (void)state;
  static const CagRegionOp ops[3] = {CAG_REGION_UNION, CAG_REGION_INTERSECTION,
                                     CAG_REGION_DIFFERENCE};
  size_t corners = 0;
  seed = 102;
  for (int round = 0; round < 120; round++) {
    seam_count = 0;
    CagRegion *r = round % 2 ? disc() : polygon();
    for (int k = 0; k < 4; k++) {
      CagRegion *with = uniform(0, 1) < 0.5 ? disc() : polygon(), *result;
      OK(cag_region_boolean(ops[(round / 2 + (k > 2)) % 3], r, with, &result, &err));
      cag_region_release(r);
      cag_region_release(with);
      r = result;
      corners += check_corners(r);
    }
    cag_region_release(r);
  }
  assert_true(corners > 1000);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loops_are_divided_where_they_turn),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
