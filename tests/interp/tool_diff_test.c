// Differences of random texts: each is applied to the first text, which must result in the second,
// and has the minimum number of lines according to the longest common subsequence.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <string.h>

#include "cli/diff.h"
#include "tests/fuzz/failing.h"
#include "tests/geom/random.h"

volatile int cag_tool_interrupt;

#define TEXT_MAX 65536

typedef struct Text {
  char bytes[TEXT_MAX];
  size_t length;
} Text;

static void add(Text *t, const char *bytes, size_t n) {
  assert_true(t->length + n < TEXT_MAX);
  memcpy(t->bytes + t->length, bytes, n);
  t->length += n;
  t->bytes[t->length] = '\0';
}

static void make_diff(const Text *a, const Text *b, Text *out) {
  char *bytes = NULL;
  size_t length = 0;
  FILE *f = __real_open_memstream(&bytes, &length);
  assert_non_null(f);
  cag_tool_diff("a.cag", a->bytes, a->length, b->bytes, b->length, f);
  fclose(f);
  out->length = 0;
  add(out, bytes, length);
  free(bytes);
}

static size_t line_length(const char *at, const char *end) {
  const char *newline = memchr(at, '\n', (size_t)(end - at));
  return newline ? (size_t)(newline + 1 - at) : (size_t)(end - at);
}

// --- Applying a unified diff ---

typedef struct Patch {
  const char *at, *end;            // in the diff
  const char *source, *source_end; // in the first text
  size_t line, edits;
  Text *out;
} Patch;

static void take_source(Patch *p, const char *line, size_t n) {
  assert_true(n <= (size_t)(p->source_end - p->source));
  assert_memory_equal(p->source, line, n);
  p->source += n;
  p->line++;
}

// Copies a line of a hunk. If a remark follows, its newline does not belong to it.
static void apply_line(Patch *p, size_t *from, size_t *to) {
  static const char REMARK[] = "\\ No newline at end of file\n";
  const char sign = *p->at, *line = p->at + 1;
  size_t n = line_length(line, p->end);
  p->at = line + n;
  if ((size_t)(p->end - p->at) >= sizeof REMARK - 1 && !memcmp(p->at, REMARK, sizeof REMARK - 1)) {
    n--;
    p->at += sizeof REMARK - 1;
  }
  assert_true(sign == ' ' || sign == '-' || sign == '+');
  if (sign != '+') take_source(p, line, n);
  if (sign != '-') add(p->out, line, n);
  p->edits += sign != ' ';
  *from += sign != '+';
  *to += sign != '-';
}

static void apply_hunk(Patch *p) {
  size_t from_line, from_count, to_line, to_count, from = 0, to = 0, context = 0;
  int length = 0;
  assert_int_equal(sscanf(p->at, "@@ -%zu,%zu +%zu,%zu @@\n%n", &from_line, &from_count, &to_line,
                          &to_count, &length),
                   4);
  p->at = memchr(p->at, '\n', (size_t)(p->end - p->at));
  p->at++;
  const size_t begin = from_count ? from_line - 1 : from_line;
  while (p->line < begin) { // lines between the hunks do not change
    const size_t n = line_length(p->source, p->source_end);
    add(p->out, p->source, n);
    take_source(p, p->source, n);
  }
  while (from < from_count || to < to_count) {
    if (*p->at == ' ') context++;
    else context = 0;
    apply_line(p, &from, &to);
  }
  assert_true(context <= 3);
  assert_int_equal(from, from_count);
  assert_int_equal(to, to_count);
}

// Returns the number of removed and added lines.
static size_t apply(const Text *a, const Text *diff, Text *out) {
  static const char HEAD[] = "--- a.cag\n+++ a.cag\n";
  out->length = 0;
  Patch p = {.at = diff->bytes + sizeof HEAD - 1,
             .end = diff->bytes + diff->length,
             .source = a->bytes,
             .source_end = a->bytes + a->length,
             .out = out};
  assert_memory_equal(diff->bytes, HEAD, sizeof HEAD - 1);
  while (p.at < p.end) apply_hunk(&p);
  add(out, p.source, (size_t)(p.source_end - p.source));
  return p.edits;
}

// --- Random texts ---

// Lines of one letter, of few kinds, so that many are equal.
static void random_text(Text *t, size_t lines, int kinds) {
  t->length = 0;
  for (size_t i = 0; i < lines; i++) {
    const char line[] = {(char)('a' + (int)(uniform(0, kinds))), '\n'};
    add(t, line, i + 1 == lines && uniform(0, 1) < 0.3 ? 1 : 2);
  }
}

// A copy of the text with some lines changed, added, or removed.
static void random_change(const Text *t, double share, Text *out) {
  out->length = 0;
  for (const char *at = t->bytes, *end = at + t->length; at < end;) {
    const size_t n = line_length(at, end);
    const double what = uniform(0, 1);
    if (what < share) add(out, "x\n", 2);
    if (what >= 2 * share) add(out, at, n);
    at += n;
  }
}

static size_t split(const Text *t, const char **lines, size_t *lengths) {
  size_t count = 0;
  for (const char *at = t->bytes, *end = at + t->length; at < end; at += lengths[count++]) {
    lines[count] = at;
    lengths[count] = line_length(at, end);
  }
  return count;
}

// The minimum number of removed and added lines, from the longest common subsequence.
static size_t fewest_edits(const Text *a, const Text *b) {
  enum { MOST = 64 };
  const char *a_lines[MOST], *b_lines[MOST];
  size_t a_lengths[MOST], b_lengths[MOST], common[MOST + 1][MOST + 1] = {{0}};
  const size_t n = split(a, a_lines, a_lengths), m = split(b, b_lines, b_lengths);
  for (size_t i = 1; i <= n; i++)
    for (size_t k = 1; k <= m; k++) {
      const size_t x = a_lengths[i - 1], y = b_lengths[k - 1];
      const bool same = x == y && !memcmp(a_lines[i - 1], b_lines[k - 1], x);
      const size_t up = common[i - 1][k], left = common[i][k - 1];
      common[i][k] = same ? common[i - 1][k - 1] + 1 : up > left ? up : left;
    }
  return n + m - 2 * common[n][m];
}

static Text a, b, diff, back;

static void check(void) {
  make_diff(&a, &b, &diff);
  const size_t edits = apply(&a, &diff, &back);
  assert_int_equal(back.length, b.length);
  assert_memory_equal(back.bytes, b.bytes, b.length);
  assert_int_equal(edits, fewest_edits(&a, &b));
}

static void test_random(void **state) {
  (void)state;
  seed = 7;
  for (int i = 0; i < 2000; i++) {
    random_text(&a, (size_t)(uniform(0, 30)), 2 + i % 9);
    if (i % 2) random_text(&b, (size_t)(uniform(0, 30)), 2 + i % 9);
    else random_change(&a, 0.05 + uniform(0, 0.1), &b);
    if (a.length == b.length && !memcmp(a.bytes, b.bytes, a.length)) continue;
    check();
  }
}

// If texts differ in too many lines, the diff replaces everything.
static void test_many_lines(void **state) {
  (void)state;
  a.length = b.length = 0;
  for (int i = 0; i < 2000; i++) {
    char line[32];
    add(&a, line, (size_t)snprintf(line, sizeof line, "a %d\n", i));
    add(&b, line, (size_t)snprintf(line, sizeof line, "b %d\n", i));
  }
  make_diff(&a, &b, &diff);
  assert_int_equal(apply(&a, &diff, &back), 4000);
  assert_memory_equal(back.bytes, b.bytes, b.length);
}

// If memory runs out, the difference is complete, possibly with more lines, or missing.
static void test_failing_memory(void **state) {
  (void)state;
  seed = 11;
  for (int i = 0; i < 20; i++) {
    random_text(&a, 20, 4);
    random_text(&b, 20, 4);
    made = 0;
    make_diff(&a, &b, &diff);
    const size_t all = made;
    for (size_t at = 1; at <= all; at++) {
      made = 0;
      failing = at;
      make_diff(&a, &b, &diff);
      failing = 0;
      if (!diff.length) continue;
      apply(&a, &diff, &back);
      assert_int_equal(back.length, b.length);
      assert_memory_equal(back.bytes, b.bytes, b.length);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_random),
      cmocka_unit_test(test_many_lines),
      cmocka_unit_test(test_failing_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
