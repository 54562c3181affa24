#include "cli/params.h"

#include <cJSON.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/diagnostic.h"
#include "cli/scripts.h"

#define NAMES_MOST 256

static bool refuse(CagToolRefusal *why, const char *help, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static bool refuse(CagToolRefusal *why, const char *help, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(why->message, sizeof why->message, format, arguments);
  va_end(arguments);
  snprintf(why->help, sizeof why->help, "%s", help);
  return false;
}

static bool refuse_set(CagToolRefusal *why, const char *path, const char *name, const cJSON *sets) {
  const char *names[NAMES_MOST] = {NULL};
  size_t n = 0;
  char help[sizeof why->help] = "the file has no sets";
  const cJSON *set;
  cJSON_ArrayForEach(set, sets) if (n < NAMES_MOST) names[n++] = set->string;
  const char *nearest = cag_nearest_name(name, names, n);
  if (nearest) snprintf(help, sizeof help, "did you mean %s?", nearest);
  else if (n > 0) snprintf(help, sizeof help, "the first of its sets is %s", names[0]);
  return refuse(why, help, "%s has no set %s", path, name);
}

// A text is an expression, or the value of a param that is a text, as after -D.
static void give_values(const cJSON *set, CagParamGive *give, void *context) {
  const cJSON *value;
  cJSON_ArrayForEach(value, set) {
    char number[32];
    if (cJSON_IsString(value)) {
      give(context, value->string, value->valuestring);
    } else if (cJSON_IsNumber(value)) {
      give(context, value->string, cag_number_text(value->valuedouble, number));
    } else {
      char *text = cJSON_PrintUnformatted(value);
      if (text) give(context, value->string, text);
      free(text);
    }
  }
}

static bool give_set(const char *path, const char *name, const char *text, CagParamGive *give,
                     void *context, CagToolRefusal *why) {
  cJSON *sets = cJSON_Parse(text);
  const cJSON *set = cJSON_GetObjectItemCaseSensitive(sets, name);
  bool ok = cJSON_IsObject(set);
  if (ok) give_values(set, give, context);
  else if (!cJSON_IsObject(sets))
    refuse(why, "a file of sets has the form {\"tall\": {\"height\": 200}}",
           "%s is not a JSON object", path);
  else refuse_set(why, path, name, sets);
  cJSON_Delete(sets);
  return ok;
}

bool cag_params_read(const char *place, CagParamGive *give, void *context, CagToolRefusal *why) {
  const char *colon = strrchr(place, ':');
  if (!colon || colon == place || !colon[1])
    return refuse(why, "write --params FILE:NAME, such as --params vase.cag.params.json:tall",
                  "expected a file and the name of a set");
  char *path = strndup(place, (size_t)(colon - place));
  size_t length;
  char *text = path ? cag_tool_try_file(path, &length) : NULL;
  const bool ok = text ? give_set(path, colon + 1, text, give, context, why)
                       : refuse(why, "the page of `cag view` writes it beside the script",
                                "cannot read %s: %s", path ? path : place, strerror(errno));
  free(text);
  free(path);
  return ok;
}
