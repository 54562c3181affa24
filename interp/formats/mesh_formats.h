// Writers of mesh files: OBJ with its MTL, binary STL, binary PLY, glTF and binary glTF (GLB), and
// 3MF.
//
// A file is written from parts, each a mesh with a name and a material, to an open output file.
// Write errors remain in the file until its commit. Triangles that degenerate in the single
// precision of a format are omitted, except in OBJ; their neighbors then close the gap. In OBJ,
// STL, PLY, and 3MF, lengths are in millimeters, and Z is up. In glTF, the vertices are the same,
// and the root node converts them to meters with Y up. Parts that are copies of another part are
// written as instances in glTF and 3MF.

#ifndef CAG_INTERP_FORMATS_MESH_FORMATS_H
#define CAG_INTERP_FORMATS_MESH_FORMATS_H

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

typedef struct CagMeshPart {
  const char *name; // of the object, UTF-8
  const CagMesh *mesh;
  const CagMaterial *material;
} CagMeshPart;

// Writes one object per part. Vertices are shared across seams and creases (`v` by `weld`), normals
// and parameters are not (`vn`, `vt`). material_file: the name for `mtllib`, a file in the same
// folder; NULL: no materials.
CagStatus cag_export_obj(const CagMeshPart *parts, size_t n, const char *material_file,
                         CagAtomicFile *file, CagError *err);
// Writes the materials of the parts, each once, with colors in sRGB, which viewers expect, and the
// physically based `Pr`, `Pm`, and `Pc`.
CagStatus cag_export_mtl(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);
// Writes all parts as one list of triangles with flat normals. `title` goes into the header (NULL:
// the program's).
CagStatus cag_export_stl(const CagMeshPart *parts, size_t n, const char *title, CagAtomicFile *file,
                         CagError *err);
// Writes one welded mesh. Each point is one vertex, so its normal at a crease is the mean of the
// normals there, and its parameters at a seam are the first ones. Colors are 8-bit sRGB.
CagStatus cag_export_ply(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);
// Writes glTF 2.0: a node for each part, a mesh for each part that is not a copy, and
// metallic-roughness materials with the Khronos extensions for ior, transmission, clear coat, and
// strong emission if needed.
CagStatus cag_export_glb(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);
// The data of a .gltf file, to be written to a separate file. Release name and bytes with free.
typedef struct CagGltfData {
  char *name; // "part-0123456789abcdef.bin", as in the JSON; NULL: no data
  char *bytes;
  size_t size;
} CagGltfData;

// Writes the same as JSON. `stem` is the start of the name of the data file, which ends with a hash
// of its contents, so that a JSON file never refers to another version of its data. NULL: the data
// are included in the JSON.
CagStatus cag_export_gltf(const CagMeshPart *parts, size_t n, const char *stem, CagAtomicFile *file,
                          CagGltfData *data, CagError *err);
// Writes 3MF (core specification): an object for each part, closed ones as models and open ones as
// surfaces, with colors as base materials.
CagStatus cag_export_3mf(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);

#endif
