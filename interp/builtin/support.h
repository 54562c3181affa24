// What the families of built-ins that are not geometry share: errors about values, reading of
// sequences, order and mixing of values, decimal rounding.

#ifndef CAG_INTERP_SUPPORT_H
#define CAG_INTERP_SUPPORT_H

#include "interp/vm/builtin.h"

// The functions of the rows, made by tools/rows.awk.
#include "builtin_functions.h"

#define CAG_TYPE_BIT(tag) (UINT64_C(1) << CAG_##tag)

// --- Errors ---
// "NAME expects EXPECTED as `PARAMETER`, found FOUND", code E0314: the type is right, the value is
// not.
bool cag_fail_value(CagCall *call, int argument, const char *expected);
// The same as cag_fail_type for an element: "NAME expects EXPECTED in `PARAMETER`, found FOUND at
// [index]".
bool cag_fail_element(CagCall *call, int argument, size_t index, CagValue element,
                      const char *expected);
#define cag_fail_value(...) cag_never_true((cag_fail_value)(__VA_ARGS__))
#define cag_fail_element(...) cag_never_true((cag_fail_element)(__VA_ARGS__))
const char *cag_parameter_name(const CagCall *call, int argument);
// Short text of a value for messages; buffer is given back. Cut with "..." where it does not fit.
const char *cag_value_words(CagVm *vm, CagValue v, char *buffer, size_t size);

// Gives x, or the error E0307 when x is no number or infinite though every argument is finite.
bool cag_give_number(CagCall *call, double x, CagValue *result);
bool cag_give_angle(CagCall *call, double degrees, CagValue *result);

// --- Texts ---
// An empty text to be added to. The machine frees it when the built-in ends.
CagString *cag_held_string(CagCall *call);

// --- Sequences: what is read as a list, element by element, without making a list of a range ---
typedef struct CagSequence {
  CagValue source;
  size_t length;
  const char *next; // of a text: where the next character begins
} CagSequence;
// Takes lists and ranges, and texts where `texts`.
bool cag_sequence_open(CagCall *call, int argument, bool texts, CagSequence *out);
// Element i; of a text the elements are to be asked for in order, from 0.
CagValue cag_sequence_element(CagVm *vm, CagSequence *s, size_t i);
// Bytes of the UTF-8 character that begins at s.
size_t cag_character_size(const char *s);
// Where character k of a text begins.
const char *cag_text_at(const CagText *t, size_t k);

// --- Values ---
// Values nest as deep as a script likes, functions that follow them so deep only: the same bound as
// for brackets.
#define CAG_DEPTH_MOST 1000
bool cag_fail_depth(CagCall *call);
// Whether values that nest so deep may be followed further; false, with the error set, as well
// where the run must stop: values that share their parts take endlessly long.
bool cag_may_nest(CagCall *call, int depth);
// Order of two numbers, angles or texts: -1, 0, 1. False when they have none (no error is set).
bool cag_order(CagValue a, CagValue b, int *order);
bool cag_fail_order(CagCall *call, int argument, CagValue a, CagValue b);
double cag_mix_numbers(double a, double b, double t); // (1 - t) a + t b
// The same of numbers, angles, transforms and lists of these. Error set by the call.
bool cag_mix_values(CagCall *call, CagValue a, CagValue b, double t, CagValue *out);

// x rounded at `digits` places after the point, halves away from 0. What is rounded is the shortest
// decimal that reads back as x, so that 2.675 is a half at 2 places as it is on paper.
double cag_round_decimal(double x, int digits);
// The same as text with exactly `digits` places after the point (digits >= 0).
void cag_print_fixed(CagString *out, double x, int digits);
// A space, a tab or the end of a line.
bool cag_is_space(char c);
// Reads all of [s, s + n), less spaces around, as a decimal number. False when it is none or
// overflows.
bool cag_read_number(const char *s, size_t n, double *out);

// Sine and cosine of degrees, exact at multiples of 30 and 90 where they are 0, 1/2 or 1.
void cag_sincos_degrees(double degrees, double *sine, double *cosine);
// Angle of the point (x, y) in degrees, in -180 .. 180, exact at multiples of 45.
double cag_atan2_degrees(double y, double x);

#endif
