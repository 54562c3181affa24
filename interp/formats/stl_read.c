// Reads STL, binary and as text.
//
// Binary files may start with "solid", too. A file is binary if its length exactly matches its
// count of triangles. Otherwise it is text if it starts with "solid", and its first part contains
// "facet" or "endsolid" and no zero byte. Otherwise it is binary with a wrong length. Normals and
// colors of triangles are ignored, because a normal follows from the corners.

#include <string.h>

#include "interp/formats/mesh_draft.h"
#include "interp/formats/text_scan.h"

enum { HEADER = 80, RECORD = 50 };
// The length of the part that is examined for text: an 80-byte header and a first facet.
#define TEXT_LOOK ((size_t)1024)

static uint64_t count_of(const CagMeshFile *f) { return cag_read_u32(f->bytes + HEADER); }

bool cag_stl_is_binary(const CagMeshFile *f) {
  return f->size >= HEADER + 4 && f->size == HEADER + 4 + RECORD * count_of(f);
}

static bool is_text(const CagMeshFile *f) {
  CagTextScan s = {f->bytes, f->bytes + f->size};
  const char *word;
  if (!cag_scan_to_word(&s)) return false;
  size_t n = cag_scan_word(&s, &word);
  if (!cag_scan_is(word, n, "solid")) return false;
  size_t look = f->size < TEXT_LOOK ? f->size : TEXT_LOOK;
  if (memchr(f->bytes, 0, look)) return false;
  cag_scan_next_line(&s);
  if (!cag_scan_to_word(&s)) return false;
  n = cag_scan_word(&s, &word);
  return cag_scan_is(word, n, "facet") || cag_scan_is(word, n, "endsolid");
}

// --- Binary ---

static CagStatus read_corner(CagMeshDraft *d, const char *at, size_t triangle, CagError *err) {
  float x[3];
  for (int k = 0; k < 3; k++) {
    uint32_t bits = cag_read_u32(at + 4 * k);
    memcpy(&x[k], &bits, sizeof bits);
  }
  if (!isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2]))
    return cag_mesh_file_fail_byte(d->file, err, CAG_ERR_mesh_file_number, at,
                                   "triangle %zu has a corner at [%g, %g, %g]", triangle,
                                   (double)x[0], (double)x[1], (double)x[2]);
  d->positions[d->vertex_count++] = cag_vec3(x[0], x[1], x[2]);
  return CAG_OK;
}

static CagStatus read_binary(CagMeshDraft *d, CagError *err) {
  const CagMeshFile *f = d->file;
  if (f->size < HEADER + 4)
    return cag_mesh_file_fail_byte(
        f, err, CAG_ERR_mesh_file_truncated, NULL,
        "its %zu bytes are too few for an STL file, which has 84 bytes before its triangles; write or download it again",
        f->size);
  uint64_t count = count_of(f), there = (f->size - HEADER - 4) / RECORD;
  if (count > there)
    return cag_mesh_file_fail_byte(
        f, err, CAG_ERR_mesh_file_truncated, f->bytes + HEADER,
        "its header states %llu triangles, but its %zu bytes contain %llu; write or download it again",
        (unsigned long long)count, f->size, (unsigned long long)there);
  CagStatus status = cag_draft_triangles(d, count, err);
  if (!status) status = cag_draft_vertices(d, 3 * count, false, false, err);
  const char *at = f->bytes + HEADER + 4;
  for (size_t t = 0; !status && t < count; t++, at += RECORD) {
    uint32_t first = (uint32_t)(3 * t);
    for (int k = 0; k < 3 && !status; k++) status = read_corner(d, at + 12 * (k + 1), t, err);
    cag_draft_triangle(d, first, first + 1, first + 2);
    if (!status && t % CAG_DRAFT_CHECK_STEP == 0) status = cag_draft_check(d, err);
  }
  return status;
}

// --- Text ---

// Reads a required word. *word, *n: the word that was found.
static bool expect(CagTextScan *s, const char *expected) {
  const char *word;
  if (!cag_scan_to_word(s)) return false;
  const char *before = s->at;
  size_t n = cag_scan_word(s, &word);
  if (cag_scan_is(word, n, expected)) return true;
  s->at = before;
  return false;
}

static CagStatus fail_word(const CagMeshDraft *d, CagTextScan *s, const char *expected,
                           CagError *err) {
  const char *word;
  if (!cag_scan_to_word(s))
    return cag_mesh_file_fail_line(
        d->file, err, CAG_ERR_mesh_file_truncated, s->at,
        "unexpected end of file, expected %s; write or download the file again", expected);
  const char *at = s->at;
  size_t n = cag_scan_word(s, &word);
  return cag_mesh_file_fail_line(d->file, err, CAG_ERR_mesh_file_syntax, at,
                                 "expected %s, found `%.*s`", expected, n < 40 ? (int)n : 40, word);
}

static CagStatus read_vertex(CagMeshDraft *d, CagTextScan *s, CagError *err) {
  double x[3];
  if (!expect(s, "vertex")) return fail_word(d, s, "vertex", err);
  for (int k = 0; k < 3; k++) {
    if (!cag_scan_to_word(s) || !cag_scan_number(s, &x[k])) return fail_word(d, s, "a number", err);
    if (!isfinite(x[k]))
      return cag_mesh_file_fail_line(d->file, err, CAG_ERR_mesh_file_number, s->at,
                                     "a coordinate is too large");
  }
  d->positions[d->vertex_count++] = cag_vec3(x[0], x[1], x[2]);
  return CAG_OK;
}

// facet normal x y z / outer loop / vertex x y z (three) / endloop / endfacet; the word `facet` has
// been read.
static CagStatus read_facet(CagMeshDraft *d, CagTextScan *s, CagError *err) {
  // A facet has at least 60 bytes, so the room grows only with the input.
  CagStatus status = cag_draft_triangles(d, 1, err);
  if (!status && d->vertex_count + 3 > d->vertex_room)
    status = cag_draft_vertices(d, 2 * d->vertex_count + 3 * 64, false, false, err);
  if (status) return status;
  // `normal` and its numbers, which may be nan or missing.
  const int most_words = 4;
  const char *word;
  uint32_t first = (uint32_t)d->vertex_count;
  for (int k = 0; k < most_words && !cag_scan_at_line_end(s); k++) {
    const char *before = s->at;
    size_t n = cag_scan_word(s, &word);
    if (!cag_scan_is(word, n, "outer")) continue;
    s->at = before;
    break;
  }
  if (!expect(s, "outer")) return fail_word(d, s, "outer", err);
  if (!expect(s, "loop")) return fail_word(d, s, "loop", err);
  for (int k = 0; k < 3 && !status; k++) status = read_vertex(d, s, err);
  if (status) return status;
  if (!expect(s, "endloop")) return fail_word(d, s, "endloop", err);
  if (!expect(s, "endfacet")) return fail_word(d, s, "endfacet", err);
  cag_draft_triangle(d, first, first + 1, first + 2);
  return CAG_OK;
}

static CagStatus read_text(CagMeshDraft *d, CagError *err) {
  CagTextScan s = {d->file->bytes, d->file->bytes + d->file->size};
  CagStatus status = CAG_OK;
  // Files may contain several solids.
  while (!status && cag_scan_to_word(&s)) {
    if (!expect(&s, "solid")) return fail_word(d, &s, "solid", err);
    cag_scan_next_line(&s);
    while (!status && expect(&s, "facet")) {
      status = read_facet(d, &s, err);
      if (!status && d->triangle_count % CAG_DRAFT_CHECK_STEP == 0)
        status = cag_draft_check(d, err);
    }
    if (!status && !expect(&s, "endsolid")) return fail_word(d, &s, "endsolid", err);
    cag_scan_next_line(&s);
  }
  return status;
}

CagStatus cag_read_stl(CagMeshDraft *d, CagError *err) {
  if (cag_stl_is_binary(d->file) || !is_text(d->file)) return read_binary(d, err);
  return read_text(d, err);
}
