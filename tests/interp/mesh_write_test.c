// Written STL, OBJ, and PLY files, and meshes read back, compared with the original meshes.

#include "mesh_write_support.h"

// --- STL ---

static void stl_has_every_triangle(void **state) {
  (void)state;
  seed = 1;
  for (int round = 0; round < 9; round++) {
    Scene s;
    random_scene(&s, round);
    if (round == 4) // without degenerate triangles
      s.count = 0;
    for (size_t i = 0; round == 4 && i < PARTS; i++)
      if (i % 2) s.parts[s.count++] = s.parts[i];
    size_t size, at = 84, kept = 0;
    char *b = bytes_of(s.parts, s.count, export_stl, &size);
    assert_string_equal(b, "cag: binary STL, mm");
    for (size_t i = 0; i < s.count; i++) {
      const CagMesh *m = s.parts[i].mesh;
      for (size_t t = 0; t < m->triangle_count; t++) {
        if (shrinks(m, t)) continue;
        CagVec3 p[3];
        for (int j = 0; j < 3; j++) {
          p[j] = m->positions[m->triangles[3 * t + (size_t)j]];
          assert_true(distance(p[j], vector_at(b + at + 12 * (j + 1))) < 1e-6);
        }
        const CagVec3 n = cag_unit(cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0])));
        if (distance(n, vector_at(b + at)) > 1e-6) fail_msg("triangle %zu has another normal", t);
        assert_true(b[at + 48] == 0 && b[at + 49] == 0);
        at += 50;
        kept++;
      }
    }
    assert_int_equal(size, at);
    assert_int_equal(word_at(b + 80), kept);
    free(b);
    scene_free(&s);
  }
}

// Triangles whose squares overflow or underflow in single precision have unit normals, too; only
// those without area have zeros. Each is between ordinary ones.
static void stl_normals_have_length_1_at_any_size(void **state) {
  (void)state;
  static const double scales[] = {1e-30, 1e-12, 1e-9, 1e-6, 1e-3, 1, 1e3, 1e6, 1e8, 1e12, 1e30};
  enum { N = 11 };
  for (int axis = 0; axis < 3; axis++) {
    CagMesh *m;
    OK(cag_mesh_new(3 * N + 3, N + 1, false, false, false, &m, &err));
    for (int k = 0; k < N; k++) {
      const double s = scales[k], x = s, y = 2 * s, z = -3 * s;
      const CagVec3 p[3] = {{0, 0, 0}, {x, y, 0}, {0, x, z}};
      for (int j = 0; j < 3; j++) {
        const double c[3] = {p[j].x, p[j].y, p[j].z};
        m->positions[3 * k + j] = cag_vec3(c[axis], c[(axis + 1) % 3], c[(axis + 2) % 3]);
      }
    }
    for (int j = 0; j < 3; j++) m->positions[3 * N + j] = cag_vec3(j, j, j); // collinear
    for (uint32_t k = 0; k < 3 * N + 3; k++) m->triangles[k] = k;
    const CagMeshPart part = {"t", m, NULL};
    size_t size;
    char *b = bytes_of(&part, 1, export_stl, &size);
    assert_int_equal(size, 84 + 50 * (N + 1));
    // (1, 2, 0) x (0, 1, -3) = (-6, 3, 1)
    const double c[3] = {-6 / sqrt(46), 3 / sqrt(46), 1 / sqrt(46)};
    const CagVec3 n = cag_vec3(c[axis], c[(axis + 1) % 3], c[(axis + 2) % 3]);
    for (int k = 0; k < N; k++)
      if (!(distance(n, vector_at(b + 84 + 50 * k)) < 1e-6)) fail_msg("scale %g", scales[k]);
    assert_true(cag_norm(vector_at(b + 84 + 50 * N)) == 0);
    free(b);
    cag_mesh_release(m);
  }
}

// --- OBJ ---

static void word_of(const char *name, char out[64]) {
  snprintf(out, 64, "%s", *name ? name : "_");
  for (char *c = out; *c; c++)
    if (*c <= ' ') *c = '_';
}

// Reads "a/b/c", "a//c", "a/b" or "a"; missing numbers are 0.
static const char *read_corner(const char *at, long out[3]) {
  char *end;
  out[1] = out[2] = 0;
  out[0] = strtol(at, &end, 10);
  for (int k = 1; k < 3 && *end == '/'; k++) {
    const char *digits = end + 1;
    out[k] = strtol(digits, &end, 10);
    if (end == digits) end = (char *)digits;
  }
  return end;
}

static void obj_has_every_corner(void **state) {
  (void)state;
  enum { MOST = 30000 };
  static CagVec3 v[MOST], vn[MOST];
  static double vt[MOST][2];
  seed = 2;
  for (int round = 0; round < 9; round++) {
    Scene s;
    random_scene(&s, round);
    size_t size, n[3] = {0}, part = SIZE_MAX, t = 0, points = 0;
    char *b = bytes_of(s.parts, s.count, export_obj, &size), *line = b, word[64];
    static const char *const materials[PARTS] = {
        "red_paint", "red_paint", "glass", "_", "red_paint", "", "red_paint.7", "_", "red_paint"};
    for (char *end; *line; line = end + 1) {
      end = strchr(line, '\n');
      *end = 0;
      if (!strncmp(line, "v ", 2)) {
        CagVec3 *p = &v[++n[0]];
        assert_int_equal(sscanf(line, "v %lf %lf %lf", &p->x, &p->y, &p->z), 3);
      } else if (!strncmp(line, "vn ", 3)) {
        CagVec3 *p = &vn[++n[2]];
        assert_int_equal(sscanf(line, "vn %lf %lf %lf", &p->x, &p->y, &p->z), 3);
      } else if (!strncmp(line, "vt ", 3)) {
        double *p = vt[++n[1]];
        assert_int_equal(sscanf(line, "vt %lf %lf", &p[0], &p[1]), 2);
      } else if (!strncmp(line, "o ", 2)) {
        part = part == SIZE_MAX ? 0 : part + 1;
        word_of(s.parts[part].name ? s.parts[part].name : "part", word);
        assert_string_equal(line + 2, word);
        const CagMesh *m = s.parts[part].mesh;
        for (size_t k = 0; k < m->vertex_count; k++) points += !m->weld || m->weld[k] == k;
        t = 0;
      } else if (!strncmp(line, "usemtl ", 7)) {
        assert_string_equal(line + 7, materials[part]);
      } else if (!strncmp(line, "s ", 2)) {
        assert_string_equal(line, s.parts[part].mesh->normals ? "s 1" : "s off");
      } else if (*line == 'f') {
        const CagMesh *m = s.parts[part].mesh;
        const char *at = line + 1;
        for (int j = 0; j < 3; j++) {
          const uint32_t k = m->triangles[3 * t + (size_t)j];
          long c[3];
          at = read_corner(at + 1, c);
          assert_true(c[0] > 0 && (size_t)c[0] <= n[0]);
          assert_true(distance(v[c[0]], m->positions[k]) < 2e-6);
          assert_true((c[1] != 0) == (m->uv != NULL) && (c[2] != 0) == (m->normals != NULL));
          if (c[1])
            assert_true(hypot(vt[c[1]][0] - m->uv[2 * k], vt[c[1]][1] - m->uv[2 * k + 1]) < 1e-8);
          if (c[2]) assert_true(distance(vn[c[2]], m->normals[k]) < 1e-8);
        }
        assert_true(*at == 0);
        t++;
      } else if (strcmp(line, "mtllib a.mtl") != 0 && *line != '#') fail_msg("the line %s", line);
    }
    assert_int_equal(part, s.count - 1);
    assert_int_equal(n[0], points);
    assert_int_equal(t, s.parts[part].mesh->triangle_count);
    free(b);
    scene_free(&s);
  }
}

static void is_line(const char *text, const char *word, const double *x, int n) {
  char head[8];
  snprintf(head, sizeof head, "\n%s ", word);
  const char *at = strstr(text, head);
  assert_non_null(at);
  at += strlen(head);
  for (int k = 0; k < n; k++) {
    char *end;
    const double y = strtod(at, &end);
    if (end == at || fabs(y - x[k]) > 1e-8 * fmax(1, fabs(x[k])))
      fail_msg("%s: %.9g, not %.9g in %.200s", word, y, x[k], text);
    at = end;
  }
}

static double srgb(double linear) {
  const double c = fmin(fmax(linear, 0), 1);
  return c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055;
}

// A metal has no diffuse color. At normal incidence, a dielectric reflects according to Fresnel's
// formula. Phong's exponent is 2 / roughness^4 - 2, at most 1000.
static void mtl_has_every_material_once(void **state) {
  (void)state;
  seed = 3;
  Scene s;
  random_scene(&s, 0);
  size_t size;
  char *b = bytes_of(s.parts, s.count, cag_export_mtl, &size);
  static const char *const names[] = {"red_paint", "glass", "red_paint.7", "_"};
  size_t found = 0;
  for (const char *at = b; (at = strstr(at, "newmtl ")); at++) found++;
  assert_int_equal(found, 4);
  for (int i = 0; i < 4; i++) {
    char head[40];
    snprintf(head, sizeof head, "newmtl %s\n", names[i]);
    const char *at = strstr(b, head);
    if (!at) fail_msg("no %s", head);
    const CagMaterial *m = &s.materials[i];
    const double rgb[3] = {m->color.r, m->color.g, m->color.b};
    const double emission[3] = {m->emission.r, m->emission.g, m->emission.b};
    double kd[3], ks[3], ke[3];
    for (int k = 0; k < 3; k++) {
      const double f0 = pow((m->ior - 1) / (m->ior + 1), 2);
      kd[k] = srgb(rgb[k] * (1 - m->metallic));
      ks[k] = srgb(f0 * (1 - m->metallic) + rgb[k] * m->metallic);
      ke[k] = srgb(emission[k]);
    }
    is_line(at, "Kd", kd, 3);
    is_line(at, "Ks", ks, 3);
    is_line(at, "Ke", ke, 3);
    is_line(at, "Ns", (const double[]){fmin(1000, fmax(0, 2 / pow(m->roughness, 4) - 2))}, 1);
    is_line(at, "Ni", &m->ior, 1);
    is_line(at, "d", (const double[]){1 - m->transmission}, 1);
    is_line(at, "Pr", &m->roughness, 1);
    is_line(at, "Pm", &m->metallic, 1);
    is_line(at, "Pc", &m->coat, 1);
    is_line(at, "illum", (const double[]){m->transmission > 0 ? 7 : 2}, 1);
  }
  free(b);
  scene_free(&s);
}

// --- PLY ---

// The number within its part of the vertex in the file that represents vertex v: one for each
// normal of a point, in order of occurrence. *first is the vertex itself.
static size_t number_in_ply(const CagMesh *m, size_t *kept, size_t n, size_t v) {
  for (size_t k = 0; k < n; k++) {
    const size_t u = kept[k];
    const bool point = u == v || (m->weld && m->weld[u] == m->weld[v]);
    if (point && (!m->normals || u == v || cag_dot(m->normals[u], m->normals[v]) >= 1 - 1e-6))
      return k;
  }
  return n;
}

static void ply_has_every_corner(void **state) {
  (void)state;
  static size_t kept[5000], number[5000];
  seed = 4;
  for (int round = 0; round < 9; round++) {
    Scene s;
    random_scene(&s, round);
    size_t size, vertices, triangles, first = 0, seen = 0;
    char *b = bytes_of(s.parts, s.count, cag_export_ply, &size);
    assert_int_equal(sscanf(strstr(b, "element vertex"), "element vertex %zu", &vertices), 1);
    assert_int_equal(sscanf(strstr(b, "element face"), "element face %zu", &triangles), 1);
    const char *at = strstr(b, "end_header\n") + strlen("end_header\n");
    const char *faces = at + 35 * vertices;
    assert_int_equal(size, (size_t)(faces - b) + 13 * triangles);
    for (size_t i = 0; i < s.count; i++) {
      const CagMesh *m = s.parts[i].mesh;
      size_t n = 0;
      for (size_t v = 0; v < m->vertex_count; v++) {
        number[v] = number_in_ply(m, kept, n, v);
        if (number[v] == n) kept[n++] = v;
      }
      CagVec3 *sums = calloc(m->vertex_count, sizeof *sums);
      for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *k = m->triangles + 3 * t;
        const CagVec3 a = m->positions[k[0]], p = m->positions[k[1]], q = m->positions[k[2]];
        const CagVec3 cross = cag_cross(cag_sub(p, a), cag_sub(q, a));
        for (int j = 0; j < 3; j++) sums[number[k[j]]] = cag_add(sums[number[k[j]]], cross);
      }
      for (size_t k = 0; k < n; k++, at += 35) {
        const size_t v = kept[k];
        assert_true(distance(vector_at(at), m->positions[v]) < 1e-6);
        const CagVec3 normal = m->normals ? m->normals[v] : cag_unit(sums[k]);
        assert_true(distance(vector_at(at + 12), normal) < 1e-6);
        const double u = m->uv ? m->uv[2 * v] : 0;
        assert_true(float_at(at + 24) == (float)u);
        assert_true(float_at(at + 28) == (float)(m->uv ? m->uv[2 * v + 1] : 0));
        const CagMaterial *material = s.parts[i].material;
        CagColor c = material ? material->color : (CagColor){1, 1, 1};
        if (m->scale.kind) c = cag_color_scale_at(&m->scale, u);
        const double rgb[3] = {c.r, c.g, c.b};
        for (int j = 0; j < 3; j++) assert_int_equal((unsigned char)at[32 + j], srgb_byte(rgb[j]));
      }
      for (size_t t = 0; t < m->triangle_count; t++) {
        if (shrinks(m, t)) continue;
        assert_int_equal(*faces, 3);
        for (int j = 0; j < 3; j++)
          assert_int_equal(word_at(faces + 1 + 4 * j),
                           first + number[m->triangles[3 * t + (size_t)j]]);
        faces += 13;
        seen++;
      }
      first += n;
      free(sums);
    }
    assert_int_equal(first, vertices);
    assert_int_equal(seen, triangles);
    free(b);
    scene_free(&s);
  }
}

// --- Reading back ---

static double corner_off(const CagMesh *a, uint32_t i, const CagMesh *b, uint32_t j) {
  double off = distance(a->positions[i], b->positions[j]) / 1000;
  if (a->normals && b->normals) off = fmax(off, distance(a->normals[i], b->normals[j]));
  if (a->uv && b->uv)
    off = fmax(off, hypot(a->uv[2 * i] - b->uv[2 * j], a->uv[2 * i + 1] - b->uv[2 * j + 1]));
  return off;
}

// Each part alone, written and read: the same triangles in the same order.
static void what_was_written_is_read(void **state) {
  (void)state;
  static const struct {
    const char *name;
    Export *export;
    bool normals, uv;
  } formats[] = {{"a.obj", export_obj, true, true},
                 {"a.stl", export_stl, false, false},
                 {"a.ply", cag_export_ply, true, false},
                 {"a.glb", cag_export_glb, true, true},
                 {"a.gltf", export_gltf, true, true}};
  seed = 9;
  for (int round = 0; round < 8; round++) {
    Scene s;
    random_scene(&s, round);
    for (size_t i = 0; i < PARTS - 1; i++)
      for (size_t k = 0; k < 5; k++) {
        const CagMesh *m = s.meshes[i];
        CagMesh *found = NULL;
        size_t size, n = 0;
        CagMeshPart part = s.parts[i];
        part.material = NULL;
        stem = NULL;
        char *b = bytes_of(&part, 1, formats[k].export, &size);
        const CagMeshFile file = {.name = formats[k].name,
                                  .bytes = b,
                                  .size = size,
                                  .max_triangles = 1000000,
                                  .max_memory = 1 << 28};
        OK(cag_mesh_read(&file, &found, &err));
        if (m->normals && formats[k].normals) assert_non_null(found->normals);
        assert_true((found->uv != NULL) == ((m->uv && formats[k].uv) || k == 2));
        for (size_t t = 0; t < m->triangle_count; t++) {
          if (shrinks(m, t)) continue;
          assert_true(n < found->triangle_count);
          for (size_t j = 0; j < 3; j++) {
            const double off =
                corner_off(m, m->triangles[3 * t + j], found, found->triangles[3 * n + j]);
            // PLY has only one parameter pair for each normal of a point.
            if (off > 2e-6 && !(k == 2 && m->weld))
              fail_msg("%s: a corner is %g off", formats[k].name, off);
          }
          n++;
        }
        if (k == 0) // OBJ keeps triangles that degenerate in single precision
          n = found->triangle_count;
        assert_int_equal(found->triangle_count, n);
        cag_mesh_release(found);
        free(b);
      }
    scene_free(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stl_has_every_triangle),
      cmocka_unit_test(stl_normals_have_length_1_at_any_size),
      cmocka_unit_test(obj_has_every_corner),
      cmocka_unit_test(mtl_has_every_material_once),
      cmocka_unit_test(ply_has_every_corner),
      cmocka_unit_test(what_was_written_is_read),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
