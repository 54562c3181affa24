// Fillets: the arc that leads from one curve to another, and curves with rounded corners.
//
// At the corner the path turns left or right. On that side each curve has a parallel at the
// distance of the radius; the intersection of the parallels nearest to the corner is the center.
// For two lines it has a closed form. Otherwise Newton's method starts from the solution for the
// tangent lines at the corner, and if it leaves the curves, the parallels are intersected as
// polylines first.

#include "base/memory.h"
#include "geom/curve/circles.h"
#include "geom/curve/family.h"
#include "geom/curve/intersect.h"
#include "geom/linalg/tolerance.h"

// Fractions of the size of the data: tolerance for ends that meet; convergence of a center.
#define MEETS CAG_COINCIDENT
#define FOUND CAG_ROUNDING
// Turns below this are not corners (radians).
#define SMOOTH CAG_PARALLEL
#define NEWTON_STEPS 60
#define SAMPLES 256

static CagVec3 left_of(CagVec3 d) { return cag_vec3(-d.y, d.x, 0); }
static double cross2(CagVec3 a, CagVec3 b) { return a.x * b.y - a.y * b.x; }

static CagStatus too_large(double radius, long index, CagError *err) {
  char text[32];
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_too_large, "radius", index,
                  "an arc of radius %s does not fit into the corner: the curves end before it "
                  "touches them",
                  cag_number_text(radius, text));
}

static CagStatus check_radius(double radius, CagError *err) {
  char text[32];
  if (radius > 0 && isfinite(radius)) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_not_positive, "radius", -1,
                  "`radius` must be positive, found %s", cag_number_text(radius, text));
}

// A parallel of a curve: its point, its derivative, and the foot point on the curve.
typedef struct Parallel {
  CagVec3 foot, tangent, point, derivative;
} Parallel;

static CagStatus parallel_at(const CagCurve *c, double t, CagSide side, double distance,
                             Parallel *out, CagError *err) {
  CagVec3 d[3];
  CagStatus status = cag_curve_eval(c, t, 2, side, d, err);
  if (status) return status;
  const double speed = cag_norm(d[1]);
  const double bend = speed > 0 ? cross2(d[1], d[2]) / (speed * speed * speed) : 0;
  out->foot = d[0];
  out->tangent = cag_unit(d[1]);
  out->point = cag_madd(d[0], distance, left_of(out->tangent));
  out->derivative = cag_scaled(d[1], 1 - distance * bend);
  return CAG_OK;
}

typedef struct Corner {
  const CagCurve *a, *b;
  double ta, tb; // parameters of the corner
  double side;   // 1: the path turns left
  double turn;
  double size;
} Corner;

static bool inside(const Corner *k, double s, double u) {
  return s >= k->a->start && s <= k->ta && u >= k->tb && u <= k->b->end;
}

// *found is true if (s, u) converged to a center; they stay on the parts before and after the
// corner.
static CagStatus newton(const Corner *k, double radius, double *s, double *u, bool *found,
                        CagError *err) {
  Parallel p, q;
  *found = false;
  for (int i = 0; i < NEWTON_STEPS; i++) {
    CagStatus status = parallel_at(k->a, *s, CAG_SIDE_LEFT, k->side * radius, &p, err);
    if (!status) status = parallel_at(k->b, *u, CAG_SIDE_RIGHT, k->side * radius, &q, err);
    if (status) return status;
    const CagVec3 d = cag_sub(q.point, p.point);
    if (cag_norm(d) <= FOUND * (k->size + radius)) {
      *found = true;
      return CAG_OK;
    }
    const double det = cross2(p.derivative, q.derivative);
    if (det == 0) return CAG_OK;
    const double s1 = *s + cross2(d, q.derivative) / det, u1 = *u + cross2(d, p.derivative) / det;
    *s = fmin(k->ta, fmax(k->a->start, s1));
    *u = fmin(k->b->end, fmax(k->tb, u1));
    // Clamped to an end twice: there is no solution inside.
    if (i > NEWTON_STEPS / 2 && !inside(k, s1, u1)) return CAG_OK;
  }
  return CAG_OK;
}

// The intersection of the chords p0-p1 and q0-q1, as fractions of them.
static bool chords_cross(CagVec3 p0, CagVec3 p1, CagVec3 q0, CagVec3 q1, double *s, double *u) {
  const CagVec3 a = cag_sub(p1, p0), b = cag_sub(q1, q0), d = cag_sub(q0, p0);
  const double det = cross2(a, b);
  if (det == 0) return false;
  *s = cross2(d, b) / det;
  *u = cross2(d, a) / det;
  return *s >= 0 && *s <= 1 && *u >= 0 && *u <= 1;
}

// The intersection of the parallels nearest to the corner along both curves, refined.
static CagStatus search(const Corner *k, double radius, double *s, double *u, bool *found,
                        CagError *err) {
  CagVec3 *points = cag_malloc(sizeof *points * 2 * (SAMPLES + 1));
  if (!points) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  const double step_a = (k->ta - k->a->start) / SAMPLES, step_b = (k->b->end - k->tb) / SAMPLES;
  CagVec3 *p = points, *q = points + SAMPLES + 1;
  Parallel x;
  // Both lists start at the corner.
  for (int i = 0; !status && i <= SAMPLES; i++) {
    status = parallel_at(k->a, fmax(k->a->start, k->ta - step_a * i), CAG_SIDE_LEFT,
                         k->side * radius, &x, err);
    if (!status) {
      p[i] = x.point;
      status = parallel_at(k->b, fmin(k->b->end, k->tb + step_b * i), CAG_SIDE_RIGHT,
                           k->side * radius, &x, err);
      q[i] = x.point;
    }
  }
  *found = false;
  for (int sum = 0; !status && !*found && sum <= 2 * (SAMPLES - 1); sum++)
    for (int i = sum < SAMPLES ? 0 : sum - SAMPLES + 1; !status && i <= sum && i < SAMPLES; i++) {
      double share, share2;
      const int j = sum - i;
      if (*found || !chords_cross(p[i], p[i + 1], q[j], q[j + 1], &share, &share2)) continue;
      *s = k->ta - step_a * (i + share);
      *u = k->tb + step_b * (j + share2);
      status = newton(k, radius, s, u, found, err);
    }
  cag_free(points);
  return status;
}

static CagStatus find_corner(const CagCurve *a, const CagCurve *b, Corner *out, CagError *err) {
  CagVec3 p, q, ta, tb;
  const CagBounds box = a->kind->hull(a, a->start, a->end),
                  other = b->kind->hull(b, b->start, b->end);
  *out = (Corner){a, b, a->end, b->start, 1, 0, 0};
  out->size = cag_norm(cag_sub(box.max, box.min)) + cag_norm(cag_sub(other.max, other.min));
  CagStatus status = cag_curve_point(a, a->end, &p, err);
  if (!status) status = cag_curve_point(b, b->start, &q, err);
  if (!status && cag_norm(cag_sub(p, q)) > MEETS * (out->size + cag_norm(p))) {
    CagMeeting *meetings = NULL;
    size_t n = 0;
    status = cag_curve_intersect(a, b, &meetings, &n, err);
    if (!status && n == 0)
      status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_curves_do_not_meet, "", -1,
                        "the two curves do not intersect: there is no corner to round");
    if (!status) {
      out->ta = meetings[n - 1].t;
      out->tb = meetings[n - 1].t2;
    }
    cag_free(meetings);
  }
  if (!status) status = cag_curve_tangent(a, out->ta, CAG_SIDE_LEFT, &ta, err);
  if (!status) status = cag_curve_tangent(b, out->tb, CAG_SIDE_RIGHT, &tb, err);
  if (status) return status;
  out->turn = atan2(fabs(cross2(ta, tb)), cag_dot(ta, tb));
  out->side = cross2(ta, tb) >= 0 ? 1 : -1;
  if (out->turn <= SMOOTH || out->turn >= M_PI - SMOOTH)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_corner, "", -1,
                    "the two curves are tangent where they meet: there is no corner to round");
  return CAG_OK;
}

// The arc about center from p on, counter-clockwise about the normal.
static CagStatus arc_from(CagVec3 center, CagVec3 p, CagVec3 normal, double sweep, int dimension,
                          CagCurve **out, CagError *err) {
  CagTransform frame;
  const CagVec3 x = cag_sub(p, center);
  const double radius = cag_norm(x);
  CagStatus status = cag_axes(center, x, cag_cross(normal, x), &frame, err);
  frame.planar = dimension == 2;
  return status ? status : cag_curve_arc(radius, radius, 0, sweep, &frame, out, err);
}

CagStatus cag_fillet(const CagCurve *a, const CagCurve *b, double radius, CagCurve **out, double *t,
                     double *t2, CagError *err) {
  Corner k;
  Parallel p, q, at_a, at_b;
  bool found;
  CagStatus status = check_radius(radius, err);
  if (!status && (a->dimension != 2 || b->dimension != 2))
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_planar, "", -1,
                      "expects curves of the plane, with points [x, y]");
  if (!status) status = find_corner(a, b, &k, err);
  if (!status) status = parallel_at(a, k.ta, CAG_SIDE_LEFT, 0, &at_a, err);
  if (!status) status = parallel_at(b, k.tb, CAG_SIDE_RIGHT, 0, &at_b, err);
  if (status) return status;
  // Distance of the points of contact for the tangent lines.
  const double back = radius * tan(k.turn / 2);
  double s = k.ta, u = k.tb;
  if (cag_norm(at_a.derivative) > 0) s -= back / cag_norm(at_a.derivative);
  if (cag_norm(at_b.derivative) > 0) u += back / cag_norm(at_b.derivative);
  s = fmax(a->start, s);
  u = fmin(b->end, u);
  status = newton(&k, radius, &s, &u, &found, err);
  if (!status && !found) status = search(&k, radius, &s, &u, &found, err);
  if (!status && !found) status = too_large(radius, -1, err);
  if (!status) status = parallel_at(a, s, CAG_SIDE_LEFT, k.side * radius, &p, err);
  if (!status) status = parallel_at(b, u, CAG_SIDE_RIGHT, k.side * radius, &q, err);
  if (status) return status;
  double sweep = k.side * atan2(cross2(p.tangent, q.tangent), cag_dot(p.tangent, q.tangent));
  if (sweep <= 0) sweep += 2 * M_PI;
  *t = s;
  *t2 = u;
  return arc_from(p.point, p.foot, cag_vec3(0, 0, k.side), sweep, 2, out, err);
}

// --- Rounded corners ---

typedef struct Pieces {
  CagCurve **items;
  size_t n;
} Pieces;

static void release(Pieces *p) {
  while (p->n > 0) cag_curve_release(p->items[--p->n]);
  cag_free(p->items);
}

static CagStatus add_line(Pieces *pieces, CagVec3 p, CagVec3 q, double size, int dimension,
                          CagError *err) {
  if (cag_norm(cag_sub(q, p)) <= MEETS * size) return CAG_OK;
  CagStatus status = cag_curve_line(p, q, dimension, &pieces->items[pieces->n], err);
  if (!status) pieces->n++;
  return status;
}

// The two end points of the arc of a corner; both are the vertex if the path is straight there.
typedef struct Cut {
  CagVec3 in, out, center, normal;
  double turn, back;
} Cut;

static CagStatus cut_corner(CagVec3 before, CagVec3 at, CagVec3 after, double radius, long index,
                            Cut *cut, CagError *err) {
  const CagVec3 a = cag_unit(cag_sub(at, before)), b = cag_unit(cag_sub(after, at));
  const CagVec3 n = cag_cross(a, b);
  *cut = (Cut){.in = at, .out = at, .normal = cag_unit(n)};
  cut->turn = atan2(cag_norm(n), cag_dot(a, b));
  if (cut->turn <= SMOOTH) {
    cut->turn = 0;
    return CAG_OK;
  }
  if (cut->turn >= M_PI - SMOOTH) return too_large(radius, index, err);
  cut->back = radius * tan(cut->turn / 2);
  cut->in = cag_madd(at, -cut->back, a);
  cut->out = cag_madd(at, cut->back, b);
  cut->center = cag_madd(cut->in, radius, cag_cross(cut->normal, a));
  return CAG_OK;
}

static CagStatus check_edges(const CagVec3 *p, const Cut *cuts, size_t n, bool closed,
                             double radius, CagError *err) {
  for (size_t i = 0; i + (closed ? 0 : 1) < n; i++) {
    const size_t j = (i + 1) % n;
    const double length = cag_norm(cag_sub(p[j], p[i]));
    if (cuts[i].back + cuts[j].back > length * (1 + MEETS)) {
      char text[32], edge[32];
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_too_large, "radius", (long)i,
                      "corners of radius %s do not fit on the edge from point %zu to point %zu, "
                      "whose length is %s",
                      cag_number_text(radius, text), i, j, cag_number_text(length, edge));
    }
  }
  return CAG_OK;
}

static CagStatus round_polyline(const CagCurve *c, const CagVec3 *p, size_t n, bool closed,
                                double radius, CagCurve **out, CagError *err) {
  Pieces pieces = {cag_malloc(sizeof *pieces.items * (2 * n + 2)), 0};
  Cut *cuts = cag_calloc(n, sizeof *cuts);
  CagStatus status = pieces.items && cuts ? CAG_OK : cag_fail_memory(err);
  const double size = cag_curve_size(p, n);
  for (size_t i = 0; !status && i < n; i++) {
    cuts[i] = (Cut){.in = p[i], .out = p[i]};
    if (closed || (i > 0 && i + 1 < n))
      status = cut_corner(p[(i + n - 1) % n], p[i], p[(i + 1) % n], radius, (long)i, &cuts[i], err);
  }
  if (!status) status = check_edges(p, cuts, n, closed, radius, err);
  for (size_t i = 0; !status && i < n; i++) {
    // The arc of this corner, then the line to the next.
    if (cuts[i].turn > 0) {
      status = arc_from(cuts[i].center, cuts[i].in, cuts[i].normal, cuts[i].turn, c->dimension,
                        &pieces.items[pieces.n], err);
      if (!status) pieces.n++;
    }
    if (!status && (closed || i + 1 < n))
      status = add_line(&pieces, cuts[i].out, cuts[(i + 1) % n].in, size, c->dimension, err);
  }
  if (!status) status = cag_curve_join(pieces.items, pieces.n, out, err);
  cag_free(cuts);
  release(&pieces);
  return status;
}

static bool is_corner(CagVec3 before, CagVec3 after) {
  return cag_norm(cag_sub(after, before)) > SMOOTH;
}

// The smooth parts of a curve: cuts where the tangent turns, and both ends.
static CagStatus find_corners(const CagCurve *c, double *cuts, size_t *n, CagError *err) {
  size_t kept = 1;
  for (size_t i = 1; i + 1 < *n; i++) {
    CagVec3 before, after;
    CagStatus status = cag_curve_tangent(c, cuts[i], CAG_SIDE_LEFT, &before, err);
    if (!status) status = cag_curve_tangent(c, cuts[i], CAG_SIDE_RIGHT, &after, err);
    if (status) return status;
    if (is_corner(before, after)) cuts[kept++] = cuts[i];
  }
  cuts[kept++] = cuts[*n - 1];
  *n = kept;
  return CAG_OK;
}

static bool seam_is_corner(const CagCurve *c) {
  CagVec3 before, after;
  CagError ignored;
  if (!c->closed || cag_curve_tangent(c, c->end, CAG_SIDE_LEFT, &before, &ignored) ||
      cag_curve_tangent(c, c->start, CAG_SIDE_RIGHT, &after, &ignored))
    return false;
  return is_corner(before, after);
}

static CagStatus add_trimmed(Pieces *pieces, const CagCurve *c, double a, double b, double radius,
                             size_t index, CagError *err) {
  const double slack = MEETS * (c->end - c->start);
  if (b - a < -slack) return too_large(radius, (long)index, err);
  if (b - a <= slack) return CAG_OK;
  CagStatus status = cag_curve_trim(c, a, b, &pieces->items[pieces->n], err);
  if (!status) pieces->n++;
  return status;
}

// Fillets between neighboring `parts`; for a closed curve with a corner at its seam also between
// the last and the first.
static CagStatus round_parts(CagCurve *const *parts, size_t n, bool around, double radius,
                             CagCurve **arcs, Pieces *pieces, CagError *err) {
  double *from = cag_malloc(sizeof *from * n), *to = cag_malloc(sizeof *to * n);
  CagStatus status = from && to ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    from[i] = parts[i]->start;
    to[i] = parts[i]->end;
  }
  for (size_t i = 0; !status && i < (around ? n : n - 1); i++) {
    const size_t j = (i + 1) % n;
    status = cag_fillet(parts[i], parts[j], radius, &arcs[i], &to[i], &from[j], err);
    if (status) err->index = (long)i;
  }
  for (size_t i = 0; !status && i < n; i++) {
    status = add_trimmed(pieces, parts[i], from[i], to[i], radius, i, err);
    if (!status && arcs[i]) pieces->items[pieces->n++] = cag_curve_retain(arcs[i]);
  }
  cag_free(from);
  cag_free(to);
  return status;
}

static CagStatus round_curve(const CagCurve *c, double radius, CagCurve **out, CagError *err) {
  double *cuts;
  size_t n;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  status = find_corners(c, cuts, &n, err);
  const size_t parts = n - 1;
  CagCurve **part = cag_calloc(parts, sizeof *part), **arcs = cag_calloc(parts, sizeof *arcs);
  Pieces pieces = {cag_malloc(sizeof *pieces.items * (2 * parts + 2)), 0};
  if (!status && (!part || !arcs || !pieces.items)) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < parts; i++)
    status = cag_curve_trim(c, cuts[i], cuts[i + 1], &part[i], err);
  if (!status) status = round_parts(part, parts, seam_is_corner(c), radius, arcs, &pieces, err);
  if (!status) status = cag_curve_join(pieces.items, pieces.n, out, err);
  for (size_t i = 0; i < parts; i++) {
    if (part) cag_curve_release(part[i]);
    if (arcs) cag_curve_release(arcs[i]);
  }
  cag_free(part);
  cag_free(arcs);
  cag_free(cuts);
  release(&pieces);
  return status;
}

CagStatus cag_curve_rounded(const CagCurve *c, double radius, CagCurve **out, CagError *err) {
  const CagVec3 *p;
  size_t n;
  bool closed;
  CagStatus status = check_radius(radius, err);
  if (status) return status;
  if (cag_curve_vertices(c, &p, &n, &closed))
    return round_polyline(c, p, n, closed, radius, out, err);
  if (c->dimension != 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_planar, "", -1,
                    "in space, only polylines can be rounded");
  return round_curve(c, radius, out, err);
}
