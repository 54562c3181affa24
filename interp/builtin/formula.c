// Formulas in text: "a*cos(t)" becomes a function.
//
// A formula is arithmetic of numbers: its own parser reads it, so that errors are about the formula
// and no name outside of the lists here can be reached, and writes it as an expression of the
// language, which the machine compiles like any other. Numbers stand for radians where a
// trigonometric function wants an angle: sin(t) is written sin((t) * 1rad), atan(t) as (atan(t)) /
// 1rad.
//
//     formula = sum
//     sum     = product { ( "+" | "-" ) product }
//     product = signed { ( "*" | "/" | "%" ) signed }
//     signed  = [ "-" | "+" ] signed | power
//     power   = primary [ "^" signed ]
//     primary = number | name | name "(" sum { "," sum } ")" | "(" sum ")"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <utf8proc.h>

#include "interp/builtin/support.h"

// Functions of formulas: X(name, fewest arguments, most, takes radians, gives radians). They are
// built-ins of the same name.
#define MANY 100
#define FUNCTIONS(X)                                                                               \
  X(sin, 1, 1, true, false)                                                                        \
  X(cos, 1, 1, true, false)                                                                        \
  X(tan, 1, 1, true, false)                                                                        \
  X(asin, 1, 1, false, true)                                                                       \
  X(acos, 1, 1, false, true)                                                                       \
  X(atan, 1, 1, false, true)                                                                       \
  X(atan2, 2, 2, false, true)                                                                      \
  X(sinh, 1, 1, false, false)                                                                      \
  X(cosh, 1, 1, false, false)                                                                      \
  X(tanh, 1, 1, false, false)                                                                      \
  X(asinh, 1, 1, false, false)                                                                     \
  X(acosh, 1, 1, false, false)                                                                     \
  X(atanh, 1, 1, false, false)                                                                     \
  X(exp, 1, 1, false, false)                                                                       \
  X(ln, 1, 1, false, false)                                                                        \
  X(log10, 1, 1, false, false)                                                                     \
  X(log2, 1, 1, false, false)                                                                      \
  X(sqrt, 1, 1, false, false)                                                                      \
  X(cbrt, 1, 1, false, false)                                                                      \
  X(abs, 1, 1, false, false)                                                                       \
  X(sign, 1, 1, false, false)                                                                      \
  X(floor, 1, 1, false, false)                                                                     \
  X(ceil, 1, 1, false, false)                                                                      \
  X(round, 1, 2, false, false)                                                                     \
  X(hypot, 1, MANY, false, false)                                                                  \
  X(min, 1, MANY, false, false)                                                                    \
  X(max, 1, MANY, false, false)

typedef struct Function {
  const char *name;
  size_t fewest, most;
  bool takes_radians, gives_radians;
} Function;

static const Function functions[] = {
#define X(name, fewest, most, takes, gives) {#name, fewest, most, takes, gives},
    FUNCTIONS(X)
#undef X
};
#define FUNCTION_COUNT (sizeof functions / sizeof *functions)

static const char *const constants[] = {"pi", "tau"};
#define CONSTANT_COUNT (sizeof constants / sizeof *constants)

// --- Words ---

typedef struct Word {
  const char *s;
  size_t n;
} Word;

static bool word_is(Word w, const char *text) {
  return strlen(text) == w.n && memcmp(w.s, text, w.n) == 0;
}

static const Function *find_function(Word w) {
  for (size_t i = 0; i < FUNCTION_COUNT; i++)
    if (word_is(w, functions[i].name)) return &functions[i];
  return NULL;
}

static bool is_constant(Word w) {
  for (size_t i = 0; i < CONSTANT_COUNT; i++)
    if (word_is(w, constants[i])) return true;
  return false;
}

static bool is_reserved(Word w) {
  static const char *const words[] = {"and", "as",    "assert", "by",   "else", "false",
                                      "for", "if",    "import", "in",   "none", "not",
                                      "or",  "param", "print",  "show", "then", "true"};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (word_is(w, words[i])) return true;
  return false;
}

static bool is_letter(utf8proc_int32_t c) {
  utf8proc_category_t category = utf8proc_category(c);
  return c == '_' || (category >= UTF8PROC_CATEGORY_LU && category <= UTF8PROC_CATEGORY_LO);
}

// The end of the name that begins at s: a letter, then letters, digits and combining marks. s
// itself where none begins.
static const char *name_end(const char *s, const char *end) {
  const char *begin = s;
  while (s < end) {
    utf8proc_int32_t c;
    utf8proc_ssize_t n = utf8proc_iterate((const utf8proc_uint8_t *)s, end - s, &c);
    if (n <= 0) break;
    utf8proc_category_t category = utf8proc_category(c);
    bool mark = category == UTF8PROC_CATEGORY_MN || category == UTF8PROC_CATEGORY_MC ||
                category == UTF8PROC_CATEGORY_ND;
    if (!is_letter(c) && (s == begin || !mark)) break;
    s += n;
  }
  return s;
}

// --- The parser ---

typedef struct Parser {
  CagCall *call;
  const char *text;
  const char *at, *end;
  const CagList *names;
  CagString *out; // the expression of the language; held
  int depth;
} Parser;

static bool fail_here(Parser *p, const char *place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static bool fail_here(Parser *p, const char *place, const char *format, ...) {
  char message[200];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  size_t column = 1;
  for (const char *s = p->text; s < place; s += cag_character_size(s)) column++;
  return cag_fail_call(p->call, 0, CAG_ERR_parse_text, "cannot read \"%.80s\": column %zu: %s",
                       p->text, column, message);
}

static void write_text(Parser *p, const char *s) { cag_string_add(p->out, s, strlen(s)); }

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static void skip_blank(Parser *p) {
  while (cag_is_space(*p->at)) p->at++;
}

static char peek(Parser *p) {
  skip_blank(p);
  return *p->at;
}

static bool accept_char(Parser *p, char c) {
  if (peek(p) != c) return false;
  p->at++;
  return true;
}

static bool parse_sum(Parser *p);
static bool parse_signed(Parser *p);

// digits [ "." digits ] [ "e" sign digits ], with the digits on one side of the point left out
// where one likes
static bool parse_number(Parser *p) {
  const char *from = p->at;
  double x;
  while (is_digit(*p->at) || *p->at == '.') p->at++;
  const char *e = p->at;
  if (*e == 'e' || *e == 'E') {
    e++;
    if (*e == '+' || *e == '-') e++;
    if (is_digit(*e)) {
      while (is_digit(*e)) e++;
      p->at = e;
    }
  }
  if (!cag_read_number(from, (size_t)(p->at - from), &x)) return fail_here(p, from, "not a number");
  cag_print_number(p->out, x);
  return true;
}

static bool is_parameter(Parser *p, Word w) {
  for (size_t i = 0; i < p->names->length; i++)
    if (word_is(w, CAG_AS_TEXT(cag_list_get(p->call->vm, p->names, i))->bytes)) return true;
  return false;
}

static bool fail_unknown(Parser *p, Word w) {
  const char *candidates[FUNCTION_COUNT + CONSTANT_COUNT];
  size_t n = 0;
  for (size_t i = 0; i < FUNCTION_COUNT; i++) candidates[n++] = functions[i].name;
  for (size_t i = 0; i < CONSTANT_COUNT; i++) candidates[n++] = constants[i];
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)w.n, w.s);
  fail_here(p, w.s, "`%s` is not a parameter, function, or constant of formulas", name);
  const char *nearest = word_is(w, "log") ? "ln` or `log10" : cag_nearest_name(name, candidates, n);
  if (nearest) cag_fail_help(p->call->vm, "did you mean `%s`?", nearest);
  else cag_fail_help(p->call->vm, "add it to the parameters: formula(\"...\", [\"%s\"])", name);
  return false;
}

// sum { "," sum } ")" behind the name of a function and `(`
static bool parse_arguments(Parser *p, const Function *f, const char *place) {
  size_t count = 0;
  write_text(p, f->gives_radians ? "(" : "");
  write_text(p, f->name);
  write_text(p, "(");
  if (peek(p) != ')') {
    do {
      if (count++ > 0) write_text(p, ", ");
      write_text(p, f->takes_radians ? "(" : "");
      if (!parse_sum(p)) return false;
      write_text(p, f->takes_radians ? ")*1rad" : "");
    } while (accept_char(p, ','));
  }
  if (!accept_char(p, ')'))
    return fail_here(p, p->at, "expected `)` at the end of the arguments of %s", f->name);
  write_text(p, f->gives_radians ? ")/1rad)" : ")");
  if (count >= f->fewest && count <= f->most) return true;
  return fail_here(p, place, "%s takes %zu argument%s, found %zu", f->name,
                   count < f->fewest ? f->fewest : f->most,
                   (count < f->fewest ? f->fewest : f->most) == 1 ? "" : "s", count);
}

static bool parse_name(Parser *p) {
  Word w = {p->at, (size_t)(name_end(p->at, p->end) - p->at)};
  p->at += w.n;
  const Function *f = find_function(w);
  if (f) {
    if (accept_char(p, '(')) return parse_arguments(p, f, w.s);
    return fail_here(p, w.s, "%s expects its argument in parentheses: %s(...)", f->name, f->name);
  }
  if (!is_parameter(p, w) && !is_constant(w)) return fail_unknown(p, w);
  cag_string_add(p->out, w.s, w.n);
  if (peek(p) == '(')
    return fail_here(p, p->at, "`%.*s` is not a function: write * between factors", (int)w.n, w.s);
  return true;
}

static bool parse_primary(Parser *p) {
  char c = peek(p);
  if (is_digit(c) || c == '.') return parse_number(p);
  if (c == '(') {
    p->at++;
    write_text(p, "(");
    if (!parse_sum(p)) return false;
    if (!accept_char(p, ')')) return fail_here(p, p->at, "expected `)`");
    write_text(p, ")");
    return true;
  }
  if (c == 0) return fail_here(p, p->at, "the formula ends where a number or a name was expected");
  if (name_end(p->at, p->end) > p->at) return parse_name(p);
  return fail_here(p, p->at, "expected a number, a name or `(`, found `%.*s`",
                   (int)cag_character_size(p->at), p->at);
}

static bool parse_power(Parser *p) {
  if (!parse_primary(p)) return false;
  skip_blank(p);
  if (p->at[0] == '*' && p->at[1] == '*') return fail_here(p, p->at, "write ^ for a power");
  if (!accept_char(p, '^')) return true;
  write_text(p, "^");
  return parse_signed(p);
}

static bool parse_signed(Parser *p) {
  // Deeper formulas would be no formulas, and the parser is recursive.
  enum { DEPTH_MOST = 200 };
  if (++p->depth > DEPTH_MOST)
    return fail_here(p, p->at, "brackets and signs nest deeper than %d", DEPTH_MOST);
  bool good;
  if (accept_char(p, '-')) {
    write_text(p, "(-");
    good = parse_signed(p);
    write_text(p, ")");
  } else {
    good = accept_char(p, '+') ? parse_signed(p) : parse_power(p);
  }
  p->depth--;
  return good;
}

// Operands of `next` joined by the operators, which are the same in the language.
static bool parse_joined(Parser *p, const char *operators, bool (*next)(Parser *)) {
  if (!next(p)) return false;
  for (;;) {
    char c = peek(p);
    if (c == 0 || !strchr(operators, c)) return true;
    p->at++;
    cag_string_printf(p->out, " %c ", c);
    if (!next(p)) return false;
  }
}

static bool parse_product(Parser *p) { return parse_joined(p, "*/%", parse_signed); }
static bool parse_sum(Parser *p) { return parse_joined(p, "+-", parse_product); }

static bool parse_formula(Parser *p) {
  if (!parse_sum(p)) return false;
  char c = peek(p);
  if (c == 0) return true;
  bool factor = c == '(' || is_digit(c) || name_end(p->at, p->end) > p->at;
  if (factor) return fail_here(p, p->at, "expected an operator: write * between factors");
  if (c == '=') return fail_here(p, p->at, "a formula is one expression, without `=`");
  return fail_here(p, p->at, "expected an operator, found `%.*s`", (int)cag_character_size(p->at),
                   p->at);
}

// --- formula ---

static bool check_parameter(CagCall *call, const CagList *names, size_t i) {
  CagValue v = cag_list_get(call->vm, names, i);
  if (v.type != CAG_TEXT) return cag_fail_element(call, 1, i, v, "names in texts");
  Word w = {CAG_AS_TEXT(v)->bytes, CAG_AS_TEXT(v)->length};
  const char *why = NULL;
  if (w.n == 0 || name_end(w.s, w.s + w.n) != w.s + w.n) why = "is not a name";
  else if (is_reserved(w) || word_is(w, "_")) why = "is a word of the language";
  else if (find_function(w)) why = "is a function of formulas";
  else if (is_constant(w)) why = "is a constant of formulas";
  for (size_t j = 0; j < i && !why; j++)
    if (word_is(w, CAG_AS_TEXT(cag_list_get(call->vm, names, j))->bytes)) why = "occurs twice";
  if (!why) return true;
  return cag_fail_call(
      call, 1, CAG_ERR_value,
      "expects names of parameters in `parameters`, but \"%.60s\" at parameters[%zu] %s", w.s, i,
      why);
}

bool cag_formula_formula(CagCall *call, const struct cag_formula_formula *a, CagValue *result) {
  CagList *names;
  if (!cag_arg_list(call, 1, &names)) return false;
  for (size_t i = 0; i < names->length; i++)
    if (!check_parameter(call, names, i)) return false;
  Parser p = {call, a->text, a->text, a->text + strlen(a->text), names, cag_held_string(call), 0};
  write_text(&p, "(");
  for (size_t i = 0; i < names->length; i++) {
    if (i > 0) write_text(&p, ", ");
    write_text(&p, CAG_AS_TEXT(cag_list_get(call->vm, names, i))->bytes);
  }
  write_text(&p, ") => ");
  if (!parse_formula(&p)) return false;
  cag_string_check(call->vm, p.out);
  return cag_vm_compile_lambda(call->vm, p.out->bytes, result);
}
