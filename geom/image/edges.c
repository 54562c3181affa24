#include "geom/image/edges.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/filter.h"

#define DEGREES (180 / M_PI)
// The sum of the weights of Sobel's operator on each side, times the distance of the sides.
#define SOBEL_SCALE 8

static void set_polar(double magnitude, double degrees, double *m, double *d) {
  *m = magnitude;
  *d = magnitude > 0 ? degrees : NAN;
}

static CagStatus pair_of_images(size_t width, size_t height, CagRaster **a, CagRaster **b,
                                CagError *err) {
  CagStatus status = cag_raster_new(width, height, 1, a, err);
  if (status) return status;
  status = cag_raster_new(width, height, 1, b, err);
  if (status) cag_raster_release(*a);
  return status;
}

CagStatus cag_edges_roberts(const CagRaster *r, CagRaster **magnitude, CagRaster **direction,
                            CagError *err) {
  const double turned = 45; // of the diagonals against the axes
  const size_t width = r->width - 1, height = r->height - 1;
  CagRaster *m, *d;
  CagStatus status = pair_of_images(width, height, &m, &d, err);
  if (status) return status;
  for (size_t y = 0; y < height && !cag_stopped(); y++) {
    const double *up = cag_raster_at(r, 0, 0, y), *down = cag_raster_at(r, 0, 0, y + 1);
    for (size_t x = 0; x < width; x++) {
      const double d1 = down[x + 1] - up[x], d2 = up[x + 1] - down[x];
      double degrees = atan2(d2, d1) * DEGREES - turned;
      if (degrees <= -180) degrees += 360;
      set_polar(hypot(d1, d2), degrees, cag_raster_at(m, 0, x, y), cag_raster_at(d, 0, x, y));
    }
  }
  *magnitude = m;
  *direction = d;
  return CAG_OK;
}

static void sobel_x_row(const void *context, const double *const *rows, size_t width, bool has_none,
                        double *out) {
  (void)context;
  (void)has_none;
  for (size_t x = 0; x < width; x++)
    out[x] = (rows[0][x + 2] - rows[0][x] + 2 * (rows[1][x + 2] - rows[1][x]) + rows[2][x + 2] -
              rows[2][x]) /
             SOBEL_SCALE;
}

static void sobel_y_row(const void *context, const double *const *rows, size_t width, bool has_none,
                        double *out) {
  (void)context;
  (void)has_none;
  for (size_t x = 0; x < width; x++)
    out[x] = (rows[0][x] - rows[2][x] + 2 * (rows[0][x + 1] - rows[2][x + 1]) + rows[0][x + 2] -
              rows[2][x + 2]) /
             SOBEL_SCALE;
}

CagStatus cag_edges_gradient(const CagRaster *r, CagRaster **gx, CagRaster **gy, CagError *err) {
  CagRaster *a, *b;
  CagStatus status = pair_of_images(r->width, r->height, &a, &b, err);
  if (status) return status;
  CagWindow w = {1, 1, CAG_BORDER_REPLICATE, sobel_x_row, NULL};
  status = cag_window_rows(r, 0, &w, a, err);
  w.row = sobel_y_row;
  if (!status) status = cag_window_rows(r, 0, &w, b, err);
  if (status) {
    cag_raster_release(a);
    cag_raster_release(b);
    return status;
  }
  *gx = a;
  *gy = b;
  return CAG_OK;
}

CagStatus cag_edges_sobel(const CagRaster *r, CagRaster **magnitude, CagRaster **direction,
                          CagError *err) {
  CagStatus status = cag_edges_gradient(r, magnitude, direction, err);
  if (status) return status;
  // The components become magnitude and direction.
  for (size_t y = 0; y < r->height && !cag_stopped(); y++) {
    double *m = cag_raster_at(*magnitude, 0, 0, y), *d = cag_raster_at(*direction, 0, 0, y);
    for (size_t x = 0; x < r->width; x++)
      set_polar(SOBEL_SCALE * hypot(m[x], d[x]), atan2(d[x], m[x]) * DEGREES, &m[x], &d[x]);
  }
  return CAG_OK;
}

// --- Canny ---

typedef struct Canny {
  CagRaster *blurred, *gx, *gy, *magnitude;
  CagRaster *out;
  size_t *pending; // pixels of edges whose neighbors have not been looked at
  size_t count, capacity;
} Canny;

// The magnitude at a pixel, 0 outside of the image.
static double magnitude_at(const CagRaster *m, long x, long y) {
  if (x < 0 || y < 0 || (size_t)x >= m->width || (size_t)y >= m->height) return 0;
  return *cag_raster_at(m, 0, (size_t)x, (size_t)y);
}

// Whether the magnitude is a maximum along the gradient. It is compared with the magnitudes where
// the line of the gradient leaves the square of neighbors, by linear interpolation. Of two equal
// neighbors, the first one counts.
static bool is_ridge(const Canny *c, size_t x, size_t y) {
  const double dx = *cag_raster_at(c->gx, 0, x, y), dy = -*cag_raster_at(c->gy, 0, x, y);
  const double here = *cag_raster_at(c->magnitude, 0, x, y);
  const bool flat = fabs(dx) >= fabs(dy);
  const double part = flat ? fabs(dy / dx) : fabs(dx / dy);
  const long sx = dx < 0 ? -1 : 1, sy = dy < 0 ? -1 : 1, px = (long)x, py = (long)y;
  double side[2];
  for (int k = 0; k < 2; k++) {
    const long s = k ? -1 : 1;
    const double straight = flat ? magnitude_at(c->magnitude, px + s * sx, py)
                                 : magnitude_at(c->magnitude, px, py + s * sy);
    const double diagonal = magnitude_at(c->magnitude, px + s * sx, py + s * sy);
    side[k] = straight + (diagonal - straight) * part;
  }
  // The order of the two sides must not depend on the direction of the gradient.
  const bool forward = flat ? sx > 0 : sy > 0;
  return here >= side[forward ? 0 : 1] && here > side[forward ? 1 : 0];
}

// While edges grow, ridges of at least the lower threshold are marked with 2, and edges with 1.
static CagStatus mark_edge(Canny *c, size_t x, size_t y, CagError *err) {
  *cag_raster_at(c->out, 0, x, y) = 1;
  if (!CAG_RESERVE(c->pending, c->capacity, c->count + 1)) return cag_fail_memory(err);
  c->pending[c->count++] = y * c->out->width + x;
  return CAG_OK;
}

static CagStatus grow_edges(Canny *c, CagError *err) {
  const CagRaster *out = c->out;
  CagStatus status = CAG_OK;
  for (size_t k = 1; !status && c->count > 0; k++) {
    const size_t at = c->pending[--c->count], x = at % out->width, y = at / out->width;
    for (size_t v = y - (y > 0); !status && v <= y + 1 && v < out->height; v++)
      for (size_t u = x - (x > 0); !status && u <= x + 1 && u < out->width; u++)
        if (*cag_raster_at(out, 0, u, v) == 2) status = mark_edge(c, u, v, err);
    if (!status && k % out->width == 0) status = cag_stop_check(err);
  }
  return status;
}

static CagStatus find_edges(Canny *c, double low, double high, CagError *err) {
  CagRaster *out = c->out;
  CagStatus status = CAG_OK;
  for (size_t y = 0; !status && y < out->height; y++) {
    for (size_t x = 0; x < out->width; x++) {
      const double m = *cag_raster_at(c->magnitude, 0, x, y);
      if (m >= low && m > 0 && is_ridge(c, x, y)) *cag_raster_at(out, 0, x, y) = 2;
    }
    status = cag_stop_check(err);
  }
  for (size_t y = 0; !status && y < out->height; y++) {
    for (size_t x = 0; !status && x < out->width; x++)
      if (*cag_raster_at(out, 0, x, y) == 2 && *cag_raster_at(c->magnitude, 0, x, y) >= high) {
        status = mark_edge(c, x, y, err);
        if (!status) status = grow_edges(c, err);
      }
    if (!status) status = cag_stop_check(err);
  }
  const size_t n = out->width * out->height;
  for (size_t i = 0; i < n; i++)
    if (out->data[i] == 2) out->data[i] = 0;
  return status;
}

static CagStatus canny_magnitude(Canny *c, CagError *err) {
  CagStatus status = cag_raster_new(c->blurred->width, c->blurred->height, 1, &c->magnitude, err);
  const size_t n = c->blurred->width * c->blurred->height;
  for (size_t i = 0; !status && i < n; i++) {
    const double m = SOBEL_SCALE * hypot(c->gx->data[i], c->gy->data[i]);
    c->magnitude->data[i] = isnan(m) ? 0 : m;
  }
  return status;
}

CagStatus cag_edges_canny(const CagRaster *r, double low, double high, double sigma,
                          CagRaster **out, CagError *err) {
  Canny c = {0};
  CagStatus status = cag_image_blur(r, sigma, CAG_BORDER_REPLICATE, &c.blurred, err);
  if (!status) status = cag_edges_gradient(c.blurred, &c.gx, &c.gy, err);
  if (!status) status = canny_magnitude(&c, err);
  if (!status) status = cag_raster_new(r->width, r->height, 1, &c.out, err);
  if (!status) status = find_edges(&c, low, high, err);
  cag_raster_release(c.blurred);
  cag_raster_release(c.gx);
  cag_raster_release(c.gy);
  cag_raster_release(c.magnitude);
  cag_free(c.pending);
  if (status) cag_raster_release(c.out);
  else *out = c.out;
  return status;
}
