// Curves as runs of segments and bent curves, and the reduction of runs.

#include "geom/curve/runs.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"

// --- Runs of a curve ---

void cag_runs_free(CagRuns *runs) {
  for (size_t i = 0; i < runs->n; i++) {
    cag_curve_release(runs->items[i].bent);
    cag_free(runs->items[i].vertices);
    cag_free(runs->items[i].kept);
  }
  cag_free(runs->items);
  *runs = (CagRuns){0};
}

static CagStatus new_run(CagRuns *runs, CagRun **out, CagError *err) {
  if (!CAG_RESERVE(runs->items, runs->capacity, runs->n + 1)) return cag_fail_memory(err);
  *out = &runs->items[runs->n++];
  **out = (CagRun){0};
  return CAG_OK;
}

static CagStatus add_vertex(CagRun *run, CagVec3 p, CagError *err) {
  if (!CAG_RESERVE(run->vertices, run->capacity, run->n + 1)) return cag_fail_memory(err);
  run->vertices[run->n++] = p;
  return CAG_OK;
}

// The curve over [a, b] between two cuts: the segment, or the bent piece, which may begin before.
static CagStatus add_interval(CagRuns *runs, const CagCurve *c, double a, double b,
                              const CagCurve **last, CagError *err) {
  double local_a, local_b, rate;
  const CagVec3 *vertices;
  size_t n;
  bool closed;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &local_a, &local_b, &rate);
  if (!piece) piece = c;
  CagRun *run = runs->n ? &runs->items[runs->n - 1] : NULL;
  CagStatus status = CAG_OK;
  if (!cag_curve_vertices(piece, &vertices, &n, &closed)) {
    if (piece == *last && local_a != piece->start) return CAG_OK;
    *last = piece;
    status = new_run(runs, &run, err);
    if (!status) run->bent = cag_curve_retain(piece);
    return status;
  }
  *last = NULL;
  CagVec3 p;
  if (!run || run->bent) {
    status = new_run(runs, &run, err);
    if (!status) status = cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &p, err);
    if (!status) status = add_vertex(run, p, err);
  }
  if (!status) status = cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &p, err);
  return status ? status : add_vertex(run, p, err);
}

static size_t farthest(const CagVec3 *v, size_t n, CagVec3 from) {
  size_t best = 0;
  double most = -1;
  for (size_t i = 0; i < n; i++) {
    const double d = cag_norm(cag_sub(v[i], from));
    if (d > most) best = i;
    most = fmax(most, d);
  }
  return best;
}

// Rotates a ring so that it starts at the vertex farthest from its first one.
static CagStatus turn_ring(CagRun *run, CagError *err) {
  const size_t n = run->n - 1, first = farthest(run->vertices, n, run->vertices[0]);
  CagVec3 *turned = cag_malloc(sizeof *turned * run->n);
  if (!turned) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) turned[i] = run->vertices[(first + i) % n];
  turned[n] = turned[0];
  cag_free(run->vertices);
  run->vertices = turned;
  run->capacity = run->n;
  return CAG_OK;
}

CagStatus cag_runs_of(const CagCurve *c, CagRuns *out, CagError *err) {
  double *cuts;
  size_t n;
  const CagCurve *last = NULL;
  *out = (CagRuns){0};
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  for (size_t i = 0; !status && i + 1 < n; i++)
    status = add_interval(out, c, cuts[i], cuts[i + 1], &last, err);
  cag_free(cuts);
  out->ring = !status && c->closed && out->n == 1 && !out->items[0].bent;
  if (out->ring) status = turn_ring(&out->items[0], err);
  for (size_t i = 0; !status && i < out->n; i++) {
    CagRun *run = &out->items[i];
    if (run->bent) continue;
    run->kept = cag_malloc(sizeof *run->kept * run->n);
    if (run->kept) memset(run->kept, true, sizeof *run->kept * run->n);
    else status = cag_fail_memory(err);
  }
  if (status) cag_runs_free(out);
  return status;
}

// --- Back to a curve ---

static CagStatus run_curve(const CagRun *run, bool ring, int dimension, CagCurve **out,
                           CagError *err) {
  if (run->bent) {
    *out = cag_curve_retain(run->bent);
    return CAG_OK;
  }
  CagVec3 *v = cag_malloc(sizeof *v * run->n);
  if (!v) return cag_fail_memory(err);
  size_t n = 0;
  for (size_t i = 0; i + ring < run->n; i++)
    if (run->kept[i]) v[n++] = run->vertices[i];
  const CagStatus status = n == 2 && !ring ? cag_curve_line(v[0], v[1], dimension, out, err)
                                           : cag_curve_polyline(v, n, ring, dimension, out, err);
  cag_free(v);
  return status;
}

static bool keeps_all(const CagRuns *runs) {
  for (size_t i = 0; i < runs->n; i++)
    for (size_t k = 0; k < runs->items[i].n; k++)
      if (!runs->items[i].kept[k]) return false;
  return true;
}

CagStatus cag_runs_curve(const CagRuns *runs, const CagCurve *c, CagCurve **out, CagError *err) {
  if (keeps_all(runs)) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  if (runs->n == 1) return run_curve(&runs->items[0], runs->ring, c->dimension, out, err);
  CagCurve **parts = cag_calloc(runs->n, sizeof *parts);
  if (!parts) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < runs->n; i++)
    status = run_curve(&runs->items[i], false, c->dimension, &parts[i], err);
  if (!status) status = cag_curve_join(parts, runs->n, out, err);
  for (size_t i = 0; i < runs->n; i++) cag_curve_release(parts[i]);
  cag_free(parts);
  return status;
}

// --- Reduction ---

static double distance_to_segment(CagVec3 p, CagVec3 q, CagVec3 from) {
  const CagVec3 d = cag_sub(q, p), r = cag_sub(from, p);
  const double dd = cag_dot(d, d), t = dd > 0 ? fmin(1, fmax(0, cag_dot(r, d) / dd)) : 0;
  return cag_norm(cag_sub(r, cag_scaled(d, t)));
}

// The vertex between i and k that is farthest from the segment between these.
static size_t farthest_between(const CagRun *run, size_t i, size_t k, double *distance) {
  const CagVec3 *v = run->vertices;
  size_t best = i + 1;
  *distance = -1;
  for (size_t m = i + 1; m < k; m++) {
    const double d = distance_to_segment(v[i], v[k], v[m]);
    if (d > *distance) best = m;
    *distance = fmax(*distance, d);
  }
  return best;
}

typedef struct Stretch {
  size_t from, to;
} Stretch;

static CagStatus reduce_between(CagRun *run, size_t first, size_t last, double tolerance,
                                const CagRunCheck *check, CagError *err) {
  Stretch *stack = cag_malloc(sizeof *stack * (last - first + 1)); // disjoint stretches
  size_t n = 0;
  if (!stack) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  stack[n++] = (Stretch){first, last};
  while (!status && n > 0) {
    const Stretch s = stack[--n];
    if (s.to - s.from < 2) continue;
    double distance;
    const size_t middle = farthest_between(run, s.from, s.to, &distance);
    bool drop = distance <= tolerance;
    status = cag_stop_check(err);
    if (!status && drop && check)
      status = check->allows(check->context, run, s.from, s.to, &drop, err);
    if (status) break;
    if (drop) {
      memset(run->kept + s.from + 1, false, sizeof *run->kept * (s.to - s.from - 1));
    } else {
      stack[n++] = (Stretch){middle, s.to};
      stack[n++] = (Stretch){s.from, middle};
    }
  }
  cag_free(stack);
  return status;
}

// Drops the vertex in which the halves of a ring meet, if those next to it may be connected.
static CagStatus drop_meeting(CagRun *run, size_t far, double tolerance, const CagRunCheck *check,
                              CagError *err) {
  size_t from = far - 1, to = far + 1;
  double distance;
  while (!run->kept[from]) from--;
  while (!run->kept[to]) to++;
  farthest_between(run, from, to, &distance);
  bool drop = distance <= tolerance;
  CagStatus status = CAG_OK;
  if (drop && check) status = check->allows(check->context, run, from, to, &drop, err);
  if (!status && drop) run->kept[far] = false;
  return status;
}

CagStatus cag_run_reduce(CagRun *run, bool ring, double tolerance, const CagRunCheck *check,
                         CagError *err) {
  const size_t last = run->n - 1;
  if (!ring) return reduce_between(run, 0, last, tolerance, check, err);
  // The two halves of a ring meet in its first vertex and the one farthest from it.
  const size_t far = farthest(run->vertices, last, run->vertices[0]);
  CagStatus status = reduce_between(run, 0, far, tolerance, check, err);
  if (!status) status = reduce_between(run, far, last, tolerance, check, err);
  size_t kept = 0;
  for (size_t i = 0; i < last; i++) kept += run->kept[i];
  if (status) return status;
  if (kept > 3) return drop_meeting(run, far, tolerance, check, err);
  if (kept == 3) return CAG_OK;
  double first_off, second_off;
  const size_t a = farthest_between(run, 0, far, &first_off),
               b = farthest_between(run, far, last, &second_off);
  run->kept[first_off > second_off ? a : b] = true;
  return CAG_OK;
}
