// Tessellation of trimmed surfaces: their loops are discretized as curves in space, and the surface
// is triangulated within them (within.h).

#include "geom/tessellate/trimmed.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/tessellation.h"
#include "geom/tessellate/within.h"

// Adds a point of a loop at t. Points of different parameters get different numbers.
static CagStatus add_point(CagLoopPoints *o, const CagSurface *inner, const CagCurve *loop,
                           double t, CagError *err) {
  CagVec3 x, position;
  CagStatus status = cag_curve_point(loop, t, &x, err);
  if (status) return status;
  const double u = fmin(fmax(x.x, inner->u0), inner->u1), v = fmin(fmax(x.y, inner->v0), inner->v1);
  status = cag_surface_point(inner, u, v, &position, err);
  return status ? status : cag_loop_points_add(o, u, v, position, (uint32_t)o->count, err);
}

// Discretizes a loop in space; its last point equals the first and is left out.
static CagStatus outline_loop(CagLoopPoints *o, const CagSurface *s, size_t loop,
                              const CagTessellation *how, size_t *count, CagError *err) {
  const CagSurface *inner;
  const CagRegion *region;
  cag_surface_trimmed_view(s, &inner, &region);
  CagCurve *on;
  double *at = NULL;
  size_t n = 0, before = o->count;
  CagStatus status = cag_trimmed_loop(s, loop, &on, err);
  if (status) return status;
  double angle = how->angle > 0 ? how->angle : M_PI / 2;
  status = cag_curve_discretize_short(on, how->tolerance, angle, how->short_edge * how->tolerance,
                                      &at, &n, err);
  for (size_t k = 0; !status && k + 1 < n; k++) {
    CagVec3 a, b;
    status = cag_curve_point(on, at[k], &a, err);
    if (!status) status = cag_curve_point(on, at[k + 1], &b, err);
    if (status) break;
    const double length = cag_norm(cag_sub(b, a));
    double edges = how->max_edge > 0 ? ceil(length / how->max_edge) : 1;
    size_t parts = 1;
    status = cag_loop_points_parts(inner, region->loops[loop], at[k], at[k + 1], length, how,
                                   &parts, err);
    if (edges > (double)parts) parts = (size_t)edges;
    for (size_t j = 0; !status && j < parts; j++)
      status = add_point(o, inner, region->loops[loop],
                         at[k] + (at[k + 1] - at[k]) * (double)j / (double)parts, err);
    if (!status) status = cag_loop_points_check(o, how, err);
  }
  cag_free(at);
  cag_curve_release(on);
  *count = o->count - before;
  return status;
}

typedef struct Place {
  CagVec3 at;
  uint32_t vertex;
} Place;

static int by_place(const void *a, const void *b) {
  const Place *x = a, *y = b;
  if (x->at.x != y->at.x) return x->at.x < y->at.x ? -1 : 1;
  if (x->at.y != y->at.y) return x->at.y < y->at.y ? -1 : 1;
  if (x->at.z != y->at.z) return x->at.z < y->at.z ? -1 : 1;
  return x->vertex < y->vertex ? -1 : 1;
}

// Points of the outline that differ only by rounding, at poles and seams, become one.
static CagStatus unite_points(CagLoopPoints *o, CagError *err) {
  const double same = 1e-11; // of the size
  uint32_t *of = o->points;
  Place *places = cag_malloc((o->count + 1) * sizeof *places);
  if (!places) return cag_fail_memory(err);
  double size = 0;
  for (size_t k = 0; k < o->count; k++) {
    places[k] = (Place){o->positions[k], (uint32_t)k};
    size = fmax(size, cag_norm(o->positions[k]));
  }
  qsort(places, o->count, sizeof *places, by_place);
  for (size_t k = 0; k < o->count; k++)
    for (size_t j = k + 1; j < o->count; j++) {
      if (places[j].at.x - places[k].at.x > same * size) break;
      if (cag_norm(cag_sub(places[j].at, places[k].at)) > same * size) continue;
      uint32_t a = places[k].vertex, b = places[j].vertex;
      while (of[a] != a) a = of[a];
      while (of[b] != b) b = of[b];
      of[a > b ? a : b] = a < b ? a : b;
    }
  for (size_t k = 0; k < o->count; k++) {
    while (of[of[k]] != of[k]) of[k] = of[of[k]];
    o->positions[k] = o->positions[of[k]];
  }
  cag_free(places);
  return CAG_OK;
}

CagStatus cag_trimmed_tessellate(const CagSurface *s, const CagTessellation *how, CagMesh **out,
                                 CagError *err) {
  const CagSurface *inner;
  const CagRegion *region;
  cag_surface_trimmed_view(s, &inner, &region);
  size_t *counts = cag_malloc((region->count + 1) * sizeof *counts);
  CagLoopPoints o = {.counts = counts, .loops = region->count};
  const double box[4] = {s->u0, s->u1, s->v0, s->v1};
  CagStatus status = counts ? CAG_OK : cag_fail_memory(err);
  for (size_t l = 0; !status && l < region->count; l++)
    status = outline_loop(&o, s, l, how, &counts[l], err);
  if (!status) status = unite_points(&o, err);
  if (!status) status = cag_within_tessellate(inner, box, &o, how, out, err);
  cag_loop_points_free(&o);
  cag_free(counts);
  return status;
}
