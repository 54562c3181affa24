// cag view [FILE]: serves the page on which a script is seen and changed.

#include "live/view.h"

#include <stdlib.h>
#include <unistd.h>

#include "cli/tool.h"

// Opens a browser where there is a desktop.
static void open_browser(const char *address) {
  if (!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY")) return;
  const pid_t child = fork();
  if (child != 0) return;
  if (fork() == 0) {
    if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(1);
    execlp("xdg-open", "xdg-open", address, (char *)NULL);
  }
  _exit(0);
}

static void tell_address(void *context, const char *address) {
  const CagTool *t = context;
  printf("%s\n", address);
  fflush(stdout);
  cag_tool_say(t, "press Ctrl-C to end");
  if (!t->no_open) open_browser(address);
}

int cag_tool_view(CagTool *t, int argc, char **argv) {
  char why[512] = "";
  const char **names = calloc(2 * t->define_count + 1, sizeof *names);
  if (!names) return cag_tool_fail(t, CAG_STATUS_LIMIT, NULL, "out of memory");
  for (size_t i = 0; i < t->define_count; i++) {
    names[i] = t->defines[i].name;
    names[t->define_count + i] = t->defines[i].value;
  }
  const CagViewOptions options = {.session = t->session,
                                  .define_names = names,
                                  .define_values = names + t->define_count,
                                  .define_count = t->define_count,
                                  .file = argc > 0 ? argv[0] : NULL,
                                  .port = t->port,
                                  .read_only = t->read_only,
                                  .ready = tell_address,
                                  .context = t};
  const int status = cag_view_serve(&options, why, sizeof why);
  free(names);
  return *why ? cag_tool_fail(t, status, NULL, "%s", why) : status;
}
