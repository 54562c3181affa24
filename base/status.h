// Error reporting: functions return a status and fill a CagError with the message, the argument,
// and the index of the invalid element.
//
// A function that can fail returns CagStatus and takes `CagError *err` last (never NULL). Outputs
// are initialized only if it returns CAG_OK. Nothing in base/ and geom/ prints, exits, or keeps
// global state, except for a flag of each thread that records exhausted memory. Functions that
// access files return bool instead.

#ifndef CAG_BASE_STATUS_H
#define CAG_BASE_STATUS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/assert.h"
#include "base/error.h"

typedef enum CagStatus {
  CAG_OK,
  CAG_E_ARGUMENT,    // an invalid value: negative radius, too few points, decreasing knots
  CAG_E_DOMAIN,      // a parameter outside the domain
  CAG_E_DEGENERATE,  // valid input, but the result is undefined: tangent of a point, normal at a
                     // cusp
  CAG_E_UNSUPPORTED, // not supported for this kind of shape: exact NURBS of a helix
  CAG_E_CONVERGENCE, // an iteration reached its maximum number of steps
  CAG_E_LIMIT,       // a limit of the run (triangles) would be exceeded
  CAG_E_MEMORY,
  CAG_E_CALLBACK, // a function of the caller failed and keeps its own error, or the work was
                  // stopped
  CAG_E_FILE,     // a file cannot be read or written
  CAG_E_RENDERER, // the renderer cannot be run, or failed
  CAG_E_USAGE     // an invalid option of the program
} CagStatus;

typedef struct CagError {
  CagStatus status;
  CagErrorId id;     // such as CAG_ERR_parameter_range; its row gives the reason that scripts see
  char argument[32]; // the argument's name in the language, such as "knots"; empty: none
  long index;        // index of the invalid element; -1: none
  char message[512]; // what was expected and found, without the function's name: "`knots` must not
                     // decrease: knots[5] = ..."; includes the last lines of the renderer
  char help[256];    // how to fix it; may be empty
} CagError;

// Fills err and returns status: `return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knots_not_monotone,
// "knots", i, "...", ...)`.
CagStatus cag_fail(CagError *err, CagStatus status, CagErrorId id, const char *argument, long index,
                   const char *format, ...) __attribute__((format(printf, 6, 7)));
CagStatus cag_fail_memory(CagError *err);
// Both return an error, never CAG_OK. The macros state this to compilers and analyzers, which
// otherwise cannot tell that results are initialized if the status is CAG_OK.
static inline CagStatus cag_never_ok(CagStatus status) {
  CAG_ASSERT(status);
  if (!status) __builtin_unreachable();
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
// too long for their fields are truncated at a whole UTF-8 character. `help` may be NULL. The
// error's id is the general one of its status.
bool cag_fail_io(CagError *err, CagStatus status, const char *help, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// Returns the exit status of a program that ends with this error: 1 to 5, or 130 if it was
// interrupted.
int cag_exit_status(const CagError *err);
// Records that memory ran out, as cag_fail_memory does, for functions that cannot return a status.
void cag_note_memory(void);
// Returns whether memory ran out on this thread since the last call. Callers check this even after
// CAG_OK, because an intermediate function may have treated the failure as a negative answer.
bool cag_memory_was_out(void);
// Tests whether a call failed for a reason that an alternative method cannot avoid: memory ran out
// or the caller canceled. Code that tries an alternative after a failure must return these errors.
static inline bool cag_is_final(CagStatus status) {
  return status == CAG_E_MEMORY || status == CAG_E_CALLBACK;
}
// Tests whether the call failed because its shape is empty ("empty-shape").
bool cag_is_empty_shape(const CagError *err);

// Writes the shortest text that reads back as x to `buffer`, of at least 32 bytes, for messages.
// Returns buffer.
const char *cag_number_text(double x, char *buffer);
// Returns the article of a word by its first letter: "an" offset, "a" line, "a" union.
const char *cag_article(const char *word);

#endif
