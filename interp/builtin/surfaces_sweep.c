// Surfaces and solids swept by a section along a path or under transforms, and lofts.

#include "geom/surface/loft.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"
#include "interp/vm/vm.h"

// The relative tolerance of the series that approximate functions of the path's parameter.
#define FIT_TOLERANCE 1e-12

// --- Functions of the script as series ---

typedef struct Sampled {
  CagCall *call;
  int argument;
  bool angular; // the parameter is an angle
  bool angles;  // the values are angles
} Sampled;

typedef struct Question {
  const Sampled *sampled;
  double t;
  CagValue answer;
} Question;

static bool call_sampled(CagVm *vm, void *question) {
  Question *q = question;
  const Sampled *s = q->sampled;
  CagValue at = cag_parameter_value(s->angular, q->t);
  return cag_call(vm, s->call->values[s->argument], &at, 1, &q->answer) && cag_keep_going(vm);
}

// Calls the function, which must return a value of the type `wanted`. Running out of memory in the
// script must not jump past the fit.
static CagStatus call_at(const Sampled *s, double t, CagType wanted, const char *values,
                         CagValue *out, CagError *err) {
  Question q = {s, t, cag_none()};
  bool good = cag_vm_call_back(s->call->vm, call_sampled, &q);
  if (good && q.answer.type != wanted)
    good = cag_fail_call(s->call, s->argument, CAG_ERR_type,
                         "expects a function that returns %s, found one that returned %s", values,
                         cag_type_article(q.answer));
  *out = q.answer;
  return good ? CAG_OK
              : cag_fail(err, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1,
                         "the function failed");
}

static CagStatus sample_number(void *context, double t, double *out, CagError *err) {
  const Sampled *s = context;
  CagValue v;
  CagStatus status = s->angles ? call_at(s, t, CAG_ANGLE, "angles", &v, err)
                               : call_at(s, t, CAG_NUMBER, "numbers", &v, err);
  if (!status) *out = s->angles ? v.as.number * CAG_RADIANS_PER_DEGREE : v.as.number;
  return status;
}

static CagStatus sample_rows(void *context, double t, double *out, CagError *err) {
  CagValue v;
  CagStatus status = call_at(context, t, CAG_TRANSFORM, "transforms", &v, err);
  if (status) return status;
  const CagTransform *m = &CAG_AS_TRANSFORM(v)->t;
  if (!cag_transform_is_affine(m))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_affine, "map", -1,
                    "`map` must return affine transforms, found a projection");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) out[4 * i + j] = m->m[i][j] / m->m[3][3];
  return CAG_OK;
}

static void release_series(void *series) { cag_chebyshev_release(series); }

// Reads a function of the path's parameter, or a number or angle that is reached at the end of the
// path.
static bool read_along(CagCall *call, int argument, const CagCurve *path, bool angles, double from,
                       CagAlong *out) {
  CagValue v = call->values[argument];
  CagChebyshev *fit = NULL;
  *out = (CagAlong){from, from, NULL};
  if (v.type == CAG_UNSET) return true;
  if (!cag_is_function(v)) {
    if (v.type != (angles ? CAG_ANGLE : CAG_NUMBER))
      return cag_fail_type(call, argument,
                           angles ? "an angle or a function" : "a number or a function");
    return angles ? cag_arg_angle(call, argument, &out->end)
                  : cag_arg_finite(call, argument, &out->end);
  }
  Sampled s = {call, argument, path->angular, angles};
  CagStatus status = cag_chebyshev_fit(sample_number, &s, path->start, path->end, 1, FIT_TOLERANCE,
                                       cag_parameter_name(call, argument), &fit, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_series, fit);
  out->function = fit;
  return true;
}

// --- Sections ---

// The section to sweep: a curve for a surface, or a region for a solid. A region in space is used
// in its own coordinates.
typedef struct Section {
  const CagCurve *curve; // borrowed
  CagRegion *region;     // held
} Section;

static bool read_section(CagCall *call, bool caps, Section *out) {
  CagValue v = call->values[0];
  *out = (Section){0};
  if (v.type == CAG_CURVE) {
    const CagCurve *c = CAG_AS_SHAPE(v)->as.curve;
    if (!c->closed || c->dimension == 3 || !caps) {
      out->curve = c;
      return true;
    }
  }
  CagTransform place;
  if (!cag_arg_region(call, 0, &out->region, &place)) return false;
  cag_hold_region(call, out->region);
  return true;
}

static bool sweep_sides(CagCall *call, const Section *section, const CagMotion *motion,
                        CagValue *result) {
  size_t n = section->curve ? 1 : section->region->count;
  CagBuilder *sides = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    CagSurface *s = NULL;
    CagValue side;
    const CagCurve *c = section->curve ? section->curve : section->region->loops[i];
    CagStatus status = cag_surface_sweep(c, motion, &s, call->err);
    if (!cag_surface_result(call, status, &s, &side) || !cag_builder_add(call->vm, sides, side))
      return false;
  }
  return cag_shapes_result(call, sides, result);
}

static void release_motion(void *motion) { cag_motion_release(motion); }

// Sweeps the section, and takes ownership of the motion.
static bool sweep_section(CagCall *call, const Section *section, CagMotion *motion, bool caps,
                          CagValue *result) {
  CagSolid *s = NULL;
  cag_hold_for(call, release_motion, motion);
  const bool ok =
      section->curve || !caps
          ? sweep_sides(call, section, motion, result)
          : cag_solid_result(call, cag_solid_sweep(section->region, motion, &s, call->err), &s,
                             result);
  if (ok && cag_is_shape(call->values[0])) cag_shape_say_alike(*result, call->values[0]);
  return ok;
}

// --- Sweeps ---

bool cag_arg_orient(CagCall *call, int argument, CagPathMotion *how) {
  static const char *const names[] = {"rmf", "frenet", "fixed", NULL};
  static const CagOrient orients[] = {CAG_ORIENT_RMF, CAG_ORIENT_FRENET, CAG_ORIENT_FIXED};
  const CagValue v = call->values[argument];
  int choice;
  if (v.type == CAG_LIST) {
    how->orient = CAG_ORIENT_UP;
    return cag_arg_direction(call, argument, cag_vec3(0, 0, 1), &how->up, NULL);
  }
  if (v.type != CAG_UNSET && v.type != CAG_TEXT)
    return cag_fail_type(call, argument, "\"rmf\", \"frenet\", \"fixed\", or a direction");
  if (!cag_arg_choice(call, argument, names, &choice)) return false;
  how->orient = orients[choice];
  return true;
}

bool cag_surfaces_sweep(CagCall *call, const struct cag_surfaces_sweep *a, CagValue *result) {
  CagPathMotion how = {0};
  CagMotion *motion = NULL;
  Section section = {0};
  return cag_arg_orient(call, 2, &how) && read_section(call, a->caps, &section) &&
         read_along(call, 3, a->path, true, 0, &how.twist) &&
         read_along(call, 4, a->path, false, 1, &how.scale) &&
         cag_geometry_ok(call, cag_motion_along(a->path, &how, &motion, call->err)) &&
         sweep_section(call, &section, motion, a->caps, result);
}

bool cag_surfaces_sweep_by(CagCall *call, const struct cag_surfaces_sweep_by *a, CagValue *result) {
  CagChebyshev *rows = NULL;
  CagMotion *motion = NULL;
  Section section = {0};
  const bool angle = a->range.angle;
  const double unit = angle ? CAG_RADIANS_PER_DEGREE : 1;
  const double from = a->range.start * unit, to = a->range.end * unit;
  if (!(from < to) || !isfinite(from) || !isfinite(to))
    return cag_fail_call(call, 2, CAG_ERR_value, "expects a range that ends after its start");
  Sampled s = {call, 1, angle, false};
  if (!read_section(call, a->caps, &section)) return false;
  CagStatus status =
      cag_chebyshev_fit(sample_rows, &s, from, to, 12, FIT_TOLERANCE, "map", &rows, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_series, rows);
  return cag_geometry_ok(call, cag_motion_affine(rows, from, to, angle, &motion, call->err)) &&
         sweep_section(call, &section, motion, a->caps, result);
}

bool cag_surfaces_tube(CagCall *call, const struct cag_surfaces_tube *a, CagValue *result) {
  CagSurface *s = NULL;
  CagSolid *solid = NULL;
  CagAlong radius = {0};
  const bool changing = cag_is_function(a->radius);
  if (changing ? !read_along(call, 1, a->path, false, 0, &radius)
               : !cag_arg_positive(call, 1, &radius.end))
    return false;
  if (a->caps) {
    CagStatus status = changing ? cag_solid_tube_along(a->path, &radius, &solid, call->err)
                                : cag_solid_tube(a->path, radius.end, &solid, call->err);
    return cag_changed_solid_result(call, status, &solid, result);
  }
  CagStatus status = changing ? cag_surface_tube_along(a->path, &radius, &s, call->err)
                              : cag_surface_tube(a->path, radius.end, &s, call->err);
  return cag_changed_surface_result(call, status, &s, result);
}

// --- Lofts ---

// Returns a curve, or the outline of a region without holes, which is placed and held.
static bool read_loft_curve(CagCall *call, size_t i, CagValue v, const CagCurve **out) {
  if (v.type == CAG_CURVE) {
    *out = CAG_AS_SHAPE(v)->as.curve;
    return true;
  }
  if (v.type != CAG_REGION) return cag_fail_element(call, 0, i, v, "curves or regions");
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (shape->as.region->count != 1)
    return cag_fail_call(
        call, 0, CAG_ERR_value,
        "expects regions with one outline and no holes, found %zu outlines in `curves`[%zu]; loft them one by one",
        shape->as.region->count, i);
  CagCurve *placed = NULL;
  CagStatus status =
      cag_curve_transform(shape->as.region->loops[0], shape->placement, &placed, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_curve(call, placed);
  *out = placed;
  return true;
}

bool cag_surfaces_loft(CagCall *call, const struct cag_surfaces_loft *a, CagValue *result) {
  CagList *list;
  if (!cag_arg_list(call, 0, &list)) return false;
  if (list->length < 2) return cag_fail_value(call, 0, "at least 2 curves");
  const CagCurve **curves = cag_hold_array(call, list->length, sizeof *curves);
  bool all_closed = true;
  for (size_t i = 0; i < list->length; i++) {
    if (!read_loft_curve(call, i, cag_list_get(call->vm, list, i), &curves[i])) return false;
    all_closed = all_closed && (curves[i]->closed || cag_curve_resting_view(curves[i], NULL));
  }
  CagSurface *side = NULL;
  CagSolid *solid = NULL;
  CagStatus status =
      cag_surface_loft(curves, list->length, (int)a->degree, a->closed, &side, call->err);
  if (a->caps && all_closed && !status) {
    status = cag_solid_loft(side, &solid, call->err);
    cag_surface_release(side);
    if (!cag_solid_result(call, status, &solid, result)) return false;
  } else if (!cag_surface_result(call, status, &side, result)) {
    return false;
  }
  cag_shape_say_alike(*result, cag_list_get(call->vm, list, 0));
  return true;
}
