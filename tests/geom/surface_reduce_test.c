// Knot removal, degree reduction, and reversed directions of surfaces. What insertion and elevation
// add is removed; otherwise, the deviation found by samples must not exceed the one reported.

#include "geom/surface/reshape.h"
#include "random.h"
#include "support.h"

enum { NU = 6, NV = 5 };

static CagSurface *random_surface(bool rational) {
  CagVec3 net[NU * NV];
  double weights[NU * NV];
  const double ku[] = {0, 0, 0, 0, 0.6, 1, 2, 2, 2, 2}, kv[] = {0, 0, 0, 1, 3, 4, 4, 4};
  CagSurface *s;
  for (int i = 0; i < NU; i++)
    for (int j = 0; j < NV; j++) {
      net[i * NV + j] = cag_vec3(i + uniform(-0.3, 0.3), j + uniform(-0.3, 0.3), uniform(-1, 1));
      weights[i * NV + j] = uniform(0.5, 2);
    }
  OK(cag_surface_nurbs(net, rational ? weights : NULL, NU, NV, 3, 2, ku, kv, &s, &err));
  return s;
}

static CagVec3 point_of(const CagSurface *s, double u, double v) {
  CagVec3 p;
  OK(cag_surface_eval(s, u, v, 0, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, &p, &err));
  return p;
}

static double largest_gap(const CagSurface *a, const CagSurface *b) {
  enum { SAMPLES = 25 };
  double most = 0;
  for (int i = 0; i <= SAMPLES; i++)
    for (int j = 0; j <= SAMPLES; j++) {
      const double u = a->u0 + (a->u1 - a->u0) * i / SAMPLES;
      const double v = a->v0 + (a->v1 - a->v0) * j / SAMPLES;
      most = fmax(most, cag_norm(cag_sub(point_of(a, u, v), point_of(b, u, v))));
    }
  return most;
}

static void inserted_knots_are_removed(void **state) {
  (void)state;
  for (int k = 0; k < 20; k++) {
    CagSurface *s = random_surface(k % 2), *more, *back;
    const int direction = k / 2 % 2, times = 1 + k / 4 % 2;
    double moved;
    OK(cag_surface_insert_knot(s, direction, 0.8, times, &more, &err));
    OK(cag_surface_remove_knot(more, direction, 0.8, times, 1e-9, &back, &moved, &err));
    assert_true(moved < 1e-12 && largest_gap(s, back) < 1e-12);
    CagSurfaceNurbsView v;
    assert_true(cag_surface_nurbs_view(back, &v));
    assert_int_equal(v.nu, NU);
    assert_int_equal(v.nv, NV);
    FAILS(cag_surface_remove_knot(s, direction, 0.8, 1, INFINITY, &back, NULL, &err),
          "no-such-knot");
    cag_surface_release(back);
    cag_surface_release(more);
    cag_surface_release(s);
  }
}

static void removal_moves_points_by_at_most_the_deviation(void **state) {
  (void)state;
  for (int k = 0; k < 20; k++) {
    CagSurface *s = random_surface(k % 2), *less;
    const int direction = k / 2 % 2;
    double moved;
    OK(cag_surface_remove_knot(s, direction, 1, 1, INFINITY, &less, &moved, &err));
    const double gap = largest_gap(s, less);
    assert_true(gap > 0.01 * moved && gap <= moved * (1 + 1e-12));
    cag_surface_release(less);
    FAILS(cag_surface_remove_knot(s, direction, 1, 1, 0.999 * moved, &less, NULL, &err),
          "tolerance-exceeded");
    OK(cag_surface_remove_knot(s, direction, 1, 1, 1.001 * moved, &less, NULL, &err));
    cag_surface_release(less);
    cag_surface_release(s);
  }
}

static void elevated_degrees_are_reduced(void **state) {
  (void)state;
  for (int k = 0; k < 20; k++) {
    CagSurface *s = random_surface(k % 2), *more, *back;
    const int direction = k / 2 % 2;
    double moved;
    OK(cag_surface_elevate(s, direction == 0, direction == 1, &more, &err));
    OK(cag_surface_reduce_degree(more, direction, 1e-9, &back, &moved, &err));
    assert_true(moved < 1e-11 && largest_gap(s, back) < 1e-11);
    CagSurfaceNurbsView v;
    assert_true(cag_surface_nurbs_view(back, &v));
    assert_int_equal(v.nu, NU);
    assert_int_equal(v.nv, NV);
    cag_surface_release(back);
    cag_surface_release(more);
    OK(cag_surface_reduce_degree(s, direction, INFINITY, &back, &moved, &err));
    assert_true(largest_gap(s, back) <= moved * (1 + 1e-12));
    cag_surface_release(back);
    FAILS(cag_surface_reduce_degree(s, direction, 1e-6, &back, NULL, &err), "tolerance-exceeded");
    cag_surface_release(s);
  }
}

static void reversed_directions_mirror_the_parameters(void **state) {
  (void)state;
  for (int direction = 0; direction < 2; direction++) {
    CagSurface *s = random_surface(true), *back;
    OK(cag_surface_reverse(s, direction, &back, &err));
    for (int k = 0; k < 50; k++) {
      const double u = uniform(s->u0, s->u1), v = uniform(s->v0, s->v1);
      const CagVec3 p =
          direction ? point_of(s, u, s->v0 + s->v1 - v) : point_of(s, s->u0 + s->u1 - u, v);
      assert_true(cag_norm(cag_sub(point_of(back, u, v), p)) < 1e-13);
    }
    cag_surface_release(back);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(inserted_knots_are_removed),
      cmocka_unit_test(removal_moves_points_by_at_most_the_deviation),
      cmocka_unit_test(elevated_degrees_are_reduced),
      cmocka_unit_test(reversed_directions_mirror_the_parameters),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
