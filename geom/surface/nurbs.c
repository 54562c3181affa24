// Tensor product NURBS surfaces: Bezier, B-spline and rational, open or closed in each direction.
//
// A point is N(u) B M(v) with homogeneous control points B, divided by its weight where rational.
// The net is kept twice: as points (w x, w y, w z, w) for single evaluations and exporters, and as
// one plane per coordinate for grids, where the inner loops run along v over contiguous numbers.
//
// The span of t is the index i with knots[i] <= t < knots[i + 1] (limit from the right) or
// knots[i] < t <= knots[i + 1] (from the left), within the domain knots[degree]..knots[count]. A
// closed direction stores its first `degree` lines again at the end, over knots -degree, ..., so
// that nothing else knows of it.

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/surface/family.h"
#include "geom/surface/trimmed.h"

// Basis tables live on the stack; higher degrees serve nobody and lose all accuracy.
#define MAX_DEGREE 63

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

typedef struct Direction {
  int degree;
  size_t count, distinct;
  bool periodic;
  double *knots;
} Direction;

typedef struct Nurbs {
  CagSurface base;
  Direction u, v;
  bool rational;
  double *net;    // count_u x count_v x 4
  double *planes; // 4 x count_u x count_v: x, y, z, w
} Nurbs;

static const CagSurfaceKind bezier_kind, bspline_kind, nurbs_kind;

// --- Basis ---

static size_t find_span(const Direction *d, double t, CagSide side) {
  size_t low = (size_t)d->degree, high = d->count; // knots[low] <= t <= knots[high]
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    bool above = side == CAG_SIDE_LEFT ? t > d->knots[middle] : t >= d->knots[middle];
    if (above) low = middle;
    else high = middle;
  }
  // At an end of the domain the bisection may stop at an empty span; the piece is the nearest one.
  while (low > (size_t)d->degree && d->knots[low] >= d->knots[low + 1]) low--;
  while (low + 1 < d->count && d->knots[low] >= d->knots[low + 1]) low++;
  return low;
}

// Is it the span of t, from the right? Neighbouring parameters mostly share theirs.
static bool is_in_span(const Direction *d, size_t span, double t) {
  return span < d->count && d->knots[span] <= t && t < d->knots[span + 1];
}

// Values of the p + 1 basis functions of degree p on the span, by the triangular scheme of Cox and
// de Boor; `lower` takes those of the degree below (p of them) where it is not NULL.
INLINE void basis_scheme(const Direction *d, int p, size_t span, double t, double *values,
                         double *lower) {
  double left[MAX_DEGREE + 1], right[MAX_DEGREE + 1];
  values[0] = 1;
  for (int j = 1; j <= p; j++) {
    for (int r = 0; lower && j == p && r < j; r++) lower[r] = values[r];
    left[j] = t - d->knots[span + 1 - (size_t)j];
    right[j] = d->knots[span + (size_t)j] - t;
    double saved = 0;
    for (int r = 0; r < j; r++) {
      double part = values[r] / (right[r + 1] + left[j - r]);
      values[r] = saved + right[r + 1] * part;
      saved = left[j - r] * part;
    }
    values[j] = saved;
  }
}

static void basis_values(const Direction *d, size_t span, double t, double *values) {
  basis_scheme(d, d->degree, span, t, values, NULL);
}

INLINE void basis_first_of(const Direction *d, int p, size_t span, double t, double *values,
                           double *slopes) {
  double lower[MAX_DEGREE + 1], before = 0;
  basis_scheme(d, p, span, t, values, lower);
  for (int i = 0; i <= p; i++) {
    double after = 0;
    if (i < p) {
      double width = d->knots[span + 1 + (size_t)i] - d->knots[span + 1 + (size_t)i - (size_t)p];
      after = p * lower[i] / width;
    }
    slopes[i] = before - after;
    before = after;
  }
}

// Values and first derivatives. The loops of the degrees that are met most are unrolled.
static void basis_first(const Direction *d, size_t span, double t, double *values, double *slopes) {
  switch (d->degree) {
  case 1: basis_first_of(d, 1, span, t, values, slopes); break;
  case 2: basis_first_of(d, 2, span, t, values, slopes); break;
  case 3: basis_first_of(d, 3, span, t, values, slopes); break;
  default: basis_first_of(d, d->degree, span, t, values, slopes);
  }
}

// Derivatives 0..n: out[k * (degree + 1) + i]. Derivatives of a B-spline are B-splines of the
// differences of its control points, applied here to the unit control points.
static void basis_derivatives(const Direction *d, size_t span, double t, int n, double *out) {
  int p = d->degree, width = p + 1;
  if (n <= 1) {
    double slopes[MAX_DEGREE + 1];
    basis_first(d, span, t, out, n < 1 ? slopes : out + width);
    return;
  }
  for (int k = 0; k <= n; k++) {
    double *row = out + k * width;
    for (int i = 0; i <= p; i++) row[i] = 0;
    if (k > p) continue;
    // Values of degree p - k on the span, then raised k times by the derivative formula.
    Direction low = *d;
    low.degree = p - k;
    double values[MAX_DEGREE + 1];
    basis_values(&low, span, t, values);
    for (int i = 0; i <= p - k; i++) row[i] = values[i];
    for (int q = p - k + 1; q <= p; q++) {
      double before = 0;
      for (int i = 0; i <= q; i++) {
        double after = 0;
        if (i < q) {
          double span_width =
              d->knots[span + 1 + (size_t)i] - d->knots[span + 1 + (size_t)i - (size_t)q];
          after = q * row[i] / span_width;
        }
        row[i] = before - after;
        before = after;
      }
    }
  }
}

// --- One point ---

// Quotient rule for all partials of total order <= n of A / w (reference 06b, 7.2).
static CagStatus divide(int n, const double (*h)[4], CagVec3 *out, CagError *err) {
  double w = h[0][3];
  if (!(w > 0))
    return cag_fail(
        err, CAG_E_DEGENERATE, "zero-denominator", "weights", -1,
        "all `weights` that act at this point are 0: give one of them a positive value");
  double binomial[CAG_MAX_PARTIAL + 1][CAG_MAX_PARTIAL + 1];
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= i; j++)
      binomial[i][j] = j == 0 || j == i ? 1 : binomial[i - 1][j - 1] + binomial[i - 1][j];
  for (int a = 0; a <= n; a++)
    for (int b = 0; a + b <= n; b++) {
      const double *top = h[cag_partial(n, a, b)];
      CagVec3 sum = {top[0], top[1], top[2]};
      for (int i = 0; i <= a; i++)
        for (int j = 0; j <= b; j++)
          if (i + j > 0)
            sum = cag_madd(sum, -binomial[a][i] * binomial[b][j] * h[cag_partial(n, i, j)][3],
                           out[cag_partial(n, a - i, b - j)]);
      out[cag_partial(n, a, b)] = cag_scaled(sum, 1 / w);
    }
  return CAG_OK;
}

// All partials of total order <= n of the homogeneous point. bu, bv: the bases' derivatives; p, q:
// the degrees, once more, so that their loops may be unrolled.
INLINE void contract_net(const Nurbs *b, int p, int q, size_t iu, size_t iv, int n,
                         const double *bu, const double *bv, double (*h)[4]) {
  double row[MAX_DEGREE + 1][4];
  for (int i = 0; i <= n; i++) {
    // The net contracted with the i-th derivatives by u.
    for (int l = 0; l <= q; l++)
      for (int c = 0; c < 4; c++) row[l][c] = 0;
    for (int k = 0; k <= p && i <= p; k++) {
      double f = bu[i * (p + 1) + k];
      const double *net = b->net + 4 * ((iu - (size_t)p + (size_t)k) * b->v.count + iv - (size_t)q);
      for (int l = 0; l <= q; l++)
        for (int c = 0; c < 4; c++) row[l][c] += f * net[4 * l + c];
    }
    for (int j = 0; i + j <= n; j++) {
      double to[4] = {0};
      for (int l = 0; l <= q; l++)
        for (int c = 0; c < 4; c++) to[c] += bv[j * (q + 1) + l] * row[l][c];
      memcpy(h[cag_partial(n, i, j)], to, sizeof to);
    }
  }
}

static CagStatus nurbs_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                            CagVec3 *out, CagError *err) {
  const Nurbs *b = (const Nurbs *)s;
  int p = b->u.degree, q = b->v.degree;
  double bu[(CAG_MAX_PARTIAL + 1) * (MAX_DEGREE + 1)], bv[(CAG_MAX_PARTIAL + 1) * (MAX_DEGREE + 1)];
  double h[(CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1)][4];
  size_t iu = find_span(&b->u, u, su), iv = find_span(&b->v, v, sv);
  h[0][0] = h[0][1] = h[0][2] = 0;
  h[0][3] = 1;
  basis_derivatives(&b->u, iu, u, n, bu);
  basis_derivatives(&b->v, iv, v, n, bv);
  if (p == 3 && q == 3) contract_net(b, 3, 3, iu, iv, n, bu, bv, h);
  else contract_net(b, p, q, iu, iv, n, bu, bv, h);
  if (b->rational) return divide(n, (const double(*)[4])h, out, err);
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      int k = cag_partial(n, i, j);
      out[k] = cag_vec3(h[k][0], h[k][1], h[k][2]);
    }
  return CAG_OK;
}

// --- Grids ---

// The widest vector unit of the machine is chosen when the program starts; the arithmetic is the
// same in each (no contraction), so are the results.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define WIDEST __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WIDEST
#endif

// What is known of one row u and one run of columns in the same span of v.
typedef struct Run {
  size_t n;            // columns
  size_t room;         // columns that may be written: those after n are written again later
  const double *m, *d; // values and slopes by v: [l * stride + column]
  size_t stride;       // columns of the whole grid
  const double *a[4];  // row contracted with the values by u: x, y, z, w from the span's first on
  const double *da[4]; // with the slopes
  double *point, *du, *dv; // 3 numbers per column; du, dv may be NULL together
  double *normal;          // of unit length, or zero; NULL: not asked for
} Run;

// Vectors whose cross product is shorter than this part of the product of their lengths are
// parallel: what is left is rounding.
#define PARALLEL 1e-9

// What the cross product is scaled by; 0: there is no normal.
INLINE double normal_scale(double length2, double uu, double vv) {
  bool good = length2 > PARALLEL * PARALLEL * uu * vv && length2 > DBL_MIN;
  return good ? 1 / sqrt(length2) : 0;
}

// Columns worked on at a time: their rows of results stay in the first cache.
#define CHUNK 64

// sum_l a[l] f[l * stride + j] for all j of a chunk.
INLINE void combine(double *restrict to, const double *restrict a, const double *restrict f,
                    size_t stride, size_t n, int q) {
  for (size_t j = 0; j < n; j++) to[j] = a[0] * f[j];
  for (int l = 1; l <= q; l++) {
    const double *restrict fl = f + (size_t)l * stride;
    for (size_t j = 0; j < n; j++) to[j] += a[l] * fl[j];
  }
}

INLINE void interleave(double *restrict to, const double *restrict x, const double *restrict y,
                       const double *restrict z, size_t n) {
  for (size_t j = 0; j < n; j++) {
    to[3 * j] = x[j];
    to[3 * j + 1] = y[j];
    to[3 * j + 2] = z[j];
  }
}

typedef struct Chunk {
  double point[4][CHUNK], du[4][CHUNK], dv[4][CHUNK], normal[3][CHUNK];
} Chunk;

// Divides by the weights. Gives the count of those that are not positive.
INLINE size_t chunk_quotients(Chunk *restrict s, size_t n, bool first) {
  size_t bad = 0;
  for (size_t j = 0; j < n; j++) {
    bad += !(s->point[3][j] > 0);
    double inverse = 1 / s->point[3][j];
    for (int c = 0; c < 3; c++) {
      double x = s->point[c][j] * inverse;
      s->point[c][j] = x;
      if (!first) continue;
      s->du[c][j] = (s->du[c][j] - s->du[3][j] * x) * inverse;
      s->dv[c][j] = (s->dv[c][j] - s->dv[3][j] * x) * inverse;
    }
  }
  return bad;
}

INLINE void chunk_normals(Chunk *restrict s, size_t n) {
  for (size_t j = 0; j < n; j++) {
    double xu = s->du[0][j], yu = s->du[1][j], zu = s->du[2][j];
    double xv = s->dv[0][j], yv = s->dv[1][j], zv = s->dv[2][j];
    double nx = yu * zv - zu * yv, ny = zu * xv - xu * zv, nz = xu * yv - yu * xv;
    double scale = normal_scale(nx * nx + ny * ny + nz * nz, xu * xu + yu * yu + zu * zu,
                                xv * xv + yv * yv + zv * zv);
    s->normal[0][j] = nx * scale;
    s->normal[1][j] = ny * scale;
    s->normal[2][j] = nz * scale;
  }
}

// Any degree. False: a weight is not positive.
WIDEST static bool run_any(const Run *r, int q, bool rational, bool first) {
  Chunk s;
  size_t bad = 0;
  for (size_t at = 0; at < r->n; at += CHUNK) {
    size_t n = r->n - at < CHUNK ? r->n - at : CHUNK;
    for (int c = 0; c < (rational ? 4 : 3); c++) {
      combine(s.point[c], r->a[c], r->m + at, r->stride, n, q);
      if (!first) continue;
      combine(s.du[c], r->da[c], r->m + at, r->stride, n, q);
      combine(s.dv[c], r->a[c], r->d + at, r->stride, n, q);
    }
    if (rational) bad += chunk_quotients(&s, n, first);
    interleave(r->point + 3 * at, s.point[0], s.point[1], s.point[2], n);
    if (!first) continue;
    if (r->du) {
      interleave(r->du + 3 * at, s.du[0], s.du[1], s.du[2], n);
      interleave(r->dv + 3 * at, s.dv[0], s.dv[1], s.dv[2], n);
    }
    if (!r->normal) continue;
    chunk_normals(&s, n);
    interleave(r->normal + 3 * at, s.normal[0], s.normal[1], s.normal[2], n);
  }
  return bad == 0;
}

// Degrees up to 3 with vectors of four numbers in registers from the basis to the interleaved
// result. The arithmetic of a column is that of run_any.
#ifdef __has_builtin
#if __has_builtin(__builtin_shufflevector)
#define FUSED
#endif
#endif
#ifdef FUSED
#pragma GCC diagnostic ignored "-Wpsabi" // of functions that are always inlined

#define WIDE 4
typedef double Wide __attribute__((vector_size(8 * WIDE)));
typedef struct Wide3 {
  Wide x, y, z;
} Wide3;
typedef struct Basis {
  Wide f[4];
} Basis;

INLINE Wide wide_load(const double *from) {
  Wide w;
  memcpy(&w, from, sizeof w);
  return w;
}

// x0 y0 z0 x1 y1 z1 ...
INLINE void wide_store(double *to, Wide3 p) {
  Wide low = __builtin_shufflevector(p.x, p.y, 0, 4, 1, 5);
  Wide high = __builtin_shufflevector(p.x, p.y, 2, 6, 3, 7);
  Wide across = __builtin_shufflevector(low, p.z, 3, 5, 3, 5);
  // One by one: an array of all three would be stored and read again.
  Wide first = __builtin_shufflevector(low, p.z, 0, 1, 4, 2);
  Wide second = __builtin_shufflevector(across, high, 0, 1, 4, 5);
  Wide third = __builtin_shufflevector(high, p.z, 6, 2, 3, 7);
  memcpy(to, &first, sizeof first);
  memcpy(to + WIDE, &second, sizeof second);
  memcpy(to + 2 * WIDE, &third, sizeof third);
}

// Of the last columns of a grid only `n` have room.
INLINE void wide_put(double *to, Wide3 p, size_t n) {
  double all[3 * WIDE];
  if (n >= WIDE) {
    wide_store(to, p);
    return;
  }
  wide_store(all, p);
  memcpy(to, all, 3 * n * sizeof *all);
}

INLINE Basis wide_basis(const double *m, const size_t row[4]) {
  return (Basis){
      {wide_load(m), wide_load(m + row[1]), wide_load(m + row[2]), wide_load(m + row[3])}};
}

INLINE Wide wide_sum(const double a[4], const Basis *b) {
  return a[0] * b->f[0] + a[1] * b->f[1] + a[2] * b->f[2] + a[3] * b->f[3];
}

INLINE Wide3 wide_sums(double (*a)[4], const Basis *b) {
  return (Wide3){wide_sum(a[0], b), wide_sum(a[1], b), wide_sum(a[2], b)};
}

// As basis_first, of several parameters in the same span.
INLINE void basis_wide(const Direction *d, int p, size_t span, Wide t, Wide *values, Wide *slopes) {
  const double *knots = d->knots + span;
  Wide left[4], right[4], lower[4], before = {0};
  values[0] = before + 1;
  for (int j = 1; j <= p; j++) {
    Wide saved = {0};
    left[j] = t - knots[1 - j];
    right[j] = knots[j] - t;
    for (int r = 0; r < j; r++) {
      if (j == p) lower[r] = values[r];
      Wide part = values[r] / (right[r + 1] + left[j - r]);
      values[r] = saved + right[r + 1] * part;
      saved = left[j - r] * part;
    }
    values[j] = saved;
  }
  for (int i = 0; i < p; i++) {
    Wide after = (double)p * lower[i] / (knots[1 + i] - knots[1 + i - p]);
    slopes[i] = before - after;
    before = after;
  }
  slopes[p] = before;
}

INLINE void columns_wide(const Direction *d, int p, size_t span, const double *vs, size_t n,
                         size_t stride, double *m, double *slopes) {
  for (size_t j = 0; j < n; j += WIDE) {
    size_t some = n - j < WIDE ? n - j : WIDE;
    Wide t, value[4], slope[4];
    for (size_t k = 0; k < WIDE; k++) t[k] = vs[j + (k < some ? k : 0)];
    basis_wide(d, p, span, t, value, slope);
    for (int l = 0; l <= p; l++) {
      size_t at = (size_t)l * stride + j;
      // Behind the last of a row stands the next one.
      if (some == WIDE) {
        memcpy(m + at, &value[l], sizeof value[l]);
        memcpy(slopes + at, &slope[l], sizeof slope[l]);
      } else {
        memcpy(m + at, &value[l], some * sizeof *m);
        memcpy(slopes + at, &slope[l], some * sizeof *m);
      }
    }
  }
}

INLINE Wide3 wide_quotient(Wide3 p, Wide3 base, Wide w, Wide inverse) {
  return (Wide3){(p.x - w * base.x) * inverse, (p.y - w * base.y) * inverse,
                 (p.z - w * base.z) * inverse};
}

INLINE Wide wide_dot(Wide3 a, Wide3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

INLINE bool run_wide(const Run *r, int q, bool rational, bool partials, bool normals) {
  double a[4][4] = {{0}}, da[4][4] = {{0}}, scale[CHUNK], uu[CHUNK], vv[CHUNK];
  Wide3 cross[CHUNK / WIDE];
  // Rows that a lower degree does not have count for nothing.
  size_t row[4], room = r->room;
  bool good = true;
  for (int l = 0; l < 4; l++) row[l] = l <= q ? (size_t)l * r->stride : 0;
  for (int c = 0; c < (rational ? 4 : 3); c++)
    for (int l = 0; l <= q; l++) {
      a[c][l] = r->a[c][l];
      da[c][l] = partials || normals ? r->da[c][l] : 0;
    }
  for (size_t start = 0; start < r->n; start += CHUNK) {
    size_t n = r->n - start < CHUNK ? r->n - start : CHUNK;
    for (size_t j = 0; j < n; j += WIDE) {
      size_t at = start + j;
      Wide inverse = {0};
      Basis m = wide_basis(r->m + at, row);
      Wide3 p = wide_sums(a, &m);
      if (rational) {
        Wide w = wide_sum(a[3], &m);
        for (size_t k = 0; k < WIDE; k++) good = good && (w[k] > 0 || j + k >= n);
        inverse = 1 / w;
        p = (Wide3){p.x * inverse, p.y * inverse, p.z * inverse};
      }
      wide_put(r->point + 3 * at, p, room - at);
      if (!partials && !normals) continue;
      Basis d = wide_basis(r->d + at, row);
      Wide3 du = wide_sums(da, &m), dv = wide_sums(a, &d);
      if (rational) {
        du = wide_quotient(du, p, wide_sum(da[3], &m), inverse);
        dv = wide_quotient(dv, p, wide_sum(a[3], &d), inverse);
      }
      if (partials) {
        wide_put(r->du + 3 * at, du, room - at);
        wide_put(r->dv + 3 * at, dv, room - at);
      }
      if (!normals) continue;
      Wide3 c = {du.y * dv.z - du.z * dv.y, du.z * dv.x - du.x * dv.z, du.x * dv.y - du.y * dv.x};
      Wide squares[3] = {wide_dot(c, c), wide_dot(du, du), wide_dot(dv, dv)};
      cross[j / WIDE] = c;
      memcpy(scale + j, &squares[0], sizeof(Wide));
      memcpy(uu + j, &squares[1], sizeof(Wide));
      memcpy(vv + j, &squares[2], sizeof(Wide));
    }
    if (!normals) continue;
    for (size_t j = 0; j < (n + WIDE - 1) / WIDE * WIDE; j++)
      scale[j] = normal_scale(scale[j], uu[j], vv[j]);
    for (size_t j = 0; j < n; j += WIDE) {
      Wide by = wide_load(scale + j);
      Wide3 c = cross[j / WIDE];
      wide_put(r->normal + 3 * (start + j), (Wide3){c.x * by, c.y * by, c.z * by},
               room - start - j);
    }
  }
  return good;
}

WIDEST static void columns_low(const Direction *d, size_t span, const double *vs, size_t n,
                               size_t stride, double *m, double *slopes) {
  switch (d->degree) {
  case 1: columns_wide(d, 1, span, vs, n, stride, m, slopes); break;
  case 2: columns_wide(d, 2, span, vs, n, stride, m, slopes); break;
  default: columns_wide(d, 3, span, vs, n, stride, m, slopes);
  }
}

WIDEST static bool run_polynomial(const Run *r, int q, bool first) {
  if (!first) return run_wide(r, q, false, false, false);
  if (!r->normal) return run_wide(r, q, false, true, false);
  return r->du ? run_wide(r, q, false, true, true) : run_wide(r, q, false, false, true);
}

WIDEST static bool run_rational(const Run *r, int q, bool first) {
  if (!first) return run_wide(r, q, true, false, false);
  if (!r->normal) return run_wide(r, q, true, true, false);
  return r->du ? run_wide(r, q, true, true, true) : run_wide(r, q, true, false, true);
}

static bool run_columns(const Run *r, int q, bool rational, bool first) {
  if (q > 3) return run_any(r, q, rational, first);
  return rational ? run_rational(r, q, first) : run_polynomial(r, q, first);
}
#else
#define WIDE 1
static bool run_columns(const Run *r, int q, bool rational, bool first) {
  return run_any(r, q, rational, first);
}
#endif

// Values and slopes of n parameters in the same span, [l * stride + column].
static void basis_columns(const Direction *d, size_t span, const double *vs, size_t n,
                          size_t stride, double *m, double *slopes) {
#ifdef FUSED
  if (d->degree <= 3) {
    columns_low(d, span, vs, n, stride, m, slopes);
    return;
  }
#endif
  double value[MAX_DEGREE + 1], slope[MAX_DEGREE + 1];
  for (size_t j = 0; j < n; j++) {
    basis_first(d, span, vs[j], value, slope);
    for (size_t l = 0; l <= (size_t)d->degree; l++) {
      m[l * stride + j] = value[l];
      slopes[l * stride + j] = slope[l];
    }
  }
}

// Working memory of a grid: everything that does not depend on both parameters.
typedef struct GridWork {
  double *m, *d;   // basis by v, [l * nv + column]
  size_t *span;    // by v, per column
  size_t *end;     // of the columns in the same span, at the first of them
  double *row;     // 8 x count_v: planes contracted by u with values and slopes
  double *du, *dv; // where the caller wants only one of them
} GridWork;

static CagStatus grid_prepare(const Nurbs *b, const double *vs, size_t nv, bool first, GridWork *w,
                              CagError *err) {
  size_t lines = (size_t)b->v.degree + 1;
  w->m = calloc(2 * lines * nv + WIDE, sizeof *w->m); // whole vectors are read at the end
  w->span = malloc(2 * nv * sizeof *w->span);
  w->row = malloc(8 * b->v.count * sizeof *w->row);
  w->du = first ? malloc((3 * nv + 1) * sizeof *w->du) : NULL;
  w->dv = first ? malloc((3 * nv + 1) * sizeof *w->dv) : NULL;
  if (!w->m || !w->span || !w->row || (first && (!w->du || !w->dv))) return cag_fail_memory(err);
  w->d = w->m + lines * nv;
  w->end = w->span + nv;
  size_t span = SIZE_MAX;
  for (size_t j = 0; j < nv; j++) {
    bool at_end = vs[j] >= b->base.v1;
    if (at_end || !is_in_span(&b->v, span, vs[j]))
      span = find_span(&b->v, vs[j], at_end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT);
    w->span[j] = span;
  }
  for (size_t start = 0, end; start < nv; start = end) {
    for (end = start + 1; end < nv && w->span[end] == w->span[start];) end++;
    w->end[start] = end;
    basis_columns(&b->v, w->span[start], vs + start, end - start, nv, w->m + start, w->d + start);
  }
  return CAG_OK;
}

// sum_k f[k] net[k * stride + j] for the columns lo..hi, in the order of k. Few columns are met as
// often as many (a cell of a surface alone): so no sums on their way through memory.
INLINE void contract_lines(const double *f, int p, const double *net, size_t stride, size_t lo,
                           size_t hi, double *restrict to) {
  for (size_t j = lo; j < hi; j++) {
    double sum = f[0] * net[j];
    for (int k = 1; k <= p; k++) sum += f[k] * net[(size_t)k * stride + j];
    to[j] = sum;
  }
}

// Contracts the columns lo..hi of the planes with the basis by u.
WIDEST static void contract_row(const Nurbs *b, size_t span, const double *value,
                                const double *slope, size_t lo, size_t hi, bool slopes,
                                double *restrict row) {
  size_t nv = b->v.count, plane = b->u.count * nv;
  int planes = b->rational ? 4 : 3, p = b->u.degree;
  for (int c = 0; c < planes; c++) {
    const double *net = b->planes + (size_t)c * plane + (span - (size_t)p) * nv;
    double *restrict a = row + (size_t)c * nv, *restrict da = row + (size_t)(4 + c) * nv;
    if (p == 3) {
      contract_lines(value, 3, net, nv, lo, hi, a);
      if (slopes) contract_lines(slope, 3, net, nv, lo, hi, da);
    } else {
      contract_lines(value, p, net, nv, lo, hi, a);
      if (slopes) contract_lines(slope, p, net, nv, lo, hi, da);
    }
  }
}

static CagStatus grid(const Nurbs *b, const double *us, size_t nu, const double *vs, size_t nv,
                      CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagVec3 *normals, CagError *err) {
  const CagSurface *s = &b->base;
  if (nu == 0 || nv == 0) return CAG_OK;
  bool partials = du || dv, first = partials || normals, positive = true;
  bool one = partials && !(du && dv); // wanted only: the other goes to a row of its own
  GridWork w = {0};
  CagStatus status = grid_prepare(b, vs, nv, one, &w, err);
  size_t q = (size_t)b->v.degree, low = SIZE_MAX, high = 0;
  for (size_t j = 0; !status && j < nv; j++) {
    low = w.span[j] < low ? w.span[j] : low;
    high = w.span[j] > high ? w.span[j] : high;
  }
  for (size_t i = 0; !status && i < nu; i++) {
    double value[MAX_DEGREE + 1], slope[MAX_DEGREE + 1];
    CagSide side = us[i] >= s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    size_t span = find_span(&b->u, us[i], side);
    basis_first(&b->u, span, us[i], value, slope);
    contract_row(b, span, value, slope, low - q, high + 1, first, w.row);
    for (size_t start = 0, end; start < nv; start = end) {
      end = w.end[start];
      size_t at = i * nv + start;
      Run run = {.n = end - start,
                 .room = one ? end - start : nv - start,
                 .m = w.m + start,
                 .d = w.d + start,
                 .stride = nv,
                 .point = &points[at].x,
                 .normal = normals ? &normals[at].x : NULL};
      if (partials) {
        run.du = du ? &du[at].x : w.du;
        run.dv = dv ? &dv[at].x : w.dv;
      }
      for (size_t c = 0; c < 4; c++) {
        run.a[c] = w.row + c * b->v.count + w.span[start] - q;
        run.da[c] = w.row + (4 + c) * b->v.count + w.span[start] - q;
      }
      bool good = run_columns(&run, (int)q, b->rational, first);
      positive = positive && good;
    }
  }
  free(w.m);
  free(w.span);
  free(w.row);
  free(w.du);
  free(w.dv);
  if (!status && !positive)
    status = cag_fail(err, CAG_E_DEGENERATE, "zero-denominator", "weights", -1,
                      "all `weights` that act at a point of the grid are 0: give one of them a "
                      "positive value");
  return status;
}

static CagStatus nurbs_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  return grid((const Nurbs *)s, us, nu, vs, nv, points, du, dv, NULL, err);
}

// --- Construction ---

static CagStatus check_knots(const double *knots, size_t count, int degree, const char *name,
                             CagError *err) {
  char a[32], b[32];
  size_t n = count + (size_t)degree + 1;
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(knots[i]))
      return cag_fail(err, CAG_E_ARGUMENT, "not-finite", name, (long)i,
                      "`%s` must be finite: entry %zu is %s", name, i,
                      cag_number_text(knots[i], a));
    if (i > 0 && knots[i] < knots[i - 1])
      return cag_fail(err, CAG_E_ARGUMENT, "knots-not-monotone", name, (long)i,
                      "`%s` must not decrease: entry %zu is %s after %s", name, i,
                      cag_number_text(knots[i], a), cag_number_text(knots[i - 1], b));
  }
  double from = knots[degree], to = knots[count];
  if (!(to > from))
    return cag_fail(err, CAG_E_ARGUMENT, "empty-range", name, degree,
                    "`%s` must leave a range of parameters: entries %d and %zu are both %s", name,
                    degree, count, cag_number_text(from, a));
  for (size_t i = 1; i + (size_t)degree + 1 < n; i++)
    if (knots[i] > from && knots[i] < to && knots[i + (size_t)degree] == knots[i])
      return cag_fail(err, CAG_E_ARGUMENT, "knot-multiplicity", name, (long)i,
                      "`%s` may hold an inner knot at most %d times (the degree), %s stands more "
                      "often from entry %zu on",
                      name, degree, cag_number_text(knots[i], a), i);
  return CAG_OK;
}

static CagStatus check_degree(size_t count, int degree, const char *direction, CagError *err) {
  if (degree >= 1 && degree <= MAX_DEGREE && (size_t)degree < count) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, "order-range", "degree", *direction == 'u' ? 0 : 1,
                  "`degree` by %s must lie in 1..%zu for %zu net lines (and be at most %d), it is "
                  "%d; add lines or lower the degree",
                  direction, count ? count - 1 : 0, count, MAX_DEGREE, degree);
}

static CagStatus check_net(const double *h, size_t nu, size_t nv, CagError *err) {
  for (size_t i = 0; i < nu * nv; i++)
    for (int c = 0; c < 4; c++)
      if (!isfinite(h[4 * i + (size_t)c]))
        return cag_fail(err, CAG_E_ARGUMENT, "not-finite", c < 3 ? "net" : "weights", (long)i,
                        "`%s` must be finite: row %zu, column %zu is not",
                        c < 3 ? "net" : "weights", i / nv, i % nv);
  return CAG_OK;
}

static bool near(const double *a, const double *b, double size) {
  for (int c = 0; c < 4; c++)
    if (fabs(a[c] - b[c]) > CAG_SURFACE_SAME * (c == 3 ? fmax(fabs(a[3]), fabs(b[3])) : size))
      return false;
  return true;
}

// Same place, whatever the weights.
static bool near_point(const double *a, const double *b, double size) {
  for (int c = 0; c < 3; c++)
    if (fabs(a[c] * b[3] - b[c] * a[3]) > CAG_SURFACE_SAME * size * fmax(a[3], b[3])) return false;
  return true;
}

static bool clamped(const Direction *d) {
  return d->knots[0] == d->knots[d->degree] &&
         d->knots[d->count] == d->knots[d->count + (size_t)d->degree];
}

// Flags from the net where the edges of the surface are those of the net, which is certain; else
// from points.
static void judge(Nurbs *b) {
  cag_surface_judge(&b->base);
  size_t nu = b->u.count, nv = b->v.count;
  double size = 0;
  for (size_t i = 0; i < nu * nv; i++)
    for (size_t c = 0; c < 3; c++) size = fmax(size, fabs(b->net[4 * i + c]));
  if (clamped(&b->u)) {
    const double *first = b->net, *last = b->net + 4 * (nu - 1) * nv;
    bool closed = true, pole0 = true, pole1 = true;
    for (size_t j = 0; j < nv; j++) {
      closed = closed && near(first + 4 * j, last + 4 * j, size);
      pole0 = pole0 && near_point(first + 4 * j, first, size);
      pole1 = pole1 && near_point(last + 4 * j, last, size);
    }
    b->base.closed_u = closed && !(pole0 && pole1);
    b->base.pole_u0 = pole0;
    b->base.pole_u1 = pole1;
  }
  if (clamped(&b->v)) {
    bool closed = true, pole0 = true, pole1 = true;
    for (size_t i = 0; i < nu; i++) {
      const double *first = b->net + 4 * i * nv, *last = first + 4 * (nv - 1);
      closed = closed && near(first, last, size);
      pole0 = pole0 && near_point(first, b->net, size);
      pole1 = pole1 && near_point(last, b->net + 4 * (nv - 1), size);
    }
    b->base.closed_v = closed && !(pole0 && pole1);
    b->base.pole_v0 = pole0;
    b->base.pole_v1 = pole1;
  }
  b->base.closed_u = b->base.closed_u || b->u.periodic;
  b->base.closed_v = b->base.closed_v || b->v.periodic;
}

static bool is_bezier(const Direction *d) {
  return d->count == (size_t)d->degree + 1 && clamped(d) && d->knots[d->degree] == 0 &&
         d->knots[d->count] == 1;
}

static void nurbs_destroy(CagSurface *s) {
  Nurbs *b = (Nurbs *)s;
  free(b->u.knots);
  free(b->v.knots);
  free(b->net);
  free(b->planes);
}

// Takes copies of everything; the net is homogeneous and already holds the repeated lines of closed
// directions.
static CagStatus build(const double *net, const Direction *u, const Direction *v, CagSurface **out,
                       CagError *err) {
  CagStatus status = check_net(net, u->count, v->count, err);
  if (status) return status;
  CagSurface *s;
  status = cag_surface_block(sizeof(Nurbs), &nurbs_kind, u->knots[u->degree], u->knots[u->count],
                             v->knots[v->degree], v->knots[v->count], &s, err);
  if (status) return status;
  Nurbs *b = (Nurbs *)s;
  size_t total = u->count * v->count;
  size_t knots_u = u->count + (size_t)u->degree + 1, knots_v = v->count + (size_t)v->degree + 1;
  b->u = *u;
  b->v = *v;
  b->u.knots = malloc(knots_u * sizeof(double));
  b->v.knots = malloc(knots_v * sizeof(double));
  b->net = malloc(4 * total * sizeof(double));
  b->planes = malloc(4 * total * sizeof(double));
  if (!b->u.knots || !b->v.knots || !b->net || !b->planes) {
    cag_surface_release(s);
    return cag_fail_memory(err);
  }
  memcpy(b->u.knots, u->knots, knots_u * sizeof(double));
  memcpy(b->v.knots, v->knots, knots_v * sizeof(double));
  memcpy(b->net, net, 4 * total * sizeof(double));
  // Equal weights are no weights.
  double w = net[3];
  for (size_t i = 0; i < total; i++) b->rational = b->rational || net[4 * i + 3] != w;
  if (!b->rational && w != 1)
    for (size_t i = 0; i < total; i++) {
      for (size_t c = 0; c < 3; c++) b->net[4 * i + c] /= w;
      b->net[4 * i + 3] = 1;
    }
  for (size_t i = 0; i < total; i++)
    for (size_t c = 0; c < 4; c++) b->planes[c * total + i] = b->net[4 * i + c];
  bool bezier = is_bezier(&b->u) && is_bezier(&b->v);
  s->kind = bezier ? &bezier_kind : b->rational ? &nurbs_kind : &bspline_kind;
  judge(b);
  *out = s;
  return CAG_OK;
}

CagStatus cag_surface_from_homogeneous(const double *net, size_t nu, size_t nv, int degree_u,
                                       int degree_v, const double *knots_u, const double *knots_v,
                                       CagSurface **out, CagError *err) {
  Direction u = {degree_u, nu, nu, false, (double *)knots_u};
  Direction v = {degree_v, nv, nv, false, (double *)knots_v};
  CagStatus status = check_degree(nu, degree_u, "u", err);
  if (!status) status = check_degree(nv, degree_v, "v", err);
  if (!status) status = check_knots(knots_u, nu, degree_u, "knots", err);
  if (!status) status = check_knots(knots_v, nv, degree_v, "knots", err);
  return status ? status : build(net, &u, &v, out, err);
}

static CagStatus check_weights(const double *weights, size_t nu, size_t nv, CagError *err) {
  bool any = false;
  for (size_t i = 0; weights && i < nu * nv; i++) {
    char text[32];
    if (!(weights[i] >= 0) || !isfinite(weights[i]))
      return cag_fail(err, CAG_E_ARGUMENT, "negative-weight", "weights", (long)i,
                      "`weights` must be finite and not negative: row %zu, column %zu is %s",
                      i / nv, i % nv, cag_number_text(weights[i], text));
    any = any || weights[i] > 0;
  }
  if (weights && !any)
    return cag_fail(err, CAG_E_ARGUMENT, "zero-denominator", "weights", 0,
                    "`weights` must not all be 0");
  return CAG_OK;
}

// Fills a direction: the given knots, or whole ones of a closed direction (malloc'd, in *own).
static CagStatus make_direction(size_t count, int degree, const double *knots, bool closed,
                                const char *name, Direction *out, double **own, CagError *err) {
  *own = NULL;
  size_t stored = closed ? count + (size_t)(degree > 0 ? degree : 0) : count;
  CagStatus status = check_degree(count, degree, name, err);
  if (status) return status;
  *out = (Direction){degree, stored, count, closed, (double *)knots};
  if (!closed || knots) return check_knots(knots, stored, degree, "knots", err);
  size_t n = stored + (size_t)degree + 1;
  *own = malloc(n * sizeof **own);
  if (!*own) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) (*own)[i] = (double)i - degree;
  out->knots = *own;
  return CAG_OK;
}

CagStatus cag_surface_nurbs_closed(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                                   int degree_u, int degree_v, const double *knots_u,
                                   const double *knots_v, bool closed_u, bool closed_v,
                                   CagSurface **out, CagError *err) {
  Direction u, v;
  double *own_u = NULL, *own_v = NULL, *h = NULL;
  CagStatus status = make_direction(nu, degree_u, knots_u, closed_u, "u", &u, &own_u, err);
  if (!status) status = make_direction(nv, degree_v, knots_v, closed_v, "v", &v, &own_v, err);
  if (!status) status = check_weights(weights, nu, nv, err);
  if (!status) {
    h = malloc(4 * u.count * v.count * sizeof *h);
    if (!h) status = cag_fail_memory(err);
  }
  for (size_t i = 0; !status && i < u.count; i++)
    for (size_t j = 0; j < v.count; j++) {
      size_t from = (i % nu) * nv + j % nv;
      double w = weights ? weights[from] : 1, *to = h + 4 * (i * v.count + j);
      to[0] = net[from].x * w;
      to[1] = net[from].y * w;
      to[2] = net[from].z * w;
      to[3] = w;
    }
  if (!status) status = build(h, &u, &v, out, err);
  free(h);
  free(own_u);
  free(own_v);
  return status;
}

CagStatus cag_surface_nurbs(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                            int degree_u, int degree_v, const double *knots_u,
                            const double *knots_v, CagSurface **out, CagError *err) {
  return cag_surface_nurbs_closed(net, weights, nu, nv, degree_u, degree_v, knots_u, knots_v, false,
                                  false, out, err);
}

CagStatus cag_surface_bezier(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                             CagSurface **out, CagError *err) {
  double knots_u[2 * (MAX_DEGREE + 1)], knots_v[2 * (MAX_DEGREE + 1)];
  int p = nu <= MAX_DEGREE + 1 ? (int)nu - 1 : MAX_DEGREE + 1;
  int q = nv <= MAX_DEGREE + 1 ? (int)nv - 1 : MAX_DEGREE + 1;
  CagStatus status = check_degree(nu, p, "u", err);
  if (!status) status = check_degree(nv, q, "v", err);
  if (status) return status;
  for (size_t i = 0; i < 2 * nu; i++) knots_u[i] = i < nu ? 0 : 1;
  for (size_t i = 0; i < 2 * nv; i++) knots_v[i] = i < nv ? 0 : 1;
  return cag_surface_nurbs(net, weights, nu, nv, p, q, knots_u, knots_v, out, err);
}

// --- The rest of the table ---

static CagStatus nurbs_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  (void)err;
  *out = cag_surface_retain(s);
  return CAG_OK;
}

static CagStatus nurbs_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                 CagError *err) {
  const Nurbs *b = (const Nurbs *)s;
  size_t total = b->u.count * b->v.count;
  double *h = malloc(4 * total * sizeof *h);
  if (!h) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < total; i++) {
    cag_transform_homogeneous(t, b->net + 4 * i, h + 4 * i);
    if (h[4 * i + 3] < 0 || (h[4 * i + 3] == 0 && b->net[4 * i + 3] > 0))
      status = cag_fail(err, CAG_E_DEGENERATE, "behind-centre", "transform", (long)i,
                        "the projection sends control point [%zu, %zu] to infinity or behind its "
                        "centre: move the surface or the centre",
                        i / b->v.count, i % b->v.count);
  }
  if (!status) status = build(h, &b->u, &b->v, out, err);
  free(h);
  return status;
}

static size_t nurbs_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Nurbs *b = (const Nurbs *)s;
  const Direction *d = direction == 0 ? &b->u : &b->v;
  size_t n = 0;
  for (size_t i = (size_t)d->degree + 1; i < d->count; i++)
    if (d->knots[i] > d->knots[i - 1] && d->knots[i] < d->knots[d->count]) {
      if (n < capacity) out[n] = d->knots[i];
      n++;
    }
  return n;
}

static void nurbs_describe(const CagSurface *s, char *buffer, size_t size) {
  const Nurbs *b = (const Nurbs *)s;
  const char *closed = b->u.periodic   ? b->v.periodic ? ", closed by u and v" : ", closed by u"
                       : b->v.periodic ? ", closed by v"
                                       : "";
  snprintf(buffer, size, "degree %d x %d, %zu x %zu points%s", b->u.degree, b->v.degree,
           b->u.distinct, b->v.distinct, closed);
}

#define NURBS_TABLE(text)                                                                          \
  {                                                                                                \
    .name = text, .eval = nurbs_eval, .eval_grid = nurbs_grid, .to_nurbs = nurbs_to_nurbs,         \
    .transform = nurbs_transform, .breaks = nurbs_breaks, .describe = nurbs_describe,              \
    .destroy = nurbs_destroy,                                                                      \
  }
static const CagSurfaceKind bezier_kind = NURBS_TABLE("bezier");
static const CagSurfaceKind bspline_kind = NURBS_TABLE("bspline");
static const CagSurfaceKind nurbs_kind = NURBS_TABLE("nurbs");

static const Nurbs *as_nurbs(const CagSurface *s) {
  return s->kind->eval == nurbs_eval ? (const Nurbs *)s : NULL;
}

bool cag_surface_nurbs_frames(const CagSurface *s, const double *us, size_t nu, const double *vs,
                              size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                              CagVec3 *normals, CagStatus *status, CagError *err) {
  const Nurbs *b = as_nurbs(s);
  if (b) *status = grid(b, us, nu, vs, nv, points, du, dv, normals, err);
  return b != NULL;
}

bool cag_surface_nurbs_view(const CagSurface *s, CagSurfaceNurbsView *out) {
  const Nurbs *b = as_nurbs(s);
  if (!b) return false;
  if (out)
    *out = (CagSurfaceNurbsView){
        .degree_u = b->u.degree,
        .degree_v = b->v.degree,
        .nu = b->u.count,
        .nv = b->v.count,
        .distinct_u = b->u.distinct,
        .distinct_v = b->v.distinct,
        .periodic_u = b->u.periodic,
        .periodic_v = b->v.periodic,
        .rational = b->rational,
        .knots_u = b->u.knots,
        .knots_v = b->v.knots,
        .homogeneous = b->net,
    };
  return true;
}

CagStatus cag_surface_nurbs_swapped(const CagSurface *s, CagSurface **out, CagError *err) {
  const Nurbs *b = as_nurbs(s);
  if (!b)
    return cag_fail(err, CAG_E_UNSUPPORTED, "not-nurbs", "surface", -1,
                    "the surface is a %s: convert it to a NURBS first", s->kind->name);
  size_t nu = b->u.count, nv = b->v.count;
  double *h = malloc(4 * nu * nv * sizeof *h);
  if (!h) return cag_fail_memory(err);
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++)
      memcpy(h + 4 * (j * nu + i), b->net + 4 * (i * nv + j), 4 * sizeof *h);
  CagStatus status = build(h, &b->v, &b->u, out, err);
  free(h);
  return status;
}

// v runs backwards over the same domain.
static CagStatus reversed_v(const Nurbs *b, CagSurface **out, CagError *err) {
  size_t nu = b->u.count, nv = b->v.count, knots = nv + (size_t)b->v.degree + 1;
  double *h = malloc(4 * nu * nv * sizeof *h), *turned = malloc(knots * sizeof *turned);
  CagStatus status = h && turned ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    for (size_t i = 0; i < nu; i++)
      for (size_t j = 0; j < nv; j++)
        memcpy(h + 4 * (i * nv + nv - 1 - j), b->net + 4 * (i * nv + j), 4 * sizeof *h);
    // The ends of the domain change places exactly; the rest are mirrored in its middle.
    double a = b->base.v0, z = b->base.v1;
    for (size_t k = 0; k < knots; k++) {
      double t = b->v.knots[knots - 1 - k];
      turned[k] = t == a ? z : t == z ? a : a + z - t;
    }
    Direction v = b->v;
    v.knots = turned;
    status = build(h, &b->u, &v, out, err);
  }
  free(h);
  free(turned);
  return status;
}

CagStatus cag_surface_flip(const CagSurface *s, CagSurface **out, CagError *err) {
  const Nurbs *b = as_nurbs(s);
  if (b) return reversed_v(b, out, err);
  if (cag_surface_trimmed_view(s, NULL, NULL)) return cag_trimmed_flip(s, out, err);
  const CagRegion *region;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame)) {
    // A mirrored region in a mirrored frame: the same piece of plane seen from behind.
    CagTransform mirror = cag_transform_identity();
    mirror.m[1][1] = -1;
    mirror.m[1][3] = s->v0 + s->v1;
    CagTransform turned = cag_transform_multiply(&frame, &mirror);
    CagRegion *image;
    CagStatus status = cag_region_transform(region, &mirror, &image, err);
    if (status) return status;
    status = cag_surface_planar(image, &turned, out, err);
    cag_region_release(image);
    return status;
  }
  CagTransform identity = cag_transform_identity();
  return cag_surface_placed(s, &identity, true, out, err);
}
