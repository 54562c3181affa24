// Attributes of shapes: material, color, name, tolerance, and line style.
//
// The innermost attribute wins: the material of a group does not change that of a shape in it. A
// color alone is stored as a material with only that field. It is completed by the material of an
// enclosing group, and a color of an enclosing group completes a material without color.

#include <stdlib.h>
#include <string.h>

#include "interp/builtin/scene.h"

// --- Materials ---

typedef enum FieldKind {
  FIELD_COLOR,
  FIELD_SHARE,
  FIELD_NUMBER,
  FIELD_TEXT,
  FIELD_GLOW,
  FIELD_FLAG
} FieldKind;
typedef struct Field {
  const char *name;
  FieldKind kind;
} Field;

static const Field fields[] = {
    {"color", FIELD_COLOR},          {"metallic", FIELD_SHARE},     {"roughness", FIELD_SHARE},
    {"ior", FIELD_NUMBER},           {"coat", FIELD_SHARE},         {"transmission", FIELD_SHARE},
    {"emission", FIELD_GLOW},        {"texture", FIELD_TEXT},       {"color2", FIELD_COLOR},
    {"texture_scale", FIELD_NUMBER}, {"pov", FIELD_TEXT},           {"name", FIELD_TEXT},
    {"density", FIELD_NUMBER},       {"reflectivity", FIELD_SHARE}, {"conductive", FIELD_FLAG},
    {"ferromagnetic", FIELD_FLAG}};
#define FIELD_COUNT (sizeof fields / sizeof *fields)

static const char *const textures[] = {"", "wood", "marble", "concrete", "clay"};
#define TEXTURE_COUNT (sizeof textures / sizeof *textures)

static bool fail_field(CagCall *call, const char *name) {
  const char *names[FIELD_COUNT];
  for (size_t i = 0; i < FIELD_COUNT; i++) names[i] = fields[i].name;
  cag_fail_call(call, 1, CAG_ERR_material_field, "has no field `%s`", name);
  const char *nearest = cag_nearest_name(name, names, FIELD_COUNT);
  return nearest && cag_fail_help(call->vm, "did you mean `%s`?", nearest);
}

static bool check_texture(CagCall *call, const char *text) {
  for (size_t i = 0; i < TEXTURE_COUNT; i++)
    if (!strcmp(text, textures[i])) return true;
  cag_fail_call(
      call, 1, CAG_ERR_material_field,
      "expects \"wood\", \"marble\", \"concrete\", or \"clay\" as `texture`, found \"%s\"", text);
  const char *nearest = cag_nearest_name(text, textures, TEXTURE_COUNT);
  return nearest && cag_fail_help(call->vm, "did you mean \"%s\"?", nearest);
}

// Checks one field. Colors are converted to [r, g, b].
static bool check_field(CagCall *call, const Field *f, CagValue *v) {
  CagColor c;
  double x = v->type == CAG_NUMBER ? v->as.number : -1;
  switch (f->kind) {
  case FIELD_GLOW:
    if (v->type == CAG_NUMBER) {
      *v = cag_color_value(call->vm, (CagColor){x, x, x});
      return (x >= 0 && isfinite(x)) ||
             cag_fail_call(call, 1, CAG_ERR_material_field,
                           "expects a color, or a number of at least 0, as `%s`", f->name);
    }
    // fall through
  case FIELD_COLOR:
    if (!cag_color_read(call, 1, f->name, *v, &c)) return false;
    *v = cag_color_value(call->vm, c);
    return true;
  case FIELD_SHARE:
    return (x >= 0 && x <= 1) || cag_fail_call(call, 1, CAG_ERR_material_field,
                                               "expects a number in 0..1 as `%s`", f->name);
  case FIELD_NUMBER:
    return (x > 0 && isfinite(x)) ||
           cag_fail_call(call, 1, CAG_ERR_material_field, "expects a number greater than 0 as `%s`",
                         f->name);
  case FIELD_FLAG:
    return v->type == CAG_BOOL ||
           cag_fail_call(call, 1, CAG_ERR_material_field, "expects true or false as `%s`, found %s",
                         f->name, cag_type_article(*v));
  case FIELD_TEXT:
    if (v->type != CAG_TEXT)
      return cag_fail_call(call, 1, CAG_ERR_material_field, "expects a text as `%s`, found %s",
                           f->name, cag_type_article(*v));
    return strcmp(f->name, "texture") != 0 || check_texture(call, CAG_AS_TEXT(*v)->bytes);
  }
  return true;
}

static bool check_material(CagCall *call, const CagRecord *given, CagRecord **out) {
  size_t n = given->layout->count;
  CagValue values[FIELD_COUNT];
  for (size_t i = 0; i < n; i++) {
    const char *name = given->layout->names[i]->bytes;
    size_t k = 0;
    while (k < FIELD_COUNT && strcmp(fields[k].name, name) != 0) k++;
    if (k == FIELD_COUNT) return fail_field(call, name);
    values[i] = given->fields[i];
    if (!check_field(call, &fields[k], &values[i])) return false;
  }
  *out = CAG_AS_RECORD(cag_record_from_texts(call->vm, given->layout->names, values, n));
  return true;
}

static bool has_field(const CagRecord *r, const char *name) {
  return cag_record_get(r, name).type != CAG_UNSET;
}

// Copies all fields of `base` and adds the color.
static CagRecord *with_color(CagVm *vm, const CagRecord *base, CagValue color) {
  const char *names[FIELD_COUNT + 1];
  CagValue values[FIELD_COUNT + 1];
  size_t n = 0;
  names[n] = "color";
  values[n++] = color;
  for (size_t i = 0; i < base->layout->count; i++) {
    const char *name = base->layout->names[i]->bytes;
    if (!strcmp(name, "color")) continue;
    names[n] = name;
    values[n++] = base->fields[i];
  }
  return CAG_AS_RECORD(cag_record_new(vm, names, values, n));
}

CagRecord *cag_material_combine(CagVm *vm, CagRecord *inner, CagRecord *outer) {
  if (!inner) return outer;
  if (!outer) return inner;
  bool color_alone = inner->layout->count == 1 && has_field(inner, "color");
  if (color_alone) return with_color(vm, outer, cag_record_get(inner, "color"));
  if (!has_field(inner, "color") && has_field(outer, "color"))
    return with_color(vm, inner, cag_record_get(outer, "color"));
  return inner;
}

// --- Setting attributes ---

// Copies a setting, camera, or light with a new value of one field.
static CagValue with_field(CagVm *vm, CagValue v, const char *name, CagValue value) {
  const CagSceneValue *old = CAG_AS_SCENE(v);
  const char *names[32];
  CagValue values[32];
  size_t n = 0;
  for (size_t i = 0; i < old->fields->layout->count && n < 31; i++) {
    if (!strcmp(old->fields->layout->names[i]->bytes, name)) continue;
    names[n] = old->fields->layout->names[i]->bytes;
    values[n++] = old->fields->fields[i];
  }
  names[n] = name;
  values[n++] = value;
  CagValue copy = cag_scene_value(vm, v.type, old->kind, cag_record_new(vm, names, values, n));
  CAG_AS_SCENE(copy)->placement = old->placement;
  CAG_AS_SCENE(copy)->mirrored = old->mirrored;
  return copy;
}

bool cag_scene_copy(CagCall *call, CagValue *result) {
  CagValue v = call->values[0];
  if (v.type == CAG_LIST) {
    CagBuilder *shapes = cag_builder_new(call->vm);
    if (!cag_shapes_collect(call, v, shapes)) return false;
    v = cag_group_value(call->vm, cag_builder_finish(call->vm, shapes));
  }
  if (!cag_is_shape(v)) return cag_fail_type(call, 0, "a shape or a list of shapes");
  *result = cag_shape_copy(call->vm, v);
  return true;
}

static bool set_material(CagCall *call, CagRecord *material, CagValue *result) {
  CagValue v = call->values[0];
  if (v.type == CAG_SETTING && !strcmp(CAG_AS_SCENE(v)->kind, "ground")) {
    CagValue old = cag_record_get(CAG_AS_SCENE(v)->fields, "material");
    CagRecord *inner = old.type == CAG_RECORD ? CAG_AS_RECORD(old) : NULL;
    CagRecord *both = cag_material_combine(call->vm, inner, material);
    *result = with_field(call->vm, v, "material", cag_object(CAG_RECORD, both));
    return true;
  }
  if (!cag_scene_copy(call, result)) return false;
  CagShape *shape = CAG_AS_SHAPE(*result);
  shape->material = cag_material_combine(call->vm, shape->material, material);
  return true;
}

bool cag_scenes_material(CagCall *call, const struct cag_scenes_material *a, CagValue *result) {
  CagRecord *material = NULL;
  return check_material(call, a->m, &material) && set_material(call, material, result);
}

bool cag_scenes_color(CagCall *call, CagValue *result) {
  static const char *const names[] = {"color"};
  CagColor c;
  if (!cag_color_read(call, 1, "color", call->values[1], &c)) return false;
  CagValue color = cag_color_value(call->vm, c);
  return set_material(call, CAG_AS_RECORD(cag_record_new(call->vm, names, &color, 1)), result);
}

// A copy of an image, with the name unless it has one.
static CagValue named_image(CagVm *vm, CagValue v, CagValue name) {
  const CagImageValue *image = CAG_AS_IMAGE(v);
  if (image->name) return v;
  const CagValue copy = cag_image_value(vm, cag_raster_retain(image->raster));
  CAG_AS_IMAGE(copy)->name = CAG_AS_TEXT(name);
  return copy;
}

bool cag_scenes_named(CagCall *call, const struct cag_scenes_named *a, CagValue *result) {
  const CagValue v = a->G, name = call->values[1];
  if (!*a->name) return cag_fail_call(call, 1, CAG_ERR_value, "expects a name that is not empty");
  if (v.type == CAG_CAMERA || v.type == CAG_LIGHT || v.type == CAG_SETTING) {
    *result = cag_record_get(CAG_AS_SCENE(v)->fields, "name").type == CAG_TEXT
                  ? v
                  : with_field(call->vm, v, "name", name);
    return true;
  }
  if (v.type == CAG_IMAGE) {
    *result = named_image(call->vm, v, name);
    return true;
  }
  if (!cag_scene_copy(call, result)) return false;
  CagShape *shape = CAG_AS_SHAPE(*result);
  if (!shape->name) shape->name = CAG_AS_TEXT(name);
  return true;
}

bool cag_scenes_tolerance(CagCall *call, const struct cag_scenes_tolerance *a, CagValue *result) {
  if (!cag_scene_copy(call, result)) return false;
  CagShape *shape = CAG_AS_SHAPE(*result);
  if (shape->tolerance == 0) shape->tolerance = a->t;
  return true;
}

bool cag_scenes_hidden(CagCall *call, CagValue *result) {
  if (!cag_scene_copy(call, result)) return false;
  CAG_AS_SHAPE(*result)->hidden = true;
  return true;
}

bool cag_scenes_group(CagCall *call, CagValue *result) {
  CagBuilder *items = cag_builder_new(call->vm);
  for (size_t i = 0; i < call->count; i++) {
    CagValue v = call->values[i];
    if (v.type == CAG_UNSET) continue;
    // Groups are kept with their attributes; lists are flattened.
    bool ok = v.type == CAG_GROUP ? cag_builder_add(call->vm, items, v)
                                  : cag_shapes_collect(call, v, items);
    if (!ok) return false;
  }
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, items));
  return true;
}

bool cag_scenes_line_style(CagCall *call, const struct cag_scenes_line_style *a, CagValue *result) {
  if (!cag_scene_copy(call, result)) return false;
  CagShape *shape = CAG_AS_SHAPE(*result);
  if (!shape->line.set) shape->line = (CagLineStyle){true, a->radius, a->dash};
  return true;
}
