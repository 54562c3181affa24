// Boundaries that are made by hand, for tests without cag-brep: a cylinder that stands on z = 0,
// whose wall is any of the carriers that can be one.

#ifndef CAG_TESTS_GEOM_BOUNDARY_SUPPORT_H
#define CAG_TESTS_GEOM_BOUNDARY_SUPPORT_H

#include "base/memory.h"
#include "geom/boundary/boundary.h"
#include "geom/surface/reshape.h"
#include "tests/geom/support.h"

#define WALL_RADIUS 2.0
#define WALL_HEIGHT 5.0

static inline CagCurve *straight_trace(double t0, double t1, double u0, double v0, double u1,
                                       double v1) {
  const CagVec3 ends[2] = {{u0, v0, 0}, {u1, v1, 0}};
  const double knots[4] = {t0, t0, t1, t1};
  CagCurve *c;
  OK(cag_curve_nurbs(ends, NULL, 2, 1, knots, 2, &c, &err));
  return c;
}

// A circle about Z at this height; dimension 2: in the parameters of a plane.
static inline CagCurve *circle_at(double z, int dimension, bool spline) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c, *exact;
  frame.m[2][3] = z;
  frame.planar = dimension == 2;
  OK(cag_curve_arc(WALL_RADIUS, WALL_RADIUS, 0, 2 * M_PI, &frame, &c, &err));
  if (!spline) return c;
  OK(cag_curve_to_nurbs(c, &exact, &err));
  cag_curve_release(c);
  return exact;
}

static inline CagCarrier wall_carrier(CagCarrierKind kind, const CagCurve *base,
                                      const CagCurve *seam) {
  CagCarrier c = {.kind = kind, .frame = cag_transform_identity(), .a = WALL_RADIUS};
  CagSurface *s;
  c.frame.planar = false;
  if (kind == CAG_CARRIER_EXTRUDED) c.profile = cag_curve_retain(base);
  if (kind == CAG_CARRIER_REVOLVED) c.profile = cag_curve_retain(seam);
  if (kind != CAG_CARRIER_SPLINE) return c;
  OK(cag_surface_extrude(base, cag_vec3(0, 0, WALL_HEIGHT), 0, 1, &s, &err));
  OK(cag_surface_to_nurbs(s, &c.spline, &err));
  cag_surface_release(s);
  return c;
}

static inline CagBoundaryFace cap_face(double z, bool reversed, size_t loop) {
  CagBoundaryFace f = {.carrier = {.kind = CAG_CARRIER_PLANE, .frame = cag_transform_identity()},
                       .reversed = reversed,
                       .domain = {-WALL_RADIUS, WALL_RADIUS, -WALL_RADIUS, WALL_RADIUS},
                       .first = loop,
                       .count = 1};
  f.carrier.frame.planar = false;
  f.carrier.frame.m[2][3] = z;
  return f;
}

// Edges 0 and 1 are the circles at the bottom and the top, edge 2 is the seam; the faces are the
// wall, the top, and the bottom.
static inline CagBoundary cylinder_boundary(CagCarrierKind kind) {
  const bool spline = kind == CAG_CARRIER_SPLINE;
  const double h = WALL_HEIGHT, r = WALL_RADIUS;
  CagCurve *base = circle_at(0, 3, spline), *top = circle_at(h, 3, spline), *seam;
  const CagVec3 ends[2] = {{r, 0, 0}, {r, 0, h}};
  const double knots[4] = {0, 0, h, h}, u0 = base->start, u1 = base->end, v1 = spline ? 1 : h;
  OK(cag_curve_nurbs(ends, NULL, 2, 1, knots, 3, &seam, &err));
  CagBoundary b = {.corner_count = 2,
                   .edge_count = 3,
                   .use_count = 6,
                   .loop_count = 3,
                   .face_count = 3,
                   .shell_count = 1,
                   .order_count = 3};
  b.corners = cag_calloc(2, sizeof *b.corners);
  b.edges = cag_calloc(3, sizeof *b.edges);
  b.uses = cag_calloc(6, sizeof *b.uses);
  b.loops = cag_calloc(3, sizeof *b.loops);
  b.faces = cag_calloc(3, sizeof *b.faces);
  b.shells = cag_calloc(1, sizeof *b.shells);
  b.order = cag_calloc(3, sizeof *b.order);
  b.corners[0] = ends[0];
  b.corners[1] = ends[1];
  b.edges[0] = (CagBoundaryEdge){base, 0, 0, 0};
  b.edges[1] = (CagBoundaryEdge){top, 1, 1, 0};
  b.edges[2] = (CagBoundaryEdge){seam, 0, 1, 0};
  b.uses[0] = (CagBoundaryUse){0, false, straight_trace(u0, u1, u0, 0, u1, 0)};
  b.uses[1] = (CagBoundaryUse){2, false, straight_trace(0, h, u1, 0, u1, v1)};
  b.uses[2] = (CagBoundaryUse){1, true, straight_trace(u0, u1, u0, v1, u1, v1)};
  b.uses[3] = (CagBoundaryUse){2, true, straight_trace(0, h, u0, 0, u0, v1)};
  b.uses[4] = (CagBoundaryUse){1, false, circle_at(0, 2, spline)};
  b.uses[5] = (CagBoundaryUse){0, true, circle_at(0, 2, spline)};
  b.loops[0] = (CagBoundaryLoop){0, 4};
  b.loops[1] = (CagBoundaryLoop){4, 1};
  b.loops[2] = (CagBoundaryLoop){5, 1};
  b.faces[0] = (CagBoundaryFace){
      .carrier = wall_carrier(kind, base, seam), .domain = {u0, u1, 0, v1}, .first = 0, .count = 1};
  b.faces[1] = cap_face(h, false, 1);
  b.faces[2] = cap_face(0, true, 2);
  b.shells[0] = (CagBoundaryShell){0, 3};
  for (size_t i = 0; i < 3; i++) b.order[i] = i;
  b.volume = M_PI * r * r * h;
  b.area = 2 * M_PI * r * (r + h);
  b.centroid = cag_vec3(0, 0, h / 2);
  return b;
}

#endif
