// Helpers for the tests of the front end: parse a text, and compare its tree, errors, or messages
// as text.

#ifndef CAG_TESTS_LANG_SUPPORT_H
#define CAG_TESTS_LANG_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/dump.h"
#include "lang/parser.h"

static const char *const test_builtins[] = {"sin", "cos", "pi",     "max",     "map",  "material",
                                            "sum", "inf", "X",      "Y",       "unit", "sort",
                                            "len", "deg", "reduce", "revolve", "trace"};
#define TEST_BUILTIN_COUNT (sizeof test_builtins / sizeof *test_builtins)

static inline size_t test_find_builtin(void *context, const char *name) {
  (void)context;
  for (size_t i = 0; i < TEST_BUILTIN_COUNT; i++)
    if (strcmp(test_builtins[i], name) == 0) return i;
  return (size_t)-1;
}

// Every module defines glazed and puma560.
static inline bool test_module_has(void *context, const CagStatement *s, const char *name,
                                   const char *const **names, size_t *count) {
  (void)context;
  (void)s;
  static const char *const has[] = {"glazed", "puma560"};
  if (names) *names = has, *count = 2;
  return strcmp(name, has[0]) == 0 || strcmp(name, has[1]) == 0;
}

static inline CagResolveEnv test_env(void) {
  return (CagResolveEnv){.find_builtin = test_find_builtin,
                         .builtin_names = test_builtins,
                         .builtin_count = TEST_BUILTIN_COUNT,
                         .module_has = test_module_has};
}

typedef struct Parsed {
  CagSource *source;
  CagModuleAst *module;
  CagDiagnostics errors;
  char *text; // result of the last of the functions below
} Parsed;

static inline Parsed parse_bytes(const char *text, size_t length, CagParseMode mode) {
  Parsed p = {0};
  p.source = cag_source_new("test.cag", text, length);
  assert_non_null(p.source);
  p.module = cag_parse(p.source, mode, &p.errors);
  assert_non_null(p.module);
  return p;
}

static inline Parsed parse_text(const char *text) {
  return parse_bytes(text, strlen(text), CAG_PARSE_FILE);
}

static inline Parsed resolve_text(const char *text) {
  Parsed p = parse_text(text);
  CagResolveEnv env = test_env();
  if (p.errors.count == 0) cag_resolve(p.module, &env, &p.errors);
  return p;
}

static inline void release(Parsed *p) {
  free(p->text);
  cag_module_ast_free(p->module);
  cag_diagnostics_clear(&p->errors);
  cag_source_free(p->source);
}

// The statements as nested lists, one a line, or the codes of the errors.
static inline const char *tree_of(Parsed *p) {
  free(p->text);
  size_t size;
  FILE *f = open_memstream(&p->text, &size);
  cag_ast_dump(f, p->module);
  fclose(f);
  if (size && p->text[size - 1] == '\n') p->text[size - 1] = 0;
  return p->text;
}

// The code and location of each error: "E0123 1:5, E0120 2:1".
static inline const char *errors_of(Parsed *p) {
  free(p->text);
  size_t size;
  FILE *f = open_memstream(&p->text, &size);
  for (size_t i = 0; i < p->errors.count; i++) {
    const CagDiagnostic *d = &p->errors.items[i];
    CagPosition at = cag_source_position(d->source, d->span.start);
    fprintf(f, "%s%s %zu:%zu", i ? ", " : "", cag_error_info(d->id)->code, at.line, at.column);
  }
  fclose(f);
  return p->text;
}

static inline void expect_tree(const char *text, const char *tree) {
  Parsed p = parse_text(text);
  assert_string_equal(errors_of(&p), "");
  assert_string_equal(tree_of(&p), tree);
  release(&p);
}

// The tree of an expression, written as the value of `x`.
static inline void value_is(const char *expression, const char *tree) {
  char text[1024], wanted[1024];
  snprintf(text, sizeof text, "x = %s\n", expression);
  snprintf(wanted, sizeof wanted, "(= x %s)", tree);
  expect_tree(text, wanted);
}

static inline void expect_errors(const char *text, const char *errors) {
  Parsed p = resolve_text(text);
  assert_string_equal(errors_of(&p), errors);
  release(&p);
}

// Checks that the first error has this code, and its help contains these words.
static inline void expect_help(const char *text, const char *code, const char *help) {
  Parsed p = resolve_text(text);
  assert_true(p.errors.count >= 1);
  assert_string_equal(cag_error_info(p.errors.items[0].id)->code, code);
  const char *said = p.errors.items[0].help ? p.errors.items[0].help : "";
  if (!strstr(said, help)) fail_msg("%s: the help `%s` lacks `%s`", text, said, help);
  release(&p);
}

static inline const char *messages_of(Parsed *p, CagDiagnosticStyle style) {
  free(p->text);
  size_t size;
  FILE *f = open_memstream(&p->text, &size);
  cag_diagnostics_render(&p->errors, style, f);
  fclose(f);
  return p->text;
}

#endif
