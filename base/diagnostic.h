// Diagnostics: what is wrong with a script, its location, and how to fix it.
//
// Every kind of error is a row of errors.def: a stable code, a short name, and an explanation. A
// diagnostic is plain data. `cag_diagnostic_render` formats it as text for people or as one line of
// JSON.

#ifndef CAG_BASE_DIAGNOSTIC_H
#define CAG_BASE_DIAGNOSTIC_H

#include <stdbool.h>
#include <stdio.h>

#include "base/error.h"
#include "base/source.h"

typedef enum CagSeverity {
  CAG_SEVERITY_ERROR,
  CAG_SEVERITY_WARNING,
  CAG_SEVERITY_NOTE
} CagSeverity;

// A further location: a call of the call chain ("called from", with the function's name in `text`),
// or a related definition.
typedef struct CagNote {
  enum { CAG_NOTE_CALL, CAG_NOTE_TAIL_CALL, CAG_NOTE_RELATED, CAG_NOTE_OMITTED } kind;
  const CagSource *source; // NULL: no location
  CagSpan span;
  char *text; // CALL: the function; RELATED: "first defined here"; OMITTED: "9 980 more calls"
} CagNote;

typedef struct CagDiagnostic {
  CagSeverity severity;
  CagErrorId id;
  char *message; // "sin expects an angle, found the number 30"
  char *help;    // how to fix it, shown after the carets: "write 30deg or 30rad"; NULL: none
  const CagSource *source; // NULL: the error has no location in a script
  CagSpan span;
  CagNote *notes;
  size_t note_count, note_capacity;
} CagDiagnostic;

// The diagnostics of a parse or a run. At most `most` are kept (0: CAG_DIAGNOSTICS_MAX); `dropped`
// counts the others. The first ones need no allocation, so exhausted memory can always be reported.
#define CAG_DIAGNOSTICS_MAX 20
typedef struct CagDiagnostics {
  CagDiagnostic items[CAG_DIAGNOSTICS_MAX];
  size_t count;
  size_t dropped;
  size_t most;
  CagDiagnostic *more; // those after CAG_DIAGNOSTICS_MAX
  size_t more_capacity;
} CagDiagnostics;

// Returns item i, which must be less than `count`.
static inline CagDiagnostic *cag_diagnostics_at(const CagDiagnostics *d, size_t i) {
  return i < CAG_DIAGNOSTICS_MAX ? (CagDiagnostic *)&d->items[i]
                                 : &d->more[i - CAG_DIAGNOSTICS_MAX];
}
static inline bool cag_diagnostics_full(const CagDiagnostics *d) {
  return d->count >= (d->most ? d->most : CAG_DIAGNOSTICS_MAX);
}

void cag_diagnostics_clear(CagDiagnostics *d);
// Releases all but the first n diagnostics.
void cag_diagnostics_truncate(CagDiagnostics *d, size_t n);

// Adds an error with a message formatted as by printf. If there is no memory for the message, adds
// the error for exhausted memory instead. The pointer is valid until the next call. If the list is
// full, returns a scratch diagnostic that is discarded; never returns NULL.
CagDiagnostic *cag_diagnostics_add(CagDiagnostics *d, CagErrorId id, const CagSource *source,
                                   CagSpan span, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
void cag_diagnostic_set_help(CagDiagnostic *d, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void cag_diagnostic_add_note(CagDiagnostic *d, int kind, const CagSource *source, CagSpan span,
                             const char *format, ...) __attribute__((format(printf, 5, 6)));
// Moves the diagnostics of `from` to the end of `to`.
void cag_diagnostics_move(CagDiagnostics *to, CagDiagnostics *from);

// Sorts the items from index `from` on, which all have the same source, by their position in the
// text.
void cag_diagnostics_sort(CagDiagnostics *d, size_t from);
// Sorts only the items at the end that share the source of the last one.
void cag_diagnostics_sort_last(CagDiagnostics *d);

typedef enum CagDiagnosticStyle {
  CAG_DIAGNOSTIC_TEXT,
  CAG_DIAGNOSTIC_COLOR,
  CAG_DIAGNOSTIC_JSON
} CagDiagnosticStyle;

// Writes a diagnostic as described in section 6 of the language, or as one JSON object on one line.
void cag_diagnostic_render(const CagDiagnostic *d, CagDiagnosticStyle style, FILE *out);
void cag_diagnostics_render(const CagDiagnostics *d, CagDiagnosticStyle style, FILE *out);

// Returns the candidate nearest to `name` by edit distance, which may be at most a third of its
// length or 1, or NULL.
const char *cag_nearest_name(const char *name, const char *const *candidates, size_t count);

#endif
