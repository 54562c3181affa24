// Helpers for JSON by cJSON.

#ifndef CAG_LIVE_JSON_H
#define CAG_LIVE_JSON_H

#include <cJSON.h>
#include <stddef.h>

#include "cag.h"

// Adds a number with the shortest text that reads back as the same number, which has at most 17
// digits; null if it is not finite. (cJSON's own text can differ in the last digit.)
void cag_json_add_number(cJSON *object, const char *name, double x);
// Adds a list of such numbers.
void cag_json_add_numbers(cJSON *object, const char *name, const double *x, size_t n);

// The diagnostics of the session's last call, as a list of the objects of CAG_STYLE_JSON.
cJSON *cag_json_diagnostics(const CagSession *s);

#endif
