// Points of curves along which two surfaces touch, found by Newton's method on the parameters of
// both.
//
// Move the point of the first surface by a in the common tangent plane, and the point of the second
// by b. Let t be the tangential part of the vector from the second point to the first. Both points
// lie on one normal if b - a = t. Let n be the tangential part of the difference of the normals,
// and let W1 and W2 be the shape operators for the same orientation of the normal. The normals
// become parallel if n - W1 a + W2 b = 0. It follows that (W1 - W2) a = n + W2 t. Along a curve of
// touches, W1 - W2 has rank 1, and its kernel is the tangent of the curve. There the equation is
// solved across the curve only.

#include <float.h>
#include <math.h>

#include "geom/linalg/tolerance.h"
#include "geom/meet/meet_place.h"

#define NEWTON_STEPS 40
// Curvatures whose difference is below this fraction of their size count as equal.
#define SAME_CURVATURE 1e-6
// If no direction is given, the smaller curvature is damped by this fraction of the larger one.
#define DAMPING 1e-3
// A difference along a touch that is below this fraction of the curvatures may be rounding.
#define ALONG 2e-8
// The surfaces do not touch if their gap exceeds this multiple of what the curvatures can close in
// one step.
#define OUT_OF_REACH 8
// Surfaces touch if they are within this fraction of the size, and would cross at angles too small
// to tell otherwise.
#define NEAR CAG_COINCIDENT
// A summit is found within this fraction of the longest step.
#define SUMMIT 1e-6
#define SUMMIT_STEPS 12
// If steps no longer shrink, the result is accepted once they are below this fraction of the size.
#define SETTLED 1e-8

// A symmetric matrix in the tangent plane: xx, xy, yy.
typedef struct Shape {
  double xx, xy, yy;
} Shape;

typedef struct Plane2 {
  double x, y;
} Plane2;

static Plane2 apply(const Shape *w, Plane2 a) {
  return (Plane2){w->xx * a.x + w->xy * a.y, w->xy * a.x + w->yy * a.y};
}

static double largest(const Shape *w) {
  return fabs((w->xx + w->yy) / 2) + hypot((w->xx - w->yy) / 2, w->xy);
}

typedef struct Pair {
  CagMarchTangent t[2];
  CagVec3 normal, e1, e2; // of the common tangent plane
  Shape shape[2];
  Plane2 beside, turned; // t and n in the equations above
  double gap;            // along the normal
} Pair;

static double curvature_along(const CagMarchTangent *t, const CagVec3 second[3], CagVec3 a,
                              CagVec3 b) {
  // a and b as combinations of the partials.
  const double e = cag_dot(t->du, t->du), f = cag_dot(t->du, t->dv), g = cag_dot(t->dv, t->dv),
               det = e * g - f * f;
  const CagVec3 *v[2] = {&a, &b};
  double u[2], w[2];
  for (int i = 0; i < 2; i++) {
    const double p = cag_dot(*v[i], t->du), q = cag_dot(*v[i], t->dv);
    u[i] = (g * p - f * q) / det;
    w[i] = (e * q - f * p) / det;
  }
  const double l = cag_dot(t->normal, second[0]), m = cag_dot(t->normal, second[1]),
               n = cag_dot(t->normal, second[2]);
  return l * u[0] * u[1] + m * (u[0] * w[1] + u[1] * w[0]) + n * w[0] * w[1];
}

static bool look_at_side(CagMarch *m, int k, const CagMarchNode *node, CagMarchTangent *t,
                         CagVec3 second[3]) {
  enum { ORDER = 2 };
  CagVec3 d[(ORDER + 1) * (ORDER + 1)];
  if (!cag_march_partials(m, k, node, ORDER, d)) return false;
  *t = (CagMarchTangent){
      .p = d[0], .du = d[cag_partial(ORDER, 1, 0)], .dv = d[cag_partial(ORDER, 0, 1)]};
  t->normal = cag_unit(cag_cross(t->du, t->dv));
  second[0] = d[cag_partial(ORDER, 2, 0)];
  second[1] = d[cag_partial(ORDER, 1, 1)];
  second[2] = d[cag_partial(ORDER, 0, 2)];
  return true;
}

// Evaluates both sides. Returns false with the status CAG_OK if a side has no normal there or the
// normals are far from parallel.
static bool look_at_both(CagMarch *m, const CagMarchNode *node, Pair *out) {
  CagVec3 second[2][3];
  for (int k = 0; k < 2; k++)
    if (!look_at_side(m, k, node, &out->t[k], second[k])) return false;
  const CagVec3 n0 = out->t[0].normal, n1 = out->t[1].normal;
  const double cosine = cag_dot(n0, n1), sense = cosine < 0 ? -1 : 1;
  if (!(fabs(cosine) > 0.5)) return false;
  out->normal = cag_unit(cag_madd(n1, sense, n0));
  const CagVec3 n = out->normal, other = fabs(n.x) > 0.7 ? cag_vec3(0, 1, 0) : cag_vec3(1, 0, 0);
  out->e1 = cag_unit(cag_cross(n, other));
  out->e2 = cag_cross(n, out->e1);
  for (int k = 0; k < 2; k++) {
    const double s = k ? 1 : sense;
    out->shape[k] = (Shape){s * curvature_along(&out->t[k], second[k], out->e1, out->e1),
                            s * curvature_along(&out->t[k], second[k], out->e1, out->e2),
                            s * curvature_along(&out->t[k], second[k], out->e2, out->e2)};
  }
  const CagVec3 off = cag_sub(out->t[0].p, out->t[1].p),
                turned = cag_sub(cag_scaled(n0, sense), n1);
  out->beside = (Plane2){cag_dot(off, out->e1), cag_dot(off, out->e2)};
  out->turned = (Plane2){cag_dot(turned, out->e1), cag_dot(turned, out->e2)};
  out->gap = cag_dot(off, n);
  return true;
}

// Computes the eigenvalues and eigenvectors of the matrix, sorted by magnitude.
static void eigen(const Shape *w, double *small, double *large, Plane2 *kernel) {
  const double middle = (w->xx + w->yy) / 2, spread = hypot((w->xx - w->yy) / 2, w->xy),
               turn = atan2(w->xy, (w->xx - w->yy) / 2) / 2;
  // (cos, sin) of the angle belong to the eigenvalue middle + spread.
  const bool first = fabs(middle + spread) < fabs(middle - spread);
  *small = first ? middle + spread : middle - spread;
  *large = first ? middle - spread : middle + spread;
  *kernel = first ? (Plane2){cos(turn), sin(turn)} : (Plane2){-sin(turn), cos(turn)};
}

// Finds the step a that solves M a = g in the plane n x = h, or across the kernel. Returns false if
// there is none.
static bool solve(const Shape *m, Plane2 g, Plane2 n, double h, double least, Plane2 *out) {
  const double nn = hypot(n.x, n.y);
  if (nn > 0) {
    const Plane2 along = {n.x / nn, n.y / nn}, across = {-along.y, along.x};
    const double by = h / nn;
    const Plane2 one = apply(m, along), two = apply(m, across);
    const double square = two.x * two.x + two.y * two.y;
    if (!(square > least * least)) return false;
    const double x = (two.x * (g.x - by * one.x) + two.y * (g.y - by * one.y)) / square;
    *out = (Plane2){by * along.x + x * across.x, by * along.y + x * across.y};
    return true;
  }
  double small, large;
  Plane2 kernel;
  eigen(m, &small, &large, &kernel);
  if (!(fabs(large) > least)) return false;
  const Plane2 across = {-kernel.y, kernel.x};
  const double x = (g.x * across.x + g.y * across.y) / large,
               y = (g.x * kernel.x + g.y * kernel.y) * small /
                   (small * small + DAMPING * DAMPING * large * large);
  *out = (Plane2){x * across.x + y * kernel.x, x * across.y + y * kernel.y};
  return true;
}

static Shape difference_of(const Pair *p) {
  return (Shape){p->shape[0].xx - p->shape[1].xx, p->shape[0].xy - p->shape[1].xy,
                 p->shape[0].yy - p->shape[1].yy};
}

// Smaller differences of curvatures count as none.
static double least_curvature(const CagMarch *m, const Pair *p) {
  return SAME_CURVATURE * (largest(&p->shape[0]) + largest(&p->shape[1])) + DBL_EPSILON / m->size;
}

static CagVec3 in_space(const Pair *p, Plane2 a) {
  return cag_madd(cag_scaled(p->e1, a.x), a.y, p->e2);
}

// The gap that counts as none: parabolas with this difference of curvature cross at the sine
// sqrt(2 gap curvature).
static double gap_most(const CagMarch *m, double curvature) {
  const double sine = CAG_MARCH_TOUCH, same = CAG_MARCH_SAME * m->size;
  return fmax(same, fmin(NEAR * m->size, sine * sine / (2 * curvature + DBL_MIN)));
}

static CagMarchFound finish(const CagMarch *m, const Pair *p, double off, const Shape *difference,
                            CagVec3 along, CagMarchNode *node) {
  double small, large;
  Plane2 kernel;
  eigen(difference, &small, &large, &kernel);
  const double beside = hypot(p->beside.x, p->beside.y) + fabs(off);
  if (!(beside <= CAG_MARCH_SAME * m->size && fabs(p->gap) <= gap_most(m, fabs(large))) ||
      hypot(p->turned.x, p->turned.y) > CAG_MARCH_TOUCH)
    return CAG_MARCH_NONE;
  // Otherwise it is a single point, however slowly the surfaces separate.
  if (fabs(small) > ALONG * (largest(&p->shape[0]) + largest(&p->shape[1]))) return CAG_MARCH_NONE;
  node->x = cag_lerp(p->t[0].p, p->t[1].p, 0.5);
  node->tangent = cag_unit(in_space(p, kernel));
  if (cag_dot(node->tangent, along) < 0) node->tangent = cag_scaled(node->tangent, -1);
  return CAG_MARCH_FOUND;
}

CagMarchFound cag_march_locate_touch(CagMarch *m, CagVec3 q, CagVec3 n, CagVec3 along,
                                     CagMarchNode *node) {
  const bool planar = cag_norm(n) > 0;
  double last = INFINITY;
  for (int i = 0; i < NEWTON_STEPS; i++) {
    Pair p;
    if (!look_at_both(m, node, &p)) return m->status ? CAG_MARCH_FAILED : CAG_MARCH_NONE;
    const Shape w = difference_of(&p);
    const double least = least_curvature(m, &p);
    const CagVec3 middle = cag_lerp(p.t[0].p, p.t[1].p, 0.5);
    const Plane2 towards = planar ? (Plane2){cag_dot(n, p.e1), cag_dot(n, p.e2)} : (Plane2){0, 0};
    const double off = planar ? cag_dot(n, cag_sub(q, middle)) : 0;
    const double h = off - (towards.x * p.beside.x + towards.y * p.beside.y) / 2;
    const Plane2 moved = apply(&p.shape[1], p.beside);
    Plane2 a;
    if (!solve(&w, (Plane2){p.turned.x + moved.x, p.turned.y + moved.y}, towards, h, least, &a))
      return CAG_MARCH_TANGENT;
    double length = hypot(a.x, a.y);
    const double step = length + hypot(p.beside.x, p.beside.y);
    if (step <= CAG_MARCH_SAME * m->size && (step >= last / 2 || step == 0))
      return finish(m, &p, off, &w, along, node);
    if (i > 8 && step > last / 2)
      return step <= SETTLED * m->size ? finish(m, &p, off, &w, along, node) : CAG_MARCH_NONE;
    // So close to parallel normals, the gap no longer changes much.
    if (i > 1 && fabs(p.gap) > gap_most(m, largest(&w)) + OUT_OF_REACH * largest(&w) * step * step)
      return CAG_MARCH_NONE;
    last = fmin(last, step);
    if (length > m->step_most) {
      a.x *= m->step_most / length;
      a.y *= m->step_most / length;
    }
    const Plane2 b = {a.x + p.beside.x, a.y + p.beside.y};
    cag_march_move(m, 0, &p.t[0], cag_add(p.t[0].p, in_space(&p, a)), node);
    cag_march_move(m, 1, &p.t[1], cag_add(p.t[1].p, in_space(&p, b)), node);
  }
  return CAG_MARCH_NONE;
}

// Moves the node to a place near it where both points lie on one normal. Returns false if there is
// none, or if the gap is larger than what the curvatures can close within the reach.
static bool go_to_summit(CagMarch *m, double near, double reach, CagMarchNode *node, Pair *p) {
  for (int i = 0; i < SUMMIT_STEPS; i++) {
    if (!look_at_both(m, node, p)) return false;
    const Shape w = difference_of(p);
    const Plane2 moved = apply(&p->shape[1], p->beside), none = {0, 0};
    Plane2 a;
    if (!solve(&w, (Plane2){p->turned.x + moved.x, p->turned.y + moved.y}, none, 0,
               least_curvature(m, p), &a))
      return false;
    const double length = hypot(a.x, a.y);
    const double step = length + hypot(p->beside.x, p->beside.y);
    if (step <= near) return true;
    if (fabs(p->gap) > 2 * largest(&w) * (reach * reach + step * step) || step > m->step_most)
      return false;
    const Plane2 b = {a.x + p->beside.x, a.y + p->beside.y};
    cag_march_move(m, 0, &p->t[0], cag_add(p->t[0].p, in_space(p, a)), node);
    cag_march_move(m, 1, &p->t[1], cag_add(p->t[1].p, in_space(p, b)), node);
  }
  return false;
}

// At a summit the gap g is extreme. Along a principal direction with the curvature w it is
// g + w s^2 / 2.
size_t cag_march_find_round(CagMarch *m, const CagMarchNode *seed, double reach,
                            CagMarchNode out[4]) {
  CagMarchNode node = *seed;
  Pair p;
  if (!go_to_summit(m, SUMMIT * m->step_most, reach, &node, &p)) return 0;
  const Shape w = difference_of(&p);
  const CagVec3 x = cag_lerp(p.t[0].p, p.t[1].p, 0.5);
  double curvature[2];
  Plane2 direction[2];
  size_t n = 0;
  eigen(&w, &curvature[0], &curvature[1], &direction[0]);
  direction[1] = (Plane2){-direction[0].y, direction[0].x};
  for (int i = 0; i < 4; i++) {
    const double square = -2 * p.gap / curvature[i / 2];
    if (!(square > 0 && square <= reach * reach)) continue;
    out[n] = node;
    for (int k = 0; k < 2; k++)
      cag_march_move(
          m, k, &p.t[k],
          cag_madd(x, i % 2 ? -sqrt(square) : sqrt(square), in_space(&p, direction[i / 2])),
          &out[n]);
    n++;
  }
  return n;
}

// Along the direction d across the curve, the gap changes at the rate -n d and the curvatures
// differ by d (W1 - W2) d. The parabola with these derivatives has its second root at 2 n d / d (W1
// - W2) d.
bool cag_march_find_twin(CagMarch *m, const CagMarchNode *node, double reach, CagMarchNode *out) {
  Pair p;
  if (!look_at_both(m, node, &p)) return false;
  const CagVec3 across = cag_unit(cag_cross(p.normal, node->tangent));
  const Plane2 d = {cag_dot(across, p.e1), cag_dot(across, p.e2)};
  const Shape w = difference_of(&p);
  const Plane2 bent = apply(&w, d);
  const double rate = 2 * (p.turned.x * d.x + p.turned.y * d.y);
  const double curvature = bent.x * d.x + bent.y * d.y;
  if (!(fabs(rate) <= reach * fabs(curvature)) || curvature == 0) return false;
  *out = *node;
  for (int k = 0; k < 2; k++)
    cag_march_move(m, k, &p.t[k], cag_madd(node->x, rate / curvature, across), out);
  return true;
}
