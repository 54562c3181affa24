// Meshes as mesh2: vertex_vectors, normal_vectors, face_indices.
//
// Numbers are written with a fixed number of decimals that depends on the size of the mesh: 1e-8 of
// it for positions, and 1e-5 for normals. This is finer than the renderer's resolution, and several
// times faster than the shortest form of numbers.
//
// The renderer stores vertices in single precision. Far from the origin, neighboring triangles
// would not quite meet, and rays would pass between them. So such a mesh is written relative to a
// point near its center, and translated.

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "interp/formats/pov_write.h"
#include "interp/scene/item_mesh.h"

#define NORMAL_DECIMALS 5
// Largest scaled value that is written through 64-bit integers.
#define INTEGER_MAX 9e17

static const double powers_of_ten[] = {1e0, 1e1, 1e2, 1e3,  1e4,  1e5, 1e6,
                                       1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
#define DECIMALS_MAX 12

static char *put_unsigned(char *at, uint64_t x) {
  char digits[20];
  int n = 0;
  do digits[n++] = (char)('0' + x % 10);
  while (x /= 10);
  while (n > 0) *at++ = digits[--n];
  return at;
}

// Writes x with at most `decimals` decimals, without trailing zeros. |x| * 10^decimals <
// INTEGER_MAX.
static char *put_fixed(char *at, double x, int decimals) {
  int64_t scaled = llround(x * powers_of_ten[decimals]);
  if (scaled < 0) *at++ = '-';
  uint64_t value = scaled < 0 ? (uint64_t)-scaled : (uint64_t)scaled;
  uint64_t one = (uint64_t)powers_of_ten[decimals];
  at = put_unsigned(at, value / one);
  uint64_t rest = value % one;
  if (rest == 0) return at;
  while (rest % 10 == 0) rest /= 10, decimals--;
  *at++ = '.';
  for (int i = decimals - 1; i >= 0; i--) {
    at[i] = (char)('0' + rest % 10);
    rest /= 10;
  }
  return at + decimals;
}

#define VECTOR_ROOM 96 // three numbers of at most 22 characters, with separators
#define VECTORS_PER_LINE 4
#define FACES_PER_LINE 8

static void write_vectors(CagPovWriter *w, const char *word, const CagVec3 *v, size_t n,
                          CagVec3 origin, int decimals) {
  cag_pov_printf(w, "  %s {\n    %zu", word, n);
  for (size_t i = 0; i < n && !cag_stopped(); i++) {
    char *at = cag_atomic_file_reserve(w->file, VECTOR_ROOM);
    *at++ = ',';
    if (i % VECTORS_PER_LINE == 0) memcpy(at, "\n    ", 5), at += 5;
    *at++ = '<';
    at = put_fixed(at, v[i].x - origin.x, decimals);
    *at++ = ',';
    at = put_fixed(at, v[i].y - origin.y, decimals);
    *at++ = ',';
    at = put_fixed(at, v[i].z - origin.z, decimals);
    *at++ = '>';
    cag_atomic_file_advance(w->file, at);
  }
  cag_pov_text(w, "\n  }\n");
}

static void write_faces(CagPovWriter *w, const CagMesh *m) {
  cag_pov_printf(w, "  face_indices {\n    %zu", m->triangle_count);
  for (size_t i = 0; i < m->triangle_count && !cag_stopped(); i++) {
    const uint32_t *t = m->triangles + 3 * i;
    char *at = cag_atomic_file_reserve(w->file, VECTOR_ROOM);
    *at++ = ',';
    if (i % FACES_PER_LINE == 0) memcpy(at, "\n    ", 5), at += 5;
    *at++ = '<';
    at = put_unsigned(at, t[0]);
    *at++ = ',';
    at = put_unsigned(at, t[1]);
    *at++ = ',';
    at = put_unsigned(at, t[2]);
    *at++ = '>';
    cag_atomic_file_advance(w->file, at);
  }
  cag_pov_text(w, "\n  }\n");
}

// The distance from the origin, in radii of the mesh, from which it is written relative to its
// center. Single precision is then at least twice as fine.
#define FAR_RADII 2

// Returns the point relative to which the mesh is written: the origin, or a point near the center
// of a mesh far from it. It is a multiple of a power of ten, so that few digits are needed.
static CagVec3 mesh_origin(const CagMesh *m) {
  const CagBounds b = cag_mesh_bounds(m);
  const double radius = cag_norm(cag_sub(b.max, b.min)) / 2;
  const CagVec3 middle = cag_lerp(b.min, b.max, 0.5);
  if (!(radius > 0) || cag_norm(middle) < FAR_RADII * radius) return cag_vec3(0, 0, 0);
  const double unit = pow(10, floor(log10(radius)));
  return cag_vec3(cag_pov_round(middle.x, unit), cag_pov_round(middle.y, unit),
                  cag_pov_round(middle.z, unit));
}

// Returns the number of decimals that resolve 1e-8 of the largest coordinate.
static int position_decimals(const CagMesh *m, CagVec3 origin) {
  double largest = 0;
  for (size_t i = 0; i < m->vertex_count; i++) {
    CagVec3 p = cag_sub(m->positions[i], origin);
    largest = fmax(largest, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
  }
  if (largest == 0) return 0;
  int decimals = 8 - (int)floor(log10(largest));
  return decimals < 0 ? 0 : decimals > DECIMALS_MAX ? DECIMALS_MAX : decimals;
}

// Writes the values of the vertices as positions in the pattern of colors. They use the middle half
// of 0..1, where the pattern does not repeat, so that values outside of the scale get the colors of
// its ends.
static void write_scale_places(CagPovWriter *w, const CagMesh *m) {
  const int decimals = 7;
  const CagColorScale *s = &m->scale;
  cag_pov_printf(w, "  uv_vectors {\n    %zu", m->vertex_count);
  for (size_t i = 0; i < m->vertex_count && !cag_stopped(); i++) {
    char *at = cag_atomic_file_reserve(w->file, VECTOR_ROOM);
    double t = (m->uv[2 * i] - s->from) / (s->to - s->from);
    double place = isnan(t) ? 0.5 : fmin(fmax(pov_scale_place(t), 0), 1 - POV_SCALE_EDGE);
    *at++ = ',';
    if (i % VECTORS_PER_LINE == 0) memcpy(at, "\n    ", 5), at += 5;
    *at++ = '<';
    at = put_fixed(at, place, decimals);
    memcpy(at, ",0>", 3);
    cag_atomic_file_advance(w->file, at + 3);
  }
  cag_pov_text(w, "\n  }\n");
}

// Writes the parts of a mesh with several materials, each with its own material.
static CagStatus write_parts(CagPovWriter *w, const CagMesh *m, CagError *err) {
  size_t *materials, count;
  CagStatus status = cag_item_materials(w->item, &materials, &count, err);
  cag_pov_text(w, "union {\n");
  for (size_t i = 0; !status && i < count; i++) {
    CagMesh *part = NULL;
    char material[64];
    status = cag_item_mesh_of(w->item, m, materials[i], &part, err);
    if (status || part->triangle_count == 0) {
      cag_mesh_release(part);
      continue;
    }
    cag_pov_text(w, "object {\n");
    status = cag_pov_mesh(w, part, err);
    cag_mesh_release(part);
    cag_pov_material_name(w, materials[i], true, material);
    cag_pov_printf(w, "\n  material { %s }\n}\n", material);
  }
  cag_free(materials);
  cag_pov_text(w, "}");
  return status;
}

static void write_triangles(CagPovWriter *w, const CagMesh *m, CagVec3 origin, int decimals) {
  const CagVec3 none = {0, 0, 0};
  cag_pov_printf(w, "mesh2 { // %zu triangles\n", m->triangle_count);
  write_vectors(w, "vertex_vectors", m->positions, m->vertex_count, origin, decimals);
  if (m->normals)
    write_vectors(w, "normal_vectors", m->normals, m->vertex_count, none, NORMAL_DECIMALS);
  if (m->scale.kind && m->uv) write_scale_places(w, m);
  write_faces(w, m);
  // Any direction that is unlikely to lie in a face.
  if (w->in_operation) cag_pov_text(w, "  inside_vector <0.3071, 0.2117, 0.9278>\n");
  CagTransform place = cag_transform_identity();
  place.m[0][3] = origin.x;
  place.m[1][3] = origin.y;
  place.m[2][3] = origin.z;
  cag_pov_placement(w, "  ", &place);
  cag_pov_text(w, "}");
}

CagStatus cag_pov_mesh(CagPovWriter *w, const CagMesh *m, CagError *err) {
  if (m->labels && w->item && w->item->label_count && !w->in_operation)
    return write_parts(w, m, err);
  if (m->triangle_count == 0) { // a shape without area: declare its name as an invisible object
    cag_pov_text(w, "sphere { // nothing is seen of it: it has no area\n  0, 1\n"
                    "  no_image no_shadow no_reflection\n}");
    return CAG_OK;
  }
  const CagVec3 origin = mesh_origin(m);
  const int decimals = position_decimals(m, origin);
  const CagBounds b = cag_mesh_bounds(m);
  const double reach = fmax(cag_norm(cag_sub(b.min, origin)), cag_norm(cag_sub(b.max, origin)));
  if (!(reach * powers_of_ten[decimals] < INTEGER_MAX))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_mesh_empty, "", -1,
                    "the coordinates of the mesh are too large for the renderer");
  CagMesh *facing = NULL;
  CagStatus status = cag_pov_facing_mesh(w, m, &facing, err);
  if (status) return status;
  write_triangles(w, facing, origin, decimals);
  cag_mesh_release(facing);
  return CAG_OK;
}
