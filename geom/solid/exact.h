// Solids with exact boundaries: kind EXACT.
//
// Such a solid keeps the boundaries of its parts in its own coordinates, beside the surfaces of all
// faces in those of the world. It is meshed by the boundaries, whose faces share edges.

#ifndef CAG_GEOM_SOLID_EXACT_H
#define CAG_GEOM_SOLID_EXACT_H

#include "geom/boundary/boundary.h"
#include "geom/solid/kind.h"
#include "geom/solid/solid.h"

// A solid of n >= 1 separate parts. Takes the contents of their boundaries, which are then empty,
// also if it fails.
CagStatus cag_solid_exact(CagBoundary *parts, size_t n, CagSolid **out, CagError *err);
// Fails with "no-boundary" unless the mesh is watertight and encloses the volume that the kernel
// found, up to the tolerance of the mesh (1/1000 of the diagonal of the bounds).
CagStatus cag_solid_exact_check(const CagSolid *s, CagError *err);
// The boundaries of the parts in the solid's own coordinates, which its placement maps to the
// world. The solid's faces are theirs, in order. NULL: another kind.
const CagBoundary *cag_solid_boundaries(const CagSolid *s, size_t *n);

// --- For the table of kinds, and the functions that all kinds share ---
CagExact *cag_exact_retain(CagExact *e);
void cag_exact_release(CagExact *e);
void cag_exact_digest(const CagExact *e, CagDigest *d);
// The measures of all parts in the solid's own coordinates (measure.h in geom/boundary), which are
// computed once.
CagStatus cag_exact_body(CagExact *e, CagSolidBody *out, CagError *err);
CagStatus cag_exact_bounds(const CagSolid *s, CagBounds *out, CagError *err);
CagStatus cag_exact_mesh(const CagSolid *s, const CagTessellation *how, CagMesh **out,
                         CagError *err);

#endif
