// Interval bounds of the derivatives of a motion: the evaluation of motion.c in interval
// arithmetic.

#include <string.h>

#include "base/memory.h"
#include "geom/curve/range.h"
#include "geom/surface/family.h"
#include "geom/surface/motion_parts.h"

#define ORDER CAG_MOTION_ORDER

// --- Joints ---

CagStatus cag_motion_joints(const CagMotion *m, double **out, size_t *n, CagError *err) {
  const CagChebyshev *functions[] = {m->how.twist.function, m->how.scale.function, m->rows};
  size_t most = m->count + 2, count = 0;
  for (int i = 0; i < 3; i++)
    if (functions[i]) most += cag_chebyshev_joints(functions[i], NULL, 0);
  double *all = cag_malloc(most * sizeof *all);
  if (!all) return cag_fail_memory(err);
  for (size_t i = 0; i < m->count; i++) all[1 + count++] = m->segments[i].v0;
  for (int i = 0; i < 3; i++)
    if (functions[i])
      count += cag_chebyshev_joints(functions[i], all + 1 + count, most - 1 - count);
  count = cag_surface_tidy_breaks(all + 1, count, m->start, m->end);
  all[0] = m->start;
  all[count + 1] = m->end;
  *out = all;
  *n = count + 1;
  return CAG_OK;
}

// --- Frames ---

typedef struct Frame {
  CagInterval3 c[ORDER], t[ORDER], n1[ORDER], n2[ORDER];
} Frame;

static CagInterval3 constant(CagVec3 v) {
  return (CagInterval3){cag_interval(v.x), cag_interval(v.y), cag_interval(v.z)};
}

static CagInterval3 scaled(CagInterval3 a, double f) {
  return (CagInterval3){cag_interval_scaled(a.x, f), cag_interval_scaled(a.y, f),
                        cag_interval_scaled(a.z, f)};
}

static CagInterval within_one(CagInterval a) {
  return (CagInterval){cag_higher(a.lo, -1), cag_lower(a.hi, 1)};
}

// The unit vector of `a`. If the range of `a` contains 0, the direction is unknown: each coordinate
// gets the range -1..1, and derivatives have no bounds.
static bool unit_ranges(const CagInterval3 *a, int n, CagInterval3 *out) {
  const CagInterval any = {-1, 1};
  if (cag_intervals3_unit(a, n, out)) {
    out[0] = (CagInterval3){within_one(out[0].x), within_one(out[0].y), within_one(out[0].z)};
    return true;
  }
  out[0] = (CagInterval3){any, any, any};
  return n == 0;
}

// Path and unit tangent; `bend`: the second derivative, or NULL.
static bool tangent_ranges(const CagMotion *m, double a, double b, int n, Frame *out,
                           CagInterval3 *bend) {
  CagInterval3 c[ORDER + 2], velocity[ORDER];
  if (!cag_curve_ranges(m->path, a, b, n + 2, c)) return false;
  memcpy(out->c, c, (size_t)(n + 1) * sizeof *c);
  for (int k = 0; k <= n; k++) {
    velocity[k] = scaled(c[k + 1], k + 1);
    if (bend) bend[k] = scaled(c[k + 2], (k + 1) * (k + 2));
  }
  return unit_ranges(velocity, n, out->t);
}

// The range of the polynomial of the angle on the segment.
static void angle_ranges(const CagMotionSegment *g, double a, double b, int n, CagInterval *out) {
  const double half = (g->v1 - g->v0) / 2, middle = (g->v0 + g->v1) / 2;
  const double s = ((a + b) / 2 - middle) / half, reach = (b - a) / 2 / half;
  double d[CAG_MOTION_NODES + 1], power = 1;
  // Taylor shift to s, by repeated synthetic division.
  memcpy(d, g->phi, sizeof d);
  for (int k = 0; k < CAG_MOTION_NODES; k++)
    for (int i = CAG_MOTION_NODES - 1; i >= k; i--) d[i] += s * d[i + 1];
  for (int k = 0; k <= n; k++) {
    double off = 0, binomial = 1, step = 1;
    for (int i = k + 1; i <= CAG_MOTION_NODES; i++) {
      binomial *= (double)i / (i - k);
      step *= reach;
      off += binomial * fabs(d[i]) * step;
    }
    const double at = k <= CAG_MOTION_NODES ? d[k] : 0;
    out[k] = cag_interval_scaled((CagInterval){at - off, at + off}, power);
    power /= half;
  }
}

// Rotates x and y by the angle.
static void turn_ranges(const CagInterval3 *x, const CagInterval3 *y, const CagInterval *by, int n,
                        CagInterval3 *to_x, CagInterval3 *to_y) {
  CagInterval s[ORDER], c[ORDER];
  CagInterval3 p[ORDER], q[ORDER];
  cag_intervals_sincos(by, n, s, c);
  cag_intervals3_scaled(x, c, n, p);
  cag_intervals3_scaled(y, s, n, q);
  cag_intervals3_add(p, q, n, to_x);
  cag_intervals3_scaled(y, c, n, p);
  cag_intervals3_scaled(x, s, n, q);
  cag_intervals3_sub(p, q, n, to_y);
}

// The cross product of perpendicular unit vectors.
static void perpendicular_ranges(const CagInterval3 *a, const CagInterval3 *b, int n,
                                 CagInterval3 *out) {
  cag_intervals3_cross(a, b, n, out);
  out[0] = (CagInterval3){within_one(out[0].x), within_one(out[0].y), within_one(out[0].z)};
}

static bool minimizing(const CagMotion *m, const CagMotionSegment *g, double a, double b, int n,
                       Frame *out) {
  CagInterval3 fixed[ORDER] = {{{0, 0}, {0, 0}, {0, 0}}}, across[ORDER], e1[ORDER], e2[ORDER];
  CagInterval phi[ORDER];
  fixed[0] = constant(g->a);
  if (!tangent_ranges(m, a, b, n, out, NULL)) return false;
  cag_intervals3_cross(out->t, fixed, n, across);
  if (!unit_ranges(across, n, e2)) return false;
  perpendicular_ranges(e2, out->t, n, e1);
  angle_ranges(g, a, b, n, phi);
  turn_ranges(e1, e2, phi, n, out->n1, out->n2);
  return true;
}

static bool frenet(const CagMotion *m, double a, double b, int n, Frame *out) {
  CagInterval3 bend[ORDER], binormal[ORDER];
  if (!tangent_ranges(m, a, b, n, out, bend)) return false;
  cag_intervals3_cross(out->t, bend, n, binormal);
  if (!unit_ranges(binormal, n, out->n2)) return false;
  perpendicular_ranges(out->n2, out->t, n, out->n1);
  return true;
}

static bool upright(const CagMotion *m, double a, double b, int n, Frame *out) {
  CagInterval3 up[ORDER] = {{{0, 0}, {0, 0}, {0, 0}}}, across[ORDER];
  up[0] = constant(m->how.up);
  if (!tangent_ranges(m, a, b, n, out, NULL)) return false;
  cag_intervals3_cross(up, out->t, n, across);
  if (!unit_ranges(across, n, out->n1)) return false;
  perpendicular_ranges(out->t, out->n1, n, out->n2);
  return true;
}

static bool standing(const CagMotion *m, double a, double b, int n, Frame *out) {
  memset(out, 0, sizeof *out);
  if (!cag_curve_ranges(m->path, a, b, n, out->c)) return false;
  out->n1[0] = constant(m->fixed[0]);
  out->n2[0] = constant(m->fixed[1]);
  out->t[0] = constant(m->fixed[2]);
  return true;
}

static bool frame_ranges(const CagMotion *m, const CagMotionSegment *g, double a, double b, int n,
                         Frame *out) {
  switch (m->how.orient) {
  case CAG_ORIENT_FRENET: return frenet(m, a, b, n, out);
  case CAG_ORIENT_UP: return upright(m, a, b, n, out);
  case CAG_ORIENT_FIXED: return standing(m, a, b, n, out);
  case CAG_ORIENT_RMF: break;
  }
  return minimizing(m, g, a, b, n, out);
}

// A linear function over [a, b] from its values at both ends.
static void linear_ranges(double at_a, double at_b, double length, int n, CagInterval *out) {
  for (int k = 0; k <= n; k++) out[k] = cag_interval(0);
  out[0] = (CagInterval){fmin(at_a, at_b), fmax(at_a, at_b)};
  if (n > 0) out[1] = cag_interval((at_b - at_a) / length);
}

static void shear_ranges(const CagMotionPiece *p, double a, double b, int n, Frame *f) {
  for (int axis = 0; axis < 2; axis++) {
    const double slope = (p->end[axis] - p->start[axis]) / (p->v1 - p->v0);
    CagInterval shift[ORDER];
    CagInterval3 along[ORDER], *spoke = axis == 0 ? f->n1 : f->n2;
    if (p->start[axis] == 0 && slope == 0) continue;
    linear_ranges(p->start[axis] + slope * (a - p->v0), p->start[axis] + slope * (b - p->v0), b - a,
                  n, shift);
    cag_intervals3_scaled(f->t, shift, n, along);
    cag_intervals3_add(spoke, along, n, spoke);
  }
}

static void along_ranges(const CagMotion *m, const CagAlong *f, double a, double b, int n,
                         CagInterval *out) {
  if (f->function) {
    cag_chebyshev_ranges(f->function, a, b, n, out);
    return;
  }
  const double rate = (f->end - f->start) / (m->end - m->start);
  linear_ranges(f->start + rate * (a - m->start), f->start + rate * (b - m->start), b - a, n, out);
}

static void map_ranges(const CagMotion *m, double a, double b, int n, CagMotionRanges *out) {
  CagInterval x[12 * ORDER];
  CagInterval3 *columns[] = {out->x, out->y, out->z, out->origin};
  cag_chebyshev_ranges(m->rows, a, b, n, x);
  for (int j = 0; j < 4; j++)
    for (int k = 0; k <= n; k++)
      columns[j][k] =
          (CagInterval3){x[j * (n + 1) + k], x[(4 + j) * (n + 1) + k], x[(8 + j) * (n + 1) + k]};
}

bool cag_motion_ranges(const CagMotion *m, double a, double b, int n, CagMotionRanges *out) {
  if (!m->path) {
    map_ranges(m, a, b, n, out);
    return true;
  }
  const CagMotionSegment *g = cag_motion_segment(m, a + (b - a) / 2, CAG_SIDE_RIGHT);
  const size_t size = (size_t)(n + 1) * sizeof(CagInterval3);
  CagInterval by[ORDER];
  CagInterval3 longer[ORDER];
  Frame f;
  if (!frame_ranges(m, g, a, b, n, &f)) return false;
  shear_ranges(&m->pieces[g->piece], a, b, n, &f);
  memcpy(out->origin, f.c, size);
  memcpy(out->z, f.t, size);
  if (cag_along_is_constant(&m->how.twist, 0)) {
    memcpy(out->x, f.n1, size);
    memcpy(out->y, f.n2, size);
  } else {
    along_ranges(m, &m->how.twist, a, b, n, by);
    turn_ranges(f.n1, f.n2, by, n, out->x, out->y);
  }
  if (cag_along_is_constant(&m->how.scale, 1)) return true;
  CagInterval3 *spokes[] = {out->x, out->y, out->z};
  along_ranges(m, &m->how.scale, a, b, n, by);
  for (int i = 0; i < 3; i++) {
    cag_intervals3_scaled(spokes[i], by, n, longer);
    memcpy(spokes[i], longer, size);
  }
  return true;
}
