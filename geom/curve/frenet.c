// Frames from derivatives, changes of parameter, the derivative of a moving triad, and contact of a
// curve with a plane.

#include <string.h>

#include "geom/basis/bernstein.h"
#include "geom/curve/family.h"
#include "geom/curve/frenet.h"
#include "geom/linalg/tolerance.h"

// Sine of the angle between derivatives that are parallel up to rounding.
#define PARALLEL 1e-10
// Tolerance for orthonormal vectors.
#define ORTHONORMAL CAG_PARALLEL
// A Taylor term over the whole domain is 0 below this fraction of the curve's size.
#define VANISHES CAG_ROUNDING

CagStatus cag_frenet_of(const CagVec3 d[3], double *speed, CagFrenet *out, CagError *err) {
  memset(out, 0, sizeof *out);
  *speed = cag_norm(d[0]);
  if (!(*speed > 0))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_singular_point, "derivatives", 0,
                    "the first derivative is 0, so the frame is undefined");
  const CagVec3 cross = cag_cross(d[0], d[1]);
  const double area = cag_norm(cross);
  out->tangent = cag_scaled(d[0], 1 / *speed);
  if (area <= PARALLEL * *speed * cag_norm(d[1])) return CAG_OK;
  out->curvature = area / *speed / *speed / *speed;
  out->has_normal = true;
  out->binormal = cag_scaled(cross, 1 / area);
  out->normal = cag_cross(out->binormal, out->tangent);
  out->torsion = cag_dot(out->binormal, d[2]) / area;
  return CAG_OK;
}

// Faa di Bruno's rule by the partial Bell polynomials B(n, k) = sum C(n - 1, i - 1) f_i B(n - i, k
// - 1): the n-th derivative is the sum of B(n, k) d_k.
CagStatus cag_chain_derivatives(const CagVec3 *d, const double *f, int order, CagVec3 *out,
                                CagError *err) {
  double bell[CAG_MAX_DERIVATIVE + 1][CAG_MAX_DERIVATIVE + 1] = {{1}};
  if (f[0] == 0)
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_parameter_stands_still, "by", 0,
        "the first derivative of the old parameter with respect to the new one must not be 0");
  for (int n = 1; n <= order; n++) {
    out[n - 1] = cag_vec3(0, 0, 0);
    for (int k = 1; k <= n; k++) {
      for (int i = 1; i <= n - k + 1; i++)
        bell[n][k] += cag_binomial(n - 1, i - 1) * f[i - 1] * bell[n - i][k - 1];
      out[n - 1] = cag_madd(out[n - 1], bell[n][k], d[k - 1]);
    }
  }
  return CAG_OK;
}

CagStatus cag_triad_derivative(const CagVec3 m[3], const CagVec3 dm[3], double out[3][3],
                               CagError *err) {
  double largest = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      if (!(fabs(cag_dot(m[i], m[j]) - (i == j)) <= ORTHONORMAL))
        return cag_fail(
            err, CAG_E_ARGUMENT, CAG_ERR_frame_not_orthonormal, "triad", i,
            "the three vectors must be unit vectors and perpendicular to each other; vector %d %s",
            i, i == j ? "is not a unit vector" : "is not perpendicular to another one");
      out[i][j] = cag_dot(dm[i], m[j]);
      largest = fmax(largest, fabs(out[i][j]));
    }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j <= i; j++)
      if (!(fabs(out[i][j] + out[j][i]) <= ORTHONORMAL * largest))
        return cag_fail(
            err, CAG_E_ARGUMENT, CAG_ERR_triad_not_rigid, "derivatives", i,
            "with these derivatives, the vectors do not remain orthonormal: those of vectors %d and %d do not agree",
            j, i);
  return CAG_OK;
}

// --- Contact with a plane ---

static double factorial(int n) {
  double f = 1;
  for (int i = 2; i <= n; i++) f *= i;
  return f;
}

typedef struct Leading {
  int power; // 0: none
  double value;
} Leading;

// The first nonzero term of the distance, from the derivatives d[0..order].
static Leading leading_term(const CagCurve *c, const CagVec3 *d, CagVec3 normal, int order) {
  const CagBounds box = c->kind->hull(c, c->start, c->end);
  const double size = cag_norm(cag_sub(box.max, box.min)), length = c->end - c->start;
  for (int k = 1; k <= order; k++) {
    const double x = cag_dot(normal, d[k]);
    const bool small = fabs(x) <= PARALLEL * cag_norm(d[k]) ||
                       fabs(x) * pow(length, k) / factorial(k) <= VANISHES * size;
    if (!small) return (Leading){k, x};
  }
  return (Leading){0, 0};
}

static CagStatus lead(const CagCurve *c, double t, CagSide side, CagVec3 normal, CagVec3 *d,
                      Leading *out, CagError *err) {
  CagStatus status = cag_curve_eval(c, t, 3, side, d, err);
  if (status) return status;
  *out = leading_term(c, d, normal, 3);
  if (out->power > 0) return CAG_OK;
  status = cag_curve_eval(c, t, CAG_MAX_DERIVATIVE, side, d, err);
  if (!status) *out = leading_term(c, d, normal, CAG_MAX_DERIVATIVE);
  return status;
}

static int sign_of(double x) { return (x > 0) - (x < 0); }

CagStatus cag_curve_contact(const CagCurve *c, double t, CagVec3 normal, CagPlaneContact *out,
                            CagError *err) {
  CagVec3 left[CAG_MAX_DERIVATIVE + 1], right[CAG_MAX_DERIVATIVE + 1];
  Leading before, after;
  const CagVec3 n = cag_unit(normal);
  const bool at_start = t <= c->start, at_end = t >= c->end;
  CagStatus status = lead(c, t, at_start ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, n, left, &before, err);
  if (!status) status = lead(c, t, at_end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, n, right, &after, err);
  if (status) return status;
  for (int k = 1; k <= 3; k++) out->c[k] = cag_dot(n, right[k]) / factorial(k);
  out->c[0] = 0;
  // At a knot the curve has the lower of the two orders of contact.
  const int power = before.power == 0                                ? after.power
                    : after.power == 0 || before.power < after.power ? before.power
                                                                     : after.power;
  out->order = power - 1;
  out->before = sign_of(before.value) * (before.power % 2 ? -1 : 1);
  out->after = sign_of(after.value);
  return CAG_OK;
}
