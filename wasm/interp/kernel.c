// Replaces interp/kernel/ and interp/formats/step_check.c in a browser, which cannot start the
// helper program.

#include "interp/formats/step_check.h"

static char no_kernel;

CagKernel *cag_kernel_new(void) { return (CagKernel *)(void *)&no_kernel; }
void cag_kernel_free(CagKernel *k) { (void)k; }

void cag_boundaries_free(CagBoundaries *b) { *b = (CagBoundaries){0}; }

static CagStatus fail_missing(CagError *err) {
  return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_missing, "", -1,
                  "exact boundaries of solids need the program cag-brep, which does not run in a "
                  "browser: export the script with the program cag");
}

CagStatus cag_kernel_boundary(CagKernel *k, const CagSolid *s, double tolerance, int turn,
                              CagBoundaries *out, bool *approximate, CagError *err) {
  (void)k;
  (void)s;
  (void)tolerance;
  (void)turn;
  (void)out;
  (void)approximate;
  return fail_missing(err);
}

CagStatus cag_step_reads_back(CagKernel *kernel, const CagBoundaries *parts, bool *same,
                              CagError *err) {
  (void)kernel;
  (void)parts;
  (void)same;
  return fail_missing(err);
}
