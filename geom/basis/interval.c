// Intervals of numbers, and truncated power series whose coefficients are intervals.

#include "geom/basis/interval.h"

// Maximum length of a series.
#define MOST 16

CagInterval cag_interval_cos(CagInterval a) {
  const double turn = 2 * M_PI;
  CagInterval out = {cag_lower(cos(a.lo), cos(a.hi)), cag_higher(cos(a.lo), cos(a.hi))};
  // The maximum is at multiples of a full turn, the minimum half a turn later.
  if (floor(a.hi / turn) >= ceil(a.lo / turn)) out.hi = 1;
  if (floor((a.hi - M_PI) / turn) >= ceil((a.lo - M_PI) / turn)) out.lo = -1;
  return out;
}

void cag_intervals_sincos(const CagInterval *a, int n, CagInterval *s, CagInterval *c) {
  const CagInterval quarter = cag_interval(M_PI / 2);
  c[0] = cag_interval_cos(a[0]);
  s[0] = cag_interval_cos(cag_interval_sub(a[0], quarter));
  for (int k = 1; k <= n; k++) {
    s[k] = c[k] = cag_interval(0);
    for (int j = 1; j <= k; j++) {
      const CagInterval f = cag_interval_scaled(a[j], (double)j / k);
      s[k] = cag_interval_add(s[k], cag_interval_product(f, c[k - j]));
      c[k] = cag_interval_sub(c[k], cag_interval_product(f, s[k - j]));
    }
  }
}

static bool holds_zero(CagInterval a) { return !(a.lo > 0 || a.hi < 0); }

bool cag_intervals_quotient(const CagInterval *a, const CagInterval *b, int n, CagInterval *out) {
  if (holds_zero(b[0])) return false;
  const CagInterval inverse = {1 / b[0].hi, 1 / b[0].lo};
  for (int k = 0; k <= n; k++) {
    CagInterval rest = a[k];
    for (int j = 1; j <= k; j++)
      rest = cag_interval_sub(rest, cag_interval_product(b[j], out[k - j]));
    out[k] = cag_interval_product(rest, inverse);
  }
  return true;
}

void cag_intervals3_cross(const CagInterval3 *a, const CagInterval3 *b, int n, CagInterval3 *out) {
  for (int k = 0; k <= n; k++) {
    CagInterval3 sum = {{0, 0}, {0, 0}, {0, 0}};
    for (int j = 0; j <= k; j++) {
      const CagInterval3 *p = &a[j], *q = &b[k - j];
      const CagInterval x =
          cag_interval_sub(cag_interval_product(p->y, q->z), cag_interval_product(p->z, q->y));
      const CagInterval y =
          cag_interval_sub(cag_interval_product(p->z, q->x), cag_interval_product(p->x, q->z));
      const CagInterval z =
          cag_interval_sub(cag_interval_product(p->x, q->y), cag_interval_product(p->y, q->x));
      sum.x = cag_interval_add(sum.x, x);
      sum.y = cag_interval_add(sum.y, y);
      sum.z = cag_interval_add(sum.z, z);
    }
    out[k] = sum;
  }
}

void cag_intervals3_scaled(const CagInterval3 *a, const CagInterval *f, int n, CagInterval3 *out) {
  for (int k = 0; k <= n; k++) {
    CagInterval3 sum = {{0, 0}, {0, 0}, {0, 0}};
    for (int j = 0; j <= k; j++) {
      sum.x = cag_interval_add(sum.x, cag_interval_product(a[j].x, f[k - j]));
      sum.y = cag_interval_add(sum.y, cag_interval_product(a[j].y, f[k - j]));
      sum.z = cag_interval_add(sum.z, cag_interval_product(a[j].z, f[k - j]));
    }
    out[k] = sum;
  }
}

void cag_intervals3_add(const CagInterval3 *a, const CagInterval3 *b, int n, CagInterval3 *out) {
  for (int k = 0; k <= n; k++)
    out[k] = (CagInterval3){cag_interval_add(a[k].x, b[k].x), cag_interval_add(a[k].y, b[k].y),
                            cag_interval_add(a[k].z, b[k].z)};
}

void cag_intervals3_sub(const CagInterval3 *a, const CagInterval3 *b, int n, CagInterval3 *out) {
  for (int k = 0; k <= n; k++)
    out[k] = (CagInterval3){cag_interval_sub(a[k].x, b[k].x), cag_interval_sub(a[k].y, b[k].y),
                            cag_interval_sub(a[k].z, b[k].z)};
}

bool cag_intervals3_unit(const CagInterval3 *a, int n, CagInterval3 *out) {
  // f = w^(-1/2) with w = a a, by f' w = -f w' / 2.
  CagInterval w[MOST], f[MOST];
  if (n >= MOST) return false;
  for (int k = 0; k <= n; k++) {
    w[k] = cag_interval(0);
    // Terms j and k - j are equal.
    for (int j = 0; 2 * j <= k; j++) {
      const CagInterval3 *p = &a[j], *q = &a[k - j];
      const bool same = 2 * j == k;
      const CagInterval x = same ? cag_interval_square(p->x) : cag_interval_product(p->x, q->x);
      const CagInterval y = same ? cag_interval_square(p->y) : cag_interval_product(p->y, q->y);
      const CagInterval z = same ? cag_interval_square(p->z) : cag_interval_product(p->z, q->z);
      const CagInterval term = cag_interval_add(x, cag_interval_add(y, z));
      w[k] = cag_interval_add(w[k], cag_interval_scaled(term, same ? 1 : 2));
    }
  }
  if (!(w[0].lo > 0) || !isfinite(w[0].hi)) return false;
  const CagInterval inverse = {1 / w[0].hi, 1 / w[0].lo};
  f[0] = (CagInterval){1 / sqrt(w[0].hi), 1 / sqrt(w[0].lo)};
  for (int k = 1; k <= n; k++) {
    CagInterval sum = {0, 0};
    for (int j = 1; j <= k; j++)
      sum = cag_interval_add(
          sum, cag_interval_scaled(cag_interval_product(w[j], f[k - j]), (-0.5 * j - (k - j)) / k));
    f[k] = cag_interval_product(sum, inverse);
  }
  cag_intervals3_scaled(a, f, n, out);
  return true;
}
