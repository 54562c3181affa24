// Growing lists of curves: removes duplicates and joins curves end to end.
//
// Curves are joined where two ends meet. If more than two ends meet, the pair with the smallest
// turn is joined first, then the next pair of the rest, and so on. The result therefore does not
// depend on the order in which the curves were found.

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/meet/section_edges.h"

// Turns, and the directions that decide between equal turns, are compared in steps of this size,
// which is far above the rounding error of a tangent.
#define STEPS_OF_TURN 1e6

void cag_curve_list_free(CagCurveList *list) {
  for (size_t i = 0; i < list->count; i++) cag_curve_release(list->items[i]);
  cag_free(list->items);
  *list = (CagCurveList){0};
}

CagStatus cag_curve_list_add(CagCurveList *list, CagCurve *c, CagError *err) {
  if (!CAG_RESERVE(list->items, list->capacity, list->count + 1)) {
    cag_curve_release(c);
    return cag_fail_memory(err);
  }
  list->items[list->count++] = c;
  return CAG_OK;
}

// --- Duplicates ---

// Tests whether all of c runs along `on`.
static CagStatus runs_along(const CagCurve *c, const CagCurve *on, double near, bool *does,
                            CagError *err) {
  enum { PLACES = 9 };
  *does = false;
  const CagBounds box = on->kind->hull(on, on->start, on->end);
  for (int i = 0; i <= PLACES; i++) {
    CagVec3 p, foot;
    double t, distance;
    CagStatus status = cag_curve_point(c, c->start + (c->end - c->start) * i / PLACES, &p, err);
    if (status) return status;
    if (p.x < box.min.x - near || p.y < box.min.y - near || p.z < box.min.z - near ||
        p.x > box.max.x + near || p.y > box.max.y + near || p.z > box.max.z + near)
      return CAG_OK;
    status = cag_curve_closest(on, p, &t, &foot, &distance, err);
    if (status || distance > near) return status;
  }
  *does = true;
  return CAG_OK;
}

CagStatus cag_curve_list_drop_covered(CagCurveList *list, size_t first, double near,
                                      CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = list->count; i-- > first;) {
    bool covered = false;
    for (size_t k = first; k < list->count && !status && !covered; k++)
      if (k != i) status = runs_along(list->items[i], list->items[k], near, &covered, err);
    if (!covered) continue;
    cag_curve_release(list->items[i]);
    list->count--;
    memmove(list->items + i, list->items + i + 1, (list->count - i) * sizeof *list->items);
  }
  return status;
}

// --- Pairs of ends ---

// An end of an open curve. `way` is the unit direction into the curve.
typedef struct End {
  CagVec3 at, way;
  size_t curve, mate;
  bool last, met;
} End;

typedef struct Pair {
  size_t a, b;
  double turn, sum[3]; // in steps
} Pair;

typedef struct Joints {
  End *ends; // two of each curve: number 2 i is the start of curve first + i
  Pair *pairs;
  size_t end_count, pair_count, pair_capacity;
} Joints;

static End end_of(const CagCurve *c, size_t curve, bool last) {
  const double t = last ? c->end : c->start;
  CagVec3 d[2];
  CagError ignored;
  End out = {.curve = curve, .last = last};
  if (!cag_curve_eval(c, t, 1, last ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &ignored)) {
    out.at = d[0];
    out.way = cag_scaled(cag_unit(d[1]), last ? -1 : 1);
  } else out.met = cag_curve_point(c, t, &out.at, &ignored); // an end without a point meets nothing
  return out;
}

static bool add_pair(Joints *j, size_t a, size_t b) {
  if (!CAG_RESERVE(j->pairs, j->pair_capacity, j->pair_count + 1)) return false;
  const CagVec3 sum = cag_add(j->ends[a].way, j->ends[b].way);
  j->pairs[j->pair_count++] =
      (Pair){.a = a,
             .b = b,
             .turn = round(STEPS_OF_TURN * cag_dot(j->ends[a].way, j->ends[b].way)),
             .sum = {round(STEPS_OF_TURN * sum.x), round(STEPS_OF_TURN * sum.y),
                     round(STEPS_OF_TURN * sum.z)}};
  return true;
}

static int by_turn(const void *a, const void *b) {
  const Pair *x = a, *y = b;
  if (x->turn != y->turn) return x->turn > y->turn ? 1 : -1;
  for (int k = 0; k < 3; k++)
    if (x->sum[k] != y->sum[k]) return x->sum[k] > y->sum[k] ? 1 : -1;
  if (x->a != y->a) return x->a > y->a ? 1 : -1;
  return (x->b > y->b) - (x->b < y->b);
}

static void joints_free(Joints *j) {
  cag_free(j->ends);
  cag_free(j->pairs);
}

// Curves that are closed, or whose own ends meet, are not joined.
static bool find_ends(const CagCurveList *list, size_t first, double same, Joints *j) {
  const size_t n = list->count - first;
  j->end_count = 2 * n;
  j->ends = cag_malloc((2 * n + 1) * sizeof *j->ends);
  if (!j->ends) return false;
  for (size_t i = 0; i < n; i++) {
    const CagCurve *c = list->items[first + i];
    End *e = j->ends + 2 * i;
    for (int k = 0; k < 2; k++) e[k] = end_of(c, i, k == 1);
    if (c->closed || cag_norm(cag_sub(e[0].at, e[1].at)) <= same) e[0].met = e[1].met = true;
  }
  for (size_t a = 0; a < 2 * n; a++)
    for (size_t b = a + 1; b < 2 * n && !j->ends[a].met; b++)
      if (!j->ends[b].met && cag_norm(cag_sub(j->ends[a].at, j->ends[b].at)) <= same &&
          !add_pair(j, a, b))
        return false;
  return true;
}

static void match_ends(Joints *j) {
  for (size_t i = 0; i < j->end_count; i++) {
    j->ends[i].mate = i; // an end that is its own mate has none
    j->ends[i].met = false;
  }
  if (j->pair_count > 0) qsort(j->pairs, j->pair_count, sizeof *j->pairs, by_turn);
  for (size_t i = 0; i < j->pair_count; i++) {
    End *a = &j->ends[j->pairs[i].a], *b = &j->ends[j->pairs[i].b];
    if (a->met || b->met) continue;
    a->met = b->met = true;
    a->mate = j->pairs[i].b;
    b->mate = j->pairs[i].a;
  }
}

// --- Joining ---

static bool is_line(const CagCurve *c) {
  const CagVec3 *points;
  size_t n;
  bool closed;
  return cag_curve_vertices(c, &points, &n, &closed) && !closed;
}

// Lines and open polylines end to end as one polyline.
static CagStatus join_lines(CagCurve *const *parts, size_t n, bool closed, CagCurve **out,
                            CagError *err) {
  size_t count = 0, capacity = 1;
  const CagVec3 *points;
  size_t m;
  bool ignored;
  for (size_t i = 0; i < n; i++)
    if (cag_curve_vertices(parts[i], &points, &m, &ignored)) capacity += m;
  CagVec3 *all = cag_malloc(capacity * sizeof *all);
  if (!all) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++)
    if (cag_curve_vertices(parts[i], &points, &m, &ignored))
      for (size_t k = i > 0; k < m; k++) all[count++] = points[k];
  CagStatus status = cag_curve_polyline(all, closed ? count - 1 : count, closed, 3, out, err);
  cag_free(all);
  return status;
}

static CagStatus join_parts(CagCurve *const *parts, size_t n, bool closed, CagCurve **out,
                            CagError *err) {
  bool straight = true;
  for (size_t i = 0; i < n; i++) straight = straight && is_line(parts[i]);
  if (straight) return join_lines(parts, n, closed, out, err);
  return cag_curve_join(parts, n, out, err);
}

// Returns the end at which the run through the curve begins. The run starts with this curve in its
// forward direction.
static size_t first_end(const Joints *j, size_t curve) {
  size_t start = 2 * curve;
  while (j->ends[start].mate != start) {
    start = j->ends[start].mate ^ 1;
    if (start == 2 * curve) break; // closed
  }
  return start;
}

// Collects the curves of a run from its first end on, each in the direction of the run. Ownership
// moves from the list to the caller.
static CagStatus take_run(const Joints *j, CagCurveList *list, size_t first, size_t start,
                          CagCurve **parts, size_t *n, CagError *err) {
  CagStatus status = CAG_OK;
  *n = 0;
  for (size_t end = start; !status;) {
    CagCurve **at = &list->items[first + end / 2];
    if (end % 2 == 0) parts[*n] = *at;
    else {
      status = cag_curve_reverse(*at, &parts[*n], err);
      if (status) break;
      cag_curve_release(*at);
    }
    *at = NULL;
    (*n)++;
    const size_t next = j->ends[end ^ 1].mate;
    if (next == (end ^ 1) || next == start) break;
    end = next;
  }
  return status;
}

// Joins the run through a curve and replaces the curve with the result.
static CagStatus join_run(const Joints *j, CagCurveList *list, size_t first, size_t curve,
                          CagCurve **parts, CagCurveList *out, CagError *err) {
  const size_t start = first_end(j, curve);
  size_t n;
  CagCurve *joined = NULL;
  CagError ignored;
  CagStatus status = take_run(j, list, first, start, parts, &n, err);
  const bool closed = n > 1 && j->ends[start].mate != start;
  // Ends that the joint does not take for one stay apart.
  const bool joins = !status && n > 1 && !join_parts(parts, n, closed, &joined, &ignored);
  for (size_t k = 0; k < n; k++) {
    if (joins) cag_curve_release(parts[k]);
    else if (status) cag_curve_release(parts[k]);
    else status = cag_curve_list_add(out, parts[k], err);
  }
  if (joins) status = cag_curve_list_add(out, joined, err);
  return status;
}

CagStatus cag_curve_list_join(CagCurveList *list, size_t first, double same, CagError *err) {
  const size_t n = list->count - first;
  Joints j = {0};
  CagCurveList out = {0};
  if (n < 2) return CAG_OK;
  CagCurve **parts = cag_malloc(n * sizeof *parts);
  CagStatus status = parts && find_ends(list, first, same, &j) ? CAG_OK : cag_fail_memory(err);
  if (!status) match_ends(&j);
  for (size_t i = 0; !status && i < n; i++)
    if (list->items[first + i]) status = join_run(&j, list, first, i, parts, &out, err);
  // Releases what remains after an error.
  for (size_t i = 0; status && i < n; i++)
    if (list->items[first + i]) cag_curve_release(list->items[first + i]);
  list->count = first;
  for (size_t i = 0; !status && i < out.count; i++)
    list->items[list->count++] = cag_curve_retain(out.items[i]);
  cag_curve_list_free(&out);
  joints_free(&j);
  cag_free(parts);
  return status;
}
