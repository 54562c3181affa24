#include "interp/session/expect_plan.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "interp/session/expect_near.h"

// The most samples of a picture, as on the command line.
enum { SAMPLES_MAX = 10000 };

// --- Making plans ---

// Makes room for one more. Returns NULL if memory ran out.
static void *grow(void **array, size_t *count, size_t size) {
  char *larger = cag_realloc(*array, (*count + 1) * size);
  if (!larger) return NULL;
  *array = larger;
  void *item = larger + size * (*count)++;
  memset(item, 0, size);
  return item;
}

void cag_test_free_plans(CagTestPlans *plans) {
  for (size_t i = 0; i < plans->count; i++) {
    CagTestPlan *p = &plans->items[i];
    for (size_t k = 0; k < p->define_count; k++) cag_free(p->defines[k].name);
    cag_free(p->defines);
    cag_free(p->expected);
    cag_free(p->options);
    cag_free((void *)(size_t)p->rendering.engine);
    cag_free((void *)(size_t)p->rendering.quality);
    cag_free((void *)(size_t)p->rendering.camera);
    cag_free(p->problem);
  }
  cag_free(plans->items);
  cag_free(plans->misses);
}

static CagTestPlan *add_plan(CagTestPlans *plans, const CagSessionOptions *limits, size_t line) {
  CagTestPlan *p = grow((void **)&plans->items, &plans->count, sizeof *p);
  if (!p) {
    plans->memory = true;
    return NULL;
  }
  p->limits = *limits;
  p->line = line;
  return p;
}

CagTestPiece cag_test_trim(CagTestPiece p) {
  while (p.start < p.end && isspace((unsigned char)*p.start)) p.start++;
  while (p.end > p.start && isspace((unsigned char)p.end[-1])) p.end--;
  return p;
}

// Copies the next word of a line of options to `out` (which is as long as the line), without its
// quotes. Returns its end, or NULL if there is none.
static const char *next_word(const char *at, char *out) {
  while (isspace((unsigned char)*at)) at++;
  if (!*at) return NULL;
  char quote = 0;
  for (; *at && (quote || !isspace((unsigned char)*at)); at++) {
    if (quote && *at == quote) quote = 0;
    else if (!quote && (*at == '"' || *at == '\'')) quote = *at;
    else *out++ = *at;
  }
  *out = 0;
  return at;
}

static bool add_define(CagTestPlan *p, const char *word) {
  const char *equals = strchr(word, '=');
  if (!equals || equals == word) return false;
  CagTestDefine *d = grow((void **)&p->defines, &p->define_count, sizeof *d);
  if (!d || !(d->name = cag_strdup(word))) {
    if (d) p->define_count--;
    return false;
  }
  d->name[equals - word] = 0;
  d->value = d->name + (equals - word) + 1;
  return true;
}

static bool set_limit(CagTestPlan *p, const char *name, const char *value) {
  char *end;
  double x = strtod(value, &end);
  if (end == value || *end || !(x > 0)) return false;
  if (!strcmp(name, "--max-depth")) p->limits.max_depth = (size_t)x;
  else if (!strcmp(name, "--max-memory")) p->limits.max_memory = (size_t)x;
  else if (!strcmp(name, "--max-triangles")) p->limits.max_triangles = (size_t)x;
  else if (!strcmp(name, "--max-time")) p->limits.max_time = x;
  else return false;
  return true;
}

static bool keep_word(const char **to, const char *word) {
  char *copy = cag_strdup(word);
  if (!copy) return false;
  cag_free((void *)(size_t)*to);
  *to = copy;
  return true;
}

// Sets an option of the picture. The renderer checks words.
static bool set_rendering(CagTestPlan *p, const char *name, const char *value) {
  CagRenderOptions *o = &p->rendering;
  if (!strcmp(name, "--engine")) return keep_word(&o->engine, value);
  if (!strcmp(name, "--quality")) return keep_word(&o->quality, value);
  if (!strcmp(name, "--camera")) return keep_word(&o->camera, value);
  if (strcmp(name, "--samples") != 0) return false;
  char *end;
  const long samples = strtol(value, &end, 10);
  o->samples = (int)samples;
  return end > value && !*end && samples >= 1 && samples <= SAMPLES_MAX;
}

static void set_problem(CagTestPlan *p, const char *format, const char *word, const char *value) {
  cag_free(p->problem);
  if (cag_asprintf(&p->problem, format, word, value) < 0) p->problem = NULL;
}

static bool is_value_option(const char *word) {
  static const char *const NAMES[] = {"-D",         "--engine",     "--quality",
                                      "--camera",   "--samples",    "--max-depth",
                                      "--max-time", "--max-memory", "--max-triangles"};
  for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
    if (!strcmp(NAMES[i], word)) return true;
  return false;
}

// Reads an option after its name. Returns where the next one starts, or NULL if it is wrong.
static const char *read_option(CagTestPlan *p, const char *name, const char *at, char *word) {
  static const char UNKNOWN[] =
      "`%s` is not an option of `// run:`; the options are -D name=value, --picture, --engine, --quality, --camera, --samples, --max-depth, --max-memory, --max-time, and --max-triangles";
  if (!strcmp(name, "--picture")) {
    p->picture = true;
    return at;
  }
  if (!strncmp(name, "-D", 2) && name[2]) {
    if (add_define(p, name + 2)) return at;
    set_problem(p, "expected -D name=value, found `%s`", name, NULL);
    return NULL;
  }
  if (!is_value_option(name)) {
    set_problem(p, UNKNOWN, name, NULL);
    return NULL;
  }
  const char *next = next_word(at, word);
  if (!next) set_problem(p, "`%s` needs a value", name, NULL);
  else if (!strcmp(name, "-D")) {
    if (add_define(p, word)) return next;
    set_problem(p, "expected -D name=value, found `-D %s`", word, NULL);
  } else {
    if (set_limit(p, name, word) || set_rendering(p, name, word)) return next;
    set_problem(p, "`%s` cannot be `%s`", name, word);
  }
  return NULL;
}

// Parses the options of `// run:` into the plan.
static void read_options(CagTestPlans *plans, CagTestPlan *p, CagTestPiece text) {
  p->options = cag_strndup(text.start, (size_t)(text.end - text.start));
  char *word = cag_malloc((size_t)(text.end - text.start) + 1);
  const char *at = p->options;
  if (!at || !word) plans->memory = true;
  while (at && word && (at = next_word(at, word))) {
    char *name = cag_strdup(word);
    if (name) at = read_option(p, name, at, word);
    else plans->memory = true;
    cag_free(name);
    if (!name) break;
  }
  cag_free(word);
}

// --- Reading the script ---

typedef struct Reader {
  const char *start, *end; // of the script
  size_t line;             // of the current byte
  const char *line_start;
  const CagSessionOptions *limits;
  CagTestPlans *plans;
} Reader;

static bool begins_with(CagTestPiece p, const char *word, CagTestPiece *rest) {
  size_t n = strlen(word);
  if ((size_t)(p.end - p.start) < n || memcmp(p.start, word, n) != 0) return false;
  *rest = cag_test_trim((CagTestPiece){p.start + n, p.end});
  return true;
}

// The rest of a text that begins with a word, with its blanks.
static CagTestPiece after(CagTestPiece p, const char *word) {
  return (CagTestPiece){p.start + strlen(word), p.end};
}

static void add_expected(Reader *r, CagTestPiece text, bool is_error, bool alone) {
  if (r->plans->count == 0 && !add_plan(r->plans, r->limits, 0)) return;
  CagTestPlan *p = &r->plans->items[r->plans->count - 1];
  CagTestExpected *e = grow((void **)&p->expected, &p->count, sizeof *e);
  if (e)
    *e = (CagTestExpected){.text = text, .line = r->line, .is_error = is_error, .alone = alone};
  else r->plans->memory = true;
}

// Parses `E0201, E0203`: several errors of one line.
static void add_errors(Reader *r, CagTestPiece text, bool alone) {
  const char *at = text.start;
  while (at < text.end) {
    const char *from = at;
    while (at < text.end && isalnum((unsigned char)*at)) at++;
    if (at > from) add_expected(r, (CagTestPiece){from, at}, true, alone);
    else at++;
  }
}

// Parses `: depth.exr` or ` depth: depth.exr`, after `expect image`. False: it is something else.
static bool add_image(Reader *r, CagTestPiece text, bool alone) {
  const char *colon =
      text.start < text.end ? memchr(text.start, ':', (size_t)(text.end - text.start)) : NULL;
  if (!colon || (*text.start != ':' && !isspace((unsigned char)*text.start))) return false;
  add_expected(r, cag_test_trim((CagTestPiece){colon + 1, text.end}), false, alone);
  const CagTestPlan *p = r->plans->count ? &r->plans->items[r->plans->count - 1] : NULL;
  if (r->plans->memory || !p || p->count == 0) return true;
  p->expected[p->count - 1].is_image = true;
  p->expected[p->count - 1].name = cag_test_trim((CagTestPiece){text.start, colon});
  return true;
}

static void note_miss(Reader *r, CagTestPiece text) {
  const char *meant = cag_test_meant(text.start, (size_t)(text.end - text.start));
  if (!meant) return;
  CagTestMiss *miss = grow((void **)&r->plans->misses, &r->plans->miss_count, sizeof *miss);
  if (miss) *miss = (CagTestMiss){text, meant, r->line};
  else r->plans->memory = true;
}

// Reads the text after the `//` of a comment.
static void read_comment(Reader *r, CagTestPiece text, bool alone) {
  CagTestPiece rest;
  text = cag_test_trim(text);
  if (begins_with(text, "expect error:", &rest)) {
    add_errors(r, rest, alone);
  } else if (begins_with(text, "expect image", &rest) &&
             add_image(r, after(text, "expect image"), alone)) {
    return;
  } else if (begins_with(text, "expect:", &rest)) {
    add_expected(r, rest, false, alone);
  } else if (begins_with(text, "run:", &rest)) {
    CagTestPlan *p = add_plan(r->plans, r->limits, r->line);
    if (p) read_options(r->plans, p, rest);
  } else {
    note_miss(r, text);
  }
}

// Reads the rest of a line with an unterminated text or comment.
static void read_broken_line(Reader *r, const char *at, const char *line_end) {
  CagTestPiece rest;
  for (; at + 2 <= line_end; at++)
    if (at[0] == '/' && at[1] == '/' &&
        begins_with(cag_test_trim((CagTestPiece){at + 2, line_end}), "expect error:", &rest))
      add_errors(r, rest, false);
}

static const char *end_of_line(const Reader *r, const char *at) {
  const char *newline = memchr(at, '\n', (size_t)(r->end - at));
  return newline ? newline : r->end;
}

// Returns the position after the `*/` of the block comment at `at`, or NULL if it is unterminated.
// Block comments nest.
static const char *skip_block_comment(const char *at, const char *end) {
  size_t depth = 0;
  for (; at + 2 <= end; at++) {
    if (at[0] == '/' && at[1] == '*') {
      depth++;
      at++;
    } else if (at[0] == '*' && at[1] == '/') {
      at++;
      if (--depth == 0) return at + 1;
    }
  }
  return NULL;
}

static const char *skip_raw(const char *at, const char *end) {
  const char *close = memchr(at + 1, '`', (size_t)(end - at - 1));
  return close ? close + 1 : NULL;
}

// Returns the position after the closing quote of the text at `at`, or NULL if there is none on its
// line. The { } of a text contain expressions that may contain texts: `holes` counts the open
// braces in each enclosing text.
#define TEXT_NESTING 64
static const char *skip_text(const char *at, const char *line_end) {
  unsigned holes[TEXT_NESTING] = {0}, depth = 0;
  for (at++; at < line_end; at++) {
    const char c = *at;
    if (holes[depth] == 0) { // within the text
      if (c == '\\') at++;
      else if (c == '{') holes[depth] = 1;
      else if (c == '"' && depth == 0) return at + 1;
      else if (c == '"') depth--;
    } else if (c == '"') {
      if (++depth == TEXT_NESTING) return NULL;
      holes[depth] = 0;
    } else if (c == '{') {
      holes[depth]++;
    } else if (c == '}') {
      holes[depth]--;
    } else if (c == '`') {
      const char *behind = skip_raw(at, line_end);
      if (!behind) return NULL;
      at = behind - 1;
    }
  }
  return NULL;
}

static void count_lines(Reader *r, const char *from, const char *to) {
  for (; from < to; from++) {
    if (*from != '\n') continue;
    r->line++;
    r->line_start = from + 1;
  }
}

static bool is_blank(const char *from, const char *to) {
  while (from < to && isspace((unsigned char)*from)) from++;
  return from == to;
}

// Reads the comment or text at `at`, if there is one, and returns the next position.
static const char *read_at(Reader *r, const char *at) {
  const char *line_end = end_of_line(r, at), *behind;
  const bool two = at + 2 <= r->end;
  if (two && at[0] == '/' && at[1] == '/') {
    read_comment(r, (CagTestPiece){at + 2, line_end}, is_blank(r->line_start, at));
    return line_end;
  }
  if (two && at[0] == '/' && at[1] == '*') behind = skip_block_comment(at, r->end);
  else if (*at == '`') behind = skip_raw(at, r->end);
  else if (*at == '"') behind = skip_text(at, line_end);
  else return at + 1;
  if (behind) return behind;
  read_broken_line(r, at, line_end);
  return line_end;
}

bool cag_test_read_plans(const char *text, size_t length, const CagSessionOptions *limits,
                         CagTestPlans *plans) {
  Reader r = {.start = text,
              .end = text + length,
              .line = 1,
              .line_start = text,
              .limits = limits,
              .plans = plans};
  for (const char *at = text; at < r.end;) {
    const char *behind = read_at(&r, at);
    count_lines(&r, at, behind);
    at = behind;
  }
  if (plans->count == 0) add_plan(plans, limits, 0);
  return !plans->memory;
}
