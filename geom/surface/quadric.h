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
  // Equations without quadratic terms, which are not among the 17 classes.
  CAG_QUADRIC_PLANE,
  CAG_QUADRIC_EMPTY
} CagQuadricClass;

typedef struct CagQuadricForm {
  CagQuadricClass class_id;
  const char *name;   // name of the class (Beyer 1987, CRC Standard Mathematical Tables, quadrics)
  CagTransform frame; // canonical frame: rigid, right-handed; maps canonical to world coordinates
  double semi[3];     // semi-axes a, b, c (or the focal parameters of paraboloids); 0: unused
  bool has_center;
  CagVec3 center;
  int rank3, rank4; // of the 3x3 and the 4x4 matrix
} CagQuadricForm;

CagStatus cag_quadric_from_rows(const double rows[4][4], CagQuadric *out,
                                CagError *err); // uses the symmetric part
void cag_quadric_rows(const CagQuadric *q, double rows[4][4]);
CagStatus cag_quadric_classify(const CagQuadric *q, CagQuadricForm *out, CagError *err);
double cag_quadric_value(const CagQuadric *q, CagVec3 p);
CagStatus cag_quadric_transform(const CagQuadric *q, const CagTransform *t, CagQuadric *out,
                                CagError *err);

// The real surface within a box (required for unbounded classes: "quadric-unbounded") as parametric
// patches in world coordinates: one sheet, two sheets, planes, or strips; each a CagSurface of kind
// "quadric" (or planar). *out is a malloc'd array of *n surfaces. Fails with "quadric-imaginary" if
// there is no real surface, and with "quadric-outside" if it lies outside the box.
//
// Parts outside the box are cut off along the world's x, y, and z. Planes, and pieces that end at
// constant parameters (a range along the axis, the rulings of a cylinder), are exact. Other pieces
// are patches trimmed by splines that are accurate to 1e-11 of the box's diagonal, or to the
// rounding of their coordinates if these are far larger. With `z_only`, only the range from
// within->min.z to within->max.z along the world's z applies, whatever the direction of the axis;
// fails with "quadric-unbounded" if this does not bound the quadric.
CagStatus cag_quadric_patches(const CagQuadric *q, const CagBounds *within, bool z_only,
                              CagSurface ***out, size_t *n, CagError *err);
// The equation of a surface of kind "quadric"; false: another kind.
bool cag_surface_quadric_view(const CagSurface *s, CagQuadric *equation);
// The affine map from the unit form of the surface.
bool cag_surface_quadric_frame(const CagSurface *s, CagTransform *frame);

// How a piece was made by cag_quadric_patches, for building a solid from the pieces.
typedef struct CagQuadricWithin {
  CagBounds box; // the box, or the range of z
  bool z_only;
  CagTransform frame; // box to world; composed with transforms of the pieces
  size_t pieces;      // total number of pieces
  bool trimmed;       // whether this piece is trimmed
  bool negated;       // the caller's equation has the opposite sign of the stored one
} CagQuadricWithin;

// How a patch or trimmed patch was made by cag_quadric_patches with a box or range. Returns false
// for another surface or a part of one.
bool cag_surface_quadric_within(const CagSurface *s, CagQuadricWithin *out);

// The same piece, of the same kind, with the opposite normal: u is reversed. For patches of kind
// "quadric", trimmed or not.
CagStatus cag_surface_quadric_turn(const CagSurface *s, CagSurface **out, CagError *err);

// Finds the extrema and saddle points of a world coordinate (axis 0 to 2) inside the domain (u, v)
// of a surface of kind "quadric". Returns their number, which is 0 for another kind.
size_t cag_surface_quadric_extremes(const CagSurface *s, int axis, CagVec3 out[2]);

// The parametric forms of real quadrics, in units of the semi-axes, which are the lengths of the
// frame's columns.
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

// The parametric form of a surface of kind "quadric"; false: another kind.
bool cag_surface_quadric_shape(const CagSurface *s, CagQuadricShape *shape);

// A piece over [u0, u1] x [v0, v1]; frame: affine, unit form to world. Kind "quadric". A frame with
// a reflection reverses the normals.
CagStatus cag_surface_quadric(CagQuadricShape shape, const CagTransform *frame, double u0,
                              double u1, double v0, double v1, CagSurface **out, CagError *err);

#endif
