// Curves between carriers (see recognized_curve.h).

#include "geom/solid/recognized_curve.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/curve/family.h"
#include "geom/curve/fit.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/roll_section.h"
#include "geom/surface/nearest.h"

// Steps of Newton's method.
#define STEPS 30
// Steps toward the nearest point of a spline, each of which halves the distance.
#define SPLINE_STEPS 12
// Carriers are tangent if the determinant of their normals is smaller.
#define TANGENT 1e-6
// A curve is a line or a conic if its points are on one to this fraction of the size.
#define EXACT 1e-7
// Points from which the kind of a curve is found, and the most of a spline.
#define POINTS_LEAST 9
#define POINTS_MOST 400
// The largest turn between neighboring chords of a spline's points, in radians.
#define TURN (5 * M_PI / 180)
// The chords between points in their right order turn by less, in radians.
#define BACK 1.2
// Points of a trace. The cubic through so many points of a circle is within 2e-8 of its radius.
#define TRACE 129
// A trace is a line if its points are on one to this fraction of its length.
#define TRACE_LINE 1e-12

// --- Points on several carriers ---

static CagStatus nearest_parameters(const CagCarrier *c, CagVec3 p, double uv[2], CagError *err) {
  CagSurfaceNearest at;
  uv[0] = uv[1] = 0;
  if (c->kind != CAG_CARRIER_SPLINE) return CAG_OK;
  CagStatus status = cag_surface_closest(c->spline, p, &at, err);
  uv[0] = at.u, uv[1] = at.v;
  return status;
}

// The step of least length to the tangent planes rows[i] . x = values[i]; false: they are parallel.
static bool least_step(const CagVec3 *rows, const double *values, size_t n, CagVec3 *x) {
  if (n == 2) {
    const double c = cag_dot(rows[0], rows[1]), det = 1 - c * c;
    if (!(det > TANGENT)) return false;
    *x = cag_madd(cag_scaled(rows[0], (values[0] - c * values[1]) / det),
                  (values[1] - c * values[0]) / det, rows[1]);
    return true;
  }
  const CagVec3 c0 = cag_cross(rows[1], rows[2]), c1 = cag_cross(rows[2], rows[0]);
  const CagVec3 c2 = cag_cross(rows[0], rows[1]);
  const double det = cag_dot(rows[0], c0);
  if (!(fabs(det) > sqrt(TANGENT))) return false;
  *x = cag_scaled(cag_madd(cag_madd(cag_scaled(c0, values[0]), values[1], c1), values[2], c2),
                  1 / det);
  return true;
}

CagStatus cag_recognized_settle(const CagCarrier *const *carriers, size_t n, double most,
                                CagVec3 *p, bool *settled, CagError *err) {
  CagRollSide sides[3];
  double uv[3][2];
  CagVec3 at = *p, step = {INFINITY, 0, 0};
  CagStatus status = CAG_OK;
  *settled = false;
  for (size_t i = 0; i < n; i++)
    if (carriers[i]->kind == CAG_CARRIER_NONE) return CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    sides[i] = (CagRollSide){.carrier = carriers[i], .outward = 1};
    status = nearest_parameters(carriers[i], at, uv[i], err);
  }
  const double enough = 8 * CAG_ROUNDING * (cag_norm(at) + most);
  for (int k = 0; !status && k < STEPS && cag_norm(step) > enough; k++) {
    CagVec3 rows[3], foot;
    double values[3];
    for (size_t i = 0; !status && i < n; i++) {
      const int times = cag_carrier_is_analytic(carriers[i]) ? 1 : SPLINE_STEPS;
      for (int j = 0; !status && j < times; j++)
        status = cag_roll_foot(&sides[i], at, uv[i], &foot, &rows[i], err);
      values[i] = cag_dot(cag_sub(foot, at), rows[i]);
    }
    if (status || !least_step(rows, values, n, &step)) return status;
    at = cag_add(at, step);
    if (!(cag_norm(cag_sub(at, *p)) <= most)) return CAG_OK;
  }
  if (status || !(cag_norm(step) <= sqrt(CAG_ROUNDING) * (cag_norm(at) + most))) return status;
  *settled = true;
  *p = at;
  return CAG_OK;
}

// --- Points of a curve ---

typedef struct CurvePoints {
  const CagCarrier *const *carriers;
  CagVec3 at[POINTS_MOST];
  size_t n;
  bool closed;
  double size, most;
} CurvePoints;

// Moves the points to both carriers. Those that cannot be moved are left out, unless they are most.
static CagStatus settle_points(CurvePoints *c, CagError *err) {
  CagStatus status = CAG_OK;
  bool settled[POINTS_MOST];
  size_t count = 0, n = 0;
  for (size_t i = 0; !status && i < c->n; i++) {
    const bool fixed = !c->closed && (i == 0 || i + 1 == c->n);
    status = cag_stop_check(err);
    settled[i] = fixed;
    if (!status && !fixed)
      status = cag_recognized_settle(c->carriers, 2, c->most, &c->at[i], &settled[i], err);
    count += settled[i];
  }
  for (size_t i = 0; !status && 2 * count > c->n && count >= 4 && i < c->n; i++)
    if (settled[i]) c->at[n++] = c->at[i];
  if (n > 0) c->n = n;
  if (c->closed && cag_norm(cag_sub(c->at[c->n - 1], c->at[0])) > 0) {
    if (settled[0]) c->at[c->n - 1] = c->at[0];
    else if (c->n < POINTS_MOST) c->at[c->n] = c->at[0], c->n++;
  }
  return status;
}

static double chord_turn(CagVec3 a, CagVec3 b, CagVec3 c) {
  const CagVec3 d = cag_sub(b, a), e = cag_sub(c, b);
  return atan2(cag_norm(cag_cross(d, e)), cag_dot(d, e));
}

// Leaves out points that are closer to the ones before them, or to the end, than the points moved at
// most, and points at which the chords turn back: their order may have changed.
static void thin_points(CurvePoints *c) {
  double length = 0;
  for (size_t i = 1; i < c->n; i++) length += cag_norm(cag_sub(c->at[i], c->at[i - 1]));
  const double gap = fmin(c->most / 4, length / POINTS_LEAST);
  const CagVec3 end = c->at[c->n - 1];
  size_t n = 1;
  for (size_t i = 1; i + 1 < c->n; i++)
    if (cag_norm(cag_sub(c->at[i], c->at[n - 1])) >= gap && cag_norm(cag_sub(c->at[i], end)) >= gap)
      c->at[n++] = c->at[i];
  c->at[n++] = end;
  c->n = n;
  for (size_t i = 1; i + 1 < c->n && c->n > 4;) {
    if (chord_turn(c->at[i - 1], c->at[i], c->at[i + 1]) <= BACK) {
      i++;
      continue;
    }
    memmove(c->at + i, c->at + i + 1, (c->n - i - 1) * sizeof *c->at);
    c->n--;
    if (i > 1) i--;
  }
}

// Adds a point between points i and i + 1.
static CagStatus split_chord(CurvePoints *c, size_t i, CagError *err) {
  CagVec3 middle = cag_lerp(c->at[i], c->at[i + 1], 0.5);
  bool settled;
  const double most = fmax(c->most, cag_norm(cag_sub(c->at[i + 1], c->at[i])) / 4);
  CagStatus status = cag_recognized_settle(c->carriers, 2, most, &middle, &settled, err);
  if (status) return status;
  memmove(c->at + i + 2, c->at + i + 1, (c->n - i - 1) * sizeof *c->at);
  c->at[i + 1] = middle;
  c->n++;
  return CAG_OK;
}

// Divides the longest chords until there are at least so many points.
static CagStatus add_points(CurvePoints *c, size_t least, CagError *err) {
  CagStatus status = CAG_OK;
  while (!status && c->n < least) {
    size_t longest = 0;
    double most = 0;
    for (size_t i = 0; i + 1 < c->n; i++) {
      const double length = cag_norm(cag_sub(c->at[i + 1], c->at[i]));
      if (length > most) most = length, longest = i;
    }
    status = split_chord(c, longest, err);
  }
  return status;
}

// Divides chords beside which the curve turns.
static CagStatus refine_points(CurvePoints *c, CagError *err) {
  CagStatus status = CAG_OK;
  for (int round = 0; !status && round < 4; round++) {
    const size_t before = c->n;
    for (size_t i = c->n - 1; !status && i-- > 0 && c->n < POINTS_MOST;) {
      const double left = i > 0 ? chord_turn(c->at[i - 1], c->at[i], c->at[i + 1]) : 0;
      const double right = i + 2 < c->n ? chord_turn(c->at[i], c->at[i + 1], c->at[i + 2]) : 0;
      const double length = cag_norm(cag_sub(c->at[i + 1], c->at[i]));
      if (fmax(left, right) > TURN && length > c->most) status = split_chord(c, i, err);
    }
    if (c->n == before) break;
  }
  return status;
}

// --- Kinds of curves ---

static bool points_on_line(const CurvePoints *c) {
  const CagVec3 a = c->at[0], along = cag_unit(cag_sub(c->at[c->n - 1], a));
  for (size_t i = 1; i < c->n; i++) {
    const CagVec3 d = cag_sub(c->at[i], a);
    if (cag_norm(cag_cross(d, along)) > EXACT * c->size) return false;
  }
  return !c->closed;
}

// A line of degree 1, as edges of boundaries have.
static CagStatus line_curve(const CurvePoints *c, CagCurve **out, CagError *err) {
  const CagVec3 ends[2] = {c->at[0], c->at[c->n - 1]};
  const double length = cag_norm(cag_sub(ends[1], ends[0])), knots[4] = {0, 0, length, length};
  return cag_curve_nurbs(ends, NULL, 2, 1, knots, 3, out, err);
}

// A conic with semi-axes a along x and b along y.
typedef struct Conic {
  CagTransform frame;
  double a, b;
} Conic;

static CagTransform conic_frame(CagVec3 x, CagVec3 y, CagVec3 z, CagVec3 center) {
  const CagVec3 columns[4] = {x, y, z, center};
  CagTransform frame = cag_transform_identity();
  frame.planar = false;
  for (int k = 0; k < 4; k++) {
    frame.m[0][k] = columns[k].x;
    frame.m[1][k] = columns[k].y;
    frame.m[2][k] = columns[k].z;
  }
  return frame;
}

static bool circle_through(const CurvePoints *c, Conic *out) {
  const CagVec3 p = c->at[0], q = c->at[c->n / 3], r = c->at[2 * c->n / 3];
  const CagVec3 a = cag_sub(q, p), b = cag_sub(r, p), normal = cag_cross(a, b);
  const double square = cag_dot(normal, normal);
  if (!(square > 0)) return false;
  const CagVec3 to = cag_scaled(cag_add(cag_scaled(cag_cross(b, normal), cag_dot(a, a)),
                                        cag_scaled(cag_cross(normal, a), cag_dot(b, b))),
                                1 / (2 * square));
  const CagVec3 center = cag_add(p, to), z = cag_unit(normal), x = cag_unit(cag_scaled(to, -1));
  out->frame = conic_frame(x, cag_cross(z, x), z, center);
  out->a = out->b = cag_norm(to);
  for (size_t i = 0; i < c->n; i++) {
    const CagVec3 d = cag_sub(c->at[i], center);
    if (fabs(cag_norm(d) - out->a) > EXACT * c->size || fabs(cag_dot(d, z)) > EXACT * c->size)
      return false;
  }
  return true;
}

// The section of a cylinder by a plane.
static bool ellipse_of(const CurvePoints *c, Conic *out) {
  const bool first = c->carriers[0]->kind == CAG_CARRIER_PLANE;
  const CagCarrier *plane = c->carriers[!first], *round = c->carriers[first];
  if (plane->kind != CAG_CARRIER_PLANE || round->kind != CAG_CARRIER_CYLINDER) return false;
  const CagVec3 n = cag_frame_column(&plane->frame, 2), z = cag_frame_column(&round->frame, 2);
  const CagVec3 o = cag_frame_column(&round->frame, 3);
  const double slope = cag_dot(n, z), across = cag_norm(cag_cross(n, z));
  if (fabs(slope) < TANGENT || across < TANGENT) return false;
  const double along = cag_dot(cag_sub(cag_frame_column(&plane->frame, 3), o), n) / slope;
  const CagVec3 center = cag_madd(o, along, z), x = cag_unit(cag_madd(z, -slope, n));
  const CagVec3 y = cag_cross(n, x);
  out->frame = conic_frame(x, y, n, center);
  out->a = round->a / fabs(slope);
  out->b = round->a;
  for (size_t i = 0; i < c->n; i++) {
    const CagVec3 d = cag_sub(c->at[i], center);
    const double off = hypot(cag_dot(d, x) / out->a, cag_dot(d, y) / out->b) - 1;
    if (fabs(off) * out->b > EXACT * c->size) return false;
  }
  return true;
}

// Finds the angle at which a conic around the axis of a carrier crosses the half-plane u = 0, where
// the kernel's face has its seam.
static bool conic_seam(const Conic *k, const CagCarrier *c, double size, double *out) {
  if (!cag_carrier_is_analytic(c) || !cag_carrier_is_periodic(c, 0)) return false;
  const CagVec3 x = cag_frame_column(&k->frame, 0), y = cag_frame_column(&k->frame, 1);
  const CagVec3 right = cag_frame_column(&c->frame, 0), up = cag_frame_column(&c->frame, 1);
  const CagVec3 off = cag_sub(cag_frame_column(&k->frame, 3), cag_frame_column(&c->frame, 3));
  if (hypot(cag_dot(off, right), cag_dot(off, up)) > EXACT * size) return false;
  const double t = atan2(-k->a * cag_dot(x, up), k->b * cag_dot(y, up));
  const double ahead = k->a * cos(t) * cag_dot(x, right) + k->b * sin(t) * cag_dot(y, right);
  if (!(fabs(ahead) > EXACT * size)) return false;
  *out = ahead < 0 ? t + M_PI : t;
  return true;
}

// The part of a conic through the points, in their direction. A closed one starts at the seam of a
// carrier if it goes around its axis, so that its start does not depend on the mesh.
static CagStatus conic_curve(const CurvePoints *c, Conic k, CagCurve **out, CagError *err) {
  double turned = 0, last = 0, first = 0;
  for (int pass = 0; pass < 2; pass++) {
    const CagVec3 x = cag_frame_column(&k.frame, 0), y = cag_frame_column(&k.frame, 1);
    turned = 0;
    for (size_t i = 0; i < c->n; i++) {
      const CagVec3 d = cag_sub(c->at[i], cag_frame_column(&k.frame, 3));
      const double t = atan2(cag_dot(d, y) / k.b, cag_dot(d, x) / k.a);
      if (i == 0) first = t;
      else turned += remainder(t - last, 2 * M_PI);
      last = t;
    }
    if (turned >= 0) break;
    for (int i = 0; i < 3; i++) // turned about x
      for (int j = 1; j < 3; j++) k.frame.m[i][j] = -k.frame.m[i][j];
  }
  if (c->closed) {
    turned = 2 * M_PI;
    if (!conic_seam(&k, c->carriers[0], c->size, &first))
      conic_seam(&k, c->carriers[1], c->size, &first);
  }
  return cag_curve_arc(k.a, k.b, first, first + turned, &k.frame, out, err);
}

static CagStatus spline_curve(CurvePoints *c, CagCurve **out, CagError *err) {
  CagStatus status = refine_points(c, err);
  if (status) return status;
  double parameters[POINTS_MOST];
  size_t n = 0;
  for (size_t i = 0; i < c->n; i++) { // without points that coincide
    const double step = n > 0 ? cag_norm(cag_sub(c->at[i], c->at[n - 1])) : 0;
    if (n > 0 && !(step > CAG_COINCIDENT * c->size) && i + 1 < c->n) continue;
    parameters[n] = n > 0 ? parameters[n - 1] + fmax(step, CAG_COINCIDENT * c->size) : 0;
    c->at[n++] = c->at[i];
  }
  const CagFitData data = {
      .points = c->at, .n = n, .parameters = parameters, .degree = 3, .dimension = 3};
  return cag_curve_interpolate_ends(&data, c->closed ? CAG_FIT_PERIODIC : CAG_FIT_NOT_A_KNOT, NULL,
                                    out, err);
}

CagStatus cag_recognized_curve(const CagCarrier *const carriers[2], const CagVec3 *points, size_t n,
                               bool closed, double size, double most, CagCurve **out,
                               CagError *err) {
  CurvePoints *c = cag_malloc(sizeof *c);
  Conic conic;
  if (!c) return cag_fail_memory(err);
  c->carriers = carriers;
  c->closed = closed;
  c->size = size;
  c->most = most;
  // A long chain is thinned out.
  const size_t kept = n < POINTS_MOST / 2 ? n : POINTS_MOST / 2;
  c->n = kept;
  for (size_t i = 0; i < kept; i++) c->at[i] = points[i * (n - 1) / (kept - 1)];
  CagStatus status = settle_points(c, err);
  if (!status) thin_points(c);
  if (!status) status = add_points(c, POINTS_LEAST, err);
  if (!status) {
    if (points_on_line(c)) status = line_curve(c, out, err);
    else if (circle_through(c, &conic) || ellipse_of(c, &conic))
      status = conic_curve(c, conic, out, err);
    else status = spline_curve(c, out, err);
  }
  cag_free(c);
  return status;
}

// Whether points are evenly spaced on a line over their parameters.
static bool is_even(const CagVec3 *uv, const double *t, size_t n) {
  const CagVec3 along = cag_sub(uv[n - 1], uv[0]);
  const double slack = TRACE_LINE * (cag_norm(along) + cag_norm(uv[0]));
  for (size_t i = 1; i + 1 < n; i++) {
    const CagVec3 even = cag_madd(uv[0], (t[i] - t[0]) / (t[n - 1] - t[0]), along);
    if (cag_norm(cag_sub(uv[i], even)) > slack) return false;
  }
  return true;
}

CagStatus cag_recognized_trace(const CagCarrier *c, const CagCurve *curve, CagCurve **out,
                               CagError *err) {
  CagVec3 uv[TRACE];
  double t[TRACE], near[2] = {0, 0};
  bool straight;
  CagStatus status = cag_curve_is_straight(curve, &straight, err);
  const size_t n = !straight ? TRACE : c->kind == CAG_CARRIER_PLANE ? 2 : 3;
  for (size_t i = 0; !status && i < n; i++) {
    CagVec3 p;
    double at[2];
    t[i] = i + 1 == n ? curve->end
                      : curve->start + (curve->end - curve->start) * (double)i / (double)(n - 1);
    status = cag_curve_point(curve, t[i], &p, err);
    if (status) break;
    if (cag_carrier_is_analytic(c)) cag_carrier_parameters(c, p, near, at);
    else status = nearest_parameters(c, p, at, err);
    near[0] = at[0], near[1] = at[1];
    uv[i] = cag_vec3(at[0], at[1], 0);
  }
  if (status) return status;
  if (is_even(uv, t, n)) {
    const CagVec3 ends[2] = {uv[0], uv[n - 1]};
    return cag_curve_polyline_over(ends, (double[2]){t[0], t[n - 1]}, 2, 2, out, err);
  }
  if (n < TRACE) return cag_curve_polyline_over(uv, t, n, 2, out, err);
  const CagFitData data = {.points = uv, .n = n, .parameters = t, .degree = 3, .dimension = 2};
  return cag_curve_interpolate_ends(&data, CAG_FIT_NOT_A_KNOT, NULL, out, err);
}
