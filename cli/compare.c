// cag compare A B: reports how much two pictures differ.

#include <string.h>
#include <strings.h>

#include "cli/tool.h"
#include "interp/render/compare.h"
#include "interp/render/compare_parts.h"
#include "interp/render/exr.h"
#include "interp/render/png.h"

static bool is_png(const char *path) {
  const size_t n = strlen(path);
  return n > 4 && !strcasecmp(path + n - 4, ".png");
}

// A picture, with the metadata of an .exr.
typedef struct Picture {
  CagImage image;
  CagExrMetadata metadata;
} Picture;

static bool read_picture(const char *path, Picture *out, CagError *err) {
  return is_png(path) ? cag_png_read(path, &out->image, err)
                      : cag_exr_read(path, &out->image, &out->metadata, err);
}

static void free_picture(Picture *p) {
  cag_image_free(&p->image);
  cag_exr_metadata_free(&p->metadata);
}

static bool write_heatmap(const CagTool *t, const CagImage *a, const CagImage *b, CagError *err) {
  CagImage map;
  if (!cag_compare_heatmap(a, b, &map, err)) return false;
  const CagPngOptions plain = {.keep_linear = true};
  const bool ok = is_png(t->heatmap) ? cag_png_write(t->heatmap, &map, &plain, NULL, 0, err)
                                     : cag_exr_write(t->heatmap, &map, CAG_EXR_FLOAT, NULL, err);
  cag_image_free(&map);
  return ok;
}

static int check_heatmap(const CagTool *t) {
  const size_t n = t->heatmap ? strlen(t->heatmap) : 0;
  const bool picture = n > 4 && (is_png(t->heatmap) || !strcasecmp(t->heatmap + n - 4, ".exr"));
  if (!t->heatmap) return CAG_STATUS_OK;
  if (!picture && strcmp(t->heatmap, "-") != 0)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "name an .exr or .png file",
                         "cannot write the heatmap '%s': expected .exr or .png", t->heatmap);
  return cag_tool_check_output(t, t->heatmap);
}

// Compares two pictures in memory.
static bool compare(const CagTool *t, char **names, const CagImage *a, const CagImage *b,
                    bool *differ, CagError *err) {
  CagCompareReport report;
  if (!cag_compare_images(a, names[0], b, names[1], t->threshold, &report, err)) return false;
  // A heatmap on standard output replaces the numbers.
  if (!t->quiet && !t->by_part)
    cag_compare_print(&report, t->heatmap && !strcmp(t->heatmap, "-") ? stderr : stdout);
  *differ = report.differing_pixels > 0;
  cag_compare_report_free(&report);
  return !t->heatmap || write_heatmap(t, a, b, err);
}

// Prints which parts differ.
static bool compare_parts(const CagTool *t, const Picture *a, const Picture *b, CagError *err) {
  CagCryptoManifest names[2] = {{0}, {0}};
  const bool known = cag_crypto_manifest(&a->metadata, "CryptoObject", &names[0]) &&
                     cag_crypto_manifest(&b->metadata, "CryptoObject", &names[1]);
  const CagPartPicture pictures[2] = {{&a->image, &names[0]}, {&b->image, &names[1]}};
  CagPartReport report;
  bool ok = known || cag_fail_io(err, CAG_E_USAGE, "render them with --passes color,object",
                                 "the pictures do not tell which parts they show");
  if (ok && (ok = cag_compare_parts(pictures, t->threshold, &report, err))) {
    if (!t->quiet) cag_part_report_print(&report, stdout);
    cag_part_report_free(&report);
  }
  for (int k = 0; k < 2; k++) cag_crypto_manifest_free(&names[k]);
  return ok;
}

int cag_tool_compare(CagTool *t, int argc, char **argv) {
  (void)argc;
  Picture a = {0}, b = {0};
  CagError err = {0};
  bool differ = false;
  if (!strcmp(argv[0], "-") && !strcmp(argv[1], "-"))
    return cag_tool_fail(t, CAG_STATUS_USAGE, "name a file for one of the two",
                         "both pictures cannot come from standard input");
  const int status = check_heatmap(t);
  if (status != CAG_STATUS_OK) return status;
  const bool ok = read_picture(argv[0], &a, &err) && read_picture(argv[1], &b, &err) &&
                  (!t->by_part || compare_parts(t, &a, &b, &err)) &&
                  compare(t, argv, &a.image, &b.image, &differ, &err);
  free_picture(&a);
  free_picture(&b);
  if (!ok) return cag_tool_fail(t, cag_exit_status(&err), err.help, "%s", err.message);
  return differ ? CAG_STATUS_SCRIPT : CAG_STATUS_OK;
}
