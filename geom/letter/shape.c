// The steps for each paragraph, that is, the text up to a line feed:
//
// 1. Levels: even ones run to the right, odd ones to the left (FriBidi). Scripts: punctuation has
//    that of the character before it.
// 2. If there is a width, the advance of each character, with which lines are broken.
// 3. For each line, the levels again with its own end, and the order in which its characters are
//    seen. Successive characters of one level and script are a run, which HarfBuzz shapes.

#include "geom/letter/shape.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <utf8proc.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"

// What HarfBuzz takes per character of a run.
#define BYTES_PER_CHARACTER 128
#define TAB_SPACES 4

typedef struct Paragraph {
  uint32_t *chars;
  FriBidiCharType *types;
  FriBidiLevel *levels;      // of the paragraph
  FriBidiLevel *line_levels; // of the line that is laid out
  FriBidiStrIndex *order;    // from places in a line to characters
  hb_script_t *scripts;
  double *advances; // of each character; with a width only
  size_t n;
  FriBidiParType base;
} Paragraph;

typedef struct Shaper {
  const CagFont *font;
  const CagLetterRules *rules;
  CagLetters *out;
  hb_buffer_t *buffer;
  Paragraph p;
  double pen;      // along the line
  double hyphen;   // its advance; with a width only
  bool has_hyphen; // whether the font has one
} Shaper;

// --- Characters ---

static void paragraph_free(Paragraph *p) {
  cag_free(p->chars);
  cag_free(p->types);
  cag_free(p->levels);
  cag_free(p->line_levels);
  cag_free(p->order);
  cag_free(p->scripts);
  cag_free(p->advances);
  *p = (Paragraph){.n = 0};
}

// Room for n characters.
static bool paragraph_new(Paragraph *p, size_t n, bool measured) {
  const size_t room = n ? n : 1;
  *p = (Paragraph){.n = 0};
  p->chars = cag_malloc(room * sizeof *p->chars);
  p->types = cag_malloc(room * sizeof *p->types);
  p->levels = cag_malloc(room * sizeof *p->levels);
  p->line_levels = cag_malloc(room * sizeof *p->line_levels);
  p->order = cag_malloc(room * sizeof *p->order);
  p->scripts = cag_malloc(room * sizeof *p->scripts);
  if (measured) p->advances = cag_calloc(room, sizeof *p->advances);
  return p->chars && p->types && p->levels && p->line_levels && p->order && p->scripts &&
         (!measured || p->advances);
}

static size_t room_for(const char *text, size_t n) {
  size_t room = n;
  for (size_t i = 0; i < n; i++) room += text[i] == '\t' ? TAB_SPACES - 1 : 0;
  return room;
}

static void read_chars(Paragraph *p, const char *text, size_t n) {
  for (size_t i = 0; i < n;) {
    utf8proc_int32_t c;
    const utf8proc_ssize_t bytes =
        utf8proc_iterate((const utf8proc_uint8_t *)text + i, (utf8proc_ssize_t)(n - i), &c);
    if (bytes <= 0) return; // not UTF-8
    i += (size_t)bytes;
    if (c == '\r') continue;
    if (c == '\t')
      for (int k = 0; k < TAB_SPACES; k++) p->chars[p->n++] = ' ';
    else p->chars[p->n++] = (uint32_t)c;
  }
}

static bool is_generic(hb_script_t script) {
  return script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED || script == HB_SCRIPT_UNKNOWN;
}

static void find_scripts(Paragraph *p) {
  hb_unicode_funcs_t *unicode = cag_hb.unicode_funcs_get_default();
  hb_script_t last = HB_SCRIPT_COMMON;
  for (size_t i = 0; i < p->n; i++) {
    const hb_script_t own = cag_hb.unicode_script(unicode, p->chars[i]);
    if (!is_generic(own)) last = own;
    p->scripts[i] = last;
  }
  // What is before the first letter belongs to it.
  for (size_t i = p->n; i-- > 0; last = p->scripts[i])
    if (p->scripts[i] == HB_SCRIPT_COMMON) p->scripts[i] = last;
}

static FriBidiParType base_of(CagLetterDirection d) {
  return d == CAG_LETTER_AUTO ? FRIBIDI_PAR_ON
                              : (d == CAG_LETTER_RTL ? FRIBIDI_PAR_RTL : FRIBIDI_PAR_LTR);
}

static CagStatus find_levels(Paragraph *p, CagLetterDirection direction, CagError *err) {
  p->base = base_of(direction);
  FriBidiBracketType *brackets = cag_malloc((p->n ? p->n : 1) * sizeof *brackets);
  if (!brackets) return cag_fail_memory(err);
  const FriBidiStrIndex n = (FriBidiStrIndex)p->n;
  cag_fribidi.get_bidi_types(p->chars, n, p->types);
  cag_fribidi.get_bracket_types(p->chars, n, p->types, brackets);
  const bool ok =
      cag_fribidi.get_par_embedding_levels_ex(p->types, brackets, n, &p->base, p->levels) > 0;
  cag_free(brackets);
  return ok || p->n == 0 ? CAG_OK : cag_fail_memory(err);
}

// --- Runs ---

// A run of characters with one level and script, within `of` characters from `line` on.
typedef struct Run {
  size_t line, of;
  size_t start, n;
  hb_direction_t direction;
} Run;

static CagStatus fail_missing(const Shaper *s, uint32_t c, CagError *err) {
  char text[8] = "";
  utf8proc_encode_char((utf8proc_int32_t)c, (utf8proc_uint8_t *)text);
  const bool seen = utf8proc_charwidth((utf8proc_int32_t)c) > 0; // marks and controls are not
  (cag_fail)(err, CAG_E_ARGUMENT, CAG_ERR_glyph_missing, "text", -1,
             "the font \"%s\" has no glyph for %s%s%sU+%04X%s", s->font->name, seen ? "\"" : "",
             seen ? text : "", seen ? "\" (" : "", c, seen ? ")" : "");
  snprintf(err->help, sizeof err->help, "name another font; fonts() lists those of this system");
  return cag_never_ok(err->status);
}

static CagStatus shape_run(Shaper *s, const Run *r, CagError *err) {
  hb_buffer_t *b = s->buffer;
  cag_hb.buffer_clear_contents(b);
  cag_hb.buffer_add_codepoints(b, s->p.chars + r->line, (int)r->of, (unsigned)(r->start - r->line),
                               (int)r->n);
  hb_buffer_flags_t flags = HB_BUFFER_FLAG_DEFAULT;
  if (r->start == r->line) flags |= HB_BUFFER_FLAG_BOT;
  if (r->start + r->n == r->line + r->of) flags |= HB_BUFFER_FLAG_EOT;
  cag_hb.buffer_set_flags(b, flags);
  cag_hb.buffer_set_direction(b, r->direction);
  cag_hb.buffer_set_script(b, s->p.scripts[r->start]);
  // The result does not depend on the language of the system.
  cag_hb.buffer_set_language(b, cag_hb.language_from_string("en", -1));
  // Letters that are set apart are not joined.
  static const hb_feature_t apart[] = {{HB_TAG('l', 'i', 'g', 'a'), 0, 0, UINT_MAX},
                                       {HB_TAG('c', 'l', 'i', 'g'), 0, 0, UINT_MAX}};
  cag_hb.shape(s->font->hb, b, apart, s->rules->spacing == 1 ? 0 : 2);
  if (!cag_hb.buffer_allocation_successful(b)) return cag_fail_memory(err);
  return cag_stop_check(err);
}

typedef struct Shaped {
  const hb_glyph_info_t *infos;
  const hb_glyph_position_t *positions;
  unsigned n;
} Shaped;

static Shaped shaped(const Shaper *s) {
  Shaped found;
  found.infos = cag_hb.buffer_get_glyph_infos(s->buffer, &found.n);
  found.positions = cag_hb.buffer_get_glyph_positions(s->buffer, NULL);
  return found;
}

// Glyphs of one cluster stay together: what spacing adds comes after the last one.
static void place_run(Shaper *s, bool vertical) {
  const Shaped run = shaped(s);
  CagLetters *l = s->out;
  for (unsigned i = 0; i < run.n;) {
    const double start = s->pen;
    unsigned k = i;
    do {
      const hb_glyph_position_t *p = &run.positions[k];
      const double advance = vertical ? -p->y_advance : p->x_advance;
      l->items[l->count++] = (CagLetter){.glyph = run.infos[k].codepoint,
                                         .x = (vertical ? 0 : s->pen) + p->x_offset,
                                         .y = (vertical ? -s->pen : 0) + p->y_offset};
      s->pen += advance;
    } while (++k < run.n && run.infos[k].cluster == run.infos[i].cluster);
    for (unsigned c = i; c < k; c++) l->items[l->count - k + c].middle = (start + s->pen) / 2;
    s->pen = start + s->rules->spacing * (s->pen - start);
    i = k;
  }
}

// The first character of a cluster that has no glyph of its own. Without one, the first character.
static uint32_t missing_in_cluster(const Shaper *s, const Run *r, uint32_t cluster) {
  const Shaped run = shaped(s);
  size_t end = r->start + r->n;
  for (unsigned i = 0; i < run.n; i++)
    if (run.infos[i].cluster > cluster && r->line + run.infos[i].cluster < end)
      end = r->line + run.infos[i].cluster;
  for (size_t i = r->line + cluster; i < end; i++) {
    hb_codepoint_t glyph;
    if (!cag_hb.font_get_nominal_glyph(s->font->hb, s->p.chars[i], &glyph)) return s->p.chars[i];
  }
  return s->p.chars[r->line + cluster];
}

static CagStatus check_glyphs(const Shaper *s, const Run *r, CagError *err) {
  const Shaped run = shaped(s);
  for (unsigned i = 0; i < run.n; i++)
    if (run.infos[i].codepoint == 0)
      return fail_missing(s, missing_in_cluster(s, r, run.infos[i].cluster), err);
  return CAG_OK;
}

static CagStatus put_run(Shaper *s, const Run *r, CagError *err) {
  CagStatus status = shape_run(s, r, err);
  if (!status && !s->rules->missing) status = check_glyphs(s, r, err);
  if (status) return status;
  if (!CAG_RESERVE(s->out->items, s->out->capacity, s->out->count + shaped(s).n))
    return cag_fail_memory(err);
  place_run(s, r->direction == HB_DIRECTION_TTB);
  return CAG_OK;
}

// --- Lines ---

// The characters from place `i` on that follow each other in the text, have one level, and one
// script.
static size_t run_length(const Paragraph *p, size_t from, size_t n, size_t i) {
  const FriBidiStrIndex *order = p->order + from;
  const FriBidiLevel level = p->line_levels[order[i]];
  const FriBidiStrIndex step = level % 2 ? -1 : 1;
  size_t k = i + 1;
  while (k < n && order[k] == order[k - 1] + step && p->line_levels[order[k]] == level &&
         p->scripts[order[k]] == p->scripts[order[i]])
    k++;
  return k - i;
}

static CagStatus put_runs(Shaper *s, size_t from, size_t n, CagError *err) {
  Paragraph *p = &s->p;
  memcpy(p->line_levels + from, p->levels + from, n * sizeof *p->levels);
  for (size_t i = from; i < from + n; i++) p->order[i] = (FriBidiStrIndex)i;
  if (n > 0 && !cag_fribidi.reorder_line(0, p->types, (FriBidiStrIndex)n, (FriBidiStrIndex)from,
                                         p->base, p->line_levels, NULL, p->order))
    return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n;) {
    const size_t length = run_length(p, from, n, i);
    const size_t first = (size_t)p->order[from + i], last = (size_t)p->order[from + i + length - 1];
    const bool left = p->line_levels[first] % 2;
    const Run run = {from, n, left ? last : first, length,
                     left ? HB_DIRECTION_RTL : HB_DIRECTION_LTR};
    status = put_run(s, &run, err);
    i += length;
  }
  return status;
}

// Lines from top to bottom have one direction.
static CagStatus put_column(Shaper *s, size_t from, size_t n, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = from; !status && i < from + n;) {
    size_t k = i + 1;
    while (k < from + n && s->p.scripts[k] == s->p.scripts[i]) k++;
    const Run run = {from, n, i, k - i, HB_DIRECTION_TTB};
    status = put_run(s, &run, err);
    i = k;
  }
  return status;
}

static CagStatus put_line(Shaper *s, size_t from, size_t n, CagError *err) {
  CagLetters *l = s->out;
  const size_t first = l->count;
  s->pen = 0;
  CagStatus status = s->rules->direction == CAG_LETTER_TTB ? put_column(s, from, n, err)
                                                           : put_runs(s, from, n, err);
  if (status) return status;
  if (!CAG_RESERVE(l->lines, l->line_capacity, l->line_count + 1)) return cag_fail_memory(err);
  l->lines[l->line_count++] = (CagLetterLine){first, l->count - first, s->pen};
  return CAG_OK;
}

// --- Breaking lines ---

// The advance of each character, with those of its cluster at the first one.
static CagStatus measure_chars(Shaper *s, CagError *err) {
  Paragraph *p = &s->p;
  const bool vertical = s->rules->direction == CAG_LETTER_TTB;
  for (size_t i = 0; i < p->n;) {
    size_t k = i + 1;
    while (k < p->n && p->levels[k] == p->levels[i] && p->scripts[k] == p->scripts[i]) k++;
    const hb_direction_t along = p->levels[i] % 2 ? HB_DIRECTION_RTL : HB_DIRECTION_LTR;
    const Run run = {0, p->n, i, k - i, vertical ? HB_DIRECTION_TTB : along};
    CagStatus status = shape_run(s, &run, err);
    if (status) return status;
    const Shaped found = shaped(s);
    for (unsigned g = 0; g < found.n; g++)
      p->advances[found.infos[g].cluster] +=
          s->rules->spacing *
          (vertical ? -found.positions[g].y_advance : found.positions[g].x_advance);
    i = k;
  }
  return CAG_OK;
}

static bool is_space(uint32_t c) {
  return c == ' ' || (c >= 0x2000 && c <= 0x200b && c != 0x2007) || c == 0x3000;
}

#define SOFT_HYPHEN 0xad // seen only at the end of a line

static bool is_hyphen(uint32_t c) {
  return c == '-' || c == SOFT_HYPHEN || c == 0x2010 || c == 0x2013 || c == 0x2014;
}

static bool is_digit(uint32_t c) { return c >= '0' && c <= '9'; }

// Signs of numbers, and hyphens that begin a word, are not followed by a break (Unicode Standard
// Annex 14, LB20a and LB25).
static bool is_hyphenated(const Paragraph *p, size_t i) {
  const uint32_t hyphen = p->chars[i - 1], c = p->chars[i];
  if (!is_hyphen(hyphen) || is_hyphen(c)) return false;
  const bool within = i > 1 && !is_space(p->chars[i - 2]);
  return hyphen == 0x2014 || (within && !(hyphen == '-' && is_digit(c)));
}

// Ideographs, kana, and hangul.
static bool is_ideograph(uint32_t c) {
  return (c >= 0x2e80 && c <= 0x9fff && c != 0x3000) || (c >= 0xac00 && c <= 0xd7a3) ||
         (c >= 0xf900 && c <= 0xfaff) || (c >= 0x20000 && c <= 0x3ffff);
}

// Closing punctuation does not start a line.
static bool is_closing(uint32_t c) {
  return (c >= 0x3001 && c <= 0x3002) || c == 0x300d || c == 0x300f || c == 0xff09 || c == 0xff0c;
}

static bool may_break_before(const Paragraph *p, size_t i) {
  const uint32_t before = p->chars[i - 1], c = p->chars[i];
  if (is_space(c)) return false;
  return is_space(before) || is_hyphenated(p, i) ||
         ((is_ideograph(c) || is_ideograph(before)) && !is_closing(c));
}

// Returns the end of the line that starts at `from`: the last break before the width is exceeded,
// not counting spaces at the end, or the first break if there is none.
static size_t line_end(const Shaper *s, size_t from) {
  const Paragraph *p = &s->p;
  const double width = s->rules->width * (1 + 1e-9);
  double advance = 0;
  size_t end = from;
  for (size_t i = from; i < p->n; i++) {
    if (i > from && may_break_before(p, i)) {
      const bool soft = p->chars[i - 1] == SOFT_HYPHEN;
      if (end == from || !soft || advance + s->hyphen <= width) end = i;
    }
    if (!is_space(p->chars[i]) && advance + p->advances[i] > width && end > from) return end;
    advance += p->advances[i];
  }
  return p->n;
}

// Finds the hyphen that a soft hyphen becomes. Fonts without one have none there either.
static void find_hyphen(Shaper *s) {
  hb_codepoint_t glyph;
  s->has_hyphen = cag_hb.font_get_nominal_glyph(s->font->hb, '-', &glyph);
  if (!s->has_hyphen) return;
  const int advance = s->rules->direction == CAG_LETTER_TTB
                          ? -cag_hb.font_get_glyph_v_advance(s->font->hb, glyph)
                          : cag_hb.font_get_glyph_h_advance(s->font->hb, glyph);
  s->hyphen = s->rules->spacing * advance;
}

static CagStatus put_broken_lines(Shaper *s, CagError *err) {
  CagStatus status = measure_chars(s, err);
  if (!status) find_hyphen(s);
  size_t from = 0;
  while (!status) {
    const size_t end = line_end(s, from);
    size_t seen = end; // without the spaces at which the line is broken
    while (end < s->p.n && seen > from && is_space(s->p.chars[seen - 1])) seen--;
    if (end < s->p.n && s->has_hyphen && s->p.chars[seen - 1] == SOFT_HYPHEN)
      s->p.chars[seen - 1] = '-';
    status = put_line(s, from, seen - from, err);
    from = end;
    if (from >= s->p.n) break;
  }
  return status;
}

// --- Paragraphs ---

static CagStatus put_paragraph(Shaper *s, const char *text, size_t n, CagError *err) {
  const size_t room = room_for(text, n);
  if (room > INT_MAX / 2 || !cag_account_hold(room * BYTES_PER_CHARACTER))
    return cag_fail_memory(err);
  const bool broken = s->rules->width > 0;
  CagStatus status = paragraph_new(&s->p, room, broken) ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    read_chars(&s->p, text, n);
    find_scripts(&s->p);
    status = find_levels(&s->p, s->rules->direction, err);
  }
  if (!status) status = broken ? put_broken_lines(s, err) : put_line(s, 0, s->p.n, err);
  paragraph_free(&s->p);
  cag_account_drop(room * BYTES_PER_CHARACTER);
  return status;
}

CagStatus cag_letters_shape(const CagFont *f, const char *text, size_t n, const CagLetterRules *r,
                            CagLetters *out, CagError *err) {
  *out = (CagLetters){.items = NULL};
  CagStatus status = cag_letter_libraries(err);
  if (status) return status;
  Shaper s = {.font = f, .rules = r, .out = out, .buffer = cag_hb.buffer_create()};
  for (size_t from = 0; !status;) {
    const char *end = memchr(text + from, '\n', n - from);
    const size_t length = end ? (size_t)(end - text) - from : n - from;
    status = put_paragraph(&s, text + from, length, err);
    if (!end) break;
    from += length + 1;
  }
  cag_hb.buffer_destroy(s.buffer);
  if (status) cag_letters_free(out);
  return status;
}

void cag_letters_free(CagLetters *l) {
  cag_free(l->items);
  cag_free(l->lines);
  *l = (CagLetters){.items = NULL};
}
