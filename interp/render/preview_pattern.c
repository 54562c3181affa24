#include "interp/render/preview_pattern.h"

#include <stdint.h>
#include <string.h>

// --- Noise ---

static uint32_t lattice_bits(int64_t x, int64_t y, int64_t z, uint32_t seed) {
  uint64_t h = (uint64_t)x * UINT64_C(0x9e3779b97f4a7c15) ^
               (uint64_t)y * UINT64_C(0xc2b2ae3d27d4eb4f) ^
               (uint64_t)z * UINT64_C(0x165667b19e3779f9) ^ (uint64_t)seed << 32;
  h = (h ^ h >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
  h = (h ^ h >> 27) * UINT64_C(0x94d049bb133111eb);
  return (uint32_t)(h >> 32);
}

// The product of a corner's gradient, one of twelve, and the way to it.
static double corner_slope(int64_t x, int64_t y, int64_t z, CagVec3 d, uint32_t seed) {
  const uint32_t h = lattice_bits(x, y, z, seed) % 12;
  const double a = h < 8 ? d.x : d.y, b = h < 4 ? d.y : d.z;
  return (h & 1 ? -a : a) + (h & 2 ? -b : b);
}

static double eased(double t) { return t * t * t * (t * (6 * t - 15) + 10); }
static double mix(double a, double b, double t) { return a + t * (b - a); }

// Gradient noise in about -1..1 (Perlin 2002).
static double signed_noise(CagVec3 p, uint32_t seed) {
  const double fx = floor(p.x), fy = floor(p.y), fz = floor(p.z);
  const int64_t x = (int64_t)fx, y = (int64_t)fy, z = (int64_t)fz;
  const double u = eased(p.x - fx), v = eased(p.y - fy), w = eased(p.z - fz);
  double plane[2];
  for (int k = 0; k < 2; k++) {
    double row[2];
    for (int j = 0; j < 2; j++) {
      const CagVec3 d = cag_vec3(p.x - fx, p.y - fy - j, p.z - fz - k);
      row[j] = mix(corner_slope(x, y + j, z + k, d, seed),
                   corner_slope(x + 1, y + j, z + k, cag_sub(d, cag_vec3(1, 0, 0)), seed), u);
    }
    plane[k] = mix(row[0], row[1], v);
  }
  return mix(plane[0], plane[1], w);
}

static double noise(CagVec3 p) { return fmin(1, fmax(0, 0.5 + 0.5 * signed_noise(p, 0))); }

// How much a pattern is stirred: the sum of noises of higher and higher frequency.
typedef struct Turbulence {
  CagVec3 amount;
  int octaves;
  double omega, lambda; // factors of the amplitude and of the frequency
} Turbulence;

static CagVec3 stirred(CagVec3 p, const Turbulence *t) {
  CagVec3 sum = {0, 0, 0};
  double frequency = 1, amplitude = 1;
  for (int k = 0; k < t->octaves; k++) {
    const CagVec3 q = cag_scaled(p, frequency);
    sum = cag_madd(sum, amplitude,
                   cag_vec3(signed_noise(q, 1), signed_noise(q, 2), signed_noise(q, 3)));
    frequency *= t->lambda;
    amplitude *= t->omega;
  }
  return cag_add(p, cag_vec3(t->amount.x * sum.x, t->amount.y * sum.y, t->amount.z * sum.z));
}

static double granite(CagVec3 p) {
  double sum = 0, frequency = 1;
  for (int k = 0; k < 6; k++, frequency *= 2)
    sum += fabs(0.5 - noise(cag_scaled(p, 4 * frequency))) / frequency;
  return fmin(1, sum);
}

// --- Colors ---

typedef struct Stop {
  double at, mix, transmit; // position, fraction of the second color, transparency
} Stop;

static Stop stop_at(const Stop *stops, size_t n, double x) {
  size_t k = 1;
  while (k + 1 < n && x > stops[k].at) k++;
  const Stop a = stops[k - 1], b = stops[k];
  const double f = fmin(1, fmax(0, (x - a.at) / (b.at - a.at)));
  return (Stop){x, mix(a.mix, b.mix, f), mix(a.transmit, b.transmit, f)};
}
#define STOP_AT(x, ...)                                                                            \
  stop_at((const Stop[]){__VA_ARGS__}, sizeof((const Stop[]){__VA_ARGS__}) / sizeof(Stop), (x))

static CagColor mixed(CagColor a, CagColor b, double t) {
  return (CagColor){mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

static double fraction_of(double x) { return x - floor(x); }

// Rings about an axis along X below the ground, overlaid with fine fibers.
static CagColor wood(const CagMaterial *m, CagVec3 at) {
  const double s = m->texture_scale;
  const Turbulence t = {{0.08, 0.08, 0.4}, 4, 0.5, 2};
  const CagVec3 q = cag_add(at, cag_vec3(0, 2.3 * s, 5.1 * s));
  // A slight slant, and the rings' axis along X.
  const double c = cos(3 * M_PI / 180), d = sin(3 * M_PI / 180);
  const CagVec3 slanted = cag_vec3(c * q.x + d * q.y, c * q.y - d * q.x, q.z - 0.035 * q.x);
  const CagVec3 p = stirred(cag_vec3(slanted.z / s, slanted.y / s, slanted.x / (6 * s)), &t);
  const double ring = (1 + sin(2 * M_PI * hypot(p.x, p.y))) / 2;
  const Stop base =
      STOP_AT(ring, {0, 0.05, 0}, {0.3, 0, 0}, {0.7, 0.55, 0}, {0.9, 1, 0}, {1, 0.05, 0});
  const Stop fiber = STOP_AT(granite(cag_vec3(at.x / (14 * s), at.y / (0.6 * s), at.z / (0.6 * s))),
                             {0, 1, 1}, {0.35, 1, 1}, {0.6, 1, 0.6}, {1, 1, 0.45});
  return mixed(mixed(m->color, m->color2, base.mix), m->color2, 1 - fiber.transmit);
}

static CagColor marble(const CagMaterial *m, CagVec3 at) {
  const Turbulence t = {{1.1, 1.1, 1.1}, 6, 0.6, 2.2};
  const CagVec3 across = cag_unit(cag_vec3(0.72, 0.62, -0.3));
  const CagVec3 q = stirred(cag_scaled(at, 1 / m->texture_scale), &t);
  const Stop s = STOP_AT(fraction_of(cag_dot(q, across)), {0, 1, 0}, {0.04, 0.6, 0},
                         {0.14, 0.12, 0}, {0.45, 0, 0}, {0.7, 0.2, 0}, {0.8, 0.04, 0}, {1, 0, 0});
  return mixed(m->color, m->color2, s.mix);
}

static CagColor concrete(const CagMaterial *m, CagVec3 at) {
  const Turbulence t = {{1, 1, 1}, 6, 0.7, 2};
  const CagVec3 q = stirred(cag_scaled(at, 0.5 / m->texture_scale), &t);
  const Stop s = STOP_AT(noise(q), {0, 0, 0}, {0.45, 0.3, 0}, {0.75, 0.75, 0}, {1, 1, 0});
  return mixed(m->color, m->color2, s.mix);
}

static CagColor clay(const CagMaterial *m, CagVec3 at) {
  const Turbulence t = {{0.8, 0.8, 0.8}, 5, 0.5, 2};
  const double k = 1 / m->texture_scale;
  const CagVec3 q = stirred(cag_vec3(at.x * k / 3, at.y * k / 3, at.z * k), &t);
  const Stop s = STOP_AT(noise(q), {0, 0, 0}, {0.5, 0.35, 0}, {1, 1, 0});
  return mixed(m->color, m->color2, s.mix);
}

CagColor cag_preview_pattern(const CagMaterial *m, CagVec3 at) {
  static const struct {
    const char *name;
    CagColor (*color)(const CagMaterial *m, CagVec3 at);
  } PATTERNS[] = {{"wood", wood}, {"marble", marble}, {"concrete", concrete}, {"clay", clay}};
  for (size_t i = 0; m->texture_scale > 0 && i < sizeof PATTERNS / sizeof *PATTERNS; i++)
    if (strcmp(m->texture, PATTERNS[i].name) == 0) return PATTERNS[i].color(m, at);
  return m->color;
}
