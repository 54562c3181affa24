// A point inside a region: the middle of the widest stretch of a horizontal line in its largest
// part, an outer loop with its holes.
//
// Lines run midway between neighboring heights of corners and extrema, so none of them is a point
// of tangency. Among some lines, the point with the largest distance from the boundary is chosen.

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/region_arrange.h"
#include "geom/curve/region_relation.h"

// Lines that are tried.
#define LINES 5

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// The index of the outer loop with the largest area.
static CagStatus largest_part(const CagRegion *r, size_t *out, CagError *err) {
  double largest = -1;
  *out = 0;
  for (size_t i = 0; i < r->count; i++) {
    double area;
    if (r->outer[i] != i) continue;
    CagStatus status = cag_curve_area(r->loops[i], &area, NULL, err);
    if (status) return status;
    if (area > largest) *out = i;
    largest = fmax(largest, area);
  }
  return CAG_OK;
}

// The pieces of an outer loop and its holes.
static CagStatus pieces_of(const CagRegion *r, size_t outer, const CagWalk *walks,
                           CagRegionPieces *s, CagError *err) {
  *s = (CagRegionPieces){.walks = walks};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < r->count; i++)
    if (r->outer[i] == outer) status = cag_region_pieces_add(s, i, err);
  return status;
}

// The x of all pieces at the height, ascending; room for as many as there are pieces.
static CagStatus crossings(const CagRegionPieces *s, double y, double *x, size_t *n,
                           CagError *err) {
  *n = 0;
  for (size_t i = 0; i < s->n; i++) {
    const CagRegionPiece *p = &s->items[i];
    double t;
    CagVec3 at;
    if ((p->p.y <= y) == (p->q.y <= y)) continue;
    CagStatus status = cag_region_piece_at(s, p, p->a, p->b, 1, y, &t, &at, err);
    if (!status) status = cag_stop_check(err);
    if (status) return status;
    x[(*n)++] = at.x;
  }
  return cag_sort(x, *n, sizeof *x, ascending, err);
}

static CagStatus clearance(const CagRegion *r, CagVec3 p, double *out, CagError *err) {
  *out = INFINITY;
  for (size_t i = 0; i < r->count; i++) {
    double t, distance;
    CagVec3 at;
    CagStatus status = cag_curve_closest(r->loops[i], p, &t, &at, &distance, err);
    if (status) return status;
    *out = fmin(*out, distance);
  }
  return CAG_OK;
}

// The height midway between neighbors of `heights` that is nearest to the value.
static double height_near(const double *heights, size_t n, double value) {
  double best = heights[0], off = INFINITY;
  for (size_t i = 0; i + 1 < n; i++) {
    const double middle = heights[i] + (heights[i + 1] - heights[i]) / 2;
    if (!(heights[i] < middle && middle < heights[i + 1])) continue;
    // A thin gap is avoided if there is a wide one not much farther away.
    const double rank = fabs(middle - value) - (heights[i + 1] - heights[i]) / 2;
    if (rank >= off) continue;
    off = rank;
    best = middle;
  }
  return best;
}

static CagStatus best_point(const CagRegion *r, const CagRegionPieces *s, const double *heights,
                            double *x, CagVec3 *out, CagError *err) {
  double best = -1;
  for (int line = 0; line < LINES; line++) {
    const double part = (line + 1.0) / (LINES + 1),
                 y = height_near(heights, s->n,
                                 heights[0] + part * (heights[s->n - 1] - heights[0]));
    size_t n;
    CagStatus status = crossings(s, y, x, &n, err);
    if (status) return status;
    CagVec3 p = {0, y, 0};
    double width = 0, room;
    for (size_t i = 0; i + 1 < n; i += 2) {
      if (!(x[i + 1] - x[i] > width)) continue;
      width = x[i + 1] - x[i];
      p.x = x[i] + width / 2;
    }
    if (!(width > 0)) continue;
    status = clearance(r, p, &room, err);
    if (status) return status;
    if (room > best) *out = p;
    best = fmax(best, room);
  }
  return CAG_OK;
}

CagStatus cag_region_interior_point(const CagRegion *r, CagVec3 *out, CagError *err) {
  if (cag_region_is_empty(r))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
                    "the region is empty, so it has no inner point");
  CagRegionPieces s = {0};
  size_t outer;
  CagWalk *walks = cag_malloc(sizeof *walks * r->count);
  if (!walks) return cag_fail_memory(err);
  for (size_t i = 0; i < r->count; i++) walks[i] = (CagWalk){r->loops[i], 0, 1, 0};
  CagStatus status = largest_part(r, &outer, err);
  if (!status) status = pieces_of(r, outer, walks, &s, err);
  double *heights = status ? NULL : cag_malloc(sizeof *heights * (s.n + 1)),
         *x = status ? NULL : cag_malloc(sizeof *x * (s.n + 1));
  if (!status && (!heights || !x)) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < s.n; i++) heights[i] = s.items[i].p.y;
  if (!status) status = cag_sort(heights, s.n, sizeof *heights, ascending, err);
  if (!status) status = best_point(r, &s, heights, x, out, err);
  cag_free(heights);
  cag_free(x);
  cag_region_pieces_free(&s);
  cag_free(walks);
  return status;
}
