// Least squares and eigenvalues by Householder reflections, which can be canceled.

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/dense.h"

// Operations, and rows of a matrix, between checks of the stop flag.
#define WORK_BETWEEN_LOOKS ((size_t)1 << 18)
#define LINES_BETWEEN_LOOKS ((size_t)64)

static inline double dot(const double *x, const double *y, size_t n) {
  double s[4] = {0};
  size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (size_t k = 0; k < 4; k++) s[k] += x[i + k] * y[i + k];
  for (; i < n; i++) s[0] += x[i] * y[i];
  return (s[0] + s[1]) + (s[2] + s[3]);
}

static inline void subtract(double *restrict x, double factor, const double *restrict y, size_t n) {
  for (size_t i = 0; i < n; i++) x[i] -= factor * y[i];
}

// --- Least squares ---

// The norm, scaled so that no square overflows.
static double size_of(const double *x, size_t n) {
  double largest = 0, sum = 0;
  for (size_t i = 0; i < n; i++) largest = fmax(largest, fabs(x[i]));
  if (largest == 0) return 0;
  for (size_t i = 0; i < n; i++) sum += (x[i] / largest) * (x[i] / largest);
  return largest * sqrt(sum);
}

// Turns x into a vector v with v[0] = 1 such that only the first entry of (1 - beta v v^T) x is
// nonzero; returns that entry. v[1..n) is stored in x[1..n).
static double reflect_to_first(double *x, size_t n, double *beta) {
  const double rest = size_of(x + 1, n - 1);
  *beta = 0;
  if (rest == 0) return x[0];
  const double size = hypot(x[0], rest), first = x[0] > 0 ? -size : size;
  *beta = (first - x[0]) / first;
  const double scale = 1 / (x[0] - first);
  for (size_t i = 1; i < n; i++) x[i] *= scale;
  return first;
}

// x becomes (1 - beta v v^T) x, where v[0] counts as 1.
static void reflect(double *x, const double *v, double beta, size_t n) {
  const double s = beta * (x[0] + dot(x + 1, v + 1, n - 1));
  x[0] -= s;
  subtract(x + 1, s, v + 1, n - 1);
}

typedef struct Factors {
  double *a;
  size_t rows, columns, rank;
  double *right;
  size_t room, sides;
  size_t *order; // column of the given matrix; NULL: not pivoted
  double *norms; // of the columns: from the current row down, and their values when last computed
  double *line;  // of `columns` numbers
} Factors;

static void compute_norm(Factors *f, size_t j, size_t from) {
  f->norms[j] = f->norms[f->columns + j] = size_of(f->a + j * f->rows + from, f->rows - from);
}

// Removes row k from the norms. A norm that lost digits by cancellation is recomputed.
static void reduce_norms(Factors *f, size_t k) {
  const double CANCELED = sqrt(DBL_EPSILON);
  for (size_t j = k + 1; j < f->columns && !cag_stopped(); j++) {
    double *norm = &f->norms[j];
    if (*norm == 0) continue;
    const double part = fabs(f->a[j * f->rows + k]) / *norm, left = fmax(0, 1 - part * part);
    const double ratio = *norm / f->norms[f->columns + j];
    if (left * ratio * ratio <= CANCELED) compute_norm(f, j, k + 1);
    else *norm *= sqrt(left);
  }
}

static void bring_largest_column(Factors *f, size_t k) {
  size_t best = k;
  for (size_t j = k; j < f->columns; j++)
    if (f->norms[j] > f->norms[best]) best = j;
  if (best == k) return;
  f->norms[best] = f->norms[k];
  f->norms[f->columns + best] = f->norms[f->columns + k];
  const size_t order = f->order[k];
  f->order[k] = f->order[best];
  f->order[best] = order;
  double *x = f->a + k * f->rows, *y = f->a + best * f->rows;
  for (size_t i = 0; i < f->rows; i++) {
    const double z = x[i];
    x[i] = y[i];
    y[i] = z;
  }
}

// a P = Q R, and the right sides become Q^T times them. Stops at the first column below the cut.
static CagStatus factor(Factors *f, const double *cut, CagError *err) {
  const size_t least = f->rows < f->columns ? f->rows : f->columns;
  double largest = 0;
  for (f->rank = 0; f->rank < least; f->rank++) {
    const size_t k = f->rank, n = f->rows - k;
    double *column = f->a + k * f->rows + k, beta;
    if (cut) bring_largest_column(f, k);
    const double first = reflect_to_first(column, n, &beta);
    if (k == 0) largest = fabs(first);
    if (cut && !(fabs(first) > *cut * largest)) break;
    size_t work = 0;
    for (size_t j = k + 1; beta != 0 && j < f->columns + f->sides; j++) {
      double *x = j < f->columns ? f->a + j * f->rows : f->right + (j - f->columns) * f->room;
      reflect(x + k, column, beta, n);
      if ((work += n) < WORK_BETWEEN_LOOKS) continue;
      work = 0;
      if (cag_stop_check(err)) return err->status;
    }
    column[0] = first;
    if (cut) reduce_norms(f, k);
    if (cag_stop_check(err)) return err->status;
  }
  return CAG_OK;
}

// The rows of R are longer than the rank: reflections from the right reduce it to a triangle. Row k
// is kept in `z` (columns - rank numbers for each row), its factor in beta.
static CagStatus shorten_rows(Factors *f, double *z, double *beta, CagError *err) {
  const size_t rest = f->columns - f->rank, rows = f->rows;
  double *line = f->line;
  for (size_t k = f->rank; k-- > 0;) {
    line[0] = f->a[k * rows + k];
    for (size_t j = 0; j < rest; j++) line[1 + j] = f->a[(f->rank + j) * rows + k];
    f->a[k * rows + k] = reflect_to_first(line, rest + 1, &beta[k]);
    memcpy(z + k * rest, line + 1, rest * sizeof *z);
    for (size_t i = 0; beta[k] != 0 && i < k; i++) {
      double s = f->a[k * rows + i];
      for (size_t j = 0; j < rest; j++) s += f->a[(f->rank + j) * rows + i] * z[k * rest + j];
      s *= beta[k];
      f->a[k * rows + i] -= s;
      for (size_t j = 0; j < rest; j++) f->a[(f->rank + j) * rows + i] -= s * z[k * rest + j];
      if (i % LINES_BETWEEN_LOOKS == 0 && cag_stop_check(err)) return err->status;
    }
    if (cag_stop_check(err)) return err->status;
  }
  return CAG_OK;
}

static void substitute_back(const Factors *f, double *x) {
  for (size_t k = f->rank; k-- > 0;) {
    x[k] /= f->a[k * f->rows + k];
    subtract(x, x[k], f->a + k * f->rows, k);
  }
}

static CagStatus find_shortest(Factors *f, CagError *err) {
  const size_t rest = f->columns - f->rank, rank = f->rank;
  double *z = cag_malloc((rank * rest + rank + 1) * sizeof *z), *beta = z ? z + rank * rest : NULL;
  CagStatus status = z ? CAG_OK : cag_fail_memory(err);
  if (!status && rest > 0) status = shorten_rows(f, z, beta, err);
  for (size_t s = 0; !status && s < f->sides; s++) {
    double *x = f->right + s * f->room;
    substitute_back(f, x);
    memset(x + rank, 0, rest * sizeof *x);
    for (size_t k = 0; rest > 0 && k < rank; k++) {
      const double t = beta[k] * (x[k] + dot(x + rank, z + k * rest, rest));
      x[k] -= t;
      subtract(x + rank, t, z + k * rest, rest);
    }
    for (size_t j = 0; j < f->columns; j++) f->line[f->order[j]] = x[j];
    memcpy(x, f->line, f->columns * sizeof *x);
    status = cag_stop_check(err);
  }
  cag_free(z);
  return status;
}

CagStatus cag_least_squares(double *a, size_t rows, size_t columns, double *right, size_t room,
                            size_t sides, const double *cut, CagError *err) {
  Factors f = {
      .a = a, .rows = rows, .columns = columns, .right = right, .room = room, .sides = sides};
  if (!cut) {
    CagStatus status = factor(&f, NULL, err);
    for (size_t s = 0; !status && s < sides; s++) {
      substitute_back(&f, right + s * room);
      status = cag_stop_check(err);
    }
    return status;
  }
  f.order = cag_malloc(columns * sizeof *f.order);
  f.norms = cag_malloc(2 * columns * sizeof *f.norms);
  f.line = cag_malloc((columns + 1) * sizeof *f.line);
  CagStatus status = f.order && f.norms && f.line ? CAG_OK : cag_fail_memory(err);
  for (size_t j = 0; !status && j < columns; j++) {
    f.order[j] = j;
    compute_norm(&f, j, 0);
    status = cag_stop_check(err);
  }
  if (!status) status = factor(&f, cut, err);
  if (!status) status = find_shortest(&f, err);
  cag_free(f.order);
  cag_free(f.norms);
  cag_free(f.line);
  return status;
}

// --- Eigenvalues of symmetric matrices ---

// Reduces `a` to a tridiagonal matrix with diagonal d and subdiagonal e[1..n), from the last row
// up. Row i of `a` keeps the vector of its reflection in its first i entries, beta[i] its factor.
static CagStatus make_tridiagonal(double *a, size_t n, double *d, double *e, double *beta,
                                  double *p, CagError *err) {
  for (size_t i = n; i-- > 1;) {
    double *v = a + i * n;
    d[i] = v[i];
    // The vector's leading entry is its last, v[i - 1].
    const double rest = size_of(v, i - 1);
    beta[i] = 0;
    e[i] = v[i - 1];
    if (rest > 0) {
      const double size = hypot(v[i - 1], rest), first = v[i - 1] > 0 ? -size : size;
      beta[i] = (first - v[i - 1]) / first;
      const double scale = 1 / (v[i - 1] - first);
      for (size_t k = 0; k + 1 < i; k++) v[k] *= scale;
      v[i - 1] = 1;
      e[i] = first;
      // p = beta A v from the lower triangle; A -= v q^T + q v^T with q = p - (beta/2 p.v) v.
      memset(p, 0, i * sizeof *p);
      for (size_t j = 0; j < i; j++) {
        const double *row = a + j * n, x = v[j];
        double s = row[j] * x;
        s += dot(row, v, j);
        for (size_t k = 0; k < j; k++) p[k] += row[k] * x;
        p[j] += s;
        if (j % LINES_BETWEEN_LOOKS == 0 && cag_stop_check(err)) return err->status;
      }
      for (size_t j = 0; j < i; j++) p[j] *= beta[i];
      const double half = beta[i] / 2 * dot(p, v, i);
      subtract(p, half, v, i);
      for (size_t j = 0; j < i; j++) {
        double *row = a + j * n;
        const double x = v[j], y = p[j];
        for (size_t k = 0; k <= j; k++) row[k] -= x * p[k] + y * v[k];
        if (j % LINES_BETWEEN_LOOKS == 0 && cag_stop_check(err)) return err->status;
      }
    }
    if (cag_stop_check(err)) return err->status;
  }
  d[0] = a[0];
  return CAG_OK;
}

// Replaces the vectors of the reflections by the rows of the transposed product.
static CagStatus collect_reflections(double *a, size_t n, const double *beta, double *q,
                                     CagError *err) {
  for (size_t i = 0; i < n; i++) {
    memset(q + i * n, 0, n * sizeof *q);
    q[i * n + i] = 1;
  }
  // Row k of q is column k of Q = H(n-1) .. H(1): reflections from the smallest up.
  for (size_t i = 1; i < n; i++) {
    if (beta[i] == 0) continue;
    const double *v = a + i * n;
    for (size_t k = 0; k < i; k++) {
      double *row = q + k * n;
      subtract(row, beta[i] * dot(row, v, i), v, i);
      if (k % LINES_BETWEEN_LOOKS == 0 && cag_stop_check(err)) return err->status;
    }
  }
  memcpy(a, q, n * n * sizeof *a);
  return CAG_OK;
}

// Rotates rows i and i + 1.
static void rotate_rows(double *restrict x, double *restrict y, double c, double s, size_t n) {
  for (size_t k = 0; k < n; k++) {
    const double f = y[k];
    y[k] = s * x[k] + c * f;
    x[k] = c * x[k] - s * f;
  }
}

// One step with implicit shift on the block l .. m. Ends early if the work is canceled.
static void ql_step(double *d, double *e, size_t l, size_t m, double *rows, size_t n) {
  double g = (d[l + 1] - d[l]) / (2 * e[l]), r = hypot(g, 1);
  double s = 1, c = 1, p = 0;
  g = d[m] - d[l] + e[l] / (g + copysign(r, g));
  for (size_t i = m; i-- > l;) {
    const double f = s * e[i], b = c * e[i];
    e[i + 1] = r = hypot(f, g);
    if (r == 0) {
      d[i + 1] -= p;
      e[m] = 0;
      return;
    }
    s = f / r;
    c = g / r;
    g = d[i + 1] - p;
    r = (d[i] - g) * s + 2 * c * b;
    p = s * r;
    d[i + 1] = g + p;
    g = c * r - b;
    rotate_rows(rows + i * n, rows + (i + 1) * n, c, s, n);
    if (cag_stopped()) return;
  }
  d[l] -= p;
  e[l] = g;
  e[m] = 0;
}

static CagStatus diagonalize(double *d, double *e, size_t n, double *rows, CagError *err) {
  enum { STEPS_MOST = 60 };
  for (size_t i = 1; i < n; i++) e[i - 1] = e[i];
  e[n - 1] = 0;
  for (size_t l = 0; l < n; l++)
    for (int step = 0;; step++) {
      size_t m = l;
      while (m + 1 < n && fabs(e[m]) > DBL_EPSILON * (fabs(d[m]) + fabs(d[m + 1]))) m++;
      if (m == l) break;
      if (step == STEPS_MOST)
        return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "", -1,
                        "the eigenvalues could not be found");
      ql_step(d, e, l, m, rows, n);
      if (cag_stop_check(err)) return err->status;
    }
  return CAG_OK;
}

// Selection sort: at most n exchanges of rows.
static void sort_rising(double *d, size_t n, double *rows) {
  for (size_t i = 0; i + 1 < n; i++) {
    size_t least = i;
    for (size_t k = i + 1; k < n; k++)
      if (d[k] < d[least]) least = k;
    if (least == i) continue;
    const double x = d[i];
    d[i] = d[least];
    d[least] = x;
    for (size_t k = 0; k < n; k++) {
      const double y = rows[i * n + k];
      rows[i * n + k] = rows[least * n + k];
      rows[least * n + k] = y;
    }
  }
}

CagStatus cag_symmetric_eigen(double *a, size_t n, double *values, CagError *err) {
  double *e = cag_malloc((3 * n + n * n) * sizeof *e);
  if (!e) return cag_fail_memory(err);
  double *beta = e + n, *p = beta + n, *q = p + n;
  beta[0] = e[0] = 0;
  CagStatus status = make_tridiagonal(a, n, values, e, beta, p, err);
  if (!status) status = collect_reflections(a, n, beta, q, err);
  if (!status) status = diagonalize(values, e, n, a, err);
  if (!status) sort_rising(values, n, a);
  cag_free(e);
  return status;
}
