// Evaluation, representations, and images of all kinds of curves.

#include "geom/basis/bernstein.h"
#include "geom/curve/curve.h"
#include "support.h"

static CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

// --- The reference's curves ---

typedef struct Vector {
  const char *id, *type;
  int degree, n, dimension;
  const double *points, *weights, *knots;
  int count;
  const double *t, *expected, *d1, *d2;
} Vector;

#define P(...) (const double[]) __VA_ARGS__
#define VECTOR(...) {__VA_ARGS__},
static const Vector vectors[] = {
#include "bspline_vectors.def"
};

static CagCurve *build(const Vector *v) {
  CagVec3 p[16];
  double knots[64];
  CagCurve *c;
  for (int i = 0; i < v->n; i++) {
    const double *q = v->points + i * v->dimension;
    p[i] = cag_vec3(q[0], q[1], v->dimension == 3 ? q[2] : 0);
  }
  const double *weights = isnan(v->weights[0]) ? NULL : v->weights;
  const size_t n = (size_t)v->n;
  if (strcmp(v->type, "closed") == 0) {
    OK(cag_curve_nurbs_closed(p, weights, n, v->degree, v->dimension, &c, &err));
    return c;
  }
  if (strcmp(v->type, "knots") == 0) memcpy(knots, v->knots, (n + (size_t)v->degree + 1) * 8);
  else
    OK(cag_knots_make(strcmp(v->type, "chord-knots") == 0 ? "chord" : v->type, n, v->degree, p,
                      knots, &err));
  OK(cag_curve_nurbs(p, weights, n, v->degree, knots, v->dimension, &c, &err));
  return c;
}

static CagVec3 listed(const double *list, int i, int dimension) {
  const double *q = list + i * dimension;
  return cag_vec3(q[0], q[1], dimension == 3 ? q[2] : 0);
}

static void the_reference_curves_have_their_points_and_derivatives(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++) {
    const Vector *v = &vectors[k];
    CagCurve *c = build(v);
    for (int i = 0; i < v->count; i++) {
      CagVec3 d[3], many[3];
      OK(cag_curve_eval(c, v->t[i], 2, CAG_SIDE_RIGHT, d, &err));
      OK(cag_curve_eval_many(c, &v->t[i], 1, 2, many, &err));
      for (int j = 0; j < 3; j++) near_vec(many[j], d[j], 0);
      if (!isnan(v->expected[0])) near_vec(d[0], listed(v->expected, i, v->dimension), 1e-9);
      if (!isnan(v->d1[0])) near_vec(d[1], listed(v->d1, i, v->dimension), 1e-9);
      if (!isnan(v->d2[0])) near_vec(d[2], listed(v->d2, i, v->dimension), 1e-9);
    }
    cag_curve_release(c);
  }
}

// --- Curves for testing identities ---

static const CagVec3 zigzag[5] = {{0, 1, 0}, {1, 2, 1}, {2.5, 0, 0.5}, {4, 2, -1}, {5, 0, 0}};

static size_t samples(CagCurve *out[16]) {
  static const double weights[5] = {1, 2, 0.5, 3, 1};
  static const double uneven[9] = {0, 0, 0, 0, 0.3, 1, 1, 1, 1};
  double knots[16];
  size_t n = 0;
  CagTransform frame;
  CagTransform shear = cag_shear(0.3, 0, 0, 0.2, 0.1, 0);
  CagTransform move = cag_translate(cag_vec3(1, 2, 3));
  frame = cag_transform_multiply(&move, &shear);
  OK(cag_curve_line(zigzag[0], zigzag[1], 3, &out[n++], &err));
  OK(cag_curve_polyline(zigzag, 5, false, 3, &out[n++], &err));
  OK(cag_curve_polyline(zigzag, 5, true, 3, &out[n++], &err));
  OK(cag_curve_arc(2, 1, 0.3, 2.5, &frame, &out[n++], &err));
  OK(cag_curve_arc(2, 2, 0, 2 * M_PI, &frame, &out[n++], &err));
  OK(cag_curve_helix(3, 2, 2.5, 0.1, &out[n++], &err));
  OK(cag_curve_helix(3, 2, -1.5, 0, &out[n++], &err));
  OK(cag_curve_bezier(zigzag, NULL, 5, 3, &out[n++], &err));
  OK(cag_curve_bezier(zigzag, weights, 5, 3, &out[n++], &err));
  OK(cag_curve_nurbs(zigzag, NULL, 5, 3, uneven, 3, &out[n++], &err));
  OK(cag_curve_nurbs(zigzag, weights, 5, 3, uneven, 3, &out[n++], &err));
  OK(cag_knots_make("periodic", 5, 2, NULL, knots, &err));
  OK(cag_curve_nurbs(zigzag, weights, 5, 2, knots, 3, &out[n++], &err));
  OK(cag_curve_nurbs_closed(zigzag, NULL, 5, 3, 3, &out[n++], &err));
  OK(cag_curve_nurbs_closed(zigzag, weights, 5, 4, 3, &out[n++], &err));
  CagCurve *parts[2];
  OK(cag_curve_bezier(zigzag, NULL, 5, 3, &parts[0], &err));
  OK(cag_curve_line(zigzag[4], cag_vec3(7, 7, 7), 3, &parts[1], &err));
  OK(cag_curve_join(parts, 2, &out[n++], &err));
  cag_curve_release(parts[0]);
  cag_curve_release(parts[1]);
  return n;
}

// Fourth-order central differences with step h, whose error is about h^4 f''''' / 30.
static void derivatives_agree_with_differences(void **state) {
  (void)state;
  CagCurve *c[16];
  size_t n = samples(c);
  for (size_t i = 0; i < n; i++) {
    const double range = c[i]->end - c[i]->start, h = 1e-3 * range;
    for (int k = 0; k < 7; k++) {
      double t = c[i]->start + range * (0.13 + 0.107 * k);
      CagVec3 d[5], e[4][5];
      OK(cag_curve_eval(c[i], t, 4, CAG_SIDE_RIGHT, d, &err));
      static const double step[4] = {-2, -1, 1, 2};
      bool smooth = true;
      double cuts[64];
      size_t m = c[i]->kind->breaks ? c[i]->kind->breaks(c[i], cuts, 64) : 0;
      for (size_t j = 0; j < m; j++) smooth = smooth && fabs(cuts[j] - t) > 3 * h;
      if (!smooth) continue;
      for (int j = 0; j < 4; j++)
        OK(cag_curve_eval(c[i], t + step[j] * h, 4, CAG_SIDE_RIGHT, e[j], &err));
      for (int order = 0; order < 4; order++) {
        CagVec3 difference = cag_scaled(cag_sub(e[0][order], e[3][order]), 1 / (12 * h));
        difference = cag_madd(difference, 8 / (12 * h), cag_sub(e[2][order], e[1][order]));
        double size = 1 + cag_norm(d[order + 1]) + cag_norm(d[order]) / range;
        near_vec(difference, d[order + 1], 1e-5 * size);
      }
    }
  }
  for (size_t i = 0; i < n; i++) cag_curve_release(c[i]);
}

static void reversing_trimming_and_stretching_keep_the_points(void **state) {
  (void)state;
  CagCurve *c[16], *r, *part, *stretched;
  size_t n = samples(c);
  for (size_t i = 0; i < n; i++) {
    const double a = c[i]->start, b = c[i]->end, range = b - a;
    OK(cag_curve_reverse(c[i], &r, &err));
    OK(cag_curve_trim(c[i], a + 0.2 * range, a + 0.7 * range, &part, &err));
    OK(cag_curve_reparametrize(c[i], 5, 9, &stretched, &err));
    assert_true(r->start == a && r->end == b);
    assert_true(stretched->start == 5 && stretched->end == 9);
    for (int k = 0; k <= 20; k++) {
      double u = k / 20.0, t = a + u * range;
      near_vec(at(r, k == 20 ? a : a + (1 - u) * range), at(c[i], t), 1e-12);
      near_vec(at(stretched, 5 + 4 * u), at(c[i], t), 1e-12);
      double inner = a + (0.2 + 0.5 * u) * range;
      near_vec(at(part, fmin(inner, part->end)), at(c[i], inner), 1e-12);
    }
    CagVec3 d[3], e[3];
    OK(cag_curve_eval(c[i], a + 0.5 * range, 2, CAG_SIDE_RIGHT, d, &err));
    OK(cag_curve_eval(stretched, 7, 2, CAG_SIDE_RIGHT, e, &err));
    near_vec(cag_scaled(d[1], range / 4), e[1], 1e-10);
    near_vec(cag_scaled(d[2], range * range / 16), e[2], 1e-10);
    cag_curve_release(r);
    cag_curve_release(part);
    cag_curve_release(stretched);
    cag_curve_release(c[i]);
  }
}

static void transforming_the_curve_transforms_its_points(void **state) {
  (void)state;
  CagCurve *c[16], *image;
  size_t n = samples(c);
  CagTransform turn, affine, shear = cag_shear(0.5, 0, 0.1, 0, 0, 0.3);
  OK(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(1, 0, 2), &turn, &err));
  affine = cag_transform_multiply(&turn, &shear);
  for (size_t i = 0; i < n; i++) {
    OK(cag_curve_transform(c[i], &affine, &image, &err));
    assert_string_equal(image->kind->name,
                        strcmp(c[i]->kind->name, "circle") == 0 ? "ellipse" : c[i]->kind->name);
    for (int k = 0; k <= 20; k++) {
      double t = k == 20 ? c[i]->end : c[i]->start + (c[i]->end - c[i]->start) * k / 20.0;
      near_vec(at(image, t), cag_transform_point(&affine, at(c[i], t)), 1e-12);
    }
    cag_curve_release(image);
    cag_curve_release(c[i]);
  }
}

static void projecting_the_curve_projects_its_points(void **state) {
  (void)state;
  CagCurve *c[16], *image;
  size_t n = samples(c);
  CagPlane plane;
  CagTransform t;
  OK(cag_plane(cag_vec3(0, 0, -10), cag_vec3(0.1, 0, 1), &plane, &err));
  OK(cag_project_central(&plane, cag_vec3(1, 2, 50), &t, &err));
  for (size_t i = 0; i < n; i++) {
    if (strcmp(c[i]->kind->name, "helix") == 0) {
      FAILS(cag_curve_transform(c[i], &t, &image, &err), "no-exact-form");
    } else {
      // The image of an exact NURBS representation has its parameters.
      CagCurve *exact;
      OK(cag_curve_to_nurbs(c[i], &exact, &err));
      OK(cag_curve_transform(c[i], &t, &image, &err));
      for (int k = 0; k <= 20; k++) {
        double u = k / 20.0, x = exact->start + (exact->end - exact->start) * u;
        double y = image->start + (image->end - image->start) * u;
        near_vec(at(image, fmin(y, image->end)),
                 cag_transform_point(&t, at(exact, fmin(x, exact->end))), 1e-11);
      }
      cag_curve_release(exact);
      cag_curve_release(image);
    }
    cag_curve_release(c[i]);
  }
}

static void the_exact_nurbs_form_has_the_same_points(void **state) {
  (void)state;
  CagCurve *c[16], *exact;
  size_t n = samples(c);
  for (size_t i = 0; i < n; i++) {
    if (strcmp(c[i]->kind->name, "helix") == 0) {
      FAILS(cag_curve_to_nurbs(c[i], &exact, &err), "no-exact-form");
    } else {
      CagNurbsView view;
      OK(cag_curve_to_nurbs(c[i], &exact, &err));
      assert_true(cag_curve_nurbs_view(exact, &view));
      for (int k = 0; k <= 30; k++) {
        double t = exact->start + (exact->end - exact->start) * k / 30.0, distance;
        OK(cag_curve_closest(c[i], at(exact, fmin(t, exact->end)), NULL, NULL, &distance, &err));
        assert_true(distance < 1e-9);
      }
      cag_curve_release(exact);
    }
    cag_curve_release(c[i]);
  }
}

// --- Single facts ---

static void a_closed_spline_meets_itself_bit_for_bit(void **state) {
  (void)state;
  static const double weights[3] = {1, 0.3, 2};
  for (int degree = 1; degree <= 6; degree++)
    for (int rational = 0; rational < 2; rational++) {
      CagCurve *c;
      OK(cag_curve_nurbs_closed(zigzag, rational ? weights : NULL, 3, degree, 3, &c, &err));
      CagVec3 a = at(c, 0), b = at(c, 3);
      assert_memory_equal(&a, &b, sizeof a);
      CagVec3 d[8], e[8];
      OK(cag_curve_eval(c, 0, degree, CAG_SIDE_RIGHT, d, &err));
      OK(cag_curve_eval(c, 3, degree, CAG_SIDE_LEFT, e, &err));
      for (int k = 0; k < degree; k++)
        near_vec(d[k], e[k], 1e-10 * pow(3, k) * (1 + cag_norm(d[k])));
      cag_curve_release(c);
    }
}

static void circles_and_arcs_hit_special_angles_exactly(void **state) {
  (void)state;
  CagCurve *c;
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(2, 2, 0, 2 * M_PI, &frame, &c, &err));
  assert_string_equal(c->kind->name, "circle");
  assert_true(c->closed && c->angular && c->dimension == 2);
  near_vec(at(c, M_PI), cag_vec3(-2, 0, 0), 0);
  near_vec(at(c, M_PI / 2), cag_vec3(0, 2, 0), 0);
  near_vec(at(c, M_PI / 6), cag_vec3(2 * 0.86602540378443864676, 1, 0), 0);
  near_vec(at(c, 2 * M_PI), cag_vec3(2, 0, 0), 0);
  cag_curve_release(c);
}

// Reference 05b, 6.3: circle of four quarters.
static void a_circle_as_nurbs_has_four_quarters(void **state) {
  (void)state;
  static const double knots[12] = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
  CagCurve *c, *exact;
  CagNurbsView v;
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(1, 1, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_curve_to_nurbs(c, &exact, &err));
  assert_true(cag_curve_nurbs_view(exact, &v));
  assert_int_equal(v.count, 9);
  assert_int_equal(v.degree, 2);
  assert_memory_equal(v.knots, knots, sizeof knots);
  for (int i = 0; i < 9; i++)
    assert_true(fabs(v.homogeneous[4 * i + 3] - (i % 2 ? sqrt(0.5) : 1)) < 1e-15);
  near_vec(at(exact, 0.25), cag_vec3(0.9297883010624303, 0.36809470956187273, 0), 1e-14);
  near_vec(at(exact, 3.9), cag_vec3(0.9894434504817674, -0.14491948902316157, 0), 1e-14);
  assert_true(exact->closed);
  cag_curve_release(c);
  cag_curve_release(exact);
}

// A Bezier curve of degree 60. Its x coordinates, i / 60, form the identity. Its y coordinate is
// t^60, because only the last point is not 0.
static void high_degrees_are_stable(void **state) {
  (void)state;
  CagVec3 p[61];
  for (int i = 0; i <= 60; i++) p[i] = cag_vec3(i / 60.0, i == 60, 0);
  CagCurve *c;
  OK(cag_curve_bezier(p, NULL, 61, 2, &c, &err));
  for (int k = 0; k <= 40; k++) {
    CagVec3 d[3];
    double t = k / 40.0;
    OK(cag_curve_eval(c, t, 2, CAG_SIDE_RIGHT, d, &err));
    assert_true(fabs(d[0].x - t) < 1e-14 && fabs(d[1].x - 1) < 1e-12);
    assert_true(fabs(d[0].y - pow(t, 60)) < 1e-14);
    assert_true(fabs(d[1].y - 60 * pow(t, 59)) < 1e-11);
    assert_true(fabs(d[2].y - 60 * 59 * pow(t, 58)) < 1e-9);
  }
  cag_curve_release(c);
}

static void derivatives_above_the_degree_are_zero(void **state) {
  (void)state;
  CagCurve *c;
  CagVec3 d[CAG_MAX_DERIVATIVE + 1];
  for (size_t n = 2; n <= 5; n++) {
    OK(cag_curve_bezier(zigzag, NULL, n, 3, &c, &err));
    OK(cag_curve_eval(c, 0.4, CAG_MAX_DERIVATIVE, CAG_SIDE_RIGHT, d, &err));
    for (size_t k = n; k <= CAG_MAX_DERIVATIVE; k++) near_vec(d[k], cag_vec3(0, 0, 0), 0);
    cag_curve_release(c);
  }
}

// (1 - t^2, 2t) / (1 + t^2) has derivatives in closed form. At t = 0, the series of y = 2t / (1 +
// t^2) is 2 (t - t^3 + t^5 - ..), so the k-th derivative is +-2 k! for odd k.
static void rational_derivatives_of_any_order_are_right(void **state) {
  (void)state;
  static const CagVec3 p[3] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  static const double w[3] = {1, 1, 2};
  CagCurve *c;
  CagVec3 d[CAG_MAX_DERIVATIVE + 1];
  OK(cag_curve_bezier(p, w, 3, 2, &c, &err));
  OK(cag_curve_eval(c, 0, CAG_MAX_DERIVATIVE, CAG_SIDE_RIGHT, d, &err));
  double factorial = 1;
  for (int k = 1; k <= CAG_MAX_DERIVATIVE; k++) {
    factorial *= k;
    double y = k % 2 ? 2 * factorial * (k % 4 == 1 ? 1 : -1) : 0;
    double x = k % 2 ? 0 : 2 * factorial * (k % 4 == 0 ? 1 : -1); // 2 / (1 + t^2) - 1
    near_vec(d[k], cag_vec3(x, y, 0), 1e-12 * factorial);
  }
  cag_curve_release(c);
}

// Vectors curve.helix.a2b1, curve.twisted-cubic.t0 and t1, curve.frenet-straight.
static void frenet_frames_are_those_of_the_reference(void **state) {
  (void)state;
  CagCurve *c;
  CagFrenet f;
  OK(cag_curve_helix(2, 2 * M_PI, 1, 0, &c, &err));
  OK(cag_curve_frenet(c, 1.0471975511965976, &f, &err));
  near_vec(f.tangent, cag_vec3(-0.7745966692414833, 0.44721359549995804, 0.4472135954999579),
           1e-14);
  near_vec(f.normal, cag_vec3(-0.5, -0.8660254037844385, 0), 1e-14);
  near_vec(f.binormal, cag_vec3(0.38729833462074165, -0.22360679774997902, 0.8944271909999159),
           1e-14);
  assert_true(fabs(f.curvature - 2.0 / 5) < 1e-14 && fabs(f.torsion - 1.0 / 5) < 1e-14);
  cag_curve_release(c);

  // (t, t^2, t^3) over 0..1 in Bernstein form.
  static const CagVec3 cubic[4] = {{0, 0, 0}, {1.0 / 3, 0, 0}, {2.0 / 3, 1.0 / 3, 0}, {1, 1, 1}};
  OK(cag_curve_bezier(cubic, NULL, 4, 3, &c, &err));
  OK(cag_curve_frenet(c, 0, &f, &err));
  assert_true(fabs(f.curvature - 2) < 1e-13 && fabs(f.torsion - 3) < 1e-13);
  OK(cag_curve_frenet(c, 1, &f, &err));
  assert_true(fabs(f.curvature - 0.16642353500306217) < 1e-14);
  assert_true(fabs(f.torsion - 0.15789473684210523) < 1e-13);
  near_vec(f.normal, cag_vec3(-0.6744532734334624, -0.4905114715879726, 0.5518254055364692), 1e-13);
  cag_curve_release(c);

  OK(cag_curve_line(cag_vec3(1, 2, 3), cag_vec3(3, 1, 5), 3, &c, &err));
  OK(cag_curve_frenet(c, 0.5, &f, &err));
  near_vec(f.tangent, cag_vec3(2.0 / 3, -1.0 / 3, 2.0 / 3), 1e-15);
  assert_true(f.curvature == 0 && !f.has_normal);
  cag_curve_release(c);
}

static void tangents_have_their_limit_where_the_speed_is_zero(void **state) {
  (void)state;
  CagCurve *c;
  CagVec3 t;
  // Two equal points at the start: the tangent points to the third.
  static const CagVec3 start[4] = {{0, 0, 0}, {0, 0, 0}, {3, 4, 0}, {5, 5, 0}};
  OK(cag_curve_bezier(start, NULL, 4, 2, &c, &err));
  OK(cag_curve_tangent(c, 0, CAG_SIDE_RIGHT, &t, &err));
  near_vec(t, cag_vec3(0.6, 0.8, 0), 1e-12);
  cag_curve_release(c);
  // Two equal points at the end: the tangent comes from the one before.
  static const CagVec3 end[4] = {{0, 0, 0}, {1, 1, 0}, {4, 5, 0}, {4, 5, 0}};
  OK(cag_curve_bezier(end, NULL, 4, 2, &c, &err));
  OK(cag_curve_tangent(c, 1, CAG_SIDE_LEFT, &t, &err));
  near_vec(t, cag_vec3(0.6, 0.8, 0), 1e-12);
  cag_curve_release(c);
  // (t^2, t^3) over -1..1 has a cusp at 0: the two limits are opposite, and the curvature is
  // infinite.
  static const CagVec3 cusp[4] = {{1, -1, 0}, {-1.0 / 3, 1, 0}, {-1.0 / 3, -1, 0}, {1, 1, 0}};
  CagCurve *whole;
  CagFrenet f;
  OK(cag_curve_bezier(cusp, NULL, 4, 2, &whole, &err));
  OK(cag_curve_reparametrize(whole, -1, 1, &c, &err));
  OK(cag_curve_tangent(c, 0, CAG_SIDE_RIGHT, &t, &err));
  near_vec(t, cag_vec3(1, 0, 0), 1e-12);
  OK(cag_curve_tangent(c, 0, CAG_SIDE_LEFT, &t, &err));
  near_vec(t, cag_vec3(-1, 0, 0), 1e-12);
  FAILS(cag_curve_frenet(c, 0, &f, &err), "curvature-undefined");
  cag_curve_release(c);
  cag_curve_release(whole);
  // If all control points coincide, there is no tangent.
  static const CagVec3 point[3] = {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}};
  OK(cag_curve_bezier(point, NULL, 3, 2, &c, &err));
  FAILS(cag_curve_tangent(c, 0.5, CAG_SIDE_RIGHT, &t, &err), "tangent-undefined");
  cag_curve_release(c);
}

static void parameters_outside_the_domain_fail_with_the_domain(void **state) {
  (void)state;
  CagCurve *c;
  CagVec3 p;
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(1, 1, 0, 2 * M_PI, &frame, &c, &err));
  FAILS(cag_curve_point(c, 400 * (M_PI / 180), &p, &err), "parameter-range");
  assert_string_equal(err.message, "`t` = 400deg lies outside the domain 0deg..360deg");
  assert_int_equal(err.status, CAG_E_DOMAIN);
  OK(cag_curve_point(c, -0.0, &p, &err));
  OK(cag_curve_point(c, nextafter(2 * M_PI, 7), &p, &err)); // one ulp is rounding
  FAILS(cag_curve_point(c, NAN, &p, &err), "not-finite");
  cag_curve_release(c);
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 1, 0), 2, &c, &err));
  FAILS(cag_curve_point(c, 2, &p, &err), "parameter-range");
  assert_string_equal(err.message, "`t` = 2 lies outside the domain 0..1");
  FAILS(cag_curve_eval(c, 0, 17, CAG_SIDE_RIGHT, &p, &err), "derivative-order");
  cag_curve_release(c);
}

static void rounding_at_the_ends_of_a_domain_counts_as_the_end(void **state) {
  (void)state;
  const CagVec3 p = {1, 2, 3}, q = {-4, 5, 7};
  const double ulp = 0x1p-52; // of 1; 16 of them are tolerated
  CagCurve *c, *part, *half[2];
  OK(cag_curve_line(p, q, 3, &c, &err));
  near_vec(at(c, 1 + 16 * ulp), q, 0);
  near_vec(at(c, -16 * ulp), p, 0);
  CagVec3 x;
  FAILS(cag_curve_point(c, 1 + 17 * ulp, &x, &err), "parameter-range");
  FAILS(cag_curve_point(c, -17 * ulp, &x, &err), "parameter-range");
  FAILS(cag_curve_point(c, -INFINITY, &x, &err), "parameter-range");
  FAILS(cag_curve_point(c, INFINITY, &x, &err), "parameter-range");
  near_vec(at(c, 0.25), cag_lerp(p, q, 0.25), 1e-15);
  // Trimming to the whole domain returns the curve itself, but a part is a new curve.
  OK(cag_curve_trim(c, -8 * ulp, 1 + 8 * ulp, &part, &err));
  assert_ptr_equal(part, c);
  cag_curve_release(part);
  const double ranges[3][2] = {{0, 0.5}, {0.5, 1}, {0.25, 0.75}};
  for (int i = 0; i < 3; i++) {
    OK(cag_curve_trim(c, ranges[i][0], ranges[i][1], &part, &err));
    near_vec(at(part, part->start), cag_lerp(p, q, ranges[i][0]), 1e-14);
    near_vec(at(part, part->end), cag_lerp(p, q, ranges[i][1]), 1e-14);
    cag_curve_release(part);
    OK(cag_curve_reparametrize(c, 2 * ranges[i][0], 2 * ranges[i][1], &part, &err));
    assert_true(part->start == 2 * ranges[i][0] && part->end == 2 * ranges[i][1]);
    near_vec(at(part, part->start), p, 0);
    near_vec(at(part, part->end), q, 0);
    cag_curve_release(part);
  }
  OK(cag_curve_reparametrize(c, 0, 1, &part, &err));
  assert_ptr_equal(part, c);
  cag_curve_release(part);
  FAILS(cag_curve_trim(c, 1, 1 + 2 * ulp, &part, &err), "empty-range");
  FAILS(cag_curve_trim(c, -2 * ulp, 0, &part, &err), "empty-range");
  FAILS(cag_curve_trim(c, 0.5, 0.5, &part, &err), "empty-range");
  FAILS(cag_curve_trim(c, 0.5, NAN, &part, &err), "not-finite");
  FAILS(cag_curve_trim(c, -INFINITY, 0.5, &part, &err), "not-finite");
  FAILS(cag_curve_trim(c, -0.5, 0.5, &part, &err), "parameter-range");
  FAILS(cag_curve_trim(c, 0.5, 1.5, &part, &err), "parameter-range");
  FAILS(cag_curve_reparametrize(c, 3, 3, &part, &err), "empty-range");
  // Splitting at an end results in the curve and a point.
  for (int i = 0; i < 2; i++) {
    OK(cag_curve_halves(c, i, half, &err));
    assert_ptr_equal(half[1 - i], c);
    assert_true(half[i]->start == i && half[i]->end == i && !half[i]->closed);
    near_vec(at(half[i], i), i ? q : p, 0);
    assert_true(cag_curve_resting_view(half[i], &x));
    for (int k = 0; k < 2; k++) cag_curve_release(half[k]);
  }
  cag_curve_release(c);
}

static void closed_curves_are_trimmed_over_the_seam_up_to_a_turn(void **state) {
  (void)state;
  CagCurve *c, *part;
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(3, 2, 0, 2 * M_PI, &frame, &c, &err));
  const double turn = 2 * M_PI, ulp = 0x1p-50;
  OK(cag_curve_trim(c, -4 * ulp, turn + 4 * ulp, &part, &err));
  assert_ptr_equal(part, c);
  cag_curve_release(part);
  const double ranges[4][2] = {{-1, 2}, {5, 8}, {1, 1 + turn}, {-turn / 2, turn / 2}};
  for (int i = 0; i < 4; i++) {
    OK(cag_curve_trim(c, ranges[i][0], ranges[i][1], &part, &err));
    assert_true(part->angular);
    NEAR(part->end - part->start, ranges[i][1] - ranges[i][0], 1e-14);
    for (int k = 0; k <= 20; k++) {
      const double x = ranges[i][0] + (ranges[i][1] - ranges[i][0]) * k / 20;
      const double t = part->start + (part->end - part->start) * k / 20;
      near_vec(at(part, fmin(t, part->end)), cag_vec3(3 * cos(x), 2 * sin(x), 0), 1e-14);
    }
    cag_curve_release(part);
  }
  FAILS(cag_curve_trim(c, 1, 1 + turn + 1e-12, &part, &err), "parameter-range");
  FAILS(cag_curve_trim(c, -1, turn, &part, &err), "parameter-range");
  cag_curve_release(c);
}

static void bad_data_are_named(void **state) {
  (void)state;
  CagCurve *c;
  const double falling[7] = {0, 0, 0, 2, 1, 3, 3};    // bspline.error.knots-decreasing
  const double torn[9] = {0, 0, 0, 1, 1, 1, 2, 2, 2}; // an inner knot k times
  const double empty[6] = {0, 1, 2, 2, 3, 4};         // bspline.knots.class-2
  const double good[7] = {0, 0, 0, 1, 2, 2, 2}, negative[4] = {1, 1, -1, 1};
  const double none[4] = {0, 0, 0, 0}, gap[4] = {0, 1, 1, 1}, infinite[4] = {1, INFINITY, 1, 1};
  FAILS_AT(cag_curve_nurbs(zigzag, NULL, 4, 2, falling, 3, &c, &err), "knots-not-monotone", 4);
  assert_string_equal(err.argument, "knots");
  assert_string_equal(err.message,
                      "`knots` must not decrease: knots[4] = 1 is less than knots[3] = 2");
  CagVec3 six[6] = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 0, 0}, {4, 2, 0}, {5, 5, 0}};
  FAILS_AT(cag_curve_nurbs(six, NULL, 6, 2, torn, 3, &c, &err), "knot-multiplicity", 5);
  FAILS_AT(cag_curve_nurbs(six, NULL, 3, 2, empty, 3, &c, &err), "empty-range", 2);
  FAILS(cag_curve_nurbs(six, NULL, 4, 4, good, 3, &c, &err), "order-range");
  FAILS_AT(cag_curve_nurbs(six, negative, 4, 2, good, 3, &c, &err), "negative-weight", 2);
  FAILS(cag_curve_nurbs(six, none, 4, 2, good, 3, &c, &err), "zero-denominator");
  FAILS(cag_curve_nurbs(six, gap, 4, 2, good, 3, &c, &err), "zero-denominator");
  FAILS_AT(cag_curve_nurbs(six, infinite, 4, 2, good, 3, &c, &err), "not-finite", 1);
  six[3].y = NAN;
  FAILS_AT(cag_curve_nurbs(six, NULL, 4, 2, good, 3, &c, &err), "not-finite", 3);
  FAILS(cag_curve_bezier(six, NULL, 0, 3, &c, &err), "too-few-points");
  FAILS_AT(cag_curve_bezier(six, none, 1, 3, &c, &err), "zero-denominator", 0);
  FAILS_AT(cag_curve_bezier(six, negative + 2, 1, 3, &c, &err), "negative-weight", 0);
  FAILS(cag_curve_polyline(six, 1, false, 3, &c, &err), "too-few-points");
  FAILS(cag_curve_polyline(six, 2, true, 3, &c, &err), "too-few-points");
  const CagVec3 same[3] = {{1, 2, 0}, {1, 2, 0}, {1, 2, 0}};
  FAILS(cag_curve_polyline(same, 3, true, 3, &c, &err), "too-few-points");
  assert_string_equal(err.message, "a closed polyline needs at least 3 different points, found 1");
  CagTransform frame = cag_transform_identity();
  FAILS(cag_curve_arc(-1, -1, 0, 1, &frame, &c, &err), "radius-not-positive");
  assert_string_equal(err.argument, "radius");
  FAILS(cag_curve_arc(1, 1, 1, 1, &frame, &c, &err), "empty-range");
  FAILS(cag_curve_helix(1, 1, 0, 0, &c, &err), "empty-range");
  FAILS(cag_curve_helix(1, 1, 3, -1, &c, &err), "radius-not-positive");
  assert_string_equal(err.argument, "taper");
}

static void joining_wants_ends_that_meet(void **state) {
  (void)state;
  CagCurve *a, *b, *c, *joined;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 2, &a, &err));
  OK(cag_curve_line(cag_vec3(1, 0, 0), cag_vec3(1, 2, 0), 2, &b, &err));
  CagTransform frame = cag_transform_identity();
  OK(cag_curve_arc(2, 2, M_PI / 2, M_PI, &frame, &c, &err));
  CagCurve *good[2] = {a, b}, *bad[2] = {b, a};
  OK(cag_curve_join(good, 2, &joined, &err));
  assert_string_equal(joined->kind->name, "polyline");
  assert_true(joined->end == 2);
  near_vec(at(joined, 1), cag_vec3(1, 0, 0), 0);
  FAILS_AT(cag_curve_join(bad, 2, &a, &err), "ends-do-not-meet", 1);
  cag_curve_release(joined);
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(c);
}

// Example 22 of reference 05b: a quarter circle joined to a quadratic spline.
static void a_composite_has_an_exact_nurbs_form(void **state) {
  (void)state;
  static const CagVec3 spline[4] = {{2, 2, 0}, {4, 2, 0}, {6, 3, 0}, {7, 5, 0}};
  static const CagVec3 quarter[3] = {{0, 0, 0}, {0, 2, 0}, {2, 2, 0}};
  static const double knots[7] = {0, 0, 0, 1, 2, 2, 2};
  const double w[3] = {1, sqrt(0.5), 1};
  CagCurve *parts[2], *joined, *exact;
  OK(cag_curve_bezier(quarter, w, 3, 2, &parts[0], &err));
  OK(cag_curve_nurbs(spline, NULL, 4, 2, knots, 2, &parts[1], &err));
  OK(cag_curve_join(parts, 2, &joined, &err));
  assert_true(joined->start == 0 && joined->end == 3);
  OK(cag_curve_to_nurbs(joined, &exact, &err));
  for (int k = 0; k <= 30; k++) near_vec(at(exact, k / 10.0), at(joined, k / 10.0), 1e-13);
  // The speeds at the joint are 2 sqrt 2 and 4.
  CagVec3 d[2];
  OK(cag_curve_eval(joined, 1, 1, CAG_SIDE_LEFT, d, &err));
  near_vec(d[1], cag_vec3(2 * sqrt(2), 0, 0), 1e-12);
  OK(cag_curve_eval(joined, 1, 1, CAG_SIDE_RIGHT, d, &err));
  near_vec(d[1], cag_vec3(4, 0, 0), 1e-12);
  cag_curve_release(parts[0]);
  cag_curve_release(parts[1]);
  cag_curve_release(joined);
  cag_curve_release(exact);
}

static void polylines_have_corners_on_both_sides(void **state) {
  (void)state;
  static const CagVec3 square[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  CagCurve *c;
  CagVec3 d[2];
  OK(cag_curve_polyline(square, 4, true, 2, &c, &err));
  assert_true(c->end == 4 && c->closed);
  OK(cag_curve_eval(c, 1, 1, CAG_SIDE_LEFT, d, &err));
  near_vec(d[1], cag_vec3(1, 0, 0), 0);
  OK(cag_curve_eval(c, 1, 1, CAG_SIDE_RIGHT, d, &err));
  near_vec(d[1], cag_vec3(0, 1, 0), 0);
  near_vec(at(c, 4), at(c, 0), 0);
  const CagVec3 *points;
  size_t n;
  bool ring;
  assert_true(cag_curve_vertices(c, &points, &n, &ring));
  assert_true(n == 4 && ring);
  cag_curve_release(c);
}

// Inner knots 1e-7 apart; control points (7 i^2 + 3 i) mod 11, (5 i^2 + i) mod 7. Derivatives by
// exact fractions, at 1 + 2^-25 between the knots and from the right at the first one.
static void derivatives_keep_their_digits_between_close_knots(void **state) {
  (void)state;
  static const double knots3[] = {0, 0, 0, 0, 1, 1 + 1e-7, 2, 2, 2, 2};
  static const double knots5[] = {0, 0, 0, 0, 0, 0, 1, 1 + 1e-7, 1.5, 2, 2, 2, 2, 2, 2};
  static const struct {
    int degree;
    size_t n;
    const double *knots;
    double t, expected[3][2];
    int orders;
  } cases[] = {
      {3,
       6,
       knots3,
       1 + 0x1p-25,
       {{7.499998153389552, 7.499998664779049},
        {38.60162254798628, 16.389765259691984},
        {-1019999876.4044732, -959999924.4394981}},
       3},
      {3,
       6,
       knots3,
       1,
       {{7.499996550000613, 7.499997750000373},
        {68.99998770000177, 44.99999250000104},
        {-1019999876.4044732, -959999924.4394981}},
       3},
      {5,
       9,
       knots5,
       1 + 0x1p-25,
       {{-2.3148148699525453, -3.148148123247141},
        {-11.481482042518635, 5.185184235736654},
        {158.8888346429665, 268.88882894412495}},
       3},
      {5,
       9,
       knots5,
       1,
       {{-2.3148145277776453, -3.148148277777554},
        {-11.48148677777414, 5.185176222225625},
        {158.88877966669966, 268.88878666669234}},
       3},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagVec3 p[9], d[4], many[4];
    for (size_t k = 0; k < cases[i].n; k++)
      p[k] = cag_vec3((double)((7 * k * k + 3 * k) % 11), (double)((5 * k * k + k) % 7), 0);
    CagCurve *c;
    OK(cag_curve_nurbs(p, NULL, cases[i].n, cases[i].degree, cases[i].knots, 2, &c, &err));
    OK(cag_curve_eval(c, cases[i].t, cases[i].orders, CAG_SIDE_RIGHT, d, &err));
    OK(cag_curve_eval_many(c, &cases[i].t, 1, cases[i].orders, many, &err));
    for (int k = 0; k < cases[i].orders; k++) {
      const CagVec3 exact = {cases[i].expected[k][0], cases[i].expected[k][1], 0};
      // The rounding of t between the knots is 2e-9 of their distance.
      near_vec(d[k + 1], exact, 1e-12 * cag_norm(exact));
      near_vec(many[k + 1], exact, 1e-12 * cag_norm(exact));
    }
    OK(cag_curve_point(c, cases[i].t, &many[0], &err));
    near_vec(d[0], many[0], 0);
    cag_curve_release(c);
  }
}

// If the control points are evenly spaced on a line, the curve is that line, for any degree.
static void curves_have_at_most_the_greatest_degree(void **state) {
  (void)state;
  enum { N = CAG_MAX_DEGREE + 2 };
  static CagVec3 p[N];
  CagCurve *c;
  for (int i = 0; i < N; i++)
    p[i] = cag_vec3(2.0 * i / CAG_MAX_DEGREE, -1.0 * i / CAG_MAX_DEGREE, 0);
  OK(cag_curve_bezier(p, NULL, N - 1, 2, &c, &err));
  for (int k = 0; k <= 8; k++) {
    CagVec3 at;
    OK(cag_curve_point(c, k / 8.0, &at, &err));
    near_vec(at, cag_vec3(k / 4.0, -k / 8.0, 0), 1e-12);
  }
  cag_curve_release(c);
  FAILS(cag_curve_bezier(p, NULL, N, 2, &c, &err), "order-range");
  assert_string_equal(err.message, "the degree must be at most 1000, found 1001");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_reference_curves_have_their_points_and_derivatives),
      cmocka_unit_test(derivatives_agree_with_differences),
      cmocka_unit_test(reversing_trimming_and_stretching_keep_the_points),
      cmocka_unit_test(transforming_the_curve_transforms_its_points),
      cmocka_unit_test(projecting_the_curve_projects_its_points),
      cmocka_unit_test(the_exact_nurbs_form_has_the_same_points),
      cmocka_unit_test(a_closed_spline_meets_itself_bit_for_bit),
      cmocka_unit_test(circles_and_arcs_hit_special_angles_exactly),
      cmocka_unit_test(a_circle_as_nurbs_has_four_quarters),
      cmocka_unit_test(high_degrees_are_stable),
      cmocka_unit_test(derivatives_above_the_degree_are_zero),
      cmocka_unit_test(rational_derivatives_of_any_order_are_right),
      cmocka_unit_test(frenet_frames_are_those_of_the_reference),
      cmocka_unit_test(tangents_have_their_limit_where_the_speed_is_zero),
      cmocka_unit_test(parameters_outside_the_domain_fail_with_the_domain),
      cmocka_unit_test(rounding_at_the_ends_of_a_domain_counts_as_the_end),
      cmocka_unit_test(closed_curves_are_trimmed_over_the_seam_up_to_a_turn),
      cmocka_unit_test(bad_data_are_named),
      cmocka_unit_test(joining_wants_ends_that_meet),
      cmocka_unit_test(a_composite_has_an_exact_nurbs_form),
      cmocka_unit_test(derivatives_keep_their_digits_between_close_knots),
      cmocka_unit_test(polylines_have_corners_on_both_sides),
      cmocka_unit_test(curves_have_at_most_the_greatest_degree),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
