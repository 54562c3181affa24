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

static const CagDocParameter *find(const char *word, const char *parameter) {
  for (size_t i = 0; i < PARAMETER_COUNT; i++)
    if (strcmp(parameters[i].name, parameter) == 0 &&
        (*word ? has_word(parameters[i].functions, word) : !*parameters[i].functions))
      return &parameters[i];
  return NULL;
}

const CagDocParameter *cag_doc_parameter(const char *function, const char *parameter) {
  const CagDocParameter *own = find(function, parameter);
  return own ? own : find("", parameter);
}

const CagDocParameter *cag_doc_module_parameter(const char *module, const char *function,
                                                const char *parameter) {
  char word[160];
  if (strncmp(module, "std.", 4) != 0) return NULL;
  snprintf(word, sizeof word, "%s.%s", module + 4, function);
  const CagDocParameter *own = find(word, parameter);
  return own ? own : find(module + 4, parameter);
}
