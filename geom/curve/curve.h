// Curves: immutable, reference counted values of several kinds with a common table of functions.
//
// A curve maps its domain [start, end] to points of the plane (dimension 2: z is 0) or of space
// (3). Points are always CagVec3. The parameter is natural (knots, radians, ...); if `angular` is
// set, the language shows it as an angle. Derivatives are with respect to the parameter. Algorithms
// for all kinds (tangent, curvature, length, bounds, closest point, ...) use only the functions of
// CagCurveKind. The data of a kind follow the header: struct { CagCurve base; ... }.

#ifndef CAG_GEOM_CURVE_H
#define CAG_GEOM_CURVE_H

#include "base/status.h"
#include "geom/linalg/transform.h"
#include "geom/linalg/vec.h"

typedef struct CagCurve CagCurve;

// The one-sided limit to take where the curve is not smooth: at a knot or a corner.
typedef enum CagSide { CAG_SIDE_RIGHT, CAG_SIDE_LEFT } CagSide;

// Highest derivative that callers may request.
#define CAG_MAX_DERIVATIVE 16

// The part of a curve between the parameters `from` and `to`, which is backwards if from > to. At
// the parameter t in [start, end], it is at the affine image of t, which maps start to `from` and
// end to `to`.
typedef struct CagCurvePart {
  double from, to;
  double start, end;
} CagCurvePart;

typedef struct CagCurveKind {
  const char *name; // "line", "polyline", "arc", "helix", "bezier", "bspline", "nurbs" ...
  // Point and derivatives 1..order at t (in the domain), as the limit from `side`: out[0..order].
  CagStatus (*eval)(const CagCurve *c, double t, int order, CagSide side, CagVec3 *out,
                    CagError *err);
  // The same for n parameters in any order: out[i * (order + 1) + k]. NULL: eval is called for
  // each.
  CagStatus (*eval_many)(const CagCurve *c, const double *t, size_t n, int order, CagVec3 *out,
                         CagError *err);
  // Exact rational form; NULL if there is none.
  CagStatus (*to_nurbs)(const CagCurve *c, CagCurve **out, CagError *err);
  // Image under a transform; a kind that is not closed under it returns another kind.
  CagStatus (*transform)(const CagCurve *c, const CagTransform *t, CagCurve **out, CagError *err);
  // A part of the curve, over its own domain and possibly backwards.
  CagStatus (*part)(const CagCurve *c, const CagCurvePart *p, CagCurve **out, CagError *err);
  // A box that contains the curve over [a, b], cheap and not always tight (hull of control points).
  CagBounds (*hull)(const CagCurve *c, double a, double b);
  // Interior parameters at which the curve is not C-infinity (distinct, ascending). Returns their
  // number, writes up to `capacity`.
  size_t (*breaks)(const CagCurve *c, double *out, size_t capacity);
  // A one-line description for the language, without kind and domain: "degree 3, 5 points".
  // NUL-terminated.
  void (*describe)(const CagCurve *c, char *buffer, size_t size);
  void (*destroy)(
      CagCurve *c); // frees the data of the kind; cag_curve_release frees the block itself
  // Adds what the curve was made of, apart from its kind, dimension, and domain.
  void (*digest)(const CagCurve *c, CagDigest *d);
} CagCurveKind;

struct CagCurve {
  const CagCurveKind *kind;
  int references;    // a curve belongs to one thread, or is shared read-only
  int dimension;     // 2 or 3
  double start, end; // domain; start < end, except that a point may have start == end
  bool angular;      // the parameter is an angle
  bool closed;       // the ends coincide (to rounding), determined at construction
};

CagCurve *cag_curve_retain(const CagCurve *c);
void cag_curve_release(CagCurve *c); // c may be NULL
// Adds everything that the curve depends on to a digest: curves with equal digests are the same.
void cag_curve_digest(const CagCurve *c, CagDigest *d);

// Whether the header of a curve is valid: kind, references, dimension, and domain. For CAG_ASSERT
// and tests; surfaces, meshes, and solids have the same.
bool cag_check_curve(const CagCurve *c);

// --- Constructors (each fails with a reason and the argument; *out has one reference) ---
CagStatus cag_curve_line(CagVec3 p, CagVec3 q, int dimension, CagCurve **out, CagError *err);
CagStatus cag_curve_polyline(const CagVec3 *points, size_t n, bool closed, int dimension,
                             CagCurve **out, CagError *err);
// Kind "point": one point over [start, end], start <= end. No tangent, length 0, never closed.
CagStatus cag_curve_resting(CagVec3 p, int dimension, double start, double end, bool angular,
                            CagCurve **out, CagError *err);
// Points center + a cos(t) x + b sin(t) y for t in [start, end] radians. Circle: a == b. The
// columns of frame are x, y, and center (planar: dimension 2).
CagStatus cag_curve_arc(double a, double b, double start, double end, const CagTransform *frame,
                        CagCurve **out, CagError *err);
// [r cos t, r sin t, pitch t / 2 pi], r = radius + taper * t / 2 pi; t in 0..2 pi |turns|; negative
// turns are left-handed.
CagStatus cag_curve_helix(double radius, double pitch, double turns, double taper, CagCurve **out,
                          CagError *err);
// Kind "bezier": domain 0..1; weights NULL: polynomial.
CagStatus cag_curve_bezier(const CagVec3 *points, const double *weights, size_t n, int dimension,
                           CagCurve **out, CagError *err);
// Kind "bspline" (weights NULL) or "nurbs". knots: n + degree + 1 numbers; domain
// knots[degree]..knots[n].
CagStatus cag_curve_nurbs(const CagVec3 *points, const double *weights, size_t n, int degree,
                          const double *knots, int dimension, CagCurve **out, CagError *err);
// Closed periodic B-spline of n distinct points: uniform knots, domain 0..n; `points` returns the
// n.
CagStatus cag_curve_nurbs_closed(const CagVec3 *points, const double *weights, size_t n, int degree,
                                 int dimension, CagCurve **out, CagError *err);
// Joins curves, each starting where the previous one ends. The domain is 0..(sum of the domains'
// lengths), or natural if alike.
CagStatus cag_curve_join(CagCurve *const *curves, size_t n, CagCurve **out, CagError *err);

// Knot vectors of n control points: "open" uniform integers 0,0,..,1,..,m,m; "periodic" 0,1,2,...;
// "chord" from the points (Hartley and Judd 1978).
CagStatus cag_knots_make(const char *type, size_t n, int degree, const CagVec3 *points,
                         double *knots, CagError *err);

// --- Access to the data of NURBS kinds (bezier, bspline, nurbs) ---
typedef struct CagNurbsView {
  int degree;
  size_t count;              // control points as stored (a closed one repeats its first `degree`)
  size_t distinct;           // control points as given
  bool periodic;             // made by cag_curve_nurbs_closed
  const double *knots;       // count + degree + 1
  const double *homogeneous; // count x 4: w x, w y, w z, w
  bool rational;
} CagNurbsView;
bool cag_curve_nurbs_view(const CagCurve *c, CagNurbsView *out); // false: not a NURBS kind
// Vertices of a line or polyline (without the repeated first one of a closed polyline); false:
// another kind.
bool cag_curve_vertices(const CagCurve *c, const CagVec3 **points, size_t *n, bool *closed);
bool cag_curve_resting_view(const CagCurve *c, CagVec3 *p); // p may be NULL; false: not a point
// Data of an arc kind.
bool cag_curve_arc_view(const CagCurve *c, double *a, double *b, CagTransform *frame);
bool cag_curve_helix_view(const CagCurve *c, double *radius, double *pitch, double *turns,
                          double *taper, CagTransform *frame);

// --- Queries of any curve. t outside the domain fails with CAG_E_DOMAIN "parameter-range"; a few
// ulp outside is snapped to the end. ---
CagStatus cag_curve_eval(const CagCurve *c, double t, int order, CagSide side, CagVec3 *out,
                         CagError *err);
CagStatus cag_curve_eval_many(const CagCurve *c, const double *t, size_t n, int order, CagVec3 *out,
                              CagError *err);
CagStatus cag_curve_point(const CagCurve *c, double t, CagVec3 *out, CagError *err);

typedef struct CagFrenet {
  CagVec3 point, tangent, normal, binormal;
  double curvature, torsion;
  bool has_normal; // false if the curvature is 0 (normal and binormal are then zero vectors)
} CagFrenet;
CagStatus cag_curve_frenet(const CagCurve *c, double t, CagFrenet *out, CagError *err);
CagStatus cag_curve_tangent(const CagCurve *c, double t, CagSide side, CagVec3 *out,
                            CagError *err); // the limit where C' = 0

// Arc length over [a, b] to 1e-10 relative (adaptive Gauss-Kronrod on the smooth pieces); the
// parameter at arc length s from the start.
CagStatus cag_curve_length(const CagCurve *c, double a, double b, double *out, CagError *err);
CagStatus cag_curve_parameter_at_length(const CagCurve *c, double s, double *out, CagError *err);
CagStatus cag_curve_bounds(const CagCurve *c, CagBounds *out,
                           CagError *err); // tight to 1e-9 of its size
// Signed area (counter-clockwise positive) and centroid of a closed plane curve, by Green's
// theorem, 1e-10 relative.
CagStatus cag_curve_area(const CagCurve *c, double *area, CagVec3 *centroid, CagError *err);
// Whether the curve lies in a plane or on a line, within 1e-9 of its size. plane may be NULL.
CagStatus cag_curve_is_planar(const CagCurve *c, bool *is, CagPlane *plane, CagError *err);
CagStatus cag_curve_is_straight(const CagCurve *c, bool *is, CagError *err);
CagStatus cag_curve_to_nurbs(const CagCurve *c, CagCurve **out,
                             CagError *err); // fails with "no-exact-form" if there is none
CagStatus cag_curve_transform(const CagCurve *c, const CagTransform *t, CagCurve **out,
                              CagError *err);
CagStatus cag_curve_reverse(const CagCurve *c, CagCurve **out, CagError *err);
// The part over [a, b]; for a closed curve the range may cross the seam, and cover at most one
// turn.
CagStatus cag_curve_trim(const CagCurve *c, double a, double b, CagCurve **out, CagError *err);
// The parts before and after t, which may be anywhere in the domain: a part of zero length is a
// point over [t, t].
CagStatus cag_curve_halves(const CagCurve *c, double t, CagCurve *out[2], CagError *err);
CagStatus cag_curve_reparametrize(const CagCurve *c, double a, double b, CagCurve **out,
                                  CagError *err);
// The same, with a range of angles (radians) or of numbers.
CagStatus cag_curve_reparametrize_as(const CagCurve *c, double a, double b, bool angular,
                                     CagCurve **out, CagError *err);
// The curve without the stretches on which it rests at one point, for sweeping along it. The domain
// stays the same. A curve that is a single point is returned unchanged.
CagStatus cag_curve_without_stops(const CagCurve *c, CagCurve **out, CagError *err);
// Turns a space curve that lies in z = 0, up to rounding, into a plane curve, in place. There must
// be no other reference to it.
void cag_curve_lay_flat(CagCurve *c);
// The curve's image in the plane of the frame's x and y axes, in these coordinates: a plane curve.
CagStatus cag_curve_flatten(const CagCurve *c, const CagTransform *frame, CagCurve **out,
                            CagError *err);
// The curve as a space curve (dimension 3).
CagStatus cag_curve_to_space(const CagCurve *c, CagCurve **out, CagError *err);

// Parameters of a polyline that stays within `tolerance` of the curve and turns by at most `angle`
// (radians) per step; both ends and all breaks are included. *out is malloc'd.
CagStatus cag_curve_discretize(const CagCurve *c, double tolerance, double angle, double **out,
                               size_t *n, CagError *err);
// The same, but steps up to the length `short_edge` may turn farther.
CagStatus cag_curve_discretize_short(const CagCurve *c, double tolerance, double angle,
                                     double short_edge, double **out, size_t *n, CagError *err);
// The closest point of the curve (the global minimum). Intersections and others have their own
// headers.
CagStatus cag_curve_closest(const CagCurve *c, CagVec3 p, double *t, CagVec3 *point,
                            double *distance, CagError *err);

#endif
