// Boundaries that were found from meshes.

#ifndef CAG_GEOM_BOUNDARY_MESHED_H
#define CAG_GEOM_BOUNDARY_MESHED_H

#include "geom/boundary/face_feature.h"

// The middle of a triangle.
static inline CagVec3 cag_meshed_middle(const CagMesh *m, size_t t) {
  const uint32_t *v = m->triangles + 3 * t;
  return cag_scaled(cag_add(cag_add(m->positions[v[0]], m->positions[v[1]]), m->positions[v[2]]),
                    1.0 / 3);
}

// Twice the area of a triangle times its normal.
static inline CagVec3 cag_meshed_cross(const CagMesh *m, size_t t) {
  const uint32_t *v = m->triangles + 3 * t;
  const CagVec3 a = m->positions[v[0]];
  return cag_cross(cag_sub(m->positions[v[1]], a), cag_sub(m->positions[v[2]], a));
}

// The feature of a face of a boundary with a mesh, by its triangles. The normal is that of the
// carrier, at the middle of the triangle whose middle is nearest to the center.
CagStatus cag_meshed_face(const CagBoundary *b, size_t face, CagFaceFeature *out, CagError *err);
// A copy of the mesh, with the numbers of faces as labels, or without labels.
CagStatus cag_meshed_copy(const CagBoundary *b, bool labeled, CagMesh **out, CagError *err);

#endif
