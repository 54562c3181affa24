// Superellipsoids: |x / a|^(2 / e) + |y / b|^(2 / e) = r^(2 / e) with r^(2 / n) + |z / c|^(2 / n) = 1
// (Barr 1981).
//
// S(u, v) = [a X(v) x(u), b X(v) y(u), c Z(v)], where (x, y) is the superellipse of exponent e at the
// polar angle u, and (X, Z) that of exponent n at v. With the polar angle as parameter, first partials
// are finite for exponents of at most 2; Barr's powers of cos and sin have infinite ones below 1.
//
// Derivatives are those of truncated Taylor series within a quadrant, in which |cos| and |sin| are
// analytic. On an axis, derivatives of |t|^k of an order above k, which are infinite unless k is an
// integer, count as 0.

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/surface/family.h"

enum { TERMS = CAG_MAX_PARTIAL + 1 };

// |cos t| or |sin t| below this is a rounding error of 0.
#define ON_AXIS 4e-16

typedef struct Superellipsoid {
  CagSurface base;
  CagVec3 half; // half of the size
  double e, n;
} Superellipsoid;

// --- Series ---

// The power m of a series whose first coefficient is not 0.
static void power_of_series(const double *c, int n, double m, double *out) {
  out[0] = pow(c[0], m);
  for (int k = 1; k <= n; k++) {
    double sum = 0;
    for (int i = 1; i <= k; i++) sum += (m * i - (k - i)) * c[i] * out[k - i];
    out[k] = sum / (k * c[0]);
  }
}

// The power m > 0 of a series that is not negative on the side of interest, and may begin with 0.
static void power_of_side(const double *c, int n, double m, double *out) {
  if (c[0] > 0) {
    power_of_series(c, n, m, out);
    return;
  }
  for (int k = 0; k <= n; k++) out[k] = 0;
  if (m != floor(m) || m > n) return;
  const int order = (int)m; // c = t q, with q[0] = 1 or -1
  power_of_series(c + 1, n - order, m, out + order);
}

static void multiply_series(const double *a, const double *b, int n, double *out) {
  for (int k = 0; k <= n; k++) {
    out[k] = 0;
    for (int i = 0; i <= k; i++) out[k] += a[i] * b[k - i];
  }
}

// The derivatives 0..order of a superellipse at an angle, on one side of it.
typedef struct Curve {
  double x[TERMS], y[TERMS];
} Curve;

static Curve superellipse(double e, double angle, int order, CagSide side) {
  double sine, cosine, c[TERMS + 1] = {0}, s[TERMS + 1] = {0};
  Curve out;
  cag_sincos(angle, &sine, &cosine);
  if (fabs(cosine) <= ON_AXIS) cosine = 0;
  if (fabs(sine) <= ON_AXIS) sine = 0;
  // The signs of cos and sin on the side.
  const double toward = side == CAG_SIDE_LEFT ? -1 : 1;
  const double of_x = cosine != 0 ? copysign(1, cosine) : copysign(1, -toward * sine);
  const double of_y = sine != 0 ? copysign(1, sine) : copysign(1, toward * cosine);
  double a = of_x * cosine, b = of_x * -sine, d = of_y * sine, f = of_y * cosine, factorial = 1;
  for (int k = 0; k <= order + 1; k++) { // one more, since a factor t is divided off
    factorial *= k > 0 ? k : 1;
    c[k] = a / factorial;
    s[k] = d / factorial;
    const double next_a = -a, next_d = -d;
    a = b;
    b = next_a;
    d = f;
    f = next_d;
  }
  const double m = 2 / e;
  double p[TERMS], q[TERMS], radius[TERMS];
  power_of_side(c, order, m, p);
  power_of_side(s, order, m, q);
  for (int k = 0; k <= order; k++) p[k] += q[k];
  power_of_series(p, order, -1 / m, radius);
  multiply_series(c, radius, order, out.x);
  multiply_series(s, radius, order, out.y);
  factorial = 1;
  for (int k = 0; k <= order; k++) {
    factorial *= k > 0 ? k : 1;
    out.x[k] *= of_x * factorial;
    out.y[k] *= of_y * factorial;
  }
  return out;
}

// --- The kind ---

static CagStatus superellipsoid_eval(const CagSurface *surface, double u, double v, int n,
                                     CagSide su, CagSide sv, CagVec3 *out, CagError *err) {
  (void)err;
  const Superellipsoid *s = (const Superellipsoid *)surface;
  const Curve around = superellipse(s->e, u, n, su), up = superellipse(s->n, v, n, sv);
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++)
      out[cag_partial(n, i, j)] =
          cag_vec3(s->half.x * up.x[j] * around.x[i], s->half.y * up.x[j] * around.y[i],
                   i == 0 ? s->half.z * up.y[j] : 0);
  return CAG_OK;
}

static CagStatus superellipsoid_grid(const CagSurface *surface, const double *us, size_t nu,
                                     const double *vs, size_t nv, CagVec3 *points, CagVec3 *du,
                                     CagVec3 *dv, CagError *err) {
  const Superellipsoid *s = (const Superellipsoid *)surface;
  Curve *up = cag_malloc((nv + 1) * sizeof *up);
  if (!up) return cag_fail_memory(err);
  for (size_t j = 0; j < nv; j++) up[j] = superellipse(s->n, vs[j], 1, CAG_SIDE_RIGHT);
  for (size_t i = 0; i < nu; i++) {
    const Curve around = superellipse(s->e, us[i], 1, CAG_SIDE_RIGHT);
    const CagVec3 p = cag_vec3(s->half.x * around.x[0], s->half.y * around.y[0], 0);
    const CagVec3 d = cag_vec3(s->half.x * around.x[1], s->half.y * around.y[1], 0);
    for (size_t j = 0; j < nv; j++) {
      const CagVec3 z = {0, 0, s->half.z};
      points[i * nv + j] = cag_madd(cag_scaled(p, up[j].x[0]), up[j].y[0], z);
      if (du) du[i * nv + j] = cag_scaled(d, up[j].x[0]);
      if (dv) dv[i * nv + j] = cag_madd(cag_scaled(p, up[j].x[1]), up[j].y[1], z);
    }
  }
  cag_free(up);
  return CAG_OK;
}

// Powers that are even integers are smooth on the axes.
static bool is_smooth(double e) { return fmod(2 / e, 2) == 0; }

static size_t superellipsoid_breaks(const CagSurface *surface, int direction, double *out,
                                    size_t capacity) {
  const Superellipsoid *s = (const Superellipsoid *)surface;
  const double around[] = {M_PI / 2, M_PI, 3 * M_PI / 2}, up[] = {0};
  const size_t n = is_smooth(direction == 0 ? s->e : s->n) ? 0 : direction == 0 ? 3 : 1;
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = direction == 0 ? around[i] : up[i];
  return n;
}

static void superellipsoid_describe(const CagSurface *surface, char *buffer, size_t size) {
  const Superellipsoid *s = (const Superellipsoid *)surface;
  char x[32], y[32], z[32], e[32], n[32];
  snprintf(buffer, size, "size [%s, %s, %s], e %s, n %s", cag_number_text(2 * s->half.x, x),
           cag_number_text(2 * s->half.y, y), cag_number_text(2 * s->half.z, z),
           cag_number_text(s->e, e), cag_number_text(s->n, n));
}

static void superellipsoid_digest(const CagSurface *surface, CagDigest *d) {
  const Superellipsoid *s = (const Superellipsoid *)surface;
  const double numbers[] = {s->half.x, s->half.y, s->half.z, s->e, s->n};
  for (int i = 0; i < 5; i++) cag_digest_number(d, numbers[i]);
}

static const CagSurfaceKind superellipsoid_kind = {
    .name = "superellipsoid",
    .eval = superellipsoid_eval,
    .eval_grid = superellipsoid_grid,
    .breaks = superellipsoid_breaks,
    .describe = superellipsoid_describe,
    .digest = superellipsoid_digest,
};

CagStatus cag_surface_superellipsoid(CagVec3 size, double e, double n, CagSurface **out,
                                     CagError *err) {
  CagSurface *s;
  CagStatus status = cag_surface_block(sizeof(Superellipsoid), &superellipsoid_kind, 0, 2 * M_PI,
                                       -M_PI / 2, M_PI / 2, &s, err);
  if (status) return status;
  Superellipsoid *made = (Superellipsoid *)s;
  made->half = cag_scaled(size, 0.5);
  made->e = e;
  made->n = n;
  s->angular_u = s->angular_v = true;
  s->closed_u = true;
  s->pole_v0 = s->pole_v1 = true;
  *out = s;
  return CAG_OK;
}
