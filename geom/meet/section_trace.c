// Traces the zero curves of a function on a surface in the parameter plane.
//
// The crossings of a grid (section_grid.h) are linked cell by cell. Points are added between two
// crossings until Hermite cubics are within the tolerance; points that coincide in space are
// dropped.
//
// Functions that jump at breaks are traced patch by patch; runs that continue smoothly from patch
// to patch are joined.

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/meet/section_grid.h"
#include "geom/meet/section_join.h"
#include "geom/surface/crease.h"
#include "geom/surface/family.h"
#include "geom/surface/trimmed.h"

// Number of cells along a whole direction, and minimum number on a patch.
#define CELLS 40
#define CELLS_OF_PATCH 4
#define CELLS_OF_SIDED_PATCH 10
// Maximum depth of halvings between two crossings, and maximum number of branch points searched
// there, each of which may be followed by half as many halvings.
#define DEPTH_MOST 12
#define BRANCHINGS_MOST 4
// A run that crosses fewer edges than this is halved this often for any error, so that there are
// enough points to recognize its kind.
#define SHORT_RUN 4
#define SHORT_RUN_DEPTH 2
// cos 30 degrees: maximum turn of the tangent between points.
#define TURN_COSINE 0.866
// Points closer than this fraction of the size coincide.
#define SAME 1e-10
// A run up to this fraction of the size next to an area where the function is 0 is a rounding
// artifact.
#define BESIDE_LOST 1e-3
// A function of at most this many rounding errors is 0 throughout.
#define CONSTANT_ROUNDINGS 100
// A point closer to one of two others than this fraction of their distance coincides with it.
#define SLID 1e-5
// A point between two others measures the cubic's middle only if it is at least this fraction of
// the way from both: at a pole the midpoint of the parameters may not be.
#define LOPSIDED 0.2
#define NEWTON_ROUNDS 12

// --- Functions ---

static double plane_value(const CagLevel *l, const CagVec3 *d, int n, double *gradient) {
  if (gradient) {
    gradient[0] = cag_dot(l->direction, d[cag_partial(n, 1, 0)]);
    gradient[1] = cag_dot(l->direction, d[cag_partial(n, 0, 1)]);
  }
  return cag_dot(l->direction, cag_sub(d[0], l->point));
}

CagLevel cag_level_plane(const CagPlane *plane, double size) {
  const double rounding = 1e-13;
  CagLevel l = {.order = 1,
                .value = plane_value,
                .point = plane->point,
                .direction = plane->normal,
                .zero = rounding * size};
  return l;
}

static double contour_value(const CagLevel *l, const CagVec3 *d, int n, double *gradient) {
  CagVec3 su = d[cag_partial(n, 1, 0)], sv = d[cag_partial(n, 0, 1)], normal = cag_cross(su, sv);
  CagVec3 sight = l->central ? cag_sub(d[0], l->point) : l->direction;
  if (gradient) {
    // The line of sight changes within the tangent plane, so only the change of the normal matters.
    CagVec3 suu = d[cag_partial(n, 2, 0)], suv = d[cag_partial(n, 1, 1)],
            svv = d[cag_partial(n, 0, 2)];
    gradient[0] = cag_dot(cag_add(cag_cross(suu, sv), cag_cross(su, suv)), sight);
    gradient[1] = cag_dot(cag_add(cag_cross(suv, sv), cag_cross(su, svv)), sight);
  }
  return cag_dot(normal, sight);
}

CagLevel cag_level_contour(CagVec3 direction, CagVec3 point, bool central) {
  CagLevel l = {.order = 2,
                .value = contour_value,
                .point = point,
                .direction = direction,
                .central = central};
  return l;
}

// --- Refinement ---

static bool add_node(CagTracer *t, const CagTraceNode *node) {
  if (!CAG_RESERVE(t->run, t->run_capacity, t->run_count + 1)) return false;
  t->run[t->run_count++] = *node;
  return true;
}

static bool add_check(CagTracer *t, CagVec3 p) {
  if (!CAG_RESERVE(t->checks, t->check_capacity, t->check_count + 1)) return false;
  t->checks[t->check_count++] = p;
  return true;
}

static double clamped(double x, double lo, double hi) { return fmin(fmax(x, lo), hi); }

// The point of the curve near the middle of two others; false if Newton's method does not converge
// to it.
static bool middle_by_newton(CagTracer *t, const CagTraceNode *a, const CagTraceNode *b,
                             CagTraceNode *out) {
  const double *lo = t->patch.lo, *hi = t->patch.hi;
  double lu = hi[0] - lo[0], lv = hi[1] - lo[1];
  double u = (a->u + b->u) / 2, v = (a->v + b->v) / 2;
  double reach = hypot((b->u - a->u) / lu, (b->v - a->v) / lv);
  *out = (CagTraceNode){.u = u, .v = v};
  for (int round = 0; round < NEWTON_ROUNDS; round++) {
    double g[2], f = cag_tracer_inspect(t, out, g);
    if (t->status) return false;
    double x = g[0] * lu, y = g[1] * lv, square = x * x + y * y;
    if (fabs(f) <= cag_tracer_zero(t, out->u, out->v)) return true;
    if (!(square > 0)) return false;
    double du = lu * f * x / square, dv = lv * f * y / square;
    out->u = clamped(out->u - du, lo[0], hi[0]);
    out->v = clamped(out->v - dv, lo[1], hi[1]);
    if (hypot((out->u - u) / lu, (out->v - v) / lv) > reach) return false;
    if (hypot(du / lu, dv / lv) <= 4 * DBL_EPSILON) {
      cag_tracer_inspect(t, out, g);
      return true;
    }
  }
  return false;
}

// The same if that fails, as at a pole, where the curve may turn sharply in the parameters: the
// crossing nearest to the middle on the line perpendicular to the segment from a to b.
static bool middle_across(CagTracer *t, const CagTraceNode *a, const CagTraceNode *b,
                          CagTraceNode *out) {
  const int places = 16;
  const double *lo = t->patch.lo, *hi = t->patch.hi;
  double lu = hi[0] - lo[0], lv = hi[1] - lo[1], u = (a->u + b->u) / 2, v = (a->v + b->v) / 2;
  double du = -(b->v - a->v) / lv * lu / 2, dv = (b->u - a->u) / lu * lv / 2;
  double f0 = cag_tracer_settled(t, u, v), at[2][3] = {{u, v, f0}, {u, v, f0}};
  for (int k = 1; k <= places && !t->status; k++)
    for (int way = 0; way < 2; way++) {
      double x = (way ? -1.0 : 1.0) * k / places, *last = at[way];
      double next[3] = {clamped(u + x * du, lo[0], hi[0]), clamped(v + x * dv, lo[1], hi[1]), 0};
      next[2] = cag_tracer_settled(t, next[0], next[1]);
      if ((next[2] < 0) != (last[2] < 0)) {
        *out = (CagTraceNode){0};
        cag_tracer_crossing(t, last[0], last[1], last[2], next[0], next[1], next[2], out);
        return !t->status;
      }
      memcpy(last, next, sizeof next);
    }
  return false;
}

// At a pole Newton's method may converge to the pole itself, to rounding: that is not a point
// between the two.
static bool is_between(const CagTraceNode *a, const CagTraceNode *m, const CagTraceNode *b,
                       double same) {
  double h = cag_norm(cag_sub(b->p, a->p));
  double near = fmin(cag_norm(cag_sub(m->p, a->p)), cag_norm(cag_sub(m->p, b->p)));
  return h <= same || near > SLID * h;
}

static bool middle_of(CagTracer *t, const CagTraceNode *a, const CagTraceNode *b,
                      CagTraceNode *out) {
  double same = SAME * t->size;
  if (middle_by_newton(t, a, b, out) && is_between(a, out, b, same)) return true;
  return !t->status && middle_across(t, a, b, out) && is_between(a, out, b, same);
}

static CagVec3 aligned(CagVec3 tangent, CagVec3 chord) {
  return cag_dot(tangent, chord) < 0 ? cag_scaled(tangent, -1) : tangent;
}

// Whether the Hermite cubic from a to b is accurate; m is a point of the curve between them.
static bool is_good(const CagTracer *t, const CagTraceNode *a, const CagTraceNode *m,
                    const CagTraceNode *b) {
  CagVec3 chord = cag_sub(b->p, a->p);
  double h = cag_norm(chord);
  // A missing tangent gets the value that it will have later: the reflected tangent of the other
  // end, or that of the parabola through the three.
  CagVec3 along_chord = cag_scaled(chord, 1 / h);
  CagVec3 first = cag_sub(cag_sub(cag_scaled(m->p, 4), cag_scaled(a->p, 3)), b->p);
  CagVec3 last = cag_sub(cag_add(cag_scaled(b->p, 3), a->p), cag_scaled(m->p, 4));
  CagVec3 ta = a->regular ? aligned(a->t, chord) : cag_unit(first);
  CagVec3 tb = b->regular ? aligned(b->t, chord) : cag_unit(last);
  if (!a->regular && b->regular) ta = cag_unit(cag_sub(cag_scaled(along_chord, 2), tb));
  if (a->regular && !b->regular) tb = cag_unit(cag_sub(cag_scaled(along_chord, 2), ta));
  if (cag_dot(ta, tb) < TURN_COSINE) return false;
  double before = cag_norm(cag_sub(m->p, a->p)), after = cag_norm(cag_sub(b->p, m->p));
  if (fmin(before, after) < LOPSIDED * (before + after)) return false;
  CagVec3 middle = cag_madd(cag_scaled(cag_add(a->p, b->p), 0.5), h / 8, cag_sub(ta, tb));
  CagVec3 along = cag_unit(cag_madd(cag_scaled(chord, 1.5 / h), -0.25, cag_add(ta, tb)));
  CagVec3 off = cag_sub(m->p, middle);
  off = cag_madd(off, -cag_dot(off, along), along);
  if (cag_norm(off) > t->tolerance / 2) return false;
  // An error that changes its sign there, like x (1 - x^2)^2 on -1..1, is visible in the slope.
  const double largest = 0.1431; // at x = 1 / sqrt(5), for a slope of 1 and a length of 1
  const double slope = m->regular ? cag_norm(cag_cross(m->t, along)) : 0;
  return largest * slope * h <= t->tolerance / 2;
}

// A point between a and b at which two branches of the curve cross: the gradient vanishes there,
// and the value up to the corresponding rounding.
static bool find_branching(CagTracer *t, const CagTraceNode *a, const CagTraceNode *b,
                           CagTraceNode *out) {
  const double roundings = 100, reach = 2;
  double lu = t->patch.hi[0] - t->patch.lo[0], lv = t->patch.hi[1] - t->patch.lo[1];
  double bend, determinant;
  double far = reach * hypot((b->u - a->u) / lu, (b->v - a->v) / lv);
  *out = (CagTraceNode){.u = (a->u + b->u) / 2, .v = (a->v + b->v) / 2};
  if (!cag_tracer_critical(t, out, far * lu, far * lv, &bend, &determinant) || determinant >= 0)
    return false;
  double g[2];
  double f = cag_tracer_inspect(t, out, g);
  out->regular = false;
  return !t->status && fabs(f) <= roundings * cag_tracer_zero(t, out->u, out->v);
}

// Adds the points after a up to and including b.
static bool refine(CagTracer *t, const CagTraceNode *a, const CagTraceNode *b, int depth,
                   int at_least) {
  CagTraceNode m;
  double same = SAME * t->size;
  bool found = middle_of(t, a, b, &m);
  if (t->status) return false;
  bool together = cag_norm(cag_sub(b->p, a->p)) <= same;
  if (together && (!found || cag_norm(cag_sub(m.p, a->p)) <= same)) return true;
  if (found && !together && at_least <= 0 && is_good(t, a, &m, b))
    return add_check(t, m.p) && add_node(t, b);
  CagTraceNode branching;
  bool stuck = !found || depth >= DEPTH_MOST;
  bool tried = a->branching || b->branching || t->branchings >= BRANCHINGS_MOST;
  if (stuck && !tried && find_branching(t, a, b, &branching)) {
    branching.branching = true;
    t->branchings++;
    return refine(t, a, &branching, depth / 2, at_least) &&
           refine(t, &branching, b, depth / 2, at_least);
  }
  if (stuck) {
    // A jump to another part of the curve: the cells are too large.
    double h = cag_norm(cag_sub(b->p, a->p));
    t->torn = t->torn || (h > t->tolerance && a->regular && b->regular);
    return add_node(t, b);
  }
  return refine(t, a, &m, depth + 1, at_least - 1) && refine(t, &m, b, depth + 1, at_least - 1);
}

// --- Runs ---

static bool add_trace(CagTraces *out, const CagTrace *trace) {
  if (!CAG_RESERVE(out->items, out->capacity, out->count + 1)) return false;
  out->items[out->count++] = *trace;
  return true;
}

// Stores nodes as a trace.
static bool keep_nodes(const CagTraceNode *nodes, size_t n, const CagVec3 *checks,
                       size_t check_count, CagTraces *out) {
  if (n < 2) return true;
  CagTrace trace = {n,
                    check_count,
                    false,
                    cag_malloc(n * sizeof *trace.points),
                    cag_malloc(n * sizeof *trace.tangents),
                    cag_malloc((check_count + 1) * sizeof *trace.checks)};
  bool ok = trace.points && trace.tangents && trace.checks;
  for (size_t i = 0; ok && i < n; i++) {
    const CagTraceNode *node = &nodes[i];
    CagVec3 chord = cag_sub(nodes[i + 1 < n ? i + 1 : i].p, nodes[i > 0 ? i - 1 : 0].p);
    trace.points[i] = node->p;
    trace.tangents[i] = node->regular ? aligned(node->t, chord) : cag_vec3(0, 0, 0);
  }
  if (ok && check_count > 0) memcpy(trace.checks, checks, check_count * sizeof *checks);
  ok = ok && add_trace(out, &trace);
  if (!ok) cag_trace_free(&trace);
  return ok;
}

static bool belongs(CagTracer *t, const CagTraceNode *node) {
  bool inside = false;
  if (!t->status)
    t->status = cag_region_contains(t->region, cag_vec3(node->u, node->v, 0), &inside, t->err);
  return inside;
}

// The intersection of the curve with the border of the region, between a node inside and one
// outside.
static CagTraceNode border_between(CagTracer *t, CagTraceNode in, CagTraceNode off) {
  const int halvings = 50;
  for (int i = 0; i < halvings && !t->status; i++) {
    CagTraceNode m;
    if (!middle_of(t, &in, &off, &m)) break;
    if (belongs(t, &m)) in = m;
    else off = m;
  }
  return in;
}

// Keeps the parts of a run that are inside a trimmed surface.
static bool keep_trimmed(CagTracer *t, size_t from, size_t to, CagTraces *out) {
  CagTraceNode *part = cag_malloc((to - from + 3) * sizeof *part);
  if (!part) return false;
  size_t n = 0;
  bool ok = true, before = false;
  for (size_t i = from; i <= to && ok; i++) {
    bool here = belongs(t, &t->run[i]);
    if (here && !before && i > from) part[n++] = border_between(t, t->run[i], t->run[i - 1]);
    if (here) part[n++] = t->run[i];
    else if (before) {
      part[n++] = border_between(t, t->run[i - 1], t->run[i]);
      ok = keep_nodes(part, n, NULL, 0, out);
      n = 0;
    }
    before = here;
    ok = ok && !t->status;
  }
  ok = ok && keep_nodes(part, n, NULL, 0, out);
  cag_free(part);
  return ok;
}

// Keeps nodes [from, to] of the run. The kind of a run in several parts is determined from its
// points only.
static bool keep_run(CagTracer *t, size_t from, size_t to, CagTraces *out) {
  if (t->region) return keep_trimmed(t, from, to, out);
  bool whole = from == 0 && to + 1 == t->run_count;
  return keep_nodes(t->run + from, to - from + 1, t->checks, whole ? t->check_count : 0, out);
}

static bool is_corner(const CagTracer *t, size_t i) {
  if (t->run[i].branching) return true;
  CagVec3 before = cag_unit(cag_sub(t->run[i].p, t->run[i - 1].p));
  CagVec3 after = cag_unit(cag_sub(t->run[i + 1].p, t->run[i].p));
  return cag_dot(before, after) < CAG_TRACE_CORNER;
}

// Where a sided function is 0 over an area, to rounding, its zero curves are undefined.
static bool is_lost(const CagTracer *t, size_t i) {
  return t->level->sided && t->run[i].flat && t->run[i + 1].flat;
}

// Keeps nodes [from, to], unless they are a tiny run next to such an area, which is a rounding
// artifact.
static bool keep_piece(CagTracer *t, size_t from, size_t to, CagTraces *out) {
  bool beside = (from > 0 && is_lost(t, from - 1)) || (to + 1 < t->run_count && is_lost(t, to));
  double reach = 0;
  for (size_t i = from + 1; i <= to; i++)
    reach = fmax(reach, cag_norm(cag_sub(t->run[i].p, t->run[from].p)));
  return (beside && reach <= BESIDE_LOST * t->size) || keep_run(t, from, to, out);
}

// Refines the run through these edges and cuts it at its corners.
static bool keep_path(CagTracer *t, const int32_t *path, size_t n, CagTraces *out) {
  t->run_count = t->check_count = 0;
  int at_least = n <= SHORT_RUN ? SHORT_RUN_DEPTH : 0;
  if (!add_node(t, &t->crossings[path[0]])) return false;
  for (size_t k = 1; k < n; k++) {
    t->branchings = 0;
    if (!refine(t, &t->crossings[path[k - 1]], &t->crossings[path[k]], 0, at_least)) return false;
  }
  size_t from = 0;
  for (size_t i = 0; i + 1 < t->run_count; i++) {
    bool lost = is_lost(t, i);
    bool corner = i > 0 && is_corner(t, i);
    if ((lost || corner) && i > from && !keep_piece(t, from, i, out)) return false;
    if (lost || corner) from = lost ? i + 1 : i;
  }
  return keep_piece(t, from, t->run_count - 1, out);
}

static bool walk(CagTracer *t, size_t start, bool *seen, int32_t *path, CagTraces *out) {
  size_t n = 0;
  int32_t before = -1, at = (int32_t)start;
  bool round = false;
  while (at >= 0 && !seen[at]) {
    seen[at] = true;
    path[n++] = at;
    int32_t next = t->links[at][0] == before ? t->links[at][1] : t->links[at][0];
    before = at;
    at = next;
    round = at == (int32_t)start;
  }
  if (round && n > 2) path[n++] = (int32_t)start;
  return n < 2 || keep_path(t, path, n, out);
}

static bool walk_all(CagTracer *t, CagTraces *out) {
  bool *seen = cag_calloc(t->edge_count, sizeof *seen);
  int32_t *path = cag_malloc((t->edge_count + 1) * sizeof *path);
  bool ok = seen && path;
  // Runs that begin at the border first, then closed ones.
  for (int inner = 0; inner < 2; inner++)
    for (size_t e = 0; ok && e < t->edge_count; e++)
      if (!seen[e] && t->links[e][0] >= 0 && (inner || t->links[e][1] < 0))
        ok = walk(t, e, seen, path, out);
  cag_free(seen);
  cag_free(path);
  return ok && !t->status;
}

static void tracer_free(CagTracer *t) {
  cag_free(t->lines[0]);
  cag_free(t->lines[1]);
  cag_free(t->values);
  cag_free(t->crossings);
  cag_free(t->links);
  cag_free(t->run);
  cag_free(t->checks);
  t->lines[0] = t->lines[1] = t->values = NULL;
  t->crossings = t->run = NULL;
  t->links = NULL;
  t->checks = NULL;
  t->run_count = t->run_capacity = t->check_count = t->check_capacity = 0;
}

// --- Patches ---

// Whether the values are only rounding: half of them below the bound away from the edges, all below
// the largest bound.
static bool is_constant(const CagTracer *t, double inner, double most) {
  size_t n = t->n[0] * t->n[1], small = 0;
  for (size_t k = 0; k < n; k++) small += fabs(t->values[k]) <= CONSTANT_ROUNDINGS * inner;
  return 2 * small >= n && cag_tracer_largest(t) <= CONSTANT_ROUNDINGS * most;
}

// The largest value that a contour's function could have on the patch: for normals parallel to the
// line of sight.
static double contour_scale(CagTracer *t) {
  enum { TRIED = 5 };
  double largest = 0;
  for (int i = 0; i < TRIED * TRIED && !t->status; i++) {
    CagVec3 d[4] = {0};
    double f, at[2], part[2] = {i / TRIED / (TRIED - 1.0), i % TRIED / (TRIED - 1.0)};
    for (int k = 0; k < 2; k++)
      at[k] = t->patch.lo[k] + part[k] * (t->patch.hi[k] - t->patch.lo[k]);
    t->status = cag_patch_value(&t->patch, at[0], at[1], &f, NULL, d, t->err);
    CagVec3 sight = t->level->central ? cag_sub(d[0], t->level->point) : t->level->direction;
    CagVec3 normal = cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]);
    largest = fmax(largest, cag_norm(normal) * cag_norm(sight));
  }
  return largest;
}

// Sets the bound below which values are 0 on this patch; returns false if all are.
static bool set_patch_zero(CagTracer *t, CagLevel *own) {
  const double rounding = 1e-13;
  if (own->zero > 0) return true;
  if (own->sided) {
    t->status = cag_patch_rounding(&t->patch, &own->zero, &t->zero_beside, t->err);
    if (t->status || is_constant(t, own->zero, t->zero_beside)) return false;
  } else {
    own->zero = rounding * contour_scale(t);
    if (t->status || cag_tracer_largest(t) <= CONSTANT_ROUNDINGS * own->zero) return false;
  }
  return cag_tracer_fill(t);
}

static bool trace_grid(CagTracer *t, CagLevel *own, size_t finer, CagTraces *out, bool *constant) {
  double zero = own->zero;
  t->torn = false;
  bool ok = cag_tracer_make_grid(t, finer);
  bool settled = ok && set_patch_zero(t, own);
  *constant = ok && !settled && !t->status;
  if (!*constant) ok = settled && cag_tracer_link(t) && walk_all(t, out);
  own->zero = zero;
  tracer_free(t);
  return ok;
}

// Traces again with finer cells as long as runs have gaps.
static bool trace_patch(CagTracer *t, CagLevel *own, CagTraces *out, bool *constant) {
  size_t first = out->count;
  for (size_t finer = 1;; finer = 2 * t->finer) {
    if (!trace_grid(t, own, finer, out, constant)) return false;
    if (!t->torn || t->finer >> CAG_TRACER_HALVINGS) return true;
    while (out->count > first) cag_trace_free(&out->items[--out->count]);
  }
}

static CagStatus trace_patches(CagTracer *t, CagLevel *own, CagTraces *out) {
  const CagSurface *s = t->s;
  double *ends[2] = {NULL, NULL};
  size_t n[2] = {0, 0};
  for (int k = 0; !t->status && k < 2; k++)
    t->status = cag_surface_patch_ends(s, own->sided, k, &ends[k], &n[k], t->err);
  bool ok = !t->status;
  for (int k = 0; k < 2; k++) {
    size_t share = n[k] > 0 ? CELLS / n[k] : CELLS;
    size_t least = own->sided ? CELLS_OF_SIDED_PATCH : CELLS_OF_PATCH;
    t->cells[k] = share < least ? least : share;
  }
  out->everywhere = ok;
  for (size_t i = 0; ok && i < n[0]; i++)
    for (size_t j = 0; ok && j < n[1]; j++) {
      bool constant = false;
      const double lo[2] = {ends[0][i], ends[1][j]}, hi[2] = {ends[0][i + 1], ends[1][j + 1]};
      t->status = cag_patch_open(s, own, lo, hi, &t->patch, t->err);
      ok = !t->status && trace_patch(t, own, out, &constant);
      out->everywhere = out->everywhere && constant;
    }
  cag_free(ends[0]);
  cag_free(ends[1]);
  return ok ? CAG_OK : t->status ? t->status : cag_fail_memory(t->err);
}

CagStatus cag_surface_trace(const CagSurface *s, const CagLevel *level, double tolerance,
                            CagTraces *out, CagError *err) {
  CagBounds box;
  *out = (CagTraces){0};
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  CagLevel own = *level;
  CagTracer t = {.s = s, .level = &own, .tolerance = tolerance, .err = err};
  t.size = cag_norm(cag_sub(box.max, box.min));
  const CagSurface *whole;
  if (!cag_surface_trimmed_view(s, &whole, &t.region)) t.region = NULL;
  const CagTraceJoint how = {SAME * 10 * t.size, t.size, tolerance, own.sided};
  status = trace_patches(&t, &own, out);
  if (!status && !cag_traces_join(out, &how)) status = cag_fail_memory(err);
  if (status) cag_traces_free(out);
  return status;
}
