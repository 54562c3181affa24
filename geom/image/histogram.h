// Histograms of gray values, and the threshold between their two modes.

#ifndef CAG_GEOM_IMAGE_HISTOGRAM_H
#define CAG_GEOM_IMAGE_HISTOGRAM_H

#include "geom/image/raster.h"

// The largest number of levels, that of 16 bits.
#define CAG_LEVELS_MOST ((size_t)1 << 16)

// Adds to counts[v] the number of pixels of channel 0 with the value v, for v = 0..levels - 1.
// Pixels without a value are skipped. Fails with "image-codes" if another value is found.
CagStatus cag_histogram(const CagRaster *r, size_t levels, double *counts, CagError *err);
// The least number of levels with which cag_histogram succeeds.
CagStatus cag_histogram_levels(const CagRaster *r, size_t *levels, CagError *err);

// A threshold t separates the codes below t from those at or above t.
typedef struct CagOtsu {
  double low, high; // all thresholds from low to high have the greatest variance between classes
  double threshold; // the middle of low and high
  double variance;
  double below, above; // number of pixels in the two classes
} CagOtsu;

// The threshold with the greatest variance between the two classes (Otsu 1979). Counts are finite
// and at least 0. Fails with "single-level-histogram" if fewer than two counts are not 0.
CagStatus cag_otsu(const double *counts, size_t levels, CagOtsu *out, CagError *err);

#endif
