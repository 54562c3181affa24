// Meshes whose triangles tell the carriers on which they are, for recognized.h.

#ifndef CAG_GEOM_SOLID_RECOGNIZED_SOURCES_H
#define CAG_GEOM_SOLID_RECOGNIZED_SOURCES_H

#include "geom/boundary/boundary.h"
#include "geom/solid/solid.h"

// The carriers of the operands of a solid. Their kind is NONE where no carrier was recognized.
typedef struct CagRecognizedSources {
  CagCarrier *items;
  size_t count, room;
} CagRecognizedSources;

void cag_recognized_sources_free(CagRecognizedSources *s);

// The mesh of a solid within the tolerance (mm), in the world. Its labels are 1 more than the
// indexes of the carriers. Every operand is meshed and divided into faces before operations combine
// them, so a triangle keeps its carrier however it is cut.
CagStatus cag_recognized_mesh(const CagSolid *s, double tolerance, CagRecognizedSources *sources,
                              CagMesh **out, CagError *err);

#endif
