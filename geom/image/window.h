// Rows of an image with a margin, for operations on windows of pixels.

#ifndef CAG_GEOM_IMAGE_WINDOW_H
#define CAG_GEOM_IMAGE_WINDOW_H

#include "geom/image/raster.h"

// The pixels outside of an image: those of the nearest pixel, 0, or a reflection in which the
// pixel at the border comes twice.
typedef enum CagBorder { CAG_BORDER_REPLICATE, CAG_BORDER_ZERO, CAG_BORDER_REFLECT } CagBorder;

// The index within [0, n) that stands for index i; -1: the value is 0.
long cag_border_index(long i, size_t n, CagBorder border);

// Computes row y of the result. rows[j] is row y + j - ry of the channel, from which
// rows[j][i + k] is pixel i + k - rx. `has_none` states whether the rows contain pixels without a
// value.
typedef void CagWindowRow(const void *context, const double *const *rows, size_t width,
                          bool has_none, double *out);

// An operation on windows that reach rx pixels to both sides, and ry pixels up and down.
typedef struct CagWindow {
  size_t rx, ry;
  CagBorder border;
  CagWindowRow *row;
  const void *context;
} CagWindow;

// Applies the operation to all rows of a channel. `to` has the same size, and such a channel.
CagStatus cag_window_rows(const CagRaster *from, size_t channel, const CagWindow *w, CagRaster *to,
                          CagError *err);
// The same for all channels: makes the result.
CagStatus cag_window_image(const CagRaster *from, const CagWindow *w, CagRaster **out,
                           CagError *err);

#endif
