// Large pictures in tiles: the layout of the tiles, and how they are joined.
//
// Inner edges are at multiples of the blocks in which the renderer works, so that the pixels of
// tiles equal those of the whole picture.

#ifndef CAG_CLI_TILES_H
#define CAG_CLI_TILES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "cag.h"

// The side, in pixels, of the blocks in which POV-Ray 3.7 renders. Tiles are never smaller.
#define CAG_TILE_STEP 32
// The maximum number of tiles along a side.
#define CAG_TILES_MAX 64

// Reads "4x3": columns and rows of tiles. Returns false if the text is invalid or there are too
// many.
bool cag_tiles_read(const char *text, int *columns, int *lines);

// Tests whether a side of this many pixels can be divided into this many tiles.
bool cag_tiles_fit(int pixels, int tiles);

// Returns tile number i of the picture, row by row from the top.
CagRenderRegion cag_tile(int width, int height, int columns, int lines, int i);

// Joins the EXR files of the tiles (columns * lines, in order) and writes the picture to `output`,
// which is an .exr with the metadata of the first tile, or a .png.
bool cag_tiles_join(const char *const *tiles, int columns, int lines, int width, int height,
                    const char *output, CagError *err);

#endif
