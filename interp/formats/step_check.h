// The test that a STEP file is read as it was meant.

#ifndef CAG_INTERP_FORMATS_STEP_CHECK_H
#define CAG_INTERP_FORMATS_STEP_CHECK_H

#include "interp/formats/brep.h"

// Writes the boundaries as a STEP file in memory, has the kernel read it, and compares the numbers
// and volumes of the solids. Fails with the kernel's errors, except that a file that cannot be read
// is not the same.
CagStatus cag_step_reads_back(CagKernel *kernel, const CagBoundaries *parts, bool *same,
                              CagError *err);

#endif
