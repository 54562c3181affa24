// Solids without faces: solids bounded by meshes, half spaces and other unbounded solids, and set
// operations.
//
// A set operation keeps its operands for exporters with native set operations. Everything else uses
// a mesh: the operands are tessellated to the tolerance and combined by
// cag_mesh_boolean. Transformed copies of an operation share its core, so they are meshed only
// once.
//
// Operands may be unbounded (half spaces, quadrics). They are cut to the part that can matter to
// the whole operation: an intersection lies within each of its operands, a difference within the
// first.

#ifndef CAG_GEOM_SOLID_CSG_H
#define CAG_GEOM_SOLID_CSG_H

#include "geom/boolean/boolean.h"
#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"

// The location in a script at which a solid was made: a source and a range of it, meaningful only
// to the caller.
typedef struct CagSolidPlace {
  const void *source; // NULL: unknown
  uint32_t start, end;
} CagSolidPlace;

struct CagSolidCore {
  int references;
  size_t count;        // set operations
  CagSolid **operands; // in the given order
  double form[10];     // HALF_SPACE, QUADRIC: in the order of CagQuadric, negative inside
  CagMesh *mesh;       // MESH: the boundary. Set operations: the finest one made so far, or NULL
                       // ...
  double tolerance, short_edge; // ... to these limits
  CagBounds reach; // set operations: bounds that contain the solid; infinite if unknown
  const volatile int *interrupt; // set operations: cancels meshing; NULL: none
  CagSolidPlace place;
};

// Whether the solid has a core, in which case cores and meshes are used instead of faces.
bool cag_solid_is_compound(const CagSolid *s);

// Union, difference (the first minus all others), or intersection of n >= 1 solids. Nested
// operations of the same kind that are not transformed are flattened if that does not change the
// result.
//
//   interrupt  nonzero cancels meshing; must outlive the solid; may be NULL
CagStatus cag_solid_combine(CagSetOperation op, CagSolid *const *operands, size_t n,
                            const volatile int *interrupt, CagSolid **out, CagError *err);
// Whether an operand with this index is flattened in this way: its own operands take its place.
bool cag_solid_dissolves(const CagSolid *operand, CagSetOperation op, size_t index);
// A copy in which `relabel` replaces the label of each operand without operands of its own, or of
// the solid itself if it has no operands. Operations without labels count as having no operands.
typedef uint32_t CagRelabel(void *context, uint32_t label);
CagStatus cag_solid_relabel(const CagSolid *s, CagRelabel *relabel, void *context, CagSolid **out,
                            CagError *err);
// The label of the solid, or the first label among its operands; 0: none.
uint32_t cag_solid_first_label(const CagSolid *s);
// The empty solid: a union of nothing.
CagStatus cag_solid_empty(CagSolid **out, CagError *err);
// The side of the plane opposite to its normal.
CagStatus cag_solid_half_space(const CagPlane *plane, CagSolid **out, CagError *err);
// The points at which the form is negative, bounded or not. Fails with "quadric-imaginary" if the
// form is constant or not finite.
CagStatus cag_solid_quadric(const CagQuadric *form, CagSolid **out, CagError *err);
// The solid bounded by a closed mesh, oriented outward. Fails with "mesh-open" and an open edge,
// and with "mesh-flat". A mesh without triangles results in the empty solid.
CagStatus cag_solid_from_mesh(const CagMesh *m, CagSolid **out, CagError *err);

// The form of a half space or quadric in world coordinates; false: another kind.
bool cag_solid_form(const CagSolid *s, CagQuadric *out);

// cag_solid_tessellate, cag_solid_bounds, and cag_solid_mass for these kinds. Fail with
// "solid-unbounded". The empty solid has a mesh without triangles, no bounds ("empty-shape"), and
// the mass 0.
CagStatus cag_csg_mesh(const CagSolid *s, const CagTessellation *how, CagMesh **out, CagError *err);
CagStatus cag_csg_bounds(const CagSolid *s, CagBounds *out, CagError *err);
CagStatus cag_csg_mass(const CagSolid *s, double tolerance, CagMassProperties *out, CagError *err);
// Like cag_solid_mass; set operations are meshed to this tolerance (mm; 0: one that is accurate to
// 2e-3).
CagStatus cag_solid_mass_within(const CagSolid *s, double tolerance, CagMassProperties *out,
                                CagError *err);
// Whether the solid is empty, decided by a mesh if necessary; solids with faces are not empty.
CagStatus cag_solid_is_empty(const CagSolid *s, bool *out, CagError *err);
// Bounds that contain the solid, cheap to compute; infinite if it is unbounded or the bounds are
// unknown.
CagStatus cag_solid_reach(const CagSolid *s, CagBounds *out, CagError *err);

// The side of the boundary that p is on: -1 inside, 1 outside, 0 on it, to `slack`. `leaf` decides
// for solids with faces and for meshes; half spaces, quadrics, and operations are handled here, so
// that operations are not meshed.
typedef CagStatus CagSideOfLeaf(void *context, const CagSolid *leaf, CagVec3 p, int *side,
                                CagError *err);
CagStatus cag_csg_side(const CagSolid *s, CagVec3 p, double slack, CagSideOfLeaf *leaf,
                       void *context, int *side, CagError *err);

// --- Unbounded sides (side.c) ---

// The part of a form's negative side within the window, as a closed mesh that is accurate inside
// the window and ends anywhere outside. If the mesh has no triangles, the part is empty, or, with
// *all, the window lies inside.
CagStatus cag_side_mesh(const CagQuadric *form, const CagBounds *window, const CagTessellation *how,
                        CagMesh **out, CagError *err);
// A box as a closed mesh.
CagStatus cag_box_mesh(const CagBounds *box, CagMesh **out, CagError *err);

#endif
