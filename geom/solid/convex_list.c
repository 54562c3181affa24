#include "geom/solid/convex_list.h"

#include <math.h>
#include <stdlib.h>

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/csg.h"
#include "geom/surface/core.h"

void cag_convex_list_free(CagConvexList *list) {
  for (size_t i = 0; i < list->point_lists; i++) cag_free(list->points[i]);
  cag_free(list->points);
  cag_free(list->items);
  cag_free(list->bounds);
}

static CagStatus add_body(CagConvexList *list, CagConvex body, CagError *err) {
  if (!CAG_RESERVE(list->items, list->capacity, list->n + 1) ||
      !CAG_RESERVE(list->bounds, list->bounds_capacity, list->n + 1))
    return cag_fail_memory(err);
  list->bounds[list->n] = cag_convex_bounds(&body);
  list->items[list->n++] = body;
  return CAG_OK;
}

// Room for n points, which the list owns.
static CagVec3 *new_points(CagConvexList *list, size_t n) {
  if (!CAG_RESERVE(list->points, list->list_capacity, list->point_lists + 1)) return NULL;
  CagVec3 *points = cag_malloc(n * sizeof *points);
  if (points) list->points[list->point_lists++] = points;
  return points;
}

static CagVec3 column(const CagTransform *t, int j) {
  return cag_scaled(cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]), 1 / t->m[3][3]);
}

// --- Primitives ---

static CagStatus add_box(CagConvexList *list, const CagSolid *s, const CagTransform *t,
                         CagError *err) {
  CagVec3 *corners = new_points(list, 8);
  if (!corners) return cag_fail_memory(err);
  const CagVec3 size = cag_vec3(s->a, s->b, s->c);
  const CagVec3 low = s->centered ? cag_scaled(size, -0.5) : cag_vec3(0, 0, 0);
  for (int k = 0; k < 8; k++)
    corners[k] =
        cag_transform_point(t, cag_vec3(low.x + (k & 1 ? size.x : 0), low.y + (k & 2 ? size.y : 0),
                                        low.z + (k & 4 ? size.z : 0)));
  return add_body(list, (CagConvex){.kind = CAG_CONVEX_HULL, .points = corners, .count = 8}, err);
}

static CagStatus add_ball(CagConvexList *list, const CagSolid *s, const CagTransform *t,
                          CagError *err) {
  double scale;
  CagConvex body = {.kind = CAG_CONVEX_ELLIPSOID, .center = column(t, 3)};
  if (!cag_transform_is_similarity(t, &scale)) {
    body.x = cag_scaled(column(t, 0), s->a);
    body.y = cag_scaled(column(t, 1), s->a);
    body.z = cag_scaled(column(t, 2), s->a);
    return add_body(list, body, err);
  }
  CagVec3 *center = new_points(list, 1);
  if (!center) return cag_fail_memory(err);
  *center = body.center;
  body = (CagConvex){
      .kind = CAG_CONVEX_HULL, .points = center, .count = 1, .round = s->a * fabs(scale)};
  return add_body(list, body, err);
}

static CagStatus add_frustum(CagConvexList *list, const CagSolid *s, const CagTransform *t,
                             CagError *err) {
  return add_body(list,
                  (CagConvex){.kind = CAG_CONVEX_FRUSTUM,
                              .center = column(t, 3),
                              .x = column(t, 0),
                              .y = column(t, 1),
                              .z = cag_scaled(column(t, 2), s->a),
                              .radius = {s->b, s->c}},
                  err);
}

static CagStatus add_torus(CagConvexList *list, const CagSolid *s, const CagTransform *t,
                           bool *known, CagError *err) {
  double scale;
  *known = cag_transform_is_similarity(t, &scale);
  if (!*known) return CAG_OK;
  return add_body(list,
                  (CagConvex){.kind = CAG_CONVEX_RING,
                              .center = column(t, 3),
                              .x = cag_scaled(column(t, 0), s->a),
                              .y = cag_scaled(column(t, 1), s->a),
                              .round = s->b * fabs(scale)},
                  err);
}

// --- Extrusions of polygons ---

// Whether the corners turn in one direction, once around.
static bool is_convex(const CagVec3 *p, size_t n) {
  double turned = 0, sense = 0;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 a = cag_sub(p[(i + 1) % n], p[i]), b = cag_sub(p[(i + 2) % n], p[(i + 1) % n]);
    const double sine = a.x * b.y - a.y * b.x;
    if (sine * sense < 0) return false;
    if (sine != 0) sense = sine;
    turned += atan2(sine, a.x * b.x + a.y * b.y);
  }
  return fabs(turned) < 3 * M_PI;
}

// The hull of points, and of the same points moved along a vector.
static CagStatus add_prism(CagConvexList *list, const CagVec3 *base, size_t n, CagVec3 along,
                           CagError *err) {
  CagVec3 *points = new_points(list, 2 * n);
  if (!points) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) {
    points[i] = base[i];
    points[n + i] = cag_add(base[i], along);
  }
  const CagConvex body = {.kind = CAG_CONVEX_HULL, .points = points, .count = 2 * n};
  return add_body(list, body, err);
}

// One prism for each triangle of the cap, whose vertices are those of the polygon.
static CagStatus add_triangles(CagConvexList *list, const CagSurface *cap, const CagTransform *t,
                               CagVec3 along, CagError *err) {
  const CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  CagStatus status = cag_surface_tessellate(cap, &how, &m, err);
  for (size_t i = 0; !status && i < m->triangle_count; i++) {
    CagVec3 corner[3];
    for (size_t k = 0; k < 3; k++)
      corner[k] = cag_transform_point(t, m->positions[m->triangles[3 * i + k]]);
    status = add_prism(list, corner, 3, along, err);
    if (!status) status = cag_stop_check(err);
  }
  cag_mesh_release(m);
  return status;
}

// The vector of an extrusion without twist and scale, in the coordinates of the face.
static bool extrusion_vector(const CagSurface *face, CagVec3 *along) {
  const CagSurface *inner;
  const CagCurve *section;
  CagTransform map = cag_transform_identity();
  if (cag_surface_placed_view(face, &inner, &map)) face = inner;
  if (!cag_transform_is_affine(&map) || !cag_surface_extrusion_view(face, &section, along))
    return false;
  *along = cag_scaled(cag_transform_vector(&map, *along), 1 / map.m[3][3]);
  return true;
}

// An extrusion has one face for each loop of its region, and two caps.
static CagStatus add_extrusion(CagConvexList *list, const CagSolid *s, const CagTransform *t,
                               bool *known, CagError *err) {
  const CagRegion *region = NULL;
  const CagVec3 *corners = NULL;
  CagTransform frame;
  CagVec3 along;
  size_t n = 0;
  bool closed;
  *known = false;
  if (s->face_count < 3) return CAG_OK;
  const CagSurface *cap = s->faces[s->face_count - 2];
  if (!cag_surface_planar_view(cap, &region, &frame) || !cag_transform_is_affine(&frame) ||
      region->count + 2 != s->face_count || !extrusion_vector(s->faces[0], &along))
    return CAG_OK;
  for (size_t i = 0; i < region->count; i++)
    if (!cag_curve_vertices(region->loops[i], &corners, &n, &closed)) return CAG_OK;
  *known = true;
  along = cag_scaled(cag_transform_vector(t, along), 1 / t->m[3][3]);
  if (region->count > 1 || !is_convex(corners, n)) return add_triangles(list, cap, t, along, err);
  CagVec3 *base = cag_malloc(n * sizeof *base);
  if (!base) return cag_fail_memory(err);
  const CagTransform to_world = cag_transform_multiply(t, &frame);
  for (size_t i = 0; i < n; i++) base[i] = cag_transform_point(&to_world, corners[i]);
  CagStatus status = add_prism(list, base, n, along, err);
  cag_free(base);
  return status;
}

// --- Solids ---

// Adds a solid whose coordinates are mapped to the world by `to_world`.
static CagStatus add_solid(CagConvexList *list, const CagSolid *s, const CagTransform *to_world,
                           bool *known, CagError *err) {
  const CagTransform placement = cag_transform_multiply(to_world, &s->placement);
  CagStatus status = cag_stop_check(err);
  *known = cag_transform_is_affine(&placement) && cag_transform_is_affine(to_world);
  if (status || !*known) return status;
  switch (s->kind) {
  case CAG_SOLID_BOX: return add_box(list, s, &placement, err);
  case CAG_SOLID_SPHERE: return add_ball(list, s, &placement, err);
  case CAG_SOLID_CYLINDER: return add_frustum(list, s, &placement, err);
  case CAG_SOLID_TORUS: return add_torus(list, s, &placement, known, err);
  case CAG_SOLID_EXTRUSION: return add_extrusion(list, s, to_world, known, err);
  case CAG_SOLID_UNION:
    for (size_t i = 0; !status && *known && i < s->core->count; i++)
      status = add_solid(list, s->core->operands[i], &placement, known, err);
    return status;
  default: *known = false; return CAG_OK;
  }
}

CagStatus cag_solid_add_convex(const CagSolid *s, CagConvexList *list, bool *known, CagError *err) {
  const CagTransform identity = cag_transform_identity();
  const size_t before = list->n;
  CagStatus status = add_solid(list, s, &identity, known, err);
  if (!*known) list->n = before;
  return status;
}

// --- Distances ---

static double box_gap(const CagBounds *a, const CagBounds *b) {
  const double x = fmax(0, fmax(a->min.x - b->max.x, b->min.x - a->max.x));
  const double y = fmax(0, fmax(a->min.y - b->max.y, b->min.y - a->max.y));
  const double z = fmax(0, fmax(a->min.z - b->max.z, b->min.z - a->max.z));
  return sqrt(x * x + y * y + z * z);
}

static CagBounds all_bounds(const CagConvexList *list) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < list->n; i++) {
    cag_bounds_add(&box, list->bounds[i].min);
    cag_bounds_add(&box, list->bounds[i].max);
  }
  return box;
}

// A body of the first list, and its distance from the box of the second one.
typedef struct Entry {
  double gap;
  size_t index;
} Entry;

static int by_gap(const void *a, const void *b) {
  const Entry *x = a, *y = b;
  return x->gap != y->gap ? (x->gap > y->gap) - (x->gap < y->gap)
                          : (x->index > y->index) - (x->index < y->index);
}

static CagStatus sorted_entries(const CagConvexList *list, const CagBounds *to, Entry **out,
                                CagError *err) {
  *out = cag_malloc(list->n * sizeof **out);
  if (!*out) return cag_fail_memory(err);
  for (size_t i = 0; i < list->n; i++) (*out)[i] = (Entry){box_gap(&list->bounds[i], to), i};
  qsort(*out, list->n, sizeof **out, by_gap);
  return CAG_OK;
}

// Both lists are ordered by the distance from the box of the other one, so most pairs are skipped.
CagStatus cag_convex_list_distance(const CagConvexList *a, const CagConvexList *b, double *out,
                                   CagVec3 points[2], bool *certain, CagError *err) {
  const CagBounds box[2] = {all_bounds(a), all_bounds(b)};
  Entry *first = NULL, *second = NULL;
  CagStatus status = sorted_entries(a, &box[1], &first, err);
  if (!status) status = sorted_entries(b, &box[0], &second, err);
  double best = INFINITY;
  *certain = true;
  for (size_t i = 0; !status && i < a->n && first[i].gap < best && best > 0; i++) {
    const size_t m = first[i].index;
    status = cag_stop_check(err);
    for (size_t k = 0; !status && k < b->n && second[k].gap < best && best > 0; k++) {
      const size_t n = second[k].index;
      double distance;
      CagVec3 found[2];
      if (box_gap(&a->bounds[m], &b->bounds[n]) >= best) continue;
      const bool known = cag_convex_distance(&a->items[m], &b->items[n], best, &distance, found);
      *certain = *certain && known;
      if (!known || distance >= best) continue;
      best = distance;
      if (points) memcpy(points, found, sizeof found);
    }
  }
  cag_free(first);
  cag_free(second);
  *out = best;
  return status;
}
