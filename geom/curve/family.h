// Shared by the implementations of the kinds of curves; not for users of curves.

#ifndef CAG_GEOM_CURVE_FAMILY_H
#define CAG_GEOM_CURVE_FAMILY_H

#include "geom/curve/curve.h"
#include "geom/linalg/tolerance.h"

// Points closer than this fraction of the size of the data are identical: the rounding of a few
// evaluations.
#define CAG_CURVE_SAME CAG_ROUNDING

// Zeroed block of `size` bytes (a struct that starts with CagCurve) with one reference.
CagStatus cag_curve_block(size_t size, const CagCurveKind *kind, int dimension, double start,
                          double end, CagCurve **out, CagError *err);
// Fails with "not-finite" and the index.
CagStatus cag_curve_check_points(const CagVec3 *points, size_t n, const char *name, CagError *err);
CagStatus cag_curve_check_number(double x, const char *name, CagError *err);
// Magnitude of the largest coordinate of the points, to which rounding is relative.
double cag_curve_size(const CagVec3 *points, size_t n);
// Bound of the rounding of coordinates in the box. Distances are not known better than this,
// however small the curve is compared to its distance from the origin.
double cag_curve_noise(const CagBounds *box);
// 2 if a plane curve stays a plane curve under t.
int cag_curve_image_dimension(const CagCurve *c, const CagTransform *t);
// Image via the exact NURBS form, for maps that a kind is not closed under.
CagStatus cag_curve_transform_nurbs(const CagCurve *c, const CagTransform *t, CagCurve **out,
                                    CagError *err);
// The affine map of parameters from [c->start, c->end] to [a, b], exact at the ends.
double cag_curve_remap(const CagCurve *c, double t, double a, double b);
// How fast the parameter of the curve changes with that of its part; negative: backwards.
static inline double cag_part_rate(const CagCurvePart *p) {
  return p->start < p->end ? (p->to - p->from) / (p->end - p->start) : 1;
}
// The parameter of the curve at which the part's parameter would be 0.
static inline double cag_part_origin(const CagCurvePart *p) {
  return p->from - cag_part_rate(p) * p->start;
}
// The part's parameter at the curve's parameter t; exact at the ends, and if only the range changes.
double cag_part_parameter(const CagCurvePart *p, double t);
// The part as the kind makes it, with the unit of its parameter; for ranges that were checked.
CagStatus cag_curve_part(const CagCurve *c, const CagCurvePart *p, CagCurve **out, CagError *err);
// Bound of the distance of the curve over [a, b], where it must be smooth, from the chord between
// its ends. Proportional to the square of b - a in the limit.
double cag_curve_sag(const CagCurve *c, double a, double b);
// Control points of the cubic with the points and derivatives of the curve at a and b. Returns
// false if points in between are off the curve by more than a fraction of its sag, or if an
// evaluation fails.
bool cag_curve_chord_cubic(const CagCurve *c, double a, double b, CagVec3 *q);
// Interior breaks and both ends, malloc'd, ascending: *n values.
CagStatus cag_curve_cuts(const CagCurve *c, double **out, size_t *n, CagError *err);
// Linear from points[i] at t[i] to the next; t ascends strictly.
CagStatus cag_curve_polyline_over(const CagVec3 *points, const double *t, size_t n, int dimension,
                                  CagCurve **out, CagError *err);
// cag_curve_trim for [a, b], a < b <= a + period, of a closed curve, at any multiple of the period.
CagStatus cag_curve_trim_over_seam(const CagCurve *c, double a, double b, CagCurve **out,
                                   CagError *err);
// Axes of an arc kind: center + cos(angle) x + sin(angle) y, d angle / dt = rate.
bool cag_curve_arc_axes(const CagCurve *c, CagVec3 *center, CagVec3 *x, CagVec3 *y, double *rate);
// An arc or a helix: center + r(angle) (cos(angle) x + sin(angle) y) + climb angle z, where angle
// is phase + rate t and r(angle) is radius + growth angle.
typedef struct CagCoil {
  CagVec3 center, x, y, z;
  double radius, growth, climb, phase, rate;
} CagCoil;
bool cag_curve_coil(const CagCurve *c, CagCoil *out); // false: another kind
// The same, for arcs only.
bool cag_curve_arc_coil(const CagCurve *c, CagCoil *out);
// Bound of |C''| over [a, b]; false: not a helix.
bool cag_curve_helix_bend(const CagCurve *c, double a, double b, double *out);
// Largest factor by which x u + y v lengthens the unit vector (u, v).
double cag_curve_stretch(CagVec3 x, CagVec3 y);
// The piece of a composite curve over [a, b] (within one piece), with its own parameters, which run
// `rate` times as fast; NULL: not a composite curve.
const CagCurve *cag_curve_composite_piece(const CagCurve *c, double a, double b, double *local_a,
                                          double *local_b, double *rate);
// A box that contains the curve over [a, b], for curves known only by points: the box of samples,
// enlarged in each direction by the largest second difference there. A smooth curve leaves its
// chord by an eighth of that; a corner between two samples hides at most half of the difference
// that it causes. Returns false if some points cannot be evaluated; these are left out.
bool cag_curve_sampled_hull(const CagCurve *c, double a, double b, CagBounds *out);
// Points with the same hull, plane, and line as the curve (control points if it has them, else
// samples); malloc'd.
CagStatus cag_curve_gather(const CagCurve *c, CagVec3 **out, size_t *n, CagError *err);

#endif
