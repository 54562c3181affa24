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

// The coefficients in ascending order, or a and b. out: degree + 1 numbers for a polynomial, else
// 2. *residual is the sum of the squared deviations in y. Fails with "underdetermined" if there are
// fewer distinct x than coefficients, and with "domain" and the index of the point.
CagStatus cag_fit_formula(const double *x, const double *y, size_t n, CagModel model, int degree,
                          double *out, double *residual, CagError *err);

#endif
