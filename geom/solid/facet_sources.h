// Meshes whose triangles tell the carriers on which they are, for facets.h.

#ifndef CAG_GEOM_SOLID_FACET_SOURCES_H
#define CAG_GEOM_SOLID_FACET_SOURCES_H

#include "geom/boundary/boundary.h"
#include "geom/solid/solid.h"

// The carriers of the operands of a solid. Their kind is NONE where no carrier was recognized.
typedef struct CagFacetSources {
  CagCarrier *items;
  size_t count, room;
} CagFacetSources;

void cag_facet_sources_free(CagFacetSources *s);

// The mesh of a solid within the tolerance (mm), in the world. Its labels are 1 more than the
// indexes of the carriers. Every operand is meshed and divided into faces before operations combine
// them, so a triangle keeps its carrier however it is cut.
CagStatus cag_facet_mesh(const CagSolid *s, double tolerance, CagFacetSources *sources,
                         CagMesh **out, CagError *err);

#endif
