// Intersections of lines with trimmed surfaces.

#include "tests/geom/ring_support.h"

// A line meets a ring where it passes its plane or graph inside the outlines.
static void lines_pierce_rings_within_their_outlines(void **state) {
  (void)state;
  seed = 8;
  int pierced = 0, missed = 0;
  for (int round = 0; round < 4; round++) {
    const double disk[3] = {1.1, 0.9, 0.85}, hole[3] = {uniform(0.8, 1.4), uniform(0.6, 1.2), 0.4};
    CagSurface *base = round % 2 ? graph() : NULL, *s = ring(base, disk, hole);
    for (int i = 0; i < (base ? 15 : 40); i++) {
      const double x = uniform(0.1, 2.1), y = uniform(0, 1.9), in = inside_of(x, y, disk, hole);
      if (fabs(in) < 1e-6) continue;
      // Slanted lines may cross a graph twice.
      CagVec3 along = {0, 0, 3}, p = {x, y, 0};
      if (base) OK(cag_surface_point(base, x, y, &p, &err));
      else along = cag_vec3(uniform(-2, 2), uniform(-2, 2), 3);
      const double before = uniform(0.2, 0.8);
      CagCurve *line;
      const CagVec3 from = cag_madd(p, -before, along);
      OK(cag_curve_line(from, cag_add(from, along), 3, &line, &err));
      CagSurfaceMeeting *found;
      size_t n;
      OK(cag_surface_intersect_curve(s, line, &found, &n, &err));
      assert_int_equal(n, in > 0);
      if (n) {
        near_vec(found->point, p, 1e-10);
        NEAR(found->u, x, 1e-9);
        NEAR(found->v, y, 1e-9);
        NEAR(found->t, line->start + before * (line->end - line->start), 1e-9);
        pierced++;
      } else missed++;
      free(found);
      cag_curve_release(line);
    }
    cag_surface_release(base);
    cag_surface_release(s);
  }
  assert_true(pierced > 30 && missed > 30);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(lines_pierce_rings_within_their_outlines)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
