// Curvature of surfaces, from the first and second fundamental forms.

#include <float.h>

#include "interp/builtin/surfaces.h"

typedef struct Forms {
  CagVec3 su, sv, normal;
  double E, F, G, L, M, N;
  double area; // E G - F^2
} Forms;

// A patch whose tangents are more nearly parallel than this, or one of which vanishes, has no
// normal by them.
#define FLAT_SINE 1e-12

static bool read_forms(CagCall *call, Forms *f) {
  CagSurface *s;
  CagVec3 d[9];
  double u, v;
  if (!cag_arg_side_uv(call, &s, &u, &v) ||
      !cag_geometry_ok(call,
                       cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, call->err)))
    return false;
  f->su = d[cag_partial(2, 1, 0)];
  f->sv = d[cag_partial(2, 0, 1)];
  CagVec3 n = cag_cross(f->su, f->sv);
  f->normal = cag_unit(n);
  f->E = cag_dot(f->su, f->su);
  f->F = cag_dot(f->su, f->sv);
  f->G = cag_dot(f->sv, f->sv);
  f->area = cag_dot(n, n);
  f->L = cag_dot(d[cag_partial(2, 2, 0)], f->normal);
  f->M = cag_dot(d[cag_partial(2, 1, 1)], f->normal);
  f->N = cag_dot(d[cag_partial(2, 0, 2)], f->normal);
  return true;
}

// The same where curvature is asked for, which a pole does not have by its partials.
static bool read_regular(CagCall *call, Forms *f) {
  if (!read_forms(call, f)) return false;
  return f->area > FLAT_SINE * FLAT_SINE * f->E * f->G ||
         cag_geometry_ok(
             call,
             cag_fail(
                 call->err, CAG_E_DEGENERATE, CAG_ERR_degenerate_normal, "", -1,
                 "the surface has no two independent tangents here (a pole or a fold), so its curvature is undefined"));
}

bool cag_surfaces_first_form(CagCall *call, CagValue *result) {
  Forms f;
  if (!read_forms(call, &f)) return false;
  *result = cag_vector(call->vm, (double[]){f.E, f.F, f.G}, 3);
  return true;
}

bool cag_surfaces_second_form(CagCall *call, CagValue *result) {
  Forms f;
  if (!read_regular(call, &f)) return false;
  *result = cag_vector(call->vm, (double[]){f.L, f.M, f.N}, 3);
  return true;
}

static double gaussian(const Forms *f) { return (f->L * f->N - f->M * f->M) / f->area; }
static double mean(const Forms *f) {
  return (f->E * f->N - 2 * f->F * f->M + f->G * f->L) / (2 * f->area);
}

bool cag_surfaces_gaussian_curvature(CagCall *call, CagValue *result) {
  Forms f;
  if (!read_regular(call, &f)) return false;
  *result = cag_number(gaussian(&f));
  return true;
}

bool cag_surfaces_mean_curvature(CagCall *call, CagValue *result) {
  Forms f;
  if (!read_regular(call, &f)) return false;
  *result = cag_number(mean(&f));
  return true;
}

bool cag_surfaces_normal_curvature(CagCall *call, const struct cag_surfaces_normal_curvature *a,
                                   CagValue *result) {
  Forms f;
  if (!read_regular(call, &f)) return false;
  // The tangent x su + y sv below v.
  const CagVec3 v = a->V.at;
  double p = cag_dot(v, f.su), q = cag_dot(v, f.sv);
  double x = (f.G * p - f.F * q) / f.area, y = (f.E * q - f.F * p) / f.area;
  double length = f.E * x * x + 2 * f.F * x * y + f.G * y * y;
  if (length <= FLAT_SINE * FLAT_SINE * cag_dot(v, v))
    return cag_fail_call(call, 3, CAG_ERR_value,
                         "expects a direction along the surface, found one along its normal");
  *result = cag_number((f.L * x * x + 2 * f.M * x * y + f.N * y * y) / length);
  return true;
}

// The curvatures are the eigenvalues of the second form in an orthonormal basis of the tangent
// plane, a symmetric 2x2 matrix, which keeps the small one exact and the directions square.
static void principal(const Forms *f, double k[2], CagVec3 direction[2]) {
  CagVec3 e1 = cag_unit(f->su), e2 = cag_cross(f->normal, e1);
  double x = cag_norm(f->su), c = cag_dot(f->sv, e1), d = cag_dot(f->sv, e2);
  // su = x e1, sv = c e1 + d e2
  double a = f->L / (x * x);
  double b = (f->M / x - c * a) / d;
  double g = (f->N - c * c * a - 2 * c * d * b) / (d * d);
  double middle = (a + g) / 2, spread = hypot((a - g) / 2, b);
  double turn = spread <= 16 * DBL_EPSILON * fabs(middle) ? 0 : atan2(b, (a - g) / 2) / 2;
  k[0] = middle - spread;
  k[1] = middle + spread;
  direction[1] = cag_madd(cag_scaled(e1, cos(turn)), sin(turn), e2);
  direction[0] = cag_cross(f->normal, direction[1]);
}

bool cag_surfaces_principal_curvatures(CagCall *call, CagValue *result) {
  static const char *const names[] = {"min", "max", "min_direction", "max_direction"};
  Forms f;
  double k[2];
  CagVec3 d[2];
  if (!read_regular(call, &f)) return false;
  principal(&f, k, d);
  CagValue values[] = {cag_number(k[0]), cag_number(k[1]), cag_point(call->vm, d[0], 3),
                       cag_point(call->vm, d[1], 3)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

// A curvature counts as 0 when it is this part of the larger one or, times the length of the
// tangents, this small: rounding of second derivatives stays well below.
#define FLAT_CURVATURE 1e-9

bool cag_surfaces_curvature_class(CagCall *call, CagValue *result) {
  Forms f;
  double k[2];
  CagVec3 d[2];
  if (!read_regular(call, &f)) return false;
  principal(&f, k, d);
  double large = fmax(fabs(k[0]), fabs(k[1])), small = fmin(fabs(k[0]), fabs(k[1]));
  const char *name = k[0] * k[1] > 0 ? "elliptic" : "hyperbolic";
  if (large * sqrt(fmax(f.E, f.G)) <= FLAT_CURVATURE) name = "planar";
  else if (small <= FLAT_CURVATURE * large) name = "parabolic";
  *result = cag_text_c(call->vm, name);
  return true;
}
