// Reports of tests as JUnit XML, which continuous integration reads.

#ifndef CAG_CLI_JUNIT_H
#define CAG_CLI_JUNIT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef struct CagJunitCase {
  char *name;
  double seconds;
  char *failure; // what was not as expected; NULL: passed
  char *skipped; // why it did not run; NULL: it did
} CagJunitCase;

typedef struct CagJunitSuite {
  const char *name; // the script
  const CagJunitCase *cases;
  size_t count;
} CagJunitSuite;

// Writes the file whole or not at all. False with the reason in `err`.
bool cag_junit_write(const char *path, const CagJunitSuite *suites, size_t count, CagError *err);

#endif
