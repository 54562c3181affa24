// The nearest point minimizes |y|^2, y = x - p, subject to q(p + y) = y.Ay + g.y + q(p) = 0. At it,
// (I + k A) y = -k g / 2 for a multiplier k, and the minimum over the whole quadric is that for which
// I + k A has no negative eigenvalue (More 1993, "Generalizations of the trust region problem",
// theorem 3.2). In the axes of A, q is monotone in k between the poles, so the multiplier is a
// simple root. If g vanishes along the axis of the pole, there may be no root (the hard case): then
// the multiplier is the pole, and the coordinate along the axis follows from q = 0.

#include "geom/surface/quadric_nearest.h"

#include <float.h>
#include <math.h>

#include "geom/linalg/tolerance.h"
#include "geom/surface/quadric_equation.h"

// Sweeps of Jacobi's method, which converges quadratically.
enum { SWEEPS = 12 };
// Iterations for the multiplier, which can be anywhere in the range of the exponents.
enum { ROOT_STEPS = 400 };
// Eigenvalues below this fraction of the largest are the rounding of zeros.
#define ZERO_EIGENVALUE (8 * DBL_EPSILON)
// Growth of the bracket of the multiplier.
#define GROWTH 8.0
// A point whose parameters map farther from it than this fraction of its coordinates is on another
// sheet.
#define SAME_POINT 1e-10
// The range of the parameters includes their rounding, relative to its width.
#define EDGE_SLACK 1e-14

// --- Axes ---

// Diagonalizes a symmetric matrix by rotations (Golub and Van Loan 2013, section 8.5): a becomes
// diagonal, and the columns of v are the axes.
static void find_axes(double a[3][3], double v[3][3]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) v[i][j] = i == j;
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    const double off = fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]);
    if (off == 0) return;
    for (int k = 0; k < 3; k++) {
      const int i = k == 2 ? 1 : 0, j = k == 0 ? 1 : 2;
      if (a[i][j] == 0) continue;
      const double theta = (a[j][j] - a[i][i]) / (2 * a[i][j]);
      const double t = copysign(1, theta) / (fabs(theta) + hypot(theta, 1));
      const double c = 1 / hypot(t, 1), s = t * c;
      for (int m = 0; m < 3; m++) {
        const double x = a[m][i], y = a[m][j];
        a[m][i] = c * x - s * y;
        a[m][j] = s * x + c * y;
      }
      for (int m = 0; m < 3; m++) {
        const double x = a[i][m], y = a[j][m], e = v[m][i], f = v[m][j];
        a[i][m] = c * x - s * y;
        a[j][m] = s * x + c * y;
        v[m][i] = c * e - s * f;
        v[m][j] = s * e + c * f;
      }
      a[i][j] = a[j][i] = 0;
    }
  }
}

// --- The multiplier ---

// The form about p in its axes, a.y^2 + g.y + value, with value >= 0. The multiplier is
// k = z / (1 + z m), z >= 0, where m >= 0 makes all of c = m + a nonnegative: then
// y = -z g / (2 (1 + z c)) is accurate for all z.
typedef struct Secular {
  double a[3], g[3], c[3], m, value;
} Secular;

static double secular_at(const Secular *f, double z, double y[3], double *slope) {
  double sum = f->value;
  *slope = 0;
  for (int i = 0; i < 3; i++) {
    const double w = 1 + z * f->c[i];
    y[i] = f->g[i] == 0 ? 0 : -f->g[i] / 2 * (z / w);
    sum += (f->a[i] * y[i] + f->g[i]) * y[i];
    *slope -= (2 * f->a[i] * y[i] + f->g[i]) * f->g[i] / (2 * w * w);
  }
  return sum;
}

// The limit of y for z to infinity; false if it is infinite.
static bool secular_limit(const Secular *f, double y[3], double *value) {
  *value = f->value;
  for (int i = 0; i < 3; i++) {
    if (f->g[i] == 0) y[i] = 0;
    else if (f->c[i] == 0) return false;
    else y[i] = -f->g[i] / (2 * f->c[i]);
    *value += (f->a[i] * y[i] + f->g[i]) * y[i];
  }
  return true;
}

// The root: Newton's method, kept in a bracket whose ends may differ by orders of magnitude.
static void find_root(const Secular *f, double y[3]) {
  double square = 0, slope;
  for (int i = 0; i < 3; i++) square += f->g[i] * f->g[i];
  double low = 0, high = INFINITY, z = 2 * f->value / square;
  if (!(z > 0) || !isfinite(z)) z = z > 0 ? DBL_MAX / GROWTH : DBL_MIN;
  for (int k = 0; k < ROOT_STEPS; k++) {
    const double value = secular_at(f, z, y, &slope);
    if (value == 0) return;
    if (value > 0) low = z;
    else high = z;
    double next = z - value / slope;
    if (!(next > low && next < high))
      next = !isfinite(high)       ? low * GROWTH
             : low == 0            ? high / GROWTH
             : high > low * GROWTH ? sqrt(low) * sqrt(high)
                                   : low + (high - low) / 2;
    if (!(fabs(next - z) > DBL_EPSILON * z) || !isfinite(next)) return;
    z = next;
  }
}

// y from the form about p. Returns false if the equation has no real solution.
static bool solve_secular(Secular *f, double y[3]) {
  double limit, least = INFINITY, rounding = 0;
  int axis = 0;
  for (int i = 0; i < 3; i++) {
    rounding = fmax(rounding, fabs(f->g[i]));
    if (f->a[i] < least) {
      least = f->a[i];
      axis = i;
    }
  }
  f->m = fmax(0, -least);
  for (int i = 0; i < 3; i++) f->c[i] = f->a[i] == least && f->m > 0 ? 0 : f->m + f->a[i];
  if (f->value == 0) {
    y[0] = y[1] = y[2] = 0;
    return true;
  }
  if (!secular_limit(f, y, &limit) || limit < 0) {
    find_root(f, y);
    return true;
  }
  // The hard case, or, of a form that is positive elsewhere, a single point or none.
  if (f->m > 0) {
    y[axis] = sqrt(limit / f->m);
    return true;
  }
  double size = rounding * rounding;
  for (int i = 0; i < 3; i++) size = fmax(size, fabs(f->a[i]) * f->value);
  return limit * fabs(f->a[0] + f->a[1] + f->a[2]) <= CAG_ROUNDING * size;
}

bool cag_quadric_closest(const CagQuadric *q, CagVec3 p, CagVec3 *out) {
  const double *c = q->c;
  double a[3][3] = {
      {c[0], c[3] / 2, c[5] / 2}, {c[3] / 2, c[1], c[4] / 2}, {c[5] / 2, c[4] / 2, c[2]}};
  double axes[3][3], y[3], largest = 0;
  find_axes(a, axes);
  for (int i = 0; i < 3; i++) largest = fmax(largest, fabs(a[i][i]));
  const CagVec3 slope = cag_quadric_gradient(q, p);
  const double g[3] = {slope.x, slope.y, slope.z}, value = cag_quadric_value(q, p);
  const double sign = value < 0 ? -1 : 1;
  Secular f = {.value = fabs(value)};
  for (int i = 0; i < 3; i++) {
    f.a[i] = fabs(a[i][i]) <= ZERO_EIGENVALUE * largest ? 0 : sign * a[i][i];
    for (int j = 0; j < 3; j++) f.g[i] += sign * axes[j][i] * g[j];
  }
  if (!solve_secular(&f, y)) return false;
  double x[3] = {p.x, p.y, p.z};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) x[i] += axes[i][j] * y[j];
  *out = cag_vec3(x[0], x[1], x[2]);
  // A step along the gradient removes the rounding of the multiplier.
  const CagVec3 n = cag_quadric_gradient(q, *out);
  const double step = cag_quadric_value(q, *out) / cag_dot(n, n);
  if (fabs(step) * cag_norm(n) <= CAG_ROUNDING * (cag_norm(*out) + cag_norm(p)))
    *out = cag_madd(*out, -step, n);
  return isfinite(out->x + out->y + out->z);
}

// --- Surfaces ---

// The parameters of a point in units of the semi-axes: the inverse of cag_quadric_unit_point.
static void unit_parameters(CagQuadricShape shape, CagVec3 e, double at[2]) {
  at[0] = atan2(e.y, e.x);
  at[1] = e.z;
  switch (shape) {
  case CAG_SHAPE_ELLIPSOID: at[1] = atan2(hypot(e.x, e.y), e.z); break;
  case CAG_SHAPE_HYPERBOLOID_ONE: at[1] = asinh(e.z); break;
  case CAG_SHAPE_HYPERBOLOID_TWO: at[1] = asinh(hypot(e.x, e.y)); break;
  case CAG_SHAPE_CONE:
    if (e.z < 0) at[0] = atan2(-e.y, -e.x);
    break;
  case CAG_SHAPE_ELLIPTIC_PARABOLOID: at[1] = hypot(e.x, e.y); break;
  case CAG_SHAPE_HYPERBOLIC_PARABOLOID:
    at[0] = e.x;
    at[1] = e.y;
    break;
  case CAG_SHAPE_ELLIPTIC_CYLINDER: break;
  case CAG_SHAPE_PARABOLIC_CYLINDER: at[0] = e.y / 2; break;
  case CAG_SHAPE_HYPERBOLIC_CYLINDER: at[0] = asinh(e.y); break;
  }
}

// Moves a parameter into the range, if it is there, by whole turns if it is an angle.
static bool parameter_in_range(double *x, double low, double high, bool angular) {
  const double slack = EDGE_SLACK * (high - low);
  if (angular) {
    if (*x < low - slack) *x += 2 * M_PI * ceil((low - slack - *x) / (2 * M_PI));
    else if (*x > high + slack) *x -= 2 * M_PI * ceil((*x - high - slack) / (2 * M_PI));
  }
  const bool within = *x >= low - slack && *x <= high + slack;
  *x = fmin(fmax(*x, low), high);
  return within;
}

bool cag_surface_quadric_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out) {
  CagQuadric equation;
  CagTransform frame, back;
  CagQuadricShape shape;
  CagVec3 x;
  CagError err;
  double at[2];
  if (!cag_surface_quadric_view(s, &equation) || !cag_surface_quadric_frame(s, &frame) ||
      !cag_surface_quadric_shape(s, &shape) || !cag_quadric_closest(&equation, p, &x) ||
      cag_transform_inverse(&frame, &back, &err))
    return false;
  unit_parameters(shape, cag_transform_point(&back, x), at);
  const bool turns = shape != CAG_SHAPE_HYPERBOLIC_PARABOLOID &&
                     shape != CAG_SHAPE_PARABOLIC_CYLINDER &&
                     shape != CAG_SHAPE_HYPERBOLIC_CYLINDER;
  if (!parameter_in_range(&at[0], s->u0, s->u1, turns) ||
      !parameter_in_range(&at[1], s->v0, s->v1, false) ||
      cag_surface_point(s, at[0], at[1], &out->point, &err))
    return false;
  out->u = at[0];
  out->v = at[1];
  out->distance = cag_norm(cag_sub(out->point, p));
  return cag_norm(cag_sub(out->point, x)) <= SAME_POINT * (cag_norm(x) + out->distance);
}
