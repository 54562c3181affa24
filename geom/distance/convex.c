// Distances of convex bodies by their support functions, and of rings by subdivision.
//
// The points a - b of two bodies form a convex body too, whose point closest to the origin is the
// shortest way between them. The method of Gilbert, Johnson, and Keerthi holds up to four of its
// points, and the point v of their hull closest to the origin. The plane through the farthest point
// against v, perpendicular to v, bounds the distance from below, |v| from above. That point then
// joins the hull.
//
// The distance of a convex body is at least that of a half space around it. Over an arc of a ring,
// the distance of the half space that is exact at the middle of the arc bounds it, with an error of
// the second order. Arcs are halved until no bound is below the least distance found.

#include "geom/distance/convex.h"

#include <string.h>

// The search ends when the bounds of the distance are as close to each other as this fraction of the
// size. Rounding may prevent it from getting there.
#define CLOSE 1e-14
// The result is accepted if they are within this fraction. Bodies that are closer meet.
#define ACCEPTED 1e-10
enum { ROUNDS = 250 };

// Arcs that a ring starts with, and the largest number that may remain; more are needed only for
// almost constant distances, which are sampled.
enum { FIRST_ARCS = 16, MOST_ARCS = 160, LEVELS = 48, SAMPLES = 128, REFINEMENTS = 60 };
// Arcs are excluded if they are at most this fraction of the size closer than the best point.
#define ARC_CLOSE 4e-12
// The best point is then moved to where the slope is zero, within this angle.
#define POLISHED 1e-4
enum { POLISH_ROUNDS = 6 };

// --- Support functions ---

static CagVec3 support_of_points(const CagConvex *c, CagVec3 d) {
  size_t best = 0;
  double most = cag_dot(c->points[0], d);
  for (size_t i = 1; i < c->count; i++) {
    const double along = cag_dot(c->points[i], d);
    if (along <= most) continue;
    most = along;
    best = i;
  }
  return c->points[best];
}

static CagVec3 support_of_ellipsoid(const CagConvex *c, CagVec3 d) {
  const double x = cag_dot(c->x, d), y = cag_dot(c->y, d), z = cag_dot(c->z, d);
  const double norm = sqrt(x * x + y * y + z * z);
  if (!(norm > 0)) return c->center;
  return cag_madd(cag_madd(cag_madd(c->center, x / norm, c->x), y / norm, c->y), z / norm, c->z);
}

static CagVec3 support_of_frustum(const CagConvex *c, CagVec3 d) {
  const double x = cag_dot(c->x, d), y = cag_dot(c->y, d), across = sqrt(x * x + y * y);
  const int end = cag_dot(c->z, d) + (c->radius[1] - c->radius[0]) * across > 0;
  const CagVec3 center = end ? cag_add(c->center, c->z) : c->center;
  if (!(across > 0)) return center;
  const double by = c->radius[end] / across;
  return cag_madd(cag_madd(center, x * by, c->x), y * by, c->y);
}

// The farthest point along d, without rounding.
static CagVec3 support(const CagConvex *c, CagVec3 d) {
  switch (c->kind) {
  case CAG_CONVEX_HULL: return support_of_points(c, d);
  case CAG_CONVEX_ELLIPSOID: return support_of_ellipsoid(c, d);
  case CAG_CONVEX_FRUSTUM: return support_of_frustum(c, d);
  default: break;
  }
  const double x = cag_dot(c->x, d), y = cag_dot(c->y, d), across = sqrt(x * x + y * y);
  if (!(across > 0)) return cag_add(c->center, c->x);
  return cag_madd(cag_madd(c->center, x / across, c->x), y / across, c->y);
}

CagBounds cag_convex_bounds(const CagConvex *c) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  const CagVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 3; k++)
    for (int sign = -1; sign <= 1; sign += 2)
      cag_bounds_add(&box, support(c, cag_scaled(axes[k], sign)));
  const CagVec3 round = {c->round, c->round, c->round};
  return (CagBounds){cag_sub(box.min, round), cag_add(box.max, round)};
}

CagVec3 cag_convex_point(const CagConvex *c) { return support(c, cag_vec3(0, 0, 1)); }

// --- Simplices ---

// Up to four points of the difference of two bodies, the points of the first one that they come from,
// and the weights with which they are combined.
typedef struct Simplex {
  CagVec3 at[4], of[4];
  double weight[4];
  int n;
} Simplex;

// The affine combination of the first n points that is closest to the origin; false: the weights
// are not all positive.
static bool weigh_points(Simplex *s) {
  const CagVec3 p = s->at[0], to = cag_scaled(p, -1);
  const CagVec3 e = cag_sub(s->at[1], p), f = cag_sub(s->at[2], p), g = cag_sub(s->at[3], p);
  double *w = s->weight;
  if (s->n == 2) w[1] = cag_dot(to, e) / cag_dot(e, e);
  if (s->n == 3) {
    const CagVec3 normal = cag_cross(e, f);
    const double square = cag_dot(normal, normal);
    w[1] = cag_dot(cag_cross(to, f), normal) / square;
    w[2] = cag_dot(cag_cross(e, to), normal) / square;
  }
  if (s->n == 4) {
    const double volume = cag_dot(cag_cross(e, f), g);
    w[1] = cag_dot(cag_cross(to, f), g) / volume;
    w[2] = cag_dot(cag_cross(e, to), g) / volume;
    w[3] = cag_dot(cag_cross(e, f), to) / volume;
  }
  w[0] = 1;
  for (int i = 1; i < s->n; i++) {
    if (!(w[i] > 0)) return false;
    w[0] -= w[i];
  }
  return w[0] > 0;
}

static CagVec3 combined(const Simplex *s) {
  CagVec3 v = {0, 0, 0};
  for (int i = 0; i < s->n; i++) v = cag_madd(v, s->weight[i], s->at[i]);
  return v;
}

// Adds a point, and keeps the points that carry the one closest to the origin. Every combination
// with positive weights is a point of the hull, so the least of them is safe even if the points
// almost coincide.
static CagVec3 add_apex(Simplex *s, CagVec3 apex, CagVec3 of) {
  Simplex best = {.at = {apex}, .of = {of}, .weight = {1}, .n = 1};
  CagVec3 nearest = apex;
  double least = cag_dot(apex, apex);
  for (unsigned which = 1; which < 1u << s->n; which++) {
    Simplex part = {.at = {apex}, .of = {of}, .n = 1};
    for (int i = 0; i < s->n; i++)
      if (which >> i & 1) {
        part.of[part.n] = s->of[i];
        part.at[part.n++] = s->at[i];
      }
    if (!weigh_points(&part)) continue;
    const CagVec3 v = combined(&part);
    const double square = cag_dot(v, v);
    if (!(square < least)) continue;
    least = square;
    nearest = v;
    best = part;
  }
  *s = best;
  return nearest;
}

// --- Convex bodies ---

// Bounds of the distance of two bodies without rounding, the unit normal toward the first one of the
// half space that has the lower one, and the points that have the upper one.
typedef struct Gap {
  double least, most;
  CagVec3 normal, points[2];
} Gap;

static CagVec3 combined_first(const Simplex *s) {
  CagVec3 v = {0, 0, 0};
  for (int i = 0; i < s->n; i++) v = cag_madd(v, s->weight[i], s->of[i]);
  return v;
}

static bool holds_point(const Simplex *s, CagVec3 p) {
  for (int i = 0; i < s->n; i++)
    if (memcmp(&s->at[i], &p, sizeof p) == 0) return true;
  return false;
}

// Starts at the difference of a point of each body. Ends if the lower bound is at least `enough`.
static Gap gap_of(const CagConvex *a, const CagConvex *b, CagVec3 p, CagVec3 q, double size,
                  double enough) {
  Simplex s = {.n = 0};
  CagVec3 v = cag_sub(p, q);
  Gap gap = {-INFINITY, INFINITY, {0, 0, 0}, {p, q}};
  double last = INFINITY; // of the simplex, which does not contain the start
  for (int round = 0; round < ROUNDS; round++) {
    const double norm = cag_norm(v);
    if (round > 0 && !(norm < last)) break; // only rounding is left
    if (round > 0) last = norm;
    if (norm < gap.most) {
      const CagVec3 first = round > 0 ? combined_first(&s) : p;
      gap.most = norm;
      gap.points[0] = first;
      gap.points[1] = cag_sub(first, v);
    }
    if (!(norm > CLOSE * size)) {
      gap.least = gap.most = 0;
      break;
    }
    const CagVec3 n = cag_scaled(v, 1 / norm);
    const CagVec3 of = support(a, cag_scaled(n, -1)), apex = cag_sub(of, support(b, n));
    const double least = cag_dot(apex, n);
    if (least > gap.least) {
      gap.least = least;
      gap.normal = n;
    }
    if (gap.most - gap.least <= CLOSE * (size + gap.most) || gap.least >= enough) break;
    if (holds_point(&s, apex)) break;
    v = add_apex(&s, apex, of);
  }
  return gap;
}

static CagVec3 middle_of(const CagConvex *c) {
  const CagVec3 far = cag_vec3(1, 1, 1);
  return c->kind == CAG_CONVEX_HULL
             ? cag_lerp(support(c, far), support(c, cag_scaled(far, -1)), 0.5)
         : c->kind == CAG_CONVEX_FRUSTUM ? cag_madd(c->center, 0.5, c->z)
                                         : c->center;
}

static double size_of(const CagConvex *c) {
  if (c->kind == CAG_CONVEX_HULL) {
    double most = 0;
    for (size_t i = 1; i < c->count; i++)
      most = fmax(most, cag_norm(cag_sub(c->points[i], c->points[0])));
    return most;
  }
  if (c->kind == CAG_CONVEX_FRUSTUM)
    return cag_norm(c->z) + fmax(c->radius[0], c->radius[1]) * (cag_norm(c->x) + cag_norm(c->y));
  return 2 * fmax(cag_norm(c->x), fmax(cag_norm(c->y), cag_norm(c->z)));
}

// --- Rings ---

// A ring, and the body whose distance from it is wanted.
typedef struct Pair {
  const CagConvex *ring, *other;
  CagVec3 middle; // of the other body
  double size;
  double meeting, enough; // distances up to the one, or from the other on, need not be exact
} Pair;

// An arc of the ring about an angle, bounds of its distance, and the sign of its slope at the angle,
// times a factor that hardly changes.
typedef struct Arc {
  double angle, half, least, most, slope;
} Arc;

static CagVec3 ring_point(const CagConvex *ring, double angle) {
  return cag_madd(cag_madd(ring->center, cos(angle), ring->x), sin(angle), ring->y);
}

// The least value of x cos(t) + y sin(t) for t within half of angle.
static double least_wave(double x, double y, double angle, double half) {
  const double lowest = atan2(-y, -x), amplitude = hypot(x, y);
  const double off = fabs(remainder(lowest - angle, 2 * M_PI));
  return off <= half ? -amplitude : -amplitude * cos(off - half);
}

// By the half space around the body that is exact at the middle of the arc.
static void bound_by_plane(const Pair *pair, Arc *arc) {
  const CagVec3 p = ring_point(pair->ring, arc->angle);
  const CagConvex point = {.kind = CAG_CONVEX_HULL, .points = &p, .count = 1};
  const Gap gap = gap_of(&point, pair->other, p, pair->middle, pair->size, pair->enough);
  const double x = cag_dot(pair->ring->x, gap.normal), y = cag_dot(pair->ring->y, gap.normal);
  const double here = x * cos(arc->angle) + y * sin(arc->angle);
  arc->most = gap.most;
  arc->slope = y * cos(arc->angle) - x * sin(arc->angle);
  arc->least = gap.least - here + least_wave(x, y, arc->angle, arc->half);
}

// The distance of a point from a circle is that in the plane through the axis. Its square is the sum
// of the square of the distance from the center, that of the radius R, and -2 R rho, where rho is
// the distance from the axis. Since the square root is concave, rho <= (rho^2 / m + m) / 2 for all
// m > 0. With the value of rho at the middle of the arc for m, the right side has waves of one and
// two periods, which Taylor's theorem bounds.
static void bound_by_waves(const Pair *pair, Arc *arc) {
  const CagConvex *ring = pair->ring, *other = pair->other;
  const double radius = cag_norm(other->x), own = cag_norm(ring->x);
  const CagVec3 axis = cag_unit(cag_cross(other->x, other->y));
  const CagVec3 p = ring_point(ring, arc->angle), r = cag_sub(p, other->center);
  const CagVec3 d = cag_madd(cag_scaled(ring->x, -sin(arc->angle)), cos(arc->angle), ring->y);
  const double height = cag_dot(r, axis), rho = cag_norm(cag_madd(r, -height, axis));
  const double f = hypot(rho - radius, height);
  arc->most = f;
  arc->least = f - own * arc->half; // the distance changes at most as fast as the point
  if (!(rho > 0)) return;
  // q(t) = |r|^2 + R^2 - R (rho^2 / m + m), with the first derivative, and a bound of the second.
  const double climb = cag_dot(d, axis);
  const double slope = 2 * cag_dot(r, d) - radius / rho * 2 * (cag_dot(r, d) - height * climb);
  arc->slope = slope;
  const double offset = cag_norm(cag_sub(ring->center, other->center));
  const double tilt = hypot(cag_dot(ring->x, axis), cag_dot(ring->y, axis));
  const double bend =
      2 * own * offset * (1 + radius / rho) + radius / rho * 2 * tilt * (tilt + offset);
  const double square = f * f - fabs(slope) * arc->half - bend * arc->half * arc->half / 2;
  if (square > 0) arc->least = fmax(arc->least, sqrt(square));
}

static Arc arc_at(const Pair *pair, double angle, double half) {
  Arc arc = {.angle = angle, .half = half};
  if (pair->other->kind == CAG_CONVEX_RING) bound_by_waves(pair, &arc);
  else bound_by_plane(pair, &arc);
  return arc;
}

// The nearest point of a ring, if it is off the axis.
static CagVec3 nearest_of_ring(const CagConvex *ring, CagVec3 p) {
  return support(ring, cag_sub(p, ring->center));
}

// The least distance between two angles, by golden sections, which replaces a larger one.
static void refine(const Pair *pair, double low, double high, double *best, double *angle) {
  const double golden = (sqrt(5) - 1) / 2;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = arc_at(pair, a, 0).most, at_b = arc_at(pair, b, 0).most;
  for (int i = 0; i < REFINEMENTS; i++) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      at_a = arc_at(pair, a = high - golden * (high - low), 0).most;
    } else {
      low = a;
      a = b;
      at_a = at_b;
      at_b = arc_at(pair, b = low + golden * (high - low), 0).most;
    }
  }
  if (!(fmin(at_a, at_b) < *best)) return;
  *best = fmin(at_a, at_b);
  *angle = at_a < at_b ? a : b;
}

static void keep_best(const Arc *arc, double *best, double *angle) {
  if (arc->most >= *best) return;
  *best = arc->most;
  *angle = arc->angle;
}

// The distance where the slope is zero near the angle, if there is a minimum, replaces a larger one.
static void polish(const Pair *pair, double *best, double *angle) {
  Arc low = arc_at(pair, *angle - POLISHED, 0), high = arc_at(pair, *angle + POLISHED, 0);
  keep_best(&low, best, angle);
  keep_best(&high, best, angle);
  for (int i = 0; i < POLISH_ROUNDS && low.slope < 0 && high.slope > 0; i++) {
    const double part = low.slope / (low.slope - high.slope);
    const Arc next = arc_at(pair, low.angle + part * (high.angle - low.angle), 0);
    keep_best(&next, best, angle);
    if (next.slope < 0) low = next;
    else high = next;
  }
}

static void sample_gap(const Pair *pair, double *best, double *angle) {
  const double step = 2 * M_PI / SAMPLES;
  double at[SAMPLES];
  for (int i = 0; i < SAMPLES; i++) {
    const Arc arc = arc_at(pair, step * i, 0);
    at[i] = arc.most;
    keep_best(&arc, best, angle);
  }
  const double flat = CLOSE * pair->size;
  for (int i = 0; i < SAMPLES; i++) {
    const double before = at[(i + SAMPLES - 1) % SAMPLES], after = at[(i + 1) % SAMPLES];
    if (at[i] > before || at[i] > after || fmax(before, after) - at[i] <= flat) continue;
    refine(pair, step * (i - 1), step * (i + 1), best, angle);
  }
}

// The bounds with the points that belong to the angle.
static Gap gap_at(const Pair *pair, double least, double most, double angle) {
  const CagVec3 p = ring_point(pair->ring, angle);
  if (pair->other->kind == CAG_CONVEX_RING)
    return (Gap){least, most, {0, 0, 0}, {p, nearest_of_ring(pair->other, p)}};
  const CagConvex point = {.kind = CAG_CONVEX_HULL, .points = &p, .count = 1};
  const Gap gap = gap_of(&point, pair->other, p, pair->middle, pair->size, INFINITY);
  return (Gap){least, most, {0, 0, 0}, {p, gap.points[1]}};
}

// Bounds of the distance of a ring from another body, without rounding.
static Gap gap_of_ring(const Pair *pair) {
  Arc arcs[MOST_ARCS], next[2 * MOST_ARCS];
  const double close = ARC_CLOSE * pair->size;
  int n = 0;
  double best = INFINITY, angle = 0;
  for (int i = 0; i < FIRST_ARCS; i++) {
    arcs[n++] = arc_at(pair, 2 * M_PI * i / FIRST_ARCS, M_PI / FIRST_ARCS);
    keep_best(&arcs[i], &best, &angle);
  }
  for (int level = 0; level < LEVELS; level++) {
    int kept = 0, count = 0;
    for (int i = 0; i < n; i++)
      if (arcs[i].least < fmin(best, pair->enough) - close) arcs[kept++] = arcs[i];
    n = kept;
    if (n == 0 || best <= pair->meeting) {
      if (best > pair->meeting) polish(pair, &best, &angle);
      return gap_at(pair, fmin(best, pair->enough), best, angle);
    }
    if (2 * n > MOST_ARCS) break;
    for (int i = 0; i < n; i++)
      for (int side = -1; side <= 1; side += 2) {
        const double half = arcs[i].half / 2;
        next[count] = arc_at(pair, arcs[i].angle + side * half, half);
        // An arc's bound also holds for its halves.
        next[count].least = fmax(next[count].least, arcs[i].least);
        keep_best(&next[count++], &best, &angle);
      }
    memcpy(arcs, next, (size_t)count * sizeof *next);
    n = count;
  }
  sample_gap(pair, &best, &angle);
  return gap_at(pair, fmin(best, pair->enough), best, angle);
}

// --- All kinds ---

// Moves the points by the rounding of their bodies, but not beyond each other.
static void round_points(const CagConvex *a, const CagConvex *b, CagVec3 points[2]) {
  const CagVec3 way = cag_sub(points[1], points[0]);
  const double gap = cag_norm(way), first = fmin(a->round, gap);
  const double second = fmin(b->round, gap - first);
  if (!(gap > 0)) return;
  points[0] = cag_madd(points[0], first / gap, way);
  points[1] = cag_madd(points[1], -second / gap, way);
}

bool cag_convex_distance(const CagConvex *a, const CagConvex *b, double most, double *out,
                         CagVec3 points[2]) {
  const double round = a->round + b->round, enough = most + round;
  const CagVec3 p = middle_of(a), q = middle_of(b);
  const double size = size_of(a) + size_of(b) + round, far = cag_norm(cag_sub(p, q));
  Gap gap;
  if (a->kind == CAG_CONVEX_RING || b->kind == CAG_CONVEX_RING) {
    const bool first = a->kind == CAG_CONVEX_RING;
    const Pair pair = {
        first ? a : b, first ? b : a, first ? q : p, size + far, round + ARC_CLOSE * size, enough};
    gap = gap_of_ring(&pair);
    if (!first) gap = (Gap){gap.least, gap.most, gap.normal, {gap.points[1], gap.points[0]}};
  } else {
    gap = gap_of(a, b, p, q, size, enough);
  }
  const double accepted = ACCEPTED * (size + far);
  if (gap.most <= round + accepted) *out = 0;
  else if (gap.least >= enough) *out = gap.least - round;
  else if (gap.most - gap.least <= accepted) *out = gap.most - round;
  else return false;
  if (!points) return true;
  memcpy(points, gap.points, sizeof gap.points);
  round_points(a, b, points);
  return true;
}
