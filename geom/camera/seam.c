// Joints of workpieces in the profile of a light stripe.

#include "geom/camera/locate.h"

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"

// Samples between checks of the stop flag.
#define LOOK_UP 4096

static CagStatus fail_seam(const char *why, CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_seam, "profile", -1, "%s", why);
}

// --- Fillet ---

// Sums of the samples before each index, relative to the mean sample.
typedef struct Sums {
  double n, y, z, yy, yz, zz;
} Sums;

static Sums run_sums(const Sums *sums, size_t from, size_t to) {
  const Sums *a = &sums[from], *b = &sums[to];
  return (Sums){b->n - a->n, b->y - a->y, b->z - a->z, b->yy - a->yy, b->yz - a->yz, b->zz - a->zz};
}

// The line z = height + slope y with the least sum of squared residuals in z.
typedef struct FittedLine {
  double slope, height, residual;
} FittedLine;

// Returns false if all samples are at one position.
static bool fit_run(const Sums *sums, size_t from, size_t to, FittedLine *out) {
  const Sums s = run_sums(sums, from, to);
  const double width = s.yy - s.y * s.y / s.n, cross = s.yz - s.y * s.z / s.n;
  if (!(width > CAG_ROUNDING * s.yy)) return false;
  out->slope = cross / width;
  out->height = (s.z - out->slope * s.y) / s.n;
  out->residual = s.zz - s.z * s.z / s.n - out->slope * cross;
  return true;
}

static CagStatus find_fillet(const CagProfileSample *v, size_t n, CagSeam *out, CagError *err) {
  Sums *sums = cag_calloc(n + 1, sizeof *sums);
  if (!sums) return cag_fail_memory(err);
  double y0 = 0, z0 = 0, best = INFINITY;
  FittedLine left = {0}, right = {0};
  for (size_t i = 0; i < n; i++) y0 += v[i].y / (double)n, z0 += v[i].z / (double)n;
  for (size_t i = 0; i < n; i++) {
    const double y = v[i].y - y0, z = v[i].z - z0;
    const Sums *s = &sums[i];
    sums[i + 1] = (Sums){s->n + 1, s->y + y, s->z + z, s->yy + y * y, s->yz + y * z, s->zz + z * z};
  }
  for (size_t i = 2; i + 2 <= n; i++) {
    FittedLine a, b;
    if (!fit_run(sums, 0, i, &a) || !fit_run(sums, i, n, &b)) continue;
    if (a.residual + b.residual < best) best = a.residual + b.residual, left = a, right = b;
  }
  cag_free(sums);
  const double sine =
      fabs(left.slope - right.slope) / (hypot(1, left.slope) * hypot(1, right.slope));
  if (!(best < INFINITY) || sine < CAG_PARALLEL)
    return fail_seam("expected two faces that are not parallel, of two samples or more", err);
  const double y = (right.height - left.height) / (left.slope - right.slope);
  *out = (CagSeam){.y = y0 + y, .z = z0 + left.height + left.slope * y};
  return CAG_OK;
}

// --- Lap and butt ---

static CagStatus find_lap(const CagProfileSample *v, size_t n, double limit, CagSeam *out,
                          CagError *err) {
  double step = 0;
  for (size_t i = 0; i + 1 < n; i++) {
    const double jump = fabs(v[i + 1].z - v[i].z);
    if (!(jump > step)) continue;
    step = jump;
    *out = (CagSeam){.y = (v[i].y + v[i + 1].y) / 2, .z = (v[i].z + v[i + 1].z) / 2, .step = jump};
  }
  return step > limit ? CAG_OK : fail_seam("expected a step that is higher than the limit", err);
}

// `samples` include those without a return.
static CagStatus find_butt(const CagProfileSample *samples, size_t n, CagSeam *out, CagError *err) {
  const CagProfileSample *before = NULL; // the last return
  double first = NAN, last = NAN;        // positions without a return after it
  size_t missing = 0;
  *out = (CagSeam){0};
  for (size_t i = 0; i < n; i++) {
    const CagProfileSample *s = &samples[i];
    if (isnan(s->z)) {
      missing++;
      if (isnan(first)) first = s->y;
      if (!isnan(s->y)) last = s->y;
      continue;
    }
    if (before && missing > 0 && s->y - before->y > out->gap_most)
      *out = (CagSeam){.y = (before->y + s->y) / 2,
                       .z = (before->z + s->z) / 2,
                       .gap_least = isnan(first) ? 0 : last - first,
                       .gap_most = s->y - before->y};
    before = s;
    first = last = NAN;
    missing = 0;
  }
  return out->gap_most > 0 ? CAG_OK : fail_seam("expected samples without a return in a gap", err);
}

CagStatus cag_find_seam(const CagProfileSample *samples, size_t n, CagSeamKind kind, double limit,
                        CagSeam *out, CagError *err) {
  if (kind == CAG_SEAM_BUTT) return find_butt(samples, n, out, err);
  CagProfileSample *returns = cag_malloc((n + 1) * sizeof *returns);
  if (!returns) return cag_fail_memory(err);
  size_t count = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < n && !status; i++) {
    if (!isnan(samples[i].z)) returns[count++] = samples[i];
    if (i % LOOK_UP == 0) status = cag_stop_check(err);
  }
  if (!status)
    status = kind == CAG_SEAM_FILLET ? find_fillet(returns, count, out, err)
                                     : find_lap(returns, count, limit, out, err);
  cag_free(returns);
  return status;
}
