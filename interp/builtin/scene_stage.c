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
      "expects a color as `%s`: a CSS name, \"#0a8\", \"#00aa88\" or [r, g, b]; \"%s\" is "
      "none",
      what, text);
  const char *nearest = cag_nearest_name(text, names, n);
  if (nearest) cag_fail_help(call->vm, "did you mean \"%s\"?", nearest);
  return false;
}

// A fourth part, that other programs take for opacity.
static void fail_alpha(CagCall *call, const double x[4]) {
  cag_fail_help(call->vm,
                "a color has no opacity; write material(G, { color: [%.6g, %.6g, %.6g], "
                "transmission: %.6g })",
                x[0], x[1], x[2], 1 - x[3]);
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
                  "expects a color as `%s`: a CSS name, \"#0a8\" or [r, g, b]; found %s", what,
                  cag_type_article(v));
    if (numbers && n == 4) fail_alpha(call, x);
    return false;
  }
  for (size_t i = 0; i < 3; i++)
    if (!(x[i] >= 0 && isfinite(x[i])))
      return cag_fail_call(call, argument, CAG_ERR_value,
                           "expects parts of 0 or more in the color `%s`, found %g", what, x[i]);
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

static bool read_size(CagCall *call, int argument, CagValue *out) {
  const double *x;
  size_t n;
  double size[2] = {1280, 720};
  if (cag_given(call, argument)) {
    if (!cag_arg_numbers(call, argument, &x, &n)) return false;
    bool good = n == 2;
    for (size_t i = 0; good && i < 2; i++) {
      size[i] = x[i];
      good = x[i] >= 1 && x[i] <= PIXELS_MAX && x[i] == floor(x[i]);
    }
    if (!good)
      return cag_fail_call(call, argument, CAG_ERR_value,
                           "expects [width, height] in whole pixels up to %d as `size`",
                           PIXELS_MAX);
  }
  *out = cag_vector(call->vm, size, 2);
  return true;
}

bool cag_scenes_camera(CagCall *call, CagValue *result) {
  static const char *const names[] = {"eye",   "target", "up",    "fov",     "kind",
                                      "width", "size",   "focus", "aperture"};
  static const char *const kinds[] = {"perspective", "orthographic", NULL};
  CagVec3 eye, target, up;
  double fov, width = 0, focus = 0, aperture;
  int kind;
  CagValue size;
  if (!cag_arg_vec(call, 0, &eye, NULL) ||
      !cag_arg_vec_or(call, 1, cag_vec3(0, 0, 0), &target, NULL) ||
      !cag_arg_direction(call, 2, cag_vec3(0, 0, 1), &up, NULL))
    return false;
  if (cag_norm(cag_sub(eye, target)) == 0)
    return cag_fail_call(call, cag_given(call, 1) ? 1 : 0, CAG_ERR_view,
                         "expects two different points as `eye` and `target`");
  if (!cag_arg_angle_or(call, 3, 40 * CAG_RADIANS_PER_DEGREE, &fov)) return false;
  const double widest = 179; // degrees: the tangent of the half grows without end towards 180
  if (!(fov > 0 && fov <= widest * CAG_RADIANS_PER_DEGREE))
    return cag_fail_call(call, 3, CAG_ERR_view, "expects a `fov` above 0deg, of 179deg at most");
  if (!cag_arg_choice(call, 4, kinds, &kind) ||
      (cag_given(call, 5) && !cag_arg_positive(call, 5, &width)) || !read_size(call, 6, &size) ||
      (cag_given(call, 7) && !cag_arg_positive(call, 7, &focus)) ||
      !cag_arg_number_or(call, 8, 0, &aperture))
    return false;
  if (!(aperture >= 0 && isfinite(aperture)))
    return cag_fail_call(call, 8, CAG_ERR_value, "expects an `aperture` of 0 or more");
  CagValue fields[] = {cag_point(call->vm, eye, 3),
                       cag_point(call->vm, target, 3),
                       cag_point(call->vm, up, 3),
                       cag_angle(cag_degrees_shown(fov)),
                       cag_text_c(call->vm, kinds[kind]),
                       width > 0 ? cag_number(width) : cag_none(),
                       size,
                       focus > 0 ? cag_number(focus) : cag_none(),
                       cag_number(aperture)};
  return scene_result(call, CAG_CAMERA, kinds[kind], names, fields, 9, result);
}

// --- Lights ---

// `color` and `strength` stand at `at` and the parameter after it.
static bool read_light(CagCall *call, int at, CagValue *color, CagValue *strength) {
  CagColor c = {1, 1, 1};
  double s;
  if (cag_given(call, at) && !cag_color_read(call, at, "color", call->values[at], &c)) return false;
  if (!cag_arg_number_or(call, at + 1, 1, &s)) return false;
  if (!(s >= 0 && isfinite(s)))
    return cag_fail_call(call, at + 1, CAG_ERR_value, "expects a `strength` of 0 or more");
  *color = cag_color_value(call->vm, c);
  *strength = cag_number(s);
  return true;
}

bool cag_scenes_sun(CagCall *call, CagValue *result) {
  static const char *const names[] = {"direction", "color", "strength"};
  CagVec3 direction;
  CagValue fields[3];
  if (!cag_arg_direction(call, 0, cag_vec3(0, 0, 0), &direction, NULL) ||
      !read_light(call, 1, &fields[1], &fields[2]))
    return false;
  fields[0] = cag_point(call->vm, direction, 3);
  return scene_result(call, CAG_LIGHT, "sun", names, fields, 3, result);
}

bool cag_scenes_point_light(CagCall *call, CagValue *result) {
  static const char *const names[] = {"position", "color", "strength"};
  CagVec3 position;
  CagValue fields[3];
  if (!cag_arg_vec(call, 0, &position, NULL) || !read_light(call, 1, &fields[1], &fields[2]))
    return false;
  fields[0] = cag_point(call->vm, position, 3);
  return scene_result(call, CAG_LIGHT, "point", names, fields, 3, result);
}

// Position and target, which must differ.
static bool read_beam(CagCall *call, CagValue fields[2]) {
  CagVec3 position, target;
  if (!cag_arg_vec(call, 0, &position, NULL) || !cag_arg_vec(call, 1, &target, NULL)) return false;
  if (cag_norm(cag_sub(position, target)) == 0)
    return cag_fail_call(call, 1, CAG_ERR_view,
                         "expects two different points as `position` and `target`");
  fields[0] = cag_point(call->vm, position, 3);
  fields[1] = cag_point(call->vm, target, 3);
  return true;
}

bool cag_scenes_spot_light(CagCall *call, CagValue *result) {
  static const char *const names[] = {"position", "target", "angle", "color", "strength"};
  CagValue fields[5];
  double angle;
  if (!read_beam(call, fields) || !cag_arg_angle_or(call, 2, 30 * CAG_RADIANS_PER_DEGREE, &angle) ||
      !read_light(call, 3, &fields[3], &fields[4]))
    return false;
  if (!(angle > 0 && angle < 180 * CAG_RADIANS_PER_DEGREE))
    return cag_fail_call(call, 2, CAG_ERR_value, "expects an `angle` above 0deg and below 180deg");
  fields[2] = cag_angle(cag_degrees_shown(angle));
  return scene_result(call, CAG_LIGHT, "spot", names, fields, 5, result);
}

bool cag_scenes_area_light(CagCall *call, CagValue *result) {
  static const char *const names[] = {"position", "target", "size", "color", "strength"};
  CagValue fields[5];
  double size;
  if (!read_beam(call, fields) || !cag_arg_positive(call, 2, &size) ||
      !read_light(call, 3, &fields[3], &fields[4]))
    return false;
  fields[2] = cag_number(size);
  return scene_result(call, CAG_LIGHT, "area", names, fields, 5, result);
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
    return cag_fail_type(call, 0, "a color, colors from below to above, or an .exr image");
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

bool cag_scenes_ground(CagCall *call, CagValue *result) {
  static const char *const names[] = {"z", "size", "material", "name"};
  double z, size;
  if (!cag_arg_number_or(call, 0, 0, &z) || !cag_arg_number_or(call, 1, INFINITY, &size))
    return false;
  if (!isfinite(z)) return cag_fail_call(call, 0, CAG_ERR_value, "expects a finite `z`");
  if (!(size > 0)) return cag_fail_call(call, 1, CAG_ERR_value, "expects a `size` greater than 0");
  CagValue fields[] = {cag_number(z), cag_number(size), cag_none(), cag_none()};
  return scene_result(call, CAG_SETTING, "ground", names, fields, 4, result);
}
