// Reading a file back (see brep_check.h).

#include "interp/formats/brep_check.h"

#include <math.h>

#include "base/memory.h"
#include "interp/formats/brep_build.h"
#include "interp/formats/iges.h"
#include "interp/formats/step.h"

// The relative difference of volumes that counts as equal. Readers compute curves in the parameters
// of surfaces again, within the gaps of edges; a face that was read wrongly changes far more.
#define VOLUME_SAME 1e-5

static CagStatus write_text(const CagBoundaries *parts, CagBrepFormat format, char **text,
                            size_t *size, CagError *err) {
  CagBrep b = {.accuracy = 1e-7};
  CagMaterial plain = {0};
  CagError io = {0};
  CagStatus status = CAG_OK;
  b.shapes = cag_calloc(1, sizeof *b.shapes);
  CagAtomicFile *file = cag_atomic_file_open_memory(&io);
  if (!b.shapes || !file) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < parts->count; i++)
    status = cag_brep_add_boundary(&b, &parts->items[i], err);
  if (!status) {
    b.shapes[0] = (CagBrepShape){
        .kind = CAG_BREP_SOLID, .name = "solid", .material = &plain, .count = b.shell_count};
    b.shape_count = 1;
    status = format == CAG_BREP_IGES ? cag_export_iges(&b, NULL, file, err)
                                     : cag_export_step(&b, NULL, file, err);
  }
  if (status) cag_atomic_file_abort(file);
  else if (!cag_atomic_file_commit_memory(file, text, size, &io)) status = cag_fail_memory(err);
  cag_brep_free(&b);
  return status;
}

static double total_volume(const CagBoundaries *b) {
  double sum = 0;
  for (size_t i = 0; i < b->count; i++) sum += b->items[i].volume;
  return sum;
}

CagStatus cag_brep_reads_back(CagKernel *kernel, const CagBoundaries *parts, CagBrepFormat format,
                              bool *same, CagError *err) {
  char *text = NULL;
  size_t size = 0;
  CagBoundaries again = {0};
  CagKernelFailure why;
  *same = false;
  CagStatus status = write_text(parts, format, &text, &size, err);
  if (status) return status;
  status = format == CAG_BREP_IGES
               ? cag_kernel_read_iges(kernel, "solid.igs", text, size, &again, &why, err)
               : cag_kernel_read_step(kernel, "solid.step", text, size, &again, &why, err);
  cag_free(text);
  if (status) return why.reason ? CAG_OK : status;
  const double meant = total_volume(parts), found = total_volume(&again);
  *same = again.count == parts->count && fabs(meant - found) <= VOLUME_SAME * fabs(meant);
  cag_boundaries_free(&again);
  return CAG_OK;
}
