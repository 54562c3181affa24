// Matrices as lists of rows, and polynomials: linear systems, eigenvalues, roots.
//
// Decompositions are LAPACK's, of large matrices those of geom/linalg/dense. A matrix counts as
// singular where its reciprocal condition number is below the rounding error: its solution would be
// noise.

#include <float.h>
#include <stdlib.h>
#include <string.h>

// LAPACKE's complex type is C's.
#include <lapacke.h>

#include "geom/linalg/complex.h"
#include "geom/linalg/dense.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// --- Reading and giving ---

typedef struct Matrix {
  size_t rows, columns;
  double *x; // by rows; held
} Matrix;

// Rows of a matrix, and numbers, after which the run is asked whether it must stop.
enum { ROWS_BETWEEN_CHECKS = 16, NUMBERS_BETWEEN_CHECKS = 1 << 18 };

// A matrix of zeros.
static Matrix matrix_new(CagCall *call, size_t rows, size_t columns) {
  return (Matrix){rows, columns, cag_hold_array(call, rows * columns, sizeof(double))};
}

static bool check_finite(CagCall *call, int argument, const Matrix *m) {
  for (size_t i = 0; i < m->rows * m->columns; i++) {
    if (!isfinite(m->x[i])) return cag_fail_value(call, argument, "finite numbers");
    if (i % NUMBERS_BETWEEN_CHECKS == 0 && !cag_keep_going(call->vm)) return false;
  }
  return true;
}

// Row i of a matrix that is not a packed list: too long, or no row.
static bool read_row(CagCall *call, int argument, const CagList *list, size_t i, const double **x,
                     size_t *n) {
  CagValue row = cag_list_get(call->vm, list, i);
  return cag_as_vector(row, x, n) || cag_fail_element(call, argument, i, row, "rows of numbers");
}

static bool read_rows(CagCall *call, int argument, Matrix *out) {
  CagValue v = call->values[argument];
  if (v.type != CAG_LIST) return cag_fail_type(call, argument, "a matrix (a list of rows)");
  const CagList *list = CAG_AS_LIST(v);
  const double *x;
  size_t n, columns;
  if (list->length == 0) return cag_fail_value(call, argument, "a matrix of at least one row");
  if (!read_row(call, argument, list, 0, &x, &columns)) return false;
  *out = matrix_new(call, list->length, columns);
  for (size_t i = 0; i < list->length; i++) {
    if (!read_row(call, argument, list, i, &x, &n)) return false;
    if (n != columns)
      return cag_fail_call(
          call, argument, CAG_ERR_length,
          "expects rows of the same length as `%s`, found %zu numbers in row 0 and %zu in row %zu",
          cag_parameter_name(call, argument), columns, n, i);
    memcpy(out->x + i * columns, x, columns * sizeof *x);
    if (i % ROWS_BETWEEN_CHECKS == 0 && !cag_keep_going(call->vm)) return false;
  }
  return true;
}

static bool read_matrix(CagCall *call, int argument, Matrix *out) {
  return read_rows(call, argument, out) && check_finite(call, argument, out);
}

static bool read_square(CagCall *call, int argument, const char *help, Matrix *out) {
  if (!read_matrix(call, argument, out)) return false;
  if (out->rows == out->columns) return true;
  cag_fail_call(call, argument, CAG_ERR_length,
                "expects a square matrix, found %zu rows and %zu columns", out->rows, out->columns);
  return help && cag_fail_help(call->vm, "%s", help);
}

// A vector (as one column; *vector is set) or a matrix with so many rows.
static bool read_right_side(CagCall *call, int argument, size_t rows, const char *as, Matrix *out,
                            bool *vector) {
  const double *x;
  size_t n;
  *vector = cag_as_vector(call->values[argument], &x, &n);
  if (*vector) {
    *out = matrix_new(call, n, 1);
    memcpy(out->x, x, n * sizeof *x);
    if (!check_finite(call, argument, out)) return false;
  } else if (!read_matrix(call, argument, out)) {
    return false;
  }
  return out->rows == rows ||
         cag_fail_call(call, argument, CAG_ERR_length,
                       "expects %zu rows in `%s`, as many as `%s` has %s, found %zu", rows,
                       cag_parameter_name(call, argument), cag_parameter_name(call, 0), as,
                       out->rows);
}

// The first rows of m as a list of rows, or its only column as a vector.
static CagValue give_rows(CagVm *vm, const Matrix *m, size_t rows, bool vector) {
  if (vector) return cag_vector(vm, m->x, rows);
  CagBuilder *built = cag_builder_new(vm);
  for (size_t i = 0; i < rows; i++)
    cag_builder_add(vm, built, cag_vector(vm, m->x + i * m->columns, m->columns));
  return cag_builder_finish(vm, built);
}

static bool give_matrix(CagCall *call, Matrix *m, size_t rows, bool vector, CagValue *result) {
  for (size_t i = 0; i < rows * m->columns; i++) {
    m->x[i] += 0.0; // never -0
    if (!isfinite(m->x[i])) return cag_fail_call(call, 0, CAG_ERR_not_finite, "overflows");
    if (i % NUMBERS_BETWEEN_CHECKS == 0 && !cag_keep_going(call->vm)) return false;
  }
  *result = give_rows(call->vm, m, rows, vector);
  return true;
}

// --- Linear systems ---

static bool fail_singular(CagCall *call) {
  return cag_fail_call(
      call, 0, CAG_ERR_singular,
      "expects a matrix that is not singular, found one with linearly dependent rows");
}

static bool is_large(double multiplications) { return multiplications > CAG_LAPACK_MOST; }

static double norm_of_columns(const Matrix *m, double *sums) {
  double largest = 0;
  memset(sums, 0, m->columns * sizeof *sums);
  for (size_t i = 0; i < m->rows; i++)
    for (size_t j = 0; j < m->columns; j++) sums[j] += fabs(m->x[i * m->columns + j]);
  for (size_t j = 0; j < m->columns; j++) largest = fmax(largest, sums[j]);
  return largest;
}

// The same as solve_system for a matrix that is large or has many right sides.
static bool solve_large(CagCall *call, Matrix *a, Matrix *b) {
  const size_t n = a->rows;
  size_t *pivots = cag_hold_array(call, n, sizeof *pivots);
  const double norm = norm_of_columns(a, cag_hold_array(call, n, sizeof(double)));
  double reciprocal = 0;
  bool singular;
  CagStatus status = cag_lu_factor(a->x, n, pivots, &singular, call->err);
  if (!status && !singular)
    status = cag_lu_condition(a->x, n, pivots, norm, &reciprocal, call->err);
  if (!status && !(reciprocal > DBL_EPSILON)) return fail_singular(call);
  if (!status) status = cag_lu_solve(a->x, n, pivots, b->x, b->columns, call->err);
  return cag_geometry_ok(call, status);
}

// Replaces a by its LU decomposition, and b by the solution.
static bool solve_system(CagCall *call, Matrix *a, Matrix *b) {
  const double size = (double)a->rows;
  if (is_large(size * size * (size / 3 + (double)b->columns))) return solve_large(call, a, b);
  const lapack_int n = (lapack_int)a->rows, columns = (lapack_int)b->columns;
  lapack_int *pivots = cag_hold_array(call, a->rows, sizeof *pivots);
  double norm = LAPACKE_dlange(LAPACK_ROW_MAJOR, '1', n, n, a->x, n), reciprocal = 0;
  const lapack_int info = LAPACKE_dgetrf(LAPACK_ROW_MAJOR, n, n, a->x, n, pivots);
  if (info < 0) cag_vm_out_of_memory(call->vm);
  // Where a pivot is 0, the reciprocal is.
  if (info == 0) LAPACKE_dgecon(LAPACK_ROW_MAJOR, '1', n, a->x, n, norm, &reciprocal);
  if (!(reciprocal > DBL_EPSILON)) return fail_singular(call);
  LAPACKE_dgetrs(LAPACK_ROW_MAJOR, 'N', n, columns, a->x, n, pivots, b->x, columns);
  return true;
}

bool cag_matrices_solve(CagCall *call, CagValue *result) {
  Matrix a, b;
  bool vector;
  return read_square(call, 0, "least_squares takes any number of rows", &a) &&
         read_right_side(call, 1, a.rows, "rows", &b, &vector) && solve_system(call, &a, &b) &&
         give_matrix(call, &b, b.rows, vector, result);
}

// Copies a matrix to one by columns, or back.
static bool copy_transposed(CagCall *call, const Matrix *m, bool back, double *columns) {
  for (size_t i = 0; i < m->rows; i++) {
    for (size_t j = 0; j < m->columns; j++) {
      double *row = &m->x[i * m->columns + j], *column = &columns[j * m->rows + i];
      if (back) *row = *column;
      else *column = *row;
    }
    if (!cag_keep_going(call->vm)) return false;
  }
  return true;
}

// Least squares by Householder reflections; x has as many rows as the larger of a's rows and
// columns.
static bool solve_large_least_squares(CagCall *call, const Matrix *a, Matrix *x, double cut) {
  Matrix turned = matrix_new(call, a->columns, a->rows);
  Matrix sides = matrix_new(call, x->columns, x->rows);
  return copy_transposed(call, a, false, turned.x) && copy_transposed(call, x, false, sides.x) &&
         cag_geometry_ok(call, cag_least_squares(turned.x, a->rows, a->columns, sides.x, x->rows,
                                                 x->columns, &cut, call->err)) &&
         copy_transposed(call, x, true, sides.x);
}

static bool solve_least_squares(CagCall *call, Matrix *a, Matrix *x) {
  const size_t least = a->rows < a->columns ? a->rows : a->columns;
  // Singular values, or diagonal entries, below this part of the largest count as 0.
  const double cut = DBL_EPSILON * (double)x->rows;
  if (is_large((double)a->rows * (double)a->columns * (double)(least + x->columns)))
    return solve_large_least_squares(call, a, x, cut);
  double *singular_values = cag_hold_array(call, least, sizeof *singular_values);
  lapack_int rank, columns = (lapack_int)x->columns;
  const lapack_int info =
      LAPACKE_dgelsd(LAPACK_ROW_MAJOR, (lapack_int)a->rows, (lapack_int)a->columns, columns, a->x,
                     (lapack_int)a->columns, x->x, columns, singular_values, cut, &rank);
  return info == 0 || cag_fail_call(call, 0, CAG_ERR_convergence,
                                    "does not converge: the singular values could not be found");
}

bool cag_matrices_least_squares(CagCall *call, CagValue *result) {
  Matrix a, b;
  bool vector;
  if (!read_matrix(call, 0, &a) || !read_right_side(call, 1, a.rows, "rows", &b, &vector))
    return false;
  // The solution has `columns` rows and takes the place of the right side.
  const size_t room = a.rows > a.columns ? a.rows : a.columns;
  Matrix x = matrix_new(call, room, b.columns);
  memcpy(x.x, b.x, b.rows * b.columns * sizeof(double));
  return solve_least_squares(call, &a, &x) && give_matrix(call, &x, a.columns, vector, result);
}

bool cag_matrices_multiply(CagCall *call, CagValue *result) {
  Matrix a, b;
  bool vector;
  if (!read_matrix(call, 0, &a) || !read_right_side(call, 1, a.columns, "columns", &b, &vector))
    return false;
  Matrix c = matrix_new(call, a.rows, b.columns);
  for (size_t i = 0; i < a.rows; i++) {
    double *row = c.x + i * c.columns;
    size_t work = 0;
    for (size_t k = 0; k < a.columns; k++) {
      for (size_t j = 0; j < c.columns; j++)
        row[j] += a.x[i * a.columns + k] * b.x[k * b.columns + j];
      if ((work += c.columns) < NUMBERS_BETWEEN_CHECKS) continue;
      work = 0;
      if (!cag_keep_going(call->vm)) return false;
    }
    if (!cag_keep_going(call->vm)) return false;
  }
  return give_matrix(call, &c, c.rows, vector, result);
}

// Up to 3x3 by the rule of Sarrus: exact for small whole numbers.
static double small_determinant(const Matrix *m) {
  const double *x = m->x;
  if (m->rows == 1) return x[0];
  if (m->rows == 2) return x[0] * x[3] - x[1] * x[2];
  return x[0] * (x[4] * x[8] - x[5] * x[7]) - x[1] * (x[3] * x[8] - x[5] * x[6]) +
         x[2] * (x[3] * x[7] - x[4] * x[6]);
}

static bool large_determinant(CagCall *call, Matrix *m, double *out) {
  size_t *pivots = cag_hold_array(call, m->rows, sizeof *pivots);
  bool singular;
  if (!cag_geometry_ok(call, cag_lu_factor(m->x, m->rows, pivots, &singular, call->err)))
    return false;
  *out = 1;
  for (size_t i = 0; i < m->rows; i++) *out *= m->x[i * m->rows + i] * (pivots[i] == i ? 1 : -1);
  return true;
}

bool cag_matrices_determinant(CagCall *call, CagValue *result) {
  Matrix m;
  if (!read_square(call, 0, NULL, &m)) return false;
  double determinant = 0;
  if (m.rows <= 3) determinant = small_determinant(&m);
  else if (!large_determinant(call, &m, &determinant)) return false;
  return cag_give_number(call, determinant + 0.0, result);
}

bool cag_matrices_inverse(CagCall *call, CagValue *result) {
  Matrix a;
  if (!read_square(call, 0, NULL, &a)) return false;
  Matrix b = matrix_new(call, a.rows, a.rows);
  for (size_t i = 0; i < a.rows; i++) b.x[i * a.rows + i] = 1;
  return solve_system(call, &a, &b) && give_matrix(call, &b, b.rows, false, result);
}

bool cag_matrices_transpose(CagCall *call, CagValue *result) {
  Matrix a;
  if (!read_rows(call, 0, &a)) return false;
  Matrix b = matrix_new(call, a.columns, a.rows);
  if (!copy_transposed(call, &a, false, b.x)) return false;
  cag_release_held(call, a.x);
  *result = give_rows(call->vm, &b, b.rows, false);
  return true;
}

// --- Eigenvalues ---

static bool check_symmetric(CagCall *call, const Matrix *m) {
  static const double RELATIVE = 1e-9; // what computing a symmetric matrix may have left
  double largest = 0;
  for (size_t i = 0; i < m->rows * m->rows; i++) largest = fmax(largest, fabs(m->x[i]));
  for (size_t i = 0; i < m->rows; i++)
    for (size_t j = 0; j < i; j++) {
      double low = m->x[i * m->rows + j], high = m->x[j * m->rows + i];
      if (fabs(low - high) <= RELATIVE * largest) continue;
      char a[32], b[32];
      return cag_fail_call(call, 0, CAG_ERR_value,
                           "expects a symmetric matrix: [%zu][%zu] = %s, but [%zu][%zu] = %s", i, j,
                           cag_number_text(low, a), j, i, cag_number_text(high, b));
    }
  return true;
}

// Eigenvectors have no sign of their own: the component largest in size is made positive.
static void orient(double *v, size_t n) {
  size_t largest = 0;
  // Sizes that differ by rounding only do not decide.
  static const double CLEARLY = 1 + 1e-9;
  for (size_t i = 1; i < n; i++)
    if (fabs(v[i]) > CLEARLY * fabs(v[largest])) largest = i;
  if (v[largest] >= 0) return;
  for (size_t i = 0; i < n; i++) v[i] = -v[i];
}

bool cag_matrices_eigen(CagCall *call, CagValue *result) {
  Matrix m;
  if (!read_square(call, 0, NULL, &m) || !check_symmetric(call, &m)) return false;
  size_t n = m.rows;
  double *values = cag_hold_array(call, n, sizeof *values);
  const bool large = is_large((double)n * (double)n * (double)n);
  if (large && !cag_geometry_ok(call, cag_symmetric_eigen(m.x, n, values, call->err))) return false;
  // In column-major order the eigenvectors come out one after the other: the rows of what we give.
  if (!large &&
      LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'U', (lapack_int)n, m.x, (lapack_int)n, values) != 0)
    return cag_fail_call(call, 0, CAG_ERR_convergence,
                         "does not converge: the eigenvalues could not be found");
  for (size_t i = 0; i < n; i++) orient(m.x + i * n, n);
  for (size_t i = 0; i < n * n; i++) m.x[i] += 0.0;
  static const char *const names[] = {"values", "vectors"};
  CagValue fields[] = {cag_vector(call->vm, values, n), give_rows(call->vm, &m, n, false)};
  *result = cag_record_new(call->vm, names, fields, 2);
  return true;
}

// --- Roots of polynomials ---
//
// The eigenvalues of the companion matrix are roots of a polynomial whose coefficients differ from
// the given ones by rounding only. A root of multiplicity m is spread by that into m roots about
// it, as far as the m-th root of the rounding error, with their mean at the root. So clusters are
// sought: the mean of m neighbors, improved by Newton's method as a root of the derivative of
// order m - 1, counts as a root of multiplicity m where the polynomial and its first m - 1
// derivatives vanish there to rounding.

typedef double complex Complex;
typedef long double complex LongComplex;

typedef struct Roots {
  const double *c; // coefficients, c[degree] not 0, c[0] not 0
  size_t degree;
  Complex *z;   // eigenvalues
  bool *done;   // which have been given to a root
  size_t *near; // numbers of those not done, by distance from the one in question
  Complex *found;
  size_t found_count;
} Roots;

// The derivative of this order, divided by its factorial, at z; *size the sum of the sizes of its
// terms.
static LongComplex taylor_at(const Roots *r, LongComplex z, size_t order, long double *size) {
  LongComplex value = 0;
  long double sum = 0, distance = cabsl(z);
  // binomial(j, order), from the highest j down
  long double binomial = 1;
  for (size_t k = 0; k < order; k++)
    binomial = binomial * (long double)(r->degree - k) / (long double)(k + 1);
  for (size_t j = r->degree;; j--) {
    value = value * z + r->c[j] * binomial;
    sum = sum * distance + fabsl(r->c[j] * binomial);
    if (j == order) break;
    binomial = binomial * (long double)(j - order) / (long double)j;
  }
  if (size) *size = sum;
  return value;
}

// Newton's method for a simple root of the derivative of order m - 1.
static LongComplex improve(const Roots *r, LongComplex z, size_t m) {
  enum { STEPS_MOST = 20 };
  for (int i = 0; i < STEPS_MOST; i++) {
    LongComplex slope = taylor_at(r, z, m, NULL) * (long double)m;
    LongComplex step = taylor_at(r, z, m - 1, NULL) / slope;
    if (!(cabsl(step) < HUGE_VALL)) break; // also if the slope is 0
    z -= step;
    if (cabsl(step) <= LDBL_EPSILON * cabsl(z)) break;
  }
  return z;
}

// Whether z is a root of multiplicity m of a polynomial that differs by rounding.
static bool vanishes(const Roots *r, LongComplex z, size_t m) {
  static const double ROUNDING = 16 * DBL_EPSILON; // of a coefficient, for each degree
  for (size_t k = 0; k < m; k++) {
    long double size;
    LongComplex value = taylor_at(r, z, k, &size);
    if (cabsl(value) > ROUNDING * (long double)r->degree * size) return false;
  }
  return true;
}

// Fills near with the roots not done, by distance from root i, which comes first; gives their
// number.
static size_t neighbors(Roots *r, size_t i) {
  size_t n = 0;
  for (size_t j = 0; j < r->degree; j++) {
    if (r->done[j]) continue;
    double distance = cabs(r->z[j] - r->z[i]);
    size_t k = n++;
    for (; k > 0 && j != i && cabs(r->z[r->near[k - 1]] - r->z[i]) > distance; k--)
      r->near[k] = r->near[k - 1];
    if (j == i)
      for (; k > 0; k--) r->near[k] = r->near[k - 1];
    r->near[k] = j;
  }
  return n;
}

// The number of the conjugate of root i among those not done.
static size_t conjugate(const Roots *r, size_t i) {
  for (size_t j = 0; j < r->degree; j++)
    if (!r->done[j] && r->z[j] == conj(r->z[i])) return j;
  return i;
}

// Whether the first m neighbors are m of the same side, or closed under conjugation. *real: the
// latter.
static bool one_sided(const Roots *r, size_t m, bool *real) {
  size_t above = 0, below = 0;
  for (size_t k = 0; k < m; k++) {
    above += cimag(r->z[r->near[k]]) > 0;
    below += cimag(r->z[r->near[k]]) < 0;
  }
  *real = above == below;
  return *real || above == m;
}

static void give_root(Roots *r, LongComplex z, size_t m, bool real) {
  for (size_t k = 0; k < m; k++) {
    size_t i = r->near[k];
    if (!real) r->done[conjugate(r, i)] = true;
    r->done[i] = true;
    r->found[r->found_count++] = real ? (double)creall(z) : (Complex)z;
    if (!real) r->found[r->found_count++] = conj((Complex)z);
  }
}

// Tries the m roots nearest to the one in question as one root of multiplicity m.
static bool take_cluster(Roots *r, size_t m) {
  bool real;
  if (!one_sided(r, m, &real)) return false;
  LongComplex mean = 0;
  for (size_t k = 0; k < m; k++) mean += r->z[r->near[k]];
  mean /= (long double)m;
  // Members of a cluster lie closer together than to 0; wider ones are several roots.
  static const double SPREAD = 0.25;
  for (size_t k = 0; k < m; k++)
    if (m > 1 && cabsl(r->z[r->near[k]] - mean) > SPREAD * cabsl(mean)) return false;
  if (real) mean = creall(mean);
  LongComplex z = improve(r, mean, m);
  if (real) z = creall(z);
  long double moved = cabsl(z - mean);
  if (!(moved <= SPREAD * cabsl(mean))) {
    if (m > 1) return false;
    z = mean;
  }
  if (m > 1 && !vanishes(r, z, m)) return false;
  give_root(r, z, m, real);
  return true;
}

static void collect_roots(Roots *r) {
  for (size_t i = 0; i < r->degree; i++) {
    if (r->done[i] || cimag(r->z[i]) < 0) continue;
    size_t m = neighbors(r, i);
    while (m > 1 && !take_cluster(r, m)) m--;
    if (m == 1) take_cluster(r, 1);
  }
}

// Eigenvalues of the companion matrix, conjugates side by side. x is scaled by a power of 2 so that
// first and last coefficient weigh alike.
static bool companion_roots(CagCall *call, Roots *r) {
  size_t n = r->degree;
  int exponent = 0;
  double ratio = fabs(r->c[0] / r->c[n]);
  if (ratio > 0 && isfinite(ratio)) exponent = (int)rint(log2(ratio) / (double)n);
  Matrix m = matrix_new(call, n, n);
  double *re = cag_hold_array(call, 2 * n, sizeof *re), *im = re + n;
  for (size_t j = 0; j < n; j++) {
    m.x[j] = -ldexp(r->c[n - 1 - j] / r->c[n], -exponent * (int)(j + 1));
    if (j + 1 < n) m.x[(j + 1) * n + j] = 1;
    if (!isfinite(m.x[j]))
      return cag_fail_call(call, 0, CAG_ERR_not_finite,
                           "overflows: the coefficients differ too much in size");
  }
  if (LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'N', (lapack_int)n, m.x, (lapack_int)n, re, im, NULL,
                    (lapack_int)n, NULL, (lapack_int)n) != 0)
    return cag_fail_call(call, 0, CAG_ERR_convergence,
                         "does not converge: the roots could not be found");
  for (size_t i = 0; i < n; i++) r->z[i] = CMPLX(ldexp(re[i], exponent), ldexp(im[i], exponent));
  return true;
}

static int compare_roots(const void *a, const void *b) {
  Complex s = *(const Complex *)a, t = *(const Complex *)b;
  if (creal(s) != creal(t)) return creal(s) < creal(t) ? -1 : 1;
  return (cimag(s) > cimag(t)) - (cimag(s) < cimag(t));
}

// All roots of the polynomial, sorted by real part, then imaginary part; *out is held.
static bool all_roots(CagCall *call, CagNumbers coefficients, Complex **out, size_t *count) {
  enum { DEGREE_MOST = 200 }; // beyond, coefficients say too little about the roots
  const double *c = coefficients.items;
  size_t n = coefficients.count;
  for (size_t i = 0; i < n; i++)
    if (!isfinite(c[i])) return cag_fail_value(call, 0, "finite coefficients");
  while (n > 0 && c[n - 1] == 0) n--;
  if (n == 0) return cag_fail_value(call, 0, "a polynomial that is not 0 everywhere");
  size_t zeros = 0;
  while (c[zeros] == 0) zeros++;
  size_t degree = n - 1 - zeros;
  if (degree > DEGREE_MOST) return cag_fail_value(call, 0, "a polynomial of degree 200 or less");
  size_t room = n + 1;
  Roots r = {.c = c + zeros,
             .degree = degree,
             .z = cag_hold_array(call, room, sizeof *r.z),
             .found = cag_hold_array(call, 2 * room, sizeof *r.found),
             .done = cag_hold_array(call, room, sizeof *r.done),
             .near = cag_hold_array(call, room, sizeof *r.near)};
  if (degree > 0 && !companion_roots(call, &r)) return false;
  collect_roots(&r);
  r.found_count += zeros; // their places are 0
  qsort(r.found, r.found_count, sizeof *r.found, compare_roots);
  *out = r.found;
  *count = r.found_count;
  return true;
}

bool cag_matrices_roots(CagCall *call, const struct cag_matrices_roots *a, CagValue *result) {
  Complex *z;
  size_t n, reals = 0;
  if (!all_roots(call, a->coefficients, &z, &n)) return false;
  double *numbers = cag_hold_array(call, n, sizeof *numbers);
  for (size_t i = 0; i < n; i++)
    if (cimag(z[i]) == 0) numbers[reals++] = creal(z[i]) + 0.0;
  *result = cag_vector(call->vm, numbers, reals);
  return true;
}

bool cag_matrices_complex_roots(CagCall *call, const struct cag_matrices_complex_roots *a,
                                CagValue *result) {
  Complex *z;
  size_t n;
  double *numbers;
  if (!all_roots(call, a->coefficients, &z, &n)) return false;
  *result = cag_list_vectors(call->vm, n, 2, &numbers);
  for (size_t i = 0; i < n; i++) {
    numbers[2 * i] = creal(z[i]) + 0.0;
    numbers[2 * i + 1] = cimag(z[i]) + 0.0;
  }
  return true;
}
