// Values inside the machine (representations of lists, texts, ranges, records, and numbers as text)
// compared with models in plain C.

#include "tests/interp/vm_support.h"

// ---- lists ----

// The kinds of random elements.
enum { NUMBERS, ANGLES, VECTORS, TEXTS, KINDS };

static CagValue random_element(CagVm *vm, uint32_t kind, size_t dim) {
  switch (kind) {
  case NUMBERS: return cag_number(chance(100));
  case ANGLES: return cag_angle(chance(100));
  case VECTORS: return random_vector(vm, dim);
  default: return cag_text_c(vm, chance(2) ? "a" : "bc");
  }
}

// The representation stated in value.h: numbers, vectors of one length from 2 to 16, or values.
static uint32_t promised_dim(const CagValue *values, size_t n) {
  if (n == 0) return 0;
  size_t numbers = 0, length = 0, vectors = 0;
  for (size_t i = 0; i < n; i++) {
    if (values[i].type == CAG_NUMBER) numbers++;
    if (values[i].type != CAG_LIST || CAG_AS_LIST(values[i])->dim != 1) continue;
    if (vectors++ == 0) length = CAG_AS_LIST(values[i])->length;
    else if (CAG_AS_LIST(values[i])->length != length) length = 0;
  }
  if (numbers == n) return 1;
  return vectors == n && length >= 2 && length <= 16 ? (uint32_t)length : 0;
}

static void expect_list(CagVm *vm, CagValue list, const CagValue *values, size_t n) {
  const CagList *l = CAG_AS_LIST(list);
  assert_int_equal(list.type, CAG_LIST);
  assert_int_equal(l->length, n);
  assert_int_equal(l->dim, promised_dim(values, n));
  for (size_t i = 0; i < n; i++) {
    const CagValue v = cag_list_get(vm, l, i);
    assert_true(cag_equal(vm, v, values[i]));
    assert_int_equal(v.type, values[i].type);
  }
}

static void lists_keep_their_elements_in_the_promised_form(void **state) {
  CagVm *vm = *state;
  static CagValue values[1200];
  for (int round = 0; round < 400; round++) {
    const size_t n = round < 300 ? chance(20) : chance(1200), dim = 1 + chance(18);
    const uint32_t kind = chance(KINDS), other = chance(KINDS);
    const size_t odd = chance(3) ? n : chance((uint32_t)n + 1), odd_dim = 1 + chance(18);
    for (size_t i = 0; i < n; i++) values[i] = random_element(vm, kind, dim);
    if (odd < n) values[odd] = random_element(vm, other, odd_dim);
    const CagValue made = cag_list_values(vm, values, n), grown = built(vm, values, n);
    expect_list(vm, made, values, n);
    expect_list(vm, grown, values, n);
    assert_true(cag_equal(vm, made, grown));
    // Lists of more than 4 KiB have separate memory.
    const size_t bytes = n * (CAG_AS_LIST(made)->dim ? 8 * CAG_AS_LIST(made)->dim : 16);
    assert_int_equal(CAG_AS_LIST(made)->allocated, bytes > 4096);
    assert_int_equal(CAG_AS_LIST(grown)->allocated, bytes > 4096);
    // Slices, and slices of slices.
    const size_t from = chance((uint32_t)n + 1), count = chance((uint32_t)(n - from) + 1);
    const CagValue part = cag_list_slice(vm, made, from, count);
    expect_list(vm, part, values + from, count);
    const size_t inner = chance((uint32_t)count + 1);
    expect_list(vm, cag_list_slice(vm, part, inner, count - inner), values + from + inner,
                count - inner);
    // A different or additional element makes another list.
    if (n == 0) continue;
    const size_t changed = chance((uint32_t)n);
    const CagValue old = values[changed];
    values[changed] = old.type == CAG_NUMBER ? cag_number(old.as.number + 1) : cag_number(-1);
    assert_false(cag_equal(vm, made, cag_list_values(vm, values, n)));
    values[changed] = old;
    assert_false(cag_equal(vm, made, cag_list_values(vm, values, n - 1)));
    assert_false(cag_equal(vm, cag_list_values(vm, values, n - 1), made));
  }
}

// ---- indices ----

// The index of each element that `low..high` selects from n elements, or -1 if one is out of range.
static long model_of_part(double low, double high, bool open, long n, long *out) {
  const long first = low < 0 ? (long)low + n : (long)low;
  long last = isinf(high) ? n - 1 : high < 0 ? (long)high + n : (long)high;
  if (open && !isinf(high)) last--;
  if (first < 0 || first > n || last + 1 > n || last + 1 < 0) return -1;
  long count = 0;
  for (long i = first; i <= last; i++) out[count++] = i;
  return count;
}

static long model_of_steps(const CagRange *r, long n, long *out) {
  long count = 0;
  for (double x = r->start; r->step > 0 ? x <= r->end : x >= r->end; x += r->step) {
    if (r->open && x == r->end) break;
    const long i = x < 0 ? (long)x + n : (long)x;
    if (i < 0 || i >= n) return -1;
    out[count++] = i;
  }
  return count;
}

// Characters of one to four bytes.
static const char *const characters[] = {"a", "\xc3\xa9", "\xe6\xbc\xa2", "\xf0\x9f\x98\x80", "z"};

static void ranges_select_the_elements_of_lists_and_texts(void **state) {
  CagVm *vm = *state;
  size_t wrong = 0, right = 0;
  for (int round = 0; round < 4000; round++) {
    const long n = (long)chance(9);
    const double start = (double)chance(24) - 12;
    const double end = chance(8) ? (double)chance(24) - 12 : HUGE_VAL;
    const bool open = chance(2), stepped = chance(2) && !isinf(end);
    double step = stepped ? (double)chance(7) - 3 : 1;
    if (step == 0) step = 1;
    const CagValue range = cag_range_new(vm, start, end, step, false, open, stepped);
    const uint32_t kind = chance(KINDS);
    CagValue values[10];
    char text[64] = "", bytes[64] = "";
    const bool ascii = chance(2);
    const char *parts[10];
    for (long i = 0; i < n; i++) {
      values[i] = random_element(vm, kind, 3);
      parts[i] = ascii ? (i % 2 ? "a" : "b") : characters[chance(5)];
      strcat(text, parts[i]);
    }
    long indices[64];
    const long count = stepped && step != 1 ? model_of_steps(CAG_AS_RANGE(range), n, indices)
                                            : model_of_part(start, end, open, n, indices);
    CagValue expected[64];
    for (long i = 0; i < count; i++) {
      expected[i] = values[indices[i]];
      strcat(bytes, parts[indices[i]]);
    }
    CagValue got;
    const CagValue list = cag_list_values(vm, values, (size_t)n);
    assert_int_equal(cag_index(vm, list, range, &got), count >= 0);
    if (count >= 0) expect_list(vm, got, expected, (size_t)count);
    else forget_error(vm);
    assert_int_equal(cag_index(vm, cag_text_c(vm, text), range, &got), count >= 0);
    if (count < 0) {
      assert_non_null(strstr(error_text(vm), "lies outside of a text of"));
      forget_error(vm);
      wrong++;
      continue;
    }
    right++;
    assert_string_equal(CAG_AS_TEXT(got)->bytes, bytes);
    assert_int_equal(CAG_AS_TEXT(got)->characters, count);
  }
  assert_true(wrong > 500 && right > 500);
}

static void single_indices_count_from_both_ends(void **state) {
  CagVm *vm = *state;
  const CagValue list = cag_vector(vm, (double[]){10, 11, 12, 13}, 4);
  const CagValue range = cag_range_new(vm, 10, 13, 1, false, false, false);
  const CagValue text = cag_text_c(vm, "a\xc3\xa9z\xe6\xbc\xa2");
  static const char *const letters[] = {"a", "\xc3\xa9", "z", "\xe6\xbc\xa2"};
  for (int twice = -14; twice <= 14; twice++) {
    const double at = twice / 2.0;
    const long k = at < 0 ? (long)at + 4 : (long)at;
    const bool good = twice % 2 == 0 && k >= 0 && k < 4;
    CagValue got;
    assert_int_equal(cag_index(vm, list, cag_number(at), &got), good);
    if (good) assert_true(got.as.number == 10 + (double)k);
    assert_int_equal(cag_index(vm, range, cag_number(at), &got), good);
    if (good) assert_true(got.as.number == 10 + (double)k);
    assert_int_equal(cag_index(vm, text, cag_number(at), &got), good);
    if (good) assert_string_equal(CAG_AS_TEXT(got)->bytes, letters[k]);
    forget_error(vm);
  }
  // An infinite range has all elements from its start on.
  const CagValue endless = cag_range_new(vm, 5, HUGE_VAL, 0.5, false, false, true);
  CagValue got;
  for (int k = 0; k < 9; k++) {
    assert_true(cag_index(vm, endless, cag_number(k), &got));
    assert_true(got.as.number == 5 + 0.5 * k);
  }
  assert_false(cag_index(vm, endless, cag_number(0.5), &got));
  assert_false(cag_index(vm, endless, cag_number(-1), &got));
  forget_error(vm);
}

// ---- arithmetic ----

static double model(CagBinaryOp op, double a, double b) {
  switch (op) {
  case CAG_OP_ADD: return a + b;
  case CAG_OP_SUBTRACT: return a - b;
  case CAG_OP_MULTIPLY: return a * b;
  default: return a / b;
  }
}

// a - b floor(a / b) has the sign of b, and is exact for small integers.
static void remainders_have_the_sign_of_the_divisor(void **state) {
  CagVm *vm = *state;
  for (int a = -20; a <= 20; a++)
    for (int b = -7; b <= 7; b++) {
      CagValue r;
      const bool ok = cag_arithmetic(vm, CAG_OP_MODULO, cag_number(a), cag_number(b), &r);
      assert_int_equal(ok, b != 0);
      if (b == 0) {
        char expected[64];
        snprintf(expected, sizeof expected, "%d %% 0 is undefined", a);
        assert_string_equal(error_text(vm), expected);
        forget_error(vm);
        continue;
      }
      assert_true(r.as.number == a - b * floor((double)a / b));
    }
}

static void lists_are_computed_element_by_element(void **state) {
  CagVm *vm = *state;
  for (int round = 0; round < 2000; round++) {
    const CagBinaryOp op = (CagBinaryOp)(CAG_OP_ADD + chance(4));
    const bool scaled = op == CAG_OP_MULTIPLY || op == CAG_OP_DIVIDE;
    const bool angles = chance(3) == 0, swapped = op == CAG_OP_MULTIPLY && chance(2);
    const size_t n = chance(9), dim = chance(2) ? 1 : 2 + chance(4), huge = chance(20);
    double a[64], b[64];
    CagValue x[10], y[10];
    for (size_t i = 0; i < n * dim; i++) {
      a[i] = (double)chance(1000) - 500;
      b[i] = (double)chance(1000) - 500;
    }
    if (!scaled && huge < n * dim) {
      a[huge] = DBL_MAX;
      b[huge] = op == CAG_OP_ADD ? DBL_MAX : -DBL_MAX;
    }
    if (scaled && huge < n * dim) a[huge] = DBL_MAX;
    const double k = op == CAG_OP_DIVIDE ? (chance(2) ? 0.25 : 8) : (double)chance(9) - 4;
    bool fits = true;
    for (size_t i = 0; i < n * dim; i++)
      fits = fits && fabs(model(op, a[i], scaled ? k : b[i])) <= DBL_MAX;
    for (size_t i = 0; i < n; i++) {
      x[i] = dim > 1  ? cag_vector(vm, a + i * dim, dim)
             : angles ? cag_angle(a[i])
                      : cag_number(a[i]);
      y[i] = dim > 1  ? cag_vector(vm, b + i * dim, dim)
             : angles ? cag_angle(b[i])
                      : cag_number(b[i]);
    }
    CagValue left = cag_list_values(vm, x, n), got;
    CagValue right = scaled ? cag_number(k) : cag_list_values(vm, y, n);
    const bool ok = cag_arithmetic(vm, op, swapped ? right : left, swapped ? left : right, &got);
    assert_int_equal(ok, fits);
    if (!ok) {
      assert_non_null(strstr(error_text(vm), "too large for a number"));
      forget_error(vm);
      continue;
    }
    assert_int_equal(CAG_AS_LIST(got)->length, n);
    for (size_t i = 0; i < n; i++) {
      const CagValue e = cag_list_get(vm, CAG_AS_LIST(got), i);
      for (size_t j = 0; j < dim; j++) {
        const double expected = model(op, a[i * dim + j], scaled ? k : b[i * dim + j]);
        assert_int_equal(e.type, dim > 1 ? CAG_LIST : angles ? CAG_ANGLE : CAG_NUMBER);
        assert_true((dim > 1 ? CAG_AS_LIST(e)->as.numbers[j] : e.as.number) == expected);
      }
    }
    assert_true(cag_negate(vm, left, &got));
    for (size_t i = 0; i < n * dim && dim > 1; i++)
      assert_true(CAG_AS_LIST(got)->as.numbers[i] == -a[i]);
  }
}

// An infinite operand may have an infinite result. A finite sum that is too large, a division by 0,
// and an undefined result are errors.
static void infinite_results_need_infinite_operands(void **state) {
  CagVm *vm = *state;
  static const double samples[] = {0, 1, -2, DBL_MAX, HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < 6 * 6 * 4; i++) {
    const double a = samples[i % 6], b = samples[i / 6 % 6];
    const CagBinaryOp op = (CagBinaryOp)(CAG_OP_ADD + i / 36);
    const double expected = model(op, a, b);
    const bool good =
        !isnan(expected) &&
        (isfinite(expected) || ((isinf(a) || isinf(b)) && !(op == CAG_OP_DIVIDE && !b)));
    CagValue got, x = cag_number(a), y = cag_number(b);
    assert_int_equal(cag_arithmetic(vm, op, x, y, &got), good);
    if (good) assert_true(got.as.number == expected);
    else
      assert_non_null(strstr(error_text(vm), op == CAG_OP_DIVIDE && b == 0 ? "by 0"
                                             : isnan(expected)             ? "is undefined"
                                                                           : "is too large"));
    forget_error(vm);
    // The same in a packed list, after a finite element.
    const CagValue list = cag_vector(vm, (double[]){1, a}, 2);
    const bool scaled = op >= CAG_OP_MULTIPLY;
    const CagValue other = scaled ? y : cag_vector(vm, (double[]){1, b}, 2);
    const bool first = !scaled || cag_arithmetic(vm, op, cag_number(1), y, &got);
    forget_error(vm);
    assert_int_equal(cag_arithmetic(vm, op, list, other, &got), good && first);
    forget_error(vm);
  }
}

// ---- comparison ----

static void texts_compare_as_their_code_points(void **state) {
  CagVm *vm = *state;
  static const char *const sorted[] = {"",  "A", "a",        "aa",          "ab",
                                       "b", "z", "\xc3\xa9", "\xe6\xbc\xa2"};
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 9; j++) {
      const CagValue a = cag_text_c(vm, sorted[i]), b = cag_text_c(vm, sorted[j]);
      const CagValue x = cag_angle(i), y = cag_angle(j);
      static const CagBinaryOp ops[] = {CAG_OP_LESS, CAG_OP_LESS_EQUAL, CAG_OP_GREATER,
                                        CAG_OP_GREATER_EQUAL};
      const bool expected[] = {i<j, i <= j, i> j, i >= j};
      for (int k = 0; k < 4; k++) {
        bool got;
        assert_true(cag_compare(vm, ops[k], a, b, &got));
        assert_int_equal(got, expected[k]);
        assert_true(cag_compare(vm, ops[k], x, y, &got));
        assert_int_equal(got, expected[k]);
      }
      assert_int_equal(cag_equal(vm, a, b), i == j);
    }
}

static void ranges_hold_what_lies_between_their_ends(void **state) {
  CagVm *vm = *state;
  for (int start = -3; start <= 3; start++)
    for (int end = -3; end <= 3; end++)
      for (int form = 0; form < 6; form++) {
        const double step = (double[]){1, 1, 2, 2, -1, -1}[form];
        const bool open = form % 2;
        const CagValue r = cag_range_new(vm, start, end, step, false, open, form > 1);
        for (int twice = -8; twice <= 8; twice++) {
          const double x = twice / 2.0;
          const bool up = x >= start && x <= end, down = x <= start && x >= end;
          const bool expected = (step > 0 ? up : down) && !(open && x == end);
          bool got;
          assert_true(cag_contains(vm, cag_number(x), r, &got));
          assert_int_equal(got, expected);
        }
      }
}

static void lists_hold_their_elements_and_no_others(void **state) {
  CagVm *vm = *state;
  for (int round = 0; round < 600; round++) {
    const size_t n = chance(6), dim = 1 + chance(4);
    const uint32_t kind = chance(KINDS);
    CagValue values[6];
    for (size_t i = 0; i < n; i++) values[i] = random_element(vm, kind, dim);
    CagValue needle = random_element(vm, chance(2) ? kind : chance(KINDS), 1 + chance(4));
    if (n && chance(2)) needle = values[chance((uint32_t)n)];
    bool expected = false, got;
    for (size_t i = 0; i < n; i++) expected = expected || cag_equal(vm, needle, values[i]);
    assert_true(cag_contains(vm, needle, cag_list_values(vm, values, n), &got));
    assert_int_equal(got, expected);
  }
}

// ---- ranges ----

// Steps of hundredths: the k-th element is the decimal number, and the last one is the end itself.
static void ranges_count_decimal_steps(void **state) {
  CagVm *vm = *state;
  for (int round = 0; round < 3000; round++) {
    const int start = (int)chance(200) - 100, step = (int)chance(41) - 20, many = (int)chance(60);
    if (step == 0) continue;
    const int rest = chance(2) ? 0 : (int)chance((uint32_t)abs(step));
    const int end = start + many * step + (step > 0 ? rest : -rest);
    const bool open = chance(2);
    const CagRange r = {.start = start / 100.0,
                        .end = end / 100.0,
                        .step = step / 100.0,
                        .open = open,
                        .stepped = true};
    size_t count;
    assert_true(cag_range_count(vm, &r, &count));
    assert_int_equal(count, (size_t)(open && rest == 0 ? many : many + 1));
    for (size_t k = 0; k < count; k++) {
      const double x = cag_range_element(&r, k, count);
      assert_true(fabs(x - (start + (double)k * step) / 100) <= 1e-14);
    }
    if (rest == 0 && many > 0) assert_true(cag_range_element(&r, (size_t)many, count) == r.end);
    // In the opposite direction, it is empty.
    const CagRange back = {.start = r.start, .end = r.start - r.step, .step = r.step, .open = open};
    assert_true(cag_range_count(vm, &back, &count));
    assert_int_equal(count, 0);
  }
  // A range with too many elements for a list, or an infinite one.
  size_t count;
  const CagRange large = {.start = 0, .end = 1e15, .step = 1}, larger = {.end = 2e15, .step = 1};
  assert_true(cag_range_count(vm, &large, &count));
  assert_true(count == 1000000000000001u);
  assert_false(cag_range_count(vm, &larger, &count));
  assert_non_null(strstr(error_text(vm), "more than 1e15"));
  const CagRange endless[] = {{.start = 0, .end = HUGE_VAL, .step = 1},
                              {.start = -HUGE_VAL, .end = 0, .step = 1}};
  for (int i = 0; i < 2; i++) {
    assert_false(cag_range_count(vm, &endless[i], &count));
    assert_non_null(strstr(error_text(vm), "a range to inf"));
  }
  forget_error(vm);
}

static void ranges_become_lists_of_their_elements(void **state) {
  CagVm *vm = *state;
  for (int angle = 0; angle < 2; angle++) {
    const CagValue r = cag_range_new(vm, 0, 1, 0.25, angle, false, true);
    CagValue list;
    assert_true(cag_as_list(vm, r, &list));
    assert_string_equal(printed(vm, list), angle ? "[0deg, 0.25deg, 0.5deg, 0.75deg, 1deg]"
                                                 : "[0, 0.25, 0.5, 0.75, 1]");
  }
}

// ---- numbers as text ----

// Counts the digits of a number without its point, leading zeros, and exponent.
static size_t significant(const char *text) {
  size_t n = 0, zeros = 0;
  for (; *text && *text != 'e'; text++) {
    if (*text < '0' || *text > '9' || (n == 0 && *text == '0')) continue;
    n++;
    zeros = *text == '0' ? zeros + 1 : 0;
  }
  return n - zeros;
}

// A printed number reads back as itself, with as few digits as possible.
static void numbers_are_printed_shortest(void **state) {
  (void)state;
  for (int round = 0; round < 20000; round++) {
    double x;
    if (round % 3 == 0) {
      uint64_t bits = 0;
      for (int i = 0; i < 4; i++) bits = bits << 16 | chance(65536);
      memcpy(&x, &bits, sizeof x);
    } else {
      const double digits = chance(10000), more = round % 3 == 1 ? 0 : chance(1000000);
      x = (digits + more / 1e6) * pow(10, (double)chance(40) - 22) * (chance(2) ? 1 : -1);
    }
    if (!isfinite(x)) continue;
    CagString s = {0};
    cag_print_number(&s, x);
    assert_true(strtod(s.bytes, NULL) == x);
    const double size = fabs(x);
    const bool exponent = strchr(s.bytes, 'e') != NULL;
    assert_int_equal(exponent, size != 0 && (size < 1e-5 || size >= 1e17));
    // Integers below 2^53 have all their digits; other numbers have no shorter form.
    const size_t n = significant(s.bytes);
    char shorter[40];
    if (n > 1) {
      snprintf(shorter, sizeof shorter, "%.*e", (int)n - 2, x);
      assert_true(strtod(shorter, NULL) != x);
    }
    // There are no redundant zeros, either before the point or at the end of a fraction.
    const char *text = s.bytes + (*s.bytes == '-'), *point = strchr(text, '.');
    if (text[0] == '0') assert_true(text[1] == '.' || text[1] == 0);
    const size_t last = exponent ? (size_t)(strchr(s.bytes, 'e') - s.bytes) : s.length;
    if (point) assert_true(s.bytes[last - 1] != '0' && s.bytes[last - 1] != '.');
    if (exponent) assert_true(text[0] != '0' && (text[1] == '.' || text[1] == 'e'));
    cag_string_free(&s);
  }
}

static void numbers_have_their_printed_forms(void **state) {
  CagVm *vm = *state;
  static const struct {
    double x;
    const char *text;
  } rows[] = {{0, "0"},
              {-0.0, "0"},
              {1, "1"},
              {-1, "-1"},
              {0.5, "0.5"},
              {1e-5, "0.00001"},
              {9.5e-6, "9.5e-6"},
              {1e-6, "1e-6"},
              {0.00125, "0.00125"},
              {1e16, "10000000000000000"},
              {1e17, "1e17"},
              {1.5e17, "1.5e17"},
              {999999999999999.0, "999999999999999"},
              {1e15, "1000000000000000"},
              {1234567890123456.0, "1234567890123456"},
              {12.75, "12.75"},
              {123456789.125, "123456789.125"},
              {HUGE_VAL, "inf"},
              {-HUGE_VAL, "-inf"},
              {5e-324, "5e-324"},
              {0.1, "0.1"},
              {100, "100"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    assert_string_equal(printed(vm, cag_number(rows[i].x)), rows[i].text);
  assert_string_equal(printed(vm, cag_number(NAN)), "nan");
}

static const char *described(CagVm *vm, CagValue v) {
  static char text[256];
  CagString s = {0};
  cag_describe_value(vm, &s, v);
  snprintf(text, sizeof text, "%s", s.bytes);
  cag_string_free(&s);
  return text;
}

// Messages include the contents of values of up to 40 characters.
static void messages_name_short_values(void **state) {
  CagVm *vm = *state;
  char text[64], expected[128];
  for (size_t n = 0; n <= 42; n++) {
    memset(text, 'a', n);
    text[n] = 0;
    if (n <= 40) snprintf(expected, sizeof expected, "the text \"%s\"", text);
    else snprintf(expected, sizeof expected, "a text of %zu characters", n);
    assert_string_equal(described(vm, cag_text_c(vm, text)), expected);
  }
  for (size_t n = 0; n <= 10; n++) { // n numbers of d digits are n (d + 2) characters with brackets
    for (size_t digits = 1; digits < 9; digits++) {
      double x[10];
      for (size_t i = 0; i < n; i++) x[i] = pow(10, (double)digits - 1);
      const CagValue list = cag_vector(vm, x, n);
      if (n == 0) snprintf(expected, sizeof expected, "an empty list");
      else if (n <= 8 && n * (digits + 2) <= 40)
        snprintf(expected, sizeof expected, "the list %.100s", printed(vm, list));
      else snprintf(expected, sizeof expected, "a list of %zu element%s", n, n == 1 ? "" : "s");
      assert_string_equal(described(vm, list), expected);
    }
  }
}

// ---- records ----

static void records_find_their_fields(void **state) {
  CagVm *vm = *state;
  for (size_t n = 0; n <= 40; n++) {
    char names[40][8];
    const char *pointers[40];
    CagValue values[40], turned[40];
    const char *turned_names[40];
    for (size_t i = 0; i < n; i++) {
      snprintf(names[i], sizeof names[i], "f%zu", i * i);
      pointers[i] = names[i];
      values[i] = cag_number((double)i);
    }
    for (size_t i = 0; i < n; i++) {
      turned_names[i] = names[n - 1 - i];
      turned[i] = values[n - 1 - i];
    }
    const CagValue r = cag_record_new(vm, pointers, values, n);
    const CagRecord *record = CAG_AS_RECORD(r);
    assert_int_equal(record->layout->count, n);
    // From 9 fields on, lookup uses a hash table.
    assert_int_equal(record->layout->index != NULL, n > 8);
    for (size_t i = 0; i < 1700; i++) {
      char name[8];
      snprintf(name, sizeof name, "f%zu", i);
      const size_t root = (size_t)sqrt((double)i);
      const bool has = root * root == i && root < n;
      const CagValue a = cag_record_get(record, name);
      const CagValue text = cag_text_c(vm, name);
      const CagValue b = cag_record_get_text(vm, record, CAG_AS_TEXT(text));
      assert_int_equal(a.type, has ? CAG_NUMBER : CAG_UNSET);
      assert_int_equal(b.type, has ? CAG_NUMBER : CAG_UNSET);
      if (has) assert_true(a.as.number == (double)root && b.as.number == (double)root);
      bool in;
      assert_true(cag_contains(vm, text, r, &in));
      assert_int_equal(in, has);
    }
    // Equality does not depend on the order of the fields, but on all of them.
    assert_true(cag_equal(vm, r, cag_record_new(vm, turned_names, turned, n)));
    if (n == 0) continue;
    turned[n / 2] = cag_number(-1);
    assert_false(cag_equal(vm, r, cag_record_new(vm, turned_names, turned, n)));
    assert_false(cag_equal(vm, r, cag_record_new(vm, pointers, values, n - 1)));
    assert_false(cag_equal(vm, cag_record_new(vm, pointers, values, n - 1), r));
    pointers[n - 1] = "other";
    assert_false(cag_equal(vm, r, cag_record_new(vm, pointers, values, n)));
  }
}

static void texts_are_interned_once(void **state) {
  CagVm *vm = *state;
  CagText *first[3000];
  char name[16];
  for (int i = 0; i < 3000; i++) {
    snprintf(name, sizeof name, "name%d", i);
    first[i] = cag_intern(vm, name, strlen(name));
    assert_string_equal(first[i]->bytes, name);
    assert_true(first[i]->interned);
  }
  for (int i = 0; i < 3000; i++) {
    snprintf(name, sizeof name, "name%d", i);
    assert_ptr_equal(cag_intern(vm, name, strlen(name)), first[i]);
    assert_ptr_not_equal(cag_intern(vm, name, strlen(name) - 1), first[i]);
  }
}

static void lists_keep_their_representation(void **state) {
  CagVm *vm = *state;
  const CagValue mixed[3] = {cag_number(1), cag_number(2), cag_none()};
  CagList *l = CAG_AS_LIST(cag_list_values(vm, mixed, 3));
  assert_true(cag_check_list(l));
  l->as.items[2] = cag_number(3); // numbers that are not packed
  assert_false(cag_check_list(l));
  l->length = 0;
  assert_true(cag_check_list(l));
  l->dim = 1; // an empty list has dim 0
  assert_false(cag_check_list(l));
  CagList *numbers = CAG_AS_LIST(cag_list_values(vm, mixed, 2));
  assert_int_equal(numbers->dim, 1);
  assert_true(cag_check_list(numbers));
  numbers->dim = CAG_MAX_PACKED + 1;
  assert_false(cag_check_list(numbers));
  numbers->dim = 1;
  CagList part = {.owner = numbers, .length = 1, .dim = 1};
  part.as.numbers = numbers->as.numbers + 1;
  assert_true(cag_check_list(&part));
  part.length = 2; // beyond its end
  assert_false(cag_check_list(&part));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lists_keep_their_representation),
      cmocka_unit_test(lists_keep_their_elements_in_the_promised_form),
      cmocka_unit_test(ranges_select_the_elements_of_lists_and_texts),
      cmocka_unit_test(single_indices_count_from_both_ends),
      cmocka_unit_test(remainders_have_the_sign_of_the_divisor),
      cmocka_unit_test(lists_are_computed_element_by_element),
      cmocka_unit_test(infinite_results_need_infinite_operands),
      cmocka_unit_test(texts_compare_as_their_code_points),
      cmocka_unit_test(ranges_hold_what_lies_between_their_ends),
      cmocka_unit_test(lists_hold_their_elements_and_no_others),
      cmocka_unit_test(ranges_count_decimal_steps),
      cmocka_unit_test(ranges_become_lists_of_their_elements),
      cmocka_unit_test(numbers_are_printed_shortest),
      cmocka_unit_test(numbers_have_their_printed_forms),
      cmocka_unit_test(messages_name_short_values),
      cmocka_unit_test(records_find_their_fields),
      cmocka_unit_test(texts_are_interned_once),
  };
  return cmocka_run_group_tests_name("values", tests, open_vm, close_vm);
}
