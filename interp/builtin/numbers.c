// Numbers: elementary functions, rounding, extremes, and what works on angles and vectors as well
// (abs, sign, min, max, clamp, mix, round).

#include <string.h>

#include "interp/builtin/support.h"

// --- Functions of one number ---

static bool apply(CagCall *call, double (*f)(double), CagValue *result) {
  double x;
  return cag_arg_number(call, 0, &x) && cag_give_number(call, f(x), result);
}

#define ELEMENTARY(f)                                                                              \
  bool cag_numbers_##f(CagCall *call, CagValue *result) { return apply(call, f, result); }
ELEMENTARY(exp)
ELEMENTARY(sinh)
ELEMENTARY(cosh)
ELEMENTARY(tanh)
ELEMENTARY(asinh)
ELEMENTARY(floor)
ELEMENTARY(ceil)
#undef ELEMENTARY

// The library's cbrt may miss by one unit in the last place, also for cubes: a step of Newton's
// method mends that.
static double cube_root(double x) {
  double y = cbrt(x), slope = 3 * y * y;
  return isnormal(slope) && isfinite(slope * y) ? y - (double)((long double)y * y * y - x) / slope
                                                : y;
}
bool cag_numbers_cbrt(CagCall *call, CagValue *result) { return apply(call, cube_root, result); }

bool cag_numbers_sqrt(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  if (x >= 0) return cag_give_number(call, sqrt(x), result);
  char digits[32];
  return cag_fail_call(call, 0, CAG_ERR_not_finite,
                       "expects a number of at least 0, found the number %s",
                       cag_number_text(x, digits));
}

static bool logarithm(CagCall *call, double (*f)(double), CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  return x > 0 ? cag_give_number(call, f(x), result)
               : cag_fail_value(call, 0, "a number greater than 0");
}
bool cag_numbers_ln(CagCall *call, CagValue *result) { return logarithm(call, log, result); }
bool cag_numbers_log10(CagCall *call, CagValue *result) { return logarithm(call, log10, result); }
bool cag_numbers_log2(CagCall *call, CagValue *result) { return logarithm(call, log2, result); }

bool cag_numbers_acosh(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  return x >= 1 ? cag_give_number(call, acosh(x), result)
                : cag_fail_value(call, 0, "a number of at least 1");
}

bool cag_numbers_atanh(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  return x > -1 && x < 1 ? cag_give_number(call, atanh(x), result)
                         : cag_fail_value(call, 0, "a number greater than -1 and less than 1");
}

bool cag_numbers_hypot(CagCall *call, CagValue *result) {
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

bool cag_numbers_abs(CagCall *call, CagValue *result) {
  *result = call->values[0];
  result->as.number = fabs(result->as.number);
  return true;
}

bool cag_numbers_sign(CagCall *call, CagValue *result) {
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
      return cag_fail_element(call, 0, i, element, "numbers, angles, or lists of these");
    else if (!round_list(call, element, digits, depth + 1, &rounded)) return false;
    if (!cag_builder_add(call->vm, built, rounded)) return false;
  }
  *result = cag_builder_finish(call->vm, built);
  return true;
}

bool cag_numbers_round(CagCall *call, CagValue *result) {
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
bool cag_numbers_min(CagCall *call, CagValue *result) { return extreme(call, -1, result); }
bool cag_numbers_max(CagCall *call, CagValue *result) { return extreme(call, 1, result); }

bool cag_numbers_clamp(CagCall *call, CagValue *result) {
  CagValue v = call->values[0];
  double low, high;
  bool angle;
  if (!cag_arg_interval(call, 1, &low, &high, &angle)) return false;
  if (angle != (v.type == CAG_ANGLE))
    return cag_fail_type(call, 1, v.type == CAG_ANGLE ? "a range of angles" : "a range of numbers");
  if (low > high) return cag_fail_value(call, 1, "a range whose start is not greater than its end");
  v.as.number = v.as.number < low ? low : v.as.number > high ? high : v.as.number;
  *result = v;
  return true;
}

bool cag_numbers_mix(CagCall *call, CagValue *result) {
  double t;
  return cag_arg_finite(call, 2, &t) &&
         cag_mix_values(call, call->values[0], call->values[1], t, result);
}
