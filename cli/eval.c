// cag eval 'EXPR' ...: prints the value of each expression.
//
// The expressions are inputs of an interactive session, so each can use the definitions before it.
// -D adds such definitions. The first error ends the command.

#include <stdlib.h>
#include <string.h>

#include "cli/tool.h"

// Writes a quoted text without quotes, as `print` does. The session returns it with the escapes of
// a script.
static void write_bare(const char *quoted, FILE *out) {
  const char *end = quoted + strlen(quoted) - 1;
  for (const char *at = quoted + 1; at < end; at++) {
    if (*at != '\\') {
      fputc(*at, out);
    } else if (*++at == 'u') { // only control characters have this form
      char *stop;
      fputc((int)strtol(at + 2, &stop, 16), out);
      at = stop;
    } else {
      fputc(*at == 'n' ? '\n' : *at == 't' ? '\t' : *at, out);
    }
  }
  fputc('\n', out);
}

static void print_value(void *context, const char *text, const char *type) {
  (void)context;
  if (!strcmp(type, "text")) write_bare(text, stdout);
  else puts(text);
}

static int input(CagTool *t, CagSession *s, const char *text) {
  return cag_tool_finish(t, s, cag_session_input(s, text, strlen(text), print_value, NULL));
}

static int input_define(CagTool *t, CagSession *s, const CagToolDefine *d) {
  char *text;
  if (asprintf(&text, "%s = %s", d->name, d->value) < 0)
    return cag_tool_fail(t, CAG_STATUS_LIMIT, NULL, "out of memory");
  const int status = input(t, s, text);
  free(text);
  return status;
}

int cag_tool_eval(CagTool *t, int argc, char **argv) {
  CagSession *s = cag_tool_session(t);
  if (!s) return CAG_STATUS_LIMIT;
  int status = CAG_STATUS_OK;
  for (size_t i = 0; i < t->define_count && status == CAG_STATUS_OK; i++)
    status = input_define(t, s, &t->defines[i]);
  for (int i = 0; i < argc && status == CAG_STATUS_OK; i++) status = input(t, s, argv[i]);
  cag_session_free(s);
  return status;
}
