// What the exact surface of a shape tells about its mesh: the operand that each triangle comes
// from, the curvature at its corners, and its distance from the surface.
//
// The surface is found by rays along the normals of the triangles, so all kinds of shapes with
// casters have these numbers. Formulas of a script can be evaluated by its own thread only.

#ifndef CAG_GEOM_RAY_MESH_SURFACE_H
#define CAG_GEOM_RAY_MESH_SURFACE_H

#include "geom/mesh/mesh.h"
#include "geom/ray/caster.h"

// The operands of a set operation, in depth-first order. Of nested set operations, their operands.
size_t cag_solid_leaf_count(const CagSolid *s);
// Finds the number of the leaf that each triangle of the solid's mesh is a part of. The mesh is in
// the coordinates of the solid. A triangle that lies on no leaf, because it is too small to have a
// normal, gets the number of a neighbor.
CagStatus cag_mesh_leaves(const CagSolid *s, const CagMesh *m, uint32_t *out, CagError *err);

// The mean and Gaussian curvature at the corners of the triangles, 3 numbers per triangle: that of
// the surface next to the corner on the side of the triangle, so the triangles on both sides of an
// edge have their own. Signs are relative to the side that the triangle faces, as in CagBend. NaN:
// unknown.
CagStatus cag_mesh_curvature(const CagCaster *c, const CagMesh *m, float *mean, float *gaussian,
                             CagError *err);
// The distance of each triangle from the surface, mm: the largest at its center and the middles of
// its sides, to first order in the angle between them. NaN: the surface was not found. *farthest is
// the largest of all.
CagStatus cag_mesh_deviation(const CagCaster *c, const CagMesh *m, float *distance,
                             double *farthest, CagError *err);

#endif
