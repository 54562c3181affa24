// The requests to the kernel (see kernel.h), each as the fields of its message (protocol.h).

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "interp/kernel/ask.h"
#include "interp/kernel/put_curve.h"
#include "interp/kernel/put_solid.h"
#include "interp/kernel/unnamed_file.h"

void cag_boundaries_free(CagBoundaries *b) {
  for (size_t i = 0; i < b->count; i++) cag_boundary_free(&b->items[i]);
  cag_free(b->items);
  cag_free(b->copies);
  *b = (CagBoundaries){0};
}

// The answer depends on all bytes of the message.
static CagDigest message_digest(CagBrepMessage type, const CagFields *f) {
  CagDigest d = cag_digest_start();
  cag_digest_word(&d, type);
  cag_digest_bytes(&d, f->bytes, f->length);
  return d;
}

// Asks if the fields are complete (status), and frees them.
static CagStatus ask_and_free(CagKernel *k, CagBrepMessage type, CagFields *f, CagStatus status,
                              CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  *why = (CagKernelFailure){.edge = CAG_NO_EDGE};
  if (!status) {
    const CagDigest question = message_digest(type, f);
    status = cag_kernel_ask(k, type, f, &question, out, why, err);
  }
  cag_fields_free(f);
  return status;
}

CagStatus cag_kernel_boundary(CagKernel *k, const CagSolid *s, double tolerance, int turn,
                              CagBoundaries *out, bool *approximate, CagError *err) {
  CagFields f = {.tolerance = tolerance, .turn = turn};
  CagKernelFailure why;
  const CagStatus status = cag_put_solid(&f, s, err);
  *approximate = f.approximate;
  return ask_and_free(k, CAG_BREP_EVALUATE, &f, status, out, &why, err);
}

// A part in its own coordinates, where it has the numbers of its boundary.
static CagStatus put_part_body(CagFields *f, const CagBoundary *part, CagError *err) {
  const CagTransform here = cag_transform_identity();
  cag_put_body(f, part, &here);
  return f->failed ? cag_fail_memory(err) : CAG_OK;
}

static CagStatus ask_blends(CagKernel *k, CagBrepMessage type, const CagBoundary *part,
                            const CagBlend *blends, size_t n, CagBoundaries *out,
                            CagKernelFailure *why, CagError *err) {
  CagFields f = {0};
  const CagStatus status = put_part_body(&f, part, err);
  cag_put_u32(&f, n);
  for (size_t i = 0; i < n; i++) {
    cag_put_u32(&f, blends[i].edge);
    if (type == CAG_BREP_CHAMFER) cag_put_u32(&f, blends[i].face);
    cag_put_f64(&f, blends[i].first);
    cag_put_f64(&f, blends[i].last);
  }
  return ask_and_free(k, type, &f, status, out, why, err);
}

CagStatus cag_kernel_fillet(CagKernel *k, const CagBoundary *part, const CagBlend *blends, size_t n,
                            CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  return ask_blends(k, CAG_BREP_FILLET, part, blends, n, out, why, err);
}

CagStatus cag_kernel_chamfer(CagKernel *k, const CagBoundary *part, const CagBlend *blends,
                             size_t n, CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  return ask_blends(k, CAG_BREP_CHAMFER, part, blends, n, out, why, err);
}

static void put_indexes(CagFields *f, const size_t *indexes, size_t n) {
  cag_put_u32(f, n);
  for (size_t i = 0; i < n; i++) cag_put_u32(f, indexes[i]);
}

CagStatus cag_kernel_shell(CagKernel *k, const CagBoundary *part, double thickness,
                           const size_t *open, size_t n, CagBoundaries *out, CagKernelFailure *why,
                           CagError *err) {
  CagFields f = {0};
  const CagStatus status = put_part_body(&f, part, err);
  cag_put_f64(&f, thickness);
  put_indexes(&f, open, n);
  return ask_and_free(k, CAG_BREP_SHELL, &f, status, out, why, err);
}

CagStatus cag_kernel_draft(CagKernel *k, const CagBoundary *part, double angle, CagVec3 pull,
                           CagVec3 at, const size_t *faces, size_t n, CagBoundaries *out,
                           CagKernelFailure *why, CagError *err) {
  CagFields f = {0};
  const CagStatus status = put_part_body(&f, part, err);
  cag_put_f64(&f, angle);
  cag_put_vec(&f, pull);
  cag_put_vec(&f, at);
  put_indexes(&f, faces, n);
  return ask_and_free(k, CAG_BREP_DRAFT, &f, status, out, why, err);
}

CagStatus cag_kernel_imprint(CagKernel *k, const CagBoundary *part, CagCurve *const *curves,
                             size_t n, double tolerance, CagBoundaries *out, CagKernelFailure *why,
                             CagError *err) {
  CagFields f = {.tolerance = tolerance};
  CagStatus status = put_part_body(&f, part, err);
  cag_put_u32(&f, n);
  for (size_t i = 0; !status && i < n; i++) {
    status = cag_put_space_curve(&f, curves[i], err);
    if (!status) status = cag_stop_check(err);
  }
  return ask_and_free(k, CAG_BREP_IMPRINT, &f, status, out, why, err);
}

CagStatus cag_kernel_offset(CagKernel *k, const CagSolid *s, double distance, double tolerance,
                            CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  CagFields f = {.tolerance = tolerance};
  const CagStatus status = cag_put_solid(&f, s, err);
  cag_put_f64(&f, distance);
  return ask_and_free(k, CAG_BREP_OFFSET, &f, status, out, why, err);
}

CagStatus cag_kernel_split(CagKernel *k, const CagSolid *s, const CagSolid *tool, double tolerance,
                           CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  CagFields f = {.tolerance = tolerance};
  CagBounds box;
  CagStatus status = cag_solid_bounds(s, &box, err);
  if (!status) status = cag_put_solid(&f, s, err);
  if (!status) status = cag_put_solid_within(&f, tool, &box, err);
  return ask_and_free(k, CAG_BREP_SPLIT, &f, status, out, why, err);
}

// --- Files ---

// The kernel's text with the name of the file in place of the path at which the kernel found it.
static CagStatus fail_file(const char *path, const char *name, CagError *err) {
  char told[sizeof err->message];
  memcpy(told, err->message, sizeof told);
  const char *at = strstr(told, path);
  if (!at)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_exact_file, "", -1, "cannot read `%s`: %s", name,
                    told);
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_exact_file, "", -1, "%.*s%s%s", (int)(at - told),
                  told, name, at + strlen(path));
}

static CagStatus read_file(CagKernel *k, CagBrepMessage type, const char *name, const void *bytes,
                           size_t size, CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  char path[CAG_UNNAMED_PATH];
  CagFields f = {0};
  CagDigest question = cag_digest_start();
  cag_digest_word(&question, type);
  cag_digest_bytes(&question, bytes, size);
  *why = (CagKernelFailure){.edge = CAG_NO_EDGE};
  const int fd = cag_unnamed_file(bytes, size, path);
  if (fd < 0) return cag_fail_memory(err);
  cag_put_u32(&f, strlen(path));
  cag_put_bytes(&f, path, strlen(path));
  const CagStatus status = cag_kernel_ask(k, type, &f, &question, out, why, err);
  cag_fields_free(&f);
  cag_unnamed_close(fd);
  return why->reason == CAG_BREP_FAIL_FILE ? fail_file(path, name, err) : status;
}

CagStatus cag_kernel_read_step(CagKernel *k, const char *name, const void *bytes, size_t size,
                               CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  return read_file(k, CAG_BREP_READ_STEP, name, bytes, size, out, why, err);
}

CagStatus cag_kernel_read_iges(CagKernel *k, const char *name, const void *bytes, size_t size,
                               CagBoundaries *out, CagKernelFailure *why, CagError *err) {
  return read_file(k, CAG_BREP_READ_IGES, name, bytes, size, out, why, err);
}
