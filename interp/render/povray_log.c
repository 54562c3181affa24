// The output of POV-Ray. It breaks lines at 80 characters; continuation lines start with a blank.

#include "interp/render/povray_log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Headings look like `==== [Rendering...] ====`.
static const struct {
  const char *heading, *phase;
} PHASES[] = {
    {"==== [Parsing", "parsing"},     {"==== [Shooting", "photons"},
    {"==== [Sorting", "photons"},     {"==== [Radiosity", "radiosity"},
    {"==== [Rendering", "rendering"},
};

static void report(CagPovrayLog *log, double percent) {
  if (log->progress && log->phase) log->progress(log->progress_user, percent, log->phase);
}

// A heading starts a phase.
static bool take_heading(CagPovrayLog *log, const char *line) {
  for (size_t i = 0; i < sizeof PHASES / sizeof *PHASES; i++) {
    if (strncmp(line, PHASES[i].heading, strlen(PHASES[i].heading)) != 0) continue;
    log->phase = PHASES[i].phase;
    report(log, 0);
    return true;
  }
  return false;
}

// Reads `Rendered 1024 of 3072 pixels (33%)` and `Parsing 11179K tokens`, whose total is unknown.
// The percentage is computed from the counts, which are more precise.
static bool take_progress(CagPovrayLog *log, const char *line) {
  double done, all;
  if (sscanf(line, "Rendered %lf of %lf pixels", &done, &all) == 2) {
    if (!log->phase) log->phase = "rendering";
    if (all > 0) report(log, 100 * done / all);
    return true;
  }
  if (!strncmp(line, "Parsing ", 8) && strstr(line, " tokens")) {
    report(log, 0);
    return true;
  }
  if (!strncmp(line, "Photon", 6) || !strncmp(line, "Shooting photons", 16)) {
    report(log, 0);
    return true;
  }
  return false;
}

// Reads `File 'scene.pov' line 12: Parse Error: ...`. Keeps only the first definite error, not
// possible ones.
static void take_error(CagPovrayLog *log, const char *line) {
  const size_t used = strlen(log->error_text);
  if (log->error_continues && *line == ' ') {
    snprintf(log->error_text + used, sizeof log->error_text - used, "%s", line);
    return;
  }
  log->error_continues = false;
  if (log->error_line || strncmp(line, "File '", 6) != 0) return;
  const char *quote = strstr(line + 6, "' line ");
  if (!quote) return;
  char *after;
  const unsigned long number = strtoul(quote + 7, &after, 10);
  if (strncmp(after, ": ", 2) != 0 || !strstr(after, "Error: ") || strstr(after, "Possible"))
    return;
  snprintf(log->error_file, sizeof log->error_file, "%.*s", (int)(quote - line - 6), line + 6);
  snprintf(log->error_text, sizeof log->error_text, "%s", strstr(after, "Error: ") + 7);
  log->error_line = number ? number : 1;
  log->error_continues = true;
}

static void take_version(CagPovrayLog *log, const char *line) {
  static const char *const LEADS[] = {"Persistence of Vision(tm) Ray Tracer Version ", "POV-Ray "};
  for (size_t i = 0; i < 2 && !log->version[0]; i++) {
    const char *digits = line + strlen(LEADS[i]);
    if (strncmp(line, LEADS[i], strlen(LEADS[i])) != 0 || *digits < '0' || *digits > '9') continue;
    snprintf(log->version, sizeof log->version, "%.*s", (int)strcspn(digits, " "), digits);
  }
}

static void take_line(CagPovrayLog *log) {
  log->line[log->length] = '\0';
  log->length = 0;
  const char *line = log->line;
  if (!*line || take_progress(log, line)) return;
  take_error(log, line);
  if (take_heading(log, line)) return;
  take_version(log, line);
  log->told_statistics |= !strncmp(line, "Render Statistics", 17);
  memcpy(log->last[log->line_count++ % CAG_POVRAY_LAST_LINES], line, CAG_POVRAY_LINE_MAX);
}

void cag_povray_log_feed(CagPovrayLog *log, const char *bytes, size_t n) {
  for (size_t i = 0; i < n; i++) {
    if (bytes[i] == '\n' || bytes[i] == '\r') take_line(log);
    else if (log->length + 1 < sizeof log->line && bytes[i]) log->line[log->length++] = bytes[i];
  }
}

void cag_povray_log_finish(CagPovrayLog *log) { take_line(log); }

void cag_povray_log_whole(CagPovrayLog *log) {
  log->phase = "rendering";
  report(log, 100);
}

void cag_povray_log_last(const CagPovrayLog *log, char *out, size_t size) {
  const size_t kept =
      log->line_count < CAG_POVRAY_LAST_LINES ? log->line_count : CAG_POVRAY_LAST_LINES;
  *out = '\0';
  for (size_t i = log->line_count - kept; i < log->line_count; i++) {
    const size_t used = strlen(out);
    snprintf(out + used, size - used, "\n%.100s", log->last[i % CAG_POVRAY_LAST_LINES]);
  }
}
