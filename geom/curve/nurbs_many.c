// Evaluates many points of a NURBS curve of low degree at once.
//
// The four homogeneous coordinates form a vector register, and results are stored as whole vectors,
// each overlapping the next. The operations and their order are the same as for a single point
// (nurbs.c), and multiplications are not fused with additions, so the results are identical to the
// last bit, with or without wide registers.

#include <string.h>

#include "geom/basis/wide.h"
#include "geom/curve/nurbs.h"

typedef double Quad __attribute__((vector_size(32), aligned(8)));

// Functions with vector arguments are inlined, so the calling convention without wide registers
// does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

// The piece of t, like cag_nurbs_piece. Equally spaced cuts need no search, and so no branch that
// depends on the previous t.
INLINE size_t piece_of(const CagNurbs *c, double t, size_t last) {
  if (c->per_unit <= 0) return cag_nurbs_piece(c, t, CAG_SIDE_RIGHT, last);
  double guess = (t - c->base.start) * c->per_unit;
  size_t i = guess > 0 ? (size_t)guess : 0;
  if (i >= c->pieces) i = c->pieces - 1;
  while (i > 0 && t < c->cuts[i]) i--;
  while (i + 1 < c->pieces && t >= c->cuts[i + 1]) i++;
  return i;
}

// Value, first, and second derivative, as separate variables so that they stay in registers.
typedef struct Jet {
  Quad p, d, dd;
} Jet;

INLINE Quad load(const double *from) {
  Quad q;
  memcpy(&q, from, sizeof q);
  return q;
}

// The Taylor polynomial of degree p at s. The compiler removes derivatives that the order does not
// need.
INLINE Jet taylor(const double *a, int p, double s) {
  const Quad none = {0, 0, 0, 0}, a0 = load(a), a1 = load(a + 4);
  if (p == 1) return (Jet){a1 * s + a0, a1, none};
  const Quad a2 = load(a + 8);
  if (p == 2) return (Jet){(a2 * s + a1) * s + a0, (2 * a2) * s + a1, 2 * a2};
  const Quad a3 = load(a + 12);
  return (Jet){((a3 * s + a2) * s + a1) * s + a0, ((3 * a3) * s + 2 * a2) * s + a1,
               (6 * a3) * s + 2 * a2};
}

INLINE Quad fourth(const Quad *q) { return __builtin_shufflevector(*q, *q, 3, 3, 3, 3); }

INLINE Jet project(Jet h) {
  const Quad one = {1, 1, 1, 1}, inverse = one / fourth(&h.p), w1 = fourth(&h.d),
             w2 = fourth(&h.dd);
  Jet c;
  c.p = h.p * inverse;
  c.d = (h.d - w1 * c.p) * inverse;
  c.dd = ((h.dd - (2 * w1) * c.d) - w2 * c.p) * inverse;
  return c;
}

// The point and its derivatives at t; *piece: the last piece on input, the current one on output.
INLINE Jet evaluate(const CagNurbs *c, int p, bool rational, double t, size_t *piece) {
  *piece = piece_of(c, t, *piece);
  // Use the coefficients about the nearer end.
  const double l = t - c->cuts[*piece], r = t - c->cuts[*piece + 1];
  const bool right = l > -r;
  Jet h = taylor(c->taylor + (2 * *piece + right) * 4 * (size_t)(p + 1), p, right ? r : l);
  return rational ? project(h) : h;
}

// Writes four numbers, one more than each vector has.
INLINE void store(const Jet *h, int order, double *to) {
  memcpy(to, &h->p, sizeof h->p);
  if (order > 0) memcpy(to + 3, &h->d, sizeof h->d);
  if (order > 1) memcpy(to + 6, &h->dd, sizeof h->dd);
}

INLINE void evaluate_all(const CagNurbs *c, int p, bool rational, const double *t, size_t n,
                         int order, CagVec3 *out) {
  const size_t stride = 3 * (size_t)(order + 1);
  double *to = (double *)out;
  size_t piece = 0;
  if (n == 0) return;
  // The fourth number of each vector is overwritten by the next; the last vector has no successor.
  for (size_t i = 0; i + 1 < n; i++, to += stride) {
    const Jet h = evaluate(c, p, rational, t[i], &piece);
    store(&h, order, to);
  }
  double last[3 * 3 + 1];
  const Jet h = evaluate(c, p, rational, t[n - 1], &piece);
  store(&h, order, last);
  memcpy(to, last, stride * sizeof *to);
}

INLINE void evaluate_order(const CagNurbs *c, int p, bool rational, const double *t, size_t n,
                           int order, CagVec3 *out) {
  if (order == 0) evaluate_all(c, p, rational, t, n, 0, out);
  else if (order == 1) evaluate_all(c, p, rational, t, n, 1, out);
  else evaluate_all(c, p, rational, t, n, 2, out);
}

INLINE void evaluate_kind(const CagNurbs *c, const double *t, size_t n, int order, CagVec3 *out) {
  if (c->degree == 3 && c->rational) evaluate_order(c, 3, true, t, n, order, out);
  else if (c->degree == 3) evaluate_order(c, 3, false, t, n, order, out);
  else if (c->degree == 2 && c->rational) evaluate_order(c, 2, true, t, n, order, out);
  else if (c->degree == 2) evaluate_order(c, 2, false, t, n, order, out);
  else evaluate_order(c, 1, c->rational, t, n, order, out);
}

static void evaluate_plain(const CagNurbs *c, const double *t, size_t n, int order, CagVec3 *out) {
  evaluate_kind(c, t, n, order, out);
}

#if defined(__x86_64__) && !defined(CAG_ONE_COPY)
__attribute__((target("avx2"))) static void evaluate_wide(const CagNurbs *c, const double *t,
                                                          size_t n, int order, CagVec3 *out) {
  evaluate_kind(c, t, n, order, out);
}
static bool has_wide(void) { return __builtin_cpu_supports("avx2"); }
#else
#define evaluate_wide evaluate_plain
static bool has_wide(void) { return false; }
#endif

bool cag_nurbs_eval_many(const CagNurbs *c, const double *t, size_t n, int order, CagVec3 *out) {
  if (!c->taylor || order > 2) return false;
  if (has_wide()) evaluate_wide(c, t, n, order, out);
  else evaluate_plain(c, t, n, order, out);
  return true;
}
