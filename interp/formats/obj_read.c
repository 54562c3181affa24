// Reads Wavefront OBJ: points, parameters, normals, and polygons of all groups.
//
// A corner of a face refers to a point and optionally to parameters and a normal. Each such triple
// is a vertex of the mesh, found by a hash. Indices count from 1; negative ones count back from the
// last element read. A first pass counts, so that the arrays are allocated once. Curves, surfaces,
// groups, and materials are skipped.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/formats/mesh_draft.h"
#include "interp/formats/text_scan.h"

typedef struct Counts {
  size_t points, parameters, normals, faces;
} Counts;

// A corner as indices from 1; 0: none.
typedef struct Corner {
  uint32_t point, parameters, normal;
} Corner;

typedef struct Obj {
  CagMeshDraft *draft;
  CagTextScan scan;
  Counts all, read;
  CagVec3 *points, *normals;
  double *parameters;
  Corner *corners; // of each vertex of the draft
  uint32_t *slots; // hash of a corner -> its vertex + 1; 0: free
  size_t slot_count;
  uint32_t *face; // vertices of the current face
  size_t face_room;
} Obj;

static void count(Obj *o) {
  CagTextScan s = o->scan;
  while (cag_scan_to_word(&s)) {
    const char *word;
    size_t n = cag_scan_word(&s, &word);
    if (n == 1 && *word == 'v') o->all.points++;
    else if (n == 2 && !memcmp(word, "vt", 2)) o->all.parameters++;
    else if (n == 2 && !memcmp(word, "vn", 2)) o->all.normals++;
    else if (n == 1 && *word == 'f') o->all.faces++;
    if (*word == '#') // comments have no continuation lines
      while (s.at < s.end && *s.at != '\n' && *s.at != '\r') s.at++;
    cag_scan_blanks(&s);
    while (!cag_scan_at_line_end(&s)) cag_scan_word(&s, &word);
    cag_scan_next_line(&s);
  }
}

static CagStatus make_room(Obj *o, CagError *err) {
  const Counts *n = &o->all;
  if (n->points >= UINT32_MAX || n->parameters >= UINT32_MAX || n->normals >= UINT32_MAX)
    return cag_mesh_file_fail_line(o->draft->file, err, CAG_ERR_mesh_file_unsupported, NULL,
                                   "it has more than 4294967294 vertices; split it");
  CagStatus status = cag_draft_take(o->draft, n->points + n->normals, sizeof(CagVec3), err);
  if (!status) status = cag_draft_take(o->draft, n->parameters, 2 * sizeof(double), err);
  if (!status) status = cag_draft_triangles(o->draft, n->faces, err);
  if (status) return status;
  o->points = cag_calloc(n->points + 1, sizeof *o->points);
  o->normals = cag_calloc(n->normals + 1, sizeof *o->normals);
  o->parameters = cag_calloc(n->parameters + 1, 2 * sizeof *o->parameters);
  return o->points && o->normals && o->parameters ? CAG_OK : cag_fail_memory(err);
}

// --- Numbers of a line ---

static CagStatus read_numbers(Obj *o, double *x, int least, int most, CagError *err) {
  for (int k = 0; k < most; k++) x[k] = 0;
  for (int k = 0; k < most; k++) {
    if (k >= least && cag_scan_at_line_end(&o->scan)) return CAG_OK;
    if (!cag_scan_number(&o->scan, &x[k]))
      return cag_mesh_file_fail_line(o->draft->file, err, CAG_ERR_mesh_file_syntax, o->scan.at,
                                     "expected at least %d numbers in the line", least);
    if (!isfinite(x[k]))
      return cag_mesh_file_fail_line(o->draft->file, err, CAG_ERR_mesh_file_number, o->scan.at,
                                     "a coordinate is too large");
  }
  return CAG_OK;
}

static CagStatus read_point(Obj *o, CagError *err) {
  double x[3];
  CagStatus status = read_numbers(o, x, 3, 3, err);
  if (!status) o->points[o->read.points++] = cag_vec3(x[0], x[1], x[2]);
  return status;
}

static CagStatus read_parameters(Obj *o, CagError *err) {
  CagStatus status = read_numbers(o, o->parameters + 2 * o->read.parameters, 1, 2, err);
  o->read.parameters += !status;
  return status;
}

static CagStatus read_normal(Obj *o, CagError *err) {
  double x[3];
  CagStatus status = read_numbers(o, x, 3, 3, err);
  if (!status) o->normals[o->read.normals++] = cag_vec3(x[0], x[1], x[2]);
  return status;
}

// --- Faces ---

// `count`: of all in the file; `read`: so far.
static CagStatus read_index(Obj *o, size_t count, size_t read, const char *noun, uint32_t *out,
                            CagError *err) {
  int64_t k = 0;
  if (!cag_scan_integer(&o->scan, &k))
    return cag_mesh_file_fail_line(o->draft->file, err, CAG_ERR_mesh_file_syntax, o->scan.at,
                                   "expected the number of a %s in the face", noun);
  int64_t number = k < 0 ? (int64_t)read + 1 + k : k;
  if (number < 1 || (uint64_t)number > count)
    return cag_mesh_file_fail_line(
        o->draft->file, err, CAG_ERR_mesh_file_index, o->scan.at,
        "a face refers to %s %lld, but the file has %zu, and %zu before this line", noun,
        (long long)k, count, read);
  *out = (uint32_t)number;
  return CAG_OK;
}

static bool take_slash(Obj *o) {
  bool there = o->scan.at < o->scan.end && *o->scan.at == '/';
  o->scan.at += there;
  return there;
}

static bool at_number(const Obj *o) {
  char c = *o->scan.at;
  return c == '-' || c == '+' || (c >= '0' && c <= '9');
}

// p, p/t, p//n or p/t/n.
static CagStatus read_corner(Obj *o, Corner *c, CagError *err) {
  *c = (Corner){0};
  CagStatus status = read_index(o, o->all.points, o->read.points, "point", &c->point, err);
  if (status || !take_slash(o)) return status;
  if (at_number(o))
    status = read_index(o, o->all.parameters, o->read.parameters, "vt", &c->parameters, err);
  if (status || !take_slash(o)) return status;
  if (at_number(o)) status = read_index(o, o->all.normals, o->read.normals, "vn", &c->normal, err);
  return status;
}

static size_t hash(Corner c) {
  uint64_t h = c.point * 0x9e3779b97f4a7c15u ^ c.parameters * 0xc2b2ae3d27d4eb4fu ^
               c.normal * 0x165667b19e3779f9u; // odd constants of hash functions
  h ^= h >> 29;
  h *= 0xbf58476d1ce4e5b9u;
  return (size_t)(h ^ h >> 32);
}

static bool same(Corner a, Corner b) {
  return a.point == b.point && a.parameters == b.parameters && a.normal == b.normal;
}

static uint32_t *find_slot(Obj *o, Corner c) {
  size_t mask = o->slot_count - 1, at = hash(c) & mask;
  while (o->slots[at] && !same(o->corners[o->slots[at] - 1], c)) at = (at + 1) & mask;
  return &o->slots[at];
}

// Doubles the room for vertices and the hash.
static CagStatus grow(Obj *o, CagError *err) {
  CagMeshDraft *d = o->draft;
  size_t room = d->vertex_room ? 2 * d->vertex_room : 1024, slots = 2 * room;
  CagStatus status = cag_draft_take(d, room - d->vertex_room, sizeof(Corner) + 2 * 4, err);
  if (!status) status = cag_draft_vertices(d, room, o->all.normals > 0, o->all.parameters > 0, err);
  if (status) return status;
  const bool roomy = CAG_RESIZE(o->corners, room);
  uint32_t *larger = cag_calloc(slots, sizeof *larger);
  if (!roomy || !larger) {
    cag_free(larger);
    return cag_fail_memory(err);
  }
  cag_free(o->slots);
  o->slots = larger;
  o->slot_count = slots;
  for (size_t v = 0; v < d->vertex_count; v++) *find_slot(o, o->corners[v]) = (uint32_t)v + 1;
  return CAG_OK;
}

static CagStatus vertex_of(Obj *o, Corner c, uint32_t *out, CagError *err) {
  CagMeshDraft *d = o->draft;
  if (d->vertex_count == d->vertex_room) {
    CagStatus status = grow(o, err);
    if (status) return status;
  }
  uint32_t *slot = find_slot(o, c);
  if (!*slot) {
    size_t v = d->vertex_count++;
    *slot = (uint32_t)v + 1;
    o->corners[v] = c;
    // A point may come after the faces that refer to it, so positions are set at the end.
    d->positions[v] = cag_vec3(0, 0, 0);
  }
  *out = *slot - 1;
  return CAG_OK;
}

static CagStatus read_face(Obj *o, CagError *err) {
  CagStatus status = CAG_OK;
  size_t n = 0;
  while (!status && !cag_scan_at_line_end(&o->scan)) {
    Corner c;
    status = read_corner(o, &c, err);
    if (!status && n == o->face_room) {
      size_t room = n ? 2 * n : 64;
      status = cag_draft_take(o->draft, room - n, sizeof *o->face, err);
      if (!status && !CAG_RESIZE(o->face, room)) status = cag_fail_memory(err);
      if (status) return status;
      o->face_room = room;
    }
    if (!status) status = vertex_of(o, c, &o->face[n], err);
    if (status) break;
    // The triangulation needs the positions.
    if (c.point <= o->read.points) o->draft->positions[o->face[n]] = o->points[c.point - 1];
    n++;
  }
  return !status ? cag_draft_polygon(o->draft, o->face, n, err) : status;
}

// --- The file ---

static CagStatus read_line(Obj *o, const char *word, size_t n, CagError *err) {
  if (n == 1 && *word == 'v') return read_point(o, err);
  if (n == 1 && *word == 'f') return read_face(o, err);
  if (n == 2 && !memcmp(word, "vt", 2)) return read_parameters(o, err);
  if (n == 2 && !memcmp(word, "vn", 2)) return read_normal(o, err);
  return CAG_OK;
}

static CagStatus read_lines(Obj *o, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t line = 1; !status && cag_scan_to_word(&o->scan); line++) {
    const char *word;
    size_t n = cag_scan_word(&o->scan, &word);
    if (*word != '#') {
      status = read_line(o, word, n, err);
      while (!cag_scan_at_line_end(&o->scan)) cag_scan_word(&o->scan, &word);
    }
    cag_scan_next_line(&o->scan);
    if (!status && line % CAG_DRAFT_CHECK_STEP == 0) status = cag_draft_check(o->draft, err);
  }
  return status;
}

static void fill_vertices(Obj *o) {
  CagMeshDraft *d = o->draft;
  for (size_t v = 0; v < d->vertex_count; v++) {
    Corner c = o->corners[v];
    d->positions[v] = o->points[c.point - 1];
    if (c.normal) d->normals[v] = o->normals[c.normal - 1];
    if (c.parameters)
      memcpy(d->uv + 2 * v, o->parameters + 2 * (c.parameters - 1), 2 * sizeof *d->uv);
  }
}

CagStatus cag_read_obj(CagMeshDraft *d, CagError *err) {
  Obj o = {.draft = d, .scan = {d->file->bytes, d->file->bytes + d->file->size}};
  count(&o);
  CagStatus status = make_room(&o, err);
  if (!status) status = read_lines(&o, err);
  if (!status) fill_vertices(&o);
  cag_free(o.points);
  cag_free(o.normals);
  cag_free(o.parameters);
  cag_free(o.corners);
  cag_free(o.slots);
  cag_free(o.face);
  return status;
}
