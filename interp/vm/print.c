// The printed form of values (language, section 7), and equality.

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "interp/vm/jet.h"
#include "interp/vm/value_type.h"
#include "interp/vm/vm.h"

static void add(CagString *s, const char *text) { cag_string_add(s, text, strlen(text)); }

void cag_string_check(CagVm *vm, CagString *s) {
  if (!s->failed) return;
  cag_string_free(s);
  cag_vm_out_of_memory(vm);
}

static void free_string(void *s) { cag_string_free(s); }

CagValue cag_text_from_string(CagVm *vm, CagString *s) {
  cag_string_check(vm, s);
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_string, s);
  CagValue text = cag_text_new(vm, s->length ? s->bytes : "", s->length);
  cag_cleanup_run(&cleanup);
  return text;
}

CagText *cag_intern_string(CagVm *vm, CagString *s) {
  cag_string_check(vm, s);
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_string, s);
  CagText *text = cag_intern(vm, s->length ? s->bytes : "", s->length);
  cag_cleanup_run(&cleanup);
  return text;
}

// --- Numbers ---

// Computes the decimal digits, without a point, of the shortest form of |x| that reads back as x,
// and the exponent of the first digit.
static int shortest_digits(double x, char digits[20], int *exponent) {
  char text[40];
  // A normal double of up to 15 digits is preserved by 15 digits, and any double by 17.
  for (int precision = x < DBL_MIN ? 1 : 15; precision <= 17; precision++) {
    snprintf(text, sizeof text, "%.*e", precision - 1, x);
    if (precision == 17 || strtod(text, NULL) == x) break;
  }
  int n = 0;
  const char *p = text;
  for (; *p && *p != 'e'; p++)
    if (*p >= '0' && *p <= '9') digits[n++] = *p;
  *exponent = atoi(p + 1);
  while (n > 1 && digits[n - 1] == '0') n--;
  digits[n] = 0;
  return n;
}

void cag_print_number(CagString *s, double x) {
  if (x == 0) {
    add(s, "0");
    return;
  }
  if (isnan(x)) {
    add(s, "nan");
    return;
  }
  if (x < 0) add(s, "-");
  x = fabs(x);
  if (isinf(x)) {
    add(s, "inf");
    return;
  }
  if (x < 1e15 && x == floor(x)) { // the common case: integers
    cag_string_printf(s, "%.0f", x);
    return;
  }
  char digits[20];
  int exponent;
  int n = shortest_digits(x, digits, &exponent);
  if (x < 1e-5 || x >= 1e17) { // exponent form: one digit before the point
    cag_string_add(s, digits, 1);
    if (n > 1) {
      add(s, ".");
      cag_string_add(s, digits + 1, (size_t)n - 1);
    }
    cag_string_printf(s, "e%d", exponent);
  } else if (exponent < 0) {
    add(s, "0.");
    for (int i = -1; i > exponent; i--) add(s, "0");
    cag_string_add(s, digits, (size_t)n);
  } else if (n <= exponent + 1) {
    cag_string_add(s, digits, (size_t)n);
    for (int i = n; i <= exponent; i++) add(s, "0");
  } else {
    cag_string_add(s, digits, (size_t)exponent + 1);
    add(s, ".");
    cag_string_add(s, digits + exponent + 1, (size_t)(n - exponent - 1));
  }
}

// --- Values ---

void cag_print_quoted(CagString *s, const CagText *t) {
  add(s, "\"");
  for (size_t i = 0; i < t->length; i++) {
    unsigned char c = (unsigned char)t->bytes[i];
    switch (c) {
    case '"': add(s, "\\\""); break;
    case '\\': add(s, "\\\\"); break;
    case '\n': add(s, "\\n"); break;
    case '\t': add(s, "\\t"); break;
    case '{': add(s, "\\{"); break;
    case '}': add(s, "\\}"); break;
    default:
      if (c < 0x20 || c == 0x7f) cag_string_printf(s, "\\u{%x}", c);
      else cag_string_add(s, (const char *)&t->bytes[i], 1);
    }
  }
  add(s, "\"");
}

bool cag_string_fits(CagVm *vm, const CagString *s) {
  if (!s->failed) return true;
  if (!vm->failed)
    cag_vm_fail(vm, CAG_ERR_limit_memory,
                "the printed value exceeds the memory limit (--max-memory)");
  return false;
}

bool cag_print_is_cut(CagVm *vm, const CagString *s) {
  return !cag_string_fits(vm, s) || vm->stop || (s->most && s->length > s->most);
}

void cag_print_numbers(CagVm *vm, CagString *s, const double *x, size_t n) {
  add(s, "[");
  for (size_t i = 0; i < n && !cag_print_is_cut(vm, s); i++) {
    if (i) add(s, ", ");
    cag_print_number(s, x[i]);
  }
  add(s, "]");
}

void cag_print_value(CagVm *vm, CagString *s, CagValue v, bool quoted) {
  const CagValueType *type = cag_value_type(v);
  const CagText *text = v.type == CAG_TEXT && !quoted ? CAG_AS_TEXT(v) : NULL;
  if (!cag_room_on_c_stack(vm)) add(s, "..."); // nested hundreds of thousands of levels deep
  else if (text) cag_string_add(s, text->bytes, text->length);
  else if (type->print) type->print(vm, s, v);
  else add(s, cag_type_name(v));
  vm->starved |= s->failed;
}

void cag_describe_value(CagVm *vm, CagString *s, CagValue v) {
  const CagValueType *type = cag_value_type(v);
  if (type->describe) type->describe(vm, s, v);
  else add(s, cag_type_article(v));
  vm->starved |= s->failed;
}

bool cag_equal(CagVm *vm, CagValue a, CagValue b) {
  if (a.type == CAG_JET || b.type == CAG_JET) {
    a = cag_plain(a);
    b = cag_plain(b);
  }
  if (a.type != b.type) return false;
  const CagValueType *type = cag_value_type(a);
  return type->equal ? type->equal(vm, a, b) : a.as.object == b.as.object;
}
