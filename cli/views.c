// Lists of cameras, and file name patterns with a placeholder for the name of a camera.
//
// A pattern is user input and never passed to printf.

#include "cli/views.h"

#include <string.h>

bool cag_views_next(const char **at, char name[CAG_VIEW_NAME_MAX]) {
  if (!*at) return false;
  const size_t n = strcspn(*at, ",");
  const bool fits = n < CAG_VIEW_NAME_MAX;
  if (fits) memcpy(name, *at, n);
  name[fits ? n : 0] = 0;
  *at = (*at)[n] ? *at + n + 1 : NULL;
  return true;
}

int cag_views_places(const char *pattern) {
  int places = 0;
  for (const char *at = pattern; (at = strchr(at, '%')); at += 2) {
    if (at[1] != 's' && at[1] != '%') return -1;
    places += at[1] == 's';
  }
  return places;
}

bool cag_views_name(const char *pattern, const char *view, char *out, size_t size) {
  size_t used = 0;
  for (const char *at = pattern; *at; at++) {
    const bool percent = at[0] == '%' && at[1] == '%', place = at[0] == '%' && at[1] == 's';
    const size_t n = place ? strlen(view) : 1;
    if (used + n >= size) return false;
    memcpy(out + used, place ? view : at, n);
    used += n;
    if (percent || place) at++;
  }
  out[used] = 0;
  return true;
}
