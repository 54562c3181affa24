// Hodographs and antiderivatives: differences and sums of control points, and the quotient rule for
// rational curves.

#include "geom/curve/hodograph.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/bernstein.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs_ops.h"

// Control points of a polynomial B-spline, and room for those of the result.
typedef struct Polynomial {
  CagCurve *nurbs;
  CagNurbsView view;
  CagVec3 *points; // count + 1
  double *knots;   // count + degree + 3
} Polynomial;

static void polynomial_free(Polynomial *p) {
  cag_curve_release(p->nurbs);
  cag_free(p->points);
  cag_free(p->knots);
}

static CagStatus fail_kind(const CagCurve *c, const char *result, CagError *err) {
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "C", -1,
                  "%s of a curve of kind %s has no exact form; use approximate(C, tolerance) first",
                  result, c->kind->name);
}

static CagStatus polynomial_open(const CagCurve *c, const char *result, Polynomial *out,
                                 CagError *err) {
  *out = (Polynomial){0};
  if (!c->kind->to_nurbs) return fail_kind(c, result, err);
  CagStatus status = cag_curve_to_nurbs(c, &out->nurbs, err);
  if (status) return status;
  cag_curve_nurbs_view(out->nurbs, &out->view);
  if (out->view.rational) {
    status = fail_kind(c, result, err);
  } else {
    const size_t knots = out->view.count + (size_t)out->view.degree + 3;
    out->points = cag_malloc((out->view.count + 1) * sizeof *out->points);
    out->knots = cag_malloc(knots * sizeof *out->knots);
    if (!out->points || !out->knots) status = cag_fail_memory(err);
  }
  if (status) polynomial_free(out);
  return status;
}

static CagVec3 control(const Polynomial *p, size_t i) {
  const double *h = p->view.homogeneous + 4 * i;
  return cag_vec3(h[0], h[1], h[2]);
}

// The curve of these points, with the unit of the parameter of c.
static CagStatus same_unit(const CagCurve *c, CagStatus status, CagCurve **made, CagCurve **out,
                           CagError *err) {
  if (!status) status = cag_curve_reparametrize_as(*made, c->start, c->end, c->angular, out, err);
  cag_curve_release(*made);
  return status;
}

// --- Hodographs ---

// The derivative of a circle or ellipse is the same arc, a quarter turn ahead, about the origin.
static CagStatus arc_hodograph(const CagCurve *c, CagCurve **out, CagError *err) {
  CagCoil arc;
  CagCurve *made = NULL;
  cag_curve_arc_coil(c, &arc);
  if (arc.rate < 0) { // the same points by increasing angles
    arc.y = cag_scaled(arc.y, -1);
    arc.phase = -arc.phase;
    arc.rate = -arc.rate;
  }
  const CagVec3 x = cag_scaled(arc.y, arc.rate), y = cag_scaled(arc.x, -arc.rate);
  CagTransform frame = cag_transform_identity();
  frame.planar = c->dimension == 2;
  frame.m[0][0] = x.x, frame.m[1][0] = x.y, frame.m[2][0] = x.z;
  frame.m[0][1] = y.x, frame.m[1][1] = y.y, frame.m[2][1] = y.z;
  CagStatus status = cag_curve_arc(1, 1, arc.phase + arc.rate * c->start,
                                   arc.phase + arc.rate * c->end, &frame, &made, err);
  return same_unit(c, status, &made, out, err);
}

// Control points p (P_{i+1} - P_i) / (k_{i+p+1} - k_{i+1}), over the same knots without both ends.
static CagStatus polynomial_hodograph(const CagCurve *c, CagCurve **out, CagError *err) {
  Polynomial p;
  CagStatus status = polynomial_open(c, "the hodograph", &p, err);
  if (status) return status;
  const size_t n = p.view.count - 1;
  const int degree = p.view.degree;
  const double *k = p.view.knots;
  CagCurve *made = NULL;
  for (size_t i = 0; i < n; i++) {
    const double span = k[i + (size_t)degree + 1] - k[i + 1];
    const CagVec3 step = cag_sub(control(&p, i + 1), control(&p, i));
    p.points[i] = cag_scaled(step, span > 0 ? degree / span : 0);
  }
  if (degree > 1) {
    status = cag_curve_nurbs(p.points, NULL, n, degree - 1, k + 1, c->dimension, &made, err);
    if (status && err->id == CAG_ERR_knot_multiplicity)
      cag_fail(err, status, CAG_ERR_knot_multiplicity, "C", -1,
               "the curve has a corner, where its derivative jumps; split it there first");
  } else if (n == 1) {
    status = cag_curve_resting(p.points[0], c->dimension, c->start, c->end, c->angular, &made, err);
  } else {
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_knot_multiplicity, "C", -1,
                      "the curve has corners, where its derivative jumps; split it there first");
  }
  polynomial_free(&p);
  if (degree > 1) return same_unit(c, status, &made, out, err);
  *out = made;
  return status;
}

// The derivative of a rational piece h of degree p over 0..1: (H' w - H w') / w^2, of degree 2 p.
// points and weights have 2 p + 1 entries.
static void piece_hodograph(const double *h, int p, CagVec3 *points, double *weights) {
  const int q = 2 * p;
  for (int k = 0; k <= q; k++) points[k] = cag_vec3(0, 0, 0), weights[k] = 0;
  // Products of Bernstein polynomials. The numerator has the degree q - 1, and is raised by 1.
  for (int i = 0; i <= p; i++)
    for (int j = 0; j <= p; j++) {
      const double *a = h + 4 * i, *b = h + 4 * j;
      weights[i + j] +=
          cag_binomial(p, i) * cag_binomial(p, j) / cag_binomial(q, i + j) * a[3] * b[3];
      if (i == p) continue;
      const double share =
          p * cag_binomial(p - 1, i) * cag_binomial(p, j) / cag_binomial(q - 1, i + j);
      const double *next = a + 4, dw = next[3] - a[3];
      const CagVec3 term =
          cag_vec3((next[0] - a[0]) * b[3] - b[0] * dw, (next[1] - a[1]) * b[3] - b[1] * dw,
                   (next[2] - a[2]) * b[3] - b[2] * dw);
      const int k = i + j;
      points[k] = cag_madd(points[k], share * (q - k) / q, term);
      points[k + 1] = cag_madd(points[k + 1], share * (k + 1) / q, term);
    }
  for (int k = 0; k <= q; k++) points[k] = cag_scaled(points[k], 1 / weights[k]);
}

// The pieces between different knots, as a spline with all of them in common.
typedef struct RationalHodograph {
  CagVec3 *points;
  double *weights, *knots;
  size_t count, knot_count; // so far
} RationalHodograph;

static void rational_free(RationalHodograph *r) {
  cag_free(r->points);
  cag_free(r->weights);
  cag_free(r->knots);
}

// Adds the piece of a curve over [a, b]. Its first point is the last one so far.
static CagStatus add_piece(RationalHodograph *r, const CagCurve *piece, double a, double b,
                           CagError *err) {
  CagNurbsView v;
  cag_curve_nurbs_view(piece, &v);
  const int q = 2 * v.degree;
  const bool first = r->count == 0;
  CagVec3 *points = r->points + (first ? 0 : r->count - 1);
  double *weights = r->weights + (first ? 0 : r->count - 1);
  const CagVec3 joint = first ? cag_vec3(0, 0, 0) : points[0];
  const double weight = first ? 0 : weights[0];
  piece_hodograph(v.homogeneous, v.degree, points, weights);
  double size = 0;
  const double scale = first ? 1 : weight / weights[0];
  for (int k = 0; k <= q; k++) {
    points[k] = cag_scaled(points[k], 1 / (b - a));
    weights[k] *= scale;
    size = fmax(size, cag_norm(points[k]));
  }
  if (!first && cag_norm(cag_sub(points[0], joint)) > 1e-9 * size)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_knot_multiplicity, "C", -1,
                    "the curve has a corner, where its derivative jumps; split it there first");
  r->count += (size_t)(first ? q + 1 : q);
  for (int k = first ? -1 : 0; k < q; k++) r->knots[r->knot_count++] = a;
  return cag_stop_check(err);
}

static CagStatus rational_hodograph(const CagCurve *c, const CagCurve *nurbs, CagCurve **out,
                                    CagError *err) {
  CagNurbsView v;
  CagCurve **pieces, *made = NULL;
  size_t n, done = 0;
  cag_curve_nurbs_view(nurbs, &v);
  const int q = 2 * v.degree;
  if (q > CAG_MAX_DEGREE) return fail_kind(c, "the hodograph", err);
  CagStatus status = cag_curve_to_bezier(nurbs, &pieces, &n, err);
  if (status) return status;
  const size_t room = n * (size_t)q + 1;
  RationalHodograph r = {.points = cag_malloc(room * sizeof *r.points),
                         .weights = cag_malloc(room * sizeof *r.weights),
                         .knots = cag_malloc((room + (size_t)q + 1) * sizeof *r.knots)};
  if (!r.points || !r.weights || !r.knots) status = cag_fail_memory(err);
  double a = nurbs->start;
  for (size_t i = 0; !status && done < n && i < v.count + (size_t)v.degree + 1; i++) {
    const double b = fmin(v.knots[i], nurbs->end);
    if (!(b > a)) continue;
    status = add_piece(&r, pieces[done++], a, b, err);
    a = b;
  }
  for (int k = 0; !status && k <= q; k++) r.knots[r.knot_count++] = nurbs->end;
  if (!status)
    status = cag_curve_nurbs(r.points, r.weights, r.count, q, r.knots, c->dimension, &made, err);
  for (size_t i = 0; i < n; i++) cag_curve_release(pieces[i]);
  cag_free(pieces);
  rational_free(&r);
  return same_unit(c, status, &made, out, err);
}

CagStatus cag_curve_hodograph(const CagCurve *c, CagCurve **out, CagError *err) {
  CagCoil arc;
  if (cag_curve_resting_view(c, NULL))
    return cag_curve_resting(cag_vec3(0, 0, 0), c->dimension, c->start, c->end, c->angular, out,
                             err);
  if (cag_curve_arc_coil(c, &arc)) return arc_hodograph(c, out, err);
  CagCurve *nurbs;
  CagNurbsView v;
  if (!c->kind->to_nurbs) return fail_kind(c, "the hodograph", err);
  CagStatus status = cag_curve_to_nurbs(c, &nurbs, err);
  if (status) return status;
  cag_curve_nurbs_view(nurbs, &v);
  status = v.rational ? rational_hodograph(c, nurbs, out, err) : polynomial_hodograph(c, out, err);
  cag_curve_release(nurbs);
  return status;
}

// --- Antiderivatives ---

static CagStatus move_start(CagCurve *made, CagVec3 start, CagCurve **out, CagError *err) {
  CagVec3 first;
  CagStatus status = cag_curve_point(made, made->start, &first, err);
  if (status) return status;
  CagTransform t = cag_translate(cag_sub(start, first));
  t.planar = made->dimension == 2;
  return cag_curve_transform(made, &t, out, err);
}

CagStatus cag_curve_antiderivative(const CagCurve *c, CagVec3 start, CagCurve **out,
                                   CagError *err) {
  Polynomial p;
  CagCurve *made = NULL, *moved = NULL;
  CagVec3 point;
  if (cag_curve_resting_view(c, &point) && c->start < c->end) {
    const CagVec3 end = cag_madd(start, c->end - c->start, point);
    CagStatus straight = cag_curve_line(start, end, c->dimension, &made, err);
    return same_unit(c, straight, &made, out, err);
  }
  CagStatus status = polynomial_open(c, "the antiderivative", &p, err);
  if (status) return status;
  const size_t n = p.view.count;
  const int degree = p.view.degree;
  const double *k = p.view.knots;
  // Sums of P_i (k_{i+p+1} - k_i) / (p + 1), over the same knots with both ends repeated.
  p.points[0] = cag_vec3(0, 0, 0);
  for (size_t i = 0; i < n; i++)
    p.points[i + 1] =
        cag_madd(p.points[i], (k[i + (size_t)degree + 1] - k[i]) / (degree + 1), control(&p, i));
  const size_t count = n + (size_t)degree + 1;
  for (size_t i = 0; i < count; i++) p.knots[i + 1] = k[i];
  p.knots[0] = k[0];
  p.knots[count + 1] = k[count - 1];
  if (degree >= CAG_MAX_DEGREE)
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "C", -1,
                      "expected a degree less than %d, found %d", CAG_MAX_DEGREE, degree);
  if (!status)
    status = cag_curve_nurbs(p.points, NULL, n + 1, degree + 1, p.knots, c->dimension, &made, err);
  if (!status) status = move_start(made, start, &moved, err);
  cag_curve_release(made);
  polynomial_free(&p);
  return same_unit(c, status, &moved, out, err);
}
