// Tangent, curvature, torsion, and the moving frame, with their limits where the speed vanishes.
//
// Regular points use the classical formulas. Where C' = 0 (coincident control points) the curve is
// C0 + d_m s^m / m! + ..: the first nonzero derivative gives the direction, the first one off that
// line gives the normal, and the leading powers give curvature and torsion or show that they are
// infinite.

#include <string.h>

#include "geom/curve/curve.h"
#include "geom/linalg/tolerance.h"

// A derivative is 0 if its Taylor term over the whole domain is below this fraction of the size of
// the curve.
#define VANISHES CAG_ROUNDING
// Speeds below this fraction of the acceleration need a closer check.
#define SUSPECT 1e-6
// Sine of the angle between derivatives that are parallel up to rounding.
#define PARALLEL 1e-10

static double factorial(int n) {
  double f = 1;
  for (int i = 2; i <= n; i++) f *= i;
  return f;
}

// Magnitude of the largest coordinate of the curve's box.
static double size_of(const CagCurve *c) {
  CagBounds b = c->kind->hull(c, c->start, c->end);
  CagVec3 e = cag_sub(b.max, b.min);
  double extent = cag_norm(e);
  double far = fmax(cag_norm(b.min), cag_norm(b.max));
  // Rounding is relative to the coordinates; otherwise smallness is relative to the extent.
  return fmax(extent, VANISHES * far);
}

static bool vanishes(const CagCurve *c, CagVec3 d, int k, double size) {
  return cag_norm(d) * pow(c->end - c->start, k) / factorial(k) <= VANISHES * size;
}

static CagStatus fail_tangent(CagError *err, double t) {
  char text[32];
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_tangent_undefined, "t", -1,
                  "the curve is stationary at t = %s: all its derivatives are 0 there, so it "
                  "has no tangent",
                  cag_number_text(t, text));
}

// Order of the first derivative that does not vanish, 0 if there is none. d[0..CAG_MAX_DERIVATIVE].
static int first_direction(const CagCurve *c, const CagVec3 *d) {
  double size = size_of(c);
  for (int k = 1; k <= CAG_MAX_DERIVATIVE; k++)
    if (!vanishes(c, d[k], k, size)) return k;
  return 0;
}

static CagStatus side_of(const CagCurve *c, double t, CagSide *side, CagError *err) {
  (void)err;
  if (t >= c->end) *side = CAG_SIDE_LEFT;
  if (t <= c->start) *side = CAG_SIDE_RIGHT;
  return CAG_OK;
}

CagStatus cag_curve_tangent(const CagCurve *c, double t, CagSide side, CagVec3 *out,
                            CagError *err) {
  CagVec3 d[CAG_MAX_DERIVATIVE + 1];
  CagStatus status = cag_curve_eval(c, t, 2, side, d, err);
  if (status) return status;
  if (cag_norm(d[1]) > SUSPECT * cag_norm(d[2]) * (c->end - c->start) && cag_norm(d[1]) > 0) {
    *out = cag_unit(d[1]);
    return CAG_OK;
  }
  status = cag_curve_eval(c, t, CAG_MAX_DERIVATIVE, side, d, err);
  if (status) return status;
  int m = first_direction(c, d);
  if (m == 0) return fail_tangent(err, t);
  side_of(c, t, &side, err);
  // From the left s is negative, and so is the derivative of an even power.
  double sign = side == CAG_SIDE_LEFT && m % 2 == 0 ? -1 : 1;
  *out = cag_scaled(cag_unit(d[m]), sign);
  return CAG_OK;
}

// The component of v perpendicular to the unit vector u; zero if it is only rounding.
static CagVec3 across(CagVec3 v, CagVec3 u) {
  CagVec3 w = cag_madd(v, -cag_dot(v, u), u);
  return cag_norm(w) <= PARALLEL * cag_norm(v) ? cag_vec3(0, 0, 0) : w;
}

static CagStatus regular_frame(const CagCurve *c, double t, const CagVec3 *d, CagFrenet *out) {
  (void)t;
  const double speed = cag_norm(d[1]);
  const CagVec3 cross = cag_cross(d[1], d[2]);
  const double area = cag_norm(cross), bend = cag_norm(d[2]);
  out->tangent = cag_scaled(d[1], 1 / speed);
  out->curvature = area / (speed * speed * speed);
  // Straight: the acceleration is along the curve, or negligible.
  const double reach = speed * (c->end - c->start) + cag_norm(d[0]);
  if (area <= PARALLEL * speed * bend || out->curvature * reach <= PARALLEL * 1e-2) {
    out->curvature = 0;
    return CAG_OK;
  }
  out->has_normal = true;
  out->binormal = cag_scaled(cross, 1 / area);
  out->normal = cag_cross(out->binormal, out->tangent);
  out->torsion = c->dimension == 2 ? 0 : cag_dot(cross, d[3]) / (area * area);
  return CAG_OK;
}

// Frame from the leading powers: along s^m, sideways s^n, out of the plane s^q.
static CagStatus singular_frame(const CagCurve *c, double t, CagFrenet *out, CagError *err) {
  CagVec3 d[CAG_MAX_DERIVATIVE + 1];
  CagSide side = CAG_SIDE_RIGHT;
  CagStatus status = cag_curve_eval(c, t, CAG_MAX_DERIVATIVE, side, d, err);
  if (status) return status;
  side_of(c, t, &side, err);
  const double s = side == CAG_SIDE_LEFT ? -1 : 1;
  const double size = size_of(c);
  const int m = first_direction(c, d);
  char text[32];
  if (m == 0) return fail_tangent(err, t);
  CagVec3 along = cag_unit(d[m]);
  out->tangent = cag_scaled(along, s < 0 && m % 2 == 0 ? -1 : 1);
  int n = m + 1;
  CagVec3 v = {0, 0, 0};
  for (; n <= CAG_MAX_DERIVATIVE; n++) {
    v = across(d[n], along);
    if (!vanishes(c, v, n, size)) break;
  }
  if (n > 2 * m || n > CAG_MAX_DERIVATIVE) return CAG_OK; // straight, or straight in the limit
  if (n < 2 * m)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_curvature_undefined, "t", -1,
                    "the curve has a cusp at t = %s: its speed is 0 and its curvature infinite "
                    "there",
                    cag_number_text(t, text));
  const double x = cag_norm(d[m]) / factorial(m), y = cag_norm(v) / factorial(n);
  out->curvature = 2 * y / (x * x);
  out->has_normal = true;
  out->normal = cag_unit(v); // n = 2 m is even: the same from both sides
  out->binormal = cag_cross(out->tangent, out->normal);
  if (c->dimension == 2) return CAG_OK;
  CagVec3 up = cag_cross(along, out->normal);
  for (int q = n + 1; q <= 3 * m && q <= CAG_MAX_DERIVATIVE; q++) {
    double z = cag_dot(d[q], up);
    if (vanishes(c, cag_scaled(up, z), q, size)) continue;
    if (q < 3 * m)
      return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_torsion_undefined, "t", -1,
                      "the speed is 0 at t = %s and the torsion infinite there",
                      cag_number_text(t, text));
    out->torsion = 6 * z / factorial(q) / (out->curvature * x * x * x);
  }
  return CAG_OK;
}

CagStatus cag_curve_frenet(const CagCurve *c, double t, CagFrenet *out, CagError *err) {
  CagVec3 d[4];
  CagFrenet r;
  memset(&r, 0, sizeof r);
  CagStatus status = cag_curve_eval(c, t, 3, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  r.point = d[0];
  const double length = c->end - c->start, speed = cag_norm(d[1]);
  const bool regular =
      speed > SUSPECT * fmax(cag_norm(d[2]) * length, cag_norm(d[3]) * length * length) &&
      speed > 0;
  if (regular || (speed > 0 && !vanishes(c, d[1], 1, size_of(c))))
    status = regular_frame(c, t, d, &r);
  else status = singular_frame(c, t, &r, err);
  if (!status) *out = r;
  return status;
}
