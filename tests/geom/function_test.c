// Curves and surfaces defined by functions of the caller: transforms, errors, and ownership.

#include "function_support.h"
#include "geom/curve/function.h"
#include "geom/curve/natural.h"
#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/function.h"
#include "support.h"

// A circle of radius 2 in the plane z = 1, which fails after `limit`.
typedef struct Circle {
  double limit;
  int released;
} Circle;

static CagStatus circle_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  const Circle *c = context;
  if (t > c->limit) return cag_fail(e, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "too far");
  for (int k = 0; k <= order; k++)
    out[k] = cag_vec3(2 * cos(t + k * M_PI / 2), 2 * sin(t + k * M_PI / 2), k == 0);
  return CAG_OK;
}
static void circle_release(void *context) { ((Circle *)context)->released++; }

static CagCurve *make_circle(Circle *c) {
  CagCurve *curve;
  const CagCurveFunction f = {.eval = circle_eval, .release = circle_release, .context = c};
  OK(cag_curve_function(&f, 3, 0, 2 * M_PI, true, &curve, &err));
  return curve;
}

static void a_function_is_released_with_its_last_curve(void **state) {
  (void)state;
  Circle c = {10, 0};
  CagCurve *whole = make_circle(&c), *part, *back;
  OK(cag_curve_trim(whole, 1, 2, &part, &err));
  OK(cag_curve_reverse(part, &back, &err));
  assert_true(whole->closed && !part->closed && back->angular);
  cag_curve_release(whole);
  cag_curve_release(part);
  assert_int_equal(c.released, 0);
  CagVec3 p;
  OK(cag_curve_point(back, 1, &p, &err));
  near_vec(p, cag_vec3(2 * cos(2), 2 * sin(2), 1), 1e-15);
  cag_curve_release(back);
  assert_int_equal(c.released, 1);
}

static void a_function_that_fails_stays_with_its_caller(void **state) {
  (void)state;
  Circle c = {3, 0};
  CagCurve *curve;
  const CagCurveFunction f = {.eval = circle_eval, .release = circle_release, .context = &c};
  assert_int_equal(cag_curve_function(&f, 3, 0, 2 * M_PI, true, &curve, &err), CAG_E_CALLBACK);
  FAILS(cag_curve_function(&f, 3, 1, 1, false, &curve, &err), "empty-range");
  FAILS(cag_curve_function(&f, 3, 0, INFINITY, false, &curve, &err), "not-finite");
  assert_int_equal(c.released, 0);
}

// The derivatives of x / z for x = 2 cos t, z = 2 sin t + 3, from the quotient rule.
static void a_projection_has_the_derivatives_of_the_quotient(void **state) {
  (void)state;
  Circle c = {10, 0};
  CagCurve *curve = make_circle(&c), *image;
  CagTransform t = cag_transform_identity();
  t.planar = false;
  t.m[3][1] = 1; // w = y + 3
  t.m[3][3] = 3;
  OK(cag_curve_transform(curve, &t, &image, &err));
  CagVec3 d[3];
  OK(cag_curve_eval(image, 0.7, 2, CAG_SIDE_RIGHT, d, &err));
  const double x = 2 * cos(0.7), x1 = -2 * sin(0.7), x2 = -x, w = 2 * sin(0.7) + 3, w1 = x, w2 = x1;
  NEAR(d[0].x, x / w, 1e-15);
  NEAR(d[1].x, x1 / w - x * w1 / (w * w), 1e-15);
  NEAR(d[2].x, x2 / w - 2 * x1 * w1 / (w * w) - x * w2 / (w * w) + 2 * x * w1 * w1 / (w * w * w),
       1e-15);
  cag_curve_release(curve);
  cag_curve_release(image);
}

static void bounds_and_length_are_those_of_the_circle(void **state) {
  (void)state;
  Circle c = {10, 0};
  CagCurve *curve = make_circle(&c);
  CagBounds box;
  double length;
  OK(cag_curve_bounds(curve, &box, &err));
  near_vec(box.min, cag_vec3(-2, -2, 1), 1e-8);
  near_vec(box.max, cag_vec3(2, 2, 1), 1e-8);
  OK(cag_curve_length(curve, 0, 2 * M_PI, &length, &err));
  NEAR(length, 4 * M_PI, 1e-12);
  cag_curve_release(curve);
}

// u v over the unit square; NaN at u = 1 if `broken` is set.
static CagStatus saddle_eval(void *context, double u, double v, int n, CagVec3 *out, CagError *e) {
  (void)e;
  const bool broken = *(const bool *)context;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      double x = i + j == 0 ? u : i == 1 && j == 0, y = i + j == 0 ? v : i == 0 && j == 1;
      double z = i > 1 || j > 1 ? 0 : (i ? 1 : u) * (j ? 1 : v);
      out[cag_partial(n, i, j)] = cag_vec3(x, y, broken && u == 1 ? NAN : z);
    }
  return CAG_OK;
}
static CagStatus saddle_row(void *context, double u, const double *vs, size_t nv, int n,
                            CagVec3 *out, CagError *e) {
  return row_by_points(saddle_eval, context, u, vs, nv, n, out, e);
}

static void points_that_are_not_finite_are_found(void **state) {
  (void)state;
  bool broken = true;
  CagSurface *s;
  const CagSurfaceFunction f = {
      .eval = saddle_eval, .eval_row = saddle_row, .release = NULL, .context = &broken};
  FAILS(cag_surface_function(&f, 0, 1, false, 0, 1, false, &s, &err), "not-finite");
  assert_non_null(strstr(err.message, "u = 1, v = 0"));
  broken = false;
  OK(cag_surface_function(&f, 0, 1, false, 0, 1, false, &s, &err));
  assert_false(s->closed_u || s->closed_v || s->pole_u0 || s->pole_v1);
  CagVec3 points[4], du[4], dv[4];
  const double ends[2] = {0, 1};
  OK(cag_surface_eval_grid(s, ends, 2, ends, 2, points, du, dv, &err));
  near_vec(points[3], cag_vec3(1, 1, 1), 0);
  near_vec(du[1], cag_vec3(1, 0, 1), 0);
  near_vec(dv[2], cag_vec3(0, 1, 1), 0);
  broken = true;
  FAILS(cag_surface_eval_grid(s, ends, 2, ends, 2, points, du, dv, &err), "not-finite");
  cag_surface_release(s);
}

// The curvature s / 4 and the torsion 1 / 2.
static CagStatus spiral_eval(void *context, double s, int order, double *k, double *w,
                             CagError *e) {
  (void)context;
  (void)e;
  for (int i = 0; i <= order; i++) {
    k[i] = i == 0 ? s / 4 : i == 1 ? 0.25 : 0;
    w[i] = i == 0 ? 0.5 : 0;
  }
  return CAG_OK;
}

// Checks Frenet's equations with the derivatives of the curve.
static void a_natural_curve_has_its_curvature_and_torsion(void **state) {
  (void)state;
  CagCurve *c;
  const CagNaturalEquations equations = {spiral_eval, NULL, NULL};
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_natural(&equations, 40, &frame, 3, &c, &err));
  for (double s = 0.5; s < 40; s += 3.7) {
    CagFrenet f;
    CagVec3 d[7], around[2];
    OK(cag_curve_frenet(c, s, &f, &err));
    NEAR(f.curvature, s / 4, 1e-12 * s);
    NEAR(f.torsion, 0.5, 1e-11);
    // Compares the fourth derivative with differences of the third.
    const double h = 1e-4;
    OK(cag_curve_eval(c, s, 6, CAG_SIDE_RIGHT, d, &err));
    CagVec3 third[4];
    OK(cag_curve_eval(c, s + h, 3, CAG_SIDE_RIGHT, third, &err));
    around[1] = third[3];
    OK(cag_curve_eval(c, s - h, 3, CAG_SIDE_RIGHT, third, &err));
    around[0] = third[3];
    CagVec3 slope = cag_scaled(cag_sub(around[1], around[0]), 1 / (2 * h));
    near_vec(d[4], slope, 1e-6 * (1 + pow(s / 4, 6)));
  }
  cag_curve_release(c);
  frame.m[0][0] = 2;
  FAILS(cag_curve_natural(&equations, 40, &frame, 3, &c, &err), "frame-not-orthonormal");
}

// Sums of a_k cos(k t) + b_k sin(k t), k = 0..WAVES, for each coordinate.
enum { WAVES = 9 };
typedef struct Fourier {
  double a[3][WAVES + 1], b[3][WAVES + 1];
  size_t calls;
} Fourier;

static double fourier(const Fourier *f, int axis, int order, double t) {
  double sum = 0;
  for (int k = 0; k <= WAVES; k++)
    sum += pow(k, order) * (f->a[axis][k] * cos(k * t + order * M_PI / 2) +
                            f->b[axis][k] * sin(k * t + order * M_PI / 2));
  return sum;
}

static CagStatus fourier_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)e;
  Fourier *f = context;
  f->calls++;
  for (int k = 0; k <= order; k++)
    out[k] = cag_vec3(fourier(f, 0, k, t), fourier(f, 1, k, t), fourier(f, 2, k, t));
  return CAG_OK;
}

static double random_fraction(uint64_t *state) {
  *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(*state >> 11) / 9007199254740992.0;
}

// The largest value of a coordinate, from the roots of its derivative. They are bisected between
// sign changes at steps far shorter than the shortest wave.
static double fourier_top(const Fourier *f, int axis, double sign) {
  enum { STEPS = 400 };
  double best = sign * fourier(f, axis, 0, 0);
  for (int i = 0; i < STEPS; i++) {
    double a = 2 * M_PI * i / STEPS, b = 2 * M_PI * (i + 1) / STEPS;
    if (sign * fourier(f, axis, 1, a) < 0 || sign * fourier(f, axis, 1, b) > 0) continue;
    for (int k = 0; k < 60; k++) {
      const double middle = (a + b) / 2;
      if (sign * fourier(f, axis, 1, middle) > 0) a = middle;
      else b = middle;
    }
    best = fmax(best, sign * fourier(f, axis, 0, a));
  }
  return best;
}

static void bounds_of_random_waves_are_those_of_their_summits(void **state) {
  (void)state;
  uint64_t seed = 28;
  for (int round = 0; round < 200; round++) {
    Fourier f = {.calls = 0};
    for (int axis = 0; axis < 3; axis++)
      for (int k = 0; k <= WAVES; k++) {
        f.a[axis][k] = (random_fraction(&seed) - 0.5) / (1 + k);
        f.b[axis][k] = (random_fraction(&seed) - 0.5) / (1 + k);
      }
    CagCurve *c;
    CagBounds box;
    const CagCurveFunction function = {.eval = fourier_eval, .release = NULL, .context = &f};
    OK(cag_curve_function(&function, 3, 0, 2 * M_PI, true, &c, &err));
    OK(cag_curve_bounds(c, &box, &err));
    assert_true(f.calls < 1000);
    const double low[3] = {box.min.x, box.min.y, box.min.z};
    const double high[3] = {box.max.x, box.max.y, box.max.z};
    for (int axis = 0; axis < 3; axis++) {
      NEAR(high[axis], fourier_top(&f, axis, 1), 1e-10);
      NEAR(-low[axis], fourier_top(&f, axis, -1), 1e-10);
    }
    cag_curve_release(c);
  }
}

// Kinks, poles of the derivative, and constant parts, where slopes are useless.
static CagStatus rough_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)context;
  (void)e;
  const double x = t - 0.3;
  out[0] = cag_vec3(-fabs(x), -sqrt(fabs(t - 0.7)), t < 0.5 ? 0 : (t - 0.5) * (t - 0.5));
  for (int k = 1; k <= order; k++) out[k] = cag_vec3(k == 1 ? (x > 0 ? -1 : 1) : 0, NAN, 0);
  return CAG_OK;
}

static void bounds_do_without_derivatives(void **state) {
  (void)state;
  CagCurve *c;
  CagBounds box;
  const CagCurveFunction function = {.eval = rough_eval, .release = NULL, .context = NULL};
  OK(cag_curve_function(&function, 3, 0, 1, false, &c, &err));
  OK(cag_curve_bounds(c, &box, &err));
  near_vec(box.min, cag_vec3(-0.7, -sqrt(0.7), 0), 1e-9);
  near_vec(box.max, cag_vec3(0, 0, 0.25), 1e-7); // y: the square root of the rounding error of t
  cag_curve_release(c);
}

// A star, r = 10 + cos 5 t.
static CagStatus star_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)e;
  ++*(size_t *)context;
  for (int k = 0; k <= order; k++) {
    const double turn = k * M_PI / 2;
    // cos t cos 5t = (cos 4t + cos 6t) / 2, sin t cos 5t = (sin 6t - sin 4t) / 2
    const double four = pow(4, k) / 2, six = pow(6, k) / 2;
    out[k] = cag_vec3(10 * cos(t + turn) + four * cos(4 * t + turn) + six * cos(6 * t + turn),
                      10 * sin(t + turn) - four * sin(4 * t + turn) + six * sin(6 * t + turn), 0);
  }
  return CAG_OK;
}

// The function is evaluated about once for each required point, no matter how often the shape is
// moved, measured, and tessellated.
static void a_solid_of_a_function_asks_for_few_points(void **state) {
  (void)state;
  size_t calls = 0;
  CagCurve *c;
  CagRegion *r;
  CagSolid *solid, *moved;
  const CagCurveFunction function = {.eval = star_eval, .release = NULL, .context = &calls};
  OK(cag_curve_function(&function, 2, 0, 2 * M_PI, true, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  OK(cag_solid_extrude(r, cag_vec3(0, 0, 5), 0, 1, &solid, &err));
  CagTransform turn;
  OK(cag_rotate(cag_vec3(1, 2, 3), 0.4, cag_vec3(0, 0, 0), &turn, &err));
  for (int i = 0; i < 3; i++) {
    OK(cag_solid_transform(solid, &turn, &moved, &err));
    cag_solid_release(solid);
    solid = moved;
  }
  CagBounds box;
  CagMesh *mesh;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 0.01;
  OK(cag_solid_bounds(solid, &box, &err));
  OK(cag_solid_tessellate(solid, &how, &mesh, &err));
  assert_true(calls < 12000);
  double terms[10];
  cag_mesh_volume_terms(mesh, terms);
  NEAR(terms[0], 5 * M_PI * 100.5, 0.003 * 5 * M_PI * 100.5); // area: pi (10^2 + 1 / 2)
  cag_mesh_release(mesh);
  cag_solid_release(solid);
  cag_region_release(r);
  cag_curve_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_function_is_released_with_its_last_curve),
      cmocka_unit_test(a_function_that_fails_stays_with_its_caller),
      cmocka_unit_test(a_projection_has_the_derivatives_of_the_quotient),
      cmocka_unit_test(bounds_and_length_are_those_of_the_circle),
      cmocka_unit_test(bounds_of_random_waves_are_those_of_their_summits),
      cmocka_unit_test(bounds_do_without_derivatives),
      cmocka_unit_test(a_solid_of_a_function_asks_for_few_points),
      cmocka_unit_test(points_that_are_not_finite_are_found),
      cmocka_unit_test(a_natural_curve_has_its_curvature_and_torsion),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
