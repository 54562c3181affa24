// Fits of the map from a model to its picture, and of cameras (calibration).
//
// The points of the model are in space, those of the picture in the plane: (U, V, w) = H (X, Y, Z, 1)
// with 3x4 rows H, and the picture of the point is (U/w, V/w).

#ifndef CAG_GEOM_MODEL_FIT_H
#define CAG_GEOM_MODEL_FIT_H

#include "geom/camera/camera.h"

typedef struct CagModelFit {
  double rows[3][4];
  double error; // the sum of the distances in the picture
  double rms;   // the root of their mean square
} CagModelFit;

// The affine map with the least sum of squared distances in the picture; the last row is 0 0 0 1.
// Fails with "too-few-model-points" (fewer than 4) and "model-points-coplanar".
CagStatus cag_model_fit_affine(const CagVec3 *points, const CagVec3 *images, size_t n,
                               CagModelFit *out, CagError *err);

// The projective map by the direct linear transform with normalized points (Hartley and Zisserman
// 2004, algorithm 4.2 and section 7.1), exact for exact points. w = 1 for the first point. scales
// has the w of all points, n numbers.
// Fails with "too-few-model-points" (fewer than 6), "model-points-coplanar", and "model-ambiguous".
CagStatus cag_model_fit_projective(const CagVec3 *points, const CagVec3 *images, size_t n,
                                   CagModelFit *out, double *scales, CagError *err);

// The error of a map as in CagModelFit. Fails with "point-not-in-front" if the map sends a point to
// infinity.
CagStatus cag_model_error(const double rows[3][4], const CagVec3 *points, const CagVec3 *images,
                          size_t n, double *error, double *rms, CagError *err);

// The camera that sees the points at these pixels, by the projective fit; *rms is the root of the
// mean square of the distances in pixels. Most of the points are in front of the camera. Fails as
// the projective fit does, but with "calibration-points-coplanar".
CagStatus cag_calibrate(const CagVec3 *points, const CagVec3 *pixels, size_t n, CagCameraMap *out,
                        double *rms, CagError *err);

#endif
