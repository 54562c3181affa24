#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/edges.h"
#include "geom/image/filter.h"
#include "geom/image/lines.h"

// The standard deviation in pixels over which products of the gradient are averaged.
#define AVERAGED 1.5
// Corners are greater than all pixels within this distance.
#define APART 2
// A corner is located by the edges within this distance.
#define NEARBY 4
// Strengths below this fraction of the largest eigenvalue are rounding.
#define NO_CORNER 1e-9

// The products of the gradient xx, xy, and yy, one after the other, each averaged.
static CagStatus averaged_products(const CagRaster *gx, const CagRaster *gy, CagRaster *out[3],
                                   CagError *err) {
  const size_t n = gx->width * gx->height;
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 3; k++) {
    CagRaster *product = NULL;
    const double *a = k < 2 ? gx->data : gy->data, *b = k > 0 ? gy->data : gx->data;
    status = cag_raster_new(gx->width, gx->height, 1, &product, err);
    for (size_t i = 0; !status && i < n; i++) product->data[i] = a[i] * b[i];
    if (!status) status = cag_image_blur(product, AVERAGED, CAG_BORDER_REPLICATE, &out[k], err);
    cag_raster_release(product);
  }
  return status;
}

// Replaces xx by the smaller eigenvalue. Returns the largest eigenvalue of all pixels.
static double smaller_eigenvalues(CagRaster *const m[3]) {
  const size_t n = m[0]->width * m[0]->height;
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    const double xx = m[0]->data[i], xy = m[1]->data[i], yy = m[2]->data[i];
    const double middle = (xx + yy) / 2, half = hypot((xx - yy) / 2, xy);
    m[0]->data[i] = middle - half;
    if (middle + half > largest) largest = middle + half;
  }
  return largest;
}

// Whether no pixel nearby is stronger. Of equal pixels, the first one counts.
static bool is_peak(const CagRaster *r, size_t x, size_t y) {
  const double here = *cag_raster_at(r, 0, x, y);
  for (size_t v = y > APART ? y - APART : 0; v <= y + APART && v < r->height; v++)
    for (size_t u = x > APART ? x - APART : 0; u <= x + APART && u < r->width; u++) {
      const double other = *cag_raster_at(r, 0, u, v);
      const bool before = v < y || (v == y && u < x);
      if (other > here || (before && other == here)) return false;
    }
  return true;
}

// The point with the least sum of squared distances from the tangents of the edges around pixel
// [x, y], weighted with the square of the gradient (Foerstner and Guelch 1987). Relative to the
// center of the pixel, y up.
static bool edges_meet(const CagRaster *gx, const CagRaster *gy, size_t x, size_t y, double *dx,
                       double *dy) {
  double xx = 0, xy = 0, yy = 0, bx = 0, by = 0;
  for (size_t v = y > NEARBY ? y - NEARBY : 0; v <= y + NEARBY && v < gx->height; v++)
    for (size_t u = x > NEARBY ? x - NEARBY : 0; u <= x + NEARBY && u < gx->width; u++) {
      const double px = (double)u - (double)x, py = (double)y - (double)v;
      const double a = *cag_raster_at(gx, 0, u, v), b = *cag_raster_at(gy, 0, u, v);
      if (isnan(a) || isnan(b)) continue;
      const double w = exp(-(px * px + py * py) / (2 * AVERAGED * AVERAGED));
      xx += w * a * a;
      xy += w * a * b;
      yy += w * b * b;
      bx += w * a * (a * px + b * py);
      by += w * b * (a * px + b * py);
    }
  const double determinant = xx * yy - xy * xy;
  *dx = (yy * bx - xy * by) / determinant;
  *dy = (xx * by - xy * bx) / determinant;
  return hypot(*dx, *dy) <= NEARBY;
}

// Where a corner is searched.
typedef struct Corners {
  const CagRaster *gx, *gy, *strength;
  CagImageCorner *items;
  size_t count, capacity;
} Corners;

static CagImageCorner corner_at(const Corners *c, size_t x, size_t y) {
  double dx, dy;
  if (!edges_meet(c->gx, c->gy, x, y, &dx, &dy)) dx = dy = 0;
  return (CagImageCorner){
      .at = cag_vec3((double)x + 0.5 + dx, (double)(c->gx->height - y) - 0.5 + dy, 0),
      .strength = *cag_raster_at(c->strength, 0, x, y)};
}

// Strongest first, then in raster order.
static int by_strength(const void *a, const void *b) {
  const CagImageCorner *p = a, *q = b;
  if (p->strength != q->strength) return p->strength > q->strength ? -1 : 1;
  if (p->at.y != q->at.y) return p->at.y > q->at.y ? -1 : 1;
  return p->at.x < q->at.x ? -1 : p->at.x > q->at.x;
}

static CagStatus collect_peaks(Corners *c, double least, CagError *err) {
  const CagRaster *r = c->strength;
  for (size_t y = 0; y < r->height; y++) {
    for (size_t x = 0; x < r->width; x++) {
      if (!(*cag_raster_at(r, 0, x, y) > least) || !is_peak(r, x, y)) continue;
      if (!CAG_RESERVE(c->items, c->capacity, c->count + 1)) return cag_fail_memory(err);
      c->items[c->count++] = corner_at(c, x, y);
    }
    if (cag_stopped()) return cag_stop_fail(err);
  }
  return CAG_OK;
}

CagStatus cag_image_corners(const CagRaster *r, size_t n, CagImageCorner **out, size_t *count,
                            CagError *err) {
  CagRaster *gx = NULL, *gy = NULL, *m[3] = {NULL, NULL, NULL};
  Corners c = {0};
  CagStatus status = cag_edges_gradient(r, &gx, &gy, err);
  if (!status) status = averaged_products(gx, gy, m, err);
  if (!status) {
    const double largest = smaller_eigenvalues(m);
    c = (Corners){.gx = gx, .gy = gy, .strength = m[0]};
    status = collect_peaks(&c, NO_CORNER * largest, err);
  }
  cag_raster_release(gx);
  cag_raster_release(gy);
  for (int k = 0; k < 3; k++) cag_raster_release(m[k]);
  if (status) {
    cag_free(c.items);
    return status;
  }
  if (c.count > 0) qsort(c.items, c.count, sizeof *c.items, by_strength);
  *out = c.items;
  *count = c.count < n ? c.count : n;
  return CAG_OK;
}
