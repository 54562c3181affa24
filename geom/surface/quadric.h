// Quadrics: the general equation of second degree, its class and canonical frame, and its real
// surface as parametric patches.

#ifndef CAG_GEOM_QUADRIC_H
#define CAG_GEOM_QUADRIC_H

#include "geom/surface/surface.h"

// a x^2 + b y^2 + c z^2 + d xy + e yz + f xz + g x + h y + j z + k = 0, in this order.
typedef struct CagQuadric {
  double c[10];
} CagQuadric;

typedef enum CagQuadricClass {
  CAG_QUADRIC_ELLIPSOID,
  CAG_QUADRIC_IMAGINARY_ELLIPSOID,
  CAG_QUADRIC_HYPERBOLOID_ONE,
  CAG_QUADRIC_HYPERBOLOID_TWO,
  CAG_QUADRIC_CONE,
  CAG_QUADRIC_IMAGINARY_CONE,
  CAG_QUADRIC_ELLIPTIC_PARABOLOID,
  CAG_QUADRIC_HYPERBOLIC_PARABOLOID,
  CAG_QUADRIC_ELLIPTIC_CYLINDER,
  CAG_QUADRIC_IMAGINARY_ELLIPTIC_CYLINDER,
  CAG_QUADRIC_HYPERBOLIC_CYLINDER,
  CAG_QUADRIC_PARABOLIC_CYLINDER,
  CAG_QUADRIC_INTERSECTING_PLANES,
  CAG_QUADRIC_IMAGINARY_INTERSECTING_PLANES,
  CAG_QUADRIC_PARALLEL_PLANES,
  CAG_QUADRIC_IMAGINARY_PARALLEL_PLANES,
  CAG_QUADRIC_COINCIDENT_PLANES,
  // Equations without terms of second degree, which are not among the 17 classes.
  CAG_QUADRIC_PLANE,
  CAG_QUADRIC_EMPTY
} CagQuadricClass;

typedef struct CagQuadricForm {
  CagQuadricClass class_id;
  const char *name;   // of the class (Beyer 1987, CRC Standard Mathematical Tables, quadrics)
  CagTransform frame; // canonical frame: rigid, right-handed; canonical coordinates -> world
  double semi[3];     // semi-axes a, b, c (or the focal parameters of paraboloids); 0: none
  bool has_center;
  CagVec3 center;
  int rank3, rank4; // of the 3x3 and the 4x4 matrix
} CagQuadricForm;

CagStatus cag_quadric_from_rows(const double rows[4][4], CagQuadric *out,
                                CagError *err); // symmetric part is taken
void cag_quadric_rows(const CagQuadric *q, double rows[4][4]);
CagStatus cag_quadric_classify(const CagQuadric *q, CagQuadricForm *out, CagError *err);
double cag_quadric_value(const CagQuadric *q, CagVec3 p);
CagStatus cag_quadric_transform(const CagQuadric *q, const CagTransform *t, CagQuadric *out,
                                CagError *err);

// The real surface within a box (unbounded classes need one: "quadric-unbounded"), as parametric
// patches in world coordinates: one sheet, two sheets, planes or strips; each a CagSurface of kind
// "quadric" (or planar). *out is a malloc'd array of *n surfaces. An imaginary quadric has none
// ("quadric-imaginary"), and neither does one that lies outside the box ("quadric-outside").
//
// Parts outside the box are cut off, along x, y, and z of the world. Planes, and pieces that end at
// constant parameters (a range along the axis, the rulings of a cylinder), are exact. Other pieces
// are patches trimmed by splines that are accurate to 1e-11 of the box's diagonal, or to the
// rounding of their coordinates if these are far larger. With `z_only`, the range is within->min.z
// to within->max.z along the world's z, whatever the direction of the axis. Quadrics that this
// range does not bound are "quadric-unbounded".
CagStatus cag_quadric_patches(const CagQuadric *q, const CagBounds *within, bool z_only,
                              CagSurface ***out, size_t *n, CagError *err);
// The equation behind a surface of kind "quadric"; false: another kind.
bool cag_surface_quadric_view(const CagSurface *s, CagQuadric *equation);
// The affine map from its unit form.
bool cag_surface_quadric_frame(const CagSurface *s, CagTransform *frame);

// The origin of a piece made by cag_quadric_patches, from which the body is built.
typedef struct CagQuadricWithin {
  CagBounds box; // the box, or the range of z
  bool z_only;
  CagTransform frame; // box to world; transforms of the pieces move it
  size_t pieces;      // number of pieces that belong together
  bool trimmed;       // whether this piece is trimmed
  bool negated;       // the caller's equation has the opposite sign of the stored one
} CagQuadricWithin;

// Gets the origin of a patch or a trimmed patch of cag_quadric_patches with a box or range. Returns
// false for another surface or a part of one.
bool cag_surface_quadric_within(const CagSurface *s, CagQuadricWithin *out);

// The same piece with the other normal, and of the same kind: u runs backwards. For patches of kind
// "quadric", and these trimmed.
CagStatus cag_surface_quadric_turn(const CagSurface *s, CagSurface **out, CagError *err);

// Finds the extremes and saddles of a world coordinate (axis 0 to 2) inside the domain (u, v) of a
// surface of kind "quadric". Returns their number, which is 0 for another kind.
size_t cag_surface_quadric_extremes(const CagSurface *s, int axis, CagVec3 out[2]);

// The parametric forms of real quadrics, each in units
// of its semi-axes: they are the lengths of the frame's columns.
typedef enum CagQuadricShape {
  CAG_SHAPE_ELLIPSOID,             // [cos u sin v, sin u sin v, cos v]
  CAG_SHAPE_HYPERBOLOID_ONE,       // [cos u cosh v, sin u cosh v, sinh v]
  CAG_SHAPE_HYPERBOLOID_TWO,       // [cos u sinh v, sin u sinh v, cosh v]: one sheet
  CAG_SHAPE_CONE,                  // [v cos u, v sin u, v]
  CAG_SHAPE_ELLIPTIC_PARABOLOID,   // [v cos u, v sin u, v^2]
  CAG_SHAPE_HYPERBOLIC_PARABOLOID, // [u, v, u^2 - v^2]
  CAG_SHAPE_ELLIPTIC_CYLINDER,     // [cos u, sin u, v]
  CAG_SHAPE_PARABOLIC_CYLINDER,    // [u^2, 2 u, v]
  CAG_SHAPE_HYPERBOLIC_CYLINDER    // [cosh u, sinh u, v]: one branch
} CagQuadricShape;

// A piece over [u0, u1] x [v0, v1]; frame: affine, unit form -> world. Kind "quadric". A frame that
// mirrors turns the normals.
CagStatus cag_surface_quadric(CagQuadricShape shape, const CagTransform *frame, double u0,
                              double u1, double v0, double v1, CagSurface **out, CagError *err);

#endif
