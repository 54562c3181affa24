// Adaptive Gauss-Kronrod integration. The recursion is bounded; nothing allocates.

#include "geom/basis/quadrature.h"

#include <math.h>

#include "geom/stop.h"

// Halving an interval this often leaves less of it than rounding does.
#define DEPTH 48
// Where halving does not lower the estimate of the error by this factor, the integrand is rounding
// noise: a kink lowers it by 4, a square root by about 2.8.
#define IMPROVES 0.8
// The first halvings may show more of the integrand than was seen before.
#define SETTLED (DEPTH - 5)

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
  CagIntegrand f;
  void *context;
  int parts;
  double limit; // error allowed to one interval
  CagError *err;
} Task;

typedef struct Estimate {
  double value[CAG_INTEGRAND_PARTS];
  double size; // largest integral of absolute values
  double error;
} Estimate;

static CagStatus estimate(const Task *task, double a, double b, Estimate *out) {
  const double half = (b - a) / 2, middle = a + half;
  if (cag_stop_check(task->err)) return task->err->status;
  double k[CAG_INTEGRAND_PARTS] = {0}, g[CAG_INTEGRAND_PARTS] = {0}, m[CAG_INTEGRAND_PARTS] = {0};
  for (int i = 0; i < 8; i++)
    for (int side = -1; side <= 1; side += 2) {
      if (i == 7 && side > 0) continue;
      double f[CAG_INTEGRAND_PARTS];
      CagStatus status = task->f(task->context, middle + side * half * node[i], f, task->err);
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
    // The difference is an estimate for the 7 points; that for the 15 is far smaller (QUADPACK).
    if (size > 0) e = size * fmin(1, pow(200 * e / size, 1.5));
    out->error = fmax(out->error, e);
  }
  return CAG_OK;
}

static CagStatus refine(const Task *task, double a, double b, const Estimate *known, int depth,
                        double *sum) {
  const double middle = a + (b - a) / 2;
  if (known->error <= task->limit || depth == 0 || !(a < middle && middle < b)) {
    for (int p = 0; p < task->parts; p++) sum[p] += known->value[p];
    return CAG_OK;
  }
  Estimate left, right;
  CagStatus status = estimate(task, a, middle, &left);
  if (!status) status = estimate(task, middle, b, &right);
  if (!status && depth < SETTLED && left.error + right.error > IMPROVES * known->error) {
    for (int p = 0; p < task->parts; p++) sum[p] += left.value[p] + right.value[p];
    return CAG_OK;
  }
  if (!status) status = refine(task, a, middle, &left, depth - 1, sum);
  if (!status) status = refine(task, middle, b, &right, depth - 1, sum);
  return status;
}

CagStatus cag_integrate(CagIntegrand f, void *context, const double *cuts, size_t n, int parts,
                        double tolerance, double *out, CagError *err) {
  Task task = {f, context, parts, 0, err};
  Estimate e;
  double size = 0;
  for (size_t i = 0; i + 1 < n; i++) {
    CagStatus status = estimate(&task, cuts[i], cuts[i + 1], &e);
    if (status) return status;
    size += e.size;
  }
  task.limit = tolerance * size / sqrt((double)n);
  double sum[CAG_INTEGRAND_PARTS] = {0};
  for (size_t i = 0; i + 1 < n; i++) {
    CagStatus status = estimate(&task, cuts[i], cuts[i + 1], &e);
    if (!status) status = refine(&task, cuts[i], cuts[i + 1], &e, DEPTH, sum);
    if (status) return status;
  }
  for (int p = 0; p < parts; p++) out[p] = sum[p];
  return CAG_OK;
}
