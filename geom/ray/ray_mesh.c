#include "geom/ray/ray_mesh.h"

#include "base/memory.h"
#include "geom/mesh/distance.h"
#include "geom/ray/bvh_walk.h"

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

CagStatus cag_ray_mesh_new(const CagMesh *m, CagRayMesh **out, CagError *err) {
  CagRayMesh *made = cag_calloc(1, sizeof *made);
  if (!made) return cag_fail_memory(err);
  made->mesh = cag_mesh_retain(m);
  CagBounds *boxes = NULL;
  CagStatus status = triangle_boxes(m, &boxes, err);
  if (!status) status = cag_bvh_build(boxes, m->triangle_count, &made->bvh, err);
  cag_free(boxes);
  if (!status) made->triangles = cag_malloc((m->triangle_count + 1) * sizeof *made->triangles);
  if (!status && !made->triangles) status = cag_fail_memory(err);
  made->bvh.items = made->triangles;
  made->bvh.item_size = sizeof *made->triangles;
  for (size_t i = 0; !status && i < m->triangle_count; i++) {
    const uint32_t *t = m->triangles + 3 * (size_t)made->bvh.order[i];
    for (int k = 0; k < 3; k++) made->triangles[i].p[k] = m->positions[t[k]];
  }
  if (status) cag_ray_mesh_free(made);
  else *out = made;
  return status;
}

void cag_ray_mesh_free(CagRayMesh *m) {
  if (!m) return;
  cag_mesh_release(m->mesh);
  cag_bvh_free(&m->bvh);
  cag_free(m->triangles);
  cag_free(m);
}

// --- Rays ---

// A ray along which the axis z is the one that it is most parallel to. Points are projected along
// the ray to the plane of the axes x and y, in which the ray is the origin (Woop, Benthin, and Wald
// 2013).
typedef struct Shear {
  CagVec3 origin;
  int x, y, z;
  double sx, sy, sz;
} Shear;

static Shear shear_of(CagVec3 origin, CagVec3 direction) {
  const double d[3] = {direction.x, direction.y, direction.z};
  Shear s = {.origin = origin};
  s.z = fabs(d[0]) > fabs(d[1]) ? 0 : 1;
  if (fabs(d[2]) > fabs(d[s.z])) s.z = 2;
  s.x = (s.z + 1) % 3;
  s.y = (s.z + 2) % 3;
  if (d[s.z] < 0) { // keeps the orientation of the projection
    const int swap = s.x;
    s.x = s.y;
    s.y = swap;
  }
  s.sx = d[s.x] / d[s.z];
  s.sy = d[s.y] / d[s.z];
  s.sz = 1 / d[s.z];
  return s;
}

typedef struct Projected {
  double x, y, z;
} Projected;

INLINE Projected project(const Shear *s, const CagVec3 *p) {
  const double d[3] = {p->x - s->origin.x, p->y - s->origin.y, p->z - s->origin.z};
  return (Projected){d[s->x] - s->sx * d[s->z], d[s->y] - s->sy * d[s->z], d[s->z]};
}

// The sign of the edge function of the ray and the edge from a to b where its rounded value is 0.
// The products are compared with their rounding errors. If the ray meets the edge, it is moved by
// an infinitesimal amount along x, and by a still smaller one along y.
static double sign_of_edge(const Projected *a, const Projected *b) {
  const double p = a->x * b->y, q = a->y * b->x;
  const double error = fma(a->x, b->y, -p) - fma(a->y, b->x, -q);
  if (error != 0) return error;
  return a->y != b->y ? a->y - b->y : b->x - a->x;
}

// The number, or the least or largest of the three others beyond which it is.
INLINE double within_corners(double z, double a, double b, double c) {
  const double ab = a < b ? a : b, low = ab < c ? ab : c;
  const double ba = a > b ? a : b, high = ba > c ? ba : c;
  return z < low ? low : z > high ? high : z;
}

// A triangle that the ray meets.
typedef struct Met {
  double t, weight[2];
  int sign;
} Met;

// Meets a triangle exactly: an edge that two triangles share is assigned to one of them.
INLINE bool meet_triangle(const Shear *s, const CagRayTriangle *triangle, Met *out) {
  const Projected a = project(s, &triangle->p[0]), b = project(s, &triangle->p[1]),
                  c = project(s, &triangle->p[2]);
  const double u = b.x * c.y - b.y * c.x, v = c.x * a.y - c.y * a.x, w = a.x * b.y - a.y * b.x;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  double su = u, sv = v, sw = w;
  if (u == 0 || v == 0 || w == 0) {
    if (u == 0) su = sign_of_edge(&b, &c);
    if (v == 0) sv = sign_of_edge(&c, &a);
    if (w == 0) sw = sign_of_edge(&a, &b);
    if (!((su > 0 && sv > 0 && sw > 0) || (su < 0 && sv < 0 && sw < 0))) return false;
  }
  const double sum = u + v + w;
  double z;
  if (sum != 0) {
    const double inverse = 1 / sum;
    out->weight[0] = v * inverse;
    out->weight[1] = w * inverse;
    z = (u * a.z + v * b.z + w * c.z) * inverse;
    // Of a triangle that is nearly parallel to the ray, the quotient may be far off.
    z = within_corners(z, a.z, b.z, c.z);
  } else {
    out->weight[0] = out->weight[1] = 0;
    z = a.z;
  }
  out->t = z * s->sz;
  // Seen along the ray, a triangle in counter-clockwise order points towards the viewer.
  out->sign = su > 0 ? 1 : -1;
  return true;
}

// The ray's parameter from the prepared origin on, which is near the mesh.
typedef struct Approach {
  CagBvhRay ray;
  Shear shear;
  CagBvhWalk walk;
} Approach;

static bool approach_mesh(const CagRayMesh *m, const CagRay *ray, Approach *a) {
  if (!cag_bvh_ray(&m->bvh, ray->origin, ray->direction, ray->least, ray->most, &a->ray))
    return false;
  a->shear = shear_of(cag_madd(ray->origin, a->ray.start, ray->direction), ray->direction);
  cag_bvh_start(&m->bvh, &a->walk);
  return true;
}

static CagVec3 corner_mix(const double *uv, const uint32_t *t, const Met *met) {
  const double w0 = 1 - met->weight[0] - met->weight[1];
  const double *a = uv + 2 * (size_t)t[0], *b = uv + 2 * (size_t)t[1], *c = uv + 2 * (size_t)t[2];
  return cag_vec3(w0 * a[0] + met->weight[0] * b[0] + met->weight[1] * c[0],
                  w0 * a[1] + met->weight[0] * b[1] + met->weight[1] * c[1], 0);
}

static CagCrossing crossing_of(const CagRayMesh *m, size_t at, const Met *met) {
  const uint32_t face = m->bvh.order[at];
  const CagVec3 *p = m->triangles[at].p;
  CagVec3 uv = {NAN, NAN, 0};
  if (m->mesh->uv) uv = corner_mix(m->mesh->uv, m->mesh->triangles + 3 * (size_t)face, met);
  return (CagCrossing){.t = met->t,
                       .normal = cag_unit(cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0]))),
                       .u = uv.x,
                       .v = uv.y,
                       .face = face,
                       .label = m->mesh->labels ? m->mesh->labels[face] : 0,
                       .sign = met->sign,
                       .weight = {(float)met->weight[0], (float)met->weight[1]}};
}

bool cag_ray_mesh_first(const CagRayMesh *m, const CagRay *ray, CagCrossing *out) {
  Approach a;
  size_t first, count, best = SIZE_MAX;
  Met met, nearest = {0};
  if (!approach_mesh(m, ray, &a)) return false;
  const double least = ray->least - a.ray.start;
  double most = ray->most - a.ray.start;
  while (cag_bvh_next(&m->bvh, &a.ray, &a.walk, &first, &count))
    for (size_t i = first; i < first + count; i++) {
      if (!meet_triangle(&a.shear, &m->triangles[i], &met) || !(met.t > least && met.t <= most))
        continue;
      // Of two at one distance, the one with the lower number.
      if (met.t == most && best != SIZE_MAX && m->bvh.order[i] > m->bvh.order[best]) continue;
      best = i;
      nearest = met;
      most = met.t;
      a.ray.most = nextafterf((float)most, INFINITY);
    }
  if (best == SIZE_MAX) return false;
  nearest.t += a.ray.start;
  *out = crossing_of(m, best, &nearest);
  return true;
}

bool cag_ray_mesh_blocks(const CagRayMesh *m, const CagRay *ray) {
  Approach a;
  size_t first, count;
  Met met;
  if (!approach_mesh(m, ray, &a)) return false;
  while (cag_bvh_next(&m->bvh, &a.ray, &a.walk, &first, &count))
    for (size_t i = first; i < first + count; i++)
      if (meet_triangle(&a.shear, &m->triangles[i], &met) && met.t > ray->least - a.ray.start &&
          met.t <= ray->most - a.ray.start)
        return true;
  return false;
}

CagStatus cag_ray_mesh_all(const CagRayMesh *m, const CagRay *ray, CagCrossings *out,
                           CagError *err) {
  Approach a;
  size_t first, count;
  Met met;
  if (!approach_mesh(m, ray, &a)) return CAG_OK;
  while (cag_bvh_next(&m->bvh, &a.ray, &a.walk, &first, &count))
    for (size_t i = first; i < first + count; i++) {
      if (!meet_triangle(&a.shear, &m->triangles[i], &met)) continue;
      met.t += a.ray.start;
      if (!(met.t > ray->least && met.t <= ray->most)) continue;
      CagCrossing *c = cag_crossings_add(out, err);
      if (!c) return CAG_E_MEMORY;
      *c = crossing_of(m, i, &met);
    }
  return CAG_OK;
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
  Approach a;
  size_t first, count;
  Met met;
  int winding = 0;
  if (!approach_mesh(m, &ray, &a)) return false;
  while (cag_bvh_next(&m->bvh, &a.ray, &a.walk, &first, &count))
    for (size_t i = first; i < first + count; i++)
      if (meet_triangle(&a.shear, &m->triangles[i], &met) && met.t + a.ray.start > 0)
        winding += met.sign;
  if (winding > 0) return true;
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
      const CagVec3 q = cag_nearest_of_triangle(p, m->triangles[i].p);
      const double distance = cag_norm(cag_sub(q, p));
      if (!(distance < least || (distance == least && !found))) continue;
      least = distance;
      *point = q;
      *face = m->bvh.order[i];
      found = true;
    }
  return found;
}
