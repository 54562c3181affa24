// Operations on all kinds of curves through CagCurveKind: parameter checks, reference counts, and
// fallbacks for optional functions.

#include "geom/curve/curve.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

// A parameter this many ulps outside the domain is snapped to the end: it is a rounding error.
#define SNAP_ULPS 16

CagStatus cag_curve_block(size_t size, const CagCurveKind *kind, int dimension, double start,
                          double end, CagCurve **out, CagError *err) {
  CagCurve *c = cag_calloc(1, size);
  if (!c) return cag_fail_memory(err);
  c->kind = kind;
  c->references = 1;
  c->dimension = dimension;
  c->start = start;
  c->end = end;
  *out = c;
  return CAG_OK;
}

CagCurve *cag_curve_retain(const CagCurve *c) {
  CagCurve *mine = (CagCurve *)c;
  if (mine) mine->references++;
  return mine;
}

void cag_curve_release(CagCurve *c) {
  if (!c || --c->references > 0) return;
  if (c->kind->destroy) c->kind->destroy(c);
  cag_free(c);
}

void cag_curve_digest(const CagCurve *c, CagDigest *d) {
  cag_digest_text(d, c->kind->name);
  cag_digest_word(d, (uint64_t)c->dimension << 1 | c->angular);
  cag_digest_number(d, c->start);
  cag_digest_number(d, c->end);
  if (c->kind->digest) c->kind->digest(c, d);
  else d->unknown = true;
}

bool cag_check_curve(const CagCurve *c) {
  return c && c->kind && c->kind->eval && c->references > 0 &&
         (c->dimension == 2 || c->dimension == 3) && isfinite(c->start) && isfinite(c->end) &&
         c->start <= c->end;
}

// --- Checks ---

// Points between checks of the stop flag.
#define BLOCK ((size_t)4096)

// Lengths up to this size can be squared and multiplied by each other without overflow.
#define LARGEST 1e100

CagStatus cag_curve_check_points(const CagVec3 *points, size_t n, const char *name, CagError *err) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(points[i].x) || !isfinite(points[i].y) || !isfinite(points[i].z))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, name, (long)i,
                      "%s[%zu] has a coordinate that is not a finite number", name, i);
    else if (cag_curve_size(points + i, 1) > LARGEST)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_out_of_range, name, (long)i,
                      "%s[%zu] has a coordinate beyond the limit of %g", name, i, LARGEST);
    else if (i % BLOCK == BLOCK - 1 && cag_stop_check(err)) return err->status;
  return CAG_OK;
}

CagStatus cag_curve_check_number(double x, const char *name, CagError *err) {
  if (fabs(x) <= LARGEST) return CAG_OK;
  if (isfinite(x))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_out_of_range, name, -1,
                    "`%s` is beyond the limit of %g", name, LARGEST);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, name, -1, "`%s` is not a finite number",
                  name);
}

double cag_curve_size(const CagVec3 *points, size_t n) {
  double size = 0;
  for (size_t i = 0; i < n; i++)
    size = fmax(size, fmax(fabs(points[i].x), fmax(fabs(points[i].y), fabs(points[i].z))));
  return size;
}

double cag_curve_noise(const CagBounds *box) {
  const double ulps = 32; // rounding of a few dozen operations
  const CagVec3 corners[2] = {box->min, box->max};
  return ulps * DBL_EPSILON * cag_curve_size(corners, 2);
}

static const char *parameter_text(const CagCurve *c, double t, char *buffer) {
  if (!c->angular) return cag_number_text(t, buffer);
  // Degrees are printed without the rounding from the conversion to radians.
  snprintf(buffer, 32, "%.12gdeg", t * (180 / M_PI));
  return buffer;
}

static CagStatus snap(const CagCurve *c, double *t, const char *name, CagError *err) {
  char a[48], b[48], x[48];
  if (isnan(*t)) return cag_curve_check_number(*t, name, err);
  const double inside = fmin(c->end, fmax(c->start, *t));
  if (fabs(*t - inside) <= SNAP_ULPS * DBL_EPSILON * fmax(fabs(c->start), fabs(c->end))) {
    *t = inside;
    return CAG_OK;
  }
  return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, name, -1,
                  "`%s` = %s lies outside the domain %s..%s", name, parameter_text(c, *t, x),
                  parameter_text(c, c->start, a), parameter_text(c, c->end, b));
}

static CagStatus check_order(int order, CagError *err) {
  if (order >= 0 && order <= CAG_MAX_DERIVATIVE) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_derivative_order, "order", -1,
                  "the order of a derivative must be 0 to %d, found %d", CAG_MAX_DERIVATIVE, order);
}

// --- Evaluation ---

CagStatus cag_curve_eval(const CagCurve *c, double t, int order, CagSide side, CagVec3 *out,
                         CagError *err) {
  if (cag_stop_check(err)) return err->status;
  CagStatus status = check_order(order, err);
  if (!status) status = snap(c, &t, "t", err);
  if (status) return status;
  if (t == c->start) side = CAG_SIDE_RIGHT;
  if (t == c->end) side = CAG_SIDE_LEFT;
  return c->kind->eval(c, t, order, side, out, err);
}

CagStatus cag_curve_point(const CagCurve *c, double t, CagVec3 *out, CagError *err) {
  return cag_curve_eval(c, t, 0, CAG_SIDE_RIGHT, out, err);
}

CagStatus cag_curve_eval_many(const CagCurve *c, const double *t, size_t n, int order, CagVec3 *out,
                              CagError *err) {
  CagStatus status = check_order(order, err);
  if (status) return status;
  bool inside = true;
  for (size_t i = 0; i < n; i++) inside = inside && t[i] >= c->start && t[i] <= c->end;
  for (size_t i = 0; !status && inside && c->kind->eval_many && i < n; i += BLOCK) {
    const size_t block = n - i < BLOCK ? n - i : BLOCK;
    status = cag_stop_check(err);
    if (!status)
      status = c->kind->eval_many(c, t + i, block, order, out + i * (size_t)(order + 1), err);
  }
  if (inside && c->kind->eval_many) return status;
  for (size_t i = 0; i < n; i++) {
    status = cag_curve_eval(c, t[i], order, CAG_SIDE_RIGHT, out + i * (size_t)(order + 1), err);
    if (status) {
      err->index = (long)i;
      return status;
    }
  }
  return CAG_OK;
}

// --- Other forms ---

CagStatus cag_curve_to_nurbs(const CagCurve *c, CagCurve **out, CagError *err) {
  if (c->kind->to_nurbs) return c->kind->to_nurbs(c, out, err);
  return cag_fail(
      err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "", -1,
      "a curve of kind \"%s\" has no exact NURBS form; approximate(C, tolerance) returns one within a tolerance",
      c->kind->name);
}

// Whether a planar transform maps all of space to the plane: see cag_curve_flatten.
static bool flattens(const CagTransform *t) {
  return t->planar && t->m[2][0] == 0 && t->m[2][1] == 0 && t->m[2][2] == 0 && t->m[2][3] == 0;
}

int cag_curve_image_dimension(const CagCurve *c, const CagTransform *t) {
  return (c->dimension == 2 && t->planar) || flattens(t) ? 2 : 3;
}

CagStatus cag_curve_transform_nurbs(const CagCurve *c, const CagTransform *t, CagCurve **out,
                                    CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  status = exact->kind->transform(exact, t, out, err);
  cag_curve_release(exact);
  return status;
}

// Keeps the unit of the parameter. Kinds recognize angles by their rate of turning, which a change
// of the range alters. An image as a NURBS has its own parameter.
static CagStatus keep_unit(const CagCurve *c, CagStatus status, CagCurve **made) {
  if (status || (*made)->references > 1 || (*made)->angular == c->angular) return status;
  if (!cag_nurbs_data(*made) || cag_nurbs_data(c)) (*made)->angular = c->angular;
  return status;
}

CagStatus cag_curve_transform(const CagCurve *c, const CagTransform *t, CagCurve **out,
                              CagError *err) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (!isfinite(t->m[i][j]))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "T", -1,
                        "the transform has an entry that is not a finite number");
  return keep_unit(c, c->kind->transform(c, t, out, err), out);
}

CagStatus cag_curve_to_space(const CagCurve *c, CagCurve **out, CagError *err) {
  if (c->dimension == 3) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  CagTransform t = cag_transform_identity();
  t.planar = false;
  return keep_unit(c, c->kind->transform(c, &t, out, err), out);
}

CagStatus cag_curve_flatten(const CagCurve *c, const CagTransform *frame, CagCurve **out,
                            CagError *err) {
  CagTransform t;
  CagStatus status = cag_transform_inverse(frame, &t, err);
  if (status) return status;
  for (int k = 0; k < 4; k++) t.m[2][k] = 0;
  t.planar = true;
  return keep_unit(c, c->kind->transform(c, &t, out, err), out);
}

CagStatus cag_curve_part(const CagCurve *c, const CagCurvePart *p, CagCurve **out, CagError *err) {
  return keep_unit(c, c->kind->part(c, p, out, err), out);
}

CagStatus cag_curve_reverse(const CagCurve *c, CagCurve **out, CagError *err) {
  const CagCurvePart backwards = {c->end, c->start, c->start, c->end};
  return cag_curve_part(c, &backwards, out, err);
}

double cag_curve_remap(const CagCurve *c, double t, double a, double b) {
  if (t == c->start) return a;
  if (t == c->end) return b;
  return a + (t - c->start) * ((b - a) / (c->end - c->start));
}

double cag_part_parameter(const CagCurvePart *p, double t) {
  if (t == p->from) return p->start;
  if (t == p->to) return p->end;
  if (p->from == p->start && p->to == p->end) return t;
  return p->start + (t - p->from) * ((p->end - p->start) / (p->to - p->from));
}

static CagStatus check_range(const CagCurve *c, double a, double b, CagError *err) {
  char x[32], y[32];
  CagStatus status = cag_curve_check_number(a, "range", err);
  if (!status) status = cag_curve_check_number(b, "range", err);
  if (status || a < b) return status;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "range", -1,
                  "the range %s..%s has no length; its start must be less than its end",
                  parameter_text(c, a, x), parameter_text(c, b, y));
}

// Whether the range leaves the domain of a closed curve by more than rounding.
static bool leaves_domain(const CagCurve *c, double a, double b) {
  const double slack = SNAP_ULPS * DBL_EPSILON * fmax(fabs(c->start), fabs(c->end));
  return c->closed && c->start < c->end && (a < c->start - slack || b > c->end + slack);
}

static CagStatus trim_closed(const CagCurve *c, double a, double b, CagCurve **out, CagError *err) {
  const double period = c->end - c->start;
  const double slack = SNAP_ULPS * DBL_EPSILON * fmax(fabs(a), fabs(b));
  char x[48], y[48], z[48];
  if (b - a > period + slack)
    return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "range", -1,
                    "the range %s..%s is longer than one turn of the closed curve, %s",
                    parameter_text(c, a, x), parameter_text(c, b, y), parameter_text(c, period, z));
  return keep_unit(c, cag_curve_trim_over_seam(c, a, b, out, err), out);
}

CagStatus cag_curve_trim(const CagCurve *c, double a, double b, CagCurve **out, CagError *err) {
  CagStatus status = check_range(c, a, b, err);
  if (!status && leaves_domain(c, a, b)) return trim_closed(c, a, b, out, err);
  if (!status) status = snap(c, &a, "range", err);
  if (!status) status = snap(c, &b, "range", err);
  if (!status) status = check_range(c, a, b, err);
  if (status) return status;
  if (a == c->start && b == c->end) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  const CagCurvePart between = {a, b, a, b};
  return cag_curve_part(c, &between, out, err);
}

CagStatus cag_curve_halves(const CagCurve *c, double t, CagCurve *out[2], CagError *err) {
  CagStatus status = snap(c, &t, "t", err);
  if (status) return status;
  out[0] = out[1] = NULL;
  for (int i = 0; !status && i < 2; i++) {
    const double a = i ? t : c->start, b = i ? c->end : t;
    CagVec3 p;
    if (a < b) {
      status = cag_curve_trim(c, a, b, &out[i], err);
      continue;
    }
    status = cag_curve_point(c, t, &p, err);
    if (!status) status = cag_curve_resting(p, c->dimension, t, t, c->angular, &out[i], err);
  }
  if (!status) return CAG_OK;
  cag_curve_release(out[0]);
  cag_curve_release(out[1]);
  return status;
}

CagStatus cag_curve_reparametrize(const CagCurve *c, double a, double b, CagCurve **out,
                                  CagError *err) {
  CagStatus status = check_range(c, a, b, err);
  if (status) return status;
  if (a == c->start && b == c->end) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  const CagCurvePart whole = {c->start, c->end, a, b};
  return c->kind->part(c, &whole, out, err);
}

CagStatus cag_curve_reparametrize_as(const CagCurve *c, double a, double b, bool angular,
                                     CagCurve **out, CagError *err) {
  CagStatus status = check_range(c, a, b, err);
  if (status) return status;
  if (a == c->start && b == c->end && angular == c->angular) {
    *out = cag_curve_retain(c);
    return CAG_OK;
  }
  const CagCurvePart whole = {c->start, c->end, a, b};
  status = c->kind->part(c, &whole, out, err);
  if (!status) (*out)->angular = angular;
  return status;
}

CagStatus cag_curve_cuts(const CagCurve *c, double **out, size_t *n, CagError *err) {
  size_t inner = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *cuts = cag_malloc(sizeof *cuts * (inner + 2));
  if (!cuts) return cag_fail_memory(err);
  cuts[0] = c->start;
  if (inner) c->kind->breaks(c, cuts + 1, inner);
  cuts[inner + 1] = c->end;
  *out = cuts;
  *n = inner + 2;
  return CAG_OK;
}

bool cag_curve_sampled_hull(const CagCurve *c, double a, double b, CagBounds *out) {
  enum { PARTS = 16 };
  CagError ignored;
  CagVec3 p[3] = {{0, 0, 0}}, bend = {0, 0, 0}; // p: the last three
  int found = 0;
  *out = CAG_BOUNDS_EMPTY;
  for (int i = 0; i <= PARTS; i++) {
    const CagSide side = i < PARTS ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT;
    CagVec3 at;
    if (c->kind->eval(c, i < PARTS ? a + (b - a) * i / PARTS : b, 0, side, &at, &ignored)) continue;
    p[0] = p[1];
    p[1] = p[2];
    p[2] = at;
    cag_bounds_add(out, at);
    if (++found < 3) continue;
    bend.x = fmax(bend.x, fabs(p[0].x - 2 * p[1].x + p[2].x));
    bend.y = fmax(bend.y, fabs(p[0].y - 2 * p[1].y + p[2].y));
    bend.z = fmax(bend.z, fabs(p[0].z - 2 * p[1].z + p[2].z));
  }
  out->min = cag_sub(out->min, bend);
  out->max = cag_add(out->max, bend);
  return found > PARTS;
}
