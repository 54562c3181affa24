// cag fmt [--check] [--diff] PATH ...: formats scripts.
//
// A script with errors is not changed. A file is written only if its layout changes, and
// atomically.

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/atomic_file.h"
#include "cli/diff.h"
#include "cli/scripts.h"

typedef struct Formatting {
  CagTool *tool;
  size_t changed;
  int status; // the worst so far
} Formatting;

static void remember(Formatting *f, int status) {
  if (status > f->status) f->status = status;
}

static void write_back(Formatting *f, const char *path, const char *text, size_t length) {
  CagError err = {0};
  struct stat st;
  if (stat(path, &st) == 0 && !S_ISREG(st.st_mode)) { // a pipe cannot be read again
    remember(f, cag_tool_fail(f->tool, CAG_STATUS_FILE,
                              "`-` reads standard input and writes standard output",
                              "cannot rewrite %s: it is not a regular file", path));
    return;
  }
  CagAtomicFile *file = cag_atomic_file_open(path, &err);
  if (file) cag_atomic_file_write(file, text, length);
  if (file && cag_atomic_file_commit(file, &err)) {
    if (f->tool->verbose) cag_tool_say(f->tool, "formatted %s", path);
    return;
  }
  remember(f, cag_tool_fail(f->tool, CAG_STATUS_FILE, err.help, "%s", err.message));
}

// Writes, compares, or checks the formatted text `out` of a script.
static void finish(Formatting *f, const char *path, const char *text, size_t length,
                   const char *out, size_t out_length) {
  const bool input = strcmp(path, "-") == 0;
  const bool same = length == out_length && memcmp(text, out, length) == 0;
  const CagTool *t = f->tool;
  f->changed += !same;
  if (t->diff) {
    if (!same) cag_tool_diff(input ? "<stdin>" : path, text, length, out, out_length, stdout);
  } else if (t->check) {
    if (!same && !t->quiet) printf("%s\n", input ? "<stdin>" : path);
  } else if (input) {
    fwrite(out, 1, out_length, stdout);
  } else if (!same) {
    write_back(f, path, out, out_length);
  }
}

static int format_script(void *context, const char *path) {
  Formatting *f = context;
  size_t length, out_length = 0;
  char *text = cag_tool_read_file(f->tool, path, &length), *out = NULL;
  if (!text) {
    remember(f, CAG_STATUS_FILE);
    return CAG_STATUS_OK;
  }
  CagSession *s = cag_tool_session(f->tool);
  int status = s ? CAG_STATUS_OK : CAG_STATUS_LIMIT;
  if (s) {
    const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
    const int read = cag_session_format(s, name, text, length, &out, &out_length);
    remember(f, cag_tool_finish(f->tool, s, read));
    if (out) finish(f, path, text, length, out, out_length);
  }
  free(out);
  free(text);
  cag_session_free(s);
  return cag_tool_interrupt ? CAG_STATUS_INTERRUPTED : status;
}

int cag_tool_fmt(CagTool *t, int argc, char **argv) {
  Formatting f = {.tool = t};
  CagToolScripts scripts = {.tool = t, .each = format_script, .context = &f};
  const int status = cag_tool_each_script(&scripts, argc, argv);
  if (status != CAG_STATUS_OK) return status;
  remember(&f, scripts.status);
  if (scripts.count == 0 && f.status == CAG_STATUS_OK) cag_tool_say(t, "no scripts found");
  if (f.status == CAG_STATUS_OK && f.changed && (t->check || t->diff)) return CAG_STATUS_SCRIPT;
  return f.status;
}
