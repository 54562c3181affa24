#include "geom/image/arithmetic.h"

#include <math.h>

#include "base/stop.h"

// --- Operators ---

// Undefined and infinite numbers become NaN.
static inline double defined(double x) { return isfinite(x) ? x : NAN; }

// Computes a row. The steps are 0 for a number in place of a row.
static void combine_row(CagRasterOp op, const double *a, size_t a_step, const double *b,
                        size_t b_step, size_t n, double *out) {
  switch (op) {
  case CAG_RASTER_ADD:
    for (size_t i = 0; i < n; i++) out[i] = defined(a[i * a_step] + b[i * b_step]);
    break;
  case CAG_RASTER_SUBTRACT:
    for (size_t i = 0; i < n; i++) out[i] = defined(a[i * a_step] - b[i * b_step]);
    break;
  case CAG_RASTER_MULTIPLY:
    for (size_t i = 0; i < n; i++) out[i] = defined(a[i * a_step] * b[i * b_step]);
    break;
  case CAG_RASTER_DIVIDE:
    for (size_t i = 0; i < n; i++) out[i] = defined(a[i * a_step] / b[i * b_step]);
  }
}

CagStatus cag_raster_combine(CagRasterOp op, const CagRaster *a, const CagRaster *b,
                             CagRaster **out, CagError *err) {
  if (a->width != b->width || a->height != b->height)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_image_sizes, "", -1,
                    "expected images of the same size, found %zu x %zu and %zu x %zu", a->width,
                    a->height, b->width, b->height);
  const size_t m = a->channel_count, n = b->channel_count;
  if (m != n && m != 1 && n != 1)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_image_channels, "", -1,
                    "expected equally many channels, or a single one, found %zu and %zu channels",
                    m, n);
  CagRaster *made;
  CagStatus status = cag_raster_like(n > m ? b : a, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < made->channel_count; c++)
    for (size_t y = 0; !status && y < made->height; y++) {
      combine_row(op, cag_raster_at(a, m == 1 ? 0 : c, 0, y), 1,
                  cag_raster_at(b, n == 1 ? 0 : c, 0, y), 1, made->width,
                  cag_raster_at(made, c, 0, y));
      status = cag_stop_check(err);
    }
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

CagStatus cag_raster_with_number(CagRasterOp op, const CagRaster *a, double k, bool swapped,
                                 CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_like(a, &made, err);
  if (status) return status;
  for (size_t y = 0; !status && y < a->height * a->channel_count; y++) {
    const double *row = a->data + y * a->width;
    double *to = made->data + y * a->width;
    if (swapped) combine_row(op, &k, 0, row, 1, a->width, to);
    else combine_row(op, row, 1, &k, 0, a->width, to);
    status = cag_stop_check(err);
  }
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

// --- Figures ---

CagStatus cag_raster_figures(const CagRaster *r, CagRasterFigures *out, CagError *err) {
  double total = 0, lost = 0;
  CagStatus status = CAG_OK;
  *out = (CagRasterFigures){.least = NAN, .greatest = NAN};
  for (size_t y = 0; !status && y < r->height * r->channel_count; y++) {
    const double *row = r->data + y * r->width;
    for (size_t x = 0; x < r->width; x++) {
      const double v = row[x];
      if (isnan(v)) continue;
      out->count++;
      if (!(out->least <= v)) out->least = v;
      if (!(out->greatest >= v)) out->greatest = v;
      const double next = total + v;
      lost += fabs(total) >= fabs(v) ? (total - next) + v : (v - next) + total;
      total = next;
    }
    status = cag_stop_check(err);
  }
  out->sum = isfinite(total) ? total + lost : total;
  return status;
}

// --- Codes ---

double cag_code_of(double value, int bits, double white) {
  const double most = ldexp(1, bits) - 1, v = value / white;
  return isnan(v) ? NAN : floor((v < 0 ? 0 : v > 1 ? 1 : v) * most + 0.5);
}

double cag_value_of_code(double code, int bits, double white) {
  return defined(code / (ldexp(1, bits) - 1) * white);
}

// Applies one of the two functions above to all samples.
static CagStatus convert(const CagRaster *r, double (*function)(double v, int bits, double white),
                         int bits, double white, CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_like(r, &made, err);
  if (status) return status;
  for (size_t y = 0; !status && y < r->height * r->channel_count; y++) {
    for (size_t i = y * r->width; i < (y + 1) * r->width; i++)
      made->data[i] = function(r->data[i], bits, white);
    status = cag_stop_check(err);
  }
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

CagStatus cag_raster_to_codes(const CagRaster *r, int bits, double white, CagRaster **out,
                              CagError *err) {
  return convert(r, cag_code_of, bits, white, out, err);
}

CagStatus cag_raster_from_codes(const CagRaster *r, int bits, double white, CagRaster **out,
                                CagError *err) {
  return convert(r, cag_value_of_code, bits, white, out, err);
}
