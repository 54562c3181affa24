// Set operations of solids that triangle meshes bound.
//
// What decides (which triangles meet, where, what lies inside) is exact: the operands' coordinates
// are taken as they are, and points of intersection are rounded to doubles only after everything is
// decided. Before that, corners that coincide to 1e-11 of the largest coordinate become one, and
// faces of the operands that lie in one plane as nearly are put into it exactly
// (boolean_snap.c). A point is inside a mesh where the mesh winds around it a positive number of
// times, so meshes may have several parts, cavities, and parts that touch, cross or repeat each
// other.

#ifndef CAG_GEOM_BOOLEAN_BOOLEAN_H
#define CAG_GEOM_BOOLEAN_BOOLEAN_H

#include "geom/mesh/mesh.h"

typedef enum CagSetOperation { CAG_UNION, CAG_DIFFERENCE, CAG_INTERSECTION } CagSetOperation;

typedef struct CagBooleanHow {
  const volatile int *interrupt; // NULL, or: not 0 stops with CAG_E_CALLBACK
  bool keep_flat; // flat faces stay in the triangles that they were cut to: edges stay short
} CagBooleanHow;

// The solid of a and b, bounded by a closed, consistently oriented mesh in which each edge is of
// two triangles; without triangles where the solid is empty. Where parts touch along an edge or in
// a point, each has vertices of its own there (weld does not join them).
//
//   a, b       vertices are one point where their numbers are; each edge is run as often in one
//              sense as in the other
//   interrupt  NULL, or: not 0 stops with CAG_E_CALLBACK
//
// Flat faces, and the facets of ruled ones, get as few triangles as their outlines allow, within
// 1e-12 of the largest coordinate; triangles of two materials, or with normals that do not agree,
// are no one face.
//
// The time is that of sorting the triangles, and of what meets. Flat faces that overlap in one
// plane are cut along the outlines of each other, however they are divided into triangles.
//
// Normals are interpolated from the operands (turned where b's surface bounds a hole of a; of faces
// where an operand has none); no operand has normals: none. uv is dropped. Each triangle has the
// label of the one that it is a part of. Fails with "mesh-open" (argument "a" or "b", index of a
// triangle), "mesh-inside-out", "vertex-out-of-range" (not finite, or beyond 1e100),
// "mesh-too-large".
CagStatus cag_mesh_boolean(CagSetOperation op, const CagMesh *a, const CagMesh *b,
                           const volatile int *interrupt, CagMesh **out, CagError *err);

// Of n >= 1 meshes: the union or intersection of all, or the first without all others. Errors name
// the argument "meshes" and give the operand's number as the index.
//
//   how   NULL: as usual
CagStatus cag_mesh_boolean_many(CagSetOperation op, const CagMesh *const *meshes, size_t n,
                                const CagBooleanHow *how, CagMesh **out, CagError *err);

#endif
