// Random scenes of many meshes in every mesh format, read back with plain readers: each triangle
// has the positions, normals, parameters, colors and material that its part has.

#include "tests/geom/random.h"
#include "tests/interp/scene_fixture.h"

#include <cjson/cJSON.h>
#include <zlib.h>

#include "interp/export/mesh_copies.h"
#include "interp/export/mesh_formats.h"
#include "interp/import/mesh_read.h"
#include "interp/scene/color_scale.h"
#include "tests/interp/bytes.h"

#define PARTS 9

// --- Random meshes ---

static size_t below(size_t n) { return (size_t)uniform(0, (double)n - 1e-9); }

static CagVec3 random_unit(void) {
  CagVec3 v;
  do {
    v.x = uniform(-1, 1);
    v.y = uniform(-1, 1);
    v.z = uniform(-1, 1);
  } while (cag_norm(v) < 0.1 || cag_norm(v) > 1);
  return cag_unit(v);
}

// Whole numbers, which single precision holds. Some vertices are an earlier one again, some of
// these with the same normal, and some triangles have corners that single precision does not tell
// apart.
static CagMesh *random_mesh(size_t vertices, size_t triangles, int features, bool shrinking) {
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

static bool same_place(const CagMesh *m, uint32_t a, uint32_t b) {
  const CagVec3 p = m->positions[a], q = m->positions[b];
  return (float)p.x == (float)q.x && (float)p.y == (float)q.y && (float)p.z == (float)q.z;
}

static bool shrinks(const CagMesh *m, size_t t) {
  const uint32_t *k = m->triangles + 3 * t;
  return same_place(m, k[0], k[1]) || same_place(m, k[1], k[2]) || same_place(m, k[2], k[0]);
}

typedef struct Scene {
  CagMeshPart parts[PARTS];
  CagMesh *meshes[PARTS];
  CagMaterial materials[4];
  char names[PARTS][16];
  size_t count;
} Scene;

// Parts with all combinations of what a mesh may have. Part 1 is part 0 moved, part 2 is part 0
// again with another material, and part 8 has nothing that single precision leaves.
static void random_scene(Scene *s, int round) {
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
    else if (i == 6 && round == 2) // values by colors, in more than one batch
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

static void scene_free(Scene *s) {
  for (size_t i = 0; i < PARTS; i++) cag_mesh_release(s->meshes[i]);
}

// --- Files ---

typedef CagStatus Export(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err);

static CagStatus export_obj(const CagMeshPart *parts, size_t n, CagAtomicFile *file,
                            CagError *err) {
  return cag_export_obj(parts, n, "a.mtl", file, err);
}
static CagStatus export_stl(const CagMeshPart *parts, size_t n, CagAtomicFile *file,
                            CagError *err) {
  return cag_export_stl(parts, n, NULL, file, err);
}
static CagGltfData data;
static const char *stem;
static CagStatus export_gltf(const CagMeshPart *parts, size_t n, CagAtomicFile *file,
                             CagError *err) {
  return cag_export_gltf(parts, n, stem, file, &data, err);
}

// With a zero behind it.
static char *bytes_of(const CagMeshPart *parts, size_t n, Export *export, size_t *size) {
  CagIoError io;
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

static CagVec3 vector_at(const char *p) {
  return cag_vec3(float_at(p), float_at(p + 4), float_at(p + 8));
}
static double distance(CagVec3 a, CagVec3 b) { return cag_norm(cag_sub(a, b)); }

static int srgb_byte(double linear) {
  const double c = fmin(fmax(linear, 0), 1);
  return (int)floor(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1 / 2.4) - 0.055) + 0.5);
}

// --- STL ---

static void stl_has_every_triangle(void **state) {
  (void)state;
  seed = 1;
  for (int round = 0; round < 9; round++) {
    Scene s;
    random_scene(&s, round);
    if (round == 4) // without any that shrinks
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

// Triangles whose squares leave single precision have unit normals as well, and only those without
// an area have zeros. Each stands among ordinary ones.
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
    for (int j = 0; j < 3; j++) m->positions[3 * N + j] = cag_vec3(j, j, j); // on one line
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

// Reads "a/b/c", "a//c", "a/b" or "a"; what is missing is 0.
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

// A metal has no diffuse color. Light that meets a dielectric square is reflected by Fresnel's
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

// The number, within its part, of the vertex in the file that stands for vertex v: one for each
// normal of a point, in the order in which they come. *first: the vertex itself.
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

// --- glTF ---

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

// The data of an accessor; SIZE_MAX for `kind` if there is none. Its view must be inside the data.
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

static CagTransform place_of(const cJSON *node) {
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
    const CagTransform place = place_of(found);
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
  // Views follow each other without a gap.
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
    // Part 0, part 1 moved, and part 2 again share data; parts 0 and 2 differ in material.
    assert_int_equal((int)number_of(item(root, "nodes", 1), "mesh"),
                     (int)number_of(item(root, "nodes", 2), "mesh"));
    const cJSON *first = item(item(root, "meshes", 0), "primitives", 0);
    assert_int_equal((int)number_of(first, "indices"),
                     (int)number_of(item(item(root, "meshes", 1), "primitives", 0), "indices"));
    // The same data beside a file, and inside it.
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

// A scene without triangles has no data, and no name for it.
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

// Normals without a length become Z, and those of another length have length 1.
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

// --- 3MF ---

// The third member of the archive, unpacked; the directory must tell the same of each.
static char *model_of(const char *b, size_t size) {
  char *out = NULL;
  const char *at = b, *end = b + size - 22;
  assert_memory_equal(end, "PK\5\6", 4);
  const char *entry = b + word_at(end + 16);
  for (int k = 0; k < 3; k++) {
    assert_memory_equal(at, "PK\3\4", 4);
    assert_memory_equal(entry, "PK\1\2", 4);
    const size_t name = (unsigned char)at[26];
    assert_memory_equal(at + 14, entry + 16, 12);
    assert_memory_equal(at + 30, entry + 46, name);
    assert_int_equal(word_at(entry + 42), at - b);
    const uint32_t packed = word_at(at + 18), whole = word_at(at + 22);
    free(out);
    out = calloc(1, whole + 1);
    z_stream z = {.next_in = (Bytef *)at + 30 + name,
                  .avail_in = packed,
                  .next_out = (Bytef *)out,
                  .avail_out = whole};
    assert_int_equal(inflateInit2(&z, -15), Z_OK);
    assert_int_equal(inflate(&z, Z_FINISH), Z_STREAM_END);
    assert_int_equal(z.total_out, whole);
    inflateEnd(&z);
    assert_int_equal(crc32(0, (Bytef *)out, whole), word_at(at + 14));
    at += 30 + name + packed;
    entry += 46 + name;
  }
  assert_ptr_equal(at, b + word_at(end + 16));
  assert_ptr_equal(entry, end);
  assert_int_equal(word_at(end + 12), entry - at);
  return out;
}

static int scale_step(const CagColorScale *s, double value) {
  return (int)fmin(fmax(floor((value - s->from) / (s->to - s->from) * 256), 0), 255);
}

static void threemf_has_every_corner(void **state) {
  (void)state;
  static size_t points[5000];
  seed = 6;
  for (int round = 0; round < 9; round++) {
    Scene s;
    random_scene(&s, round);
    size_t size, built = 0;
    char *b = bytes_of(s.parts, s.count, cag_export_3mf, &size), *xml = model_of(b, size);
    const char *at = xml;
    // Materials in the order in which parts have them.
    const CagMaterial *const materials[] = {&s.materials[0], &s.materials[1], &s.materials[3],
                                            &s.materials[2]};
    for (int k = 0; k < 4; k++) {
      const CagMaterial *m = materials[k];
      char base[100];
      snprintf(base, sizeof base, "   <base name=\"%s\" displaycolor=\"#%02X%02X%02X%02X\"/>\n",
               m->name, srgb_byte(m->color.r), srgb_byte(m->color.g), srgb_byte(m->color.b),
               (int)(255 * (1 - m->transmission) + 0.5));
      const char *found = strstr(at, base);
      if (!found) fail_msg("no %s", base);
      at = found;
    }
    for (size_t i = 0; i < s.count; i++) {
      const CagMesh *m = s.parts[i].mesh;
      size_t kept = 0, n = 0;
      for (size_t t = 0; t < m->triangle_count; t++) kept += !shrinks(m, t);
      char head[100];
      snprintf(head, sizeof head, "  <object id=\"%zu\" type=\"surface\" name=\"", i + 2);
      const char *object = strstr(xml, head);
      assert_true((object != NULL) == (kept > 0));
      snprintf(head, sizeof head, "<item objectid=\"%zu\"/>", i + 2);
      assert_true((strstr(xml, head) != NULL) == (kept > 0));
      if (!object) continue;
      built++;
      if (i == 1) { // a copy of part 0
        CagVec3 c[4];
        object = strstr(object, "<component objectid=\"2\" transform=\"");
        assert_int_equal(sscanf(object,
                                "<component objectid=\"2\" transform=\"%lf %lf %lf %lf %lf %lf "
                                "%lf %lf %lf %lf %lf %lf\"",
                                &c[0].x, &c[0].y, &c[0].z, &c[1].x, &c[1].y, &c[1].z, &c[2].x,
                                &c[2].y, &c[2].z, &c[3].x, &c[3].y, &c[3].z),
                         12);
        for (size_t v = 0; v < m->vertex_count; v++) {
          const CagVec3 p = s.parts[0].mesh->positions[v];
          CagVec3 q = cag_madd(c[3], p.x, c[0]);
          q = cag_madd(cag_madd(q, p.y, c[1]), p.z, c[2]);
          assert_true(distance(q, m->positions[v]) < 1e-9);
        }
        continue;
      }
      const CagMaterial *material = s.parts[i].material;
      const char *close = strchr(strstr(object, "name=\"") + 6, '>'),
                 *pid = strstr(object, "pid=\"1\"");
      assert_true((pid && pid < close) == (material != NULL));
      if (material) {
        int k = 0;
        while (materials[k] != material) k++;
        assert_int_equal(strtol(strstr(pid, "pindex=\"") + 8, NULL, 10), k);
      }
      const char *end = strstr(object, "</object>"), *p = object;
      for (size_t v = 0; v < m->vertex_count; v++) {
        points[v] = m->weld ? points[m->weld[v]] : n;
        if (m->weld && m->weld[v] != v) continue;
        points[v] = n++;
        CagVec3 q;
        p = strstr(p + 1, "<vertex ");
        assert_int_equal(sscanf(p, "<vertex x=\"%lf\" y=\"%lf\" z=\"%lf\"/>", &q.x, &q.y, &q.z), 3);
        assert_true(distance(q, m->positions[v]) < 2e-6);
      }
      const char *next = strstr(p + 1, "<vertex ");
      assert_true(!next || next > end);
      for (size_t t = 0; t < m->triangle_count; t++) {
        if (shrinks(m, t)) continue;
        const uint32_t *k = m->triangles + 3 * t;
        char line[200];
        int used = snprintf(line, sizeof line, "<triangle v1=\"%zu\" v2=\"%zu\" v3=\"%zu\"",
                            points[k[0]], points[k[1]], points[k[2]]);
        if (m->scale.kind)
          used += snprintf(
              line + used, sizeof line - (size_t)used, " pid=\"%zu\" p1=\"%d\" p2=\"%d\" p3=\"%d\"",
              s.count + 2 + i, scale_step(&m->scale, m->uv[2 * k[0]]),
              scale_step(&m->scale, m->uv[2 * k[1]]), scale_step(&m->scale, m->uv[2 * k[2]]));
        snprintf(line + used, sizeof line - (size_t)used, "/>\n");
        p = strstr(p + 1, "<triangle ");
        if (!p || strncmp(p, line, strlen(line)) != 0)
          fail_msg("%.100s, not %s", p ? p : "none", line);
      }
      next = strstr(p + 1, "<triangle ");
      assert_true(!next || next > end);
      if (!m->scale.kind) continue;
      snprintf(head, sizeof head, "<m:colorgroup id=\"%zu\">", s.count + 2 + i);
      p = strstr(xml, head);
      assert_true(p && p < object); // a group stands before what refers to it
      for (int k = 0; k < 256; k++) {
        const CagColor c = cag_color_scale_at(
            &m->scale, m->scale.from + (m->scale.to - m->scale.from) * (k + 0.5) / 256);
        snprintf(head, sizeof head, "<m:color color=\"#%02X%02X%02X\"/>", srgb_byte(c.r),
                 srgb_byte(c.g), srgb_byte(c.b));
        p = strstr(p + 1, "<m:color ");
        assert_memory_equal(p, head, strlen(head));
      }
    }
    assert_int_equal(built, 8);
    free(xml);
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
            // PLY has one place in the parameters for each normal of a point.
            if (off > 2e-6 && !(k == 2 && m->weld))
              fail_msg("%s: a corner is %g off", formats[k].name, off);
          }
          n++;
        }
        if (k == 0) // OBJ keeps triangles that single precision shrinks
          n = found->triangle_count;
        assert_int_equal(found->triangle_count, n);
        cag_mesh_release(found);
        free(b);
      }
    scene_free(&s);
  }
}

// --- Copies ---

// A mesh that differs from a moved one in one thing that can be seen is no copy of it, and one that
// differs by rounding, or in the diagonal of a quad, is.
static void copies_differ_in_nothing_that_is_seen(void **state) {
  (void)state;
  seed = 7;
  CagTransform move, turn;
  OK(cag_rotate(cag_vec3(1, 2, 3), 1.25, cag_vec3(0, 5, 0), &turn, &err));
  move = cag_translate(cag_vec3(100, -20, 3));
  move = cag_transform_multiply(&move, &turn);
  static const struct {
    const char *what;
    bool copy;
  } changes[] = {{"nothing", true},
                 {"a position", false},
                 {"a position, by rounding", true},
                 {"a normal", false},
                 {"a normal, by little", true},
                 {"a parameter", false},
                 {"a parameter below", false},
                 {"a parameter, by little", true},
                 {"a large parameter, by little", true},
                 {"weld", false},
                 {"the scale", false},
                 {"its end", false},
                 {"its begin", false},
                 {"stripes", false},
                 {"the last triangle", false},
                 {"a turned triangle", true},
                 {"a reversed triangle", false},
                 {"a diagonal", true},
                 {"no quad", false},
                 {"normals left out", false},
                 {"parameters left out", false},
                 {"weld left out", false},
                 {"another count", false}};
  for (size_t k = 0; k < sizeof changes / sizeof *changes; k++)
    for (int moved = 0; moved < 3; moved++) {
      CagMesh *a = random_mesh(30, 12, 7, false), *b;
      const uint32_t quad[6] = {3, 7, 8, 3, 8, 9}, other[6] = {3, 7, 9, 7, 8, 9};
      memcpy(a->triangles + 6, quad, sizeof quad);
      a->uv[2 * 5] = 1e6;
      a->scale = (CagColorScale){CAG_SCALE_SEQUENCE, 0, 1, 3};
      const CagTransform unit = cag_transform_identity(),
                         shift = cag_translate(cag_vec3(1e3, 0, 7));
      const CagTransform *t = moved == 0 ? &unit : moved == 1 ? &shift : &move;
      if (k < 19) OK(cag_mesh_transform(a, t, &b, &err));
      else {
        OK(cag_mesh_new(k == 22 ? 31 : 30, 12, k != 19, k != 20, k != 21, &b, &err));
        for (size_t v = 0; v < 30; v++) b->positions[v] = cag_transform_point(t, a->positions[v]);
        memcpy(b->triangles, a->triangles, 36 * sizeof *a->triangles);
        if (k != 19)
          for (size_t v = 0; v < 30; v++) b->normals[v] = cag_transform_vector(t, a->normals[v]);
        if (k != 20) memcpy(b->uv, a->uv, 60 * sizeof *a->uv);
        if (k != 21) memcpy(b->weld, a->weld, 30 * sizeof *a->weld);
        if (k == 22)
          b->positions[30] = b->positions[0], b->weld[30] = 0, b->normals[30] = b->normals[0],
          b->uv[60] = b->uv[61] = 0;
      }
      b->scale = a->scale;
      uint32_t *last = b->triangles + 33;
      switch (k) {
      case 1: b->positions[20].y += 1e-3; break;
      case 2: b->positions[20].y += 1e-8; break;
      case 3: b->normals[20] = random_unit(); break;
      case 4: b->normals[20].z += 5e-7; break;
      case 5: b->uv[41] += 1e-3; break;
      case 6: b->uv[40] -= 1e-3; break;
      case 7: b->uv[40] += 5e-7; break;
      case 8: b->uv[10] += 0.5; break;
      case 9: b->weld[29] = b->weld[29] == 29 ? 0 : 29; break;
      case 10: b->scale.kind = CAG_SCALE_DIVERGING; break;
      case 11: b->scale.to = 2; break;
      case 12: b->scale.from = -1; break;
      case 13: b->scale.stripes = 4; break;
      case 14: last[2] = last[2] == 29 ? 28 : 29; break;
      case 15: {
        const uint32_t first = last[0];
        last[0] = last[1], last[1] = last[2], last[2] = first;
        break;
      }
      case 16: {
        const uint32_t first = last[0];
        last[0] = last[1], last[1] = first;
        break;
      }
      case 17: memcpy(b->triangles + 6, other, sizeof other); break;
      case 18: memcpy(b->triangles + 6, other, sizeof other), b->triangles[11] = 10; break;
      default: break;
      }
      const CagMeshPart parts[] = {{"a", a, NULL}, {"b", b, NULL}};
      CagMeshCopy *copies;
      OK(cag_mesh_find_copies(parts, 2, false, &copies, &err));
      assert_int_equal(copies[0].original, 0);
      if ((copies[1].original == 0) != changes[k].copy) fail_msg("%s (%d)", changes[k].what, moved);
      for (int i = 0; i < 4 && changes[k].copy; i++)
        for (int j = 0; j < 4; j++) {
          const double off = fabs(copies[1].place.m[i][j] - t->m[i][j]);
          // A copy that is only carried has exactly no turn.
          if (off > (j == 3 ? 1e-6 : moved < 2 ? 0 : 1e-9))
            fail_msg("%s: [%d][%d]", changes[k].what, i, j);
        }
      free(copies);
      cag_mesh_release(a);
      cag_mesh_release(b);
    }
}

// Many parts of few shapes: each is a copy of the first of its shape.
static void each_part_is_a_copy_of_the_first_of_its_shape(void **state) {
  (void)state;
  enum { N = 60, SHAPES = 7 };
  seed = 8;
  CagMesh *shapes[SHAPES], *meshes[N];
  CagMeshPart parts[N];
  static char names[2][2] = {"a", "b"};
  CagMaterial materials[2] = {{.name = names[0]}, {.name = names[1]}};
  size_t first[SHAPES][2], shape[N];
  for (size_t k = 0; k < SHAPES; k++) {
    shapes[k] = random_mesh(20, 10, 7, false); // all of the same counts
    first[k][0] = first[k][1] = SIZE_MAX;
  }
  for (size_t i = 0; i < N; i++) {
    CagTransform t;
    shape[i] = below(SHAPES);
    const double angle = uniform(-4, 4);
    OK(cag_rotate(random_unit(), angle, cag_vec3(1, 2, 3), &t, &err));
    OK(cag_mesh_transform(shapes[shape[i]], &t, &meshes[i], &err));
    parts[i] = (CagMeshPart){"p", meshes[i], &materials[below(2)]};
  }
  for (int same = 0; same < 2; same++) {
    CagMeshCopy *copies;
    OK(cag_mesh_find_copies(parts, N, same, &copies, &err));
    for (size_t k = 0; k < SHAPES; k++) first[k][0] = first[k][1] = SIZE_MAX;
    for (size_t i = 0; i < N; i++) {
      size_t *f = &first[shape[i]][same && parts[i].material == &materials[1]];
      if (*f == SIZE_MAX) *f = i;
      assert_int_equal(copies[i].original, *f);
      for (size_t v = 0; v < 20; v++)
        assert_true(distance(cag_transform_point(&copies[i].place, meshes[*f]->positions[v]),
                             meshes[i]->positions[v]) < 1e-8);
    }
    free(copies);
  }
  for (size_t k = 0; k < SHAPES; k++) cag_mesh_release(shapes[k]);
  for (size_t i = 0; i < N; i++) cag_mesh_release(meshes[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stl_has_every_triangle),
      cmocka_unit_test(stl_normals_have_length_1_at_any_size),
      cmocka_unit_test(obj_has_every_corner),
      cmocka_unit_test(mtl_has_every_material_once),
      cmocka_unit_test(ply_has_every_corner),
      cmocka_unit_test(gltf_has_every_corner),
      cmocka_unit_test(an_empty_gltf_has_no_data),
      cmocka_unit_test(gltf_normals_have_length_1),
      cmocka_unit_test(threemf_has_every_corner),
      cmocka_unit_test(what_was_written_is_read),
      cmocka_unit_test(copies_differ_in_nothing_that_is_seen),
      cmocka_unit_test(each_part_is_a_copy_of_the_first_of_its_shape),
  };
  return cmocka_run_group_tests_name("mesh_write", tests, NULL, NULL);
}
