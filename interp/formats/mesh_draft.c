// Internals of the readers of mesh formats: a growing mesh, and the locations of errors.
//
// Finishing a draft finds coincident vertices by a hash of their coordinates, removes triangles
// that are thereby degenerate, and removes unused vertices. Coincident vertices without attributes
// are merged. Those with normals or parameters are kept and welded.

#include "interp/formats/mesh_draft.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/mesh/polygon.h"
#include "interp/formats/tangle.h"

#define NO_VERTEX UINT32_MAX

// --- Errors ---

static CagStatus fail_with(const CagMeshFile *f, CagError *err, CagErrorId id, const char *place,
                           const char *format, va_list arguments) {
  char message[280];
  vsnprintf(message, sizeof message, format, arguments);
  return cag_fail(err, CAG_E_ARGUMENT, id, "path", -1, "%.80s%s: %s", f->name, place, message);
}

CagStatus(cag_mesh_file_fail_line)(const CagMeshFile *f, CagError *err, CagErrorId id,
                                   const char *at, const char *format, ...) {
  char place[40] = "";
  size_t line = 1;
  for (const char *s = f->bytes; at && s < at; s++) line += *s == '\n';
  if (at) snprintf(place, sizeof place, ", line %zu", line);
  va_list arguments;
  va_start(arguments, format);
  CagStatus status = fail_with(f, err, id, place, format, arguments);
  va_end(arguments);
  return status;
}

CagStatus(cag_mesh_file_fail_byte)(const CagMeshFile *f, CagError *err, CagErrorId id,
                                   const char *at, const char *format, ...) {
  char place[40] = "";
  if (at) snprintf(place, sizeof place, ", byte %zu", (size_t)(at - f->bytes));
  va_list arguments;
  va_start(arguments, format);
  CagStatus status = fail_with(f, err, id, place, format, arguments);
  va_end(arguments);
  return status;
}

CagStatus cag_draft_check(const CagMeshDraft *d, CagError *err) {
  if (!d->file->interrupt || !*d->file->interrupt) return CAG_OK;
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1, "reading was interrupted");
}

// --- Growing ---

void cag_draft_free(CagMeshDraft *d) {
  cag_free(d->positions);
  cag_free(d->normals);
  cag_free(d->uv);
  cag_free(d->triangles);
}

CagStatus cag_draft_take(CagMeshDraft *d, size_t count, size_t bytes_each, CagError *err) {
  size_t left = d->file->max_memory - d->taken;
  if (bytes_each > 0 && count > left / bytes_each) return cag_fail_memory(err);
  d->taken += count * bytes_each;
  return CAG_OK;
}

// Grows *items, NULL or an array of `before` elements, to n elements, and zeroes the new ones.
static bool grow(void **items, size_t before, size_t n, size_t size) {
  if (!*items) before = 0;
  char *larger = cag_realloc(*items, (n + 1) * size);
  if (!larger) return false;
  memset(larger + before * size, 0, (n - before) * size);
  *items = larger;
  return true;
}

CagStatus cag_draft_vertices(CagMeshDraft *d, size_t n, bool normals, bool uv, CagError *err) {
  if (n >= NO_VERTEX)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_mesh_too_large, "path", -1,
                    "%.80s: a mesh can have at most %lu vertices, but the file has %zu",
                    d->file->name, (unsigned long)NO_VERTEX - 1, n);
  size_t room = n > d->vertex_room ? n : d->vertex_room;
  size_t each = sizeof *d->positions + (normals || d->normals ? sizeof *d->normals : 0) +
                (uv || d->uv ? 2 * sizeof *d->uv : 0);
  CagStatus status = cag_draft_take(d, room - d->vertex_room, each, err);
  if (status) return status;
  bool done = room == d->vertex_room ||
              grow((void **)&d->positions, d->vertex_room, room, sizeof *d->positions);
  if (done && (d->normals ? room > d->vertex_room : normals))
    done = grow((void **)&d->normals, d->vertex_room, room, sizeof *d->normals);
  if (done && (d->uv ? room > d->vertex_room : uv))
    done = grow((void **)&d->uv, d->vertex_room, room, 2 * sizeof *d->uv);
  d->vertex_room = done ? room : d->vertex_room;
  return done ? CAG_OK : cag_fail_memory(err);
}

CagStatus cag_draft_triangles(CagMeshDraft *d, size_t n, CagError *err) {
  size_t most = d->file->max_triangles ? d->file->max_triangles : SIZE_MAX / 64;
  if (n > most || d->triangle_count > most - n)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "path", -1,
                    "%.80s has more than the %zu triangles allowed (--max-triangles)",
                    d->file->name, most);
  size_t wanted = d->triangle_count + n;
  if (wanted <= d->triangle_room) return CAG_OK;
  size_t room = d->triangle_room + d->triangle_room / 2;
  if (room < wanted) room = wanted;
  CagStatus status = cag_draft_take(d, room - d->triangle_room, 3 * sizeof *d->triangles, err);
  if (status) return status;
  if (!CAG_RESIZE(d->triangles, (room + 1) * 3)) return cag_fail_memory(err);
  d->triangle_room = room;
  return CAG_OK;
}

CagStatus cag_draft_polygon(CagMeshDraft *d, const uint32_t *corners, size_t n, CagError *err) {
  if (n < 3) return CAG_OK;
  CagStatus status = cag_draft_triangles(d, n - 2, err);
  if (status) return status;
  if (n == 3) {
    cag_draft_triangle(d, corners[0], corners[1], corners[2]);
    return CAG_OK;
  }
  status = cag_draft_check(d, err);
  if (status) return status;
  CagTangle tangle = cag_tangle_of(d->positions, corners, n);
  if (tangle == CAG_TANGLE_MEMORY) return cag_fail_memory(err);
  if (tangle == CAG_TANGLE_UNKNOWN)
    return cag_mesh_file_fail_byte(d->file, err, CAG_ERR_mesh_file_unsupported, NULL,
                                   "a face with %zu corners is too complex; write it as triangles",
                                   n);
  CagError poor;
  uint32_t *to = d->triangles + 3 * d->triangle_count;
  if (tangle == CAG_TANGLE_NONE) {
    status = cag_polygon_triangulate(d->positions, corners, n, 0, to, &poor);
    if (status == CAG_E_MEMORY) return cag_fail_memory(err);
    if (!status) {
      d->triangle_count += n - 2;
      return CAG_OK;
    }
  }
  for (size_t k = 1; k + 1 < n; k++) cag_draft_triangle(d, corners[0], corners[k], corners[k + 1]);
  return CAG_OK;
}

// --- Finishing ---

static uint64_t mix(uint64_t h) {
  h ^= h >> 33;
  h *= 0xff51afd7ed558ccdu; // constants of MurmurHash3's finisher
  h ^= h >> 33;
  h *= 0xc4ceb9fe1a85ec53u;
  return h ^ h >> 33;
}

static uint64_t bits_of(double x) {
  uint64_t bits;
  x += 0.0; // negative and positive zero are equal
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

static bool same_place(CagVec3 a, CagVec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Sets first[v] to the first vertex with v's position among those that triangles use, or NO_VERTEX
// if v is not used.
static CagStatus find_points(CagMeshDraft *d, uint32_t *first, CagError *err) {
  size_t size = 1024;
  while (size < d->vertex_count + d->vertex_count / 2) size *= 2;
  CagStatus status = cag_draft_take(d, size, sizeof(uint32_t), err);
  if (status) return status;
  uint32_t *slots = cag_malloc(size * sizeof *slots);
  if (!slots) return cag_fail_memory(err);
  memset(slots, 0xff, size * sizeof *slots);
  memset(first, 0xff, d->vertex_count * sizeof *first);
  for (size_t k = 0; k < 3 * d->triangle_count; k++) first[d->triangles[k]] = 0;
  for (size_t v = 0; v < d->vertex_count; v++) {
    if (first[v] == NO_VERTEX) continue;
    CagVec3 p = d->positions[v];
    uint64_t h = mix(mix(mix(bits_of(p.x)) ^ bits_of(p.y)) ^ bits_of(p.z));
    size_t at = h & (size - 1);
    while (slots[at] != NO_VERTEX && !same_place(d->positions[slots[at]], p))
      at = (at + 1) & (size - 1);
    if (slots[at] == NO_VERTEX) slots[at] = (uint32_t)v;
    first[v] = slots[at];
  }
  cag_free(slots);
  return CAG_OK;
}

// Removes the triangles that contain a point twice.
static void drop_shrunk(CagMeshDraft *d, const uint32_t *first) {
  size_t kept = 0;
  for (size_t t = 0; t < d->triangle_count; t++) {
    const uint32_t *k = d->triangles + 3 * t;
    uint32_t a = first[k[0]], b = first[k[1]], c = first[k[2]];
    if (a == b || b == c || c == a) continue;
    memmove(d->triangles + 3 * kept++, k, 3 * sizeof *k);
  }
  d->triangle_count = kept;
}

// Normalizes normals. Missing and zero normals are computed from the adjacent faces.
static CagStatus complete_normals(CagMeshDraft *d, CagError *err) {
  const double least = 1e-6; // shorter normals count as missing; files have unit normals
  CagStatus status = cag_draft_take(d, d->vertex_count + 1, sizeof(bool), err);
  if (status) return status;
  bool *said = cag_malloc(d->vertex_count + 1), all = true;
  if (!said) return cag_fail_memory(err);
  for (size_t v = 0; v < d->vertex_count; v++) {
    double length = cag_norm(d->normals[v]);
    said[v] = isfinite(length) && length > least;
    d->normals[v] = said[v] ? cag_scaled(d->normals[v], 1 / length) : cag_vec3(0, 0, 0);
    all &= said[v];
  }
  for (size_t t = 0; !all && t < d->triangle_count; t++) {
    const uint32_t *k = d->triangles + 3 * t;
    CagVec3 a = d->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(d->positions[k[1]], a), cag_sub(d->positions[k[2]], a));
    for (int j = 0; j < 3; j++)
      if (!said[k[j]]) d->normals[k[j]] = cag_add(d->normals[k[j]], n);
  }
  for (size_t v = 0; !all && v < d->vertex_count; v++) {
    double length = cag_norm(d->normals[v]);
    bool good = isfinite(length) && length > 0;
    if (!said[v]) d->normals[v] = good ? cag_scaled(d->normals[v], 1 / length) : cag_vec3(0, 0, 1);
  }
  cag_free(said);
  return CAG_OK;
}

// Removes the vertices that no triangle uses. first: from find_points, invalid afterwards. weld:
// for the remaining vertices; NULL for a mesh whose vertices are its points.
static void drop_unnamed(CagMeshDraft *d, const uint32_t *first, uint32_t *number, uint32_t *weld) {
  memset(number, 0xff, d->vertex_count * sizeof *number);
  for (size_t k = 0; k < 3 * d->triangle_count; k++) number[d->triangles[k]] = 0;
  size_t n = 0;
  for (size_t v = 0; v < d->vertex_count; v++) {
    if (number[v] == NO_VERTEX) continue;
    d->positions[n] = d->positions[v];
    if (d->normals) d->normals[n] = d->normals[v];
    if (d->uv) memmove(d->uv + 2 * n, d->uv + 2 * v, 2 * sizeof *d->uv);
    if (weld) weld[n] = first[v];
    number[v] = (uint32_t)n++;
  }
  for (size_t k = 0; k < 3 * d->triangle_count; k++) d->triangles[k] = number[d->triangles[k]];
  // A point is represented by its first remaining vertex.
  memset(number, 0xff, d->vertex_count * sizeof *number);
  for (size_t v = 0; weld && v < n; v++) {
    uint32_t *name = &number[weld[v]];
    if (*name == NO_VERTEX) *name = (uint32_t)v;
    weld[v] = *name;
  }
  d->vertex_count = n;
}

static CagStatus fail_empty(const CagMeshDraft *d, CagError *err) {
  return cag_mesh_file_fail_byte(
      d->file, err, CAG_ERR_mesh_file_empty, NULL,
      d->vertex_count > 0 ? "it has %zu vertices, but no triangle with an area; write it with faces"
                          : "it has no triangles; write it with faces",
      d->vertex_count);
}

// Welds the draft and removes unused parts. `first` and `number` have an element for each vertex.
static CagStatus tidy(CagMeshDraft *d, uint32_t *first, uint32_t *number, uint32_t **weld,
                      CagError *err) {
  CagStatus status = find_points(d, first, err);
  if (status) return status;
  drop_shrunk(d, first);
  if (d->triangle_count == 0) return fail_empty(d, err);
  bool points = !d->normals && !d->uv;
  if (points)
    for (size_t k = 0; k < 3 * d->triangle_count; k++) d->triangles[k] = first[d->triangles[k]];
  else if (!(*weld = cag_malloc((d->vertex_count + 1) * sizeof **weld)))
    return cag_fail_memory(err);
  drop_unnamed(d, first, number, *weld);
  return d->normals ? complete_normals(d, err) : CAG_OK;
}

CagStatus cag_draft_finish(CagMeshDraft *d, CagMesh **out, CagError *err) {
  if (d->triangle_count == 0) return fail_empty(d, err);
  const size_t arrays = 3;
  CagStatus status = cag_draft_take(d, d->vertex_count + 1, arrays * sizeof(uint32_t), err);
  if (status) return status;
  uint32_t *first = cag_malloc((d->vertex_count + 1) * sizeof *first), *weld = NULL;
  uint32_t *number = cag_malloc((d->vertex_count + 1) * sizeof *number);
  status = first && number ? tidy(d, first, number, &weld, err) : cag_fail_memory(err);
  cag_free(first);
  cag_free(number);
  CagMesh *m = NULL;
  if (!status) status = cag_mesh_new(0, 0, false, false, false, &m, err);
  if (status) {
    cag_free(weld);
    return status;
  }
  // The mesh takes over the arrays of the draft.
  cag_free(m->positions);
  cag_free(m->triangles);
  m->vertex_count = d->vertex_count;
  m->triangle_count = d->triangle_count;
  m->positions = d->positions;
  m->normals = d->normals;
  m->uv = d->uv;
  m->triangles = d->triangles;
  m->weld = weld;
  *d = (CagMeshDraft){.file = d->file};
  *out = m;
  return CAG_OK;
}
