// Writes materials as POV-Ray's `material`: pigment, finish, normal, and interior.
//
// A CagMaterial is a rough or smooth surface, metallic or not, possibly with a clear coat.
// POV-Ray's finish has one mirror reflection (always sharp), one broad highlight (`specular`), and
// one narrow one (`phong`). They are used as follows:
//
//   diffuse     the part that is neither metallic nor transmitted
//   specular    the highlight of the surface; its width follows from the roughness
//   phong       the highlight of the clear coat
//   reflection  Fresnel reflection for the index of refraction, as far as the surface or the coat
//               is smooth; for metals, in their color. The blurred reflection of a rough metal is
//               divided between highlight and diffuse
//
// A material is declared for closed bodies. If it is transparent and an open shape uses it, it is
// declared again as a thin sheet that does not refract.

#include <stdio.h>
#include <string.h>

#include "interp/formats/pov_write.h"
#include "interp/scene/color_scale.h"

static double clamp01(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

static CagColor mixed(CagColor a, CagColor b, double t) {
  return (CagColor){a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

static double brightness(CagColor c) { return fmax(c.r, fmax(c.g, c.b)); }

void cag_pov_material_name(const CagPovWriter *w, size_t index, bool closed, char out[64]) {
  bool thin = !closed && w->scene->materials[index].transmission > 0;
  snprintf(out, 64, "%s%s", w->material_names[index], thin ? "_thin" : "");
}

// The roughness below which a sharp reflection is visible.
#define MIRROR_ROUGHNESS 0.5
// The minimum of POV-Ray's roughness, the inverse of the specular exponent. Below it, a highlight
// is a single pixel.
#define SPECULAR_ROUGHNESS_MIN 0.0008

// Fainter reflections are omitted.
#define MIRROR_LEAST 0.01

// Returns the sharp fraction of the reflection for this roughness.
static double gloss(double roughness) {
  double g = clamp01(1 - roughness / MIRROR_ROUGHNESS);
  return g * g;
}

// Blinn's exponent for a microfacet slope a = roughness^2 is 2 / a^2 - 2 (Walter et al. 2007), and
// POV-Ray's roughness is its inverse.
static double specular_roughness(double roughness) {
  double a = roughness * roughness;
  return fmax(SPECULAR_ROUGHNESS_MIN, a * a / 2);
}

// Returns the fraction of light reflected at normal incidence (Fresnel).
static double normal_reflectance(double ior) {
  double f = (ior - 1) / (ior + 1);
  return f * f;
}

typedef struct Finish {
  double diffuse, specular, phong, mirror;
  bool metal;
} Finish;

static Finish finish_of(const CagMaterial *m) {
  double metallic = clamp01(m->metallic), rough = clamp01(m->roughness), coat = clamp01(m->coat);
  // The mirror reflection decreases with roughness, in favor of highlight and diffuse reflection.
  double mirror = metallic * 0.95 * pow(1 - rough, 1.5);
  double blurred = metallic - mirror;
  Finish f = {.metal = metallic > 0.5};
  f.diffuse = (1 - metallic) + 0.4 * blurred;
  f.specular = f.metal ? 0.35 * blurred + 0.1 : 1.5 * normal_reflectance(m->ior);
  f.phong = coat * normal_reflectance(1.5);
  f.mirror = f.metal ? mirror : fmax(gloss(rough), coat);
  return f;
}

static void write_number_line(CagPovWriter *w, const char *word, double x) {
  cag_pov_printf(w, "      %s %.4g\n", word, x);
}

static void write_mirror(CagPovWriter *w, const Finish *f, bool bends) {
  if (f->mirror < MIRROR_LEAST) return;
  if (f->metal) cag_pov_printf(w, "      reflection { %.4g metallic }\n", f->mirror);
  else if (bends) cag_pov_printf(w, "      reflection { 0, %.4g fresnel }\n", f->mirror);
  else // a thin sheet: approximately Fresnel reflection of glass
    cag_pov_printf(w, "      reflection { %.4g, %.4g falloff 4 }\n", 0.05 * f->mirror, f->mirror);
  cag_pov_text(w, "      conserve_energy\n");
}

// Emission is multiplied by the pigment's color, so it is divided by it here.
static void write_emission(CagPovWriter *w, CagColor pigment, CagColor light) {
  if (brightness(light) <= 0) return;
  cag_pov_text(w, "      emission ");
  cag_pov_color(w, (CagColor){light.r / pigment.r, light.g / pigment.g, light.b / pigment.b});
  cag_pov_text(w, "\n");
}

static void write_finish(CagPovWriter *w, const CagMaterial *m, CagColor pigment, bool bends) {
  Finish f = finish_of(m);
  cag_pov_text(w, "    finish {\n");
  write_number_line(w, "ambient", w->indirect ? 0 : f.diffuse);
  write_number_line(w, "diffuse", f.diffuse);
  write_emission(w, pigment, m->emission);
  cag_pov_printf(w, "      specular albedo %.4g roughness %.4g%s\n", f.specular,
                 specular_roughness(m->roughness), f.metal ? " metallic" : "");
  if (f.phong > 0) cag_pov_printf(w, "      phong albedo %.4g phong_size 600\n", f.phong);
  write_mirror(w, &f, bends);
  cag_pov_text(w, "    }\n");
}

// --- Patterns ---

typedef struct Stop {
  double at, mix, transmit; // position, fraction of the second color, transparency
} Stop;

static void write_color_map(CagPovWriter *w, const CagMaterial *m, const Stop *stops, size_t n) {
  cag_pov_text(w, "      color_map {\n");
  for (size_t i = 0; i < n; i++) {
    cag_pov_printf(w, "        [%.3g ", stops[i].at);
    cag_pov_color(w, mixed(m->color, m->color2, stops[i].mix));
    if (stops[i].transmit > 0) cag_pov_printf(w, " transmit %.3g", stops[i].transmit);
    cag_pov_text(w, "]\n");
  }
  cag_pov_text(w, "      }\n");
}
#define COLOR_MAP(...)                                                                             \
  write_color_map(w, m, (const Stop[]){__VA_ARGS__},                                               \
                  sizeof((const Stop[]){__VA_ARGS__}) / sizeof(Stop))

// Slightly bent rings about an axis along X below the ground, overlaid with fine fibers.
static void write_wood(CagPovWriter *w, const CagMaterial *m) {
  double s = m->texture_scale;
  cag_pov_text(w, "    pigment {\n      wood\n      turbulence <0.08, 0.08, 0.4> octaves 4\n");
  COLOR_MAP({0, 0.05, 0}, {0.3, 0, 0}, {0.7, 0.55, 0}, {0.9, 1, 0}, {1, 0.05, 0});
  cag_pov_printf(w, "      scale <%.4g, %.4g, %.4g>\n", s, s, 6 * s);
  cag_pov_text(w, "      rotate <0, 90, 0> rotate <0, 2, 3>\n");
  cag_pov_printf(w, "      translate <0, %.4g, %.4g>\n    }\n", -2.3 * s, -5.1 * s);
}

static void write_fibres(CagPovWriter *w, const CagMaterial *m) {
  double s = m->texture_scale;
  cag_pov_text(w, "    pigment {\n      granite\n");
  COLOR_MAP({0, 1, 1}, {0.35, 1, 1}, {0.6, 1, 0.6}, {1, 1, 0.45});
  cag_pov_printf(w, "      scale <%.4g, %.4g, %.4g>\n    }\n", 14 * s, 0.6 * s, 0.6 * s);
}

static void write_marble(CagPovWriter *w, const CagMaterial *m) {
  cag_pov_text(
      w, "    pigment {\n      marble\n      turbulence 1.1 octaves 6 omega 0.6 lambda 2.2\n");
  COLOR_MAP({0, 1, 0}, {0.04, 0.6, 0}, {0.14, 0.12, 0}, {0.45, 0, 0}, {0.7, 0.2, 0}, {0.8, 0.04, 0},
            {1, 0, 0});
  cag_pov_printf(w, "      rotate <25, 15, 40>\n      scale %.4g\n    }\n", m->texture_scale);
}

static void write_concrete(CagPovWriter *w, const CagMaterial *m) {
  double s = m->texture_scale;
  cag_pov_text(w, "    pigment {\n      bozo\n      turbulence 1 octaves 6 omega 0.7\n");
  COLOR_MAP({0, 0, 0}, {0.45, 0.3, 0}, {0.75, 0.75, 0}, {1, 1, 0});
  cag_pov_printf(w, "      scale %.4g\n    }\n", 2 * s);
  cag_pov_printf(w, "    normal { granite 0.12 scale %.4g }\n", s);
}

static void write_clay(CagPovWriter *w, const CagMaterial *m) {
  double s = m->texture_scale;
  cag_pov_text(w, "    pigment {\n      bozo\n      turbulence 0.8 octaves 5\n");
  COLOR_MAP({0, 0, 0}, {0.5, 0.35, 0}, {1, 1, 0});
  cag_pov_printf(w, "      scale <%.4g, %.4g, %.4g>\n    }\n", 3 * s, 3 * s, s);
  cag_pov_printf(w, "    normal { bumps 0.08 scale %.4g }\n", 0.3 * s);
}

typedef struct Pattern {
  const char *name;
  void (*base)(CagPovWriter *w, const CagMaterial *m); // pigment and normal
  void (*over)(CagPovWriter *w, const CagMaterial *m); // pigment of a second layer; NULL: none
} Pattern;

static const Pattern patterns[] = {
    {"wood", write_wood, write_fibres},
    {"marble", write_marble, NULL},
    {"concrete", write_concrete, NULL},
    {"clay", write_clay, NULL},
};

static const Pattern *find_pattern(const CagMaterial *m) {
  for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
    if (strcmp(patterns[i].name, m->texture) == 0 && m->texture_scale > 0) return &patterns[i];
  return NULL;
}

static void write_plain_pigment(CagPovWriter *w, const CagMaterial *m, CagColor c) {
  double passed = clamp01(m->transmission) * (1 - clamp01(m->metallic));
  cag_pov_text(w, "    pigment { color ");
  cag_pov_color(w, c);
  if (passed > 0) cag_pov_printf(w, " filter %.4g", passed);
  cag_pov_text(w, " }\n");
}

static void write_texture(CagPovWriter *w, const CagMaterial *m, bool bends) {
  const Pattern *pattern = find_pattern(m);
  CagColor c = m->color;
  if (brightness(m->emission) > 0) { // black cannot emit light
    const double least = 0.01;
    c = (CagColor){fmax(c.r, least), fmax(c.g, least), fmax(c.b, least)};
  }
  cag_pov_text(w, "  texture {\n");
  if (pattern) pattern->base(w, m);
  else write_plain_pigment(w, m, c);
  write_finish(w, m, c, bends);
  cag_pov_text(w, "  }\n");
  if (!pattern || !pattern->over) return;
  cag_pov_text(w, "  texture {\n");
  pattern->over(w, m);
  write_finish(w, m, c, bends);
  cag_pov_text(w, "  }\n");
}

// Writes the script's own text: a whole texture, or the contents of one.
static void write_own_texture(CagPovWriter *w, const char *text) {
  bool whole = strncmp(text + strspn(text, " \t\r\n"), "texture", 7) == 0;
  cag_pov_text(w, whole ? "  " : "  texture {\n    ");
  cag_pov_text(w, text);
  cag_pov_text(w, whole ? "\n" : "\n  }\n");
}

// Fresnel reflection and refraction need the interior.
static bool needs_ior(const CagMaterial *m) {
  Finish f = finish_of(m);
  return m->pov || m->transmission > 0 || (!f.metal && f.mirror >= MIRROR_LEAST);
}

void cag_pov_material(CagPovWriter *w, size_t index, bool closed) {
  const CagMaterial *m = &w->scene->materials[index];
  char name[64];
  cag_pov_material_name(w, index, closed, name);
  cag_pov_comment(w, "", m->name);
  cag_pov_printf(w, "#declare %s = material {\n", name);
  bool bends = closed || !(m->transmission > 0);
  if (m->pov) write_own_texture(w, m->pov);
  else write_texture(w, m, bends);
  if (bends && needs_ior(m)) cag_pov_printf(w, "  interior { ior %.5g }\n", m->ior);
  cag_pov_text(w, "}\n");
}

void cag_pov_scale_material(CagPovWriter *w, size_t index, const CagColorScale *scale) {
  const CagMaterial *m = &w->scene->materials[index];
  CagColorStop stops[CAG_SCALE_STOPS_MAX];
  size_t n = cag_color_scale_stops(scale, stops);
  cag_pov_text(w, "  material {\n  texture {\n    uv_mapping\n    pigment {\n      gradient x\n"
                  "      color_map {\n");
  for (size_t i = 0; i < n; i++) {
    cag_pov_printf(w, "        [%.7g ", pov_scale_place(stops[i].at));
    cag_pov_color(w, stops[i].color);
    cag_pov_text(w, "]\n");
  }
  cag_pov_text(w, "      }\n    }\n");
  write_finish(w, m, (CagColor){1, 1, 1}, false);
  cag_pov_text(w, "  }\n");
  if (needs_ior(m)) cag_pov_printf(w, "  interior { ior %.5g }\n", m->ior);
  cag_pov_text(w, "  }\n");
}

// The fraction of the sky's mean color that replaces its light, because corners receive less than
// all of it.
#define SKY_SHARE 0.5
#define DIM_WHITE 0.12

CagColor cag_pov_ambient(const CagScene *s) {
  CagColor sum = {0, 0, 0};
  size_t n = s->sky.color_count;
  if (n == 0 && s->sky.image) return (CagColor){SKY_SHARE, SKY_SHARE, SKY_SHARE};
  if (n == 0) return (CagColor){DIM_WHITE, DIM_WHITE, DIM_WHITE};
  for (size_t i = 0; i < n; i++)
    sum = (CagColor){sum.r + s->sky.colors[i].r, sum.g + s->sky.colors[i].g,
                     sum.b + s->sky.colors[i].b};
  double k = SKY_SHARE / (double)n;
  return (CagColor){k * sum.r, k * sum.g, k * sum.b};
}
