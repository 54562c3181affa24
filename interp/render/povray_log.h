// What POV-Ray says while it runs: progress, the first error, the last lines. Part of povray.c.

#ifndef CAG_INTERP_RENDER_POVRAY_LOG_H
#define CAG_INTERP_RENDER_POVRAY_LOG_H

#include <stdbool.h>
#include <stddef.h>

#include "interp/render/povray.h"

// Longest line that is kept; POV-Ray itself breaks its lines at 80.
#define CAG_POVRAY_LINE_MAX 200
// How many last lines are kept for the message of a failure.
#define CAG_POVRAY_LAST_LINES 5

typedef struct CagPovrayLog {
  CagPovrayProgress progress;
  void *progress_user;
  const char *phase; // the one that the last heading named
  char line[CAG_POVRAY_LINE_MAX];
  size_t length;
  char last[CAG_POVRAY_LAST_LINES]
           [CAG_POVRAY_LINE_MAX]; // ring: line i of the run stands at i modulo the size
  size_t line_count;
  char version[64];
  // The first error that names a place: its file, its line (0 when none was seen), and its text
  // with continuations.
  char error_file[CAG_POVRAY_LINE_MAX];
  size_t error_line;
  char error_text[2 * CAG_POVRAY_LINE_MAX];
  bool error_continues;
  bool told_statistics; // which it does when all is rendered
} CagPovrayLog;

// Takes output as it comes, in pieces of any size. Lines end in '\n', lines of progress in '\r'.
void cag_povray_log_feed(CagPovrayLog *log, const char *bytes, size_t n);

// Takes a last line that has no end.
void cag_povray_log_finish(CagPovrayLog *log);

// The picture is whole, though its last line of progress may not have come.
void cag_povray_log_whole(CagPovrayLog *log);

// Puts the last lines into `out`, each after a '\n'.
void cag_povray_log_last(const CagPovrayLog *log, char *out, size_t size);

#endif
