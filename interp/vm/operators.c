// The operators of the language beyond the fast paths of the loop.

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/utf8.h"
#include "interp/vm/apply.h"
#include "interp/vm/calls.h"
#include "interp/vm/jet.h"
#include "interp/vm/jet_builtins.h"
#include "interp/vm/origin.h"
#include "interp/vm/value_type.h"
#include "interp/vm/vm.h"
#include "lang/foreign.h"

static const char *symbol(CagBinaryOp op) {
  static const char *const symbols[] = {"+",  "-",  "*", "/",  "%", "^",  "|", "&",
                                        "==", "!=", "<", "<=", ">", ">=", "in"};
  return symbols[op];
}

static bool fail_operands(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, const char *help) {
  CagString s = {0};
  cag_describe_value(vm, &s, a);
  cag_string_add(&s, " and ", 5);
  cag_describe_value(vm, &s, b);
  cag_vm_fail(vm, CAG_ERR_operand, "cannot apply `%s` to %s", symbol(op), s.bytes);
  cag_string_free(&s);
  if (help) cag_fail_help(vm, "%s", help);
  return false;
}

// --- Numbers and angles ---

// Fails if the result is not finite, unless an operand is infinite.
static bool check_number(CagVm *vm, CagBinaryOp op, double a, double b, double r, CagValue *result,
                         CagType type) {
  // The test for NaN comes first because, without traps, GCC 12 evaluates `finite, or infinite and
  // ...` as true for NaN.
  if (!isnan(r) &&
      (fabs(r) <= DBL_MAX || ((isinf(a) || isinf(b)) && !(op == CAG_OP_DIVIDE && b == 0)))) {
    *result = type == CAG_ANGLE ? cag_angle(r) : cag_number(r);
    return true;
  }
  char x[32], y[32];
  cag_number_text(a, x);
  cag_number_text(b, y);
  if (op == CAG_OP_DIVIDE && b == 0)
    return cag_vm_fail(vm, CAG_ERR_not_finite, "division of %s by 0", x);
  if (op == CAG_OP_MODULO && b == 0)
    return cag_vm_fail(vm, CAG_ERR_not_finite, "%s %% 0 is undefined", x);
  return cag_vm_fail(vm, CAG_ERR_not_finite,
                     isnan(r) ? "%s %s %s is undefined" : "%s %s %s is too large for a number", x,
                     symbol(op), y);
}

// The remainder, with the sign of the divisor.
static double modulo(double a, double b) {
  double r = fmod(a, b);
  if (r != 0 && (r < 0) != (b < 0)) r += b;
  return r;
}

static double apply(CagBinaryOp op, double a, double b) {
  switch (op) {
  case CAG_OP_ADD: return a + b;
  case CAG_OP_SUBTRACT: return a - b;
  case CAG_OP_MULTIPLY: return a * b;
  case CAG_OP_DIVIDE: return a / b;
  case CAG_OP_MODULO: return modulo(a, b);
  default: return pow(a, b);
  }
}

// Operators on two numbers, two angles, or one of each. Sets *known to false for other operands.
static bool scalars(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result,
                    bool *known) {
  *known = true;
  double x = a.as.number, y = b.as.number;
  if (a.type == CAG_NUMBER && b.type == CAG_NUMBER)
    return check_number(vm, op, x, y, apply(op, x, y), result, CAG_NUMBER);
  if (a.type == CAG_ANGLE && b.type == CAG_ANGLE) {
    if (op == CAG_OP_DIVIDE) return check_number(vm, op, x, y, x / y, result, CAG_NUMBER);
    if (op == CAG_OP_ADD || op == CAG_OP_SUBTRACT || op == CAG_OP_MODULO)
      return check_number(vm, op, x, y, apply(op, x, y), result, CAG_ANGLE);
    return fail_operands(vm, op, a, b,
                         op == CAG_OP_MULTIPLY
                             ? "an angle times a number is an angle; divide one angle by 1rad"
                             : NULL);
  }
  if (a.type == CAG_ANGLE && b.type == CAG_NUMBER) {
    if (op == CAG_OP_MULTIPLY || op == CAG_OP_DIVIDE)
      return check_number(vm, op, x, y, apply(op, x, y), result, CAG_ANGLE);
  } else if (a.type == CAG_NUMBER && b.type == CAG_ANGLE) {
    if (op == CAG_OP_MULTIPLY) return check_number(vm, op, x, y, x * y, result, CAG_ANGLE);
  } else {
    *known = false;
    return false;
  }
  char n[32], help[96];
  cag_number_text(a.type == CAG_NUMBER ? x : y, n);
  snprintf(help, sizeof help, "write %sdeg or %srad", n, n);
  return fail_operands(vm, op, a, b, op == CAG_OP_ADD || op == CAG_OP_SUBTRACT ? help : NULL);
}

// --- Lists ---

// Vectors that are not packed numbers (angles, jets) are made without a builder up to this length.
#define SHORT_LIST 4

static bool list_sum(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result);

// Loops over packed numbers check after blocks of this size whether the run must stop.
#define BLOCK ((size_t)1 << 16)
static size_t block_length(size_t from, size_t n) { return n - from < BLOCK ? n - from : BLOCK; }

// Computes sums or differences of n numbers. Returns a nonzero value if one is infinite or
// undefined.
static inline double sum_of(CagBinaryOp op, const double *x, const double *y, size_t n,
                            double *out) {
  double worst = 0;
  if (op == CAG_OP_ADD) {
    for (size_t i = 0; i < n; i++) worst += 0 * (out[i] = x[i] + y[i]);
  } else {
    for (size_t i = 0; i < n; i++) worst += 0 * (out[i] = x[i] - y[i]);
  }
  return worst;
}

// Adds or subtracts two packed lists of the same shape elementwise.
static bool packed_sum(CagVm *vm, CagBinaryOp op, const CagList *a, const CagList *b,
                       CagValue *result) {
  double *out;
  *result = a->dim == 1 ? cag_list_numbers(vm, a->length, &out)
                        : cag_list_vectors(vm, a->length, a->dim, &out);
  const double *x = a->as.numbers, *y = b->as.numbers;
  const size_t n = a->length * a->dim;
  double worst = 0;
  if (n <= BLOCK) {
    worst = sum_of(op, x, y, n, out);
  } else {
    for (size_t from = 0; from < n; from += BLOCK) {
      worst += sum_of(op, x + from, y + from, block_length(from, n), out + from);
      if (!cag_keep_going(vm)) return false;
    }
  }
  if (worst == 0) return true; // no element is infinite or undefined
  for (size_t i = 0; i < n; i++) {
    CagValue v;
    if (!check_number(vm, op, x[i], y[i], out[i], &v, CAG_NUMBER)) return false;
  }
  return true;
}

static bool list_sum(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result) {
  CagValue x, y;
  if (!cag_may_go_deeper(vm, "added")) return false;
  if (!cag_as_list(vm, a, &x) || !cag_as_list(vm, b, &y)) return false;
  const CagList *l = CAG_AS_LIST(x), *m = CAG_AS_LIST(y);
  if (l->length != m->length) {
    cag_vm_fail(vm, CAG_ERR_length, "`%s` of a list of %zu and a list of %zu elements", symbol(op),
                l->length, m->length);
    if (l->dim == 1 && m->dim == 1 && l->length + m->length == 5)
      cag_fail_help(vm, "write the 2-D point [x, y] as [x, y, 0]");
    else if (op == CAG_OP_ADD) cag_fail_help(vm, "to concatenate lists, write [...a, ...b]");
    return false;
  }
  if (l->dim && l->dim == m->dim) return packed_sum(vm, op, l, m, result);
  if (l->length <= SHORT_LIST) {
    CagValue parts[SHORT_LIST];
    for (size_t i = 0; i < l->length; i++)
      if (!cag_arithmetic(vm, op, cag_list_get(vm, l, i), cag_list_get(vm, m, i), &parts[i]))
        return false;
    *result = cag_list_values(vm, parts, l->length);
    return true;
  }
  CagBuilder *out = cag_builder_new(vm);
  for (size_t i = 0; i < l->length; i++) {
    CagValue v;
    if (!cag_arithmetic(vm, op, cag_list_get(vm, l, i), cag_list_get(vm, m, i), &v) ||
        !cag_builder_add(vm, out, v))
      return false;
  }
  *result = cag_builder_finish(vm, out);
  return true;
}

// A list multiplied or divided by a number. `swapped`: the number came first.
static bool list_scaled(CagVm *vm, CagBinaryOp op, CagValue list, CagValue factor, bool swapped,
                        CagValue *result) {
  CagValue x;
  if (!cag_may_go_deeper(vm, "multiplied")) return false;
  if (!cag_as_list(vm, list, &x)) return false;
  const CagList *l = CAG_AS_LIST(x);
  if (l->dim && factor.type == CAG_NUMBER) {
    double *out, k = factor.as.number, worst = 0;
    const size_t n = l->length * l->dim;
    *result = l->dim == 1 ? cag_list_numbers(vm, l->length, &out)
                          : cag_list_vectors(vm, l->length, l->dim, &out);
    for (size_t from = 0; from < n; from += BLOCK) {
      const size_t to = from + block_length(from, n);
      if (op == CAG_OP_MULTIPLY) {
        for (size_t i = from; i < to; i++) worst += 0 * (out[i] = l->as.numbers[i] * k);
      } else {
        for (size_t i = from; i < to; i++) worst += 0 * (out[i] = l->as.numbers[i] / k);
      }
      if (to < n && !cag_keep_going(vm)) return false;
    }
    if (worst == 0) return true;
    for (size_t i = 0; i < n; i++) {
      CagValue v;
      if (!check_number(vm, op, l->as.numbers[i], k, out[i], &v, CAG_NUMBER)) return false;
    }
    return true;
  }
  if (l->length <= SHORT_LIST) {
    CagValue parts[SHORT_LIST];
    for (size_t i = 0; i < l->length; i++) {
      CagValue e = cag_list_get(vm, l, i);
      if (!cag_arithmetic(vm, op, swapped ? factor : e, swapped ? e : factor, &parts[i]))
        return false;
    }
    *result = cag_list_values(vm, parts, l->length);
    return true;
  }
  CagBuilder *out = cag_builder_new(vm);
  for (size_t i = 0; i < l->length; i++) {
    CagValue v, e = cag_list_get(vm, l, i);
    if (!cag_arithmetic(vm, op, swapped ? factor : e, swapped ? e : factor, &v) ||
        !cag_builder_add(vm, out, v))
      return false;
  }
  *result = cag_builder_finish(vm, out);
  return true;
}

static bool is_list(CagValue v) { return v.type == CAG_LIST || v.type == CAG_RANGE; }
static bool is_scalar(CagValue v) {
  return v.type == CAG_NUMBER || v.type == CAG_ANGLE || v.type == CAG_JET;
}

// Operators on two scalars of which at least one is a jet: computes the value with plain numbers,
// and its derivatives.
static bool jets(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result) {
  bool known;
  CagValue value;
  return scalars(vm, op, cag_plain(a), cag_plain(b), &value, &known) &&
         cag_jet_arithmetic(vm, (int)op, a, b, value, result);
}

// --- Others ---

// Moves the top of the stack above the registers of the running frame, which the loop does not do
// for operators, so that a built-in can be called, which may call the script. Returns the old top.
static CagValue *raise_top(CagVm *vm) {
  CagValue *top = vm->top;
  if (vm->frame_count) {
    const CagFrame *f = &vm->frames[vm->frame_count - 1];
    if (f->base + f->proto->registers > top) vm->top = f->base + f->proto->registers;
  }
  return top;
}

// Set operations of solids and regions, by calling the corresponding built-in, whose rows accept
// different types of the first operand. For `-` and `|`, the elements of a list on the right become
// operands. Other lists stand for the union of their shapes.
static bool solids(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result) {
  const char *name = op == CAG_OP_UNION          ? "union"
                     : op == CAG_OP_INTERSECTION ? "intersection"
                                                 : "difference";
  size_t index = cag_builtin_find(name);
  if (index == (size_t)-1) return fail_operands(vm, op, a, b, NULL);
  CagValue operands[2] = {a, b};
  const bool several = b.type == CAG_LIST && op != CAG_OP_INTERSECTION;
  if (several) { // pass all operands as one list
    const CagList *list = CAG_AS_LIST(b);
    CagBuilder *builder = cag_builder_new(vm);
    cag_builder_add(vm, builder, a);
    for (size_t i = 0; i < list->length; i++)
      cag_builder_add(vm, builder, cag_list_get(vm, list, i));
    operands[0] = cag_builder_finish(vm, builder);
  }
  CagValue *top = raise_top(vm);
  bool ok = cag_call(vm, vm->builtin_values[index], operands, several ? 1 : 2, result);
  vm->top = top;
  return ok;
}

static bool is_body(CagValue v) {
  return v.type == CAG_SOLID || v.type == CAG_REGION || v.type == CAG_MESH ||
         v.type == CAG_SURFACE || v.type == CAG_GROUP;
}

// Tests for a list of bodies, or of lists of bodies. An empty list counts as one.
static bool is_bodies(CagVm *vm, CagValue v) {
  while (v.type == CAG_LIST) {
    const CagList *list = CAG_AS_LIST(v);
    if (list->length == 0) return true;
    if (list->dim != 0) return false;
    v = cag_list_get(vm, list, 0);
  }
  return is_body(v);
}

static bool are_bodies(CagVm *vm, CagValue a, CagValue b) {
  return (is_body(a) && is_bodies(vm, b)) || (is_bodies(vm, a) && is_body(b));
}

// Returns the help for operands to which the operator does not apply.
static const char *operand_help(CagBinaryOp op, CagValue a, CagValue b) {
  if (op == CAG_OP_MULTIPLY && is_list(a) && is_list(b))
    return "write dot(a, b) or cross(a, b); multiply(A, b) of matrices";
  if (op == CAG_OP_ADD && is_list(a) && is_scalar(b))
    return "to add an element, write [...list, x]";
  if (op == CAG_OP_ADD && (a.type == CAG_TEXT || b.type == CAG_TEXT))
    return "put the value into the text: \"... {x}\"";
  if (op == CAG_OP_UNION && a.type == CAG_BOOL) return "write `or`";
  if (op == CAG_OP_INTERSECTION && a.type == CAG_BOOL) return "write `and`";
  if (op == CAG_OP_ADD && is_body(a) && is_body(b)) return "the union is a | b";
  if (op == CAG_OP_MULTIPLY && is_body(a) && is_body(b)) return "the intersection is a & b";
  if (b.type == CAG_TRANSFORM && cag_is_shape(a)) return "the transform comes first: T * shape";
  return NULL;
}

// Computes T * v. A curve by a formula is evaluated for this.
static bool moved(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result) {
  CagValue *top = raise_top(vm);
  bool ok = vm->differentiation ? cag_jet_transform(vm, t, v, result)
                                : cag_transform_apply(vm, t, v, result);
  vm->top = top;
  if (!ok || vm->failed) return false;
  cag_origin_note_operator(vm, *result, &v, 1);
  return true;
}

// Operators of the types of values beyond those of the language.
static bool of_type(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result,
                    bool *known) {
  const CagValueType *types[] = {cag_value_type(a), cag_value_type(b)};
  *known = false;
  for (int i = 0; i < 2 && !*known && op <= CAG_OP_DIVIDE; i++) {
    *known = types[i]->arithmetic != NULL;
    if (*known && types[i]->arithmetic(vm, op, a, b, result, known)) return true;
  }
  return false;
}

bool cag_arithmetic(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, CagValue *result) {
  bool known;
  if (op <= CAG_OP_POWER) {
    bool ok = scalars(vm, op, a, b, result, &known);
    if (known) return ok;
    if (is_scalar(a) && is_scalar(b)) return jets(vm, op, a, b, result);
  }
  switch (op) {
  case CAG_OP_ADD:
    if (a.type == CAG_TEXT && b.type == CAG_TEXT) {
      *result = cag_text_joined(vm, CAG_AS_TEXT(a), CAG_AS_TEXT(b));
      return true;
    }
    if (is_list(a) && is_list(b)) return list_sum(vm, op, a, b, result);
    break;
  case CAG_OP_SUBTRACT:
    if (is_list(a) && is_list(b)) return list_sum(vm, op, a, b, result);
    if (are_bodies(vm, a, b)) return solids(vm, op, a, b, result);
    break;
  case CAG_OP_MULTIPLY:
    if (a.type == CAG_TRANSFORM) return moved(vm, &CAG_AS_TRANSFORM(a)->t, b, result);
    if (is_list(a) && is_scalar(b)) return list_scaled(vm, op, a, b, false, result);
    if (is_scalar(a) && is_list(b)) return list_scaled(vm, op, b, a, true, result);
    break;
  case CAG_OP_DIVIDE:
    if (is_list(a) && is_scalar(b)) return list_scaled(vm, op, a, b, false, result);
    break;
  case CAG_OP_UNION:
  case CAG_OP_INTERSECTION:
    if (are_bodies(vm, a, b)) return solids(vm, op, a, b, result);
    break;
  default: break;
  }
  const bool ok = of_type(vm, op, a, b, result, &known);
  return known ? ok : fail_operands(vm, op, a, b, operand_help(op, a, b));
}

bool cag_negate(CagVm *vm, CagValue v, CagValue *result) {
  if (v.type == CAG_NUMBER) *result = cag_number(-v.as.number);
  else if (v.type == CAG_ANGLE) *result = cag_angle(-v.as.number);
  else if (v.type == CAG_JET) return jets(vm, CAG_OP_MULTIPLY, v, cag_number(-1), result);
  else if (is_list(v)) return list_scaled(vm, CAG_OP_MULTIPLY, v, cag_number(-1), false, result);
  else if (cag_value_type(v)->arithmetic)
    return cag_arithmetic(vm, CAG_OP_MULTIPLY, v, cag_number(-1), result);
  else {
    CagString s = {0};
    cag_describe_value(vm, &s, v);
    cag_vm_fail(vm, CAG_ERR_operand,
                "`-` expects a number, an angle, a vector, or an image, found %s", s.bytes);
    cag_string_free(&s);
    return false;
  }
  return true;
}

// --- Comparison ---

static int compare_texts(const CagText *a, const CagText *b) {
  size_t n = a->length < b->length ? a->length : b->length;
  int c = memcmp(a->bytes, b->bytes, n); // bytewise order of UTF-8 equals the order of code points
  return c ? c : (a->length > b->length) - (a->length < b->length);
}

bool cag_compare(CagVm *vm, CagBinaryOp op, CagValue a, CagValue b, bool *result) {
  int c;
  if (a.type == CAG_JET || b.type == CAG_JET) { // by their values
    a = cag_plain(a);
    b = cag_plain(b);
  }
  if (a.type == b.type && is_scalar(a)) {
    c = (a.as.number > b.as.number) - (a.as.number < b.as.number);
  } else if (a.type == CAG_TEXT && b.type == CAG_TEXT) {
    c = compare_texts(CAG_AS_TEXT(a), CAG_AS_TEXT(b));
  } else {
    CagString s = {0};
    cag_describe_value(vm, &s, a);
    cag_string_add(&s, " with ", 6);
    cag_describe_value(vm, &s, b);
    cag_vm_fail(vm, CAG_ERR_not_comparable, "`%s` cannot compare %s", symbol(op), s.bytes);
    cag_string_free(&s);
    if (is_scalar(a) && is_scalar(b)) {
      char n[32];
      cag_number_text(a.type == CAG_NUMBER ? a.as.number : b.as.number, n);
      cag_fail_help(vm, "write %sdeg or %srad", n, n);
    }
    return false;
  }
  switch (op) {
  case CAG_OP_LESS: *result = c < 0; break;
  case CAG_OP_LESS_EQUAL: *result = c <= 0; break;
  case CAG_OP_GREATER: *result = c > 0; break;
  default: *result = c >= 0; break;
  }
  return true;
}

static bool in_range(const CagRange *r, double x) {
  double low = r->start, high = r->end;
  if (r->stepped && r->step < 0) { // a descending range contains the same numbers
    low = r->end;
    high = r->start;
    return r->open ? x > low && x <= high : x >= low && x <= high;
  }
  return x >= low && (r->open ? x < high : x <= high);
}

bool cag_contains(CagVm *vm, CagValue needle, CagValue haystack, bool *result) {
  needle = cag_plain(needle);
  switch (haystack.type) {
  case CAG_RANGE: {
    const CagRange *r = CAG_AS_RANGE(haystack);
    if (!is_scalar(needle) || r->angle != (needle.type == CAG_ANGLE)) {
      if (is_scalar(needle))
        return fail_operands(vm, CAG_OP_IN, needle, haystack,
                             "both sides must be numbers, or both angles");
      *result = false;
      return true;
    }
    *result = in_range(r, needle.as.number);
    return true;
  }
  case CAG_LIST: {
    const CagList *l = CAG_AS_LIST(haystack);
    *result = false;
    for (size_t i = 0; i < l->length && !*result; i++) {
      if (l->dim == 1) *result = needle.type == CAG_NUMBER && l->as.numbers[i] == needle.as.number;
      else if (l->dim == 0) *result = cag_equal(vm, needle, l->as.items[i]);
      else {
        const double *x;
        size_t n;
        *result = cag_as_vector(needle, &x, &n) && n == l->dim;
        for (size_t k = 0; *result && k < n; k++) *result = x[k] == l->as.numbers[i * l->dim + k];
      }
    }
    return !vm->failed;
  }
  case CAG_RECORD:
    if (needle.type != CAG_TEXT) break;
    *result =
        cag_record_get_text(vm, CAG_AS_RECORD(haystack), CAG_AS_TEXT(needle)).type != CAG_UNSET;
    return true;
  case CAG_TEXT: {
    if (needle.type != CAG_TEXT) break;
    const CagText *t = CAG_AS_TEXT(needle), *h = CAG_AS_TEXT(haystack);
    *result = t->length == 0 || memmem(h->bytes, h->length, t->bytes, t->length) != NULL;
    return true;
  }
  default: break;
  }
  return fail_operands(
      vm, CAG_OP_IN, needle, haystack,
      "`in` searches a list or range for an element, a record for a field, or a text for a part");
}

// --- Ranges ---

// Reports a range from a number to an angle or vice versa. The help converts the number to degrees.
static bool fail_mixed_range(CagVm *vm, CagValue low, CagValue high) {
  char a[32], b[32];
  cag_number_text(low.as.number, a);
  cag_number_text(high.as.number, b);
  const char *a_unit = low.type == CAG_ANGLE ? "deg" : "";
  const char *b_unit = high.type == CAG_ANGLE ? "deg" : "";
  cag_vm_fail(vm, CAG_ERR_type, "a range needs two numbers or two angles, found %s%s and %s%s", a,
              a_unit, b, b_unit);
  return cag_fail_help(vm, "write %sdeg..%sdeg", a, b);
}

bool cag_make_range(CagVm *vm, CagValue low, CagValue high, CagValue step, bool open,
                    CagValue *result) {
  bool angle = low.type == CAG_ANGLE;
  CagType type = angle ? CAG_ANGLE : CAG_NUMBER;
  const CagValue parts[] = {low, high, step};
  for (int i = 0; i < (step.type == CAG_UNSET ? 2 : 3); i++) {
    if (parts[i].type == type) continue;
    if (parts[i].type == CAG_JET)
      return cag_vm_fail(vm, CAG_ERR_not_differentiable, "a range cannot be differentiated");
    if (i == 1 && is_scalar(parts[i])) return fail_mixed_range(vm, parts[0], parts[1]);
    CagString s = {0};
    cag_describe_value(vm, &s, parts[i]);
    if (i == 0 || !is_scalar(parts[i]))
      cag_vm_fail(vm, CAG_ERR_type, "a range needs numbers or angles, found %s", s.bytes);
    else
      cag_vm_fail(vm, CAG_ERR_type, "the step of a range of %s, found %s",
                  angle ? "angles must be an angle" : "numbers must be a number", s.bytes);
    cag_string_free(&s);
    return false;
  }
  double by = step.type == CAG_UNSET ? 1 : step.as.number;
  if (by == 0 || !isfinite(by))
    return cag_vm_fail(vm, CAG_ERR_value,
                       "the step of a range must be a finite number other than 0");
  *result =
      cag_range_new(vm, low.as.number, high.as.number, by, angle, open, step.type != CAG_UNSET);
  return true;
}

// --- Indices ---

static bool fail_index(CagVm *vm, double at, size_t n, const char *what) {
  char text[32];
  cag_number_text(at, text);
  if (at != rint(at))
    return cag_vm_fail(vm, CAG_ERR_index, "expected an integer as the index, found %s", text);
  cag_vm_fail(vm, CAG_ERR_index, "index %s lies outside of %s %s of %zu", text, cag_article(what),
              what, n);
  if (n) cag_fail_help(vm, "0 to %zu, or -%zu to -1", n - 1, n);
  return false;
}

// Resolves an index, which may count from the end.
static bool resolve(CagVm *vm, double at, size_t n, const char *what, size_t *out) {
  double k = at < 0 ? at + (double)n : at;
  if (!(k >= 0 && k < (double)n && at == rint(at))) return fail_index(vm, at, n, what);
  *out = (size_t)k;
  return true;
}

// Returns the half-open part of n elements that a range of indices selects. The upper end is
// included unless the range is open. Negative indices count from the end.
static bool resolve_part(CagVm *vm, const CagRange *r, size_t n, const char *what, size_t *from,
                         size_t *count) {
  if (r->angle)
    return cag_vm_fail(vm, CAG_ERR_index, "expected integers as indices, found a range of angles");
  if (r->start != rint(r->start) || (r->end != rint(r->end)))
    return cag_vm_fail(vm, CAG_ERR_index, "expected integers as indices");
  double a = r->start < 0 ? r->start + (double)n : r->start;
  double b = isinf(r->end) && r->end > 0
                 ? (double)n
                 : (r->end < 0 ? r->end + (double)n : r->end) + (r->open ? 0 : 1);
  if (a < 0 || a > (double)n) return fail_index(vm, r->start, n, what);
  if (b > (double)n || b < 0) return fail_index(vm, r->end, n, what);
  *from = (size_t)a;
  *count = b > a ? (size_t)(b - a) : 0;
  return true;
}

static size_t byte_of_character(const CagText *t, size_t k) {
  if (t->characters == t->length) return k;
  size_t i = 0;
  for (; k; k--) i = cag_utf8_next(t->bytes, t->length, i);
  return i;
}

// "abcdef"[0..4 by 2]: collects single characters.
static bool text_steps(CagVm *vm, const CagText *t, const CagRange *r, CagValue *result) {
  CagString s = {0};
  size_t n, k;
  bool ok = cag_range_count(vm, r, &n);
  for (size_t i = 0; ok && i < n; i++) {
    ok = resolve(vm, cag_range_element(r, i, n), t->characters, "text", &k);
    if (!ok) break;
    const size_t a = byte_of_character(t, k), b = byte_of_character(t, k + 1);
    cag_string_add(&s, t->bytes + a, b - a);
  }
  if (ok) *result = cag_text_from_string(vm, &s);
  else cag_string_free(&s);
  return ok;
}

static bool index_text(CagVm *vm, const CagText *t, CagValue index, CagValue *result) {
  size_t from, count = 1;
  if (index.type == CAG_RANGE) {
    const CagRange *r = CAG_AS_RANGE(index);
    if (r->stepped && r->step != 1) return text_steps(vm, t, r, result);
    if (!resolve_part(vm, CAG_AS_RANGE(index), t->characters, "text", &from, &count)) return false;
  } else if (!resolve(vm, index.as.number, t->characters, "text", &from)) {
    return false;
  }
  size_t a = byte_of_character(t, from), b = byte_of_character(t, from + count);
  *result = cag_text_new(vm, t->bytes + a, b - a);
  return true;
}

// xs[0..10 by 2]: collects single elements.
static bool index_steps(CagVm *vm, CagValue list, const CagRange *r, CagValue *result) {
  const CagList *l = CAG_AS_LIST(list);
  size_t n;
  if (!cag_range_count(vm, r, &n)) return false;
  CagBuilder *b = cag_builder_new(vm);
  for (size_t i = 0; i < n; i++) {
    size_t k;
    if (!resolve(vm, cag_range_element(r, i, n), l->length, "list", &k) ||
        !cag_builder_add(vm, b, cag_list_get(vm, l, k)))
      return false;
  }
  *result = cag_builder_finish(vm, b);
  return true;
}

static bool index_list(CagVm *vm, CagValue list, CagValue index, CagValue *result) {
  const CagList *l = CAG_AS_LIST(list);
  size_t from, count;
  if (index.type == CAG_RANGE) {
    const CagRange *r = CAG_AS_RANGE(index);
    if (r->stepped && r->step != 1) return index_steps(vm, list, r, result);
    if (!resolve_part(vm, r, l->length, "list", &from, &count)) return false;
    *result = cag_list_slice(vm, list, from, count);
    return true;
  }
  if (!resolve(vm, index.as.number, l->length, "list", &from)) return false;
  *result = cag_list_get(vm, l, from);
  return true;
}

static bool fail_field(CagVm *vm, CagValue object, const char *name);

bool cag_index(CagVm *vm, CagValue object, CagValue index, CagValue *result) {
  if (object.type == CAG_RECORD && index.type == CAG_TEXT) {
    *result = cag_record_get_text(vm, CAG_AS_RECORD(object), CAG_AS_TEXT(index));
    if (result->type != CAG_UNSET) return true;
    return fail_field(vm, object, CAG_AS_TEXT(index)->bytes);
  }
  bool listed = object.type == CAG_LIST || object.type == CAG_RANGE || object.type == CAG_TEXT;
  if (listed && index.type == CAG_JET)
    return cag_vm_fail(vm, CAG_ERR_not_differentiable, "an index cannot be differentiated");
  if (!listed || (index.type != CAG_NUMBER && index.type != CAG_RANGE)) {
    CagString s = {0};
    cag_describe_value(vm, &s, listed || object.type == CAG_RECORD ? index : object);
    if (object.type == CAG_RECORD)
      cag_vm_fail(vm, CAG_ERR_type, "expected a text as the name of a field, found %s", s.bytes);
    else if (listed)
      cag_vm_fail(vm, CAG_ERR_type, "expected a number or a range as the index, found %s", s.bytes);
    else
      cag_vm_fail(vm, CAG_ERR_type,
                  "only lists, ranges, texts, and records have elements, found %s", s.bytes);
    cag_string_free(&s);
    return false;
  }
  if (object.type == CAG_TEXT) return index_text(vm, CAG_AS_TEXT(object), index, result);
  if (object.type == CAG_RANGE && index.type == CAG_NUMBER) { // one element, without making the
                                                              // list
    const CagRange *r = CAG_AS_RANGE(object);
    size_t n, k;
    if (isinf(r->end) && index.as.number >= 0 && index.as.number == rint(index.as.number)) {
      double x = r->start + index.as.number * r->step;
      *result = r->angle ? cag_angle(x) : cag_number(x);
      return true;
    }
    if (!cag_range_count(vm, r, &n) || !resolve(vm, index.as.number, n, "range", &k)) return false;
    double x = cag_range_element(r, k, n);
    *result = r->angle ? cag_angle(x) : cag_number(x);
    return true;
  }
  CagValue list;
  if (!cag_as_list(vm, object, &list)) return false;
  return index_list(vm, list, index, result);
}

// --- Members ---

// The maximum number of names that are searched for a suggestion, and that are listed.
enum { NAMES_MOST = 256, NAMES_LISTED = 12 };

static bool fail_field(CagVm *vm, CagValue object, const char *name) {
  const CagValueType *type = cag_value_type(object);
  const bool is_record = object.type == CAG_RECORD, is_module = object.type == CAG_MODULE;
  const char *names[NAMES_MOST];
  size_t n = 0;
  while (type->member_name && n < NAMES_MOST && (names[n] = type->member_name(vm, object, n))) n++;
  if (is_record) cag_vm_fail(vm, CAG_ERR_field, "the record has no field `%s`", name);
  else if (is_module)
    cag_vm_fail(vm, CAG_ERR_field, "the module %s has no `%s`",
                vm->modules[CAG_AS_MODULE(object)->module]->name, name);
  else cag_vm_fail(vm, CAG_ERR_field, "%s has no member `%s`", cag_type_article(object), name);
  const char *nearest = n ? cag_nearest_name(name, names, n) : NULL;
  const bool other = !is_record && !is_module;
  if (other && cag_foreign_member(name)) cag_fail_help(vm, "write %s", cag_foreign_member(name));
  else if (other && cag_builtin_find(name) != (size_t)-1)
    cag_fail_help(vm, "a function comes after |>: write x |> %s(...)", name);
  else if (nearest) cag_fail_help(vm, "did you mean `%s`?", nearest);
  else if (n && n <= NAMES_LISTED && !is_module) {
    CagString s = {0};
    for (size_t i = 0; i < n; i++) cag_string_printf(&s, "%s%s", i ? ", " : "", names[i]);
    cag_fail_help(vm, is_record ? "its fields are %s" : "it has %s", s.bytes);
    cag_string_free(&s);
  }
  return false;
}

bool cag_member(CagVm *vm, CagValue object, CagValue name_value, CagValue *result) {
  const CagText *text = CAG_AS_TEXT(name_value);
  const CagValueType *type = cag_value_type(object);
  if (object.type == CAG_RECORD) { // the most common case
    *result = cag_record_get_text(vm, CAG_AS_RECORD(object), text);
    if (result->type != CAG_UNSET) return true;
  } else if (type->member && type->member(vm, object, text->bytes, result)) {
    return true;
  }
  return !vm->failed && fail_field(vm, object, text->bytes);
}
