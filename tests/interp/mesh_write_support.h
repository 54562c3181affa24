// Random scenes of meshes, and the files written from them.

#ifndef CAG_TESTS_INTERP_MESH_WRITE_SUPPORT_H
#define CAG_TESTS_INTERP_MESH_WRITE_SUPPORT_H

#include "tests/geom/random.h"
#include "tests/interp/scene_fixture.h"

#include <cjson/cJSON.h>
#include <zlib.h>

#include "interp/formats/mesh_copies.h"
#include "interp/formats/mesh_formats.h"
#include "interp/formats/mesh_read.h"
#include "interp/scene/color_scale.h"
#include "tests/interp/bytes.h"

#define PARTS 9

// --- Random meshes ---

static inline size_t below(size_t n) { return (size_t)uniform(0, (double)n - 1e-9); }

static inline CagVec3 random_unit(void) {
  CagVec3 v;
  do {
    v.x = uniform(-1, 1);
    v.y = uniform(-1, 1);
    v.z = uniform(-1, 1);
  } while (cag_norm(v) < 0.1 || cag_norm(v) > 1);
  return cag_unit(v);
}

// Integer coordinates, which are exact in single precision. Some vertices repeat an earlier one,
// some of these with the same normal. Some triangles have corners that single precision cannot
// distinguish.
static inline CagMesh *random_mesh(size_t vertices, size_t triangles, int features,
                                   bool shrinking) {
  CagMesh *m;
  const bool normals = features & 1, uv = features & 2, weld = features & 4;
  OK(cag_mesh_new(vertices, triangles, normals, uv, weld, &m, &err));
  for (size_t v = 0; v < vertices; v++) {
    const size_t like = v > 4 && below(3) == 0 ? below(v) : v;
    m->positions[v].x = floor(uniform(-1000, 1000));
    m->positions[v].y = floor(uniform(-1000, 1000));
    m->positions[v].z = floor(uniform(-1000, 1000));
    if (shrinking && v == 1) {
      m->positions[1] = m->positions[0];
      m->positions[1].x += 1e-9;
    }
    if (weld) m->weld[v] = (uint32_t)(like == v ? v : m->weld[like]);
    if (weld) m->positions[v] = m->positions[m->weld[v]];
    if (normals) m->normals[v] = random_unit();
    if (normals && like != v && below(2)) m->normals[v] = m->normals[like];
    if (uv) {
      m->uv[2 * v] = uniform(-1, 2);
      m->uv[2 * v + 1] = uniform(0, 1);
    }
  }
  for (size_t t = 0; t < triangles; t++) {
    uint32_t *k = m->triangles + 3 * t;
    do
      for (int j = 0; j < 3; j++) k[j] = (uint32_t)below(vertices);
    while (k[0] == k[1] || k[1] == k[2] || k[2] == k[0]);
    if (shrinking && t % 5 == 3) {
      const uint32_t other = (uint32_t)(2 + below(vertices - 2));
      const uint32_t corners[3] = {0, 1, other};
      for (uint32_t j = 0; j < 3; j++) k[j] = corners[(j + t) % 3];
    }
  }
  return m;
}

static inline bool same_position(const CagMesh *m, uint32_t a, uint32_t b) {
  const CagVec3 p = m->positions[a], q = m->positions[b];
  return (float)p.x == (float)q.x && (float)p.y == (float)q.y && (float)p.z == (float)q.z;
}

static inline bool shrinks(const CagMesh *m, size_t t) {
  const uint32_t *k = m->triangles + 3 * t;
  return same_position(m, k[0], k[1]) || same_position(m, k[1], k[2]) ||
         same_position(m, k[2], k[0]);
}

typedef struct Scene {
  CagMeshPart parts[PARTS];
  CagMesh *meshes[PARTS];
  CagMaterial materials[4];
  char names[PARTS][16];
  size_t count;
} Scene;

// Parts with all combinations of optional data. Part 1 is part 0 moved, part 2 is part 0 with
// another material, and part 8 is empty in single precision.
static inline void random_scene(Scene *s, int round) {
  static char *const names[] = {"red paint", "glass", "red paint", ""};
  *s = (Scene){.count = PARTS};
  static const size_t sizes[] = {5, 64, 65, 128, 129, 200, 1024, 1025, 2049};
  for (size_t i = 0; i < 4; i++) {
    CagMaterial *m = &s->materials[i];
    *m = (CagMaterial){.name = names[i], .texture = ""};
    m->color = (CagColor){uniform(-0.1, 1.1), uniform(0, 1), 0};
    m->color.b = uniform(-0.1, 1.1);
    m->metallic = i == 0 ? 0.75 : 0;
    m->roughness = i == 3 ? 0.1 : 0.25 * (double)(i + 1);
    m->ior = i == 1 ? 1.5 : i == 2 ? 0.5 : 1.2;
    m->transmission = i == 1 ? 0.25 : 0;
    m->coat = i == 2 ? 0.5 : 0;
    if (i == 3) m->emission = (CagColor){0.5, 4, 2};
    if (i == 2) m->emission = (CagColor){0.5, 0.25, 0};
  }
  for (size_t i = 0; i < PARTS; i++) {
    const int features = (int)((i + (size_t)round) % 8);
    const size_t n = sizes[(i * 4 + (size_t)round) % 9];
    const size_t triangles = sizes[(i + (size_t)round * 2) % 9];
    if (i == 1) {
      CagTransform turn, move = cag_translate(cag_vec3(100, -20, 3));
      OK(cag_rotate(cag_vec3(0, 0, 1), round % 3 ? M_PI / 2 : 0, cag_vec3(0, 0, 0), &turn, &err));
      move = cag_transform_multiply(&move, &turn);
      OK(cag_mesh_transform(s->meshes[0], &move, &s->meshes[1], &err));
    } else if (i == 2) s->meshes[2] = cag_mesh_retain(s->meshes[0]);
    else if (i == 6 && round == 2) // values as colors, in more than one batch
      s->meshes[i] = random_mesh(4500, 4500, 2, false);
    else s->meshes[i] = random_mesh(n, triangles, features, i % 2 == 0);
    CagMesh *m = s->meshes[i];
    if (m->uv && i % 3 == 0) {
      const int kinds[] = {CAG_SCALE_SEQUENCE, CAG_SCALE_DIVERGING, CAG_SCALE_STRIPES};
      m->scale = (CagColorScale){(CagColorScaleKind)kinds[round % 3], -0.5, 1.5, 4};
    }
    if (i == 1) m->scale = s->meshes[0]->scale;
    if (i == 8)
      for (size_t v = 0; v < m->vertex_count; v++) m->positions[v] = cag_vec3(1, 2, 3);
    snprintf(s->names[i], sizeof *s->names, "part %zu\t<&\">", i);
    CagMaterial *of = i == 2   ? &s->materials[1]
                      : i == 5 ? NULL
                               : &s->materials[i % 4 == 1 ? 0 : i % 4];
    s->parts[i] = (CagMeshPart){i == 4 ? NULL : s->names[i], m, of};
  }
}

static inline void scene_free(Scene *s) {
  for (size_t i = 0; i < PARTS; i++) cag_mesh_release(s->meshes[i]);
}

// --- Files ---

typedef CagStatus Export(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);

static inline CagStatus export_obj(const CagMeshPart *parts, size_t n, CagAtomicFile *file,
                                   CagError *err) {
  return cag_export_obj(parts, n, "a.mtl", file, err);
}
static inline CagStatus export_stl(const CagMeshPart *parts, size_t n, CagAtomicFile *file,
                                   CagError *err) {
  return cag_export_stl(parts, n, NULL, file, err);
}
static CagGltfData data;
static const char *stem;
static inline CagStatus export_gltf(const CagMeshPart *parts, size_t n, CagAtomicFile *file,
                                    CagError *err) {
  return cag_export_gltf(parts, n, stem, file, &data, err);
}

// Terminated by NUL.
static inline char *bytes_of(const CagMeshPart *parts, size_t n, Export *export, size_t *size) {
  CagError io;
  char *bytes, *text;
  CagAtomicFile *file = cag_atomic_file_open_memory(&io);
  assert_non_null(file);
  OK(export(parts, n, file, &err));
  assert_true(cag_atomic_file_commit_memory(file, &bytes, size, &io));
  text = malloc(*size + 1);
  if (*size > 0) memcpy(text, bytes, *size);
  text[*size] = 0;
  free(bytes);
  return text;
}

static inline CagVec3 vector_at(const char *p) {
  return cag_vec3(float_at(p), float_at(p + 4), float_at(p + 8));
}
static inline double distance(CagVec3 a, CagVec3 b) { return cag_norm(cag_sub(a, b)); }

static inline int srgb_byte(double linear) {
  const double c = fmin(fmax(linear, 0), 1);
  return (int)floor(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055) + 0.5);
}

#endif
