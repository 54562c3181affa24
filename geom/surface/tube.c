// Tubes: a circle carried along a path in frames that do not turn about the tangent.
//
// S(u, v) = C(v) + r (cos u n1(v) + sin u n2(v)), n2 = T x n1, where n1 is rotation minimising: it
// moves only along the tangent. That is the frame to which the double reflection of Wang et al.
// (2008) converges. Here it is kept as an angle phi(v) against an analytic frame: on each segment
// of the path a fixed vector a gives e2 = unit(C' x a), e1 = e2 x T, and n1 = cos phi e1 + sin phi
// e2 with phi' = e1 . (C'' x a) / |C' x a|. phi' is integrated as a polynomial per segment, so all
// partials of S are exact derivatives of what is evaluated, and segments meet to rounding with all
// derivatives that the path has.
//
// A closed path brings the frame home turned by some angle; it is given back evenly over v. At a
// corner of the path the tubes of both sides are mitred: each circle is shifted along the tangent
// by a multiple that grows linearly over the smooth piece to what puts it into the bisecting plane,
// so that straight pieces are exact cylinders cut by that plane.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "geom/surface/family.h"

// Gauss-Legendre nodes that sample phi' on a segment, and so the degree of phi.
#define NODES 8
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

// A segment is short enough when the last terms of phi are below this, in radians.
#define ANGLE_TOLERANCE 1e-13
#define MAX_DEPTH 20
// The tangent may lean this far towards the fixed vector; the sine of the angle between them.
#define LEAST_SINE 0.5
// A path turns a corner where its unit tangents differ by more than this.
#define CORNER 1e-9

typedef struct Segment {
  double v0, v1;
  CagVec3 a;
  double phi[NODES + 1]; // coefficients of powers of s, -1..1 over the segment
  size_t piece;
} Segment;

// A smooth piece of the path with its mitres: the shift of the circle along the tangent at either
// end, as factors of cos u and sin u.
typedef struct Piece {
  double v0, v1;
  double start[2], end[2];
} Piece;

typedef struct Tube {
  CagSurface base;
  CagCurve *path;
  double radius;
  Segment *segments;
  size_t count, room;
  Piece *pieces;
  size_t piece_count;
} Tube;

static const CagSurfaceKind tube_kind;

// --- Truncated power series in v ---

#define ORDER (CAG_MAX_PARTIAL + 1)

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

static void angle_series(const Segment *g, double v, int n, double *out) {
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
  return cag_fail(err, CAG_E_DEGENERATE, "zero-tangent", "path", -1,
                  "`path` must have a tangent everywhere: it vanishes at %s",
                  cag_number_text(v, text));
}

// Unit tangent and reference frame at v on segment g, as series of order n; C alongside.
static CagStatus reference(const Tube *t, const Segment *g, double v, int n, CagSide side,
                           Frame *out, CagError *err) {
  CagVec3 c[ORDER + 1], velocity[ORDER], a[ORDER] = {g->a}, across[ORDER];
  CagStatus status = cag_curve_eval(t->path, v, n + 1, side, c, err);
  if (status) return status;
  double factorial = 1;
  for (int k = 0; k <= n; k++) {
    if (k > 0) factorial *= k;
    out->c[k] = cag_scaled(c[k], 1 / factorial);
    velocity[k] = cag_scaled(c[k + 1], 1 / factorial);
  }
  if (!(cag_norm(velocity[0]) > 0)) return zero_tangent(v, err);
  series_unit(velocity, n, out->t);
  series_cross(out->t, a, n, across);
  series_unit(across, n, out->n2);
  series_cross(out->n2, out->t, n, out->n1);
  return CAG_OK;
}

static CagStatus frame_on(const Tube *t, const Segment *g, double v, int n, CagSide side,
                          Frame *out, CagError *err) {
  Frame e;
  CagStatus status = reference(t, g, v, n, side, &e, err);
  if (status) return status;
  double phi[ORDER], s[ORDER], c[ORDER];
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

static const Segment *segment_at(const Tube *t, double v, CagSide side) {
  size_t low = 0, high = t->count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    bool above = side == CAG_SIDE_LEFT ? v > t->segments[middle].v0 : v >= t->segments[middle].v0;
    if (above) low = middle;
    else high = middle;
  }
  return &t->segments[low];
}

// The two series that cos u and sin u multiply: n1 and n2 with the mitre's shift along the tangent.
static CagStatus spokes(const Tube *t, double v, int n, CagSide side, Frame *f, CagError *err) {
  const Segment *g = segment_at(t, v, side);
  const Piece *p = &t->pieces[g->piece];
  CagStatus status = frame_on(t, g, v, n, side, f, err);
  if (status) return status;
  for (int axis = 0; axis < 2; axis++) {
    double slope = (p->end[axis] - p->start[axis]) / (p->v1 - p->v0);
    double shift[ORDER] = {p->start[axis] + slope * (v - p->v0), slope};
    if (shift[0] == 0 && slope == 0) continue;
    CagVec3 along[ORDER];
    series_scale(f->t, shift, n, along);
    CagVec3 *spoke = axis == 0 ? f->n1 : f->n2;
    for (int k = 0; k <= n; k++) spoke[k] = cag_add(spoke[k], along[k]);
  }
  return CAG_OK;
}

static CagStatus tube_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                           CagVec3 *out, CagError *err) {
  (void)su;
  const Tube *t = (const Tube *)s;
  Frame f;
  CagStatus status = spokes(t, v, n, sv, &f, err);
  if (status) return status;
  double sine, cosine;
  cag_sincos(u, &sine, &cosine);
  double c = cosine * t->radius, d = sine * t->radius;
  for (int i = 0; i <= n; i++) {
    double factorial = 1;
    for (int j = 0; i + j <= n; j++) {
      if (j > 0) factorial *= j;
      CagVec3 p = cag_madd(cag_scaled(f.n1[j], c), d, f.n2[j]);
      if (i == 0) p = cag_add(p, f.c[j]);
      out[cag_partial(n, i, j)] = cag_scaled(p, factorial);
    }
    double next = -d;
    d = c;
    c = next;
  }
  return CAG_OK;
}

static CagStatus tube_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                           size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  const Tube *t = (const Tube *)s;
  double *turn = malloc((2 * nu + 1) * sizeof *turn);
  if (!turn) return cag_fail_memory(err);
  for (size_t i = 0; i < nu; i++) cag_sincos(us[i], &turn[2 * i], &turn[2 * i + 1]);
  CagStatus status = CAG_OK;
  for (size_t j = 0; !status && j < nv; j++) {
    Frame f;
    status = spokes(t, vs[j], 1, vs[j] >= s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &f, err);
    for (size_t i = 0; !status && i < nu; i++) {
      double d = turn[2 * i] * t->radius, c = turn[2 * i + 1] * t->radius;
      size_t at = i * nv + j;
      points[at] = cag_madd(cag_madd(f.c[0], c, f.n1[0]), d, f.n2[0]);
      if (du) du[at] = cag_madd(cag_scaled(f.n2[0], c), -d, f.n1[0]);
      if (dv) dv[at] = cag_madd(cag_madd(f.c[1], c, f.n1[1]), d, f.n2[1]);
    }
  }
  free(turn);
  return status;
}

// --- Construction ---

// phi over the segment from samples of phi', by Legendre series; phi = 0 at its start. False: the
// segment is too long.
static CagStatus integrate_angle(const Tube *t, Segment *g, bool *good, CagError *err) {
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

static CagStatus add_segment(Tube *t, const Segment *g, CagError *err) {
  if (t->count == t->room) {
    size_t room = t->room ? 2 * t->room : 16;
    Segment *grown = realloc(t->segments, room * sizeof *grown);
    if (!grown) return cag_fail_memory(err);
    t->segments = grown;
    t->room = room;
  }
  t->segments[t->count++] = *g;
  return CAG_OK;
}

// The unit axis that leans least towards the tangent.
static CagVec3 fixed_vector(CagVec3 tangent) {
  double x = fabs(tangent.x), y = fabs(tangent.y), z = fabs(tangent.z);
  if (z <= x && z <= y) return cag_vec3(0, 0, 1);
  return y <= x ? cag_vec3(0, 1, 0) : cag_vec3(1, 0, 0);
}

static CagStatus divide(Tube *t, size_t piece, double v0, double v1, int depth, CagError *err) {
  CagVec3 c[2];
  CagStatus status = cag_curve_eval(t->path, (v0 + v1) / 2, 1, CAG_SIDE_RIGHT, c, err);
  if (status) return status;
  Segment g = {.v0 = v0, .v1 = v1, .a = fixed_vector(cag_unit(c[1])), .piece = piece};
  bool good;
  status = integrate_angle(t, &g, &good, err);
  if (status) return status;
  if (good || depth >= MAX_DEPTH) return add_segment(t, &g, err);
  status = divide(t, piece, v0, (v0 + v1) / 2, depth + 1, err);
  return status ? status : divide(t, piece, (v0 + v1) / 2, v1, depth + 1, err);
}

// X turned by the smallest rotation that takes Z to the tangent: the first spoke of every tube.
static CagVec3 first_spoke(CagVec3 t) {
  if (t.z < -1 + 1e-12) return cag_vec3(1, 0, 0);
  CagVec3 v = cag_cross(cag_vec3(0, 0, 1), t), x = {1, 0, 0};
  CagVec3 vx = cag_cross(v, x);
  CagVec3 n = cag_add(cag_add(x, vx), cag_scaled(cag_cross(v, vx), 1 / (1 + t.z)));
  return cag_unit(cag_madd(n, -cag_dot(n, t), t));
}

// The unit normal of the plane that halves a corner; false: there is no corner.
static CagStatus bisector(CagVec3 in, CagVec3 out, double v, bool *corner, CagVec3 *m,
                          CagError *err) {
  *corner = cag_norm(cag_sub(in, out)) > CORNER;
  *m = cag_unit(cag_add(in, out));
  char text[32];
  if (*corner && cag_norm(cag_add(in, out)) <= CORNER)
    return cag_fail(err, CAG_E_DEGENERATE, "path-turns-back", "path", -1,
                    "`path` must not turn back on itself: it does at %s; round that corner",
                    cag_number_text(v, text));
  return CAG_OK;
}

static CagVec3 reflected(CagVec3 p, CagVec3 m) { return cag_madd(p, -2 * cag_dot(p, m), m); }

// Carries the first spoke along all segments: sets phi at each start.
static CagStatus transport(Tube *t, CagError *err) {
  CagVec3 spoke = {0, 0, 0}, tangent = {0, 0, 0}, home = {0, 0, 0}, home_tangent = {0, 0, 0};
  Frame f;
  for (size_t i = 0; i < t->count; i++) {
    Segment *g = &t->segments[i];
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
    Segment *g = &t->segments[i];
    g->phi[0] += missing * ((g->v0 + g->v1) / 2 - t->path->start) / length;
    g->phi[1] += missing * (g->v1 - g->v0) / 2 / length;
  }
  return CAG_OK;
}

// Shift along the tangent that takes each spoke into the plane square to m.
static void mitre(const Frame *f, CagVec3 m, double *out) {
  double along = cag_dot(f->t[0], m);
  out[0] = -cag_dot(f->n1[0], m) / along;
  out[1] = -cag_dot(f->n2[0], m) / along;
}

static CagStatus set_mitres(Tube *t, CagError *err) {
  size_t joints = t->piece_count - (t->path->closed ? 0 : 1);
  for (size_t i = 0; i < joints; i++) {
    Piece *a = &t->pieces[i], *b = &t->pieces[(i + 1) % t->piece_count];
    Frame in, out;
    CagStatus status =
        frame_on(t, segment_at(t, a->v1, CAG_SIDE_LEFT), a->v1, 0, CAG_SIDE_LEFT, &in, err);
    if (!status)
      status =
          frame_on(t, segment_at(t, b->v0, CAG_SIDE_RIGHT), b->v0, 0, CAG_SIDE_RIGHT, &out, err);
    bool corner = false;
    CagVec3 m;
    if (!status) status = bisector(in.t[0], out.t[0], a->v1, &corner, &m, err);
    if (status) return status;
    if (!corner) continue;
    mitre(&in, m, a->end);
    mitre(&out, m, b->start);
  }
  return CAG_OK;
}

static CagStatus cut_path(Tube *t, CagError *err) {
  const CagCurve *c = t->path;
  size_t inner = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *ends = malloc((inner + 2) * sizeof *ends);
  t->pieces = calloc(inner + 1, sizeof *t->pieces);
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
  free(ends);
  return status;
}

static size_t tube_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Tube *t = (const Tube *)s;
  if (direction == 0 || !t->path->kind->breaks) return 0;
  return t->path->kind->breaks(t->path, out, capacity);
}

static void tube_describe(const CagSurface *s, char *buffer, size_t size) {
  const Tube *t = (const Tube *)s;
  char text[32];
  snprintf(buffer, size, "along a %s, radius %s", t->path->kind->name,
           cag_number_text(t->radius, text));
}

static void tube_destroy(CagSurface *s) {
  Tube *t = (Tube *)s;
  cag_curve_release(t->path);
  free(t->segments);
  free(t->pieces);
}

static const CagSurfaceKind tube_kind = {
    .name = "tube",
    .eval = tube_eval,
    .eval_grid = tube_grid,
    .breaks = tube_breaks,
    .describe = tube_describe,
    .destroy = tube_destroy,
};

CagStatus cag_surface_tube(const CagCurve *path, double radius, CagSurface **out, CagError *err) {
  char text[32];
  if (!(radius > 0) || !isfinite(radius))
    return cag_fail(err, CAG_E_ARGUMENT, "size-not-positive", "radius", -1,
                    "`radius` must be positive, it is %s", cag_number_text(radius, text));
  CagCurve *space;
  CagStatus status = cag_surface_space_curve(path, &space, err);
  if (status) return status;
  CagSurface *s;
  status =
      cag_surface_block(sizeof(Tube), &tube_kind, 0, 2 * M_PI, space->start, space->end, &s, err);
  if (status) {
    cag_curve_release(space);
    return status;
  }
  Tube *t = (Tube *)s;
  t->path = space;
  t->radius = radius;
  status = cut_path(t, err);
  if (!status) status = transport(t, err);
  if (!status) status = set_mitres(t, err);
  if (status) {
    cag_surface_release(s);
    return status;
  }
  s->angular_u = true;
  s->angular_v = space->angular;
  s->closed_u = true;
  s->closed_v = space->closed;
  *out = s;
  return CAG_OK;
}
