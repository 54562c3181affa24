// Reads the triangles of the scene of a glTF or GLB file, with each mesh transformed by its parent
// nodes.
//
// A first traversal of the scene counts the contents of all meshes, to check them against the
// limits before anything is allocated. A second one fills the draft. A node has at most one parent,
// so a traversal visits each node at most once. Meters with Y up are converted to millimeters with
// Z up.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/formats/gltf_document.h"

enum { TRIANGLES = 4, STRIP = 5, FAN = 6, USHORT_TYPE = 5123, UBYTE_TYPE = 5121, UINT_TYPE = 5125 };

typedef struct Visit {
  const cJSON *node; // NULL: a mesh without a node
  size_t mesh;       // SIZE_MAX: none
  CagTransform place;
} Visit;

typedef struct Walk {
  CagGltf *g;
  Visit *stack;
  size_t depth, room;
  bool *seen;
} Walk;

// A set of triangles of a mesh, whose data were checked.
typedef struct Primitive {
  CagGltfAccessor positions, normals, uv, indices;
  bool has_normals, has_uv, has_indices;
  size_t mode, corners, triangles;
} Primitive;

typedef struct Total {
  size_t vertices, triangles;
  bool normals, uv;
} Total;

// --- Transforms ---

static bool read_numbers(const cJSON *node, const char *key, double *x, int n) {
  const cJSON *list = cJSON_GetObjectItemCaseSensitive(node, key), *item;
  int k = 0;
  if (!list) return true;
  if (!cJSON_IsArray(list)) return false;
  cJSON_ArrayForEach(item, list) {
    if (k == n || !cJSON_IsNumber(item) || !isfinite(item->valuedouble)) return false;
    x[k++] = item->valuedouble;
  }
  return k == n;
}

// Reads the node's own transform: a matrix by columns, or translation * rotation * scale.
static bool read_place(const cJSON *node, CagTransform *out) {
  double m[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
  *out = cag_transform_identity();
  if (cJSON_GetObjectItemCaseSensitive(node, "matrix")) {
    if (!read_numbers(node, "matrix", m, 16)) return false;
    for (int k = 0; k < 12; k++) out->m[k % 4][k / 4] = k % 4 < 3 ? m[k] : 0;
    for (int k = 0; k < 3; k++) out->m[k][3] = m[12 + k];
    return true;
  }
  if (!read_numbers(node, "translation", t, 3) || !read_numbers(node, "rotation", q, 4) ||
      !read_numbers(node, "scale", s, 3))
    return false;
  double x = q[0], y = q[1], z = q[2], w = q[3], size = x * x + y * y + z * z + w * w;
  if (!(size > 0) || !isfinite(size)) return false;
  double f = 2 / size; // a quaternion of length 1 up to rounding gives an exact rotation
  const double r[3][3] = {{1 - f * (y * y + z * z), f * (x * y - z * w), f * (x * z + y * w)},
                          {f * (x * y + z * w), 1 - f * (x * x + z * z), f * (y * z - x * w)},
                          {f * (x * z - y * w), f * (y * z + x * w), 1 - f * (x * x + y * y)}};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) out->m[i][j] = r[i][j] * s[j];
    out->m[i][3] = t[i];
  }
  return true;
}

static CagTransform to_millimeters(void) {
  const double scale = 1000;
  CagTransform t = cag_transform_identity();
  t.m[0][0] = scale;
  t.m[1][1] = t.m[2][2] = 0;
  t.m[1][2] = -scale;
  t.m[2][1] = scale;
  return t;
}

// --- Traversal ---

static CagStatus push(Walk *w, const cJSON *node, size_t mesh, const CagTransform *place,
                      CagError *err) {
  if (w->depth == w->room) {
    size_t room = w->room ? 2 * w->room : 64;
    CagStatus status = cag_draft_take(w->g->draft, room - w->room, sizeof *w->stack, err);
    if (!status && !CAG_RESIZE(w->stack, room)) status = cag_fail_memory(err);
    if (status) return status;
    w->room = room;
  }
  w->stack[w->depth++] = (Visit){node, mesh, *place};
  return CAG_OK;
}

static CagStatus push_node(Walk *w, const cJSON *number, const CagTransform *above, CagError *err) {
  double k = cJSON_IsNumber(number) ? number->valuedouble : -1;
  if (!(k >= 0 && k < (double)w->g->nodes.count) || k != floor(k))
    return cag_gltf_fail(w->g, err, CAG_ERR_mesh_file_index,
                         "the scene refers to node %g, but there are %zu nodes", k,
                         w->g->nodes.count);
  size_t i = (size_t)k, mesh;
  if (w->seen[i])
    return cag_gltf_fail(w->g, err, CAG_ERR_mesh_file_syntax,
                         "nodes[%zu] occurs twice in the scene", i);
  w->seen[i] = true;
  const cJSON *node = w->g->nodes.items[i];
  CagTransform own;
  if (!read_place(node, &own))
    return cag_gltf_fail(w->g, err, CAG_ERR_mesh_file_syntax,
                         "nodes[%zu] has an invalid matrix, translation, rotation, or scale", i);
  if (!cag_gltf_whole(node, "mesh", SIZE_MAX, &mesh) ||
      (mesh != SIZE_MAX && mesh >= w->g->meshes.count))
    return cag_gltf_fail(w->g, err, CAG_ERR_mesh_file_index,
                         "nodes[%zu] refers to a mesh that does not exist", i);
  CagTransform place = cag_transform_multiply(above, &own);
  return push(w, node, mesh, &place, err);
}

// Pushes the roots of the scene: the nodes that it names; if there are no scenes, the nodes that
// are not children; and if there are no nodes, all meshes.
static CagStatus push_roots(Walk *w, CagError *err) {
  CagGltf *g = w->g;
  CagTransform place = to_millimeters();
  CagStatus status = CAG_OK;
  size_t which;
  const cJSON *scenes = cJSON_GetObjectItemCaseSensitive(g->json, "scenes"), *item;
  if (!cag_gltf_whole(g->json, "scene", 0, &which)) which = SIZE_MAX;
  if (scenes && which >= (size_t)cJSON_GetArraySize(scenes))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_index, "the default scene does not exist");
  if (scenes) {
    const cJSON *scene = cJSON_GetArrayItem(scenes, (int)which);
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(scene, "nodes")) {
      status = push_node(w, item, &place, err);
      if (status) return status;
    }
    return CAG_OK;
  }
  for (size_t i = 0; g->nodes.count == 0 && !status && i < g->meshes.count; i++)
    status = push(w, NULL, i, &place, err);
  if (g->nodes.count == 0) return status;
  bool *child = cag_calloc(g->nodes.count, sizeof *child);
  if (!child) return cag_fail_memory(err);
  for (size_t i = 0; i < g->nodes.count; i++)
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(g->nodes.items[i], "children")) {
      double k = cJSON_IsNumber(item) ? item->valuedouble : -1;
      if (k >= 0 && k < (double)g->nodes.count) child[(size_t)k] = true;
    }
  for (size_t i = 0; !status && i < g->nodes.count; i++) {
    const cJSON number = {.type = cJSON_Number, .valuedouble = (double)i};
    if (!child[i]) status = push_node(w, &number, &place, err);
  }
  cag_free(child);
  return status;
}

typedef CagStatus VisitMesh(CagGltf *g, size_t mesh, const CagTransform *place, void *context,
                            CagError *err);

static CagStatus walk_nodes(Walk *w, VisitMesh *visit, void *context, CagError *err) {
  CagStatus status = push_roots(w, err);
  while (!status && w->depth > 0) {
    Visit v = w->stack[--w->depth];
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(v.node, "children")) {
      status = push_node(w, item, &v.place, err);
      if (status) return status;
    }
    if (v.mesh != SIZE_MAX) status = visit(w->g, v.mesh, &v.place, context, err);
    if (!status) status = cag_draft_check(w->g->draft, err);
  }
  return status;
}

static CagStatus walk(CagGltf *g, VisitMesh *visit, void *context, CagError *err) {
  Walk w = {.g = g, .seen = cag_calloc(g->nodes.count + 1, sizeof(bool))};
  CagStatus status = w.seen ? walk_nodes(&w, visit, context, err) : cag_fail_memory(err);
  cag_free(w.stack);
  cag_free(w.seen);
  return status;
}

// --- Primitives ---

static size_t triangles_of(size_t mode, size_t corners) {
  if (mode == TRIANGLES) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

// Reads positions and their attributes, which must have the same count.
static CagStatus read_attributes(const CagGltf *g, const cJSON *p, Primitive *out, CagError *err) {
  const cJSON *attributes = cJSON_GetObjectItemCaseSensitive(p, "attributes");
  size_t position, normal, uv;
  if (!cag_gltf_whole(attributes, "POSITION", SIZE_MAX, &position) ||
      !cag_gltf_whole(attributes, "NORMAL", SIZE_MAX, &normal) ||
      !cag_gltf_whole(attributes, "TEXCOORD_0", SIZE_MAX, &uv))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax,
                         "an attribute is not the number of an accessor");
  if (position == SIZE_MAX) return CAG_OK; // nothing visible
  CagStatus status = cag_gltf_accessor(g, position, 3, &out->positions, err);
  out->has_normals = !status && normal != SIZE_MAX;
  if (out->has_normals) status = cag_gltf_accessor(g, normal, 3, &out->normals, err);
  out->has_uv = !status && uv != SIZE_MAX;
  if (out->has_uv) status = cag_gltf_accessor(g, uv, 2, &out->uv, err);
  if (status) return status;
  size_t n = out->positions.count;
  if ((out->has_normals && out->normals.count != n) || (out->has_uv && out->uv.count != n))
    return cag_gltf_fail(
        g, err, CAG_ERR_mesh_file_syntax,
        "accessors[%zu] has %zu points, but the other attributes have another number", position, n);
  return CAG_OK;
}

// `triangles` is 0 for points and lines.
static CagStatus read_primitive(const CagGltf *g, const cJSON *p, Primitive *out, CagError *err) {
  size_t indices;
  *out = (Primitive){0};
  const cJSON *extensions = cJSON_GetObjectItemCaseSensitive(p, "extensions");
  if (cJSON_GetObjectItemCaseSensitive(extensions, "KHR_draco_mesh_compression"))
    return cag_gltf_fail(
        g, err, CAG_ERR_mesh_file_unsupported,
        "it is compressed (KHR_draco_mesh_compression); write it without compression");
  if (!cag_gltf_whole(p, "mode", TRIANGLES, &out->mode) || out->mode > FAN ||
      !cag_gltf_whole(p, "indices", SIZE_MAX, &indices))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax,
                         "a primitive has an invalid mode or invalid indices");
  if (out->mode < TRIANGLES) return CAG_OK;
  CagStatus status = read_attributes(g, p, out, err);
  if (status) return status;
  out->corners = out->positions.count;
  if (indices != SIZE_MAX) {
    status = cag_gltf_accessor(g, indices, 1, &out->indices, err);
    int type = out->indices.component;
    if (!status && (type != UBYTE_TYPE && type != USHORT_TYPE && type != UINT_TYPE))
      status =
          cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "accessors[%zu] has no indices", indices);
    if (!status && (!out->indices.data || out->indices.sparse_count > 0))
      status = cag_gltf_fail(g, err, CAG_ERR_mesh_file_unsupported,
                             "accessors[%zu] has sparse indices; write all indices", indices);
    out->has_indices = true;
    out->corners = out->indices.count;
  }
  out->triangles = triangles_of(out->mode, out->corners);
  return status;
}

static CagStatus count_mesh(CagGltf *g, size_t mesh, const CagTransform *place, void *context,
                            CagError *err) {
  (void)place;
  Total *t = context;
  const cJSON *item;
  cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(g->meshes.items[mesh], "primitives")) {
    Primitive p;
    CagStatus status = read_primitive(g, item, &p, err);
    if (status) return status;
    if (p.triangles == 0) continue;
    // Data without a view are zeros, whose number is not limited by the size of the file.
    if (p.positions.count > UINT32_MAX || t->vertices > UINT32_MAX)
      return cag_gltf_fail(g, err, CAG_ERR_mesh_file_unsupported,
                           "it has more than %lu vertices; split it", (unsigned long)UINT32_MAX);
    t->vertices += p.positions.count;
    t->triangles += p.triangles;
    t->normals |= p.has_normals;
    t->uv |= p.has_uv;
  }
  return CAG_OK;
}

// --- Filling ---

// Copies the numbers of an accessor.
static void copy_numbers(const CagGltfAccessor *a, double *to, int width) {
  for (size_t i = 0; i < a->count; i++)
    for (int k = 0; k < width; k++) to[i * (size_t)width + (size_t)k] = cag_gltf_number(a, i, k);
  for (size_t i = 0; i < a->sparse_count; i++) {
    size_t at = cag_gltf_index(a->sparse_index, a->sparse_component, i);
    for (int k = 0; k < width; k++)
      to[at * (size_t)width + (size_t)k] = cag_gltf_sparse_number(a, i, k);
  }
}

static void copy_vectors(const CagGltfAccessor *a, CagVec3 *to) {
  for (size_t i = 0; i < a->count; i++)
    to[i] = cag_vec3(cag_gltf_number(a, i, 0), cag_gltf_number(a, i, 1), cag_gltf_number(a, i, 2));
  for (size_t i = 0; i < a->sparse_count; i++)
    to[cag_gltf_index(a->sparse_index, a->sparse_component, i)] =
        cag_vec3(cag_gltf_sparse_number(a, i, 0), cag_gltf_sparse_number(a, i, 1),
                 cag_gltf_sparse_number(a, i, 2));
}

// Normals are transformed by the cofactors of the linear part, up to their length. A reflection
// reverses them.
static CagVec3 place_normal(const CagTransform *t, CagVec3 n) {
  CagVec3 x = cag_vec3(t->m[0][0], t->m[1][0], t->m[2][0]);
  CagVec3 y = cag_vec3(t->m[0][1], t->m[1][1], t->m[2][1]);
  CagVec3 z = cag_vec3(t->m[0][2], t->m[1][2], t->m[2][2]);
  CagVec3 out = cag_add(cag_add(cag_scaled(cag_cross(y, z), n.x), cag_scaled(cag_cross(z, x), n.y)),
                        cag_scaled(cag_cross(x, y), n.z));
  out = cag_unit(out);
  return cag_transform_mirrors(t) ? cag_scaled(out, -1) : out;
}

static CagStatus fill_vertices(CagGltf *g, const Primitive *p, const CagTransform *place,
                               size_t first, CagError *err) {
  CagMeshDraft *d = g->draft;
  if (p->positions.count == 0) return CAG_OK; // the draft may have no arrays yet
  copy_vectors(&p->positions, d->positions + first);
  if (p->has_normals) copy_vectors(&p->normals, d->normals + first);
  if (p->has_uv) copy_numbers(&p->uv, d->uv + 2 * first, 2);
  for (size_t i = first; i < first + p->positions.count; i++) {
    CagVec3 at = cag_transform_point(place, d->positions[i]);
    if (!isfinite(at.x) || !isfinite(at.y) || !isfinite(at.z))
      return cag_gltf_fail(g, err, CAG_ERR_mesh_file_number,
                           "element %zu of an accessor of positions is not finite", i - first);
    d->positions[i] = at;
    if (p->has_normals) d->normals[i] = place_normal(place, d->normals[i]);
    for (size_t k = 2 * i; p->has_uv && k < 2 * i + 2; k++)
      if (!isfinite(d->uv[k])) d->uv[k] = 0;
  }
  return CAG_OK;
}

static size_t corner(const Primitive *p, size_t k) {
  return p->has_indices ? (size_t)cag_gltf_number(&p->indices, k, 0) : k;
}

static CagStatus fill_triangles(CagGltf *g, const Primitive *p, bool mirrored, size_t first,
                                CagError *err) {
  for (size_t t = 0; t < p->triangles; t++) {
    size_t k[3] = {t, t + 1, t + 2};
    if (p->mode == TRIANGLES) k[0] = 3 * t, k[1] = 3 * t + 1, k[2] = 3 * t + 2;
    else if (p->mode == FAN) k[0] = 0;
    else if (t % 2) k[0] = t + 1, k[1] = t; // every other triangle of a strip is reversed
    for (int j = 0; j < 3; j++) {
      k[j] = corner(p, k[j]);
      if (k[j] >= p->positions.count)
        return cag_gltf_fail(
            g, err, CAG_ERR_mesh_file_index,
            "triangle %zu of a mesh refers to vertex %zu, but there are %zu vertices", t, k[j],
            p->positions.count);
    }
    size_t b = mirrored ? k[2] : k[1], c = mirrored ? k[1] : k[2];
    cag_draft_triangle(g->draft, (uint32_t)(first + k[0]), (uint32_t)(first + b),
                       (uint32_t)(first + c));
    if (t % CAG_DRAFT_CHECK_STEP == 0 && cag_draft_check(g->draft, err)) return CAG_E_CALLBACK;
  }
  return CAG_OK;
}

static CagStatus fill_mesh(CagGltf *g, size_t mesh, const CagTransform *place, void *context,
                           CagError *err) {
  (void)context;
  const cJSON *item;
  cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(g->meshes.items[mesh], "primitives")) {
    Primitive p;
    CagStatus status = read_primitive(g, item, &p, err);
    if (!status && p.triangles == 0) continue;
    size_t first = g->draft->vertex_count;
    if (!status) status = fill_vertices(g, &p, place, first, err);
    if (status) return status;
    g->draft->vertex_count += p.positions.count;
    status = fill_triangles(g, &p, cag_transform_mirrors(place), first, err);
    if (status) return status;
  }
  return CAG_OK;
}

CagStatus cag_read_gltf(CagMeshDraft *d, CagError *err) {
  CagGltf g;
  Total total = {0};
  CagStatus status = cag_gltf_open(&g, d, err);
  if (!status) status = walk(&g, count_mesh, &total, err);
  if (!status) status = cag_draft_triangles(d, total.triangles, err);
  if (!status) status = cag_draft_vertices(d, total.vertices, total.normals, total.uv, err);
  if (!status) status = walk(&g, fill_mesh, NULL, err);
  cag_gltf_close(&g);
  return status;
}
