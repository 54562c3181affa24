// Tensor product NURBS surfaces: Bezier, B-spline and rational, open or closed in each direction.
// Construction from nets, images, and the table of the kind.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/surface/family.h"
#include "geom/surface/frames.h"
#include "geom/surface/tensor.h"
#include "geom/surface/trimmed.h"

static const CagSurfaceKind bezier_kind, bspline_kind, nurbs_kind;

// --- Construction ---

static CagStatus check_knots(const double *knots, size_t count, int degree, const char *name,
                             CagError *err) {
  char a[32], b[32];
  size_t n = count + (size_t)degree + 1;
  for (size_t i = 0; i < n; i++) {
    if (!isfinite(knots[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, name, (long)i,
                      "`%s` must be finite: entry %zu is %s", name, i,
                      cag_number_text(knots[i], a));
    if (i > 0 && knots[i] < knots[i - 1])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knots_not_monotone, name, (long)i,
                      "`%s` must not decrease: entry %zu is %s after %s", name, i,
                      cag_number_text(knots[i], a), cag_number_text(knots[i - 1], b));
  }
  double from = knots[degree], to = knots[count];
  if (!(to > from))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, name, degree,
                    "the usable range of `%s` has no length: entries %d and %zu are both %s", name,
                    degree, count, cag_number_text(from, a));
  for (size_t i = 1; i + (size_t)degree + 1 < n; i++)
    if (knots[i] > from && knots[i] < to && knots[i + (size_t)degree] == knots[i])
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, name, (long)i,
          "`%s` can contain an inner knot at most %d times (the degree), but %s occurs more often, from entry %zu on",
          name, degree, cag_number_text(knots[i], a), i);
  return CAG_OK;
}

static CagStatus check_degree(size_t count, int degree, const char *direction, CagError *err) {
  if (degree >= 1 && degree <= MAX_DEGREE && (size_t)degree < count) return CAG_OK;
  if (count < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "net", -1,
                    "a surface needs at least 2 rows of at least 2 points, but in %s there %s %zu",
                    direction, count == 1 ? "is" : "are", count);
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", *direction == 'u' ? 0 : 1,
      "`degree` in %s must lie in 1..%zu for %zu control points (and be at most %d), found %d; add points, or lower the degree",
      direction, count ? count - 1 : 0, count, MAX_DEGREE, degree);
}

static CagStatus check_net(const double *h, size_t nu, size_t nv, CagError *err) {
  for (size_t i = 0; i < nu * nv; i++)
    for (int c = 0; c < 4; c++)
      if (!isfinite(h[4 * i + (size_t)c]))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, c < 3 ? "net" : "weights", (long)i,
                        "`%s` must be finite: row %zu, column %zu is not",
                        c < 3 ? "net" : "weights", i / nv, i % nv);
  return CAG_OK;
}

static bool near(const double *a, const double *b, double size) {
  for (int c = 0; c < 4; c++)
    if (fabs(a[c] - b[c]) > CAG_SURFACE_SAME * (c == 3 ? fmax(fabs(a[3]), fabs(b[3])) : size))
      return false;
  return true;
}

// Whether the points are equal, whatever their weights.
static bool near_point(const double *a, const double *b, double size) {
  for (int c = 0; c < 3; c++)
    if (fabs(a[c] * b[3] - b[c] * a[3]) > CAG_SURFACE_SAME * size * fmax(a[3], b[3])) return false;
  return true;
}

static bool clamped(const Direction *d) {
  return d->knots[0] == d->knots[d->degree] &&
         d->knots[d->count] == d->knots[d->count + (size_t)d->degree];
}

// Determines the flags from the net if the edges of the surface are those of the net, which is
// exact; else from points.
static void judge(Nurbs *b) {
  cag_surface_judge(&b->base);
  size_t nu = b->u.count, nv = b->v.count;
  double size = 0;
  for (size_t i = 0; i < nu * nv; i++)
    for (size_t c = 0; c < 3; c++) size = fmax(size, fabs(b->net[4 * i + c]));
  if (clamped(&b->u)) {
    const double *first = b->net, *last = b->net + 4 * (nu - 1) * nv;
    bool closed = true, pole0 = true, pole1 = true;
    for (size_t j = 0; j < nv; j++) {
      closed = closed && near(first + 4 * j, last + 4 * j, size);
      pole0 = pole0 && near_point(first + 4 * j, first, size);
      pole1 = pole1 && near_point(last + 4 * j, last, size);
    }
    b->base.closed_u = closed && !(pole0 && pole1);
    b->base.pole_u0 = pole0;
    b->base.pole_u1 = pole1;
  }
  if (clamped(&b->v)) {
    bool closed = true, pole0 = true, pole1 = true;
    for (size_t i = 0; i < nu; i++) {
      const double *first = b->net + 4 * i * nv, *last = first + 4 * (nv - 1);
      closed = closed && near(first, last, size);
      pole0 = pole0 && near_point(first, b->net, size);
      pole1 = pole1 && near_point(last, b->net + 4 * (nv - 1), size);
    }
    b->base.closed_v = closed && !(pole0 && pole1);
    b->base.pole_v0 = pole0;
    b->base.pole_v1 = pole1;
  }
  b->base.closed_u = b->base.closed_u || b->u.periodic;
  b->base.closed_v = b->base.closed_v || b->v.periodic;
}

// Partials are differences of neighboring points divided by the length of a span.
static void find_noise(Nurbs *b) {
  double most = 0, weight = 0;
  for (size_t i = 0; i < b->u.count * b->v.count; i++) {
    const double *p = b->net + 4 * i;
    most = fmax(most, cag_norm(cag_vec3(p[0], p[1], p[2])));
    weight = fmax(weight, p[3]);
  }
  const Direction *along[2] = {&b->u, &b->v};
  for (int k = 0; k < 2; k++) {
    const Direction *d = along[k];
    double spans = (double)(d->count - (size_t)d->degree);
    double noise = cag_partial_noise(cag_vec3(most / weight, 0, 0),
                                     (d->knots[d->count] - d->knots[d->degree]) / spans);
    b->noise2[k] = noise * noise;
  }
}

static bool is_bezier(const Direction *d) {
  return d->count == (size_t)d->degree + 1 && clamped(d) && d->knots[d->degree] == 0 &&
         d->knots[d->count] == 1;
}

static void nurbs_destroy(CagSurface *s) {
  Nurbs *b = (Nurbs *)s;
  cag_free(b->u.knots);
  cag_free(b->v.knots);
  cag_free(b->net);
  cag_free(b->planes);
}

// Copies everything; the net is homogeneous and already contains the repeated lines of closed
// directions.
static CagStatus build(const double *net, const Direction *u, const Direction *v, CagSurface **out,
                       CagError *err) {
  CagStatus status = check_net(net, u->count, v->count, err);
  if (status) return status;
  CagSurface *s;
  status = cag_surface_block(sizeof(Nurbs), &nurbs_kind, u->knots[u->degree], u->knots[u->count],
                             v->knots[v->degree], v->knots[v->count], &s, err);
  if (status) return status;
  Nurbs *b = (Nurbs *)s;
  size_t total = u->count * v->count;
  size_t knots_u = u->count + (size_t)u->degree + 1, knots_v = v->count + (size_t)v->degree + 1;
  b->u = *u;
  b->v = *v;
  b->u.knots = cag_malloc(knots_u * sizeof(double));
  b->v.knots = cag_malloc(knots_v * sizeof(double));
  b->net = cag_malloc(4 * total * sizeof(double));
  b->planes = cag_malloc(4 * total * sizeof(double));
  if (!b->u.knots || !b->v.knots || !b->net || !b->planes) {
    cag_surface_release(s);
    return cag_fail_memory(err);
  }
  memcpy(b->u.knots, u->knots, knots_u * sizeof(double));
  memcpy(b->v.knots, v->knots, knots_v * sizeof(double));
  memcpy(b->net, net, 4 * total * sizeof(double));
  // Equal weights mean a polynomial surface.
  double w = net[3];
  for (size_t i = 0; i < total; i++) b->rational = b->rational || net[4 * i + 3] != w;
  if (!b->rational && w != 1)
    for (size_t i = 0; i < total; i++) {
      for (size_t c = 0; c < 3; c++) b->net[4 * i + c] /= w;
      b->net[4 * i + 3] = 1;
    }
  for (size_t i = 0; i < total; i++)
    for (size_t c = 0; c < 4; c++) b->planes[c * total + i] = b->net[4 * i + c];
  bool bezier = is_bezier(&b->u) && is_bezier(&b->v);
  s->kind = bezier ? &bezier_kind : b->rational ? &nurbs_kind : &bspline_kind;
  judge(b);
  find_noise(b);
  *out = s;
  return CAG_OK;
}

CagStatus cag_surface_from_homogeneous(const double *net, size_t nu, size_t nv, int degree_u,
                                       int degree_v, const double *knots_u, const double *knots_v,
                                       CagSurface **out, CagError *err) {
  Direction u = {degree_u, nu, nu, false, (double *)knots_u};
  Direction v = {degree_v, nv, nv, false, (double *)knots_v};
  CagStatus status = check_degree(nu, degree_u, "u", err);
  if (!status) status = check_degree(nv, degree_v, "v", err);
  if (!status) status = check_knots(knots_u, nu, degree_u, "knots", err);
  if (!status) status = check_knots(knots_v, nv, degree_v, "knots", err);
  return status ? status : build(net, &u, &v, out, err);
}

static CagStatus check_weights(const double *weights, size_t nu, size_t nv, CagError *err) {
  bool any = false;
  for (size_t i = 0; weights && i < nu * nv; i++) {
    char text[32];
    if (!(weights[i] >= 0) || !isfinite(weights[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_negative_weight, "weights", (long)i,
                      "`weights` must be finite and not negative: row %zu, column %zu is %s",
                      i / nv, i % nv, cag_number_text(weights[i], text));
    any = any || weights[i] > 0;
  }
  if (weights && !any)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_denominator, "weights", 0,
                    "`weights` must not all be 0");
  return CAG_OK;
}

// Fills a direction: the given knots, or integers for a closed direction (malloc'd, in *own).
static CagStatus make_direction(size_t count, int degree, const double *knots, bool closed,
                                const char *name, Direction *out, double **own, CagError *err) {
  *own = NULL;
  size_t stored = closed ? count + (size_t)(degree > 0 ? degree : 0) : count;
  CagStatus status = check_degree(count, degree, name, err);
  if (status) return status;
  *out = (Direction){degree, stored, count, closed, (double *)knots};
  if (!closed || knots) return check_knots(knots, stored, degree, "knots", err);
  size_t n = stored + (size_t)degree + 1;
  *own = cag_malloc(n * sizeof **own);
  if (!*own) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) (*own)[i] = (double)i - degree;
  out->knots = *own;
  return CAG_OK;
}

CagStatus cag_surface_nurbs_closed(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                                   int degree_u, int degree_v, const double *knots_u,
                                   const double *knots_v, bool closed_u, bool closed_v,
                                   CagSurface **out, CagError *err) {
  Direction u, v;
  double *own_u = NULL, *own_v = NULL, *h = NULL;
  CagStatus status = make_direction(nu, degree_u, knots_u, closed_u, "u", &u, &own_u, err);
  if (!status) status = make_direction(nv, degree_v, knots_v, closed_v, "v", &v, &own_v, err);
  if (!status) status = check_weights(weights, nu, nv, err);
  if (!status) {
    h = cag_malloc(4 * u.count * v.count * sizeof *h);
    if (!h) status = cag_fail_memory(err);
  }
  for (size_t i = 0; !status && i < u.count; i++)
    for (size_t j = 0; j < v.count; j++) {
      size_t from = (i % nu) * nv + j % nv;
      double w = weights ? weights[from] : 1, *to = h + 4 * (i * v.count + j);
      to[0] = net[from].x * w;
      to[1] = net[from].y * w;
      to[2] = net[from].z * w;
      to[3] = w;
    }
  if (!status) status = build(h, &u, &v, out, err);
  cag_free(h);
  cag_free(own_u);
  cag_free(own_v);
  return status;
}

CagStatus cag_surface_nurbs(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                            int degree_u, int degree_v, const double *knots_u,
                            const double *knots_v, CagSurface **out, CagError *err) {
  return cag_surface_nurbs_closed(net, weights, nu, nv, degree_u, degree_v, knots_u, knots_v, false,
                                  false, out, err);
}

CagStatus cag_surface_bezier(const CagVec3 *net, const double *weights, size_t nu, size_t nv,
                             CagSurface **out, CagError *err) {
  double knots_u[2 * (MAX_DEGREE + 1)], knots_v[2 * (MAX_DEGREE + 1)];
  int p = nu <= MAX_DEGREE + 1 ? (int)nu - 1 : MAX_DEGREE + 1;
  int q = nv <= MAX_DEGREE + 1 ? (int)nv - 1 : MAX_DEGREE + 1;
  CagStatus status = check_degree(nu, p, "u", err);
  if (!status) status = check_degree(nv, q, "v", err);
  if (status) return status;
  for (size_t i = 0; i < 2 * nu; i++) knots_u[i] = i < nu ? 0 : 1;
  for (size_t i = 0; i < 2 * nv; i++) knots_v[i] = i < nv ? 0 : 1;
  return cag_surface_nurbs(net, weights, nu, nv, p, q, knots_u, knots_v, out, err);
}

// --- Other functions of the kind ---

static CagStatus nurbs_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  (void)err;
  *out = cag_surface_retain(s);
  return CAG_OK;
}

static CagStatus nurbs_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                 CagError *err) {
  const Nurbs *b = (const Nurbs *)s;
  size_t total = b->u.count * b->v.count;
  double *h = cag_malloc(4 * total * sizeof *h);
  if (!h) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < total; i++) {
    cag_transform_homogeneous(t, b->net + 4 * i, h + 4 * i);
    if (h[4 * i + 3] < 0 || (h[4 * i + 3] == 0 && b->net[4 * i + 3] > 0))
      status = cag_fail(
          err, CAG_E_DEGENERATE, CAG_ERR_behind_center, "transform", (long)i,
          "the projection maps control point [%zu, %zu] to infinity or behind its center; move the surface or the center",
          i / b->v.count, i % b->v.count);
  }
  if (!status) status = build(h, &b->u, &b->v, out, err);
  cag_free(h);
  return status;
}

static size_t nurbs_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Nurbs *b = (const Nurbs *)s;
  const Direction *d = direction == 0 ? &b->u : &b->v;
  size_t n = 0;
  for (size_t i = (size_t)d->degree + 1; i < d->count; i++)
    if (d->knots[i] > d->knots[i - 1] && d->knots[i] < d->knots[d->count]) {
      if (n < capacity) out[n] = d->knots[i];
      n++;
    }
  return n;
}

static void nurbs_describe(const CagSurface *s, char *buffer, size_t size) {
  const Nurbs *b = (const Nurbs *)s;
  const char *closed = b->u.periodic   ? b->v.periodic ? ", closed by u and v" : ", closed by u"
                       : b->v.periodic ? ", closed by v"
                                       : "";
  snprintf(buffer, size, "degree %d x %d, %zu x %zu points%s", b->u.degree, b->v.degree,
           b->u.distinct, b->v.distinct, closed);
}

static void nurbs_digest(const CagSurface *surface, CagDigest *d) {
  const Nurbs *s = (const Nurbs *)surface;
  const Direction *const directions[] = {&s->u, &s->v};
  for (int i = 0; i < 2; i++) {
    const Direction *k = directions[i];
    cag_digest_word(d, (uint64_t)k->degree);
    cag_digest_word(d, k->count);
    cag_digest_numbers(d, k->knots, k->count + (size_t)k->degree + 1);
  }
  cag_digest_numbers(d, s->net, 4 * s->u.count * s->v.count);
}

#define NURBS_TABLE(text)                                                                          \
  {                                                                                                \
    .name = text, .eval = cag_tensor_eval, .eval_grid = cag_tensor_grid,                           \
    .to_nurbs = nurbs_to_nurbs, .transform = nurbs_transform, .breaks = nurbs_breaks,              \
    .describe = nurbs_describe, .destroy = nurbs_destroy, .digest = nurbs_digest,                  \
  }
static const CagSurfaceKind bezier_kind = NURBS_TABLE("bezier");
static const CagSurfaceKind bspline_kind = NURBS_TABLE("bspline");
static const CagSurfaceKind nurbs_kind = NURBS_TABLE("nurbs");

static const Nurbs *as_nurbs(const CagSurface *s) {
  return s->kind->eval == cag_tensor_eval ? (const Nurbs *)s : NULL;
}

bool cag_surface_nurbs_frames(const CagSurface *s, const double *us, size_t nu, const double *vs,
                              size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                              CagVec3 *normals, CagStatus *status, CagError *err) {
  const Nurbs *b = as_nurbs(s);
  if (b) *status = cag_tensor_frames(b, us, nu, vs, nv, points, du, dv, normals, err);
  return b != NULL;
}

bool cag_surface_nurbs_view(const CagSurface *s, CagSurfaceNurbsView *out) {
  const Nurbs *b = as_nurbs(s);
  if (!b) return false;
  if (out)
    *out = (CagSurfaceNurbsView){
        .degree_u = b->u.degree,
        .degree_v = b->v.degree,
        .nu = b->u.count,
        .nv = b->v.count,
        .distinct_u = b->u.distinct,
        .distinct_v = b->v.distinct,
        .periodic_u = b->u.periodic,
        .periodic_v = b->v.periodic,
        .rational = b->rational,
        .knots_u = b->u.knots,
        .knots_v = b->v.knots,
        .homogeneous = b->net,
    };
  return true;
}

CagStatus cag_surface_nurbs_swapped(const CagSurface *s, CagSurface **out, CagError *err) {
  const Nurbs *b = as_nurbs(s);
  if (!b)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_not_nurbs, "surface", -1,
                    "the surface is %s %s: convert it to a NURBS first", cag_article(s->kind->name),
                    s->kind->name);
  size_t nu = b->u.count, nv = b->v.count;
  double *h = cag_malloc(4 * nu * nv * sizeof *h);
  if (!h) return cag_fail_memory(err);
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++)
      memcpy(h + 4 * (j * nu + i), b->net + 4 * (i * nv + j), 4 * sizeof *h);
  CagStatus status = build(h, &b->v, &b->u, out, err);
  cag_free(h);
  return status;
}

// Reverses v over the same domain.
static CagStatus reversed_v(const Nurbs *b, CagSurface **out, CagError *err) {
  size_t nu = b->u.count, nv = b->v.count, knots = nv + (size_t)b->v.degree + 1;
  double *h = cag_malloc(4 * nu * nv * sizeof *h), *turned = cag_malloc(knots * sizeof *turned);
  CagStatus status = h && turned ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    for (size_t i = 0; i < nu; i++)
      for (size_t j = 0; j < nv; j++)
        memcpy(h + 4 * (i * nv + nv - 1 - j), b->net + 4 * (i * nv + j), 4 * sizeof *h);
    // The ends of the domain are exchanged exactly; other knots are reflected about its middle.
    double a = b->base.v0, z = b->base.v1;
    for (size_t k = 0; k < knots; k++) {
      double t = b->v.knots[knots - 1 - k];
      turned[k] = t == a ? z : t == z ? a : a + z - t;
    }
    Direction v = b->v;
    v.knots = turned;
    status = build(h, &b->u, &v, out, err);
  }
  cag_free(h);
  cag_free(turned);
  return status;
}

CagStatus cag_surface_flip(const CagSurface *s, CagSurface **out, CagError *err) {
  const Nurbs *b = as_nurbs(s);
  if (b) return reversed_v(b, out, err);
  if (cag_surface_trimmed_view(s, NULL, NULL)) return cag_trimmed_flip(s, out, err);
  CagVec3 origin, x, y;
  if (cag_surface_parallelogram_view(s, &origin, &x, &y))
    return cag_surface_parallelogram(cag_add(origin, y), x, cag_scaled(y, -1), out, err);
  const CagRegion *region;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame)) {
    // A reflected region in a reflected frame: the same part of the plane with the opposite normal.
    CagTransform mirror = cag_transform_identity();
    mirror.m[1][1] = -1;
    mirror.m[1][3] = s->v0 + s->v1;
    CagTransform turned = cag_transform_multiply(&frame, &mirror);
    CagRegion *image;
    CagStatus status = cag_region_transform(region, &mirror, &image, err);
    if (status) return status;
    status = cag_surface_planar(image, &turned, out, err);
    cag_region_release(image);
    return status;
  }
  const CagCurve *profile;
  CagVec3 axis, through;
  double from, to;
  // Reverse the rotation of the profile, if that preserves the ends of the angle range.
  if (cag_surface_revolution_view(s, &profile, &axis, &through, &from, &to) &&
      (from == -to || (from == 0 && to == 2 * M_PI)))
    return cag_surface_revolve(profile, cag_scaled(axis, -1), through, from, to, out, err);
  CagTransform identity = cag_transform_identity();
  return cag_surface_placed(s, &identity, true, out, err);
}
