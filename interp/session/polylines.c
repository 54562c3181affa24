#include "interp/session/polylines.h"

#include "base/array.h"
#include "base/memory.h"

// The largest turn between segments of a line, in radians, and its tolerance as a fraction of its
// size.
#define LINE_TURN 0.1
#define LINE_PART 2e-4

void cag_polylines_free(CagPolylines *l) {
  cag_free(l->points);
  cag_free(l->sizes);
}

CagStatus cag_polylines_begin(CagPolylines *l, CagError *err) {
  if (!CAG_RESERVE(l->sizes, l->capacity, l->count + 1)) return cag_fail_memory(err);
  l->sizes[l->count++] = 0;
  return CAG_OK;
}

CagStatus cag_polylines_add(CagPolylines *l, CagVec3 p, CagError *err) {
  if (!CAG_RESERVE(l->points, l->point_capacity, l->point_count + 3)) return cag_fail_memory(err);
  l->points[l->point_count++] = (float)p.x;
  l->points[l->point_count++] = (float)p.y;
  l->points[l->point_count++] = (float)p.z;
  l->sizes[l->count - 1]++;
  return CAG_OK;
}

static double curve_size(const CagCurve *c) {
  CagBounds box;
  CagError ignored;
  if (cag_curve_bounds(c, &box, &ignored) || box.min.x > box.max.x) return 1;
  return cag_norm(cag_sub(box.max, box.min));
}

CagStatus cag_polylines_curve(CagPolylines *l, const CagCurve *c, const CagTransform *map,
                              CagError *err) {
  double *t = NULL;
  size_t n = 0;
  const double size = curve_size(c);
  CagStatus status = cag_polylines_begin(l, err);
  if (!status && size > 0)
    status = cag_curve_discretize(c, LINE_PART * size, LINE_TURN, &t, &n, err);
  for (size_t i = 0; !status && i < n; i++) {
    CagVec3 p;
    status = cag_curve_eval(c, t[i], 0, CAG_SIDE_RIGHT, &p, err);
    if (!status) status = cag_polylines_add(l, cag_transform_point(map, p), err);
  }
  cag_free(t);
  return status;
}
