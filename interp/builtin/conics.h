// What several files of built-ins on conics share.

#ifndef CAG_INTERP_BUILTIN_CONICS_H
#define CAG_INTERP_BUILTIN_CONICS_H

#include "geom/curve/conic.h"
#include "interp/builtin/curves.h"

// The equation of a conic from six coefficients, 3 rows of its symmetric matrix, or a curve.
bool cag_arg_conic(CagCall *call, int argument, CagConic *out);

#endif
