#include "interp/formats/system_fonts.h"

#include <fontconfig/fontconfig.h>
#include <pthread.h>
#include <string.h>

#include "base/array.h"
#include "base/library.h"
#include "base/memory.h"
#include "base/sort.h"

#define FONTCONFIG_FUNCTIONS(X)                                                                    \
  X(FontList)                                                                                      \
  X(FontSetDestroy)                                                                                \
  X(Init)                                                                                          \
  X(ObjectSetAdd)                                                                                  \
  X(ObjectSetCreate)                                                                               \
  X(ObjectSetDestroy)                                                                              \
  X(PatternAddBool)                                                                                \
  X(PatternCreate)                                                                                 \
  X(PatternDestroy)                                                                                \
  X(PatternGetDouble)                                                                              \
  X(PatternGetInteger)                                                                             \
  X(PatternGetString)

const char *const cag_system_fonts_owner = "this system";

// An index has the number of a named instance of a variable font in these bits.
#define INSTANCE_BITS 16

static struct {
#define X(name) __typeof__(Fc##name) *name;
  FONTCONFIG_FUNCTIONS(X)
#undef X
} fc;

static pthread_once_t once = PTHREAD_ONCE_INIT;
static char missing[200]; // what cannot be loaded; empty: it is loaded

// Available only in builds with AddressSanitizer.
__attribute__((weak)) void __lsan_disable(void);
__attribute__((weak)) void __lsan_enable(void);

// Reads the configuration, which lasts until the program ends. LeakSanitizer does not see the
// pointers that fontconfig keeps to it, because they are offsets.
static void read_configuration(void) {
  if (__lsan_disable) __lsan_disable();
  fc.Init();
  if (__lsan_enable) __lsan_enable();
}

static void load(void) {
  static const CagLibraryFunction functions[] = {
#define X(name) {"Fc" #name, &fc.name},
      FONTCONFIG_FUNCTIONS(X)
#undef X
  };
  if (cag_library_load("libfontconfig.so.1", "libfontconfig1", functions,
                       sizeof functions / sizeof *functions, missing, sizeof missing))
    read_configuration();
}

// --- One face ---

static const char *text_of(const FcPattern *p, const char *object, int n) {
  FcChar8 *text = NULL;
  return fc.PatternGetString(p, object, n, &text) == FcResultMatch ? (const char *)text : NULL;
}

// Returns `otherwise` for a variable font, whose numbers are ranges.
static double number_of(const FcPattern *p, const char *object, double otherwise) {
  double x;
  return fc.PatternGetDouble(p, object, 0, &x) == FcResultMatch ? x : otherwise;
}

// Returns whether the face has one of the styles.
static bool find_style(const FcPattern *p, CagFontStyle *out) {
  const double weight = number_of(p, FC_WEIGHT, FC_WEIGHT_REGULAR),
               width = number_of(p, FC_WIDTH, FC_WIDTH_NORMAL),
               slant = number_of(p, FC_SLANT, FC_SLANT_ROMAN);
  const bool bold = weight >= FC_WEIGHT_DEMIBOLD && weight <= FC_WEIGHT_BOLD,
             regular = weight >= FC_WEIGHT_BOOK && weight <= FC_WEIGHT_MEDIUM;
  const bool italic = slant != FC_SLANT_ROMAN;
  *out = bold ? (italic ? CAG_FONT_BOLD_ITALIC : CAG_FONT_BOLD)
              : (italic ? CAG_FONT_ITALIC : CAG_FONT_REGULAR);
  return (bold || regular) && width == FC_WIDTH_NORMAL;
}

static bool is_outline_font(const FcPattern *p) {
  const char *format = text_of(p, FC_FONTFORMAT, 0);
  return format && (strcmp(format, "TrueType") == 0 || strcmp(format, "CFF") == 0);
}

static bool add_face(CagSystemFonts *fonts, const FcPattern *p) {
  const char *family = text_of(p, FC_FAMILY, 0), *full = text_of(p, FC_FULLNAME, 0),
             *file = text_of(p, FC_FILE, 0);
  int index = 0;
  CagSystemFont face = {.name = NULL};
  fc.PatternGetInteger(p, FC_INDEX, 0, &index);
  if (!family || !file || index >> INSTANCE_BITS || !is_outline_font(p)) return true;
  if (!find_style(p, &face.style)) {
    face.style = CAG_FONT_REGULAR;
    if (full) family = full;
  }
  face.index = (unsigned)index;
  face.name = cag_strdup(family);
  face.file = cag_strdup(file);
  if (face.name && face.file && CAG_RESERVE(fonts->items, fonts->capacity, fonts->count + 1)) {
    fonts->items[fonts->count++] = face;
    return true;
  }
  cag_free(face.name);
  cag_free(face.file);
  return false;
}

// --- All ---

static int by_name(const void *a, const void *b) {
  const CagSystemFont *p = a, *q = b;
  const int names = strcmp(p->name, q->name), files = strcmp(p->file, q->file);
  if (names) return names;
  if (p->style != q->style) return p->style > q->style ? 1 : -1;
  return files ? files : (p->index > q->index) - (p->index < q->index);
}

static FcFontSet *list_faces(void) {
  FcPattern *all = fc.PatternCreate();
  FcObjectSet *wanted = fc.ObjectSetCreate();
  static const char *const objects[] = {FC_FAMILY, FC_FULLNAME, FC_FILE,  FC_INDEX,
                                        FC_WEIGHT, FC_WIDTH,    FC_SLANT, FC_FONTFORMAT};
  for (size_t i = 0; i < sizeof objects / sizeof *objects; i++) fc.ObjectSetAdd(wanted, objects[i]);
  fc.PatternAddBool(all, FC_SCALABLE, FcTrue);
  FcFontSet *found = fc.FontList(NULL, all, wanted);
  fc.ObjectSetDestroy(wanted);
  fc.PatternDestroy(all);
  return found;
}

CagStatus cag_system_fonts(CagSystemFonts *out, CagError *err) {
  *out = (CagSystemFonts){.items = NULL};
  pthread_once(&once, load);
  if (*missing)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_library_missing, NULL, -1,
                    "finding fonts needs %s", missing);
  FcFontSet *found = list_faces();
  if (!found) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < found->nfont; i++)
    if (!add_face(out, found->fonts[i])) status = cag_fail_memory(err);
  fc.FontSetDestroy(found);
  if (!status) status = cag_sort(out->items, out->count, sizeof *out->items, by_name, err);
  if (status) cag_system_fonts_free(out);
  return status;
}

void cag_system_fonts_free(CagSystemFonts *fonts) {
  for (size_t i = 0; i < fonts->count; i++) {
    cag_free(fonts->items[i].name);
    cag_free(fonts->items[i].file);
  }
  cag_free(fonts->items);
  *fonts = (CagSystemFonts){.items = NULL};
}
