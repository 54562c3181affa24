// Diagnostics as data: the list, and the search for the nearest name.

#include "base/diagnostic.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

// ---- the list ----
//
// Texts are allocated with malloc and charged to no account (base/memory.h), because they must be
// available after the limit of a run is exceeded, and must outlive the run.

// Receives errors for which the list has no room. Thread-local, so that interpreters on different
// threads do not interfere.
static _Thread_local CagDiagnostic scratch;

// The message if there was no memory for one. It is not freed.
static char no_memory[] = "out of memory";

static void release(CagDiagnostic *d) {
  if (d->message != no_memory) free(d->message);
  free(d->help);
  for (size_t i = 0; i < d->note_count; i++) free(d->notes[i].text);
  free(d->notes);
  *d = (CagDiagnostic){0};
}

void cag_diagnostics_truncate(CagDiagnostics *d, size_t n) {
  while (d->count > n) release(cag_diagnostics_at(d, --d->count));
  d->dropped = 0;
  if (d->count > CAG_DIAGNOSTICS_MAX) return;
  free(d->more);
  d->more = NULL;
  d->more_capacity = 0;
}

void cag_diagnostics_clear(CagDiagnostics *d) { cag_diagnostics_truncate(d, 0); }

static CagDiagnostic *thrown_away(CagDiagnostics *d) {
  d->dropped++;
  release(&scratch);
  return &scratch;
}

// Makes room for another item. Returns NULL if the list is full, or memory ran out.
static CagDiagnostic *new_item(CagDiagnostics *d) {
  if (cag_diagnostics_full(d)) return NULL;
  if (d->count >= CAG_DIAGNOSTICS_MAX + d->more_capacity) {
    const size_t capacity = d->more_capacity ? 2 * d->more_capacity : CAG_DIAGNOSTICS_MAX;
    CagDiagnostic *more = realloc(d->more, capacity * sizeof *more);
    if (!more) return NULL;
    d->more = more;
    d->more_capacity = capacity;
  }
  return cag_diagnostics_at(d, d->count++);
}

CagDiagnostic *cag_diagnostics_add(CagDiagnostics *d, CagErrorId id, const CagSource *source,
                                   CagSpan span, const char *format, ...) {
  CagDiagnostic *fresh = new_item(d);
  if (!fresh) return thrown_away(d);
  va_list args;
  va_start(args, format);
  char *message;
  int n = vasprintf(&message, format, args);
  va_end(args);
  if (n < 0) {
    message = no_memory;
    id = CAG_ERR_limit_memory;
  }
  *fresh = (CagDiagnostic){
      .severity = CAG_SEVERITY_ERROR, .id = id, .message = message, .source = source, .span = span};
  return fresh;
}

// Texts added to the scratch diagnostic would be neither read nor released.
static bool is_scratch(const CagDiagnostic *d) { return d == &scratch; }

void cag_diagnostic_set_help(CagDiagnostic *d, const char *format, ...) {
  if (is_scratch(d)) return;
  va_list args;
  va_start(args, format);
  char *help;
  int n = vasprintf(&help, format, args);
  va_end(args);
  if (n < 0) return;
  free(d->help);
  d->help = help;
}

void cag_diagnostic_add_note(CagDiagnostic *d, int kind, const CagSource *source, CagSpan span,
                             const char *format, ...) {
  if (is_scratch(d)) return;
  if (d->note_count == d->note_capacity) {
    size_t capacity = d->note_capacity ? 2 * d->note_capacity : 4;
    CagNote *notes = realloc(d->notes, capacity * sizeof *notes);
    if (!notes) return;
    d->notes = notes;
    d->note_capacity = capacity;
  }
  va_list args;
  va_start(args, format);
  char *text;
  int n = vasprintf(&text, format, args);
  va_end(args);
  if (n < 0) return;
  CagNote *note = &d->notes[d->note_count++];
  note->kind = kind;
  note->source = source;
  note->span = span;
  note->text = text;
}

void cag_diagnostics_move(CagDiagnostics *to, CagDiagnostics *from) {
  for (size_t i = 0; i < from->count; i++) {
    CagDiagnostic *moved = cag_diagnostics_at(from, i), *item = new_item(to);
    if (item) {
      *item = *moved;
    } else {
      release(moved);
      to->dropped++;
    }
  }
  to->dropped += from->dropped;
  from->count = 0;
  cag_diagnostics_clear(from);
}

static uint32_t start_of(const CagDiagnostics *d, size_t i) {
  return cag_diagnostics_at(d, i)->span.start;
}

// Merges the sorted halves [from, middle) and [middle, to) of the list, by way of `buffer`.
static void merge(CagDiagnostics *d, size_t from, size_t middle, size_t to, CagDiagnostic *buffer) {
  size_t a = from, b = middle;
  for (size_t i = 0; i < to - from; i++) {
    const bool left = b >= to || (a < middle && start_of(d, a) <= start_of(d, b));
    buffer[i] = *cag_diagnostics_at(d, left ? a++ : b++);
  }
  for (size_t i = 0; i < to - from; i++) *cag_diagnostics_at(d, from + i) = buffer[i];
}

// Sorts a few items by insertion, which needs no memory and keeps the order of equal ones.
static void sort_few(CagDiagnostics *d, size_t from, size_t to) {
  for (size_t i = from + 1; i < to; i++) {
    CagDiagnostic moved = *cag_diagnostics_at(d, i);
    size_t k = i;
    for (; k > from && start_of(d, k - 1) > moved.span.start; k--)
      *cag_diagnostics_at(d, k) = *cag_diagnostics_at(d, k - 1);
    *cag_diagnostics_at(d, k) = moved;
  }
}

void cag_diagnostics_sort(CagDiagnostics *d, size_t from) {
  const size_t n = d->count - from;
  if (d->count < from || n < 2) return;
  CagDiagnostic *buffer = n > CAG_DIAGNOSTICS_MAX ? malloc(n * sizeof *buffer) : NULL;
  if (!buffer) {
    sort_few(d, from, d->count);
    return;
  }
  for (size_t i = from; i < d->count; i += CAG_DIAGNOSTICS_MAX)
    sort_few(d, i, d->count - i < CAG_DIAGNOSTICS_MAX ? d->count : i + CAG_DIAGNOSTICS_MAX);
  for (size_t width = CAG_DIAGNOSTICS_MAX; width < n; width *= 2)
    for (size_t i = from; i + width < d->count; i += 2 * width)
      merge(d, i, i + width, i + 2 * width < d->count ? i + 2 * width : d->count, buffer);
  free(buffer);
}

void cag_diagnostics_sort_last(CagDiagnostics *d) {
  size_t from = d->count;
  while (from > 0 &&
         cag_diagnostics_at(d, from - 1)->source == cag_diagnostics_at(d, d->count - 1)->source)
    from--;
  cag_diagnostics_sort(d, from);
}

// ---- the nearest name ----

// Longer names are not compared.
#define LONGEST_NAME 64

static char folded(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

// The edit distance of two names, where a transposition of two neighboring letters counts as one
// edit (optimal string alignment), or `limit + 1` if it is larger than limit. Ignores case.
static size_t edit_distance(const char *a, size_t n, const char *b, size_t m, size_t limit) {
  size_t rows[3][LONGEST_NAME + 1];
  size_t *before = rows[0], *last = rows[1], *row = rows[2];
  for (size_t j = 0; j <= m; j++) last[j] = j;
  for (size_t i = 1; i <= n; i++) {
    row[0] = i;
    size_t least = i;
    for (size_t j = 1; j <= m; j++) {
      char x = folded(a[i - 1]), y = folded(b[j - 1]);
      size_t cost = last[j - 1] + (x != y);
      if (last[j] + 1 < cost) cost = last[j] + 1;
      if (row[j - 1] + 1 < cost) cost = row[j - 1] + 1;
      if (i > 1 && j > 1 && x == folded(b[j - 2]) && folded(a[i - 2]) == y &&
          before[j - 2] + 1 < cost)
        cost = before[j - 2] + 1;
      row[j] = cost;
      if (cost < least) least = cost;
    }
    if (least > limit) return limit + 1;
    size_t *free_row = before;
    before = last;
    last = row;
    row = free_row;
  }
  return last[m];
}

const char *cag_nearest_name(const char *name, const char *const *candidates, size_t count) {
  size_t n = strlen(name);
  if (n == 0 || n > LONGEST_NAME) return NULL;
  size_t limit = n / 3 > 1 ? n / 3 : 1;
  const char *best = NULL;
  for (size_t i = 0; i < count; i++) {
    size_t m = strlen(candidates[i]);
    if (m > LONGEST_NAME || m + limit < n || n + limit < m || strcmp(name, candidates[i]) == 0)
      continue;
    size_t distance = edit_distance(name, n, candidates[i], m, limit);
    if (distance > limit || distance >= n)
      continue;                              // if every letter differs, it is not a misspelling
    if (best && distance == limit) continue; // keep the first of equally near names
    best = candidates[i];
    if (distance == 0) return best;
    limit = distance;
  }
  return best;
}
