// Mesh files that are read: each format written by hand here, what is wrong with files, and files
// that were changed by chance.

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
#include "interp/export/mesh_formats.h"
#include "interp/import/mesh_read.h"

static CagError err;

// --- Files in memory ---

typedef struct Bytes {
  char *at;
  size_t n;
} Bytes;

static Bytes bytes_of(const void *data, size_t n) {
  Bytes b = {malloc(n + 1), n};
  if (!b.at) fail();
  memcpy(b.at, data, n);
  b.at[n] = 0;
  return b;
}

static void add(Bytes *b, const void *data, size_t n) {
  b->at = realloc(b->at, b->n + n + 1);
  if (!b->at) fail();
  memcpy(b->at + b->n, data, n);
  b->n += n;
  b->at[b->n] = 0;
}

static void add_u32(Bytes *b, uint32_t x) {
  const unsigned char c[4] = {x & 255, x >> 8 & 255, x >> 16 & 255, x >> 24};
  add(b, c, 4);
}

static void add_float(Bytes *b, float x) {
  uint32_t bits;
  memcpy(&bits, &x, 4);
  add_u32(b, bits);
}

static CagMeshFile file_of(const char *name, Bytes b) {
  return (CagMeshFile){
      .name = name, .bytes = b.at, .size = b.n, .max_triangles = 1000000, .max_memory = 1 << 28};
}

static CagMesh *read_bytes(const char *name, Bytes b) {
  CagMeshFile f = file_of(name, b);
  CagMesh *m = NULL;
  if (cag_mesh_read(&f, &m, &err) != CAG_OK) fail_msg("%s: %s", name, err.message);
  return m;
}

static CagMesh *read_text(const char *name, const char *text) {
  Bytes b = bytes_of(text, strlen(text));
  CagMesh *m = read_bytes(name, b);
  free(b.at);
  return m;
}

static void assert_fails(const char *name, Bytes b, const char *reason, const char *part) {
  CagMeshFile f = file_of(name, b);
  CagMesh *m = NULL;
  CagStatus status = cag_mesh_read(&f, &m, &err);
  if (status == CAG_OK) fail_msg("%s was read, expected %s", name, reason);
  if (strcmp(err.reason, reason) != 0) fail_msg("%s: %s: %s", name, err.reason, err.message);
  if (!strstr(err.message, part)) fail_msg("`%s` lacks `%s`", err.message, part);
}

static void assert_text_fails(const char *name, const char *text, const char *reason,
                              const char *part) {
  Bytes b = bytes_of(text, strlen(text));
  assert_fails(name, b, reason, part);
  free(b.at);
}

// The corner of a cube: the tetrahedron of the origin and 2, 3, 4 on the axes has the volume
// 2 * 3 * 4 / 6 = 4, and 4 points, 6 edges, 4 faces.
static const float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
static const unsigned faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

static void assert_tetrahedron(CagMesh *m) {
  CagMeshCheck c;
  assert_int_equal(cag_mesh_check(m, &c, &err), CAG_OK);
  assert_int_equal(c.vertices, 4);
  assert_int_equal(c.faces, 4);
  assert_true(c.solid);
  assert_true(fabs(c.volume - 4) < 1e-12);
  CagBounds b = cag_mesh_bounds(m);
  assert_true(b.max.x == 2 && b.max.y == 3 && b.max.z == 4 && cag_norm(b.min) == 0);
  cag_mesh_release(m);
}

// --- STL ---

static Bytes binary_stl(const char *header, uint32_t said) {
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

static void binary_stl_is_welded(void **state) {
  (void)state;
  Bytes b = binary_stl("made elsewhere", 4);
  CagMesh *m = read_bytes("part.stl", b);
  assert_int_equal(m->vertex_count, 4);
  assert_null(m->weld);
  assert_tetrahedron(m);
  assert_tetrahedron(read_bytes("part.unknown", b)); // its length tells
  free(b.at);
}

static void binary_stl_may_begin_with_solid(void **state) {
  (void)state;
  Bytes b = binary_stl("solid facet of some program", 4);
  assert_tetrahedron(read_bytes("part.stl", b));
  free(b.at);
}

static void text_stl_is_read_with_its_liberties(void **state) {
  (void)state;
  char text[4096] = "\n  SOLID a name\n";
  for (int t = 0; t < 4; t++) {
    strcat(text, t % 2 ? "facet normal nan 0 -nan\r\n  outer loop\r\n" : "facet outer\tloop\n");
    for (int k = 0; k < 3; k++) {
      const float *p = corners[faces[t][k]];
      char line[80];
      snprintf(line, sizeof line, "    vertex %.6e %+g %g\n", p[0], p[1], p[2]);
      strcat(text, line);
    }
    strcat(text, "endloop endfacet\n");
    if (t == 1) strcat(text, "endsolid a name\n\nsolid\n");
  }
  strcat(text, "endsolid");
  assert_tetrahedron(read_text("part.stl", text));
  assert_tetrahedron(read_text("part", text));
}

static void what_is_wrong_with_an_stl_is_told(void **state) {
  (void)state;
  Bytes b = binary_stl("x", 5);
  assert_fails("a.stl", b, "mesh-file-truncated", "5 triangles, and its 284 bytes hold 4");
  b.at[80] = 4;
  b.n -= 10;
  assert_fails("a.stl", b, "mesh-file-truncated", "byte 80");
  b.n = 20;
  assert_fails("a.stl", b, "mesh-file-truncated", "84");
  free(b.at);
  assert_text_fails("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 q\n",
                    "mesh-file-syntax", "line 5");
  assert_text_fails("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0\n",
                    "mesh-file-truncated", "line 6");
  assert_text_fails("a.stl", "solid\nfacet\nouter loop\nvertex 0 0 1e999\n", "mesh-file-number",
                    "line 4");
  assert_text_fails("a.stl", "solid\nendsolid\n", "mesh-file-empty", "no triangle");
  assert_text_fails("a.stl", "", "mesh-file-truncated", "0 bytes");
  assert_text_fails("a.xyz", "", "mesh-file-kind", "empty");
  assert_text_fails("a.xyz", "1 2 3", "mesh-file-kind", ".stl");
}

// --- OBJ ---

static void obj_has_polygons_and_numbers_from_the_end(void **state) {
  (void)state;
  // A cube of side 2: quads, one concave octagon would not add anything; negative numbers, groups,
  // a line that goes on, vertices with colors.
  CagMesh *m = read_text("cube.obj", "# a cube\nmtllib none.mtl\no cube\n"
                                     "v 0 0 0\nv 2 0 0 0.5 0.5 0.5\nv 2 2 0\nv 0 2 0\n"
                                     "v 0 0 2\r\nv 2 0 2\r\nv 2 2 2\r\nv 0 2 2\r\n"
                                     "g sides\nusemtl red\ns 1\n"
                                     "f 1 4 3 2\nf -4 -3 -2 -1\nf 1 2 \\\n 6 5\n"
                                     "f 2 3 7 6\nf 3 4 8 7\nf 4/ 1// 5 8\nl 1 2\np 1\n");
  CagMeshCheck c;
  assert_int_equal(cag_mesh_check(m, &c, &err), CAG_OK);
  assert_int_equal(c.vertices, 8);
  assert_int_equal(c.faces, 12);
  assert_true(c.solid);
  assert_true(fabs(c.volume - 8) < 1e-12);
  cag_mesh_release(m);
  // An L of area 3, as one polygon.
  m = read_text("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n");
  assert_int_equal(m->triangle_count, 4);
  assert_true(fabs(cag_mesh_area(m) - 3) < 1e-12);
  cag_mesh_release(m);
}

// 3000 corners that jump about a circle: a fan, at once, and not what takes a triangulation hours.
static void tangled_polygons_are_taken_as_fans(void **state) {
  (void)state;
  enum { CORNERS = 3000, JUMP = 1111 };
  Bytes b = bytes_of("", 0);
  char line[80];
  const double step = 2 * 3.14159265358979323846 / CORNERS;
  for (int k = 0; k < CORNERS; k++)
    add(&b, line,
        (size_t)snprintf(line, sizeof line, "v %.9f %.9f 0\n", cos(k * step), sin(k * step)));
  Bytes ring = bytes_of(b.at, b.n);
  add(&b, "f", 1);
  add(&ring, "f", 1);
  for (int k = 0; k < CORNERS; k++) {
    add(&b, line, (size_t)snprintf(line, sizeof line, " %d", k * JUMP % CORNERS + 1));
    add(&ring, line, (size_t)snprintf(line, sizeof line, " %d", k + 1));
  }
  CagMesh *m = read_bytes("a.obj", b);
  assert_int_equal(m->triangle_count, CORNERS - 2);
  cag_mesh_release(m);
  // One without crossings has the area of the regular polygon.
  m = read_bytes("a.obj", ring);
  assert_int_equal(m->triangle_count, CORNERS - 2);
  assert_true(fabs(cag_mesh_area(m) - CORNERS / 2.0 * sin(step)) < 1e-6);
  cag_mesh_release(m);
  free(b.at);
  free(ring.at);
}

static void obj_keeps_normals_and_parameters(void **state) {
  (void)state;
  CagMesh *m = read_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
                                  "vt 0 0\nvt 1 0\nvt 0.25 0.75\nvn 0 0 2\nvn 0 3 4\n"
                                  "f 1/1/1 2/2/1 3/3/1\nf 2/2/2 4//2 3/3/2\n");
  assert_int_equal(m->vertex_count, 6); // two points with two normals each
  assert_true(m->uv[4] == 0.25 && m->uv[5] == 0.75);
  assert_true(m->normals[0].z == 1);
  assert_true(fabs(m->normals[4].y - 0.6) < 1e-15 && fabs(m->normals[4].z - 0.8) < 1e-15);
  assert_int_equal(m->weld[3], 1); // vertex 3 is point 2 again
  assert_int_equal(m->weld[4], 4);
  assert_int_equal(m->weld[5], 2);
  cag_mesh_release(m);
  // Where a face says no normal, it is that of the face.
  m = read_text("a.obj",
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\n");
  assert_true(m->normals[3].x == 1 && m->normals[4].x == 1);
  cag_mesh_release(m);
}

static void what_is_wrong_with_an_obj_is_told(void **state) {
  (void)state;
  assert_text_fails("a.obj", "v 0 0\n", "mesh-file-syntax", "line 1");
  assert_text_fails("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n", "mesh-file-syntax", "line 4");
  assert_text_fails("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "mesh-file-index", "point 0");
  assert_text_fails("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n", "mesh-file-index", "-4");
  assert_text_fails("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2 3\n", "mesh-file-index", "vt 1");
  assert_text_fails("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n",
                    "mesh-file-syntax", "line 4");
  assert_text_fails("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\n", "mesh-file-empty", "");
  assert_text_fails("a.obj", "v 0 0 0\nv 0 0 0\nv 2 0 0\nf 1 2 3\n", "mesh-file-empty", "area");
}

// --- PLY ---

static void ply_as_text_has_other_properties_too(void **state) {
  (void)state;
  CagMesh *m = read_text(
      "a.ply", "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement material 1\n"
               "property list uchar float values\nproperty int kind\nelement vertex 4\n"
               "property float quality\nproperty double z\nproperty double x\nproperty double y\n"
               "property list uint8 int32 neighbours\nelement face 4\nproperty uchar flags\n"
               "property list uint8 uint16 vertex_index\nproperty float area\nend_header\n"
               "2 1.5 nan 7\n0.5 0 0 0 0\n0.5 0 2 0 1 3\n0.5 0 0 3 0\ninf 4 0 0 2 1 2\n"
               "1 3 0 2 1 0\n1 3 0 1 3 0\n1 3 0 3 2 0\n1 3 1 2 3 0\n");
  assert_tetrahedron(m);
}

static void put_number(Bytes *b, bool big, const void *x, size_t n) {
  const unsigned char *c = x;
  for (size_t k = 0; k < n; k++) add(b, c + (big ? n - 1 - k : k), 1); // of a little-endian machine
}

static Bytes binary_ply(bool big) {
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

static void binary_ply_of_either_end_is_read(void **state) {
  (void)state;
  for (int big = 0; big < 2; big++) {
    Bytes b = binary_ply(big);
    CagMesh *m = read_bytes("a.ply", b);
    assert_true(m->normals[2].z == 1);
    assert_true(m->uv[0] == 0.5 && m->uv[7] == 3);
    assert_tetrahedron(m);
    for (size_t n = b.n - 1; n > 200; n -= 7) { // cut anywhere
      Bytes cut = bytes_of(b.at, n);
      CagMeshFile f = file_of("a.ply", cut);
      CagMesh *none = NULL;
      assert_int_equal(cag_mesh_read(&f, &none, &err), CAG_E_ARGUMENT);
      free(cut.at);
    }
    free(b.at);
  }
}

static void strips_of_a_ply_are_turned_in_turn(void **state) {
  (void)state;
  CagMesh *m =
      read_text("a.ply", "ply\nformat ascii 1.0\nelement vertex 6\nproperty int x\nproperty int y\n"
                         "property int z\nelement tristrips 1\n"
                         "property list int int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n11 0 1 2 3 -1 2 3 4 5 -1 0\n");
  assert_int_equal(m->triangle_count, 4);
  for (size_t t = 0; t < 4; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    assert_true(n.z == 1);
  }
  cag_mesh_release(m);
}

static void what_is_wrong_with_a_ply_is_told(void **state) {
  (void)state;
#define HEAD "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
#define FACES                                                                                      \
  "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
  assert_text_fails("a.ply", HEAD "end_header\n0 0\n0 0\n0 0\n", "mesh-file-syntax", "x, y or z");
  assert_text_fails("a.ply", HEAD FACES "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "mesh-file-index",
                    "vertex 3; there are 3");
  assert_text_fails("a.ply", HEAD FACES "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "mesh-file-truncated", "");
  assert_text_fails("a.ply", HEAD FACES "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", "mesh-file-syntax",
                    "line 11");
  assert_text_fails("a.ply", HEAD FACES "0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", "mesh-file-number",
                    "vertex 1");
  assert_text_fails("a.ply", HEAD FACES "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "mesh-file-syntax",
                    "count of a list");
  assert_text_fails("a.ply", HEAD, "mesh-file-truncated", "end_header");
  assert_text_fails("a.ply",
                    "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\n"
                    "property float x\nproperty float y\nproperty float z\nend_header\n",
                    "mesh-file-truncated", "4000000000000 elements of at least 12 bytes");
  assert_text_fails("a.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", "mesh-file-syntax",
                    "line 3");
}

// --- glTF ---

// Positions of the tetrahedron in glTF's axes and meters: x, z, -y of ours, by 1000.
static void add_positions(Bytes *b) {
  for (int v = 0; v < 4; v++) {
    add_float(b, corners[v][0] / 1000);
    add_float(b, corners[v][2] / 1000);
    add_float(b, -corners[v][1] / 1000);
  }
}

static Bytes glb(const char *json, const Bytes *data) {
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

static Bytes gltf_data(void) {
  Bytes data = bytes_of("", 0);
  add_positions(&data);
  for (int t = 0; t < 4; t++)
    for (int k = 0; k < 3; k++) add(&data, &(unsigned char){(unsigned char)faces[t][k]}, 1);
  return data;
}

static CagMesh *read_glb(const char *json, Bytes data) {
  Bytes b = glb(json, &data);
  CagMesh *m = read_bytes("a.glb", b);
  free(b.at);
  return m;
}

static void glb_is_turned_and_scaled(void **state) {
  (void)state;
  Bytes data = gltf_data();
  CagMesh *m = read_glb(plain_gltf, data);
  CagBounds b = cag_mesh_bounds(m);
  // Thousandths are rounded to single precision.
  assert_true(fabs(b.max.x - 2) < 1e-6 && fabs(b.max.y - 3) < 1e-6 && fabs(b.max.z - 4) < 1e-6);
  CagMeshCheck c;
  assert_int_equal(cag_mesh_check(m, &c, &err), CAG_OK);
  assert_true(c.solid && fabs(c.volume - 4) < 1e-5);
  cag_mesh_release(m);
  free(data.at);
}

static void nodes_move_scale_and_mirror(void **state) {
  (void)state;
  Bytes data = gltf_data();
  // Twice: moved by 10 along its z after doubling; mirrored by a matrix, moved by 1 along y.
  CagMesh *m =
      read_glb(ASSET BUFFER VIEWS POSITIONS INDICES MESH
               ", \"scene\": 1, \"scenes\": [{}, {\"nodes\": [2]}], \"nodes\": ["
               "{\"mesh\": 0, \"scale\": [2, 2, 2]}, "
               "{\"mesh\": 0, \"matrix\": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0.001,0,1]}, "
               "{\"children\": [0, 3], \"rotation\": [0, 0, 0, 3], \"translation\": [0, 0, 0.01]}, "
               "{\"children\": [1]}]}",
               data);
  CagMeshCheck c;
  assert_int_equal(cag_mesh_check(m, &c, &err), CAG_OK);
  assert_int_equal(c.shells, 2);
  assert_true(fabs(c.volume - (8 * 4 + 4)) < 1e-4);
  CagBounds b = cag_mesh_bounds(m);
  assert_true(fabs(b.min.x + 2) < 1e-5 && fabs(b.max.x - 4) < 1e-5);
  assert_true(fabs(b.min.y + 10) < 1e-5 && fabs(b.max.y + 4) < 1e-5); // glTF's z is our -y
  assert_true(fabs(b.max.z - 8) < 1e-5 && b.min.z == 0);
  cag_mesh_release(m);
  free(data.at);
}

// v turned by a quaternion of any length: t = 2 q x v, v + w t + q x t.
static CagVec3 turned(const double q[4], CagVec3 v) {
  const double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const CagVec3 u = cag_vec3(q[0] / n, q[1] / n, q[2] / n);
  const CagVec3 t = cag_scaled(cag_cross(u, v), 2);
  return cag_add(cag_madd(v, q[3] / n, t), cag_cross(u, t));
}

// A node in a node, each scaled, turned, and moved by any numbers. Meters with Y up become
// millimeters with Z up.
static void nodes_stand_where_their_numbers_say(void **state) {
  (void)state;
  Bytes data = gltf_data();
  uint64_t x = 5;
  for (int round = 0; round < 40; round++) {
    double n[20];
    for (int i = 0; i < 20; i++) {
      x = x * 6364136223846793005u + 1442695040888963407u;
      n[i] = (double)(x >> 11) / 4503599627370496.0 - 1;
    }
    if (round % 4 == 1) n[7] = -n[7] - 2; // a mirror
    char json[2000];
    snprintf(json, sizeof json,
             ASSET BUFFER VIEWS POSITIONS INDICES MESH
             ", \"nodes\": [{\"mesh\": 0, \"scale\": [%.17g, %.17g, %.17g], "
             "\"rotation\": [%.17g, %.17g, %.17g, %.17g], \"translation\": [%.17g, %.17g, %.17g]}, "
             "{\"children\": [0], \"scale\": [%.17g, %.17g, %.17g], "
             "\"rotation\": [%.17g, %.17g, %.17g, %.17g], "
             "\"translation\": [%.17g, %.17g, %.17g]}], \"scenes\": [{\"nodes\": [1]}]}",
             n[7], n[8], n[9], n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[17], n[18], n[19], n[10],
             n[11], n[12], n[13], n[14], n[15], n[16]);
    CagMesh *m = read_glb(json, data);
    assert_int_equal(m->triangle_count, 4);
    for (int k = 0; k < 4; k++) {
      // Corners are told in thousandths, with Y up, in single precision.
      const float given[3] = {corners[k][0] / 1000, corners[k][2] / 1000, -corners[k][1] / 1000};
      CagVec3 p = cag_vec3(given[0], given[1], given[2]);
      for (int i = 0; i < 2; i++) {
        const double *of = n + 10 * i;
        p = turned(of, cag_vec3(of[7] * p.x, of[8] * p.y, of[9] * p.z));
        p = cag_add(p, cag_vec3(of[4], of[5], of[6]));
      }
      p = cag_vec3(1000 * p.x, -1000 * p.z, 1000 * p.y);
      double least = INFINITY;
      for (size_t v = 0; v < m->vertex_count; v++)
        least = fmin(least, cag_norm(cag_sub(m->positions[v], p)));
      if (!(least < 1e-9 * 1000)) fail_msg("round %d: corner %d is %g off", round, k, least);
    }
    cag_mesh_release(m);
  }
  free(data.at);
}

// Normals stay perpendicular to what they were perpendicular to, whatever the scale, and look to
// the same side of their triangles, also in a mirror.
static void normals_go_with_their_nodes(void **state) {
  (void)state;
  uint64_t x = 7;
  Bytes data = gltf_data();
  for (int t = 0; t < 4; t++) { // behind the 60 bytes: a normal for each corner
    const float n[3] = {(float)(0.3 * t - 0.5), (float)(0.7 - 0.2 * t), 0.4f};
    for (int k = 0; k < 3; k++) add_float(&data, n[k]);
  }
  for (int round = 0; round < 30; round++) {
    double n[7];
    for (int i = 0; i < 7; i++) {
      x = x * 6364136223846793005u + 1442695040888963407u;
      n[i] = (double)(x >> 11) / 4503599627370496.0 - 1;
    }
    for (int i = 4; i < 7; i++) n[i] += n[i] < 0 ? -0.2 : 0.2;
    char json[2000];
    snprintf(json, sizeof json,
             ASSET "\"buffers\": [{\"byteLength\": 108}], "
                   "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 48}, {\"buffer\": 0, "
                   "\"byteOffset\": 48, \"byteLength\": 12}, {\"buffer\": 0, \"byteOffset\": 60, "
                   "\"byteLength\": 48}], " POSITIONS
                   "{\"bufferView\": 1, \"componentType\": 5121, \"count\": 12, \"type\": "
                   "\"SCALAR\"}, {\"bufferView\": 2, \"componentType\": 5126, \"count\": 4, "
                   "\"type\": \"VEC3\"}], \"meshes\": [{\"primitives\": [{\"attributes\": "
                   "{\"POSITION\": 0, \"NORMAL\": 2}, \"indices\": 1}]}], "
                   "\"nodes\": [{\"mesh\": 0, \"rotation\": [%.17g, %.17g, %.17g, %.17g], "
                   "\"scale\": [%.17g, %.17g, %.17g]}]}",
             n[0], n[1], n[2], n[3], n[4], n[5], n[6]);
    CagMesh *m = read_glb(json, data);
    const bool mirror = n[4] * n[5] * n[6] < 0;
    assert_int_equal(m->triangle_count, 4);
    for (size_t t = 0; t < 4; t++) {
      size_t seen = 0;
      for (int j = 0; j < 3; j++) {
        const unsigned c = faces[t][mirror ? (j == 0 ? 0 : 3 - j) : j];
        const float g[3] = {(float)(0.3 * c - 0.5), (float)(0.7 - 0.2 * c), 0.4f};
        // The inverse of the scale, then the turn, then Z up.
        CagVec3 v = turned(n, cag_vec3(g[0] / n[4], g[1] / n[5], g[2] / n[6]));
        v = cag_unit(cag_vec3(v.x, -v.z, v.y));
        const CagVec3 found = m->normals[m->triangles[3 * t + (size_t)j]];
        seen += cag_norm(cag_sub(found, v)) < 1e-6;
      }
      if (seen != 3) fail_msg("round %d, triangle %zu: %zu normals", round, t, seen);
    }
    cag_mesh_release(m);
  }
  free(data.at);
}

// Normals of a PLY need three numbers and parameters two.
static void a_ply_may_lack_a_part_of_its_normals(void **state) {
  (void)state;
  static const struct {
    const char *names[3];
    bool normals, uv;
  } cases[] = {{{"nx", "ny", "nz"}, true, false}, {{"nx", "ny", "a"}, false, false},
               {{"nx", "a", "nz"}, false, false}, {{"a", "ny", "nz"}, false, false},
               {{"s", "t", "a"}, false, true},    {{"s", "a", "b"}, false, false},
               {{"a", "b", "t"}, false, false},   {{"a", "b", "c"}, false, false}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[600];
    snprintf(text, sizeof text,
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
             "property float z\nproperty float %s\nproperty float %s\nproperty float %s\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0 3 0 4\n1 0 0 3 0 4\n0 1 0 3 0 4\n3 0 1 2\n",
             cases[i].names[0], cases[i].names[1], cases[i].names[2]);
    CagMesh *m = read_text("a.ply", text);
    assert_int_equal(m->triangle_count, 1);
    assert_true((m->normals != NULL) == cases[i].normals && (m->uv != NULL) == cases[i].uv);
    if (m->normals) assert_true(cag_norm(cag_sub(m->normals[0], cag_vec3(0.6, 0, 0.8))) < 1e-12);
    if (m->uv) assert_true(m->uv[0] == 3 && m->uv[1] == 0);
    cag_mesh_release(m);
  }
}

// Extensions that change nothing about triangles may be required, others not.
static void required_extensions_are_known(void **state) {
  (void)state;
  static const struct {
    const char *names;
    bool read;
  } cases[] = {{"", true},
               {"\"KHR_materials_ior\"", true},
               {"\"KHR_materials_ior\", \"KHR_texture_transform\"", true},
               {"\"KHR_lights_punctual\", \"KHR_mesh_quantization\", \"EXT_texture_webp\"", true},
               {"\"KHR_xmp\"", true},
               {"\"KHR_draco_mesh_compression\"", false},
               {"\"KHR_materials_ior\", \"EXT_meshopt_compression\"", false},
               {"\"EXT_meshopt_compression\", \"KHR_materials_ior\"", false},
               {"5", false}};
  Bytes data = gltf_data();
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char json[1500];
    snprintf(json, sizeof json,
             ASSET BUFFER VIEWS POSITIONS INDICES MESH ", \"extensionsRequired\": [%s]}",
             cases[i].names);
    Bytes b = glb(json, &data);
    if (cases[i].read) cag_mesh_release(read_bytes("a.glb", b));
    else assert_fails("a.glb", b, "mesh-file-unsupported", "write it without");
    free(b.at);
  }
  free(data.at);
}

// A large grid of quads with its vertices in any order, once as one mesh and once with each corner
// told again for each face: the same points.
static void many_corners_are_numbered_once(void **state) {
  (void)state;
  enum { N = 60 };
  Bytes b = bytes_of("", 0);
  char line[100];
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      add(&b, line, (size_t)snprintf(line, sizeof line, "v %d %d %d\n", i, j, i * j % 7));
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++)
      add(&b, line,
          (size_t)snprintf(line, sizeof line, "vn %d %d 1\nvt %g %g\n", i % 3, j % 2, i / 64.0,
                           j / 64.0));
  for (int i = 0; i + 1 < N; i++)
    for (int j = 0; j + 1 < N; j++) {
      const int a = i * N + j + 1, c = a + N;
      add(&b, line,
          (size_t)snprintf(line, sizeof line, "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, c,
                           c, c, c + 1, c + 1, c + 1, a + 1, a + 1, a + 1));
    }
  CagMesh *m = read_bytes("grid.obj", b);
  assert_int_equal(m->vertex_count, N * N);
  assert_int_equal(m->triangle_count, 2 * (N - 1) * (N - 1));
  for (size_t v = 0; v < m->vertex_count; v++) {
    const CagVec3 p = m->positions[v];
    const int i = (int)p.x, j = (int)p.y;
    assert_true(p.z == i * j % 7);
    const CagVec3 n = cag_unit(cag_vec3(i % 3, j % 2, 1));
    assert_true(cag_norm(cag_sub(m->normals[v], n)) < 1e-12);
    assert_true(m->uv[2 * v] == i / 64.0 && m->uv[2 * v + 1] == j / 64.0);
  }
  double area = 0; // seen from above
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 p = m->positions[k[0]], q = m->positions[k[1]], r = m->positions[k[2]];
    const double part = cag_cross(cag_sub(q, p), cag_sub(r, p)).z / 2;
    assert_true(part == 0.5);
    area += part;
  }
  assert_true(area == (N - 1) * (N - 1));
  cag_mesh_release(m);
  free(b.at);
}

static void sparse_accessors_strips_and_fans_are_read(void **state) {
  (void)state;
  // Four corners of a square that are zeros, three of them replaced, in 16-bit and 8-bit numbers.
  Bytes data = bytes_of("", 0);
  const unsigned short index[3] = {1, 2, 3};
  const signed char value[9] = {127, 0, 0, 0, 0, -127, 127, 0, -127};
  add(&data, index, sizeof index);
  add(&data, "\0\0", 2);
  add(&data, value, sizeof value);
  for (int mode = 5; mode <= 6; mode++) {
    char json[1200];
    snprintf(json, sizeof json,
             ASSET
             "\"buffers\": [{\"byteLength\": 17}], \"bufferViews\": ["
             "{\"buffer\": 0, \"byteLength\": 6}, {\"buffer\": 0, \"byteOffset\": 8, "
             "\"byteLength\": 9}], \"accessors\": [{\"componentType\": 5120, \"normalized\": "
             "true, \"count\": 4, \"type\": \"VEC3\", \"sparse\": {\"count\": 3, \"indices\": "
             "{\"bufferView\": 0, \"componentType\": 5123}, \"values\": {\"bufferView\": 1}}}],"
             " \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"mode\": "
             "%d}]}]}",
             mode);
    CagMesh *m = read_glb(json, data);
    // A square of 1 m: as a strip whole; the fan goes over the corner in its middle and back.
    assert_int_equal(m->triangle_count, 2);
    assert_true(fabs(cag_mesh_area(m) - 1e6) < 1e-6);
    for (size_t t = 0; t < 2; t++) {
      const uint32_t *k = m->triangles + 3 * t;
      CagVec3 a = m->positions[k[0]];
      CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
      assert_true(mode == 5 || t == 0 ? n.z > 0 : n.z < 0);
    }
    cag_mesh_release(m);
  }
  free(data.at);
}

static CagStatus open_buffer(void *context, const char *path, char **bytes, size_t *n,
                             CagError *e) {
  const Bytes *b = context;
  if (strcmp(path, "my part.bin") != 0)
    return cag_fail(e, CAG_E_CALLBACK, "file", "", -1, "no such file");
  *bytes = bytes_of(b->at, b->n).at;
  *n = b->n;
  return CAG_OK;
}

static void buffers_may_be_text_or_beside(void **state) {
  (void)state;
  // 0 0 0, 1 0 0, 0 0 -1 as floats in base64, by coreutils.
  CagMesh *m = read_text(
      "a.gltf", ASSET
      "\"buffers\": [{\"byteLength\": 36, \"uri\": "
      "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/"
      "\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36, \"byteStride\": 12}], "
      "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": "
      "\"VEC3\"}], \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}]}");
  assert_true(fabs(cag_mesh_area(m) - 5e5) < 1e-6);
  assert_true(m->positions[2].y == 1000);
  cag_mesh_release(m);
  Bytes data = gltf_data();
  const char *json =
      ASSET "\"buffers\": [{\"byteLength\": 60, \"uri\": \"my%20part.bin\"}], " VIEWS POSITIONS
          INDICES MESH "}";
  Bytes b = bytes_of(json, strlen(json));
  CagMeshFile f = file_of("a.gltf", b);
  f.open = open_buffer;
  f.context = &data;
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_OK);
  assert_int_equal(m->triangle_count, 4);
  cag_mesh_release(m);
  data.n = 59;
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_ARGUMENT);
  assert_string_equal(err.reason, "mesh-file-truncated");
  free(b.at);
  free(data.at);
}

static void what_is_wrong_with_a_gltf_is_told(void **state) {
  (void)state;
  static const struct {
    const char *json, *reason, *part;
  } bad[] = {
      {ASSET, "mesh-file-truncated", "JSON"},
      {ASSET "]}", "mesh-file-syntax", "line 1"},
      {"{}", "mesh-file-syntax", "asset"},
      {"{\"asset\": {\"version\": \"1.0\"}}", "mesh-file-unsupported", "1.0"},
      {ASSET "\"meshes\": []}", "mesh-file-empty", ""},
      {ASSET "\"buffers\": [{\"byteLength\": 9, \"uri\": \"http://a.b/c\"}]}",
       "mesh-file-unsupported", "http"},
      {ASSET "\"buffers\": [{\"byteLength\": -1}]}", "mesh-file-syntax", "byteLength"},
      {ASSET "\"buffers\": [{\"byteLength\": 1e300}]}", "mesh-file-syntax", "byteLength"},
      {ASSET "\"buffers\": [{\"byteLength\": 9000000000000}]}", "mesh-file-truncated",
       "buffers[0]"},
      {ASSET "\"nodes\": [{\"children\": [0]}], \"scenes\": [{\"nodes\": [0]}]}",
       "mesh-file-syntax", "twice"},
      {ASSET "\"nodes\": [{\"mesh\": 4}]}", "mesh-file-index", "nodes[0]"},
      {ASSET "\"nodes\": [{\"matrix\": [1]}]}", "mesh-file-syntax", "matrix"},
      {ASSET "\"scene\": 3, \"scenes\": []}", "mesh-file-index", "scene"},
      {ASSET "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 2}}]}]}",
       "mesh-file-index", "accessor"},
      {ASSET "\"meshes\": [{\"primitives\": [{\"extensions\": "
             "{\"KHR_draco_mesh_compression\": {}}}]}]}",
       "mesh-file-unsupported", "draco"},
      {ASSET "\"accessors\": [{\"componentType\": 5126, \"count\": 3, \"type\": \"VEC2\"}], "
             "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}]}",
       "mesh-file-syntax", "VEC3"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    assert_text_fails("a.gltf", bad[i].json, bad[i].reason, bad[i].part);
  Bytes data = gltf_data();
  data.at[50] = 9;
  Bytes b = glb(plain_gltf, &data);
  assert_fails("a.glb", b, "mesh-file-index", "vertex 9, of 4");
  b.n -= 4;
  assert_fails("a.glb", b, "mesh-file-truncated", "bytes of the");
  free(b.at);
  free(data.at);
}

// --- Limits ---

static void limits_hold_before_memory_is_taken(void **state) {
  (void)state;
  Bytes b = binary_stl("x", 4);
  CagMeshFile f = file_of("a.stl", b);
  CagMesh *m = NULL;
  f.max_triangles = 3;
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_LIMIT);
  assert_string_equal(err.reason, "triangle-limit");
  f.max_triangles = 4;
  f.max_memory = 300; // 12 corners alone take 288
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_MEMORY);
  volatile int stop = 1;
  f.max_memory = 1 << 20;
  f.interrupt = &stop;
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_CALLBACK);
  free(b.at);
  // A billion points of which the file says nothing: zeros without bytes.
  const char *json =
      ASSET "\"accessors\": [{\"componentType\": 5126, \"count\": 3000000, \"type\": \"VEC3\"}], "
            "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}]}";
  b = bytes_of(json, strlen(json));
  f = file_of("a.gltf", b);
  f.max_memory = 1 << 20;
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_MEMORY);
  free(b.at);
}

// --- Round trips ---

static Bytes exported(CagMesh *m, CagStatus (*write)(const CagMeshPart *, size_t, CagAtomicFile *,
                                                     CagError *)) {
  const CagMeshPart parts[2] = {{"a", m, NULL}, {"b", m, NULL}};
  CagIoError io;
  Bytes b = {0};
  CagAtomicFile *f = cag_atomic_file_open_memory(&io);
  assert_non_null(f);
  assert_int_equal(write(parts, 1, f, &err), CAG_OK);
  assert_true(cag_atomic_file_commit_memory(f, &b.at, &b.n, &io));
  return b;
}

static CagStatus export_obj(const CagMeshPart *p, size_t n, CagAtomicFile *f, CagError *e) {
  return cag_export_obj(p, n, NULL, f, e);
}
static CagStatus export_stl(const CagMeshPart *p, size_t n, CagAtomicFile *f, CagError *e) {
  return cag_export_stl(p, n, NULL, f, e);
}
static CagStatus export_gltf(const CagMeshPart *p, size_t n, CagAtomicFile *f, CagError *e) {
  return cag_export_gltf(p, n, NULL, f, &(CagGltfData){0}, e);
}

static void what_was_written_is_read(void **state) {
  (void)state;
  Bytes b = binary_stl("x", 4);
  CagMesh *m = read_bytes("a.stl", b);
  free(b.at);
  static const struct {
    const char *name;
    CagStatus (*write)(const CagMeshPart *, size_t, CagAtomicFile *, CagError *);
  } formats[] = {{"a.obj", export_obj},
                 {"a.stl", export_stl},
                 {"a.ply", cag_export_ply},
                 {"a.glb", cag_export_glb},
                 {"a.gltf", export_gltf}};
  for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
    b = exported(m, formats[i].write);
    assert_tetrahedron(read_bytes(formats[i].name, b));
    free(b.at);
  }
  cag_mesh_release(m);
}

// --- Files changed by chance ---

static uint32_t next_random(uint32_t *x) {
  *x = *x * 1664525u + 1013904223u; // Numerical Recipes
  return *x >> 8;
}

// Some bytes changed, a piece cut out, doubled or put elsewhere, numbers made large.
static Bytes mutated(Bytes b, uint32_t *seed) {
  static const char *const pieces[] = {"-1",  "4294967295", "1e999",        "\xff\xff\xff\xff",
                                       "\n",  "{",          "999999999999", "\0\0\0\0",
                                       "nan", "[",          "list",         "/"};
  Bytes out = bytes_of(b.at, b.n);
  uint32_t times = 1 + next_random(seed) % 4;
  for (uint32_t k = 0; k < times && out.n > 8; k++) {
    size_t at = next_random(seed) % out.n, n = next_random(seed) % 16;
    const char *piece = pieces[next_random(seed) % (sizeof pieces / sizeof *pieces)];
    size_t size = *piece ? strlen(piece) : 4;
    if (n > out.n - at) n = out.n - at;
    switch (next_random(seed) % 5) {
    case 0: out.at[at] = (char)next_random(seed); break;
    case 1: out.at[at] = (char)(out.at[at] ^ 1 << next_random(seed) % 8); break;
    case 2: out.n = at; break;
    case 3:
      memmove(out.at + at, out.at + at + n, out.n - at - n);
      out.n -= n;
      break;
    default:
      if (size <= out.n - at) memcpy(out.at + at, piece, size);
    }
    out.at[out.n] = 0;
  }
  return out;
}

static void changed_files_are_read_or_refused(void **state) {
  (void)state;
  enum { RUNS = 3000 };
  Bytes stl = binary_stl("x", 4), data = gltf_data();
  CagMesh *m = read_bytes("a.stl", stl);
  struct {
    const char *name;
    Bytes b;
  } seeds[] = {{"a.stl", stl},
               {"a.ply", binary_ply(false)},
               {"a.ply", binary_ply(true)},
               {"a.obj", exported(m, export_obj)},
               {"a.glb", glb(plain_gltf, &data)},
               {"a.gltf", exported(m, export_gltf)}};
  uint32_t seed = 1, read = 0;
  for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++) {
    for (int k = 0; k < RUNS; k++) {
      Bytes b = mutated(seeds[i].b, &seed);
      CagMeshFile f = file_of(seeds[i].name, b);
      f.max_memory = 1 << 24;
      CagMesh *got = NULL;
      if (cag_mesh_read(&f, &got, &err) == CAG_OK) {
        read++;
        for (size_t j = 0; j < 3 * got->triangle_count; j++)
          assert_true(got->triangles[j] < got->vertex_count);
        assert_true(isfinite(cag_mesh_area(got)) || cag_mesh_area(got) > 1e30);
        cag_mesh_release(got);
      } else assert_true(err.message[0] != 0);
      free(b.at);
    }
    free(seeds[i].b.at);
  }
  assert_true(read > 0);
  cag_mesh_release(m);
  free(data.at);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(binary_stl_is_welded),
      cmocka_unit_test(binary_stl_may_begin_with_solid),
      cmocka_unit_test(text_stl_is_read_with_its_liberties),
      cmocka_unit_test(what_is_wrong_with_an_stl_is_told),
      cmocka_unit_test(obj_has_polygons_and_numbers_from_the_end),
      cmocka_unit_test(tangled_polygons_are_taken_as_fans),
      cmocka_unit_test(obj_keeps_normals_and_parameters),
      cmocka_unit_test(what_is_wrong_with_an_obj_is_told),
      cmocka_unit_test(ply_as_text_has_other_properties_too),
      cmocka_unit_test(binary_ply_of_either_end_is_read),
      cmocka_unit_test(strips_of_a_ply_are_turned_in_turn),
      cmocka_unit_test(what_is_wrong_with_a_ply_is_told),
      cmocka_unit_test(glb_is_turned_and_scaled),
      cmocka_unit_test(nodes_move_scale_and_mirror),
      cmocka_unit_test(nodes_stand_where_their_numbers_say),
      cmocka_unit_test(normals_go_with_their_nodes),
      cmocka_unit_test(a_ply_may_lack_a_part_of_its_normals),
      cmocka_unit_test(required_extensions_are_known),
      cmocka_unit_test(many_corners_are_numbered_once),
      cmocka_unit_test(sparse_accessors_strips_and_fans_are_read),
      cmocka_unit_test(buffers_may_be_text_or_beside),
      cmocka_unit_test(what_is_wrong_with_a_gltf_is_told),
      cmocka_unit_test(limits_hold_before_memory_is_taken),
      cmocka_unit_test(what_was_written_is_read),
      cmocka_unit_test(changed_files_are_read_or_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
