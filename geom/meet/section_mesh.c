// Plane sections of meshes, as polylines.
//
// A vertex in the plane counts as above it, as for sections of surfaces. Each triangle then has
// zero or two crossed edges, and every crossed edge of a closed mesh belongs to two triangles, so
// that the polylines close.

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/section.h"

// Vertices closer to the plane than this fraction of the size lie in it.
#define ON_PLANE 1e-13
// Points of a polyline closer than this fraction of the size are merged, and points this close to
// the line of their neighbors are dropped.
#define SAME CAG_ROUNDING

// One end of a segment: the edge that it crosses, lower vertex first.
typedef struct End {
  uint32_t low, high;
  size_t segment;
  int side;
} End;

typedef struct Cut {
  const CagMesh *m;
  const CagPlane *plane;
  double zero, size;
  End *ends;
  size_t count; // of ends, two to a segment
  CagVec3 *points;
  size_t (*next)[2]; // the end that each end of a segment meets
} Cut;

#define NO_END SIZE_MAX

static uint32_t welded(const CagMesh *m, uint32_t v) { return m->weld ? m->weld[v] : v; }

static double height(const Cut *c, uint32_t v) {
  double d = cag_dot(c->plane->normal, cag_sub(c->m->positions[v], c->plane->point));
  return fabs(d) <= c->zero ? 0 : d;
}

// From the lower vertex, for all triangles alike.
static CagVec3 crossing(const Cut *c, const End *e) {
  double a = height(c, e->low), b = height(c, e->high);
  CagVec3 p = c->m->positions[e->low], q = c->m->positions[e->high];
  return a == 0 ? p : b == 0 ? q : cag_lerp(p, q, a / (a - b));
}

static int by_edge(const void *a, const void *b) {
  const End *x = a, *y = b;
  if (x->low != y->low) return x->low < y->low ? -1 : 1;
  if (x->high != y->high) return x->high < y->high ? -1 : 1;
  return (x->segment > y->segment) - (x->segment < y->segment);
}

static void find_segments(Cut *c) {
  for (size_t t = 0; t < c->m->triangle_count; t++) {
    uint32_t v[3];
    bool below[3];
    for (int k = 0; k < 3; k++) {
      v[k] = welded(c->m, c->m->triangles[3 * t + (size_t)k]);
      below[k] = height(c, v[k]) < 0;
    }
    int side = 0;
    for (int k = 0; k < 3; k++) {
      uint32_t a = v[k], b = v[(k + 1) % 3];
      if (below[k] == below[(k + 1) % 3]) continue;
      c->ends[c->count] = (End){a < b ? a : b, a < b ? b : a, c->count / 2, side++};
      c->points[c->count] = crossing(c, &c->ends[c->count]);
      c->count++;
    }
  }
}

// Ends on one edge meet in pairs; if more than two triangles share it, in order.
static void link_ends(Cut *c) {
  for (size_t i = 0; i < c->count / 2; i++) c->next[i][0] = c->next[i][1] = NO_END;
  qsort(c->ends, c->count, sizeof *c->ends, by_edge);
  for (size_t i = 0; i + 1 < c->count; i++) {
    const End *a = &c->ends[i], *b = &c->ends[i + 1];
    if (a->low != b->low || a->high != b->high) continue;
    c->next[a->segment][a->side] = 2 * b->segment + (size_t)b->side;
    c->next[b->segment][b->side] = 2 * a->segment + (size_t)a->side;
    i++;
  }
}

// Adds a point unless it equals the last one; the last one is dropped if it is on the line to the
// new one.
static void add_point(const Cut *c, CagVec3 *out, size_t *n, CagVec3 p) {
  double same = SAME * c->size;
  if (*n > 0 && cag_norm(cag_sub(p, out[*n - 1])) <= same) return;
  if (*n > 1) {
    CagVec3 before = cag_sub(out[*n - 1], out[*n - 2]), along = cag_unit(cag_sub(p, out[*n - 2]));
    bool forward = cag_dot(before, along) > 0;
    if (forward && cag_norm(cag_cross(before, along)) <= same) (*n)--;
  }
  out[(*n)++] = p;
}

static CagStatus add_polyline(const Cut *c, CagVec3 *points, size_t n, bool closed,
                              CagCurveList *out, CagError *err) {
  double same = SAME * c->size;
  while (closed && n > 1 && cag_norm(cag_sub(points[n - 1], points[0])) <= same) n--;
  if (closed && n > 2) {
    CagVec3 before = cag_sub(points[0], points[n - 1]);
    CagVec3 along = cag_unit(cag_sub(points[1], points[n - 1]));
    if (cag_dot(before, along) > 0 && cag_norm(cag_cross(before, along)) <= same) {
      points[0] = points[n - 1];
      n--;
    }
  }
  if (n < (closed ? 3u : 2u)) return CAG_OK;
  CagCurve *line = NULL;
  CagStatus status = cag_curve_polyline(points, n, closed, 3, &line, err);
  return status ? status : cag_curve_list_add(out, line, err);
}

// Follows a polyline from one end of a segment; returns the number of points.
static size_t walk(const Cut *c, size_t segment, int from, bool *seen, CagVec3 *points) {
  size_t n = 0;
  add_point(c, points, &n, c->points[2 * segment + (size_t)from]);
  for (;;) {
    seen[segment] = true;
    int to = 1 - from;
    add_point(c, points, &n, c->points[2 * segment + (size_t)to]);
    size_t next = c->next[segment][to];
    if (next == NO_END || seen[next / 2]) return n;
    segment = next / 2;
    from = (int)(next % 2);
  }
}

static CagStatus walk_all(const Cut *c, CagCurveList *out, CagError *err) {
  size_t segments = c->count / 2;
  bool *seen = cag_calloc(segments + 1, sizeof *seen);
  CagVec3 *points = cag_malloc((segments + 2) * sizeof *points);
  CagStatus status = seen && points ? CAG_OK : cag_fail_memory(err);
  // Open runs first, from their ends. The others are closed.
  for (int round = 0; round < 2; round++)
    for (size_t i = 0; i < segments && !status; i++) {
      int open = c->next[i][0] == NO_END ? 0 : c->next[i][1] == NO_END ? 1 : -1;
      if (seen[i] || (round == 0 && open < 0)) continue;
      size_t n = walk(c, i, open < 0 ? 0 : open, seen, points);
      status = add_polyline(c, points, n, open < 0, out, err);
    }
  cag_free(seen);
  cag_free(points);
  return status;
}

CagStatus cag_mesh_section(const CagMesh *m, const CagPlane *plane, CagCurveList *out,
                           CagError *err) {
  CagBounds box = cag_mesh_bounds(m);
  double size = m->vertex_count > 0 ? cag_norm(cag_sub(box.max, box.min)) : 0;
  Cut c = {.m = m, .plane = plane, .size = size, .zero = ON_PLANE * size};
  c.ends = cag_malloc((2 * m->triangle_count + 1) * sizeof *c.ends);
  c.points = cag_malloc((2 * m->triangle_count + 1) * sizeof *c.points);
  c.next = cag_malloc((m->triangle_count + 1) * sizeof *c.next);
  CagStatus status = c.ends && c.points && c.next ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    find_segments(&c);
    link_ends(&c);
    status = walk_all(&c, out, err);
  }
  cag_free(c.ends);
  cag_free(c.points);
  cag_free(c.next);
  return status;
}
