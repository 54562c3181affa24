// What is at a place, and the signatures of calls.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "interp/doc/doc.h"
#include "interp/document/document.h"
#include "interp/vm/builtin.h"

// --- Hover ---

typedef struct Hover {
  CagWorkspace *w;
  Document *d;
  size_t offset;
  CagString text;
  CagSpan span;
  bool found;
} Hover;

// Describes a number with a unit: what it is in millimeters or degrees.
static void hover_number(Hover *h, const CagToken *t) {
  const char *text = h->d->text + t->span.start;
  const size_t n = t->span.end - t->span.start, digits = strspn(text, "0123456789.eE_xXbB");
  if (digits >= n) return; // no unit
  if (t->kind == CAG_TOKEN_NUMBER)
    cag_string_printf(&h->text, "`%.*s` is %.12g mm\n", (int)n, text, t->as.number);
  else
    cag_string_printf(&h->text, "`%.*s` is %.12g degrees, %.12g radians\n", (int)n, text,
                      t->as.number, t->as.number * M_PI / 180);
}

static void hover_token(Hover *h) {
  CagArena memory = {0};
  const Tokens ts = cag_document_tokens(h->d, h->offset + 1, &memory);
  const CagToken *t = ts.count ? &ts.items[ts.count - 1] : NULL;
  if (t && h->offset <= t->span.end) {
    h->span = t->span;
    if (t->kind == CAG_TOKEN_NUMBER || t->kind == CAG_TOKEN_ANGLE) hover_number(h, t);
    if (t->kind >= CAG_TOKEN_FIRST_WORD) cag_describe_word(t->as.name, &h->text);
  }
  cag_arena_free(&memory);
}

typedef struct FieldHover {
  const char *name;
  CagString *out;
  const CagExpr *value;
  const CagModuleUnit *unit;
} FieldHover;

typedef struct MemberAt {
  size_t offset;
  const CagExpr *object;
} MemberAt;

static void find_object(void *context, const CagExpr *e) {
  MemberAt *m = context;
  if (e->span.start > m->offset || m->offset > e->span.end) return;
  if (e->kind == CAG_EXPR_MEMBER && e->as.member.name_span.start <= m->offset)
    m->object = e->as.member.object;
  else cag_tree_below(e, find_object, m);
}

static void take_value(void *context, const char *name, const CagExpr *value,
                       const CagModuleUnit *unit) {
  FieldHover *f = context;
  if (strcmp(name, f->name) != 0) return;
  f->value = value;
  f->unit = unit;
}

static void hover_field(Hover *h, const char *name) {
  const CagStatement *s = cag_tree_statement(h->d->unit->ast, h->offset);
  MemberAt m = {h->offset, NULL};
  FieldHover f = {.name = name, .out = &h->text};
  if (s) cag_tree_of_statement(s, find_object, &m);
  if (m.object) cag_fields_of(h->d->session->vm, h->d->unit, m.object, take_value, &f);
  if (!f.value) return;
  const size_t n = f.value->span.end - f.value->span.start;
  cag_string_printf(&h->text, "```cag\n%s: %.*s\n```\n", name, n > 200 ? 200 : (int)n,
                    f.unit->source->text + f.value->span.start);
}

static void hover(void *context) {
  Hover *h = context;
  const Occurrence *o = cag_document_occurrence(h->d, h->offset);
  if (o) {
    h->span = o->span;
    if (o->entity.kind == ENTITY_DECL) cag_document_make_checked(h->w, h->d);
    o = cag_document_occurrence(h->d, h->offset);
  }
  if (o && o->entity.kind == ENTITY_FIELD) hover_field(h, o->entity.name);
  else if (o) cag_describe_entity(h->w, h->d, &o->entity, &h->text);
  else hover_token(h);
}

bool cag_document_hover(CagWorkspace *w, const char *file, size_t offset,
                        void (*give)(void *context, const CagPlace *place, const char *markdown),
                        void *context) {
  Hover h = {.w = w, .d = cag_document_get(w, file), .offset = offset};
  const bool done = h.d && cag_document_guard(hover, &h) && h.text.length;
  if (done) {
    const CagPlace place = {h.d->file, h.span.start, h.span.end};
    give(context, &place, h.text.bytes);
  }
  cag_string_free(&h.text);
  return done;
}

// --- Signatures ---

typedef struct Signatures {
  CagWorkspace *w;
  Document *d;
  size_t offset;
  void (*give)(void *context, const CagSignatureView *s);
  void *context;
  CagArena memory;
} Signatures;

// Finds parameter number i in a label such as "box(size: length, centered: bool = false)".
static struct CagSignatureParameter parameter_at(const char *label, const char *name) {
  const size_t n = strlen(name);
  const char *at = strchr(label, '(');
  for (int depth = 0; at && *at; at++) {
    const bool begins = *at == '(' || *at == ',';
    if (strchr("([{", *at)) depth++;
    if (strchr(")]}", *at)) depth--;
    if (!begins || depth != 1) continue;
    const char *word = at + 1 + strspn(at + 1, " ");
    if (strncmp(word, name, n) != 0 || !strchr(" ,:=)", word[n])) continue;
    size_t end = (size_t)(word - label);
    for (int inner = 0; label[end] && (inner > 0 || !strchr(",)", label[end])); end++)
      inner += strchr("([{", label[end]) ? 1 : strchr(")]}", label[end]) ? -1 : 0;
    return (struct CagSignatureParameter){(size_t)(word - label), end, NULL};
  }
  return (struct CagSignatureParameter){0, 0, NULL};
}

static size_t active_of(const CursorCall *call, const char *const *names, size_t count,
                        bool variadic) {
  if (!call->label) return call->position < count ? call->position : variadic && count ? 0 : count;
  for (size_t i = 0; i < count; i++)
    if (strcmp(names[i], call->label) == 0) return i;
  return count;
}

static const char *builtin_meaning(Signatures *s, const CagSignature *sig, size_t k) {
  CagString text = {0};
  const char *meaning = cag_doc_meaning(sig->name, sig->parameters[k]);
  cag_string_printf(&text, "%s%s%s", sig->words[k], *meaning ? ": " : "", meaning);
  const char *copy = text.bytes ? cag_arena_copy(&s->memory, text.bytes, text.length) : NULL;
  cag_string_free(&text);
  return copy;
}

static void give_builtin(Signatures *s, const CursorCall *call) {
  size_t rows;
  if (call->callee.index >= cag_builtin_count()) return;
  const CagBuiltin *row = cag_builtin_rows(call->callee.index, &rows);
  bool chosen = false;
  for (size_t i = 0; row->function && i < rows; i++) {
    const CagSignature *sig = cag_builtin_signature(call->callee.index, i);
    struct CagSignatureParameter *p = cag_arena_alloc(&s->memory, (sig->count + 1) * sizeof *p);
    CagString label = {0}, doc = {0};
    cag_string_printf(&label, "%s%s%s", row[i].signature, row[i].result ? " -> " : "",
                      row[i].result ? row[i].result : "");
    for (size_t k = 0; label.bytes && k < label.length; k++)
      if (label.bytes[k] == '\n') label.bytes[k] = ' ';
    cag_string_printf(&doc, "%.*s", (int)cag_doc_sentence(row[i].summary), row[i].summary);
    for (size_t k = 0; label.bytes && k < sig->count; k++) {
      p[k] = parameter_at(label.bytes, sig->parameters[k]);
      p[k].documentation = builtin_meaning(s, sig, k);
    }
    const size_t active = active_of(call, sig->parameters, sig->count, sig->variadic);
    const bool fits = !chosen && (active < sig->count || sig->count == 0);
    chosen |= fits;
    const CagSignatureView view = {
        label.bytes ? label.bytes : "", doc.bytes, sig->count, p, active, fits};
    s->give(s->context, &view);
    cag_string_free(&label);
    cag_string_free(&doc);
  }
}

// Finds what an item "- `width`: ..." of the documentation says about a parameter.
static char *meaning_of(Signatures *s, const Entity *e, const char *name) {
  const CagDocParameter *row = cag_doc_module_parameter(e->unit->name, e->decl->name, name);
  if (row) {
    char *text = NULL;
    if (cag_asprintf(&text, "%s: %s", row->type, row->meaning) < 0) return NULL;
    char *copy = cag_arena_copy(&s->memory, text, strlen(text));
    cag_free(text);
    return copy;
  }
  char item[160];
  snprintf(item, sizeof item, "- `%s`: ", name);
  const char *at = e->decl->doc ? strstr(e->decl->doc, item) : NULL;
  if (!at) return NULL;
  at += strlen(item);
  return cag_arena_copy(&s->memory, at, strcspn(at, "\n"));
}

static void give_function(Signatures *s, const CursorCall *call) {
  const CagFunctionAst *f = cag_entity_function(&call->callee);
  if (!f) return;
  CagString label = {0}, doc = {0};
  const char **names = cag_arena_alloc(&s->memory, (f->parameter_count + 1) * sizeof *names);
  struct CagSignatureParameter *p =
      cag_arena_alloc(&s->memory, (f->parameter_count + 1) * sizeof *p);
  cag_describe_head(&call->callee, &label);
  if (!f->name) { // a definition of a function: adder = (a, b) => a + b
    cag_string_printf(&label, "(");
    for (size_t i = 0; i < f->parameter_count; i++)
      cag_string_printf(&label, "%s%s", i ? ", " : "", f->parameters[i].decl->name);
    cag_string_printf(&label, ")");
  }
  if (call->callee.decl->doc) cag_describe_doc(call->callee.decl->doc, true, &doc);
  for (size_t i = 0; i < f->parameter_count; i++) {
    names[i] = f->parameters[i].decl->name;
    if (label.bytes) p[i] = parameter_at(label.bytes, names[i]);
    p[i].documentation = meaning_of(s, &call->callee, names[i]);
  }
  const CagSignatureView view = {label.bytes ? label.bytes : "",
                                 doc.bytes,
                                 f->parameter_count,
                                 p,
                                 active_of(call, names, f->parameter_count, false),
                                 true};
  s->give(s->context, &view);
  cag_string_free(&label);
  cag_string_free(&doc);
}

static void give_signatures(void *context) {
  Signatures *s = context;
  Cursor c;
  CursorCall call;
  cag_document_cursor(s->d, s->offset, &s->memory, &c);
  if (c.in_comment || !cag_document_call(s->d, &c, &s->memory, &call)) return;
  if (call.callee.kind == ENTITY_BUILTIN) give_builtin(s, &call);
  else give_function(s, &call);
}

void cag_document_signatures(CagWorkspace *w, const char *file, size_t offset,
                             void (*give)(void *context, const CagSignatureView *s),
                             void *context) {
  Signatures s = {w, cag_document_get(w, file), offset, give, context, {0}};
  if (s.d) cag_document_guard(give_signatures, &s);
  cag_arena_free(&s.memory);
}
