#include "geom/ray/ray_rods.h"

#include "base/memory.h"
#include "geom/ray/bvh_walk.h"

// A rod, prepared.
struct CagRodForm {
  CagVec3 from, axis; // unit; 0 for a ball
  double length;
  bool ball;
};

// --- Making ---

static CagBounds rod_bounds(const CagRod *rod, double radius) {
  const CagVec3 a = rod->from, b = rod->to;
  return (CagBounds){{fmin(a.x, b.x) - radius, fmin(a.y, b.y) - radius, fmin(a.z, b.z) - radius},
                     {fmax(a.x, b.x) + radius, fmax(a.y, b.y) + radius, fmax(a.z, b.z) + radius}};
}

static CagRodForm rod_form(const CagRod *rod) {
  const CagVec3 way = cag_sub(rod->to, rod->from);
  CagRodForm form = {.from = rod->from, .length = cag_norm(way), .ball = rod->ball};
  if (form.length > 0) form.axis = cag_scaled(way, 1 / form.length);
  else form.ball = true;
  return form;
}

CagStatus cag_ray_rods_new(const CagRod *rods, size_t n, double radius, CagRayRods **out,
                           CagError *err) {
  CagRayRods *made = cag_calloc(1, sizeof *made);
  CagBounds *boxes = cag_malloc((n + 1) * sizeof *boxes);
  CagStatus status = made && boxes ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) boxes[i] = rod_bounds(&rods[i], radius);
  if (!status) status = cag_bvh_build(boxes, n, 1, &made->bvh, err);
  cag_free(boxes);
  if (!status) {
    made->radius = radius;
    made->forms = cag_malloc((n + 1) * sizeof *made->forms);
    if (!made->forms) status = cag_fail_memory(err);
  }
  if (status) {
    cag_ray_rods_free(made);
    return status;
  }
  for (size_t i = 0; i < n; i++) made->forms[i] = rod_form(&rods[made->bvh.order[i]]);
  made->bvh.items = made->forms;
  made->bvh.item_size = sizeof *made->forms;
  *out = made;
  return CAG_OK;
}

void cag_ray_rods_free(CagRayRods *r) {
  if (!r) return;
  cag_bvh_free(&r->bvh);
  cag_free(r->forms);
  cag_free(r);
}

// --- Rays ---

// A crossing as a search keeps it.
typedef struct Met {
  double t;
  CagVec3 normal; // not a unit vector
  uint32_t face;
  int sign;
} Met;

// The nearest crossing after `least` so far; out->t is the end of the ray at the beginning.
typedef struct Search {
  double least;
  bool met;
  Met out;
} Search;

static bool is_nearer(const Search *s, double t) { return t > s->least && t < s->out.t; }

static void keep_met(Search *s, double t, CagVec3 normal, uint32_t face, int sign) {
  s->met = true;
  s->out = (Met){t, normal, face, sign};
}

// `foot` is the point of the line nearest to the center, relative to it, at the parameter t.
static void meet_ball(double radius, CagVec3 foot, CagVec3 d, double t, Search *s) {
  const double rest = radius * radius - cag_dot(foot, foot);
  if (!(rest > 0)) return;
  const double half = sqrt(rest);
  for (int k = 0; k < 2; k++) {
    const double by = k ? half : -half;
    if (is_nearer(s, t + by)) keep_met(s, t + by, cag_madd(foot, by, d), CAG_ROD_BALL, k ? 1 : -1);
  }
}

static void meet_end(const CagRodForm *rod, double radius, CagVec3 o, CagVec3 d, double shift,
                     bool last, Search *s) {
  const double way = cag_dot(d, rod->axis), at = last ? rod->length : 0;
  if (way == 0) return;
  const double step = (at - cag_dot(o, rod->axis)) / way;
  if (!is_nearer(s, shift + step)) return;
  const CagVec3 p = cag_madd(cag_madd(o, step, d), -at, rod->axis);
  if (!(cag_dot(p, p) < radius * radius)) return;
  keep_met(s, shift + step, cag_scaled(rod->axis, last ? 1 : -1), CAG_ROD_END,
           (way > 0) == last ? 1 : -1);
}

static void meet_rod(const CagRodForm *rod, double radius, const CagRay *ray, Search *s) {
  const CagVec3 d = ray->direction, far = cag_sub(ray->origin, rod->from);
  // From the point of the ray nearest to the start, where rounding matters least.
  const double shift = -cag_dot(far, d);
  const CagVec3 o = cag_madd(far, shift, d);
  if (rod->length > 0) {
    const double way = cag_dot(d, rod->axis), from = cag_dot(o, rod->axis);
    const CagVec3 across = cag_madd(d, -way, rod->axis), off = cag_madd(o, -from, rod->axis);
    const double a = cag_dot(across, across), b = cag_dot(off, across);
    const double c = cag_dot(off, off) - radius * radius, square = b * b - a * c;
    // The balls are within the unbounded cylinder.
    if (a > 0 ? !(square > 0) : !(c < 0)) return;
    for (int k = 0; k < 2 && a > 0; k++) {
      const double step = (-b + (k ? sqrt(square) : -sqrt(square))) / a, along = from + step * way;
      if (along >= 0 && along <= rod->length && is_nearer(s, shift + step))
        keep_met(s, shift + step, cag_madd(off, step, across), CAG_ROD_SIDE, k ? 1 : -1);
    }
    meet_end(rod, radius, o, d, shift, false, s);
    meet_end(rod, radius, o, d, shift, true, s);
  }
  if (rod->ball) meet_ball(radius, o, d, shift, s);
}

static bool search_rods(const CagRayRods *r, const CagRay *ray, bool any, Search *s) {
  CagBvhRay walked;
  CagBvhWalk walk;
  size_t first, count;
  *s = (Search){.least = ray->least, .out.t = nextafter(ray->most, INFINITY)};
  if (!cag_bvh_ray(&r->bvh, ray->origin, ray->direction, ray->least, ray->most, &walked))
    return false;
  cag_bvh_start(&r->bvh, &walk);
  while (cag_bvh_next(&r->bvh, &walked, &walk, &first, &count))
    for (size_t i = first; i < first + count; i++) {
      meet_rod(&r->forms[i], r->radius, ray, s);
      if (!s->met) continue;
      if (any) return true;
      walked.most = nextafterf((float)(s->out.t - walked.start), INFINITY);
    }
  return s->met;
}

bool cag_ray_rods_first(const CagRayRods *r, const CagRay *ray, CagCrossing *out) {
  Search s;
  if (!search_rods(r, ray, false, &s)) return false;
  *out = (CagCrossing){.t = s.out.t,
                       .normal = cag_unit(s.out.normal),
                       .u = NAN,
                       .v = NAN,
                       .face = s.out.face,
                       .sign = s.out.sign};
  return true;
}

bool cag_ray_rods_blocks(const CagRayRods *r, const CagRay *ray) {
  Search s;
  return search_rods(r, ray, true, &s);
}
