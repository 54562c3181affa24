// Wavefront OBJ and its material library MTL.

#include <stdio.h>

#include "base/decimal.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/formats/mesh_write.h"

enum { NUMBER_BYTES = 25, INDEX_BYTES = 21, WORD_BYTES = 240, BATCH = 64 };

typedef struct ObjCounts {
  uint64_t points, normals, parameters; // written so far
} ObjCounts;

static char *put_text(char *at, const char *text) {
  size_t n = strlen(text);
  memcpy(at, text, n);
  return at + n;
}

// Writes one line: a word and its numbers.
static char *put_line(char *at, const char *word, const double *x, int n) {
  at = put_text(at, word);
  for (int k = 0; k < n; k++) {
    *at++ = ' ';
    at = cag_mesh_write_number(at, x[k]);
  }
  *at++ = '\n';
  return at;
}

// The materials of the parts. Names in the file are unique: a material whose name is already taken
// gets the number of the first part that uses it as a suffix.
typedef struct ObjMaterials {
  CagMaterialList list;
  size_t *of;    // index of each part's material
  size_t *first; // the first part that uses each material
  bool *taken;   // an earlier material has the name
} ObjMaterials;

static void free_materials(ObjMaterials *m) {
  cag_material_list_free(&m->list);
  cag_free(m->of);
  cag_free(m->first);
  cag_free(m->taken);
  *m = (ObjMaterials){0};
}

static const char *material_name(const CagMaterial *m) { return m->name ? m->name : "material"; }

// Marks the materials whose names are taken. Materials without a name take none.
static bool mark_taken(ObjMaterials *m) {
  CagHashIndex names = {0};
  bool good = true;
  for (size_t i = 0; good && i < m->list.count; i++) {
    const char *name = material_name(m->list.items[i]);
    const uint64_t hash = cag_hash_text(CAG_HASH_START, name);
    size_t k;
    CagHashWalk w = cag_hash_walk(&names, hash);
    while (!m->taken[i] && cag_hash_next(&w, &k))
      m->taken[i] = strcmp(m->list.items[k]->name, name) == 0;
    if (!m->taken[i] && m->list.items[i]->name) good = cag_hash_add(&names, hash, i);
  }
  cag_hash_free(&names);
  return good;
}

static CagStatus find_materials(const CagMeshPart *parts, size_t n, ObjMaterials *m,
                                CagError *err) {
  *m = (ObjMaterials){.of = cag_calloc(n + 1, sizeof *m->of),
                      .first = cag_calloc(n + 1, sizeof *m->first),
                      .taken = cag_calloc(n + 1, sizeof *m->taken)};
  bool good = m->of && m->first && m->taken;
  for (size_t i = 0; good && i < n; i++) {
    const size_t known = m->list.count;
    if (!parts[i].material) continue;
    good = cag_material_list_add(&m->list, parts[i].material, &m->of[i]);
    if (m->list.count > known) m->first[known] = i;
  }
  if (good && mark_taken(m)) return CAG_OK;
  free_materials(m);
  return cag_fail_memory(err);
}

static void write_material_name(const ObjMaterials *m, size_t number, CagAtomicFile *file) {
  char *start = cag_atomic_file_reserve(file, WORD_BYTES + INDEX_BYTES + 1);
  char *at = cag_mesh_write_word(start, material_name(m->list.items[number]), WORD_BYTES);
  if (m->taken[number]) {
    *at++ = '.';
    at = cag_decimal_index(at, m->first[number] + 1);
  }
  *at++ = '\n';
  cag_atomic_file_advance(file, at);
}

static void write_points(const CagMesh *m, uint32_t *number, ObjCounts *counts,
                         CagAtomicFile *file) {
  for (size_t v = 0; v < m->vertex_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * (3 * NUMBER_BYTES + 4));
    for (size_t end = v + BATCH; v < m->vertex_count && v < end; v++) {
      if (m->weld && m->weld[v] != v) {
        number[v] = number[m->weld[v]];
        continue;
      }
      number[v] = (uint32_t)++counts->points;
      const double x[3] = {m->positions[v].x, m->positions[v].y, m->positions[v].z};
      at = put_line(at, "v", x, 3);
    }
    cag_atomic_file_advance(file, at);
  }
}

static void write_parameters(const CagMesh *m, CagAtomicFile *file) {
  for (size_t v = 0; v < m->vertex_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * (2 * NUMBER_BYTES + 4));
    for (size_t end = v + BATCH; v < m->vertex_count && v < end; v++)
      at = put_line(at, "vt", m->uv + 2 * v, 2);
    cag_atomic_file_advance(file, at);
  }
}

static void write_normals(const CagMesh *m, CagAtomicFile *file) {
  for (size_t v = 0; v < m->vertex_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * (3 * NUMBER_BYTES + 4));
    for (size_t end = v + BATCH; v < m->vertex_count && v < end; v++) {
      const double x[3] = {m->normals[v].x, m->normals[v].y, m->normals[v].z};
      at = put_line(at, "vn", x, 3);
    }
    cag_atomic_file_advance(file, at);
  }
}

// Corners are point/parameters/normal, as far as the mesh has them.
static void write_faces(const CagMesh *m, const uint32_t *number, const ObjCounts *before,
                        CagAtomicFile *file) {
  for (size_t t = 0; t < m->triangle_count && !cag_stopped();) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * (9 * INDEX_BYTES + 4));
    for (size_t end = t + BATCH; t < m->triangle_count && t < end; t++) {
      *at++ = 'f';
      for (int j = 0; j < 3; j++) {
        uint32_t k = m->triangles[3 * t + j];
        *at++ = ' ';
        at = cag_decimal_index(at, number[k]);
        if (!m->uv && !m->normals) continue;
        *at++ = '/';
        if (m->uv) at = cag_decimal_index(at, before->parameters + k + 1);
        if (!m->normals) continue;
        *at++ = '/';
        at = cag_decimal_index(at, before->normals + k + 1);
      }
      *at++ = '\n';
    }
    cag_atomic_file_advance(file, at);
  }
}

// materials: NULL if none are written.
static CagStatus write_part(const CagMeshPart *parts, size_t i, const ObjMaterials *materials,
                            ObjCounts *counts, CagAtomicFile *file, CagError *err) {
  const CagMesh *m = parts[i].mesh;
  uint32_t *number = cag_malloc((m->vertex_count + 1) * sizeof *number);
  if (!number) return cag_fail_memory(err);
  char *at = cag_atomic_file_reserve(file, WORD_BYTES + 8);
  at = put_text(at, "o ");
  at = cag_mesh_write_word(at, parts[i].name ? parts[i].name : "part", WORD_BYTES);
  *at++ = '\n';
  cag_atomic_file_advance(file, at);
  ObjCounts before = *counts;
  write_points(m, number, counts, file);
  if (m->uv) {
    write_parameters(m, file);
    counts->parameters += m->vertex_count;
  }
  if (m->normals) {
    write_normals(m, file);
    counts->normals += m->vertex_count;
  }
  if (materials && parts[i].material) {
    cag_atomic_file_text(file, "usemtl ");
    write_material_name(materials, materials->of[i], file);
  }
  cag_atomic_file_text(file, m->normals ? "s 1\n" : "s off\n");
  write_faces(m, number, &before, file);
  cag_free(number);
  return CAG_OK;
}

CagStatus cag_export_obj(const CagMeshPart *parts, size_t n, const char *material_file,
                         CagAtomicFile *file, CagError *err) {
  cag_atomic_file_text(file, "# written by cag, lengths in mm, z up\n");
  if (material_file) cag_atomic_file_printf(file, "mtllib %s\n", material_file);
  ObjCounts counts = {0};
  ObjMaterials materials = {0};
  CagStatus status = material_file ? find_materials(parts, n, &materials, err) : CAG_OK;
  for (size_t i = 0; !status && i < n; i++)
    status = write_part(parts, i, material_file ? &materials : NULL, &counts, file, err);
  free_materials(&materials);
  return status;
}

// --- Materials ---

static void write_color(CagAtomicFile *file, const char *word, CagColor c, double strength) {
  double x[3] = {c.r, c.g, c.b};
  for (int k = 0; k < 3; k++) x[k] = cag_linear_to_srgb(fmin(fmax(x[k] * strength, 0), 1));
  char *at = cag_atomic_file_reserve(file, 3 * NUMBER_BYTES + 8);
  cag_atomic_file_advance(file, put_line(at, word, x, 3));
}

static void write_value(CagAtomicFile *file, const char *word, double x) {
  char *at = cag_atomic_file_reserve(file, NUMBER_BYTES + 8);
  cag_atomic_file_advance(file, put_line(at, word, &x, 1));
}

static void write_material(const CagMaterial *m, CagAtomicFile *file) {
  // Phong's exponent for highlights of the same width as the roughness: 2 / roughness^4 - 2.
  const double most_shiny = 1000;
  double alpha = fmax(m->roughness * m->roughness, 0.04);
  // A dielectric reflects ((n - 1)/(n + 1))^2 of light at normal incidence, and a metal its color.
  double f0 = (m->ior - 1) / (m->ior + 1);
  CagColor mirror = {f0 * f0 + (m->color.r - f0 * f0) * m->metallic,
                     f0 * f0 + (m->color.g - f0 * f0) * m->metallic,
                     f0 * f0 + (m->color.b - f0 * f0) * m->metallic};
  write_color(file, "Kd", m->color, 1 - m->metallic);
  write_color(file, "Ks", mirror, 1);
  write_color(file, "Ke", m->emission, 1);
  write_value(file, "Ns", fmin(most_shiny, fmax(0, 2 / (alpha * alpha) - 2)));
  write_value(file, "Ni", m->ior);
  write_value(file, "d", 1 - m->transmission);
  write_value(file, "Pr", m->roughness);
  write_value(file, "Pm", m->metallic);
  write_value(file, "Pc", m->coat);
  cag_atomic_file_text(file, m->transmission > 0 ? "illum 7\n" : "illum 2\n");
}

CagStatus cag_export_mtl(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err) {
  ObjMaterials materials;
  CagStatus status = find_materials(parts, n, &materials, err);
  if (status) return status;
  cag_atomic_file_text(file, "# written by cag\n");
  for (size_t i = 0; i < materials.list.count; i++) {
    cag_atomic_file_text(file, "\nnewmtl ");
    write_material_name(&materials, i, file);
    write_material(materials.list.items[i], file);
  }
  free_materials(&materials);
  return CAG_OK;
}
