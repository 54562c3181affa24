// Creased surfaces of curved cells that meet a plane sheet: random comparisons with plane sections.

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/meet/meet_surface.h"
#include "geom/meet/section.h"

static double total_length(const CagCurveList *list) {
  double sum = 0, own;
  for (size_t i = 0; i < list->count; i++) {
    const CagCurve *c = list->items[i];
    OK(cag_curve_length(c, c->start, c->end, &own, &err));
    sum += own;
  }
  return sum;
}

// A net of curved cells, one direction of which may be smooth.
static CagSurface *curved_net(int degree_u, int degree_v) {
  const double linear[] = {0, 0, 1, 2, 3, 3};
  const double quadratic[] = {0, 0, 0, 1, 2, 2, 2};
  CagVec3 p[16];
  for (int i = 0; i < 16; i++) {
    const double x = -2 + 4.0 / 3 * (i / 4) + uniform(-0.3, 0.3),
                 y = -2 + 4.0 / 3 * (i % 4) + uniform(-0.3, 0.3);
    p[i] = cag_vec3(x, y, uniform(-1, 1));
  }
  CagSurface *s;
  OK(cag_surface_nurbs(p, NULL, 4, 4, degree_u, degree_v, degree_u == 1 ? linear : quadratic,
                       degree_v == 1 ? linear : quadratic, &s, &err));
  return s;
}

// Counts curves that are not tiny. A corner of the net may be behind the plane by less than the
// length of any traced curve.
static size_t count_long(const CagCurveList *l) {
  size_t n = 0;
  for (size_t i = 0; i < l->count; i++) {
    double own;
    OK(cag_curve_length(l->items[i], l->items[i]->start, l->items[i]->end, &own, &err));
    n += own > 1e-5;
  }
  return n;
}

// Sections with planes are traced by a different method: as zeros of a function on one surface. The
// tolerance bounds the distance between the curves, so their lengths may differ by several
// tolerances.
static void curved_nets_meet_a_flat_sheet_as_they_do_its_plane(void **state) {
  (void)state;
  seed = 3;
  for (int round = 0; round < 25; round++) {
    CagSurface *s = curved_net(1 + (round % 3 == 1), 1 + (round % 3 == 2)), *sheet;
    const double height = uniform(-0.5, 0.5), x = uniform(-0.7, 0.7), y = uniform(-0.7, 0.7);
    const CagPlane plane = {cag_vec3(0, 0, height), cag_unit(cag_vec3(x, y, 1))};
    CagTransform frame = cag_plane_frame(&plane);
    CagVec3 corner[4];
    for (int i = 0; i < 4; i++)
      corner[i] = cag_transform_point(&frame, cag_vec3(i & 2 ? 9 : -9, i & 1 ? 9 : -9, 0));
    OK(cag_surface_bilinear(corner[0], corner[1], corner[2], corner[3], &sheet, &err));
    CagCurveList met = {0}, cut = {0};
    OK(cag_surface_intersect(s, sheet, 1e-6, NULL, &met, &err));
    OK(cag_surface_section(s, &plane, 1e-6, &cut, &err));
    assert_int_equal(count_long(&met), count_long(&cut));
    NEAR(total_length(&met), total_length(&cut), 1e-5);
    cag_curve_list_free(&met);
    cag_curve_list_free(&cut);
    cag_surface_release(s);
    cag_surface_release(sheet);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curved_nets_meet_a_flat_sheet_as_they_do_its_plane)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
