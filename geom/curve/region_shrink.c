// Shrinking convex polygons.
//
// The result is bounded only by the shifted lines of the edges, which are sorted by direction: each
// cuts off the ends of the chain of the previous ones. This takes linear time, while an arrangement
// would intersect all strips near the middle with each other.

#include "geom/curve/region_shrink.h"

#include <math.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"

// Turns below this (sine) are not corners.
#define TURN CAG_PARALLEL

// The half plane to the left of a line.
typedef struct Half {
  CagVec3 at, along; // along: unit
} Half;

typedef struct Chain {
  Half *halves;
  size_t first, end; // the remaining ones: first .. end - 1
  double slack;      // lengths below this are rounding
} Chain;

static CagVec3 meeting(const Half *a, const Half *b) {
  const double t = cag_cross(cag_sub(b->at, a->at), b->along).z / cag_cross(a->along, b->along).z;
  return cag_madd(a->at, t, a->along);
}

static bool leaves_out(const Half *h, CagVec3 p) {
  return cag_cross(h->along, cag_sub(p, h->at)).z <= 0;
}

// False: nothing is left.
static bool cut_chain(Chain *c, Half h) {
  const Half *all = c->halves;
  while (c->end - c->first > 1 && leaves_out(&h, meeting(&all[c->end - 2], &all[c->end - 1])))
    c->end--;
  while (c->end - c->first > 1 && leaves_out(&h, meeting(&all[c->first], &all[c->first + 1])))
    c->first++;
  if (c->end > c->first && !(cag_cross(all[c->end - 1].along, h.along).z > 0)) return false;
  c->halves[c->end++] = h;
  return true;
}

// The loop's edges shifted to the left by `left`; false if it is not a convex polygon that runs
// counter-clockwise once.
static bool move_edges(const CagVec3 *v, size_t n, double left, Half *out, size_t *count) {
  double turned = 0;
  *count = 0;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 p = v[i], step = cag_sub(v[(i + 1) % n], p);
    if (!(cag_norm(step) > 0)) continue;
    const CagVec3 u = cag_unit(step);
    if (*count > 0) {
      const CagVec3 before = out[*count - 1].along;
      const double sine = cag_cross(before, u).z, cosine = cag_dot(before, u);
      if (fabs(sine) <= TURN && cosine > 0) continue; // collinear with the previous edge
      if (sine < 0) return false;
      turned += atan2(sine, cosine);
    }
    out[(*count)++] = (Half){cag_madd(p, left, cag_vec3(-u.y, u.x, 0)), u};
  }
  if (*count < 3) return false;
  const CagVec3 first = out[0].along, last = out[*count - 1].along;
  const double sine = cag_cross(last, first).z, cosine = cag_dot(last, first);
  turned += atan2(sine, cosine);
  if (fabs(sine) <= TURN && cosine > 0) --*count; // the loop starts on a line
  else if (sine < 0) return false;
  return turned < 3 * M_PI;
}

static CagStatus polygon_of(const Chain *c, CagRegion **out, CagError *err) {
  const size_t n = c->end - c->first;
  CagVec3 *v = cag_malloc((n + 1) * sizeof *v);
  if (!v) return cag_fail_memory(err);
  size_t kept = 0;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 p = meeting(&c->halves[c->first + i], &c->halves[c->first + (i + 1) % n]);
    if (kept == 0 || cag_norm(cag_sub(p, v[kept - 1])) > c->slack) v[kept++] = p;
  }
  while (kept > 1 && !(cag_norm(cag_sub(v[kept - 1], v[0])) > c->slack)) kept--;
  CagCurve *loop = NULL;
  CagStatus status = CAG_OK;
  *out = NULL;
  if (kept > 2) {
    status = cag_curve_polyline(v, kept, true, 2, &loop, err);
    if (!status) status = cag_region_new(loop, NULL, 0, out, err);
    cag_curve_release(loop);
  }
  cag_free(v);
  return status;
}

CagStatus cag_region_shrink_convex(const CagRegion *r, double d, double size, bool *taken,
                                   CagRegion **out, CagError *err) {
  const CagVec3 *v;
  size_t n, count;
  bool closed;
  *taken = false;
  *out = NULL;
  if (r->count != 1 || !cag_curve_vertices(r->loops[0], &v, &n, &closed)) return CAG_OK;
  Half *moved = cag_malloc((2 * n + 2) * sizeof *moved);
  if (!moved) return cag_fail_memory(err);
  Chain c = {moved + n + 1, 0, 0, CAG_ROUNDING * size};
  *taken = move_edges(v, n, d, moved, &count);
  bool left = *taken;
  for (size_t i = 0; left && i < count; i++) left = cut_chain(&c, moved[i]);
  const Half *all = c.halves;
  while (left && c.end - c.first > 2 &&
         leaves_out(&all[c.first], meeting(&all[c.end - 2], &all[c.end - 1])))
    c.end--;
  left = left && c.end - c.first > 2 && cag_cross(all[c.end - 1].along, all[c.first].along).z > 0;
  const CagStatus status = left ? polygon_of(&c, out, err) : CAG_OK;
  cag_free(moved);
  return status;
}
