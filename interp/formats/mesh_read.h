// Reading of mesh files: STL, OBJ, PLY, glTF, and GLB become one mesh in millimeters with Z up.
//
// A file is given as bytes in memory. Sizes in its header are checked against them before memory is
// allocated. For glTF, meters with Y up are converted; the other formats have no unit and are not
// converted. Vertices with identical coordinates become one point of the mesh (CagMesh.weld), and
// triangles that contain a point twice are omitted. Normals and parameters are kept if the file
// contains them.

#ifndef CAG_INTERP_FORMATS_MESH_READ_H
#define CAG_INTERP_FORMATS_MESH_READ_H

#include "geom/mesh/mesh.h"

typedef struct CagMeshFile {
  const char *name;  // for messages; its extension helps to detect the format
  const char *bytes; // bytes[size] is 0
  size_t size;
  size_t max_triangles;          // 0: unlimited
  size_t max_memory;             // bytes that reading may allocate in addition to the file
  const volatile int *interrupt; // NULL: none
  // Reads a file that this one refers to, by the path as written there. The bytes are as above,
  // allocated with malloc. NULL: there are no such files.
  CagStatus (*open)(void *context, const char *path, char **bytes, size_t *size, CagError *err);
  void *context;
} CagMeshFile;

// Fails with CAG_E_ARGUMENT and one of the reasons
//   "mesh-file-kind"         unknown format
//   "mesh-file-truncated"    shorter than its header states
//   "mesh-file-syntax"       syntax error
//   "mesh-file-index"        index of a missing vertex or part
//   "mesh-file-number"       coordinate that is not finite
//   "mesh-file-unsupported"  unsupported feature that affects the mesh
//   "mesh-file-empty"        no triangles
// or with CAG_E_LIMIT "triangle-limit", CAG_E_MEMORY, or CAG_E_CALLBACK (interrupted, or `open`
// failed). The invalid argument is `path`.
CagStatus cag_mesh_read(const CagMeshFile *f, CagMesh **out, CagError *err);

#endif
