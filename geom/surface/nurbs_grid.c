// Tensor product NURBS surfaces on grids, in wide registers.
//
// The basis in v is computed once for all rows. Each row contracts the net's planes with the basis
// in u, which leaves a curve in v; its columns are processed several at a time.

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/tensor.h"

// The data of one row u and a run of columns in the same span of v.
typedef struct Run {
  size_t n;            // columns
  size_t room;         // number of columns that may be written: those after n are overwritten later
  const double *m, *d; // values and slopes by v: [l * stride + column]
  size_t stride;       // columns of the whole grid
  const double *a[4];  // row contracted with the values by u: x, y, z, w from the span's first on
  const double *da[4]; // the same, contracted with the slopes
  double *point, *du, *dv; // 3 numbers per column; du, dv may be NULL together
  double *normal;          // of unit length, or zero; NULL: not asked for
  const double *noise2;    // of Nurbs
} Run;

// Vectors are parallel if their cross product is below this fraction of the product of their
// lengths, which is rounding.
#define PARALLEL CAG_PARALLEL

// Returns the factor that normalizes the cross product, or 0 if the normal is undefined.
INLINE double normal_scale(double length2, double uu, double vv, const double noise2[2]) {
  bool good = (length2 > PARALLEL * PARALLEL * uu * vv) & (length2 > DBL_MIN) & (uu > noise2[0]) &
              (vv > noise2[1]);
  return good ? 1 / sqrt(length2) : 0;
}

// Number of columns processed together, so that their results stay in the L1 cache.
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

// Divides by the weights. Returns the number of weights that are not positive.
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

INLINE void chunk_normals(Chunk *restrict s, size_t n, const double noise2[2]) {
  for (size_t j = 0; j < n; j++) {
    double xu = s->du[0][j], yu = s->du[1][j], zu = s->du[2][j];
    double xv = s->dv[0][j], yv = s->dv[1][j], zv = s->dv[2][j];
    double nx = yu * zv - zu * yv, ny = zu * xv - xu * zv, nz = xu * yv - yu * xv;
    double scale = normal_scale(nx * nx + ny * ny + nz * nz, xu * xu + yu * yu + zu * zu,
                                xv * xv + yv * yv + zv * zv, noise2);
    s->normal[0][j] = nx * scale;
    s->normal[1][j] = ny * scale;
    s->normal[2][j] = nz * scale;
  }
}

// For any degree. Returns false if a weight is not positive.
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
    chunk_normals(&s, n, r->noise2);
    interleave(r->normal + 3 * at, s.normal[0], s.normal[1], s.normal[2], n);
  }
  return bad == 0;
}

// Degrees up to 3 keep vectors of four numbers in registers from the basis to the interleaved
// result. The arithmetic of each column is the same as in run_any.
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
  // One by one: an array of all three would go through memory.
  Wide first = __builtin_shufflevector(low, p.z, 0, 1, 4, 2);
  Wide second = __builtin_shufflevector(across, high, 0, 1, 4, 5);
  Wide third = __builtin_shufflevector(high, p.z, 6, 2, 3, 7);
  memcpy(to, &first, sizeof first);
  memcpy(to + WIDE, &second, sizeof second);
  memcpy(to + 2 * WIDE, &third, sizeof third);
}

// At the last columns of a grid there is room for only `n`.
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

// Like cag_tensor_basis_first, for several parameters in the same span.
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
      // The end of a row is followed by the next row.
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
  const double noise2[2] = {r->noise2[0], r->noise2[1]};
  Wide3 cross[CHUNK / WIDE];
  // Rows beyond the degree contribute nothing.
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
      scale[j] = normal_scale(scale[j], uu[j], vv[j], noise2);
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
    cag_tensor_basis_first(d, span, vs[j], value, slope);
    for (size_t l = 0; l <= (size_t)d->degree; l++) {
      m[l * stride + j] = value[l];
      slopes[l * stride + j] = slope[l];
    }
  }
}

// Scratch memory of a grid: everything that depends on only one parameter.
typedef struct GridWork {
  double *m, *d;   // basis by v, [l * nv + column]
  size_t *span;    // by v, per column
  size_t *end;     // end of the columns in the same span, stored at the first of them
  double *row;     // 8 x count_v: planes contracted by u with values and slopes
  double *du, *dv; // used if the caller wants only one of them
} GridWork;

static CagStatus grid_prepare(const Nurbs *b, const double *vs, size_t nv, bool first, GridWork *w,
                              CagError *err) {
  size_t lines = (size_t)b->v.degree + 1;
  w->m = cag_calloc(2 * lines * nv + WIDE, sizeof *w->m); // whole vectors are read at the end
  w->span = cag_malloc(2 * nv * sizeof *w->span);
  w->row = cag_malloc(8 * b->v.count * sizeof *w->row);
  w->du = first ? cag_malloc((3 * nv + 1) * sizeof *w->du) : NULL;
  w->dv = first ? cag_malloc((3 * nv + 1) * sizeof *w->dv) : NULL;
  if (!w->m || !w->span || !w->row || (first && (!w->du || !w->dv))) return cag_fail_memory(err);
  w->d = w->m + lines * nv;
  w->end = w->span + nv;
  size_t span = SIZE_MAX;
  for (size_t j = 0; j < nv; j++) {
    bool at_end = vs[j] >= b->base.v1;
    if (at_end || !tensor_in_span(&b->v, span, vs[j]))
      span = cag_tensor_span(&b->v, vs[j], at_end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT);
    w->span[j] = span;
  }
  for (size_t start = 0, end; start < nv; start = end) {
    for (end = start + 1; end < nv && w->span[end] == w->span[start];) end++;
    w->end[start] = end;
    basis_columns(&b->v, w->span[start], vs + start, end - start, nv, w->m + start, w->d + start);
  }
  return CAG_OK;
}

// sum_k f[k] net[k * stride + j] for the columns lo..hi, in the order of k. There are often few
// columns (a single cell of a surface), so sums are not accumulated in memory.
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

CagStatus cag_tensor_frames(const Nurbs *b, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagVec3 *normals,
                            CagError *err) {
  const CagSurface *s = &b->base;
  if (nu == 0 || nv == 0) return CAG_OK;
  bool partials = du || dv, first = partials || normals, positive = true;
  bool one = partials && !(du && dv); // only one is requested: the other goes to a scratch row
  GridWork w = {0};
  CagStatus status = grid_prepare(b, vs, nv, one, &w, err);
  size_t q = (size_t)b->v.degree, low = SIZE_MAX, high = 0;
  for (size_t j = 0; !status && j < nv; j++) {
    low = w.span[j] < low ? w.span[j] : low;
    high = w.span[j] > high ? w.span[j] : high;
  }
  for (size_t i = 0; !status && i < nu; i++) {
    if ((status = cag_stop_check(err)) != CAG_OK) break;
    double value[MAX_DEGREE + 1], slope[MAX_DEGREE + 1];
    CagSide side = us[i] >= s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    size_t span = cag_tensor_span(&b->u, us[i], side);
    cag_tensor_basis_first(&b->u, span, us[i], value, slope);
    contract_row(b, span, value, slope, low - q, high + 1, first, w.row);
    for (size_t start = 0, end; start < nv; start = end) {
      end = w.end[start];
      size_t at = i * nv + start;
      Run run = {.n = end - start,
                 .room = one ? end - start : nv - start,
                 .m = w.m + start,
                 .d = w.d + start,
                 .stride = nv,
                 .noise2 = b->noise2,
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
  cag_free(w.m);
  cag_free(w.span);
  cag_free(w.row);
  cag_free(w.du);
  cag_free(w.dv);
  if (!status && !positive)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "weights", -1,
                      "all `weights` that act at a point of the grid are 0: give one of them a "
                      "positive value");
  return status;
}

CagStatus cag_tensor_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                          size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  return cag_tensor_frames((const Nurbs *)s, us, nu, vs, nv, points, du, dv, NULL, err);
}
