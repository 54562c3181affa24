#include "geom/image/morphology.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"

// --- Dilation and erosion ---
//
// The line is divided into blocks of `size` pixels. Maxima from the start of each block up to a
// pixel, and from a pixel to the end of its block, combine to the maximum of any window of this
// size. Erosion is the dilation of the negative image.

// Columns that are handled together, so that memory is read in rows.
#define STRIP 16

typedef struct Lines {
  size_t length, reach;       // size = 2 reach + 1
  size_t width;               // number of lines that are handled together, interleaved
  double *forward, *backward; // (length + 2 reach) x width
} Lines;

static double greater(double a, double b) { return a > b ? a : b; }

// Replaces lines, padded by `reach` items of -inf at both ends in `forward`, by the maxima of
// windows, which are stored at forward[0 .. length).
static void lines_dilate(Lines *l) {
  const size_t n = l->length + 2 * l->reach, size = 2 * l->reach + 1, w = l->width;
  memcpy(l->backward, l->forward, n * w * sizeof *l->backward);
  for (size_t i = 1; i < n; i++)
    for (size_t k = 0; i % size && k < w; k++)
      l->forward[i * w + k] = greater(l->forward[i * w + k], l->forward[(i - 1) * w + k]);
  for (size_t i = n - 1; i-- > 0;)
    for (size_t k = 0; (i + 1) % size && k < w; k++)
      l->backward[i * w + k] = greater(l->backward[i * w + k], l->backward[(i + 1) * w + k]);
  for (size_t i = 0; i < l->length; i++)
    for (size_t k = 0; k < w; k++)
      l->forward[i * w + k] = greater(l->backward[i * w + k], l->forward[(i + size - 1) * w + k]);
}

static void lines_clear_ends(Lines *l) {
  const size_t n = l->reach * l->width, tail = (l->reach + l->length) * l->width;
  for (size_t i = 0; i < n; i++) l->forward[i] = l->forward[tail + i] = -INFINITY;
}

static CagStatus lines_new(Lines *l, size_t length, size_t reach, size_t width, CagError *err) {
  // A longer window has the same result as one that contains the whole line.
  *l = (Lines){.length = length, .reach = reach < length ? reach : length, .width = width};
  const size_t n = (length + 2 * l->reach) * width;
  l->forward = cag_malloc(n * sizeof *l->forward);
  l->backward = cag_malloc(n * sizeof *l->backward);
  return l->forward && l->backward ? CAG_OK : cag_fail_memory(err);
}

static void lines_free(Lines *l) {
  cag_free(l->forward);
  cag_free(l->backward);
}

static CagStatus dilate_rows(double *plane, size_t width, size_t height, size_t reach,
                             CagError *err) {
  Lines l;
  CagStatus status = lines_new(&l, width, reach, 1, err);
  for (size_t y = 0; !status && y < height; y++) {
    lines_clear_ends(&l);
    memcpy(l.forward + l.reach, plane + y * width, width * sizeof *plane);
    lines_dilate(&l);
    memcpy(plane + y * width, l.forward, width * sizeof *plane);
    status = cag_stop_check(err);
  }
  lines_free(&l);
  return status;
}

static CagStatus dilate_columns(double *plane, size_t width, size_t height, size_t reach,
                                CagError *err) {
  Lines l;
  CagStatus status = lines_new(&l, height, reach, STRIP, err);
  for (size_t x = 0; !status && x < width; x += STRIP) {
    const size_t n = width - x < STRIP ? width - x : STRIP;
    l.width = n;
    lines_clear_ends(&l);
    for (size_t y = 0; y < height; y++)
      memcpy(l.forward + (l.reach + y) * n, plane + y * width + x, n * sizeof *plane);
    lines_dilate(&l);
    for (size_t y = 0; y < height; y++)
      memcpy(plane + y * width + x, l.forward + y * n, n * sizeof *plane);
    status = cag_stop_check(err);
  }
  lines_free(&l);
  return status;
}

static CagStatus extremes(const CagRaster *r, size_t size, double sign, CagRaster **out,
                          CagError *err) {
  const size_t n = r->width * r->height * r->channel_count;
  CagRaster *made;
  CagStatus status = cag_raster_like(r, &made, err);
  if (status) return status;
  for (size_t i = 0; i < n; i++) made->data[i] = isnan(r->data[i]) ? -INFINITY : sign * r->data[i];
  for (size_t c = 0; !status && c < r->channel_count; c++) {
    double *plane = cag_raster_plane(made, c);
    status = dilate_rows(plane, r->width, r->height, size / 2, err);
    if (!status) status = dilate_columns(plane, r->width, r->height, size / 2, err);
  }
  // 0 + turns -0 into 0.
  for (size_t i = 0; i < n; i++)
    made->data[i] = made->data[i] == -INFINITY ? NAN : 0 + sign * made->data[i];
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

CagStatus cag_image_dilate(const CagRaster *r, size_t size, CagRaster **out, CagError *err) {
  return extremes(r, size, 1, out, err);
}

CagStatus cag_image_erode(const CagRaster *r, size_t size, CagRaster **out, CagError *err) {
  return extremes(r, size, -1, out, err);
}

// --- Distances ---
//
// g[x, y] is the distance to the nearest pixel of the background in the same column. Along a row,
// the squared distance is the least of the parabolas (x - i)^2 + g[i]^2. All numbers are integers,
// so the result is exact.

typedef struct Envelope {
  long *g;            // a row of distances within columns; `none` if there is no background
  long *apex, *start; // parabolas of the lower envelope, and the first pixel of each
  long none;
} Envelope;

// Sets `out` to the distances within columns, up and down.
static CagStatus column_distances(const CagRaster *r, double none, CagRaster *out, CagError *err) {
  const size_t w = r->width, h = r->height;
  double *g = out->data;
  for (size_t y = 0; y < h; y++) {
    const double *v = cag_raster_at(r, 0, 0, y);
    for (size_t x = 0; x < w; x++)
      g[y * w + x] = v[x] == 0 ? 0 : y == 0 ? none : fmin(none, g[(y - 1) * w + x] + 1);
    if (cag_stopped()) return cag_stop_fail(err);
  }
  for (size_t y = h - 1; y-- > 0;)
    for (size_t x = 0; x < w; x++)
      if (g[(y + 1) * w + x] + 1 < g[y * w + x]) g[y * w + x] = g[(y + 1) * w + x] + 1;
  return CAG_OK;
}

static long parabola_at(const Envelope *e, long x, long i) {
  return (x - i) * (x - i) + e->g[i] * e->g[i];
}

// Replaces a row of distances within columns by distances.
static void row_distances(Envelope *e, double *row, long width) {
  long top = -1;
  for (long i = 0; i < width; i++) e->g[i] = (long)row[i];
  for (long u = 0; u < width; u++) {
    if (e->g[u] >= e->none) continue;
    while (top >= 0 &&
           parabola_at(e, e->start[top], e->apex[top]) > parabola_at(e, e->start[top], u))
      top--;
    if (top < 0) {
      e->apex[top = 0] = u;
      e->start[0] = 0;
      continue;
    }
    // The first pixel at which the parabola of u is below the last one, which is on its left.
    const long i = e->apex[top];
    const long above = u * u - i * i + e->g[u] * e->g[u] - e->g[i] * e->g[i];
    const long quotient = above / (2 * (u - i)), rest = above % (2 * (u - i));
    const long start = 1 + quotient - (rest < 0);
    if (start >= width) continue;
    e->apex[++top] = u;
    e->start[top] = start;
  }
  for (long x = width - 1; x >= 0 && top >= 0; x--) {
    row[x] = sqrt((double)parabola_at(e, x, e->apex[top]));
    if (x == e->start[top]) top--;
  }
}

CagStatus cag_distance_transform(const CagRaster *r, CagRaster **out, CagError *err) {
  const size_t w = r->width, n = w * r->height;
  CagRaster *made;
  CagStatus status = cag_raster_new(w, r->height, 1, &made, err);
  if (status) return status;
  Envelope e = {.none = (long)(w + r->height)};
  e.g = cag_malloc(w * sizeof *e.g);
  e.apex = cag_malloc(w * sizeof *e.apex);
  e.start = cag_malloc(w * sizeof *e.start);
  if (!e.g || !e.apex || !e.start) status = cag_fail_memory(err);
  if (!status) status = column_distances(r, (double)e.none, made, err);
  bool any = false; // background
  for (size_t i = 0; i < n && !any; i++) any = r->data[i] == 0;
  for (size_t y = 0; !status && any && y < r->height; y++) {
    row_distances(&e, cag_raster_at(made, 0, 0, y), (long)w);
    status = cag_stop_check(err);
  }
  for (size_t i = 0; i < n; i++)
    if (!any || isnan(r->data[i])) made->data[i] = NAN;
  cag_free(e.g);
  cag_free(e.apex);
  cag_free(e.start);
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}
