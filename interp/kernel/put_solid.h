// Solids as fields of messages to cag-brep.

#ifndef CAG_INTERP_KERNEL_PUT_SOLID_H
#define CAG_INTERP_KERNEL_PUT_SOLID_H

#include "geom/boundary/boundary.h"
#include "geom/solid/solid.h"
#include "interp/kernel/fields.h"

// Adds a solid: primitives, prisms, and revolutions as such, other solids by their faces, set
// operations with their operands, and exact solids in the kernel's own form. Fails with "no-boundary" for a mesh, and for an unbounded solid
// that nothing bounds. Curves and surfaces without an exact NURBS form are approximated within the
// tolerance of the fields; if it is 0, fails with "export-not-exact".
CagStatus cag_put_solid(CagFields *f, const CagSolid *s, CagError *err);
// Adds a solid of which only the part that meets `window` matters, so that it may be unbounded.
CagStatus cag_put_solid_within(CagFields *f, const CagSolid *s, const CagBounds *window,
                               CagError *err);
// Adds a part in the kernel's own form, placed.
void cag_put_body(CagFields *f, const CagBoundary *part, const CagTransform *placement);

#endif
