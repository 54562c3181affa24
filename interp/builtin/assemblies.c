// Frames of parts, and placing parts by frames and faces.

#include "interp/builtin/assemblies.h"

#include <string.h>

#include "geom/linalg/rigid.h"
#include "interp/builtin/scene.h"
#include "interp/builtin/support.h"

// --- Frames ---

CagRecord *cag_frames_moved(CagVm *vm, const CagRecord *frames, const CagTransform *map) {
  const CagLayout *names = frames->layout;
  CagValue record = cag_record_with_layout(vm, frames->layout, frames->fields);
  for (size_t i = 0; i < names->count; i++) {
    CagTransform image;
    if (!cag_frame_image(map, &CAG_AS_TRANSFORM(frames->fields[i])->t, &image)) return NULL;
    CAG_AS_RECORD(record)->fields[i] = cag_transform_value(vm, &image);
  }
  return CAG_AS_RECORD(record);
}

static bool check_frames(CagCall *call, const CagRecord *frames) {
  for (size_t i = 0; i < frames->layout->count; i++) {
    const char *name = frames->layout->names[i]->bytes;
    const CagValue v = frames->fields[i];
    if (v.type != CAG_TRANSFORM)
      return cag_fail_call(call, 1, CAG_ERR_type,
                           "expects transforms as `frames`, found %s as `%s`", cag_type_article(v),
                           name);
    if (cag_transform_is_rigid(&CAG_AS_TRANSFORM(v)->t)) continue;
    cag_fail_call(call, 1, CAG_ERR_not_rigid,
                  "expects rigid transforms as `frames`, but `%s` scales, shears, or mirrors",
                  name);
    return cag_fail_help(call->vm,
                         "orthonormal(T) is the nearest transform without scale or shear");
  }
  return true;
}

// The fields of `old`, which may be NULL, and those of `added`, which take precedence.
static CagRecord *joined_frames(CagCall *call, const CagRecord *old, CagRecord *added) {
  if (!old) return added;
  const size_t most = old->layout->count + added->layout->count;
  CagText **names = cag_hold_array(call, most, sizeof *names);
  CagValue *values = cag_hold_array(call, most, sizeof *values);
  size_t n = 0;
  for (size_t i = 0; i < old->layout->count; i++) {
    if (cag_layout_find(added->layout, old->layout->names[i]) != (size_t)-1) continue;
    names[n] = old->layout->names[i];
    values[n++] = old->fields[i];
  }
  for (size_t i = 0; i < added->layout->count; i++) {
    names[n] = added->layout->names[i];
    values[n++] = added->fields[i];
  }
  return CAG_AS_RECORD(cag_record_from_texts(call->vm, names, values, n));
}

bool cag_assemblies_with_frames(CagCall *call, const struct cag_assemblies_with_frames *a,
                                CagValue *result) {
  if (!check_frames(call, a->frames) || !cag_scene_copy(call, result)) return false;
  CagShape *shape = CAG_AS_SHAPE(*result);
  shape->frames = joined_frames(call, shape->frames, a->frames);
  return true;
}

// --- attach ---

static bool check_frame(CagCall *call, int argument, const CagTransform *t) {
  if (cag_transform_is_rigid(t)) return true;
  cag_fail_call(call, argument, CAG_ERR_not_rigid,
                "expects a rigid transform as `%s`, found one that scales, shears, or mirrors",
                cag_parameter_name(call, argument));
  return cag_fail_help(call->vm, "orthonormal(T) is the nearest transform without scale or shear");
}

bool cag_assemblies_attach(CagCall *call, const struct cag_assemblies_attach *a, CagValue *result) {
  CagTransform back, motion;
  if (!check_frame(call, 1, &a->its) || !check_frame(call, 2, &a->to)) return false;
  if (!cag_geometry_ok(call, cag_transform_inverse(&a->its, &back, call->err))) return false;
  motion = cag_transform_multiply(&a->to, &back);
  return cag_transform_apply(call->vm, &motion, a->part, result);
}

// --- mate ---

typedef struct Face {
  CagVec3 center, normal;
} Face;

static bool face_vector(CagCall *call, int argument, const CagRecord *face, const char *field,
                        CagVec3 *out) {
  const CagValue v = cag_record_get(face, field);
  const double *x;
  size_t n;
  if (v.type == CAG_UNSET) {
    cag_fail_call(call, argument, CAG_ERR_field, "expects a record with the field `%s` as `%s`",
                  field, cag_parameter_name(call, argument));
    return cag_fail_help(call->vm, "a face is a record such as {center: [0, 0, 10], normal: Z}");
  }
  const bool is_vector = v.type == CAG_LIST && cag_as_vector(v, &x, &n) && (n == 2 || n == 3);
  if (is_vector) *out = cag_vec3(x[0], x[1], n == 3 ? x[2] : 0);
  if (is_vector && isfinite(out->x) && isfinite(out->y) && isfinite(out->z)) return true;
  return cag_fail_call(call, argument, CAG_ERR_type,
                       "expects 2 or 3 finite numbers as `%s` of `%s`, found %s", field,
                       cag_parameter_name(call, argument), cag_type_article(v));
}

static bool read_face(CagCall *call, int argument, const CagRecord *face, Face *out) {
  if (!face_vector(call, argument, face, "center", &out->center) ||
      !face_vector(call, argument, face, "normal", &out->normal))
    return false;
  return cag_norm(out->normal) > 0 ||
         cag_fail_call(call, argument, CAG_ERR_value,
                       "expects a direction as `normal` of `%s`, found the zero vector",
                       cag_parameter_name(call, argument));
}

static bool check_part(CagCall *call, int argument) {
  const CagValue v = call->values[argument];
  return cag_is_shape(v) || v.type == CAG_LIST ||
         cag_fail_type(call, argument, "a shape or a group");
}

bool cag_assemblies_mate(CagCall *call, const struct cag_assemblies_mate *a, CagValue *result) {
  Face face, onto;
  if (!check_part(call, 2) || !read_face(call, 1, a->face, &face) ||
      !read_face(call, 3, a->onto_face, &onto))
    return false;
  const CagVec3 up = cag_unit(onto.normal);
  const CagTransform turn = cag_rotation_between(face.normal, cag_scaled(up, -1)),
                     to_center = cag_translate(cag_scaled(face.center, -1)),
                     back = cag_translate(cag_madd(onto.center, a->gap, up));
  CagTransform motion = cag_transform_multiply(&turn, &to_center);
  motion = cag_transform_multiply(&back, &motion);
  motion.planar = false;
  return cag_transform_apply(call->vm, &motion, a->part, result);
}
