// The negative side of a conic within a rectangle.
//
// The crossings of the conic with the sides of the rectangle are roots of quadratic equations.
// Between crossings, the equation of the conic has a constant sign along the sides. The class of
// the conic determines in which order its branches pass the crossings, and so which two of them are
// the ends of an arc within the rectangle. The boundary of a part alternates between pieces of the
// sides and arcs. The arcs are rational quadratic Bezier curves: the apex is the intersection of
// the tangents, and the weight has a closed form that does not lose digits if the conic is far
// larger than the rectangle.

#include "geom/curve/conic_side.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"

// Crossings coincide if their distance is below this fraction of the rectangle's perimeter.
#define ONE_CROSSING 1e-10
// A value of the equation below this fraction of its terms is rounding.
#define ROUNDING (64 * DBL_EPSILON)
// If the sine between two tangents is below this, the arc is straight to rounding.
#define STRAIGHT 1e-14
// An arc whose tangent turns by more than this is halved, which keeps the weights near 1.
#define MOST_TURN (M_PI / 3)
#define MOST_HALVINGS 12

// Each of the four sides has two roots.
#define CANDIDATES_MOST 8
#define GAPS_MOST (CANDIDATES_MOST + 1)

typedef struct Rectangle {
  CagVec3 corner[4]; // counter-clockwise
  double at[5];      // of the corners along the perimeter
} Rectangle;

typedef enum BranchKind {
  BRANCH_NONE,
  BRANCH_ELLIPSE,
  BRANCH_HYPERBOLA, // two, with x > 0 and x < 0
  BRANCH_PARABOLA,
  BRANCH_LINES, // one or two
  BRANCH_WEDGES // both bound a negative wedge between two lines: a ray, the center, a ray
} BranchKind;

typedef struct Branches {
  BranchKind kind;
  CagConicClass k;
  CagVec3 x, y;    // axes of the conic
  double ray[4];   // WEDGES: angles, ascending
  int first_wedge; // WEDGES: 0 or 1, the ray at which the first negative wedge begins
} Branches;

typedef struct Crossing {
  double s; // along the perimeter
  CagVec3 p;
  bool enters; // the perimeter enters the negative side here
  int branch;
  double t; // along the branch
  size_t partner;
  double span; // of t up to the partner, within the rectangle
  bool used;
} Crossing;

typedef struct Work {
  const CagConic *conic;
  Rectangle r;
  Branches b;
  Crossing at[GAPS_MOST];
  size_t n;
  int sign; // if n is 0: the sign on the whole perimeter
} Work;

// --- The perimeter ---

static void set_rectangle(Rectangle *r, const CagBounds *box) {
  const CagVec3 a = box->min, b = box->max;
  r->corner[0] = cag_vec3(a.x, a.y, 0);
  r->corner[1] = cag_vec3(b.x, a.y, 0);
  r->corner[2] = cag_vec3(b.x, b.y, 0);
  r->corner[3] = cag_vec3(a.x, b.y, 0);
  r->at[0] = 0;
  for (int k = 0; k < 4; k++) r->at[k + 1] = r->at[k] + (k % 2 == 0 ? b.x - a.x : b.y - a.y);
}

static CagVec3 perimeter_point(const Rectangle *r, double s) {
  s -= r->at[4] * floor(s / r->at[4]);
  int k = 0;
  while (k < 3 && s > r->at[k + 1]) k++;
  return cag_lerp(r->corner[k], r->corner[(k + 1) % 4], (s - r->at[k]) / (r->at[k + 1] - r->at[k]));
}

// The quadratic part for a direction.
static double quadratic_part(const CagConic *conic, CagVec3 d) {
  const double *c = conic->c;
  return c[0] * d.x * d.x + c[1] * d.x * d.y + c[2] * d.y * d.y;
}

CagVec3 cag_conic_gradient(const CagConic *conic, CagVec3 p) {
  double line[3];
  cag_conic_polar(conic, p, line);
  return cag_vec3(2 * line[0], 2 * line[1], 0);
}

// The size of the equation's terms at p.
static double size_of_terms(const CagConic *conic, CagVec3 p) {
  const double *c = conic->c;
  return fabs(c[0] * p.x * p.x) + fabs(c[1] * p.x * p.y) + fabs(c[2] * p.y * p.y) +
         fabs(c[3] * p.x) + fabs(c[4] * p.y) + fabs(c[5]);
}

// Adds the parameters on side k at which the equation is 0.
static void add_roots(const Work *w, int k, double *s, size_t *n) {
  const CagVec3 p = w->r.corner[k], d = cag_sub(w->r.corner[(k + 1) % 4], p);
  const double slack = ONE_CROSSING;
  const double a = quadratic_part(w->conic, d), b = cag_dot(cag_conic_gradient(w->conic, p), d) / 2;
  const double c = cag_conic_value(w->conic, p), rest = b * b - a * c;
  if (rest < 0) return;
  const double q = b < 0 ? sqrt(rest) - b : -sqrt(rest) - b; // without cancellation
  const double root[2] = {q / a, c / q};
  for (int i = 0; i < 2; i++)
    if (root[i] >= -slack && root[i] <= 1 + slack)
      s[(*n)++] = w->r.at[k] + fmin(fmax(root[i], 0), 1) * (w->r.at[k + 1] - w->r.at[k]);
}

static int by_place(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// The sign of the equation between two neighboring zeros on the perimeter, from the sample with the
// largest value. 0: the equation is 0 at all samples.
static int sign_between(const Work *w, double from, double to) {
  const double part[] = {0.5, 0.25, 0.75, 0.06, 0.94};
  double best = 0;
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
    const CagVec3 p = perimeter_point(&w->r, from + part[i] * (to - from));
    const double value = cag_conic_value(w->conic, p);
    if (fabs(value) <= ROUNDING * size_of_terms(w->conic, p)) continue;
    if (fabs(value) > fabs(best)) best = value;
  }
  return (best > 0) - (best < 0);
}

typedef struct Gap {
  double from, to;
  int sign;
} Gap;

// A crossing between two intervals of the perimeter: the corner if there is one.
static double place_between(const Rectangle *r, double from, double to) {
  const double slack = ONE_CROSSING * r->at[4];
  for (int turn = 0; turn < 2; turn++)
    for (int k = 0; k < 4; k++) {
      const double corner = r->at[k] + turn * r->at[4];
      if (corner >= from - slack && corner <= to + slack) return corner;
    }
  return from + (to - from) / 2;
}

static void add_crossing(Work *w, double from, double to, bool enters) {
  double s = place_between(&w->r, from, to);
  const CagVec3 p = perimeter_point(&w->r, s);
  s -= w->r.at[4] * floor(s / w->r.at[4]);
  w->at[w->n++] = (Crossing){.s = s, .p = p, .enters = enters, .partner = SIZE_MAX};
}

// Finds the parameters on the perimeter at which the sign changes, in order.
static void find_crossings(Work *w) {
  double s[CANDIDATES_MOST];
  Gap gaps[GAPS_MOST];
  size_t candidates = 0, n = 0;
  const double all = w->r.at[4];
  for (int k = 0; k < 4; k++) add_roots(w, k, s, &candidates);
  qsort(s, candidates, sizeof *s, by_place);
  if (candidates == 0) {
    w->sign = sign_between(w, 0, all);
    return;
  }
  for (size_t i = 0; i < candidates; i++) {
    const double to = i + 1 < candidates ? s[i + 1] : s[0] + all;
    const int sign = to - s[i] > ONE_CROSSING * all ? sign_between(w, s[i], to) : 0;
    if (sign == 0) continue;
    if (n > 0 && gaps[n - 1].sign == sign) gaps[n - 1].to = to;
    else gaps[n++] = (Gap){s[i], to, sign};
  }
  if (n > 1 && gaps[0].sign == gaps[n - 1].sign) { gaps[0].from = gaps[--n].from - all; }
  w->sign = n > 0 ? gaps[0].sign : 0;
  for (size_t i = 0; n > 1 && i < n; i++) {
    const Gap *next = &gaps[(i + 1) % n];
    const double to = i + 1 < n ? next->from : next->from + all;
    add_crossing(w, gaps[i].to, to, next->sign < 0);
  }
}

// --- Branches ---

// The four rays from the center, and the wedges between them that are negative.
static void set_wedges(const CagConic *conic, Branches *b) {
  size_t n = 0;
  for (int i = 0; i < 2; i++) {
    const double angle = atan2(b->k.lines[i][0], -b->k.lines[i][1]);
    b->ray[n++] = angle;
    b->ray[n++] = angle > 0 ? angle - M_PI : angle + M_PI;
  }
  qsort(b->ray, n, sizeof *b->ray, by_place);
  const double middle = (b->ray[0] + b->ray[1]) / 2;
  b->first_wedge = quadratic_part(conic, cag_vec3(cos(middle), sin(middle), 0)) < 0 ? 0 : 1;
}

static CagStatus set_branches(const CagConic *conic, Branches *b, CagError *err) {
  CagStatus status = cag_conic_classify(conic, &b->k, err);
  if (status) return status;
  const CagConicClass *k = &b->k;
  b->x = cag_vec3(cos(k->angle), sin(k->angle), 0);
  b->y = cag_vec3(-b->x.y, b->x.x, 0);
  b->kind = BRANCH_NONE;
  if (k->line_count == 2 && k->has_center) b->kind = BRANCH_WEDGES;
  else if (k->line_count > 0) b->kind = BRANCH_LINES;
  else if (k->a > 0)
    b->kind = k->eccentricity < 1    ? BRANCH_ELLIPSE
              : k->eccentricity == 1 ? BRANCH_PARABOLA
                                     : BRANCH_HYPERBOLA;
  if (b->kind == BRANCH_WEDGES) set_wedges(conic, b);
  return CAG_OK;
}

static int nearest_ray(const Branches *b, CagVec3 d) {
  const double angle = atan2(d.y, d.x);
  int best = 0;
  double most = -2;
  for (int i = 0; i < 4; i++)
    if (cos(angle - b->ray[i]) > most) {
      most = cos(angle - b->ray[i]);
      best = i;
    }
  return best;
}

static double off_line(const double line[3], CagVec3 p) {
  return fabs(line[0] * p.x + line[1] * p.y + line[2]);
}

// The branch that a point of the conic is on, and its parameter there.
static void find_branch(const Branches *b, CagVec3 p, int *branch, double *t) {
  const CagConicClass *k = &b->k;
  const CagVec3 d = cag_sub(p, k->center);
  const double x = cag_dot(d, b->x), y = cag_dot(d, b->y);
  *branch = 0;
  *t = 0;
  switch (b->kind) {
  case BRANCH_NONE: return;
  case BRANCH_ELLIPSE: *t = atan2(y / k->b, x / k->a); return;
  case BRANCH_PARABOLA: *t = y; return;
  case BRANCH_HYPERBOLA:
    *branch = x < 0;
    *t = asinh(y / k->b);
    return;
  case BRANCH_LINES:
    *branch = k->line_count == 2 && off_line(k->lines[1], p) < off_line(k->lines[0], p);
    *t = k->lines[*branch][0] * p.y - k->lines[*branch][1] * p.x;
    return;
  case BRANCH_WEDGES: {
    const int ray = (nearest_ray(b, d) - b->first_wedge + 4) % 4;
    *branch = ray / 2;
    *t = ray % 2 ? cag_norm(d) : -cag_norm(d);
  }
  }
}

static CagVec3 branch_point(const Branches *b, int branch, double t) {
  const CagConicClass *k = &b->k;
  double x = 0, y = 0;
  switch (b->kind) {
  case BRANCH_NONE: break;
  case BRANCH_ELLIPSE: x = k->a * cos(t), y = k->b * sin(t); break;
  case BRANCH_PARABOLA: x = t * t / (4 * k->a), y = t; break;
  case BRANCH_HYPERBOLA: x = (branch ? -k->a : k->a) * cosh(t), y = k->b * sinh(t); break;
  case BRANCH_LINES: {
    const double *line = k->lines[branch];
    return cag_vec3(-line[2] * line[0] - line[1] * t, -line[2] * line[1] + line[0] * t, 0);
  }
  case BRANCH_WEDGES: {
    const double angle = b->ray[(2 * branch + b->first_wedge + (t > 0)) % 4];
    return cag_madd(k->center, fabs(t), cag_vec3(cos(angle), sin(angle), 0));
  }
  }
  return cag_madd(cag_madd(k->center, x, b->x), y, b->y);
}

CagVec3 cag_conic_onto(const CagConic *conic, CagVec3 p) {
  for (int k = 0; k < 2; k++) {
    const CagVec3 g = cag_conic_gradient(conic, p);
    const double square = cag_dot(g, g);
    if (square > 0) p = cag_madd(p, -cag_conic_value(conic, p) / square, g);
  }
  return p;
}

// The point of the branch, with the additional rounding removed that results if the conic is far
// larger than the rectangle.
static CagVec3 precise_point(const Work *w, int branch, double t) {
  const CagVec3 p = branch_point(&w->b, branch, t);
  return w->b.kind == BRANCH_WEDGES || w->b.kind == BRANCH_LINES ? p : cag_conic_onto(w->conic, p);
}

// Tests whether a branch lies within the rectangle between two neighboring crossings, by the sample
// that is farthest from the sides.
static bool is_inside(const Work *w, int branch, double from, double to) {
  const double part[] = {0.5, 0.25, 0.75};
  const CagVec3 low = w->r.corner[0], high = w->r.corner[2];
  double best = 0;
  for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
    const CagVec3 p = precise_point(w, branch, from + part[i] * (to - from));
    const double off = fmin(fmin(p.x - low.x, high.x - p.x), fmin(p.y - low.y, high.y - p.y));
    if (fabs(off) > fabs(best)) best = off;
  }
  return best > 0;
}

// Pairs the ends of arcs within the rectangle. Returns false if they do not come in pairs of one
// entry and one exit.
static bool pair_crossings(Work *w) {
  size_t order[GAPS_MOST];
  for (size_t i = 0; i < w->n; i++) {
    find_branch(&w->b, w->at[i].p, &w->at[i].branch, &w->at[i].t);
    size_t k = i;
    for (; k > 0; k--) {
      const Crossing *before = &w->at[order[k - 1]], *mine = &w->at[i];
      if (before->branch < mine->branch || (before->branch == mine->branch && before->t <= mine->t))
        break;
      order[k] = order[k - 1];
    }
    order[k] = i;
  }
  const bool round = w->b.kind == BRANCH_ELLIPSE;
  for (size_t k = 0; k < w->n; k++) {
    if (k + 1 == w->n && !round) break;
    const size_t i = order[k], j = order[(k + 1) % w->n];
    Crossing *a = &w->at[i], *b = &w->at[j];
    if (a->branch != b->branch) continue;
    const double span = b->t - a->t + (k + 1 < w->n ? 0 : 2 * M_PI);
    if (!is_inside(w, a->branch, a->t, a->t + span)) continue;
    if (a->partner != SIZE_MAX || b->partner != SIZE_MAX || a->enters == b->enters) return false;
    a->partner = j;
    a->span = span;
    b->partner = i;
    b->span = -span;
  }
  for (size_t i = 0; i < w->n; i++)
    if (w->at[i].partner == SIZE_MAX) return false;
  return true;
}

// --- Arcs ---

typedef struct Chain {
  CagCurve **at;
  size_t n, room;
} Chain;

static CagStatus add_curve(Chain *c, CagStatus made, CagCurve *curve, CagError *err) {
  if (made) return made;
  if (!CAG_RESERVE(c->at, c->room, c->n + 1)) {
    cag_curve_release(curve);
    return cag_fail_memory(err);
  }
  c->at[c->n++] = curve;
  return CAG_OK;
}

static CagStatus add_line(Chain *c, CagVec3 p, CagVec3 q, CagError *err) {
  CagCurve *line = NULL;
  const CagStatus status = cag_curve_line(p, q, 2, &line, err);
  return add_curve(c, status, line, err);
}

// With d from end to end and e from an end to the apex, and Q the quadratic part, the square of the
// weight is Q(d) / (4 Q(e)).
CagStatus cag_conic_short_arc(const CagConic *conic, CagVec3 p, CagVec3 q, CagCurve **out,
                              CagError *err) {
  const CagVec3 g = cag_conic_gradient(conic, p), h = cag_conic_gradient(conic, q);
  const CagVec3 d = cag_sub(q, p);
  const double det = g.x * h.y - g.y * h.x, reach = cag_dot(h, d);
  if (!(fabs(det) > STRAIGHT * cag_norm(g) * cag_norm(h))) return cag_curve_line(p, q, 2, out, err);
  // p + s (-g.y, g.x) lies on the tangent at q.
  const CagVec3 apex = cag_madd(p, reach / det, cag_vec3(-g.y, g.x, 0));
  const double around = quadratic_part(conic, d);
  const double first = around / (4 * quadratic_part(conic, cag_sub(apex, p)));
  const double second = around / (4 * quadratic_part(conic, cag_sub(apex, q)));
  if (!(first > 0) || !(second > 0) || !isfinite(first) || !isfinite(second))
    return cag_curve_line(p, q, 2, out, err);
  const CagVec3 points[3] = {p, apex, q};
  const double weights[3] = {1, sqrt(sqrt(first) * sqrt(second)), 1};
  return cag_curve_bezier(points, weights, 3, 2, out, err);
}

static CagStatus add_arc(const Work *w, int branch, double from, double to, CagVec3 p, CagVec3 q,
                         int halvings, Chain *c, CagError *err) {
  const CagVec3 g = cag_conic_gradient(w->conic, p), h = cag_conic_gradient(w->conic, q);
  const double turn = atan2(fabs(g.x * h.y - g.y * h.x), cag_dot(g, h));
  const bool long_way = w->b.kind == BRANCH_ELLIPSE && fabs(to - from) > M_PI / 2;
  if (halvings == 0 || (turn <= MOST_TURN && !long_way)) {
    CagCurve *arc = NULL;
    const CagStatus made = cag_conic_short_arc(w->conic, p, q, &arc, err);
    return add_curve(c, made, arc, err);
  }
  const double half = from + (to - from) / 2;
  const CagVec3 middle = precise_point(w, branch, half);
  CagStatus status = add_arc(w, branch, from, half, p, middle, halvings - 1, c, err);
  return status ? status : add_arc(w, branch, half, to, middle, q, halvings - 1, c, err);
}

// From one crossing to its partner, within the rectangle.
static CagStatus add_inner(const Work *w, const Crossing *a, Chain *c, CagError *err) {
  const Crossing *b = &w->at[a->partner];
  const double to = a->t + a->span;
  if (w->b.kind == BRANCH_WEDGES && (a->t < 0) != (to < 0)) {
    CagStatus status = add_line(c, a->p, w->b.k.center, err);
    return status ? status : add_line(c, w->b.k.center, b->p, err);
  }
  if (w->b.kind == BRANCH_WEDGES || w->b.kind == BRANCH_LINES) return add_line(c, a->p, b->p, err);
  return add_arc(w, a->branch, a->t, to, a->p, b->p, MOST_HALVINGS, c, err);
}

// --- Parts ---

// Along the perimeter from one crossing to the next.
static CagStatus add_sides(const Work *w, const Crossing *a, const Crossing *b, Chain *c,
                           CagError *err) {
  const double all = w->r.at[4], slack = ONE_CROSSING * all;
  const double end = b->s > a->s ? b->s : b->s + all;
  CagVec3 last = a->p;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 8; k++) {
    const double at = w->r.at[k % 4] + (k < 4 ? 0 : all);
    if (at <= a->s + slack || at >= end - slack) continue;
    status = add_line(c, last, w->r.corner[k % 4], err);
    last = w->r.corner[k % 4];
  }
  return status ? status : add_line(c, last, b->p, err);
}

static CagStatus take_region(CagCurve *outline, CagRegion **out, size_t *n, CagError *err) {
  CagStatus status = cag_region_new(outline, NULL, 0, &out[*n], err);
  if (!status) ++*n;
  cag_curve_release(outline);
  return status;
}

static CagStatus add_part(Work *w, size_t start, CagRegion **out, size_t *n, CagError *err) {
  Chain chain = {0};
  CagStatus status = CAG_OK;
  for (size_t i = start; !status && !w->at[i].used;) {
    w->at[i].used = true;
    const Crossing *leaves = &w->at[(i + 1) % w->n];
    status = add_sides(w, &w->at[i], leaves, &chain, err);
    if (!status) status = add_inner(w, leaves, &chain, err);
    i = leaves->partner;
  }
  CagCurve *outline = NULL;
  if (!status) status = cag_curve_join(chain.at, chain.n, &outline, err);
  for (size_t i = 0; i < chain.n; i++) cag_curve_release(chain.at[i]);
  cag_free(chain.at);
  return status ? status : take_region(outline, out, n, err);
}

static CagStatus add_rectangle(const Work *w, CagRegion **out, size_t *n, CagError *err) {
  CagCurve *outline = NULL;
  CagStatus status = cag_curve_polyline(w->r.corner, 4, true, 2, &outline, err);
  return status ? status : take_region(outline, out, n, err);
}

// Without crossings the rectangle's boundary is entirely on one side. The conic is then outside, or
// an ellipse inside the rectangle if the equation has the opposite sign at its center.
static CagStatus add_uncrossed(const Work *w, CagRegion **out, size_t *n, CagError *err) {
  const CagVec3 low = w->r.corner[0], high = w->r.corner[2], c = w->b.k.center;
  const bool hole = w->sign < 0;
  const bool within = w->b.kind == BRANCH_ELLIPSE && c.x > low.x && c.x < high.x && c.y > low.y &&
                      c.y < high.y && (cag_conic_value(w->conic, c) < 0) != hole;
  if (!within) return w->sign < 0 ? add_rectangle(w, out, n, err) : CAG_OK;
  CagCurve *ellipse[2], *around = NULL;
  size_t branches = 0;
  CagStatus status = cag_conic_branches(w->conic, -1, 1, ellipse, &branches, err);
  if (status) return status;
  if (!hole) return take_region(ellipse[0], out, n, err);
  status = cag_curve_polyline(w->r.corner, 4, true, 2, &around, err);
  if (!status) status = cag_region_new(around, ellipse, 1, &out[*n], err);
  if (!status) ++*n;
  cag_curve_release(around);
  cag_curve_release(ellipse[0]);
  return status;
}

CagStatus cag_conic_negative_parts(const CagConic *conic, const CagBounds *rectangle,
                                   CagRegion *out[CAG_CONIC_PARTS], size_t *n, bool *decided,
                                   CagError *err) {
  Work w = {.conic = conic};
  *n = 0;
  *decided = true;
  set_rectangle(&w.r, rectangle);
  CagStatus status = set_branches(conic, &w.b, err);
  if (status) return status;
  find_crossings(&w);
  if (w.n == 0) return add_uncrossed(&w, out, n, err);
  *decided = pair_crossings(&w);
  for (size_t i = 0; !status && *decided && i < w.n; i++)
    if (w.at[i].enters && !w.at[i].used) status = add_part(&w, i, out, n, err);
  if (status)
    while (*n > 0) cag_region_release(out[--*n]);
  return status;
}
