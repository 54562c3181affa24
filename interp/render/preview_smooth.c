#include "interp/render/preview_smooth.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/stop.h"

// Passes, each with twice the step of the one before.
enum { PASSES = 3 };
// Light that differs by this many standard deviations of its mean counts by 1/e.
#define DEVIATIONS 3.0f
// Depths that differ by more than this fraction across a pixel are of different surfaces, and the
// cosine of normals counts by this power.
#define DEPTH_FRACTION 0.01f
enum { NORMAL_POWER = 32 };

typedef struct Cell {
  float light[3];
  float variance; // of the mean of the brightness
  float normal[3], distance;
} Cell;

typedef struct Smoothing {
  const Cell *from;
  Cell *to;
  size_t width, height;
  int step;
} Smoothing;

static float brightness_of(const float *c) { return 0.3f * c[0] + 0.6f * c[1] + 0.1f * c[2]; }

static float power_of(float x) {
  if (x <= 0) return 0;
  for (int k = 1; k < NORMAL_POWER; k *= 2) x *= x;
  return x;
}

// How much a neighbor counts.
static float weight_of(const Cell *a, const Cell *b, float deviation, float steps) {
  if (b->distance <= 0) return 0;
  const float cosine =
      a->normal[0] * b->normal[0] + a->normal[1] * b->normal[1] + a->normal[2] * b->normal[2];
  const float depth = fabsf(a->distance - b->distance) / (DEPTH_FRACTION * steps * a->distance);
  const float light = fabsf(brightness_of(a->light) - brightness_of(b->light)) / deviation;
  return power_of(cosine) * expf(-depth * depth - light);
}

static void smooth_cell(const Smoothing *s, size_t x, size_t y) {
  static const float KERNEL[] = {3.0f / 8, 1.0f / 4, 1.0f / 16};
  const Cell *a = &s->from[y * s->width + x];
  Cell *out = &s->to[y * s->width + x];
  *out = *a;
  if (a->distance <= 0 || a->variance <= 0) return;
  const float deviation = DEVIATIONS * sqrtf(a->variance) + 1e-6f;
  float sum = 0, light[3] = {0, 0, 0}, variance = 0;
  for (int j = -2; j <= 2; j++)
    for (int i = -2; i <= 2; i++) {
      const long px = (long)x + i * s->step, py = (long)y + j * s->step;
      if (px < 0 || py < 0 || px >= (long)s->width || py >= (long)s->height) continue;
      const Cell *b = &s->from[(size_t)py * s->width + (size_t)px];
      const float steps = (float)((abs(i) + abs(j)) * s->step + 1);
      const float k =
          KERNEL[abs(i)] * KERNEL[abs(j)] * (i || j ? weight_of(a, b, deviation, steps) : 1);
      sum += k;
      for (int c = 0; c < 3; c++) light[c] += k * b->light[c];
      variance += k * k * b->variance;
    }
  for (int c = 0; c < 3; c++) out->light[c] = light[c] / sum;
  out->variance = variance / (sum * sum);
}

static void smooth_row(void *context, size_t y, int thread) {
  (void)thread;
  const Smoothing *s = context;
  for (size_t x = 0; x < s->width && !cag_stopped(); x++) smooth_cell(s, x, y);
}

static Cell cell_of(const CagPreviewSum *p, int samples) {
  Cell c = {.distance = 0};
  if (!(p->met > 0) || samples < 2) return c;
  const float n = p->met;
  for (int k = 0; k < 3; k++) {
    c.light[k] = p->light[k] / n;
    c.normal[k] = p->normal[k] / n;
  }
  c.distance = p->distance / n;
  const float mean = brightness_of(c.light);
  c.variance = fmaxf(0, p->square / n - mean * mean) / n;
  return c;
}

bool cag_preview_smooth(CagPreviewSum *sums, size_t width, size_t height, int samples) {
  const size_t n = width * height;
  Cell *cells = cag_malloc(2 * n * sizeof *cells);
  if (!cells) return false;
  for (size_t i = 0; i < n; i++) cells[i] = cell_of(&sums[i], samples);
  Smoothing s = {.from = cells, .to = cells + n, .width = width, .height = height, .step = 1};
  for (int pass = 0; pass < PASSES; pass++, s.step *= 2) {
    cag_parallel(height, smooth_row, &s);
    const Cell *done = s.to;
    s.to = s.from == cells ? cells : cells + n;
    s.from = done;
  }
  // Only the difference is added, so that pixels of several surfaces keep their mixture.
  for (size_t i = 0; i < n && !cag_stopped(); i++) {
    CagPreviewSum *p = &sums[i];
    if (!(p->met > 0)) continue;
    for (int k = 0; k < 3; k++)
      p->color[k] += p->albedo[k] * (s.from[i].light[k] - p->light[k] / p->met);
  }
  cag_free(cells);
  return !cag_stopped();
}
