// Rigid motions: the best one for pairs of points, nearest rotations, twists, and frames.
//
// A twist [v, w] is the logarithm of a rigid motion: w is the axis times the angle in radians, and v
// is the velocity of the point at the origin of a constant motion that takes one unit of time.

#ifndef CAG_GEOM_RIGID_H
#define CAG_GEOM_RIGID_H

#include "geom/linalg/transform.h"

typedef struct CagMotionFit {
  CagTransform transform;
  double scale;        // 1 unless it was to be found
  double rms, largest; // distances between moved points and images
} CagMotionFit;

// The rotation and translation, and with `scale` the uniform scale, that minimize the sum of the
// squared distances between the moved points and their images (Kabsch 1976; Umeyama 1991). Never a
// reflection. `planar`: all points have z = 0, and the motion stays in the plane. Fails with
// "too-few-points" (2 in the plane, 3 in space), "coincident-points", and "collinear-points" if the
// rotation is not unique.
CagStatus cag_best_motion(const CagVec3 *points, const CagVec3 *images, size_t n, bool planar,
                          bool scale, CagMotionFit *out, CagError *err);

// The orthonormal matrix nearest to the linear part of an affine transform, with the same position:
// a rotation, or a rotation and a reflection if the transform mirrors. Fails with "not-rigid" if the
// transform is projective, and with "singular-transform".
CagStatus cag_orthonormal(const CagTransform *t, CagTransform *out, CagError *err);

// The rotation that minimizes the sum of the squared Frobenius distances to the rotations of n rigid
// transforms (the chordal mean). Fails with "not-rigid" and the index, and with "underdetermined" if
// several rotations are equally near.
CagStatus cag_mean_rotation(const CagTransform *t, size_t n, CagTransform *out, CagError *err);

// The twist of a rigid motion, with an angle of at most pi, and its inverse for any twist. Fails
// with "not-rigid" and "not-finite".
CagStatus cag_twist_of(const CagTransform *t, double twist[6], CagError *err);
CagStatus cag_motion_of(const double twist[6], CagTransform *out, CagError *err);

// The rotation by the smallest angle that turns one direction into another, neither of which is 0.
// Between opposite directions, it is a half turn about the direction perpendicular to them that is
// nearest to z, or about x if they are vertical.
CagTransform cag_rotation_between(CagVec3 from, CagVec3 to);
// What becomes of a rigid frame if an affine map moves the space: x follows the map, z stays
// perpendicular to the image of the xy plane and on the side of the image of z, and y completes a
// right-handed frame. Returns false if there is no such frame: the map is projective or singular.
bool cag_frame_image(const CagTransform *map, const CagTransform *frame, CagTransform *out);

#endif
