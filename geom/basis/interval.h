// Intervals of numbers, and truncated power series whose coefficients are intervals (Moore 1966).
//
// The result of an operation contains, up to rounding, every result for numbers from the operands.
// A series of intervals contains the Taylor coefficients of a function about every point of an
// interval, and so bounds its derivatives there.

#ifndef CAG_GEOM_INTERVAL_H
#define CAG_GEOM_INTERVAL_H

#include <math.h>
#include <stdbool.h>

typedef struct CagInterval {
  double lo, hi;
} CagInterval;

// A box: one interval for each coordinate of a point or vector.
typedef struct CagInterval3 {
  CagInterval x, y, z;
} CagInterval3;

// For numbers other than NaN, each compiles to one instruction.
static inline double cag_lower(double a, double b) { return a < b ? a : b; }
static inline double cag_higher(double a, double b) { return a > b ? a : b; }

static inline CagInterval cag_interval(double x) { return (CagInterval){x, x}; }

static inline CagInterval cag_interval_add(CagInterval a, CagInterval b) {
  return (CagInterval){a.lo + b.lo, a.hi + b.hi};
}

static inline CagInterval cag_interval_sub(CagInterval a, CagInterval b) {
  return (CagInterval){a.lo - b.hi, a.hi - b.lo};
}

static inline CagInterval cag_interval_scaled(CagInterval a, double f) {
  return f < 0 ? (CagInterval){a.hi * f, a.lo * f} : (CagInterval){a.lo * f, a.hi * f};
}

static inline CagInterval cag_interval_product(CagInterval a, CagInterval b) {
  if (a.lo == a.hi) return cag_interval_scaled(b, a.lo);
  if (b.lo == b.hi) return cag_interval_scaled(a, b.lo);
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return (CagInterval){cag_lower(cag_lower(p, q), cag_lower(r, s)),
                       cag_higher(cag_higher(p, q), cag_higher(r, s))};
}

static inline CagInterval cag_interval_square(CagInterval a) {
  const double p = a.lo * a.lo, q = a.hi * a.hi;
  return (CagInterval){a.lo <= 0 && a.hi >= 0 ? 0 : cag_lower(p, q), cag_higher(p, q)};
}

static inline CagInterval cag_interval_hull(CagInterval a, CagInterval b) {
  return (CagInterval){cag_lower(a.lo, b.lo), cag_higher(a.hi, b.hi)};
}

// The largest absolute value.
static inline double cag_interval_size(CagInterval a) { return cag_higher(fabs(a.lo), fabs(a.hi)); }

static inline double cag_interval3_size(CagInterval3 a) {
  return sqrt(cag_interval_square(a.x).hi + cag_interval_square(a.y).hi +
              cag_interval_square(a.z).hi);
}

// The cosine of the angles in the interval.
CagInterval cag_interval_cos(CagInterval a);

// --- Series ---

// Coefficients 0..n. Results must not overlap operands.

// Sine and cosine of the series.
void cag_intervals_sincos(const CagInterval *a, int n, CagInterval *s, CagInterval *c);
// a / b. Returns false if b may be 0.
bool cag_intervals_quotient(const CagInterval *a, const CagInterval *b, int n, CagInterval *out);
void cag_intervals3_cross(const CagInterval3 *a, const CagInterval3 *b, int n, CagInterval3 *out);
void cag_intervals3_scaled(const CagInterval3 *a, const CagInterval *f, int n, CagInterval3 *out);
void cag_intervals3_add(const CagInterval3 *a, const CagInterval3 *b, int n, CagInterval3 *out);
void cag_intervals3_sub(const CagInterval3 *a, const CagInterval3 *b, int n, CagInterval3 *out);
// a / |a|. Returns false if a may be 0.
bool cag_intervals3_unit(const CagInterval3 *a, int n, CagInterval3 *out);

#endif
