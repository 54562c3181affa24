// What the families of built-ins share: results, sequences, order, mixing, and decimal rounding.

#include "interp/builtin/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "interp/vm/jet.h"

// --- Texts ---

static void free_held_string(void *s) {
  cag_string_free(s);
  cag_free(s);
}

CagString *cag_held_string(CagCall *call) {
  CagString *s = cag_hold_array(call, 1, sizeof *s);
  cag_hold_for(call, free_held_string, cag_give_held(call, s));
  return s;
}

// --- Results ---

static bool all_finite(const CagCall *call) {
  for (size_t i = 0; i < call->count; i++) {
    CagValue v = call->values[i];
    if ((v.type == CAG_NUMBER || v.type == CAG_ANGLE) && !isfinite(v.as.number)) return false;
  }
  return true;
}

// The arguments as they stand in a call, for messages, which show so many bytes of them.
#define ARGUMENTS_MOST 120
static const char *print_arguments(CagCall *call) {
  CagString *out = cag_held_string(call);
  out->most = ARGUMENTS_MOST;
  for (size_t i = 0; i < call->count && call->values[i].type != CAG_UNSET; i++) {
    if (i > 0) cag_string_add(out, ", ", 2);
    cag_print_value(call->vm, out, call->values[i], true);
  }
  cag_string_add(out, "", 1);
  return out->bytes;
}

static bool check_result(CagCall *call, double x) {
  // A result that is infinite because an argument was infinite is not an overflow. (The test for
  // NaN comes first for the reason given in operators.c.)
  if (!isnan(x) && (isfinite(x) || !all_finite(call))) return true;
  return cag_fail_call(call, 0, CAG_ERR_not_finite, "%s for %.*s",
                       isnan(x) ? "is undefined" : "overflows", ARGUMENTS_MOST,
                       print_arguments(call));
}

bool cag_give_number(CagCall *call, double x, CagValue *result) {
  *result = cag_number(x);
  return check_result(call, x);
}

bool cag_give_angle(CagCall *call, double degrees, CagValue *result) {
  *result = cag_angle(degrees);
  return check_result(call, degrees);
}

// Records and lists of results nest less deep; deeper ones are the arguments' own.
#define RESULT_DEPTH 4

static bool all_defined(const double *x, size_t n) {
  int undefined = 0;
  for (size_t i = 0; i < n; i++) undefined |= isnan(x[i]);
  return !undefined;
}

static bool is_defined(CagValue v, int depth) {
  switch (v.type) {
  case CAG_NUMBER:
  case CAG_ANGLE: return !isnan(v.as.number);
  case CAG_TRANSFORM: return all_defined(&CAG_AS_TRANSFORM(v)->t.m[0][0], 16);
  case CAG_LIST: {
    const CagList *l = CAG_AS_LIST(v);
    if (l->owner || depth == 0) return true;
    if (l->dim > 0) return all_defined(l->as.numbers, l->length * l->dim);
    for (size_t i = 0; i < l->length; i++)
      if (!is_defined(l->as.items[i], depth - 1)) return false;
    return true;
  }
  case CAG_RECORD: {
    const CagRecord *r = CAG_AS_RECORD(v);
    for (size_t i = 0; depth > 0 && i < r->layout->count; i++)
      if (!is_defined(r->fields[i], depth - 1)) return false;
    return true;
  }
  default: return true;
  }
}

// Families whose results are parts of their arguments, which are defined.
static bool rearranges(const CagBuiltin *b) {
  return b->family && (strcmp(b->family, "Lists") == 0 || strcmp(b->family, "Records") == 0);
}

bool cag_check_defined(CagCall *call, CagValue result) {
  if (result.type == CAG_NUMBER || result.type == CAG_ANGLE) {
    if (!isnan(result.as.number)) return true;
  } else if (result.type < CAG_FIRST_OBJECT || rearranges(call->builtin) ||
             is_defined(result, RESULT_DEPTH)) {
    return true;
  }
  return cag_fail_call(call, -1, CAG_ERR_not_finite, "has an undefined result for %.120s",
                       print_arguments(call));
}

bool cag_fail_depth(CagCall *call) {
  return cag_fail_call(call, 0, CAG_ERR_value, "expects lists that are nested at most %d deep",
                       CAG_DEPTH_MOST);
}

bool cag_may_nest(CagCall *call, int depth) {
  if (depth > CAG_DEPTH_MOST) return cag_fail_depth(call);
  return cag_keep_going(call->vm);
}

// --- Sequences ---

size_t cag_character_size(const char *s) {
  unsigned char c = (unsigned char)*s;
  return c < 0x80 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
}

const char *cag_text_at(const CagText *t, size_t k) {
  if (t->characters == t->length) return t->bytes + k;
  const char *s = t->bytes;
  for (; k > 0; k--) s += cag_character_size(s);
  return s;
}

bool cag_sequence_open(CagCall *call, int argument, bool texts, CagSequence *out) {
  CagValue v = call->values[argument];
  *out = (CagSequence){.source = v};
  switch (v.type) {
  case CAG_LIST: out->length = CAG_AS_LIST(v)->length; return true;
  case CAG_RANGE: return cag_range_count(call->vm, CAG_AS_RANGE(v), &out->length);
  case CAG_TEXT:
    if (!texts) break;
    out->length = CAG_AS_TEXT(v)->characters;
    out->next = CAG_AS_TEXT(v)->bytes;
    return true;
  default: break;
  }
  return cag_fail_type(call, argument, texts ? "a list or a text" : "a list");
}

CagValue cag_sequence_element(CagVm *vm, CagSequence *s, size_t i) {
  if (s->source.type == CAG_LIST) return cag_list_get(vm, CAG_AS_LIST(s->source), i);
  if (s->source.type == CAG_RANGE) {
    const CagRange *r = CAG_AS_RANGE(s->source);
    double x = cag_range_element(r, i, s->length);
    return r->angle ? cag_angle(x) : cag_number(x);
  }
  size_t n = cag_character_size(s->next);
  CagValue character = cag_text_new(vm, s->next, n);
  s->next += n;
  return character;
}

// --- Order ---

bool cag_order(CagValue a, CagValue b, int *order) {
  if (a.type != b.type) return false;
  if (a.type == CAG_NUMBER || a.type == CAG_ANGLE) {
    *order = (a.as.number > b.as.number) - (a.as.number < b.as.number);
    return true;
  }
  if (a.type != CAG_TEXT) return false;
  // The order of UTF-8 bytes is that of code points.
  const CagText *s = CAG_AS_TEXT(a), *t = CAG_AS_TEXT(b);
  size_t common = s->length < t->length ? s->length : t->length;
  int c = memcmp(s->bytes, t->bytes, common);
  *order = c != 0 ? (c > 0) - (c < 0) : (s->length > t->length) - (s->length < t->length);
  return true;
}

bool cag_fail_order(CagCall *call, int argument, CagValue a, CagValue b) {
  if (cag_holds_jet(a) || cag_holds_jet(b)) return cag_fail_differentiate(call, argument);
  char left[120], right[120];
  return cag_fail_call(
      call, argument, CAG_ERR_not_comparable,
      "cannot compare %s and %s: it compares numbers with numbers, angles with angles, and texts with texts",
      cag_value_words(call->vm, a, left, sizeof left),
      cag_value_words(call->vm, b, right, sizeof right));
}

// --- Mixing ---

// From the nearer end: exact at both ends, constant where a = b, and with fewer rounding errors
// than (1 - t) a + t b, so that a tenth of the way from 1 to 2 is 1.1.
double cag_mix_numbers(double a, double b, double t) {
  double way = b - a;
  if (!isfinite(way)) return (1 - t) * a + t * b;
  return t <= 0.5 ? a + t * way : b - (1 - t) * way;
}

static bool mix_transforms(CagCall *call, CagValue a, CagValue b, double t, CagValue *out) {
  CagTransform mixed;
  CagError err = {0};
  if (cag_transform_mix(&CAG_AS_TRANSFORM(a)->t, &CAG_AS_TRANSFORM(b)->t, t, &mixed, &err))
    return cag_fail_geometry(call, &err);
  *out = cag_transform_value(call->vm, &mixed);
  return true;
}

static bool mix_values(CagCall *call, CagValue a, CagValue b, double t, int depth, CagValue *out);

static bool mix_lists(CagCall *call, const CagList *a, const CagList *b, double t, int depth,
                      CagValue *out) {
  if (!cag_may_nest(call, depth)) return false;
  if (a->length != b->length)
    return cag_fail_call(call, 1, CAG_ERR_length,
                         "expects lists of the same length, found %zu and %zu elements", a->length,
                         b->length);
  if (a->dim > 0 && a->dim == b->dim) {
    double *numbers;
    size_t n = a->length * a->dim;
    *out = a->dim == 1 ? cag_list_numbers(call->vm, n, &numbers)
                       : cag_list_vectors(call->vm, a->length, a->dim, &numbers);
    for (size_t i = 0; i < n; i++)
      numbers[i] = cag_mix_numbers(a->as.numbers[i], b->as.numbers[i], t);
    return true;
  }
  CagBuilder *built = cag_builder_new(call->vm);
  for (size_t i = 0; i < a->length; i++) {
    CagValue element;
    if (!mix_values(call, cag_list_get(call->vm, a, i), cag_list_get(call->vm, b, i), t, depth,
                    &element))
      return false;
    if (!cag_builder_add(call->vm, built, element)) return false;
  }
  *out = cag_builder_finish(call->vm, built);
  return true;
}

static bool mix_values(CagCall *call, CagValue a, CagValue b, double t, int depth, CagValue *out) {
  if (a.type == b.type && a.type == CAG_NUMBER)
    return cag_give_number(call, cag_mix_numbers(a.as.number, b.as.number, t), out);
  if (a.type == b.type && a.type == CAG_ANGLE)
    return cag_give_angle(call, cag_mix_numbers(a.as.number, b.as.number, t), out);
  if (a.type == b.type && a.type == CAG_TRANSFORM) return mix_transforms(call, a, b, t, out);
  bool lists =
      (a.type == CAG_LIST || a.type == CAG_RANGE) && (b.type == CAG_LIST || b.type == CAG_RANGE);
  if (lists)
    return cag_as_list(call->vm, a, &a) && cag_as_list(call->vm, b, &b) &&
           mix_lists(call, CAG_AS_LIST(a), CAG_AS_LIST(b), t, depth + 1, out);
  char left[120], right[120];
  return cag_fail_call(
      call, 0, CAG_ERR_type,
      "expects two numbers, angles, vectors, lists of these, or transforms to interpolate, found %s and %s",
      cag_value_words(call->vm, a, left, sizeof left),
      cag_value_words(call->vm, b, right, sizeof right));
}

bool cag_mix_values(CagCall *call, CagValue a, CagValue b, double t, CagValue *out) {
  return mix_values(call, a, b, t, 0, out);
}

// --- Decimal rounding ---

// A double as the shortest decimal that reads back the same: 0.DIGITS times ten to the power of
// `point`.
typedef struct Decimal {
  char digits[32];
  int count, point;
  bool negative;
} Decimal;

// 17 digits tell all doubles apart; 15 are always kept.
enum { DIGITS_FEWEST = 1, DIGITS_KEPT = 15, DIGITS_MOST = 17 };

static Decimal shortest_decimal(double x) {
  char text[48];
  for (int digits = DIGITS_KEPT; digits <= DIGITS_MOST; digits++) {
    snprintf(text, sizeof text, "%.*e", digits - 1, x);
    if (strtod(text, NULL) == x) break;
  }
  Decimal d = {.negative = text[0] == '-'};
  const char *s = text + d.negative;
  for (; *s && *s != 'e'; s++)
    if (*s != '.') d.digits[d.count++] = *s;
  while (d.count > DIGITS_FEWEST && d.digits[d.count - 1] == '0') d.count--;
  d.point = atoi(s + 1) + 1;
  return d;
}

// Keeps the digits down to `places` behind the point, halves away from 0.
static void round_digits(Decimal *d, int places) {
  int keep = d->point + places;
  if (keep >= d->count) return;
  if (keep < 0) {
    d->count = 0;
    return;
  }
  bool up = d->digits[keep] >= '5';
  d->count = keep;
  if (!up) return;
  int i = keep - 1;
  while (i >= 0 && d->digits[i] == '9') d->digits[i--] = '0';
  if (i >= 0) {
    d->digits[i]++;
    return;
  }
  // 9.99 has become 10.0.
  memmove(d->digits + 1, d->digits, (size_t)d->count);
  d->digits[0] = '1';
  d->count++;
  d->point++;
}

double cag_round_decimal(double x, int digits) {
  // From 2^52 on all doubles are whole.
  static const double WHOLE = 4503599627370496;
  if (!isfinite(x) || x == 0 || (digits >= 0 && fabs(x) >= WHOLE)) return x + 0.0;
  if (digits == 0) return round(x) + 0.0;
  Decimal d = shortest_decimal(x);
  round_digits(&d, digits);
  if (d.count == 0) return 0;
  char text[64];
  snprintf(text, sizeof text, "%s0.%.*se%d", d.negative ? "-" : "", d.count, d.digits, d.point);
  return strtod(text, NULL) + 0.0;
}

void cag_print_fixed(CagString *out, double x, int digits) {
  if (!isfinite(x)) {
    cag_string_printf(out, "%s", x > 0 ? "inf" : "-inf");
    return;
  }
  Decimal d = shortest_decimal(x);
  round_digits(&d, digits);
  bool zero = true;
  for (int i = 0; i < d.count; i++) zero = zero && d.digits[i] == '0';
  if (zero) d.count = 0;
  if (d.negative && !zero) cag_string_add(out, "-", 1);
  // Digit k stands before the point when k < point.
  int whole = !zero && d.point > 0 ? d.point : 0;
  for (int k = 0; k < whole; k++) cag_string_add(out, k < d.count ? &d.digits[k] : "0", 1);
  if (whole == 0) cag_string_add(out, "0", 1);
  if (digits > 0) cag_string_add(out, ".", 1);
  for (int place = 0; place < digits; place++) {
    int k = d.point + place;
    cag_string_add(out, !zero && k >= 0 && k < d.count ? &d.digits[k] : "0", 1);
  }
}

bool cag_is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static const char *skip_digits(const char *s, const char *end) {
  while (s < end && is_digit(*s)) s++;
  return s;
}

// The double of a text that is known to be a decimal number. strtod wants a NUL behind it.
static bool convert_number(const char *s, size_t n, double *out) {
  char buffer[128], *copy = n < sizeof buffer ? buffer : cag_malloc(n + 1);
  if (!copy) return false;
  memcpy(copy, s, n);
  copy[n] = 0;
  double x = strtod(copy, NULL);
  if (copy != buffer) cag_free(copy);
  *out = x + 0.0;
  return isfinite(x);
}

bool cag_read_number(const char *s, size_t n, double *out) {
  const char *end = s + n;
  while (s < end && cag_is_space(*s)) s++;
  while (end > s && cag_is_space(end[-1])) end--;
  // sign digits [ "." digits ] [ "e" sign digits ]; of the digits around the point one side may be
  // missing.
  const char *from = s;
  if (s < end && (*s == '+' || *s == '-')) s++;
  const char *whole = s;
  s = skip_digits(s, end);
  size_t count = (size_t)(s - whole);
  if (s < end && *s == '.') {
    const char *places = s + 1;
    s = skip_digits(places, end);
    count += (size_t)(s - places);
  }
  if (count == 0) return false;
  if (s < end && (*s == 'e' || *s == 'E')) {
    s++;
    if (s < end && (*s == '+' || *s == '-')) s++;
    const char *power = s;
    s = skip_digits(s, end);
    if (s == power) return false;
  }
  if (s != end) return false;
  return convert_number(from, (size_t)(end - from), out);
}

// --- Angles in degrees ---

#define DEGREES_PER_RADIAN 57.29577951308232
#define RADIANS_PER_DEGREE 0.017453292519943295

void cag_sincos_degrees(double degrees, double *sine, double *cosine) {
  // The rest to the nearest quarter turn is exact, and at most 45 degrees.
  double reduced = fmod(degrees, 360);
  double quarters = rint(reduced / 90);
  double rest = reduced - 90 * quarters;
  double s = sin(rest * RADIANS_PER_DEGREE), c = cos(rest * RADIANS_PER_DEGREE);
  if (fabs(rest) == 30) s = copysign(0.5, rest);
  switch ((int)quarters & 3) {
  case 0: *sine = s, *cosine = c; break;
  case 1: *sine = c, *cosine = -s; break;
  case 2: *sine = -s, *cosine = -c; break;
  default: *sine = -c, *cosine = s; break;
  }
  *sine += 0.0; // never -0
  *cosine += 0.0;
}

double cag_atan2_degrees(double y, double x) {
  if (y == 0) return x < 0 ? 180 : 0;
  if (x == 0) return y < 0 ? -90 : 90;
  if (fabs(x) == fabs(y)) return copysign(x < 0 ? 135 : 45, y);
  return atan2(y, x) * DEGREES_PER_RADIAN;
}
