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
  CAG_QUADRIC_COINCIDENT_PLANES
} CagQuadricClass;

typedef struct CagQuadricForm {
  CagQuadricClass class_id;
  const char *name;   // as the reference's table names it (06a, 6.4)
  CagTransform frame; // canonical frame: rigid, right-handed; canonical coordinates -> world
  double semi[3]; // semi-axes a, b, c (or the focal parameters of paraboloids) as in the reference;
                  // 0 where there is none
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
// patches in world coordinates: one sheet, two sheets or planes; each a CagSurface of kind
// "quadric" (or planar), cut exactly at the box's z range in the canonical direction where
// `z_only`, else at the box. *out is a malloc'd array of *n surfaces. An imaginary one has none
// ("quadric-imaginary").
CagStatus cag_quadric_patches(const CagQuadric *q, const CagBounds *within, bool z_only,
                              CagSurface ***out, size_t *n, CagError *err);
// The equation behind a surface of kind "quadric"; false: another kind.
bool cag_surface_quadric_view(const CagSurface *s, CagQuadric *equation);

#endif
