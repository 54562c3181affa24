// Rays at meshes whose triangles are found by Embree: `make EMBREE=1`.
//
// Embree searches boxes, which are larger than the triangles by more than the rounding of a ray. What
// it finds is ruled out or met by the same code as what our hierarchy finds, so the results are the
// same. (Its own triangles would not do: a ray near an edge may miss the triangle that it meets.)

#include "geom/ray/ray_mesh.h"

#ifdef CAG_EMBREE

#include <embree3/rtcore.h>
#include <stdio.h>

#include "base/memory.h"
#include "base/parallel.h"

#define CAG_VISIT_BY_EMBREE
#include "geom/ray/ray_mesh_walk.h"

// Boxes are enlarged by this fraction of the radius of the mesh, which is 33 e with e = 2^-24. Rounding
// the corners, the ray's origin, and its direction moves a point of the ray by less than 10 e, and
// the products of the slab test by less than 10 e. (Embree has no robust mode for boxes of the user.)
#define EMBREE_PAD 2e-6f
// An estimate of the memory of Embree for each triangle, in bytes.
#define EMBREE_BYTES 100

// Embree leaves out boxes whose coordinates exceed 1.8e18, and the areas of tiny ones would be 0.
#define EMBREE_RADIUS_MIN 1e-9
#define EMBREE_RADIUS_MAX 1e9

typedef struct CagRayMeshEmbree {
  RTCDevice device;
  RTCScene scene;
  size_t charged; // bytes
  float pad;
} CagRayMeshEmbree;

// A ray on its way, with what Embree passes on to the callback.
typedef struct Search {
  struct RTCIntersectContext context; // the first member
  const CagRayMesh *mesh;
  Approach *approach;
  VisitMet *visit;
  void *visitor;
  float shift; // of parameters, since those of Embree are not negative
} Search;

static void box_of_triangle(const struct RTCBoundsFunctionArguments *args) {
  const CagRayMesh *m = args->geometryUserPtr;
  const CagRayTriangle *t = &m->triangles[args->primID];
  const float *rows[3] = {t->x, t->y, t->z};
  float low[3], high[3];
  for (int k = 0; k < 3; k++) {
    low[k] = fminf(fminf(rows[k][0], rows[k][1]), rows[k][2]) - m->embree->pad;
    high[k] = fmaxf(fmaxf(rows[k][0], rows[k][1]), rows[k][2]) + m->embree->pad;
  }
  *args->bounds_o = (struct RTCBounds){.lower_x = low[0],
                                       .lower_y = low[1],
                                       .lower_z = low[2],
                                       .upper_x = high[0],
                                       .upper_y = high[1],
                                       .upper_z = high[2]};
}

// Embree calls this for each triangle whose box the ray meets. A hit is reported to reduce the range
// of the ray; one at -infinity ends the search.
static void meet_found(const struct RTCIntersectFunctionNArguments *args) {
  Search *s = (Search *)args->context;
  struct RTCRayHit *ray = (struct RTCRayHit *)args->rayhit;
  Approach *a = s->approach;
  const CagRayTriangle *t = &s->mesh->triangles[args->primID];
  const float most = a->ray.most;
  Met met;
  if (!args->valid[0] || !(sieve_pair(&a->sieve, t, t, most) & 1u) ||
      !meet_triangle(&a->shear, s->mesh->mesh->positions, t->corner, &met))
    return;
  const bool goes_on = s->visit(s->visitor, t, &met);
  if (goes_on && a->ray.most >= most) return;
  ray->ray.tfar = goes_on ? a->ray.most + s->shift : -INFINITY;
  ray->hit.geomID = args->geomID;
  ray->hit.primID = args->primID;
}

static void visit_met(const CagRayMesh *m, Approach *a, VisitMet *visit, void *context) {
  // A direction of length 0 has no parameters within the bounds. Embree stops the program at NaN.
  if (!isfinite(a->ray.origin[0] + a->ray.origin[1] + a->ray.origin[2])) return;
  Search s = {.mesh = m, .approach = a, .visit = visit, .visitor = context};
  s.shift = 2 * m->embree->pad;
  rtcInitIntersectContext(&s.context);
  const float *o = a->ray.origin;
  const CagVec3 direction = a->whole->direction;
  const float d[3] = {(float)direction.x, (float)direction.y, (float)direction.z};
  struct RTCRayHit ray = {.ray = {.org_x = o[0] - s.shift * d[0],
                                  .org_y = o[1] - s.shift * d[1],
                                  .org_z = o[2] - s.shift * d[2],
                                  .dir_x = d[0],
                                  .dir_y = d[1],
                                  .dir_z = d[2],
                                  .tfar = a->ray.most + 2 * s.shift,
                                  .mask = UINT32_MAX},
                          .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
  rtcIntersect1(m->embree->scene, &s.context, &ray);
}

static const CagRayMeshCasts cag_ray_mesh_casts_embree = CAG_RAY_MESH_CASTS;

static void add_boxes(CagRayMesh *m) {
  CagRayMeshEmbree *e = m->embree;
  RTCGeometry g = rtcNewGeometry(e->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(g, (unsigned)m->mesh->triangle_count);
  rtcSetGeometryUserData(g, m);
  rtcSetGeometryBoundsFunction(g, box_of_triangle, NULL);
  rtcSetGeometryIntersectFunction(g, meet_found);
  rtcCommitGeometry(g);
  rtcAttachGeometry(e->scene, g);
  rtcReleaseGeometry(g);
  rtcCommitScene(e->scene);
}

void cag_ray_mesh_use_embree(CagRayMesh *m) {
  char threads[32];
  const size_t charged = EMBREE_BYTES * m->mesh->triangle_count;
  if (m->bvh.radius < EMBREE_RADIUS_MIN || m->bvh.radius > EMBREE_RADIUS_MAX) return;
  if (!cag_account_hold(charged)) return;
  m->embree = cag_calloc(1, sizeof *m->embree);
  if (!m->embree) {
    cag_account_drop(charged);
    return;
  }
  snprintf(threads, sizeof threads, "threads=%d", cag_thread_count());
  m->embree->charged = charged;
  m->embree->pad = EMBREE_PAD * (float)m->bvh.radius;
  m->embree->device = rtcNewDevice(threads);
  if (m->embree->device) m->embree->scene = rtcNewScene(m->embree->device);
  if (m->embree->scene) add_boxes(m);
  if (m->embree->scene && rtcGetDeviceError(m->embree->device) == RTC_ERROR_NONE)
    m->casts = &cag_ray_mesh_casts_embree;
  else cag_ray_mesh_release_embree(m);
}

void cag_ray_mesh_release_embree(CagRayMesh *m) {
  if (!m->embree) return;
  if (m->embree->scene) rtcReleaseScene(m->embree->scene);
  if (m->embree->device) rtcReleaseDevice(m->embree->device);
  cag_account_drop(m->embree->charged);
  cag_free(m->embree);
  m->embree = NULL;
}

#endif
