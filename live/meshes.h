// The meshes that pages can ask for, by identity. Those of the last scene are kept, and others up to
// a limit, the least recently used leave first.

#ifndef CAG_LIVE_MESHES_H
#define CAG_LIVE_MESHES_H

#include <stdbool.h>
#include <stddef.h>

typedef struct CagMeshes CagMeshes;

CagMeshes *cag_meshes_new(size_t most_bytes);
void cag_meshes_free(CagMeshes *m);
// Starts another scene: the meshes that are looked up or kept from now on belong to it.
void cag_meshes_begin_scene(CagMeshes *m);
bool cag_meshes_has(CagMeshes *m, const char *id);
// Takes over the bytes, which are malloc'd. Returns false, and frees them, if memory ran out.
bool cag_meshes_keep(CagMeshes *m, const char *id, unsigned char *bytes, size_t size);
// A copy of the bytes, malloc'd, or NULL if the mesh is not there.
unsigned char *cag_meshes_copy(CagMeshes *m, const char *id, size_t *size);

#endif
