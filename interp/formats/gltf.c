// The glTF 2.0 document: JSON, and the data with positions, normals, parameters, and indices of
// each mesh in sequence.
//
// Parts that are copies of another part share its data, and also its mesh if the material is the
// same. A node places each part. The root node converts millimeters with Z up to meters with Y up.

#include "interp/formats/gltf.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/array.h"
#include "base/json_text.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/scene/color_scale.h"

#ifndef CAG_VERSION
#define CAG_VERSION "0"
#endif

enum { BATCH = 2048 };
// Constants of the glTF specification.
enum { FLOAT = 5126, UNSIGNED_INT = 5125, ARRAY_BUFFER = 34962, ELEMENT_ARRAY_BUFFER = 34963 };

typedef CagGltfText Text;
typedef CagGltfPart Part;
typedef CagGltfPlan Plan;

// --- JSON ---

static bool make_room(Text *t, size_t n) {
  t->failed = t->failed || !CAG_RESERVE(t->at, t->capacity, t->length + n + 1);
  return !t->failed;
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
    char escape[8];
    const char *escaped = cag_json_escape(*s, escape);
    if (escaped) add(t, "%s", escaped);
    else add(t, "%c", *s);
  }
  add(t, "\"");
}

// 9 digits preserve a float exactly, and validators compare bounds with the data.
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
  // Properties of extensions are omitted if they equal the defaults of the core specification.
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
  cag_free(e.at);
  add(t, "}");
}

// Adds the names of the used extensions, each once.
static void add_extensions(Text *t, const Plan *p) {
  static const char *const names[] = {"KHR_materials_emissive_strength",
                                      "KHR_materials_transmission", "KHR_materials_ior",
                                      "KHR_materials_clearcoat"};
  bool used[4] = {false};
  for (size_t i = 0; i < p->materials.count; i++) {
    const CagMaterial *m = p->materials.items[i];
    used[0] |= fmax(m->emission.r, fmax(m->emission.g, m->emission.b)) > 1;
    used[1] |= m->transmission > 0;
    used[2] |= m->ior != 1.5 && m->ior >= 1;
    used[3] |= m->coat > 0;
  }
  bool any = false;
  for (int k = 0; k < 4; k++) {
    if (!used[k]) continue;
    add(t, "%s\"%s\"", any ? "," : ",\"extensionsUsed\":[", names[k]);
    any = true;
  }
  if (any) add(t, "]");
}

static void add_materials(Text *t, const Plan *p) {
  for (size_t i = 0; i < p->materials.count; i++) {
    add(t, "%s", i ? "," : ",\"materials\":[");
    add_material(t, p->materials.items[i]);
  }
  if (p->materials.count > 0) add(t, "]");
}

// Adds a rigid motion as translation and rotation. Identities are omitted.
static void add_place(Text *t, const CagTransform *place) {
  CagError err;
  double q[4];
  bool turned = false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) turned |= place->m[i][j] != (i == j);
  CagVec3 v = cag_vec3(place->m[0][3], place->m[1][3], place->m[2][3]);
  if (cag_norm(v) > 0) add(t, ",\"translation\":[%.17g,%.17g,%.17g]", v.x, v.y, v.z);
  CagTransform turn = *place;
  for (int i = 0; i < 3; i++) turn.m[i][3] = 0;
  if (turned && !cag_quaternion_of(&turn, q, &err))
    add(t, ",\"rotation\":[%.17g,%.17g,%.17g,%.17g]", q[1], q[2], q[3], q[0]);
}

static const char *name_of(const CagMeshPart *part) { return part->name ? part->name : "part"; }

static void add_nodes(Text *t, const Plan *p) {
  size_t shown = 0;
  // A quarter turn about x converts Z up to Y up; a meter is 1000 mm.
  add(t, ",\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"scene\",\"rotation\":"
         "[-0.7071067811865476,0,0,0.7071067811865476],\"scale\":[0.001,0.001,0.001]");
  for (size_t i = 0; i < p->count; i++)
    if (p->parts[i].shown) add(t, "%s%zu", shown ? "," : ",\"children\":[", shown + 1), shown++;
  add(t, "%s}", shown ? "]" : "");
  for (size_t i = 0; i < p->count; i++) {
    if (!p->parts[i].shown) continue;
    add(t, ",{\"name\":");
    add_string(t, name_of(&p->meshes[i]));
    add_place(t, &p->copies[i].place);
    add(t, ",\"mesh\":%zu}", p->parts[i].mesh);
  }
  add(t, "]");
}

// Accessors correspond to buffer views: number k of each is the same data.
static void add_meshes(Text *t, const Plan *p) {
  bool any = false;
  for (size_t i = 0; i < p->count; i++) {
    if (!p->parts[i].shown || p->parts[i].mesh_of != i) continue;
    const CagMesh *m = p->meshes[i].mesh;
    size_t view = p->parts[p->copies[i].original].first_view;
    add(t, "%s{\"name\":", any ? "," : ",\"meshes\":[");
    any = true;
    add_string(t, name_of(&p->meshes[i]));
    add(t, ",\"primitives\":[{\"attributes\":{\"POSITION\":%zu", view++);
    if (m->normals) add(t, ",\"NORMAL\":%zu", view++);
    if (m->uv) add(t, ",\"TEXCOORD_0\":%zu", view++);
    if (m->scale.kind) add(t, ",\"COLOR_0\":%zu", view++);
    add(t, "},\"indices\":%zu", view++);
    if (p->meshes[i].material) add(t, ",\"material\":%zu", p->parts[i].material);
    add(t, "}]}");
  }
  if (any) add(t, "]");
}

static void add_accessor(Text *t, size_t *view, size_t count, const char *type, int component) {
  add(t, "%s{\"bufferView\":%zu,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
      *view ? "," : ",\"accessors\":[", *view, component, count, type);
  ++*view;
}

static bool has_data(const Plan *p, size_t i) {
  return p->parts[i].triangles > 0 && p->copies[i].original == i;
}

static void add_accessors(Text *t, const Plan *p) {
  size_t view = 0;
  for (size_t i = 0; i < p->count; i++) {
    if (!has_data(p, i)) continue;
    const CagMesh *m = p->meshes[i].mesh;
    const Part *g = &p->parts[i];
    add_accessor(t, &view, m->vertex_count, "VEC3", FLOAT);
    add_numbers(t, "min", g->least, 3);
    add_numbers(t, "max", g->most, 3);
    add(t, "}");
    if (m->normals) add_accessor(t, &view, m->vertex_count, "VEC3", FLOAT), add(t, "}");
    if (m->uv) add_accessor(t, &view, m->vertex_count, "VEC2", FLOAT), add(t, "}");
    if (m->scale.kind) add_accessor(t, &view, m->vertex_count, "VEC3", FLOAT), add(t, "}");
    add_accessor(t, &view, 3 * g->triangles, "SCALAR", UNSIGNED_INT);
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

static void add_views(Text *t, const Plan *p) {
  uint64_t offset = 0;
  for (size_t i = 0; i < p->count; i++) {
    if (!has_data(p, i)) continue;
    const CagMesh *m = p->meshes[i].mesh;
    offset = add_view(t, offset, (uint64_t)m->vertex_count * 12, ARRAY_BUFFER);
    if (m->normals) offset = add_view(t, offset, (uint64_t)m->vertex_count * 12, ARRAY_BUFFER);
    if (m->uv) offset = add_view(t, offset, (uint64_t)m->vertex_count * 8, ARRAY_BUFFER);
    if (m->scale.kind) offset = add_view(t, offset, (uint64_t)m->vertex_count * 12, ARRAY_BUFFER);
    offset = add_view(t, offset, (uint64_t)p->parts[i].triangles * 12, ELEMENT_ARRAY_BUFFER);
  }
  if (offset > 0) add(t, "]");
}

// Adds a file name as a relative reference (RFC 3986).
static void add_uri(Text *t, const char *name) {
  add(t, ",\"uri\":\"");
  for (; *name; name++) {
    unsigned char c = (unsigned char)*name;
    bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                 (c != 0 && strchr("-._~", c));
    add(t, plain ? "%c" : "%%%02X", c);
  }
  add(t, "\"");
}

CagStatus cag_gltf_text(const CagGltfPlan *p, const char *uri, CagGltfText *t, CagError *err) {
  *t = (CagGltfText){0};
  add(t, "{\"asset\":{\"version\":\"2.0\",\"generator\":\"cag " CAG_VERSION "\"}");
  add_extensions(t, p);
  add_nodes(t, p);
  add_materials(t, p);
  add_meshes(t, p);
  add_accessors(t, p);
  add_views(t, p);
  if (p->data_bytes > 0) {
    add(t, ",\"buffers\":[{\"byteLength\":%llu", (unsigned long long)p->data_bytes);
    if (uri) add_uri(t, uri);
    // The position in the document for embedded data.
    t->data_at = t->length;
    add(t, "}]");
  }
  add(t, "}");
  while (!t->failed && t->length % 4) add(t, " ");
  if (!t->failed) return CAG_OK;
  cag_gltf_text_free(t);
  return cag_fail_memory(err);
}

void cag_gltf_text_free(CagGltfText *t) {
  cag_free(t->at);
  *t = (CagGltfText){0};
}

// --- The plan ---

// Assigns a mesh to part i's node: one with the same data and material, or a new one. Returns false
// if memory ran out.
static bool number_mesh(Plan *p, size_t i, size_t *meshes) {
  Part *g = &p->parts[i];
  const size_t original = p->copies[i].original;
  const CagMaterial *material = p->meshes[i].material;
  if (material && !cag_material_list_add(&p->materials, material, &g->material)) return false;
  const uint64_t hash = cag_hash_word(cag_hash_word(CAG_HASH_START, original), (uintptr_t)material);
  size_t k;
  for (CagHashWalk w = cag_hash_walk(&p->told, hash); cag_hash_next(&w, &k);) {
    if (p->copies[k].original != original || p->meshes[k].material != material) continue;
    g->mesh = p->parts[k].mesh;
    g->mesh_of = k;
    return true;
  }
  g->mesh = (*meshes)++;
  g->mesh_of = i;
  return cag_hash_add(&p->told, hash, i);
}

static CagStatus plan_part(Plan *p, size_t i, size_t *views, size_t *meshes, CagError *err) {
  Part *g = &p->parts[i];
  const CagMesh *m = p->meshes[i].mesh;
  if (p->copies[i].original == i) {
    CagStatus status = cag_mesh_floats(&p->meshes[i], &g->positions, g->least, g->most, err);
    if (status) return status;
    g->triangles = cag_mesh_kept_triangles(m, g->positions);
    if (g->triangles > 0) {
      g->first_view = *views;
      bool colored = m->scale.kind != CAG_SCALE_NONE;
      *views += 2 + (m->normals ? 1u : 0u) + (m->uv ? 1u : 0u) + colored;
      p->data_bytes += (uint64_t)m->vertex_count * (12 + (m->normals ? 12u : 0u) +
                                                    (m->uv ? 8u : 0u) + (colored ? 12u : 0u)) +
                       (uint64_t)g->triangles * 12;
    }
  }
  g->shown = p->parts[p->copies[i].original].triangles > 0;
  return !g->shown || number_mesh(p, i, meshes) ? CAG_OK : cag_fail_memory(err);
}

CagStatus cag_gltf_plan(const CagMeshPart *parts, size_t n, CagGltfPlan *p, CagError *err) {
  *p = (CagGltfPlan){.meshes = parts, .count = n};
  size_t views = 0, meshes = 0;
  p->parts = cag_calloc(n + 1, sizeof *p->parts);
  CagStatus status =
      p->parts ? cag_mesh_find_copies(parts, n, false, &p->copies, err) : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) status = plan_part(p, i, &views, &meshes, err);
  if (status) cag_gltf_plan_free(p);
  return status;
}

void cag_gltf_plan_free(CagGltfPlan *p) {
  for (size_t i = 0; p->parts && i < p->count; i++) cag_free(p->parts[i].positions);
  cag_free(p->parts);
  cag_free(p->copies);
  cag_material_list_free(&p->materials);
  cag_hash_free(&p->told);
  *p = (CagGltfPlan){0};
}

// --- Data ---

static void write_uv(const double *x, size_t n, CagAtomicFile *file) {
  for (size_t k = 0; k < n && !cag_stopped();) {
    size_t end = n - k < BATCH ? n : k + BATCH;
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * 4);
    for (; k < end; k++) at = cag_mesh_put_float(at, (float)x[k]);
    cag_atomic_file_advance(file, at);
  }
}

// Writes colors in linear light, as the format requires. They multiply the material's color.
static void write_colors(const CagMesh *m, CagAtomicFile *file) {
  for (size_t v = 0; v < m->vertex_count && !cag_stopped();) {
    size_t end = m->vertex_count - v < BATCH ? m->vertex_count : v + BATCH;
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * 12);
    for (; v < end; v++) {
      CagColor c = cag_color_scale_at(&m->scale, m->uv[2 * v]);
      at = cag_mesh_put_float(at, (float)c.r);
      at = cag_mesh_put_float(at, (float)c.g);
      at = cag_mesh_put_float(at, (float)c.b);
    }
    cag_atomic_file_advance(file, at);
  }
}

// Validators require normals of length 1, even where a surface has none.
static void write_normals(const CagVec3 *x, size_t n, CagAtomicFile *file) {
  const double most_off = 1e-3;
  for (size_t k = 0; k < n && !cag_stopped();) {
    size_t end = n - k < BATCH ? n : k + BATCH;
    char *at = cag_atomic_file_reserve(file, (size_t)BATCH * 12);
    for (; k < end; k++) {
      CagVec3 v = x[k];
      if (!(fabs(cag_dot(v, v) - 1) < most_off))
        v = cag_norm(v) > 0 && isfinite(cag_norm(v)) ? cag_unit(v) : cag_vec3(0, 0, 1);
      at = cag_mesh_put_float(at, (float)v.x);
      at = cag_mesh_put_float(at, (float)v.y);
      at = cag_mesh_put_float(at, (float)v.z);
    }
    cag_atomic_file_advance(file, at);
  }
}

static void write_indices(const CagMesh *m, const Part *g, CagAtomicFile *file) {
  if (g->triangles == m->triangle_count) {
    cag_mesh_write_words(file, m->triangles, 3 * m->triangle_count);
    return;
  }
  for (size_t t = 0; t < m->triangle_count && !cag_stopped(); t++) {
    const uint32_t *k = m->triangles + 3 * t;
    if (!cag_mesh_shrinks(g->positions, k)) cag_mesh_write_words(file, k, 3);
  }
}

void cag_gltf_write_data(const CagGltfPlan *p, CagAtomicFile *file) {
  for (size_t i = 0; i < p->count; i++) {
    if (!has_data(p, i)) continue;
    const CagMesh *m = p->meshes[i].mesh;
    const Part *g = &p->parts[i];
    cag_mesh_write_words(file, g->positions, 3 * m->vertex_count);
    if (m->normals) write_normals(m->normals, m->vertex_count, file);
    if (m->uv) write_uv(m->uv, 2 * m->vertex_count, file);
    if (m->scale.kind) write_colors(m, file);
    write_indices(m, g, file);
  }
}

// --- .gltf ---

static void write_base64(const unsigned char *bytes, size_t n, CagAtomicFile *file) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < n; i += 3) {
    char *at = cag_atomic_file_reserve(file, 4);
    size_t left = n - i;
    uint32_t x = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) |
                 (left > 2 ? bytes[i + 2] : 0);
    for (int k = 0; k < 4; k++) at[k] = digits[x >> (18 - 6 * k) & 63];
    if (left < 3) at[3] = '=';
    if (left < 2) at[2] = '=';
    cag_atomic_file_advance(file, at + 4);
  }
}

// Writes the document with embedded data.
static void write_embedded(const Text *t, const CagGltfData *d, CagAtomicFile *file) {
  cag_atomic_file_write(file, t->at, t->data_at);
  cag_atomic_file_text(file, ",\"uri\":\"data:application/octet-stream;base64,");
  write_base64((const unsigned char *)d->bytes, d->size, file);
  cag_atomic_file_text(file, "\"");
  cag_atomic_file_write(file, t->at + t->data_at, t->length - t->data_at);
}

static CagStatus make_data(const Plan *p, const char *stem, CagGltfData *out, CagError *err) {
  CagError io;
  if (p->data_bytes == 0) return CAG_OK;
  CagAtomicFile *memory = cag_atomic_file_open_memory(&io);
  if (!memory) return cag_fail_memory(err);
  cag_gltf_write_data(p, memory);
  if (!cag_atomic_file_commit_memory(memory, &out->bytes, &out->size, &io))
    return cag_fail_memory(err);
  if (!stem) return CAG_OK;
  const size_t room = strlen(stem) + sizeof "-0123456789abcdef.bin";
  out->name = cag_malloc(room);
  if (!out->name) return cag_fail_memory(err);
  snprintf(out->name, room, "%s-%016" PRIx64 ".bin", stem,
           cag_hash_bytes(CAG_HASH_START, out->bytes, out->size));
  return CAG_OK;
}

CagStatus cag_export_gltf(const CagMeshPart *parts, size_t n, const char *stem, CagAtomicFile *file,
                          CagGltfData *data, CagError *err) {
  Plan p;
  Text t = {0};
  *data = (CagGltfData){0};
  CagStatus status = cag_gltf_plan(parts, n, &p, err);
  if (status) return status;
  status = make_data(&p, stem, data, err);
  if (!status) status = cag_gltf_text(&p, data->name, &t, err);
  if (!status && !stem && data->bytes) write_embedded(&t, data, file);
  else if (!status) cag_atomic_file_write(file, t.at, t.length);
  if (status || !stem) {
    cag_free(data->name);
    cag_free(data->bytes);
    *data = (CagGltfData){0};
  }
  cag_gltf_text_free(&t);
  cag_gltf_plan_free(&p);
  return status;
}
