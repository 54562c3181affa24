// Interactive sessions: each text is a module of its own that sees the names of those before it.
//
// A name that is defined again keeps its slot: whatever refers to it sees the new definition.
// Values that were computed are forgotten then, and computed again when they are needed; since
// nothing has effects, nobody can tell but by the new result.

#include <stdlib.h>
#include <string.h>

#include "interp/session/session.h"

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
    const char **names = realloc(vm->outer_names, capacity * sizeof *names);
    if (names) vm->outer_names = names;
    size_t *globals = realloc(vm->outer_globals, capacity * sizeof *globals);
    if (globals) vm->outer_globals = globals;
    if (!names || !globals) cag_vm_out_of_memory(vm);
    vm->outer_capacity = capacity;
  }
  vm->outer_names[vm->outer_count] = name;
  vm->outer_globals[vm->outer_count++] = global;
}

// Makes the definitions of a loaded text those of the session.
static void adopt(CagVm *vm, CagModuleUnit *m) {
  bool again = false;
  for (size_t i = 0; i < m->ast->top_count; i++) {
    const char *name = m->ast->tops[i]->name;
    size_t k = find_name(vm, name), g = m->tops[i];
    // A slot of an earlier definition is taken over; one that an import filled is not.
    if (k != (size_t)-1 && vm->globals[vm->outer_globals[k]].expr) {
      size_t old = vm->outer_globals[k];
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
    if (g->expr && g->state == CAG_GLOBAL_DONE) g->state = CAG_GLOBAL_NEW;
  }
}

static void give_value(CagVm *vm, CagValue v, void *context) {
  Input *in = context;
  if (!in->value) return;
  CagString s = {0};
  cag_print_value(vm, &s, v, true);
  in->value(in->context, s.bytes ? s.bytes : "", cag_type_name(v));
  cag_string_free(&s);
}

static bool evaluate_input(CagVm *vm, void *context) {
  Input *in = context;
  CagSession *s = in->session;
  size_t k = in->path ? cag_load_file(vm, in->path, &in->status)
                      : cag_load_text(vm, in->name, in->text, in->length, CAG_PARSE_REPL);
  if (k == CAG_NO_MODULE) return false;
  CagModuleUnit *m = vm->modules[k];
  adopt(vm, m);
  size_t *inputs = realloc(s->inputs, (s->input_count + 1) * sizeof *inputs);
  if (!inputs) cag_vm_out_of_memory(vm);
  s->inputs = inputs;
  if (!cag_program_run(vm, m, give_value, in)) return false;
  s->inputs[s->input_count++] = k;
  return true;
}

static int start_input(CagSession *s, Input *in) {
  if (!s->interactive) cag_session_drop_vm(s);
  s->interactive = true;
  cag_diagnostics_free(&s->diagnostics);
  s->diagnostics = (CagDiagnostics){0};
  return cag_session_work(s, evaluate_input, in);
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

const char *cag_session_name(CagSession *s, size_t i, const char **source_text,
                             size_t *source_length) {
  if (!s->vm || !s->interactive || i >= s->vm->outer_count) return NULL;
  const CagGlobal *g = &s->vm->globals[s->vm->outer_globals[i]];
  if (source_text) *source_text = NULL;
  if (source_length) *source_length = 0;
  for (size_t k = 0; g->unit && source_text && k < g->unit->ast->top_count; k++) {
    const CagDecl *d = g->unit->ast->tops[k];
    if (strcmp(d->name, s->vm->outer_names[i]) != 0) continue;
    *source_text = g->unit->source->text + d->statement->span.start;
    if (source_length) *source_length = d->statement->span.end - d->statement->span.start;
  }
  return s->vm->outer_names[i];
}

void cag_session_clear(CagSession *s) { cag_session_drop_vm(s); }
