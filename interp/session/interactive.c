// Interactive sessions: each input is a module that sees the names of earlier inputs.
//
// A name that is redefined keeps its slot, so everything that refers to it sees the new definition.
// All computed values are then discarded, and recomputed when they are needed. Since evaluation has
// no side effects, only the results can change.

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/session/session.h"
#include "interp/vm/value_type.h"

typedef struct Input {
  CagSession *session;
  const char *name, *text, *path;
  size_t length;
  void (*value)(void *context, const char *text, const char *type);
  void *context;
  int status;
} Input;

static size_t find_name(const CagVm *vm, const char *name) {
  for (size_t i = vm->outer_count; i-- > 0;)
    if (strcmp(vm->outer_names[i], name) == 0) return i;
  return (size_t)-1;
}

static void add_name(CagVm *vm, const char *name, size_t global) {
  size_t i = find_name(vm, name);
  if (i != (size_t)-1) {
    vm->outer_globals[i] = global;
    return;
  }
  if (vm->outer_count == vm->outer_capacity) {
    size_t capacity = vm->outer_capacity ? vm->outer_capacity * 2 : 32;
    if (!CAG_RESIZE(vm->outer_names, capacity) || !CAG_RESIZE(vm->outer_globals, capacity))
      cag_vm_out_of_memory(vm);
    vm->outer_capacity = capacity;
  }
  vm->outer_names[vm->outer_count] = name;
  vm->outer_globals[vm->outer_count++] = global;
}

// Makes the definitions of a loaded input part of the session.
static void adopt(CagVm *vm, CagModuleUnit *m) {
  bool again = false;
  for (size_t i = 0; i < m->ast->top_count; i++) {
    const char *name = m->ast->tops[i]->name;
    if (m->ast->tops[i]->whole) continue;
    size_t k = find_name(vm, name), g = m->tops[i];
    const size_t old = k == (size_t)-1 ? k : vm->outer_globals[k];
    // The slot of an earlier definition is reused. That of an imported name belongs to its module.
    if (k != (size_t)-1 && vm->globals[old].unit && vm->globals[old].unit->adopted) {
      vm->globals[old] = vm->globals[g];
      m->tops[i] = old;
      again = true;
    } else {
      add_name(vm, name, g);
    }
  }
  for (size_t i = 0; i < m->ast->count; i++) {
    const CagStatement *s = m->ast->statements[i];
    if (s->kind != CAG_STATEMENT_IMPORT) continue;
    if (s->as.import.decl) add_name(vm, s->as.import.decl->name, s->as.import.decl->index);
    for (size_t k = 0; k < s->as.import.name_count; k++)
      add_name(vm, s->as.import.names[k].decl->name, s->as.import.names[k].decl->index);
  }
  if (!again) return;
  for (size_t i = 0; i < vm->outer_count; i++) {
    CagGlobal *g = &vm->globals[vm->outer_globals[i]];
    if (g->expr && !g->given && g->state == CAG_GLOBAL_DONE) g->state = CAG_GLOBAL_NEW;
  }
}

static void give_value(CagVm *vm, CagValue v, void *context) {
  Input *in = context;
  if (!in->value) return;
  CagString s = {0};
  cag_print_value(vm, &s, v, true);
  // If the value took too long or too much memory, its text is incomplete.
  if (!vm->failed && cag_keep_going(vm)) {
    cag_string_check(vm, &s);
    in->value(in->context, s.bytes ? s.bytes : "", cag_type_name(v));
  }
  cag_string_free(&s);
}

// Sets params to the values of -D for params of an input, and checks their defaults.
static bool set_params(CagVm *vm, CagModuleUnit *m, const CagSession *s) {
  CagCleanup cleanup;
  CagDefine *defines = cag_temporary(&cleanup, s->define_count, sizeof *defines);
  for (size_t i = 0; i < s->define_count; i++) defines[i] = (CagDefine){s->names[i], s->values[i]};
  bool ok = cag_program_set_params(vm, m, defines, s->define_count, s->frame, s->frames, true);
  cag_cleanup_run(&cleanup);
  return ok;
}

static bool evaluate_input(CagVm *vm, void *context) {
  Input *in = context;
  CagSession *s = in->session;
  size_t k = in->path ? cag_load_file(vm, in->path, &in->status)
                      : cag_load_text(vm, in->name, in->text, in->length, CAG_PARSE_REPL);
  if (k == CAG_NO_MODULE) return false;
  CagModuleUnit *m = vm->modules[k];
  adopt(vm, m);
  m->adopted = true;
  if (!CAG_RESIZE(s->inputs, s->input_count + 1)) cag_vm_out_of_memory(vm);
  if (!set_params(vm, m, s) || !cag_program_run(vm, m, give_value, in)) return false;
  s->inputs[s->input_count++] = k;
  return true;
}

static int start_input(CagSession *s, Input *in) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  if (!s->interactive) cag_session_drop_vm(s);
  s->interactive = true;
  cag_session_clear_diagnostics(s);
  cag_session_renew_time(s);
  return cag_session_end(s, s->define_lost ? cag_session_fail_memory(s)
                                           : cag_session_work(s, evaluate_input, in));
}

int cag_session_input(CagSession *s, const char *text, size_t length,
                      void (*value)(void *context, const char *text, const char *type),
                      void *context) {
  return start_input(s, &(Input){.session = s,
                                 .name = "<input>",
                                 .text = text,
                                 .length = length,
                                 .value = value,
                                 .context = context});
}

int cag_session_input_file(CagSession *s, const char *path) {
  return start_input(s, &(Input){.session = s, .path = path});
}

bool cag_input_is_incomplete(const char *text, size_t length) {
  return cag_parse_incomplete(text, length);
}

// Returns the definition of name i of the session, or NULL if it was imported.
static const CagDecl *find_decl(const CagVm *vm, size_t i) {
  const CagModuleUnit *m = vm->globals[vm->outer_globals[i]].unit;
  for (size_t k = 0; m && m->adopted && k < m->ast->top_count; k++)
    if (strcmp(m->ast->tops[k]->name, vm->outer_names[i]) == 0) return m->ast->tops[k];
  return NULL;
}

const char *cag_session_name(CagSession *s, size_t i, const char **source_text,
                             size_t *source_length) {
  if (source_text) *source_text = NULL;
  if (source_length) *source_length = 0;
  if (!s->vm || !s->interactive || i >= s->vm->outer_count) return NULL;
  const CagVm *vm = s->vm;
  const CagDecl *d = source_text || source_length ? find_decl(vm, i) : NULL;
  if (!d) return vm->outer_names[i];
  const CagSpan span = d->statement->span;
  const CagModuleUnit *m = vm->globals[vm->outer_globals[i]].unit;
  if (source_text) *source_text = m->source->text + span.start;
  if (source_length) *source_length = span.end - span.start;
  return vm->outer_names[i];
}

bool cag_session_write_doc(CagSession *s, const char *name, FILE *out) {
  size_t i = s->vm && s->interactive ? find_name(s->vm, name) : (size_t)-1;
  if (i == (size_t)-1) return false;
  const char *text, *doc = NULL;
  size_t length;
  cag_session_name(s, i, &text, &length);
  if (text) {
    doc = find_decl(s->vm, i)->doc;
    fprintf(out, "%.*s\n", (int)length, text);
  } else {
    const CagModuleUnit *m = s->vm->globals[s->vm->outer_globals[i]].unit;
    fprintf(out, "%s is imported%s%s\n", name, m ? " from " : "", m ? m->name : "");
    for (size_t k = 0; m && k < m->ast->top_count; k++)
      if (strcmp(m->ast->tops[k]->name, name) == 0) doc = m->ast->tops[k]->doc;
  }
  while (doc && *doc) {
    size_t n = strcspn(doc, "\n");
    fprintf(out, "  %.*s\n", (int)n, doc);
    doc += n + (doc[n] == '\n');
  }
  return true;
}

bool cag_session_library_name(CagSession *s, const char *name, char *out, size_t size) {
  const size_t n = strcspn(name, ".");
  char *head = cag_strndup(name, n);
  const size_t i = head && s->vm && s->interactive ? find_name(s->vm, head) : (size_t)-1;
  cag_free(head);
  if (i == (size_t)-1) return false;
  const CagGlobal *g = &s->vm->globals[s->vm->outer_globals[i]];
  const bool whole = g->value.type == CAG_MODULE; // the name is that of the module, not of a member
  const CagModuleUnit *m =
      whole ? s->vm->modules[((const CagModuleValue *)g->value.as.object)->module] : g->unit;
  if (!m || m->path || strncmp(m->name, "std.", 4) != 0 || (!whole && name[n])) return false;
  snprintf(out, size, "%s%s%s", m->name, whole ? "" : ".", whole ? name + n : name);
  return true;
}

// --- Members ---

// The time limit of completion for values.
#define MEMBERS_SECONDS 1.0

typedef struct MemberQuestion {
  CagSession *session;
  const char *path;
  void (*give)(void *context, const char *name);
  void *context;
} MemberQuestion;

static void give_members(CagVm *vm, CagValue v, const MemberQuestion *q) {
  const CagValueType *type = cag_value_type(v);
  const char *name;
  for (size_t i = 0; type->member_name && (name = type->member_name(vm, v, i)); i++)
    q->give(q->context, name);
}

static bool ask_members(CagVm *vm, void *context) {
  const MemberQuestion *q = context;
  char *path = cag_checked(cag_strdup(q->path)), *rest = NULL;
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, cag_free, path);
  const char *word = strtok_r(path, ".", &rest);
  size_t i = word ? find_name(vm, word) : (size_t)-1;
  CagValue v;
  bool ok = i != (size_t)-1 && cag_vm_force(vm, vm->outer_globals[i], &v);
  while (ok && (word = strtok_r(NULL, ".", &rest)))
    ok = cag_member(vm, v, cag_text_c(vm, word), &v);
  cag_cleanup_run(&cleanup);
  if (ok) give_members(vm, v, q);
  return ok;
}

void cag_session_members(CagSession *s, const char *path,
                         void (*give)(void *context, const char *name), void *context) {
  if (!s->vm || !s->interactive || !cag_session_begin(s)) return;
  const double limit = s->vm->max_time;
  s->vm->max_time = s->time_left = MEMBERS_SECONDS;
  cag_session_work(s, ask_members, &(MemberQuestion){s, path, give, context});
  s->vm->max_time = limit;
  cag_session_clear_diagnostics(s);
  cag_session_end(s, CAG_STATUS_OK);
}

// --- The session as a script ---

static void write_span(const CagModuleUnit *m, CagSpan span, FILE *out) {
  fprintf(out, "%.*s\n", (int)(span.end - span.start), m->source->text + span.start);
}

// Tests whether an expression shown has this source text.
static bool is_written(const CagModuleUnit *m, const CagExpr *e, const char *text) {
  const size_t length = e->span.end - e->span.start;
  return strlen(text) == length && memcmp(m->source->text + e->span.start, text, length) == 0;
}

size_t cag_session_hide(CagSession *s, const char *text) {
  size_t hidden = 0;
  for (size_t i = 0; s->vm && s->interactive && i < s->input_count; i++) {
    const CagModuleUnit *m = s->vm->modules[s->inputs[i]];
    for (size_t k = 0; k < m->ast->count; k++) {
      CagStatement *show = m->ast->statements[k];
      if (show->kind != CAG_STATEMENT_SHOW) continue;
      size_t kept = 0;
      for (size_t n = 0; n < show->as.list.count; n++)
        if (is_written(m, show->as.list.items[n], text)) hidden++;
        else show->as.list.items[kept++] = show->as.list.items[n];
      show->as.list.count = kept;
    }
  }
  return hidden;
}

static void write_show(const CagModuleUnit *m, const CagStatement *show, FILE *out) {
  for (size_t n = 0; n < show->as.list.count; n++) {
    const CagSpan span = show->as.list.items[n]->span;
    fprintf(out, "%s%.*s%s", n ? ", " : "show ", (int)(span.end - span.start),
            m->source->text + span.start, n + 1 == show->as.list.count ? "\n" : "");
  }
}

// Writes the statements of one kind of all inputs that ran.
static void write_statements(const CagSession *s, CagStatementKind kind, FILE *out) {
  for (size_t i = 0; i < s->input_count; i++) {
    const CagModuleUnit *m = s->vm->modules[s->inputs[i]];
    for (size_t k = 0; k < m->ast->count; k++)
      if (m->ast->statements[k]->kind != kind) continue;
      else if (kind == CAG_STATEMENT_SHOW) write_show(m, m->ast->statements[k], out);
      else write_span(m, m->ast->statements[k]->span, out);
  }
}

void cag_session_write_script(CagSession *s, FILE *out) {
  if (!s->vm || !s->interactive) return;
  write_statements(s, CAG_STATEMENT_IMPORT, out);
  const char *text;
  size_t length;
  for (size_t i = 0; cag_session_name(s, i, &text, &length); i++) {
    if (!text) continue;
    const CagDecl *d = find_decl(s->vm, i);
    const char *doc = d ? d->doc : NULL;
    while (doc && *doc) {
      size_t n = strcspn(doc, "\n");
      fprintf(out, "/// %.*s\n", (int)n, doc);
      doc += n + (doc[n] == '\n');
    }
    fprintf(out, "%.*s\n", (int)length, text);
  }
  write_statements(s, CAG_STATEMENT_ASSERT, out);
  write_statements(s, CAG_STATEMENT_SHOW, out);
}

void cag_session_clear(CagSession *s) {
  if (!cag_session_begin(s)) return;
  cag_session_drop_vm(s);
  cag_session_end(s, CAG_STATUS_OK);
}
