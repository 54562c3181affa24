// Knot vectors and B-spline bases as data.

#include <limits.h>
#include <string.h>

#include "geom/basis/basis_table.h"
#include "geom/basis/bernstein.h"
#include "interp/builtin/curves.h"

bool cag_bsplines_uniform_knots(CagCall *call, const struct cag_bsplines_uniform_knots *a,
                                CagValue *result) {
  double *out;
  *result = cag_list_numbers(call->vm, (size_t)a->count, &out);
  for (long i = 0; i < a->count; i++) out[i] = a->start + (double)i * a->step;
  return true;
}

// The degree, for which the knots must be at least degree + 2, ascending and finite.
static bool read_degree(CagCall *call, CagNumbers knots, int degree_at, int order_at, int *degree) {
  const double *x = knots.items;
  const size_t count = knots.count;
  if (!cag_arg_degree(call, degree_at, order_at, 3, degree)) return false;
  CagStatus status = CAG_OK;
  char a[32], b[32];
  if (*degree < 1 || *degree > CAG_MAX_DEGREE)
    status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                      "the degree must be 1 to %d, found %d", CAG_MAX_DEGREE, *degree);
  else if (count < (size_t)*degree + 2)
    status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_knot_count, "knots", -1,
                      "a basis function of degree %d needs %d knots, found %zu", *degree,
                      *degree + 2, count);
  for (size_t i = 0; !status && i < count; i++) {
    if (!isfinite(x[i]))
      status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "knots", (long)i,
                        "knots[%zu] is not a finite number", i);
    else if (i > 0 && x[i] < x[i - 1])
      status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_knots_not_monotone, "knots", (long)i,
                        "`knots` must not decrease: knots[%zu] = %s is less than knots[%zu] = %s",
                        i, cag_number_text(x[i], a), i - 1, cag_number_text(x[i - 1], b));
  }
  if (!status && !(x[0] < x[count - 1]))
    status =
        cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "knots", 0, "all knots are equal");
  return cag_geometry_ok(call, status);
}

static CagValue interval(CagCall *call, double a, double b) {
  return cag_domain_value(call->vm, false, a, b);
}

bool cag_bsplines_classify_knots(CagCall *call, const struct cag_bsplines_classify_knots *a,
                                 CagValue *result) {
  static const char *const names[] = {"class", "degree",   "points",    "multiplicities",
                                      "range", "segments", "full_range"};
  const double *x = a->knots.items;
  const size_t count = a->knots.count;
  int p;
  if (!read_degree(call, a->knots, 1, 2, &p)) return false;
  const size_t n = count - (size_t)p - 1, k = (size_t)p;
  if (n < k + 1)
    return cag_fail_core(call, CAG_E_ARGUMENT, CAG_ERR_knot_count, "knots", -1,
                         "a curve of degree %d needs at least %zu `knots`, found %zu", p, 2 * k + 2,
                         count);
  // The range may be empty, which only a curve minds; multiplicities may be too high.
  char text[32];
  CagBuilder *list = cag_builder_new(call->vm);
  size_t segments = 0;
  for (size_t i = 0, run; i < count; i += run) {
    for (run = 1; i + run < count && x[i + run] == x[i]; run++) {}
    const bool inner = x[i] > x[0] && x[i] < x[count - 1];
    if (run > k + 1 || (inner && run > k && x[k] < x[i] && x[i] < x[n]))
      return cag_fail_core(
          call, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, "knots", (long)i,
          "the knot %s occurs %zu times: degree %d allows %d inside and %d at the ends",
          cag_number_text(x[i], text), run, p, p, p + 1);
    const double pair[2] = {x[i], (double)run};
    if (!cag_builder_add(call->vm, list, cag_vector(call->vm, pair, 2))) return false;
    segments += i + run < count && x[i] >= x[k] && x[i + run] <= x[n];
  }
  CagValue values[] = {cag_text_c(call->vm, cag_knots_class(x, n, p)),
                       cag_number(p),
                       cag_number((double)n),
                       cag_builder_finish(call->vm, list),
                       interval(call, x[k], x[n]),
                       cag_number((double)segments),
                       interval(call, x[0], x[count - 1])};
  *result = cag_record_new(call->vm, names, values, 7);
  return true;
}

// --- Values ---

typedef struct Basis {
  const double *knots, *weights; // weights: NULL, or one for each function
  size_t count, n;
  int degree, derivative;
  bool left;
  double *rows, *work; // derivative + 1 rows of n; degree + 2
} Basis;

// R_i = h_i N_i / S: the rule of Leibniz on R_i S = h_i N_i, with the sums S of the derivatives.
static CagStatus make_rational(const Basis *b, double t, CagError *err) {
  char text[32];
  const size_t n = b->n;
  double sums[CAG_MAX_DERIVATIVE + 1];
  for (int d = 0; d <= b->derivative; d++) {
    double *row = b->rows + (size_t)d * n;
    sums[d] = 0;
    for (size_t i = 0; i < n; i++) sums[d] += row[i] *= b->weights[i];
    if (!(sums[0] > 0))
      return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "weights", -1,
                      "all functions that act at t = %s have the weight 0",
                      cag_number_text(t, text));
    double binomial = 1; // C(d, j)
    for (int j = 1; j <= d; j++) {
      binomial = binomial * (d - j + 1) / j;
      const double *lower = b->rows + (size_t)(d - j) * n;
      for (size_t i = 0; i < n; i++) row[i] -= binomial * sums[j] * lower[i];
    }
    for (size_t i = 0; i < n; i++) row[i] /= sums[0];
  }
  return CAG_OK;
}

static CagStatus basis_at(const Basis *b, double t, double *out, CagError *err) {
  size_t at;
  CagStatus status = cag_basis_interval(b->knots, b->count, b->degree, t, b->left, &at, err);
  for (int d = b->weights ? 0 : b->derivative; !status && d <= b->derivative; d++)
    cag_basis_derivative(b->knots, b->count, b->degree, at, t, d, b->work,
                         b->rows + (size_t)d * b->n);
  if (!status && b->weights) status = make_rational(b, t, err);
  if (!status) memcpy(out, b->rows + (size_t)b->derivative * b->n, b->n * sizeof *out);
  return status;
}

static bool check_basis_weights(CagCall *call, CagNumbers weights, size_t n) {
  char text[32];
  CagStatus status = CAG_OK;
  if (weights.count != n)
    status =
        cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_weight_count, "weights", -1,
                 "expects one of `weights` for each of %zu functions, found %zu", n, weights.count);
  for (size_t i = 0; !status && i < n; i++)
    if (!(weights.items[i] >= 0))
      status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_negative_weight, "weights", (long)i,
                        "weights must not be negative: weights[%zu] = %s", i,
                        cag_number_text(weights.items[i], text));
  return cag_geometry_ok(call, status);
}

// One row, or as many as there are parameters.
static bool give_basis(CagCall *call, const Basis *b, CagValue *result) {
  const double *list = NULL;
  double t, *out;
  size_t rows = 1;
  const bool several = call->values[2].type != CAG_NUMBER;
  if (several ? !cag_arg_numbers(call, 2, &list, &rows) : !cag_arg_finite(call, 2, &t))
    return false;
  if (!several) {
    *result = cag_list_numbers(call->vm, b->n, &out);
    return cag_geometry_ok(call, basis_at(b, t, out, call->err));
  }
  CagBuilder *all = cag_builder_new(call->vm);
  for (size_t i = 0; i < rows; i++) {
    CagValue row = cag_list_numbers(call->vm, b->n, &out);
    if (!cag_geometry_ok(call, basis_at(b, list[i], out, call->err)) ||
        !cag_builder_add(call->vm, all, row) || !cag_keep_going(call->vm))
      return false;
  }
  *result = cag_builder_finish(call->vm, all);
  return true;
}

bool cag_bsplines_basis(CagCall *call, const struct cag_bsplines_basis *a, CagValue *result) {
  Basis b = {.knots = a->knots.items,
             .weights = a->weights.items,
             .count = a->knots.count,
             .derivative = (int)a->derivative,
             .left = a->side == CAG_SIDE_LEFT};
  if (!read_degree(call, a->knots, 1, 4, &b.degree)) return false;
  b.n = b.count - (size_t)b.degree - 1;
  if (cag_given(call, 5) && !check_basis_weights(call, a->weights, b.n)) return false;
  const size_t size = (size_t)(b.derivative + 1) * b.n;
  b.rows = cag_hold_array(call, size + (size_t)b.degree + 2, sizeof *b.rows);
  b.work = b.rows + size;
  return give_basis(call, &b, result);
}

bool cag_bsplines_basis_triangle(CagCall *call, const struct cag_bsplines_basis_triangle *a,
                                 CagValue *result) {
  const double *x = a->knots.items, t = a->t;
  const size_t count = a->knots.count;
  size_t at;
  int p;
  if (!read_degree(call, a->knots, 1, 3, &p) ||
      !cag_geometry_ok(call, cag_basis_interval(x, count, p, t, false, &at, call->err)))
    return false;
  double *rows = cag_hold_array(call, (size_t)(p + 1) * (count - 1), sizeof *rows);
  cag_basis_triangle(x, count, p, at, t, rows);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t q = 0; q <= (size_t)p; q++)
    if (!cag_builder_add(call->vm, list,
                         cag_vector(call->vm, rows + q * (count - 1), count - 1 - q)))
      return false;
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// --- Pieces ---

// Record of one interval: its functions with their coefficients.
static CagValue piece_record(CagCall *call, const double *x, size_t count, int p, size_t at,
                             bool local, double *table) {
  static const char *const names[] = {"interval", "functions", "coefficients", "matrix"};
  CagVm *vm = call->vm;
  const size_t k = (size_t)p, n = count - k - 1, width = k + 1;
  cag_basis_piece(x, count, p, at, local, table);
  const size_t first = at > k ? at - k : 0, last = at < n ? at : n - 1;
  CagBuilder *functions = cag_builder_new(vm), *rows = cag_builder_new(vm),
             *matrix = cag_builder_new(vm);
  for (size_t i = first; i <= last; i++) {
    cag_builder_add(vm, functions, cag_number((double)i));
    cag_builder_add(vm, rows, cag_vector(vm, table + (i + k - at) * width, width));
  }
  // Rows of the matrix: powers from the highest down; columns: the functions.
  for (size_t power = width; power-- > 0;) {
    double *out;
    CagValue row = cag_list_numbers(vm, last - first + 1, &out);
    for (size_t i = first; i <= last; i++) out[i - first] = table[(i + k - at) * width + power];
    cag_builder_add(vm, matrix, row);
  }
  CagValue values[] = {interval(call, x[at], x[at + 1]), cag_builder_finish(vm, functions),
                       cag_builder_finish(vm, rows), cag_builder_finish(vm, matrix)};
  return cag_record_new(vm, names, values, 4);
}

bool cag_bsplines_basis_pieces(CagCall *call, const struct cag_bsplines_basis_pieces *a,
                               CagValue *result) {
  const double *x = a->knots.items;
  const size_t count = a->knots.count;
  int p;
  if (!read_degree(call, a->knots, 1, 2, &p)) return false;
  double *table = cag_hold_array(call, (size_t)(p + 1) * (size_t)(p + 1), sizeof *table);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i + 1 < count; i++)
    if (x[i] < x[i + 1])
      if (!cag_builder_add(call->vm, list, piece_record(call, x, count, p, i, a->local, table)))
        return false;
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// --- Dependency ---

// Indices low..high within 0..most, as a list.
static CagValue indices(CagCall *call, long low, long high, long most) {
  double *out;
  low = low < 0 ? 0 : low;
  high = high > most ? most : high;
  CagValue list = cag_list_numbers(call->vm, high < low ? 0 : (size_t)(high - low + 1), &out);
  for (long i = low; i <= high; i++) out[i - low] = (double)i;
  return list;
}

bool cag_bsplines_basis_dependency(CagCall *call, const struct cag_bsplines_basis_dependency *a,
                                   CagValue *result) {
  static const char *const names[] = {"needs", "feeds"};
  const long i = a->i, count = cag_given(call, 3) ? a->count : LONG_MAX / 2;
  int p;
  if (!cag_arg_degree(call, 1, 2, 3, &p)) return false;
  if (p > CAG_MAX_DEGREE)
    return cag_fail_call(call, 1, CAG_ERR_value, "takes a degree up to %d", CAG_MAX_DEGREE);
  CagBuilder *needs = cag_builder_new(call->vm), *feeds = cag_builder_new(call->vm);
  for (long q = 0; q <= p; q++) {
    // Of degree q there are count + p - q functions.
    const long most = count + p - q - 1;
    if (!cag_builder_add(call->vm, needs, indices(call, i, i + p - q, most)) ||
        !cag_builder_add(call->vm, feeds, indices(call, i - q, i, most)))
      return false;
  }
  CagValue values[] = {cag_builder_finish(call->vm, needs), cag_builder_finish(call->vm, feeds)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

// --- Refinement ---

// Most numbers in the tables of one refinement: 800 MB.
#define TABLE_MAX 1e8

bool cag_bsplines_oslo(CagCall *call, const struct cag_bsplines_oslo *a, CagValue *result) {
  const double *x = a->knots.items, *y = a->refined.items;
  const size_t count = a->knots.count, n = a->refined.count;
  int p;
  if (!read_degree(call, a->knots, 2, 3, &p)) return false;
  if (n < count)
    return cag_fail_core(call, CAG_E_ARGUMENT, CAG_ERR_not_a_refinement, "refined", -1,
                         "`refined` has %zu knots, fewer than the %zu of `knots`", n, count);
  const size_t m = n - (size_t)p - 1, block = (count - 1) * m;
  if ((double)(count - 1) * (double)m * (double)(p + 1) > TABLE_MAX)
    return cag_fail_call(call, -1, CAG_ERR_limit_memory, "needs more memory than is available");
  double *table = cag_hold_array(call, block * (size_t)(p + 1), sizeof *table);
  if (!cag_geometry_ok(call, cag_basis_oslo(x, count, y, n, p, table, call->err))) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t q = 0; q <= (size_t)p; q++) {
    CagBuilder *rows = cag_builder_new(call->vm);
    for (size_t i = 0; i + q + 1 < count; i++)
      if (!cag_builder_add(call->vm, rows, cag_vector(call->vm, table + q * block + i * m, m)))
        return false;
    if (!cag_builder_add(call->vm, list, cag_builder_finish(call->vm, rows))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// --- Phantom vertices ---

// What holds at an end of a uniform B-spline: a derivative (0: the point) and its value.
typedef struct EndCondition {
  int derivative;
  CagVec3 value;
} EndCondition;

static bool read_end(CagCall *call, int argument, CagVec3 end_point, int dimension,
                     EndCondition *out) {
  static const char wanted[] = "\"position\", {tangent: V} or {second: V}";
  *out = (EndCondition){0, end_point};
  if (!cag_given(call, argument)) return true;
  const CagValue v = call->values[argument];
  if (v.type == CAG_TEXT && strcmp(CAG_AS_TEXT(v)->bytes, "position") == 0) return true;
  if (v.type != CAG_RECORD) return cag_fail_type(call, argument, wanted);
  CagValue tangent = cag_record_get(CAG_AS_RECORD(v), "tangent");
  CagValue second = cag_record_get(CAG_AS_RECORD(v), "second");
  const CagValue given = tangent.type != CAG_UNSET ? tangent : second;
  const double *x;
  size_t n;
  if (!cag_as_vector(given, &x, &n) || n != (size_t)dimension)
    return cag_fail_type(call, argument, wanted);
  out->derivative = tangent.type != CAG_UNSET ? 1 : 2;
  out->value = cag_vec3(x[0], x[1], n > 2 ? x[2] : 0);
  return true;
}

// The point before points[0] (step 1) or behind points[n - 1] (step -1): of the degree + 1 points
// that act at the end the outermost, so that the condition holds. Weights come from the basis at
// the end of uniform knots.
static CagStatus phantom(const EndCondition *c, const CagVec3 *points, size_t n, int p, bool last,
                         double *work, CagVec3 *out, CagError *err) {
  const size_t k = (size_t)p, count = 2 * k + 2;
  if (c->derivative > p)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, last ? "end" : "start", -1,
                    "a curve of degree %d cannot have a given derivative of order %d", p,
                    c->derivative);
  double *knots = work, *weights = knots + count, *rest = weights + k + 1;
  for (size_t i = 0; i < count; i++) knots[i] = (double)i;
  cag_basis_derivative(knots, count, p, k, last ? (double)k + 1 : (double)k, c->derivative, rest,
                       weights);
  CagVec3 sum = c->value;
  for (size_t i = 0; i < k; i++) {
    // Known points from the end inwards have the weights 1, 2, .. from the phantom's.
    const CagVec3 known = last ? points[n - 1 - i] : points[i];
    sum = cag_madd(sum, -weights[last ? k - 1 - i : 1 + i], known);
  }
  *out = cag_scaled(sum, 1 / weights[last ? k : 0]);
  return CAG_OK;
}

bool cag_bsplines_phantom_points(CagCall *call, const struct cag_bsplines_phantom_points *a,
                                 CagValue *result) {
  const CagVec3 *points = a->points.items;
  const size_t n = a->points.count;
  const int dimension = a->points.dimension;
  int p;
  EndCondition start, end;
  if (!cag_arg_degree(call, 1, 4, 3, &p) ||
      !cag_geometry_ok(call, cag_degree_check(n, p, call->err)) ||
      !read_end(call, 2, points[0], dimension, &start) ||
      !read_end(call, 3, points[n - 1], dimension, &end))
    return false;
  CagVec3 *all = cag_hold_array(call, n + 2, sizeof *all);
  double *work = cag_hold_array(call, 4 * (size_t)p + 8, sizeof *work);
  memcpy(all + 1, points, sizeof *all * n);
  CagStatus status = phantom(&start, points, n, p, false, work, &all[0], call->err);
  if (!status) status = phantom(&end, points, n, p, true, work, &all[n + 1], call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_points_value(call->vm, all, n + 2, dimension);
  return true;
}
