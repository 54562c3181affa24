// Compares meshes with their surfaces by dense sampling, for tests of tessellation.
//
// The search for a point starts with the triangles near its parameters, which provide an upper
// bound of the distance. All triangles are searched only if this bound exceeds the tolerance.

#ifndef CAG_TESTS_GEOM_DENSE_SUPPORT_H
#define CAG_TESTS_GEOM_DENSE_SUPPORT_H

#include "geom/mesh/distance.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/support.h"

// --- Random numbers ---

static uint64_t chance_state = 1;

// Park and Miller's generator, which is the same on every machine.
static inline double chance(void) {
  chance_state = chance_state * 48271 % 2147483647;
  return (double)chance_state / 2147483647;
}

static inline double between(double a, double b) { return a + (b - a) * chance(); }

// --- Distances ---

typedef struct Boxes {
  const CagMesh *mesh;
  const CagSurface *surface;
  size_t side;
  uint32_t *start, *triangles;
} Boxes;

static inline size_t box_of(const Boxes *b, double x, int direction) {
  const CagSurface *s = b->surface;
  double from = direction == 0 ? s->u0 : s->v0, to = direction == 0 ? s->u1 : s->v1;
  double k = floor((x - from) / (to - from) * (double)b->side);
  return k < 0 ? 0 : k >= (double)b->side ? b->side - 1 : (size_t)k;
}

static inline Boxes sort_into_boxes(const CagMesh *m, const CagSurface *s) {
  Boxes b = {.mesh = m, .surface = s};
  b.side = (size_t)fmin(400, 2 + sqrt((double)m->triangle_count / 4));
  b.start = calloc(b.side * b.side + 2, sizeof *b.start);
  for (int pass = 0; pass < 2; pass++) {
    for (size_t t = 0; t < m->triangle_count; t++) {
      size_t low[2] = {b.side, b.side}, high[2] = {0, 0};
      for (size_t k = 0; k < 3; k++)
        for (int d = 0; d < 2; d++) {
          size_t at = box_of(&b, m->uv[2 * (size_t)m->triangles[3 * t + k] + (size_t)d], d);
          low[d] = at < low[d] ? at : low[d];
          high[d] = at > high[d] ? at : high[d];
        }
      for (size_t i = low[0]; i <= high[0]; i++)
        for (size_t j = low[1]; j <= high[1]; j++) {
          if (pass == 0) b.start[i * b.side + j + 2]++;
          else b.triangles[b.start[i * b.side + j + 1]++] = (uint32_t)t;
        }
    }
    if (pass == 1) break;
    for (size_t k = 2; k < b.side * b.side + 2; k++) b.start[k] += b.start[k - 1];
    b.triangles = malloc((b.start[b.side * b.side + 1] + 1) * sizeof *b.triangles);
  }
  return b;
}

static inline double to_triangle(const CagMesh *m, size_t t, CagVec3 p) {
  const uint32_t *c = m->triangles + 3 * t;
  return cag_distance_to_triangle(p, m->positions[c[0]], m->positions[c[1]], m->positions[c[2]]);
}

static inline double distance_at(const Boxes *b, double u, double v, CagVec3 p, double enough) {
  double least = INFINITY;
  size_t at = box_of(b, u, 0) * b->side + box_of(b, v, 1);
  for (uint32_t k = b->start[at]; k < b->start[at + 1]; k++)
    least = fmin(least, to_triangle(b->mesh, b->triangles[k], p));
  for (size_t t = 0; least > enough && t < b->mesh->triangle_count; t++)
    least = fmin(least, to_triangle(b->mesh, t, p));
  return least;
}

// --- Checks ---

enum { POINTS = 12000 };

// Every fourth point is close to an end of the domain, and every eighth is on it.
static inline double sample_parameter(double from, double to, int k) {
  double x = chance();
  if (k % 4 == 1) x = x * x * x * x;
  if (k % 4 == 2) x = 1 - x * x * x * x;
  if (k % 8 == 7) x = x < 0.5 ? 0 : 1;
  return k % 8 == 7 ? (x == 0 ? from : to) : from + (to - from) * x;
}

static inline double largest_distance(const CagSurface *s, const CagMesh *m, double tolerance,
                                      double worst[2]) {
  const CagRegion *region = NULL;
  double largest = 0;
  Boxes b = sort_into_boxes(m, s);
  cag_surface_trimmed_view(s, NULL, &region);
  for (int k = 0; k < POINTS; k++) {
    double u = sample_parameter(s->u0, s->u1, k), v = sample_parameter(s->v0, s->v1, k / 8);
    CagVec3 p;
    bool inside = true;
    if (region) OK(cag_region_contains(region, cag_vec3(u, v, 0), &inside, &err));
    if (!inside) continue;
    OK(cag_surface_point(s, u, v, &p, &err));
    double d = distance_at(&b, u, v, p, tolerance);
    if (d <= largest) continue;
    largest = d;
    worst[0] = u;
    worst[1] = v;
  }
  free(b.start);
  free(b.triangles);
  return largest;
}

// Along each edge longer than `free`, the normal turns by at most `angle`. No edge is longer than
// `longest`.
static inline void check_edges(const char *name, const CagMesh *m, double angle, double free,
                               double longest) {
  for (size_t t = 0; t < m->triangle_count; t++)
    for (size_t k = 0; k < 3; k++) {
      uint32_t a = m->triangles[3 * t + k], b = m->triangles[3 * t + (k + 1) % 3];
      CagVec3 n = m->normals[a], o = m->normals[b];
      double turn = atan2(cag_norm(cag_cross(n, o)), cag_dot(n, o));
      double length = cag_norm(cag_sub(m->positions[a], m->positions[b]));
      if (turn > angle && length > free)
        fail_msg("%s: an edge turns by %g degrees", name, turn * 180 / M_PI);
      if (length > longest) fail_msg("%s: an edge is %g long", name, length);
    }
}

#endif
