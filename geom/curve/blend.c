// Parabolic blends: cubic segments between the parabolas through three neighboring points.
//
// The parabola through points i - 1, i, i + 1 passes them at r = 0, a, 1. A segment's end tangents
// are those of the parabolas there, so it is a Hermite segment; it is stored by its Bezier points.

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/cubic.h"
#include "geom/curve/family.h"

typedef struct Blend {
  const CagVec3 *points;
  size_t n;
  const double *ratios, *lengths; // one of them is NULL
  CagBlendEnds ends;
} Blend;

static const CagVec3 *point(const Blend *b, size_t i) { return &b->points[i % b->n]; }

// Length of the span from point i to the next.
static double length(const Blend *b, size_t i) { return b->lengths ? b->lengths[i % b->n] : 1; }

// The parameter r at which the parabola about point i passes it.
static double ratio(const Blend *b, size_t i) {
  i %= b->n;
  if (b->ratios) return b->ratios[b->ends == CAG_BLEND_CLOSED ? i : i - 1];
  const double h = length(b, i + b->n - 1), g = length(b, i);
  return h / (h + g);
}

// Derivative with respect to r of the parabola about point i at point i - 1, i, or i + 1 (which is
// -1, 0, 1).
static CagVec3 parabola_slope(const Blend *b, size_t i, int which) {
  const double a = ratio(b, i);
  const CagVec3 s1 = cag_scaled(cag_sub(*point(b, i), *point(b, i + b->n - 1)), 1 / a);
  const CagVec3 s2 = cag_scaled(cag_sub(*point(b, i + 1), *point(b, i)), 1 / (1 - a));
  const CagVec3 bend = cag_sub(s2, s1);
  if (which < 0) return cag_madd(s1, -a, bend);
  if (which > 0) return cag_madd(s2, 1 - a, bend);
  return cag_madd(s1, a, bend);
}

// The two inner Bezier points of the span from point i to the next; `first`, `last`: the span is an
// arc of the only parabola there.
static void inner_points(const Blend *b, size_t i, bool first, bool last, CagVec3 *out) {
  const double share = first ? ratio(b, i + 1) : 1 - ratio(b, i); // fraction of r covered by the
                                                                  // span
  const double share2 = last ? 1 - ratio(b, i) : ratio(b, i + 1);
  const CagVec3 d0 = first ? parabola_slope(b, i + 1, -1) : parabola_slope(b, i, 0);
  const CagVec3 d1 = last ? parabola_slope(b, i, 1) : parabola_slope(b, i + 1, 0);
  out[0] = cag_madd(*point(b, i), share / 3, d0);
  out[1] = cag_madd(*point(b, i + 1), -share2 / 3, d1);
}

static CagStatus build(const Blend *b, int dimension, CagCurve **out, CagError *err) {
  const bool arcs = b->ends == CAG_BLEND_PARABOLA, closed = b->ends == CAG_BLEND_CLOSED;
  const size_t from = b->ends == CAG_BLEND_OPEN ? 1 : 0;
  const size_t spans = closed ? b->n : arcs ? b->n - 1 : b->n - 3;
  // Equal speed on both sides of a joint, unless given ratios other than 1/2 prevent it.
  bool smooth = true;
  for (size_t i = 0; b->ratios && i < (closed ? b->n : b->n - 2); i++)
    smooth = smooth && b->ratios[i] == 0.5;
  const size_t times = smooth ? 2 : 3, count = 4 + times * (spans - 1);
  CagVec3 *control = cag_malloc(count * sizeof *control);
  double *knots = cag_malloc((count + 4) * sizeof *knots);
  CagStatus status = CAG_OK;
  if (!control || !knots) status = cag_fail_memory(err);
  if (!status) {
    size_t c = 0, k = 0;
    double u = 0;
    for (int j = 0; j < 4; j++) knots[k++] = u;
    control[c++] = *point(b, from);
    for (size_t s = 0; s < spans; s++) {
      const size_t i = from + s;
      if ((status = cag_stop_check(err)) != CAG_OK) break;
      inner_points(b, i, arcs && s == 0, arcs && s + 1 == spans, control + c);
      c += 2;
      u += length(b, i);
      if (s + 1 == spans) break;
      if (!smooth) control[c++] = *point(b, i + 1);
      for (size_t j = 0; j < times; j++) knots[k++] = u;
    }
    control[c++] = *point(b, from + spans);
    for (int j = 0; j < 4; j++) knots[k++] = u;
    if (!status) status = cag_curve_nurbs(control, NULL, count, 3, knots, dimension, out, err);
  }
  cag_free(control);
  cag_free(knots);
  return status;
}

static CagStatus check_ratios(const double *ratios, size_t n, CagError *err) {
  char text[32];
  for (size_t i = 0; i < n; i++)
    if (!(ratios[i] > 0 && ratios[i] < 1))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_blend_parameter, "alpha", (long)i,
                      "alpha must be between 0 and 1, found %s", cag_number_text(ratios[i], text));
  return CAG_OK;
}

// Chords to this power for all spans (including the one from the last point to the first).
static CagStatus chord_lengths(const CagVec3 *points, size_t n, double power, bool closed,
                               double *out, CagError *err) {
  for (size_t i = 0; i < n; i++) {
    const size_t next = (i + 1) % n;
    out[i] = pow(cag_norm(cag_sub(points[next], points[i])), power);
    if (next == 0 && !closed) break;
    if (!(out[i] > 0) || !isfinite(out[i]))
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_coincident_points, "points", (long)next,
          "points[%zu] and points[%zu] coincide, so there is no ratio of chords; remove one of them, or give the ratio as a number",
          i, next);
  }
  return CAG_OK;
}

CagStatus cag_curve_parabolic_blend(const CagVec3 *points, size_t n, const double *ratios,
                                    double power, CagBlendEnds ends, int dimension, CagCurve **out,
                                    CagError *err) {
  const size_t least = ends == CAG_BLEND_OPEN ? 4 : 3;
  if (n < least)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "a parabolic blend %s needs at least %zu points, found %zu",
                    ends == CAG_BLEND_OPEN       ? "with open ends"
                    : ends == CAG_BLEND_PARABOLA ? "with arcs at its ends"
                                                 : "that is closed",
                    least, n);
  const bool closed = ends == CAG_BLEND_CLOSED;
  CagStatus status = cag_curve_check_points(points, n, "points", err);
  if (!status && ratios) status = check_ratios(ratios, closed ? n : n - 2, err);
  if (status) return status;
  Blend b = {points, n, ratios, NULL, ends};
  double *lengths = NULL;
  if (!ratios) {
    lengths = cag_malloc(n * sizeof *lengths);
    if (!lengths) return cag_fail_memory(err);
    status = chord_lengths(points, n, power, closed, lengths, err);
    b.lengths = lengths;
  }
  if (!status) status = build(&b, dimension, out, err);
  cag_free(lengths);
  return status;
}
