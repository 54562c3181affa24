// Lookups in the table of foreign words. They are needed only to report errors, so they are linear.

#include "lang/foreign.h"

#include <string.h>

typedef enum Kind { NAME, MEMBER, ARGUMENT, CALL } Kind;

typedef struct Row {
  Kind kind;
  const char *word, *form, *meant; // meant: the parameter of an ARGUMENT
} Row;

static const Row words[] = {
#define CAG_FOREIGN_NAME(word, form) {NAME, word, form, NULL},
#define CAG_FOREIGN_MEMBER(word, form) {MEMBER, word, form, NULL},
#define CAG_FOREIGN_ARGUMENT(word, meant, example, form) {ARGUMENT, word, form, meant},
#define CAG_FOREIGN_CALL(function, example, form) {CALL, function, form, NULL},
#define CAG_FOREIGN_SYNTAX(id, example, form)
#include "lang/foreign.def"
#undef CAG_FOREIGN_NAME
#undef CAG_FOREIGN_MEMBER
#undef CAG_FOREIGN_ARGUMENT
#undef CAG_FOREIGN_CALL
#undef CAG_FOREIGN_SYNTAX
};

static const char *const forms[] = {
#define CAG_FOREIGN_NAME(word, form)
#define CAG_FOREIGN_MEMBER(word, form)
#define CAG_FOREIGN_ARGUMENT(word, meant, example, form)
#define CAG_FOREIGN_CALL(function, example, form)
#define CAG_FOREIGN_SYNTAX(id, example, form) form,
#include "lang/foreign.def"
};

const char *cag_foreign_syntax(CagForeignSyntax id) { return forms[id]; }

static const char *find(Kind kind, const char *word) {
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (words[i].kind == kind && strcmp(words[i].word, word) == 0) return words[i].form;
  return NULL;
}

const char *cag_foreign_name(const char *word) { return find(NAME, word); }
const char *cag_foreign_member(const char *word) { return find(MEMBER, word); }
const char *cag_foreign_call(const char *function) { return find(CALL, function); }

const char *cag_foreign_argument(const char *word, const char *const *parameters, size_t count,
                                 const char **form) {
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    if (words[i].kind != ARGUMENT || strcmp(words[i].word, word) != 0) continue;
    *form = words[i].form;
    for (size_t k = 0; k < count; k++)
      if (strcmp(parameters[k], words[i].meant) == 0) return words[i].meant;
  }
  return NULL;
}
