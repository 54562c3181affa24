// Checks the file names in a scene before POV-Ray reads it.
//
// In POV-Ray's language, file names follow #include and #fopen, and the words for pictures, height
// fields, densities, and fonts. Each name must be a string literal, because computed names cannot
// be checked. Our own scenes contain none.

#include <ctype.h>
#include <string.h>

#include "interp/render/povray.h"

// Words that are followed by a file name.
static const char *const FILE_WORDS[] = {
    "bump_map",  "df3",           "exr",  "gif",          "hdr", "height_field", "iff",
    "image_map", "image_pattern", "jpeg", "material_map", "pgm", "png",          "pot",
    "ppm",       "sys",           "tga",  "tiff",         "ttf"};
// Of these, the ones that are followed by `{` and an optional file type before the name.
static const char *const BLOCK_WORDS[] = {"bump_map", "height_field", "image_map", "image_pattern",
                                          "material_map"};
// Functions that return texts.
static const char *const TEXT_FUNCTIONS[] = {"chr",    "concat", "datetime", "str",
                                             "strlwr", "strupr", "substr",   "vstr"};

typedef enum { TOKEN_END, TOKEN_WORD, TOKEN_TEXT, TOKEN_OTHER } TokenKind;

typedef struct {
  const char *at, *end;
  size_t line;
  TokenKind kind;
  const char *start; // of the token; of a text: after its quote
  size_t length;
} Scan;

static bool is_word(char c) { return isalnum((unsigned char)c) || c == '_'; }

// Skips a comment that starts at s->at. Block comments nest.
static void skip_comment(Scan *s, bool block) {
  size_t depth = 1;
  for (s->at += 2; s->at < s->end; s->at++) {
    if (!block && *s->at == '\n') return;
    if (*s->at == '\n') s->line++;
    if (!block || s->end - s->at < 2) continue;
    if (s->at[0] == '/' && s->at[1] == '*') depth++, s->at++;
    else if (s->at[0] == '*' && s->at[1] == '/' && (s->at++, --depth == 0)) {
      s->at++;
      return;
    }
  }
}

static void skip_blank(Scan *s) {
  while (s->at < s->end) {
    const bool more = s->end - s->at > 1 && *s->at == '/';
    if (more && (s->at[1] == '/' || s->at[1] == '*')) {
      skip_comment(s, s->at[1] == '*');
    } else if (isspace((unsigned char)*s->at)) {
      s->line += *s->at++ == '\n';
    } else {
      return;
    }
  }
}

static void next(Scan *s) {
  skip_blank(s);
  s->start = s->at;
  s->length = 0;
  s->kind = TOKEN_END;
  if (s->at == s->end) return;
  if (*s->at == '"') {
    s->kind = TOKEN_TEXT;
    s->start = ++s->at;
    while (s->at < s->end && *s->at != '"') {
      if (*s->at == '\\' && s->end - s->at > 1) s->at++;
      s->line += *s->at++ == '\n';
    }
    s->length = (size_t)(s->at - s->start);
    if (s->at < s->end) s->at++;
    return;
  }
  if (is_word(*s->at)) {
    s->kind = TOKEN_WORD;
    while (s->at < s->end && is_word(*s->at)) s->at++;
  } else {
    s->kind = TOKEN_OTHER;
    s->at++;
  }
  s->length = (size_t)(s->at - s->start);
}

static bool is(const Scan *s, const char *word) {
  return s->length == strlen(word) && !memcmp(s->start, word, s->length);
}

static bool is_one_of(const Scan *s, const char *const *words, size_t count) {
  // Most words of a scene with meshes are numbers.
  if (s->kind != TOKEN_WORD || !isalpha((unsigned char)*s->start)) return false;
  for (size_t i = 0; i < count; i++)
    if (is(s, words[i])) return true;
  return false;
}
#define IS_ONE_OF(s, words) is_one_of(s, words, sizeof(words) / sizeof *(words))

// Tests whether a name stays in the folder: it must be relative, without `..`, and without escape
// sequences, which could hide them.
static bool stays_inside(const Scan *s) {
  if (!s->length || *s->start == '/' || *s->start == '~') return false;
  if (memchr(s->start, '\\', s->length) || memchr(s->start, '\0', s->length)) return false;
  for (size_t i = 0; i + 1 < s->length; i++) {
    if (s->start[i] != '.' || s->start[i + 1] != '.') continue;
    const bool begins = i == 0 || s->start[i - 1] == '/';
    const bool ends = i + 2 == s->length || s->start[i + 2] == '/';
    if (begins && ends) return false;
  }
  return true;
}

static bool check_name(const Scan *s, CagError *err) {
  if (stays_inside(s)) return true;
  return cag_fail_io(err, CAG_E_RENDERER, "name files by their plain name in the scene's folder",
                     "line %zu of the POV-Ray scene names the file '%.*s', which is outside the "
                     "scene's folder",
                     s->line, (int)(s->length < 120 ? s->length : 120), s->start);
}

static bool refuse_computed(const Scan *s, CagError *err) {
  return cag_fail_io(err, CAG_E_RENDERER, "write the file's name as a text in quotes",
                     "line %zu of the POV-Ray scene computes the name of a file, which cannot be "
                     "checked",
                     s->line);
}

// After #include, or after #fopen and its identifier, only a text is allowed.
static bool check_directive(Scan *s, CagError *err) {
  if (is(s, "fopen")) next(s);
  next(s);
  return s->kind == TOKEN_TEXT ? check_name(s, err) : refuse_computed(s, err);
}

// Checks the name after a word for a kind of file. It may be in braces, and a file type may precede
// it.
static bool check_word(Scan *s, CagError *err) {
  const bool block = IS_ONE_OF(s, BLOCK_WORDS);
  Scan ahead = *s;
  next(&ahead);
  if (block && ahead.kind == TOKEN_OTHER && *ahead.start == '{') next(&ahead);
  if (ahead.kind == TOKEN_TEXT) return check_name(&ahead, err);
  if (IS_ONE_OF(&ahead, TEXT_FUNCTIONS)) return refuse_computed(&ahead, err);
  // `ttf internal 1` contains no file name. After a file type, an identifier could hold a name.
  if (!block && ahead.kind == TOKEN_WORD && !is(&ahead, "internal"))
    return refuse_computed(&ahead, err);
  return true;
}

bool cag_povray_check_files(const char *scene, size_t size, CagError *err) {
  Scan s = {.at = scene, .end = scene + size, .line = 1};
  bool directive = false, ok = true;
  for (next(&s); ok && s.kind != TOKEN_END; next(&s)) {
    if (directive && (is(&s, "include") || is(&s, "fopen"))) ok = check_directive(&s, err);
    else if (!directive && IS_ONE_OF(&s, FILE_WORDS)) ok = check_word(&s, err);
    directive = s.kind == TOKEN_OTHER && *s.start == '#';
  }
  return ok;
}
