#include "geom/image/resample.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/layout.h"

// --- Means over areas ---
//
// Both directions use integers: of n old and m new pixels, old pixel i is the interval m i .. m (i
// + 1), and new pixel k the interval n k .. n (k + 1). So the weights, their overlaps, are exact.
// The largest coordinate is the square of CAG_RASTER_SIDE_MAX.

// The overlap of old pixel i and new pixel k.
static size_t overlap(size_t i, size_t n, size_t k, size_t m) {
  const size_t low = m * i > n * k ? m * i : n * k;
  const size_t high = m * (i + 1) < n * (k + 1) ? m * (i + 1) : n * (k + 1);
  return high > low ? high - low : 0;
}

// A row reduced to the new width: the weighted sums of samples, and the weights of those that have
// a value.
typedef struct Reduced {
  double *sums, *weights;
} Reduced;

static void reduce_row(const double *row, size_t n, size_t m, Reduced out) {
  for (size_t k = 0, i = 0; k < m; k++) {
    double sum = 0, weight = 0;
    while (m * (i + 1) <= n * k) i++;
    for (size_t at = i; at < n && m * at < n * (k + 1); at++) {
      if (isnan(row[at])) continue;
      const double w = (double)overlap(at, n, k, m);
      sum += w * row[at];
      weight += w;
    }
    out.sums[k] = sum;
    out.weights[k] = weight;
  }
}

// The buffers of a resize: the reduced row `known` of the current channel, and the accumulated new
// row.
typedef struct Resizing {
  const CagRaster *from;
  CagRaster *to;
  Reduced row, total;
  size_t known;
} Resizing;

static void add_row(Resizing *z, double weight) {
  for (size_t k = 0; k < z->to->width; k++) {
    z->total.sums[k] += weight * z->row.sums[k];
    z->total.weights[k] += weight * z->row.weights[k];
  }
}

static void resize_row(Resizing *z, size_t c, size_t y) {
  const size_t n = z->from->height, m = z->to->height, width = z->to->width;
  memset(z->total.sums, 0, width * sizeof(double));
  memset(z->total.weights, 0, width * sizeof(double));
  for (size_t i = n * y / m; i < n && m * i < n * (y + 1); i++) {
    if (i != z->known) reduce_row(cag_raster_at(z->from, c, 0, i), z->from->width, width, z->row);
    z->known = i; // new rows share only the last old row, so each is reduced once
    add_row(z, (double)overlap(i, n, y, m));
  }
  double *to = cag_raster_at(z->to, c, 0, y);
  for (size_t k = 0; k < width; k++) {
    const double mean = z->total.sums[k] / z->total.weights[k];
    to[k] = z->total.weights[k] > 0 && isfinite(mean) ? mean : NAN;
  }
}

CagStatus cag_raster_resize(const CagRaster *r, size_t width, size_t height, CagRaster **out,
                            CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_new(width, height, r->channel_count, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    status = cag_raster_name(made, c, r->names[c], err);
  double *room = status ? NULL : cag_malloc(4 * width * sizeof *room);
  if (!status && !room) status = cag_fail_memory(err);
  if (!status) {
    Resizing z = {.from = r,
                  .to = made,
                  .row = {room, room + width},
                  .total = {room + 2 * width, room + 3 * width}};
    for (size_t c = 0; !status && c < r->channel_count; c++) {
      z.known = r->height;
      for (size_t y = 0; !status && y < height; y++) {
        resize_row(&z, c, y);
        status = cag_stop_check(err);
      }
    }
  }
  cag_free(room);
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

// --- Turning ---

// An angle is a quarter turn within the rounding of an angle in degrees converted to radians.
#define QUARTER_SLACK 1e-13
// Excess of a side, in pixels, that is rounding: no row of pixels is added for it.
#define SIDE_SLACK 1e-9

// The old pixel on either side of a coordinate between 0 and n, and the fraction from the first to
// the second.
typedef struct Between {
  size_t first, second;
  double fraction;
} Between;

static Between between_centers(double x, size_t n) {
  const double at = fmin(fmax(x - 0.5, 0), (double)n - 1);
  const size_t first = (size_t)at;
  return (Between){first, first + 1 < n ? first + 1 : first, at - (double)first};
}

// a (1 - t) + b t. A value of weight 0 may be missing.
static double mix(double a, double b, double t) {
  return t == 0 ? a : t == 1 ? b : a + (b - a) * t;
}

static double interpolate(const CagRaster *r, size_t c, Between x, Between y) {
  const double *top = cag_raster_at(r, c, 0, y.first), *low = cag_raster_at(r, c, 0, y.second);
  const double upper = mix(top[x.first], top[x.second], x.fraction);
  if (y.fraction == 0) return upper;
  return mix(upper, mix(low[x.first], low[x.second], x.fraction), y.fraction);
}

static void turn_row(const CagRaster *r, double cosine, double sine, double outside,
                     CagRaster *made, size_t y) {
  const double w = (double)r->width, h = (double)r->height;
  // Relative to the center, x right and y up.
  const double py = (double)made->height / 2 - ((double)y + 0.5);
  for (size_t i = 0; i < made->width; i++) {
    const double px = (double)i + 0.5 - (double)made->width / 2;
    const double x = w / 2 + cosine * px + sine * py, down = h / 2 - (cosine * py - sine * px);
    const bool inside = x >= 0 && x <= w && down >= 0 && down <= h;
    const Between across = between_centers(x, r->width), along = between_centers(down, r->height);
    for (size_t c = 0; c < r->channel_count; c++)
      *cag_raster_at(made, c, i, y) = inside ? interpolate(r, c, across, along) : outside;
  }
}

// A side of the box around the turned image, as a number of pixels that the size limit rejects if
// it is too large.
static size_t side_of_box(double a, double b) {
  const double side = ceil(fabs(a) + fabs(b) - SIDE_SLACK);
  return side < 1 ? 1 : (size_t)side;
}

CagStatus cag_raster_turn(const CagRaster *r, double angle, double outside, CagRaster **out,
                          CagError *err) {
  const double quarters = rint(angle / M_PI_2);
  if (fabs(angle - quarters * M_PI_2) <= QUARTER_SLACK * fmax(1, fabs(angle)))
    return cag_raster_quarter_turns(r, (int)(quarters - 4 * floor(quarters / 4)), out, err);
  const double cosine = cos(angle), sine = sin(angle);
  const double w = (double)r->width, h = (double)r->height;
  CagRaster *made;
  CagStatus status =
      cag_raster_new(side_of_box(w * cosine, h * sine), side_of_box(w * sine, h * cosine),
                     r->channel_count, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    status = cag_raster_name(made, c, r->names[c], err);
  for (size_t y = 0; !status && y < made->height; y++) {
    turn_row(r, cosine, sine, outside, made, y);
    status = cag_stop_check(err);
  }
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}
