// Points of conics at equal steps of the parameter, by the classical recurrences.
//
// With p the position from the center and q the derivative with respect to the parameter, a step of
// d is the addition theorem of the form: two products for each coordinate, and no trigonometric
// functions except those of the step. The recurrence accumulates rounding errors, and hyperbolic
// ones grow with the curve, so p and q are recomputed every ANCHOR steps.

#include "geom/curve/conic.h"
#include "geom/curve/family.h"

#define ANCHOR 64

typedef enum Form { CIRCULAR, PARABOLIC, HYPERBOLIC, SECANT, TANGENT } Form;

typedef struct Walk {
  Form form;
  const CagCurve *c;
  CagVec3 center, x, y;
  double rate, phase; // d(angle) / dt; phase: for open conics
} Walk;

static bool read_walk(const CagCurve *c, Walk *w) {
  static const Form forms[] = {PARABOLIC, TANGENT, HYPERBOLIC, SECANT};
  CagOpenConic open;
  w->c = c;
  w->form = CIRCULAR;
  w->phase = 0;
  if (cag_curve_arc_axes(c, &w->center, &w->x, &w->y, &w->rate)) return true;
  if (!cag_curve_open_conic(c, &open)) return false;
  w->form = forms[open.form];
  w->center = open.center;
  w->x = open.x;
  w->y = open.y;
  w->rate = open.rate;
  w->phase = open.phase;
  return true;
}

// Position from the center, and derivative with respect to the angle, at parameter t.
static CagStatus anchor(const Walk *w, double t, CagVec3 *p, CagVec3 *q, CagError *err) {
  CagVec3 out[2];
  CagStatus status = cag_curve_eval(w->c, t, 1, CAG_SIDE_RIGHT, out, err);
  if (status) return status;
  *p = cag_sub(out[0], w->center);
  *q = cag_scaled(out[1], 1 / w->rate);
  return CAG_OK;
}

// Steps of the circular, elliptic, parabolic, and hyperbolic forms.
static void step(const Walk *w, double d, double c, double s, CagVec3 *p, CagVec3 *q) {
  CagVec3 a = *p, b = *q;
  switch (w->form) {
  case CIRCULAR:
    *p = cag_madd(cag_scaled(a, c), s, b);
    *q = cag_madd(cag_scaled(b, c), -s, a);
    break;
  case HYPERBOLIC:
    *p = cag_madd(cag_scaled(a, c), s, b);
    *q = cag_madd(cag_scaled(b, c), s, a);
    break;
  default: *p = cag_madd(cag_madd(a, d, b), d * d, w->x); *q = cag_madd(b, 2 * d, w->x);
  }
}

// Secant and tangent forms: tan and sec of the sum of two angles.
static void angular_points(const Walk *w, size_t n, double d, CagVec3 *out) {
  double s, c, sine, cosine, secant = 0, tangent = 0;
  cag_sincos(d, &s, &c);
  for (size_t i = 0; i + 1 < n; i++) {
    if (i % ANCHOR == 0) {
      cag_sincos(w->phase + w->rate * w->c->start + d * (double)i, &sine, &cosine);
      secant = 1 / cosine;
      tangent = sine / cosine;
    }
    const double f = w->form == SECANT ? secant : tangent * tangent;
    out[i] = cag_add(w->center, cag_madd(cag_scaled(w->x, f), tangent, w->y));
    const double divisor = c - tangent * s;
    secant = secant / divisor;
    tangent = (tangent * c + s) / divisor;
  }
}

CagStatus cag_conic_points(const CagCurve *c, size_t n, CagVec3 *out, CagError *err) {
  Walk w;
  CagVec3 p = {0, 0, 0}, q = p;
  CagStatus status = CAG_OK;
  if (cag_curve_conic_branch(c)) c = cag_curve_conic_branch(c);
  if (n < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "n", -1,
                    "`n` must be at least 2, because both ends are included");
  if (!read_walk(c, &w))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_not_a_conic, "", -1,
        "expects a circle, ellipse, parabola or hyperbola or an arc of one, found a curve of kind \"%s\"; sample(C, n) works for any curve",
        c->kind->name);
  const double step_t = (c->end - c->start) / (double)(n - 1), d = w.rate * step_t;
  if (w.form == SECANT || w.form == TANGENT) {
    angular_points(&w, n, d, out);
  } else {
    double cosine = cosh(d), sine = sinh(d);
    if (w.form == CIRCULAR) cag_sincos(d, &sine, &cosine);
    for (size_t i = 0; !status && i + 1 < n; i++) {
      if (i % ANCHOR == 0) status = anchor(&w, c->start + step_t * (double)i, &p, &q, err);
      if (status) break;
      out[i] = cag_add(w.center, p);
      step(&w, d, cosine, sine, &p, &q);
    }
  }
  if (!status) status = cag_curve_point(c, c->end, &out[n - 1], err);
  return status;
}
