// Curves as fields of messages to cag-brep.

#ifndef CAG_INTERP_KERNEL_PUT_CURVE_H
#define CAG_INTERP_KERNEL_PUT_CURVE_H

#include "geom/curve/curve.h"
#include "interp/kernel/fields.h"

// Whether a conversion to NURBS failed because there is no such form.
bool cag_no_exact_form(CagStatus status);
// Fails with "export-not-exact", which names the kind of curve or surface.
CagStatus cag_fail_inexact(const char *kind, CagError *err);
// The NURBS form of a curve; the caller releases it. A curve without one is approximated within the
// tolerance of the fields; if it is 0, fails with "export-not-exact".
CagStatus cag_exact_curve(CagFields *f, const CagCurve *c, CagCurve **out, CagError *err);

// Adds a curve in space and its range: arcs as circles and ellipses, others as splines. Fails as
// cag_exact_curve.
CagStatus cag_put_space_curve(CagFields *f, const CagCurve *c, CagError *err);

#endif
