// OpenEXR files, through the C API of the library (OpenEXRCore).
//
// Reading: one or several parts, scanlines or tiles (the full-size level), and half, float, and
// integer channels. The compressions are those that OpenEXRCore 3.1 decodes correctly: none, RLE,
// ZIP, and ZIPS; PIZ and PXR24 if all channels have full sampling; B44 and B44A if all channels are
// also half. Others, such as DWAA and DWAB, are refused with a message. The image covers the
// display window: pixels without data are 0, data outside are ignored, and a channel with coarser
// sampling is repeated. In a file with several parts, the channels of the first part keep their
// names, and those of the others are named `part.channel`.
//
// Writing: scanlines, ZIP, half or float, any channel names, and metadata. Files are written
// atomically. Values outside of the range of half become infinite.
//
// Damaged, truncated, or malicious files cause an error of status CAG_E_FILE that names the file
// and the problem.

#ifndef CAG_INTERP_RENDER_EXR_H
#define CAG_INTERP_RENDER_EXR_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "interp/render/image.h"

typedef enum { CAG_EXR_TEXT, CAG_EXR_NUMBER, CAG_EXR_MATRIX } CagExrAttributeKind;

// A named attribute in the header of the file.
typedef struct CagExrAttribute {
  char name[CAG_IMAGE_NAME_MAX + 1];
  CagExrAttributeKind kind;
  char *text;        // CAG_EXR_TEXT, owned
  double number;     // CAG_EXR_NUMBER
  double matrix[16]; // CAG_EXR_MATRIX: row-major, for column vectors (p' = M p), translation in
                     // elements 3, 7, 11
} CagExrAttribute;

// A list of attributes. Initialize with {0}, and release with cag_exr_metadata_free. Names are
// unique: adding a name again replaces its value.
typedef struct CagExrMetadata {
  CagExrAttribute *items;
  size_t count, capacity;
} CagExrMetadata;

// Add an attribute. Names have 1 to 255 bytes; those that EXR itself needs (`channels`,
// `compression`, ...) are refused. Texts are stored as EXR's `string`, numbers as `double`, and
// matrices as `m44f` in EXR's convention for row vectors, so that other programs interpret the
// standard attribute `worldToCamera` correctly. Returns false, with `err`, if the name is invalid
// or memory runs out.
bool cag_exr_metadata_text(CagExrMetadata *m, const char *name, const char *text, CagError *err);
bool cag_exr_metadata_number(CagExrMetadata *m, const char *name, double number, CagError *err);
bool cag_exr_metadata_matrix(CagExrMetadata *m, const char *name, const double matrix[16],
                             CagError *err);

// Returns the attribute of that name, or NULL.
const CagExrAttribute *cag_exr_metadata_find(const CagExrMetadata *m, const char *name);

void cag_exr_metadata_free(CagExrMetadata *m);

// Reads the picture. The texts, numbers, and 4x4 matrices of the header of its first part are read
// into `metadata` (may be NULL; initialize with {0}). `-` is standard input. On failure, there is
// nothing to release.
bool cag_exr_read(const char *path, CagImage *out, CagExrMetadata *metadata, CagError *err);

// The same from memory; `shown` is the file's name in messages.
bool cag_exr_read_memory(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, CagError *err);

// Tests whether the bytes are a complete EXR of scanlines, without decoding pixels. The table of
// chunks is written last, so it shows whether a file is complete.
bool cag_exr_is_whole(const void *bytes, size_t size);

typedef enum { CAG_EXR_HALF, CAG_EXR_FLOAT } CagExrPixels;

// Writes the picture with its metadata (may be NULL). `-` is standard output. Channel names must be
// present and unique.
bool cag_exr_write(const char *path, const CagImage *image, CagExrPixels pixels,
                   const CagExrMetadata *metadata, CagError *err);

// Reads an EXR in memory, as written by a renderer, and writes the same picture with added metadata
// to `path`: as half if all its channels were half, else as float. `picture` (may be NULL) receives
// the image, for a PNG of it.
bool cag_exr_rewrite(const void *bytes, size_t size, const char *shown, const char *path,
                     const CagExrMetadata *metadata, CagImage *picture, CagError *err);

// Shared by reader and writer only.
bool cag_exr_name_is_reserved(const char *name);
bool cag_exr_read_pixels(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, bool *all_half, CagError *err);

#endif
