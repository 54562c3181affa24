#include "geom/image/histogram.h"

#include <math.h>

#include "base/stop.h"

static CagStatus fail_code(double v, size_t levels, size_t x, size_t y, CagError *err) {
  char text[32];
  cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_image_codes, "", -1,
           "expected whole numbers from 0 to %zu as gray values, found %s at pixel [%zu, %zu]",
           levels - 1, cag_number_text(v, text), x, y);
  return err->status;
}

CagStatus cag_histogram(const CagRaster *r, size_t levels, double *counts, CagError *err) {
  for (size_t y = 0; y < r->height; y++) {
    const double *row = cag_raster_at(r, 0, 0, y);
    for (size_t x = 0; x < r->width; x++) {
      if (isnan(row[x])) continue;
      if (!(row[x] >= 0 && row[x] < (double)levels)) return fail_code(row[x], levels, x, y, err);
      const size_t v = (size_t)row[x];
      if ((double)v != row[x]) return fail_code(row[x], levels, x, y, err);
      counts[v]++;
    }
    if (cag_stopped()) return cag_stop_fail(err);
  }
  return CAG_OK;
}

CagStatus cag_histogram_levels(const CagRaster *r, size_t *levels, CagError *err) {
  double most = 0;
  for (size_t y = 0; y < r->height; y++) {
    const double *row = cag_raster_at(r, 0, 0, y);
    for (size_t x = 0; x < r->width; x++)
      if (row[x] > most) most = row[x];
    if (cag_stopped()) return cag_stop_fail(err);
  }
  *levels = most < (double)CAG_LEVELS_MOST ? (size_t)most + 1 : CAG_LEVELS_MOST;
  return CAG_OK;
}

CagStatus cag_otsu(const double *counts, size_t levels, CagOtsu *out, CagError *err) {
  double n = 0, sum = 0, n0 = 0, sum0 = 0;
  size_t used = 0;
  CagOtsu best = {.variance = -1};
  for (size_t v = 0; v < levels; v++) {
    n += counts[v];
    sum += counts[v] * (double)v;
    used += counts[v] > 0;
  }
  if (used < 2)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_single_level_histogram, "", -1,
                    "expected at least two different gray values, found %zu", used);
  for (size_t t = 1; t < levels; t++) {
    n0 += counts[t - 1];
    sum0 += counts[t - 1] * (double)(t - 1);
    const double n1 = n - n0;
    if (n0 == 0 || n1 == 0) continue;
    const double difference = sum0 / n0 - (sum - sum0) / n1;
    const double variance = n0 / n * (n1 / n) * (difference * difference);
    // Thresholds without a code in between have equal sums, and so the same variance exactly.
    if (variance == best.variance && best.high + 1 == (double)t) best.high = (double)t;
    if (variance <= best.variance) continue;
    best = (CagOtsu){
        .low = (double)t, .high = (double)t, .variance = variance, .below = n0, .above = n1};
  }
  best.threshold = (best.low + best.high) / 2;
  *out = best;
  return CAG_OK;
}
