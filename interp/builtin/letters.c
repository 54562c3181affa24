// Texts as regions, their sizes, and the fonts for them.

#include "interp/builtin/letters.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/diagnostic.h"
#include "base/memory.h"
#include "geom/letter/lettering.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/regions.h"
#include "interp/builtin/support.h"
#include "interp/formats/system_fonts.h"
#include "interp/vm/vm.h"

// --- Fonts ---

static void release_font(void *font) { cag_font_free(font); }
static void release_fonts(void *fonts) { cag_system_fonts_free(fonts); }

static bool is_path(const char *name) {
  static const char *const ends[] = {".ttf", ".otf", ".ttc", ".otc"};
  const size_t n = strlen(name);
  for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
    if (n >= strlen(ends[i]) && strcasecmp(name + n - strlen(ends[i]), ends[i]) == 0) return true;
  return strchr(name, '/') != NULL;
}

// The fonts of the system, held.
static bool hold_system_fonts(CagCall *call, CagSystemFonts **out) {
  CagSystemFonts *fonts = cag_hold_array(call, 1, sizeof *fonts);
  if (!cag_geometry_ok(call, cag_system_fonts(fonts, call->err))) return false;
  cag_hold_for(call, release_fonts, fonts);
  *out = fonts;
  return true;
}

// "\"regular\", \"bold\"": the styles of the fonts with this name; empty if there is none.
static void list_styles(const CagSystemFonts *fonts, const char *name, char *out, size_t size) {
  *out = 0;
  for (size_t i = 0; i < fonts->count; i++) {
    const CagSystemFont *f = &fonts->items[i];
    const size_t n = strlen(out);
    const bool again = i > 0 && strcmp(f[-1].name, name) == 0 && f[-1].style == f->style;
    if (strcmp(f->name, name) == 0 && !again)
      snprintf(out + n, size - n, "%s\"%s\"", n ? ", " : "", cag_font_styles[f->style]);
  }
}

static bool fail_missing(CagCall *call, int argument, const char *name, CagFontStyle style,
                         const CagSystemFonts *fonts) {
  char styles[80];
  list_styles(fonts, name, styles, sizeof styles);
  if (*styles) {
    cag_fail_call(call, argument, CAG_ERR_font_missing,
                  "found no style \"%s\" of the font \"%s\", which has %s", cag_font_styles[style],
                  name, styles);
    return cag_fail_help(call->vm, "choose one of its styles, or another font");
  }
  const char **names = cag_hold_array(call, fonts->count + 1, sizeof *names);
  names[0] = CAG_FONT_SANS;
  for (size_t i = 0; i < fonts->count; i++) names[i + 1] = fonts->items[i].name;
  const char *nearest = cag_nearest_name(name, names, fonts->count + 1);
  cag_fail_call(call, argument, CAG_ERR_font_missing, "found no font with the name \"%s\"", name);
  if (nearest) return cag_fail_help(call->vm, "did you mean \"%s\"?", nearest);
  if (fonts->count == 0)
    return cag_fail_help(call->vm, "use \"%s\", the only font of %s", CAG_FONT_SANS,
                         cag_system_fonts_owner);
  return cag_fail_help(call->vm, "\"%s\" is compiled in, and fonts() lists the others",
                       CAG_FONT_SANS);
}

static bool use_file(CagCall *call, int argument, const char *name, CagFontStyle style,
                     CagFont *out) {
  char *bytes;
  size_t n;
  if (style != CAG_FONT_REGULAR) {
    cag_fail_call(call, argument, CAG_ERR_value, "found a style with the font file \"%s\"", name);
    return cag_fail_help(call->vm, "a file has one style: name the file with the style \"%s\"",
                         cag_font_styles[style]);
  }
  if (!cag_vm_open_file(call, argument, name, &bytes, &n)) return false;
  cag_hold(call, bytes);
  return cag_geometry_ok(call, cag_font_new(name, bytes, n, 0, out, call->err));
}

static bool use_system_font(CagCall *call, int argument, const char *name, CagFontStyle style,
                            CagFont *out) {
  CagSystemFonts *fonts;
  if (!hold_system_fonts(call, &fonts)) return false;
  for (size_t i = 0; i < fonts->count; i++) {
    const CagSystemFont *f = &fonts->items[i];
    if (f->style != style || strcmp(f->name, name) != 0) continue;
    size_t n;
    const char *why;
    char *bytes = cag_read_whole_file(f->file, &n, &why);
    if (!bytes)
      return cag_fail_call(call, argument, CAG_ERR_font_unreadable, "cannot read %s: %s", f->file,
                           why);
    cag_hold(call, bytes);
    return cag_geometry_ok(call, cag_font_new(name, bytes, n, f->index, out, call->err));
  }
  return fail_missing(call, argument, name, style, fonts);
}

bool cag_letters_font(CagCall *call, int argument, const char *name, CagFontStyle style,
                      CagFont **out) {
  CagFont *font = cag_hold_array(call, 1, sizeof *font);
  bool ok;
  if (strcmp(name, CAG_FONT_SANS) == 0)
    ok = cag_geometry_ok(call, cag_font_compiled_in(style, font, call->err));
  else if (is_path(name)) ok = use_file(call, argument, name, style, font);
  else ok = use_system_font(call, argument, name, style, font);
  if (ok) cag_hold_for(call, release_font, font);
  *out = font;
  return ok;
}

// --- Texts ---

enum { FONT_ARGUMENT = 2, DIRECTION_ARGUMENT = 8, ALONG_ARGUMENT = 10 };

static bool read_font(CagCall *call, const char *name, int style, CagLettering *how) {
  CagFont *font;
  if (!cag_letters_font(call, FONT_ARGUMENT, cag_given(call, FONT_ARGUMENT) ? name : CAG_FONT_SANS,
                        (CagFontStyle)style, &font))
    return false;
  how->font = font;
  return true;
}

static CagLetterDirection direction_of(const CagCall *call, int given) {
  return cag_given(call, DIRECTION_ARGUMENT) ? (CagLetterDirection)given : CAG_LETTER_AUTO;
}

// The layout that the arguments of both built-ins state.
#define LAYOUT_OF(call, a)                                                                         \
  ((CagLettering){.size = (a)->size,                                                               \
                  .align = (CagLetterAlign)(a)->align,                                             \
                  .valign = (CagLetterValign)(a)->valign,                                          \
                  .spacing = (a)->spacing,                                                         \
                  .line_spacing = (a)->line_spacing,                                               \
                  .direction = direction_of(call, (a)->direction),                                 \
                  .width = (a)->width})

// The plane curve of an argument, held, and its plane.
static bool read_along(CagCall *call, CagCurve *given, CagLettering *how, CagTransform *frame,
                       bool *in_space) {
  CagCurve **along = cag_hold_curve_array(call, 1);
  along[0] = cag_curve_retain(given);
  if (!cag_region_loops_plane(call, along, 1, frame, in_space)) return false;
  how->along = along[0];
  if (how->direction != CAG_LETTER_TTB) return true;
  cag_fail_call(call, DIRECTION_ARGUMENT, CAG_ERR_value, "found \"ttb\" with `along`");
  return cag_fail_help(call->vm, "along a curve, a text runs to the right or to the left");
}

bool cag_letters_lettering(CagCall *call, const struct cag_letters_lettering *a, CagValue *result) {
  CagTransform frame;
  bool in_space = false;
  CagRegion *out = NULL;
  CagLettering how = LAYOUT_OF(call, a);
  if (!read_font(call, a->font, a->style, &how)) return false;
  if (cag_given(call, ALONG_ARGUMENT) && !read_along(call, a->along, &how, &frame, &in_space))
    return false;
  CagStatus status = cag_lettering(a->text, strlen(a->text), &how, &out, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_region_value(call->vm, out, in_space ? &frame : NULL);
  return true;
}

bool cag_letters_metrics(CagCall *call, const struct cag_letters_metrics *a, CagValue *result) {
  CagLetteringMetrics m;
  CagLettering how = LAYOUT_OF(call, a);
  if (!read_font(call, a->font, a->style, &how)) return false;
  CagStatus status = cag_lettering_measure(a->text, strlen(a->text), &how, &m, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  const bool ink = m.box.min.x <= m.box.max.x;
  const char *const names[] = {"width", "height", "ascent", "descent", "advance", "lines"};
  const CagValue values[] = {cag_number(ink ? m.box.max.x - m.box.min.x : 0),
                             cag_number(ink ? m.box.max.y - m.box.min.y : 0),
                             cag_number(m.ascent),
                             cag_number(m.descent),
                             cag_number(m.advance),
                             cag_number((double)m.lines)};
  *result = cag_record_new(call->vm, names, values, sizeof values / sizeof *values);
  return true;
}

// --- The list ---

static CagValue font_record(CagVm *vm, const char *name, CagFontStyle style, const char *file) {
  const char *const names[] = {"name", "style", "file"};
  const char *const texts[] = {name, cag_font_styles[style], file};
  CagValue values[3];
  for (int i = 0; i < 3; i++)
    values[i] = texts[i] ? cag_text_new(vm, texts[i], strlen(texts[i])) : cag_none();
  return cag_record_new(vm, names, values, 3);
}

bool cag_letters_fonts(CagCall *call, CagValue *result) {
  CagSystemFonts *fonts;
  if (!hold_system_fonts(call, &fonts)) return false;
  CagVm *vm = call->vm;
  CagBuilder *b = cag_builder_new(vm);
  for (int i = 0; i < CAG_FONT_STYLE_COUNT; i++)
    if (!cag_builder_add(vm, b, font_record(vm, CAG_FONT_SANS, (CagFontStyle)i, NULL)))
      return false;
  for (size_t i = 0; i < fonts->count; i++) {
    const CagSystemFont *f = &fonts->items[i];
    if (!cag_builder_add(vm, b, font_record(vm, f->name, f->style, f->file))) return false;
  }
  *result = cag_builder_finish(vm, b);
  return true;
}
