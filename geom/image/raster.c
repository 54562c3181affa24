#include "geom/image/raster.h"

#include <string.h>

#include "base/memory.h"

CagStatus cag_raster_new(size_t width, size_t height, size_t channel_count, CagRaster **out,
                         CagError *err) {
  if (width == 0 || height == 0 || channel_count == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_image, "", -1,
                    "an image needs at least one pixel and one channel, found %zu x %zu pixels of "
                    "%zu channels",
                    width, height, channel_count);
  if (width > CAG_RASTER_SIDE_MAX || height > CAG_RASTER_SIDE_MAX ||
      channel_count > CAG_RASTER_CHANNELS_MAX ||
      width * height > CAG_RASTER_SAMPLES_MAX / channel_count)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_image_size, "", -1,
                    "an image of %zu x %zu pixels and %zu channels is too large: the limit is %zu "
                    "numbers, and %zu pixels along a side",
                    width, height, channel_count, CAG_RASTER_SAMPLES_MAX, CAG_RASTER_SIDE_MAX);
  CagRaster *r = cag_calloc(1, sizeof *r);
  if (!r) return cag_fail_memory(err);
  *r = (CagRaster){
      .references = 1, .width = width, .height = height, .channel_count = channel_count};
  r->names = cag_calloc(channel_count, sizeof *r->names);
  r->data = cag_calloc(width * height * channel_count, sizeof *r->data);
  CagStatus status = r->names && r->data ? CAG_OK : cag_fail_memory(err);
  for (size_t c = 0; !status && c < channel_count; c++) status = cag_raster_name(r, c, "", err);
  if (status) cag_raster_release(r);
  else *out = r;
  return status;
}

CagStatus cag_raster_like(const CagRaster *r, CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_new(r->width, r->height, r->channel_count, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    status = cag_raster_name(made, c, r->names[c], err);
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

CagStatus cag_raster_name(CagRaster *r, size_t c, const char *name, CagError *err) {
  size_t length = strlen(name);
  if (length > CAG_CHANNEL_NAME_MAX) length = CAG_CHANNEL_NAME_MAX;
  char *copy = cag_malloc(length + 1);
  if (!copy) return cag_fail_memory(err);
  memcpy(copy, name, length);
  copy[length] = '\0';
  cag_free(r->names[c]);
  r->names[c] = copy;
  return CAG_OK;
}

bool cag_raster_find(const CagRaster *r, const char *name, size_t *channel) {
  for (size_t c = 0; c < r->channel_count; c++)
    if (!strcmp(r->names[c], name)) {
      *channel = c;
      return true;
    }
  return false;
}

CagRaster *cag_raster_retain(const CagRaster *r) {
  CagRaster *kept = (CagRaster *)r;
  kept->references++;
  return kept;
}

void cag_raster_release(CagRaster *r) {
  if (!r || --r->references > 0) return;
  for (size_t c = 0; r->names && c < r->channel_count; c++) cag_free(r->names[c]);
  cag_free(r->names);
  cag_free(r->data);
  cag_free(r);
}

bool cag_check_raster(const CagRaster *r) {
  if (r->references < 1 || r->width == 0 || r->height == 0 || r->channel_count == 0 || !r->data)
    return false;
  for (size_t c = 0; c < r->channel_count; c++)
    if (!r->names[c]) return false;
  return true;
}
