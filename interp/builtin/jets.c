// Built-ins on jets: their derivatives.
//
// A function here computes its value as the plain built-in does, which also finds the errors of
// plain numbers, and then the parts above the value by the recurrences of jet.h. Names that are not
// in the table have no derivative: the readers of arguments say so.

#include "interp/vm/jet_builtins.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/vm/jet.h"
#include "interp/vm/vm.h"

#define DEGREES_PER_RADIAN 57.29577951308232

// Arguments of a call of a function in the table.
#define ARGUMENTS_MOST 16

static bool fail_at(CagCall *call, int argument) {
  char where[120];
  cag_fail_call(call, argument, CAG_ERR_not_differentiable,
                "cannot be differentiated at %s: it has no derivative there",
                cag_value_words(call->vm, call->values[argument], where, sizeof where));
  return false;
}

// --- Reading ---

// Deeper values hold no coordinates.
#define DEPTH_MOST 100

// The shape of the jets among the arguments.
static bool find_shape(CagValue v, CagSeries *like, int depth) {
  if (v.type == CAG_JET) {
    *like = cag_series_shape(CAG_AS_JET(v));
    return true;
  }
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->dim != 0 || depth > DEPTH_MOST) return false;
  const CagList *l = CAG_AS_LIST(v);
  for (size_t i = 0; i < l->length; i++)
    if (find_shape(l->as.items[i], like, depth + 1)) return true;
  return false;
}

// Without a jet, constants of order 0.
static void shape_of_call(const CagCall *call, CagSeries *like) {
  like->variables = 1;
  like->order = 0;
  like->level = call->vm->differentiation;
  for (size_t i = 0; i < call->count; i++)
    if (find_shape(call->values[i], like, 0)) return;
}

static bool read_series(CagCall *call, CagValue v, const CagSeries *like, CagSeries *out) {
  return cag_series_of(v, like, out) || cag_fail_jet_level(call->vm);
}

// What the built-in gives for plain numbers.
static bool plain_result(CagCall *call, CagValue *value) {
  CagValue plain[ARGUMENTS_MOST], *values = plain;
  if (call->count > ARGUMENTS_MOST) values = cag_hold_array(call, call->count, sizeof *values);
  for (size_t i = 0; i < call->count; i++) values[i] = cag_without_jets(call->vm, call->values[i]);
  CagCall with = {call->vm, call->builtin, values, call->count, call->err};
  return call->builtin->function(&with, value);
}

static CagValue jet_of_series(CagVm *vm, CagSeries *s, CagValue value) {
  s->c[0] = value.as.number;
  return cag_jet_value(vm, s, value.type == CAG_ANGLE);
}

// --- Functions of one number or angle ---

// `x` in radians for angles; part 0 of out need not be set; an angle is given in radians.
typedef bool (*Unary)(const CagSeries *x, double degrees, double value, CagSeries *out);

static bool unary(CagCall *call, Unary f, CagValue *result) {
  CagValue value;
  CagSeries x, out;
  if (!plain_result(call, &value)) return false;
  const CagJet *j = CAG_AS_JET(call->values[0]);
  if (call->values[0].type != CAG_JET) return fail_at(call, 0);
  CagSeries like = cag_series_shape(j);
  cag_series_of(call->values[0], &like, &x);
  if (j->angle) cag_series_scale(&x, CAG_RADIANS_PER_DEGREE, &x);
  if (!f(&x, j->c[0], value.as.number, &out)) return fail_at(call, 0);
  if (value.type == CAG_ANGLE) cag_series_scale(&out, DEGREES_PER_RADIAN, &out);
  *result = jet_of_series(call->vm, &out, value);
  return true;
}

static bool of_sin(const CagSeries *x, double degrees, double value, CagSeries *out) {
  double s, c;
  CagSeries other;
  (void)value;
  cag_sincos_degrees(degrees, &s, &c);
  cag_series_sin_cos(x, false, s, c, out, &other);
  return true;
}
static bool of_cos(const CagSeries *x, double degrees, double value, CagSeries *out) {
  double s, c;
  CagSeries other;
  (void)value;
  cag_sincos_degrees(degrees, &s, &c);
  cag_series_sin_cos(x, false, s, c, &other, out);
  return true;
}
static bool of_tan(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  cag_series_tan(x, false, value, out);
  return true;
}
static bool of_sinh(const CagSeries *x, double degrees, double value, CagSeries *out) {
  CagSeries other;
  (void)degrees;
  cag_series_sin_cos(x, true, value, cosh(x->c[0]), out, &other);
  return true;
}
static bool of_cosh(const CagSeries *x, double degrees, double value, CagSeries *out) {
  CagSeries other;
  (void)degrees;
  cag_series_sin_cos(x, true, sinh(x->c[0]), value, &other, out);
  return true;
}
static bool of_tanh(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  cag_series_tan(x, true, value, out);
  return true;
}
static bool of_exp(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  cag_series_exp(x, out);
  return true;
}
static bool of_ln(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  cag_series_ln(x, out);
  return true;
}
static bool of_log10(const CagSeries *x, double degrees, double value, CagSeries *out) {
  of_ln(x, degrees, value, out);
  cag_series_scale(out, 1 / log(10), out);
  return true;
}
static bool of_log2(const CagSeries *x, double degrees, double value, CagSeries *out) {
  of_ln(x, degrees, value, out);
  cag_series_scale(out, 1 / log(2), out);
  return true;
}
static bool of_sqrt(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  return cag_series_power(x, 0.5, out);
}
static bool of_cbrt(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  const double sign = x->c[0] < 0 ? -1 : 1;
  CagSeries positive;
  cag_series_scale(x, sign, &positive);
  if (!cag_series_power(&positive, 1.0 / 3, out)) return false;
  cag_series_scale(out, sign, out);
  return true;
}
static bool of_abs(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  if (x->c[0] == 0 && !cag_series_is_constant(x)) return false;
  cag_series_scale(x, x->c[0] < 0 ? -1 : 1, out);
  return true;
}

// value + integral of (a + b x^2)^r, the form of all inverse functions.
static bool inverse(const CagSeries *x, double a, double b, double r, double sign, CagSeries *out) {
  CagSeries square, slope;
  cag_series_multiply(x, x, &square);
  cag_series_scale(&square, b, &square);
  square.c[0] += a;
  // Near the ends a - x^2 loses what the product keeps.
  if (a == 1 && b == -1) square.c[0] = (1 - x->c[0]) * (1 + x->c[0]);
  if (a == -1 && b == 1) square.c[0] = (x->c[0] - 1) * (x->c[0] + 1);
  if (square.c[0] == 0 || !cag_series_power(&square, r, &slope)) return false;
  cag_series_scale(&slope, sign, &slope);
  cag_series_integrate(x, &slope, 0, out);
  return true;
}
static bool of_asin(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  return inverse(x, 1, -1, -0.5, 1, out);
}
static bool of_acos(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  return inverse(x, 1, -1, -0.5, -1, out);
}
static bool of_atan(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  return inverse(x, 1, 1, -1, 1, out);
}
static bool of_asinh(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  return inverse(x, 1, 1, -0.5, 1, out);
}
static bool of_acosh(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  return inverse(x, -1, 1, -0.5, 1, out);
}
static bool of_atanh(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  return inverse(x, 1, -1, -1, 1, out);
}
// In radians both ways: the value is set afterwards.
static bool of_in_radians(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  *out = *x;
  return true;
}
static bool of_in_degrees(const CagSeries *x, double degrees, double value, CagSeries *out) {
  (void)degrees;
  (void)value;
  cag_series_scale(x, DEGREES_PER_RADIAN, out);
  return true;
}

// clang-format off
#define UNARY(X) \
  X(abs) X(sqrt) X(cbrt) X(exp) X(ln) X(log10) X(log2) X(sinh) X(cosh) X(tanh) X(asinh) X(acosh) \
  X(atanh) X(sin) X(cos) X(tan) X(asin) X(acos) X(atan) X(in_degrees) X(in_radians)
// clang-format on

// abs of an angle: the jet is read in radians, and given so.
#define X(name)                                                                                    \
  static bool jet_##name(CagCall *call, CagValue *result) { return unary(call, of_##name, result); }
UNARY(X)
#undef X

// --- Functions of several numbers ---

static bool jet_atan2(CagCall *call, CagValue *result) {
  CagValue value;
  CagSeries like, y, x, out;
  if (!plain_result(call, &value)) return false;
  shape_of_call(call, &like);
  if (!read_series(call, call->values[0], &like, &y) ||
      !read_series(call, call->values[1], &like, &x))
    return false;
  if (x.c[0] == 0 && y.c[0] == 0) return fail_at(call, 0);
  // The angle differs from atan(y / x), or from -atan(x / y), by a constant.
  const bool steep = fabs(y.c[0]) > fabs(x.c[0]);
  CagSeries q;
  if (steep) cag_series_divide(&x, &y, &q);
  else cag_series_divide(&y, &x, &q);
  inverse(&q, 1, 1, -1, steep ? -1 : 1, &out);
  cag_series_scale(&out, DEGREES_PER_RADIAN, &out);
  *result = jet_of_series(call->vm, &out, value);
  return true;
}

// Root of the sum of squares; false where it is 0 and not constant. Scaled against overflow.
static bool root_of_squares(const CagSeries *x, size_t n, double value, CagSeries *out) {
  const CagSeries *like = &x[0];
  CagSeries sum, square;
  cag_series_constant(like, 0, &sum);
  const double scale = value > 0 && isfinite(value) ? value : 1;
  bool constant = true;
  for (size_t i = 0; i < n; i++) {
    CagSeries y;
    constant = constant && cag_series_is_constant(&x[i]);
    cag_series_scale(&x[i], 1 / scale, &y);
    cag_series_multiply(&y, &y, &square);
    cag_series_add(&sum, 1, &square, &sum);
  }
  if (constant) {
    cag_series_constant(like, value, out);
    return true;
  }
  if (value == 0 || !cag_series_power(&sum, 0.5, out)) return false;
  cag_series_scale(out, scale, out);
  out->c[0] = value;
  return true;
}

static bool jet_hypot(CagCall *call, CagValue *result) {
  CagValue value;
  CagSeries like, x[ARGUMENTS_MOST], out;
  if (!plain_result(call, &value)) return false;
  if (call->count > ARGUMENTS_MOST) return cag_fail_differentiate(call, 0);
  shape_of_call(call, &like);
  for (size_t i = 0; i < call->count; i++)
    if (!read_series(call, call->values[i], &like, &x[i])) return false;
  if (!root_of_squares(x, call->count, value.as.number, &out)) return fail_at(call, 0);
  *result = jet_of_series(call->vm, &out, value);
  return true;
}

static bool same_series(const CagSeries *a, const CagSeries *b) {
  for (size_t i = 1; i < cag_jet_count(a->variables, a->order); i++)
    if (a->c[i] != b->c[i]) return false;
  return true;
}

// The argument or element that is the least or greatest. Two of them that differ in their
// derivatives make a corner.
static bool jet_extreme(CagCall *call, CagValue *result) {
  CagValue value;
  CagSeries like, x, found = {0};
  CagSequence s;
  if (!plain_result(call, &value)) return false;
  shape_of_call(call, &like);
  bool of_list = call->count == 1 && call->values[0].type == CAG_LIST, any = false;
  if (of_list && !cag_sequence_open(call, 0, false, &s)) return false;
  size_t n = of_list ? s.length : call->count;
  for (size_t i = 0; i < n; i++) {
    CagValue v = of_list ? cag_sequence_element(call->vm, &s, i) : call->values[i];
    if (cag_plain(v).as.number != value.as.number) continue;
    if (!read_series(call, v, &like, &x)) return false;
    if (any && !same_series(&x, &found)) return fail_at(call, of_list ? 0 : (int)i);
    found = x;
    any = true;
  }
  *result = jet_of_series(call->vm, &found, value);
  return true;
}

static bool jet_clamp(CagCall *call, CagValue *result) {
  CagValue value;
  if (!plain_result(call, &value)) return false;
  const CagRange *r = CAG_AS_RANGE(call->values[1]);
  double x = cag_plain(call->values[0]).as.number;
  if (x == r->start || x == r->end) return fail_at(call, 0);
  *result = x > r->start && x < r->end ? call->values[0] : value;
  return true;
}

// Operators as the script has them, for what is a short formula.
static bool op(CagCall *call, CagBinaryOp o, CagValue a, CagValue b, CagValue *out) {
  return cag_arithmetic(call->vm, o, a, b, out);
}

// a + t (b - a), of numbers, angles, vectors and lists of these.
static bool mix(CagCall *call, CagValue a, CagValue b, CagValue t, CagValue *result) {
  CagValue way, part;
  return op(call, CAG_OP_SUBTRACT, b, a, &way) && op(call, CAG_OP_MULTIPLY, way, t, &part) &&
         op(call, CAG_OP_ADD, a, part, result);
}

static bool jet_mix(CagCall *call, CagValue *result) {
  CagType t = cag_plain_type(call->values[2]);
  if (t != CAG_NUMBER) return cag_fail_type(call, 2, "a number");
  return mix(call, call->values[0], call->values[1], call->values[2], result);
}

static bool jet_along(CagCall *call, CagValue *result) {
  CagSequence s;
  CagValue t = call->values[1];
  if (!cag_sequence_open(call, 0, false, &s)) return false;
  if (cag_plain_type(t) != CAG_NUMBER) return cag_fail_type(call, 1, "a number");
  if (s.length == 0) return cag_fail_value(call, 0, "at least one element");
  const double x = cag_plain(t).as.number, steps = (double)(s.length - 1);
  if (!(x >= 0 && x <= 1)) return cag_fail_value(call, 1, "a number in 0..1");
  const double place = x * steps;
  size_t i = (size_t)place;
  // The elements are corners, but for the ends.
  if (t.type == CAG_JET && place == (double)i && i > 0 && i + 1 < s.length) return fail_at(call, 1);
  if (i + 1 >= s.length && i > 0) i--;
  *result = cag_sequence_element(call->vm, &s, i);
  if (i + 1 >= s.length) return true;
  CagValue scaled, share;
  return op(call, CAG_OP_MULTIPLY, t, cag_number(steps), &scaled) &&
         op(call, CAG_OP_SUBTRACT, scaled, cag_number((double)i), &share) &&
         mix(call, *result, cag_sequence_element(call->vm, &s, i + 1), share, result);
}

static bool fold(CagCall *call, CagBinaryOp o, CagValue *result) {
  CagSequence s;
  if (!cag_sequence_open(call, 0, false, &s)) return false;
  for (size_t i = 0; i < s.length; i++) {
    CagValue v = cag_sequence_element(call->vm, &s, i);
    CagType type = cag_plain_type(v);
    bool good = type == CAG_NUMBER || (o == CAG_OP_ADD && (type == CAG_ANGLE || type == CAG_LIST));
    if (!good) { // not as an element that holds jets: its type is wrong
      char found[120];
      return cag_fail_call(call, 0, CAG_ERR_type, "expects %s, found %s at xs[%zu]",
                           o == CAG_OP_ADD ? "numbers, angles, or vectors" : "numbers",
                           cag_value_words(call->vm, v, found, sizeof found), i);
    }
    if (i == 0) *result = v;
    else if (!op(call, o, *result, v, result)) return false;
  }
  return true;
}
static bool jet_sum(CagCall *call, CagValue *result) { return fold(call, CAG_OP_ADD, result); }
static bool jet_product(CagCall *call, CagValue *result) {
  return fold(call, CAG_OP_MULTIPLY, result);
}

// --- Vectors ---

typedef struct Vector {
  CagValue x[CAG_MAX_PACKED];
  size_t n;
} Vector;

static bool read_vector(CagCall *call, int argument, Vector *out) {
  CagValue v = call->values[argument];
  const CagList *l = v.type == CAG_LIST ? CAG_AS_LIST(v) : NULL;
  bool good = l && l->dim <= 1 && l->length > 0 && l->length <= CAG_MAX_PACKED;
  for (size_t i = 0; good && i < l->length; i++) {
    out->x[i] = cag_list_get(call->vm, l, i);
    good = cag_plain_type(out->x[i]) == CAG_NUMBER;
  }
  if (good) {
    out->n = l->length;
    return true;
  }
  char found[120];
  return cag_fail_call(call, argument, CAG_ERR_type, "expects a vector, found %s",
                       cag_value_words(call->vm, v, found, sizeof found));
}

// Both arguments, the shorter one of plane and space with z = 0.
static bool read_two(CagCall *call, Vector *a, Vector *b) {
  if (!read_vector(call, 0, a) || !read_vector(call, 1, b)) return false;
  if (a->n == 2 && b->n == 3) a->x[a->n++] = cag_number(0);
  if (b->n == 2 && a->n == 3) b->x[b->n++] = cag_number(0);
  return a->n == b->n ||
         cag_fail_call(call, 1, CAG_ERR_length,
                       "expects vectors of the same length, found %zu and %zu numbers", a->n, b->n);
}

static bool jet_dot(CagCall *call, CagValue *result) {
  Vector a, b;
  if (!read_two(call, &a, &b)) return false;
  *result = cag_number(0);
  for (size_t i = 0; i < a.n; i++) {
    CagValue p;
    if (!op(call, CAG_OP_MULTIPLY, a.x[i], b.x[i], &p) || !op(call, CAG_OP_ADD, *result, p, result))
      return false;
  }
  return true;
}

static bool jet_cross(CagCall *call, CagValue *result) {
  Vector a, b;
  CagValue out[3];
  if (!read_two(call, &a, &b)) return false;
  if (a.n == 2) a.x[2] = b.x[2] = cag_number(0);
  else if (a.n != 3) return cag_fail_value(call, 0, "a vector of 2 or 3 numbers");
  for (size_t i = 0; i < 3; i++) {
    size_t j = (i + 1) % 3, k = (i + 2) % 3;
    CagValue p, q;
    if (!op(call, CAG_OP_MULTIPLY, a.x[j], b.x[k], &p) ||
        !op(call, CAG_OP_MULTIPLY, a.x[k], b.x[j], &q) || !op(call, CAG_OP_SUBTRACT, p, q, &out[i]))
      return false;
  }
  *result = cag_list_values(call->vm, out, 3);
  return true;
}

static bool norm_of(CagCall *call, const Vector *v, CagValue *result) {
  CagSeries like, x[CAG_MAX_PACKED], out;
  double value = 0;
  if (v->n == 0) {
    *result = cag_number(0);
    return true;
  }
  shape_of_call(call, &like);
  for (size_t i = 0; i < v->n; i++) {
    if (!read_series(call, v->x[i], &like, &x[i])) return false;
    value = hypot(value, x[i].c[0]);
  }
  if (!root_of_squares(x, v->n, value, &out)) return fail_at(call, 0);
  *result = jet_of_series(call->vm, &out, cag_number(value));
  return true;
}

static bool jet_norm(CagCall *call, CagValue *result) {
  Vector v;
  return read_vector(call, 0, &v) && norm_of(call, &v, result);
}

static bool jet_unit(CagCall *call, CagValue *result) {
  Vector v;
  CagValue norm;
  if (!read_vector(call, 0, &v) || !norm_of(call, &v, &norm)) return false;
  if (cag_plain(norm).as.number == 0)
    return cag_fail_call(call, 0, CAG_ERR_not_finite,
                         "of a zero vector is undefined: it has no direction");
  return op(call, CAG_OP_DIVIDE, call->values[0], norm, result);
}

static bool jet_distance(CagCall *call, CagValue *result) {
  Vector a, b;
  if (call->values[0].type != CAG_LIST || call->values[1].type != CAG_LIST)
    return cag_fail_differentiate(call, call->values[0].type == CAG_LIST ? 0 : 1);
  if (!read_two(call, &a, &b)) return false;
  for (size_t i = 0; i < a.n; i++)
    if (!op(call, CAG_OP_SUBTRACT, a.x[i], b.x[i], &a.x[i])) return false;
  return norm_of(call, &a, result);
}

static bool jet_polar(CagCall *call, CagValue *result) {
  CagValue angle = call->values[1], out[2], center = call->values[2];
  CagSeries like, a, part[2];
  if (cag_plain_type(call->values[0]) != CAG_NUMBER) return cag_fail_type(call, 0, "a number");
  if (cag_plain_type(angle) != CAG_ANGLE) {
    cag_fail_call(call, 1, CAG_ERR_type, "expects an angle as `angle`, found a number");
    return cag_fail_help(call->vm, "write t * 1rad or t * 1deg");
  }
  shape_of_call(call, &like);
  if (!read_series(call, angle, &like, &a)) return false;
  double s, c;
  cag_sincos_degrees(a.c[0], &s, &c);
  cag_series_scale(&a, CAG_RADIANS_PER_DEGREE, &a);
  cag_series_sin_cos(&a, false, s, c, &part[1], &part[0]);
  for (size_t i = 0; i < 2; i++)
    if (!op(call, CAG_OP_MULTIPLY, call->values[0], cag_jet_value(call->vm, &part[i], false),
            &out[i]))
      return false;
  *result = cag_list_values(call->vm, out, 2);
  return center.type == CAG_UNSET || op(call, CAG_OP_ADD, center, *result, result);
}

// An answer that is a step: that of the values.
static bool by_value(CagCall *call, CagValue *result) { return plain_result(call, result); }

// --- Curves and surfaces at a parameter that is a jet ---

typedef struct Point {
  CagSeries x[3];
  size_t n; // coordinates
} Point;

static CagValue point_value(CagVm *vm, const Point *p) {
  CagValue x[3];
  for (size_t i = 0; i < p->n; i++) x[i] = cag_jet_value(vm, &p->x[i], false);
  return cag_list_values(vm, x, p->n);
}

// A parameter as a series in the curve's or surface's own unit. False: of the wrong kind.
static bool parameter_series(CagCall *call, int argument, bool angular, const CagSeries *like,
                             CagSeries *out) {
  CagValue v = call->values[argument];
  if (cag_plain_type(v) != (angular ? CAG_ANGLE : CAG_NUMBER)) {
    char found[120];
    cag_fail_call(call, argument, CAG_ERR_type, "expects %s, found %s",
                  angular ? "an angle" : "a number",
                  cag_value_words(call->vm, cag_plain(v), found, sizeof found));
    return cag_fail_help(call->vm, angular ? "this parameter is an angle: write t * 1rad"
                                           : "this parameter is a number: write in_radians(t)");
  }
  if (!read_series(call, v, like, out)) return false;
  if (angular) cag_series_scale(out, CAG_RADIANS_PER_DEGREE, out);
  return true;
}

// Derivatives 0 .. most of the curve at the jet in argument 1, each a jet itself.
static bool curve_jets(CagCall *call, int most, Point *out) {
  CagCurve *c = CAG_AS_SHAPE(call->values[0])->as.curve;
  CagVec3 d[CAG_MAX_DERIVATIVE + 1];
  CagSeries like, t;
  shape_of_call(call, &like);
  if (!parameter_series(call, 1, c->angular, &like, &t)) return false;
  if (like.order + most > CAG_MAX_DERIVATIVE) return cag_fail_differentiate(call, 0);
  CagSide side = t.c[0] >= c->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  if (!cag_geometry_ok(call, cag_curve_eval(c, t.c[0], like.order + most, side, d, call->err)))
    return false;
  for (int k = 0; k <= most; k++) {
    out[k].n = (size_t)c->dimension;
    cag_series_compose(&t, &d[k].x, 3, &out[k].x[0]);
    cag_series_compose(&t, &d[k].y, 3, &out[k].x[1]);
    cag_series_compose(&t, &d[k].z, 3, &out[k].x[2]);
  }
  return true;
}

static bool surface_jet(CagCall *call, Point *out) {
  CagSurface *s = CAG_AS_SHAPE(call->values[0])->as.surface;
  CagVec3 d[(CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1)];
  CagSeries like, u, v;
  shape_of_call(call, &like);
  if (!parameter_series(call, 1, s->angular_u, &like, &u) ||
      !parameter_series(call, 2, s->angular_v, &like, &v))
    return false;
  if (like.order > CAG_MAX_PARTIAL) return cag_fail_differentiate(call, 0);
  if (!cag_geometry_ok(call, cag_surface_eval(s, u.c[0], v.c[0], like.order, CAG_SIDE_RIGHT,
                                              CAG_SIDE_RIGHT, d, call->err)))
    return false;
  out->n = 3;
  cag_series_compose_2(&u, &v, &d[0].x, 3, &out->x[0]);
  cag_series_compose_2(&u, &v, &d[0].y, 3, &out->x[1]);
  cag_series_compose_2(&u, &v, &d[0].z, 3, &out->x[2]);
  return true;
}

static bool jet_at(CagCall *call, CagValue *result) {
  Point p;
  bool surface = call->values[0].type == CAG_SURFACE;
  size_t unit = surface ? 3 : 2;
  if (!surface && call->values[0].type != CAG_CURVE) return cag_fail_differentiate(call, 0);
  if (unit < call->count && call->values[unit].type == CAG_BOOL && call->values[unit].as.boolean)
    return cag_fail_differentiate(call, (int)unit);
  if (!(surface ? surface_jet(call, &p) : curve_jets(call, 0, &p))) return false;
  *result = point_value(call->vm, &p);
  return true;
}

// Questions to curves, by the formulas of the moving frame.
static bool only_curves(CagCall *call) {
  return call->values[0].type == CAG_CURVE || cag_fail_differentiate(call, 0);
}

static bool jet_derivative(CagCall *call, CagValue *result) {
  Point p[CAG_MAX_DERIVATIVE + 1];
  long order;
  if (!only_curves(call) || !cag_arg_integer_or(call, 2, 1, 0, CAG_MAX_DERIVATIVE, &order) ||
      !curve_jets(call, (int)order, p))
    return false;
  *result = point_value(call->vm, &p[order]);
  return true;
}

static void dot(const Point *a, const Point *b, CagSeries *out) {
  CagSeries product;
  cag_series_multiply(&a->x[0], &b->x[0], out);
  for (size_t i = 1; i < 3; i++) {
    cag_series_multiply(&a->x[i], &b->x[i], &product);
    cag_series_add(out, 1, &product, out);
  }
}

static void cross(const Point *a, const Point *b, Point *out) {
  out->n = 3;
  for (size_t i = 0; i < 3; i++) {
    size_t j = (i + 1) % 3, k = (i + 2) % 3;
    CagSeries p, q;
    cag_series_multiply(&a->x[j], &b->x[k], &p);
    cag_series_multiply(&a->x[k], &b->x[j], &q);
    cag_series_add(&p, -1, &q, &out->x[i]);
  }
}

// v / |v| and |v|. False: the zero vector.
static bool normalize(Point *v, CagSeries *length) {
  double value = hypot(hypot(v->x[0].c[0], v->x[1].c[0]), v->x[2].c[0]);
  if (value == 0 || !root_of_squares(v->x, 3, value, length)) return false;
  for (size_t i = 0; i < 3; i++) cag_series_divide(&v->x[i], length, &v->x[i]);
  return true;
}

// tangent, normal, binormal, and curvature and torsion, as far as `want` goes.
typedef enum Want { TANGENT, NORMAL, BINORMAL, CURVATURE, TORSION } Want;

static bool frenet(CagCall *call, Want want, CagValue *result) {
  Point d[4], normal, binormal;
  CagSeries speed, area;
  if (!only_curves(call) || !curve_jets(call, want == TANGENT ? 1 : want == TORSION ? 3 : 2, d))
    return false;
  size_t n = d[0].n;
  cross(&d[1], &d[2], &binormal); // of plane curves along z
  if (!normalize(&d[1], &speed)) return fail_at(call, 1);
  if (want == TANGENT) {
    *result = point_value(call->vm, &d[1]);
    return true;
  }
  if (!normalize(&binormal, &area)) return fail_at(call, 1);
  if (want == BINORMAL) {
    *result = point_value(call->vm, &binormal);
    return true;
  }
  if (want == NORMAL) {
    cross(&binormal, &d[1], &normal);
    normal.n = n;
    *result = point_value(call->vm, &normal);
    return true;
  }
  CagSeries out;
  if (want == CURVATURE) { // |C' x C''| / |C'|^3
    out = area;
    for (int i = 0; i < 3; i++) cag_series_divide(&out, &speed, &out);
  } else { // (C' x C'') . C''' / |C' x C''|^2
    dot(&binormal, &d[3], &out);
    cag_series_divide(&out, &area, &out);
  }
  *result = cag_jet_value(call->vm, &out, false);
  return true;
}
static bool jet_tangent(CagCall *call, CagValue *result) { return frenet(call, TANGENT, result); }
static bool jet_normal(CagCall *call, CagValue *result) { return frenet(call, NORMAL, result); }
static bool jet_binormal(CagCall *call, CagValue *result) { return frenet(call, BINORMAL, result); }
static bool jet_curvature(CagCall *call, CagValue *result) {
  return frenet(call, CURVATURE, result);
}
static bool jet_torsion(CagCall *call, CagValue *result) { return frenet(call, TORSION, result); }

bool cag_jet_shape_call(CagVm *vm, CagValue shape, const CagValue *arguments, size_t n,
                        CagValue *result) {
  size_t rows, expected = shape.type == CAG_CURVE ? 1 : 2;
  if (shape.type == CAG_SOLID || n != expected)
    return cag_shape_call(vm, shape, arguments, n, result);
  // The call of a shape is `at` by another name.
  size_t index = cag_builtin_find("at");
  const CagBuiltin *row =
      cag_builtin_rows(index, &rows) + cag_builtin_select(index, shape.type, n + 1);
  CagValue values[3] = {shape, arguments[0], n > 1 ? arguments[1] : cag_unset()};
  CagCall call = {vm, row, values, n + 1, &vm->core_error};
  const size_t held = vm->held_count;
  const bool ok = jet_at(&call, result);
  cag_vm_release_held(vm, held);
  return ok;
}

// --- Transforms ---

static bool transform_point(CagVm *vm, const CagTransform *t, const CagList *l, CagValue *result) {
  CagValue x[4] = {cag_number(0), cag_number(0), cag_number(0), cag_number(1)}, out[4];
  size_t n = l->length, rows = n == 2 && !t->planar ? 3 : n;
  for (size_t i = 0; i < n; i++) x[i] = l->as.items[i];
  for (size_t i = 0; i < 4; i++) {
    out[i] = cag_number(0);
    for (size_t j = 0; j < 4; j++) {
      CagValue p;
      if (t->m[i][j] == 0) continue;
      if (!cag_arithmetic(vm, CAG_OP_MULTIPLY, cag_number(t->m[i][j]), x[j], &p) ||
          !cag_arithmetic(vm, CAG_OP_ADD, out[i], p, &out[i]))
        return false;
    }
  }
  const bool divides = n < 4 && !(out[3].type == CAG_NUMBER && out[3].as.number == 1);
  for (size_t i = 0; divides && i < rows; i++)
    if (!cag_arithmetic(vm, CAG_OP_DIVIDE, out[i], out[3], &out[i])) return false;
  *result = cag_list_values(vm, out, rows);
  return true;
}

bool cag_jet_transform(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result) {
  const CagList *l = v.type == CAG_LIST ? CAG_AS_LIST(v) : NULL;
  if (!l || l->dim != 0 || !cag_holds_jet(v)) return cag_transform_apply(vm, t, v, result);
  bool point = l->length >= 2 && l->length <= 4;
  for (size_t i = 0; point && i < l->length; i++)
    point = cag_plain_type(l->as.items[i]) == CAG_NUMBER;
  if (point) return transform_point(vm, t, l, result);
  CagBuilder *b = cag_builder_new(vm);
  for (size_t i = 0; i < l->length; i++) {
    CagValue moved;
    if (l->as.items[i].type == CAG_JET) // no point either: the plain call says what is wrong
      return cag_transform_apply(vm, t, cag_without_jets(vm, v), result);
    if (!cag_jet_transform(vm, t, l->as.items[i], &moved)) return false;
    if (!cag_builder_add(vm, b, moved)) return false;
  }
  *result = cag_builder_finish(vm, b);
  return true;
}

// --- The table ---

static const struct {
  const char *name;
  CagBuiltinFunction function;
} differentiated[] = {
#define X(name) {#name, jet_##name},
    UNARY(X)
#undef X
        {"atan2", jet_atan2},
    {"hypot", jet_hypot},
    {"min", jet_extreme},
    {"max", jet_extreme},
    {"clamp", jet_clamp},
    {"mix", jet_mix},
    {"along", jet_along},
    {"sum", jet_sum},
    {"product", jet_product},
    {"dot", jet_dot},
    {"cross", jet_cross},
    {"norm", jet_norm},
    {"unit", jet_unit},
    {"distance", jet_distance},
    {"polar", jet_polar},
    {"at", jet_at},
    {"derivative", jet_derivative},
    {"tangent", jet_tangent},
    {"normal", jet_normal},
    {"binormal", jet_binormal},
    {"curvature", jet_curvature},
    {"torsion", jet_torsion},
    {"near", by_value},
};
#define COUNT (sizeof differentiated / sizeof *differentiated)

size_t cag_jet_row(const char *name) {
  for (size_t i = 0; i < COUNT; i++)
    if (strcmp(differentiated[i].name, name) == 0) return i + 1;
  return 0;
}

static bool refuse(CagCall *call, CagValue *result) {
  (void)result;
  return cag_fail_differentiate(call, 0);
}

CagBuiltinFunction cag_jet_function(const CagCall *call, size_t index) {
  const size_t row = cag_builtin_jet(index);
  if (!row) {
    // Rows that tell their types read the argument without asking again.
    bool reads = call->count > 0 && call->values[0].type == CAG_JET && call->builtin->first != 0;
    return reads ? refuse : call->builtin->function;
  }
  for (size_t i = 0; i < call->count; i++)
    if (cag_holds_jet(call->values[i])) return differentiated[row - 1].function;
  return call->builtin->function;
}
