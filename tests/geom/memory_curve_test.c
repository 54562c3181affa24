// Tests curves of every kind with exhausted memory, with failing functions of the caller, and with
// interrupted work. Each fault is reported, and nothing leaks.

#include <stdio.h>

#include "faults.h"
#include "geom/curve/approximate.h"
#include "geom/curve/circles.h"
#include "geom/curve/conic.h"
#include "geom/curve/cubic.h"
#include "geom/curve/curve.h"
#include "geom/curve/family.h"
#include "geom/curve/fit.h"
#include "geom/curve/frenet.h"
#include "geom/curve/function.h"
#include "geom/curve/intersect.h"
#include "geom/curve/joint.h"
#include "geom/curve/natural.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/surface/curve_on.h"

static const CagVec3 zigzag[6] = {{0, 1, 0}, {1, 2, 0}, {2.5, 0, 0},
                                  {4, 2, 0}, {5, 0, 0}, {6, 3, 0}};
static const CagVec3 in_space[6] = {{0, 1, 0},  {1, 2, 1}, {2.5, 0, 0.5},
                                    {4, 2, -1}, {5, 0, 0}, {6, 3, 1}};
static const double weights[6] = {1, 2, 0.5, 3, 1, 1.5};
static const double uneven[10] = {0, 0, 0, 0, 0.3, 0.3, 1, 1, 1, 1};

// C(t) = [t, sin t, 0].
static CagStatus wave_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)context;
  const CagStatus status = fault_in_call(e);
  if (status) return status;
  for (int k = 0; k <= order; k++) out[k] = cag_vec3(k == 0 ? t : k == 1, sin(t + k * M_PI / 2), 0);
  return CAG_OK;
}
// Curvature 1 + s, torsion 1/2.
static CagStatus spiral_eval(void *context, double s, int order, double *curvature, double *torsion,
                             CagError *e) {
  (void)context;
  const CagStatus status = fault_in_call(e);
  if (status) return status;
  for (int k = 0; k <= order; k++) {
    curvature[k] = k == 0 ? 1 + s : k == 1;
    if (torsion) torsion[k] = k == 0 ? 0.5 : 0;
  }
  return CAG_OK;
}
static void release_nothing(void *context) { (void)context; }

static CagStatus make_wave(CagCurve **out, CagError *e) {
  const CagCurveFunction f = {.eval = wave_eval, .release = release_nothing, .context = NULL};
  return cag_curve_function(&f, 2, 0, 5, false, out, e);
}

// The kinds of curves, each with the function that makes it.
#define MAKER(name) static CagStatus name(CagCurve **out, CagError *e)
MAKER(line) { return cag_curve_line(zigzag[0], zigzag[3], 2, out, e); }
MAKER(polyline) { return cag_curve_polyline(zigzag, 6, false, 2, out, e); }
MAKER(triangle) { return cag_curve_polyline(zigzag, 3, true, 2, out, e); }
MAKER(arc) {
  const CagTransform frame = cag_transform_identity();
  return cag_curve_arc(3, 3, 0.2, 2.5, &frame, out, e);
}
MAKER(circle) {
  const CagTransform frame = cag_transform_identity();
  return cag_curve_arc(3, 3, 0, 2 * M_PI, &frame, out, e);
}
MAKER(ellipse) {
  CagTransform frame = cag_rpy(0.3, 0.2, 0.1);
  return cag_curve_arc(4, 2, 0, 2 * M_PI, &frame, out, e);
}
MAKER(helix) { return cag_curve_helix(2, 3, 1.5, 0.1, out, e); }
MAKER(bezier) { return cag_curve_bezier(zigzag, NULL, 5, 2, out, e); }
MAKER(rational) { return cag_curve_bezier(in_space, weights, 5, 3, out, e); }
MAKER(bspline) { return cag_curve_nurbs(zigzag, NULL, 6, 3, uneven, 2, out, e); }
MAKER(nurbs) { return cag_curve_nurbs(in_space, weights, 6, 3, uneven, 3, out, e); }
MAKER(periodic) { return cag_curve_nurbs_closed(zigzag, NULL, 6, 3, 2, out, e); }
MAKER(parabola) {
  const CagTransform frame = cag_transform_identity();
  return cag_curve_parabola(0.5, CAG_FORM_QUADRATIC, -1, 2, &frame, out, e);
}
MAKER(parabola_by_angle) {
  const CagTransform frame = cag_transform_identity();
  return cag_curve_parabola(0.5, CAG_FORM_TANGENT, -0.5, 1, &frame, out, e);
}
MAKER(hyperbola) {
  const CagTransform frame = cag_transform_identity();
  return cag_curve_hyperbola(2, 1, CAG_FORM_HYPERBOLIC, -1, 1.5, &frame, out, e);
}
MAKER(hyperbola_by_angle) {
  const CagTransform frame = cag_transform_identity();
  return cag_curve_hyperbola(2, 1, CAG_FORM_SECANT, -1, 1, &frame, out, e);
}
MAKER(conic) { return cag_curve_conic(&(CagConic){{1, 0.5, 2, 1, -1, -5}}, out, e); }
MAKER(conic_arc) { return cag_conic_arc(zigzag[0], zigzag[1], zigzag[2], 0.7, 2, out, e); }
MAKER(function) { return make_wave(out, e); }
MAKER(resting) { return cag_curve_resting(zigzag[1], 2, 0, 1, false, out, e); }
MAKER(natural) {
  const CagNaturalEquations equations = {spiral_eval, release_nothing, NULL};
  const CagTransform frame = cag_transform_identity();
  return cag_curve_natural(&equations, 1.5, &frame, 3, out, e);
}
MAKER(composite) {
  const CagTransform frame = cag_transform_identity();
  CagCurve *parts[3] = {0};
  CagStatus status = cag_curve_line(cag_vec3(-1, -2, 0), cag_vec3(3, -2, 0), 2, &parts[0], e);
  if (!status) status = cag_curve_line(cag_vec3(3, -2, 0), cag_vec3(3, 0, 0), 2, &parts[1], e);
  if (!status) status = cag_curve_arc(3, 3, 0, 2, &frame, &parts[2], e);
  if (!status) status = cag_curve_join(parts, 3, out, e);
  for (int i = 0; i < 3; i++) cag_curve_release(parts[i]);
  return status;
}
MAKER(projected) {
  CagCurve *c;
  CagTransform t = cag_transform_identity();
  t.planar = false;
  t.m[3][1] = 0.1;
  t.m[3][3] = 2;
  CagStatus status = make_wave(&c, e);
  if (status) return status;
  status = cag_curve_transform(c, &t, out, e);
  cag_curve_release(c);
  return status;
}
MAKER(stopping) { // a wave that first stays at one point
  CagCurve *parts[2] = {0};
  CagStatus status = cag_curve_resting(cag_vec3(0, 0, 0), 2, 0, 1, false, &parts[0], e);
  if (!status) status = make_wave(&parts[1], e);
  if (!status) status = cag_curve_join(parts, 2, out, e);
  for (int i = 0; i < 2; i++) cag_curve_release(parts[i]);
  return status;
}
MAKER(on_torus) {
  CagSurface *s;
  CagCurve *c = NULL;
  CagStatus status = cag_surface_torus(5, 2, &s, e);
  if (status) return status;
  status = cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 2, 0), 2, &c, e);
  if (!status) status = cag_curve_on_surface(s, c, out, e);
  cag_curve_release(c);
  cag_surface_release(s);
  return status;
}

typedef struct Kind {
  const char *name;
  CagStatus (*make)(CagCurve **out, CagError *e);
} Kind;
static const Kind KINDS[] = {
    {"line", line},           {"polyline", polyline},
    {"triangle", triangle},   {"arc", arc},
    {"circle", circle},       {"ellipse", ellipse},
    {"helix", helix},         {"bezier", bezier},
    {"rational", rational},   {"bspline", bspline},
    {"nurbs", nurbs},         {"periodic", periodic},
    {"parabola", parabola},   {"parabola by angle", parabola_by_angle},
    {"hyperbola", hyperbola}, {"hyperbola by angle", hyperbola_by_angle},
    {"conic", conic},         {"conic arc", conic_arc},
    {"function", function},   {"resting", resting},
    {"natural", natural},     {"composite", composite},
    {"projected", projected}, {"stopping", stopping},
    {"on a torus", on_torus},
};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

static double along(const CagCurve *c, double fraction) {
  return c->start + fraction * (c->end - c->start);
}

// Operations on one curve. Each operation releases its result.
#define QUESTION(name) static CagStatus name(const void *given, CagError *e)
#define CURVE const CagCurve *c = given
// Takes the address because the caller evaluates it before the call that makes the curve.
static CagStatus drop(CagStatus status, CagCurve *const *made) {
  if (status) return status;
  const Fault kind = fault.kind;
  fault.kind = FAULT_NONE;
  for (int i = 0; i < 3; i++) {
    CagVec3 p;
    CagError e;
    if (!cag_curve_point(*made, along(*made, 0.45 * i), &p, &e)) fault_found(p.x + p.y + p.z);
  }
  fault.kind = kind;
  cag_curve_release(*made);
  return status;
}

QUESTION(derivatives) {
  CURVE;
  CagVec3 d[9];
  const CagStatus status = cag_curve_eval(c, along(c, 0.3), 8, CAG_SIDE_LEFT, d, e);
  if (!status) fault_found(d[8].y);
  return status;
}
QUESTION(many) {
  CURVE;
  double t[20];
  CagVec3 d[60];
  for (int i = 0; i < 20; i++) t[i] = along(c, i / 19.0);
  const CagStatus status = cag_curve_eval_many(c, t, 20, 2, d, e);
  if (!status) fault_found(d[31].y);
  return status;
}
QUESTION(frenet) {
  CURVE;
  CagFrenet f;
  const CagStatus status = cag_curve_frenet(c, along(c, 0.4), &f, e);
  if (!status) fault_found(f.curvature);
  return status;
}
QUESTION(tangent) {
  CURVE;
  CagVec3 v;
  const CagStatus status = cag_curve_tangent(c, c->start, CAG_SIDE_RIGHT, &v, e);
  if (!status) fault_found(v.x);
  return status;
}
QUESTION(length) {
  CURVE;
  double l;
  const CagStatus status = cag_curve_length(c, c->start, c->end, &l, e);
  if (!status) fault_found(l);
  return status;
}
QUESTION(parameter_at_length) {
  CURVE;
  double l, t;
  CagStatus status = cag_curve_length(c, c->start, along(c, 0.4), &l, e);
  if (!status && !(status = cag_curve_parameter_at_length(c, l, &t, e))) fault_found(t);
  return status;
}
QUESTION(bounds) {
  CURVE;
  CagBounds b;
  const CagStatus status = cag_curve_bounds(c, &b, e);
  if (!status) fault_found(b.max.x + b.min.y);
  return status;
}
QUESTION(area) {
  CURVE;
  double a;
  CagVec3 center;
  const CagStatus status = cag_curve_area(c, &a, &center, e);
  if (!status) fault_found(a);
  return status;
}
QUESTION(is_planar) {
  CURVE;
  bool is;
  const CagStatus status = cag_curve_is_planar(c, &is, NULL, e);
  if (!status) fault_found(is);
  return status;
}
QUESTION(is_straight) {
  CURVE;
  bool is;
  const CagStatus status = cag_curve_is_straight(c, &is, e);
  if (!status) fault_found(is);
  return status;
}
QUESTION(to_nurbs) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_to_nurbs(c, &made, e), &made);
}
QUESTION(moved) {
  CURVE;
  CagCurve *made;
  const CagTransform t = cag_rpy(1, 2, 3);
  return drop(cag_curve_transform(c, &t, &made, e), &made);
}
QUESTION(sheared) {
  CURVE;
  CagCurve *made;
  const CagTransform t = cag_shear(0.5, 0, 0.2, 0, 0.1, 0);
  return drop(cag_curve_transform(c, &t, &made, e), &made);
}
QUESTION(seen_from_a_point) {
  CURVE;
  CagCurve *made;
  CagTransform t = cag_transform_identity();
  t.m[3][0] = 0.01;
  t.m[3][3] = 3;
  return drop(cag_curve_transform(c, &t, &made, e), &made);
}
QUESTION(reverse) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_reverse(c, &made, e), &made);
}
QUESTION(trim) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_trim(c, along(c, 0.2), along(c, 0.7), &made, e), &made);
}
QUESTION(trim_over_seam) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_trim(c, along(c, 0.7), along(c, 1.2), &made, e), &made);
}
QUESTION(halves) {
  CURVE;
  CagCurve *made[2];
  const CagStatus status = cag_curve_halves(c, along(c, 0.6), made, e);
  if (status) return status;
  cag_curve_release(made[0]);
  cag_curve_release(made[1]);
  return CAG_OK;
}
QUESTION(halves_at_the_end) {
  CURVE;
  CagCurve *made[2];
  const CagStatus status = cag_curve_halves(c, c->end, made, e);
  if (status) return status;
  cag_curve_release(made[0]);
  cag_curve_release(made[1]);
  return CAG_OK;
}
QUESTION(reparametrize) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_reparametrize_as(c, 2, 5, !c->angular, &made, e), &made);
}
QUESTION(without_stops) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_without_stops(c, &made, e), &made);
}
QUESTION(flatten) {
  CURVE;
  CagCurve *made;
  const CagTransform frame = cag_rpy(0.1, 0.2, 0.3);
  return drop(cag_curve_flatten(c, &frame, &made, e), &made);
}
QUESTION(to_space) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_to_space(c, &made, e), &made);
}
QUESTION(discretize) {
  CURVE;
  double *t;
  size_t n;
  const CagStatus status = cag_curve_discretize(c, 0.05, 0.5, &t, &n, e);
  if (!status) fault_found((double)n + t[n / 2]);
  if (!status) free(t);
  return status;
}
QUESTION(closest) {
  CURVE;
  double t, distance;
  CagVec3 p;
  const CagStatus status = cag_curve_closest(c, cag_vec3(2, 3, 1), &t, &p, &distance, e);
  if (!status) fault_found(t);
  return status;
}
QUESTION(approximate) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_approximate(c, 1e-2, &made, e), &made);
}
QUESTION(offset) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_offset(c, 0.1, 1e-2, &made, e), &made);
}
QUESTION(offset_to_the_right) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_offset(c, -0.1, 1e-2, &made, e), &made);
}
QUESTION(rounded) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_rounded(c, 0.1, &made, e), &made);
}
QUESTION(tangents_from_point) {
  CURVE;
  CagTangentLine *lines;
  size_t n;
  const CagStatus status = cag_tangents_from_point(c, cag_vec3(9, 1, 0), &lines, &n, e);
  if (!status) fault_found((double)n);
  if (!status) free(lines);
  return status;
}
QUESTION(its_conic) {
  CURVE;
  CagConic q;
  const CagStatus status = cag_conic_of_curve(c, &q, e);
  if (!status) fault_found(q.c[0]);
  return status;
}
QUESTION(its_conic_in_space) {
  CURVE;
  CagConic q;
  CagTransform frame;
  const CagStatus status = cag_conic_of_space_curve(c, &frame, &q, e);
  if (!status) fault_found(q.c[0]);
  return status;
}
QUESTION(conic_points) {
  CURVE;
  CagVec3 p[9];
  return cag_conic_points(c, 9, p, e);
}
QUESTION(coefficients) {
  CURVE;
  CagVec3 *at;
  size_t pieces;
  int degree;
  const CagStatus status = cag_curve_coefficients(c, &at, &pieces, &degree, e);
  if (!status) fault_found((double)pieces);
  if (!status) free(at);
  return status;
}
QUESTION(special_points) {
  CURVE;
  CagSpecialPoints s;
  memset(&s, 0, sizeof s);
  const CagStatus status = cag_curve_special_points(c, &s, e);
  cag_special_points_free(&s);
  return status;
}
QUESTION(contact) {
  CURVE;
  CagPlaneContact contact;
  const CagStatus status = cag_curve_contact(c, along(c, 0.5), cag_vec3(0, 1, 0), &contact, e);
  if (!status) fault_found(contact.c[2]);
  return status;
}
QUESTION(where_it_meets_a_plane) {
  CURVE;
  CagMeeting *at;
  size_t n;
  const CagPlane plane = {{1, 1, 0}, {0, 1, 0}};
  const CagStatus status = cag_curve_intersect_plane(c, &plane, &at, &n, e);
  if (!status) fault_found((double)n);
  if (!status) free(at);
  return status;
}
QUESTION(split) {
  CURVE;
  CagCurve *made[2];
  const CagStatus status = cag_curve_split(c, along(c, 0.6), made, e);
  if (status) return status;
  cag_curve_release(made[0]);
  cag_curve_release(made[1]);
  return CAG_OK;
}
QUESTION(to_bezier) {
  CURVE;
  CagCurve **made;
  size_t n;
  const CagStatus status = cag_curve_to_bezier(c, &made, &n, e);
  if (status) return status;
  for (size_t i = 0; i < n; i++) cag_curve_release(made[i]);
  free(made);
  return CAG_OK;
}
QUESTION(elevate) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_elevate(c, 2, &made, e), &made);
}
QUESTION(insert_knots) {
  CURVE;
  CagCurve *made;
  const double t[2] = {along(c, 0.43), along(c, 0.61)};
  return drop(cag_curve_insert_knots(c, t, 2, &made, e), &made);
}
QUESTION(insert_midpoints) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_insert_midpoints(c, &made, e), &made);
}
QUESTION(clamp) {
  CURVE;
  CagCurve *made;
  return drop(cag_curve_clamp(c, &made, e), &made);
}
QUESTION(remove_knot) {
  CURVE;
  CagCurve *made;
  CagNurbsView view;
  double t = 0.3, deviation;
  if (cag_curve_nurbs_view(c, &view)) t = view.knots[view.degree + 1];
  return drop(cag_curve_remove_knot(c, t, 1, INFINITY, &made, &deviation, e), &made);
}
QUESTION(reduce_degree) {
  CURVE;
  CagCurve *made;
  double deviation;
  return drop(cag_curve_reduce_degree(c, INFINITY, &made, &deviation, e), &made);
}
QUESTION(bezier_join) {
  CURVE;
  CagVec3 p[3];
  return cag_bezier_join(c, 3, 2, 1.5, p, e);
}
QUESTION(gather) {
  CURVE;
  CagVec3 *p;
  size_t n;
  const CagStatus status = cag_curve_gather(c, &p, &n, e);
  if (!status) free(p);
  return status;
}
QUESTION(cuts) {
  CURVE;
  double *t;
  size_t n;
  const CagStatus status = cag_curve_cuts(c, &t, &n, e);
  if (!status) fault_found((double)n + t[n / 2]);
  if (!status) free(t);
  return status;
}

typedef struct Question {
  const char *name;
  FaultyOperation ask;
} Question;
#define ROW(name)                                                                                  \
  { #name, name }
static const Question QUESTIONS[] = {
    ROW(derivatives),
    ROW(many),
    ROW(frenet),
    ROW(tangent),
    ROW(length),
    ROW(parameter_at_length),
    ROW(bounds),
    ROW(area),
    ROW(is_planar),
    ROW(is_straight),
    ROW(to_nurbs),
    ROW(moved),
    ROW(sheared),
    ROW(seen_from_a_point),
    ROW(reverse),
    ROW(trim),
    ROW(trim_over_seam),
    ROW(halves),
    ROW(halves_at_the_end),
    ROW(reparametrize),
    ROW(without_stops),
    ROW(flatten),
    ROW(to_space),
    ROW(discretize),
    ROW(closest),
    ROW(approximate),
    ROW(offset),
    ROW(offset_to_the_right),
    ROW(rounded),
    ROW(tangents_from_point),
    ROW(its_conic),
    ROW(its_conic_in_space),
    ROW(conic_points),
    ROW(coefficients),
    ROW(special_points),
    ROW(contact),
    ROW(where_it_meets_a_plane),
    ROW(split),
    ROW(to_bezier),
    ROW(elevate),
    ROW(insert_knots),
    ROW(insert_midpoints),
    ROW(clamp),
    ROW(remove_knot),
    ROW(reduce_degree),
    ROW(bezier_join),
    ROW(gather),
    ROW(cuts),
};

static CagStatus make_kind(const void *given, CagError *e) {
  const Kind *kind = given;
  CagCurve *c;
  return drop(kind->make(&c, e), &c);
}
static void making_a_curve_reports_faults(void **state) {
  (void)state;
  for (int k = 0; k < KIND_COUNT; k++) try_faults("making", KINDS[k].name, make_kind, &KINDS[k]);
  assert_int_equal(fault_problems, 0);
}

static void questions_to_a_curve_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  for (int k = 0; k < KIND_COUNT; k++) {
    CagCurve *c;
    OK(KINDS[k].make(&c, &err));
    for (size_t q = 0; q < sizeof QUESTIONS / sizeof *QUESTIONS; q++)
      try_faults(QUESTIONS[q].name, KINDS[k].name, QUESTIONS[q].ask, c);
    cag_curve_release(c);
  }
  assert_int_equal(fault_problems, 0);
}

// Operations on two curves.
typedef struct Pair {
  const CagCurve *a, *b;
} Pair;
#define PAIR const Pair *pair = given

QUESTION(intersect) {
  PAIR;
  CagMeeting *at;
  size_t n;
  const CagStatus status = cag_curve_intersect(pair->a, pair->b, &at, &n, e);
  if (!status) fault_found((double)n);
  if (!status) free(at);
  return status;
}
QUESTION(tangents_of_two) {
  PAIR;
  CagTangentLine *lines;
  size_t n;
  const CagStatus status = cag_tangents_of_two(pair->a, pair->b, &lines, &n, e);
  if (!status) fault_found((double)n);
  if (!status) free(lines);
  return status;
}
QUESTION(fillet) {
  PAIR;
  CagCurve *made;
  double t, t2;
  return drop(cag_fillet(pair->a, pair->b, 0.1, &made, &t, &t2, e), &made);
}
QUESTION(joint) {
  PAIR;
  CagJoint j;
  const CagStatus status = cag_curve_joint(pair->a, pair->b, 1e-9, &j, e);
  if (!status) fault_found(j.gap);
  return status;
}
QUESTION(deviation) {
  PAIR;
  double d;
  const CagStatus status = cag_curve_deviation(pair->a, pair->b, &d, e);
  if (!status) fault_found(d);
  return status;
}
static const Question PAIR_QUESTIONS[] = {
    ROW(intersect), ROW(tangents_of_two), ROW(fillet), ROW(joint), ROW(deviation),
};

static void questions_to_two_curves_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  for (int k = 0; k < KIND_COUNT; k++)
    for (int l = 0; l < KIND_COUNT; l++) {
      // Each kind is combined with the function and with its neighbor in the list.
      if (KINDS[l].make != function && l != (k + 1) % KIND_COUNT) continue;
      Pair pair;
      CagCurve *a, *b;
      char name[80];
      snprintf(name, sizeof name, "%s and %s", KINDS[k].name, KINDS[l].name);
      OK(KINDS[k].make(&a, &err));
      OK(KINDS[l].make(&b, &err));
      pair = (Pair){a, b};
      for (size_t q = 0; q < sizeof PAIR_QUESTIONS / sizeof *PAIR_QUESTIONS; q++)
        try_faults(PAIR_QUESTIONS[q].name, name, PAIR_QUESTIONS[q].ask, &pair);
      cag_curve_release(a);
      cag_curve_release(b);
    }
  assert_int_equal(fault_problems, 0);
}

// Curves made of points.
QUESTION(spline_through_points) {
  CagCurve *made;
  const double t[6] = {0, 1, 2, 3.5, 4, 5};
  const CagCubicEnds ends = {.closing = *(const CagCubicClosing *)given};
  CagVec3 points[6];
  memcpy(points, zigzag, sizeof points);
  if (ends.closing == CAG_CUBIC_CYCLIC) points[5] = points[0];
  return drop(cag_curve_cubic_spline(points, 6, t, &ends, NULL, 2, &made, e), &made);
}
QUESTION(hermite) {
  (void)given;
  CagCurve *made;
  const double t[6] = {0, 1, 2, 3.5, 4, 5};
  return drop(cag_curve_hermite(zigzag, in_space, 6, t, 3, &made, e), &made);
}
QUESTION(polynomial) {
  (void)given;
  CagCurve *made;
  return drop(cag_curve_polynomial(zigzag, 4, 2, 2, &made, e), &made);
}
QUESTION(parabolic_blend) {
  CagCurve *made;
  return drop(
      cag_curve_parabolic_blend(zigzag, 6, NULL, 0.5, *(const CagBlendEnds *)given, 2, &made, e),
      &made);
}
static const CagFitData FIT = {.points = zigzag, .n = 6, .degree = 3, .dimension = 2};
QUESTION(interpolate) {
  CagCurve *made;
  const size_t tangents = *(const size_t *)given;
  return drop(cag_curve_interpolate(&FIT, tangents ? in_space : NULL, tangents, &made, e), &made);
}
QUESTION(fit) {
  CagCurve *made;
  CagFitReport report;
  const int axis = *(const int *)given;
  const CagStatus status = cag_curve_fit(&FIT, 5, axis >= 0, axis, 1e-6, &made, &report, e);
  if (status) return status;
  cag_fit_report_free(&report);
  return drop(CAG_OK, &made);
}
QUESTION(conic_branches) {
  CagCurve *made[2];
  size_t n;
  const CagStatus status = cag_conic_branches(given, -2, 2, made, &n, e);
  if (!status)
    for (size_t i = 0; i < n; i++) cag_curve_release(made[i]);
  return status;
}
QUESTION(conic_segment) {
  CagCurve *made;
  return drop(cag_conic_segment(given, 0.1, 0.2, true, &made, e), &made);
}
QUESTION(conic_through_points) {
  (void)given;
  CagConic q;
  return cag_conic_from_conditions(zigzag, 5, NULL, 0, CAG_CONIC_GENERAL, &q, e);
}

static void curves_through_points_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  for (CagCubicClosing i = CAG_CUBIC_ENDS; i <= CAG_CUBIC_ANTICYCLIC; i++)
    try_faults("cubic spline", "points", spline_through_points, &i);
  try_faults("hermite", "points", hermite, NULL);
  try_faults("polynomial", "coefficients", polynomial, NULL);
  for (CagBlendEnds i = CAG_BLEND_OPEN; i <= CAG_BLEND_CLOSED; i++)
    try_faults("parabolic blend", "points", parabolic_blend, &i);
  static const size_t TANGENTS[] = {0, 2, 6};
  for (int i = 0; i < 3; i++) try_faults("interpolation", "points", interpolate, &TANGENTS[i]);
  static const int AXES[] = {-1, 0};
  for (int i = 0; i < 2; i++) try_faults("fit", "points", fit, &AXES[i]);
}

static void conics_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  static const CagConic CONICS[] = {{{1, 0, 2, 0, 0, -3}}, {{1, 0, -2, 0, 0, -3}},
                                    {{1, 0, 0, 0, -1, 0}}, {{1, 0, -1, 0, 0, 0}},
                                    {{1, 0, 0, 0, 0, -1}}, {{0, 0, 0, 1, 1, -1}}};
  for (int i = 0; i < 6; i++) {
    try_faults("branches", "conic", conic_branches, &CONICS[i]);
    try_faults("segment", "conic", conic_segment, &CONICS[i]);
  }
  try_faults("conic", "points", conic_through_points, NULL);
  assert_int_equal(fault_problems, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(making_a_curve_reports_faults),
      cmocka_unit_test(questions_to_a_curve_report_faults),
      cmocka_unit_test(questions_to_two_curves_report_faults),
      cmocka_unit_test(curves_through_points_report_faults),
      cmocka_unit_test(conics_report_faults),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
