#include "geom/ray/mesh_surface.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/ray/caster_parts.h"
#include "geom/ray/ray_curvature.h"
#include "geom/solid/csg.h"

// The surface is looked for within this fraction of the size. The nearest crossing counts, so that
// this only bounds the work.
#define REACH 0.05
// The least cosine of the angle between a triangle and the surface that it stands for.
#define ALIKE 0.3
// Curvature is taken this fraction of the way from a corner to the center of the triangle, so that
// it is that of the triangle's own face at edges.
#define INWARD 1e-3
// The work is stopped between so many triangles.
enum { LOOK_UP = 256 };

// --- Triangles ---

typedef struct Triangle {
  CagVec3 corners[3], center, normal; // normal: unit, or zero
} Triangle;

static Triangle triangle_at(const CagMesh *m, size_t t) {
  Triangle out;
  for (size_t k = 0; k < 3; k++) out.corners[k] = m->positions[m->triangles[3 * t + k]];
  out.center = cag_scaled(cag_add(out.corners[0], cag_add(out.corners[1], out.corners[2])), 1. / 3);
  const CagVec3 n =
      cag_cross(cag_sub(out.corners[1], out.corners[0]), cag_sub(out.corners[2], out.corners[0]));
  const double length = cag_norm(n);
  out.normal = length > 0 ? cag_scaled(n, 1 / length) : cag_vec3(0, 0, 0);
  return out;
}

static bool has_normal(const Triangle *t) { return cag_norm(t->normal) > 0; }

static double mesh_reach(const CagMesh *m) {
  const CagBounds b = cag_mesh_bounds(m);
  return b.min.x <= b.max.x ? REACH * cag_norm(cag_sub(b.max, b.min)) : 0;
}

// --- Leaves ---

typedef struct Leaf {
  const CagCaster *caster;
  int side; // of its normals: 1 as those of the result, -1 against them (subtracted), 0 either
} Leaf;

// The surfaces that the triangles of a mesh approximate: those of the operands of a set operation,
// beyond their intersections too, since a triangle may reach over an edge by the tolerance.
typedef struct Leaves {
  Leaf *items;
  size_t count;
  double reach;
  CagCrossings work;
} Leaves;

static bool is_operation(const CagSolid *s) {
  return s->core && (s->kind == CAG_SOLID_UNION || s->kind == CAG_SOLID_DIFFERENCE ||
                     s->kind == CAG_SOLID_INTERSECTION);
}

size_t cag_solid_leaf_count(const CagSolid *s) {
  size_t n = is_operation(s) ? 0 : 1;
  for (size_t i = 0; is_operation(s) && i < s->core->count; i++)
    n += cag_solid_leaf_count(s->core->operands[i]);
  return n;
}

static size_t caster_leaf_count(const CagCaster *c) {
  size_t n = c->kind == CAG_CASTER_OPERATION ? 0 : 1;
  for (size_t i = 0; i < c->operand_count; i++) n += caster_leaf_count(c->operands[i]);
  return n;
}

// Casters have the operands of their solids in the same order.
static void collect_leaves(const CagCaster *c, int side, Leaves *out) {
  if (c->kind != CAG_CASTER_OPERATION) {
    out->items[out->count++] = (Leaf){c, side};
    return;
  }
  for (size_t i = 0; i < c->operand_count; i++)
    collect_leaves(c->operands[i], c->operation == CAG_SOLID_DIFFERENCE && i > 0 ? -side : side,
                   out);
}

static CagStatus leaves_of(const CagCaster *c, const CagMesh *m, Leaves *out, CagError *err) {
  *out = (Leaves){.reach = mesh_reach(m),
                  .items = cag_calloc(caster_leaf_count(c) + 1, sizeof *out->items)};
  if (!out->items) return cag_fail_memory(err);
  collect_leaves(c, cag_caster_is_closed(c) ? 1 : 0, out);
  return CAG_OK;
}

static void free_leaves(Leaves *l) {
  cag_crossings_free(&l->work);
  cag_free(l->items);
}

static bool is_near(const CagBounds *b, CagVec3 p, double reach) {
  return p.x >= b->min.x - reach && p.x <= b->max.x + reach && p.y >= b->min.y - reach &&
         p.y <= b->max.y + reach && p.z >= b->min.z - reach && p.z <= b->max.z + reach;
}

// A line through a point near the surface.
typedef struct Probe {
  CagVec3 at, along; // along: unit
  CagVec3 facing;    // the normal of the triangle
} Probe;

// Finds the crossing of a leaf next to the point whose normal fits that of the triangle, if it is
// nearer than *nearest.
static CagStatus probe_leaf(Leaves *l, size_t leaf, const Probe *p, double *nearest,
                            CagCrossing *out, CagError *err) {
  const CagRay ray = {p->at, p->along, -l->reach, l->reach};
  const int side = l->items[leaf].side;
  const CagStatus status = cag_caster_all(l->items[leaf].caster, &ray, &l->work, NULL, err);
  for (size_t i = 0; !status && i < l->work.n; i++) {
    const CagCrossing *x = &l->work.items[i];
    const double along = cag_dot(x->normal, p->facing);
    const double alike = side == 0 ? fabs(along) : side * along;
    if (!(alike >= ALIKE) || fabs(x->t) >= *nearest) continue;
    *nearest = fabs(x->t);
    *out = *x;
  }
  return status;
}

// Finds the nearest such crossing of all leaves. *leaf is UINT32_MAX if there is none.
static CagStatus probe_leaves(Leaves *l, const Probe *p, uint32_t *leaf, CagCrossing *out,
                              CagError *err) {
  double nearest = l->reach;
  *leaf = UINT32_MAX;
  for (size_t i = 0; i < l->count; i++) {
    const double before = nearest;
    if (!is_near(&l->items[i].caster->bounds, p->at, nearest)) continue;
    const CagStatus status = probe_leaf(l, i, p, &nearest, out, err);
    if (status) return status;
    if (nearest < before) *leaf = (uint32_t)i;
  }
  return CAG_OK;
}

// Triangles without a leaf get that of a neighbor.
static CagStatus fill_gaps(const CagMesh *m, uint32_t *leaves, CagError *err) {
  enum { PASSES = 4 };
  uint32_t *of_vertex = cag_malloc((m->vertex_count + 1) * sizeof *of_vertex);
  if (!of_vertex) return cag_fail_memory(err);
  for (size_t v = 0; v < m->vertex_count; v++) of_vertex[v] = UINT32_MAX;
  for (int pass = 0; pass < PASSES; pass++) {
    for (size_t i = 0; i < 3 * m->triangle_count; i++)
      if (leaves[i / 3] != UINT32_MAX) of_vertex[m->triangles[i]] = leaves[i / 3];
    for (size_t i = 0; i < 3 * m->triangle_count; i++)
      if (leaves[i / 3] == UINT32_MAX) leaves[i / 3] = of_vertex[m->triangles[i]];
  }
  for (size_t t = 0; t < m->triangle_count; t++)
    if (leaves[t] == UINT32_MAX) leaves[t] = 0;
  cag_free(of_vertex);
  return CAG_OK;
}

CagStatus cag_mesh_leaves(const CagSolid *s, const CagMesh *m, uint32_t *out, CagError *err) {
  Leaves l = {0};
  CagCaster *caster = NULL;
  CagStatus status = cag_caster_of_solid(s, &caster, err);
  if (!status) status = leaves_of(caster, m, &l, err);
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    const Triangle triangle = triangle_at(m, t);
    const Probe p = {triangle.center, triangle.normal, triangle.normal};
    CagCrossing unused;
    out[t] = UINT32_MAX;
    status = t % LOOK_UP == 0 ? cag_stop_check(err) : CAG_OK;
    if (!status && has_normal(&triangle)) status = probe_leaves(&l, &p, &out[t], &unused, err);
  }
  if (!status) status = fill_gaps(m, out, err);
  free_leaves(&l);
  cag_caster_free(caster);
  return status;
}

// --- Curvature ---

static const CagBend UNKNOWN = {NAN, NAN};

static CagVec3 corner_normal(const CagMesh *m, size_t t, size_t k, const Triangle *triangle) {
  const CagVec3 n = m->normals ? m->normals[m->triangles[3 * t + k]] : triangle->normal;
  return cag_norm(n) > 0 ? cag_unit(n) : triangle->normal;
}

// The curvature next to corner k.
static CagStatus corner_bend(Leaves *l, const Triangle *t, size_t k, CagVec3 along, CagBend *out,
                             CagError *err) {
  const Probe p = {cag_lerp(t->corners[k], t->center, INWARD), along, t->normal};
  CagCrossing x;
  uint32_t leaf;
  bool known;
  *out = UNKNOWN;
  CagStatus status = probe_leaves(l, &p, &leaf, &x, err);
  if (status || leaf == UINT32_MAX) return status;
  status = cag_crossing_bend(&x, cag_madd(p.at, x.t, p.along), out, &known, err);
  if (status || !known) *out = UNKNOWN;
  // The triangle faces the other side of a surface that is subtracted, or was turned for its mesh.
  else if (cag_dot(x.normal, t->normal) < 0) out->mean = -out->mean;
  return status;
}

// A corner where the surface was not found, at a pole or beyond an edge, gets the numbers of
// another one of its triangle.
static void fill_corners(CagBend *bends) {
  for (int k = 0; k < 3; k++)
    for (int i = 0; isnan(bends[k].mean) && i < 3; i++) bends[k] = bends[i];
}

CagStatus cag_mesh_curvature(const CagCaster *c, const CagMesh *m, float *mean, float *gaussian,
                             CagError *err) {
  Leaves l = {0};
  CagStatus status = leaves_of(c, m, &l, err);
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    const Triangle triangle = triangle_at(m, t);
    CagBend bends[3] = {UNKNOWN, UNKNOWN, UNKNOWN};
    if (t % LOOK_UP == 0) status = cag_stop_check(err);
    for (size_t k = 0; !status && has_normal(&triangle) && k < 3; k++)
      status = corner_bend(&l, &triangle, k, corner_normal(m, t, k, &triangle), &bends[k], err);
    fill_corners(bends);
    for (size_t k = 0; k < 3; k++) {
      mean[3 * t + k] = (float)bends[k].mean;
      gaussian[3 * t + k] = (float)bends[k].gaussian;
    }
  }
  free_leaves(&l);
  return status;
}

// --- Deviation ---

// Raises *most to the distance of a point of the triangle.
static CagStatus point_distance(Leaves *l, const Triangle *t, CagVec3 at, double *most,
                                CagError *err) {
  const Probe p = {at, t->normal, t->normal};
  CagCrossing x;
  uint32_t leaf;
  const CagStatus status = probe_leaves(l, &p, &leaf, &x, err);
  if (!status && leaf != UINT32_MAX) *most = fmax(*most, fabs(x.t * cag_dot(x.normal, t->normal)));
  return status;
}

static CagStatus triangle_distance(Leaves *l, const Triangle *t, double *most, CagError *err) {
  CagStatus status = point_distance(l, t, t->center, most, err);
  for (size_t k = 0; !status && k < 3; k++) {
    // The middle of a side may be outside of the face by rounding.
    const CagVec3 middle = cag_lerp(t->corners[k], t->corners[(k + 1) % 3], 0.5);
    status = point_distance(l, t, cag_lerp(middle, t->center, INWARD), most, err);
  }
  return status;
}

CagStatus cag_mesh_deviation(const CagCaster *c, const CagMesh *m, float *distance,
                             double *farthest, CagError *err) {
  Leaves l = {0};
  CagStatus status = leaves_of(c, m, &l, err);
  *farthest = 0;
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    const Triangle triangle = triangle_at(m, t);
    double most = -1;
    if (t % LOOK_UP == 0) status = cag_stop_check(err);
    if (!status && has_normal(&triangle)) status = triangle_distance(&l, &triangle, &most, err);
    distance[t] = most >= 0 ? (float)most : NAN;
    *farthest = fmax(*farthest, most);
  }
  free_leaves(&l);
  return status;
}
