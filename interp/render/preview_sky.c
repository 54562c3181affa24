#include "interp/render/preview_sky.h"

#include "interp/render/exr.h"

CagStatus cag_preview_sky_load(const CagScene *s, CagPreviewSky *out, CagError *err) {
  *out = (CagPreviewSky){.scene = s, .lights = s->sky.color_count > 0 || s->sky.image};
  if (!s->sky.image) return CAG_OK;
  size_t channels[3];
  if (!cag_exr_read(s->sky.image, &out->image, NULL, err)) return err->status;
  if (!cag_image_find_color(&out->image, channels)) {
    cag_preview_sky_free(out);
    return cag_fail_io(err, CAG_E_FILE, NULL, "the sky `%s` has no color channels", s->sky.image);
  }
  for (int k = 0; k < 3; k++) out->rgb[k] = cag_image_plane(&out->image, channels[k]);
  return CAG_OK;
}

void cag_preview_sky_free(CagPreviewSky *sky) {
  cag_image_free(&sky->image);
  *sky = (CagPreviewSky){0};
}

static CagColor gradient_color(const CagSky *sky, CagVec3 direction) {
  const size_t n = sky->color_count;
  if (n == 1) return sky->colors[0];
  const double at = fmin(1, fmax(0, (direction.z + 1) / 2)) * (double)(n - 1);
  const size_t k = at >= (double)(n - 1) ? n - 2 : (size_t)at;
  const double f = at - (double)k;
  const CagColor a = sky->colors[k], b = sky->colors[k + 1];
  return (CagColor){a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b)};
}

// The two pixels around a position and the fraction of the second. `around`: the last one is followed
// by the first.
static double neighbors(double at, size_t n, bool around, size_t out[2]) {
  const double below = floor(at);
  for (int k = 0; k < 2; k++) {
    double i = below + k;
    if (around) i -= floor(i / (double)n) * (double)n;
    out[k] = (size_t)fmin((double)(n - 1), fmax(0, i));
  }
  return at - below;
}

static CagColor panorama_color(const CagPreviewSky *sky, CagVec3 direction) {
  const size_t width = sky->image.width, height = sky->image.height;
  const double turn = atan2(direction.y, direction.x) / (2 * M_PI);
  const double down = acos(fmin(1, fmax(-1, direction.z))) / M_PI;
  size_t x[2], y[2];
  const double fx = neighbors(turn * (double)width - 0.5, width, true, x);
  const double fy = neighbors(down * (double)height - 0.5, height, false, y);
  double c[3];
  for (int k = 0; k < 3; k++) {
    const float *top = sky->rgb[k] + y[0] * width, *bottom = sky->rgb[k] + y[1] * width;
    c[k] = (1 - fy) * ((1 - fx) * top[x[0]] + fx * top[x[1]]) +
           fy * ((1 - fx) * bottom[x[0]] + fx * bottom[x[1]]);
  }
  return (CagColor){c[0], c[1], c[2]};
}

CagColor cag_preview_sky_color(const CagPreviewSky *sky, CagVec3 direction) {
  const CagScene *s = sky->scene;
  if (sky->image.data) return panorama_color(sky, direction);
  if (s->sky.color_count > 0) return gradient_color(&s->sky, direction);
  return s->has_background ? s->background : (CagColor){0, 0, 0};
}
