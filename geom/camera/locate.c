// Positions from bearings and distances.

#include "geom/camera/locate.h"

#include "geom/camera/triangle.h"
#include "geom/linalg/tolerance.h"

static CagVec3 mean_mark(const CagVec3 *marks, size_t n) {
  CagVec3 mean = {0, 0, 0};
  for (size_t i = 0; i < n; i++) mean = cag_madd(mean, 1.0 / (double)n, marks[i]);
  return mean;
}

// Solves the equations of a finished triangle with `dimension` unknowns. *independent: whether the
// unknowns are determined; otherwise nothing is solved.
static CagStatus solve_position(CagTriangle *t, int dimension, bool *independent, CagVec3 *out,
                                CagError *err) {
  const size_t n = (size_t)dimension;
  double values[3], x[3] = {0};
  CagStatus status = cag_triangle_finish(t, err);
  if (!status) status = cag_triangle_singular(t, n, values, NULL, err);
  if (status) return status;
  *independent = values[n - 1] > CAG_PARALLEL * values[0];
  if (!*independent) return CAG_OK;
  cag_triangle_solve(t, n, n, x);
  *out = cag_vec3(x[0], x[1], x[2]);
  return CAG_OK;
}

CagStatus cag_locate_by_bearings(const CagVec3 *marks, const double *bearings, size_t n,
                                 CagVec3 *out, CagError *err) {
  const CagVec3 mean = mean_mark(marks, n);
  CagTriangle t;
  CagVec3 offset = {0, 0, 0};
  bool independent = false;
  CagStatus status = CAG_OK;
  cag_triangle_init(&t, 3);
  for (size_t i = 0; i < n && !status; i++) {
    double sine, cosine;
    cag_sincos(bearings[i], &sine, &cosine);
    const CagVec3 mark = cag_sub(marks[i], mean);
    status = cag_triangle_add(&t, (double[]){-sine, cosine, cosine * mark.y - sine * mark.x}, err);
  }
  if (!status) status = solve_position(&t, 2, &independent, &offset, err);
  if (status) return status;
  if (!independent)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_bearings_parallel, "angles", -1,
                    "expected two bearings or more that are not equal or opposite");
  *out = cag_add(mean, offset);
  return CAG_OK;
}

CagStatus cag_locate_by_ranges(const CagVec3 *marks, const double *ranges, size_t n, int dimension,
                               CagVec3 *out, CagError *err) {
  const CagVec3 mean = mean_mark(marks, n);
  CagTriangle t;
  CagVec3 offset = {0, 0, 0};
  bool independent = false;
  double power = 0; // the mean of |mark|^2 - range^2
  for (size_t i = 0; i < n; i++) {
    const CagVec3 m = cag_sub(marks[i], mean);
    power += (cag_dot(m, m) - ranges[i] * ranges[i]) / (double)n;
  }
  CagStatus status = CAG_OK;
  cag_triangle_init(&t, (size_t)dimension + 1);
  for (size_t i = 0; i < n && !status; i++) {
    const CagVec3 m = cag_sub(marks[i], mean);
    double row[4] = {2 * m.x, 2 * m.y, 2 * m.z};
    row[dimension] = cag_dot(m, m) - ranges[i] * ranges[i] - power;
    status = cag_triangle_add(&t, row, err);
  }
  if (!status) status = solve_position(&t, dimension, &independent, &offset, err);
  if (status) return status;
  if (!independent)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_landmarks_collinear, "marks", -1,
                    dimension == 2 ? "expected three marks or more that are not on one line"
                                   : "expected four marks or more that are not in one plane");
  *out = cag_add(mean, offset);
  return CAG_OK;
}
