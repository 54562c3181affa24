#include "geom/ray/ray_primitive.h"

#include "geom/solid/kind.h"

// Roots of a quartic are bisected and refined until they do not change any more.
enum { ROOT_STEPS = 200 };

bool cag_ray_primitive_can(const CagSolid *s) {
  return s->kind == CAG_SOLID_BOX || s->kind == CAG_SOLID_SPHERE || s->kind == CAG_SOLID_CYLINDER ||
         s->kind == CAG_SOLID_TORUS;
}

CagStatus cag_ray_primitive_set(CagRayPrimitive *p, const CagSolid *s,
                                const CagTransform *placement, CagError *err) {
  CagStatus status = cag_transform_inverse(placement, &p->back, err);
  if (status) return status;
  const double w = p->back.m[3][3];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) p->back.m[i][j] /= w;
  p->placement = *placement;
  p->solid = cag_solid_retain(s);
  return CAG_OK;
}

void cag_ray_primitive_free(CagRayPrimitive *p) {
  if (p->solid) cag_solid_release(p->solid);
}

CagBounds cag_ray_primitive_bounds(const CagRayPrimitive *p) {
  const CagSolid *s = p->solid;
  const double r = fmax(s->b, s->c);
  switch (s->kind) {
  case CAG_SOLID_BOX: {
    const CagVec3 size = cag_vec3(s->a, s->b, s->c);
    const CagVec3 low = s->centered ? cag_scaled(size, -0.5) : cag_vec3(0, 0, 0);
    return (CagBounds){low, cag_add(low, size)};
  }
  case CAG_SOLID_SPHERE: return (CagBounds){{-s->a, -s->a, -s->a}, {s->a, s->a, s->a}};
  case CAG_SOLID_CYLINDER: return (CagBounds){{-r, -r, 0}, {r, r, s->a}};
  default: {
    const double wide = s->a + s->b;
    return (CagBounds){{-wide, -wide, -s->b}, {wide, wide, s->b}};
  }
  }
}

// --- Roots ---

int cag_ray_quadratic(double a, double b, double c, double roots[2]) {
  if (a == 0) {
    if (b == 0) return 0;
    roots[0] = -c / b;
    return 1;
  }
  const double square = b * b - 4 * a * c;
  if (!(square > 0)) return 0;
  const double q = -(b + copysign(sqrt(square), b)) / 2;
  const double x = q / a, y = q != 0 ? c / q : 0;
  roots[0] = fmin(x, y);
  roots[1] = fmax(x, y);
  return roots[0] < roots[1] ? 2 : 0;
}

static double polynomial(const double *c, int degree, double t) {
  double sum = c[degree];
  for (int k = degree - 1; k >= 0; k--) sum = sum * t + c[k];
  return sum;
}

// The root between a and b, at which the signs differ: bisection, and Newton's method where it stays
// between them.
static double root_between(const double *c, const double *slope, int degree, double a, double b) {
  const bool rising = polynomial(c, degree, b) > 0;
  double t = a + (b - a) / 2;
  for (int i = 0; i < ROOT_STEPS; i++) {
    const double f = polynomial(c, degree, t);
    if (f == 0) return t;
    if ((f > 0) == rising) b = t;
    else a = t;
    const double step = f / polynomial(slope, degree - 1, t);
    double next = t - step;
    if (!(next > a && next < b)) next = a + (b - a) / 2;
    if (next == t || next <= a || next >= b) return next;
    t = next;
  }
  return t;
}

// The roots in [a, b] at which the polynomial changes its sign, ascending. Between them are roots of
// the derivative.
static int roots_in(const double *c, int degree, double a, double b, double *roots) {
  double slope[4], turns[6];
  if (degree == 1) {
    roots[0] = -c[0] / c[1];
    return c[1] != 0 && roots[0] > a && roots[0] < b;
  }
  for (int k = 0; k < degree; k++) slope[k] = (k + 1) * c[k + 1];
  const int n = roots_in(slope, degree - 1, a, b, turns + 1);
  turns[0] = a;
  turns[n + 1] = b;
  int found = 0;
  for (int i = 0; i <= n; i++) {
    const double low = polynomial(c, degree, turns[i]), high = polynomial(c, degree, turns[i + 1]);
    if ((low < 0 && high > 0) || (low > 0 && high < 0))
      roots[found++] = root_between(c, slope, degree, turns[i], turns[i + 1]);
  }
  return found;
}

// --- Lines ---

// Where a line enters and leaves a convex part, and the faces and normals there.
typedef struct Pass {
  double t[2];
  uint32_t face[2];
  CagVec3 normal[2];
} Pass;

static double component(CagVec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

// Reduces a pass to the slab low <= axis <= high.
static bool pass_slab(Pass *p, CagVec3 o, CagVec3 d, int axis, double low, double high,
                      uint32_t face_low, uint32_t face_high) {
  const double from = component(o, axis), way = component(d, axis);
  if (way == 0) return from >= low && from <= high;
  const bool up = way > 0;
  const double in = ((up ? low : high) - from) / way, out = ((up ? high : low) - from) / way;
  CagVec3 normal = {axis == 0, axis == 1, axis == 2};
  if (in > p->t[0]) {
    p->t[0] = in;
    p->face[0] = up ? face_low : face_high;
    p->normal[0] = cag_scaled(normal, up ? -1 : 1);
  }
  if (out < p->t[1]) {
    p->t[1] = out;
    p->face[1] = up ? face_high : face_low;
    p->normal[1] = cag_scaled(normal, up ? 1 : -1);
  }
  return p->t[0] < p->t[1];
}

static bool pass_box(const CagSolid *s, CagVec3 o, CagVec3 d, Pass *p) {
  const double size[3] = {s->a, s->b, s->c};
  for (uint32_t k = 0; k < 3; k++) {
    const double low = s->centered ? -size[k] / 2 : 0;
    if (!pass_slab(p, o, d, (int)k, low, low + size[k], 2 * k, 2 * k + 1)) return false;
  }
  return true;
}

static bool pass_sphere(const CagSolid *s, CagVec3 o, CagVec3 d, Pass *p) {
  // From the point of the line closest to the center, where the roots are opposite.
  const double square = cag_dot(d, d), middle = -cag_dot(o, d) / square;
  const CagVec3 foot = cag_madd(o, middle, d);
  const double rest = s->a * s->a - cag_dot(foot, foot);
  if (!(rest > 0)) return false;
  const double half = sqrt(rest / square);
  for (int k = 0; k < 2; k++) {
    const double by = k ? half : -half;
    p->t[k] = middle + by;
    p->normal[k] = cag_madd(foot, by, d);
    p->face[k] = 0;
  }
  return true;
}

// Cylinders, frustums, and cones: x^2 + y^2 = (radius + slope z)^2 in the slab 0 <= z <= height.
static bool pass_frustum(const CagSolid *s, CagVec3 o, CagVec3 d, Pass *p) {
  const double slope = (s->c - s->b) / s->a;
  const uint32_t top = s->b > 0 ? 2 : 1;
  if (!pass_slab(p, o, d, 2, 0, s->a, 1, top)) return false;
  // From the point of the slab's part that is closest to the axis, where rounding matters least.
  const double flat = d.x * d.x + d.y * d.y;
  const double nearest = flat > 0 ? -(o.x * d.x + o.y * d.y) / flat : 0;
  const double shift = fmin(fmax(nearest, p->t[0]), p->t[1]);
  const CagVec3 m = cag_madd(o, shift, d);
  const double r = s->b + slope * m.z, dr = slope * d.z;
  double roots[2];
  const double a = flat - dr * dr, b = 2 * (m.x * d.x + m.y * d.y - r * dr),
               c = m.x * m.x + m.y * m.y - r * r;
  const int n = cag_ray_quadratic(a, b, c, roots);
  double low = -INFINITY, high = INFINITY;
  if (a > 0) {
    if (n < 2) return false;
    low = roots[0];
    high = roots[1];
  } else if (n == 2) { // the line is inside of one half of the double cone, or of each in turn
    if (p->t[0] - shift < roots[0] && r + dr * roots[0] >= 0 && slope * d.z <= 0) high = roots[0];
    else low = roots[1];
  } else if (n == 1) { // parallel to a line of the cone
    if (b > 0) high = roots[0];
    else low = roots[0];
  } else if (a == 0 && c > 0) return false;
  const double side[2] = {shift + low, shift + high};
  for (int k = 0; k < 2; k++) {
    if (k == 0 ? !(side[0] > p->t[0]) : !(side[1] < p->t[1])) continue;
    const CagVec3 at = cag_madd(o, side[k], d);
    p->t[k] = side[k];
    p->face[k] = 0;
    p->normal[k] = cag_vec3(at.x, at.y, -slope * (s->b + slope * at.z));
  }
  return p->t[0] < p->t[1];
}

// (|p|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2), a quartic along the line.
static int torus_roots(const CagSolid *s, CagVec3 o, CagVec3 d, double *shift, double *roots) {
  const double big = s->a, small = s->b, square = cag_dot(d, d);
  *shift = -cag_dot(o, d) / square;
  const CagVec3 m = cag_madd(o, *shift, d);
  const double rest = (big + small) * (big + small) - cag_dot(m, m);
  if (!(rest > 0)) return 0;
  const double reach = sqrt(rest / square) * (1 + 1e-9);
  const double e = cag_dot(m, m) + big * big - small * small, f = 4 * big * big;
  const double xy = m.x * d.x + m.y * d.y, n = cag_dot(m, d);
  const double c[5] = {e * e - f * (m.x * m.x + m.y * m.y), 4 * n * e - 2 * f * xy,
                       2 * square * e + 4 * n * n - f * (d.x * d.x + d.y * d.y), 4 * square * n,
                       square * square};
  return roots_in(c, 4, -reach, reach, roots);
}

static CagVec3 torus_normal(const CagSolid *s, CagVec3 p) {
  const double rho = hypot(p.x, p.y);
  const double k = rho > 0 ? 1 - s->a / rho : 1;
  return cag_vec3(p.x * k, p.y * k, p.z);
}

static CagStatus add_crossing(const CagRayPrimitive *p, double t, uint32_t face, CagVec3 normal,
                              int sign, CagCrossings *out, CagError *err) {
  CagCrossing *c = cag_crossings_add(out, err);
  if (!c) return CAG_E_MEMORY;
  const double n[3] = {normal.x, normal.y, normal.z};
  double w[3] = {0, 0, 0};
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 3; j++) w[k] += p->back.m[j][k] * n[j];
  *c = (CagCrossing){.t = t,
                     .normal = cag_unit(cag_vec3(w[0], w[1], w[2])),
                     .u = NAN,
                     .v = NAN,
                     .face = face,
                     .sign = sign};
  return CAG_OK;
}

CagStatus cag_ray_primitive_meet(const CagRayPrimitive *p, const CagRay *line, CagCrossings *out,
                                 CagError *err) {
  const CagSolid *s = p->solid;
  const CagVec3 o = cag_transform_point(&p->back, line->origin);
  const CagVec3 d = cag_transform_vector(&p->back, line->direction);
  CagStatus status = CAG_OK;
  if (s->kind == CAG_SOLID_TORUS) {
    double shift, roots[4];
    int n = torus_roots(s, o, d, &shift, roots);
    n -= n % 2; // of a double root, rounding may leave one
    for (int i = 0; !status && i < n; i++)
      status =
          add_crossing(p, shift + roots[i], 0, torus_normal(s, cag_madd(o, shift + roots[i], d)),
                       i % 2 ? 1 : -1, out, err);
    return status;
  }
  Pass pass = {.t = {-INFINITY, INFINITY}};
  const bool met = s->kind == CAG_SOLID_BOX      ? pass_box(s, o, d, &pass)
                   : s->kind == CAG_SOLID_SPHERE ? pass_sphere(s, o, d, &pass)
                                                 : pass_frustum(s, o, d, &pass);
  for (int k = 0; met && !status && k < 2; k++)
    status = add_crossing(p, pass.t[k], pass.face[k], pass.normal[k], k ? 1 : -1, out, err);
  return status;
}

// --- Parameters ---

static double turn(double y, double x) {
  const double angle = atan2(y, x);
  return angle < 0 ? angle + 2 * M_PI : angle;
}

void cag_ray_primitive_parameters(const CagRayPrimitive *p, const CagRay *ray, CagCrossing *c) {
  const CagSolid *s = p->solid;
  const CagSurface *face = c->face < s->face_count ? s->faces[c->face] : NULL;
  const CagVec3 at = cag_transform_point(&p->back, cag_ray_point(ray, c->t));
  double slope = 0;
  switch (s->kind) {
  case CAG_SOLID_SPHERE:
    c->u = turn(at.y, at.x);
    c->v = acos(fmin(1, fmax(-1, -at.z / s->a)));
    c->angular[0] = c->angular[1] = true;
    break;
  case CAG_SOLID_TORUS:
    c->u = turn(at.y, at.x);
    c->v = turn(at.z, hypot(at.x, at.y) - s->a);
    c->angular[0] = c->angular[1] = true;
    break;
  case CAG_SOLID_CYLINDER:
    if (c->face != 0) { // the disk below is turned over
      c->u = at.x;
      c->v = c->face == 1 && s->b > 0 ? -at.y : at.y;
      break;
    }
    slope = (s->c - s->b) / s->a;
    c->u = turn(at.y, at.x);
    c->angular[0] = true;
    // Of a cone, |v| is the radius; it is negative if the radius decreases upward.
    c->v = slope == 0 ? at.z : copysign(s->b + slope * at.z, slope);
    break;
  default: {
    const double size[3] = {s->a, s->b, s->c};
    double local[3] = {at.x, at.y, at.z};
    for (int k = 0; k < 3; k++) local[k] = (local[k] + (s->centered ? size[k] / 2 : 0)) / size[k];
    const int f = (int)c->face;
    c->u = local[(f / 2 + 1 + (f % 2 == 0)) % 3];
    c->v = local[(f / 2 + 1 + f % 2) % 3];
  }
  }
  if (face && !(c->u >= face->u0)) c->u = face->u0;
}

// --- Points ---

int cag_ray_primitive_side(const CagRayPrimitive *p, CagVec3 at, double slack) {
  const double beyond =
      cag_solid_kinds[p->solid->kind].beyond(p->solid, cag_transform_point(&p->back, at));
  return fabs(beyond) <= slack ? 0 : beyond < 0 ? -1 : 1;
}

int cag_ray_form_side(const CagQuadric *q, CagVec3 p, double slack) {
  const double *c = q->c;
  const CagVec3 slope = cag_vec3(2 * c[0] * p.x + c[3] * p.y + c[5] * p.z + c[6],
                                 2 * c[1] * p.y + c[3] * p.x + c[4] * p.z + c[7],
                                 2 * c[2] * p.z + c[4] * p.y + c[5] * p.x + c[8]);
  const double value = cag_quadric_value(q, p);
  // Where the gradient vanishes too, the second derivatives determine how fast the form grows.
  double bend = 0;
  for (int i = 0; i < 6; i++) bend = fmax(bend, fabs(c[i]));
  if (fabs(value) <= cag_norm(slope) * slack + bend * slack * slack) return 0;
  return value < 0 ? -1 : 1;
}
