// Jets: truncated Taylor expansions that stand wherever a number or an angle does, so that the
// functions of a script are differentiated exactly.
//
// A jet is the expansion of a value in one or two variables about the point where a function is
// evaluated, up to a total order. Its coefficients are graded: part d holds the monomials of degree
// d, of one variable one coefficient, of two variables d + 1, coefficient j being that of
// du^(d - j) dv^j. Factorials are not multiplied in: the k-th derivative is k! times coefficient k.
// An angle's coefficients are degrees.
//
// All recurrences rest on the Euler operator E, which multiplies part d by d: E f(g) = f'(g) E g
// holds in any number of variables, so one code serves both (Griewank and Walther, Evaluating
// Derivatives, 2008, chapter 13). Part k of a result needs the parts below k only, and part 0 is
// the value as plain numbers give it.
//
// Jets live during one evaluation of a function and never leave it. `level` tells nested
// evaluations apart: a function inside that uses the parameter of the one around it cannot be
// differentiated.

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

// The same off the heap, for computing.
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
// The variable number `which` (0, 1) at x, which changes by `rate` per unit of the parameter.
CagValue cag_jet_variable(CagVm *vm, int variables, int order, uint32_t level, int which, double x,
                          double rate, bool angle);
// Number and angle stay, a jet becomes its value: what is compared and printed.
static inline CagValue cag_plain(CagValue v) {
  if (v.type != CAG_JET) return v;
  const CagJet *j = CAG_AS_JET(v);
  return j->angle ? cag_angle(j->c[0]) : cag_number(j->c[0]);
}
static inline CagType cag_plain_type(CagValue v) {
  return v.type != CAG_JET ? v.type : CAG_AS_JET(v)->angle ? CAG_ANGLE : CAG_NUMBER;
}
// Whether a jet is within the value: itself, in a list, in a record. Ends where values nest deep.
bool cag_holds_jet(CagValue v);
// The same value with plain numbers in the place of jets.
CagValue cag_without_jets(CagVm *vm, CagValue v);
// A number, angle or jet as a series like `like`. A jet of another evaluation: false.
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
// a^r. False: there is no derivative of that order (a(0) = 0 and r no whole number).
bool cag_series_power(const CagSeries *a, double r, CagSeries *out);
void cag_series_exp(const CagSeries *a, CagSeries *out);
void cag_series_ln(const CagSeries *a, CagSeries *out); // a(0) > 0
// sin and cos of radians, or sinh and cosh where `hyperbolic`; part 0 of the results is given.
void cag_series_sin_cos(const CagSeries *a, bool hyperbolic, double sine, double cosine,
                        CagSeries *s, CagSeries *c);
// tan, or tanh where `hyperbolic`; part 0 is given.
void cag_series_tan(const CagSeries *a, bool hyperbolic, double tangent, CagSeries *out);
// The function with f(a(0)) = value and f'(a) = slope: E out = slope E a.
void cag_series_integrate(const CagSeries *a, const CagSeries *slope, double value, CagSeries *out);
// Sum of derivative k / k! times (x - x(0))^k: a function of one variable whose derivatives at x(0)
// are given, of x.
void cag_series_compose(const CagSeries *x, const double *derivatives, size_t stride,
                        CagSeries *out);
// The same of a function of two, with its partials in a square of side order + 1.
void cag_series_compose_2(const CagSeries *x, const CagSeries *y, const double *partials,
                          size_t stride, CagSeries *out);

// --- What the operators do (operators.c): one of a and b is a jet, the other a number, an angle or
// a jet, and `value` is what plain numbers give. ---
bool cag_jet_arithmetic(CagVm *vm, int op, CagValue a, CagValue b, CagValue value,
                        CagValue *result);
// Error: the parameter of a function around is used in one inside.
bool cag_fail_jet_level(CagVm *vm);

#endif
