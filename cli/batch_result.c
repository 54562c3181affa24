// Describes the exit of a process: the first error of its diagnostics, or how it was ended.

#include "cli/batch_result.h"

#include <cJSON.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "cag.h"

// The maximum length of a message of a process.
#define MESSAGE_MAX 600

// Returns the "ball.cag:3:5: E0310: ..." of a diagnostic, or NULL for other lines and for warnings.
static char *read_diagnostic(const char *line, size_t length) {
  cJSON *object = cJSON_ParseWithLength(line, length);
  const char *severity = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "severity"));
  const char *message = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "message"));
  const char *code = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "code"));
  const char *file = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "file"));
  const cJSON *at = cJSON_GetObjectItemCaseSensitive(object, "line");
  char *text = NULL, place[24] = "";
  if (cJSON_IsNumber(at)) snprintf(place, sizeof place, ":%d", at->valueint);
  if (message && severity && !strcmp(severity, "error") &&
      asprintf(&text, "%.200s%s%s%.16s%s%.*s", file ? file : "", file ? place : "",
               file ? ": " : "", code ? code : "", code ? ": " : "", MESSAGE_MAX, message) < 0)
    text = NULL;
  cJSON_Delete(object);
  return text;
}

// Returns the first error that the process reported, or else its last line of output.
static char *told(const char *text) {
  const char *last = "";
  size_t last_length = 0;
  while (*text) {
    const size_t n = strcspn(text, "\n");
    char *message = *text == '{' ? read_diagnostic(text, n) : NULL;
    if (message) return message;
    if (n) last = text, last_length = n;
    text += n + (text[n] == '\n');
  }
  return last_length ? strndup(last, last_length < MESSAGE_MAX ? last_length : MESSAGE_MAX) : NULL;
}

// Makes a message fit on one line of the report.
static void make_line(char *text) {
  for (; text && *text; text++)
    if (*text == '\n' || *text == '\r') *text = ' ';
}

static char *print(const char *format, double value, const char *unit) {
  char *text = NULL;
  return asprintf(&text, format, value, unit) < 0 ? NULL : text;
}

int cag_child_result(const CagChild *c, double max_time, size_t limit_memory, char **message) {
  *message = NULL;
  if (WIFEXITED(c->status) && WEXITSTATUS(c->status) == CAG_STATUS_OK) return CAG_STATUS_OK;
  if (c->stop == CAG_CHILD_STOP_TIME) {
    *message = print("exceeded the time limit of %g %s", max_time, "s");
    return CAG_STATUS_LIMIT;
  }
  if (c->stop == CAG_CHILD_STOP_MEMORY) {
    *message =
        print("exceeded the memory limit of %.0f %s", (double)limit_memory / (1 << 20), "MB");
    return CAG_STATUS_LIMIT;
  }
  if (WIFSIGNALED(c->status)) {
    const int number = WTERMSIG(c->status);
    *message = print(number == SIGKILL
                         ? "killed by signal %.0f (%s); the system may have run out of memory"
                         : "ended by signal %.0f (%s)",
                     number, strsignal(number));
    return CAG_STATUS_SCRIPT;
  }
  *message = told(c->text);
  if (!*message) *message = print("failed with exit status %.0f%s", WEXITSTATUS(c->status), "");
  make_line(*message);
  return WEXITSTATUS(c->status);
}
