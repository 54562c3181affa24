// Edits corners and edges of surfaces by their control points.
//
// Everything uses homogeneous points. A join in homogeneous coordinates, with equal points and
// weights on the edge and N_across = ratio M_across + shear M_along of the homogeneous derivatives,
// is also a join of the points, by the quotient rule.

#include "geom/surface/edit.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"
#include "geom/surface/net.h"
#include "geom/surface/reshape.h"

// --- Corners ---

CagStatus cag_surface_corners(const CagSurface *s, CagHermiteCorners *out, CagError *err) {
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      CagVec3 d[9];
      CagStatus status = cag_surface_eval(s, i ? s->u1 : s->u0, j ? s->v1 : s->v0, 2,
                                          CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
      if (status) return status;
      out->p[i][j] = d[0];
      out->pu[i][j] = d[cag_partial(2, 1, 0)];
      out->pv[i][j] = d[cag_partial(2, 0, 1)];
      out->puv[i][j] = d[cag_partial(2, 1, 1)];
    }
  return CAG_OK;
}

CagStatus cag_surface_hermite_corners(const CagSurface *s, CagHermiteCorners *out, CagError *err) {
  enum { BICUBIC = 3 };
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (status) return status;
  CagSurfaceNurbsView v;
  cag_surface_nurbs_view(exact, &v);
  if (v.rational)
    status = cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_rational_patch, "", -1,
                      "the surface has weights: a Hermite patch is polynomial");
  else if (v.degree_u > BICUBIC || v.degree_v > BICUBIC)
    status = cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_degree_too_high, "", -1,
                      "the surface has the degrees %d and %d: a Hermite patch is at most bicubic",
                      v.degree_u, v.degree_v);
  else if (exact->kind->breaks(exact, 0, NULL, 0) + exact->kind->breaks(exact, 1, NULL, 0) > 0)
    status = cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_not_one_patch, "", -1,
                      "the surface has inner knots: use the patches of `to_bezier` one by one");
  else status = cag_surface_corners(exact, out, err);
  cag_surface_release(exact);
  return status;
}

// --- Single points ---

CagStatus cag_surface_set_point(const CagSurface *s, size_t i, size_t j, CagVec3 p, double weight,
                                CagSurface **out, CagError *err) {
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (status) return status;
  CagSurfaceNurbsView v;
  cag_surface_nurbs_view(exact, &v);
  size_t n = v.distinct_u, m = v.distinct_v;
  if (i >= n || j >= m) {
    status = cag_fail(
        err, CAG_E_DOMAIN, CAG_ERR_point_index, i >= n ? "i" : "j", (long)(i >= n ? i : j),
        "the net has %zu points in u and %zu in v, counted from 0: there is no point [%zu, %zu]", n,
        m, i, j);
    cag_surface_release(exact);
    return status;
  }
  CagVec3 *net = cag_malloc(n * m * sizeof *net);
  double *weights = cag_malloc(n * m * sizeof *weights);
  if (!net || !weights) status = cag_fail_memory(err);
  for (size_t k = 0; !status && k < n * m; k++) {
    const double *h = v.homogeneous + 4 * (k / m * v.nv + k % m);
    weights[k] = h[3];
    net[k] = h[3] > 0 ? cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]) : cag_vec3(0, 0, 0);
  }
  if (!status) {
    net[i * m + j] = p;
    if (weight >= 0) weights[i * m + j] = weight;
    status = cag_surface_nurbs_closed(net, weights, n, m, v.degree_u, v.degree_v, v.knots_u,
                                      v.knots_v, v.periodic_u, v.periodic_v, out, err);
  }
  cag_free(net);
  cag_free(weights);
  cag_surface_release(exact);
  return status;
}

// --- A corner's tangents and twist ---

typedef struct End {
  size_t at, next; // rows of the net: at the end, and next to it
  double rate;     // signed factor from the difference of these rows to the derivative at the end
} End;

static bool end_of(const double *knots, size_t n, int degree, int end, End *out) {
  size_t p = (size_t)degree;
  bool clamped = end ? knots[n] == knots[n + p] : knots[0] == knots[p];
  double span = end ? knots[n] - knots[n - 1] : knots[p + 1] - knots[p];
  out->at = end ? n - 1 : 0;
  out->next = end ? n - 2 : 1;
  out->rate = span > 0 ? (end ? -1 : 1) * (double)degree / span : 0;
  return clamped && span > 0;
}

static CagVec3 point_of(const double *h) { return cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]); }

static void put_point(double *h, CagVec3 p) {
  h[0] = h[3] * p.x;
  h[1] = h[3] * p.y;
  h[2] = h[3] * p.z;
}

static CagStatus rebuilt(const double *h, const CagSurfaceNurbsView *v, CagSurface **out,
                         CagError *err) {
  return cag_surface_from_homogeneous(h, v->nu, v->nv, v->degree_u, v->degree_v, v->knots_u,
                                      v->knots_v, out, err);
}

static CagVec3 wanted(const CagCornerEdit *e, int k, CagVec3 now) {
  return e->by_vector[k] ? e->vector[k] : cag_scaled(now, e->factor[k]);
}

// The points next to the corner set the tangents; then the diagonal one, on which the twist depends
// linearly, sets the twist.
static CagStatus move_corner(double *h, const CagSurfaceNurbsView *v, const CagCornerEdit *e,
                             const End *u, const End *w, CagSurface **out, CagError *err) {
  double *corner = h + 4 * (u->at * v->nv + w->at), *by_u = h + 4 * (u->next * v->nv + w->at);
  double *by_v = h + 4 * (u->at * v->nv + w->next), *inner = h + 4 * (u->next * v->nv + w->next);
  if (!(corner[3] > 0 && by_u[3] > 0 && by_v[3] > 0 && inner[3] > 0))
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "", -1,
        "a control point at this corner has the weight 0, so it has no effect; give it a positive weight first");
  CagVec3 p = point_of(corner);
  double to_u = u->rate * by_u[3] / corner[3], to_v = w->rate * by_v[3] / corner[3];
  CagVec3 du = wanted(e, 0, cag_scaled(cag_sub(point_of(by_u), p), to_u));
  CagVec3 dv = wanted(e, 1, cag_scaled(cag_sub(point_of(by_v), p), to_v));
  CagSurface *before, *between;
  CagHermiteCorners old, now;
  CagStatus status = rebuilt(h, v, &before, err);
  if (status) return status;
  status = cag_surface_corners(before, &old, err);
  cag_surface_release(before);
  if (status) return status;
  put_point(by_u, cag_madd(p, 1 / to_u, du));
  put_point(by_v, cag_madd(p, 1 / to_v, dv));
  status = rebuilt(h, v, &between, err);
  if (status) return status;
  status = cag_surface_corners(between, &now, err);
  cag_surface_release(between);
  if (status) return status;
  CagVec3 twist = wanted(e, 2, old.puv[e->u][e->v]);
  double rate = u->rate * w->rate * inner[3] / corner[3];
  put_point(inner, cag_madd(point_of(inner), 1 / rate, cag_sub(twist, now.puv[e->u][e->v])));
  return rebuilt(h, v, out, err);
}

CagStatus cag_surface_edit_corner(const CagSurface *s, const CagCornerEdit *edit, CagSurface **out,
                                  CagError *err) {
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(s, &exact, err);
  if (status) return status;
  CagSurfaceNurbsView v;
  End u, w;
  cag_surface_nurbs_view(exact, &v);
  double *h = NULL;
  if (!end_of(v.knots_u, v.nu, v.degree_u, edit->u, &u) ||
      !end_of(v.knots_v, v.nv, v.degree_v, edit->v, &w))
    status = cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_not_clamped, "", -1,
        "the surface does not end in its control points, so it has no corners to edit; `trim` over its domain returns the same surface with open knots");
  else {
    h = cag_malloc(4 * v.nu * v.nv * sizeof *h);
    if (!h) status = cag_fail_memory(err);
  }
  if (!status) {
    memcpy(h, v.homogeneous, 4 * v.nu * v.nv * sizeof *h);
    status = move_corner(h, &v, edit, &u, &w, out, err);
  }
  cag_free(h);
  cag_surface_release(exact);
  return status;
}

// --- Lines next to an edge ---

#define EDGE_WIDTH 8 // homogeneous point, and its derivative outward across the edge

// The edge on a side as a curve of these vectors.
static CagStatus edge_of(const CagSurface *s, int side, CagNet *out, CagError *err) {
  CagNet net, along;
  CagStatus status = cag_net_of_surface(s, side < 2 ? 0 : 1, &net, &along, err);
  if (status) return status;
  status = cag_net_trim(&net, cag_net_start(&net), cag_net_end(&net), err);
  if (!status) status = cag_net_new(along.degree, along.count, EDGE_WIDTH, out, err);
  if (!status) {
    memcpy(out->knots, along.knots, (along.count + (size_t)along.degree + 1) * sizeof(double));
    size_t n = net.count, p = (size_t)net.degree;
    bool last = side % 2 == 1;
    double span = last ? net.knots[n] - net.knots[n - 1] : net.knots[p + 1] - net.knots[p];
    const double *edge = net.data + (last ? n - 1 : 0) * net.width;
    const double *inner = net.data + (last ? n - 2 : 1) * net.width;
    for (size_t j = 0; j < along.count; j++)
      for (size_t c = 0; c < 4; c++) {
        out->data[EDGE_WIDTH * j + c] = edge[4 * j + c];
        out->data[EDGE_WIDTH * j + 4 + c] =
            (double)net.degree / span * (edge[4 * j + c] - inner[4 * j + c]);
      }
    status = cag_net_trim(out, cag_net_start(out), cag_net_end(out), err);
    if (status) cag_net_free(out);
  }
  cag_net_free(&net);
  cag_net_free(&along);
  return status;
}

// Rows shorter than this fraction of the longest have no direction to continue.
#define SHORT_LINE CAG_ROUNDING

static CagStatus check_match(const CagNet *edge, const CagEdgeMatch *how, CagError *err) {
  char text[32];
  if (!(how->ratio > 0) || !isfinite(how->ratio))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_join_folds, "ratio", -1,
                    "`ratio` must be positive, or the surfaces fold over each other; found %s",
                    cag_number_text(how->ratio, text));
  if ((how->shear[0] != 0 || how->shear[1] != 0) && edge->count > (size_t)edge->degree + 1)
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_join_shear, "shear", -1,
        "`shear` needs an edge of one piece, but this one has inner knots; use the patches of `to_bezier`");
  double longest = 0;
  for (int pass = 0; pass < 2; pass++)
    for (size_t j = 0; j < edge->count; j++) {
      const double *d = edge->data + EDGE_WIDTH * j + 4;
      double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3]);
      if (pass == 0) longest = fmax(longest, length);
      else if (!(length > SHORT_LINE * longest))
        return cag_fail(
            err, CAG_E_DEGENERATE, CAG_ERR_join_degenerate, "", (long)j,
            "the control points of line %zu next to the edge coincide, so the tangent across the edge is undefined; move one of them",
            j);
    }
  return CAG_OK;
}

// Replaces the derivative of the edge by the neighbor's inward derivative. Shear requires an edge
// of one piece: the product of the linear shear and the derivative along the edge then has the
// edge's degree.
static void continue_edge(CagNet *edge, const CagEdgeMatch *how) {
  double m = edge->degree, range = cag_net_end(edge) - cag_net_start(edge);
  for (size_t j = 0; j < edge->count; j++) {
    double *e = edge->data + EDGE_WIDTH * j;
    for (size_t c = 0; c < 4; c++) {
      double after = j + 1 < edge->count ? e[EDGE_WIDTH + c] - e[c] : 0;
      double before = j > 0 ? e[c] - (e - EDGE_WIDTH)[c] : 0;
      double shear =
          ((m - (double)j) * how->shear[0] * after + (double)j * how->shear[1] * before) / range;
      if (how->shear[0] == 0 && how->shear[1] == 0) shear = 0;
      e[4 + c] = how->ratio * e[4 + c] + shear;
    }
  }
}

// The neighbor's row next to the edge, from its derivative: `rate` is the factor from the
// difference of the first two rows to the inward derivative.
static CagStatus second_line(const CagNet *edge, double rate, double *out, CagError *err) {
  for (size_t j = 0; j < edge->count; j++) {
    const double *e = edge->data + EDGE_WIDTH * j;
    for (size_t c = 0; c < 4; c++) out[4 * j + c] = e[c] + e[4 + c] / rate;
    if (!(out[4 * j + 3] > 0))
      return cag_fail(
          err, CAG_E_DEGENERATE, CAG_ERR_negative_weight, "ratio", (long)j,
          "the neighbor would need a weight that is not positive in line %zu; use a smaller `ratio`",
          j);
  }
  return CAG_OK;
}

CagStatus cag_surface_join_lines(const CagSurface *s, int side, int degree, const CagEdgeMatch *how,
                                 double **lines, size_t *count, CagError *err) {
  CagNet edge;
  CagStatus status = edge_of(s, side, &edge, err);
  if (status) return status;
  status = check_match(&edge, how, err);
  double *out = NULL;
  if (!status) {
    out = cag_malloc(8 * edge.count * sizeof *out);
    if (!out) status = cag_fail_memory(err);
  }
  if (!status) {
    for (size_t j = 0; j < edge.count; j++)
      memcpy(out + 4 * j, edge.data + EDGE_WIDTH * j, 4 * sizeof *out);
    continue_edge(&edge, how);
    status = second_line(&edge, degree, out + 4 * edge.count, err);
  }
  *count = edge.count;
  cag_net_free(&edge);
  if (status) cag_free(out);
  else *lines = out;
  return status;
}

// b with both directions clamped, over the same domain.
static CagStatus clamped(const CagSurface *b, CagSurface **out, CagError *err) {
  CagSurface *exact;
  CagStatus status = cag_surface_to_nurbs(b, &exact, err);
  if (status) return status;
  status = cag_surface_nurbs_part(exact, exact->u0, exact->u1, exact->v0, exact->v1, out, err);
  cag_surface_release(exact);
  return status;
}

// Sets the edge's row and the next one of b, whose net runs along the edge.
static CagStatus put_lines(CagNet *b, const CagNet *across, int side, const CagNet *edge,
                           CagError *err) {
  size_t n = across->count, p = (size_t)across->degree;
  bool last = side % 2 == 1;
  double span =
      last ? across->knots[n] - across->knots[n - 1] : across->knots[p + 1] - across->knots[p];
  double *line = cag_malloc(4 * edge->count * sizeof *line);
  if (!line) return cag_fail_memory(err);
  CagStatus status = second_line(edge, (double)across->degree / span, line, err);
  // All weights of a surface may have a common factor: b's is used.
  double theirs = b->data[4 * (last ? n - 1 : 0) + 3], ours = edge->data[3];
  double factor = theirs > 0 && ours > 0 ? theirs / ours : 1;
  for (size_t j = 0; !status && j < b->count; j++) {
    double *first = b->data + j * b->width + 4 * (last ? n - 1 : 0);
    double *second = b->data + j * b->width + 4 * (last ? n - 2 : 1);
    for (size_t c = 0; c < 4; c++) {
      first[c] = factor * edge->data[EDGE_WIDTH * j + c];
      second[c] = factor * line[4 * j + c];
    }
  }
  cag_free(line);
  return status;
}

CagStatus cag_surface_match(const CagSurface *a, const CagSurface *b, const CagEdgeMatch *how,
                            const int sides[2], CagSurface **out, CagError *err) {
  CagSeam seam;
  CagSurface *base;
  CagNet nets[2] = {{0}, {0}}, across = {0}; // along the edge: of a, of all of b
  CagStatus status = cag_surface_seam_on(a, b, sides, 0, &seam, err);
  if (!status) status = edge_of(a, seam.side[0], &nets[0], err);
  if (status) return status;
  status = clamped(b, &base, err);
  if (!status) {
    status = cag_net_of_surface(base, seam.side[1] < 2 ? 1 : 0, &nets[1], &across, err);
    cag_surface_release(base);
  }
  if (!status) status = check_match(&nets[0], how, err);
  if (!status) {
    double from = cag_net_start(&nets[1]), to = cag_net_end(&nets[1]);
    if (seam.reversed) cag_net_reverse(&nets[0]);
    // Shear uses the parameter of a, and its direction; b may have inner knots.
    const double sign = seam.reversed ? -1 : 1;
    const CagEdgeMatch over = {
        how->ratio, {sign * how->shear[seam.reversed], sign * how->shear[!seam.reversed]}};
    continue_edge(&nets[0], &over);
    cag_net_rescale(&nets[0], 0, 1);
    cag_net_rescale(&nets[1], 0, 1);
    status = cag_nets_unify(nets, 2, err);
    if (!status) status = put_lines(&nets[1], &across, seam.side[1], &nets[0], err);
    cag_net_rescale(&nets[1], from, to);
  }
  if (!status) status = cag_net_to_surface(&nets[1], seam.side[1] < 2 ? 1 : 0, &across, out, err);
  cag_net_free(&nets[0]);
  cag_net_free(&nets[1]);
  cag_net_free(&across);
  return status;
}

// --- Creases ---

#define CREASE_PROBES 9
// Rounding of one-sided tangents stays well below this angle.
#define CREASE_LEAST 1e-7
// Number of derivatives tried for a tangent if the first ones vanish.
#define TANGENT_ORDERS 5
#define VANISHED CAG_COINCIDENT

// Unit tangent across the line from one side, in the direction of increasing parameters; zero: none
// found.
static CagStatus side_tangent(const CagSurface *s, int direction, double at, double other,
                              CagSide side, double length, CagVec3 *out, CagError *err) {
  CagVec3 d[(TANGENT_ORDERS + 1) * (TANGENT_ORDERS + 1)];
  CagStatus status =
      direction == 0 ? cag_surface_eval(s, at, other, TANGENT_ORDERS, side, CAG_SIDE_RIGHT, d, err)
                     : cag_surface_eval(s, other, at, TANGENT_ORDERS, CAG_SIDE_RIGHT, side, d, err);
  if (status) return status;
  double size = 0, power = 1, sign = 1;
  *out = cag_vec3(0, 0, 0);
  for (int pass = 0; pass < 2; pass++, power = 1)
    for (int k = 1; k <= TANGENT_ORDERS; k++) {
      CagVec3 x =
          d[direction == 0 ? cag_partial(TANGENT_ORDERS, k, 0) : cag_partial(TANGENT_ORDERS, 0, k)];
      power *= length;
      if (pass == 0) size = fmax(size, cag_norm(x) * power);
      else if (cag_norm(x) * power > VANISHED * size) {
        sign = side == CAG_SIDE_LEFT && k % 2 == 0 ? -1 : 1;
        *out = cag_scaled(cag_unit(x), sign);
        return CAG_OK;
      }
    }
  return CAG_OK;
}

CagStatus cag_surface_creases(const CagSurface *s, int direction, CagCrease **out, size_t *n,
                              CagError *err) {
  size_t count = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  double *at = cag_malloc((count + 1) * sizeof *at);
  CagCrease *found = cag_malloc((count + 1) * sizeof *found);
  CagStatus status = at && found ? CAG_OK : cag_fail_memory(err);
  if (!status && count > 0) s->kind->breaks(s, direction, at, count);
  double lo = direction == 0 ? s->v0 : s->u0, hi = direction == 0 ? s->v1 : s->u1;
  double length = (direction == 0 ? s->u1 - s->u0 : s->v1 - s->v0) / (double)(count + 1);
  *n = 0;
  for (size_t i = 0; !status && i < count; i++) {
    double most = 0;
    for (int k = 0; !status && k < CREASE_PROBES; k++) {
      CagVec3 left, right;
      double other = lo + (hi - lo) * (k + 0.5) / CREASE_PROBES;
      status = side_tangent(s, direction, at[i], other, CAG_SIDE_LEFT, length, &left, err);
      if (!status)
        status = side_tangent(s, direction, at[i], other, CAG_SIDE_RIGHT, length, &right, err);
      if (!status) most = fmax(most, atan2(cag_norm(cag_cross(left, right)), cag_dot(left, right)));
    }
    if (most > CREASE_LEAST) found[(*n)++] = (CagCrease){at[i], most};
  }
  cag_free(at);
  if (status) cag_free(found);
  else *out = found;
  return status;
}
