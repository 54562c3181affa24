// Messages of the program on standard error.

#include <cJSON.h>
#include <errno.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/tool.h"

// Writes the message as one JSON object with the same fields as diagnostics of scripts.
static void write_json(const char *message, const char *help) {
  cJSON *object = cJSON_CreateObject();
  cJSON_AddStringToObject(object, "severity", "error");
  cJSON_AddNullToObject(object, "code");
  cJSON_AddStringToObject(object, "message", message);
  if (help) cJSON_AddStringToObject(object, "help", help);
  char *text = cJSON_PrintUnformatted(object);
  fprintf(stderr, "%s\n", text ? text : "{\"severity\":\"error\"}");
  cJSON_free(text);
  cJSON_Delete(object);
}

int cag_tool_fail(const CagTool *t, int status, const char *help, const char *format, ...) {
  char *message = NULL;
  va_list args;
  va_start(args, format);
  const int n = vasprintf(&message, format, args);
  va_end(args);
  const char *shown = n < 0 ? "out of memory" : message;
  const char *name = t->command ? t->command->name : NULL;
  if (help && !*help) help = NULL;
  fflush(stdout); // earlier output comes first
  if (t->style == CAG_STYLE_JSON) {
    write_json(shown, help);
  } else {
    fprintf(stderr, "cag%s%s: %s\n", name ? " " : "", name ? name : "", shown);
    if (help) fprintf(stderr, "  %s\n", help);
  }
  if (n >= 0) free(message);
  return status;
}

void cag_tool_say(const CagTool *t, const char *format, ...) {
  if (t->quiet || t->style == CAG_STYLE_JSON) return;
  va_list args;
  va_start(args, format);
  fprintf(stderr, "cag %s: ", t->command->name);
  vfprintf(stderr, format, args);
  fputc('\n', stderr);
  va_end(args);
}

void cag_tool_say_tolerances(const CagTool *t, const CagSession *s) {
  static const char *const REASONS[][2] = {{"shape", "by `tolerance`"},
                                           {"option", "by --tolerance"},
                                           {"pixels", "a quarter of a pixel or less"},
                                           {"size", "by the size of what is shown"}};
  CagToleranceView v;
  for (size_t i = 0; cag_session_tolerance(s, i, &v); i++) {
    const char *reason = "";
    for (size_t k = 0; k < sizeof REASONS / sizeof *REASONS; k++)
      if (!strcmp(v.source, REASONS[k][0])) reason = REASONS[k][1];
    if (v.least == v.most) cag_tool_say(t, "tolerance %.6g mm, %s", v.most, reason);
    else cag_tool_say(t, "tolerances %.6g to %.6g mm, %s", v.least, v.most, reason);
  }
}

bool cag_tool_output_is_unread(void) {
  struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
  return poll(&out, 1, 0) > 0 && (out.revents & POLLERR);
}

int cag_tool_finish(CagTool *t, CagSession *s, int status) {
  fflush(stdout);
  if (status == CAG_STATUS_INTERRUPTED || cag_tool_interrupt) return CAG_STATUS_INTERRUPTED;
  if (status == CAG_STATUS_FILE && cag_tool_output_is_unread()) return status;
  cag_session_write_diagnostics(s, t->style, stderr);
  return status;
}

int cag_tool_close_output(const CagTool *t, int status) {
  errno = 0;
  const bool failed = fflush(stdout) != 0 || ferror(stdout);
  const int code = errno;
  if (!failed || cag_tool_interrupt || status == CAG_STATUS_FILE) return status;
  if (code != EPIPE && !cag_tool_output_is_unread())
    cag_tool_fail(t, CAG_STATUS_FILE, code == ENOSPC ? "free some space, or write elsewhere" : NULL,
                  "cannot write standard output%s%s", code ? ": " : "", code ? strerror(code) : "");
  return status == CAG_STATUS_OK ? CAG_STATUS_FILE : status;
}
