// The one way in which functions report errors: a status, and a CagError that carries the message,
// the argument, and the element at fault.
//
// A function that can fail returns CagStatus and takes `CagError *err` last (never NULL). Outputs
// are initialized only on CAG_OK. Nothing in base/ and geom/ prints, exits, or keeps global
// state, except for a flag of each thread that records exhausted memory. Functions of files return
// bool instead.

#ifndef CAG_BASE_STATUS_H
#define CAG_BASE_STATUS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/assert.h"
#include "base/error.h"

typedef enum CagStatus {
  CAG_OK,
  CAG_E_ARGUMENT,   // a value that no geometry has: negative radius, too few points, knots that
                    // decrease
  CAG_E_DOMAIN,     // a parameter outside the domain
  CAG_E_DEGENERATE, // the data are valid but the question has no answer: tangent of a point, normal
                    // at a cusp
  CAG_E_UNSUPPORTED, // the question is not one for this kind: exact NURBS of a helix
  CAG_E_CONVERGENCE, // an iteration met its limit
  CAG_E_LIMIT,       // a limit of the run (triangles) would be crossed
  CAG_E_MEMORY,
  CAG_E_CALLBACK, // a function of the caller failed and keeps its own error, or the work was
                  // stopped
  CAG_E_FILE,     // a file cannot be read or written
  CAG_E_RENDERER, // the renderer cannot be run, or failed
  CAG_E_USAGE     // an option of the program is wrong
} CagStatus;

typedef struct CagError {
  CagStatus status;
  CagErrorId id;     // CAG_ERR_parameter_range: its row gives the reason that scripts see
  char argument[32]; // the argument's name as the language has it: "knots"; empty: none
  long index;        // offending element; -1: none
  char message[512]; // what was expected and what was found, without the function's name: "`knots`
                     // must not decrease: knots[5] = ..."; renderers add their last lines
  char help[256];    // how to fix it; may be empty
} CagError;

// Fills err and gives status back: `return cag_fail(err, CAG_E_ARGUMENT,
// CAG_ERR_knots_not_monotone, "knots", i, "...", ...)`.
CagStatus cag_fail(CagError *err, CagStatus status, CagErrorId id, const char *argument, long index,
                   const char *format, ...) __attribute__((format(printf, 6, 7)));
CagStatus cag_fail_memory(CagError *err);
// Both return an error, never CAG_OK. The macros let compilers and analyzers know, so that they see
// that results are set where a status is CAG_OK.
static inline CagStatus cag_never_ok(CagStatus status) {
  CAG_ASSERT(status != CAG_OK);
  if (status == CAG_OK) __builtin_unreachable();
  return status;
}
// The same for functions that return whether something went well, such as the errors of a run.
static inline bool cag_never_true(bool ok) {
  CAG_ASSERT(!ok);
  if (ok) __builtin_unreachable();
  return ok;
}
#define cag_fail(...) cag_never_ok((cag_fail)(__VA_ARGS__))
#define cag_fail_memory(err) cag_never_ok((cag_fail_memory)(err))
// The same for files and renderers: fills err, which may be NULL, and returns false. Texts that are
// too long for their fields are cut at a whole UTF-8 character. `help` may be NULL. The error's id
// is the general one of its status.
bool cag_fail_io(CagError *err, CagStatus status, const char *help, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// The exit status of a program that ends with this error: 1 to 5, or 130 if it was interrupted.
int cag_exit_status(const CagError *err);
// Records that memory ran out, as cag_fail_memory does, where a function cannot return a status.
void cag_note_memory(void);
// Returns whether memory ran out on this thread since the last call. Callers check this even after
// CAG_OK, because an intermediate function may have treated the failure as a negative answer.
bool cag_memory_was_out(void);
// Tests whether a call failed for a reason that an alternative method cannot avoid: memory ran out
// or the caller canceled. Code that tries an alternative after a failure must return these errors.
static inline bool cag_is_final(CagStatus status) {
  return status == CAG_E_MEMORY || status == CAG_E_CALLBACK;
}
// Whether the call failed because nothing is left of a shape ("empty-shape").
bool cag_is_empty_shape(const CagError *err);

// Shortest text of a double that reads back the same, for messages: buffer of at least 32 bytes;
// gives buffer.
const char *cag_number_text(double x, char *buffer);
// The article of a word by its first letter: "an" offset, "a" line, "a" union.
const char *cag_article(const char *word);

#endif
