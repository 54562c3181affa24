// The text before a cursor: its words, the brackets that are open, and the call that it is in.
//
// The tokens tell this even where the text cannot be parsed, as it is while one types.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/document/document.h"
#include "interp/vm/builtin.h"

// --- Tokens ---

typedef struct Reader {
  CagLexer lexer;
  CagNames names;
  Tokens *out;
  CagToken *items;
  size_t capacity;
} Reader;

static void release_reader(void *context) {
  Reader *r = context;
  cag_lexer_release(&r->lexer);
  cag_names_release(&r->names);
  cag_free(r->items);
}

Tokens cag_document_tokens(const Document *d, size_t end, CagArena *arena) {
  Tokens out = {0};
  Reader r = {.out = &out};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, release_reader, &r);
  cag_names_init(&r.names, arena);
  cag_lexer_init(&r.lexer, d->unit->source, arena, &r.names, NULL);
  for (CagToken t = {0};;) {
    cag_lexer_next(&r.lexer, &t);
    if (t.kind == CAG_TOKEN_END || t.span.start >= end) break;
    if (!CAG_RESERVE(r.items, r.capacity, out.count + 1)) cag_memory_leave();
    r.items[out.count++] = t;
    if (t.kind == CAG_TOKEN_ERROR && t.span.end <= t.span.start) break; // the rest is unreadable
  }
  const size_t bytes = out.count * sizeof *out.items;
  out.items = cag_arena_alloc(arena, bytes);
  if (bytes) memcpy(out.items, r.items, bytes);
  out.comment_count = r.lexer.comment_count;
  const size_t comment_bytes = out.comment_count * sizeof *out.comments;
  out.comments = cag_arena_alloc(arena, comment_bytes);
  if (comment_bytes) memcpy(out.comments, r.lexer.comments, comment_bytes);
  cag_cleanup_run(&cleanup);
  return out;
}

// --- The cursor ---

static bool is_opener(CagTokenKind k) {
  return k == CAG_TOKEN_LEFT_PAREN || k == CAG_TOKEN_LEFT_SQUARE || k == CAG_TOKEN_LEFT_BRACE ||
         k == CAG_TOKEN_TEXT_HEAD;
}

static bool is_closer(CagTokenKind k) {
  return k == CAG_TOKEN_RIGHT_PAREN || k == CAG_TOKEN_RIGHT_SQUARE || k == CAG_TOKEN_RIGHT_BRACE ||
         k == CAG_TOKEN_TEXT_TAIL;
}

static bool is_word(CagTokenKind k) { return k == CAG_TOKEN_NAME || k >= CAG_TOKEN_FIRST_WORD; }

static bool in_first_column(const Document *d, const CagToken *t) {
  return t->span.start == 0 || d->text[t->span.start - 1] == '\n';
}

// Tests whether a token in the first column starts a statement, although brackets may be open.
static bool starts_statement(const Document *d, const Tokens *ts, size_t i) {
  const CagToken *t = &ts->items[i];
  if (!in_first_column(d, t)) return false;
  if (t->kind == CAG_TOKEN_IMPORT || t->kind == CAG_TOKEN_PARAM || t->kind == CAG_TOKEN_SHOW ||
      t->kind == CAG_TOKEN_PRINT || t->kind == CAG_TOKEN_ASSERT)
    return true;
  return t->kind == CAG_TOKEN_NAME && i + 1 < ts->count &&
         (ts->items[i + 1].kind == CAG_TOKEN_EQUALS ||
          ts->items[i + 1].kind == CAG_TOKEN_LEFT_PAREN);
}

// Finds the brackets that are open before token number `end`, and the statement.
static void find_open(const Document *d, Cursor *c, size_t end, CagArena *arena) {
  const Tokens *ts = &c->tokens;
  c->open = cag_arena_alloc(arena, (end + 1) * sizeof *c->open);
  for (size_t i = 0; i < end; i++) {
    const CagTokenKind kind = ts->items[i].kind;
    if (starts_statement(d, ts, i)) {
      c->open_count = 0;
      c->statement = i;
    } else if (c->open_count == 0 && ts->items[i].newline_before) {
      c->statement = i;
    }
    if (is_closer(kind) && c->open_count) c->open_count--;
    else if (is_opener(kind)) c->open[c->open_count++] = (OpenBracket){i, 0, i + 1};
    if (kind == CAG_TOKEN_COMMA && c->open_count) {
      c->open[c->open_count - 1].commas++;
      c->open[c->open_count - 1].argument = i + 1;
    }
  }
}

static bool in_comment(const Cursor *c) {
  for (size_t i = c->tokens.comment_count; i-- > 0;) {
    const CagComment *comment = &c->tokens.comments[i];
    if (comment->span.end < c->offset) return false;
    // A line comment includes its end.
    if (comment->span.start < c->offset &&
        (c->offset < comment->span.end || (!comment->block && c->offset == comment->span.end)))
      return true;
  }
  return false;
}

void cag_document_cursor(const Document *d, size_t offset, CagArena *arena, Cursor *out) {
  *out = (Cursor){.offset = offset};
  // The token after the cursor shows whether the cursor is in a comment.
  out->tokens = cag_document_tokens(d, offset, arena);
  Tokens *ts = &out->tokens;
  out->in_comment = in_comment(out);
  size_t end = ts->count;
  const CagToken *last = end ? &ts->items[end - 1] : NULL;
  out->word = (CagSpan){(uint32_t)offset, (uint32_t)offset};
  if (last && is_word(last->kind) && offset <= last->span.end) {
    out->word.start = last->span.start;
    end--;
  } else if (last && (last->kind == CAG_TOKEN_TEXT || last->kind == CAG_TOKEN_ERROR) &&
             strchr("\"`", d->text[last->span.start]) &&
             (offset < last->span.end || last->kind == CAG_TOKEN_ERROR)) {
    out->text = last;
    end--;
  } else if (last && last->span.end > offset) {
    end--; // within another token
  }
  out->before = end;
  find_open(d, out, end, arena);
  const CagToken *next = end < ts->count ? &ts->items[end] : NULL;
  if (next && starts_statement(d, ts, end)) out->open_count = 0;
  if (next && next->newline_before && out->open_count == 0) out->statement = end;
  if (!next && out->open_count == 0 &&
      memchr(d->text + (last ? last->span.end : 0), '\n', offset - (last ? last->span.end : 0)))
    out->statement = end;
}

// --- The call ---

Entity cag_document_chain(const Document *d, const Cursor *c, size_t end, size_t *start) {
  const CagToken *t = c->tokens.items;
  Entity none = {.kind = ENTITY_NONE};
  *start = end;
  if (end == 0 || t[end - 1].kind != CAG_TOKEN_NAME) return none;
  *start = end - 1;
  const char *name = t[end - 1].as.name;
  if (end >= 2 && t[end - 2].kind == CAG_TOKEN_DOT) {
    if (end < 3 || t[end - 3].kind != CAG_TOKEN_NAME) return none;
    *start = end - 3;
    if (end >= 4 && t[end - 4].kind == CAG_TOKEN_DOT) return none; // a field of a field
    const char *object = t[end - 3].as.name;
    const Entity module = cag_document_lookup(d, t[end - 3].span.start, object, strlen(object));
    if (module.kind != ENTITY_DECL || module.decl->kind != CAG_DECL_IMPORT) return none;
    const CagVm *vm = d->session->vm;
    const size_t k = module.decl->statement->as.import.module;
    const CagModuleUnit *m = k < vm->module_count ? vm->modules[k] : NULL;
    for (size_t i = 0; m && i < m->public_count; i++) {
      const CagDecl *decl = m->publics[i].decl;
      if (strcmp(m->publics[i].name, name) != 0 ||
          decl->statement->kind != CAG_STATEMENT_DEFINITION)
        continue;
      return (Entity){.kind = ENTITY_DECL, .unit = m, .decl = decl};
    }
    return none;
  }
  return cag_document_lookup(d, t[end - 1].span.start, name, strlen(name));
}

// Finds the labels of the arguments between the bracket and the cursor.
static void find_labels(const Cursor *c, const OpenBracket *open, CagArena *arena,
                        CursorCall *out) {
  const CagToken *t = c->tokens.items;
  out->labels = cag_arena_alloc(arena, (c->before + 1) * sizeof *out->labels);
  size_t depth = 0, labeled = 0;
  for (size_t i = open->token + 1; i < c->before; i++) {
    const bool first = t[i - 1].kind == CAG_TOKEN_COMMA || i == open->token + 1;
    if (depth == 0 && first && is_word(t[i].kind) && i + 1 < c->before &&
        t[i + 1].kind == CAG_TOKEN_COLON) {
      if (i == open->argument) out->label = t[i].as.name;
      else out->labels[out->label_count++] = i;
      labeled++;
    }
    if (is_opener(t[i].kind)) depth++;
    if (is_closer(t[i].kind) && depth) depth--;
  }
  out->position = open->commas - (labeled && !out->label ? labeled : 0);
}

bool cag_document_call(const Document *d, const Cursor *c, CagArena *arena, CursorCall *out) {
  const CagToken *t = c->tokens.items;
  *out = (CursorCall){0};
  for (size_t k = c->open_count; k-- > 0;) {
    const OpenBracket *open = &c->open[k];
    if (t[open->token].kind != CAG_TOKEN_LEFT_PAREN || open->token == 0) continue;
    const CagToken *callee = &t[open->token - 1];
    if (callee->kind != CAG_TOKEN_NAME || t[open->token].newline_before) continue; // a group
    size_t start;
    out->callee = cag_document_chain(d, c, open->token, &start);
    out->name = callee->as.name;
    find_labels(c, open, arena, out);
    out->piped = start > 0 && t[start - 1].kind == CAG_TOKEN_PIPE;
    out->position += out->piped;
    return true;
  }
  return false;
}
