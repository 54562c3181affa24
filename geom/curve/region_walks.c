// Lists of curves for an arrangement.

#include "geom/curve/region_walks.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"

void cag_walks_free(CagWalks *w) {
  for (size_t i = 0; i < w->n; i++) cag_curve_release(w->curves[i]);
  cag_free(w->curves);
  cag_free(w->items);
}

CagStatus cag_walks_put(CagWalks *w, CagCurve *c, int sign, CagError *err) {
  if (w->n == w->capacity) {
    const size_t capacity = w->capacity ? 2 * w->capacity : 32;
    if (!CAG_RESIZE(w->curves, capacity) || !CAG_RESIZE(w->items, capacity)) {
      cag_curve_release(c);
      return cag_fail_memory(err);
    }
    w->capacity = capacity;
  }
  w->items[w->n] = (CagWalk){c, 0, sign, -1};
  w->curves[w->n++] = c;
  return CAG_OK;
}

CagStatus cag_walks_put_line(CagWalks *w, CagVec3 p, CagVec3 q, int sign, CagError *err) {
  if (p.x == q.x && p.y == q.y) return CAG_OK;
  CagCurve *line;
  CagStatus status = cag_curve_line(p, q, 2, &line, err);
  return status ? status : cag_walks_put(w, line, sign, err);
}

CagStatus cag_walks_put_arc(CagWalks *w, CagVec3 center, CagVec3 from, CagVec3 to, bool clockwise,
                            int sign, CagError *err) {
  const CagVec3 a = cag_sub(from, center), b = cag_sub(to, center);
  const double radius = cag_norm(a);
  double turn = atan2(cag_cross(a, b).z, cag_dot(a, b));
  if (clockwise) turn = -turn;
  if (turn <= 0) turn += 2 * M_PI;
  const CagVec3 x = cag_scaled(a, 1 / radius);
  const double sense = clockwise ? -1 : 1;
  CagTransform frame = cag_translate(center);
  frame.m[0][0] = x.x;
  frame.m[1][0] = x.y;
  frame.m[0][1] = -sense * x.y;
  frame.m[1][1] = sense * x.x;
  frame.planar = true;
  CagCurve *arc;
  CagStatus status = cag_curve_arc(radius, radius, 0, turn, &frame, &arc, err);
  return status ? status : cag_walks_put(w, arc, sign, err);
}
