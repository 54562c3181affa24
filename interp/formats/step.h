// A scene as STEP (ISO 10303-21, schema AUTOMOTIVE_DESIGN of AP214): exact geometry for other CAD
// systems.
//
// Solids are manifold solids bounded by advanced faces, surfaces and regions are shells, and curves
// are geometric curve sets. All have their names and colors. Lengths are in millimeters.

#ifndef CAG_INTERP_FORMATS_STEP_H
#define CAG_INTERP_FORMATS_STEP_H

#include "base/atomic_file.h"
#include "interp/formats/brep.h"

// Write errors remain in the file until its commit.
CagStatus cag_export_step(const CagBrep *brep, const char *script, CagAtomicFile *file,
                          CagError *err);

#endif
