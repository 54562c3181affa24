// The curves in which two surfaces meet, by marching.
//
// Seeds are points where the triangles of their meshes meet. From each seed that is not on a known
// curve, a run is marched in both directions along the cross product of the normals. Each step
// locates a common point of both surfaces in the plane at the end of the step, by Newton's method.
// The step is shortened until the cubic through both ends, with their tangents, passes within the
// tolerance of the points at its middle and quarters. A run ends where it returns to its start,
// where a surface ends, or where the surfaces touch and have no direction. There the march looks a
// little ahead, because two branches may cross. Curves along which the surfaces touch are marched
// in the same way, starting where the meshes are close to each other and nearly parallel. Only the
// method that locates a point differs. If surfaces cross around such a place instead, or twice side
// by side, the other places where they cross are estimated from their curvatures.
//
// A run stays in one patch of each surface. At a crease it ends as at an edge, and its end becomes
// a seed in the patches beyond. Corners therefore lie on the creases, and the joined result does
// not depend on the location of the seeds.

#include "geom/meet/meet_surface.h"

#include <float.h>
#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/meet_place.h"
#include "geom/surface/nearest.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/tessellate.h"

// Fractions of the size of the smaller surface: tolerance of the seeds' meshes, longest step.
#define SEED_MESH (1.0 / 400)
#define SEED_EDGE (1.0 / 25)
#define STEP_MOST (1.0 / 12)
#define STEP_FIRST (1.0 / 100)
// Fractions of the size of both: shortest step, distance of ends that are joined.
#define STEP_LEAST 1e-9
#define JOINED 1e-7
// Fraction of a patch's width within which the end of a run lies on its edge.
#define BESIDE 1e-7
// How to tell a shared piece from a touch: sample points around the place where the surfaces touch,
// at distances of up to COMMON_REACH times the longest step. The surfaces share a piece if they are
// within COMMON times the size of each other at all of these points.
#define COMMON_REACH 0.25
#define COMMON CAG_COINCIDENT
// Branches farther apart than this multiple of the longest step have seeds of their own.
#define TWIN_REACH 0.5
// The meshes are near a touch within this multiple of their tolerance. A run of touches that is
// shorter than this fraction of the size is a single point of contact.
#define TOUCH_MARGIN 3
#define TOUCH_LEAST 1e-3
// cos 12 degrees: maximum turn of a tangent in one step.
#define TURN_MOST 0.978
#define DEFAULT_TOLERANCE 1e-6
// Ratio of sizes above which the meshes for seeds would need millions of triangles.
#define APART_MOST 1000
#define NODES_MOST 200000
#define SEED_TRIANGLES 4000000

typedef struct Run {
  CagMarchNode *nodes;
  CagVec3 *middles; // between node i and the next, on the curve
  size_t n, capacity;
  bool closed;
} Run;

// --- Runs ---

static bool add_node(CagMarch *m, Run *run, const CagMarchNode *node, CagVec3 middle_before) {
  if (run->n >= NODES_MOST) return false;
  if (run->n == run->capacity) {
    size_t capacity = run->capacity ? 2 * run->capacity : 64;
    if (!CAG_RESIZE(run->nodes, capacity) || !CAG_RESIZE(run->middles, capacity))
      return cag_march_fail(m, cag_fail_memory(m->err));
    run->capacity = capacity;
  }
  if (run->n) run->middles[run->n - 1] = middle_before;
  run->nodes[run->n++] = *node;
  return true;
}

static CagVec3 hermite(const CagMarchNode *a, const CagMarchNode *b, double t) {
  double length = cag_norm(cag_sub(b->x, a->x)), s = 1 - t;
  CagVec3 p = cag_scaled(a->x, s * s * (1 + 2 * t));
  p = cag_madd(p, t * t * (1 + 2 * s), b->x);
  p = cag_madd(p, s * s * t * length, a->tangent);
  return cag_madd(p, -t * t * s * length, b->tangent);
}

typedef enum Step { STEPPED, TOO_LONG, ENDED, BROKEN } Step;

// A step from a of length h along its tangent to b, with the point at the middle.
static Step try_step(CagMarch *m, const CagMarchNode *a, double h, bool leap, CagMarchNode *b,
                     CagVec3 *middle) {
  *b = *a;
  CagMarchFound found = m->locate(m, cag_madd(a->x, h, a->tangent), a->tangent, a->tangent, b);
  if (found == CAG_MARCH_FAILED) return BROKEN;
  if (found == CAG_MARCH_NONE) return ENDED;
  if (found == CAG_MARCH_TANGENT) return TOO_LONG;
  CagVec3 d = cag_sub(b->x, a->x);
  if (cag_dot(a->tangent, b->tangent) < TURN_MOST || cag_norm(d) > 1.1 * h) return TOO_LONG;
  // The cubic is parametrized by chord length: the speed of arcs, to third order.
  CagVec3 guess = hermite(a, b, 0.5);
  CagMarchNode between = *a;
  *middle = guess;
  if (leap) return STEPPED;
  found = m->locate(m, guess, cag_unit(d), a->tangent, &between);
  if (found == CAG_MARCH_FAILED) return BROKEN;
  if (found != CAG_MARCH_FOUND) return TOO_LONG;
  *middle = between.x;
  if (cag_norm(cag_sub(guess, between.x)) > m->tolerance / 2) return TOO_LONG;
  // If the curve has an inflection the cubic may pass through its middle, but not through the
  // quarters.
  for (int i = 1; i < 4; i += 2) {
    CagMarchNode quarter = between;
    guess = hermite(a, b, i / 4.0);
    found = m->locate(m, guess, cag_unit(d), a->tangent, &quarter);
    if (found == CAG_MARCH_FAILED) return BROKEN;
    if (found != CAG_MARCH_FOUND || cag_norm(cag_sub(guess, quarter.x)) > m->tolerance)
      return TOO_LONG;
  }
  return STEPPED;
}

// Whether the run passes its start on the way from a to b.
static bool comes_home(const CagMarch *m, const Run *run, const CagMarchNode *a,
                       const CagMarchNode *b) {
  if (run->n < 4) return false;
  const CagMarchNode *start = &run->nodes[0];
  CagVec3 chord = cag_sub(b->x, a->x), to = cag_sub(start->x, a->x);
  double length = cag_norm(chord), along = cag_dot(to, chord) / (length * length);
  if (!(along > 0 && along <= 1 + 1e-9) || cag_dot(start->tangent, a->tangent) < TURN_MOST)
    return false;
  double t = along;
  for (int i = 0; i < 4; i++)
    t += cag_dot(cag_sub(start->x, hermite(a, b, t)), chord) / (length * length);
  return cag_norm(cag_sub(hermite(a, b, t), start->x)) <= 4 * m->tolerance + JOINED * m->size;
}

// Whether both surfaces pass x within the tolerance, near the node.
static bool is_on_both(CagMarch *m, const CagMarchNode *node, CagVec3 x) {
  enum { STEPS = 12 };
  for (int k = 0; k < 2; k++) {
    CagMarchNode n = *node;
    double off = INFINITY;
    for (int i = 0; i < STEPS && off > m->tolerance; i++) {
      CagMarchTangent t;
      if (!cag_march_look(m, k, &n, &t)) return false;
      off = cag_norm(cag_sub(t.p, x));
      cag_march_move(m, k, &t, x, &n);
    }
    if (off > m->tolerance) return false;
  }
  return true;
}

// Continues straight beyond a point without a direction, if the line segment lies on both surfaces.
static bool leap_over(CagMarch *m, const CagMarchNode *a, double h, CagMarchNode *b,
                      CagVec3 *middle) {
  for (double far = h; far < m->step_most; far *= 2) {
    bool leaps = try_step(m, a, far, true, b, middle) == STEPPED &&
                 cag_norm(cag_sub(b->x, cag_madd(a->x, far, a->tangent))) < far / 4;
    for (int i = 1; leaps && i < 4; i++) leaps = is_on_both(m, a, hermite(a, b, i / 4.0));
    if (leaps) return true;
    if (m->status) return false;
  }
  return false;
}

// Newton's method may fail near a pole, where parameters change fast, although nothing ends there.
static bool is_near_pole(const CagMarch *m, CagVec3 x, double reach) {
  for (int k = 0; k < 2; k++) {
    const CagSurface *s = m->side[k].s;
    const double u[4] = {s->u0, s->u1, (s->u0 + s->u1) / 2, (s->u0 + s->u1) / 2};
    const double v[4] = {(s->v0 + s->v1) / 2, (s->v0 + s->v1) / 2, s->v0, s->v1};
    const bool pole[4] = {s->pole_u0, s->pole_u1, s->pole_v0, s->pole_v1};
    for (int i = 0; i < 4; i++) {
      CagVec3 p;
      CagError ignored;
      if (pole[i] && !cag_surface_point(s, u[i], v[i], &p, &ignored) &&
          cag_norm(cag_sub(p, x)) <= reach)
        return true;
    }
  }
  return false;
}

// A surface ends before h, which is negligibly short: the last point is found by bisection and
// replaces the last node.
static bool add_end(CagMarch *m, Run *run, double h) {
  CagMarchNode *end = &run->nodes[run->n - 1];
  const CagMarchNode a = *end;
  double low = 0, high = h;
  while (high - low > CAG_MARCH_SAME * m->size) {
    CagMarchNode b;
    CagVec3 middle;
    const double half = (low + high) / 2;
    const Step step = try_step(m, &a, half, true, &b, &middle);
    if (step == BROKEN) return false;
    if (step == STEPPED) low = half, *end = b;
    else high = half;
  }
  return true;
}

// Moves the end of a run exactly onto the edge of the patch that it is next to: to the intersection
// of the edge with the other surface.
static bool move_to_edge(CagMarch *m, int k, int d, double edge, CagMarchNode *end) {
  enum { STEPS = 6 };
  CagMarchNode node = *end;
  CagVec3 x = end->x;
  double gap = INFINITY;
  node.at[k][d] = edge;
  for (int i = 0; i < STEPS; i++) {
    CagMarchTangent own, other;
    if (!cag_march_look(m, k, &node, &own) || !cag_march_look(m, 1 - k, &node, &other))
      return false;
    const CagVec3 along = d ? own.du : own.dv;
    const double rate = cag_dot(other.normal, along);
    if (fabs(rate) <= CAG_MARCH_TOUCH * cag_norm(along)) {
      // For touches, the nearest point on the edge is accurate to second order.
      if (m->locate == cag_march_locate_touch &&
          cag_norm(cag_sub(own.p, end->x)) <= JOINED * m->size) {
        node.x = own.p;
        *end = node;
      }
      return true;
    }
    const double *range = cag_march_range(m, k, &node, 1 - d);
    const double step = cag_dot(other.normal, cag_sub(other.p, own.p)) / rate;
    gap = cag_norm(cag_sub(own.p, other.p));
    x = own.p;
    node.at[k][1 - d] = fmin(fmax(node.at[k][1 - d] + step, range[0]), range[1]);
    cag_march_move(m, 1 - k, &other, cag_madd(own.p, step, along), &node);
  }
  if (gap > CAG_MARCH_SAME * m->size || cag_norm(cag_sub(x, end->x)) > JOINED * m->size)
    return true;
  node.x = x;
  *end = node;
  return true;
}

static bool settle_end(CagMarch *m, CagMarchNode *end) {
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 2; d++) {
      const double *range = cag_march_range(m, k, end, d), near = BESIDE * (range[1] - range[0]);
      for (int i = 0; i < 2 && !m->side[k].patches.wraps[d]; i++)
        if (fabs(end->at[k][d] - range[i]) <= near) return move_to_edge(m, k, d, range[i], end);
    }
  return true;
}

// Continues from the last node until the run ends or is closed.
static bool go_on(CagMarch *m, Run *run) {
  double h = m->step_first, least = STEP_LEAST * m->size;
  while (run->n < NODES_MOST) {
    if (m->interrupt && *m->interrupt)
      return cag_march_fail(
          m, cag_fail(m->err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1, "stopped"));
    CagMarchNode a = run->nodes[run->n - 1], b;
    CagVec3 middle;
    Step step = try_step(m, &a, h, false, &b, &middle);
    if (step == BROKEN) return false;
    if (step != STEPPED) {
      // Before an end steps need not be short.
      if (h > (step == ENDED ? JOINED * m->size : least)) {
        h = fmax(h / 2, least);
        continue;
      }
      bool open = step == ENDED && !is_near_pole(m, a.x, 4 * h);
      if (open || !leap_over(m, &a, 64 * least, &b, &middle))
        return !m->status &&
               (step != ENDED || (add_end(m, run, h) && settle_end(m, &run->nodes[run->n - 1])));
    }
    if (comes_home(m, run, &a, &b)) {
      // The last piece ends exactly in the start.
      CagMarchNode home = run->nodes[0], between = a;
      CagVec3 d = cag_sub(home.x, a.x), guess = hermite(&a, &home, 0.5);
      run->closed = true;
      if (cag_norm(d) <= 16 * least) {
        run->nodes[run->n - 1] = home;
        return true;
      }
      if (m->locate(m, guess, cag_unit(d), a.tangent, &between) == CAG_MARCH_FOUND)
        guess = between.x;
      return !m->status && add_node(m, run, &home, guess);
    }
    if (!add_node(m, run, &b, middle)) return !m->status;
    h = fmin(1.4 * h, m->step_most);
  }
  return true;
}

static void turn_round(Run *run) {
  for (size_t i = 0; i < run->n / 2; i++) {
    CagMarchNode swap = run->nodes[i];
    run->nodes[i] = run->nodes[run->n - 1 - i];
    run->nodes[run->n - 1 - i] = swap;
  }
  for (size_t i = 0; i + 1 < run->n && i < (run->n - 1) / 2; i++) {
    CagVec3 swap = run->middles[i];
    run->middles[i] = run->middles[run->n - 2 - i];
    run->middles[run->n - 2 - i] = swap;
  }
  for (size_t i = 0; i < run->n; i++) run->nodes[i].tangent = cag_scaled(run->nodes[i].tangent, -1);
}

static bool trace(CagMarch *m, const CagMarchNode *seed, Run *run) {
  if (!add_node(m, run, seed, seed->x) || !go_on(m, run)) return !m->status;
  if (run->closed) return true;
  turn_round(run);
  return go_on(m, run);
}

// --- Seeds in adjacent patches ---

// Adds the end of a run as a seed in the other patches that contain it.
static bool add_seeds_beside(CagMarch *m, const CagMarchNode *end) {
  CagPatchPlace places[2][9];
  size_t n[2];
  for (int k = 0; k < 2; k++) {
    const CagPatchPlace own = {{end->patch[k][0], end->patch[k][1]},
                               {end->at[k][0], end->at[k][1]}};
    n[k] = cag_patches_beside(&m->side[k].patches, &own, BESIDE, places[k]);
  }
  for (size_t i = 1; i < n[0] * n[1]; i++) {
    CagMarchNode seed = *end;
    for (int k = 0; k < 2; k++) {
      const CagPatchPlace *place = &places[k][k ? i % n[1] : i / n[1]];
      for (int d = 0; d < 2; d++) {
        seed.at[k][d] = place->at[d];
        seed.patch[k][d] = place->patch[d];
      }
    }
    if (!cag_march_add_seed(m, m->seeds, &seed)) return false;
  }
  return true;
}

// Whether the point lies within `near` of the run.
static bool lies_on(const Run *run, CagVec3 x, double near) {
  for (size_t i = 0; i + 1 < run->n; i++) {
    const CagMarchNode *a = &run->nodes[i], *b = &run->nodes[i + 1];
    CagVec3 chord = cag_sub(b->x, a->x);
    double square = cag_dot(chord, chord);
    if (square == 0 || cag_norm(cag_sub(x, a->x)) > 1.5 * sqrt(square)) continue;
    double t = fmin(fmax(cag_dot(cag_sub(x, a->x), chord) / square, 0), 1);
    for (int k = 0; k < 4; k++)
      t = fmin(fmax(t + cag_dot(cag_sub(x, hermite(a, b, t)), chord) / square, 0), 1);
    if (cag_norm(cag_sub(hermite(a, b, t), x)) <= near) return true;
  }
  return false;
}

// Whether a seed in a run's patches lies on it.
static bool has_seed(const CagMarch *m, const Run *run, const CagMarchNode *seed) {
  const CagMarchNode *first = &run->nodes[0];
  for (int k = 0; k < 2; k++)
    for (int d = 0; d < 2; d++)
      if (first->patch[k][d] != seed->patch[k][d]) return false;
  return lies_on(run, seed->x, 8 * m->tolerance + JOINED * m->size);
}

static double reach_of(const Run *run, size_t first, size_t last) {
  double reach = 0;
  for (size_t i = first; i <= last; i++)
    reach = fmax(reach, cag_norm(cag_sub(run->nodes[i].x, run->nodes[first].x)));
  return reach;
}

// Whether a run has been found already: along a crease, from the patch on its other side.
static bool is_twin(const CagMarch *m, const Run *run, const Run *other) {
  const double reach = reach_of(run, 0, run->n - 1);
  const double near = reach > 16 * m->tolerance ? m->tolerance : JOINED * m->size;
  for (size_t i = 0; i < run->n; i++)
    if (!lies_on(other, run->nodes[i].x, near)) return false;
  return true;
}

// --- Curves ---

static bool add_curve(CagMarch *m, const Run *run, size_t first, size_t last, bool closed,
                      CagCurveList *out) {
  size_t n = last - first + 1;
  // The remainder of a seed at a pole or at a corner of an outline.
  if (n < 2 || reach_of(run, first, last) <= JOINED * m->size) return true;
  CagTrace t = {.count = n, .check_count = n - 1, .closed = closed};
  t.points = cag_malloc(n * sizeof *t.points);
  t.tangents = cag_malloc(n * sizeof *t.tangents);
  t.checks = cag_malloc(n * sizeof *t.checks);
  bool ok = t.points && t.tangents && t.checks;
  if (!ok) cag_march_fail(m, cag_fail_memory(m->err));
  for (size_t i = 0; ok && i < n; i++) {
    t.points[i] = run->nodes[first + i].x;
    t.tangents[i] = run->nodes[first + i].tangent;
    if (i + 1 < n) t.checks[i] = run->middles[first + i];
  }
  CagCurve *curve = NULL;
  CagStatus status = ok ? cag_trace_curve(&t, NULL, m->size, &curve, m->err) : CAG_OK;
  if (ok && !status) status = cag_curve_list_add(out, curve, m->err);
  cag_free(t.points);
  cag_free(t.tangents);
  cag_free(t.checks);
  return ok && (!status || cag_march_fail(m, status));
}

// The point between two nodes at which the run leaves an outline; `inside` is inside of it.
static bool find_border(CagMarch *m, CagMarchNode inside, CagMarchNode outside, CagMarchNode *out) {
  const int halvings = 48;
  for (int i = 0; i < halvings; i++) {
    CagVec3 d = cag_sub(outside.x, inside.x);
    if (cag_norm(d) <= CAG_MARCH_SAME * m->size) break;
    CagMarchNode half = inside;
    if (m->locate(m, hermite(&inside, &outside, 0.5), cag_unit(d), inside.tangent, &half) !=
        CAG_MARCH_FOUND)
      break;
    if (cag_march_belongs(m, &half)) inside = half;
    else outside = half;
    if (m->status) return false;
  }
  *out = inside;
  return !m->status;
}

// The parts of a run that lie within the outlines.
static bool add_parts(CagMarch *m, const Run *run, CagCurveList *out) {
  if (!m->side[0].region && !m->side[1].region)
    return add_curve(m, run, 0, run->n - 1, run->closed, out);
  Run part = {0};
  bool ok = true, whole = run->closed, was = false;
  for (size_t i = 0; ok && i < run->n; i++) {
    const CagMarchNode *node = &run->nodes[i];
    bool is = cag_march_belongs(m, node);
    CagMarchNode border;
    if (m->status) ok = false;
    whole = whole && is;
    if (ok && is && !was && i > 0)
      ok = find_border(m, *node, run->nodes[i - 1], &border) &&
           add_node(m, &part, &border, border.x);
    if (ok && is) {
      CagVec3 middle = i > 0 && was ? run->middles[i - 1] : node->x;
      if (!was && part.n) middle = hermite(&part.nodes[part.n - 1], node, 0.5);
      ok = add_node(m, &part, node, middle);
    }
    if (ok && !is && was) {
      ok = find_border(m, run->nodes[i - 1], *node, &border) &&
           add_node(m, &part, &border, hermite(&part.nodes[part.n - 1], &border, 0.5)) &&
           add_curve(m, &part, 0, part.n - 1, false, out);
      part.n = 0;
    }
    was = is;
  }
  if (ok && part.n) ok = add_curve(m, &part, 0, part.n - 1, whole, out);
  cag_free(part.nodes);
  cag_free(part.middles);
  return ok;
}

// --- Complete search ---

// Whether a point of the first surface next to a contact lies on the second; `known`: whether there
// is such a point.
static bool is_shared(CagMarch *m, const double at[2], bool *known, bool *out) {
  const CagSurface *a = m->side[0].s;
  const CagMarchNode place = {.at = {{at[0], at[1]}}};
  const double low[2] = {a->u0, a->v0}, high[2] = {a->u1, a->v1};
  bool inside = true;
  *known = false;
  for (int d = 0; d < 2; d++)
    if (!(at[d] >= low[d] && at[d] <= high[d])) return true;
  if (!cag_march_belongs_to(m, 0, &place, &inside) || !inside) return !m->status;
  CagVec3 p;
  CagSurfaceNearest nearest;
  CagStatus status = cag_surface_point(a, at[0], at[1], &p, m->err);
  if (!status) status = cag_surface_closest(m->side[1].s, p, &nearest, m->err);
  if (status) return cag_march_fail(m, status);
  *known = true;
  *out = nearest.distance <= COMMON * m->size;
  return true;
}

// Whether the surfaces coincide around a contact, rather than only along lines. Two lines of
// contact or intersection may cross there, so many directions are tested, as far away as surfaces
// with third-order contact separate.
static bool is_common(CagMarch *m, const CagMarchNode *node, bool *out) {
  enum { DIRECTIONS = 10, RINGS = 2 };
  CagMarchTangent t;
  int tried = 0;
  *out = false;
  if (!cag_march_look(m, 0, node, &t)) return false;
  for (int i = 0; i < DIRECTIONS * RINGS; i++) {
    const double reach = COMMON_REACH * m->step_most * (1 + i / DIRECTIONS) / RINGS;
    const double angle = 2 * M_PI * (i + 0.25) / DIRECTIONS;
    const double at[2] = {node->at[0][0] + reach * cos(angle) / fmax(cag_norm(t.du), DBL_MIN),
                          node->at[0][1] + reach * sin(angle) / fmax(cag_norm(t.dv), DBL_MIN)};
    bool known, shared;
    if (!is_shared(m, at, &known, &shared)) return false;
    if (known && !shared) return true;
    tried += known;
  }
  *out = tried >= DIRECTIONS / 2;
  return true;
}

// Examines the contacts, up to some hundred of them.
static bool find_common(CagMarch *m, bool *out) {
  const size_t looks = 100;
  size_t found = 0, every = m->touching / looks + 1;
  *out = false;
  for (size_t i = 0; !*out && i < m->seeds->count; i++) {
    CagMarchNode seed = m->seeds->items[i];
    const CagVec3 none = {0, 0, 0};
    CagMarchFound how = m->locate(m, seed.x, none, none, &seed);
    if (how == CAG_MARCH_FAILED) return false;
    if (how == CAG_MARCH_TANGENT && found++ % every == 0 && !is_common(m, &seed, out)) return false;
  }
  return true;
}

static void free_run(Run *run) {
  cag_free(run->nodes);
  cag_free(run->middles);
}

typedef struct Runs {
  Run *items;
  size_t n, capacity;
} Runs;

static void free_runs(Runs *runs) {
  for (size_t i = 0; i < runs->n; i++) free_run(&runs->items[i]);
  cag_free(runs->items);
}

// Where the surfaces cross at a small angle, two branches may run so close to each other that all
// seeds lead to one of them. Adds seeds of the other one.
static bool add_seeds_of_twins(CagMarch *m, const Run *run) {
  enum { PLACES = 16 };
  const size_t every = run->n / PLACES + 1;
  for (size_t i = 0; i < run->n; i += every) {
    CagMarchNode seed;
    if (cag_march_find_twin(m, &run->nodes[i], TWIN_REACH * m->step_most, &seed)) {
      if (!cag_march_add_seed(m, m->seeds, &seed)) return false;
    } else if (m->status) return false;
  }
  return true;
}

// Takes ownership of the run, unless it is a point or has been found already, and adds the seeds of
// its continuations.
static bool keep_run(CagMarch *m, Runs *runs, Run *run) {
  bool kept = run->n > 1 && reach_of(run, 0, run->n - 1) > m->least_run;
  for (size_t k = 0; kept && k < runs->n; k++) kept = !is_twin(m, run, &runs->items[k]);
  if (kept && !CAG_RESERVE(runs->items, runs->capacity, runs->n + 1))
    kept = cag_march_fail(m, cag_fail_memory(m->err));
  if (!kept) {
    free_run(run);
    return !m->status;
  }
  runs->items[runs->n++] = *run;
  if (m->locate == cag_march_locate_crossing && !add_seeds_of_twins(m, run)) return false;
  return run->closed ||
         (add_seeds_beside(m, &run->nodes[0]) && add_seeds_beside(m, &run->nodes[run->n - 1]));
}

// Seeds of loops so small that the meshes do not cross there.
static bool add_seeds_around(CagMarch *m, const CagMarchNode *touch) {
  CagMarchNode seeds[4];
  const size_t n = cag_march_find_round(m, touch, TWIN_REACH * m->step_most, seeds);
  for (size_t i = 0; i < n; i++)
    if (!cag_march_add_seed(m, &m->crossings, &seeds[i])) return false;
  return !m->status;
}

static bool march_from(CagMarch *m, Runs *runs, CagMarchNode seed) {
  const CagVec3 none = {0, 0, 0};
  const CagMarchFound found = m->locate(m, seed.x, none, none, &seed);
  m->touching += found == CAG_MARCH_TANGENT;
  if (found == CAG_MARCH_NONE && m->locate == cag_march_locate_touch)
    return add_seeds_around(m, &seed);
  if (found != CAG_MARCH_FOUND) return found != CAG_MARCH_FAILED;
  for (size_t k = 0; k < runs->n; k++)
    if (has_seed(m, &runs->items[k], &seed)) return true;
  Run run = {0};
  if (trace(m, &seed, &run)) return keep_run(m, runs, &run);
  free_run(&run);
  return false;
}

static bool march_all(CagMarch *m, Runs *runs) {
  bool ok = true;
  // Runs add seeds.
  for (size_t i = 0; ok && i < m->seeds->count; i++) ok = march_from(m, runs, m->seeds->items[i]);
  return ok;
}

static bool march_touches(CagMarch *m, Runs *runs) {
  m->locate = cag_march_locate_touch;
  m->least_run = TOUCH_LEAST * m->size;
  m->seeds = &m->touches;
  return march_all(m, runs);
}

static bool march_crossings(CagMarch *m, Runs *runs) {
  m->locate = cag_march_locate_crossing;
  m->least_run = JOINED * m->size;
  m->touching = 0;
  m->seeds = &m->crossings;
  return march_all(m, runs);
}

static bool find_seeds(CagMarch *m) {
  return cag_march_find_seeds(m, TOUCH_MARGIN * m->mesh_tolerance);
}

// Touches come first. Near a touch, the surfaces are so close that they seem to cross, but points
// on a known run are skipped.
static bool find_runs(CagMarch *m, Runs *runs, bool *common) {
  return find_seeds(m) && march_touches(m, runs) && march_crossings(m, runs) &&
         (m->touching == 0 || find_common(m, common));
}

static CagStatus prepare(CagMarch *m, const CagSurface *a, const CagSurface *b, double tolerance,
                         CagError *err) {
  const CagSurface *s[2] = {a, b};
  double size[2] = {0, 0};
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 2; k++) {
    CagBounds box;
    m->side[k].s = s[k];
    if (!cag_surface_planar_view(s[k], &m->side[k].region, NULL))
      cag_surface_trimmed_view(s[k], NULL, &m->side[k].region);
    status = cag_surface_bounds(s[k], &box, err);
    if (!status) size[k] = cag_norm(cag_sub(box.max, box.min));
  }
  double smaller = fmin(size[0], size[1]);
  m->size = fmax(size[0], size[1]);
  m->tolerance = tolerance > 0 ? tolerance : DEFAULT_TOLERANCE * m->size;
  m->least_run = JOINED * m->size;
  m->mesh_tolerance = SEED_MESH * smaller;
  m->step_most = STEP_MOST * smaller;
  m->step_first = STEP_FIRST * smaller;
  if (!status && !(m->size <= APART_MOST * smaller))
    return smaller > 0
               ? cag_fail(
                     err, CAG_E_UNSUPPORTED, CAG_ERR_sizes_apart, "A", -1,
                     "the sizes of the surfaces differ too much, %.3g mm and %.3g mm; trim the larger one near the other",
                     m->size, smaller)
               : CAG_OK;
  for (int k = 0; !status && k < 2; k++) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    how.tolerance = m->mesh_tolerance;
    // For the larger surface, as fine as by default.
    how.max_edge = fmax(SEED_EDGE * smaller, size[k] / 200);
    how.max_triangles = SEED_TRIANGLES;
    how.interrupt = m->interrupt;
    status = cag_surface_tessellate(s[k], &how, &m->side[k].mesh, err);
    if (!status) status = cag_patches_open(s[k], &m->side[k].patches, err);
  }
  return status;
}

static void close_march(CagMarch *m) {
  for (int k = 0; k < 2; k++) {
    cag_mesh_release(m->side[k].mesh);
    cag_patches_free(&m->side[k].patches);
  }
  cag_free(m->crossings.items);
  cag_free(m->touches.items);
}

// Converts the runs to curves and joins them.
static CagStatus add_runs(CagMarch *m, const Runs *runs, CagCurveList *out) {
  const size_t first = out->count;
  for (size_t i = 0; i < runs->n; i++)
    if (!add_parts(m, &runs->items[i], out)) return m->status;
  return cag_curve_list_join(out, first, JOINED * m->size, m->err);
}

CagStatus cag_surface_intersect(const CagSurface *a, const CagSurface *b, double tolerance,
                                const volatile int *interrupt, CagCurveList *out, CagError *err) {
  CagMarch m = {.interrupt = interrupt, .err = err};
  CagStatus status = prepare(&m, a, b, tolerance, err);
  Runs runs = {0};
  bool common = false;
  const bool are_two = !status && m.side[0].mesh; // neither is a point
  if (are_two && !find_runs(&m, &runs, &common)) status = m.status;
  if (!status && common)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_overlap, "", -1,
                      "the surfaces share a piece: they meet in more than curves");
  if (!status && are_two) status = add_runs(&m, &runs, out);
  free_runs(&runs);
  close_march(&m);
  return status;
}

CagStatus cag_surface_touches(const CagSurface *a, const CagSurface *b, double tolerance,
                              const volatile int *interrupt, CagCurveList *out, CagError *err) {
  CagMarch m = {.interrupt = interrupt, .err = err};
  CagStatus status = prepare(&m, a, b, tolerance, err);
  Runs runs = {0};
  const bool are_two = !status && m.side[0].mesh;
  if (are_two && !(find_seeds(&m) && march_touches(&m, &runs))) status = m.status;
  if (!status && are_two) status = add_runs(&m, &runs, out);
  free_runs(&runs);
  close_march(&m);
  return status;
}
