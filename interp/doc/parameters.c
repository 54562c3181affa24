// What parameters take, looked up in parameters.def.

#include <string.h>

#include "interp/doc/doc.h"

static const CagDocParameter parameters[] = {
#define CAG_PARAMETER(functions, name, type, meaning) {functions, name, type, meaning},
#include "interp/doc/parameters.def"
#undef CAG_PARAMETER
};
#define PARAMETER_COUNT (sizeof parameters / sizeof *parameters)

static bool has_word(const char *words, const char *word) {
  const size_t n = strlen(word);
  for (const char *at = words; (at = strstr(at, word)); at += n)
    if ((at == words || at[-1] == ' ') && (at[n] == ' ' || at[n] == 0)) return true;
  return false;
}

const CagDocParameter *cag_doc_parameter(const char *function, const char *parameter) {
  const CagDocParameter *common = NULL;
  for (size_t i = 0; i < PARAMETER_COUNT; i++) {
    const CagDocParameter *p = &parameters[i];
    if (strcmp(p->name, parameter) != 0) continue;
    if (*p->functions && has_word(p->functions, function)) return p;
    if (!*p->functions && !common) common = p;
  }
  return common;
}
