// Classification of transforms (class, rotation, and fixed points), and the transform that maps
// given points to given images.

#include <lapacke.h>
#include <string.h>

#include "geom/linalg/tolerance.h"
#include "geom/linalg/transform.h"

// Orthogonality and rank are tested to this fraction of the entries.
#define CLASS_TOLERANCE CAG_COINCIDENT
// Points are collinear or coplanar if the determinant is below this fraction of its rows.
#define FLAT CAG_ROUNDING

// --- Class ---

// Scale of a linear part of `n` rows if its columns are orthogonal and of equal length; else 0.
static double common_scale(const CagTransform *t, int n) {
  double first = 0, w = fabs(t->m[3][3]);
  for (int a = 0; a < n; a++)
    for (int b = a; b < n; b++) {
      double dot = 0;
      for (int i = 0; i < n; i++) dot += t->m[i][a] * t->m[i][b];
      if (a == 0 && b == 0) first = dot;
      if (!(fabs(dot - (a == b ? first : 0)) <= CLASS_TOLERANCE * first)) return 0;
    }
  return sqrt(first) / w;
}

static bool mirrors(const CagTransform *t) {
  if (!t->planar) return cag_transform_mirrors(t);
  return t->m[0][0] * t->m[1][1] - t->m[0][1] * t->m[1][0] < 0;
}

static void find_turn(const CagTransform *t, CagTransformClass *out) {
  if (t->planar) {
    out->has_rotation = true;
    out->axis = cag_vec3(0, 0, 1);
    out->angle = atan2(t->m[1][0] / t->m[3][3], t->m[0][0] / t->m[3][3]) + 0.0;
    return;
  }
  CagError ignored;
  bool singular;
  out->has_rotation = !cag_axis_angle_of(t, &out->axis, &out->angle, &singular, &ignored);
}

// --- Fixed points: eigenvectors of the homogeneous matrix that are finite points ---

// Null space of a - lambda I (n x n, row-major) as orthonormal rows of `basis`; returns its
// dimension.
static int null_space(const double *a, int n, double lambda, double basis[4][4]) {
  double m[16], s[4], u[16], vt[16], work[4], size = 0;
  for (int i = 0; i < n * n; i++) {
    m[i] = a[i] - (i % (n + 1) == 0 ? lambda : 0);
    size = fmax(size, fabs(a[i]));
  }
  if (LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'A', 'A', n, n, m, n, s, u, n, vt, n, work) != 0) return 0;
  int dimension = 0;
  for (int i = 0; i < n; i++)
    if (s[i] <= CLASS_TOLERANCE * size) memcpy(basis[dimension++], vt + i * n, n * sizeof(double));
  return dimension;
}

// Reduces the basis to echelon form with the weight (last component) first: then at most the first
// vector is finite, and it is scaled to weight 1; the others are directions. False: no finite
// point.
static bool split_finite(double basis[4][4], int dimension, int n) {
  int best = 0;
  for (int i = 1; i < dimension; i++)
    if (fabs(basis[i][n - 1]) > fabs(basis[best][n - 1])) best = i;
  if (fabs(basis[best][n - 1]) <= CLASS_TOLERANCE) return false;
  double first[4];
  for (int j = 0; j < n; j++) first[j] = basis[best][j] / basis[best][n - 1];
  memcpy(basis[best], basis[0], sizeof first);
  memcpy(basis[0], first, sizeof first);
  for (int i = 1; i < dimension; i++) {
    double f = basis[i][n - 1];
    for (int j = 0; j < n; j++) basis[i][j] -= f * first[j];
  }
  return true;
}

// Candidates for the eigenvalue. The finite fixed points of an affine map have the eigenvalue of
// the weight.
static int candidates(const CagTransform *t, const double *a, int n, double out[4]) {
  if (cag_transform_is_affine(t)) {
    out[0] = t->m[3][3];
    return 1;
  }
  double m[16], re[4], im[4], none[1];
  memcpy(m, a, (size_t)(n * n) * sizeof(double));
  if (LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'N', n, m, n, re, im, none, 1, none, 1) != 0) return 0;
  int count = 0;
  for (int i = 0; i < n; i++)
    if (fabs(im[i]) <= CLASS_TOLERANCE * hypot(re[i], im[i])) out[count++] = re[i];
  return count;
}

static void find_fixed(const CagTransform *t, CagTransformClass *out) {
  const int n = t->planar ? 3 : 4;
  // Lengths are relative to the size of the translation, so that the rank does not depend on units.
  double unit = 0, a[16];
  for (int i = 0; i < 3; i++) unit = fmax(unit, fabs(t->m[i][3] / (t->m[3][3] ? t->m[3][3] : 1)));
  if (unit == 0) unit = 1;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      int row = i == n - 1 ? 3 : i, col = j == n - 1 ? 3 : j;
      a[i * n + j] = t->m[row][col] * (row == 3 ? unit : 1) / (col == 3 ? unit : 1);
    }
  static const char *const names[] = {"none", "point", "line", "plane", "all"};
  double values[4], basis[4][4], best[4][4] = {{0}};
  int found = 0, count = candidates(t, a, n, values);
  for (int c = 0; c < count; c++) {
    int dimension = null_space(a, n, values[c], basis);
    if (dimension <= found || !split_finite(basis, dimension, n)) continue;
    found = dimension;
    memcpy(best, basis, sizeof best);
  }
  out->fixed = found == n ? "all" : names[found];
  out->fixed_point = out->fixed_direction = cag_vec3(0, 0, 0);
  if (found == 0) return;
  CagVec3 v[4] = {{0}};
  for (int i = 0; i < found; i++)
    v[i] = cag_vec3(best[i][0] * unit, best[i][1] * unit, n == 4 ? best[i][2] * unit : 0);
  out->fixed_point = v[0];
  if (found == 2 && found < n) out->fixed_direction = cag_unit(v[1]);
  if (found == 3 && found < n) out->fixed_direction = cag_unit(cag_cross(v[1], v[2]));
  // Report the point of the set that is nearest to the origin.
  CagVec3 d = out->fixed_direction;
  if (found == n) out->fixed_point = cag_vec3(0, 0, 0);
  else if (found == 2) out->fixed_point = cag_madd(v[0], -cag_dot(v[0], d), d);
  else if (found == 3) out->fixed_point = cag_scaled(d, cag_dot(v[0], d));
}

CagStatus cag_transform_classify(const CagTransform *t, CagTransformClass *out, CagError *err) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (!isfinite(t->m[i][j]))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "T", -1,
                        "the transform has an entry that is not a finite number");
  CagTransformClass r = {.scale = 1};
  if (!cag_transform_is_affine(t)) {
    r.name = "projective";
  } else {
    double scale = common_scale(t, t->planar ? 2 : 3);
    bool unit = fabs(scale - 1) <= CLASS_TOLERANCE;
    r.name = scale == 0 ? "affine" : !unit ? "similarity" : mirrors(t) ? "mirror" : "rigid";
    if (scale != 0 && !unit) r.scale = scale;
    if (scale != 0 && !mirrors(t)) find_turn(t, &r);
  }
  find_fixed(t, &r);
  *out = r;
  return CAG_OK;
}

// --- Transforms from point pairs ---

static CagStatus fail_position(const char *argument, CagErrorId id, const char *problem,
                               CagError *err) {
  return cag_fail(err, CAG_E_ARGUMENT, id, argument, -1, "the %s %s", argument, problem);
}

// z -> a z + b in complex numbers.
static CagStatus from_two(const CagVec3 *p, const CagVec3 *q, CagTransform *t, CagError *err) {
  double dx = p[1].x - p[0].x, dy = p[1].y - p[0].y, n = dx * dx + dy * dy;
  if (n == 0)
    return fail_position("points", CAG_ERR_coincident_points, "coincide; give two different ones",
                         err);
  double ex = q[1].x - q[0].x, ey = q[1].y - q[0].y;
  double c = (ex * dx + ey * dy) / n, s = (ey * dx - ex * dy) / n;
  t->m[0][0] = t->m[1][1] = c;
  t->m[0][1] = -s + 0.0;
  t->m[1][0] = s;
  t->m[0][3] = q[0].x - (c * p[0].x - s * p[0].y);
  t->m[1][3] = q[0].y - (s * p[0].x + c * p[0].y);
  return CAG_OK;
}

// Columns p1 - p0, p2 - p0, .. as the linear part; the plane keeps z.
static CagTransform edges(const CagVec3 *p, int n) {
  CagTransform t = cag_transform_identity();
  for (int j = 0; j < n; j++) {
    CagVec3 e = cag_sub(p[j + 1], p[0]);
    t.m[0][j] = e.x;
    t.m[1][j] = e.y;
    if (n == 3) t.m[2][j] = e.z;
  }
  t.m[0][3] = p[0].x;
  t.m[1][3] = p[0].y;
  if (n == 3) t.m[2][3] = p[0].z;
  return t;
}

static bool flat(const CagTransform *e, int n) {
  double size = 1;
  for (int j = 0; j < n; j++) size *= hypot(hypot(e->m[0][j], e->m[1][j]), n == 3 ? e->m[2][j] : 0);
  return !(fabs(cag_transform_determinant(e)) > FLAT * size);
}

static CagStatus from_simplex(const CagVec3 *p, const CagVec3 *q, int n, CagTransform *t,
                              CagError *err) {
  CagTransform from = edges(p, n), to = edges(q, n), inverse;
  if (flat(&from, n))
    return n == 2 ? fail_position("points", CAG_ERR_collinear_points,
                                  "lie on one line; give three that span the plane", err)
                  : fail_position("points", CAG_ERR_coplanar_points,
                                  "lie in one plane; give four that span space", err);
  CagStatus status = cag_transform_inverse(&from, &inverse, err);
  if (status) return status;
  *t = cag_transform_multiply(&to, &inverse);
  return CAG_OK;
}

// 3x3 matrix (in x, y, w of a 4x4) that maps the unit triangle's vertices and centroid to p0 .. p3.
static CagStatus from_frame(const CagVec3 *p, const char *argument, CagTransform *t,
                            CagError *err) {
  for (int skip = 0; skip < 4; skip++) {
    CagVec3 three[3];
    for (int i = 0, n = 0; i < 4; i++)
      if (i != skip) three[n++] = p[i];
    CagTransform e = edges(three, 2);
    if (flat(&e, 2))
      return fail_position(argument, CAG_ERR_collinear_points,
                           "include three on one line; no three of the four may be collinear", err);
  }
  CagTransform m = {{{p[0].x, p[1].x, 0, p[2].x},
                     {p[0].y, p[1].y, 0, p[2].y},
                     {0, 0, 1, 0},
                     {1, 1, 0, 1}},
                    true},
               inverse;
  CagStatus status = cag_transform_inverse(&m, &inverse, err);
  if (status) return status;
  double h[4] = {p[3].x, p[3].y, 0, 1}, k[4];
  cag_transform_homogeneous(&inverse, h, k);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (j != 2) m.m[i][j] *= k[j];
  *t = m;
  return CAG_OK;
}

static CagStatus from_four(const CagVec3 *p, const CagVec3 *q, CagTransform *t, CagError *err) {
  CagTransform from, to, inverse;
  CagStatus status = from_frame(p, "points", &from, err);
  if (!status) status = from_frame(q, "images", &to, err);
  if (!status) status = cag_transform_inverse(&from, &inverse, err);
  if (status) return status;
  CagTransform m = cag_transform_multiply(&to, &inverse);
  m.m[2][2] = 1;
  // Scale so that the weight of the points' centroid has magnitude 1; then so that m33 is 1 unless
  // the origin maps to infinity.
  CagVec3 c = cag_scaled(cag_add(cag_add(p[0], p[1]), cag_add(p[2], p[3])), 0.25);
  double size = 0;
  for (int i = 0; i < 4; i++) size = fmax(size, cag_norm(cag_sub(p[i], c)));
  double w = m.m[3][3], tilt = hypot(m.m[3][0], m.m[3][1]) * (size + cag_norm(c));
  double factor = fabs(w) > FLAT * tilt ? w : tilt;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (i != 2 && j != 2) m.m[i][j] /= factor;
  if (tilt <= FLAT * fabs(w)) m.m[3][0] = m.m[3][1] = 0; // affine to rounding
  *t = m;
  return CAG_OK;
}

CagStatus cag_transform_from(const CagVec3 *points, const CagVec3 *images, size_t n, bool planar,
                             CagTransform *out, CagError *err) {
  for (size_t i = 0; i < n; i++) {
    const CagVec3 v[2] = {points[i], images[i]};
    for (int k = 0; k < 2; k++)
      if (!isfinite(v[k].x) || !isfinite(v[k].y) || !isfinite(v[k].z))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, k ? "images" : "points", (long)i,
                        "%s[%zu] has a coordinate that is not a finite number",
                        k ? "images" : "points", i);
  }
  CagTransform t = cag_transform_identity();
  CagStatus status;
  if (planar && n == 2) status = from_two(points, images, &t, err);
  else if (planar && n == 3) status = from_simplex(points, images, 2, &t, err);
  else if (planar && n == 4) status = from_four(points, images, &t, err);
  else if (!planar && n == 4) status = from_simplex(points, images, 3, &t, err);
  else
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_point_count, "points", -1,
        planar
            ? "expected 2 (similarity), 3 (affine), or 4 (projective) pairs of points in the plane, found %zu"
            : "expected 4 pairs of points in space, found %zu",
        n);
  if (status) return status;
  t.planar = planar;
  *out = t;
  return CAG_OK;
}
