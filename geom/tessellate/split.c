// Subdivides triangles until no edge is longer than a limit.
//
// In each pass the midpoints of all long edges become vertices, and each triangle with n such edges
// becomes n + 1. Both triangles of an edge use the same midpoint. Vertices that are duplicated for
// several faces are halved once per face, at the identical position, and are welded like the ends
// of their edges.

#include "geom/tessellate/split.h"

#include <string.h>

#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"

// Edges at exactly the limit are not halved because of rounding.
#define ROUNDING CAG_ROUNDING

// An edge of a triangle that is halved: its ends, lower first, and its corner.
typedef struct Half {
  uint32_t low, high;
  size_t corner;   // 3 times the triangle, plus the edge's first corner
  uint32_t middle; // the new vertex
} Half;

typedef struct Splitter {
  const CagMesh *m;
  double longest;
  Half *halves;
  size_t n;
  size_t vertices; // including the new ones
} Splitter;

static int by_ends(const void *a, const void *b) {
  const Half *x = a, *y = b;
  if (x->low != y->low) return x->low < y->low ? -1 : 1;
  if (x->high != y->high) return x->high < y->high ? -1 : 1;
  return (x->corner > y->corner) - (x->corner < y->corner);
}

static CagStatus find_halves(Splitter *s, CagError *err) {
  const CagMesh *m = s->m;
  s->halves = cag_malloc((3 * m->triangle_count + 1) * sizeof *s->halves);
  if (!s->halves) return cag_fail_memory(err);
  s->n = 0;
  for (size_t i = 0; i < 3 * m->triangle_count; i++) {
    const uint32_t a = m->triangles[i], b = m->triangles[i % 3 == 2 ? i - 2 : i + 1];
    if (cag_norm(cag_sub(m->positions[a], m->positions[b])) > s->longest * (1 + ROUNDING))
      s->halves[s->n++] = (Half){.low = a < b ? a : b, .high = a < b ? b : a, .corner = i};
  }
  const CagStatus status = cag_sort(s->halves, s->n, sizeof *s->halves, by_ends, err);
  if (status) return status;
  s->vertices = m->vertex_count;
  for (size_t i = 0; i < s->n; i++) {
    const bool same = i > 0 && s->halves[i].low == s->halves[i - 1].low &&
                      s->halves[i].high == s->halves[i - 1].high;
    s->halves[i].middle = (uint32_t)(same ? s->vertices - 1 : s->vertices++);
  }
  return CAG_OK;
}

static void middle_vertex(const CagMesh *m, const Half *h, CagMesh *out) {
  const uint32_t a = h->low, b = h->high, at = h->middle;
  out->positions[at] = cag_scaled(cag_add(m->positions[a], m->positions[b]), 0.5);
  if (m->normals) {
    const CagVec3 mean = cag_unit(cag_add(m->normals[a], m->normals[b]));
    out->normals[at] = cag_norm(mean) > 0 ? mean : m->normals[a];
  }
  for (int k = 0; m->uv && k < 2; k++)
    out->uv[2 * at + k] = (m->uv[2 * a + k] + m->uv[2 * b + k]) / 2;
}

// Midpoints are one point of the closed surface if their edges are one edge.
static CagStatus weld_middles(const Splitter *s, CagMesh *out, CagError *err) {
  const uint32_t *weld = s->m->weld;
  Half *welded = cag_malloc((s->n + 1) * sizeof *welded);
  if (!welded) return cag_fail_memory(err);
  for (size_t i = 0; i < s->n; i++) {
    const uint32_t a = weld[s->halves[i].low], b = weld[s->halves[i].high];
    // The corner orders equal ends by their middles, so that the first of them is the lowest.
    welded[i] = (Half){a < b ? a : b, a < b ? b : a, s->halves[i].middle, s->halves[i].middle};
  }
  const CagStatus status = cag_sort(welded, s->n, sizeof *welded, by_ends, err);
  for (size_t i = 0, first = 0; !status && i < s->n; i++) {
    if (welded[i].low != welded[first].low || welded[i].high != welded[first].high) first = i;
    out->weld[welded[i].middle] = welded[first].middle;
  }
  cag_free(welded);
  return status;
}

// The triangles into which corners v and midpoints w (w[k] between v[k] and v[k + 1], or none)
// divide one.
static size_t divide_triangle(const CagMesh *out, const uint32_t v[3], const uint32_t w[3],
                              const bool has[3], uint32_t *to) {
  const int count = has[0] + has[1] + has[2];
  uint32_t parts[12];
  if (count == 0) {
    memcpy(to, v, 3 * sizeof *to);
    return 1;
  }
  if (count == 3) {
    const uint32_t all[12] = {v[0], w[0], w[2], v[1], w[1], w[0],
                              v[2], w[2], w[1], w[0], w[1], w[2]};
    memcpy(to, all, sizeof all);
    return 4;
  }
  // Rotated so that edge 0 is halved and, if there are two, edge 1 as well.
  int k = 0;
  while (!(has[k] && (count == 1 || has[(k + 1) % 3]))) k++;
  const uint32_t a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3], ab = w[k];
  if (count == 1) {
    const uint32_t two[6] = {a, ab, c, ab, b, c};
    memcpy(to, two, sizeof two);
    return 2;
  }
  const uint32_t bc = w[(k + 1) % 3];
  const double one = cag_norm(cag_sub(out->positions[a], out->positions[bc]));
  const double other = cag_norm(cag_sub(out->positions[ab], out->positions[c]));
  const uint32_t short_a[9] = {ab, b, bc, a, ab, bc, a, bc, c};
  const uint32_t short_c[9] = {ab, b, bc, a, ab, c, ab, bc, c};
  memcpy(parts, one < other ? short_a : short_c, sizeof short_a);
  memcpy(to, parts, sizeof short_a);
  return 3;
}

static CagStatus divide_triangles(const Splitter *s, CagMesh *out, CagError *err) {
  const CagMesh *m = s->m;
  uint32_t *middle = cag_malloc((3 * m->triangle_count + 1) * sizeof *middle);
  if (!middle) return cag_fail_memory(err);
  memset(middle, 0xff, 3 * m->triangle_count * sizeof *middle);
  for (size_t i = 0; i < s->n; i++) middle[s->halves[i].corner] = s->halves[i].middle;
  size_t made = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    bool has[3];
    for (int k = 0; k < 3; k++) has[k] = middle[3 * t + (size_t)k] != UINT32_MAX;
    const size_t n =
        divide_triangle(out, m->triangles + 3 * t, middle + 3 * t, has, out->triangles + 3 * made);
    for (size_t i = 0; out->labels && i < n; i++) out->labels[made + i] = m->labels[t];
    made += n;
  }
  cag_free(middle);
  return CAG_OK;
}

static CagStatus split_once(Splitter *s, size_t max_triangles, CagMesh **out, CagError *err) {
  const CagMesh *m = s->m;
  const size_t triangles = m->triangle_count + s->n;
  if (triangles > max_triangles || s->vertices >= UINT32_MAX)
    return cag_fail(err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "max_edge", -1,
                    "the mesh would have %zu triangles, more than the limit of %zu; allow longer "
                    "edges",
                    triangles, max_triangles);
  CagMesh *fine;
  CagStatus status = cag_mesh_new(s->vertices, triangles, m->normals, m->uv, m->weld, &fine, err);
  if (status) return status;
  const size_t old = m->vertex_count;
  memcpy(fine->positions, m->positions, old * sizeof *m->positions);
  if (m->normals) memcpy(fine->normals, m->normals, old * sizeof *m->normals);
  if (m->uv) memcpy(fine->uv, m->uv, 2 * old * sizeof *m->uv);
  if (m->weld) memcpy(fine->weld, m->weld, old * sizeof *m->weld);
  fine->scale = m->scale;
  if (m->labels) {
    fine->labels = cag_malloc((triangles + 1) * sizeof *fine->labels);
    if (!fine->labels) status = cag_fail_memory(err);
  }
  for (size_t i = 0; i < s->n; i++) middle_vertex(m, &s->halves[i], fine);
  if (!status && m->weld) status = weld_middles(s, fine, err);
  if (!status) status = divide_triangles(s, fine, err);
  if (status) cag_mesh_release(fine);
  else *out = fine;
  return status;
}

CagStatus cag_mesh_split_edges(const CagMesh *m, double longest, size_t max_triangles,
                               CagMesh **out, CagError *err) {
  CagMesh *now = cag_mesh_retain(m);
  CagStatus status = CAG_OK;
  for (bool more = true; !status && more;) {
    Splitter s = {.m = now, .longest = longest};
    CagMesh *fine = NULL;
    status = cag_stop_check(err);
    if (!status) status = find_halves(&s, err);
    more = s.n > 0;
    if (!status && more) status = split_once(&s, max_triangles, &fine, err);
    cag_free(s.halves);
    if (status || !more) break;
    cag_mesh_release(now);
    now = fine;
  }
  if (status) cag_mesh_release(now);
  else *out = now;
  return status;
}
