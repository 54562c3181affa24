// What the readers of mesh formats share: a mesh as it grows, and the places of errors.
//
// Invariants of a draft: every index is below vertex_count; normals and uv, where there are, have
// an element for each vertex. A normal of zero length is one that the file did not say.

#ifndef CAG_INTERP_FORMATS_MESH_DRAFT_H
#define CAG_INTERP_FORMATS_MESH_DRAFT_H

#include "interp/formats/mesh_read.h"

typedef struct CagMeshDraft {
  const CagMeshFile *file;
  CagVec3 *positions, *normals;
  double *uv;
  uint32_t *triangles;
  size_t vertex_count, triangle_count;
  size_t vertex_room, triangle_room;
  size_t taken; // bytes, against the file's max_memory
} CagMeshDraft;

void cag_draft_free(CagMeshDraft *d);
// Counts `bytes` against the memory that may be taken, before it is: CAG_E_MEMORY.
CagStatus cag_draft_take(CagMeshDraft *d, size_t count, size_t bytes_each, CagError *err);
// Room for n vertices in all, with normals and parameters of zero where wanted.
CagStatus cag_draft_vertices(CagMeshDraft *d, size_t n, bool normals, bool uv, CagError *err);
// Room for n triangles more; fails where the triangles would be more than are allowed.
CagStatus cag_draft_triangles(CagMeshDraft *d, size_t n, CagError *err);
static inline void cag_draft_triangle(CagMeshDraft *d, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *t = d->triangles + 3 * d->triangle_count++;
  t[0] = a;
  t[1] = b;
  t[2] = c;
}
// A polygon of any count of corners; fewer than three are no face. Concave ones are taken apart
// well; those without area or that cross themselves as fans, so that their neighbors stay closed.
CagStatus cag_draft_polygon(CagMeshDraft *d, const uint32_t *corners, size_t n, CagError *err);
// Whether the run was interrupted; to be asked every so many elements.
CagStatus cag_draft_check(const CagMeshDraft *d, CagError *err);
#define CAG_DRAFT_CHECK_STEP 65536

// The draft as a mesh.
CagStatus cag_draft_finish(CagMeshDraft *d, CagMesh **out, CagError *err);

// "part.stl, line 12: ..." for a place in the text of the file; "part.stl, byte 84: ..." for one in
// a binary file; NULL: "part.stl: ...".
CagStatus cag_mesh_file_fail_line(const CagMeshFile *f, CagError *err, CagErrorId id,
                                  const char *at, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
#define cag_mesh_file_fail_line(...) cag_never_ok((cag_mesh_file_fail_line)(__VA_ARGS__))
CagStatus cag_mesh_file_fail_byte(const CagMeshFile *f, CagError *err, CagErrorId id,
                                  const char *at, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
#define cag_mesh_file_fail_byte(...) cag_never_ok((cag_mesh_file_fail_byte)(__VA_ARGS__))

// The readers, one a format.
typedef CagStatus CagMeshReader(CagMeshDraft *d, CagError *err);
CagMeshReader cag_read_stl, cag_read_obj, cag_read_ply, cag_read_gltf;
// Are the bytes a binary STL of exactly the length that it says?
bool cag_stl_is_binary(const CagMeshFile *f);

// Little-endian numbers of a file.
static inline uint32_t cag_read_u32(const void *at) {
  const unsigned char *b = at;
  return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

#endif
