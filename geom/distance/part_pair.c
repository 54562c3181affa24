// Nearest points of exact shapes, by Newton's method, damped and kept within smooth pieces.

#include "geom/distance/part_pair.h"

#include <float.h>
#include <string.h>

#include "geom/mesh/distance.h"

#define ROUNDS 100

typedef struct Place {
  CagVec3 p, d[2], dd[3]; // point, first derivatives, second: 00, 01, 11
} Place;

static int freedom(const CagPart *part) {
  return part->curve ? 1 : part->surface || part->flat ? 2 : 0;
}

CagPartPair cag_part_pair(const CagPart *a, const CagPart *b) {
  CagPartPair pair = {.part = {a, b}};
  for (int side = 0; side < 2; side++) {
    pair.free[side] = freedom(pair.part[side]);
    for (int k = 0; k < pair.free[side]; k++) pair.x[pair.n++] = pair.part[side]->at[k];
  }
  return pair;
}

static CagStatus part_point(const CagPart *part, const double *x, Place *out, CagError *err) {
  *out = (Place){.p = part->p[0]};
  if (part->curve) {
    CagVec3 d[3];
    const CagSide side = x[0] >= part->high[0] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagStatus status = cag_curve_eval(part->curve, x[0], 2, side, d, err);
    if (status) return status;
    *out = (Place){.p = d[0], .d = {d[1]}, .dd = {d[2]}};
  } else if (part->surface) {
    CagVec3 d[9];
    const CagSide su = x[0] >= part->high[0] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    const CagSide sv = x[1] >= part->high[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagStatus status = cag_surface_eval(part->surface, x[0], x[1], 2, su, sv, d, err);
    if (status) return status;
    *out = (Place){d[0],
                   {d[cag_partial(2, 1, 0)], d[cag_partial(2, 0, 1)]},
                   {d[cag_partial(2, 2, 0)], d[cag_partial(2, 1, 1)], d[cag_partial(2, 0, 2)]}};
  } else if (part->flat) {
    // (1 - s) p0 + s ((1 - t) p1 + t p2), which fills the triangle from the unit square
    const CagVec3 far = cag_lerp(part->p[1], part->p[2], x[1]);
    const CagVec3 across = cag_sub(part->p[2], part->p[1]);
    out->p = cag_lerp(part->p[0], far, x[0]);
    out->d[0] = cag_sub(far, part->p[0]);
    out->d[1] = cag_scaled(across, x[0]);
    out->dd[1] = across;
  }
  return CAG_OK;
}

typedef struct Slope {
  double value; // half the square of the distance
  double g[4], h[4][4], scale[4];
} Slope;

static CagStatus slope(const CagPartPair *pair, const double *x, Slope *out, CagError *err) {
  Place place[2];
  CagVec3 d[4];
  CagStatus status = part_point(pair->part[0], x, &place[0], err);
  if (!status) status = part_point(pair->part[1], x + pair->free[0], &place[1], err);
  if (status) return status;
  const CagVec3 r = cag_sub(place[0].p, place[1].p);
  *out = (Slope){.value = cag_dot(r, r) / 2};
  for (int side = 0, at = 0; side < 2; at += pair->free[side++])
    for (int i = 0; i < pair->free[side]; i++)
      d[at + i] = cag_scaled(place[side].d[i], side ? -1 : 1);
  for (int i = 0; i < pair->n; i++) {
    out->g[i] = cag_dot(r, d[i]);
    out->scale[i] = cag_dot(d[i], d[i]);
    for (int k = 0; k < pair->n; k++) out->h[i][k] = cag_dot(d[i], d[k]);
  }
  for (int side = 0, at = 0; side < 2; at += pair->free[side++])
    for (int i = 0; i < pair->free[side]; i++)
      for (int k = 0; k < pair->free[side]; k++)
        out->h[at + i][at + k] += (side ? -1 : 1) * cag_dot(r, place[side].dd[i + k]);
  return CAG_OK;
}

// A flat triangle degenerates to one point where its first parameter is 0. There the second
// parameter is chosen: the side along which the distance decreases more.
static CagStatus leave_corners(CagPartPair *pair, Slope *here, CagError *err) {
  CagStatus status = CAG_OK;
  for (int side = 0, at = 0; !status && side < 2; at += pair->free[side++]) {
    if (!pair->part[side]->flat || pair->x[at] > 0) continue;
    const CagVec3 *p = pair->part[side]->p;
    // The derivative with respect to the first parameter is linear in the second.
    Slope end[2];
    for (int k = 0; !status && k < 2; k++) {
      pair->x[at + 1] = k;
      status = slope(pair, pair->x, &end[k], err);
    }
    if (status) break;
    const double along[2] = {end[0].g[at] / (cag_norm(cag_sub(p[1], p[0])) + DBL_MIN),
                             end[1].g[at] / (cag_norm(cag_sub(p[2], p[0])) + DBL_MIN)};
    const int k = along[1] < along[0];
    pair->x[at + 1] = k;
    *here = end[k];
  }
  return status;
}

static void limits(const CagPartPair *pair, int i, double *low, double *high, bool *ring) {
  const int side = i >= pair->free[0], k = side ? i - pair->free[0] : i;
  const CagPart *part = pair->part[side];
  *low = part->low[k];
  *high = part->high[k];
  *ring = part->ring[k];
}

// Solves (h + damping scale) d = -g for the free parameters (Cholesky); false: not positive.
static bool solve(const Slope *s, const bool *fixed, int n, double damping, double *d) {
  double l[4][4] = {{0}}, y[4];
  for (int i = 0; i < n; i++) {
    for (int k = 0; k <= i; k++) {
      double sum = fixed[i] || fixed[k] ? (double)(i == k) : s->h[i][k];
      if (i == k && !fixed[i]) sum += damping * s->scale[i] + 1e-300;
      for (int m = 0; m < k; m++) sum -= l[i][m] * l[k][m];
      if (i != k) l[i][k] = sum / l[k][k];
      else if (sum > 0) l[i][i] = sqrt(sum);
      else return false;
    }
    y[i] = fixed[i] ? 0 : -s->g[i];
    for (int m = 0; m < i; m++) y[i] -= l[i][m] * y[m];
    y[i] /= l[i][i];
  }
  for (int i = n - 1; i >= 0; i--) {
    d[i] = y[i];
    for (int m = i + 1; m < n; m++) d[i] -= l[m][i] * d[m];
    d[i] /= l[i][i];
  }
  return true;
}

static void advance(const CagPartPair *pair, const double *d, double *x) {
  for (int i = 0; i < pair->n; i++) {
    double low, high;
    bool ring;
    limits(pair, i, &low, &high, &ring);
    x[i] = pair->x[i] + d[i];
    if (ring) x[i] -= (high - low) * floor((x[i] - low) / (high - low));
    x[i] = fmin(fmax(x[i], low), high);
  }
}

CagStatus cag_part_pair_refine(CagPartPair *pair, double *out, CagVec3 points[2], CagError *err) {
  Slope here, there;
  double damping = 1e-6;
  CagStatus status = slope(pair, pair->x, &here, err);
  for (int round = 0; !status && pair->n && round < ROUNDS && damping < 1e12; round++) {
    bool fixed[4];
    double d[4], x[4];
    status = leave_corners(pair, &here, err);
    if (status) break;
    for (int i = 0; i < pair->n; i++) {
      double low, high;
      bool ring;
      limits(pair, i, &low, &high, &ring);
      fixed[i] =
          !ring && ((pair->x[i] <= low && here.g[i] > 0) || (pair->x[i] >= high && here.g[i] < 0));
    }
    if (!solve(&here, fixed, pair->n, damping, d)) {
      damping = fmax(damping * 10, 1e-3);
      continue;
    }
    double gain = 0; // to first order
    for (int i = 0; i < pair->n; i++) gain -= here.g[i] * d[i];
    if (gain <= DBL_EPSILON / 4 * here.value) break;
    advance(pair, d, x);
    status = slope(pair, x, &there, err);
    if (status) break;
    if (!(there.value < here.value)) {
      damping = fmax(damping * 10, 1e-6);
      continue;
    }
    memcpy(pair->x, x, sizeof x);
    here = there;
    damping /= 10;
  }
  if (status) return status;
  *out = sqrt(2 * here.value);
  for (int side = 0; !status && side < 2; side++) {
    Place place;
    status = part_point(pair->part[side], pair->x + (side ? pair->free[0] : 0), &place, err);
    points[side] = place.p;
  }
  return status;
}

// The point of the triangle nearest to p, as weights of its second and third corner.
static double nearest_in_triangle(CagVec3 p, const CagVec3 t[3], double share[2]) {
  CagVec3 foot;
  if (cag_foot_in_triangle(p, t, &foot)) {
    const CagVec3 ab = cag_sub(t[1], t[0]), ac = cag_sub(t[2], t[0]), n = cag_cross(ab, ac);
    const CagVec3 to = cag_sub(foot, t[0]);
    share[0] = cag_dot(cag_cross(to, ac), n) / cag_dot(n, n);
    share[1] = cag_dot(cag_cross(ab, to), n) / cag_dot(n, n);
    return cag_norm(cag_sub(p, foot));
  }
  double nearest = INFINITY;
  for (int i = 0; i < 3; i++) {
    const CagVec3 a = t[i], b = t[(i + 1) % 3], on = cag_nearest_of_segment(p, a, b);
    const double d = cag_norm(cag_sub(p, on)), length = cag_norm(cag_sub(b, a));
    if (d >= nearest) continue;
    const double x = length > 0 ? cag_norm(cag_sub(on, a)) / length : 0;
    const double shares[3][2] = {{x, 0}, {1 - x, x}, {0, 1 - x}};
    nearest = d;
    memcpy(share, shares[i], 2 * sizeof *share);
  }
  return nearest;
}

bool cag_part_pair_leave_corner(CagPartPair *pair, double distance, CagStatus *status,
                                CagError *err) {
  const double nearer = 1 - 1e-9;
  for (int side = 0; side < 2; side++) {
    if (!pair->part[side]->flat) continue;
    Place other;
    double share[2], *x = pair->x + (side ? pair->free[0] : 0);
    *status = part_point(pair->part[1 - side], pair->x + (side ? 0 : pair->free[0]), &other, err);
    if (*status || !(nearest_in_triangle(other.p, pair->part[side]->p, share) < nearer * distance))
      return false;
    x[0] = fmin(1, share[0] + share[1]);
    if (x[0] > 0) x[1] = fmin(1, fmax(0, share[1] / x[0]));
    return true;
  }
  return false;
}
