// Reading the boundaries in the answers of cag-brep.

#ifndef CAG_INTERP_KERNEL_READ_BOUNDARY_H
#define CAG_INTERP_KERNEL_READ_BOUNDARY_H

#include "geom/boundary/boundary.h"
#include "interp/kernel/fields.h"

// Reads one solid of a RESULT: name, color, body, and boundary. Fails with
// "kernel-answer" if the bytes are not one; *out is then empty.
CagStatus cag_read_boundary(CagFieldReader *r, CagBoundary *out, CagError *err);

#endif
