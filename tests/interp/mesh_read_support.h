// Mesh files in memory, in each format, written by hand.

#ifndef CAG_TESTS_INTERP_MESH_READ_SUPPORT_H
#define CAG_TESTS_INTERP_MESH_READ_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "geom/mesh/check.h"
#include "interp/formats/mesh_formats.h"
#include "interp/formats/mesh_read.h"

static CagError err;

// --- Files in memory ---

typedef struct Bytes {
  char *at;
  size_t n;
} Bytes;

static inline Bytes bytes_of(const void *data, size_t n) {
  Bytes b = {malloc(n + 1), n};
  if (!b.at) fail();
  memcpy(b.at, data, n);
  b.at[n] = 0;
  return b;
}

static inline void add(Bytes *b, const void *data, size_t n) {
  b->at = realloc(b->at, b->n + n + 1);
  if (!b->at) fail();
  memcpy(b->at + b->n, data, n);
  b->n += n;
  b->at[b->n] = 0;
}

static inline void add_u32(Bytes *b, uint32_t x) {
  const unsigned char c[4] = {x & 255, x >> 8 & 255, x >> 16 & 255, x >> 24};
  add(b, c, 4);
}

static inline void add_float(Bytes *b, float x) {
  uint32_t bits;
  memcpy(&bits, &x, 4);
  add_u32(b, bits);
}

static inline CagMeshFile file_of(const char *name, Bytes b) {
  return (CagMeshFile){
      .name = name, .bytes = b.at, .size = b.n, .max_triangles = 1000000, .max_memory = 1 << 28};
}

static inline CagMesh *read_bytes(const char *name, Bytes b) {
  CagMeshFile f = file_of(name, b);
  CagMesh *m = NULL;
  if (cag_mesh_read(&f, &m, &err) != CAG_OK) fail_msg("%s: %s", name, err.message);
  return m;
}

static inline CagMesh *read_text(const char *name, const char *text) {
  Bytes b = bytes_of(text, strlen(text));
  CagMesh *m = read_bytes(name, b);
  free(b.at);
  return m;
}

static inline void assert_fails(const char *name, Bytes b, const char *reason, const char *part) {
  CagMeshFile f = file_of(name, b);
  CagMesh *m = NULL;
  CagStatus status = cag_mesh_read(&f, &m, &err);
  if (status == CAG_OK) fail_msg("%s was read, expected %s", name, reason);
  if (strcmp(cag_error_info(err.id)->reason, reason) != 0)
    fail_msg("%s: %s: %s", name, cag_error_info(err.id)->reason, err.message);
  if (!strstr(err.message, part)) fail_msg("`%s` lacks `%s`", err.message, part);
}

static inline void assert_text_fails(const char *name, const char *text, const char *reason,
                                     const char *part) {
  Bytes b = bytes_of(text, strlen(text));
  assert_fails(name, b, reason, part);
  free(b.at);
}

// The corner of a cube: the tetrahedron of the origin and 2, 3, 4 on the axes has the volume 2 * 3
// * 4 / 6 = 4, and 4 points, 6 edges, and 4 faces.
static const float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
static const unsigned faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

static inline void assert_solid(const CagMesh *m, size_t vertices, size_t triangles,
                                double volume) {
  CagMeshCheck c;
  assert_int_equal(cag_mesh_check(m, &c, &err), CAG_OK);
  assert_int_equal(c.vertices, vertices);
  assert_int_equal(c.faces, triangles);
  assert_true(c.solid);
  assert_true(fabs(c.volume - volume) < 1e-12);
}

static inline void assert_tetrahedron(CagMesh *m) {
  assert_solid(m, 4, 4, 4);
  CagBounds b = cag_mesh_bounds(m);
  assert_true(b.max.x == 2 && b.max.y == 3 && b.max.z == 4 && cag_norm(b.min) == 0);
  cag_mesh_release(m);
}

static inline Bytes binary_stl(const char *header, uint32_t said) {
  char head[80] = {0};
  strncpy(head, header, sizeof head - 1);
  Bytes b = bytes_of(head, sizeof head);
  add_u32(&b, said);
  for (int t = 0; t < 4; t++) {
    for (int k = 0; k < 3; k++) add_float(&b, 0);
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 3; i++) add_float(&b, corners[faces[t][k]][i]);
    add(&b, "\0\0", 2);
  }
  return b;
}

static inline void put_number(Bytes *b, bool big, const void *x, size_t n) {
  const unsigned char *c = x;
  for (size_t k = 0; k < n; k++) add(b, c + (big ? n - 1 - k : k), 1); // on a little-endian machine
}

static inline Bytes binary_ply(bool big) {
  Bytes b = bytes_of("", 0);
  const char *head = "ply\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty double x\n"
                     "property float y\nproperty short z\nproperty float nx\nproperty float ny\n"
                     "property float nz\nproperty float s\nproperty float t\nelement face 4\n"
                     "property list ushort uint vertex_indices\nend_header\n";
  char text[400];
  add(&b, text, (size_t)snprintf(text, sizeof text, head, big ? "big" : "little"));
  for (int v = 0; v < 4; v++) {
    double x = corners[v][0];
    int16_t z = (int16_t)corners[v][2];
    float other[6] = {corners[v][1], 0, 0, 1, 0.5f, (float)v};
    put_number(&b, big, &x, 8);
    put_number(&b, big, &other[0], 4);
    put_number(&b, big, &z, 2);
    for (int k = 1; k < 6; k++) put_number(&b, big, &other[k], 4);
  }
  for (int t = 0; t < 4; t++) {
    uint16_t n = 3;
    put_number(&b, big, &n, 2);
    for (int k = 0; k < 3; k++) put_number(&b, big, &faces[t][k], 4);
  }
  return b;
}

// --- glTF ---

// The positions of the tetrahedron in glTF's axes and meters: our x, z, -y, divided by 1000.
static inline void add_positions(Bytes *b) {
  for (int v = 0; v < 4; v++) {
    add_float(b, corners[v][0] / 1000);
    add_float(b, corners[v][2] / 1000);
    add_float(b, -corners[v][1] / 1000);
  }
}

static inline Bytes glb(const char *json, const Bytes *data) {
  Bytes b = bytes_of("glTF\2\0\0\0", 8);
  size_t n = strlen(json), padded = (n + 3) / 4 * 4;
  add_u32(&b, (uint32_t)(12 + 8 + padded + 8 + data->n));
  add_u32(&b, (uint32_t)padded);
  add(&b, "JSON", 4);
  add(&b, json, n);
  add(&b, "   ", padded - n);
  add_u32(&b, (uint32_t)data->n);
  add(&b, "BIN\0", 4);
  add(&b, data->at, data->n);
  return b;
}

#define ASSET "{\"asset\": {\"version\": \"2.0\"}, "
#define BUFFER "\"buffers\": [{\"byteLength\": 60}], "
#define VIEWS                                                                                      \
  "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48}, {\"buffer\": 0, \"byteOffset\": 48, "    \
  "\"byteLength\": 12}], "
#define POSITIONS                                                                                  \
  "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 4, \"type\": "          \
  "\"VEC3\"}, "
#define INDICES                                                                                    \
  "{\"bufferView\": 1, \"componentType\": 5121, \"count\": 12, \"type\": \"SCALAR\"}], "
#define MESH "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"indices\": 1}]}]"
static const char plain_gltf[] = ASSET BUFFER VIEWS POSITIONS INDICES MESH "}";

static inline Bytes gltf_data(void) {
  Bytes data = bytes_of("", 0);
  add_positions(&data);
  for (int t = 0; t < 4; t++)
    for (int k = 0; k < 3; k++) add(&data, &(unsigned char){(unsigned char)faces[t][k]}, 1);
  return data;
}

static inline CagMesh *read_glb(const char *json, Bytes data) {
  Bytes b = glb(json, &data);
  CagMesh *m = read_bytes("a.glb", b);
  free(b.at);
  return m;
}

#endif
