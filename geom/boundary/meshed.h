// Boundaries that were found from meshes.

#ifndef CAG_GEOM_BOUNDARY_MESHED_H
#define CAG_GEOM_BOUNDARY_MESHED_H

#include "geom/boundary/face_feature.h"

// The feature of a face of a boundary with a mesh, by its triangles. The normal is that of the
// carrier, at the middle of the triangle whose middle is nearest to the center.
CagStatus cag_meshed_face(const CagBoundary *b, size_t face, CagFaceFeature *out, CagError *err);
// A copy of the mesh, with the numbers of faces as labels, or without labels.
CagStatus cag_meshed_copy(const CagBoundary *b, bool labeled, CagMesh **out, CagError *err);

#endif
