// Numbers, and diagnostics.

#include "live/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static cJSON *number(double x) {
  char text[32];
  return isfinite(x) ? cJSON_CreateRaw(cag_number_text(x, text)) : cJSON_CreateNull();
}

void cag_json_add_number(cJSON *object, const char *name, double x) {
  cJSON_AddItemToObject(object, name, number(x));
}

void cag_json_add_numbers(cJSON *object, const char *name, const double *x, size_t n) {
  cJSON *list = cJSON_AddArrayToObject(object, name);
  for (size_t i = 0; i < n; i++) cJSON_AddItemToArray(list, number(x[i]));
}

// The library writes one object per line.
cJSON *cag_json_diagnostics(const CagSession *s) {
  cJSON *list = cJSON_CreateArray();
  char *text = NULL, *rest = NULL;
  size_t length = 0;
  FILE *f = open_memstream(&text, &length);
  if (!f) return list;
  cag_session_write_diagnostics(s, CAG_STYLE_JSON, f);
  fclose(f);
  for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
    cJSON_AddItemToArray(list, cJSON_Parse(line));
  free(text);
  return list;
}
