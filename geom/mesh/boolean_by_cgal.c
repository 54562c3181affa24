// Set operations in a build with CGAL: operands handed over, and the pieces that come back.

#include <string.h>

#include "base/memory.h"
#include "geom/mesh/boolean_cgal.h"
#include "geom/mesh/boolean_work.h"

static void free_mesh(BoolCgalMesh *m) {
  cag_free(m->points);
  cag_free(m->triangles);
  cag_free(m->operand);
  cag_free(m->source);
}

// The faces of one operand, numbered on their own; face_of: from its triangles back to the faces.
// *whole: it has no face twice.
static bool hand_over(const BoolWork *w, int operand, BoolCgalMesh *m, uint32_t *face_of,
                      bool *whole) {
  uint32_t *number = cag_malloc((w->points.n + 1) * sizeof *number);
  m->points = cag_malloc((w->points.n + 1) * 3 * sizeof *m->points);
  m->triangles = cag_malloc((w->face_count + 1) * 3 * sizeof *m->triangles);
  const bool room = number && m->points && m->triangles;
  if (room) memset(number, 0xff, w->points.n * sizeof *number);
  for (uint32_t f = 0; room && f < w->face_count; f++) {
    const BoolFace *face = &w->faces[f];
    const int times = face->times[operand];
    if (times == 0) continue;
    if (times != 1 && times != -1) *whole = false;
    face_of[m->triangle_count] = f;
    for (int k = 0; k < 3; k++) {
      const uint32_t v = face->v[times < 0 && k ? 3 - k : k];
      if (number[v] == BOOL_NONE) {
        number[v] = (uint32_t)m->point_count;
        memcpy(m->points + 3 * m->point_count++, &w->points.at[v], 3 * sizeof *m->points);
      }
      m->triangles[3 * m->triangle_count + (size_t)k] = number[v];
    }
    m->triangle_count++;
  }
  cag_free(number);
  return room;
}

// Does the piece run as the face of which it is a part does?
static signed char facing(const BoolWork *w, const uint32_t v[3], const BoolFace *face) {
  CagVec3 n[2];
  for (int i = 0; i < 2; i++) {
    const uint32_t *k = i ? face->v : v;
    const CagVec3 a = w->points.at[k[0]];
    n[i] = cag_cross(cag_sub(w->points.at[k[1]], a), cag_sub(w->points.at[k[2]], a));
  }
  return cag_dot(n[0], n[1]) < 0 ? -1 : 1;
}

static bool take_pieces(BoolWork *w, const BoolCgalMesh *m, uint32_t *const face_of[2]) {
  uint32_t *number = cag_malloc((m->point_count + 1) * sizeof *number);
  w->winding = cag_calloc(m->triangle_count + 1, sizeof *w->winding);
  bool done = number && w->winding &&
              bool_list_reserve(&w->pieces, m->triangle_count + 1, sizeof(BoolPiece));
  for (size_t i = 0; done && i < m->point_count; i++) {
    const double *p = m->points + 3 * i;
    number[i] = bool_points_add(&w->points, cag_vec3(p[0], p[1], p[2]));
    done = number[i] != BOOL_NONE;
  }
  for (size_t t = 0; done && t < m->triangle_count; t++) {
    const uint32_t face = face_of[m->operand[t]][m->source[t]];
    BoolPiece piece = {.plane = face, .times = {1, 0}, .face = face};
    for (size_t k = 0; k < 3; k++) piece.v[k] = number[m->triangles[3 * t + k]];
    piece.facing = facing(w, piece.v, &w->faces[face]);
    bool_pieces(w)[w->pieces.n++] = piece;
  }
  cag_free(number);
  return done;
}

CagStatus bool_ask_cgal(BoolWork *w, CagSetOperation op, bool *taken) {
  BoolCgalMesh operands[2] = {{0}, {0}}, out = {0};
  uint32_t *face_of[2];
  bool done = true, whole = true;
  for (int k = 0; k < 2; k++) {
    face_of[k] = cag_malloc((w->face_count + 1) * sizeof *face_of[k]);
    done = done && face_of[k] && hand_over(w, k, &operands[k], face_of[k], &whole);
  }
  const int number = op == CAG_UNION ? 0 : op == CAG_DIFFERENCE ? 1 : 2;
  *taken = done && whole && bool_cgal_operate(number, operands, &out);
  if (*taken) done = take_pieces(w, &out, face_of);
  for (int k = 0; k < 2; k++) {
    free_mesh(&operands[k]);
    cag_free(face_of[k]);
  }
  free_mesh(&out);
  return done ? bool_stopped(w) : cag_fail_memory(w->err);
}
