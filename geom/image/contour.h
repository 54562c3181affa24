// Contours of the regions of an image, as chain codes.

#ifndef CAG_GEOM_IMAGE_CONTOUR_H
#define CAG_GEOM_IMAGE_CONTOUR_H

#include "geom/image/labels.h"

// A closed path through the centers of the pixels of a region that border on one component of the
// background. The figure is on its left: an outer contour runs counter-clockwise, with y up, and
// the contour of a hole clockwise.
typedef struct CagContour {
  bool hole;
  size_t x, y;    // the pixel at which it starts, y down
  uint32_t label; // of the region
  // Freeman's code: 0 is a step in direction +x, and each further number turns by 45 degrees
  // counter-clockwise, with y up. A single pixel has no steps.
  uint8_t *code;
  size_t count;
  double length; // 1 for each straight step, and the square root of 2 for each diagonal one
  double area;   // enclosed by the path through the centers; at least 0
} CagContour;

typedef struct CagContours {
  CagContour *items;
  size_t count, capacity;
} CagContours;

// Finds all contours, in raster order of the pixels at which they start. Fails with an error of
// memory or of the stop.
CagStatus cag_contours_new(const CagLabels *l, CagContours *out, CagError *err);
void cag_contours_free(CagContours *c);
// Adds the length of the outer contour of a region, without storing it.
double cag_contour_outer_length(const CagLabels *l, size_t label);

// The step of a code: [x, y] with y down.
extern const int cag_contour_step[8][2];

#endif
