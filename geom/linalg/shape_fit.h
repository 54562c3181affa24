// Lines, planes, circles, ellipses, spheres, and cylinders nearest to points: the sum of the squared
// orthogonal distances is minimal.

#ifndef CAG_GEOM_SHAPE_FIT_H
#define CAG_GEOM_SHAPE_FIT_H

#include "geom/linalg/transform.h"

typedef enum CagFitShape {
  CAG_FIT_LINE,    // along z
  CAG_FIT_PLANE,   // z = 0
  CAG_FIT_CIRCLE,  // in the plane z = 0
  CAG_FIT_ELLIPSE, // in the plane z = 0, with the semi-axes a >= b along x and y
  CAG_FIT_SPHERE,
  CAG_FIT_CYLINDER, // about z
  CAG_FIT_SHAPES
} CagFitShape;

// The shape is described in the coordinates of its frame.
typedef struct CagShapeFit {
  CagTransform frame;
  double a, b;         // radius, or semi-axes
  double low, high;    // of a line or cylinder: the range of z of the points
  double rms, largest; // orthogonal distances
} CagShapeFit;

// Fits a shape to points. `planar`: all points have z = 0, and a line, circle, or ellipse stays in
// the plane.
//
// Lines and planes are found by singular values, the others by the method of Levenberg and Marquardt
// from algebraic fits; for cylinders, from several directions of the axis.
//
// Fails with "too-few-points", "coincident-points", "collinear-points", and "coplanar-points", with
// "underdetermined" if several shapes fit equally well, and with "convergence" if the best shape is
// of infinite size.
CagStatus cag_shape_fit(CagFitShape shape, const CagVec3 *points, size_t n, bool planar,
                        CagShapeFit *out, CagError *err);

// The fewest points that determine the shape.
size_t cag_shape_fit_least(CagFitShape shape, bool planar);

#endif
