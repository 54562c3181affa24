// The nearest point of an ellipse, by Newton's method on the function of Eberly (2013, Distance from
// a point to an ellipse).

#include "geom/linalg/ellipse_foot.h"

// Newton's steps increase the root monotonically and rarely exceed ten.
#define STEPS 100

// For p in the first quadrant, and a >= b.
static CagVec3 quadrant_foot(double a, double b, double x, double y) {
  if (y == 0 && a * x < (a - b) * (a + b)) {
    const double share = a * x / ((a - b) * (a + b));
    return cag_vec3(a * share, b * sqrt((1 - share) * (1 + share)), 0);
  }
  if (y == 0) return cag_vec3(a, 0, 0);
  // The foot is (a^2 x / (t + a^2), b^2 y / (t + b^2)) for the t that brings it on the ellipse. With
  // s = t + b^2, s > 0, nothing cancels near the long axis.
  const double gap = (a - b) * (a + b);
  double s = fmax(b * y, a * x - gap);
  for (int i = 0; i < STEPS; i++) {
    const double u = a * x / (s + gap), v = b * y / s;
    const double value = u * u + v * v - 1, slope = -2 * (u * u / (s + gap) + v * v / s);
    const double next = s - value / slope;
    if (!(next > s)) break;
    s = next;
  }
  return cag_vec3(a * (a * x / (s + gap)), b * (b * y / s), 0);
}

CagVec3 cag_ellipse_foot(double a, double b, CagVec3 p, CagVec3 *normal) {
  const double x = fabs(p.x), y = fabs(p.y);
  CagVec3 foot = a < b ? quadrant_foot(b, a, y, x) : quadrant_foot(a, b, x, y);
  if (a < b) foot = cag_vec3(foot.y, foot.x, 0);
  foot.x = copysign(foot.x, p.x);
  foot.y = copysign(foot.y, p.y);
  *normal = cag_unit(cag_vec3(foot.x / a / a, foot.y / b / b, 0));
  return foot;
}
