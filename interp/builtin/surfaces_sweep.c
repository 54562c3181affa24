// Surfaces and solids that a section sweeps along a path or under transforms, and lofts.

#include "geom/surface/loft.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"
#include "interp/vm/vm.h"

// Functions of the path's parameter are kept as series to this part of their size.
#define FIT_TOLERANCE 1e-12

// --- Functions of the script as series ---

typedef struct Sampled {
  CagCall *call;
  int argument;
  bool angular; // the parameter is an angle
  bool angles;  // the values are angles
} Sampled;

static CagStatus stopped(CagError *err) {
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "the function failed");
}

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

// Running out of memory in the script must not leave the fit by a jump.
static CagStatus call_at(const Sampled *s, double t, CagValue *out, CagError *err) {
  Question q = {s, t, cag_none()};
  if (!cag_vm_call_back(s->call->vm, call_sampled, &q)) return stopped(err);
  *out = q.answer;
  return CAG_OK;
}

static CagStatus sample_number(void *context, double t, double *out, CagError *err) {
  const Sampled *s = context;
  CagValue v;
  CagStatus status = call_at(s, t, &v, err);
  if (status) return status;
  if (v.type != (s->angles ? CAG_ANGLE : CAG_NUMBER)) {
    cag_fail_call(s->call, s->argument, CAG_ERR_type,
                  "expects a function that gives %s, it gave %s", s->angles ? "angles" : "numbers",
                  cag_type_article(v));
    return stopped(err);
  }
  *out = s->angles ? v.as.number * CAG_RADIANS_PER_DEGREE : v.as.number;
  return CAG_OK;
}

static CagStatus sample_rows(void *context, double t, double *out, CagError *err) {
  const Sampled *s = context;
  CagValue v;
  CagStatus status = call_at(s, t, &v, err);
  if (status) return status;
  if (v.type != CAG_TRANSFORM) {
    cag_fail_call(s->call, s->argument, CAG_ERR_type,
                  "expects a function that gives transforms, it gave %s", cag_type_article(v));
    return stopped(err);
  }
  const CagTransform *m = &CAG_AS_TRANSFORM(v)->t;
  if (!cag_transform_is_affine(m))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_affine, "map", -1,
                    "`map` must give affine transforms: a projection has no sweep");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) out[4 * i + j] = m->m[i][j] / m->m[3][3];
  return CAG_OK;
}

static void release_series(void *series) { cag_chebyshev_release(series); }

// Reads a number or angle that is reached at the end of the path, or a function of its parameter.
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
  const char *name = cag_builtin_signature_of(call->builtin)->parameters[argument];
  CagStatus status = cag_chebyshev_fit(sample_number, &s, path->start, path->end, 1, FIT_TOLERANCE,
                                       name, &fit, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_series, fit);
  out->function = fit;
  return true;
}

// --- Results ---

// --- Sections ---

// What is swept: a curve for a surface, else a region of the plane. A region that stands in space
// keeps its own coordinates.
typedef struct Section {
  const CagCurve *curve; // borrowed
  CagRegion *region;     // held
} Section;

static void release_region(void *region) { cag_region_release(region); }

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
  cag_hold_for(call, release_region, out->region);
  return true;
}

static bool sweep_sides(CagCall *call, const Section *section, const CagMotion *motion,
                        CagValue *result) {
  size_t n = section->curve ? 1 : section->region->count;
  CagBuilder *sides = cag_builder_new(call->vm);
  CagValue side = cag_none();
  for (size_t i = 0; i < n; i++) {
    CagSurface *s = NULL;
    const CagCurve *c = section->curve ? section->curve : section->region->loops[i];
    CagStatus status = cag_surface_sweep(c, motion, &s, call->err);
    if (!cag_surface_result(call, status, &s, &side) || !cag_builder_add(call->vm, sides, side))
      return false;
  }
  *result = n == 1 ? side : cag_group_value(call->vm, cag_builder_finish(call->vm, sides));
  return true;
}

static bool sweep_section(CagCall *call, const Section *section, const CagMotion *motion, bool caps,
                          CagValue *result) {
  if (section->curve || !caps) return sweep_sides(call, section, motion, result);
  CagSolid *s = NULL;
  return cag_solid_result(call, cag_solid_sweep(section->region, motion, &s, call->err), &s,
                          result);
}

// --- Sweeps ---

static bool read_orient(CagCall *call, int argument, CagPathMotion *how) {
  static const char *const names[] = {"rmf", "frenet", "fixed", NULL};
  static const CagOrient orients[] = {CAG_ORIENT_RMF, CAG_ORIENT_FRENET, CAG_ORIENT_FIXED};
  CagValue v = call->values[argument];
  int choice;
  if (v.type == CAG_LIST) {
    how->orient = CAG_ORIENT_UP;
    return cag_arg_direction(call, argument, cag_vec3(0, 0, 1), &how->up, NULL);
  }
  if (v.type != CAG_UNSET && v.type != CAG_TEXT)
    return cag_fail_type(call, argument, "\"rmf\", \"frenet\", \"fixed\" or a direction");
  if (!cag_arg_choice(call, argument, names, &choice)) return false;
  how->orient = orients[choice];
  return true;
}

static void release_motion(void *motion) { cag_motion_release(motion); }

bool cag_surfaces_sweep(CagCall *call, CagValue *result) {
  CagCurve *path;
  CagPathMotion how = {0};
  CagMotion *motion = NULL;
  Section section = {0};
  bool caps;
  if (!cag_arg_curve(call, 1, &path) || !read_orient(call, 2, &how) ||
      !cag_arg_bool_or(call, 5, true, &caps) || !read_section(call, caps, &section) ||
      !read_along(call, 3, path, true, 0, &how.twist) ||
      !read_along(call, 4, path, false, 1, &how.scale) ||
      !cag_geometry_ok(call, cag_motion_along(path, &how, &motion, call->err)))
    return false;
  cag_hold_for(call, release_motion, motion);
  if (!sweep_section(call, &section, motion, caps, result)) return false;
  if (cag_is_shape(call->values[0])) cag_shape_say_alike(*result, call->values[0]);
  return true;
}

bool cag_surfaces_sweep_by(CagCall *call, CagValue *result) {
  CagValue map;
  CagChebyshev *rows = NULL;
  CagMotion *motion = NULL;
  Section section = {0};
  bool caps, angle;
  double from, to;
  if (!cag_arg_function(call, 1, &map) || !cag_arg_interval(call, 2, &from, &to, &angle) ||
      !cag_arg_bool_or(call, 3, true, &caps))
    return false;
  if (!(from < to) || !isfinite(from) || !isfinite(to))
    return cag_fail_call(call, 2, CAG_ERR_value, "expects a range that ends after its start");
  double unit = angle ? CAG_RADIANS_PER_DEGREE : 1;
  Sampled s = {call, 1, angle, false};
  if (!read_section(call, caps, &section)) return false;
  CagStatus status = cag_chebyshev_fit(sample_rows, &s, from * unit, to * unit, 12, FIT_TOLERANCE,
                                       "map", &rows, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_series, rows);
  status = cag_motion_affine(rows, from * unit, to * unit, angle, &motion, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_motion, motion);
  if (!sweep_section(call, &section, motion, caps, result)) return false;
  if (cag_is_shape(call->values[0])) cag_shape_say_alike(*result, call->values[0]);
  return true;
}

bool cag_surfaces_tube(CagCall *call, CagValue *result) {
  CagCurve *path;
  CagSurface *s = NULL;
  CagSolid *solid = NULL;
  CagAlong radius = {0};
  bool caps;
  bool changing = cag_is_function(call->values[1]);
  if (!cag_arg_curve(call, 0, &path) || !cag_arg_bool_or(call, 2, true, &caps) ||
      (!changing && !cag_arg_positive(call, 1, &radius.end)))
    return false;
  if (changing && !read_along(call, 1, path, false, 0, &radius)) return false;
  if (caps) {
    CagStatus status = changing ? cag_solid_tube_along(path, &radius, &solid, call->err)
                                : cag_solid_tube(path, radius.end, &solid, call->err);
    if (!cag_solid_result(call, status, &solid, result)) return false;
  } else {
    CagStatus status = changing ? cag_surface_tube_along(path, &radius, &s, call->err)
                                : cag_surface_tube(path, radius.end, &s, call->err);
    if (!cag_surface_result(call, status, &s, result)) return false;
  }
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}

// --- Lofts ---

static void release_curve(void *curve) { cag_curve_release(curve); }

// A curve as it is, or the outline of a region without holes, placed and held.
static bool read_loft_curve(CagCall *call, size_t i, CagValue v, const CagCurve **out) {
  if (v.type == CAG_CURVE) {
    *out = CAG_AS_SHAPE(v)->as.curve;
    return true;
  }
  if (v.type != CAG_REGION) return cag_fail_element(call, 0, i, v, "curves or regions");
  const CagShape *shape = CAG_AS_SHAPE(v);
  if (shape->as.region->count != 1)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects regions of one outline without holes, found %zu outlines in "
                         "`curves`[%zu]; loft them one by one",
                         shape->as.region->count, i);
  CagCurve *placed = NULL;
  CagStatus status =
      cag_curve_transform(shape->as.region->loops[0], &shape->placement, &placed, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_curve, placed);
  *out = placed;
  return true;
}

bool cag_surfaces_loft(CagCall *call, CagValue *result) {
  CagList *list;
  long degree;
  bool closed, caps;
  if (!cag_arg_list(call, 0, &list) || !cag_arg_integer_or(call, 1, 3, 1, 25, &degree) ||
      !cag_arg_bool_or(call, 2, false, &closed) || !cag_arg_bool_or(call, 3, true, &caps))
    return false;
  if (list->length < 2) return cag_fail_value(call, 0, "at least 2 curves");
  const CagCurve **curves = cag_hold_array(call, list->length, sizeof *curves);
  bool all_closed = true;
  for (size_t i = 0; i < list->length; i++) {
    if (!read_loft_curve(call, i, cag_list_get(call->vm, list, i), &curves[i])) return false;
    all_closed = all_closed && (curves[i]->closed || cag_curve_resting_view(curves[i], NULL));
  }
  CagSurface *side = NULL;
  CagSolid *solid = NULL;
  CagStatus status = cag_surface_loft(curves, list->length, (int)degree, closed, &side, call->err);
  if (caps && all_closed && status == CAG_OK) {
    status = cag_solid_loft(side, &solid, call->err);
    cag_surface_release(side);
    if (!cag_solid_result(call, status, &solid, result)) return false;
  } else if (!cag_surface_result(call, status, &side, result)) {
    return false;
  }
  cag_shape_say_alike(*result, cag_list_get(call->vm, list, 0));
  return true;
}
