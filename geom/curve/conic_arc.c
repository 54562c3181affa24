// Arcs of parabolas and hyperbolas, in the parameters of the classical forms.
//
// Both are stored as center + f(s) x + g(s) y with any two vectors x, y, so every affine image is
// of the same form; s is phase + rate * t, and a negative rate reverses the curve. For boxes and
// the rational form, the angular forms are converted to the parameter of the other form: tan s for
// a parabola, asinh(tan s) for a branch of a hyperbola. The exact rational form is quadratic.

#include <stdio.h>

#include "base/memory.h"
#include "geom/curve/conic.h"
#include "geom/curve/family.h"

typedef struct Open {
  CagCurve base;
  CagOpenConic d;
} Open;

static const CagCurveKind parabola_kind, hyperbola_kind;

// Angles closer than this to a pole of tan and sec are rejected as the pole: there a coordinate
// would exceed 1e9 times the size of the conic.
#define POLE 1e-9
// A hyperbola's rational pieces span at most this much of the hyperbolic parameter, which keeps
// their weights below 1.6.
#define PIECE 2.0
// Largest parameter at which points are still distinct; cosh is 1e100 there.
#define FARTHEST 230.0

static bool is_open(const CagCurve *c) {
  return c->kind == &parabola_kind || c->kind == &hyperbola_kind;
}
static bool is_angular(CagConicForm form) {
  return form == CAG_FORM_TANGENT || form == CAG_FORM_SECANT;
}
static bool is_parabola(CagConicForm form) {
  return form == CAG_FORM_QUADRATIC || form == CAG_FORM_TANGENT;
}

static CagStatus make(const CagOpenConic *d, double start, double end, int dimension,
                      CagCurve **out, CagError *err) {
  CagCurve *base;
  CagStatus status =
      cag_curve_block(sizeof(Open), is_parabola(d->form) ? &parabola_kind : &hyperbola_kind,
                      dimension, start, end, &base, err);
  if (status) return status;
  Open *c = (Open *)base;
  c->d = *d;
  if (dimension == 2) c->d.center.z = c->d.x.z = c->d.y.z = 0;
  base->angular = is_angular(d->form) && fabs(d->rate) == 1;
  *out = base;
  return CAG_OK;
}

// --- Construction ---

static CagStatus check_semi(double r, const char *name, CagError *err) {
  char text[32];
  CagStatus status = cag_curve_check_number(r, name, err);
  if (status || r > 0) return status;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_not_positive, name, -1,
                  "`%s` must be positive, found %s", name, cag_number_text(r, text));
}

// The index of the interval between two poles that contains the angle.
static double strip(double angle) { return floor(angle / M_PI + 0.5); }
static double off_pole(double angle) { return angle - (strip(angle) - 0.5) * M_PI; }

static CagStatus check_range(CagConicForm form, double start, double end, CagError *err) {
  char a[32], b[32];
  CagStatus status = cag_curve_check_number(start, "range", err);
  if (!status) status = cag_curve_check_number(end, "range", err);
  if (status) return status;
  const char *unit = is_angular(form) ? "deg" : "";
  const double shown = is_angular(form) ? 180 / M_PI : 1;
  if (!(start < end))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "range", -1,
        "the range %.12g%s..%.12g%s has no length; its start must be less than its end (to reverse the curve, use reverse(C))",
        start * shown, unit, end * shown, unit);
  if (is_angular(form) &&
      (strip(start) != strip(end) || off_pole(start) < POLE || M_PI - off_pole(end) < POLE))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_conic_domain, "range", -1,
        "the curve goes to infinity at odd multiples of 90deg: the range %.12gdeg..%.12gdeg must lie between two of them",
        start * shown, end * shown);
  if (form == CAG_FORM_HYPERBOLIC && fmax(fabs(start), fabs(end)) > FARTHEST)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_conic_domain, "range", -1,
                    "hyperbolic parameters must lie in -%g..%g, found %s..%s", FARTHEST, FARTHEST,
                    cag_number_text(start, a), cag_number_text(end, b));
  return CAG_OK;
}

static CagStatus read_frame(const CagTransform *frame, CagOpenConic *d, CagError *err) {
  if (!cag_transform_is_affine(frame))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_affine, "frame", -1,
                    "the conic's frame must be affine, found a projection");
  CagVec3 columns[4];
  for (int j = 0; j < 4; j++) {
    columns[j] =
        cag_scaled(cag_vec3(frame->m[0][j], frame->m[1][j], frame->m[2][j]), 1 / frame->m[3][3]);
    if (!isfinite(cag_norm(columns[j])))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "frame", -1,
                      "the conic's frame has an entry that is not a finite number");
  }
  d->x = columns[0];
  d->y = columns[1];
  d->center = columns[3];
  d->phase = 0;
  d->rate = 1;
  return CAG_OK;
}

CagStatus cag_curve_parabola(double a, CagConicForm form, double start, double end,
                             const CagTransform *frame, CagCurve **out, CagError *err) {
  CagOpenConic d = {.form = form};
  CagStatus status = check_semi(a, "a", err);
  if (!status) status = check_range(form, start, end, err);
  if (!status) status = read_frame(frame, &d, err);
  if (status) return status;
  const bool quadratic = form == CAG_FORM_QUADRATIC;
  d.x = cag_scaled(d.x, quadratic ? a : 1);
  d.y = cag_scaled(d.y, quadratic ? 2 * a : 2 * sqrt(a));
  return make(&d, start, end, frame->planar ? 2 : 3, out, err);
}

CagStatus cag_curve_hyperbola(double a, double b, CagConicForm form, double start, double end,
                              const CagTransform *frame, CagCurve **out, CagError *err) {
  CagOpenConic d = {.form = form};
  CagStatus status = check_semi(a, "a", err);
  if (!status) status = check_semi(b, "b", err);
  if (!status) status = check_range(form, start, end, err);
  if (!status) status = read_frame(frame, &d, err);
  if (status) return status;
  d.x = cag_scaled(d.x, a);
  d.y = cag_scaled(d.y, b);
  return make(&d, start, end, frame->planar ? 2 : 3, out, err);
}

bool cag_curve_open_conic(const CagCurve *c, CagOpenConic *out) {
  if (!is_open(c)) return false;
  *out = ((const Open *)c)->d;
  return true;
}

// --- Evaluation ---

// Derivatives 0..order of tan and sec, from u' = 1 + u^2 and s' = s u by Taylor series.
static void tangent_secant(double angle, int order, double *u, double *s) {
  double sine, cosine, factorial = 1;
  cag_sincos(angle, &sine, &cosine);
  u[0] = sine / cosine;
  s[0] = 1 / cosine;
  for (int k = 0; k < order; k++) {
    double uu = k == 0 ? 1 : 0, su = 0;
    for (int i = 0; i <= k; i++) {
      uu += u[i] * u[k - i];
      su += s[i] * u[k - i];
    }
    u[k + 1] = uu / (k + 1);
    s[k + 1] = su / (k + 1);
  }
  for (int k = 2; k <= order; k++) {
    factorial *= k;
    u[k] *= factorial;
    s[k] *= factorial;
  }
}

static void derivatives(const Open *c, double t, int order, CagVec3 *out) {
  const CagOpenConic *d = &c->d;
  const double p = d->phase + d->rate * t;
  double f[CAG_MAX_DERIVATIVE + 2] = {0}, g[CAG_MAX_DERIVATIVE + 2] = {0};
  switch (d->form) {
  case CAG_FORM_QUADRATIC:
    f[0] = p * p;
    f[1] = 2 * p;
    f[2] = 2;
    g[0] = p;
    g[1] = 1;
    break;
  case CAG_FORM_TANGENT:
    // The derivatives of tan^2 are those of tan' = 1 + tan^2.
    tangent_secant(p, order + 1, g, f);
    f[0] = g[0] * g[0];
    for (int k = 1; k <= order; k++) f[k] = g[k + 1];
    break;
  case CAG_FORM_HYPERBOLIC:
    for (int k = 0; k <= order; k++) {
      f[k] = k % 2 ? sinh(p) : cosh(p);
      g[k] = k % 2 ? cosh(p) : sinh(p);
    }
    break;
  case CAG_FORM_SECANT: tangent_secant(p, order, g, f); break;
  }
  double scale = 1;
  for (int k = 0; k <= order; k++, scale *= d->rate) {
    CagVec3 v = cag_madd(cag_scaled(d->x, scale * f[k]), scale * g[k], d->y);
    out[k] = k == 0 ? cag_add(d->center, v) : v;
  }
}

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  (void)side;
  (void)err;
  derivatives((const Open *)curve, t, order, out);
  return CAG_OK;
}

static CagStatus eval_many(const CagCurve *curve, const double *t, size_t n, int order,
                           CagVec3 *out, CagError *err) {
  (void)err;
  for (size_t i = 0; i < n; i++)
    derivatives((const Open *)curve, t[i], order, out + i * (size_t)(order + 1));
  return CAG_OK;
}

// --- The canonical parameter: quadratic for a parabola, hyperbolic for a hyperbola ---

// *branch is -1 on the left branch of a secant form, where x is negated.
static double canonical(const Open *c, double t, double *branch) {
  const double p = c->d.phase + c->d.rate * t;
  double sine, cosine;
  *branch = 1;
  if (!is_angular(c->d.form)) return p;
  cag_sincos(p, &sine, &cosine);
  if (c->d.form == CAG_FORM_TANGENT) return sine / cosine;
  if (cosine < 0) *branch = -1;
  return asinh(sine / cosine);
}

static CagVec3 canonical_point(const Open *c, double u, double branch) {
  double f = is_parabola(c->d.form) ? u * u : branch * cosh(u);
  double g = is_parabola(c->d.form) ? u : sinh(u);
  return cag_add(c->d.center, cag_madd(cag_scaled(c->d.x, f), g, c->d.y));
}

static CagStatus parabola_nurbs(const Open *c, double from, double to, CagCurve **out,
                                CagError *err) {
  // The middle control point is the polar form at (from, to).
  CagVec3 points[3] = {
      canonical_point(c, from, 1),
      cag_add(c->d.center, cag_madd(cag_scaled(c->d.x, from * to), (from + to) / 2, c->d.y)),
      canonical_point(c, to, 1)};
  return cag_curve_bezier(points, NULL, 3, c->base.dimension, out, err);
}

// Pieces with knots 0, 0, 0, 1, 1, 2, 2, ..: the circle's construction with cosh for cos.
static CagStatus hyperbola_nurbs(const Open *c, double from, double to, double branch,
                                 CagCurve **out, CagError *err) {
  const size_t m = (size_t)fmax(1, ceil(fabs(to - from) / PIECE - POLE)), n = 2 * m + 1;
  CagVec3 *points = cag_malloc(sizeof *points * n);
  double *weights = cag_malloc(sizeof *weights * n), *knots = cag_malloc(sizeof *knots * (n + 3));
  CagStatus status = points && weights && knots ? CAG_OK : cag_fail_memory(err);
  const double half = cosh((to - from) / (double)(2 * m));
  for (size_t i = 0; !status && i < n; i++) {
    double u = from + (to - from) * ((double)i / (double)(2 * m));
    weights[i] = i % 2 ? half : 1;
    CagVec3 p = canonical_point(c, u, branch);
    points[i] = i % 2 ? cag_madd(c->d.center, 1 / half, cag_sub(p, c->d.center)) : p;
  }
  for (size_t i = 0; !status && i < n + 3; i++) knots[i] = i < 3 ? 0 : (double)((i - 1) / 2);
  if (!status) {
    knots[n + 2] = (double)m;
    status = cag_curve_nurbs(points, weights, n, 2, knots, c->base.dimension, out, err);
  }
  cag_free(points);
  cag_free(weights);
  cag_free(knots);
  return status;
}

static CagStatus to_nurbs(const CagCurve *curve, CagCurve **out, CagError *err) {
  const Open *c = (const Open *)curve;
  double branch;
  const double from = canonical(c, curve->start, &branch), to = canonical(c, curve->end, &branch);
  return is_parabola(c->d.form) ? parabola_nurbs(c, from, to, out, err)
                                : hyperbola_nurbs(c, from, to, branch, out, err);
}

// --- Derived curves ---

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  if (!cag_transform_is_affine(t)) return cag_curve_transform_nurbs(curve, t, out, err);
  CagOpenConic d = ((const Open *)curve)->d;
  d.center = cag_transform_point(t, d.center);
  d.x = cag_scaled(cag_transform_vector(t, d.x), 1 / t->m[3][3]);
  d.y = cag_scaled(cag_transform_vector(t, d.y), 1 / t->m[3][3]);
  return make(&d, curve->start, curve->end, cag_curve_image_dimension(curve, t), out, err);
}

static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  CagOpenConic d = ((const Open *)curve)->d;
  d.phase += d.rate * cag_part_origin(p);
  d.rate *= cag_part_rate(p);
  return make(&d, p->start, p->end, curve->dimension, out, err);
}

// --- Bounds ---

static double coordinate(CagVec3 v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

// The canonical parameter at which coordinate i of the curve has an extremum; false: none.
static bool turning(const Open *c, int i, double branch, double *u) {
  const double x = branch * coordinate(c->d.x, i), y = coordinate(c->d.y, i);
  if (is_parabola(c->d.form)) {
    *u = -y / (2 * x);
    return x != 0;
  }
  *u = atanh(-y / x);
  return fabs(y) < fabs(x);
}

// Exact: the ends, and each coordinate's extremum if it is inside.
static CagBounds hull(const CagCurve *curve, double a, double b) {
  const Open *c = (const Open *)curve;
  double branch, u;
  const double from = canonical(c, a, &branch), to = canonical(c, b, &branch);
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagVec3 p;
  derivatives(c, a, 0, &p);
  cag_bounds_add(&box, p);
  derivatives(c, b, 0, &p);
  cag_bounds_add(&box, p);
  for (int i = 0; i < curve->dimension; i++)
    if (turning(c, i, branch, &u) && u > fmin(from, to) && u < fmax(from, to))
      cag_bounds_add(&box, canonical_point(c, u, branch));
  return box;
}

static size_t breaks(const CagCurve *curve, double *out, size_t capacity) {
  (void)curve;
  (void)out;
  (void)capacity;
  return 0;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const CagOpenConic *d = &((const Open *)curve)->d;
  char a[32], b[32];
  double x = cag_norm(d->x), y = cag_norm(d->y), across = cag_norm(cag_cross(d->x, d->y));
  if (is_parabola(d->form))
    snprintf(buffer, size, "focal length %s",
             cag_number_text(across * across / (4 * x * x * x), a));
  else snprintf(buffer, size, "semi-axes %s and %s", cag_number_text(x, a), cag_number_text(y, b));
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const Open *c = (const Open *)curve;
  cag_digest_word(d, (uint64_t)c->d.form);
  cag_vec3s_digest(&c->d.center, 1, d);
  cag_vec3s_digest(&c->d.x, 1, d);
  cag_vec3s_digest(&c->d.y, 1, d);
  cag_digest_number(d, c->d.phase);
  cag_digest_number(d, c->d.rate);
}

#define OPEN_KIND(NAME)                                                                            \
  { NAME, eval, eval_many, to_nurbs, transform, part, hull, breaks, describe, NULL, digest }
static const CagCurveKind parabola_kind = OPEN_KIND("parabola");
static const CagCurveKind hyperbola_kind = OPEN_KIND("hyperbola");
