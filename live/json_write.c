#include "live/json_write.h"

#include <math.h>
#include <string.h>

#include "base/json_text.h"
#include "base/status.h"

static void add(CagJson *j, const char *text) { cag_string_add(j->to, text, strlen(text)); }

static void add_quoted(CagJson *j, const char *text) {
  char buffer[8];
  const char *from = text;
  add(j, "\"");
  for (const char *at = text; *at; at++) {
    const char *escape = cag_json_escape(*at, buffer);
    if (!escape) continue;
    cag_string_add(j->to, from, (size_t)(at - from));
    add(j, escape);
    from = at + 1;
  }
  add(j, from);
  add(j, "\"");
}

static void begin_item(CagJson *j, const char *key) {
  if (j->follows) add(j, ",");
  j->follows = true;
  if (!key) return;
  add_quoted(j, key);
  add(j, ":");
}

void cag_json_open_in(CagJson *j, const char *key, char bracket) {
  begin_item(j, key);
  cag_string_add(j->to, &bracket, 1);
  j->follows = false;
}

void cag_json_open(CagJson *j, char bracket) { cag_json_open_in(j, NULL, bracket); }

void cag_json_close(CagJson *j, char bracket) {
  cag_string_add(j->to, &bracket, 1);
  j->follows = true;
}

void cag_json_null(CagJson *j, const char *key) {
  begin_item(j, key);
  add(j, "null");
}

void cag_json_text(CagJson *j, const char *key, const char *text) {
  if (!text) {
    cag_json_null(j, key);
    return;
  }
  begin_item(j, key);
  add_quoted(j, text);
}

static void add_number(CagJson *j, double x) {
  char text[32];
  add(j, isfinite(x) ? cag_number_text(x, text) : "null");
}

void cag_json_number(CagJson *j, const char *key, double x) {
  begin_item(j, key);
  add_number(j, x);
}

void cag_json_bool(CagJson *j, const char *key, bool b) {
  begin_item(j, key);
  add(j, b ? "true" : "false");
}

void cag_json_numbers(CagJson *j, const char *key, const double *x, size_t n) {
  cag_json_open_in(j, key, '[');
  for (size_t i = 0; i < n; i++) cag_json_number(j, NULL, x[i]);
  cag_json_close(j, ']');
}
