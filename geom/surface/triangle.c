// De Casteljau's scheme on triangular nets.

#include "geom/surface/triangle.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"

// Tolerance for the sum of barycentric coordinates, and for negative ones.
#define BARYCENTRIC_SLACK CAG_COINCIDENT

// Index of b_ijk: row j + k, position k.
static size_t triangle_index(int j, int k) {
  return (size_t)(j + k) * (size_t)(j + k + 1) / 2 + (size_t)k;
}

static CagStatus check_coordinates(const double w[3], CagError *err) {
  double sum = w[0] + w[1] + w[2];
  for (int c = 0; c < 3; c++)
    if (!(w[c] >= -BARYCENTRIC_SLACK))
      return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "W", c,
                      "barycentric coordinates must not be negative within the triangle: W[%d] = "
                      "%g",
                      c, w[c]);
  if (!(fabs(sum - 1) <= BARYCENTRIC_SLACK))
    return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "W", -1,
                    "barycentric coordinates must sum to 1: [%g, %g, %g] sum to %.12g", w[0], w[1],
                    w[2], sum);
  return CAG_OK;
}

static CagVec3 blend(const double w[3], CagVec3 a, CagVec3 b, CagVec3 c) {
  return cag_madd(cag_madd(cag_scaled(a, w[0]), w[1], b), w[2], c);
}

// One step: reduces a net of this degree to one of a degree less, in place. Each point uses only
// points that have not been overwritten.
static void step(CagVec3 *net, int degree, const double w[3]) {
  for (int row = 0; row < degree; row++)
    for (int k = 0; k <= row; k++) {
      int j = row - k;
      net[triangle_index(j, k)] = blend(w, net[triangle_index(j, k)], net[triangle_index(j + 1, k)],
                                        net[triangle_index(j, k + 1)]);
    }
}

static CagVec3 *copy_net(const CagVec3 *net, int degree) {
  size_t n = cag_triangle_count(degree);
  CagVec3 *copy = cag_malloc(n * sizeof *copy);
  if (copy) memcpy(copy, net, n * sizeof *copy);
  return copy;
}

CagStatus cag_triangle_at(const CagVec3 *net, int degree, const double uvw[3], CagTriangleJet *out,
                          CagError *err) {
  CagStatus status = check_coordinates(uvw, err);
  if (status) return status;
  CagVec3 *b = copy_net(net, degree);
  if (!b) return cag_fail_memory(err);
  for (int left = degree; left > 1; left--) step(b, left, uvw);
  *out = (CagTriangleJet){b[0], {0, 0, 0}, {0, 0, 0}};
  if (degree > 0) {
    out->point = blend(uvw, b[0], b[1], b[2]);
    out->ds = cag_scaled(cag_sub(b[0], b[2]), degree);
    out->dt = cag_scaled(cag_sub(b[1], b[2]), degree);
  }
  cag_free(b);
  return CAG_OK;
}

void cag_triangle_elevate(const CagVec3 *net, int degree, CagVec3 *out) {
  int n = degree + 1;
  for (int row = 0; row <= n; row++)
    for (int k = 0; k <= row; k++) {
      int j = row - k, i = n - row;
      CagVec3 sum = {0, 0, 0};
      if (i > 0) sum = cag_madd(sum, (double)i / n, net[triangle_index(j, k)]);
      if (j > 0) sum = cag_madd(sum, (double)j / n, net[triangle_index(j - 1, k)]);
      if (k > 0) sum = cag_madd(sum, (double)k / n, net[triangle_index(j, k - 1)]);
      out[triangle_index(j, k)] = sum;
    }
}

// After r steps the border of the net opposite corner c, where that index is 0, is the row with
// index r of the part without corner c.
CagStatus cag_triangle_split(const CagVec3 *net, int degree, const double uvw[3],
                             CagVec3 *const out[3], CagError *err) {
  CagStatus status = check_coordinates(uvw, err);
  if (status) return status;
  CagVec3 *b = copy_net(net, degree);
  if (!b) return cag_fail_memory(err);
  for (int r = 0; r <= degree; r++) {
    int left = degree - r;
    for (int m = 0; m <= left; m++) {
      out[0][triangle_index(m, left - m)] = b[triangle_index(m, left - m)];
      out[1][triangle_index(r, m)] = b[triangle_index(0, m)];
      out[2][triangle_index(m, r)] = b[triangle_index(m, 0)];
    }
    if (left > 0) step(b, left, uvw);
  }
  cag_free(b);
  return CAG_OK;
}
