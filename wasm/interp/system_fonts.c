// Replaces interp/formats/system_fonts.c in a browser, which lets the program read no fonts.

#include "interp/formats/system_fonts.h"

const char *const cag_system_fonts_owner = "the playground";

CagStatus cag_system_fonts(CagSystemFonts *out, CagError *err) {
  (void)err;
  *out = (CagSystemFonts){.items = NULL};
  return CAG_OK;
}

void cag_system_fonts_free(CagSystemFonts *fonts) { *fonts = (CagSystemFonts){.items = NULL}; }
