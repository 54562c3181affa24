// Running a program.

#include "interp/vm/program.h"

#include <string.h>

#include "base/array.h"
#include "base/memory.h"

// --- Params ---

static const CagStatement *find_param(const CagModuleUnit *m, const char *name) {
  for (size_t i = 0; i < m->ast->count; i++) {
    const CagStatement *s = m->ast->statements[i];
    if (s->kind == CAG_STATEMENT_PARAM && strcmp(s->as.param.decl->name, name) == 0) return s;
  }
  return NULL;
}

static bool fail_unknown_param(CagVm *vm, const CagModuleUnit *m, const char *name) {
  const char *names[256];
  size_t n = 0;
  for (size_t i = 0; i < m->ast->count && n < 250; i++)
    if (m->ast->statements[i]->kind == CAG_STATEMENT_PARAM)
      names[n++] = m->ast->statements[i]->as.param.decl->name;
  names[n++] = "time";
  names[n++] = "frame";
  names[n++] = "frames";
  vm->failed = true;
  CagDiagnostic *d = cag_diagnostics_add(&vm->errors, CAG_ERR_param_unknown, NULL, (CagSpan){0, 0},
                                         "%s has no param `%s`", m->name, name);
  const char *nearest = cag_nearest_name(name, names, n);
  if (nearest) cag_diagnostic_set_help(d, "did you mean `%s`?", nearest);
  return false;
}

// Evaluates the text of a -D, an expression that uses built-in names only.
static bool evaluate_define(CagVm *vm, const char *name, const char *text, CagValue *out) {
  char label[128];
  snprintf(label, sizeof label, "-D %s", name);
  size_t outer = vm->outer_count;
  vm->outer_count = 0;
  size_t k = cag_load_text(vm, label, text, strlen(text), CAG_PARSE_REPL);
  vm->outer_count = outer;
  if (k == CAG_NO_MODULE) return false;
  CagModuleUnit *m = vm->modules[k];
  if (m->ast->count != 1 || m->ast->statements[0]->kind != CAG_STATEMENT_EXPRESSION) {
    vm->failed = true;
    cag_diagnostics_add(&vm->errors, CAG_ERR_param_type, NULL, (CagSpan){0, 0},
                        "-D %s=%s: expected one expression as the value", name, text);
    return false;
  }
  const CagProto *p = cag_compile_expression(vm, m, m->ast->statements[0]->as.expression, NULL);
  return p && cag_vm_run(vm, p, out);
}

static bool same_type(CagValue a, CagValue b) {
  if (cag_is_function(a)) return cag_is_function(b);
  return a.type == b.type || (a.type == CAG_LIST && b.type == CAG_RANGE) || a.type == CAG_NONE;
}

static bool is_within(CagVm *vm, CagModuleUnit *m, const CagStatement *s, CagValue v,
                      CagErrorId id) {
  CagValue domain;
  const CagProto *p = cag_compile_expression(vm, m, s->as.param.domain, NULL);
  if (!p || !cag_vm_run(vm, p, &domain)) return false;
  bool within;
  if (!cag_contains(vm, v, domain, &within)) return false;
  if (within) return true;
  CagString text = {0};
  cag_print_value(vm, &text, v, true);
  cag_string_add(&text, " is not in ", 11);
  cag_print_value(vm, &text, domain, true);
  CagSpan span = id == CAG_ERR_param_default ? s->as.param.value->span : s->as.param.decl->span;
  cag_diagnostics_add(&vm->errors, id, m->source, span, "%s `%s`: %s",
                      id == CAG_ERR_param_default ? "the default of the param" : "the param",
                      s->as.param.decl->name, text.bytes);
  vm->failed = true;
  cag_string_free(&text);
  return false;
}

// A text may be quoted, as in a script, or unquoted.
static bool is_quoted(const char *value) {
  const size_t n = strlen(value);
  return n >= 2 && value[0] == '"' && value[n - 1] == '"';
}

static bool set_param(CagVm *vm, CagModuleUnit *m, const CagStatement *s, const CagDefine *d) {
  size_t g = m->tops[s->as.param.decl->index];
  CagValue standard, v;
  if (!cag_vm_force(vm, g, &standard)) return false;
  if (s->as.param.domain && !is_within(vm, m, s, standard, CAG_ERR_param_default)) return false;
  if (!d) return true;
  if (standard.type == CAG_TEXT && !is_quoted(d->value)) v = cag_text_c(vm, d->value);
  else if (!evaluate_define(vm, d->name, d->value, &v)) return false;
  if (!same_type(standard, v)) {
    vm->failed = true;
    CagString found = {0};
    cag_describe_value(vm, &found, v);
    CagDiagnostic *e =
        cag_diagnostics_add(&vm->errors, CAG_ERR_param_type, m->source, s->as.param.decl->span,
                            "the param `%s` is %s, but -D sets it to %s", d->name,
                            cag_type_article(standard), found.bytes);
    if (standard.type == CAG_ANGLE && v.type == CAG_NUMBER)
      cag_diagnostic_set_help(e, "-D %s=%sdeg", d->name, d->value);
    cag_string_free(&found);
    return false;
  }
  if (s->as.param.domain && !is_within(vm, m, s, v, CAG_ERR_param_range)) return false;
  vm->globals[g].value = v;
  vm->globals[g].given = true;
  return true;
}

// If a name is given repeatedly, the last -D counts.
static const CagDefine *find_define(const CagDefine *defines, size_t n, const char *name) {
  for (size_t i = n; i-- > 0;)
    if (strcmp(defines[i].name, name) == 0) return &defines[i];
  return NULL;
}

// Sets the params that every script has.
static bool set_time(CagVm *vm, const CagModuleUnit *m, const CagDefine *defines, size_t n,
                     double frame, double frames) {
  double values[CAG_GLOBAL_RESERVED] = {0, frame, frames};
  bool given[CAG_GLOBAL_RESERVED] = {false};
  for (size_t k = 0; k < CAG_GLOBAL_RESERVED; k++) {
    const char *name = vm->globals[k].name;
    const CagDefine *d = find_param(m, name) ? NULL : find_define(defines, n, name);
    if (!d) continue;
    CagValue v;
    if (!evaluate_define(vm, name, d->value, &v)) return false;
    if (v.type != CAG_NUMBER)
      return cag_vm_fail(vm, CAG_ERR_param_type, "-D %s expects a number", name);
    values[k] = v.as.number;
    given[k] = true;
  }
  if (!given[CAG_GLOBAL_TIME])
    values[CAG_GLOBAL_TIME] =
        values[CAG_GLOBAL_FRAMES] > 1
            ? values[CAG_GLOBAL_FRAME] / (values[CAG_GLOBAL_FRAMES] - (vm->loop ? 0 : 1))
            : 0;
  for (size_t k = 0; k < CAG_GLOBAL_RESERVED; k++) vm->globals[k].value = cag_number(values[k]);
  return true;
}

static bool is_reserved(const CagVm *vm, const char *name) {
  for (size_t k = 0; k < CAG_GLOBAL_RESERVED; k++)
    if (strcmp(vm->globals[k].name, name) == 0) return true;
  return false;
}

bool cag_program_set_params(CagVm *vm, CagModuleUnit *main, const CagDefine *defines, size_t n,
                            double frame, double frames, bool lenient) {
  if (!set_time(vm, main, defines, n, frame, frames)) return false;
  for (size_t i = 0; !lenient && i < n; i++)
    if (!is_reserved(vm, defines[i].name) && !find_param(main, defines[i].name))
      return fail_unknown_param(vm, main, defines[i].name);
  for (size_t i = 0; i < main->ast->count; i++) {
    const CagStatement *s = main->ast->statements[i];
    if (s->kind != CAG_STATEMENT_PARAM) continue;
    if (!set_param(vm, main, s, find_define(defines, n, s->as.param.decl->name))) return false;
  }
  return true;
}

// --- Statements ---

static bool evaluate(CagVm *vm, CagModuleUnit *m, const CagExpr *e, CagValue *out) {
  const CagProto *p = cag_compile_expression(vm, m, e, NULL);
  if (p) return cag_vm_run(vm, p, out);
  vm->failed = true;
  return false;
}

static bool run_assert(CagVm *vm, CagModuleUnit *m, const CagStatement *s) {
  const CagProto *p = cag_compile_assert(vm, m, s);
  CagValue ignored;
  if (p) return cag_vm_run(vm, p, &ignored);
  vm->failed = true;
  return false;
}

static void free_line(void *line) { cag_string_free(line); }

static bool run_print(CagVm *vm, CagModuleUnit *m, const CagStatement *s) {
  CagString line = {0};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_line, &line);
  bool ok = true;
  for (size_t i = 0; ok && i < s->as.list.count; i++) {
    CagValue v;
    ok = evaluate(vm, m, s->as.list.items[i], &v);
    if (!ok) break;
    if (i) cag_string_add(&line, " ", 1);
    cag_print_value(vm, &line, v, false);
  }
  ok = ok && !vm->failed && cag_keep_going(vm);
  if (ok) {
    cag_string_add(&line, "\n", 1);
    cag_string_check(vm, &line);
    fwrite(line.bytes, 1, line.length, vm->out);
  }
  cag_cleanup_run(&cleanup);
  return ok;
}

static bool add_shown(CagVm *vm, CagModuleUnit *m, const CagExpr *e, CagValue v) {
  if (!CAG_RESERVE(vm->shown, vm->shown_capacity, vm->shown_count + 1)) cag_vm_out_of_memory(vm);
  vm->shown[vm->shown_count++] =
      (CagShown){.value = v, .expr = e, .source = m->source, .span = e->span};
  return true;
}

bool cag_value_is_shown(CagVm *vm, CagValue v) {
  if (!cag_may_go_deeper(vm, "shown")) return false;
  if (v.type == CAG_LIST) {
    // Lists of numbers and vectors are packed and contain no shapes.
    const CagList *list = CAG_AS_LIST(v);
    if (list->dim != 0) return false;
    for (size_t i = 0; i < list->length; i++)
      if (!cag_value_is_shown(vm, list->as.items[i])) return false;
    return true;
  }
  return cag_is_shape(v) || v.type == CAG_ROBOT || v.type == CAG_CAMERA || v.type == CAG_LIGHT ||
         v.type == CAG_SETTING || v.type == CAG_IMAGE;
}

static bool run_show(CagVm *vm, CagModuleUnit *m, const CagStatement *s) {
  for (size_t i = 0; i < s->as.list.count; i++) {
    const CagExpr *e = s->as.list.items[i];
    CagValue v;
    if (!evaluate(vm, m, e, &v)) return false;
    if (!cag_value_is_shown(vm, v)) {
      if (vm->failed) return false;
      CagString found = {0};
      cag_describe_value(vm, &found, v);
      CagDiagnostic *d = cag_diagnostics_add(
          &vm->errors, CAG_ERR_no_image, m->source, e->span,
          "show expects shapes, images, lights, cameras, or settings of the scene, found %s",
          found.bytes);
      if (v.type <= CAG_TEXT) cag_diagnostic_set_help(d, "to write a value, use `print`");
      cag_string_free(&found);
      vm->failed = true;
      return false;
    }
    add_shown(vm, m, e, v);
  }
  return true;
}

// Runs the asserts of the modules that m imports, those of their own imports first, each module
// once.
static bool run_imported_asserts(CagVm *vm, CagModuleUnit *m) {
  for (size_t i = 0; i < m->ast->count; i++) {
    const CagStatement *s = m->ast->statements[i];
    if (s->kind != CAG_STATEMENT_IMPORT) continue;
    CagModuleUnit *other = vm->modules[s->as.import.module];
    if (other->asserted) continue;
    other->asserted = true;
    if (!run_imported_asserts(vm, other)) return false;
    for (size_t k = 0; k < other->ast->count; k++)
      if (other->ast->statements[k]->kind == CAG_STATEMENT_ASSERT &&
          !run_assert(vm, other, other->ast->statements[k]))
        return false;
  }
  return true;
}

bool cag_program_run(CagVm *vm, CagModuleUnit *main,
                     void (*expression)(CagVm *vm, CagValue v, void *context), void *context) {
  if (!run_imported_asserts(vm, main)) return false;
  for (size_t i = 0; i < main->ast->count; i++) {
    const CagStatement *s = main->ast->statements[i];
    bool ok = true;
    CagValue v;
    switch (s->kind) {
    case CAG_STATEMENT_SHOW: ok = run_show(vm, main, s); break;
    case CAG_STATEMENT_PRINT: ok = run_print(vm, main, s); break;
    case CAG_STATEMENT_ASSERT: ok = run_assert(vm, main, s); break;
    case CAG_STATEMENT_EXPRESSION:
      ok = evaluate(vm, main, s->as.expression, &v);
      if (ok && expression) expression(vm, v, context);
      ok = ok && !vm->failed;
      break;
    default: break;
    }
    if (!ok) return false;
  }
  return true;
}

bool cag_program_run_shows(CagVm *vm, CagModuleUnit *m) {
  for (size_t i = 0; i < m->ast->count; i++)
    if (m->ast->statements[i]->kind == CAG_STATEMENT_SHOW &&
        !run_show(vm, m, m->ast->statements[i]))
      return false;
  return true;
}
