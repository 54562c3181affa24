// cag explain [CODE]: explains an error code, or lists all of them.

#include "base/diagnostic.h"
#include "cli/tool.h"

static int list_codes(void) {
  const char *code, *title;
  for (size_t i = 0; cag_error_kind(i, &code, NULL, &title, NULL); i++)
    printf("%s  %s\n", code, title);
  return CAG_STATUS_OK;
}

int cag_tool_explain(CagTool *t, int argc, char **argv) {
  if (argc == 0) return list_codes();
  if (cag_explain(argv[0], stdout)) return CAG_STATUS_OK;
  const char *names[2 * CAG_ERR_COUNT], *code, *reason;
  size_t count = 0;
  for (size_t i = 0; cag_error_kind(i, &code, &reason, NULL, NULL); i++) {
    names[count++] = code;
    names[count++] = reason;
  }
  const char *nearest = cag_nearest_name(argv[0], names, count);
  return cag_tool_fail(t, CAG_STATUS_USAGE, "`cag explain` lists all codes",
                       "unknown error code `%s`%s%s%s", argv[0], nearest ? "; the nearest is " : "",
                       nearest ? nearest : "", "");
}
