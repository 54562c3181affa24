// Questions to conics, to lines by their equations, and to plane curves by their coordinates.

#include <math.h>

#include "base/memory.h"
#include "geom/basis/regression.h"
#include "geom/curve/intersect.h"
#include "interp/builtin/conics.h"
#include "interp/builtin/support.h"

// Lines whose directions differ by less than this sine are parallel; equations whose entries agree
// to this share are of one line.
#define PARALLEL 1e-12

// --- Classification ---

static CagValue angle_value(double radians) { return cag_angle(cag_degrees_shown(radians)); }

// A row of numbers, none of them -0.
static CagValue row_value(CagCall *call, const double *x, size_t n) {
  double *row;
  CagValue list = cag_list_numbers(call->vm, n, &row);
  for (size_t i = 0; i < n; i++) row[i] = x[i] + 0.0;
  return list;
}

static CagValue matrix_value(CagCall *call, const CagConic *k) {
  const double *c = k->c;
  double *m;
  const double rows[9] = {c[0],     c[1] / 2, c[3] / 2, c[1] / 2, c[2],
                          c[4] / 2, c[3] / 2, c[4] / 2, c[5]};
  CagValue list = cag_list_vectors(call->vm, 3, 3, &m);
  for (int i = 0; i < 9; i++) m[i] = rows[i] + 0.0;
  return list;
}

static CagValue lines_value(CagCall *call, const CagConicClass *k) {
  CagValue lines[2];
  for (size_t i = 0; i < k->line_count; i++) lines[i] = cag_vector(call->vm, k->lines[i], 3);
  return cag_list_values(call->vm, lines, k->line_count);
}

// Points of the conic's plane as the script sees them: in space where the plane lies there.
static CagValue plane_points(CagCall *call, const CagVec3 *p, size_t n, const CagTransform *frame) {
  CagVec3 moved[2];
  for (size_t i = 0; i < n; i++) moved[i] = frame ? cag_transform_point(frame, p[i]) : p[i];
  return cag_points_value(call->vm, moved, n, frame ? 3 : 2);
}

static CagValue plane_point(CagCall *call, CagVec3 p, const CagTransform *frame) {
  return frame ? cag_point(call->vm, cag_transform_point(frame, p), 3) : cag_point(call->vm, p, 2);
}

// The conic of a curve of the plane, or of space with the frame of its plane.
static bool read_placed_conic(CagCall *call, CagConic *out, CagTransform *frame, bool *placed) {
  const CagValue v = call->values[0];
  const CagCurve *c = v.type == CAG_CURVE ? CAG_AS_SHAPE(v)->as.curve : NULL;
  *placed = c && c->dimension == 3;
  return *placed ? cag_geometry_ok(call, cag_conic_of_space_curve(c, frame, out, call->err))
                 : cag_arg_conic(call, 0, out);
}

// The values of the text: turned by the angle that removes the xy term, then moved to the center.
static CagValue standard_value(CagCall *call, const CagConicClass *k) {
  static const char *const names[] = {"angle", "coefficients", "alpha", "beta", "kappa"};
  CagValue values[] = {angle_value(k->book_angle), cag_vector(call->vm, k->rotated, 6), cag_none(),
                       cag_none(), cag_none()};
  for (int i = 0; k->has_center && i < 3; i++) values[2 + i] = cag_number(k->standard[i]);
  return cag_record_new(call->vm, names, values, 5);
}

bool cag_conics_classify(CagCall *call, CagValue *result) {
  static const char *const names[] = {
      "class", "discriminant", "central",      "center", "vertex", "angle",    "a",      "b",
      "p",     "axes",         "eccentricity", "foci",   "lines",  "standard", "matrix", "frame"};
  CagConic conic;
  CagConicClass k;
  CagTransform place;
  bool placed;
  if (!read_placed_conic(call, &conic, &place, &placed) ||
      !cag_geometry_ok(call, cag_conic_classify(&conic, &k, call->err)))
    return false;
  const CagTransform *frame = placed ? &place : NULL;
  CagVm *vm = call->vm;
  const bool curve = k.a > 0, parabola = curve && k.eccentricity == 1, round = curve && !parabola;
  const double axes[2] = {k.a, k.b};
  CagValue values[] = {cag_text_c(vm, k.name),
                       cag_number(k.discriminant),
                       cag_bool(!parabola),
                       k.has_center ? plane_point(call, k.center, frame) : cag_none(),
                       parabola ? plane_point(call, k.center, frame) : cag_none(),
                       curve ? angle_value(k.angle) : cag_none(),
                       round ? cag_number(k.a) : cag_none(),
                       round ? cag_number(k.b) : cag_none(),
                       parabola ? cag_number(k.a) : cag_none(),
                       round ? cag_vector(vm, axes, 2) : cag_none(),
                       curve ? cag_number(k.eccentricity) : cag_none(),
                       plane_points(call, k.foci, k.focus_count, frame),
                       lines_value(call, &k),
                       standard_value(call, &k),
                       matrix_value(call, &conic),
                       placed ? cag_transform_value(vm, frame) : cag_none()};
  // Conics of the plane need no frame.
  *result = cag_record_new(vm, names, values, sizeof values / sizeof *values - (placed ? 0 : 1));
  return true;
}

bool cag_conics_coefficients(CagCall *call, CagValue *result) {
  CagConic k;
  if (!cag_arg_conic(call, 0, &k)) return false;
  *result = row_value(call, k.c, 6);
  return true;
}

// --- Lines by their equations ---

static bool check_line(CagCall *call, int argument, CagNumbers line) {
  const double *x = line.items;
  const bool finite = line.count == 3 && isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]);
  return (finite && (x[0] != 0 || x[1] != 0 || x[2] != 0)) ||
         cag_fail_value(call, argument,
                        "the 3 finite numbers [p, q, r] of a line p x + q y + r = 0, not all 0");
}

static bool check_plane_point(CagCall *call, int argument, CagPoint p) {
  return p.dimension == 2 || cag_fail_value(call, argument, "a point [x, y] of the plane");
}

bool cag_conics_line_through(CagCall *call, const struct cag_conics_line_through *a,
                             CagValue *result) {
  if (!check_plane_point(call, 0, a->P) || !check_plane_point(call, 1, a->Q)) return false;
  const CagVec3 p = a->P.at, d = cag_sub(a->Q.at, p);
  if (cag_norm(d) == 0) return cag_fail_value(call, 1, "a point that differs from the first");
  const double row[3] = {-d.y, d.x, d.y * p.x - d.x * p.y};
  *result = row_value(call, row, 3);
  return true;
}

bool cag_conics_meet_lines(CagCall *call, const struct cag_conics_meet_lines *a, CagValue *result) {
  static const char *const names[] = {"status", "point", "homogeneous"};
  if (!check_line(call, 0, a->A) || !check_line(call, 1, a->B)) return false;
  const double *p = a->A.items, *q = a->B.items;
  const double np = hypot(p[0], p[1]), nq = hypot(q[0], q[1]);
  const double x = p[1] * q[2] - p[2] * q[1], y = p[2] * q[0] - p[0] * q[2];
  const double w = p[0] * q[1] - p[1] * q[0];
  CagValue values[] = {cag_text_c(call->vm, "point"), cag_none(), cag_none()};
  if (hypot(hypot(x, y), w) <= PARALLEL * hypot(np, p[2]) * hypot(nq, q[2])) {
    values[0] = cag_text_c(call->vm, "coincident");
  } else if (fabs(w) <= PARALLEL * np * nq) {
    // The common direction as a point at infinity.
    const double ideal[3] = {x, y, 0};
    values[0] = cag_text_c(call->vm, "parallel");
    values[2] = row_value(call, ideal, 3);
  } else {
    const double h[3] = {x / w, y / w, 1};
    values[1] = row_value(call, h, 2);
    values[2] = row_value(call, h, 3);
  }
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_conics_line_image(CagCall *call, const struct cag_conics_line_image *a, CagValue *result) {
  static const int place[3] = {0, 1, 3};
  double image[3] = {0};
  CagTransform back;
  if (!check_line(call, 0, a->A)) return false;
  if (!a->T.planar)
    return cag_fail_call(call, 1, CAG_ERR_value,
                         "expects a transform of the plane: rotate(30deg), translate([1, 2]), ...");
  if (!cag_geometry_ok(call, cag_transform_inverse(&a->T, &back, call->err))) return false;
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 3; i++) image[j] += a->A.items[i] * back.m[place[i]][place[j]];
  *result = row_value(call, image, 3);
  return true;
}

// --- Lines and conics ---

bool cag_conics_intersect_line(CagCall *call, const struct cag_conics_intersect_line *a,
                               CagValue *result) {
  static const char *const names[] = {"status", "points"};
  static const char *const words[] = {"none", "one", "tangent", "two", "within"};
  static const size_t counts[] = {0, 1, 1, 2, 0};
  CagConic k;
  CagPoint p;
  CagVec3 d, points[2];
  CagLineConic kind;
  double t[2];
  if (!cag_arg_conic(call, 0, &k)) return false;
  if (cag_given(call, 2)) {
    if (!cag_arg_vec(call, 1, &p.at, &p.dimension) || !check_plane_point(call, 1, p) ||
        !check_plane_point(call, 2, a->Q))
      return false;
    d = cag_sub(a->Q.at, p.at);
  } else {
    CagNumbers line;
    if (!cag_arg_numbers(call, 1, &line.items, &line.count) || !check_line(call, 1, line))
      return false;
    const double *row = line.items, nn = row[0] * row[0] + row[1] * row[1];
    if (nn == 0)
      return cag_fail_value(call, 1, "a line that is not at infinity: p or q must not be 0");
    p.at = cag_vec3(-row[2] * row[0] / nn, -row[2] * row[1] / nn, 0);
    d = cag_vec3(-row[1], row[0], 0);
  }
  if (!cag_geometry_ok(call, cag_conic_line(&k, p.at, d, &kind, t, call->err))) return false;
  for (size_t i = 0; i < counts[kind]; i++) points[i] = cag_madd(p.at, t[i], d);
  CagValue values[] = {cag_text_c(call->vm, words[kind]),
                       cag_points_value(call->vm, points, counts[kind], 2)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_conics_polar_line(CagCall *call, const struct cag_conics_polar_line *a, CagValue *result) {
  CagConic k;
  double row[3];
  if (!cag_arg_conic(call, 0, &k) || !check_plane_point(call, 1, a->P)) return false;
  cag_conic_polar(&k, a->P.at, row);
  *result = row_value(call, row, 3);
  return true;
}

bool cag_conics_implicit_at(CagCall *call, const struct cag_conics_implicit_at *a,
                            CagValue *result) {
  static const char *const names[] = {"value", "gradient", "slope", "curvature", "radius"};
  CagConic k;
  double line[3];
  if (!cag_arg_conic(call, 0, &k) || !check_plane_point(call, 1, a->P)) return false;
  cag_conic_polar(&k, a->P.at, line);
  const double fx = 2 * line[0], fy = 2 * line[1], n = hypot(fx, fy);
  if (n == 0)
    return cag_fail_core(call, CAG_E_DEGENERATE, CAG_ERR_singular_point, "", -1,
                         "the gradient is zero here: a singular point without slope and curvature");
  const double bend = 2 * k.c[0] * fy * fy - 2 * k.c[1] * fx * fy + 2 * k.c[2] * fx * fx;
  const double curvature = fabs(bend) / (n * n * n), gradient[2] = {fx, fy};
  CagValue values[] = {cag_number(cag_conic_value(&k, a->P.at) + 0.0), row_value(call, gradient, 2),
                       fy == 0 ? cag_none() : cag_number(-fx / fy + 0.0), cag_number(curvature),
                       curvature == 0 ? cag_none() : cag_number(1 / curvature)};
  *result = cag_record_new(call->vm, names, values, 5);
  return true;
}

bool cag_conics_point_of_conic(CagCall *call, const struct cag_conics_point_of_conic *a,
                               CagValue *result) {
  CagConic k;
  CagVec3 p;
  if (!cag_arg_conic(call, 0, &k) ||
      !cag_geometry_ok(call, cag_conic_point_at(&k, a->x, a->branch, &p, call->err)))
    return false;
  *result = cag_point(call->vm, p, 2);
  return true;
}

// --- Plane curves by their coordinates ---

static bool check_plane_curve(CagCall *call, const CagCurve *c) {
  return c->dimension == 2 ||
         cag_fail_call(call, 0, CAG_ERR_value, "expects a curve of the plane, with points [x, y]");
}

bool cag_conics_points_at(CagCall *call, const struct cag_conics_points_at *a, CagValue *result) {
  static const char *const names[] = {"t", "point"};
  CagMeeting *meetings;
  size_t n;
  const bool x = cag_given(call, 1);
  if (!check_plane_curve(call, a->C)) return false;
  if (x == cag_given(call, 2))
    return cag_fail_call(call, -1, CAG_ERR_value, "needs either `x` or `y`");
  // One of x and y is given, the other is 0.
  const CagPlane plane = {cag_vec3(a->x, a->y, 0), cag_vec3(x, !x, 0)};
  if (!cag_geometry_ok(call, cag_curve_intersect_plane(a->C, &plane, &meetings, &n, call->err)))
    return false;
  cag_hold_for(call, cag_free, meetings);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    CagValue values[] = {cag_parameter_value(a->C->angular, meetings[i].t),
                         cag_point(call->vm, meetings[i].point, 2)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 2))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

static bool derivatives_at(CagCall *call, const CagCurve *c, CagVec3 out[3]) {
  double t;
  return check_plane_curve(call, c) && cag_arg_at(call, c, &t) &&
         cag_geometry_ok(call, cag_curve_eval(c, t, 2, CAG_SIDE_RIGHT, out, call->err));
}

bool cag_conics_slope(CagCall *call, const struct cag_conics_slope *a, CagValue *result) {
  CagVec3 d[3];
  if (!derivatives_at(call, a->C, d)) return false;
  const double vertical = 1e-15; // what is left of a zero by rounding
  *result =
      fabs(d[1].x) <= vertical * fabs(d[1].y) ? cag_none() : cag_number(d[1].y / d[1].x + 0.0);
  return true;
}

bool cag_conics_signed_curvature(CagCall *call, const struct cag_conics_signed_curvature *a,
                                 CagValue *result) {
  CagVec3 d[3];
  if (!derivatives_at(call, a->C, d)) return false;
  const double n = cag_norm(d[1]);
  if (n == 0)
    return cag_fail_core(call, CAG_E_DEGENERATE, CAG_ERR_curvature_undefined, "t", -1,
                         "the derivative vanishes here: there is no curvature");
  *result = cag_number((d[1].x * d[2].y - d[1].y * d[2].x) / (n * n * n) + 0.0);
  return true;
}

// --- Formulas through points ---

#define DEGREE_MAX 30 // as the row of fit_formula says

bool cag_conics_fit_formula(CagCall *call, const struct cag_conics_fit_formula *a,
                            CagValue *result) {
  static const char *const names[] = {"coefficients", "a", "b", "residual_sum_of_squares"};
  const size_t n = a->points.count;
  double out[DEGREE_MAX + 1], residual;
  double *x = cag_hold_array(call, n, sizeof *x), *y = cag_hold_array(call, n, sizeof *y);
  for (size_t i = 0; i < n; i++) {
    x[i] = a->points.items[i].x;
    y[i] = a->points.items[i].y;
  }
  CagStatus status =
      cag_fit_formula(x, y, n, (CagModel)a->model, (int)a->degree, out, &residual, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  const bool two = a->model != CAG_MODEL_POLYNOMIAL;
  CagValue values[] = {cag_vector(call->vm, out, two ? 2 : (size_t)a->degree + 1),
                       two ? cag_number(out[0]) : cag_none(), two ? cag_number(out[1]) : cag_none(),
                       cag_number(residual)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}
