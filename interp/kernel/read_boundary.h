// Reading the boundaries in the answers of cag-brep.

#ifndef CAG_INTERP_KERNEL_READ_BOUNDARY_H
#define CAG_INTERP_KERNEL_READ_BOUNDARY_H

#include "geom/boundary/boundary.h"
#include "interp/kernel/fields.h"
#include "interp/kernel/kernel.h"

// Reads one solid of a RESULT: name and color, then body and boundary or, of a copy, its original and
// placement. Fails with "kernel-answer" if the bytes are not one; *out is then empty.
CagStatus cag_read_part(CagFieldReader *r, CagBoundary *out, CagBoundaryCopy *copy, CagError *err);

#endif
