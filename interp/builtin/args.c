// Reading the arguments of built-ins: each reader checks the type and the value, and where that
// fails sets an error that names the parameter, what it may be, and what was found.

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/utf8.h"
#include "interp/builtin/support.h"
#include "interp/vm/jet.h"

const char *cag_parameter_name(const CagCall *call, int argument) {
  const CagSignature *s = cag_builtin_signature_of(call->builtin);
  if (!s || argument < 0 || (size_t)argument >= s->count) return "...";
  return s->parameters[argument];
}

// --- Errors ---

const char *cag_value_words(CagVm *vm, CagValue v, char *buffer, size_t size) {
  CagString s = {0};
  cag_describe_value(vm, &s, v);
  size_t n = s.length;
  if (n < size) { // n is also 0 if memory ran out
    if (n) memcpy(buffer, s.bytes, n);
    buffer[n] = 0;
  } else {
    // Cut before a character, not within one.
    n = cag_utf8_start(s.bytes, size - 4);
    memcpy(buffer, s.bytes, n);
    strcpy(buffer + n, "...");
  }
  cag_string_free(&s);
  return buffer;
}

bool(cag_fail_value)(CagCall *call, int argument, const char *expected) {
  char found[200];
  cag_value_words(call->vm, call->values[argument], found, sizeof found);
  const CagSignature *s = cag_builtin_signature_of(call->builtin);
  if (s && s->count == 1)
    return cag_fail_call(call, argument, CAG_ERR_value, "expects %s, found %s", expected, found);
  return cag_fail_call(call, argument, CAG_ERR_value, "expects %s as `%s`, found %s", expected,
                       cag_parameter_name(call, argument), found);
}

bool(cag_fail_element)(CagCall *call, int argument, size_t index, CagValue element,
                       const char *expected) {
  if (cag_holds_jet(element)) return cag_fail_differentiate(call, argument);
  char found[200];
  cag_value_words(call->vm, element, found, sizeof found);
  const char *name = cag_parameter_name(call, argument);
  return cag_fail_call(call, argument, CAG_ERR_type, "expects %s in `%s`, found %s at %s[%zu]",
                       expected, name, found, name, index);
}

static bool fail_angle_for_number(CagCall *call, int argument) {
  cag_fail_type(call, argument, "a number");
  if (call->values[argument].type == CAG_ANGLE)
    cag_fail_help(call->vm, "write in_degrees(...) or in_radians(...), or divide by 1deg");
  return false;
}

static bool fail_number_for_angle(CagCall *call, int argument) {
  cag_fail_type(call, argument, "an angle");
  if (call->values[argument].type == CAG_NUMBER) {
    char digits[32];
    cag_number_text(call->values[argument].as.number, digits);
    if (strcmp(digits, "inf") != 0 && strcmp(digits, "-inf") != 0)
      cag_fail_help(call->vm, "write %sdeg or %srad", digits, digits);
  }
  return false;
}

// --- Numbers ---

bool cag_given(const CagCall *call, int argument) {
  return call->values[argument].type != CAG_UNSET;
}

bool cag_arg_number(CagCall *call, int argument, double *out) {
  CagValue v = call->values[argument];
  if (v.type != CAG_NUMBER) return fail_angle_for_number(call, argument);
  *out = v.as.number;
  return true;
}

bool cag_arg_number_or(CagCall *call, int argument, double fallback, double *out) {
  if (cag_given(call, argument)) return cag_arg_number(call, argument, out);
  *out = fallback;
  return true;
}

bool cag_arg_finite(CagCall *call, int argument, double *out) {
  if (!cag_arg_number(call, argument, out)) return false;
  return isfinite(*out) || cag_fail_value(call, argument, "a finite number");
}

bool cag_arg_positive(CagCall *call, int argument, double *out) {
  if (!cag_arg_number(call, argument, out)) return false;
  return (isfinite(*out) && *out > 0) ||
         cag_fail_value(call, argument,
                        *out > 0 ? "a finite number greater than 0" : "a number greater than 0");
}

bool cag_arg_integer(CagCall *call, int argument, long low, long high, long *out) {
  double x;
  if (!cag_arg_number(call, argument, &x)) return false;
  if (x != floor(x) || x < (double)low || x > (double)high) {
    char expected[96];
    if (high == LONG_MAX && low == LONG_MIN) snprintf(expected, sizeof expected, "a whole number");
    else if (high == LONG_MAX)
      snprintf(expected, sizeof expected, "a whole number of at least %ld", low);
    else snprintf(expected, sizeof expected, "a whole number in %ld..%ld", low, high);
    return cag_fail_value(call, argument, expected);
  }
  // (double)LONG_MAX rounds up to 2^63, which is no long.
  *out = x >= (double)LONG_MAX ? LONG_MAX : (long)x;
  return true;
}

bool cag_arg_integer_or(CagCall *call, int argument, long fallback, long low, long high,
                        long *out) {
  if (cag_given(call, argument)) return cag_arg_integer(call, argument, low, high, out);
  *out = fallback;
  return true;
}

// --- Angles ---

#define RADIANS_PER_DEGREE 0.017453292519943295 // pi / 180

bool cag_arg_degrees(CagCall *call, int argument, double *degrees) {
  *degrees = 0;
  CagValue v = call->values[argument];
  if (v.type != CAG_ANGLE) return fail_number_for_angle(call, argument);
  if (!isfinite(v.as.number)) return cag_fail_value(call, argument, "a finite angle");
  *degrees = v.as.number;
  return true;
}

bool cag_arg_angle(CagCall *call, int argument, double *radians) {
  double degrees;
  if (!cag_arg_degrees(call, argument, &degrees)) return false;
  *radians = degrees * RADIANS_PER_DEGREE;
  return true;
}

// --- Bools, texts, functions, records ---

bool cag_arg_bool_or(CagCall *call, int argument, bool fallback, bool *out) {
  CagValue v = call->values[argument];
  if (v.type == CAG_UNSET) {
    *out = fallback;
    return true;
  }
  if (v.type != CAG_BOOL) return cag_fail_type(call, argument, "true or false");
  *out = v.as.boolean;
  return true;
}

bool cag_text_is_c(const CagText *t) { return strlen(t->bytes) == t->length; }

bool cag_arg_text(CagCall *call, int argument, const char **out) {
  CagValue v = call->values[argument];
  if (v.type != CAG_TEXT) return cag_fail_type(call, argument, "a text");
  if (!cag_text_is_c(CAG_AS_TEXT(v)))
    return cag_fail_call(call, argument, CAG_ERR_value,
                         "expects a text without the character \\u{0}");
  *out = CAG_AS_TEXT(v)->bytes;
  return true;
}

// `"a", "b" or "c"`
static void list_choices(CagString *s, const char *const *choices) {
  for (size_t i = 0; choices[i]; i++) {
    const char *between = i == 0 ? "" : choices[i + 1] ? ", " : " or ";
    cag_string_printf(s, "%s\"%s\"", between, choices[i]);
  }
  cag_string_add(s, "", 1);
}

bool cag_arg_choice(CagCall *call, int argument, const char *const *choices, int *out) {
  *out = 0;
  if (!cag_given(call, argument)) return true;
  CagValue v = call->values[argument];
  size_t n = 0;
  for (; choices[n]; n++) {
    if (v.type != CAG_TEXT || !cag_text_is_c(CAG_AS_TEXT(v)) ||
        strcmp(choices[n], CAG_AS_TEXT(v)->bytes) != 0)
      continue;
    *out = (int)n;
    return true;
  }
  CagString *expected = cag_held_string(call);
  list_choices(expected, choices);
  if (v.type != CAG_TEXT) return cag_fail_type(call, argument, expected->bytes);
  cag_fail_value(call, argument, expected->bytes);
  const char *nearest = cag_nearest_name(CAG_AS_TEXT(v)->bytes, choices, n);
  return nearest && cag_fail_help(call->vm, "did you mean \"%s\"?", nearest);
}

bool cag_arg_function(CagCall *call, int argument, CagValue *out) {
  *out = call->values[argument];
  // Curves and surfaces can be called as well.
  if (cag_is_function(*out) || out->type == CAG_CURVE || out->type == CAG_SURFACE) return true;
  return cag_fail_type(call, argument, "a function");
}

bool cag_arg_record(CagCall *call, int argument, CagRecord **out) {
  if (call->values[argument].type != CAG_RECORD) return cag_fail_type(call, argument, "a record");
  *out = CAG_AS_RECORD(call->values[argument]);
  return true;
}

// --- Lists, vectors, points ---

bool cag_arg_list(CagCall *call, int argument, CagList **out) {
  CagValue v = call->values[argument], list;
  if (v.type != CAG_LIST && v.type != CAG_RANGE) return cag_fail_type(call, argument, "a list");
  if (!cag_as_list(call->vm, v, &list)) return false;
  *out = CAG_AS_LIST(list);
  return true;
}

// Whether v is a vector of 2 or 3 finite numbers.
static bool read_point(CagValue v, CagVec3 *out, int *dimension) {
  const double *x;
  size_t n;
  if (!cag_as_vector(v, &x, &n) || n < 2 || n > 3) return false;
  *out = cag_vec3(x[0], x[1], n == 3 ? x[2] : 0);
  *dimension = (int)n;
  return isfinite(out->x) && isfinite(out->y) && isfinite(out->z);
}

bool cag_arg_vec(CagCall *call, int argument, CagVec3 *out, int *dimension) {
  CagVec3 p;
  int d;
  if (!read_point(call->values[argument], &p, &d))
    return cag_fail_type(call, argument, "a point or vector of 2 or 3 finite numbers");
  *out = p;
  if (dimension) *dimension = d;
  return true;
}

bool cag_arg_vec_or(CagCall *call, int argument, CagVec3 fallback, CagVec3 *out, int *dimension) {
  if (cag_given(call, argument)) return cag_arg_vec(call, argument, out, dimension);
  *out = fallback;
  if (dimension) *dimension = 3;
  return true;
}

bool cag_arg_points(CagCall *call, int argument, CagVec3 **out, size_t *n, int *dimension) {
  CagValue v = call->values[argument];
  if (v.type != CAG_LIST) return cag_fail_type(call, argument, "a list of points");
  const CagList *list = CAG_AS_LIST(v);
  if (list->length == 0) return cag_fail_value(call, argument, "at least one point");
  CagVec3 *points = cag_hold(call, cag_malloc(list->length * sizeof *points));
  int highest = 2;
  for (size_t i = 0; i < list->length; i++) {
    // Packed vectors are read where they lie, without a value for each.
    int d = (int)list->dim;
    bool good;
    if (d == 2 || d == 3) {
      const double *x = list->as.numbers + i * (size_t)d;
      points[i] = cag_vec3(x[0], x[1], d == 3 ? x[2] : 0);
      good = isfinite(points[i].x) && isfinite(points[i].y) && isfinite(points[i].z);
    } else {
      good = read_point(cag_list_get(call->vm, list, i), &points[i], &d);
    }
    if (!good)
      return cag_fail_element(call, argument, i, cag_list_get(call->vm, list, i),
                              "points of 2 or 3 finite numbers");
    if (d > highest) highest = d;
  }
  *out = cag_give_held(call, points);
  *n = list->length;
  if (dimension) *dimension = highest;
  return true;
}

bool cag_arg_numbers(CagCall *call, int argument, const double **out, size_t *n) {
  CagList *list;
  CagValue v = call->values[argument];
  if (v.type != CAG_LIST && v.type != CAG_RANGE)
    return cag_fail_type(call, argument, "a list of numbers");
  if (!cag_arg_list(call, argument, &list)) return false;
  if (list->dim == 1 || list->length == 0) {
    // A range's list is kept by the argument's place.
    call->values[argument] = cag_object(CAG_LIST, list);
    *out = list->as.numbers;
    *n = list->length;
    return true;
  }
  // Numbers alone are packed: here one element is none.
  size_t i = 0;
  while (cag_list_get(call->vm, list, i).type == CAG_NUMBER) i++;
  return cag_fail_element(call, argument, i, cag_list_get(call->vm, list, i), "numbers");
}

bool cag_arg_interval(CagCall *call, int argument, double *start, double *end, bool *angle) {
  CagValue v = call->values[argument];
  if (v.type != CAG_RANGE) {
    cag_fail_type(call, argument, "a range");
    if (v.type == CAG_LIST && CAG_AS_LIST(v)->dim == 1 && CAG_AS_LIST(v)->length == 2) {
      char low[32], high[32];
      const double *x = CAG_AS_LIST(v)->as.numbers;
      cag_fail_help(call->vm, "write %s..%s", cag_number_text(x[0], low),
                    cag_number_text(x[1], high));
    }
    return false;
  }
  const CagRange *r = CAG_AS_RANGE(v);
  *start = r->start;
  *end = r->end;
  if (angle) *angle = r->angle;
  else if (r->angle) return cag_fail_type(call, argument, "a range of numbers");
  return true;
}

// --- Shapes ---

bool cag_arg_transform(CagCall *call, int argument, CagTransform *out) {
  if (call->values[argument].type != CAG_TRANSFORM)
    return cag_fail_type(call, argument, "a transform");
  *out = CAG_AS_TRANSFORM(call->values[argument])->t;
  return true;
}

bool cag_arg_curve(CagCall *call, int argument, CagCurve **out) {
  if (call->values[argument].type != CAG_CURVE) return cag_fail_type(call, argument, "a curve");
  *out = CAG_AS_SHAPE(call->values[argument])->as.curve;
  return true;
}

bool cag_arg_surface(CagCall *call, int argument, CagSurface **out) {
  if (call->values[argument].type != CAG_SURFACE) return cag_fail_type(call, argument, "a surface");
  *out = CAG_AS_SHAPE(call->values[argument])->as.surface;
  return true;
}
