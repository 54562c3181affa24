// A conic as a curve: its equation, and its branch if there is exactly one.
//
// Every query is delegated to the branch, and curves derived from the branch have the branch's
// kind; only an image under a planar transform is again a conic, by its equation. A conic with two
// branches, or without a real one, fails all queries ("no-single-curve").

#include <stdio.h>

#include "geom/curve/conic.h"
#include "geom/curve/family.h"

// Parameter range of the branch of a parabola or line.
#define REACH 2.0

typedef struct Conic {
  CagCurve base;
  CagConic conic;
  CagCurve *branch; // NULL: no branch, or two
  CagBounds box;    // of all branches
  const char *name;
} Conic;

static const CagCurveKind conic_kind;

bool cag_curve_conic_view(const CagCurve *c, CagConic *out) {
  if (c->kind != &conic_kind) return false;
  *out = ((const Conic *)c)->conic;
  return true;
}

const CagCurve *cag_curve_conic_branch(const CagCurve *c) {
  return c->kind == &conic_kind ? ((const Conic *)c)->branch : NULL;
}

CagStatus cag_curve_conic(const CagConic *conic, CagCurve **out, CagError *err) {
  CagConicClass k;
  CagCurve *branches[2], *base = NULL;
  size_t n = 0;
  CagStatus status = cag_conic_classify(conic, &k, err);
  if (!status) status = cag_conic_branches(conic, -REACH, REACH, branches, &n, err);
  if (!status) status = cag_curve_block(sizeof(Conic), &conic_kind, 2, 0, 1, &base, err);
  if (!status) {
    Conic *c = (Conic *)base;
    c->conic = *conic;
    c->name = k.name;
    c->box = CAG_BOUNDS_EMPTY;
    for (size_t i = 0; i < n; i++) {
      CagBounds b = branches[i]->kind->hull(branches[i], branches[i]->start, branches[i]->end);
      cag_bounds_add(&c->box, b.min);
      cag_bounds_add(&c->box, b.max);
    }
    if (n == 1) {
      c->branch = cag_curve_retain(branches[0]);
      base->start = branches[0]->start;
      base->end = branches[0]->end;
      base->angular = branches[0]->angular;
      base->closed = branches[0]->closed;
    }
    *out = base;
  }
  while (n > 0) cag_curve_release(branches[--n]);
  return status;
}

static CagStatus single(const CagCurve *curve, const CagCurve **branch, CagError *err) {
  const Conic *c = (const Conic *)curve;
  *branch = c->branch;
  if (c->branch) return CAG_OK;
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_single_curve, "", -1,
                  "this conic (%s) is not a single curve; branches(C) returns its curves", c->name);
}

static CagStatus eval(const CagCurve *c, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  const CagCurve *b;
  CagStatus status = single(c, &b, err);
  return status ? status : b->kind->eval(b, t, order, side, out, err);
}

static CagStatus to_nurbs(const CagCurve *c, CagCurve **out, CagError *err) {
  const CagCurve *b;
  CagStatus status = single(c, &b, err);
  return status ? status : cag_curve_to_nurbs(b, out, err);
}

static CagStatus transform(const CagCurve *c, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  CagConic image;
  const CagCurve *b;
  CagStatus status;
  if (t->planar) {
    status = cag_conic_transform(&((const Conic *)c)->conic, t, &image, err);
    return status ? status : cag_curve_conic(&image, out, err);
  }
  status = single(c, &b, err);
  return status ? status : cag_curve_transform(b, t, out, err);
}

static CagStatus part(const CagCurve *c, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const CagCurve *b;
  CagStatus status = single(c, &b, err);
  return status ? status : b->kind->part(b, p, out, err);
}

static CagBounds hull(const CagCurve *curve, double a, double b) {
  const Conic *c = (const Conic *)curve;
  return c->branch ? c->branch->kind->hull(c->branch, a, b) : c->box;
}

static size_t breaks(const CagCurve *curve, double *out, size_t capacity) {
  (void)curve;
  (void)out;
  (void)capacity;
  return 0;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const Conic *c = (const Conic *)curve;
  snprintf(buffer, size, "class %s", c->name);
}

static void destroy(CagCurve *c) { cag_curve_release(((Conic *)c)->branch); }

static void digest(const CagCurve *curve, CagDigest *d) {
  const Conic *c = (const Conic *)curve;
  cag_digest_numbers(d, c->conic.c, 6);
  if (c->branch) cag_curve_digest(c->branch, d);
}

static const CagCurveKind conic_kind = {"conic", eval,   NULL,     to_nurbs, transform, part,
                                        hull,    breaks, describe, destroy,  digest};
