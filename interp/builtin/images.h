// What the built-in functions of images share.

#ifndef CAG_INTERP_BUILTIN_IMAGES_H
#define CAG_INTERP_BUILTIN_IMAGES_H

#include "geom/image/raster.h"
#include "interp/vm/builtin.h"

// Reads an image. It is borrowed.
bool cag_arg_image(CagCall *call, int argument, CagRaster **out);
// Makes a raster, which the call holds until cag_image_result takes it. NULL: the error is set.
CagRaster *cag_held_raster(CagCall *call, size_t width, size_t height, size_t channel_count);
// Makes a raster of rows of pixels, which the call holds in the same way. NULL: the error is set.
CagRaster *cag_held_rows(CagCall *call, int argument);
// Holds a raster until the call ends or it is given away, and returns it.
CagRaster *cag_hold_raster(CagCall *call, CagRaster *r);
// The held raster as a value.
CagValue cag_image_result(CagCall *call, CagRaster *r);
// The value of a call of the core that makes a raster, or the machine's error. Takes the address of
// what was made because the call that fills it in is an argument before it.
bool cag_raster_result(CagCall *call, CagStatus status, CagRaster **made, CagValue *result);
// Finds a channel by its name. Fails with "no-channel" and a list of the channels.
bool cag_channel_find(CagCall *call, int argument, const CagRaster *r, const char *name,
                      size_t *channel);
// The pixel [x, y], y down: a number or, if there are several channels, a list. A channel without a
// value is none, and so is a pixel without one in any channel.
CagValue cag_pixel_value(CagVm *vm, const CagRaster *r, size_t x, size_t y);

#endif
