// Complex numbers. Include this instead of <complex.h>.

#ifndef CAG_GEOM_COMPLEX_H
#define CAG_GEOM_COMPLEX_H

#include <complex.h>

// The GNU C library defines this macro for GCC only. Unlike re + im * I, it keeps an infinite im.
#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

#endif
