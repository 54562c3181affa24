// Surfaces and solids from curves and regions: revolved, extruded, ruled, and swept along a path.

#include <stdlib.h>

#include "geom/solid/csg.h"
#include "geom/solid/rounded.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

#define FULL_TURN 6.283185307179586 // 2 pi

// --- Revolution ---

// [x, y] -> [x, 0, y]
static CagTransform upright(void) {
  CagTransform t = {.m = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
  return t;
}

// The axis lies in the profile's plane if the sine of their angle, and its distance relative to
// that of the profile, are below this. Rounding errors of frames are well below.
#define AXIS_IN_PLANE 1e-9

// The map from the region's own coordinates to (distance from the axis, height along it).
static CagTransform half_plane(const CagTransform *place, CagVec3 radial, CagVec3 axis,
                               CagVec3 through) {
  CagTransform t = cag_transform_identity();
  const CagVec3 rows[] = {radial, axis};
  for (int i = 0; i < 2; i++) {
    CagVec3 r = rows[i];
    for (int j = 0; j < 4; j++)
      t.m[i][j] = r.x * place->m[0][j] + r.y * place->m[1][j] + r.z * place->m[2][j];
    t.m[i][2] = 0;
    t.m[i][3] -= cag_dot(r, through);
  }
  return t;
}

// Revolves the region about an axis in its plane. Converts its coordinates to distance from and
// height along the axis, revolves that about Z, and moves Z to the axis.
bool cag_region_revolved(CagCall *call, const CagRegion *region, const CagTransform *place,
                         CagVec3 axis, CagVec3 through, double from, double to, CagValue *result) {
  CagVec3 centroid;
  double area;
  if (cag_region_is_empty(region)) {
    CagSolid *nothing = NULL;
    const CagStatus made = cag_solid_empty(&nothing, call->err);
    return cag_solid_result(call, made, &nothing, result);
  }
  CagVec3 a = cag_unit(axis);
  CagVec3 x = cag_transform_vector(place, cag_vec3(1, 0, 0));
  CagVec3 n = cag_unit(cag_cross(x, cag_transform_vector(place, cag_vec3(0, 1, 0))));
  if (!cag_geometry_ok(call, cag_region_area(region, &area, &centroid, call->err))) return false;
  CagVec3 center = cag_sub(cag_transform_point(place, centroid), through);
  if (fabs(cag_dot(a, n)) > AXIS_IN_PLANE ||
      fabs(cag_dot(center, n)) > AXIS_IN_PLANE * (1 + cag_norm(center)))
    return cag_geometry_ok(call,
                           cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_axis_not_in_plane, "axis",
                                    -1, "`axis` does not lie in the plane of the region"));
  CagVec3 radial = cag_cross(n, a);
  if (cag_dot(center, radial) < 0) radial = cag_scaled(radial, -1);
  CagTransform flat = half_plane(place, radial, a, through), frame;
  CagRegion *half = NULL;
  CagSolid *turned = NULL, *placed = NULL;
  CagStatus status = cag_region_transform(region, &flat, &half, call->err);
  if (!status)
    status =
        cag_solid_revolve(half, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), from, to, &turned, call->err);
  if (!status) status = cag_axes(through, radial, cag_cross(a, radial), &frame, call->err);
  if (!status) status = cag_solid_transform(turned, &frame, &placed, call->err);
  cag_region_release(half);
  cag_solid_release(turned);
  return cag_solid_result(call, status, &placed, result);
}

// Reads an angle a as 0..a, or as a..0 if it is negative.
static bool read_turn(CagCall *call, int argument, double *from, double *to) {
  *from = 0;
  *to = FULL_TURN;
  if (!cag_given(call, argument)) return true;
  if (call->values[argument].type == CAG_RANGE)
    return cag_arg_parameter_range(call, argument, true, from, to);
  double angle;
  if (!cag_arg_angle(call, argument, &angle)) return false;
  *from = fmin(angle, 0);
  *to = fmax(angle, 0);
  return true;
}

static CagStatus revolve_curve(const CagCurve *c, bool stand, CagVec3 axis, CagVec3 through,
                               double from, double to, CagSurface **out, CagError *err) {
  CagTransform up = upright();
  CagCurve *profile = NULL;
  CagStatus status =
      stand ? cag_curve_transform(c, &up, &profile, err) : cag_curve_to_space(c, &profile, err);
  if (!status) status = cag_surface_revolve(profile, axis, through, from, to, out, err);
  cag_curve_release(profile);
  return status;
}

bool cag_surfaces_revolve(CagCall *call, const struct cag_surfaces_revolve *a, CagValue *result) {
  const CagVec3 axis = a->axis.at, through = a->through.at;
  const CagValue v = a->C;
  double from, to;
  if (!(cag_norm(axis) > 0))
    return cag_geometry_ok(call, cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_zero_axis, "axis", -1,
                                          "`axis` must not be the zero vector"));
  if (!read_turn(call, 3, &from, &to)) return false;
  bool along_z = axis.x == 0 && axis.y == 0;
  if (v.type == CAG_CURVE) {
    const CagCurve *c = CAG_AS_SHAPE(v)->as.curve;
    CagSurface *s = NULL;
    CagStatus status =
        revolve_curve(c, along_z && c->dimension == 2, axis, through, from, to, &s, call->err);
    return cag_changed_surface_result(call, status, &s, result);
  }
  CagRegion *region;
  CagTransform place;
  if (!cag_arg_region(call, 0, &region, &place)) return false;
  cag_hold_region(call, region);
  if (along_z && place.planar) {
    CagTransform up = upright();
    place = cag_transform_multiply(&up, &place);
  }
  if (!cag_region_revolved(call, region, &place, axis, through, from, to, result)) return false;
  if (cag_is_shape(v)) cag_shape_say_alike(*result, v);
  return true;
}

// --- Extrusion ---

// Reads a height (along the section's normal) or a vector.
static bool read_way(CagCall *call, CagVec3 *way) {
  *way = cag_vec3(0, 0, 0);
  if (call->values[1].type == CAG_NUMBER) return cag_arg_finite(call, 1, &way->z);
  return call->values[1].type == CAG_LIST ? cag_arg_vec(call, 1, way, NULL)
                                          : cag_fail_type(call, 1, "a height or a vector");
}

// The sides of a region without caps: one for each of its curves.
static bool extrude_sides(CagCall *call, const struct cag_surfaces_extrude *a,
                          const CagRegion *region, CagVec3 way, const CagTransform *place,
                          CagValue *result) {
  CagBuilder *sides = cag_builder_new(call->vm);
  for (size_t i = 0; i < region->count; i++) {
    CagSurface *s = NULL, *placed = NULL;
    CagValue side;
    CagStatus status =
        cag_surface_extrude(region->loops[i], way, a->twist, a->scale, &s, call->err);
    if (!status) status = cag_surface_transform(s, place, &placed, call->err);
    cag_surface_release(s);
    if (!cag_surface_result(call, status, &placed, &side) ||
        !cag_builder_add(call->vm, sides, side))
      return false;
  }
  return cag_shapes_result(call, sides, result);
}

// Extrudes along `way`, which is in the region's own coordinates.
static bool extrude_region(CagCall *call, const struct cag_surfaces_extrude *a,
                           const CagRegion *region, CagVec3 way, const CagRoundedEnd ends[2],
                           const CagTransform *place, CagValue *result) {
  CagSolid *s = NULL, *placed = NULL;
  if (!a->caps) return extrude_sides(call, a, region, way, place, result);
  CagStatus status = ends[0].reach > 0 || ends[1].reach > 0
                         ? cag_solid_extrude_rounded(region, way.z, ends, &s, call->err)
                         : cag_solid_extrude(region, way, a->twist, a->scale, &s, call->err);
  if (!status) status = cag_solid_transform(s, place, &placed, call->err);
  cag_solid_release(s);
  return cag_solid_result(call, status, &placed, result);
}

// Indices of the parameters.
enum { HEIGHT = 1, TWIST = 2, SCALE = 3, CAPS = 4, FILLET = 6, CHAMFER = 7 };

// Reads a length for both ends, or a list of one for each.
static bool read_reach(CagCall *call, int argument, CagValue v, double out[2]) {
  const double *numbers = &v.as.number;
  size_t n = 1;
  out[0] = out[1] = 0;
  if (v.type == CAG_UNSET || v.type == CAG_NONE) return true;
  if (v.type == CAG_LIST) {
    if (!cag_arg_numbers(call, argument, &numbers, &n)) return false;
    if (n != 2) return cag_fail_value(call, argument, "a length, or a list of two");
  } else if (v.type != CAG_NUMBER) {
    return cag_fail_type(call, argument, "a length, or a list of two");
  }
  for (size_t i = 0; i < 2; i++) {
    out[i] = numbers[n == 1 ? 0 : i];
    if (!(out[i] >= 0) || isinf(out[i]))
      return cag_fail_value(call, argument, "lengths of at least 0");
  }
  return true;
}

static bool read_ends(CagCall *call, const struct cag_surfaces_extrude *a, CagRoundedEnd ends[2]) {
  double fillets[2], chamfers[2];
  if (!read_reach(call, FILLET, a->fillet, fillets) ||
      !read_reach(call, CHAMFER, a->chamfer, chamfers))
    return false;
  for (int i = 0; i < 2; i++) {
    if (fillets[i] > 0 && chamfers[i] > 0)
      return cag_fail_call(call, CHAMFER, CAG_ERR_value,
                           "accepts a fillet or a chamfer for each end, found both; give one of "
                           "them as a list with a 0 for this end");
    ends[i] = (CagRoundedEnd){fmax(fillets[i], chamfers[i]), fillets[i] > 0};
  }
  return true;
}

// Whether what the ends require is given: a straight solid.
static bool check_ends(CagCall *call, const struct cag_surfaces_extrude *a,
                       const CagRoundedEnd ends[2]) {
  if (ends[0].reach == 0 && ends[1].reach == 0) return true;
  const char *name = ends[0].round || ends[1].round ? "fillet" : "chamfer";
  if (a->twist != 0)
    return cag_fail_call(call, TWIST, CAG_ERR_value, "accepts `%s` only without `twist`", name);
  if (a->scale != 1)
    return cag_fail_call(call, SCALE, CAG_ERR_value, "accepts `%s` only without `scale`", name);
  if (!a->caps)
    return cag_fail_call(call, CAPS, CAG_ERR_value, "accepts `%s` only with caps", name);
  return true;
}

// A rounded extrusion goes along the normal of the region, and its placement keeps circles.
static bool check_place(CagCall *call, CagVec3 own, const CagTransform *place,
                        const CagRoundedEnd ends[2]) {
  double scale;
  if (ends[0].reach == 0 && ends[1].reach == 0) return true;
  const char *name = ends[0].round || ends[1].round ? "fillet" : "chamfer";
  if (fabs(own.x) + fabs(own.y) > AXIS_IN_PLANE * fabs(own.z))
    return cag_fail_call(call, HEIGHT, CAG_ERR_value,
                         "accepts `%s` only for a height along the normal of the section", name);
  if (!cag_transform_is_similarity(place, &scale) || fabs(scale - 1) > AXIS_IN_PLANE)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "accepts `%s` only for a section that is not scaled or sheared", name);
  return true;
}

bool cag_surfaces_extrude(CagCall *call, const struct cag_surfaces_extrude *a, CagValue *result) {
  CagRegion *region;
  CagTransform place, back;
  CagVec3 way;
  CagRoundedEnd ends[2];
  if (!read_way(call, &way) || !read_ends(call, a, ends) || !check_ends(call, a, ends))
    return false;
  const CagCurve *c = a->C.type == CAG_CURVE ? CAG_AS_SHAPE(a->C)->as.curve : NULL;
  if (c && (!c->closed || c->dimension == 3 || !a->caps)) {
    CagSurface *s = NULL;
    if (ends[0].reach > 0 || ends[1].reach > 0)
      return cag_fail_call(call, 0, CAG_ERR_value,
                           "expects a region or a closed plane curve for `fillet` or `chamfer`");
    CagStatus status = cag_surface_extrude(c, way, a->twist, a->scale, &s, call->err);
    if (!cag_surface_result(call, status, &s, result)) return false;
  } else {
    if (!cag_arg_region(call, 0, &region, &place)) return false;
    cag_hold_region(call, region);
    CagVec3 own = way;
    if (a->height.type == CAG_NUMBER) {
      way = cag_transform_vector(&place, way);
    } else {
      if (!cag_geometry_ok(call, cag_transform_inverse(&place, &back, call->err))) return false;
      own = cag_transform_vector(&back, way);
    }
    if (!check_place(call, own, &place, ends) ||
        !extrude_region(call, a, region, own, ends, &place, result))
      return false;
  }
  if (a->centered) {
    const CagTransform half = cag_translate(cag_scaled(way, -0.5));
    if (!cag_transform_apply(call->vm, &half, *result, result)) return false;
  }
  if (cag_is_shape(a->C)) cag_shape_say_alike(*result, a->C);
  return true;
}

// --- Others ---

bool cag_surfaces_ruled(CagCall *call, const struct cag_surfaces_ruled *a, CagValue *result) {
  CagSurface *s = NULL;
  return cag_surface_result(call, cag_surface_ruled(a->A, a->B, &s, call->err), &s, result);
}

bool cag_surfaces_bilinear(CagCall *call, const struct cag_surfaces_bilinear *a, CagValue *result) {
  CagSurface *s = NULL;
  CagStatus status = cag_surface_bilinear(a->P.at, a->Q.at, a->R.at, a->S.at, &s, call->err);
  return cag_surface_result(call, status, &s, result);
}

bool cag_surfaces_translational(CagCall *call, const struct cag_surfaces_translational *a,
                                CagValue *result) {
  CagSurface *s = NULL;
  return cag_surface_result(call, cag_surface_translational(a->A, a->B, &s, call->err), &s, result);
}

// The semicircle from the north pole to the south pole revolved about Z: u is the polar angle, v is
// the azimuth, and S_u x S_v points outward.
bool cag_surfaces_sphere_surface(CagCall *call, const struct cag_surfaces_sphere_surface *a,
                                 CagValue *result) {
  CagCurve *meridian = NULL;
  CagSurface *s = NULL;
  CagTransform from_pole = {.m = {{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}},
                            .planar = true};
  CagStatus status =
      cag_curve_arc(a->radius, a->radius, 0, FULL_TURN / 2, &from_pole, &meridian, call->err);
  if (!status)
    status = revolve_curve(meridian, true, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, FULL_TURN, &s,
                           call->err);
  cag_curve_release(meridian);
  return cag_surface_result(call, status, &s, result);
}

bool cag_surfaces_torus_surface(CagCall *call, const struct cag_surfaces_torus_surface *a,
                                CagValue *result) {
  CagSurface *s = NULL;
  return cag_surface_result(call, cag_surface_torus(a->major, a->minor, &s, call->err), &s, result);
}
