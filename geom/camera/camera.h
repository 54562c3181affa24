// Cameras that measure: the map from points of space to pixels, and back to lines of sight.
//
// A camera is a 3x4 matrix P: (U, V, w) = P (X, Y, Z, 1), and the pixel is (U/w, V/w). Pixels are
// measured from the upper left corner of the picture, u right and v down, so the center of the pixel
// in column c and row r is (c + 1/2, r + 1/2). The third row of P is scaled such that its direction
// part is a unit vector, the view direction; w is then the distance from the plane through the
// center of projection, and points in front have w > 0. The third row of a parallel projection is
// 0 0 0 1.
//
// Split, P = K [R | -R c]: K is upper triangular with a positive diagonal (in pixels), the rows of R
// are the camera's axes (right, down, forward) in the world, and c is the center of projection. R is
// a reflection if the picture is mirrored. Of a parallel projection, the pixel is
// K (R1 X, R2 X, 1) with the first two rows of R.

#ifndef CAG_GEOM_CAMERA_H
#define CAG_GEOM_CAMERA_H

#include "geom/linalg/transform.h"

typedef struct CagCameraMap {
  double p[3][4];
  double inverse[3][3]; // of the left part of P; of a parallel projection, of its first two rows
                        // above the view direction
  CagVec3 center;       // of projection; unused if parallel
  CagVec3 view;         // unit view direction
  bool parallel;
  bool has_depth; // a parallel projection given by P alone does not tell what is in front
  double start;   // the depth is w - start; of parallel projections view . X - start
} CagCameraMap;

// Makes the map of a matrix that is given up to a positive factor. The depth is the distance from
// the plane through the center. Fails with "camera-singular".
CagStatus cag_camera_map(const double rows[3][4], CagCameraMap *out, CagError *err);

typedef struct CagCameraParts {
  double k[3][3];
  double r[3][3];
} CagCameraParts;

// Makes the map from its parts. `eye` is the center of projection, or, of a parallel projection, a
// point that is imaged at (k02, k12), in the plane of depth 0. A point of a central projection has
// depth 0 at the distance `start` from the center.
CagStatus cag_camera_map_of_parts(const CagCameraParts *parts, CagVec3 eye, bool parallel,
                                  double start, CagCameraMap *out, CagError *err);

// Splits P into K and R by Gram-Schmidt from the last row (RQ decomposition).
void cag_camera_split(const CagCameraMap *c, CagCameraParts *out);

// Projects a point. Returns false if it is not in front of the camera. *depth is set if the camera
// has one.
bool cag_camera_project(const CagCameraMap *c, CagVec3 point, double pixel[2], double *depth);

// The line of sight of a pixel, with a unit direction. It starts in the center of projection, or, of
// a parallel projection, in the plane of depth 0 (without depth: the plane through the origin of the
// world that is perpendicular to the view direction).
void cag_camera_sight(const CagCameraMap *c, const double pixel[2], CagVec3 *origin,
                      CagVec3 *direction);

// The point of a plane that a pixel shows. Returns false if the line of sight is parallel to the
// plane, or meets it behind the camera.
bool cag_camera_on_plane(const CagCameraMap *c, const double pixel[2], const CagPlane *plane,
                         CagVec3 *out);

// The middle of the shortest segment between two lines, and its length (Goldman 1990, "Intersection
// of two lines in three-space"). Directions have any length. Fails with "parallel-lines".
CagStatus cag_stereo_point(const CagVec3 origins[2], const CagVec3 directions[2], CagVec3 *point,
                           double *gap, CagError *err);

#endif
