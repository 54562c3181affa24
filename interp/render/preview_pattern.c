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

// Factors by which the noise varies, in space and in value, as much as POV-Ray's: measured in pictures
// of its patterns `bozo` and `bumps`, whose standard deviation is 0.118 and whose correlation is 1/2
// at a distance of 0.57.
#define NOISE_FREQUENCY 0.85
#define NOISE_AMPLITUDE 0.85

// Gradient noise in about -1..1 (Perlin 2002).
static double signed_noise(CagVec3 at, uint32_t seed) {
  const CagVec3 p = cag_scaled(at, NOISE_FREQUENCY);
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
  return NOISE_AMPLITUDE * mix(plane[0], plane[1], w);
}

static double noise(CagVec3 p) { return fmin(1, fmax(0, 0.5 + 0.5 * signed_noise(p, 0))); }

// How much a pattern is stirred: the sum of noises of higher and higher frequency.
typedef struct Turbulence {
  CagVec3 amount;
  int octaves;
  double omega, lambda; // factors of the amplitude and of the frequency
} Turbulence;

static CagVec3 vector_noise(CagVec3 p) {
  return cag_vec3(signed_noise(p, 1), signed_noise(p, 2), signed_noise(p, 3));
}

static CagVec3 vector_turbulence(CagVec3 p, const Turbulence *t) {
  CagVec3 sum = {0, 0, 0};
  double frequency = 1, amplitude = 1;
  for (int k = 0; k < t->octaves; k++) {
    sum = cag_madd(sum, amplitude, vector_noise(cag_scaled(p, frequency)));
    frequency *= t->lambda;
    amplitude *= t->omega;
  }
  return sum;
}

static CagVec3 stirred(CagVec3 p, const Turbulence *t) {
  const CagVec3 n = vector_turbulence(p, t);
  return cag_add(p, cag_vec3(t->amount.x * n.x, t->amount.y * n.y, t->amount.z * n.z));
}

static double granite(CagVec3 p) {
  double sum = 0, frequency = 1;
  for (int k = 0; k < 6; k++, frequency *= 2)
    sum += fabs(signed_noise(cag_scaled(p, 4 * frequency), 0)) / frequency;
  return fmin(1, sum);
}

static double fraction_of(double x) { return x - floor(x); }
// From 0 to 1 and back, with period 1.
static double triangle_wave(double x) { return 1 - fabs(2 * fraction_of(x) - 1); }

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

// Rings about an axis along X below the ground, overlaid with fine fibers. POV-Ray stirs its wood by
// adding sines of the coordinates across the axis.
static CagColor wood(const CagMaterial *m, CagVec3 at) {
  const double s = m->texture_scale, stir = 0.08;
  const Turbulence t = {.octaves = 4, .omega = 0.5, .lambda = 2};
  const CagVec3 q = cag_add(at, cag_vec3(0, 2.3 * s, 5.1 * s));
  // The axis is turned by 2 degrees about Y and 3 degrees about Z.
  const double c2 = cos(2 * M_PI / 180), s2 = sin(2 * M_PI / 180);
  const double c3 = cos(3 * M_PI / 180), s3 = sin(3 * M_PI / 180);
  const double x = c3 * q.x + s3 * q.y, y = c3 * q.y - s3 * q.x;
  const double along = c2 * x - s2 * q.z, up = c2 * q.z + s2 * x;
  const CagVec3 p = cag_vec3(-up / s, y / s, along / (6 * s)), n = vector_turbulence(p, &t);
  const double ring = triangle_wave(
      hypot(p.x + sin(2 * M_PI * stir * (p.x + n.x)), p.y + sin(2 * M_PI * stir * (p.y + n.y))));
  const Stop base =
      STOP_AT(ring, {0, 0.05, 0}, {0.3, 0, 0}, {0.7, 0.55, 0}, {0.9, 1, 0}, {1, 0.05, 0});
  const Stop fiber = STOP_AT(granite(cag_vec3(at.x / (14 * s), at.y / (0.6 * s), at.z / (0.6 * s))),
                             {0, 1, 1}, {0.35, 1, 1}, {0.6, 1, 0.6}, {1, 1, 0.45});
  return mixed(mixed(m->color, m->color2, base.mix), m->color2, 1 - fiber.transmit);
}

// How POV-Ray stirs its marble: by one number, whose mean is not 0.
static double marble_turbulence(CagVec3 p) {
  double sum = 0, frequency = 1, amplitude = 1;
  for (int k = 0; k < 6; k++, frequency *= 2.2, amplitude *= 0.6)
    sum += amplitude * (0.5 + signed_noise(cag_scaled(p, frequency), 4));
  return sum;
}

// Waves along an axis, which is X turned by 15 degrees about Y and 40 degrees about Z.
static CagColor marble(const CagMaterial *m, CagVec3 at) {
  const double a = 15 * M_PI / 180, b = 40 * M_PI / 180;
  const CagVec3 axis = cag_vec3(cos(a) * cos(b), cos(a) * sin(b), -sin(a));
  const CagVec3 p = cag_scaled(at, 1 / m->texture_scale);
  const Stop s = STOP_AT(triangle_wave(cag_dot(p, axis) + 1.1 * marble_turbulence(p)), {0, 1, 0},
                         {0.04, 0.6, 0}, {0.14, 0.12, 0}, {0.45, 0, 0}, {0.7, 0.2, 0},
                         {0.8, 0.04, 0}, {1, 0, 0});
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

// --- Bumps ---

// Bumps and dents: noise is added to the normal, for any size of the bumps.
static CagVec3 bumped(CagVec3 p, double amount, CagVec3 normal) {
  return cag_unit(cag_madd(normal, amount, vector_noise(p)));
}

// POV-Ray finds the slope of a pattern from its values at the corners of a small tetrahedron.
#define SLOPE_STEP 0.02
#define SLOPE_FACTOR 5.0

static CagVec3 granite_bumped(CagVec3 p, double amount, CagVec3 normal) {
  static const CagVec3 corners[] = {{0.942809041, -1.0 / 3, 0},
                                    {-0.471404521, -1.0 / 3, 0.816496581},
                                    {-0.471404521, -1.0 / 3, -0.816496581},
                                    {0, 1, 0}};
  CagVec3 sum = normal;
  for (int k = 0; k < 4; k++)
    sum = cag_madd(sum, -SLOPE_FACTOR * amount * granite(cag_madd(p, SLOPE_STEP, corners[k])),
                   corners[k]);
  return cag_unit(sum);
}

static CagVec3 concrete_bumps(const CagMaterial *m, CagVec3 at, CagVec3 normal) {
  return granite_bumped(cag_scaled(at, 1 / m->texture_scale), 0.12, normal);
}

static CagVec3 clay_bumps(const CagMaterial *m, CagVec3 at, CagVec3 normal) {
  return bumped(cag_scaled(at, 1 / (0.3 * m->texture_scale)), 0.08, normal);
}

const CagPreviewPattern *cag_preview_find_pattern(const CagMaterial *m) {
  static const CagPreviewPattern patterns[] = {{"wood", wood, NULL},
                                               {"marble", marble, NULL},
                                               {"concrete", concrete, concrete_bumps},
                                               {"clay", clay, clay_bumps}};
  for (size_t i = 0; m->texture_scale > 0 && i < sizeof patterns / sizeof *patterns; i++)
    if (strcmp(m->texture, patterns[i].name) == 0) return &patterns[i];
  return NULL;
}
