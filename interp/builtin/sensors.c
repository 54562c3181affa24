// Range finders, proximity sensors, switches, and tactile sensors.

#include <math.h>

#include "interp/builtin/images.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

static CagVec3 frame_column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static void release_crossings(void *list) { cag_crossings_free(list); }

static CagCrossings *held_crossings(CagCall *call) {
  CagCrossings *work = cag_hold_array(call, 1, sizeof *work);
  cag_hold_for(call, release_crossings, work);
  return work;
}

// --- Range finders ---

typedef struct Scanner {
  const CagTarget *target;
  CagTransform pose;
  double max;
  bool triangulates;
  CagVec3 detector;
  CagCrossings *work;
} Scanner;

static bool range_at(CagCall *call, const Scanner *s, double degrees, double *out) {
  double sine, cosine;
  cag_sincos_degrees(degrees, &sine, &cosine);
  const CagVec3 origin = frame_column(&s->pose, 3);
  const CagVec3 direction =
      cag_madd(cag_scaled(frame_column(&s->pose, 0), cosine), sine, frame_column(&s->pose, 1));
  const CagRay ray = {origin, cag_unit(direction), cag_target_skipped(s->target, origin), s->max};
  CagTargetHit hit;
  bool met, free = true;
  *out = NAN;
  CagStatus status = cag_target_first(s->target, &ray, s->work, &hit, &met, call->err);
  if (!status && met && s->triangulates)
    status = cag_target_sees(s->target, s->detector, cag_ray_point(&ray, hit.at.t), s->work, &free,
                             call->err);
  if (!status && met && free) *out = hit.at.t;
  return cag_geometry_ok(call, status);
}

bool cag_sensors_range_scan(CagCall *call, const struct cag_sensors_range_scan *a,
                            CagValue *result) {
  Scanner s = {.max = a->max, .triangulates = cag_given(call, 4), .work = held_crossings(call)};
  CagList *angles;
  if (!cag_arg_list(call, 2, &angles) || !cag_arg_pose(call, 1, &s.pose) ||
      (s.triangulates && !cag_arg_vec(call, 4, &s.detector, NULL)) ||
      !cag_arg_ray_target(call, 0, &s.target))
    return false;
  CagValue *ranges = cag_hold_array(call, angles->length, sizeof *ranges);
  for (size_t i = 0; i < angles->length; i++) {
    const CagValue v = cag_list_get(call->vm, angles, i);
    double range;
    if (v.type != CAG_ANGLE || !isfinite(v.as.number))
      return cag_fail_element(call, 2, i, v, "finite angles");
    if ((i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) ||
        !range_at(call, &s, v.as.number, &range))
      return false;
    ranges[i] = isnan(range) ? cag_none() : cag_number(range);
  }
  *result = cag_list_values(call->vm, ranges, angles->length);
  return true;
}

// --- Proximity sensors and switches ---

// The distance of what touches is at most this fraction of the size: the rounding of a touch.
#define TOUCH 1e-9

bool cag_sensors_proximity(CagCall *call, const struct cag_sensors_proximity *a, CagValue *result) {
  static const char *const names[] = {"detected", "distance", "part"};
  const CagTarget *t;
  CagTargetNearest near;
  if (!cag_arg_ray_target(call, 0, &t) || !cag_target_closest(call, t, a->P.at, INFINITY, &near))
    return false;
  const bool far = near.distance > a->range + a->hysteresis;
  const CagValue values[] = {near.distance <= a->range ? cag_bool(true)
                             : far || !near.found      ? cag_bool(false)
                                                       : cag_none(),
                             near.found ? cag_number(near.distance) : cag_none(),
                             near.found ? cag_target_name(t, near.part) : cag_none()};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_sensors_contact_at(CagCall *call, const struct cag_sensors_contact_at *a,
                            CagValue *result) {
  const CagTarget *t;
  CagTargetNearest near;
  if (!cag_arg_ray_target(call, 0, &t)) return false;
  const double reach = a->radius + TOUCH * (t->size + a->radius);
  if (!cag_target_closest(call, t, a->P.at, reach, &near)) return false;
  *result = cag_bool(near.found);
  return true;
}

// --- Tactile sensors ---

typedef struct Pad {
  const CagTarget *target;
  CagVec3 origin, x, y, normal; // steps of one taxel along x and y, and the unit normal
  size_t columns, rows;
  double indentation;
  CagCrossings *work;
} Pad;

// Reduces the gap of a taxel at p to one part. Where p is inside of a body, the gap is the depth at
// which its surface lies behind the pad, with a negative sign.
static CagStatus gap_to_part(const Pad *pad, const CagCaster *part, CagVec3 p, double skipped,
                             double *gap, CagError *err) {
  bool inside = false, met;
  CagCrossing at;
  const CagRay ahead = {p, pad->normal, -skipped, *gap};
  CagStatus status = cag_caster_first(part, &ahead, pad->work, &at, &met, err);
  if (status) return status;
  if (met) *gap = at.t;
  if (!cag_caster_is_closed(part) || (met && at.sign < 0)) return CAG_OK;
  const CagRay behind = {p, cag_scaled(pad->normal, -1), 0, INFINITY};
  status = cag_caster_all(part, &behind, pad->work, &inside, err);
  if (status || !inside || pad->work->n == 0) return status;
  *gap = fmin(*gap, -pad->work->items[0].t);
  return CAG_OK;
}

static CagStatus press_taxel(const Pad *pad, CagVec3 p, double *depth, CagError *err) {
  const double skipped = cag_target_skipped(pad->target, p);
  double gap = pad->indentation;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < pad->target->count; i++)
    status = gap_to_part(pad, pad->target->parts[i].caster, p, skipped, &gap, err);
  *depth = fmax(0, pad->indentation - gap);
  return status;
}

typedef struct Pressure {
  double total, x, y; // moments of the force
} Pressure;

static bool press_pad(CagCall *call, const Pad *pad, double pitch, double stiffness,
                      CagRaster *images[3], Pressure *sum) {
  *sum = (Pressure){0};
  for (size_t row = 0; row < pad->rows; row++) {
    if (!cag_keep_going(call->vm)) return false;
    const double y = (double)pad->rows / 2 - (double)row - 0.5;
    for (size_t column = 0; column < pad->columns; column++) {
      const double x = (double)column + 0.5 - (double)pad->columns / 2;
      const CagVec3 p = cag_madd(cag_madd(pad->origin, x, pad->x), y, pad->y);
      double depth;
      if (!cag_geometry_ok(call, press_taxel(pad, p, &depth, call->err))) return false;
      const double force = depth * stiffness;
      *cag_raster_at(images[0], 0, column, row) = depth;
      *cag_raster_at(images[1], 0, column, row) = depth > 0;
      *cag_raster_at(images[2], 0, column, row) = force;
      sum->total += force;
      sum->x += force * x * pitch;
      sum->y += force * y * pitch;
    }
  }
  return true;
}

bool cag_sensors_tactile(CagCall *call, const struct cag_sensors_tactile *a, CagValue *result) {
  static const char *const names[] = {"depth", "contact", "force", "total", "center"};
  CagTransform pose;
  Pressure sum;
  CagRaster *images[3];
  Pad pad = {.columns = (size_t)a->columns,
             .rows = (size_t)a->rows,
             .indentation = a->indentation,
             .work = held_crossings(call)};
  if (!cag_arg_pose(call, 1, &pose) || !cag_arg_ray_target(call, 0, &pad.target)) return false;
  if (!isfinite(a->indentation)) return cag_fail_value(call, 5, "a finite number");
  pad.origin = frame_column(&pose, 3);
  pad.x = cag_scaled(frame_column(&pose, 0), a->pitch);
  pad.y = cag_scaled(frame_column(&pose, 1), a->pitch);
  pad.normal = cag_unit(frame_column(&pose, 2));
  for (int k = 0; k < 3; k++) {
    images[k] = cag_held_raster(call, pad.columns, pad.rows, 1);
    if (!images[k]) return false;
  }
  if (!press_pad(call, &pad, a->pitch, a->stiffness, images, &sum)) return false;
  if (!isfinite(sum.total) || !isfinite(sum.x) || !isfinite(sum.y))
    return cag_fail_call(call, -1, CAG_ERR_not_finite, "overflows: the forces are too large");
  CagVm *vm = call->vm;
  const double center[] = {sum.x / sum.total, sum.y / sum.total};
  const CagValue values[] = {cag_image_result(call, images[0]), cag_image_result(call, images[1]),
                             cag_image_result(call, images[2]), cag_number(sum.total),
                             sum.total > 0 ? cag_vector(vm, center, 2) : cag_none()};
  *result = cag_record_new(vm, names, values, 5);
  return true;
}
