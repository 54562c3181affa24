// Positions from measurements: bearings and distances of known marks, and joints of workpieces in
// profiles.

#ifndef CAG_GEOM_CAMERA_LOCATE_H
#define CAG_GEOM_CAMERA_LOCATE_H

#include "geom/linalg/transform.h"

// The point of the plane from which the marks are seen in these directions (radians,
// counterclockwise from x): the one with the least sum of squared distances from the lines of
// sight. Fails with "bearings-parallel".
CagStatus cag_locate_by_bearings(const CagVec3 *marks, const double *bearings, size_t n,
                                 CagVec3 *out, CagError *err);

// The point at these distances from the marks, in the plane (`dimension` 2, at least 3 marks) or in
// space (3, at least 4 marks). The squared equations of the spheres minus their mean are linear;
// they are solved by least squares. Fails with "landmarks-collinear" if the marks are on one line
// (in space: in one plane).
CagStatus cag_locate_by_ranges(const CagVec3 *marks, const double *ranges, size_t n, int dimension,
                               CagVec3 *out, CagError *err);

// A sample of a profile: height z at the position y, or no return (z is NaN). y is NaN if the
// position is unknown; samples with a return have one, and are in order.
typedef struct CagProfileSample {
  double y, z;
} CagProfileSample;

typedef enum CagSeamKind {
  CAG_SEAM_FILLET, // two faces that meet: the intersection of two fitted lines
  CAG_SEAM_LAP,    // a step: the middle of the largest one
  CAG_SEAM_BUTT    // a gap: the middle of the widest run without returns
} CagSeamKind;

typedef struct CagSeam {
  double y, z;
  double step;                // LAP
  double gap_least, gap_most; // BUTT: the width of the gap is between them
} CagSeam;

// Finds the joint in a profile. `limit`: a step that is not higher does not count. Fails with
// "no-seam".
CagStatus cag_find_seam(const CagProfileSample *samples, size_t n, CagSeamKind kind, double limit,
                        CagSeam *out, CagError *err);

#endif
