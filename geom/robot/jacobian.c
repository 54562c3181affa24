// The geometric Jacobian and its singularities.

#include "geom/linalg/tolerance.h"
#include "geom/robot/kernel.h"

// Singular values below this fraction of the largest are 0.
#define RANK_TOLERANCE CAG_COINCIDENT
// Sweeps of the one-sided Jacobi iteration; it converges in well under ten.
#define SWEEPS_MAX 60
// Rows are orthogonal if their cosine is below this.
#define ORTHOGONAL 1e-15

// A revolute joint moves the tool's origin by z x (p - o) plus its lead along z, a prismatic one by
// z.
static void fill_column(const CagRobotStage *s, CagVec3 o, CagVec3 z, CagVec3 p, double out[6]) {
  CagVec3 v = cag_scaled(cag_cross(z, cag_sub(p, o)), s->turn);
  v = cag_madd(v, s->slide, z);
  out[0] = v.x + 0.0;
  out[1] = v.y + 0.0;
  out[2] = v.z + 0.0;
  out[3] = s->turn * z.x + 0.0;
  out[4] = s->turn * z.y + 0.0;
  out[5] = s->turn * z.z + 0.0;
}

void cag_robot_jacobian(const CagRobot *r, const double *q, double (*columns)[6],
                        CagTransform *tool) {
  CagRobotTurns turns;
  CagRobotFrame f;
  CagVec3 origins[CAG_ROBOT_JOINTS_MAX], axes[CAG_ROBOT_JOINTS_MAX];
  cag_robot_turns(r, q, &turns);
  cag_robot_frame_from(&r->before, &f);
  for (size_t i = 0; i < r->joint_count; i++) {
    origins[i] = f.p;
    axes[i] = f.z;
    cag_robot_advance(&f, &r->stages[i], turns.sine[i], turns.cosine[i], q[i]);
  }
  for (size_t i = 0; i < r->joint_count; i++)
    fill_column(&r->stages[i], origins[i], axes[i], f.p, columns[i]);
  if (tool) cag_robot_frame_to(&f, tool);
}

void cag_robot_jacobian_tool(const CagRobot *r, const double *q, double (*columns)[6]) {
  CagTransform t;
  cag_robot_jacobian(r, q, columns, &t);
  for (size_t i = 0; i < r->joint_count; i++)
    for (int half = 0; half < 6; half += 3) {
      double v[3] = {columns[i][half], columns[i][half + 1], columns[i][half + 2]};
      for (int k = 0; k < 3; k++)
        columns[i][half + k] = t.m[0][k] * v[0] + t.m[1][k] * v[1] + t.m[2][k] * v[2] + 0.0;
    }
}

// --- Singular values ---

// Rotates two rows of n numbers until they are orthogonal. Returns true if they were already, or if
// one of them is zero: its square is at most `nothing`.
static bool orthogonalize(double *a, double *b, size_t n, double nothing) {
  double aa = 0, bb = 0, ab = 0;
  for (size_t i = 0; i < n; i++) {
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  if (aa <= nothing || bb <= nothing || fabs(ab) <= ORTHOGONAL * sqrt(aa * bb)) return true;
  double zeta = (bb - aa) / (2 * ab);
  double t = (zeta >= 0 ? 1 : -1) / (fabs(zeta) + sqrt(1 + zeta * zeta));
  double c = 1 / sqrt(1 + t * t), s = c * t;
  for (size_t i = 0; i < n; i++) {
    double x = a[i], y = b[i];
    a[i] = c * x - s * y;
    b[i] = s * x + c * y;
  }
  return false;
}

static void sort_descending(double *x, size_t n) {
  for (size_t i = 1; i < n; i++)
    for (size_t j = i; j > 0 && x[j] > x[j - 1]; j--) {
      double swap = x[j];
      x[j] = x[j - 1];
      x[j - 1] = swap;
    }
}

CagStatus cag_robot_singular_values(const CagRobot *r, const double *q, double values[6],
                                    size_t *count, size_t *rank, CagError *err) {
  double columns[CAG_ROBOT_JOINTS_MAX][6], rows[6][CAG_ROBOT_JOINTS_MAX], norms[6];
  size_t n = r->joint_count;
  cag_robot_jacobian(r, q, columns, NULL);
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 6; k++) rows[k][i] = columns[i][k] / (k < 3 ? r->reach : 1);
  double square = 0;
  for (int k = 0; k < 6; k++)
    for (size_t i = 0; i < n; i++) square += rows[k][i] * rows[k][i];
  double nothing = ORTHOGONAL * ORTHOGONAL * square;
  bool done = false;
  for (int sweep = 0; !done; sweep++) {
    if (sweep == SWEEPS_MAX)
      return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "", -1,
                      "the singular values did not converge");
    done = true;
    for (int i = 0; i < 5; i++)
      for (int j = i + 1; j < 6; j++) done = orthogonalize(rows[i], rows[j], n, nothing) && done;
  }
  for (int k = 0; k < 6; k++) {
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += rows[k][i] * rows[k][i];
    norms[k] = sqrt(sum);
  }
  sort_descending(norms, 6);
  *count = n < 6 ? n : 6;
  *rank = 0;
  for (size_t k = 0; k < *count; k++) {
    values[k] = norms[k];
    *rank += norms[k] > RANK_TOLERANCE * norms[0];
  }
  return CAG_OK;
}

// The square root of the determinant of the m x m Gram matrix, by Cholesky factorization.
static double root_determinant(double g[6][6], size_t m) {
  double product = 1;
  for (size_t k = 0; k < m; k++) {
    for (size_t j = 0; j < k; j++) g[k][k] -= g[k][j] * g[k][j];
    if (!(g[k][k] > 0)) return 0;
    g[k][k] = sqrt(g[k][k]);
    product *= g[k][k];
    for (size_t i = k + 1; i < m; i++) {
      for (size_t j = 0; j < k; j++) g[i][k] -= g[i][j] * g[k][j];
      g[i][k] /= g[k][k];
    }
  }
  return product;
}

// |det| of a square matrix by elimination with row pivots.
static double absolute_determinant(double m[6][6]) {
  double product = 1;
  for (int k = 0; k < 6; k++) {
    int pivot = k;
    for (int i = k + 1; i < 6; i++)
      if (fabs(m[i][k]) > fabs(m[pivot][k])) pivot = i;
    if (m[pivot][k] == 0) return 0;
    for (int j = 0; j < 6; j++) {
      double swap = m[k][j];
      m[k][j] = m[pivot][j];
      m[pivot][j] = swap;
    }
    product *= fabs(m[k][k]);
    for (int i = k + 1; i < 6; i++) {
      double factor = m[i][k] / m[k][k];
      for (int j = k; j < 6; j++) m[i][j] -= factor * m[k][j];
    }
  }
  return product;
}

double cag_robot_manipulability(const CagRobot *r, const double *q) {
  double columns[CAG_ROBOT_JOINTS_MAX][6], g[6][6] = {{0}};
  size_t n = r->joint_count;
  cag_robot_jacobian(r, q, columns, NULL);
  if (n == 6) { // avoids the squares in J J^T
    memcpy(g, columns, sizeof g);
    return absolute_determinant(g);
  }
  size_t m = n < 6 ? n : 6;
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < m; j++)
      for (size_t k = 0; k < (n < 6 ? 6 : n); k++)
        g[i][j] += n < 6 ? columns[i][k] * columns[j][k] : columns[k][i] * columns[k][j];
  return root_determinant(g, m);
}
