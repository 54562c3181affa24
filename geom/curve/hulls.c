// Distance of two convex hulls, as the point of their difference nearest to the origin.
//
// The hull of all differences a - b is never constructed: a simplex of at most four differences
// moves towards the origin until no difference is closer in its direction.

#include "geom/curve/hulls.h"
#include "geom/linalg/tolerance.h"

#include <string.h>

// Gaps below this fraction of the size of the points are contact.
#define CONTACT CAG_ROUNDING
// The simplex has converged when no difference is closer by more than this fraction.
#define NEARER 1e-14
// Limit on the rounds, each of which adds a difference; far more than any hull needs before
// rounding stops it.
#define ROUNDS 1000

static CagVec3 farthest(const CagVec3 *p, size_t n, CagVec3 direction) {
  size_t best = 0;
  double most = cag_dot(p[0], direction);
  for (size_t i = 1; i < n; i++) {
    const double d = cag_dot(p[i], direction);
    if (d > most) {
      most = d;
      best = i;
    }
  }
  return p[best];
}

// Weights of the point nearest to the origin in the plane through k points, by the normal
// equations. Returns false if the points are dependent.
static bool affine_nearest(const CagVec3 *p, int k, double *weights) {
  double m[3][4] = {0};
  for (int i = 1; i < k; i++) {
    const CagVec3 e = cag_sub(p[i], p[0]);
    for (int j = 1; j < k; j++) m[i - 1][j - 1] = cag_dot(e, cag_sub(p[j], p[0]));
    m[i - 1][k - 1] = -cag_dot(e, p[0]);
  }
  const int n = k - 1;
  for (int c = 0; c < n; c++) {
    int pivot = c;
    for (int r = c + 1; r < n; r++)
      if (fabs(m[r][c]) > fabs(m[pivot][c])) pivot = r;
    if (m[pivot][c] == 0) return false;
    double row[4];
    memcpy(row, m[pivot], sizeof row);
    memcpy(m[pivot], m[c], sizeof row);
    memcpy(m[c], row, sizeof row);
    for (int r = 0; r < n; r++) {
      if (r == c) continue;
      const double f = m[r][c] / m[c][c];
      for (int j = c; j <= n; j++) m[r][j] -= f * m[c][j];
    }
  }
  weights[0] = 1;
  for (int i = 0; i < n; i++) {
    weights[i + 1] = m[i][n] / m[i][i];
    weights[0] -= weights[i + 1];
  }
  return true;
}

// Reduces the simplex to the face that contains its point nearest to the origin; returns that
// point.
static CagVec3 reduce(CagVec3 *simplex, int *k) {
  CagVec3 best = simplex[0], kept[4] = {simplex[0]};
  int kept_count = 1;
  double least = INFINITY;
  for (int subset = 1; subset < 1 << *k; subset++) {
    CagVec3 face[4];
    double weights[4] = {1};
    int n = 0;
    for (int i = 0; i < *k; i++)
      if (subset >> i & 1) face[n++] = simplex[i];
    if (!affine_nearest(face, n, weights)) continue;
    CagVec3 v = {0, 0, 0};
    bool inside = true;
    for (int i = 0; i < n; i++) {
      inside = inside && weights[i] >= 0;
      v = cag_madd(v, weights[i], face[i]);
    }
    if (!inside || !(cag_dot(v, v) < least)) continue;
    least = cag_dot(v, v);
    best = v;
    kept_count = n;
    memcpy(kept, face, sizeof face);
  }
  memcpy(simplex, kept, sizeof kept);
  *k = kept_count;
  return best;
}

CagVec3 cag_hulls_gap(const CagVec3 *a, size_t n, const CagVec3 *b, size_t m) {
  CagVec3 simplex[4] = {cag_sub(a[0], b[0])}, v = simplex[0];
  int k = 1;
  for (int round = 0; round < ROUNDS; round++) {
    const double vv = cag_dot(v, v);
    if (vv == 0) return v;
    const CagVec3 w = cag_sub(farthest(a, n, cag_scaled(v, -1)), farthest(b, m, v));
    if (vv - cag_dot(v, w) <= NEARER * vv || k == 4) return v;
    simplex[k++] = w;
    const CagVec3 next = reduce(simplex, &k);
    if (!(cag_dot(next, next) < vv)) return v;
    v = next;
  }
  return v;
}

bool cag_hulls_disjoint(const CagVec3 *a, size_t n, const CagVec3 *b, size_t m) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < n; i++) cag_bounds_add(&box, a[i]);
  for (size_t i = 0; i < m; i++) cag_bounds_add(&box, b[i]);
  const double size = cag_norm(cag_sub(box.max, box.min));
  return cag_norm(cag_hulls_gap(a, n, b, m)) > CONTACT * size;
}
