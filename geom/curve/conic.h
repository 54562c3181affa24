// Conics: parabolas and hyperbolas as curves, the general equation, and classical constructions
// from points and tangents.
//
// The general conic is A x^2 + B xy + C y^2 + D x + E y + F = 0 without factors of 2. Angles are
// radians. Everything here lies in the plane unless a frame is given.

#ifndef CAG_GEOM_CONIC_H
#define CAG_GEOM_CONIC_H

#include "geom/curve/curve.h"

// --- Parabolas and hyperbolas as curves ---

// The parametrization of a curve. In the frame's plane the point is
typedef enum CagConicForm {
  CAG_FORM_QUADRATIC,  // parabola    (a t^2, 2 a t)
  CAG_FORM_TANGENT,    // parabola    (tan^2 t, 2 sqrt(a) tan t), t an angle
  CAG_FORM_HYPERBOLIC, // hyperbola   (a cosh t, b sinh t)
  CAG_FORM_SECANT      // hyperbola   (a sec t, b tan t), t an angle; |t| > pi/2: the left branch
} CagConicForm;

// y^2 = 4 a x in the frame. Form: quadratic or tangent; the range of a tangent form must not
// contain a pole ("domain").
CagStatus cag_curve_parabola(double a, CagConicForm form, double start, double end,
                             const CagTransform *frame, CagCurve **out, CagError *err);
// x^2/a^2 - y^2/b^2 = 1 in the frame. Form: hyperbolic or secant.
CagStatus cag_curve_hyperbola(double a, double b, CagConicForm form, double start, double end,
                              const CagTransform *frame, CagCurve **out, CagError *err);

// A parabola or hyperbola by its parameter angle = phase + rate t. With s, r the two functions of
// the form for a = b = 1, the point is center + r x + s y (quadratic: angle^2 x + angle y).
typedef struct CagOpenConic {
  CagConicForm form;
  CagVec3 center, x, y;
  double phase, rate;
} CagOpenConic;
bool cag_curve_open_conic(const CagCurve *c, CagOpenConic *out); // false: another kind

// n points at equal steps of the parameter, by recurrences for circles, ellipses, parabolas, and
// hyperbolas. Both ends are included and exact. Fails with "not-a-conic".
CagStatus cag_conic_points(const CagCurve *c, size_t n, CagVec3 *out, CagError *err);

// --- The general conic ---

typedef struct CagConic {
  double c[6]; // A B C D E F
} CagConic;

typedef struct CagConicClass {
  // "ellipse" "circle" "hyperbola" "parabola" "point" "intersecting_lines" "parallel_lines"
  // "double_line" "line" "plane" "empty"
  const char *name;
  double discriminant; // B^2 - 4 A C
  bool has_center;     // there is a single center: ellipse, hyperbola, point, intersecting lines,
                       // and ellipses without real points
  CagVec3 center;      // for a parabola its vertex
  double angle; // of the major or real axis, in (-pi/2, pi/2]; for a parabola of the direction in
                // which it opens, in (-pi, pi]
  double a, b;  // semi-axes (ellipse: a >= b; hyperbola: a is real); for a parabola a = p, y^2 = 4
                // p x
  double eccentricity; // for an ellipse, hyperbola, or parabola
  size_t focus_count;
  CagVec3 foci[2];
  size_t line_count;  // number of lines that the conic consists of
  double lines[2][3]; // p x + q y + r = 0, p^2 + q^2 = 1, the first nonzero one of p, q is positive
  double book_angle;  // in [-pi/4, pi/4]; rotation by it removes the xy term
  double rotated[6];  // coefficients in the axes rotated by book_angle
  double standard[3]; // alpha x^2 + beta y^2 = kappa about the center; if has_center
} CagConicClass;

// Fails with "not-finite" and the index.
CagStatus cag_conic_check(const CagConic *c, CagError *err);
CagStatus cag_conic_classify(const CagConic *c, CagConicClass *out, CagError *err);
double cag_conic_value(const CagConic *c, CagVec3 p);
// The polar line p x + q y + r = 0 of the point p; the tangent if p lies on the conic.
void cag_conic_polar(const CagConic *c, CagVec3 p, double line[3]);
// The equation of the image under a planar transform, which may be projective.
CagStatus cag_conic_transform(const CagConic *c, const CagTransform *t, CagConic *out,
                              CagError *err);
// The real branches as curves. Hyperbolas, parabolas, and lines are limited to the parameters
// [from, to] (lines: millimeters from the point nearest to their common center). At most 2; each
// has one reference.
CagStatus cag_conic_branches(const CagConic *c, double from, double to, CagCurve *out[2], size_t *n,
                             CagError *err);
// The equation of a circle, ellipse, parabola, or hyperbola, their arcs, or a plane Bezier curve of
// degree 2. Fails with "not-a-conic".
CagStatus cag_conic_of_curve(const CagCurve *c, CagConic *out, CagError *err);
// The same for a plane curve in space, in coordinates of its plane: `frame` maps them to space.
CagStatus cag_conic_of_space_curve(const CagCurve *c, CagTransform *frame, CagConic *out,
                                   CagError *err);
// The point at x with the smaller or larger y. Fails with "domain".
CagStatus cag_conic_point_at(const CagConic *c, double x, bool upper, CagVec3 *out, CagError *err);
// The arc over x in [from, to] (reversed if from > to) on the branch with the smaller or larger y.
// Fails with "domain".
CagStatus cag_conic_segment(const CagConic *c, double from, double to, bool upper, CagCurve **out,
                            CagError *err);

typedef enum CagLineConic {
  CAG_LINE_NONE,
  CAG_LINE_ONE, // the line is parallel to an asymptote or to a parabola's axis
  CAG_LINE_TANGENT,
  CAG_LINE_TWO,
  CAG_LINE_WITHIN // the line is part of the conic
} CagLineConic;
// Intersections of the line through p along d with the conic: p + t[i] d, ascending by t.
CagStatus cag_conic_line(const CagConic *c, CagVec3 p, CagVec3 d, CagLineConic *kind, double t[2],
                         CagError *err);

// The family of equations to choose from: general, without xy term, circles, or lines.
typedef enum CagConicShape {
  CAG_CONIC_GENERAL, // 5 conditions
  CAG_CONIC_AXIS,    // 4
  CAG_CONIC_CIRCLE,  // 3
  CAG_CONIC_LINE     // 2
} CagConicShape;
typedef struct CagConicTangent {
  CagVec3 point, direction;
} CagConicTangent;
// The conic through the points and tangents. It passes through each tangent's point in the
// tangent's direction, whether or not the point is also listed in `points`. Fails with
// "too-few-conditions", "conditions-dependent", "conditions-contradict". Scaled to C = 1, or if C
// vanishes, to a first nonzero coefficient of 1.
CagStatus cag_conic_from_conditions(const CagVec3 *points, size_t n,
                                    const CagConicTangent *tangents, size_t m, CagConicShape shape,
                                    CagConic *out, CagError *err);

// A conic as a curve. If it has a single real branch (ellipse, circle; parabola and line over [-2,
// 2]) the curve is that branch; otherwise every operation other than transforming it fails with
// "no-single-curve".
CagStatus cag_curve_conic(const CagConic *conic, CagCurve **out, CagError *err);
bool cag_curve_conic_view(const CagCurve *c, CagConic *out);
// The single branch of such a curve (borrowed); NULL if there is none, or if the curve is of
// another kind.
const CagCurve *cag_curve_conic_branch(const CagCurve *c);

// The arc from p to q with the end tangents p-apex and apex-q (plane or space), kind "bezier".
// weight > 0: 1 is a parabola, less an ellipse, more a hyperbola; rho = weight / (1 + weight).
CagStatus cag_conic_arc(CagVec3 p, CagVec3 apex, CagVec3 q, double weight, int dimension,
                        CagCurve **out, CagError *err);
// The weight for which the arc passes through a point inside the triangle. Fails with
// "shoulder-outside".
CagStatus cag_conic_shoulder_weight(CagVec3 p, CagVec3 apex, CagVec3 q, CagVec3 shoulder,
                                    double *weight, CagError *err);

#endif
