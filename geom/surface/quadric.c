// Quadrics: evaluation, transforms, and the reduction to standard form.
//
// The symmetric 3x3 matrix of the quadratic terms is diagonalized by Jacobi rotations. In the
// eigenbasis the square is completed for every nonzero eigenvalue; the remainder (a constant k1, a
// linear term of length g along the directions of zero eigenvalues) determines the class (Beyer
// 1987, CRC Standard Mathematical Tables, quadrics). Before that, lengths are scaled to the
// quadric's own size, so that decisions do not depend on the unit of the drawing.

// If the coefficients are integers of moderate size, ranks and the constant are computed exactly in
// integers instead: a determinant is then exactly 0 or not.

#include "geom/surface/quadric.h"

#include <float.h>
#include <math.h>

// An eigenvalue below this fraction of the largest is zero: coefficients in scripts have fewer
// digits than this.
#define RANK_TOLERANCE 1e-10
// The constant and the linear remainder result from a subtraction of numbers near 1 (in the
// quadric's own units): this is its rounding.
#define REST_TOLERANCE 1e-13

// name, in the order of CagQuadricClass
static const char *const CLASS_NAME[] = {
    "ellipsoid",
    "imaginary-ellipsoid",
    "hyperboloid-1",
    "hyperboloid-2",
    "cone",
    "point",
    "elliptic-paraboloid",
    "hyperbolic-paraboloid",
    "elliptic-cylinder",
    "imaginary-elliptic-cylinder",
    "hyperbolic-cylinder",
    "parabolic-cylinder",
    "intersecting-planes",
    "line",
    "parallel-planes",
    "imaginary-parallel-planes",
    "coincident-planes",
    "plane",
    "empty",
};

static CagStatus check(const CagQuadric *q, CagError *err) {
  double largest = 0;
  for (int i = 0; i < 10; i++) {
    if (!isfinite(q->c[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "coefficients", i,
                      "`coefficients` must be finite: number %d is not", i);
    largest = fmax(largest, fabs(q->c[i]));
  }
  if (largest > 0) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_quadric, "coefficients", -1,
                  "`coefficients` must not all be 0: every point would satisfy the equation");
}

CagStatus cag_quadric_from_rows(const double r[4][4], CagQuadric *out, CagError *err) {
  CagQuadric q = {{r[0][0], r[1][1], r[2][2], r[0][1] + r[1][0], r[1][2] + r[2][1],
                   r[0][2] + r[2][0], r[0][3] + r[3][0], r[1][3] + r[3][1], r[2][3] + r[3][2],
                   r[3][3]}};
  CagStatus status = check(&q, err);
  if (!status) *out = q;
  return status;
}

void cag_quadric_rows(const CagQuadric *q, double r[4][4]) {
  const double *c = q->c;
  const double rows[4][4] = {{c[0], c[3] / 2, c[5] / 2, c[6] / 2},
                             {c[3] / 2, c[1], c[4] / 2, c[7] / 2},
                             {c[5] / 2, c[4] / 2, c[2], c[8] / 2},
                             {c[6] / 2, c[7] / 2, c[8] / 2, c[9]}};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) r[i][j] = rows[i][j];
}

double cag_quadric_value(const CagQuadric *q, CagVec3 p) {
  const double *c = q->c;
  return c[0] * p.x * p.x + c[1] * p.y * p.y + c[2] * p.z * p.z + c[3] * p.x * p.y +
         c[4] * p.y * p.z + c[5] * p.x * p.z + c[6] * p.x + c[7] * p.y + c[8] * p.z + c[9];
}

CagStatus cag_quadric_transform(const CagQuadric *q, const CagTransform *t, CagQuadric *out,
                                CagError *err) {
  CagTransform inverse;
  CagStatus status = cag_transform_inverse(t, &inverse, err);
  if (status) return status;
  double rows[4][4], half[4][4], full[4][4];
  cag_quadric_rows(q, rows);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      half[i][j] = 0;
      for (int k = 0; k < 4; k++) half[i][j] += rows[i][k] * inverse.m[k][j];
    }
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      full[i][j] = 0;
      for (int k = 0; k < 4; k++) full[i][j] += inverse.m[k][i] * half[k][j];
    }
  return cag_quadric_from_rows((const double(*)[4])full, out, err);
}

// --- Eigenvectors ---

// Cyclic Jacobi method for a symmetric matrix; v holds the eigenvectors. A diagonal matrix is not
// changed at all.
static void jacobi(double a[3][3], CagVec3 v[3]) {
  double e[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < 40; sweep++) {
    double off = fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]);
    if (off == 0) break;
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (a[p][q] == 0) continue;
        // Too small to matter against either diagonal entry.
        double tiny = 1e-17 * (fabs(a[p][p]) + fabs(a[q][q]));
        if (sweep > 3 && fabs(a[p][q]) <= tiny) {
          a[p][q] = a[q][p] = 0;
          continue;
        }
        double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
        double c = 1 / sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < 3; k++) {
          double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < 3; k++) {
          double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
        }
        a[p][q] = a[q][p] = 0;
        for (int k = 0; k < 3; k++) {
          double x = e[k][p], y = e[k][q];
          e[k][p] = c * x - s * y;
          e[k][q] = s * x + c * y;
        }
      }
  }
  for (int j = 0; j < 3; j++) v[j] = cag_vec3(e[0][j], e[1][j], e[2][j]);
}

static double entry(CagVec3 v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

// Whether the component of largest magnitude is negative (ties: the first).
static bool points_down(CagVec3 v) {
  double best = 0;
  for (int i = 2; i >= 0; i--)
    if (fabs(entry(v, i)) >= fabs(best) * (1 - 1e-12)) best = entry(v, i);
  return best < 0;
}

// --- Exact ranks ---

// Twice the coefficients must be integers up to this: determinants of order 4 then have less than
// 70 bits, and no eigenvalue is so small that its sign is rounding.
#define EXACT_MOST 16384

__extension__ typedef __int128 Integer;

typedef struct ExactRanks {
  int rank3, rank4;
  double k1; // the constant once the squares are completed, where no linear term remains
} ExactRanks;

// The minor of the given rows and columns, expanded along the first row.
static Integer minor_of(const Integer m[4][4], const int *rows, const int *columns, int n) {
  if (n == 0) return 1;
  Integer sum = 0;
  for (int j = 0; j < n; j++) {
    int rest[3] = {0};
    for (int k = 0, at = 0; k < n; k++)
      if (k != j) rest[at++] = columns[k];
    const Integer part = m[rows[0]][columns[j]] * minor_of(m, rows + 1, rest, n - 1);
    sum += j % 2 ? -part : part;
  }
  return sum;
}

// The n of `size` indices given by the set bits of a mask; false: another number of bits.
static bool places_of(unsigned mask, int size, int n, int *out) {
  int count = 0;
  for (int i = 0; i < size; i++)
    if (mask & (1u << i)) {
      if (count < n) out[count] = i;
      count++;
    }
  return count == n;
}

// The order of the largest minor that is not 0.
static int rank_of(const Integer m[4][4], int size) {
  for (int n = size; n > 0; n--)
    for (unsigned a = 0; a < 1u << size; a++)
      for (unsigned b = 0; b < 1u << size; b++) {
        int rows[4], columns[4];
        if (places_of(a, size, n, rows) && places_of(b, size, n, columns) &&
            minor_of(m, rows, columns, n) != 0)
          return n;
      }
  return 0;
}

static bool exact_ranks(const CagQuadric *q, ExactRanks *out) {
  double rows[4][4];
  Integer m[4][4];
  cag_quadric_rows(q, rows);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const double twice = 2 * rows[i][j];
      if (twice != floor(twice) || fabs(twice) > EXACT_MOST) return false;
      m[i][j] = (Integer)twice;
    }
  const Integer(*rows_of)[4] = (const Integer(*)[4])m;
  out->rank3 = rank_of(rows_of, 3);
  out->rank4 = rank_of(rows_of, 4);
  // With n = rank3 the sum of the principal minors of order n, and that of the minors of order n +
  // 1 with the last row, are the products of the nonzero eigenvalues without and with the constant.
  Integer without = 0, with = 0;
  for (unsigned a = 0; a < 8; a++) {
    int places[4];
    if (!places_of(a, 3, out->rank3, places)) continue;
    without += minor_of(rows_of, places, places, out->rank3);
    places[out->rank3] = 3;
    with += minor_of(rows_of, places, places, out->rank3 + 1);
  }
  out->k1 = (double)with / (double)without / 2;
  return true;
}

// --- Reduction ---

// The equation in its eigenbasis, with lengths in units of `size` and divided by about the largest
// eigenvalue: sum lam_i y_i^2 + lin_i y_i + k, with squares completed if lam_i is not zero. Both
// units are powers of two, so scaling is exact.
typedef struct Reduced {
  double size;
  double lam[3], lin[3], k1;
  CagVec3 v[3];
  double center[3]; // in the eigenbasis, own units; 0 along zero eigenvalues
  double g;         // length of the linear remainder
  int rank3;
} Reduced;

// The largest power of two not above x > 0.
static double power_of_two(double x) {
  int exponent;
  frexp(x, &exponent);
  return ldexp(1, exponent - 1);
}

// A limit between the eigenvalues (the diagonal) that are 0 and those that are not, for a known
// rank.
static double rank_limit(const double m[3][3], int rank) {
  double sizes[3] = {fabs(m[0][0]), fabs(m[1][1]), fabs(m[2][2])};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++)
      if (sizes[k] > sizes[k + 1]) {
        const double swap = sizes[k];
        sizes[k] = sizes[k + 1];
        sizes[k + 1] = swap;
      }
  return rank == 3 ? 0 : sizes[2 - rank];
}

static void reduce(const CagQuadric *q, Reduced *r) {
  const double *c = q->c;
  double m[3][3] = {
      {c[0], c[3] / 2, c[5] / 2}, {c[3] / 2, c[1], c[4] / 2}, {c[5] / 2, c[4] / 2, c[2]}};
  jacobi(m, r->v);
  double largest = power_of_two(fmax(fabs(m[0][0]), fmax(fabs(m[1][1]), fabs(m[2][2]))));
  CagVec3 linear = cag_vec3(c[6], c[7], c[8]);
  r->size = fmax(cag_norm(linear) / largest, sqrt(fabs(c[9]) / largest));
  r->size = r->size > 0 ? power_of_two(r->size) : 1;
  r->k1 = c[9] / (largest * r->size * r->size);
  r->rank3 = 0;
  r->g = 0;
  ExactRanks exact = {0};
  const bool is_exact = exact_ranks(q, &exact);
  double terms = 1; // terms whose sum is k1, weighted by their rounding
  const double zero =
      is_exact ? rank_limit((const double(*)[3])m, exact.rank3) : RANK_TOLERANCE * largest;
  for (int i = 0; i < 3; i++) {
    r->lam[i] = m[i][i] / largest;
    r->lin[i] = cag_dot(r->v[i], linear) / (largest * r->size);
    r->center[i] = 0;
    if (fabs(m[i][i]) <= zero) {
      r->lam[i] = 0;
      r->g = hypot(r->g, r->lin[i]);
      continue;
    }
    r->rank3++;
    r->center[i] = -r->lin[i] / (2 * r->lam[i]);
    r->k1 -= r->lin[i] * r->lin[i] / (4 * r->lam[i]);
    terms += r->lin[i] * r->lin[i] / (4 * fabs(r->lam[i]));
    // All eigenvalues have the rounding of the largest one.
    terms += 4 * (DBL_EPSILON / REST_TOLERANCE) * r->center[i] * r->center[i];
  }
  if (is_exact) {
    if (exact.rank4 < r->rank3 + 2) r->g = 0;
    if (exact.rank4 == r->rank3) r->k1 = 0;
    else if (r->g == 0) r->k1 = exact.k1 / (largest * r->size * r->size);
    return;
  }
  if (r->g <= REST_TOLERANCE) r->g = 0;
  if (fabs(r->k1) <= REST_TOLERANCE * terms) r->k1 = 0;
}

// The assignment of eigenvectors to e1, e2, e3, and their orientation.
typedef struct Roles {
  int axis[3];
  bool fixed[3]; // the orientation must not change
} Roles;

static double nearness(const Reduced *r, const int axis[3]) {
  double sum = 0;
  for (int i = 0; i < 3; i++) sum += fabs(entry(r->v[axis[i]], i));
  return sum;
}

// Orders e1 and e2 (or all three), if they are interchangeable, to be nearest to the world's axes.
static void order_free(const Reduced *r, int axis[3], bool all) {
  static const int ORDER[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}};
  int start[3] = {axis[0], axis[1], axis[2]};
  double best = -1;
  for (int k = 0; k < (all ? 6 : 2); k++) {
    int tried[3];
    for (int i = 0; i < 3; i++) tried[i] = start[ORDER[k][i]];
    double value = nearness(r, tried);
    if (value <= best * (1 + 1e-12)) continue;
    best = value;
    for (int i = 0; i < 3; i++) axis[i] = tried[i];
  }
}

// Right-handed frame with the given origin: free orientations follow the world's axes; then the
// free axis that is farthest from its world axis is reversed if necessary for handedness.
static void set_frame(const CagVec3 e[3], const bool fixed[3], CagVec3 origin, CagTransform *out) {
  CagVec3 axis[3];
  for (int i = 0; i < 3; i++)
    axis[i] = !fixed[i] && points_down(e[i]) ? cag_scaled(e[i], -1) : e[i];
  if (cag_dot(cag_cross(axis[0], axis[1]), axis[2]) < 0) {
    int turn = -1;
    for (int i = 0; i < 3; i++)
      if (!fixed[i] && (turn < 0 || fabs(entry(axis[i], i)) < fabs(entry(axis[turn], turn))))
        turn = i;
    axis[turn] = cag_scaled(axis[turn], -1);
  }
  *out = cag_transform_identity();
  out->planar = false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) out->m[i][j] = entry(axis[j], i);
  out->m[0][3] = origin.x;
  out->m[1][3] = origin.y;
  out->m[2][3] = origin.z;
}

static CagVec3 from_basis(const Reduced *r, const double y[3]) {
  CagVec3 p = {0, 0, 0};
  for (int i = 0; i < 3; i++) p = cag_madd(p, y[i] * r->size, r->v[i]);
  return p;
}

// Index of the eigenvalue whose sign differs from the other two (all three are nonzero).
static int odd_sign(const double lam[3]) {
  int positive = (lam[0] > 0) + (lam[1] > 0) + (lam[2] > 0);
  for (int i = 0; i < 3; i++)
    if ((lam[i] > 0) == (positive == 1)) return i;
  return 2;
}

static void central(const Reduced *r, CagQuadricForm *f) {
  int positive = (r->lam[0] > 0) + (r->lam[1] > 0) + (r->lam[2] > 0);
  bool same = positive == 0 || positive == 3;
  int axis[3] = {0, 1, 2};
  f->has_center = true;
  if (same) {
    bool real = r->k1 * r->lam[0] < 0;
    f->class_id = r->k1 == 0 ? CAG_QUADRIC_IMAGINARY_CONE
                  : real     ? CAG_QUADRIC_ELLIPSOID
                             : CAG_QUADRIC_IMAGINARY_ELLIPSOID;
    order_free(r, axis, true);
  } else {
    int odd = odd_sign(r->lam);
    axis[2] = odd;
    axis[0] = (odd + 1) % 3;
    axis[1] = (odd + 2) % 3;
    order_free(r, axis, false);
    // lam / -k1 of the odd axis: negative means one sheet.
    f->class_id = r->k1 == 0                 ? CAG_QUADRIC_CONE
                  : r->lam[odd] * -r->k1 < 0 ? CAG_QUADRIC_HYPERBOLOID_ONE
                                             : CAG_QUADRIC_HYPERBOLOID_TWO;
  }
  CagVec3 e[3];
  const bool fixed[3] = {false, false, false};
  for (int i = 0; i < 3; i++) {
    double lam = fabs(r->lam[axis[i]]);
    e[i] = r->v[axis[i]];
    f->semi[i] = r->k1 != 0                        ? r->size * sqrt(fabs(r->k1) / lam)
                 : f->class_id == CAG_QUADRIC_CONE ? sqrt(fabs(r->lam[axis[2]]) / lam)
                                                   : 0;
  }
  set_frame(e, fixed, from_basis(r, r->center), &f->frame);
}

static void paraboloid(const Reduced *r, int zero, CagQuadricForm *f) {
  int axis[3] = {(zero + 1) % 3, (zero + 2) % 3, zero};
  bool elliptic = r->lam[axis[0]] * r->lam[axis[1]] > 0;
  double vertex[3] = {r->center[0], r->center[1], r->center[2]};
  vertex[zero] = -r->k1 / r->lin[zero];
  CagVec3 up = r->v[zero];
  double slope = r->lin[zero];
  // Z = -(lam_1 X^2 + lam_2 Y^2) / slope: an elliptic paraboloid opens along e3; for a saddle e3
  // points up.
  if (elliptic ? r->lam[axis[0]] * slope > 0 : points_down(up)) {
    up = cag_scaled(up, -1);
    slope = -slope;
  }
  if (elliptic) order_free(r, axis, false);
  else if (r->lam[axis[0]] * slope > 0) {
    int swap = axis[0];
    axis[0] = axis[1];
    axis[1] = swap;
  }
  f->class_id = elliptic ? CAG_QUADRIC_ELLIPTIC_PARABOLOID : CAG_QUADRIC_HYPERBOLIC_PARABOLOID;
  for (int i = 0; i < 2; i++) f->semi[i] = sqrt(r->size * fabs(slope / r->lam[axis[i]]));
  const CagVec3 e[3] = {r->v[axis[0]], r->v[axis[1]], up};
  const bool fixed[3] = {false, false, true};
  set_frame(e, fixed, from_basis(r, vertex), &f->frame);
}

static void cylinder(const Reduced *r, int zero, CagQuadricForm *f) {
  int axis[3] = {(zero + 1) % 3, (zero + 2) % 3, zero};
  bool same = r->lam[axis[0]] * r->lam[axis[1]] > 0;
  if (same) {
    f->class_id = r->k1 == 0                    ? CAG_QUADRIC_IMAGINARY_INTERSECTING_PLANES
                  : r->k1 * r->lam[axis[0]] < 0 ? CAG_QUADRIC_ELLIPTIC_CYLINDER
                                                : CAG_QUADRIC_IMAGINARY_ELLIPTIC_CYLINDER;
  } else {
    f->class_id = r->k1 == 0 ? CAG_QUADRIC_INTERSECTING_PLANES : CAG_QUADRIC_HYPERBOLIC_CYLINDER;
  }
  // e1 is the axis that intersects the hyperbola.
  if (same || r->k1 == 0) order_free(r, axis, false);
  else if (r->lam[axis[0]] * r->k1 > 0) {
    int swap = axis[0];
    axis[0] = axis[1];
    axis[1] = swap;
  }
  if (r->k1 != 0)
    for (int i = 0; i < 2; i++) f->semi[i] = r->size * sqrt(fabs(r->k1 / r->lam[axis[i]]));
  else if (!same) {
    f->semi[0] = 1;
    f->semi[1] = sqrt(fabs(r->lam[axis[0]] / r->lam[axis[1]]));
  }
  const CagVec3 e[3] = {r->v[axis[0]], r->v[axis[1]], r->v[zero]};
  const bool fixed[3] = {false, false, false};
  set_frame(e, fixed, from_basis(r, r->center), &f->frame);
}

// One eigenvalue: y is along its eigenvector; the linear remainder is along a direction w in the
// perpendicular plane.
static void single(const Reduced *r, int one, CagQuadricForm *f) {
  if (r->g == 0) {
    f->class_id = r->k1 == 0                ? CAG_QUADRIC_COINCIDENT_PLANES
                  : r->k1 * r->lam[one] < 0 ? CAG_QUADRIC_PARALLEL_PLANES
                                            : CAG_QUADRIC_IMAGINARY_PARALLEL_PLANES;
    if (f->class_id == CAG_QUADRIC_PARALLEL_PLANES)
      f->semi[0] = r->size * sqrt(-r->k1 / r->lam[one]);
    const CagVec3 e[3] = {r->v[one], r->v[(one + 1) % 3], r->v[(one + 2) % 3]};
    const bool fixed[3] = {false, false, false};
    set_frame(e, fixed, from_basis(r, r->center), &f->frame);
    return;
  }
  f->class_id = CAG_QUADRIC_PARABOLIC_CYLINDER;
  double vertex[3], sign = r->lam[one] > 0 ? -1 : 1;
  CagVec3 opens = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    bool zero = i != one;
    vertex[i] = zero ? -r->k1 * r->lin[i] / (r->g * r->g) : r->center[i];
    if (zero) opens = cag_madd(opens, sign * r->lin[i] / r->g, r->v[i]);
  }
  CagVec3 across = r->v[one], along = cag_cross(opens, across);
  if (points_down(along)) {
    across = cag_scaled(across, -1);
    along = cag_scaled(along, -1);
  }
  f->semi[0] = r->size * r->g / (4 * fabs(r->lam[one])); // Y^2 = 4 a X
  const CagVec3 e[3] = {opens, across, along};
  const bool fixed[3] = {true, true, true};
  set_frame(e, fixed, from_basis(r, vertex), &f->frame);
}

// No quadratic terms.
static void linear(const CagQuadric *q, CagQuadricForm *f) {
  CagVec3 n = cag_vec3(q->c[6], q->c[7], q->c[8]);
  double length = cag_norm(n);
  f->class_id = length > 0 ? CAG_QUADRIC_PLANE : CAG_QUADRIC_EMPTY;
  f->rank4 = length > 0 ? 2 : 1;
  f->frame = cag_transform_identity();
  f->frame.planar = false;
  if (!(length > 0)) return;
  CagVec3 up = cag_unit(n), x = {1, 0, 0};
  if (fabs(up.x) > 0.9) x = cag_vec3(0, 1, 0);
  x = cag_unit(cag_madd(x, -cag_dot(x, up), up));
  const CagVec3 e[3] = {x, cag_cross(up, x), up};
  const bool fixed[3] = {true, true, true};
  set_frame(e, fixed, cag_scaled(up, -q->c[9] / length), &f->frame);
}

CagStatus cag_quadric_classify(const CagQuadric *q, CagQuadricForm *out, CagError *err) {
  CagStatus status = check(q, err);
  if (status) return status;
  CagQuadricForm f = {0};
  bool second = false;
  for (int i = 0; i < 6; i++) second = second || q->c[i] != 0;
  if (!second) linear(q, &f);
  else {
    Reduced r;
    reduce(q, &r);
    int zero = 0, one = 0;
    for (int i = 0; i < 3; i++) {
      if (r.lam[i] == 0) zero = i;
      else one = i;
    }
    f.rank3 = r.rank3;
    f.rank4 = r.rank3 + (r.g > 0 ? 2 : r.k1 != 0 ? 1 : 0);
    if (r.rank3 == 3) central(&r, &f);
    else if (r.rank3 == 2 && r.g > 0) paraboloid(&r, zero, &f);
    else if (r.rank3 == 2) cylinder(&r, zero, &f);
    else single(&r, one, &f);
    if (f.has_center) f.center = cag_vec3(f.frame.m[0][3], f.frame.m[1][3], f.frame.m[2][3]);
  }
  f.name = CLASS_NAME[f.class_id];
  *out = f;
  return CAG_OK;
}
