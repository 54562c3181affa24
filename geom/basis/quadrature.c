// Adaptive Gauss-Kronrod integration (Piessens et al., QUADPACK, 1983): the interval with the
// largest error is halved until the sum of the errors is within the tolerance.
//
// Intervals are not abandoned for lack of progress: near a peak or a near-cusp, halving begins to
// help only at the scale of the feature. Intervals whose error is the rounding of their own
// integral, or which cannot be halved, are set aside.

#include "geom/basis/quadrature.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"

// Maximum number of intervals of a piece; more would only follow noise. A cusp takes about 50.
#define MOST_INTERVALS 4000
// An interval's error is rounding if it is below this fraction of its integral of absolute values.
#define ROUNDING (4 * DBL_EPSILON)
// This many cuts need no allocation. Inner integrals have few.
#define FEW_CUTS 8

// Nodes and weights of the 15-point Kronrod rule, from the outermost; Gauss weights belong to every
// second node (Piessens et al., QUADPACK, 1983).
static const double node[8] = {
    0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
    0.586087235467691130294144691258238, 0.405845151377397166906606412076961,
    0.207784955007898467600689403773245, 0};
static const double kronrod[8] = {
    0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
static const double gauss[4] = {
    0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
    0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

typedef struct Task {
  CagPieceIntegrand f;
  void *context;
  int parts;
  CagError *err;
} Task;

typedef struct Estimate {
  double value[CAG_INTEGRAND_PARTS];
  double size; // largest integral of absolute values
  double error;
} Estimate;

static CagStatus estimate(const Task *task, size_t piece, double a, double b, Estimate *out) {
  const double half = (b - a) / 2, middle = a + half;
  if (cag_stop_check(task->err)) return task->err->status;
  double k[CAG_INTEGRAND_PARTS] = {0}, g[CAG_INTEGRAND_PARTS] = {0}, m[CAG_INTEGRAND_PARTS] = {0};
  for (int i = 0; i < 8; i++)
    for (int side = -1; side <= 1; side += 2) {
      if (i == 7 && side > 0) continue;
      double f[CAG_INTEGRAND_PARTS];
      CagStatus status =
          task->f(task->context, piece, middle + side * half * node[i], f, task->err);
      if (status) return status;
      for (int p = 0; p < task->parts; p++) {
        k[p] += kronrod[i] * f[p];
        m[p] += kronrod[i] * fabs(f[p]);
        if (i % 2) g[p] += gauss[i / 2] * f[p];
      }
    }
  out->size = out->error = 0;
  for (int p = 0; p < task->parts; p++) {
    out->value[p] = half * k[p];
    double size = half * m[p], e = half * fabs(k[p] - g[p]);
    out->size = fmax(out->size, size);
    // The difference estimates the error of the 7-point rule; that of the 15-point rule is far
    // smaller (QUADPACK).
    if (size > 0) e = size * fmin(1, pow(200 * e / size, 1.5));
    out->error = fmax(out->error, e);
  }
  return CAG_OK;
}

// --- Intervals ---

typedef struct Interval {
  size_t piece;
  double a, b;
  Estimate e;
} Interval;

// A heap with the largest error first, and the sums over all intervals.
typedef struct Pool {
  Interval *items;
  size_t count, capacity;
  size_t made;
  double error, size;              // of the intervals on the heap; of all
  double sum[CAG_INTEGRAND_PARTS]; // of the intervals that were set aside
} Pool;

static CagStatus push(Pool *pool, const Interval *interval, CagError *err) {
  if (!CAG_RESERVE(pool->items, pool->capacity, pool->count + 1)) return cag_fail_memory(err);
  size_t i = pool->count++;
  for (; i > 0 && pool->items[(i - 1) / 2].e.error < interval->e.error; i = (i - 1) / 2)
    pool->items[i] = pool->items[(i - 1) / 2];
  pool->items[i] = *interval;
  return CAG_OK;
}

static Interval pop(Pool *pool) {
  Interval *items = pool->items;
  const Interval top = items[0], last = items[--pool->count];
  size_t i = 0;
  for (size_t child; (child = 2 * i + 1) < pool->count; i = child) {
    if (child + 1 < pool->count && items[child + 1].e.error > items[child].e.error) child++;
    if (!(items[child].e.error > last.e.error)) break;
    items[i] = items[child];
  }
  if (pool->count > 0) items[i] = last;
  return top;
}

static CagStatus add_interval(const Task *task, Pool *pool, size_t piece, double a, double b) {
  Interval interval = {.piece = piece, .a = a, .b = b};
  CagStatus status = estimate(task, piece, a, b, &interval.e);
  if (status) return status;
  pool->size += interval.e.size;
  pool->made++;
  const double middle = a + (b - a) / 2;
  if (interval.e.error > ROUNDING * interval.e.size && a < middle && middle < b) {
    pool->error += interval.e.error;
    return push(pool, &interval, task->err);
  }
  for (int p = 0; p < task->parts; p++) pool->sum[p] += interval.e.value[p];
  return CAG_OK;
}

static double heap_error(const Pool *pool) {
  double sum = 0;
  for (size_t i = 0; i < pool->count; i++) sum += pool->items[i].e.error;
  return sum;
}

CagStatus cag_integrate_pieces(CagPieceIntegrand f, void *context, const double (*ranges)[2],
                               size_t n, int parts, double tolerance, double *out, CagError *err) {
  const Task task = {f, context, parts, err};
  Pool pool = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++)
    status = add_interval(&task, &pool, i, ranges[i][0], ranges[i][1]);
  const size_t most = pool.made + MOST_INTERVALS;
  while (!status && pool.count > 0 && pool.made < most) {
    if (pool.error <= tolerance * pool.size) {
      // The running sum may contain rounding errors of its former magnitude.
      pool.error = heap_error(&pool);
      if (pool.error <= tolerance * pool.size) break;
    }
    const Interval worst = pop(&pool);
    const double middle = worst.a + (worst.b - worst.a) / 2;
    pool.error -= worst.e.error;
    pool.size -= worst.e.size;
    status = add_interval(&task, &pool, worst.piece, worst.a, middle);
    if (!status) status = add_interval(&task, &pool, worst.piece, middle, worst.b);
  }
  if (!status) memcpy(out, pool.sum, sizeof(double) * (size_t)parts);
  for (size_t i = 0; !status && i < pool.count; i++)
    for (int p = 0; p < parts; p++) out[p] += pool.items[i].e.value[p];
  cag_free(pool.items);
  return status;
}

// --- Pieces with separate parameters ---

typedef struct Single {
  CagIntegrand f;
  void *context;
} Single;

static CagStatus call_single(void *context, size_t piece, double t, double *out, CagError *err) {
  (void)piece;
  const Single *single = context;
  return single->f(single->context, t, out, err);
}

CagStatus cag_integrate(CagIntegrand f, void *context, const double *cuts, size_t n, int parts,
                        double tolerance, double *out, CagError *err) {
  Single single = {f, context};
  double few[FEW_CUTS][2], (*ranges)[2] = n <= FEW_CUTS ? few : cag_malloc(n * sizeof *ranges);
  if (!ranges) return cag_fail_memory(err);
  for (size_t i = 0; i + 1 < n; i++) {
    ranges[i][0] = cuts[i];
    ranges[i][1] = cuts[i + 1];
  }
  CagStatus status = cag_integrate_pieces(call_single, &single, (const double(*)[2])ranges,
                                          n > 0 ? n - 1 : 0, parts, tolerance, out, err);
  if (ranges != few) cag_free(ranges);
  return status;
}
