#include "interp/session/expect_image.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/arithmetic.h"
#include "interp/formats/raster_file.h"
#include "interp/session/images.h"
#include "interp/vm/vm.h"

typedef struct Comparison {
  const char *name, *path;
  char message[512]; // why they differ
} Comparison;

static bool is_png(const char *path) {
  const char *dot = strrchr(path, '.');
  return dot && strcasecmp(dot, ".png") == 0;
}

static bool has_same_channels(const CagRaster *a, const CagRaster *b) {
  if (a->channel_count != b->channel_count) return false;
  for (size_t c = 0; c < a->channel_count; c++)
    if (strcmp(a->names[c], b->names[c]) != 0) return false;
  return true;
}

// The difference of a number from the expected one; infinite if only one has a value.
static double difference(double found, double expected, bool png) {
  if (png) found = isnan(found) ? 0 : fmin(fmax(found, 0), 1);
  if (isnan(found) || isnan(expected)) return isnan(found) && isnan(expected) ? 0 : INFINITY;
  return fabs(found - expected);
}

typedef struct Differences {
  size_t count;
  double largest;
} Differences;

static CagStatus find_differences(const CagRaster *found, const CagRaster *expected, bool png,
                                  Differences *out, CagError *err) {
  CagRasterFigures f;
  CagStatus status = cag_raster_figures(expected, &f, err);
  const double size = f.count ? fmax(fabs(f.least), fabs(f.greatest)) : 0;
  const double slack =
      png ? CAG_TEST_IMAGE_PNG * (1 + CAG_TEST_IMAGE_EXR) : CAG_TEST_IMAGE_EXR * size;
  *out = (Differences){0};
  for (size_t y = 0; !status && y < found->height * found->channel_count; y++) {
    for (size_t i = y * found->width; i < (y + 1) * found->width; i++) {
      const double d = difference(found->data[i], expected->data[i], png);
      out->count += d > slack;
      out->largest = fmax(out->largest, d);
    }
    status = cag_stop_check(err);
  }
  return status;
}

// Compares a shown image with the file's.
static CagStatus compare(Comparison *c, const CagShownImage *shown, const CagRaster *expected,
                         CagError *err) {
  const CagRaster *r = shown->raster;
  Differences d;
  if (r->width != expected->width || r->height != expected->height) {
    snprintf(c->message, sizeof c->message,
             "the image %s has %zu x %zu pixels, but %s has %zu x %zu", shown->name, r->width,
             r->height, c->path, expected->width, expected->height);
    return CAG_OK;
  }
  if (is_png(c->path) ? r->channel_count != expected->channel_count
                      : !has_same_channels(r, expected)) {
    snprintf(c->message, sizeof c->message, "the image %s has other channels than %s", shown->name,
             c->path);
    return CAG_OK;
  }
  CagStatus status = find_differences(r, expected, is_png(c->path), &d, err);
  if (!status && d.count > 0)
    snprintf(c->message, sizeof c->message,
             "the image %s is not as %s: %zu of %zu numbers differ, by up to %g", shown->name,
             c->path, d.count, r->width * r->height * r->channel_count, d.largest);
  return status;
}

static bool read_reference(const char *path, CagRaster **out, CagError *err) {
  size_t size;
  const char *why;
  char *bytes = cag_read_whole_file(path, &size, &why);
  if (!bytes) return cag_fail_io(err, CAG_E_FILE, NULL, "cannot read %s: %s", path, why);
  const bool ok = cag_raster_read(bytes, size, path, out, err);
  cag_free(bytes);
  return ok;
}

static int test_image(CagSession *s, void *context) {
  Comparison *c = context;
  CagShownImages images;
  const CagShownImage *shown;
  CagRaster *expected = NULL;
  CagError err = {0};
  if (cag_shown_images(s, &images, &err)) return cag_session_fail_geometry(s, &err);
  int status = cag_shown_image_find(s, &images, c->name, &shown);
  if (status == CAG_STATUS_OK && !read_reference(c->path, &expected, &err))
    status = cag_session_fail_io(s, CAG_ERR_image_file, &err);
  if (status == CAG_STATUS_OK && expected && compare(c, shown, expected, &err))
    status = cag_session_fail_geometry(s, &err);
  cag_raster_release(expected);
  cag_shown_images_free(&images);
  return status;
}

char *cag_test_image(CagSession *s, const char *name, const char *path) {
  Comparison c = {.name = name, .path = path};
  if (!cag_session_begin(s)) return NULL;
  const int status = cag_session_end(s, cag_session_geometry(s, test_image, &c));
  CagErrorView e = {0};
  if (status != CAG_STATUS_OK) cag_session_error(s, s->lasting, &e);
  if (status == CAG_STATUS_OK || c.message[0]) return cag_strdup(c.message);
  return cag_strdup(e.message ? e.message : "the image cannot be compared");
}
