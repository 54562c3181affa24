// Every operator with values of every pair of types.
//
// The checker (interp/check) knows without running which types an operator accepts and what it
// returns. The machine must agree. Formulas test the same for numbers with derivatives: the
// derivative must be the slope between two points of the curve.

#include <ctype.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "cag.h"
#include "interp/check/types.h"

typedef struct Sample {
  CagType type;
  const char *text;
} Sample;

static const Sample samples[] = {
    {CAG_NONE, "none"},
    {CAG_BOOL, "true"},
    {CAG_NUMBER, "0"},
    {CAG_NUMBER, "2.5"},
    {CAG_NUMBER, "-3"},
    {CAG_NUMBER, "1e308"},
    {CAG_NUMBER, "inf"},
    {CAG_ANGLE, "30deg"},
    {CAG_ANGLE, "0deg"},
    {CAG_TEXT, "\"abc\""},
    {CAG_TEXT, "\"ab\""},
    {CAG_LIST, "[]"},
    {CAG_LIST, "[1, 2]"},
    {CAG_LIST, "[1, -2, 1e308]"},
    {CAG_LIST, "[30deg, 10deg, 20deg]"},
    {CAG_LIST, "[1deg, 2deg, 3deg, 4deg, 5deg, 6deg]"},
    {CAG_LIST, "[[1, 2], [3, 4]]"},
    {CAG_LIST, "[\"a\", none, 1, 2, 3, 4]"},
    {CAG_RANGE, "0..5"},
    {CAG_RANGE, "5..0 by -1"},
    {CAG_RANGE, "0..<4 by 2"},
    {CAG_RANGE, "0..inf"},
    {CAG_RANGE, "0deg..90deg"},
    {CAG_RECORD, "{a: 1, b: \"x\"}"},
    {CAG_CLOSURE, "(x => x)"},
    {CAG_BUILTIN, "sin"},
    {CAG_TRANSFORM, "rotate(30deg)"},
    {CAG_CURVE, "circle(2)"},
    {CAG_REGION, "rectangle(2, 1)"},
    {CAG_SURFACE, "bilinear([0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1])"},
    {CAG_SOLID, "box(2)"},
    {CAG_MESH, "convex_hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])"},
    {CAG_GROUP, "group(box(1), sphere(1))"},
    {CAG_PLANE, "plane(origin, Z)"},
    {CAG_LINK, "revolute(a: 1)"},
    {CAG_ROBOT, "robot([revolute(a: 1)])"},
    {CAG_CAMERA, "camera([1, 2, 3])"},
};
#define SAMPLE_COUNT (sizeof samples / sizeof *samples)

typedef struct Operator {
  CagBinaryOp op;
  const char *text;
} Operator;

static const Operator operators[] = {
    {CAG_OP_ADD, "+"},        {CAG_OP_SUBTRACT, "-"},       {CAG_OP_MULTIPLY, "*"},
    {CAG_OP_DIVIDE, "/"},     {CAG_OP_MODULO, "%"},         {CAG_OP_POWER, "^"},
    {CAG_OP_UNION, "|"},      {CAG_OP_INTERSECTION, "&"},   {CAG_OP_EQUAL, "=="},
    {CAG_OP_NOT_EQUAL, "!="}, {CAG_OP_LESS, "<"},           {CAG_OP_LESS_EQUAL, "<="},
    {CAG_OP_GREATER, ">"},    {CAG_OP_GREATER_EQUAL, ">="}, {CAG_OP_IN, "in"},
};
#define OPERATOR_COUNT (sizeof operators / sizeof *operators)

typedef struct Answer {
  char type[32], text[256];
} Answer;

static void store_answer(void *context, const char *text, const char *type) {
  Answer *a = context;
  snprintf(a->text, sizeof a->text, "%s", text);
  snprintf(a->type, sizeof a->type, "%s", type);
}

static bool names_type(CagTypes types, const char *name) {
  static const char *const names[] = {
#define X(tag, text, article) text,
      CAG_VALUE_TYPES(X)
#undef X
  };
  for (size_t i = 0; i < CAG_TYPE_COUNT; i++)
    if (types >> i & 1 && strcmp(names[i], name) == 0) return true;
  return false;
}

// Whether the text contains the word nan, not as part of a longer word.
static bool undefined(const char *text) {
  for (const char *s = strstr(text, "nan"); s; s = strstr(s + 1, "nan"))
    if ((s == text || !isalpha((unsigned char)s[-1])) && !isalpha((unsigned char)s[3])) return true;
  return false;
}

static CagSession *quiet_session(void) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.max_time = 2;
  options.max_memory = (size_t)256 << 20;
  return cag_session_new(&options);
}

// Evaluates an expression. Returns a description of the error in the outcome, or NULL.
static const char *evaluate(CagSession *s, const char *text, int *status, Answer *out) {
  CagErrorView e;
  *out = (Answer){"", ""};
  *status = cag_session_input(s, text, strlen(text), store_answer, out);
  if (*status == CAG_STATUS_OK) return undefined(out->text) ? "an undefined number" : NULL;
  if (cag_session_error_count(s) == 0) return "the script fails without an error";
  cag_session_error(s, 0, &e);
  if (!e.code || !e.message || !*e.message || strcmp(e.code, "E0000") == 0)
    return "an error without code or words";
  return NULL;
}

static size_t complain(const char *wrong, const char *text, const Answer *a) {
  if (wrong) print_error("%s: %s (%s %s)\n", text, wrong, a->type, a->text);
  return wrong != NULL;
}

static void operators_join_the_types_that_the_checker_says(void **state) {
  (void)state;
  CagSession *s = quiet_session();
  size_t bad = 0;
  for (size_t i = 0; i < SAMPLE_COUNT * SAMPLE_COUNT * OPERATOR_COUNT; i++) {
    const Operator *o = &operators[i % OPERATOR_COUNT];
    const Sample *a = &samples[i / OPERATOR_COUNT % SAMPLE_COUNT];
    const Sample *b = &samples[i / OPERATOR_COUNT / SAMPLE_COUNT];
    char text[256];
    Answer answer;
    int status;
    snprintf(text, sizeof text, "(%s) %s (%s)", a->text, o->text, b->text);
    const char *wrong = evaluate(s, text, &status, &answer);
    CagTypes types = cag_types_joined(o->op, (CagTypes)1 << a->type, (CagTypes)1 << b->type);
    if (!wrong && status == CAG_STATUS_OK && !names_type(types, answer.type))
      wrong = "a type that the checker rules out";
    bad += complain(wrong, text, &answer);
  }
  cag_session_free(s);
  assert_int_equal(bad, 0);
}

// Constructs with one operand: values of all types except these are errors.
static void other_forms_take_the_types_that_they_say(void **state) {
  (void)state;
  static const CagTypes numbers = CAG_TYPES(NUMBER) | CAG_TYPES(ANGLE);
  static const CagTypes lists = CAG_TYPES(LIST) | CAG_TYPES(RANGE);
  const struct {
    const char *form;
    CagTypes taken;
  } forms[] = {
      {"-(%s)", numbers | lists},
      {"not (%s)", CAG_TYPES(BOOL)},
      {"if %s then 1 else 2", CAG_TYPES(BOOL)},
      {"(%s) and true", CAG_TYPES(BOOL)},
      {"true and (%s)", CAG_TYPES(BOOL)},
      {"false or (%s)", CAG_TYPES(BOOL)},
      {"[...(%s)]", lists},
      {"{...(%s)}", CAG_TYPES(RECORD)},
      {"[for [p, q, r] in [%s]: p]", lists},
      {"len([for x in (%s): x]) >= 0", CAG_TYPES_LOOPED},
      {"(%s)[0]", lists | CAG_TYPES(TEXT)},
      {"(%s)[\"a\"]", CAG_TYPES(RECORD)},
      {"[1, 2, 3][%s]", CAG_TYPES(NUMBER) | CAG_TYPES(RANGE)},
      {"\"abc\"[%s]", CAG_TYPES(NUMBER) | CAG_TYPES(RANGE)},
      {"(4..6)[%s]", CAG_TYPES(NUMBER) | CAG_TYPES(RANGE)},
      {"{a: 1}[%s]", CAG_TYPES(TEXT)},
      {"(%s)..10", CAG_TYPES(NUMBER)},
      {"0deg..(%s)", CAG_TYPES(ANGLE)},
      {"0..10 by (%s)", CAG_TYPES(NUMBER)},
      {"(%s)(1)", CAG_TYPES_FUNCTION},
      {"(%s).x", CAG_TYPES_ANY & ~(numbers | CAG_TYPES(NONE) | CAG_TYPES(BOOL) | CAG_TYPES(TEXT) |
                                   CAG_TYPES(RANGE) | CAG_TYPES_FUNCTION)},
      {"(%s).start", CAG_TYPES_ANY & ~(numbers | CAG_TYPES(NONE) | CAG_TYPES(BOOL) |
                                       CAG_TYPES(TEXT) | CAG_TYPES(LIST) | CAG_TYPES_FUNCTION)},
  };
  CagSession *s = quiet_session();
  size_t bad = 0;
  for (size_t f = 0; f < sizeof forms / sizeof *forms; f++)
    for (size_t i = 0; i < SAMPLE_COUNT; i++) {
      char text[256];
      Answer answer;
      int status;
      snprintf(text, sizeof text, forms[f].form, samples[i].text);
      const char *wrong = evaluate(s, text, &status, &answer);
      if (!wrong && status == CAG_STATUS_OK && !(forms[f].taken >> samples[i].type & 1))
        wrong = "a type that the form does not take";
      bad += complain(wrong, text, &answer);
    }
  cag_session_free(s);
  assert_int_equal(bad, 0);
}

static bool number_of(CagSession *s, const char *text, double *out) {
  Answer answer;
  int status;
  if (evaluate(s, text, &status, &answer) || status != CAG_STATUS_OK) return false;
  *out = strtod(answer.text, NULL);
  return true;
}

// Functions of t near PLACE, where all of them are smooth.
#define PLACE 0.4
static const char *const formulas[] = {
    "t + 3",
    "3 - t",
    "t * t",
    "t / (t + 1)",
    "t ^ 3",
    "2 ^ t",
    "t ^ t",
    "t % 0.3",
    "5 % (t + 1)",
    "-t",
    "sin(t * 1rad)",
    "(t * 30deg) / 1deg",
    "(t * 1rad + 10deg) / 1rad",
    "(t * 1rad - 10deg) / 1rad",
    "(t * 1rad % 10deg) / 1rad",
    "1rad / (t * 1rad + 1rad)",
    "if t < 0.5 then t ^ 2 else 7",
    "if t * 1rad > 0.1rad then 3 * t else 7",
    "if 0.1 <= t then t ^ 2 else 7",
    "if t in 0..1 then t ^ 3 else 7",
    "([t, 2, t ^ 2] + [1, 2, 3]).z",
    "([t, t, t, t, t ^ 2, 1] + [1, 2, 3, 4, 5, 6])[4]",
    "([t, t, t, t, t ^ 2, 1] * t)[4]",
    "([1, 2, 3] * t).y",
    "(t * [1, 2, 3]).z",
    "([t, 2 * t] / t ^ 2).y",
    "([1, 2, 3, 4, 5] / t)[4]",
    "(-[t, t ^ 2]).y",
    "(-[t, t ^ 2, t, t, t ^ 3])[4]",
    "([1, t] - [t, t ^ 2]).y",
    "(rotate(30deg) * [t, t ^ 2]).x",
    "(translate([1, 2, 3]) * [t, t ^ 2, 1]).y",
    "(translate([1, 2]) * [[t, t ^ 2], [1, t]])[1].y",
    "dot([t, 1], [t ^ 2, t])",
    "dot([t, 1], [t ^ 2, t, 1])",
    "cross([t, 1, 2], [3, t, t ^ 2]).y",
    "cross([t, 1], [3, t]).z",
    "norm([t, 1, 2])",
    "unit([t, 1, 2]).x",
    "distance([t, 1], [0, t ^ 2])",
    "abs(-t)",
    "abs(t * 1rad) / 1rad",
    "sqrt(t)",
    "cbrt(t)",
    "cbrt(-t)",
    "exp(t)",
    "ln(t)",
    "log10(t)",
    "log2(t)",
    "sinh(t)",
    "cosh(t)",
    "tanh(t)",
    "asinh(t)",
    "acosh(t + 2)",
    "atanh(t)",
    "cos(t * 1rad)",
    "tan(t * 1rad)",
    "asin(t) / 1rad",
    "acos(t) / 1rad",
    "atan(t) / 1rad",
    "atan2(t, 2) / 1rad",
    "atan2(3, t) / 1rad",
    "atan2(t, t ^ 2) / 1rad",
    "hypot(t, 2)",
    "hypot(t, t ^ 2, 3)",

    "min(t, 3)",
    "max(t, t ^ 2)",
    "min([t, 0.3, t ^ 2])",
    "max([t, 0.3])",
    "clamp(t, 0..1)",
    "clamp(t, 0.5..1) + t",
    "clamp(t, 0..0.1) + t",
    "mix(1, 4, t)",
    "mix([1, t], [t, 3], 0.25).y",
    "along([0, 1, 4], t)",
    "along([0, 1, t], 0.9)",
    "along([t, 1, 4], 0.1)",
    "sum([t, t ^ 2, 1])",
    "sum([[t, 1], [2, t ^ 2]]).y",
    "product([t, t, 3])",
    "in_degrees(t * 1rad)",
    "in_radians(t * 1deg)",
    "polar(t, t * 1rad).x",
    "polar(2, t * 1rad, [t, 1]).x",
    "at(circle(2), t * 1rad).x",
    "at(bezier([[0, 0], [1, 2], [3, 1]]), t).y",
    "at(curve(s => [s, s ^ 3], 0..1), t).y",
    "derivative(bezier([[0, 0], [1, 2], [3, 1]]), t).y",
    "tangent(bezier([[0, 0], [1, 2], [3, 1]]), t).x",
    "normal(bezier([[0, 0], [1, 2], [3, 1]]), t).x",
    "curvature(bezier([[0, 0], [1, 2], [3, 1]]), t)",
    "torsion(bezier([[0, 0, 0], [1, 2, 1], [3, 1, 4], [5, 5, 5]]), t)",
    "binormal(bezier([[0, 0, 0], [1, 2, 1], [3, 1, 4], [5, 5, 5]]), t).z",
    "at(bilinear([0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 1]), t, t ^ 2).z",
    "at(sphere_surface(2), t * 1rad, t * 0.5rad).x",
};

// Compares the exact derivative with the slope between two points near PLACE. The error of the
// slope is that of the third derivative, a small multiple of STEP^2, plus rounding divided by STEP.
#define STEP 1e-5
#define SLACK 1e-6

static void formulas_have_the_slope_of_their_curve(void **state) {
  (void)state;
  CagSession *s = quiet_session();
  size_t bad = 0;
  for (size_t i = 0; i < sizeof formulas / sizeof *formulas; i++) {
    char text[512];
    double low = NAN, high = NAN, exact = NAN;
    for (int k = 0; k < 2; k++) {
      snprintf(text, sizeof text, "{ f(t) = %s; f(%.17g) }", formulas[i],
               PLACE + (k ? STEP : -STEP));
      if (!number_of(s, text, k ? &high : &low))
        cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    }
    snprintf(text, sizeof text, "derivative(curve(t => [t, %s], 0.3..0.5), %g).y", formulas[i],
             PLACE);
    if (!number_of(s, text, &exact)) cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    const double slope = (high - low) / (2 * STEP);
    if (fabs(slope - exact) <= SLACK * fmax(1, fabs(slope))) continue;
    print_error("%s: the derivative is %.12g, the slope %.12g\n", formulas[i], exact, slope);
    bad++;
  }
  cag_session_free(s);
  assert_int_equal(bad, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operators_join_the_types_that_the_checker_says),
      cmocka_unit_test(other_forms_take_the_types_that_they_say),
      cmocka_unit_test(formulas_have_the_slope_of_their_curve),
  };
  return cmocka_run_group_tests_name("operators", tests, NULL, NULL);
}
