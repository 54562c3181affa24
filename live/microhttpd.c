#include "live/microhttpd.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

#define LIBRARY "libmicrohttpd.so.12"

CagMicrohttpd cag_microhttpd;

// POSIX lets a pointer to an object hold that of a function, which C alone does not.
static bool find_function(void *library, const char *name, void *to, char *why, size_t size) {
  void *found = dlsym(library, name);
  memcpy(to, &found, sizeof found);
  if (!found) snprintf(why, size, "%s has no function %s", LIBRARY, name);
  return found != NULL;
}

bool cag_microhttpd_load(char *why, size_t size) {
  static bool loaded;
  if (loaded) return true;
  void *library = dlopen(LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    snprintf(why, size, "the server needs %s (Debian package libmicrohttpd12)", LIBRARY);
    return false;
  }
#define X(name)                                                                                    \
  if (!find_function(library, "MHD_" #name, &cag_microhttpd.name, why, size)) return false;
  CAG_MICROHTTPD_FUNCTIONS(X)
#undef X
  return loaded = true;
}
