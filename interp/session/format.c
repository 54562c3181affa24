// The one layout of a script.

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
  const CagModuleAst *m = cag_read_script(vm, l->name, l->text, l->length);
  if (m) *l->out = cag_format(m, l->out_length);
  return m != NULL;
}

int cag_session_format(CagSession *s, const char *name, const char *text, size_t length, char **out,
                       size_t *out_length) {
  Layout l = {name, text, length, out, out_length};
  *out = NULL;
  *out_length = 0;
  cag_session_drop_vm(s);
  return cag_session_work(s, lay_out, &l);
}
