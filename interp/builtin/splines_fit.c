// B-splines from data: interpolation, least squares, and its report.

#include "base/memory.h"
#include "geom/curve/fit.h"
#include "interp/builtin/splines.h"
#include "interp/builtin/support.h"

bool cag_splines_data_parameters(CagCall *call, const struct cag_splines_data_parameters *a,
                                 CagValue *result) {
  const CagVec3 *points = a->points.items;
  double sum = 0, *out;
  if (!cag_splines_check_points(call, 0, &a->points)) return false;
  *result = cag_list_numbers(call->vm, a->points.count, &out);
  for (size_t i = 0; i < a->points.count; i++) {
    double step = i == 0 ? 0 : 1;
    if (i > 0 && a->by != CAG_SPACING_UNIFORM) step = cag_norm(cag_sub(points[i], points[i - 1]));
    out[i] = sum += a->by == CAG_SPACING_CENTRIPETAL ? sqrt(step) : step;
  }
  return isfinite(sum) || cag_splines_fail(call, CAG_ERR_not_finite, "points", -1,
                                           "the distances of the points overflow");
}

static bool read_knots(CagCall *call, int argument, CagFitData *d, size_t count) {
  static const char *const names[] = {"auto", "open", "averaged", NULL};
  const CagType type = call->values[argument].type;
  if (type != CAG_LIST && type != CAG_RANGE) {
    int choice;
    if (!cag_arg_choice(call, argument, names, &choice)) return false;
    d->kind = (CagFitKnots)choice;
    return true;
  }
  size_t given;
  d->kind = CAG_FIT_GIVEN;
  if (!cag_arg_numbers(call, argument, &d->knots, &given)) return false;
  const size_t wanted = count + (size_t)d->degree + 1;
  if (given == wanted) return true;
  return cag_splines_fail(call, CAG_ERR_knot_count, "knots", -1,
                          "%zu control points of degree %d need %zu `knots` (count + degree + 1), "
                          "found %zu",
                          count, d->degree, wanted, given);
}

// Reads the arguments that both have in common, except the knots. The parameters are held.
static bool read_data(CagCall *call, const CagPoints *points, int degree, int order, int parameters,
                      CagFitData *d) {
  double *own;
  *d = (CagFitData){.points = points->items, .n = points->count, .dimension = points->dimension};
  if (!cag_arg_degree(call, degree, order, 3, &d->degree) ||
      !cag_splines_check_points(call, 0, points) ||
      !cag_splines_parameters(call, parameters, CAG_SPACING_CHORD, d->n, &d->spacing, &own))
    return false;
  d->parameters = own;
  return true;
}

// Reads {second: [V, W]}.
static bool read_second(CagCall *call, int argument, int dimension, CagVec3 second[2]) {
  const CagValue v = call->values[argument];
  const CagValue both =
      v.type == CAG_RECORD ? cag_record_get(CAG_AS_RECORD(v), "second") : cag_unset();
  if (both.type != CAG_LIST || CAG_AS_LIST(both)->length != 2)
    return cag_fail_value(call, argument,
                          "\"natural\", \"not-a-knot\", \"periodic\", or {second: [V, W]}");
  for (size_t i = 0; i < 2; i++) {
    const double *x;
    size_t n;
    if (!cag_as_vector(cag_list_get(call->vm, CAG_AS_LIST(both), i), &x, &n))
      return cag_fail_value(call, argument, "a list of two vectors as `second`");
    if ((int)n != dimension)
      return cag_splines_fail(call, CAG_ERR_dimension_mismatch, "ends", -1,
                              "the points have %d numbers, but second[%zu] has %zu", dimension, i,
                              n);
    second[i] = cag_vec3(x[0], x[1], n > 2 ? x[2] : 0);
    if (!isfinite(cag_norm(second[i])))
      return cag_splines_fail(call, CAG_ERR_not_finite, "ends", -1,
                              "second[%zu] has a number that is not finite", i);
  }
  return true;
}

// Conditions at the ends exclude what would determine the curve otherwise.
static bool check_ends_alone(CagCall *call, const CagFitData *d) {
  if (d->degree != 3)
    return cag_fail_call(call, 6, CAG_ERR_value, "with `ends` makes cubics; omit the degree %d",
                         d->degree);
  if (cag_given(call, 3) || cag_given(call, 4))
    return cag_fail_call(call, 6, CAG_ERR_value, "takes `ends` or `%s`, not both",
                         cag_given(call, 3) ? "tangents" : "knots");
  return true;
}

static bool interpolate_ends(CagCall *call, const CagFitData *d, CagValue *result) {
  static const char *const names[] = {"natural", "not-a-knot", "periodic", NULL};
  CagVec3 second[2];
  CagCurve *c = NULL;
  int ends = CAG_FIT_SECOND;
  if (!check_ends_alone(call, d)) return false;
  if (call->values[6].type == CAG_TEXT ? !cag_arg_choice(call, 6, names, &ends)
                                       : !read_second(call, 6, d->dimension, second))
    return false;
  CagStatus status = cag_curve_interpolate_ends(d, (CagFitEnds)ends, second, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_splines_interpolate(CagCall *call, const struct cag_splines_interpolate *a,
                             CagValue *result) {
  CagFitData d;
  CagPoints tangents = {0};
  CagCurve *c = NULL;
  if (!read_data(call, &a->points, 1, 5, 2, &d)) return false;
  if (cag_given(call, 6)) return interpolate_ends(call, &d, result);
  if ((cag_given(call, 3) && !cag_splines_tangents(call, 3, d.dimension, &tangents)) ||
      !read_knots(call, 4, &d, d.n + tangents.count))
    return false;
  CagStatus status = cag_curve_interpolate(&d, tangents.items, tangents.count, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// fit(points, degree = 3, count = degree + 1, parameters = "chord", fixed = "ends", knots = "auto",
//     error = 1e-9, order = none)
static bool fit(CagCall *call, CagFitReport *report, CagPoints *points, CagCurve **out) {
  static const char *const names[] = {"ends", "none", "x", "y", "z", NULL};
  CagFitData d;
  int fixed;
  long count;
  double slack;
  if (!cag_arg_choice(call, 4, names, &fixed) || !cag_arg_number_or(call, 6, 1e-9, &slack) ||
      !cag_arg_points(call, 0, &points->items, &points->count, &points->dimension))
    return false;
  cag_hold(call, points->items);
  if (!read_data(call, points, 1, 7, 3, &d) ||
      !cag_arg_integer_or(call, 2, d.degree + 1L, 1, 100000000, &count))
    return false;
  if (!(slack >= 0))
    return cag_splines_fail(call, CAG_ERR_bad_parameter, "error", -1,
                            "the allowed error must be at least 0");
  // With too many control points, the error is about their number, not that of the knots.
  if ((size_t)count <= d.n && !read_knots(call, 5, &d, (size_t)count)) return false;
  CagStatus status = cag_curve_fit(&d, (size_t)count, fixed == 0, fixed >= 2 ? fixed - 2 : -1,
                                   slack, out, report, call->err);
  return cag_geometry_ok(call, status);
}

bool cag_splines_fit(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagPoints points;
  if (!fit(call, NULL, &points, &c)) return false;
  *result = cag_curve_value(call->vm, c);
  return true;
}

// Whether the data are rows of points, to be fitted by a surface.
static bool is_grid(CagCall *call) {
  CagValue v = call->values[0];
  for (int level = 0; level < 2; level++) {
    if (v.type != CAG_LIST || CAG_AS_LIST(v)->length == 0) return false;
    v = cag_list_get(call->vm, CAG_AS_LIST(v), 0);
  }
  return v.type == CAG_LIST;
}

// Reports on fitting a surface. Only the arguments that curves and surfaces have in common are
// allowed.
static bool report_surface(CagCall *call, CagValue *result) {
  size_t rows;
  const CagBuiltin *row = cag_builtin_rows(cag_builtin_find("fit_surface_report"), &rows);
  CagValue *given = call->values, unset = cag_unset();
  CagValue values[] = {given[0], given[1], given[2], given[3], given[5],
                       unset,    unset,    given[4], unset,    given[6]};
  CagCall other = {call->vm, row, values, sizeof values / sizeof *values, call->err};
  if (given[2].type == CAG_UNSET)
    return cag_fail_call(call, 2, CAG_ERR_arity,
                         "of rows of points expects a `count` of two numbers, for u and v");
  if (cag_given(call, 7))
    return cag_fail_call(call, 7, CAG_ERR_value,
                         "of rows of points takes a degree, not an `order`");
  return row->function(&other, result);
}

static void free_report(void *report) { cag_fit_report_free(report); }

bool cag_splines_fit_report(CagCall *call, CagValue *result) {
  if (is_grid(call)) return report_surface(call, result);
  static const char *const names[] = {"curve", "parameters", "residuals",
                                      "rms",   "largest",    "rounds"};
  CagCurve *c;
  CagFitReport *report = cag_hold_array(call, 1, sizeof *report);
  cag_hold_for(call, free_report, report);
  CagPoints points;
  if (!fit(call, report, &points, &c)) return false;
  CagValue values[] = {
      cag_curve_value(call->vm, c),
      cag_numbers_value(call->vm, report->parameters, points.count),
      cag_points_value(call->vm, report->residuals, points.count, points.dimension),
      cag_number(report->rms),
      cag_number(report->largest),
      cag_number(report->rounds)};
  *result = cag_record_new(call->vm, names, values, 6);
  return true;
}
