// cag compare A B: reports how much two pictures differ.

#include <string.h>
#include <strings.h>

#include "cli/tool.h"
#include "interp/render/compare.h"
#include "interp/render/exr.h"
#include "interp/render/png.h"

static bool is_png(const char *path) {
  const size_t n = strlen(path);
  return n > 4 && !strcasecmp(path + n - 4, ".png");
}

static bool read_picture(const char *path, CagImage *out, CagError *err) {
  return is_png(path) ? cag_png_read(path, out, err) : cag_exr_read(path, out, NULL, err);
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
  if (!t->quiet)
    cag_compare_print(&report, t->heatmap && !strcmp(t->heatmap, "-") ? stderr : stdout);
  *differ = report.differing_pixels > 0;
  cag_compare_report_free(&report);
  return !t->heatmap || write_heatmap(t, a, b, err);
}

int cag_tool_compare(CagTool *t, int argc, char **argv) {
  (void)argc;
  CagImage a = {0}, b = {0};
  CagError err = {0};
  bool differ = false;
  if (!strcmp(argv[0], "-") && !strcmp(argv[1], "-"))
    return cag_tool_fail(t, CAG_STATUS_USAGE, "name a file for one of the two",
                         "both pictures cannot come from standard input");
  const int status = check_heatmap(t);
  if (status != CAG_STATUS_OK) return status;
  const bool ok = read_picture(argv[0], &a, &err) && read_picture(argv[1], &b, &err) &&
                  compare(t, argv, &a, &b, &differ, &err);
  cag_image_free(&a);
  cag_image_free(&b);
  if (!ok) return cag_tool_fail(t, cag_exit_status(&err), err.help, "%s", err.message);
  return differ ? CAG_STATUS_SCRIPT : CAG_STATUS_OK;
}
