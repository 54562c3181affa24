// The time of Tab completion in a session with the whole library: the slowest of several texts, the
// best of several tries each. Prints microseconds and the text.

#include <stdio.h>
#include <string.h>
#include <time.h>

#include "cli/repl.h"

volatile int cag_tool_interrupt;

#define TRIES 20

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool load_library(CagSession *s) {
  const char *module;
  for (size_t i = 0; (module = cag_library_module(i)); i++) {
    char text[96];
    int n = snprintf(text, sizeof text, "import %s\n", module);
    if (cag_session_input(s, text, (size_t)n, NULL, NULL) != CAG_STATUS_OK) return false;
  }
  return true;
}

// Returns the seconds of the best try, and the number of proposals.
static double measure(CagRepl *repl, const char *text, size_t *count) {
  double best = 1e9;
  for (int i = 0; i < TRIES; i++) {
    const double begin = now();
    CagReplProposals p = cag_repl_propose(repl, text);
    const double seconds = now() - begin;
    *count = p.count;
    cag_repl_proposals_free(&p);
    if (seconds < best) best = seconds;
  }
  return best;
}

int main(void) {
  static const char *const texts[] = {"s",
                                      "bspline([[0, 0], [1, 1]], d",
                                      "robots.",
                                      "materials.gl",
                                      "import std.",
                                      "import std.robots: p",
                                      ":r",
                                      "print \"{len(",
                                      ":load tests/",
                                      "read_csv(\"tests/"};
  CagTool tool = {0};
  cag_session_options_init(&tool.session);
  CagRepl repl = {.tool = &tool, .session = cag_session_new(&tool.session)};
  if (!repl.session || !load_library(repl.session)) return 1;
  double slowest = 0;
  const char *which = "";
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    size_t count;
    const double seconds = measure(&repl, texts[i], &count);
    if (count == 0) {
      fprintf(stderr, "nothing is proposed for %s\n", texts[i]);
      return 1;
    }
    if (seconds > slowest) {
      slowest = seconds;
      which = texts[i];
    }
  }
  printf("%.6f %s\n", slowest, which);
  cag_session_free(repl.session);
  return 0;
}
