// The CAD kernel: the helper program cag-brep (protocol.h), which computes exact boundaries of
// solids with Open CASCADE.
//
// A kernel starts the program when it is first needed, and keeps it. The program may crash, hang,
// answer garbage, or be killed at any time: the request then fails, and the next one starts it
// again. Requests end when the thread's stop flag is set (base/stop.h). Answers are kept, so that a
// request that was answered before asks nothing (answers.h).

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

// Seconds that a request may take if the mesh can give what it asks for: a fillet, chamfer, shell,
// offset, or draft. 0: as long as the others.
void cag_kernel_set_patience(CagKernel *k, double seconds);

// Where a part is that has the shape of an earlier one.
#define CAG_NOT_COPIED SIZE_MAX
typedef struct CagBoundaryCopy {
  size_t original;        // its index, or CAG_NOT_COPIED
  CagTransform placement; // rigid: maps the original to the copy
} CagBoundaryCopy;

// Boundaries of the connected parts of a solid. Copies, which only files have, have a name, a color,
// and a volume, but no faces.
typedef struct CagBoundaries {
  CagBoundary *items;
  size_t count;
  CagBoundaryCopy *copies; // as many as items; NULL: none is a copy
} CagBoundaries;
void cag_boundaries_free(CagBoundaries *b);

// Why a request failed, as far as the kernel said it.
#define CAG_NO_EDGE SIZE_MAX
typedef struct CagKernelFailure {
  int reason;   // CagBrepFailure (protocol.h); 0: the kernel did not answer
  size_t edge;  // its index in the boundary, or CAG_NO_EDGE
  double limit; // the largest radius or distance that works there; 0 if none is known
} CagKernelFailure;

// All requests below give boundaries. Each result closes: every edge has as many uses in one
// direction as in the other. Nothing is left in *out by a request that fails.
//
// They fail with "kernel-missing" if the program is not installed or of another version,
// "kernel-failed" if it ends early or does not answer, "kernel-answer" if its answer is wrong, and
// "no-boundary", with a reason, for solids that have none (meshes, unbounded and empty solids) and
// where the kernel finds no valid result; *why then has what the kernel said.

// Computes the boundary of a solid, of all its parts, in world coordinates.
//
//   tolerance    mm: for operands without an exact NURBS form; 0: these fail
//   turn         which of the equal forms of round primitives is used, below CAG_TURNS: the seams
//                and poles of the result differ
//   approximate  set if the tolerance was used
CagStatus cag_kernel_boundary(CagKernel *k, const CagSolid *s, double tolerance, int turn,
                              CagBoundaries *out, bool *approximate, CagError *err);

// An edge that is filleted or chamfered, with indexes of the boundary of which it is a part.
typedef struct CagBlend {
  size_t edge;
  size_t face;        // of a chamfer: the face on which `first` lies
  double first, last; // mm: of a fillet, the radii at the start and at the end of the edge's curve;
                      // of a chamfer, the distances on the face and on the other one
} CagBlend;

// The requests for a part take the boundary of one, as the kernel gave it, and answer in its
// coordinates. Lengths are in its unit.

// Rounds edges, and those that continue them smoothly, with a rolling ball. Smooth edges have
// nothing to round and are passed over.
CagStatus cag_kernel_fillet(CagKernel *k, const CagBoundary *part, const CagBlend *blends, size_t n,
                            CagBoundaries *out, CagKernelFailure *why, CagError *err);
// Cuts edges off by planes or ruled surfaces.
CagStatus cag_kernel_chamfer(CagKernel *k, const CagBoundary *part, const CagBlend *blends,
                             size_t n, CagBoundaries *out, CagKernelFailure *why, CagError *err);
// Hollows a part out. Walls of this thickness remain inside of its faces, or stand outside of them
// if the thickness is negative; the `open` faces have none.
CagStatus cag_kernel_shell(CagKernel *k, const CagBoundary *part, double thickness,
                           const size_t *open, size_t n, CagBoundaries *out, CagKernelFailure *why,
                           CagError *err);
// Inclines faces by an angle (radians) such that the part becomes narrower along the pull. The
// faces keep their sections with the plane through `at` perpendicular to the pull.
CagStatus cag_kernel_draft(CagKernel *k, const CagBoundary *part, double angle, CagVec3 pull,
                           CagVec3 at, const size_t *faces, size_t n, CagBoundaries *out,
                           CagKernelFailure *why, CagError *err);
// Draws curves on the faces that they lie on or near to, which divides these faces.
//
//   tolerance  for curves without an exact NURBS form; 0: these fail
CagStatus cag_kernel_imprint(CagKernel *k, const CagBoundary *part, CagCurve *const *curves,
                             size_t n, double tolerance, CagBoundaries *out, CagKernelFailure *why,
                             CagError *err);

// These take any solids, with the tolerance of cag_kernel_boundary, and answer in world
// coordinates.

// Moves all faces outward by a distance (mm), or inward if it is negative.
CagStatus cag_kernel_offset(CagKernel *k, const CagSolid *s, double distance, double tolerance,
                            CagBoundaries *out, CagKernelFailure *why, CagError *err);
// Divides a solid by another one, which may be unbounded. The parts within the tool are named
// "inside", the others "outside".
CagStatus cag_kernel_split(CagKernel *k, const CagSolid *s, const CagSolid *tool, double tolerance,
                           CagBoundaries *out, CagKernelFailure *why, CagError *err);

// Reads the solids of a STEP or IGES file, whose contents are given: placed, in millimeters, with
// names and colors. `name` stands for the file in errors.
CagStatus cag_kernel_read_step(CagKernel *k, const char *name, const void *bytes, size_t size,
                               CagBoundaries *out, CagKernelFailure *why, CagError *err);
CagStatus cag_kernel_read_iges(CagKernel *k, const char *name, const void *bytes, size_t size,
                               CagBoundaries *out, CagKernelFailure *why, CagError *err);

#endif
