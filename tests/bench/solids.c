// Exports a script twice in one session, and prints the seconds of both runs and the bytes that the
// second one asks the kernel. CAG_BREP must name a program that adds what it reads to a file.
//
//     solids SCRIPT OUTPUT FILE

#include <stdio.h>
#include <sys/stat.h>
#include <time.h>

#include "cag.h"

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static long size_of(const char *path) {
  struct stat s;
  return stat(path, &s) == 0 ? (long)s.st_size : 0;
}

int main(int argc, char **argv) {
  if (argc != 4) return 2;
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.out = options.messages = fopen("/dev/null", "w");
  CagSession *s = cag_session_new(&options);
  double seconds[2];
  long asked[2];
  for (int i = 0; i < 2; i++) {
    const double begin = now();
    if (!s || cag_session_run_file(s, argv[1]) != CAG_STATUS_OK ||
        cag_session_export(s, argv[2], NULL) != CAG_STATUS_OK)
      return 1;
    seconds[i] = now() - begin;
    asked[i] = size_of(argv[3]);
  }
  cag_session_free(s);
  if (asked[0] == 0) return 1;
  printf("%.4f %.4f %ld\n", seconds[0], seconds[1], asked[1] - asked[0]);
  return 0;
}
