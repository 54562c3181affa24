// Random numbers as pure functions.
//
// splitmix64 expands the bits of the seed to the state of xoshiro256** (Blackman and Vigna 2018).
// The upper 53 bits of each output are a number in [0, 1). All arithmetic is on integers, so a seed
// has the same list on every machine.

#include <string.h>

#include "interp/builtin/support.h"

typedef struct Generator {
  uint64_t s[4];
} Generator;

static uint64_t splitmix64(uint64_t *state) {
  uint64_t z = (*state += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

static Generator seeded(uint64_t seed) {
  Generator g;
  for (int i = 0; i < 4; i++) g.s[i] = splitmix64(&seed);
  return g;
}

static uint64_t rotated(uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }

static uint64_t next_bits(Generator *g) {
  uint64_t *s = g->s, result = rotated(s[1] * 5, 7) * 9, t = s[1] << 17;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = rotated(s[3], 45);
  return result;
}

static double next_unit(Generator *g) {
  static const double UNIT = 0x1p-53;
  return (double)(next_bits(g) >> 11) * UNIT;
}

// The source of the numbers: an interval, or the elements of a range with `by`.
typedef struct Source {
  double start, end;
  bool angle;
  const CagRange *elements; // NULL: an interval
  size_t count;
} Source;

static bool read_source(CagCall *call, CagRangeEnds over, Source *out) {
  *out = (Source){.start = over.start, .end = over.end, .angle = over.angle};
  if (!isfinite(out->start) || !isfinite(out->end))
    return cag_fail_value(call, 2, "a finite range");
  if (!cag_given(call, 2)) return true;
  const CagRange *r = CAG_AS_RANGE(call->values[2]);
  if (!r->stepped) return true;
  out->elements = r;
  if (!cag_range_count(call->vm, r, &out->count)) return false;
  return out->count > 0 || cag_fail_value(call, 2, "a range with elements");
}

static CagValue draw(Generator *g, const Source *from) {
  double u = next_unit(g), x;
  if (from->elements) {
    size_t k = (size_t)(u * (double)from->count);
    x = cag_range_element(from->elements, k < from->count ? k : from->count - 1, from->count);
  } else {
    x = from->start + u * (from->end - from->start);
  }
  return from->angle ? cag_angle(x) : cag_number(x);
}

bool cag_random_random(CagCall *call, const struct cag_random_random *a, CagValue *result) {
  enum { STEPS_BETWEEN_CHECKS = 1 << 14 };
  Source source;
  if (!read_source(call, a->over, &source)) return false;
  // Whole seeds count as integers, and others by the bits of the double.
  uint64_t bits;
  const double seed = a->seed + 0.0;
  if (seed == floor(seed) && fabs(seed) < 0x1p62) bits = (uint64_t)(int64_t)seed;
  else memcpy(&bits, &seed, sizeof bits);
  Generator g = seeded(bits);
  CagBuilder *built = cag_builder_new(call->vm);
  for (long i = 0; i < a->n; i++) {
    if (!cag_builder_add(call->vm, built, draw(&g, &source))) return false;
    if (i % STEPS_BETWEEN_CHECKS == STEPS_BETWEEN_CHECKS - 1 && !cag_keep_going(call->vm))
      return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}
