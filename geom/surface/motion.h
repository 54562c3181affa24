// Motions: a frame carried along a path, or any affine map that depends on one parameter.
//
// A motion gives an origin and three spokes for every t, and a swept surface is
// S(u, v) = origin(v) + x(u) X(v) + y(u) Y(v) + z(u) Z(v). Along a path the spokes are the frame's
// normal, binormal and tangent, turned by the twist and lengthened by the scale. The frame is
// rotation minimizing (that to which the double reflection of Wang et al. (2008) converges), the
// one of Frenet, the one of the start kept as it is, or the one whose y axis is nearest to a given
// direction.

#ifndef CAG_GEOM_MOTION_H
#define CAG_GEOM_MOTION_H

#include "geom/basis/chebyshev.h"
#include "geom/surface/surface.h"

typedef enum CagOrient {
  CAG_ORIENT_RMF,
  CAG_ORIENT_FRENET,
  CAG_ORIENT_FIXED,
  CAG_ORIENT_UP
} CagOrient;

// A number along the path: from `start` to `end`, linear in the parameter, or a function of it.
typedef struct CagAlong {
  double start, end;
  const CagChebyshev *function; // of one part; NULL: linear
} CagAlong;

typedef struct CagPathMotion {
  CagOrient orient;
  CagVec3 up;     // of CAG_ORIENT_UP
  CagAlong twist; // radians
  CagAlong scale;
} CagPathMotion;

#define CAG_MOTION_ORDER (CAG_MAX_PARTIAL + 1)
// Taylor coefficients about a parameter.
typedef struct CagMotionSeries {
  CagVec3 origin[CAG_MOTION_ORDER], x[CAG_MOTION_ORDER], y[CAG_MOTION_ORDER], z[CAG_MOTION_ORDER];
} CagMotionSeries;

typedef struct CagMotion CagMotion;

// Fails with "zero-tangent", "path-turns-back", "path-straight" (Frenet), "path-along-up",
// "path-corner" and "scale-negative".
CagStatus cag_motion_along(const CagCurve *path, const CagPathMotion *how, CagMotion **out,
                           CagError *err);
// The map of the upper three rows of a matrix, 12 parts in row order, over [a, b].
CagStatus cag_motion_affine(const CagChebyshev *rows, double a, double b, bool angular,
                            CagMotion **out, CagError *err);
CagMotion *cag_motion_retain(const CagMotion *m);
void cag_motion_release(CagMotion *m);

CagStatus cag_motion_at(const CagMotion *m, double t, int n, CagSide side, CagMotionSeries *out,
                        CagError *err);
void cag_motion_domain(const CagMotion *m, double *start, double *end, bool *angular);
size_t cag_motion_breaks(const CagMotion *m, double *out, size_t capacity);
const CagCurve *cag_motion_path(const CagMotion *m); // NULL: of maps
const CagPathMotion *cag_motion_how(const CagMotion *m);
bool cag_motion_is_plain(const CagMotion *m); // along a path, without twist, not scaled
// The path has a corner where the spokes are mitered, so that only plane sections fit together.
bool cag_motion_has_corner(const CagMotion *m);
// The frame at t as a matrix.
CagStatus cag_motion_frame(const CagMotion *m, double t, CagTransform *out, CagError *err);

#endif
