// Checking a script without running it.

#include "interp/check/check.h"

#include "interp/session/session.h"

typedef struct Check {
  const char *path, *name, *text;
  size_t length;
} Check;

static bool check(CagVm *vm, void *context) {
  const Check *c = context;
  int status;
  const size_t k = vm->module_count; // imports have higher indices
  const size_t loaded = c->path ? cag_load_file(vm, c->path, &status)
                                : cag_load_text(vm, c->name, c->text, c->length, CAG_PARSE_FILE);
  if (loaded == CAG_NO_MODULE && (k >= vm->module_count || !vm->modules[k]->resolved)) return false;
  return cag_check_module(vm, vm->modules[k]) && loaded != CAG_NO_MODULE;
}

static int start_check(CagSession *s, Check *c) {
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  cag_session_drop_vm(s);
  return cag_session_end(s, cag_session_work(s, check, c));
}

int cag_session_check_file(CagSession *s, const char *path) {
  return start_check(s, &(Check){.path = path});
}

int cag_session_check_text(CagSession *s, const char *name, const char *text, size_t length) {
  return start_check(s, &(Check){.name = name, .text = text, .length = length});
}
