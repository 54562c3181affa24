// The test that a file is read as it was meant.

#ifndef CAG_INTERP_FORMATS_BREP_CHECK_H
#define CAG_INTERP_FORMATS_BREP_CHECK_H

#include "interp/formats/brep.h"

// Whether readers may find other faces than those that are meant: some depend on where a reader puts
// them in a periodic parameter. Planes do not, and neither do faces of cylinders, cones, balls, and
// tori that are rectangles of the parameters, with a seam if they go all the way round.
CagStatus cag_brep_needs_reading(const CagBoundaries *parts, bool *needed, CagError *err);

// Writes the boundaries as a file in memory, has the kernel read it, and compares the numbers and
// volumes of the solids. Fails with the kernel's errors, except that a file that cannot be read
// is not the same.
CagStatus cag_brep_reads_back(CagKernel *kernel, const CagBoundaries *parts, CagBrepFormat format,
                              bool *same, CagError *err);

#endif
