#include "live/microhttpd.h"

#include <stdio.h>

#include "base/library.h"

CagMicrohttpd cag_microhttpd;

bool cag_microhttpd_load(char *why, size_t size) {
  static const CagLibraryFunction functions[] = {
#define X(name) {"MHD_" #name, &cag_microhttpd.name},
      CAG_MICROHTTPD_FUNCTIONS(X)
#undef X
  };
  static bool loaded;
  char missing[200];
  if (!loaded)
    loaded = cag_library_load("libmicrohttpd.so.12", "libmicrohttpd12", functions,
                              sizeof functions / sizeof *functions, missing, sizeof missing);
  if (!loaded) snprintf(why, size, "the server needs %s", missing);
  return loaded;
}
