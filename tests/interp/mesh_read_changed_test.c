// Mesh files of every format: limits, round trips, and random changes.

#include "tests/interp/mesh_read_support.h"

// --- Limits ---

static void limits_hold_before_memory_is_taken(void **state) {
  (void)state;
  Bytes b = binary_stl("x", 4);
  CagMeshFile f = file_of("a.stl", b);
  CagMesh *m = NULL;
  f.max_triangles = 3;
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_LIMIT);
  assert_string_equal(cag_error_info(err.id)->reason, "triangle-limit");
  f.max_triangles = 4;
  f.max_memory = 300; // 12 corners alone take 288
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_MEMORY);
  volatile int stop = 1;
  f.max_memory = 1 << 20;
  f.interrupt = &stop;
  assert_int_equal(cag_mesh_read(&f, &m, &err), CAG_E_CALLBACK);
  free(b.at);
  // A billion points without data in the file, which are zeros.
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
  CagError io;
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

// --- Random changes ---

static uint32_t next_random(uint32_t *x) {
  *x = *x * 1664525u + 1013904223u; // Numerical Recipes
  return *x >> 8;
}

// Changes some bytes; removes, duplicates, or moves a piece; enlarges numbers.
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
      cmocka_unit_test(limits_hold_before_memory_is_taken),
      cmocka_unit_test(what_was_written_is_read),
      cmocka_unit_test(changed_files_are_read_or_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
