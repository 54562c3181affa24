// Replaces the process of interp/kernel/, and interp/formats/brep_check.c, in a browser, which
// cannot start the helper program.

#include "interp/formats/brep_check.h"
#include "interp/kernel/ask.h"
#include "interp/kernel/unnamed_file.h"

static char no_kernel;

CagKernel *cag_kernel_new(void) { return (CagKernel *)(void *)&no_kernel; }
void cag_kernel_free(CagKernel *k) { (void)k; }
void cag_kernel_set_patience(CagKernel *k, double seconds) {
  (void)k;
  (void)seconds;
}

static CagStatus fail_missing(CagError *err) {
  return cag_fail(err, CAG_E_RENDERER, CAG_ERR_kernel_missing, "", -1,
                  "exact boundaries of solids need the program cag-brep, which does not run in a "
                  "browser: export the script with the program cag");
}

CagStatus cag_kernel_ask(CagKernel *k, CagBrepMessage type, const CagFields *f,
                         const CagDigest *question, CagBoundaries *out, CagKernelFailure *why,
                         CagError *err) {
  (void)k;
  (void)type;
  (void)f;
  (void)question;
  *out = (CagBoundaries){0};
  *why = (CagKernelFailure){.edge = CAG_NO_EDGE};
  return fail_missing(err);
}

// The bytes are not needed.
int cag_unnamed_file(const void *bytes, size_t size, char path[CAG_UNNAMED_PATH]) {
  (void)bytes;
  (void)size;
  path[0] = '\0';
  return 0;
}
void cag_unnamed_close(int file) { (void)file; }

CagStatus cag_brep_needs_reading(const CagBoundaries *parts, bool *needed, CagError *err) {
  (void)parts;
  (void)err;
  *needed = true;
  return CAG_OK;
}

CagStatus cag_brep_reads_back(CagKernel *kernel, const CagBoundaries *parts, CagBrepFormat format,
                              bool *same, CagError *err) {
  (void)kernel;
  (void)parts;
  (void)format;
  (void)same;
  return fail_missing(err);
}
