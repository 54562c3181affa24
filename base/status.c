// Errors as values: filling a CagError, and numbers as messages show them.

#include "base/status.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/stop.h"

CagStatus cag_fail(CagError *err, CagStatus status, CagErrorId id, const char *argument, long index,
                   const char *format, ...) {
  err->status = status;
  err->id = id;
  snprintf(err->argument, sizeof err->argument, "%s", argument ? argument : "");
  err->index = index;
  va_list values;
  va_start(values, format);
  vsnprintf(err->message, sizeof err->message, format, values);
  va_end(values);
  return status;
}

bool cag_is_empty_shape(const CagError *err) { return err->id == CAG_ERR_empty_shape; }

static _Thread_local bool memory_was_out;

void cag_note_memory(void) { memory_was_out = true; }

bool cag_memory_was_out(void) {
  const bool out = memory_was_out;
  memory_was_out = false;
  return out;
}

// Functions that only tell that they could not finish do so as well if the work is to end.
CagStatus cag_fail_memory(CagError *err) {
  if (cag_stopped()) return cag_stop_fail(err);
  cag_note_memory();
  return cag_fail(err, CAG_E_MEMORY, CAG_ERR_limit_memory, "", -1, "there is no memory left");
}

// 17 digits always read back the same, 15 often do and are what a person would write.
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
