// Times the mesh formats on 10^6 triangles, beside writing the same bytes with fwrite.

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "geom/mesh/mesh.h"
#include "interp/export/mesh_formats.h"
#include "interp/scene/scene.h"

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// A wavy sheet of 2 n^2 triangles.
static CagMesh *make_sheet(size_t n) {
  CagError err;
  CagMesh *m;
  if (cag_mesh_new((n + 1) * (n + 1), 2 * n * n, true, true, false, &m, &err) != CAG_OK) exit(1);
  for (size_t i = 0; i <= n; i++) {
    for (size_t j = 0; j <= n; j++) {
      size_t k = i * (n + 1) + j;
      double x = 0.1 * (double)i, y = 0.1 * (double)j;
      m->positions[k] = cag_vec3(x, y, sin(x) * cos(y));
      m->normals[k] = cag_unit(cag_vec3(-cos(x) * cos(y), sin(x) * sin(y), 1));
      m->uv[2 * k] = x;
      m->uv[2 * k + 1] = y;
    }
  }
  size_t t = 0;
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < n; j++) {
      uint32_t a = (uint32_t)(i * (n + 1) + j), b = a + (uint32_t)n + 1;
      const uint32_t corners[] = {a, b, b + 1, a, b + 1, a + 1};
      memcpy(m->triangles + t, corners, sizeof corners);
      t += 6;
    }
  }
  return m;
}

static CagStatus write_obj(const CagMeshPart *p, CagAtomicFile *f, CagError *e) {
  return cag_export_obj(p, 1, NULL, f, e);
}
static CagStatus write_stl(const CagMeshPart *p, CagAtomicFile *f, CagError *e) {
  return cag_export_stl(p, 1, NULL, f, e);
}
static CagStatus write_ply(const CagMeshPart *p, CagAtomicFile *f, CagError *e) {
  return cag_export_ply(p, 1, f, e);
}
static CagStatus write_glb(const CagMeshPart *p, CagAtomicFile *f, CagError *e) {
  return cag_export_glb(p, 1, f, e);
}

static double time_plain(const char *path, size_t bytes) {
  char *data = malloc(bytes);
  if (!data) exit(1);
  memset(data, 1, bytes);
  double best = 1e9;
  for (int k = 0; k < 5; k++) {
    remove(path);
    double t = now();
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(data, 1, bytes, f) != bytes || fclose(f)) exit(1);
    t = now() - t;
    if (t < best) best = t;
  }
  free(data);
  return best;
}

int main(int argc, char **argv) {
  static const struct {
    const char *name;
    CagStatus (*write)(const CagMeshPart *, CagAtomicFile *, CagError *);
    const char *aim;
  } formats[] = {{"stl", write_stl, "ratio <= 3"},
                 {"ply", write_ply, "ratio <= 3"},
                 {"glb", write_glb, "ratio <= 3"},
                 {"obj", write_obj, ">= 3 Mtri/s"}};
  if (argc < 2) return 2;
  CagMesh *mesh = make_sheet(708);
  CagMaterial material = cag_material_default();
  CagMeshPart part = {.name = "sheet", .mesh = mesh, .material = &material};
  for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
    char path[4096];
    snprintf(path, sizeof path, "%s/sheet.%s", argv[1], formats[i].name);
    double best = 1e9;
    for (int k = 0; k < 5; k++) {
      remove(path);
      CagIoError io;
      CagError err;
      double t = now();
      CagAtomicFile *f = cag_atomic_file_open(path, &io);
      if (!f || formats[i].write(&part, f, &err) != CAG_OK || !cag_atomic_file_commit(f, &io))
        return 1;
      t = now() - t;
      if (t < best) best = t;
    }
    struct stat st;
    if (stat(path, &st) != 0) return 1;
    double plain = time_plain(path, (size_t)st.st_size);
    printf("%s %44.4f s   fwrite of %4lld MB %13.4f s   ratio %6.2f   %.1f Mtri/s   aim %s\n",
           formats[i].name, best, (long long)st.st_size >> 20, plain, best / plain,
           (double)mesh->triangle_count / best / 1e6, formats[i].aim);
  }
  return 0;
}
