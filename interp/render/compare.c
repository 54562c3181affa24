// Comparison of two pictures: statistics per channel, color differences, and a heatmap.

#include "interp/render/compare.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/memory.h"

// Returns the index in b of each channel of a, or sets an error that names the missing channel.
static size_t *match_channels(const CagImage *a, const char *a_name, const CagImage *b,
                              const char *b_name, CagError *err) {
  if (a->width != b->width || a->height != b->height) {
    cag_fail_io(err, CAG_E_ARGUMENT, "compare pictures of the same size",
                "'%s' is %zu by %zu pixels, but '%s' is %zu by %zu", a_name, a->width, a->height,
                b_name, b->width, b->height);
    return NULL;
  }
  size_t *match = cag_malloc(a->channel_count * sizeof *match);
  if (!match) {
    cag_fail_io(err, CAG_E_LIMIT, NULL, "not enough memory to compare '%s'", a_name);
    return NULL;
  }
  const char *missing = NULL, *holder = a_name, *other = b_name;
  for (size_t c = 0; c < a->channel_count && !missing; c++)
    if (!cag_image_find(b, a->channels[c].name, &match[c])) missing = a->channels[c].name;
  size_t ignored;
  for (size_t c = 0; c < b->channel_count && !missing; c++) {
    if (cag_image_find(a, b->channels[c].name, &ignored)) continue;
    missing = b->channels[c].name;
    holder = b_name;
    other = a_name;
  }
  if (!missing) return match;
  cag_fail_io(err, CAG_E_ARGUMENT, "compare pictures with the same channels",
              "'%s' has a channel '%.80s', but '%s' has none of that name", holder, missing, other);
  cag_free(match);
  return NULL;
}

// The difference of two samples, which is infinite if they differ and one is not finite.
static double difference(float x, float y) {
  if (x == y || (isnan(x) && isnan(y))) return 0;
  if (!isfinite(x) || !isfinite(y)) return INFINITY;
  return fabs((double)x - (double)y);
}

static void compare_channel(const float *a, const float *b, size_t width, size_t height,
                            CagCompareChannel *out) {
  double sum = 0;
  out->peak = 1;
  for (size_t y = 0; y < height; y++) {
    double row = 0; // summed by rows, to reduce rounding errors in large pictures
    for (size_t x = 0; x < width; x++) {
      const float p = a[y * width + x], q = b[y * width + x];
      const double d = difference(p, q);
      out->not_finite[0] += !isfinite(p);
      out->not_finite[1] += !isfinite(q);
      if (isfinite(p)) out->peak = fmax(out->peak, fabs((double)p));
      if (isinf(d)) out->unlike++;
      if (!isfinite(p) || !isfinite(q)) continue;
      out->samples++;
      row += d * d;
      if (d <= out->largest) continue;
      out->largest = d;
      out->largest_x = x;
      out->largest_y = y;
    }
    sum += row;
  }
  out->rmse = out->samples ? sqrt(sum / (double)out->samples) : 0;
  out->psnr = out->rmse > 0 ? 20 * log10(out->peak / out->rmse) : INFINITY;
}

// The largest difference of a pixel over all channels.
static double pixel_difference(const CagImage *a, const CagImage *b, const size_t *match,
                               size_t i) {
  double most = 0;
  for (size_t c = 0; c < a->channel_count; c++)
    most = fmax(most, difference(cag_image_plane(a, c)[i], cag_image_plane(b, match[c])[i]));
  return most;
}

static void lab_at(const CagImage *image, const size_t rgb[3], size_t i, double lab[3]) {
  double linear[3];
  for (int k = 0; k < 3; k++) linear[k] = cag_image_plane(image, rgb[k])[i];
  cag_compare_lab(linear, lab);
}

static void compare_colors(const CagImage *a, const CagImage *b, CagCompareReport *out) {
  size_t rgb_a[3], rgb_b[3];
  out->has_color = cag_image_find_color(a, rgb_a) && cag_image_find_color(b, rgb_b);
  if (!out->has_color) return;
  double sum = 0;
  for (size_t y = 0; y < a->height; y++) {
    double row = 0;
    for (size_t i = y * a->width; i < (y + 1) * a->width; i++) {
      bool same = true; // most pixels of similar pictures are equal, and the formula is slow
      for (int k = 0; k < 3; k++)
        same &= cag_image_plane(a, rgb_a[k])[i] == cag_image_plane(b, rgb_b[k])[i];
      if (same) continue;
      double lab_a[3], lab_b[3];
      lab_at(a, rgb_a, i, lab_a);
      lab_at(b, rgb_b, i, lab_b);
      const double e = cag_compare_delta_e(lab_a, lab_b);
      row += e;
      out->delta_e_largest = fmax(out->delta_e_largest, e);
    }
    sum += row;
  }
  out->delta_e_mean = sum / ((double)a->width * (double)a->height);
}

bool cag_compare_images(const CagImage *a, const char *a_name, const CagImage *b,
                        const char *b_name, double threshold, CagCompareReport *out,
                        CagError *err) {
  size_t *match = match_channels(a, a_name, b, b_name, err);
  if (!match) return false;
  CagCompareChannel *channels = cag_calloc(a->channel_count, sizeof *channels);
  if (!channels) {
    cag_free(match);
    return cag_fail_io(err, CAG_E_LIMIT, NULL, "not enough memory to compare '%s'", a_name);
  }
  *out = (CagCompareReport){.width = a->width,
                            .height = a->height,
                            .channel_count = a->channel_count,
                            .channels = channels,
                            .threshold = threshold};
  for (size_t c = 0; c < a->channel_count; c++) {
    memcpy(channels[c].name, a->channels[c].name, sizeof channels[c].name);
    compare_channel(cag_image_plane(a, c), cag_image_plane(b, match[c]), a->width, a->height,
                    &channels[c]);
  }
  for (size_t i = 0; i < a->width * a->height; i++)
    out->differing_pixels += pixel_difference(a, b, match, i) > threshold;
  compare_colors(a, b, out);
  cag_free(match);
  return true;
}

void cag_compare_report_free(CagCompareReport *report) {
  cag_free(report->channels);
  *report = (CagCompareReport){0};
}

void cag_compare_print(const CagCompareReport *r, FILE *out) {
  fprintf(out, "%-12s %12s %12s %14s %10s\n", "channel", "RMSE", "maximum", "at", "PSNR");
  for (size_t c = 0; c < r->channel_count; c++) {
    const CagCompareChannel *n = &r->channels[c];
    char at[48] = "-", psnr[32] = "same";
    if (n->unlike) strcpy(psnr, "-");
    if (n->largest > 0) snprintf(at, sizeof at, "%zu, %zu", n->largest_x, n->largest_y);
    if (isfinite(n->psnr)) snprintf(psnr, sizeof psnr, "%.2f dB", n->psnr);
    fprintf(out, "%-12s %12.6g %12.6g %14s %10s\n", n->name, n->rmse, n->largest, at, psnr);
    if (n->not_finite[0] || n->not_finite[1])
      fprintf(out, "%-12s NaN or infinite: %zu in the first, %zu in the second, %zu different\n",
              "", n->not_finite[0], n->not_finite[1], n->unlike);
  }
  if (r->has_color)
    fprintf(out, "color difference (CIEDE2000): mean %.4g, largest %.4g\n", r->delta_e_mean,
            r->delta_e_largest);
  const double pixels = (double)r->width * (double)r->height;
  fprintf(out, "pixels that differ by more than %g: %zu of %.0f (%.4g%%)\n", r->threshold,
          r->differing_pixels, pixels, 100 * (double)r->differing_pixels / pixels);
}

// The colors of the heatmap: black, red, yellow, and white at 0, 1/3, 2/3, and 1.
static void heat(double t, float *r, float *g, float *b) {
  *r = (float)fmin(3 * t, 1);
  *g = (float)fmin(fmax(3 * t - 1, 0), 1);
  *b = (float)fmin(fmax(3 * t - 2, 0), 1);
}

bool cag_compare_heatmap(const CagImage *a, const CagImage *b, CagImage *out, CagError *err) {
  static const char *const NAMES[4] = {"R", "G", "B", "difference"};
  size_t *match = match_channels(a, "the first picture", b, "the second picture", err);
  if (!match) return false;
  if (!cag_image_create(out, a->width, a->height, 4, err)) {
    cag_free(match);
    return false;
  }
  float *plane[4];
  for (size_t c = 0; c < 4; c++) {
    cag_image_set_name(out, c, NAMES[c]);
    plane[c] = cag_image_plane(out, c);
  }
  double worst = 0;
  for (size_t i = 0; i < a->width * a->height; i++) {
    const double d = pixel_difference(a, b, match, i);
    plane[3][i] = (float)d;
    if (isfinite(d)) worst = fmax(worst, d);
  }
  for (size_t i = 0; i < a->width * a->height; i++) {
    if (isinf(plane[3][i])) plane[0][i] = plane[2][i] = 1;
    else if (worst > 0) heat(plane[3][i] / worst, &plane[0][i], &plane[1][i], &plane[2][i]);
  }
  cag_free(match);
  return true;
}

// From linear sRGB to XYZ (IEC 61966-2-1). The sums of the rows are the white point D65.
static const double XYZ[3][3] = {
    {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};

// The cube root with a linear start (CIE 15). The constants are (6/29)^3 and 3 (6/29)^2.
static double lab_curve(double t) {
  const double delta = 6.0 / 29.0;
  return t > delta * delta * delta ? cbrt(t) : t / (3 * delta * delta) + 4.0 / 29.0;
}

void cag_compare_lab(const double linear_rgb[3], double lab[3]) {
  double f[3];
  for (int k = 0; k < 3; k++) {
    double sum = 0, white = 0;
    for (int c = 0; c < 3; c++) {
      const double v = linear_rgb[c] > 0 ? fmin(linear_rgb[c], 1) : 0; // NaN becomes 0
      sum += XYZ[k][c] * v;
      white += XYZ[k][c];
    }
    f[k] = lab_curve(sum / white);
  }
  lab[0] = 116 * f[1] - 16;
  lab[1] = 500 * (f[0] - f[1]);
  lab[2] = 200 * (f[1] - f[2]);
}

static double degrees(double d) { return d * M_PI / 180; }

// The angle of (a, b) in 0..2 pi, or 0 for gray.
static double hue(double a, double b) {
  if (a == 0 && b == 0) return 0;
  const double h = atan2(b, a);
  return h < 0 ? h + 2 * M_PI : h;
}

// sqrt(c^7 / (c^7 + 25^7)): 0 for gray, 1 for strong color.
static double chroma_weight(double c) {
  const double c7 = pow(c, 7), limit7 = 6103515625.0; // 25^7
  return sqrt(c7 / (c7 + limit7));
}

// The mean of two hues along the shorter arc, and their signed difference.
static void hue_pair(double h1, double h2, bool gray, double *mean, double *step) {
  *step = gray ? 0 : h2 - h1;
  if (*step > M_PI) *step -= 2 * M_PI;
  if (*step < -M_PI) *step += 2 * M_PI;
  if (gray) *mean = h1 + h2;
  else if (fabs(h1 - h2) <= M_PI) *mean = (h1 + h2) / 2;
  else *mean = h1 + h2 < 2 * M_PI ? (h1 + h2 + 2 * M_PI) / 2 : (h1 + h2 - 2 * M_PI) / 2;
}

double cag_compare_delta_e(const double lab1[3], const double lab2[3]) {
  // Equations 2 to 7: chroma and hue, with the a axis stretched near gray.
  const double c_mean = (hypot(lab1[1], lab1[2]) + hypot(lab2[1], lab2[2])) / 2;
  const double stretch = 1 + 0.5 * (1 - chroma_weight(c_mean));
  const double a1 = stretch * lab1[1], a2 = stretch * lab2[1];
  const double c1 = hypot(a1, lab1[2]), c2 = hypot(a2, lab2[2]);
  // Equations 8 to 14: the differences and the means.
  double h, h_step;
  hue_pair(hue(a1, lab1[2]), hue(a2, lab2[2]), c1 * c2 == 0, &h, &h_step);
  const double dl = lab2[0] - lab1[0], dc = c2 - c1;
  const double dh = 2 * sqrt(c1 * c2) * sin(h_step / 2);
  const double l = (lab1[0] + lab2[0]) / 2, c = (c1 + c2) / 2;
  // Equations 15 to 21: the weights.
  const double t = 1 - 0.17 * cos(h - degrees(30)) + 0.24 * cos(2 * h) +
                   0.32 * cos(3 * h + degrees(6)) - 0.20 * cos(4 * h - degrees(63));
  const double turn = (h - degrees(275)) / degrees(25);
  const double rotation = -sin(2 * degrees(30) * exp(-turn * turn)) * 2 * chroma_weight(c);
  const double l50 = (l - 50) * (l - 50);
  const double sl = 1 + 0.015 * l50 / sqrt(20 + l50);
  const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
  // Equation 22.
  const double x = dl / sl, y = dc / sc, z = dh / sh;
  return sqrt(fmax(0, x * x + y * y + z * z + rotation * y * z));
}
