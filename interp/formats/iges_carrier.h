// Carriers of faces as surfaces of IGES files.

#ifndef CAG_INTERP_FORMATS_IGES_CARRIER_H
#define CAG_INTERP_FORMATS_IGES_CARRIER_H

#include "interp/formats/iges_entity.h"

typedef struct CagIgesSurface {
  CagIgesPointer at;
  bool turned;             // its normal is opposite to that of the carrier
  CagTransform parameters; // planar: from the carrier's parameters
  bool bent;               // there is no such map, so that edges have no curves in the parameters
} CagIgesSurface;

// Writes the surface on which a face with a carrier lies.
CagStatus cag_iges_carrier(CagIges *w, const CagBrepFace *face, CagIgesSurface *out, CagError *err);

#endif
