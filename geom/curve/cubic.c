// Cubic splines and Hermite curves: parameter spacing, the system for the tangents, and the
// B-spline.

#include "geom/curve/cubic.h"

#include <lapacke.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"

// --- Parameters ---

static CagStatus check_count(size_t n, CagError *err) {
  if (n >= 2) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                  "expected at least 2 points, found %zu", n);
}

CagStatus cag_spacing_parameters(const CagVec3 *points, size_t n, CagSpacing spacing, double *out,
                                 CagError *err) {
  CagStatus status = check_count(n, err);
  if (!status) status = cag_curve_check_points(points, n, "points", err);
  if (status) return status;
  out[0] = 0;
  for (size_t i = 1; i < n; i++) {
    double length = 1;
    if (spacing != CAG_SPACING_UNIFORM) length = cag_norm(cag_sub(points[i], points[i - 1]));
    if (spacing == CAG_SPACING_CENTRIPETAL) length = sqrt(length);
    out[i] = out[i - 1] + length;
    if (!isfinite(out[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "points", (long)i,
                      "the points are so far apart that their distances overflow");
    // A step lost in the rounding of the sum counts as zero.
    if (!(out[i] > out[i - 1]))
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_coincident_points, "points", (long)i,
          "points[%zu] and points[%zu] coincide, so the parameter cannot increase by their distance; remove one of them, or use uniform parameters",
          i - 1, i);
  }
  return CAG_OK;
}

CagStatus cag_parameters_check(const double *parameters, size_t n, CagError *err) {
  char a[32], b[32];
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(parameters[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "parameters", (long)i,
                      "parameters[%zu] is not a finite number", i);
    if (i > 0 && !(parameters[i] > parameters[i - 1]))
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_bad_parameter_length, "parameters", (long)i,
          "the parameter must increase from point to point: it is %s at point %zu and %s "
          "at point %zu",
          cag_number_text(parameters[i - 1], a), i - 1, cag_number_text(parameters[i], b), i);
  }
  return CAG_OK;
}

// --- The system ---

// Rows below[i - 1], diagonal[i], above[i] and right sides [column * m + i], m rows.
typedef struct System {
  size_t m;
  double *below, *diagonal, *above, *right;
  double *all; // the block that holds them
} System;

// Columns of right sides: three coordinates, and one for the rank-one part of closed splines.
#define COLUMNS 4

static CagStatus system_new(size_t m, System *out, CagError *err) {
  double *all = cag_calloc(m * (3 + COLUMNS), sizeof *all);
  if (!all) return cag_fail_memory(err);
  *out = (System){m, all, all + m, all + 2 * m, all + 3 * m, all};
  return CAG_OK;
}

static void set_right(System *s, size_t row, CagVec3 v) {
  s->right[row] = v.x;
  s->right[s->m + row] = v.y;
  s->right[2 * s->m + row] = v.z;
}

static CagVec3 solution(const System *s, size_t row) {
  return cag_vec3(s->right[row], s->right[s->m + row], s->right[2 * s->m + row]);
}

static CagStatus solve(System *s, int columns, CagError *err) {
  if (cag_stop_check(err)) return err->status;
  if (LAPACKE_dgtsv(LAPACK_COL_MAJOR, (lapack_int)s->m, columns, s->below, s->diagonal, s->above,
                    s->right, (lapack_int)s->m) == 0)
    return CAG_OK;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_fit_singular, "parameters", -1,
                  "the lengths of the segments differ so much that the spline's equations cannot "
                  "be solved");
}

typedef struct Spline {
  const CagVec3 *points;
  size_t n;
  const double *u;
  const double *tension;
} Spline;

static CagVec3 slope(const Spline *s, size_t i) {
  return cag_scaled(cag_sub(s->points[i + 1], s->points[i]), 1 / (s->u[i + 1] - s->u[i]));
}

// Weights of the tangents before and after inner point i (their sum is 1), the diagonal, and the
// right-hand side: the spline equation divided by the sum of the two lengths.
static void inner_row(const Spline *s, size_t i, double *before, double *diagonal, double *after,
                      CagVec3 *right) {
  const double h = s->u[i] - s->u[i - 1], g = s->u[i + 1] - s->u[i], sum = h + g;
  *before = g / sum;
  *after = h / sum;
  *diagonal = 2;
  if (s->tension) *diagonal += s->tension[i - 1] * h * *before / 2;
  *right = cag_madd(cag_scaled(slope(s, i), 3 * *after), 3 * *before, slope(s, i - 1));
}

static CagStatus solve_open(const Spline *s, const CagCubicEnds *ends, CagVec3 *out,
                            CagError *err) {
  const size_t n = s->n;
  System a = {0};
  CagStatus status = system_new(n, &a, err);
  if (status) return status;
  CagVec3 right;
  for (size_t i = 1; i + 1 < n; i++) {
    inner_row(s, i, &a.below[i - 1], &a.diagonal[i], &a.above[i], &right);
    set_right(&a, i, right);
  }
  for (int e = 0; e < 2; e++) {
    const size_t row = e ? n - 1 : 0, i = e ? n - 2 : 0; // of the segment
    // The second derivative at the end of a segment of length h whose slope is s, with the tangents D
    // at the end and E at the other, is (6 s - 4 D - 2 E) / h, and negative at its finish.
    const double h = s->u[i + 1] - s->u[i];
    const CagVec3 bent = cag_madd(cag_scaled(slope(s, i), 3), (e ? h : -h) / 2, ends->second[e]);
    a.diagonal[row] = ends->clamped[e] ? 1 : 2;
    *(e ? &a.below[n - 2] : &a.above[0]) = ends->clamped[e] ? 0 : 1;
    set_right(&a, row, ends->clamped[e] ? ends->tangent[e] : bent);
  }
  status = solve(&a, 3, err);
  for (size_t i = 0; !status && i < n; i++) out[i] = solution(&a, i);
  cag_free(a.all);
  return status;
}

// Two unknowns of a closed spline: both corner entries coincide with the neighbors.
static void solve_two(const double m[2][2], const CagVec3 r[2], CagVec3 *out) {
  const double d = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  out[0] = cag_scaled(cag_madd(cag_scaled(r[0], m[1][1]), -m[0][1], r[1]), 1 / d);
  out[1] = cag_scaled(cag_madd(cag_scaled(r[1], m[0][0]), -m[1][0], r[0]), 1 / d);
}

// The unknowns are the first n - 1 tangents; the last is `sign` times the first. The corners of the
// matrix make it T + u v^T with T tridiagonal, so two solutions with T give the solution (Sherman
// and Morrison).
static CagStatus solve_closed(const Spline *s, double sign, CagVec3 *out, CagError *err) {
  const size_t n = s->n, m = n - 1;
  if (m == 1) {
    // The conditions give P' = (P2 - P1) / t2 for a cyclic spline, 0 for an anticyclic one.
    out[0] = out[1] = sign > 0 ? slope(s, 0) : cag_vec3(0, 0, 0);
    return CAG_OK;
  }
  // The row of the seam: segment m - 1 comes before point 0, segment 0 after it.
  const double h = s->u[m] - s->u[m - 1], g = s->u[1] - s->u[0], sum = h + g;
  const CagVec3 seam =
      cag_madd(cag_scaled(slope(s, 0), 3 * h / sum), sign * 3 * g / sum, slope(s, m - 1));
  const double first_corner = sign * g / sum;
  double last_corner;
  CagVec3 right;
  if (m == 2) {
    double a[2][2] = {{2, h / sum + first_corner}, {0, 0}};
    CagVec3 r[2] = {seam};
    inner_row(s, 1, &a[1][0], &a[1][1], &last_corner, &r[1]);
    a[1][0] += sign * last_corner;
    solve_two(a, r, out);
    out[2] = cag_scaled(out[0], sign);
    return CAG_OK;
  }
  System a = {0};
  CagStatus status = system_new(m, &a, err);
  if (status) return status;
  for (size_t i = 1; i < m; i++) {
    inner_row(s, i, &a.below[i - 1], &a.diagonal[i], i + 1 < m ? &a.above[i] : &last_corner,
              &right);
    set_right(&a, i, right);
  }
  last_corner *= sign;
  a.diagonal[0] = 2;
  a.above[0] = h / sum;
  set_right(&a, 0, seam);
  // u = [gamma, 0, .., last], v = [1, 0, .., first / gamma]
  const double gamma = -a.diagonal[0];
  a.diagonal[0] -= gamma;
  a.diagonal[m - 1] -= last_corner * first_corner / gamma;
  double *q = a.right + 3 * m;
  q[0] = gamma;
  q[m - 1] = last_corner;
  status = solve(&a, COLUMNS, err);
  if (!status) {
    const CagVec3 y0 = solution(&a, 0), y1 = solution(&a, m - 1);
    const double v = first_corner / gamma;
    const CagVec3 part = cag_scaled(cag_madd(y0, v, y1), 1 / (1 + q[0] + v * q[m - 1]));
    for (size_t i = 0; i < m; i++) out[i] = cag_madd(solution(&a, i), -q[i], part);
    out[m] = cag_scaled(out[0], sign);
  }
  cag_free(a.all);
  return status;
}

CagStatus cag_cubic_tangents(const CagVec3 *points, size_t n, const double *parameters,
                             const CagCubicEnds *ends, const double *tension, CagVec3 *out,
                             CagError *err) {
  CagStatus status = check_count(n, err);
  if (!status) status = cag_curve_check_points(points, n, "points", err);
  if (!status) status = cag_parameters_check(parameters, n, err);
  if (status) return status;
  char text[32];
  for (size_t i = 0; tension && i + 2 < n; i++)
    if (!(tension[i] >= 0) || !isfinite(tension[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_tension, "tension", (long)i,
                      "tensions must not be negative: tension[%zu] = %s", i,
                      cag_number_text(tension[i], text));
  const Spline s = {points, n, parameters, tension};
  if (ends->closing == CAG_CUBIC_ENDS) return solve_open(&s, ends, out, err);
  return solve_closed(&s, ends->closing == CAG_CUBIC_CYCLIC ? 1 : -1, out, err);
}

// --- The curve ---

// Control points and knots of a curve with inner knots of this multiplicity (1 or 2).
typedef struct Draft {
  CagVec3 *points;
  double *knots;
  size_t count;
} Draft;

static CagStatus draft_new(size_t n, size_t times, const double *u, Draft *out, CagError *err) {
  const size_t count = 4 + times * (n - 2), knots = count + 4;
  CagVec3 *points = cag_malloc(count * sizeof *points);
  double *k = cag_malloc(knots * sizeof *k);
  if (!points || !k) {
    cag_free(points);
    cag_free(k);
    return cag_fail_memory(err);
  }
  for (size_t i = 0; i < 4; i++) {
    k[i] = u[0];
    k[knots - 1 - i] = u[n - 1];
  }
  for (size_t i = 1; i + 1 < n; i++)
    for (size_t j = 0; j < times; j++) k[4 + times * (i - 1) + j] = u[i];
  *out = (Draft){points, k, count};
  return CAG_OK;
}

static CagStatus draft_finish(Draft *d, int dimension, CagCurve **out, CagError *err) {
  CagStatus status = cag_curve_nurbs(d->points, NULL, d->count, 3, d->knots, dimension, out, err);
  cag_free(d->points);
  cag_free(d->knots);
  return status;
}

// The inner Bezier point of a segment next to its start or end.
static CagVec3 after(const CagVec3 *p, const CagVec3 *d, const double *u, size_t i) {
  return cag_madd(p[i], (u[i + 1] - u[i]) / 3, d[i]);
}
static CagVec3 before(const CagVec3 *p, const CagVec3 *d, const double *u, size_t i) {
  return cag_madd(p[i], (u[i - 1] - u[i]) / 3, d[i]);
}

CagStatus cag_curve_hermite(const CagVec3 *points, const CagVec3 *tangents, size_t n,
                            const double *parameters, int dimension, CagCurve **out,
                            CagError *err) {
  CagStatus status = check_count(n, err);
  if (!status) status = cag_curve_check_points(points, n, "points", err);
  if (!status) status = cag_curve_check_points(tangents, n, "tangents", err);
  if (!status) status = cag_parameters_check(parameters, n, err);
  Draft d = {0};
  if (!status) status = draft_new(n, 2, parameters, &d, err);
  if (status) return status;
  size_t k = 0;
  d.points[k++] = points[0];
  for (size_t i = 0; i < n; i++) {
    if (i > 0) d.points[k++] = before(points, tangents, parameters, i);
    if (i + 1 < n) d.points[k++] = after(points, tangents, parameters, i);
  }
  d.points[k] = points[n - 1];
  return draft_finish(&d, dimension, out, err);
}

// With simple knots there is one control point for each inner point, on the line through the two
// Bezier points before it and on that through the two after it. It is computed from the longer of
// the two segments.
static CagVec3 control_point(const CagVec3 *p, const CagVec3 *d, const double *u, size_t i) {
  const double h = u[i] - u[i - 1], g = u[i + 1] - u[i];
  if (h > g) {
    CagVec3 b = before(p, d, u, i);
    return cag_madd(b, g / h, cag_sub(b, after(p, d, u, i - 1)));
  }
  CagVec3 a = after(p, d, u, i);
  return cag_madd(a, h / g, cag_sub(a, before(p, d, u, i + 1)));
}

CagStatus cag_curve_cubic_spline(const CagVec3 *points, size_t n, const double *parameters,
                                 const CagCubicEnds *ends, const double *tension, int dimension,
                                 CagCurve **out, CagError *err) {
  CagVec3 *tangents = cag_malloc((n ? n : 1) * sizeof *tangents);
  if (!tangents) return cag_fail_memory(err);
  CagStatus status = cag_cubic_tangents(points, n, parameters, ends, tension, tangents, err);
  if (!status && tension) {
    status = cag_curve_hermite(points, tangents, n, parameters, dimension, out, err);
  } else if (!status) {
    Draft d = {0};
    status = draft_new(n, 1, parameters, &d, err);
    if (!status) {
      d.points[0] = points[0];
      d.points[1] = after(points, tangents, parameters, 0);
      for (size_t i = 1; i + 1 < n; i++)
        d.points[i + 1] = control_point(points, tangents, parameters, i);
      d.points[n] = before(points, tangents, parameters, n - 1);
      d.points[n + 1] = points[n - 1];
      status = draft_finish(&d, dimension, out, err);
    }
  }
  cag_free(tangents);
  return status;
}
