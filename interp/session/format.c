// Formatting a script.

#include "lang/format.h"

#include "interp/session/session.h"

typedef struct Layout {
  const char *name, *text;
  size_t length;
  char **out;
  size_t *out_length;
} Layout;

static bool lay_out(CagVm *vm, void *context) {
  Layout *l = context;
  const CagSource *source = cag_read_source(vm, l->name, l->text, l->length);
  if (source) *l->out = cag_format(source, &vm->errors, l->out_length);
  vm->failed = !*l->out;
  return *l->out != NULL;
}

int cag_session_format(CagSession *s, const char *name, const char *text, size_t length, char **out,
                       size_t *out_length) {
  Layout l = {name, text, length, out, out_length};
  *out = NULL;
  *out_length = 0;
  if (!cag_session_begin(s)) return CAG_STATUS_USAGE;
  cag_session_drop_vm(s);
  return cag_session_end(s, cag_session_work(s, lay_out, &l));
}
