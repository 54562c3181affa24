// Records of the faces, edges, and corners of exact solids.

#ifndef CAG_INTERP_BUILTIN_EXACTS_FEATURES_H
#define CAG_INTERP_BUILTIN_EXACTS_FEATURES_H

#include "interp/builtin/exacts.h"

// The records of all parts of an exact solid, whose placement must be a similarity, in world
// coordinates. They are in the order of cag_boundary_features, part after part; so are the indexes
// in `faces` and `edges`. Face number k is face k of the solid. Return false if an error is set.
bool cag_exacts_face_records(CagCall *call, const CagSolid *exact, CagValue *list);
bool cag_exacts_edge_records(CagCall *call, const CagSolid *exact, CagValue *list);
bool cag_exacts_corner_records(CagCall *call, const CagSolid *exact, CagValue *list);
// Whether two values are records of the same face, edge, or corner: all fields are equal but the
// surface or curve, which are other objects in each list of records.
bool cag_exacts_same_record(CagVm *vm, CagValue a, CagValue b);

#endif
