// Cameras that measure: pinholes, matrices, pixels, lines of sight.

#include "interp/builtin/cameras.h"

#include <string.h>

#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// --- Reading ---

bool cag_arg_camera_rows(CagCall *call, int argument, double out[3][4]) {
  const CagValue v = call->values[argument];
  const CagList *list = v.type == CAG_LIST ? CAG_AS_LIST(v) : NULL;
  for (size_t i = 0; list && i < 3; i++) {
    const double *x;
    size_t n;
    if (list->length != 3 || !cag_as_vector(cag_list_get(call->vm, list, i), &x, &n) || n != 4)
      return cag_fail_type(call, argument, "a camera, or 3 rows of 4 numbers,");
    for (size_t j = 0; j < 4; j++) {
      if (!isfinite(x[j])) return cag_fail_value(call, argument, "finite numbers");
      out[i][j] = x[j];
    }
  }
  return list || cag_fail_type(call, argument, "3 rows of 4 numbers");
}

static bool arg_camera(CagCall *call, int argument, CagCamera *out) {
  if (call->values[argument].type != CAG_CAMERA) return cag_fail_type(call, argument, "a camera");
  *out = cag_camera_of_value(CAG_AS_SCENE(call->values[argument]));
  return true;
}

bool cag_arg_camera_map(CagCall *call, int argument, CagCameraMap *out) {
  double rows[3][4];
  const CagType type = call->values[argument].type;
  if (type == CAG_CAMERA) {
    const CagCamera c = cag_camera_of_value(CAG_AS_SCENE(call->values[argument]));
    return cag_geometry_ok(call, cag_scene_camera_map(&c, out, call->err));
  }
  if (type != CAG_LIST) return cag_fail_type(call, argument, "a camera, or 3 rows of 4 numbers,");
  return cag_arg_camera_rows(call, argument, rows) &&
         cag_geometry_ok(call, cag_camera_map(rows, out, call->err));
}

// A pair of finite numbers.
static bool read_pair(CagCall *call, int argument, CagNumbers numbers, const char *expected,
                      double out[2]) {
  if (numbers.count != 2 || !isfinite(numbers.items[0]) || !isfinite(numbers.items[1]))
    return cag_fail_value(call, argument, expected);
  memcpy(out, numbers.items, 2 * sizeof *out);
  return true;
}

#define PIXEL_EXPECTED "a pixel [u, v]"

// --- Making ---

CagValue cag_rows_value(CagVm *vm, const double *x, size_t rows, size_t columns) {
  double *numbers;
  const CagValue list = cag_list_vectors(vm, rows, columns, &numbers);
  for (size_t i = 0; i < rows * columns; i++) numbers[i] = x[i] + 0.0; // never -0
  return list;
}

// The fields of a pinhole. `target` is on its image plane.
typedef struct Pinhole {
  CagVec3 eye, target, up;
  double focal, skew;
  CagValue pitch, principal;
  const double *size;
  bool mirrored;
} Pinhole;

static CagValue pinhole_value(CagVm *vm, const Pinhole *p) {
  static const char *const names[] = {"eye",   "target", "up",        "focal",
                                      "pitch", "size",   "principal", "skew"};
  const CagValue fields[] = {cag_point(vm, p->eye, 3),
                             cag_point(vm, p->target, 3),
                             cag_point(vm, p->up, 3),
                             cag_number(p->focal),
                             p->pitch,
                             cag_vector(vm, p->size, 2),
                             p->principal,
                             cag_number(p->skew)};
  const CagValue v =
      cag_scene_value(vm, CAG_CAMERA, "pinhole", cag_record_new(vm, names, fields, 8));
  CAG_AS_SCENE(v)->placement = cag_transform_identity();
  CAG_AS_SCENE(v)->mirrored = p->mirrored;
  return v;
}

static bool check_pitch(CagCall *call, CagValue v) {
  const double *x;
  size_t n;
  if (v.type == CAG_NUMBER) {
    if (v.as.number > 0 && isfinite(v.as.number)) return true;
  } else if (v.type == CAG_LIST && cag_as_vector(v, &x, &n) && n == 2) {
    if (x[0] > 0 && x[1] > 0 && isfinite(x[0]) && isfinite(x[1])) return true;
  } else {
    return cag_fail_type(call, 2, "the side of a pixel (a number, or [width, height])");
  }
  return cag_fail_value(call, 2, "the side of a pixel (a number, or [width, height]) above 0");
}

static CagVec3 frame_column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

bool cag_cameras_pinhole(CagCall *call, const struct cag_cameras_pinhole *a, CagValue *result) {
  CagTransform frame;
  double size[2], principal[2];
  const bool given = cag_given(call, 4);
  if (!cag_arg_pose(call, 0, &frame) || !check_pitch(call, a->pitch) ||
      !cag_picture_size(call, 3, a->size, size) ||
      (given && !read_pair(call, 4, a->principal, PIXEL_EXPECTED, principal)))
    return false;
  const CagVec3 origin = frame_column(&frame, 3), axis = frame_column(&frame, 2);
  const Pinhole p = {.eye = cag_madd(origin, -a->focal, axis),
                     .target = origin,
                     .up = cag_sub(cag_vec3(0, 0, 0), frame_column(&frame, 1)),
                     .focal = a->focal,
                     .skew = a->skew,
                     .pitch = a->pitch,
                     .principal = given ? cag_vector(call->vm, principal, 2) : cag_none(),
                     .size = size};
  if (cag_norm(cag_sub(p.eye, p.target)) == 0)
    return cag_fail_value(call, 1, "a focal length that is not lost in the position of the frame");
  *result = pinhole_value(call->vm, &p);
  return true;
}

CagValue cag_pinhole_value(CagVm *vm, const CagCameraParts *parts, CagVec3 center, double pitch,
                           const double size[2]) {
  const double(*k)[3] = parts->k, (*r)[3] = parts->r;
  const CagVec3 right = cag_vec3(r[0][0], r[0][1], r[0][2]);
  const CagVec3 down = cag_vec3(r[1][0], r[1][1], r[1][2]);
  const CagVec3 forward = cag_vec3(r[2][0], r[2][1], r[2][2]);
  const double pitches[] = {pitch, pitch * k[0][0] / k[1][1]}, focal = pitch * k[0][0];
  const double principal[] = {k[0][2], k[1][2]};
  const Pinhole p = {.eye = center,
                     .target = cag_madd(center, focal, forward),
                     .up = cag_sub(cag_vec3(0, 0, 0), down),
                     .focal = focal,
                     .skew = k[0][1],
                     .pitch = cag_vector(vm, pitches, 2),
                     .principal = cag_vector(vm, principal, 2),
                     .size = size,
                     .mirrored = cag_dot(cag_cross(right, down), forward) < 0};
  return pinhole_value(vm, &p);
}

// --- Data ---

bool cag_cameras_camera_matrix(CagCall *call, const struct cag_cameras_camera_matrix *a,
                               CagValue *result) {
  CagCamera camera;
  CagCameraMap map;
  (void)a;
  if (!arg_camera(call, 0, &camera) ||
      !cag_geometry_ok(call, cag_scene_camera_map(&camera, &map, call->err)))
    return false;
  *result = cag_rows_value(call->vm, map.p[0], 3, 4);
  return true;
}

// The angle between the lines of sight of two borders of the picture.
static double angle_seen(double focal, double principal, double size) {
  return atan2(principal, focal) + atan2(size - principal, focal);
}

bool cag_cameras_intrinsics(CagCall *call, const struct cag_cameras_intrinsics *a,
                            CagValue *result) {
  static const char *const names[] = {"K", "center", "rotation", "focal", "size", "field_of_view"};
  CagCamera c;
  CagCameraMap map;
  (void)a;
  if (!arg_camera(call, 0, &c) || !cag_geometry_ok(call, cag_scene_camera_map(&c, &map, call->err)))
    return false;
  CagVm *vm = call->vm;
  CagCameraParts parts = cag_camera_parts(&c);
  if (map.parallel) cag_camera_split(&map, &parts); // with the pixel of the world's origin
  const double size[] = {c.size[0], c.size[1]};
  const CagValue angles[] = {
      cag_angle(cag_degrees_shown(angle_seen(parts.k[0][0], parts.k[0][2], size[0]))),
      cag_angle(cag_degrees_shown(angle_seen(parts.k[1][1], parts.k[1][2], size[1])))};
  const CagValue values[] = {cag_rows_value(vm, parts.k[0], 3, 3),
                             map.parallel ? cag_none() : cag_point(vm, c.eye, 3),
                             cag_rows_value(vm, parts.r[0], 3, 3),
                             c.focal > 0 ? cag_number(c.focal) : cag_none(),
                             cag_vector(vm, size, 2),
                             map.parallel ? cag_none() : cag_list_values(vm, angles, 2)};
  *result = cag_record_new(vm, names, values, 6);
  return true;
}

bool cag_cameras_footprint(CagCall *call, const struct cag_cameras_footprint *a, CagValue *result) {
  CagCamera c;
  if (!arg_camera(call, 0, &c)) return false;
  if (!isfinite(a->depth)) return cag_fail_value(call, 1, "a finite depth");
  if (!c.orthographic && !(a->depth + c.focal > 0))
    return cag_fail_call(call, 1, CAG_ERR_point_not_in_front,
                         "expects a depth in front of the center of projection, above %g, found %g",
                         -c.focal, a->depth);
  const CagCameraParts parts = cag_camera_parts(&c);
  return cag_give_number(call, (c.orthographic ? 1 : a->depth + c.focal) / parts.k[0][0], result);
}

// --- Points and pixels ---

bool cag_cameras_project_point(CagCall *call, const struct cag_cameras_project_point *a,
                               CagValue *result) {
  static const char *const names[] = {"pixel", "depth"};
  CagCameraMap map;
  double pixel[2], depth = 0;
  if (!cag_arg_camera_map(call, 0, &map)) return false;
  *result = cag_none();
  if (!cag_camera_project(&map, a->P.at, pixel, &depth)) return true;
  if (!isfinite(pixel[0]) || !isfinite(pixel[1]))
    return cag_fail_call(call, 1, CAG_ERR_not_finite, "overflows: the pixel is too far");
  const CagValue values[] = {cag_vector(call->vm, pixel, 2),
                             map.has_depth ? cag_number(depth) : cag_none()};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_cameras_sight_line(CagCall *call, const struct cag_cameras_sight_line *a,
                            CagValue *result) {
  static const char *const names[] = {"origin", "direction"};
  CagCameraMap map;
  double pixel[2];
  CagVec3 origin, direction;
  if (!cag_arg_camera_map(call, 0, &map) || !read_pair(call, 1, a->pixel, PIXEL_EXPECTED, pixel))
    return false;
  cag_camera_sight(&map, pixel, &origin, &direction);
  const CagVec3 zero = {0, 0, 0}; // added to avoid -0
  const CagValue values[] = {cag_point(call->vm, cag_add(origin, zero), 3),
                             cag_point(call->vm, cag_add(direction, zero), 3)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

// The direction from which angles on a plane are measured: X as projected to it, or Y.
static CagVec3 plane_axis(CagVec3 normal) {
  const double across = 1e-9; // sine of the angle below which X counts as the normal
  CagVec3 x = cag_madd(cag_vec3(1, 0, 0), -normal.x, normal);
  if (cag_norm(x) < across) x = cag_madd(cag_vec3(0, 1, 0), -normal.y, normal);
  return cag_unit(x);
}

bool cag_cameras_on_plane(CagCall *call, const struct cag_cameras_on_plane *a, CagValue *result) {
  static const char *const names[] = {"point", "angle"};
  CagCameraMap map;
  double pixel[2];
  CagVec3 point, beside;
  if (!cag_arg_camera_map(call, 0, &map) || !read_pair(call, 1, a->pixel, PIXEL_EXPECTED, pixel))
    return false;
  *result = cag_none();
  if (!cag_camera_on_plane(&map, pixel, &a->plane, &point)) return true;
  CagValue angle = cag_none();
  if (cag_given(call, 3)) {
    double sine, cosine;
    cag_sincos(a->theta, &sine, &cosine);
    const double next[] = {pixel[0] + cosine, pixel[1] - sine};
    if (!cag_camera_on_plane(&map, next, &a->plane, &beside)) return true;
    const CagVec3 way = cag_sub(beside, point), x = plane_axis(a->plane.normal);
    const CagVec3 y = cag_cross(a->plane.normal, x);
    angle = cag_angle(cag_atan2_degrees(cag_dot(way, y), cag_dot(way, x)));
  }
  const CagValue values[] = {cag_point(call->vm, point, 3), angle};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

// --- Stereo ---

static bool read_line(CagCall *call, int argument, CagVec3 *origin, CagVec3 *direction) {
  CagRecord *record;
  if (!cag_arg_record(call, argument, &record)) return false;
  static const CagVec3 missing = {NAN, NAN, NAN};
  *origin = cag_point_field(record, "origin", missing);
  *direction = cag_point_field(record, "direction", missing);
  const double size = cag_norm(*direction);
  if (!isfinite(cag_norm(*origin)) || !(size > 0) || !isfinite(size))
    return cag_fail_value(call, argument,
                          "a record with a point `origin` and a vector `direction`");
  return true;
}

static bool read_sight(CagCall *call, int camera, int pixel, CagVec3 *origin, CagVec3 *direction) {
  CagCameraMap map;
  CagNumbers numbers;
  double at[2];
  if (!cag_arg_camera_map(call, camera, &map) ||
      !cag_arg_numbers(call, pixel, &numbers.items, &numbers.count) ||
      !read_pair(call, pixel, numbers, PIXEL_EXPECTED, at))
    return false;
  cag_camera_sight(&map, at, origin, direction);
  return true;
}

bool cag_cameras_stereo(CagCall *call, CagValue *result) {
  static const char *const names[] = {"point", "gap"};
  const bool lines = call->values[0].type == CAG_RECORD;
  CagVec3 origins[2], directions[2], point;
  double gap;
  for (int i = 0; i < 2; i++)
    if (lines ? !read_line(call, i, &origins[i], &directions[i])
              : !read_sight(call, i, 2 + i, &origins[i], &directions[i]))
      return false;
  if (!cag_geometry_ok(call, cag_stereo_point(origins, directions, &point, &gap, call->err)))
    return false;
  const CagValue values[] = {cag_point(call->vm, point, 3), cag_number(gap)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

// --- On a robot ---

bool cag_cameras_carried(CagCall *call, const struct cag_cameras_carried *a, CagValue *result) {
  const CagRobot *r = a->robot;
  const CagType type = call->values[0].type;
  double q[CAG_ROBOT_JOINTS_MAX];
  long link = (long)r->link_count;
  CagTransform mount = a->mount, t;
  if (type != CAG_CAMERA && type != CAG_TRANSFORM)
    return cag_fail_type(call, 0, "a camera, or the frame of a sensor,");
  if (!cag_arg_joints(call, 2, r, a->limits, q) ||
      (cag_given(call, 3) && !cag_arg_pose(call, 3, &mount)) ||
      !cag_arg_integer_or(call, 4, link, 0, link, &link))
    return false;
  cag_robot_subchain(r, q, 0, (size_t)link, &t);
  t = cag_transform_multiply(&r->base, &t);
  t = cag_transform_multiply(&t, &mount);
  t.planar = false;
  return cag_transform_apply(call->vm, &t, call->values[0], result);
}
