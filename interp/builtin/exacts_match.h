// Edges of one solid in two boundaries: that of the kernel, and the one that is found from the mesh.

#ifndef CAG_INTERP_BUILTIN_EXACTS_MATCH_H
#define CAG_INTERP_BUILTIN_EXACTS_MATCH_H

#include "interp/builtin/exacts_parts.h"

// Points at which edges are compared, evenly along each.
#define CAG_MATCH_PLACES 3

// Edges are numbered through all parts, as in the features.
typedef struct CagEdgeMatch {
  size_t (
      *of)[CAG_MATCH_PLACES]; // for each edge of `to`: the edges of `from` nearest to its places
  size_t *back;               // for each edge of `from`: the edge of `to` nearest to its middle
  size_t from_count, to_count;
} CagEdgeMatch;

// Finds which edges run along each other. Smooth edges are left out: theirs is SIZE_MAX, as is that
// of edges that are apart from all others. The arrays are held by the call.
CagStatus cag_match_edges(const CagExactParts *from, const CagExactParts *to, CagEdgeMatch *out,
                          CagError *err);

#endif
