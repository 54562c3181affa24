// Curve theory in the language: frames from derivatives, special points, contact with planes,
// changes of the parameter, and helices by their constants.

#include <string.h>

#include "base/memory.h"
#include "geom/curve/frenet.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/support.h"

static CagValue rows_value(CagVm *vm, double m[3][3]) {
  const CagVec3 rows[3] = {
      {m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}};
  return cag_points_value(vm, rows, 3, 3);
}

// --- Frames ---

bool cag_frenet_frenet_of(CagCall *call, CagValue *result) {
  static const char *const names[] = {"speed",     "tangent", "normal", "binormal",
                                      "curvature", "torsion", "radius"};
  CagVec3 *given, d[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  size_t n;
  int dimension;
  double speed;
  CagFrenet f;
  if (!cag_arg_points(call, 0, &given, &n, &dimension)) return false;
  cag_hold(call, given);
  for (size_t i = 0; i < 3 && i < n; i++) d[i] = given[i];
  if (n > 3 || n < 2)
    return cag_fail_value(call, 0, "a list of the derivatives of order 1 and 2, or 1 to 3");
  if (!cag_geometry_ok(call, cag_frenet_of(d, &speed, &f, call->err))) return false;
  const bool bent = f.has_normal, twisted = bent && (n == 3 || dimension == 2);
  CagValue values[] = {cag_number(speed),
                       cag_point(call->vm, f.tangent, dimension),
                       bent ? cag_point(call->vm, f.normal, dimension) : cag_none(),
                       bent ? cag_point(call->vm, f.binormal, 3) : cag_none(),
                       cag_number(f.curvature),
                       twisted ? cag_number(f.torsion) : cag_none(),
                       bent ? cag_number(1 / f.curvature) : cag_none()};
  *result = cag_record_new(call->vm, names, values, 7);
  return true;
}

// The parameter of the curve and the frame there, which must have a normal.
static bool read_bent(CagCall *call, const CagCurve *c, double *t, CagFrenet *out) {
  if (!cag_arg_at(call, c, t) || !cag_geometry_ok(call, cag_curve_frenet(c, *t, out, call->err)))
    return false;
  return out->has_normal ||
         cag_fail_core(call, CAG_E_DEGENERATE, CAG_ERR_no_normal, "", -1,
                       "the curvature is 0 here, so there is neither normal nor circle of "
                       "curvature");
}

bool cag_frenet_frame_derivative(CagCall *call, const struct cag_frenet_frame_derivative *a,
                                 CagValue *result) {
  static const char *const names[] = {"by_length", "by_parameter", "tangent", "normal", "binormal"};
  const CagCurve *c = a->C;
  CagFrenet f;
  CagVec3 d[2];
  double t;
  if (!read_bent(call, c, &t, &f) ||
      !cag_geometry_ok(call, cag_curve_eval(c, t, 1, CAG_SIDE_RIGHT, d, call->err)))
    return false;
  const double k = f.curvature, w = f.torsion, speed = cag_norm(d[1]);
  double by_length[3][3] = {{0, k, 0}, {-k, 0, w}, {0, -w, 0}}, by_parameter[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) by_parameter[i][j] = speed * by_length[i][j];
  const CagVec3 bend = cag_madd(cag_scaled(f.tangent, -k), w, f.binormal);
  CagValue values[] = {rows_value(call->vm, by_length), rows_value(call->vm, by_parameter),
                       cag_point(call->vm, cag_scaled(f.normal, k), c->dimension),
                       cag_point(call->vm, bend, c->dimension),
                       cag_point(call->vm, cag_scaled(f.normal, -w), 3)};
  *result = cag_record_new(call->vm, names, values, 5);
  return true;
}

// Three vectors of space.
static bool read_triad(CagCall *call, int argument, CagVec3 out[3]) {
  CagVec3 *given;
  size_t n;
  int dimension;
  if (!cag_arg_points(call, argument, &given, &n, &dimension)) return false;
  cag_hold(call, given);
  if (n != 3 || dimension != 3)
    return cag_fail_value(call, argument, "a list of 3 vectors of space");
  memcpy(out, given, 3 * sizeof *out);
  return true;
}

bool cag_frenet_triad_derivative(CagCall *call, CagValue *result) {
  CagVec3 m[3], dm[3];
  double rates[3][3];
  if (!read_triad(call, 0, m) || !read_triad(call, 1, dm) ||
      !cag_geometry_ok(call, cag_triad_derivative(m, dm, rates, call->err)))
    return false;
  *result = rows_value(call->vm, rates);
  return true;
}

// --- At one parameter ---

bool cag_frenet_osculating_circle(CagCall *call, const struct cag_frenet_osculating_circle *a,
                                  CagValue *result) {
  static const char *const names[] = {"radius", "center", "circle"};
  CagCurve *circle;
  CagFrenet f;
  double t;
  if (!read_bent(call, a->C, &t, &f)) return false;
  const double radius = 1 / f.curvature;
  const CagVec3 center = cag_madd(f.point, radius, f.normal);
  // From the point on in the direction of the curve.
  const CagVec3 columns[4] = {cag_scaled(f.normal, -1), f.tangent, f.binormal, center};
  CagTransform frame = cag_transform_identity();
  frame.planar = a->C->dimension == 2;
  // In the plane a curve that bends to the right has y on the right of x.
  for (int j = 0; j < 4; j++) {
    if (frame.planar && j == 2) continue;
    frame.m[0][j] = columns[j].x;
    frame.m[1][j] = columns[j].y;
    frame.m[2][j] = columns[j].z;
  }
  CagStatus status = cag_curve_arc(radius, radius, 0, 2 * acos(-1), &frame, &circle, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  CagValue values[] = {cag_number(radius), cag_point(call->vm, center, a->C->dimension),
                       cag_curve_value(call->vm, circle)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_frenet_tangent_line(CagCall *call, const struct cag_frenet_tangent_line *a,
                             CagValue *result) {
  CagCurve *line = NULL;
  CagVec3 p, v;
  double t;
  if (!cag_arg_at(call, a->C, &t)) return false;
  CagStatus status = cag_curve_point(a->C, t, &p, call->err);
  if (!status) status = cag_curve_tangent(a->C, t, CAG_SIDE_RIGHT, &v, call->err);
  if (!status)
    status = cag_curve_line(p, cag_madd(p, a->length, v), a->C->dimension, &line, call->err);
  return cag_curve_result(call, status, &line, result);
}

bool cag_frenet_plane_contact(CagCall *call, const struct cag_frenet_plane_contact *a,
                              CagValue *result) {
  static const char *const names[] = {"coefficients", "order", "before", "after", "crosses"};
  CagPlaneContact found;
  double t;
  if (!cag_arg_at(call, a->C, &t) ||
      !cag_geometry_ok(call, cag_curve_contact(a->C, t, a->normal.at, &found, call->err)))
    return false;
  CagValue values[] = {cag_numbers_value(call->vm, found.c + 1, 3),
                       found.order < 0 ? cag_number(HUGE_VAL) : cag_number(found.order),
                       cag_number(found.before), cag_number(found.after),
                       cag_bool(found.before * found.after < 0)};
  *result = cag_record_new(call->vm, names, values, 5);
  return true;
}

// --- Of the whole ---

static CagValue parameters_value(CagCall *call, const CagCurve *c, const CagParameters *list,
                                 bool ranges) {
  CagBuilder *b = cag_builder_new(call->vm);
  for (size_t i = 0; i + (ranges ? 1 : 0) < list->count; i += ranges ? 2 : 1) {
    CagValue v = ranges ? cag_domain_value(call->vm, c->angular, list->t[i], list->t[i + 1])
                        : cag_parameter_value(c->angular, list->t[i]);
    cag_builder_add(call->vm, b, v);
  }
  return cag_builder_finish(call->vm, b);
}

static void free_special_points(void *s) {
  cag_special_points_free(s);
  cag_free(s);
}

bool cag_frenet_special_points(CagCall *call, const struct cag_frenet_special_points *a,
                               CagValue *result) {
  static const char *const names[] = {"singular", "straightening", "flattening",
                                      "still",    "straight",      "planar"};
  CagSpecialPoints *found = cag_hold_array(call, 1, sizeof *found);
  cag_hold_for(call, free_special_points, cag_give_held(call, found));
  if (!cag_geometry_ok(call, cag_curve_special_points(a->C, found, call->err))) return false;
  CagValue values[6];
  for (int k = 0; k < CAG_VANISHINGS; k++) {
    values[k] = parameters_value(call, a->C, &found->points[k], false);
    values[3 + k] = parameters_value(call, a->C, &found->stretches[k], true);
  }
  *result = cag_record_new(call->vm, names, values, 6);
  return true;
}

// --- Change of the parameter ---

bool cag_frenet_chain_derivatives(CagCall *call, CagValue *result) {
  CagVec3 *d, out[CAG_MAX_DERIVATIVE];
  const double *f;
  size_t n, m;
  int dimension;
  if (!cag_arg_numbers(call, 1, &f, &m)) return false;
  if (!cag_arg_points(call, 0, &d, &n, &dimension)) return false;
  cag_hold(call, d);
  if (n > CAG_MAX_DERIVATIVE || m != n)
    return cag_fail_value(call, 1, "as many derivatives as the curve has, at most 16");
  if (!cag_geometry_ok(call, cag_chain_derivatives(d, f, (int)n, out, call->err))) return false;
  *result = cag_points_value(call->vm, out, n, dimension);
  return true;
}

// --- Helices ---

bool cag_frenet_circular_vectors(CagCall *call, CagValue *result) {
  static const char *const names[] = {"e", "g"};
  double degrees, s, c;
  if (!cag_arg_degrees(call, 0, &degrees)) return false;
  cag_sincos_degrees(degrees, &s, &c);
  CagValue values[] = {cag_point(call->vm, cag_vec3(c, s, 0), 3),
                       cag_point(call->vm, cag_vec3(-s, c, 0), 3)};
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_frenet_helix_motion(CagCall *call, const struct cag_frenet_helix_motion *a,
                             CagValue *result) {
  static const char *const names[] = {"point", "velocity", "angle",     "rise",
                                      "pitch", "length",   "curvature", "torsion"};
  const double r = a->radius, v = a->speed, time = a->time, omega = a->turning;
  const double turned = call->values[1].as.number * time, b = v / omega, r2 = r * r + b * b;
  if (omega == 0)
    return cag_fail_core(call, CAG_E_ARGUMENT, CAG_ERR_no_turning, "turning", -1,
                         "`turning` must not be 0: the point moves along a line, not a helix");
  double s, c;
  cag_sincos_degrees(turned, &s, &c);
  CagValue values[] = {cag_point(call->vm, cag_vec3(r * c, r * s, v * time), 3),
                       cag_point(call->vm, cag_vec3(-r * omega * s, r * omega * c, v), 3),
                       cag_angle(turned),
                       cag_number(b),
                       cag_number(2 * acos(-1) * b),
                       cag_number(hypot(r * omega, v) * fabs(time)),
                       cag_number(r / r2),
                       cag_number(b / r2)};
  *result = cag_record_new(call->vm, names, values, 8);
  return true;
}

bool cag_frenet_constant_curve(CagCall *call, const struct cag_frenet_constant_curve *a,
                               CagValue *result) {
  static const char *const names[] = {"kind", "radius", "rise", "pitch"};
  const double k = a->curvature, w = a->torsion;
  if (k < 0) return cag_fail_value(call, 0, "a curvature of at least 0");
  const bool bent = k > 0;
  // In units of the larger of both, so that squares neither overflow nor vanish.
  const double unit = fmax(k, fabs(w)), x = bent ? k / unit : 0, y = bent ? w / unit : 0;
  const double squares = x * x + y * y;
  const double radius = bent ? x / squares / unit : 0, rise = bent ? y / squares / unit : 0;
  CagValue values[] = {
      cag_text_c(call->vm, !bent    ? "line"
                           : w == 0 ? "circle"
                                    : "helix"),
      bent ? cag_number(radius) : cag_none(),
      bent ? cag_number(rise) : cag_none(),
      bent ? cag_number(2 * acos(-1) * rise) : cag_none(),
  };
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}
