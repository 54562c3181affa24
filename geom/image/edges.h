// Edges: where gray values change.
//
// Directions are those of increasing gray values, in degrees counter-clockwise from +x, y up, in
// (-180, 180]. They are without a value where the magnitude is 0. Both results are without a value
// where a pixel that they depend on is.

#ifndef CAG_GEOM_IMAGE_EDGES_H
#define CAG_GEOM_IMAGE_EDGES_H

#include "geom/image/raster.h"

// Roberts' operator (Roberts 1963) on channel 0: the results have one row and one column less than
// the image. Pixel [x, y] is at the common corner of the pixels [x, y] and [x + 1, y + 1]. On a
// plane slope, the magnitude is the gradient times the root of 2. The image has at least 2 x 2
// pixels.
CagStatus cag_edges_roberts(const CagRaster *r, CagRaster **magnitude, CagRaster **direction,
                            CagError *err);
// Sobel's operator, with the weights 1, 2, 1: on a plane slope, the magnitude is 8 times the
// gradient. Pixels beyond the border are those of the nearest pixel.
CagStatus cag_edges_sobel(const CagRaster *r, CagRaster **magnitude, CagRaster **direction,
                          CagError *err);
// The two components of the gradient by Sobel's operator, divided by 8: x to the right, y up.
CagStatus cag_edges_gradient(const CagRaster *r, CagRaster **gx, CagRaster **gy, CagError *err);
// Edges one pixel wide (Canny 1986): the image is blurred, and the maxima of Sobel's magnitude
// across the edge are kept if they are at least `high`, or at least `low` and connected to one of
// these by 8 neighbors. The result is 1 on edges and 0 elsewhere.
CagStatus cag_edges_canny(const CagRaster *r, double low, double high, double sigma,
                          CagRaster **out, CagError *err);

#endif
