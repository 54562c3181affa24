// Loading of modules: finding them, their syntax trees, their names, and the slots of their values.
//
// A module is loaded after its imports, so that their names are known. The syntax errors of all
// files are reported together, along with unknown names in the valid parts of a file. Names from a
// module that failed to load count as defined.

#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/vm/stdlib.h"
#include "interp/vm/vm.h"

static size_t load_unit(CagVm *vm, CagModuleUnit *m, CagParseMode mode);

static CagModuleUnit *new_unit(CagVm *vm, const char *name, const char *path, const char *text,
                               size_t length) {
  if (!CAG_RESERVE(vm->modules, vm->module_capacity, vm->module_count + 1))
    cag_vm_out_of_memory(vm);
  CagModuleUnit *m = cag_calloc(1, sizeof *m);
  if (!m) cag_vm_out_of_memory(vm);
  m->name = cag_strdup(name);
  m->path = path ? cag_strdup(path) : NULL;
  m->source = cag_source_new(name, text, length);
  if (!m->name || !m->source || (path && !m->path)) {
    cag_module_free(m);
    cag_vm_out_of_memory(vm);
  }
  m->source->stop = cag_vm_stop(vm);
  m->number = vm->module_count;
  vm->modules[vm->module_count++] = m;
  return m;
}

// Checks that the file is text. The lexer reports single invalid bytes with their locations. A zero
// byte never occurs in text, and a file with one has too many invalid bytes to report each.
static bool check_text(CagVm *vm, CagModuleUnit *m) {
  size_t bad = cag_source_bad_utf8(m->source);
  if (bad == m->source->length || !memchr(m->source->text, 0, m->source->length)) return true;
  const char *why = m->source->text[bad] == 0 ? "a zero byte" : "a byte that is not UTF-8";
  CagDiagnostic *d = cag_diagnostics_add(
      &vm->errors, CAG_ERR_module_not_text, m->source, (CagSpan){(uint32_t)bad, (uint32_t)bad + 1},
      "%s is not a text in UTF-8: it has %s (0x%02x) at byte %zu", m->name, why,
      (unsigned char)m->source->text[bad], bad);
  cag_diagnostic_set_help(d, "is it a script? Save it as UTF-8");
  return false;
}

// --- Finding modules ---

static char *folder_of(const CagVm *vm, const CagModuleUnit *m) {
  if (!m->path) return vm->root ? cag_strdup(vm->root) : NULL;
  const char *slash = strrchr(m->path, '/');
  if (!slash) return NULL;
  return cag_strndup(m->path, slash == m->path ? 1 : (size_t)(slash - m->path));
}

static size_t find_standard(CagVm *vm, const char *name) {
  for (size_t i = 0; i < vm->module_count; i++)
    if (!vm->modules[i]->path && vm->modules[i]->state != CAG_MODULE_LOST &&
        strcmp(vm->modules[i]->name, name) == 0)
      return i;
  for (const CagStdlibFile *f = cag_stdlib; f->module; f++)
    if (strcmp(f->module, name) == 0) {
      CagModuleUnit *m = new_unit(vm, name, NULL, f->text, f->length);
      m->source->library = true;
      return load_unit(vm, m, CAG_PARSE_FILE);
    }
  return CAG_NO_MODULE;
}

// Reports circular imports, starting from the first loading of module m.
static void fail_circle(CagVm *vm, const CagModuleUnit *from, const CagStatement *s,
                        const CagModuleUnit *m) {
  CagString chain = {0};
  for (size_t i = m->number; i < vm->module_count; i++)
    if (vm->modules[i]->state == CAG_MODULE_LOADING)
      cag_string_printf(&chain, "%s -> ", vm->modules[i]->name);
  cag_string_printf(&chain, "%s", m->name);
  cag_diagnostics_add(&vm->errors, CAG_ERR_import_circle, from->source, s->as.import.path_span,
                      "circular imports: %s", chain.bytes);
  cag_string_free(&chain);
}

// The length of a folder's path without its last part, or the same if that is not known by name.
static size_t parent_length(const char *path, size_t n) {
  const bool up = n >= 3 && !strncmp(path + n - 3, "../", 3) && (n == 3 || path[n - 4] == '/');
  if (n <= 1 || up) return n;
  n--;
  while (n > 0 && path[n - 1] != '/') n--;
  return n;
}

// Returns the path for messages: that of the importing file with its last part replaced, without
// detours such as `./`.
static char *shown_path(const CagModuleUnit *from, const char *relative) {
  const char *slash = from->path ? strrchr(from->name, '/') : NULL;
  size_t n = slash ? (size_t)(slash - from->name) + 1 : 0;
  for (;;) {
    const size_t parent = parent_length(from->name, n);
    if (!strncmp(relative, "./", 2)) relative += 2;
    else if (!strncmp(relative, "../", 3) && parent < n) relative += 3, n = parent;
    else break;
  }
  char *out = NULL;
  if (cag_asprintf(&out, "%.*s%s", (int)n, from->name, relative) < 0) return NULL;
  return out;
}

static size_t load_path(CagVm *vm, CagModuleUnit *from, const CagStatement *s, const char *real,
                        const char *shown) {
  for (size_t i = 0; i < vm->module_count; i++) {
    CagModuleUnit *m = vm->modules[i];
    if (!m->path || m->state == CAG_MODULE_LOST || strcmp(m->path, real) != 0) continue;
    if (m->state != CAG_MODULE_LOADING) return i;
    fail_circle(vm, from, s, m);
    return CAG_NO_MODULE;
  }
  size_t length;
  const char *why;
  const char *given = vm->find_text ? vm->find_text(vm->find_text_context, real, &length) : NULL;
  if (given) return load_unit(vm, new_unit(vm, shown, real, given, length), CAG_PARSE_FILE);
  char *text = cag_read_whole_file(real, &length, &why);
  if (!text) {
    cag_diagnostics_add(&vm->errors, CAG_ERR_module_unreadable, from->source,
                        s->as.import.path_span, "cannot read %s: %s", shown, why);
    vm->starved |= why == cag_file_out_of_memory;
    return CAG_NO_MODULE;
  }
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, cag_free, text);
  CagModuleUnit *m = new_unit(vm, shown, real, text, length);
  cag_cleanup_run(&cleanup);
  return load_unit(vm, m, CAG_PARSE_FILE);
}

// Converts parts.gripper to parts/gripper.cag. A text is returned unchanged.
static char *relative_path(const CagStatement *s) {
  char *p = NULL;
  if (s->as.import.is_text) return cag_strdup(s->as.import.path);
  if (cag_asprintf(&p, "%s.cag", s->as.import.path) < 0) return NULL;
  for (char *c = p; c < p + strlen(p) - 4; c++)
    if (*c == '.') *c = '/';
  return p;
}

static void suggest_module(CagDiagnostic *d, const char *name) {
  const char *names[64];
  size_t n = 0;
  for (const CagStdlibFile *f = cag_stdlib; f->module && n < 64; f++) names[n++] = f->module;
  const char *nearest = cag_nearest_name(name, names, n);
  if (nearest) cag_diagnostic_set_help(d, "did you mean `%s`?", nearest);
}

typedef struct ImportPaths {
  char *relative, *folder; // path as written; folder of the importing file
  char *real, *shown;      // paths of the file that was found
} ImportPaths;

static void free_paths(void *paths) {
  ImportPaths *p = paths;
  cag_free(p->relative);
  cag_free(p->folder);
  cag_free(p->real);
  cag_free(p->shown);
}

static size_t load_import(CagVm *vm, CagModuleUnit *m, const CagStatement *s) {
  const char *name = s->as.import.path;
  if (!s->as.import.is_text && strncmp(name, "std.", 4) == 0) {
    size_t before = vm->errors.count, k = find_standard(vm, name);
    if (k == CAG_NO_MODULE && vm->errors.count == before)
      suggest_module(cag_diagnostics_add(&vm->errors, CAG_ERR_module_not_found, m->source,
                                         s->as.import.path_span,
                                         "the standard library has no module `%s`", name),
                     name);
    return k;
  }
  ImportPaths p = {.relative = relative_path(s), .folder = folder_of(vm, m)};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_paths, &p);
  vm->starved |= !p.relative || (!p.folder && (m->path || vm->root));
  const char *const relative = p.relative, *const folder = p.folder;
  char message[512];
  if (relative && folder) p.real = cag_allowed_path(vm, relative, folder, message, sizeof message);
  if (p.real) p.shown = shown_path(m, relative);
  for (size_t i = 0; relative && !p.real && !s->as.import.is_text && i < vm->include_count; i++) {
    char ignored[512];
    p.real = cag_allowed_path(vm, relative, vm->include[i], ignored, sizeof ignored);
    if (p.real) p.shown = cag_strdup(p.real);
  }
  size_t k = CAG_NO_MODULE;
  vm->starved |= p.real && !p.shown;
  if (vm->starved) {
    // The run reports this error when it ends.
  } else if (p.real) {
    k = load_path(vm, m, s, p.real, p.shown);
  } else {
    bool outside = folder && strstr(message, "outside") != NULL;
    CagDiagnostic *d = cag_diagnostics_add(
        &vm->errors, outside ? CAG_ERR_import_outside : CAG_ERR_module_not_found, m->source,
        s->as.import.path_span, outside ? "%s" : "unknown module %s", outside ? message : name);
    if (!outside) {
      cag_diagnostic_set_help(d, "looked for %s next to %s%s", relative ? relative : name, m->name,
                              vm->include_count ? " and on the module path" : "");
      if (!strchr(name, '.')) {
        char standard[128];
        snprintf(standard, sizeof standard, "std.%s", name);
        for (const CagStdlibFile *f = cag_stdlib; f->module; f++)
          if (strcmp(f->module, standard) == 0)
            cag_diagnostic_set_help(d, "did you mean `%s`?", standard);
      }
    }
  }
  cag_cleanup_run(&cleanup);
  return k;
}

// --- Names ---

static const char *const reserved_names[] = {"time", "frame", "frames"};

static size_t find_builtin(void *context, const char *name) {
  (void)context;
  for (size_t i = 0; i < CAG_GLOBAL_RESERVED; i++)
    if (strcmp(name, reserved_names[i]) == 0) return cag_builtin_count() + i;
  return cag_builtin_find(name);
}

// Finds names defined by earlier inputs of the REPL, the newest definition first.
static size_t find_outer(void *context, const char *name) {
  CagVm *vm = context;
  for (size_t i = vm->outer_count; i-- > 0;)
    if (strcmp(vm->outer_names[i], name) == 0) return vm->outer_globals[i];
  return (size_t)-1;
}

static const struct CagPublicName *find_public(const CagModuleUnit *m, const char *name) {
  for (size_t i = 0; i < m->public_count; i++)
    if (strcmp(m->publics[i].name, name) == 0) return &m->publics[i];
  return NULL;
}

static bool module_has(void *context, const CagStatement *s, const char *name,
                       const char *const **names, size_t *count) {
  CagVm *vm = context;
  if (s->as.import.module >= vm->module_count) return true; // CAG_NO_MODULE: already reported
  const CagModuleUnit *m = vm->modules[s->as.import.module];
  if (names) {
    *names = m->public_names;
    *count = m->public_count;
  }
  return find_public(m, name) != NULL;
}

// Assigns slots to the module's definitions, and lists its public names.
static void make_globals(CagVm *vm, CagModuleUnit *m) {
  size_t n = m->ast->top_count;
  m->tops = cag_calloc(n ? n : 1, sizeof *m->tops);
  m->publics = cag_calloc(n ? n : 1, sizeof *m->publics);
  m->public_names = cag_calloc(n ? n : 1, sizeof *m->public_names);
  if (!m->tops || !m->publics || !m->public_names) cag_vm_out_of_memory(vm);
  for (size_t i = 0; i < n; i++) {
    CagDecl *d = m->ast->tops[i];
    d->index = i;
    size_t g = m->tops[i] = cag_vm_add_global(vm, d->name);
    const CagStatement *s = d->statement;
    vm->globals[g].expr =
        s->kind == CAG_STATEMENT_PARAM ? s->as.param.value : s->as.definition.value;
    vm->globals[g].unit = m;
    vm->globals[g].span = d->span;
    if (d->whole) vm->globals[g].pattern = s->as.definition.pattern;
    else if (s->kind == CAG_STATEMENT_DEFINITION && s->as.definition.pattern)
      vm->globals[g].whole = m->tops[s->as.definition.decl->index];
    if (d->whole || d->name[0] == '_') continue;
    m->publics[m->public_count] = (struct CagPublicName){d->name, g, d};
    m->public_names[m->public_count++] = d->name;
  }
  CagModuleValue *v = cag_alloc(vm, CAG_MODULE, sizeof *v);
  v->module = m->number;
  m->value = cag_object(CAG_MODULE, v);
}

// Assigns imported names the slots of their definitions.
static void bind_imports(CagVm *vm, CagModuleUnit *m) {
  for (size_t i = 0; i < m->ast->count; i++) {
    CagStatement *s = m->ast->statements[i];
    if (s->kind != CAG_STATEMENT_IMPORT || s->as.import.module == CAG_NO_MODULE) continue;
    const CagModuleUnit *other = vm->modules[s->as.import.module];
    if (s->as.import.decl) {
      size_t g = cag_vm_add_global(vm, s->as.import.decl->name);
      vm->globals[g].value = other->value;
      vm->globals[g].state = CAG_GLOBAL_DONE;
      s->as.import.decl->index = g;
    }
    for (size_t k = 0; k < s->as.import.name_count; k++) {
      const struct CagPublicName *p = find_public(other, s->as.import.names[k].name);
      if (p) s->as.import.names[k].decl->index = p->global;
    }
  }
}

static bool resolve_unit(CagVm *vm, CagModuleUnit *m) {
  CagResolveEnv env = {.context = vm,
                       .find_builtin = find_builtin,
                       .builtin_names = cag_builtin_names(),
                       .builtin_count = cag_builtin_count(),
                       .find_outer = find_outer,
                       .outer_names = vm->outer_names,
                       .outer_count = vm->outer_count,
                       .module_has = module_has};
  return cag_resolve(m->ast, &env, &vm->errors) || !vm->stop || cag_keep_going(vm);
}

static size_t load_unit(CagVm *vm, CagModuleUnit *m, CagParseMode mode) {
  m->state = CAG_MODULE_FAILED;
  if (!check_text(vm, m)) return CAG_NO_MODULE;
  size_t before = vm->errors.count;
  m->ast = cag_parse(m->source, mode, &vm->errors);
  if (!m->ast) {
    m->state = CAG_MODULE_LOST;
    if (vm->stop) cag_keep_going(vm);
    return CAG_NO_MODULE;
  }
  m->sound = vm->errors.count == before;
  m->resolved = m->sound || mode == CAG_PARSE_FILE; // the REPL rejects an entire input
  m->state = CAG_MODULE_LOADING;
  for (size_t i = 0; i < m->ast->count; i++) {
    CagStatement *s = m->ast->statements[i];
    if (s->kind != CAG_STATEMENT_IMPORT) continue;
    s->as.import.module =
        m->resolved && s->damage == CAG_SOUND ? load_import(vm, m, s) : CAG_NO_MODULE;
  }
  m->first_error = vm->errors.count;
  if (m->resolved) {
    make_globals(vm, m);
    bind_imports(vm, m);
    if (!resolve_unit(vm, m)) return CAG_NO_MODULE;
    cag_diagnostics_sort_last(&vm->errors);
  }
  const bool sound = vm->errors.count == before && !vm->starved;
  m->state = sound ? CAG_MODULE_LOADED : vm->starved ? CAG_MODULE_LOST : CAG_MODULE_FAILED;
  return sound ? m->number : CAG_NO_MODULE;
}

// --- Entry points ---

static void set_root(CagVm *vm, const char *real) {
  if (vm->root) return;
  vm->root = cag_strdup(real);
  vm->starved |= !vm->root;
  char *slash = vm->root ? strrchr(vm->root, '/') : NULL;
  if (slash) slash[slash == vm->root ? 1 : 0] = 0;
}

size_t cag_load_file(CagVm *vm, const char *path, int *exit_status) {
  bool input = strcmp(path, "-") == 0;
  size_t length;
  const char *why;
  if (!input) cag_vm_note_file(vm, path);
  char *text = cag_read_whole_file(path, &length, &why);
  *exit_status = 1;
  if (!text) {
    cag_diagnostics_add(&vm->errors, CAG_ERR_module_unreadable, NULL, (CagSpan){0, 0},
                        "cannot read %s: %s", path, why);
    vm->failed = true;
    vm->starved |= why == cag_file_out_of_memory;
    *exit_status = 3;
    return CAG_NO_MODULE;
  }
  CagCleanup text_cleanup, real_cleanup;
  cag_cleanup_push(&text_cleanup, cag_free, text);
  char *real = input ? NULL : cag_vm_real_path(vm, path);
  cag_cleanup_push(&real_cleanup, cag_free, real);
  if (real) set_root(vm, real);
  else if (!vm->root) vm->root = getcwd(NULL, 0);
  CagModuleUnit *m = new_unit(vm, input ? "<stdin>" : path, real, text, length);
  cag_cleanup_run(&real_cleanup);
  cag_cleanup_run(&text_cleanup);
  size_t k = load_unit(vm, m, CAG_PARSE_FILE);
  vm->failed = k == CAG_NO_MODULE;
  return k;
}

size_t cag_load_text(CagVm *vm, const char *name, const char *text, size_t length,
                     CagParseMode mode) {
  if (!vm->root) vm->root = getcwd(NULL, 0);
  size_t k = load_unit(vm, new_unit(vm, name, NULL, text, length), mode);
  vm->failed = k == CAG_NO_MODULE;
  return k;
}

CagModuleUnit *cag_load_document(CagVm *vm, const char *name, const char *path, const char *text,
                                 size_t length) {
  if (path) set_root(vm, path);
  const size_t k = vm->module_count; // imports have higher indices
  load_unit(vm, new_unit(vm, name, path, text, length), CAG_PARSE_FILE);
  return vm->modules[k];
}

const CagSource *cag_read_source(CagVm *vm, const char *name, const char *text, size_t length) {
  CagModuleUnit *m = new_unit(vm, name, NULL, text, length);
  m->state = CAG_MODULE_FAILED; // read, but not to be run
  return check_text(vm, m) ? m->source : NULL;
}

const CagModuleAst *cag_read_script(CagVm *vm, const char *name, const char *text, size_t length) {
  CagModuleUnit *m = new_unit(vm, name, NULL, text, length);
  m->state = CAG_MODULE_FAILED;
  const size_t before = vm->errors.count;
  if (check_text(vm, m)) m->ast = cag_parse(m->source, CAG_PARSE_FILE, &vm->errors);
  vm->failed = vm->errors.count > before;
  return vm->failed ? NULL : m->ast;
}

typedef struct OuterNames {
  CagVm *vm;
  size_t count;
} OuterNames;

static void restore_outer(void *names) {
  const OuterNames *outer = names;
  outer->vm->outer_count = outer->count;
}

bool cag_vm_compile_lambda(CagVm *vm, const char *source, CagValue *out) {
  OuterNames outer = {vm, vm->outer_count};
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, restore_outer, &outer);
  vm->outer_count = 0; // a formula can use only built-in names
  size_t k = cag_load_text(vm, "<formula>", source, strlen(source), CAG_PARSE_REPL);
  cag_cleanup_run(&cleanup);
  if (k == CAG_NO_MODULE) return false;
  CagModuleUnit *m = vm->modules[k];
  if (m->ast->count != 1 || m->ast->statements[0]->kind != CAG_STATEMENT_EXPRESSION)
    return cag_vm_fail(vm, CAG_ERR_parse_text, "a formula is one expression");
  const CagProto *p = cag_compile_expression(vm, m, m->ast->statements[0]->as.expression, NULL);
  return p && cag_vm_run(vm, p, out);
}
