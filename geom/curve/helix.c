// Helices about the z axis of a frame: [r cos, r sin, pitch turn], with r growing by the taper each
// turn.
//
// The frame may be any affine map, so that the affine image of a helix is a helix. The angle is
// phase + rate * t (rate < 0: reversed); a left-handed helix rotates in the other direction as it
// climbs.

#include <stdio.h>

#include "base/stop.h"
#include "geom/curve/family.h"

typedef struct Helix {
  CagCurve base;
  double radius, pitch, turns, taper; // as constructed
  CagTransform frame;
  CagVec3 center, x, y, z; // columns of the frame; y negated for a left-handed helix
  double phase, rate;
} Helix;

static const CagCurveKind helix_kind;

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

// Another helix with the same parameters; frame must be affine.
static CagStatus make(const Helix *like, const CagTransform *frame, double start, double end,
                      double phase, double rate, CagCurve **out, CagError *err) {
  CagCurve *base;
  CagStatus status = cag_curve_block(sizeof(Helix), &helix_kind, 3, start, end, &base, err);
  if (status) return status;
  Helix *c = (Helix *)base;
  c->radius = like->radius;
  c->pitch = like->pitch;
  c->turns = like->turns;
  c->taper = like->taper;
  c->frame = *frame;
  const double w = frame->m[3][3];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) c->frame.m[i][j] /= w;
  c->center = column(&c->frame, 3);
  c->x = column(&c->frame, 0);
  c->y = cag_scaled(column(&c->frame, 1), like->turns < 0 ? -1 : 1);
  c->z = column(&c->frame, 2);
  c->phase = phase;
  c->rate = rate;
  base->angular = rate == 1;
  *out = base;
  return CAG_OK;
}

CagStatus cag_curve_helix(double radius, double pitch, double turns, double taper, CagCurve **out,
                          CagError *err) {
  char text[32];
  CagStatus status = cag_curve_check_number(radius, "radius", err);
  if (!status) status = cag_curve_check_number(pitch, "pitch", err);
  if (!status) status = cag_curve_check_number(turns, "turns", err);
  if (!status) status = cag_curve_check_number(taper, "taper", err);
  if (status) return status;
  const double last = radius + taper * fabs(turns);
  if (radius < 0 || last < 0 || (radius == 0 && taper == 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_not_positive,
                    radius > 0 ? "taper" : "radius", -1,
                    radius > 0 ? "the taper takes the radius below 0: after all turns it is %s"
                               : "`radius` must be positive, found %s",
                    cag_number_text(radius > 0 ? last : radius, text));
  if (turns == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "turns", -1,
                    "`turns` must not be 0: the helix would be a point");
  if (taper == 0 && pitch == 0 && fabs(turns) > 1)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_pitch, "pitch", -1,
                    "with pitch 0 and no taper, the turns lie on one circle; use circle(radius)");
  const Helix like = {.radius = radius, .pitch = pitch, .turns = turns, .taper = taper};
  CagTransform frame = cag_transform_identity();
  frame.planar = false;
  return make(&like, &frame, 0, 2 * M_PI * fabs(turns), 0, 1, out, err);
}

bool cag_curve_helix_view(const CagCurve *curve, double *radius, double *pitch, double *turns,
                          double *taper, CagTransform *frame) {
  const Helix *c = (const Helix *)curve;
  if (curve->kind != &helix_kind || c->rate != 1 || c->phase != 0) return false;
  *radius = c->radius;
  *pitch = c->pitch;
  *turns = c->turns;
  *taper = c->taper;
  *frame = c->frame;
  return true;
}

static void derivatives(const Helix *c, double t, int order, CagVec3 *out) {
  const double angle = c->phase + c->rate * t;
  const double growth = c->taper / (2 * M_PI), climb = c->pitch / (2 * M_PI);
  const double r = c->radius + growth * angle;
  double s, d, scale = 1;
  cag_sincos(angle, &s, &d);
  // (r e)^(k) = r e^(k) + k growth e^(k - 1), with e = (cos, sin) and quarter turns for e^(k).
  const double cosine[4] = {d, -s, -d, s}, sine[4] = {s, d, -s, -d};
  for (int k = 0; k <= order; k++) {
    double x = r * cosine[k & 3], y = r * sine[k & 3],
           z = k == 0   ? climb * angle
               : k == 1 ? climb
                        : 0;
    if (k > 0) {
      x += k * growth * cosine[(k - 1) & 3];
      y += k * growth * sine[(k - 1) & 3];
    }
    CagVec3 v = cag_madd(cag_madd(cag_scaled(c->x, x), y, c->y), z, c->z);
    out[k] = k == 0 ? cag_add(c->center, v) : cag_scaled(v, scale);
    scale *= c->rate;
  }
}

bool cag_curve_coil(const CagCurve *curve, CagCoil *out) {
  if (curve->kind != &helix_kind) return cag_curve_arc_coil(curve, out);
  const Helix *c = (const Helix *)curve;
  *out = (CagCoil){
      c->center, c->x,   c->y, c->z, c->radius, c->taper / (2 * M_PI), c->pitch / (2 * M_PI),
      c->phase,  c->rate};
  return true;
}

// C'' = r e'' + 2 growth e' with respect to the angle, a sum of two perpendicular vectors.
bool cag_curve_helix_bend(const CagCurve *curve, double a, double b, double *out) {
  if (curve->kind != &helix_kind) return false;
  const Helix *c = (const Helix *)curve;
  const double growth = c->taper / (2 * M_PI);
  const double r = fmax(fabs(c->radius + growth * (c->phase + c->rate * a)),
                        fabs(c->radius + growth * (c->phase + c->rate * b)));
  *out = c->rate * c->rate * hypot(r, 2 * growth) * cag_curve_stretch(c->x, c->y);
  return true;
}

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  (void)side;
  (void)err;
  derivatives((const Helix *)curve, t, order, out);
  return CAG_OK;
}

static CagStatus eval_many(const CagCurve *curve, const double *t, size_t n, int order,
                           CagVec3 *out, CagError *err) {
  (void)err;
  for (size_t i = 0; i < n; i++)
    derivatives((const Helix *)curve, t[i], order, out + i * (size_t)(order + 1));
  return CAG_OK;
}

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const Helix *c = (const Helix *)curve;
  if (!cag_transform_is_affine(t))
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "T", -1,
        "the image of a helix under a projection has no exact form; use approximate(C, tolerance) first");
  CagTransform frame = cag_transform_multiply(t, &c->frame);
  return make(c, &frame, curve->start, curve->end, c->phase, c->rate, out, err);
}

static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const Helix *c = (const Helix *)curve;
  return make(c, &c->frame, p->start, p->end, c->phase + c->rate * cag_part_origin(p),
              c->rate * cag_part_rate(p), out, err);
}

// The chord's box, enlarged by the bound of the sag. Ends early if the work is canceled.
static CagBounds hull(const CagCurve *curve, double a, double b) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  const Helix *c = (const Helix *)curve;
  const double quarter = M_PI / 2;
  double from = c->phase + c->rate * a, to = c->phase + c->rate * b;
  size_t n = (size_t)fmax(1, ceil(fabs(to - from) / quarter));
  for (size_t i = 0; i == 0 || (i < n && !cag_stopped()); i++) {
    double s = a + (b - a) * (double)i / (double)n, e = a + (b - a) * (double)(i + 1) / (double)n;
    double sag = cag_curve_sag(curve, s, e);
    CagVec3 p[2];
    derivatives(c, s, 0, &p[0]);
    derivatives(c, e, 0, &p[1]);
    for (int k = 0; k < 2; k++) {
      cag_bounds_add(&box, cag_sub(p[k], cag_vec3(sag, sag, sag)));
      cag_bounds_add(&box, cag_add(p[k], cag_vec3(sag, sag, sag)));
    }
  }
  return box;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const Helix *c = (const Helix *)curve;
  char r[32], p[32], n[32], k[32];
  int used = snprintf(buffer, size, "radius %s, pitch %s, %s turns", cag_number_text(c->radius, r),
                      cag_number_text(c->pitch, p), cag_number_text(c->turns, n));
  if (c->taper != 0 && used > 0 && (size_t)used < size)
    snprintf(buffer + used, size - (size_t)used, ", taper %s", cag_number_text(c->taper, k));
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const Helix *c = (const Helix *)curve;
  cag_digest_numbers(d, (const double[]){c->radius, c->pitch, c->turns, c->taper}, 4);
  cag_transform_digest(&c->frame, d);
  cag_digest_number(d, c->phase);
  cag_digest_number(d, c->rate);
}

static const CagCurveKind helix_kind = {"helix", eval, eval_many, NULL, transform, part,
                                        hull,    NULL, describe,  NULL, digest};
