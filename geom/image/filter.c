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

static double lesser(double a, double b) { return a < b ? a : b; }
static double greater(double a, double b) { return a < b ? b : a; }
static double middle_of(double a, double b, double c) {
  return greater(lesser(a, b), lesser(greater(a, b), c));
}

// The columns of windows that are sorted together.
#define STRIP 256

// Medians of 3 x 3 pixels. Each column of three is sorted once; the median is that of the greatest
// of the least, the middle of the middle, and the least of the greatest numbers of three columns
// (Kopp and Purgathofer 1994).
static void medians_of_nine(const double *a, const double *b, const double *c, size_t width,
                            double *out) {
  double low[STRIP + 2], middle[STRIP + 2], high[STRIP + 2];
  for (size_t from = 0; from < width; from += STRIP) {
    const size_t n = width - from < STRIP ? width - from : STRIP;
    for (size_t i = 0; i < n + 2; i++) {
      const double p = a[from + i], q = b[from + i], r = c[from + i];
      low[i] = lesser(lesser(p, q), r);
      middle[i] = middle_of(p, q, r);
      high[i] = greater(greater(p, q), r);
    }
    for (size_t i = 0; i < n; i++)
      out[from + i] = middle_of(greater(greater(low[i], low[i + 1]), low[i + 2]),
                                middle_of(middle[i], middle[i + 1], middle[i + 2]),
                                lesser(lesser(high[i], high[i + 1]), high[i + 2]));
  }
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
    medians_of_nine(rows[0], rows[1], rows[2], width, out);
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
  const CagWindow w = {size / 2, size / 2, border, median_row, &m};
  CagStatus status = cag_window_image(r, &w, out, err);
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
  const CagWindow w = {1, 1, border, majority_row, NULL};
  return cag_window_image(r, &w, out, err);
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
  const CagWindow w = {1, 1, border, sharpen_row, &k};
  return cag_window_image(r, &w, out, err);
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
  const CagWindow w = {0, 0, CAG_BORDER_ZERO, stretch_row, &s};
  return cag_window_image(r, &w, out, err);
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
  const CagWindow w = {0, 0, CAG_BORDER_ZERO, threshold_row, &threshold};
  return cag_window_image(r, &w, out, err);
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
  const CagWindow w = {width / 2, height / 2, border, convolve_row, &k};
  return cag_window_image(r, &w, out, err);
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
