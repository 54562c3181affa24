// Cubic B-spline approximations of curves, by Hermite pieces that are halved until they fit.
//
// The error of a cubic Hermite piece of length h is about h^4 / 384 times the fourth derivative and
// is largest in the middle, so it is measured at a few points of the piece. Joints of pieces are
// double knots (continuous first derivative); breaks whose sides differ are triple knots.

#include "geom/curve/approximate.h"

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/linalg/tolerance.h"

// Maximum depth of halvings of a smooth piece, and maximum number of pieces; beyond, the fit fails.
#define DEPTH 40
#define MOST_PIECES 2000000
// The measured error may be this fraction of the tolerance, since the largest lies between the
// samples.
#define SAFETY 0.9
// Derivatives of both sides that differ by less than this fraction are equal.
#define SMOOTH CAG_COINCIDENT

typedef struct Node {
  double t;
  CagVec3 point, left, right; // derivatives of both sides
} Node;

typedef struct Fit {
  CagCurveSampler sample;
  void *context;
  double tolerance;
  Node *nodes;
  size_t n, capacity;
} Fit;

static CagVec3 hermite(const Node *a, const Node *b, double t) {
  const double h = b->t - a->t, s = (t - a->t) / h, r = 1 - s;
  CagVec3 p = cag_scaled(a->point, r * r * (1 + 2 * s));
  p = cag_madd(p, s * s * (1 + 2 * r), b->point);
  p = cag_madd(p, h * s * r * r, a->right);
  return cag_madd(p, -h * s * s * r, b->left);
}

static CagStatus add(Fit *f, Node node, CagError *err) {
  if (!CAG_RESERVE(f->nodes, f->capacity, f->n + 1)) return cag_fail_memory(err);
  f->nodes[f->n++] = node;
  return CAG_OK;
}

static CagStatus fail_convergence(double t, CagError *err) {
  char text[32];
  return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "tolerance", -1,
                  "the curve cannot be fitted within the tolerance near t = %s",
                  cag_number_text(t, text));
}

// Adds the nodes after a up to b.
static CagStatus fit_piece(Fit *f, const Node *a, const Node *b, int depth, CagError *err) {
  static const double places[] = {0.5, 0.21, 0.79, 0.36, 0.64};
  double error = 0;
  Node middle = {.t = a->t + (b->t - a->t) / 2};
  for (int i = 0; i < 5 && error <= SAFETY * f->tolerance; i++) {
    const double t = i == 0 ? middle.t : a->t + places[i] * (b->t - a->t);
    CagVec3 d[2];
    CagStatus status = f->sample(f->context, t, CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    if (i == 0) {
      middle.point = d[0];
      middle.left = middle.right = d[1];
    }
    error = fmax(error, cag_norm(cag_sub(hermite(a, b, t), d[0])));
  }
  if (error <= SAFETY * f->tolerance) return add(f, *b, err);
  if (depth == 0 || f->n > MOST_PIECES || !(a->t < middle.t && middle.t < b->t))
    return fail_convergence(middle.t, err);
  CagStatus status = fit_piece(f, a, &middle, depth - 1, err);
  return status ? status : fit_piece(f, &middle, b, depth - 1, err);
}

static bool smooth(const Node *n) {
  const double size = fmax(cag_norm(n->left), cag_norm(n->right));
  return cag_norm(cag_sub(n->left, n->right)) <= SMOOTH * size;
}

static void put(double *h, CagVec3 p) {
  h[0] = p.x;
  h[1] = p.y;
  h[2] = p.z;
  h[3] = 1;
}

// The nodes as a cubic B-spline.
static CagStatus assemble(const Fit *f, int dimension, CagCurve **out, CagError *err) {
  double *h = cag_malloc(sizeof(double) * (4 * 3 * f->n + 3 * f->n + 8));
  if (!h) return cag_fail_memory(err);
  double *knots = h + 4 * 3 * f->n;
  size_t points = 0, m = 0;
  for (int k = 0; k < 4; k++) knots[m++] = f->nodes[0].t;
  put(h + 4 * points++, f->nodes[0].point);
  for (size_t i = 0; i + 1 < f->n; i++) {
    const Node *a = &f->nodes[i], *b = &f->nodes[i + 1];
    const double third = (b->t - a->t) / 3;
    const bool last = i + 2 == f->n, corner = last || !smooth(b);
    put(h + 4 * points++, cag_madd(a->point, third, a->right));
    put(h + 4 * points++, cag_madd(b->point, -third, b->left));
    if (corner) put(h + 4 * points++, b->point);
    for (int k = 0; k < (last ? 4 : corner ? 3 : 2); k++) knots[m++] = b->t;
  }
  CagStatus status =
      cag_nurbs_new(h, points, 3, knots, false, 0, CAG_NURBS_BSPLINE, dimension, out, err);
  cag_free(h);
  return status;
}

CagStatus cag_curve_fit_sampler(CagCurveSampler sample, void *context, const double *cuts, size_t n,
                                double tolerance, int dimension, CagCurve **out, CagError *err) {
  Fit f = {.sample = sample, .context = context, .tolerance = tolerance};
  CagStatus status = CAG_OK;
  Node from = {0};
  for (size_t i = 0; !status && i < n; i++) {
    Node node = {.t = cuts[i]};
    CagVec3 d[2] = {{0, 0, 0}};
    if (i > 0) {
      status = sample(context, cuts[i], CAG_SIDE_LEFT, d, err);
      node.left = d[1];
    }
    if (!status && i + 1 < n) {
      status = sample(context, cuts[i], CAG_SIDE_RIGHT, d, err);
      node.right = d[1];
    }
    if (status) break;
    node.point = d[0];
    status = i == 0 ? add(&f, node, err) : fit_piece(&f, &from, &node, DEPTH, err);
    from = node;
  }
  if (!status) status = assemble(&f, dimension, out, err);
  cag_free(f.nodes);
  return status;
}

static CagStatus sample_curve(void *context, double t, CagSide side, CagVec3 out[2],
                              CagError *err) {
  return cag_curve_eval(context, t, 1, side, out, err);
}

CagStatus cag_curve_approximate(const CagCurve *c, double tolerance, CagCurve **out,
                                CagError *err) {
  if (!(tolerance > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_value, "tolerance", -1,
                    "`tolerance` must be positive");
  if (cag_curve_resting_view(c, NULL)) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  CagStatus status = cag_curve_to_nurbs(c, out, err);
  if (status != CAG_E_UNSUPPORTED) return status;
  double *cuts;
  size_t n;
  status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  status =
      cag_curve_fit_sampler(sample_curve, (void *)c, cuts, n, tolerance, c->dimension, out, err);
  cag_free(cuts);
  return status;
}

// --- Distance of two curves ---

typedef struct Gap {
  const CagCurve *a, *b;
} Gap;

static CagStatus gap_at(const Gap *g, double t, CagSide side, double *out, CagError *err) {
  CagVec3 p, q;
  double u = cag_curve_remap(g->a, t, g->b->start, g->b->end);
  CagStatus status = cag_curve_eval(g->a, t, 0, side, &p, err);
  if (!status)
    status = cag_curve_eval(g->b, fmin(g->b->end, fmax(g->b->start, u)), 0, side, &q, err);
  if (!status) *out = cag_norm(cag_sub(p, q));
  return status;
}

// The largest gap over [a, b] from samples, refined by golden section around the largest.
static CagStatus largest_gap(const Gap *g, double a, double b, double *most, CagError *err) {
  enum { SAMPLES = 16, SECTIONS = 40 };
  const double golden = 0.6180339887498949; // (sqrt 5 - 1) / 2
  double best = -1, at = a, x;
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i <= SAMPLES; i++) {
    double t = i == SAMPLES ? b : a + (b - a) * i / SAMPLES;
    status = gap_at(g, t, i == SAMPLES ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &x, err);
    if (!status && x > best) {
      best = x;
      at = t;
    }
  }
  const double step = (b - a) / SAMPLES;
  double low = fmax(a, at - step), high = fmin(b, at + step);
  for (int i = 0; !status && i < SECTIONS; i++) {
    double l = high - golden * (high - low), r = low + golden * (high - low), y = 0;
    status = gap_at(g, l, CAG_SIDE_RIGHT, &x, err);
    if (!status) status = gap_at(g, r, CAG_SIDE_LEFT, &y, err);
    if (status) break;
    best = fmax(best, fmax(x, y));
    if (x > y) high = r;
    else low = l;
  }
  if (!status) *most = fmax(*most, best);
  return status;
}

CagStatus cag_curve_deviation(const CagCurve *a, const CagCurve *b, double *out, CagError *err) {
  Gap g = {a, b};
  double *ca, *cb, most = 0;
  size_t na, nb;
  CagStatus status = cag_curve_cuts(a, &ca, &na, err);
  if (status) return status;
  status = cag_curve_cuts(b, &cb, &nb, err);
  if (status) {
    cag_free(ca);
    return status;
  }
  double from = a->start;
  for (size_t i = 1, k = 1; !status && i < na;) {
    // The next break of either curve.
    double next = ca[i];
    if (k + 1 < nb) next = fmin(next, cag_curve_remap(b, cb[k], a->start, a->end));
    if (next >= ca[i]) i++;
    if (k + 1 < nb && next >= cag_curve_remap(b, cb[k], a->start, a->end)) k++;
    if (next > from) status = largest_gap(&g, from, next, &most, err);
    from = fmax(from, next);
  }
  cag_free(ca);
  cag_free(cb);
  if (!status) *out = most;
  return status;
}
