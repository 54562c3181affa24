// The test that a file is read as it was meant.

#ifndef CAG_INTERP_FORMATS_BREP_CHECK_H
#define CAG_INTERP_FORMATS_BREP_CHECK_H

#include "interp/formats/brep.h"

// Writes the boundaries as a file in memory, has the kernel read it, and compares the numbers and
// volumes of the solids. Fails with the kernel's errors, except that a file that cannot be read
// is not the same.
CagStatus cag_brep_reads_back(CagKernel *kernel, const CagBoundaries *parts, CagBrepFormat format,
                              bool *same, CagError *err);

#endif
