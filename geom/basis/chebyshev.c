// Piecewise Chebyshev interpolation at the extrema of T_16, so that pieces share their ends.

#include "geom/basis/chebyshev.h"

#include <math.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"

#define DEGREE 16
#define COUNT (DEGREE + 1)
#define ORDERS (CAG_CHEBYSHEV_DERIVATIVES + 1)
#define MAX_DEPTH 26
// If the function is not resolved on a piece this short relative to the whole, it has a kink or a
// jump there.
#define JUMP_SHARE 1e-3
// The first derivative jumps if its two limits differ by more than this fraction.
#define KINK 1e-5
// Joints closer than this fraction of the interval belong to the same kink.
#define SAME_KINK 1e-6

typedef struct Piece {
  double a, b;
  double *series; // part, derivative, coefficient of T_i
} Piece;

struct CagChebyshev {
  int references, parts;
  double a, b;
  size_t count, room;
  Piece *pieces;
  double *size; // largest value of each part
};

typedef struct Fit {
  CagChebyshev *c;
  CagSampled f;
  void *context;
  double tolerance;
  const char *name;
} Fit;

CagChebyshev *cag_chebyshev_retain(const CagChebyshev *c) {
  CagChebyshev *mine = (CagChebyshev *)c;
  if (mine) mine->references++;
  return mine;
}

void cag_chebyshev_release(CagChebyshev *c) {
  if (!c || --c->references > 0) return;
  for (size_t i = 0; i < c->count; i++) cag_free(c->pieces[i].series);
  cag_free(c->pieces);
  cag_free(c->size);
  cag_free(c);
}

// Coefficients from values at cos(pi j / DEGREE).
static void transform(const double *values, size_t stride, double *out) {
  for (int k = 0; k < COUNT; k++) {
    double sum = 0;
    for (int j = 0; j < COUNT; j++) {
      double f = values[(size_t)j * stride] * cos(M_PI * ((j * k) % (2 * DEGREE)) / DEGREE);
      sum += j == 0 || j == DEGREE ? f / 2 : f;
    }
    out[k] = sum * 2 / DEGREE;
  }
  out[0] /= 2;
  out[DEGREE] /= 2;
}

// Coefficients of the derivative with respect to the piece's own parameter -1..1.
static void differentiate(const double *c, double *out) {
  double above = 0, next = 0;
  for (int k = DEGREE; k >= 0; k--) {
    double here = k < DEGREE ? above + 2 * (k + 1) * c[k + 1] : 0;
    above = next;
    next = here;
    out[k] = here;
  }
  out[0] /= 2;
}

static double clenshaw(const double *c, double x) {
  double b1 = 0, b2 = 0;
  for (int k = DEGREE; k > 0; k--) {
    double b0 = c[k] + 2 * x * b1 - b2;
    b2 = b1;
    b1 = b0;
  }
  return c[0] + x * b1 - b2;
}

static CagStatus add_piece(CagChebyshev *c, double a, double b, const double *values,
                           CagError *err) {
  if (!CAG_RESERVE(c->pieces, c->room, c->count + 1)) return cag_fail_memory(err);
  double *series = cag_malloc((size_t)c->parts * ORDERS * COUNT * sizeof *series);
  if (!series) return cag_fail_memory(err);
  for (int part = 0; part < c->parts; part++) {
    double *to = series + (size_t)part * ORDERS * COUNT;
    transform(values + part, (size_t)c->parts, to);
    // Rounding errors would grow with every derivative.
    for (int k = 0; k < COUNT; k++)
      if (fabs(to[k]) <= 1e-15 * c->size[part]) to[k] = 0;
    for (int k = 1; k < ORDERS; k++) differentiate(to + (k - 1) * COUNT, to + k * COUNT);
  }
  c->pieces[c->count++] = (Piece){a, b, series};
  return CAG_OK;
}

static bool settled(const Fit *fit, const double *values) {
  for (int part = 0; part < fit->c->parts; part++) {
    double c[COUNT];
    transform(values + part, (size_t)fit->c->parts, c);
    double most = fit->tolerance * fit->c->size[part];
    if (fabs(c[DEGREE]) + fabs(c[DEGREE - 1]) + fabs(c[DEGREE - 2]) > most) return false;
  }
  return true;
}

static CagStatus check_jump(const Fit *fit, double a, const double *values, CagError *err) {
  size_t parts = (size_t)fit->c->parts;
  char text[32];
  for (size_t part = 0; part < parts; part++) {
    double gap = fabs(values[part] - values[DEGREE * parts + part]);
    if (gap > JUMP_SHARE * fit->c->size[part])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_function_jumps, fit->name, -1,
                      "`%s` must be continuous: it jumps near %s", fit->name,
                      cag_number_text(a, text));
  }
  return CAG_OK;
}

static CagStatus sample(Fit *fit, double a, double b, double *values, CagError *err) {
  size_t parts = (size_t)fit->c->parts;
  for (size_t j = 0; j < COUNT; j++) {
    double x = cos(M_PI * (double)j / DEGREE);
    double t = j == 0 ? b : j == DEGREE ? a : (a + b) / 2 + (b - a) / 2 * x;
    CagStatus status = fit->f(fit->context, t, values + j * parts, err);
    if (status) return status;
    for (size_t part = 0; part < parts; part++) {
      double y = values[j * parts + part];
      char text[32];
      if (!isfinite(y))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, fit->name, -1,
                        "`%s` must be finite: it is not at %s", fit->name,
                        cag_number_text(t, text));
      fit->c->size[part] = fmax(fit->c->size[part], fabs(y));
    }
  }
  return CAG_OK;
}

static CagStatus divide(Fit *fit, double a, double b, int depth, CagError *err) {
  double *values = cag_malloc(COUNT * (size_t)fit->c->parts * sizeof *values);
  if (!values) return cag_fail_memory(err);
  CagStatus status = sample(fit, a, b, values, err);
  bool done = !status && (depth >= MAX_DEPTH || settled(fit, values));
  if (!status && depth >= MAX_DEPTH) status = check_jump(fit, a, values, err);
  if (!status && done) status = add_piece(fit->c, a, b, values, err);
  cag_free(values);
  if (status || done) return status;
  status = divide(fit, a, (a + b) / 2, depth + 1, err);
  return status ? status : divide(fit, (a + b) / 2, b, depth + 1, err);
}

CagStatus cag_chebyshev_fit(CagSampled f, void *context, double a, double b, int parts,
                            double tolerance, const char *name, CagChebyshev **out, CagError *err) {
  CagChebyshev *c = cag_calloc(1, sizeof *c);
  if (!c) return cag_fail_memory(err);
  *c = (CagChebyshev){.references = 1, .parts = parts, .a = a, .b = b};
  c->size = cag_calloc((size_t)parts, sizeof *c->size);
  Fit fit = {c, f, context, tolerance, name};
  CagStatus status = c->size ? divide(&fit, a, b, 0, err) : cag_fail_memory(err);
  if (status) cag_chebyshev_release(c);
  else *out = c;
  return status;
}

static const Piece *piece_at(const CagChebyshev *c, double t, bool left) {
  size_t low = 0, high = c->count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (left ? t > c->pieces[middle].a : t >= c->pieces[middle].a) low = middle;
    else high = middle;
  }
  return &c->pieces[low];
}

static void piece_series(const CagChebyshev *c, const Piece *p, double t, int n, double *out) {
  double half = (p->b - p->a) / 2, x = (t - (p->a + p->b) / 2) / half;
  if (t == p->a) x = -1;
  if (t == p->b) x = 1;
  for (int part = 0; part < c->parts; part++) {
    double factor = 1;
    for (int k = 0; k <= n; k++) {
      const double *series = p->series + ((size_t)part * ORDERS + (size_t)k) * COUNT;
      out[part * (n + 1) + k] = k < ORDERS ? clenshaw(series, x) * factor : 0;
      factor /= half * (k + 1);
    }
  }
}

void cag_chebyshev_series(const CagChebyshev *c, double t, bool left, int n, double *out) {
  piece_series(c, piece_at(c, t, left), t, n, out);
}

// With T_i(x) = cos(i acos(x)).
static CagInterval series_range(const double *c, CagInterval x) {
  const CagInterval angle = {acos(x.hi), acos(x.lo)};
  CagInterval sum = cag_interval(c[0]);
  for (int i = 1; i <= DEGREE; i++)
    if (c[i] != 0)
      sum = cag_interval_add(
          sum, cag_interval_scaled(cag_interval_cos(cag_interval_scaled(angle, i)), c[i]));
  return sum;
}

void cag_chebyshev_ranges(const CagChebyshev *c, double a, double b, int n, CagInterval *out) {
  const Piece *p = piece_at(c, a + (b - a) / 2, false);
  const double half = (p->b - p->a) / 2, middle = (p->a + p->b) / 2;
  const CagInterval x = {fmax(-1, (a - middle) / half), fmin(1, (b - middle) / half)};
  for (int part = 0; part < c->parts; part++) {
    double factor = 1;
    for (int k = 0; k <= n; k++) {
      const double *series = p->series + ((size_t)part * ORDERS + (size_t)k) * COUNT;
      out[part * (n + 1) + k] = cag_interval_scaled(series_range(series, x), factor);
      factor /= half * (k + 1);
    }
  }
}

size_t cag_chebyshev_joints(const CagChebyshev *c, double *out, size_t capacity) {
  for (size_t i = 1; i < c->count && i <= capacity; i++) out[i - 1] = c->pieces[i].a;
  return c->count - 1;
}

size_t cag_chebyshev_breaks(const CagChebyshev *c, double *out, size_t capacity) {
  size_t n = 0;
  double last = -INFINITY;
  double *side = cag_malloc(4 * (size_t)c->parts * sizeof *side);
  if (!side) return cag_note_memory(), 0;
  double *right = side + 2 * c->parts;
  for (size_t i = 1; i < c->count; i++) {
    double t = c->pieces[i].a;
    piece_series(c, &c->pieces[i - 1], t, 1, side);
    piece_series(c, &c->pieces[i], t, 1, right);
    bool kink = false;
    for (int part = 0; part < c->parts; part++) {
      double slope = c->size[part] / (c->b - c->a);
      double gap = fabs(side[2 * part + 1] - right[2 * part + 1]);
      kink = kink || gap > KINK * (slope + fabs(side[2 * part + 1]) + fabs(right[2 * part + 1]));
    }
    if (!kink || t - last <= SAME_KINK * (c->b - c->a)) continue;
    last = t;
    if (n < capacity) out[n] = t;
    n++;
  }
  cag_free(side);
  return n;
}

void cag_chebyshev_digest(const CagChebyshev *c, CagDigest *d) {
  cag_digest_word(d, (uint64_t)c->parts);
  cag_digest_word(d, c->count);
  for (size_t i = 0; i < c->count; i++) {
    const Piece *p = &c->pieces[i];
    cag_digest_number(d, p->a);
    cag_digest_number(d, p->b);
    for (int part = 0; part < c->parts; part++)
      cag_digest_numbers(d, p->series + (size_t)part * ORDERS * COUNT, COUNT);
  }
}
