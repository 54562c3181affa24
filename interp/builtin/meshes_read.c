// Meshes from files.

#include <string.h>

#include "base/memory.h"
#include "interp/builtin/shapes.h"
#include "interp/formats/mesh_read.h"
#include "interp/vm/vm.h"

static const char meshes[] = "Meshes";

typedef struct Opener {
  CagCall *call;
  const char *path; // of the mesh, whose folder other files lie in
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

// Files that a mesh names are files of the script: the same places, the same limits. The reader of
// the mesh holds memory of its own, so exhausted memory must not jump over it.
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

static bool call_read_mesh(CagCall *call, CagValue *result) {
  const char *path;
  char *bytes;
  size_t size;
  if (!cag_arg_text(call, 0, &path) || !cag_vm_open_file(call, 0, path, &bytes, &size))
    return false;
  cag_hold(call, bytes);
  Opener opener = {call, path};
  const char *slash = strrchr(path, '/');
  const size_t left = cag_account_room();
  CagMeshFile file = {.name = slash ? slash + 1 : path,
                      .bytes = bytes,
                      .size = size,
                      .max_triangles = call->vm->max_triangles,
                      .max_memory = left,
                      .interrupt = cag_vm_stop(call->vm),
                      .open = open_beside,
                      .context = &opener};
  CagMesh *m = NULL;
  CagError err = {0};
  CagStatus status = cag_mesh_read(&file, &m, &err);
  cag_release_held(call, bytes); // before the mesh has its value
  if (!cag_geometry_ok(call, status, &err)) return false;
  *result = cag_mesh_value(call->vm, m);
  return true;
}

const CagBuiltin cag_builtins_mesh_files[] = {
    {"read_mesh(path: text)", call_read_mesh, "mesh",
     "Reads all parts of a file as one mesh: STL (binary and text), OBJ, PLY (binary and text), "
     "glTF, and GLB. Lengths are millimeters, and Z is up. For glTF, meters with Y up are "
     "converted. Coincident points become one vertex; normals and texture parameters are kept. "
     "Errors state the line or byte of the file. The file must be in the script's folder, below "
     "it, or on the module path.",
     "print attempt(() => read_mesh(\"none.stl\"), err => err.reason) // expect: file", 0, meshes},
    {0}};
