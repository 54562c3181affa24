// Lookup of the meaning of parameters in parameters.def and library_parameters.def.

#include <string.h>

#include "interp/doc/doc.h"

static const CagDocParameter builtins[] =
    {
#define CAG_PARAMETER(functions, name, meaning) {functions, name, "", meaning},
#include "interp/doc/parameters.def"
#undef CAG_PARAMETER
},
                             library[] = {
#define CAG_LIBRARY_PARAMETER(functions, name, type, meaning) {functions, name, type, meaning},
#include "interp/doc/library_parameters.def"
#undef CAG_LIBRARY_PARAMETER
};
#define COUNT(array) (sizeof(array) / sizeof *(array))

static bool has_word(const char *words, const char *word) {
  const size_t n = strlen(word);
  for (const char *at = words; (at = strstr(at, word)); at += n)
    if ((at == words || at[-1] == ' ') && (at[n] == ' ' || at[n] == 0)) return true;
  return false;
}

static const CagDocParameter *find_row(const CagDocParameter *rows, size_t count, const char *word,
                                       const char *parameter) {
  for (size_t i = 0; i < count; i++)
    if (strcmp(rows[i].name, parameter) == 0 &&
        (*word ? has_word(rows[i].functions, word) : !*rows[i].functions))
      return &rows[i];
  return NULL;
}

const char *cag_doc_meaning(const char *function, const char *parameter) {
  const CagDocParameter *row = find_row(builtins, COUNT(builtins), function, parameter);
  if (!row) row = find_row(builtins, COUNT(builtins), "", parameter);
  return row ? row->meaning : "";
}

const CagDocParameter *cag_doc_module_parameter(const char *module, const char *function,
                                                const char *parameter) {
  char word[160];
  if (strncmp(module, "std.", 4) != 0) return NULL;
  snprintf(word, sizeof word, "%s.%s", module + 4, function);
  const CagDocParameter *own = find_row(library, COUNT(library), word, parameter);
  return own ? own : find_row(library, COUNT(library), module + 4, parameter);
}
