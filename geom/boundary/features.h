// Faces, edges, and corners of a boundary, with what they are selected by.
//
// Edges that only the kernel needs are left out: seams, where a face meets itself smoothly, and
// degenerate edges. So are corners at which no other edges end, except at the apex of a cone, and
// those of a single closed edge. Lengths are those of the boundary, angles are radians. The order
// is that of the boundary: by positions.

#ifndef CAG_GEOM_BOUNDARY_FEATURES_H
#define CAG_GEOM_BOUNDARY_FEATURES_H

#include "geom/boundary/face_feature.h"

typedef enum CagEdgeBend { CAG_EDGE_CONVEX, CAG_EDGE_CONCAVE, CAG_EDGE_SMOOTH } CagEdgeBend;

typedef struct CagEdgeFeature {
  size_t edge;      // of the boundary
  const char *kind; // "line" "circle" "ellipse" "spline"; arcs are circles and ellipses
  double length;
  CagEdgeBend bend;    // at the middle of its curve's parameters, as all that follows
  double angle;        // between its faces, inside of the solid
  CagVec3 direction;   // a unit tangent whose first coordinate that is not 0 is positive
  bool flipped;        // the direction is opposite to the curve's
  CagVec3 start, end;  // along the direction
  CagVec3 normals[2];  // the outward normals of two faces, of the one with the lower index first
  size_t first, count; // of edge_faces: the faces that meet here
} CagEdgeFeature;

typedef struct CagCornerFeature {
  size_t corner; // of the boundary
  CagVec3 point;
  size_t first, count; // of corner_edges: the edges that end here
} CagCornerFeature;

typedef struct CagFeatures {
  CagFaceFeature *faces; // as many as the boundary has
  CagEdgeFeature *edges;
  CagCornerFeature *corners;
  size_t *edge_faces, *corner_edges; // indexes of `faces` and `edges`
  size_t face_count, edge_count, corner_count;
} CagFeatures;

// Areas and centers as cag_boundary_face_area. Bounds are those of the edges, and of the extremes
// of the carrier within the face: closed forms, or found from samples by Newton's method on splines
// and surfaces of revolution. Two faces meet smoothly if their normals differ by less than 1e-4.
CagStatus cag_boundary_features(const CagBoundary *b, CagFeatures *out, CagError *err);
void cag_features_free(CagFeatures *f);

#endif
