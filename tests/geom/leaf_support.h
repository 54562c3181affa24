// Faces over 0..1 x 0..1 that are manually divided into leaves.

#ifndef CAG_TESTS_GEOM_LEAF_SUPPORT_H
#define CAG_TESTS_GEOM_LEAF_SUPPORT_H

#include "geom/surface/surface.h"
#include "geom/tessellate/tessellation.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { FACES = 2, MOST_LEAVES = 64 };

// Owns its surfaces.
typedef struct CutFaces {
  CagSurface *s[FACES];
  Face faces[FACES];
  double breaks[2];
  Leaf leaves[MOST_LEAVES];
  Tessellator t;
} CutFaces;

// Subsequent leaves belong to this face.
static inline void add_face(CutFaces *c, CagSurface *s) {
  assert_true(c->t.face_count < FACES);
  c->s[c->t.face_count] = s;
  c->faces[c->t.face_count++] =
      (Face){.surface = s, .break_count = {2, 2}, .leaf = c->t.leaf_count};
}

static inline void add_leaf(CutFaces *c, const double from[2], const double to[2], uint32_t nu,
                            uint32_t nv) {
  assert_true(c->t.leaf_count < MOST_LEAVES);
  c->leaves[c->t.leaf_count++] = (Leaf){.from = {from[0], from[1]},
                                        .to = {to[0], to[1]},
                                        .n = {nu, nv},
                                        .face = (uint32_t)c->t.face_count - 1};
  c->faces[c->t.face_count - 1].leaf_count++;
}

// Adds at most 2^depth leaves that fill the rectangle.
static inline void add_random_leaves(CutFaces *c, const double from[2], const double to[2],
                                     int depth) {
  const double part = uniform(0.2, 0.8);
  const int d = uniform(0, 1) < 0.5;
  if (depth == 0 || uniform(0, 1) < 0.2) {
    const uint32_t nu = 1 + (uint32_t)uniform(0, 6);
    add_leaf(c, from, to, nu, 1 + (uint32_t)uniform(0, 6));
    return;
  }
  double low[2] = {from[0], from[1]}, high[2] = {to[0], to[1]};
  low[d] = high[d] = from[d] + (to[d] - from[d]) * part;
  add_random_leaves(c, from, high, depth - 1);
  add_random_leaves(c, low, to, depth - 1);
}

static inline void make_lines(CutFaces *c) {
  c->breaks[0] = 0;
  c->breaks[1] = 1;
  for (size_t k = 0; k < c->t.face_count; k++)
    c->faces[k].breaks[0] = c->faces[k].breaks[1] = c->breaks;
  c->t = (Tessellator){.how = {.tolerance = 100, .max_triangles = 1000 * 1000},
                       .size = 10,
                       .noise = 1e-13,
                       .faces = c->faces,
                       .face_count = c->t.face_count,
                       .leaves = c->leaves,
                       .leaf_count = c->t.leaf_count,
                       .leaf_capacity = MOST_LEAVES};
  for (uint32_t k = 0; k < c->t.face_count; k++) OK(cag_tess_make_lines(&c->t, k, &err));
}

static inline void free_faces(CutFaces *c) {
  for (size_t k = 0; k < c->t.face_count; k++) cag_surface_release(c->s[k]);
  for (size_t k = 0; k < c->t.line_count; k++) free(c->t.lines[k].own_parameters);
  free(c->t.lines);
  free(c->t.atoms);
  free(c->t.nodes);
  free(c->t.corners);
  free(c->t.corner_hash);
  free(c->t.positions);
  free(c->t.normals);
  free(c->t.uv);
  free(c->t.weld);
}

#endif
