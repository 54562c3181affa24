// Pictures in memory: allocation and channel names.

#include "interp/render/image.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"

bool cag_image_create(CagImage *out, size_t width, size_t height, size_t channel_count,
                      CagError *err) {
  if (!width || !height || !channel_count)
    return cag_fail_io(err, CAG_E_LIMIT, NULL,
                       "an image of %zu by %zu pixels with %zu channels has no samples", width,
                       height, channel_count);
  // The first three bounds keep the product below 2^64.
  if (width > CAG_IMAGE_SIDE_MAX || height > CAG_IMAGE_SIDE_MAX ||
      channel_count > CAG_IMAGE_CHANNELS_MAX ||
      width * height * channel_count > CAG_IMAGE_SAMPLES_MAX)
    return cag_fail_io(err, CAG_E_LIMIT, "make it smaller",
                       "an image of %zu by %zu pixels with %zu channels is too large (at most "
                       "%zu samples, %zu pixels on a side, %zu channels)",
                       width, height, channel_count, CAG_IMAGE_SAMPLES_MAX, CAG_IMAGE_SIDE_MAX,
                       CAG_IMAGE_CHANNELS_MAX);
  CagImageChannel *channels = cag_calloc(channel_count, sizeof *channels);
  float *data = cag_calloc(width * height * channel_count, sizeof *data);
  if (!channels || !data) {
    cag_free(channels);
    cag_free(data);
    return cag_fail_io(err, CAG_E_MEMORY, "make it smaller",
                       "not enough memory for an image of %zu by %zu pixels with %zu channels",
                       width, height, channel_count);
  }
  *out = (CagImage){width, height, channel_count, channels, data};
  return true;
}

void cag_image_free(CagImage *image) {
  cag_free(image->channels);
  cag_free(image->data);
  *image = (CagImage){0};
}

void cag_image_set_name(CagImage *image, size_t c, const char *name) {
  snprintf(image->channels[c].name, sizeof image->channels[c].name, "%s", name);
}

bool cag_image_find(const CagImage *image, const char *name, size_t *index) {
  for (size_t c = 0; c < image->channel_count; c++) {
    if (strcmp(image->channels[c].name, name) != 0) continue;
    *index = c;
    return true;
  }
  return false;
}

bool cag_image_find_color(const CagImage *image, size_t rgb[3]) {
  if (cag_image_find(image, "R", &rgb[0]) && cag_image_find(image, "G", &rgb[1]) &&
      cag_image_find(image, "B", &rgb[2]))
    return true;
  if (!cag_image_find(image, "Y", &rgb[0])) {
    if (image->channel_count != 1) return false;
    rgb[0] = 0;
  }
  rgb[1] = rgb[2] = rgb[0];
  return true;
}

// A half float has 11 digits, and a multiple of 2^-24 (IEEE 754-2019, 3.6).
static bool is_half(float x) {
  const float largest = 65504, step = 0x1p-24f, normal = 0x1p-14f;
  if (!isfinite(x)) return true;
  if (fabsf(x) > largest) return false;
  if (fabsf(x) < normal) return x / step == rintf(x / step);
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return (bits & 0x1fff) == 0;
}

bool cag_image_is_half(const CagImage *image) {
  const size_t n = image->width * image->height * image->channel_count;
  for (size_t i = 0; i < n; i++)
    if (!is_half(image->data[i])) return false;
  return true;
}
