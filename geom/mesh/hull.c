// Convex hulls.
//
// In the plane the points are sorted and scanned (Andrew 1979). In space they are added one by one,
// starting with the farthest beyond each face (Barber, Dobkin, Huhdanpaa 1996). All sides are
// decided exactly (predicates.h), so the triangles always form a closed surface for any input: a
// point sees a face only from strictly outside, so no triangle without area can arise. Triangles
// that are coplanar to rounding are then merged, and vertices that remain in the interior of a face
// or an edge are removed.

#include "geom/mesh/hull.h"

#include <float.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/mesh/predicates.h"

// Rounding of transformed points, relative to their largest coordinate: points this close to a line
// or plane are on it.
#define IN_LINE (8 * DBL_EPSILON)
#define IN_PLANE (16 * DBL_EPSILON)

#define NONE UINT32_MAX

static CagStatus check(const CagVec3 *points, size_t n, size_t least, CagError *err) {
  if (n >= least && n < NONE) return cag_curve_check_points(points, n, "points", err);
  if (n >= NONE)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_many_points, "points", -1,
                    "`points` must have fewer than %u points, found %zu", NONE, n);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                  "a hull needs at least %zu points, found %zu", least, n);
}

static CagStatus fail_coincident(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_coincident_points, "points", -1,
                  "all `points` are the same; a hull needs different points");
}

static CagStatus fail_collinear(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_collinear_points, "points", -1,
                  "all `points` are on one line, so they have no hull");
}

// --- Plane ---

typedef struct Indexed {
  CagVec3 p;
  size_t index;
} Indexed;

static int by_place(const void *a, const void *b) {
  const Indexed *p = a, *q = b;
  if (p->p.x != q->p.x) return p->p.x < q->p.x ? -1 : 1;
  if (p->p.y != q->p.y) return p->p.y < q->p.y ? -1 : 1;
  return (p->index > q->index) - (p->index < q->index);
}

static double from_line(CagVec3 p, CagVec3 a, CagVec3 b) {
  const CagVec3 d = cag_sub(b, a);
  const double length = cag_norm(d);
  return length > 0 ? cag_norm(cag_cross(d, cag_sub(p, a))) / length : cag_norm(cag_sub(p, a));
}

// Builds a strictly convex chain over sorted points in `chain`; returns its length.
static size_t scan(const Indexed *points, size_t n, bool backwards, size_t *chain) {
  size_t m = 0;
  for (size_t k = 0; k < n; k++) {
    const size_t i = backwards ? n - 1 - k : k;
    while (m >= 2 &&
           cag_side_of_line(points[chain[m - 2]].p, points[chain[m - 1]].p, points[i].p) <= 0)
      m--;
    chain[m++] = i;
  }
  return m;
}

// Removes corners that are straight to rounding.
static size_t straighten(const Indexed *points, size_t *ring, size_t m, double slack) {
  size_t kept = 0;
  for (size_t i = 0; i < m; i++) {
    const CagVec3 before = points[kept ? ring[kept - 1] : ring[m - 1]].p;
    const CagVec3 after = points[i + 1 < m ? ring[i + 1] : ring[0]].p;
    if (from_line(points[ring[i]].p, before, after) > slack) ring[kept++] = ring[i];
  }
  return kept;
}

CagStatus cag_hull_plane(const CagVec3 *points, size_t n, size_t **out, size_t *count,
                         CagError *err) {
  CagStatus status = check(points, n, 3, err);
  if (status) return status;
  Indexed *sorted = cag_malloc(n * sizeof *sorted);
  size_t *ring = cag_malloc(2 * n * sizeof *ring), m = 0;
  if (!sorted || !ring) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) sorted[i] = (Indexed){points[i], i};
  if (!status) { status = cag_sort(sorted, n, sizeof *sorted, by_place, err); }
  if (!status) {
    const CagVec3 first = sorted[0].p, last = sorted[n - 1].p;
    if (first.x == last.x && first.y == last.y) status = fail_coincident(err);
  }
  if (!status) {
    m = scan(sorted, n, false, ring) - 1;
    m += scan(sorted, n, true, ring + m) - 1;
    m = straighten(sorted, ring, m, IN_LINE * cag_curve_size(points, n));
    if (m < 3) status = fail_collinear(err);
  }
  for (size_t i = 0; i < m; i++) ring[i] = sorted[ring[i]].index;
  cag_free(sorted);
  if (status) {
    cag_free(ring);
    return status;
  }
  *out = ring;
  *count = m;
  return CAG_OK;
}

// --- Space: triangles and their neighbors ---

typedef struct Face {
  uint32_t v[3], next[3]; // next[i]: beyond the edge from v[i] to v[i + 1]
  uint32_t outside;       // first of the points outside of this face, chained; NONE: none
  uint32_t farthest;
  double height; // of the farthest
  uint32_t mark; // of the round in which it was visible
  bool dead;
} Face;

typedef struct Hull {
  const CagVec3 *points;
  size_t n;
  double slack;
  uint32_t *chain; // next point of the same outside set
  Face *faces;
  size_t count, capacity;
  uint32_t *seen;   // faces
  uint32_t *rim_of; // for each point: the new face that starts there on the horizon
  size_t seen_n, seen_capacity;
  uint32_t round;
} Hull;

static bool sees(const Hull *h, const Face *f, uint32_t p) {
  return cag_side_of_plane(h->points[f->v[0]], h->points[f->v[1]], h->points[f->v[2]],
                           h->points[p]) > 0;
}

static CagVec3 face_cross(const Hull *h, const Face *f) {
  const CagVec3 a = h->points[f->v[0]];
  return cag_cross(cag_sub(h->points[f->v[1]], a), cag_sub(h->points[f->v[2]], a));
}

static CagStatus new_face(Hull *h, uint32_t a, uint32_t b, uint32_t c, uint32_t *out,
                          CagError *err) {
  if (h->count == h->capacity) {
    const size_t capacity = h->capacity ? 2 * h->capacity : 256;
    if (!CAG_RESIZE(h->faces, capacity) || !CAG_RESIZE(h->seen, 2 * capacity))
      return cag_fail_memory(err);
    h->capacity = capacity;
  }
  *out = (uint32_t)h->count;
  h->faces[h->count++] =
      (Face){.v = {a, b, c}, .next = {NONE, NONE, NONE}, .outside = NONE, .farthest = NONE};
  return CAG_OK;
}

// Assigns the point to the face if the face is visible from it.
static bool offer(Hull *h, uint32_t face, uint32_t p) {
  Face *f = &h->faces[face];
  if (!sees(h, f, p)) return false;
  const double height = cag_dot(face_cross(h, f), cag_sub(h->points[p], h->points[f->v[0]]));
  h->chain[p] = f->outside;
  f->outside = p;
  if (f->farthest == NONE || height > f->height) {
    f->farthest = p;
    f->height = height;
  }
  return true;
}

static uint32_t farthest_from(const Hull *h,
                              double (*measure)(const Hull *, const uint32_t *, CagVec3),
                              const uint32_t *base, double *most) {
  uint32_t best = 0;
  *most = -1;
  for (size_t i = 0; i < h->n && !cag_stopped(); i++) {
    const double d = measure(h, base, h->points[i]);
    if (d > *most) {
      *most = d;
      best = (uint32_t)i;
    }
  }
  return best;
}

static double measure_point(const Hull *h, const uint32_t *base, CagVec3 p) {
  return cag_norm(cag_sub(p, h->points[base[0]]));
}

static double measure_line(const Hull *h, const uint32_t *base, CagVec3 p) {
  return from_line(p, h->points[base[0]], h->points[base[1]]);
}

static double measure_plane(const Hull *h, const uint32_t *base, CagVec3 p) {
  const CagVec3 a = h->points[base[0]];
  const CagVec3 n =
      cag_unit(cag_cross(cag_sub(h->points[base[1]], a), cag_sub(h->points[base[2]], a)));
  return fabs(cag_dot(n, cag_sub(p, a)));
}

// Four points that are not coplanar, b[3] below the plane of the others.
static CagStatus first_points(const Hull *h, uint32_t b[4], CagError *err) {
  double most;
  b[0] = 0;
  b[0] = farthest_from(h, measure_point, b, &most);
  b[1] = farthest_from(h, measure_point, b, &most);
  if (cag_stop_check(err)) return err->status;
  if (most <= h->slack) return fail_coincident(err);
  b[2] = farthest_from(h, measure_line, b, &most);
  if (cag_stop_check(err)) return err->status;
  if (most <= h->slack) return fail_collinear(err);
  b[3] = farthest_from(h, measure_plane, b, &most);
  if (cag_stop_check(err)) return err->status;
  const int side =
      cag_side_of_plane(h->points[b[0]], h->points[b[1]], h->points[b[2]], h->points[b[3]]);
  if (most <= h->slack || side == 0)
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_coplanar_points, "points", -1,
        "all `points` are in one plane, so their hull has no volume; write them as points [x, y], or add a point outside of the plane");
  if (side > 0) {
    const uint32_t swap = b[0];
    b[0] = b[1];
    b[1] = swap;
  }
  return CAG_OK;
}

static CagStatus first_faces(Hull *h, CagError *err) {
  static const int corner[4][3] = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
  static const uint32_t next[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  uint32_t b[4], id;
  CagStatus status = first_points(h, b, err);
  for (int i = 0; !status && i < 4; i++) {
    status = new_face(h, b[corner[i][0]], b[corner[i][1]], b[corner[i][2]], &id, err);
    if (!status) memcpy(h->faces[id].next, next[i], sizeof next[i]);
  }
  for (uint32_t p = 0; !status && p < h->n; p++) {
    for (uint32_t f = 0; f < 4 && !offer(h, f, p); f++) {}
    status = cag_stop_check(err);
  }
  return status;
}

// Collects all faces visible from p in h->seen, starting with one.
static void flood(Hull *h, uint32_t from, uint32_t p) {
  h->round++;
  h->seen_n = 0;
  h->seen[h->seen_n++] = from;
  h->faces[from].mark = h->round;
  for (size_t i = 0; i < h->seen_n; i++)
    for (int e = 0; e < 3; e++) {
      const uint32_t g = h->faces[h->seen[i]].next[e];
      if (h->faces[g].mark == h->round || !sees(h, &h->faces[g], p)) continue;
      h->faces[g].mark = h->round;
      h->seen[h->seen_n++] = g;
    }
}

static int edge_from(const Face *f, uint32_t v) { return f->v[0] == v ? 0 : f->v[1] == v ? 1 : 2; }

// Adds a fan from p over the horizon of the faces in h->seen; the new faces are the last ones.
static CagStatus cone(Hull *h, uint32_t p, CagError *err) {
  const size_t first = h->count;
  for (size_t i = 0; i < h->seen_n; i++)
    for (int e = 0; e < 3; e++) {
      const Face f = h->faces[h->seen[i]];
      const uint32_t g = f.next[e], a = f.v[e], b = f.v[(e + 1) % 3];
      uint32_t id;
      if (h->faces[g].mark == h->round) continue;
      CagStatus status = new_face(h, a, b, p, &id, err);
      if (status) return status;
      h->faces[id].next[0] = g;
      h->faces[g].next[edge_from(&h->faces[g], b)] = id;
      h->rim_of[a] = id;
    }
  for (size_t id = first; id < h->count; id++) {
    const uint32_t after = h->rim_of[h->faces[id].v[1]];
    h->faces[id].next[1] = after;
    h->faces[after].next[2] = (uint32_t)id;
  }
  return CAG_OK;
}

// Adds the farthest point beyond the face to the hull.
static CagStatus take_in(Hull *h, uint32_t face, CagError *err) {
  const uint32_t p = h->faces[face].farthest;
  flood(h, face, p);
  const size_t first = h->count;
  CagStatus status = cone(h, p, err);
  if (!status) status = cag_stop_check(err);
  for (size_t i = 0; !status && i < h->seen_n; i++) {
    Face *f = &h->faces[h->seen[i]];
    f->dead = true;
    for (uint32_t q = f->outside, after; q != NONE; q = after) {
      if (cag_stop_check(err)) return err->status;
      after = h->chain[q];
      for (size_t id = first; q != p && id < h->count && !offer(h, (uint32_t)id, q); id++) {}
    }
    f->outside = NONE;
  }
  return status;
}

// --- Flat faces ---

typedef struct Flat {
  double area;
  uint32_t face;
} Flat;

static int larger_first(const void *a, const void *b) {
  const Flat *f = a, *g = b;
  if (f->area != g->area) return f->area > g->area ? -1 : 1;
  return (f->face > g->face) - (f->face < g->face);
}

// In a solid as thin as rounding the opposite side is within the tolerance too, but faces the other
// way. Triangles as thin as rounding may face anywhere.
static bool looks_away(const Hull *h, const Face *f, CagVec3 normal) {
  const CagVec3 cross = face_cross(h, f);
  double longest = 0;
  for (int e = 0; e < 3; e++)
    longest = fmax(longest, cag_norm(cag_sub(h->points[f->v[e]], h->points[f->v[(e + 1) % 3]])));
  return cag_dot(cross, normal) < 0 && cag_norm(cross) > 2 * h->slack * longest;
}

// Assigns the number of its flat face to each triangle in `flat`; the largest triangle of each
// determines its plane.
static CagStatus find_flats(Hull *h, uint32_t *flat, size_t *flats, CagError *err) {
  Flat *order = cag_malloc(h->count * sizeof *order);
  if (!order) return cag_fail_memory(err);
  for (uint32_t i = 0; i < h->count; i++) {
    order[i] = (Flat){cag_norm(face_cross(h, &h->faces[i])), i};
    flat[i] = NONE;
  }
  CagStatus status = cag_sort(order, h->count, sizeof *order, larger_first, err);
  *flats = 0;
  for (size_t k = 0; !status && k < h->count; k++) {
    status = cag_stop_check(err);
    const uint32_t seed = order[k].face;
    if (h->faces[seed].dead || flat[seed] != NONE) continue;
    const CagVec3 normal = cag_unit(face_cross(h, &h->faces[seed]));
    const CagVec3 at = h->points[h->faces[seed].v[0]];
    const uint32_t number = (uint32_t)(*flats)++;
    size_t n = 0;
    h->seen[n++] = seed;
    flat[seed] = number;
    for (size_t i = 0; i < n; i++)
      for (int e = 0; e < 3; e++) {
        const uint32_t g = h->faces[h->seen[i]].next[e];
        const Face *f = &h->faces[g];
        bool within = flat[g] == NONE;
        for (int c = 0; within && c < 3; c++)
          within = fabs(cag_dot(normal, cag_sub(h->points[f->v[c]], at))) <= h->slack;
        if (!within || looks_away(h, f, normal)) continue;
        flat[g] = number;
        h->seen[n++] = g;
      }
  }
  cag_free(order);
  return status;
}

// For each point, counts the flat faces that have it on their rim, by the rim edges that leave it.
static void count_rims(const Hull *h, const uint32_t *flat, uint32_t *rims) {
  memset(rims, 0, h->n * sizeof *rims);
  for (size_t i = 0; i < h->count; i++)
    for (int e = 0; !h->faces[i].dead && e < 3; e++)
      if (flat[h->faces[i].next[e]] != flat[i]) rims[h->faces[i].v[e]]++;
}

// Collects all vertices of the rim of a flat face, starting at edge e of a triangle, in `ring`;
// returns their number. Marks the edges.
static size_t walk_rim(const Hull *h, const uint32_t *flat, uint8_t *walked, uint32_t face, int e,
                       uint32_t *ring) {
  size_t n = 0;
  while (!(walked[face] & 1 << e)) {
    walked[face] |= (uint8_t)(1 << e);
    ring[n++] = h->faces[face].v[e];
    // The next rim edge around the end of this one.
    const uint32_t end = h->faces[face].v[(e + 1) % 3];
    e = (e + 1) % 3;
    while (flat[h->faces[face].next[e]] == flat[face]) {
      face = h->faces[face].next[e];
      e = edge_from(&h->faces[face], end);
    }
  }
  return n;
}

static double from_segment(CagVec3 p, CagVec3 a, CagVec3 b) {
  const CagVec3 d = cag_sub(b, a);
  const double along = cag_dot(d, cag_sub(p, a)) / cag_dot(d, d);
  return cag_norm(cag_sub(p, cag_lerp(a, b, fmax(0, fmin(1, along)))));
}

// Keeps the vertices of a rim that belong to three or more flat faces, and returns their number. In
// a solid as thin as rounding, two flat faces may share an edge that is not straight; then it
// returns 0.
static size_t keep_corners(const Hull *h, const uint32_t *rims, uint32_t *ring, size_t n) {
  size_t first = 0, kept = 0;
  while (first < n && rims[ring[first]] < 3) first++;
  for (size_t k = first, end; k < n; k = end) {
    for (end = k + 1; rims[ring[end % n]] < 3; end++) {}
    const CagVec3 from = h->points[ring[k]], to = h->points[ring[end % n]];
    for (size_t i = k + 1; i < end; i++)
      if (from_segment(h->points[ring[i % n]], from, to) > 2 * h->slack) return 0;
  }
  for (size_t i = 0; i < n; i++)
    if (rims[ring[i]] >= 3) ring[kept++] = ring[i];
  return kept;
}

typedef struct Rings {
  uint32_t *vertices, *counts;
  size_t rings, total;
} Rings;

// Returns false if the flat faces do not form a polyhedron (a solid as thin as rounding).
static bool collect_rings(const Hull *h, const uint32_t *flat, size_t flats, const uint32_t *rims,
                          uint8_t *walked, Rings *out) {
  size_t corners = 0;
  out->rings = out->total = 0;
  for (uint32_t i = 0; i < h->count; i++)
    for (int e = 0; !h->faces[i].dead && e < 3; e++) {
      if (flat[h->faces[i].next[e]] == flat[i] || walked[i] & 1 << e) continue;
      if (out->rings == flats) return false;
      uint32_t *ring = out->vertices + out->total;
      const size_t n = keep_corners(h, rims, ring, walk_rim(h, flat, walked, i, e, ring));
      if (n < 3) return false;
      out->counts[out->rings++] = (uint32_t)n;
      out->total += n;
    }
  for (size_t i = 0; i < h->n; i++) corners += rims[i] >= 3;
  return out->rings == flats && corners + flats == out->total / 2 + 2; // Euler
}

static CagStatus mesh_of_rings(const Hull *h, const Rings *r, uint32_t *number, CagMesh **out,
                               CagError *err) {
  CagMesh *m;
  uint32_t vertices = 0;
  size_t at = 0, t = 0;
  for (size_t i = 0; i < h->n; i++) number[i] = NONE;
  for (size_t i = 0; i < r->total; i++)
    if (number[r->vertices[i]] == NONE) number[r->vertices[i]] = vertices++;
  CagStatus status = cag_mesh_new(vertices, r->total - 2 * r->rings, false, false, false, &m, err);
  if (status) return status;
  for (size_t i = 0; i < r->total; i++)
    m->positions[number[r->vertices[i]]] = h->points[r->vertices[i]];
  for (size_t k = 0; k < r->rings; at += r->counts[k++])
    for (size_t i = 1; i + 1 < r->counts[k]; i++) {
      m->triangles[t++] = number[r->vertices[at]];
      m->triangles[t++] = number[r->vertices[at + i]];
      m->triangles[t++] = number[r->vertices[at + i + 1]];
    }
  *out = m;
  return CAG_OK;
}

// Uses each triangle as a separate face; this hull is always closed.
static void collect_triangles(const Hull *h, Rings *out) {
  out->rings = out->total = 0;
  for (size_t i = 0; i < h->count; i++) {
    if (h->faces[i].dead) continue;
    memcpy(out->vertices + out->total, h->faces[i].v, sizeof h->faces[i].v);
    out->total += 3;
    out->counts[out->rings++] = 3;
  }
}

// The mesh is NULL if it is not closed: in a solid as thin as rounding, two flat faces may share
// more than one edge.
static CagStatus mesh_of_flats(const Hull *h, const Rings *r, uint32_t *number, CagMesh **out,
                               CagError *err) {
  bool closed;
  CagStatus status = mesh_of_rings(h, r, number, out, err);
  if (status) return status;
  status = cag_mesh_watertight(*out, &closed, NULL, err);
  if (!status && closed) return CAG_OK;
  cag_mesh_release(*out);
  *out = NULL;
  return status;
}

static CagStatus to_mesh(Hull *h, CagMesh **out, CagError *err) {
  const size_t n = h->count;
  size_t flats = 0;
  CagMesh *mesh = NULL;
  uint32_t *flat = cag_malloc(n * sizeof *flat), *rims = cag_malloc(h->n * sizeof *rims);
  Rings r = {cag_malloc(3 * n * sizeof(uint32_t)), cag_malloc(n * sizeof(uint32_t)), 0, 0};
  uint8_t *walked = cag_calloc(n, 1);
  CagStatus status =
      flat && rims && r.vertices && r.counts && walked ? CAG_OK : cag_fail_memory(err);
  if (!status) status = find_flats(h, flat, &flats, err);
  if (!status) {
    count_rims(h, flat, rims);
    if (collect_rings(h, flat, flats, rims, walked, &r))
      status = mesh_of_flats(h, &r, rims, &mesh, err);
  }
  if (!status && !mesh) {
    collect_triangles(h, &r);
    status = mesh_of_rings(h, &r, rims, &mesh, err);
  }
  if (!status) *out = mesh;
  cag_free(flat);
  cag_free(rims);
  cag_free(r.vertices);
  cag_free(r.counts);
  cag_free(walked);
  return status;
}

CagStatus cag_hull_space(const CagVec3 *points, size_t n, CagMesh **out, CagError *err) {
  CagStatus status = check(points, n, 4, err);
  if (status) return status;
  Hull h = {.points = points, .n = n, .slack = IN_PLANE * cag_curve_size(points, n)};
  h.chain = cag_malloc(n * sizeof *h.chain);
  h.rim_of = cag_malloc(n * sizeof *h.rim_of);
  if (!h.chain || !h.rim_of) status = cag_fail_memory(err);
  if (!status) status = first_faces(&h, err);
  for (uint32_t f = 0; !status && f < h.count; f++)
    if (!h.faces[f].dead && h.faces[f].outside != NONE) status = take_in(&h, f, err);
  if (!status) status = to_mesh(&h, out, err);
  cag_free(h.chain);
  cag_free(h.rim_of);
  cag_free(h.faces);
  cag_free(h.seen);
  return status;
}
