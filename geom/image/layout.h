// Images made of the pixels of others: parts, copies, quarter turns, fields. Samples are copied, so
// all of this is exact. Coordinates are in pixels from the upper left corner, y down.

#ifndef CAG_GEOM_IMAGE_LAYOUT_H
#define CAG_GEOM_IMAGE_LAYOUT_H

#include "geom/image/raster.h"

// The n channels with these indices, in this order.
CagStatus cag_raster_select(const CagRaster *r, const size_t *channels, size_t n, CagRaster **out,
                            CagError *err);
// The part of width x height pixels whose upper left pixel is [x, y]; it must lie within the image.
CagStatus cag_raster_crop(const CagRaster *r, size_t x, size_t y, size_t width, size_t height,
                          CagRaster **out, CagError *err);
// Each pixel becomes n x n pixels.
CagStatus cag_raster_enlarge(const CagRaster *r, size_t n, CagRaster **out, CagError *err);
// Reverses the order of the columns (`across`) or of the rows.
CagStatus cag_raster_flip(const CagRaster *r, bool across, CagRaster **out, CagError *err);
// Turns the image as seen by a number of quarter turns, counter-clockwise, 0 to 3.
CagStatus cag_raster_quarter_turns(const CagRaster *r, int turns, CagRaster **out, CagError *err);

// The odd or the even rows, counted from 1: a field of an interlaced frame. An image of a single
// row has no even ones, which is an error.
CagStatus cag_raster_field(const CagRaster *r, bool even, CagRaster **out, CagError *err);
// The frame of two fields, odd rows first. `even` has as many rows as `odd` or one less; it may be
// NULL if `odd` has one row. Fails with "image-sizes" and "image-channels".
CagStatus cag_raster_weave(const CagRaster *odd, const CagRaster *even, CagRaster **out,
                           CagError *err);

#endif
