// Images of plane regions: how much of each pixel a region covers.

#ifndef CAG_GEOM_IMAGE_COVERAGE_H
#define CAG_GEOM_IMAGE_COVERAGE_H

#include "geom/curve/region.h"
#include "geom/image/raster.h"

// A grid of width x height square pixels of side `pixel`, whose lower left corner is at (x, y). The
// plane has y up. Pixel [c, r] of the image covers x + c pixel .. x + (c + 1) pixel, and y + (height
// - 1 - r) pixel .. y + (height - r) pixel.
typedef struct CagGrid {
  double x, y, pixel;
  size_t width, height;
} CagGrid;

typedef enum CagPixelRule {
  CAG_PIXEL_COVERAGE, // the fraction of the pixel's area that lies in the region
  CAG_PIXEL_CENTER // 1 if the pixel's center lies in the region, or on a left or lower edge; or 0
} CagPixelRule;

// One channel without a name. Fractions are exact to rounding, also along curved edges: the boundary
// is cut where it crosses the lines of the grid, and each pixel gets the area between its pieces by
// Green's theorem. The effort is proportional to the number of pixels and cuts.
CagStatus cag_raster_of_region(const CagRegion *region, const CagGrid *grid, CagPixelRule rule,
                               CagRaster **out, CagError *err);

#endif
