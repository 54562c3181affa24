// Functions of the table of solids and meshes (solids.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_SOLIDS_H
#define CAG_INTERP_BUILTIN_SOLIDS_H

#include "geom/surface/quadric.h"
#include "interp/builtin/shapes.h"

// clang-format off
#define CAG_SOLID_FUNCTIONS(X) \
  /* solids_make.c */ \
  X(box) X(sphere) X(cylinder) X(cone) X(prism) X(rod) X(torus) X(solid) \
  /* solids_csg.c */ \
  X(union) X(difference) X(intersection) X(half_space) X(clip) X(is_empty) \
  /* solids_copies.c */ \
  X(around) X(rows) X(mirrored) \
  /* solids_measure.c */ \
  X(area) X(volume) X(centroid) X(inertia) \
  /* meshes.c */ \
  X(mesh) X(vertices) X(faces) X(normals_of) X(is_watertight) X(euler_characteristic) \
  X(weld) X(tessellate) X(flip) \
  /* solids_figures.c */ \
  X(control_net) X(isolines) X(arrow) X(triad)
// clang-format on

#define X(name) bool cag_solids_##name(CagCall *call, CagValue *result);
CAG_SOLID_FUNCTIONS(X)
#undef X

// Reads faces, lists of 3 or more numbers below `vertices`, as counts and indices. Both arrays are
// held, since a caller could not hold one without risking the other.
bool cag_arg_faces(CagCall *call, int argument, size_t vertices, uint32_t **counts,
                   uint32_t **indices, size_t *count);

// The body where a form is negative, cut by the argument `within` where it is given: a solid or a
// range of z (solids_csg.c).
bool cag_solids_of_form(CagCall *call, const CagQuadric *q, int within, CagValue *result);
// A cylinder, frustum or cone from p to q.
CagStatus cag_solid_rod(CagVec3 p, CagVec3 q, double radius, double top, CagSolid **out,
                        CagError *err);

// The material behind a label of a solid or mesh (solids_csg.c); NULL: none.
CagRecord *cag_solids_material(const CagVm *vm, uint32_t label);

#endif
