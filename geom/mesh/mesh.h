// Triangle meshes: shared vertices, normals from the exact surface, and its parameters.

#ifndef CAG_GEOM_MESH_H
#define CAG_GEOM_MESH_H

#include <stdint.h>

#include "base/status.h"
#include "geom/linalg/transform.h"
#include "geom/linalg/vec.h"

// How a mesh shows values by colors: uv[0] of each vertex is the value; `from` and `to` have the
// first and last color; values outside are clamped. See interp/scene/color_scale.h.
typedef enum CagColorScaleKind {
  CAG_SCALE_NONE, // uv are parameters
  CAG_SCALE_SEQUENCE,
  CAG_SCALE_DIVERGING,
  CAG_SCALE_STRIPES
} CagColorScaleKind;
typedef struct CagColorScale {
  CagColorScaleKind kind;
  double from, to;
  int stripes; // STRIPES: pairs of a light and a dark stripe
} CagColorScale;

// Invariant: every index is below vertex_count; no triangle uses a vertex twice. Normals are stored
// per vertex; at a sharp edge of a solid vertices are duplicated, one for each face, for shading
// (`normals`). `weld` tells which vertices are one point of the closed surface: weld[i] <= i is the
// first vertex with i's position (identical bits). NULL weld: vertices are not welded.
typedef struct CagMesh {
  int references;
  size_t vertex_count, triangle_count;
  CagVec3 *positions;
  CagVec3 *normals;    // unit, per vertex; NULL: flat shading
  double *uv;          // 2 per vertex; NULL: none
  uint32_t *triangles; // 3 per triangle, counter-clockwise seen from outside
  uint32_t *weld;
  uint32_t *labels;    // of triangles: material numbers, 0: unspecified. NULL: all 0
  CagColorScale scale; // kind NONE unless there are uv
} CagMesh;

CagStatus cag_mesh_new(size_t vertices, size_t triangles, bool normals, bool uv, bool weld,
                       CagMesh **out, CagError *err); // contents unset
CagMesh *cag_mesh_retain(const CagMesh *m);
void cag_mesh_release(CagMesh *m);
// Adds the contents of the mesh to a digest.
void cag_mesh_digest(const CagMesh *m, CagDigest *d);
// Whether the invariant above holds, and all positions are finite. Linear time.
bool cag_check_mesh(const CagMesh *m);
// A validated copy of lists; faces are polygons of 3 or more vertices, given by their counts and
// indices (concave ones are triangulated).
CagStatus cag_mesh_from_faces(const CagVec3 *vertices, size_t n, const uint32_t *indices,
                              const uint32_t *counts, size_t faces, CagMesh **out, CagError *err);
CagStatus cag_mesh_transform(const CagMesh *m, const CagTransform *t, CagMesh **out,
                             CagError *err); // reflections reverse the triangles
CagStatus cag_mesh_append(CagMesh *const *meshes, size_t n, CagMesh **out, CagError *err);
CagBounds cag_mesh_bounds(const CagMesh *m);
// Whether the mesh is closed and consistently oriented: each edge (of welded vertices) belongs to
// two triangles, in opposite directions. *edge: an edge that fails, as two positions.
CagStatus cag_mesh_watertight(const CagMesh *m, bool *watertight, CagVec3 edge[2], CagError *err);
bool cag_mesh_is_watertight(const CagMesh *m, CagVec3 edge[2]); // also false if memory ran out
long cag_mesh_euler_characteristic(const CagMesh *m);           // of the welded mesh
double cag_mesh_area(const CagMesh *m);
void cag_mesh_volume_terms(const CagMesh *m, double terms[10]); // like cag_surface_volume_terms
CagStatus cag_mesh_weld(const CagMesh *m, double tolerance, CagMesh **out,
                        CagError *err); // merges vertices closer than the tolerance
CagStatus cag_mesh_flip(const CagMesh *m, CagMesh **out, CagError *err);

// Triangulates polygons with holes in the plane (GLU tessellator, odd rule): loops of 2-D points
// given by counts. No points are added, so self-crossing input fails ("polygon-self-intersection").
// *out is malloc'd: 3 indices per triangle into the given points; counter-clockwise.
CagStatus cag_triangulate(const double *xy, const size_t *counts, size_t loops, uint32_t **out,
                          size_t *n, CagError *err);

#endif
