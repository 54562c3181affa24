// Converts the values that a script shows, except images, to a scene: groups are split, attributes of a group apply
// to its shapes that have none, and records become plain structs.
//
// Nothing here calls back into the script, so values need no roots.

#include "interp/session/scene_build.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/scene.h"
#include "interp/session/lead.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/memory.h"
#include "geom/solid/csg.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/solids.h"
#include "interp/vm/vm.h"

typedef struct Build {
  CagVm *vm;
  CagScene *scene;
  size_t item_capacity, label_capacity, material_capacity, camera_capacity, light_capacity;
  CagHashIndex names;      // items by name
  size_t *name_numbers;    // for each item: the last number appended to its name for other items
  size_t number_capacity;  // of name_numbers
  CagItemSources *sources; // NULL: not wanted
  size_t shown;            // the shown value that is being added
  CagHashIndex materials;  // by appearance, and by appearance and name
  CagHashIndex labels;     // of the current item
  bool failed;             // memory ran out
} Build;

// The attributes of the groups around a shape.
typedef struct Said {
  CagRecord *material;
  const char *name;
  CagLineStyle line;
  double tolerance;
} Said;

static void *grown(Build *b, void *items, size_t count, size_t *capacity, size_t size) {
  if (!cag_array_reserve(&items, capacity, count + 1, size)) b->failed = true;
  return items;
}

static char *copy_text(Build *b, const char *text) {
  char *copy = cag_strdup(text);
  if (!copy) b->failed = true;
  return copy;
}

// --- Fields of records ---

static const char *text_field(const CagRecord *r, const char *name, const char *fallback) {
  CagValue v = r ? cag_record_get(r, name) : cag_unset();
  return v.type == CAG_TEXT ? CAG_AS_TEXT(v)->bytes : fallback;
}

static CagColor color_field(const CagRecord *r, const char *name, CagColor fallback) {
  CagVec3 c = cag_point_field(r, name, cag_vec3(fallback.r, fallback.g, fallback.b));
  return (CagColor){c.x, c.y, c.z};
}

// --- Materials ---

// The color of curves without a material.
static const CagColor ink = {0.03, 0.035, 0.05};
#define DEFAULT_MATERIAL 0
#define INK_MATERIAL 1

static bool same_text(const char *a, const char *b) { return a == b || (a && b && !strcmp(a, b)); }
static bool same_color(CagColor a, CagColor b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

static bool same_material(const CagMaterial *a, const CagMaterial *b) {
  return same_color(a->color, b->color) && a->metallic == b->metallic &&
         a->roughness == b->roughness && a->ior == b->ior && a->transmission == b->transmission &&
         same_color(a->emission, b->emission) && a->coat == b->coat &&
         same_color(a->color2, b->color2) && a->texture_scale == b->texture_scale &&
         same_text(a->texture, b->texture) && same_text(a->pov, b->pov);
}

static uint64_t hash_color(uint64_t h, CagColor c) {
  return cag_hash_number(cag_hash_number(cag_hash_number(h, c.r), c.g), c.b);
}

// Hashes the fields that same_material compares.
static uint64_t hash_material(const CagMaterial *m) {
  const double numbers[] = {m->metallic,     m->roughness, m->ior,
                            m->transmission, m->coat,      m->texture_scale};
  uint64_t h = hash_color(hash_color(hash_color(CAG_HASH_START, m->color), m->emission), m->color2);
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) h = cag_hash_number(h, numbers[i]);
  h = cag_hash_text(h, m->texture);
  return m->pov ? cag_hash_text(h, m->pov) : h;
}

// Finds the first material with the same appearance and name (NULL: any).
static bool find_material(const Build *b, uint64_t hash, const CagMaterial *m, const char *name,
                          size_t *out) {
  const CagMaterial *known = b->scene->materials;
  for (CagHashWalk w = cag_hash_walk(&b->materials, hash); cag_hash_next(&w, out);)
    if (same_material(&known[*out], m) && (!name || same_text(known[*out].name, name))) return true;
  return false;
}

// Adds the material unless the scene contains the same one. Copies texts.
static size_t keep_material(Build *b, CagMaterial m, const char *name) {
  CagScene *s = b->scene;
  const uint64_t look = hash_material(&m);
  size_t known;
  if (find_material(b, name ? cag_hash_text(look, name) : look, &m, name, &known)) return known;
  const bool first = !name || !find_material(b, look, &m, NULL, &known);
  s->materials =
      grown(b, s->materials, s->material_count, &b->material_capacity, sizeof *s->materials);
  if (b->failed) return DEFAULT_MATERIAL;
  char numbered[32];
  snprintf(numbered, sizeof numbered, "material_%zu", s->material_count);
  m.name = copy_text(b, name ? name : numbered);
  m.texture = copy_text(b, m.texture);
  m.pov = m.pov ? copy_text(b, m.pov) : NULL;
  const uint64_t named = m.name ? cag_hash_text(look, m.name) : look;
  if (first && !cag_hash_add(&b->materials, look, s->material_count)) b->failed = true;
  if (!cag_hash_add(&b->materials, named, s->material_count)) b->failed = true;
  s->materials[s->material_count] = m;
  return s->material_count++;
}

static size_t material_of(Build *b, const CagRecord *r, size_t fallback) {
  if (!r) return fallback;
  CagMaterial m = b->scene->materials[fallback];
  m.color = color_field(r, "color", m.color);
  m.color2 = color_field(r, "color2", m.color2);
  m.emission = color_field(r, "emission", m.emission);
  m.metallic = cag_number_field(r, "metallic", m.metallic);
  m.roughness = cag_number_field(r, "roughness", m.roughness);
  m.ior = cag_number_field(r, "ior", m.ior);
  m.transmission = cag_number_field(r, "transmission", m.transmission);
  m.coat = cag_number_field(r, "coat", m.coat);
  m.texture_scale = cag_number_field(r, "texture_scale", m.texture_scale);
  // copied when the material is added
  m.texture = (char *)text_field(r, "texture", m.texture);
  m.pov = (char *)text_field(r, "pov", NULL);
  return keep_material(b, m, text_field(r, "name", NULL));
}

// --- Items ---

static bool find_item(const Build *b, const char *name, size_t *out) {
  const uint64_t hash = cag_hash_text(CAG_HASH_START, name);
  for (CagHashWalk w = cag_hash_walk(&b->names, hash); cag_hash_next(&w, out);)
    if (same_text(b->scene->items[*out].name, name)) return true;
  return false;
}

// Makes "vase", "vase.2", "vase.3" ... The search continues from the last number appended to the
// name, so that naming many items with the same name takes linear time.
static char *unique_name(Build *b, const char *wanted) {
  size_t first, taken;
  if (!find_item(b, wanted, &first)) return copy_text(b, wanted);
  size_t size = strlen(wanted) + 24, *number = &b->name_numbers[first];
  char *name = cag_malloc(size);
  if (!name) {
    b->failed = true;
    return NULL;
  }
  do snprintf(name, size, "%s.%zu", wanted, ++*number);
  while (find_item(b, name, &taken));
  return name;
}

static CagItem *add_item(Build *b, CagItemKind kind, const char *name) {
  CagScene *s = b->scene;
  s->items = grown(b, s->items, s->item_count, &b->item_capacity, sizeof *s->items);
  b->name_numbers =
      grown(b, b->name_numbers, s->item_count, &b->number_capacity, sizeof *b->name_numbers);
  char *own = b->failed ? NULL : unique_name(b, name);
  if (!b->failed && !cag_hash_add(&b->names, cag_hash_text(CAG_HASH_START, own), s->item_count)) {
    cag_free(own);
    b->failed = true;
  }
  if (b->failed) return NULL;
  b->name_numbers[s->item_count] = 1;
  CagItem *item = &s->items[s->item_count++];
  *item = (CagItem){.kind = kind,
                    .number = s->item_count - 1,
                    .name = own,
                    .placement = cag_transform_identity()};
  return item;
}

static void add_label(Build *b, const CagLabelText *label, const Said *said) {
  CagScene *s = b->scene;
  size_t material = material_of(b, said->material, INK_MATERIAL);
  s->labels = grown(b, s->labels, s->label_count, &b->label_capacity, sizeof *s->labels);
  if (b->failed) return;
  s->labels[s->label_count++] = (CagLabel){.text = copy_text(b, label->text->bytes),
                                           .at = label->at,
                                           .along = label->along,
                                           .directed = cag_norm(label->along) > 0,
                                           .place = (CagLabelPlace)label->place,
                                           .mark = (CagLabelMark)label->mark,
                                           .size = label->size,
                                           .material = material};
}

// Returns the kind of surface that it was made as, before any transforms.
static const char *surface_name(const CagSurface *s) {
  const CagSurface *inner;
  CagTransform map;
  return cag_surface_placed_view(s, &inner, &map) ? inner->kind->name : s->kind->name;
}

// The labels in a solid or mesh, and their materials.
typedef struct Labels {
  Build *b;
  CagItem *item;
  CagRecord *outer;
  size_t capacity;
  uint32_t last; // the last label found; neighboring triangles usually have the same one
} Labels;

static bool is_noted(const Labels *l, uint32_t label) {
  size_t i;
  CagHashWalk w = cag_hash_walk(&l->b->labels, cag_hash_word(CAG_HASH_START, label));
  while (cag_hash_next(&w, &i))
    if (l->item->labels[i].label == label) return true;
  return false;
}

static void note_label(Labels *l, uint32_t label) {
  CagItem *item = l->item;
  if (label == 0 || label == l->last || is_noted(l, label) || l->b->failed) return;
  l->last = label;
  item->labels = grown(l->b, item->labels, item->label_count, &l->capacity, sizeof *item->labels);
  if (l->b->failed) return;
  CagRecord *own = cag_solids_material(l->b->vm, label);
  const size_t at =
      material_of(l->b, cag_material_combine(l->b->vm, own, l->outer), DEFAULT_MATERIAL);
  if (!cag_hash_add(&l->b->labels, cag_hash_word(CAG_HASH_START, label), item->label_count))
    l->b->failed = true;
  item->labels[item->label_count++] = (CagItemLabel){label, own ? at : item->material};
}

static void note_solid_labels(Labels *l, const CagSolid *s) {
  note_label(l, s->label);
  if (s->core && s->core->mesh && s->kind == CAG_SOLID_MESH && s->core->mesh->labels)
    for (size_t t = 0; t < s->core->mesh->triangle_count; t++)
      note_label(l, s->core->mesh->labels[t]);
  for (size_t i = 0; s->core && i < s->core->count; i++) note_solid_labels(l, s->core->operands[i]);
}

static int by_label(const void *a, const void *b) {
  const CagItemLabel *x = a, *y = b;
  return x->label < y->label ? -1 : x->label > y->label;
}

static void note_labels(Build *b, CagItem *item, CagRecord *outer) {
  Labels l = {.b = b, .item = item, .outer = outer};
  if (item->kind == CAG_ITEM_SOLID) note_solid_labels(&l, item->as.solid);
  if (item->kind == CAG_ITEM_MESH && item->as.mesh->labels)
    for (size_t t = 0; t < item->as.mesh->triangle_count; t++)
      note_label(&l, item->as.mesh->labels[t]);
  cag_hash_free(&b->labels);
  if (item->label_count) qsort(item->labels, item->label_count, sizeof *item->labels, by_label);
}

// Notes where the last item comes from.
static void note_source(Build *b, const CagShape *shape) {
  CagItemSources *k = b->sources;
  const size_t n = b->scene->item_count;
  if (!k || b->failed) return;
  if (!CAG_RESERVE(k->items, k->capacity, n)) {
    b->failed = true;
    return;
  }
  memset(k->items + k->count, 0, (n - k->count) * sizeof *k->items); // grounds have none
  k->items[n - 1] = (CagItemSource){shape, b->shown};
  k->count = n;
}

static void add_shape(Build *b, CagValue v, const Said *said) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagItem *item = NULL;
  const char *name = said->name;
  if (v.type == CAG_LABEL) {
    add_label(b, shape->as.label, said);
    return;
  }
  size_t fallback = v.type == CAG_CURVE ? INK_MATERIAL : DEFAULT_MATERIAL;
  size_t material = material_of(b, said->material, fallback);
  switch (v.type) {
  case CAG_CURVE:
    item = add_item(b, CAG_ITEM_CURVE, name ? name : shape->as.curve->kind->name);
    if (item) item->as.curve = cag_curve_retain(shape->as.curve);
    break;
  case CAG_REGION:
    item = add_item(b, CAG_ITEM_REGION, name ? name : "region");
    if (item) item->as.region = cag_region_retain(shape->as.region);
    if (item) item->placement = shape->placement[0];
    break;
  case CAG_SURFACE:
    item = add_item(b, CAG_ITEM_SURFACE, name ? name : surface_name(shape->as.surface));
    if (item) item->as.surface = cag_surface_retain(shape->as.surface);
    break;
  case CAG_SOLID:
    item = add_item(b, CAG_ITEM_SOLID, name ? name : cag_solid_kind_name(shape->as.solid->kind));
    if (item) item->as.solid = cag_solid_retain(shape->as.solid);
    break;
  default:
    item = add_item(b, CAG_ITEM_MESH, name ? name : "mesh");
    if (item) item->as.mesh = cag_mesh_retain(shape->as.mesh);
  }
  if (!item) return;
  note_source(b, shape);
  item->material = material;
  item->tolerance = said->tolerance;
  note_labels(b, item, said->material);
  item->line_radius = said->line.radius;
  item->dash = said->line.dash;
}

static void add_shapes(Build *b, CagValue v, const Said *around, CagLead lead) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  b->failed = b->failed || !cag_may_go_deeper(b->vm, "shown");
  if (shape->hidden || b->failed) return;
  Said said = {cag_material_combine(b->vm, shape->material, around->material),
               shape->name ? shape->name->bytes
               : lead.name ? lead.name
                           : around->name,
               shape->line.set ? shape->line : around->line,
               shape->tolerance > 0 ? shape->tolerance : around->tolerance};
  if (v.type != CAG_GROUP) {
    add_shape(b, v, &said);
    return;
  }
  const CagList *items = shape->as.items;
  const CagLead unnamed = {0};
  const CagLeadParts parts = cag_lead_parts(shape->name ? unnamed : lead, items->length);
  for (size_t i = 0; i < items->length && !b->failed; i++)
    add_shapes(b, cag_list_get(b->vm, items, i), &said, cag_lead_part(&parts, i));
}

// --- Cameras, lights, settings ---

static void add_camera(Build *b, const CagSceneValue *v, const char *name) {
  CagScene *s = b->scene;
  s->cameras = grown(b, s->cameras, s->camera_count, &b->camera_capacity, sizeof *s->cameras);
  if (b->failed) return;
  CagCamera c = cag_camera_of_value(v);
  c.name = copy_text(b, text_field(v->fields, "name", name ? name : "camera"));
  s->cameras[s->camera_count++] = c;
}

static void add_light(Build *b, const CagSceneValue *v) {
  CagScene *s = b->scene;
  s->lights = grown(b, s->lights, s->light_count, &b->light_capacity, sizeof *s->lights);
  if (!b->failed) s->lights[s->light_count++] = cag_light_of_value(v);
}

static void set_sky(Build *b, const CagRecord *r) {
  CagSky *sky = &b->scene->sky;
  cag_free(sky->colors);
  cag_free(sky->image);
  *sky = (CagSky){0};
  CagValue image = cag_record_get(r, "image"), colors = cag_record_get(r, "colors");
  if (image.type == CAG_TEXT) {
    sky->image = copy_text(b, CAG_AS_TEXT(image)->bytes);
    cag_vm_note_file(b->vm, CAG_AS_TEXT(image)->bytes); // the renderer reads it
  }
  if (colors.type != CAG_LIST) return;
  const CagList *list = CAG_AS_LIST(colors);
  sky->colors = cag_malloc((list->length + 1) * sizeof *sky->colors);
  if (!sky->colors) {
    b->failed = true;
    return;
  }
  for (size_t i = 0; i < list->length; i++) {
    const double *x;
    size_t n;
    if (!cag_as_vector(cag_list_get(b->vm, list, i), &x, &n) || n != 3) continue;
    sky->colors[sky->color_count++] = (CagColor){x[0], x[1], x[2]};
  }
}

static void add_ground(Build *b, const CagRecord *r, const char *name) {
  CagValue said = cag_record_get(r, "material");
  const CagRecord *material = said.type == CAG_RECORD ? CAG_AS_RECORD(said) : NULL;
  size_t index = material_of(b, material, DEFAULT_MATERIAL);
  CagItem *item = add_item(b, CAG_ITEM_GROUND, text_field(r, "name", name ? name : "ground"));
  if (!item) return;
  item->material = index;
  item->ground_z = cag_number_field(r, "z", 0);
  item->ground_size = cag_number_field(r, "size", INFINITY);
}

static void add_setting(Build *b, const CagSceneValue *v, const char *name) {
  if (!strcmp(v->kind, "sky")) set_sky(b, v->fields);
  else if (!strcmp(v->kind, "ground")) add_ground(b, v->fields, name);
  else {
    b->scene->has_background = true;
    b->scene->background = color_field(v->fields, "color", (CagColor){0, 0, 0});
  }
}

// --- Shown values ---

// A robot is shown at home.
static void add_robot(Build *b, CagValue v, CagLead lead) {
  CagValue group;
  if (cag_robot_at_home(b->vm, v, &group)) add_shapes(b, group, &(Said){0}, lead);
  else b->failed = true;
}

static void add_value(Build *b, CagValue v, CagLead lead) {
  b->failed = b->failed || !cag_may_go_deeper(b->vm, "shown");
  if (v.type == CAG_LIST) {
    const CagList *list = CAG_AS_LIST(v);
    const CagLeadParts parts = cag_lead_parts(lead, list->length);
    for (size_t i = 0; i < list->length && !b->failed; i++)
      add_value(b, cag_list_get(b->vm, list, i), cag_lead_part(&parts, i));
    return;
  }
  if (v.type == CAG_CAMERA) add_camera(b, CAG_AS_SCENE(v), lead.name);
  else if (v.type == CAG_LIGHT) add_light(b, CAG_AS_SCENE(v));
  else if (v.type == CAG_SETTING) add_setting(b, CAG_AS_SCENE(v), lead.name);
  else if (v.type == CAG_ROBOT) add_robot(b, v, lead);
  else if (cag_is_shape(v)) add_shapes(b, v, &(Said){0}, lead);
}

static void free_scene(void *scene) { cag_scene_free(scene); }

static void free_build(void *build) {
  Build *b = build;
  cag_hash_free(&b->names);
  cag_hash_free(&b->materials);
  cag_hash_free(&b->labels);
  cag_free(b->name_numbers);
}

static bool build_scene(Build *build, const CagShown *shown, size_t n) {
  CagVm *vm = build->vm;
  CagMaterial plain = cag_material_default(), line = plain;
  line.color = ink;
  keep_material(build, plain, plain.name);
  keep_material(build, line, "ink");
  for (size_t i = 0; i < n && !build->failed; i++) {
    if (!cag_value_is_shown(vm, shown[i].value))
      return !vm->failed &&
             cag_vm_fail(
                 vm, CAG_ERR_no_image,
                 "show expects shapes, images, lights, cameras, and lists of these, found %s",
                 cag_type_article(shown[i].value));
    build->shown = i;
    add_value(build, shown[i].value, cag_lead(shown[i].expr));
  }
  if (!build->failed) return true;
  return !vm->failed &&
         cag_vm_fail(vm, CAG_ERR_limit_memory, "the scene needs more memory than is available");
}

bool cag_scene_from_values(CagVm *vm, const CagShown *shown, size_t n, CagScene *out,
                           CagItemSources *sources) {
  Build b = {.vm = vm, .scene = out, .sources = sources};
  if (sources) sources->count = 0;
  CagCleanup scene, building;
  *out = (CagScene){.bounds = CAG_BOUNDS_EMPTY};
  cag_cleanup_push(&scene, free_scene, out);
  cag_cleanup_push(&building, free_build, &b);
  const bool ok = build_scene(&b, shown, n);
  cag_cleanup_run(&building);
  if (ok) cag_cleanup_pop(&scene);
  else cag_cleanup_run(&scene);
  return ok;
}
