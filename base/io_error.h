// The error of everything that reads or writes files or runs a renderer.
//
// A function that can fail returns false (or NULL) and fills one of these: a message that names the
// file and what is wrong with it, a mend where there is one, and the exit status that the program
// ends with if nobody handles the error.

#ifndef CAG_BASE_IO_ERROR_H
#define CAG_BASE_IO_ERROR_H

#include <stdbool.h>

// The exit statuses of the command line that errors of files and renderers lead to.
enum {
  CAG_EXIT_SCRIPT = 1,
  CAG_EXIT_USAGE = 2,
  CAG_EXIT_FILE = 3,
  CAG_EXIT_RENDERER = 4,
  CAG_EXIT_LIMIT = 5,
  CAG_EXIT_INTERRUPTED = 130,
};

typedef struct CagIoError {
  int exit_status;   // one of CAG_EXIT_*
  char message[512]; // one sentence; renderers add their last lines, separated by '\n'
  char help[256];    // the mend, or empty
} CagIoError;

// Fills `err` (which may be NULL) and returns false, so that a function can end with it. A text too
// long for its field is cut at a whole UTF-8 character. `help` may be NULL.
bool cag_io_error_set(CagIoError *err, int exit_status, const char *help, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#endif
