// PNG pictures, through libpng: what a person looks at.
//
// Written from linear light: each color is multiplied by 2^exposure, highlights are rolled off,
// the result gets the sRGB transfer of IEC 61966-2-1 and is rounded to 8 or 16 bits. The roll-off
// keeps everything up to CAG_PNG_SHOULDER as it is and bends what lies above towards 1 with a
// continuous slope:
//
//     f(x) = x                                                  for x <= s
//     f(x) = s + (1 - s) * (1 - exp(-(x - s) / (1 - s)))        for x > s,        s =
//     CAG_PNG_SHOULDER
//
// so that a bright spot keeps its shape instead of turning flat. NaN and values below 0 become 0,
// infinity becomes 1. Alpha (channel `A`, when there is one) is not exposed or bent; EXR's colors,
// which are premultiplied, are divided by it first.

#ifndef CAG_INTERP_RENDER_PNG_H
#define CAG_INTERP_RENDER_PNG_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "interp/render/image.h"

// Where the roll-off of highlights begins, in linear light after exposure.
#define CAG_PNG_SHOULDER 0.8

typedef struct CagPngOptions {
  double exposure;  // in stops: 1 doubles the light
  int bits;         // per channel: 8 or 16; 0 is 8
  bool keep_linear; // no roll-off: plain clipping to 0..1 before the sRGB transfer
  bool drop_alpha;  // write RGB also when there is a channel A
} CagPngOptions;

// A text chunk: a keyword of 1 to 79 Latin-1 bytes, as PNG asks (Title, Software, ...), and UTF-8
// text.
typedef struct CagPngText {
  const char *key;
  const char *text;
} CagPngText;

// The sRGB transfer: linear 0..1 to encoded 0..1, and back.
double cag_png_srgb_encode(double linear);
double cag_png_srgb_decode(double encoded);

// The roll-off above, for x >= 0.
double cag_png_shoulder(double x);

// Writes the image's color (R G B, or Y) and alpha. `-` is standard output. `options` may be NULL,
// `texts` too when the count is 0. Fails with CAG_E_FILE (cannot be written), CAG_E_USAGE (no
// color channels, bits that PNG does not have).
bool cag_png_write(const char *path, const CagImage *image, const CagPngOptions *options,
                   const CagPngText *texts, size_t text_count, CagError *err);

// Reads a PNG of any kind into linear R, G, B, and A (premultiplied, as in EXR) if it has
// transparency, taking its colors as sRGB.
bool cag_png_read(const char *path, CagImage *out, CagError *err);

#endif
