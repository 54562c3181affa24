// Descriptions of names in Markdown.

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "interp/check/constant.h"
#include "interp/doc/doc.h"
#include "interp/document/document.h"
#include "interp/vm/builtin.h"
#include "lang/lexer.h"

// A value that is printed longer is cut.
#define VALUE_MAX 200

static void add_text(CagString *out, const char *text) { cag_string_add(out, text, strlen(text)); }

static void add_code(CagString *out, const char *code, size_t length) {
  while (length && (code[length - 1] == '\n' || code[length - 1] == ' ')) length--;
  cag_string_printf(out, "```cag\n%.*s\n```\n", (int)length, code);
}

// Adds a part of the source as one line.
static void add_line(CagString *out, const char *text, size_t length) {
  bool space = false;
  for (size_t i = 0; i < length; i++) {
    if (strchr(" \t\r\n", text[i])) {
      space = true;
      continue;
    }
    if (space && out->length) add_text(out, " ");
    space = false;
    cag_string_add(out, text + i, 1);
  }
}

void cag_describe_head(const Entity *e, CagString *out) {
  const CagFunctionAst *f = cag_entity_function(e);
  add_text(out, e->decl->name);
  if (!f || !f->name) return;
  add_text(out, "(");
  for (size_t i = 0; i < f->parameter_count; i++) {
    const CagParameter *p = &f->parameters[i];
    cag_string_printf(out, "%s%s", i ? ", " : "", p->decl->name);
    if (!p->fallback) continue;
    CagString value = {0};
    const CagSpan span = p->fallback->span;
    add_line(&value, e->unit->source->text + span.start, span.end - span.start);
    cag_string_printf(out, " = %s", value.bytes ? value.bytes : "");
    cag_string_free(&value);
  }
  add_text(out, ")");
}

void cag_describe_doc(const char *doc, bool brief, CagString *out) {
  if (brief) {
    const char *paragraph = strstr(doc, "\n\n");
    size_t end = cag_doc_sentence(doc);
    if (paragraph && (size_t)(paragraph - doc) < end) end = (size_t)(paragraph - doc);
    cag_string_printf(out, "%.*s\n", (int)end, doc);
    return;
  }
  for (bool is_code; *doc;) {
    const size_t n = cag_doc_part(doc, &is_code);
    char *part = n ? cag_doc_part_text(doc, n, is_code) : NULL;
    if (!part) break;
    if (is_code) add_code(out, part, strlen(part));
    else cag_string_printf(out, "%s\n", part);
    free(part);
    doc += n;
  }
}

// Adds the parameters of a row with their types and meanings.
static void describe_parameters(size_t index, size_t row, CagString *out) {
  const CagSignature *s = cag_builtin_signature(index, row);
  if (s && s->count) add_text(out, "\n");
  for (size_t i = 0; s && i < s->count; i++) {
    const char *meaning = cag_doc_meaning(s->name, s->parameters[i]);
    cag_string_printf(out, "- `%s`: %s%s%s\n", s->parameters[i], s->words[i], *meaning ? ": " : "",
                      meaning);
  }
}

void cag_describe_builtin(size_t index, bool brief, CagString *out) {
  size_t rows;
  if (index >= cag_builtin_count()) {
    add_text(out,
             "Set by `cag render --frames`: `frame` counts from 0, and `time` runs from 0 to 1.\n");
    return;
  }
  const CagBuiltin *row = cag_builtin_rows(index, &rows);
  for (size_t i = 0; i < rows; i++) {
    const size_t sentence = cag_doc_sentence(row[i].summary);
    if (i) add_text(out, brief ? "\n" : "\n---\n\n");
    if (!brief) {
      CagString head = {0};
      add_line(&head, row[i].signature, strlen(row[i].signature));
      if (row[i].result) cag_string_printf(&head, " -> %s", row[i].result);
      if (head.bytes) add_code(out, head.bytes, head.length);
      cag_string_free(&head);
    }
    cag_string_printf(out, "%.*s\n", brief ? (int)sentence : (int)strlen(row[i].summary),
                      row[i].summary);
    if (!brief) describe_parameters(index, i, out);
    if (brief || !row[i].example) continue;
    add_text(out, "\n");
    add_code(out, row[i].example, strlen(row[i].example));
  }
}

bool cag_describe_word(const char *word, CagString *out) {
  char *text = NULL;
  size_t size = 0;
  if (!cag_word_is_reserved(word)) return false;
  FILE *f = open_memstream(&text, &size);
  if (!f) return false;
  const CagDocWriter writer = {f, false};
  const bool found = cag_doc_write_word(&writer, word, false);
  fclose(f);
  if (found) {
    const size_t head = strcspn(text, "\n");
    add_code(out, text, head);
    // The text is indented by two, and the example by four.
    const char *at = text + head + (text[head] == '\n');
    for (bool example = false; *at;) {
      const size_t n = strcspn(at, "\n"), indent = strspn(at, " ");
      if (strncmp(at, "  Example", 9) == 0) {
        add_text(out, "\n```cag\n");
        example = true;
      } else if (n > indent) {
        cag_string_printf(out, "%.*s\n", (int)(n - indent), at + indent);
      }
      at += n + (at[n] == '\n');
      if (!*at && example) add_text(out, "```\n");
    }
  }
  free(text);
  return found;
}

// --- Definitions ---

typedef struct ConstantValue {
  CagModuleUnit *unit;
  const CagExpr *e;
  CagString *out;
} ConstantValue;

static bool print_constant(CagVm *vm, void *context) {
  const ConstantValue *c = context;
  c->out->most = VALUE_MAX;
  cag_constant_print(vm, c->unit, c->e, c->out);
  return true;
}

// Adds the value of a definition if it is constant.
static void describe_value(Document *d, const Entity *e, CagString *out) {
  const CagExpr *value = cag_entity_value(e);
  const CagStatement *s = e->decl->statement;
  CagVm *vm = d->session->vm;
  if (!value || value->kind == CAG_EXPR_LAMBDA || s->damage != CAG_SOUND ||
      e->decl->kind != CAG_DECL_TOP || vm->modules[e->unit->number] != e->unit)
    return;
  CagString text = {0};
  ConstantValue c = {vm->modules[e->unit->number], value, &text};
  const CagDiagnostics kept = d->session->diagnostics;
  d->session->diagnostics = (CagDiagnostics){0};
  cag_session_work(d->session, print_constant, &c);
  cag_diagnostics_clear(&d->session->diagnostics);
  d->session->diagnostics = kept;
  if (text.bytes && text.length) {
    cag_string_printf(out, "\nValue: `%.*s%s`\n",
                      text.length > VALUE_MAX ? VALUE_MAX : (int)text.length, text.bytes,
                      text.length > VALUE_MAX ? "..." : "");
  }
  cag_string_free(&text);
}

static void describe_type(CagWorkspace *w, Document *d, const Entity *e, CagString *out) {
  char text[256];
  if (e->unit != d->unit || e->decl->kind != CAG_DECL_TOP || cag_entity_function(e)) return;
  (void)w;
  if (!d->checked) return;
  const CagTypes types = d->types[e->decl->index];
  if (types != CAG_TYPES_ANY && strcmp(cag_types_text(types, text, sizeof text), "another type"))
    cag_string_printf(out, "\nType: %s\n", text);
}

static void describe_param(const Entity *e, CagString *out) {
  const CagStatement *s = e->decl->statement;
  const CagSource *source = e->unit->source;
  add_code(out, source->text + s->span.start, s->span.end - s->span.start);
}

static void describe_parameter(const Entity *e, CagString *out) {
  cag_string_printf(out, "```cag\n%s\n```\nA parameter of %s.\n", e->decl->name,
                    e->decl->owner && e->decl->owner->name ? e->decl->owner->name : "a function");
}

static void describe_module(const CagModuleUnit *m, CagString *out) {
  cag_string_printf(out, "```cag\nimport %s\n```\n", m->name);
  const char *at = m->source->text; // the // lines at its top
  for (int lines = 0; strncmp(at, "//", 2) == 0 && at[2] != '/' && lines < 12; lines++) {
    const size_t n = strcspn(at, "\n"), skip = at[2] == ' ' ? 3 : 2;
    if (n <= skip) break;
    cag_string_printf(out, "%.*s\n", (int)(n - skip), at + skip);
    at += n + (at[n] == '\n');
  }
}

static void describe_decl(CagWorkspace *w, Document *d, const Entity *e, CagString *out) {
  const CagDecl *decl = e->decl;
  const CagVm *vm = d->session->vm;
  const CagStatement *s = decl->statement;
  if (decl->kind == CAG_DECL_IMPORT) {
    if (s->as.import.module < vm->module_count)
      describe_module(vm->modules[s->as.import.module], out);
    return;
  }
  if (decl->kind == CAG_DECL_PARAMETER) {
    describe_parameter(e, out);
    return;
  }
  if (decl->kind == CAG_DECL_TOP && s->kind == CAG_STATEMENT_PARAM) {
    describe_param(e, out);
  } else {
    CagString head = {0};
    cag_describe_head(e, &head);
    const CagExpr *value = cag_entity_value(e);
    if (value && value->kind != CAG_EXPR_LAMBDA && value->span.end - value->span.start < 80 &&
        !memchr(e->unit->source->text + value->span.start, '\n',
                value->span.end - value->span.start))
      cag_string_printf(&head, " = %.*s", (int)(value->span.end - value->span.start),
                        e->unit->source->text + value->span.start);
    if (head.bytes) add_code(out, head.bytes, head.length);
    cag_string_free(&head);
  }
  describe_type(w, d, e, out);
  describe_value(d, e, out);
  if (decl->doc) {
    add_text(out, "\n");
    cag_describe_doc(decl->doc, false, out);
  }
  if (e->unit != d->unit) cag_string_printf(out, "\nFrom `%s`\n", e->unit->name);
}

void cag_describe_entity(CagWorkspace *w, Document *d, const Entity *e, CagString *out) {
  switch (e->kind) {
  case ENTITY_NONE:
  case ENTITY_FIELD: break;
  case ENTITY_DECL: describe_decl(w, d, e, out); break;
  case ENTITY_BUILTIN: cag_describe_builtin(e->index, false, out); break;
  case ENTITY_MODULE: describe_module(e->unit, out); break;
  case ENTITY_ARGUMENT:
    if (e->index < cag_builtin_count())
      cag_string_printf(out, "`%s`: %s\n\nA parameter of %s.\n", e->name,
                        cag_doc_meaning(cag_builtin_name(e->index), e->name),
                        cag_builtin_name(e->index));
    break;
  }
}
