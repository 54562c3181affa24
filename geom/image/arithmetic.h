// Arithmetic with the samples of images, sample by sample.
//
// A sample without a value makes the result one without a value, and so does a result that is
// undefined or too large for a number: a raster never has infinite samples. Everything is linear in
// the number of samples.

#ifndef CAG_GEOM_IMAGE_ARITHMETIC_H
#define CAG_GEOM_IMAGE_ARITHMETIC_H

#include "geom/image/raster.h"

typedef enum CagRasterOp {
  CAG_RASTER_ADD,
  CAG_RASTER_SUBTRACT,
  CAG_RASTER_MULTIPLY,
  CAG_RASTER_DIVIDE
} CagRasterOp;

// a op b. The images have the same size, and equally many channels unless one has a single channel,
// which is then combined with each of the other. The channels have the names of the image with more
// of them, or those of a. Fails with "image-sizes" and "image-channels".
CagStatus cag_raster_combine(CagRasterOp op, const CagRaster *a, const CagRaster *b,
                             CagRaster **out, CagError *err);
// a op k or, if `swapped`, k op a.
CagStatus cag_raster_with_number(CagRasterOp op, const CagRaster *a, double k, bool swapped,
                                 CagRaster **out, CagError *err);

// Figures of all samples that have a value.
typedef struct CagRasterFigures {
  size_t count;           // of samples with a value
  double least, greatest; // NaN if there are none
  double sum;             // rounding errors do not accumulate (Neumaier 1974)
} CagRasterFigures;
CagStatus cag_raster_figures(const CagRaster *r, CagRasterFigures *out, CagError *err);

// The most bits of a code. Larger codes are not exact in all formats of files.
#define CAG_CODE_BITS_MAX 32
// The code of a brightness, 0 to 2^bits - 1: floor(clamp(v / white, 0, 1) (2^bits - 1) + 1/2). bits
// in 1..CAG_CODE_BITS_MAX, white > 0. NaN remains NaN.
double cag_code_of(double value, int bits, double white);
double cag_value_of_code(double code, int bits, double white); // code / (2^bits - 1) white
CagStatus cag_raster_to_codes(const CagRaster *r, int bits, double white, CagRaster **out,
                              CagError *err);
CagStatus cag_raster_from_codes(const CagRaster *r, int bits, double white, CagRaster **out,
                                CagError *err);

#endif
