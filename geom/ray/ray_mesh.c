#include "geom/ray/ray_mesh.h"

#include "base/memory.h"
#include "geom/mesh/distance.h"
#include "geom/ray/bvh_walk.h"

// Triangles of a leaf, at most. Rays take the same time with 4 to 8; with more, nodes need less memory.
#define LEAF_TRIANGLES 6

// --- Making ---

static CagStatus triangle_boxes(const CagMesh *m, CagBounds **out, CagError *err) {
  CagBounds *boxes = cag_malloc((m->triangle_count + 1) * sizeof *boxes);
  if (!boxes) return cag_fail_memory(err);
  for (size_t i = 0; i < m->triangle_count; i++) {
    const uint32_t *t = m->triangles + 3 * i;
    const CagVec3 a = m->positions[t[0]], b = m->positions[t[1]], c = m->positions[t[2]];
    boxes[i].min =
        cag_vec3(fmin(fmin(a.x, b.x), c.x), fmin(fmin(a.y, b.y), c.y), fmin(fmin(a.z, b.z), c.z));
    boxes[i].max =
        cag_vec3(fmax(fmax(a.x, b.x), c.x), fmax(fmax(a.y, b.y), c.y), fmax(fmax(a.z, b.z), c.z));
  }
  *out = boxes;
  return CAG_OK;
}

static const CagRayMeshCasts *casts_of_processor(void) {
#ifdef CAG_RAY_MESH_AVX2
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
      __builtin_cpu_supports("bmi"))
    return &cag_ray_mesh_casts_avx2;
#endif
  return &cag_ray_mesh_casts;
}

static void round_triangle(const CagRayMesh *m, uint32_t face, CagRayTriangle *out) {
  const uint32_t *t = m->mesh->triangles + 3 * (size_t)face;
  out->face = face;
  for (int k = 0; k < 3; k++) {
    const CagVec3 p = cag_sub(m->mesh->positions[t[k]], m->bvh.origin);
    out->x[k] = (float)p.x;
    out->y[k] = (float)p.y;
    out->z[k] = (float)p.z;
    out->corner[k] = t[k];
  }
}

static CagStatus round_triangles(CagRayMesh *m, CagError *err) {
  const size_t n = m->mesh->triangle_count, size = (n + 1) * sizeof *m->triangles;
  m->triangles = cag_malloc(size);
  if (!m->triangles) return cag_fail_memory(err);
  cag_memory_scattered(m->triangles, size);
  for (size_t i = 0; i < n; i++) round_triangle(m, m->bvh.order[i], &m->triangles[i]);
  m->bvh.items = m->triangles;
  m->bvh.item_size = sizeof *m->triangles;
  return CAG_OK;
}

CagStatus cag_ray_mesh_new(const CagMesh *m, CagRayMesh **out, CagError *err) {
  CagRayMesh *made = cag_calloc(1, sizeof *made);
  if (!made) return cag_fail_memory(err);
  made->mesh = cag_mesh_retain(m);
  made->casts = casts_of_processor();
  CagBounds *boxes = NULL;
  CagStatus status = triangle_boxes(m, &boxes, err);
  if (!status) status = cag_bvh_build(boxes, m->triangle_count, LEAF_TRIANGLES, &made->bvh, err);
  cag_free(boxes);
  if (!status) status = round_triangles(made, err);
#ifdef CAG_EMBREE
  if (!status && m->triangle_count >= CAG_EMBREE_TRIANGLES) cag_ray_mesh_use_embree(made);
#endif
  if (status) cag_ray_mesh_free(made);
  else *out = made;
  return status;
}

void cag_ray_mesh_free(CagRayMesh *m) {
  if (!m) return;
#ifdef CAG_EMBREE
  cag_ray_mesh_release_embree(m);
#endif
  cag_mesh_release(m->mesh);
  cag_bvh_free(&m->bvh);
  cag_free(m->triangles);
  cag_free(m);
}

// --- Rays ---

bool cag_ray_mesh_first(const CagRayMesh *m, const CagRay *ray, CagCrossing *out) {
  return m->casts->first(m, ray, out);
}

bool cag_ray_mesh_blocks(const CagRayMesh *m, const CagRay *ray) {
  return m->casts->blocks(m, ray);
}

CagStatus cag_ray_mesh_all(const CagRayMesh *m, const CagRay *ray, CagCrossings *out,
                           CagError *err) {
  return m->casts->all(m, ray, out, err);
}

// --- Points ---

// The direction of the ray that decides whether a point is inside: any will do.
static const CagVec3 ANY_DIRECTION = {0.36, 0.48, 0.8};

static bool is_outside_box(const CagBounds *b, CagVec3 p, double slack) {
  return p.x < b->min.x - slack || p.y < b->min.y - slack || p.z < b->min.z - slack ||
         p.x > b->max.x + slack || p.y > b->max.y + slack || p.z > b->max.z + slack;
}

bool cag_ray_mesh_contains(const CagRayMesh *m, CagVec3 p, double slack) {
  if (m->bvh.item_count == 0 || is_outside_box(&m->bvh.bounds, p, slack)) return false;
  const CagRay ray = {p, ANY_DIRECTION, 0, INFINITY};
  if (m->casts->winding(m, &ray) > 0) return true;
  CagVec3 point;
  uint32_t face;
  return slack > 0 && cag_ray_mesh_closest(m, p, slack, &point, &face);
}

bool cag_ray_mesh_closest(const CagRayMesh *m, CagVec3 p, double most, CagVec3 *point,
                          uint32_t *face) {
  const CagVec3 local = cag_sub(p, m->bvh.origin);
  // Boxes that are a few roundings of the point farther away count.
  const double slack = CAG_BVH_SLACK * (cag_norm(local) + m->bvh.radius);
  const float at[3] = {(float)local.x, (float)local.y, (float)local.z};
  double least = most;
  bool found = false;
  CagBvhWalk walk;
  size_t first, count;
  cag_bvh_start(&m->bvh, &walk);
  while (cag_bvh_near(&m->bvh, at, (least + slack) * (least + slack), &walk, &first, &count))
    for (size_t i = first; i < first + count; i++) {
      const CagRayTriangle *t = &m->triangles[i];
      CagVec3 corners[3];
      for (int k = 0; k < 3; k++) corners[k] = cag_vec3(t->x[k], t->y[k], t->z[k]);
      // The rounded corners are off by less than the slack.
      if (cag_norm(cag_sub(cag_nearest_of_triangle(local, corners), local)) > least + slack)
        continue;
      for (int k = 0; k < 3; k++) corners[k] = m->mesh->positions[t->corner[k]];
      const CagVec3 q = cag_nearest_of_triangle(p, corners);
      const double distance = cag_norm(cag_sub(q, p));
      if (!(distance < least || (distance == least && (!found || t->face < *face)))) continue;
      least = distance;
      *point = q;
      *face = t->face;
      found = true;
    }
  return found;
}
