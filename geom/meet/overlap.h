// The volume that two solids share.
//
// Meshes of curved faces that touch overlap by slivers, which are thinner than the tolerances of
// the meshes allow for. A lump of the common part therefore counts only if its mean thickness, twice
// its volume by its area, exceeds the sum of the tolerances. While there are thinner lumps, finer
// meshes decide: those of faces that touch get thinner with the tolerance, others do not.

#ifndef CAG_GEOM_MEET_OVERLAP_H
#define CAG_GEOM_MEET_OVERLAP_H

#include "geom/solid/solid.h"

// The number of meshes of a body. Each has a quarter of the tolerance of the one before.
#define CAG_OVERLAP_LEVELS 4

typedef struct CagOverlapBody {
  const CagSolid *solid;               // borrowed
  CagBounds bounds;                    // contain the solid
  double tolerance;                    // of the first mesh, in mm
  bool exact;                          // the first mesh is the solid itself
  CagMesh *meshes[CAG_OVERLAP_LEVELS]; // NULL: not made yet
} CagOverlapBody;

// tolerance: in mm; 0: a thousandth of the size. Release with cag_overlap_release, even on failure.
CagStatus cag_overlap_body(const CagSolid *s, double tolerance, const CagTessellation *how,
                           CagOverlapBody *out, CagError *err);
void cag_overlap_release(CagOverlapBody *b);

// Sets *volume to that of the common part, or to 0 if the solids only touch. Common parts that are
// thinner than 1/32 of the tolerances are not found.
//
//   how   the limits of meshes; its tolerance is ignored
CagStatus cag_overlap_volume(CagOverlapBody *a, CagOverlapBody *b, const CagTessellation *how,
                             double *volume, CagError *err);

#endif
