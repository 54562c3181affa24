// B-splines from data points: parameters, knots, and the two banded systems.

#include "geom/curve/fit.h"

#include <lapacke.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/bspline.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/linalg/dense.h"

// Uniform knots suit interpolation if each basis function has at least this fraction of its maximum
// at its own data point; otherwise the curve oscillates between the points.
#define WELL_PLACED 0.5
// A diagonal entry of a triangle below this fraction of the largest is rounding: basis functions
// are all of size 1.
#define RANK_LOST 1e-13

void cag_fit_report_free(CagFitReport *r) {
  cag_free(r->parameters);
  cag_free(r->residuals);
  *r = (CagFitReport){0};
}

// --- Parameters ---

// Parameters of the data over [from, to], with steps in proportion to the spacing; repeated points
// are allowed.
static CagStatus spaced(const CagFitData *d, double from, double to, double *out, CagError *err) {
  double sum = 0;
  out[0] = 0;
  for (size_t i = 1; i < d->n; i++) {
    double step = 1;
    if (d->spacing != CAG_SPACING_UNIFORM) step = cag_norm(cag_sub(d->points[i], d->points[i - 1]));
    out[i] = sum += d->spacing == CAG_SPACING_CENTRIPETAL ? sqrt(step) : step;
  }
  if (!(sum > 0) || !isfinite(sum))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_chord_total, "points", -1,
                    sum > 0 ? "the distances of the points overflow"
                            : "all points coincide, so the parameter has no range");
  for (size_t i = 0; i < d->n; i++) out[i] = from + (to - from) * (out[i] / sum);
  out[d->n - 1] = to;
  return CAG_OK;
}

static CagStatus check_given(const CagFitData *d, double from, double to, CagError *err) {
  char a[32], b[32], c[32];
  for (size_t i = 0; i < d->n; i++) {
    const double t = d->parameters[i];
    if (!isfinite(t))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "parameters", (long)i,
                      "parameters[%zu] is not a finite number", i);
    if (i > 0 && t < d->parameters[i - 1])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_parameter, "parameters", (long)i,
                      "`parameters` must not decrease: parameters[%zu] = %s is less than "
                      "parameters[%zu] = %s",
                      i, cag_number_text(t, a), i - 1, cag_number_text(d->parameters[i - 1], b));
    if (t < from || t > to)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_parameter, "parameters", (long)i,
                      "parameters[%zu] = %s is outside of the usable range of the knots, %s..%s", i,
                      cag_number_text(t, a), cag_number_text(from, b), cag_number_text(to, c));
  }
  return CAG_OK;
}

// --- Knots ---

// Uniform knots over [from, to], clamped.
static void even_knots(size_t count, int p, double from, double to, double *out) {
  cag_knots_open(count, p, out);
  const double spans = (double)(count - (size_t)p);
  for (size_t i = 0; i < count + (size_t)p + 1; i++)
    out[i] = out[i] == spans ? to : from + (to - from) * (out[i] / spans);
}

// Each inner knot is the mean of p consecutive parameters; every parameter then lies inside the
// support of its basis function. u: as many as control points. Ends early if the work is canceled,
// with knots that are 0.
static void averaged_knots(const double *u, size_t count, int p, double *out) {
  memset(out, 0, (count + (size_t)p + 1) * sizeof *out);
  for (int i = 0; i <= p; i++) {
    out[i] = u[0];
    out[count + (size_t)i] = u[count - 1];
  }
  for (size_t j = 1; j + (size_t)p < count && !cag_stopped(); j++) {
    double sum = 0;
    for (int i = 0; i < p; i++) sum += u[j + (size_t)i] - u[0];
    out[j + (size_t)p] = u[0] + sum / p;
  }
}

// Inner knots such that every span contains about equally many of the n data (Piegl and Tiller
// 9.69).
static void spread_knots(const double *u, size_t n, size_t count, int p, double *out) {
  for (int i = 0; i <= p; i++) {
    out[i] = u[0];
    out[count + (size_t)i] = u[n - 1];
  }
  const double step = (double)n / (double)(count - (size_t)p);
  for (size_t j = 1; j + (size_t)p < count; j++) {
    const size_t i = (size_t)((double)j * step);
    const double part = (double)j * step - (double)i;
    out[j + (size_t)p] = u[i - 1] + part * (u[i] - u[i - 1]);
  }
}

// --- The design matrix: rows of basis functions ---

typedef struct Design {
  size_t rows, count; // conditions, control points
  int p;
  double *u;      // rows: parameters
  int *order;     // rows: 0 a point, 1 a derivative; NULL: all points
  CagVec3 *value; // rows
  double *knots;
  double *basis; // rows x (p + 1)
  size_t *first; // for each row: the control point of the first basis value
} Design;

static void design_free(Design *a) {
  cag_free(a->u);
  cag_free(a->order);
  cag_free(a->value);
  cag_free(a->knots);
  cag_free(a->basis);
  cag_free(a->first);
}

static CagStatus design_new(size_t rows, size_t count, int p, Design *out, CagError *err) {
  Design a = {.rows = rows, .count = count, .p = p};
  const size_t width = (size_t)p + 1;
  a.u = cag_malloc(rows * sizeof *a.u);
  a.order = cag_calloc(rows, sizeof *a.order);
  a.value = cag_malloc(rows * sizeof *a.value);
  a.knots = cag_malloc((count + width) * sizeof *a.knots);
  a.basis = cag_malloc(rows * width * sizeof *a.basis);
  a.first = cag_malloc(rows * sizeof *a.first);
  *out = a;
  if (a.u && a.order && a.value && a.knots && a.basis && a.first) return CAG_OK;
  design_free(&a);
  return cag_fail_memory(err);
}

static CagStatus fill_basis(Design *a, CagError *err) {
  double both[2 * (CAG_MAX_DEGREE + 1)];
  const size_t width = (size_t)a->p + 1;
  size_t span = width - 1;
  for (size_t r = 0; r < a->rows; r++) {
    if (cag_stop_check(err)) return err->status;
    span = cag_knots_span(a->knots, a->count, a->p, a->u[r], false, span);
    a->first[r] = span - (size_t)a->p;
    double *row = a->basis + r * width;
    if (a->order[r] == 0) {
      cag_bspline_basis(a->knots, a->p, span, a->u[r], row);
    } else {
      cag_bspline_derivatives(a->knots, a->p, span, a->u[r], 1, both);
      memcpy(row, both + width, width * sizeof *row);
    }
  }
  return CAG_OK;
}

static CagStatus make_curve(const Design *a, const CagVec3 *control, int dimension, CagCurve **out,
                            CagError *err) {
  return cag_curve_nurbs(control, NULL, a->count, a->p, a->knots, dimension, out, err);
}

// --- Checks of the arguments ---

static CagStatus check_data(const CagFitData *d, size_t count, CagError *err) {
  if (d->n < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "expected at least 2 points, found %zu", d->n);
  CagStatus status = cag_curve_check_points(d->points, d->n, "points", err);
  if (status) return status;
  if (d->degree < 1 || d->degree > CAG_MAX_DEGREE)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "the degree must be 1 to %d, found %d", CAG_MAX_DEGREE, d->degree);
  if ((size_t)d->degree >= count)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "degree %d needs at least %d control points, found %zu", d->degree,
                    d->degree + 1, count);
  if (d->kind == CAG_FIT_GIVEN) return cag_knots_check(d->knots, count, d->degree, err);
  return CAG_OK;
}

// The range of the parameter: the usable range of given knots, the range of given parameters, else
// 0..spans as for a clamped B-spline with integer knots.
static void range_of(const CagFitData *d, size_t count, double *from, double *to) {
  *from = 0;
  *to = (double)(count - (size_t)d->degree);
  if (d->kind == CAG_FIT_GIVEN) {
    *from = d->knots[d->degree];
    *to = d->knots[count];
  } else if (d->parameters) {
    *from = d->parameters[0];
    *to = d->parameters[d->n - 1];
  }
}

// Parameters of the data, into out.
static CagStatus find_parameters(const CagFitData *d, size_t count, double *out, CagError *err) {
  double from, to;
  range_of(d, count, &from, &to);
  if (!d->parameters) return spaced(d, from, to, out, err);
  CagStatus status = check_given(d, from, to, err);
  if (!status && !(from < to))
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_parameter, "parameters", -1,
                      "all parameters are the same");
  if (!status) memcpy(out, d->parameters, d->n * sizeof *out);
  return status;
}

// --- Interpolation ---

// Rows sorted by parameter: at each point its value, then its tangent if there is one; at the last
// point the tangent first, so that the ends of the band stay narrow.
static void fill_conditions(const CagFitData *d, const double *u, const CagVec3 *tangents,
                            size_t tangent_count, Design *a) {
  const bool everywhere = tangent_count == d->n;
  size_t r = 0;
  for (size_t i = 0; i < d->n; i++) {
    const bool last = i + 1 == d->n, has = tangents && (everywhere || i == 0 || last);
    for (int k = 0; k < (has ? 2 : 1); k++, r++) {
      a->order[r] = has && (last ? k == 0 : k == 1);
      a->u[r] = u[i];
      a->value[r] = !a->order[r] ? d->points[i] : tangents[everywhere ? i : last];
    }
  }
}

// Schoenberg-Whitney condition: the i-th parameter lies inside the support of the i-th basis
// function.
static CagStatus check_support(const Design *a, CagError *err) {
  if (cag_stop_check(err)) return err->status; // the knots may be unfinished
  const double start = a->knots[a->p], end = a->knots[a->count];
  char t[32], x[32], y[32];
  for (size_t i = 0; i < a->count; i++) {
    const double lo = a->knots[i], hi = a->knots[i + (size_t)a->p + 1], u = a->u[i];
    if ((u > lo && u < hi) || (u == lo && u == start && lo == a->knots[i + (size_t)a->p]) ||
        (u == hi && u == end && hi == a->knots[i + 1]))
      continue;
    // Repeated ends (a tangent with the point) use the second control point of a clamped end.
    if ((u == start && i > 0 && a->u[i - 1] == u && a->order[i] > 0 && lo == start && u < hi) ||
        (u == end && i + 1 < a->count && a->u[i + 1] == u && hi == end && u > lo))
      continue;
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_fit_singular, "parameters", (long)i,
        "no curve with these knots passes through all points: parameter %s of condition %zu is "
        "not inside the support %s..%s of its control point; use other knots "
        "(\"averaged\" ones always work) or increasing parameters",
        cag_number_text(u, t), i, cag_number_text(lo, x), cag_number_text(hi, y));
  }
  return CAG_OK;
}

// Whether with uniform knots each basis function is large enough at its own parameter.
static bool even_knots_suit(Design *a, CagError *scratch) {
  if (check_support(a, scratch)) return false;
  double best[CAG_MAX_DEGREE + 1];
  for (size_t i = 0; i < a->count; i++) {
    double peak = 0;
    for (int k = 1; k <= a->p; k++) peak += a->knots[i + (size_t)k];
    peak /= a->p;
    size_t span = cag_knots_span(a->knots, a->count, a->p, peak, false, (size_t)a->p);
    cag_bspline_basis(a->knots, a->p, span, peak, best);
    const double largest = best[i - (span - (size_t)a->p)];
    if (a->order[i] > 0) continue;
    span = cag_knots_span(a->knots, a->count, a->p, a->u[i], false, (size_t)a->p);
    cag_bspline_basis(a->knots, a->p, span, a->u[i], best);
    const size_t first = span - (size_t)a->p;
    // i is one of them: see check_support.
    if (best[i - first] < WELL_PLACED * largest) return false;
    if (cag_stopped()) return false; // fill_basis reports it
  }
  return true;
}

static CagStatus choose_knots(const CagFitData *d, Design *a, CagError *err) {
  if (d->kind == CAG_FIT_GIVEN) {
    memcpy(a->knots, d->knots, (a->count + (size_t)a->p + 1) * sizeof *a->knots);
    return check_support(a, err);
  }
  if (d->kind != CAG_FIT_AVERAGED) {
    even_knots(a->count, a->p, a->u[0], a->u[a->count - 1], a->knots);
    if (d->kind == CAG_FIT_OPEN) return check_support(a, err);
    if (even_knots_suit(a, err)) return CAG_OK;
  }
  averaged_knots(a->u, a->count, a->p, a->knots);
  return check_support(a, err);
}

// Solves the square banded system; control gets the points.
static CagStatus solve_banded(const Design *a, CagVec3 *control, CagError *err) {
  const size_t n = a->count, width = (size_t)a->p + 1;
  size_t kl = 0, ku = 0;
  for (size_t r = 0; r < n; r++) {
    if (r > a->first[r] && r - a->first[r] > kl) kl = r - a->first[r];
    const size_t last = a->first[r] + width - 1;
    if (last > r && last - r > ku) ku = last - r;
  }
  const size_t ld = 2 * kl + ku + 1;
  double *band = cag_calloc(ld * n, sizeof *band), *right = cag_malloc(3 * n * sizeof *right);
  CagStatus status = CAG_OK;
  if (!band || !right) {
    status = cag_fail_memory(err);
  } else {
    for (size_t r = 0; r < n; r++) {
      for (size_t j = 0; j < width; j++) {
        const size_t c = a->first[r] + j;
        band[c * ld + kl + ku + r - c] = a->basis[r * width + j];
      }
      right[r] = a->value[r].x;
      right[n + r] = a->value[r].y;
      right[2 * n + r] = a->value[r].z;
    }
    bool singular;
    status = cag_band_solve(band, n, kl, ku, right, 3, &singular, err);
    if (!status && singular)
      status = cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_fit_singular, "parameters", -1,
          "no curve with these knots passes through all points: the equations are singular; use \"averaged\" knots");
    for (size_t r = 0; !status && r < n; r++)
      control[r] = cag_vec3(right[r], right[n + r], right[2 * n + r]);
  }
  cag_free(band);
  cag_free(right);
  return status;
}

CagStatus cag_curve_interpolate(const CagFitData *d, const CagVec3 *tangents, size_t tangent_count,
                                CagCurve **out, CagError *err) {
  if (tangents && tangent_count != 2 && tangent_count != d->n)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_point_count, "tangents", -1,
                    "expected 2 tangents for the ends, or one for each of the %zu points, "
                    "found %zu",
                    d->n, tangent_count);
  const size_t count = d->n + (tangents ? tangent_count : 0);
  CagStatus status = check_data(d, count, err);
  if (!status && tangents)
    status = cag_curve_check_points(tangents, tangent_count, "tangents", err);
  if (status) return status;
  Design a;
  status = design_new(count, count, d->degree, &a, err);
  if (status) return status;
  double *u = cag_malloc(d->n * sizeof *u);
  CagVec3 *control = cag_malloc(count * sizeof *control);
  if (!u || !control) status = cag_fail_memory(err);
  if (!status) status = find_parameters(d, count, u, err);
  for (size_t i = 1; !status && i < d->n; i++)
    if (!(u[i] > u[i - 1]))
      status = cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_fit_singular, "points", (long)i,
          "points %zu and %zu have the same parameter, so no curve passes through both in turn; remove one of them",
          i - 1, i);
  if (!status) {
    fill_conditions(d, u, tangents, tangent_count, &a);
    status = choose_knots(d, &a, err);
  }
  if (!status) status = fill_basis(&a, err);
  if (!status) status = solve_banded(&a, control, err);
  if (!status) status = make_curve(&a, control, d->dimension, out, err);
  cag_free(control);
  cag_free(u);
  design_free(&a);
  return status;
}

// --- Conditions at the ends ---

// The knots of the second and the second to last point are left out. Fewer than 4 points determine a
// curve of a lower degree.
static CagStatus without_knots(const CagFitData *d, const double *u, CagCurve **out,
                               CagError *err) {
  CagFitData low = *d;
  low.parameters = u;
  low.degree = d->n < 4 ? (int)d->n - 1 : 3;
  const size_t p = (size_t)low.degree, count = d->n + p + 1;
  double *knots = cag_malloc(count * sizeof *knots);
  CagCurve *made = NULL;
  if (!knots) return cag_fail_memory(err);
  for (size_t i = 0; i < count; i++) knots[i] = i <= p ? u[0] : i >= d->n ? u[d->n - 1] : u[i - 2];
  low.kind = CAG_FIT_GIVEN;
  low.knots = knots;
  CagStatus status = cag_curve_interpolate(&low, NULL, 0, &made, err);
  if (!status && low.degree < 3) {
    status = cag_curve_elevate(made, 3 - low.degree, out, err);
    cag_curve_release(made);
  } else if (!status) {
    *out = made;
  }
  cag_free(knots);
  return status;
}

static CagStatus check_periodic(const CagFitData *d, CagError *err) {
  const CagVec3 gap = cag_sub(d->points[0], d->points[d->n - 1]);
  if (cag_norm(gap) <= CAG_CURVE_SAME * cag_curve_size(d->points, d->n)) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_closed, "points", (long)d->n - 1,
                  "a periodic curve ends in its first point, but the last point is at a distance "
                  "of %g from it; add the first point at the end",
                  cag_norm(gap));
}

CagStatus cag_curve_interpolate_ends(const CagFitData *data, CagFitEnds ends,
                                     const CagVec3 second[2], CagCurve **out, CagError *err) {
  CagFitData d = *data;
  d.kind = CAG_FIT_AUTO;
  d.degree = 1; // only the number of points matters here
  CagStatus status = check_data(&d, d.n, err);
  if (!status && ends == CAG_FIT_PERIODIC) status = check_periodic(&d, err);
  if (status) return status;
  d.degree = 3;
  const size_t fewest = 4, control = d.n + (ends == CAG_FIT_NOT_A_KNOT ? 0 : 2);
  double *u = cag_malloc(d.n * sizeof *u);
  if (!u) return cag_fail_memory(err);
  CagCubicEnds conditions = {.closing =
                                 ends == CAG_FIT_PERIODIC ? CAG_CUBIC_CYCLIC : CAG_CUBIC_ENDS};
  for (int e = 0; e < 2 && ends == CAG_FIT_SECOND; e++) conditions.second[e] = second[e];
  status = find_parameters(&d, control < fewest ? fewest : control, u, err);
  if (!status) status = cag_parameters_check(u, d.n, err);
  if (!status && ends == CAG_FIT_NOT_A_KNOT) status = without_knots(&d, u, out, err);
  else if (!status)
    status = cag_curve_cubic_spline(d.points, d.n, u, &conditions, NULL, d.dimension, out, err);
  cag_free(u);
  return status;
}

// --- Least squares ---

// A banded upper triangle: row i holds columns i .. i + p; right-hand sides are stored separately.
typedef struct Triangle {
  size_t n;
  size_t width;
  double *r;      // n x width
  CagVec3 *right; // n
} Triangle;

// Rotates one data row, whose entries start at column `first`, into the triangle.
static void rotate_in(Triangle *t, double *row, size_t first, CagVec3 value) {
  for (size_t k = 0; k < t->width && first + k < t->n; k++) {
    const double x = row[k];
    if (x == 0) continue;
    double *r = t->r + (first + k) * t->width;
    const double h = hypot(r[0], x), c = r[0] / h, s = x / h;
    r[0] = h;
    for (size_t j = 1; k + j < t->width; j++) {
      const double y = r[j], z = row[k + j];
      r[j] = c * y + s * z;
      row[k + j] = c * z - s * y;
    }
    // Entries of the triangle's row beyond the data row's end meet zeros.
    CagVec3 *q = &t->right[first + k];
    const CagVec3 old = *q;
    *q = cag_madd(cag_scaled(old, c), s, value);
    value = cag_madd(cag_scaled(value, c), -s, old);
  }
}

static CagStatus back_substitute(const Triangle *t, size_t offset, CagVec3 *out, CagError *err) {
  double largest = 0;
  for (size_t i = 0; i < t->n; i++) largest = fmax(largest, t->r[i * t->width]);
  for (size_t i = t->n; i-- > 0;) {
    const double *r = t->r + i * t->width;
    if (!(r[0] > RANK_LOST * largest))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_fit_singular, "parameters", (long)(i + offset),
                      "the data do not determine control point %zu: no parameter lies in its "
                      "support; use fewer control points or \"averaged\" knots",
                      i + offset);
    CagVec3 sum = t->right[i];
    for (size_t j = 1; j < t->width && i + j < t->n; j++) sum = cag_madd(sum, -r[j], out[i + j]);
    out[i] = cag_scaled(sum, 1 / r[0]);
  }
  return CAG_OK;
}

// Control points of the least squares curve. With `keep_ends` the first and last are given, and
// their contribution is subtracted from the data.
static CagStatus solve_least(const Design *a, bool keep_ends, CagVec3 *control, CagError *err) {
  const size_t skip = keep_ends ? 1 : 0, width = (size_t)a->p + 1, n = a->count - 2 * skip;
  if (keep_ends) {
    control[0] = a->value[0];
    control[a->count - 1] = a->value[a->rows - 1];
    if (n == 0) return CAG_OK;
  }
  Triangle t = {n, width, cag_calloc(n * width, sizeof(double)), cag_calloc(n, sizeof(CagVec3))};
  CagStatus status = CAG_OK;
  if (!t.r || !t.right) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < a->rows; i++) {
    if ((status = cag_stop_check(err)) != CAG_OK) break;
    double row[CAG_MAX_DEGREE + 1] = {0};
    CagVec3 value = a->value[i];
    size_t filled = 0, from = a->first[i];
    for (size_t j = 0; j < width; j++) {
      const size_t c = a->first[i] + j;
      const double b = a->basis[i * width + j];
      if (keep_ends && (c == 0 || c == a->count - 1)) {
        value = cag_madd(value, -b, control[c]);
        if (c == 0) from = 1;
      } else {
        row[filled++] = b;
      }
    }
    rotate_in(&t, row, from - skip, value);
  }
  if (!status) status = back_substitute(&t, skip, control + skip, err);
  cag_free(t.r);
  cag_free(t.right);
  return status;
}

// Whether every span of uniform knots contains a parameter: least squares then has a unique
// solution, and no part of the curve is undetermined.
static bool spans_filled(const Design *a) {
  size_t i = 0;
  for (size_t k = (size_t)a->p; k < a->count; k++) {
    while (i < a->rows && a->u[i] < a->knots[k]) i++;
    if (i == a->rows || a->u[i] > a->knots[k + 1]) return false;
  }
  return true;
}

static CagStatus choose_least_knots(const CagFitData *d, Design *a, bool keep_ends, CagError *err) {
  if (d->kind == CAG_FIT_GIVEN) {
    memcpy(a->knots, d->knots, (a->count + (size_t)a->p + 1) * sizeof *a->knots);
    if (keep_ends &&
        (a->knots[0] != a->knots[a->p] || a->knots[a->count] != a->knots[a->count + (size_t)a->p]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_fit_ends, "knots", -1,
                      "the ends stay fixed only where the end knots occur %d times; repeat them or "
                      "set `fixed` to \"none\"",
                      a->p + 1);
    return CAG_OK;
  }
  if (d->kind != CAG_FIT_AVERAGED) {
    even_knots(a->count, a->p, a->u[0], a->u[a->rows - 1], a->knots);
    if (d->kind == CAG_FIT_OPEN || spans_filled(a)) return CAG_OK;
  }
  if (a->count == a->rows) averaged_knots(a->u, a->count, a->p, a->knots);
  else spread_knots(a->u, a->rows, a->count, a->p, a->knots);
  return CAG_OK;
}

static double coordinate(CagVec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// One Newton step of every inner parameter towards its point's coordinate. *worst: the largest
// error before the step.
static CagStatus move_parameters(Design *a, const CagCurve *c, int axis, double slack,
                                 double *worst, CagError *err) {
  *worst = 0;
  for (size_t i = 1; i + 1 < a->rows; i++) {
    CagVec3 d[2];
    CagStatus status = cag_curve_eval(c, a->u[i], 1, CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    const double gap = coordinate(a->value[i], axis) - coordinate(d[0], axis);
    const double speed = coordinate(d[1], axis);
    *worst = fmax(*worst, fabs(gap));
    if (fabs(gap) <= slack) continue;
    if (speed == 0)
      return cag_fail(
          err, CAG_E_CONVERGENCE, CAG_ERR_fit_no_convergence, "fixed", (long)i,
          "the coordinate is stationary at point %zu, so its parameter is undetermined; "
          "the coordinate must increase or decrease throughout the data",
          i);
    a->u[i] = fmin(fmax(a->u[i] + gap / speed, c->start), c->end);
  }
  for (size_t i = 1; i < a->rows; i++)
    if (a->u[i] < a->u[i - 1])
      return cag_fail(
          err, CAG_E_CONVERGENCE, CAG_ERR_fit_no_convergence, "fixed", (long)i,
          "the parameters of points %zu and %zu lose their order; the coordinate must increase or decrease throughout the data",
          i - 1, i);
  return CAG_OK;
}

// Refits with moved parameters until the coordinate matches everywhere.
static CagStatus hold_coordinate(Design *a, int axis, double slack, int dimension, CagVec3 *control,
                                 CagCurve **curve, int *rounds, CagError *err) {
  double worst = INFINITY;
  for (*rounds = 0; *rounds < CAG_FIT_ROUNDS; ++*rounds) {
    CagStatus status = move_parameters(a, *curve, axis, slack, &worst, err);
    if (status || worst <= slack) return status;
    status = fill_basis(a, err);
    if (!status) status = solve_least(a, true, control, err);
    CagCurve *next;
    if (!status) status = make_curve(a, control, dimension, &next, err);
    if (status) return status;
    cag_curve_release(*curve);
    *curve = next;
  }
  char x[32], y[32];
  return cag_fail(
      err, CAG_E_CONVERGENCE, CAG_ERR_fit_no_convergence, "fixed", -1,
      "after %d rounds, the coordinate is still off by %s, more than the allowed error %s",
      CAG_FIT_ROUNDS, cag_number_text(worst, x), cag_number_text(slack, y));
}

static CagStatus make_report(Design *a, const CagCurve *c, int rounds, CagFitReport *out,
                             CagError *err) {
  CagVec3 *residuals = cag_malloc(a->rows * sizeof *residuals);
  if (!residuals) return cag_fail_memory(err);
  CagStatus status = cag_curve_eval_many(c, a->u, a->rows, 0, residuals, err);
  double sum = 0, largest = 0;
  for (size_t i = 0; !status && i < a->rows; i++) {
    residuals[i] = cag_sub(residuals[i], a->value[i]);
    const double length = cag_norm(residuals[i]);
    sum += length * length;
    largest = fmax(largest, length);
  }
  if (status) {
    cag_free(residuals);
    return status;
  }
  *out = (CagFitReport){a->u, residuals, sqrt(sum / (double)a->rows), largest, rounds};
  a->u = NULL;
  return CAG_OK;
}

CagStatus cag_curve_fit(const CagFitData *d, size_t count, bool keep_ends, int axis, double slack,
                        CagCurve **out, CagFitReport *report, CagError *err) {
  if (count > d->n)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_fit_underdetermined, "count", -1,
                    "%zu points cannot determine %zu control points; use at most %zu", d->n, count,
                    d->n);
  keep_ends = keep_ends || axis >= 0;
  CagStatus status = check_data(d, count, err);
  if (!status && axis >= d->dimension)
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_order, "fixed", -1,
                      "plane points have no z coordinate to keep");
  Design a;
  if (!status) status = design_new(d->n, count, d->degree, &a, err);
  if (status) return status;
  CagCurve *curve = NULL;
  int rounds = 0;
  CagVec3 *control = cag_malloc(count * sizeof *control);
  if (!control) status = cag_fail_memory(err);
  memcpy(a.value, d->points, d->n * sizeof *a.value);
  if (!status) status = find_parameters(d, count, a.u, err);
  if (!status) status = choose_least_knots(d, &a, keep_ends, err);
  if (!status) status = fill_basis(&a, err);
  if (!status) status = solve_least(&a, keep_ends, control, err);
  if (!status) status = make_curve(&a, control, d->dimension, &curve, err);
  if (!status && axis >= 0)
    status = hold_coordinate(&a, axis, slack, d->dimension, control, &curve, &rounds, err);
  if (!status && report) status = make_report(&a, curve, rounds, report, err);
  cag_free(control);
  design_free(&a);
  if (status) cag_curve_release(curve);
  else *out = curve;
  return status;
}
