#include "interp/render/preview.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/stop.h"
#include "interp/render/preview_labels.h"
#include "interp/render/preview_shade.h"
#include "interp/render/preview_smooth.h"

// Side of a tile in pixels: what one thread works on.
enum { TILE = 16 };
// The first round renders one pixel of each square of so many, which stands for the others until the
// second round: the first picture is there after a fraction of the time. Divides TILE.
enum { COARSE = 4 };
// The most samples that a round adds to each pixel: rounds double until then.
enum { ROUND_SAMPLES = 4 };
// Samples of a pixel of a sketch at an edge, as a square of so many.
enum { EDGE_SIDE = 3, LENS_SIDE = 6 };
// Neighbors that differ by more than this fraction of their brightness are at an edge.
#define EDGE_CONTRAST 0.06
#define EDGE_FLOOR 0.02

typedef struct Frame {
  const CagPreviewWorld *world;
  const CagCamera *camera;
  const CagPreviewOptions *options;
  CagCameraMap map;
  CagVec3 right, down, view; // of the lens
  int x, y, width, height;   // of what is rendered: the region and its neighbors
  size_t columns;            // of tiles
  int round;                 // the first two share the first sample of each pixel
  int first_sample, samples; // that this round adds to its pixels
  CagImage *out;
  CagPreviewSum *sum;  // of the samples so far
  unsigned char *edge; // pixels of a sketch that get more samples
  CagStatus status;
  CagError *err;
} Frame;

// --- Rays ---

// The ray of a point of the picture, in pixels; a lens bends it about the plane in focus.
static CagRay ray_through(const Frame *f, const double at[2], CagPreviewShader *s) {
  CagRay ray = {.least = 0, .most = INFINITY};
  const CagCamera *c = f->camera;
  cag_camera_sight(&f->map, at, &ray.origin, &ray.direction);
  if (!cag_camera_has_lens(c)) return ray;
  const double to_target = cag_norm(cag_sub(c->target, c->eye));
  const double focus = c->focus > 0 ? c->focus : to_target > 0 ? to_target : 1;
  double chance[2];
  cag_preview_roll(&s->dice, chance);
  const double radius = c->aperture / 2 * sqrt(chance[0]), angle = 2 * M_PI * chance[1];
  const CagVec3 sharp =
      cag_madd(ray.origin, focus / cag_dot(ray.direction, f->view), ray.direction);
  ray.origin =
      cag_madd(cag_madd(ray.origin, radius * cos(angle), f->right), radius * sin(angle), f->down);
  ray.direction = cag_unit(cag_sub(sharp, ray.origin));
  return ray;
}

static CagStatus light_at(const Frame *f, CagPreviewShader *s, const double at[2], CagColor *out,
                          CagError *err) {
  const CagRay ray = ray_through(f, at, s);
  return cag_preview_light(s, &ray, 0, 1, out, err);
}

// --- Pixels ---

static size_t pixel_index(const Frame *f, int x, int y) {
  return (size_t)y * (size_t)f->width + (size_t)x;
}

static void add_color(float sum[3], CagColor c) {
  sum[0] += (float)c.r;
  sum[1] += (float)c.g;
  sum[2] += (float)c.b;
}

static void add_sample(CagPreviewSum *sum, const CagColor *c, const CagPreviewFirst *first) {
  add_color(sum->color, *c);
  if (!first->met) return;
  const CagColor l = first->light;
  const float bright = (float)(0.3 * l.r + 0.6 * l.g + 0.1 * l.b);
  add_color(sum->light, l);
  add_color(sum->albedo, first->albedo);
  sum->square += bright * bright;
  sum->normal[0] += (float)first->normal.x;
  sum->normal[1] += (float)first->normal.y;
  sum->normal[2] += (float)first->normal.z;
  sum->distance += (float)first->distance;
  sum->met++;
}

static CagPreviewDice pixel_dice(const Frame *f, int x, int y, int index) {
  return (CagPreviewDice){.pixel = (uint64_t)(f->y + y) << 32 | (uint32_t)(f->x + x),
                          .index = (uint32_t)index};
}

static bool is_coarse(int x, int y) { return x % COARSE == 0 && y % COARSE == 0; }

static bool in_round(const Frame *f, int x, int y) {
  return f->round > 1 || is_coarse(x, y) == (f->round == 0);
}

// Adds a sample of a pixel, anywhere in it.
static CagStatus sample_pixel(const Frame *f, CagPreviewShader *s, int x, int y, int index,
                              CagError *err) {
  double chance[2];
  CagColor c;
  s->dice = pixel_dice(f, x, y, index);
  cag_preview_roll(&s->dice, chance);
  const double at[2] = {f->x + x + chance[0], f->y + y + chance[1]};
  s->first.met = false;
  CagStatus status = light_at(f, s, at, &c, err);
  if (!status) add_sample(&f->sum[pixel_index(f, x, y)], &c, &s->first);
  return status;
}

static CagStatus sample_pixel_often(const Frame *f, CagPreviewShader *s, int x, int y,
                                    CagError *err) {
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < f->samples; k++)
    status = sample_pixel(f, s, x, y, f->first_sample + k, err);
  return status;
}

// The middle of a pixel in the first two rounds; a square of samples at edges in the third.
static CagStatus sketch_pixel(const Frame *f, CagPreviewShader *s, int x, int y, CagError *err) {
  const size_t i = pixel_index(f, x, y);
  const int fine = cag_camera_has_lens(f->camera) ? LENS_SIDE : EDGE_SIDE;
  const int side = f->round < 2 ? 1 : fine;
  CagColor sum = {0, 0, 0}, c;
  if (f->round > 1 && !f->edge[i]) return CAG_OK;
  for (int k = 0; k < side * side; k++) {
    s->dice = pixel_dice(f, x, y, k);
    const double at[2] = {f->x + x + (k % side + 0.5) / side, f->y + y + (k / side + 0.5) / side};
    CagStatus status = light_at(f, s, at, &c, err);
    if (status) return status;
    sum = (CagColor){sum.r + c.r, sum.g + c.g, sum.b + c.b};
  }
  const double n = side * side;
  memset(f->sum[i].color, 0, sizeof f->sum[i].color);
  add_color(f->sum[i].color, (CagColor){sum.r / n, sum.g / n, sum.b / n});
  return CAG_OK;
}

static CagStatus render_tile(const Frame *f, CagPreviewShader *s, size_t tile, CagError *err) {
  const int left = (int)(tile % f->columns) * TILE, top = (int)(tile / f->columns) * TILE;
  CagStatus status = CAG_OK;
  for (int y = top; y < top + TILE && y < f->height; y++)
    for (int x = left; !status && x < left + TILE && x < f->width; x++) {
      if (!in_round(f, x, y)) continue;
      status = cag_stop_check(err);
      if (status) break;
      status = s->sketch ? sketch_pixel(f, s, x, y, err) : sample_pixel_often(f, s, x, y, err);
    }
  return status;
}

static bool render_numbered_tile(void *context, size_t tile, int thread) {
  Frame *f = context;
  CagError own;
  CagError *err = thread == 0 ? f->err : &own;
  CagPreviewShader s = {.world = f->world,
                        .sky_light = f->options->sky_light,
                        .samples = f->options->samples,
                        .sketch = f->options->samples <= 0};
  const CagStatus status = render_tile(f, &s, tile, err);
  cag_crossings_free(&s.work);
  if (thread == 0 && status) f->status = status;
  return !status;
}

static float brightness_of(const float *c) { return 0.3f * c[0] + 0.6f * c[1] + 0.1f * c[2]; }

static bool differ(const float *a, const float *b) {
  const float p = brightness_of(a), q = brightness_of(b);
  return fabsf(p - q) > EDGE_CONTRAST * fmaxf(p, q) + EDGE_FLOOR * EDGE_CONTRAST;
}

// With a lens, all pixels may be of edges that are not sharp.
static void find_edges(Frame *f) {
  if (cag_camera_has_lens(f->camera)) memset(f->edge, 1, (size_t)f->width * (size_t)f->height);
  for (int y = 0; y < f->height; y++)
    for (int x = 0; x < f->width; x++) {
      const size_t i = pixel_index(f, x, y), below = i + (size_t)f->width;
      if (x + 1 < f->width && differ(f->sum[i].color, f->sum[i + 1].color))
        f->edge[i] = f->edge[i + 1] = 1;
      if (y + 1 < f->height && differ(f->sum[i].color, f->sum[below].color))
        f->edge[i] = f->edge[below] = 1;
    }
}

// --- Rounds ---

static void report(const Frame *f, double percent) {
  if (f->options->progress) f->options->progress(f->options->progress_user, percent, "rendering");
}

static int least(int a, int b) { return a < b ? a : b; }

// Renders round by round. Sets the numbers of complete rounds, and of samples of each pixel in them.
// The edges of a sketch count as its second sample.
static CagStatus render_rounds(Frame *f, int *complete, int *samples) {
  const int most = f->options->samples > 0 ? f->options->samples : 2;
  const size_t tiles = f->columns * ((size_t)(f->height + TILE - 1) / TILE);
  const size_t pixels = (size_t)f->width * (size_t)f->height;
  CagPreviewSum *before = cag_malloc(pixels * sizeof *before); // the complete rounds
  if (!before) return cag_fail_memory(f->err);
  bool good = true;
  *complete = *samples = 0;
  while (good && *samples < most) {
    f->round = *complete;
    f->first_sample = *samples;
    f->samples = f->round < 2 ? 1 : least(least(*samples, ROUND_SAMPLES), most - *samples);
    if (f->round == 2 && f->edge) find_edges(f);
    if (f->round > 0) memcpy(before, f->sum, pixels * sizeof *before);
    good = cag_parallel_checked(tiles, render_numbered_tile, f);
    if (!good) break;
    ++*complete;
    if (f->round > 0) *samples += f->samples;
    report(f, 100 * (f->round > 0 ? *samples : 1.0 / (COARSE * COARSE)) / most);
  }
  if (!good && *complete > 0) memcpy(f->sum, before, pixels * sizeof *before);
  cag_free(before);
  if (good) return CAG_OK;
  return f->status ? f->status : cag_stop_check(f->err);
}

// Spreads the pixels of the coarse round over their squares.
static void spread_coarse(Frame *f) {
  for (int y = 0; y < f->height; y++)
    for (int x = 0; x < f->width; x++)
      f->sum[pixel_index(f, x, y)] = f->sum[pixel_index(f, x - x % COARSE, y - y % COARSE)];
}

// The part of the picture that was asked for.
typedef struct Region {
  int x, y, width, height;
} Region;

static Region region_of(const CagCamera *c, const CagPreviewOptions *o) {
  if (o->region_width <= 0) return (Region){0, 0, c->size[0], c->size[1]};
  return (Region){o->region_x, o->region_y, o->region_width, o->region_height};
}

// Pixels of a region depend on neighbors beyond it, so that its parts are those of the picture.
static void render_around(Frame *f, const Region *r) {
  const int margin = f->options->samples > 0 ? CAG_PREVIEW_SMOOTH_REACH : 1;
  const int *size = f->camera->size;
  f->x = r->x > margin ? r->x - margin : 0;
  f->y = r->y > margin ? r->y - margin : 0;
  const int right = r->x + r->width + margin, bottom = r->y + r->height + margin;
  f->width = (right < size[0] ? right : size[0]) - f->x;
  f->height = (bottom < size[1] ? bottom : size[1]) - f->y;
}

static void write_picture(const Frame *f, const Region *r, int samples) {
  static const char *const names[] = {"R", "G", "B"};
  const float k = f->options->samples > 0 ? 1 / (float)samples : 1;
  for (size_t c = 0; c < 3; c++) {
    cag_image_set_name(f->out, c, names[c]);
    float *to = cag_image_plane(f->out, c);
    for (int y = 0; y < r->height; y++)
      for (int x = 0; x < r->width; x++)
        *to++ = k * f->sum[pixel_index(f, r->x + x - f->x, r->y + y - f->y)].color[c];
  }
}

static CagStatus render_frame(Frame *f, bool *finished) {
  const Region r = region_of(f->camera, f->options);
  render_around(f, &r);
  const size_t n = (size_t)f->width * (size_t)f->height;
  int complete = 0, samples = 0;
  f->columns = (size_t)(f->width + TILE - 1) / TILE;
  f->sum = cag_calloc(n, sizeof *f->sum);
  if (f->options->samples <= 0) f->edge = cag_calloc(n, 1);
  CagStatus status =
      f->sum && (f->edge || f->options->samples > 0) ? CAG_OK : cag_fail_memory(f->err);
  if (!status && !cag_image_create(f->out, (size_t)r.width, (size_t)r.height, 3, f->err))
    status = f->err->status;
  if (!status) {
    status = render_rounds(f, &complete, &samples);
    *finished = !status;
    if (status == CAG_E_CALLBACK && complete > 0) status = CAG_OK;
    // What is complete is finished even if the work is stopped.
    const volatile int *flag = cag_stop_lend(NULL);
    if (!status && complete == 1) {
      spread_coarse(f);
      samples = 1;
    }
    if (!status && samples > 1 && f->options->samples > 0)
      cag_preview_smooth(f->sum, (size_t)f->width, (size_t)f->height, samples);
    if (!status) {
      write_picture(f, &r, samples);
      status = cag_preview_labels(f->world->scene, f->camera, &f->map, r.x, r.y, f->out, f->err);
    }
    if (status) cag_image_free(f->out);
    cag_stop_lend(flag);
  }
  cag_free(f->sum);
  cag_free(f->edge);
  return status;
}

CagStatus cag_preview_render(const CagScene *scene, const CagCamera *camera,
                             const CagPreviewOptions *options, CagImage *out, bool *finished,
                             CagError *err) {
  const CagTransform frame = cag_camera_frame(camera);
  Frame f = {.camera = camera, .options = options, .out = out, .err = err};
  f.right = cag_vec3(frame.m[0][0], frame.m[1][0], frame.m[2][0]);
  f.down = cag_vec3(frame.m[0][1], frame.m[1][1], frame.m[2][1]);
  f.view = cag_vec3(frame.m[0][2], frame.m[1][2], frame.m[2][2]);
  CagPreviewWorld world;
  CagStatus status = cag_scene_camera_map(camera, &f.map, err);
  if (status) return status;
  status = cag_preview_world(scene, &world, err);
  if (status) return status;
  f.world = &world;
  status = render_frame(&f, finished);
  cag_preview_world_free(&world);
  return status;
}
