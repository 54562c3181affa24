// 4x4 transforms: products, images, inverses, and elementary maps other than rotations.
//
// Special angles and axes give exact matrices: a quarter turn consists of 0 and 1, so that a mesh
// rotated four times is identical to the original.

#include "geom/linalg/transform.h"
#include "geom/linalg/tolerance.h"

#include <float.h>
#include <string.h>

// A matrix is singular if its relative determinant is below this, the rounding of its entries.
#define SINGULAR 1e-14
// Accepted deviation from a similarity: the rounding of a few products.
#define SIMILAR CAG_ROUNDING

// --- Angles ---

void cag_sincos(double angle, double *sine, double *cosine) {
  // sin of 0, 15, .. 90 degrees.
  static const double table[7] = {0,
                                  0.25881904510252076235,
                                  0.5,
                                  0.70710678118654752440,
                                  0.86602540378443864676,
                                  0.96592582628906828675,
                                  1};
  const double step = M_PI / 12;
  // A multiple that was computed in degrees and converted is a few roundings away from the nearest
  // double.
  const double slack = 4 * DBL_EPSILON * fabs(angle);
  const double farthest = 1e6; // steps; beyond, the slack would reach into ordinary angles
  double k = nearbyint(angle / step);
  if (fabs(k) < farthest && fabs(angle - k * step) <= slack) {
    int i = (int)fmod(k, 24);
    if (i < 0) i += 24;
    int q = i / 6, r = i % 6;
    double s = table[r], c = table[6 - r];
    *sine = q == 0 ? s : q == 1 ? c : q == 2 ? -s : -c;
    *cosine = q == 0 ? c : q == 1 ? -s : q == 2 ? -c : s;
    *sine += 0.0; // no negative zero
    *cosine += 0.0;
    return;
  }
  *sine = sin(angle);
  *cosine = cos(angle);
}

// --- Algebra ---

CagTransform cag_transform_identity(void) {
  return (CagTransform){.m = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}},
                        .planar = true};
}

static CagTransform space_identity(void) {
  CagTransform t = cag_transform_identity();
  t.planar = false;
  return t;
}

CagTransform cag_transform_multiply(const CagTransform *a, const CagTransform *b) {
  CagTransform t = {.planar = a->planar && b->planar, .in_front = a->in_front || b->in_front};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 4; k++) t.m[i][j] += a->m[i][k] * b->m[k][j];
  return t;
}

CagVec3 cag_transform_point(const CagTransform *t, CagVec3 p) {
  const double(*m)[4] = t->m;
  CagVec3 q = {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
               m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
               m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
  double w = m[3][0] * p.x + m[3][1] * p.y + m[3][2] * p.z + m[3][3];
  return w == 1 ? q : (CagVec3){q.x / w, q.y / w, q.z / w};
}

CagVec3 cag_transform_vector(const CagTransform *t, CagVec3 v) {
  const double(*m)[4] = t->m;
  CagVec3 q = {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
               m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
               m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
  double w = m[3][3];
  return w == 1 || w == 0 ? q : cag_scaled(q, 1 / w);
}

void cag_transform_homogeneous(const CagTransform *t, const double h[4], double out[4]) {
  double r[4];
  for (int i = 0; i < 4; i++)
    r[i] = t->m[i][0] * h[0] + t->m[i][1] * h[1] + t->m[i][2] * h[2] + t->m[i][3] * h[3];
  memcpy(out, r, sizeof r);
}

bool cag_transform_derivatives(const CagTransform *t, int order, CagVec3 *d) {
  double w[CAG_TRANSFORM_ORDER + 1] = {0};
  for (int k = 0; k <= order; k++) {
    const double from[4] = {d[k].x, d[k].y, d[k].z, k == 0};
    double to[4];
    cag_transform_homogeneous(t, from, to);
    d[k] = cag_vec3(to[0], to[1], to[2]);
    w[k] = to[3];
  }
  if (w[0] == 0) return false;
  for (int k = 0; k <= order; k++) {
    double binomial = 1;
    for (int i = 1; i <= k; i++) {
      binomial = binomial * (k - i + 1) / i;
      d[k] = cag_madd(d[k], -binomial * w[i], d[k - i]);
    }
    d[k] = cag_scaled(d[k], 1 / w[0]);
  }
  return true;
}

static CagVec3 column(const CagTransform *t, int j) {
  return (CagVec3){t->m[0][j], t->m[1][j], t->m[2][j]};
}

static double linear_determinant(const CagTransform *t) {
  return cag_dot(column(t, 0), cag_cross(column(t, 1), column(t, 2)));
}

// Laplace expansion by the 2x2 minors of the upper and the lower two rows.
double cag_transform_determinant(const CagTransform *t) {
  const double(*m)[4] = t->m;
#define MINOR(r, i, j) (m[r][i] * m[r + 1][j] - m[r][j] * m[r + 1][i])
  return MINOR(0, 0, 1) * MINOR(2, 2, 3) - MINOR(0, 0, 2) * MINOR(2, 1, 3) +
         MINOR(0, 0, 3) * MINOR(2, 1, 2) + MINOR(0, 1, 2) * MINOR(2, 0, 3) -
         MINOR(0, 1, 3) * MINOR(2, 0, 2) + MINOR(0, 2, 3) * MINOR(2, 0, 1);
#undef MINOR
}

static bool finite_transform(const CagTransform *t) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (!isfinite(t->m[i][j])) return false;
  return true;
}

static CagStatus fail_singular(CagError *err) {
  return cag_fail(
      err, CAG_E_DEGENERATE, CAG_ERR_singular_transform, "T", -1,
      "the transform is singular (its determinant is 0 to rounding): it flattens space, so it has no inverse");
}

// Adjugate of the linear part over its determinant: exact if the numbers are.
static CagStatus invert_affine(const CagTransform *t, CagTransform *out, CagError *err) {
  CagVec3 a = column(t, 0), b = column(t, 1), c = column(t, 2), d = column(t, 3);
  double det = linear_determinant(t);
  if (!(fabs(det) > SINGULAR * cag_norm(a) * cag_norm(b) * cag_norm(c))) return fail_singular(err);
  CagVec3 rows[3] = {cag_cross(b, c), cag_cross(c, a), cag_cross(a, b)};
  double w = t->m[3][3];
  for (int i = 0; i < 3; i++) {
    const double r[3] = {rows[i].x / det, rows[i].y / det, rows[i].z / det};
    for (int j = 0; j < 3; j++) out->m[i][j] = r[j] + 0.0;
    out->m[i][3] = -(r[0] * d.x + r[1] * d.y + r[2] * d.z) / w + 0.0;
    out->m[3][i] = 0;
  }
  out->m[3][3] = 1 / w;
  return CAG_OK;
}

// Gauss-Jordan with full pivoting on rows scaled to unit size.
static CagStatus invert_general(const CagTransform *t, CagTransform *out, CagError *err) {
  double a[4][8] = {{0}};
  for (int i = 0; i < 4; i++) {
    double size = 0;
    for (int j = 0; j < 4; j++) size = fmax(size, fabs(t->m[i][j]));
    if (size == 0) return fail_singular(err);
    for (int j = 0; j < 4; j++) a[i][j] = t->m[i][j] / size;
    a[i][4 + i] = 1 / size;
  }
  int pivot_row[4];
  bool used_row[4] = {false}, used_column[4] = {false};
  for (int step = 0; step < 4; step++) {
    int r = -1, c = -1;
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++)
        if (!used_row[i] && !used_column[j] && (r < 0 || fabs(a[i][j]) > fabs(a[r][c]))) {
          r = i;
          c = j;
        }
    if (!(fabs(a[r][c]) > SINGULAR)) return fail_singular(err);
    used_row[r] = used_column[c] = true;
    pivot_row[c] = r;
    double p = a[r][c];
    for (int j = 0; j < 8; j++) a[r][j] /= p;
    for (int i = 0; i < 4; i++) {
      double f = a[i][c];
      if (i == r || f == 0) continue;
      for (int j = 0; j < 8; j++) a[i][j] -= f * a[r][j];
    }
  }
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) out->m[i][j] = a[pivot_row[i]][4 + j] + 0.0;
  return CAG_OK;
}

CagStatus cag_transform_inverse(const CagTransform *t, CagTransform *out, CagError *err) {
  if (!finite_transform(t))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "T", -1,
                    "the transform has an entry that is not a finite number");
  CagTransform r = {.planar = t->planar, .in_front = t->in_front};
  CagStatus status =
      cag_transform_is_affine(t) ? invert_affine(t, &r, err) : invert_general(t, &r, err);
  if (!status) *out = r;
  return status;
}

bool cag_transform_is_affine(const CagTransform *t) {
  return t->m[3][0] == 0 && t->m[3][1] == 0 && t->m[3][2] == 0 && t->m[3][3] != 0;
}

bool cag_transform_is_similarity(const CagTransform *t, double *scale) {
  if (!cag_transform_is_affine(t)) return false;
  CagVec3 a = column(t, 0), b = column(t, 1), c = column(t, 2);
  double aa = cag_dot(a, a), bb = cag_dot(b, b), cc = cag_dot(c, c);
  double slack = SIMILAR * aa;
  if (!(aa > 0) || fabs(bb - aa) > slack || fabs(cc - aa) > slack || fabs(cag_dot(a, b)) > slack ||
      fabs(cag_dot(b, c)) > slack || fabs(cag_dot(c, a)) > slack)
    return false;
  if (scale) *scale = sqrt(aa) / fabs(t->m[3][3]);
  return true;
}

double cag_transform_stretch(const CagTransform *t) {
  double scale, sum = 0;
  if (cag_transform_is_similarity(t, &scale)) return scale;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) sum += t->m[i][j] * t->m[i][j];
  return sqrt(sum) / fabs(t->m[3][3]);
}

bool cag_transform_mirrors(const CagTransform *t) {
  double det = linear_determinant(t);
  return t->m[3][3] < 0 ? det > 0 : det < 0;
}

// --- Elementary maps ---

static CagStatus finite_vec(CagVec3 v, const char *name, CagError *err) {
  if (isfinite(v.x) && isfinite(v.y) && isfinite(v.z)) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, name, -1,
                  "`%s` has a coordinate that is not a finite number", name);
}

static CagStatus nonzero_vec(CagVec3 v, const char *name, CagError *err) {
  CagStatus status = finite_vec(v, name, err);
  if (status) return status;
  if (cag_norm(v) > 0) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_vector, name, -1,
                  "`%s` is the zero vector, which has no direction", name);
}

// Unit vector, exact if it is along an axis.
static CagVec3 direction(CagVec3 v) {
  double size = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
  return cag_unit((CagVec3){v.x / size, v.y / size, v.z / size});
}

// Sets the translation so that `about` is a fixed point.
static void fix_point(CagTransform *t, CagVec3 about) {
  CagVec3 d = cag_sub(about, cag_transform_vector(t, about));
  t->m[0][3] = d.x;
  t->m[1][3] = d.y;
  t->m[2][3] = d.z;
}

CagTransform cag_translate(CagVec3 v) {
  CagTransform t = space_identity();
  t.m[0][3] = v.x;
  t.m[1][3] = v.y;
  t.m[2][3] = v.z;
  return t;
}

// Rodrigues' formula.
CagStatus cag_rotate(CagVec3 axis, double angle, CagVec3 about, CagTransform *out, CagError *err) {
  CagStatus status = nonzero_vec(axis, "axis", err);
  if (!status) status = finite_vec(about, "about", err);
  if (status) return status;
  if (!isfinite(angle))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "angle", -1,
                    "`angle` is not a finite number");
  double s, c;
  cag_sincos(angle, &s, &c);
  const CagVec3 u = direction(axis);
  const double k[3] = {u.x, u.y, u.z};
  const double cross[3][3] = {{0, -u.z, u.y}, {u.z, 0, -u.x}, {-u.y, u.x, 0}};
  CagTransform t = space_identity();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      t.m[i][j] = i == j ? k[i] * k[i] + c * (1 - k[i] * k[i])
                         : k[i] * k[j] * (1 - c) + s * cross[i][j] + 0.0;
  fix_point(&t, about);
  *out = t;
  return CAG_OK;
}

CagStatus cag_scale(CagVec3 factors, CagVec3 about, CagTransform *out, CagError *err) {
  CagStatus status = finite_vec(factors, "factor", err);
  if (!status) status = finite_vec(about, "about", err);
  if (status) return status;
  const double f[3] = {factors.x, factors.y, factors.z};
  CagTransform t = space_identity();
  for (int i = 0; i < 3; i++) {
    if (f[i] == 0)
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_zero_factor, "factor", i,
          "the factor along %c must not be 0; to flatten a shape, use project(onto: plane)",
          'x' + i);
    t.m[i][i] = f[i];
  }
  fix_point(&t, about);
  *out = t;
  return CAG_OK;
}

CagStatus cag_reflect(CagVec3 normal, CagVec3 through, CagTransform *out, CagError *err) {
  CagStatus status = nonzero_vec(normal, "normal", err);
  if (!status) status = finite_vec(through, "through", err);
  if (status) return status;
  const CagVec3 u = direction(normal);
  const double k[3] = {u.x, u.y, u.z};
  CagTransform t = space_identity();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) t.m[i][j] = (i == j) - 2 * k[i] * k[j] + 0.0;
  fix_point(&t, through);
  *out = t;
  return CAG_OK;
}

// The matrix [[u^2 - v^2, 2uv], [2uv, v^2 - u^2]] of the line's direction (u, v).
CagStatus cag_reflect_line(CagVec3 p, CagVec3 q, CagTransform *out, CagError *err) {
  CagStatus status = finite_vec(p, "P", err);
  if (!status) status = finite_vec(q, "Q", err);
  if (status) return status;
  CagVec3 d = {q.x - p.x, q.y - p.y, 0};
  if (cag_norm(d) == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_coincident_points, "Q", -1,
                    "P and Q are the same point of the XY plane; use two different points");
  double size = fmax(fabs(d.x), fabs(d.y)), x = d.x / size, y = d.y / size, n = x * x + y * y;
  CagTransform t = cag_transform_identity();
  t.m[0][0] = (x * x - y * y) / n;
  t.m[0][1] = t.m[1][0] = 2 * x * y / n;
  t.m[1][1] = (y * y - x * x) / n;
  fix_point(&t, (CagVec3){p.x, p.y, 0});
  *out = t;
  return CAG_OK;
}

CagStatus cag_perspective(double f, bool keep_depth, CagTransform *out, CagError *err) {
  CagTransform t = space_identity();
  t.m[2][2] = keep_depth;
  t.m[3][2] = 1 / f;
  t.in_front = true;
  if (!finite_transform(&t))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "f", -1, "1/f is not finite");
  *out = t;
  return CAG_OK;
}

CagTransform cag_reflect_point(CagVec3 p) {
  CagTransform t = space_identity();
  for (int i = 0; i < 3; i++) t.m[i][i] = -1;
  fix_point(&t, p);
  return t;
}

CagTransform cag_shear(double xy, double xz, double yx, double yz, double zx, double zy) {
  return (CagTransform){.m = {{1, xy, xz, 0}, {yx, 1, yz, 0}, {zx, zy, 1, 0}, {0, 0, 0, 1}}};
}

// --- Planes and projections ---

CagStatus cag_plane(CagVec3 point, CagVec3 normal, CagPlane *out, CagError *err) {
  CagStatus status = finite_vec(point, "P", err);
  if (!status) status = nonzero_vec(normal, "normal", err);
  if (!status) *out = (CagPlane){point, direction(normal)};
  return status;
}

CagStatus cag_plane_through(CagVec3 p, CagVec3 q, CagVec3 r, CagPlane *out, CagError *err) {
  // Sine of the angle at P below which the three points are collinear.
  const double flat = CAG_ROUNDING;
  CagStatus status = finite_vec(p, "P", err);
  if (!status) status = finite_vec(q, "Q", err);
  if (!status) status = finite_vec(r, "R", err);
  if (status) return status;
  CagVec3 a = cag_sub(q, p), b = cag_sub(r, p), n = cag_cross(a, b);
  if (!(cag_norm(n) > flat * cag_norm(a) * cag_norm(b)))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_collinear_points, "R", -1,
                    "P, Q, and R are collinear, so they do not determine a plane");
  *out = (CagPlane){p, direction(n)};
  return CAG_OK;
}

CagStatus cag_plane_from_row(const double row[4], CagPlane *out, CagError *err) {
  CagVec3 n = {row[0], row[1], row[2]};
  CagStatus status = nonzero_vec(n, "row", err);
  if (status) return status;
  if (!isfinite(row[3]))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "row", 3,
                    "the last number of the plane's row is not finite");
  *out = (CagPlane){cag_scaled(n, -row[3] / cag_dot(n, n)), direction(n)};
  return CAG_OK;
}

void cag_plane_row(const CagPlane *p, double row[4]) {
  row[0] = p->normal.x;
  row[1] = p->normal.y;
  row[2] = p->normal.z;
  row[3] = -cag_dot(p->normal, p->point) + 0.0;
}

// The row of a plane is multiplied by the inverse from the right.
CagStatus cag_plane_transform(const CagPlane *p, const CagTransform *t, CagPlane *out,
                              CagError *err) {
  CagTransform inverse;
  CagStatus status = cag_transform_inverse(t, &inverse, err);
  if (status) return status;
  double row[4], image[4] = {0};
  cag_plane_row(p, row);
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++) image[j] += row[i] * inverse.m[i][j];
  if (image[0] == 0 && image[1] == 0 && image[2] == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_plane_at_infinity, "plane", -1,
                    "the transform maps this plane to infinity");
  CagPlane r;
  status = cag_plane_from_row(image, &r, err);
  if (status) return status;
  // Keep the image of the plane's point as its point, if it has one.
  CagVec3 q = cag_transform_point(t, p->point);
  if (isfinite(q.x) && isfinite(q.y) && isfinite(q.z)) r.point = q;
  *out = r;
  return CAG_OK;
}

// p -> p - (n.p + d) / (n.v) v
CagStatus cag_project_parallel(const CagPlane *onto, CagVec3 along, CagTransform *out,
                               CagError *err) {
  CagStatus status = finite_vec(along, "along", err);
  if (status) return status;
  const bool square = along.x == 0 && along.y == 0 && along.z == 0;
  const CagVec3 v = square ? onto->normal : direction(along);
  double row[4];
  cag_plane_row(onto, row);
  double slope = cag_dot(onto->normal, v);
  if (fabs(slope) < SINGULAR)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_parallel_to_plane, "along", -1,
                    "`along` must not be parallel to the plane `onto`");
  const double k[3] = {v.x / slope, v.y / slope, v.z / slope};
  CagTransform t = space_identity();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) t.m[i][j] = (i == j) - k[i] * row[j] + 0.0;
  *out = t;
  return CAG_OK;
}

// M = (row . from) I - from row, which maps p to the intersection of the line from-p with the
// plane.
CagStatus cag_project_central(const CagPlane *onto, CagVec3 from, CagTransform *out,
                              CagError *err) {
  CagStatus status = finite_vec(from, "from", err);
  if (status) return status;
  double row[4];
  cag_plane_row(onto, row);
  const double h[4] = {from.x, from.y, from.z, 1};
  double height = cag_dot(onto->normal, cag_sub(from, onto->point));
  double size = fmax(cag_norm(cag_sub(from, onto->point)), DBL_MIN);
  if (fabs(height) <= SINGULAR * size)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_center_in_plane, "from", -1,
                    "the point `from` lies in the plane `onto`; move it off the plane");
  CagTransform t = {.planar = false};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) t.m[i][j] = ((i == j) * height - h[i] * row[j]) / height + 0.0;
  *out = t;
  return CAG_OK;
}

// --- Frames ---

static CagTransform frame_of(CagVec3 x, CagVec3 y, CagVec3 z, CagVec3 origin) {
  return (CagTransform){.m = {{x.x, y.x, z.x, origin.x},
                              {x.y, y.y, z.y, origin.y},
                              {x.z, y.z, z.z, origin.z},
                              {0, 0, 0, 1}}};
}

CagStatus cag_axes(CagVec3 origin, CagVec3 x, CagVec3 y, CagTransform *out, CagError *err) {
  // Sine of the angle between the axes below which y does not determine a direction.
  const double flat = CAG_ROUNDING;
  CagStatus status = finite_vec(origin, "origin", err);
  if (!status) status = nonzero_vec(x, "x", err);
  if (!status) status = nonzero_vec(y, "y", err);
  if (status) return status;
  CagVec3 u = direction(x), v = direction(y);
  CagVec3 across = cag_cross(u, v);
  if (cag_norm(across) <= flat)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_parallel_axes, "y", -1,
                    "`y` must not be parallel to `x`");
  CagVec3 w = direction(across);
  *out = frame_of(u, cag_cross(w, u), w, origin);
  return CAG_OK;
}

// z points from `from` to `to`, y as far down as possible, and x to the right.
CagStatus cag_look_at(CagVec3 from, CagVec3 to, CagVec3 up, CagTransform *out, CagError *err) {
  const double flat = CAG_ROUNDING;
  CagStatus status = finite_vec(from, "from", err);
  if (!status) status = finite_vec(to, "to", err);
  if (!status) status = nonzero_vec(up, "up", err);
  if (status) return status;
  CagVec3 view = cag_sub(to, from);
  if (cag_norm(view) == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_coincident_points, "to", -1,
                    "`from` and `to` must be different points");
  CagVec3 z = direction(view), across = cag_cross(z, direction(up));
  if (cag_norm(across) <= flat)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_parallel_axes, "up", -1,
                    "`up` is parallel to the view direction; give another direction");
  CagVec3 x = direction(across);
  *out = frame_of(x, cag_cross(z, x), z, from);
  return CAG_OK;
}

// Rot(z, theta) Trans(0, 0, d) Trans(a, 0, 0) Rot(x, alpha).
CagTransform cag_dh(double theta, double d, double a, double alpha) {
  double st, ct, sa, ca;
  cag_sincos(theta, &st, &ct);
  cag_sincos(alpha, &sa, &ca);
  return (CagTransform){.m = {{ct, -st * ca, st * sa, a * ct},
                              {st, ct * ca, -ct * sa, a * st},
                              {0, sa, ca, d},
                              {0, 0, 0, 1}}};
}

// Rot(x, alpha) Trans(a, 0, 0) Rot(z, theta) Trans(0, 0, d).
CagTransform cag_mdh(double theta, double d, double a, double alpha) {
  double st, ct, sa, ca;
  cag_sincos(theta, &st, &ct);
  cag_sincos(alpha, &sa, &ca);
  return (CagTransform){.m = {{ct, -st, 0, a},
                              {st * ca, ct * ca, -sa, -sa * d},
                              {st * sa, ct * sa, ca, ca * d},
                              {0, 0, 0, 1}}};
}

bool cag_transform_is_rigid(const CagTransform *t) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j <= i; j++) {
      double dot = t->m[0][i] * t->m[0][j] + t->m[1][i] * t->m[1][j] + t->m[2][i] * t->m[2][j];
      if (!(fabs(dot - (i == j)) <= CAG_PARALLEL)) return false;
    }
  for (int j = 0; j < 4; j++)
    if (t->m[3][j] != (j == 3) || (j < 3 && !isfinite(t->m[j][3]))) return false;
  return cag_transform_determinant(t) > 0;
}

void cag_vec3s_digest(const CagVec3 *points, size_t n, CagDigest *d) {
  for (size_t i = 0; i < n; i++)
    cag_digest_numbers(d, (const double[]){points[i].x, points[i].y, points[i].z}, 3);
}

void cag_transform_digest(const CagTransform *t, CagDigest *d) {
  cag_digest_numbers(d, t->m[0], 16);
  cag_digest_word(d, (uint64_t)t->planar << 1 | t->in_front);
}
