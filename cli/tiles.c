// Joining the tiles of a picture.

#include "cli/tiles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "interp/render/exr.h"
#include "interp/render/png.h"

// --- Layout ---

static bool read_side(const char **at, int *out) {
  *out = 0;
  const char *start = *at;
  while (**at >= '0' && **at <= '9' && *out <= CAG_TILES_MAX) *out = 10 * *out + (*(*at)++ - '0');
  return *at > start && *out >= 1 && *out <= CAG_TILES_MAX;
}

bool cag_tiles_read(const char *text, int *columns, int *lines) {
  return read_side(&text, columns) && *text++ == 'x' && read_side(&text, lines) && !*text;
}

bool cag_tiles_fit(int pixels, int tiles) { return tiles == 1 || pixels / CAG_TILE_STEP >= tiles; }

// Returns where tile i of `tiles` starts.
static int edge(int pixels, int tiles, int i) {
  if (i == tiles) return pixels;
  const long steps = pixels / CAG_TILE_STEP;
  return (int)(steps * i / tiles) * CAG_TILE_STEP;
}

CagRenderRegion cag_tile(int width, int height, int columns, int lines, int i) {
  const int x = edge(width, columns, i % columns), y = edge(height, lines, i / columns);
  return (CagRenderRegion){.x = x,
                           .y = y,
                           .width = edge(width, columns, i % columns + 1) - x,
                           .height = edge(height, lines, i / columns + 1) - y};
}

// --- Joining ---

static void paste(CagImage *into, size_t to, const CagImage *from, size_t channel,
                  CagRenderRegion r) {
  for (int y = 0; y < r.height; y++)
    memcpy(cag_image_plane(into, to) + (size_t)(r.y + y) * into->width + (size_t)r.x,
           cag_image_plane(from, channel) + (size_t)y * from->width,
           (size_t)r.width * sizeof(float));
}

// Creates the picture with the first tile's channels.
static bool begin(CagImage *picture, const CagImage *tile, int width, int height, CagError *err) {
  if (!cag_image_create(picture, (size_t)width, (size_t)height, tile->channel_count, err))
    return false;
  for (size_t c = 0; c < tile->channel_count; c++)
    cag_image_set_name(picture, c, tile->channels[c].name);
  return true;
}

static bool add_tile(CagImage *picture, const CagImage *tile, CagRenderRegion r, const char *path,
                     CagError *err) {
  bool fits = tile->width == (size_t)r.width && tile->height == (size_t)r.height &&
              tile->channel_count == picture->channel_count;
  for (size_t c = 0; fits && c < picture->channel_count; c++) {
    size_t from;
    fits = cag_image_find(tile, picture->channels[c].name, &from);
    if (fits) paste(picture, c, tile, from, r);
  }
  return fits || cag_fail_io(err, CAG_E_FILE, "remove it to render it again",
                             "the tile '%s' does not fit its picture", path);
}

static bool is_png(const char *path) {
  const size_t n = strlen(path);
  return n > 4 && strcasecmp(path + n - 4, ".png") == 0;
}

static bool write_picture(const CagImage *picture, const CagExrMetadata *m, const char *output,
                          CagError *err) {
  if (!is_png(output))
    return cag_exr_write(output, picture, cag_image_is_half(picture) ? CAG_EXR_HALF : CAG_EXR_FLOAT,
                         m, err);
  const CagExrAttribute *script = cag_exr_metadata_find(m, "cag.script");
  CagPngText texts[] = {{"Software", "cag " CAG_VERSION},
                        {"Title", script && script->text ? script->text : ""}};
  return cag_png_write(output, picture, &(CagPngOptions){.exposure = 0, .bits = 8}, texts, 2, err);
}

bool cag_tiles_join(const char *const *tiles, int columns, int lines, int width, int height,
                    const char *output, CagError *err) {
  CagImage picture = {0};
  CagExrMetadata metadata = {0};
  bool ok = true;
  for (int i = 0; ok && i < columns * lines; i++) {
    CagImage tile = {0};
    ok = cag_exr_read(tiles[i], &tile, i == 0 ? &metadata : NULL, err) &&
         (i > 0 || begin(&picture, &tile, width, height, err)) &&
         add_tile(&picture, &tile, cag_tile(width, height, columns, lines, i), tiles[i], err);
    cag_image_free(&tile);
  }
  ok = ok && write_picture(&picture, &metadata, output, err);
  cag_image_free(&picture);
  cag_exr_metadata_free(&metadata);
  return ok;
}
