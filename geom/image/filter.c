#include "geom/image/filter.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"

// A Gaussian is cut where it is below exp(-8) of its maximum.
#define BLUR_REACH 4

// --- Median and majority ---

static void sort_pair(double *a, double *b) {
  const double low = *a < *b ? *a : *b, high = *a < *b ? *b : *a;
  *a = low;
  *b = high;
}

// The median of nine numbers by 19 exchanges (Paeth 1990).
static double median_of_nine(double p[9]) {
  static const unsigned char pairs[19][2] = {{1, 2}, {4, 5}, {7, 8}, {0, 1}, {3, 4}, {6, 7}, {1, 2},
                                             {4, 5}, {7, 8}, {0, 3}, {5, 8}, {4, 7}, {3, 6}, {1, 4},
                                             {2, 5}, {4, 7}, {4, 2}, {6, 4}, {4, 2}};
  for (int i = 0; i < 19; i++) sort_pair(&p[pairs[i][0]], &p[pairs[i][1]]);
  return p[4];
}

// The k-th smallest of n numbers, which are reordered so that smaller ones are before it (Wirth 1976,
// "Find").
static double select_number(double *p, long n, long k) {
  long low = 0, high = n - 1;
  while (low < high) {
    const double pivot = p[k];
    long i = low, j = high;
    do {
      while (p[i] < pivot) i++;
      while (pivot < p[j]) j--;
      if (i <= j) sort_pair(&p[i++], &p[j--]);
    } while (i <= j);
    if (j < k) low = i;
    if (k < i) high = j;
  }
  return p[k];
}

static double median_of(double *p, size_t n) {
  if (n == 0) return NAN;
  const double upper = select_number(p, (long)n, (long)n / 2);
  if (n % 2) return upper;
  double lower = p[0];
  for (size_t i = 1; i < n / 2; i++) lower = fmax(lower, p[i]);
  return lower + (upper - lower) / 2;
}

typedef struct Median {
  size_t size;
  double *room; // size x size
} Median;

static void median_row(const void *context, const double *const *rows, size_t width, bool has_none,
                       double *out) {
  const Median *m = context;
  if (m->size == 3 && !has_none) {
    const double *a = rows[0], *b = rows[1], *c = rows[2];
    for (size_t x = 0; x < width; x++) {
      double p[9] = {a[x], a[x + 1], a[x + 2], b[x], b[x + 1], b[x + 2], c[x], c[x + 1], c[x + 2]};
      out[x] = median_of_nine(p);
    }
    return;
  }
  for (size_t x = 0; x < width && !cag_stopped(); x++) {
    size_t n = 0;
    for (size_t j = 0; j < m->size; j++)
      for (size_t i = x; i < x + m->size; i++)
        if (!isnan(rows[j][i])) m->room[n++] = rows[j][i];
    out[x] = median_of(m->room, n);
  }
}

CagStatus cag_image_median(const CagRaster *r, size_t size, CagBorder border, CagRaster **out,
                           CagError *err) {
  Median m = {.size = size, .room = cag_malloc(size * size * sizeof *m.room)};
  if (!m.room) return cag_fail_memory(err);
  CagStatus status = cag_window_image(r, size / 2, size / 2, border, median_row, &m, out, err);
  cag_free(m.room);
  return status;
}

static void majority_row(const void *context, const double *const *rows, size_t width,
                         bool has_none, double *out) {
  (void)context;
  (void)has_none;
  for (size_t x = 0; x < width; x++) {
    int set = 0, clear = 0;
    for (int j = 0; j < 3; j++)
      for (size_t i = x; i < x + 3; i++) {
        set += !isnan(rows[j][i]) && rows[j][i] != 0;
        clear += rows[j][i] == 0;
      }
    out[x] = set + clear ? set > clear : NAN;
  }
}

CagStatus cag_image_majority(const CagRaster *r, CagBorder border, CagRaster **out, CagError *err) {
  return cag_window_image(r, 1, 1, border, majority_row, NULL, out, err);
}

// --- Sharpness ---

static void sharpen_row(const void *context, const double *const *rows, size_t width, bool has_none,
                        double *out) {
  const double k = *(const double *)context;
  (void)has_none;
  for (size_t x = 0; x < width; x++) {
    const double v = rows[1][x + 1];
    out[x] = v - k * (rows[0][x + 1] + rows[2][x + 1] + rows[1][x] + rows[1][x + 2] - 4 * v);
  }
}

CagStatus cag_image_sharpen(const CagRaster *r, double k, CagBorder border, CagRaster **out,
                            CagError *err) {
  return cag_window_image(r, 1, 1, border, sharpen_row, &k, out, err);
}

// --- Single pixels ---

bool cag_image_range(const CagRaster *r, double *low, double *high) {
  const size_t n = r->width * r->height * r->channel_count;
  *low = INFINITY;
  *high = -INFINITY;
  for (size_t i = 0; i < n; i++) {
    if (r->data[i] < *low) *low = r->data[i];
    if (r->data[i] > *high) *high = r->data[i];
  }
  return *low <= *high;
}

// Maps each pixel v to (v - low) factor.
typedef struct Stretch {
  double low, factor;
} Stretch;

static void stretch_row(const void *context, const double *const *rows, size_t width, bool has_none,
                        double *out) {
  const Stretch *s = context;
  (void)has_none;
  for (size_t x = 0; x < width; x++) out[x] = (rows[0][x] - s->low) * s->factor;
}

CagStatus cag_image_stretch(const CagRaster *r, double low, double high, double top,
                            CagRaster **out, CagError *err) {
  const bool same = low == high;
  const Stretch s = {same ? 0 : low, same ? 1 : top / (high - low)};
  return cag_window_image(r, 0, 0, CAG_BORDER_ZERO, stretch_row, &s, out, err);
}

typedef struct Threshold {
  double least;
  bool keep;
} Threshold;

static void threshold_row(const void *context, const double *const *rows, size_t width,
                          bool has_none, double *out) {
  const Threshold *t = context;
  const double *v = rows[0];
  (void)has_none;
  for (size_t x = 0; x < width; x++)
    out[x] = isnan(v[x]) ? v[x] : v[x] < t->least ? 0 : t->keep ? v[x] : 1;
}

CagStatus cag_image_threshold(const CagRaster *r, double t, bool keep, CagRaster **out,
                              CagError *err) {
  const Threshold threshold = {t, keep};
  return cag_window_image(r, 0, 0, CAG_BORDER_ZERO, threshold_row, &threshold, out, err);
}

// --- Convolution ---

typedef struct Kernel {
  const double *weights;
  size_t width, height;
} Kernel;

static void convolve_row(const void *context, const double *const *rows, size_t width,
                         bool has_none, double *out) {
  const Kernel *k = context;
  (void)has_none;
  memset(out, 0, width * sizeof *out);
  for (size_t j = 0; j < k->height; j++)
    for (size_t i = 0; i < k->width; i++) {
      const double w = k->weights[(k->height - 1 - j) * k->width + (k->width - 1 - i)];
      const double *v = rows[j] + i;
      for (size_t x = 0; x < width; x++) out[x] += w * v[x];
    }
}

CagStatus cag_image_convolve(const CagRaster *r, const double *kernel, size_t width, size_t height,
                             CagBorder border, CagRaster **out, CagError *err) {
  const Kernel k = {kernel, width, height};
  return cag_window_image(r, width / 2, height / 2, border, convolve_row, &k, out, err);
}

CagStatus cag_image_blur(const CagRaster *r, double sigma, CagBorder border, CagRaster **out,
                         CagError *err) {
  const size_t reach = (size_t)ceil(BLUR_REACH * sigma), n = 2 * reach + 1;
  double *weights = cag_malloc(n * sizeof *weights), sum = 0;
  CagRaster *across = NULL;
  if (!weights) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) {
    const double x = (double)i - (double)reach;
    weights[i] = sigma > 0 ? exp(-x * x / (2 * sigma * sigma)) : 1;
    sum += weights[i];
  }
  for (size_t i = 0; i < n; i++) weights[i] /= sum;
  CagStatus status = cag_image_convolve(r, weights, n, 1, border, &across, err);
  if (!status) status = cag_image_convolve(across, weights, 1, n, border, out, err);
  cag_raster_release(across);
  cag_free(weights);
  return status;
}
