// B-splines from data: interpolation, least squares and its report.

#include "base/memory.h"
#include "geom/curve/fit.h"
#include "interp/builtin/splines.h"
#include "interp/builtin/support.h"

// data_parameters(points, by = "chord")
bool cag_splines_data_parameters(CagCall *call, CagValue *result) {
  static const char *const names[] = {"chord", "uniform", "centripetal", NULL};
  CagVec3 *points;
  size_t n;
  int dimension, choice;
  double *out;
  if (!cag_arg_choice(call, 1, names, &choice) ||
      !cag_splines_points(call, 0, &points, &n, &dimension))
    return false;
  cag_hold(call, points);
  *result = cag_list_numbers(call->vm, n, &out);
  double sum = 0;
  for (size_t i = 0; i < n; i++) {
    double step = i == 0 ? 0 : 1;
    if (i > 0 && choice != CAG_SPACING_UNIFORM) step = cag_norm(cag_sub(points[i], points[i - 1]));
    out[i] = sum += choice == CAG_SPACING_CENTRIPETAL ? sqrt(step) : step;
  }
  if (isfinite(sum)) return true;
  return cag_splines_fail(call, CAG_ERR_not_finite, "points", -1,
                          "the distances of the points overflow");
}

static bool read_knots(CagCall *call, int argument, CagFitData *d, size_t count) {
  static const char *const names[] = {"auto", "open", "averaged", NULL};
  const CagType type = cag_given(call, argument) ? call->values[argument].type : CAG_UNSET;
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

// What both read, except the knots. The arrays are held.
static bool read_data(CagCall *call, int degree, int order, int parameters, CagFitData *d) {
  CagVec3 *points;
  double *own;
  *d = (CagFitData){0};
  if (!cag_arg_degree(call, degree, order, 3, &d->degree) ||
      !cag_splines_points(call, 0, &points, &d->n, &d->dimension))
    return false;
  d->points = cag_hold(call, points);
  if (!cag_splines_parameters(call, parameters, CAG_SPACING_CHORD, d->n, &d->spacing, &own))
    return false;
  cag_hold_for(call, cag_free, own);
  d->parameters = own;
  return true;
}

// interpolate(points, degree = 3, parameters = "chord", tangents = none, knots = "auto",
//             order = none)
bool cag_splines_interpolate(CagCall *call, CagValue *result) {
  CagFitData d;
  CagVec3 *tangents = NULL;
  size_t count = 0;
  int dimension;
  CagCurve *c = NULL;
  if (!read_data(call, 1, 5, 2, &d) ||
      (cag_given(call, 3) && !cag_splines_points(call, 3, &tangents, &count, &dimension)))
    return false;
  cag_hold_for(call, cag_free, tangents);
  if (tangents && dimension != d.dimension)
    return cag_splines_fail(call, CAG_ERR_dimension_mismatch, "tangents", -1,
                            "the points have %d numbers, the tangents %d", d.dimension, dimension);
  if (!read_knots(call, 4, &d, d.n + count)) return false;
  CagStatus status = cag_curve_interpolate(&d, tangents, count, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// fit(points, degree = 3, count = degree + 1, parameters = "chord", fixed = "ends", knots = "auto",
//     error = 1e-9, order = none)
static bool fit(CagCall *call, CagFitReport *report, size_t *n, int *dimension, CagCurve **out) {
  static const char *const names[] = {"ends", "none", "x", "y", "z", NULL};
  CagFitData d;
  int fixed;
  long count;
  double slack;
  if (!cag_arg_choice(call, 4, names, &fixed) || !cag_arg_number_or(call, 6, 1e-9, &slack) ||
      !read_data(call, 1, 7, 3, &d) ||
      !cag_arg_integer_or(call, 2, d.degree + 1L, 1, 100000000, &count))
    return false;
  if (!(slack >= 0))
    return cag_splines_fail(call, CAG_ERR_bad_parameter, "error", -1,
                            "the error that is allowed is 0 or more");
  // Too many control points are told as that, not as the wrong number of knots.
  if ((size_t)count <= d.n && !read_knots(call, 5, &d, (size_t)count)) return false;
  *n = d.n;
  *dimension = d.dimension;
  CagStatus status = cag_curve_fit(&d, (size_t)count, fixed == 0, fixed >= 2 ? fixed - 2 : -1,
                                   slack, out, report, call->err);
  return cag_geometry_ok(call, status);
}

bool cag_splines_fit(CagCall *call, CagValue *result) {
  CagCurve *c;
  size_t n;
  int dimension;
  if (!fit(call, NULL, &n, &dimension, &c)) return false;
  *result = cag_curve_value(call->vm, c);
  return true;
}

// Whether the data are rows of points, which are fitted by a surface.
static bool is_grid(CagCall *call) {
  CagValue v = call->values[0];
  for (int level = 0; level < 2; level++) {
    if (v.type != CAG_LIST || CAG_AS_LIST(v)->length == 0) return false;
    v = cag_list_get(call->vm, CAG_AS_LIST(v), 0);
  }
  return v.type == CAG_LIST;
}

// The same question of a grid, with what both have: the ends are those of curves alone.
static bool report_surface(CagCall *call, CagValue *result) {
  size_t rows;
  const CagBuiltin *row = cag_builtin_rows(cag_builtin_find("fit_surface_report"), &rows);
  CagValue *given = call->values, unset = cag_unset();
  CagValue values[] = {given[0], given[1], given[2], given[3], given[5],
                       unset,    unset,    given[4], unset,    given[6]};
  CagCall other = {call->vm, row, values, sizeof values / sizeof *values, call->err};
  if (given[2].type == CAG_UNSET)
    return cag_fail_call(call, 2, CAG_ERR_arity,
                         "of rows of points expects a `count`, two for u and v");
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
  size_t n = 0;
  int dimension = 0;
  if (!fit(call, report, &n, &dimension, &c)) return false;
  const CagValue curve = cag_curve_value(call->vm, c);
  CagValue values[] = {curve,
                       cag_numbers_value(call->vm, report->parameters, n),
                       cag_points_value(call->vm, report->residuals, n, dimension),
                       cag_number(report->rms),
                       cag_number(report->largest),
                       cag_number(report->rounds)};
  *result = cag_record_new(call->vm, names, values, 6);
  return true;
}
