// Binary glTF 2.0: a JSON chunk that describes, and a binary chunk with positions, normals,
// parameters and indices of each part, one after the other.

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "interp/export/mesh_write.h"

#ifndef CAG_VERSION
#define CAG_VERSION "0"
#endif

enum { GLB_HEADER = 12, CHUNK_HEADER = 8, BATCH = 1024 };
// Numbers of the glTF specification.
enum { FLOAT = 5126, UNSIGNED_INT = 5125, ARRAY_BUFFER = 34962, ELEMENT_ARRAY_BUFFER = 34963 };

// The JSON as it grows. After memory ran out nothing is added.
typedef struct Text {
  char *at;
  size_t length, capacity;
  bool failed;
} Text;

typedef struct GlbPart {
  float *positions;
  size_t triangles; // 0: the part is left out
  size_t material;  // number in the file
  float least[3], most[3];
} GlbPart;

// --- JSON ---

static bool make_room(Text *t, size_t n) {
  if (t->failed) return false;
  if (t->length + n < t->capacity) return true;
  size_t capacity = 2 * (t->length + n) + 4096;
  char *larger = realloc(t->at, capacity);
  t->failed = !larger;
  if (!larger) return false;
  t->at = larger;
  t->capacity = capacity;
  return true;
}

__attribute__((format(printf, 2, 3))) static void add(Text *t, const char *format, ...) {
  va_list args;
  va_start(args, format);
  int n = vsnprintf(NULL, 0, format, args);
  va_end(args);
  if (n < 0 || !make_room(t, (size_t)n + 1)) return;
  va_start(args, format);
  vsnprintf(t->at + t->length, (size_t)n + 1, format, args);
  va_end(args);
  t->length += (size_t)n;
}

static void add_string(Text *t, const char *s) {
  add(t, "\"");
  for (; *s; s++) {
    unsigned char c = (unsigned char)*s;
    if (c == '"' || c == '\\') add(t, "\\%c", c);
    else if (c < ' ') add(t, "\\u%04x", c);
    else add(t, "%c", c);
  }
  add(t, "\"");
}

// 9 digits give back a float exactly; validators compare bounds with the data.
static void add_numbers(Text *t, const char *key, const float *x, int n) {
  add(t, ",\"%s\":[", key);
  for (int k = 0; k < n; k++) add(t, "%s%.9g", k ? "," : "", (double)x[k]);
  add(t, "]");
}

static double unit_range(double x) { return fmin(fmax(x, 0), 1); }

static void add_material(Text *t, const CagMaterial *m) {
  double brightest = fmax(m->emission.r, fmax(m->emission.g, m->emission.b));
  double strength = fmax(1, brightest);
  add(t, "{\"name\":");
  add_string(t, m->name ? m->name : "material");
  add(t,
      ",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.9g,%.9g,%.9g,1],\"metallicFactor\":%.9g,"
      "\"roughnessFactor\":%.9g},\"alphaMode\":\"OPAQUE\",\"doubleSided\":true",
      unit_range(m->color.r), unit_range(m->color.g), unit_range(m->color.b),
      unit_range(m->metallic), unit_range(m->roughness));
  if (brightest > 0)
    add(t, ",\"emissiveFactor\":[%.9g,%.9g,%.9g]", unit_range(m->emission.r / strength),
        unit_range(m->emission.g / strength), unit_range(m->emission.b / strength));
  // What the core does not know is left out where it says the same as the core.
  const double core_ior = 1.5;
  Text e = {0};
  if (strength > 1)
    add(&e, ",\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%.9g}", strength);
  if (m->transmission > 0)
    add(&e, ",\"KHR_materials_transmission\":{\"transmissionFactor\":%.9g}",
        unit_range(m->transmission));
  if (m->ior != core_ior && m->ior >= 1) add(&e, ",\"KHR_materials_ior\":{\"ior\":%.9g}", m->ior);
  if (m->coat > 0)
    add(&e, ",\"KHR_materials_clearcoat\":{\"clearcoatFactor\":%.9g}", unit_range(m->coat));
  if (e.length > 0) add(t, ",\"extensions\":{%s}", e.at + 1);
  t->failed |= e.failed;
  free(e.at);
  add(t, "}");
}

// Names of the extensions in use, each once.
static void add_extensions(Text *t, const CagMeshPart *parts, const GlbPart *g, size_t n) {
  static const char *const names[] = {"KHR_materials_emissive_strength",
                                      "KHR_materials_transmission", "KHR_materials_ior",
                                      "KHR_materials_clearcoat"};
  bool used[4] = {false};
  for (size_t i = 0; i < n; i++) {
    const CagMaterial *m = parts[i].material;
    if (!m || g[i].triangles == 0) continue;
    used[0] |= fmax(m->emission.r, fmax(m->emission.g, m->emission.b)) > 1;
    used[1] |= m->transmission > 0;
    used[2] |= m->ior != 1.5 && m->ior >= 1;
    used[3] |= m->coat > 0;
  }
  const char *separator = ",\"extensionsUsed\":[";
  for (int k = 0; k < 4; k++) {
    if (!used[k]) continue;
    add(t, "%s\"%s\"", separator, names[k]);
    separator = ",";
  }
  if (*separator == ',' && separator[1] == '\0') add(t, "]");
}

static size_t material_number(const CagMeshPart *parts, const GlbPart *g, size_t i) {
  for (size_t k = 0; k < i; k++)
    if (g[k].triangles > 0 && parts[k].material == parts[i].material) return k;
  return i;
}

static void add_materials(Text *t, const CagMeshPart *parts, GlbPart *g, size_t n) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) {
    if (g[i].triangles == 0 || !parts[i].material) continue;
    size_t first = material_number(parts, g, i);
    g[i].material = first < i ? g[first].material : count;
    if (first < i) continue;
    add(t, "%s", count++ ? "," : ",\"materials\":[");
    add_material(t, parts[i].material);
  }
  if (count > 0) add(t, "]");
}

static void add_nodes(Text *t, const CagMeshPart *parts, const GlbPart *g, size_t n) {
  size_t shown = 0;
  // A quarter turn about x brings z up to y up; metres are 1000 mm.
  add(t, ",\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"scene\",\"rotation\":"
         "[-0.7071067811865476,0,0,0.7071067811865476],\"scale\":[0.001,0.001,0.001]");
  for (size_t i = 0; i < n; i++)
    if (g[i].triangles > 0) add(t, "%s%zu", shown ? "," : ",\"children\":[", shown + 1), shown++;
  add(t, "%s}", shown ? "]" : "");
  shown = 0;
  for (size_t i = 0; i < n; i++) {
    if (g[i].triangles == 0) continue;
    add(t, ",{\"name\":");
    add_string(t, parts[i].name ? parts[i].name : "part");
    add(t, ",\"mesh\":%zu}", shown++);
  }
  add(t, "]");
}

// Accessors and buffer views go side by side: number k of each is the same data.
static void add_meshes(Text *t, const CagMeshPart *parts, const GlbPart *g, size_t n) {
  size_t shown = 0, view = 0;
  for (size_t i = 0; i < n; i++) {
    if (g[i].triangles == 0) continue;
    const CagMesh *m = parts[i].mesh;
    add(t, "%s{\"name\":", shown++ ? "," : ",\"meshes\":[");
    add_string(t, parts[i].name ? parts[i].name : "part");
    add(t, ",\"primitives\":[{\"attributes\":{\"POSITION\":%zu", view++);
    if (m->normals) add(t, ",\"NORMAL\":%zu", view++);
    if (m->uv) add(t, ",\"TEXCOORD_0\":%zu", view++);
    add(t, "},\"indices\":%zu", view++);
    if (parts[i].material) add(t, ",\"material\":%zu", g[i].material);
    add(t, "}]}");
  }
  if (shown > 0) add(t, "]");
}

static void add_accessor(Text *t, size_t *view, size_t count, const char *type, int component) {
  add(t, "%s{\"bufferView\":%zu,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
      *view ? "," : ",\"accessors\":[", *view, component, count, type);
  ++*view;
}

static void add_accessors(Text *t, const CagMeshPart *parts, const GlbPart *g, size_t n) {
  size_t view = 0;
  for (size_t i = 0; i < n; i++) {
    if (g[i].triangles == 0) continue;
    const CagMesh *m = parts[i].mesh;
    add_accessor(t, &view, m->vertex_count, "VEC3", FLOAT);
    add_numbers(t, "min", g[i].least, 3);
    add_numbers(t, "max", g[i].most, 3);
    add(t, "}");
    if (m->normals) add_accessor(t, &view, m->vertex_count, "VEC3", FLOAT), add(t, "}");
    if (m->uv) add_accessor(t, &view, m->vertex_count, "VEC2", FLOAT), add(t, "}");
    add_accessor(t, &view, 3 * g[i].triangles, "SCALAR", UNSIGNED_INT);
    add(t, "}");
  }
  if (view > 0) add(t, "]");
}

static uint64_t add_view(Text *t, uint64_t offset, uint64_t bytes, int target) {
  add(t, "%s{\"buffer\":0,\"byteOffset\":%llu,\"byteLength\":%llu,\"target\":%d}",
      offset ? "," : ",\"bufferViews\":[", (unsigned long long)offset, (unsigned long long)bytes,
      target);
  return offset + bytes;
}

// Gives the length of the binary chunk.
static uint64_t add_views(Text *t, const CagMeshPart *parts, const GlbPart *g, size_t n) {
  uint64_t offset = 0;
  for (size_t i = 0; i < n; i++) {
    if (g[i].triangles == 0) continue;
    const CagMesh *m = parts[i].mesh;
    offset = add_view(t, offset, (uint64_t)m->vertex_count * 12, ARRAY_BUFFER);
    if (m->normals) offset = add_view(t, offset, (uint64_t)m->vertex_count * 12, ARRAY_BUFFER);
    if (m->uv) offset = add_view(t, offset, (uint64_t)m->vertex_count * 8, ARRAY_BUFFER);
    offset = add_view(t, offset, (uint64_t)g[i].triangles * 12, ELEMENT_ARRAY_BUFFER);
  }
  if (offset > 0) add(t, "],\"buffers\":[{\"byteLength\":%llu}]", (unsigned long long)offset);
  return offset;
}

// --- Binary ---

static bool begin_part(GlbPart *g, const CagMesh *m) {
  g->positions = cag_mesh_float_positions(m);
  if (!g->positions) return false;
  g->triangles = cag_mesh_kept_triangles(m, g->positions);
  for (int axis = 0; axis < 3; axis++) g->least[axis] = INFINITY, g->most[axis] = -INFINITY;
  for (size_t v = 0; v < m->vertex_count; v++)
    for (int axis = 0; axis < 3; axis++) {
      float x = g->positions[3 * v + axis];
      if (x < g->least[axis]) g->least[axis] = x;
      if (x > g->most[axis]) g->most[axis] = x;
    }
  return true;
}

static void write_floats(const float *x, size_t n, CagAtomicFile *file) {
  for (size_t k = 0; k < n;) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * 4);
    for (size_t end = k + BATCH; k < n && k < end; k++) at = cag_mesh_put_float(at, x[k]);
    cag_atomic_file_advance(file, at);
  }
}

static void write_doubles(const double *x, size_t n, CagAtomicFile *file) {
  for (size_t k = 0; k < n;) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * 4);
    for (size_t end = k + BATCH; k < n && k < end; k++) at = cag_mesh_put_float(at, (float)x[k]);
    cag_atomic_file_advance(file, at);
  }
}

static void write_vectors(const CagVec3 *x, size_t n, CagAtomicFile *file) {
  for (size_t k = 0; k < n;) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * 12);
    for (size_t end = k + BATCH; k < n && k < end; k++) {
      at = cag_mesh_put_float(at, (float)x[k].x);
      at = cag_mesh_put_float(at, (float)x[k].y);
      at = cag_mesh_put_float(at, (float)x[k].z);
    }
    cag_atomic_file_advance(file, at);
  }
}

static void write_part(const CagMesh *m, const GlbPart *g, CagAtomicFile *file) {
  write_floats(g->positions, 3 * m->vertex_count, file);
  if (m->normals) write_vectors(m->normals, m->vertex_count, file);
  if (m->uv) write_doubles(m->uv, 2 * m->vertex_count, file);
  for (size_t t = 0; t < m->triangle_count;) {
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * 12);
    for (size_t end = t + BATCH; t < m->triangle_count && t < end; t++) {
      const uint32_t *k = m->triangles + 3 * t;
      if (cag_mesh_shrinks(g->positions, k)) continue;
      for (int j = 0; j < 3; j++) at = cag_mesh_put_u32(at, k[j]);
    }
    cag_atomic_file_advance(file, at);
  }
}

static void write_words(CagAtomicFile *file, uint32_t a, uint32_t b, uint32_t c, int n) {
  char bytes[12];
  cag_mesh_put_u32(cag_mesh_put_u32(cag_mesh_put_u32(bytes, a), b), c);
  cag_atomic_file_write(file, bytes, 4 * (size_t)n);
}

static CagStatus write_file(const CagMeshPart *parts, GlbPart *g, size_t n, Text *json,
                            CagAtomicFile *file, CagError *err) {
  const uint32_t magic = 0x46546c67, version = 2, json_chunk = 0x4e4f534a,
                 binary_chunk = 0x004e4942;
  add(json, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"cag " CAG_VERSION "\"}");
  add_extensions(json, parts, g, n);
  add_nodes(json, parts, g, n);
  add_materials(json, parts, g, n);
  add_meshes(json, parts, g, n);
  add_accessors(json, parts, g, n);
  uint64_t binary = add_views(json, parts, g, n);
  add(json, "}");
  while (!json->failed && json->length % 4) add(json, " ");
  if (json->failed) return cag_fail_memory(err);
  uint64_t total = GLB_HEADER + CHUNK_HEADER + json->length + (binary ? CHUNK_HEADER + binary : 0);
  if (total > UINT32_MAX)
    return cag_fail(err, CAG_E_LIMIT, "file-too-large", "", -1,
                    "a GLB file holds at most 4 GB, the scene takes %.1f GB: use a larger "
                    "tolerance or PLY",
                    (double)total / 1e9);
  write_words(file, magic, version, (uint32_t)total, 3);
  write_words(file, (uint32_t)json->length, json_chunk, 0, 2);
  cag_atomic_file_write(file, json->at, json->length);
  if (binary > 0) write_words(file, (uint32_t)binary, binary_chunk, 0, 2);
  for (size_t i = 0; i < n; i++)
    if (g[i].triangles > 0) write_part(parts[i].mesh, &g[i], file);
  return CAG_OK;
}

CagStatus cag_export_glb(const CagMeshPart *parts, size_t n, CagAtomicFile *file, CagError *err) {
  GlbPart *g = calloc(n + 1, sizeof *g);
  CagStatus status = g ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; status == CAG_OK && i < n; i++) {
    status = cag_mesh_check_range(&parts[i], err);
    if (status == CAG_OK && !begin_part(&g[i], parts[i].mesh)) status = cag_fail_memory(err);
  }
  Text json = {0};
  if (status == CAG_OK) status = write_file(parts, g, n, &json, file, err);
  free(json.at);
  for (size_t i = 0; g && i < n; i++) free(g[i].positions);
  free(g);
  return status;
}
