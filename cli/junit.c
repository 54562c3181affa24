// Test reports as JUnit XML: testsuites, a testsuite for each script, and a testcase for each run.

#include "cli/junit.h"

#include <string.h>

#include "base/atomic_file.h"

// Writes text as XML. Five characters are escaped, and control characters, which XML 1.0 does not
// allow, become spaces.
static void write_escaped(CagAtomicFile *f, const char *text) {
  for (; *text; text++) {
    const char *entity = NULL;
    switch (*text) {
    case '<': entity = "&lt;"; break;
    case '>': entity = "&gt;"; break;
    case '&': entity = "&amp;"; break;
    case '"': entity = "&quot;"; break;
    case '\'': entity = "&apos;"; break;
    default: break;
    }
    const unsigned char c = (unsigned char)*text;
    const char kept = c < 32 && c != '\n' && c != '\t' ? ' ' : *text;
    if (entity) cag_atomic_file_text(f, entity);
    else cag_atomic_file_write(f, &kept, 1);
  }
}

static void write_attribute(CagAtomicFile *f, const char *name, const char *value) {
  cag_atomic_file_printf(f, " %s=\"", name);
  write_escaped(f, value);
  cag_atomic_file_text(f, "\"");
}

typedef struct Sums {
  size_t tests, failures, skipped;
  double seconds;
} Sums;

static void add_suite(Sums *sums, const CagJunitSuite *s) {
  sums->tests += s->count;
  for (size_t i = 0; i < s->count; i++) {
    sums->failures += s->cases[i].failure != NULL;
    sums->skipped += s->cases[i].skipped != NULL;
    sums->seconds += s->cases[i].seconds;
  }
}

static void write_sums(CagAtomicFile *f, const Sums *sums) {
  cag_atomic_file_printf(
      f, " tests=\"%zu\" failures=\"%zu\" errors=\"0\" skipped=\"%zu\" time=\"%.3f\">\n",
      sums->tests, sums->failures, sums->skipped, sums->seconds);
}

static void write_case(CagAtomicFile *f, const char *suite, const CagJunitCase *c) {
  cag_atomic_file_text(f, "    <testcase");
  write_attribute(f, "classname", suite);
  write_attribute(f, "name", c->name);
  cag_atomic_file_printf(f, " time=\"%.3f\"", c->seconds);
  if (c->failure) {
    cag_atomic_file_text(f, "><failure message=\"not as expected\">");
    write_escaped(f, c->failure);
    cag_atomic_file_text(f, "</failure></testcase>\n");
  } else if (c->skipped) {
    cag_atomic_file_text(f, "><skipped");
    write_attribute(f, "message", c->skipped);
    cag_atomic_file_text(f, "/></testcase>\n");
  } else {
    cag_atomic_file_text(f, "/>\n");
  }
}

bool cag_junit_write(const char *path, const CagJunitSuite *suites, size_t count, CagError *err) {
  CagAtomicFile *f = cag_atomic_file_open(path, err);
  if (!f) return false;
  Sums all = {0};
  for (size_t i = 0; i < count; i++) add_suite(&all, &suites[i]);
  cag_atomic_file_text(f, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"cag\"");
  write_sums(f, &all);
  for (size_t i = 0; i < count; i++) {
    Sums sums = {0};
    add_suite(&sums, &suites[i]);
    cag_atomic_file_text(f, "  <testsuite");
    write_attribute(f, "name", suites[i].name);
    write_sums(f, &sums);
    for (size_t k = 0; k < suites[i].count; k++) write_case(f, suites[i].name, &suites[i].cases[k]);
    cag_atomic_file_text(f, "  </testsuite>\n");
  }
  cag_atomic_file_text(f, "</testsuites>\n");
  return cag_atomic_file_commit(f, err);
}
