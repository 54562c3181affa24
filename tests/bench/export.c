// Times the mesh formats for 10^6 triangles, compared with writing the same bytes by fwrite to the
// same location. The two alternate, so that other processes affect both equally; the best of each
// counts.

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "geom/mesh/mesh.h"
#include "interp/formats/mesh_formats.h"
#include "interp/formats/pov.h"
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

static CagStatus write_gltf(const CagMeshPart *p, CagAtomicFile *f, CagError *e) {
  return cag_export_gltf(p, 1, NULL, f, &(CagGltfData){0}, e);
}
static CagStatus write_3mf(const CagMeshPart *p, CagAtomicFile *f, CagError *e) {
  return cag_export_3mf(p, 1, f, e);
}
// Makes a scene that owns its contents, as cag_scene_complete requires.
static CagStatus write_pov(const CagMeshPart *p, CagAtomicFile *f, CagError *e) {
  CagScene scene = {.items = calloc(1, sizeof *scene.items),
                    .item_count = 1,
                    .materials = malloc(sizeof *scene.materials),
                    .material_count = 1};
  if (!scene.items || !scene.materials) exit(1);
  scene.items[0] = (CagItem){.kind = CAG_ITEM_MESH,
                             .name = strdup(p->name),
                             .as.mesh = cag_mesh_retain(p->mesh),
                             .placement = cag_transform_identity()};
  scene.materials[0] = *p->material;
  scene.materials[0].name = strdup(p->material->name);
  scene.materials[0].texture = strdup("");
  CagStatus status = cag_scene_complete(&scene, e);
  if (status == CAG_OK)
    status = cag_export_pov(&scene, &(CagPovOptions){.quality = CAG_POV_NORMAL}, f, e);
  cag_scene_free(&scene);
  return status;
}

typedef struct Format {
  const char *name;
  CagStatus (*write)(const CagMeshPart *, CagAtomicFile *, CagError *);
  const char *aim;
} Format;

static double time_ours(const Format *format, const CagMeshPart *part, const char *path) {
  CagError io;
  CagError err;
  remove(path);
  double t = now();
  CagAtomicFile *f = cag_atomic_file_open(path, &io);
  if (!f || format->write(part, f, &err) != CAG_OK || !cag_atomic_file_commit(f, &io)) exit(1);
  return now() - t;
}

static double time_plain(const char *path, const char *data, size_t bytes) {
  remove(path);
  double t = now();
  FILE *f = fopen(path, "wb");
  if (!f || fwrite(data, 1, bytes, f) != bytes || fclose(f)) exit(1);
  return now() - t;
}

static char *read_back(const char *path, size_t *bytes) {
  struct stat st;
  if (stat(path, &st) != 0) exit(1);
  *bytes = (size_t)st.st_size;
  char *data = malloc(*bytes);
  FILE *f = fopen(path, "rb");
  if (!data || !f || fread(data, 1, *bytes, f) != *bytes) exit(1);
  fclose(f);
  return data;
}

int main(int argc, char **argv) {
  static const Format formats[] = {
      {"stl", write_stl, "ratio <= 2"}, {"ply", write_ply, "ratio <= 2"},
      {"glb", write_glb, "ratio <= 2"}, {"gltf", write_gltf, ""},
      {"3mf", write_3mf, ""},           {"obj", write_obj, ">= 5 Mtri/s"},
      {"pov", write_pov, ">= 2 Mtri/s"}};
  enum { TURNS = 9 };
  if (argc < 2) return 2;
  CagMesh *mesh = make_sheet(708);
  CagMaterial material = cag_material_default();
  CagMeshPart part = {.name = "sheet", .mesh = mesh, .material = &material};
  for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
    char path[4096];
    snprintf(path, sizeof path, "%s/sheet.%s", argv[1], formats[i].name);
    size_t bytes;
    double best = time_ours(&formats[i], &part, path), plain = 1e9;
    char *data = read_back(path, &bytes);
    for (int k = 0; k < TURNS; k++) {
      double a = time_plain(path, data, bytes), b = time_ours(&formats[i], &part, path);
      plain = a < plain ? a : plain;
      best = b < best ? b : best;
    }
    free(data);
    remove(path);
    printf("%-4s %43.4f s   fwrite of %4zu MB %13.4f s   ratio %6.2f   %.1f Mtri/s   aim %s\n",
           formats[i].name, best, bytes >> 20, plain, best / plain,
           (double)mesh->triangle_count / best / 1e6, formats[i].aim);
  }
  return 0;
}
