#include "geom/curve/intersect_circles.h"

#include <float.h>

#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// Axes of an arc are those of a circle within this fraction of their length.
#define ROUND CAG_ROUNDING
// Circles closer to each other than this fraction of their size nearly coincide.
#define NEARLY 1e-3
// The largest error of a direction, in radians, for which a tangency is decided in closed form.
#define UNSURE 1e-6

typedef struct Circle {
  CagVec3 center, normal;
  double radius;
} Circle;

static bool circle_of(const CagCurve *c, Circle *out) {
  CagVec3 x, y;
  double rate;
  if (!cag_curve_arc_axes(c, &out->center, &x, &y, &rate)) return false;
  const double xx = cag_dot(x, x), yy = cag_dot(y, y);
  if (!(xx > 0) || fabs(xx - yy) > ROUND * xx || fabs(cag_dot(x, y)) > ROUND * xx) return false;
  if (fabs(rate) * (c->end - c->start) > 2 * M_PI * (1 + 4 * DBL_EPSILON)) return false;
  out->radius = sqrt(xx);
  out->normal = cag_scaled(cag_cross(x, y), 1 / xx);
  return true;
}

// Adds an intersection of both circles if it is on both parts.
static CagStatus add_place(const CagCurve *const c[2], CagVec3 p, int multiplicity, double same,
                           CagContact *out, size_t *n, CagError *err) {
  double t[2];
  for (int i = 0; i < 2; i++) {
    CagVec3 foot;
    double distance;
    CagStatus status = cag_curve_closest(c[i], p, &t[i], &foot, &distance, err);
    if (status || distance > same) return status;
    if (c[i]->closed && t[i] == c[i]->end) t[i] = c[i]->start;
  }
  out[(*n)++] = (CagContact){t[0], {t[1], 0}, p, multiplicity};
  return CAG_OK;
}

CagStatus cag_circles_intersect(const CagCurve *a, const CagCurve *b, double same,
                                CagContact out[2], size_t *n, bool *decided, CagError *err) {
  Circle k, m;
  *n = 0;
  *decided = false;
  if (!circle_of(a, &k) || !circle_of(b, &m)) return CAG_OK;
  const double noise =
      32 * DBL_EPSILON * fmax(cag_norm(k.center) + k.radius, cag_norm(m.center) + m.radius);
  const CagVec3 way = cag_sub(m.center, k.center);
  const double tilt = cag_norm(cag_cross(k.normal, m.normal)) * fmax(k.radius, m.radius);
  if (tilt > noise || fabs(cag_dot(way, k.normal)) > noise) return CAG_OK;

  // The gap between the circles, apart or one inside the other; negative if they cross.
  const double d = cag_norm(way), growth = k.radius - m.radius;
  const double gap = fmax(d - (k.radius + m.radius), fabs(growth) - d);
  *decided = true;
  if (gap > same) return CAG_OK;
  const bool touch = fabs(gap) <= noise && noise <= UNSURE * d && d + fabs(growth) > same;
  if (!touch && gap >= -same) {
    *decided = false;
    return CAG_OK;
  }
  // Angle at the center of a in the triangle of the centers and an intersection.
  const CagVec3 u = cag_scaled(way, 1 / d), v = cag_cross(k.normal, u);
  double cosine = (d * d + growth * (k.radius + m.radius)) / (2 * d * k.radius);
  if (touch) cosine = cosine < 0 ? -1 : 1;
  const double sine = sqrt(fmax(0, (1 - cosine) * (1 + cosine)));
  const CagCurve *const c[2] = {a, b};
  const size_t places = touch ? 1 : 2;
  for (size_t i = 0; i < places; i++) {
    const CagVec3 along = cag_add(cag_scaled(u, cosine), cag_scaled(v, i ? -sine : sine));
    const CagVec3 p = cag_add(k.center, cag_scaled(along, k.radius));
    CagStatus status = add_place(c, p, touch ? 2 : 1, same, out, n, err);
    if (status) return status;
  }
  if (*n == 2 && out[1].t < out[0].t) {
    const CagContact first = out[1];
    out[1] = out[0];
    out[0] = first;
  }
  *decided = *n == places || d + fabs(growth) > NEARLY * (k.radius + m.radius);
  return CAG_OK;
}
