// Replaces the files interp/render/povray*.c and sandbox.c where no process can be started.

#include "interp/render/povray.h"

#include "base/memory.h"

bool cag_povray_render(const CagPovrayJob *job, CagPovrayResult *out, CagError *err) {
  (void)job;
  *out = (CagPovrayResult){0};
  return cag_povray_find(NULL, 0, NULL, err);
}

void cag_povray_result_free(CagPovrayResult *result) {
  cag_free(result->exr);
  *result = (CagPovrayResult){0};
}

bool cag_povray_find(char *path, size_t path_size, char version[64], CagError *err) {
  (void)path;
  (void)path_size;
  (void)version;
  return cag_fail_io(err, CAG_E_RENDERER, "use --engine preview",
                     "POV-Ray is not installed: the playground cannot start programs");
}
