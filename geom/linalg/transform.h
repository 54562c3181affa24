// 4x4 homogeneous transforms on column vectors: constructors, composition, and decomposition.
//
// Angles are radians. m[row][column]. `planar`: made from 2-D data only, so plane objects stay
// plane under it. `in_front`: a perspective, which has images only of points with w > 0; products
// and inverses keep this.

#ifndef CAG_GEOM_TRANSFORM_H
#define CAG_GEOM_TRANSFORM_H

#include "base/digest.h"
#include "base/status.h"
#include "geom/linalg/vec.h"

typedef struct CagTransform {
  double m[4][4];
  bool planar, in_front;
} CagTransform;

// Sine and cosine of an angle in radians, exact (0, +-1/2, +-1 ...) if the angle is the double
// nearest to a multiple of pi/12.
void cag_sincos(double angle, double *sine, double *cosine);

CagTransform cag_transform_identity(void); // planar
CagTransform cag_transform_multiply(const CagTransform *a,
                                    const CagTransform *b); // applies b first
// Image of a point, divided by w (infinite coordinates for a point at infinity); image of a vector
// (not translated).
CagVec3 cag_transform_point(const CagTransform *t, CagVec3 p);
CagVec3 cag_transform_vector(const CagTransform *t, CagVec3 v);
// Replaces derivatives 0..order of a moving point by those of its image, using homogeneous
// coordinates and the quotient rule. Returns false if the image is at infinity.
#define CAG_TRANSFORM_ORDER 16
bool cag_transform_derivatives(const CagTransform *t, int order, CagVec3 *d);
void cag_transform_homogeneous(const CagTransform *t, const double h[4], double out[4]);
CagStatus cag_transform_inverse(const CagTransform *t, CagTransform *out,
                                CagError *err);          // fails: "singular-transform"
double cag_transform_determinant(const CagTransform *t); // of the 4x4
bool cag_transform_is_affine(const CagTransform *t);     // last row is [0 0 0 w]
bool cag_transform_is_similarity(
    const CagTransform *t, double *scale); // uniform scale, with or without reflection, exactly or
                                           // to rounding
// An upper bound of how much an affine transform lengthens; the scale of a similarity.
double cag_transform_stretch(const CagTransform *t);
bool cag_transform_mirrors(const CagTransform *t); // determinant of the linear part < 0

CagTransform cag_translate(CagVec3 v);
// Rotation by `angle` (right-hand rule) about the axis through the point `about`. Fails for a zero
// axis.
CagStatus cag_rotate(CagVec3 axis, double angle, CagVec3 about, CagTransform *out, CagError *err);
CagStatus cag_scale(CagVec3 factors, CagVec3 about, CagTransform *out, CagError *err);
CagStatus cag_reflect(CagVec3 normal, CagVec3 through, CagTransform *out, CagError *err);
CagStatus cag_reflect_line(CagVec3 p, CagVec3 q, CagTransform *out,
                           CagError *err); // line in the XY plane
CagTransform cag_reflect_point(CagVec3 p);
// The image in the plane z = 0 from the center z = -f; x and y are divided by 1 + z/f. With
// keep_depth, the image has z f / (f + z) as its depth, which increases with z.
CagStatus cag_perspective(double f, bool keep_depth, CagTransform *out, CagError *err);
CagTransform cag_shear(double xy, double xz, double yx, double yz, double zx, double zy);

// A plane: point and unit normal; row is [a b c d] with a x + b y + c z + d = 0 and unit [a b c].
typedef struct CagPlane {
  CagVec3 point, normal;
} CagPlane;
CagStatus cag_plane(CagVec3 point, CagVec3 normal, CagPlane *out, CagError *err);
CagStatus cag_plane_through(CagVec3 p, CagVec3 q, CagVec3 r, CagPlane *out, CagError *err);
CagStatus cag_plane_from_row(const double row[4], CagPlane *out, CagError *err);
void cag_plane_row(const CagPlane *p, double row[4]);
CagStatus cag_plane_transform(const CagPlane *p, const CagTransform *t, CagPlane *out,
                              CagError *err);

CagStatus cag_project_parallel(const CagPlane *onto, CagVec3 along, CagTransform *out,
                               CagError *err); // along zero: perpendicular to the plane
CagStatus cag_project_central(const CagPlane *onto, CagVec3 from, CagTransform *out, CagError *err);
CagStatus cag_axes(CagVec3 origin, CagVec3 x, CagVec3 y, CagTransform *out,
                   CagError *err); // orthonormal: y is made perpendicular to x
CagStatus cag_look_at(CagVec3 from, CagVec3 to, CagVec3 up, CagTransform *out, CagError *err);
// Rotations about the moving axes named by `order` ("zyx", "zyz" ...: all 12).
CagStatus cag_euler(double a, double b, double c, const char *order, CagTransform *out,
                    CagError *err);
CagTransform cag_rpy(double roll, double pitch, double yaw);
CagStatus cag_quaternion(const double wxyz[4], CagTransform *out,
                         CagError *err); // normalized; zero fails
CagTransform cag_dh(double theta, double d, double a, double alpha);
CagTransform cag_mdh(double theta, double d, double a, double alpha);

// The inverses of these; `singular` is set at gimbal lock, and the documented branch is chosen (c =
// 0, or yaw = 0).
CagStatus cag_euler_of(const CagTransform *t, const char *order, double abc[3], bool *singular,
                       CagError *err);
CagStatus cag_rpy_of(const CagTransform *t, double rpy[3], bool *singular, CagError *err);
CagStatus cag_axis_angle_of(const CagTransform *t, CagVec3 *axis, double *angle, bool *singular,
                            CagError *err);
CagStatus cag_quaternion_of(const CagTransform *t, double wxyz[4], CagError *err); // w >= 0
// Slerp of the rotations, linear interpolation of the positions; both must be rigid.
CagStatus cag_transform_mix(const CagTransform *a, const CagTransform *b, double t,
                            CagTransform *out, CagError *err);
// The transform that maps points to images: 2 (similarity) or 3 (affine) pairs in the plane, 4
// (affine) in space, or 4 pairs in the plane (projective) if `planar`.
CagStatus cag_transform_from(const CagVec3 *points, const CagVec3 *images, size_t n, bool planar,
                             CagTransform *out, CagError *err);

typedef struct CagTransformClass {
  const char *name;  // "rigid" "mirror" "similarity" "affine" "projective"
  double scale;      // of a similarity, else 1
  bool has_rotation; // axis and angle are set
  CagVec3 axis;
  double angle;
  const char *fixed; // "all" "plane" "line" "point" "none"
  CagVec3 fixed_point,
      fixed_direction; // a point of the fixed set; direction of a fixed line, normal of a fixed
                       // plane
} CagTransformClass;
CagStatus cag_transform_classify(const CagTransform *t, CagTransformClass *out, CagError *err);

// Tests whether the map is a rotation and a translation, to CAG_PARALLEL.
bool cag_transform_is_rigid(const CagTransform *t);
// Add the coordinates of points, and the map, to a digest.
void cag_vec3s_digest(const CagVec3 *points, size_t n, CagDigest *d);
void cag_transform_digest(const CagTransform *t, CagDigest *d);

#endif
