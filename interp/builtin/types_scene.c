// The types of what a scene has besides shapes: cameras, lights, and settings.

#include <string.h>

#include "interp/builtin/shapes.h"
#include "interp/builtin/types.h"

// Fields by name, as far as they are given: "sun, direction [1, 1, -2], ...".
static void print_staged(CagVm *vm, CagString *s, CagValue v) {
  const CagSceneValue *value = CAG_AS_SCENE(v);
  const char *noun = v.type == CAG_CAMERA ? " camera" : v.type == CAG_LIGHT ? " light" : "";
  cag_string_printf(s, "%s%s", value->kind, !strcmp(value->kind, "sun") ? "" : noun);
  for (size_t i = 0; i < value->fields->layout->count; i++) {
    CagValue field = value->fields->fields[i];
    const char *name = value->fields->layout->names[i]->bytes;
    if (field.type == CAG_NONE || !strcmp(name, "kind")) continue;
    cag_string_printf(s, ", %s ", name);
    cag_print_value(vm, s, field, true);
  }
}

static void scan_staged(CagHeap *h, CagObject *o) {
  const CagRecord *fields = ((CagSceneValue *)o)->fields;
  if (fields) cag_mark_object(h, (CagObject *)&fields->head);
}

static bool staged_member(CagVm *vm, CagValue v, const char *name, CagValue *out) {
  return cag_type_record.member(vm, cag_object(CAG_RECORD, CAG_AS_SCENE(v)->fields), name, out);
}

static const char *staged_member_name(CagVm *vm, CagValue v, size_t i) {
  return cag_type_record.member_name(vm, cag_object(CAG_RECORD, CAG_AS_SCENE(v)->fields), i);
}

// Cameras and lights are moved by their points and directions; sizes follow a uniform scale.
static bool move_staged(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  static const char *const points[] = {"eye", "target", "position"};
  static const char *const vectors[] = {"up", "direction"};
  static const char *const sizes[] = {"width", "focus", "aperture"};
  const CagSceneValue *old = CAG_AS_SCENE(v);
  size_t n = old->fields->layout->count;
  double scale = 1;
  CagVec3 images[3] = {{0, 0, 0}}; // of `points`
  bool is_flat = !cag_transform_is_affine(t);
  cag_transform_is_similarity(t, &scale);
  CagValue fields[32];
  if (n > 32) return cag_fail_call(call, 0, CAG_ERR_internal, "found too many fields");
  for (size_t i = 0; i < n; i++) {
    const char *name = old->fields->layout->names[i]->bytes;
    CagValue f = fields[i] = old->fields->fields[i];
    const double *x;
    size_t count;
    bool vector = f.type == CAG_LIST && cag_as_vector(f, &x, &count) && count >= 2;
    CagVec3 p = vector ? cag_vec3(x[0], x[1], count > 2 ? x[2] : 0) : cag_vec3(0, 0, 0);
    for (size_t k = 0; vector && k < sizeof points / sizeof *points; k++)
      if (!strcmp(name, points[k]))
        fields[i] = cag_point(call->vm, images[k] = cag_transform_point(t, p), 3);
    for (size_t k = 0; vector && k < sizeof vectors / sizeof *vectors; k++)
      if (!strcmp(name, vectors[k])) {
        const CagVec3 image = cag_transform_vector(t, p);
        is_flat |= cag_norm(image) == 0;
        fields[i] = cag_point(call->vm, image, 3);
      }
    for (size_t k = 0; f.type == CAG_NUMBER && k < sizeof sizes / sizeof *sizes; k++)
      if (!strcmp(name, sizes[k])) fields[i] = cag_number(f.as.number * scale);
  }
  // A camera needs a direction to look and one that is up.
  if (is_flat || (v.type == CAG_CAMERA && cag_norm(cag_sub(images[0], images[1])) == 0))
    return cag_fail_call(call, 0, CAG_ERR_operand,
                         "cannot apply a projection to a camera or light");
  CagValue record = cag_record_from_texts(call->vm, old->fields->layout->names, fields, n);
  *result = cag_scene_value(call->vm, v.type, old->kind, record);
  CAG_AS_SCENE(*result)->placement = cag_transform_identity();
  CAG_AS_SCENE(*result)->mirrored = old->mirrored != cag_transform_mirrors(t);
  return true;
}

#define STAGED                                                                                     \
  .print = print_staged, .scan = scan_staged, .member = staged_member,                             \
  .member_name = staged_member_name
const CagValueType cag_type_camera = {STAGED, .transform = move_staged};
const CagValueType cag_type_light = {STAGED, .transform = move_staged};
const CagValueType cag_type_setting = {STAGED};
