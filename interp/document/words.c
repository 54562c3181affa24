// The words of a document with their meaning, the names of positional arguments, and colors.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "interp/document/document.h"
#include "interp/scene/scene.h"
#include "interp/vm/builtin.h"

typedef struct Words {
  CagWorkspace *w;
  Document *d;
  size_t start, end;
  void (*give)(void *context, const CagPlace *place, CagWordKind kind, unsigned flags);
  void *context;
  CagArena memory;
  size_t occurrence; // the next one that may match
} Words;

// --- Kinds ---

static void give_span(const Words *w, CagSpan span, CagWordKind kind, unsigned flags) {
  // Gives the lines of a text or comment one by one.
  const char *text = w->d->text;
  for (size_t at = span.start; at < span.end;) {
    const char *newline = memchr(text + at, '\n', span.end - at);
    size_t end = newline ? (size_t)(newline - text) : span.end;
    const size_t next = newline ? end + 1 : span.end;
    if (end > at && text[end - 1] == '\r') end--;
    const CagPlace place = {w->d->file, at, end};
    if (end > at && end > w->start && at < w->end) w->give(w->context, &place, kind, flags);
    at = next;
  }
}

static bool is_library(const CagModuleUnit *m) {
  return m && !m->path && strncmp(m->name, "std.", 4) == 0;
}

static CagWordKind kind_of_decl(const Entity *e, unsigned *flags) {
  if (is_library(e->unit)) *flags |= CAG_WORD_IS_LIBRARY;
  if (e->decl->doc && strstr(e->decl->doc, "deprecated:")) *flags |= CAG_WORD_IS_DEPRECATED;
  switch (cag_entity_kind(e)) {
  case CAG_NAME_FUNCTION: return CAG_WORD_FUNCTION;
  case CAG_NAME_PARAMETER: return CAG_WORD_PARAMETER;
  case CAG_NAME_MODULE: return CAG_WORD_MODULE;
  case CAG_NAME_PARAM: return CAG_WORD_PARAMETER;
  default: *flags |= CAG_WORD_IS_CONSTANT; return CAG_WORD_VALUE;
  }
}

static CagWordKind kind_of(const Occurrence *o, unsigned *flags) {
  const bool defines = o->role == ROLE_DEFINITION || o->role == ROLE_SHORTHAND;
  *flags = defines ? CAG_WORD_IS_DEFINITION : 0;
  switch (o->entity.kind) {
  case ENTITY_NONE: return o->role == ROLE_LABEL ? CAG_WORD_PARAMETER : CAG_WORD_VALUE;
  case ENTITY_DECL: return kind_of_decl(&o->entity, flags);
  case ENTITY_BUILTIN:
    *flags |= CAG_WORD_IS_LIBRARY;
    if (cag_entity_kind(&o->entity) == CAG_NAME_BUILTIN) return CAG_WORD_FUNCTION;
    *flags |= CAG_WORD_IS_CONSTANT;
    return CAG_WORD_VALUE;
  case ENTITY_MODULE:
    if (is_library(o->entity.unit)) *flags |= CAG_WORD_IS_LIBRARY;
    return CAG_WORD_MODULE;
  case ENTITY_FIELD: return CAG_WORD_FIELD;
  case ENTITY_ARGUMENT: return CAG_WORD_PARAMETER;
  }
  return CAG_WORD_VALUE;
}

// Returns the occurrence that contains a token, or NULL. Tokens come in order.
static const Occurrence *occurrence_at(Words *w, CagSpan span) {
  const Document *d = w->d;
  while (w->occurrence < d->occurrence_count &&
         d->occurrences[w->occurrence].span.end <= span.start)
    w->occurrence++;
  if (w->occurrence >= d->occurrence_count) return NULL;
  const Occurrence *o = &d->occurrences[w->occurrence];
  return o->span.start <= span.start && span.end <= o->span.end ? o : NULL;
}

static void give_token(Words *w, const CagToken *t) {
  const Occurrence *o = occurrence_at(w, t->span);
  unsigned flags = 0;
  switch (t->kind) {
  case CAG_TOKEN_NUMBER:
  case CAG_TOKEN_ANGLE: give_span(w, t->span, CAG_WORD_NUMBER, 0); return;
  case CAG_TOKEN_TEXT:
  case CAG_TOKEN_TEXT_HEAD:
  case CAG_TOKEN_TEXT_MIDDLE:
  case CAG_TOKEN_TEXT_TAIL: give_span(w, t->span, CAG_WORD_TEXT, 0); return;
  case CAG_TOKEN_LEFT_PAREN:
  case CAG_TOKEN_RIGHT_PAREN:
  case CAG_TOKEN_LEFT_SQUARE:
  case CAG_TOKEN_RIGHT_SQUARE:
  case CAG_TOKEN_LEFT_BRACE:
  case CAG_TOKEN_RIGHT_BRACE:
  case CAG_TOKEN_COMMA:
  case CAG_TOKEN_COLON:
  case CAG_TOKEN_SEMICOLON:
  case CAG_TOKEN_DOT:
  case CAG_TOKEN_ERROR:
  case CAG_TOKEN_END: return;
  default: break;
  }
  if (t->kind == CAG_TOKEN_NAME || (o && t->kind >= CAG_TOKEN_FIRST_WORD)) {
    const CagWordKind kind = o ? kind_of(o, &flags) : CAG_WORD_VALUE;
    give_span(w, t->span, kind, flags);
  } else if (t->kind >= CAG_TOKEN_FIRST_WORD) {
    give_span(w, t->span, CAG_WORD_KEYWORD, 0);
  } else {
    give_span(w, t->span, CAG_WORD_OPERATOR, 0);
  }
}

static void give_words(void *context) {
  Words *w = context;
  const Tokens ts = cag_document_tokens(w->d, w->end, &w->memory);
  size_t comment = 0;
  for (size_t i = 0; i <= ts.count; i++) {
    const uint32_t next = i < ts.count ? ts.items[i].span.start : UINT32_MAX;
    for (; comment < ts.comment_count && ts.comments[comment].span.start < next; comment++)
      give_span(w, ts.comments[comment].span, CAG_WORD_COMMENT,
                ts.comments[comment].doc ? CAG_WORD_IS_DOCUMENTATION : 0);
    if (i < ts.count && ts.items[i].span.end > w->start) give_token(w, &ts.items[i]);
  }
}

void cag_document_words(CagWorkspace *w, const char *file, size_t start, size_t end,
                        void (*give)(void *context, const CagPlace *place, CagWordKind kind,
                                     unsigned flags),
                        void *context) {
  Words words = {.w = w,
                 .d = cag_document_get(w, file),
                 .start = start,
                 .end = end,
                 .give = give,
                 .context = context};
  if (words.d) cag_document_guard(give_words, &words);
  cag_arena_free(&words.memory);
}

// --- Hints ---

typedef struct Hints {
  Document *d;
  size_t start, end;
  void (*give)(void *context, const CagPlace *place, const char *label);
  void *context;
} Hints;

static bool is_literal(const CagExpr *e) {
  while (e->kind == CAG_EXPR_NEGATE) e = e->as.unary.operand;
  return e->kind == CAG_EXPR_NUMBER || e->kind == CAG_EXPR_ANGLE || e->kind == CAG_EXPR_TEXT ||
         e->kind == CAG_EXPR_TRUE || e->kind == CAG_EXPR_FALSE || e->kind == CAG_EXPR_NONE;
}

static CagType type_of_literal(const CagExpr *e) {
  while (e->kind == CAG_EXPR_NEGATE) e = e->as.unary.operand;
  switch (e->kind) {
  case CAG_EXPR_NUMBER: return CAG_NUMBER;
  case CAG_EXPR_ANGLE: return CAG_ANGLE;
  case CAG_EXPR_TEXT: return CAG_TEXT;
  case CAG_EXPR_LIST: return CAG_LIST;
  case CAG_EXPR_RANGE: return CAG_RANGE;
  case CAG_EXPR_RECORD: return CAG_RECORD;
  default: return CAG_UNSET;
  }
}

// Returns the signature of the row that a call selects, or NULL if it cannot be told from the text.
static const CagSignature *signature_of(size_t index, const CagExpr *call, size_t positional) {
  size_t rows;
  if (index >= cag_builtin_count() || !cag_builtin_rows(index, &rows)->function) return NULL;
  if (rows == 1) return cag_builtin_signature(index, 0);
  const CagArgument *first = call->as.call.count ? &call->as.call.arguments[0] : NULL;
  const CagType type = first && !first->name ? type_of_literal(first->value) : CAG_UNSET;
  if (type == CAG_UNSET) return NULL;
  const size_t row = cag_builtin_select(index, type, positional);
  return row == (size_t)-1 ? NULL : cag_builtin_signature(index, row);
}

static void hint_call(const Hints *h, const CagExpr *call, bool piped) {
  const Entity callee = cag_entity_of_callee(h->d->session->vm, h->d->unit, call->as.call.callee);
  const CagFunctionAst *f = cag_entity_function(&callee);
  size_t position = piped, positional = piped;
  for (size_t i = 0; i < call->as.call.count; i++) positional += !call->as.call.arguments[i].name;
  const CagSignature *s =
      callee.kind == ENTITY_BUILTIN && !piped ? signature_of(callee.index, call, positional) : NULL;
  for (size_t i = 0; i < call->as.call.count; i++) {
    const CagArgument *a = &call->as.call.arguments[i];
    if (a->name) break;
    const size_t k = position++;
    const char *name = NULL;
    if (f && k < f->parameter_count) name = f->parameters[k].decl->name;
    if (s && k < s->count && !s->positional_only[k]) name = s->parameters[k];
    if (!name || !is_literal(a->value) || call->as.call.count + piped < 2) continue;
    const CagSpan span = a->value->span;
    const CagPlace place = {h->d->file, span.start, span.start};
    char label[128];
    snprintf(label, sizeof label, "%s:", name);
    if (span.start >= h->start && span.start < h->end) h->give(h->context, &place, label);
  }
}

static void hint_expression(void *context, const CagExpr *e) {
  const Hints *h = context;
  if (e->kind == CAG_EXPR_PIPE && e->as.binary.right->kind == CAG_EXPR_CALL) {
    hint_expression(context, e->as.binary.left);
    hint_call(h, e->as.binary.right, true);
    cag_tree_below(e->as.binary.right, hint_expression, context);
    return;
  }
  if (e->kind == CAG_EXPR_CALL) hint_call(h, e, false);
  cag_tree_below(e, hint_expression, context);
}

static void give_hints(void *context) {
  Hints *h = context;
  const CagModuleAst *ast = h->d->unit->ast;
  for (size_t i = 0; ast && i < ast->count; i++)
    if (ast->statements[i]->span.end >= h->start && ast->statements[i]->span.start < h->end)
      cag_tree_of_statement(ast->statements[i], hint_expression, h);
}

void cag_document_hints(CagWorkspace *w, const char *file, size_t start, size_t end,
                        void (*give)(void *context, const CagPlace *place, const char *label),
                        void *context) {
  Hints h = {cag_document_get(w, file), start, end, give, context};
  if (h.d) cag_document_guard(give_hints, &h);
}

// --- Colors ---

typedef struct Colors {
  Document *d;
  void (*give)(void *context, const CagPlace *place, const double rgb[3]);
  void *context;
} Colors;

// The transfer function of sRGB (IEC 61966-2-1).
static double to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static void color_expression(void *context, const CagExpr *e) {
  const Colors *c = context;
  CagColor color;
  if (e->kind == CAG_EXPR_TEXT && strlen(e->as.text.bytes) == e->as.text.length &&
      cag_color_from_text(e->as.text.bytes, &color)) {
    const double rgb[3] = {to_srgb(color.r), to_srgb(color.g), to_srgb(color.b)};
    const CagPlace place = {c->d->file, e->span.start, e->span.end};
    c->give(c->context, &place, rgb);
  }
  // A text with { } is not a color.
  if (e->kind != CAG_EXPR_TEMPLATE) cag_tree_below(e, color_expression, context);
}

static void give_colors(void *context) {
  Colors *c = context;
  const CagModuleAst *ast = c->d->unit->ast;
  for (size_t i = 0; ast && i < ast->count; i++)
    if (ast->statements[i]->kind != CAG_STATEMENT_PRINT &&
        ast->statements[i]->kind != CAG_STATEMENT_ASSERT)
      cag_tree_of_statement(ast->statements[i], color_expression, c);
}

void cag_document_colors(CagWorkspace *w, const char *file,
                         void (*give)(void *context, const CagPlace *place, const double rgb[3]),
                         void *context) {
  Colors c = {cag_document_get(w, file), give, context};
  if (c.d) cag_document_guard(give_colors, &c);
}

void cag_color_text(const double rgb[3], char *out, size_t size) {
  int v[3];
  for (int i = 0; i < 3; i++) v[i] = (int)lround(255 * fmin(fmax(rgb[i], 0), 1));
  const bool brief = v[0] % 17 == 0 && v[1] % 17 == 0 && v[2] % 17 == 0;
  if (brief) snprintf(out, size, "\"#%x%x%x\"", v[0] / 17, v[1] / 17, v[2] / 17);
  else snprintf(out, size, "\"#%02x%02x%02x\"", v[0], v[1], v[2]);
}
