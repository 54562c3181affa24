// Camera, lights and sky.

#include "interp/formats/pov_write.h"

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

// Rounds a unit direction to 12 decimals, which removes rounding errors: 0 is more readable than
// 6e-17.
static CagVec3 tidy(CagVec3 v) {
  const double unit = 1e-12;
  return cag_vec3(cag_pov_round(v.x, unit), cag_pov_round(v.y, unit), cag_pov_round(v.z, unit));
}

static void write_axis(CagPovWriter *w, const char *word, CagVec3 axis, double length,
                       bool in_space) {
  cag_pov_printf(w, "  %-9s ", word);
  if (in_space && w->unit != 1) cag_pov_text(w, "unit*");
  if (length != 1) {
    cag_pov_number(w, length);
    cag_pov_text(w, "*");
  }
  cag_pov_vec(w, tidy(axis));
  cag_pov_text(w, "\n");
}

// --- The lens ---
//
// POV-Ray 3.7 deflects the rays of a pixel by half its `aperture` times the points of a pattern
// (tracepixel.cpp), and moves each point randomly within a square. For up to 37 samples, the
// pattern is a grid; more samples are spread evenly over the disc of radius 1/2. The second moment
// of such a pattern differs from that of a disc. The aperture is therefore scaled, so that the blur
// has the second moment given by the thin lens formula.

// The second moment of a disc of radius 1/2 along an axis.
#define DISC_MOMENT (1.0 / 16)
// From this number on, POV-Ray may stop early if the first samples of a pixel agree. Fewer initial
// samples would miss the rim of the lens.
#define SAMPLES_TO_STOP_EARLY 19
// The pattern of one sample has a single point, which is not centered: (-1/4, 1/4).
#define FIRST_POINT 0.25

// The grids that fill the lens evenly, with equal second moments along both axes: the sum of x^2
// divided by the number of points, and the moment of the random moves.
static const struct {
  int points;
  double sum, moves;
} GRIDS[] = {{1, 0, 1.0 / 12},
             {4, 1.0 / 4, 1.0 / 48},
             {7, 1.0 / 4, 1.0 / 144},
             {19, 8.0 / 9, 1.0 / 324},
             {37, 31.0 / 16, 1.0 / 576}};
enum { GRID_COUNT = sizeof GRIDS / sizeof *GRIDS };

static const int LENS_SAMPLES[] = {[CAG_POV_DRAFT] = 1, [CAG_POV_NORMAL] = 4, [CAG_POV_FINAL] = 80};

// Returns the requested number of samples, or rounds it up to the next grid. The points that
// POV-Ray adds to a small grid are lopsided.
static int lens_samples(const CagPovOptions *o) {
  const int samples = o->samples > 0 ? o->samples : LENS_SAMPLES[o->quality];
  for (int i = 0; i < GRID_COUNT; i++)
    if (samples <= GRIDS[i].points) return GRIDS[i].points;
  return samples;
}

// The second moment of the pattern along an axis, about its center.
static double pattern_moment(int samples) {
  for (int i = 0; i < GRID_COUNT; i++)
    if (samples == GRIDS[i].points) return GRIDS[i].sum / samples + GRIDS[i].moves;
  const int more = samples - GRIDS[GRID_COUNT - 1].points;
  const double moves = 1 / (12.0 * samples); // within squares of side sqrt(1 / samples)
  return (GRIDS[GRID_COUNT - 1].sum + more * DISC_MOMENT) / samples + moves;
}

// Returns POV-Ray's aperture for a lens diameter: the patterns lie within a disc of half that
// diameter.
static double pov_aperture(const CagPovOptions *o, double diameter) {
  return 2 * diameter * sqrt(DISC_MOMENT / pattern_moment(lens_samples(o)));
}

static double focus_distance(const CagCamera *c) {
  const double to_target = cag_norm(cag_sub(c->target, c->eye));
  return c->focus > 0 ? c->focus : to_target > 0 ? to_target : 1;
}

// Returns how far to move the location so that the middle of the pattern is at the camera's eye.
// The axes of the pattern are up x view and view x (up x view), and POV-Ray subtracts the second.
static CagVec3 lens_shift(const CagPovOptions *o, const CagCamera *c, CagVec3 up, CagVec3 view) {
  if (!cag_camera_has_lens(c) || lens_samples(o) > 1) return cag_vec3(0, 0, 0);
  CagVec3 x = cag_cross(up, view), y = cag_cross(view, x);
  return cag_scaled(cag_add(x, y), FIRST_POINT * pov_aperture(o, c->aperture) / 2);
}

// A thin lens of diameter A focused at the distance f shows a point at the distance z as a disc
// that is A |z - f| / z wide in the plane of focus.
static void write_focus(CagPovWriter *w, const CagCamera *c, CagVec3 view) {
  if (!cag_camera_has_lens(c)) return;
  const int samples = lens_samples(w->options);
  cag_pov_text(w, "  aperture ");
  cag_pov_length(w, pov_aperture(w->options, c->aperture));
  cag_pov_text(w, "\n  focal_point ");
  cag_pov_place_vec(w, cag_madd(c->eye, focus_distance(c), view));
  if (samples < SAMPLES_TO_STOP_EARLY)
    cag_pov_printf(w, "\n  blur_samples %d, %d\n", samples, samples);
  else cag_pov_printf(w, "\n  blur_samples %d variance 1/100000 confidence 0.99\n", samples);
}

void cag_pov_camera(CagPovWriter *w) {
  const CagCamera *c = w->camera;
  CagTransform frame = cag_camera_frame(c);
  const CagCameraWindow window = cag_camera_window(c);
  CagVec3 right = window.right, up = cag_scaled(window.down, -1);
  CagVec3 view = column(&frame, 2), eye = column(&frame, 3);
  if (c->orthographic) eye = cag_madd(eye, c->width, window.shift);
  const int *size = w->options->size[0] > 0 && w->options->size[1] > 0 ? w->options->size : c->size;
  double aspect = (double)size[0] / size[1];

  cag_pov_comment(w, "", c->name ? c->name : "camera");
  CagVec3 shift = lens_shift(w->options, c, up, view);
  cag_pov_printf(
      w, "// For pictures of %d x %d pixels; right, up and direction make it right-handed.\n",
      size[0], size[1]);
  cag_pov_text(w, "camera {\n");
  cag_pov_text(w, c->orthographic ? "  orthographic\n" : "  perspective\n");
  cag_pov_text(w, "  location  ");
  cag_pov_place_vec(w, cag_add(eye, shift));
  cag_pov_text(w, "\n");
  if (c->orthographic) { // right and up span the picture
    write_axis(w, "right", right, c->width, true);
    write_axis(w, "up", up, c->width / aspect, true);
    write_axis(w, "direction", view, 1, false);
  } else { // a picture of height 1 at this distance
    write_axis(w, "right", right, aspect, false);
    write_axis(w, "up", up, 1, false);
    // Moving the location does not change the visible part of the plane in focus.
    CagVec3 middle = cag_madd(view, -1 / focus_distance(c), shift);
    middle = cag_madd(middle, 2 * tan(c->fov / 2), window.shift);
    write_axis(w, "direction", middle, aspect / 2 / tan(c->fov / 2), false);
  }
  write_focus(w, c, view);
  cag_pov_text(w, "}\n");
}

// --- Lights ---

// The distance of a sun in radii of the scene. Its rays are parallel up to 0.06 degrees.
#define SUN_DISTANCE 1000.0
// The angular diameter of a sun in radians, twice the real one, for slightly softer shadows.
#define SUN_WIDTH 0.0175

static void any_perpendicular(CagVec3 d, CagVec3 *a, CagVec3 *b) {
  CagVec3 other = fabs(d.z) < 0.9 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  *a = cag_unit(cag_cross(d, other));
  *b = cag_cross(d, *a);
}

static void write_area(CagPovWriter *w, CagVec3 direction, double size, bool round) {
  if (w->options->quality == CAG_POV_DRAFT || !(size > 0)) return;
  CagVec3 a, b;
  any_perpendicular(direction, &a, &b);
  int n = w->options->quality == CAG_POV_FINAL ? 9 : 5;
  cag_pov_text(w, "  area_light ");
  cag_pov_length(w, size);
  cag_pov_text(w, "*");
  cag_pov_vec(w, tidy(a));
  cag_pov_text(w, ", ");
  cag_pov_length(w, size);
  cag_pov_text(w, "*");
  cag_pov_vec(w, tidy(b));
  cag_pov_printf(w, ", %d, %d adaptive %d jitter%s\n", n, n, n > 5 ? 2 : 1,
                 round ? " circular" : "");
}

static void write_light_head(CagPovWriter *w, const CagLight *l, const char *what, CagVec3 at) {
  cag_pov_printf(w, "light_source { // %s\n  ", what);
  cag_pov_place_vec(w, at);
  cag_pov_text(w, "\n  color ");
  cag_pov_color(
      w, (CagColor){l->color.r * l->strength, l->color.g * l->strength, l->color.b * l->strength});
  cag_pov_text(w, "\n");
}

static void write_sun(CagPovWriter *w, const CagLight *l) {
  double far = cag_pov_round(SUN_DISTANCE * w->radius, 1);
  CagVec3 direction = cag_unit(l->direction);
  write_light_head(w, l, "sun", cag_madd(w->center, -far, direction));
  write_area(w, direction, cag_pov_round(far * SUN_WIDTH, 1e-3), true);
}

static void write_spot(CagPovWriter *w, const CagLight *l) {
  const double soft_edge = 0.8; // the inner part of the cone with full light
  double half = l->angle / 2 * 180 / 3.14159265358979323846;
  write_light_head(w, l, "spot", l->position);
  cag_pov_printf(w, "  spotlight radius %.6g falloff %.6g point_at ", soft_edge * half, half);
  cag_pov_place_vec(w, cag_madd(l->position, w->radius, cag_unit(l->direction)));
  cag_pov_text(w, "\n");
}

void cag_pov_lights(CagPovWriter *w) {
  for (size_t i = 0; i < w->scene->light_count; i++) {
    const CagLight *l = &w->scene->lights[i];
    switch (l->kind) {
    case CAG_LIGHT_SUN: write_sun(w, l); break;
    case CAG_LIGHT_POINT: write_light_head(w, l, "point", l->position); break;
    case CAG_LIGHT_SPOT: write_spot(w, l); break;
    case CAG_LIGHT_AREA:
      write_light_head(w, l, "area", l->position);
      write_area(w, cag_unit(l->direction), l->size, false);
      break;
    }
    cag_pov_text(w, "}\n");
  }
}

// --- Sky ---

static void write_quoted(CagPovWriter *w, const char *path) {
  cag_pov_text(w, "\"");
  for (const char *p = path; *p; p++) {
    if (*p == '"' || *p == '\\') cag_pov_text(w, "\\");
    cag_atomic_file_write(w->file, p, 1);
  }
  cag_pov_text(w, "\"");
}

// A panorama is upright about Z and not mirrored as seen from inside. POV-Ray's mapping is about Y
// and left-handed, so y and z are swapped.
static void write_sky_image(CagPovWriter *w, const char *path) {
  cag_pov_text(w, "sky_sphere {\n  pigment {\n    image_map { exr ");
  write_quoted(w, path);
  cag_pov_text(w, " map_type 1 interpolate 2 }\n");
  cag_pov_text(w, "    matrix <1, 0, 0,  0, 0, 1,  0, 1, 0,  0, 0, 0>\n  }\n}\n");
}

static void write_sky_colors(CagPovWriter *w, const CagSky *sky) {
  cag_pov_text(
      w, "sky_sphere { // from below to above\n  pigment {\n    gradient z\n    color_map {\n");
  for (size_t i = 0; i < sky->color_count; i++) {
    size_t steps = sky->color_count > 1 ? sky->color_count - 1 : 1;
    cag_pov_printf(w, "      [%.6g ", (double)i / (double)steps);
    cag_pov_color(w, sky->colors[i]);
    cag_pov_text(w, "]\n");
  }
  cag_pov_text(w, "    }\n    scale 2\n    translate -1\n  }\n}\n");
}

void cag_pov_sky(CagPovWriter *w) {
  const CagScene *s = w->scene;
  if (s->has_background) {
    cag_pov_text(w, "background { ");
    cag_pov_color(w, s->background);
    cag_pov_text(w, " }\n");
  }
  if (s->sky.image) write_sky_image(w, s->sky.image);
  else if (s->sky.color_count > 0) write_sky_colors(w, &s->sky);
}
