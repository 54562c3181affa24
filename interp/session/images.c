#include "interp/session/images.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/arithmetic.h"
#include "geom/image/layout.h"
#include "geom/image/resample.h"
#include "interp/formats/raster_file.h"
#include "interp/session/lead.h"
#include "interp/vm/vm.h"

// --- The list ---

static bool has_image(const CagShownImages *images, const char *name) {
  for (size_t i = 0; i < images->count; i++)
    if (!strcmp(images->items[i].name, name)) return true;
  return false;
}

// "depth", "depth.2", ...; NULL if memory ran out.
static char *unique_name(const CagShownImages *images, const char *wanted) {
  char *name = cag_strdup(wanted);
  for (size_t k = 2; name && has_image(images, name); k++) {
    cag_free(name);
    if (cag_asprintf(&name, "%s.%zu", wanted, k) < 0) return NULL;
  }
  return name;
}

static CagStatus add_image(CagShownImages *images, const CagImageValue *v, const char *lead,
                           CagError *err) {
  if (!CAG_RESERVE(images->items, images->capacity, images->count + 1)) return cag_fail_memory(err);
  char *name = unique_name(images, v->name ? v->name->bytes : lead ? lead : "image");
  if (!name) return cag_fail_memory(err);
  images->items[images->count++] = (CagShownImage){name, cag_raster_retain(v->raster)};
  return CAG_OK;
}

static CagStatus add_value(CagVm *vm, CagShownImages *images, CagValue v, CagLead lead,
                           CagError *err) {
  if (v.type == CAG_IMAGE) return add_image(images, CAG_AS_IMAGE(v), lead.name, err);
  if (v.type != CAG_LIST) return CAG_OK;
  const CagList *list = CAG_AS_LIST(v);
  const CagLeadParts parts = cag_lead_parts(lead, list->length);
  CagStatus status = cag_stop_check(err);
  for (size_t i = 0; !status && list->dim == 0 && i < list->length; i++)
    status = add_value(vm, images, list->as.items[i], cag_lead_part(&parts, i), err);
  return status;
}

CagStatus cag_shown_images(CagSession *s, CagShownImages *out, CagError *err) {
  CagStatus status = CAG_OK;
  *out = (CagShownImages){0};
  for (size_t i = 0; !status && i < s->vm->shown_count; i++)
    status = add_value(s->vm, out, s->vm->shown[i].value, cag_lead(s->vm->shown[i].expr), err);
  if (status) cag_shown_images_free(out);
  return status;
}

void cag_shown_images_free(CagShownImages *images) {
  for (size_t i = 0; i < images->count; i++) {
    cag_free(images->items[i].name);
    cag_raster_release(images->items[i].raster);
  }
  cag_free(images->items);
  *images = (CagShownImages){0};
}

static bool is_image(CagValue v) {
  if (v.type == CAG_IMAGE) return true;
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->dim != 0) return false;
  for (size_t i = 0; i < CAG_AS_LIST(v)->length; i++)
    if (is_image(CAG_AS_LIST(v)->as.items[i])) return true;
  return false;
}

bool cag_session_shows_image(const CagSession *s) {
  for (size_t i = 0; s->vm && i < s->vm->shown_count; i++)
    if (is_image(s->vm->shown[i].value)) return true;
  return false;
}

// The names of the images, for messages.
static void list_names(const CagShownImages *images, CagString *out) {
  // More names than this make the message unreadable.
  enum { NAMES_LISTED = 12 };
  for (size_t i = 0; i < images->count && i < NAMES_LISTED; i++)
    cag_string_printf(out, "%s%s", i ? ", " : "", images->items[i].name);
  if (images->count > NAMES_LISTED) cag_string_printf(out, ", ...");
}

static int fail_find(CagSession *s, const CagShownImages *images, const char *name) {
  const char *script = s->script ? s->script : "the session";
  if (images->count == 0) {
    CagDiagnostic *d = cag_diagnostics_add(&s->diagnostics, CAG_ERR_no_image_shown, NULL,
                                           (CagSpan){0, 0}, "%s shows no image", script);
    cag_diagnostic_set_help(d, "`cag render` renders a picture of shapes");
    return CAG_STATUS_SCRIPT;
  }
  CagString names = {0};
  list_names(images, &names);
  CagDiagnostic *d =
      name ? cag_diagnostics_add(&s->diagnostics, CAG_ERR_which_image, NULL, (CagSpan){0, 0},
                                 "%s shows no image named `%s`", script, name)
           : cag_diagnostics_add(&s->diagnostics, CAG_ERR_which_image, NULL, (CagSpan){0, 0},
                                 "%s shows %zu images, expected one", script, images->count);
  cag_diagnostic_set_help(d, "select one by --image: %s", names.bytes ? names.bytes : "");
  cag_string_free(&names);
  return CAG_STATUS_USAGE;
}

int cag_shown_image_find(CagSession *s, const CagShownImages *images, const char *name,
                         const CagShownImage **out) {
  for (size_t i = 0; i < images->count; i++)
    if (name ? !strcmp(images->items[i].name, name) : images->count == 1) {
      *out = &images->items[i];
      return CAG_STATUS_OK;
    }
  return fail_find(s, images, name);
}

// --- Export ---

typedef struct Export {
  const char *path;
  bool png;
  CagImageOptions options;
} Export;

static bool write_image(const Export *e, const CagRaster *r, CagError *err) {
  if (!e->png) return cag_raster_write_exr(e->path, r, err);
  const bool ranged = e->options.low != 0 || e->options.high != 0;
  const CagRasterRange range = {ranged ? e->options.low : 0, ranged ? e->options.high : 1,
                                e->options.bits ? e->options.bits : 8};
  return cag_raster_write_png(e->path, r, &range, err);
}

static int export_image(CagSession *s, void *context) {
  const Export *e = context;
  CagShownImages images;
  const CagShownImage *image;
  CagError err = {0};
  if (cag_shown_images(s, &images, &err)) return cag_session_fail_geometry(s, &err);
  int status = cag_shown_image_find(s, &images, e->options.image, &image);
  if (status == CAG_STATUS_OK && !write_image(e, image->raster, &err))
    status = cag_session_fail_io(s, CAG_ERR_output_file, &err);
  cag_shown_images_free(&images);
  return status;
}

void cag_image_options_init(CagImageOptions *o) { *o = (CagImageOptions){0}; }

static int fail_options(CagSession *s, const char *message, const char *help) {
  CagDiagnostic *d = cag_diagnostics_add(&s->diagnostics, CAG_ERR_picture_size, NULL,
                                         (CagSpan){0, 0}, "%s", message);
  cag_diagnostic_set_help(d, "%s", help);
  return CAG_STATUS_USAGE;
}

int cag_session_write_image(CagSession *s, const char *path, bool png,
                            const CagImageOptions *options) {
  Export e = {.path = path, .png = png};
  if (options) e.options = *options;
  const bool ranged = e.options.low != 0 || e.options.high != 0;
  if (ranged && !(e.options.low < e.options.high))
    return fail_options(s, "expected a range whose start is below its end",
                        "the first number becomes black, the second white");
  if (e.options.bits && e.options.bits != 8 && e.options.bits != 16)
    return fail_options(s, "expected 8 or 16 bits", "a PNG has 8 or 16 bits per channel");
  const int status = cag_session_refresh(s);
  return status == CAG_STATUS_OK ? cag_session_geometry(s, export_image, &e) : status;
}

int cag_session_export_image(CagSession *s, const char *path, const char *format,
                             const CagImageOptions *options) {
  const char *dot = strrchr(path, '.');
  const char *name = format ? format : dot ? dot + 1 : "";
  if (strcasecmp(name, "png") != 0 && strcasecmp(name, "exr") != 0)
    return cag_session_export(s, path, format);
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  return cag_session_end(s,
                         cag_session_write_image(s, path, strcasecmp(name, "png") == 0, options));
}

// --- Previews ---

typedef struct Preview {
  const char *path;
  size_t width, height;
  size_t *out_width, *out_height;
} Preview;

// The channels that a preview shows: all of a PNG's, or else the first one.
static CagStatus viewable(const CagRaster *r, CagRaster **out, CagError *err) {
  const size_t first = 0;
  if (r->channel_count == 1 || r->channel_count == 3 || r->channel_count == 4) {
    *out = cag_raster_retain(r);
    return CAG_OK;
  }
  return cag_raster_select(r, &first, 1, out, err);
}

// Enlarges by a whole factor, or reduces to the size of the preview.
static CagStatus fit(const CagRaster *r, const Preview *p, CagRaster **out, CagError *err) {
  if (r->width <= p->width && r->height <= p->height) {
    const size_t across = p->width / r->width, along = p->height / r->height;
    return cag_raster_enlarge(r, across < along ? across : along, out, err);
  }
  size_t width = p->width, height = r->height * p->width / r->width;
  if (height > p->height) width = r->width * p->height / r->height, height = p->height;
  return cag_raster_resize(r, width ? width : 1, height ? height : 1, out, err);
}

static CagStatus preview_range(const CagRaster *r, CagRasterRange *out, CagError *err) {
  CagRasterFigures f;
  CagStatus status = cag_raster_figures(r, &f, err);
  const bool usual = f.count == 0 || (f.least >= 0 && f.greatest <= 1) || f.least == f.greatest;
  *out = usual ? (CagRasterRange){0, 1, 8} : (CagRasterRange){f.least, f.greatest, 8};
  return status;
}

static int write_preview(CagSession *s, void *context) {
  const Preview *p = context;
  CagShownImages images;
  CagError err = {0};
  CagRaster *seen = NULL, *fitted = NULL;
  CagRasterRange range;
  if (cag_shown_images(s, &images, &err)) return cag_session_fail_geometry(s, &err);
  CagStatus status = images.count ? viewable(images.items[0].raster, &seen, &err) : CAG_E_USAGE;
  if (!status) status = fit(seen, p, &fitted, &err);
  if (!status) {
    *p->out_width = fitted->width;
    *p->out_height = fitted->height;
  }
  const bool writes = !status && access(p->path, R_OK) != 0;
  if (writes) status = preview_range(fitted, &range, &err);
  if (writes && !status && !cag_raster_write_png(p->path, fitted, &range, &err))
    status = CAG_E_FILE;
  cag_raster_release(seen);
  cag_raster_release(fitted);
  cag_shown_images_free(&images);
  if (!status) return CAG_STATUS_OK;
  return status == CAG_E_FILE ? cag_session_fail_io(s, CAG_ERR_output_file, &err)
                              : cag_session_fail_geometry(s, &err);
}

int cag_session_write_preview(CagSession *s, const char *path, size_t width, size_t height,
                              size_t *out_width, size_t *out_height) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  Preview p = {path, width, height, out_width, out_height};
  return cag_session_end(s, cag_session_geometry(s, write_preview, &p));
}

// --- Names ---

typedef struct NameQuery {
  size_t index;
  char *text;
  size_t size;
  bool found;
} NameQuery;

static int find_name(CagSession *s, void *context) {
  NameQuery *q = context;
  CagShownImages images;
  CagError err = {0};
  if (cag_shown_images(s, &images, &err)) return cag_session_fail_geometry(s, &err);
  q->found = q->index < images.count;
  if (q->found) snprintf(q->text, q->size, "%s", images.items[q->index].name);
  cag_shown_images_free(&images);
  return CAG_STATUS_OK;
}

const char *cag_session_image(CagSession *s, size_t i) {
  if (!cag_session_begin(s)) return NULL;
  NameQuery q = {.index = i, .text = s->text, .size = sizeof s->text};
  if (cag_session_refresh(s) == CAG_STATUS_OK) cag_session_geometry(s, find_name, &q);
  cag_session_end(s, CAG_STATUS_OK);
  return q.found ? s->text : NULL;
}

typedef struct Size {
  size_t index, width, height;
  bool found;
} Size;

static int find_size(CagSession *s, void *context) {
  Size *z = context;
  CagShownImages images;
  CagError err = {0};
  if (cag_shown_images(s, &images, &err)) return cag_session_fail_geometry(s, &err);
  z->found = z->index < images.count;
  if (z->found) {
    z->width = images.items[z->index].raster->width;
    z->height = images.items[z->index].raster->height;
  }
  cag_shown_images_free(&images);
  return CAG_STATUS_OK;
}

bool cag_session_image_size(CagSession *s, size_t i, size_t *width, size_t *height) {
  Size z = {.index = i};
  *width = *height = 0;
  if (!cag_session_begin(s)) return false;
  if (cag_session_refresh(s) == CAG_STATUS_OK) cag_session_geometry(s, find_size, &z);
  cag_session_end(s, CAG_STATUS_OK);
  *width = z.width;
  *height = z.height;
  return z.found;
}
