// Outlines of lathes and prisms.

#include "interp/formats/pov_outline.h"

#include <math.h>

#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/family.h"

// The maximum distance of the output from the curve, as a fraction of its size: far below a pixel
// of the largest picture (16,384 pixels).
#define NEAR 2e-6

void cag_pov_outline_free(CagPovOutline *o) { cag_free(o->all.points); }

static double largest(const CagPieces *p) {
  double size = 0;
  for (size_t i = 0; i < 4 * p->count; i++) size = fmax(size, cag_norm(p->points[i]));
  return size;
}

static CagStatus sample(void *context, double t, CagSide side, CagVec3 out[2], CagError *err) {
  return cag_curve_eval(context, t, 1, side, out, err);
}

static bool near_pieces(const CagCurve *c, CagPieces *out) {
  CagError err;
  CagBounds box;
  CagCurve *cubic = NULL;
  double *cuts;
  size_t n;
  if (cag_curve_bounds(c, &box, &err) || cag_curve_cuts(c, &cuts, &n, &err)) return false;
  double size = cag_norm(cag_sub(box.max, box.min));
  bool ok = size > 0 && !cag_curve_fit_sampler(sample, (void *)c, cuts, n, NEAR * size,
                                               c->dimension, &cubic, &err);
  cag_free(cuts);
  ok = ok && cag_pieces_of_curve(cubic, out);
  cag_curve_release(cubic);
  return ok;
}

static bool curve_pieces(const CagCurve *c, CagPieces *out) {
  return cag_pieces_of_curve(c, out) || near_pieces(c, out);
}

bool cag_pov_outline_add(CagPovOutline *o, const CagCurve *c) {
  CagPieces p;
  if (!curve_pieces(c, &p)) return false;
  // Only Bezier splines can contain several outlines.
  if (o->all.count > 0 || !p.linear) o->linear = false;
  bool ok = cag_pieces_append(&o->all, &p);
  cag_free(p.points);
  return ok;
}

bool cag_pov_outline_append(CagPovOutline *o, const CagPovOutline *part) {
  if (o->all.count > 0 || !part->linear) o->linear = false;
  return cag_pieces_append(&o->all, &part->all);
}

// Rounding produces coordinates such as 3e-17 instead of 0. Values below 1e-13 of the size are
// insignificant.
void cag_pov_outline_tidy(CagPovOutline *o) {
  double unit = largest(&o->all) * 1e-13;
  for (size_t i = 0; i < 4 * o->all.count; i++) {
    CagVec3 *q = o->all.points + i;
    if (fabs(q->x) < unit) q->x = 0;
    if (fabs(q->y) < unit) q->y = 0;
  }
}

// --- Text ---

void cag_pov_outline_write(CagPovWriter *w, const CagPovOutline *o, const char *between) {
  size_t n = o->all.count;
  const CagVec3 *p = o->all.points;
  cag_pov_text(w, o->linear ? "  linear_spline\n" : "  bezier_spline\n");
  cag_pov_text(w, between);
  cag_pov_printf(w, "  %zu", o->linear ? n + 1 : 4 * n);
  if (o->linear) {
    for (size_t i = 0; i <= n; i++) {
      cag_pov_text(w, i % 6 == 0 ? ",\n  " : ", ");
      CagVec3 at = i < n ? p[4 * i] : p[4 * n - 1];
      cag_pov_vec2(w, at.x, at.y);
    }
  } else {
    for (size_t i = 0; i < 4 * n; i++) {
      cag_pov_text(w, i % 4 == 0 ? ",\n  " : ", ");
      cag_pov_vec2(w, p[i].x, p[i].y);
    }
  }
  cag_pov_text(w, "\n");
}
