// The CAD kernel: the helper program cag-brep (protocol.h), which computes exact boundaries of
// solids with Open CASCADE.
//
// A kernel starts the program when it is first needed, and keeps it. The program may crash, hang,
// answer garbage, or be killed at any time: the request then fails, and the next one starts it
// again. Requests end when the thread's stop flag is set (base/stop.h).

#ifndef CAG_INTERP_KERNEL_KERNEL_H
#define CAG_INTERP_KERNEL_KERNEL_H

#include "geom/boundary/boundary.h"
#include "geom/solid/solid.h"
#include "interp/kernel/fields.h"

typedef struct CagKernel CagKernel;

// NULL if memory ran out. Starts nothing.
CagKernel *cag_kernel_new(void);
// Ends the program. NULL is allowed.
void cag_kernel_free(CagKernel *k);

// Boundaries of the connected parts of a solid.
typedef struct CagBoundaries {
  CagBoundary *items;
  size_t count;
} CagBoundaries;
void cag_boundaries_free(CagBoundaries *b);

// Computes the boundary of a solid in world coordinates. Each result closes: every edge has as many
// uses in one direction as in the other.
//
//   tolerance    mm: for operands without an exact NURBS form; 0: these fail
//   turn         which of the equal forms of round primitives is used, below CAG_TURNS: the seams
//                and poles of the result differ
//   approximate  set if the tolerance was used
//
// Fails with "kernel-missing" if the program is not installed or of another version,
// "kernel-failed" if it ends early or does not answer, "kernel-answer" if its answer is wrong, and
// "no-boundary", with a reason, for solids that have none: meshes, unbounded and empty solids, and
// those for which the kernel finds no valid result.
CagStatus cag_kernel_boundary(CagKernel *k, const CagSolid *s, double tolerance, int turn,
                              CagBoundaries *out, bool *approximate, CagError *err);
// Reads the solids of a STEP file. Fails as above.
CagStatus cag_kernel_read_step(CagKernel *k, const char *path, CagBoundaries *out, CagError *err);

#endif
