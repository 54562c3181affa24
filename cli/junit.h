// Test reports as JUnit XML, for continuous integration.

#ifndef CAG_CLI_JUNIT_H
#define CAG_CLI_JUNIT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef struct CagJunitCase {
  char *name;
  double seconds;
  char *failure; // the failed expectation; NULL: passed
  char *skipped; // why it was skipped; NULL: it was not
} CagJunitCase;

typedef struct CagJunitSuite {
  const char *name; // the script
  const CagJunitCase *cases;
  size_t count;
} CagJunitSuite;

// Writes the file atomically. Returns false, with the reason in `err`, on failure.
bool cag_junit_write(const char *path, const CagJunitSuite *suites, size_t count, CagError *err);

#endif
