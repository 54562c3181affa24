// Orthogonal distance fits: shapes are moved in their own frame, so that all share one Jacobian.
//
// Points are centered and divided by their spread. In the frame of the shape, a point q has one or
// two residuals r with the gradients g by q. A small translation t and rotation w of the frame change
// q by -t - w x q, so the residual changes by -g . t - (q x g) . w. A shape lists the motions that
// matter to it, and its sizes (Gander, Golub, and Strebel 1994; Ahn 2004, Least squares orthogonal
// distance fitting).

#include "geom/linalg/shape_fit.h"

#include <lapacke.h>
#include <string.h>

#include "base/stop.h"
#include "geom/linalg/ellipse_foot.h"
#include "geom/linalg/givens.h"
#include "geom/linalg/rigid.h"

// A spread below this fraction of the largest is rounding: points are then on a line or in a plane.
#define FLAT 1e-12
// A shape larger than this many times the spread of its points is practically a line or plane.
#define INFINITE 1e7
// Steps shorter than this fraction of the spread are rounding.
#define SMALL_STEP 1e-14
// A singular value of the Jacobian below this fraction of the largest: several shapes fit.
#define AMBIGUOUS 1e-10
#define STEPS_MOST 500
// Steps of the trial from each direction of a cylinder's axis.
#define STEPS_TRIAL 12

enum { TX, TY, TZ, WX, WY, WZ, SIZE_A, SIZE_B, UNKNOWNS };

typedef struct Points {
  const CagVec3 *items;
  size_t n;
  CagVec3 center;
  double spread;
  CagVec3 axes[3]; // principal directions, the longest first
  double extent[3];
} Points;

// A shape in the normalized coordinates.
typedef struct State {
  CagTransform frame;
  double a, b;
} State;

typedef struct Residual {
  double value;
  CagVec3 gradient;
  double by_a, by_b;
} Residual;

typedef struct Model {
  const char *name;
  size_t least[2]; // points in space and in the plane
  unsigned moves[2];
  int (*residuals)(const State *s, CagVec3 q, Residual out[2]); // returns their number
} Model;

static CagVec3 normalized(const Points *p, size_t i) {
  return cag_scaled(cag_sub(p->items[i], p->center), 1 / p->spread);
}

static CagVec3 in_frame(const CagTransform *t, CagVec3 p) {
  const CagVec3 d = cag_vec3(p.x - t->m[0][3], p.y - t->m[1][3], p.z - t->m[2][3]);
  return cag_vec3(t->m[0][0] * d.x + t->m[1][0] * d.y + t->m[2][0] * d.z,
                  t->m[0][1] * d.x + t->m[1][1] * d.y + t->m[2][1] * d.z,
                  t->m[0][2] * d.x + t->m[1][2] * d.y + t->m[2][2] * d.z);
}

static CagTransform frame_of(CagVec3 x, CagVec3 y, CagVec3 z, CagVec3 origin) {
  return (CagTransform){.m = {{x.x, y.x, z.x, origin.x},
                              {x.y, y.y, z.y, origin.y},
                              {x.z, y.z, z.z, origin.z},
                              {0, 0, 0, 1}}};
}

// --- Residuals ---

static Residual height(CagVec3 q) {
  return (Residual){.value = q.z, .gradient = cag_vec3(0, 0, 1)};
}

static Residual from_axis(const State *s, CagVec3 q) {
  const double r = hypot(q.x, q.y);
  const CagVec3 out = r > 0 ? cag_vec3(q.x / r, q.y / r, 0) : cag_vec3(1, 0, 0);
  return (Residual){.value = r - s->a, .gradient = out, .by_a = -1};
}

static int line_residuals(const State *s, CagVec3 q, Residual out[2]) {
  (void)s;
  out[0] = (Residual){.value = q.x, .gradient = cag_vec3(1, 0, 0)};
  out[1] = (Residual){.value = q.y, .gradient = cag_vec3(0, 1, 0)};
  return 2;
}

static int plane_residuals(const State *s, CagVec3 q, Residual out[2]) {
  (void)s;
  out[0] = height(q);
  return 1;
}

static int circle_residuals(const State *s, CagVec3 q, Residual out[2]) {
  out[0] = from_axis(s, q);
  out[1] = height(q);
  return 2;
}

static int ellipse_residuals(const State *s, CagVec3 q, Residual out[2]) {
  CagVec3 normal;
  const CagVec3 foot = cag_ellipse_foot(s->a, s->b, q, &normal);
  const CagVec3 d = cag_vec3(q.x - foot.x, q.y - foot.y, 0);
  out[0] = (Residual){.value = cag_dot(normal, d),
                      .gradient = normal,
                      .by_a = -normal.x * foot.x / s->a,
                      .by_b = -normal.y * foot.y / s->b};
  out[1] = height(q);
  return 2;
}

static int sphere_residuals(const State *s, CagVec3 q, Residual out[2]) {
  const double r = cag_norm(q);
  const CagVec3 normal = r > 0 ? cag_scaled(q, 1 / r) : cag_vec3(1, 0, 0);
  out[0] = (Residual){.value = r - s->a, .gradient = normal, .by_a = -1};
  return 1;
}

static int cylinder_residuals(const State *s, CagVec3 q, Residual out[2]) {
  out[0] = from_axis(s, q);
  return 1;
}

#define BIT(unknown) (1u << (unknown))
#define CENTER (BIT(TX) | BIT(TY))
#define TILT (BIT(WX) | BIT(WY))
#define RAISED (BIT(TZ) | TILT)

static const Model models[] = {
    [CAG_FIT_LINE] = {"line", {2, 2}, {0, 0}, line_residuals},
    [CAG_FIT_PLANE] = {"plane", {3, 3}, {0, 0}, plane_residuals},
    [CAG_FIT_CIRCLE] = {"circle",
                        {3, 3},
                        {CENTER | RAISED | BIT(SIZE_A), CENTER | BIT(SIZE_A)},
                        circle_residuals},
    [CAG_FIT_ELLIPSE] = {"ellipse",
                         {5, 5},
                         {CENTER | RAISED | BIT(WZ) | BIT(SIZE_A) | BIT(SIZE_B),
                          CENTER | BIT(WZ) | BIT(SIZE_A) | BIT(SIZE_B)},
                         ellipse_residuals},
    [CAG_FIT_SPHERE] = {"sphere",
                        {4, 4},
                        {CENTER | BIT(TZ) | BIT(SIZE_A), CENTER | BIT(TZ) | BIT(SIZE_A)},
                        sphere_residuals},
    // Up to six cylinders pass through five points.
    [CAG_FIT_CYLINDER] = {"cylinder",
                          {6, 6},
                          {CENTER | TILT | BIT(SIZE_A), CENTER | TILT | BIT(SIZE_A)},
                          cylinder_residuals},
};

size_t cag_shape_fit_least(CagFitShape shape, bool planar) { return models[shape].least[planar]; }

// --- Least squares ---

typedef struct Search {
  const Points *points;
  const Model *model;
  unsigned moves;
} Search;

// The change of a residual with each unknown that the shape has, and the residual itself.
static void jacobian_row(const Residual *r, CagVec3 q, unsigned moves, double *row) {
  const CagVec3 turn = cag_cross(q, r->gradient);
  const double all[UNKNOWNS] = {-r->gradient.x, -r->gradient.y, -r->gradient.z, -turn.x,
                                -turn.y,        -turn.z,        r->by_a,        r->by_b};
  int k = 0;
  for (int i = 0; i < UNKNOWNS; i++)
    if (moves & BIT(i)) row[k++] = all[i];
  row[k] = -r->value;
}

static int unknowns_of(unsigned moves) {
  int k = 0;
  for (int i = 0; i < UNKNOWNS; i++) k += (moves & BIT(i)) != 0;
  return k;
}

// The triangle of the linearized problem at s. Returns the sum of the squared residuals.
static double linearize(const Search *search, const State *s, CagGivens *t) {
  double sum = 0, row[CAG_GIVENS_MOST];
  *t = (CagGivens){.columns = unknowns_of(search->moves) + 1};
  for (size_t i = 0; i < search->points->n && !cag_stopped(); i++) {
    const CagVec3 q = in_frame(&s->frame, normalized(search->points, i));
    Residual r[2];
    const int count = search->model->residuals(s, q, r);
    for (int k = 0; k < count; k++) {
      jacobian_row(&r[k], q, search->moves, row);
      cag_givens_add(t, row);
      sum += r[k].value * r[k].value;
    }
  }
  return sum;
}

// Solves with the damping and moves the state. Returns the length of the step; -1 if the shape would
// lose its size.
static double take_step(const Search *search, const CagGivens *t, double damping, State *s) {
  CagGivens damped = *t;
  const int k = t->columns - 1;
  double x[CAG_GIVENS_MOST], row[CAG_GIVENS_MOST], all[UNKNOWNS] = {0}, length = 0;
  for (int i = 0; i < k; i++) {
    memset(row, 0, sizeof row);
    row[i] = sqrt(damping * (double)search->points->n);
    cag_givens_add(&damped, row);
  }
  if (!cag_givens_solve(&damped, x)) return -1;
  for (int i = 0, j = 0; i < UNKNOWNS; i++)
    if (search->moves & BIT(i)) all[i] = x[j++];
  for (int i = 0; i < UNKNOWNS; i++) length = hypot(length, all[i]);
  CagTransform motion;
  CagError scratch;
  if (cag_motion_of(all, &motion, &scratch)) return -1;
  s->frame = cag_transform_multiply(&s->frame, &motion);
  s->a += all[SIZE_A];
  s->b += all[SIZE_B];
  const bool sized =
      (!(search->moves & BIT(SIZE_A)) || s->a > 0) && (!(search->moves & BIT(SIZE_B)) || s->b > 0);
  return sized && isfinite(length) ? length : -1;
}

// The damping, relative to the mean square of the residuals' changes, starts at FIRST and stays
// above LEAST, so that unknowns without effect do not move.
#define FIRST_DAMPING 1e-3
#define LEAST_DAMPING 1e-15
#define MOST_DAMPING 1e8
// Near the minimum the sum of the squares changes less than its rounding.
#define ROUNDED_SUM 1e-12
// Below this length, a step that is not shorter than the one before is rounding.
#define LAST_STEPS 1e-9

// Improves the state. Returns the sum of the squared residuals; *settled tells whether it is minimal.
static double improve(const Search *search, int steps, State *s, bool *settled) {
  CagGivens t, next;
  double sum = linearize(search, s, &t), damping = FIRST_DAMPING, before = INFINITY;
  *settled = false;
  for (int i = 0; i < steps && !*settled && !cag_stopped(); i++) {
    State trial = *s;
    const double length = take_step(search, &t, damping, &trial);
    const double found = length < 0 ? INFINITY : linearize(search, &trial, &next);
    if (!(found <= sum * (1 + ROUNDED_SUM))) {
      damping *= 10;
      *settled = damping > MOST_DAMPING || (length >= 0 && length < SMALL_STEP);
      continue;
    }
    *settled = length < SMALL_STEP || (length < LAST_STEPS && length >= before / 2);
    *s = trial;
    sum = found;
    t = next;
    before = length;
    damping = fmax(damping / 100, LEAST_DAMPING);
    if (s->a > INFINITE) break;
  }
  return sum;
}

// --- Starts ---

static CagStatus find_spread(Points *p, CagError *err) {
  double sum = 0, row[3], vectors[9];
  const double share = 1 / (double)p->n;
  CagGivens t = {.columns = 3};
  p->center = cag_vec3(0, 0, 0);
  for (size_t i = 0; i < p->n; i++) {
    if (cag_stop_check(err)) return err->status;
    const CagVec3 v = p->items[i];
    if (!isfinite(cag_dot(v, v)))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "points", (long)i,
                      "points[%zu] is not finite, or so large that its square overflows", i);
    p->center = cag_madd(p->center, share, v);
  }
  for (size_t i = 0; i < p->n && !cag_stopped(); i++) {
    const CagVec3 d = cag_sub(p->items[i], p->center);
    row[0] = d.x, row[1] = d.y, row[2] = d.z;
    cag_givens_add(&t, row);
    sum = fmax(sum, cag_norm(d));
  }
  p->spread = sum;
  const double size = cag_norm(p->center) + sum;
  if (!(sum > FLAT * size))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_coincident_points, "points", -1,
                    "all points coincide");
  if (!cag_givens_svd(&t, 3, p->extent, vectors))
    return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "points", -1,
                    "the singular values of the points were not found");
  for (int i = 0; i < 3; i++)
    p->axes[i] = cag_vec3(vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]);
  p->axes[2] = cag_cross(p->axes[0], p->axes[1]);
  return CAG_OK;
}

// The circle (of the x and y in the frame), or the sphere, by linear equations in the center and in
// r^2 - |center|^2. Moves the frame to its center.
static void algebraic_round(const Points *p, bool in_plane, State *s) {
  const int k = in_plane ? 2 : 3;
  CagGivens t = {.columns = k + 2};
  double row[5], x[5] = {0};
  for (size_t i = 0; i < p->n && !cag_stopped(); i++) {
    const CagVec3 q = in_frame(&s->frame, normalized(p, i));
    double *r = row;
    *r++ = 2 * q.x;
    *r++ = 2 * q.y;
    if (!in_plane) *r++ = 2 * q.z;
    *r++ = 1;
    *r = q.x * q.x + q.y * q.y + (in_plane ? 0 : q.z * q.z);
    cag_givens_add(&t, row);
  }
  if (!cag_givens_solve(&t, x)) memset(x, 0, sizeof x);
  CagVec3 c = cag_vec3(x[0], x[1], in_plane ? 0 : x[2]);
  double square = x[k] + cag_dot(c, c);
  if (!(square > 0) || !isfinite(square)) {
    c = cag_vec3(0, 0, 0);
    square = 1;
  }
  const CagTransform move = cag_translate(c);
  s->frame = cag_transform_multiply(&s->frame, &move);
  s->a = s->b = sqrt(square);
}

// The conic k0 + k1 x + k2 y + k3 x^2 + k4 xy + k5 y^2 = 0 with 4 k3 k5 - k4^2 = 1 that fits best
// algebraically, which is always an ellipse (Halir and Flusser 1998). r: the triangle of the rows [1,
// x, y, x^2, xy, y^2]; its last three rows are what the first three unknowns cannot compensate.
static bool algebraic_ellipse(const CagGivens *r, double out[6]) {
  double m[9], c[3][3], re[3], im[3], vectors[9], none[1];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      c[i][j] = 0;
      for (int k = 0; k < 3; k++) c[i][j] += r->r[3 + k][3 + i] * r->r[3 + k][3 + j];
    }
  for (int j = 0; j < 3; j++) {
    m[j] = c[2][j] / 2;
    m[3 + j] = -c[1][j];
    m[6 + j] = c[0][j] / 2;
  }
  if (LAPACKE_dgeev(LAPACK_ROW_MAJOR, 'N', 'V', 3, m, 3, re, im, none, 1, vectors, 3) != 0)
    return false;
  for (int k = 0; k < 3; k++) {
    const double a = vectors[k], b = vectors[3 + k], d = vectors[6 + k];
    if (im[k] != 0 || !(4 * a * d - b * b > 0)) continue;
    out[3] = a, out[4] = b, out[5] = d;
    for (int i = 2; i >= 0; i--) {
      if (r->r[i][i] == 0) return false;
      out[i] = 0;
      for (int j = i + 1; j < 6; j++) out[i] -= r->r[i][j] * out[j];
      out[i] /= r->r[i][i];
    }
    return true;
  }
  return false;
}

// The frame and the semi-axes of the ellipse with these coefficients. Returns false if they are not those of a real ellipse.
static bool ellipse_axes(const double k[6], State *s) {
  const double a = k[3], b = k[4], c = k[5], d = 4 * a * c - b * b;
  const double x = (b * k[2] - 2 * c * k[1]) / d, y = (b * k[1] - 2 * a * k[2]) / d;
  const double level = -(k[0] + (k[1] * x + k[2] * y) / 2);
  const double middle = (a + c) / 2, half = hypot((a - c) / 2, b / 2);
  const double first = level / (middle + half), second = level / (middle - half);
  if (!(first > 0) || !(second > 0) || !isfinite(first + second)) return false;
  // The eigenvector of middle + half belongs to the first semi-axis.
  const double angle = atan2(b, a - c) / 2;
  CagTransform turn;
  CagError scratch;
  const double twist[6] = {0, 0, 0, 0, 0, angle};
  if (cag_motion_of(twist, &turn, &scratch)) return false;
  turn.m[0][3] = x;
  turn.m[1][3] = y;
  s->frame = cag_transform_multiply(&s->frame, &turn);
  s->a = sqrt(first);
  s->b = sqrt(second);
  return true;
}

static bool ellipse_start(const Points *p, State *s) {
  CagGivens t = {.columns = 6};
  double k[6];
  for (size_t i = 0; i < p->n && !cag_stopped(); i++) {
    const CagVec3 q = in_frame(&s->frame, normalized(p, i));
    double row[6] = {1, q.x, q.y, q.x * q.x, q.x * q.y, q.y * q.y};
    cag_givens_add(&t, row);
  }
  return algebraic_ellipse(&t, k) && ellipse_axes(k, s);
}

// The frame with z along the shortest extent of the points; in the plane, the world's axes.
static State flat_start(const Points *p, bool planar) {
  State s = {.frame = cag_transform_identity(), .a = 1, .b = 1};
  if (!planar) s.frame = frame_of(p->axes[0], p->axes[1], p->axes[2], cag_vec3(0, 0, 0));
  return s;
}

static double fit_ellipse(const Search *search, bool planar, State *s, bool *settled) {
  // From the algebraic ellipse, and from one with the extents of the points.
  State best = *s;
  double least = INFINITY;
  for (int k = 0; k < 2; k++) {
    State start = flat_start(search->points, planar);
    if (k == 0 && !ellipse_start(search->points, &start)) continue;
    if (k == 1 && planar) {
      const CagVec3 *axes = search->points->axes;
      start.frame = frame_of(axes[0], axes[1], axes[2], cag_vec3(0, 0, 0));
    }
    if (k == 1) {
      const double share = sqrt(2 / (double)search->points->n) / search->points->spread;
      start.a = search->points->extent[0] * share;
      start.b = search->points->extent[1] * share;
    }
    bool done;
    const double sum = improve(search, STEPS_MOST, &start, &done);
    if (!(sum < least * (1 - ROUNDED_SUM))) continue;
    least = sum;
    best = start;
    *settled = done;
  }
  *s = best;
  if (s->a >= s->b) return least;
  const CagTransform quarter =
      frame_of(cag_vec3(0, 1, 0), cag_vec3(-1, 0, 0), cag_vec3(0, 0, 1), cag_vec3(0, 0, 0));
  s->frame = cag_transform_multiply(&s->frame, &quarter);
  const double a = s->a;
  s->a = s->b;
  s->b = a;
  return least;
}

// The directions of the axis that are tried, in the principal axes of the points: a half of the 26
// neighbors of a cube.
static double fit_cylinder(const Search *search, State *s, bool *settled) {
  const Points *p = search->points;
  double least = INFINITY;
  bool done;
  for (int i = 14; i < 27; i++) {
    const double x = i / 9 - 1, y = i / 3 % 3 - 1, z = i % 3 - 1;
    CagVec3 axis = cag_scaled(p->axes[0], x);
    axis = cag_unit(cag_madd(cag_madd(axis, y, p->axes[1]), z, p->axes[2]));
    CagVec3 side = cag_cross(axis, fabs(axis.x) < 0.6 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0));
    side = cag_unit(side);
    State start = {.frame = frame_of(side, cag_cross(axis, side), axis, cag_vec3(0, 0, 0))};
    algebraic_round(p, true, &start);
    const double sum = improve(search, STEPS_TRIAL, &start, &done);
    if (!(sum < least) || start.a > INFINITE) continue;
    least = sum;
    *s = start;
  }
  return improve(search, STEPS_MOST, s, settled);
}

// --- The fit ---

// The number of different points, up to `most`.
#define LEAST_MOST 6
static size_t different_points(const Points *p, size_t most) {
  CagVec3 found[LEAST_MOST];
  size_t n = 0;
  for (size_t i = 0; i < p->n && n < most && !cag_stopped(); i++) {
    const CagVec3 q = normalized(p, i);
    bool new = true;
    for (size_t k = 0; k < n; k++) new = new &&cag_norm(cag_sub(q, found[k])) > FLAT;
    if (new) found[n++] = q;
  }
  return n;
}

static CagStatus check_points(const Points *p, CagFitShape shape, bool planar, CagError *err) {
  const char *name = models[shape].name;
  const bool space = shape == CAG_FIT_SPHERE || shape == CAG_FIT_CYLINDER;
  if (shape != CAG_FIT_LINE && p->extent[1] <= FLAT * p->extent[0])
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_collinear_points, "points", -1,
                    "the points are collinear, so they determine no %s", name);
  if (space && p->extent[2] <= FLAT * p->extent[0])
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_coplanar_points, "points", -1,
                    "the points are coplanar, so they determine no %s", name);
  const size_t least = models[shape].least[planar], count = different_points(p, least);
  if (cag_stop_check(err)) return err->status;
  if (count < least)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "expected at least %zu different points for the %s, found %zu", least, name,
                    count);
  const double a = p->extent[shape == CAG_FIT_PLANE], b = p->extent[shape == CAG_FIT_PLANE ? 2 : 1];
  const bool level =
      (shape == CAG_FIT_LINE || shape == CAG_FIT_PLANE) && (a - b) <= FLAT * p->extent[0];
  if (level && !(planar && shape == CAG_FIT_PLANE))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_underdetermined, "points", -1,
                    "the points extend equally in two directions, so several %ss fit equally well",
                    name);
  return CAG_OK;
}

// Whether another shape nearby would fit as well. An ellipse that is a circle has no direction.
static bool ambiguous(const Search *search, const State *s) {
  CagGivens t;
  double values[CAG_GIVENS_MOST], vectors[CAG_GIVENS_MOST * CAG_GIVENS_MOST];
  Search fewer = *search;
  if (fabs(s->a - s->b) <= AMBIGUOUS * s->a) fewer.moves &= ~BIT(WZ);
  linearize(&fewer, s, &t);
  const int k = t.columns - 1;
  return k > 0 &&
         (!cag_givens_svd(&t, k, values, vectors) || values[k - 1] <= AMBIGUOUS * values[0]);
}

static CagStatus fit_state(const Search *search, CagFitShape shape, bool planar, State *s,
                           CagError *err) {
  const CagVec3 *axes = search->points->axes;
  bool settled = true;
  *s = flat_start(search->points, planar);
  if (shape == CAG_FIT_LINE) {
    s->frame = frame_of(axes[1], axes[2], axes[0], cag_vec3(0, 0, 0));
    return CAG_OK;
  }
  if (shape == CAG_FIT_PLANE) return CAG_OK;
  if (shape == CAG_FIT_ELLIPSE) {
    fit_ellipse(search, planar, s, &settled);
  } else if (shape == CAG_FIT_CYLINDER) {
    fit_cylinder(search, s, &settled);
  } else {
    algebraic_round(search->points, shape == CAG_FIT_CIRCLE, s);
    improve(search, STEPS_MOST, s, &settled);
  }
  if (cag_stop_check(err)) return err->status;
  if (!settled || s->a > INFINITE)
    return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "points", -1,
                    "no %s is nearest to the points: larger ones are always nearer",
                    search->model->name);
  if (ambiguous(search, s))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_underdetermined, "points", -1,
                    "several %ss fit the points equally well", search->model->name);
  return CAG_OK;
}

// Whether the largest component of column i of a frame is negative.
static bool points_back(const CagTransform *t, int i) {
  double largest = 0;
  for (int k = 0; k < 3; k++)
    if (fabs(t->m[k][i]) > fabs(largest)) largest = t->m[k][i];
  return largest < 0;
}

static void negate_columns(CagTransform *t, int i, int j) {
  for (int k = 0; k < 3; k++) {
    t->m[k][i] = -t->m[k][i] + 0.0;
    t->m[k][j] = -t->m[k][j] + 0.0;
  }
}

// Of the frames that describe the same shape, one whose z and x axes have positive components where
// these are largest, so that the result does not depend on the start.
static void orient(CagTransform *t) {
  if (points_back(t, 2)) negate_columns(t, 1, 2);
  if (points_back(t, 0)) negate_columns(t, 0, 1);
}

// Scales back, and measures the distances and the range of z.
static void finish(const Search *search, const State *s, CagShapeFit *out) {
  const Points *p = search->points;
  double sum = 0;
  *out = (CagShapeFit){.frame = s->frame, .low = INFINITY, .high = -INFINITY};
  for (size_t i = 0; i < p->n && !cag_stopped(); i++) {
    const CagVec3 q = in_frame(&s->frame, normalized(p, i));
    Residual r[2];
    const int count = search->model->residuals(s, q, r);
    const double distance = count == 2 ? hypot(r[0].value, r[1].value) : fabs(r[0].value);
    sum += distance * distance / (double)p->n;
    out->largest = fmax(out->largest, distance * p->spread);
    out->low = fmin(out->low, q.z * p->spread);
    out->high = fmax(out->high, q.z * p->spread);
  }
  out->rms = sqrt(sum) * p->spread;
  out->a = s->a * p->spread;
  out->b = s->b * p->spread;
  const double center[3] = {p->center.x, p->center.y, p->center.z};
  for (int i = 0; i < 3; i++) out->frame.m[i][3] = center[i] + s->frame.m[i][3] * p->spread;
}

CagStatus cag_shape_fit(CagFitShape shape, const CagVec3 *points, size_t n, bool planar,
                        CagShapeFit *out, CagError *err) {
  const size_t least = cag_shape_fit_least(shape, planar);
  if (n < least)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "expected at least %zu points for the %s, found %zu", least, models[shape].name,
                    n);
  Points p = {.items = points, .n = n};
  CagStatus status = find_spread(&p, err);
  if (!status) status = cag_stop_check(err);
  if (!status) status = check_points(&p, shape, planar, err);
  if (status) return status;
  const Search search = {&p, &models[shape], models[shape].moves[planar]};
  State s;
  status = fit_state(&search, shape, planar, &s, err);
  if (status) return status;
  orient(&s.frame);
  finish(&search, &s, out);
  out->frame.planar = planar && shape != CAG_FIT_LINE;
  return cag_stop_check(err);
}
