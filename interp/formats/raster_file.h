// Images as EXR and PNG files.
//
// In EXR files, the channels r, g, b, and a are called R, G, B, and A, and a single channel without
// a name Y, so that other programs show them. Two attributes of the header keep the own names and
// the order, so an image is read again as it was: its numbers as 32-bit floats, to the bit. A pixel
// without a value is NaN in EXR and 0 in PNG.
//
// PNG files hold codes of 8 or 16 bits. Code 0 is 0, and the largest code is 1; there is no transfer
// function.

#ifndef CAG_INTERP_FORMATS_RASTER_FILE_H
#define CAG_INTERP_FORMATS_RASTER_FILE_H

#include "geom/image/raster.h"

// Reads an EXR or PNG file from memory; `shown` is its name in messages. EXR files in half or float,
// PNG files of any kind. Infinity and NaN become pixels without a value. Fails with CAG_E_FILE,
// CAG_E_LIMIT, or CAG_E_MEMORY.
bool cag_raster_read(const void *bytes, size_t size, const char *shown, CagRaster **out,
                     CagError *err);

// Writes all channels as 32-bit floats. `-` is standard output. Numbers beyond the range of floats
// become infinite.
bool cag_raster_write_exr(const char *path, const CagRaster *r, CagError *err);

typedef struct CagRasterRange {
  double low, high; // the numbers that become black and white
  int bits;         // 8 or 16
} CagRasterRange;
// Writes 1 (gray), 3 (R G B), or 4 channels (R G B A), or gray with a second channel `a`. Fails with
// CAG_E_USAGE for other channels.
bool cag_raster_write_png(const char *path, const CagRaster *r, const CagRasterRange *range,
                          CagError *err);

#endif
