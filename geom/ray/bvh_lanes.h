// Eight floats at a time, in the registers that the compiler may use: AVX2, SSE2, or none.
//
// Results may differ by roundings, since AVX2 comes with fused products. Callers therefore use these
// functions to rule things out, with a margin for roundings, and decide the rest in double precision.
// CAG_PLAIN_LANES selects plain C.

#ifndef CAG_GEOM_RAY_BVH_LANES_H
#define CAG_GEOM_RAY_BVH_LANES_H

#include <stdint.h>
#include <string.h>

#include "geom/basis/wide.h"

#define CAG_LANES 8

#if defined(__AVX2__) && defined(__FMA__) && !defined(CAG_PLAIN_LANES)

#include <immintrin.h>

typedef __m256 CagFloat8;

INLINE CagFloat8 cag_all8(float x) { return _mm256_set1_ps(x); }
// Eight bytes as numbers.
INLINE CagFloat8 cag_bytes8(const uint8_t *p) {
  return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)p)));
}
// Four floats of each.
INLINE CagFloat8 cag_halves8(const float *p, const float *q) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(q), 1);
}
INLINE void cag_store8(float *p, CagFloat8 a) { _mm256_storeu_ps(p, a); }
INLINE CagFloat8 cag_plus8(CagFloat8 a, CagFloat8 b) { return _mm256_add_ps(a, b); }
INLINE CagFloat8 cag_minus8(CagFloat8 a, CagFloat8 b) { return _mm256_sub_ps(a, b); }
INLINE CagFloat8 cag_times8(CagFloat8 a, CagFloat8 b) { return _mm256_mul_ps(a, b); }
// a b + c, and c - a b.
INLINE CagFloat8 cag_add_product8(CagFloat8 a, CagFloat8 b, CagFloat8 c) {
  return _mm256_fmadd_ps(a, b, c);
}
INLINE CagFloat8 cag_subtract_product8(CagFloat8 a, CagFloat8 b, CagFloat8 c) {
  return _mm256_fnmadd_ps(a, b, c);
}
// The second number if one of them is not a number.
INLINE CagFloat8 cag_larger8(CagFloat8 a, CagFloat8 b) { return _mm256_max_ps(a, b); }
INLINE CagFloat8 cag_smaller8(CagFloat8 a, CagFloat8 b) { return _mm256_min_ps(a, b); }
INLINE CagFloat8 cag_size8(CagFloat8 a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
// The first three floats of each half, turned: 1 2 0.
INLINE CagFloat8 cag_turn8(CagFloat8 a) { return _mm256_permute_ps(a, _MM_SHUFFLE(3, 0, 2, 1)); }
// The lanes in which a <= b, and a < b, as bits.
INLINE unsigned cag_no_larger8(CagFloat8 a, CagFloat8 b) {
  return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
}
INLINE unsigned cag_less8(CagFloat8 a, CagFloat8 b) {
  return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ));
}

#elif defined(__SSE2__) && !defined(CAG_PLAIN_LANES)

#include <emmintrin.h>

typedef struct CagFloat8 {
  __m128 a, b;
} CagFloat8;

INLINE CagFloat8 cag_all8(float x) { return (CagFloat8){_mm_set1_ps(x), _mm_set1_ps(x)}; }
INLINE CagFloat8 cag_bytes8(const uint8_t *p) {
  const __m128i zero = _mm_setzero_si128();
  const __m128i shorts = _mm_unpacklo_epi8(_mm_loadl_epi64((const __m128i *)p), zero);
  return (CagFloat8){_mm_cvtepi32_ps(_mm_unpacklo_epi16(shorts, zero)),
                     _mm_cvtepi32_ps(_mm_unpackhi_epi16(shorts, zero))};
}
INLINE CagFloat8 cag_halves8(const float *p, const float *q) {
  return (CagFloat8){_mm_loadu_ps(p), _mm_loadu_ps(q)};
}
INLINE void cag_store8(float *p, CagFloat8 a) {
  _mm_storeu_ps(p, a.a);
  _mm_storeu_ps(p + 4, a.b);
}
#define CAG_BOTH_HALVES(name, function)                                                            \
  INLINE CagFloat8 name(CagFloat8 a, CagFloat8 b) {                                                \
    return (CagFloat8){function(a.a, b.a), function(a.b, b.b)};                                    \
  }
CAG_BOTH_HALVES(cag_plus8, _mm_add_ps)
CAG_BOTH_HALVES(cag_minus8, _mm_sub_ps)
CAG_BOTH_HALVES(cag_times8, _mm_mul_ps)
CAG_BOTH_HALVES(cag_larger8, _mm_max_ps)
CAG_BOTH_HALVES(cag_smaller8, _mm_min_ps)
#undef CAG_BOTH_HALVES
INLINE CagFloat8 cag_add_product8(CagFloat8 a, CagFloat8 b, CagFloat8 c) {
  return cag_plus8(cag_times8(a, b), c);
}
INLINE CagFloat8 cag_subtract_product8(CagFloat8 a, CagFloat8 b, CagFloat8 c) {
  return cag_minus8(c, cag_times8(a, b));
}
INLINE CagFloat8 cag_size8(CagFloat8 a) {
  const __m128 sign = _mm_set1_ps(-0.0f);
  return (CagFloat8){_mm_andnot_ps(sign, a.a), _mm_andnot_ps(sign, a.b)};
}
INLINE CagFloat8 cag_turn8(CagFloat8 a) {
  return (CagFloat8){_mm_shuffle_ps(a.a, a.a, _MM_SHUFFLE(3, 0, 2, 1)),
                     _mm_shuffle_ps(a.b, a.b, _MM_SHUFFLE(3, 0, 2, 1))};
}
INLINE unsigned cag_no_larger8(CagFloat8 a, CagFloat8 b) {
  return (unsigned)(_mm_movemask_ps(_mm_cmple_ps(a.a, b.a)) |
                    _mm_movemask_ps(_mm_cmple_ps(a.b, b.b)) << 4);
}
INLINE unsigned cag_less8(CagFloat8 a, CagFloat8 b) {
  return (unsigned)(_mm_movemask_ps(_mm_cmplt_ps(a.a, b.a)) |
                    _mm_movemask_ps(_mm_cmplt_ps(a.b, b.b)) << 4);
}

#else

typedef struct CagFloat8 {
  float f[CAG_LANES];
} CagFloat8;

INLINE CagFloat8 cag_bytes8(const uint8_t *p) {
  CagFloat8 r;
  for (int i = 0; i < CAG_LANES; i++) r.f[i] = (float)p[i];
  return r;
}
INLINE CagFloat8 cag_halves8(const float *p, const float *q) {
  CagFloat8 r;
  memcpy(r.f, p, 4 * sizeof *p);
  memcpy(r.f + 4, q, 4 * sizeof *q);
  return r;
}
INLINE void cag_store8(float *p, CagFloat8 a) { memcpy(p, a.f, sizeof a.f); }
#define CAG_LANEWISE(name, parameters, expression)                                                 \
  INLINE CagFloat8 name parameters {                                                               \
    CagFloat8 r;                                                                                   \
    for (int i = 0; i < CAG_LANES; i++) r.f[i] = (expression);                                     \
    return r;                                                                                      \
  }
CAG_LANEWISE(cag_all8, (float x), x)
CAG_LANEWISE(cag_plus8, (CagFloat8 a, CagFloat8 b), a.f[i] + b.f[i])
CAG_LANEWISE(cag_minus8, (CagFloat8 a, CagFloat8 b), a.f[i] - b.f[i])
CAG_LANEWISE(cag_times8, (CagFloat8 a, CagFloat8 b), a.f[i] * b.f[i])
CAG_LANEWISE(cag_larger8, (CagFloat8 a, CagFloat8 b), a.f[i] > b.f[i] ? a.f[i] : b.f[i])
CAG_LANEWISE(cag_smaller8, (CagFloat8 a, CagFloat8 b), a.f[i] < b.f[i] ? a.f[i] : b.f[i])
CAG_LANEWISE(cag_add_product8, (CagFloat8 a, CagFloat8 b, CagFloat8 c), a.f[i] * b.f[i] + c.f[i])
CAG_LANEWISE(cag_subtract_product8, (CagFloat8 a, CagFloat8 b, CagFloat8 c),
             c.f[i] - a.f[i] * b.f[i])
CAG_LANEWISE(cag_size8, (CagFloat8 a), a.f[i] < 0 ? -a.f[i] : a.f[i])
CAG_LANEWISE(cag_turn8, (CagFloat8 a), i % 4 < 3 ? a.f[i / 4 * 4 + (i + 1) % 4 % 3] : a.f[i])
#undef CAG_LANEWISE
INLINE unsigned cag_no_larger8(CagFloat8 a, CagFloat8 b) {
  unsigned bits = 0;
  for (int i = 0; i < CAG_LANES; i++) bits |= (unsigned)(a.f[i] <= b.f[i]) << i;
  return bits;
}
INLINE unsigned cag_less8(CagFloat8 a, CagFloat8 b) {
  unsigned bits = 0;
  for (int i = 0; i < CAG_LANES; i++) bits |= (unsigned)(a.f[i] < b.f[i]) << i;
  return bits;
}

#endif

INLINE int cag_lowest_bit(unsigned bits) {
#if defined(__GNUC__)
  return __builtin_ctz(bits);
#else
  int i = 0;
  while (!(bits >> i & 1)) i++;
  return i;
#endif
}

// Starts to bring memory into the cache, of which cache lines of 64 bytes are assumed.
INLINE void cag_fetch(const void *p, size_t size) {
#if defined(__GNUC__)
  for (size_t k = 0; k < size; k += 64) __builtin_prefetch((const char *)p + k);
  __builtin_prefetch((const char *)p + size - 1);
#else
  (void)p;
  (void)size;
#endif
}

#endif
