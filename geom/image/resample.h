// Images of another size, and turned by any angle.

#ifndef CAG_GEOM_IMAGE_RESAMPLE_H
#define CAG_GEOM_IMAGE_RESAMPLE_H

#include "geom/image/raster.h"

// Each new pixel is the mean of the image over the area of the pixel, where old pixels are squares
// of constant value. Samples without a value are left out; a pixel without any has no value. Linear
// in the number of old and new pixels.
CagStatus cag_raster_resize(const CagRaster *r, size_t width, size_t height, CagRaster **out,
                            CagError *err);

// The image turned about its center, counter-clockwise as seen, in radians, in the smallest image
// that contains it. Quarter turns are exact. Otherwise a pixel is interpolated between the centers
// of the four old pixels around its center (bilinear); beyond the outermost centers, the nearest
// values are continued to the edge. Pixels outside have the value `outside`, which may be NaN.
CagStatus cag_raster_turn(const CagRaster *r, double angle, double outside, CagRaster **out,
                          CagError *err);

#endif
