#include "interp/render/preview_shade.h"

#include "base/stop.h"

// Reflections and refractions one after another, as in POV-Ray's source, and the least part of the
// light that is followed.
enum { DEPTH_MAX = 12 };
#define WEIGHT_LEAST 0.004
// Diffuse reflections one after another in pictures with the sky's light.
enum { BOUNCES_MAX = 2 };
// A ray starts this fraction of the scene's size beside the surface that it leaves.
#define START 1e-6
#define COAT_EXPONENT 600.0
// A sample of indirect light is at most this bright: brighter ones, which are rare, would be specks.
#define BRIGHTEST 12.0

// --- Chance ---

// Of x >= 0. The conversion takes less time than floor.
static double fraction_of(double x) { return x - (double)(int64_t)x; }

// The R2 sequence (Roberts 2018), which is even for any number of samples, from a start that differs
// from pixel to pixel by interleaved gradient noise (Jimenez 2014): neighbors complement each other.
static double gradient_noise(double x, double y, double dimension) {
  const double shift = 5.588238 * dimension;
  return fraction_of(52.9829189 * fraction_of(0.06711056 * (x + shift) + 0.00583715 * (y + shift)));
}

void cag_preview_roll(CagPreviewDice *d, double out[2]) {
  const double x = (double)(uint32_t)d->pixel, y = (double)(d->pixel >> 32);
  const double k = 2 * (double)d->dimension++;
  out[0] = fraction_of(gradient_noise(x, y, k) + 0.7548776662466927 * d->index);
  out[1] = fraction_of(gradient_noise(y, x, k + 1) + 0.5698402909980532 * d->index);
}

// --- Vectors and colors ---

static CagColor color_add(CagColor a, double k, CagColor b) {
  return (CagColor){a.r + k * b.r, a.g + k * b.g, a.b + k * b.b};
}
static CagColor color_product(CagColor a, CagColor b) {
  return (CagColor){a.r * b.r, a.g * b.g, a.b * b.b};
}
static CagColor color_scaled(CagColor a, double k) { return (CagColor){a.r * k, a.g * k, a.b * k}; }
static const CagColor BLACK = {0, 0, 0}, WHITE = {1, 1, 1};

static void perpendicular_pair(CagVec3 d, CagVec3 *a, CagVec3 *b) {
  const CagVec3 other = fabs(d.z) < 0.9 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  *a = cag_unit(cag_cross(d, other));
  *b = cag_cross(d, *a);
}

static CagVec3 mirrored(CagVec3 d, CagVec3 n) { return cag_madd(d, -2 * cag_dot(d, n), n); }

// --- Lights ---

// What a light sends to a point: the direction to it, the distance, and its color there.
//
// The light is that of the middle of the light source; only its shadow is that of a point of it, as
// in POV-Ray's pictures, which spares them noise.
typedef struct Beam {
  CagVec3 direction; // to the middle
  CagColor color;
  CagVec3 shadow;  // to a point of the source
  double distance; // of the point
} Beam;

// The inner part of the cone is fully lit; towards the edge, the light fades by a cubic.
static double spot_fade(const CagPreviewLamp *l, CagVec3 direction) {
  const double cosine = -cag_dot(direction, l->direction);
  if (cosine >= l->inner) return 1;
  if (cosine <= l->outer) return 0;
  const double x = (cosine - l->outer) / (l->inner - l->outer);
  return x * x * (3 - 2 * x);
}

static Beam beam_of(CagPreviewShader *s, const CagPreviewLamp *l, CagVec3 at) {
  const CagLightKind kind = l->light->kind;
  CagVec3 to = kind == CAG_LIGHT_SUN ? l->to_sun : cag_sub(l->light->position, at);
  Beam beam = {.direction = cag_unit(to), .color = l->color};
  if (!s->sketch && l->wide) {
    double chance[2];
    cag_preview_roll(&s->dice, chance);
    double x = chance[0] - 0.5, y = chance[1] - 0.5;
    if (kind == CAG_LIGHT_SUN) { // a disk
      const double radius = sqrt(chance[0]) / 2, angle = 2 * M_PI * chance[1];
      x = radius * cos(angle);
      y = radius * sin(angle);
    }
    to = cag_madd(cag_madd(to, x, l->across), y, l->over);
  }
  beam.distance = cag_norm(to);
  beam.shadow = cag_scaled(to, 1 / beam.distance);
  if (kind == CAG_LIGHT_SPOT) beam.color = color_scaled(beam.color, spot_fade(l, beam.direction));
  return beam;
}

// A point of a surface that is being shaded, with the normals on the side of the viewer.
typedef struct Spot {
  const CagPreviewHit *hit;
  const CagPreviewSurface *surface;
  CagVec3 point, normal, flat, view; // view: to the viewer
  CagColor color;
} Spot;

static double start_step(const CagPreviewWorld *w) { return START * w->radius; }

// The highlights that a light source has on the surface.
static CagColor highlight_of(const Spot *p, const Beam *beam) {
  const CagPreviewSurface *f = p->surface;
  const CagVec3 half = cag_unit(cag_add(beam->direction, p->view));
  const double shine = f->highlight * pow(fmax(0, cag_dot(p->normal, half)), f->exponent);
  CagColor sum = color_scaled(f->metal ? p->color : WHITE, shine);
  if (f->coat > 0) {
    const CagVec3 r = mirrored(cag_scaled(p->view, -1), p->normal);
    sum = color_add(sum, f->coat * pow(fmax(0, cag_dot(r, beam->direction)), COAT_EXPONENT), WHITE);
  }
  return sum;
}

// The samples of a pixel ask the lights in turn. Each stands for as many samples as do not ask it,
// so that light without shadows has no noise. With few samples, all are asked: returns their number.
static size_t lamp_in_turn(const CagPreviewShader *s, double *all) {
  const size_t n = s->world->lamp_count, samples = (size_t)s->samples;
  if (samples < 4 * n) return n;
  const size_t shift = (size_t)(s->dice.pixel ^ s->dice.pixel >> 32) % n;
  const size_t lamp = (s->dice.index + shift) % n;
  const size_t count = samples / n + ((lamp + n - shift) % n < samples % n);
  *all = (double)samples / (double)count;
  return lamp;
}

static size_t lamp_by_chance(CagPreviewShader *s, double *all) {
  double chance[2];
  cag_preview_roll(&s->dice, chance);
  *all = (double)s->world->lamp_count;
  return (size_t)(chance[0] * *all);
}

// The light of all sources that arrives at a point, weighted by the cosine, and their highlights
// (NULL: not wanted). Paths that have left a diffuse surface see no highlights, which would be
// specks.
static CagStatus light_of_sources(CagPreviewShader *s, const Spot *p, CagColor *arriving,
                                  CagColor *highlights, CagError *err) {
  const CagPreviewWorld *w = s->world;
  size_t first = 0, last = w->lamp_count;
  double all = 1; // how many the lights that are asked stand for
  *arriving = BLACK;
  if (highlights) *highlights = BLACK;
  if (!s->sketch && last > 1) {
    first = highlights ? lamp_in_turn(s, &all) : lamp_by_chance(s, &all);
    if (first < last) last = first + 1;
    else first = 0;
  }
  for (size_t i = first; i < last; i++) {
    const Beam beam = beam_of(s, &w->lamps[i], p->point);
    const double facing = cag_dot(p->normal, beam.direction);
    if (facing <= 0) continue;
    // The light comes from behind the surface itself. A sheet has only the normal of shading.
    if (p->hit->closed && cag_dot(p->flat, beam.shadow) <= 0) continue;
    const CagRay ray = {p->point, beam.shadow, start_step(s->world), beam.distance};
    CagColor passed;
    CagStatus status = cag_preview_passage(s->world, &ray, &s->work, &passed, err);
    if (status) return status;
    passed = color_product(passed, beam.color);
    *arriving = color_add(*arriving, facing * all, passed);
    if (highlights && passed.r + passed.g + passed.b > 0)
      *highlights = color_add(*highlights, all, color_product(passed, highlight_of(p, &beam)));
  }
  return CAG_OK;
}

// --- Light from everywhere ---

// A direction about the normal, with the density of the cosine.
static CagVec3 cosine_direction(CagPreviewShader *s, CagVec3 normal) {
  double chance[2];
  CagVec3 a, b;
  cag_preview_roll(&s->dice, chance);
  const double r = sqrt(chance[0]), angle = 2 * M_PI * chance[1];
  perpendicular_pair(normal, &a, &b);
  const CagVec3 side = cag_madd(cag_scaled(a, r * cos(angle)), r * sin(angle), b);
  return cag_unit(cag_madd(side, sqrt(fmax(0, 1 - chance[0])), normal));
}

static CagStatus diffuse_light(CagPreviewShader *s, const CagRay *ray, int bounces, CagColor *out,
                               CagError *err);

static CagStatus light_from_everywhere(CagPreviewShader *s, const Spot *p, int bounces,
                                       CagColor *out, CagError *err) {
  *out = s->world->ambient;
  if (s->sketch || !s->sky_light) return CAG_OK;
  const CagRay ray = {p->point, cosine_direction(s, p->normal), start_step(s->world), INFINITY};
  return diffuse_light(s, &ray, bounces, out, err);
}

static CagColor color_limited(CagColor c) {
  const double most = fmax(c.r, fmax(c.g, c.b));
  return most > BRIGHTEST ? color_scaled(c, BRIGHTEST / most) : c;
}

// The sky's light, or what stands for it where there is none.
static CagColor escaped_light(const CagPreviewShader *s, CagVec3 direction) {
  const CagPreviewSky *sky = &s->world->sky;
  return sky->lights ? color_limited(cag_preview_sky_color(sky, direction)) : s->world->ambient;
}

static Spot spot_of(const CagPreviewWorld *w, const CagRay *ray, const CagPreviewHit *hit) {
  Spot p = {.hit = hit,
            .surface = &w->surfaces[hit->material],
            .point = hit->point,
            .normal = cag_preview_normal(w, hit),
            .flat = hit->flat,
            .view = cag_scaled(ray->direction, -1),
            .color = cag_preview_color(w, hit)};
  if (cag_dot(p.flat, p.view) < 0) {
    p.flat = cag_scaled(p.flat, -1);
    p.normal = cag_scaled(p.normal, -1);
  }
  // A normal of shading that points away from the viewer is of the outline.
  if (cag_dot(p.normal, p.view) <= 0) p.normal = p.flat;
  return p;
}

// What comes along a ray that has left a diffuse surface: all surfaces count as diffuse.
static CagStatus diffuse_light(CagPreviewShader *s, const CagRay *ray, int bounces, CagColor *out,
                               CagError *err) {
  CagPreviewHit hit;
  bool met;
  CagStatus status = cag_preview_meet(s->world, ray, &s->work, &hit, &met, err);
  if (status) return status;
  if (!met) {
    *out = escaped_light(s, ray->direction);
    return CAG_OK;
  }
  const Spot p = spot_of(s->world, ray, &hit);
  CagColor direct, indirect = BLACK;
  status = light_of_sources(s, &p, &direct, NULL, err);
  if (!status && bounces + 1 < BOUNCES_MAX)
    status = light_from_everywhere(s, &p, bounces + 1, &indirect, err);
  // Of metals, the mirror's part counts as diffuse, too.
  const double kept =
      p.surface->diffuse * (1 - p.surface->passed) + (p.surface->metal ? p.surface->mirror : 0);
  *out =
      color_add(p.surface->emission, kept, color_product(color_add(direct, 1, indirect), p.color));
  *out = color_limited(*out);
  return status;
}

// --- Reflection and refraction ---

// Fresnel's equations for light that is not polarized. `eta` is the ratio of the index of refraction
// behind the surface to that in front. 1: all light is reflected.
static double fresnel(double cosine, double eta) {
  const double square = 1 - (1 - cosine * cosine) / (eta * eta);
  if (square <= 0) return 1;
  const double inner = sqrt(square);
  const double across = (cosine - eta * inner) / (cosine + eta * inner);
  const double along = (eta * cosine - inner) / (eta * cosine + inner);
  return (across * across + along * along) / 2;
}

// The part of the light that is reflected like by a mirror.
static double mirror_part(const Spot *p, double eta) {
  const CagPreviewSurface *f = p->surface;
  const double cosine = fmin(1, fmax(0, cag_dot(p->normal, p->view)));
  if (f->mirror == 0 || f->metal) return f->mirror;
  if (p->hit->closed || f->passed == 0) return f->mirror * fresnel(cosine, eta);
  return f->mirror * (0.05 + 0.95 * pow(1 - cosine, 4)); // a thin sheet
}

// The direction behind the surface. Returns false if all light is reflected.
static bool refracted(CagVec3 d, CagVec3 n, double eta, CagVec3 *out) {
  const double cosine = -cag_dot(d, n), square = 1 - (1 - cosine * cosine) / (eta * eta);
  if (square < 0) return false;
  *out = cag_unit(cag_madd(cag_scaled(d, 1 / eta), cosine / eta - sqrt(square), n));
  return true;
}

static CagStatus add_mirror(CagPreviewShader *s, const Spot *p, double part, int depth,
                            double weight, CagColor *sum, CagError *err) {
  const CagRay ray = {p->point, mirrored(cag_scaled(p->view, -1), p->normal), start_step(s->world),
                      INFINITY};
  CagColor light;
  if (cag_dot(ray.direction, p->flat) <= 0) return CAG_OK;
  CagStatus status = cag_preview_light(s, &ray, depth + 1, weight * part, &light, err);
  if (status) return status;
  *sum = color_add(*sum, part, p->surface->metal ? color_product(light, p->color) : light);
  return CAG_OK;
}

static CagStatus add_passed(CagPreviewShader *s, const Spot *p, double eta, double part, int depth,
                            double weight, CagColor *sum, CagError *err) {
  const CagVec3 d = cag_scaled(p->view, -1);
  CagRay ray = {p->point, d, start_step(s->world), INFINITY};
  CagColor light;
  // What is not refracted is reflected within the part.
  if (p->hit->closed && !refracted(d, p->normal, eta, &ray.direction))
    ray.direction = mirrored(d, p->normal);
  CagStatus status = cag_preview_light(s, &ray, depth + 1, weight * part, &light, err);
  if (status) return status;
  *sum = color_add(*sum, part, color_product(light, p->color));
  return CAG_OK;
}

CagStatus cag_preview_light(CagPreviewShader *s, const CagRay *ray, int depth, double weight,
                            CagColor *out, CagError *err) {
  CagPreviewHit hit;
  bool met;
  *out = BLACK;
  if (depth > DEPTH_MAX || weight < WEIGHT_LEAST) return CAG_OK;
  CagStatus status = cag_preview_meet(s->world, ray, &s->work, &hit, &met, err);
  if (status) return status;
  if (!met) {
    *out = cag_preview_sky_color(&s->world->sky, ray->direction);
    return CAG_OK;
  }
  const Spot p = spot_of(s->world, ray, &hit);
  const CagPreviewSurface *f = p.surface;
  CagColor direct, highlights, everywhere = BLACK;
  const double diffuse = f->diffuse * (1 - f->passed);
  status = light_of_sources(s, &p, &direct, &highlights, err);
  // Reflections show a surface by its lights and one path at most.
  if (!status && diffuse > 0)
    status = light_from_everywhere(s, &p, depth > 0 ? BOUNCES_MAX - 1 : 0, &everywhere, err);
  if (status) return status;
  const double eta = hit.leaves && hit.closed ? 1 / f->ior : f->ior;
  const double mirror = mirror_part(&p, eta);
  const CagColor arriving = color_add(direct, 1, everywhere);
  const CagColor albedo = color_scaled(p.color, diffuse);
  *out = color_add(color_add(f->emission, 1, highlights), 1, color_product(arriving, albedo));
  if (depth == 0) s->first = (CagPreviewFirst){true, arriving, albedo, p.normal, hit.t};
  if (mirror > 0) status = add_mirror(s, &p, mirror, depth, weight, out, err);
  if (!status && f->passed > 0)
    status = add_passed(s, &p, eta, f->passed * (1 - mirror), depth, weight, out, err);
  return status;
}
