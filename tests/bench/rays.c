// Benchmarks of rays: the hierarchy of a mesh of 10^6 triangles and single casts at it, against
// Embree on the same mesh and rays if it is installed; points in solids.
//
// Prints lines `NAME | our seconds | seconds of Embree, or - | aim`.

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifdef CAG_PEER_EMBREE
#include <embree3/rtcore.h>
#endif

#include "geom/ray/caster.h"
#include "geom/ray/ray_mesh.h"
#include "geom/solid/csg.h"

// Points along each direction of the bumpy torus, and rays. Casts are repeated in turn with those of
// Embree, and the least time counts.
enum { SIDE = 708, RAYS = 1000000, REPEATS = 5 };

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static uint64_t seed = 1;
static double chance(void) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return 2 * ((double)(seed >> 11) / 9007199254740992.0) - 1;
}

static CagMesh *bumpy_torus(void) {
  CagMesh *m;
  CagError err;
  if (cag_mesh_new((size_t)SIDE * SIDE, 2 * (size_t)SIDE * SIDE, false, false, false, &m, &err))
    exit(1);
  for (uint32_t i = 0; i < SIDE; i++)
    for (uint32_t k = 0; k < SIDE; k++) {
      const double u = 2 * M_PI * i / SIDE, v = 2 * M_PI * k / SIDE;
      const double r = 1 + 0.1 * sin(40 * u) * sin(40 * v);
      const uint32_t a = i * SIDE + k, b = (i + 1) % SIDE * SIDE + k;
      const uint32_t c = (i + 1) % SIDE * SIDE + (k + 1) % SIDE, d = i * SIDE + (k + 1) % SIDE;
      const uint32_t corners[6] = {a, b, c, a, c, d};
      m->positions[a] = cag_vec3((3 + r * cos(v)) * cos(u), (3 + r * cos(v)) * sin(u), r * sin(v));
      for (int j = 0; j < 6; j++) m->triangles[6 * (size_t)a + (size_t)j] = corners[j];
    }
  return m;
}

// Rays from a point above, close to each other, or of any direction from anywhere.
static void make_rays(CagRay *rays, bool together) {
  for (int k = 0; k < RAYS; k++) {
    const double x = k % 1000 / 500.0 - 1, y = k / 1000 / 500.0 - 1;
    const CagVec3 from = cag_vec3(5 * chance(), 5 * chance(), 5 * chance());
    const CagVec3 to = cag_vec3(chance(), chance(), chance());
    rays[k] = together ? (CagRay){{0, 0, 20}, cag_unit(cag_vec3(x / 4, y / 4, -1)), 0, INFINITY}
                       : (CagRay){from, cag_unit(to), 0, INFINITY};
  }
}

static double cast_all(const CagRayMesh *m, const CagRay *rays, size_t *hits) {
  const double start = now();
  CagCrossing c;
  *hits = 0;
  for (int k = 0; k < RAYS; k++) *hits += cag_ray_mesh_first(m, &rays[k], &c);
  return now() - start;
}

#ifdef CAG_PEER_EMBREE
static RTCScene embree_scene(RTCDevice device, const CagMesh *m) {
  RTCScene scene = rtcNewScene(device);
  RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  float *p = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                     3 * sizeof(float), m->vertex_count);
  uint32_t *t = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        3 * sizeof(uint32_t), m->triangle_count);
  for (size_t i = 0; i < m->vertex_count; i++) {
    p[3 * i] = (float)m->positions[i].x;
    p[3 * i + 1] = (float)m->positions[i].y;
    p[3 * i + 2] = (float)m->positions[i].z;
  }
  for (size_t i = 0; i < 3 * m->triangle_count; i++) t[i] = m->triangles[i];
  rtcCommitGeometry(g);
  rtcAttachGeometry(scene, g);
  rtcReleaseGeometry(g);
  rtcCommitScene(scene);
  return scene;
}

static double embree_cast_all(RTCScene scene, const CagRay *rays, size_t *hits) {
  const double start = now();
  *hits = 0;
  for (int k = 0; k < RAYS; k++) {
    struct RTCIntersectContext context;
    struct RTCRayHit r = {.ray = {.org_x = (float)rays[k].origin.x,
                                  .org_y = (float)rays[k].origin.y,
                                  .org_z = (float)rays[k].origin.z,
                                  .dir_x = (float)rays[k].direction.x,
                                  .dir_y = (float)rays[k].direction.y,
                                  .dir_z = (float)rays[k].direction.z,
                                  .tfar = INFINITY,
                                  .mask = UINT32_MAX},
                          .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &r);
    *hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  return now() - start;
}
#endif

static void print_line(const char *name, double ours, double theirs, const char *aim) {
  printf("%s|%.6f|", name, ours);
  if (theirs > 0 && theirs < INFINITY) printf("%.6f", theirs);
  else printf("-");
  printf("|%s\n", aim);
}

int main(void) {
  CagError err;
  CagMesh *mesh = bumpy_torus();
  CagRayMesh *m;
  CagRay *rays = malloc(RAYS * sizeof *rays);
  double start = now(), embree[3] = {0, 0, 0};
  if (cag_ray_mesh_new(mesh, &m, &err)) return 1;
  const double build = now() - start;
  double ours[2];
  size_t hits[2], theirs[2] = {0, 0};
#ifdef CAG_PEER_EMBREE
  RTCDevice device = rtcNewDevice(NULL);
  start = now();
  RTCScene scene = embree_scene(device, mesh);
  embree[2] = now() - start;
#endif
  for (int k = 0; k < 2; k++) {
    make_rays(rays, k);
    ours[k] = embree[k] = INFINITY;
    for (int i = 0; i < REPEATS; i++) {
      ours[k] = fmin(ours[k], cast_all(m, rays, &hits[k]));
#ifdef CAG_PEER_EMBREE
      embree[k] = fmin(embree[k], embree_cast_all(scene, rays, &theirs[k]));
#endif
    }
  }
  print_line("hierarchy of 10^6 triangles", build, embree[2], "< 0.5 s");
  print_line("10^6 rays of any direction at it", ours[0], embree[0], "< 1 s, 1.5x");
  print_line("10^6 rays close together at it", ours[1], embree[1], "< 1 s, 1.5x");
  if (theirs[0] > 0)
    fprintf(stderr, "hits: %zu and %zu, Embree: %zu and %zu\n", hits[0], hits[1], theirs[0],
            theirs[1]);
  return 0;
}
