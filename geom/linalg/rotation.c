// Conversion of Euler angles, roll-pitch-yaw, and quaternions to rotations and back.
//
// Matrices are divided by their scale first, so that similarities without reflection are accepted.
// Arctangents of two arguments are used throughout: angles near 0 or 180 degrees lose no accuracy.

#include <string.h>

#include "geom/linalg/tolerance.h"
#include "geom/linalg/transform.h"

// Cosine (or sine) of the middle angle below which the outer two axes are parallel (Shuster 1993, A
// survey of attitude representations).
#define GIMBAL 1e-10
// Accepted deviation from a rigid motion: rounding of a chain of products.
#define RIGID CAG_COINCIDENT

static CagStatus fail_not_finite(const char *name, CagError *err) {
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, name, -1, "`%s` is not a finite number",
                  name);
}

static void turn(int axis, double angle, CagTransform *t) {
  double s, c;
  cag_sincos(angle, &s, &c);
  int i = (axis + 1) % 3, j = (axis + 2) % 3;
  CagTransform r = cag_transform_identity();
  r.planar = false;
  r.m[i][i] = r.m[j][j] = c;
  r.m[j][i] = s;
  r.m[i][j] = -s + 0.0;
  *t = cag_transform_multiply(t, &r);
}

// Axis numbers of an order such as "zyx": all 12 in which neighbors differ.
static CagStatus read_order(const char *order, int axes[3], CagError *err) {
  bool good = order && strlen(order) == 3;
  for (int i = 0; good && i < 3; i++) {
    axes[i] = order[i] - 'x';
    good = axes[i] >= 0 && axes[i] <= 2 && (i == 0 || axes[i] != axes[i - 1]);
  }
  if (good) return CAG_OK;
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_euler_order, "order", -1,
      "`order` must name three axes of which neighbors differ, such as \"zyx\" or \"zyz\", found \"%s\"",
      order ? order : "");
}

CagStatus cag_euler(double a, double b, double c, const char *order, CagTransform *out,
                    CagError *err) {
  int axes[3];
  CagStatus status = read_order(order, axes, err);
  if (status) return status;
  if (!isfinite(a)) return fail_not_finite("a", err);
  if (!isfinite(b)) return fail_not_finite("b", err);
  if (!isfinite(c)) return fail_not_finite("c", err);
  CagTransform t = cag_transform_identity();
  turn(axes[0], a, &t);
  turn(axes[1], b, &t);
  turn(axes[2], c, &t);
  *out = t;
  return CAG_OK;
}

CagTransform cag_rpy(double roll, double pitch, double yaw) {
  CagTransform t = cag_transform_identity();
  turn(2, yaw, &t);
  turn(1, pitch, &t);
  turn(0, roll, &t);
  return t;
}

CagStatus cag_quaternion(const double wxyz[4], CagTransform *out, CagError *err) {
  double size = 0;
  for (int i = 0; i < 4; i++) {
    if (!isfinite(wxyz[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "quaternion", i,
                      "the quaternion has a part that is not a finite number");
    size = fmax(size, fabs(wxyz[i]));
  }
  if (size == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_quaternion, "quaternion", -1,
                    "the quaternion [0, 0, 0, 0] is not a rotation; the identity is [1, 0, 0, 0]");
  double w = wxyz[0] / size, x = wxyz[1] / size, y = wxyz[2] / size, z = wxyz[3] / size;
  double n = w * w + x * x + y * y + z * z;
  *out = (CagTransform){
      {{(w * w + x * x - y * y - z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n, 0},
       {2 * (x * y + w * z) / n, (w * w - x * x + y * y - z * z) / n, 2 * (y * z - w * x) / n, 0},
       {2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, (w * w - x * x - y * y + z * z) / n, 0},
       {0, 0, 0, 1}},
      false};
  return CAG_OK;
}

// --- Decomposition ---

// The rotation of a similarity without reflection.
static CagStatus rotation_part(const CagTransform *t, double r[3][3], CagError *err) {
  double scale, w = t->m[3][3];
  if (!cag_transform_is_similarity(t, &scale)) {
    // More rounding is accepted than by is_similarity, for long chains of products.
    CagVec3 c[3];
    for (int j = 0; j < 3; j++) c[j] = cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
    double aa = cag_dot(c[0], c[0]);
    bool near = cag_transform_is_affine(t) && aa > 0;
    for (int j = 0; near && j < 3; j++)
      near = fabs(cag_dot(c[j], c[j]) - aa) <= RIGID * aa &&
             fabs(cag_dot(c[j], c[(j + 1) % 3])) <= RIGID * aa;
    if (!near)
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_not_a_rotation, "T", -1,
          "the linear part of the transform is not a rotation: its axes are not perpendicular or not of equal length");
    scale = sqrt(aa) / fabs(w);
  }
  if (cag_transform_mirrors(t))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_a_rotation, "T", -1,
                    "the transform contains a reflection, so it has no rotation part");
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) r[i][j] = scale * w == 1 ? t->m[i][j] : t->m[i][j] / (scale * w);
  return CAG_OK;
}

CagStatus cag_euler_of(const CagTransform *t, const char *order, double abc[3], bool *singular,
                       CagError *err) {
  int axes[3];
  double r[3][3];
  CagStatus status = read_order(order, axes, err);
  if (!status) status = rotation_part(t, r, err);
  if (status) return status;
  const int i = axes[0], j = axes[1], k = 3 - i - j;
  const double e = (j - i + 3) % 3 == 1 ? 1 : -1;
  double across;
  if (axes[2] == i) {
    // R_i(a) R_j(b) R_i(c), b in [0, 180deg].
    across = hypot(r[i][j], r[i][k]);
    abc[0] = atan2(r[j][i], -e * r[k][i]);
    abc[1] = atan2(across, r[i][i]);
    abc[2] = atan2(r[i][j], e * r[i][k]);
  } else {
    // R_i(a) R_j(b) R_k(c), b in [-90deg, 90deg].
    across = hypot(r[i][i], r[i][j]);
    abc[0] = atan2(-e * r[j][k], r[k][k]);
    abc[1] = atan2(e * r[i][k], across);
    abc[2] = atan2(-e * r[i][j], r[i][i]);
  }
  *singular = across < GIMBAL;
  if (*singular) {
    abc[0] = atan2(e * r[k][j], r[j][j]);
    abc[2] = 0;
  }
  for (int n = 0; n < 3; n++) abc[n] += 0.0; // no negative zero
  return CAG_OK;
}

CagStatus cag_rpy_of(const CagTransform *t, double rpy[3], bool *singular, CagError *err) {
  double r[3][3];
  CagStatus status = rotation_part(t, r, err);
  if (status) return status;
  double across = hypot(r[0][0], r[1][0]);
  *singular = across < GIMBAL;
  rpy[0] = *singular ? atan2(-r[1][2], r[1][1]) : atan2(r[2][1], r[2][2]);
  rpy[1] = atan2(-r[2][0], across);
  rpy[2] = *singular ? 0 : atan2(r[1][0], r[0][0]);
  for (int n = 0; n < 3; n++) rpy[n] += 0.0;
  return CAG_OK;
}

// Shepperd's method: the largest of the four parts is found first, the others by division.
CagStatus cag_quaternion_of(const CagTransform *t, double wxyz[4], CagError *err) {
  double r[3][3];
  CagStatus status = rotation_part(t, r, err);
  if (status) return status;
  double trace = r[0][0] + r[1][1] + r[2][2], q[4];
  int i = 0;
  for (int n = 1; n < 3; n++)
    if (r[n][n] > r[i][i]) i = n;
  if (trace >= r[i][i]) {
    q[0] = sqrt(1 + trace) / 2;
    q[1] = (r[2][1] - r[1][2]) / (4 * q[0]);
    q[2] = (r[0][2] - r[2][0]) / (4 * q[0]);
    q[3] = (r[1][0] - r[0][1]) / (4 * q[0]);
  } else {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    q[1 + i] = sqrt(fmax(0, 1 + r[i][i] - r[j][j] - r[k][k])) / 2;
    q[0] = (r[k][j] - r[j][k]) / (4 * q[1 + i]);
    q[1 + j] = (r[j][i] + r[i][j]) / (4 * q[1 + i]);
    q[1 + k] = (r[k][i] + r[i][k]) / (4 * q[1 + i]);
  }
  double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (q[0] < 0) n = -n;
  for (int m = 0; m < 4; m++) wxyz[m] = q[m] / n + 0.0;
  return CAG_OK;
}

CagStatus cag_axis_angle_of(const CagTransform *t, CagVec3 *axis, double *angle, bool *singular,
                            CagError *err) {
  double q[4];
  CagStatus status = cag_quaternion_of(t, q, err);
  if (status) return status;
  CagVec3 v = {q[1], q[2], q[3]};
  double s = cag_norm(v);
  *singular = s == 0;
  *axis = *singular ? cag_vec3(0, 0, 1) : cag_unit(v);
  *angle = 2 * atan2(s, q[0]);
  // A half turn has two axes: choose the one whose first nonzero component is positive.
  double first = v.x != 0 ? v.x : v.y != 0 ? v.y : v.z;
  if (q[0] == 0 && first < 0) *axis = cag_scaled(*axis, -1);
  return CAG_OK;
}

static CagStatus require_rigid(const CagTransform *t, const char *name, CagError *err) {
  double scale;
  if (cag_transform_is_similarity(t, &scale) && fabs(scale - 1) <= RIGID &&
      !cag_transform_mirrors(t))
    return CAG_OK;
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_not_rigid, name, -1,
      "only rigid motions can be interpolated; this transform scales, shears, mirrors, or projects");
}

CagStatus cag_transform_mix(const CagTransform *a, const CagTransform *b, double t,
                            CagTransform *out, CagError *err) {
  // Angle below which slerp and linear interpolation agree to rounding.
  const double straight = 1e-8;
  double p[4], q[4], m[4];
  if (!isfinite(t)) return fail_not_finite("t", err);
  CagStatus status = require_rigid(a, "T", err);
  if (!status) status = require_rigid(b, "T", err);
  if (!status) status = cag_quaternion_of(a, p, err);
  if (!status) status = cag_quaternion_of(b, q, err);
  if (status) return status;
  double dot = 0, sum = 0, difference = 0;
  for (int i = 0; i < 4; i++) dot += p[i] * q[i];
  for (int i = 0; i < 4; i++) {
    if (dot < 0) q[i] = -q[i];
    sum += (p[i] + q[i]) * (p[i] + q[i]);
    difference += (p[i] - q[i]) * (p[i] - q[i]);
  }
  double angle = 2 * atan2(sqrt(difference), sqrt(sum));
  for (int i = 0; i < 4; i++)
    m[i] = angle < straight ? p[i] + t * (q[i] - p[i])
                            : (sin((1 - t) * angle) * p[i] + sin(t * angle) * q[i]) / sin(angle);
  CagTransform r;
  status = cag_quaternion(m, &r, err);
  if (status) return status;
  for (int i = 0; i < 3; i++) {
    double from = a->m[i][3] / a->m[3][3], to = b->m[i][3] / b->m[3][3];
    r.m[i][3] = from + t * (to - from);
  }
  r.planar = a->planar && b->planar;
  *out = r;
  return CAG_OK;
}
