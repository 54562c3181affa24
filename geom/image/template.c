#include "geom/image/template.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"

// The sum of squares of a window about its mean, as a fraction of the sum of squares, below which
// the window is of one gray value.
#define ONE_GRAY 1e-20
// A side of a rotated template that exceeds a whole number of pixels by less is rounded down.
#define WHOLE_PIXELS 1e-9

static CagStatus check_channels(const CagRaster *image, const CagRaster *pattern, CagError *err) {
  if (image->channel_count != pattern->channel_count)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_several_channels, "", -1,
                    "expected a template with %zu channels, as the image, found %zu",
                    image->channel_count, pattern->channel_count);
  return CAG_OK;
}

static CagStatus fail_larger(const CagRaster *image, size_t width, size_t height, CagError *err) {
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_template_larger_than_image, "", -1,
                  "expected a template of at most %zu x %zu pixels, as the image, found %zu x %zu",
                  image->width, image->height, width, height);
}

static CagStatus map_of_shifts(const CagRaster *image, const CagRaster *pattern, CagRaster **out,
                               CagError *err) {
  CagStatus status = check_channels(image, pattern, err);
  if (status) return status;
  if (pattern->width > image->width || pattern->height > image->height)
    return fail_larger(image, pattern->width, pattern->height, err);
  return cag_raster_new(image->width - pattern->width + 1, image->height - pattern->height + 1, 1,
                        out, err);
}

// --- Sums of squared differences ---

// Adds to errors[0 .. n) those of row j of the template at the shifts [x0 + i, y].
static void row_errors(const CagRaster *image, const CagRaster *pattern, size_t j, size_t x0,
                       size_t y, size_t n, double *errors) {
  for (size_t c = 0; c < image->channel_count; c++)
    for (size_t i = 0; i < pattern->width; i++) {
      const double t = *cag_raster_at(pattern, c, i, j);
      const double *v = cag_raster_at(image, c, x0 + i, y + j);
      if (isnan(t)) continue;
      for (size_t x = 0; x < n; x++) errors[x] += (v[x] - t) * (v[x] - t);
    }
}

CagStatus cag_template_errors(const CagRaster *image, const CagRaster *pattern, CagRaster **out,
                              CagError *err) {
  CagRaster *map;
  CagStatus status = map_of_shifts(image, pattern, &map, err);
  if (status) return status;
  for (size_t y = 0; !status && y < map->height; y++)
    for (size_t j = 0; !status && j < pattern->height; j++) {
      row_errors(image, pattern, j, 0, y, map->width, cag_raster_at(map, 0, 0, y));
      status = cag_stop_check(err);
    }
  if (status) cag_raster_release(map);
  else *out = map;
  return status;
}

// --- The best shift ---

// The box of all parts, relative to their common shift.
typedef struct Frame {
  long left, top, right, bottom;
} Frame;

static Frame frame_of_parts(const CagTemplatePart *parts, size_t n) {
  Frame f = {parts[0].dx, parts[0].dy, parts[0].dx, parts[0].dy};
  for (size_t k = 0; k < n; k++) {
    const CagTemplatePart *p = &parts[k];
    const long right = p->dx + (long)p->pattern->width, bottom = p->dy + (long)p->pattern->height;
    if (p->dx < f.left) f.left = p->dx;
    if (p->dy < f.top) f.top = p->dy;
    if (right > f.right) f.right = right;
    if (bottom > f.bottom) f.bottom = bottom;
  }
  return f;
}

// Whether an error can still be less than the best one: a sum of squares only grows.
static bool may_be_best(const double *errors, size_t n, double best) {
  bool any = false;
  for (size_t x = 0; x < n; x++) any |= errors[x] < best;
  return any;
}

// A search, with room for the errors of a row of shifts.
typedef struct Search {
  const CagRaster *image;
  const CagTemplatePart *parts;
  size_t count;
  Frame frame;
  size_t shifts;
  double *errors;
  CagMatch best;
} Search;

// Searches the shifts at which the upper left corner of the frame is in row y.
static CagStatus search_row(Search *s, size_t y, CagError *err) {
  memset(s->errors, 0, s->shifts * sizeof *s->errors);
  for (size_t k = 0; k < s->count; k++) {
    const CagTemplatePart *p = &s->parts[k];
    const size_t dx = (size_t)(p->dx - s->frame.left), dy = (size_t)(p->dy - s->frame.top);
    for (size_t j = 0; j < p->pattern->height; j++) {
      row_errors(s->image, p->pattern, j, dx, y + dy, s->shifts, s->errors);
      if (cag_stopped()) return cag_stop_fail(err);
      if (!may_be_best(s->errors, s->shifts, s->best.error)) return CAG_OK;
    }
  }
  for (size_t x = 0; x < s->shifts; x++)
    if (s->errors[x] < s->best.error) {
      s->best.found = true;
      s->best.x = (long)x - s->frame.left;
      s->best.y = (long)y - s->frame.top;
      s->best.error = s->errors[x];
    }
  return CAG_OK;
}

static size_t count_samples(const CagTemplatePart *parts, size_t n) {
  size_t counted = 0;
  for (size_t k = 0; k < n; k++) {
    const CagRaster *p = parts[k].pattern;
    const size_t samples = p->width * p->height * p->channel_count;
    for (size_t i = 0; i < samples; i++) counted += !isnan(p->data[i]);
  }
  return counted;
}

CagStatus cag_template_find(const CagRaster *image, const CagTemplatePart *parts, size_t n,
                            CagMatch *out, CagError *err) {
  const Frame f = frame_of_parts(parts, n);
  const size_t width = (size_t)(f.right - f.left), height = (size_t)(f.bottom - f.top);
  Search s = {.image = image, .parts = parts, .count = n, .frame = f};
  CagStatus status = CAG_OK;
  for (size_t k = 0; !status && k < n; k++) status = check_channels(image, parts[k].pattern, err);
  if (status) return status;
  if (width > image->width || height > image->height) return fail_larger(image, width, height, err);
  s.best = (CagMatch){.error = INFINITY, .counted = count_samples(parts, n)};
  s.shifts = image->width - width + 1;
  s.errors = cag_malloc(s.shifts * sizeof *s.errors);
  if (!s.errors) return cag_fail_memory(err);
  for (size_t y = 0; !status && y + height <= image->height; y++) status = search_row(&s, y, err);
  cag_free(s.errors);
  if (!status) *out = s.best;
  return status;
}

// --- Correlation ---

// The sums for a row of shifts.
typedef struct Correlation {
  const CagRaster *image, *pattern;
  size_t shifts;
  bool zero_mean;
  double mean;                               // of the template
  double *window, *products, *squares, *raw; // means of windows; sums, of `raw` about 0
} Correlation;

// Calls for each sample of the template that has a value.
typedef void SampleRow(const Correlation *c, double t, const double *v);

static CagStatus for_samples(const Correlation *c, size_t y, SampleRow *f, CagError *err) {
  for (size_t k = 0; k < c->pattern->channel_count; k++)
    for (size_t j = 0; j < c->pattern->height; j++) {
      for (size_t i = 0; i < c->pattern->width; i++) {
        const double t = *cag_raster_at(c->pattern, k, i, j);
        if (!isnan(t)) f(c, t, cag_raster_at(c->image, k, i, y + j));
      }
      if (cag_stopped()) return cag_stop_fail(err);
    }
  return CAG_OK;
}

static void add_means(const Correlation *c, double t, const double *v) {
  (void)t;
  for (size_t x = 0; x < c->shifts; x++) c->window[x] += v[x];
}

static void add_products(const Correlation *c, double t, const double *v) {
  for (size_t x = 0; x < c->shifts; x++) {
    const double d = v[x] - c->window[x];
    c->products[x] += d * (t - c->mean);
    c->squares[x] += d * d;
    c->raw[x] += v[x] * v[x];
  }
}

// One root is more accurate than two, if the product has a normal double.
static double root_of_product(double a, double b) {
  return isnormal(a * b) ? sqrt(a * b) : sqrt(a) * sqrt(b);
}

static CagStatus correlation_row(const Correlation *c, size_t y, double counted,
                                 double template_squares, double *out, CagError *err) {
  CagStatus status = CAG_OK;
  const size_t size = c->shifts * sizeof *out;
  memset(c->window, 0, size);
  memset(c->products, 0, size);
  memset(c->squares, 0, size);
  memset(c->raw, 0, size);
  if (c->zero_mean) status = for_samples(c, y, add_means, err);
  for (size_t x = 0; x < c->shifts && counted > 0; x++) c->window[x] /= counted;
  if (!status) status = for_samples(c, y, add_products, err);
  for (size_t x = 0; !status && x < c->shifts; x++) {
    const bool flat = template_squares == 0 || c->squares[x] <= ONE_GRAY * c->raw[x];
    const double m = c->products[x] / root_of_product(c->squares[x], template_squares);
    out[x] = flat ? 0 : isnan(m) ? NAN : fmax(-1, fmin(1, m));
  }
  return status;
}

// The mean of the template, and its sum of squares about the mean; without `zero_mean`, about 0.
static double template_sums(Correlation *c, double *counted) {
  const CagRaster *p = c->pattern;
  const size_t n = p->width * p->height * p->channel_count;
  double sum = 0, squares = 0, raw = 0;
  *counted = 0;
  for (size_t i = 0; i < n; i++) {
    if (isnan(p->data[i])) continue;
    sum += p->data[i];
    raw += p->data[i] * p->data[i];
    ++*counted;
  }
  c->mean = c->zero_mean && *counted > 0 ? sum / *counted : 0;
  for (size_t i = 0; i < n; i++)
    if (!isnan(p->data[i])) squares += (p->data[i] - c->mean) * (p->data[i] - c->mean);
  return squares <= ONE_GRAY * raw ? 0 : squares;
}

CagStatus cag_template_correlation(const CagRaster *image, const CagRaster *pattern, bool zero_mean,
                                   CagRaster **out, CagError *err) {
  CagRaster *map;
  CagStatus status = map_of_shifts(image, pattern, &map, err);
  if (status) return status;
  Correlation c = {
      .image = image, .pattern = pattern, .shifts = map->width, .zero_mean = zero_mean};
  double counted, *room = cag_malloc(4 * map->width * sizeof *room);
  const double squares = template_sums(&c, &counted);
  if (!room) status = cag_fail_memory(err);
  if (!status) {
    c.window = room;
    c.products = room + c.shifts;
    c.squares = room + 2 * c.shifts;
    c.raw = room + 3 * c.shifts;
  }
  for (size_t y = 0; !status && y < map->height; y++)
    status = correlation_row(&c, y, counted, squares, cag_raster_at(map, 0, 0, y), err);
  cag_free(room);
  if (status) cag_raster_release(map);
  else *out = map;
  return status;
}

// --- Rotated templates ---

// The side in pixels that contains a length.
static size_t side_for(double length) {
  const double side = ceil(length - WHOLE_PIXELS);
  return side < 1 ? 1 : side > (double)CAG_RASTER_SIDE_MAX ? CAG_RASTER_SIDE_MAX + 1 : (size_t)side;
}

// Pixel [x, y] of the template rotated by `turns` quarters.
static double quarter_sample(const CagRaster *p, size_t c, int turns, size_t x, size_t y) {
  const size_t w = p->width - 1, h = p->height - 1;
  switch (turns) {
  case 0: return *cag_raster_at(p, c, x, y);
  case 1: return *cag_raster_at(p, c, w - y, x);
  case 2: return *cag_raster_at(p, c, w - x, h - y);
  default: return *cag_raster_at(p, c, y, h - x);
  }
}

// The value at a point, y down, by linear interpolation between the centers of pixels, and NaN
// outside of the raster.
static double linear_sample(const CagRaster *p, size_t c, double x, double y) {
  const double w = (double)p->width, h = (double)p->height;
  if (!(x >= 0 && x <= w && y >= 0 && y <= h)) return NAN;
  const double fx = fmax(0, fmin(w - 1, x - 0.5)), fy = fmax(0, fmin(h - 1, y - 0.5));
  const size_t i = (size_t)fx, j = (size_t)fy;
  const size_t right = i + (i + 1 < p->width), down = j + (j + 1 < p->height);
  const double s = fx - (double)i, t = fy - (double)j;
  const double upper = (1 - s) * *cag_raster_at(p, c, i, j) + s * *cag_raster_at(p, c, right, j);
  const double lower =
      (1 - s) * *cag_raster_at(p, c, i, down) + s * *cag_raster_at(p, c, right, down);
  return (1 - t) * upper + t * lower;
}

static void sample_turned(const CagRaster *p, double cosine, double sine, double scale,
                          CagRaster *out) {
  for (size_t y = 0; y < out->height && !cag_stopped(); y++)
    for (size_t x = 0; x < out->width; x++) {
      // From the center of the result, y down, back to the template.
      const double dx = ((double)x + 0.5 - (double)out->width / 2) / scale;
      const double dy = ((double)y + 0.5 - (double)out->height / 2) / scale;
      const double u = cosine * dx - sine * dy + (double)p->width / 2;
      const double v = sine * dx + cosine * dy + (double)p->height / 2;
      for (size_t c = 0; c < p->channel_count; c++)
        *cag_raster_at(out, c, x, y) = linear_sample(p, c, u, v);
    }
}

CagStatus cag_template_turned(const CagRaster *pattern, double degrees, double scale,
                              CagRaster **out, CagError *err) {
  const CagRaster *p = pattern;
  const double quarter = 90, turn = degrees - 4 * quarter * floor(degrees / (4 * quarter));
  const double angle = turn * (M_PI / 180), cosine = cos(angle), sine = sin(angle);
  const bool quarters = scale == 1 && fmod(turn, quarter) == 0;
  const int turns = (int)(turn / quarter) % 4;
  const double w = (double)p->width * scale, h = (double)p->height * scale;
  size_t width = side_for(w * fabs(cosine) + h * fabs(sine));
  size_t height = side_for(w * fabs(sine) + h * fabs(cosine));
  CagRaster *made;
  if (quarters) {
    width = turns % 2 ? p->height : p->width;
    height = turns % 2 ? p->width : p->height;
  }
  CagStatus status = cag_raster_new(width, height, p->channel_count, &made, err);
  if (status) return status;
  if (!quarters) sample_turned(p, cosine, sine, scale, made);
  for (size_t c = 0; quarters && c < p->channel_count; c++)
    for (size_t y = 0; y < height; y++)
      for (size_t x = 0; x < width; x++)
        *cag_raster_at(made, c, x, y) = quarter_sample(p, c, turns, x, y);
  *out = made;
  return CAG_OK;
}
