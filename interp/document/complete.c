// Completion: what can be written at a cursor.

#include <ctype.h>
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "interp/doc/doc.h"
#include "interp/document/document.h"
#include "interp/scene/color.h"
#include "interp/vm/builtin.h"
#include "interp/vm/stdlib.h"

// Ranks: what is likely at the cursor comes first.
enum { RANK_ARGUMENT, RANK_LOCAL, RANK_MODULE_NAME, RANK_BUILTIN, RANK_WORD, RANK_IMPORT };

typedef struct Completion {
  CagWorkspace *w;
  Document *d;
  size_t offset;
  void (*give)(void *context, const CagCompletion *c);
  void *context;
  CagArena memory;
  Cursor cursor;
  CagPlace place;     // what is replaced
  const char **given; // names that were given, in a hash table
  size_t given_count, given_size;
} Completion;

// --- Proposals ---

static size_t slot_of(const Completion *c, const char *name) {
  uint32_t hash = CAG_NAME_HASH;
  for (const char *at = name; *at; at++) hash = cag_name_hash(hash, (unsigned char)*at);
  size_t i = hash & (c->given_size - 1);
  while (c->given[i] && strcmp(c->given[i], name) != 0) i = (i + 1) & (c->given_size - 1);
  return i;
}

// Returns whether a name was given before, and notes it.
static bool is_again(Completion *c, const char *name) {
  if (2 * (c->given_count + 1) > c->given_size) {
    const char **old = c->given;
    const size_t old_size = c->given_size;
    c->given_size = old_size ? 2 * old_size : 1024;
    c->given = cag_arena_alloc(&c->memory, c->given_size * sizeof *c->given);
    for (size_t i = 0; i < old_size; i++)
      if (old[i]) c->given[slot_of(c, old[i])] = old[i];
  }
  const size_t i = slot_of(c, name);
  if (c->given[i]) return true;
  c->given[i] = cag_arena_copy(&c->memory, name, strlen(name));
  c->given_count++;
  return false;
}

// Tests whether a label has the letters before the cursor in order, ignoring case.
static bool matches(const Completion *c, const char *label) {
  const char *letter = c->d->text + c->place.start, *end = c->d->text + c->offset;
  for (; letter < end; label++) {
    if (!*label) return false;
    if (tolower((unsigned char)*label) == tolower((unsigned char)*letter)) letter++;
  }
  return true;
}

static void propose(Completion *c, CagCompletion item) {
  if (!matches(c, item.label)) return;
  item.place = c->place;
  if (!item.text) item.text = item.label;
  c->give(c->context, &item);
}

// Tests whether a call can be inserted: no parenthesis follows, and the name is not imported.
static bool may_call(const Completion *c) {
  const Cursor *cursor = &c->cursor;
  const size_t first = cursor->statement;
  return c->d->text[c->offset] != '(' &&
         !(first < cursor->before && cursor->tokens.items[first].kind == CAG_TOKEN_IMPORT);
}

// Tests whether the name comes after `|>`, which gives the first argument.
static bool is_piped(const Completion *c) {
  const CagToken *t = c->cursor.tokens.items;
  size_t i = c->cursor.before;
  while (i >= 2 && t[i - 1].kind == CAG_TOKEN_DOT && t[i - 2].kind == CAG_TOKEN_NAME) i -= 2;
  return i > 0 && t[i - 1].kind == CAG_TOKEN_PIPE;
}

// Returns the first signature of a built-in that needs more than `given` arguments, or the first.
static const CagSignature *signature_for(const Entity *e, size_t given) {
  size_t rows;
  if (e->kind != ENTITY_BUILTIN || e->index >= cag_builtin_count()) return NULL;
  cag_builtin_rows(e->index, &rows);
  for (size_t i = 0; i < rows; i++) {
    const CagSignature *s = cag_builtin_signature(e->index, i);
    if (s && s->required > given) return s;
  }
  return cag_builtin_signature(e->index, 0);
}

// Writes a call with a gap for each argument that is needed: "cone(${1:height}, ${2:radius})".
static void write_call(const Completion *c, const char *name, const Entity *e, CagString *out) {
  const CagFunctionAst *f = cag_entity_function(e);
  const size_t first = is_piped(c);
  const CagSignature *s = signature_for(e, first);
  const size_t required = f ? f->required_count : s ? s->required : 0;
  const size_t count = f ? f->parameter_count : s ? s->count : 0;
  if (!f && !s) return;
  cag_string_printf(out, "%s(", name);
  for (size_t i = first; i < required; i++)
    cag_string_printf(out, "%s${%zu:%s}", i > first ? ", " : "", i - first + 1,
                      f ? f->parameters[i].decl->name : s->parameters[i]);
  cag_string_printf(out, required > first || count <= first ? ")" : "$0)");
}

static void propose_entity(Completion *c, const char *label, const Entity *e, int rank) {
  CagString head = {0}, doc = {0}, call = {0};
  const CagNameKind kind = cag_entity_kind(e);
  size_t rows;
  bool deprecated = false;
  if (!matches(c, label)) return;
  if (may_call(c)) write_call(c, label, e, &call);
  if (e->kind == ENTITY_DECL) {
    if (cag_entity_function(e)) cag_describe_head(e, &head);
    if (e->decl->doc) cag_describe_doc(e->decl->doc, true, &doc);
    deprecated = e->decl->doc && strstr(e->decl->doc, "deprecated:");
  } else if (e->kind == ENTITY_BUILTIN && e->index < cag_builtin_count()) {
    const CagBuiltin *row = cag_builtin_rows(e->index, &rows);
    cag_string_printf(&head, "%s", row->signature);
    cag_describe_builtin(e->index, true, &doc);
    deprecated = strncmp(row->summary, "Deprecated: ", 12) == 0;
  }
  propose(c, (CagCompletion){.label = label,
                             .detail = head.bytes,
                             .documentation = doc.bytes,
                             .kind = kind,
                             .text = call.bytes,
                             .is_snippet = call.bytes,
                             .rank = rank,
                             .deprecated = deprecated});
  cag_string_free(&head);
  cag_string_free(&doc);
  cag_string_free(&call);
}

// --- Names ---

static void propose_decl(void *context, const CagDecl *decl) {
  Completion *c = context;
  if (is_again(c, decl->name)) return;
  Entity e = cag_entity_of_decl(c->d->session->vm, c->d->unit, decl);
  const bool local = decl->kind == CAG_DECL_PARAMETER || decl->kind == CAG_DECL_BLOCK ||
                     decl->kind == CAG_DECL_CLAUSE;
  propose_entity(c, decl->name, &e, local ? RANK_LOCAL : RANK_MODULE_NAME);
}

static void propose_builtins(Completion *c) {
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    const char *name = cag_builtin_name(i);
    const Entity e = {.kind = ENTITY_BUILTIN, .index = i, .name = name};
    if (!is_again(c, name)) propose_entity(c, name, &e, RANK_BUILTIN);
  }
  static const char *const frames[] = {"time", "frame", "frames"};
  for (size_t i = 0; i < 3; i++)
    if (!is_again(c, frames[i]))
      propose(c, (CagCompletion){.label = frames[i], .kind = CAG_NAME_PARAM, .rank = RANK_BUILTIN});
}

static void propose_word(Completion *c, const char *word) {
  CagString doc = {0};
  if (!matches(c, word)) return;
  cag_describe_word(word, &doc);
  propose(c,
          (CagCompletion){
              .label = word, .documentation = doc.bytes, .kind = CAG_NAME_WORD, .rank = RANK_WORD});
  cag_string_free(&doc);
}

static void propose_words(Completion *c, bool statement) {
  static const char *const in_expression[] = {"and", "by",   "else", "false", "for",  "if",
                                              "in",  "none", "not",  "or",    "then", "true"};
  static const char *const at_start[] = {"assert", "import", "param", "print", "show"};
  for (size_t i = 0; !statement && i < sizeof in_expression / sizeof *in_expression; i++)
    propose_word(c, in_expression[i]);
  for (size_t i = 0; statement && i < sizeof at_start / sizeof *at_start; i++)
    propose_word(c, at_start[i]);
}

static void propose_snippet(Completion *c, const char *label, const char *detail,
                            const char *text) {
  propose(c, (CagCompletion){.label = label,
                             .detail = detail,
                             .kind = CAG_NAME_SNIPPET,
                             .text = text,
                             .is_snippet = true,
                             .rank = RANK_WORD});
}

static void propose_statements(Completion *c) {
  propose_snippet(c, "param ...", "a value that can be set from outside",
                  "param ${1:name} = ${2:10} in ${3:1..100}  \"${4:what it is, mm}\"");
  propose_snippet(c, "f(x) = ...", "a function", "${1:f}(${2:x}) = $0");
  propose_snippet(c, "import std...", "a module of the library",
                  "import std.${1:materials} as ${2:mat}");
  propose_snippet(c, "assert ...", "a condition that must hold",
                  "assert ${1:true}, \"${2:message}\"");
}

static void propose_forms(Completion *c) {
  propose_snippet(c, "if ... then ... else", "selects a value",
                  "if ${1:true} then ${2:a} else ${3:b}");
  propose_snippet(c, "[for ...]", "a list", "[for ${1:i} in ${2:0..<10}: ${0:i}]");
}

// --- Names of modules that are not imported ---

typedef struct NewImport {
  size_t at;        // where the statement is inserted
  const char *word; // the text before the cursor
  size_t length;
} NewImport;

// The imports are at the top, after the comment that documents the file.
static size_t import_place(const Document *d) {
  const CagModuleAst *ast = d->unit->ast;
  size_t end = 0;
  bool any = false;
  for (size_t i = 0; ast && i < ast->count; i++)
    if (ast->statements[i]->kind == CAG_STATEMENT_IMPORT) {
      end = ast->statements[i]->span.end;
      any = true;
    }
  if (any)
    return end + strcspn(d->text + end, "\n") +
           (d->text[end + strcspn(d->text + end, "\n")] == '\n');
  while (strncmp(d->text + end, "//", 2) == 0 && d->text[end + 2] != '/') {
    end += strcspn(d->text + end, "\n");
    end += d->text[end] == '\n';
  }
  while (d->text[end] == '\n') end++;
  return end;
}

static void propose_import(Completion *c, const char *module, const CagModuleUnit *unit,
                           const NewImport *n) {
  for (size_t i = 0; i < unit->public_count; i++) {
    const char *name = unit->publics[i].name;
    if (strncmp(name, n->word, n->length) != 0 || is_again(c, name)) continue;
    const Entity e = {.kind = ENTITY_DECL, .unit = unit, .decl = unit->publics[i].decl};
    char text[256], detail[160];
    snprintf(text, sizeof text, "import %s: %s\n", module, name);
    snprintf(detail, sizeof detail, "import %s", module);
    const CagEdit import = {{c->d->file, n->at, n->at}, text};
    CagString doc = {0}, call = {0};
    if (e.decl->doc) cag_describe_doc(e.decl->doc, true, &doc);
    if (may_call(c)) write_call(c, name, &e, &call);
    propose(c, (CagCompletion){.label = name,
                               .detail = detail,
                               .documentation = doc.bytes,
                               .kind = cag_entity_kind(&e),
                               .text = call.bytes,
                               .is_snippet = call.bytes,
                               .rank = RANK_IMPORT,
                               .import = &import});
    cag_string_free(&doc);
    cag_string_free(&call);
  }
}

// Proposes public names of the library from three letters on.
static void propose_imports(Completion *c) {
  const CagSpan word = c->cursor.word;
  const NewImport n = {import_place(c->d), c->d->text + word.start, c->offset - word.start};
  if (n.length < 3) return;
  for (const CagStdlibFile *f = cag_stdlib; f->module; f++) {
    Document *module = cag_document_get(c->w, f->module);
    if (module) propose_import(c, f->module, module->unit, &n);
  }
}

// --- Members ---

static void propose_field(void *context, const char *name, const CagExpr *value,
                          const CagModuleUnit *unit) {
  Completion *c = context;
  char detail[80];
  if (is_again(c, name) || name[0] == '_') return;
  const size_t n = value->span.end - value->span.start;
  snprintf(detail, sizeof detail, "%.*s", n < sizeof detail ? (int)n : (int)sizeof detail - 1,
           unit->source->text + value->span.start);
  detail[strcspn(detail, "\n")] = 0;
  propose(c, (CagCompletion){.label = name, .detail = detail, .kind = CAG_NAME_FIELD});
}

static void propose_module_names(Completion *c, const CagModuleUnit *m) {
  for (size_t i = 0; i < m->public_count; i++) {
    const Entity e = {.kind = ENTITY_DECL, .unit = m, .decl = m->publics[i].decl};
    if (!is_again(c, e.decl->name)) propose_entity(c, e.decl->name, &e, RANK_ARGUMENT);
  }
}

// Members of values whose type is all that is known: coordinates, and ends of a range.
static void propose_members_of_type(Completion *c, CagTypes types) {
  static const char *const coordinates[] = {"x", "y", "z"},
                           *const ends[] = {"start", "end", "step"},
                           *const axes[] = {"x", "y", "z", "origin"};
  const char *const *names = types == CAG_TYPES(RANGE)       ? ends
                             : types == CAG_TYPES(TRANSFORM) ? axes
                             : types & CAG_TYPES(LIST)       ? coordinates
                                                             : NULL;
  const size_t count = names == axes ? 4 : 3;
  for (size_t i = 0; names && i < count; i++)
    if (!is_again(c, names[i]))
      propose(c, (CagCompletion){.label = names[i], .kind = CAG_NAME_FIELD});
}

typedef struct FieldOf {
  const char *name;
  const CagExpr *value;
  const CagModuleUnit *unit;
} FieldOf;

static void take_named(void *context, const char *name, const CagExpr *value,
                       const CagModuleUnit *unit) {
  FieldOf *f = context;
  if (strcmp(f->name, name) != 0) return;
  f->value = value;
  f->unit = unit;
}

static CagTypes types_of(Completion *c, const Entity *e) {
  if (e->kind != ENTITY_DECL || e->unit != c->d->unit || e->decl->kind != CAG_DECL_TOP)
    return CAG_TYPES_ANY;
  return c->d->checked ? c->d->types[e->decl->index] : CAG_TYPES_ANY;
}

// Completes after `a.b.`, where token number `end` - 1 is the last dot.
static void complete_member(Completion *c, size_t end) {
  const CagToken *t = c->cursor.tokens.items;
  const CagVm *vm = c->d->session->vm;
  size_t first = end - 1; // of the chain of names
  while (first > 0 && t[first - 1].kind == CAG_TOKEN_NAME) {
    first--;
    if (first == 0 || t[first - 1].kind != CAG_TOKEN_DOT) break;
    first--;
  }
  if (first + 1 >= end || t[first].kind != CAG_TOKEN_NAME) {
    propose_members_of_type(c, CAG_TYPES(LIST));
    return;
  }
  Entity e =
      cag_document_lookup(c->d, t[first].span.start, t[first].as.name, strlen(t[first].as.name));
  if (first + 2 == end && e.kind == ENTITY_DECL && e.decl->kind == CAG_DECL_IMPORT) {
    const size_t k = e.decl->statement->as.import.module;
    if (k < vm->module_count) propose_module_names(c, vm->modules[k]);
    return;
  }
  // Follow the chain from value to value.
  const CagModuleUnit *unit = e.unit;
  const CagExpr *value = cag_entity_value(&e);
  if (e.kind == ENTITY_DECL && e.decl->kind == CAG_DECL_IMPORT && first + 4 <= end) {
    const size_t k = e.decl->statement->as.import.module;
    const CagModuleUnit *m = k < vm->module_count ? vm->modules[k] : NULL;
    for (size_t i = 0; m && i < m->public_count; i++)
      if (strcmp(m->publics[i].name, t[first + 2].as.name) == 0 &&
          m->publics[i].decl->statement->kind == CAG_STATEMENT_DEFINITION)
        value = cag_tree_value(m->publics[i].decl);
    unit = m;
    first += 2;
  }
  for (size_t i = first + 2; value && i + 1 < end; i += 2) {
    FieldOf f = {.name = t[i].as.name};
    cag_fields_of(vm, unit, value, take_named, &f);
    value = f.value;
    unit = f.unit;
  }
  const size_t before = c->given_count;
  if (value) cag_fields_of(vm, unit, value, propose_field, c);
  const CagTypes types = types_of(c, &e);
  if (c->given_count == before && (types == CAG_TYPES_ANY || first + 2 == end))
    propose_members_of_type(c, value && value->kind == CAG_EXPR_LIST ? CAG_TYPES(LIST) : types);
}

// --- Arguments ---

static bool is_given(const Completion *c, const CursorCall *call, const char *name) {
  for (size_t i = 0; i < call->label_count; i++)
    if (strcmp(c->cursor.tokens.items[call->labels[i]].as.name, name) == 0) return true;
  return false;
}

static void propose_label(Completion *c, const char *name, const char *detail,
                          const char *meaning) {
  char label[160];
  snprintf(label, sizeof label, "%s: ", name);
  if (is_again(c, label)) return;
  propose(c, (CagCompletion){.label = label,
                             .detail = detail,
                             .documentation = meaning,
                             .kind = CAG_NAME_PARAMETER,
                             .rank = RANK_ARGUMENT});
}

static void propose_arguments(Completion *c, const CursorCall *call) {
  size_t rows = 0;
  const CagFunctionAst *f = cag_entity_function(&call->callee);
  for (size_t i = call->position; f && i < f->parameter_count; i++) {
    const char *name = f->parameters[i].decl->name;
    if (f->parameters[i].pattern) continue; // given by position
    const CagDocParameter *row =
        cag_doc_module_parameter(call->callee.unit->name, call->callee.decl->name, name);
    if (!is_given(c, call, name))
      propose_label(c, name, row ? row->type : NULL, row ? row->meaning : NULL);
  }
  if (call->callee.kind != ENTITY_BUILTIN || call->callee.index >= cag_builtin_count()) return;
  cag_builtin_rows(call->callee.index, &rows);
  for (size_t k = 0; k < rows; k++) {
    const CagSignature *s = cag_builtin_signature(call->callee.index, k);
    for (size_t i = call->position; s && i < s->count; i++)
      if (!s->positional_only[i] && !is_given(c, call, s->parameters[i]))
        propose_label(c, s->parameters[i], s->words[i], cag_doc_meaning(s->name, s->parameters[i]));
  }
}

// Proposes the texts that the current parameter accepts. With `quoted`, with their quotes.
static void propose_choices(Completion *c, const CursorCall *call, bool quoted) {
  size_t rows = 0;
  char text[160];
  if (call->callee.kind != ENTITY_BUILTIN || call->callee.index >= cag_builtin_count()) return;
  cag_builtin_rows(call->callee.index, &rows);
  for (size_t k = 0; k < rows; k++) {
    const CagSignature *s = cag_builtin_signature(call->callee.index, k);
    for (size_t i = 0; s && i < s->count; i++) {
      if (call->label ? strcmp(call->label, s->parameters[i]) != 0 : i != call->position) continue;
      for (const char *at = s->words[i]; (at = strchr(at, '"'));) {
        const size_t n = strcspn(at + 1, "\"");
        snprintf(text, sizeof text, quoted ? "\"%.*s\"" : "%.*s", (int)n, at + 1);
        if (!is_again(c, text))
          propose(c,
                  (CagCompletion){.label = text, .kind = CAG_NAME_CHOICE, .rank = RANK_ARGUMENT});
        at += n + 1 + (at[n + 1] == '"');
      }
    }
  }
}

// --- In a text ---

static const char *folder_of(Completion *c) {
  const char *path = c->d->path, *slash = path ? strrchr(path, '/') : NULL;
  return slash ? cag_arena_copy(&c->memory, path, (size_t)(slash - path)) : NULL;
}

static bool is_inside(const char *path, const char *folder) {
  char *real = realpath(path, NULL);
  const size_t n = strlen(folder);
  const bool inside =
      real && strncmp(real, folder, n) == 0 && (real[n] == '/' || real[n] == 0 || n == 1);
  free(real);
  return inside;
}

// Proposes files and folders. `written`: the path so far; `extension`: of the files, NULL: all.
static void propose_files(Completion *c, const char *folder, const char *written,
                          const char *extension) {
  char path[4096];
  const char *slash = strrchr(written, '/');
  const int head = slash ? (int)(slash - written + 1) : 0;
  snprintf(path, sizeof path, "%s/%.*s", written[0] == '/' ? "" : folder, head, written);
  if (c->w->options.folder && !is_inside(path, c->w->options.folder)) return;
  DIR *dir = opendir(path);
  const struct dirent *entry;
  for (size_t count = 0; dir && count < 1000 && (entry = readdir(dir)); count++) {
    char name[300], whole[4400];
    struct stat st;
    if (entry->d_name[0] == '.') continue;
    snprintf(whole, sizeof whole, "%s/%s", path, entry->d_name);
    if (stat(whole, &st) != 0) continue;
    const bool is_folder = S_ISDIR(st.st_mode);
    const size_t n = strlen(entry->d_name), e = extension ? strlen(extension) : 0;
    if (!is_folder && e && (n < e || strcmp(entry->d_name + n - e, extension) != 0)) continue;
    snprintf(name, sizeof name, "%s%s", entry->d_name, is_folder ? "/" : "");
    propose(c, (CagCompletion){.label = name, .kind = CAG_NAME_FILE});
  }
  if (dir) closedir(dir);
}

static void propose_colors(Completion *c) {
  size_t count;
  const char *const *names = cag_color_names(&count);
  for (size_t i = 0; i < count; i++)
    propose(c, (CagCompletion){.label = names[i], .kind = CAG_NAME_CHOICE, .detail = "a color"});
}

static bool expects_color(const CursorCall *call, const Completion *c) {
  const CagToken *t = c->cursor.tokens.items;
  const size_t n = c->cursor.before;
  if (call->name && (strcmp(call->name, "color") == 0 || strcmp(call->name, "sky") == 0))
    return true;
  // After `color: `, in a call or a record.
  return n >= 2 && t[n - 1].kind == CAG_TOKEN_COLON && t[n - 2].kind == CAG_TOKEN_NAME &&
         strstr(t[n - 2].as.name, "color");
}

// Tests whether the library describes the current parameter as a color.
static bool is_color_parameter(const CursorCall *call) {
  const CagFunctionAst *f = cag_entity_function(&call->callee);
  if (!f) return false;
  const char *name = call->label;
  if (!name && call->position < f->parameter_count) name = f->parameters[call->position].decl->name;
  return name && strstr(name, "color");
}

static void complete_text(Completion *c) {
  const CagToken *text = c->cursor.text;
  const size_t start = text->span.start + 1;
  const char *written = cag_arena_copy(&c->memory, c->d->text + start, c->offset - start);
  const char *slash = strrchr(written, '/'), *folder = folder_of(c);
  const CagToken *t = c->cursor.tokens.items;
  CursorCall call = {0};
  const bool called = cag_document_call(c->d, &c->cursor, &c->memory, &call);
  const bool import =
      c->cursor.statement < c->cursor.before && t[c->cursor.statement].kind == CAG_TOKEN_IMPORT;
  c->place.start = start;
  if (import || (called && strncmp(call.name, "read_", 5) == 0)) {
    if (slash) c->place.start = start + (size_t)(slash - written) + 1;
    if (folder) propose_files(c, folder, written, import ? ".cag" : NULL);
    return;
  }
  if (called) propose_choices(c, &call, false);
  if (expects_color(&call, c) || (called && is_color_parameter(&call))) propose_colors(c);
}

// --- Imports ---

static void propose_library(Completion *c) {
  for (const CagStdlibFile *f = cag_stdlib; f->module; f++) {
    CagString doc = {0};
    const char *end = strchr(f->text, '\n');
    if (strncmp(f->text, "// ", 3) == 0 && end)
      cag_string_printf(&doc, "%.*s", (int)(end - f->text - 3), f->text + 3);
    propose(c, (CagCompletion){
                   .label = f->module, .documentation = doc.bytes, .kind = CAG_NAME_MODULE});
    cag_string_free(&doc);
  }
}

// Proposes modules beside the document, whose names are words.
static void propose_siblings(Completion *c, const char *written) {
  char path[4096], name[300];
  const char *folder = folder_of(c), *dot = strrchr(written, '.');
  if (!folder) return;
  snprintf(path, sizeof path, "%s/%.*s", folder, dot ? (int)(dot - written) : 0, written);
  for (char *at = path + strlen(folder); *at; at++)
    if (*at == '.') *at = '/';
  DIR *dir = opendir(path);
  const struct dirent *entry;
  for (size_t count = 0; dir && count < 1000 && (entry = readdir(dir)); count++) {
    const size_t n = strlen(entry->d_name);
    if (n < 5 || n > 200 || strcmp(entry->d_name + n - 4, ".cag") != 0) continue;
    snprintf(name, sizeof name, "%.*s%.*s", dot ? (int)(dot - written + 1) : 0, written, (int)n - 4,
             entry->d_name);
    if (name[strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.")])
      continue;
    propose(c, (CagCompletion){.label = name, .kind = CAG_NAME_MODULE});
  }
  if (dir) closedir(dir);
}

// Completes in an import: the path of a module, or names of the module after its `:`.
static void complete_import(Completion *c) {
  const CagToken *t = c->cursor.tokens.items;
  const size_t first = c->cursor.statement + 1, end = c->cursor.before;
  for (size_t i = first; i < end; i++)
    if (t[i].kind == CAG_TOKEN_COLON) {
      const CagStatement *s = cag_tree_statement(c->d->unit->ast, t[first - 1].span.start);
      const CagVm *vm = c->d->session->vm;
      // A list that ends with a comma damages the statement, whose module is then not loaded.
      char path[256];
      snprintf(path, sizeof path, "%.*s", (int)(t[i].span.start - t[first].span.start),
               c->d->text + t[first].span.start);
      path[strcspn(path, " ")] = 0;
      Document *library = cag_doc_library(path, &(const char *){NULL}, &(size_t){0})
                              ? cag_document_get(c->w, path)
                              : NULL;
      if (s && s->kind == CAG_STATEMENT_IMPORT && s->as.import.module < vm->module_count)
        propose_module_names(c, vm->modules[s->as.import.module]);
      else if (library) propose_module_names(c, library->unit);
      return;
    }
  if (end > first && t[end - 1].kind != CAG_TOKEN_DOT) { // after the path
    propose_word(c, "as");
    return;
  }
  // The path is replaced as a whole.
  const size_t start = end > first ? t[first].span.start : c->cursor.word.start;
  c->place.start = start;
  propose_library(c);
  propose_siblings(c, cag_arena_copy(&c->memory, c->d->text + start, c->offset - start));
}

// --- All ---

static bool is_value_end(CagTokenKind k) {
  return k == CAG_TOKEN_NUMBER || k == CAG_TOKEN_ANGLE || k == CAG_TOKEN_TEXT ||
         k == CAG_TOKEN_NAME || k == CAG_TOKEN_RIGHT_PAREN || k == CAG_TOKEN_RIGHT_SQUARE ||
         k == CAG_TOKEN_RIGHT_BRACE || k == CAG_TOKEN_TEXT_TAIL;
}

static void complete_name(Completion *c) {
  CursorCall call;
  const size_t n = c->cursor.before;
  const CagToken *t = c->cursor.tokens.items;
  const bool statement = n <= c->cursor.statement && c->cursor.open_count == 0;
  const CagTokenKind last = n ? t[n - 1].kind : CAG_TOKEN_END;
  if (!statement && is_value_end(last) && c->cursor.word.end > c->cursor.word.start &&
      !(n < c->cursor.tokens.count && t[n].newline_before)) {
    propose_words(c, false); // an operator is expected
    return;
  }
  const bool called = cag_document_call(c->d, &c->cursor, &c->memory, &call);
  const bool begins = last == CAG_TOKEN_LEFT_PAREN || last == CAG_TOKEN_COMMA;
  if (called && begins && c->cursor.open_count &&
      t[c->cursor.open[c->cursor.open_count - 1].token].kind == CAG_TOKEN_LEFT_PAREN)
    propose_arguments(c, &call);
  if (called && (begins || last == CAG_TOKEN_COLON)) propose_choices(c, &call, true);
  if (statement) {
    propose_words(c, true);
    propose_statements(c);
    return;
  }
  cag_document_scope(c->d, c->offset, propose_decl, c);
  propose_builtins(c);
  propose_words(c, false);
  propose_forms(c);
  propose_imports(c);
}

// In a pattern, names are new, except those of fields.
static bool complete_pattern(Completion *c) {
  PatternAt at;
  if (!cag_document_pattern(c->d, c->offset, &at)) return false;
  if (at.value) cag_fields_of(c->d->session->vm, c->d->unit, at.value, propose_field, c);
  return true;
}

static void complete(void *context) {
  Completion *c = context;
  cag_document_cursor(c->d, c->offset, &c->memory, &c->cursor);
  const Cursor *cursor = &c->cursor;
  const CagToken *t = cursor->tokens.items;
  const size_t n = cursor->before;
  c->place = (CagPlace){c->d->file, cursor->word.start, c->offset};
  if (cursor->in_comment) return;
  if (cursor->text) complete_text(c);
  else if (n > cursor->statement && t[cursor->statement].kind == CAG_TOKEN_IMPORT &&
           cursor->open_count == 0)
    complete_import(c);
  else if (n > 0 && t[n - 1].kind == CAG_TOKEN_DOT) complete_member(c, n);
  else if (n > 0 && (t[n - 1].kind == CAG_TOKEN_NUMBER || t[n - 1].kind == CAG_TOKEN_ANGLE) &&
           cursor->word.start == t[n - 1].span.end && cursor->word.end > cursor->word.start) {
    // a unit
  } else if (!complete_pattern(c)) complete_name(c);
}

void cag_document_complete(CagWorkspace *w, const char *file, size_t offset,
                           void (*give)(void *context, const CagCompletion *c), void *context) {
  Completion c = {
      .w = w, .d = cag_document_get(w, file), .offset = offset, .give = give, .context = context};
  if (c.d && offset <= c.d->length) cag_document_guard(complete, &c);
  cag_arena_free(&c.memory);
}
