// Simplification of curves and regions.
//
// A region keeps its topology: a segment replaces a stretch of vertices only if it touches no other
// part of the boundary, and if nothing lies between it and the stretch. Bent curves take part in
// these tests as polygons that are far finer than any drawing.

#include "geom/curve/simplify.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/curve/runs.h"

// Chord tolerance of the polygons of bent curves, as a fraction of the size, and angle.
#define FINE 1e-5
#define FINE_ANGLE (M_PI / 18)
// Knots are removed in passes, whose tolerances grow to the whole by this factor.
#define PASSES 5
#define PASS_GROWTH 4

// --- Curves ---

// Removes inner knots in order, each within the tolerance that is left over from the others.
static CagStatus remove_knots(CagCurve **c, double most, double *left, CagError *err) {
  double *cuts = NULL;
  CagNurbsView view;
  if (!cag_curve_nurbs_view(*c, &view)) return CAG_OK;
  size_t n = 0;
  CagStatus status = CAG_OK;
  cuts = cag_malloc(sizeof *cuts * (view.count + 1));
  if (!cuts) return cag_fail_memory(err);
  for (size_t i = (size_t)view.degree + 1; i < view.count; i++)
    if (view.knots[i] > (*c)->start && view.knots[i] < (*c)->end) cuts[n++] = view.knots[i];
  for (size_t i = 0; !status && i < n; i++) {
    CagCurve *fewer;
    CagError ignored;
    double deviation;
    if (cag_curve_remove_knot(*c, cuts[i], 1, fmin(most, *left), &fewer, &deviation, &ignored)) {
      status = cag_stop_check(err);
      continue;
    }
    *left -= deviation;
    cag_curve_release(*c);
    *c = fewer;
  }
  cag_free(cuts);
  return status;
}

static CagStatus simplify_nurbs(const CagCurve *c, double tolerance, CagCurve **out,
                                CagError *err) {
  double left = tolerance, most = tolerance * pow(PASS_GROWTH, 1 - PASSES);
  *out = cag_curve_retain(c);
  CagStatus status = CAG_OK;
  for (int pass = 0; !status && pass < PASSES; pass++, most *= PASS_GROWTH)
    status = remove_knots(out, most, &left, err);
  if (status) cag_curve_release(*out);
  return status;
}

CagStatus cag_curve_simplify(const CagCurve *c, double tolerance, CagCurve **out, CagError *err) {
  CagRuns runs;
  CagNurbsView view;
  if (cag_curve_nurbs_view(c, &view)) return simplify_nurbs(c, tolerance, out, err);
  CagStatus status = cag_runs_of(c, &runs, err);
  if (status) return status;
  for (size_t i = 0; !status && i < runs.n; i++)
    if (!runs.items[i].bent)
      status = cag_run_reduce(&runs.items[i], runs.ring, tolerance, NULL, err);
  if (!status) status = cag_runs_curve(&runs, c, out, err);
  cag_runs_free(&runs);
  return status;
}

// --- The boundary of a region as segments ---

typedef struct Side {
  CagVec3 p, q;
  size_t loop;
  size_t from, to; // the places of the segments that it stands for: from .. to - 1
  bool gone;       // replaced by another one
} Side;

typedef struct Sides {
  Side *items;
  size_t n, capacity;
  size_t first, loop;     // of the run that is reduced: its first segment, and its loop
  const CagVec3 *samples; // a point of each loop, which stays
  size_t loops;
} Sides;

static CagStatus add_side(Sides *s, CagVec3 p, CagVec3 q, size_t loop, CagError *err) {
  if (!CAG_RESERVE(s->items, s->capacity, s->n + 1)) return cag_fail_memory(err);
  s->items[s->n] = (Side){p, q, loop, s->n, s->n + 1, false};
  s->n++;
  return CAG_OK;
}

static CagStatus add_bent(Sides *s, const CagCurve *c, size_t loop, CagError *err) {
  const CagBounds box = c->kind->hull(c, c->start, c->end);
  double *t;
  size_t n;
  CagStatus status =
      cag_curve_discretize(c, FINE * cag_norm(cag_sub(box.max, box.min)), FINE_ANGLE, &t, &n, err);
  if (status) return status;
  CagVec3 p, q;
  status = cag_curve_point(c, t[0], &p, err);
  for (size_t i = 1; !status && i < n; i++) {
    status = cag_curve_point(c, t[i], &q, err);
    if (!status) status = add_side(s, p, q, loop, err);
    p = q;
  }
  cag_free(t);
  return status;
}

static double beside(CagVec3 a, CagVec3 b, CagVec3 p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// The side of the line on which the point lies; 0 if that may be rounding.
static int side_of(CagVec3 a, CagVec3 b, CagVec3 p) {
  const double value = beside(a, b, p), slack = CAG_ROUNDING * (fabs((b.x - a.x) * (p.y - a.y)) +
                                                                fabs((b.y - a.y) * (p.x - a.x)));
  return fabs(value) <= slack ? 0 : value > 0 ? 1 : -1;
}

static bool same(CagVec3 p, CagVec3 q) { return p.x == q.x && p.y == q.y; }

static bool boxes_meet(CagVec3 p, CagVec3 q, const Side *s) {
  return fmax(p.x, q.x) >= fmin(s->p.x, s->q.x) && fmax(s->p.x, s->q.x) >= fmin(p.x, q.x) &&
         fmax(p.y, q.y) >= fmin(s->p.y, s->q.y) && fmax(s->p.y, s->q.y) >= fmin(p.y, q.y);
}

// Whether segments that share the end `at` have more points in common.
static bool fold_over(CagVec3 at, CagVec3 a, CagVec3 b) {
  return side_of(at, a, b) == 0 && cag_dot(cag_sub(a, at), cag_sub(b, at)) > 0;
}

// Whether the segment from p to q touches one that is not next to it.
static bool touches(const Sides *s, CagVec3 p, CagVec3 q, const Side *other) {
  if (!boxes_meet(p, q, other)) return false;
  const bool next = other->loop == s->loop;
  if (next && same(other->q, p)) return fold_over(p, q, other->p) || same(other->p, q);
  if (next && same(other->p, q)) return fold_over(q, p, other->q);
  const int a = side_of(p, q, other->p), b = side_of(p, q, other->q),
            c = side_of(other->p, other->q, p), d = side_of(other->p, other->q, q);
  return a * b <= 0 && c * d <= 0;
}

// Whether the polygon of the vertices i to k of the run contains the point.
static bool encloses(const CagRun *run, size_t i, size_t k, CagVec3 at) {
  bool inside = false;
  for (size_t m = i; m <= k; m++) {
    const CagVec3 p = run->vertices[m], q = run->vertices[m == k ? i : m + 1];
    if ((p.y <= at.y) == (q.y <= at.y)) continue;
    if ((beside(p, q, at) > 0) == (q.y > p.y)) inside = !inside;
  }
  return inside;
}

// Replaces the segments between vertices i and k of the run by one, if that is free.
static CagStatus replace(void *context, const CagRun *run, size_t i, size_t k, bool *out,
                         CagError *err) {
  Sides *s = context;
  const CagVec3 p = run->vertices[i], q = run->vertices[k];
  const size_t from = s->first + i, to = s->first + k;
  *out = !same(p, q);
  for (size_t m = 0; *out && m < s->n; m++) {
    const Side *other = &s->items[m];
    if (other->gone || (other->from >= from && other->to <= to)) continue;
    *out = !touches(s, p, q, other);
    // The rest of the same loop, by the vertex after the stretch.
    if (*out && other->loop == s->loop && same(other->p, q)) *out = !encloses(run, i, k, other->q);
  }
  for (size_t m = 0; *out && m < s->loops; m++)
    *out = m == s->loop || !encloses(run, i, k, s->samples[m]);
  if (!*out) return CAG_OK;
  for (size_t m = 0; m < s->n; m++)
    s->items[m].gone = s->items[m].gone || (s->items[m].from >= from && s->items[m].to <= to);
  CagStatus status = add_side(s, p, q, s->loop, err);
  if (status) return status;
  s->items[s->n - 1].from = from;
  s->items[s->n - 1].to = to;
  return CAG_OK;
}

// --- Regions ---

static CagStatus add_loop(Sides *s, CagRuns *runs, size_t loop, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < runs->n; i++) {
    CagRun *run = &runs->items[i];
    run->first = s->n;
    if (run->bent) status = add_bent(s, run->bent, loop, err);
    for (size_t k = 0; !status && k + 1 < run->n; k++)
      status = add_side(s, run->vertices[k], run->vertices[k + 1], loop, err);
  }
  return status;
}

static CagStatus reduce_loop(Sides *s, CagRuns *runs, size_t loop, double tolerance,
                             CagError *err) {
  const CagRunCheck check = {replace, s};
  CagStatus status = CAG_OK;
  s->loop = loop;
  for (size_t i = 0; !status && i < runs->n; i++) {
    CagRun *run = &runs->items[i];
    s->first = run->first;
    if (!run->bent) status = cag_run_reduce(run, runs->ring, tolerance, &check, err);
  }
  return status;
}

// The first point of a loop, which is always kept.
static CagStatus first_point(const CagRuns *runs, CagVec3 *out, CagError *err) {
  const CagRun *run = &runs->items[0];
  if (run->bent) return cag_curve_point(run->bent, run->bent->start, out, err);
  *out = run->vertices[0];
  return CAG_OK;
}

static CagStatus region_of_runs(const CagRegion *r, const CagRuns *runs, CagRegion **out,
                                CagError *err) {
  CagCurve **loops = cag_calloc(r->count + 1, sizeof *loops);
  if (!loops) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < r->count; i++)
    status = cag_runs_curve(&runs[i], r->loops[i], &loops[i], err);
  if (!status) status = cag_region_take(loops, r->outer, r->count, out, err);
  else
    for (size_t i = 0; i < r->count; i++) cag_curve_release(loops[i]);
  cag_free(loops);
  return status;
}

CagStatus cag_region_simplify(const CagRegion *r, double tolerance, CagRegion **out,
                              CagError *err) {
  CagRuns *runs = cag_calloc(r->count + 1, sizeof *runs);
  CagVec3 *samples = cag_malloc(sizeof *samples * (r->count + 1));
  Sides sides = {.samples = samples, .loops = r->count};
  CagStatus status = runs && samples ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < r->count; i++) {
    status = cag_runs_of(r->loops[i], &runs[i], err);
    if (!status) status = first_point(&runs[i], &samples[i], err);
    if (!status) status = add_loop(&sides, &runs[i], i, err);
  }
  for (size_t i = 0; !status && i < r->count; i++)
    status = reduce_loop(&sides, &runs[i], i, tolerance, err);
  if (!status) status = region_of_runs(r, runs, out, err);
  for (size_t i = 0; runs && i < r->count; i++) cag_runs_free(&runs[i]);
  cag_free(runs);
  cag_free(samples);
  cag_free(sides.items);
  return status;
}
