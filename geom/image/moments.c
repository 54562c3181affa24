// Moments. Those of images are separable: over each pixel, x^m y^n is integrated exactly, or taken
// at the center. Those of regions are integrals along the boundary, by Green's theorem.

#include "geom/image/moments.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/line_integral.h"

// Relative tolerance of an integral over a smooth piece of a boundary.
#define INTEGRAL 1e-12
// A polar moment below this fraction of its largest possible size is 0.
#define NO_TURN 1e-9

// The mixed moments of a polar moment, and the two that measure the spread.
#define ORDERS_MOST (CAG_POLAR_MOMENT_MOST + 3)

// Mixed moments x^a[i] y^b[i].
typedef struct Orders {
  int count;
  int a[ORDERS_MOST], b[ORDERS_MOST];
} Orders;

// What is known of the figure first.
typedef struct Center {
  double area, x, y; // the centroid, y up
} Center;

// --- Images ---

static CagStatus check_weight(double w, size_t x, size_t y, CagError *err) {
  char text[32];
  if (w >= 0 && w < INFINITY) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_gray_weight, "", -1,
                  "expected finite gray values of at least 0, found %s at pixel [%zu, %zu]",
                  cag_number_text(w, text), x, y);
}

// The gray values of a row, 0 where there is none.
static void weights_of_row(const CagRaster *r, size_t y, double *w) {
  const double *row = cag_raster_at(r, 0, 0, y);
  for (size_t x = 0; x < r->width; x++) w[x] = isnan(row[x]) ? 0 : row[x];
}

static CagStatus raster_center(const CagRaster *r, double *w, Center *out, CagError *err) {
  double area = 0, sx = 0, sy = 0;
  for (size_t y = 0; y < r->height; y++) {
    double sum = 0;
    weights_of_row(r, y, w);
    for (size_t x = 0; x < r->width; x++) {
      CagStatus status = check_weight(w[x], x, y, err);
      if (status) return status;
      sum += w[x];
      sx += w[x] * ((double)x + 0.5);
    }
    area += sum;
    sy += sum * ((double)(r->height - y) - 0.5);
    if (cag_stopped()) return cag_stop_fail(err);
  }
  if (!(area > 0))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_image, "", -1,
                    "expected an image with gray values greater than 0, found none");
  *out = (Center){area, sx / area, sy / area};
  return CAG_OK;
}

// The integral of x^n over the interval of length 1 about x, or x^n itself.
static double pixel_power(double x, int n, CagMass mass) {
  if (mass == CAG_MASS_POINT) return pow(x, n);
  return (pow(x + 0.5, n + 1) - pow(x - 0.5, n + 1)) / (n + 1);
}

static double dot(const double *a, const double *b, size_t n) {
  // Four sums, because each addition waits for the previous one of the same sum.
  double s[4] = {0, 0, 0, 0};
  size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (int k = 0; k < 4; k++) s[k] += a[i + (size_t)k] * b[i + (size_t)k];
  for (; i < n; i++) s[0] += a[i] * b[i];
  return (s[0] + s[1]) + (s[2] + s[3]);
}

// powers[i * width + x] is the power a[i] of column x; w has room for a row.
static CagStatus sum_rows(const CagMassOf *of, const Center *c, const Orders *o, double *w,
                          double *powers, double *out, CagError *err) {
  const CagRaster *r = of->raster;
  for (int i = 0; i < o->count; i++) {
    out[i] = 0;
    for (size_t x = 0; x < r->width; x++)
      powers[(size_t)i * r->width + x] = pixel_power((double)x + 0.5 - c->x, o->a[i], of->mass);
  }
  for (size_t y = 0; y < r->height; y++) {
    const double up = (double)(r->height - y) - 0.5 - c->y;
    weights_of_row(r, y, w);
    for (int i = 0; i < o->count; i++)
      out[i] +=
          dot(w, powers + (size_t)i * r->width, r->width) * pixel_power(up, o->b[i], of->mass);
    if (cag_stopped()) return cag_stop_fail(err);
  }
  return CAG_OK;
}

static CagStatus raster_moments(const CagMassOf *of, const Orders *o, Center *c, double *out,
                                CagError *err) {
  const size_t width = of->raster->width;
  double *w = cag_malloc(width * sizeof *w);
  double *powers = cag_malloc((size_t)o->count * width * sizeof *powers);
  CagStatus status = w && powers ? CAG_OK : cag_fail_memory(err);
  if (!status) status = raster_center(of->raster, w, c, err);
  if (!status) status = sum_rows(of, c, o, w, powers, out, err);
  cag_free(w);
  cag_free(powers);
  return status;
}

// --- Regions ---

typedef struct BoundaryMoments {
  Center center;
  const Orders *orders;
} BoundaryMoments;

static double small_power(double x, int n) {
  double p = 1;
  for (; n > 0; n--) p *= x;
  return p;
}

// x^(a + 1) / (a + 1) y^b dy about the centroid.
static void boundary_integrand(void *context, CagVec3 p, CagVec3 d, double *out) {
  const BoundaryMoments *m = context;
  const double x = p.x - m->center.x, y = p.y - m->center.y;
  for (int i = 0; i < m->orders->count; i++) {
    const int a = m->orders->a[i], b = m->orders->b[i];
    out[i] = small_power(x, a + 1) / (a + 1) * small_power(y, b) * d.y;
  }
}

static CagStatus region_moments(const CagRegion *r, const Orders *o, Center *c, double *out,
                                CagError *err) {
  CagVec3 centroid = {0, 0, 0};
  double part[ORDERS_MOST];
  if (cag_region_is_empty(r))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_silhouette, "", -1,
                    "expected a region with an area, found the empty region");
  CagStatus status = cag_region_area(r, &c->area, &centroid, err);
  BoundaryMoments m = {.center = {c->area, centroid.x, centroid.y}, .orders = o};
  *c = m.center;
  for (int i = 0; i < o->count; i++) out[i] = 0;
  for (size_t k = 0; !status && k < r->count; k++) {
    const CagCurve *loop = r->loops[k];
    status = cag_curve_integrate(loop, loop->start, loop->end, boundary_integrand, &m, o->count,
                                 INTEGRAL, part, err);
    for (int i = 0; !status && i < o->count; i++) out[i] += part[i];
  }
  return status;
}

static CagStatus mixed_moments(const CagMassOf *of, const Orders *o, Center *c, double *out,
                               CagError *err) {
  return of->raster ? raster_moments(of, o, c, out, err)
                    : region_moments(of->region, o, c, out, err);
}

CagStatus cag_moment(const CagMassOf *of, int m, int n, double *out, CagError *err) {
  const Orders o = {.count = 1, .a = {m}, .b = {n}};
  Center c;
  CagStatus status = mixed_moments(of, &o, &c, out, err);
  // The centroid makes the first moments 0.
  if (!status && m + n == 1) *out = 0;
  return status;
}

// --- Polar moments ---

// The coefficients of x^a y^(n-a), a = 0..n, in the real and imaginary parts of
// (x^2 + y^2)^((n-m)/2) (x + i y)^m.
static void polar_polynomial(int m, int n, double *re, double *im) {
  for (int a = 0; a <= n; a++) re[a] = im[a] = 0;
  re[0] = 1;                   // of degree 0
  for (int k = 1; k <= m; k++) // times x + i y
    for (int a = k; a >= 0; a--) {
      const double x_re = a > 0 ? re[a - 1] : 0, x_im = a > 0 ? im[a - 1] : 0;
      const double y_re = a < k ? re[a] : 0, y_im = a < k ? im[a] : 0;
      re[a] = x_re - y_im;
      im[a] = x_im + y_re;
    }
  for (int k = m + 2; k <= n; k += 2) // times x^2 + y^2
    for (int a = k; a >= 0; a--) {
      re[a] = (a > 1 ? re[a - 2] : 0) + (a <= k - 2 ? re[a] : 0);
      im[a] = (a > 1 ? im[a - 2] : 0) + (a <= k - 2 ? im[a] : 0);
    }
}

// size: the length of the moment if the entire figure were at the same distance from the centroid.
static CagStatus polar_with_size(const CagMassOf *of, int m, int n, double out[2], double *size,
                                 CagError *err) {
  double re[CAG_POLAR_MOMENT_MOST + 1], im[CAG_POLAR_MOMENT_MOST + 1];
  double mixed[ORDERS_MOST];
  Orders o = {.count = n + 3};
  Center c;
  polar_polynomial(m, n, re, im);
  for (int a = 0; a <= n; a++) {
    o.a[a] = a;
    o.b[a] = n - a;
  }
  o.a[n + 1] = o.b[n + 2] = 2;
  CagStatus status = mixed_moments(of, &o, &c, mixed, err);
  if (status) return status;
  out[0] = out[1] = 0;
  for (int a = 0; a <= n; a++) {
    out[0] += re[a] * mixed[a];
    out[1] += im[a] * mixed[a];
  }
  *size = c.area * pow((mixed[n + 1] + mixed[n + 2]) / c.area, n / 2.0);
  if (m == 1 && n == 1) out[0] = out[1] = 0; // as for mixed moments
  return CAG_OK;
}

CagStatus cag_polar_moment(const CagMassOf *of, int m, int n, double out[2], CagError *err) {
  double size;
  return polar_with_size(of, m, n, out, &size, err);
}

CagStatus cag_turn_between(const CagMassOf *reference, const CagMassOf *seen, int m, bool *defined,
                           double *angle, CagError *err) {
  const int n = m == 1 ? 3 : m;
  const double period = 360.0 / m;
  double a[2], b[2], size_a, size_b;
  CagStatus status = polar_with_size(reference, m, n, a, &size_a, err);
  if (!status) status = polar_with_size(seen, m, n, b, &size_b, err);
  if (status) return status;
  *defined = hypot(a[0], a[1]) > NO_TURN * size_a && hypot(b[0], b[1]) > NO_TURN * size_b;
  if (!*defined) return CAG_OK;
  // The angle from a to b, by the quotient of the complex numbers.
  const double turn = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
  *angle = turn * (180 / M_PI) / m;
  if (*angle < 0) *angle += period;
  if (*angle >= period) *angle -= period;
  return CAG_OK;
}
