// The map of a camera: from its matrix, to pixels and back.

#include "geom/camera/camera.h"

#include <string.h>

#include "geom/linalg/tolerance.h"

// --- Rows ---

static CagVec3 row_vector(const double row[4]) { return cag_vec3(row[0], row[1], row[2]); }

static CagVec3 inverse_times(const double m[3][3], CagVec3 v) {
  return cag_vec3(m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
                  m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                  m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z);
}

// Inverts the matrix of these rows. Returns false if they are dependent.
static bool invert_rows(CagVec3 a, CagVec3 b, CagVec3 c, double out[3][3]) {
  const CagVec3 columns[3] = {cag_cross(b, c), cag_cross(c, a), cag_cross(a, b)};
  const double det = cag_dot(a, columns[0]);
  if (!(fabs(det) > CAG_ROUNDING * cag_norm(a) * cag_norm(b) * cag_norm(c))) return false;
  for (int j = 0; j < 3; j++) {
    out[0][j] = columns[j].x / det;
    out[1][j] = columns[j].y / det;
    out[2][j] = columns[j].z / det;
  }
  return true;
}

CagStatus cag_camera_map(const double rows[3][4], CagCameraMap *out, CagError *err) {
  CagCameraMap c = {.has_depth = true};
  const CagVec3 forward = row_vector(rows[2]);
  // Without overflow of the squares.
  const double largest = fmax(fabs(forward.x), fmax(fabs(forward.y), fabs(forward.z)));
  const double length = largest > 0 ? largest * cag_norm(cag_scaled(forward, 1 / largest)) : 0;
  const double scale = length > 0 ? length : rows[2][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) c.p[i][j] = rows[i][j] / scale + 0.0; // never -0
  const CagVec3 right = row_vector(c.p[0]), down = row_vector(c.p[1]);
  c.parallel = length == 0;
  c.view = c.parallel ? cag_unit(cag_cross(right, down)) : row_vector(c.p[2]);
  if (!(scale != 0) || !invert_rows(right, down, c.view, c.inverse))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_camera_singular, "C", -1,
                    "expected a camera matrix whose left 3 columns are independent (or, of a "
                    "parallel projection, two independent rows above 0 0 0 1)");
  c.has_depth = !c.parallel;
  if (!c.parallel)
    c.center = cag_scaled(inverse_times(c.inverse, cag_vec3(c.p[0][3], c.p[1][3], c.p[2][3])), -1);
  *out = c;
  return CAG_OK;
}

CagStatus cag_camera_map_of_parts(const CagCameraParts *parts, CagVec3 eye, bool parallel,
                                  double start, CagCameraMap *out, CagError *err) {
  const double(*k)[3] = parts->k, (*r)[3] = parts->r;
  const double at[3] = {eye.x, eye.y, eye.z};
  CagCameraMap c = {.parallel = parallel, .has_depth = true, .center = eye, .start = start};
  c.view = cag_vec3(r[2][0], r[2][1], r[2][2]);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      c.p[i][j] = parallel ? 0 : k[i][2] * r[2][j];
      for (int m = i; m < 2; m++) c.p[i][j] += k[i][m] * r[m][j];
    }
    c.p[i][3] = parallel ? k[i][2] : 0;
    for (int j = 0; j < 3; j++) c.p[i][3] -= c.p[i][j] * at[j];
    for (int j = 0; j < 4; j++) c.p[i][j] += 0.0; // never -0
  }
  if (parallel) c.start = cag_dot(c.view, eye);
  *out = c;
  if (invert_rows(row_vector(c.p[0]), row_vector(c.p[1]), c.view, out->inverse)) return CAG_OK;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_camera_singular, "C", -1,
                  "the camera is too narrow to measure");
}

// --- Projection ---

bool cag_camera_project(const CagCameraMap *c, CagVec3 point, double pixel[2], double *depth) {
  double h[3];
  for (int i = 0; i < 3; i++) h[i] = cag_dot(row_vector(c->p[i]), point) + c->p[i][3];
  const double along = c->parallel ? cag_dot(c->view, point) : h[2];
  if (c->parallel ? c->has_depth && along < c->start : !(h[2] > 0)) return false;
  for (int i = 0; i < 2; i++) pixel[i] = h[i] / h[2];
  if (c->has_depth) *depth = along - c->start;
  return true;
}

void cag_camera_sight(const CagCameraMap *c, const double pixel[2], CagVec3 *origin,
                      CagVec3 *direction) {
  if (c->parallel) {
    *direction = c->view;
    *origin =
        inverse_times(c->inverse, cag_vec3(pixel[0] - c->p[0][3], pixel[1] - c->p[1][3], c->start));
    return;
  }
  *origin = c->center;
  *direction = cag_unit(inverse_times(c->inverse, cag_vec3(pixel[0], pixel[1], 1)));
}

bool cag_camera_on_plane(const CagCameraMap *c, const double pixel[2], const CagPlane *plane,
                         CagVec3 *out) {
  CagVec3 origin, direction;
  cag_camera_sight(c, pixel, &origin, &direction);
  const double slope = cag_dot(plane->normal, direction);
  if (fabs(slope) < CAG_PARALLEL) return false;
  const double s = cag_dot(plane->normal, cag_sub(plane->point, origin)) / slope;
  // The center itself is not in front; the plane of depth 0 of a parallel projection is visible.
  if (c->parallel ? c->has_depth && s < 0 : !(s > 0)) return false;
  *out = cag_madd(origin, s, direction);
  return true;
}

// --- Parts ---

static void set_row(double row[3], CagVec3 v) {
  row[0] = v.x + 0.0, row[1] = v.y + 0.0, row[2] = v.z + 0.0; // never -0
}

void cag_camera_split(const CagCameraMap *c, CagCameraParts *out) {
  const CagVec3 first = row_vector(c->p[0]), second = row_vector(c->p[1]);
  const CagVec3 forward = c->view;
  memset(out, 0, sizeof *out);
  // The rows of P are k00 r0 + k01 r1 + k02 r2, k11 r1 + k12 r2, and r2.
  out->k[0][2] = c->parallel ? c->p[0][3] : cag_dot(first, forward);
  out->k[1][2] = c->parallel ? c->p[1][3] : cag_dot(second, forward);
  out->k[2][2] = 1;
  const CagVec3 flat_second = cag_madd(second, -cag_dot(second, forward), forward);
  out->k[1][1] = cag_norm(flat_second);
  const CagVec3 down = cag_scaled(flat_second, 1 / out->k[1][1]);
  out->k[0][1] = cag_dot(first, down);
  const CagVec3 flat_first =
      cag_madd(cag_madd(first, -cag_dot(first, forward), forward), -out->k[0][1], down);
  out->k[0][0] = cag_norm(flat_first);
  set_row(out->r[0], cag_scaled(flat_first, 1 / out->k[0][0]));
  set_row(out->r[1], down);
  set_row(out->r[2], forward);
}

// --- Stereo ---

CagStatus cag_stereo_point(const CagVec3 origins[2], const CagVec3 directions[2], CagVec3 *point,
                           double *gap, CagError *err) {
  const CagVec3 a = cag_unit(directions[0]), b = cag_unit(directions[1]);
  const CagVec3 normal = cag_cross(a, b), between = cag_sub(origins[1], origins[0]);
  const double square = cag_dot(normal, normal); // of the sine of the angle between the lines
  // 1 - (a . b)^2 < 1e-12, without its cancellation.
  if (!(square >= CAG_ROUNDING))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_parallel_lines, "", -1,
                    "the lines of sight are parallel, so they do not determine a point");
  const double s = cag_dot(cag_cross(between, b), normal) / square;
  const double t = cag_dot(cag_cross(between, a), normal) / square;
  const CagVec3 p = cag_madd(origins[0], s, a), q = cag_madd(origins[1], t, b);
  *point = cag_lerp(p, q, 0.5);
  *gap = cag_norm(cag_sub(q, p));
  return CAG_OK;
}
