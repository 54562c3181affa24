// Meshes from files.

#include <string.h>

#include "base/memory.h"
#include "interp/builtin/shapes.h"
#include "interp/formats/mesh_read.h"
#include "interp/vm/vm.h"

typedef struct Opener {
  CagCall *call;
  const char *path; // the path of the mesh, in whose folder the other files are
} Opener;

typedef struct Opening {
  CagCall *call;
  const char *path;
  char **bytes;
  size_t *size;
} Opening;

static bool open_file(CagVm *vm, void *context) {
  (void)vm;
  const Opening *o = context;
  return cag_vm_open_file(o->call, 0, o->path, o->bytes, o->size);
}

// The files that a mesh refers to are subject to the same rules and limits as files that the script
// reads. The mesh reader owns memory, so running out of memory must not jump past it.
static CagStatus open_beside(void *context, const char *name, char **bytes, size_t *size,
                             CagError *err) {
  const Opener *o = context;
  const char *slash = strrchr(o->path, '/');
  int folder = slash && name[0] != '/' ? (int)(slash + 1 - o->path) : 0;
  char *path;
  if (cag_asprintf(&path, "%.*s%s", folder, o->path, name) < 0) return cag_fail_memory(err);
  Opening opening = {o->call, path, bytes, size};
  const bool good = cag_vm_call_back(o->call->vm, open_file, &opening);
  cag_free(path);
  return good ? CAG_OK
              : cag_fail(err, CAG_E_CALLBACK, CAG_ERR_file, "path", -1, "cannot read %s", name);
}

bool cag_mesh_files_read_mesh(CagCall *call, const struct cag_mesh_files_read_mesh *a,
                              CagValue *result) {
  char *bytes;
  size_t size;
  if (!cag_vm_open_file(call, 0, a->path, &bytes, &size)) return false;
  cag_hold(call, bytes);
  Opener opener = {call, a->path};
  const char *slash = strrchr(a->path, '/');
  CagMeshFile file = {.name = slash ? slash + 1 : a->path,
                      .bytes = bytes,
                      .size = size,
                      .max_triangles = call->vm->max_triangles,
                      .max_memory = cag_account_room(),
                      .interrupt = cag_vm_stop(call->vm),
                      .open = open_beside,
                      .context = &opener};
  CagMesh *m = NULL;
  CagStatus status = cag_mesh_read(&file, &m, call->err);
  cag_release_held(call, bytes); // early, because creating the value may need the memory
  return cag_mesh_result(call, status, &m, result);
}
