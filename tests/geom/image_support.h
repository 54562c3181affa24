// Images of tests.

#ifndef CAG_TESTS_GEOM_IMAGE_SUPPORT_H
#define CAG_TESTS_GEOM_IMAGE_SUPPORT_H

#include "geom/image/raster.h"
#include "random.h"
#include "support.h"

// An image of rows of digits, and of '-' for pixels without a value, separated by '/'.
static inline CagRaster *picture(const char *rows) {
  size_t width = strcspn(rows, "/"), height = 1;
  for (const char *c = rows; *c; c++) height += *c == '/';
  CagRaster *r;
  OK(cag_raster_new(width, height, 1, &r, &err));
  for (size_t y = 0; y < height; y++)
    for (size_t x = 0; x < width; x++) {
      const char c = rows[y * (width + 1) + x];
      *cag_raster_at(r, 0, x, y) = c == '-' ? NAN : c - '0';
    }
  return r;
}

// An image of random whole numbers from 0 to `most`, which is 0 in about the given fraction of the
// pixels.
static inline CagRaster *random_picture(size_t width, size_t height, int most, double zeros) {
  CagRaster *r;
  OK(cag_raster_new(width, height, 1, &r, &err));
  for (size_t i = 0; i < width * height; i++)
    r->data[i] = uniform(0, 1) < zeros ? 0 : floor(uniform(1, most + 1));
  return r;
}

// The pixel, or `outside` beyond the border.
static inline double pixel_or(const CagRaster *r, long x, long y, double outside) {
  if (x < 0 || y < 0 || (size_t)x >= r->width || (size_t)y >= r->height) return outside;
  return *cag_raster_at(r, 0, (size_t)x, (size_t)y);
}

// The figures of the reference: an L, and a scene of several regions.
#define PICTURE_L "00000000/01100000/01100000/01100000/01100000/01111100/01111100/00000000"
#define PICTURE_SCENE "1100000/1100111/0000101/0000111/1001000/0100011"

#endif
