// Curves on which a function of a surface is 0, traced in the parameter plane.
//
// The parameter rectangle is cut into cells, each crossing of a cell's edge is found to rounding,
// and the crossings are linked cell by cell. A value of 0 counts as positive, so that curves along
// the grid, seams and poles need no care: they run along the side of the cells that are negative,
// and points that coincide in space are dropped. Between two crossings points are added until
// Hermite cubics are within the tolerance.
//
// Functions that jump at breaks are traced patch by patch between them; runs that go on smoothly
// from patch to patch are joined.

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "geom/surface/family.h"
#include "geom/surface/level_patch.h"
#include "geom/surface/section.h"
#include "geom/surface/section_join.h"
#include "geom/surface/trimmed.h"

// Cells along the whole of a direction, and at least so many between two breaks.
#define CELLS 40
#define CELLS_BETWEEN_BREAKS 4
#define CELLS_OF_PATCH 10
#define CELLS_MOST 400
// As often as the cells may be halved where the function is rough.
#define HALVINGS_MOST 3
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
// Parts of the size below which points are one.
#define SAME 1e-10
// Part of the size up to which a run beside an area where the function is 0 is what rounding left.
#define BESIDE_LOST 1e-3
// A place has no tangent where its two parts cancel to this part, or the function changes by less
// than so many roundings over the whole surface.
#define FLAT 1e-9
#define FLAT_ROUNDINGS 1e4
// A function that is this many roundings at most is 0 throughout.
#define CONSTANT_ROUNDINGS 100
// Part of the way between two points below which a third is one of them.
#define SLID 1e-5
// A point between two others tells of the cubic's middle only if it is not nearer to one of them
// than this part of the way: by a pole the middle of the parameters may be.
#define LOPSIDED 0.2
#define ROOT_ROUNDS 80
#define NEWTON_ROUNDS 12

typedef struct Node {
  double u, v;
  CagVec3 p, t;
  bool regular;   // t is the tangent
  bool branching; // two branches cross there
  bool flat;      // the function does not change there
} Node;

typedef struct Tracer {
  const CagSurface *s;
  const CagLevel *level;
  CagLevelPatch patch;     // what is traced now: all of the surface where the function is not sided
  const CagRegion *region; // of a trimmed surface; NULL: all of the rectangle belongs to it
  double tolerance, size;
  double zero_beside; // what is rounding beside a pole
  double *lines[2];
  size_t n[2];     // grid lines
  size_t cells[2]; // as many as there were before they were halved
  size_t finer;
  bool torn; // a run has a gap
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
    // The line of sight changes within the tangent plane: only the normal counts.
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

static double value_at(Tracer *t, double u, double v) {
  double f = 0;
  if (!t->status) t->status = cag_patch_value(&t->patch, u, v, &f, NULL, NULL, t->err);
  return f;
}

// What is rounding at this place.
static double zero_at(const Tracer *t, double u, double v) {
  return t->level->sided && cag_patch_is_beside(&t->patch, u, v) ? t->zero_beside : t->level->zero;
}

// The value, 0 where it is rounding.
static double settled_at(Tracer *t, double u, double v) {
  double f = value_at(t, u, v);
  return fabs(f) <= zero_at(t, u, v) ? 0 : f;
}

// Point and tangent at the node's parameters; gives the value and its gradient.
static double inspect(Tracer *t, Node *node, double gradient[2]) {
  CagVec3 d[4] = {0};
  double f = 0;
  gradient[0] = gradient[1] = 0;
  node->regular = false;
  if (!t->status) t->status = cag_patch_value(&t->patch, node->u, node->v, &f, gradient, d, t->err);
  if (t->status) return 0;
  CagVec3 su = d[cag_partial(1, 1, 0)], sv = d[cag_partial(1, 0, 1)];
  CagVec3 along = cag_madd(cag_scaled(su, -gradient[1]), gradient[0], sv);
  double magnitude = fabs(gradient[1]) * cag_norm(su) + fabs(gradient[0]) * cag_norm(sv);
  const double *lo = t->patch.lo, *hi = t->patch.hi;
  double level = fabs(gradient[0]) * (hi[0] - lo[0]) + fabs(gradient[1]) * (hi[1] - lo[1]);
  node->p = d[0];
  node->flat = level <= FLAT_ROUNDINGS * t->level->zero;
  node->regular = cag_norm(along) > FLAT * magnitude && !node->flat &&
                  !cag_patch_is_collapsed(&t->patch, node->u, node->v);
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
  double lo = t->patch.lo[direction], hi = t->patch.hi[direction];
  bool broken = s->kind->breaks && !t->level->sided;
  size_t inner = broken ? s->kind->breaks(s, direction, NULL, 0) : 0;
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
      *value_of(t, i, j) = settled_at(t, t->lines[0][i], t->lines[1][j]);
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

// Lines that are added to the even ones, by direction.
typedef struct Extra {
  double at[2][FOLLOWED_MOST];
  size_t n[2];
} Extra;

static void add_extra(Extra *e, int direction, double x) {
  if (e->n[direction] < FOLLOWED_MOST) e->at[direction][e->n[direction]++] = x;
}

static bool make_all_lines(Tracer *t, const Extra *e) {
  return make_lines(t, 0, t->cells[0] * t->finer, e->at[0], e->n[0]) &&
         make_lines(t, 1, t->cells[1] * t->finer, e->at[1], e->n[1]) && fill_values(t);
}

// Twice as fine until the function is smooth from one line to the next.
static bool make_grid(Tracer *t, size_t finer) {
  const double smooth = 0.1;
  const Extra none = {.n = {0, 0}};
  for (t->finer = finer;; t->finer *= 2) {
    if (!make_all_lines(t, &none)) return false;
    if (t->finer >> HALVINGS_MOST || roughness(t) <= smooth) return t->status == CAG_OK;
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
    double du = node->u + part * hu > t->patch.hi[0] ? -part * hu : part * hu;
    double dv = node->v + part * hv > t->patch.hi[1] ? -part * hv : part * hv;
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
    const double *lo = t->patch.lo, *hi = t->patch.hi;
    node->u = inside(node->u - su, fmax(u - hu, lo[0]), fmin(u + hu, hi[0]));
    node->v = inside(node->v - sv, fmax(v - hv, lo[1]), fmin(v + hv, hi[1]));
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
  return determinant > 0 && bend * sign > 0 && settled_at(t, here.u, here.v) * sign < 0;
}

static bool nearest_to_zero(const Tracer *t, size_t i, size_t j) {
  double f = *value_of(t, i, j), sign = f < 0 ? -1 : 1;
  for (int di = -1; di <= 1; di++)
    for (int dj = -1; dj <= 1; dj++)
      if (*value_of(t, i + (size_t)di, j + (size_t)dj) * sign < f * sign) return false;
  return f != 0;
}

static void find_small_loops(Tracer *t, Extra *e) {
  double u, v;
  for (size_t j = 1; j + 1 < t->n[1]; j++)
    for (size_t i = 1; i + 1 < t->n[0] && e->n[0] < FOLLOWED_MOST && !t->status; i++)
      if (nearest_to_zero(t, i, j) && follow(t, i, j, &u, &v)) {
        add_extra(e, 0, u);
        add_extra(e, 1, v);
      }
}

// Between two ends along direction k where the function has one sign: a place with the other one,
// looked for where it comes nearest to 0. A curve leaves the rectangle there and comes back.
static bool find_dip(Tracer *t, int k, double fixed, double lo, double hi, double *out) {
  const int rounds = 30;
  double sign = 0, slopes[2] = {0, 0};
  for (int round = 0; round < rounds && !t->status; round++) {
    // The ends first, then places between: secant and bisection of the slope by turns.
    double way = slopes[1] - slopes[0];
    double x = round == 0                  ? lo
               : round == 1                ? hi
               : round % 2 == 0 && way > 0 ? lo - (hi - lo) * slopes[0] / way
                                           : (lo + hi) / 2;
    double f = 0, g[2] = {0, 0};
    t->status = cag_patch_value(&t->patch, k ? fixed : x, k ? x : fixed, &f, g, NULL, t->err);
    if (fabs(f) <= zero_at(t, k ? fixed : x, k ? x : fixed)) f = 0;
    if (round == 0) sign = f < 0 ? -1 : 1;
    if (f * sign < 0) {
      *out = x;
      return round > 1;
    }
    if (round < 2) {
      slopes[round] = sign * g[k];
      if (round == 0 ? slopes[0] >= 0 : slopes[1] <= 0) return false;
    } else if (sign * g[k] < 0) {
      lo = x;
      slopes[0] = sign * g[k];
    } else {
      hi = x;
      slopes[1] = sign * g[k];
    }
  }
  return false;
}

static void find_dips(Tracer *t, Extra *e) {
  for (int k = 0; k < 2; k++)
    for (int end = 0; end < 2; end++)
      for (size_t i = 0; i + 1 < t->n[k] && e->n[k] < FOLLOWED_MOST && !t->status; i++) {
        const double *x = &t->lines[k][i];
        double fixed = end ? t->patch.hi[1 - k] : t->patch.lo[1 - k], found;
        if (find_dip(t, k, fixed, x[0], x[1], &found)) add_extra(e, k, found);
      }
}

static bool add_lines(Tracer *t) {
  Extra e = {.n = {0, 0}};
  find_small_loops(t, &e);
  find_dips(t, &e);
  if (e.n[0] + e.n[1] == 0) return t->status == CAG_OK;
  return !t->status && make_all_lines(t, &e);
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
    double f = settled_at(t, u0 + x * (u1 - u0), v0 + x * (v1 - v0));
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

// Whether two branches cross at a node without tangent: the gradient vanishes there as at a saddle.
static bool is_saddle(Tracer *t, const Node *node) {
  const double same = 1e-6; // parts of a cell
  double bend, determinant;
  double hu = (t->patch.hi[0] - t->patch.lo[0]) / (double)t->n[0];
  double hv = (t->patch.hi[1] - t->patch.lo[1]) / (double)t->n[1];
  Node here = *node;
  return !cag_patch_is_collapsed(&t->patch, node->u, node->v) &&
         go_to_critical(t, &here, hu, hv, &bend, &determinant) && determinant < 0 &&
         fabs(here.u - node->u) <= same * hu && fabs(here.v - node->v) <= same * hv;
}

static void cross_edge(Tracer *t, size_t edge, size_t i0, size_t j0, size_t i1, size_t j1) {
  double f0 = *value_of(t, i0, j0), f1 = *value_of(t, i1, j1);
  t->links[edge][0] = t->links[edge][1] = -1;
  if (negative(f0) == negative(f1)) return;
  Node *node = &t->crossings[edge];
  find_crossing(t, t->lines[0][i0], t->lines[1][j0], f0, t->lines[0][i1], t->lines[1][j1], f1,
                node);
  if (!node->regular && !t->status) node->branching = is_saddle(t, node);
}

static void link_pair(Tracer *t, size_t a, size_t b) {
  t->links[a][t->links[a][0] >= 0] = (int32_t)b;
  t->links[b][t->links[b][0] >= 0] = (int32_t)a;
}

// The value at the saddle of a cell whose edges are all crossed; in its middle where none is found.
static double saddle_value(Tracer *t, size_t i, size_t j) {
  const double *u = &t->lines[0][i], *v = &t->lines[1][j];
  double hu = (u[1] - u[0]) / 2, hv = (v[1] - v[0]) / 2, bend, determinant;
  Node middle = {.u = u[0] + hu, .v = v[0] + hv}, saddle = middle;
  bool found = go_to_critical(t, &saddle, hu, hv, &bend, &determinant) && determinant < 0;
  const Node *at = found ? &saddle : &middle;
  return settled_at(t, at->u, at->v);
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
  // The saddle between joins the two corners of its sign; the others are cut off.
  bool with_first = negative(saddle_value(t, i, j)) == corner[0];
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
static bool middle_by_newton(Tracer *t, const Node *a, const Node *b, Node *out) {
  const double *lo = t->patch.lo, *hi = t->patch.hi;
  double lu = hi[0] - lo[0], lv = hi[1] - lo[1];
  double u = (a->u + b->u) / 2, v = (a->v + b->v) / 2;
  double reach = hypot((b->u - a->u) / lu, (b->v - a->v) / lv);
  *out = (Node){.u = u, .v = v};
  for (int round = 0; round < NEWTON_ROUNDS; round++) {
    double g[2], f = inspect(t, out, g);
    if (t->status) return false;
    double x = g[0] * lu, y = g[1] * lv, square = x * x + y * y;
    if (fabs(f) <= zero_at(t, out->u, out->v)) return true;
    if (!(square > 0)) return false;
    double du = lu * f * x / square, dv = lv * f * y / square;
    out->u = inside(out->u - du, lo[0], hi[0]);
    out->v = inside(out->v - dv, lo[1], hi[1]);
    if (hypot((out->u - u) / lu, (out->v - v) / lv) > reach) return false;
    if (hypot(du / lu, dv / lv) <= 4 * DBL_EPSILON) {
      inspect(t, out, g);
      return true;
    }
  }
  return false;
}

// The same where that fails, as by a pole, where the curve may turn sharply in the parameters: the
// crossing nearest to the middle on the line square to the way from a to b.
static bool middle_across(Tracer *t, const Node *a, const Node *b, Node *out) {
  const int places = 16;
  const double *lo = t->patch.lo, *hi = t->patch.hi;
  double lu = hi[0] - lo[0], lv = hi[1] - lo[1], u = (a->u + b->u) / 2, v = (a->v + b->v) / 2;
  double du = -(b->v - a->v) / lv * lu / 2, dv = (b->u - a->u) / lu * lv / 2;
  double f0 = settled_at(t, u, v), at[2][3] = {{u, v, f0}, {u, v, f0}};
  for (int k = 1; k <= places && !t->status; k++)
    for (int way = 0; way < 2; way++) {
      double x = (way ? -1.0 : 1.0) * k / places, *last = at[way];
      double next[3] = {inside(u + x * du, lo[0], hi[0]), inside(v + x * dv, lo[1], hi[1]), 0};
      next[2] = settled_at(t, next[0], next[1]);
      if (negative(next[2]) != negative(last[2])) {
        *out = (Node){0};
        find_crossing(t, last[0], last[1], last[2], next[0], next[1], next[2], out);
        return !t->status;
      }
      memcpy(last, next, sizeof next);
    }
  return false;
}

// By a pole Newton's method may slide into it, to rounding: that is no point between the two.
static bool is_between(const Node *a, const Node *m, const Node *b, double same) {
  double h = cag_norm(cag_sub(b->p, a->p));
  double near = fmin(cag_norm(cag_sub(m->p, a->p)), cag_norm(cag_sub(m->p, b->p)));
  return h <= same || near > SLID * h;
}

static bool middle_of(Tracer *t, const Node *a, const Node *b, Node *out) {
  double same = SAME * t->size;
  if (middle_by_newton(t, a, b, out) && is_between(a, out, b, same)) return true;
  return !t->status && middle_across(t, a, b, out) && is_between(a, out, b, same);
}

static CagVec3 aligned(CagVec3 tangent, CagVec3 chord) {
  return cag_dot(tangent, chord) < 0 ? cag_scaled(tangent, -1) : tangent;
}

// Whether the Hermite cubic from a to b is good: m is a point of the curve between them.
static bool is_good(const Tracer *t, const Node *a, const Node *m, const Node *b) {
  CagVec3 chord = cag_sub(b->p, a->p);
  double h = cag_norm(chord);
  // Where there is no tangent, the one it will get: that of the other end mirrored, or of the
  // parabola through the three.
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
  return cag_norm(off) <= t->tolerance / 2;
}

// Where two branches of the curve cross between a and b: the gradient vanishes there, and the value
// to the rounding of that.
static bool find_branching(Tracer *t, const Node *a, const Node *b, Node *out) {
  const double roundings = 100, reach = 2;
  double lu = t->patch.hi[0] - t->patch.lo[0], lv = t->patch.hi[1] - t->patch.lo[1];
  double bend, determinant;
  double far = reach * hypot((b->u - a->u) / lu, (b->v - a->v) / lv);
  *out = (Node){.u = (a->u + b->u) / 2, .v = (a->v + b->v) / 2};
  if (!go_to_critical(t, out, far * lu, far * lv, &bend, &determinant) || determinant >= 0)
    return false;
  double g[2];
  double f = inspect(t, out, g);
  out->regular = false;
  return !t->status && fabs(f) <= roundings * zero_at(t, out->u, out->v);
}

// Adds the points after a, b the last of them.
static bool refine(Tracer *t, const Node *a, const Node *b, int depth, int at_least) {
  Node m;
  double same = SAME * t->size;
  bool found = middle_of(t, a, b, &m);
  if (t->status) return false;
  bool together = cag_norm(cag_sub(b->p, a->p)) <= same;
  if (together && (!found || cag_norm(cag_sub(m.p, a->p)) <= same)) return true;
  if (found && !together && at_least <= 0 && is_good(t, a, &m, b))
    return add_check(t, m.p) && add_node(t, b);
  Node branching;
  bool stuck = !found || depth == DEPTH_MOST;
  if (stuck && !a->branching && !b->branching && find_branching(t, a, b, &branching)) {
    branching.branching = true;
    return refine(t, a, &branching, depth / 2, at_least) &&
           refine(t, &branching, b, depth / 2, at_least);
  }
  if (stuck) {
    // A way across where there is no curve: the cells are too large.
    double h = cag_norm(cag_sub(b->p, a->p));
    t->torn = t->torn || (h > t->tolerance && a->regular && b->regular);
    return add_node(t, b);
  }
  return refine(t, a, &m, depth + 1, at_least - 1) && refine(t, &m, b, depth + 1, at_least - 1);
}

// --- Runs ---

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
  if (!ok) cag_trace_free(&trace);
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
  return cag_dot(before, after) < CAG_TRACE_CORNER;
}

// Where a sided function is 0 over an area, to rounding, it has no curve there, or any.
static bool is_lost(const Tracer *t, size_t i) {
  return t->level->sided && t->run[i].flat && t->run[i + 1].flat;
}

// Nodes [from, to], unless they are a speck beside a lost one: what rounding leaves about such an
// area.
static bool keep_piece(Tracer *t, size_t from, size_t to, CagTraces *out) {
  bool beside = (from > 0 && is_lost(t, from - 1)) || (to + 1 < t->run_count && is_lost(t, to));
  double reach = 0;
  for (size_t i = from + 1; i <= to; i++)
    reach = fmax(reach, cag_norm(cag_sub(t->run[i].p, t->run[from].p)));
  return (beside && reach <= BESIDE_LOST * t->size) || keep_run(t, from, to, out);
}

// Refines the run through these edges and cuts it at its corners.
static bool keep_path(Tracer *t, const int32_t *path, size_t n, CagTraces *out) {
  t->run_count = t->check_count = 0;
  int at_least = n <= SHORT_RUN ? SHORT_RUN_DEPTH : 0;
  if (!add_node(t, &t->crossings[path[0]])) return false;
  for (size_t k = 1; k < n; k++)
    if (!refine(t, &t->crossings[path[k - 1]], &t->crossings[path[k]], 0, at_least)) return false;
  size_t from = 0;
  for (size_t i = 0; i + 1 < t->run_count; i++) {
    bool lost = is_lost(t, i);
    bool corner = i > 0 && is_corner(t, i);
    if ((lost || corner) && i > from && !keep_piece(t, from, i, out)) return false;
    if (lost || corner) from = lost ? i + 1 : i;
  }
  return keep_piece(t, from, t->run_count - 1, out);
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

static void tracer_free(Tracer *t) {
  free(t->lines[0]);
  free(t->lines[1]);
  free(t->values);
  free(t->crossings);
  free(t->links);
  free(t->run);
  free(t->checks);
  t->lines[0] = t->lines[1] = t->values = NULL;
  t->crossings = t->run = NULL;
  t->links = NULL;
  t->checks = NULL;
  t->run_count = t->run_capacity = t->check_count = t->check_capacity = 0;
}

// --- Patches ---

// The ends of the patches along a direction: of all of it where the function is not sided.
static bool find_ends(const CagSurface *s, bool sided, int direction, double **out, size_t *n) {
  size_t inner = sided && s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  *out = malloc((inner + 2) * sizeof **out);
  if (!*out) return false;
  (*out)[0] = direction ? s->v0 : s->u0;
  if (inner > 0) s->kind->breaks(s, direction, *out + 1, inner);
  (*out)[inner + 1] = direction ? s->v1 : s->u1;
  *n = inner + 1;
  return true;
}

// Whether the values are rounding: half of them below that away from the edges, all below the
// most.
static bool is_constant(const Tracer *t, double inner, double most) {
  size_t n = t->n[0] * t->n[1], small = 0;
  for (size_t k = 0; k < n; k++) small += fabs(t->values[k]) <= CONSTANT_ROUNDINGS * inner;
  return 2 * small >= n && largest_value(t) <= CONSTANT_ROUNDINGS * most;
}

// Sets what counts as 0 on this patch; false where all of it does.
static bool settle(Tracer *t, CagLevel *own) {
  const double rounding = 1e-13;
  if (own->zero > 0) return true;
  if (own->sided) {
    t->status = cag_patch_rounding(&t->patch, &own->zero, &t->zero_beside, t->err);
    if (t->status || is_constant(t, own->zero, t->zero_beside)) return false;
  } else {
    own->zero = rounding * largest_value(t);
  }
  return fill_values(t);
}

static bool trace_grid(Tracer *t, CagLevel *own, size_t finer, CagTraces *out, bool *constant) {
  double zero = own->zero;
  t->torn = false;
  bool ok = make_grid(t, finer);
  bool settled = ok && settle(t, own);
  *constant = ok && !settled && !t->status && own->sided;
  if (!*constant) ok = settled && add_lines(t) && find_crossings(t) && walk_all(t, out);
  own->zero = zero;
  tracer_free(t);
  return ok;
}

// Sided functions, which may change more sharply than surfaces, are traced once more with finer
// cells while runs have gaps.
static bool trace_patch(Tracer *t, CagLevel *own, CagTraces *out, bool *constant) {
  size_t first = out->count;
  for (size_t finer = 1;; finer = 2 * t->finer) {
    if (!trace_grid(t, own, finer, out, constant)) return false;
    if (!own->sided || !t->torn || t->finer >> HALVINGS_MOST) return true;
    while (out->count > first) cag_trace_free(&out->items[--out->count]);
  }
}

static CagStatus trace_patches(Tracer *t, CagLevel *own, CagTraces *out) {
  const CagSurface *s = t->s;
  double *ends[2] = {NULL, NULL};
  size_t n[2] = {0, 0};
  bool ok =
      find_ends(s, own->sided, 0, &ends[0], &n[0]) && find_ends(s, own->sided, 1, &ends[1], &n[1]);
  for (int k = 0; k < 2; k++) {
    size_t share = n[k] > 0 ? CELLS / n[k] : CELLS;
    t->cells[k] = share < CELLS_OF_PATCH ? CELLS_OF_PATCH : share;
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
  free(ends[0]);
  free(ends[1]);
  return ok ? CAG_OK : t->status ? t->status : cag_fail_memory(t->err);
}

CagStatus cag_surface_trace(const CagSurface *s, const CagLevel *level, double tolerance,
                            CagTraces *out, CagError *err) {
  CagBounds box;
  *out = (CagTraces){0};
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  CagLevel own = *level;
  Tracer t = {.s = s, .level = &own, .tolerance = tolerance, .err = err};
  t.size = cag_norm(cag_sub(box.max, box.min));
  const CagSurface *whole;
  if (!cag_surface_trimmed_view(s, &whole, &t.region)) t.region = NULL;
  const CagTraceJoint how = {SAME * 10 * t.size, t.size, tolerance, own.sided};
  status = trace_patches(&t, &own, out);
  if (!status && !cag_traces_join(out, &how)) status = cag_fail_memory(err);
  if (status) cag_traces_free(out);
  return status;
}
