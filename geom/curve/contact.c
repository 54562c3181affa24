// Merging of contacts: groups, their best point, and its order (see contact.h).

#include "geom/curve/contact.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// Fractions of a domain: of a seam; contacts closer than the second, and closer in space than that
// fraction of the size, are identical; contacts farther apart than the last are always distinct.
#define SEAM CAG_COINCIDENT
#define SAME_PLACE 1e-4
#define SAME_POINT 1e-7
#define LINKED_MOST 0.25
// Contacts of a group that are farther apart than the first fraction of the size are an overlap if
// the curve stays within the second fraction of the object in between.
#define OVERLAP 1e-3
#define COINCIDENT CAG_ROUNDING
// Sine of the angle below which a contact may be a tangency, and below which it is one.
#define SHALLOW 1e-2
#define TANGENTIAL 1e-6
// Maximum order of contact that is reported.
#define ORDER_MOST 6

static int by_t(const void *a, const void *b) {
  const CagContact *x = a, *y = b;
  if (x->t != y->t) return x->t > y->t ? 1 : -1;
  if (x->at[0] != y->at[0]) return x->at[0] > y->at[0] ? 1 : -1;
  return (x->at[1] > y->at[1]) - (x->at[1] < y->at[1]);
}

// Clamps to the domain, or wraps around a closed one.
static double around(double x, double low, double high, bool closed) {
  const double range = high - low;
  if (closed && x < low) x += range;
  if (closed && x > high) x -= range;
  return fmin(high, fmax(low, x));
}

// The shorter way from a to b.
static double shorter_step(double a, double b, double low, double high, bool closed) {
  const double d = b - a, range = high - low;
  if (closed && d > range / 2) return d - range;
  if (closed && d < -range / 2) return d + range;
  return d;
}

static double way_along(const CagCurve *c, double a, double b) {
  return shorter_step(a, b, c->start, c->end, c->closed);
}

static double way_on(const CagContactTask *k, int i, double a, double b) {
  return shorter_step(a, b, k->low[i], k->high[i], k->closed[i]);
}

// Whether two contacts are the same point, found twice.
static bool is_same(const CagContactTask *k, const CagContact *a, const CagContact *b) {
  bool same = fabs(way_along(k->c, a->t, b->t)) <= SAME_PLACE * (k->c->end - k->c->start);
  for (int i = 0; i < k->places; i++)
    same = same && fabs(way_on(k, i, a->at[i], b->at[i])) <= SAME_PLACE * (k->high[i] - k->low[i]);
  return same && cag_norm(cag_sub(a->point, b->point)) <= SAME_POINT * k->size + k->noise;
}

// Whether the curve stays near the object between m and o.
static CagStatus stays_near(const CagContactTask *k, const CagContact *m, const CagContact *o,
                            bool *out, CagError *err) {
  // Not simple fractions, at which a periodic curve might touch again; foot points may be off by
  // the last fraction.
  static const double fractions[] = {0.382, 0.549, 0.819};
  const double beside = 0.3, range = k->c->end - k->c->start, dt = way_along(k->c, m->t, o->t);
  double d[2] = {0, 0};
  *out = false;
  if (fabs(dt) > LINKED_MOST * range) return CAG_OK;
  for (int i = 0; i < k->places; i++) {
    d[i] = way_on(k, i, m->at[i], o->at[i]);
    if (fabs(d[i]) > LINKED_MOST * (k->high[i] - k->low[i])) return CAG_OK;
  }
  for (size_t f = 0; f < sizeof fractions / sizeof *fractions; f++) {
    const double x = fractions[f];
    double at[2] = {0, 0}, from[2] = {0, 0}, gap, sine;
    for (int i = 0; i < k->places; i++)
      from[i] = at[i] = around(m->at[i] + x * d[i], k->low[i], k->high[i], k->closed[i]);
    const double t = around(m->t + x * dt, k->c->start, k->c->end, k->c->closed);
    CagStatus status = k->measure(k->context, t, at, &gap, &sine, err);
    if (status) return status;
    if (!(gap <= k->same)) return CAG_OK;
    for (int i = 0; i < k->places; i++) {
      const double slack = beside * fabs(d[i]) + SEAM * (k->high[i] - k->low[i]);
      if (fabs(way_on(k, i, from[i], at[i])) > slack) return CAG_OK;
    }
  }
  *out = true;
  return CAG_OK;
}

// A group while contacts are added: its first and last contact, and the one at the smallest angle.
typedef struct Group {
  CagContact first, last, best;
  double sine, last_sine;
} Group;

static CagStatus are_linked(const CagContactTask *k, const Group *g, const CagContact *m,
                            double sine, bool *out, CagError *err) {
  *out = is_same(k, &g->last, m);
  if (*out || !(g->last_sine < SHALLOW && sine < SHALLOW)) return CAG_OK;
  return stays_near(k, &g->last, m, out, err);
}

static CagStatus group_all(const CagContactTask *k, const CagContact *items, size_t n,
                           Group *groups, size_t *count, CagError *err) {
  *count = 0;
  for (size_t i = 0; i < n; i++) {
    const CagContact *m = &items[i];
    double place[2] = {m->at[0], m->at[1]}, gap, sine;
    CagStatus status = k->measure(k->context, m->t, place, &gap, &sine, err);
    bool known = false;
    size_t at = *count;
    // The latest groups are the most likely.
    while (!status && !known && at > 0) {
      status = are_linked(k, &groups[at - 1], m, sine, &known, err);
      at--;
    }
    if (status) return status;
    if (!known) groups[at = (*count)++] = (Group){*m, *m, *m, sine, sine};
    Group *g = &groups[at];
    g->last = *m;
    g->last_sine = sine;
    if (sine < g->sine) {
      g->best = *m;
      g->sine = sine;
    }
  }
  return CAG_OK;
}

// Across a seam the last groups may continue in the first.
static CagStatus close_groups(const CagContactTask *k, Group *groups, size_t *count,
                              CagError *err) {
  if (!k->c->closed) return CAG_OK;
  for (size_t i = 0; i < *count; i++)
    for (size_t j = i + 1; j < *count; j++) {
      bool linked;
      CagStatus status = are_linked(k, &groups[j], &groups[i].first, groups[i].sine, &linked, err);
      if (status) return status;
      if (!linked) continue;
      Group *g = &groups[i];
      g->first = groups[j].first;
      if (groups[j].sine < g->sine) {
        g->best = groups[j].best;
        g->sine = groups[j].sine;
      }
      groups[j--] = groups[--*count];
    }
  return CAG_OK;
}

static CagStatus is_overlap(const CagContactTask *k, const Group *g, bool *out, CagError *err) {
  enum { LOOKS = 16 };
  const double dt = way_along(k->c, g->first.t, g->last.t);
  double at[2] = {g->first.at[0], g->first.at[1]};
  *out = false;
  if (cag_norm(cag_sub(g->last.point, g->first.point)) <= OVERLAP * k->size) return CAG_OK;
  for (int i = 1; i < LOOKS; i++) {
    const double t = around(g->first.t + dt * i / LOOKS, k->c->start, k->c->end, k->c->closed);
    double gap, sine;
    CagStatus status = k->measure(k->context, t, at, &gap, &sine, err);
    if (status) return status;
    if (!(gap <= COINCIDENT * k->size + k->noise)) return CAG_OK;
  }
  *out = true;
  return CAG_OK;
}

// --- The point of tangency ---

// The smooth interval around t, which continues across a smooth seam.
static CagStatus stretch_about(const CagCurve *c, double t, double *low, double *high,
                               CagError *err) {
  double *cuts;
  size_t n;
  CagVec3 d[2], e[2];
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  size_t i = 0;
  while (i + 2 < n && cuts[i + 1] <= t) i++;
  *low = cuts[i];
  *high = cuts[i + 1];
  const double first = cuts[1] - cuts[0], last = cuts[n - 1] - cuts[n - 2];
  cag_free(cuts);
  if (!c->closed) return CAG_OK;
  status = cag_curve_eval(c, c->start, 1, CAG_SIDE_RIGHT, d, err);
  if (!status) status = cag_curve_eval(c, c->end, 1, CAG_SIDE_LEFT, e, err);
  const bool smooth = !status && cag_norm(cag_sub(cag_unit(d[1]), cag_unit(e[1]))) <= SEAM;
  if (smooth && *low <= c->start) *low -= last / 2;
  if (smooth && *high >= c->end) *high += first / 2;
  return status;
}

static CagStatus measure_at(const CagContactTask *k, double t, double at[2], double *gap,
                            double *sine, CagError *err) {
  return k->measure(k->context, around(t, k->c->start, k->c->end, k->c->closed), at, gap, sine,
                    err);
}

// The minimum of the angle between low and high, by golden section: the angle reaches 0 in a
// corner, so the result is as accurate as the angle.
static CagStatus flattest(const CagContactTask *k, double low, double high, double at[2], double *t,
                          double *gap, double *sine, CagError *err) {
  enum { ROUNDS = 80 };
  const double golden = 0.6180339887498949;
  double x = high - golden * (high - low), y = low + golden * (high - low), fx, fy, ignored;
  CagStatus status = measure_at(k, x, at, &ignored, &fx, err);
  if (!status) status = measure_at(k, y, at, &ignored, &fy, err);
  for (int i = 0; !status && i < ROUNDS && low < x && x < y && y < high; i++) {
    if (fx < fy) {
      high = y;
      y = x;
      fy = fx;
      x = high - golden * (high - low);
      status = measure_at(k, x, at, &ignored, &fx, err);
    } else {
      low = x;
      x = y;
      fx = fy;
      y = low + golden * (high - low);
      status = measure_at(k, y, at, &ignored, &fy, err);
    }
  }
  *t = low + (high - low) / 2;
  return status ? status : measure_at(k, *t, at, gap, sine, err);
}

// The order of contact at t, from the growth of the distance.
static CagStatus order_at(const CagContactTask *k, double t, const double place[2], double low,
                          double high, int *out, CagError *err) {
  const double first = 1e-4, enough = 64;
  const double range = k->c->end - k->c->start;
  double sum = 0;
  int sides = 0;
  for (int side = -1; side <= 1; side += 2) {
    const double room = side < 0 ? t - low : high - t;
    for (double d = first * range; 2 * d <= room; d *= 2) {
      double at[2] = {place[0], place[1]}, near, far, sine;
      CagStatus status = measure_at(k, t + side * d, at, &near, &sine, err);
      if (!status) status = measure_at(k, t + side * 2 * d, at, &far, &sine, err);
      if (status) return status;
      if (!(near > enough * (COINCIDENT * k->size + k->noise))) continue;
      sum += log2(far / near);
      sides++;
      break;
    }
  }
  *out = sides ? (int)fmin(ORDER_MOST, fmax(2, round(sum / sides))) : 2;
  return CAG_OK;
}

// The contact of a group.
static CagStatus contact_of_group(const CagContactTask *k, const Group *g, CagContact *out,
                                  CagError *err) {
  const double least = 1e-4, range = k->c->end - k->c->start;
  double low, high, at[2] = {g->best.at[0], g->best.at[1]}, t, gap, sine;
  *out = g->best;
  out->multiplicity = 1;
  if (!(g->sine < SHALLOW)) return CAG_OK;
  CagStatus status = stretch_about(k->c, g->best.t, &low, &high, err);
  if (status) return status;
  const double back = way_along(k->c, g->first.t, g->best.t),
               on = way_along(k->c, g->best.t, g->last.t);
  const double pad = fmax(fabs(back) + fabs(on), least * range);
  status = flattest(k, fmax(low, g->best.t - fabs(back) - pad),
                    fmin(high, g->best.t + fabs(on) + pad), at, &t, &gap, &sine, err);
  if (status || !(gap <= k->same) || sine > TANGENTIAL) return status;
  out->t = around(t, k->c->start, k->c->end, k->c->closed);
  for (int i = 0; i < k->places; i++) out->at[i] = at[i];
  status = order_at(k, t, at, low, high, &out->multiplicity, err);
  return status ? status : cag_curve_point(k->c, out->t, &out->point, err);
}

// A contact at a seam is reported at its start.
static void open_seams(const CagContactTask *k, CagContact *m) {
  const CagCurve *c = k->c;
  if (c->closed && c->end - m->t <= SEAM * (c->end - c->start)) m->t = c->start;
  for (int i = 0; i < k->places; i++)
    if (k->closed[i] && k->high[i] - m->at[i] <= SEAM * (k->high[i] - k->low[i]))
      m->at[i] = k->low[i];
}

CagStatus cag_contacts_merge(const CagContactTask *k, CagContact *items, size_t *n, bool *overlap,
                             CagError *err) {
  *overlap = false;
  if (*n == 0) return CAG_OK;
  size_t count = 0, kept = 0;
  Group *groups = cag_malloc(*n * sizeof *groups);
  if (!groups) return cag_fail_memory(err);
  for (size_t i = 0; i < *n; i++) open_seams(k, &items[i]);
  qsort(items, *n, sizeof *items, by_t);
  CagStatus status = group_all(k, items, *n, groups, &count, err);
  if (!status) status = close_groups(k, groups, &count, err);
  for (size_t i = 0; !status && i < count && !*overlap; i++)
    status = is_overlap(k, &groups[i], overlap, err);
  for (size_t i = 0; !status && i < count && !*overlap; i++) {
    CagContact found;
    status = contact_of_group(k, &groups[i], &found, err);
    if (status) break;
    open_seams(k, &found);
    // Merges two groups that converged to the same point.
    bool known = false;
    for (size_t j = 0; j < kept && !known; j++) known = is_same(k, &items[j], &found);
    if (!known) items[kept++] = found;
  }
  cag_free(groups);
  if (status || *overlap) return status;
  qsort(items, kept, sizeof *items, by_t);
  *n = kept;
  return CAG_OK;
}
