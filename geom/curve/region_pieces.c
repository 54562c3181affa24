// Pieces of curves that are monotone in x and in y.
//
// Such a piece lies in the box of its ends, takes each coordinate value once, and moves away from
// its ends monotonically. Boxes, rays, and small circles about a corner therefore intersect it at
// most once, and bisection finds the intersection.

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/region_arrange.h"
#include "geom/linalg/tolerance.h"

// Velocities below this fraction of the largest are zero: a straight line keeps its direction.
#define STILL 1e-11
// Maximum relative difference of the axes of a circle.
#define ROUND CAG_ROUNDING
// Samples of a smooth part in the search for extrema; more for higher degrees.
#define SAMPLES 24
#define SAMPLES_PER_DEGREE 4
// Enough bisections to reduce an interval to neighboring doubles.
#define BISECTIONS 100

static CagStatus add(CagRegionPieces *s, CagRegionPiece piece, CagError *err) {
  if (!CAG_RESERVE(s->items, s->capacity, s->n + 1)) return cag_fail_memory(err);
  piece.source = s->n;
  s->items[s->n++] = piece;
  return CAG_OK;
}

void cag_region_pieces_free(CagRegionPieces *s) {
  for (size_t i = 0; i < s->n; i++) cag_curve_release(s->items[i].part);
  cag_free(s->items);
}

// Sets the circle of a piece of a circle.
static void find_circle(const CagCurve *c, CagRegionPiece *piece) {
  double local_a, local_b, rate;
  const CagCurve *inner =
      cag_curve_composite_piece(c, piece->a, piece->b, &local_a, &local_b, &rate);
  CagVec3 x, y;
  if (!cag_curve_arc_axes(inner ? inner : c, &piece->center, &x, &y, &rate)) return;
  piece->radius = cag_norm(x);
  const double square = piece->radius * piece->radius;
  piece->round =
      fabs(square - cag_dot(y, y)) <= ROUND * square && fabs(cag_dot(x, y)) <= ROUND * square;
}

static CagStatus add_part(CagRegionPieces *s, size_t walk, double a, double b, bool straight,
                          CagError *err) {
  const CagCurve *c = s->walks[walk].curve;
  CagRegionPiece piece = {.walk = walk, .a = a, .b = b, .straight = straight};
  piece.count[s->walks[walk].operand] = s->walks[walk].sign;
  CagStatus status = cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &piece.p, err);
  if (!status) status = cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &piece.q, err);
  if (!straight) find_circle(c, &piece);
  return status ? status : add(s, piece, err);
}

// Whether the curve is straight over a part between two breaks.
static bool is_straight(const CagCurve *c, double a, double b) {
  const CagVec3 *points;
  size_t n;
  bool ring;
  double local_a, local_b, rate;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &local_a, &local_b, &rate);
  return cag_curve_vertices(piece ? piece : c, &points, &n, &ring);
}

// --- Extrema of the coordinates ---

typedef struct Sample {
  double t;
  double v[2], w[2]; // velocity and its change, by coordinate
} Sample;

static CagStatus sample(const CagCurve *c, double t, CagSide side, Sample *out, CagError *err) {
  CagVec3 d[3];
  CagStatus status = cag_curve_eval(c, t, 2, side, d, err);
  *out = (Sample){t, {d[1].x, d[1].y}, {d[2].x, d[2].y}};
  return status;
}

// The zero of the velocity (order 0) or its derivative (1) in the coordinate between a and b.
static CagStatus bisect(const CagCurve *c, const Sample *a, const Sample *b, int order, int axis,
                        Sample *out, CagError *err) {
  double lo = a->t, hi = b->t;
  const bool up = (order ? a->w : a->v)[axis] < 0;
  *out = *a;
  for (int i = 0; i < BISECTIONS; i++) {
    const double t = lo + (hi - lo) / 2;
    if (!(t > lo && t < hi)) break;
    CagStatus status = sample(c, t, CAG_SIDE_RIGHT, out, err);
    if (status) return status;
    const double f = (order ? out->w : out->v)[axis];
    if (f == 0) break;
    if ((f < 0) == up) lo = t;
    else hi = t;
  }
  return CAG_OK;
}

typedef struct Turns {
  double *t;
  size_t n, capacity;
} Turns;

static CagStatus add_turn(Turns *turns, double t, CagError *err) {
  if (!CAG_RESERVE(turns->t, turns->capacity, turns->n + 1)) return cag_fail_memory(err);
  turns->t[turns->n++] = t;
  return CAG_OK;
}

static bool opposite(double x, double y, double still) {
  return (x > still && y < -still) || (x < -still && y > still);
}

// Extrema between two neighboring samples: one if the velocity changes sign; two if its minimum in
// between has the other sign.
static CagStatus turns_between(const CagCurve *c, const Sample *a, const Sample *b, int axis,
                               double still, Turns *turns, CagError *err) {
  Sample m;
  if (opposite(a->v[axis], b->v[axis], still)) {
    CagStatus status = bisect(c, a, b, 0, axis, &m, err);
    return status ? status : add_turn(turns, m.t, err);
  }
  if (a->w[axis] * b->w[axis] >= 0) return CAG_OK;
  CagStatus status = bisect(c, a, b, 1, axis, &m, err);
  if (status || !opposite(a->v[axis], m.v[axis], still)) return status;
  Sample turn;
  status = bisect(c, a, &m, 0, axis, &turn, err);
  if (!status) status = add_turn(turns, turn.t, err);
  if (!status && opposite(m.v[axis], b->v[axis], still)) {
    status = bisect(c, &m, b, 0, axis, &turn, err);
    if (!status) status = add_turn(turns, turn.t, err);
  }
  return status;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static CagStatus turns_of(const CagCurve *c, double a, double b, Turns *turns, CagError *err) {
  CagNurbsView view;
  size_t n = SAMPLES;
  if (cag_curve_nurbs_view(c, &view)) n += SAMPLES_PER_DEGREE * (size_t)view.degree;
  Sample *samples = cag_malloc(sizeof *samples * (n + 1));
  if (!samples) return cag_fail_memory(err);
  double fastest = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i <= n; i++) {
    const double t = i == n ? b : a + (b - a) * (double)i / (double)n;
    status = sample(c, t, i == n ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &samples[i], err);
    if (!status) fastest = fmax(fastest, hypot(samples[i].v[0], samples[i].v[1]));
  }
  for (size_t i = 0; !status && i < n; i++)
    for (int axis = 0; !status && axis < 2; axis++)
      status = turns_between(c, &samples[i], &samples[i + 1], axis, STILL * fastest, turns, err);
  // An extremum at a sample is missed by both of its intervals.
  for (size_t i = 1; !status && i < n; i++)
    for (int axis = 0; !status && axis < 2; axis++)
      if (fabs(samples[i].v[axis]) <= STILL * fastest &&
          opposite(samples[i - 1].v[axis], samples[i + 1].v[axis], STILL * fastest))
        status = add_turn(turns, samples[i].t, err);
  cag_free(samples);
  if (!status && turns->n) qsort(turns->t, turns->n, sizeof *turns->t, ascending);
  return status;
}

static CagStatus add_smooth(CagRegionPieces *s, size_t walk, double a, double b, CagError *err) {
  Turns turns = {0};
  CagStatus status = turns_of(s->walks[walk].curve, a, b, &turns, err);
  double from = a;
  for (size_t i = 0; !status && i <= turns.n; i++) {
    const double to = i < turns.n ? turns.t[i] : b;
    if (!(to > from) || (i < turns.n && !(to < b))) continue;
    status = add_part(s, walk, from, to, false, err);
    from = to;
  }
  cag_free(turns.t);
  return status;
}

CagStatus cag_region_pieces_add(CagRegionPieces *s, size_t walk, CagError *err) {
  const CagCurve *c = s->walks[walk].curve;
  double *cuts;
  size_t n;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    if (!(cuts[i] < cuts[i + 1])) continue;
    status = is_straight(c, cuts[i], cuts[i + 1])
                 ? add_part(s, walk, cuts[i], cuts[i + 1], true, err)
                 : add_smooth(s, walk, cuts[i], cuts[i + 1], err);
  }
  cag_free(cuts);
  return status;
}

// --- Points on a piece ---

CagStatus cag_region_piece_point(const CagRegionPieces *s, const CagRegionPiece *piece, double t,
                                 CagVec3 *out, CagError *err) {
  if (t == piece->a || t == piece->b) {
    *out = t == piece->a ? piece->p : piece->q;
    return CAG_OK;
  }
  if (piece->straight) {
    *out = cag_lerp(piece->p, piece->q, (t - piece->a) / (piece->b - piece->a));
    return CAG_OK;
  }
  return cag_curve_eval(s->walks[piece->walk].curve, t, 0, CAG_SIDE_RIGHT, out, err);
}

// The quantity to solve for, monotone along the piece: a coordinate, or the distance from a point.
typedef struct Measure {
  int axis; // 2: distance
  CagVec3 from;
  double value;
} Measure;

static double measure(const Measure *m, CagVec3 p) {
  if (m->axis == 2) return hypot(p.x - m->from.x, p.y - m->from.y) - m->value;
  return (m->axis ? p.y : p.x) - m->value;
}

// Regula falsi (Illinois variant), with bisection where that is slow.
static CagStatus find(const CagRegionPieces *s, const CagRegionPiece *piece, double a, double b,
                      const Measure *m, double *out, CagVec3 *point, CagError *err) {
  CagVec3 p, q;
  CagStatus status = cag_region_piece_point(s, piece, a, &p, err);
  if (!status) status = cag_region_piece_point(s, piece, b, &q, err);
  if (status) return status;
  double fa = measure(m, p), fb = measure(m, q);
  if ((fa > 0) == (fb > 0) || fa == 0 || fb == 0) {
    const bool first = fabs(fa) <= fabs(fb);
    *out = first ? a : b;
    *point = first ? p : q;
    return CAG_OK;
  }
  int kept = 0;
  for (int i = 0; i < BISECTIONS; i++) {
    double t = i % 4 == 3 ? a + (b - a) / 2 : (fa * b - fb * a) / (fa - fb);
    if (!(t > a && t < b)) t = a + (b - a) / 2;
    *out = t;
    status = cag_region_piece_point(s, piece, t, point, err);
    if (status || !(t > a && t < b)) return status;
    const double f = measure(m, *point);
    if (f == 0) return CAG_OK;
    if ((f > 0) == (fa > 0)) {
      a = t;
      fa = f;
      if (kept == 1) fb /= 2;
      kept = 1;
    } else {
      b = t;
      fb = f;
      if (kept == -1) fa /= 2;
      kept = -1;
    }
  }
  return CAG_OK;
}

CagStatus cag_region_piece_at(const CagRegionPieces *s, const CagRegionPiece *piece, double a,
                              double b, int axis, double value, double *t, CagVec3 *point,
                              CagError *err) {
  const Measure m = {axis, {0, 0, 0}, value};
  return find(s, piece, a, b, &m, t, point, err);
}

CagStatus cag_region_piece_at_distance(const CagRegionPieces *s, const CagRegionPiece *piece,
                                       double a, double b, bool from_end, double distance,
                                       CagVec3 *point, CagError *err) {
  Measure m = {2, {0, 0, 0}, distance};
  double t;
  CagStatus status = cag_region_piece_point(s, piece, from_end ? b : a, &m.from, err);
  return status ? status : find(s, piece, a, b, &m, &t, point, err);
}
