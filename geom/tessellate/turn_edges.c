// Tessellation, step 5: edges are flipped where triangles lean away from the surface.
//
// Where bands are stitched, for example at a sharp leading edge, a triangle may be much thinner
// than it is long. Its base departs from the surface by less than the tolerance, but by as much as
// the triangle's height, so that the triangle is nearly perpendicular to the surface. Its points
// are correct, but it appears as a dark speck in a picture: it is in shadow while its normals face
// the light. Even counts (even.c) avoid most of these triangles. The edge between two of the others
// is flipped to the other diagonal of their quadrilateral if that reduces the larger of their two
// angles to the surface. Points do not move, and edges at which normals change (seams and creases)
// are not flipped.

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/tessellate/tessellation.h"

// Fraction of the angle that the normal may turn along an edge: a triangle that leans less is
// normal.
#define LEANING 0.5
// Fraction of the tolerance, as in the trial of plan.c.
#define HIGHEST_USE 0.9
#define CLEARLY 1e-3 // radians: minimum gain of a flip

enum { MAX_PASSES = 24 };
static const uint32_t next_corner[] = {1, 2, 0};

typedef struct Turner {
  const CagTessellation *how;
  CagMesh *m;
  uint32_t *beside; // triangles across the edges that begin at each corner, or NO_INDEX
} Turner;

static double angle_between(CagVec3 a, CagVec3 b) {
  return atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
}

// The largest angle between the normal of a triangle and those of its corners.
static double lean(const CagMesh *m, uint32_t a, uint32_t b, uint32_t c) {
  const CagVec3 *p = m->positions;
  const CagVec3 n = cag_cross(cag_sub(p[b], p[a]), cag_sub(p[c], p[a]));
  if (cag_dot(n, n) == 0) return 4; // larger than any angle
  return fmax(angle_between(n, m->normals[a]),
              fmax(angle_between(n, m->normals[b]), angle_between(n, m->normals[c])));
}

// Height of the surface over an edge: that of the arc with the normals of its ends.
static double bulge(const CagMesh *m, uint32_t a, uint32_t b) {
  const CagVec3 e = cag_sub(m->positions[b], m->positions[a]);
  return fabs(cag_dot(e, cag_sub(m->normals[b], m->normals[a]))) / 8;
}

// Bound of a height that is quadratic in the triangle, at its middle.
static double middle_bulge(const CagMesh *m, uint32_t a, uint32_t b, uint32_t c) {
  return 4.0 / 9 * (bulge(m, a, b) + bulge(m, b, c) + bulge(m, c, a));
}

static double uv_area(const CagMesh *m, uint32_t a, uint32_t b, uint32_t c) {
  const double *p = m->uv + 2 * a, *q = m->uv + 2 * b, *r = m->uv + 2 * c;
  return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

// Whether the edge a c of the triangles a b c and a c d may become b d with respect to tolerance,
// angle, and length.
static bool may_turn(const Turner *t, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  const CagMesh *m = t->m;
  if (m->weld[b] == m->weld[d]) return false;
  // Convex in the parameters, too; in either orientation, since the face may be flipped.
  const double way = uv_area(m, a, b, c);
  if (!(way * uv_area(m, a, c, d) > 0 && way * uv_area(m, a, b, d) > 0 &&
        way * uv_area(m, b, c, d) > 0))
    return false;
  const double length = cag_norm(cag_sub(m->positions[d], m->positions[b]));
  const double turn = angle_between(m->normals[b], m->normals[d]);
  if (t->how->angle > 0 && turn > t->how->angle) return false;
  if (t->how->max_edge > 0 && length > t->how->max_edge) return false;
  const double off = fmax(bulge(m, b, d), fmax(middle_bulge(m, a, b, d), middle_bulge(m, b, c, d)));
  return off <= HIGHEST_USE * t->how->tolerance;
}

// The corner of triangle t whose edge borders triangle `other`.
static uint32_t corner_beside(const Turner *t, uint32_t triangle, uint32_t other) {
  for (uint32_t k = 0; k < 3; k++)
    if (t->beside[3 * triangle + k] == other) return k;
  return 3;
}

static void set_beside(Turner *t, uint32_t triangle, uint32_t was, uint32_t is) {
  if (triangle == NO_INDEX) return;
  const uint32_t k = corner_beside(t, triangle, was);
  if (k < 3) t->beside[3 * triangle + k] = is;
}

// Flips the edge at corner k of the triangle `low` if that is better.
static bool turn(Turner *t, uint32_t low, uint32_t k) {
  const uint32_t high = t->beside[3 * low + k];
  if (high == NO_INDEX) return false;
  const uint32_t h = corner_beside(t, high, low);
  if (h == 3) return false;
  uint32_t *p = t->m->triangles + 3 * low, *q = t->m->triangles + 3 * high;
  // low: c a b, high: a c d.
  const uint32_t c = p[k], a = p[next_corner[k]], b = p[next_corner[next_corner[k]]],
                 d = q[next_corner[next_corner[h]]];
  if (q[h] != a || q[next_corner[h]] != c) return false;
  const double before = fmax(lean(t->m, a, b, c), lean(t->m, a, c, d));
  const double after = fmax(lean(t->m, a, b, d), lean(t->m, b, c, d));
  if (!(after < before - CLEARLY) || !may_turn(t, a, b, c, d)) return false;
  const uint32_t ab = t->beside[3 * low + next_corner[k]],
                 bc = t->beside[3 * low + next_corner[next_corner[k]]],
                 cd = t->beside[3 * high + next_corner[h]],
                 da = t->beside[3 * high + next_corner[next_corner[h]]];
  memcpy(p, (uint32_t[3]){a, b, d}, 3 * sizeof *p);
  memcpy(q, (uint32_t[3]){b, c, d}, 3 * sizeof *q);
  memcpy(t->beside + 3 * low, (uint32_t[3]){ab, high, da}, 3 * sizeof *p);
  memcpy(t->beside + 3 * high, (uint32_t[3]){bc, cd, low}, 3 * sizeof *q);
  set_beside(t, bc, low, high);
  set_beside(t, da, high, low);
  return true;
}

// --- Neighbors ---

// starts[v]..starts[v + 1]: the corners of triangles that are vertex v.
static CagStatus find_neighbors(Turner *t, CagError *err) {
  const CagMesh *m = t->m;
  const uint32_t count = 3 * (uint32_t)m->triangle_count;
  uint32_t *starts = cag_calloc(m->vertex_count + 2, sizeof *starts);
  uint32_t *corners = cag_malloc(((size_t)count + 1) * sizeof *corners);
  if (starts && corners) {
    for (uint32_t k = 0; k < count; k++) starts[m->triangles[k] + 2]++;
    for (size_t v = 2; v < m->vertex_count + 2; v++) starts[v] += starts[v - 1];
    for (uint32_t k = 0; k < count; k++) corners[starts[m->triangles[k] + 1]++] = k;
  }
  for (uint32_t k = 0; starts && corners && k < count && !cag_stopped(); k++) {
    const uint32_t a = m->triangles[k], b = m->triangles[k - k % 3 + next_corner[k % 3]];
    t->beside[k] = NO_INDEX;
    for (uint32_t i = starts[b]; i < starts[b + 1]; i++) {
      const uint32_t other = corners[i];
      if (m->triangles[other - other % 3 + next_corner[other % 3]] == a) t->beside[k] = other / 3;
    }
  }
  const CagStatus status = starts && corners ? cag_stop_check(err) : cag_fail_memory(err);
  cag_free(starts);
  cag_free(corners);
  return status;
}

static bool leans(const Turner *t, uint32_t triangle) {
  const uint32_t *k = t->m->triangles + 3 * triangle;
  return lean(t->m, k[0], k[1], k[2]) > LEANING * t->how->angle;
}

static CagStatus turn_all(Turner *t, CagError *err) {
  CagStatus status = find_neighbors(t, err);
  bool turned = !status;
  for (int pass = 0; turned && pass < MAX_PASSES; pass++) {
    turned = false;
    for (uint32_t k = 0; k < t->m->triangle_count; k++) {
      if (cag_stop_check(err)) return err->status;
      for (uint32_t corner = 0; corner < 3 && leans(t, k); corner++) turned |= turn(t, k, corner);
    }
  }
  return status;
}

CagStatus cag_tess_turn_edges(const Tessellator *tess, CagMesh *m, CagError *err) {
  Turner t = {.how = &tess->how, .m = m};
  bool any = false;
  if (!(t.how->angle > 0)) return CAG_OK;
  for (uint32_t k = 0; k < m->triangle_count && !any; k++) {
    if (cag_stop_check(err)) return err->status;
    any = leans(&t, k);
  }
  if (!any) return CAG_OK;
  t.beside = cag_malloc((3 * m->triangle_count + 1) * sizeof *t.beside);
  const CagStatus status = t.beside ? turn_all(&t, err) : cag_fail_memory(err);
  cag_free(t.beside);
  return status;
}
