// Recognition of carriers (see recognized_fit.h).

#include "geom/solid/recognized_fit.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/linalg/dense.h"

// An eigenvalue is zero below this fraction of the largest one.
#define ZERO_EIGEN 1e-9
// The sine of the half angle of a cone, below which it is a cylinder.
#define UPRIGHT 1e-7
// A normal may differ from that of the carrier by at most this angle (radians): facets are inclined.
#define INCLINED 0.6
// A point is an apex or a pole if the carrier is thinner there than this multiple of the tolerance.
#define APEX 100

typedef struct Samples {
  const CagVec3 *points, *normals;
  size_t n;
  double most;
} Samples;

CagTransform cag_recognized_frame(CagVec3 origin, CagVec3 z) {
  const CagVec3 off = fabs(z.x) < 0.6 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  const CagVec3 x = cag_unit(cag_sub(off, cag_scaled(z, cag_dot(off, z)))), y = cag_cross(z, x);
  const CagVec3 columns[4] = {x, y, z, origin};
  CagTransform t = cag_transform_identity();
  t.planar = false;
  for (int k = 0; k < 4; k++) {
    t.m[0][k] = columns[k].x;
    t.m[1][k] = columns[k].y;
    t.m[2][k] = columns[k].z;
  }
  return t;
}

// Whether all points are on a carrier, with about its normals, or all with the opposite ones.
static CagStatus samples_agree(const Samples *s, const CagCarrier *c, bool *agree, CagError *err) {
  const double near[2] = {0, 0};
  CagStatus status = CAG_OK;
  double side = 0;
  *agree = true;
  for (size_t i = 0; !status && *agree && i < s->n; i++) {
    double uv[2];
    CagCarrierPoint at;
    CagVec3 normal;
    cag_carrier_parameters(c, s->points[i], near, uv);
    status = cag_carrier_eval(c, uv[0], uv[1], &at, err);
    if (!status) status = cag_carrier_normal(c, uv[0], uv[1], &normal, err);
    if (status) break;
    *agree = cag_norm(cag_sub(at.point, s->points[i])) <= s->most;
    const double turn = cag_dot(normal, s->normals[i]);
    if (cag_norm(normal) == 0 || cag_norm(at.du) <= APEX * s->most) continue; // an apex or a pole
    if (side == 0) side = turn < 0 ? -1 : 1;
    *agree = *agree && side * turn >= cos(INCLINED);
  }
  return status;
}

static CagVec3 mean_of(const CagVec3 *v, size_t n) {
  CagVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < n; i++) sum = cag_add(sum, v[i]);
  return cag_scaled(sum, 1 / (double)n);
}

// The unit vector along which vectors vary least about `center`; false: not unique.
static CagStatus least_spread(const CagVec3 *v, size_t n, CagVec3 center, CagVec3 *out, bool *found,
                              CagError *err) {
  double a[9] = {0}, values[3];
  for (size_t i = 0; i < n; i++) {
    const CagVec3 d = cag_sub(v[i], center);
    const double x[3] = {d.x, d.y, d.z};
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++) a[3 * r + c] += x[r] * x[c];
  }
  CagStatus status = cag_symmetric_eigen(a, 3, values, err);
  if (status) return status;
  *out = cag_vec3(a[0], a[1], a[2]);
  *found = values[1] > ZERO_EIGEN * values[2] && values[2] > 0;
  return CAG_OK;
}

// --- Kinds ---

static CagStatus fit_plane(const Samples *s, CagCarrier *out, CagError *err) {
  CagVec3 z = cag_unit(mean_of(s->normals, s->n)), least;
  bool found;
  const CagVec3 middle = mean_of(s->points, s->n);
  CagStatus status = least_spread(s->points, s->n, middle, &least, &found, err);
  if (status) return status;
  if (found) z = cag_dot(least, z) < 0 ? cag_scaled(least, -1) : least;
  *out = (CagCarrier){.kind = CAG_CARRIER_PLANE, .frame = cag_recognized_frame(middle, z)};
  return CAG_OK;
}

// The circle through points of a plane: |p|^2 = 2 c . p + d, by least squares. False: none.
static CagStatus fit_circle(const double (*xy)[2], size_t n, double center[2], double *radius,
                            bool *found, CagError *err) {
  double *a = cag_malloc((4 * n + 4) * sizeof *a), scale = 0;
  *found = false;
  if (!a) return cag_fail_memory(err);
  double *right = a + 3 * n;
  const double x0 = xy[0][0], y0 = xy[0][1];
  for (size_t i = 0; i < n; i++) scale = fmax(scale, hypot(xy[i][0] - x0, xy[i][1] - y0));
  for (size_t i = 0; i < n; i++) {
    const double x = (xy[i][0] - x0) / scale, y = (xy[i][1] - y0) / scale;
    a[i] = 2 * x, a[n + i] = 2 * y, a[2 * n + i] = 1;
    right[i] = x * x + y * y;
  }
  CagStatus status =
      n >= 3 && scale > 0 ? cag_least_squares(a, n, 3, right, n, 1, NULL, err) : CAG_OK;
  if (!status && n >= 3 && scale > 0) {
    const double square = right[2] + right[0] * right[0] + right[1] * right[1];
    center[0] = x0 + scale * right[0];
    center[1] = y0 + scale * right[1];
    *radius = scale * sqrt(square);
    *found = square > 0 && isfinite(*radius) && fabs(a[2 * n + 2]) > ZERO_EIGEN;
  }
  cag_free(a);
  return status;
}

static CagStatus fit_sphere(const Samples *s, CagCarrier *out, CagError *err) {
  const size_t n = s->n;
  const CagVec3 from = s->points[0];
  double scale = 0, *a = cag_malloc((5 * n + 5) * sizeof *a);
  if (!a) return cag_fail_memory(err);
  double *right = a + 4 * n;
  for (size_t i = 0; i < n; i++) scale = fmax(scale, cag_norm(cag_sub(s->points[i], from)));
  for (size_t i = 0; i < n && scale > 0; i++) {
    const CagVec3 p = cag_scaled(cag_sub(s->points[i], from), 1 / scale);
    a[i] = 2 * p.x, a[n + i] = 2 * p.y, a[2 * n + i] = 2 * p.z, a[3 * n + i] = 1;
    right[i] = cag_dot(p, p);
  }
  CagStatus status =
      n >= 4 && scale > 0 ? cag_least_squares(a, n, 4, right, n, 1, NULL, err) : CAG_OK;
  if (!status && n >= 4 && scale > 0 && fabs(a[3 * n + 3]) > ZERO_EIGEN) {
    const CagVec3 c = cag_vec3(right[0], right[1], right[2]);
    const double square = right[3] + cag_dot(c, c);
    if (square > 0 && isfinite(square))
      *out =
          (CagCarrier){.kind = CAG_CARRIER_SPHERE,
                       .a = scale * sqrt(square),
                       .frame = cag_recognized_frame(cag_madd(from, scale, c), cag_vec3(0, 0, 1))};
  }
  cag_free(a);
  return status;
}

// The coordinates of the points across an axis.
static CagStatus across_axis(const Samples *s, const CagTransform *frame, double (**out)[2],
                             CagError *err) {
  const CagVec3 o = cag_frame_column(frame, 3);
  *out = cag_malloc((s->n + 1) * sizeof **out);
  if (!*out) return cag_fail_memory(err);
  for (size_t i = 0; i < s->n; i++) {
    const CagVec3 d = cag_sub(s->points[i], o);
    (*out)[i][0] = cag_dot(d, cag_frame_column(frame, 0));
    (*out)[i][1] = cag_dot(d, cag_frame_column(frame, 1));
  }
  return CAG_OK;
}

static CagStatus fit_cylinder(const Samples *s, CagVec3 axis, CagCarrier *out, CagError *err) {
  CagTransform frame = cag_recognized_frame(s->points[0], axis);
  double(*xy)[2], center[2], radius;
  bool found;
  CagStatus status = across_axis(s, &frame, &xy, err);
  if (!status) status = fit_circle((const double(*)[2])xy, s->n, center, &radius, &found, err);
  cag_free(xy);
  if (status || !found) return status;
  const CagVec3 o = cag_madd(cag_madd(s->points[0], center[0], cag_frame_column(&frame, 0)),
                             center[1], cag_frame_column(&frame, 1));
  *out = (CagCarrier){
      .kind = CAG_CARRIER_CYLINDER, .a = radius, .frame = cag_recognized_frame(o, axis)};
  return CAG_OK;
}

// The tangent planes of a cone pass through its apex.
static CagStatus fit_cone(const Samples *s, CagVec3 axis, double slope, CagCarrier *out,
                          CagError *err) {
  const size_t n = s->n;
  const CagVec3 from = s->points[0];
  double *a = cag_malloc((4 * n + 4) * sizeof *a);
  if (!a) return cag_fail_memory(err);
  double *right = a + 3 * n;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 m = s->normals[i];
    a[i] = m.x, a[n + i] = m.y, a[2 * n + i] = m.z;
    right[i] = cag_dot(m, cag_sub(s->points[i], from));
  }
  CagStatus status = n >= 3 ? cag_least_squares(a, n, 3, right, n, 1, NULL, err) : CAG_OK;
  if (!status && n >= 3 && fabs(a[2 * n + 2]) > ZERO_EIGEN) {
    const CagVec3 apex = cag_add(from, cag_vec3(right[0], right[1], right[2]));
    const CagVec3 middle = cag_sub(mean_of(s->points, n), apex);
    // The z axis leads from the apex into the cone.
    if (cag_dot(middle, axis) < 0) axis = cag_scaled(axis, -1);
    const double angle = asin(fmin(fabs(slope), 1)), level = cag_dot(middle, axis);
    if (level > 0 && isfinite(level))
      *out = (CagCarrier){.kind = CAG_CARRIER_CONE,
                          .a = level * tan(angle),
                          .b = angle,
                          .frame = cag_recognized_frame(cag_madd(apex, level, axis), axis)};
  }
  cag_free(a);
  return status;
}

// The line that all normals meet: (p x n) . a + n . m = 0, where m is the moment of the axis a.
static CagStatus meeting_axis(const Samples *s, CagVec3 *axis, CagVec3 *through, bool *found,
                              CagError *err) {
  const CagVec3 from = mean_of(s->points, s->n);
  double a[36] = {0}, values[6], scale = 0;
  for (size_t i = 0; i < s->n; i++) scale = fmax(scale, cag_norm(cag_sub(s->points[i], from)));
  for (size_t i = 0; i < s->n; i++) {
    const CagVec3 n = s->normals[i];
    const CagVec3 m = cag_scaled(cag_cross(cag_sub(s->points[i], from), n), 1 / scale);
    const double row[6] = {m.x, m.y, m.z, n.x, n.y, n.z};
    for (int r = 0; r < 6; r++)
      for (int c = 0; c < 6; c++) a[6 * r + c] += row[r] * row[c];
  }
  CagStatus status = cag_symmetric_eigen(a, 6, values, err);
  if (status) return status;
  const CagVec3 z = cag_vec3(a[0], a[1], a[2]), moment = cag_vec3(a[3], a[4], a[5]);
  const double length = cag_norm(z);
  *found = values[1] > ZERO_EIGEN * values[5] && length > ZERO_EIGEN;
  if (!*found) return CAG_OK;
  *axis = cag_scaled(z, 1 / length);
  *through = cag_madd(from, scale / (length * length), cag_cross(z, moment));
  return CAG_OK;
}

static CagStatus fit_torus(const Samples *s, CagCarrier *out, CagError *err) {
  CagVec3 axis, through;
  bool found;
  double center[2], radius;
  CagStatus status = meeting_axis(s, &axis, &through, &found, err);
  if (status || !found) return status;
  double(*rz)[2] = cag_malloc((s->n + 1) * sizeof *rz);
  if (!rz) return cag_fail_memory(err);
  for (size_t i = 0; i < s->n; i++) {
    const CagVec3 d = cag_sub(s->points[i], through);
    rz[i][1] = cag_dot(d, axis);
    rz[i][0] = cag_norm(cag_madd(d, -rz[i][1], axis));
  }
  status = fit_circle((const double(*)[2])rz, s->n, center, &radius, &found, err);
  cag_free(rz);
  if (status || !found || !(center[0] > 0)) return status;
  *out = (CagCarrier){.kind = CAG_CARRIER_TORUS,
                      .a = center[0],
                      .b = radius,
                      .frame = cag_recognized_frame(cag_madd(through, center[1], axis), axis)};
  return CAG_OK;
}

static CagStatus fit_turned(const Samples *s, CagCarrier *out, CagError *err) {
  const CagVec3 middle = mean_of(s->normals, s->n);
  CagVec3 axis;
  bool found;
  CagStatus status = least_spread(s->normals, s->n, middle, &axis, &found, err);
  if (status || !found) return status;
  const double slope = cag_dot(axis, middle);
  if (fabs(slope) <= UPRIGHT) return fit_cylinder(s, axis, out, err);
  return fit_cone(s, axis, slope, out, err);
}

CagStatus cag_recognized_fit(const CagVec3 *points, const CagVec3 *normals, size_t n, double most,
                             CagCarrier *out, CagError *err) {
  static CagStatus (*const FITS[])(const Samples *s, CagCarrier *out,
                                   CagError *err) = {fit_plane, fit_turned, fit_sphere, fit_torus};
  const Samples s = {points, normals, n, most};
  CagStatus status = CAG_OK;
  *out = (CagCarrier){.kind = CAG_CARRIER_NONE};
  for (size_t k = 0; !status && n >= 3 && k < sizeof FITS / sizeof *FITS; k++) {
    CagCarrier c = {.kind = CAG_CARRIER_NONE};
    bool agree;
    status = cag_stop_check(err);
    if (!status) status = FITS[k](&s, &c, err);
    if (status || c.kind == CAG_CARRIER_NONE) continue;
    status = samples_agree(&s, &c, &agree, err);
    if (status || !agree) continue;
    *out = c;
    return CAG_OK;
  }
  return status;
}

// --- Comparison ---

bool cag_recognized_same(const CagCarrier *a, const CagCarrier *b, double size, double most) {
  if (a->kind != b->kind || !cag_carrier_is_analytic(a)) return false;
  const CagVec3 z = cag_frame_column(&a->frame, 2), other = cag_frame_column(&b->frame, 2);
  const CagVec3 off = cag_sub(cag_frame_column(&b->frame, 3), cag_frame_column(&a->frame, 3));
  if (a->kind == CAG_CARRIER_SPHERE) return cag_norm(off) <= most && fabs(a->a - b->a) <= most;
  if (cag_norm(cag_cross(z, other)) * size > most) return false;
  const double along = cag_dot(off, z);
  if (a->kind == CAG_CARRIER_PLANE) return fabs(along) <= most;
  if (cag_norm(cag_madd(off, -along, z)) > most) return false;
  if (a->kind == CAG_CARRIER_TORUS)
    return fabs(along) <= most && fabs(a->a - b->a) <= most && fabs(a->b - b->b) <= most;
  if (a->kind == CAG_CARRIER_CYLINDER) return fabs(a->a - b->a) <= most;
  return cag_dot(z, other) > 0 && fabs(a->b - b->b) * size <= most &&
         fabs(a->a + along * tan(a->b) - b->a) <= most;
}
