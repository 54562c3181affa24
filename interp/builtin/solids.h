// Declarations shared by the built-ins on solids and meshes.

#ifndef CAG_INTERP_BUILTIN_SOLIDS_H
#define CAG_INTERP_BUILTIN_SOLIDS_H

#include "geom/surface/quadric.h"
#include "geom/tessellate/tessellate.h"
#include "interp/builtin/shapes.h"

// Returns all shapes of a shape, group, or list as a list.
bool cag_list_shapes(CagCall *call, CagValue v, CagList **out);
// Return the shapes as a group. cag_shapes_result returns a single shape unchanged.
bool cag_group_result(CagCall *call, CagBuilder *shapes, CagValue *result);
bool cag_shapes_result(CagCall *call, CagBuilder *shapes, CagValue *result);
// The default tessellation, with the limits of the run.
CagTessellation cag_run_tessellation(CagVm *vm);
// Reads faces, lists of 3 or more numbers below `vertices`, as counts and indices. Both arrays are
// held, because holding one can end the run and leak the other.
bool cag_arg_faces(CagCall *call, int argument, size_t vertices, uint32_t **counts,
                   uint32_t **indices, size_t *count);

// Returns the body where a form is negative. The argument `within`, if given, bounds it by a solid
// or a range of z (solids_csg.c).
bool cag_solids_of_form(CagCall *call, const CagQuadric *q, int within, CagValue *result);
// Makes a cylinder, frustum, or cone from p to q.
CagStatus cag_solid_rod(CagVec3 p, CagVec3 q, double radius, double top, CagSolid **out,
                        CagError *err);

// Returns the material of a label of a solid or mesh (solids_csg.c), or NULL.
CagRecord *cag_solids_material(const CagVm *vm, uint32_t label);

#endif
