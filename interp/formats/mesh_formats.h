// Meshes as files for other programs: OBJ with its MTL, binary STL, binary PLY, glTF and binary
// glTF (GLB), 3MF.
//
// A file is written from parts, each a mesh with a name and a material, to an open output file;
// errors of writing stay in the file until its commit. Triangles that the single precision of a
// format shrinks to an edge or a point are left out of all but OBJ (their neighbors close the
// place). Lengths are millimeters, Z up, in OBJ, STL, PLY and 3MF; glTF keeps them in its vertices,
// and its root node turns them into meters and Y up. Parts that are copies of another are written
// as such in glTF and 3MF.

#ifndef CAG_INTERP_FORMATS_MESH_FORMATS_H
#define CAG_INTERP_FORMATS_MESH_FORMATS_H

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

typedef struct CagMeshPart {
  const char *name; // of the object, UTF-8
  const CagMesh *mesh;
  const CagMaterial *material;
} CagMeshPart;

// One object a part, its vertices shared across seams and creases (`v` by `weld`), normals and
// parameters of its own (`vn`, `vt`). material_file: the name to put in `mtllib`, beside the file;
// NULL: no materials.
CagStatus cag_export_obj(const CagMeshPart *parts, size_t n, const char *material_file,
                         CagAtomicFile *file, CagError *err);
// The materials of the parts, each once: colors in sRGB as viewers take them, and the physical
// `Pr`, `Pm`, `Pc`.
CagStatus cag_export_mtl(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);
// All parts in one list of triangles with their flat normals. `title` goes into the header (NULL:
// the program's).
CagStatus cag_export_stl(const CagMeshPart *parts, size_t n, const char *title, CagAtomicFile *file,
                         CagError *err);
// One welded mesh: a point is one vertex, so its normal at a crease is the mean of those there, and
// its parameters at a seam are the first. Colors are 8-bit sRGB.
CagStatus cag_export_ply(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);
// glTF 2.0: a node each part, a mesh each part that is no copy, metallic-roughness materials with
// the Khronos extensions for ior, transmission, clear coat and strong emission where a material has
// them.
CagStatus cag_export_glb(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);
// The data of a .gltf file, for a file beside it. Release name and bytes with free.
typedef struct CagGltfData {
  char *name; // "part-0123456789abcdef.bin": what the JSON refers to; NULL: there is no data
  char *bytes;
  size_t size;
} CagGltfData;

// The same as JSON. stem: begins the name of the data, which ends with a hash of its content, so
// that no JSON ever stands beside data that is not its own; NULL: the data is in the JSON itself.
CagStatus cag_export_gltf(const CagMeshPart *parts, size_t n, const char *stem, CagAtomicFile *file,
                          CagGltfData *data, CagError *err);
// 3MF, core specification: an object each part, closed ones as models and open ones as surfaces,
// colors as base materials.
CagStatus cag_export_3mf(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);

#endif
