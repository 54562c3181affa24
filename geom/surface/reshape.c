// Knots, degrees, and joins of NURBS surfaces, by operations on their nets in one direction at a
// time.

#include "geom/surface/reshape.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/bernstein.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"
#include "geom/surface/net.h"

// Number of points along an edge at which two surfaces are compared: enough that no spline of usual
// degree hides a gap between them.
#define EDGE_PROBES 33

// --- Nets ---

typedef CagStatus (*NetChange)(CagNet *net, const void *how, CagError *err);

static bool periodic_in(const CagSurface *s, int direction) {
  CagSurfaceNurbsView v;
  return cag_surface_nurbs_view(s, &v) && (direction == 0 ? v.periodic_u : v.periodic_v);
}

// Restores a closed direction, whose last lines repeat the first ones. h: homogeneous points of n x
// m distinct lines, with their row length; knots are kept.
static CagStatus closed_again(const double *h, size_t row, size_t n, size_t m,
                              const CagSurfaceNurbsView *v, bool closed_u, bool closed_v,
                              CagSurface **out, CagError *err) {
  CagVec3 *net = cag_malloc(n * m * sizeof *net);
  double *weights = cag_malloc(n * m * sizeof *weights);
  CagStatus status = net && weights ? CAG_OK : cag_fail_memory(err);
  for (size_t k = 0; !status && k < n * m; k++) {
    const double *at = h + 4 * (k / m * row + k % m);
    weights[k] = at[3];
    net[k] = at[3] > 0 ? cag_project(at) : cag_vec3(0, 0, 0);
  }
  if (!status)
    status =
        cag_surface_nurbs_closed(net, v->rational ? weights : NULL, n, m, v->degree_u, v->degree_v,
                                 v->knots_u, v->knots_v, closed_u, closed_v, out, err);
  cag_free(net);
  cag_free(weights);
  return status;
}

// A closed direction stays closed when the other one is changed.
static CagStatus changed(const CagSurface *s, int direction, NetChange change, const void *how,
                         CagSurface **out, CagError *err) {
  CagNet net, across;
  CagSurface *open = NULL;
  CagStatus status = cag_net_of_surface(s, direction, &net, &across, err);
  if (status) return status;
  status = change(&net, how, err);
  if (!status) status = cag_net_to_surface(&net, direction, &across, &open, err);
  cag_net_free(&net);
  cag_net_free(&across);
  if (status || !periodic_in(s, 1 - direction)) {
    if (!status) *out = open;
    return status;
  }
  CagSurfaceNurbsView v;
  cag_surface_nurbs_view(open, &v);
  bool u = direction == 1;
  status = closed_again(v.homogeneous, v.nv, u ? v.nu - (size_t)v.degree_u : v.nu,
                        u ? v.nv : v.nv - (size_t)v.degree_v, &v, u, !u, out, err);
  cag_surface_release(open);
  return status;
}

typedef struct Insertion {
  double t;
  int times;
} Insertion;

static CagStatus insert(CagNet *net, const void *how, CagError *err) {
  const Insertion *k = how;
  char text[32], from[32], to[32];
  double start = cag_net_start(net), end = cag_net_end(net);
  if (!(k->t > start && k->t < end))
    return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "", -1,
                    "the knot must lie inside %s..%s, found %s", cag_number_text(start, from),
                    cag_number_text(end, to), cag_number_text(k->t, text));
  int there = cag_net_multiplicity(net, k->t);
  if (there + k->times > net->degree)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, "times", -1,
                    "no knot may occur more often than the degree %d: %s occurs %d times",
                    net->degree, cag_number_text(k->t, text), there);
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < k->times; i++) status = cag_net_insert(net, k->t, err);
  return status;
}

CagStatus cag_surface_insert_knot(const CagSurface *s, int direction, double t, int times,
                                  CagSurface **out, CagError *err) {
  Insertion k = {t, times};
  return changed(s, direction, insert, &k, out, err);
}

static CagStatus halve(CagNet *net, const void *how, CagError *err) {
  (void)how;
  size_t p = (size_t)net->degree, n = net->count;
  double *middles = cag_malloc((n + 1) * sizeof *middles);
  if (!middles) return cag_fail_memory(err);
  size_t count = 0;
  for (size_t i = p; i < n; i++)
    if (net->knots[i + 1] > net->knots[i])
      middles[count++] = (net->knots[i] + net->knots[i + 1]) / 2;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < count; i++) status = cag_net_insert(net, middles[i], err);
  cag_free(middles);
  return status;
}

static CagStatus raise(CagNet *net, const void *how, CagError *err) {
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < *(const int *)how; i++) status = cag_net_raise(net, err);
  return status;
}

// A change in u, then one in v; NULL: none.
static CagStatus both(const CagSurface *s, NetChange change, const void *u, const void *v,
                      CagSurface **out, CagError *err) {
  CagSurface *first;
  CagStatus status =
      u ? changed(s, 0, change, u, &first, err) : cag_surface_to_nurbs(s, &first, err);
  if (status) return status;
  if (!v) {
    *out = first;
    return CAG_OK;
  }
  status = changed(first, 1, change, v, out, err);
  cag_surface_release(first);
  return status;
}

// --- Refinement ---

// Whether knot i of the net equals t.
static bool at_knot(const CagNet *net, size_t i, double t) {
  const double same =
      CAG_ROUNDING; // of the usable range: rounding of the same number after some arithmetic
  return fabs(net->knots[i] - t) <= same * (cag_net_end(net) - cag_net_start(net));
}

static CagStatus fail_superset(const CagNet *net, size_t i, CagError *err) {
  char text[32];
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knots_not_superset, "knots", (long)i,
                  "the new knots must contain the old ones, with the same ends: %s is missing",
                  cag_number_text(net->knots[i], text));
}

// Inserts the knots of the wanted vector that the net lacks, inside the usable range. The knots are
// compared in order: each old one must appear.
static CagStatus to_knots(CagNet *net, const void *how, CagError *err) {
  const CagRefinement *r = how;
  size_t old = net->count + (size_t)net->degree + 1, i = 0, more = 0;
  double start = cag_net_start(net), end = cag_net_end(net),
         *add = cag_malloc((r->count + 1) * sizeof *add);
  if (!add) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t k = 0; !status && k < r->count; k++) {
    double t = r->knots[k];
    if (!isfinite(t) || (k > 0 && t < r->knots[k - 1]))
      status =
          cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knots_not_monotone, "knots", (long)k,
                   "the new knots must be finite and must not decrease: entry %zu is wrong", k);
    else if (i < old && at_knot(net, i, t)) i++;
    else if (i < old && net->knots[i] < t) status = fail_superset(net, i, err);
    else if (t > start && t < end) add[more++] = t;
    else {
      char text[32], from[32], to[32];
      status = cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_knots_not_superset, "knots", (long)k,
          "the new knots must keep the ends of %s..%s: %s is outside, or repeats an end too often",
          cag_number_text(start, from), cag_number_text(end, to), cag_number_text(t, text));
    }
  }
  if (!status && i < old) status = fail_superset(net, i, err);
  for (size_t k = 0; !status && k < more; k++) {
    if (cag_net_multiplicity(net, add[k]) >= net->degree) {
      char text[32];
      status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, "knots", -1,
                        "no inner knot may occur more often than the degree %d: %s does",
                        net->degree, cag_number_text(add[k], text));
    } else status = cag_net_insert(net, add[k], err);
  }
  cag_free(add);
  return status;
}

// Refines a closed direction at its midpoints: N(t) = 2^-p sum over k of C(p + 1, k) N(2t - k) for
// the uniform basis function of degree p, so point i contributes to the new points 2i - p + k.
// Knots keep the spacing 1, so the domain doubles in length.
static CagStatus halved_closed(const CagSurface *s, int direction, CagSurface **out,
                               CagError *err) {
  CagSurfaceNurbsView v;
  cag_surface_nurbs_view(s, &v);
  size_t n = v.distinct_u, m = v.distinct_v, old = direction == 0 ? n : m;
  size_t p = (size_t)(direction == 0 ? v.degree_u : v.degree_v);
  size_t nu = direction == 0 ? 2 * n : n, nv = direction == 1 ? 2 * m : m, total = nu * nv;
  double *h = cag_calloc(4 * total, sizeof *h);
  double *knots = cag_malloc((2 * old + 2 * p + 1) * sizeof *knots);
  CagStatus status = h && knots ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++)
    for (size_t j = 0; j < m; j++) {
      const double *from = v.homogeneous + 4 * (i * v.nv + j);
      size_t first = 2 * (direction == 0 ? i : j) + 2 * old * p - p;
      for (size_t k = 0; k <= p + 1; k++) {
        size_t to = (first + k) % (2 * old);
        double f = ldexp(cag_binomial((int)p + 1, (int)k), -(int)p);
        double *at = h + 4 * (direction == 0 ? to * nv + j : i * nv + to);
        for (size_t c = 0; c < 4; c++) at[c] += f * from[c];
      }
    }
  if (!status) {
    const double *was = direction == 0 ? v.knots_u : v.knots_v;
    for (size_t i = 0; i < 2 * old + 2 * p + 1; i++) {
      double steps = ((double)i - (double)p) / 2;
      knots[i] = was[p] + steps * (was[p + 1] - was[p]);
    }
    if (direction == 0) v.knots_u = knots;
    else v.knots_v = knots;
    status = closed_again(h, nv, nu, nv, &v, v.periodic_u, v.periodic_v, out, err);
  }
  cag_free(h);
  cag_free(knots);
  return status;
}

static CagStatus refine_one(const CagSurface *s, int direction, const CagRefinement *by,
                            CagSurface **out, CagError *err) {
  if (by->how == CAG_REFINE_NOT) {
    *out = cag_surface_retain(s);
    return CAG_OK;
  }
  if (by->how == CAG_REFINE_KNOTS) return changed(s, direction, to_knots, by, out, err);
  return periodic_in(s, direction) ? halved_closed(s, direction, out, err)
                                   : changed(s, direction, halve, NULL, out, err);
}

CagStatus cag_surface_refine(const CagSurface *s, bool u, bool v, CagSurface **out, CagError *err) {
  CagRefinement by[2] = {{u ? CAG_REFINE_MIDPOINTS : CAG_REFINE_NOT, NULL, 0},
                         {v ? CAG_REFINE_MIDPOINTS : CAG_REFINE_NOT, NULL, 0}};
  return cag_surface_refine_by(s, by, out, err);
}

CagStatus cag_surface_refine_by(const CagSurface *s, const CagRefinement by[2], CagSurface **out,
                                CagError *err) {
  CagSurface *exact, *first;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (status) return status;
  status = refine_one(exact, 0, &by[0], &first, err);
  cag_surface_release(exact);
  if (status) return status;
  status = refine_one(first, 1, &by[1], out, err);
  cag_surface_release(first);
  return status;
}

CagStatus cag_surface_elevate(const CagSurface *s, int u, int v, CagSurface **out, CagError *err) {
  return both(s, raise, u > 0 ? &u : NULL, v > 0 ? &v : NULL, out, err);
}

// --- Bezier pieces ---

typedef struct Range {
  double a, b;
} Range;

static CagStatus cut_out(CagNet *net, const void *how, CagError *err) {
  const Range *r = how;
  return cag_net_trim(net, r->a, r->b, err);
}

static CagStatus piece(CagNet *net, const void *how, CagError *err) {
  CagStatus status = cut_out(net, how, err);
  if (!status) cag_net_rescale(net, 0, 1);
  return status;
}

static size_t spans(const double *knots, size_t count, int degree, double *cuts) {
  size_t n = 0;
  cuts[n++] = knots[degree];
  for (size_t i = (size_t)degree + 1; i <= count; i++)
    if (knots[i] > cuts[n - 1]) cuts[n++] = knots[i];
  return n - 1;
}

CagStatus cag_surface_to_bezier(const CagSurface *s, CagSurface ***out, size_t *nu, size_t *nv,
                                CagError *err) {
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (status) return status;
  CagSurfaceNurbsView view;
  cag_surface_nurbs_view(exact, &view);
  double *cu = cag_malloc((view.nu + 2) * sizeof *cu), *cv = cag_malloc((view.nv + 2) * sizeof *cv);
  CagSurface **pieces = NULL;
  size_t made = 0;
  if (!cu || !cv) status = cag_fail_memory(err);
  if (!status) {
    *nu = spans(view.knots_u, view.nu, view.degree_u, cu);
    *nv = spans(view.knots_v, view.nv, view.degree_v, cv);
    pieces = cag_malloc(*nu * *nv * sizeof *pieces);
    if (!pieces) status = cag_fail_memory(err);
  }
  for (size_t i = 0; !status && i < *nu; i++) {
    Range u = {cu[i], cu[i + 1]};
    CagSurface *strip;
    status = changed(exact, 0, piece, &u, &strip, err);
    if (status) break;
    for (size_t j = 0; !status && j < *nv; j++) {
      Range v = {cv[j], cv[j + 1]};
      status = changed(strip, 1, piece, &v, &pieces[made], err);
      if (!status) made++;
    }
    cag_surface_release(strip);
  }
  cag_free(cu);
  cag_free(cv);
  cag_surface_release(exact);
  if (!status) {
    *out = pieces;
    return CAG_OK;
  }
  while (made > 0) cag_surface_release(pieces[--made]);
  cag_free(pieces);
  return status;
}

CagStatus cag_surface_nurbs_part(const CagSurface *s, double u0, double u1, double v0, double v1,
                                 CagSurface **out, CagError *err) {
  CagSurface *strip;
  Range u = {u0, u1}, v = {v0, v1};
  CagStatus status = changed(s, 0, cut_out, &u, &strip, err);
  if (status) return status;
  status = changed(strip, 1, cut_out, &v, out, err);
  cag_surface_release(strip);
  return status;
}

// --- Edges ---

// Partials at a fraction of a side: along the edge, and outward across it.
static CagStatus edge_partials(const CagSurface *s, int side, double f, CagVec3 *point,
                               CagVec3 *along, CagVec3 *across, CagVec3 second[3], CagError *err) {
  bool of_u = side < 2;
  double lo = of_u ? s->v0 : s->u0, hi = of_u ? s->v1 : s->u1, t = f >= 1 ? hi : lo + f * (hi - lo);
  double at = side == 0 ? s->u0 : side == 1 ? s->u1 : side == 2 ? s->v0 : s->v1;
  CagVec3 d[9];
  CagStatus status = of_u ? cag_surface_eval(s, at, t, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err)
                          : cag_surface_eval(s, t, at, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  double sign = side % 2 == 1 ? 1 : -1;
  CagVec3 du = d[cag_partial(2, 1, 0)], dv = d[cag_partial(2, 0, 1)];
  *point = d[0];
  *along = of_u ? dv : du;
  *across = cag_scaled(of_u ? du : dv, sign);
  second[0] = d[of_u ? cag_partial(2, 2, 0) : cag_partial(2, 0, 2)];
  second[1] = cag_scaled(d[cag_partial(2, 1, 1)], sign);
  second[2] = d[of_u ? cag_partial(2, 0, 2) : cag_partial(2, 2, 0)];
  return CAG_OK;
}

static CagStatus edge_gap(const CagSurface *a, int i, const CagSurface *b, int j, bool reversed,
                          double *gap, CagError *err) {
  CagVec3 p, q, along, across, second[3];
  *gap = 0;
  for (int k = 0; k < EDGE_PROBES; k++) {
    double f = (double)k / (EDGE_PROBES - 1);
    CagStatus status = edge_partials(a, i, f, &p, &along, &across, second, err);
    if (!status)
      status = edge_partials(b, j, reversed ? 1 - f : f, &q, &along, &across, second, err);
    if (status) return status;
    *gap = fmax(*gap, cag_norm(cag_sub(p, q)));
  }
  return CAG_OK;
}

// Normal curvature in the direction of the surface that is perpendicular to the edge.
static double across_curvature(CagVec3 along, CagVec3 across, const CagVec3 second[3]) {
  CagVec3 n = cag_unit(cag_cross(across, along)), w = cag_cross(along, n);
  // w = x across + y along in the tangent plane.
  double e = cag_dot(across, across), f = cag_dot(across, along), g = cag_dot(along, along);
  double det = e * g - f * f, wa = cag_dot(w, across), wl = cag_dot(w, along);
  double x = (wa * g - wl * f) / det, y = (wl * e - wa * f) / det;
  double form = x * x * cag_dot(n, second[0]) + 2 * x * y * cag_dot(n, second[1]) +
                y * y * cag_dot(n, second[2]);
  return form / cag_dot(w, w);
}

static CagStatus find_seam(const CagSurface *a, const CagSurface *b, const int sides[2],
                           CagSeam *out, CagError *err) {
  out->gap = INFINITY;
  // The usual pair first: the end of the first surface with the start of the second.
  static const int ORDER[] = {1, 3, 0, 2};
  for (int x = 0; x < 4; x++)
    for (int y = 3; y >= 0; y--)
      for (int r = 0; r < 2; r++) {
        double gap;
        if (sides && (sides[0] != ORDER[x] || sides[1] != ORDER[y])) continue;
        CagStatus status = edge_gap(a, ORDER[x], b, ORDER[y], r == 1, &gap, err);
        if (status) return status;
        if (gap >= out->gap * (1 - 1e-6)) continue;
        *out = (CagSeam){.side = {ORDER[x], ORDER[y]}, .reversed = r == 1, .gap = gap};
      }
  return CAG_OK;
}

CagStatus cag_surface_seam(const CagSurface *a, const CagSurface *b, double tolerance, CagSeam *out,
                           CagError *err) {
  return cag_surface_seam_on(a, b, NULL, tolerance, out, err);
}

CagStatus cag_surface_seam_on(const CagSurface *a, const CagSurface *b, const int sides[2],
                              double tolerance, CagSeam *out, CagError *err) {
  CagBounds box, other;
  CagStatus status = find_seam(a, b, sides, out, err);
  if (!status) status = cag_surface_bounds(a, &box, err);
  if (!status) status = cag_surface_bounds(b, &other, err);
  if (status) return status;
  cag_bounds_add(&box, other.min);
  cag_bounds_add(&box, other.max);
  double size = cag_norm(cag_sub(box.max, box.min)), fastest = 0, bend = 0;
  for (int k = 0; k < EDGE_PROBES; k++) {
    double f = (double)k / (EDGE_PROBES - 1);
    CagVec3 p, q, la, lb, xa, xb, sa[3], sb[3];
    status = edge_partials(a, out->side[0], f, &p, &la, &xa, sa, err);
    if (!status)
      status = edge_partials(b, out->side[1], out->reversed ? 1 - f : f, &q, &lb, &xb, sb, err);
    if (status) return status;
    if (out->reversed) {
      lb = cag_scaled(lb, -1);
      sb[1] = cag_scaled(sb[1], -1);
    }
    // The outward direction of a across the seam is inward for b.
    xb = cag_scaled(xb, -1);
    sb[1] = cag_scaled(sb[1], -1);
    CagVec3 na = cag_cross(xa, la), nb = cag_cross(xb, lb);
    out->angle = fmax(out->angle, atan2(cag_norm(cag_cross(na, nb)), cag_dot(na, nb)));
    out->first = fmax(out->first, cag_norm(cag_sub(xa, xb)));
    fastest = fmax(fastest, fmax(cag_norm(xa), cag_norm(xb)));
    double ka = across_curvature(la, xa, sa), kb = across_curvature(lb, xb, sb);
    out->curvature = fmax(out->curvature, fabs(ka - kb));
    bend = fmax(bend, fmax(fabs(ka), fabs(kb)));
  }
  out->c0 = out->gap <= tolerance * size;
  out->g1 = out->c0 && out->angle <= tolerance;
  out->c1 = out->c0 && out->first <= tolerance * fastest;
  out->g2 = out->g1 && out->curvature <= tolerance * fmax(bend, 1 / size);
  return CAG_OK;
}

// --- Join ---

// The net of the surface reoriented so that the side becomes u1 (`last`) or u0, with the direction
// of the side reversed on demand.
static CagStatus turned(const CagSurface *s, int side, bool last, bool reverse, CagNet *net,
                        CagNet *across, CagError *err) {
  int direction = side < 2 ? 0 : 1;
  CagStatus status = cag_net_of_surface(s, direction, net, across, err);
  if (status) return status;
  if ((side % 2 == 1) != last) cag_net_reverse(net);
  if (reverse) {
    CagSurface *put;
    CagNet cross, other;
    status = cag_net_to_surface(net, 0, across, &put, err);
    cag_net_free(net);
    cag_net_free(across);
    if (!status) status = cag_net_of_surface(put, 1, &cross, &other, err);
    if (status) return status;
    cag_surface_release(put);
    cag_net_reverse(&cross);
    status = cag_net_to_surface(&cross, 1, &other, &put, err);
    cag_net_free(&cross);
    cag_net_free(&other);
    if (status) return status;
    status = cag_net_of_surface(put, 0, net, across, err);
    cag_surface_release(put);
  }
  return status;
}

// Gives both nets the degree and the knot vector in v of the first.
static CagStatus alike_across(CagNet nets[2], CagNet across[2], CagError *err) {
  CagNet lines[2], along[2];
  CagStatus status = CAG_OK;
  double lo = cag_net_start(&across[0]), hi = cag_net_end(&across[0]);
  int made = 0;
  for (; !status && made < 2; made++) {
    CagSurface *s;
    status = cag_net_to_surface(&nets[made], 0, &across[made], &s, err);
    if (status) break;
    status = cag_net_of_surface(s, 1, &lines[made], &along[made], err);
    cag_surface_release(s);
    if (status) break;
    status =
        cag_net_trim(&lines[made], cag_net_start(&lines[made]), cag_net_end(&lines[made]), err);
    cag_net_rescale(&lines[made], 0, 1);
  }
  if (!status) status = cag_nets_unify(lines, 2, err);
  for (int k = 0; !status && k < 2; k++) {
    CagSurface *s;
    cag_net_rescale(&lines[k], lo, hi);
    status = cag_net_to_surface(&lines[k], 1, &along[k], &s, err);
    if (status) break;
    cag_net_free(&nets[k]);
    cag_net_free(&across[k]);
    status = cag_net_of_surface(s, 0, &nets[k], &across[k], err);
    cag_surface_release(s);
  }
  for (int k = 0; k < made; k++) {
    cag_net_free(&lines[k]);
    cag_net_free(&along[k]);
  }
  return status;
}

// Appends the second net to the first, whose row at the joint is kept.
static CagStatus behind(const CagNet nets[2], CagNet *out, CagError *err) {
  const CagNet *a = &nets[0], *b = &nets[1];
  size_t p = (size_t)a->degree, n = a->count + b->count - 1;
  CagStatus status = cag_net_new(a->degree, n, a->width, out, err);
  if (status) return status;
  // Weights along the seam may differ by a factor.
  double factor = a->data[(a->count - 1) * a->width + 3] / b->data[3];
  memcpy(out->data, a->data, a->count * a->width * sizeof *out->data);
  for (size_t i = a->width; i < b->count * b->width; i++)
    out->data[(a->count - 1) * a->width + i] = factor * b->data[i];
  double shift = cag_net_end(a) - cag_net_start(b);
  memcpy(out->knots, a->knots, (a->count + p) * sizeof *out->knots);
  for (size_t i = p + 1; i < b->count + p + 1; i++)
    out->knots[a->count + i - 1] = b->knots[i] + shift;
  return CAG_OK;
}

CagStatus cag_surface_join(const CagSurface *a, const CagSurface *b, double tolerance,
                           CagSurface **out, CagError *err) {
  CagSeam seam;
  CagStatus status = cag_surface_seam(a, b, tolerance, &seam, err);
  if (status) return status;
  char text[32];
  if (!seam.c0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_edges_do_not_match, "", -1,
                    "no edge of the first surface lies on one of the second: the nearest two are "
                    "%s apart",
                    cag_number_text(seam.gap, text));
  CagNet nets[2] = {{0}, {0}}, across[2] = {{0}, {0}}, joined = {0};
  status = turned(a, seam.side[0], true, false, &nets[0], &across[0], err);
  if (!status) status = turned(b, seam.side[1], false, seam.reversed, &nets[1], &across[1], err);
  if (!status) status = alike_across(nets, across, err);
  for (int k = 0; !status && k < 2; k++)
    status = cag_net_trim(&nets[k], cag_net_start(&nets[k]), cag_net_end(&nets[k]), err);
  for (int k = 0; k < 2; k++)
    while (!status && nets[k].degree < nets[1 - k].degree) status = cag_net_raise(&nets[k], err);
  if (!status) status = behind(nets, &joined, err);
  if (!status) status = cag_net_to_surface(&joined, 0, &across[0], out, err);
  cag_net_free(&joined);
  for (int k = 0; k < 2; k++) {
    cag_net_free(&nets[k]);
    cag_net_free(&across[k]);
  }
  return status;
}
