// Numbers: elementary functions, rounding, extremes, and what works on angles and vectors as well
// (abs, sign, min, max, clamp, mix, round).

#include <string.h>

#include "interp/builtin/support.h"

#define NUMBER_OR_ANGLE (CAG_TYPE_BIT(NUMBER) | CAG_TYPE_BIT(ANGLE))
#define LISTS (CAG_TYPE_BIT(LIST) | CAG_TYPE_BIT(RANGE))
static const char FAMILY[] = "Numbers";

// --- Functions of one number ---

static bool apply(CagCall *call, double (*f)(double), CagValue *result) {
  double x;
  return cag_arg_number(call, 0, &x) && cag_give_number(call, f(x), result);
}

#define ELEMENTARY(name, f)                                                                        \
  static bool name(CagCall *call, CagValue *result) { return apply(call, f, result); }
ELEMENTARY(call_exp, exp)
ELEMENTARY(call_sinh, sinh)
ELEMENTARY(call_cosh, cosh)
ELEMENTARY(call_tanh, tanh)
ELEMENTARY(call_asinh, asinh)
ELEMENTARY(call_floor, floor)
ELEMENTARY(call_ceil, ceil)
#undef ELEMENTARY

// The library's cbrt may miss by one unit in the last place, also for cubes: a step of Newton's
// method mends that.
static double cube_root(double x) {
  double y = cbrt(x), slope = 3 * y * y;
  return isnormal(slope) && isfinite(slope * y) ? y - (double)((long double)y * y * y - x) / slope
                                                : y;
}
static bool call_cbrt(CagCall *call, CagValue *result) { return apply(call, cube_root, result); }

static bool call_sqrt(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  if (x >= 0) return cag_give_number(call, sqrt(x), result);
  char digits[32];
  return cag_fail_call(call, 0, CAG_ERR_not_finite,
                       "expects a number of 0 or more, found the number %s",
                       cag_number_text(x, digits));
}

static bool logarithm(CagCall *call, double (*f)(double), CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  return x > 0 ? cag_give_number(call, f(x), result)
               : cag_fail_value(call, 0, "a number greater than 0");
}
static bool call_ln(CagCall *call, CagValue *result) { return logarithm(call, log, result); }
static bool call_log10(CagCall *call, CagValue *result) { return logarithm(call, log10, result); }
static bool call_log2(CagCall *call, CagValue *result) { return logarithm(call, log2, result); }

static bool call_acosh(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  return x >= 1 ? cag_give_number(call, acosh(x), result)
                : cag_fail_value(call, 0, "a number of 1 or more");
}

static bool call_atanh(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  return x > -1 && x < 1 ? cag_give_number(call, atanh(x), result)
                         : cag_fail_value(call, 0, "a number between -1 and 1, without these");
}

static bool call_hypot(CagCall *call, CagValue *result) {
  double sum = 0;
  for (size_t i = 0; i < call->count; i++) {
    double x;
    if (!cag_arg_number(call, (int)i, &x)) return false;
    sum = hypot(sum, x);
  }
  return cag_give_number(call, sum, result);
}

// --- Numbers and angles ---

static bool is_number_or_angle(CagValue v) { return v.type == CAG_NUMBER || v.type == CAG_ANGLE; }

static bool call_abs(CagCall *call, CagValue *result) {
  *result = call->values[0];
  result->as.number = fabs(result->as.number);
  return true;
}

static bool call_sign(CagCall *call, CagValue *result) {
  double x = call->values[0].as.number;
  *result = cag_number((x > 0) - (x < 0));
  return true;
}

static CagValue round_value(CagValue v, int digits) {
  v.as.number = cag_round_decimal(v.as.number, digits);
  return v;
}

// Loops over long lists ask after so many elements whether they may go on.
enum { STEPS_BETWEEN_CHECKS = 1 << 12 };

static bool round_list(CagCall *call, CagValue value, int digits, int depth, CagValue *result) {
  if (!cag_may_nest(call, depth)) return false;
  const CagList *list = CAG_AS_LIST(value);
  if (list->dim > 0) {
    double *numbers;
    size_t n = list->length * list->dim;
    *result = list->dim == 1 ? cag_list_numbers(call->vm, n, &numbers)
                             : cag_list_vectors(call->vm, list->length, list->dim, &numbers);
    for (size_t i = 0; i < n; i++) {
      numbers[i] = cag_round_decimal(list->as.numbers[i], digits);
      if (i % STEPS_BETWEEN_CHECKS == STEPS_BETWEEN_CHECKS - 1 && !cag_keep_going(call->vm))
        return false;
    }
    return true;
  }
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = 0; i < list->length; i++) {
    CagValue element = cag_list_get(call->vm, list, i), rounded;
    if (is_number_or_angle(element)) rounded = round_value(element, digits);
    else if (element.type != CAG_LIST)
      return cag_fail_element(call, 0, i, element, "numbers, angles or lists of these");
    else if (!round_list(call, element, digits, depth + 1, &rounded)) return false;
    if (!cag_builder_add(call->vm, built, rounded)) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

static bool call_round(CagCall *call, CagValue *result) {
  // No double has digits beyond these places.
  enum { PLACES_MOST = 400 };
  long digits;
  if (!cag_arg_integer_or(call, 1, 0, -PLACES_MOST, PLACES_MOST, &digits)) return false;
  CagValue v = call->values[0];
  if (!is_number_or_angle(v))
    return cag_as_list(call->vm, v, &v) && round_list(call, v, (int)digits, 0, result);
  *result = round_value(v, (int)digits);
  return true;
}

// The least (sign = -1) or greatest (sign = 1) of the arguments, or of the one list.
static bool extreme(CagCall *call, int sign, CagValue *result) {
  CagSequence s;
  bool of_list =
      call->count == 1 && !is_number_or_angle(call->values[0]) && call->values[0].type != CAG_TEXT;
  if (of_list && !cag_sequence_open(call, 0, false, &s)) return false;
  size_t n = of_list ? s.length : call->count;
  if (n == 0) return cag_fail_value(call, 0, "at least one element");
  for (size_t i = 0; i < n; i++) {
    CagValue v = of_list ? cag_sequence_element(call->vm, &s, i) : call->values[i];
    int order;
    // The first is compared with itself, so that a single value is checked too.
    if (!cag_order(v, i == 0 ? v : *result, &order))
      return cag_fail_order(call, of_list ? 0 : (int)i, i == 0 ? v : *result, v);
    if (i == 0 || order == sign) *result = v;
    if (i % STEPS_BETWEEN_CHECKS == STEPS_BETWEEN_CHECKS - 1 && !cag_keep_going(call->vm))
      return false;
  }
  return true;
}
static bool call_min(CagCall *call, CagValue *result) { return extreme(call, -1, result); }
static bool call_max(CagCall *call, CagValue *result) { return extreme(call, 1, result); }

static bool call_clamp(CagCall *call, CagValue *result) {
  CagValue v = call->values[0];
  double low, high;
  bool angle;
  if (!cag_arg_interval(call, 1, &low, &high, &angle)) return false;
  if (angle != (v.type == CAG_ANGLE))
    return cag_fail_type(call, 1, v.type == CAG_ANGLE ? "a range of angles" : "a range of numbers");
  if (low > high) return cag_fail_value(call, 1, "a range whose start is not above its end");
  v.as.number = v.as.number < low ? low : v.as.number > high ? high : v.as.number;
  *result = v;
  return true;
}

static bool call_mix(CagCall *call, CagValue *result) {
  double t;
  return cag_arg_finite(call, 2, &t) &&
         cag_mix_values(call, call->values[0], call->values[1], t, result);
}

const CagBuiltin cag_builtins_numbers[] = {
    {"abs(x: number or angle)", call_abs, "number or angle", "Returns the absolute value.",
     "print abs(-2), abs(-30deg) // expect: 2 30deg", NUMBER_OR_ANGLE, FAMILY},
    {"sqrt(x: number)", call_sqrt, "number",
     "Returns the square root. A negative number is an error.",
     "print sqrt(2) // expect: 1.4142135623730951", 0, FAMILY},
    {"cbrt(x: number)", call_cbrt, "number",
     "Returns the cube root. The cube root of a negative number is negative.",
     "print cbrt(-27) // expect: -3", 0, FAMILY},
    {"exp(x: number)", call_exp, "number", "Returns e to the power of x.",
     "print exp(0), exp(1) // expect: 1 2.718281828459045", 0, FAMILY},
    {"ln(x: number)", call_ln, "number", "Returns the natural logarithm of a positive number.",
     "print ln(exp(2)) // expect: 2", 0, FAMILY},
    {"log10(x: number)", call_log10, "number",
     "Returns the logarithm to base 10 of a positive number.", "print log10(1000) // expect: 3", 0,
     FAMILY},
    {"log2(x: number)", call_log2, "number",
     "Returns the logarithm to base 2 of a positive number.", "print log2(1024) // expect: 10", 0,
     FAMILY},
    {"sinh(x: number)", call_sinh, "number", "Returns the hyperbolic sine.",
     "print sinh(0) // expect: 0", 0, FAMILY},
    {"cosh(x: number)", call_cosh, "number", "Returns the hyperbolic cosine.",
     "print cosh(0) // expect: 1", 0, FAMILY},
    {"tanh(x: number)", call_tanh, "number", "Returns the hyperbolic tangent.",
     "print tanh(100) // expect: 1", 0, FAMILY},
    {"asinh(x: number)", call_asinh, "number", "Returns the inverse hyperbolic sine.",
     "print asinh(0) // expect: 0", 0, FAMILY},
    {"acosh(x: number)", call_acosh, "number",
     "Returns the inverse hyperbolic cosine of a number of at least 1. The result is not "
     "negative.",
     "print acosh(1) // expect: 0", 0, FAMILY},
    {"atanh(x: number)", call_atanh, "number",
     "Returns the inverse hyperbolic tangent of a number between -1 and 1.",
     "print near(atanh(tanh(0.5)), 0.5) // expect: true", 0, FAMILY},
    {"floor(x: number)", call_floor, "number",
     "Returns the largest integer that is not greater than x.",
     "print floor(2.7), floor(-2.1) // expect: 2 -3", 0, FAMILY},
    {"ceil(x: number)", call_ceil, "number",
     "Returns the smallest integer that is not less than x.",
     "print ceil(2.1), ceil(-2.7) // expect: 3 -2", 0, FAMILY},
    {"round(x: number or angle, digits: integer = 0)", call_round, "number, angle or list",
     "Rounds to a number of decimal places; negative digits round to tens, hundreds, and so on. "
     "Halves are rounded away from 0. Accepts numbers, angles (rounded in degrees), vectors, and "
     "lists of these. Rounds the decimal form that is printed, so round(2.675, 2) is 2.68.",
     "print round(2.5), round(-2.5), round(2.675, 2), round(1234, -2) // expect: 3 -3 2.68 1200\n"
     "print round([0.126, 2], digits: 2) // expect: [0.13, 2]",
     NUMBER_OR_ANGLE | LISTS, FAMILY},
    {"sign(x: number or angle)", call_sign, "number",
     "Returns -1, 0, or 1 if x is negative, zero, or positive.",
     "print sign(-3), sign(0), sign(5deg) // expect: -1 0 1", NUMBER_OR_ANGLE, FAMILY},
    {"hypot(x: number, ...)", call_hypot, "number",
     "Returns the square root of the sum of the squares, without overflow of intermediate "
     "results.",
     "print hypot(3, 4), hypot(2, 3, 6) // expect: 5 7", 0, FAMILY},
    {"min(x: number or angle or text, ...)", call_min, "number, angle or text",
     "Returns the smallest of several values or of the elements of a list. The values must be "
     "all numbers, all angles, or all texts.",
     "print min(3, 1, 2), min([30deg, 20deg]) // expect: 1 20deg", 0, FAMILY},
    {"max(x: number or angle or text, ...)", call_max, "number, angle or text",
     "Returns the largest of several values or of the elements of a list. The values must be all "
     "numbers, all angles, or all texts.",
     "print max(3, 1, 2), max([\"b\", \"a\"]) // expect: 3 b", 0, FAMILY},
    {"clamp(x: number or angle, range: range of numbers or angles)", call_clamp, "number or angle",
     "Returns the number or angle in a closed range that is nearest to x.",
     "print clamp(12, 0..10), clamp(-5deg, 0deg..90deg) // expect: 10 0deg", NUMBER_OR_ANGLE,
     FAMILY},
    {"mix(a: number or angle or vector, b: number or angle or vector, t: number)", call_mix,
     "as a and b",
     "Returns (1 - t) a + t b; exactly a for t = 0, and exactly b for t = 1. t may be outside of "
     "0..1. Accepts numbers, angles, vectors, and lists of these.",
     "print mix(10, 20, 0.25), mix(0deg, 90deg, 0.5), mix(X, Y, 0.5) // expect: 12.5 45deg [0.5, "
     "0.5, 0]",
     NUMBER_OR_ANGLE | LISTS, FAMILY},
    {0}};
