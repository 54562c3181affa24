// Sections and outlines of tori of all sizes: the curves satisfy the tolerance. The default
// tolerance is a millionth of the size.

#include "geom/meet/section.h"
#include "geom/solid/solid.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static const double MAJOR = 3, MINOR = 1.2;

typedef enum What { SURFACE, SOLID, OUTLINE } What;

typedef struct Subject {
  What what;
  CagSolid *solid;
  const CagSurface *surface;
  CagTransform back; // to the torus about Z at the origin
  double scale, size;
  CagPlane plane;
} Subject;

static CagVec3 random_vector(double most) {
  const double x = uniform(-most, most), y = uniform(-most, most);
  return cag_vec3(x, y, uniform(-most, most));
}

static void set_subject(Subject *s, What what, double scale) {
  CagSolid *own;
  CagTransform turn, grow, map;
  CagBounds box;
  *s = (Subject){.what = what, .scale = scale};
  OK(cag_solid_torus(MAJOR, MINOR, &own, &err));
  const CagVec3 axis = random_vector(1);
  OK(cag_rotate(axis, uniform(0, 6), random_vector(1), &turn, &err));
  OK(cag_scale(cag_vec3(scale, scale, scale), cag_vec3(0, 0, 0), &grow, &err));
  map = cag_transform_multiply(&grow, &turn);
  OK(cag_transform_inverse(&map, &s->back, &err));
  OK(cag_solid_transform(own, &map, &s->solid, &err));
  cag_solid_release(own);
  assert_int_equal(s->solid->face_count, 1);
  s->surface = s->solid->faces[0];
  OK(cag_surface_bounds(s->surface, &box, &err));
  s->size = cag_norm(cag_sub(box.max, box.min));
  s->plane.point = cag_transform_point(&map, random_vector(0.5));
  s->plane.normal = cag_unit(random_vector(1));
}

static CagCurveList curves_of(const Subject *s, double tolerance) {
  CagCurveList list = {0};
  switch (s->what) {
  case SURFACE: OK(cag_surface_section(s->surface, &s->plane, tolerance, &list, &err)); break;
  case SOLID: OK(cag_solid_section(s->solid, &s->plane, tolerance, &list, &err)); break;
  default:
    OK(cag_surface_contour(s->surface, s->plane.normal, s->plane.point, false, tolerance, &list,
                           &err));
  }
  return list;
}

static CagVec3 at(const CagCurve *c, int i, int n) {
  CagVec3 p;
  OK(cag_curve_point(c, c->start + (c->end - c->start) * i / n, &p, &err));
  return p;
}

static bool same(const CagCurveList *a, const CagCurveList *b) {
  if (a->count != b->count) return false;
  for (size_t k = 0; k < a->count; k++)
    for (int i = 0; i <= 20; i++) {
      const CagVec3 p = at(a->items[k], i, 20), q = at(b->items[k], i, 20);
      if (memcmp(&p, &q, sizeof p) != 0) return false;
    }
  return true;
}

static double distance_from_torus(const Subject *s, CagVec3 p) {
  p = cag_transform_point(&s->back, p);
  return s->scale * fabs(hypot(hypot(p.x, p.y) - MAJOR, p.z) - MINOR);
}

static void check(const Subject *s, const CagCurveList *list, double tolerance) {
  for (size_t k = 0; k < list->count; k++)
    for (int i = 0; i <= 400; i++) {
      const CagVec3 p = at(list->items[k], i, 400);
      assert_true(distance_from_torus(s, p) <= tolerance);
      if (s->what <= SOLID)
        assert_true(fabs(cag_dot(s->plane.normal, cag_sub(p, s->plane.point))) <= tolerance);
    }
}

static void curves_keep_the_tolerance(void **state) {
  (void)state;
  seed = 61;
  static const double SCALE[] = {1e-4, 1, 1e4};
  for (int round = 0; round < 18; round++) {
    Subject s;
    set_subject(&s, (What)(round % 3), SCALE[round / 3 % 3]);
    CagCurveList fine = curves_of(&s, 0), wanted = curves_of(&s, 1e-6 * s.size);
    CagCurveList finer = curves_of(&s, 1e-8 * s.size);
    assert_true(fine.count > 0);
    assert_true(same(&fine, &wanted));
    check(&s, &fine, 1.01e-6 * s.size);
    check(&s, &finer, 1.01e-8 * s.size);
    assert_false(same(&fine, &finer));
    cag_curve_list_free(&fine);
    cag_curve_list_free(&wanted);
    cag_curve_list_free(&finer);
    cag_solid_release(s.solid);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curves_keep_the_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
