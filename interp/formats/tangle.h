// Polygons of files that no triangulation should be asked about: those whose edges cross so often
// that it would take forever.

#ifndef CAG_INTERP_FORMATS_TANGLE_H
#define CAG_INTERP_FORMATS_TANGLE_H

#include "interp/formats/mesh_draft.h"

typedef enum CagTangle {
  CAG_TANGLE_NONE,    // to be triangulated
  CAG_TANGLE_CROSSED, // edges cross or lie upon each other
  CAG_TANGLE_UNKNOWN, // it would take too long to tell
  CAG_TANGLE_MEMORY
} CagTangle;

// Polygons of few corners are never looked at: whatever they are costs little.
CagTangle cag_tangle_of(const CagVec3 *positions, const uint32_t *corners, size_t n);

#endif
