// Measures of whole curves and regions, and division of curves.

#include <string.h>

#include "base/memory.h"
#include "interp/builtin/curves.h"

bool cag_curves_length(CagCall *call, CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(call->values[0]); // a curve or region
  const CagCurve *c = shape->as.curve;
  double length, from, to;
  CagStatus status;
  if (call->values[0].type == CAG_REGION) {
    if (cag_given(call, 1))
      return cag_fail_call(call, 1, CAG_ERR_value,
                           "takes no range if the first argument is a region");
    status = cag_region_perimeter(shape->as.region, &length, call->err);
  } else {
    from = c->start;
    to = c->end;
    if (cag_given(call, 1) && !cag_arg_parameter_range(call, 1, c->angular, &from, &to))
      return false;
    status = cag_curve_length(c, from, to, &length, call->err);
  }
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_number(length);
  return true;
}

bool cag_curves_parameter_at_length(CagCall *call, const struct cag_curves_parameter_at_length *a,
                                    CagValue *result) {
  double t;
  if (!cag_geometry_ok(call, cag_curve_parameter_at_length(a->C, a->s, &t, call->err)))
    return false;
  *result = cag_parameter_value(a->C->angular, t);
  return true;
}

static double step(const CagCurve *c, size_t i, size_t n) {
  return i == n ? c->end : c->start + (c->end - c->start) * ((double)i / (double)n);
}

// The number of points that are evaluated together: few enough to stay in the cache.
#define SAMPLE_BATCH 512

bool cag_curves_sample(CagCall *call, const struct cag_curves_sample *a, CagValue *result) {
  const size_t count = (size_t)a->n, dimension = (size_t)a->C->dimension;
  double t[SAMPLE_BATCH], *to;
  CagVec3 points[SAMPLE_BATCH];
  CagValue list = cag_list_vectors(call->vm, count, dimension, &to);
  bool ok = true;
  cag_root_push(call->vm, list); // a curve may be a function of the script
  for (size_t from = 0; ok && from < count; from += SAMPLE_BATCH, to += SAMPLE_BATCH * dimension) {
    const size_t m = count - from < SAMPLE_BATCH ? count - from : SAMPLE_BATCH;
    // Points in space are evaluated directly into the list, whose layout is that of CagVec3.
    CagVec3 *out = dimension == 3 ? (CagVec3 *)to : points;
    for (size_t i = 0; i < m; i++) t[i] = step(a->C, from + i, count - 1);
    ok = cag_geometry_ok(call, cag_curve_eval_many(a->C, t, m, 0, out, call->err));
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
  for (size_t i = 1; !status && i < n; i++)
    status = cag_curve_parameter_at_length(c, length * (double)i / (double)n, &t[i], err);
  return status;
}

// The number of search steps per part for the next point at a given chord length.
#define CHORD_STEPS 64
// Enough bisections to exhaust a double's digits.
#define HALVINGS 60

// Finds the first parameter after `from` whose point is at distance `chord` from the point at
// `from`. *found is false if the curve ends before.
static CagStatus next_chord(const CagCurve *c, double from, double chord, double stride,
                            bool *found, double *t, CagError *err) {
  CagVec3 p, q;
  CagStatus status = cag_curve_point(c, from, &p, err);
  double low = from, high = from;
  *found = false;
  while (!status && !*found && high < c->end) {
    low = high;
    high = fmin(c->end, high + stride);
    status = cag_curve_point(c, high, &q, err);
    *found = !status && cag_norm(cag_sub(q, p)) >= chord;
  }
  for (int i = 0; !status && *found && i < HALVINGS; i++) {
    double middle = low + (high - low) / 2;
    status = cag_curve_point(c, middle, &q, err);
    if (cag_norm(cag_sub(q, p)) >= chord) high = middle;
    else low = middle;
  }
  *t = high;
  return status;
}

// Steps along n - 1 chords. *rest is the length of the last chord, which ends at the curve's end,
// minus `chord`. It is negative if the curve ends too early.
static CagStatus walk_chords(const CagCurve *c, size_t n, double chord, double *t, double *rest,
                             CagError *err) {
  double stride = (c->end - c->start) / ((double)n * CHORD_STEPS);
  CagVec3 last, end;
  *rest = -chord;
  for (size_t i = 1; i < n; i++) {
    bool found;
    CagStatus status = next_chord(c, t[i - 1], chord, stride, &found, &t[i], err);
    if (status || !found) return status;
  }
  CagStatus status = cag_curve_point(c, t[n - 1], &last, err);
  if (!status) status = cag_curve_point(c, c->end, &end, err);
  if (!status) *rest = cag_norm(cag_sub(end, last)) - chord;
  return status;
}

// Chords are equal if they differ by less than this fraction of the curve's length.
#define EQUAL_CHORDS 1e-12
#define CHORD_ROUNDS 400

// The chord before t[i] minus the chord after it, with t[i] moved to x.
static CagStatus chord_excess(const CagCurve *c, const CagVec3 *p, size_t i, double x, CagVec3 *at,
                              double *out, CagError *err) {
  CagStatus status = cag_curve_point(c, x, at, err);
  *out = cag_norm(cag_sub(*at, p[i - 1])) - cag_norm(cag_sub(p[i + 1], *at));
  return status;
}

// Moves t[i] between its neighbors until its two chords are equal. At the left neighbor, the chord
// before it is shorter; at the right one, it is longer.
static CagStatus even_out(const CagCurve *c, CagVec3 *p, double *t, size_t i, CagError *err) {
  double low = t[i - 1], high = t[i + 1], excess;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < HALVINGS; k++) {
    const double middle = low + (high - low) / 2;
    status = chord_excess(c, p, i, middle, &p[i], &excess, err);
    if (excess > 0) high = middle;
    else low = middle;
  }
  t[i] = low + (high - low) / 2;
  return status ? status : cag_curve_point(c, t[i], &p[i], err);
}

// Computes the excess at every inner point, and the largest absolute value.
static CagStatus all_excesses(const CagCurve *c, size_t n, const double *t, CagVec3 *p, double *e,
                              double *worst, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i <= n; i++) status = cag_curve_point(c, t[i], &p[i], err);
  *worst = 0;
  for (size_t i = 1; !status && i < n; i++) {
    e[i] = cag_norm(cag_sub(p[i], p[i - 1])) - cag_norm(cag_sub(p[i + 1], p[i]));
    *worst = fmax(*worst, fabs(e[i]));
  }
  return status;
}

// One step of Newton's method for all inner points at once, with a tridiagonal system. `next`
// receives the new parameters; *ok is false if they do not ascend.
static CagStatus newton_chords(const CagCurve *c, size_t n, const double *t, const CagVec3 *p,
                               const double *e, double *room, double *next, bool *ok,
                               CagError *err) {
  double *up = room, *step = room + n + 1;
  CagStatus status = CAG_OK;
  *ok = false;
  CagVec3 d[3][2];
  for (size_t i = 1; i < n; i++) {
    for (size_t k = 0; !status && k < 3; k++)
      status = cag_curve_eval(c, t[i - 1 + k], 1, CAG_SIDE_RIGHT, d[k], err);
    if (status) return status;
    const CagVec3 before = cag_unit(cag_sub(p[i], p[i - 1]));
    const CagVec3 after = cag_unit(cag_sub(p[i + 1], p[i]));
    const double below = i > 1 ? -cag_dot(before, d[0][1]) : 0;
    const double above = i + 1 < n ? -cag_dot(after, d[2][1]) : 0;
    const double own =
        cag_dot(before, d[1][1]) + cag_dot(after, d[1][1]) - (i > 1 ? below * up[i - 1] : 0);
    if (!(fabs(own) > 0)) return CAG_OK;
    up[i] = above / own;
    step[i] = (-e[i] - (i > 1 ? below * step[i - 1] : 0)) / own;
  }
  for (size_t i = n - 1; i > 1; i--) step[i - 1] -= up[i - 1] * step[i];
  next[0] = t[0];
  next[n] = t[n];
  *ok = true;
  for (size_t i = 1; i < n; i++) {
    next[i] = t[i] + step[i];
    *ok = *ok && next[i] > next[i - 1];
  }
  *ok = *ok && next[n] > next[n - 1];
  return CAG_OK;
}

// Works from any start: equalizes the chords of one point after the other until Newton's method
// converges.
static CagStatus equalize_chords(CagCall *call, const CagCurve *c, size_t n, double *t,
                                 double length, CagError *err) {
  const double enough = EQUAL_CHORDS * length;
  double *room = cag_hold_array(call, 5 * (n + 1), sizeof *room), worst, tried;
  CagVec3 *p = cag_hold_array(call, 2 * (n + 1), sizeof *p);
  double *e = room, *next = room + (n + 1), *next_e = room + 2 * (n + 1);
  CagStatus status = all_excesses(c, n, t, p, e, &worst, err);
  for (int round = 0; !status && worst > enough && round < CHORD_ROUNDS; round++) {
    bool ok;
    status = newton_chords(c, n, t, p, e, room + 3 * (n + 1), next, &ok, err);
    tried = INFINITY;
    if (!status && ok) status = all_excesses(c, n, next, p + n + 1, next_e, &tried, err);
    if (!status && tried < 0.5 * worst) {
      memcpy(t, next, sizeof *t * (n + 1));
    } else {
      for (size_t i = 1; !status && i < n; i++) status = even_out(c, p, t, i, err);
    }
    if (!status) status = all_excesses(c, n, t, p, e, &worst, err);
  }
  if (!status && worst > 1e3 * enough)
    return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "by", -1,
                    "found no %zu equal chords; their lengths still differ by %.3g mm", n, worst);
  return status;
}

// Divides the curve into chords of equal length. Prefers chords whose ends are each the first point
// at that distance from the one before. A curve that turns back may have no such division; then
// another one is searched for.
static CagStatus divide_by_chord(CagCall *call, const CagCurve *c, size_t n, double *t,
                                 CagError *err) {
  double length, low = 0, rest;
  CagStatus status = cag_curve_length(c, c->start, c->end, &length, err);
  double high = length / (double)n; // no chord is longer than its arc
  for (int i = 0; !status && n > 1 && i < HALVINGS; i++) {
    double middle = low + (high - low) / 2;
    status = walk_chords(c, n, middle, t, &rest, err);
    if (rest >= 0) low = middle;
    else high = middle;
  }
  if (!status && n > 1) status = walk_chords(c, n, low, t, &rest, err);
  if (status || n < 2 || fabs(rest) <= EQUAL_CHORDS * length) return status;
  status = divide_by_length(c, n, t, err);
  t[0] = c->start;
  t[n] = c->end;
  return status ? status : equalize_chords(call, c, n, t, length, err);
}

bool cag_curves_divide(CagCall *call, const struct cag_curves_divide *a, CagValue *result) {
  const CagCurve *c = a->C;
  const size_t n = (size_t)a->n;
  double *t = cag_hold(call, cag_malloc((n + 1) * sizeof *t));
  for (size_t i = 0; i <= n; i++) t[i] = step(c, i, n);
  CagStatus status = CAG_OK;
  if (a->by == 0) status = divide_by_length(c, n, t, call->err);
  if (a->by == 1) status = divide_by_chord(call, c, n, t, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  if (!c->angular) {
    *result = cag_numbers_value(call->vm, t, n + 1);
    return true;
  }
  CagBuilder *b = cag_builder_new(call->vm);
  for (size_t i = 0; i <= n; i++) cag_builder_add(call->vm, b, cag_parameter_value(true, t[i]));
  *result = cag_builder_finish(call->vm, b);
  return true;
}

bool cag_curves_closest(CagCall *call, const struct cag_curves_closest *a, CagValue *result) {
  static const char *const names[] = {"t", "point", "distance"};
  CagVec3 point;
  double t, distance;
  if (!cag_geometry_ok(call, cag_curve_closest(a->C, a->P.at, &t, &point, &distance, call->err)))
    return false;
  CagValue values[] = {cag_parameter_value(a->C->angular, t),
                       cag_point(call->vm, point, a->C->dimension), cag_number(distance)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// --- Area ---

// Signed area and centroid of a closed plane curve or a region, in its own plane. `centroid` may be
// NULL.
static bool read_area(CagCall *call, double *area, CagVec3 *centroid, int *dimension) {
  CagValue v = call->values[0];
  *dimension = 2;
  if (v.type == CAG_CURVE)
    return cag_geometry_ok(call,
                           cag_curve_area(CAG_AS_SHAPE(v)->as.curve, area, centroid, call->err));
  const CagShape *shape = CAG_AS_SHAPE(v);
  const CagTransform *place = shape->placement;
  if (!cag_geometry_ok(call, cag_region_area(shape->as.region, area, centroid, call->err)))
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
