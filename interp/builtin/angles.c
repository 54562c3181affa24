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
  double y, x;
  if (!cag_arg_number(call, 0, &y) || !cag_arg_number(call, 1, &x)) return false;
  *result = cag_angle(cag_atan2_degrees(y, x));
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
     "The sine of an angle, exact where it is 0, 0.5 or 1 (either sign).",
     "print sin(30deg), sin(180deg) // expect: 0.5 0", 0, FAMILY},
    {"cos(angle: angle)", call_cos, "number",
     "The cosine of an angle, exact where it is 0, 0.5 or 1 (either sign).",
     "print cos(60deg), cos(90deg) // expect: 0.5 0", 0, FAMILY},
    {"tan(angle: angle)", call_tan, "number",
     "The tangent of an angle, exact where it is 0 or 1 (either sign). An error where it is "
     "infinite, at 90deg and 270deg.",
     "print tan(45deg), tan(-45deg), tan(180deg) // expect: 1 -1 0", 0, FAMILY},
    {"asin(x: number)", call_asin, "angle",
     "The angle in -90deg..90deg whose sine is x. A number up to 1e-12 outside of -1..1 is taken "
     "for the end.",
     "print asin(0.5) // expect: 30deg", 0, FAMILY},
    {"acos(x: number)", call_acos, "angle",
     "The angle in 0deg..180deg whose cosine is x. A number up to 1e-12 outside of -1..1 is taken "
     "for the end.",
     "print acos(0.5), acos(-1) // expect: 60deg 180deg", 0, FAMILY},
    {"atan(x: number)", call_atan, "angle",
     "The angle between -90deg and 90deg whose tangent is x.", "print atan(1) // expect: 45deg", 0,
     FAMILY},
    {"atan2(y: number, x: number)", call_atan2, "angle",
     "The angle of the point [x, y] seen from the origin, above -180deg, at most 180deg; of the "
     "origin itself 0deg.",
     "print atan2(1, -1), atan2(0, -1) // expect: 135deg 180deg", 0, FAMILY},
    {"in_degrees(a: angle)", call_in_degrees, "number", "The number of degrees of an angle.",
     "print in_degrees(0.5turn) // expect: 180", 0, FAMILY},
    {"in_radians(a: angle)", call_in_radians, "number", "The number of radians of an angle.",
     "print in_radians(180deg) == pi // expect: true", 0, FAMILY},
    {0}};
