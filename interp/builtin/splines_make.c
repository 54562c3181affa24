// Hermite curves, cubic splines with their end conditions, parabolic blends, polynomials.

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "interp/builtin/splines.h"
#include "interp/builtin/support.h"

// --- Shared ---

bool cag_splines_fail(CagCall *call, CagErrorId id, const char *argument, long index,
                      const char *format, ...) {
  char message[sizeof call->err->message];
  va_list list;
  va_start(list, format);
  vsnprintf(message, sizeof message, format, list);
  va_end(list);
  cag_fail(call->err, CAG_E_ARGUMENT, id, argument, index, "%s", message);
  return cag_fail_geometry(call, call->err);
}

bool cag_splines_points(CagCall *call, int argument, CagVec3 **out, size_t *n, int *dimension) {
  if (!cag_arg_points(call, argument, out, n, dimension)) return false;
  const CagList *list = CAG_AS_LIST(call->values[argument]);
  if ((int)list->dim == *dimension) return true;
  // Lists of points of one dimension are packed: here one is different.
  const double *x;
  size_t first = 0, size = 0;
  for (size_t i = 0; i < list->length; i++) {
    cag_as_vector(cag_list_get(call->vm, list, i), &x, &size);
    if (i == 0) first = size;
    else if (size != first) {
      cag_free(*out);
      return cag_splines_fail(
          call, CAG_ERR_dimension_mismatch, cag_parameter_name(call, argument), (long)i,
          "the points are of the plane or of space, not both: %s[0] has %zu "
          "numbers and %s[%zu] has %zu",
          cag_parameter_name(call, argument), first, cag_parameter_name(call, argument), i, size);
    }
  }
  return true;
}

bool cag_splines_check_dimension(CagCall *call, int argument, CagPoint p, int dimension) {
  return p.dimension == dimension ||
         cag_splines_fail(call, CAG_ERR_dimension_mismatch, cag_parameter_name(call, argument), -1,
                          "the points have %d numbers, this vector has %d", dimension, p.dimension);
}

bool cag_splines_parameters(CagCall *call, int argument, CagSpacing otherwise, size_t n,
                            CagSpacing *spacing, double **own) {
  static const char *const names[] = {"chord", "uniform", "centripetal", NULL};
  *own = NULL;
  *spacing = otherwise;
  if (!cag_given(call, argument)) return true;
  const CagType type = call->values[argument].type;
  if (type != CAG_LIST && type != CAG_RANGE) {
    int choice;
    if (!cag_arg_choice(call, argument, names, &choice)) return false;
    *spacing = (CagSpacing)choice;
    return true;
  }
  const double *x;
  size_t count;
  char text[32];
  if (!cag_arg_numbers(call, argument, &x, &count)) return false;
  if (count != n && count + 1 != n)
    return cag_splines_fail(call, CAG_ERR_bad_parameter_length, "parameters", -1,
                            "`parameters` are one number for each of the %zu points, or the %zu "
                            "lengths between them; these are %zu",
                            n, n - 1, count);
  double *u = cag_hold_array(call, n, sizeof *u);
  if (count == n) memcpy(u, x, n * sizeof *u);
  else u[0] = 0;
  for (size_t i = 0; i < count && count + 1 == n; i++) {
    u[i + 1] = u[i] + x[i];
    if (!(x[i] > 0 && isfinite(x[i])))
      return cag_splines_fail(call, CAG_ERR_bad_parameter_length, "parameters", (long)i,
                              "the lengths of the segments are positive: parameters[%zu] = %s", i,
                              cag_number_text(x[i], text));
  }
  *own = cag_give_held(call, u);
  return true;
}

// --- Points with parameters ---

typedef struct Data {
  CagVec3 *points;
  size_t n;
  int dimension;
  double *u;
} Data;

// Both arrays are held.
static bool read_data(CagCall *call, int parameters, CagSpacing otherwise, Data *out) {
  CagSpacing spacing;
  Data d = {0};
  if (!cag_splines_points(call, 0, &d.points, &d.n, &d.dimension)) return false;
  cag_hold(call, d.points);
  if (!cag_splines_parameters(call, parameters, otherwise, d.n, &spacing, &d.u)) return false;
  const bool given = d.u;
  if (given) cag_hold(call, d.u);
  else d.u = cag_hold_array(call, d.n, sizeof *d.u);
  *out = d;
  return given ||
         cag_geometry_ok(call, cag_spacing_parameters(d.points, d.n, spacing, d.u, call->err));
}

// hermite(points, tangents, parameters = "uniform", limit = none)
bool cag_splines_hermite(CagCall *call, CagValue *result) {
  Data d;
  CagVec3 *tangents;
  size_t count;
  int dimension;
  double limit = INFINITY;
  CagCurve *c = NULL;
  if (cag_given(call, 3) && !cag_arg_positive(call, 3, &limit)) return false;
  if (!read_data(call, 2, CAG_SPACING_UNIFORM, &d) ||
      !cag_splines_points(call, 1, &tangents, &count, &dimension))
    return false;
  cag_hold(call, tangents);
  if (count != d.n)
    return cag_splines_fail(call, CAG_ERR_point_count, "tangents", -1,
                            "there is one tangent to each point: %zu points, %zu tangents", d.n,
                            count);
  if (dimension != d.dimension)
    return cag_splines_fail(call, CAG_ERR_dimension_mismatch, "tangents", -1,
                            "the points have %d numbers, the tangents %d", d.dimension, dimension);
  if (!cag_geometry_ok(call, cag_parameters_check(d.u, d.n, call->err))) return false;
  if (isfinite(limit)) cag_hermite_limit(d.points, tangents, d.n, d.u, limit);
  CagStatus status = cag_curve_hermite(d.points, tangents, d.n, d.u, d.dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// --- End conditions: records { type, start, finish, direction } ---

static bool give_ends(CagCall *call, const char *type, CagValue start, CagValue finish,
                      bool direction, CagValue *result) {
  static const char *const names[] = {"type", "start", "finish", "direction"};
  CagValue values[] = {cag_text_c(call->vm, type), start, finish, cag_bool(direction)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

static bool check_tangent(CagCall *call, int argument) {
  CagVec3 v;
  int dimension;
  return !cag_given(call, argument) || cag_arg_vec(call, argument, &v, &dimension);
}

static CagValue tangent_or_none(CagCall *call, int argument) {
  return cag_given(call, argument) ? call->values[argument] : cag_none();
}

bool cag_splines_clamped(CagCall *call, CagValue *result) {
  CagVec3 v;
  int dimension;
  bool direction;
  return cag_arg_vec(call, 0, &v, &dimension) && cag_arg_vec(call, 1, &v, &dimension) &&
         cag_arg_bool_or(call, 2, false, &direction) &&
         give_ends(call, "clamped", call->values[0], call->values[1], direction, result);
}

bool cag_splines_relaxed(CagCall *call, CagValue *result) {
  return give_ends(call, "relaxed", cag_none(), cag_none(), false, result);
}

bool cag_splines_cyclic(CagCall *call, CagValue *result) {
  return give_ends(call, "cyclic", cag_none(), cag_none(), false, result);
}

bool cag_splines_anticyclic(CagCall *call, CagValue *result) {
  return give_ends(call, "anticyclic", cag_none(), cag_none(), false, result);
}

bool cag_splines_ends(CagCall *call, CagValue *result) {
  bool direction;
  return check_tangent(call, 0) && check_tangent(call, 1) &&
         cag_arg_bool_or(call, 2, false, &direction) &&
         give_ends(call, "ends", tangent_or_none(call, 0), tangent_or_none(call, 1), direction,
                   result);
}

// The tangent of one end from its field; a direction gets the natural speed of its segment.
static bool read_end(CagCall *call, const CagRecord *r, int end, const Data *d, CagCubicEnds *out) {
  const CagValue v = cag_record_get(r, end ? "finish" : "start");
  const CagValue direction = cag_record_get(r, "direction");
  const double *x;
  size_t n;
  if (v.type == CAG_UNSET || v.type == CAG_NONE) return true;
  const char *where = end ? "finish" : "start";
  if (!cag_as_vector(v, &x, &n))
    return cag_fail_call(call, 1, CAG_ERR_value, "expects a vector as `%s` of the end conditions",
                         where);
  if ((int)n != d->dimension)
    return cag_splines_fail(call, CAG_ERR_dimension_mismatch, "ends", -1,
                            "the points have %d numbers, the tangent at the %s has %zu",
                            d->dimension, where, n);
  for (size_t i = 0; i < n; i++)
    if (!isfinite(x[i]))
      return cag_splines_fail(call, CAG_ERR_not_finite, "ends", -1,
                              "the tangent at the %s has a number that is not finite", where);
  CagVec3 t = cag_vec3(x[0], x[1], n > 2 ? x[2] : 0);
  if (direction.type == CAG_BOOL && direction.as.boolean) {
    const size_t i = end ? d->n - 2 : 0;
    if (cag_norm(t) == 0)
      return cag_splines_fail(call, CAG_ERR_zero_vector, "ends", -1,
                              "the direction at the %s is the zero vector", where);
    t = cag_scaled(cag_unit(t),
                   cag_norm(cag_sub(d->points[i + 1], d->points[i])) / (d->u[i + 1] - d->u[i]));
  }
  out->clamped[end] = true;
  out->tangent[end] = t;
  return true;
}

static bool read_ends(CagCall *call, int argument, const Data *d, CagCubicEnds *out) {
  CagRecord *r;
  *out = (CagCubicEnds){.closing = CAG_CUBIC_ENDS};
  if (!cag_given(call, argument)) return true;
  // relaxed, cyclic and anticyclic are taken uncalled as well.
  if (call->values[argument].type != CAG_RECORD)
    return cag_fail_type(call, argument,
                         "end conditions (clamped(V, V), relaxed(), cyclic(), anticyclic() or "
                         "ends(start, finish))");
  r = CAG_AS_RECORD(call->values[argument]);
  const CagValue type = cag_record_get(r, "type");
  if (type.type != CAG_TEXT)
    return cag_fail_type(call, argument,
                         "end conditions (clamped(V, V), relaxed(), cyclic(), anticyclic() or "
                         "ends(start, finish))");
  const char *name = CAG_AS_TEXT(type)->bytes;
  if (strcmp(name, "cyclic") == 0) out->closing = CAG_CUBIC_CYCLIC;
  else if (strcmp(name, "anticyclic") == 0) out->closing = CAG_CUBIC_ANTICYCLIC;
  else return d->n < 2 || (read_end(call, r, 0, d, out) && read_end(call, r, 1, d, out));
  return true;
}

// One tension for all inner points, or one for each, held; NULL where there is none.
static bool read_tension(CagCall *call, int argument, size_t n, double **out) {
  *out = NULL;
  if (!cag_given(call, argument) || n < 3) return true;
  const size_t inner = n - 2;
  const double *x = NULL;
  double same = 0;
  size_t count = inner;
  if (call->values[argument].type == CAG_NUMBER) {
    if (!cag_arg_finite(call, argument, &same)) return false;
    if (same == 0) return true;
  } else if (!cag_arg_numbers(call, argument, &x, &count)) {
    return false;
  }
  if (count != inner)
    return cag_splines_fail(call, CAG_ERR_point_count, "tension", -1,
                            "a tension is one number, or one for each of the %zu inner points; "
                            "these are %zu",
                            inner, count);
  *out = cag_hold_array(call, inner, sizeof **out);
  for (size_t i = 0; i < inner; i++) (*out)[i] = x ? x[i] : same;
  return true;
}

// cubic_spline(points, ends = relaxed(), parameters = "chord", tension = 0)
bool cag_splines_cubic_spline(CagCall *call, CagValue *result) {
  Data d;
  CagCubicEnds ends;
  double *tension = NULL;
  CagCurve *c = NULL;
  if (!read_data(call, 2, CAG_SPACING_CHORD, &d) ||
      !cag_geometry_ok(call, cag_parameters_check(d.u, d.n, call->err)) ||
      !read_ends(call, 1, &d, &ends) || !read_tension(call, 3, d.n, &tension))
    return false;
  CagStatus status =
      cag_curve_cubic_spline(d.points, d.n, d.u, &ends, tension, d.dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// --- Blends: (points, alpha, ends = "open", closed = false) ---

static bool read_blend_ends(CagCall *call, CagBlendEnds *out) {
  static const char *const names[] = {"open", "parabola", NULL};
  int choice;
  bool closed;
  if (!cag_arg_choice(call, 2, names, &choice) || !cag_arg_bool_or(call, 3, false, &closed))
    return false;
  *out = closed ? CAG_BLEND_CLOSED : choice ? CAG_BLEND_PARABOLA : CAG_BLEND_OPEN;
  return true;
}

// Ratios of the parabolas from one number or a list, held; NULL for "chord".
static bool read_ratios(CagCall *call, size_t n, CagBlendEnds ends, double **out) {
  static const char *const names[] = {"chord", NULL};
  const size_t count = ends == CAG_BLEND_CLOSED ? n : n > 2 ? n - 2 : 0;
  const double *x = NULL;
  double same = 0.5;
  size_t given = count;
  *out = NULL;
  const CagType type = cag_given(call, 1) ? call->values[1].type : CAG_UNSET;
  if (type == CAG_TEXT) {
    int choice;
    return cag_arg_choice(call, 1, names, &choice);
  }
  if (type == CAG_LIST) {
    if (!cag_arg_numbers(call, 1, &x, &given)) return false;
  } else if (!cag_arg_number_or(call, 1, 0.5, &same)) {
    return false;
  }
  if (given != count)
    return cag_splines_fail(call, CAG_ERR_point_count, "alpha", -1,
                            "`alpha` is one number, \"chord\", or one number for each of the %zu "
                            "points that a parabola is about; these are %zu",
                            count, given);
  *out = cag_hold_array(call, count, sizeof **out);
  for (size_t i = 0; i < count; i++) (*out)[i] = x ? x[i] : same;
  return true;
}

bool cag_splines_parabolic_blend(CagCall *call, CagValue *result) {
  CagVec3 *points;
  size_t n;
  int dimension;
  double *ratios = NULL;
  CagBlendEnds ends;
  CagCurve *c = NULL;
  if (!read_blend_ends(call, &ends) || !cag_splines_points(call, 0, &points, &n, &dimension))
    return false;
  cag_hold(call, points);
  if (!read_ratios(call, n, ends, &ratios)) return false;
  CagStatus status =
      cag_curve_parabolic_blend(points, n, ratios, 1, ends, dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_splines_catmull_rom(CagCall *call, CagValue *result) {
  CagVec3 *points;
  size_t n;
  int dimension;
  double alpha;
  CagBlendEnds ends;
  CagCurve *c = NULL;
  char text[32];
  if (!read_blend_ends(call, &ends) || !cag_arg_number_or(call, 1, 0.5, &alpha)) return false;
  if (!(alpha >= 0 && alpha <= 1))
    return cag_splines_fail(call, CAG_ERR_bad_blend_parameter, "alpha", -1,
                            "the power of the distances is between 0 and 1: alpha = %s",
                            cag_number_text(alpha, text));
  if (!cag_splines_points(call, 0, &points, &n, &dimension)) return false;
  cag_hold(call, points);
  CagStatus status =
      cag_curve_parabolic_blend(points, n, NULL, alpha, ends, dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// polynomial_curve(coefficients, length = 1)
bool cag_splines_polynomial_curve(CagCall *call, CagValue *result) {
  CagVec3 *coefficients;
  size_t n;
  int dimension;
  double length;
  CagCurve *c = NULL;
  if (!cag_arg_number_or(call, 1, 1, &length) ||
      !cag_splines_points(call, 0, &coefficients, &n, &dimension))
    return false;
  cag_hold(call, coefficients);
  CagStatus status = cag_curve_polynomial(coefficients, n, length, dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}
