// Errors of files and renderers: filling the fields.

#include "base/io_error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Takes an incomplete UTF-8 character off the end of a text that was cut to fit.
static void trim_cut_character(char *text) {
  size_t n = strlen(text), tail = 0;
  while (tail < n && tail < 4 && ((unsigned char)text[n - 1 - tail] & 0xC0) == 0x80) tail++;
  if (tail == n) return;
  unsigned char lead = (unsigned char)text[n - 1 - tail];
  size_t want = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
  if (tail < want) text[n - 1 - tail] = '\0';
}

bool cag_io_error_set(CagIoError *err, int exit_status, const char *help, const char *format, ...) {
  if (!err) return false;
  err->exit_status = exit_status;
  va_list args;
  va_start(args, format);
  vsnprintf(err->message, sizeof err->message, format, args);
  va_end(args);
  snprintf(err->help, sizeof err->help, "%s", help ? help : "");
  trim_cut_character(err->message);
  trim_cut_character(err->help);
  return false;
}
