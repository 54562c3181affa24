// Glyphs and their places, compared with the programs hb-shape and fribidi
// (tests/data/lettering/shapes.txt), and the breaking of lines.

#include "tests/geom/support.h"

#include <pthread.h>
#include <stdio.h>
#include <utf8proc.h>

#include "geom/letter/shape.h"

#define SHAPES "tests/data/lettering/shapes.txt"

// --- A line of the table ---

typedef struct Expected {
  char font[100], direction[8];
  char text[400];
  struct {
    uint32_t glyph;
    double x, y;
  } glyphs[100];
  size_t count;
  double advance;
} Expected;

static char *field(char **rest) {
  char *start = *rest, *end = strstr(start, " | ");
  *rest = end ? end + 3 : start + strlen(start);
  if (end) *end = 0;
  return start;
}

static void read_line(char *line, Expected *out) {
  *out = (Expected){.count = 0};
  snprintf(out->font, sizeof out->font, "%s", field(&line));
  snprintf(out->direction, sizeof out->direction, "%s", field(&line));
  unsigned c;
  int used;
  size_t n = 0;
  for (char *p = field(&line); sscanf(p, "%x%n", &c, &used) == 1; p += used)
    n += (size_t)utf8proc_encode_char((utf8proc_int32_t)c, (utf8proc_uint8_t *)out->text + n);
  uint32_t glyph;
  double x, y;
  for (char *p = field(&line); sscanf(p, "%u %lf %lf%n", &glyph, &x, &y, &used) == 3; p += used) {
    out->glyphs[out->count].glyph = glyph;
    out->glyphs[out->count].x = x;
    out->glyphs[out->count++].y = y;
  }
  out->advance = strtod(line, NULL);
}

static CagLetterDirection direction_of(const char *name) {
  return strcmp(name, "ltr") == 0   ? CAG_LETTER_LTR
         : strcmp(name, "rtl") == 0 ? CAG_LETTER_RTL
         : strcmp(name, "ttb") == 0 ? CAG_LETTER_TTB
                                    : CAG_LETTER_AUTO;
}

// --- Fonts ---

typedef struct LoadedFont {
  char path[100];
  char *bytes;
  CagFont font;
} LoadedFont;

static char *read_file(const char *path, size_t *size) {
  FILE *f = fopen(path, "rb");
  if (!f) return NULL;
  fseek(f, 0, SEEK_END);
  *size = (size_t)ftell(f);
  rewind(f);
  char *bytes = malloc(*size);
  assert_int_equal(fread(bytes, 1, *size, f), *size);
  fclose(f);
  return bytes;
}

// Returns whether the file exists.
static bool load(LoadedFont *out, const char *path) {
  size_t size;
  snprintf(out->path, sizeof out->path, "%s", path);
  out->bytes = read_file(path, &size);
  if (!out->bytes) return false;
  OK(cag_font_new(path, out->bytes, size, 0, &out->font, &err));
  return true;
}

static void unload(LoadedFont *f) {
  if (f->bytes) cag_font_free(&f->font);
  free(f->bytes);
  *f = (LoadedFont){.bytes = NULL};
}

// --- Comparison ---

static void check_line(const CagFont *font, const Expected *e) {
  CagLetters l;
  const CagLetterRules rules = {direction_of(e->direction), 1, 0, false};
  if (cag_letters_shape(font, e->text, strlen(e->text), &rules, &l, &err))
    fail_msg("\"%s\" in %s: %s", e->text, e->font, err.message);
  assert_int_equal(l.line_count, 1);
  bool same = l.count == e->count && fabs(l.lines[0].advance) == fabs(e->advance);
  for (size_t i = 0; same && i < l.count; i++)
    same = l.items[i].glyph == e->glyphs[i].glyph && l.items[i].x == e->glyphs[i].x &&
           l.items[i].y == e->glyphs[i].y;
  if (!same) {
    for (size_t i = 0; i < l.count; i++)
      print_error("%u %g %g\n", l.items[i].glyph, l.items[i].x, l.items[i].y);
    fail_msg("\"%s\" in %s, %s: the glyphs differ, or the advance %g", e->text, e->font,
             e->direction, l.lines[0].advance);
  }
  cag_letters_free(&l);
}

// Checks the lines whose font is in the folder. Returns how many there are.
static size_t check_fonts(const char *folder) {
  static char line[4096];
  FILE *f = fopen(SHAPES, "r");
  assert_non_null(f);
  LoadedFont font = {.bytes = NULL};
  size_t n = 0;
  while (fgets(line, sizeof line, f)) {
    static Expected e;
    read_line(line, &e);
    if (strncmp(e.font, folder, strlen(folder)) != 0) continue;
    if (strcmp(font.path, e.font) != 0) {
      unload(&font);
      if (!load(&font, e.font)) {
        fclose(f);
        print_message("skipped: %s is missing\n", e.font);
        skip();
      }
    }
    check_line(&font.font, &e);
    n++;
  }
  unload(&font);
  fclose(f);
  return n;
}

static void compiled_in_fonts_are_shaped_like_hb_shape_does(void **state) {
  (void)state;
  assert_true(check_fonts("fonts/") > 90);
}

static void ligatures_and_arabic_are_shaped_like_hb_shape_does(void **state) {
  (void)state;
  assert_true(check_fonts("/usr/share/fonts/truetype/dejavu/") > 20);
}

static void cubic_fonts_are_shaped_like_hb_shape_does(void **state) {
  (void)state;
  assert_true(check_fonts("/usr/share/fonts/opentype/urw-base35/") > 3);
}

// --- Files and threads ---

static double advance_of(const CagFont *font, const char *text) {
  CagLetters l;
  CagError problem;
  const CagLetterRules rules = {CAG_LETTER_AUTO, 1, 0, false};
  if (cag_letters_shape(font, text, strlen(text), &rules, &l, &problem)) return -1;
  const double advance = l.lines[0].advance;
  cag_letters_free(&l);
  return advance;
}

// The second face has a wider A (tests/language/geometry/fonts/make.py).
static void collections_have_faces_by_index(void **state) {
  (void)state;
  size_t size = 0;
  CagFont font;
  char *bytes = read_file("tests/language/geometry/fonts/Squares.ttc", &size);
  assert_non_null(bytes);
  for (unsigned i = 0; i < 2; i++) {
    OK(cag_font_new("Squares", bytes, size, i, &font, &err));
    assert_true(advance_of(&font, "A") == (i ? 1100 : 700));
    cag_font_free(&font);
  }
  FAILS(cag_font_new("Squares", bytes, size, 2, &font, &err), "font-unreadable");
  free(bytes);
}

enum { THREADS = 4, REPEATS = 50 };

static void *shape_repeatedly(void *out) {
  double sum = 0;
  for (int i = 0; i < REPEATS; i++) {
    CagFont font;
    CagError problem;
    if (cag_font_compiled_in((CagFontStyle)(i % CAG_FONT_STYLE_COUNT), &font, &problem))
      return NULL;
    sum += advance_of(&font, "AVA \u05d0\u05d1 12 e\u0301");
    cag_font_free(&font);
  }
  *(double *)out = sum;
  return out;
}

static void threads_do_not_affect_each_other(void **state) {
  (void)state;
  pthread_t threads[THREADS];
  double sums[THREADS] = {0}, expected = 0;
  for (int i = 0; i < THREADS; i++)
    assert_int_equal(pthread_create(&threads[i], NULL, shape_repeatedly, &sums[i]), 0);
  for (int i = 0; i < THREADS; i++) pthread_join(threads[i], NULL);
  assert_non_null(shape_repeatedly(&expected));
  assert_true(expected > 0);
  for (int i = 0; i < THREADS; i++) assert_true(sums[i] == expected);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threads_do_not_affect_each_other),
      cmocka_unit_test(collections_have_faces_by_index),
      cmocka_unit_test(compiled_in_fonts_are_shaped_like_hb_shape_does),
      cmocka_unit_test(ligatures_and_arabic_are_shaped_like_hb_shape_does),
      cmocka_unit_test(cubic_fonts_are_shaped_like_hb_shape_does),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
