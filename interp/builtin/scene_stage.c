// Cameras, lights, sky, background and ground: records whose fields are checked and complete.

#include <string.h>

#include "interp/builtin/scene.h"
#include "interp/scene/color.h"

// --- Colors ---

static bool fail_color(CagCall *call, int argument, const char *what, const char *text) {
  size_t n;
  const char *const *names = cag_color_names(&n);
  cag_fail_call(
      call, argument, CAG_ERR_color,
      "expects a color as `%s`: a CSS name, \"#0a8\", \"#00aa88\", or [r, g, b]; found \"%s\"",
      what, text);
  const char *nearest = cag_nearest_name(text, names, n);
  return nearest && cag_fail_help(call->vm, "did you mean \"%s\"?", nearest);
}

bool cag_color_read(CagCall *call, int argument, const char *what, CagValue v, CagColor *out) {
  const double *x;
  size_t n;
  if (v.type == CAG_TEXT) {
    const char *text = CAG_AS_TEXT(v)->bytes;
    return (cag_text_is_c(CAG_AS_TEXT(v)) && cag_color_from_text(text, out)) ||
           fail_color(call, argument, what, text);
  }
  const bool numbers = v.type == CAG_LIST && cag_as_vector(v, &x, &n);
  if (!numbers || n != 3) {
    cag_fail_call(call, argument, CAG_ERR_type,
                  "expects a color as `%s`: a CSS name, \"#0a8\", or [r, g, b]; found %s", what,
                  cag_type_article(v));
    // Other programs take a fourth part for opacity.
    return numbers && n == 4 &&
           cag_fail_help(call->vm,
                         "a color has no opacity; write material(G, { color: [%.6g, %.6g, %.6g], "
                         "transmission: %.6g })",
                         x[0], x[1], x[2], 1 - x[3]);
  }
  for (size_t i = 0; i < 3; i++)
    if (!(x[i] >= 0 && isfinite(x[i])))
      return cag_fail_call(call, argument, CAG_ERR_value,
                           "expects components of at least 0 in the color `%s`, found %g", what,
                           x[i]);
  *out = (CagColor){x[0], x[1], x[2]};
  return true;
}

CagValue cag_color_value(CagVm *vm, CagColor c) {
  double x[] = {c.r, c.g, c.b};
  return cag_vector(vm, x, 3);
}

static bool scene_result(CagCall *call, CagType type, const char *kind, const char *const *names,
                         const CagValue *fields, size_t n, CagValue *result) {
  *result = cag_scene_value(call->vm, type, kind, cag_record_new(call->vm, names, fields, n));
  CAG_AS_SCENE(*result)->placement = cag_transform_identity();
  return true;
}

// --- Camera ---

// Pixels along one side: more would be 10 GB of picture.
#define PIXELS_MAX 65536

static bool is_pixels(double x) { return x >= 1 && x <= PIXELS_MAX && x == floor(x); }

bool cag_scenes_camera(CagCall *call, const struct cag_scenes_camera *a, CagValue *result) {
  static const char *const names[] = {"eye",   "target", "up",    "fov",     "kind",
                                      "width", "size",   "focus", "aperture"};
  static const char *const kinds[] = {"perspective", "orthographic"};
  const double widest = 179; // degrees: the tangent of the half grows without end towards 180
  double size[] = {1280, 720};
  if (cag_norm(cag_sub(a->eye.at, a->target.at)) == 0)
    return cag_fail_call(call, cag_given(call, 1) ? 1 : 0, CAG_ERR_view,
                         "expects two different points as `eye` and `target`");
  if (!(a->fov > 0 && a->fov <= widest * CAG_RADIANS_PER_DEGREE))
    return cag_fail_call(call, 3, CAG_ERR_view,
                         "expects a `fov` greater than 0deg and at most 179deg");
  if (cag_given(call, 6)) {
    const double *x = a->size.items;
    if (a->size.count != 2 || !is_pixels(x[0]) || !is_pixels(x[1]))
      return cag_fail_call(call, 6, CAG_ERR_value,
                           "expects [width, height] in whole pixels, at most %d, as `size`",
                           PIXELS_MAX);
    memcpy(size, x, sizeof size);
  }
  if (!(a->aperture >= 0 && isfinite(a->aperture)))
    return cag_fail_call(call, 8, CAG_ERR_value, "expects an `aperture` of at least 0");
  CagValue fields[] = {cag_point(call->vm, a->eye.at, 3),
                       cag_point(call->vm, a->target.at, 3),
                       cag_point(call->vm, a->up.at, 3),
                       cag_angle(cag_degrees_shown(a->fov)),
                       cag_text_c(call->vm, kinds[a->kind]),
                       a->width > 0 ? cag_number(a->width) : cag_none(),
                       cag_vector(call->vm, size, 2),
                       a->focus > 0 ? cag_number(a->focus) : cag_none(),
                       cag_number(a->aperture)};
  return scene_result(call, CAG_CAMERA, kinds[a->kind], names, fields, 9, result);
}

// --- Lights ---

// A light of n fields, which are the parameters. The last two are the color, which is read here,
// and the strength.
static bool light_result(CagCall *call, const char *kind, const char *const *names,
                         CagValue *fields, size_t n, double strength, CagValue *result) {
  const int color = (int)n - 2;
  CagColor c = {1, 1, 1};
  if (cag_given(call, color) && !cag_color_read(call, color, "color", call->values[color], &c))
    return false;
  if (!(strength >= 0 && isfinite(strength)))
    return cag_fail_call(call, color + 1, CAG_ERR_value, "expects a `strength` of at least 0");
  fields[n - 2] = cag_color_value(call->vm, c);
  fields[n - 1] = cag_number(strength);
  return scene_result(call, CAG_LIGHT, kind, names, fields, n, result);
}

bool cag_scenes_sun(CagCall *call, const struct cag_scenes_sun *a, CagValue *result) {
  static const char *const names[] = {"direction", "color", "strength"};
  CagValue fields[3] = {cag_point(call->vm, a->direction.at, 3)};
  return light_result(call, "sun", names, fields, 3, a->strength, result);
}

bool cag_scenes_point_light(CagCall *call, const struct cag_scenes_point_light *a,
                            CagValue *result) {
  static const char *const names[] = {"position", "color", "strength"};
  CagValue fields[3] = {cag_point(call->vm, a->position.at, 3)};
  return light_result(call, "point", names, fields, 3, a->strength, result);
}

// A light at a position that looks at a target, with its angle or size.
static bool beam_result(CagCall *call, const char *kind, const char *const *names, CagVec3 position,
                        CagVec3 target, CagValue width, double strength, CagValue *result) {
  if (cag_norm(cag_sub(position, target)) == 0)
    return cag_fail_call(call, 1, CAG_ERR_view,
                         "expects two different points as `position` and `target`");
  CagValue fields[5] = {cag_point(call->vm, position, 3), cag_point(call->vm, target, 3), width};
  return light_result(call, kind, names, fields, 5, strength, result);
}

bool cag_scenes_spot_light(CagCall *call, const struct cag_scenes_spot_light *a, CagValue *result) {
  static const char *const names[] = {"position", "target", "angle", "color", "strength"};
  if (!(a->angle > 0 && a->angle < 180 * CAG_RADIANS_PER_DEGREE))
    return cag_fail_call(call, 2, CAG_ERR_value,
                         "expects an `angle` greater than 0deg and less than 180deg");
  return beam_result(call, "spot", names, a->position.at, a->target.at,
                     cag_angle(cag_degrees_shown(a->angle)), a->strength, result);
}

bool cag_scenes_area_light(CagCall *call, const struct cag_scenes_area_light *a, CagValue *result) {
  static const char *const names[] = {"position", "target", "size", "color", "strength"};
  return beam_result(call, "area", names, a->position.at, a->target.at, cag_number(a->size),
                     a->strength, result);
}

// --- Settings ---

static bool is_image(CagValue v) {
  if (v.type != CAG_TEXT) return false;
  const CagText *t = CAG_AS_TEXT(v);
  return t->length > 4 && cag_text_is_c(t) && strcmp(t->bytes + t->length - 4, ".exr") == 0;
}

bool cag_scenes_sky(CagCall *call, CagValue *result) {
  static const char *const names[] = {"colors", "image"};
  CagValue v = call->values[0], fields[2] = {cag_none(), cag_none()};
  CagColor c;
  const double *x;
  size_t n;
  if (is_image(v)) {
    fields[1] = v;
    return scene_result(call, CAG_SETTING, "sky", names, fields, 2, result);
  }
  bool one = v.type == CAG_TEXT || (v.type == CAG_LIST && cag_as_vector(v, &x, &n));
  if (!one && v.type != CAG_LIST)
    return cag_fail_type(call, 0, "a color, a list of colors from bottom to top, or an .exr image");
  CagBuilder *colors = cag_builder_new(call->vm);
  n = one ? 1 : CAG_AS_LIST(v)->length;
  for (size_t i = 0; i < n; i++) {
    CagValue item = one ? v : cag_list_get(call->vm, CAG_AS_LIST(v), i);
    if (!cag_color_read(call, 0, "colors", item, &c) ||
        !cag_builder_add(call->vm, colors, cag_color_value(call->vm, c)))
      return false;
  }
  if (n == 0) return cag_fail_call(call, 0, CAG_ERR_value, "expects at least one color");
  fields[0] = cag_builder_finish(call->vm, colors);
  return scene_result(call, CAG_SETTING, "sky", names, fields, 2, result);
}

bool cag_scenes_background(CagCall *call, CagValue *result) {
  static const char *const names[] = {"color"};
  CagColor c;
  if (!cag_color_read(call, 0, "color", call->values[0], &c)) return false;
  CagValue field = cag_color_value(call->vm, c);
  return scene_result(call, CAG_SETTING, "background", names, &field, 1, result);
}

bool cag_scenes_ground(CagCall *call, const struct cag_scenes_ground *a, CagValue *result) {
  static const char *const names[] = {"z", "size", "material", "name"};
  if (!isfinite(a->z)) return cag_fail_call(call, 0, CAG_ERR_value, "expects a finite `z`");
  if (!(a->size > 0))
    return cag_fail_call(call, 1, CAG_ERR_value, "expects a `size` greater than 0");
  CagValue fields[] = {cag_number(a->z), cag_number(a->size), cag_none(), cag_none()};
  return scene_result(call, CAG_SETTING, "ground", names, fields, 4, result);
}
