// Rigid motions: singular values for the nearest rotation, and the exponential of twists.

#include "geom/linalg/rigid.h"

#include <lapacke.h>
#include <string.h>

#include "base/stop.h"
#include "geom/linalg/tolerance.h"

// A sum of singular values below this fraction of the largest is rounding: the rotation is then not
// unique.
#define NOT_UNIQUE 1e-12
// Angles below which the coefficients of the exponential are computed from their series, whose first
// omitted term is then below the rounding.
#define SMALL_ANGLE 0.05

// --- The nearest orthonormal matrix ---

// Sets r to the orthonormal matrix that maximizes trace(r^T m), among rotations if `proper`.
// *unique is how far from ambiguous it is, relative to m.
static CagStatus nearest_orthonormal(const double m[3][3], bool proper, double r[3][3],
                                     double *unique, CagError *err) {
  double a[9], s[3], u[9], vt[9], rest[2];
  memcpy(a, m, sizeof a);
  if (LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'A', 'A', 3, 3, a, 3, s, u, 3, vt, 3, rest) != 0)
    return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "", -1,
                    "the singular values of the matrix were not found");
  double d = 1;
  if (proper) {
    const CagVec3 *x = (const CagVec3 *)u, *y = (const CagVec3 *)vt;
    d = cag_dot(x[0], cag_cross(x[1], x[2])) * cag_dot(y[0], cag_cross(y[1], y[2])) < 0 ? -1 : 1;
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r[i][j] = u[3 * i] * vt[j] + u[3 * i + 1] * vt[3 + j] + d * u[3 * i + 2] * vt[6 + j];
  *unique = s[0] > 0 ? (proper ? s[1] + d * s[2] : s[2]) / s[0] : 0;
  return CAG_OK;
}

static CagTransform with_linear(const double r[3][3], CagVec3 position, bool planar) {
  CagTransform t = cag_transform_identity();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) t.m[i][j] = r[i][j];
  t.m[0][3] = position.x;
  t.m[1][3] = position.y;
  t.m[2][3] = position.z;
  t.planar = planar;
  return t;
}

CagStatus cag_orthonormal(const CagTransform *t, CagTransform *out, CagError *err) {
  double m[3][3], r[3][3], unique;
  if (!cag_transform_is_affine(t))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_rigid, "T", -1,
                    "expected an affine transform, found a projective one");
  const double w = t->m[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m[i][j] = t->m[i][j] / w;
  CagStatus status = nearest_orthonormal(m, false, r, &unique, err);
  if (status) return status;
  if (!(unique > NOT_UNIQUE))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_singular_transform, "T", -1,
                    "the transform is singular, so no rotation is nearest to it");
  if (t->planar) {
    r[0][2] = r[1][2] = r[2][0] = r[2][1] = 0;
    r[2][2] = 1;
  }
  *out = with_linear(r, cag_vec3(t->m[0][3] / w, t->m[1][3] / w, t->m[2][3] / w), t->planar);
  return CAG_OK;
}

CagStatus cag_mean_rotation(const CagTransform *t, size_t n, CagTransform *out, CagError *err) {
  double sum[3][3] = {{0}}, r[3][3], unique;
  bool planar = true;
  if (n == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "T", -1,
                    "expected at least one transform, found an empty list");
  for (size_t k = 0; k < n; k++) {
    if (cag_stop_check(err)) return err->status;
    if (!cag_transform_is_rigid(&t[k]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_rigid, "T", (long)k,
                      "expected rotations and translations, but transform %zu scales, shears, or "
                      "mirrors; use orthonormal to remove rounding",
                      k);
    planar = planar && t[k].planar;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) sum[i][j] += t[k].m[i][j] / t[k].m[3][3];
  }
  CagStatus status = nearest_orthonormal(sum, true, r, &unique, err);
  if (status) return status;
  double size = 0;
  for (int i = 0; i < 9; i++) size = fmax(size, fabs(sum[i / 3][i % 3]));
  if (!(unique > NOT_UNIQUE) || !(size > NOT_UNIQUE * (double)n))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_underdetermined, "T", -1,
                    "the mean is not unique: several rotations are equally near to the given ones");
  *out = with_linear(r, cag_vec3(0, 0, 0), planar);
  return CAG_OK;
}

// --- The best motion ---

typedef struct Pairs {
  const CagVec3 *points, *images;
  size_t n;
  CagVec3 center, image_center;
} Pairs;

static void find_centers(Pairs *p) {
  p->center = p->image_center = cag_vec3(0, 0, 0);
  const double share = 1 / (double)p->n;
  for (size_t i = 0; i < p->n && !cag_stopped(); i++) {
    p->center = cag_madd(p->center, share, p->points[i]);
    p->image_center = cag_madd(p->image_center, share, p->images[i]);
  }
}

// Sums of the products of the coordinates about the centers, and of the squared distances.
static void find_moments(const Pairs *p, double m[3][3], double *spread, double *image_spread) {
  memset(m, 0, 9 * sizeof(double));
  *spread = *image_spread = 0;
  for (size_t i = 0; i < p->n && !cag_stopped(); i++) {
    const CagVec3 a = cag_sub(p->points[i], p->center), b = cag_sub(p->images[i], p->image_center);
    const double from[3] = {a.x, a.y, a.z}, to[3] = {b.x, b.y, b.z};
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) m[j][k] += to[j] * from[k];
    *spread += cag_dot(a, a);
    *image_spread += cag_dot(b, b);
  }
}

// The rotation for these moments. In the plane it is given by two of their sums.
static CagStatus rotation_for(const double m[3][3], bool planar, double size, double r[3][3],
                              CagError *err) {
  double unique;
  if (!planar) {
    CagStatus status = nearest_orthonormal(m, true, r, &unique, err);
    if (status || unique > NOT_UNIQUE) return status;
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_collinear_points, "points", -1,
                    "the rotation is not unique: the points or their images are collinear, or fit "
                    "equally well in several ways");
  }
  const double c = m[0][0] + m[1][1], s = m[1][0] - m[0][1], length = hypot(c, s);
  if (!(length > NOT_UNIQUE * size))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_underdetermined, "points", -1,
                    "the rotation is not unique: the points fit equally well at every angle");
  memset(r, 0, 9 * sizeof(double));
  r[0][0] = r[1][1] = c / length;
  r[1][0] = s / length;
  r[0][1] = -s / length;
  r[2][2] = 1;
  return CAG_OK;
}

static void measure_motion(const Pairs *p, CagMotionFit *fit) {
  double sum = 0;
  fit->largest = 0;
  for (size_t i = 0; i < p->n && !cag_stopped(); i++) {
    const CagVec3 moved = cag_transform_point(&fit->transform, p->points[i]);
    const double distance = cag_norm(cag_sub(moved, p->images[i]));
    sum += distance * distance / (double)p->n;
    fit->largest = fmax(fit->largest, distance);
  }
  fit->rms = sqrt(sum);
}

static CagStatus check_pairs(size_t n, bool planar, CagError *err) {
  const size_t least = planar ? 2 : 3;
  if (n >= least) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                  "expected at least %zu pairs of points, found %zu", least, n);
}

CagStatus cag_best_motion(const CagVec3 *points, const CagVec3 *images, size_t n, bool planar,
                          bool scale, CagMotionFit *out, CagError *err) {
  double m[3][3], r[3][3], spread, image_spread;
  CagStatus status = check_pairs(n, planar, err);
  if (status) return status;
  Pairs p = {.points = points, .images = images, .n = n};
  find_centers(&p);
  find_moments(&p, m, &spread, &image_spread);
  if (cag_stop_check(err)) return err->status;
  if (!isfinite(spread) || !isfinite(image_spread))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "points", -1,
                    "the distances of the points overflow");
  if (spread == 0 || image_spread == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_coincident_points,
                    spread == 0 ? "points" : "images", -1, "all %s coincide",
                    spread == 0 ? "points" : "images");
  status = rotation_for(m, planar, sqrt(spread) * sqrt(image_spread), r, err);
  if (status) return status;
  *out = (CagMotionFit){.scale = 1};
  if (scale) {
    double trace = 0;
    for (int i = 0; i < 9; i++) trace += r[i / 3][i % 3] * m[i / 3][i % 3];
    out->scale = trace / spread;
    if (planar) r[2][2] = 1; // a map of the plane
    for (int i = 0; i < 9; i++) r[i / 3][i % 3] *= out->scale;
  }
  const CagTransform linear = with_linear(r, cag_vec3(0, 0, 0), planar);
  const CagVec3 position = cag_sub(p.image_center, cag_transform_vector(&linear, p.center));
  out->transform = with_linear(r, position, planar);
  measure_motion(&p, out);
  return cag_stop_check(err);
}

// --- Twists ---

// With W the matrix of w x, and t its length: exp(W) = I + a W + b W^2, and the position of the
// motion is (I + b W + c W^2) v.
static void exponential(double t, double *a, double *b, double *c) {
  const double q = t * t, half = sin(t / 2);
  if (t < SMALL_ANGLE) {
    *a = 1 - q / 6 * (1 - q / 20 * (1 - q / 42 * (1 - q / 72)));
    *b = (1 - q / 12 * (1 - q / 30 * (1 - q / 56 * (1 - q / 90)))) / 2;
    *c = (1 - q / 20 * (1 - q / 42 * (1 - q / 72 * (1 - q / 110)))) / 6;
    return;
  }
  *a = sin(t) / t;
  *b = 2 * half * half / q;
  *c = (1 - *a) / q;
}

// v + x (w x v) + y (w x (w x v))
static CagVec3 combined(CagVec3 w, double x, double y, CagVec3 v) {
  const CagVec3 first = cag_cross(w, v);
  return cag_madd(cag_madd(v, x, first), y, cag_cross(w, first));
}

CagStatus cag_motion_of(const double twist[6], CagTransform *out, CagError *err) {
  const CagVec3 v = cag_vec3(twist[0], twist[1], twist[2]);
  const CagVec3 w = cag_vec3(twist[3], twist[4], twist[5]);
  const double angle = hypot(hypot(w.x, w.y), w.z);
  double a, b, c, r[3][3];
  if (!isfinite(angle) || !isfinite(cag_dot(w, w)) || !isfinite(v.x + v.y + v.z))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "twist", -1,
                    "expected 6 finite numbers in `twist`");
  exponential(angle, &a, &b, &c);
  const CagVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int j = 0; j < 3; j++) {
    const CagVec3 image = combined(w, a, b, axes[j]);
    r[0][j] = image.x;
    r[1][j] = image.y;
    r[2][j] = image.z;
  }
  *out = with_linear(r, combined(w, b, c, v), false);
  return CAG_OK;
}

CagStatus cag_twist_of(const CagTransform *t, double twist[6], CagError *err) {
  CagVec3 axis = {0, 0, 0};
  double angle = 0;
  bool still;
  if (!cag_transform_is_rigid(t))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_rigid, "T", -1,
                    "expected a rotation and a translation, but the transform scales, shears, or "
                    "mirrors; use orthonormal to remove rounding");
  CagStatus status = cag_axis_angle_of(t, &axis, &angle, &still, err);
  if (status) return status;
  const CagVec3 w = still ? cag_vec3(0, 0, 0) : cag_scaled(axis, angle);
  const double size = t->m[3][3], q = angle * angle;
  const CagVec3 position = cag_vec3(t->m[0][3] / size, t->m[1][3] / size, t->m[2][3] / size);
  // The inverse of I + b W + c W^2 is I - W / 2 + d W^2.
  double d = (1 + q / 60 * (1 + q / 42 * (1 + q / 40))) / 12;
  if (angle >= SMALL_ANGLE) d = (1 - angle / 2 * cos(angle / 2) / sin(angle / 2)) / q;
  const CagVec3 v = combined(w, -0.5, d, position);
  memcpy(twist, (double[6]){v.x, v.y, v.z, w.x, w.y, w.z}, 6 * sizeof *twist);
  return CAG_OK;
}

// --- Frames ---

// An axis of the half turn between a direction and its opposite.
static CagVec3 half_turn_axis(CagVec3 direction) {
  const CagVec3 d = cag_unit(direction), z = {0, 0, 1};
  const CagVec3 across = cag_madd(z, -d.z, d);
  return cag_norm(across) > CAG_PARALLEL ? across : cag_vec3(1, 0, 0);
}

CagTransform cag_rotation_between(CagVec3 from, CagVec3 to) {
  CagTransform out = cag_transform_identity();
  CagError ignored;
  const CagVec3 a = cag_unit(from), b = cag_unit(to);
  CagVec3 axis = cag_cross(a, b);
  const double sine = cag_norm(axis), cosine = cag_dot(a, b);
  if (sine <= CAG_PARALLEL && cosine > 0) return out;
  if (sine <= CAG_PARALLEL) axis = half_turn_axis(a);
  const double angle = sine <= CAG_PARALLEL ? M_PI : atan2(sine, cosine);
  if (cag_rotate(axis, angle, cag_vec3(0, 0, 0), &out, &ignored)) return cag_transform_identity();
  return out;
}

static CagVec3 column_of(const CagTransform *t, int k) {
  return cag_vec3(t->m[0][k], t->m[1][k], t->m[2][k]);
}

bool cag_frame_image(const CagTransform *map, const CagTransform *frame, CagTransform *out) {
  *out = cag_transform_multiply(map, frame);
  if (!cag_transform_is_affine(out)) return false;
  if (cag_transform_is_rigid(out)) return true;
  const CagVec3 x = column_of(out, 0), y = column_of(out, 1), up = column_of(out, 2);
  CagVec3 z = cag_cross(x, y);
  const double side = cag_dot(z, up);
  if (!(fabs(side) > CAG_ROUNDING * cag_norm(x) * cag_norm(y) * cag_norm(up))) return false;
  z = cag_scaled(cag_unit(z), side > 0 ? 1 : -1);
  const CagVec3 axes[3] = {cag_unit(x), cag_cross(z, cag_unit(x)), z};
  for (int k = 0; k < 3; k++) {
    out->m[0][k] = axes[k].x;
    out->m[1][k] = axes[k].y;
    out->m[2][k] = axes[k].z;
    out->m[k][3] /= out->m[3][3];
  }
  out->m[3][3] = 1;
  return true;
}
