// A program that uses libcag: it makes a vase of the height given on the command line, writes it as
// a mesh, and renders it. It compiles as C and as C++.

#include <cag.h>
#include <signal.h>
#include <stdio.h>

static volatile int interrupted;

static void interrupt(int number) {
  (void)number;
  interrupted = 1;
}

// Prints the errors and warnings of the last call, and passes its status on.
static int report(const CagSession *s, int status) {
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    fprintf(stderr, "%s %s: %s\n", e.warning ? "warning" : "error", e.code, e.message);
    if (e.file) fprintf(stderr, "  in %s, line %zu, column %zu\n", e.file, e.line, e.column);
    if (e.help) fprintf(stderr, "  help: %s\n", e.help);
  }
  return status;
}

static int make_vase(CagSession *s, const char *height) {
  static const char SCRIPT[] =
      "param height = 120 in 60..400\n"
      "profile = bspline([[24, 0], [45, 0.3*height], [22, 0.7*height], [34, height]], degree: 3)\n"
      "vase = revolve(profile)\n"
      "show vase\n"
      "print \"height {height}\"\n";
  cag_session_define(s, "height", height);
  int status = cag_session_run_text(s, "vase.cag", SCRIPT, sizeof SCRIPT - 1);
  if (status != CAG_STATUS_OK) return report(s, status);
  CagShownCounts counts;
  status = cag_session_scene(s, &counts);
  if (status == CAG_STATUS_OK) status = cag_session_export(s, "vase.obj", NULL);
  if (status != CAG_STATUS_OK) return report(s, status);
  printf("%zu items, %zu lights, camera `%s`\n", counts.items, counts.lights,
         cag_session_camera(s, 0));
  CagRenderOptions options;
  cag_render_options_init(&options);
  options.width = 160;
  options.height = 120;
  options.quality = "draft";
  return report(s, cag_session_render(s, &options, "vase.png"));
}

int main(int argc, char **argv) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.max_time = 60;                 // seconds
  options.max_memory = (size_t)64 << 20; // bytes
  options.interrupt = &interrupted;      // Ctrl-C stops the work
  signal(SIGINT, interrupt);
  CagSession *s = cag_session_new(&options);
  if (!s) return CAG_STATUS_LIMIT;
  const int status = make_vase(s, argc > 1 ? argv[1] : "200");
  cag_session_free(s);
  return status;
}
