// Jets: truncated Taylor expansions in place of numbers and angles, with which functions of a
// script are differentiated exactly (automatic differentiation).
//
// A jet is the expansion of a value in one or two variables about the point where a function is
// evaluated, up to a total order. Its coefficients are graded: part d holds the monomials of degree
// d. For one variable, this is a single coefficient. For two variables, there are d + 1, and
// coefficient j belongs to du^(d - j) dv^j. Factorials are not included: the k-th derivative is k!
// times coefficient k. Coefficients of angles are in degrees.
//
// All recurrences use the Euler operator E, which multiplies part d by d: E f(g) = f'(g) E g holds
// for any number of variables, so one code serves both (Griewank and Walther, Evaluating
// Derivatives, 2008, chapter 13). Part k of a result depends only on the parts below k, and part 0
// is the value computed with plain numbers.
//
// Jets exist only during one evaluation of a function. `level` distinguishes nested evaluations: an
// inner function that uses the parameter of an outer one cannot be differentiated.

#ifndef CAG_INTERP_VM_JET_H
#define CAG_INTERP_VM_JET_H

#include "interp/vm/value.h"

#define CAG_JET_ORDER_1 CAG_MAX_DERIVATIVE // highest order of one variable
#define CAG_JET_ORDER_2 CAG_MAX_PARTIAL    // of two variables
#define CAG_JET_MOST 45                    // coefficients of two variables at their highest order

typedef struct CagJet {
  CagObject head;
  uint8_t variables, order;
  bool angle;
  uint32_t level;
  double c[];
} CagJet;
#define CAG_AS_JET(v) ((CagJet *)(v).as.object)

// The same, not on the heap, for computations.
typedef struct CagSeries {
  int variables, order;
  uint32_t level;
  double c[CAG_JET_MOST];
} CagSeries;

static inline size_t cag_jet_offset(int variables, int part) {
  return variables == 1 ? (size_t)part : (size_t)(part * (part + 1) / 2);
}
static inline size_t cag_jet_count(int variables, int order) {
  return cag_jet_offset(variables, order + 1);
}

// --- Values ---
CagValue cag_jet_value(CagVm *vm, const CagSeries *s, bool angle);
// Variable number `which` (0 or 1) at x, which changes by `rate` per unit of the parameter.
CagValue cag_jet_variable(CagVm *vm, int variables, int order, uint32_t level, int which, double x,
                          double rate, bool angle);
// Replaces a jet by its value, for comparing and printing. Returns numbers and angles unchanged.
static inline CagValue cag_plain(CagValue v) {
  if (v.type != CAG_JET) return v;
  const CagJet *j = CAG_AS_JET(v);
  return j->angle ? cag_angle(j->c[0]) : cag_number(j->c[0]);
}
static inline CagType cag_plain_type(CagValue v) {
  return v.type != CAG_JET ? v.type : CAG_AS_JET(v)->angle ? CAG_ANGLE : CAG_NUMBER;
}
// Tests whether the value is a jet or contains one in a list or record. Deeply nested values are
// not searched.
bool cag_holds_jet(CagValue v);
// Returns the value with plain numbers in place of jets.
CagValue cag_without_jets(CagVm *vm, CagValue v);
// Converts a number, angle, or jet to a series like `like`. Returns false for a jet of another
// evaluation.
bool cag_series_of(CagValue v, const CagSeries *like, CagSeries *out);
static inline CagSeries cag_series_shape(const CagJet *j) {
  CagSeries s = {.variables = j->variables, .order = j->order, .level = j->level};
  return s;
}

// --- Arithmetic. out may be one of the operands. ---
void cag_series_constant(const CagSeries *like, double x, CagSeries *out);
bool cag_series_is_constant(const CagSeries *a);
void cag_series_add(const CagSeries *a, double factor, const CagSeries *b, CagSeries *out);
void cag_series_scale(const CagSeries *a, double factor, CagSeries *out);
void cag_series_multiply(const CagSeries *a, const CagSeries *b, CagSeries *out);
void cag_series_divide(const CagSeries *a, const CagSeries *b, CagSeries *out); // b(0) not 0
// Computes a^r. Returns false if a derivative of that order does not exist (a(0) = 0 and r is not
// an integer).
bool cag_series_power(const CagSeries *a, double r, CagSeries *out);
void cag_series_exp(const CagSeries *a, CagSeries *out);
void cag_series_ln(const CagSeries *a, CagSeries *out); // a(0) > 0
// sin and cos of radians, or sinh and cosh if `hyperbolic`. `sine` and `cosine` are part 0 of the
// results.
void cag_series_sin_cos(const CagSeries *a, bool hyperbolic, double sine, double cosine,
                        CagSeries *s, CagSeries *c);
// tan, or tanh if `hyperbolic`. `tangent` is part 0.
void cag_series_tan(const CagSeries *a, bool hyperbolic, double tangent, CagSeries *out);
// The function with f(a(0)) = value and f'(a) = slope, from E out = slope E a.
void cag_series_integrate(const CagSeries *a, const CagSeries *slope, double value, CagSeries *out);
// A function of one variable applied to x, given its derivatives at x(0): the sum of derivative k /
// k! times (x - x(0))^k.
void cag_series_compose(const CagSeries *x, const double *derivatives, size_t stride,
                        CagSeries *out);
// The same for a function of two variables. `partials` is a square with side order + 1.
void cag_series_compose_2(const CagSeries *x, const CagSeries *y, const double *partials,
                          size_t stride, CagSeries *out);

// --- Operators (operators.c) ---
// One of a and b is a jet, the other a number, angle, or jet. `value` is the result for plain
// numbers.
bool cag_jet_arithmetic(CagVm *vm, int op, CagValue a, CagValue b, CagValue value,
                        CagValue *result);
// Sets the error for an inner function that uses the parameter of an outer one.
bool cag_fail_jet_level(CagVm *vm);

#endif
