// Signatures of built-ins: the parsed parameters, and the fields of the argument structures.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "interp/vm/signature.h"
#include "interp/vm/value.h"

static CagArena arena;

static CagSignature parsed(const char *text) {
  CagSignature s;
  cag_signature_parse(&s, text, &arena);
  return s;
}

#define ACCEPTS(type, tag) (((type).accepts >> CAG_##tag & 1) != 0)

static void names_and_defaults_are_taken_apart(void **state) {
  (void)state;
  const CagSignature s =
      parsed("cone(height: length > 0, C: curve or list [p, q], text: text = \", \", ...)");
  assert_string_equal(s.name, "cone");
  assert_string_equal(s.text, "cone(height, C, text = \", \", ...)");
  assert_int_equal(s.count, 3);
  assert_int_equal(s.required, 2);
  assert_true(s.variadic);
  assert_string_equal(s.parameters[1], "C");
  assert_string_equal(s.words[1], "curve or list [p, q]");
  assert_true(s.positional_only[1] && !s.positional_only[0]);
  assert_null(s.defaults[0]);
  assert_string_equal(s.defaults[2], "\", \"");
  const CagSignature constant = parsed("pi"), none = parsed("relaxed()");
  assert_string_equal(constant.name, "pi");
  assert_int_equal(constant.count + none.count, 0);
  assert_string_equal(none.text, "relaxed()");
}

static void ranges_have_two_ends_or_one(void **state) {
  (void)state;
  const CagSignature s = parsed("f(a: length > 0, b: number >= -1.5, c: integer in 2..100000000, "
                                "d: finite number, e: integer in 0..1 = 1, g: number in 0.5..1e3)");
  const CagParameterTypes *types = cag_signature_types(&s);
  const struct {
    CagParameterKind kind;
    double low, high;
    bool ranged, above_low;
  } expected[] = {
      {CAG_BIND_FINITE, 0, INFINITY, true, true},
      {CAG_BIND_NUMBER, -1.5, INFINITY, true, false},
      {CAG_BIND_INTEGER, 2, 100000000, true, false},
      {CAG_BIND_FINITE, -INFINITY, INFINITY, false, false},
      {CAG_BIND_INTEGER, 0, 1, true, false},
      {CAG_BIND_NUMBER, 0.5, 1000, true, false},
  };
  for (size_t i = 0; i < s.count; i++) {
    const CagParameterType *t = &types->items[i];
    assert_int_equal(t->kind, expected[i].kind);
    assert_true(t->low == expected[i].low && t->high == expected[i].high);
    assert_true(t->ranged == expected[i].ranged && t->above_low == expected[i].above_low);
    assert_true(ACCEPTS(*t, NUMBER) && ACCEPTS(*t, NONE) && !ACCEPTS(*t, TEXT));
  }
  assert_true(types->items[4].fallback[0] == 1);
  free((void *)types);
}

static void alternatives_join_their_types(void **state) {
  (void)state;
  const CagSignature s = parsed(
      "f(a: \"left\" or \"right\" = \"right\", b: number or angle, c: number or text, "
      "d: something else, e: list of points, g: list of curves, h: function (u, v) => point)");
  const CagParameterTypes *types = cag_signature_types(&s);
  assert_int_equal(s.count, 7);
  assert_int_equal(types->items[0].kind, CAG_BIND_CHOICE);
  assert_string_equal(types->items[0].choices[0], "left");
  assert_string_equal(types->items[0].choices[1], "right");
  assert_null(types->items[0].choices[2]);
  assert_true(types->items[0].fallback[0] == 1);
  for (int i = 1; i < 4; i++) assert_int_equal(types->items[i].kind, CAG_BIND_VALUE);
  assert_true(ACCEPTS(types->items[1], ANGLE) && ACCEPTS(types->items[1], NUMBER));
  assert_false(ACCEPTS(types->items[1], TEXT));
  assert_true(ACCEPTS(types->items[2], TEXT) && !ACCEPTS(types->items[2], ANGLE));
  assert_true(types->items[3].accepts == 0); // any
  assert_int_equal(types->items[4].kind, CAG_BIND_POINTS);
  assert_int_equal(types->items[5].kind, CAG_BIND_VALUE);
  assert_int_equal(types->items[6].kind, CAG_BIND_FUNCTION);
  free((void *)types);
}

static void defaults_are_values(void **state) {
  (void)state;
  const CagSignature s =
      parsed("f(a: number, b: number = a, c: angle = 90deg, d: point = [1, -2], e: direction = Z, "
             "g: range = 0..1, h: range of angles = -180deg..180deg, i: bool = true, "
             "j: number = inf, k: text = none, l: number = 1e-9)");
  const CagParameterTypes *types = cag_signature_types(&s);
  assert_true(types->items[1].same_as_set && types->items[1].same_as == 0);
  assert_true(fabs(types->items[2].fallback[0] - acos(0)) < 1e-15);
  assert_true(types->items[3].fallback[0] == 1 && types->items[3].fallback[1] == -2);
  assert_int_equal(types->items[3].dimension, 2);
  assert_true(types->items[4].fallback[2] == 1 && types->items[4].dimension == 3);
  assert_true(types->items[5].fallback[0] == 0 && types->items[5].fallback[1] == 1);
  assert_int_equal(types->items[5].dimension, 0);
  assert_true(types->items[6].fallback[0] == -180 && types->items[6].fallback[1] == 180);
  assert_int_equal(types->items[6].dimension, 1); // an angle
  assert_true(types->items[7].fallback[0] == 1);
  assert_true(types->items[8].fallback[0] == HUGE_VAL);
  assert_true(types->items[9].fallback[0] == 0);
  assert_true(types->items[10].fallback[0] == 1e-9);
  free((void *)types);
}

static void fields_lie_as_in_a_structure_of_c(void **state) {
  (void)state;
  const CagSignature s =
      parsed("f(a: bool, b: length, c: \"x\" or \"y\", d: point, e: bool, g: integer, h: curve, "
             "i: transform, j: any value, k: list of numbers, l: bool)");
  const CagParameterTypes *types = cag_signature_types(&s);
  typedef struct Fields {
    bool a;
    double b;
    int c;
    CagPoint d;
    bool e;
    long g;
    CagCurve *h;
    CagTransform i;
    CagValue j;
    CagNumbers k;
    bool l;
  } Fields;
  const size_t offsets[] = {offsetof(Fields, a), offsetof(Fields, b), offsetof(Fields, c),
                            offsetof(Fields, d), offsetof(Fields, e), offsetof(Fields, g),
                            offsetof(Fields, h), offsetof(Fields, i), offsetof(Fields, j),
                            offsetof(Fields, k), offsetof(Fields, l)};
  for (size_t i = 0; i < s.count; i++) assert_int_equal(types->items[i].offset, offsets[i]);
  assert_int_equal(types->size, offsetof(Fields, l) + sizeof(bool));
  free((void *)types);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_and_defaults_are_taken_apart),
      cmocka_unit_test(ranges_have_two_ends_or_one),
      cmocka_unit_test(alternatives_join_their_types),
      cmocka_unit_test(defaults_are_values),
      cmocka_unit_test(fields_lie_as_in_a_structure_of_c),
  };
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  cag_arena_free(&arena);
  return failed;
}
