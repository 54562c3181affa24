// The difference of two texts by Myers's greedy algorithm ("An O(ND) difference algorithm and its
// variations", 1986), after common lines at the start and the end are removed.

#include "cli/diff.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define CONTEXT 3
// With more differing lines, the middle is shown as replaced as a whole.
#define MOST_EDITS 3000

typedef struct Line {
  const char *text;
  size_t length; // including its newline, if it has one
} Line;

typedef struct Lines {
  Line *items;
  size_t count;
} Lines;

// keep[i]: line i of a is unchanged; likewise for b.
typedef struct Diff {
  Lines a, b;
  bool *keep_a, *keep_b;
} Diff;

static bool split(const char *text, size_t length, Lines *out) {
  size_t n = 1;
  for (size_t i = 0; i < length; i++) n += text[i] == '\n';
  out->items = malloc(n * sizeof *out->items);
  out->count = 0;
  for (size_t at = 0; out->items && at < length;) {
    const char *end = memchr(text + at, '\n', length - at);
    const size_t size = end ? (size_t)(end - (text + at)) + 1 : length - at;
    out->items[out->count++] = (Line){text + at, size};
    at += size;
  }
  return out->items != NULL;
}

static bool same(Line a, Line b) {
  return a.length == b.length && memcmp(a.text, b.text, a.length) == 0;
}

// Marks a longest common part of a[from_a, from_a + n) and b[from_b, from_b + m) as kept. Returns
// false if they differ too much or memory ran out.
static bool match_middle(Diff *d, size_t from_a, long n, size_t from_b, long m) {
  const long most = n + m < MOST_EDITS ? n + m : MOST_EDITS, width = 2 * most + 3;
  long *rows = malloc(sizeof *rows * (size_t)width),
       **kept = calloc((size_t)most + 1, sizeof *kept);
  long edits = -1;
  bool ok = rows && kept;
  if (ok) memset(rows, 0, sizeof *rows * (size_t)width);
  long *v = ok ? rows + most + 1 : NULL;
  for (long e = 0; ok && edits < 0 && e <= most; e++) {
    for (long k = -e; k <= e; k += 2) {
      long x = k == -e || (k != e && v[k - 1] < v[k + 1]) ? v[k + 1] : v[k - 1] + 1;
      while (x < n && x - k < m && x - k >= 0 &&
             same(d->a.items[from_a + (size_t)x], d->b.items[from_b + (size_t)(x - k)]))
        x++;
      v[k] = x;
      if (x >= n && x - k >= m) edits = e;
    }
    kept[e] = malloc(sizeof **kept * (size_t)(2 * e + 3));
    ok = kept[e] != NULL;
    if (ok) memcpy(kept[e], v - e - 1, sizeof **kept * (size_t)(2 * e + 3));
  }
  long x = n, y = m;
  for (long e = edits; ok && e >= 0; e--) { // back along the path
    if (e > 0) {
      const long *before = kept[e - 1] + e; // before[k]: furthest x on diagonal k
      const long k = x - y;
      const long from = k == -e || (k != e && before[k - 1] < before[k + 1]) ? k + 1 : k - 1;
      const long start_x = before[from] + (from < k);
      for (; x > start_x; x--, y--)
        d->keep_a[from_a + (size_t)x - 1] = d->keep_b[from_b + (size_t)y - 1] = true;
      x = before[from];
      y = x - from;
    } else {
      for (; x > 0 && y > 0; x--, y--)
        d->keep_a[from_a + (size_t)x - 1] = d->keep_b[from_b + (size_t)y - 1] = true;
    }
  }
  for (long e = 0; kept && e <= most; e++) free(kept[e]);
  free(kept);
  free(rows);
  return ok && edits >= 0;
}

static void match(Diff *d) {
  size_t head = 0, tail = 0;
  const size_t n = d->a.count, m = d->b.count;
  while (head < n && head < m && same(d->a.items[head], d->b.items[head])) head++;
  while (tail < n - head && tail < m - head &&
         same(d->a.items[n - 1 - tail], d->b.items[m - 1 - tail]))
    tail++;
  for (size_t i = 0; i < head; i++) d->keep_a[i] = d->keep_b[i] = true;
  for (size_t i = 1; i <= tail; i++) d->keep_a[n - i] = d->keep_b[m - i] = true;
  match_middle(d, head, (long)(n - head - tail), head, (long)(m - head - tail));
}

static void write_line(FILE *out, char sign, Line line) {
  fputc(sign, out);
  fwrite(line.text, 1, line.length, out);
  if (line.length == 0 || line.text[line.length - 1] != '\n')
    fputs("\n\\ No newline at end of file\n", out);
}

// Returns the end of the hunk that starts at (i, j): the end of the last difference that is
// followed by more than twice the context of equal lines.
static void hunk_end(const Diff *d, size_t *i, size_t *j) {
  size_t equal = 0, end_i = *i, end_j = *j;
  while (*i < d->a.count || *j < d->b.count) {
    const bool kept = *i < d->a.count && d->keep_a[*i] && *j < d->b.count && d->keep_b[*j];
    if (kept) {
      if (++equal > 2 * CONTEXT) break;
      ++*i, ++*j;
    } else {
      equal = 0;
      if (*i < d->a.count && !d->keep_a[*i]) ++*i;
      else ++*j;
      end_i = *i, end_j = *j;
    }
  }
  *i = end_i, *j = end_j;
}

static void write_hunks(const Diff *d, FILE *out) {
  size_t i = 0, j = 0;
  for (;;) {
    while (i < d->a.count && j < d->b.count && d->keep_a[i] && d->keep_b[j]) i++, j++;
    if (i >= d->a.count && j >= d->b.count) return;
    const size_t before = i < CONTEXT ? i : CONTEXT;
    size_t end_i = i, end_j = j;
    hunk_end(d, &end_i, &end_j);
    const size_t left = d->a.count - end_i, after = left < CONTEXT ? left : CONTEXT;
    const size_t from_i = i - before, from_j = j - before, n = end_i + after - from_i,
                 m = end_j + after - from_j;
    fprintf(out, "@@ -%zu,%zu +%zu,%zu @@\n", n ? from_i + 1 : from_i, n, m ? from_j + 1 : from_j,
            m);
    for (i = from_i, j = from_j; i < end_i + after || j < end_j + after;) {
      if (i < d->a.count && !d->keep_a[i]) write_line(out, '-', d->a.items[i++]);
      else if (j < d->b.count && !d->keep_b[j]) write_line(out, '+', d->b.items[j++]);
      else write_line(out, ' ', d->a.items[i]), i++, j++;
    }
  }
}

void cag_tool_diff(const char *name, const char *a, size_t a_length, const char *b, size_t b_length,
                   FILE *out) {
  Diff d = {0};
  if (split(a, a_length, &d.a) && split(b, b_length, &d.b)) {
    d.keep_a = calloc(d.a.count + 1, 1);
    d.keep_b = calloc(d.b.count + 1, 1);
    if (d.keep_a && d.keep_b) {
      match(&d);
      fprintf(out, "--- %s\n+++ %s\n", name, name);
      write_hunks(&d, out);
    }
  }
  free(d.keep_a);
  free(d.keep_b);
  free(d.a.items);
  free(d.b.items);
}
