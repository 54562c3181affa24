// Lines and corners in images. Points have y up: the origin is the lower left corner of the image.

#ifndef CAG_GEOM_IMAGE_LINES_H
#define CAG_GEOM_IMAGE_LINES_H

#include "geom/image/raster.h"
#include "geom/linalg/vec.h"

typedef struct CagImageLine {
  double theta;       // the slope in degrees, in (-90, 90]
  double distance;    // y cos(theta) - x sin(theta) of all points of the line
  size_t pixels;      // of the figure within 1 pixel of the line
  CagVec3 start, end; // the part of the line along these pixels; end.x >= start.x
} CagImageLine;

// Finds up to n lines that pass through the most pixels of channel 0 that are greater than 0, by
// Hough's transform (Duda and Hart 1972) with bins of 1 degree and 1 pixel. Each line is fitted to
// its pixels by total least squares. These pixels are removed before the next line is searched. A
// line has at least 2 pixels. *out is malloc'd.
CagStatus cag_hough_lines(const CagRaster *r, size_t n, CagImageLine **out, size_t *count,
                          CagError *err);

typedef struct CagImageCorner {
  CagVec3 at;
  double strength;
} CagImageCorner;

// Finds up to n corners of channel 0: local maxima of the smaller eigenvalue of the matrix of
// products of the gradient, averaged with a Gaussian (Shi and Tomasi 1994), strongest first. They
// are at least 3 pixels apart, and located where the edges around them meet. *out is malloc'd.
CagStatus cag_image_corners(const CagRaster *r, size_t n, CagImageCorner **out, size_t *count,
                            CagError *err);

#endif
