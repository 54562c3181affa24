// Filters of images: noise, sharpness, contrast, and convolution. Each channel is filtered alone.
//
// A pixel without a value has no effect on medians and majorities. All other results are without a
// value where a pixel that they depend on is.

#ifndef CAG_GEOM_IMAGE_FILTER_H
#define CAG_GEOM_IMAGE_FILTER_H

#include "geom/image/window.h"

// The longest side of the window of a median, and of a kernel.
#define CAG_WINDOW_MOST 99
// The largest standard deviation of a blur, in pixels.
#define CAG_BLUR_MOST 250

// The median of the size x size pixels about each pixel; of an even number of values, the mean of
// the middle two. size: odd, at most CAG_WINDOW_MOST.
CagStatus cag_image_median(const CagRaster *r, size_t size, CagBorder border, CagRaster **out,
                           CagError *err);
// 1 where more than half of the 3 x 3 pixels about a pixel are not 0, else 0.
CagStatus cag_image_majority(const CagRaster *r, CagBorder border, CagRaster **out, CagError *err);
// v - k L, where L is the sum of the four neighbors minus 4 v.
CagStatus cag_image_sharpen(const CagRaster *r, double k, CagBorder border, CagRaster **out,
                            CagError *err);
// (v - low) / (high - low) top. If low and high are equal, the result is unchanged.
CagStatus cag_image_stretch(const CagRaster *r, double low, double high, double top,
                            CagRaster **out, CagError *err);
// 1 where v >= t, else 0; with `keep`, v where v >= t.
CagStatus cag_image_threshold(const CagRaster *r, double t, bool keep, CagRaster **out,
                              CagError *err);
// Convolution with a Gaussian of standard deviation sigma in pixels, up to 4 sigma, whose weights
// add up to 1.
CagStatus cag_image_blur(const CagRaster *r, double sigma, CagBorder border, CagRaster **out,
                         CagError *err);
// Convolution with a kernel of width x height numbers, in rows from the top; both are odd. Pixel
// [x, y] of the result is the sum of kernel[j][i] v(x + rx - i, y + ry - j), where [rx, ry] is the
// middle of the kernel.
CagStatus cag_image_convolve(const CagRaster *r, const double *kernel, size_t width, size_t height,
                             CagBorder border, CagRaster **out, CagError *err);
// The least and greatest value of all channels. Returns false if no pixel has a value.
bool cag_image_range(const CagRaster *r, double *low, double *high);

#endif
