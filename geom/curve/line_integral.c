// Integrals along curves, piece by piece between breaks.
//
// A rational curve of degree 2 with weights 1, w, 1 covers half of its length while its parameter
// is within 1 / w of an end. A double near 1 has an error of 1e-16, so integrating over the curve's
// own parameter would give a length with a relative error of 1e-16 w. Such pieces are therefore
// split in the middle, and the parameter of each half is the distance from the end of the piece.
// Weights are positive, so a piece is this fast only at its ends.

#include "geom/curve/line_integral.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

// A piece whose weights differ by more than this factor is split. Below it, the rounding of
// parameters costs less than 1e-14 of an integral.
#define FAR_APART 32

// A part of a curve with its own parameter: the curve's parameter if `points` is NULL, otherwise
// the distance from the start or the end of a Bezier piece.
typedef struct Stretch {
  const CagCurve *curve;
  const double *points; // homogeneous
  int degree;
  double width; // width of the piece
  bool from_end;
} Stretch;

typedef struct Stretches {
  Stretch *items;
  double (*ranges)[2];
  size_t n, room;
  CagLineIntegrand *f;
  void *context;
} Stretches;

static CagStatus add(Stretches *all, Stretch stretch, double from, double to, CagError *err) {
  if (!(from < to)) return CAG_OK;
  if (all->n == all->room) {
    const size_t room = all->room ? 2 * all->room : 16;
    if (!CAG_RESIZE(all->items, room) || !CAG_RESIZE(all->ranges, room))
      return cag_fail_memory(err);
    all->room = room;
  }
  all->items[all->n] = stretch;
  all->ranges[all->n][0] = from;
  all->ranges[all->n++][1] = to;
  return CAG_OK;
}

static bool has_weights_far_apart(const CagNurbs *c, size_t piece) {
  const double *h = cag_nurbs_bezier(c, piece);
  double least = h[3], most = h[3];
  for (int i = 1; i <= c->degree; i++) {
    least = fmin(least, h[4 * i + 3]);
    most = fmax(most, h[4 * i + 3]);
  }
  return least > 0 && most > FAR_APART * least;
}

// Adds the smooth part of the curve between a and b.
static CagStatus add_smooth(Stretches *all, const CagCurve *c, double a, double b, CagError *err) {
  double la, lb, rate;
  const CagCurve *part = cag_curve_composite_piece(c, a, b, &la, &lb, &rate);
  if (part) return add_smooth(all, part, la, lb, err);
  const CagNurbs *nurbs = cag_nurbs_data(c);
  const double middle = a + (b - a) / 2;
  if (!nurbs || !nurbs->rational || nurbs->has_narrow)
    return add(all, (Stretch){.curve = c}, a, b, err);
  const size_t piece = cag_nurbs_piece(nurbs, middle, CAG_SIDE_RIGHT, 0);
  if (!has_weights_far_apart(nurbs, piece)) return add(all, (Stretch){.curve = c}, a, b, err);
  const double low = nurbs->cuts[piece], high = nurbs->cuts[piece + 1];
  const double half = low + (high - low) / 2;
  Stretch near = {c, cag_nurbs_bezier(nurbs, piece), nurbs->degree, high - low, false};
  CagStatus status = add(all, near, a - low, fmin(b, half) - low, err);
  near.from_end = true;
  if (!status) status = add(all, near, high - b, high - fmax(a, half), err);
  return status;
}

// De Casteljau's algorithm. The derivative is n w0 w1 / w^2 (p1 - p0) of the last two points. This
// difference of points avoids the cancellation of weights (Farin 1983).
static void bezier_at(const Stretch *s, double t, CagVec3 *p, CagVec3 *d, double *room) {
  const double x = t / s->width, y = s->from_end ? x : 1 - x, z = s->from_end ? 1 - x : x;
  const size_t n = (size_t)s->degree;
  memcpy(room, s->points, (n + 1) * 4 * sizeof *room);
  for (size_t k = n; k > 1; k--)
    for (size_t i = 0; i < 4 * k; i++) room[i] = y * room[i] + z * room[i + 4];
  const CagVec3 p0 = cag_project(room), p1 = cag_project(room + 4);
  const double w0 = room[3], w1 = room[7], w = y * w0 + z * w1;
  *p = cag_lerp(p0, p1, z * w1 / w);
  *d = cag_scaled(cag_sub(p1, p0), (double)n * (w0 / w) * (w1 / w) / s->width);
}

static CagStatus at_stretch(void *context, size_t piece, double t, double *out, CagError *err) {
  const Stretches *all = context;
  const Stretch *s = &all->items[piece];
  CagVec3 d[2];
  CagStatus status = CAG_OK;
  double few[4 * 16], *room = few;
  if (!s->points) {
    status = cag_curve_eval(s->curve, t, 1, CAG_SIDE_RIGHT, d, err);
  } else {
    const size_t n = 4 * ((size_t)s->degree + 1);
    if (n > sizeof few / sizeof *few) room = cag_malloc(n * sizeof *room);
    if (!room) return cag_fail_memory(err);
    bezier_at(s, t, &d[0], &d[1], room);
    if (room != few) cag_free(room);
  }
  if (!status) all->f(all->context, d[0], d[1], out);
  return status;
}

CagStatus cag_curve_integrate(const CagCurve *c, double a, double b, CagLineIntegrand *f,
                              void *context, int parts, double tolerance, double *out,
                              CagError *err) {
  Stretches all = {.f = f, .context = context};
  double *cuts;
  size_t n;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    const double from = fmax(a, cuts[i]), to = fmin(b, cuts[i + 1]);
    if (from < to) status = add_smooth(&all, c, from, to, err);
  }
  if (!status)
    status = cag_integrate_pieces(at_stretch, &all, (const double(*)[2])all.ranges, all.n, parts,
                                  tolerance, out, err);
  cag_free(cuts);
  cag_free(all.items);
  cag_free(all.ranges);
  return status;
}
