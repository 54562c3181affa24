// Replaces the files interp/render/exr_*.c, except exr_metadata.c, where OpenEXR is not available.

#include "interp/render/exr.h"

#include <string.h>

static bool fail_missing(CagError *err, const char *what, const char *path) {
  return cag_fail_io(err, CAG_E_FILE, "use a .png file, or run cag on your computer",
                     "cannot %s '%s': the playground has no OpenEXR", what, path);
}

bool cag_exr_read(const char *path, CagImage *out, CagExrMetadata *metadata, CagError *err) {
  (void)out;
  (void)metadata;
  return fail_missing(err, "read", path);
}

bool cag_exr_read_memory(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, CagError *err) {
  (void)bytes;
  (void)size;
  return cag_exr_read(shown, out, metadata, err);
}

bool cag_exr_write(const char *path, const CagImage *image, CagExrPixels pixels,
                   const CagExrMetadata *metadata, CagError *err) {
  (void)image;
  (void)pixels;
  (void)metadata;
  return fail_missing(err, "write", path);
}

bool cag_exr_rewrite(const void *bytes, size_t size, const char *shown, const char *path,
                     const CagExrMetadata *metadata, CagImage *picture, CagError *err) {
  (void)bytes;
  (void)size;
  (void)shown;
  (void)picture;
  return cag_exr_write(path, NULL, CAG_EXR_HALF, metadata, err);
}
