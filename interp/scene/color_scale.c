// Perceptually uniform color scales: viridis (Smith and van der Walt, 2015) for values from low to
// high, and Moreland's cool-to-warm (2009) for values about a middle, both interpolated between
// sRGB samples. Stripes change sharply.

#include "interp/scene/color_scale.h"

#define SAMPLES 11
// The number of stops that approximate a smooth scale. Between them, the difference between linear
// light and sRGB is invisible.
#define SMOOTH_STOPS 41

static const unsigned sequence[SAMPLES] = {0x440154, 0x482475, 0x414487, 0x355f8d,
                                           0x2a788e, 0x21918c, 0x22a884, 0x44bf70,
                                           0x7ad151, 0xbddf26, 0xfde725};
static const unsigned diverging[SAMPLES] = {0x3b4cc0, 0x5977e3, 0x7b9ff9, 0x9ebeff,
                                            0xc0d4f5, 0xdddcdc, 0xf2cbb7, 0xf7ac8e,
                                            0xee8468, 0xd65244, 0xb40426};
#define LIGHT_STRIPE 0xf4f4f2
#define DARK_STRIPE 0x15181d
#define NO_NUMBER 0x808080

// Splits 0xrrggbb into red, green, and blue in sRGB, 0..1.
static void split(unsigned rgb, double out[3]) {
  const double whole = 255;
  for (int k = 0; k < 3; k++) out[k] = (double)(rgb >> (16 - 8 * k) & 0xff) / whole;
}

static CagColor mixed(unsigned a, unsigned b, double t) {
  double x[3], y[3];
  split(a, x);
  split(b, y);
  for (int k = 0; k < 3; k++) x[k] = cag_srgb_to_linear(x[k] + t * (y[k] - x[k]));
  return (CagColor){x[0], x[1], x[2]};
}

static CagColor color_at(const CagColorScale *scale, double t) {
  t = fmin(fmax(t, 0), 1);
  if (scale->kind == CAG_SCALE_STRIPES) {
    double stripe = fmin(floor(2 * scale->stripes * t), 2 * scale->stripes - 1);
    return mixed(fmod(stripe, 2) == 0 ? LIGHT_STRIPE : DARK_STRIPE, 0, 0);
  }
  const unsigned *samples = scale->kind == CAG_SCALE_DIVERGING ? diverging : sequence;
  int i = (int)fmin(floor(t * (SAMPLES - 1)), SAMPLES - 2);
  return mixed(samples[i], samples[i + 1], t * (SAMPLES - 1) - i);
}

CagColor cag_color_scale_at(const CagColorScale *scale, double value) {
  if (isnan(value)) return mixed(NO_NUMBER, 0, 0);
  return color_at(scale, (value - scale->from) / (scale->to - scale->from));
}

size_t cag_color_scale_stops(const CagColorScale *scale, CagColorStop out[CAG_SCALE_STOPS_MAX]) {
  size_t n = 0;
  if (scale->kind == CAG_SCALE_STRIPES) {
    int stripes = 2 * scale->stripes;
    for (int i = 0; i < stripes; i++) {
      CagColor c = color_at(scale, (i + 0.5) / stripes);
      out[n++] = (CagColorStop){(double)i / stripes, c};
      out[n++] = (CagColorStop){(double)(i + 1) / stripes, c};
    }
    return n;
  }
  for (int i = 0; i < SMOOTH_STOPS; i++) {
    double t = (double)i / (SMOOTH_STOPS - 1);
    out[n++] = (CagColorStop){t, color_at(scale, t)};
  }
  return n;
}
