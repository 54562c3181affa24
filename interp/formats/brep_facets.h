// Meshes as shapes of exact files: solids with plane faces.

#ifndef CAG_INTERP_FORMATS_BREP_FACETS_H
#define CAG_INTERP_FORMATS_BREP_FACETS_H

#include "geom/mesh/mesh.h"
#include "interp/formats/brep.h"

// Adds the flat faces of a closed mesh (geom/mesh/facets.h) as the shells of a shape, and notes
// their number and how far they are from the triangles. Fails with "mesh-open" if the mesh is not
// closed.
CagStatus cag_brep_add_facets(CagBrep *b, const CagMesh *m, CagBrepShape *shape, CagError *err);

#endif
