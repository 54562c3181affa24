// Meshes read from glTF: nodes, accessors, and buffers, and errors in files.

#include "tests/interp/mesh_read_support.h"

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
  // Used twice: doubled and then moved by 10 along its z; reflected by a matrix and moved by 1
  // along y.
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

// Rotates v by a quaternion of any length: t = 2 q x v, v + w t + q x t.
static CagVec3 turned(const double q[4], CagVec3 v) {
  const double n = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const CagVec3 u = cag_vec3(q[0] / n, q[1] / n, q[2] / n);
  const CagVec3 t = cag_scaled(cag_cross(u, v), 2);
  return cag_add(cag_madd(v, q[3] / n, t), cag_cross(u, t));
}

// Nested nodes with random scales, rotations, and translations. Meters with Y up become millimeters
// with Z up.
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
    if (round % 4 == 1) n[7] = -n[7] - 2; // a reflection
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
      // Corners are given in meters, with Y up, in single precision.
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

// Normals stay perpendicular to the same plane for any scale, and on the same side of their
// triangles, even under a reflection.
static void normals_go_with_their_nodes(void **state) {
  (void)state;
  uint64_t x = 7;
  Bytes data = gltf_data();
  for (int t = 0; t < 4; t++) { // after the 60 bytes: a normal for each corner
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
        // The inverse of the scale, the rotation, and then Z up.
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

// Required extensions that do not affect triangles are accepted, and others are not.
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

static void sparse_accessors_strips_and_fans_are_read(void **state) {
  (void)state;
  // Four corners of a square that are zeros, three of which are replaced, with 16-bit and 8-bit
  // indices.
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
    // A square of 1 m: the strip covers it; the fan runs over the corner in its middle and back.
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
    return cag_fail(e, CAG_E_CALLBACK, CAG_ERR_file, "", -1, "no such file");
  *bytes = bytes_of(b->at, b->n).at;
  *n = b->n;
  return CAG_OK;
}

static void buffers_may_be_text_or_beside(void **state) {
  (void)state;
  // 0 0 0, 1 0 0, 0 0 -1 as floats in base64, encoded by coreutils.
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
  assert_string_equal(cag_error_info(err.id)->reason, "mesh-file-truncated");
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
  assert_fails("a.glb", b, "mesh-file-index", "vertex 9, but there are 4");
  b.n -= 4;
  assert_fails("a.glb", b, "mesh-file-truncated", "bytes of the");
  free(b.at);
  free(data.at);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(glb_is_turned_and_scaled),
      cmocka_unit_test(nodes_move_scale_and_mirror),
      cmocka_unit_test(nodes_stand_where_their_numbers_say),
      cmocka_unit_test(normals_go_with_their_nodes),
      cmocka_unit_test(required_extensions_are_known),
      cmocka_unit_test(sparse_accessors_strips_and_fans_are_read),
      cmocka_unit_test(buffers_may_be_text_or_beside),
      cmocka_unit_test(what_is_wrong_with_a_gltf_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
