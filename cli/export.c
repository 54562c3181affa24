// cag export FILE -o OUT: writes the shapes or an image of a script in the format of the output's
// extension.

#include <string.h>
#include <strings.h>

#include "cli/tool.h"
#include "cli/watch.h"

// Returns the extension of a path without its point, or NULL.
static const char *ending(const char *path) {
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
  const char *point = strrchr(name, '.');
  return point && point[1] ? point + 1 : NULL;
}

static bool is_format(const char *name) {
  for (const char *const *f = cag_export_formats(); *f; f++)
    if (!strcasecmp(name, *f)) return true;
  return false;
}

static int reject_format(const CagTool *t, const char *format) {
  char help[300] = "the formats are";
  for (const char *const *f = cag_export_formats(); *f; f++)
    snprintf(help + strlen(help), sizeof help - strlen(help), " .%s", *f);
  return cag_tool_fail(t, CAG_STATUS_USAGE, help, "unknown format '.%s'", format);
}

// Options of images apply to their formats only.
static int check_image_options(const CagTool *t, const char *format) {
  const bool png = !strcasecmp(format, "png"), exr = !strcasecmp(format, "exr");
  const char *option = t->image && !png && !exr ? "--image"
                       : t->has_range && !png   ? "--range"
                       : t->bits && !png        ? "--bits"
                                                : NULL;
  if (!option) return CAG_STATUS_OK;
  return cag_tool_fail(t, CAG_STATUS_USAGE,
                       t->image && !png && !exr ? "images are written to .exr and .png files"
                                                : "it applies to .png files",
                       "%s does not apply to a .%s file", option, format);
}

// A robot and an image have no section.
static int check_section(const CagTool *t, const char *format) {
  if (!t->has_section || (strcasecmp(format, "urdf") != 0 && strcasecmp(format, "png") != 0 &&
                          strcasecmp(format, "exr") != 0))
    return CAG_STATUS_OK;
  return cag_tool_fail(t, CAG_STATUS_USAGE, "`cag render` renders pictures of sections",
                       "--section does not apply to a .%s file", format);
}

// Checks the command line before anything runs. Returns 0, or the status after a message.
static int check(const CagTool *t) {
  if (!t->output)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "name the output with -o OUT, such as -o vase.stl",
                         "the output is missing");
  const char *format = t->format ? t->format : ending(t->output);
  if (!format)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "give it with --format, such as --format stl",
                         "the output '%s' has no extension that determines its format", t->output);
  if (!is_format(format)) return reject_format(t, format);
  int status = check_image_options(t, format);
  if (status == CAG_STATUS_OK) status = check_section(t, format);
  return status != CAG_STATUS_OK ? status : cag_tool_check_place(t, t->output);
}

static int export_script(CagTool *t, CagSession *s, void *path) {
  int status = cag_session_run_file(s, path);
  if (status == CAG_STATUS_OK) {
    fflush(stdout);
    cag_tool_make_folder(t->output);
    const CagImageOptions image = {t->image, t->range_low, t->range_high, t->bits};
    status = cag_session_export_image(s, t->output, t->format, &image);
  }
  status = cag_tool_finish(t, s, status);
  if (status == CAG_STATUS_OK && t->verbose) {
    cag_session_describe_scene(s, stderr);
    cag_tool_say_tolerances(t, s);
    cag_tool_say(t, "wrote %s", t->output);
  }
  return status;
}

int cag_tool_export(CagTool *t, int argc, char **argv) {
  (void)argc;
  const int status = check(t);
  if (status != CAG_STATUS_OK) return status;
  if (!strcmp(t->output, "-")) t->session.out = stderr;
  return cag_tool_rounds(t, argv[0], export_script, argv[0]);
}
