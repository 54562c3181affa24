// Mesh files of other programs: STL, OBJ, PLY, glTF and GLB as one mesh in millimeters with Z up.
//
// A file is the bytes of it, already in memory; what it says about itself is checked against them
// before memory is taken for it. glTF's meters with Y up become ours; the other formats say no
// lengths and are taken as they are. Points at one place (the same bits) are one point of the mesh
// (CagMesh.weld), triangles that have such a point twice are left out. Normals and parameters are
// kept where a file has them.

#ifndef CAG_INTERP_FORMATS_MESH_READ_H
#define CAG_INTERP_FORMATS_MESH_READ_H

#include "geom/mesh/mesh.h"

typedef struct CagMeshFile {
  const char *name;  // for messages; its ending helps to tell the format
  const char *bytes; // bytes[size] is 0
  size_t size;
  size_t max_triangles;          // 0: any
  size_t max_memory;             // bytes that reading may take beside those of the file
  const volatile int *interrupt; // NULL: none
  // Reads a file that this one names (its path as written there). Bytes as above, from malloc.
  // NULL: there are no such files.
  CagStatus (*open)(void *context, const char *path, char **bytes, size_t *size, CagError *err);
  void *context;
} CagMeshFile;

// Fails with CAG_E_ARGUMENT and one of the reasons
//   "mesh-file-kind"         no format that is known
//   "mesh-file-truncated"    it ends before what it says it holds
//   "mesh-file-syntax"       something that its format has not at this place
//   "mesh-file-index"        the number of a vertex or part that is not there
//   "mesh-file-number"       a coordinate that is not finite
//   "mesh-file-unsupported"  a feature without which the mesh would be another one
//   "mesh-file-empty"        no triangles
// and with CAG_E_LIMIT "triangle-limit", CAG_E_MEMORY, CAG_E_CALLBACK (interrupted, or `open`
// failed). The argument at fault is `path`.
CagStatus cag_mesh_read(const CagMeshFile *f, CagMesh **out, CagError *err);

#endif
