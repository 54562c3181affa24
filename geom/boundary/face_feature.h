// A face of a boundary, with what it is selected by (see features.h).

#ifndef CAG_GEOM_BOUNDARY_FACE_FEATURE_H
#define CAG_GEOM_BOUNDARY_FACE_FEATURE_H

#include "geom/boundary/boundary.h"

typedef struct CagFaceFeature {
  const char *kind; // "plane" "cylinder" "cone" "sphere" "torus" "spline" "revolved" "extruded"
  double area;
  CagVec3 center; // of the area; it need not lie on the face
  CagVec3 normal; // outward, a unit vector: at the point of the face nearest to the center
  CagBounds bounds;
} CagFaceFeature;

// `boxes` are the bounds of the edges of the boundary.
CagStatus cag_face_feature(const CagBoundary *b, size_t face, const CagBounds *boxes,
                           CagFaceFeature *out, CagError *err);

// Bounds of each edge: `edge_count` of them, malloc'd.
CagStatus cag_boundary_edge_boxes(const CagBoundary *b, CagBounds **out, CagError *err);
// Bounds of the whole boundary: exact to 1e-9 of its size, by the curves of edges and by the points
// of faces at which the tangent plane is across an axis.
CagStatus cag_boundary_bounds(const CagBoundary *b, CagBounds *out, CagError *err);

#endif
