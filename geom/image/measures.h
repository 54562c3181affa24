// Measures of figures: area, centers, second moments, shape numbers, perimeter, and radii.
//
// Points have y up: the origin is the lower left corner of the image, and pixels have side 1. The
// definitions are those of Horn (1986, chapter 3): with xx, yy, and xy the second central moments
// divided by the area, the mean squared distance from a line of slope theta through the centroid is
// xx sin^2 - 2 xy sin cos + yy cos^2.

#ifndef CAG_GEOM_IMAGE_MEASURES_H
#define CAG_GEOM_IMAGE_MEASURES_H

#include "geom/image/labels.h"

// Whether a gray value is constant over its pixel, or concentrated in the pixel's center.
typedef enum CagMass { CAG_MASS_AREA, CAG_MASS_POINT } CagMass;

// Angles are in degrees.
typedef struct CagMeasures {
  double area;      // the sum of the gray values
  double center[2]; // each of the lines x = center[0] and y = center[1] halves the area
  double centroid[2];
  double xx, yy, xy;      // divided by the area
  double least, greatest; // mean squared distances from the axes
  bool has_theta;
  double theta;     // the slope of the axis of least moment, in (-90, 90]; undefined if all axes
                    // have the same moment
  double roundness; // (xx + yy) / area; 1 / (2 pi) for a disk, more for all other shapes
  bool has_thinness;
  double thinness; // (greatest - least) / (xx + yy): 0 for a disk or square, 1 for a line
  bool has_direction;
  double direction;    // theta or its opposite: the one toward which the figure is longer, by the
                       // third moment along the axis; undefined if that is 0
  double perimeter;    // exact for what is made of pixels: sides between figure and background
  bool of_pixels;      // whether chain_length and touches_border are set
  double chain_length; // of the outer contours through the centers of the pixels
  double r_min, r_max; // distances of the boundary from the centroid; with CAG_MASS_POINT, those of
                       // the centers of the pixels at the boundary
  long holes, euler;   // euler: number of regions minus number of holes
  bool touches_border; // whether pixels of the figure lie at the border of the image
} CagMeasures;

// Measures the entire figure (label 0) or one region, with the gray values of channel 0 as weights,
// in time linear in its pixels. Fails with "empty-image" if the figure has no pixels.
CagStatus cag_measure_figure(const CagRaster *r, const CagLabels *l, size_t label, CagMass mass,
                             CagMeasures *out, CagError *err);

// Sets what follows from area, xx, yy, and xy, and the direction from the third central moments
// divided by the area: those of x^3, x^2 y, x y^2, y^3.
void cag_measures_derive(CagMeasures *m, const double third[4]);

#endif
