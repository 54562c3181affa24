// Plane sections of surfaces and solids, and contours, as lists of curves.
//
// Flat faces are cut along their loops, all others are traced. Curves are joined end to end, so
// that a solid gives closed curves.

#include "geom/meet/section.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geom/curve/intersect.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/section_edges.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/family.h"
#include "geom/surface/function.h"

// Curves meet if their ends are closer than this fraction of the size; traced ends are far more
// accurate.
#define MEET 1e-7
// A face within this fraction of the size of the plane lies in it and is not cut.
#define WITHIN CAG_COINCIDENT
#define DEFAULT_TOLERANCE 1e-6
// A direction along the axis of a cylinder has no polar plane, but for rounding.
#define ALONG_AXIS 1e-12
// A traced curve runs along an exact one within this many tolerances.
#define NEAR_RUN 8

// --- Flat faces ---

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Intersections of the line p + s d in the region's plane with its loops: s, ascending.
static CagStatus cut_loops(const CagRegion *region, CagVec3 p, CagVec3 d, double **out, size_t *n,
                           CagError *err) {
  CagPlane upright = {p, cag_vec3(-d.y, d.x, 0)};
  *out = NULL;
  *n = 0;
  for (size_t i = 0; i < region->count; i++) {
    CagMeeting *found = NULL;
    size_t count = 0;
    CagStatus status = cag_curve_intersect_plane(region->loops[i], &upright, &found, &count, err);
    if (status) {
      cag_free(*out);
      return status;
    }
    double *grown = cag_realloc(*out, (*n + count + 1) * sizeof *grown);
    if (!grown) {
      cag_free(found);
      cag_free(*out);
      return cag_fail_memory(err);
    }
    *out = grown;
    for (size_t k = 0; k < count; k++) grown[(*n)++] = cag_dot(cag_sub(found[k].point, p), d);
    cag_free(found);
  }
  if (*n > 1) qsort(*out, *n, sizeof **out, by_size);
  return CAG_OK;
}

// A line in the region's plane, where it is searched and where it is: the two differ if an edge of
// the region lies on it.
typedef struct FlatLine {
  CagVec3 searched, shown, along;
} FlatLine;

static CagStatus add_piece(const CagTransform *frame, const FlatLine *l, double from, double to,
                           CagCurveList *out, CagError *err) {
  CagCurve *piece = NULL;
  CagStatus status =
      cag_curve_line(cag_transform_point(frame, cag_madd(l->shown, from, l->along)),
                     cag_transform_point(frame, cag_madd(l->shown, to, l->along)), 3, &piece, err);
  return status ? status : cag_curve_list_add(out, piece, err);
}

// The pieces of the line inside the region, with neighbors merged.
static CagStatus add_pieces(const CagRegion *region, const CagTransform *frame, const FlatLine *l,
                            const double *cuts, size_t n, double same, CagCurveList *out,
                            CagError *err) {
  CagStatus status = CAG_OK;
  bool open = false;
  double from = 0, to = 0;
  for (size_t i = 0; i + 1 < n && !status; i++) {
    if (cuts[i + 1] - cuts[i] <= same) continue;
    CagVec3 middle = cag_madd(l->searched, (cuts[i] + cuts[i + 1]) / 2, l->along);
    bool here = false;
    status = cag_region_contains(region, middle, &here, err);
    if (status) return status;
    if (here && !open) from = cuts[i];
    if (here) to = cuts[i + 1];
    if (!here && open) status = add_piece(frame, l, from, to, out, err);
    open = here;
  }
  return open && !status ? add_piece(frame, l, from, to, out, err) : status;
}

static CagStatus section_flat(const CagRegion *region, const CagTransform *frame,
                              const CagPlane *plane, double size, CagCurveList *out,
                              CagError *err) {
  CagVec3 n = plane->normal;
  CagVec3 x = cag_vec3(frame->m[0][0], frame->m[1][0], frame->m[2][0]);
  CagVec3 y = cag_vec3(frame->m[0][1], frame->m[1][1], frame->m[2][1]);
  CagVec3 o = cag_vec3(frame->m[0][3], frame->m[1][3], frame->m[2][3]);
  // a x + b y + c = 0 in the region's plane.
  double a = cag_dot(n, x), b = cag_dot(n, y), c = cag_dot(n, cag_sub(o, plane->point));
  double slope = hypot(a, b);
  if (slope <= WITHIN * (cag_norm(x) + cag_norm(y))) return CAG_OK;
  CagVec3 across = cag_vec3(a / slope, b / slope, 0), p = cag_scaled(across, -c / slope);
  FlatLine l = {p, p, cag_vec3(-across.y, across.x, 0)};
  double *cuts;
  size_t count;
  CagStatus status = cut_loops(region, p, l.along, &cuts, &count, err);
  if (status && !cag_is_final(status)) {
    // An edge lies in the plane. It belongs to the face on the negative side, so that only one of
    // two adjacent faces has it.
    l.searched = cag_madd(p, -WITHIN * size, across);
    status = cut_loops(region, l.searched, l.along, &cuts, &count, err);
  }
  if (status) return status;
  status = add_pieces(region, frame, &l, cuts, count, WITHIN * size, out, err);
  cag_free(cuts);
  return status;
}

// --- Surfaces ---

static double size_of(const CagBounds *b) { return cag_norm(cag_sub(b->max, b->min)); }

// Whether the whole box lies on one side of the plane.
static bool is_beside(const CagBounds *b, const CagPlane *plane) {
  bool above = false, below = false;
  for (int k = 0; k < 8; k++) {
    CagVec3 corner = {k & 1 ? b->max.x : b->min.x, k & 2 ? b->max.y : b->min.y,
                      k & 4 ? b->max.z : b->min.z};
    double d = cag_dot(plane->normal, cag_sub(corner, plane->point));
    above = above || d >= 0;
    below = below || d <= 0;
  }
  return !(above && below);
}

// --- Tracing ---

// Trimmed surfaces are traced as a whole, and the runs are cut at their loops.
static CagStatus trace_all(const CagSurface *s, const CagLevel *level, const CagQuadric *quadric,
                           double tolerance, double size, CagCurveList *out, bool *everywhere,
                           CagError *err) {
  CagTraces traces;
  CagStatus status = cag_surface_trace(s, level, tolerance, &traces, err);
  if (everywhere) *everywhere = traces.everywhere;
  for (size_t i = 0; !status && i < traces.count; i++) {
    CagCurve *c = NULL;
    status = cag_trace_curve(&traces.items[i], quadric, size, &c, err);
    if (!status) status = cag_curve_list_add(out, c, err);
  }
  if (traces.count > 0) cag_traces_free(&traces);
  return status;
}

static CagStatus section_face(const CagSurface *s, const CagPlane *plane, double tolerance,
                              double size, CagCurveList *out, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  CagBounds box;
  CagQuadric q;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status || is_beside(&box, plane)) return status;
  if (cag_surface_planar_view(s, &region, &frame))
    return section_flat(region, &frame, plane, size, out, err);
  bool bitangent;
  status = cag_section_villarceau(s, plane, size, out, &bitangent, err);
  if (status || bitangent) return status;
  CagLevel level = cag_level_plane(plane, size);
  bool quadric = cag_surface_quadric_view(s, &q);
  size_t first = out->count;
  status = trace_all(s, &level, quadric ? &q : NULL, tolerance, size, out, NULL, err);
  // A surface that touches the plane along a line of cells is on the same side of it in the cells
  // on both sides, so each of them has a run.
  return status ? status : cag_curve_list_drop_covered(out, first, MEET * size, err);
}

// Adds edges in the plane and curves along which the plane touches the surface. Both need
// derivatives, which a formula may not have on its edges. Formulas are therefore also traced from
// the other side of the plane.
static CagStatus add_edges_and_touches(const CagSurface *s, const CagPlane *plane,
                                       const CagBounds *box, double tolerance, CagCurveList *out,
                                       CagError *err) {
  const CagPlane turned = {plane->point, cag_scaled(plane->normal, -1)};
  if (cag_surface_is_formula(s)) return section_face(s, &turned, tolerance, size_of(box), out, err);
  CagStatus status = cag_section_edges(s, plane, size_of(box), out, err);
  if (status || cag_surface_planar_view(s, NULL, NULL)) return status;
  return cag_section_touches(s, plane, box, tolerance, out, err);
}

CagStatus cag_surface_section(const CagSurface *s, const CagPlane *plane, double tolerance,
                              CagCurveList *out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status || is_beside(&box, plane)) return status;
  double size = size_of(&box);
  size_t first = out->count;
  if (!(tolerance > 0)) tolerance = DEFAULT_TOLERANCE * size;
  // The most accurate curves come first, because the first of two equal curves is kept.
  status = add_edges_and_touches(s, plane, &box, tolerance, out, err);
  if (!status) status = section_face(s, plane, tolerance, size, out, err);
  if (!status)
    status = cag_curve_list_drop_covered(out, first, NEAR_RUN * tolerance + MEET * size, err);
  return status ? status : cag_curve_list_join(out, first, MEET * size, err);
}

CagStatus cag_solid_section(const CagSolid *s, const CagPlane *plane, double tolerance,
                            CagCurveList *out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_solid_bounds(s, &box, err);
  if (status) return status;
  double size = size_of(&box);
  size_t first = out->count;
  if (!(tolerance > 0)) tolerance = DEFAULT_TOLERANCE * size;
  if (s->face_count == 0) {
    // The solid is known only as a mesh.
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *mesh = NULL;
    status = cag_solid_tessellate(s, &how, &mesh, err);
    if (!status) status = cag_mesh_section(mesh, plane, out, err);
    cag_mesh_release(mesh);
    return status;
  }
  for (size_t i = 0; !status && i < s->face_count; i++)
    status = section_face(s->faces[i], plane, tolerance, size, out, err);
  return status ? status : cag_curve_list_join(out, first, MEET * size, err);
}

// The plane with the points of a quadric at which a line of sight touches it: the polar plane of the
// eye, or of the point at infinity in the direction. Returns false if there is none.
static bool polar_plane(const CagQuadric *q, CagVec3 direction, CagVec3 eye, bool central,
                        CagPlane *out) {
  double a[4][4], row[4], size = 0;
  CagError none;
  const CagVec3 from = central ? eye : direction;
  cag_quadric_rows(q, a);
  for (int i = 0; i < 4; i++) {
    row[i] = a[i][0] * from.x + a[i][1] * from.y + a[i][2] * from.z + (central ? a[i][3] : 0);
  }
  for (int i = 0; i < 9; i++) size = fmax(size, fabs(a[i / 3][i % 3]));
  const double length = cag_norm(cag_vec3(row[0], row[1], row[2]));
  return length > ALONG_AXIS * size && !cag_plane_from_row(row, out, &none);
}

CagStatus cag_surface_contour(const CagSurface *s, CagVec3 direction, CagVec3 eye, bool central,
                              double tolerance, CagCurveList *out, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  // A flat face has no contour.
  if (cag_surface_planar_view(s, &region, &frame)) return CAG_OK;
  CagQuadric q;
  CagPlane plane;
  if (cag_surface_quadric_view(s, &q) && polar_plane(&q, direction, eye, central, &plane))
    return cag_surface_section(s, &plane, tolerance, out, err);
  CagLevel level = cag_level_contour(direction, eye, central);
  return cag_surface_level_curves(s, &level, tolerance, out, NULL, err);
}

CagStatus cag_surface_level_curves(const CagSurface *s, const CagLevel *level, double tolerance,
                                   CagCurveList *out, bool *everywhere, CagError *err) {
  CagBounds box;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  double size = size_of(&box);
  size_t first = out->count;
  if (!(tolerance > 0)) tolerance = DEFAULT_TOLERANCE * size;
  status = trace_all(s, level, NULL, tolerance, size, out, everywhere, err);
  return status ? status : cag_curve_list_join(out, first, MEET * size, err);
}
