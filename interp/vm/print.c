// The printed form of values (language, section 7), and equality.

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "interp/vm/apply.h"
#include "interp/vm/jet.h"
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

// Decimal digits (no point) of the shortest form of |x| that reads back as x, and the exponent of
// the first digit.
static int shortest_digits(double x, char digits[20], int *exponent) {
  char text[40];
  // Any normal double of up to 15 digits survives 15; 17 always do.
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
  if (x < 1e15 && x == floor(x)) { // the common case: whole numbers
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

static void print_quoted(CagString *s, const CagText *t) {
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

// Whether a field's name can stand without quotes.
static bool is_word(const CagText *t) {
  if (t->length == 0 || (t->bytes[0] >= '0' && t->bytes[0] <= '9')) return false;
  for (size_t i = 0; i < t->length; i++) {
    unsigned char c = (unsigned char)t->bytes[i];
    bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c >= 0x80 ||
                  (c >= '0' && c <= '9');
    if (!letter) return false;
  }
  return true;
}

bool cag_string_fits(CagVm *vm, const CagString *s) {
  if (!s->failed) return true;
  if (!vm->failed)
    cag_vm_fail(vm, CAG_ERR_limit_memory,
                "the printed value does not fit the memory (--max-memory)");
  return false;
}

// Tests whether printing must end: the run must stop, or the text is long enough.
static bool is_cut(CagVm *vm, const CagString *s) {
  return !cag_string_fits(vm, s) || vm->stop || (s->most && s->length > s->most);
}

static void print_numbers(CagVm *vm, CagString *s, const double *x, size_t n) {
  add(s, "[");
  for (size_t i = 0; i < n && !is_cut(vm, s); i++) {
    if (i) add(s, ", ");
    cag_print_number(s, x[i]);
  }
  add(s, "]");
}

static void print_list(CagVm *vm, CagString *s, const CagList *l) {
  if (l->dim == 1) {
    print_numbers(vm, s, l->as.numbers, l->length);
    return;
  }
  add(s, "[");
  for (size_t i = 0; i < l->length && !is_cut(vm, s); i++) {
    if (i) add(s, ", ");
    if (l->dim) print_numbers(vm, s, l->as.numbers + i * l->dim, l->dim);
    else cag_print_value(vm, s, l->as.items[i], true);
  }
  add(s, "]");
}

static void print_record(CagVm *vm, CagString *s, const CagRecord *r) {
  add(s, "{");
  for (size_t i = 0; i < r->layout->count && !is_cut(vm, s); i++) {
    if (i) add(s, ", ");
    const CagText *name = r->layout->names[i];
    if (is_word(name)) add(s, name->bytes);
    else print_quoted(s, name);
    add(s, ": ");
    cag_print_value(vm, s, r->fields[i], true);
  }
  add(s, "}");
}

static void print_range(CagString *s, const CagRange *r) {
  const char *unit = r->angle ? "deg" : "";
  cag_print_number(s, r->start);
  add(s, unit);
  add(s, r->open ? "..<" : "..");
  cag_print_number(s, r->end);
  add(s, unit);
  if (!r->stepped) return;
  add(s, " by ");
  cag_print_number(s, r->step);
  add(s, unit);
}

static void print_value(CagVm *vm, CagString *s, CagValue v, bool quoted) {
  switch (v.type) {
  case CAG_NONE: add(s, "none"); break;
  case CAG_BOOL: add(s, v.as.boolean ? "true" : "false"); break;
  case CAG_NUMBER: cag_print_number(s, v.as.number); break;
  case CAG_JET: cag_print_value(vm, s, cag_plain(v), quoted); break;
  case CAG_ANGLE:
    cag_print_number(s, v.as.number);
    add(s, "deg");
    break;
  case CAG_TEXT:
    if (quoted) print_quoted(s, CAG_AS_TEXT(v));
    else cag_string_add(s, CAG_AS_TEXT(v)->bytes, CAG_AS_TEXT(v)->length);
    break;
  case CAG_LIST: print_list(vm, s, CAG_AS_LIST(v)); break;
  case CAG_RANGE: print_range(s, CAG_AS_RANGE(v)); break;
  case CAG_RECORD: print_record(vm, s, CAG_AS_RECORD(v)); break;
  case CAG_CLOSURE: {
    const char *name = CAG_AS_CLOSURE(v)->proto->name;
    if (name) cag_string_printf(s, "function %s", name);
    else add(s, "function");
    break;
  }
  case CAG_BUILTIN:
    cag_string_printf(s, "function %s", cag_builtin_name(CAG_AS_BUILTIN(v)->index));
    break;
  case CAG_TRANSFORM: {
    const CagTransform *t = &CAG_AS_TRANSFORM(v)->t;
    add(s, "[");
    for (int i = 0; i < 4; i++) {
      if (i) add(s, ", ");
      print_numbers(vm, s, t->m[i], 4);
    }
    add(s, "]");
    break;
  }
  case CAG_MODULE: {
    const char *name = vm->modules[CAG_AS_MODULE(v)->module]->name;
    const char *last = strrchr(name, '/');
    name = last ? last + 1 : name;
    if (strncmp(name, "std.", 4) == 0) name += 4;
    size_t n = strlen(name);
    if (n > 4 && strcmp(name + n - 4, ".cag") == 0) n -= 4;
    cag_string_printf(s, "module %.*s", (int)n, name);
    break;
  }
  case CAG_UNSET:
  case CAG_INTERNAL: add(s, "nothing"); break;
  default: cag_describe_shape(vm, s, v); break;
  }
}

void cag_print_value(CagVm *vm, CagString *s, CagValue v, bool quoted) {
  if (cag_room_on_c_stack(vm)) print_value(vm, s, v, quoted);
  else add(s, "..."); // nested hundreds of thousands deep
  vm->starved |= s->failed;
}

// Longer values are named by their type and size alone.
#define DESCRIBED_MAX 40

static void describe_value(CagVm *vm, CagString *s, CagValue v) {
  switch (v.type) {
  case CAG_NONE: add(s, "none"); return;
  case CAG_BOOL: add(s, v.as.boolean ? "true" : "false"); return;
  case CAG_JET: describe_value(vm, s, cag_plain(v)); return;
  case CAG_NUMBER:
    add(s, "the number ");
    cag_print_number(s, v.as.number);
    return;
  case CAG_ANGLE:
    add(s, "the angle ");
    cag_print_value(vm, s, v, true);
    return;
  case CAG_TEXT:
    if (CAG_AS_TEXT(v)->length > DESCRIBED_MAX) {
      cag_string_printf(s, "a text of %zu characters", CAG_AS_TEXT(v)->characters);
      return;
    }
    add(s, "the text ");
    print_quoted(s, CAG_AS_TEXT(v));
    return;
  case CAG_RANGE:
    add(s, "the range ");
    print_range(s, CAG_AS_RANGE(v));
    return;
  case CAG_LIST: {
    const CagList *l = CAG_AS_LIST(v);
    if (l->length == 0) {
      add(s, "an empty list");
      return;
    }
    CagString inner = {.most = DESCRIBED_MAX};
    if (l->length <= 8) cag_print_value(vm, &inner, v, true);
    if (inner.length && inner.length <= DESCRIBED_MAX && !vm->stop)
      cag_string_printf(s, "the list %s", inner.bytes);
    else
      cag_string_printf(s, "a list of %zu %s", l->length, l->length == 1 ? "element" : "elements");
    cag_string_free(&inner);
    return;
  }
  case CAG_CLOSURE:
    if (CAG_AS_CLOSURE(v)->proto->name)
      cag_string_printf(s, "the function %s", CAG_AS_CLOSURE(v)->proto->name);
    else add(s, "a function");
    return;
  case CAG_BUILTIN:
    cag_string_printf(s, "the function %s", cag_builtin_name(CAG_AS_BUILTIN(v)->index));
    return;
  default: add(s, cag_type_article(v)); return;
  }
}

void cag_describe_value(CagVm *vm, CagString *s, CagValue v) {
  describe_value(vm, s, v);
  vm->starved |= s->failed;
}

// --- Equality ---

static bool equal_lists(CagVm *vm, const CagList *a, const CagList *b) {
  if (a->length != b->length) return false;
  if (a->dim != b->dim) { // alike only where one holds jets, which are equal by their values
    if (!vm->differentiation || a->dim + b->dim == 0 || (a->dim && b->dim)) return false;
    for (size_t i = 0; i < a->length; i++)
      if (!cag_equal(vm, cag_list_get(vm, a, i), cag_list_get(vm, b, i))) return false;
    return true;
  }
  if (a->dim == 0) {
    for (size_t i = 0; i < a->length; i++)
      if (!cag_equal(vm, a->as.items[i], b->as.items[i])) return false;
    return true;
  }
  for (size_t i = 0; i < a->length * a->dim; i++)
    if (a->as.numbers[i] != b->as.numbers[i]) return false;
  return true;
}

static bool equal_records(CagVm *vm, const CagRecord *a, const CagRecord *b) {
  if (a->layout->count != b->layout->count) return false;
  for (size_t i = 0; i < a->layout->count; i++) {
    CagValue other = cag_record_get_text(vm, b, a->layout->names[i]);
    if (other.type == CAG_UNSET || !cag_equal(vm, a->fields[i], other)) return false;
  }
  return true;
}

bool cag_equal(CagVm *vm, CagValue a, CagValue b) {
  if (a.type == CAG_JET || b.type == CAG_JET) {
    a = cag_plain(a);
    b = cag_plain(b);
  }
  if (a.type != b.type) return false;
  if ((a.type == CAG_LIST || a.type == CAG_RECORD) && !cag_may_go_deeper(vm, "compared"))
    return false;
  switch (a.type) {
  case CAG_NONE: return true;
  case CAG_BOOL: return a.as.boolean == b.as.boolean;
  case CAG_NUMBER:
  case CAG_ANGLE: return a.as.number == b.as.number;
  case CAG_TEXT: {
    const CagText *x = CAG_AS_TEXT(a), *y = CAG_AS_TEXT(b);
    return x == y || (x->length == y->length && memcmp(x->bytes, y->bytes, x->length) == 0);
  }
  case CAG_LIST:
    return a.as.object == b.as.object || equal_lists(vm, CAG_AS_LIST(a), CAG_AS_LIST(b));
  case CAG_RANGE: {
    const CagRange *x = CAG_AS_RANGE(a), *y = CAG_AS_RANGE(b);
    return x->start == y->start && x->end == y->end && x->step == y->step && x->angle == y->angle &&
           x->open == y->open;
  }
  case CAG_RECORD:
    return a.as.object == b.as.object || equal_records(vm, CAG_AS_RECORD(a), CAG_AS_RECORD(b));
  case CAG_BUILTIN: return CAG_AS_BUILTIN(a)->index == CAG_AS_BUILTIN(b)->index;
  case CAG_TRANSFORM: {
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++)
        if (CAG_AS_TRANSFORM(a)->t.m[i][j] != CAG_AS_TRANSFORM(b)->t.m[i][j]) return false;
    return true;
  }
  case CAG_PLANE: {
    const CagPlane *x = &CAG_AS_PLANE(a)->plane, *y = &CAG_AS_PLANE(b)->plane;
    return x->point.x == y->point.x && x->point.y == y->point.y && x->point.z == y->point.z &&
           x->normal.x == y->normal.x && x->normal.y == y->normal.y && x->normal.z == y->normal.z;
  }
  case CAG_MODULE: return CAG_AS_MODULE(a)->module == CAG_AS_MODULE(b)->module;
  default: return a.as.object == b.as.object;
  }
}
