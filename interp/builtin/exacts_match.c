// Matches of edges, by the distances of points from the chords of the others.

#include "interp/builtin/exacts_match.h"

#include <math.h>

#include "base/stop.h"
#include "geom/mesh/distance.h"
#include "interp/builtin/holds.h"

#define CHORDS 32
// Edges that are farther apart than this fraction of their length do not run along each other.
#define APART 0.02

// The edges of all parts in world coordinates, each as CHORDS + 1 points.
typedef struct Lines {
  CagVec3 (*points)[CHORDS + 1];
  bool *sharp;
  size_t n;
} Lines;

static CagStatus edge_points(const CagExactParts *p, size_t part, const CagEdgeFeature *e,
                             CagVec3 *out, CagError *err) {
  const CagCurve *c = p->parts[part].edges[e->edge].curve;
  for (int i = 0; i <= CHORDS; i++) {
    const CagStatus status =
        cag_curve_point(c, c->start + (c->end - c->start) * i / CHORDS, &out[i], err);
    if (status) return status;
    out[i] = cag_transform_point(&p->solid->placement, out[i]);
  }
  return CAG_OK;
}

static CagStatus lines_of(const CagExactParts *p, Lines *out, CagError *err) {
  size_t n = 0;
  for (size_t i = 0; i < p->count; i++) n += p->features[i].edge_count;
  *out = (Lines){cag_hold_array(p->call, n, sizeof *out->points),
                 cag_hold_array(p->call, n, sizeof *out->sharp), 0};
  for (size_t i = 0; i < p->count; i++)
    for (size_t k = 0; k < p->features[i].edge_count; k++, out->n++) {
      const CagEdgeFeature *e = &p->features[i].edges[k];
      out->sharp[out->n] = e->bend != CAG_EDGE_SMOOTH && p->parts[i].edges[e->edge].curve;
      if (!out->sharp[out->n]) continue;
      const CagStatus status = edge_points(p, i, e, out->points[out->n], err);
      if (status) return status;
    }
  return CAG_OK;
}

// Of a point from the chords.
static double line_distance(const CagVec3 *points, CagVec3 p) {
  double least = INFINITY;
  for (int i = 0; i < CHORDS; i++)
    least = fmin(least, cag_distance_to_segment(p, points[i], points[i + 1]));
  return least;
}

static double line_length(const CagVec3 *points) {
  double sum = 0;
  for (int i = 0; i < CHORDS; i++) sum += cag_norm(cag_sub(points[i + 1], points[i]));
  return sum;
}

// The line nearest to a point of another one, of which it is at most a fraction of the length away.
static size_t nearest_line(const Lines *l, CagVec3 p, double length) {
  double least = APART * length;
  size_t best = SIZE_MAX;
  for (size_t i = 0; i < l->n; i++) {
    if (!l->sharp[i]) continue;
    const double d = line_distance(l->points[i], p);
    if (!(d < least)) continue;
    least = d;
    best = i;
  }
  return best;
}

CagStatus cag_match_edges(const CagExactParts *from, const CagExactParts *to, CagEdgeMatch *out,
                          CagError *err) {
  Lines a, b;
  CagStatus status = lines_of(from, &a, err);
  if (!status) status = lines_of(to, &b, err);
  if (status) return status;
  *out = (CagEdgeMatch){cag_hold_array(from->call, b.n, sizeof *out->of),
                        cag_hold_array(from->call, a.n, sizeof *out->back), a.n, b.n};
  for (size_t i = 0; !status && i < b.n; i++) {
    const double length = b.sharp[i] ? line_length(b.points[i]) : 0;
    for (int k = 0; k < CAG_MATCH_PLACES; k++)
      out->of[i][k] =
          b.sharp[i]
              ? nearest_line(&a, b.points[i][CHORDS * (k + 1) / (CAG_MATCH_PLACES + 1)], length)
              : SIZE_MAX;
    status = cag_stop_check(err);
  }
  for (size_t i = 0; !status && i < a.n; i++) {
    out->back[i] =
        a.sharp[i] ? nearest_line(&b, a.points[i][CHORDS / 2], line_length(a.points[i])) : SIZE_MAX;
    status = cag_stop_check(err);
  }
  return status;
}
