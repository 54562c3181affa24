// Coons patches keep their curves; Hermite patches are converted to B-spline surfaces.

#include "geom/surface/patches.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/bernstein.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"
#include "geom/surface/net.h"

// --- Linear Coons surface ---

typedef struct Coons {
  CagSurface base;
  CagCurve *side[4]; // u0, u1, v0, v1
  CagVec3 corner[2][2];
} Coons;

static const CagSurfaceKind coons_kind;

#define MAX_TRIANGLE 25

// Corners differ if they are farther apart than this fraction of the patch's size.
#define CORNER_GAP CAG_COINCIDENT

static CagStatus eval_fraction(const CagCurve *c, double v, int n, CagSide side, CagVec3 *out,
                               CagError *err) {
  double t = v >= 1 ? c->end : c->start + v * (c->end - c->start), factor = 1;
  CagStatus status = cag_curve_eval(c, t, n, side, out, err);
  for (int k = 1; !status && k <= n; k++) {
    factor *= c->end - c->start;
    out[k] = cag_scaled(out[k], factor);
  }
  return status;
}

static CagStatus coons_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                            CagVec3 *out, CagError *err) {
  const Coons *c = (const Coons *)s;
  CagVec3 d[4][CAG_MAX_PARTIAL + 1];
  for (int k = 0; k < 4; k++) {
    CagStatus status = eval_fraction(c->side[k], k < 2 ? v : u, n, k < 2 ? sv : su, d[k], err);
    if (status) return status;
  }
  // Blending functions and their derivatives: 1 - t, t, then -1, 1, then 0.
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      double a[2] = {i == 0 ? 1 - u : i == 1 ? -1 : 0, i == 0 ? u : i == 1 ? 1 : 0};
      double b[2] = {j == 0 ? 1 - v : j == 1 ? -1 : 0, j == 0 ? v : j == 1 ? 1 : 0};
      CagVec3 p = {0, 0, 0};
      for (int k = 0; k < 2; k++) {
        p = cag_madd(p, a[k], d[k][j]);
        p = cag_madd(p, b[k], d[2 + k][i]);
        for (int m = 0; m < 2; m++) p = cag_madd(p, -a[k] * b[m], c->corner[k][m]);
      }
      out[cag_partial(n, i, j)] = p;
    }
  return CAG_OK;
}

static bool is_polynomial(const CagNet *net) {
  for (size_t i = 0; i < net->count; i++)
    if (fabs(net->data[4 * i + 3] - 1) > CAG_SURFACE_SAME) return false;
  return true;
}

// The line between two points over the knots of another net; the Greville abscissas reproduce it.
static void ruling(const CagNet *like, size_t i, double *out) {
  double sum = 0;
  for (int k = 1; k <= like->degree; k++) sum += like->knots[i + (size_t)k];
  *out = sum / like->degree;
}

// The sum of two ruled surfaces minus the bilinear one, all over the same knots.
static CagStatus coons_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Coons *c = (const Coons *)s;
  CagNet net[4] = {{0}, {0}, {0}, {0}};
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 4; k++) status = cag_net_of_curve(c->side[k], &net[k], err);
  for (int k = 0; !status && k < 4; k++)
    if (!is_polynomial(&net[k]))
      status = cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "surface", -1,
                        "a Coons surface with rational edges (%s) has no exact form of low degree; "
                        "approximate it to a tolerance",
                        c->side[k]->kind->name);
  if (!status) status = cag_nets_unify(&net[0], 2, err);
  if (!status) status = cag_nets_unify(&net[2], 2, err);
  const CagNet *nu = &net[2], *nv = &net[0];
  double *h = status ? NULL : cag_malloc(nu->count * nv->count * 4 * sizeof *h);
  if (!status && !h) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < nu->count; i++)
    for (size_t j = 0; j < nv->count; j++) {
      double u, v, *to = h + 4 * (i * nv->count + j);
      ruling(nu, i, &u);
      ruling(nv, j, &v);
      double a[2] = {1 - u, u}, b[2] = {1 - v, v};
      for (int x = 0; x < 3; x++) {
        to[x] = 0;
        for (size_t k = 0; k < 2; k++) {
          to[x] +=
              a[k] * net[k].data[4 * j + (size_t)x] + b[k] * net[2 + k].data[4 * i + (size_t)x];
          for (size_t m = 0; m < 2; m++) {
            const double corner[3] = {c->corner[k][m].x, c->corner[k][m].y, c->corner[k][m].z};
            to[x] -= a[k] * b[m] * corner[x];
          }
        }
      }
      to[3] = 1;
    }
  if (!status)
    status = cag_surface_from_homogeneous(h, nu->count, nv->count, nu->degree, nv->degree,
                                          nu->knots, nv->knots, out, err);
  cag_free(h);
  for (int k = 0; k < 4; k++) cag_net_free(&net[k]);
  return status;
}

static CagStatus coons_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                 CagError *err) {
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(s, t, out, err);
  const Coons *c = (const Coons *)s;
  CagCurve *moved[4] = {NULL, NULL, NULL, NULL};
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 4; k++)
    status = cag_curve_transform(c->side[k], t, &moved[k], err);
  if (!status) status = cag_surface_coons(moved[0], moved[1], moved[2], moved[3], out, err);
  for (int k = 0; k < 4; k++) cag_curve_release(moved[k]);
  return status;
}

static size_t coons_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Coons *c = (const Coons *)s;
  CagCurve *const *pair = direction == 0 ? &c->side[2] : &c->side[0];
  size_t counts[2], n = 0;
  for (int k = 0; k < 2; k++)
    counts[k] = pair[k]->kind->breaks ? pair[k]->kind->breaks(pair[k], NULL, 0) : 0;
  double *all = cag_malloc((counts[0] + counts[1] + 1) * sizeof *all);
  if (!all) return cag_note_memory(), 0;
  for (int k = 0; k < 2; k++) {
    const CagCurve *e = pair[k];
    if (counts[k] > 0) e->kind->breaks(e, all + n, counts[k]);
    for (size_t i = n; i < n + counts[k]; i++) all[i] = (all[i] - e->start) / (e->end - e->start);
    n += counts[k];
  }
  n = cag_surface_tidy_breaks(all, n, 0, 1);
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = all[i];
  cag_free(all);
  return n;
}

static void coons_describe(const CagSurface *s, char *buffer, size_t size) {
  const Coons *c = (const Coons *)s;
  snprintf(buffer, size, "between %s %s, %s %s, %s %s and %s %s",
           cag_article(c->side[0]->kind->name), c->side[0]->kind->name,
           cag_article(c->side[1]->kind->name), c->side[1]->kind->name,
           cag_article(c->side[2]->kind->name), c->side[2]->kind->name,
           cag_article(c->side[3]->kind->name), c->side[3]->kind->name);
}

static void coons_destroy(CagSurface *s) {
  for (int k = 0; k < 4; k++) cag_curve_release(((Coons *)s)->side[k]);
}

static void coons_digest(const CagSurface *surface, CagDigest *d) {
  const Coons *s = (const Coons *)surface;
  for (int i = 0; i < 4; i++) cag_curve_digest(s->side[i], d);
}

static const CagSurfaceKind coons_kind = {
    .name = "coons",
    .eval = coons_eval,
    .to_nurbs = coons_to_nurbs,
    .transform = coons_transform,
    .breaks = coons_breaks,
    .describe = coons_describe,
    .destroy = coons_destroy,
    .digest = coons_digest,
};

static const char *const SIDES[] = {"u0", "u1", "v0", "v1"};

// end[k][e]: start and end of side k. The largest gap with the sides in `turned` reversed.
static double largest_gap(const CagVec3 end[4][2], unsigned turned, int *i, int *j) {
  double worst = -1;
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++) {
      int along_v = (turned >> a & 1) ? 1 - b : b, along_u = (turned >> (2 + b) & 1) ? 1 - a : a;
      double gap = cag_norm(cag_sub(end[a][along_v], end[2 + b][along_u]));
      if (gap > worst) worst = gap, *i = a, *j = b;
    }
  return worst;
}

static CagStatus check_corners(const CagVec3 end[4][2], double size, CagError *err) {
  int i, j, ti, tj;
  double gap = largest_gap(end, 0, &i, &j);
  if (gap <= CORNER_GAP * size) return CAG_OK;
  char text[32], help[100] = "move one of the two ends onto the other";
  for (int pass = 0; pass < 2; pass++)
    for (unsigned turned = 1; turned < 16; turned++) {
      // Prefer the advice to reverse a single edge.
      bool single = (turned & (turned - 1)) == 0;
      if (single != (pass == 0)) continue;
      if (largest_gap(end, turned, &ti, &tj) > CORNER_GAP * size) continue;
      int n = snprintf(help, sizeof help, "reversing");
      for (int k = 0; k < 4; k++)
        if (turned >> k & 1)
          n +=
              snprintf(help + n, sizeof help - (size_t)n, "%s `%s`", n > 9 ? " and" : "", SIDES[k]);
      snprintf(help + n, sizeof help - (size_t)n, " closes the patch");
      pass = 2;
      break;
    }
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_coons_corner_mismatch, SIDES[2 + j], -1,
                  "`%s` and `%s` must meet in the corner u = %d, v = %d, but they are %s apart; %s",
                  SIDES[i], SIDES[2 + j], i, j, cag_number_text(gap, text), help);
}

CagStatus cag_surface_coons(const CagCurve *u0, const CagCurve *u1, const CagCurve *v0,
                            const CagCurve *v1, CagSurface **out, CagError *err) {
  const CagCurve *given[4] = {u0, u1, v0, v1};
  CagSurface *s;
  CagStatus status = cag_surface_block(sizeof(Coons), &coons_kind, 0, 1, 0, 1, &s, err);
  if (status) return status;
  Coons *c = (Coons *)s;
  CagVec3 end[4][2];
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int k = 0; !status && k < 4; k++) {
    status = cag_surface_space_curve(given[k], &c->side[k], err);
    if (!status) status = cag_curve_point(given[k], given[k]->start, &end[k][0], err);
    if (!status) status = cag_curve_point(given[k], given[k]->end, &end[k][1], err);
    CagBounds own;
    if (!status) status = cag_curve_bounds(given[k], &own, err);
    if (status) break;
    cag_bounds_add(&box, own.min);
    cag_bounds_add(&box, own.max);
  }
  if (!status) status = check_corners(end, cag_norm(cag_sub(box.max, box.min)), err);
  if (status) {
    cag_surface_release(s);
    return status;
  }
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) c->corner[i][j] = end[i][j];
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}

// --- Hermite patches ---

void cag_hermite_adini(CagHermiteCorners *c) {
  CagVec3 bend = cag_sub(cag_add(c->p[0][0], c->p[1][1]), cag_add(c->p[0][1], c->p[1][0]));
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      c->puv[i][j] = cag_sub(
          cag_add(cag_sub(c->pu[i][1], c->pu[i][0]), cag_sub(c->pv[1][j], c->pv[0][j])), bend);
}

static void put(double *net, size_t row, size_t i, size_t j, CagVec3 p) {
  double *h = net + 4 * (i * row + j);
  h[0] = p.x;
  h[1] = p.y;
  h[2] = p.z;
  h[3] = 1;
}

// The 16 Bezier points of a patch, from its corner points, derivatives, and twists, at (i0, j0) of
// a net with rows of `row`.
static void put_patch(double *net, size_t row, size_t i0, size_t j0, const CagHermiteCorners *c,
                      double du, double dv) {
  for (size_t i = 0; i < 2; i++)
    for (size_t j = 0; j < 2; j++) {
      double su = (i == 0 ? du : -du) / 3, sv = (j == 0 ? dv : -dv) / 3;
      CagVec3 p = c->p[i][j], u = cag_scaled(c->pu[i][j], su), v = cag_scaled(c->pv[i][j], sv);
      size_t i1 = i0 + 3 * i, j1 = j0 + 3 * j, i2 = i0 + 1 + i, j2 = j0 + 1 + j;
      put(net, row, i1, j1, p);
      put(net, row, i2, j1, cag_add(p, u));
      put(net, row, i1, j2, cag_add(p, v));
      put(net, row, i2, j2, cag_madd(cag_add(cag_add(p, u), v), su * sv, c->puv[i][j]));
    }
}

CagStatus cag_surface_hermite(const CagHermiteCorners *c, double u0, double u1, double v0,
                              double v1, CagSurface **out, CagError *err) {
  if (!(u0 < u1) || !(v0 < v1))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, u0 < u1 ? "v" : "u", -1,
                    "the range of a patch must end after its start");
  double net[64], ku[8], kv[8];
  put_patch(net, 4, 0, 0, c, u1 - u0, v1 - v0);
  for (int i = 0; i < 8; i++) ku[i] = i < 4 ? u0 : u1, kv[i] = i < 4 ? v0 : v1;
  return cag_surface_from_homogeneous(net, 4, 4, 3, 3, ku, kv, out, err);
}

// --- Composite surface ---

// Tangents of the C2 spline through values[k * stride], k = 0..n - 1, at tangents[k * stride] where
// both ends are given.
static void spline_line(const CagVec3 *values, CagVec3 *tangents, size_t n, size_t stride,
                        const double *steps, double *work) {
  for (size_t k = 1; k + 1 < n; k++) {
    double a = 1 / steps[k - 1], b = 1 / steps[k];
    CagVec3 before = cag_sub(values[k * stride], values[(k - 1) * stride]);
    CagVec3 after = cag_sub(values[(k + 1) * stride], values[k * stride]);
    CagVec3 right = cag_add(cag_scaled(before, 3 * a * a), cag_scaled(after, 3 * b * b));
    // Forward elimination; work holds the superdiagonal.
    double left = k == 1 ? 0 : work[k - 1], pivot = 2 * (a + b) - a * left;
    right = cag_madd(right, -a, tangents[(k - 1) * stride]);
    work[k] = b / pivot;
    tangents[k * stride] = cag_scaled(right, 1 / pivot);
  }
  for (size_t k = n - 1; k-- > 1;)
    tangents[k * stride] = cag_madd(tangents[k * stride], -work[k], tangents[(k + 1) * stride]);
}

static CagStatus check_steps(const double *steps, size_t n, const char *which, CagError *err) {
  for (size_t i = 0; steps && i < n; i++) {
    char text[32];
    if (!(steps[i] > 0) || !isfinite(steps[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, "lengths", (long)i,
                      "`lengths` must be positive: in %s, [%zu] is %s", which, i,
                      cag_number_text(steps[i], text));
  }
  return CAG_OK;
}

typedef struct Composite {
  const CagHermiteGrid *g;
  CagVec3 *q, *r, *t; // tangents by u, by v, twists
  double *hu, *hv, *work;
} Composite;

static void solve_composite(Composite *c) {
  const CagHermiteGrid *g = c->g;
  size_t m = g->nu - 1, n = g->nv - 1, row = g->nv;
  for (size_t j = 0; j <= n; j++) {
    c->q[j] = g->u_start[j];
    c->q[m * row + j] = g->u_end[j];
    spline_line(g->points + j, c->q + j, m + 1, row, c->hu, c->work);
  }
  for (size_t i = 0; i <= m; i++) {
    c->r[i * row] = g->v_start[i];
    c->r[i * row + n] = g->v_end[i];
    spline_line(g->points + i * row, c->r + i * row, n + 1, 1, c->hv, c->work);
  }
  for (size_t i = 0; i < 2; i++) {
    CagVec3 *line = c->t + i * m * row;
    line[0] = g->twist[i][0];
    line[n] = g->twist[i][1];
    spline_line(c->q + i * m * row, line, n + 1, 1, c->hv, c->work);
  }
  for (size_t j = 0; j <= n; j++) spline_line(c->r + j, c->t + j, m + 1, row, c->hu, c->work);
}

static void bezier_knots(const double *steps, size_t pieces, double *knots) {
  double at = 0;
  size_t k = 0;
  knots[k++] = 0;
  for (size_t i = 0; i <= pieces; i++) {
    for (int m = 0; m < 3; m++) knots[k++] = at;
    if (i < pieces) at += steps[i];
  }
  knots[k] = at;
}

// Bezier pieces; then the knots that are redundant by C2 are removed in both directions.
static CagStatus composite_surface(const Composite *c, CagSurface **out, CagError *err) {
  const CagHermiteGrid *g = c->g;
  size_t m = g->nu - 1, n = g->nv - 1, row = g->nv, columns = 3 * n + 1;
  CagNet net, across;
  CagStatus status = cag_net_new(3, 3 * m + 1, 4 * columns, &net, err);
  if (status) return status;
  status = cag_net_new(3, columns, 0, &across, err);
  if (status) {
    cag_net_free(&net);
    return status;
  }
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < n; j++) {
      CagHermiteCorners k;
      for (size_t a = 0; a < 2; a++)
        for (size_t b = 0; b < 2; b++) {
          size_t at = (i + a) * row + j + b;
          k.p[a][b] = g->points[at];
          k.pu[a][b] = c->q[at];
          k.pv[a][b] = c->r[at];
          k.puv[a][b] = c->t[at];
        }
      put_patch(net.data, columns, 3 * i, 3 * j, &k, c->hu[i], c->hv[j]);
    }
  bezier_knots(c->hu, m, net.knots);
  bezier_knots(c->hv, n, across.knots);
  CagSurface *pieces = NULL;
  for (int direction = 0; !status && direction < 2; direction++) {
    if (direction == 1) {
      cag_net_free(&net);
      cag_net_free(&across);
      status = cag_net_of_surface(pieces, 1, &net, &across, err);
      cag_surface_release(pieces);
      if (status) return status;
    }
    double at = 0;
    const double *steps = direction == 0 ? c->hu : c->hv;
    for (size_t i = 0; !status && i + 1 < (direction == 0 ? m : n); i++) {
      at += steps[i];
      status = cag_net_drop(&net, at, err);
      if (!status) status = cag_net_drop(&net, at, err);
    }
    if (!status)
      status = cag_net_to_surface(&net, direction, &across, direction == 0 ? &pieces : out, err);
  }
  cag_net_free(&net);
  cag_net_free(&across);
  return status;
}

CagStatus cag_surface_hermite_grid(const CagHermiteGrid *g, CagSurface **out, CagError *err) {
  if (g->nu < 2 || g->nv < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "grid", -1,
                    "`grid` must have at least 2 rows and columns, found %zu by %zu", g->nu, g->nv);
  CagStatus status = check_steps(g->steps_u, g->nu - 1, "u", err);
  if (!status) status = check_steps(g->steps_v, g->nv - 1, "v", err);
  if (status) return status;
  size_t count = g->nu * g->nv;
  Composite c = {g, NULL, NULL, NULL, NULL, NULL, NULL};
  CagVec3 *vectors = cag_calloc(3 * count, sizeof *vectors);
  double *numbers = cag_malloc(3 * (g->nu + g->nv) * sizeof *numbers);
  status = vectors && numbers ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    c.q = vectors;
    c.r = vectors + count;
    c.t = vectors + 2 * count;
    c.hu = numbers;
    c.hv = numbers + g->nu;
    c.work = numbers + g->nu + g->nv;
    for (size_t i = 0; i + 1 < g->nu; i++) c.hu[i] = g->steps_u ? g->steps_u[i] : 1;
    for (size_t j = 0; j + 1 < g->nv; j++) c.hv[j] = g->steps_v ? g->steps_v[j] : 1;
    solve_composite(&c);
    status = composite_surface(&c, out, err);
  }
  cag_free(vectors);
  cag_free(numbers);
  return status;
}

// --- Triangles ---

// Row m of the tensor product net is the Bezier curve of degree m of the points with i = n - m,
// elevated to degree n.
CagStatus cag_surface_bezier_triangle(const CagVec3 *points, int n, CagSurface **out,
                                      CagError *err) {
  if (n < 1 || n > MAX_TRIANGLE)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "net", -1,
                    "`net` must have 2 to %d rows, found %d", MAX_TRIANGLE + 1, n + 1);
  size_t side = (size_t)n + 1;
  double *h = cag_malloc((side + 2) * side * 4 * sizeof *h),
         *knots = cag_malloc(2 * side * sizeof *knots);
  CagStatus status = h && knots ? CAG_OK : cag_fail_memory(err);
  size_t at = 0;
  double *spare = h ? h + side * side * 4 : NULL;
  for (int m = 0; !status && m <= n; m++) {
    double *row = h + (size_t)m * side * 4;
    for (int k = 0; k <= m; k++) put(row, side, 0, (size_t)k, points[at++]);
    for (int degree = m; degree < n; degree++) {
      cag_bezier_elevate(row, degree, spare);
      memcpy(row, spare, (size_t)(degree + 2) * 4 * sizeof *row);
    }
  }
  for (size_t i = 0; !status && i < 2 * side; i++) knots[i] = i < side ? 0 : 1;
  if (!status) status = cag_surface_from_homogeneous(h, side, side, n, n, knots, knots, out, err);
  cag_free(h);
  cag_free(knots);
  return status;
}
