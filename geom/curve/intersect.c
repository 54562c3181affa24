// Intersections by subdivision. Parts whose distance exceeds the bounds of their sag are dropped.
// Parts with at most one crossing are finished by Newton's method. The rest is clipped to the
// parameters at which its control points allow it to be near the other curve, and halved if that
// helps little. Parts on which Newton's method fails are halved as well, because only the bounds
// can exclude an intersection. Parts that remain at the smallest size belong to tangencies, each of
// which is found many times (contact.h).

#include "geom/curve/intersect.h"

#include <float.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/contact.h"
#include "geom/curve/family.h"
#include "geom/curve/intersect_circles.h"
#include "geom/curve/intersect_clip.h"
#include "geom/linalg/tolerance.h"

// Fractions of the size of the data: deviation below which a curve is a chord; distance below which
// two points are identical.
#define CHORD 1e-11
#define MEET CAG_COINCIDENT
#define ZERO CAG_ROUNDING
// A part longer than this fraction of the domain that lies entirely in the other curve is an
// overlap.
#define OVERLAP 1e-3
// When this many intersections have been found, they are checked for an overlap, and again whenever
// the number doubles.
#define FOUND_MANY 256
// Number of pairs after which the curves are assumed to coincide.
#define MOST_PAIRS 1000000
#define DEPTH 60

typedef struct Found {
  CagContact *items;
  size_t n, capacity;
  CagContactTask task;
} Found;

typedef struct Part {
  double a, b;
  double low, high; // of its smooth interval
  CagVec3 p, q;
} Part;

static CagStatus fail_overlap(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_overlap, "", -1,
                  "the shapes overlap: they share more than isolated points");
}

static CagStatus merge(Found *found, CagError *err) {
  bool overlap;
  CagStatus status = cag_contacts_merge(&found->task, found->items, &found->n, &overlap, err);
  return status ? status : overlap ? fail_overlap(err) : CAG_OK;
}

static CagStatus add(Found *found, double t, double t2, CagVec3 point, CagError *err) {
  if (!CAG_RESERVE(found->items, found->capacity, found->n + 1)) return cag_fail_memory(err);
  found->items[found->n++] = (CagContact){t, {t2, 0}, point, 1};
  const bool many = found->n >= FOUND_MANY && (found->n & (found->n - 1)) == 0;
  return many ? merge(found, err) : CAG_OK;
}

static CagStatus give_contacts(const CagContact *contacts, size_t count, CagMeeting **out,
                               size_t *n, CagError *err) {
  CagMeeting *items = NULL;
  if (count) {
    items = cag_malloc(count * sizeof *items);
    if (!items) return cag_fail_memory(err);
  }
  for (size_t i = 0; i < count; i++) {
    const CagContact *m = &contacts[i];
    items[i] = (CagMeeting){m->t, m->at[0], m->point, m->multiplicity};
  }
  *out = items;
  *n = count;
  return CAG_OK;
}

static CagStatus merged_meetings(Found *found, CagStatus status, CagMeeting **out, size_t *n,
                                 CagError *err) {
  if (!status) status = merge(found, err);
  if (!status) status = give_contacts(found->items, found->n, out, n, err);
  cag_free(found->items);
  return status;
}

static CagStatus first_parts(const CagCurve *c, Part **out, size_t *n, CagError *err) {
  // A smooth piece may be a full turn, so its chord is meaningful only after some halvings.
  enum { HALVES = 4 };
  double *cuts;
  size_t count;
  CagStatus status = cag_curve_cuts(c, &cuts, &count, err);
  if (status) return status;
  const size_t pieces = cag_curve_sag(c, cuts[0], cuts[1]) > 0 ? HALVES : 1;
  Part *parts = cag_malloc(sizeof *parts * (count - 1) * pieces);
  if (!parts) status = cag_fail_memory(err);
  size_t used = 0;
  for (size_t i = 0; !status && i + 1 < count; i++)
    for (size_t k = 0; !status && k < pieces; k++) {
      Part *p = &parts[used++];
      double range = cuts[i + 1] - cuts[i];
      p->low = cuts[i];
      p->high = cuts[i + 1];
      p->a = k ? cuts[i] + range * (double)k / (double)pieces : cuts[i];
      p->b = k + 1 < pieces ? cuts[i] + range * (double)(k + 1) / (double)pieces : cuts[i + 1];
      status = cag_curve_eval(c, p->a, 0, CAG_SIDE_RIGHT, &p->p, err);
      if (!status) status = cag_curve_eval(c, p->b, 0, CAG_SIDE_LEFT, &p->q, err);
    }
  cag_free(cuts);
  if (status) {
    cag_free(parts);
    return status;
  }
  *out = parts;
  *n = used;
  return CAG_OK;
}

static CagStatus halves(const CagCurve *c, const Part *part, Part out[2], CagError *err) {
  double m = part->a + (part->b - part->a) / 2;
  CagVec3 p;
  CagStatus status = cag_curve_point(c, m, &p, err);
  if (status) return status;
  out[0] = out[1] = *part;
  out[0].b = out[1].a = m;
  out[0].q = out[1].p = p;
  return CAG_OK;
}

// Size of a curve, and the rounding error of its coordinates.
static double extent_of(const CagCurve *c, double *noise) {
  CagBounds b = c->kind->hull(c, c->start, c->end);
  *noise = fmax(*noise, cag_curve_noise(&b));
  return cag_norm(cag_sub(b.max, b.min));
}

// --- A plane ---

typedef struct PlaneSearch {
  const CagCurve *c;
  const CagPlane *plane;
  double size, noise;
  Found found;
} PlaneSearch;

static double height(const PlaneSearch *s, CagVec3 p) {
  return cag_dot(cag_sub(p, s->plane->point), s->plane->normal);
}

// The root between a and b, where the heights have different signs: Newton's method within a
// bracket.
static CagStatus solve(PlaneSearch *s, double a, double b, double fa, CagError *err) {
  double t = a + (b - a) / 2;
  CagVec3 d[2] = {{0, 0, 0}};
  for (int i = 0; i < 100; i++) {
    CagStatus status = cag_curve_eval(s->c, t, 1, CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    double f = height(s, d[0]), slope = cag_dot(d[1], s->plane->normal);
    if (f == 0) break;
    if ((f > 0) == (fa > 0)) a = t;
    else b = t;
    double next = t - f / slope;
    if (!(next > a && next < b)) next = a + (b - a) / 2;
    if (fabs(next - t) <= DBL_EPSILON * fmax(fabs(t), s->c->end - s->c->start)) break;
    t = next;
  }
  return add(&s->found, t, 0, d[0], err);
}

// A part that is straight up to rounding: a tangency if its middle is close enough.
static CagStatus touch(PlaneSearch *s, const Part *part, CagError *err) {
  const double t = part->a + (part->b - part->a) / 2;
  CagVec3 p;
  CagStatus status = cag_curve_point(s->c, t, &p, err);
  if (status) return status;
  return fabs(height(s, p)) <= MEET * s->size + s->noise ? add(&s->found, t, 0, p, err) : CAG_OK;
}

static CagStatus plane_part(PlaneSearch *s, const Part *part, int depth, CagError *err) {
  // Ratio of the slope of the chord to the bound of its change above which there is only one root.
  const double steep = 16;
  const double zero = (ZERO * s->size + s->noise);
  double fa = height(s, part->p), fb = height(s, part->q);
  double sag = cag_curve_sag(s->c, part->a, part->b);
  if (fabs(fa) <= zero) fa = 0;
  if (fabs(fb) <= zero) fb = 0;
  if (fa * fb > 0 && fmin(fabs(fa), fabs(fb)) > sag) return CAG_OK;
  if (fabs(fb - fa) > steep * sag) {
    if (fa == 0) return add(&s->found, part->a, 0, part->p, err);
    if (fb == 0) return add(&s->found, part->b, 0, part->q, err);
    return fa * fb > 0 ? CAG_OK : solve(s, part->a, part->b, fa, err);
  }
  const bool wide = part->b - part->a > OVERLAP * (s->c->end - s->c->start);
  if (wide && fa == 0 && fb == 0) {
    // Not simple fractions, at which a periodic curve might be close again.
    static const double fractions[] = {0.236, 0.382, 0.618, 0.854};
    bool lies = true;
    for (size_t i = 0; lies && i < sizeof fractions / sizeof *fractions; i++) {
      CagVec3 p;
      CagStatus status =
          cag_curve_point(s->c, part->a + (part->b - part->a) * fractions[i], &p, err);
      if (status) return status;
      lies = fabs(height(s, p)) <= zero;
    }
    if (lies) return fail_overlap(err);
  }
  if (sag <= (CHORD * s->size + s->noise) || depth == 0) return touch(s, part, err);
  Part half[2];
  CagStatus status = halves(s->c, part, half, err);
  for (int i = 0; !status && i < 2; i++) status = plane_part(s, &half[i], depth - 1, err);
  return status;
}

static CagStatus measure_height(void *context, double t, double at[2], double *gap, double *sine,
                                CagError *err) {
  const PlaneSearch *s = context;
  CagVec3 d[2];
  (void)at;
  CagStatus status =
      cag_curve_eval(s->c, t, 1, t >= s->c->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  *gap = fabs(height(s, d[0]));
  *sine = fabs(cag_dot(cag_unit(d[1]), s->plane->normal));
  return CAG_OK;
}

CagStatus cag_curve_intersect_plane(const CagCurve *c, const CagPlane *plane, CagMeeting **out,
                                    size_t *n, CagError *err) {
  PlaneSearch s = {.c = c, .plane = plane};
  s.size = extent_of(c, &s.noise);
  s.found.task = (CagContactTask){.c = c,
                                  .context = &s,
                                  .measure = measure_height,
                                  .same = MEET * s.size + s.noise,
                                  .size = s.size,
                                  .noise = s.noise};
  Part *parts;
  size_t count;
  CagStatus status = first_parts(c, &parts, &count, err);
  if (status) return status;
  for (size_t i = 0; !status && i < count; i++) status = plane_part(&s, &parts[i], DEPTH, err);
  cag_free(parts);
  return merged_meetings(&s.found, status, out, n, err);
}

// --- Another curve ---

typedef struct CurveSearch {
  const CagCurve *a, *b;
  double size, noise;
  size_t pairs;
  Found found;
} CurveSearch;

// Parameter of the segment's point nearest to x, 0 to 1.
static double nearest_on(const Part *a, CagVec3 x) {
  const CagVec3 d = cag_sub(a->q, a->p);
  const double dd = cag_dot(d, d);
  return dd > 0 ? fmin(1, fmax(0, cag_dot(cag_sub(x, a->p), d) / dd)) : 0;
}

// Steps u and v for which r + u d intersects v e, or is nearest to it. Uses cross products, which
// lose far fewer digits than a determinant of scalar products if d and e are nearly parallel.
static void nearest_steps(CagVec3 r, CagVec3 d, CagVec3 e, double *u, double *v) {
  const CagVec3 n = cag_cross(d, e);
  const double nn = cag_dot(n, n);
  *u = -cag_dot(cag_cross(r, e), n) / nn;
  *v = -cag_dot(cag_cross(r, d), n) / nn;
}

// Nearest points p + u (q - p) and r + v (s - r) of two segments; returns their distance. Also
// tries the nearest point to each end, since the result of the directions is rounding if they are
// nearly parallel.
static double segments(const Part *a, const Part *b, double *u, double *v) {
  const CagVec3 d = cag_sub(a->q, a->p), e = cag_sub(b->q, b->p);
  double x, across;
  nearest_steps(cag_sub(a->p, b->p), d, e, &x, &across);
  x = fmin(1, fmax(0, x)); // parallel: x was NaN
  const double y = nearest_on(b, cag_madd(a->p, x, d));
  const double tried[5][2] = {{nearest_on(a, cag_madd(b->p, y, e)), y},
                              {0, nearest_on(b, a->p)},
                              {1, nearest_on(b, a->q)},
                              {nearest_on(a, b->p), 0},
                              {nearest_on(a, b->q), 1}};
  double least = INFINITY;
  for (int i = 0; i < 5; i++) {
    const double gap =
        cag_norm(cag_sub(cag_madd(a->p, tried[i][0], d), cag_madd(b->p, tried[i][1], e)));
    if (!(gap < least)) continue;
    least = gap;
    *u = tried[i][0];
    *v = tried[i][1];
  }
  return least;
}

static CagSide side_in(const Part *part, double t) {
  return t >= part->high ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
}

// Clamps to the smooth interval of the part, and to its width around the part.
static double step_within(const Part *part, double t) {
  const double reach = part->b - part->a;
  return fmin(fmin(part->high, part->b + reach), fmax(fmax(part->low, part->a - reach), t));
}

static bool lies_in(const Part *part, double t) {
  const double slack = 1e-9 * (part->b - part->a);
  return t >= part->a - slack && t <= part->b + slack;
}

// Gauss-Newton on the distance of the two points, from (t, u); adds an intersection if it converges
// to one. *inside: the intersection is in these parts, not in neighboring ones.
static CagStatus meet(CurveSearch *s, const Part *a, const Part *b, double t, double u, bool *met,
                      bool *inside, CagError *err) {
  CagVec3 p[2], q[2];
  double best = INFINITY, best_t = t, best_u = u;
  CagVec3 point = {0, 0, 0};
  for (int i = 0; i < 60; i++) {
    CagStatus status = cag_curve_eval(s->a, t, 1, side_in(a, t), p, err);
    if (!status) status = cag_curve_eval(s->b, u, 1, side_in(b, u), q, err);
    if (status) return status;
    CagVec3 r = cag_sub(p[0], q[0]);
    double distance = cag_norm(r);
    if (distance < best) {
      best = distance;
      best_t = t;
      best_u = u;
      point = p[0];
    }
    double pp = cag_dot(p[1], p[1]), qq = cag_dot(q[1], q[1]), dt, du;
    if (cag_norm(cag_cross(p[1], q[1])) > MEET * sqrt(pp * qq)) {
      nearest_steps(r, p[1], q[1], &dt, &du);
    } else { // parallel: separate steps
      dt = pp > 0 ? -cag_dot(r, p[1]) / (2 * pp) : 0;
      du = qq > 0 ? cag_dot(r, q[1]) / (2 * qq) : 0;
    }
    double next_t = step_within(a, t + dt), next_u = step_within(b, u + du);
    if (next_t == t && next_u == u) break;
    t = next_t;
    u = next_u;
  }
  *met = best <= MEET * s->size + s->noise;
  *inside = *met && lies_in(a, best_t) && lies_in(b, best_u);
  return *met ? add(&s->found, best_t, best_u, point, err) : CAG_OK;
}

// The point of the other curve nearest to the first curve's point at t, starting from at[0].
static CagStatus measure_curve(void *context, double t, double at[2], double *gap, double *sine,
                               CagError *err) {
  enum { STEPS = 16 };
  const CurveSearch *s = context;
  const CagCurve *b = s->b;
  const double range = b->end - b->start;
  CagVec3 p[2], q[2];
  CagStatus status =
      cag_curve_eval(s->a, t, 1, t >= s->a->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, p, err);
  for (int i = 0; !status; i++) {
    status = cag_curve_eval(b, at[0], 1, at[0] >= b->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, q, err);
    if (status) break;
    const CagVec3 r = cag_sub(p[0], q[0]);
    const double qq = cag_dot(q[1], q[1]);
    *gap = cag_norm(r);
    *sine = cag_norm(cag_cross(cag_unit(p[1]), cag_unit(q[1])));
    double next = qq > 0 ? at[0] + cag_dot(r, q[1]) / qq : at[0];
    if (b->closed && next < b->start) next += range;
    if (b->closed && next > b->end) next -= range;
    next = fmin(b->end, fmax(b->start, next));
    if (i == STEPS || fabs(next - at[0]) <= DBL_EPSILON * range) break;
    at[0] = next;
  }
  return status;
}

// Whether collinear chords overlap, rather than share at most an end point.
static bool run_along(const CurveSearch *s, const Part *a, const Part *b) {
  CagVec3 d = cag_sub(a->q, a->p);
  double length = cag_norm(d);
  if (length == 0) return false;
  CagVec3 unit = cag_scaled(d, 1 / length);
  double x = cag_dot(cag_sub(b->p, a->p), unit), y = cag_dot(cag_sub(b->q, a->p), unit);
  double common = fmin(length, fmax(x, y)) - fmax(0, fmin(x, y));
  bool parallel = cag_norm(cag_cross(unit, cag_unit(cag_sub(b->q, b->p)))) <= MEET;
  return parallel && common > OVERLAP * fmin(length, fabs(y - x)) && common > OVERLAP * s->size;
}

// Clips the part with the larger sag by the other one, then the other by the remainder. *apart:
// nothing is left; *smaller: enough was removed to process the pair again.
static CagStatus clip(const CurveSearch *s, Part *a, Part *b, bool *apart, bool *smaller,
                      CagError *err) {
  const double enough = 0.7; // fraction of the interval that may be left; if more is left, there
                             // are several intersections
  const double slack = CHORD * s->size + s->noise;
  const Part old_a = *a, old_b = *b;
  *apart = !cag_curve_clip_parameters(s->a, a->a, a->b, s->b, slack, &b->a, &b->b);
  *apart = *apart || !cag_curve_clip_parameters(s->b, b->a, b->b, s->a, slack, &a->a, &a->b);
  *smaller = false;
  if (*apart) return CAG_OK;
  *smaller =
      a->b - a->a <= enough * (old_a.b - old_a.a) || b->b - b->a <= enough * (old_b.b - old_b.a);
  CagStatus status = CAG_OK;
  if (!*smaller) return CAG_OK;
  if (a->a != old_a.a) status = cag_curve_eval(s->a, a->a, 0, CAG_SIDE_RIGHT, &a->p, err);
  if (!status && a->b != old_a.b) status = cag_curve_eval(s->a, a->b, 0, CAG_SIDE_LEFT, &a->q, err);
  if (!status && b->a != old_b.a)
    status = cag_curve_eval(s->b, b->a, 0, CAG_SIDE_RIGHT, &b->p, err);
  if (!status && b->b != old_b.b) status = cag_curve_eval(s->b, b->b, 0, CAG_SIDE_LEFT, &b->q, err);
  return status;
}

static CagStatus pair(CurveSearch *s, const Part *a, const Part *b, int depth, CagError *err) {
  // A tangent deviates from the chord's direction by about 4 sag / length. Curves whose chords
  // cross at an angle a few times larger than that intersect at most once.
  const double bend = 16;
  double u = 0, v = 0;
  double sag_a = cag_curve_sag(s->a, a->a, a->b), sag_b = cag_curve_sag(s->b, b->a, b->b);
  if (segments(a, b, &u, &v) > sag_a + sag_b + (ZERO * s->size + s->noise)) return CAG_OK;
  if (++s->pairs > MOST_PAIRS) return fail_overlap(err);
  if (cag_stop_check(err)) return err->status;
  CagVec3 d = cag_sub(a->q, a->p), e = cag_sub(b->q, b->p);
  double da = cag_norm(d), db = cag_norm(e), sine = 0;
  bool met = false, inside;
  double t = a->a + u * (a->b - a->a), w = b->a + v * (b->b - b->a);
  if (da > 0 && db > 0) {
    sine = cag_norm(cag_cross(d, e)) / (da * db);
    if (sine > bend * (sag_a / da + sag_b / db) && sine > MEET) {
      CagStatus status = meet(s, a, b, t, w, &met, &inside, err);
      if (status || inside) return status;
    }
  }
  const double small = CHORD * s->size + s->noise;
  if ((sag_a <= small && sag_b <= small) || depth == 0) {
    if (run_along(s, a, b)) return fail_overlap(err);
    CagStatus status = meet(s, a, b, t, w, &met, &inside, err);
    // The chords get closer than their sag allows for curves that do not meet, but Newton's method
    // failed: the parametrization is too uneven.
    const bool uneven = !met && sine > MEET && fmax(da, db) > MEET * s->size;
    if (status || depth == 0 || !uneven) return status;
  }
  Part half[2];
  const bool bent = sag_a > small || sag_b > small, first = bent ? sag_a > sag_b : da > db;
  bool apart, smaller;
  half[0] = *a;
  half[1] = *b;
  CagStatus status = clip(s, &half[0], &half[1], &apart, &smaller, err);
  if (status || apart) return status;
  if (smaller) return pair(s, &half[0], &half[1], depth - 1, err);
  status = first ? halves(s->a, a, half, err) : halves(s->b, b, half, err);
  for (int i = 0; !status && i < 2; i++)
    status = first ? pair(s, &half[i], b, depth - 1, err) : pair(s, a, &half[i], depth - 1, err);
  return status;
}

CagStatus cag_curve_intersect(const CagCurve *a, const CagCurve *b, CagMeeting **out, size_t *n,
                              CagError *err) {
  CurveSearch s = {.a = a, .b = b};
  const double size_a = extent_of(a, &s.noise), size_b = extent_of(b, &s.noise);
  s.size = fmax(size_a, size_b);
  s.found.task = (CagContactTask){.c = a,
                                  .context = &s,
                                  .measure = measure_curve,
                                  .places = 1,
                                  .low = {b->start},
                                  .high = {b->end},
                                  .closed = {b->closed},
                                  .same = MEET * s.size + s.noise,
                                  .size = s.size,
                                  .noise = s.noise};
  CagContact places[2];
  size_t count;
  bool decided;
  CagStatus status = cag_circles_intersect(a, b, s.found.task.same, places, &count, &decided, err);
  if (status) return status;
  if (decided) return give_contacts(places, count, out, n, err);
  Part *parts_a, *parts_b;
  size_t count_a, count_b;
  status = first_parts(a, &parts_a, &count_a, err);
  if (status) return status;
  status = first_parts(b, &parts_b, &count_b, err);
  if (status) {
    cag_free(parts_a);
    return status;
  }
  for (size_t i = 0; !status && i < count_a; i++) {
    status = cag_stop_check(err);
    for (size_t k = 0; !status && k < count_b; k++)
      status = pair(&s, &parts_a[i], &parts_b[k], 2 * DEPTH, err);
  }
  cag_free(parts_a);
  cag_free(parts_b);
  return merged_meetings(&s.found, status, out, n, err);
}
