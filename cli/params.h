// Named sets of params, as the page of `cag view` keeps them beside a script: {"tall": {"height":
// 200}}.

#ifndef CAG_CLI_PARAMS_H
#define CAG_CLI_PARAMS_H

#include "cli/tool.h"

typedef void CagParamGive(void *context, const char *name, const char *value);

// Calls `give` for each param of the set that `place`, FILE:NAME, names, with its value as the text
// of an expression. Returns false, with the reason in `why`, if there is no such set.
bool cag_params_read(const char *place, CagParamGive *give, void *context, CagToolRefusal *why);

#endif
