// Reads PLY as text, little-endian, or big-endian.
//
// The header lists elements, whose properties are numbers or lists of numbers, of eight types. The
// elements `vertex` (x y z, nx ny nz, parameters), `face`, and `tristrips` (strips separated by -1)
// are read, and others are skipped. The minimum size of an element in the file follows from its
// properties, so counts are checked against the rest of the file before anything is read.
// anything is read.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/formats/mesh_draft.h"
#include "interp/formats/text_scan.h"

enum { ELEMENTS_MAX = 64, PROPERTIES_MAX = 256 };

typedef enum NumberType { I8, U8, I16, U16, I32, U32, F32, F64, NO_TYPE } NumberType;
static const size_t type_size[] = {1, 1, 2, 2, 4, 4, 4, 8};

// The meaning of a property for a mesh.
typedef enum Role { X, Y, Z, NX, NY, NZ, U, V, CORNERS, OTHER } Role;
#define VERTEX_ROLES CORNERS // those before it

typedef struct Property {
  NumberType type, count_type; // count_type: of a list, else NO_TYPE
  Role role;
} Property;

typedef enum ElementKind { VERTICES, FACES, STRIPS, SKIPPED } ElementKind;

typedef struct Element {
  ElementKind kind;
  size_t count, property_count, first_property;
} Element;

typedef enum Format { TEXT, LITTLE, BIG } Format;

typedef struct Ply {
  CagMeshDraft *draft;
  Format format;
  CagTextScan scan; // of a binary file, only `at` and `end` are used
  Element elements[ELEMENTS_MAX];
  size_t element_count;
  Property properties[PROPERTIES_MAX];
  size_t property_count;
  uint32_t *corners; // of the current list
  size_t corner_room;
} Ply;

// --- Header ---

static NumberType find_type(const char *word, size_t n) {
  static const struct {
    const char *name;
    NumberType type;
  } names[] = {{"char", I8},   {"int8", I8},     {"uchar", U8},   {"uint8", U8},
               {"short", I16}, {"int16", I16},   {"ushort", U16}, {"uint16", U16},
               {"int", I32},   {"int32", I32},   {"uint", U32},   {"uint32", U32},
               {"float", F32}, {"float32", F32}, {"double", F64}, {"float64", F64}};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (cag_scan_is(word, n, names[i].name)) return names[i].type;
  return NO_TYPE;
}

static Role find_role(ElementKind kind, const char *word, size_t n) {
  static const struct {
    const char *name;
    Role role;
  } names[] = {{"x", X}, {"y", Y}, {"z", Z}, {"nx", NX}, {"ny", NY},       {"nz", NZ},
               {"s", U}, {"t", V}, {"u", U}, {"v", V},   {"texture_u", U}, {"texture_v", V}};
  for (size_t i = 0; kind == VERTICES && i < sizeof names / sizeof *names; i++)
    if (cag_scan_is(word, n, names[i].name)) return names[i].role;
  bool corners = cag_scan_is(word, n, "vertex_indices") || cag_scan_is(word, n, "vertex_index");
  return (kind == FACES || kind == STRIPS) && corners ? CORNERS : OTHER;
}

static CagStatus fail_line(const Ply *p, CagErrorId id, const char *what, const char *word,
                           size_t n, CagError *err) {
  return cag_mesh_file_fail_line(p->draft->file, err, id, p->scan.at, "%s, found `%.*s`", what,
                                 n < 40 ? (int)n : 40, word);
}

static CagStatus read_element(Ply *p, CagError *err) {
  const char *word;
  int64_t count;
  size_t n = cag_scan_word(&p->scan, &word);
  if (!cag_scan_integer(&p->scan, &count) || count < 0)
    return fail_line(p, CAG_ERR_mesh_file_syntax, "expected a count after the element's name", word,
                     n, err);
  if (p->element_count == ELEMENTS_MAX)
    return fail_line(p, CAG_ERR_mesh_file_syntax, "expected at most 64 elements", word, n, err);
  ElementKind kind = cag_scan_is(word, n, "vertex")      ? VERTICES
                     : cag_scan_is(word, n, "face")      ? FACES
                     : cag_scan_is(word, n, "tristrips") ? STRIPS
                                                         : SKIPPED;
  p->elements[p->element_count++] =
      (Element){.kind = kind, .count = (size_t)count, .first_property = p->property_count};
  return CAG_OK;
}

static CagStatus read_property(Ply *p, CagError *err) {
  const char *word;
  size_t n = cag_scan_word(&p->scan, &word);
  Property property = {.count_type = NO_TYPE};
  if (cag_scan_is(word, n, "list")) {
    n = cag_scan_word(&p->scan, &word);
    property.count_type = find_type(word, n);
    if (property.count_type == NO_TYPE || property.count_type >= F32)
      return fail_line(p, CAG_ERR_mesh_file_syntax, "expected the type of a list's count", word, n,
                       err);
    n = cag_scan_word(&p->scan, &word);
  }
  property.type = find_type(word, n);
  if (property.type == NO_TYPE)
    return fail_line(p, CAG_ERR_mesh_file_syntax, "expected a type such as float or uchar", word, n,
                     err);
  n = cag_scan_word(&p->scan, &word);
  if (p->element_count == 0 || n == 0 || p->property_count == PROPERTIES_MAX)
    return fail_line(p, CAG_ERR_mesh_file_syntax,
                     "expected a property with a name, of an element, and at most 256", word, n,
                     err);
  Element *e = &p->elements[p->element_count - 1];
  bool list = property.count_type != NO_TYPE;
  property.role = find_role(e->kind, word, n);
  if (list != (property.role == CORNERS)) property.role = OTHER;
  p->properties[p->property_count++] = property;
  e->property_count++;
  return CAG_OK;
}

static CagStatus read_format(Ply *p, CagError *err) {
  static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  const char *word;
  size_t n = cag_scan_word(&p->scan, &word);
  for (int k = 0; k < 3; k++) {
    if (!cag_scan_is(word, n, names[k])) continue;
    p->format = (Format)k;
    return CAG_OK;
  }
  return fail_line(p, CAG_ERR_mesh_file_syntax,
                   "expected ascii, binary_little_endian, or binary_big_endian", word, n, err);
}

static CagStatus read_header(Ply *p, CagError *err) {
  cag_scan_next_line(&p->scan); // ply
  bool formatted = false;
  while (cag_scan_to_word(&p->scan)) {
    const char *word;
    size_t n = cag_scan_word(&p->scan, &word);
    CagStatus status = CAG_OK;
    if (cag_scan_is(word, n, "end_header")) {
      if (!formatted)
        return fail_line(p, CAG_ERR_mesh_file_syntax, "expected a format before", word, n, err);
      cag_scan_next_line(&p->scan);
      return CAG_OK;
    }
    if (cag_scan_is(word, n, "format")) formatted = true, status = read_format(p, err);
    else if (cag_scan_is(word, n, "element")) status = read_element(p, err);
    else if (cag_scan_is(word, n, "property")) status = read_property(p, err);
    else if (!cag_scan_is(word, n, "comment") && !cag_scan_is(word, n, "obj_info"))
      return fail_line(p, CAG_ERR_mesh_file_syntax, "expected element, property, or end_header",
                       word, n, err);
    if (status) return status;
    cag_scan_next_line(&p->scan);
  }
  return cag_mesh_file_fail_line(p->draft->file, err, CAG_ERR_mesh_file_truncated, p->scan.at,
                                 "the header has no end_header; write or download the file again");
}

// --- Numbers ---

static double decode(const unsigned char *b, NumberType type, bool big) {
  uint64_t bits = 0;
  size_t n = type_size[type];
  for (size_t k = 0; k < n; k++) bits |= (uint64_t)b[big ? n - 1 - k : k] << 8 * k;
  switch (type) {
  case I8: return (int8_t)bits;
  case I16: return (int16_t)bits;
  case I32: return (int32_t)bits;
  case F32: {
    uint32_t half = (uint32_t)bits;
    float x;
    memcpy(&x, &half, sizeof x);
    return x;
  }
  case F64: {
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
  }
  default: return (double)bits;
  }
}

// Reads the next number. Returns false if the file ends, or there is no number at p->scan.at.
static bool next_number(Ply *p, NumberType type, double *x) {
  if (p->format == TEXT) {
    const char *word;
    if (!cag_scan_to_word(&p->scan)) return false;
    if (cag_scan_number(&p->scan, x)) return true;
    // "nan" and "inf", which some programs write for unknown values.
    CagTextScan before = p->scan;
    size_t n = cag_scan_word(&p->scan, &word);
    if (n > 0 && (*word == '-' || *word == '+')) word++, n--;
    *x = NAN;
    if (cag_scan_is(word, n, "nan") || cag_scan_is(word, n, "inf")) return true;
    p->scan = before;
    return false;
  }
  if ((size_t)(p->scan.end - p->scan.at) < type_size[type]) return false;
  *x = decode((const unsigned char *)p->scan.at, type, p->format == BIG);
  p->scan.at += type_size[type];
  return true;
}

static CagStatus fail_data(const Ply *p, CagErrorId id, const char *what, size_t i, CagError *err) {
  const CagMeshFile *f = p->draft->file;
  return p->format == TEXT ? cag_mesh_file_fail_line(f, err, id, p->scan.at, "%s %zu", what, i)
                           : cag_mesh_file_fail_byte(f, err, id, p->scan.at, "%s %zu", what, i);
}

static CagStatus fail_number(Ply *p, size_t i, CagError *err) {
  bool ended = p->format != TEXT || !cag_scan_to_word(&p->scan);
  return ended ? fail_data(p, CAG_ERR_mesh_file_truncated,
                           "write or download the file again: it ends within its element", i, err)
               : fail_data(p, CAG_ERR_mesh_file_syntax, "expected a number in the element", i, err);
}

// --- Elements ---

// Reads the count of a list, which must fit in the rest of the file.
static CagStatus read_count(Ply *p, const Property *q, size_t i, size_t *count, CagError *err) {
  double x;
  if (!next_number(p, q->count_type, &x)) return fail_number(p, i, err);
  size_t each = p->format == TEXT ? 2 : type_size[q->type];
  size_t rest = (size_t)(p->scan.end - p->scan.at) + 1;
  if (!(x >= 0) || x != floor(x))
    return fail_data(p, CAG_ERR_mesh_file_syntax,
                     "the count of a list is not a whole number in element", i, err);
  if (x > (double)(rest / each))
    return fail_data(p, CAG_ERR_mesh_file_truncated,
                     "write or download the file again: a list is longer than the rest in element",
                     i, err);
  *count = (size_t)x;
  return CAG_OK;
}

static CagStatus skip_list(Ply *p, const Property *q, size_t i, CagError *err) {
  size_t count = 0;
  CagStatus status = read_count(p, q, i, &count, err);
  double x;
  for (size_t k = 0; !status && k < count; k++)
    if (!next_number(p, q->type, &x)) status = fail_number(p, i, err);
  return status;
}

static CagStatus read_vertex(Ply *p, const Element *e, size_t i, CagError *err) {
  double value[VERTEX_ROLES] = {0}, x;
  CagMeshDraft *d = p->draft;
  for (size_t k = 0; k < e->property_count; k++) {
    const Property *q = &p->properties[e->first_property + k];
    if (q->count_type != NO_TYPE) {
      CagStatus status = skip_list(p, q, i, err);
      if (status) return status;
      continue;
    }
    if (!next_number(p, q->type, &x)) return fail_number(p, i, err);
    if (q->role < VERTEX_ROLES) value[q->role] = x;
  }
  if (!isfinite(value[X]) || !isfinite(value[Y]) || !isfinite(value[Z]))
    return fail_data(p, CAG_ERR_mesh_file_number, "a coordinate is not finite in vertex", i, err);
  d->positions[i] = cag_vec3(value[X], value[Y], value[Z]);
  if (d->normals) d->normals[i] = cag_vec3(value[NX], value[NY], value[NZ]);
  for (int k = 0; d->uv && k < 2; k++)
    d->uv[2 * i + (size_t)k] = isfinite(value[U + k]) ? value[U + k] : 0;
  return CAG_OK;
}

// Adds strips separated by -1. Every other triangle is reversed.
static CagStatus add_strips(Ply *p, size_t n, CagError *err) {
  CagMeshDraft *d = p->draft;
  size_t in_strip = 0;
  if (n < 3) return CAG_OK;
  CagStatus status = cag_draft_triangles(d, n - 2, err);
  for (size_t k = 0; !status && k < n; k++) {
    const uint32_t *c = p->corners + k;
    in_strip = *c == UINT32_MAX ? 0 : in_strip + 1;
    if (in_strip < 3) continue;
    if (in_strip % 2) cag_draft_triangle(d, c[-2], c[-1], c[0]);
    else cag_draft_triangle(d, c[-1], c[-2], c[0]);
  }
  return status;
}

static CagStatus read_corners(Ply *p, const Element *e, const Property *q, size_t i,
                              CagError *err) {
  CagMeshDraft *d = p->draft;
  size_t count = 0;
  CagStatus status = read_count(p, q, i, &count, err);
  if (status) return status;
  if (count > p->corner_room) {
    status = cag_draft_take(d, count - p->corner_room, sizeof *p->corners, err);
    if (!status && !CAG_RESIZE(p->corners, count)) status = cag_fail_memory(err);
    if (status) return status;
    p->corner_room = count;
  }
  for (size_t k = 0; k < count; k++) {
    double x;
    if (!next_number(p, q->type, &x)) return fail_number(p, i, err);
    bool restart = e->kind == STRIPS && x == -1;
    if (!restart && (!(x >= 0 && x < (double)d->vertex_count) || x != floor(x)))
      return cag_mesh_file_fail_line(
          d->file, err, CAG_ERR_mesh_file_index, p->format == TEXT ? p->scan.at : NULL,
          "face %zu refers to vertex %.9g, but there are %zu vertices, numbered from 0", i, x,
          d->vertex_count);
    p->corners[k] = restart ? UINT32_MAX : (uint32_t)x;
  }
  return e->kind == STRIPS ? add_strips(p, count, err)
                           : cag_draft_polygon(d, p->corners, count, err);
}

static CagStatus read_other(Ply *p, const Element *e, size_t i, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t k = 0; !status && k < e->property_count; k++) {
    const Property *q = &p->properties[e->first_property + k];
    double x;
    if (q->role == CORNERS) status = read_corners(p, e, q, i, err);
    else if (q->count_type != NO_TYPE) status = skip_list(p, q, i, err);
    else if (!next_number(p, q->type, &x)) status = fail_number(p, i, err);
  }
  return status;
}

// Returns the minimum size of an element in bytes.
static size_t least_size(const Ply *p, const Element *e) {
  size_t n = 0;
  for (size_t k = 0; k < e->property_count; k++) {
    const Property *q = &p->properties[e->first_property + k];
    n += p->format == TEXT          ? 2 // a digit and what divides it from the next
         : q->count_type != NO_TYPE ? type_size[q->count_type]
                                    : type_size[q->type];
  }
  return n;
}

static CagStatus begin_vertices(Ply *p, const Element *e, CagError *err) {
  bool has[OTHER + 1] = {false};
  for (size_t k = 0; k < e->property_count; k++)
    has[p->properties[e->first_property + k].role] = true;
  if (!has[X] || !has[Y] || !has[Z])
    return cag_mesh_file_fail_line(p->draft->file, err, CAG_ERR_mesh_file_syntax, NULL,
                                   "its vertices lack x, y, or z");
  if (p->draft->vertex_count > 0)
    return cag_mesh_file_fail_line(p->draft->file, err, CAG_ERR_mesh_file_syntax, NULL,
                                   "it has two lists of vertices");
  CagStatus status =
      cag_draft_vertices(p->draft, e->count, has[NX] && has[NY] && has[NZ], has[U] && has[V], err);
  if (!status) p->draft->vertex_count = e->count;
  return status;
}

static CagStatus read_elements(Ply *p, const Element *e, CagError *err) {
  size_t least = least_size(p, e), rest = (size_t)(p->scan.end - p->scan.at) + 1;
  if (least == 0 || e->count == 0) return CAG_OK;
  if (e->count > rest / least)
    return cag_mesh_file_fail_line(
        p->draft->file, err, CAG_ERR_mesh_file_truncated, NULL,
        "its header states %zu elements of at least %zu bytes, but only %zu bytes are left; write or download the file again",
        e->count, least, rest - 1);
  CagStatus status = e->kind == VERTICES ? begin_vertices(p, e, err) : CAG_OK;
  // Most faces are triangles, so room for them is reserved at once, as far as the file can contain
  // them.
  if (!status && e->kind == FACES) status = cag_draft_triangles(p->draft, e->count, err);
  for (size_t i = 0; !status && i < e->count; i++) {
    status = e->kind == VERTICES ? read_vertex(p, e, i, err) : read_other(p, e, i, err);
    if (!status && i % CAG_DRAFT_CHECK_STEP == 0) status = cag_draft_check(p->draft, err);
  }
  return status;
}

CagStatus cag_read_ply(CagMeshDraft *d, CagError *err) {
  Ply *p = cag_calloc(1, sizeof *p);
  if (!p) return cag_fail_memory(err);
  p->draft = d;
  p->scan = (CagTextScan){d->file->bytes, d->file->bytes + d->file->size};
  CagStatus status = read_header(p, err);
  for (size_t i = 0; !status && i < p->element_count; i++)
    status = read_elements(p, &p->elements[i], err);
  cag_free(p->corners);
  cag_free(p);
  return status;
}
