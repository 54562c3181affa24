// Plane sections and view contours of surfaces as curves.

#ifndef CAG_GEOM_MEET_SECTION_H
#define CAG_GEOM_MEET_SECTION_H

#include "geom/curve/conic.h"
#include "geom/mesh/mesh.h"
#include "geom/solid/solid.h"
#include "geom/surface/quadric_equation.h"

// --- Zero curves of functions on a surface ---

// A function on a surface, defined by the partials at each point.
typedef struct CagLevel {
  int order; // of the partials needed for its gradient, 1 to 3; its value needs one order less
  // d holds the partials of total order n; gradient (with respect to u and v) may be NULL.
  double (*value)(const struct CagLevel *level, const CagVec3 *d, int n, double *gradient);
  CagVec3 point, direction;
  bool central;
  double zero;           // smaller values are rounding errors; 0: estimated from the values
  double constant, unit; // data of other functions
  int which;
  // The function jumps or bends at breaks, so each patch between them has its own values. Where the
  // surface has no normal, including along an edge that is a pole, the value is NaN, and is
  // extrapolated from nearby points.
  bool sided;
} CagLevel;
// Signed distance from a plane.
CagLevel cag_level_plane(const CagPlane *plane, double size);
// 0 where the line of sight lies in the tangent plane: along `direction`, or from `point` if
// `central`.
CagLevel cag_level_contour(CagVec3 direction, CagVec3 point, bool central);

// A part of such a curve without corners: points and unit tangents. `checks` are additional points
// on it, used to verify a guess of its kind.
typedef struct CagTrace {
  size_t count, check_count;
  bool closed; // the last point equals the first
  CagVec3 *points, *tangents, *checks;
} CagTrace;
typedef struct CagTraces {
  CagTrace *items;
  size_t count, capacity;
  bool everywhere; // a sided function is 0, to rounding, on the whole surface
} CagTraces;
void cag_traces_free(CagTraces *t);

// All traces, dense enough that cubics through points and tangents stay within the tolerance. The
// parameter rectangle is searched on a grid, and the grid points with values nearest to 0 are
// followed up, so that loops smaller than a cell are usually found. If the function is 0 on a whole
// patch, the patch has no curves.
CagStatus cag_surface_trace(const CagSurface *s, const CagLevel *level, double tolerance,
                            CagTraces *out, CagError *err);
// A trace as a curve: a line, an arc of a conic if all its points lie on one to rounding, else
// cubics. `quadric`: the conic is the section of this quadric; NULL: the conic is fitted.
CagStatus cag_trace_curve(const CagTrace *t, const CagQuadric *quadric, double size, CagCurve **out,
                          CagError *err);

// --- Sections ---

// A growing list of curves, each with one reference.
typedef struct CagCurveList {
  CagCurve **items;
  size_t count, capacity;
} CagCurveList;
void cag_curve_list_free(CagCurveList *list);
CagStatus cag_curve_list_add(CagCurveList *list, CagCurve *c, CagError *err); // takes over c
// Joins the curves [first, list->count) end to end, where ends are closer than `same`. If more than
// two ends meet, those with the smallest turn are joined.
CagStatus cag_curve_list_join(CagCurveList *list, size_t first, double same, CagError *err);

// Adds sections with a plane to the list. The section of a surface includes touching curves, edges,
// and creases in the plane. The section of a solid is the outline of the part on the negative side
// of the plane, so its curves are closed. If the plane only touches the solid, the section may be
// empty. The tolerance is for curves that are neither lines nor conics; 0 means a millionth of the
// size.
CagStatus cag_surface_section(const CagSurface *s, const CagPlane *plane, double tolerance,
                              CagCurveList *out, CagError *err);
CagStatus cag_solid_section(const CagSolid *s, const CagPlane *plane, double tolerance,
                            CagCurveList *out, CagError *err);
CagStatus cag_mesh_section(const CagMesh *m, const CagPlane *plane, CagCurveList *out,
                           CagError *err);
// The apparent contour of a surface: the points at which the line of sight is tangent to it.
CagStatus cag_surface_contour(const CagSurface *s, CagVec3 direction, CagVec3 eye, bool central,
                              double tolerance, CagCurveList *out, CagError *err);

// The zero curves of a function on the surface, within `tolerance` as for sections. `everywhere`
// may be NULL; see CagTraces.
CagStatus cag_surface_level_curves(const CagSurface *s, const CagLevel *level, double tolerance,
                                   CagCurveList *out, bool *everywhere, CagError *err);

#endif
