// Curves from their natural equations, by Taylor's method.
//
// The Frenet-Serret formulas T' = k N, N' = -k T + w B, B' = -w N give the Taylor coefficients of
// the frame recursively from those of k and w. A step extends as far as the series is accurate to
// rounding and agrees with k and w (which may be piecewise); the frame is orthonormalized at each
// step. The steps are stored, and points between them are evaluated from the series without solving
// again.

#include "geom/curve/natural.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/function.h"
#include "geom/linalg/tolerance.h"

// Terms of the series of the frame; the points have one more.
#define TERMS 15
// Bound of the last terms of a step, relative to the unit vectors of the frame.
#define TAIL 1e-16
// Tolerance for the agreement of k and w with their series, in radians turned over the step.
#define AGREES 1e-13
// Steps are not halved below this fraction of the length; a jump is then stepped over.
#define STEP_LEAST 1e-14
// Maximum turn of the frame in a step (radians).
#define TURN_MOST 2.0
#define STEPS_MOST 100000
// Derivatives up to this order come from the series of the step, higher ones from the equations.
#define ORDER_KEPT 3

typedef struct Frame {
  CagVec3 point, t, n, b;
} Frame;

typedef struct Step {
  double start;
  Frame frame;
  CagVec3 points[TERMS + 2]; // Taylor coefficients
} Step;

typedef struct Natural {
  CagNaturalEquations equations;
  Step *steps;
  size_t count, capacity;
  double length;
} Natural;

typedef struct Expansion {
  CagVec3 t[CAG_MAX_DERIVATIVE + 1], n[CAG_MAX_DERIVATIVE + 1], b[CAG_MAX_DERIVATIVE + 1];
} Expansion;

// Taylor coefficients of the frame up to `terms`, from the frame at s and the coefficients of the
// equations.
static void expand(const Frame *f, const double *k, const double *w, int terms, Expansion *out) {
  out->t[0] = f->t;
  out->n[0] = f->n;
  out->b[0] = f->b;
  for (int i = 0; i < terms; i++) {
    CagVec3 t = {0, 0, 0}, n = {0, 0, 0}, b = {0, 0, 0};
    for (int j = 0; j <= i; j++) {
      t = cag_madd(t, k[j], out->n[i - j]);
      n = cag_madd(cag_madd(n, -k[j], out->t[i - j]), w[j], out->b[i - j]);
      b = cag_madd(b, -w[j], out->n[i - j]);
    }
    out->t[i + 1] = cag_scaled(t, 1.0 / (i + 1));
    out->n[i + 1] = cag_scaled(n, 1.0 / (i + 1));
    out->b[i + 1] = cag_scaled(b, 1.0 / (i + 1));
  }
}

// Taylor coefficients of the points: C' is the tangent.
static void integrate(CagVec3 point, const Expansion *e, int terms, CagVec3 *points) {
  points[0] = point;
  for (int i = 0; i <= terms; i++) points[i + 1] = cag_scaled(e->t[i], 1.0 / (i + 1));
}

static double value(const double *series, int terms, double h) {
  double sum = 0;
  for (int i = terms - 1; i >= 0; i--) sum = sum * h + series[i];
  return sum;
}

// Whether the equations agree with their series at s over the step h.
static CagStatus agree(const Natural *c, double s, double h, const double *k, const double *w,
                       bool *out, CagError *err) {
  static const double shares[] = {1, 0.381966, 0.763932};
  *out = true;
  for (int i = 0; *out && i < 3; i++) {
    double x = shares[i] * h, at_k, at_w, to = fmin(s + x, c->length);
    CagStatus status = c->equations.eval(c->equations.context, to, 0, &at_k, &at_w, err);
    if (status) return status;
    double differs = fabs(at_k - value(k, TERMS, to - s)) + fabs(at_w - value(w, TERMS, to - s));
    *out = differs * h <= AGREES * fmax(1, (fabs(at_k) + fabs(at_w)) * h);
  }
  return CAG_OK;
}

// Longest step for which the tail of the series is below rounding.
static double step_length(const Expansion *e, double turning, double rest) {
  double h = rest;
  for (int i = TERMS - 1; i <= TERMS; i++) {
    double size = fmax(cag_norm(e->t[i]), fmax(cag_norm(e->n[i]), cag_norm(e->b[i])));
    if (size > 0) h = fmin(h, pow(TAIL / size, 1.0 / i));
  }
  return turning > 0 ? fmin(h, TURN_MOST / turning) : h;
}

static CagVec3 series_point(const Step *step, double h, int derivative) {
  CagVec3 sum = {0, 0, 0};
  for (int i = TERMS + 1; i >= derivative; i--) {
    double factor = 1;
    for (int j = 0; j < derivative; j++) factor *= i - j;
    sum = cag_madd(cag_scaled(sum, h), factor, step->points[i]);
  }
  return sum;
}

static CagVec3 sum_series(const CagVec3 *terms, double h) {
  CagVec3 sum = terms[TERMS];
  for (int i = TERMS - 1; i >= 0; i--) sum = cag_madd(terms[i], h, sum);
  return sum;
}

// The frame at distance h from a step's start.
static Frame frame_after(const Step *step, const Expansion *e, double h) {
  Frame f;
  CagVec3 normal = sum_series(e->n, h);
  f.point = series_point(step, h, 0);
  f.t = cag_unit(sum_series(e->t, h));
  f.n = cag_unit(cag_madd(normal, -cag_dot(normal, f.t), f.t));
  f.b = cag_cross(f.t, f.n);
  return f;
}

static CagStatus add_step(Natural *c, const Step *step, CagError *err) {
  char text[32];
  if (c->count == STEPS_MOST)
    return cag_fail(
        err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "curvature", -1,
        "the curvature or torsion changes too fast: up to s = %s, the curve needed %d steps",
        cag_number_text(step->start, text), STEPS_MOST);
  if (!CAG_RESERVE(c->steps, c->capacity, c->count + 1)) return cag_fail_memory(err);
  c->steps[c->count++] = *step;
  return CAG_OK;
}

static CagStatus solve(Natural *c, Frame frame, CagError *err) {
  double s = 0;
  const double least = STEP_LEAST * c->length;
  while (s < c->length) {
    double k[TERMS], w[TERMS];
    Expansion e;
    CagStatus status = c->equations.eval(c->equations.context, s, TERMS - 1, k, w, err);
    if (status) return status;
    Step step = {.start = s, .frame = frame};
    expand(&frame, k, w, TERMS, &e);
    integrate(frame.point, &e, TERMS, step.points);
    double h = step_length(&e, fabs(k[0]) + fabs(w[0]), c->length - s);
    for (bool good = false; !good && h > least; h = good ? h : h / 2) {
      status = agree(c, s, h, k, w, &good, err);
      if (status) return status;
    }
    h = fmax(h, least);
    status = add_step(c, &step, err);
    if (status) return status;
    frame = frame_after(&step, &e, h);
    s = s + h >= c->length || !(s + h > s) ? c->length : s + h;
  }
  return CAG_OK;
}

static const Step *find_step(const Natural *c, double s) {
  size_t low = 0, high = c->count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (c->steps[middle].start <= s) low = middle;
    else high = middle;
  }
  return &c->steps[low];
}

static CagStatus eval(void *context, double s, int order, CagVec3 *out, CagError *err) {
  const Natural *c = context;
  const Step *step = find_step(c, s);
  const double h = s - step->start;
  for (int i = 0; i <= order && i <= ORDER_KEPT; i++) out[i] = series_point(step, h, i);
  if (order <= ORDER_KEPT) return CAG_OK;
  double k[CAG_MAX_DERIVATIVE + 1], w[CAG_MAX_DERIVATIVE + 1];
  CagVec3 points[CAG_MAX_DERIVATIVE + 2];
  CagStatus status = c->equations.eval(c->equations.context, step->start, TERMS - 1, k, w, err);
  if (status) return status;
  Expansion e;
  expand(&step->frame, k, w, TERMS, &e);
  const Frame frame = frame_after(step, &e, h);
  status = c->equations.eval(c->equations.context, s, order - 2, k, w, err);
  if (status) return status;
  expand(&frame, k, w, order - 1, &e);
  integrate(frame.point, &e, order - 1, points);
  double factorial = 1;
  for (int i = 2; i <= order; i++) {
    factorial *= i;
    if (i > ORDER_KEPT) out[i] = cag_scaled(points[i], factorial);
  }
  return CAG_OK;
}

static void release(void *context) {
  Natural *c = context;
  if (c->equations.release) c->equations.release(c->equations.context);
  cag_free(c->steps);
  cag_free(c);
}

static CagStatus read_frame(const CagTransform *t, Frame *out, CagError *err) {
  const double slack = CAG_COINCIDENT;
  CagVec3 axis[4];
  for (int j = 0; j < 4; j++) axis[j] = cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
  bool good = cag_transform_is_affine(t);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) good = good && fabs(cag_dot(axis[i], axis[j]) - (i == j)) <= slack;
  good = good && cag_dot(cag_cross(axis[0], axis[1]), axis[2]) > 0;
  if (!good)
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_frame_not_orthonormal, "frame", -1,
        "`frame` must be a rigid motion: its x, y, and z axes are the tangent, normal, and binormal at the start, which are perpendicular unit vectors");
  *out = (Frame){axis[3], cag_unit(axis[0]), axis[1], axis[2]};
  out->n = cag_unit(cag_madd(axis[1], -cag_dot(axis[1], out->t), out->t));
  out->b = cag_cross(out->t, out->n);
  return CAG_OK;
}

CagStatus cag_curve_natural(const CagNaturalEquations *equations, double length,
                            const CagTransform *frame, int dimension, CagCurve **out,
                            CagError *err) {
  char text[32];
  if (!(length > 0) || !isfinite(length))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_length_not_positive, "length", -1,
                    "`length` must be positive, found %s", cag_number_text(length, text));
  Frame start;
  CagStatus status = read_frame(frame, &start, err);
  if (status) return status;
  Natural *c = cag_calloc(1, sizeof *c);
  if (!c) return cag_fail_memory(err);
  c->equations = *equations;
  c->length = length;
  status = solve(c, start, err);
  const CagCurveFunction function = {.eval = eval, .release = release, .context = c};
  if (!status) status = cag_curve_function(&function, dimension, 0, length, false, out, err);
  if (status) {
    c->equations.release = NULL; // the caller keeps the context
    release(c);
  }
  return status;
}
