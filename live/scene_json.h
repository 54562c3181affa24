// What a page needs to know of a run, as JSON: for the server, and for the program in the browser.

#ifndef CAG_LIVE_SCENE_JSON_H
#define CAG_LIVE_SCENE_JSON_H

#include "cag.h"
#include "live/json_write.h"

// A mesh for the page as bytes: eight numbers of 32 bits (a mark, version 1, counts of vertices,
// triangles, and edges, and flags), positions and normals as 32-bit floats, and the indices of
// triangles, labels, and edges. *out is malloc'd. Returns false if memory ran out.
bool cag_live_mesh_bytes(const CagMeshView *m, unsigned char **out, size_t *size);

// Where the meshes of a scene go. `keep` is called for each mesh that `has` does not know.
typedef struct CagLiveMeshes {
  bool (*has)(void *context, const char *id);
  bool (*keep)(void *context, const CagMeshView *mesh); // false: memory ran out
  void *context;
} CagLiveMeshes;

typedef struct CagLiveModel {
  int run;            // its number
  const char *script; // path of the script below the folder
  const char *folder; // an absolute path
  double coarse;      // the tolerance of meshes is so many times larger
} CagLiveModel;

// Adds the scene of the last run to a JSON text, and makes its meshes. Returns a status; the text
// is only complete if it is CAG_STATUS_OK.
int cag_live_scene(CagSession *s, const CagLiveModel *model, const CagLiveMeshes *meshes,
                   CagString *out);

// What a run printed and complained about, the values of definitions, and, if it failed, the params.
typedef struct CagLiveRun {
  int run, status;
  double seconds;
  const char *prints;
} CagLiveRun;
void cag_live_messages(CagSession *s, const CagLiveRun *run, CagString *out);

#endif
