// Scenes built by hand for the tests of exporters, and temporary files.

#ifndef CAG_TESTS_SCENE_FIXTURE_H
#define CAG_TESTS_SCENE_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

#define FIXTURE_MAX 64

typedef struct Fixture {
  CagScene scene;
  CagItem items[FIXTURE_MAX];
  CagMaterial materials[FIXTURE_MAX];
  CagLight lights[4];
  CagColor sky[4];
  CagCamera camera;
} Fixture;

#define OK(call)                                                                                   \
  do {                                                                                             \
    CagError err = {0};                                                                            \
    if ((call) != CAG_OK) fail_msg("%s", err.message);                                             \
  } while (0)

static inline CagMaterial plain_material(char *name, double r, double g, double b) {
  return (CagMaterial){.name = name,
                       .color = {r, g, b},
                       .roughness = 1,
                       .ior = 1.2,
                       .texture = "",
                       .texture_scale = 10};
}

// A camera at -Y that looks along +Y, one sun along the view, and a black sky; there is no other
// light.
static inline void fixture_begin(Fixture *f) {
  memset(f, 0, sizeof *f);
  f->materials[0] = plain_material("white", 1, 1, 1);
  f->camera = (CagCamera){.name = "camera",
                          .eye = {0, -300, 0},
                          .target = {0, 0, 0},
                          .up = {0, 0, 1},
                          .fov = 0.4,
                          .size = {96, 72}};
  f->lights[0] =
      (CagLight){.kind = CAG_LIGHT_SUN, .direction = {0, 1, 0}, .color = {1, 1, 1}, .strength = 1};
  f->scene = (CagScene){.items = f->items,
                        .materials = f->materials,
                        .material_count = 1,
                        .cameras = &f->camera,
                        .camera_count = 1,
                        .lights = f->lights,
                        .light_count = 1,
                        .sky = {.color_count = 1, .colors = f->sky},
                        .bounds = {{-50, -50, -50}, {50, 50, 50}},
                        .script = "test.cag",
                        .max_triangles = 10000000};
}

static inline CagItem *fixture_item(Fixture *f, CagItemKind kind, char *name) {
  assert_true(f->scene.item_count < FIXTURE_MAX);
  CagItem *item = &f->items[f->scene.item_count++];
  *item = (CagItem){.kind = kind, .name = name, .placement = cag_transform_identity()};
  return item;
}

// Each takes ownership of the shape.
static inline CagItem *fixture_solid(Fixture *f, char *name, CagSolid *s) {
  CagItem *item = fixture_item(f, CAG_ITEM_SOLID, name);
  item->as.solid = s;
  return item;
}
static inline CagItem *fixture_surface(Fixture *f, char *name, CagSurface *s) {
  CagItem *item = fixture_item(f, CAG_ITEM_SURFACE, name);
  item->as.surface = s;
  return item;
}
static inline CagItem *fixture_curve(Fixture *f, char *name, CagCurve *c) {
  CagItem *item = fixture_item(f, CAG_ITEM_CURVE, name);
  item->as.curve = c;
  return item;
}
static inline CagItem *fixture_region(Fixture *f, char *name, CagRegion *r) {
  CagItem *item = fixture_item(f, CAG_ITEM_REGION, name);
  item->as.region = r;
  return item;
}

static inline void fixture_end(Fixture *f) {
  for (size_t i = 0; i < f->scene.item_count; i++) {
    CagItem *item = &f->items[i];
    switch (item->kind) {
    case CAG_ITEM_CURVE: cag_curve_release(item->as.curve); break;
    case CAG_ITEM_REGION: cag_region_release(item->as.region); break;
    case CAG_ITEM_SURFACE: cag_surface_release(item->as.surface); break;
    case CAG_ITEM_SOLID: cag_solid_release(item->as.solid); break;
    case CAG_ITEM_MESH: cag_mesh_release(item->as.mesh); break;
    case CAG_ITEM_GROUND: break;
    }
  }
}

// The contents of a file, terminated by NUL; to be freed.
static inline char *read_whole(const char *path) {
  FILE *in = fopen(path, "rb");
  assert_non_null(in);
  fseek(in, 0, SEEK_END);
  long n = ftell(in);
  rewind(in);
  char *text = malloc((size_t)n + 1);
  assert_int_equal(fread(text, 1, (size_t)n, in), n);
  text[n] = 0;
  fclose(in);
  return text;
}

// Creates a folder for the files of one test program. scene_fixture's fixture_folder_remove removes
// it.
static inline void fixture_folder(char path[64]) {
  strcpy(path, "/tmp/cag-test-XXXXXX");
  assert_non_null(mkdtemp(path));
}
static inline void fixture_folder_remove(const char *path) {
  char command[128];
  snprintf(command, sizeof command, "rm -rf '%s'", path);
  assert_int_equal(system(command), 0);
}

// The signed volume between the triangles of a mesh and the origin.
static inline double volume_of(const CagMesh *m) {
  double v = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    v += cag_dot(m->positions[k[0]], cag_cross(m->positions[k[1]], m->positions[k[2]])) / 6;
  }
  return v;
}

#endif
