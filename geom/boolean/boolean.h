// Set operations on solids bounded by triangle meshes.
//
// All decisions (which triangles meet, where, and what lies inside) are exact: the coordinates of
// the operands are taken as given, and intersection points are rounded to doubles only after
// everything is decided. Before that, vertices that coincide to within 1e-11 of the largest
// coordinate are merged, and faces of the operands that are coplanar to the same accuracy are moved
// exactly into one plane (snap.c). A point is inside a mesh if the winding number of the mesh about
// it is positive, so a mesh may have several parts, cavities, and parts that touch, intersect, or
// coincide.

#ifndef CAG_GEOM_BOOLEAN_BOOLEAN_H
#define CAG_GEOM_BOOLEAN_BOOLEAN_H

#include "geom/mesh/mesh.h"

typedef enum CagSetOperation { CAG_UNION, CAG_DIFFERENCE, CAG_INTERSECTION } CagSetOperation;

typedef struct CagBooleanHow {
  const volatile int *interrupt; // nonzero stops with CAG_E_CALLBACK; may be NULL
  bool keep_flat; // do not merge the triangles of flat faces after cutting: edges stay short
} CagBooleanHow;

// The solid of a and b, bounded by a closed, consistently oriented mesh in which each edge belongs
// to two triangles. The mesh has no triangles if the solid is empty. Where parts touch along an
// edge or in a point, each has its own vertices (weld does not join them).
//
//   a, b       vertices are identified by index; each edge must be run equally often in both
//   directions
//   interrupt  nonzero stops with CAG_E_CALLBACK; may be NULL
//
// Flat faces, and the facets of ruled faces, get as few triangles as their outlines allow, within
// 1e-12 of the largest coordinate. Triangles of different materials, or with normals that disagree,
// do not belong to one face.
//
// The time grows with sorting the triangles, and with the number of intersections. Flat faces that
// overlap in one plane are cut along each other's outlines, however they are triangulated.
//
// Normals are interpolated from the operands. They are reversed where b's surface bounds a hole of
// a; if an operand has no normals, the normals of its faces are used, and if neither has any, the
// result has none. uv is dropped. Each triangle keeps the label of the triangle that it is a part
// of. Fails with "mesh-open" (argument "a" or "b", index of a triangle), "mesh-inside-out",
// "vertex-out-of-range" (not finite, or beyond 1e100), "mesh-too-large".
CagStatus cag_mesh_boolean(CagSetOperation op, const CagMesh *a, const CagMesh *b,
                           const volatile int *interrupt, CagMesh **out, CagError *err);

// The union or intersection of n >= 1 meshes, or the first minus all others. Errors name the
// argument "meshes", with the operand's number as the index.
//
//   how   NULL: the defaults
CagStatus cag_mesh_boolean_many(CagSetOperation op, const CagMesh *const *meshes, size_t n,
                                const CagBooleanHow *how, CagMesh **out, CagError *err);

#endif
