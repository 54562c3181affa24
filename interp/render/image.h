// Pictures in memory: named channels of 32-bit floats.
//
// Samples are planar: channel c is one block of width * height floats, in rows from the top, x
// fastest. Colors are linear light with the sRGB primaries unless a function states otherwise.
// Channels are named as in EXR: R G B A Z, or `layer.name`.

#ifndef CAG_INTERP_RENDER_IMAGE_H
#define CAG_INTERP_RENDER_IMAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

// The longest channel name in bytes: the limit of EXR files with long names.
#define CAG_IMAGE_NAME_MAX 255
// The longest side in pixels, and the maximum number of samples (pixels times channels) of an
// image, which is 4 GB of floats. Larger sizes come from damaged files and typing errors.
#define CAG_IMAGE_SIDE_MAX ((size_t)1 << 17)
#define CAG_IMAGE_SAMPLES_MAX ((size_t)1 << 30)
#define CAG_IMAGE_CHANNELS_MAX ((size_t)1024)

typedef struct CagImageChannel {
  char name[CAG_IMAGE_NAME_MAX + 1];
} CagImageChannel;

typedef struct CagImage {
  size_t width, height;
  size_t channel_count;
  CagImageChannel *channels;
  float *data; // channel_count planes of width * height samples
} CagImage;

// Makes an image of zeros with unnamed channels. Release it with cag_image_free. A size of zero or
// above the limits is an error of status CAG_E_LIMIT, exhausted memory one of CAG_E_MEMORY.
bool cag_image_create(CagImage *out, size_t width, size_t height, size_t channel_count,
                      CagError *err);

// Releases the image and makes it empty ({0}). Empty images are allowed.
void cag_image_free(CagImage *image);

// Names channel c. A name that is too long is truncated.
void cag_image_set_name(CagImage *image, size_t c, const char *name);

// The samples of channel c.
static inline float *cag_image_plane(const CagImage *image, size_t c) {
  return image->data + c * image->width * image->height;
}

// Finds a channel by its name.
bool cag_image_find(const CagImage *image, const char *name, size_t *index);

// Whether all samples are half floats, such as those of POV-Ray's pictures.
bool cag_image_is_half(const CagImage *image);

// Finds the color channels: R, G, and B, or three times a luminance Y or the only channel. Returns
// false if there are none.
bool cag_image_find_color(const CagImage *image, size_t rgb[3]);

#endif
