// Angles: the trigonometric functions and their inverses.
//
// Angles are kept in degrees, so the reduction to a quarter turn is exact, and so are the values 0,
// 1/2, and 1.

#include "interp/builtin/support.h"

#define DEGREES_PER_RADIAN 57.29577951308232
#define RADIANS_PER_DEGREE 0.017453292519943295

bool cag_angles_sin(CagCall *call, CagValue *result) {
  double a, s, c;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  cag_sincos_degrees(a, &s, &c);
  *result = cag_number(s);
  return true;
}

bool cag_angles_cos(CagCall *call, CagValue *result) {
  double a, s, c;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  cag_sincos_degrees(a, &s, &c);
  *result = cag_number(c);
  return true;
}

bool cag_angles_tan(CagCall *call, CagValue *result) {
  double a, s, c;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  cag_sincos_degrees(a, &s, &c);
  if (c == 0) {
    char digits[32];
    return cag_fail_call(call, 0, CAG_ERR_not_finite, "is infinite at %sdeg",
                         cag_number_text(a, digits));
  }
  // At odd multiples of 45deg, sine and cosine differ only by rounding; the quotient is set to 1.
  double rest = fmod(fabs(a), 90);
  *result = cag_number(rest == 45 ? copysign(1, s / c) : s / c + 0.0);
  return true;
}

// Reads a number in -1..1. A value that is outside only by rounding is set to the end.
static bool read_cosine(CagCall *call, double *x) {
  static const double OUTSIDE = 1e-12;
  if (!cag_arg_number(call, 0, x)) return false;
  if (!(fabs(*x) <= 1 + OUTSIDE)) return cag_fail_value(call, 0, "a number in -1..1");
  *x = fmin(fmax(*x, -1), 1);
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

bool cag_angles_asin(CagCall *call, CagValue *result) {
  double x;
  if (!read_cosine(call, &x)) return false;
  *result = cag_angle(arcsine_degrees(x));
  return true;
}

bool cag_angles_acos(CagCall *call, CagValue *result) {
  double x;
  if (!read_cosine(call, &x)) return false;
  *result = cag_angle(arccosine_degrees(x));
  return true;
}

bool cag_angles_atan(CagCall *call, CagValue *result) {
  double x;
  if (!cag_arg_number(call, 0, &x)) return false;
  *result = cag_angle(cag_atan2_degrees(x, 1));
  return true;
}

bool cag_angles_atan2(CagCall *call, const struct cag_angles_atan2 *a, CagValue *result) {
  (void)call;
  *result = cag_angle(cag_atan2_degrees(a->y, a->x));
  return true;
}

bool cag_angles_in_degrees(CagCall *call, CagValue *result) {
  double a;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  *result = cag_number(a);
  return true;
}

bool cag_angles_in_radians(CagCall *call, CagValue *result) {
  double a;
  if (!cag_arg_degrees(call, 0, &a)) return false;
  *result = cag_number(a * RADIANS_PER_DEGREE);
  return true;
}
