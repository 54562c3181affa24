// What rays can be cast at: surfaces, meshes, and solids.
//
// A caster is made once for a shape and asked many times, by several threads at once. Formulas of a
// script can be evaluated by its own thread only: on others, queries that need them fail (see
// base/parallel.h). Distances are exact to about 1e-12 of the size of the shape: quadrics and planes
// are solved directly, other surfaces by Newton's method, and set operations by the intervals in
// which a ray is inside of their operands (Roth 1982). A ray that meets a common edge of faces
// crosses them once.

#ifndef CAG_GEOM_RAY_CASTER_H
#define CAG_GEOM_RAY_CASTER_H

#include "geom/ray/ray.h"
#include "geom/solid/solid.h"

typedef struct CagCaster CagCaster;

CagStatus cag_caster_of_solid(const CagSolid *s, CagCaster **out, CagError *err);
CagStatus cag_caster_of_surface(const CagSurface *s, CagCaster **out, CagError *err);
CagStatus cag_caster_of_mesh(const CagMesh *m, CagCaster **out, CagError *err);
void cag_caster_free(CagCaster *c); // c may be NULL

// Whether it has an inside: a solid or closed mesh.
bool cag_caster_is_closed(const CagCaster *c);
// Bounds that contain the shape; infinite if it is unbounded.
CagBounds cag_caster_bounds(const CagCaster *c);

// Finds the first crossing of the ray. *met is false if there is none. `work` is a list whose memory
// is reused from call to call; start with {0} and free it at the end.
CagStatus cag_caster_first(const CagCaster *c, const CagRay *ray, CagCrossings *work,
                           CagCrossing *out, bool *met, CagError *err);
// Finds all crossings in ascending order. For a solid their signs alternate; *inside, unless NULL,
// is whether it is inside at the start of the ray.
CagStatus cag_caster_all(const CagCaster *c, const CagRay *ray, CagCrossings *out, bool *inside,
                         CagError *err);
// The side of a solid's or closed mesh's boundary that p is on: -1 inside, 1 outside, 0 within
// `slack` of it.
CagStatus cag_caster_side(const CagCaster *c, CagVec3 p, double slack, CagCrossings *work,
                          int *side, CagError *err);

#endif
