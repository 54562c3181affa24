// Errors as values: setting a CagError, and formatting numbers for messages.

#include "base/status.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/decimal.h"
#include "base/stop.h"
#include "base/utf8.h"

CagStatus(cag_fail)(CagError *err, CagStatus status, CagErrorId id, const char *argument,
                    long index, const char *format, ...) {
  err->status = status;
  err->id = id;
  snprintf(err->argument, sizeof err->argument, "%s", argument ? argument : "");
  err->index = index;
  err->help[0] = 0;
  va_list values;
  va_start(values, format);
  vsnprintf(err->message, sizeof err->message, format, values);
  va_end(values);
  return status;
}

// --- Files and renderers ---

// Removes an incomplete UTF-8 character from the end of a text that was truncated to fit.
static void trim_cut_character(char *text) {
  size_t n = strlen(text), tail = 0;
  while (tail < n && tail < 4 && cag_utf8_is_within(text[n - 1 - tail])) tail++;
  if (tail == n) return;
  unsigned char lead = (unsigned char)text[n - 1 - tail];
  size_t want = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
  if (tail < want) text[n - 1 - tail] = '\0';
}

static CagErrorId general_id(CagStatus status) {
  switch (status) {
  case CAG_E_CALLBACK: return CAG_ERR_interrupted;
  case CAG_E_LIMIT: return CAG_ERR_limit_time;
  case CAG_E_RENDERER: return CAG_ERR_renderer;
  case CAG_E_USAGE: return CAG_ERR_picture_size;
  default: return CAG_ERR_output_file;
  }
}

bool cag_fail_io(CagError *err, CagStatus status, const char *help, const char *format, ...) {
  if (!err) return false;
  *err = (CagError){.status = status, .id = general_id(status), .index = -1};
  va_list values;
  va_start(values, format);
  vsnprintf(err->message, sizeof err->message, format, values);
  va_end(values);
  snprintf(err->help, sizeof err->help, "%s", help ? help : "");
  trim_cut_character(err->message);
  trim_cut_character(err->help);
  return false;
}

int cag_exit_status(const CagError *err) {
  switch (err->status) {
  case CAG_OK: return 0;
  case CAG_E_USAGE: return 2;
  case CAG_E_FILE: return 3;
  case CAG_E_RENDERER: return 4;
  case CAG_E_LIMIT:
  case CAG_E_MEMORY: return 5;
  case CAG_E_CALLBACK: return 130;
  default: return 1;
  }
}

bool cag_is_empty_shape(const CagError *err) { return err->id == CAG_ERR_empty_shape; }

static _Thread_local bool memory_was_out;

void cag_note_memory(void) { memory_was_out = true; }

bool cag_memory_was_out(void) {
  const bool out = memory_was_out;
  memory_was_out = false;
  return out;
}

// If the work is to stop, some functions report this as failure without a reason, and their callers
// then call this.
CagStatus(cag_fail_memory)(CagError *err) {
  if (cag_stopped()) return cag_stop_fail(err);
  cag_note_memory();
  return cag_fail(err, CAG_E_MEMORY, CAG_ERR_limit_memory, "", -1, "out of memory");
}

// 17 digits always read back the same. 15 often do, and are what a person would write.
const char *cag_number_text(double x, char *buffer) {
  enum { SIZE = 32 };
  if (isnan(x)) {
    snprintf(buffer, SIZE, "nan");
    return buffer;
  }
  if (isinf(x)) {
    snprintf(buffer, SIZE, x > 0 ? "inf" : "-inf");
    return buffer;
  }
  char *end = cag_decimal_shortest(buffer, x);
  if (end) {
    *end = 0;
    return buffer;
  }
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(buffer, SIZE, "%.*g", digits, x);
    if (strtod(buffer, NULL) == x) break;
  }
  return buffer;
}

const char *cag_article(const char *word) {
  const bool vowel = *word && strchr("aeiouAEIOU", *word) && strncmp(word, "uni", 3) != 0;
  return vowel ? "an" : "a";
}
