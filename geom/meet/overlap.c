#include "geom/meet/overlap.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boolean/boolean.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"

// The tolerance of the first mesh, as a fraction of the size (as in tessellate.h).
#define SIZE_PART 1e-3
// Each mesh has this fraction of the tolerance of the one before.
#define FINER 0.25
// Finer meshes are made until the tolerances change the volume by at most this fraction.
#define ACCURATE 2e-3
// Slivers of faces that touch lose three quarters of their volume with each mesh. A common part that
// does not get thinner keeps at least this fraction.
#define LASTING 0.4

// --- Bodies ---

static bool is_exact(const CagSolid *s) {
  if (s->kind == CAG_SOLID_BOX || s->kind == CAG_SOLID_MESH || s->kind == CAG_SOLID_HALF_SPACE)
    return true;
  if (!s->core || s->core->count == 0) return false;
  for (size_t i = 0; i < s->core->count; i++)
    if (!is_exact(s->core->operands[i])) return false;
  return true;
}

static double size_of(const CagBounds *b) { return cag_norm(cag_sub(b->max, b->min)); }

static CagStatus body_mesh(CagOverlapBody *b, int level, const CagTessellation *how, CagMesh **out,
                           CagError *err) {
  if (b->exact) level = 0;
  CagTessellation own = *how;
  own.tolerance = b->tolerance * pow(FINER, level);
  CagStatus status = CAG_OK;
  if (!b->meshes[level]) status = cag_solid_tessellate(b->solid, &own, &b->meshes[level], err);
  *out = b->meshes[level];
  return status;
}

CagStatus cag_overlap_body(const CagSolid *s, double tolerance, const CagTessellation *how,
                           CagOverlapBody *out, CagError *err) {
  *out = (CagOverlapBody){.solid = s, .tolerance = tolerance, .exact = is_exact(s)};
  CagStatus status = cag_solid_reach(s, &out->bounds, err);
  if (status) return status;
  if (!isfinite(size_of(&out->bounds)) && out->bounds.min.x <= out->bounds.max.x) {
    CagMesh *m;
    status = body_mesh(out, 0, how, &m, err);
    if (status) return status;
    out->bounds = cag_mesh_bounds(m);
  }
  if (!(out->tolerance > 0)) out->tolerance = SIZE_PART * size_of(&out->bounds);
  return CAG_OK;
}

void cag_overlap_release(CagOverlapBody *b) {
  for (int k = 0; k < CAG_OVERLAP_LEVELS; k++) cag_mesh_release(b->meshes[k]);
  *b = (CagOverlapBody){0};
}

// --- Lumps ---

typedef struct Lump {
  double area, volume;
} Lump;

typedef struct Lumps {
  double sure, sure_area; // of lumps that are thicker than the tolerances
  double doubtful;        // volume of the others
} Lumps;

static uint32_t lump_root(uint32_t *parent, uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

static void join_vertices(uint32_t *parent, uint32_t a, uint32_t b) {
  a = lump_root(parent, a);
  b = lump_root(parent, b);
  if (a < b) parent[b] = a;
  else parent[a] = b;
}

// Adds the triangles to the lumps of their vertices.
static void measure_lumps(const CagMesh *m, uint32_t *parent, Lump *lumps) {
  const CagBounds box = cag_mesh_bounds(m);
  const CagVec3 middle = cag_lerp(box.min, box.max, 0.5);
  for (size_t v = 0; v < m->vertex_count; v++) parent[v] = (uint32_t)v;
  for (size_t v = 0; m->weld && v < m->vertex_count; v++)
    join_vertices(parent, (uint32_t)v, m->weld[v]);
  for (size_t i = 0; i < 3 * m->triangle_count && !cag_stopped(); i += 3) {
    join_vertices(parent, m->triangles[i], m->triangles[i + 1]);
    join_vertices(parent, m->triangles[i], m->triangles[i + 2]);
  }
  for (size_t i = 0; i < 3 * m->triangle_count && !cag_stopped(); i += 3) {
    const CagVec3 a = cag_sub(m->positions[m->triangles[i]], middle),
                  b = cag_sub(m->positions[m->triangles[i + 1]], middle),
                  c = cag_sub(m->positions[m->triangles[i + 2]], middle);
    Lump *lump = &lumps[lump_root(parent, m->triangles[i])];
    lump->area += cag_norm(cag_cross(cag_sub(b, a), cag_sub(c, a))) / 2;
    lump->volume += cag_dot(a, cag_cross(b, c)) / 6;
  }
}

// slack: the thickness that tolerances explain. rounding: that of exact meshes.
static void add_lump(const Lump *lump, double slack, double rounding, Lumps *out) {
  const double thickness = lump->area > 0 ? 2 * lump->volume / lump->area : 0;
  if (thickness <= rounding) return;
  if (thickness <= slack) {
    out->doubtful += lump->volume;
    return;
  }
  out->sure += lump->volume;
  out->sure_area += lump->area;
}

static CagStatus find_lumps(const CagMesh *m, double slack, double rounding, Lumps *out,
                            CagError *err) {
  uint32_t *parent = cag_malloc((m->vertex_count + 1) * sizeof *parent);
  Lump *lumps = cag_calloc(m->vertex_count + 1, sizeof *lumps), whole = {0, 0};
  bool hollow = false;
  *out = (Lumps){0};
  if (parent && lumps) measure_lumps(m, parent, lumps);
  for (size_t v = 0; parent && lumps && v < m->vertex_count; v++) {
    whole.area += lumps[v].area;
    whole.volume += lumps[v].volume;
    hollow = hollow || lumps[v].volume < 0;
  }
  // A shell around a cavity is as thick as the difference of both.
  if (hollow) add_lump(&whole, slack, rounding, out);
  for (size_t v = 0; parent && lumps && !hollow && v < m->vertex_count; v++)
    add_lump(&lumps[v], slack, rounding, out);
  const bool good = parent && lumps;
  cag_free(parent);
  cag_free(lumps);
  return good ? cag_stop_check(err) ? err->status : CAG_OK : cag_fail_memory(err);
}

// --- The common part ---

static bool are_apart(const CagBounds *a, const CagBounds *b) {
  return a->max.x <= b->min.x || b->max.x <= a->min.x || a->max.y <= b->min.y ||
         b->max.y <= a->min.y || a->max.z <= b->min.z || b->max.z <= a->min.z;
}

static CagStatus lumps_at(CagOverlapBody *a, CagOverlapBody *b, int level,
                          const CagTessellation *how, double slack, Lumps *out, CagError *err) {
  CagMesh *x, *y, *common;
  *out = (Lumps){0};
  CagStatus status = body_mesh(a, level, how, &x, err);
  if (!status) status = body_mesh(b, level, how, &y, err);
  if (status || x->triangle_count == 0 || y->triangle_count == 0) return status;
  const CagBounds p = cag_mesh_bounds(x), q = cag_mesh_bounds(y);
  if (are_apart(&p, &q)) return CAG_OK;
  status = cag_mesh_boolean(CAG_INTERSECTION, x, y, how->interrupt, &common, err);
  if (status) return status;
  const double rounding = CAG_COINCIDENT * fmax(size_of(&p), size_of(&q));
  status = find_lumps(common, slack, rounding, out, err);
  cag_mesh_release(common);
  return status;
}

CagStatus cag_overlap_volume(CagOverlapBody *a, CagOverlapBody *b, const CagTessellation *how,
                             double *volume, CagError *err) {
  double doubtful = INFINITY;
  *volume = 0;
  if (are_apart(&a->bounds, &b->bounds)) return CAG_OK;
  for (int level = 0; level < CAG_OVERLAP_LEVELS; level++) {
    Lumps l;
    const double slack =
        pow(FINER, level) * ((a->exact ? 0 : a->tolerance) + (b->exact ? 0 : b->tolerance));
    CagStatus status = lumps_at(a, b, level, how, slack, &l, err);
    if (status) return status;
    *volume = l.sure;
    const bool touching = l.doubtful <= (isfinite(doubtful) ? LASTING * doubtful : 0);
    if (touching && slack * l.sure_area / 2 <= ACCURATE * l.sure) return CAG_OK;
    doubtful = l.doubtful;
  }
  return CAG_OK;
}
