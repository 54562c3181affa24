// Writing JSON as text, in order and without a tree. (json.h has helpers for trees.)
//
//     CagString s = {0};
//     CagJson j = {.to = &s};
//     cag_json_open(&j, '{');
//     cag_json_text(&j, "name", part.name);
//     cag_json_numbers(&j, "at", part.at, 3);
//     cag_json_close(&j, '}');
//
// Commas are added where they are needed. The key is NULL within an array. Numbers that are not
// finite become null. If memory runs out, s.failed is set.

#ifndef CAG_LIVE_JSON_WRITE_H
#define CAG_LIVE_JSON_WRITE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/string.h"

typedef struct CagJson {
  CagString *to;
  bool follows; // something is before the next item
} CagJson;

void cag_json_open(CagJson *j, char bracket);
void cag_json_open_in(CagJson *j, const char *key, char bracket);
void cag_json_close(CagJson *j, char bracket);
void cag_json_text(CagJson *j, const char *key, const char *text); // text NULL: null
void cag_json_number(CagJson *j, const char *key, double x);
void cag_json_bool(CagJson *j, const char *key, bool b);
void cag_json_numbers(CagJson *j, const char *key, const double *x, size_t n);
void cag_json_null(CagJson *j, const char *key);

#endif
