// Rays at meshes: the code of ray_mesh_casts.c, which is also compiled for other processors.
//
// The hierarchy finds triangles near the ray. Those that it certainly misses are ruled out in floats,
// with bounds of the errors; the others are met exactly.

#ifndef CAG_GEOM_RAY_RAY_MESH_WALK_H
#define CAG_GEOM_RAY_RAY_MESH_WALK_H

#include <float.h>

#include "geom/ray/bvh_walk.h"
#include "geom/ray/ray_mesh.h"

// --- Meeting a triangle ---

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
static bool meet_triangle(const Shear *s, const CagVec3 *p, const uint32_t t[3], Met *out) {
  const Projected a = project(s, &p[t[0]]), b = project(s, &p[t[1]]), c = project(s, &p[t[2]]);
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

// --- Ruling out ---

// Two triangles at a time, in the two halves of eight lanes. In each half, the lanes are the corners;
// the fourth lane is unused.
//
// The bounds of the errors, with e = 2^-24 and R the radius of the hierarchy, whose bounds contain
// the ray's origin and the corners: the differences of rounded coordinates are off by 4 e R, and the
// coordinates after the shear by 16 e R. With d for that and m for the largest coordinate of two
// corners, which is at most 4 R, their edge function is off by at most 4 d m + 2 d^2 from this, and
// by 4 e m^2 <= d m from its own rounding, which is less than 5 d (m + d).
#define SIEVE_ERROR 1.5e-6 // d / R = 25 e, with some reserve
// The rounding of products that are not normal numbers.
#define SIEVE_LEAST FLT_MIN

typedef struct Sieve {
  CagFloat8 origin[3], shear[2], scale; // along the axes x, y, and z of the shear
  CagFloat8 error, error_rate;          // of edge functions: error + error_rate m
  float reserve;                        // of parameters
  int row[3];                           // where the coordinates of a triangle begin
} Sieve;

static void sieve_of(const CagBvh *b, const CagBvhRay *ray, const Shear *shear, Sieve *s) {
  const int axis[3] = {shear->x, shear->y, shear->z};
  const float d = (float)(SIEVE_ERROR * b->radius);
  for (int k = 0; k < 3; k++) {
    s->origin[k] = cag_all8(ray->origin[axis[k]]);
    s->row[k] = 3 * axis[k];
  }
  s->shear[0] = cag_all8((float)shear->sx);
  s->shear[1] = cag_all8((float)shear->sy);
  s->scale = cag_all8((float)shear->sz);
  s->error = cag_all8(5 * d * d + SIEVE_LEAST);
  s->error_rate = cag_all8(5 * d);
  s->reserve = d;
}

// The lanes of a triangle.
#define CORNERS 7u

// Whether a triangle is not ruled out: by edges that it has on both sides of the ray, or by corners
// that are all beyond the range.
INLINE unsigned is_candidate(unsigned below, unsigned above, unsigned beyond) {
  return (!(below & CORNERS) || !(above & CORNERS)) && (beyond & CORNERS) != CORNERS;
}

// The triangles, of the two, that the ray may meet at a parameter of at most `most`, as bits.
INLINE unsigned sieve_pair(const Sieve *s, const CagRayTriangle *one, const CagRayTriangle *other,
                           float most) {
  const float *a = one->x, *b = other->x;
  const CagFloat8 z = cag_minus8(cag_halves8(a + s->row[2], b + s->row[2]), s->origin[2]);
  const CagFloat8 dx = cag_minus8(cag_halves8(a + s->row[0], b + s->row[0]), s->origin[0]);
  const CagFloat8 dy = cag_minus8(cag_halves8(a + s->row[1], b + s->row[1]), s->origin[1]);
  const CagFloat8 x = cag_subtract_product8(s->shear[0], z, dx);
  const CagFloat8 y = cag_subtract_product8(s->shear[1], z, dy);
  // The edge functions of corners 0 and 1, 1 and 2, and 2 and 0.
  const CagFloat8 edge = cag_subtract_product8(y, cag_turn8(x), cag_times8(x, cag_turn8(y)));
  const CagFloat8 size = cag_larger8(cag_size8(x), cag_size8(y));
  const CagFloat8 error =
      cag_add_product8(cag_larger8(size, cag_turn8(size)), s->error_rate, s->error);
  const unsigned below = cag_less8(cag_plus8(edge, error), cag_all8(0));
  const unsigned above = cag_less8(error, edge);
  const unsigned beyond = cag_less8(cag_all8(most + s->reserve), cag_times8(z, s->scale));
  return is_candidate(below, above, beyond) | is_candidate(below >> 4, above >> 4, beyond >> 4)
                                                  << 1;
}

// --- Rays ---

// The ray's parameter from the prepared origin on, which is near the mesh.
typedef struct Approach {
  const CagRay *whole;
  CagBvhRay ray;
  Shear shear;
  Sieve sieve;
  CagBvhWalk walk;
} Approach;

static bool approach_mesh(const CagRayMesh *m, const CagRay *ray, Approach *a) {
  if (!cag_bvh_ray(&m->bvh, ray->origin, ray->direction, ray->least, ray->most, &a->ray))
    return false;
  a->shear = shear_of(cag_madd(ray->origin, a->ray.start, ray->direction), ray->direction);
  a->whole = ray;
  sieve_of(&m->bvh, &a->ray, &a->shear, &a->sieve);
  cag_bvh_start(&m->bvh, &a->walk);
  return true;
}

// Calls visit(context, t, met) for the triangles that the ray meets until it returns false. Calls may
// reduce `a->ray.most`.
typedef bool VisitMet(void *context, const CagRayTriangle *t, const Met *met);
#ifdef CAG_VISIT_BY_EMBREE
static void visit_met(const CagRayMesh *m, Approach *a, VisitMet *visit, void *context);
#else
INLINE void visit_met(const CagRayMesh *m, Approach *a, VisitMet *visit, void *context) {
  size_t first, count;
  Met met;
  while (cag_bvh_next(&m->bvh, &a->ray, &a->walk, &first, &count))
    for (size_t i = first; i < first + count; i += 2) {
      const bool pair = i + 1 < first + count;
      unsigned left =
          sieve_pair(&a->sieve, &m->triangles[i], &m->triangles[i + pair], a->ray.most) &
          (1u + 2u * pair);
      for (; left; left &= left - 1) {
        const CagRayTriangle *t = &m->triangles[i + (size_t)cag_lowest_bit(left)];
        if (meet_triangle(&a->shear, m->mesh->positions, t->corner, &met) &&
            !visit(context, t, &met))
          return;
      }
    }
}
#endif

static CagVec3 corner_mix(const double *uv, const uint32_t *t, const Met *met) {
  const double w0 = 1 - met->weight[0] - met->weight[1];
  const double *a = uv + 2 * (size_t)t[0], *b = uv + 2 * (size_t)t[1], *c = uv + 2 * (size_t)t[2];
  return cag_vec3(w0 * a[0] + met->weight[0] * b[0] + met->weight[1] * c[0],
                  w0 * a[1] + met->weight[0] * b[1] + met->weight[1] * c[1], 0);
}

static CagCrossing crossing_of(const CagMesh *m, const CagRayTriangle *t, const Met *met) {
  const CagVec3 p = m->positions[t->corner[0]];
  CagVec3 uv = {NAN, NAN, 0};
  if (m->uv) uv = corner_mix(m->uv, t->corner, met);
  return (CagCrossing){.t = met->t,
                       .normal = cag_unit(cag_cross(cag_sub(m->positions[t->corner[1]], p),
                                                    cag_sub(m->positions[t->corner[2]], p))),
                       .u = uv.x,
                       .v = uv.y,
                       .face = t->face,
                       .label = m->labels ? m->labels[t->face] : 0,
                       .sign = met->sign,
                       .weight = {(float)met->weight[0], (float)met->weight[1]}};
}

// A float that is not less.
static float float_above(double t) {
  const float f = (float)t;
  return f + fabsf(f) * FLT_EPSILON + FLT_MIN;
}

// The nearest triangle so far, with parameters relative to the prepared origin.
typedef struct Nearest {
  Approach approach;
  double least, most;
  bool found;
  const CagRayTriangle *triangle;
  Met met;
} Nearest;

INLINE bool visit_nearest(void *context, const CagRayTriangle *t, const Met *met) {
  Nearest *n = context;
  if (!(met->t > n->least && met->t <= n->most)) return true;
  // Of two at one distance, the one with the lower number.
  if (met->t == n->most && n->found && t->face > n->triangle->face) return true;
  n->found = true;
  n->triangle = t;
  n->met = *met;
  n->most = met->t;
  n->approach.ray.most = float_above(met->t);
  return true;
}

static bool mesh_first(const CagRayMesh *m, const CagRay *ray, CagCrossing *out) {
  Nearest n;
  if (!approach_mesh(m, ray, &n.approach)) return false;
  const double start = n.approach.ray.start;
  n.least = ray->least - start;
  n.most = ray->most - start;
  n.found = false;
  visit_met(m, &n.approach, visit_nearest, &n);
  if (!n.found) return false;
  n.met.t += start;
  *out = crossing_of(m->mesh, n.triangle, &n.met);
  return true;
}

typedef struct Blocking {
  double least, most;
  bool found;
} Blocking;

INLINE bool visit_blocking(void *context, const CagRayTriangle *t, const Met *met) {
  (void)t;
  Blocking *b = context;
  b->found = met->t > b->least && met->t <= b->most;
  return !b->found;
}

static bool mesh_blocks(const CagRayMesh *m, const CagRay *ray) {
  Approach a;
  if (!approach_mesh(m, ray, &a)) return false;
  Blocking b = {ray->least - a.ray.start, ray->most - a.ray.start, false};
  visit_met(m, &a, visit_blocking, &b);
  return b.found;
}

typedef struct Collecting {
  const CagRayMesh *mesh;
  const CagRay *ray;
  double start;
  CagCrossings *out;
  CagError *err;
  CagStatus status;
} Collecting;

INLINE bool visit_each(void *context, const CagRayTriangle *t, const Met *met) {
  Collecting *c = context;
  Met shifted = *met;
  shifted.t += c->start;
  if (!(shifted.t > c->ray->least && shifted.t <= c->ray->most)) return true;
  CagCrossing *added = cag_crossings_add(c->out, c->err);
  if (added) *added = crossing_of(c->mesh->mesh, t, &shifted);
  else c->status = CAG_E_MEMORY;
  return added;
}

static CagStatus mesh_all(const CagRayMesh *m, const CagRay *ray, CagCrossings *out,
                          CagError *err) {
  Approach a;
  if (!approach_mesh(m, ray, &a)) return CAG_OK;
  Collecting c = {m, ray, a.ray.start, out, err, CAG_OK};
  visit_met(m, &a, visit_each, &c);
  return c.status;
}

typedef struct Winding {
  double least;
  int sum;
} Winding;

INLINE bool visit_winding(void *context, const CagRayTriangle *t, const Met *met) {
  (void)t;
  Winding *w = context;
  if (met->t > w->least) w->sum += met->sign;
  return true;
}

static int mesh_winding(const CagRayMesh *m, const CagRay *ray) {
  Approach a;
  if (!approach_mesh(m, ray, &a)) return 0;
  Winding w = {ray->least - a.ray.start, 0};
  visit_met(m, &a, visit_winding, &w);
  return w.sum;
}

#define CAG_RAY_MESH_CASTS                                                                         \
  { mesh_first, mesh_blocks, mesh_all, mesh_winding }

#endif
