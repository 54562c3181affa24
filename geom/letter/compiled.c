#include "geom/letter/font.h"

CagStatus cag_font_compiled_file(CagFontStyle style, CagFontFile *out, CagError *err) {
  (void)err;
  *out = cag_compiled_fonts[style];
  return CAG_OK;
}
