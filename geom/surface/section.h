// Plane sections: of quadrics as conics, of everything as curves; contours seen from a direction;
// and what else a quadric's equation tells about one of its points.

#ifndef CAG_GEOM_SURFACE_SECTION_H
#define CAG_GEOM_SURFACE_SECTION_H

#include "geom/curve/conic.h"
#include "geom/mesh/mesh.h"
#include "geom/solid/solid.h"
#include "geom/surface/quadric.h"

CagVec3 cag_quadric_gradient(const CagQuadric *q, CagVec3 p);
// The one center; fails with "quadric-not-central" where there is none, or a line or plane of them.
CagStatus cag_quadric_center(const CagQuadric *q, CagVec3 *out, CagError *err);
// Fails with "point-not-on-surface" and, where the gradient vanishes, "singular-point".
CagStatus cag_quadric_tangent_plane(const CagQuadric *q, CagVec3 p, CagPlane *out, CagError *err);
// Straight lines of the surface through one of its points: unit directions. `all`: every direction
// of the tangent plane is one. Fails as the tangent plane does.
typedef struct CagRulings {
  size_t count;
  bool all;
  CagVec3 direction[2];
} CagRulings;
CagStatus cag_quadric_rulings(const CagQuadric *q, CagVec3 p, CagRulings *out, CagError *err);
// The conic in the plane through the frame's origin along its x and y axes, in these coordinates.
void cag_quadric_section(const CagQuadric *q, const CagTransform *frame, CagConic *out);
// A right-handed frame of the plane: its point, and x as near to the world's X (or Y) as may be.
CagTransform cag_plane_frame(const CagPlane *plane);

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
