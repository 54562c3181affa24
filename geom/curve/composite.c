// Curves joined end to end: each piece keeps its kind and covers its part of the domain.
//
// Piece i covers cuts[i]..cuts[i + 1], mapped to its own domain at a constant rate and exactly at
// the ends. Pieces are never composites themselves. A joint belongs to the piece that starts there,
// except for limits from the left. Breaks within the pieces, such as corners, are mapped exactly,
// too: at a parameter next to one, both limits would be the same.

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/linalg/tolerance.h"

// Ends meet if their gap is at most this fraction of the size of the curves.
#define MEET CAG_COINCIDENT

typedef struct Composite {
  CagCurve base;
  size_t n;
  CagCurve **pieces;
  double *cuts; // n + 1
  // Breaks within pieces, ascending: as parameters of the whole curve, and of the pieces.
  size_t inner_count;
  double *inner, *own;
} Composite;

static const CagCurveKind composite_kind;

static void destroy(CagCurve *curve) {
  Composite *c = (Composite *)curve;
  for (size_t i = 0; c->pieces && i < c->n; i++) cag_curve_release(c->pieces[i]);
  cag_free(c->pieces);
  cag_free(c->cuts);
  cag_free(c->inner);
  cag_free(c->own);
}

static size_t breaks_of(const CagCurve *piece, double *out, size_t capacity) {
  return piece->kind->breaks ? piece->kind->breaks(piece, out, capacity) : 0;
}

static CagStatus find_inner_breaks(Composite *c, CagError *err) {
  size_t n = 0;
  for (size_t i = 0; i < c->n; i++) n += breaks_of(c->pieces[i], NULL, 0);
  if (n == 0) return CAG_OK;
  c->inner = cag_malloc(sizeof *c->inner * n);
  c->own = cag_malloc(sizeof *c->own * n);
  if (!c->inner || !c->own) return cag_fail_memory(err);
  for (size_t i = 0; i < c->n; i++) {
    const size_t first = c->inner_count;
    c->inner_count += breaks_of(c->pieces[i], c->own + first, n - first);
    for (size_t k = first; k < c->inner_count; k++)
      c->inner[k] = cag_curve_remap(c->pieces[i], c->own[k], c->cuts[i], c->cuts[i + 1]);
  }
  return CAG_OK;
}

// Retains the pieces; copies the cuts.
static CagStatus make(CagCurve *const *pieces, const double *cuts, size_t n, bool angular,
                      CagCurve **out, CagError *err) {
  CagCurve *base;
  CagStatus status = cag_curve_block(sizeof(Composite), &composite_kind, pieces[0]->dimension,
                                     cuts[0], cuts[n], &base, err);
  if (status) return status;
  Composite *c = (Composite *)base;
  c->pieces = cag_calloc(n, sizeof(CagCurve *));
  c->cuts = cag_malloc(sizeof(double) * (n + 1));
  if (!c->pieces || !c->cuts) {
    cag_curve_release(base);
    return cag_fail_memory(err);
  }
  c->n = n;
  for (size_t i = 0; i < n; i++) c->pieces[i] = cag_curve_retain(pieces[i]);
  memcpy(c->cuts, cuts, sizeof(double) * (n + 1));
  base->angular = angular;
  CagVec3 ends[2];
  status = find_inner_breaks(c, err);
  if (!status) status = cag_curve_point(pieces[0], pieces[0]->start, &ends[0], err);
  if (!status) status = cag_curve_point(pieces[n - 1], pieces[n - 1]->end, &ends[1], err);
  if (status) {
    cag_curve_release(base);
    return status;
  }
  CagBounds box = pieces[0]->kind->hull(pieces[0], pieces[0]->start, pieces[0]->end);
  const CagVec3 extent[4] = {ends[0], ends[1], box.min, box.max};
  base->closed = cag_norm(cag_sub(ends[0], ends[1])) <= MEET * cag_curve_size(extent, 4);
  *out = base;
  return CAG_OK;
}

static double local(const Composite *c, size_t i, double t) {
  const CagCurve *piece = c->pieces[i];
  if (t == c->cuts[i]) return piece->start;
  if (t == c->cuts[i + 1]) return piece->end;
  size_t lo = 0, hi = c->inner_count;
  while (lo < hi) {
    const size_t mid = lo + (hi - lo) / 2;
    if (c->inner[mid] < t) lo = mid + 1;
    else hi = mid;
  }
  if (lo < c->inner_count && c->inner[lo] == t) return c->own[lo];
  double rate = (piece->end - piece->start) / (c->cuts[i + 1] - c->cuts[i]);
  double u = piece->start + (t - c->cuts[i]) * rate;
  return fmin(fmax(u, piece->start), piece->end);
}

static size_t piece_of(const Composite *c, double t, CagSide side) {
  size_t lo = 0, hi = c->n;
  while (hi - lo > 1) {
    size_t mid = lo + (hi - lo) / 2;
    if (c->cuts[mid] <= t) lo = mid;
    else hi = mid;
  }
  if (side == CAG_SIDE_LEFT && lo > 0 && t == c->cuts[lo]) lo--;
  return lo;
}

const CagCurve *cag_curve_composite_piece(const CagCurve *curve, double a, double b,
                                          double *local_a, double *local_b, double *rate) {
  if (curve->kind != &composite_kind) return NULL;
  const Composite *c = (const Composite *)curve;
  const size_t i = piece_of(c, a, CAG_SIDE_RIGHT);
  *local_a = local(c, i, a);
  *local_b = b >= c->cuts[i + 1] ? c->pieces[i]->end : local(c, i, b);
  *rate = (c->pieces[i]->end - c->pieces[i]->start) / (c->cuts[i + 1] - c->cuts[i]);
  return c->pieces[i];
}

// --- Joining ---

// The pieces of all curves in sequence, with composites flattened, and the lengths of their
// domains.
static size_t flatten(CagCurve *const *curves, size_t n, CagCurve **pieces, double *lengths) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (curves[i]->kind == &composite_kind) {
      const Composite *c = (const Composite *)curves[i];
      for (size_t k = 0; k < c->n; k++, count++) {
        if (!pieces) continue;
        pieces[count] = c->pieces[k];
        lengths[count] = c->cuts[k + 1] - c->cuts[k];
      }
    } else {
      if (pieces) {
        pieces[count] = curves[i];
        lengths[count] = curves[i]->end - curves[i]->start;
      }
      count++;
    }
  }
  return count;
}

static CagStatus check_joints(CagCurve *const *curves, size_t n, CagError *err) {
  for (size_t i = 0; i + 1 < n; i++) {
    CagVec3 p, q;
    CagStatus status = cag_curve_point(curves[i], curves[i]->end, &p, err);
    if (!status) status = cag_curve_point(curves[i + 1], curves[i + 1]->start, &q, err);
    if (status) return status;
    CagBounds box = curves[i]->kind->hull(curves[i], curves[i]->start, curves[i]->end);
    const CagVec3 extent[3] = {box.min, box.max, q};
    double gap = cag_norm(cag_sub(p, q));
    if (gap > MEET * cag_curve_size(extent, 3))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_ends_do_not_meet, "curves", (long)i + 1,
                      "curves[%zu] starts at [%.9g, %.9g, %.9g], %.3g away from the end of "
                      "curves[%zu] at [%.9g, %.9g, %.9g]; move it, or reverse one of them",
                      i + 1, q.x, q.y, q.z, gap, i, p.x, p.y, p.z);
  }
  return CAG_OK;
}

// If all pieces are straight, they form a polyline whose vertices have integer parameters.
static CagStatus join_straight(CagCurve *const *curves, size_t n, int dimension, bool *done,
                               CagCurve **out, CagError *err) {
  const CagVec3 *points;
  size_t count, total = 1;
  bool ring;
  *done = false;
  for (size_t i = 0; i < n; i++) {
    if (!cag_curve_vertices(curves[i], &points, &count, &ring) ||
        curves[i]->end - curves[i]->start != (double)(count + ring - 1))
      return CAG_OK;
    total += count + ring - 1;
  }
  CagVec3 *all = cag_malloc(sizeof *all * total);
  if (!all) return cag_fail_memory(err);
  size_t used = 0;
  for (size_t i = 0; i < n; i++) {
    cag_curve_vertices(curves[i], &points, &count, &ring);
    for (size_t k = i > 0; k < count + ring; k++) all[used++] = points[k % count];
  }
  const CagVec3 ends[2] = {all[0], all[total - 1]};
  bool closed =
      total > 3 && cag_norm(cag_sub(ends[0], ends[1])) <= MEET * cag_curve_size(all, total);
  if (closed) all[total - 1] = all[0];
  CagStatus status = cag_curve_polyline(all, total, closed, dimension, out, err);
  cag_free(all);
  *done = true;
  return status;
}

// Joins curves that meet; none of them may be a point.
static CagStatus join_moving(CagCurve *const *curves, size_t n, int dimension, CagCurve **out,
                             CagError *err) {
  if (n == 1 && curves[0]->dimension < dimension) return cag_curve_to_space(curves[0], out, err);
  if (n == 1) {
    *out = cag_curve_retain(curves[0]);
    return CAG_OK;
  }
  bool done;
  CagStatus status = join_straight(curves, n, dimension, &done, out, err);
  if (status || done) return status;

  const size_t count = flatten(curves, n, NULL, NULL);
  CagCurve **pieces = cag_malloc(sizeof *pieces * count);
  double *cuts = cag_malloc(sizeof *cuts * (count + 1));
  if (!pieces || !cuts) {
    cag_free(pieces);
    cag_free(cuts);
    return cag_fail_memory(err);
  }
  flatten(curves, n, pieces, cuts + 1);
  // Domains are kept if they are contiguous, else they are laid end to end from 0.
  bool natural = true, angular = true;
  for (size_t i = 0; i < n; i++) {
    natural = natural && (i == 0 || curves[i]->start == curves[i - 1]->end);
    angular = angular && curves[i]->angular;
  }
  cuts[0] = natural ? curves[0]->start : 0;
  for (size_t i = 0; i < count; i++) cuts[i + 1] += cuts[i];
  if (natural) cuts[count] = curves[n - 1]->end;
  size_t owned = 0;
  for (; !status && owned < count; owned++) {
    CagCurve *placed;
    if (pieces[owned]->dimension == dimension) placed = cag_curve_retain(pieces[owned]);
    else status = cag_curve_to_space(pieces[owned], &placed, err);
    if (status) break;
    pieces[owned] = placed;
  }
  if (!status) status = make(pieces, cuts, count, angular, out, err);
  for (size_t i = 0; i < owned; i++) cag_curve_release(pieces[i]);
  cag_free(pieces);
  cag_free(cuts);
  return status;
}

CagStatus cag_curve_join(CagCurve *const *curves, size_t n, CagCurve **out, CagError *err) {
  if (n == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_curves, "curves", -1,
                    "expected at least 1 curve, found none");
  CagStatus status = check_joints(curves, n, err);
  if (status) return status;
  // Points are dropped, since they add nothing to the curves that they touch.
  CagCurve **moving = cag_malloc(n * sizeof *moving);
  if (!moving) return cag_fail_memory(err);
  int dimension = 2;
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (curves[i]->dimension == 3) dimension = 3;
    if (!cag_curve_resting_view(curves[i], NULL)) moving[count++] = curves[i];
  }
  status = count ? join_moving(moving, count, dimension, out, err)
                 : join_moving(curves, 1, dimension, out, err);
  cag_free(moving);
  return status;
}

// --- Functions of the kind ---

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  const Composite *c = (const Composite *)curve;
  const size_t i = piece_of(c, t, side);
  const CagCurve *piece = c->pieces[i];
  CagStatus status = cag_curve_eval(piece, local(c, i, t), order, side, out, err);
  double rate = (piece->end - piece->start) / (c->cuts[i + 1] - c->cuts[i]), scale = 1;
  for (int k = 1; !status && rate != 1 && k <= order; k++) {
    scale *= rate;
    out[k] = cag_scaled(out[k], scale);
  }
  return status;
}

// The pieces as clamped NURBS curves of one degree; returns their number of points and whether one
// is rational.
static CagStatus alike_pieces(const Composite *c, CagCurve **exact, size_t *points, bool *rational,
                              int *degree, CagError *err) {
  *degree = 1;
  *points = 1;
  *rational = false;
  for (size_t i = 0; i < c->n; i++) {
    CagStatus status = cag_curve_to_nurbs(c->pieces[i], &exact[i], err);
    if (status) return status;
    const CagNurbs *piece = cag_nurbs_data(exact[i]);
    if (piece->degree > *degree) *degree = piece->degree;
  }
  for (size_t i = 0; i < c->n; i++) {
    CagCurve *raised;
    CagStatus status =
        cag_curve_elevate(exact[i], *degree - cag_nurbs_data(exact[i])->degree, &raised, err);
    if (status) return status;
    cag_curve_release(exact[i]);
    exact[i] = raised;
    *points += cag_nurbs_data(raised)->count - 1;
    *rational = *rational || cag_nurbs_data(raised)->rational;
  }
  return CAG_OK;
}

// The joint of two pieces is a single homogeneous point, to which the weights of the second piece
// are scaled, and a knot of multiplicity equal to the degree. Knots inside the pieces are kept.
static CagStatus to_nurbs(const CagCurve *curve, CagCurve **out, CagError *err) {
  const Composite *c = (const Composite *)curve;
  CagCurve **exact = cag_calloc(c->n, sizeof *exact);
  double *data = NULL;
  int p = 0;
  size_t n = 0;
  bool rational = false;
  CagStatus status = exact ? alike_pieces(c, exact, &n, &rational, &p, err) : cag_fail_memory(err);
  if (!status && !(data = cag_malloc(sizeof(double) * (5 * n + (size_t)p + 1))))
    status = cag_fail_memory(err);
  if (!status) {
    double *h = data, *knots = data + 4 * n;
    size_t used = 0, k = 0;
    knots[k++] = curve->start;
    for (size_t i = 0; i < c->n; i++) {
      const CagNurbs *piece = cag_nurbs_data(exact[i]);
      const double scale = used ? h[4 * (used - 1) + 3] / piece->homogeneous[3] : 1;
      for (size_t m = used > 0; m < piece->count; m++, used++)
        for (size_t x = 0; x < 4; x++) h[4 * used + x] = scale * piece->homogeneous[4 * m + x];
      for (int m = 0; m < p; m++) knots[k++] = c->cuts[i];
      for (size_t m = (size_t)p + 1; m < piece->count; m++)
        knots[k++] = cag_curve_remap(exact[i], piece->knots[m], c->cuts[i], c->cuts[i + 1]);
    }
    for (int m = 0; m <= p; m++) knots[k++] = curve->end;
    status = cag_nurbs_new(h, used, p, knots, rational, 0,
                           rational ? CAG_NURBS_RATIONAL : CAG_NURBS_BSPLINE, curve->dimension, out,
                           err);
  }
  for (size_t i = 0; exact && i < c->n; i++) cag_curve_release(exact[i]);
  cag_free(exact);
  cag_free(data);
  return status;
}

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const Composite *c = (const Composite *)curve;
  CagCurve **pieces = cag_calloc(c->n, sizeof *pieces);
  if (!pieces) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < c->n; i++)
    status = cag_curve_transform(c->pieces[i], t, &pieces[i], err);
  if (!status) status = make(pieces, c->cuts, c->n, curve->angular, out, err);
  for (size_t i = 0; i < c->n; i++) cag_curve_release(pieces[i]);
  cag_free(pieces);
  return status;
}

// The part of piece i between two parameters of the whole curve, a < b.
static CagStatus part_of_piece(const Composite *c, size_t i, double a, double b, bool backwards,
                               CagCurve **out, CagError *err) {
  CagCurve *kept;
  CagStatus status = cag_curve_trim(c->pieces[i], local(c, i, a), local(c, i, b), &kept, err);
  if (status || !backwards) {
    if (!status) *out = kept;
    return status;
  }
  status = cag_curve_reverse(kept, out, err);
  cag_curve_release(kept);
  return status;
}

static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const Composite *c = (const Composite *)curve;
  const bool backwards = p->from > p->to;
  const double lo = fmin(p->from, p->to), hi = fmax(p->from, p->to);
  const size_t first = piece_of(c, lo, CAG_SIDE_RIGHT), last = piece_of(c, hi, CAG_SIDE_LEFT);
  const size_t n = last - first + 1;
  CagCurve **pieces = cag_calloc(n, sizeof *pieces);
  double *cuts = cag_malloc(sizeof *cuts * (n + 1));
  CagStatus status = CAG_OK;
  if (!pieces || !cuts) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    const double a = i == 0 ? lo : c->cuts[first + i], b = i == n - 1 ? hi : c->cuts[first + i + 1];
    const size_t k = backwards ? n - 1 - i : i;
    cuts[k] = cag_part_parameter(p, backwards ? b : a);
    status = part_of_piece(c, first + i, a, b, backwards, &pieces[k], err);
  }
  if (!status) {
    cuts[n] = p->end;
    status = make(pieces, cuts, n, false, out, err);
  }
  for (size_t i = 0; pieces && i < n; i++) cag_curve_release(pieces[i]);
  cag_free(pieces);
  cag_free(cuts);
  return status;
}

static CagBounds hull(const CagCurve *curve, double a, double b) {
  const Composite *c = (const Composite *)curve;
  CagBounds box = CAG_BOUNDS_EMPTY;
  size_t first = piece_of(c, a, CAG_SIDE_RIGHT), last = piece_of(c, b, CAG_SIDE_LEFT);
  for (size_t i = first; i <= last || i == first; i++) {
    double from = i == first ? local(c, i, a) : c->pieces[i]->start;
    double to = i == last ? local(c, i, b) : c->pieces[i]->end;
    CagBounds part = c->pieces[i]->kind->hull(c->pieces[i], from, fmax(from, to));
    cag_bounds_add(&box, part.min);
    cag_bounds_add(&box, part.max);
  }
  return box;
}

static size_t breaks(const CagCurve *curve, double *out, size_t capacity) {
  const Composite *c = (const Composite *)curve;
  size_t n = 0, k = 0;
  for (size_t i = 1; i <= c->n; i++) {
    for (; k < c->inner_count && (i == c->n || c->inner[k] < c->cuts[i]); k++, n++)
      if (n < capacity) out[n] = c->inner[k];
    if (i == c->n) break;
    if (n < capacity) out[n] = c->cuts[i];
    n++;
  }
  return n;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  snprintf(buffer, size, "%zu pieces", ((const Composite *)curve)->n);
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const Composite *c = (const Composite *)curve;
  cag_digest_word(d, c->n);
  for (size_t i = 0; i < c->n; i++) cag_curve_digest(c->pieces[i], d);
  cag_digest_numbers(d, c->cuts, c->n + 1);
}

static const CagCurveKind composite_kind = {
    "composite", eval, NULL, to_nurbs, transform, part, hull, breaks, describe, destroy, digest};

void cag_curve_lay_flat(CagCurve *c) {
  c->dimension = 2;
  if (c->kind != &composite_kind) return;
  for (size_t i = 0; i < ((Composite *)c)->n; i++) ((Composite *)c)->pieces[i]->dimension = 2;
}
