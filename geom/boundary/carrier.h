// Carriers of faces: points, derivatives, and the edges of faces in their parameters.
//
// The traces of the kernel are approximations on curved carriers. On carriers with closed forms,
// the parameters of an edge are therefore those of its curve in space, unless its trace is a line.

#ifndef CAG_GEOM_BOUNDARY_CARRIER_H
#define CAG_GEOM_BOUNDARY_CARRIER_H

#include "geom/boundary/boundary.h"

typedef struct CagCarrierPoint {
  CagVec3 point, du, dv; // S, S_u, S_v
} CagCarrierPoint;

// A column of a frame: 0 to 2 are x, y, and z, 3 is the origin.
static inline CagVec3 cag_frame_column(const CagTransform *t, int k) {
  return cag_vec3(t->m[0][k], t->m[1][k], t->m[2][k]);
}

// The parameters of splines are moved into their domain.
CagStatus cag_carrier_eval(const CagCarrier *c, double u, double v, CagCarrierPoint *out,
                           CagError *err);
// The unit vector along S_u x S_v; zero where there is none.
CagStatus cag_carrier_normal(const CagCarrier *c, double u, double v, CagVec3 *out, CagError *err);
// The name of its kind: "plane" "cylinder" "cone" "sphere" "torus" "spline" "revolved" "extruded".
const char *cag_carrier_name(const CagCarrier *c);
// Whether the carrier is a plane, cylinder, cone, sphere, or torus.
bool cag_carrier_is_analytic(const CagCarrier *c);
// The apex of a cone; false for other kinds.
bool cag_carrier_apex(const CagCarrier *c, CagVec3 *out);
// Whether u (direction 0) or v (1) is an angle, with the period 2 pi.
bool cag_carrier_is_periodic(const CagCarrier *c, int direction);
// Breaks of the carrier along u (direction 0) or v (1), as for surfaces: writes up to `capacity`,
// returns their number.
size_t cag_carrier_breaks(const CagCarrier *c, int direction, double *out, size_t capacity);
// A straight generator of a plane, cylinder, cone, or extruded carrier: S(u, v) is `at` + v
// `along`, S_u is `at_u` + v `along_u`.
typedef struct CagGenerator {
  CagVec3 at, along, at_u, along_u;
} CagGenerator;
bool cag_carrier_is_ruled(const CagCarrier *c);
CagStatus cag_carrier_generator(const CagCarrier *c, double u, CagGenerator *out, CagError *err);

// The parameters of the point of an analytic carrier that is nearest to p, with the angles nearest
// to those of `near`. On the axis, u is that of `near`.
void cag_carrier_parameters(const CagCarrier *c, CagVec3 p, const double near[2], double out[2]);

// An edge in the parameters of a face, with the parameter of its curve.
typedef struct CagEdgePath {
  const CagCarrier *carrier;
  const CagCurve *curve, *trace; // curve: NULL if the trace is used
  double start, end;
  bool reversed; // the face uses the edge from the end to the start
  bool straight; // the trace is the line at + t along, which is exact
  double at[2], along[2];
} CagEdgePath;

// Fails with "no-boundary" if the edge has neither a trace nor a curve on an analytic carrier.
CagStatus cag_edge_path(const CagBoundary *b, const CagBoundaryFace *f, const CagBoundaryUse *use,
                        CagEdgePath *out, CagError *err);
// u, v, and their derivatives by t. `rates` may be NULL.
CagStatus cag_edge_path_eval(const CagEdgePath *p, double t, double uv[2], double rates[2],
                             CagError *err);

#endif
