// What several files of built-ins on splines share.

#ifndef CAG_INTERP_BUILTIN_SPLINES_H
#define CAG_INTERP_BUILTIN_SPLINES_H

#include "geom/curve/cubic.h"
#include "interp/builtin/curves.h"

// A geometry error of the built-ins themselves.
bool cag_splines_fail(CagCall *call, CagErrorId id, const char *argument, long index,
                      const char *format, ...) __attribute__((format(printf, 5, 6)));
// Points all of one dimension ("dimension-mismatch"); malloc'd.
bool cag_splines_points(CagCall *call, int argument, CagVec3 **out, size_t *n, int *dimension);
// A vector of the dimension that the points have.
bool cag_splines_check_dimension(CagCall *call, int argument, CagPoint p, int dimension);
// "chord", "uniform", "centripetal"; n parameters, or the n - 1 lengths between them. *own is
// malloc'd, NULL where spacing says it.
bool cag_splines_parameters(CagCall *call, int argument, CagSpacing otherwise, size_t n,
                            CagSpacing *spacing, double **own);

#endif
