// The parts of a scene for programs that show it: what they are, and where they come from in the
// script.

#include <math.h>
#include <string.h>

#include "interp/session/part_mesh.h"

// --- Descriptions ---

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
  const CagItemSource *source = cag_session_item_source(s, t->item);
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
    out->type = cag_session_item_type(item);
    out->material = item->material;
    out->z = item->ground_z;
    out->size = item->ground_size;
    cag_session_work(s, tell_story, &(Story){s, item, out});
    cag_diagnostics_truncate(&s->diagnostics, s->lasting);
  }
  cag_session_end(s, CAG_STATUS_OK);
  return found;
}

bool cag_origin_other_caller(const CagOriginStep *step, const CagOriginStep *later) {
  const CagOriginSite *at = step->site, *after = later ? later->site : NULL;
  if (!at->caller) return false;
  return !after || after->caller != at->caller ||
         after->caller_span.start != at->caller_span.start ||
         after->caller_span.end != at->caller_span.end;
}

bool cag_session_part_place(CagSession *s, size_t part, size_t k, const char **what,
                            CagPlaceView *out) {
  *out = (CagPlaceView){0};
  if (!s->has_scene || part >= s->scene.item_count) return false;
  const CagItemSource *source = cag_session_item_source(s, &s->scene.items[part]);
  if (!source) return false;
  *what = "show";
  const CagShown *shown = &s->vm->shown[source->shown];
  *out = cag_session_place(shown->source, shown->span);
  if (k == 0) return true;
  const CagOriginStep *later = NULL;
  for (const CagOriginStep *step = source->shape->origin.last; step; step = step->before) {
    *what = step->before ? "changed" : "made";
    if (cag_origin_other_caller(step, later) && --k == 0) {
      *out = cag_session_place(step->site->caller, step->site->caller_span);
      return true;
    }
    later = step;
    if (--k > 0) continue;
    *out = cag_session_place(step->site->source, step->site->span);
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
