// The output of POV-Ray: its progress, the first error, and the last lines. Part of povray.c.

#ifndef CAG_INTERP_RENDER_POVRAY_LOG_H
#define CAG_INTERP_RENDER_POVRAY_LOG_H

#include <stdbool.h>
#include <stddef.h>

#include "interp/render/povray.h"

// The longest line that is kept. POV-Ray breaks its lines at 80.
#define CAG_POVRAY_LINE_MAX 200
// The number of last lines that are kept for error messages.
#define CAG_POVRAY_LAST_LINES 5

typedef struct CagPovrayLog {
  CagPovrayProgress progress;
  void *progress_user;
  const char *phase; // named by the last heading
  char line[CAG_POVRAY_LINE_MAX];
  size_t length;
  char last[CAG_POVRAY_LAST_LINES]
           [CAG_POVRAY_LINE_MAX]; // ring: line i of the run is at i modulo the size
  size_t line_count;
  char version[64];
  // The first error with a location: its file, its line (0 if none was seen), and its text with
  // continuation lines.
  char error_file[CAG_POVRAY_LINE_MAX];
  size_t error_line;
  char error_text[2 * CAG_POVRAY_LINE_MAX];
  bool error_continues;
  bool told_statistics; // printed at the end of rendering
} CagPovrayLog;

// Adds output in pieces of any size. Lines end with '\n', progress lines with '\r'.
void cag_povray_log_feed(CagPovrayLog *log, const char *bytes, size_t n);

// Adds a last line without a line end.
void cag_povray_log_finish(CagPovrayLog *log);

// To be called when the picture is complete, because the last line of progress may be missing.
void cag_povray_log_whole(CagPovrayLog *log);

// Writes the last lines to `out`, each after a '\n'.
void cag_povray_log_last(const CagPovrayLog *log, char *out, size_t size);

#endif
