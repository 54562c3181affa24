// The samples of PNG pictures as they are in the file, without any transfer function: for images
// whose numbers are data, not colors to look at.

#ifndef CAG_INTERP_RENDER_PNG_SAMPLES_H
#define CAG_INTERP_RENDER_PNG_SAMPLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

// Rows from the top; the samples of a pixel are adjacent.
typedef struct CagPngSamples {
  size_t width, height;
  size_t channels; // 1: gray, 2: gray and alpha, 3: R G B, 4: R G B and alpha
  int bits;        // 8 or 16
  uint8_t *bytes;  // one or two bytes per sample, big-endian
} CagPngSamples;

// Makes room for the samples; the other fields are set. Fails with CAG_E_LIMIT if there are more
// than an image may have (geom/image/raster.h), or CAG_E_MEMORY.
bool cag_png_samples_create(CagPngSamples *s, CagError *err);
void cag_png_samples_free(CagPngSamples *s);

// Sample i of the file, from 0 to 2^bits - 1.
static inline unsigned cag_png_sample(const CagPngSamples *s, size_t i) {
  return s->bits == 8 ? s->bytes[i] : (unsigned)s->bytes[2 * i] << 8 | s->bytes[2 * i + 1];
}
static inline void cag_png_set_sample(CagPngSamples *s, size_t i, unsigned code) {
  if (s->bits == 8) {
    s->bytes[i] = (uint8_t)code;
    return;
  }
  s->bytes[2 * i] = (uint8_t)(code >> 8);
  s->bytes[2 * i + 1] = (uint8_t)code;
}

// Reads any PNG from memory; `shown` is its name in messages. Palettes become R G B, grays of less
// than 8 bits are scaled to 8, and a transparent color becomes an alpha channel. Damaged and
// malicious files are errors of status CAG_E_FILE.
bool cag_png_read_samples(const void *bytes, size_t size, const char *shown, CagPngSamples *out,
                          CagError *err);

// Writes a PNG. `-` is standard output.
bool cag_png_write_samples(const char *path, const CagPngSamples *s, CagError *err);

#endif
