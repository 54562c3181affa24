// The bounding box of a curve.
//
// Parts whose hull is inside the box of the points found so far add nothing; other parts are
// halved. For NURBS this continues to the limit, since their hulls are rigorous. For curves known
// only by samples, a part is finished as soon as each coordinate that may leave the box has a
// single maximum there. The maximum is then located by root finding, which takes a few evaluations
// instead of hundreds for bisection.

#include <math.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

// Accepted error of the box, as a fraction of the size of the curve.
#define BOX 1e-11
// Maximum depth of halvings: a parameter has no more bits.
#define DEEPEST 60
// A maximum is accepted in parts that are at most 2^-3 of a smooth piece ...
#define SETTLED_DEPTH 3
// ... and whose hull exceeds the points by at most this fraction of the excess of the parent. For
// smooth curves the excess falls to a quarter, at corners to a half.
#define SETTLED_SHRINK 0.6
// Number of samples of a part for finding maxima; the same as for a hull, so that the points are
// known already.
#define STEPS 8

static bool inside(const CagBounds *outer, const CagBounds *inner, double slack) {
  return inner->min.x >= outer->min.x - slack && inner->min.y >= outer->min.y - slack &&
         inner->min.z >= outer->min.z - slack && inner->max.x <= outer->max.x + slack &&
         inner->max.y <= outer->max.y + slack && inner->max.z <= outer->max.z + slack;
}

// --- Rigorous hulls ---

static CagStatus grow(const CagCurve *c, double a, double b, double slack, int depth,
                      CagBounds *box, CagError *err) {
  CagBounds hull = c->kind->hull(c, a, b);
  double middle = a + (b - a) / 2;
  if (depth == 0 || inside(box, &hull, slack) || !(a < middle && middle < b)) return CAG_OK;
  CagVec3 p;
  CagStatus status = cag_curve_eval(c, middle, 0, CAG_SIDE_RIGHT, &p, err);
  if (status) return status;
  cag_bounds_add(box, p);
  status = grow(c, a, middle, slack, depth - 1, box, err);
  return status ? status : grow(c, middle, b, slack, depth - 1, box, err);
}

// --- Samples ---

typedef struct Samples {
  double t[STEPS + 1];
  CagVec3 p[STEPS + 1];
} Samples;

// The support of a point in the direction 0..5: -x, +x, -y, +y, -z, +z.
static double height(CagVec3 p, int direction) {
  const double x[3] = {p.x, p.y, p.z};
  return direction % 2 ? x[direction / 2] : -x[direction / 2];
}

static double box_height(const CagBounds *box, int direction) {
  return height(direction % 2 ? box->max : box->min, direction);
}

// How far the hull exceeds the box, in the direction in which that is largest.
static double excess(const CagBounds *hull, const CagBounds *box) {
  double most = 0;
  for (int k = 0; k < 6; k++) most = fmax(most, box_height(hull, k) - box_height(box, k));
  return most;
}

// Index of the only maximum of the samples in a direction; -1: there are several.
static int summit(const Samples *s, int direction) {
  int top = 0;
  for (int i = 1; i <= STEPS; i++)
    if (height(s->p[i], direction) > height(s->p[top], direction)) top = i;
  for (int i = 1; i <= STEPS; i++) {
    const double step = height(s->p[i], direction) - height(s->p[i - 1], direction);
    if (i <= top ? step < 0 : step > 0) return -1;
  }
  return top;
}

// The slope in a direction; false: undefined.
static bool slope(const CagCurve *c, double t, CagSide side, int direction, CagVec3 *p,
                  double *out) {
  CagVec3 d[2];
  CagError ignored;
  if (cag_curve_eval(c, t, 1, side, d, &ignored)) return false;
  *p = d[0];
  *out = height(d[1], direction);
  return true;
}

// Adds the maximum near sample `top` to the box: the root of the slope between its neighbors, by
// false position (the Illinois variant). Returns false if the slopes do not bracket one.
static bool climb(const CagCurve *c, const Samples *s, int top, int direction, double slack,
                  CagBounds *box) {
  enum { ROUNDS = 60 };
  const bool first = top == 0, last = top == STEPS;
  double a = s->t[first ? 0 : top - 1], b = s->t[last ? STEPS : top + 1], up, down;
  CagVec3 p;
  if (!slope(c, a, CAG_SIDE_RIGHT, direction, &p, &up) ||
      !slope(c, b, CAG_SIDE_LEFT, direction, &p, &down))
    return false;
  if ((first && up <= 0) || (last && down >= 0)) return true; // the sample is the maximum
  if (!(up > 0 && down < 0)) return false;
  double before = a;
  int kept = 0; // the end that was kept in the last round: -1 or 1
  for (int round = 0; round < ROUNDS; round++) {
    double t = a + (b - a) * (up / (up - down)), at;
    if (!(a < t && t < b)) return true;
    if (!slope(c, t, CAG_SIDE_RIGHT, direction, &p, &at)) return false;
    cag_bounds_add(box, p);
    if (fabs(at * (t - before)) <= slack) return true;
    before = t;
    if (at > 0) {
      a = t, up = at;
      if (kept == 1) down /= 2;
      kept = 1;
    } else {
      b = t, down = at;
      if (kept == -1) up /= 2;
      kept = -1;
    }
  }
  return false;
}

// Whether the part has a single maximum in each direction in which its hull leaves the box; these
// are then added to the box.
static CagStatus bound_by_summits(const CagCurve *c, double a, double b, const CagBounds *hull,
                                  double slack, CagBounds *box, bool *settled, CagError *err) {
  Samples s;
  for (int i = 0; i <= STEPS; i++) {
    s.t[i] = i == STEPS ? b : a + (b - a) * i / STEPS;
    CagStatus status =
        cag_curve_eval(c, s.t[i], 0, i == STEPS ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &s.p[i], err);
    if (status) return status;
    cag_bounds_add(box, s.p[i]);
  }
  *settled = true;
  for (int k = 0; *settled && k < 6; k++) {
    if (box_height(hull, k) <= box_height(box, k) + slack) continue;
    const int top = summit(&s, k);
    *settled = top >= 0 && climb(c, &s, top, k, slack, box);
  }
  return CAG_OK;
}

// `before` is the amount by which the hull of the parent exceeds the box.
static CagStatus grow_sampled(const CagCurve *c, double a, double b, double slack, int depth,
                              double before, CagBounds *box, CagError *err) {
  const CagBounds hull = c->kind->hull(c, a, b);
  const double middle = a + (b - a) / 2, over = excess(&hull, box);
  if (depth == DEEPEST || over <= slack || !(a < middle && middle < b)) return CAG_OK;
  CagVec3 p;
  CagStatus status = cag_curve_point(c, middle, &p, err);
  if (status) return status;
  cag_bounds_add(box, p);
  if (depth >= SETTLED_DEPTH && over <= SETTLED_SHRINK * before) {
    bool settled;
    status = bound_by_summits(c, a, b, &hull, slack, box, &settled, err);
    if (status || settled) return status;
  }
  status = grow_sampled(c, a, middle, slack, depth + 1, over, box, err);
  return status ? status : grow_sampled(c, middle, b, slack, depth + 1, over, box, err);
}

// --- All kinds ---

// Adds the smooth piece over [a, b], whose ends are in the box already.
static CagStatus add_piece(const CagCurve *c, double a, double b, double slack, CagBounds *box,
                           CagError *err) {
  CagVec3 center, x, y;
  double rate;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &rate);
  if (piece) return add_piece(piece, a, b, slack, box, err);
  if (cag_nurbs_data(c)) return grow(c, a, b, slack, DEEPEST, box, err);
  if (!cag_curve_arc_axes(c, &center, &x, &y, &rate))
    return grow_sampled(c, a, b, slack, 0, INFINITY, box, err);
  const CagBounds part = c->kind->hull(c, a, b);
  cag_bounds_add(box, part.min);
  cag_bounds_add(box, part.max);
  return CAG_OK;
}

CagStatus cag_curve_bounds(const CagCurve *c, CagBounds *out, CagError *err) {
  CagBounds box = c->kind->hull(c, c->start, c->end);
  CagVec3 center, x, y;
  double rate;
  const CagVec3 *points;
  size_t n;
  bool ring;
  if (!isfinite(cag_norm(cag_sub(box.max, box.min))))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_out_of_range, "", -1,
                    "the curve is out of range");
  // Hulls of these kinds are tight.
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate) || cag_curve_vertices(c, &points, &n, &ring)) {
    *out = box;
    return CAG_OK;
  }
  double slack = fmax(BOX * cag_norm(cag_sub(box.max, box.min)), cag_curve_noise(&box)), *cuts;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  box = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; !status && i < n; i++) {
    CagVec3 p;
    status = cag_curve_point(c, cuts[i], &p, err);
    if (!status) cag_bounds_add(&box, p);
  }
  for (size_t i = 0; !status && i + 1 < n; i++)
    status = add_piece(c, cuts[i], cuts[i + 1], slack, &box, err);
  cag_free(cuts);
  if (!status) *out = box;
  return status;
}
