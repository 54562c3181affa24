// Regions of a labeled mesh and the chains of mesh edges between them, for recognized.h.

#ifndef CAG_GEOM_SOLID_RECOGNIZED_NET_H
#define CAG_GEOM_SOLID_RECOGNIZED_NET_H

#include "geom/solid/recognized_sources.h"

// The border between two regions, from corner to corner or closed.
typedef struct CagRecognizedChain {
  size_t first, count; // vertices in `path`; the first and last of a closed chain are equal
  uint32_t sides[2];   // regions on the left and right, seen from outside
  bool closed;
  size_t ends[2]; // corners
} CagRecognizedChain;

typedef struct CagRecognizedNet {
  const CagMesh *mesh;
  uint32_t *region; // by triangles
  size_t *source;   // by regions: the index of the carrier
  double *area;     // likewise
  uint32_t *path;   // vertices, welded
  CagRecognizedChain *chains;
  uint32_t *corners; // vertices
  size_t region_count, path_count, path_room, chain_count, chain_room, corner_count, corner_room;
} CagRecognizedNet;

// Divides a mesh by the labels of its triangles. Regions that are narrower than the tolerance (mm)
// belong to the neighbor with the longest common border, and the corners at the ends of a border
// that is shorter than twice the tolerance are one.
CagStatus cag_recognized_net(const CagMesh *m, const CagRecognizedSources *sources,
                             double tolerance, CagRecognizedNet *out, CagError *err);
void cag_recognized_net_free(CagRecognizedNet *n);

#endif
