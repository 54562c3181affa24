// The time from the start of the program to the first whole picture of the built-in renderer. Runs a
// script, renders a draft of it, and prints the seconds. The file of the picture is not written.
//
//     first_picture SCRIPT WIDTH HEIGHT

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cag.h"

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct Watch {
  double begin, first; // first: 0 until there is a picture
  volatile int stop;
} Watch;

static void note_round(void *context, double percent, const char *phase) {
  (void)percent;
  Watch *w = context;
  if (w->first > 0 || strcmp(phase, "rendering") != 0) return;
  w->first = now() - w->begin;
  w->stop = 1;
}

int main(int argc, char **argv) {
  Watch w = {.begin = now()};
  if (argc != 4) return 2;
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.interrupt = &w.stop;
  options.out = options.messages = fopen("/dev/null", "w");
  CagSession *s = cag_session_new(&options);
  if (!s || cag_session_run_file(s, argv[1]) != CAG_STATUS_OK) return 1;
  CagRenderOptions render;
  cag_render_options_init(&render);
  render.engine = "preview";
  render.quality = "draft";
  render.width = atoi(argv[2]);
  render.height = atoi(argv[3]);
  render.progress = note_round;
  render.progress_context = &w;
  cag_session_render(s, &render, "/dev/null/picture.exr");
  cag_session_free(s);
  if (w.first == 0) return 1;
  printf("%.4f\n", w.first);
  return 0;
}
