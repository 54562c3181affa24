// cag lsp: the language server on standard input and output.

#include <limits.h>
#include <unistd.h>

#include "cli/tool.h"
#include "live/lsp.h"

int cag_tool_lsp(CagTool *t, int argc, char **argv) {
  (void)argc;
  (void)argv;
  char program[PATH_MAX];
  // A signal ends the server at once: it has nothing to clean up.
  const int ends[] = {SIGINT, SIGTERM, SIGHUP};
  for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) signal(ends[i], SIG_DFL);
  const ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
  if (n > 0) program[n] = 0;
  t->session.interrupt = NULL; // each piece of work has its own
  return cag_lsp_serve(&t->session, n > 0 ? program : NULL, stdin, stdout);
}
