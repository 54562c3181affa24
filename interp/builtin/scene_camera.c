// Cameras and lights as plain data.

#include <string.h>

#include "interp/builtin/scene.h"

double cag_number_field(const CagRecord *r, const char *name, double fallback) {
  CagValue v = r ? cag_record_get(r, name) : cag_unset();
  return v.type == CAG_NUMBER || v.type == CAG_ANGLE ? v.as.number : fallback;
}

CagVec3 cag_point_field(const CagRecord *r, const char *name, CagVec3 fallback) {
  const double *x;
  size_t n;
  CagValue v = cag_record_get(r, name);
  if (v.type != CAG_LIST || !cag_as_vector(v, &x, &n) || n < 2) return fallback;
  return cag_vec3(x[0], x[1], n > 2 ? x[2] : 0);
}

// Makes up perpendicular to the view direction. If they are parallel, uses Y.
static CagVec3 square_up(CagVec3 view, CagVec3 up) {
  const double along_view = 1e-9; // sine of the angle below which up and view count as parallel
  CagVec3 v = cag_unit(view), u = cag_unit(up);
  if (cag_norm(cag_cross(v, u)) < along_view) u = cag_vec3(0, 1, 0);
  if (cag_norm(cag_cross(v, u)) < along_view) u = cag_vec3(0, 0, 1);
  return cag_unit(cag_madd(u, -cag_dot(u, v), v));
}

// Pixels are `pitch` wide and high at the distance `focal`; without a principal point, the view axis
// goes through the middle of the picture.
static void read_pinhole(const CagRecord *r, CagCamera *c) {
  const double one = cag_number_field(r, "pitch", 1);
  const CagVec3 pitch = cag_point_field(r, "pitch", cag_vec3(one, one, 0));
  const double width = c->size[0], height = c->size[1];
  const CagVec3 principal = cag_point_field(r, "principal", cag_vec3(width / 2, height / 2, 0));
  c->focal = cag_number_field(r, "focal", 1);
  c->width = width * pitch.x;
  c->fov = 2 * atan2(c->width / 2, c->focal);
  c->shift[0] = (width / 2 - principal.x) / width;
  c->shift[1] = (height / 2 - principal.y) / width;
  c->skew = cag_number_field(r, "skew", 0) * pitch.x / c->focal;
  c->stretch = pitch.x / pitch.y - 1;
}

CagCamera cag_camera_of_value(const CagSceneValue *v) {
  static const CagVec3 none = {0, 0, 0};
  const CagRecord *r = v->fields;
  const CagTransform *place = &v->placement;
  const CagVec3 size = cag_point_field(r, "size", cag_vec3(1280, 720, 0));
  CagCamera c = {.eye = cag_transform_point(place, cag_point_field(r, "eye", none)),
                 .target = cag_transform_point(place, cag_point_field(r, "target", none)),
                 .orthographic = !strcmp(v->kind, "orthographic"),
                 .fov = cag_number_field(r, "fov", 40) * CAG_RADIANS_PER_DEGREE,
                 .width = cag_number_field(r, "width", 0),
                 .size = {(int)size.x, (int)size.y},
                 .focus = cag_number_field(r, "focus", 0),
                 .aperture = cag_number_field(r, "aperture", 0),
                 .mirrored = v->mirrored != cag_transform_mirrors(place)};
  const CagVec3 view = cag_sub(c.target, c.eye);
  c.up = square_up(view, cag_transform_vector(place, cag_point_field(r, "up", cag_vec3(0, 0, 1))));
  if (c.width <= 0) c.width = 2 * cag_norm(view) * tan(c.fov / 2);
  if (!strcmp(v->kind, "pinhole")) read_pinhole(r, &c);
  return c;
}

CagLight cag_light_of_value(const CagSceneValue *v) {
  static const CagVec3 none = {0, 0, 0};
  static const struct {
    const char *kind;
    CagLightKind id;
  } kinds[] = {{"sun", CAG_LIGHT_SUN},
               {"point", CAG_LIGHT_POINT},
               {"spot", CAG_LIGHT_SPOT},
               {"area", CAG_LIGHT_AREA}};
  const CagRecord *r = v->fields;
  const CagTransform *place = &v->placement;
  const CagVec3 color = cag_point_field(r, "color", cag_vec3(1, 1, 1));
  CagLight l = {.kind = CAG_LIGHT_SUN,
                .position = cag_transform_point(place, cag_point_field(r, "position", none)),
                .angle = cag_number_field(r, "angle", 30) * CAG_RADIANS_PER_DEGREE,
                .size = cag_number_field(r, "size", 0),
                .color = {color.x, color.y, color.z},
                .strength = cag_number_field(r, "strength", 1)};
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
    if (!strcmp(v->kind, kinds[i].kind)) l.kind = kinds[i].id;
  const CagVec3 target = cag_transform_point(place, cag_point_field(r, "target", none));
  const CagVec3 direction = l.kind == CAG_LIGHT_SUN
                                ? cag_transform_vector(place, cag_point_field(r, "direction", none))
                                : cag_sub(target, l.position);
  l.direction = l.kind == CAG_LIGHT_POINT ? cag_vec3(0, 0, -1) : cag_unit(direction);
  return l;
}
