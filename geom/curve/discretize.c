// Parameters of a polyline that approximates a curve within a chord tolerance and an angle.
//
// Smooth pieces are halved until the bound of cag_curve_sag and the turn of the tangent are within
// the limits; circles are divided into equal steps. Ends and breaks are always included.

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

// Limit on the number of points; a tolerance that needs more is probably a mistake.
#define MOST_POINTS 5000000
// A piece shorter than these fractions of the tolerance and of the curve's size is not halved
// because of its turn: it contains a cusp.
#define CUSP_TOLERANCE 0.25
#define CUSP_SIZE 1e-4
// Maximum step of an arc, for any tolerance.
#define WIDEST (M_PI / 2)

typedef struct Limits {
  double tolerance, angle;
  double cusp, short_edge; // up to these lengths, the turn does not matter
} Limits;

typedef struct Output {
  double *t;
  size_t n, capacity;
} Output;

static CagStatus fail_count(CagError *err) {
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_many_points, "tolerance", -1,
                  "the tolerance requires more than %d points on one curve; use a larger tolerance",
                  MOST_POINTS);
}

static CagStatus append(Output *out, double t, CagError *err) {
  if (out->n >= MOST_POINTS) return fail_count(err);
  if (cag_stop_check(err)) return err->status;
  if (!CAG_RESERVE(out->t, out->capacity, out->n + 1)) return cag_fail_memory(err);
  out->t[out->n++] = t;
  return CAG_OK;
}

static double angle_between(CagVec3 a, CagVec3 b) {
  return atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b));
}

// Turn of a polygon: a Bezier curve turns no more than its control polygon.
static double bezier_turn(const double *b, int p, double *length) {
  double turn = 0;
  CagVec3 before = {0, 0, 0}, from = cag_project(b);
  *length = 0;
  for (int i = 1; i <= p; i++) {
    if (!(b[4 * i + 3] > 0)) continue;
    CagVec3 to = cag_project(b + 4 * i), leg = cag_sub(to, from);
    double size = cag_norm(leg);
    if (size == 0) continue;
    if (*length > 0) turn += angle_between(before, leg);
    *length += size;
    before = leg;
    from = to;
  }
  return turn;
}

// The same for the control points of a cubic.
static double polygon_turn(const CagVec3 *q, double *length) {
  double homogeneous[16];
  for (int i = 0; i < 4; i++) {
    const double row[4] = {q[i].x, q[i].y, q[i].z, 1};
    memcpy(homogeneous + 4 * i, row, sizeof row);
  }
  return bezier_turn(homogeneous, 3, length);
}

// Turn of the tangent over [a, b], and the approximate length.
static double turn_of(const CagCurve *c, double a, double b, double *length) {
  enum { SAMPLES = 4 };
  double rate;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &rate);
  if (piece) c = piece;
  const CagNurbs *nurbs = cag_nurbs_data(c);
  if (nurbs) {
    double part[4 * (CAG_MAX_DEGREE + 1)];
    size_t i = cag_nurbs_piece(nurbs, a, CAG_SIDE_RIGHT, nurbs->pieces);
    double h = nurbs->cuts[i + 1] - nurbs->cuts[i];
    cag_bezier_segment(cag_nurbs_bezier(nurbs, i), nurbs->degree, fmax(0, (a - nurbs->cuts[i]) / h),
                       fmin(1, (b - nurbs->cuts[i]) / h), part);
    return bezier_turn(part, nurbs->degree, length);
  }
  CagVec3 q[4];
  if (cag_curve_chord_cubic(c, a, b, q)) return polygon_turn(q, length);
  double turn = 0;
  CagVec3 before = {0, 0, 0}, d[2], from = {0, 0, 0};
  CagError ignored;
  *length = 0;
  for (int i = 0; i <= SAMPLES; i++) {
    CagSide side = i == SAMPLES ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    double t = i == SAMPLES ? b : a + (b - a) * i / SAMPLES;
    if (cag_curve_eval(c, t, 1, side, d, &ignored)) return 0;
    if (i > 0) {
      *length += cag_norm(cag_sub(d[0], from));
      if (cag_norm(before) > 0 && cag_norm(d[1]) > 0) turn += angle_between(before, d[1]);
    }
    before = d[1];
    from = d[0];
  }
  return turn;
}

static CagStatus halve(const CagCurve *c, double a, double b, const Limits *limits, Output *out,
                       CagError *err) {
  double middle = a + (b - a) / 2, length;
  const double sag = cag_curve_sag(c, a, b);
  bool fine = sag <= limits->tolerance;
  if (isinf(sag)) { // halving does not help if evaluation fails
    CagVec3 ignored;
    CagStatus status = cag_curve_point(c, middle, &ignored, err);
    if (status) return status;
  }
  if (fine && limits->angle < M_PI)
    fine = turn_of(c, a, b, &length) <= limits->angle || length <= limits->cusp;
  if (fine || !(a < middle && middle < b)) return append(out, b, err);
  CagStatus status = halve(c, a, middle, limits, out, err);
  return status ? status : halve(c, middle, b, limits, out, err);
}

// Equal steps for an arc of a circle. Returns false if the piece is not one.
static bool circle_steps(const CagCurve *c, double a, double b, const Limits *limits, size_t *n) {
  const double round = 1e-9, slack = 1e-9;
  CagVec3 center, x, y;
  double rate, ignored;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &ignored);
  if (!cag_curve_arc_axes(piece ? piece : c, &center, &x, &y, &rate)) return false;
  double xx = cag_dot(x, x);
  if (fabs(cag_dot(y, y) - xx) > round * xx || fabs(cag_dot(x, y)) > round * xx) return false;
  // 1 - cos(step / 2) = tolerance / r
  double step = 4 * asin(sqrt(fmin(1, limits->tolerance / (2 * sqrt(xx)))));
  step = fmin(step, fmin(fmax(limits->angle, limits->short_edge / sqrt(xx)), WIDEST));
  *n = (size_t)fmax(1, ceil(fabs(rate) * (b - a) / step - slack));
  return true;
}

static CagStatus one_piece(const CagCurve *c, double a, double b, const Limits *limits, Output *out,
                           CagError *err) {
  size_t n;
  if (!circle_steps(c, a, b, limits, &n)) return halve(c, a, b, limits, out, err);
  CagStatus status = n > MOST_POINTS ? fail_count(err) : CAG_OK;
  for (size_t i = 1; !status && i <= n; i++)
    status = append(out, i == n ? b : a + (b - a) * ((double)i / (double)n), err);
  return status;
}

CagStatus cag_curve_discretize(const CagCurve *c, double tolerance, double angle, double **out,
                               size_t *n, CagError *err) {
  return cag_curve_discretize_short(c, tolerance, angle, 0, out, n, err);
}

CagStatus cag_curve_discretize_short(const CagCurve *c, double tolerance, double angle,
                                     double short_edge, double **out, size_t *n, CagError *err) {
  char text[32];
  if (cag_curve_resting_view(c, NULL)) return cag_curve_cuts(c, out, n, err);
  if (!(tolerance > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_tolerance_not_positive, "tolerance", -1,
                    "`tolerance` must be positive, found %s", cag_number_text(tolerance, text));
  if (!(angle > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_angle_not_positive, "angle", -1,
                    "`angle` must be positive, found %.12gdeg", angle * (180 / M_PI));
  double *cuts;
  size_t count;
  CagStatus status = cag_curve_cuts(c, &cuts, &count, err);
  if (status) return status;
  CagBounds box = c->kind->hull(c, c->start, c->end);
  const double size = cag_norm(cag_sub(box.max, box.min));
  // Distances and directions below the rounding of the coordinates are meaningless.
  const double noise = cag_curve_noise(&box);
  const double cusp = fmin(CUSP_TOLERANCE * tolerance, CUSP_SIZE * size);
  const Limits limits = {fmax(tolerance, noise), angle,
                         fmax(fmax(cusp, short_edge), 2 * noise / fmin(angle, 1)), short_edge};
  Output o = {0};
  status = append(&o, cuts[0], err);
  for (size_t i = 0; !status && i + 1 < count; i++)
    status = one_piece(c, cuts[i], cuts[i + 1], &limits, &o, err);
  // A closed curve is at least a triangle.
  if (!status && c->closed && o.n < 4) {
    const double a = c->start, b = c->end;
    o.n = 0;
    for (int i = 0; !status && i <= 4; i++)
      status = append(&o, i == 4 ? b : a + (b - a) * i / 4, err);
  }
  cag_free(cuts);
  if (status) {
    cag_free(o.t);
    return status;
  }
  *out = o.t;
  *n = o.n;
  return CAG_OK;
}
