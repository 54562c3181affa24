// Written glTF files, compared with the meshes, materials, and scales of the scene.

#include "mesh_write_support.h"

static const cJSON *item(const cJSON *o, const char *list, size_t i) {
  const cJSON *found = cJSON_GetArrayItem(cJSON_GetObjectItem(o, list), (int)i);
  if (!found) fail_msg("no %s %zu", list, i);
  return found;
}

static double number_of(const cJSON *o, const char *key) {
  const cJSON *found = cJSON_GetObjectItem(o, key);
  if (!found) fail_msg("no %s", key);
  return cJSON_GetNumberValue(found);
}

static double element(const cJSON *o, const char *list, int i) {
  return cJSON_GetNumberValue(item(o, list, (size_t)i));
}

// Returns the data of an accessor; `kind` is SIZE_MAX if there is none. Its view must be inside the
// data.
static const char *accessor(const cJSON *root, const char *bytes, const cJSON *of, const char *key,
                            size_t width, size_t *count) {
  const cJSON *a = item(root, "accessors", (size_t)number_of(of, key));
  const cJSON *view = item(root, "bufferViews", (size_t)number_of(a, "bufferView"));
  *count = (size_t)number_of(a, "count");
  assert_int_equal((size_t)number_of(view, "byteLength"), *count * width);
  assert_int_equal((int)number_of(view, "target"), strcmp(key, "indices") ? 34962 : 34963);
  assert_int_equal((int)number_of(a, "componentType"), strcmp(key, "indices") ? 5126 : 5125);
  return bytes + (size_t)number_of(view, "byteOffset");
}

static CagTransform node_transform(const cJSON *node) {
  CagTransform t = cag_transform_identity();
  if (cJSON_HasObjectItem(node, "rotation")) {
    const double x = element(node, "rotation", 0), y = element(node, "rotation", 1);
    const double z = element(node, "rotation", 2), w = element(node, "rotation", 3);
    const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                            {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                            {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++) memcpy(t.m[i], m[i], sizeof m[i]);
  }
  if (cJSON_HasObjectItem(node, "translation"))
    for (int i = 0; i < 3; i++) t.m[i][3] = element(node, "translation", i);
  return t;
}

static double brightest(CagColor c) { return fmax(c.r, fmax(c.g, c.b)); }

static void check_material(const cJSON *found, const CagMaterial *m) {
  assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItem(found, "name")), m->name);
  const cJSON *base = cJSON_GetObjectItem(found, "pbrMetallicRoughness");
  const double rgb[4] = {m->color.r, m->color.g, m->color.b, 1};
  for (int k = 0; k < 4; k++)
    assert_true(fabs(element(base, "baseColorFactor", k) - fmin(fmax(rgb[k], 0), 1)) < 1e-8);
  assert_true(number_of(base, "metallicFactor") == m->metallic);
  assert_true(number_of(base, "roughnessFactor") == m->roughness);
  const double peak = brightest(m->emission), strength = fmax(1, peak);
  assert_true(cJSON_HasObjectItem(found, "emissiveFactor") == (peak > 0));
  const double emission[3] = {m->emission.r, m->emission.g, m->emission.b};
  for (int k = 0; k < 3 && peak > 0; k++)
    assert_true(fabs(element(found, "emissiveFactor", k) - emission[k] / strength) < 1e-8);
  const struct {
    const char *extension, *key;
    bool used;
    double value;
  } extensions[] = {
      {"KHR_materials_emissive_strength", "emissiveStrength", peak > 1, strength},
      {"KHR_materials_transmission", "transmissionFactor", m->transmission > 0, m->transmission},
      {"KHR_materials_ior", "ior", m->ior != 1.5 && m->ior >= 1, m->ior},
      {"KHR_materials_clearcoat", "clearcoatFactor", m->coat > 0, m->coat}};
  const cJSON *all = cJSON_GetObjectItem(found, "extensions");
  int used = 0;
  for (int k = 0; k < 4; k++) {
    const cJSON *e = cJSON_GetObjectItem(all, extensions[k].extension);
    assert_true((e != NULL) == extensions[k].used);
    if (e) assert_true(number_of(e, extensions[k].key) == extensions[k].value);
    used += e != NULL;
  }
  assert_int_equal(cJSON_GetArraySize(all), used);
}

static const char *const extension_names[] = {"KHR_materials_emissive_strength",
                                              "KHR_materials_transmission", "KHR_materials_ior",
                                              "KHR_materials_clearcoat"};

static void check_gltf(const Scene *s, const cJSON *root, const char *bytes, size_t size) {
  const cJSON *nodes = cJSON_GetObjectItem(root, "nodes"), *top = cJSON_GetArrayItem(nodes, 0);
  int node = 0, materials = 0;
  const CagMaterial *distinct[PARTS];
  bool used[4] = {false};
  assert_true(number_of(item(root, "buffers", 0), "byteLength") == (double)size);
  for (size_t i = 0; i < s->count; i++) {
    const CagMesh *m = s->parts[i].mesh;
    const CagMaterial *material = s->parts[i].material;
    size_t kept = 0, n;
    for (size_t t = 0; t < m->triangle_count; t++) kept += !shrinks(m, t);
    if (kept == 0) continue;
    const cJSON *found = cJSON_GetArrayItem(nodes, ++node);
    assert_int_equal((int)element(top, "children", node - 1), node);
    assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItem(found, "name")),
                        s->parts[i].name ? s->parts[i].name : "part");
    const CagTransform place = node_transform(found);
    const cJSON *primitive =
        item(item(root, "meshes", (size_t)number_of(found, "mesh")), "primitives", 0);
    const cJSON *attributes = cJSON_GetObjectItem(primitive, "attributes");
    assert_true(cJSON_HasObjectItem(attributes, "NORMAL") == (m->normals != NULL));
    assert_true(cJSON_HasObjectItem(attributes, "TEXCOORD_0") == (m->uv != NULL));
    assert_true(cJSON_HasObjectItem(attributes, "COLOR_0") == (m->scale.kind != 0));
    assert_true(cJSON_HasObjectItem(primitive, "material") == (material != NULL));
    if (material) {
      const size_t number = (size_t)number_of(primitive, "material");
      check_material(item(root, "materials", number), material);
      int k = 0;
      while (k < materials && distinct[k] != material) k++;
      assert_int_equal(number, k);
      if (k == materials) distinct[materials++] = material;
      used[0] |= brightest(material->emission) > 1;
      used[1] |= material->transmission > 0;
      used[2] |= material->ior != 1.5 && material->ior >= 1;
      used[3] |= material->coat > 0;
    }
    const char *p = accessor(root, bytes, attributes, "POSITION", 12, &n);
    assert_int_equal(n, m->vertex_count);
    CagBounds box = CAG_BOUNDS_EMPTY;
    for (size_t v = 0; v < n; v++) {
      cag_bounds_add(&box, vector_at(p + 12 * v));
      const CagVec3 q = cag_transform_point(&place, vector_at(p + 12 * v));
      assert_true(distance(q, m->positions[v]) < 1e-3);
    }
    const cJSON *a = item(root, "accessors", (size_t)number_of(attributes, "POSITION"));
    for (int k = 0; k < 3; k++) {
      assert_true((float)element(a, "min", k) == (float)(&box.min.x)[k]);
      assert_true((float)element(a, "max", k) == (float)(&box.max.x)[k]);
    }
    if (m->normals) {
      const char *q = accessor(root, bytes, attributes, "NORMAL", 12, &n);
      for (size_t v = 0; v < m->vertex_count; v++)
        assert_true(distance(cag_transform_vector(&place, vector_at(q + 12 * v)), m->normals[v]) <
                    1e-5);
    }
    if (m->uv) {
      const char *q = accessor(root, bytes, attributes, "TEXCOORD_0", 8, &n);
      for (size_t v = 0; v < 2 * m->vertex_count; v++)
        assert_true(float_at(q + 4 * v) == (float)m->uv[v]);
    }
    if (m->scale.kind) {
      const char *q = accessor(root, bytes, attributes, "COLOR_0", 12, &n);
      for (size_t v = 0; v < m->vertex_count; v++) {
        const CagColor c = cag_color_scale_at(&m->scale, m->uv[2 * v]);
        assert_true(distance(vector_at(q + 12 * v), cag_vec3(c.r, c.g, c.b)) < 1e-6);
      }
    }
    const char *k = accessor(root, bytes, primitive, "indices", 4, &n);
    assert_int_equal(n, 3 * kept);
    for (size_t t = 0; t < m->triangle_count; t++) {
      if (shrinks(m, t)) continue;
      for (size_t j = 0; j < 3; j++, k += 4) assert_int_equal(word_at(k), m->triangles[3 * t + j]);
    }
  }
  assert_int_equal(cJSON_GetArraySize(nodes), node + 1);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(root, "materials")), materials);
  const cJSON *extensions = cJSON_GetObjectItem(root, "extensionsUsed");
  int k = 0;
  for (int e = 0; e < 4; e++)
    if (used[e])
      assert_string_equal(cJSON_GetStringValue(cJSON_GetArrayItem(extensions, k++)),
                          extension_names[e]);
  assert_int_equal(cJSON_GetArraySize(extensions), k);
  // Views are contiguous.
  const cJSON *view;
  size_t end = 0;
  cJSON_ArrayForEach(view, cJSON_GetObjectItem(root, "bufferViews")) {
    assert_int_equal((size_t)number_of(view, "byteOffset"), end);
    end += (size_t)number_of(view, "byteLength");
  }
  assert_int_equal(end, size);
}

static int base64_digit(char c) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const char *at = strchr(digits, c);
  return at && c ? (int)(at - digits) : -1;
}

static void gltf_has_every_corner(void **state) {
  (void)state;
  seed = 5;
  for (int round = 0; round < 10; round++) {
    Scene s;
    random_scene(&s, round);
    if (round == 9) s.count = 4;
    size_t size;
    char *b = bytes_of(s.parts, s.count, cag_export_glb, &size);
    const uint32_t length = word_at(b + 12);
    assert_int_equal(word_at(b + 8), size);
    cJSON *root = cJSON_ParseWithLength(b + 20, length);
    assert_non_null(root);
    const size_t binary = word_at(b + 20 + length);
    const char *bytes = b + 28 + length;
    assert_int_equal(size, 28 + length + binary);
    check_gltf(&s, root, bytes, binary);
    // Part 0, part 1 (moved), and part 2 use the same data; parts 0 and 2 have different materials.
    assert_int_equal((int)number_of(item(root, "nodes", 1), "mesh"),
                     (int)number_of(item(root, "nodes", 2), "mesh"));
    const cJSON *first = item(item(root, "meshes", 0), "primitives", 0);
    assert_int_equal((int)number_of(first, "indices"),
                     (int)number_of(item(item(root, "meshes", 1), "primitives", 0), "indices"));
    // The same data in a separate file and inside the file.
    stem = "a b";
    size_t text_size;
    char *text = bytes_of(s.parts, s.count, export_gltf, &text_size);
    assert_int_equal(data.size, binary);
    assert_memory_equal(data.bytes, bytes, binary);
    uint64_t hash = 14695981039346656037u; // FNV-1a
    for (size_t i = 0; i < binary; i++) hash = (hash ^ (unsigned char)bytes[i]) * 1099511628211u;
    char name[64], uri[80];
    snprintf(name, sizeof name, "a b-%016llx.bin", (unsigned long long)hash);
    assert_string_equal(data.name, name);
    snprintf(uri, sizeof uri, "\"uri\":\"a%%20b-%016llx.bin\"", (unsigned long long)hash);
    assert_non_null(strstr(text, uri));
    free(data.name);
    free(data.bytes);
    free(text);
    stem = NULL;
    text = bytes_of(s.parts, s.count, export_gltf, &text_size);
    assert_null(data.bytes);
    cJSON *whole = cJSON_Parse(text);
    assert_non_null(whole);
    const char *in = cJSON_GetStringValue(cJSON_GetObjectItem(item(whole, "buffers", 0), "uri"));
    in = strchr(in, ',') + 1;
    assert_int_equal(strlen(in), (binary + 2) / 3 * 4);
    for (size_t i = 0; i < binary; i++) {
      const char *group = in + i / 3 * 4;
      uint32_t x = 0;
      for (int k = 0; k < 4; k++)
        x = x << 6 | (uint32_t)(group[k] == '=' ? 0 : base64_digit(group[k]));
      assert_int_equal((unsigned char)bytes[i], x >> (16 - 8 * (i % 3)) & 255);
    }
    for (size_t i = 0; in[i]; i++)
      assert_true(base64_digit(in[i]) >= 0 ||
                  (in[i] == '=' && strlen(in) - i <= 3 - (binary + 2) % 3));
    cJSON_Delete(whole);
    free(text);
    cJSON_Delete(root);
    free(b);
    scene_free(&s);
  }
}

// A scene without triangles has no data, and does not name a data file.
static void an_empty_gltf_has_no_data(void **state) {
  (void)state;
  size_t size;
  stem = "a";
  char *text = bytes_of(NULL, 0, export_gltf, &size);
  assert_null(data.name);
  assert_null(data.bytes);
  assert_null(strstr(text, "buffers"));
  cJSON *root = cJSON_Parse(text);
  assert_non_null(root);
  cJSON_Delete(root);
  free(text);
}

// Normals of length 0 become Z, and those of other lengths are normalized.
static void gltf_normals_have_length_1(void **state) {
  (void)state;
  CagMesh *m;
  OK(cag_mesh_new(6, 1, true, false, false, &m, &err));
  const CagVec3 given[6] = {{0, 0, 0},      {0, 3, 0},     {NAN, 0, 0},
                            {1.0004, 0, 0}, {0.998, 0, 0}, {1e-200, 0, 0}};
  const CagVec3 expected[6] = {{0, 0, 1},      {0, 1, 0}, {0, 0, 1},
                               {1.0004, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  for (uint32_t k = 0; k < 6; k++) {
    m->positions[k] = cag_vec3(k, k % 2, 0);
    m->normals[k] = given[k];
    if (k < 3) m->triangles[k] = k;
  }
  const CagMeshPart part = {"t", m, NULL};
  size_t size;
  char *b = bytes_of(&part, 1, cag_export_glb, &size);
  const char *bytes = b + 28 + word_at(b + 12) + 6 * 12;
  for (int k = 0; k < 5; k++) {
    const double off = distance(vector_at(bytes + 12 * k), expected[k]);
    if (!(off < 1e-6)) fail_msg("normal %d is %g off", k, off);
  }
  free(b);
  cag_mesh_release(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gltf_has_every_corner),
      cmocka_unit_test(an_empty_gltf_has_no_data),
      cmocka_unit_test(gltf_normals_have_length_1),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
