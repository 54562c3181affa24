// Circles tangent to three circles, lines, or points (the problem of Apollonius).
//
// A circle about (x, y) with radius r touches a circle about c with radius R if |p - c| = |r + s R|
// with s = 1 (from outside) or -1 (one inside the other); a point is a circle of radius 0, and a
// line demands that the signed distance of p is s r. With w = x^2 + y^2 - r^2 all of these are
// linear in x, y, r, and w. Three of them leave a line in these four coordinates, which meets the
// quadric w = x^2 + y^2 - r^2 at most twice (Lie's geometry of spheres, as in Cecil 2008, chapter 1).
// A negative r stands for the circle with all signs reversed, so one sign is fixed.

#include <stdlib.h>

#include "geom/curve/circles.h"
#include "geom/linalg/tolerance.h"

enum { UNKNOWNS = 4, SIDES = 3 };

// Circles that are larger than the data by this factor are lines, up to rounding.
#define LARGEST 1e9
// Two roots count as one if the discriminant is below this fraction of its terms. They then differ
// by about its square root, 1e-6.
#define DOUBLE_ROOT 1e-12
// Two circles count as one if they differ by this fraction of the data: the errors of double roots
// are square roots of rounding errors.
#define TWICE 1e-6

// The three objects, moved and scaled such that all coordinates are about 1.
typedef struct Scaled {
  CagTouched touched[SIDES];
  CagVec3 origin;
  double size;
} Scaled;

static bool is_line(const CagTouched *t) { return t->radius == 0 && cag_norm(t->d) > 0; }
static bool is_point(const CagTouched *t) { return t->radius == 0 && !(cag_norm(t->d) > 0); }

// The origin is the center of what is bounded: a line extends anywhere.
static Scaled scaled(const CagTouched touched[SIDES]) {
  Scaled out = {.origin = touched[0].p};
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int i = 0; i < SIDES; i++)
    if (!is_line(&touched[i])) cag_bounds_add(&box, touched[i].p);
  if (box.min.x <= box.max.x) out.origin = cag_lerp(box.min, box.max, 0.5);
  for (int i = 0; i < SIDES; i++) {
    const CagVec3 from = cag_sub(touched[i].p, out.origin);
    const CagVec3 d = is_line(&touched[i]) ? cag_unit(touched[i].d) : cag_vec3(0, 0, 0);
    out.touched[i] = (CagTouched){from, d, touched[i].radius};
    if (is_line(&touched[i])) out.touched[i].p = cag_madd(from, -cag_dot(from, d), d);
    out.size = fmax(out.size, cag_norm(out.touched[i].p) + touched[i].radius);
  }
  if (!(out.size > 0)) out.size = 1; // three lines through one point, or three equal points
  for (int i = 0; i < SIDES; i++) {
    out.touched[i].p = cag_scaled(out.touched[i].p, 1 / out.size);
    out.touched[i].radius /= out.size;
  }
  return out;
}

// The equation row . (x, y, r, w) + row[4] = 0 of a contact.
static void contact_row(const CagTouched *t, double sign, double row[UNKNOWNS + 1]) {
  if (is_line(t)) {
    const CagVec3 n = cag_vec3(-t->d.y, t->d.x, 0);
    const double values[] = {n.x, n.y, -sign, 0, -cag_dot(n, t->p)};
    for (int i = 0; i <= UNKNOWNS; i++) row[i] = values[i];
    return;
  }
  const double r = sign * t->radius;
  const double values[] = {-2 * t->p.x, -2 * t->p.y, -2 * r, 1, cag_dot(t->p, t->p) - r * r};
  for (int i = 0; i <= UNKNOWNS; i++) row[i] = values[i];
}

static void swap(double *a, double *b) {
  const double t = *a;
  *a = *b;
  *b = t;
}

// Moves the largest remaining entry to the diagonal; false: all are 0.
static bool pivot(double m[SIDES][UNKNOWNS + 1], int at, int order[UNKNOWNS]) {
  int row = at, column = at;
  for (int i = at; i < SIDES; i++)
    for (int k = at; k < UNKNOWNS; k++)
      if (fabs(m[i][k]) > fabs(m[row][column])) {
        row = i;
        column = k;
      }
  if (!(fabs(m[row][column]) > CAG_COINCIDENT)) return false;
  for (int k = 0; k <= UNKNOWNS; k++) swap(&m[at][k], &m[row][k]);
  for (int i = 0; i < SIDES; i++) swap(&m[i][at], &m[i][column]);
  const int moved = order[at];
  order[at] = order[column];
  order[column] = moved;
  return true;
}

// Gauss-Jordan elimination with full pivoting; returns the rank. `order` is that of the unknowns in
// the columns afterwards.
static int eliminate(double m[SIDES][UNKNOWNS + 1], int order[UNKNOWNS]) {
  for (int k = 0; k < UNKNOWNS; k++) order[k] = k;
  for (int at = 0; at < SIDES; at++) {
    if (!pivot(m, at, order)) return at;
    for (int k = UNKNOWNS; k >= at; k--) m[at][k] /= m[at][at];
    for (int i = 0; i < SIDES; i++) {
      const double factor = m[i][at];
      if (i == at || factor == 0) continue;
      for (int k = at; k <= UNKNOWNS; k++) m[i][k] -= factor * m[at][k];
    }
  }
  return SIDES;
}

// The real roots of a x^2 + 2 b x + c that are not at infinity. Double ones count once.
static int quadratic_roots(double a, double b, double c, double roots[2]) {
  double rest = b * b - a * c;
  if (fabs(rest) <= DOUBLE_ROOT * (b * b + fabs(a * c))) rest = 0;
  if (rest < 0) return 0;
  const double q = -(b + (b < 0 ? -sqrt(rest) : sqrt(rest)));
  int n = 0;
  if (fabs(q) <= LARGEST * fabs(a) && a != 0) roots[n++] = q / a;
  if (rest > 0) roots[n++] = c / q;
  return n;
}

static bool is_same(const CagTangentCircle *c, CagVec3 center, double radius) {
  return cag_norm(cag_sub(c->center, center)) + fabs(c->radius - radius) <=
         TWICE * fmax(1, fmax(c->radius, radius));
}

// Adds a circle unless it is a point, one of the given circles, or known already.
static void keep_circle(const Scaled *s, CagTangentCircle c, CagTangentCircle *out, size_t *n) {
  if (!(c.radius > CAG_COINCIDENT) || c.radius > LARGEST || *n == CAG_TANGENT_CIRCLES) return;
  for (int i = 0; i < SIDES; i++)
    if (s->touched[i].radius > 0 && is_same(&c, s->touched[i].p, s->touched[i].radius)) return;
  for (size_t i = 0; i < *n; i++)
    if (is_same(&c, out[i].center, out[i].radius)) return;
  out[(*n)++] = c;
}

static double lie_product(const double a[UNKNOWNS], const double b[UNKNOWNS]) {
  return a[0] * b[0] + a[1] * b[1] - a[2] * b[2];
}

// The circles of one combination of signs. Returns false if there are infinitely many.
static bool touch_with_signs(const Scaled *s, const double signs[SIDES], CagTangentCircle *out,
                             size_t *n) {
  double m[SIDES][UNKNOWNS + 1], from[UNKNOWNS], along[UNKNOWNS], roots[2];
  int order[UNKNOWNS];
  for (int i = 0; i < SIDES; i++) contact_row(&s->touched[i], signs[i], m[i]);
  const int rank = eliminate(m, order);
  bool consistent = true;
  for (int i = rank; i < SIDES; i++)
    consistent = consistent && fabs(m[i][UNKNOWNS]) <= CAG_COINCIDENT;
  if (rank < SIDES) return !consistent;
  for (int i = 0; i < UNKNOWNS; i++) {
    from[order[i]] = i < SIDES ? -m[i][UNKNOWNS] : 0;
    along[order[i]] = i < SIDES ? -m[i][SIDES] : 1;
  }
  const int count =
      quadratic_roots(lie_product(along, along), lie_product(from, along) - along[3] / 2,
                      lie_product(from, from) - from[3], roots);
  for (int i = 0; i < count; i++) {
    double at[UNKNOWNS];
    for (int k = 0; k < UNKNOWNS; k++) at[k] = from[k] + roots[i] * along[k];
    keep_circle(s, (CagTangentCircle){cag_vec3(at[0], at[1], 0), fabs(at[2])}, out, n);
  }
  return true;
}

static int by_radius(const void *a, const void *b) {
  const CagTangentCircle *p = a, *q = b;
  const double close = TWICE * fmax(p->radius, q->radius);
  if (fabs(p->radius - q->radius) > close) return p->radius < q->radius ? -1 : 1;
  if (fabs(p->center.x - q->center.x) > close) return p->center.x < q->center.x ? -1 : 1;
  return (p->center.y > q->center.y) - (p->center.y < q->center.y);
}

CagStatus cag_circles_tangent(const CagTouched touched[3],
                              CagTangentCircle out[CAG_TANGENT_CIRCLES], size_t *n, CagError *err) {
  const Scaled s = scaled(touched);
  double signs[SIDES] = {1, 1, 1};
  int free[SIDES], count = 0;
  *n = 0;
  for (int i = 0; i < SIDES; i++)
    if (!is_point(&touched[i])) free[count++] = i;
  // The first sign is fixed.
  for (int choice = 0; choice < (count > 1 ? 1 << (count - 1) : 1); choice++) {
    for (int i = 1; i < count; i++) signs[free[i]] = choice >> (i - 1) & 1 ? -1 : 1;
    if (!touch_with_signs(&s, signs, out, n))
      return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_infinitely_many, "", -1,
                      "infinitely many circles are tangent to all three: two of them are equal, or "
                      "all three touch at one point");
  }
  for (size_t i = 0; i < *n; i++) {
    out[i].center = cag_madd(s.origin, s.size, out[i].center);
    out[i].radius *= s.size;
  }
  qsort(out, *n, sizeof *out, by_radius);
  return CAG_OK;
}
