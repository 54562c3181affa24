// PNG pictures for viewing, through libpng.
//
// Writing starts from linear light: each color is multiplied by 2^exposure, highlights are
// compressed, and the result gets the sRGB transfer function of IEC 61966-2-1 and is rounded to 8
// or 16 bits. The compression leaves values up to CAG_PNG_SHOULDER unchanged, and maps larger ones
// smoothly to below 1, with a continuous slope:
//
//     f(x) = x                                                  for x <= s
//     f(x) = s + (1 - s) * (1 - exp(-(x - s) / (1 - s)))        for x > s
//     with s = CAG_PNG_SHOULDER
//
// so that bright areas keep their shading. NaN and values below 0 become 0, and infinity becomes 1.
// Alpha (channel `A`, if there is one) is neither exposed nor compressed. EXR's colors, which are
// premultiplied, are first divided by it.

#ifndef CAG_INTERP_RENDER_PNG_H
#define CAG_INTERP_RENDER_PNG_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "interp/render/image.h"

// The value where the compression of highlights starts, in linear light after exposure.
#define CAG_PNG_SHOULDER 0.8

typedef struct CagPngOptions {
  double exposure;  // in stops: 1 doubles the light
  int bits;         // per channel: 8 or 16; 0 is 8
  bool keep_linear; // no compression of highlights: clips to 0..1 before the sRGB transfer
  bool drop_alpha;  // write RGB even if there is a channel A
} CagPngOptions;

// A text chunk: a keyword of 1 to 79 Latin-1 bytes, as in the PNG specification (Title, Software,
// ...), and UTF-8 text.
typedef struct CagPngText {
  const char *key;
  const char *text;
} CagPngText;

// The sRGB transfer function from linear 0..1 to encoded 0..1, and its inverse.
double cag_png_srgb_encode(double linear);
double cag_png_srgb_decode(double encoded);

// The compression of highlights above, for x >= 0.
double cag_png_shoulder(double x);

// Writes the image's color (R G B, or Y) and alpha. `-` is standard output. `options` may be NULL,
// and so may `texts` if the count is 0. Fails with CAG_E_FILE (cannot be written) or CAG_E_USAGE
// (no color channels, or an unsupported number of bits).
bool cag_png_write(const char *path, const CagImage *image, const CagPngOptions *options,
                   const CagPngText *texts, size_t text_count, CagError *err);

// Reads any PNG into linear R, G, B, and, if it has transparency, A (premultiplied, as in EXR). Its
// colors are assumed to be sRGB.
bool cag_png_read(const char *path, CagImage *out, CagError *err);

#endif
