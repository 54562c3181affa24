// Faces of boundaries as surfaces.

#ifndef CAG_GEOM_BOUNDARY_PATCH_H
#define CAG_GEOM_BOUNDARY_PATCH_H

#include "geom/boundary/boundary.h"

// The surface on which a face lies, over its parameters, with the face's outward normal. Angles and
// lengths along the carrier become parameters of this surface by an affine map of the plane.
typedef struct CagPatch {
  CagSurface *whole;       // NULL: a plane
  CagTransform plane;      // of a plane: its frame, z outward; u and v are x and y
  CagTransform parameters; // planar: from the carrier's parameters
} CagPatch;

// Fails with "no-boundary" if the carrier is not a surface.
CagStatus cag_patch_of_face(const CagBoundary *b, size_t face, CagPatch *out, CagError *err);
void cag_patch_release(CagPatch *p);
// The part of an edge's trace in the parameters of the patch. Where a trace is slightly outside of the
// surface's domain, as in files of other programs, it is moved to the edge.
CagStatus cag_patch_trace(const CagPatch *p, const CagCurve *trace, CagCurve **out, CagError *err);

// The face: kind "planar" or "trimmed", with its outward normal. Traces that do not meet, because
// the kernel's tolerance is larger than rounding, are joined by lines.
CagStatus cag_boundary_surface(const CagBoundary *b, size_t face, CagSurface **out, CagError *err);

#endif
