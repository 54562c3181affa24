// Detects polygons whose edges cross so often that triangulating them would take extremely long.

#ifndef CAG_INTERP_FORMATS_TANGLE_H
#define CAG_INTERP_FORMATS_TANGLE_H

#include "interp/formats/mesh_draft.h"

typedef enum CagTangle {
  CAG_TANGLE_NONE,    // can be triangulated
  CAG_TANGLE_CROSSED, // edges cross or overlap
  CAG_TANGLE_UNKNOWN, // deciding would take too long
  CAG_TANGLE_MEMORY
} CagTangle;

// Polygons with few corners are not examined, because they are cheap in any case.
CagTangle cag_tangle_of(const CagVec3 *positions, const uint32_t *corners, size_t n);

#endif
