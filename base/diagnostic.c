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
  while (d->count > n) release(&d->items[--d->count]);
  d->dropped = 0;
}

void cag_diagnostics_clear(CagDiagnostics *d) { cag_diagnostics_truncate(d, 0); }

static CagDiagnostic *thrown_away(CagDiagnostics *d) {
  d->dropped++;
  release(&scratch);
  return &scratch;
}

CagDiagnostic *cag_diagnostics_add(CagDiagnostics *d, CagErrorId id, const CagSource *source,
                                   CagSpan span, const char *format, ...) {
  if (d->count >= CAG_DIAGNOSTICS_MAX) return thrown_away(d);
  va_list args;
  va_start(args, format);
  char *message;
  int n = vasprintf(&message, format, args);
  va_end(args);
  if (n < 0) {
    message = no_memory;
    id = CAG_ERR_limit_memory;
  }
  CagDiagnostic *fresh = &d->items[d->count++];
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
    if (to->count < CAG_DIAGNOSTICS_MAX) {
      to->items[to->count++] = from->items[i];
    } else {
      release(&from->items[i]);
      to->dropped++;
    }
  }
  to->dropped += from->dropped;
  from->count = 0;
  from->dropped = 0;
}

void cag_diagnostics_sort(CagDiagnostics *d, size_t from) {
  for (size_t i = from + 1; i < d->count; i++) {
    CagDiagnostic moved = d->items[i];
    size_t k = i;
    for (; k > from && d->items[k - 1].span.start > moved.span.start; k--)
      d->items[k] = d->items[k - 1];
    d->items[k] = moved;
  }
}

void cag_diagnostics_sort_last(CagDiagnostics *d) {
  size_t from = d->count;
  while (from > 0 && d->items[from - 1].source == d->items[d->count - 1].source) from--;
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
