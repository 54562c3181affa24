// Meshes read from STL, OBJ and PLY: files written by hand here, and what is wrong with files.

#include "tests/interp/mesh_read_support.h"

// --- STL ---

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
  assert_fails("a.stl", b, "mesh-file-truncated", "5 triangles, but its 284 bytes contain 4");
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
  assert_solid(m, 8, 12, 8);
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

// --- PLY ---

static void ply_as_text_has_other_properties_too(void **state) {
  (void)state;
  CagMesh *m = read_text(
      "a.ply", "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement material 1\n"
               "property list uchar float values\nproperty int kind\nelement vertex 4\n"
               "property float quality\nproperty double z\nproperty double x\nproperty double y\n"
               "property list uint8 int32 neighbours\nelement face 4\nproperty uchar flags\n"
               "property list uint8 uint16 vertex_index\nproperty float area\nend_header\n"
               "2 1.5 nan 7\n-nan 0 0 0 0\n+inf 0 2 0 1 3\n0.5 0 0 3 0\ninf 4 0 0 2 1 2\n"
               "1 3 0 2 1 0\n1 3 0 1 3 0\n1 3 0 3 2 0\n1 3 1 2 3 0\n");
  assert_tetrahedron(m);
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
  assert_text_fails("a.ply", HEAD "end_header\n0 0\n0 0\n0 0\n", "mesh-file-syntax", "x, y, or z");
  assert_text_fails("a.ply", HEAD FACES "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "mesh-file-index",
                    "vertex 3, but there are 3");
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

// Fractions as counts would make no sense, and most types have two names.
static void counts_of_lists_in_a_ply_are_whole(void **state) {
  (void)state;
  static const char *const whole[] = {"char",   "int8",   "uchar", "uint8", "short", "int16",
                                      "ushort", "uint16", "int",   "int32", "uint",  "uint32"};
  static const char *const others[] = {"float", "float32", "double", "float64", "size_t"};
  char text[500];
  for (size_t i = 0; i < sizeof whole / sizeof *whole + sizeof others / sizeof *others; i++) {
    const bool good = i < sizeof whole / sizeof *whole;
    snprintf(text, sizeof text,
             HEAD
             "property float z\nelement face 1\nproperty list %s int vertex_indices\nend_header\n"
             "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
             good ? whole[i] : others[i - sizeof whole / sizeof *whole]);
    if (!good) {
      assert_text_fails("a.ply", text, "mesh-file-syntax", "the type of a list's count");
      continue;
    }
    CagMesh *m = read_text("a.ply", text);
    assert_int_equal(m->triangle_count, 1);
    cag_mesh_release(m);
  }
}

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

// A normal of no length is replaced with that of the triangles around, weighted by their areas.
// Where these cancel out, or their points are on one line, any normal is as good.
static void normals_of_no_length_are_those_of_the_triangles(void **state) {
  (void)state;
  static const char head[] = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n"
                             "property float y\nproperty float z\nproperty float nx\n"
                             "property float ny\nproperty float nz\nelement face 2\n"
                             "property list uchar int vertex_indices\nend_header\n";
  // Triangles of areas 4 and 6 / 2, in the planes z = 0 and y = 0, share an edge.
  char text[600];
  snprintf(text, sizeof text, "%s%s", head,
           "0 0 0 0 0 0\n2 0 0 0 0 0\n0 4 0 0 0 0\n0 0 3 0 0 0\n9 9 9 3 0 4\n"
           "3 0 1 2\n3 0 1 3\n");
  CagMesh *m = read_text("a.ply", text);
  assert_int_equal(m->vertex_count, 4);
  const CagVec3 both = cag_unit(cag_vec3(0, -3, 4));
  const CagVec3 expected[] = {both, both, {0, 0, 1}, {0, -1, 0}};
  for (size_t v = 0; v < 4; v++) assert_true(cag_norm(cag_sub(m->normals[v], expected[v])) < 1e-15);
  cag_mesh_release(m);
  // The same triangle from both sides.
  snprintf(text, sizeof text, "%s%s", head,
           "0 0 0 0 0 0\n2 0 0 0 0 0\n0 4 0 0 0 0\n0 0 3 0 0 0\n9 9 9 3 0 4\n"
           "3 0 1 2\n3 0 2 1\n");
  m = read_text("a.ply", text);
  assert_int_equal(m->vertex_count, 3);
  for (size_t v = 0; v < 3; v++) assert_true(fabs(cag_norm(m->normals[v]) - 1) < 1e-15);
  cag_mesh_release(m);
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
      cmocka_unit_test(many_corners_are_numbered_once),
      cmocka_unit_test(ply_as_text_has_other_properties_too),
      cmocka_unit_test(binary_ply_of_either_end_is_read),
      cmocka_unit_test(strips_of_a_ply_are_turned_in_turn),
      cmocka_unit_test(what_is_wrong_with_a_ply_is_told),
      cmocka_unit_test(counts_of_lists_in_a_ply_are_whole),
      cmocka_unit_test(a_ply_may_lack_a_part_of_its_normals),
      cmocka_unit_test(normals_of_no_length_are_those_of_the_triangles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
