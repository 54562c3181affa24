// The requests of the language server about documents.

#include "live/lsp_parts.h"

#include <stdlib.h>
#include <string.h>

// A request about a place in a document.
typedef struct Place {
  CagLsp *l;
  const char *file;
  LspDocument *document;
  size_t offset;
  cJSON *out;
  CagPlace replaced; // by completions
  cJSON *range;      // of that place; NULL: none
} Place;

static LspDocument *document_of(CagLsp *l, const cJSON *params) {
  return lsp_find(l, lsp_text(lsp_get(params, "textDocument"), "uri"));
}

static bool read_place(CagLsp *l, const cJSON *params, Place *out) {
  *out = (Place){.l = l, .document = document_of(l, params)};
  if (!out->document) return false;
  out->file = out->document->file;
  return lsp_offset(l, out->file, lsp_get(params, "position"), &out->offset);
}

static cJSON *location_json(CagLsp *l, const CagPlace *place) {
  char *uri = lsp_uri_of_file(l, place->file);
  if (!uri) return NULL;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "uri", uri);
  cJSON_AddItemToObject(o, "range", lsp_range_json(l, place));
  free(uri);
  return o;
}

static void add_location(void *context, const CagPlace *place) {
  Place *p = context;
  cJSON *o = location_json(p->l, place);
  if (o) cJSON_AddItemToArray(p->out, o);
}

static cJSON *edit_json(CagLsp *l, const CagEdit *edit) {
  cJSON *o = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "range", lsp_range_json(l, &edit->place));
  cJSON_AddStringToObject(o, "newText", edit->text);
  return o;
}

// Adds an edit to a WorkspaceEdit: { changes: { uri: [edits] } }, or documentChanges with versions.
static void add_to_workspace_edit(CagLsp *l, cJSON *whole, const CagEdit *edit) {
  char *uri = lsp_uri_of_file(l, edit->place.file);
  if (!uri) return;
  if (!l->client.changes) {
    cJSON *changes = cJSON_GetObjectItemCaseSensitive(whole, "changes");
    if (!changes) changes = cJSON_AddObjectToObject(whole, "changes");
    cJSON *list = cJSON_GetObjectItemCaseSensitive(changes, uri);
    if (!list) list = cJSON_AddArrayToObject(changes, uri);
    cJSON_AddItemToArray(list, edit_json(l, edit));
    free(uri);
    return;
  }
  cJSON *changes = cJSON_GetObjectItemCaseSensitive(whole, "documentChanges"), *item, *found = NULL;
  if (!changes) changes = cJSON_AddArrayToObject(whole, "documentChanges");
  cJSON_ArrayForEach(item, changes) {
    const char *other = lsp_text(lsp_get(item, "textDocument"), "uri");
    if (other && strcmp(other, uri) == 0) found = item;
  }
  if (!found) {
    found = cJSON_CreateObject();
    cJSON *document = cJSON_AddObjectToObject(found, "textDocument");
    const LspDocument *d = lsp_find_file(l, edit->place.file);
    cJSON_AddStringToObject(document, "uri", uri);
    if (d) cJSON_AddNumberToObject(document, "version", d->version);
    else cJSON_AddNullToObject(document, "version");
    cJSON_AddArrayToObject(found, "edits");
    cJSON_AddItemToArray(changes, found);
  }
  cJSON_AddItemToArray(cJSON_GetObjectItemCaseSensitive(found, "edits"), edit_json(l, edit));
  free(uri);
}

static cJSON *markup_json(CagLsp *l, const char *markdown) {
  cJSON *o = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "kind", l->client.markdown ? "markdown" : "plaintext");
  cJSON_AddStringToObject(o, "value", markdown);
  return o;
}

// --- Completion ---

// CompletionItemKind, and SymbolKind.
static const struct {
  int completion, symbol;
} kinds[] = {
    [CAG_NAME_VALUE] = {21, 14},   [CAG_NAME_FUNCTION] = {3, 12},  [CAG_NAME_PARAM] = {6, 13},
    [CAG_NAME_MODULE] = {9, 2},    [CAG_NAME_PARAMETER] = {5, 13}, [CAG_NAME_LOCAL] = {6, 13},
    [CAG_NAME_FIELD] = {5, 8},     [CAG_NAME_BUILTIN] = {3, 12},   [CAG_NAME_CONSTANT] = {21, 14},
    [CAG_NAME_WORD] = {14, 14},    [CAG_NAME_FILE] = {17, 1},      [CAG_NAME_CHOICE] = {12, 15},
    [CAG_NAME_SNIPPET] = {15, 14}, [CAG_NAME_UNKNOWN] = {1, 13}};

static void add_completion(void *context, const CagCompletion *c) {
  Place *p = context;
  const bool snippet = c->is_snippet && p->l->client.snippets;
  if (c->kind == CAG_NAME_SNIPPET && !snippet) return;
  const char *text = c->is_snippet && !snippet ? c->label : c->text;
  cJSON *o = cJSON_CreateObject();
  char sort[160];
  cJSON_AddStringToObject(o, "label", c->label);
  cJSON_AddNumberToObject(o, "kind", kinds[c->kind].completion);
  if (c->detail) cJSON_AddStringToObject(o, "detail", c->detail);
  if (c->documentation)
    cJSON_AddItemToObject(o, "documentation", markup_json(p->l, c->documentation));
  snprintf(sort, sizeof sort, "%d%s", c->rank, c->label);
  cJSON_AddStringToObject(o, "sortText", sort);
  if (c->deprecated) {
    const int tag = 1;
    cJSON_AddItemToObject(o, "tags", cJSON_CreateIntArray(&tag, 1));
  }
  if (!p->l->client.edit_range) {
    cJSON *edit = cJSON_AddObjectToObject(o, "textEdit");
    // All replace the same.
    if (!p->range) p->range = lsp_range_json(p->l, &c->place);
    cJSON_AddItemToObject(edit, "range", cJSON_Duplicate(p->range, false));
    cJSON_AddStringToObject(edit, "newText", text);
  } else if (strcmp(text, c->label) != 0) {
    cJSON_AddStringToObject(o, "textEditText", text);
  }
  p->replaced = c->place;
  if (snippet) cJSON_AddNumberToObject(o, "insertTextFormat", 2);
  if (c->import) {
    cJSON *list = cJSON_AddArrayToObject(o, "additionalTextEdits");
    cJSON_AddItemToArray(list, edit_json(p->l, c->import));
  }
  cJSON_AddItemToArray(p->out, o);
}

static cJSON *completion(CagLsp *l, const cJSON *params) {
  Place p;
  if (!read_place(l, params, &p)) return NULL;
  p.out = cJSON_CreateArray();
  cag_document_complete(l->workspace, p.file, p.offset, add_completion, &p);
  cJSON *list = cJSON_CreateObject();
  // The names depend on the letters so far.
  cJSON_AddBoolToObject(list, "isIncomplete", true);
  if (l->client.edit_range && p.replaced.file) { // the same for all
    cJSON *defaults = cJSON_AddObjectToObject(list, "itemDefaults");
    cJSON_AddItemToObject(defaults, "editRange", lsp_range_json(l, &p.replaced));
  }
  cJSON_AddItemToObject(list, "items", p.out);
  cJSON_Delete(p.range);
  return list;
}

// --- Hover and signatures ---

static void take_hover(void *context, const CagPlace *place, const char *markdown) {
  Place *p = context;
  p->out = cJSON_CreateObject();
  cJSON_AddItemToObject(p->out, "contents", markup_json(p->l, markdown));
  cJSON_AddItemToObject(p->out, "range", lsp_range_json(p->l, place));
}

static cJSON *hover(CagLsp *l, const cJSON *params) {
  Place p;
  if (!read_place(l, params, &p)) return NULL;
  cag_document_hover(l->workspace, p.file, p.offset, take_hover, &p);
  return p.out;
}

typedef struct Signatures {
  CagLsp *l;
  cJSON *list;
  size_t chosen, active, count;
} Signatures;

// Returns the UTF-16 length of n bytes of UTF-8. Labels of signatures are always counted so.
static size_t utf16_length(const char *text, size_t n) {
  size_t units = 0;
  for (size_t i = 0; i < n; i++)
    units += ((unsigned char)text[i] & 0xC0) != 0x80 ? 1 + ((unsigned char)text[i] >= 0xF0) : 0;
  return units;
}

static void add_signature(void *context, const CagSignatureView *s) {
  Signatures *all = context;
  cJSON *o = cJSON_CreateObject(), *parameters = cJSON_CreateArray();
  cJSON_AddStringToObject(o, "label", s->label);
  if (s->documentation)
    cJSON_AddItemToObject(o, "documentation", markup_json(all->l, s->documentation));
  for (size_t i = 0; i < s->parameter_count; i++) {
    cJSON *item = cJSON_CreateObject();
    const int ends[] = {(int)utf16_length(s->label, s->parameters[i].start),
                        (int)utf16_length(s->label, s->parameters[i].end)};
    cJSON_AddItemToObject(item, "label", cJSON_CreateIntArray(ends, 2));
    if (s->parameters[i].documentation)
      cJSON_AddItemToObject(item, "documentation",
                            markup_json(all->l, s->parameters[i].documentation));
    cJSON_AddItemToArray(parameters, item);
  }
  cJSON_AddItemToObject(o, "parameters", parameters);
  cJSON_AddNumberToObject(o, "activeParameter", (double)s->active);
  if (s->is_chosen) {
    all->chosen = all->count;
    all->active = s->active;
  }
  all->count++;
  cJSON_AddItemToArray(all->list, o);
}

static cJSON *signature_help(CagLsp *l, const cJSON *params) {
  Place p;
  if (!read_place(l, params, &p)) return NULL;
  Signatures s = {.l = l, .list = cJSON_CreateArray()};
  cag_document_signatures(l->workspace, p.file, p.offset, add_signature, &s);
  if (!s.count) {
    cJSON_Delete(s.list);
    return NULL;
  }
  cJSON *o = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "signatures", s.list);
  cJSON_AddNumberToObject(o, "activeSignature", (double)s.chosen);
  cJSON_AddNumberToObject(o, "activeParameter", (double)s.active);
  return o;
}

// --- Navigation ---

static cJSON *definition(CagLsp *l, const cJSON *params) {
  Place p;
  if (!read_place(l, params, &p)) return NULL;
  p.out = cJSON_CreateArray();
  cag_document_definition(l->workspace, p.file, p.offset, add_location, &p);
  return p.out;
}

static cJSON *references(CagLsp *l, const cJSON *params) {
  Place p;
  if (!read_place(l, params, &p)) return NULL;
  p.out = cJSON_CreateArray();
  const bool own = lsp_is_true(lsp_get(params, "context"), "includeDeclaration");
  cag_document_references(l->workspace, p.file, p.offset, own, add_location, &p);
  return p.out;
}

static void add_highlight(void *context, const CagPlace *place) {
  Place *p = context;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "range", lsp_range_json(p->l, place));
  cJSON_AddNumberToObject(o, "kind", 1);
  cJSON_AddItemToArray(p->out, o);
}

static cJSON *highlight(CagLsp *l, const cJSON *params) {
  Place p;
  if (!read_place(l, params, &p)) return NULL;
  p.out = cJSON_CreateArray();
  cag_document_highlights(l->workspace, p.file, p.offset, add_highlight, &p);
  return p.out;
}

static void take_range(void *context, const CagPlace *place) {
  Place *p = context;
  cJSON_Delete(p->out);
  p->out = lsp_range_json(p->l, place);
}

static cJSON *prepare_rename(CagLsp *l, const cJSON *params) {
  Place p;
  if (!read_place(l, params, &p)) return NULL;
  if (cag_document_can_rename(l->workspace, p.file, p.offset, take_range, &p)) return p.out;
  cJSON_Delete(p.out);
  return NULL;
}

static void add_rename(void *context, const CagEdit *edit) {
  Place *p = context;
  add_to_workspace_edit(p->l, p->out, edit);
}

// A refused change of a name is an error with its reason.
static void rename_symbol(CagLsp *l, const cJSON *id, const cJSON *params) {
  Place p;
  char why[512];
  const char *name = lsp_text(params, "newName");
  if (!name || !read_place(l, params, &p)) {
    lsp_fail(l, id, LSP_INVALID_PARAMS, "expected a document, a position, and a new name");
    return;
  }
  p.out = cJSON_CreateObject();
  if (cag_document_rename(l->workspace, p.file, p.offset, name, add_rename, &p, why, sizeof why)) {
    lsp_answer(l, id, p.out);
    return;
  }
  cJSON_Delete(p.out);
  lsp_fail(l, id, LSP_REQUEST_FAILED, why);
}

// --- Structure ---

typedef struct SymbolTree {
  CagLsp *l;
  cJSON *levels[64]; // lists of children; levels[0] is the whole
} SymbolTree;

static void add_symbol(void *context, const CagSymbolView *s) {
  SymbolTree *t = context;
  if (s->depth + 1 >= sizeof t->levels / sizeof *t->levels || !t->levels[s->depth]) return;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "name", s->name);
  if (*s->detail) cJSON_AddStringToObject(o, "detail", s->detail);
  cJSON_AddNumberToObject(o, "kind", kinds[s->kind].symbol);
  cJSON_AddItemToObject(o, "range", lsp_range_json(t->l, &s->whole));
  cJSON_AddItemToObject(o, "selectionRange", lsp_range_json(t->l, &s->place));
  cJSON *children = cJSON_AddArrayToObject(o, "children");
  for (size_t i = s->depth + 1; i < sizeof t->levels / sizeof *t->levels; i++) t->levels[i] = NULL;
  t->levels[s->depth + 1] = children;
  cJSON_AddItemToArray(t->levels[s->depth], o);
}

static void add_flat_symbol(void *context, const CagSymbolView *s) {
  Place *p = context;
  cJSON *location = location_json(p->l, &s->place);
  if (!location) return;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "name", s->name);
  cJSON_AddNumberToObject(o, "kind", kinds[s->kind].symbol);
  cJSON_AddItemToObject(o, "location", location);
  cJSON_AddItemToArray(p->out, o);
}

static cJSON *document_symbols(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  if (!d) return NULL;
  if (!l->client.hierarchy) {
    Place p = {.l = l, .out = cJSON_CreateArray()};
    cag_document_symbols(l->workspace, d->file, add_flat_symbol, &p);
    return p.out;
  }
  SymbolTree t = {.l = l, .levels = {cJSON_CreateArray()}};
  cag_document_symbols(l->workspace, d->file, add_symbol, &t);
  return t.levels[0];
}

static cJSON *workspace_symbols(CagLsp *l, const cJSON *params) {
  Place p = {.l = l, .out = cJSON_CreateArray()};
  const char *query = lsp_text(params, "query");
  cag_workspace_symbols(l->workspace, query ? query : "", add_flat_symbol, &p);
  return p.out;
}

// Editors fold one part per line. The outer ones are given first.
static bool has_fold(const cJSON *list, size_t line) {
  const cJSON *last = list->child ? list->child->prev : NULL;
  for (int i = 0; last && i < 16; i++, last = last == list->child ? NULL : last->prev)
    if (lsp_get(last, "startLine")->valuedouble == (double)line) return true;
  return false;
}

static void add_fold(void *context, const CagPlace *place, CagFoldKind kind) {
  Place *p = context;
  size_t first, last, column;
  cag_document_position(p->l->workspace, place->file, place->start, p->l->columns, &first, &column);
  cag_document_position(p->l->workspace, place->file, place->end, p->l->columns, &last, &column);
  if (last <= first || has_fold(p->out, first)) return;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddNumberToObject(o, "startLine", (double)first);
  // The line of the closing bracket stays visible.
  const bool code = kind == CAG_FOLD_CODE && last > first + 1;
  cJSON_AddNumberToObject(o, "endLine", (double)(code ? last - 1 : last));
  if (kind == CAG_FOLD_COMMENT) cJSON_AddStringToObject(o, "kind", "comment");
  if (kind == CAG_FOLD_IMPORTS) cJSON_AddStringToObject(o, "kind", "imports");
  cJSON_AddItemToArray(p->out, o);
}

static cJSON *folding(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  Place p = {.l = l, .out = cJSON_CreateArray()};
  if (d) cag_document_folds(l->workspace, d->file, add_fold, &p);
  return p.out;
}

// Ranges are given from the innermost; each becomes the parent of the one before.
typedef struct Nesting {
  CagLsp *l;
  cJSON *first, *last;
} Nesting;

static void add_parent(void *context, const CagPlace *place) {
  Nesting *n = context;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "range", lsp_range_json(n->l, place));
  if (n->last) cJSON_AddItemToObject(n->last, "parent", o);
  else n->first = o;
  n->last = o;
}

static cJSON *selection(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  cJSON *out = cJSON_CreateArray();
  const cJSON *position;
  cJSON_ArrayForEach(position, lsp_get(params, "positions")) {
    Nesting n = {.l = l};
    size_t offset;
    if (!d || !lsp_offset(l, d->file, position, &offset)) continue;
    cag_document_selection(l->workspace, d->file, offset, add_parent, &n);
    if (!n.first) add_parent(&n, &(CagPlace){d->file, offset, offset});
    cJSON_AddItemToArray(out, n.first);
  }
  return out;
}

static void add_link(void *context, const CagPlace *place, const char *target) {
  Place *p = context;
  char *uri = lsp_uri_of_file(p->l, target);
  if (!uri) return;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "range", lsp_range_json(p->l, place));
  cJSON_AddStringToObject(o, "target", uri);
  cJSON_AddItemToArray(p->out, o);
  free(uri);
}

static cJSON *links(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  Place p = {.l = l, .out = cJSON_CreateArray()};
  if (d) cag_document_links(l->workspace, d->file, add_link, &p);
  return p.out;
}

// --- Semantic tokens ---

static const char *const token_types[] = {
    [CAG_WORD_KEYWORD] = "keyword",   [CAG_WORD_OPERATOR] = "operator",
    [CAG_WORD_NUMBER] = "number",     [CAG_WORD_TEXT] = "string",
    [CAG_WORD_COMMENT] = "comment",   [CAG_WORD_VALUE] = "variable",
    [CAG_WORD_FUNCTION] = "function", [CAG_WORD_PARAMETER] = "parameter",
    [CAG_WORD_MODULE] = "namespace",  [CAG_WORD_FIELD] = "property"};
static const char *const token_flags[] = {"definition", "defaultLibrary", "readonly",
                                          "documentation", "deprecated"};

typedef struct Words {
  CagLsp *l;
  unsigned *data;
  size_t count, capacity;
  size_t line, column; // of the last word
  bool failed;
} Words;

static void add_word(void *context, const CagPlace *place, CagWordKind kind, unsigned flags) {
  Words *w = context;
  size_t line, column, end_line, end;
  cag_document_position(w->l->workspace, place->file, place->start, w->l->columns, &line, &column);
  cag_document_position(w->l->workspace, place->file, place->end, w->l->columns, &end_line, &end);
  if (w->count + 5 > w->capacity) {
    const size_t capacity = 2 * w->capacity + 1000;
    unsigned *data = realloc(w->data, capacity * sizeof *data);
    w->failed |= !data;
    if (!data) return;
    w->data = data;
    w->capacity = capacity;
  }
  unsigned *d = w->data + w->count;
  d[0] = (unsigned)(line - w->line);
  d[1] = (unsigned)(line == w->line ? column - w->column : column);
  d[2] = (unsigned)(end - column);
  d[3] = (unsigned)kind;
  d[4] = flags;
  w->count += 5;
  w->line = line;
  w->column = column;
}

// Writes numbers as JSON, which for a long file is faster than a tree.
static void write_numbers(FILE *f, const unsigned *data, size_t count) {
  fputc('[', f);
  for (size_t i = 0; i < count; i++) {
    char digits[16], *at = digits + sizeof digits;
    unsigned x = data[i];
    do *--at = (char)('0' + x % 10);
    while (x /= 10);
    if (i) *--at = ',';
    fwrite(at, 1, (size_t)(digits + sizeof digits - at), f);
  }
  fputc(']', f);
}

static void keep_words(CagLsp *l, const char *file, Words *w) {
  free(l->words.data);
  free(l->words.file);
  l->words.file = lsp_copy(file);
  l->words.data = w->data;
  l->words.count = w->count;
  l->words.id++;
}

// Writes the words, or the change from those with the id `before`.
static void answer_words(CagLsp *l, const cJSON *id, const char *file, Words *w,
                         const char *before) {
  char *text = NULL, last[32];
  size_t size = 0, head = 0, tail = 0;
  snprintf(last, sizeof last, "%zu", l->words.id);
  const bool delta =
      before && l->words.file && strcmp(before, last) == 0 && strcmp(l->words.file, file) == 0;
  FILE *f = open_memstream(&text, &size);
  if (!f) {
    free(w->data);
    lsp_fail(l, id, LSP_INTERNAL_ERROR, "not enough memory");
    return;
  }
  fprintf(f, "{\"resultId\":\"%zu\",", l->words.id + 1);
  if (delta) {
    const unsigned *old = l->words.data;
    const size_t n = l->words.count;
    while (head < n && head < w->count && old[head] == w->data[head]) head++;
    head -= head % 5;
    while (tail < n - head && tail < w->count - head &&
           old[n - 1 - tail] == w->data[w->count - 1 - tail])
      tail++;
    tail -= tail % 5;
    fputs("\"edits\":[", f);
    if (n != w->count || head < n) {
      fprintf(f, "{\"start\":%zu,\"deleteCount\":%zu,\"data\":", head, n - head - tail);
      write_numbers(f, w->data + head, w->count - head - tail);
      fputc('}', f);
    }
    fputs("]}", f);
  } else {
    fputs("\"data\":", f);
    write_numbers(f, w->data, w->count);
    fputc('}', f);
  }
  fclose(f);
  keep_words(l, file, w);
  lsp_answer_raw(l, id, text);
  free(text);
}

static void semantic_tokens(CagLsp *l, const cJSON *id, const cJSON *params, bool delta) {
  const LspDocument *d = document_of(l, params);
  Words w = {.l = l};
  size_t start = 0, end = SIZE_MAX;
  const cJSON *range = lsp_get(params, "range");
  if (!d || (range && !lsp_range(l, d->file, range, &start, &end))) {
    lsp_answer(l, id, NULL);
    return;
  }
  cag_document_words(l->workspace, d->file, start, end, add_word, &w);
  if (w.failed) {
    free(w.data);
    lsp_fail(l, id, LSP_INTERNAL_ERROR, "not enough memory");
  } else if (range) {
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (f) {
      fputs("{\"data\":", f);
      write_numbers(f, w.data, w.count);
      fputc('}', f);
      fclose(f);
      lsp_answer_raw(l, id, text);
    } else lsp_fail(l, id, LSP_INTERNAL_ERROR, "not enough memory");
    free(text);
    free(w.data);
  } else answer_words(l, id, d->file, &w, delta ? lsp_text(params, "previousResultId") : NULL);
}

// --- Hints, colors, formatting ---

static void add_hint(void *context, const CagPlace *place, const char *label) {
  Place *p = context;
  cJSON *o = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "position", lsp_position_json(p->l, place->file, place->start));
  cJSON_AddStringToObject(o, "label", label);
  cJSON_AddNumberToObject(o, "kind", 2);
  cJSON_AddBoolToObject(o, "paddingRight", true);
  cJSON_AddItemToArray(p->out, o);
}

static cJSON *inlay_hints(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  Place p = {.l = l, .out = cJSON_CreateArray()};
  size_t start, end;
  if (d && l->set.hints && lsp_range(l, d->file, lsp_get(params, "range"), &start, &end))
    cag_document_hints(l->workspace, d->file, start, end, add_hint, &p);
  return p.out;
}

static void add_color(void *context, const CagPlace *place, const double rgb[3]) {
  Place *p = context;
  cJSON *o = cJSON_CreateObject(), *color = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "range", lsp_range_json(p->l, place));
  cJSON_AddNumberToObject(color, "red", rgb[0]);
  cJSON_AddNumberToObject(color, "green", rgb[1]);
  cJSON_AddNumberToObject(color, "blue", rgb[2]);
  cJSON_AddNumberToObject(color, "alpha", 1);
  cJSON_AddItemToObject(o, "color", color);
  cJSON_AddItemToArray(p->out, o);
}

static cJSON *colors(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  Place p = {.l = l, .out = cJSON_CreateArray()};
  if (d) cag_document_colors(l->workspace, d->file, add_color, &p);
  return p.out;
}

static double number_of(const cJSON *o, const char *key) {
  const cJSON *v = lsp_get(o, key);
  return cJSON_IsNumber(v) ? v->valuedouble : 0;
}

static cJSON *color_presentation(CagLsp *l, const cJSON *params) {
  const cJSON *color = lsp_get(params, "color"), *range = lsp_get(params, "range");
  const double rgb[3] = {number_of(color, "red"), number_of(color, "green"),
                         number_of(color, "blue")};
  char text[32];
  (void)l;
  cag_color_text(rgb, text, sizeof text);
  cJSON *out = cJSON_CreateArray(), *o = cJSON_CreateObject(), *edit = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "label", text);
  if (range) cJSON_AddItemToObject(edit, "range", cJSON_Duplicate(range, true));
  cJSON_AddStringToObject(edit, "newText", text);
  if (range) cJSON_AddItemToObject(o, "textEdit", edit);
  else cJSON_Delete(edit);
  cJSON_AddItemToArray(out, o);
  return out;
}

static void add_edit(void *context, const CagEdit *edit) {
  Place *p = context;
  cJSON_AddItemToArray(p->out, edit_json(p->l, edit));
}

static cJSON *formatting(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  Place p = {.l = l, .out = cJSON_CreateArray()};
  if (d && !d->is_library) cag_document_format(l->workspace, d->file, 0, SIZE_MAX, add_edit, &p);
  return p.out;
}

static cJSON *range_formatting(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  Place p = {.l = l, .out = cJSON_CreateArray()};
  size_t start, end;
  if (d && !d->is_library && lsp_range(l, d->file, lsp_get(params, "range"), &start, &end))
    cag_document_format(l->workspace, d->file, start, end, add_edit, &p);
  return p.out;
}

// Formats the statement that ends at the cursor, or before its line. The line of the cursor stays.
static void add_edit_before(void *context, const CagEdit *edit) {
  Place *p = context;
  if (edit->place.end <= p->offset) add_edit(context, edit);
}

static cJSON *on_type_formatting(CagLsp *l, const cJSON *params) {
  Place p;
  const char *typed = lsp_text(params, "ch");
  if (!read_place(l, params, &p) || p.document->is_library) return NULL;
  p.out = cJSON_CreateArray();
  size_t length, at = p.offset;
  const char *text = cag_document_text(l->workspace, p.file, &length);
  if (typed && *typed == '\n')
    while (text && at > 0 && strchr(" \t\r\n", text[at - 1])) at--;
  if (!text || at == 0 || (at < length && !strchr(" \t\r\n/;", text[at]))) return p.out;
  // What follows the cursor may belong to the statement, which is then not complete.
  size_t rest = p.offset;
  while (rest < length && strchr(" \t\r", text[rest])) rest++;
  if (rest < length && text[rest] != '\n') return p.out;
  p.offset = at;
  cag_document_format(l->workspace, p.file, at, at, add_edit_before, &p);
  return p.out;
}

// --- Actions ---

typedef struct Actions {
  Place place;
  const cJSON *context;
} Actions;

static bool is_wanted(const cJSON *context, const char *kind) {
  const cJSON *only = lsp_get(context, "only"), *item;
  if (!cJSON_IsArray(only)) return true;
  cJSON_ArrayForEach(item, only) {
    const char *wanted = cJSON_IsString(item) ? item->valuestring : "?";
    const size_t n = strlen(wanted);
    if (strncmp(kind, wanted, n) == 0 && (!kind[n] || kind[n] == '.')) return true;
  }
  return false;
}

// Adds the client's diagnostic that an action fixes.
static void add_fixed(CagLsp *l, cJSON *o, const cJSON *context, const CagActionView *a) {
  const cJSON *item;
  if (!a->code) return;
  cJSON_ArrayForEach(item, lsp_get(context, "diagnostics")) {
    const char *code = lsp_text(item, "code");
    size_t start, end;
    if (!code || strcmp(code, a->code) != 0 ||
        !lsp_range(l, a->problem.file, lsp_get(item, "range"), &start, &end) ||
        start != a->problem.start || end != a->problem.end)
      continue;
    cJSON *list = cJSON_AddArrayToObject(o, "diagnostics");
    cJSON_AddItemToArray(list, cJSON_Duplicate(item, true));
    return;
  }
}

static void add_action(void *context, const CagActionView *a) {
  Actions *all = context;
  CagLsp *l = all->place.l;
  const char *kind = a->kind == CAG_ACTION_FIX       ? "quickfix"
                     : a->kind == CAG_ACTION_EXTRACT ? "refactor.extract"
                                                     : "refactor.rewrite";
  if (!is_wanted(all->context, kind)) return;
  cJSON *o = cJSON_CreateObject(), *edit = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "title", a->title);
  cJSON_AddStringToObject(o, "kind", kind);
  if (a->is_preferred) cJSON_AddTrueToObject(o, "isPreferred");
  add_fixed(l, o, all->context, a);
  for (size_t i = 0; i < a->edit_count; i++) add_to_workspace_edit(l, edit, &a->edits[i]);
  cJSON_AddItemToObject(o, "edit", edit);
  cJSON_AddItemToArray(all->place.out, o);
}

static cJSON *code_actions(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  Actions a = {{.l = l, .out = cJSON_CreateArray()}, lsp_get(params, "context")};
  size_t start, end;
  if (d && !d->is_library && lsp_range(l, d->file, lsp_get(params, "range"), &start, &end))
    cag_document_actions(l->workspace, d->file, start, end, add_action, &a);
  return a.place.out;
}

static void add_lens(CagLsp *l, cJSON *out, const LspDocument *d, const CagPlace *place,
                     const char *title, const char *command) {
  const CagPlace start = {place->file, place->start, place->start};
  cJSON *o = cJSON_CreateObject(), *c = cJSON_CreateObject(), *arguments;
  cJSON_AddItemToObject(o, "range", lsp_range_json(l, &start));
  cJSON_AddStringToObject(c, "title", title);
  cJSON_AddStringToObject(c, "command", command);
  arguments = cJSON_AddArrayToObject(c, "arguments");
  cJSON_AddItemToArray(arguments, cJSON_CreateString(d->uri));
  cJSON_AddItemToObject(o, "command", c);
  cJSON_AddItemToArray(out, o);
}

static cJSON *code_lens(CagLsp *l, const cJSON *params) {
  const LspDocument *d = document_of(l, params);
  cJSON *out = cJSON_CreateArray();
  CagDocumentUse use;
  if (!d || d->is_library || !l->options.program || !strchr(d->file, '/') ||
      !cag_document_use(l->workspace, d->file, &use))
    return out;
  if (use.shows) {
    add_lens(l, out, d, &use.show, "Preview", "cag.preview");
    add_lens(l, out, d, &use.show, "Render", "cag.render");
  }
  if (use.tests) add_lens(l, out, d, &use.test, "Run test", "cag.runTest");
  return out;
}

// --- Dispatch ---

static const struct {
  const char *method;
  LspHandler *handle;
} handlers[] = {
    {"textDocument/completion", completion},
    {"textDocument/hover", hover},
    {"textDocument/signatureHelp", signature_help},
    {"textDocument/definition", definition},
    {"textDocument/declaration", definition},
    {"textDocument/references", references},
    {"textDocument/documentHighlight", highlight},
    {"textDocument/prepareRename", prepare_rename},
    {"textDocument/documentSymbol", document_symbols},
    {"workspace/symbol", workspace_symbols},
    {"textDocument/foldingRange", folding},
    {"textDocument/selectionRange", selection},
    {"textDocument/documentLink", links},
    {"textDocument/inlayHint", inlay_hints},
    {"textDocument/documentColor", colors},
    {"textDocument/colorPresentation", color_presentation},
    {"textDocument/formatting", formatting},
    {"textDocument/rangeFormatting", range_formatting},
    {"textDocument/onTypeFormatting", on_type_formatting},
    {"textDocument/codeAction", code_actions},
    {"textDocument/codeLens", code_lens},
};

bool lsp_handle(CagLsp *l, const char *method, const cJSON *id, const cJSON *params) {
  for (size_t i = 0; i < sizeof handlers / sizeof *handlers; i++) {
    if (strcmp(handlers[i].method, method) != 0) continue;
    cJSON *result = handlers[i].handle(l, params);
    if (!l->interrupt) lsp_answer(l, id, result);
    else {
      cJSON_Delete(result);
      lsp_fail(l, id, LSP_REQUEST_CANCELLED, "canceled");
    }
    return true;
  }
  if (strcmp(method, "textDocument/rename") == 0) rename_symbol(l, id, params);
  else if (strcmp(method, "textDocument/semanticTokens/full") == 0)
    semantic_tokens(l, id, params, false);
  else if (strcmp(method, "textDocument/semanticTokens/full/delta") == 0)
    semantic_tokens(l, id, params, true);
  else if (strcmp(method, "textDocument/semanticTokens/range") == 0)
    semantic_tokens(l, id, params, false);
  else if (strcmp(method, "workspace/executeCommand") == 0) lsp_execute(l, id, params);
  else return false;
  return true;
}

cJSON *lsp_capabilities(CagLsp *l) {
  static const char fixed[] =
      "{\"textDocumentSync\":{\"openClose\":true,\"change\":2,\"save\":{\"includeText\":false}},"
      "\"completionProvider\":{\"triggerCharacters\":[\".\",\"\\\"\",\"/\",\"(\",\",\",\":\"]},"
      "\"hoverProvider\":true,"
      "\"signatureHelpProvider\":{\"triggerCharacters\":[\"(\",\",\"],\"retriggerCharacters\":"
      "[\":\",\")\"]},"
      "\"definitionProvider\":true,\"declarationProvider\":true,\"referencesProvider\":true,"
      "\"documentHighlightProvider\":true,\"documentSymbolProvider\":true,"
      "\"workspaceSymbolProvider\":true,\"renameProvider\":{\"prepareProvider\":true},"
      "\"foldingRangeProvider\":true,\"selectionRangeProvider\":true,"
      "\"documentLinkProvider\":{},\"inlayHintProvider\":true,\"colorProvider\":true,"
      "\"documentFormattingProvider\":true,\"documentRangeFormattingProvider\":true,"
      "\"documentOnTypeFormattingProvider\":{\"firstTriggerCharacter\":\"}\","
      "\"moreTriggerCharacter\":[\"\\n\"]},"
      "\"codeActionProvider\":{\"codeActionKinds\":[\"quickfix\",\"refactor.extract\","
      "\"refactor.rewrite\"]},"
      "\"workspace\":{\"workspaceFolders\":{\"supported\":true,\"changeNotifications\":true}}}";
  cJSON *o = cJSON_Parse(fixed), *tokens = cJSON_AddObjectToObject(o, "semanticTokensProvider");
  cJSON *legend = cJSON_AddObjectToObject(tokens, "legend");
  cJSON_AddItemToObject(legend, "tokenTypes",
                        cJSON_CreateStringArray(token_types, CAG_WORD_KIND_COUNT));
  cJSON_AddItemToObject(
      legend, "tokenModifiers",
      cJSON_CreateStringArray(token_flags, sizeof token_flags / sizeof *token_flags));
  cJSON *full = cJSON_AddObjectToObject(tokens, "full");
  cJSON_AddTrueToObject(full, "delta");
  cJSON_AddTrueToObject(tokens, "range");
  cJSON_AddStringToObject(o, "positionEncoding",
                          l->columns == CAG_COLUMNS_UTF8 ? "utf-8" : "utf-16");
  if (l->options.program) {
    cJSON_AddItemToObject(o, "codeLensProvider", cJSON_CreateObject());
    cJSON_AddItemToObject(
        o, "executeCommandProvider",
        cJSON_Parse("{\"commands\":[\"cag.preview\",\"cag.render\",\"cag.runTest\"]}"));
  }
  return o;
}
