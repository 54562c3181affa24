// The helper program cag-brep of the same build, for tests.

#ifndef CAG_TESTS_INTERP_KERNEL_PROGRAM_H
#define CAG_TESTS_INTERP_KERNEL_PROGRAM_H

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// Lets kernels start the program, which is two folders above that of the test. Returns false, with
// a message, if there is none.
static inline bool use_kernel_program(void) {
  char path[PATH_MAX + 32];
  const ssize_t n = readlink("/proc/self/exe", path, PATH_MAX);
  for (ssize_t i = n, slashes = 0; i > 0 && slashes < 3; i--)
    if (path[i - 1] == '/' && ++slashes == 3) strcpy(path + i, "cag-brep");
  if (n > 0 && access(path, X_OK) == 0) setenv("CAG_BREP", path, 0);
  const char *program = getenv("CAG_BREP");
  if (program && access(program, X_OK) == 0) return true;
  fprintf(stderr, "skipped: cag-brep is missing (Open CASCADE is not installed)\n");
  return false;
}

#endif
