// Connected regions of an image's figure.
//
// The figure of an image consists of the pixels whose gray value is greater than 0. Other pixels,
// and those without a value, are background. A region is a set of figure pixels that are connected
// by neighbors: 8 neighbors, or the 4 that share a side. The background then has the other
// connectivity, so that a closed line separates its inside from its outside.

#ifndef CAG_GEOM_IMAGE_LABELS_H
#define CAG_GEOM_IMAGE_LABELS_H

#include <stdint.h>

#include "geom/image/raster.h"

// Pixels [start, end) of row y, y down, which are all of the figure.
typedef struct CagRun {
  uint32_t y, start, end;
  uint32_t label; // of the region, from 1
} CagRun;

typedef struct CagLabels {
  size_t width, height;
  int connectivity; // 4 or 8
  CagRun *runs;     // in raster order
  size_t run_count;
  size_t count;  // number of regions
  uint32_t *at;  // width x height; 0 is background. Labels are in raster order of the first pixel
  CagRun *by;    // the same runs sorted by label, in raster order within each
  size_t *first; // count + 1: the runs of label k are by[first[k - 1]] .. by[first[k]]
} CagLabels;

// Labels the regions of channel 0 in time linear in the pixels. Release with cag_labels_free. Fails
// with "gray-weight" if a gray value is negative or infinite.
CagStatus cag_labels_new(const CagRaster *r, int connectivity, CagLabels *out, CagError *err);
void cag_labels_free(CagLabels *l);

// Whether [x, y] is a pixel of the figure. Pixels outside of the image are background.
static inline bool cag_labels_has(const CagLabels *l, long x, long y) {
  return x >= 0 && y >= 0 && (size_t)x < l->width && (size_t)y < l->height &&
         l->at[(size_t)y * l->width + (size_t)x] != 0;
}

#endif
