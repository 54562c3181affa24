// Replaces geom/letter/compiled.c in a browser. Few scripts need the fonts, so each is read from the
// server when it is first needed, and kept.

#include <emscripten.h>
#include <stdio.h>

#include "geom/letter/font.h"

// Returns bytes of malloc, or NULL.
EM_JS(unsigned char *, host_font, (const char *name, size_t *size), {
  const bytes = Module["host"].font(UTF8ToString(name));
  const copy = bytes ? _malloc(bytes.length) : 0;
  if (copy) HEAPU8.set(bytes, copy);
  if (copy) HEAPU32[size >> 2] = bytes.length;
  return copy;
})

static const char *const names[CAG_FONT_STYLE_COUNT] = {[CAG_FONT_REGULAR] = "Sans-Regular.ttf",
                                                        [CAG_FONT_BOLD] = "Sans-Bold.ttf",
                                                        [CAG_FONT_ITALIC] = "Sans-Italic.ttf",
                                                        [CAG_FONT_BOLD_ITALIC] =
                                                            "Sans-BoldItalic.ttf"};

static CagStatus fail_unreachable(const char *name, CagError *err) {
  (cag_fail)(err, CAG_E_ARGUMENT, CAG_ERR_font_unreadable, "font", -1,
             "the font \"%s\" cannot be used: the server does not send fonts/%s", CAG_FONT_SANS,
             name);
  snprintf(err->help, sizeof err->help,
           "run the script again when the server of the playground can be reached");
  return cag_never_ok(err->status);
}

CagStatus cag_font_compiled_file(CagFontStyle style, CagFontFile *out, CagError *err) {
  static CagFontFile files[CAG_FONT_STYLE_COUNT];
  CagFontFile *f = &files[style];
  if (!f->bytes) f->bytes = host_font(names[style], &f->size);
  *out = *f;
  return f->bytes ? CAG_OK : fail_unreachable(names[style], err);
}
