// Reading a STEP file back (see step_check.h).

#include "interp/formats/step_check.h"

#include <math.h>
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/memory.h"
#include "interp/formats/brep_build.h"
#include "interp/formats/step.h"

// The relative difference of volumes that counts as equal. Readers compute curves in the parameters
// of surfaces again, within the gaps of edges; a face that was read wrongly changes far more.
#define VOLUME_SAME 1e-5

static CagStatus write_text(const CagBoundaries *parts, char **text, size_t *size, CagError *err) {
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
    status = cag_export_step(&b, NULL, file, err);
  }
  if (status) cag_atomic_file_abort(file);
  else if (!cag_atomic_file_commit_memory(file, text, size, &io)) status = cag_fail_memory(err);
  cag_brep_free(&b);
  return status;
}

// A file without a name, and the path at which other processes find it.
static int unnamed_file(const char *text, size_t size, char path[64]) {
  const int fd = memfd_create("cag-step", MFD_CLOEXEC);
  for (size_t done = 0; fd >= 0 && done < size;) {
    const ssize_t n = write(fd, text + done, size - done);
    if (n <= 0) {
      close(fd);
      return -1;
    }
    done += (size_t)n;
  }
  snprintf(path, 64, "/proc/%ld/fd/%d", (long)getpid(), fd);
  return fd;
}

static double total_volume(const CagBoundaries *b) {
  double sum = 0;
  for (size_t i = 0; i < b->count; i++) sum += b->items[i].volume;
  return sum;
}

CagStatus cag_step_reads_back(CagKernel *kernel, const CagBoundaries *parts, bool *same,
                              CagError *err) {
  char *text = NULL, path[64];
  size_t size = 0;
  CagBoundaries again = {0};
  *same = false;
  CagStatus status = write_text(parts, &text, &size, err);
  if (status) return status;
  const int fd = unnamed_file(text, size, path);
  cag_free(text);
  if (fd < 0) return cag_fail_memory(err);
  status = cag_kernel_read_step(kernel, path, &again, err);
  close(fd);
  if (status) return err->id == CAG_ERR_no_boundary ? CAG_OK : status;
  const double meant = total_volume(parts), found = total_volume(&again);
  *same = again.count == parts->count && fabs(meant - found) <= VOLUME_SAME * fabs(meant);
  cag_boundaries_free(&again);
  return CAG_OK;
}
