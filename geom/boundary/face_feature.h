// The parts of features.h that describe a face.

#ifndef CAG_GEOM_BOUNDARY_FACE_FEATURE_H
#define CAG_GEOM_BOUNDARY_FACE_FEATURE_H

#include "geom/boundary/features.h"

// `boxes` are the bounds of the edges of the boundary.
CagStatus cag_face_feature(const CagBoundary *b, size_t face, const CagBounds *boxes,
                           CagFaceFeature *out, CagError *err);

#endif
