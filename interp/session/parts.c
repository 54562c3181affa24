// The parts of a scene for programs that show it: what they are, where they come from in the script,
// and their meshes.
//
// A mesh is known by the digest of the geometry that it is made of and of how fine it is, so that a
// host asks for meshes only that it does not have. What only moves keeps its mesh: a shape that was
// moved remembers the shape before (CagStill), and solids with a frame of their own are meshed in it.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/solid/solid.h"
#include "interp/scene/feature_edges.h"
#include "interp/scene/item_mesh.h"
#include "interp/session/session.h"

// The largest turn between segments of a drawn curve, in radians.
#define LINE_TURN 0.1
// The tolerance of meshes and lines without one of their own, as a fraction of their size.
#define SIZE_PART 1e-3

// --- Descriptions ---

// A ground has no shape. If it was added to the scene, its number is not that of a source.
static const CagItemSource *source_of(const CagSession *s, const CagItem *item) {
  const bool known = item->kind != CAG_ITEM_GROUND && item->number < s->sources.count &&
                     s->sources.items[item->number].shape;
  return known ? &s->sources.items[item->number] : NULL;
}

static const char *const TYPES[] = {
    [CAG_ITEM_CURVE] = "curve", [CAG_ITEM_REGION] = "region", [CAG_ITEM_SURFACE] = "surface",
    [CAG_ITEM_SOLID] = "solid", [CAG_ITEM_MESH] = "mesh",     [CAG_ITEM_GROUND] = "ground"};

static void copy_point(CagVec3 p, double out[3]) {
  out[0] = p.x;
  out[1] = p.y;
  out[2] = p.z;
}

static void copy_color(CagColor c, double out[3]) {
  out[0] = c.r;
  out[1] = c.g;
  out[2] = c.b;
}

static CagValue shape_value(const CagItem *item, const CagShape *shape) {
  static const CagType VALUES[] = {[CAG_ITEM_CURVE] = CAG_CURVE,
                                   [CAG_ITEM_REGION] = CAG_REGION,
                                   [CAG_ITEM_SURFACE] = CAG_SURFACE,
                                   [CAG_ITEM_SOLID] = CAG_SOLID,
                                   [CAG_ITEM_MESH] = CAG_MESH};
  return cag_object(VALUES[item->kind], (void *)(size_t)shape);
}

typedef struct Story {
  CagSession *session;
  const CagItem *item;
  CagPartView *out;
} Story;

static bool tell_story(CagVm *vm, void *context) {
  const Story *t = context;
  CagSession *s = t->session;
  CagError ignored;
  CagBounds box = CAG_BOUNDS_EMPTY;
  const CagItemSource *source = source_of(s, t->item);
  if (t->item->kind != CAG_ITEM_GROUND && cag_item_bounds(t->item, NULL, &box, &ignored))
    box = CAG_BOUNDS_EMPTY;
  copy_point(box.min, t->out->low);
  copy_point(box.max, t->out->high);
  if (!source) return true;
  CagString text = {0};
  cag_print_value(vm, &text, shape_value(t->item, source->shape), false);
  snprintf(s->text, sizeof s->text, "%s", text.bytes && !text.failed ? text.bytes : "");
  cag_string_free(&text);
  t->out->story = s->text;
  return true;
}

bool cag_session_part(CagSession *s, size_t i, CagPartView *out) {
  *out = (CagPartView){0};
  if (!cag_session_begin(s)) return false;
  const bool found = s->has_scene && i < s->scene.item_count;
  if (found) {
    const CagItem *item = &s->scene.items[i];
    out->name = item->name;
    out->type = TYPES[item->kind];
    out->material = item->material;
    out->z = item->ground_z;
    out->size = item->ground_size;
    cag_session_work(s, tell_story, &(Story){s, item, out});
    cag_diagnostics_truncate(&s->diagnostics, s->lasting);
  }
  cag_session_end(s, CAG_STATUS_OK);
  return found;
}

// Whether a call in the library has a caller that the call after it does not have.
static bool is_other_caller(const CagOriginStep *step, const CagOriginStep *later) {
  if (!step->caller) return false;
  return !later || later->caller != step->caller ||
         later->caller_span.start != step->caller_span.start ||
         later->caller_span.end != step->caller_span.end;
}

bool cag_session_part_place(CagSession *s, size_t part, size_t k, const char **what,
                            CagPlaceView *out) {
  *out = (CagPlaceView){0};
  if (!s->has_scene || part >= s->scene.item_count) return false;
  const CagItemSource *source = source_of(s, &s->scene.items[part]);
  if (!source) return false;
  *what = "show";
  const CagShown *shown = &s->vm->shown[source->shown];
  *out = cag_session_place(shown->source, shown->span);
  if (k == 0) return true;
  const CagOriginStep *later = NULL;
  for (const CagOriginStep *step = source->shape->origin.last; step; step = step->before) {
    *what = step->before ? "changed" : "made";
    if (is_other_caller(step, later) && --k == 0) {
      *out = cag_session_place(step->caller, step->caller_span);
      return true;
    }
    later = step;
    if (--k > 0) continue;
    *out = cag_session_place(step->source, step->span);
    return true;
  }
  return false;
}

bool cag_session_part_label(CagSession *s, size_t part, size_t k, uint32_t *label,
                            size_t *material) {
  if (!s->has_scene || part >= s->scene.item_count) return false;
  const CagItem *item = &s->scene.items[part];
  if (k >= item->label_count) return false;
  *label = item->labels[k].label;
  *material = item->labels[k].material;
  return true;
}

// --- Meshes ---

typedef struct CagSessionMesh {
  CagMesh *mesh; // NULL: a line
  float *positions, *normals;
  uint32_t *edges;
} CagSessionMesh;

void cag_session_drop_mesh(CagSession *s) {
  if (!s->mesh) return;
  cag_mesh_release(s->mesh->mesh);
  cag_free(s->mesh->positions);
  cag_free(s->mesh->normals);
  cag_free(s->mesh->edges);
  cag_free(s->mesh);
  s->mesh = NULL;
}

// An item before its placement.
typedef struct Still {
  CagItem item;    // shares everything but an owned solid
  CagSolid *owned; // released at the end
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
static void find_still(const CagItem *item, const CagItemSource *source, Still *out, CagDigest *d) {
  *out = (Still){.item = *item, .motion = cag_transform_identity()};
  const CagStill *before = source ? source->shape->still : NULL;
  if (is_framed_solid(item)) {
    out->motion = item->as.solid->placement;
    out->moved = true;
    cag_solid_digest_in_own_frame(item->as.solid, d);
    return;
  }
  if (item->kind == CAG_ITEM_REGION && cag_transform_is_rigid(&item->placement)) {
    out->motion = item->placement;
    out->moved = true;
    out->item.placement = cag_transform_identity();
  } else if (before) {
    out->motion = before->motion;
    out->moved = true;
    share_geometry(&out->item, before->shape);
  }
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
}

static double size_of(const CagItem *item) {
  CagBounds box;
  CagError ignored;
  if (cag_item_bounds(item, NULL, &box, &ignored) || box.min.x > box.max.x) return 1;
  return cag_norm(cag_sub(box.max, box.min));
}

// The tolerance of the item; 0: by its size, as in exports.
static double tolerance_of(const CagScene *scene, const CagItem *item, double coarse) {
  const double own = item->tolerance > 0 ? item->tolerance : scene->tolerance;
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
  double coarse;
  bool (*has)(void *context, const char *id);
  void *context;
  CagMeshView *out;
} MeshTask;

static CagStatus make_mesh(CagSession *s, const MeshTask *t, Still *still, CagDigest *d,
                           CagError *err) {
  CagMeshView *out = t->out;
  CagScene scene = s->scene; // shares everything
  still->item.tolerance = tolerance_of(&s->scene, &still->item, t->coarse);
  out->line = t->item->kind == CAG_ITEM_CURVE;
  if (out->line) out->radius = cag_item_line_radius(&s->scene, t->item);
  cag_digest_text(d, TYPES[t->item->kind]);
  cag_digest_number(d, still->item.tolerance);
  cag_digest_number(d, scene.tolerance);
  out->placed = still->moved;
  for (int i = 0; i < 3; i++) memcpy(out->placement[i], still->motion.m[i], 4 * sizeof(double));
  write_id(d, out->id);
  if (!d->unknown && t->has && t->has(t->context, out->id)) return CAG_OK;
  CagStatus status = CAG_OK;
  if (still->moved && is_framed_solid(t->item)) status = unplaced_solid(t->item, still, err);
  if (status) return status;
  if (!(s->mesh = cag_calloc(1, sizeof *s->mesh))) return cag_fail_memory(err);
  status = out->line ? make_line(&still->item, still->item.tolerance, s->mesh, out, err)
                     : make_triangles(&scene, &still->item, s->mesh, out, err);
  out->positions = s->mesh->positions;
  out->normals = s->mesh->normals;
  out->edges = s->mesh->edges;
  if (status || !d->unknown) return status;
  digest_contents(out, d);
  write_id(d, out->id);
  return CAG_OK;
}

static int make_part_mesh(CagSession *s, void *context) {
  MeshTask *t = context;
  CagError err = {0};
  CagDigest d = cag_digest_start();
  Still still;
  cag_session_drop_mesh(s);
  find_still(t->item, source_of(s, t->item), &still, &d);
  const CagStatus status = cag_session_checked(s, make_mesh(s, t, &still, &d, &err), &err);
  cag_solid_release(still.owned);
  return status ? cag_session_fail_geometry(s, &err) : CAG_STATUS_OK;
}

int cag_session_part_mesh(CagSession *s, size_t part, double coarse,
                          bool (*has)(void *context, const char *id), void *context,
                          CagMeshView *out) {
  *out = (CagMeshView){.placement = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  int status = CAG_STATUS_USAGE;
  if (s->has_scene && part < s->scene.item_count && s->scene.items[part].kind != CAG_ITEM_GROUND)
    status = cag_session_geometry(
        s, make_part_mesh,
        &(MeshTask){&s->scene.items[part], coarse > 1 ? coarse : 1, has, context, out});
  return cag_session_end(s, status);
}

// --- Materials, cameras, lights ---

bool cag_session_material(CagSession *s, size_t i, CagMaterialView *out) {
  *out = (CagMaterialView){0};
  if (!s->has_scene || i >= s->scene.material_count) return false;
  const CagMaterial *m = &s->scene.materials[i];
  *out = (CagMaterialView){.name = m->name,
                           .texture = m->texture,
                           .metallic = m->metallic,
                           .roughness = m->roughness,
                           .transmission = m->transmission,
                           .ior = m->ior,
                           .coat = m->coat,
                           .texture_scale = m->texture_scale};
  copy_color(m->color, out->color);
  copy_color(m->color2, out->color2);
  copy_color(m->emission, out->emission);
  return true;
}

bool cag_session_camera_view(CagSession *s, size_t i, CagCameraView *out) {
  *out = (CagCameraView){0};
  if (!s->has_scene || i >= s->scene.camera_count) return false;
  const CagCamera *c = &s->scene.cameras[i];
  *out = (CagCameraView){.name = c->name,
                         .orthographic = c->orthographic,
                         .automatic = s->scene.automatic_camera,
                         .fov = c->fov * 180 / M_PI,
                         .width = c->width,
                         .size = {c->size[0], c->size[1]}};
  copy_point(c->eye, out->eye);
  copy_point(c->target, out->target);
  copy_point(c->up, out->up);
  return true;
}

bool cag_session_light(CagSession *s, size_t i, CagLightView *out) {
  static const char *const KINDS[] = {[CAG_LIGHT_SUN] = "sun",
                                      [CAG_LIGHT_POINT] = "point",
                                      [CAG_LIGHT_SPOT] = "spot",
                                      [CAG_LIGHT_AREA] = "area"};
  *out = (CagLightView){0};
  if (!s->has_scene || i >= s->scene.light_count) return false;
  const CagLight *l = &s->scene.lights[i];
  *out = (CagLightView){.kind = KINDS[l->kind],
                        .angle = l->angle * 180 / M_PI,
                        .size = l->size,
                        .strength = l->strength};
  copy_point(l->position, out->position);
  copy_point(l->direction, out->direction);
  copy_color(l->color, out->color);
  return true;
}

bool cag_session_label(CagSession *s, size_t i, CagLabelView *out) {
  *out = (CagLabelView){0};
  if (!s->has_scene || i >= s->scene.label_count) return false;
  const CagLabel *l = &s->scene.labels[i];
  *out = (CagLabelView){.text = l->text,
                        .place = cag_label_places[l->place],
                        .mark = cag_label_marks[l->mark],
                        .size = l->size,
                        .material = l->material};
  copy_point(l->at, out->at);
  if (l->directed) copy_point(l->along, out->along);
  return true;
}

// Whether everything is in one plane z = constant.
static bool is_drawing(const CagScene *scene) {
  const CagBounds *b = &scene->bounds;
  for (size_t i = 0; i < scene->item_count; i++)
    if (scene->items[i].kind != CAG_ITEM_CURVE && scene->items[i].kind != CAG_ITEM_REGION)
      return false;
  return b->min.x > b->max.x || b->max.z - b->min.z <= 1e-9 * (1 + b->max.x - b->min.x);
}

bool cag_session_stage(CagSession *s, CagStageView *out) {
  *out = (CagStageView){0};
  if (!s->has_scene) return false;
  const CagScene *scene = &s->scene;
  const CagBounds box = cag_scene_framed(scene);
  *out = (CagStageView){.studio = scene->studio,
                        .drawing = is_drawing(scene),
                        .has_background = scene->has_background,
                        .sky_count = scene->sky.color_count};
  copy_color(scene->background, out->background);
  copy_point(box.min, out->low);
  copy_point(box.max, out->high);
  return true;
}

bool cag_session_sky_color(CagSession *s, size_t i, double out[3]) {
  if (!s->has_scene || i >= s->scene.sky.color_count) return false;
  copy_color(s->scene.sky.colors[i], out);
  return true;
}
