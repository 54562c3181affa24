// Calls of every built-in with one argument of a different type.
//
// The calls are those of the examples in the table of built-ins. In each call, every argument in
// turn is replaced by a value of another type, and every omitted parameter is given one. If the
// documentation of the parameter (interp/doc/parameters.def, via interp/check) rules the type out,
// the call must fail at its own location, with the function's name. Otherwise the call may fail as
// well, but only with an error of a known kind, and it must not print an undefined number. The same
// holds for calls with arguments that depend on the parameter of a formula that is differentiated.

#include <ctype.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cag.h"
#include "interp/check/types.h"

#define LONGEST 8192 // bytes of one script
#define ARGUMENTS 24 // of one call
// Limits of one script, because some values cause a great amount of work.
#define SECONDS 2.0
#define MEMORY ((size_t)256 << 20)
#define TRIANGLES 50000

typedef struct Sample {
  CagType type;
  const char *text;
} Sample;

static const Sample samples[] = {
    {CAG_BOOL, "true"},
    {CAG_NUMBER, "7.5"},
    {CAG_NUMBER, "-1"},
    {CAG_NUMBER, "inf"},
    {CAG_ANGLE, "30deg"},
    {CAG_TEXT, "\"word\""},
    {CAG_LIST, "[]"},
    {CAG_LIST, "[1, inf, 0]"},
    {CAG_LIST, "[\"a\", none]"},
    {CAG_LIST, "[[0, 0, 0], [0, 0, 0]]"},
    {CAG_LIST, "[rectangle(1, 1), [sphere(1), q => q]]"},
    {CAG_LIST,
     "[line([0, 0, 0], [1, 1, 1]), rectangle(1, 1), sphere(1), mesh([X, Y, Z], [[0, 1, 2]])]"},
    {CAG_RANGE, "3..1"},
    {CAG_RECORD, "{a: 1}"},
    {CAG_CLOSURE, "(q => \"word\")"},
    {CAG_CURVE, "line([0, 0], [0, 0.5])"},
    {CAG_CURVE, "curve(q => [q, q^2, 1], 0..1)"},
    {CAG_SURFACE, "surface((q, r) => [q, r, q * r])"},
    {CAG_SOLID, "sphere(1)"},
    {CAG_NONE, "none"},
};
#define SAMPLE_COUNT (sizeof samples / sizeof *samples)

// --- The calls of an example ---

typedef struct Argument {
  size_t from, to; // of the value in the script
  size_t parameter;
} Argument;

typedef struct Call {
  size_t from, open, close; // of the name and the parentheses in the script
  Argument arguments[ARGUMENTS];
  size_t count;
} Call;

static bool in_word(char c) { return isalnum((unsigned char)c) || c == '_'; }

// Skips a text or a comment that begins at `at`. Returns `at` if there is none.
static size_t behind_quoted(const char *s, size_t at) {
  if (s[at] == '/' && s[at + 1] == '/') return at + strcspn(s + at, "\n");
  if (s[at] != '"') return at;
  for (at++; s[at] && s[at] != '"'; at++)
    if (s[at] == '\\' && s[at + 1]) at++;
  return s[at] ? at + 1 : at;
}

// Returns the next comma or closing bracket at the nesting level of `at`.
static size_t item_end(const char *s, size_t at) {
  for (int depth = 0; s[at];) {
    size_t behind = behind_quoted(s, at);
    if (behind > at) {
      at = behind;
      continue;
    }
    if (strchr("([{", s[at])) depth++;
    if (depth == 0 && strchr(",)]}", s[at])) return at;
    if (strchr(")]}", s[at])) depth--;
    at++;
  }
  return at;
}

static size_t parameter_of(const CagSignature *s, const char *item, size_t n, size_t position,
                           size_t *name) {
  size_t word = 0;
  while (word < n && in_word(item[word])) word++;
  *name = 0;
  if (word == 0 || item[word] != ':') return position;
  for (size_t i = 0; i < s->count; i++)
    if (strlen(s->parameters[i]) == word && strncmp(s->parameters[i], item, word) == 0) {
      *name = word + 1;
      return i;
    }
  return position;
}

// Reads the arguments of a call whose parenthesis opens at `open`.
static bool read_call(const char *text, size_t open, const CagSignature *s, Call *out) {
  out->open = open;
  out->count = 0;
  for (size_t at = open + 1; text[at];) {
    size_t end = item_end(text, at), name;
    at += strspn(text + at, " \n");
    if (at < end && out->count < ARGUMENTS) {
      Argument *a = &out->arguments[out->count];
      a->parameter = parameter_of(s, text + at, end - at, out->count, &name);
      a->from = at + name;
      a->to = end;
      out->count++;
    }
    if (text[end] != ',') {
      out->close = end;
      return text[end] == ')';
    }
    at = end + 1;
  }
  return false;
}

// Finds the next call of the function from `at` on that is not in a pipe, where the first argument
// precedes the call.
static bool find_call(const char *text, size_t at, const CagSignature *s, Call *out) {
  const size_t n = strlen(s->name);
  while (text[at]) {
    size_t behind = behind_quoted(text, at);
    if (behind > at) {
      at = behind;
      continue;
    }
    if (!in_word(text[at])) {
      at++;
      continue;
    }
    size_t end = at;
    while (in_word(text[end])) end++;
    size_t before = at;
    while (before > 0 && text[before - 1] == ' ') before--;
    bool pipe = before > 1 && text[before - 1] == '>' && text[before - 2] == '|';
    out->from = at;
    if (end - at == n && strncmp(text + at, s->name, n) == 0 && text[end] == '(' && !pipe &&
        (at == 0 || text[at - 1] != '.') && read_call(text, end, s, out))
      return true;
    at = end;
  }
  return false;
}

// --- Running ---

typedef struct Run {
  size_t scripts, ruled_out, bad;
} Run;

static size_t line_at(const char *text, size_t at) {
  size_t line = 1;
  for (size_t i = 0; i < at; i++) line += text[i] == '\n';
  return line;
}

// Whether the text contains the word nan, not as part of a longer word.
static bool undefined(const char *text) {
  for (const char *s = strstr(text, "nan"); s; s = strstr(s + 1, "nan"))
    if ((s == text || !isalpha((unsigned char)s[-1])) && !isalpha((unsigned char)s[3])) return true;
  return false;
}

static const char *judge(CagSession *s, int status, const char *output, bool ruled_out,
                         const char *name, size_t first, size_t last) {
  CagErrorView e;
  if (status == CAG_STATUS_OK) {
    if (ruled_out) return "it takes a type that its documentation rules out";
    return undefined(output) ? "an undefined number is printed" : NULL;
  }
  if (cag_session_error_count(s) == 0) return "the script fails without an error";
  for (size_t i = cag_session_error_count(s); i-- > 0;) {
    cag_session_error(s, i, &e);
    if (e.code && strcmp(e.code, "E0399") == 0) return "the built-in goes on after an error";
  }
  if (!e.code || strcmp(e.code, "E0000") == 0) return "an error without a code";
  if (!ruled_out) return NULL;
  if (e.line < first || e.line > last) return "the error is at another location";
  return e.message && strstr(e.message, name) ? NULL : "the message does not name the function";
}

// Runs the script with text[from, to) replaced by `before` and `value`.
static void run_with(Run *r, const CagSignature *s, const char *text, const Call *call, size_t from,
                     size_t to, const char *before, const char *value, bool ruled_out) {
  char script[LONGEST];
  int n = snprintf(script, sizeof script, "%.*s%s%s%s", (int)from, text, before, value, text + to);
  if (n < 0 || (size_t)n >= sizeof script) return;
  CagSessionOptions options;
  char *output = NULL;
  size_t size = 0;
  cag_session_options_init(&options);
  options.max_time = SECONDS;
  options.max_memory = MEMORY;
  options.max_triangles = TRIANGLES;
  options.folder = "tests/language";
  options.out = open_memstream(&output, &size);
  options.messages = fopen("/dev/null", "w");
  CagSession *session = cag_session_new(&options);
  int status = cag_session_run_text(session, "arguments.cag", script, strlen(script));
  fclose(options.out);
  fclose(options.messages);
  const char *wrong = judge(session, status, output, ruled_out, s->name, line_at(text, call->from),
                            line_at(text, call->close));
  r->scripts++;
  r->ruled_out += ruled_out;
  if (wrong) {
    print_error("--- %s, as `%s`: %s\n%s\n", wrong, value, s->name, script);
    cag_session_write_diagnostics(session, CAG_STYLE_TEXT, stderr);
    r->bad++;
  }
  cag_session_free(session);
  free(output);
}

// Whether all rows of the name reject the type for this parameter.
static bool rules_out(size_t index, const CagBuiltin *row, const CagSignature *s, size_t parameter,
                      size_t positional, CagType type) {
  if (parameter >= s->count || type == CAG_NONE) return false;
  if (parameter == 0) {
    size_t other = cag_builtin_select(index, type, positional), rows;
    if (other == (size_t)-1) return true;
    row = cag_builtin_rows(index, &rows) + other;
    s = cag_builtin_signature(index, other);
    if (s->count == 0) return false;
  }
  return !(cag_types_taken(row, s, parameter) & (CagTypes)1 << type);
}

static bool has_argument(const Call *call, size_t parameter) {
  for (size_t i = 0; i < call->count; i++)
    if (call->arguments[i].parameter == parameter) return true;
  return false;
}

static void vary(Run *r, size_t index, const CagBuiltin *row, const CagSignature *s,
                 const Call *call) {
  const char *text = row->example;
  char before[80];
  for (size_t k = 0; k < SAMPLE_COUNT; k++) {
    for (size_t i = 0; i < call->count; i++) {
      const Argument *a = &call->arguments[i];
      run_with(r, s, text, call, a->from, a->to, "", samples[k].text,
               rules_out(index, row, s, a->parameter, call->count, samples[k].type));
    }
    for (size_t p = 1; p < s->count; p++) {
      if (has_argument(call, p) || s->positional_only[p] || call->count == 0) continue;
      snprintf(before, sizeof before, ", %s: ", s->parameters[p]);
      run_with(r, s, text, call, call->close, call->close, before, samples[k].text,
               rules_out(index, row, s, p, call->count, samples[k].type));
    }
  }
}

static void arguments_of_another_type_are_errors_at_the_call(void **state) {
  (void)state;
  Run r = {0};
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    const CagBuiltin *row = cag_builtin_rows(i, &rows);
    for (size_t k = 0; k < rows; k++) {
      const CagSignature *s = cag_builtin_signature(i, k);
      Call call;
      if (s && row[k].example && !strstr(row[k].example, "attempt(") &&
          find_call(row[k].example, 0, s, &call))
        vary(&r, i, &row[k], s, &call);
    }
  }
  print_message("%zu scripts, %zu of them ruled out\n", r.scripts, r.ruled_out);
  assert_true(r.ruled_out > 0);
  assert_int_equal(r.bad, 0);
}

// --- Differentiated calls ---

// Values that depend on the parameter t_ of a formula. The first ones are combined with each of the
// others as the next argument.
static const char *const JETS[] = {"t_",
                                   "[t_, 1]",
                                   "[t_, 1, 2]",
                                   "t_ * 1rad",
                                   "[[t_, 1], [2, t_]]",
                                   "[[t_, 1, 0], [2, t_, 1], [0, 1, t_]]",
                                   "[t_, \"a\"]",
                                   "{a: t_}"};
static const char *const OTHERS[] = {"-1", "t_", "[1, t_]", "[1, 2, 3]", "\"word\"", "none"};
#define WITH_OTHERS 3
#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

// Puts the call, with some arguments replaced, in a formula whose tangent is computed.
static void differentiate(Run *r, const CagSignature *s, const char *text, const Call *call,
                          const char *const *values) {
  char formula[LONGEST];
  size_t at = call->from;
  int n = snprintf(formula, sizeof formula, "tangent(curve(t_ => [t_, if t_ != 0.3 then 0 else ");
  for (size_t i = 0; i < call->count; i++) {
    const Argument *a = &call->arguments[i];
    n += snprintf(formula + n, sizeof formula - (size_t)n, "%.*s%s", (int)(a->from - at), text + at,
                  values[i] ? values[i] : "");
    at = values[i] ? a->to : a->from;
  }
  n += snprintf(formula + n, sizeof formula - (size_t)n, "%.*s], 0..1), 0.3)",
                (int)(call->close + 1 - at), text + at);
  if (n > 0 && (size_t)n < sizeof formula)
    run_with(r, s, text, call, call->from, call->close + 1, "", formula, false);
}

static void differentiated_calls_give_a_value_or_a_known_error(void **state) {
  (void)state;
  Run r = {0};
  for (size_t i = 0; i < cag_builtin_count(); i++) {
    size_t rows;
    const CagBuiltin *row = cag_builtin_rows(i, &rows);
    for (size_t k = 0; k < rows; k++) {
      const CagSignature *s = cag_builtin_signature(i, k);
      Call call;
      if (!s || !row[k].example || strstr(row[k].example, "attempt(") ||
          !find_call(row[k].example, 0, s, &call))
        continue;
      for (size_t a = 0; a < call.count; a++)
        for (size_t j = 0; j < COUNT_OF(JETS); j++) {
          const char *values[ARGUMENTS] = {0};
          values[a] = JETS[j];
          differentiate(&r, s, row[k].example, &call, values);
          for (size_t m = 0; j < WITH_OTHERS && call.count > 1 && m < COUNT_OF(OTHERS); m++) {
            values[(a + 1) % call.count] = OTHERS[m];
            differentiate(&r, s, row[k].example, &call, values);
          }
        }
    }
  }
  print_message("%zu scripts\n", r.scripts);
  assert_true(r.scripts > 0);
  assert_int_equal(r.bad, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(arguments_of_another_type_are_errors_at_the_call),
      cmocka_unit_test(differentiated_calls_give_a_value_or_a_known_error),
  };
  return cmocka_run_group_tests_name("arguments of built-ins", tests, NULL, NULL);
}
