// A scene as IGES 5.3: exact geometry for other CAD systems.
//
// Curves are entities 126, and surfaces 128. A face that covers only part of its surface is a
// trimmed surface 144 with boundaries 142, given in space and, for planes, also in the parameters.
// Every entity has its color (314) and the name of its shape (406 form 15). Lengths are in
// millimeters. These entities cannot represent solids, so the faces of a solid are written
// separately, with outward normals.

#ifndef CAG_INTERP_FORMATS_IGES_H
#define CAG_INTERP_FORMATS_IGES_H

#include "base/atomic_file.h"
#include "interp/formats/brep.h"

// Write errors remain in the file until its commit.
CagStatus cag_export_iges(const CagBrep *brep, const char *script, CagAtomicFile *file,
                          CagError *err);

#endif
