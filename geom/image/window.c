#include "geom/image/window.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"

long cag_border_index(long i, size_t n, CagBorder border) {
  const long size = (long)n;
  if (i >= 0 && i < size) return i;
  if (border == CAG_BORDER_ZERO) return -1;
  if (border == CAG_BORDER_REPLICATE) return i < 0 ? 0 : size - 1;
  const long period = 2 * size, k = ((i % period) + period) % period;
  return k < size ? k : period - 1 - k;
}

// The rows of a window, which move down by one at each step.
typedef struct Band {
  const CagRaster *from;
  size_t channel, count; // count: of rows
  const CagWindow *w;
  double *data;
  const double **rows; // the first is the upper one
  bool *none;          // whether a row has pixels without a value, by its buffer
} Band;

// Fills buffer `slot` with row y, which may lie outside of the image.
static void band_fill(Band *b, size_t slot, long y) {
  const size_t width = b->from->width, padded = width + 2 * b->w->rx;
  double *out = b->data + slot * padded;
  const long source = cag_border_index(y, b->from->height, b->w->border);
  b->none[slot] = false;
  if (source < 0) {
    memset(out, 0, padded * sizeof *out);
    return;
  }
  const double *row = cag_raster_at(b->from, b->channel, 0, (size_t)source);
  memcpy(out + b->w->rx, row, width * sizeof *out);
  for (size_t i = 0; i < b->w->rx; i++) {
    const long left = cag_border_index((long)i - (long)b->w->rx, width, b->w->border);
    const long right = cag_border_index((long)(width + i), width, b->w->border);
    out[i] = left < 0 ? 0 : row[left];
    out[b->w->rx + width + i] = right < 0 ? 0 : row[right];
  }
  for (size_t x = 0; x < width; x++) b->none[slot] |= isnan(row[x]);
}

static CagStatus band_run(Band *b, CagRaster *to, CagError *err) {
  const size_t padded = b->from->width + 2 * b->w->rx, ry = b->w->ry;
  for (size_t j = 0; j + 1 < b->count; j++) band_fill(b, j, (long)j - (long)ry);
  for (size_t y = 0; y < b->from->height; y++) {
    bool none = false;
    band_fill(b, (y + b->count - 1) % b->count, (long)(y + ry));
    for (size_t j = 0; j < b->count; j++) {
      b->rows[j] = b->data + (y + j) % b->count * padded;
      none |= b->none[j];
    }
    b->w->row(b->w->context, b->rows, b->from->width, none, cag_raster_at(to, b->channel, 0, y));
    if (cag_stopped()) return cag_stop_fail(err);
  }
  return CAG_OK;
}

CagStatus cag_window_rows(const CagRaster *from, size_t channel, const CagWindow *w, CagRaster *to,
                          CagError *err) {
  Band b = {.from = from, .channel = channel, .w = w, .count = 2 * w->ry + 1};
  b.data = cag_malloc(b.count * (from->width + 2 * w->rx) * sizeof *b.data);
  b.rows = cag_malloc(b.count * sizeof *b.rows);
  b.none = cag_calloc(b.count, sizeof *b.none);
  CagStatus status = b.data && b.rows && b.none ? CAG_OK : cag_fail_memory(err);
  if (!status) status = band_run(&b, to, err);
  cag_free(b.data);
  cag_free(b.rows);
  cag_free(b.none);
  return status;
}

CagStatus cag_window_image(const CagRaster *from, const CagWindow *w, CagRaster **out,
                           CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_like(from, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < from->channel_count; c++)
    status = cag_window_rows(from, c, w, made, err);
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}
