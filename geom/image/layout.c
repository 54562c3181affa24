#include "geom/image/layout.h"

#include <string.h>

#include "base/stop.h"

// Makes a raster of another size with the same channels.
static CagStatus resized_like(const CagRaster *r, size_t width, size_t height, CagRaster **out,
                              CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_new(width, height, r->channel_count, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    status = cag_raster_name(made, c, r->names[c], err);
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

// Ends a function that fills `made` row by row.
static CagStatus finish_raster(CagStatus status, CagRaster *made, CagRaster **out) {
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

CagStatus cag_raster_select(const CagRaster *r, const size_t *channels, size_t n, CagRaster **out,
                            CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_new(r->width, r->height, n, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < n; c++) {
    status = cag_raster_name(made, c, r->names[channels[c]], err);
    for (size_t y = 0; !status && y < r->height; y++) {
      memcpy(cag_raster_at(made, c, 0, y), cag_raster_at(r, channels[c], 0, y),
             r->width * sizeof(double));
      status = cag_stop_check(err);
    }
  }
  return finish_raster(status, made, out);
}

CagStatus cag_raster_crop(const CagRaster *r, size_t x, size_t y, size_t width, size_t height,
                          CagRaster **out, CagError *err) {
  CAG_ASSERT(x + width <= r->width && y + height <= r->height);
  CagRaster *made;
  CagStatus status = resized_like(r, width, height, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    for (size_t row = 0; !status && row < height; row++) {
      memcpy(cag_raster_at(made, c, 0, row), cag_raster_at(r, c, x, y + row),
             width * sizeof(double));
      status = cag_stop_check(err);
    }
  return finish_raster(status, made, out);
}

CagStatus cag_raster_enlarge(const CagRaster *r, size_t n, CagRaster **out, CagError *err) {
  // Larger products are refused by their size, and must not overflow before that.
  const size_t times = n < CAG_RASTER_SIDE_MAX ? n : CAG_RASTER_SIDE_MAX;
  CagRaster *made;
  CagStatus status = resized_like(r, r->width * times, r->height * times, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    for (size_t y = 0; !status && y < made->height; y++) {
      const double *from = cag_raster_at(r, c, 0, y / times);
      double *to = cag_raster_at(made, c, 0, y);
      for (size_t x = 0; x < r->width; x++)
        for (size_t i = 0; i < times; i++) *to++ = from[x];
      status = cag_stop_check(err);
    }
  return finish_raster(status, made, out);
}

CagStatus cag_raster_flip(const CagRaster *r, bool across, CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_like(r, &made, err);
  if (status) return status;
  const size_t w = r->width, h = r->height;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    for (size_t y = 0; !status && y < h; y++) {
      const double *from = cag_raster_at(r, c, 0, across ? y : h - 1 - y);
      double *to = cag_raster_at(made, c, 0, y);
      for (size_t x = 0; x < w; x++) to[x] = from[across ? w - 1 - x : x];
      status = cag_stop_check(err);
    }
  return finish_raster(status, made, out);
}

// Transposing whole columns would miss the cache at every sample, so it is done in square blocks of
// this side, of which a row is one cache line or two.
#define BLOCK 16

// A quarter turn counter-clockwise: pixel [x, y] is the former pixel [w - 1 - y, x].
static void turn_block(const CagRaster *r, CagRaster *made, size_t c, size_t x0, size_t y0) {
  const size_t x1 = x0 + BLOCK < made->width ? x0 + BLOCK : made->width;
  const size_t y1 = y0 + BLOCK < made->height ? y0 + BLOCK : made->height;
  for (size_t y = y0; y < y1; y++)
    for (size_t x = x0; x < x1; x++)
      *cag_raster_at(made, c, x, y) = *cag_raster_at(r, c, r->width - 1 - y, x);
}

static CagStatus quarter_turn(const CagRaster *r, CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status = resized_like(r, r->height, r->width, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < r->channel_count; c++)
    for (size_t y = 0; !status && y < made->height; y += BLOCK) {
      for (size_t x = 0; x < made->width; x += BLOCK) turn_block(r, made, c, x, y);
      status = cag_stop_check(err);
    }
  return finish_raster(status, made, out);
}

// Reverses all pixels.
static CagStatus half_turn(const CagRaster *r, CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status = cag_raster_flip(r, true, &made, err);
  if (status) return status;
  status = cag_raster_flip(made, false, out, err);
  cag_raster_release(made);
  return status;
}

CagStatus cag_raster_quarter_turns(const CagRaster *r, int turns, CagRaster **out, CagError *err) {
  CagRaster *once;
  CagStatus status;
  switch (turns) {
  case 0: *out = cag_raster_retain(r); return CAG_OK;
  case 1: return quarter_turn(r, out, err);
  case 2: return half_turn(r, out, err);
  default:
    status = quarter_turn(r, &once, err);
    if (status) return status;
    status = half_turn(once, out, err);
    cag_raster_release(once);
    return status;
  }
}

// --- Fields ---

// Copies rows from, from + from_step ... to the rows to, to + to_step ...
static CagStatus copy_rows(const CagRaster *r, size_t from, size_t from_step, CagRaster *made,
                           size_t to, size_t to_step, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t c = 0; c < r->channel_count; c++)
    for (size_t y = from, at = to; !status && y < r->height && at < made->height;
         y += from_step, at += to_step) {
      memcpy(cag_raster_at(made, c, 0, at), cag_raster_at(r, c, 0, y), r->width * sizeof(double));
      status = cag_stop_check(err);
    }
  return status;
}

CagStatus cag_raster_field(const CagRaster *r, bool even, CagRaster **out, CagError *err) {
  CagRaster *made;
  CagStatus status =
      resized_like(r, r->width, even ? r->height / 2 : (r->height + 1) / 2, &made, err);
  if (status) return status;
  return finish_raster(copy_rows(r, even, 2, made, 0, 1, err), made, out);
}

CagStatus cag_raster_weave(const CagRaster *odd, const CagRaster *even, CagRaster **out,
                           CagError *err) {
  const size_t rows = even ? even->height : 0;
  if ((even && even->width != odd->width) || (rows != odd->height && rows + 1 != odd->height))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_image_sizes, "even", -1,
                    "`even` must be as wide as `odd`, with as many rows or one less: expected %zu "
                    "x %zu, found %zu x %zu",
                    odd->width, odd->height, even ? even->width : 0, rows);
  if (even && even->channel_count != odd->channel_count)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_image_channels, "even", -1,
                    "`even` must have as many channels as `odd`: expected %zu, found %zu",
                    odd->channel_count, even->channel_count);
  CagRaster *made;
  CagStatus status = resized_like(odd, odd->width, odd->height + rows, &made, err);
  if (status) return status;
  status = copy_rows(odd, 0, 1, made, 0, 2, err);
  if (!status && even) status = copy_rows(even, 0, 1, made, 1, 2, err);
  return finish_raster(status, made, out);
}
