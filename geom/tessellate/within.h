// Tessellation of the part of a surface within given loops of points.

#ifndef CAG_GEOM_TESSELLATE_WITHIN_H
#define CAG_GEOM_TESSELLATE_WITHIN_H

#include "geom/tessellate/tessellate.h"

// Closed loops of points: outer ones counter-clockwise in the parameter plane, holes clockwise. A
// loop does not repeat its first point.
typedef struct CagLoopPoints {
  const size_t *counts; // of points, by loops; the caller's
  size_t loops;
  size_t count, room;
  double *uv; // 2 per point
  CagVec3 *positions;
  uint32_t *points; // equal for entries that are one point of space, at seams and poles
  // Pairs of points, the lower one first, in ascending order: no edge within the outline may join
  // them. The caller's.
  const uint32_t (*apart)[2];
  size_t apart_count;
} CagLoopPoints;

void cag_loop_points_free(CagLoopPoints *o);
CagStatus cag_loop_points_add(CagLoopPoints *o, double u, double v, CagVec3 position,
                              uint32_t point, CagError *err);
// Fails if the triangles of an outline alone exceed the limit.
CagStatus cag_loop_points_check(const CagLoopPoints *o, const CagTessellation *how, CagError *err);

// Number of parts of a chord of a curve in the parameters, of this length in space, such that the
// normal turns by at most the angle along each part that is not short.
CagStatus cag_loop_points_parts(const CagSurface *s, const CagCurve *trace, double from, double to,
                                double length, const CagTessellation *how, size_t *parts,
                                CagError *err);

// The part of a surface within an outline; box: u0 u1 v0 v1 around it. The first vertices of the
// mesh are the outline's, in order, and its edges are not divided, so that surfaces on both sides
// can share them. `weld` unites vertices with equal points. The tolerance must be positive. Fails
// with "polygon-self-intersection" if the loops cross.
CagStatus cag_within_tessellate(const CagSurface *s, const double box[4], const CagLoopPoints *o,
                                const CagTessellation *how, CagMesh **out, CagError *err);

#endif
