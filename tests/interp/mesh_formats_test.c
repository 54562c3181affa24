// The contents of mesh files, byte by byte where the format prescribes it.

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

#include "base/decimal.h"
#include "geom/solid/tessellate.h"
#include "interp/formats/mesh_copies.h"
#include "interp/formats/mesh_formats.h"
#include "interp/formats/mesh_write.h"
#include "tests/interp/bytes.h"

#include <cjson/cJSON.h>
#include <zlib.h>

static CagError err;

// A tetrahedron with corners at the origin and at 2, 3, 4 on the axes. Vertex 4 is vertex 0 with
// another normal. One triangle degenerates in single precision.
static CagMesh *tetrahedron(void) {
  static const CagVec3 corner[6] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0},
                                    {0, 0, 4}, {0, 0, 0}, {2, 1e-60, 0}};
  static const uint32_t faces[15] = {0, 2, 1, 0, 1, 3, 4, 3, 2, 1, 2, 3, 1, 5, 2};
  CagMesh *m;
  if (cag_mesh_new(6, 5, true, true, true, &m, &err)) fail();
  memcpy(m->positions, corner, sizeof corner);
  memcpy(m->triangles, faces, sizeof faces);
  for (uint32_t k = 0; k < 6; k++) {
    m->normals[k] = k == 4 ? cag_vec3(-1, 0, 0) : cag_vec3(0, 0, -1);
    m->uv[2 * k] = k * 0.25;
    m->uv[2 * k + 1] = 1;
    m->weld[k] = k == 4 ? 0 : k;
  }
  return m;
}

static CagMaterial red(void) {
  static char name[] = "red paint", none[] = "";
  return (CagMaterial){.name = name,
                       .color = {1, 0, 0},
                       .roughness = 0.5,
                       .ior = 1.5,
                       .transmission = 0.25,
                       .texture = none};
}

typedef enum Format { OBJ, MTL, STL, PLY, GLB, GLTF, THREEMF } Format;

// The bytes of the file, terminated by NUL, allocated by malloc.
static char *written(Format format, const CagMeshPart *parts, size_t n, size_t *size) {
  char path[] = "/tmp/cag_mesh_formats_XXXXXX";
  int fd = mkstemp(path);
  assert_true(fd >= 0);
  close(fd);
  CagError io;
  CagAtomicFile *f = cag_atomic_file_open(path, &io);
  assert_non_null(f);
  CagStatus status = CAG_OK;
  switch (format) {
  case OBJ: status = cag_export_obj(parts, n, "a.mtl", f, &err); break;
  case MTL: status = cag_export_mtl(parts, n, f, &err); break;
  case STL: status = cag_export_stl(parts, n, "solid work", f, &err); break;
  case PLY: status = cag_export_ply(parts, n, f, &err); break;
  case GLB: status = cag_export_glb(parts, n, f, &err); break;
  case GLTF: status = cag_export_gltf(parts, n, NULL, f, &(CagGltfData){0}, &err); break;
  case THREEMF: status = cag_export_3mf(parts, n, f, &err); break;
  }
  assert_int_equal(status, CAG_OK);
  assert_true(cag_atomic_file_commit(f, &io));
  FILE *in = fopen(path, "rb");
  char *bytes = calloc(1, 1 << 16);
  *size = fread(bytes, 1, (1 << 16) - 1, in);
  fclose(in);
  unlink(path);
  return bytes;
}

static void numbers_read_back_as_the_same_float(void **state) {
  (void)state;
  const double shown[] = {0,     -0.0,         1,           -1,   0.1,  123456.789,
                          -1e-5, 9.99999999e8, 999999999.6, 1e-7, 1e20, 3.14159265358979,
                          100,   0.001,        99999999.95};
  const char *const text[] = {"0",          "0",          "1",         "-1",    "0.1",
                              "123456.789", "-0.00001",   "999999999", "1e+09", "1e-07",
                              "1e+20",      "3.14159265", "100",       "0.001", "100000000"};
  for (size_t k = 0; k < sizeof shown / sizeof *shown; k++) {
    char buffer[32];
    *cag_mesh_write_number(buffer, shown[k]) = '\0';
    assert_string_equal(buffer, text[k]);
  }
  uint32_t x = 7;
  for (int k = 0; k < 200000; k++) {
    x = x * 1664525u + 1013904223u; // the generator of Numerical Recipes
    double value = ldexp((double)x - 2147483648.0, (int)(x >> 27) - 40);
    char buffer[32];
    *cag_mesh_write_number(buffer, (float)value) = '\0';
    if (strtof(buffer, NULL) != (float)value) fail_msg("%.17g became %s", value, buffer);
  }
}

static void stl_has_the_triangles_that_have_an_area(void **state) {
  (void)state;
  CagMesh *m = tetrahedron();
  CagMeshPart part = {"t", m, NULL};
  size_t size;
  char *b = written(STL, &part, 1, &size);
  assert_int_equal(size, 84 + 4 * 50);
  assert_memory_not_equal(b, "solid", 5);
  assert_int_equal(word_at(b + 80), 4);
  assert_true(float_at(b + 84 + 8) == -1); // normal of the first face
  assert_true(float_at(b + 84 + 12 + 16) == 3);
  // The slanted face x/2 + y/3 + z/4 = 1 has the normal (6, 4, 3)/sqrt 61.
  assert_true(fabs(float_at(b + 84 + 150) - 6 / sqrt(61)) < 2e-7);
  free(b);
  cag_mesh_release(m);
}

static void obj_shares_points_and_keeps_normals_apart(void **state) {
  (void)state;
  CagMesh *m = tetrahedron();
  CagMaterial material = red();
  CagMeshPart parts[2] = {{"left part", m, &material}, {"right", m, &material}};
  size_t size;
  char *b = written(OBJ, parts, 2, &size);
  assert_non_null(strstr(b, "mtllib a.mtl\no left_part\nv 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 4\n"));
  assert_non_null(strstr(b, "usemtl red_paint\n"));
  assert_non_null(strstr(b, "f 1/1/1 3/3/3 2/2/2\n"));
  assert_non_null(strstr(b, "f 1/5/5 4/4/4 3/3/3\n")); // vertex 4 is point 0 with its own normal
  assert_non_null(strstr(b, "f 6/7/7 8/9/9 7/8/8\n")); // the second part continues the numbering
  free(b);
  b = written(MTL, parts, 2, &size);
  assert_non_null(strstr(b, "newmtl red_paint\nKd 1 0 0\n"));
  assert_non_null(strstr(b, "\nd 0.75\n"));
  assert_null(strstr(strstr(b, "newmtl") + 1, "newmtl"));
  free(b);
  cag_mesh_release(m);
}

static void ply_has_a_vertex_for_each_normal_of_a_point(void **state) {
  (void)state;
  CagMesh *m = tetrahedron();
  CagMaterial material = red();
  CagMeshPart part = {"t", m, &material};
  size_t size;
  char *b = written(PLY, &part, 1, &size);
  assert_non_null(strstr(b, "format binary_little_endian 1.0\n"));
  assert_non_null(strstr(b, "element vertex 6\n"));
  assert_non_null(strstr(b, "element face 4\n"));
  const char *data = strstr(b, "end_header\n") + strlen("end_header\n");
  assert_int_equal(size, (size_t)(data - b) + 6 * 35 + 4 * 13);
  assert_true(float_at(data + 20) == -1); // the normal of vertex 0 is downward
  assert_true(float_at(data + 4 * 35 + 12) ==
              -1); // that of vertex 4, at the same point, is to the left
  assert_int_equal((unsigned char)data[32], 255);
  assert_int_equal((unsigned char)data[33], 0);
  const char *faces = data + 6 * 35;
  assert_int_equal(faces[0], 3);
  assert_int_equal(word_at(faces + 1), 0);
  assert_int_equal(word_at(faces + 2 * 13 + 1), 4);
  free(b);
  // With the same normal, they become one vertex.
  m->normals[4] = m->normals[0];
  b = written(PLY, &part, 1, &size);
  data = strstr(b, "end_header\n") + strlen("end_header\n");
  assert_non_null(strstr(b, "element vertex 5\n"));
  assert_int_equal(word_at(data + 5 * 35 + 2 * 13 + 1), 0);
  free(b);
  cag_mesh_release(m);
}

static CagVec3 vector_at(const char *p) {
  return cag_vec3(float_at(p), float_at(p + 4), float_at(p + 8));
}

static void normals_in_ply_are_those_of_the_faces_of_a_box(void **state) {
  (void)state;
  CagSolid *box;
  CagMesh *m;
  size_t size;
  assert_int_equal(cag_solid_box(cag_vec3(2, 3, 5), false, &box, &err), CAG_OK);
  assert_int_equal(cag_solid_tessellate(box, NULL, &m, &err), CAG_OK);
  CagMeshPart part = {"box", m, NULL};
  char *b = written(PLY, &part, 1, &size);
  assert_non_null(strstr(b, "element vertex 24\n")); // three for each corner
  const char *data = strstr(b, "end_header\n") + strlen("end_header\n"), *faces = data + 24 * 35;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const char *v[3];
    for (int k = 0; k < 3; k++) v[k] = data + 35 * word_at(faces + 13 * t + 1 + 4 * k);
    const CagVec3 a = vector_at(v[0]);
    const CagVec3 n = cag_unit(cag_cross(cag_sub(vector_at(v[1]), a), cag_sub(vector_at(v[2]), a)));
    for (int k = 0; k < 3; k++) assert_true(cag_dot(n, vector_at(v[k] + 12)) > 1 - 1e-6);
  }
  free(b);
  cag_mesh_release(m);
  cag_solid_release(box);
}

static double number_of(const cJSON *json, const char *a, int i, const char *key) {
  return cJSON_GetNumberValue(
      cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(json, a), i), key));
}

static void glb_describes_its_data(void **state) {
  (void)state;
  CagMesh *m = tetrahedron();
  CagMaterial material = red();
  CagMeshPart parts[2] = {{"left \"part\"", m, &material}, {"right", m, &material}};
  size_t size;
  char *b = written(GLB, parts, 2, &size);
  assert_memory_equal(b, "glTF", 4);
  assert_int_equal(word_at(b + 4), 2);
  assert_int_equal(word_at(b + 8), size);
  uint32_t length = word_at(b + 12);
  assert_int_equal(length % 4, 0);
  assert_memory_equal(b + 16, "JSON", 4);
  cJSON *json = cJSON_ParseWithLength(b + 20, length);
  assert_non_null(json);
  assert_memory_equal(b + 20 + length + 4, "BIN\0", 4);
  uint32_t binary = word_at(b + 20 + length);
  // 6 vertices of 32 bytes, 4 triangles of 12; the second part is the same mesh again.
  assert_int_equal(binary, 6 * 32 + 4 * 12);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "meshes")), 1);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "nodes")), 3);
  assert_true(number_of(json, "buffers", 0, "byteLength") == binary);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "accessors")), 4);
  assert_true(number_of(json, "accessors", 3, "count") == 12);
  assert_true(number_of(json, "accessors", 0, "count") == 6);
  const cJSON *most =
      cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "accessors"), 0), "max");
  for (int k = 0; k < 3; k++)
    assert_true(cJSON_GetNumberValue(cJSON_GetArrayItem(most, k)) == k + 2);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "materials")), 1);
  assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItem(
                          cJSON_GetArrayItem(cJSON_GetObjectItem(json, "nodes"), 1), "name")),
                      "left \"part\"");
  assert_string_equal(
      cJSON_GetStringValue(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "extensionsUsed"), 0)),
      "KHR_materials_transmission");
  cJSON_Delete(json);
  free(b);
  b = written(GLB, parts, 0, &size); // an empty scene is a valid file
  assert_int_equal(word_at(b + 8), size);
  free(b);
  cag_mesh_release(m);
}

static void gltf_may_hold_its_data(void **state) {
  (void)state;
  CagMesh *m = tetrahedron();
  CagMeshPart part = {"t", m, NULL};
  size_t size;
  char *b = written(GLTF, &part, 1, &size);
  cJSON *json = cJSON_Parse(b);
  assert_non_null(json);
  const char *uri = cJSON_GetStringValue(
      cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "buffers"), 0), "uri"));
  const char head[] = "data:application/octet-stream;base64,";
  assert_memory_equal(uri, head, strlen(head));
  // 6 * 32 + 4 * 12 bytes, in groups of 3 as 4 characters. The first vertex is three zeros, and the
  // second begins with 2.0: 00 00 00 40.
  assert_int_equal(strlen(uri) - strlen(head), 240 / 3 * 4);
  assert_memory_equal(uri + strlen(head), "AAAAAAAAAAAAAAAAAAAAQA", 20);
  cJSON_Delete(json);
  free(b);
  cag_mesh_release(m);
}

// Returns the bytes of an archive member whose local header begins at b. *next is the end of the
// member.
static char *unpacked(const char *b, const char **next) {
  assert_memory_equal(b, "PK\3\4", 4);
  uint32_t crc = word_at(b + 14), packed = word_at(b + 18), size = word_at(b + 22);
  size_t name = (unsigned char)b[26];
  char *out = calloc(1, size + 1);
  z_stream z = {.next_in = (Bytef *)b + 30 + name,
                .avail_in = packed,
                .next_out = (Bytef *)out,
                .avail_out = size};
  assert_int_equal(inflateInit2(&z, -15), Z_OK);
  assert_int_equal(inflate(&z, Z_FINISH), Z_STREAM_END);
  assert_int_equal(z.total_out, size);
  inflateEnd(&z);
  assert_int_equal(crc32(0, (Bytef *)out, size), crc);
  *next = b + 30 + name + packed;
  return out;
}

static void threemf_has_objects_materials_and_copies(void **state) {
  (void)state;
  CagMesh *m = tetrahedron();
  CagMaterial material = red();
  CagMeshPart parts[3] = {
      {"left & right", m, &material}, {"again", m, &material}, {"bare", m, NULL}};
  size_t size;
  char *b = written(THREEMF, parts, 3, &size);
  const char *at = b;
  free(unpacked(at, &at));
  free(unpacked(at, &at));
  char *xml = unpacked(at, &at);
  assert_memory_equal(at, "PK\1\2", 4);
  // The triangle that degenerates in single precision would leave the body open. A quarter of the
  // light passes.
  assert_non_null(strstr(xml, "<base name=\"red paint\" displaycolor=\"#FF0000BF\"/>"));
  assert_non_null(strstr(xml,
                         "<object id=\"2\" type=\"surface\" name=\"left &amp; right\" pid=\"1\" "
                         "pindex=\"0\">"));
  assert_non_null(strstr(xml, "<vertex x=\"0\" y=\"3\" z=\"0\"/>"));
  assert_non_null(strstr(xml, "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/>"));
  assert_non_null(strstr(xml, "<triangle v1=\"0\" v2=\"3\" v3=\"2\"/>")); // vertex 4 is point 0
  assert_non_null(strstr(xml, "<component objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 0 0\"/>"));
  assert_non_null(strstr(xml, "<object id=\"4\" type=\"surface\" name=\"bare\">\n   <mesh>"));
  assert_non_null(strstr(xml, "<item objectid=\"3\"/>"));
  free(xml);
  free(b);
  cag_mesh_release(m);
}

static void copies_are_found_by_their_shape(void **state) {
  (void)state;
  CagMesh *m = tetrahedron(), *moved, *mirrored, *larger;
  CagTransform turn, mirror, scale, shift = cag_translate(cag_vec3(100, -20, 3));
  assert_int_equal(cag_rotate(cag_vec3(1, 2, 3), 1.25, cag_vec3(0, 5, 0), &turn, &err), CAG_OK);
  assert_int_equal(cag_reflect(cag_vec3(1, 0, 0), cag_vec3(0, 0, 0), &mirror, &err), CAG_OK);
  assert_int_equal(cag_scale(cag_vec3(2, 2, 2), cag_vec3(0, 0, 0), &scale, &err), CAG_OK);
  CagTransform place = cag_transform_multiply(&shift, &turn);
  assert_int_equal(cag_mesh_transform(m, &place, &moved, &err), CAG_OK);
  assert_int_equal(cag_mesh_transform(m, &mirror, &mirrored, &err), CAG_OK);
  assert_int_equal(cag_mesh_transform(m, &scale, &larger, &err), CAG_OK);
  CagMaterial a = red(), b = red();
  const CagMeshPart parts[5] = {{"m", m, &a},
                                {"larger", larger, &a},
                                {"moved", moved, &b},
                                {"mirror", mirrored, &a},
                                {"m", m, &a}};
  CagMeshCopy *copies;
  assert_int_equal(cag_mesh_find_copies(parts, 5, false, &copies, &err), CAG_OK);
  const size_t originals[5] = {0, 1, 0, 3, 0};
  for (int k = 0; k < 5; k++) assert_int_equal(copies[k].original, originals[k]);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      assert_true(fabs(copies[2].place.m[i][j] - place.m[i][j]) < 1e-12 * 100);
  free(copies);
  assert_int_equal(cag_mesh_find_copies(parts, 5, true, &copies, &err), CAG_OK);
  assert_int_equal(copies[2].original, 2);
  free(copies);
  cag_mesh_release(m);
  cag_mesh_release(moved);
  cag_mesh_release(mirrored);
  cag_mesh_release(larger);
}

static void what_single_precision_cannot_hold_is_an_error(void **state) {
  (void)state;
  CagMesh *m = tetrahedron();
  m->positions[3].z = 1e60;
  CagMeshPart part = {"far", m, NULL};
  CagError io;
  CagAtomicFile *f = cag_atomic_file_open("/dev/null", &io);
  assert_non_null(f);
  assert_int_equal(cag_export_stl(&part, 1, NULL, f, &err), CAG_E_DEGENERATE);
  assert_string_equal(cag_error_info(err.id)->reason, "mesh-empty");
  assert_int_equal(cag_export_ply(&part, 1, f, &err), CAG_E_DEGENERATE);
  assert_int_equal(cag_export_glb(&part, 1, f, &err), CAG_E_DEGENERATE);
  assert_int_equal(cag_export_obj(&part, 1, NULL, f, &err), CAG_OK);
  cag_atomic_file_abort(f);
  cag_mesh_release(m);
}

// In the format of the C library.
static void indices_are_decimal_whatever_their_length(void **state) {
  (void)state;
  uint64_t n = 1;
  for (int digits = 1; digits <= 20; digits++, n *= 10)
    for (int k = -1; k <= 1; k++) {
      const uint64_t x = k < 0 ? n - 1 : k > 0 ? n / 9 * 8 + (uint64_t)digits : n;
      char found[21] = {0}, expected[21];
      *cag_decimal_index(found, x) = 0;
      snprintf(expected, sizeof expected, "%llu", (unsigned long long)x);
      assert_string_equal(found, expected);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(indices_are_decimal_whatever_their_length),
      cmocka_unit_test(numbers_read_back_as_the_same_float),
      cmocka_unit_test(stl_has_the_triangles_that_have_an_area),
      cmocka_unit_test(obj_shares_points_and_keeps_normals_apart),
      cmocka_unit_test(ply_has_a_vertex_for_each_normal_of_a_point),
      cmocka_unit_test(normals_in_ply_are_those_of_the_faces_of_a_box),
      cmocka_unit_test(glb_describes_its_data),
      cmocka_unit_test(gltf_may_hold_its_data),
      cmocka_unit_test(threemf_has_objects_materials_and_copies),
      cmocka_unit_test(copies_are_found_by_their_shape),
      cmocka_unit_test(what_single_precision_cannot_hold_is_an_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
