// Declarations shared by the built-ins on conics.

#ifndef CAG_INTERP_BUILTIN_CONICS_H
#define CAG_INTERP_BUILTIN_CONICS_H

#include "geom/curve/conic.h"
#include "interp/builtin/curves.h"

// Reads the equation of a conic from six coefficients, three rows of its symmetric matrix, or a
// curve.
bool cag_arg_conic(CagCall *call, int argument, CagConic *out);

#endif
