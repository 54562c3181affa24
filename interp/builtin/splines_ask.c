// Bases as matrices, the forms and the shape of cubic segments, joints, crossings with lines.

#include <string.h>

#include "base/memory.h"
#include "geom/basis/bernstein.h"
#include "geom/curve/hulls.h"
#include "geom/curve/intersect.h"
#include "geom/curve/joint.h"
#include "interp/builtin/splines.h"
#include "interp/builtin/support.h"

// --- Matrices: rows by descending powers of t, columns by control points ---

static CagValue matrix_value(CagVm *vm, const double *m, size_t n) {
  double *out;
  CagValue v;
  if (n == 1) v = cag_list_numbers(vm, 1, &out);
  else if (n <= CAG_MAX_PACKED) v = cag_list_vectors(vm, n, n, &out);
  else {
    CagBuilder *rows = cag_builder_new(vm);
    for (size_t i = 0; i < n; i++) cag_builder_add(vm, rows, cag_numbers_value(vm, m + i * n, n));
    return cag_builder_finish(vm, rows);
  }
  memcpy(out, m, n * n * sizeof *out);
  if (n == 1) v = cag_list_values(vm, &v, 1);
  return v;
}

// C(i, j) = binomial(n - j, n - i - j) (-1)^(n - i - j), D = diag(binomial(n, j)), N = C D
// (Rogers and Adams 1990, section 5-8).
static void bezier_matrix(int n, double *product, double *c, double *d) {
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= n; j++) {
      const int k = n - i - j;
      const double sign = k % 2 == 0 ? 1 : -1, a = k < 0 ? 0 : sign * cag_binomial(n - j, k);
      const int at = i * (n + 1) + j;
      product[at] = a * cag_binomial(n, j);
      if (c) c[at] = a;
      if (d) d[at] = i == j ? cag_binomial(n, j) : 0;
    }
}

// One span of a uniform B-spline (Qin 1998, General matrix
// representations for B-splines).
static void bspline_matrix(int p, double *out) {
  const int k = p + 1;
  double factorial = 1;
  for (int i = 2; i <= p; i++) factorial *= i;
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++) {
      double sum = 0;
      for (int l = j; l < k; l++)
        sum += pow(k - (l + 1), i) * ((l - j) % 2 == 0 ? 1 : -1) * cag_binomial(k, l - j);
      out[i * k + j] = cag_binomial(p, i) * sum / factorial;
    }
}

static void parabolic_matrix(double a, double b, double *out) {
  const double c = 1 - a, d = 1 - b, ab = a * b;
  const double m[4][4] = {
      {-c * c / a, (c + ab) / a, (-c - ab) / d, b * b / d},
      {2 * c * c / a, (-2 * c - ab) / a, (2 * c - b * (1 - 2 * a)) / d, -b * b / d},
      {-c * c / a, (1 - 2 * a) / a, a, 0},
      {0, 1, 0, 0},
  };
  memcpy(out, m, sizeof m);
}

// Entries of higher degrees are beyond what a double holds exactly. The first is also in a row.
#define BEZIER_MATRIX_MOST 50
#define BSPLINE_MATRIX_MOST 15

bool cag_splines_basis_matrix(CagCall *call, const struct cag_splines_basis_matrix *a,
                              CagValue *result) {
  enum { BEZIER, BSPLINE, HERMITE, CATMULL_ROM, PARABOLIC }; // as the row has them
  static const double hermite[16] = {2, -2, 1, 1, -3, 3, -2, -1, 0, 0, 1, 0, 1, 0, 0, 0};
  const bool parabolic = a->kind == PARABOLIC;
  const long most = a->kind == BEZIER    ? BEZIER_MATRIX_MOST
                    : a->kind == BSPLINE ? BSPLINE_MATRIX_MOST
                                         : 3;
  double m[(BEZIER_MATRIX_MOST + 1) * (BEZIER_MATRIX_MOST + 1)];
  char text[32];
  long degree;
  if (!cag_arg_integer_or(call, 1, 3, a->kind <= BSPLINE ? 0 : 3, most, &degree)) return false;
  for (int i = 0; i < 2; i++) {
    const double ratio = i ? a->beta : a->alpha;
    if (parabolic && !(ratio > 0 && ratio < 1))
      return cag_splines_fail(call, CAG_ERR_bad_blend_parameter, i ? "beta" : "alpha", -1,
                              "`%s` must be between 0 and 1, found %s", i ? "beta" : "alpha",
                              cag_number_text(ratio, text));
  }
  if (a->kind == BEZIER) bezier_matrix((int)degree, m, NULL, NULL);
  else if (a->kind == BSPLINE) bspline_matrix((int)degree, m);
  else if (a->kind == HERMITE) memcpy(m, hermite, sizeof hermite);
  else parabolic_matrix(parabolic ? a->alpha : 0.5, parabolic ? a->beta : 0.5, m);
  *result = matrix_value(call->vm, m, (size_t)degree + 1);
  return true;
}

bool cag_splines_bezier_matrices(CagCall *call, const struct cag_splines_bezier_matrices *a,
                                 CagValue *result) {
  static const char *const names[] = {"N", "C", "D"};
  double m[3][(BEZIER_MATRIX_MOST + 1) * (BEZIER_MATRIX_MOST + 1)];
  bezier_matrix((int)a->n, m[0], m[1], m[2]);
  CagValue values[3];
  for (int i = 0; i < 3; i++) values[i] = matrix_value(call->vm, m[i], (size_t)a->n + 1);
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// A higher degree has no values that a double can tell apart. It is also in the row.
#define BERNSTEIN_MOST 1000

bool cag_splines_bernstein_maxima(CagCall *call, const struct cag_splines_bernstein_maxima *a,
                                  CagValue *result) {
  static const char *const names[] = {"t", "value"};
  const long n = a->n;
  double b[BERNSTEIN_MOST + 1], *t, *value;
  CagValue values[] = {cag_list_numbers(call->vm, (size_t)n + 1, &t),
                       cag_list_numbers(call->vm, (size_t)n + 1, &value)};
  for (long i = 0; i <= n; i++) {
    t[i] = n == 0 ? 0 : (double)i / (double)n;
    cag_bernstein((int)n, t[i], b);
    value[i] = b[i];
    if (!cag_keep_going(call->vm)) return false;
  }
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_splines_hermite_basis(CagCall *call, const struct cag_splines_hermite_basis *a,
                               CagValue *result) {
  const double t = a->t, h = a->length;
  double *f;
  char text[32];
  if (!(h > 0))
    return cag_splines_fail(call, CAG_ERR_bad_parameter_length, "length", -1,
                            "the length of a segment must be positive, found %s",
                            cag_number_text(h, text));
  *result = cag_list_numbers(call->vm, 4, &f);
  f[0] = (2 * t - 3) * t * t + 1;
  f[1] = (3 - 2 * t) * t * t;
  f[2] = t * ((t - 2) * t + 1) * h;
  f[3] = t * (t - 1) * t * h;
  return true;
}

// --- Polynomials of pieces ---

bool cag_splines_polynomials(CagCall *call, const struct cag_splines_polynomials *a,
                             CagValue *result) {
  CagVec3 *c;
  size_t pieces;
  int degree;
  if (!cag_geometry_ok(call, cag_curve_coefficients(a->C, &c, &pieces, &degree, call->err)))
    return false;
  cag_hold(call, c);
  CagBuilder *rows = cag_builder_new(call->vm);
  const size_t n = (size_t)degree + 1;
  for (size_t i = 0; i < pieces; i++)
    if (!cag_builder_add(call->vm, rows, cag_points_value(call->vm, c + i * n, n, a->C->dimension)))
      return false;
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

// --- Cubic segments ---

// The ends of a segment of the plane and its vectors there, checked to have 2 numbers.
static bool check_segment(CagCall *call, const CagPoint *v[4]) {
  const int dimension = v[0]->dimension;
  for (int i = 1; i < 4; i++)
    if (!cag_splines_check_dimension(call, i, *v[i], dimension)) return false;
  return dimension == 2 ||
         cag_splines_fail(
             call, CAG_ERR_dimension_mismatch, "", -1,
             "inflections, cusps, and loops need a plane segment: use points and tangents of 2 numbers");
}

bool cag_splines_hermite_shape(CagCall *call, const struct cag_splines_hermite_shape *a,
                               CagValue *result) {
  static const char *const names[] = {"chord",       "k0",           "k1",          "ratio0",
                                      "ratio1",      "within_limit", "projection0", "projection1",
                                      "inflections", "cusp",         "loop"};
  CagHermiteShape s;
  if (!check_segment(call, (const CagPoint *[]){&a->P, &a->Q, &a->V, &a->W}) ||
      !cag_geometry_ok(call, cag_hermite_shape(a->P.at, a->Q.at, a->V.at, a->W.at, &s, call->err)))
    return false;
  CagValue values[] = {cag_number(s.chord),
                       cag_number(s.speed[0]),
                       cag_number(s.speed[1]),
                       cag_number(s.ratio[0]),
                       cag_number(s.ratio[1]),
                       cag_bool(s.within_limit),
                       cag_number(s.projection[0]),
                       cag_number(s.projection[1]),
                       cag_numbers_value(call->vm, s.inflection, s.inflections),
                       s.has_cusp ? cag_number(s.cusp) : cag_none(),
                       s.has_loop ? cag_numbers_value(call->vm, s.loop, 2) : cag_none()};
  *result = cag_record_new(call->vm, names, values, sizeof values / sizeof *values);
  return true;
}

bool cag_splines_hermite_by_curvature(CagCall *call,
                                      const struct cag_splines_hermite_by_curvature *a,
                                      CagValue *result) {
  if (!check_segment(call, (const CagPoint *[]){&a->P, &a->Q, &a->V, &a->W})) return false;
  const bool no_start = cag_norm(a->V.at) == 0;
  if (no_start || cag_norm(a->W.at) == 0)
    return cag_splines_fail(call, CAG_ERR_zero_vector, no_start ? "V" : "W", -1,
                            "the direction at the %s is the zero vector",
                            no_start ? "start" : "end");
  static const double unit[2] = {0, 1};
  const CagVec3 p[2] = {a->P.at, a->Q.at}, v = cag_unit(a->V.at), w = cag_unit(a->W.at);
  const double k[2] = {a->start, a->finish};
  double lengths[4][2];
  const size_t n = cag_hermite_by_curvature(p[0], p[1], v, w, k, lengths);
  CagValue curves[4];
  for (size_t i = 0; i < n; i++) {
    const CagVec3 tangents[2] = {cag_scaled(v, lengths[i][0]), cag_scaled(w, lengths[i][1])};
    CagCurve *c = NULL;
    CagStatus status = cag_curve_hermite(p, tangents, 2, unit, 2, &c, call->err);
    if (!cag_curve_result(call, status, &c, &curves[i])) return false;
  }
  *result = cag_list_values(call->vm, curves, n);
  return true;
}

// The Bezier points of the segment that four points or vectors are in the form `from`.
static void to_bezier_points(const CagVec3 g[4], int from, CagVec3 b[4]) {
  CagVec3 d0, d1;
  switch (from) {
  case 0: memcpy(b, g, 4 * sizeof *b); return;
  case 1:
    d0 = g[2];
    d1 = g[3];
    b[0] = g[0];
    b[3] = g[1];
    break;
  case 2:
    b[0] = g[0];
    b[3] = cag_add(cag_add(g[0], g[1]), cag_add(g[2], g[3]));
    d0 = g[1];
    d1 = cag_add(g[1], cag_add(cag_scaled(g[2], 2), cag_scaled(g[3], 3)));
    break;
  default:
    b[0] = g[1];
    b[3] = g[2];
    d0 = cag_scaled(cag_sub(g[2], g[0]), 0.5);
    d1 = cag_scaled(cag_sub(g[3], g[1]), 0.5);
  }
  b[1] = cag_madd(b[0], 1.0 / 3, d0);
  b[2] = cag_madd(b[3], -1.0 / 3, d1);
}

bool cag_splines_convert_cubic(CagCall *call, const struct cag_splines_convert_cubic *a,
                               CagValue *result) {
  static const char *const names[] = {"bezier", "hermite", "power", "parabolic"};
  CagVec3 b[4];
  if (!cag_splines_check_points(call, 0, &a->points)) return false;
  if (a->points.count != 4)
    return cag_splines_fail(call, CAG_ERR_point_count, "points", -1,
                            "a cubic segment needs four points and vectors, found %zu",
                            a->points.count);
  to_bezier_points(a->points.items, a->from, b);
  const CagVec3 d0 = cag_scaled(cag_sub(b[1], b[0]), 3), d1 = cag_scaled(cag_sub(b[3], b[2]), 3);
  const CagVec3 bend = cag_scaled(cag_add(cag_sub(b[0], cag_scaled(b[1], 2)), b[2]), 3);
  const CagVec3 cube = cag_add(cag_sub(b[3], b[0]), cag_scaled(cag_sub(b[1], b[2]), 3));
  const CagVec3 forms[4][4] = {{b[0], b[1], b[2], b[3]},
                               {b[0], b[3], d0, d1},
                               {b[0], d0, bend, cube},
                               {cag_madd(b[3], -2, d0), b[0], b[3], cag_madd(b[0], 2, d1)}};
  CagValue values[4];
  for (int i = 0; i < 4; i++)
    values[i] = cag_points_value(call->vm, forms[i], 4, a->points.dimension);
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

// --- Joints ---

// bezier_join(C, degree = 3, order = 1, ratio = 1)
bool cag_splines_bezier_join(CagCall *call, CagValue *result) {
  CagCurve *c;
  long m, order;
  double ratio;
  CagVec3 out[3];
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_integer_or(call, 1, 3, 0, CAG_MAX_DEGREE, &m) ||
      !cag_arg_integer_or(call, 2, 1, -1000, 1000, &order) ||
      !cag_arg_number_or(call, 3, 1, &ratio) ||
      !cag_geometry_ok(call, cag_bezier_join(c, (int)m, (int)order, ratio, out, call->err)))
    return false;
  *result = cag_points_value(call->vm, out, (size_t)order + 1, c->dimension);
  return true;
}

static CagValue number_or_none(double x) { return isnan(x) ? cag_none() : cag_number(x); }

bool cag_splines_continuity(CagCall *call, const struct cag_splines_continuity *a,
                            CagValue *result) {
  static const char *const names[] = {"class", "C0",         "C1",          "C2",
                                      "G1",    "G2",         "gap",         "angle",
                                      "ratio", "first_jump", "second_jump", "curvature_jump"};
  CagJoint j;
  if (!(a->tolerance >= 0))
    return cag_splines_fail(call, CAG_ERR_tolerance_not_positive, "tolerance", -1,
                            "the tolerance must be at least 0");
  if (!cag_geometry_ok(call, cag_curve_joint(a->C, a->D, a->tolerance, &j, call->err)))
    return false;
  CagValue values[] = {cag_text_c(call->vm, cag_joint_class(&j)),
                       cag_bool(j.c0),
                       cag_bool(j.c1),
                       cag_bool(j.c2),
                       cag_bool(j.g1),
                       cag_bool(j.g2),
                       cag_number(j.gap),
                       isnan(j.angle) ? cag_none() : cag_angle(j.angle / CAG_RADIANS_PER_DEGREE),
                       number_or_none(j.ratio),
                       cag_number(j.first_jump),
                       cag_number(j.second_jump),
                       number_or_none(j.curvature_jump)};
  *result = cag_record_new(call->vm, names, values, sizeof values / sizeof *values);
  return true;
}

// --- Lines and hulls ---

static size_t polygon_crossings(const CagCurve *curve, CagVec3 normal, double offset) {
  CagCurve *exact;
  CagNurbsView view;
  CagError err;
  if (cag_curve_to_nurbs(curve, &exact, &err)) return 0;
  size_t n = 0;
  if (cag_curve_nurbs_view(exact, &view)) {
    int last = 0;
    for (size_t i = 0; i < view.count; i++) {
      const double *h = view.homogeneous + 4 * i;
      const double d = cag_dot(normal, cag_vec3(h[0], h[1], h[2])) - offset * h[3];
      const int sign = (d > 0) - (d < 0);
      n += sign != 0 && last != 0 && sign != last;
      if (sign != 0) last = sign;
    }
  }
  cag_curve_release(exact);
  return n;
}

bool cag_splines_line_crossings(CagCall *call, const struct cag_splines_line_crossings *a,
                                CagValue *result) {
  static const char *const names[] = {"t", "points", "curve_crossings", "polygon_crossings"};
  CagMeeting *meetings;
  size_t n;
  const double square = cag_dot(a->normal.at, a->normal.at);
  if (!(square > 0))
    return cag_splines_fail(call, CAG_ERR_zero_vector, "normal", -1,
                            "the normal of a line or plane must not be the zero vector");
  const CagPlane plane = {cag_scaled(a->normal.at, a->offset / square), cag_unit(a->normal.at)};
  if (!cag_geometry_ok(call, cag_curve_intersect_plane(a->C, &plane, &meetings, &n, call->err)))
    return false;
  cag_hold_for(call, cag_free, meetings);
  CagBuilder *t = cag_builder_new(call->vm), *points = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++)
    if (!cag_builder_add(call->vm, t, cag_parameter_value(a->C->angular, meetings[i].t)) ||
        !cag_builder_add(call->vm, points, cag_point(call->vm, meetings[i].point, a->C->dimension)))
      return false;
  CagValue values[] = {cag_builder_finish(call->vm, t), cag_builder_finish(call->vm, points),
                       cag_number((double)n),
                       cag_number((double)polygon_crossings(a->C, a->normal.at, a->offset))};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_splines_hulls_disjoint(CagCall *call, const struct cag_splines_hulls_disjoint *a,
                                CagValue *result) {
  (void)call;
  *result = cag_bool(
      cag_hulls_disjoint(a->points.items, a->points.count, a->others.items, a->others.count));
  return true;
}
