// Motions: a frame carried along a path, or any affine map that depends on one parameter.
//
// A motion has an origin and three axis vectors for every t; the swept surface is
// S(u, v) = origin(v) + x(u) X(v) + y(u) Y(v) + z(u) Z(v). Along a path the axes are the frame's
// normal, binormal, and tangent, rotated by the twist and multiplied by the scale. The frame is
// rotation minimizing (the limit of the double reflection of Wang et al. (2008)), the Frenet frame,
// the fixed frame of the start, or the frame whose y axis is nearest to a given direction.

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

// A number that varies along the path: linear from `start` to `end` in the parameter, or a function
// of it.
typedef struct CagAlong {
  double start, end;
  const CagChebyshev *function; // a function with one part; NULL: linear
} CagAlong;

typedef struct CagPathMotion {
  CagOrient orient;
  CagVec3 up;     // for CAG_ORIENT_UP
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
// The affine map with the upper three rows of a matrix, 12 parts in row order, over [a, b].
CagStatus cag_motion_affine(const CagChebyshev *rows, double a, double b, bool angular,
                            CagMotion **out, CagError *err);
CagMotion *cag_motion_retain(const CagMotion *m);
void cag_motion_release(CagMotion *m);
void cag_motion_digest(const CagMotion *m, CagDigest *d);

CagStatus cag_motion_at(const CagMotion *m, double t, int n, CagSide side, CagMotionSeries *out,
                        CagError *err);
void cag_motion_domain(const CagMotion *m, double *start, double *end, bool *angular);
size_t cag_motion_breaks(const CagMotion *m, double *out, size_t capacity);
const CagCurve *cag_motion_path(const CagMotion *m); // NULL for an affine map
const CagPathMotion *cag_motion_how(const CagMotion *m);
bool cag_motion_is_plain(const CagMotion *m); // along a path, without twist or scale
// Whether the path has a mitered corner, at which only plane sections fit together.
bool cag_motion_has_corner(const CagMotion *m);
// The frame at t as a matrix.
CagStatus cag_motion_frame(const CagMotion *m, double t, CagTransform *out, CagError *err);

#endif
