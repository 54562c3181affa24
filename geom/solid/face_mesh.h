// Meshes of exact solids that know the face of each triangle.

#ifndef CAG_GEOM_SOLID_FACE_MESH_H
#define CAG_GEOM_SOLID_FACE_MESH_H

#include "geom/solid/solid.h"

// A face of a solid of the kind EXACT: its part and its number in the boundary of this part.
typedef struct CagSolidFace {
  size_t part, face;
} CagSolidFace;

typedef struct CagFaceMesh {
  CagMesh *mesh;      // of all parts, in world coordinates
  CagSolidFace *face; // of each triangle
} CagFaceMesh;

// The mesh of a solid with boundaries, within the tolerance (mm). Fails like cag_boundary_mesh.
CagStatus cag_solid_face_mesh(const CagSolid *s, double tolerance, CagFaceMesh *out, CagError *err);
void cag_face_mesh_free(CagFaceMesh *m);

// The sums of n n^T and s n over the unit normals n of the faces at a point, each with a distance s
// and a weight.
typedef struct CagFaceSteps {
  CagTransform products;
  CagVec3 sum;
} CagFaceSteps;

void cag_face_steps_add(CagFaceSteps *f, double weight, CagVec3 normal, double distance);
// Finds the step that moves each face by its distance, by least squares. If several steps do, it is
// the shortest. Returns false if there are no faces.
bool cag_face_steps_solve(const CagFaceSteps *f, CagVec3 *step);

// The point of corner i of the triangles, counting all of them: the first of welded vertices.
static inline uint32_t cag_mesh_corner(const CagMesh *m, size_t i) {
  return m->weld ? m->weld[m->triangles[i]] : m->triangles[i];
}

// A corner of a triangle.
typedef struct CagCornerView {
  CagVec3 normal; // of the triangle
  double angle;
} CagCornerView;

// The three corners of a triangle.
void cag_triangle_corners(const CagMesh *m, size_t triangle, CagCornerView out[3]);

#endif
