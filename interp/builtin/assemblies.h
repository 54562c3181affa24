// Assemblies: frames of parts, and the parts of a group.
//
// A part is a shape, or a group that has a name and contains no other names. The group that a
// function is given is opened in any case, and so is what is alone in it.

#ifndef CAG_INTERP_BUILTIN_ASSEMBLIES_H
#define CAG_INTERP_BUILTIN_ASSEMBLIES_H

#include "interp/builtin/shapes.h"

// Returns the frames after a map, or NULL if one of them has no image.
CagRecord *cag_frames_moved(CagVm *vm, const CagRecord *frames, const CagTransform *map);

// A shape of a part: a solid, surface, or mesh.
typedef struct CagPartBody {
  CagValue shape;
  CagRecord *material; // also of enclosing groups; NULL: none
  double tolerance;    // also of enclosing groups; 0: none
  CagSolid *solid;     // NULL: the surface or mesh is open
} CagPartBody;

typedef struct CagPart {
  CagText *given;            // by `named`; NULL: none
  const char *name;          // given, or of its definition or kind
  const CagOriginStep *last; // the last call that the shape or group went through; may be NULL
  size_t first, count;       // its bodies
} CagPart;

typedef struct CagParts {
  CagPart *items;
  size_t count, capacity;
  CagPartBody *bodies;
  size_t body_count, body_capacity;
} CagParts;

// Whether a group is one part of a group around it.
bool cag_is_part(CagVm *vm, CagValue group);
// Returns the parts of a shape, group, or list, held by the call. Curves, regions, labels, and hidden
// and empty shapes are left out, and, if `only_shapes` is false, also what is not a shape. Returns NULL
// if an error is set.
CagParts *cag_parts_of(CagCall *call, CagValue v, bool only_shapes);

// A pair of parts that share volume.
typedef struct CagClash {
  size_t a, b; // a < b
  double volume;
} CagClash;

// Finds all pairs, by a and then by b. *out is held by the call.
bool cag_parts_clashes(CagCall *call, const CagParts *parts, CagClash **out, size_t *n);

#endif
