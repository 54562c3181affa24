// Tessellation within outlines: a Delaunay triangulation of the parameter plane within loops of
// points, refined until its triangles are within the tolerance.
//
// The edges between the points of the outline are not divided. The vertices of the surface's own
// mesh over the box are inserted (Lawson), which brings the triangles near their final size;
// finally points are added in triangles that exceed the tolerance. The plane is scaled so that its
// lengths approximate those on the surface.
//
// Invariant of Plane: triangle t has corners corner[3t..] counter-clockwise; across[3t + k] is the
// triangle beyond the edge from corner k to corner k + 1, NO_TRIANGLE at the outline.

#include "geom/tessellate/within.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/mesh/edges.h"
#include "geom/surface/reshape.h"
#include "geom/tessellate/sides.h"
#include "geom/tessellate/tessellation.h"

#define NO_TRIANGLE UINT32_MAX

// Fraction of the tolerance for the mesh whose vertices are inserted: its triangles fit the
// surface, with a margin for those between them and the outline.
#define INNER_SHARE 0.7
// Points closer to an edge of the outline than this fraction of its length are skipped, because
// they would cause slivers.
#define KEEP_OFF 0.3
// An in-circle determinant below this fraction of its terms is rounding, and causes no flip.
#define ROUNDING CAG_ROUNDING
// An edge turns by as much as is allowed, up to rounding, if the outline was divided by this angle.
#define TURN_ROUNDING 1e-6
// Maximum number of passes over all triangles; each roughly halves those that exceed the tolerance.
#define MOST_PASSES 40

typedef struct Plane {
  const CagSurface *inner;
  double scale[2]; // from u and v to the plane
  double *xy;      // scaled
  CagVec3 *positions, *normals;
  double box[4];
  size_t vertex_count, vertex_capacity;
  uint32_t *corner, *across;
  unsigned char *checked; // the triangle is within the tolerance
  size_t triangle_count, triangle_capacity;
  uint32_t hint;
  uint32_t *stack; // triangles whose side 0, between corners 0 and 1, must be tested
  size_t depth, stack_capacity;
} Plane;

static void release(Plane *p) {
  cag_free(p->xy);
  cag_free(p->positions);
  cag_free(p->normals);
  cag_free(p->corner);
  cag_free(p->across);
  cag_free(p->checked);
  cag_free(p->stack);
}

// --- Room ---

static CagStatus add_vertex(Plane *p, double u, double v, uint32_t *out, CagError *err) {
  if (p->vertex_count == p->vertex_capacity) {
    size_t n = p->vertex_capacity ? 2 * p->vertex_capacity : 1024;
    if (!CAG_RESIZE(p->xy, 2 * n) || !CAG_RESIZE(p->positions, n) || !CAG_RESIZE(p->normals, n))
      return cag_fail_memory(err);
    p->vertex_capacity = n;
  }
  const CagSurface *s = p->inner;
  u = fmin(fmax(u, s->u0), s->u1);
  v = fmin(fmax(v, s->v0), s->v1);
  size_t k = p->vertex_count;
  CagError ignored;
  CagStatus status = cag_surface_point(s, u, v, &p->positions[k], err);
  if (status) return status;
  if (cag_surface_normal(s, u, v, &p->normals[k], &ignored)) p->normals[k] = cag_vec3(0, 0, 0);
  p->xy[2 * k] = u * p->scale[0];
  p->xy[2 * k + 1] = v * p->scale[1];
  p->vertex_count++;
  *out = (uint32_t)k;
  return CAG_OK;
}

static CagStatus room_for_triangles(Plane *p, size_t wanted, CagError *err) {
  if (wanted <= p->triangle_capacity) return CAG_OK;
  size_t n = p->triangle_capacity ? p->triangle_capacity : 1024;
  while (n < wanted) n *= 2;
  if (!CAG_RESIZE(p->corner, 3 * n) || !CAG_RESIZE(p->across, 3 * n) || !CAG_RESIZE(p->checked, n))
    return cag_fail_memory(err);
  p->triangle_capacity = n;
  return CAG_OK;
}

static CagStatus push(Plane *p, uint32_t triangle, CagError *err) {
  if (!CAG_RESERVE(p->stack, p->stack_capacity, p->depth + 1)) return cag_fail_memory(err);
  p->stack[p->depth++] = triangle;
  return CAG_OK;
}
// --- Outlines ---

void cag_loop_points_free(CagLoopPoints *o) {
  cag_free(o->uv);
  cag_free(o->positions);
  cag_free(o->points);
  *o = (CagLoopPoints){0};
}

CagStatus cag_loop_points_add(CagLoopPoints *o, double u, double v, CagVec3 position,
                              uint32_t point, CagError *err) {
  if (o->count == o->room) {
    const size_t n = o->room ? 2 * o->room : 64;
    if (!CAG_RESIZE(o->uv, 2 * n) || !CAG_RESIZE(o->positions, n) || !CAG_RESIZE(o->points, n))
      return cag_fail_memory(err);
    o->room = n;
  }
  o->uv[2 * o->count] = u;
  o->uv[2 * o->count + 1] = v;
  o->positions[o->count] = position;
  o->points[o->count++] = point;
  return CAG_OK;
}

CagStatus cag_loop_points_check(const CagLoopPoints *o, const CagTessellation *how, CagError *err) {
  if (o->count <= how->max_triangles + 2) return CAG_OK;
  return cag_fail(
      err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
      "the outline alone needs more triangles than the limit of %zu; use a larger tolerance",
      how->max_triangles);
}

// Total turn of the surface's normal from t0 to t1 of an outline, summed over steps.
static CagStatus turn_along(const CagSurface *inner, const CagCurve *trace, double t0, double t1,
                            double *turn, CagError *err) {
  enum { STEPS = 4 };
  CagVec3 at, before = {0}, normal;
  *turn = 0;
  for (int k = 0; k <= STEPS; k++) {
    CagStatus status = cag_curve_point(trace, t0 + (t1 - t0) * k / STEPS, &at, err);
    if (status) return status;
    // The curve may leave the domain by rounding.
    const double u = fmin(fmax(at.x, inner->u0), inner->u1);
    const double v = fmin(fmax(at.y, inner->v0), inner->v1);
    status = cag_surface_normal(inner, u, v, &normal, err);
    if (status) return status;
    if (k) *turn += atan2(cag_norm(cag_cross(before, normal)), cag_dot(before, normal));
    before = normal;
  }
  return CAG_OK;
}

CagStatus cag_loop_points_parts(const CagSurface *inner, const CagCurve *trace, double from,
                                double to, double length, const CagTessellation *how, size_t *parts,
                                CagError *err) {
  const double closely = 0.9, most = ceil(length / tess_short_edge(how));
  double n = 1;
  *parts = 1;
  if (!(how->angle > 0)) return CAG_OK;
  while (n < most) {
    double largest = 0;
    for (double k = 0; k < n; k++) {
      double turn;
      CagStatus status = turn_along(inner, trace, from + (to - from) * k / n,
                                    from + (to - from) * (k + 1) / n, &turn, err);
      if (status) return status;
      largest = fmax(largest, turn);
    }
    if (largest <= how->angle) break;
    n = fmin(most, ceil(n * largest / (closely * how->angle)));
  }
  *parts = (size_t)n;
  return CAG_OK;
}

// Ratio of lengths on the surface to lengths in the parameters: the mean over some points.
static CagStatus find_scale(Plane *p, CagError *err) {
  const int PLACES = 5;
  const double *box = p->box;
  double sum[2] = {0, 0};
  for (int i = 0; i < PLACES; i++)
    for (int j = 0; j < PLACES; j++) {
      CagVec3 d[4];
      CagStatus status = cag_surface_eval(p->inner, box[0] + (box[1] - box[0]) * (i + 0.5) / PLACES,
                                          box[2] + (box[3] - box[2]) * (j + 0.5) / PLACES, 1,
                                          CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
      if (status) return status;
      sum[0] += cag_norm(d[cag_partial(1, 1, 0)]);
      sum[1] += cag_norm(d[cag_partial(1, 0, 1)]);
    }
  for (int k = 0; k < 2; k++) p->scale[k] = sum[k] > 0 ? sum[k] / (PLACES * PLACES) : 1;
  return CAG_OK;
}

static CagStatus link_triangles(Plane *p, CagError *err) {
  size_t n;
  CagMeshEdge *edges = cag_mesh_edges(p->corner, p->triangle_count, NULL, p->vertex_count, &n);
  if (!edges) return cag_fail_memory(err);
  for (size_t k = 0; k < 3 * p->triangle_count; k++) p->across[k] = NO_TRIANGLE;
  for (size_t k = 0; k + 1 < n; k++) {
    const CagMeshEdge *a = &edges[k], *b = &edges[k + 1];
    if (a->low != b->low || a->high != b->high) continue;
    size_t ta = cag_mesh_edge_triangle(a), tb = cag_mesh_edge_triangle(b);
    p->across[3 * ta + cag_mesh_edge_corner(a)] = (uint32_t)tb;
    p->across[3 * tb + cag_mesh_edge_corner(b)] = (uint32_t)ta;
  }
  cag_free(edges);
  return CAG_OK;
}

static CagStatus add_outline(Plane *p, const CagLoopPoints *o, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t k = 0; !status && k < o->count; k++) {
    uint32_t vertex;
    status = add_vertex(p, o->uv[2 * k], o->uv[2 * k + 1], &vertex, err);
    if (!status) p->positions[vertex] = o->positions[k];
  }
  return status;
}

static CagStatus begin(Plane *p, const CagLoopPoints *o, CagError *err) {
  uint32_t *triangles = NULL;
  size_t n = 0;
  CagStatus status = find_scale(p, err);
  if (!status) status = add_outline(p, o, err);
  if (!status) status = cag_triangulate(p->xy, o->counts, o->loops, &triangles, &n, err);
  if (!status) status = room_for_triangles(p, n, err);
  if (!status) {
    memcpy(p->corner, triangles, 3 * n * sizeof *triangles);
    memset(p->checked, 0, n);
    p->triangle_count = n;
    status = link_triangles(p, err);
  }
  cag_free(triangles);
  return status;
}

// --- Insertion ---

static double side_of(const double *a, const double *b, const double *c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static const double *at(const Plane *p, uint32_t vertex) { return p->xy + 2 * vertex; }

// Whether d lies inside the circle through a, b, c (counter-clockwise), by more than rounding.
static bool in_circle(const double *a, const double *b, const double *c, const double *d) {
  double ax = a[0] - d[0], ay = a[1] - d[1], bx = b[0] - d[0], by = b[1] - d[1];
  double cx = c[0] - d[0], cy = c[1] - d[1];
  double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  double x = aa * (bx * cy - by * cx), y = bb * (cx * ay - cy * ax), z = cc * (ax * by - ay * bx);
  double size = aa * (fabs(bx * cy) + fabs(by * cx)) + bb * (fabs(cx * ay) + fabs(cy * ax)) +
                cc * (fabs(ax * by) + fabs(ay * bx));
  return x + y + z > ROUNDING * size;
}

static void set_across(Plane *p, uint32_t triangle, uint32_t was, uint32_t now) {
  if (triangle == NO_TRIANGLE) return;
  for (int k = 0; k < 3; k++)
    if (p->across[3 * triangle + (uint32_t)k] == was) {
      p->across[3 * triangle + (uint32_t)k] = now;
      return;
    }
}

static void set_triangle(Plane *p, uint32_t t, uint32_t a, uint32_t b, uint32_t c, uint32_t ab,
                         uint32_t bc, uint32_t ca) {
  const uint32_t corner[3] = {a, b, c}, across[3] = {ab, bc, ca};
  memcpy(p->corner + 3 * t, corner, sizeof corner);
  memcpy(p->across + 3 * t, across, sizeof across);
  p->checked[t] = 0;
}

static int side_towards(const Plane *p, uint32_t t, uint32_t other) {
  for (int k = 0; k < 3; k++)
    if (p->across[3 * t + (uint32_t)k] == other) return k;
  return -1;
}

// Flips the edge between t, whose corner 2 is the new vertex, and the triangle beyond its side 0 if
// that makes them Delaunay. After a flip the two outer edges of the former other triangle must be
// tested.
static CagStatus legalize(Plane *p, uint32_t t, CagError *err) {
  uint32_t o = p->across[3 * t];
  if (o == NO_TRIANGLE) return CAG_OK;
  int back = side_towards(p, o, t);
  uint32_t a = p->corner[3 * t], b = p->corner[3 * t + 1], c = p->corner[3 * t + 2];
  uint32_t d = p->corner[3 * o + (uint32_t)(back + 2) % 3];
  if (!in_circle(at(p, a), at(p, b), at(p, c), at(p, d))) return CAG_OK;
  if (!(side_of(at(p, a), at(p, d), at(p, c)) > 0 && side_of(at(p, d), at(p, b), at(p, c)) > 0))
    return CAG_OK;
  uint32_t bc = p->across[3 * t + 1], ca = p->across[3 * t + 2];
  uint32_t ad = p->across[3 * o + (uint32_t)(back + 1) % 3];
  uint32_t db = p->across[3 * o + (uint32_t)(back + 2) % 3];
  set_triangle(p, t, a, d, c, ad, o, ca);
  set_triangle(p, o, d, b, c, db, bc, t);
  set_across(p, ad, o, t);
  set_across(p, bc, t, o);
  CagStatus status = push(p, t, err);
  return status ? status : push(p, o, err);
}

static CagStatus legalize_all(Plane *p, CagError *err) {
  CagStatus status = CAG_OK;
  while (!status && p->depth > 0) { status = legalize(p, p->stack[--p->depth], err); }
  return status;
}

// Splits triangle t into three around the vertex.
static CagStatus split_triangle(Plane *p, uint32_t t, uint32_t v, CagError *err) {
  CagStatus status = room_for_triangles(p, p->triangle_count + 2, err);
  if (status) return status;
  uint32_t a = p->corner[3 * t], b = p->corner[3 * t + 1], c = p->corner[3 * t + 2];
  uint32_t ab = p->across[3 * t], bc = p->across[3 * t + 1], ca = p->across[3 * t + 2];
  uint32_t x = (uint32_t)p->triangle_count, y = x + 1;
  p->triangle_count += 2;
  set_triangle(p, t, a, b, v, ab, x, y);
  set_triangle(p, x, b, c, v, bc, y, t);
  set_triangle(p, y, c, a, v, ca, t, x);
  set_across(p, bc, t, x);
  set_across(p, ca, t, y);
  status = push(p, t, err);
  if (!status) status = push(p, x, err);
  if (!status) status = push(p, y, err);
  return status ? status : legalize_all(p, err);
}

// Splits the edge between t and the triangle beyond its side at the vertex: two triangles become
// four.
static CagStatus split_edge(Plane *p, uint32_t t, int side, uint32_t v, CagError *err) {
  CagStatus status = room_for_triangles(p, p->triangle_count + 2, err);
  if (status) return status;
  uint32_t o = p->across[3 * t + (uint32_t)side];
  int back = side_towards(p, o, t);
  uint32_t a = p->corner[3 * t + (uint32_t)side], b = p->corner[3 * t + (uint32_t)(side + 1) % 3];
  uint32_t c = p->corner[3 * t + (uint32_t)(side + 2) % 3];
  uint32_t d = p->corner[3 * o + (uint32_t)(back + 2) % 3];
  uint32_t bc = p->across[3 * t + (uint32_t)(side + 1) % 3];
  uint32_t ca = p->across[3 * t + (uint32_t)(side + 2) % 3];
  uint32_t ad = p->across[3 * o + (uint32_t)(back + 1) % 3];
  uint32_t db = p->across[3 * o + (uint32_t)(back + 2) % 3];
  uint32_t x = (uint32_t)p->triangle_count, y = x + 1;
  p->triangle_count += 2;
  set_triangle(p, t, c, a, v, ca, o, x);
  set_triangle(p, x, b, c, v, bc, t, y);
  set_triangle(p, o, a, d, v, ad, y, t);
  set_triangle(p, y, d, b, v, db, x, o);
  set_across(p, bc, t, x);
  set_across(p, db, o, y);
  status = push(p, t, err);
  if (!status) status = push(p, x, err);
  if (!status) status = push(p, o, err);
  if (!status) status = push(p, y, err);
  return status ? status : legalize_all(p, err);
}

static bool holds(const Plane *p, uint32_t t, const double *q) {
  for (int k = 0; k < 3; k++)
    if (side_of(at(p, p->corner[3 * t + (uint32_t)k]),
                at(p, p->corner[3 * t + (uint32_t)(k + 1) % 3]), q) < 0)
      return false;
  return true;
}

// The triangle that contains a point: a walk towards it, and a search of all triangles if the
// outline is in the way.
static uint32_t locate(Plane *p, const double *q) {
  uint32_t t = p->hint < p->triangle_count ? p->hint : 0;
  for (size_t steps = 0; steps < p->triangle_count; steps++) {
    int leave = -1;
    for (int k = 0; k < 3 && leave < 0; k++) {
      int side = (int)((steps + (size_t)k) % 3); // vary the first side to avoid cycles
      if (side_of(at(p, p->corner[3 * t + (uint32_t)side]),
                  at(p, p->corner[3 * t + (uint32_t)(side + 1) % 3]), q) < 0)
        leave = side;
    }
    if (leave < 0) return p->hint = t;
    t = p->across[3 * t + (uint32_t)leave];
    if (t == NO_TRIANGLE) break;
  }
  for (t = 0; t < p->triangle_count; t++)
    if (holds(p, t, q)) return p->hint = t;
  return NO_TRIANGLE;
}

static double apart(const double *a, const double *b) { return hypot(a[0] - b[0], a[1] - b[1]); }

// Whether a point of triangle t is far enough from the outline and from vertices.
static bool is_clear(const Plane *p, uint32_t t, const double *q) {
  for (int k = 0; k < 3; k++) {
    const double *a = at(p, p->corner[3 * t + (uint32_t)k]);
    const double *b = at(p, p->corner[3 * t + (uint32_t)(k + 1) % 3]);
    double length = apart(a, b);
    if (p->across[3 * t + (uint32_t)k] == NO_TRIANGLE &&
        side_of(a, b, q) < KEEP_OFF * length * length)
      return false;
    // Too close to a vertex, relative to the shortest edge that the point would halve.
    if (apart(a, q) < ROUNDING * length) return false;
  }
  return true;
}

// The side of t that contains the point, -1: none.
static int on_side(const Plane *p, uint32_t t, const double *q) {
  for (int k = 0; k < 3; k++) {
    const double *a = at(p, p->corner[3 * t + (uint32_t)k]);
    const double *b = at(p, p->corner[3 * t + (uint32_t)(k + 1) % 3]);
    double length = apart(a, b);
    const double flat = 1e-7; // relative to the edge: a triangle this flat is degenerate
    if (side_of(a, b, q) < flat * length * length) return k;
  }
  return -1;
}

static CagStatus insert(Plane *p, double u, double v, uint32_t t, CagError *err) {
  uint32_t vertex;
  double q[2] = {u * p->scale[0], v * p->scale[1]};
  int side = on_side(p, t, q);
  if (side >= 0 && p->across[3 * t + (uint32_t)side] == NO_TRIANGLE) return CAG_OK;
  CagStatus status = add_vertex(p, u, v, &vertex, err);
  if (status) return status;
  return side >= 0 ? split_edge(p, t, side, vertex, err) : split_triangle(p, t, vertex, err);
}

// --- Points of the inner surface's mesh ---

static CagStatus insert_mesh(Plane *p, const CagTessellation *how, CagError *err) {
  const double *b = p->box;
  CagSurface *box;
  CagMesh *mesh;
  CagTessellation finer = *how;
  finer.tolerance *= INNER_SHARE;
  CagStatus status = cag_surface_part(p->inner, b[0], b[1], b[2], b[3], &box, err);
  if (status) return status;
  status = cag_surface_tessellate(box, &finer, &mesh, err);
  cag_surface_release(box);
  if (status) return status;
  for (size_t k = 0; !status && k < mesh->vertex_count; k++) {
    double u = mesh->uv[2 * k], v = mesh->uv[2 * k + 1];
    double q[2] = {u * p->scale[0], v * p->scale[1]};
    uint32_t t = locate(p, q);
    if (t == NO_TRIANGLE || !is_clear(p, t, q)) continue;
    status = insert(p, u, v, t, err);
    if (!status && how->interrupt && *how->interrupt)
      status = cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                        "the tessellation was interrupted");
  }
  cag_mesh_release(mesh);
  return status;
}

// --- Refinement ---

static CagStatus surface_at(const Plane *p, const double *xy, CagVec3 *out, CagError *err) {
  const CagSurface *s = p->inner;
  return cag_surface_point(s, fmin(fmax(xy[0] / p->scale[0], s->u0), s->u1),
                           fmin(fmax(xy[1] / p->scale[1], s->v0), s->v1), out, err);
}

static double from_line(CagVec3 a, CagVec3 b, CagVec3 q) {
  CagVec3 d = cag_sub(b, a);
  double length = cag_norm(d);
  if (!(length > 0)) return cag_norm(cag_sub(q, a));
  return cag_norm(cag_cross(d, cag_sub(q, a))) / length;
}

// Whether an inner edge of a triangle exceeds the tolerance.
static CagStatus judge_edge(const Plane *p, uint32_t a, uint32_t b, const CagTessellation *how,
                            bool *bad, CagError *err) {
  const CagVec3 x = p->positions[a], y = p->positions[b], n = p->normals[a], m = p->normals[b];
  const double half[2] = {(at(p, a)[0] + at(p, b)[0]) / 2, (at(p, a)[1] + at(p, b)[1]) / 2};
  const double length = cag_norm(cag_sub(y, x));
  CagVec3 q;
  CagStatus status = surface_at(p, half, &q, err);
  if (status) return status;
  const double turn = atan2(cag_norm(cag_cross(n, m)), cag_dot(n, m));
  *bad = from_line(x, y, q) > how->tolerance ||
         (how->angle > 0 && turn > (1 + TURN_ROUNDING) * how->angle &&
          length > tess_short_edge(how)) ||
         (how->max_edge > 0 && length > how->max_edge);
  return CAG_OK;
}

// Whether a triangle exceeds the tolerance, and where to divide it: at the middle of its longest
// inner edge, of those that exceed it if there are some, or (`*side` -1) at its center.
static CagStatus judge(const Plane *p, uint32_t t, const CagTessellation *how, bool *bad, int *side,
                       CagError *err) {
  const uint32_t *c = p->corner + 3 * t;
  const CagVec3 *x = p->positions;
  double longest = 0, middle[2] = {0, 0};
  CagVec3 q;
  bool bad_edge = false;
  *side = -1;
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 2; d++) middle[d] += at(p, c[k])[d] / 3;
  const CagVec3 normal = cag_unit(cag_cross(cag_sub(x[c[1]], x[c[0]]), cag_sub(x[c[2]], x[c[0]])));
  CagStatus status = surface_at(p, middle, &q, err);
  for (int k = 0; !status && k < 3; k++) {
    const uint32_t next = c[(k + 1) % 3];
    bool exceeds;
    if (p->across[3 * t + (uint32_t)k] == NO_TRIANGLE) continue;
    status = judge_edge(p, c[k], next, how, &exceeds, err);
    const double flat = apart(at(p, c[k]), at(p, next));
    if (status || exceeds < bad_edge || (exceeds == bad_edge && flat <= longest)) continue;
    bad_edge = exceeds;
    longest = flat;
    *side = k;
  }
  *bad = bad_edge || fabs(cag_dot(normal, cag_sub(q, x[c[0]]))) > how->tolerance;
  return status;
}

static CagStatus divide(Plane *p, uint32_t t, int side, CagError *err) {
  const uint32_t *c = p->corner + 3 * t;
  double q[2];
  for (int d = 0; d < 2; d++)
    q[d] = side >= 0 ? (at(p, c[side])[d] + at(p, c[(side + 1) % 3])[d]) / 2
                     : (at(p, c[0])[d] + at(p, c[1])[d] + at(p, c[2])[d]) / 3;
  uint32_t vertex;
  CagStatus status = add_vertex(p, q[0] / p->scale[0], q[1] / p->scale[1], &vertex, err);
  if (status) return status;
  return side >= 0 ? split_edge(p, t, side, vertex, err) : split_triangle(p, t, vertex, err);
}

static CagStatus refine(Plane *p, const CagTessellation *how, CagError *err) {
  for (int pass = 0; pass < MOST_PASSES; pass++) {
    size_t n = p->triangle_count;
    bool any = false;
    for (uint32_t t = 0; t < n; t++) {
      if (p->checked[t]) continue;
      bool bad;
      int side;
      CagStatus status = judge(p, t, how, &bad, &side, err);
      if (!status && bad) status = divide(p, t, side, err);
      if (status) return status;
      if (!bad) p->checked[t] = 1;
      any = any || bad;
      if (p->triangle_count > how->max_triangles)
        return cag_fail(
            err, CAG_E_LIMIT, CAG_ERR_limit_triangles, "tolerance", -1,
            "the trimmed surface needs more triangles than the limit of %zu; use a larger tolerance",
            how->max_triangles);
    }
    if (how->interrupt && *how->interrupt)
      return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1,
                      "the tessellation was interrupted");
    if (!any) return CAG_OK;
  }
  return CAG_OK;
}

// --- Edges that must not be ---

static int by_pair(const void *a, const void *b) {
  const uint32_t *x = a, *y = b;
  for (int k = 0; k < 2; k++)
    if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
  return 0;
}

static bool must_not_join(const CagLoopPoints *o, uint32_t a, uint32_t b) {
  if (a >= o->count || b >= o->count) return false;
  const uint32_t p = o->points[a], q = o->points[b], key[2] = {p < q ? p : q, p < q ? q : p};
  return bsearch(key, o->apart, o->apart_count, sizeof *o->apart, by_pair) != NULL;
}

// Divides the inner edges between points that must not be joined.
static CagStatus part_points(Plane *p, const CagLoopPoints *o, CagError *err) {
  CagStatus status = CAG_OK;
  for (uint32_t t = 0; !status && o->apart_count > 0 && t < p->triangle_count; t++)
    for (int k = 0; !status && k < 3; k++) {
      const uint32_t *c = p->corner + 3 * t;
      if (p->across[3 * t + (uint32_t)k] != NO_TRIANGLE && must_not_join(o, c[k], c[(k + 1) % 3]))
        status = divide(p, t, k, err);
    }
  return status;
}

// --- The mesh ---

// The first vertex of each point.
static CagStatus weld_outline(const CagLoopPoints *o, uint32_t *weld, CagError *err) {
  uint32_t most = 0;
  for (size_t k = 0; k < o->count; k++) most = most < o->points[k] ? o->points[k] : most;
  uint32_t *first = cag_malloc(((size_t)most + 1) * sizeof *first);
  if (!first) return cag_fail_memory(err);
  for (size_t k = o->count; k-- > 0;) first[o->points[k]] = (uint32_t)k;
  for (size_t k = 0; k < o->count; k++) weld[k] = first[o->points[k]];
  cag_free(first);
  return CAG_OK;
}

static CagStatus to_mesh(Plane *p, const CagLoopPoints *o, CagMesh **out, CagError *err) {
  CagMesh *m;
  CagStatus status = cag_mesh_new(p->vertex_count, p->triangle_count, true, true, true, &m, err);
  if (status) return status;
  for (size_t k = o->count; k < p->vertex_count; k++) m->weld[k] = (uint32_t)k;
  status = weld_outline(o, m->weld, err);
  if (status) {
    cag_mesh_release(m);
    return status;
  }
  size_t n = 0;
  for (size_t t = 0; t < p->triangle_count; t++) {
    const uint32_t *c = p->corner + 3 * t, *w = m->weld;
    // At a pole two corners are one point: the triangle is empty.
    if (w[c[0]] == w[c[1]] || w[c[1]] == w[c[2]] || w[c[2]] == w[c[0]]) continue;
    memcpy(m->triangles + 3 * n++, c, 3 * sizeof *c);
  }
  m->triangle_count = n;
  for (size_t k = 0; k < p->vertex_count; k++) {
    m->positions[k] = p->positions[k];
    m->normals[k] = p->normals[k];
    m->uv[2 * k] = p->xy[2 * k] / p->scale[0];
    m->uv[2 * k + 1] = p->xy[2 * k + 1] / p->scale[1];
  }
  // Vertices without a normal take those of their triangles.
  for (size_t t = 0; t < n; t++)
    for (int k = 0; k < 3; k++) {
      uint32_t v = m->triangles[3 * t + (size_t)k];
      if (cag_dot(p->normals[v], p->normals[v]) > 0) continue;
      const uint32_t *c = m->triangles + 3 * t;
      m->normals[v] =
          cag_add(m->normals[v], cag_cross(cag_sub(m->positions[c[1]], m->positions[c[0]]),
                                           cag_sub(m->positions[c[2]], m->positions[c[0]])));
    }
  for (size_t k = 0; k < p->vertex_count; k++) {
    m->normals[k] = cag_unit(m->normals[k]);
    if (cag_dot(m->normals[k], m->normals[k]) == 0) m->normals[k] = cag_vec3(0, 0, 1);
  }
  *out = m;
  return CAG_OK;
}

CagStatus cag_within_tessellate(const CagSurface *s, const double box[4], const CagLoopPoints *o,
                                const CagTessellation *how, CagMesh **out, CagError *err) {
  Plane p = {.inner = s, .box = {box[0], box[1], box[2], box[3]}};
  CagMesh *m = NULL;
  CagStatus status = begin(&p, o, err);
  if (!status) status = insert_mesh(&p, how, err);
  if (!status) status = refine(&p, how, err);
  if (!status) status = part_points(&p, o, err);
  if (!status) status = to_mesh(&p, o, &m, err);
  if (!status) status = cag_mesh_split_sides(m, 0, m->triangle_count, s, how->angle, 0, err);
  release(&p);
  if (!status) *out = m;
  else cag_mesh_release(m);
  return status;
}
