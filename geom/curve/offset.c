// Offsets of plane curves.
//
// A curve is cut at its corners, and a composite also at its pieces, so that its lines and arcs
// keep their kinds. The offsets of the parts are joined again: at an outer corner by an arc about
// it, at an inner one both are cut at their intersection.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/family.h"
#include "geom/curve/intersect.h"
#include "geom/linalg/tolerance.h"

// Turns below this (sine) are not corners.
#define TURN CAG_PARALLEL
// If a polyline reverses its direction to within this sine, its sides have no intersection to
// extend to.
#define STRAIGHT_BACK CAG_PARALLEL

static CagVec3 left_of(CagVec3 v) { return cag_vec3(-v.y, v.x, 0); }

// --- One smooth part ---

typedef struct Shifted {
  const CagCurve *c;
  double d;
} Shifted;

// P = C + d n; P' = C' (1 - d k) with the signed curvature k, since n' = -k |C'| T.
static CagStatus sample_shifted(void *context, double t, CagSide side, CagVec3 out[2],
                                CagError *err) {
  const Shifted *s = context;
  CagVec3 c[3], tangent;
  CagStatus status = cag_curve_eval(s->c, t, 2, side, c, err);
  if (status) return status;
  const double speed = cag_norm(c[1]);
  if (speed > 0) tangent = cag_scaled(c[1], 1 / speed);
  else if ((status = cag_curve_tangent(s->c, t, side, &tangent, err))) return status;
  const double turn = speed > 0 ? cag_cross(c[1], c[2]).z / (speed * speed * speed) : 0;
  out[0] = cag_madd(c[0], s->d, left_of(tangent));
  out[1] = cag_scaled(c[1], 1 - s->d * turn);
  return CAG_OK;
}

static CagStatus shift_line(CagVec3 p, CagVec3 q, double d, CagCurve **out, CagError *err) {
  const CagVec3 n = left_of(cag_unit(cag_sub(q, p)));
  return cag_curve_line(cag_madd(p, d, n), cag_madd(q, d, n), 2, out, err);
}

// A circle's arc, or false.
static bool circle_axes(const CagCurve *c, CagVec3 *center, CagVec3 *x, CagVec3 *y, double *rate) {
  const double round = CAG_ROUNDING; // relative difference allowed between the axes
  if (!cag_curve_arc_axes(c, center, x, y, rate)) return false;
  const double a = cag_norm(*x), b = cag_norm(*y);
  return fabs(a - b) <= round * a && fabs(cag_dot(*x, *y)) <= round * a * b;
}

static CagStatus shift_circle(const CagCurve *c, double d, CagVec3 center, double r, double turns,
                              CagCurve **out, CagError *err) {
  char a[32], b[32];
  const double image = r - turns * d;
  if (!(image > CAG_CURVE_SAME * r))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_offset_collapses, "d", -1,
                    "an arc of radius %s has no offset at the distance %s to its inside",
                    cag_number_text(r, a), cag_number_text(fabs(d), b));
  CagTransform t = cag_translate(cag_scaled(center, 1 - image / r));
  for (int i = 0; i < 2; i++) t.m[i][i] = image / r;
  t.planar = true;
  return cag_curve_transform(c, &t, out, err);
}

static CagStatus shift_part(const CagCurve *c, double d, double tolerance, CagCurve **out,
                            CagError *err) {
  const CagVec3 *v;
  CagVec3 center, x, y;
  double rate;
  size_t n;
  bool closed;
  if (cag_curve_vertices(c, &v, &n, &closed) && n == 2) {
    CagCurve *line;
    CagStatus status = shift_line(v[0], v[1], d, &line, err);
    if (status) return status;
    status = cag_curve_reparametrize(line, c->start, c->end, out, err);
    cag_curve_release(line);
    return status;
  }
  if (circle_axes(c, &center, &x, &y, &rate))
    return shift_circle(c, d, center, cag_norm(x), rate * cag_cross(x, y).z > 0 ? 1 : -1, out, err);
  double *cuts;
  Shifted s = {c, d};
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  status = cag_curve_fit_sampler(sample_shifted, &s, cuts, n, tolerance, 2, out, err);
  cag_free(cuts);
  return status;
}

// --- Polylines ---

static CagStatus shift_polyline(const CagVec3 *v, size_t n, bool closed, double d, CagCurve **out,
                                CagError *err) {
  CagVec3 *p = cag_malloc(sizeof *p * n);
  if (!p) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  size_t m = 0;
  for (size_t i = 0; !status && i < n; i++) {
    // Directions into and out of the corner; at ends both are the only one.
    const bool first = !closed && i == 0, last = !closed && i + 1 == n;
    CagVec3 in = cag_unit(cag_sub(v[i], v[(i + n - 1) % n]));
    CagVec3 to = cag_unit(cag_sub(v[(i + 1) % n], v[i]));
    if (first) in = to;
    if (last) to = in;
    // The intersection of the two shifted lines: d (n1 + n2) / (1 + n1 . n2).
    const double cosine = cag_dot(in, to);
    if (1 + cosine <= STRAIGHT_BACK) {
      status = cag_fail(
          err, CAG_E_DEGENERATE, CAG_ERR_offset_corner, "C", (long)i,
          "the polyline turns straight back at corner %zu, where an offset has no corner", i);
      break;
    }
    p[m++] = cag_madd(v[i], d / (1 + cosine), cag_add(left_of(in), left_of(to)));
  }
  if (!status) status = cag_curve_polyline(p, m, closed, 2, out, err);
  cag_free(p);
  return status;
}

// --- Parts joined ---

typedef struct Parts {
  CagCurve **items;
  size_t n, capacity;
} Parts;

static CagStatus add(Parts *p, CagCurve *c, CagError *err) {
  if (!CAG_RESERVE(p->items, p->capacity, p->n + 1)) {
    cag_curve_release(c);
    return cag_fail_memory(err);
  }
  p->items[p->n++] = c;
  return CAG_OK;
}

static void release(Parts *p) {
  for (size_t i = 0; i < p->n; i++) cag_curve_release(p->items[i]);
  cag_free(p->items);
}

// Parameters at which the curve is cut: corners, joints of a composite, and both ends.
static CagStatus part_cuts(const CagCurve *c, double *cuts, size_t *n, CagError *err) {
  double local_a, local_b, rate;
  size_t kept = 1;
  for (size_t i = 1; i + 1 < *n; i++) {
    CagVec3 left, right;
    bool keep =
        cag_curve_composite_piece(c, cuts[i - 1], cuts[i], &local_a, &local_b, &rate) != NULL;
    if (!keep) {
      CagStatus status = cag_curve_tangent(c, cuts[i], CAG_SIDE_LEFT, &left, err);
      if (!status) status = cag_curve_tangent(c, cuts[i], CAG_SIDE_RIGHT, &right, err);
      if (status) return status;
      keep = cag_norm(cag_cross(left, right)) > TURN || cag_dot(left, right) < 0;
    }
    if (keep) cuts[kept++] = cuts[i];
  }
  cuts[kept++] = cuts[*n - 1];
  *n = kept;
  return CAG_OK;
}

// The part over [a, b], in its own kind.
static CagStatus take_part(const CagCurve *c, double a, double b, CagCurve **out, CagError *err) {
  double local_a, local_b, rate;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &local_a, &local_b, &rate);
  return piece ? cag_curve_trim(piece, local_a, local_b, out, err)
               : cag_curve_trim(c, a, b, out, err);
}

// The arc from `from` to `to` about the corner.
static CagStatus corner_arc(CagVec3 corner, CagVec3 from, CagVec3 to, double d, CagCurve **out,
                            CagError *err) {
  const CagVec3 a = cag_sub(from, corner), b = cag_sub(to, corner);
  const double turn = atan2(cag_cross(a, b).z, cag_dot(a, b));
  CagVec3 x = cag_unit(a), y = left_of(x);
  if (turn < 0) y = cag_scaled(y, -1);
  CagTransform frame = cag_translate(corner);
  frame.m[0][0] = x.x;
  frame.m[1][0] = x.y;
  frame.m[0][1] = y.x;
  frame.m[1][1] = y.y;
  frame.planar = true;
  return cag_curve_arc(fabs(d), fabs(d), 0, fabs(turn), &frame, out, err);
}

// Cuts the end of *a and the start of *b at their intersection.
static CagStatus cut_corner(CagCurve **a, CagCurve **b, CagVec3 corner, CagError *err) {
  CagMeeting *found;
  size_t n;
  CagStatus status = cag_curve_intersect(*a, *b, &found, &n, err);
  if (status) return status;
  // Choose the intersection that removes the least of both.
  size_t best = n;
  double least = INFINITY;
  for (size_t i = 0; i < n; i++) {
    const double cut = cag_norm(cag_sub(found[i].point, corner));
    if (cut < least && found[i].t > (*a)->start && found[i].t2 < (*b)->end) {
      least = cut;
      best = i;
    }
  }
  if (best == n) {
    cag_free(found);
    char x[32], y[32];
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_offset_corner, "d", -1,
        "the parts of the offset at the corner [%s, %s] do not meet: use a smaller distance",
        cag_number_text(corner.x, x), cag_number_text(corner.y, y));
  }
  const double t = found[best].t, u = found[best].t2;
  cag_free(found);
  CagCurve *cut;
  if (t < (*a)->end) {
    status = cag_curve_trim(*a, (*a)->start, t, &cut, err);
    if (status) return status;
    cag_curve_release(*a);
    *a = cut;
  }
  if (u > (*b)->start) {
    status = cag_curve_trim(*b, u, (*b)->end, &cut, err);
    if (status) return status;
    cag_curve_release(*b);
    *b = cut;
  }
  return CAG_OK;
}

// Joins part a and part b, which meet in the corner before they are shifted; *arc: an arc to insert
// between them, or NULL.
static CagStatus join_corner(CagCurve **a, CagCurve **b, CagVec3 corner, double d, CagCurve **arc,
                             CagError *err) {
  CagVec3 end, start;
  *arc = NULL;
  CagStatus status = cag_curve_point(*a, (*a)->end, &end, err);
  if (!status) status = cag_curve_point(*b, (*b)->start, &start, err);
  if (status) return status;
  const CagVec3 from = cag_sub(end, corner), to = cag_sub(start, corner);
  const double sine = cag_cross(from, to).z / (d * d);
  if (fabs(sine) <= TURN && cag_dot(from, to) > 0) return CAG_OK;
  // An offset to the left goes around a corner if the curve turns right.
  if ((d > 0) == (sine < 0) || fabs(sine) <= TURN)
    return corner_arc(corner, end, start, d, arc, err);
  return cut_corner(a, b, corner, err);
}

static CagStatus shift_parts(const CagCurve *c, const double *cuts, size_t n, double d,
                             double tolerance, CagCurve **out, CagError *err) {
  Parts shifted = {0}, all = {0};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    CagCurve *part, *moved = NULL;
    status = take_part(c, cuts[i], cuts[i + 1], &part, err);
    if (status) break;
    status = shift_part(part, d, tolerance, &moved, err);
    cag_curve_release(part);
    if (!status) status = add(&shifted, moved, err);
  }
  // Corner i precedes part i; the corner at the seam of a closed curve precedes part 0.
  CagCurve **arcs = status ? NULL : cag_calloc(shifted.n + 1, sizeof *arcs);
  if (!status && !arcs) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < shifted.n; i++) {
    CagVec3 corner;
    if (i == 0 && (!c->closed || shifted.n == 1)) continue;
    status = cag_curve_point(c, cuts[i], &corner, err);
    CagCurve **before = &shifted.items[i == 0 ? shifted.n - 1 : i - 1];
    if (!status) status = join_corner(before, &shifted.items[i], corner, d, &arcs[i], err);
  }
  for (size_t i = 0; !status && i < shifted.n; i++) {
    if (i > 0 && arcs[i]) status = add(&all, cag_curve_retain(arcs[i]), err);
    if (!status) status = add(&all, cag_curve_retain(shifted.items[i]), err);
  }
  if (!status && arcs[0]) status = add(&all, cag_curve_retain(arcs[0]), err);
  if (!status && all.n == 1) *out = cag_curve_retain(all.items[0]);
  else if (!status) status = cag_curve_join(all.items, all.n, out, err);
  for (size_t i = 0; arcs && i < shifted.n; i++) cag_curve_release(arcs[i]);
  cag_free(arcs);
  release(&all);
  release(&shifted);
  return status;
}

CagStatus cag_curve_offset(const CagCurve *c, double d, double tolerance, CagCurve **out,
                           CagError *err) {
  const CagVec3 *v;
  size_t n;
  bool closed;
  if (!isfinite(d))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "d", -1, "`d` is not a finite number");
  if (c->dimension != 2)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_not_planar, "C", -1,
                    "only plane curves, of points [x, y], have an offset");
  if (d == 0) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  if (cag_curve_vertices(c, &v, &n, &closed) && n > 2)
    return shift_polyline(v, n, closed, d, out, err);
  double *cuts;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  status = part_cuts(c, cuts, &n, err);
  if (!status) status = shift_parts(c, cuts, n, d, tolerance, out, err);
  cag_free(cuts);
  return status;
}
