// The curves in which two surfaces meet, by marching.
//
// Where the triangles of their meshes meet are the seeds. From each that lies on no curve found yet
// one goes both ways along the cross product of the normals: a step is tried, a place of both
// surfaces in the plane at its end is found by Newton's method, and the step is shortened until the
// cubic through both ends, with their tangents, passes within the tolerance of the place in the
// middle. A run ends where it comes home, where a surface ends, or where the surfaces touch and
// have no direction; there one looks a little ahead, since two branches may cross.

#include "geom/surface/meet_surface.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "geom/mesh/tessellate.h"
#include "geom/surface/nearest.h"
#include "geom/surface/trimmed.h"

// Parts of the size of the smaller surface: of the seeds' meshes, of the longest step.
#define SEED_MESH (1.0 / 400)
#define SEED_EDGE (1.0 / 25)
#define STEP_MOST (1.0 / 12)
#define STEP_FIRST (1.0 / 100)
// Parts of the size of both: where two points are one, the shortest step, ends that are joined.
#define SAME 1e-11
#define STEP_LEAST 1e-9
#define JOINED 1e-7
// Sine of the angle of the normals below which the surfaces touch.
#define TOUCH 1e-6
// Surfaces share a piece where, all about a place at which they touch, to this part of the longest
// step, they are no farther apart than that part of the size.
#define COMMON_REACH 0.25
#define COMMON 1e-9
// cos 12 degrees: a tangent turns by no more in one step.
#define TURN_MOST 0.978
#define DEFAULT_TOLERANCE 1e-6
// Where one surface is so much larger, the meshes that seeds come from would take millions of
// triangles.
#define APART_MOST 1000
#define NODES_MOST 200000
#define NEWTON_STEPS 40
#define SEED_TRIANGLES 4000000

typedef struct Side {
  const CagSurface *s;
  const CagRegion *region; // its inside belongs; NULL: all
  CagMesh *mesh;
} Side;

typedef struct Node {
  CagVec3 x, tangent; // unit
  double at[2][2];    // u, v on each
} Node;

typedef struct Run {
  Node *nodes;
  CagVec3 *middles; // between node i and the next, on the curve
  size_t n, capacity;
  bool closed;
} Run;

typedef struct March {
  Side side[2];
  double size, tolerance, step_most, step_first;
  Node *seeds;
  size_t seed_count, seed_capacity, touching;
  const volatile int *interrupt;
  CagError *err;
  CagStatus status; // of what failed for good
} March;

static bool fail(March *m, CagStatus status) {
  m->status = status;
  return false;
}

// --- Places ---

typedef struct Tangential {
  CagVec3 p, du, dv, normal;
} Tangential;

static bool look(March *m, int k, const double at[2], Tangential *out) {
  const CagSurface *s = m->side[k].s;
  CagVec3 d[4];
  CagStatus status =
      cag_surface_eval(s, at[0], at[1], 1, at[0] >= s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                       at[1] >= s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, m->err);
  if (status) return fail(m, status);
  *out = (Tangential){.p = d[0], .du = d[cag_partial(1, 1, 0)], .dv = d[cag_partial(1, 0, 1)]};
  out->normal = cag_unit(cag_cross(out->du, out->dv));
  // At poles the normal is a limit.
  if (cag_norm(out->normal) == 0) {
    CagError ignored;
    if (cag_surface_normal(s, at[0], at[1], &out->normal, &ignored) != CAG_OK)
      out->normal = cag_vec3(0, 0, 0);
  }
  return true;
}

static double stepped(double x, double d, double low, double high, bool closed) {
  double range = high - low, y = x + fmin(fmax(d, -range / 4), range / 4);
  if (closed && y < low) return y + range;
  if (closed && y > high) return y - range;
  return fmin(fmax(y, low), high);
}

// A step of u (or v) that would pass a pole goes on beyond it, where the other parameter is half
// its range further.
static bool pass_pole(const CagSurface *s, int d, double step, double at[2]) {
  const double low[2] = {s->u0, s->v0}, high[2] = {s->u1, s->v1};
  const bool pole_low[2] = {s->pole_u0, s->pole_v0}, pole_high[2] = {s->pole_u1, s->pole_v1};
  const bool closed[2] = {s->closed_u, s->closed_v};
  const double y = at[d] + step, range = high[1 - d] - low[1 - d];
  if (!closed[1 - d]) return false;
  if (y < low[d] && pole_low[d]) at[d] = fmin(2 * low[d] - y, high[d]);
  else if (y > high[d] && pole_high[d]) at[d] = fmax(2 * high[d] - y, low[d]);
  else return false;
  at[1 - d] += at[1 - d] + range / 2 > high[1 - d] ? -range / 2 : range / 2;
  return true;
}

// Moves the parameters so that the point comes to x, as far as the tangent plane tells.
static void move_to(const CagSurface *s, const Tangential *t, CagVec3 x, double at[2]) {
  CagVec3 r = cag_sub(x, t->p);
  double a = cag_dot(t->du, t->du), b = cag_dot(t->du, t->dv), c = cag_dot(t->dv, t->dv);
  double damping = 1e-14 * (a + c) + DBL_MIN;
  double det = (a + damping) * (c + damping) - b * b;
  double g = cag_dot(r, t->du), h = cag_dot(r, t->dv);
  double du = ((c + damping) * g - b * h) / det, dv = ((a + damping) * h - b * g) / det;
  if (pass_pole(s, 0, du, at) || pass_pole(s, 1, dv, at)) return;
  at[0] = stepped(at[0], du, s->u0, s->u1, s->closed_u);
  at[1] = stepped(at[1], dv, s->v0, s->v1, s->closed_v);
}

typedef enum Found { FOUND, NONE, TANGENT, FAILED } Found;

// The place of both surfaces in the plane through q that is normal to n (n zero: the nearest to
// where they are), from the node's parameters; its tangent is turned to `along`.
static Found locate(March *m, CagVec3 q, CagVec3 n, CagVec3 along, Node *node) {
  double last = INFINITY;
  for (int i = 0; i < NEWTON_STEPS; i++) {
    Tangential t[2];
    if (!look(m, 0, node->at[0], &t[0]) || !look(m, 1, node->at[1], &t[1])) return FAILED;
    CagVec3 middle = cag_lerp(t[0].p, t[1].p, 0.5);
    CagVec3 cross = cag_cross(t[0].normal, t[1].normal);
    double gap = cag_norm(cag_sub(t[0].p, t[1].p));
    bool planar = cag_norm(n) > 0;
    double off = planar ? fabs(cag_dot(n, cag_sub(middle, q))) : 0;
    if (gap + off <= SAME * m->size && (gap + off >= last || gap + off == 0)) {
      if (cag_norm(cross) < TOUCH) return TANGENT;
      node->x = middle;
      node->tangent = cag_unit(cross);
      if (cag_dot(node->tangent, along) < 0) node->tangent = cag_scaled(node->tangent, -1);
      return FOUND;
    }
    if (i > 8 && gap + off > last / 2 && gap + off > SAME * m->size) return NONE;
    last = fmin(last, gap + off);
    // The point of three planes: both tangent planes and the given one, or the one across.
    CagVec3 third = planar ? n : cag_unit(cross), through = planar ? q : middle;
    CagVec3 c0 = cag_cross(t[1].normal, third), c1 = cag_cross(third, t[0].normal);
    double det = cag_dot(t[0].normal, c0);
    CagVec3 x;
    if (fabs(det) < TOUCH * TOUCH) {
      // Parallel planes: the middle, in the given plane.
      x = planar ? cag_madd(middle, cag_dot(n, cag_sub(q, middle)), n) : middle;
    } else {
      x = cag_scaled(c0, cag_dot(t[0].normal, cag_sub(t[0].p, middle)));
      x = cag_madd(x, cag_dot(t[1].normal, cag_sub(t[1].p, middle)), c1);
      x = cag_madd(x, cag_dot(third, cag_sub(through, middle)), cross);
      x = cag_madd(middle, 1 / det, x);
    }
    for (int k = 0; k < 2; k++) move_to(m->side[k].s, &t[k], x, node->at[k]);
  }
  return NONE;
}

static bool belongs_to(March *m, int k, const Node *node, bool *out) {
  const CagVec3 p = cag_vec3(node->at[k][0], node->at[k][1], 0);
  *out = true;
  if (!m->side[k].region) return true;
  CagStatus status = cag_region_contains(m->side[k].region, p, out, m->err);
  return status == CAG_OK || fail(m, status);
}

static bool belongs(March *m, const Node *node) {
  bool inside;
  for (int k = 0; k < 2; k++)
    if (!belongs_to(m, k, node, &inside) || !inside) return false;
  return true;
}

// --- Runs ---

static bool add_node(March *m, Run *run, const Node *node, CagVec3 middle_before) {
  if (run->n >= NODES_MOST) return false;
  if (run->n == run->capacity) {
    size_t capacity = run->capacity ? 2 * run->capacity : 64;
    Node *nodes = realloc(run->nodes, capacity * sizeof *nodes);
    if (nodes) run->nodes = nodes;
    CagVec3 *middles = realloc(run->middles, capacity * sizeof *middles);
    if (middles) run->middles = middles;
    if (!nodes || !middles) return fail(m, cag_fail_memory(m->err));
    run->capacity = capacity;
  }
  if (run->n) run->middles[run->n - 1] = middle_before;
  run->nodes[run->n++] = *node;
  return true;
}

static CagVec3 hermite(const Node *a, const Node *b, double t) {
  double length = cag_norm(cag_sub(b->x, a->x)), s = 1 - t;
  CagVec3 p = cag_scaled(a->x, s * s * (1 + 2 * t));
  p = cag_madd(p, t * t * (1 + 2 * s), b->x);
  p = cag_madd(p, s * s * t * length, a->tangent);
  return cag_madd(p, -t * t * s * length, b->tangent);
}

typedef enum Step { STEPPED, TOO_LONG, ENDED, BROKEN } Step;

// From a by h along its tangent to b, with the place in the middle.
static Step try_step(March *m, const Node *a, double h, bool leap, Node *b, CagVec3 *middle) {
  *b = *a;
  Found found = locate(m, cag_madd(a->x, h, a->tangent), a->tangent, a->tangent, b);
  if (found == FAILED) return BROKEN;
  if (found == NONE) return ENDED;
  if (found == TANGENT) return TOO_LONG;
  CagVec3 d = cag_sub(b->x, a->x);
  if (cag_dot(a->tangent, b->tangent) < TURN_MOST || cag_norm(d) > 1.1 * h) return TOO_LONG;
  // The cubic's chord length is its parameter: the speed of arcs, to their third order.
  CagVec3 guess = hermite(a, b, 0.5);
  Node between = *a;
  *middle = guess;
  if (leap) return STEPPED;
  found = locate(m, guess, cag_unit(d), a->tangent, &between);
  if (found == FAILED) return BROKEN;
  if (found != FOUND) return TOO_LONG;
  *middle = between.x;
  return cag_norm(cag_sub(guess, between.x)) <= m->tolerance / 2 ? STEPPED : TOO_LONG;
}

// Whether the run, going from a to b, passes its start.
static bool comes_home(const March *m, const Run *run, const Node *a, const Node *b) {
  if (run->n < 4) return false;
  const Node *start = &run->nodes[0];
  CagVec3 chord = cag_sub(b->x, a->x), to = cag_sub(start->x, a->x);
  double length = cag_norm(chord), along = cag_dot(to, chord) / (length * length);
  if (!(along > 0 && along <= 1 + 1e-9) || cag_dot(start->tangent, a->tangent) < TURN_MOST)
    return false;
  double t = along;
  for (int i = 0; i < 4; i++) {
    double off = cag_dot(cag_sub(start->x, hermite(a, b, t)), chord) / (length * length);
    t = fmin(fmax(t + off, 0), 1);
  }
  return cag_norm(cag_sub(hermite(a, b, t), start->x)) <= 4 * m->tolerance + JOINED * m->size;
}

// Beyond a place without a direction, straight on.
static bool leap_over(March *m, const Node *a, double h, Node *b, CagVec3 *middle) {
  for (double far = h; far < m->step_most; far *= 2) {
    if (try_step(m, a, far, true, b, middle) == STEPPED &&
        cag_norm(cag_sub(b->x, cag_madd(a->x, far, a->tangent))) < far / 4)
      return true;
    if (m->status) return false;
  }
  return false;
}

// Newton's method may fail beside a pole, where parameters turn fast, though nothing ends there.
static bool is_near_pole(const March *m, CagVec3 x, double reach) {
  for (int k = 0; k < 2; k++) {
    const CagSurface *s = m->side[k].s;
    const double u[4] = {s->u0, s->u1, (s->u0 + s->u1) / 2, (s->u0 + s->u1) / 2};
    const double v[4] = {(s->v0 + s->v1) / 2, (s->v0 + s->v1) / 2, s->v0, s->v1};
    const bool pole[4] = {s->pole_u0, s->pole_u1, s->pole_v0, s->pole_v1};
    for (int i = 0; i < 4; i++) {
      CagVec3 p;
      CagError ignored;
      if (pole[i] && cag_surface_point(s, u[i], v[i], &p, &ignored) == CAG_OK &&
          cag_norm(cag_sub(p, x)) <= reach)
        return true;
    }
  }
  return false;
}

// A surface ends before h: the last place is found by halving and takes the place of a last node
// that is as near as none.
static bool add_end(March *m, Run *run, double h) {
  const int halvings = 60;
  Node a = run->nodes[run->n - 1], last = a;
  double low = 0, high = h;
  CagVec3 middle;
  for (int i = 0; i < halvings && high - low > SAME * m->size; i++) {
    Node b;
    double half = (low + high) / 2;
    Step step = try_step(m, &a, half, true, &b, &middle);
    if (step == BROKEN) return false;
    if (step == STEPPED) low = half, last = b;
    else high = half;
  }
  if (low == 0) return true;
  if (low < JOINED * m->size && run->n > 1) {
    run->nodes[run->n - 1] = last;
    return true;
  }
  Node between = a;
  middle = hermite(&a, &last, 0.5);
  if (locate(m, middle, cag_unit(cag_sub(last.x, a.x)), a.tangent, &between) == FOUND)
    middle = between.x;
  return m->status == CAG_OK && add_node(m, run, &last, middle);
}

// Goes on from the last node until the run ends or is closed.
static bool go_on(March *m, Run *run) {
  double h = m->step_first, least = STEP_LEAST * m->size;
  while (run->n < NODES_MOST) {
    if (m->interrupt && *m->interrupt)
      return fail(m, cag_fail(m->err, CAG_E_CALLBACK, "interrupted", "", -1, "stopped"));
    Node a = run->nodes[run->n - 1], b;
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
        return m->status == CAG_OK && (step != ENDED || add_end(m, run, h));
    }
    if (comes_home(m, run, &a, &b)) {
      // The last piece ends in the start itself.
      Node home = run->nodes[0], between = a;
      CagVec3 d = cag_sub(home.x, a.x), guess = hermite(&a, &home, 0.5);
      run->closed = true;
      if (cag_norm(d) <= 16 * least) {
        run->nodes[run->n - 1] = home;
        return true;
      }
      if (locate(m, guess, cag_unit(d), a.tangent, &between) == FOUND) guess = between.x;
      return m->status == CAG_OK && add_node(m, run, &home, guess);
    }
    if (!add_node(m, run, &b, middle)) return m->status == CAG_OK;
    h = fmin(1.4 * h, m->step_most);
  }
  return true;
}

static void turn_round(Run *run) {
  for (size_t i = 0; i < run->n / 2; i++) {
    Node swap = run->nodes[i];
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

static bool trace(March *m, const Node *seed, Run *run) {
  if (!add_node(m, run, seed, seed->x) || !go_on(m, run)) return m->status == CAG_OK;
  if (run->closed) return true;
  turn_round(run);
  return go_on(m, run);
}

// --- Seeds ---

// Parameters of a triangle's corners, brought together where they lie at both sides of a seam.
static void corner_parameters(const Side *side, const uint32_t *corner, double out[3][2]) {
  const CagSurface *s = side->s;
  const double range[2] = {s->u1 - s->u0, s->v1 - s->v0};
  const bool closed[2] = {s->closed_u, s->closed_v};
  for (int d = 0; d < 2; d++) {
    double high = -INFINITY;
    for (int k = 0; k < 3; k++) {
      out[k][d] = side->mesh->uv[2 * corner[k] + (size_t)d];
      high = fmax(high, out[k][d]);
    }
    for (int k = 0; closed[d] && k < 3; k++)
      if (high - out[k][d] > range[d] / 2) out[k][d] += range[d];
  }
}

typedef struct Facet {
  CagVec3 p[3];
  double at[3][2];
  CagBounds box;
} Facet;

static Facet facet_of(const Side *side, size_t i) {
  Facet f = {.box = CAG_BOUNDS_EMPTY};
  const uint32_t *corner = side->mesh->triangles + 3 * i;
  for (int k = 0; k < 3; k++) {
    f.p[k] = side->mesh->positions[corner[k]];
    cag_bounds_add(&f.box, f.p[k]);
  }
  corner_parameters(side, corner, f.at);
  return f;
}

// Where the edges of f pass through g: adds points with the parameters on both to the sum.
static int pierce(const Facet *f, const Facet *g, int which, Node *sum) {
  CagVec3 e1 = cag_sub(g->p[1], g->p[0]), e2 = cag_sub(g->p[2], g->p[0]), n = cag_cross(e1, e2);
  double nn = cag_dot(n, n);
  int count = 0;
  if (nn == 0) return 0;
  for (int k = 0; k < 3; k++) {
    int l = (k + 1) % 3;
    double h0 = cag_dot(n, cag_sub(f->p[k], g->p[0])), h1 = cag_dot(n, cag_sub(f->p[l], g->p[0]));
    if ((h0 < 0) == (h1 < 0)) continue;
    double t = h0 / (h0 - h1);
    CagVec3 x = cag_lerp(f->p[k], f->p[l], t), r = cag_sub(x, g->p[0]);
    double b = cag_dot(cag_cross(r, e2), n) / nn, c = cag_dot(cag_cross(e1, r), n) / nn;
    const double slack = 1e-9;
    if (b < -slack || c < -slack || b + c > 1 + slack) continue;
    for (int d = 0; d < 2; d++) {
      sum->at[which][d] += f->at[k][d] + t * (f->at[l][d] - f->at[k][d]);
      sum->at[1 - which][d] +=
          g->at[0][d] + b * (g->at[1][d] - g->at[0][d]) + c * (g->at[2][d] - g->at[0][d]);
    }
    sum->x = cag_add(sum->x, x);
    count++;
  }
  return count;
}

// The corners of f that lie on g, for facets of one plane: of a piece in common.
static int rest(const Facet *f, const Facet *g, int which, Node *sum) {
  CagVec3 e1 = cag_sub(g->p[1], g->p[0]), e2 = cag_sub(g->p[2], g->p[0]), n = cag_cross(e1, e2);
  double nn = cag_dot(n, n), flat = 1e-9 * sqrt(sqrt(nn));
  int count = 0;
  if (nn == 0) return 0;
  for (int k = 0; k < 3; k++) {
    CagVec3 r = cag_sub(f->p[k], g->p[0]);
    if (fabs(cag_dot(n, r)) > flat * sqrt(nn)) return 0;
    double b = cag_dot(cag_cross(r, e2), n) / nn, c = cag_dot(cag_cross(e1, r), n) / nn;
    if (b < 0 || c < 0 || b + c > 1) continue;
    for (int d = 0; d < 2; d++) {
      sum->at[which][d] += f->at[k][d];
      sum->at[1 - which][d] +=
          g->at[0][d] + b * (g->at[1][d] - g->at[0][d]) + c * (g->at[2][d] - g->at[0][d]);
    }
    sum->x = cag_add(sum->x, f->p[k]);
    count++;
  }
  return count;
}

static double into(double x, double low, double high, bool closed) {
  if (closed && x > high) x -= high - low;
  return fmin(fmax(x, low), high);
}

static bool add_seed(March *m, const Facet *f, const Facet *g) {
  Node sum = {0};
  int count = pierce(f, g, 0, &sum) + pierce(g, f, 1, &sum);
  if (count == 0) count = rest(f, g, 0, &sum) + rest(g, f, 1, &sum);
  if (count == 0) return true;
  for (int k = 0; k < 2; k++) {
    const CagSurface *s = m->side[k].s;
    sum.at[k][0] = into(sum.at[k][0] / count, s->u0, s->u1, s->closed_u);
    sum.at[k][1] = into(sum.at[k][1] / count, s->v0, s->v1, s->closed_v);
  }
  sum.x = cag_scaled(sum.x, 1.0 / count);
  if (m->seed_count == m->seed_capacity) {
    size_t capacity = m->seed_capacity ? 2 * m->seed_capacity : 256;
    Node *grown = realloc(m->seeds, capacity * sizeof *grown);
    if (!grown) return fail(m, cag_fail_memory(m->err));
    m->seeds = grown;
    m->seed_capacity = capacity;
  }
  m->seeds[m->seed_count++] = sum;
  return true;
}

static bool apart(const CagBounds *a, const CagBounds *b) {
  return a->min.x > b->max.x || b->min.x > a->max.x || a->min.y > b->max.y || b->min.y > a->max.y ||
         a->min.z > b->max.z || b->min.z > a->max.z;
}

static int by_low(const void *a, const void *b) {
  const Facet *x = a, *y = b;
  return (x->box.min.x > y->box.min.x) - (x->box.min.x < y->box.min.x);
}

static double low_of(const Facet *f) { return f->box.min.x; }

// All pairs of triangles whose boxes meet, swept along x.
static bool find_seeds(March *m) {
  Facet *list[2] = {NULL, NULL};
  size_t n[2], first = 0;
  bool ok = true;
  for (int k = 0; k < 2; k++) {
    n[k] = m->side[k].mesh->triangle_count;
    list[k] = malloc((n[k] + 1) * sizeof *list[k]);
    ok = ok && list[k];
    for (size_t i = 0; ok && i < n[k]; i++) list[k][i] = facet_of(&m->side[k], i);
    if (ok && n[k]) qsort(list[k], n[k], sizeof *list[k], by_low);
  }
  if (!ok) fail(m, cag_fail_memory(m->err));
  // The longest reach along x of a facet of the second tells how far back others may begin.
  double reach = 0;
  for (size_t i = 0; ok && i < n[1]; i++)
    reach = fmax(reach, list[1][i].box.max.x - list[1][i].box.min.x);
  for (size_t i = 0; ok && i < n[0]; i++) {
    const Facet *f = &list[0][i];
    while (first < n[1] && low_of(&list[1][first]) < f->box.min.x - reach) first++;
    for (size_t j = first; ok && j < n[1] && low_of(&list[1][j]) <= f->box.max.x; j++)
      if (!apart(&f->box, &list[1][j].box)) ok = add_seed(m, f, &list[1][j]);
  }
  free(list[0]);
  free(list[1]);
  return ok;
}

// Whether the place lies on the run.
static bool lies_on(const March *m, const Run *run, CagVec3 x) {
  double near = 8 * m->tolerance + JOINED * m->size;
  for (size_t i = 0; i + 1 < run->n; i++) {
    const Node *a = &run->nodes[i], *b = &run->nodes[i + 1];
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

// --- Curves ---

static bool add_curve(March *m, const Run *run, size_t first, size_t last, bool closed,
                      CagCurveList *out) {
  size_t n = last - first + 1;
  // What a seed at a pole or at a corner of an outline leaves.
  double reach = 0;
  for (size_t i = first; i <= last; i++)
    reach = fmax(reach, cag_norm(cag_sub(run->nodes[i].x, run->nodes[first].x)));
  if (n < 2 || reach <= JOINED * m->size) return true;
  CagTrace t = {.count = n, .check_count = n - 1, .closed = closed};
  t.points = malloc(n * sizeof *t.points);
  t.tangents = malloc(n * sizeof *t.tangents);
  t.checks = malloc(n * sizeof *t.checks);
  bool ok = t.points && t.tangents && t.checks;
  if (!ok) fail(m, cag_fail_memory(m->err));
  for (size_t i = 0; ok && i < n; i++) {
    t.points[i] = run->nodes[first + i].x;
    t.tangents[i] = run->nodes[first + i].tangent;
    if (i + 1 < n) t.checks[i] = run->middles[first + i];
  }
  CagCurve *curve = NULL;
  CagStatus status = ok ? cag_trace_curve(&t, NULL, m->size, &curve, m->err) : CAG_OK;
  if (ok && !status) status = cag_curve_list_add(out, curve, m->err);
  free(t.points);
  free(t.tangents);
  free(t.checks);
  return ok && (status == CAG_OK || fail(m, status));
}

// The place between two nodes at which the run leaves an outline; `inside` belongs.
static bool find_border(March *m, Node inside, Node outside, Node *out) {
  const int halvings = 48;
  for (int i = 0; i < halvings; i++) {
    CagVec3 d = cag_sub(outside.x, inside.x);
    if (cag_norm(d) <= SAME * m->size) break;
    Node half = inside;
    if (locate(m, hermite(&inside, &outside, 0.5), cag_unit(d), inside.tangent, &half) != FOUND)
      break;
    if (belongs(m, &half)) inside = half;
    else outside = half;
    if (m->status) return false;
  }
  *out = inside;
  return m->status == CAG_OK;
}

// The parts of a run that lie within the outlines.
static bool add_parts(March *m, const Run *run, CagCurveList *out) {
  if (!m->side[0].region && !m->side[1].region)
    return add_curve(m, run, 0, run->n - 1, run->closed, out);
  Run part = {0};
  bool ok = true, whole = run->closed, was = false;
  for (size_t i = 0; ok && i < run->n; i++) {
    const Node *node = &run->nodes[i];
    bool is = belongs(m, node);
    Node border;
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
  free(part.nodes);
  free(part.middles);
  return ok;
}

// --- The whole ---

// Whether a place of the first surface, beside one where they touch, lies on the second; `known`:
// whether there is such a place.
static bool is_shared(March *m, const double at[2], bool *known, bool *out) {
  const CagSurface *a = m->side[0].s;
  const Node place = {.at = {{at[0], at[1]}}};
  const double low[2] = {a->u0, a->v0}, high[2] = {a->u1, a->v1};
  bool inside = true;
  *known = false;
  for (int d = 0; d < 2; d++)
    if (!(at[d] >= low[d] && at[d] <= high[d])) return true;
  if (!belongs_to(m, 0, &place, &inside) || !inside) return m->status == CAG_OK;
  CagVec3 p;
  CagSurfaceNearest nearest;
  CagStatus status = cag_surface_point(a, at[0], at[1], &p, m->err);
  if (!status) status = cag_surface_closest(m->side[1].s, p, &nearest, m->err);
  if (status) return fail(m, status);
  *known = true;
  *out = nearest.distance <= COMMON * m->size;
  return true;
}

// Whether the surfaces are one all about a place where they touch, not along lines only. Two lines
// along which surfaces touch or cross may meet there: so it is tried in many directions, and as far
// away as surfaces part that touch to the third order.
static bool is_common(March *m, const Node *node, bool *out) {
  enum { DIRECTIONS = 10, RINGS = 2 };
  Tangential t;
  int tried = 0;
  *out = false;
  if (!look(m, 0, node->at[0], &t)) return false;
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

// The places that touch are looked at, up to some hundred of them.
static bool find_common(March *m, bool *out) {
  const size_t looks = 100;
  size_t found = 0, every = m->touching / looks + 1;
  *out = false;
  for (size_t i = 0; !*out && i < m->seed_count; i++) {
    Node seed = m->seeds[i];
    const CagVec3 none = {0, 0, 0};
    Found how = locate(m, seed.x, none, none, &seed);
    if (how == FAILED) return false;
    if (how == TANGENT && found++ % every == 0 && !is_common(m, &seed, out)) return false;
  }
  return true;
}

static bool march_all(March *m, CagCurveList *out) {
  Run *runs = NULL;
  size_t n = 0, capacity = 0;
  bool ok = true;
  for (size_t i = 0; ok && i < m->seed_count; i++) {
    Node seed = m->seeds[i];
    CagVec3 none = {0, 0, 0};
    Found found = locate(m, seed.x, none, none, &seed);
    if (found == FAILED) ok = false;
    if (found == TANGENT) m->touching++;
    if (found != FOUND) continue;
    bool known = false;
    for (size_t k = 0; !known && k < n; k++) known = lies_on(m, &runs[k], seed.x);
    if (known) continue;
    Run run = {0};
    ok = trace(m, &seed, &run);
    if (n == capacity) {
      capacity = capacity ? 2 * capacity : 8;
      Run *grown = realloc(runs, capacity * sizeof *grown);
      if (!grown) {
        free(run.nodes);
        free(run.middles);
        ok = fail(m, cag_fail_memory(m->err));
        break;
      }
      runs = grown;
    }
    runs[n++] = run;
  }
  for (size_t i = 0; ok && i < n; i++) ok = add_parts(m, &runs[i], out);
  for (size_t i = 0; i < n; i++) {
    free(runs[i].nodes);
    free(runs[i].middles);
  }
  free(runs);
  return ok;
}

static CagStatus prepare(March *m, const CagSurface *a, const CagSurface *b, double tolerance,
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
  m->step_most = STEP_MOST * smaller;
  m->step_first = STEP_FIRST * smaller;
  if (!status && !(m->size <= APART_MOST * smaller))
    return smaller > 0
               ? cag_fail(
                     err, CAG_E_UNSUPPORTED, "sizes-apart", "A", -1,
                     "one of the surfaces is %.3g mm large, the other %.3g mm: trim the larger "
                     "one to what lies about the other",
                     m->size, smaller)
               : CAG_OK;
  for (int k = 0; !status && k < 2; k++) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    how.tolerance = SEED_MESH * smaller;
    // Where it is the larger one, as fine as it would be alone.
    how.max_edge = fmax(SEED_EDGE * smaller, size[k] / 200);
    how.max_triangles = SEED_TRIANGLES;
    how.interrupt = m->interrupt;
    status = cag_surface_tessellate(s[k], &how, &m->side[k].mesh, err);
  }
  return status;
}

CagStatus cag_surface_intersect(const CagSurface *a, const CagSurface *b, double tolerance,
                                const volatile int *interrupt, CagCurveList *out, CagError *err) {
  March m = {.interrupt = interrupt, .err = err};
  CagStatus status = prepare(&m, a, b, tolerance, err);
  size_t first = out->count;
  if (!status && !m.side[0].mesh) return CAG_OK; // one is a point
  if (!status && (!find_seeds(&m) || !march_all(&m, out))) status = m.status;
  bool common = false;
  if (!status && m.touching && !find_common(&m, &common)) status = m.status;
  if (!status && common)
    status = cag_fail(err, CAG_E_DEGENERATE, "overlap", "", -1,
                      "the surfaces share a piece: they meet in more than curves");
  if (!status) status = cag_curve_list_join(out, first, JOINED * m.size, err);
  for (int k = 0; k < 2; k++) cag_mesh_release(m.side[k].mesh);
  free(m.seeds);
  return status;
}
