// Cameras that see a stripe of light, and the brightness of shapes.

#include <math.h>

#include "base/parallel.h"
#include "base/stop.h"
#include "geom/camera/camera.h"
#include "interp/builtin/images.h"
#include "interp/builtin/scene.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

static void release_crossings(void *list) { cag_crossings_free(list); }

static bool read_camera(CagCall *call, int argument, CagCamera *camera, CagCameraMap *map) {
  if (call->values[argument].type != CAG_CAMERA) return cag_fail_type(call, argument, "a camera");
  *camera = cag_camera_of_value(CAG_AS_SCENE(call->values[argument]));
  return cag_geometry_ok(call, cag_scene_camera_map(camera, map, call->err));
}

// --- Stripes ---

// Planes whose normals have a smaller sine between them count as parallel.
#define PARALLEL 1e-12

typedef struct Stripe {
  const CagTarget *target;
  CagCameraMap map;
  CagVec3 eye; // of the sight line through the middle of the picture
  size_t columns;
  CagPlane plane;
  bool has_light;
  CagLight light;
  CagCrossings *crossings, *work;
  CagRaster *image;
  CagVec3 origin, across, away; // of the profile
} Stripe;

// A lit point that the camera sees.
typedef struct LitPoint {
  CagVec3 at;
  double u, distance; // column, and distance from the camera
} LitPoint;

// The line in which the plane of light meets the plane that row y of the picture shows.
static bool row_line(const Stripe *s, size_t y, CagRay *out) {
  const double(*p)[4] = s->map.p;
  const double v = (double)y + 0.5;
  double row[4];
  for (int k = 0; k < 4; k++) row[k] = p[1][k] - v * p[2][k];
  CagVec3 n = cag_vec3(row[0], row[1], row[2]);
  const double length = cag_norm(n);
  n = cag_scaled(n, 1 / length);
  const CagVec3 along = cag_cross(n, s->plane.normal);
  const double square = cag_dot(along, along);
  if (!(square > PARALLEL * PARALLEL)) return false;
  // From the camera, by the distances of both planes.
  const double a = -(cag_dot(n, s->eye) + row[3] / length);
  const double b = cag_dot(s->plane.normal, cag_sub(s->plane.point, s->eye));
  const CagVec3 shift = cag_add(cag_scaled(cag_cross(s->plane.normal, along), a / square),
                                cag_scaled(cag_cross(along, n), b / square));
  *out = (CagRay){cag_add(s->eye, shift), cag_unit(along), -INFINITY, INFINITY};
  return true;
}

// Whether light reaches the side of a point that the camera sees.
static CagStatus point_is_lit(const Stripe *s, const CagCaster *part, CagVec3 at, CagVec3 normal,
                              CagVec3 sight, bool *lit, CagError *err) {
  *lit = true;
  if (!s->has_light) return CAG_OK;
  const bool sun = s->light.kind == CAG_LIGHT_SUN;
  const CagVec3 beam = sun ? s->light.direction : cag_unit(cag_sub(at, s->light.position));
  if (!cag_caster_is_closed(part) && cag_dot(beam, normal) * cag_dot(sight, normal) < 0) {
    *lit = false;
    return CAG_OK;
  }
  if (!sun) return cag_target_sees(s->target, s->light.position, at, s->work, lit, err);
  const CagRay ray = {at, cag_scaled(beam, -1), cag_target_skipped(s->target, at), INFINITY};
  CagTargetHit hit;
  bool met;
  CagStatus status = cag_target_first(s->target, &ray, s->work, &hit, &met, err);
  *lit = !met;
  return status;
}

static CagStatus see_point(const Stripe *s, size_t part, const CagCrossing *x, const CagRay *line,
                           size_t row, LitPoint *out, bool *seen, CagError *err) {
  double pixel[2], depth;
  CagVec3 origin, sight;
  const CagVec3 at = cag_ray_point(line, x->t);
  *seen = false;
  if (!cag_camera_project(&s->map, at, pixel, &depth) ||
      !(pixel[0] >= 0 && pixel[0] <= (double)s->columns))
    return CAG_OK;
  pixel[1] = (double)row + 0.5;
  cag_camera_sight(&s->map, pixel, &origin, &sight);
  *out = (LitPoint){at, pixel[0], cag_dot(cag_sub(at, origin), sight)};
  if (!(out->distance > 0)) return CAG_OK;
  CagStatus status = cag_target_sees(s->target, origin, at, s->work, seen, err);
  if (!status && *seen)
    status = point_is_lit(s, s->target->parts[part].caster, at, x->normal, sight, seen, err);
  return status;
}

// Adds a stripe one pixel wide around column u, whose center of brightness is u.
static void add_to_image(const Stripe *s, size_t row, double u) {
  const double first = floor(u - 0.5), rest = u - 0.5 - first;
  for (int k = 0; k < 2; k++) {
    const double column = first + k;
    if (!(column >= 0 && column < (double)s->columns)) continue;
    double *pixel = cag_raster_at(s->image, 0, (size_t)column, row);
    *pixel = fmin(1, *pixel + (k ? rest : 1 - rest));
  }
}

static CagStatus see_row(const Stripe *s, size_t row, LitPoint *best, bool *any, CagError *err) {
  CagRay line;
  CagStatus status = cag_stop_check(err);
  *any = false;
  if (status || !row_line(s, row, &line)) return status;
  for (size_t i = 0; !status && i < s->target->count; i++) {
    status = cag_caster_all(s->target->parts[i].caster, &line, s->crossings, NULL, err);
    for (size_t k = 0; !status && k < s->crossings->n; k++) {
      LitPoint found;
      bool seen;
      status = see_point(s, i, &s->crossings->items[k], &line, row, &found, &seen, err);
      if (status || !seen) continue;
      add_to_image(s, row, found.u);
      if (*any && !(found.distance < best->distance)) continue;
      *any = true;
      *best = found;
    }
  }
  return status;
}

// The axes of the profile: in the plane of light, `away` from the camera, and `across` in the
// direction of rows that follow each other.
static void find_profile_axes(Stripe *s) {
  const double(*p)[4] = s->map.p;
  const CagVec3 n = s->plane.normal, down = cag_vec3(p[1][0], p[1][1], p[1][2]);
  CagVec3 away = cag_madd(s->map.view, -cag_dot(s->map.view, n), n);
  if (cag_norm(away) < PARALLEL) away = cag_vec3(p[0][0], p[0][1], p[0][2]);
  s->away = cag_unit(cag_madd(away, -cag_dot(away, n), n));
  s->across = cag_cross(n, s->away);
  // Rows go down: the derivative of the row along `across`.
  const CagVec3 last = cag_vec3(p[2][0], p[2][1], p[2][2]);
  const CagVec3 turn = cag_sub(down, cag_scaled(last, cag_dot(down, last)));
  if (cag_dot(s->across, turn) < 0) s->across = cag_scaled(s->across, -1);
  s->origin = cag_madd(s->eye, cag_dot(n, cag_sub(s->plane.point, s->eye)), n);
}

static bool read_stripe_light(CagCall *call, int argument, Stripe *s) {
  s->has_light = cag_given(call, argument);
  if (!s->has_light) return true;
  const CagValue v = call->values[argument];
  if (v.type == CAG_LIGHT) {
    s->light = cag_light_of_value(CAG_AS_SCENE(v));
    return true;
  }
  s->light = (CagLight){.kind = CAG_LIGHT_POINT};
  return cag_arg_vec(call, argument, &s->light.position, NULL);
}

static CagValue profile_sample(CagVm *vm, const Stripe *s, CagVec3 at) {
  const CagVec3 off = cag_sub(at, s->origin);
  const double sample[] = {cag_dot(off, s->across), cag_dot(off, s->away)};
  return cag_vector(vm, sample, 2);
}

bool cag_sensors_light_stripe(CagCall *call, const struct cag_sensors_light_stripe *a,
                              CagValue *result) {
  static const char *const names[] = {"points", "profile", "image"};
  Stripe s = {.plane = a->plane};
  CagCamera camera;
  if (!read_camera(call, 1, &camera, &s.map) || !read_stripe_light(call, 3, &s) ||
      !cag_arg_ray_target(call, 0, &s.target))
    return false;
  CagCrossings *lists = cag_hold_array(call, 2, sizeof *lists);
  for (int k = 0; k < 2; k++) cag_hold_for(call, release_crossings, &lists[k]);
  s.crossings = &lists[0];
  s.work = &lists[1];
  s.columns = (size_t)camera.size[0];
  const size_t rows = (size_t)camera.size[1];
  s.image = cag_held_raster(call, s.columns, rows, 1);
  if (!s.image) return false;
  const double middle[2] = {camera.size[0] / 2.0, camera.size[1] / 2.0};
  CagVec3 sight;
  cag_camera_sight(&s.map, middle, &s.eye, &sight);
  find_profile_axes(&s);
  CagValue *points = cag_hold_array(call, rows, sizeof *points);
  CagValue *profile = cag_hold_array(call, rows, sizeof *profile);
  for (size_t y = 0; y < rows; y++) {
    LitPoint best;
    bool any;
    if (!cag_geometry_ok(call, see_row(&s, y, &best, &any, call->err))) return false;
    points[y] = any ? cag_point(call->vm, best.at, 3) : cag_none();
    profile[y] = any ? profile_sample(call->vm, &s, best.at) : cag_none();
  }
  const CagValue values[] = {cag_list_values(call->vm, points, rows),
                             cag_list_values(call->vm, profile, rows),
                             cag_image_result(call, s.image)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// --- Brightness ---

// Luminance of linear light with the primaries of sRGB (ITU-R BT.709, section 3.2).
#define LUMINANCE_RED 0.2126
#define LUMINANCE_GREEN 0.7152
#define LUMINANCE_BLUE 0.0722
// The part of a spot light's cone, as a fraction of its angle, in which it has full strength.
#define SPOT_FULL 0.8

typedef struct Glow Glow;
struct Glow {
  const CagVm *vm;
  const CagTarget *target;
  CagCameraMap map;
  const CagLight *lights;
  size_t light_count, grid; // grid x grid rays for each pixel
  CagRaster *image;
  CagStatus status;
  CagError *err; // of the calling thread
};

static double luminance(CagColor c) {
  return LUMINANCE_RED * c.r + LUMINANCE_GREEN * c.g + LUMINANCE_BLUE * c.b;
}

static double color_luminance(const CagRecord *r, const char *name, CagColor fallback) {
  const CagVec3 none = {fallback.r, fallback.g, fallback.b};
  const CagVec3 c = r ? cag_point_field(r, name, none) : none;
  return luminance((CagColor){c.x, c.y, c.z});
}

// The fraction of a spot light's strength in a direction, as POV-Ray computes it.
static double spot_fraction(const CagLight *l, CagVec3 beam) {
  if (l->kind != CAG_LIGHT_SPOT) return 1;
  const double outer = cos(l->angle / 2), inner = cos(SPOT_FULL * l->angle / 2);
  const double t = (cag_dot(beam, l->direction) - outer) / (inner - outer);
  return t <= 0 ? 0 : t >= 1 ? 1 : t * t * (3 - 2 * t);
}

// The light that reaches a point from one point of a light, times the cosine of its angle.
static CagStatus irradiance_from(const Glow *g, const CagLight *l, CagVec3 source, CagVec3 at,
                                 CagVec3 normal, CagCrossings *work, double *sum, CagError *err) {
  const bool sun = l->kind == CAG_LIGHT_SUN;
  const CagVec3 beam = sun ? l->direction : cag_unit(cag_sub(at, source));
  const double strength = luminance(l->color) * l->strength * spot_fraction(l, beam);
  const double cosine = -cag_dot(beam, normal);
  if (!(cosine > 0) || strength == 0) return CAG_OK;
  const double skipped = cag_target_skipped(g->target, at);
  const double far = sun ? INFINITY : cag_norm(cag_sub(at, source)) - skipped;
  const CagRay ray = {at, cag_scaled(beam, -1), skipped, far};
  CagTargetHit hit;
  bool met = false;
  CagStatus status = CAG_OK;
  if (far > skipped) status = cag_target_first(g->target, &ray, work, &hit, &met, err);
  if (!met) *sum += strength * cosine;
  return status;
}

// An area light is a square, whose points are on a grid.
static CagStatus irradiance_of(const Glow *g, const CagLight *l, CagVec3 at, CagVec3 normal,
                               CagCrossings *work, double *sum, CagError *err) {
  if (l->kind != CAG_LIGHT_AREA || g->grid == 1)
    return irradiance_from(g, l, l->position, at, normal, work, sum, err);
  const CagVec3 other = fabs(l->direction.z) < 0.9 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  const CagVec3 a = cag_unit(cag_cross(l->direction, other)), b = cag_cross(l->direction, a);
  const double n = (double)g->grid;
  double all = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < g->grid * g->grid; i++) {
    const double s = ((double)(i % g->grid) + 0.5) / n - 0.5;
    const double t = ((double)(i / g->grid) + 0.5) / n - 0.5;
    const CagVec3 source = cag_madd(cag_madd(l->position, s * l->size, a), t * l->size, b);
    status = irradiance_from(g, l, source, at, normal, work, &all, err);
  }
  *sum += all / (n * n);
  return status;
}

// The brightness that a ray meets.
static CagStatus brightness_along(const Glow *g, const CagRay *ray, CagCrossings *work, double *out,
                                  CagError *err) {
  CagTargetHit hit;
  bool met;
  CagStatus status = cag_stop_check(err);
  if (!status) status = cag_target_first(g->target, ray, work, &hit, &met, err);
  *out = 0;
  if (status || !met) return status;
  const CagValue v = cag_target_material(g->vm, g->target, &hit);
  const CagRecord *m = v.type == CAG_RECORD ? CAG_AS_RECORD(v) : NULL;
  const double color = color_luminance(m, "color", cag_material_default().color);
  const double reflectivity = cag_number_field(m, "reflectivity", color);
  const CagVec3 at = cag_ray_point(ray, hit.at.t);
  const bool front = cag_dot(hit.at.normal, ray->direction) <= 0;
  const CagVec3 normal = front ? hit.at.normal : cag_scaled(hit.at.normal, -1);
  double light = 0;
  for (size_t i = 0; !status && reflectivity > 0 && i < g->light_count; i++)
    status = irradiance_of(g, &g->lights[i], at, normal, work, &light, err);
  *out = reflectivity * light + color_luminance(m, "emission", (CagColor){0, 0, 0});
  return status;
}

static CagStatus glow_row(const Glow *g, size_t y, CagCrossings *work, CagError *err) {
  const double n = (double)g->grid;
  CagStatus status = CAG_OK;
  for (size_t x = 0; !status && x < g->image->width; x++) {
    double sum = 0, one = 0;
    for (size_t i = 0; !status && i < g->grid * g->grid; i++) {
      const double pixel[2] = {(double)x + ((double)(i % g->grid) + 0.5) / n,
                               (double)y + ((double)(i / g->grid) + 0.5) / n};
      CagRay ray = {.least = 0, .most = INFINITY};
      cag_camera_sight(&g->map, pixel, &ray.origin, &ray.direction);
      status = brightness_along(g, &ray, work, &one, err);
      sum += one;
    }
    *cag_raster_at(g->image, 0, x, y) = sum / (n * n);
  }
  return status;
}

// One row of pixels, by any thread.
static bool glow_numbered_row(void *context, size_t y, int thread) {
  Glow *g = context;
  CagError own;
  CagCrossings work = {0};
  CagError *err = thread == 0 ? g->err : &own;
  const CagStatus status = glow_row(g, y, &work, err);
  cag_crossings_free(&work);
  if (thread == 0 && status) g->status = status;
  return !status;
}

// Collects the lights of a value, at any depth. Other values are skipped, or, if `only_lights` is
// set, an error.
static bool collect_lights(CagCall *call, CagValue v, bool only_lights, CagBuilder *into) {
  if (v.type == CAG_LIGHT) return cag_builder_add(call->vm, into, v);
  if (v.type != CAG_LIST)
    return !only_lights || cag_fail_type(call, 2, "a light or a list of them");
  if (!cag_may_go_deeper(call->vm, "collected")) return false;
  const CagList *list = CAG_AS_LIST(v);
  for (size_t i = 0; i < list->length; i++)
    if (!collect_lights(call, cag_list_get(call->vm, list, i), only_lights, into)) return false;
  return true;
}

static bool read_lights(CagCall *call, const CagLight **out, size_t *n) {
  const bool given = cag_given(call, 2);
  CagBuilder *found = cag_builder_new(call->vm);
  if (!collect_lights(call, call->values[given ? 2 : 0], given, found)) return false;
  const CagList *list = CAG_AS_LIST(cag_builder_finish(call->vm, found));
  CagLight *lights = cag_hold_array(call, list->length, sizeof *lights);
  for (size_t i = 0; i < list->length; i++)
    lights[i] = cag_light_of_value(CAG_AS_SCENE(cag_list_get(call->vm, list, i)));
  *out = lights;
  *n = list->length;
  return true;
}

bool cag_sensors_light_image(CagCall *call, const struct cag_sensors_light_image *a,
                             CagValue *result) {
  Glow g = {.vm = call->vm, .grid = (size_t)ceil(sqrt((double)a->samples)), .err = call->err};
  CagCamera camera;
  if (!read_camera(call, 1, &camera, &g.map) || !read_lights(call, &g.lights, &g.light_count) ||
      !cag_arg_ray_target(call, 0, &g.target))
    return false;
  g.image = cag_held_raster(call, (size_t)camera.size[0], (size_t)camera.size[1], 1);
  if (!g.image) return false;
  if (!cag_parallel_checked(g.image->height, glow_numbered_row, &g))
    return cag_geometry_ok(call, g.status ? g.status : cag_stop_check(call->err));
  *result = cag_image_result(call, g.image);
  return true;
}
