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

static CagValue row_value(CagCall *call, const double *x, size_t n) {
  return cag_vector(call->vm, x, n);
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
  for (size_t i = 0; i < k->line_count; i++) lines[i] = row_value(call, k->lines[i], 3);
  return cag_list_values(call->vm, lines, k->line_count);
}

// The values of the text: turned by the angle that removes the xy term, then moved to the center.
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
  CagCurve *c;
  *placed =
      call->values[0].type == CAG_CURVE && CAG_AS_SHAPE(call->values[0])->as.curve->dimension == 3;
  if (!*placed) return cag_arg_conic(call, 0, out);
  return cag_arg_curve(call, 0, &c) &&
         cag_geometry_ok(call, cag_conic_of_space_curve(c, frame, out, call->err));
}

static CagValue standard_value(CagCall *call, const CagConicClass *k) {
  static const char *const names[] = {"angle", "coefficients", "alpha", "beta", "kappa"};
  CagValue values[] = {angle_value(k->book_angle), row_value(call, k->rotated, 6), cag_none(),
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
                       round ? row_value(call, axes, 2) : cag_none(),
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
  for (int i = 0; i < 6; i++) k.c[i] += 0.0;
  *result = row_value(call, k.c, 6);
  return true;
}

// --- Lines by their equations ---

static bool read_row(CagCall *call, int argument, double row[3]) {
  const double *x;
  size_t n;
  if (!cag_arg_numbers(call, argument, &x, &n)) return false;
  bool finite = n == 3 && isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]);
  if (!finite || (x[0] == 0 && x[1] == 0 && x[2] == 0))
    return cag_fail_value(call, argument,
                          "the 3 finite numbers [p, q, r] of a line p x + q y + r = 0, not all 0");
  for (int i = 0; i < 3; i++) row[i] = x[i];
  return true;
}

static bool read_plane_point(CagCall *call, int argument, CagVec3 *p) {
  int dimension;
  if (!cag_arg_vec(call, argument, p, &dimension)) return false;
  return dimension == 2 || cag_fail_value(call, argument, "a point [x, y] of the plane");
}

bool cag_conics_line_through(CagCall *call, CagValue *result) {
  CagVec3 p, q;
  if (!read_plane_point(call, 0, &p) || !read_plane_point(call, 1, &q)) return false;
  const CagVec3 d = cag_sub(q, p);
  if (cag_norm(d) == 0)
    return cag_fail_value(call, 1, "another point than the first: one point is on many lines");
  const double row[3] = {-d.y + 0.0, d.x, d.y * p.x - d.x * p.y + 0.0};
  *result = row_value(call, row, 3);
  return true;
}

bool cag_conics_meet_lines(CagCall *call, CagValue *result) {
  static const char *const names[] = {"status", "point", "homogeneous"};
  double a[3] = {0}, b[3] = {0};
  if (!read_row(call, 0, a) || !read_row(call, 1, b)) return false;
  const double na = hypot(a[0], a[1]), nb = hypot(b[0], b[1]);
  const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
  const double w = a[0] * b[1] - a[1] * b[0];
  CagValue values[] = {cag_text_c(call->vm, "point"), cag_none(), cag_none()};
  const double size_a = hypot(na, a[2]), size_b = hypot(nb, b[2]);
  if (hypot(hypot(x, y), w) <= PARALLEL * size_a * size_b) {
    values[0] = cag_text_c(call->vm, "coincident");
  } else if (fabs(w) <= PARALLEL * na * nb) {
    // The common direction as a point at infinity.
    const double ideal[3] = {x + 0.0, y + 0.0, 0};
    values[0] = cag_text_c(call->vm, "parallel");
    values[2] = row_value(call, ideal, 3);
  } else {
    const double h[3] = {x / w + 0.0, y / w + 0.0, 1};
    values[1] = row_value(call, h, 2);
    values[2] = row_value(call, h, 3);
  }
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_conics_line_image(CagCall *call, CagValue *result) {
  static const int place[3] = {0, 1, 3};
  double row[3] = {0}, image[3] = {0};
  CagTransform t, back;
  if (!read_row(call, 0, row) || !cag_arg_transform(call, 1, &t)) return false;
  if (!t.planar)
    return cag_fail_call(call, 1, CAG_ERR_value,
                         "expects a transform of the plane: rotate(30deg), translate([1, 2]), ...");
  if (!cag_geometry_ok(call, cag_transform_inverse(&t, &back, call->err))) return false;
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 3; i++) image[j] += row[i] * back.m[place[i]][place[j]];
  for (int j = 0; j < 3; j++) image[j] += 0.0;
  *result = row_value(call, image, 3);
  return true;
}

// --- Lines and conics ---

bool cag_conics_intersect_line(CagCall *call, CagValue *result) {
  static const char *const names[] = {"status", "points"};
  static const char *const words[] = {"none", "one", "tangent", "two", "within"};
  static const size_t counts[] = {0, 1, 1, 2, 0};
  CagConic k;
  CagVec3 p, q, points[2];
  CagLineConic kind;
  double row[3] = {0}, t[2];
  if (!cag_arg_conic(call, 0, &k)) return false;
  if (cag_given(call, 2)) {
    if (!read_plane_point(call, 1, &p) || !read_plane_point(call, 2, &q)) return false;
    q = cag_sub(q, p);
  } else {
    if (!read_row(call, 1, row)) return false;
    const double nn = row[0] * row[0] + row[1] * row[1];
    if (nn == 0) return cag_fail_value(call, 1, "a line at a finite place: p or q must not be 0");
    p = cag_vec3(-row[2] * row[0] / nn, -row[2] * row[1] / nn, 0);
    q = cag_vec3(-row[1], row[0], 0);
  }
  if (!cag_geometry_ok(call, cag_conic_line(&k, p, q, &kind, t, call->err))) return false;
  for (size_t i = 0; i < counts[kind]; i++) points[i] = cag_madd(p, t[i], q);
  CagValue values[] = {cag_text_c(call->vm, words[kind]),
                       cag_points_value(call->vm, points, counts[kind], 2)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_conics_polar_line(CagCall *call, CagValue *result) {
  CagConic k;
  CagVec3 p;
  double row[3];
  if (!cag_arg_conic(call, 0, &k) || !read_plane_point(call, 1, &p)) return false;
  cag_conic_polar(&k, p, row);
  for (int i = 0; i < 3; i++) row[i] += 0.0;
  *result = row_value(call, row, 3);
  return true;
}

bool cag_conics_implicit_at(CagCall *call, CagValue *result) {
  static const char *const names[] = {"value", "gradient", "slope", "curvature", "radius"};
  CagConic k;
  CagVec3 p;
  double line[3];
  if (!cag_arg_conic(call, 0, &k) || !read_plane_point(call, 1, &p)) return false;
  cag_conic_polar(&k, p, line);
  const double fx = 2 * line[0], fy = 2 * line[1], n = hypot(fx, fy);
  if (n == 0) {
    cag_fail(call->err, CAG_E_DEGENERATE, CAG_ERR_singular_point, "", -1,
             "the gradient is zero here: a singular point without slope and curvature");
    return cag_fail_geometry(call, call->err);
  }
  const double bend = 2 * k.c[0] * fy * fy - 2 * k.c[1] * fx * fy + 2 * k.c[2] * fx * fx;
  const double curvature = fabs(bend) / (n * n * n), gradient[2] = {fx + 0.0, fy + 0.0};
  CagValue values[] = {cag_number(cag_conic_value(&k, p) + 0.0), row_value(call, gradient, 2),
                       fy == 0 ? cag_none() : cag_number(-fx / fy + 0.0), cag_number(curvature),
                       curvature == 0 ? cag_none() : cag_number(1 / curvature)};
  *result = cag_record_new(call->vm, names, values, 5);
  return true;
}

bool cag_conics_point_of_conic(CagCall *call, CagValue *result) {
  static const char *const sides[] = {"lower", "upper", NULL};
  CagConic k;
  CagVec3 p;
  double x;
  int upper;
  if (!cag_arg_conic(call, 0, &k) || !cag_arg_finite(call, 1, &x) ||
      !cag_arg_choice(call, 2, sides, &upper) ||
      !cag_geometry_ok(call, cag_conic_point_at(&k, x, upper, &p, call->err)))
    return false;
  *result = cag_point(call->vm, p, 2);
  return true;
}

// --- Plane curves by their coordinates ---

static bool read_plane_curve(CagCall *call, CagCurve **c) {
  if (!cag_arg_curve(call, 0, c)) return false;
  return (*c)->dimension == 2 ||
         cag_fail_call(call, 0, CAG_ERR_value, "expects a curve of the plane, with points [x, y]");
}

bool cag_conics_points_at(CagCall *call, CagValue *result) {
  static const char *const names[] = {"t", "point"};
  CagCurve *c;
  CagMeeting *meetings;
  CagPlane plane;
  size_t n;
  double value;
  const bool x = cag_given(call, 1);
  if (!read_plane_curve(call, &c)) return false;
  if (x == cag_given(call, 2))
    return cag_fail_call(call, -1, CAG_ERR_value, "needs one of `x` and `y`");
  if (!cag_arg_finite(call, x ? 1 : 2, &value)) return false;
  plane.point = x ? cag_vec3(value, 0, 0) : cag_vec3(0, value, 0);
  plane.normal = x ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  if (!cag_geometry_ok(call, cag_curve_intersect_plane(c, &plane, &meetings, &n, call->err)))
    return false;
  cag_hold_for(call, cag_free, meetings);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    CagValue values[] = {cag_parameter_value(c->angular, meetings[i].t),
                         cag_point(call->vm, meetings[i].point, 2)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 2))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

static bool read_derivatives(CagCall *call, CagVec3 out[3]) {
  CagCurve *c;
  double t;
  return read_plane_curve(call, &c) &&
         cag_arg_parameter(call, 1, c->angular, c->start, c->end, false, &t) &&
         cag_geometry_ok(call, cag_curve_eval(c, t, 2, CAG_SIDE_RIGHT, out, call->err));
}

bool cag_conics_slope(CagCall *call, CagValue *result) {
  CagVec3 d[3];
  if (!read_derivatives(call, d)) return false;
  const double vertical = 1e-15; // what is left of a zero by rounding
  *result =
      fabs(d[1].x) <= vertical * fabs(d[1].y) ? cag_none() : cag_number(d[1].y / d[1].x + 0.0);
  return true;
}

bool cag_conics_signed_curvature(CagCall *call, CagValue *result) {
  CagVec3 d[3];
  if (!read_derivatives(call, d)) return false;
  const double n = cag_norm(d[1]);
  if (n == 0) {
    cag_fail(call->err, CAG_E_DEGENERATE, CAG_ERR_curvature_undefined, "t", -1,
             "the derivative vanishes here: there is no curvature");
    return cag_fail_geometry(call, call->err);
  }
  *result = cag_number((d[1].x * d[2].y - d[1].y * d[2].x) / (n * n * n) + 0.0);
  return true;
}

// --- Formulas through points ---

#define DEGREE_MAX 30

bool cag_conics_fit_formula(CagCall *call, CagValue *result) {
  static const char *const models[] = {"polynomial", "power", "exponential", NULL};
  static const char *const names[] = {"coefficients", "a", "b", "residual_sum_of_squares"};
  CagVec3 *points;
  size_t n;
  long degree;
  int model, dimension;
  double out[DEGREE_MAX + 1], residual;
  if (!cag_arg_choice(call, 1, models, &model) ||
      !cag_arg_integer_or(call, 2, 1, 0, DEGREE_MAX, &degree) ||
      !cag_arg_points(call, 0, &points, &n, &dimension))
    return false;
  cag_hold(call, points);
  double *x = cag_hold_array(call, n, sizeof *x), *y = cag_hold_array(call, n, sizeof *y);
  for (size_t i = 0; i < n; i++) {
    x[i] = points[i].x;
    y[i] = points[i].y;
  }
  CagStatus status =
      cag_fit_formula(x, y, n, (CagModel)model, (int)degree, out, &residual, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  const bool two = model != CAG_MODEL_POLYNOMIAL;
  CagValue values[] = {row_value(call, out, two ? 2 : (size_t)degree + 1),
                       two ? cag_number(out[0]) : cag_none(), two ? cag_number(out[1]) : cag_none(),
                       cag_number(residual)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}
