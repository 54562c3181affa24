// Internals of the readers of mesh formats: a growing mesh, and the locations of errors.
//
// Invariants of a draft: every index is below vertex_count; normals and uv, if present, have an
// element for each vertex. A normal of zero length is missing in the file.

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
  size_t taken; // bytes, counted against the file's max_memory
} CagMeshDraft;

void cag_draft_free(CagMeshDraft *d);
// Counts bytes against the memory limit before they are allocated. Fails with CAG_E_MEMORY.
CagStatus cag_draft_take(CagMeshDraft *d, size_t count, size_t bytes_each, CagError *err);
// Makes room for n vertices in total, with zero normals and parameters if requested.
CagStatus cag_draft_vertices(CagMeshDraft *d, size_t n, bool normals, bool uv, CagError *err);
// Makes room for n more triangles. Fails if they would exceed the limit.
CagStatus cag_draft_triangles(CagMeshDraft *d, size_t n, CagError *err);
static inline void cag_draft_triangle(CagMeshDraft *d, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *t = d->triangles + 3 * d->triangle_count++;
  t[0] = a;
  t[1] = b;
  t[2] = c;
}
// Adds a polygon with any number of corners; fewer than three are not a face. Concave polygons are
// triangulated. Degenerate and self-intersecting ones become fans, so that their neighbors stay
// closed.
CagStatus cag_draft_polygon(CagMeshDraft *d, const uint32_t *corners, size_t n, CagError *err);
// Fails if the run was interrupted. To be called every CAG_DRAFT_CHECK_STEP elements.
CagStatus cag_draft_check(const CagMeshDraft *d, CagError *err);
#define CAG_DRAFT_CHECK_STEP 65536

// Converts the draft to a mesh.
CagStatus cag_draft_finish(CagMeshDraft *d, CagMesh **out, CagError *err);

// Fails with "part.stl, line 12: ..." for a location in a text file, "part.stl, byte 84: ..." for
// one in a binary file, or "part.stl: ..." for NULL.
CagStatus cag_mesh_file_fail_line(const CagMeshFile *f, CagError *err, CagErrorId id,
                                  const char *at, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
#define cag_mesh_file_fail_line(...) cag_never_ok((cag_mesh_file_fail_line)(__VA_ARGS__))
CagStatus cag_mesh_file_fail_byte(const CagMeshFile *f, CagError *err, CagErrorId id,
                                  const char *at, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
#define cag_mesh_file_fail_byte(...) cag_never_ok((cag_mesh_file_fail_byte)(__VA_ARGS__))

// A reader of one format.
typedef CagStatus CagMeshReader(CagMeshDraft *d, CagError *err);
CagMeshReader cag_read_stl, cag_read_obj, cag_read_ply, cag_read_gltf;
// Tests whether the bytes are a binary STL whose length matches its header.
bool cag_stl_is_binary(const CagMeshFile *f);

// Read little-endian numbers.
static inline uint32_t cag_read_u32(const void *at) {
  const unsigned char *b = at;
  return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

#endif
