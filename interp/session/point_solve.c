// Params with which a point comes close to a target: Gauss-Newton steps within the ranges.
// Derivatives are differences, since a script computes points in any way.

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "geom/linalg/tolerance.h"
#include "interp/session/points.h"

// The most params that are solved for at once.
enum { MOST_UNKNOWNS = 8, MOST_ROUNDS = 12, MOST_HALVINGS = 5 };
// The step of differences, as a part of a param's range.
#define DIFFERENCE 1e-5
// What is added to the diagonal of the normal equations, as a part of its largest element: of
// several params that do the same, all change a little.
#define DAMPING 1e-9

// Seconds after which no round begins: someone who drags the point waits for the next run.
#define SOLVE_TIME 0.5
// Steps that move the point by less than this part of the tolerance are not taken.
#define CLOSE_ENOUGH 0.05
// Params are rounded to at least this part of their range.
#define SMALLEST_STEP 1e-9
// What counts of a difference in a direction that is ignored.
#define IGNORED 1e-3
// The tolerance, mm, if none is given.
#define TOLERANCE 1e-6

// Params are unknowns of 0 to 1, from the low to the high end of their ranges.
typedef struct Solving {
  CagPointWork work;
  size_t point, n;
  CagTrialParam params[MOST_UNKNOWNS];
  CagVec3 target, at; // at: with the values in params
  CagVec3 ignored[2]; // perpendicular unit vectors; zero: none
  double tolerance;
  bool found;
  double columns[MOST_UNKNOWNS][3]; // derivatives of the point
} Solving;

static bool point_with(Solving *v, const CagTrialParam *params, CagVec3 *out) {
  CagPointWork *f = &v->work;
  if (!cag_trial_spots(&f->trial, params, v->n, &f->moved) || v->point >= f->moved.count)
    return false;
  *out = cag_point_spot_at(&f->moved.items[v->point]);
  return isfinite(out->x + out->y + out->z);
}

// A difference as far as it counts.
static CagVec3 seen(const Solving *v, CagVec3 d) {
  for (int i = 0; i < 2; i++)
    d = cag_madd(d, (IGNORED - 1) * cag_dot(d, v->ignored[i]), v->ignored[i]);
  return d;
}

static double miss(const Solving *v, CagVec3 at) {
  return cag_norm(seen(v, cag_sub(at, v->target)));
}

// Params whose differences cannot be computed do not change.
static void find_columns(Solving *v) {
  for (size_t k = 0; k < v->n; k++) {
    CagTrialParam params[MOST_UNKNOWNS];
    CagVec3 there;
    memcpy(params, v->params, sizeof params);
    const double range = params[k].high - params[k].low;
    const double h =
        params[k].value + DIFFERENCE * range <= params[k].high ? DIFFERENCE : -DIFFERENCE;
    params[k].value += h * range;
    const bool found = point_with(v, params, &there);
    const CagVec3 d = found ? cag_scaled(seen(v, cag_sub(there, v->at)), 1 / h) : cag_vec3(0, 0, 0);
    v->columns[k][0] = d.x;
    v->columns[k][1] = d.y;
    v->columns[k][2] = d.z;
  }
}

static double dot3(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Solves the normal equations of the free unknowns, which are positive definite by the damping, by
// elimination.
static void normal_step(const Solving *v, const bool *fixed, double step[MOST_UNKNOWNS]) {
  double a[MOST_UNKNOWNS][MOST_UNKNOWNS + 1], largest = 0;
  const CagVec3 d = seen(v, cag_sub(v->target, v->at));
  const double r[3] = {d.x, d.y, d.z};
  for (size_t i = 0; i < v->n; i++) largest = fmax(largest, dot3(v->columns[i], v->columns[i]));
  for (size_t i = 0; i < v->n; i++) {
    for (size_t j = 0; j < v->n; j++)
      a[i][j] = fixed[i] || fixed[j] ? 0 : dot3(v->columns[i], v->columns[j]);
    a[i][i] += fixed[i] || largest == 0 ? 1 : DAMPING * largest;
    a[i][v->n] = fixed[i] ? 0 : dot3(v->columns[i], r);
  }
  for (size_t i = 0; i < v->n; i++)
    for (size_t j = i + 1; j < v->n; j++) {
      const double factor = a[j][i] / a[i][i];
      for (size_t k = i; k <= v->n; k++) a[j][k] -= factor * a[i][k];
    }
  for (size_t i = v->n; i-- > 0;) {
    step[i] = a[i][v->n];
    for (size_t k = i + 1; k < v->n; k++) step[i] -= a[i][k] * step[k];
    step[i] /= a[i][i];
  }
}

// The step within the ranges: a param that would leave its range is fixed, and the others take
// over.
static void bounded_step(const Solving *v, double step[MOST_UNKNOWNS]) {
  bool fixed[MOST_UNKNOWNS] = {false}, again = true;
  while (again) {
    again = false;
    normal_step(v, fixed, step);
    for (size_t k = 0; k < v->n; k++) {
      const CagTrialParam *p = &v->params[k];
      const double range = p->high - p->low, to = p->value + step[k] * range;
      const bool at_end =
          (p->value <= p->low && to < p->low) || (p->value >= p->high && to > p->high);
      if (fixed[k] || !at_end) continue;
      fixed[k] = again = true;
    }
  }
}

// Takes the step, or a part of it that comes closer. Returns false if none does.
static bool take_step(Solving *v, const double *step) {
  double part = 1;
  for (int i = 0; i < MOST_HALVINGS; i++, part /= 2) {
    CagTrialParam params[MOST_UNKNOWNS];
    CagVec3 there;
    memcpy(params, v->params, sizeof params);
    for (size_t k = 0; k < v->n; k++) {
      CagTrialParam *p = &params[k];
      p->value = fmin(p->high, fmax(p->low, p->value + part * step[k] * (p->high - p->low)));
    }
    if (!point_with(v, params, &there) || !(miss(v, there) < miss(v, v->at))) continue;
    memcpy(v->params, params, sizeof params);
    v->at = there;
    return true;
  }
  return false;
}

// The largest power of ten by which a change of the param moves the point by less than the
// tolerance.
static double step_of(const Solving *v, size_t k) {
  const CagTrialParam *p = &v->params[k];
  const double range = p->high - p->low, speed = sqrt(dot3(v->columns[k], v->columns[k])) / range;
  const double most = speed > 0 ? fmin(v->tolerance / speed, range) : range;
  // The logarithm of a power of ten may be rounded.
  return pow(10, ceil(log10(fmax(most, SMALLEST_STEP * range)) - 1e-9) - 1);
}

// A param that does not move the point keeps its value.
static void round_params(Solving *v) {
  for (size_t k = 0; k < v->n; k++) {
    CagTrialParam *p = &v->params[k];
    if (dot3(v->columns[k], v->columns[k]) == 0) continue;
    const double step = step_of(v, k),
                 rounded = step >= 1 ? round(p->value / step) * step
                                     : round(p->value * round(1 / step)) / round(1 / step);
    if (rounded >= p->low && rounded <= p->high) p->value = rounded;
  }
}

// How far the point would move by a step if it moved along straight lines.
static double reach_of(const Solving *v, const double *step) {
  double d[3] = {0};
  for (size_t k = 0; k < v->n; k++)
    for (int i = 0; i < 3; i++) d[i] += v->columns[k][i] * step[k];
  return sqrt(dot3(d, d));
}

static void solve_rounds(Solving *v) {
  double step[MOST_UNKNOWNS];
  const double begin = cag_clock_seconds();
  for (int i = 0; i < MOST_ROUNDS && cag_clock_seconds() - begin < SOLVE_TIME; i++) {
    find_columns(v);
    bounded_step(v, step);
    if (reach_of(v, step) < CLOSE_ENOUGH * v->tolerance || !take_step(v, step)) return;
  }
}

static bool solve_point(CagVm *vm, void *context) {
  Solving *v = context;
  (void)vm;
  cag_trial_begin(&v->work.trial, v->work.session, v->work.part);
  v->found = point_with(v, v->params, &v->at);
  if (v->found) {
    solve_rounds(v);
    round_params(v);
    point_with(v, v->params, &v->at);
  }
  cag_trial_end(&v->work.trial);
  return true;
}

static bool find_param(const CagSession *s, const char *name, CagTrialParam *out) {
  for (size_t i = 0; cag_trial_param(s, i, out); i++)
    if (!strcmp(out->name, name)) return true;
  return false;
}

static void give_values(const Solving *v,
                        void (*give)(void *context, const char *name, const char *value),
                        void *context) {
  for (size_t k = 0; k < v->n; k++) {
    char text[64];
    CagString number = {0};
    cag_print_number(&number, v->params[k].value + 0);
    snprintf(text, sizeof text, "%s%s", number.bytes ? number.bytes : "0",
             v->params[k].angle ? "deg" : "");
    cag_string_free(&number);
    give(context, v->params[k].name, text);
  }
}

static CagVec3 vector_of(const double x[3]) { return cag_vec3(x[0], x[1], x[2]); }

// Makes the directions perpendicular unit vectors, as far as they are independent.
static void find_ignored(const CagPointGoal *goal, CagVec3 out[2]) {
  for (int i = 0; i < 2; i++) {
    CagVec3 d = vector_of(goal->ignored[i]);
    const double length = cag_norm(d);
    out[i] = cag_vec3(0, 0, 0);
    if (!(length > 0) || !isfinite(length)) continue;
    d = cag_scaled(d, 1 / length);
    if (i > 0) d = cag_madd(d, -cag_dot(d, out[0]), out[0]);
    if (cag_norm(d) > CAG_PARALLEL) out[i] = cag_scaled(d, 1 / cag_norm(d));
  }
}

int cag_session_solve_point(CagSession *s, const CagPointGoal *goal,
                            void (*give)(void *context, const char *name, const char *value),
                            void *context, double at[3]) {
  Solving v = {.work = {.session = s, .part = goal->part},
               .point = goal->point,
               .n = goal->count,
               .target = vector_of(goal->target),
               .tolerance = goal->tolerance > 0 ? goal->tolerance : TOLERANCE};
  if (v.n == 0 || v.n > MOST_UNKNOWNS || !isfinite(cag_norm(v.target)) || !cag_session_begin(s))
    return CAG_STATUS_USAGE;
  find_ignored(goal, v.ignored);
  bool known = cag_points_of_part(s, goal->part) && cag_session_list_params(s);
  for (size_t k = 0; known && k < v.n; k++) known = find_param(s, goal->names[k], &v.params[k]);
  int status = CAG_STATUS_USAGE;
  if (known) status = cag_points_work(s, solve_point, &v.work, &v);
  if (status == CAG_STATUS_OK && !v.found) status = CAG_STATUS_USAGE;
  if (status == CAG_STATUS_OK) {
    give_values(&v, give, context);
    at[0] = v.at.x;
    at[1] = v.at.y;
    at[2] = v.at.z;
  }
  return cag_session_end(s, status);
}
