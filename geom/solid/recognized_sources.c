// Carriers of operands (see recognized_sources.h).

#include "geom/solid/recognized_sources.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/mesh/edges.h"
#include "geom/solid/csg.h"
#include "geom/solid/recognized_fit.h"

// A vertex is on a face if it is closer than this fraction of the size of the operand.
#define ON_FACE 1e-9
// Points may miss a recognized carrier by this fraction of the size: meshes from files have single
// precision.
#define RECOGNIZED 2e-6
// Triangles of meshes meet smoothly if their normals differ by less, in radians.
#define CREASE (25 * M_PI / 180)
// The normal of a vertex is used if it is not farther from that of its triangle (cosine): the apex of
// a cone has none.
#define APEX 0.94
// Points from which a carrier is recognized.
#define SAMPLES_MOST 600

void cag_recognized_sources_free(CagRecognizedSources *s) {
  for (size_t i = 0; i < s->count; i++) {
    cag_surface_release(s->items[i].spline);
    cag_curve_release(s->items[i].profile);
  }
  cag_free(s->items);
  *s = (CagRecognizedSources){0};
}

static CagStatus add_source(CagRecognizedSources *s, const CagCarrier *c, uint32_t *label,
                            CagError *err) {
  if (!CAG_RESERVE(s->items, s->room, s->count + 1)) return cag_fail_memory(err);
  s->items[s->count++] = *c;
  *label = (uint32_t)s->count;
  return CAG_OK;
}

// --- Groups of triangles ---

// The triangles of an operand, in groups that have one carrier.
typedef struct Groups {
  const CagMesh *mesh;
  double size;
  uint32_t *of; // by triangles
  size_t count;
} Groups;

static bool vertex_on(const Groups *g, const CagSurface *face, uint32_t v) {
  CagVec3 p;
  CagError err;
  const double *uv = g->mesh->uv + 2 * (size_t)v;
  return !cag_surface_point(face, uv[0], uv[1], &p, &err) &&
         cag_norm(cag_sub(p, g->mesh->positions[v])) <= ON_FACE * g->size;
}

// By the faces of the operand. *found: false if a triangle is on none.
static CagStatus group_by_faces(Groups *g, const CagSolid *s, bool *found, CagError *err) {
  size_t last = 0;
  *found = g->mesh->uv && s->face_count > 0;
  for (size_t t = 0; *found && t < g->mesh->triangle_count; t++) {
    const uint32_t *v = g->mesh->triangles + 3 * t;
    CagStatus status = t % 256 == 0 ? cag_stop_check(err) : CAG_OK;
    if (status) return status;
    *found = false;
    for (size_t k = 0; !*found && k < s->face_count; k++) {
      const size_t f = (last + k) % s->face_count;
      const CagSurface *face = s->faces[f];
      *found = vertex_on(g, face, v[0]) && vertex_on(g, face, v[1]) && vertex_on(g, face, v[2]);
      if (*found) last = f;
    }
    g->of[t] = (uint32_t)last;
  }
  g->count = s->face_count;
  return CAG_OK;
}

static CagVec3 facet_normal(const CagMesh *m, size_t t) {
  const uint32_t *v = m->triangles + 3 * t;
  const CagVec3 a = m->positions[v[0]];
  return cag_unit(cag_cross(cag_sub(m->positions[v[1]], a), cag_sub(m->positions[v[2]], a)));
}

static uint32_t root_of(uint32_t *parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Unites triangles that share an edge and whose normals differ by less than an angle.
static CagStatus unite_smooth(Groups *g, double angle, uint32_t *parent, CagError *err) {
  const CagMesh *m = g->mesh;
  size_t n = 0;
  CagMeshEdge *uses = cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  if (!uses) {
    CagStatus status = cag_stop_check(err);
    return status ? status : cag_fail_memory(err);
  }
  for (size_t i = 0; i + 1 < n; i++) {
    if (uses[i].low != uses[i + 1].low || uses[i].high != uses[i + 1].high) continue;
    const size_t a = cag_mesh_edge_triangle(&uses[i]), b = cag_mesh_edge_triangle(&uses[i + 1]);
    if (cag_dot(facet_normal(m, a), facet_normal(m, b)) < cos(angle)) continue;
    parent[root_of(parent, (uint32_t)a)] = root_of(parent, (uint32_t)b);
  }
  cag_free(uses);
  return CAG_OK;
}

// By creases.
static CagStatus group_by_creases(Groups *g, CagError *err) {
  const size_t n = g->mesh->triangle_count;
  uint32_t *parent = cag_malloc((2 * n + 2) * sizeof *parent), *number = parent + n + 1;
  if (!parent) return cag_fail_memory(err);
  for (size_t t = 0; t < n; t++) parent[t] = (uint32_t)t;
  CagStatus status = unite_smooth(g, CREASE, parent, err);
  g->count = 0;
  for (size_t t = 0; !status && t < n; t++) {
    const uint32_t root = root_of(parent, (uint32_t)t);
    // Roots are not always the first of their group.
    if (root == t) number[t] = (uint32_t)g->count++;
  }
  for (size_t t = 0; !status && t < n; t++) g->of[t] = number[root_of(parent, (uint32_t)t)];
  cag_free(parent);
  return status;
}

// --- Carriers ---

// Vertices of a group, with their normals, or those of the triangles: evenly chosen.
typedef struct GroupPoints {
  CagVec3 *points, *normals, *flat;
  size_t n;
} GroupPoints;

static void group_points_free(GroupPoints *p) {
  cag_free(p->points);
  cag_free(p->normals);
  cag_free(p->flat);
}

static CagStatus group_points(const Groups *g, uint32_t group, GroupPoints *out, CagError *err) {
  const CagMesh *m = g->mesh;
  size_t count = 0, seen = 0;
  for (size_t t = 0; t < m->triangle_count; t++) count += g->of[t] == group;
  const size_t step = 1 + 3 * count / SAMPLES_MOST;
  *out = (GroupPoints){cag_malloc((3 * (count / step) + 4) * sizeof(CagVec3)),
                       cag_malloc((3 * (count / step) + 4) * sizeof(CagVec3)),
                       cag_malloc((3 * (count / step) + 4) * sizeof(CagVec3)), 0};
  if (!out->points || !out->normals || !out->flat) {
    group_points_free(out);
    return cag_fail_memory(err);
  }
  for (size_t t = 0; t < m->triangle_count; t++) {
    if (g->of[t] != group || seen++ % step != 0) continue;
    const CagVec3 flat = facet_normal(m, t);
    if (cag_norm(flat) == 0) continue;
    for (int k = 0; k < 3; k++) {
      const uint32_t v = m->triangles[3 * t + (size_t)k];
      out->points[out->n] = m->positions[v];
      const bool smooth = m->normals && cag_dot(m->normals[v], flat) >= APEX;
      out->flat[out->n] = flat;
      out->normals[out->n++] = smooth ? m->normals[v] : flat;
    }
  }
  return CAG_OK;
}

static CagStatus group_carrier(const Groups *g, uint32_t group, CagCarrier *out, CagError *err) {
  GroupPoints p;
  *out = (CagCarrier){.kind = CAG_CARRIER_NONE};
  CagStatus status = group_points(g, group, &p, err);
  if (status) return status;
  if (p.n > 0)
    status = cag_recognized_fit(p.points, p.normals, p.n, RECOGNIZED * g->size, out, err);
  // The apex of a cone has no normal. The facets of a cone are inclined like the cone.
  if (!status && p.n > 0 && out->kind == CAG_CARRIER_NONE)
    status = cag_recognized_fit(p.points, p.flat, p.n, RECOGNIZED * g->size, out, err);
  group_points_free(&p);
  return status;
}

// A face without a simple carrier is a spline.
static CagStatus spline_carrier(const CagSurface *face, CagCarrier *out, CagError *err) {
  CagStatus status = cag_surface_to_nurbs(face, &out->spline, err);
  if (cag_is_final(status)) return status;
  if (!status) out->kind = CAG_CARRIER_SPLINE;
  return CAG_OK;
}

// Labels the triangles with the carriers of their groups.
static CagStatus label_groups(const Groups *g, const CagSolid *faces, CagMesh *labeled,
                              CagRecognizedSources *sources, CagError *err) {
  uint32_t *labels = cag_calloc(g->count + 1, sizeof *labels);
  CagStatus status = labels ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < g->count; i++) {
    CagCarrier c;
    status = group_carrier(g, (uint32_t)i, &c, err);
    if (!status && c.kind == CAG_CARRIER_NONE && faces)
      status = spline_carrier(faces->faces[i], &c, err);
    if (!status) status = add_source(sources, &c, &labels[i], err);
  }
  for (size_t t = 0; !status && t < labeled->triangle_count; t++)
    labeled->labels[t] = labels[g->of[t]];
  cag_free(labels);
  return status;
}

static CagStatus label_mesh(CagMesh *m, const CagSolid *s, CagRecognizedSources *sources,
                            CagError *err) {
  const CagBounds box = cag_mesh_bounds(m);
  Groups g = {.mesh = m, .size = cag_norm(cag_sub(box.max, box.min))};
  bool faced = false;
  g.of = cag_calloc(m->triangle_count + 1, sizeof *g.of);
  if (!m->labels) m->labels = cag_calloc(m->triangle_count + 1, sizeof *m->labels);
  CagStatus status = g.of && m->labels ? CAG_OK : cag_fail_memory(err);
  if (!status) status = group_by_faces(&g, s, &faced, err);
  if (!status && !faced) status = group_by_creases(&g, err);
  if (!status) status = label_groups(&g, faced ? s : NULL, m, sources, err);
  cag_free(g.of);
  return status;
}

// --- Operands ---

typedef struct Labeling {
  CagRecognizedSources *sources;
  double tolerance;
} Labeling;

static CagStatus label_solid(const Labeling *l, const CagSolid *s, CagSolid **out, CagError *err);

static CagSetOperation set_operation(const CagSolid *s) {
  return s->kind == CAG_SOLID_UNION        ? CAG_UNION
         : s->kind == CAG_SOLID_DIFFERENCE ? CAG_DIFFERENCE
                                           : CAG_INTERSECTION;
}

// The operation with its operands in the world.
static CagStatus label_operation(const Labeling *l, const CagSolid *s, CagSolid **out,
                                 CagError *err) {
  const size_t n = s->core->count;
  CagSolid **operands = cag_calloc(n + 1, sizeof *operands);
  size_t made = 0;
  CagStatus status = operands ? CAG_OK : cag_fail_memory(err);
  while (!status && made < n) {
    CagSolid *placed;
    status = cag_solid_transform(s->core->operands[made], &s->placement, &placed, err);
    if (status) break;
    status = label_solid(l, placed, &operands[made], err);
    cag_solid_release(placed);
    if (!status) made++;
  }
  if (!status)
    status = cag_solid_combine(set_operation(s), operands, n, s->core->interrupt, out, err);
  for (size_t i = 0; i < made; i++) cag_solid_release(operands[i]);
  cag_free(operands);
  return status;
}

// A half space or quadric: its mesh depends on the operation. A plane is known.
static CagStatus label_side(const Labeling *l, const CagSolid *s, CagSolid **out, CagError *err) {
  CagQuadric q;
  CagCarrier c = {.kind = CAG_CARRIER_NONE};
  if (s->kind == CAG_SOLID_HALF_SPACE && cag_solid_form(s, &q)) {
    const CagVec3 n = cag_vec3(q.c[6], q.c[7], q.c[8]);
    c.kind = CAG_CARRIER_PLANE;
    c.frame = cag_recognized_frame(cag_scaled(n, -q.c[9] / cag_dot(n, n)), cag_unit(n));
  }
  const CagTransform same = cag_transform_identity();
  CagStatus status = cag_solid_transform(s, &same, out, err); // a copy
  if (status) return status;
  status = add_source(l->sources, &c, &(*out)->label, err);
  if (status) cag_solid_release(*out);
  return status;
}

static CagStatus label_leaf(const Labeling *l, const CagSolid *s, CagSolid **out, CagError *err) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  const CagTransform same = cag_transform_identity();
  CagMesh *own, *m = NULL;
  how.tolerance = l->tolerance;
  CagStatus status = cag_solid_tessellate(s, &how, &own, err);
  if (status) return status;
  status = cag_mesh_transform(own, &same, &m, err); // a copy, which is labeled
  cag_mesh_release(own);
  if (!status) status = label_mesh(m, s, l->sources, err);
  if (!status) status = cag_solid_from_mesh(m, out, err);
  cag_mesh_release(m);
  return status;
}

static CagStatus label_solid(const Labeling *l, const CagSolid *s, CagSolid **out, CagError *err) {
  const bool operation = s->kind == CAG_SOLID_UNION || s->kind == CAG_SOLID_DIFFERENCE ||
                         s->kind == CAG_SOLID_INTERSECTION;
  if (operation) return label_operation(l, s, out, err);
  if (s->kind == CAG_SOLID_HALF_SPACE || s->kind == CAG_SOLID_QUADRIC)
    return label_side(l, s, out, err);
  return label_leaf(l, s, out, err);
}

CagStatus cag_recognized_mesh(const CagSolid *s, double tolerance, CagRecognizedSources *sources,
                              CagMesh **out, CagError *err) {
  const Labeling l = {sources, tolerance};
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagSolid *labeled;
  *sources = (CagRecognizedSources){0};
  how.tolerance = tolerance;
  CagStatus status = label_solid(&l, s, &labeled, err);
  if (!status) {
    status = cag_solid_tessellate(labeled, &how, out, err);
    cag_solid_release(labeled);
  }
  if (status) cag_recognized_sources_free(sources);
  return status;
}
