// Edges and creases of a surface that lie in a plane, and curves along which the plane touches the
// surface: the parts of a section where the surface does not cross the plane.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/meet_surface.h"
#include "geom/meet/section_edges.h"
#include "geom/surface/crease.h"
#include "geom/surface/family.h"
#include "geom/surface/trimmed.h"

// An edge lies in the plane if its distance is below this fraction of the surface's size.
#define WITHIN CAG_COINCIDENT
// The square that represents the plane extends beyond the surface's bounding sphere by this factor.
#define MARGIN 1.1

typedef struct Cut {
  const CagPlane *plane;
  double size;
  CagCurveList *out;
  CagError *err;
} Cut;

// --- Pieces in the plane ---

// Tests several points of a smooth piece to find out whether the curve is in the plane.
static CagStatus is_within(const Cut *c, const CagCurve *curve, double a, double b, bool *out) {
  enum { PLACES = 9 };
  *out = true;
  for (int i = 0; i <= PLACES && *out; i++) {
    CagVec3 p;
    CagStatus status = cag_curve_point(curve, a + (b - a) * i / PLACES, &p, c->err);
    if (status) return status;
    *out = fabs(cag_dot(c->plane->normal, cag_sub(p, c->plane->point))) <= WITHIN * c->size;
  }
  return CAG_OK;
}

// Converts the piece to a line or an arc of a conic. Returns false if it is neither, or has no
// usable tangents.
static bool simplified(const Cut *c, const CagCurve *piece, CagCurve **out) {
  enum { POINTS = 17 };
  CagVec3 points[POINTS], tangents[POINTS], checks[POINTS];
  CagTrace trace = {POINTS, POINTS - 1, piece->closed, points, tangents, checks};
  const double step = (piece->end - piece->start) / (POINTS - 1);
  CagError ignored;
  for (int i = 0; i < POINTS; i++) {
    const bool last = i == POINTS - 1;
    const double t = last ? piece->end : piece->start + step * i;
    CagVec3 d[2];
    if (cag_curve_eval(piece, t, 1, last ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &ignored) ||
        (!last && cag_curve_point(piece, t + step / 2, &checks[i], &ignored)))
      return false;
    points[i] = d[0];
    tangents[i] = cag_unit(d[1]);
  }
  if (piece->closed) points[POINTS - 1] = points[0];
  if (cag_trace_curve(&trace, NULL, c->size, out, &ignored)) return false;
  CagNurbsView view;
  if (!cag_curve_nurbs_view(*out, &view)) return true;
  cag_curve_release(*out);
  return false;
}

static CagStatus add_piece(const Cut *c, const CagCurve *curve, double a, double b) {
  CagCurve *piece = NULL, *simple = NULL;
  CagStatus status = CAG_OK;
  if (a <= curve->start && b >= curve->end) piece = cag_curve_retain(curve);
  else status = cag_curve_trim(curve, a, b, &piece, c->err);
  if (status) return status;
  if (!simplified(c, piece, &simple)) return cag_curve_list_add(c->out, piece, c->err);
  cag_curve_release(piece);
  return cag_curve_list_add(c->out, simple, c->err);
}

// Adds the pieces of an edge in the plane, and merges consecutive ones.
static CagStatus add_edge(const Cut *c, const CagCurve *edge) {
  CagCurve *space = NULL;
  double *cuts = NULL, from = 0;
  size_t n = 0;
  bool open = false;
  CagStatus status = cag_surface_space_curve(edge, &space, c->err);
  if (!status) status = cag_curve_cuts(space, &cuts, &n, c->err);
  for (size_t i = 0; !status && i + 1 < n; i++) {
    bool within;
    status = is_within(c, space, cuts[i], cuts[i + 1], &within);
    if (status) break;
    if (within && !open) from = cuts[i];
    if (!within && open) status = add_piece(c, space, from, cuts[i]);
    open = within;
  }
  if (!status && open) status = add_piece(c, space, from, cuts[n - 1]);
  cag_free(cuts);
  cag_curve_release(space);
  return status;
}

// --- Edges ---

// Adds parameter lines: the edges that are neither poles nor smooth seams, and the creases.
static CagStatus add_lines(const CagPatches *patches, int d, CagCurveList *out, CagError *err) {
  const CagSurface *s = patches->s;
  const bool closed = d ? s->closed_v : s->closed_u;
  const bool pole[2] = {d ? s->pole_v0 : s->pole_u0, d ? s->pole_v1 : s->pole_u1};
  const size_t n = patches->n[d];
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i <= n; i++) {
    const bool edge = i == 0 || i == n, seam = closed && (patches->wraps[d] || i == n);
    if (edge && (seam || pole[i > 0])) continue;
    CagCurve *line = NULL;
    status = cag_surface_isocurve(s, d, patches->ends[d][i], &line, err);
    if (!status) status = cag_curve_list_add(out, line, err);
  }
  return status;
}

CagStatus cag_surface_lines(const CagSurface *s, CagCurveList *out, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  CagStatus status = CAG_OK;
  const bool planar = cag_surface_planar_view(s, &region, &frame);
  if (!planar && !cag_surface_trimmed_view(s, NULL, &region)) {
    CagPatches patches;
    status = cag_patches_open(s, &patches, err);
    if (status) return status;
    for (int d = 0; !status && d < 2; d++) status = add_lines(&patches, d, out, err);
    cag_patches_free(&patches);
    return status;
  }
  for (size_t i = 0; !status && i < region->count; i++) {
    CagCurve *loop = NULL;
    status = planar ? cag_curve_transform(region->loops[i], &frame, &loop, err)
                    : cag_trimmed_loop(s, i, &loop, err);
    if (!status) status = cag_curve_list_add(out, loop, err);
  }
  return status;
}

CagStatus cag_section_edges(const CagSurface *s, const CagPlane *plane, double size,
                            CagCurveList *out, CagError *err) {
  const Cut c = {plane, size, out, err};
  CagCurveList lines = {0};
  CagStatus status = cag_surface_lines(s, &lines, err);
  for (size_t i = 0; !status && i < lines.count; i++) status = add_edge(&c, lines.items[i]);
  cag_curve_list_free(&lines);
  return status;
}

// --- Touches ---

CagStatus cag_section_touches(const CagSurface *s, const CagPlane *plane, const CagBounds *box,
                              double tolerance, CagCurveList *out, CagError *err) {
  const CagTransform frame = cag_plane_frame(plane);
  const CagVec3 middle = cag_lerp(box->min, box->max, 0.5);
  const double half = MARGIN * cag_norm(cag_sub(box->max, box->min)) / 2,
               off = cag_dot(plane->normal, cag_sub(middle, plane->point));
  const CagVec3 center = cag_madd(middle, -off, plane->normal);
  const CagVec3 x = cag_vec3(half * frame.m[0][0], half * frame.m[1][0], half * frame.m[2][0]);
  const CagVec3 y = cag_vec3(half * frame.m[0][1], half * frame.m[1][1], half * frame.m[2][1]);
  const CagVec3 low = cag_sub(center, x), high = cag_add(center, x);
  CagSurface *square = NULL;
  CagStatus status = cag_surface_bilinear(cag_sub(low, y), cag_add(low, y), cag_sub(high, y),
                                          cag_add(high, y), &square, err);
  if (!status) status = cag_surface_touches(s, square, tolerance, NULL, out, err);
  cag_surface_release(square);
  return status;
}
