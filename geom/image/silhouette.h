// Exact measures of regions: silhouettes of flat parts, as references for those of images.

#ifndef CAG_GEOM_IMAGE_SILHOUETTE_H
#define CAG_GEOM_IMAGE_SILHOUETTE_H

#include "geom/curve/region.h"
#include "geom/image/measures.h"

// Measures a region of the plane, in its own coordinates. chain_length and touches_border are not
// set. Fails with "empty-silhouette" if the region has no area.
CagStatus cag_measure_region(const CagRegion *r, CagMeasures *out, CagError *err);

// The number of pixels of two images of one size that are figure in one of them only, and the
// number of common pixels divided by the number of those in either; 1 if both are empty. Fails with
// "compared-sizes".
CagStatus cag_compare_figures(const CagRaster *a, const CagRaster *b, double *different,
                              double *overlap, CagError *err);
// The same for the areas of two regions.
CagStatus cag_compare_regions(const CagRegion *a, const CagRegion *b, double *different,
                              double *overlap, CagError *err);

#endif
