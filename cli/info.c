// cag info: shows the versions of the program and its libraries, and what was found on the machine.

#include <cJSON.h>
#include <lapacke.h>
#include <openexr.h>
#include <png.h>
#include <utf8proc.h>

#include "cli/tool.h"

static void write_libraries(void) {
  int major, minor, patch;
  const char *extra = "";
  lapack_int lapack_major = 0, lapack_minor = 0, lapack_patch = 0;
  exr_get_library_version(&major, &minor, &patch, &extra);
  LAPACKE_ilaver(&lapack_major, &lapack_minor, &lapack_patch);
  printf("OpenEXR    %d.%d.%d%s%s\n", major, minor, patch, *extra ? "-" : "", extra);
  printf("LAPACK     %d.%d.%d\n", (int)lapack_major, (int)lapack_minor, (int)lapack_patch);
  printf("libpng     %s\n", png_get_libpng_ver(NULL));
  printf("cJSON      %s\n", cJSON_Version());
  printf("utf8proc   %s\n", utf8proc_version());
}

static void write_renderer(void) {
  char text[256];
  const char *version = cag_find_povray(text, sizeof text);
  if (version) printf("POV-Ray    %s\n", version);
  else printf("POV-Ray    not found: %s\n", text);
}

static void write_formats(void) {
  printf("export    ");
  for (const char *const *f = cag_export_formats(); *f; f++) printf(" .%s", *f);
  printf("\nrender     .exr .png, by POV-Ray\n");
}

// Writes a size in the largest unit that divides it.
static void write_bytes(size_t bytes) {
  static const char UNITS[] = " KMGT";
  size_t unit = 0;
  while (unit < 4 && bytes >= 1024 && bytes % 1024 == 0) {
    bytes /= 1024;
    unit++;
  }
  printf("memory     %zu%c\n", bytes, UNITS[unit]);
}

static void write_limits(const CagSessionOptions *o) {
  write_bytes(o->max_memory);
  if (o->max_time > 0) printf("time       %g s\n", o->max_time);
  else printf("time       none\n");
  printf("depth      %zu calls\ntriangles  %zu\nbrackets   1000 deep\n", o->max_depth,
         o->max_triangles);
}

int cag_tool_info(CagTool *t, int argc, char **argv) {
  (void)argc, (void)argv;
  printf("cag %s\n\nBuilt in\n", cag_version());
  write_libraries();
  write_formats();
  printf("\nFound\n");
  write_renderer();
  printf("\nLimits\n");
  write_limits(&t->session);
  return CAG_STATUS_OK;
}
