// Meshes of the parts of a scene.
//
// A mesh is known by the digest of the geometry that it is made of and of how fine it is, so that a
// host asks for meshes only that it does not have. What only moves keeps its mesh: a shape that was
// moved remembers the shape before (CagStill), and solids with a frame of their own are meshed in
// it.

#include "interp/session/part_mesh.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/solid/csg.h"
#include "interp/scene/feature_edges.h"
#include "interp/scene/item_mesh.h"

// The largest turn between segments of a drawn curve, in radians.
#define LINE_TURN 0.1
// The tolerance of meshes and lines without one of their own, as a fraction of their size.
#define SIZE_PART 1e-3

const CagItemSource *cag_session_item_source(const CagSession *s, const CagItem *item) {
  if (item->kind == CAG_ITEM_GROUND) return NULL; // that of a studio has no number of its own
  const bool known = item->number < s->sources.count && s->sources.items[item->number].shape;
  return known ? &s->sources.items[item->number] : NULL;
}

const char *cag_session_item_type(const CagItem *item) {
  static const char *const TYPES[] = {
      [CAG_ITEM_CURVE] = "curve", [CAG_ITEM_REGION] = "region", [CAG_ITEM_SURFACE] = "surface",
      [CAG_ITEM_SOLID] = "solid", [CAG_ITEM_MESH] = "mesh",     [CAG_ITEM_GROUND] = "ground"};
  return TYPES[item->kind];
}

void cag_session_drop_mesh(CagSession *s) {
  if (!s->mesh) return;
  cag_mesh_release(s->mesh->mesh);
  cag_solid_release(s->mesh->owned);
  cag_free(s->mesh->positions);
  cag_free(s->mesh->normals);
  cag_free(s->mesh->edges);
  cag_free(s->mesh->numbers);
  cag_free(s->mesh->values);
  cag_free(s->mesh->sizes);
  cag_free(s->mesh);
  s->mesh = NULL;
}

// An item before its placement.
typedef struct Still {
  CagItem item;    // shares everything but an owned solid
  CagSolid *owned; // may be NULL
  CagTransform motion;
  bool moved;
} Still;

static CagStatus unplaced_solid(const CagItem *item, Still *out, CagError *err) {
  CagTransform back;
  CagStatus status = cag_transform_inverse(&item->as.solid->placement, &back, err);
  if (!status) status = cag_solid_transform(item->as.solid, &back, &out->owned, err);
  if (!status) out->item.as.solid = out->owned;
  return status;
}

// The bounds in the frame of the solid do not change while it moves. Those of a set operation are
// cheap, and may be too wide.
static CagStatus measure_unplaced(const CagItem *item, Still *out, CagError *err) {
  CagBounds box;
  CagStatus status = unplaced_solid(item, out, err);
  if (!status) status = cag_solid_reach(out->owned, &box, err);
  if (status || !isfinite(cag_norm(cag_sub(box.max, box.min)))) return status;
  out->item.bounds = box;
  out->item.measured = true;
  return CAG_OK;
}

static void share_geometry(CagItem *item, const CagShape *shape) {
  switch (item->kind) {
  case CAG_ITEM_CURVE: item->as.curve = shape->as.curve; return;
  case CAG_ITEM_SURFACE: item->as.surface = shape->as.surface; return;
  case CAG_ITEM_SOLID: item->as.solid = shape->as.solid; return;
  case CAG_ITEM_MESH: item->as.mesh = shape->as.mesh; return;
  default: return;
  }
}

static bool is_framed_solid(const CagItem *item) {
  return item->kind == CAG_ITEM_SOLID && cag_solid_has_own_frame(item->as.solid) &&
         cag_transform_is_rigid(&item->as.solid->placement);
}

// Finds the item before it was moved, and adds it to the digest.
static CagStatus find_still(const CagItem *item, const CagShape *shape, Still *out, CagDigest *d,
                            CagError *err) {
  *out = (Still){.item = *item, .motion = cag_transform_identity()};
  const CagStill *before = shape ? shape->still : NULL;
  if (is_framed_solid(item)) {
    out->motion = item->as.solid->placement;
    out->moved = true;
    cag_solid_digest_in_own_frame(item->as.solid, d);
    return measure_unplaced(item, out, err);
  }
  if (item->kind == CAG_ITEM_REGION && cag_transform_is_rigid(&item->placement)) {
    out->motion = item->placement;
    out->moved = true;
    out->item.placement = cag_transform_identity();
  } else if (before) {
    out->motion = cag_motion_transform(before->motion);
    out->moved = true;
    share_geometry(&out->item, before->shape);
  }
  out->item.measured &= !out->moved;
  switch (item->kind) {
  case CAG_ITEM_CURVE: cag_curve_digest(out->item.as.curve, d); break;
  case CAG_ITEM_REGION:
    cag_region_digest(out->item.as.region, d);
    cag_transform_digest(&out->item.placement, d);
    break;
  case CAG_ITEM_SURFACE: cag_surface_digest(out->item.as.surface, d); break;
  case CAG_ITEM_SOLID: cag_solid_digest(out->item.as.solid, d); break;
  case CAG_ITEM_MESH: cag_mesh_digest(out->item.as.mesh, d); break;
  case CAG_ITEM_GROUND: break;
  }
  return CAG_OK;
}

static double size_of(const CagItem *item) {
  CagBounds box;
  CagError ignored;
  if (cag_item_bounds(item, NULL, &box, &ignored) || box.min.x > box.max.x) return 1;
  return cag_norm(cag_sub(box.max, box.min));
}

// The tolerance of the item, as in exports; 0: by its size.
static double tolerance_of(const CagScene *scene, const CagItem *item, double coarse) {
  const double own = cag_item_tolerance(scene, item);
  if (coarse <= 1) return own;
  return coarse * (own > 0 ? own : SIZE_PART * size_of(item));
}

static CagStatus make_line(const CagItem *item, double tolerance, CagSessionMesh *m,
                           CagMeshView *out, CagError *err) {
  const CagCurve *c = item->as.curve;
  double *t = NULL;
  size_t n = 0;
  if (!(tolerance > 0)) tolerance = SIZE_PART * size_of(item);
  if (!(tolerance > 0)) tolerance = SIZE_PART; // all points of the curve coincide
  CagStatus status = cag_curve_discretize(c, tolerance, LINE_TURN, &t, &n, err);
  if (status) return status;
  m->positions = cag_malloc((3 * n + 1) * sizeof *m->positions);
  m->edges = cag_malloc((2 * n + 1) * sizeof *m->edges);
  if (!m->positions || !m->edges) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    CagVec3 p;
    status = cag_curve_eval(c, t[i], 0, CAG_SIDE_RIGHT, &p, err);
    if (status) break;
    m->positions[3 * i] = (float)p.x;
    m->positions[3 * i + 1] = (float)p.y;
    m->positions[3 * i + 2] = (float)p.z;
    m->edges[2 * i] = (uint32_t)i;
    m->edges[2 * i + 1] = (uint32_t)(i + 1);
  }
  cag_free(t);
  out->vertex_count = n;
  out->edge_count = n > 0 ? n - 1 : 0;
  return status;
}

static float *floats_of(const CagVec3 *v, size_t n, CagError *err) {
  float *out = cag_malloc((3 * n + 1) * sizeof *out);
  if (!out) cag_fail_memory(err);
  for (size_t i = 0; out && i < n; i++) {
    out[3 * i] = (float)v[i].x;
    out[3 * i + 1] = (float)v[i].y;
    out[3 * i + 2] = (float)v[i].z;
  }
  return out;
}

static CagStatus make_triangles(const CagScene *scene, const CagItem *item, CagSessionMesh *m,
                                CagMeshView *out, CagError *err) {
  CagStatus status = cag_item_mesh(scene, item, &m->mesh, err);
  if (status) return status;
  const CagMesh *mesh = m->mesh;
  m->positions = floats_of(mesh->positions, mesh->vertex_count, err);
  if (m->positions && mesh->normals) m->normals = floats_of(mesh->normals, mesh->vertex_count, err);
  if (!m->positions || (mesh->normals && !m->normals)) return err->status;
  out->vertex_count = mesh->vertex_count;
  out->triangle_count = mesh->triangle_count;
  out->triangles = mesh->triangles;
  out->labels = mesh->labels;
  return cag_feature_edges(mesh, &m->edges, &out->edge_count, err);
}

static void write_id(const CagDigest *d, char out[33]) {
  snprintf(out, 33, "%016llx%016llx", (unsigned long long)d->a, (unsigned long long)d->b);
}

// The contents of a mesh that is made of something unknown.
static void digest_contents(const CagMeshView *v, CagDigest *d) {
  *d = cag_digest_start();
  cag_digest_bytes(d, v->positions, 3 * v->vertex_count * sizeof *v->positions);
  cag_digest_bytes(d, v->triangles, 3 * v->triangle_count * sizeof *v->triangles);
  cag_digest_bytes(d, v->edges, 2 * v->edge_count * sizeof *v->edges);
  if (v->labels) cag_digest_bytes(d, v->labels, v->triangle_count * sizeof *v->labels);
}

typedef struct MeshTask {
  const CagItem *item;
  const CagShape *shape; // that the item shows; NULL: unknown
  double coarse;
  bool (*has)(void *context, const char *id);
  void *context;
  CagMeshView *out;
} MeshTask;

// The mesh is made in the coordinates of `still`, which it keeps.
static CagStatus make_mesh(CagSession *s, const MeshTask *t, Still *still, CagDigest *d,
                           CagError *err) {
  CagMeshView *out = t->out;
  CagScene scene = s->scene; // shares everything
  still->item.tolerance = tolerance_of(&s->scene, &still->item, t->coarse);
  out->line = t->item->kind == CAG_ITEM_CURVE;
  if (out->line) out->radius = cag_item_line_radius(&s->scene, t->item);
  cag_digest_text(d, cag_session_item_type(t->item));
  cag_digest_number(d, still->item.tolerance);
  out->placed = still->moved;
  for (int i = 0; i < 3; i++) memcpy(out->placement[i], still->motion.m[i], 4 * sizeof(double));
  write_id(d, out->id);
  if (!d->unknown && t->has && t->has(t->context, out->id)) return CAG_OK;
  if (!(s->mesh = cag_calloc(1, sizeof *s->mesh))) return cag_fail_memory(err);
  s->mesh->owned = still->owned;
  still->owned = NULL;
  s->mesh->item = still->item;
  CagStatus status = out->line ? make_line(&still->item, still->item.tolerance, s->mesh, out, err)
                               : make_triangles(&scene, &still->item, s->mesh, out, err);
  out->positions = s->mesh->positions;
  out->normals = s->mesh->normals;
  out->edges = s->mesh->edges;
  if (!status && d->unknown) {
    digest_contents(out, d);
    write_id(d, out->id);
  }
  memcpy(s->mesh->id, out->id, sizeof s->mesh->id);
  return status;
}

static int make_part_mesh(CagSession *s, void *context) {
  MeshTask *t = context;
  CagError err = {0};
  CagDigest d = cag_digest_start();
  Still still;
  cag_session_drop_mesh(s);
  CagStatus status = find_still(t->item, t->shape, &still, &d, &err);
  if (!status) status = make_mesh(s, t, &still, &d, &err);
  cag_solid_release(still.owned);
  status = cag_session_checked(s, status, &err);
  return status ? cag_session_fail_geometry(s, &err) : CAG_STATUS_OK;
}

int cag_session_item_mesh(CagSession *s, const CagItem *item, const CagShape *shape, double coarse,
                          bool (*has)(void *context, const char *id), void *context,
                          CagMeshView *out) {
  *out = (CagMeshView){.placement = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  if (item->kind == CAG_ITEM_GROUND) return CAG_STATUS_USAGE;
  return cag_session_geometry(s, make_part_mesh,
                              &(MeshTask){item, shape, coarse > 1 ? coarse : 1, has, context, out});
}

int cag_session_part_mesh(CagSession *s, size_t part, double coarse,
                          bool (*has)(void *context, const char *id), void *context,
                          CagMeshView *out) {
  *out = (CagMeshView){0};
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  int status = CAG_STATUS_USAGE;
  if (s->has_scene && part < s->scene.item_count) {
    const CagItem *item = &s->scene.items[part];
    const CagItemSource *source = cag_session_item_source(s, item);
    status =
        cag_session_item_mesh(s, item, source ? source->shape : NULL, coarse, has, context, out);
  }
  return cag_session_end(s, status);
}
