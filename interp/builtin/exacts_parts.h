// What functions that change the faces of a solid share: the exact solid of their argument with the
// features of its parts, the choice of edges and faces, and the result.

#ifndef CAG_INTERP_BUILTIN_EXACTS_PARTS_H
#define CAG_INTERP_BUILTIN_EXACTS_PARTS_H

#include "geom/boundary/features.h"
#include "interp/builtin/exacts.h"

typedef struct CagExactParts {
  CagCall *call;
  CagKernel *kernel;
  const CagSolid *solid; // exact; its placement is a similarity
  double scale;          // of the placement
  const CagBoundary *parts;
  CagFeatures *features; // of each part, in its own coordinates
  size_t count;
  CagBoundaries results; // likewise
  CagValue records;      // the list of those of the chosen edges or faces, or CAG_UNSET
} CagExactParts;

// The parts of an argument, a solid; meshed: or the boundary that is found from its mesh
// (cag_exacts_or_meshed). They are held by the call. NULL: an error is set.
CagExactParts *cag_exact_parts(CagCall *call, int argument, bool meshed);
// Those of an exact solid.
CagExactParts *cag_exact_parts_of(CagCall *call, const CagSolid *exact);
// The same without setting the machine's error.
CagExactParts *cag_exact_parts_try(CagCall *call, const CagSolid *exact, CagError *err);
// Whether the boundary was found from the mesh, so that the kernel cannot change it.
bool cag_exact_parts_meshed(const CagExactParts *p);

// An edge or a face that was chosen.
typedef struct CagChosen {
  size_t part, index; // of the features of the part
  CagValue record;    // an element of `records`, which keeps it alive; or CAG_UNSET
} CagChosen;

// The edges that an argument chooses: a function of the record of an edge that tells which, or a
// list of records; if it is not given, all edges that are not smooth. `records`: the chosen edges
// have their records. Fails if no edge is chosen. *out is held by the call.
bool cag_chosen_edges(CagExactParts *p, int argument, bool records, CagChosen **out, size_t *n);
// The faces that an argument chooses, likewise; none if it is not given.
bool cag_chosen_faces(CagExactParts *p, int argument, CagChosen **out, size_t *n);
// The indexes in the boundary of the chosen faces of one part. *out is held by the call.
size_t cag_chosen_in_part(CagCall *call, const CagChosen *chosen, size_t n, size_t part,
                          size_t **out);

// Adds what the kernel made of one part, and takes its contents.
CagStatus cag_exact_parts_take(CagExactParts *p, CagBoundaries *made);
// The same, with the machine's error.
bool cag_exact_parts_add(CagExactParts *p, CagBoundaries *made);
// The solid of all results in world coordinates. The error is that of the call.
CagStatus cag_exact_parts_solid(CagExactParts *p, CagSolid **out);
// The same, with the attributes of an argument.
bool cag_exact_parts_result(CagExactParts *p, int argument, CagValue *result);

#endif
