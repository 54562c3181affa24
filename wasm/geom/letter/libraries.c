// Replaces geom/letter/libraries.c where the libraries are parts of the program.

#include "geom/letter/libraries.h"

CagHarfbuzz cag_hb = {
#define X(name) .name = hb_##name,
    CAG_HARFBUZZ_FUNCTIONS(X)
#undef X
};
CagFribidi cag_fribidi = {
#define X(name) .name = fribidi_##name,
    CAG_FRIBIDI_FUNCTIONS(X)
#undef X
};

CagStatus cag_letter_libraries(CagError *err) {
  (void)err;
  return CAG_OK;
}
