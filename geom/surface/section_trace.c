// Curves on which a function of a surface is 0, traced in the parameter plane.
//
// The parameter rectangle is cut into cells, each crossing of a cell's edge is found to rounding,
// and the crossings are linked cell by cell. A value of 0 counts as positive, so that curves along
// the grid, seams and poles need no care: they run along the side of the cells that are negative,
// and points that coincide in space are dropped. Between two crossings points are added until
// Hermite cubics are within the tolerance.

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "geom/surface/family.h"
#include "geom/surface/section.h"
#include "geom/surface/trimmed.h"

// Cells along the whole of a direction, and at least so many between two breaks.
#define CELLS 40
#define CELLS_BETWEEN_BREAKS 4
#define CELLS_MOST 400
// Grid lines added for loops smaller than a cell.
#define FOLLOWED_MOST 32
// Halvings between two crossings.
#define DEPTH_MOST 12
// A run that crosses fewer edges than this is halved so often whatever the error, so that there are
// points to judge its kind by.
#define SHORT_RUN 4
#define SHORT_RUN_DEPTH 2
// cos 30 degrees: a tangent turns by no more from one point to the next.
#define TURN_COSINE 0.866
// cos 40 degrees: where chords turn by more, a run has a corner.
#define CORNER_COSINE 0.766
// Parts of the size below which points are one.
#define SAME 1e-10
// A place has no tangent where its two parts cancel to this part, or the function changes by less
// than so many roundings over the whole surface.
#define FLAT 1e-9
#define FLAT_ROUNDINGS 1e4
#define SLID 1e-5
#define ROOT_ROUNDS 80
#define NEWTON_ROUNDS 12

typedef struct Node {
  double u, v;
  CagVec3 p, t;
  bool regular;   // t is the tangent
  bool branching; // two branches cross there
} Node;

typedef struct Tracer {
  const CagSurface *s;
  const CagLevel *level;
  const CagRegion *region; // of a trimmed surface; NULL: all of the rectangle belongs to it
  double tolerance, size;
  double *lines[2];
  size_t n[2]; // grid lines
  size_t cells;
  double *values;
  // Crossings of the edges along u (first) and along v.
  size_t edge_count;
  Node *crossings;
  int32_t (*links)[2];
  // The run being refined.
  Node *run;
  CagVec3 *checks;
  size_t run_count, run_capacity, check_count, check_capacity;
  CagStatus status;
  CagError *err;
} Tracer;

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
  CagLevel l = {1, plane_value, plane->point, plane->normal, false, rounding * size, 0};
  return l;
}

static double contour_value(const CagLevel *l, const CagVec3 *d, int n, double *gradient) {
  CagVec3 su = d[cag_partial(n, 1, 0)], sv = d[cag_partial(n, 0, 1)], normal = cag_cross(su, sv);
  CagVec3 sight = l->central ? cag_sub(d[0], l->point) : l->direction;
  if (gradient) {
    // The line of sight changes within the tangent plane: only the normal counts.
    CagVec3 suu = d[cag_partial(n, 2, 0)], suv = d[cag_partial(n, 1, 1)],
            svv = d[cag_partial(n, 0, 2)];
    gradient[0] = cag_dot(cag_add(cag_cross(suu, sv), cag_cross(su, suv)), sight);
    gradient[1] = cag_dot(cag_add(cag_cross(suv, sv), cag_cross(su, svv)), sight);
  }
  return cag_dot(normal, sight);
}

CagLevel cag_level_contour(CagVec3 direction, CagVec3 point, bool central) {
  CagLevel l = {2, contour_value, point, direction, central, 0, 0};
  return l;
}

static bool partials_at(Tracer *t, double u, double v, int n, CagVec3 *d) {
  if (t->status) return false;
  CagSide su = u >= t->s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  CagSide sv = v >= t->s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  t->status = cag_surface_eval(t->s, u, v, n, su, sv, d, t->err);
  return t->status == CAG_OK;
}

static double value_at(Tracer *t, double u, double v) {
  CagVec3 d[9] = {0};
  int n = t->level->order - 1;
  return partials_at(t, u, v, n, d) ? t->level->value(t->level, d, n, NULL) : 0;
}

static double settled(const Tracer *t, double f) { return fabs(f) <= t->level->zero ? 0 : f; }

// Point and tangent at the node's parameters; gives the value and its gradient.
static double inspect(Tracer *t, Node *node, double gradient[2]) {
  CagVec3 d[9] = {0};
  int n = t->level->order;
  gradient[0] = gradient[1] = 0;
  node->regular = false;
  if (!partials_at(t, node->u, node->v, n, d)) return 0;
  double f = t->level->value(t->level, d, n, gradient);
  CagVec3 su = d[cag_partial(n, 1, 0)], sv = d[cag_partial(n, 0, 1)];
  CagVec3 along = cag_madd(cag_scaled(su, -gradient[1]), gradient[0], sv);
  double magnitude = fabs(gradient[1]) * cag_norm(su) + fabs(gradient[0]) * cag_norm(sv);
  double level =
      fabs(gradient[0]) * (t->s->u1 - t->s->u0) + fabs(gradient[1]) * (t->s->v1 - t->s->v0);
  node->p = d[0];
  node->regular = cag_norm(along) > FLAT * magnitude && level > FLAT_ROUNDINGS * t->level->zero;
  node->t = node->regular ? cag_unit(along) : cag_vec3(0, 0, 0);
  return f;
}

// --- The grid ---

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static bool make_lines(Tracer *t, int direction, size_t cells, const double *extra,
                       size_t extra_count) {
  const CagSurface *s = t->s;
  double lo = direction ? s->v0 : s->u0, hi = direction ? s->v1 : s->u1;
  size_t inner = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  size_t between = cells / (inner + 1);
  if (between < CELLS_BETWEEN_BREAKS) between = CELLS_BETWEEN_BREAKS;
  if (between * (inner + 1) > CELLS_MOST) between = CELLS_MOST / (inner + 1) + 1;
  double *ends = malloc((inner + 2) * sizeof *ends);
  double *lines = malloc(((inner + 1) * between + 1 + extra_count) * sizeof *lines);
  if (ends && lines) {
    ends[0] = lo;
    if (inner > 0) s->kind->breaks(s, direction, ends + 1, inner);
    ends[inner + 1] = hi;
    size_t n = 0;
    for (size_t i = 0; i <= inner; i++)
      for (size_t k = 0; k < between; k++)
        lines[n++] = ends[i] + (ends[i + 1] - ends[i]) * (double)k / (double)between;
    lines[n++] = hi;
    for (size_t i = 0; i < extra_count; i++) lines[n++] = extra[i];
    qsort(lines, n, sizeof *lines, by_size);
    // Lines that are all but one are one.
    size_t kept = 1;
    for (size_t i = 1; i < n; i++)
      if (lines[i] - lines[kept - 1] > 1e-9 * (hi - lo)) lines[kept++] = lines[i];
    lines[kept - 1] = hi;
    t->n[direction] = kept;
  }
  free(ends);
  free(t->lines[direction]);
  t->lines[direction] = lines;
  return ends && lines;
}

static double *value_of(const Tracer *t, size_t i, size_t j) { return &t->values[j * t->n[0] + i]; }

static bool fill_values(Tracer *t) {
  free(t->values);
  t->values = malloc(t->n[0] * t->n[1] * sizeof *t->values);
  if (!t->values) return false;
  for (size_t j = 0; j < t->n[1] && !t->status; j++)
    for (size_t i = 0; i < t->n[0] && !t->status; i++)
      *value_of(t, i, j) = settled(t, value_at(t, t->lines[0][i], t->lines[1][j]));
  return t->status == CAG_OK;
}

// A contour's values have no unit of their own: their largest tells what is rounding.
static double largest_value(const Tracer *t) {
  double largest = 0;
  for (size_t k = 0; k < t->n[0] * t->n[1]; k++) largest = fmax(largest, fabs(t->values[k]));
  return largest;
}

// How far the function is within some cells from what the corners promise, as a part of its largest
// value: near 1 where it goes up and down within a cell. The places are at no simple fraction of
// the cells, where a wave could hide.
static double roughness(Tracer *t) {
  const size_t tried = 8;
  const double x = 0.3719, y = 0.6173;
  double worst = 0, largest = largest_value(t);
  for (size_t a = 0; a < tried; a++)
    for (size_t b = 0; b < tried && !t->status; b++) {
      size_t i = a * (t->n[0] - 2) / (tried - 1), j = b * (t->n[1] - 2) / (tried - 1);
      const double *u = &t->lines[0][i], *v = &t->lines[1][j];
      double low = (1 - x) * *value_of(t, i, j) + x * *value_of(t, i + 1, j);
      double high = (1 - x) * *value_of(t, i, j + 1) + x * *value_of(t, i + 1, j + 1);
      double f = value_at(t, u[0] + x * (u[1] - u[0]), v[0] + y * (v[1] - v[0]));
      worst = fmax(worst, fabs(f - ((1 - y) * low + y * high)));
      largest = fmax(largest, fabs(f));
    }
  return largest > 0 ? worst / largest : 0;
}

// Twice as fine until the function is smooth from one line to the next.
static bool make_grid(Tracer *t) {
  const double smooth = 0.1;
  for (t->cells = CELLS;; t->cells *= 2) {
    if (!make_lines(t, 0, t->cells, NULL, 0) || !make_lines(t, 1, t->cells, NULL, 0) ||
        !fill_values(t))
      return false;
    if (2 * t->cells > CELLS_MOST || roughness(t) <= smooth) return t->status == CAG_OK;
  }
}

static double inside(double x, double lo, double hi) { return fmin(fmax(x, lo), hi); }

// Goes from the node by Newton's method, within hu and hv of it, to where the gradient vanishes.
// The determinant of the second derivatives is told: negative at a saddle.
static bool go_to_critical(Tracer *t, Node *node, double hu, double hv, double *bend,
                           double *determinant) {
  const double part = 1e-3;
  const int rounds = 8;
  double u = node->u, v = node->v;
  for (int round = 0; round < rounds; round++) {
    double g[2], gu[2], gv[2];
    double du = node->u + part * hu > t->s->u1 ? -part * hu : part * hu;
    double dv = node->v + part * hv > t->s->v1 ? -part * hv : part * hv;
    Node beside = *node;
    inspect(t, node, g);
    beside.u += du;
    inspect(t, &beside, gu);
    beside = *node;
    beside.v += dv;
    inspect(t, &beside, gv);
    double a = (gu[0] - g[0]) / du, b = (gu[1] - g[1]) / du, c = (gv[1] - g[1]) / dv;
    *bend = a;
    *determinant = a * c - b * b;
    if (t->status || !(fabs(*determinant) > 0)) return false;
    double su = (c * g[0] - b * g[1]) / *determinant, sv = (a * g[1] - b * g[0]) / *determinant;
    node->u = inside(node->u - su, fmax(u - hu, t->s->u0), fmin(u + hu, t->s->u1));
    node->v = inside(node->v - sv, fmax(v - hv, t->s->v0), fmin(v + hv, t->s->v1));
  }
  return true;
}

// Follows the function from a node where it is nearest to 0 among its neighbours; true where it
// has the other sign at its extremum.
static bool follow(Tracer *t, size_t i, size_t j, double *u, double *v) {
  double sign = *value_of(t, i, j) < 0 ? -1 : 1, bend, determinant;
  Node here = {.u = t->lines[0][i], .v = t->lines[1][j]};
  double hu = fmin(t->lines[0][i + 1] - here.u, here.u - t->lines[0][i - 1]);
  double hv = fmin(t->lines[1][j + 1] - here.v, here.v - t->lines[1][j - 1]);
  if (!go_to_critical(t, &here, hu, hv, &bend, &determinant)) return false;
  *u = here.u;
  *v = here.v;
  return determinant > 0 && bend * sign > 0 && settled(t, value_at(t, here.u, here.v)) * sign < 0;
}

static bool nearest_to_zero(const Tracer *t, size_t i, size_t j) {
  double f = *value_of(t, i, j), sign = f < 0 ? -1 : 1;
  for (int di = -1; di <= 1; di++)
    for (int dj = -1; dj <= 1; dj++)
      if (*value_of(t, i + (size_t)di, j + (size_t)dj) * sign < f * sign) return false;
  return f != 0;
}

static bool add_small_loops(Tracer *t) {
  double us[FOLLOWED_MOST], vs[FOLLOWED_MOST];
  size_t n = 0;
  for (size_t j = 1; j + 1 < t->n[1] && n < FOLLOWED_MOST; j++)
    for (size_t i = 1; i + 1 < t->n[0] && n < FOLLOWED_MOST && !t->status; i++)
      if (nearest_to_zero(t, i, j) && follow(t, i, j, &us[n], &vs[n])) n++;
  if (n == 0) return t->status == CAG_OK;
  return make_lines(t, 0, t->cells, us, n) && make_lines(t, 1, t->cells, vs, n) && fill_values(t);
}

// --- Crossings ---

static size_t edge_along_u(const Tracer *t, size_t i, size_t j) { return j * (t->n[0] - 1) + i; }
static size_t edge_along_v(const Tracer *t, size_t i, size_t j) {
  return (t->n[0] - 1) * t->n[1] + i * (t->n[1] - 1) + j;
}

static bool negative(double f) { return f < 0; }

// The zero between two nodes, of which one is negative: false position with halved weights (the
// Illinois variant), which keeps it bracketed.
static void find_crossing(Tracer *t, double u0, double v0, double f0, double u1, double v1,
                          double f1, Node *out) {
  double a = 0, b = 1, fa = f0, fb = f1, x = f0 == 0 ? 0 : f1 == 0 ? 1 : f0 / (f0 - f1);
  for (int round = 0; f0 != 0 && f1 != 0 && round < ROOT_ROUNDS && b - a > DBL_EPSILON; round++) {
    x = a + (b - a) * fa / (fa - fb);
    if (!(x > a && x < b)) x = (a + b) / 2;
    double f = settled(t, value_at(t, u0 + x * (u1 - u0), v0 + x * (v1 - v0)));
    if (f == 0 || t->status) break;
    bool left = negative(f) == negative(fa);
    if (left) {
      a = x;
      fa = f;
      fb /= 2;
    } else {
      b = x;
      fb = f;
      fa /= 2;
    }
    // Every third round halves the bracket, whatever the function looks like.
    if (round % 3 == 2) {
      double m = (a + b) / 2, fm = value_at(t, u0 + m * (u1 - u0), v0 + m * (v1 - v0));
      if (negative(fm) == negative(f0)) {
        a = m;
        fa = fm;
      } else {
        b = m;
        fb = fm;
      }
    }
  }
  double gradient[2];
  out->u = u0 + x * (u1 - u0);
  out->v = v0 + x * (v1 - v0);
  inspect(t, out, gradient);
}

static void cross_edge(Tracer *t, size_t edge, size_t i0, size_t j0, size_t i1, size_t j1) {
  double f0 = *value_of(t, i0, j0), f1 = *value_of(t, i1, j1);
  t->links[edge][0] = t->links[edge][1] = -1;
  if (negative(f0) != negative(f1))
    find_crossing(t, t->lines[0][i0], t->lines[1][j0], f0, t->lines[0][i1], t->lines[1][j1], f1,
                  &t->crossings[edge]);
}

static void link_pair(Tracer *t, size_t a, size_t b) {
  t->links[a][t->links[a][0] >= 0] = (int32_t)b;
  t->links[b][t->links[b][0] >= 0] = (int32_t)a;
}

static void link_cell(Tracer *t, size_t i, size_t j) {
  const bool corner[4] = {negative(*value_of(t, i, j)), negative(*value_of(t, i + 1, j)),
                          negative(*value_of(t, i + 1, j + 1)), negative(*value_of(t, i, j + 1))};
  // In the order of the corners: the edge from each to the next.
  const size_t edge[4] = {edge_along_u(t, i, j), edge_along_v(t, i + 1, j),
                          edge_along_u(t, i, j + 1), edge_along_v(t, i, j)};
  size_t crossed[4], n = 0;
  for (int k = 0; k < 4; k++)
    if (corner[k] != corner[(k + 1) % 4]) crossed[n++] = edge[k];
  if (n == 2) link_pair(t, crossed[0], crossed[1]);
  if (n != 4) return;
  double middle = value_at(t, (t->lines[0][i] + t->lines[0][i + 1]) / 2,
                           (t->lines[1][j] + t->lines[1][j + 1]) / 2);
  // The middle joins the two corners of its sign; the others are cut off.
  bool with_first = negative(middle) == corner[0];
  link_pair(t, edge[0], edge[with_first ? 1 : 3]);
  link_pair(t, edge[2], edge[with_first ? 3 : 1]);
}

static bool find_crossings(Tracer *t) {
  size_t nu = t->n[0], nv = t->n[1];
  t->edge_count = (nu - 1) * nv + nu * (nv - 1);
  t->crossings = calloc(t->edge_count, sizeof *t->crossings);
  t->links = malloc(t->edge_count * sizeof *t->links);
  if (!t->crossings || !t->links) return false;
  for (size_t j = 0; j < nv; j++)
    for (size_t i = 0; i + 1 < nu; i++) cross_edge(t, edge_along_u(t, i, j), i, j, i + 1, j);
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j + 1 < nv; j++) cross_edge(t, edge_along_v(t, i, j), i, j, i, j + 1);
  for (size_t j = 0; j + 1 < nv; j++)
    for (size_t i = 0; i + 1 < nu; i++) link_cell(t, i, j);
  return t->status == CAG_OK;
}

// --- Refinement ---

static bool add_node(Tracer *t, const Node *node) {
  if (t->run_count == t->run_capacity) {
    size_t capacity = t->run_capacity ? 2 * t->run_capacity : 64;
    Node *grown = realloc(t->run, capacity * sizeof *grown);
    if (!grown) return false;
    t->run = grown;
    t->run_capacity = capacity;
  }
  t->run[t->run_count++] = *node;
  return true;
}

static bool add_check(Tracer *t, CagVec3 p) {
  if (t->check_count == t->check_capacity) {
    size_t capacity = t->check_capacity ? 2 * t->check_capacity : 64;
    CagVec3 *grown = realloc(t->checks, capacity * sizeof *grown);
    if (!grown) return false;
    t->checks = grown;
    t->check_capacity = capacity;
  }
  t->checks[t->check_count++] = p;
  return true;
}

// The place of the curve near the middle of two others; false where Newton's method does not lead
// there.
static bool middle_of(Tracer *t, const Node *a, const Node *b, Node *out) {
  double lu = t->s->u1 - t->s->u0, lv = t->s->v1 - t->s->v0;
  double u = (a->u + b->u) / 2, v = (a->v + b->v) / 2;
  double reach = hypot((b->u - a->u) / lu, (b->v - a->v) / lv);
  *out = (Node){.u = u, .v = v};
  for (int round = 0; round < NEWTON_ROUNDS; round++) {
    double g[2], f = inspect(t, out, g);
    if (t->status) return false;
    double x = g[0] * lu, y = g[1] * lv, square = x * x + y * y;
    if (fabs(f) <= t->level->zero) return true;
    if (!(square > 0)) return false;
    double du = lu * f * x / square, dv = lv * f * y / square;
    out->u = inside(out->u - du, t->s->u0, t->s->u1);
    out->v = inside(out->v - dv, t->s->v0, t->s->v1);
    if (hypot((out->u - u) / lu, (out->v - v) / lv) > reach) return false;
    if (hypot(du / lu, dv / lv) <= 4 * DBL_EPSILON) {
      inspect(t, out, g);
      return true;
    }
  }
  return false;
}

static CagVec3 aligned(CagVec3 tangent, CagVec3 chord) {
  return cag_dot(tangent, chord) < 0 ? cag_scaled(tangent, -1) : tangent;
}

// Whether the Hermite cubic from a to b is good: m is a point of the curve between them.
static bool is_good(const Tracer *t, const Node *a, const Node *m, const Node *b) {
  CagVec3 chord = cag_sub(b->p, a->p);
  double h = cag_norm(chord);
  // Where there is no tangent, that of the parabola through the three.
  CagVec3 first = cag_sub(cag_sub(cag_scaled(m->p, 4), cag_scaled(a->p, 3)), b->p);
  CagVec3 last = cag_sub(cag_add(cag_scaled(b->p, 3), a->p), cag_scaled(m->p, 4));
  CagVec3 ta = a->regular ? aligned(a->t, chord) : cag_unit(first);
  CagVec3 tb = b->regular ? aligned(b->t, chord) : cag_unit(last);
  if (cag_dot(ta, tb) < TURN_COSINE) return false;
  CagVec3 middle = cag_madd(cag_scaled(cag_add(a->p, b->p), 0.5), h / 8, cag_sub(ta, tb));
  CagVec3 along = cag_unit(cag_madd(cag_scaled(chord, 1.5 / h), -0.25, cag_add(ta, tb)));
  CagVec3 off = cag_sub(m->p, middle);
  off = cag_madd(off, -cag_dot(off, along), along);
  return cag_norm(off) <= t->tolerance / 2;
}

// Where two branches of the curve cross between a and b: the gradient vanishes there, and the value
// to the rounding of that.
static bool find_branching(Tracer *t, const Node *a, const Node *b, Node *out) {
  const double roundings = 100, reach = 2;
  double lu = t->s->u1 - t->s->u0, lv = t->s->v1 - t->s->v0, bend, determinant;
  double far = reach * hypot((b->u - a->u) / lu, (b->v - a->v) / lv);
  *out = (Node){.u = (a->u + b->u) / 2, .v = (a->v + b->v) / 2};
  if (!go_to_critical(t, out, far * lu, far * lv, &bend, &determinant) || determinant >= 0)
    return false;
  double g[2];
  double f = inspect(t, out, g);
  out->regular = false;
  return !t->status && fabs(f) <= roundings * t->level->zero;
}

// Adds the points after a, b the last of them.
static bool refine(Tracer *t, const Node *a, const Node *b, int depth, int at_least) {
  Node m;
  double same = SAME * t->size;
  bool found = middle_of(t, a, b, &m);
  if (t->status) return false;
  bool together = cag_norm(cag_sub(b->p, a->p)) <= same;
  if (together && (!found || cag_norm(cag_sub(m.p, a->p)) <= same)) return true;
  // By a pole Newton's method may slide into it, to rounding: that is no point between the two.
  double near = fmin(cag_norm(cag_sub(m.p, a->p)), cag_norm(cag_sub(m.p, b->p)));
  if (found && !together && near <= SLID * cag_norm(cag_sub(b->p, a->p))) found = false;
  if (found && !together && at_least <= 0 && is_good(t, a, &m, b))
    return add_check(t, m.p) && add_node(t, b);
  Node branching;
  bool stuck = !found || depth == DEPTH_MOST;
  if (stuck && !a->branching && !b->branching && find_branching(t, a, b, &branching)) {
    branching.branching = true;
    return refine(t, a, &branching, depth / 2, at_least) &&
           refine(t, &branching, b, depth / 2, at_least);
  }
  if (stuck) return add_node(t, b);
  return refine(t, a, &m, depth + 1, at_least - 1) && refine(t, &m, b, depth + 1, at_least - 1);
}

// --- Runs ---

void cag_traces_free(CagTraces *t) {
  for (size_t i = 0; i < t->count; i++) {
    free(t->items[i].points);
    free(t->items[i].tangents);
    free(t->items[i].checks);
  }
  free(t->items);
  *t = (CagTraces){0};
}

static bool add_trace(CagTraces *out, const CagTrace *trace) {
  if (out->count == out->capacity) {
    size_t capacity = out->capacity ? 2 * out->capacity : 8;
    CagTrace *grown = realloc(out->items, capacity * sizeof *grown);
    if (!grown) return false;
    out->items = grown;
    out->capacity = capacity;
  }
  out->items[out->count++] = *trace;
  return true;
}

// Nodes as a trace.
static bool keep_nodes(const Node *nodes, size_t n, const CagVec3 *checks, size_t check_count,
                       CagTraces *out) {
  if (n < 2) return true;
  CagTrace trace = {n,
                    check_count,
                    false,
                    malloc(n * sizeof *trace.points),
                    malloc(n * sizeof *trace.tangents),
                    malloc((check_count + 1) * sizeof *trace.checks)};
  bool ok = trace.points && trace.tangents && trace.checks;
  for (size_t i = 0; ok && i < n; i++) {
    const Node *node = &nodes[i];
    CagVec3 chord = cag_sub(nodes[i + 1 < n ? i + 1 : i].p, nodes[i > 0 ? i - 1 : 0].p);
    trace.points[i] = node->p;
    trace.tangents[i] = node->regular ? aligned(node->t, chord) : cag_vec3(0, 0, 0);
  }
  if (ok && check_count > 0) memcpy(trace.checks, checks, check_count * sizeof *checks);
  ok = ok && add_trace(out, &trace);
  if (!ok) {
    free(trace.points);
    free(trace.tangents);
    free(trace.checks);
  }
  return ok;
}

static bool belongs(Tracer *t, const Node *node) {
  bool inside = false;
  if (!t->status)
    t->status = cag_region_contains(t->region, cag_vec3(node->u, node->v, 0), &inside, t->err);
  return inside;
}

// Where the curve passes the border of the region between a node that belongs and one that does
// not.
static Node border_between(Tracer *t, Node in, Node off) {
  const int halvings = 50;
  for (int i = 0; i < halvings && !t->status; i++) {
    Node m;
    if (!middle_of(t, &in, &off, &m)) break;
    if (belongs(t, &m)) in = m;
    else off = m;
  }
  return in;
}

// The parts of a run of a trimmed surface that belong to it.
static bool keep_trimmed(Tracer *t, size_t from, size_t to, CagTraces *out) {
  Node *part = malloc((to - from + 3) * sizeof *part);
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
  free(part);
  return ok;
}

// Nodes [from, to] of the run. A run in several parts is judged by its points alone.
static bool keep_run(Tracer *t, size_t from, size_t to, CagTraces *out) {
  if (t->region) return keep_trimmed(t, from, to, out);
  bool whole = from == 0 && to + 1 == t->run_count;
  return keep_nodes(t->run + from, to - from + 1, t->checks, whole ? t->check_count : 0, out);
}

static bool is_corner(const Tracer *t, size_t i) {
  if (t->run[i].branching) return true;
  CagVec3 before = cag_unit(cag_sub(t->run[i].p, t->run[i - 1].p));
  CagVec3 after = cag_unit(cag_sub(t->run[i + 1].p, t->run[i].p));
  return cag_dot(before, after) < CORNER_COSINE;
}

// Refines the run through these edges and cuts it at its corners.
static bool keep_path(Tracer *t, const int32_t *path, size_t n, CagTraces *out) {
  t->run_count = t->check_count = 0;
  int at_least = n <= SHORT_RUN ? SHORT_RUN_DEPTH : 0;
  if (!add_node(t, &t->crossings[path[0]])) return false;
  for (size_t k = 1; k < n; k++)
    if (!refine(t, &t->crossings[path[k - 1]], &t->crossings[path[k]], 0, at_least)) return false;
  size_t from = 0;
  for (size_t i = 1; i + 1 < t->run_count; i++)
    if (is_corner(t, i)) {
      if (!keep_run(t, from, i, out)) return false;
      from = i;
    }
  return keep_run(t, from, t->run_count - 1, out);
}

static bool walk(Tracer *t, size_t start, bool *seen, int32_t *path, CagTraces *out) {
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

static bool walk_all(Tracer *t, CagTraces *out) {
  bool *seen = calloc(t->edge_count, sizeof *seen);
  int32_t *path = malloc((t->edge_count + 1) * sizeof *path);
  bool ok = seen && path;
  // Runs that begin at the border first, then those that come back.
  for (int inner = 0; inner < 2; inner++)
    for (size_t e = 0; ok && e < t->edge_count; e++)
      if (!seen[e] && t->links[e][0] >= 0 && (inner || t->links[e][1] < 0))
        ok = walk(t, e, seen, path, out);
  free(seen);
  free(path);
  return ok && t->status == CAG_OK;
}

// --- Runs that go on across a seam ---

static void turn_trace(CagTrace *t) {
  for (size_t i = 0, j = t->count - 1; i < j; i++, j--) {
    CagVec3 p = t->points[i], d = t->tangents[i];
    t->points[i] = t->points[j];
    t->tangents[i] = t->tangents[j];
    t->points[j] = p;
    t->tangents[j] = d;
  }
  for (size_t i = 0; i < t->count; i++) t->tangents[i] = cag_scaled(t->tangents[i], -1);
}

static bool goes_on(const CagTrace *a, const CagTrace *b, double same) {
  CagVec3 p = a->points[a->count - 1];
  if (cag_norm(cag_sub(p, b->points[0])) > same) return false;
  CagVec3 before = cag_unit(cag_sub(p, a->points[a->count - 2]));
  CagVec3 after = cag_unit(cag_sub(b->points[1], b->points[0]));
  return cag_dot(before, after) > CORNER_COSINE;
}

static bool append(CagTrace *a, const CagTrace *b) {
  CagVec3 *points = realloc(a->points, (a->count + b->count) * sizeof *points);
  if (points) a->points = points;
  CagVec3 *tangents = realloc(a->tangents, (a->count + b->count) * sizeof *tangents);
  if (tangents) a->tangents = tangents;
  CagVec3 *checks = realloc(a->checks, (a->check_count + b->check_count + 1) * sizeof *checks);
  if (checks) a->checks = checks;
  if (!points || !tangents || !checks) return false;
  // The first point of b is there already.
  memcpy(points + a->count, b->points + 1, (b->count - 1) * sizeof *points);
  memcpy(tangents + a->count, b->tangents + 1, (b->count - 1) * sizeof *tangents);
  if (b->check_count > 0)
    memcpy(checks + a->check_count, b->checks, b->check_count * sizeof *checks);
  a->count += b->count - 1;
  a->check_count += b->check_count;
  return true;
}

static bool join_pair(CagTraces *t, size_t i, size_t j, double same, bool *joined) {
  CagTrace *a = &t->items[i], *b = &t->items[j];
  for (int turn = 0; turn < 4 && !*joined; turn++) {
    *joined = goes_on(a, b, same);
    if (*joined) break;
    if (turn % 2 == 0) turn_trace(b);
    else turn_trace(a);
  }
  if (!*joined) return true;
  if (!append(a, b)) return false;
  free(b->points);
  free(b->tangents);
  free(b->checks);
  t->items[j] = t->items[--t->count];
  return true;
}

static bool join_traces(CagTraces *t, double same) {
  for (size_t i = 0; i < t->count; i++) {
    bool joined = true;
    while (joined) {
      joined = false;
      for (size_t j = i + 1; j < t->count && !joined; j++)
        if (!join_pair(t, i, j, same, &joined)) return false;
    }
  }
  return true;
}

// Tangents where the function gave none, by the parabola through the neighbours.
static void complete_tangents(CagTrace *t, double same) {
  size_t n = t->count;
  t->closed = n > 3 && cag_norm(cag_sub(t->points[0], t->points[n - 1])) <= same;
  if (t->closed) {
    // Only where it closes smoothly.
    CagVec3 before = cag_unit(cag_sub(t->points[n - 1], t->points[n - 2]));
    CagVec3 after = cag_unit(cag_sub(t->points[1], t->points[0]));
    t->points[n - 1] = t->points[0];
    if (cag_dot(before, after) < CORNER_COSINE) t->closed = false;
    else t->tangents[n - 1] = t->tangents[0];
  }
  for (size_t i = 0; i < n; i++) {
    if (cag_norm(t->tangents[i]) > 0) continue;
    bool first = i == 0 && !t->closed, last = i + 1 == n && !t->closed;
    CagVec3 p = t->points[i];
    CagVec3 before = i > 0 ? t->points[i - 1] : t->points[n - 2];
    CagVec3 after = i + 1 < n ? t->points[i + 1] : t->points[1];
    double a = cag_norm(cag_sub(p, before)), b = cag_norm(cag_sub(after, p));
    CagVec3 d1 = cag_unit(cag_sub(p, before)), d2 = cag_unit(cag_sub(after, p));
    if (first)
      t->tangents[i] = n > 2 && cag_norm(t->tangents[1]) > 0
                           ? cag_unit(cag_sub(cag_scaled(d2, 2), t->tangents[1]))
                           : d2;
    else if (last)
      t->tangents[i] = n > 2 ? cag_unit(cag_sub(cag_scaled(d1, 2), t->tangents[i - 1])) : d1;
    else t->tangents[i] = cag_unit(cag_madd(cag_scaled(d1, b), a, d2));
  }
}

static void tracer_free(Tracer *t) {
  free(t->lines[0]);
  free(t->lines[1]);
  free(t->values);
  free(t->crossings);
  free(t->links);
  free(t->run);
  free(t->checks);
}

CagStatus cag_surface_trace(const CagSurface *s, const CagLevel *level, double tolerance,
                            CagTraces *out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  CagLevel own = *level;
  Tracer t = {.s = s, .level = &own, .tolerance = tolerance, .err = err};
  t.size = cag_norm(cag_sub(box.max, box.min));
  const CagSurface *whole;
  if (!cag_surface_trimmed_view(s, &whole, &t.region)) t.region = NULL;
  *out = (CagTraces){0};
  bool ok = make_grid(&t);
  if (ok && own.zero == 0) {
    const double rounding = 1e-13;
    own.zero = rounding * largest_value(&t);
    ok = fill_values(&t);
  }
  ok = ok && add_small_loops(&t) && find_crossings(&t) && walk_all(&t, out) &&
       join_traces(out, SAME * 10 * t.size);
  for (size_t i = 0; ok && i < out->count; i++)
    complete_tangents(&out->items[i], SAME * 10 * t.size);
  status = ok ? CAG_OK : t.status ? t.status : cag_fail_memory(err);
  tracer_free(&t);
  if (status) cag_traces_free(out);
  return status;
}
