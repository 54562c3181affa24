// The mesh that was made last for a host, and what is computed for it.

#ifndef CAG_INTERP_SESSION_PART_MESH_H
#define CAG_INTERP_SESSION_PART_MESH_H

#include "interp/session/session.h"

// The item is that of the mesh, in its coordinates: before it was moved. It shares everything but a
// solid that it owns. Arrays are NULL until they are made.
typedef struct CagSessionMesh {
  CagMesh *mesh; // NULL: a line
  CagItem item;
  CagSolid *owned; // may be NULL
  char id[33];
  float *positions, *normals;
  uint32_t *edges;
  // Answers about the mesh, which are valid as long as it is.
  uint32_t *numbers, *sizes;
  float *values;
} CagSessionMesh;

// Returns where an item comes from; NULL: unknown.
const CagItemSource *cag_session_item_source(const CagSession *s, const CagItem *item);
// Returns the type of an item for hosts, such as "solid".
const char *cag_session_item_type(const CagItem *item);
// Makes the mesh of an item, as cag_session_part_mesh does, within a call that has begun. `shape`
// is what the item shows; NULL: unknown, or an operand.
int cag_session_item_mesh(CagSession *s, const CagItem *item, const CagShape *shape, double coarse,
                          bool (*has)(void *context, const char *id), void *context,
                          CagMeshView *out);

#endif
