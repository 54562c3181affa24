// Points of a quadric given by its equation, and its plane sections.
//
// Sums of a few products are compared with the sum of their magnitudes, to which their rounding is
// relative. Therefore all decisions are independent of the unit and of the equation's factor.

#include "geom/surface/quadric_equation.h"

#include <float.h>
#include <math.h>

// A point is on the surface if the terms of the equation cancel to this fraction, as for points
// that a script computes in a few steps.
#define ON_SURFACE 1e-8
// The gradient vanishes if its terms cancel to this fraction.
#define NO_GRADIENT 1e-11
// Eigenvalues of the form in the tangent plane below this fraction of the larger one are 0. They
// change with the error of the point.
#define NO_CURVATURE 1e-8
// Coefficients of a section below this number of rounding errors of their terms are 0.
#define ROUNDINGS (16 * DBL_EPSILON)

#define TERMS 10

// The terms of the equation at p, in the order of the coefficients.
static void terms_at(const CagQuadric *q, CagVec3 p, double out[10]) {
  const double monomials[10] = {p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z,
                                p.x * p.z, p.x,       p.y,       p.z,       1};
  for (int i = 0; i < TERMS; i++) out[i] = q->c[i] * monomials[i];
}

static double sum_of_magnitudes(const double *x, int n) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += fabs(x[i]);
  return sum;
}

CagVec3 cag_quadric_gradient(const CagQuadric *q, CagVec3 p) {
  const double *c = q->c;
  return cag_vec3(2 * c[0] * p.x + c[3] * p.y + c[5] * p.z + c[6],
                  c[3] * p.x + 2 * c[1] * p.y + c[4] * p.z + c[7],
                  c[5] * p.x + c[4] * p.y + 2 * c[2] * p.z + c[8]);
}

// The largest sum of magnitudes over the gradient's components.
static double gradient_size(const CagQuadric *q, CagVec3 p) {
  CagQuadric positive;
  for (int i = 0; i < TERMS; i++) positive.c[i] = fabs(q->c[i]);
  CagVec3 g = cag_quadric_gradient(&positive, cag_vec3(fabs(p.x), fabs(p.y), fabs(p.z)));
  return fmax(g.x, fmax(g.y, g.z));
}

CagStatus cag_quadric_center(const CagQuadric *q, CagVec3 *out, CagError *err) {
  CagQuadricForm form;
  CagStatus status = cag_quadric_classify(q, &form, err);
  if (status) return status;
  if (!form.has_center)
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_quadric_not_central, "", -1,
        "the %s has no single center; `classify` returns its vertex, or a point of its axis, as the origin of the frame",
        form.name);
  *out = form.center;
  return CAG_OK;
}

CagStatus cag_quadric_tangent_plane(const CagQuadric *q, CagVec3 p, CagPlane *out, CagError *err) {
  double terms[10], value = 0;
  terms_at(q, p, terms);
  for (int i = 0; i < TERMS; i++) value += terms[i];
  char text[32];
  if (fabs(value) > ON_SURFACE * sum_of_magnitudes(terms, TERMS))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_point_not_on_surface, "P", -1,
                    "the point is not on the quadric: the value of its equation there is %s, not 0",
                    cag_number_text(value, text));
  CagVec3 g = cag_quadric_gradient(q, p);
  if (cag_norm(g) <= NO_GRADIENT * gradient_size(q, p))
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_singular_point, "P", -1,
        "the quadric has no tangent plane there: the point is its apex, or lies on a double line");
  return cag_plane(p, g, out, err);
}

static double form_value(const CagQuadric *q, CagVec3 a, CagVec3 b) {
  const double *c = q->c;
  return c[0] * a.x * b.x + c[1] * a.y * b.y + c[2] * a.z * b.z +
         (c[3] * (a.x * b.y + a.y * b.x) + c[4] * (a.y * b.z + a.z * b.y) +
          c[5] * (a.x * b.z + a.z * b.x)) /
             2;
}

CagStatus cag_quadric_rulings(const CagQuadric *q, CagVec3 p, CagRulings *out, CagError *err) {
  CagPlane plane;
  CagStatus status = cag_quadric_tangent_plane(q, p, &plane, err);
  if (status) return status;
  CagTransform frame = cag_plane_frame(&plane);
  CagVec3 x = cag_vec3(frame.m[0][0], frame.m[1][0], frame.m[2][0]);
  CagVec3 y = cag_vec3(frame.m[0][1], frame.m[1][1], frame.m[2][1]);
  // The form in the tangent plane, by its eigenvalues.
  double a = form_value(q, x, x), b = form_value(q, x, y), c = form_value(q, y, y);
  double middle = (a + c) / 2, spread = hypot((a - c) / 2, b), turn = atan2(b, (a - c) / 2) / 2;
  double high = middle + spread, low = middle - spread;
  CagVec3 of_high = cag_madd(cag_scaled(x, cos(turn)), sin(turn), y);
  CagVec3 of_low = cag_cross(plane.normal, of_high);
  double large = fmax(fabs(high), fabs(low));
  *out = (CagRulings){0};
  if (large <= NO_CURVATURE * sum_of_magnitudes(q->c, 6)) {
    out->all = true;
  } else if (fmin(fabs(high), fabs(low)) <= NO_CURVATURE * large) {
    out->count = 1;
    out->direction[0] = fabs(high) < fabs(low) ? of_high : of_low;
  } else if (high > 0 && low < 0) {
    out->count = 2;
    out->direction[0] = cag_unit(cag_madd(cag_scaled(of_high, sqrt(-low)), sqrt(high), of_low));
    out->direction[1] = cag_unit(cag_madd(cag_scaled(of_high, sqrt(-low)), -sqrt(high), of_low));
  }
  return CAG_OK;
}

CagTransform cag_plane_frame(const CagPlane *plane) {
  CagVec3 n = plane->normal, near = fabs(n.x) > 0.9 ? cag_vec3(0, 1, 0) : cag_vec3(1, 0, 0);
  CagVec3 x = cag_unit(cag_madd(near, -cag_dot(near, n), n)), y = cag_cross(n, x);
  CagTransform t = {{{x.x, y.x, n.x, plane->point.x},
                     {x.y, y.y, n.y, plane->point.y},
                     {x.z, y.z, n.z, plane->point.z},
                     {0, 0, 0, 1}},
                    false};
  return t;
}

// Replaces a sum that is only rounding by 0; otherwise a parabola would become a very long ellipse.
static double settled(double value, double magnitude) {
  return fabs(value) <= ROUNDINGS * magnitude ? 0 : value;
}

void cag_quadric_section(const CagQuadric *q, const CagTransform *f, CagConic *out) {
  CagVec3 x = cag_vec3(f->m[0][0], f->m[1][0], f->m[2][0]);
  CagVec3 y = cag_vec3(f->m[0][1], f->m[1][1], f->m[2][1]);
  CagVec3 o = cag_vec3(f->m[0][3], f->m[1][3], f->m[2][3]), g = cag_quadric_gradient(q, o);
  double terms[10], value = 0, size = sum_of_magnitudes(q->c, 6), xx = cag_norm(x),
                    yy = cag_norm(y), slope = gradient_size(q, o);
  terms_at(q, o, terms);
  for (int i = 0; i < TERMS; i++) value += terms[i];
  const CagConic conic = {{settled(form_value(q, x, x), size * xx * xx),
                           settled(2 * form_value(q, x, y), 2 * size * xx * yy),
                           settled(form_value(q, y, y), size * yy * yy),
                           settled(cag_dot(g, x), slope * xx), settled(cag_dot(g, y), slope * yy),
                           settled(value, sum_of_magnitudes(terms, TERMS))}};
  *out = conic;
}
