// Solids with exact boundaries, which the kernel computes.

#ifndef CAG_INTERP_BUILTIN_EXACTS_H
#define CAG_INTERP_BUILTIN_EXACTS_H

#include "interp/builtin/shapes.h"
#include "interp/kernel/kernel.h"

// The session's kernel, or NULL, with an error.
CagKernel *cag_exacts_kernel(CagCall *call);
// The exact solid of an argument, whose placement is a similarity: the argument itself if it is one,
// else its boundary, which the kernel computes. It is held by the call.
bool cag_exacts_of(CagCall *call, int argument, const CagSolid **out);
// The same; where the kernel is missing or fails, the boundary that is found from the mesh
// (geom/solid/recognized.h).
bool cag_exacts_or_meshed(CagCall *call, int argument, const CagSolid **out);
// The same for a solid that need not be an argument, without setting the machine's error; meshed:
// or the boundary that is found from the mesh.
CagStatus cag_exacts_of_solid(CagCall *call, const CagSolid *s, bool meshed, const CagSolid **out);
// The boundary that is found from the mesh of a solid. It is held by the call.
CagStatus cag_exacts_meshed(CagCall *call, const CagSolid *s, const CagSolid **out, CagError *err);
// The result of a core function that made a solid of the first argument, with its attributes; or
// the machine's error.
bool cag_exacts_changed(CagCall *call, CagStatus status, CagSolid **made, CagValue *result);
// Makes a solid of parts that the kernel found, whose contents it takes, and checks it
// (cag_solid_exact_check).
CagStatus cag_exacts_checked(CagBoundaries *parts, CagSolid **out, CagError *err);
// Checks the parts that the kernel found (cag_solid_exact_check), and returns them as one solid with
// the attributes of an argument. Takes their contents.
bool cag_exacts_result(CagCall *call, CagBoundaries *parts, int argument, CagValue *result);
// With -v, writes how a result was computed ("tier B: kernel"), and a count ("edges").
void cag_exacts_say_tier(CagCall *call, const char *tier, const char *what, size_t count);
// With -v, writes why a result was not computed in a way, after which another one is tried.
void cag_exacts_say_refused(CagCall *call, const char *tier, const CagError *why);
// The tolerance of results that are meshes because the kernel failed (tier C): that of the script,
// or 3/10000 of the size of the solid.
CagStatus cag_exacts_tolerance(CagCall *call, const CagSolid *s, double *out, CagError *err);

#endif
