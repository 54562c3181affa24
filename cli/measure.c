// cag measure FILE [NAME]: measures what a script shows, or one of its definitions.

#include <cJSON.h>
#include <stdarg.h>
#include <string.h>

#include "cli/tool.h"
#include "live/measures.h"

static void print_line(const char *name, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void print_line(const char *name, const char *format, ...) {
  va_list args;
  va_start(args, format);
  printf("  %-10s  ", name);
  vprintf(format, args);
  putchar('\n');
  va_end(args);
}

// Numbers are written as in the JSON, which has their shortest text. Empty: there is none.
static const char *text_of(const cJSON *object, const char *name) {
  const cJSON *item = cJSON_GetObjectItem(object, name);
  return item && item->valuestring ? item->valuestring : "";
}

static void print_number(const cJSON *part, const char *name, const char *unit) {
  const char *text = text_of(part, name);
  if (*text) print_line(name, "%s %s", text, unit);
}

static void print_point(const cJSON *part, const char *name) {
  const cJSON *list = cJSON_GetObjectItem(part, name), *x;
  if (!cJSON_IsArray(list)) return;
  printf("  %-10s  [", name);
  cJSON_ArrayForEach(x, list)
      printf("%s%s", x->prev && x != list->child ? ", " : "", x->valuestring);
  puts("]");
}

static void print_bounds(const cJSON *part) {
  const cJSON *box = cJSON_GetObjectItem(part, "bounds");
  if (!cJSON_IsObject(box)) return;
  print_point(box, "min");
  print_point(box, "max");
  print_point(box, "size");
}

static void print_part(const cJSON *part) {
  const char *type = text_of(part, "type"), *kind = text_of(part, "kind");
  printf("%s: %s", text_of(part, "name"), type);
  if (strcmp(type, kind) != 0) printf(", %s", kind);
  if (cJSON_IsTrue(cJSON_GetObjectItem(part, "empty"))) printf(", empty");
  if (!cJSON_IsTrue(cJSON_GetObjectItem(part, "exact"))) printf(", measured by its mesh");
  putchar('\n');
  print_bounds(part);
  print_number(part, "length", "mm");
  print_number(part, "area", "mm2");
  print_number(part, "volume", "mm3");
  print_point(part, "centroid");
  const cJSON *watertight = cJSON_GetObjectItem(part, "watertight"),
              *faces = cJSON_GetObjectItem(part, "faces");
  if (cJSON_IsBool(watertight))
    print_line("watertight", "%s", cJSON_IsTrue(watertight) ? "yes" : "no");
  else print_line("closed", "%s", cJSON_IsTrue(cJSON_GetObjectItem(part, "closed")) ? "yes" : "no");
  if (cJSON_IsNumber(faces)) print_line("faces", "%.0f", faces->valuedouble);
}

static void print_all(const cJSON *whole) {
  const cJSON *part, *parts = cJSON_GetObjectItem(whole, "parts");
  if (*text_of(whole, "value"))
    printf("%s: %s\n  %s\n", text_of(whole, "name"), text_of(whole, "type"),
           text_of(whole, "value"));
  cJSON_ArrayForEach(part, parts) print_part(part);
  if (cJSON_GetArraySize(parts) < 2) return;
  const cJSON *total = cJSON_GetObjectItem(whole, "total");
  printf("total of %d parts\n", cJSON_GetArraySize(parts));
  print_bounds(total);
  print_number(total, "area", "mm2");
  print_number(total, "volume", "mm3");
  print_point(total, "centroid");
}

int cag_tool_measure(CagTool *t, int argc, char **argv) {
  t->session.out = stderr; // what the script prints is not a measure
  CagSession *s = cag_tool_session(t);
  if (!s) return CAG_STATUS_LIMIT;
  CagMeasuring m = {.status = cag_session_run_file(s, argv[0])};
  if (m.status == CAG_STATUS_OK) m = cag_measure(s, argv[0], argc > 1 ? argv[1] : NULL);
  const int status = cag_tool_finish(t, s, m.status);
  if (status == CAG_STATUS_OK && t->json) {
    char *text = cJSON_Print(m.whole);
    if (text) puts(text);
    cJSON_free(text);
  } else if (status == CAG_STATUS_OK) {
    print_all(m.whole);
  }
  cJSON_Delete(m.whole);
  cag_session_free(s);
  return status;
}
