// Least-squares fits of formulas to points (x, y).

#ifndef CAG_GEOM_REGRESSION_H
#define CAG_GEOM_REGRESSION_H

#include <stddef.h>

#include "base/status.h"

typedef enum CagModel {
  CAG_MODEL_POLYNOMIAL, // y = c0 + c1 x + ... + cn x^n
  CAG_MODEL_POWER,      // y = a x^b, fitted as a line through (ln x, ln y): x, y > 0
  CAG_MODEL_EXPONENTIAL // y = a exp(b x), fitted as a line through (x, ln |y|): y of one sign, not
                        // 0
} CagModel;

// Coefficients, ascending; a and b of the other two models. out: degree + 1 numbers (2 of the other
// models). *residual is the sum of squared deviations of y. Fails with "underdetermined" where
// there are fewer different x than coefficients, "domain" with the index.
CagStatus cag_fit_formula(const double *x, const double *y, size_t n, CagModel model, int degree,
                          double *out, double *residual, CagError *err);

#endif
