// Conics from points and tangents.
//
// Each condition is a linear equation for the coefficients, so the conic is the null vector of
// their matrix. It is computed by a singular value decomposition, with the data centered and scaled
// to unit size; the singular values also show whether the conditions are dependent or
// contradictory.

#include <lapacke.h>

#include "base/memory.h"
#include "geom/curve/conic.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// Singular values below this fraction of the largest are 0: conditions that follow from the others.
#define DEPENDENT CAG_ROUNDING
// Relative disagreement allowed for redundant conditions.
#define DISAGREE CAG_COINCIDENT
// Coefficients below this fraction of the largest, for data of unit size, are rounding errors.
#define NOISE 1e-13
// A coefficient can be normalized to 1 if it is above this fraction of the largest.
#define UNIT CAG_COINCIDENT
#define MOST 6

typedef struct Frame {
  CagVec3 center;
  double size;
} Frame;

static CagVec3 into(const Frame *f, CagVec3 p) {
  return cag_scaled(cag_sub(p, f->center), 1 / f->size);
}

// Columns of the unknowns of each shape, out of x^2, 2xy, y^2, 2x, 2y, 1; for a circle x^2 + y^2 is
// one column.
static int columns_of(CagConicShape shape) {
  static const int count[] = {6, 5, 4, 3};
  return count[shape];
}

static void pick(CagConicShape shape, const double full[6], double *row) {
  switch (shape) {
  case CAG_CONIC_GENERAL:
    for (int i = 0; i < 6; i++) row[i] = full[i];
    break;
  case CAG_CONIC_AXIS:
    row[0] = full[0];
    for (int i = 1; i < 5; i++) row[i] = full[i + 1];
    break;
  case CAG_CONIC_CIRCLE:
    row[0] = full[0] + full[2];
    for (int i = 1; i < 4; i++) row[i] = full[i + 2];
    break;
  case CAG_CONIC_LINE:
    for (int i = 0; i < 3; i++) row[i] = full[i + 3];
  }
}

// The coefficients of the form without factors of 2 from the unknowns.
static void spread(CagConicShape shape, const double *v, double c[6]) {
  double full[6] = {0};
  switch (shape) {
  case CAG_CONIC_GENERAL:
    for (int i = 0; i < 6; i++) full[i] = v[i];
    break;
  case CAG_CONIC_AXIS:
    full[0] = v[0];
    for (int i = 1; i < 5; i++) full[i + 1] = v[i];
    break;
  case CAG_CONIC_CIRCLE:
    full[0] = full[2] = v[0];
    for (int i = 1; i < 4; i++) full[i + 2] = v[i];
    break;
  case CAG_CONIC_LINE:
    for (int i = 0; i < 3; i++) full[i + 3] = v[i];
  }
  const double factor[6] = {1, 2, 1, 2, 2, 1};
  for (int i = 0; i < 6; i++) c[i] = full[i] * factor[i];
}

static void point_row(CagConicShape shape, CagVec3 p, double *row) {
  const double full[6] = {p.x * p.x, 2 * p.x * p.y, p.y * p.y, 2 * p.x, 2 * p.y, 1};
  pick(shape, full, row);
}

static void tangent_row(CagConicShape shape, CagVec3 p, CagVec3 d, double *row) {
  const double full[6] = {
      2 * p.x * d.x, 2 * (p.x * d.y + p.y * d.x), 2 * p.y * d.y, 2 * d.x, 2 * d.y, 0};
  pick(shape, full, row);
}

static void clean(double *c, const double unit[6]) {
  double most = 0;
  for (int i = 0; i < 6; i++) most = fmax(most, fabs(c[i]) * unit[i]);
  for (int i = 0; i < 6; i++)
    if (fabs(c[i]) * unit[i] <= NOISE * most) c[i] = 0;
}

// Transforms back from the frame of unit size.
static CagConic from_unit_frame(const Frame *f, const double c[6]) {
  const double s = f->size, m = f->center.x, n = f->center.y;
  const double a = c[0] / (s * s), b = c[1] / (s * s), d = c[2] / (s * s), e = c[3] / s,
               g = c[4] / s;
  return (CagConic){{a, b, d, e - 2 * a * m - b * n, g - 2 * d * n - b * m,
                     c[5] + (a * m + b * n - e) * m + (d * n - g) * n}};
}

static void normalize(CagConic *k) {
  double most = 0;
  int unit = 2;
  for (int i = 0; i < 6; i++) most = fmax(most, fabs(k->c[i]));
  if (fabs(k->c[2]) <= UNIT * most)
    for (unit = 0; unit < 5 && fabs(k->c[unit]) <= UNIT * most;) unit++;
  const double divisor = k->c[unit];
  for (int i = 0; i < 6; i++) k->c[i] = k->c[i] / divisor + 0.0;
}

// Null vector of the m x k matrix (destroyed), whose null space must be one-dimensional.
static CagStatus null_vector(double *matrix, size_t m, int k, double *v, CagError *err) {
  double values[MOST], vt[MOST * MOST], unused[1], work[MOST];
  const lapack_int rows = (lapack_int)m;
  lapack_int info = LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'N', 'A', rows, k, matrix, k, values, unused,
                                   1, vt, k, work);
  if (info != 0)
    return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_conditions_dependent, "", -1,
                    "the singular values of the conditions could not be found");
  if (values[k - 2] <= DEPENDENT * values[0])
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_conditions_dependent, "points", -1,
                    "the conditions are dependent: more than one conic satisfies them (points "
                    "are repeated, or too many lie on one line)");
  if (rows >= k && values[k - 1] > DISAGREE * values[0])
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_conditions_contradict, "points", -1,
                    "the conditions are contradictory: no conic of this kind satisfies all of "
                    "them");
  for (int i = 0; i < k; i++) v[i] = vt[(size_t)(k - 1) * (size_t)k + (size_t)i];
  return CAG_OK;
}

static Frame frame_of(const CagVec3 *points, size_t n) {
  Frame f = {{0, 0, 0}, 0};
  for (size_t i = 0; i < n; i++) f.center = cag_madd(f.center, 1 / (double)n, points[i]);
  for (size_t i = 0; i < n; i++) f.size = fmax(f.size, cag_norm(cag_sub(points[i], f.center)));
  if (n == 1) f.size = 1; // a single point, that of a tangent
  return f;
}

// The points, and those points of tangents that are not among them.
static size_t gather(const CagVec3 *points, size_t n, const CagConicTangent *tangents, size_t m,
                     CagVec3 *out) {
  for (size_t i = 0; i < n; i++) out[i] = points[i];
  const double same = CAG_CURVE_SAME * cag_curve_size(points, n);
  for (size_t j = 0; j < m; j++) {
    bool known = false;
    for (size_t i = 0; i < n; i++)
      known = known || cag_norm(cag_sub(out[i], tangents[j].point)) <= same;
    if (!known) out[n++] = tangents[j].point;
  }
  return n;
}

static CagStatus solve(const CagVec3 *points, size_t n, const CagConicTangent *tangents, size_t m,
                       CagConicShape shape, double *matrix, CagConic *out, CagError *err) {
  static const double even[6] = {1, 1, 1, 1, 1, 1};
  const int k = columns_of(shape);
  const Frame f = frame_of(points, n);
  double v[MOST], c[6];
  if (!(f.size > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_coincident_points, "points", -1,
                    "all points are the same");
  double *row = matrix;
  for (size_t i = 0; i < n; i++, row += k) point_row(shape, into(&f, points[i]), row);
  for (size_t j = 0; j < m; j++, row += k) {
    const CagVec3 d = cag_unit(tangents[j].direction);
    if (cag_norm(d) == 0)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_vector, "tangents", (long)j,
                      "the direction of `tangents`[%zu] is zero", j);
    tangent_row(shape, into(&f, tangents[j].point), d, row);
  }
  CagStatus status = null_vector(matrix, n + m, k, v, err);
  if (status) return status;
  spread(shape, v, c);
  clean(c, even);
  *out = from_unit_frame(&f, c);
  const double s = cag_norm(f.center) + f.size;
  const double unit[6] = {s * s, s * s, s * s, s, s, 1};
  clean(out->c, unit);
  normalize(out);
  return CAG_OK;
}

CagStatus cag_conic_from_conditions(const CagVec3 *points, size_t n,
                                    const CagConicTangent *tangents, size_t m, CagConicShape shape,
                                    CagConic *out, CagError *err) {
  const size_t needed = (size_t)columns_of(shape) - 1;
  CagVec3 *all = cag_malloc(sizeof *all * (n + m + 1));
  double *matrix = cag_malloc(sizeof *matrix * (n + 2 * m + 1) * MOST);
  CagStatus status = all && matrix ? CAG_OK : cag_fail_memory(err);
  const size_t count = status ? 0 : gather(points, n, tangents, m, all);
  if (!status && count + m < needed)
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_conditions, "points", -1,
                      "expected %zu conditions (each point and each tangent is one), found "
                      "%zu",
                      needed, count + m);
  if (!status) status = solve(all, count, tangents, m, shape, matrix, out, err);
  cag_free(all);
  cag_free(matrix);
  return status;
}

// --- Arcs from their triangle ---

static CagStatus check_triangle(CagVec3 p, CagVec3 apex, CagVec3 q, CagError *err) {
  const CagVec3 a = cag_sub(apex, p), b = cag_sub(q, apex);
  if (cag_norm(cag_cross(a, b)) <= CAG_CURVE_SAME * cag_norm(a) * cag_norm(b))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_collinear_points, "", -1,
                    "the two ends and the apex lie on one line (or two of them are the same): they "
                    "are not a triangle");
  return CAG_OK;
}

CagStatus cag_conic_arc(CagVec3 p, CagVec3 apex, CagVec3 q, double weight, int dimension,
                        CagCurve **out, CagError *err) {
  char text[32];
  if (!(weight >= 0) || !isfinite(weight))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_negative_weight, "weight", -1,
                    "the weight of the apex must be finite and not negative, found %s",
                    cag_number_text(weight, text));
  CagStatus status = check_triangle(p, apex, q, err);
  // With weight 0 the apex has no effect: the arc is its chord.
  if (!status && weight == 0) return cag_curve_line(p, q, dimension, out, err);
  const CagVec3 points[3] = {p, apex, q};
  const double weights[3] = {1, weight, 1};
  return status ? status
                : cag_curve_bezier(points, weight == 1 ? NULL : weights, 3, dimension, out, err);
}

CagStatus cag_conic_shoulder_weight(CagVec3 p, CagVec3 apex, CagVec3 q, CagVec3 shoulder,
                                    double *weight, CagError *err) {
  CagStatus status = check_triangle(p, apex, q, err);
  if (status) return status;
  // Barycentric coordinates: u at p, v at the apex, w at q.
  const CagVec3 a = cag_sub(apex, p), b = cag_sub(q, p), s = cag_sub(shoulder, p);
  const CagVec3 normal = cag_cross(a, b);
  const double area = cag_dot(normal, normal);
  const double v = cag_dot(cag_cross(s, b), normal) / area;
  const double w = cag_dot(cag_cross(a, s), normal) / area, u = 1 - v - w;
  const double off = fabs(cag_dot(s, normal)) / sqrt(area);
  const double off_plane = CAG_COINCIDENT; // relative to the triangle's size
  if (!(u > 0 && v > 0 && w > 0) || off > off_plane * (cag_norm(a) + cag_norm(b)))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_shoulder_outside, "shoulder", -1,
                    "`shoulder` must lie inside the triangle of the two ends and the apex");
  *weight = v / (2 * sqrt(u * w));
  return CAG_OK;
}
