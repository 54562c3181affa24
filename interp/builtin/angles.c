// Angles: the trigonometric functions and their inverses.
//
// Angles are kept in degrees, so the reduction to a quarter turn is exact, and with it the values
// 0, 1/2 and 1.

#include "interp/builtin/support.h"

static const double DEGREES_PER_RADIAN = 57.29577951308232;
static const double RADIANS_PER_DEGREE = 0.017453292519943295;
static const char FAMILY[] = "Angles";

static bool call_sin(CagCall *call, CagValue *result) {
  double a, s, c;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  cag_sincos_degrees(a, &s, &c);
  *result = cag_number(s);
  return true;
}

static bool call_cos(CagCall *call, CagValue *result) {
  double a, s, c;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  cag_sincos_degrees(a, &s, &c);
  *result = cag_number(c);
  return true;
}

static bool call_tan(CagCall *call, CagValue *result) {
  double a, s, c;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  cag_sincos_degrees(a, &s, &c);
  if (c == 0) {
    char digits[32];
    return cag_fail_call(call, 0, CAG_ERR_not_finite, "is infinite at %sdeg",
                         cag_number_text(a, digits));
  }
  // At odd multiples of 45deg, where sine and cosine differ by rounding only, the quotient is 1.
  double rest = fmod(fabs(a), 90);
  *result = cag_number(rest == 45 ? copysign(1, s / c) : s / c + 0.0);
  return true;
}

// Reads a number of -1..1; what is outside by rounding counts as the end.
static bool read_cosine(CagCall *call, double *x) {
  static const double OUTSIDE = 1e-12;
  if (!cag_arg_number(call, 0, x)) return false;
  if (!(fabs(*x) <= 1 + OUTSIDE)) return cag_fail_value(call, 0, "a number in -1..1");
  if (*x > 1) *x = 1;
  if (*x < -1) *x = -1;
  return true;
}

static double arcsine_degrees(double x) {
  if (fabs(x) == 1) return copysign(90, x);
  if (fabs(x) == 0.5) return copysign(30, x);
  return asin(x) * DEGREES_PER_RADIAN;
}

static double arccosine_degrees(double x) {
  if (x == 1) return 0;
  if (x == -1) return 180;
  if (fabs(x) == 0.5) return x > 0 ? 60 : 120;
  return x == 0 ? 90 : acos(x) * DEGREES_PER_RADIAN;
}

static bool call_asin(CagCall *call, CagValue *result) {
  double x;
  if (!read_cosine(call, &x)) return false;
  *result = cag_angle(arcsine_degrees(x));
  return true;
}

static bool call_acos(CagCall *call, CagValue *result) {
  double x;
  if (!read_cosine(call, &x)) return false;
  *result = cag_angle(arccosine_degrees(x));
  return true;
}

static bool call_atan(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  *result = cag_angle(cag_atan2_degrees(x, 1));
  return true;
}

static bool call_atan2(CagCall *call, CagValue *result) {
  struct {
    double y, x;
  } a;
  if (!cag_bind(call, &a, sizeof a)) return false;
  *result = cag_angle(cag_atan2_degrees(a.y, a.x));
  return true;
}

static bool call_in_degrees(CagCall *call, CagValue *result) {
  double a;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  *result = cag_number(a);
  return true;
}

static bool call_in_radians(CagCall *call, CagValue *result) {
  double a;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  *result = cag_number(a * RADIANS_PER_DEGREE);
  return true;
}

const CagBuiltin cag_builtins_angles[] = {
    {"sin(angle: angle)", call_sin, "number",
     "Returns the sine of an angle. Exact for results 0, ±0.5, and ±1.",
     "print sin(30deg), sin(180deg) // expect: 0.5 0", 0, FAMILY},
    {"cos(angle: angle)", call_cos, "number",
     "Returns the cosine of an angle. Exact for results 0, ±0.5, and ±1.",
     "print cos(60deg), cos(90deg) // expect: 0.5 0", 0, FAMILY},
    {"tan(angle: angle)", call_tan, "number",
     "Returns the tangent of an angle. Exact for results 0 and ±1. At 90deg and 270deg, the "
     "tangent is infinite, which is an error.",
     "print tan(45deg), tan(-45deg), tan(180deg) // expect: 1 -1 0", 0, FAMILY},
    {"asin(x: number)", call_asin, "angle",
     "Returns the angle in -90deg..90deg whose sine is x. Values that exceed the range -1..1 by "
     "at most 1e-12 are clamped to it.",
     "print asin(0.5) // expect: 30deg", 0, FAMILY},
    {"acos(x: number)", call_acos, "angle",
     "Returns the angle in 0deg..180deg whose cosine is x. Values that exceed the range -1..1 by "
     "at most 1e-12 are clamped to it.",
     "print acos(0.5), acos(-1) // expect: 60deg 180deg", 0, FAMILY},
    {"atan(x: number)", call_atan, "angle",
     "Returns the angle between -90deg and 90deg whose tangent is x.",
     "print atan(1) // expect: 45deg", 0, FAMILY},
    {"atan2(y: number, x: number)", call_atan2, "angle",
     "Returns the direction of the point [x, y] from the origin, greater than -180deg and at "
     "most 180deg. The direction of the origin itself is 0deg.",
     "print atan2(1, -1), atan2(0, -1) // expect: 135deg 180deg", 0, FAMILY},
    {"in_degrees(a: angle)", call_in_degrees, "number", "Returns an angle as a number of degrees.",
     "print in_degrees(0.5turn) // expect: 180", 0, FAMILY},
    {"in_radians(a: angle)", call_in_radians, "number", "Returns an angle as a number of radians.",
     "print in_radians(180deg) == pi // expect: true", 0, FAMILY},
    {0}};
