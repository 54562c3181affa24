// Solids without faces: bodies within meshes, unbounded sides, and set operations of solids.
//
// A set operation keeps its operands, for exporters that have operations of their own, and answers
// every question by a mesh: the operands tessellated to the tolerance and joined by
// cag_mesh_boolean. A moved operation shares the core, so that copies are made and meshed once.
//
// Operands may be unbounded (half spaces, quadrics). They are cut to what the operation as a whole
// can need of them: an intersection lies within each of its operands, a difference within the
// first.

#ifndef CAG_GEOM_SOLID_CSG_H
#define CAG_GEOM_SOLID_CSG_H

#include "geom/boolean/boolean.h"
#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"

// Where a script asked for a solid: a source and a part of it, as they are to the caller.
typedef struct CagSolidPlace {
  const void *source; // NULL: not known
  uint32_t start, end;
} CagSolidPlace;

struct CagSolidCore {
  int references;
  size_t count;        // set operations
  CagSolid **operands; // in the order given
  double form[10];     // HALF_SPACE, QUADRIC: in the order of CagQuadric, negative inside
  CagMesh *mesh;       // MESH: the body. Set operations: the finest one made so far, or NULL ...
  double tolerance;    // ... to this tolerance
  CagBounds reach;     // set operations: holds the body; infinite where that is not known
  const volatile int *interrupt; // set operations: stops their meshes; NULL: none
  CagSolidPlace place;
};

// Whether the solid has a core, so that cores and meshes are asked where no faces are.
bool cag_solid_is_compound(const CagSolid *s);

// Union, difference (of the first and all others) or intersection of n >= 1 solids. Operands that
// are unmoved operations of the same kind are taken apart where that changes nothing.
//
//   interrupt  not NULL and not 0: ends the making of a mesh; outlives the solid
CagStatus cag_solid_combine(CagSetOperation op, CagSolid *const *operands, size_t n,
                            const volatile int *interrupt, CagSolid **out, CagError *err);
// A copy in which each operand without operands of its own, or the solid where it has none, has the
// label that `relabel` gives for its old one. Operations in which nothing is labeled count
// as without operands.
typedef uint32_t CagRelabel(void *context, uint32_t label);
CagStatus cag_solid_relabel(const CagSolid *s, CagRelabel *relabel, void *context, CagSolid **out,
                            CagError *err);
// The label of the solid, or the first among its operands'; 0: nothing is labeled.
uint32_t cag_solid_first_label(const CagSolid *s);
// The solid without any points: a union of none.
CagStatus cag_solid_empty(CagSolid **out, CagError *err);
// The side that the plane's normal leaves.
CagStatus cag_solid_half_space(const CagPlane *plane, CagSolid **out, CagError *err);
// Where the form is negative, bounded or not; fails for forms that are constant or not finite
// ("quadric-imaginary").
CagStatus cag_solid_quadric(const CagQuadric *form, CagSolid **out, CagError *err);
// The body within a closed mesh, turned outward: "mesh-open" with an open edge, "mesh-flat". That
// of a mesh without triangles is empty.
CagStatus cag_solid_from_mesh(const CagMesh *m, CagSolid **out, CagError *err);

// Form of a half space or quadric in the world; false: another kind.
bool cag_solid_form(const CagSolid *s, CagQuadric *out);

// What cag_solid_tessellate, cag_solid_bounds and cag_solid_mass do for these kinds:
// "solid-unbounded". A body that is empty has a mesh without triangles, no bounds ("empty-shape")
// and the mass 0.
CagStatus cag_csg_mesh(const CagSolid *s, const CagTessellation *how, CagMesh **out, CagError *err);
CagStatus cag_csg_bounds(const CagSolid *s, CagBounds *out, CagError *err);
CagStatus cag_csg_mass(const CagSolid *s, double tolerance, CagMassProperties *out, CagError *err);
// As cag_solid_mass; set operations by a mesh of this tolerance (mm; 0: one that is good to 2e-3).
CagStatus cag_solid_mass_within(const CagSolid *s, double tolerance, CagMassProperties *out,
                                CagError *err);
// Whether nothing is left of the solid, by a mesh where that must tell; faces hold something.
CagStatus cag_solid_is_empty(const CagSolid *s, bool *out, CagError *err);
// Bounds that hold the solid, quickly told; infinite where it is unbounded or that is not known.
CagStatus cag_solid_reach(const CagSolid *s, CagBounds *out, CagError *err);

// Which side of the boundary p is on: -1 inside, 1 outside, 0 on it, to `slack`. Kinds with faces
// and meshes are asked by `leaf`, sides and operations here, so that no mesh of an operation is
// made.
typedef CagStatus CagSideOfLeaf(void *context, const CagSolid *leaf, CagVec3 p, int *side,
                                CagError *err);
CagStatus cag_csg_side(const CagSolid *s, CagVec3 p, double slack, CagSideOfLeaf *leaf,
                       void *context, int *side, CagError *err);

// --- Unbounded sides (side.c) ---

// The part of a form's negative side that lies in the window, as a closed mesh that agrees with it
// there; outside of the window it ends anywhere. No triangles: there is none, or *all: the window
// lies inside.
CagStatus cag_side_mesh(const CagQuadric *form, const CagBounds *window, const CagTessellation *how,
                        CagMesh **out, CagError *err);
// A closed box as a mesh.
CagStatus cag_box_mesh(const CagBounds *box, CagMesh **out, CagError *err);

#endif
