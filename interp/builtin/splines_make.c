// Hermite curves, cubic splines with their end conditions, parabolic blends, polynomials.

#include <string.h>

#include "base/memory.h"
#include "interp/builtin/splines.h"
#include "interp/builtin/support.h"

// --- Shared ---

bool cag_splines_check_points(CagCall *call, int argument, const CagPoints *points) {
  const CagList *list = CAG_AS_LIST(call->values[argument]);
  if ((int)list->dim == points->dimension) return true;
  // Lists of points of one dimension are packed: here one is different.
  const char *name = cag_parameter_name(call, argument);
  const double *x;
  size_t first = 0, size = 0;
  for (size_t i = 0; i < list->length; i++) {
    cag_as_vector(cag_list_get(call->vm, list, i), &x, &size);
    if (i == 0) first = size;
    else if (size != first)
      return cag_splines_fail(
          call, CAG_ERR_dimension_mismatch, name, (long)i,
          "points must be all in the plane or all in space: %s[0] has %zu numbers and %s[%zu] has %zu",
          name, first, name, i, size);
  }
  return true;
}

bool cag_splines_tangents(CagCall *call, int argument, int dimension, CagPoints *out) {
  if (!cag_arg_points(call, argument, &out->items, &out->count, &out->dimension)) return false;
  cag_hold(call, out->items);
  return cag_splines_check_points(call, argument, out) &&
         (out->dimension == dimension ||
          cag_splines_fail(call, CAG_ERR_dimension_mismatch, "tangents", -1,
                           "points and tangents must have the same dimension, found %d and %d",
                           dimension, out->dimension));
}

bool cag_splines_check_dimension(CagCall *call, int argument, CagPoint p, int dimension) {
  return p.dimension == dimension ||
         cag_splines_fail(call, CAG_ERR_dimension_mismatch, cag_parameter_name(call, argument), -1,
                          "the vector must have the dimension of the points, %d, found %d",
                          dimension, p.dimension);
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
    return cag_splines_fail(
        call, CAG_ERR_bad_parameter_length, "parameters", -1,
        "`parameters` must be one number for each of the %zu points, or the %zu lengths between them, found %zu",
        n, n - 1, count);
  double *u = cag_hold_array(call, n, sizeof *u);
  if (count == n) memcpy(u, x, n * sizeof *u);
  else u[0] = 0;
  for (size_t i = 0; i < count && count + 1 == n; i++) {
    u[i + 1] = u[i] + x[i];
    if (!(x[i] > 0 && isfinite(x[i])))
      return cag_splines_fail(call, CAG_ERR_bad_parameter_length, "parameters", (long)i,
                              "the lengths of the segments must be positive: parameters[%zu] = %s",
                              i, cag_number_text(x[i], text));
  }
  *own = u;
  return true;
}

// --- Points with parameters ---

typedef struct Data {
  const CagVec3 *points;
  size_t n;
  int dimension;
  double *u; // held
} Data;

static bool read_data(CagCall *call, const CagPoints *points, int parameters, CagSpacing otherwise,
                      Data *out) {
  CagSpacing spacing;
  Data d = {points->items, points->count, points->dimension, NULL};
  if (!cag_splines_check_points(call, 0, points) ||
      !cag_splines_parameters(call, parameters, otherwise, d.n, &spacing, &d.u))
    return false;
  CagStatus status = CAG_OK;
  if (!d.u) {
    d.u = cag_hold_array(call, d.n, sizeof *d.u);
    status = cag_spacing_parameters(d.points, d.n, spacing, d.u, call->err);
  }
  *out = d;
  return cag_geometry_ok(call, status);
}

bool cag_splines_hermite(CagCall *call, const struct cag_splines_hermite *a, CagValue *result) {
  Data d;
  CagPoints tangents;
  CagCurve *c = NULL;
  if (!read_data(call, &a->points, 2, CAG_SPACING_UNIFORM, &d) ||
      !cag_splines_tangents(call, 1, d.dimension, &tangents))
    return false;
  if (tangents.count != d.n)
    return cag_splines_fail(call, CAG_ERR_point_count, "tangents", -1,
                            "each point needs one tangent, found %zu points and %zu tangents", d.n,
                            tangents.count);
  if (!cag_geometry_ok(call, cag_parameters_check(d.u, d.n, call->err))) return false;
  if (cag_given(call, 3)) cag_hermite_limit(d.points, tangents.items, d.n, d.u, a->limit);
  CagStatus status =
      cag_curve_hermite(d.points, tangents.items, d.n, d.u, d.dimension, &c, call->err);
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

bool cag_splines_clamped(CagCall *call, const struct cag_splines_clamped *a, CagValue *result) {
  return give_ends(call, "clamped", call->values[0], call->values[1], a->direction, result);
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

bool cag_splines_ends(CagCall *call, const struct cag_splines_ends *a, CagValue *result) {
  const CagValue start = cag_given(call, 0) ? call->values[0] : cag_none();
  const CagValue finish = cag_given(call, 1) ? call->values[1] : cag_none();
  return give_ends(call, "ends", start, finish, a->direction, result);
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
                            "the points have %d numbers, but the tangent at the %s has %zu",
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

static bool read_ends(CagCall *call, CagValue ends, const Data *d, CagCubicEnds *out) {
  *out = (CagCubicEnds){.closing = CAG_CUBIC_ENDS};
  if (ends.type == CAG_UNSET) return true;
  // relaxed, cyclic and anticyclic are taken uncalled as well.
  const CagRecord *r = ends.type == CAG_RECORD ? CAG_AS_RECORD(ends) : NULL;
  const CagValue type = r ? cag_record_get(r, "type") : cag_unset();
  if (type.type != CAG_TEXT)
    return cag_fail_type(
        call, 1,
        "end conditions (clamped(V, V), relaxed(), cyclic(), anticyclic(), or ends(start, finish))");
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
    return cag_splines_fail(
        call, CAG_ERR_point_count, "tension", -1,
        "the tension must be one number, or one for each of the %zu inner points, found %zu", inner,
        count);
  *out = cag_hold_array(call, inner, sizeof **out);
  for (size_t i = 0; i < inner; i++) (*out)[i] = x ? x[i] : same;
  return true;
}

bool cag_splines_cubic_spline(CagCall *call, const struct cag_splines_cubic_spline *a,
                              CagValue *result) {
  Data d;
  CagCubicEnds ends;
  double *tension = NULL;
  CagCurve *c = NULL;
  if (!read_data(call, &a->points, 2, CAG_SPACING_CHORD, &d) ||
      !cag_geometry_ok(call, cag_parameters_check(d.u, d.n, call->err)) ||
      !read_ends(call, a->ends, &d, &ends) || !read_tension(call, 3, d.n, &tension))
    return false;
  CagStatus status =
      cag_curve_cubic_spline(d.points, d.n, d.u, &ends, tension, d.dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// --- Blends ---

static CagBlendEnds blend_ends(int ends, bool closed) {
  return closed ? CAG_BLEND_CLOSED : ends ? CAG_BLEND_PARABOLA : CAG_BLEND_OPEN;
}

// Ratios of the parabolas from one number or a list, held; NULL for "chord".
static bool read_ratios(CagCall *call, size_t n, CagBlendEnds ends, double **out) {
  static const char *const names[] = {"chord", NULL};
  const size_t count = ends == CAG_BLEND_CLOSED ? n : n > 2 ? n - 2 : 0;
  const double *x = NULL;
  double same = 0.5;
  size_t given = count;
  *out = NULL;
  const CagType type = call->values[1].type;
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
    return cag_splines_fail(
        call, CAG_ERR_point_count, "alpha", -1,
        "`alpha` must be one number, \"chord\", or one number for each of the %zu middle points of a parabola, found %zu",
        count, given);
  *out = cag_hold_array(call, count, sizeof **out);
  for (size_t i = 0; i < count; i++) (*out)[i] = x ? x[i] : same;
  return true;
}

bool cag_splines_parabolic_blend(CagCall *call, const struct cag_splines_parabolic_blend *a,
                                 CagValue *result) {
  const CagPoints *p = &a->points;
  const CagBlendEnds ends = blend_ends(a->ends, a->closed);
  double *ratios = NULL;
  CagCurve *c = NULL;
  if (!cag_splines_check_points(call, 0, p) || !read_ratios(call, p->count, ends, &ratios))
    return false;
  CagStatus status =
      cag_curve_parabolic_blend(p->items, p->count, ratios, 1, ends, p->dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_splines_catmull_rom(CagCall *call, const struct cag_splines_catmull_rom *a,
                             CagValue *result) {
  const CagPoints *p = &a->points;
  CagCurve *c = NULL;
  char text[32];
  if (!(a->alpha >= 0 && a->alpha <= 1))
    return cag_splines_fail(call, CAG_ERR_bad_blend_parameter, "alpha", -1,
                            "the power of the distances, alpha, must be between 0 and 1, found %s",
                            cag_number_text(a->alpha, text));
  if (!cag_splines_check_points(call, 0, p)) return false;
  CagStatus status =
      cag_curve_parabolic_blend(p->items, p->count, NULL, a->alpha, blend_ends(a->ends, a->closed),
                                p->dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_splines_polynomial_curve(CagCall *call, const struct cag_splines_polynomial_curve *a,
                                  CagValue *result) {
  const CagPoints *p = &a->coefficients;
  CagCurve *c = NULL;
  if (!cag_splines_check_points(call, 0, p)) return false;
  CagStatus status =
      cag_curve_polynomial(p->items, p->count, a->length, p->dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}
