// Plane sections as curves, and contours seen from a direction.

#ifndef CAG_GEOM_MEET_SECTION_H
#define CAG_GEOM_MEET_SECTION_H

#include "geom/curve/conic.h"
#include "geom/mesh/mesh.h"
#include "geom/solid/solid.h"
#include "geom/surface/quadric_equation.h"

// --- Curves on which a function of the surface is 0 ---

// A function of a place of the surface, from the partials there.
typedef struct CagLevel {
  int order; // of the partials that its gradient needs, 1 to 3; its value needs one order less
  // d holds the partials of total order n; gradient (by u and v) is wanted where it is not NULL.
  double (*value)(const struct CagLevel *level, const CagVec3 *d, int n, double *gradient);
  CagVec3 point, direction;
  bool central;
  double zero;           // values below are rounding; 0: found by the values
  double constant, unit; // what further functions need
  int which;
  // The function jumps or bends at breaks, so that each patch between them has its own values, and
  // is not a number where the surface has no normal, also along an edge that is a pole: there it is
  // continued from beside.
  bool sided;
} CagLevel;
// Distance from a plane.
CagLevel cag_level_plane(const CagPlane *plane, double size);
// 0 where the line of sight lies in the tangent plane: along `direction`, or from `point` where
// `central`.
CagLevel cag_level_contour(CagVec3 direction, CagVec3 point, bool central);

// One run of such a curve without corners: points and unit tangents. `checks` are further points of
// it, by which a guess of its kind is tried.
typedef struct CagTrace {
  size_t count, check_count;
  bool closed; // the last point is the first
  CagVec3 *points, *tangents, *checks;
} CagTrace;
typedef struct CagTraces {
  CagTrace *items;
  size_t count, capacity;
  bool everywhere; // a sided function is 0, to rounding, on all of the surface
} CagTraces;
void cag_traces_free(CagTraces *t);

// All runs, dense enough that cubics through points and tangents stay within the tolerance. The
// parameter rectangle is searched on a grid whose places nearest to 0 are followed up, so that
// loops smaller than its cells are found as a rule. Where the function is 0 over a whole patch it
// has no curves.
CagStatus cag_surface_trace(const CagSurface *s, const CagLevel *level, double tolerance,
                            CagTraces *out, CagError *err);
// A run as a curve: a line, an arc of a conic where all its points lie on one to rounding, else
// cubics. `quadric`: its conic is the section of this quadric; NULL: it is found.
CagStatus cag_trace_curve(const CagTrace *t, const CagQuadric *quadric, double size, CagCurve **out,
                          CagError *err);

// --- Sections ---

// A growing list of curves, each with one reference.
typedef struct CagCurveList {
  CagCurve **items;
  size_t count, capacity;
} CagCurveList;
void cag_curve_list_free(CagCurveList *list);
CagStatus cag_curve_list_add(CagCurveList *list, CagCurve *c, CagError *err); // takes c over
// Joins the curves [first, list->count) end to end, where ends are closer than `same`. If more than
// two ends meet, those with the smallest turn are joined.
CagStatus cag_curve_list_join(CagCurveList *list, size_t first, double same, CagError *err);

// Adds sections with a plane to the list. The section of a surface includes touching curves, edges,
// and creases in the plane. The section of a solid is the outline of the part on the negative side
// of the plane, so its curves are closed; a plane that only touches the solid may give none. The
// tolerance is for curves that are neither lines nor conics; 0 means a millionth of the size.
CagStatus cag_surface_section(const CagSurface *s, const CagPlane *plane, double tolerance,
                              CagCurveList *out, CagError *err);
CagStatus cag_solid_section(const CagSolid *s, const CagPlane *plane, double tolerance,
                            CagCurveList *out, CagError *err);
CagStatus cag_mesh_section(const CagMesh *m, const CagPlane *plane, CagCurveList *out,
                           CagError *err);
// The outline of a surface: where the line of sight touches it.
CagStatus cag_surface_contour(const CagSurface *s, CagVec3 direction, CagVec3 eye, bool central,
                              double tolerance, CagCurveList *out, CagError *err);

// The curves on which a function of the surface is 0, at `tolerance` as of sections. `everywhere`,
// where it is not NULL, is that of the traces.
CagStatus cag_surface_level_curves(const CagSurface *s, const CagLevel *level, double tolerance,
                                   CagCurveList *out, bool *everywhere, CagError *err);

#endif
