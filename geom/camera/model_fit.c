// Affine and projective fits of a model to its picture.
//
// Points are first shifted to their mean and scaled to a mean distance of sqrt(3) in space and
// sqrt(2) in the picture, which makes the equations well conditioned (Hartley 1997, "In defense of
// the eight-point algorithm").

#include "geom/camera/model_fit.h"

#include <string.h>

#include "base/stop.h"
#include "geom/camera/triangle.h"
#include "geom/linalg/tolerance.h"

#define AFFINE_POINTS 4
#define PROJECTIVE_POINTS 6
// Points between checks of the stop flag.
#define LOOK_UP 4096

// --- Normalization ---

typedef struct Scale {
  CagVec3 mean;
  double factor; // of the normalized points; 0 if all points are one
} Scale;

static CagStatus points_scale(const CagVec3 *points, size_t n, double distance, Scale *out,
                              CagError *err) {
  CagVec3 sum = {0, 0, 0};
  double spread = 0;
  for (size_t i = 0; i < n; i++) sum = cag_madd(sum, 1.0 / (double)n, points[i]);
  for (size_t i = 0; i < n; i++) {
    spread += cag_norm(cag_sub(points[i], sum)) / (double)n;
    if (i % LOOK_UP == 0 && cag_stop_check(err)) return err->status;
  }
  *out = (Scale){sum, spread > 0 ? distance / spread : 0};
  return isfinite(spread) ? CAG_OK
                          : cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "points", -1,
                                     "the points are too far from each other");
}

static CagVec3 scaled_point(const Scale *s, CagVec3 p) {
  return cag_scaled(cag_sub(p, s->mean), s->factor);
}

// Replaces the rows H of normalized points by those of the points themselves: H' = Q^-1 H M with
// M = factor (X - mean) of the model and Q that of the picture.
static void unscale_rows(double h[3][4], const Scale *model, const Scale *picture) {
  const double mean[3] = {model->mean.x, model->mean.y, model->mean.z};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      h[i][j] *= model->factor;
      h[i][3] -= h[i][j] * mean[j];
    }
  for (int j = 0; j < 4; j++) {
    h[0][j] = h[0][j] / picture->factor + picture->mean.x * h[2][j];
    h[1][j] = h[1][j] / picture->factor + picture->mean.y * h[2][j];
  }
}

// --- Checks ---

static CagStatus check_count(size_t n, size_t least, const char *map, CagError *err) {
  if (n >= least) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_model_points, "points", -1,
                  "expected at least %zu points for %s, found %zu", least, map, n);
}

// Collects the rows [x y z 1 | u v] of normalized points, and checks that the points are not in one
// plane: that the first four columns are independent.
static CagStatus affine_triangle(const CagVec3 *points, const CagVec3 *images, size_t n,
                                 const Scale *model, const Scale *picture, CagTriangle *t,
                                 CagError *err) {
  double values[4];
  CagStatus status = CAG_OK;
  cag_triangle_init(t, 6);
  for (size_t i = 0; i < n && !status; i++) {
    const CagVec3 p = scaled_point(model, points[i]), q = scaled_point(picture, images[i]);
    status = cag_triangle_add(t, (double[]){p.x, p.y, p.z, 1, q.x, q.y}, err);
  }
  if (!status) status = cag_triangle_finish(t, err);
  if (!status) status = cag_triangle_singular(t, 4, values, NULL, err);
  if (status || values[3] > CAG_COINCIDENT * values[0]) return status;
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_model_points_coplanar, "points", -1,
                  "expected points that are not all in one plane");
}

// --- Fits ---

CagStatus cag_model_error(const double rows[3][4], const CagVec3 *points, const CagVec3 *images,
                          size_t n, double *error, double *rms, CagError *err) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < n; i++) {
    double h[3];
    for (int k = 0; k < 3; k++)
      h[k] = rows[k][0] * points[i].x + rows[k][1] * points[i].y + rows[k][2] * points[i].z +
             rows[k][3];
    const double distance = hypot(h[0] / h[2] - images[i].x, h[1] / h[2] - images[i].y);
    if (!isfinite(distance))
      return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_point_not_in_front, "points", (long)i,
                      "points[%zu] has an image at infinity", i);
    sum += distance;
    squares += distance * distance;
    if (i % LOOK_UP == 0 && cag_stop_check(err)) return err->status;
  }
  *error = sum;
  *rms = n > 0 ? sqrt(squares / (double)n) : 0;
  return CAG_OK;
}

CagStatus cag_model_fit_affine(const CagVec3 *points, const CagVec3 *images, size_t n,
                               CagModelFit *out, CagError *err) {
  Scale model, picture;
  CagTriangle t;
  CagStatus status = check_count(n, AFFINE_POINTS, "an affine map", err);
  if (!status) status = points_scale(points, n, sqrt(3), &model, err);
  if (!status) status = points_scale(images, n, sqrt(2), &picture, err);
  if (!status) status = affine_triangle(points, images, n, &model, &picture, &t, err);
  if (status) return status;
  // Images at one point are normalized to 0.
  if (picture.factor == 0) picture.factor = 1;
  double rows[3][4] = {{0}, {0}, {0, 0, 0, 1}};
  for (size_t i = 0; i < 2; i++) cag_triangle_solve(&t, 4, 4 + i, rows[i]);
  unscale_rows(rows, &model, &picture);
  memcpy(out->rows, rows, sizeof rows);
  return cag_model_error(rows, points, images, n, &out->error, &out->rms, err);
}

// Two equations for each point: (h1 - u h3) . x = 0 and (h2 - v h3) . x = 0.
static CagStatus projective_triangle(const CagVec3 *points, const CagVec3 *images, size_t n,
                                     const Scale *model, const Scale *picture, CagTriangle *t,
                                     CagError *err) {
  CagStatus status = CAG_OK;
  cag_triangle_init(t, 12);
  for (size_t i = 0; i < n && !status; i++) {
    const CagVec3 p = scaled_point(model, points[i]), q = scaled_point(picture, images[i]);
    const double x[4] = {p.x, p.y, p.z, 1}, uv[2] = {q.x, q.y};
    for (size_t k = 0; k < 2 && !status; k++) {
      double row[12] = {0};
      for (size_t j = 0; j < 4; j++) {
        row[4 * k + j] = x[j];
        row[8 + j] = -uv[k] * x[j];
      }
      status = cag_triangle_add(t, row, err);
    }
  }
  return status ? status : cag_triangle_finish(t, err);
}

static CagStatus fail_ambiguous(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_model_ambiguous, "points", -1,
                  "several maps send the points to these images");
}

// The rows, up to a factor.
static CagStatus projective_rows(const CagVec3 *points, const CagVec3 *images, size_t n,
                                 double rows[3][4], CagError *err) {
  Scale model, picture;
  CagTriangle t;
  double values[12], h[12];
  CagStatus status = check_count(n, PROJECTIVE_POINTS, "a projective map", err);
  if (!status) status = points_scale(points, n, sqrt(3), &model, err);
  if (!status) status = points_scale(images, n, sqrt(2), &picture, err);
  if (!status) status = affine_triangle(points, images, n, &model, &picture, &t, err);
  if (status) return status;
  if (picture.factor == 0) return fail_ambiguous(err);
  status = projective_triangle(points, images, n, &model, &picture, &t, err);
  if (!status) status = cag_triangle_singular(&t, 12, values, h, err);
  if (status) return status;
  if (!(values[10] > CAG_COINCIDENT * values[0])) return fail_ambiguous(err);
  // Without perspective, the last row is 0 0 0 1 to rounding.
  const double slope = hypot(hypot(h[8], h[9]), h[10]);
  if (slope <= CAG_COINCIDENT * fabs(h[11])) h[8] = h[9] = h[10] = 0;
  memcpy(rows, h, sizeof h);
  unscale_rows(rows, &model, &picture);
  return CAG_OK;
}

static double point_scale(const double row[4], CagVec3 p) {
  return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
}

static void multiply_rows(double rows[3][4], double factor) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) rows[i][j] = rows[i][j] * factor + 0.0; // never -0
}

CagStatus cag_model_fit_projective(const CagVec3 *points, const CagVec3 *images, size_t n,
                                   CagModelFit *out, double *scales, CagError *err) {
  CagStatus status = projective_rows(points, images, n, out->rows, err);
  if (status) return status;
  const double first = point_scale(out->rows[2], points[0]);
  if (!isfinite(1 / first)) return fail_ambiguous(err);
  multiply_rows(out->rows, 1 / first);
  for (size_t i = 0; i < n; i++) scales[i] = point_scale(out->rows[2], points[i]);
  return cag_model_error(out->rows, points, images, n, &out->error, &out->rms, err);
}

CagStatus cag_calibrate(const CagVec3 *points, const CagVec3 *pixels, size_t n, CagCameraMap *out,
                        double *rms, CagError *err) {
  double rows[3][4], error, in_front = 0;
  CagStatus status = projective_rows(points, pixels, n, rows, err);
  if (status && err->id == CAG_ERR_model_points_coplanar)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_calibration_points_coplanar, "points", -1,
                    "expected points that are not all in one plane");
  if (status) return status;
  for (size_t i = 0; i < n; i++) in_front += point_scale(rows[2], points[i]) > 0 ? 1 : -1;
  if (in_front < 0) multiply_rows(rows, -1);
  status = cag_camera_map(rows, out, err);
  if (!status) status = cag_model_error(rows, points, pixels, n, &error, rms, err);
  return status;
}
