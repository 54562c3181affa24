// Curves defined by a function of the caller.
//
// Images, parts, and reparametrizations share the function and wrap it in maps: the parameter of
// the function runs from `from` to `to` while the curve's runs over its domain, and points are
// mapped by `map`, which may be projective. The curve is known only by points, so its hull is that
// of samples, enlarged by the distance of samples from the chords of their neighbors.

#include "geom/curve/function.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "geom/curve/family.h"

// Highest cached derivative; higher ones are needed rarely, and at few parameters.
#define KNOWN_ORDER 2
// Initial and maximum number of cache slots: the parameters of a fine mesh, in less than 100 kB.
#define FIRST_SLOTS 64
#define MOST_SLOTS 1024

// A cached result for one parameter, up to the derivative `order`; -1: empty.
typedef struct Known {
  double t;
  int order;
  CagVec3 d[KNOWN_ORDER + 1];
} Known;

// The function and a cache of its latest values, which bounds, chords, and meshes request
// repeatedly, for the curve and its images. A value can only be in the slot that its parameter
// hashes to.
typedef struct Source {
  CagCurveFunction function;
  int references;
  bool angular; // its own parameter
  Known *known;
  size_t slots, used; // slots: 0 or a power of two
} Source;

typedef struct Function {
  CagCurve base;
  Source *source;
  double from, to; // parameters of the function at the ends of the domain
  CagTransform map;
  bool mapped;
  CagBounds box; // cached hull of the whole curve
  bool boxed;    // box is valid
} Function;

static const CagCurveKind function_kind;

static double inner(const Function *c, double t) {
  const CagCurve *b = &c->base;
  if (t == b->start) return c->from;
  if (t == b->end) return c->to;
  return c->from + (t - b->start) * ((c->to - c->from) / (b->end - b->start));
}

static CagStatus fail_not_finite(const Function *c, double t, int k, CagError *err) {
  char text[48];
  const double inside = inner(c, t);
  if (c->source->angular) snprintf(text, sizeof text, "%.12gdeg", inside * (180 / M_PI));
  else cag_number_text(inside, text);
  if (k == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                    "the point of the function at t = %s is not finite", text);
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                  "derivative %d of the function at t = %s is not finite", k, text);
}

// --- Cache ---

static Known *known_slot(Known *known, size_t slots, double t) {
  uint64_t bits;
  memcpy(&bits, &t, sizeof bits);
  // The upper half of a product by the golden ratio depends on all bits.
  return &known[(bits * UINT64_C(0x9e3779b97f4a7c15) >> 32) & (slots - 1)];
}

// Grows to about twice the values used so far. If memory runs out, values are recomputed.
static void known_grow(Source *s) {
  const size_t slots = s->slots ? 2 * s->slots : FIRST_SLOTS;
  Known *grown = cag_malloc(slots * sizeof *grown);
  if (!grown) return;
  for (size_t i = 0; i < slots; i++) grown[i].order = -1;
  s->used = 0;
  for (size_t i = 0; i < s->slots; i++) {
    if (s->known[i].order < 0) continue;
    Known *to = known_slot(grown, slots, s->known[i].t);
    s->used += to->order < 0;
    *to = s->known[i];
  }
  cag_free(s->known);
  s->known = grown;
  s->slots = slots;
}

// Value and derivatives of the function itself at its own parameter.
static CagStatus source_eval(Source *s, double t, int order, CagVec3 *out, CagError *err) {
  const CagCurveFunction *f = &s->function;
  if (cag_on_worker()) return cag_worker_fail(err);
  if (order > KNOWN_ORDER) return f->eval(f->context, t, order, out, err);
  if (s->slots) {
    const Known *k = known_slot(s->known, s->slots, t);
    if (k->order >= order && k->t == t) {
      memcpy(out, k->d, (size_t)(order + 1) * sizeof *out);
      return CAG_OK;
    }
  }
  CagStatus status = f->eval(f->context, t, order, out, err);
  if (status) return status;
  if (2 * s->used >= s->slots && s->slots < MOST_SLOTS) known_grow(s);
  if (!s->slots) return CAG_OK;
  Known *k = known_slot(s->known, s->slots, t);
  s->used += k->order < 0;
  k->t = t;
  k->order = order;
  memcpy(k->d, out, (size_t)(order + 1) * sizeof *out);
  return CAG_OK;
}

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  (void)side;
  const Function *c = (const Function *)curve;
  CagStatus status = source_eval(c->source, inner(c, t), order, out, err);
  if (status) return status;
  const double rate = (c->to - c->from) / (curve->end - curve->start);
  double scale = 1;
  for (int k = 1; rate != 1 && k <= order; k++) {
    scale *= rate;
    out[k] = cag_scaled(out[k], scale);
  }
  if (c->mapped && !cag_transform_derivatives(&c->map, order, out))
    status = fail_not_finite(c, t, 0, err);
  for (int k = 0; !status && k <= order; k++)
    if (!isfinite(out[k].x) || !isfinite(out[k].y) || !isfinite(out[k].z))
      status = fail_not_finite(c, t, k, err);
  return status;
}

// Number of samples for a hull: an oscillation between two of them would be too short for a good
// picture of the curve anyway.
#define HULL_SAMPLES 33
// In each coordinate, the distance from the chord of the neighbors is four times that from the
// chord between samples, which leaves a margin for oscillations that are sampled badly.
static CagStatus sampled_box(const CagCurve *curve, double a, double b, int samples, CagBounds *out,
                             CagError *err) {
  CagVec3 before[2] = {{0, 0, 0}, {0, 0, 0}};
  CagVec3 sag = {0, 0, 0};
  *out = CAG_BOUNDS_EMPTY;
  for (int i = 0; i < samples; i++) {
    CagVec3 p;
    double t = i + 1 == samples ? b : a + (b - a) * i / (samples - 1);
    CagStatus status = eval(curve, t, 0, CAG_SIDE_RIGHT, &p, err);
    if (status) return status;
    cag_bounds_add(out, p);
    if (i >= 2) {
      sag.x = fmax(sag.x, fabs(before[1].x - (before[0].x + p.x) / 2));
      sag.y = fmax(sag.y, fabs(before[1].y - (before[0].y + p.y) / 2));
      sag.z = fmax(sag.z, fabs(before[1].z - (before[0].z + p.z) / 2));
    }
    before[0] = before[1];
    before[1] = p;
  }
  out->min = cag_sub(out->min, sag);
  out->max = cag_add(out->max, sag);
  return CAG_OK;
}

// The hull of the whole curve, computed on first use.
static CagStatus whole_box(const CagCurve *curve, CagBounds *out, CagError *err) {
  Function *c = (Function *)curve;
  if (!c->boxed) {
    CagStatus status = sampled_box(curve, curve->start, curve->end, HULL_SAMPLES, &c->box, err);
    if (status) return status;
    c->boxed = true;
  }
  *out = c->box;
  return CAG_OK;
}

// If evaluation fails, the box is infinite.
static CagBounds hull(const CagCurve *curve, double a, double b) {
  const int samples = 9; // for a part, whose halves will be requested, too
  CagBounds box;
  CagError ignored;
  if (a > curve->start || b < curve->end)
    if (!sampled_box(curve, a, b, samples, &box, &ignored)) return box;
  if (!whole_box(curve, &box, &ignored)) return box;
  return (CagBounds){{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};
}

// Another curve of the same function.
static CagStatus make(const Function *like, double start, double end, double from, double to,
                      CagCurve **out, CagError *err) {
  CagCurve *base;
  CagStatus status = cag_curve_block(sizeof(Function), &function_kind, like->base.dimension, start,
                                     end, &base, err);
  if (status) return status;
  Function *c = (Function *)base;
  c->source = like->source;
  c->source->references++;
  c->from = from;
  c->to = to;
  c->map = like->map;
  c->mapped = like->mapped;
  base->angular = like->base.angular;
  *out = base;
  return CAG_OK;
}

// Determines whether the ends meet; releases the curve on failure.
static CagStatus finish(CagCurve *curve, CagCurve **out, CagError *err) {
  CagVec3 ends[2];
  CagBounds box;
  CagStatus status = whole_box(curve, &box, err);
  if (!status) status = eval(curve, curve->start, 0, CAG_SIDE_RIGHT, &ends[0], err);
  if (!status) status = eval(curve, curve->end, 0, CAG_SIDE_LEFT, &ends[1], err);
  if (status) {
    cag_curve_release(curve);
    return status;
  }
  const CagVec3 corners[2] = {box.min, box.max};
  curve->closed =
      cag_norm(cag_sub(ends[0], ends[1])) <= CAG_CURVE_SAME * cag_curve_size(corners, 2);
  *out = curve;
  return CAG_OK;
}

CagStatus cag_curve_function(const CagCurveFunction *f, int dimension, double start, double end,
                             bool angular, CagCurve **out, CagError *err) {
  char a[32], b[32];
  CagStatus status = cag_curve_check_number(start, "range", err);
  if (!status) status = cag_curve_check_number(end, "range", err);
  if (status) return status;
  if (!(start < end))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "range", -1,
                    "the range %s..%s has no length; its start must be less than its end",
                    cag_number_text(angular ? start * (180 / M_PI) : start, a),
                    cag_number_text(angular ? end * (180 / M_PI) : end, b));
  Source *source = cag_malloc(sizeof *source);
  if (!source) return cag_fail_memory(err);
  // The caller owns the context until everything has succeeded.
  *source = (Source){.function = *f, .references = 0, .angular = angular};
  source->function.release = NULL;
  Function like = {.source = source, .map = cag_transform_identity()};
  like.base.dimension = dimension;
  like.base.angular = angular;
  CagCurve *curve;
  source->references = 1;
  status = make(&like, start, end, start, end, &curve, err);
  if (!status) status = finish(curve, out, err);
  source->references--;
  if (status) {
    cag_free(source->known);
    cag_free(source);
    return status;
  }
  source->function.release = f->release;
  return CAG_OK;
}

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const Function *c = (const Function *)curve;
  CagCurve *made;
  CagStatus status = make(c, curve->start, curve->end, c->from, c->to, &made, err);
  if (status) return status;
  Function *moved = (Function *)made;
  moved->map = cag_transform_multiply(t, &c->map);
  moved->mapped = true;
  made->dimension = cag_curve_image_dimension(curve, t);
  return finish(made, out, err);
}

static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const Function *c = (const Function *)curve;
  CagCurve *made;
  CagStatus status = make(c, p->start, p->end, inner(c, p->from), inner(c, p->to), &made, err);
  return status ? status : finish(made, out, err);
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const Function *c = (const Function *)curve;
  snprintf(buffer, size, "by a formula%s", c->mapped ? ", moved" : "");
}

static void destroy(CagCurve *curve) {
  Source *source = ((Function *)curve)->source;
  if (--source->references > 0) return;
  if (source->function.release) source->function.release(source->function.context);
  cag_free(source->known);
  cag_free(source);
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const Function *c = (const Function *)curve;
  const CagCurveFunction *f = &c->source->function;
  if (f->digest) f->digest(f->context, d);
  else d->unknown = true;
  cag_digest_number(d, c->from);
  cag_digest_number(d, c->to);
  if (c->mapped) cag_transform_digest(&c->map, d);
}

static const CagCurveKind function_kind = {
    .name = "function",
    .eval = eval,
    .transform = transform,
    .part = part,
    .hull = hull,
    .describe = describe,
    .destroy = destroy,
    .digest = digest,
};
