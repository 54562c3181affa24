// Measures of whole curves and regions, and their division.

#include <stdlib.h>

#include "interp/builtin/curves.h"

// Most points or parts that one call makes.
#define PARTS_MAX 100000000

static bool fail_memory(CagCall *call) {
  return cag_fail_call(call, -1, CAG_ERR_limit_memory, "needs more memory than there is");
}

bool cag_curves_length(CagCall *call, CagValue *result) {
  CagError err;
  double length, from, to;
  if (call->values[0].type == CAG_REGION) {
    const CagRegion *region = CAG_AS_SHAPE(call->values[0])->as.region;
    if (cag_given(call, 1))
      return cag_fail_call(call, 1, CAG_ERR_value, "takes no range of a region");
    if (!cag_geometry_ok(call, cag_region_perimeter(region, &length, &err), &err)) return false;
    *result = cag_number(length);
    return true;
  }
  CagCurve *c;
  if (!cag_arg_curve(call, 0, &c)) return false;
  from = c->start;
  to = c->end;
  if (cag_given(call, 1) && !cag_arg_parameter_range(call, 1, c->angular, &from, &to)) return false;
  if (!cag_geometry_ok(call, cag_curve_length(c, from, to, &length, &err), &err)) return false;
  *result = cag_number(length);
  return true;
}

bool cag_curves_parameter_at_length(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagError err;
  double s, t;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_finite(call, 1, &s) ||
      !cag_geometry_ok(call, cag_curve_parameter_at_length(c, s, &t, &err), &err))
    return false;
  *result = cag_parameter_value(c->angular, t);
  return true;
}

static double step(const CagCurve *c, size_t i, size_t n) {
  return i == n ? c->end : c->start + (c->end - c->start) * ((double)i / (double)n);
}

// Points that are evaluated together: few enough to stay near the processor.
#define SAMPLE_BATCH 512

bool cag_curves_sample(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagError err;
  long n;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_integer(call, 1, 2, PARTS_MAX, &n)) return false;
  const size_t count = (size_t)n, dimension = (size_t)c->dimension;
  double t[SAMPLE_BATCH], *to;
  CagVec3 points[SAMPLE_BATCH];
  CagValue list = cag_list_vectors(call->vm, count, dimension, &to);
  bool ok = true;
  cag_root_push(call->vm, list); // a curve may be a function of the script
  for (size_t from = 0; ok && from < count; from += SAMPLE_BATCH, to += SAMPLE_BATCH * dimension) {
    const size_t m = count - from < SAMPLE_BATCH ? count - from : SAMPLE_BATCH;
    // Vectors of a list in space lie as those of the core do.
    CagVec3 *out = dimension == 3 ? (CagVec3 *)to : points;
    for (size_t i = 0; i < m; i++) t[i] = step(c, from + i, count - 1);
    ok = cag_geometry_ok(call, cag_curve_eval_many(c, t, m, 0, out, &err), &err);
    for (size_t i = 0; ok && dimension == 2 && i < m; i++) {
      to[2 * i] = points[i].x;
      to[2 * i + 1] = points[i].y;
    }
  }
  cag_root_pop(call->vm, 1);
  *result = list;
  return ok;
}

// --- Division ---

static CagStatus divide_by_length(const CagCurve *c, size_t n, double *t, CagError *err) {
  double length;
  CagStatus status = cag_curve_length(c, c->start, c->end, &length, err);
  for (size_t i = 1; status == CAG_OK && i < n; i++)
    status = cag_curve_parameter_at_length(c, length * (double)i / (double)n, &t[i], err);
  return status;
}

// Steps of the search for the next point at a given chord, per part.
#define CHORD_STEPS 64
// Halvings that exhaust a double's digits.
#define HALVINGS 60

// The first parameter after `from` whose point is `chord` away from the point there; false when the
// curve ends before.
static CagStatus next_chord(const CagCurve *c, double from, double chord, double stride,
                            bool *found, double *t, CagError *err) {
  CagVec3 p, q;
  CagStatus status = cag_curve_point(c, from, &p, err);
  double low = from, high = from;
  *found = false;
  while (status == CAG_OK && !*found && high < c->end) {
    low = high;
    high = fmin(c->end, high + stride);
    status = cag_curve_point(c, high, &q, err);
    *found = status == CAG_OK && cag_norm(cag_sub(q, p)) >= chord;
  }
  for (int i = 0; status == CAG_OK && *found && i < HALVINGS; i++) {
    double middle = low + (high - low) / 2;
    status = cag_curve_point(c, middle, &q, err);
    if (cag_norm(cag_sub(q, p)) >= chord) high = middle;
    else low = middle;
  }
  *t = high;
  return status;
}

// Walks n - 1 chords; *rest is what the last chord to the end has more than `chord` (negative when
// the curve ends too early).
static CagStatus walk_chords(const CagCurve *c, size_t n, double chord, double *t, double *rest,
                             CagError *err) {
  double stride = (c->end - c->start) / ((double)n * CHORD_STEPS);
  CagVec3 last, end;
  *rest = -chord;
  for (size_t i = 1; i < n; i++) {
    bool found;
    CagStatus status = next_chord(c, t[i - 1], chord, stride, &found, &t[i], err);
    if (status != CAG_OK || !found) return status;
  }
  CagStatus status = cag_curve_point(c, t[n - 1], &last, err);
  if (status == CAG_OK) status = cag_curve_point(c, c->end, &end, err);
  if (status == CAG_OK) *rest = cag_norm(cag_sub(end, last)) - chord;
  return status;
}

static CagStatus divide_by_chord(const CagCurve *c, size_t n, double *t, CagError *err) {
  double length, low = 0, rest;
  CagStatus status = cag_curve_length(c, c->start, c->end, &length, err);
  double high = length / (double)n; // no chord is longer than its arc
  for (int i = 0; status == CAG_OK && n > 1 && i < HALVINGS; i++) {
    double middle = low + (high - low) / 2;
    status = walk_chords(c, n, middle, t, &rest, err);
    if (rest >= 0) low = middle;
    else high = middle;
  }
  return status == CAG_OK && n > 1 ? walk_chords(c, n, low, t, &rest, err) : status;
}

bool cag_curves_divide(CagCall *call, CagValue *result) {
  static const char *const ways[] = {"length", "chord", "parameter", NULL};
  CagCurve *c;
  CagError err;
  long parts;
  int by;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_integer(call, 1, 1, PARTS_MAX, &parts) ||
      !cag_arg_choice(call, 2, ways, &by))
    return false;
  size_t n = (size_t)parts;
  double *t = malloc((n + 1) * sizeof *t);
  if (!t) return fail_memory(call);
  for (size_t i = 0; i <= n; i++) t[i] = step(c, i, n);
  CagStatus status = CAG_OK;
  if (by == 0) status = divide_by_length(c, n, t, &err);
  if (by == 1) status = divide_by_chord(c, n, t, &err);
  bool ok = cag_geometry_ok(call, status, &err);
  if (ok && !c->angular) *result = cag_numbers_value(call->vm, t, n + 1);
  if (ok && c->angular) {
    CagBuilder *b = cag_builder_new(call->vm);
    for (size_t i = 0; ok && i <= n; i++)
      ok = cag_builder_add(call->vm, b, cag_parameter_value(true, t[i]));
    if (ok) *result = cag_builder_finish(call->vm, b);
  }
  free(t);
  return ok;
}

bool cag_curves_closest(CagCall *call, CagValue *result) {
  static const char *const names[] = {"t", "point", "distance"};
  CagCurve *c;
  CagVec3 p, point;
  CagError err;
  double t, distance;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_vec(call, 1, &p, NULL) ||
      !cag_geometry_ok(call, cag_curve_closest(c, p, &t, &point, &distance, &err), &err))
    return false;
  CagValue values[] = {cag_parameter_value(c->angular, t), cag_point(call->vm, point, c->dimension),
                       cag_number(distance)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// --- Area ---

// Signed area and centroid of a closed plane curve or a region, where it lies.
// centroid: NULL where it is not wanted.
static bool read_area(CagCall *call, double *area, CagVec3 *centroid, int *dimension) {
  CagError err;
  CagValue v = call->values[0];
  *dimension = 2;
  if (v.type == CAG_CURVE)
    return cag_geometry_ok(call, cag_curve_area(CAG_AS_SHAPE(v)->as.curve, area, centroid, &err),
                           &err);
  const CagShape *shape = CAG_AS_SHAPE(v);
  const CagTransform *place = &shape->placement;
  if (!cag_geometry_ok(call, cag_region_area(shape->as.region, area, centroid, &err), &err))
    return false;
  CagVec3 x = cag_transform_vector(place, cag_vec3(1, 0, 0));
  CagVec3 y = cag_transform_vector(place, cag_vec3(0, 1, 0));
  *area *= cag_norm(cag_cross(x, y));
  if (centroid) *centroid = cag_transform_point(place, *centroid);
  *dimension = place->planar ? 2 : 3;
  return true;
}

bool cag_curves_area(CagCall *call, CagValue *result) {
  double area;
  int dimension;
  if (!read_area(call, &area, NULL, &dimension)) return false;
  *result = cag_number(fabs(area));
  return true;
}

bool cag_curves_centroid(CagCall *call, CagValue *result) {
  double area;
  CagVec3 centroid;
  int dimension;
  if (!read_area(call, &area, &centroid, &dimension)) return false;
  *result = cag_point(call->vm, centroid, dimension);
  return true;
}

bool cag_curves_bounds(CagCall *call, CagValue *result) {
  CagBounds b;
  int dimension;
  if (!cag_value_bounds(call, call->values[0], &b, &dimension)) return false;
  *result = cag_bounds_value(call->vm, &b, dimension);
  return true;
}
