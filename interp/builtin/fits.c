// Fits of lines, planes, circles, ellipses, spheres, and cylinders to points.

#include "geom/linalg/shape_fit.h"
#include "geom/solid/solid.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/solids.h"
#include "interp/builtin/support.h"

#define FULL_TURN 6.283185307179586476925

typedef struct Fitted {
  CagShapeFit fit;
  int dimension; // of points of the record
} Fitted;

static bool fitted(CagCall *call, CagFitShape shape, const CagPoints *points, Fitted *out) {
  const bool planar = points->dimension == 2;
  out->dimension = points->dimension;
  return cag_geometry_ok(
      call, cag_shape_fit(shape, points->items, points->count, planar, &out->fit, call->err));
}

static CagVec3 column(const Fitted *f, int i) {
  return cag_vec3(f->fit.frame.m[0][i], f->fit.frame.m[1][i], f->fit.frame.m[2][i]);
}

static CagValue point_value(CagCall *call, const Fitted *f, CagVec3 p) {
  return cag_point(call->vm, p, f->dimension);
}

// The record of these values, followed by the distances. `names` has room for both of their names.
static bool fit_record(CagCall *call, const Fitted *f, const char **names, CagValue *values,
                       size_t n, CagValue *result) {
  names[n] = "rms";
  values[n] = cag_number(f->fit.rms);
  names[n + 1] = "deviation";
  values[n + 1] = cag_number(f->fit.largest);
  *result = cag_record_new(call->vm, names, values, n + 2);
  return true;
}

bool cag_fits_fit_line(CagCall *call, const struct cag_fits_fit_line *a, CagValue *result) {
  Fitted f;
  CagCurve *line = NULL;
  CagValue shape;
  if (!fitted(call, CAG_FIT_LINE, &a->points, &f)) return false;
  const CagVec3 center = column(&f, 3), direction = column(&f, 2);
  CagStatus status =
      cag_curve_line(cag_madd(center, f.fit.low, direction),
                     cag_madd(center, f.fit.high, direction), f.dimension, &line, call->err);
  if (!cag_curve_result(call, status, &line, &shape)) return false;
  const char *names[5] = {"shape", "point", "direction"};
  CagValue values[5] = {shape, point_value(call, &f, center), point_value(call, &f, direction)};
  return fit_record(call, &f, names, values, 3, result);
}

bool cag_fits_fit_plane(CagCall *call, const struct cag_fits_fit_plane *a, CagValue *result) {
  Fitted f;
  CagPlane plane;
  if (!fitted(call, CAG_FIT_PLANE, &a->points, &f)) return false;
  const CagVec3 center = column(&f, 3), normal = column(&f, 2);
  if (!cag_geometry_ok(call, cag_plane(center, normal, &plane, call->err))) return false;
  const char *names[5] = {"shape", "point", "normal"};
  CagValue values[5] = {cag_plane_value(call->vm, &plane), cag_point(call->vm, center, 3),
                        cag_point(call->vm, normal, 3)};
  return fit_record(call, &f, names, values, 3, result);
}

// The circle or ellipse of a fit.
static bool arc_value(CagCall *call, const Fitted *f, double a, double b, CagValue *out) {
  CagCurve *c = NULL;
  CagStatus status = cag_curve_arc(a, b, 0, FULL_TURN, &f->fit.frame, &c, call->err);
  return cag_curve_result(call, status, &c, out);
}

bool cag_fits_fit_circle(CagCall *call, const struct cag_fits_fit_circle *a, CagValue *result) {
  Fitted f;
  CagValue shape;
  if (!fitted(call, CAG_FIT_CIRCLE, &a->points, &f) ||
      !arc_value(call, &f, f.fit.a, f.fit.a, &shape))
    return false;
  const char *names[6] = {"shape", "center", "radius", "normal"};
  CagValue values[6] = {shape, point_value(call, &f, column(&f, 3)), cag_number(f.fit.a),
                        cag_point(call->vm, column(&f, 2), 3)};
  return fit_record(call, &f, names, values, 4, result);
}

bool cag_fits_fit_ellipse(CagCall *call, const struct cag_fits_fit_ellipse *a, CagValue *result) {
  Fitted f;
  CagValue shape;
  if (!fitted(call, CAG_FIT_ELLIPSE, &a->points, &f) ||
      !arc_value(call, &f, f.fit.a, f.fit.b, &shape))
    return false;
  const char *names[8] = {"shape", "center", "a", "b", "axis", "normal"};
  CagValue values[8] = {shape,
                        point_value(call, &f, column(&f, 3)),
                        cag_number(f.fit.a),
                        cag_number(f.fit.b),
                        point_value(call, &f, column(&f, 0)),
                        cag_point(call->vm, column(&f, 2), 3)};
  return fit_record(call, &f, names, values, 6, result);
}

bool cag_fits_fit_sphere(CagCall *call, const struct cag_fits_fit_sphere *a, CagValue *result) {
  Fitted f;
  CagSolid *ball = NULL, *moved = NULL;
  CagValue shape;
  if (!fitted(call, CAG_FIT_SPHERE, &a->points, &f)) return false;
  const CagTransform move = cag_translate(column(&f, 3));
  CagStatus status = cag_solid_sphere(f.fit.a, &ball, call->err);
  if (!status) status = cag_solid_transform(ball, &move, &moved, call->err);
  cag_solid_release(ball);
  if (!cag_solid_result(call, status, &moved, &shape)) return false;
  const char *names[5] = {"shape", "center", "radius"};
  CagValue values[5] = {shape, cag_point(call->vm, column(&f, 3), 3), cag_number(f.fit.a)};
  return fit_record(call, &f, names, values, 3, result);
}

bool cag_fits_fit_cylinder(CagCall *call, const struct cag_fits_fit_cylinder *a, CagValue *result) {
  Fitted f;
  CagSolid *rod = NULL;
  CagValue shape;
  if (!fitted(call, CAG_FIT_CYLINDER, &a->points, &f)) return false;
  const CagVec3 axis = column(&f, 2), base = cag_madd(column(&f, 3), f.fit.low, axis);
  const double height = f.fit.high - f.fit.low;
  CagStatus status =
      cag_solid_rod(base, cag_madd(base, height, axis), f.fit.a, f.fit.a, &rod, call->err);
  if (!cag_solid_result(call, status, &rod, &shape)) return false;
  const char *names[7] = {"shape", "center", "axis", "radius", "height"};
  CagValue values[7] = {shape, cag_point(call->vm, base, 3), cag_point(call->vm, axis, 3),
                        cag_number(f.fit.a), cag_number(height)};
  return fit_record(call, &f, names, values, 5, result);
}
