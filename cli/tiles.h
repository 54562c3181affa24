// A large picture in tiles: where they lie, and how they become one picture.
//
// Inner edges lie at multiples of the blocks in which the renderer works, so that a tile's pixels
// are those of the whole picture.

#ifndef CAG_CLI_TILES_H
#define CAG_CLI_TILES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "cag.h"

// Pixels of the side of the blocks in which POV-Ray 3.7 renders. No tile is smaller.
#define CAG_TILE_STEP 32
// The most tiles of a side.
#define CAG_TILES_MAX 64

// Reads "4x3": columns and lines of tiles. False when it is no such text, or there are too many.
bool cag_tiles_read(const char *text, int *columns, int *lines);

// Whether a side of so many pixels can be cut into so many tiles.
bool cag_tiles_fit(int pixels, int tiles);

// Tile number i of the picture, row after row from the top.
CagRenderRegion cag_tile(int width, int height, int columns, int lines, int i);

// Puts the EXR files of the tiles (columns * lines, in order) together and writes the picture to
// `output`, an .exr with the first tile's facts or a .png.
bool cag_tiles_join(const char *const *tiles, int columns, int lines, int width, int height,
                    const char *output, CagError *err);

#endif
