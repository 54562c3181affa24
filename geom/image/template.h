// Matching of templates: small images that are searched in an image.
//
// Shift [x, y], y down, means that pixel [0, 0] of the template lies on pixel [x, y] of the image.
// Only shifts at which the template lies entirely inside count. Of equal matches, the first one in
// raster order wins. Pixels of the template without a value are ignored. Where the image has no
// value under another pixel of the template, the shift has no value. Image and template have the
// same number of channels, over which sums extend.

#ifndef CAG_GEOM_IMAGE_TEMPLATE_H
#define CAG_GEOM_IMAGE_TEMPLATE_H

#include "geom/image/raster.h"

// The best shift. The error is the sum of squared differences.
typedef struct CagMatch {
  bool found; // false: no shift has a value
  long x, y;
  double error;
  size_t counted; // samples of the template that have a value
} CagMatch;

// For each shift, the sum of squared differences between template and image (Barnea and Silverman
// 1972). Fails with "template-larger-than-image" or "several-channels".
CagStatus cag_template_errors(const CagRaster *image, const CagRaster *pattern, CagRaster **out,
                              CagError *err);
// For each shift, the normalized correlation: the sum of products, divided by the root of the
// product of both sums of squares, in [-1, 1], or 0 if one of these is 0. With `zero_mean`, the
// means are subtracted first, so that gain and offset of the gray values have no effect (Lewis
// 1995).
CagStatus cag_template_correlation(const CagRaster *image, const CagRaster *pattern, bool zero_mean,
                                   CagRaster **out, CagError *err);

// A part of a template. Its pixel [0, 0] lies on pixel [x + dx, y + dy] of the image.
typedef struct CagTemplatePart {
  const CagRaster *pattern;
  long dx, dy;
} CagTemplatePart;

// The shift of the parts, n >= 1, at which the sum of their errors is least. One part is a plain
// template.
CagStatus cag_template_find(const CagRaster *image, const CagTemplatePart *parts, size_t n,
                            CagMatch *out, CagError *err);

// The template rotated counter-clockwise about its center, and scaled: the smallest raster that
// contains it, whose other pixels have no value. Quarter turns without scaling are exact, others
// interpolate linearly.
CagStatus cag_template_turned(const CagRaster *pattern, double degrees, double scale,
                              CagRaster **out, CagError *err);

#endif
