// A scene as IGES 5.3: exact geometry for other CAD systems.
//
// Curves are entities 126, surfaces 128; a face that is not all of its surface is a trimmed surface
// 144 with boundaries 142, given in space and, of planes, in the parameters as well. Every entity
// carries its color (314) and its shape's name (406 form 15). Lengths are millimeters. IGES of
// this kind knows no bodies: the faces of a solid stand side by side, their normals outward.

#ifndef CAG_INTERP_FORMATS_IGES_H
#define CAG_INTERP_FORMATS_IGES_H

#include "base/atomic_file.h"
#include "interp/formats/brep.h"

// Errors of writing stay in the file until its commit.
CagStatus cag_export_iges(const CagBrep *brep, const char *script, CagAtomicFile *file,
                          CagError *err);

#endif
