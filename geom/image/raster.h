// Rasters: the pixels of an image, in named channels.
//
// A raster has one or more channels of width x height doubles. A pixel without a value is NaN. Row
// 0 is the upper one. Functions that measure state whether their points have y down, in pixels with
// [0, 0] at the upper left corner of the image, or y up, with the origin at the lower left corner
// and pixels of side 1. In both, the center of the first pixel is half a pixel from the corner.

#ifndef CAG_GEOM_IMAGE_RASTER_H
#define CAG_GEOM_IMAGE_RASTER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

// The longest name of a channel in bytes, as in EXR files with long names.
#define CAG_CHANNEL_NAME_MAX 255
// The longest side in pixels, and the maximum number of samples, 2 GB. Larger sizes come from
// typing errors and damaged files.
#define CAG_RASTER_SIDE_MAX ((size_t)1 << 17)
#define CAG_RASTER_SAMPLES_MAX ((size_t)1 << 28)
#define CAG_RASTER_CHANNELS_MAX ((size_t)1024)

// Immutable once it is a value. The samples are planar: channel c is one block of width * height
// doubles, in rows from the top.
typedef struct CagRaster {
  int references;
  size_t width, height, channel_count;
  char **names; // of channels; "" if a channel has no name
  double *data;
} CagRaster;

// Makes a raster of zeros with channels without names. Fails with CAG_E_LIMIT "image-size" if a
// side is 0 or larger than the limits.
CagStatus cag_raster_new(size_t width, size_t height, size_t channel_count, CagRaster **out,
                         CagError *err);
// A raster of the same size and channels, of zeros.
CagStatus cag_raster_like(const CagRaster *r, CagRaster **out, CagError *err);
// Names channel c. A longer name is cut at CAG_CHANNEL_NAME_MAX bytes.
CagStatus cag_raster_name(CagRaster *r, size_t c, const char *name, CagError *err);
// The index of a channel; false: there is none of that name.
bool cag_raster_find(const CagRaster *r, const char *name, size_t *channel);
CagRaster *cag_raster_retain(const CagRaster *r);
void cag_raster_release(CagRaster *r); // r may be NULL
// Whether sizes and names are valid. For CAG_ASSERT and tests.
bool cag_check_raster(const CagRaster *r);

// The samples of channel c, and sample [x, y] of it, y down.
static inline double *cag_raster_plane(const CagRaster *r, size_t c) {
  return r->data + c * r->width * r->height;
}
static inline double *cag_raster_at(const CagRaster *r, size_t c, size_t x, size_t y) {
  return r->data + (c * r->height + y) * r->width + x;
}

#endif
