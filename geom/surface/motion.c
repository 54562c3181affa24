// Frames along a path as power series, so that derivatives are exactly those of the evaluated
// function.
//
// The rotation minimizing frame is stored as an angle phi(v) relative to an analytic frame: on each
// segment of the path a fixed vector a defines e2 = unit(C' x a), e1 = e2 x T, and n1 = cos phi e1
// + sin phi e2 with phi' = e1 . (C'' x a) / |C' x a|. phi' is integrated as a polynomial per
// segment, and segments match to rounding in all derivatives that the path has. A closed path
// returns the frame rotated by some angle; this is distributed evenly over v.
//
// At a corner of the path the bodies on both sides are mitered: each section is shifted along the
// tangent by a multiple that grows linearly over the smooth piece until it lies in the bisecting
// plane, so that straight pieces are exact prisms cut by that plane.

#include "geom/surface/motion.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"
#include "geom/surface/motion_parts.h"

#define NODES CAG_MOTION_NODES
// Gauss-Legendre nodes at which phi' is sampled on a segment; their number is the degree of phi.
static const double NODE[NODES] = {
    -0.960289856497536231683560868569, -0.796666477413626739591553936476,
    -0.525532409916328985817739049189, -0.183434642495649804939476142360,
    0.183434642495649804939476142360,  0.525532409916328985817739049189,
    0.796666477413626739591553936476,  0.960289856497536231683560868569};
static const double WEIGHT[NODES] = {
    0.101228536290376259152531354310, 0.222381034453374470544355994426,
    0.313706645877887287337962201987, 0.362683783378361982965150449277,
    0.362683783378361982965150449277, 0.313706645877887287337962201987,
    0.222381034453374470544355994426, 0.101228536290376259152531354310};

// A segment is short enough if the last terms of phi are below this, in radians.
#define ANGLE_TOLERANCE 1e-13
#define MAX_DEPTH 20
// Minimum sine of the angle between the tangent and the fixed vector.
#define LEAST_SINE 0.5
// A path has a corner if its unit tangents differ by more than this.
#define CORNER CAG_PARALLEL

// Maximum number of derivatives of the velocity that may vanish with it.
#define MOST_STOP 3

// --- Truncated power series in v ---

#define ORDER CAG_MOTION_ORDER

static void series_dot(const CagVec3 *a, const CagVec3 *b, int n, double *out) {
  for (int k = 0; k <= n; k++) {
    out[k] = 0;
    for (int j = 0; j <= k; j++) out[k] += cag_dot(a[j], b[k - j]);
  }
}

static void series_cross(const CagVec3 *a, const CagVec3 *b, int n, CagVec3 *out) {
  for (int k = 0; k <= n; k++) {
    out[k] = cag_vec3(0, 0, 0);
    for (int j = 0; j <= k; j++) out[k] = cag_add(out[k], cag_cross(a[j], b[k - j]));
  }
}

static void series_scale(const CagVec3 *a, const double *f, int n, CagVec3 *out) {
  for (int k = 0; k <= n; k++) {
    out[k] = cag_vec3(0, 0, 0);
    for (int j = 0; j <= k; j++) out[k] = cag_madd(out[k], f[k - j], a[j]);
  }
}

static void series_unit(const CagVec3 *a, int n, CagVec3 *out) {
  double w[ORDER] = {0}, f[ORDER] = {0}; // f = w^(-1/2)
  series_dot(a, a, n, w);
  f[0] = 1 / sqrt(w[0]);
  for (int k = 1; k <= n; k++) {
    double sum = 0;
    for (int j = 1; j <= k; j++) sum += (-0.5 * j - (k - j)) * w[j] * f[k - j];
    f[k] = sum / (k * w[0]);
  }
  series_scale(a, f, n, out);
}

static void series_sincos(const double *phi, int n, double *s, double *c) {
  s[0] = sin(phi[0]);
  c[0] = cos(phi[0]);
  for (int k = 1; k <= n; k++) {
    s[k] = c[k] = 0;
    for (int j = 1; j <= k; j++) {
      s[k] += j * phi[j] * c[k - j] / k;
      c[k] -= j * phi[j] * s[k - j] / k;
    }
  }
}

// --- Frames ---

typedef struct Frame {
  CagVec3 c[ORDER], t[ORDER], n1[ORDER], n2[ORDER]; // series: k-th derivative over k!
} Frame;

static void angle_series(const CagMotionSegment *g, double v, int n, double *out) {
  double half = (g->v1 - g->v0) / 2, s = (v - (g->v0 + g->v1) / 2) / half;
  // Taylor shift of the polynomial to s, by repeated synthetic division.
  double a[NODES + 1];
  for (int i = 0; i <= NODES; i++) a[i] = g->phi[i];
  double power = 1;
  int last = n < NODES ? n : NODES;
  for (int k = last + 1; k <= n; k++) out[k] = 0;
  for (int k = 0; k <= last; k++) {
    for (int i = NODES - 1; i >= k; i--) a[i] += s * a[i + 1];
    out[k] = a[k] * power;
    power /= half;
  }
}

static CagStatus zero_tangent(double v, CagError *err) {
  char text[32];
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_zero_tangent, "path", -1,
                  "`path` must have a tangent everywhere: it vanishes at %s",
                  cag_number_text(v, text));
}

// The unit tangent as a series of order n, from that of the velocity. Where the path stops, as at
// repeated control points, it is the limit from the given side: the velocity is a power of the
// parameter times a series that does not vanish. Within a segment the path continues only for an
// even power; at segment ends transport() detects paths that turn back.
static CagStatus unit_tangent(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                              CagSide side, const CagVec3 *velocity, CagVec3 *out, CagError *err) {
  if (cag_norm(velocity[0]) > 0) {
    series_unit(velocity, n, out);
    return CAG_OK;
  }
  const bool left = side == CAG_SIDE_LEFT, at_end = v == (left ? g->v1 : g->v0);
  CagVec3 c[ORDER + MOST_STOP + 1], direction[ORDER];
  CagStatus status = cag_curve_eval(t->path, v, n + 1 + MOST_STOP, side, c, err);
  if (status) return status;
  int power = 1;
  while (power <= MOST_STOP && !(cag_norm(c[power + 1]) > 0)) power++;
  if (power > MOST_STOP || (power % 2 && !at_end)) return zero_tangent(v, err);
  double factorial = left && power % 2 ? -1 : 1;
  for (int k = 1; k <= power; k++) factorial *= k;
  for (int k = 0; k <= n; k++) {
    direction[k] = cag_scaled(c[k + power + 1], 1 / factorial);
    factorial *= k + power + 1;
  }
  series_unit(direction, n, out);
  return CAG_OK;
}

// Unit tangent and reference frame at v on segment g, as series of order n, and the path's point.
static CagStatus reference(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                           CagSide side, Frame *out, CagError *err) {
  CagVec3 c[ORDER + 1], velocity[ORDER], a[ORDER] = {g->a}, across[ORDER];
  CagStatus status = cag_curve_eval(t->path, v, n + 1, side, c, err);
  if (status) return status;
  double factorial = 1;
  for (int k = 0; k <= n; k++) {
    if (k > 0) factorial *= k;
    out->c[k] = cag_scaled(c[k], 1 / factorial);
    velocity[k] = cag_scaled(c[k + 1], 1 / factorial);
  }
  status = unit_tangent(t, g, v, n, side, velocity, out->t, err);
  if (status) return status;
  series_cross(out->t, a, n, across);
  series_unit(across, n, out->n2);
  series_cross(out->n2, out->t, n, out->n1);
  return CAG_OK;
}

static CagStatus minimizing(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                            CagSide side, Frame *out, CagError *err) {
  Frame e;
  CagStatus status = reference(t, g, v, n, side, &e, err);
  if (status) return status;
  double phi[ORDER] = {0}, s[ORDER], c[ORDER];
  CagVec3 x[ORDER], y[ORDER];
  angle_series(g, v, n, phi);
  series_sincos(phi, n, s, c);
  *out = e;
  series_scale(e.n1, c, n, x);
  series_scale(e.n2, s, n, y);
  for (int k = 0; k <= n; k++) out->n1[k] = cag_add(x[k], y[k]);
  series_scale(e.n2, c, n, x);
  series_scale(e.n1, s, n, y);
  for (int k = 0; k <= n; k++) out->n2[k] = cag_sub(x[k], y[k]);
  return CAG_OK;
}

// Path and unit tangent as series.
static CagStatus tangent_series(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                                CagSide side, Frame *out, CagVec3 *bend, CagError *err) {
  CagVec3 c[ORDER + 2], velocity[ORDER];
  CagStatus status = cag_curve_eval(t->path, v, n + 2, side, c, err);
  if (status) return status;
  double factorial = 1;
  for (int k = 0; k <= n; k++) {
    if (k > 0) factorial *= k;
    out->c[k] = cag_scaled(c[k], 1 / factorial);
    velocity[k] = cag_scaled(c[k + 1], 1 / factorial);
    bend[k] = cag_scaled(c[k + 2], 1 / factorial);
  }
  return unit_tangent(t, g, v, n, side, velocity, out->t, err);
}

// y is the direction `toward` made perpendicular to the tangent, x = y x T.
static void square_to(const CagVec3 *toward, int n, Frame *f) {
  CagVec3 across[ORDER];
  series_cross(toward, f->t, n, across); // along x
  series_unit(across, n, f->n1);
  series_cross(f->t, f->n1, n, f->n2);
}

// The frame is undefined if the sine of the angle between direction and tangent is below this.
#define ALONG_TANGENT CAG_PARALLEL

// Where the curvature vanishes up to rounding, at an inflection or at the end of a natural spline,
// the binormal is the limit from the given side: that of its derivative. Fills `binormal` with a
// multiple of the series of the limit; false: it does not exist.
static bool limit_binormal(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                           CagSide side, CagVec3 *binormal) {
  const double vanishing = CAG_ROUNDING; // relative to its growth over the domain
  CagVec3 bend[ORDER], next[ORDER];
  Frame f;
  CagError ignored;
  if (n + 1 >= ORDER || tangent_series(t, g, v, n + 1, side, &f, bend, &ignored)) return false;
  series_cross(f.t, bend, n + 1, next);
  double length = t->end - t->start, grown = cag_norm(next[1]) * length;
  double bends = cag_norm(bend[0]) + cag_norm(bend[1]) * length;
  if (!(cag_norm(next[0]) <= vanishing * grown && grown > ALONG_TANGENT * bends)) return false;
  for (int k = 0; k <= n; k++)
    binormal[k] = side == CAG_SIDE_LEFT ? cag_scaled(next[k + 1], -1) : next[k + 1];
  return true;
}

static CagStatus frenet(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                        CagSide side, Frame *out, CagError *err) {
  CagVec3 bend[ORDER], binormal[ORDER];
  CagStatus status = tangent_series(t, g, v, n, side, out, bend, err);
  if (status) return status;
  series_cross(out->t, bend, n, binormal);
  if (limit_binormal(t, g, v, n, side, binormal)) bend[0] = cag_vec3(0, 0, 0);
  char text[32];
  if (!(cag_norm(binormal[0]) > ALONG_TANGENT * cag_norm(bend[0])))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_path_straight, "path", -1,
                    "`path` must be curved everywhere for Frenet's frame: it is straight at %s; "
                    "orient: \"rmf\" needs no curvature",
                    cag_number_text(v, text));
  series_unit(binormal, n, out->n2);
  series_cross(out->n2, out->t, n, out->n1);
  return CAG_OK;
}

static CagStatus upright(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                         CagSide side, Frame *out, CagError *err) {
  CagVec3 bend[ORDER], up[ORDER] = {t->how.up};
  CagStatus status = tangent_series(t, g, v, n, side, out, bend, err);
  if (status) return status;
  char text[32];
  if (!(cag_norm(cag_cross(up[0], out->t[0])) > ALONG_TANGENT))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_path_along_up, "path", -1,
                    "`path` must not run along the direction of `orient`: it does at %s; choose "
                    "another direction",
                    cag_number_text(v, text));
  square_to(up, n, out);
  return CAG_OK;
}

static CagStatus standing(const CagMotion *t, double v, int n, CagSide side, Frame *out,
                          CagError *err) {
  CagVec3 c[ORDER];
  CagStatus status = cag_curve_eval(t->path, v, n, side, c, err);
  if (status) return status;
  double factorial = 1;
  memset(out, 0, sizeof *out);
  for (int k = 0; k <= n; k++) {
    if (k > 0) factorial *= k;
    out->c[k] = cag_scaled(c[k], 1 / factorial);
  }
  out->n1[0] = t->fixed[0];
  out->n2[0] = t->fixed[1];
  out->t[0] = t->fixed[2];
  return CAG_OK;
}

static CagStatus frame_on(const CagMotion *t, const CagMotionSegment *g, double v, int n,
                          CagSide side, Frame *out, CagError *err) {
  switch (t->how.orient) {
  case CAG_ORIENT_FRENET: return frenet(t, g, v, n, side, out, err);
  case CAG_ORIENT_UP: return upright(t, g, v, n, side, out, err);
  case CAG_ORIENT_FIXED: return standing(t, v, n, side, out, err);
  case CAG_ORIENT_RMF: break;
  }
  return minimizing(t, g, v, n, side, out, err);
}

const CagMotionSegment *cag_motion_segment(const CagMotion *t, double v, CagSide side) {
  size_t low = 0, high = t->count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    bool above = side == CAG_SIDE_LEFT ? v > t->segments[middle].v0 : v >= t->segments[middle].v0;
    if (above) low = middle;
    else high = middle;
  }
  return &t->segments[low];
}

// Shears the axes along the tangent into the miters of the piece.
static void shear(const CagMotionPiece *p, double v, int n, Frame *f) {
  for (int axis = 0; axis < 2; axis++) {
    double slope = (p->end[axis] - p->start[axis]) / (p->v1 - p->v0);
    double shift[ORDER] = {p->start[axis] + slope * (v - p->v0), slope};
    if (shift[0] == 0 && slope == 0) continue;
    CagVec3 along[ORDER];
    series_scale(f->t, shift, n, along);
    CagVec3 *spoke = axis == 0 ? f->n1 : f->n2;
    for (int k = 0; k <= n; k++) spoke[k] = cag_add(spoke[k], along[k]);
  }
}

static void along_series(const CagMotion *m, const CagAlong *a, double t, CagSide side, int n,
                         double *out) {
  if (a->function) {
    cag_chebyshev_series(a->function, t, side == CAG_SIDE_LEFT, n, out);
    return;
  }
  for (int k = 0; k <= n; k++) out[k] = 0;
  double rate = (a->end - a->start) / (m->end - m->start);
  out[0] = t == m->end ? a->end : a->start + rate * (t - m->start);
  if (n > 0) out[1] = rate;
}

bool cag_along_is_constant(const CagAlong *a, double value) {
  return !a->function && a->start == value && a->end == value;
}

static CagStatus path_at(const CagMotion *m, double v, int n, CagSide side, CagMotionSeries *out,
                         CagError *err) {
  const CagMotionSegment *g = cag_motion_segment(m, v, side);
  Frame f;
  CagStatus status = frame_on(m, g, v, n, side, &f, err);
  if (status) return status;
  shear(&m->pieces[g->piece], v, n, &f);
  size_t size = (size_t)(n + 1) * sizeof(CagVec3);
  memcpy(out->origin, f.c, size);
  memcpy(out->x, f.n1, size);
  memcpy(out->y, f.n2, size);
  memcpy(out->z, f.t, size);
  if (!cag_along_is_constant(&m->how.twist, 0)) {
    double angle[ORDER], s[ORDER], c[ORDER];
    CagVec3 a[ORDER], b[ORDER];
    along_series(m, &m->how.twist, v, side, n, angle);
    series_sincos(angle, n, s, c);
    series_scale(f.n1, c, n, a);
    series_scale(f.n2, s, n, b);
    for (int k = 0; k <= n; k++) out->x[k] = cag_add(a[k], b[k]);
    series_scale(f.n2, c, n, a);
    series_scale(f.n1, s, n, b);
    for (int k = 0; k <= n; k++) out->y[k] = cag_sub(a[k], b[k]);
  }
  if (!cag_along_is_constant(&m->how.scale, 1)) {
    double k[ORDER];
    CagVec3 a[ORDER];
    CagVec3 *spokes[] = {out->x, out->y, out->z};
    along_series(m, &m->how.scale, v, side, n, k);
    for (int i = 0; i < 3; i++) {
      series_scale(spokes[i], k, n, a);
      memcpy(spokes[i], a, size);
    }
  }
  return CAG_OK;
}

static void map_at(const CagMotion *m, double t, int n, CagSide side, CagMotionSeries *out) {
  double x[12 * ORDER];
  cag_chebyshev_series(m->rows, t, side == CAG_SIDE_LEFT, n, x);
  CagVec3 *columns[] = {out->x, out->y, out->z, out->origin};
  for (int j = 0; j < 4; j++)
    for (int k = 0; k <= n; k++)
      columns[j][k] =
          cag_vec3(x[j * (n + 1) + k], x[(4 + j) * (n + 1) + k], x[(8 + j) * (n + 1) + k]);
}

CagStatus cag_motion_at(const CagMotion *m, double t, int n, CagSide side, CagMotionSeries *out,
                        CagError *err) {
  if (m->path) return path_at(m, t, n, side, out, err);
  map_at(m, t, n, side, out);
  return CAG_OK;
}

// --- Construction ---

// phi over the segment from samples of phi', by Legendre series; phi = 0 at its start. *good is
// false if the segment is too long.
static CagStatus integrate_angle(const CagMotion *t, CagMotionSegment *g, bool *good,
                                 CagError *err) {
  double half = (g->v1 - g->v0) / 2, rate[NODES];
  *good = true;
  for (int i = 0; i < NODES; i++) {
    CagVec3 c[3];
    double v = (g->v0 + g->v1) / 2 + half * NODE[i];
    CagStatus status = cag_curve_eval(t->path, v, 2, CAG_SIDE_RIGHT, c, err);
    if (status) return status;
    double speed = cag_norm(c[1]);
    if (!(speed > 0)) return zero_tangent(v, err);
    CagVec3 across = cag_cross(c[1], g->a);
    double length = cag_norm(across);
    *good = *good && length >= LEAST_SINE * speed;
    CagVec3 e1 = cag_scaled(cag_cross(across, c[1]), 1 / (length * speed));
    rate[i] = cag_dot(e1, cag_cross(c[2], g->a)) / length * half;
  }
  if (!*good) return CAG_OK;
  // Legendre polynomials as powers, and the expansion of the rate.
  double p[NODES][NODES] = {{1}, {0, 1}}, series[NODES] = {0};
  for (int k = 1; k + 1 < NODES; k++)
    for (int i = 0; i <= k + 1; i++)
      p[k + 1][i] = ((2 * k + 1) * (i > 0 ? p[k][i - 1] : 0) - k * p[k - 1][i]) / (k + 1);
  for (int k = 0; k < NODES; k++) {
    double coefficient = 0;
    for (int i = 0; i < NODES; i++) {
      double value = 0;
      for (int m = k; m >= 0; m--) value = value * NODE[i] + p[k][m];
      coefficient += (2 * k + 1) / 2.0 * WEIGHT[i] * rate[i] * value;
    }
    if (k >= NODES - 2) *good = *good && fabs(coefficient) <= ANGLE_TOLERANCE;
    for (int m = 0; m <= k; m++) series[m] += coefficient * p[k][m];
  }
  double start = 0;
  for (int m = 0; m < NODES; m++) {
    g->phi[m + 1] = series[m] / (m + 1);
    start += g->phi[m + 1] * (m % 2 == 0 ? -1 : 1);
  }
  g->phi[0] = -start;
  return CAG_OK;
}

static CagStatus add_segment(CagMotion *t, const CagMotionSegment *g, CagError *err) {
  if (!CAG_RESERVE(t->segments, t->room, t->count + 1)) return cag_fail_memory(err);
  t->segments[t->count++] = *g;
  return CAG_OK;
}

// The coordinate axis least aligned with the tangent.
static CagVec3 fixed_vector(CagVec3 tangent) {
  double x = fabs(tangent.x), y = fabs(tangent.y), z = fabs(tangent.z);
  if (z <= x && z <= y) return cag_vec3(0, 0, 1);
  return y <= x ? cag_vec3(0, 1, 0) : cag_vec3(1, 0, 0);
}

static CagStatus divide(CagMotion *t, size_t piece, double v0, double v1, int depth,
                        CagError *err) {
  if (t->how.orient != CAG_ORIENT_RMF) {
    // Other frames need no angle: the segment only stores the piece.
    CagMotionSegment plain = {.v0 = v0, .v1 = v1, .piece = piece};
    return add_segment(t, &plain, err);
  }
  CagVec3 c[2];
  CagStatus status = cag_curve_eval(t->path, (v0 + v1) / 2, 1, CAG_SIDE_RIGHT, c, err);
  if (status) return status;
  CagMotionSegment g = {.v0 = v0, .v1 = v1, .a = fixed_vector(cag_unit(c[1])), .piece = piece};
  bool good;
  status = integrate_angle(t, &g, &good, err);
  if (status) return status;
  if (good || depth >= MAX_DEPTH) return add_segment(t, &g, err);
  status = divide(t, piece, v0, (v0 + v1) / 2, depth + 1, err);
  return status ? status : divide(t, piece, (v0 + v1) / 2, v1, depth + 1, err);
}

// X rotated by the smallest rotation that maps Z to the tangent: the first axis of every motion.
static CagVec3 first_spoke(CagVec3 t) {
  if (t.z < -1 + 1e-12) return cag_vec3(1, 0, 0);
  CagVec3 v = cag_cross(cag_vec3(0, 0, 1), t), x = {1, 0, 0};
  CagVec3 vx = cag_cross(v, x);
  CagVec3 n = cag_add(cag_add(x, vx), cag_scaled(cag_cross(v, vx), 1 / (1 + t.z)));
  return cag_unit(cag_madd(n, -cag_dot(n, t), t));
}

// The unit normal of the bisecting plane of a corner; *corner is false if there is none.
static CagStatus bisector(CagVec3 in, CagVec3 out, double v, bool *corner, CagVec3 *m,
                          CagError *err) {
  *corner = cag_norm(cag_sub(in, out)) > CORNER;
  *m = cag_unit(cag_add(in, out));
  char text[32];
  if (*corner && cag_norm(cag_add(in, out)) <= CORNER)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_path_turns_back, "path", -1,
                    "`path` must not turn back on itself: it does at %s; round that corner",
                    cag_number_text(v, text));
  return CAG_OK;
}

static CagVec3 reflected(CagVec3 p, CagVec3 m) { return cag_madd(p, -2 * cag_dot(p, m), m); }

// Transports the first axis along all segments: sets phi at each start.
static CagStatus transport(CagMotion *t, CagError *err) {
  CagVec3 spoke = {0, 0, 0}, tangent = {0, 0, 0}, home = {0, 0, 0}, home_tangent = {0, 0, 0};
  Frame f;
  for (size_t i = 0; i < t->count; i++) {
    CagMotionSegment *g = &t->segments[i];
    CagStatus status = reference(t, g, g->v0, 0, CAG_SIDE_RIGHT, &f, err);
    if (status) return status;
    if (i == 0) {
      spoke = home = first_spoke(f.t[0]);
      home_tangent = f.t[0];
    } else {
      bool corner;
      CagVec3 m;
      status = bisector(tangent, f.t[0], g->v0, &corner, &m, err);
      if (status) return status;
      if (corner) spoke = reflected(spoke, m);
    }
    g->phi[0] += atan2(cag_dot(spoke, f.n2[0]), cag_dot(spoke, f.n1[0]));
    status = frame_on(t, g, g->v1, 0, CAG_SIDE_LEFT, &f, err);
    if (status) return status;
    spoke = f.n1[0];
    tangent = f.t[0];
  }
  if (!t->path->closed) return CAG_OK;
  bool corner;
  CagVec3 m;
  CagStatus status = bisector(tangent, home_tangent, t->path->end, &corner, &m, err);
  if (status) return status;
  if (corner) spoke = reflected(spoke, m);
  double missing = atan2(cag_dot(cag_cross(spoke, home), home_tangent), cag_dot(spoke, home));
  double length = t->path->end - t->path->start;
  for (size_t i = 0; i < t->count; i++) {
    CagMotionSegment *g = &t->segments[i];
    g->phi[0] += missing * ((g->v0 + g->v1) / 2 - t->path->start) / length;
    g->phi[1] += missing * (g->v1 - g->v0) / 2 / length;
  }
  return CAG_OK;
}

// Shift along the tangent that moves each axis into the plane perpendicular to m.
static void miter(const Frame *f, CagVec3 m, double *out) {
  double along = cag_dot(f->t[0], m);
  out[0] = -cag_dot(f->n1[0], m) / along;
  out[1] = -cag_dot(f->n2[0], m) / along;
}

// Mitered sections of both sides are equal if their axes differ by less than this.
#define CORNER_FRAME CAG_PARALLEL

static CagStatus set_miters(CagMotion *t, CagError *err) {
  size_t joints = t->piece_count - (t->path->closed ? 0 : 1);
  for (size_t i = 0; i < joints; i++) {
    CagMotionPiece *a = &t->pieces[i], *b = &t->pieces[(i + 1) % t->piece_count];
    Frame in, out;
    CagStatus status =
        frame_on(t, cag_motion_segment(t, a->v1, CAG_SIDE_LEFT), a->v1, 0, CAG_SIDE_LEFT, &in, err);
    if (!status)
      status = frame_on(t, cag_motion_segment(t, b->v0, CAG_SIDE_RIGHT), b->v0, 0, CAG_SIDE_RIGHT,
                        &out, err);
    bool corner = false;
    CagVec3 m;
    if (!status) status = bisector(in.t[0], out.t[0], a->v1, &corner, &m, err);
    if (status) return status;
    if (!corner) continue;
    if (cag_norm(cag_sub(reflected(in.n1[0], m), out.n1[0])) > CORNER_FRAME) {
      char text[32];
      return cag_fail(
          err, CAG_E_DEGENERATE, CAG_ERR_path_corner, "path", -1,
          "`path` turns a corner at %s where the frames of both sides do not meet in one section; round the corner, or use orient: \"rmf\"",
          cag_number_text(a->v1, text));
    }
    t->corner = true;
    miter(&in, m, a->end);
    miter(&out, m, b->start);
  }
  return CAG_OK;
}

static CagStatus cut_path(CagMotion *t, CagError *err) {
  const CagCurve *c = t->path;
  size_t inner = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *ends = cag_malloc((inner + 2) * sizeof *ends);
  t->pieces = cag_calloc(inner + 1, sizeof *t->pieces);
  CagStatus status = ends && t->pieces ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    ends[0] = c->start;
    if (inner > 0) c->kind->breaks(c, ends + 1, inner);
    ends[inner + 1] = c->end;
    t->piece_count = inner + 1;
  }
  for (size_t i = 0; !status && i <= inner; i++) {
    t->pieces[i].v0 = ends[i];
    t->pieces[i].v1 = ends[i + 1];
    status = divide(t, i, ends[i], ends[i + 1], 0, err);
  }
  cag_free(ends);
  return status;
}

static CagStatus set_frames(CagMotion *m, CagError *err) {
  CagStatus status = cut_path(m, err);
  if (status) return status;
  if (m->how.orient == CAG_ORIENT_RMF) status = transport(m, err);
  if (!status && m->how.orient == CAG_ORIENT_FIXED) {
    CagVec3 tangent;
    status = cag_curve_tangent(m->path, m->start, CAG_SIDE_RIGHT, &tangent, err);
    if (status) return status;
    m->fixed[0] = first_spoke(tangent);
    m->fixed[1] = cag_cross(tangent, m->fixed[0]);
    m->fixed[2] = tangent;
    return CAG_OK;
  }
  return status ? status : set_miters(m, err);
}

// Number of points on every smooth piece at which frame and scale are tested during construction.
#define PROBES 16

static CagStatus probe(const CagMotion *m, CagError *err) {
  CagMotionSeries f;
  for (size_t i = 0; i < m->piece_count; i++)
    for (int k = 0; k <= PROBES; k++) {
      const CagMotionPiece *p = &m->pieces[i];
      double t = k == PROBES ? p->v1 : p->v0 + (p->v1 - p->v0) * k / PROBES, scale;
      CagSide side = k == PROBES ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
      CagStatus status = cag_motion_at(m, t, 0, side, &f, err);
      if (status) return status;
      along_series(m, &m->how.scale, t, side, 0, &scale);
      bool end = t == m->start || t == m->end;
      char at[32], text[32];
      if (scale < 0 || !isfinite(scale) || (scale == 0 && !end))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_scale_negative, "scale", -1,
                        "`scale` must be positive along the path (0 only at an end, where the body "
                        "comes to a point): at %s it is %s",
                        cag_number_text(t, at), cag_number_text(scale, text));
    }
  return CAG_OK;
}

// The path in space, without the intervals on which it rests in one point.
static CagStatus moving_path(const CagCurve *path, CagCurve **out, CagError *err) {
  CagCurve *space;
  CagStatus status = cag_surface_space_curve(path, &space, err);
  if (status) return status;
  status = cag_curve_without_stops(space, out, err);
  cag_curve_release(space);
  return status;
}

CagStatus cag_motion_along(const CagCurve *path, const CagPathMotion *how, CagMotion **out,
                           CagError *err) {
  CagMotion *m = cag_calloc(1, sizeof *m);
  if (!m) return cag_fail_memory(err);
  m->references = 1;
  m->how = *how;
  m->how.up = cag_unit(how->up);
  cag_chebyshev_retain(how->twist.function);
  cag_chebyshev_retain(how->scale.function);
  CagStatus status = CAG_OK;
  if (how->orient == CAG_ORIENT_UP && !(cag_norm(m->how.up) > 0))
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_axis, "orient", -1,
                      "`orient` must not be the zero vector: give a direction such as Z");
  if (!status && !(isfinite(how->twist.start) && isfinite(how->twist.end)))
    status =
        cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "twist", -1, "`twist` must be finite");
  if (!status) status = moving_path(path, &m->path, err);
  CagBounds box = CAG_BOUNDS_EMPTY;
  if (!status) status = cag_curve_bounds(m->path, &box, err);
  if (!status && cag_norm(cag_sub(box.max, box.min)) == 0)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_zero_tangent, "path", -1,
                      "`path` must not be a single point");
  if (!status) {
    m->start = m->path->start;
    m->end = m->path->end;
    m->angular = m->path->angular;
    status = set_frames(m, err);
  }
  if (!status) status = probe(m, err);
  if (status) cag_motion_release(m);
  else *out = m;
  return status;
}

CagStatus cag_motion_affine(const CagChebyshev *rows, double a, double b, bool angular,
                            CagMotion **out, CagError *err) {
  CagMotion *m = cag_calloc(1, sizeof *m);
  if (!m) return cag_fail_memory(err);
  m->references = 1;
  m->rows = cag_chebyshev_retain(rows);
  m->start = a;
  m->end = b;
  m->angular = angular;
  *out = m;
  return CAG_OK;
}

CagMotion *cag_motion_retain(const CagMotion *m) {
  CagMotion *mine = (CagMotion *)m;
  if (mine) mine->references++;
  return mine;
}

void cag_motion_release(CagMotion *m) {
  if (!m || --m->references > 0) return;
  cag_curve_release(m->path);
  cag_chebyshev_release((CagChebyshev *)m->how.twist.function);
  cag_chebyshev_release((CagChebyshev *)m->how.scale.function);
  cag_chebyshev_release(m->rows);
  cag_free(m->segments);
  cag_free(m->pieces);
  cag_free(m);
}

// --- Queries ---

void cag_motion_domain(const CagMotion *m, double *start, double *end, bool *angular) {
  *start = m->start;
  *end = m->end;
  *angular = m->angular;
}

const CagCurve *cag_motion_path(const CagMotion *m) { return m->path; }
const CagPathMotion *cag_motion_how(const CagMotion *m) { return &m->how; }
bool cag_motion_has_corner(const CagMotion *m) { return m->corner; }

bool cag_motion_is_plain(const CagMotion *m) {
  return m->path && cag_along_is_constant(&m->how.twist, 0) &&
         cag_along_is_constant(&m->how.scale, 1);
}

size_t cag_motion_breaks(const CagMotion *m, double *out, size_t capacity) {
  const CagChebyshev *functions[] = {m->how.twist.function, m->how.scale.function, m->rows};
  size_t n = m->path && m->path->kind->breaks ? m->path->kind->breaks(m->path, NULL, 0) : 0;
  size_t most = n;
  for (int i = 0; i < 3; i++)
    if (functions[i]) most += cag_chebyshev_breaks(functions[i], NULL, 0);
  if (most == 0) return 0;
  double *all = cag_malloc(most * sizeof *all);
  if (!all) return cag_note_memory(), 0;
  if (n > 0) m->path->kind->breaks(m->path, all, n);
  for (int i = 0; i < 3; i++)
    if (functions[i]) n += cag_chebyshev_breaks(functions[i], all + n, most - n);
  n = cag_surface_tidy_breaks(all, n, m->start, m->end);
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = all[i];
  cag_free(all);
  return n;
}

CagStatus cag_motion_frame(const CagMotion *m, double t, CagTransform *out, CagError *err) {
  CagMotionSeries f;
  CagStatus status = cag_motion_at(m, t, 0, t >= m->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &f, err);
  if (status) return status;
  *out = cag_transform_identity();
  out->planar = false;
  CagVec3 columns[] = {f.x[0], f.y[0], f.z[0], f.origin[0]};
  for (int j = 0; j < 4; j++) {
    out->m[0][j] = columns[j].x;
    out->m[1][j] = columns[j].y;
    out->m[2][j] = columns[j].z;
  }
  return CAG_OK;
}

static void along_digest(const CagAlong *a, CagDigest *d) {
  cag_digest_number(d, a->start);
  cag_digest_number(d, a->end);
  if (a->function) cag_chebyshev_digest(a->function, d);
}

void cag_motion_digest(const CagMotion *m, CagDigest *d) {
  cag_digest_numbers(d, (const double[]){m->start, m->end}, 2);
  if (m->rows) cag_chebyshev_digest(m->rows, d);
  if (!m->path) return;
  cag_curve_digest(m->path, d);
  cag_digest_word(d, (uint64_t)m->how.orient);
  cag_vec3s_digest(&m->how.up, 1, d);
  along_digest(&m->how.twist, d);
  along_digest(&m->how.scale, d);
}
