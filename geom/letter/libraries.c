#include "geom/letter/libraries.h"

#include <pthread.h>

#include "base/library.h"

CagHarfbuzz cag_hb;
CagFribidi cag_fribidi;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static char missing[200]; // what cannot be loaded; empty: both are loaded

static void load(void) {
  static const CagLibraryFunction harfbuzz[] = {
#define X(name) {"hb_" #name, &cag_hb.name},
      CAG_HARFBUZZ_FUNCTIONS(X)
#undef X
  };
  static const CagLibraryFunction fribidi[] = {
#define X(name) {"fribidi_" #name, &cag_fribidi.name},
      CAG_FRIBIDI_FUNCTIONS(X)
#undef X
  };
  if (cag_library_load("libharfbuzz.so.0", "libharfbuzz0b", harfbuzz,
                       sizeof harfbuzz / sizeof *harfbuzz, missing, sizeof missing))
    cag_library_load("libfribidi.so.0", "libfribidi0", fribidi, sizeof fribidi / sizeof *fribidi,
                     missing, sizeof missing);
}

CagStatus cag_letter_libraries(CagError *err) {
  pthread_once(&once, load);
  if (!*missing) return CAG_OK;
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_library_missing, NULL, -1,
                  "setting a text needs %s", missing);
}
