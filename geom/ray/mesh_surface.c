#include "geom/ray/mesh_surface.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/ray/caster_parts.h"
#include "geom/ray/ray_curvature.h"
#include "geom/solid/csg.h"

// The surface is looked for within this fraction of the size. The nearest crossing counts, so that this
// only bounds the work.
#define REACH 0.05
// The least cosine of the angle between a triangle and the surface that it stands for.
#define ALIKE 0.3
// Curvature is taken this fraction of the way from a corner to the center of the triangle, so that it is
// that of the triangle's own face at edges.
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

static double mesh_reach(const CagMesh *m) {
  const CagBounds b = cag_mesh_bounds(m);
  return b.min.x <= b.max.x ? REACH * cag_norm(cag_sub(b.max, b.min)) : 0;
}

// A line through a point near the surface, and the crossing that counts.
typedef struct Probe {
  CagVec3 at, along; // along: unit
  CagVec3 facing;    // the normal of the triangle
  double reach;
  int side; // of the surface's normal: 1 as `facing`, -1 against it, 0 either
} Probe;

// Finds the crossing next to the point whose normal fits that of the triangle.
static CagStatus probe_surface(const CagCaster *c, const Probe *p, CagCrossings *work,
                               CagCrossing *out, bool *found, CagError *err) {
  const CagRay ray = {p->at, p->along, -p->reach, p->reach};
  *found = false;
  const CagStatus status = cag_caster_all(c, &ray, work, NULL, err);
  if (status) return status;
  for (size_t i = 0; i < work->n; i++) {
    const CagCrossing *x = &work->items[i];
    const double along = cag_dot(x->normal, p->facing);
    const double alike = p->side == 0 ? fabs(along) : p->side * along;
    if (!(alike >= ALIKE) || (*found && fabs(x->t) >= fabs(out->t))) continue;
    *out = *x;
    *found = true;
  }
  return CAG_OK;
}

// --- Leaves ---

typedef struct Leaf {
  const CagCaster *caster;
  int side; // -1: it is subtracted, so its normals are against those of the result
} Leaf;

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

static bool is_near(const CagBounds *b, CagVec3 p, double reach) {
  return p.x >= b->min.x - reach && p.x <= b->max.x + reach && p.y >= b->min.y - reach &&
         p.y <= b->max.y + reach && p.z >= b->min.z - reach && p.z <= b->max.z + reach;
}

static CagStatus find_leaf(Leaves *l, const Triangle *t, uint32_t *out, CagError *err) {
  double nearest = INFINITY;
  *out = UINT32_MAX;
  if (!(cag_norm(t->normal) > 0)) return CAG_OK;
  for (size_t i = 0; i < l->count; i++) {
    const CagCaster *c = l->items[i].caster;
    const double reach = fmin(l->reach, nearest);
    if (!is_near(&c->bounds, t->center, reach)) continue;
    const Probe probe = {t->center, t->normal, t->normal, l->reach, l->items[i].side};
    CagCrossing x;
    bool found;
    const CagStatus status = probe_surface(c, &probe, &l->work, &x, &found, err);
    if (status) return status;
    if (!found || fabs(x.t) >= nearest) continue;
    nearest = fabs(x.t);
    *out = (uint32_t)i;
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
  Leaves l = {.reach = mesh_reach(m)};
  CagCaster *caster = NULL;
  CagStatus status = cag_caster_of_solid(s, &caster, err);
  if (!status) l.items = cag_calloc(cag_solid_leaf_count(s) + 1, sizeof *l.items);
  if (!status && !l.items) status = cag_fail_memory(err);
  if (!status) collect_leaves(caster, 1, &l);
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    const Triangle triangle = triangle_at(m, t);
    status = t % LOOK_UP == 0 ? cag_stop_check(err) : CAG_OK;
    if (!status) status = find_leaf(&l, &triangle, &out[t], err);
  }
  if (!status) status = fill_gaps(m, out, err);
  cag_crossings_free(&l.work);
  cag_free(l.items);
  cag_caster_free(caster);
  return status;
}

// --- Curvature ---

static CagVec3 corner_normal(const CagMesh *m, size_t t, size_t k, const Triangle *triangle) {
  const CagVec3 n = m->normals ? m->normals[m->triangles[3 * t + k]] : triangle->normal;
  return cag_norm(n) > 0 ? cag_unit(n) : triangle->normal;
}

// The curvature next to corner k.
static CagStatus corner_bend(const CagCaster *c, const Triangle *t, size_t k, CagVec3 along,
                             double reach, CagCrossings *work, CagBend *out, CagError *err) {
  const Probe p = {cag_lerp(t->corners[k], t->center, INWARD), along, t->normal, reach,
                   cag_caster_is_closed(c) ? 1 : 0};
  CagCrossing x;
  bool known;
  *out = (CagBend){NAN, NAN};
  CagStatus status = probe_surface(c, &p, work, &x, &known, err);
  if (status || !known) return status;
  status = cag_crossing_bend(&x, cag_madd(p.at, x.t, p.along), out, &known, err);
  if (status || !known) *out = (CagBend){NAN, NAN};
  // A surface may have been turned for its mesh.
  else if (cag_dot(x.normal, t->normal) < 0) out->mean = -out->mean;
  return status;
}

CagStatus cag_mesh_curvature(const CagCaster *c, const CagMesh *m, float *mean, float *gaussian,
                             CagError *err) {
  const double reach = mesh_reach(m);
  CagCrossings work = {0};
  CagStatus status = CAG_OK;
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    const Triangle triangle = triangle_at(m, t);
    if (t % LOOK_UP == 0) status = cag_stop_check(err);
    for (size_t k = 0; !status && k < 3; k++) {
      CagBend bend = {NAN, NAN};
      if (cag_norm(triangle.normal) > 0)
        status = corner_bend(c, &triangle, k, corner_normal(m, t, k, &triangle), reach, &work,
                             &bend, err);
      mean[3 * t + k] = (float)bend.mean;
      gaussian[3 * t + k] = (float)bend.gaussian;
    }
  }
  cag_crossings_free(&work);
  return status;
}

// --- Deviation ---

// Raises *most to the distance of a point of the triangle.
static CagStatus point_distance(const CagCaster *c, const Triangle *t, CagVec3 at, double reach,
                                CagCrossings *work, double *most, CagError *err) {
  const Probe p = {at, t->normal, t->normal, reach, cag_caster_is_closed(c) ? 1 : 0};
  CagCrossing x;
  bool found;
  const CagStatus status = probe_surface(c, &p, work, &x, &found, err);
  if (!status && found) *most = fmax(*most, fabs(x.t * cag_dot(x.normal, t->normal)));
  return status;
}

CagStatus cag_mesh_deviation(const CagCaster *c, const CagMesh *m, float *distance,
                             double *farthest, CagError *err) {
  const double reach = mesh_reach(m);
  CagCrossings work = {0};
  CagStatus status = CAG_OK;
  *farthest = 0;
  for (size_t t = 0; !status && t < m->triangle_count; t++) {
    const Triangle triangle = triangle_at(m, t);
    double most = -1;
    if (t % LOOK_UP == 0) status = cag_stop_check(err);
    const bool flat = !(cag_norm(triangle.normal) > 0);
    if (!status && !flat)
      status = point_distance(c, &triangle, triangle.center, reach, &work, &most, err);
    for (size_t k = 0; !status && !flat && k < 3; k++) {
      // The middle of a side may be outside of the face by rounding.
      const CagVec3 middle = cag_lerp(triangle.corners[k], triangle.corners[(k + 1) % 3], 0.5);
      status = point_distance(c, &triangle, cag_lerp(middle, triangle.center, INWARD), reach, &work,
                              &most, err);
    }
    distance[t] = most >= 0 ? (float)most : NAN;
    *farthest = fmax(*farthest, most);
  }
  cag_crossings_free(&work);
  return status;
}
