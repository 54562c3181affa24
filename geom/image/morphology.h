// Morphology: the greatest and least values of windows, and distances from the background.

#ifndef CAG_GEOM_IMAGE_MORPHOLOGY_H
#define CAG_GEOM_IMAGE_MORPHOLOGY_H

#include "geom/image/raster.h"

// The greatest (dilation) or least (erosion) value of the size x size pixels about each pixel; size
// is odd. Pixels outside of the image and pixels without a value have no effect. The time does not
// depend on the size (van Herk 1992; Gil and Werman 1993).
CagStatus cag_image_dilate(const CagRaster *r, size_t size, CagRaster **out, CagError *err);
CagStatus cag_image_erode(const CagRaster *r, size_t size, CagRaster **out, CagError *err);

// For each pixel of channel 0 that is not 0, the distance in pixels from its center to the nearest
// center of a pixel that is 0, exact; and 0 for pixels that are 0. A pixel without a value has no
// distance, and neither has any pixel if none is 0. Linear in the pixels (Meijster, Roerdink, and
// Hesselink 2000).
CagStatus cag_distance_transform(const CagRaster *r, CagRaster **out, CagError *err);

#endif
