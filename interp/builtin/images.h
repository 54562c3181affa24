// What the built-in functions of images share.

#ifndef CAG_INTERP_BUILTIN_IMAGES_H
#define CAG_INTERP_BUILTIN_IMAGES_H

#include "geom/image/raster.h"
#include "interp/vm/builtin.h"

// Reads an image. It is borrowed.
bool cag_arg_image(CagCall *call, int argument, CagRaster **out);
// Makes a raster, which the call holds until cag_image_result takes it. NULL: the error is set.
CagRaster *cag_held_raster(CagCall *call, size_t width, size_t height, size_t channel_count);
// The held raster as a value.
CagValue cag_image_result(CagCall *call, CagRaster *r);
// The pixel [x, y], y down: a number or, if there are several channels, a list. A channel without a
// value is none.
CagValue cag_pixel_value(CagVm *vm, const CagRaster *r, size_t x, size_t y);

#endif
