// OpenEXR files, through the library's own C API (OpenEXRCore).
//
// Read: one or several parts, scanlines or tiles (the full-size level), half, float and
// whole-number channels. The compressions are those that OpenEXRCore 3.1 decodes rightly: none,
// RLE, ZIP, ZIPS; PIZ and PXR24 when all channels have full sampling; B44 and B44A when they also
// are all half. (DWAA, DWAB and the rest are refused with a message.) The image covers the display
// window: pixels that the file has no data for are 0, data outside is left out, a channel stored at
// a coarser sampling is repeated. In a file with several parts, the channels of the first keep
// their names and those of the others are named `part.channel`.
//
// Written: scanlines, ZIP, half or float, any channel names, and metadata. A file is written whole
// or not at all. Values outside the range of half become infinite there.
//
// Everything damaged, truncated or hostile is an error of status CAG_E_FILE that names the file
// and what is wrong with it.

#ifndef CAG_INTERP_RENDER_EXR_H
#define CAG_INTERP_RENDER_EXR_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "interp/render/image.h"

typedef enum { CAG_EXR_TEXT, CAG_EXR_NUMBER, CAG_EXR_MATRIX } CagExrAttributeKind;

// One named fact about the picture, in the header of the file.
typedef struct CagExrAttribute {
  char name[CAG_IMAGE_NAME_MAX + 1];
  CagExrAttributeKind kind;
  char *text;        // CAG_EXR_TEXT, owned
  double number;     // CAG_EXR_NUMBER
  double matrix[16]; // CAG_EXR_MATRIX: row-major, for column vectors (p' = M p), translation in
                     // elements 3, 7, 11
} CagExrAttribute;

// A list of facts; begin with {0}, release with cag_exr_metadata_free. Names are kept unique:
// adding one again replaces its value.
typedef struct CagExrMetadata {
  CagExrAttribute *items;
  size_t count, capacity;
} CagExrMetadata;

// Add a fact. Names are 1 to 255 bytes; those that EXR itself needs (`channels`, `compression`,
// ...) are refused. Texts are stored as EXR's `string`, numbers as `double`, matrices as `m44f` in
// EXR's convention for row vectors, so that the standard attribute `worldToCamera` means to other
// programs what it says. False, with `err`, for a name that cannot be or no memory.
bool cag_exr_metadata_text(CagExrMetadata *m, const char *name, const char *text, CagError *err);
bool cag_exr_metadata_number(CagExrMetadata *m, const char *name, double number, CagError *err);
bool cag_exr_metadata_matrix(CagExrMetadata *m, const char *name, const double matrix[16],
                             CagError *err);

// The fact of that name, or NULL.
const CagExrAttribute *cag_exr_metadata_find(const CagExrMetadata *m, const char *name);

void cag_exr_metadata_free(CagExrMetadata *m);

// Reads the picture, and into `metadata` (may be NULL; begins as {0}) the texts, numbers and 4x4
// matrices of its first part's header.
// `-` is standard input. Nothing to release on failure.
bool cag_exr_read(const char *path, CagImage *out, CagExrMetadata *metadata, CagError *err);

// The same from memory; `shown` is the file's name in messages.
bool cag_exr_read_memory(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, CagError *err);

// Whether the bytes are an EXR of scanlines to which nothing is missing; pixels are not decoded. A
// file has its table of chunks filled in last of all.
bool cag_exr_is_whole(const void *bytes, size_t size);

typedef enum { CAG_EXR_HALF, CAG_EXR_FLOAT } CagExrPixels;

// Writes the picture with its metadata (may be NULL). `-` is standard output. Channels must have
// names, each once.
bool cag_exr_write(const char *path, const CagImage *image, CagExrPixels pixels,
                   const CagExrMetadata *metadata, CagError *err);

// Takes an EXR in memory (as a renderer left it), and writes the same picture to `path` with the
// metadata added: half if all its channels were half, else float. `picture` (may be NULL) receives
// the image, for a PNG of it.
bool cag_exr_rewrite(const void *bytes, size_t size, const char *shown, const char *path,
                     const CagExrMetadata *metadata, CagImage *picture, CagError *err);

// What the two sides share; not for other files.
bool cag_exr_name_is_reserved(const char *name);
bool cag_exr_read_pixels(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, bool *all_half, CagError *err);

#endif
