// Images of a scene by one ray for each pixel.

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

// What an image shows of a hit: writes the samples of pixel [x, y].
typedef struct Shot Shot;
typedef void Sampler(const Shot *s, const CagRay *ray, const CagTargetHit *hit, size_t x, size_t y);

struct Shot {
  const CagTarget *target;
  CagCameraMap map;
  CagRaster *raster;
  Sampler *sample;
  double missing; // the samples where nothing is seen
  CagStatus status;
  CagError *err; // of the calling thread
};

// --- Samples ---

static void sample_depth(const Shot *s, const CagRay *ray, const CagTargetHit *hit, size_t x,
                         size_t y) {
  double pixel[2], depth = NAN;
  cag_camera_project(&s->map, cag_ray_point(ray, hit->at.t), pixel, &depth);
  *cag_raster_at(s->raster, 0, x, y) = depth;
}

static void sample_range(const Shot *s, const CagRay *ray, const CagTargetHit *hit, size_t x,
                         size_t y) {
  (void)ray;
  *cag_raster_at(s->raster, 0, x, y) = hit->at.t;
}

static void sample_mask(const Shot *s, const CagRay *ray, const CagTargetHit *hit, size_t x,
                        size_t y) {
  (void)ray;
  (void)hit;
  *cag_raster_at(s->raster, 0, x, y) = 1;
}

static void sample_part(const Shot *s, const CagRay *ray, const CagTargetHit *hit, size_t x,
                        size_t y) {
  (void)ray;
  *cag_raster_at(s->raster, 0, x, y) = (double)s->target->parts[hit->part].number;
}

static void sample_normal(const Shot *s, const CagRay *ray, const CagTargetHit *hit, size_t x,
                          size_t y) {
  (void)ray;
  *cag_raster_at(s->raster, 0, x, y) = hit->at.normal.x;
  *cag_raster_at(s->raster, 1, x, y) = hit->at.normal.y;
  *cag_raster_at(s->raster, 2, x, y) = hit->at.normal.z;
}

static void sample_uv(const Shot *s, const CagRay *ray, const CagTargetHit *hit, size_t x,
                      size_t y) {
  (void)ray;
  const double degrees = 180 / M_PI;
  *cag_raster_at(s->raster, 0, x, y) = hit->at.u * (hit->at.angular[0] ? degrees : 1);
  *cag_raster_at(s->raster, 1, x, y) = hit->at.v * (hit->at.angular[1] ? degrees : 1);
}

// --- Rows ---

static CagStatus shoot_row(const Shot *s, size_t y, CagCrossings *work, CagError *err) {
  CagStatus status = cag_stop_check(err);
  for (size_t x = 0; !status && x < s->raster->width; x++) {
    const double pixel[2] = {(double)x + 0.5, (double)y + 0.5};
    CagRay ray = {.least = 0, .most = INFINITY};
    CagTargetHit hit;
    bool met;
    cag_camera_sight(&s->map, pixel, &ray.origin, &ray.direction);
    status = cag_target_first(s->target, &ray, work, &hit, &met, err);
    if (!status && met) s->sample(s, &ray, &hit, x, y);
    for (size_t c = 0; !status && !met && c < s->raster->channel_count; c++)
      *cag_raster_at(s->raster, c, x, y) = s->missing;
  }
  return status;
}

// One row of pixels, by any thread.
static bool shoot_numbered_row(void *context, size_t y, int thread) {
  Shot *s = context;
  CagError own;
  CagCrossings work = {0};
  CagError *err = thread == 0 ? s->err : &own;
  const CagStatus status = shoot_row(s, y, &work, err);
  cag_crossings_free(&work);
  if (thread == 0 && status) s->status = status;
  return !status;
}

// Makes an image of `channels` channels; argument 0 is the target, and 1 the camera.
static CagRaster *shoot(CagCall *call, Sampler *sample, double missing, const char *const *names,
                        size_t channels) {
  Shot s = {.sample = sample, .missing = missing, .err = call->err};
  if (!cag_arg_ray_target(call, 0, &s.target)) return NULL;
  if (call->values[1].type != CAG_CAMERA) {
    cag_fail_type(call, 1, "a camera");
    return NULL;
  }
  const CagCamera camera = cag_camera_of_value(CAG_AS_SCENE(call->values[1]));
  if (!cag_geometry_ok(call, cag_scene_camera_map(&camera, &s.map, call->err))) return NULL;
  s.raster = cag_held_raster(call, (size_t)camera.size[0], (size_t)camera.size[1], channels);
  if (!s.raster) return NULL;
  for (size_t c = 0; names && c < channels; c++)
    if (!cag_geometry_ok(call, cag_raster_name(s.raster, c, names[c], call->err))) return NULL;
  if (!cag_parallel_checked(s.raster->height, shoot_numbered_row, &s)) {
    cag_geometry_ok(call, s.status ? s.status : cag_stop_check(call->err));
    return NULL;
  }
  return s.raster;
}

static bool image_result(CagCall *call, CagRaster *r, CagValue *result) {
  if (!r) return false;
  *result = cag_image_result(call, r);
  return true;
}

bool cag_rays_depth_image(CagCall *call, const struct cag_rays_depth_image *a, CagValue *result) {
  return image_result(call, shoot(call, a->of ? sample_range : sample_depth, NAN, NULL, 1), result);
}

bool cag_rays_mask_image(CagCall *call, const struct cag_rays_mask_image *a, CagValue *result) {
  (void)a;
  return image_result(call, shoot(call, sample_mask, 0, NULL, 1), result);
}

bool cag_rays_part_image(CagCall *call, const struct cag_rays_part_image *a, CagValue *result) {
  (void)a;
  const CagTarget *t;
  CagRaster *r = shoot(call, sample_part, NAN, NULL, 1);
  if (!r || !cag_arg_ray_target(call, 0, &t)) return false;
  CagValue *names = cag_hold_array(call, t->count, sizeof *names);
  for (size_t i = 0; i < t->count; i++) names[t->parts[i].number] = cag_target_name(t, i);
  const CagValue list = cag_list_values(call->vm, names, t->count);
  *result = cag_image_result(call, r);
  CAG_AS_IMAGE(*result)->parts = CAG_AS_LIST(list);
  return true;
}

bool cag_rays_normal_image(CagCall *call, const struct cag_rays_normal_image *a, CagValue *result) {
  static const char *const names[] = {"x", "y", "z"};
  (void)a;
  return image_result(call, shoot(call, sample_normal, NAN, names, 3), result);
}

bool cag_rays_uv_image(CagCall *call, const struct cag_rays_uv_image *a, CagValue *result) {
  static const char *const names[] = {"u", "v"};
  (void)a;
  return image_result(call, shoot(call, sample_uv, NAN, names, 2), result);
}
