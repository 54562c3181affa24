// The shapes that the shown ones were made of.

#ifndef CAG_INTERP_SESSION_GHOSTS_H
#define CAG_INTERP_SESSION_GHOSTS_H

#include "interp/session/part_mesh.h"

// A state of a shape after one of the calls that it went through.
typedef struct CagGhost {
  CagItem item;          // shares the geometry of a later state of the shape
  const CagShape *shape; // that has this geometry; NULL: an operand
  CagTransform place;    // from the geometry to the state, in the scene
  const CagOriginStep *step;
  const CagOriginStep *next; // the call that changed the state; NULL: it is the last one
  const CagOriginStep *last; // the last call that the shape went through
  CagTransform context;      // from the coordinates of the states to the scene
  // The call that made another shape of the last state, and which of its arguments or operands the
  // shape is; NULL: none.
  const CagOriginStep *user;
  size_t parameter, operand, operand_count; // operand_count 0: the user is no set operation
  // The axis of the user's revolution, in the scene.
  bool has_axis;
  CagVec3 axis, through;
  size_t part; // of the scene; SIZE_MAX: none
  bool shown;  // it is shown itself
} CagGhost;

typedef struct CagGhosts {
  CagGhost *items;
  size_t count, capacity;
  bool failed; // memory ran out
} CagGhosts;

// Adds all states of the shapes that the parts of the scene were made of.
void cag_ghosts_of_parts(const CagSession *s, CagGhosts *out);
// The same for the definitions of the script whose values are known.
void cag_ghosts_of_definitions(const CagSession *s, CagGhosts *out);
// Finds those that are the value of the smallest expression at a location of the script. *first and
// *count are a list of indices, to be freed.
bool cag_ghosts_at(const CagSession *s, const CagGhosts *all, const char *file, size_t line,
                   size_t column, size_t **found, size_t *count);

#endif
