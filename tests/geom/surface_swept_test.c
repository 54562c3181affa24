// Surfaces made from curves: revolved, ruled, extruded, and translational surfaces, and tubes.

#include "surface_support.h"

static CagCurve *new_line(CagVec3 p, CagVec3 q) {
  CagCurve *c;
  MUST(cag_curve_line(p, q, 3, &c, err));
  return c;
}

static CagCurve *new_arc(double a, double b, double from, double to, CagVec3 x, CagVec3 y,
                         CagVec3 center) {
  CagTransform frame = cag_transform_identity();
  CagVec3 z = cag_cross(x, y);
  const CagVec3 columns[4] = {x, y, z, center};
  for (int j = 0; j < 4; j++) {
    frame.m[0][j] = columns[j].x;
    frame.m[1][j] = columns[j].y;
    frame.m[2][j] = columns[j].z;
  }
  frame.planar = false;
  CagCurve *c;
  MUST(cag_curve_arc(a, b, from, to, &frame, &c, err));
  return c;
}

// Checks that every point of the exact form is on the surface of revolution: it has the radius and
// height of the profile at its u.
static void assert_exact_revolution(const CagSurface *s) {
  CagSurface *exact;
  MUST(cag_surface_to_nurbs(s, &exact, err));
  const CagCurve *profile;
  CagVec3 axis, through;
  assert_true(cag_surface_revolution_view(s, &profile, &axis, &through, NULL, NULL));
  for (int i = 0; i <= 20; i++)
    for (int j = 0; j <= 20; j++) {
      double u = exact->u0 + (exact->u1 - exact->u0) * i / 20;
      CagVec3 p = surface_at(exact, u, exact->v0 + (exact->v1 - exact->v0) * j / 20);
      CagVec3 start = surface_at(exact, u, exact->v0);
      CagVec3 d = cag_sub(p, through), e = cag_sub(start, through);
      assert_near(cag_dot(d, axis), cag_dot(e, axis), 1e-12, "height");
      assert_near(cag_norm(cag_cross(d, axis)), cag_norm(cag_cross(e, axis)), 1e-12, "radius");
    }
  double a, b;
  MUST(cag_surface_area(s, &a, NULL, err));
  MUST(cag_surface_area(exact, &b, NULL, err));
  assert_near(b, a, 1e-8, "area of the exact form");
  cag_surface_release(exact);
}

// revolve.ex1, revolve.frustum-claim
static void a_line_revolves_to_a_frustum(void **state) {
  (void)state;
  CagCurve *c = new_line(cag_vec3(1, 1, 0), cag_vec3(6, 2, 0));
  CagSurface *s;
  MUST(cag_surface_revolve(c, cag_vec3(1, 0, 0), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, err));
  CagVec3 d[4];
  double u = (s->u0 + s->u1) / 2, length = s->u1 - s->u0;
  MUST(cag_surface_eval(s, u, M_PI / 3, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
  assert_point(d[0], cag_vec3(3.5, 0.75, 1.2990381056766578), 1e-12, "point");
  assert_point(cag_scaled(d[cag_partial(1, 1, 0)], length), cag_vec3(5, 0.5, 0.8660254037844385),
               1e-12, "d_t");
  assert_point(d[cag_partial(1, 0, 1)], cag_vec3(0, -1.2990381056766578, 0.75), 1e-12, "d_phi");
  assert_true(s->closed_v && !s->closed_u && !s->pole_u0);
  assert_area(s, M_PI * (1 + 2) * sqrt(26));
  assert_consistent(s);
  assert_transforms(s);
  assert_exact_revolution(s);
  cag_surface_release(s);
  MUST_FAIL(cag_surface_revolve(c, cag_vec3(0, 0, 0), cag_vec3(0, 0, 0), 0, 1, &s, err),
            "zero-axis");
  MUST_FAIL(cag_surface_revolve(c, cag_vec3(1, 0, 0), cag_vec3(0, 0, 0), 1, 1, &s, err),
            "empty-range");
  cag_curve_release(c);
}

static void a_semicircle_revolves_to_a_sphere_with_normals_at_its_poles(void **state) {
  (void)state;
  double r = 3;
  CagCurve *c =
      new_arc(r, r, -M_PI / 2, M_PI / 2, cag_vec3(1, 0, 0), cag_vec3(0, 0, 1), cag_vec3(0, 0, 0));
  CagSurface *s;
  MUST(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, err));
  assert_true(s->pole_u0 && s->pole_u1 && s->closed_v && cag_surface_is_closed(s));
  assert_area(s, 4 * M_PI * r * r);
  assert_bounds(s, cag_vec3(-r, -r, -r), cag_vec3(r, r, r));
  // revolve.pole-normal; the profile runs up, so the normal is inward (reference 06a, 6.2).
  for (int k = 0; k < 4; k++) {
    CagVec3 n;
    MUST(cag_surface_normal(s, s->u0, inside(0, 2 * M_PI, k), &n, err));
    assert_point(n, cag_vec3(0, 0, 1), 1e-12, "south pole");
    MUST(cag_surface_normal(s, s->u1, inside(0, 2 * M_PI, k), &n, err));
    assert_point(n, cag_vec3(0, 0, -1), 1e-12, "north pole");
  }
  assert_consistent(s);
  assert_exact_revolution(s);
  CagSurface *exact;
  MUST(cag_surface_to_nurbs(s, &exact, err));
  CagSurfaceNurbsView view;
  assert_true(cag_surface_nurbs_view(exact, &view));
  assert_int_equal(view.nv, 9);
  CagVec3 n;
  // rational-surface.fig59.pole
  MUST(cag_surface_normal(exact, exact->u0, 0.7, &n, err));
  assert_point(n, cag_vec3(0, 0, 1), 1e-9, "pole of the exact form");
  assert_true(exact->pole_u0 && exact->closed_v);
  cag_surface_release(exact);
  double terms[10] = {0};
  MUST(cag_surface_volume_terms(s, terms, err));
  assert_near(terms[0], -4 * M_PI / 3 * 27, 1e-9, "volume");
  assert_near(terms[4], -4 * M_PI / 15 * 243, 1e-9, "second moment");
  cag_surface_release(s);
  cag_curve_release(c);
}

// rational-surface.fig57.revolution: a rational profile, its exact net.
static void a_rational_profile_has_the_net_of_the_reference(void **state) {
  (void)state;
  const CagVec3 points[] = {{1, 0, 0}, {3, 0, 1}, {0.5, 0, 3}, {2, 0, 5}};
  const double weights[] = {1, 2, 1, 1}, knots[] = {0, 0, 0, 1, 2, 2, 2};
  CagCurve *c;
  CagSurface *s, *exact;
  MUST(cag_curve_nurbs(points, weights, 4, 2, knots, 3, &c, err));
  MUST(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, err));
  MUST(cag_surface_to_nurbs(s, &exact, err));
  // In the reference, u runs around the axis; here, v does.
  assert_point(surface_at(exact, 0.8, 1.3),
               cag_vec3(-1.0870246390978302, 2.2106083085251864, 1.3658536585365855), 1e-12,
               "point");
  assert_exact_revolution(s);
  assert_consistent(s);
  cag_surface_release(exact);
  cag_surface_release(s);
  cag_curve_release(c);
}

static void partial_turns_are_exact_and_keep_their_angle(void **state) {
  (void)state;
  CagCurve *c = new_arc(2, 1, 0.3, 2.1, cag_vec3(1, 0, 0), cag_vec3(0, 0, 1), cag_vec3(5, 0, 1));
  CagSurface *s, *exact;
  MUST(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(1, 1, 0), 0.4, 2.9, &s, err));
  assert_false(s->closed_v);
  assert_exact_revolution(s);
  MUST(cag_surface_to_nurbs(s, &exact, err));
  assert_point(surface_at(exact, exact->u0, exact->v0), surface_at(s, s->u0, s->v0), 1e-12,
               "corner");
  assert_point(surface_at(exact, exact->u1, exact->v1), surface_at(s, s->u1, s->v1), 1e-12,
               "corner");
  assert_consistent(s);
  assert_transforms(s);
  cag_surface_release(exact);
  cag_surface_release(s);
  cag_curve_release(c);
}

// bilinear.ex9
static void a_bilinear_surface_is_a_saddle(void **state) {
  (void)state;
  CagSurface *s, *exact;
  MUST(cag_surface_bilinear(cag_vec3(0, 0, 1), cag_vec3(1, 1, 1), cag_vec3(1, 0, 0),
                            cag_vec3(0, 1, 0), &s, err));
  const Partials e = {{0.5, 0.5, 0.5}, {0, 0, -1}, {0, 1, 0}, {-2, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  assert_partials(s, 0.5, 0.5, &e);
  assert_consistent(s);
  assert_transforms(s);
  MUST(cag_surface_to_nurbs(s, &exact, err));
  assert_partials(exact, 0.5, 0.5, &e);
  cag_surface_release(exact);
  cag_surface_release(s);
}

// ruled.ex10
static void ruled_surfaces_walk_both_curves_by_fractions(void **state) {
  (void)state;
  const CagVec3 p0[] = {{0, 0, 0}, {1, 1, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}};
  const CagVec3 p1[] = {{0, 0, 6}, {1, 1, 6}, {2, 1, 6}, {3, 0, 6}};
  const double k0[] = {0, 0, 0, 1, 2, 3, 3, 3}, k1[] = {0, 0, 0, 1, 2, 2, 2};
  CagCurve *c0, *c1;
  CagSurface *s, *exact;
  MUST(cag_curve_nurbs(p0, NULL, 5, 2, k0, 3, &c0, err));
  MUST(cag_curve_nurbs(p1, NULL, 4, 2, k1, 3, &c1, err));
  MUST(cag_surface_ruled(c1, c0, &s, err));
  CagVec3 d[4];
  MUST(cag_surface_eval(s, 0.5, 0.5, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
  assert_point(d[0], cag_vec3(1.3125, 1, 3), 1e-12, "point");
  assert_point(d[cag_partial(1, 1, 0)], cag_vec3(0.375, 0, 6), 1e-12, "d_u");
  assert_point(d[cag_partial(1, 0, 1)], cag_vec3(1.75, 0, 0), 1e-12, "d_w");
  assert_consistent(s);
  assert_transforms(s);
  double breaks[8];
  assert_int_equal(s->kind->breaks(s, 1, breaks, 8), 3);
  assert_near(breaks[0], 1.0 / 3, 1e-15, "break");
  MUST(cag_surface_to_nurbs(s, &exact, err));
  for (int i = 0; i <= 10; i++)
    for (int j = 0; j <= 10; j++)
      assert_point(surface_at(exact, i / 10.0, j / 10.0), surface_at(s, i / 10.0, j / 10.0), 1e-12,
                   "exact form");
  cag_surface_release(exact);
  cag_surface_release(s);
  cag_curve_release(c0);
  cag_curve_release(c1);
}

// rational-surface.ex18
static void ruled_nurbs_form_raises_the_lower_degree(void **state) {
  (void)state;
  const CagVec3 p1[] = {{0, 0, 0}, {1, 1.7320508075688772, 0}, {2, 0, 0}};
  const CagVec3 p2[] = {{0, 0, 10}, {1, 1, 10}, {2, 0, 10}, {3, 1, 10}};
  const double w1[] = {1, 0.5, 1}, w2[] = {1, 0.75, 5, 1};
  CagCurve *c1, *c2;
  CagSurface *s, *exact;
  MUST(cag_curve_bezier(p1, w1, 3, 3, &c1, err));
  MUST(cag_curve_bezier(p2, w2, 4, 3, &c2, err));
  MUST(cag_surface_ruled(c2, c1, &s, err));
  MUST(cag_surface_to_nurbs(s, &exact, err));
  CagSurfaceNurbsView view;
  assert_true(cag_surface_nurbs_view(exact, &view));
  assert_int_equal(view.degree_v, 3);
  const CagVec3 raised[] = {
      {0, 0, 0}, {0.5, 0.8660254037844386, 0}, {1.5, 0.8660254037844386, 0}, {2, 0, 0}};
  for (int j = 0; j < 4; j++) {
    const double *h = view.homogeneous + 4 * j;
    assert_near(h[3], j == 0 || j == 3 ? 1 : 2.0 / 3, 1e-14, "weight");
    assert_point(cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]), raised[j], 1e-14, "net");
  }
  const Partials e = {{1.6336633663366336, 0.26590501446090115, 7.623762376237623},
                      {0.6022938927556122, -0.296027172811461, 7.246348397215959},
                      {1.8947162042936967, -0.20913179678229624, 2.3997647289481425},
                      {-1.3419922915730451, 0.10017939738285726, -5.037129926108972},
                      {-1.2642208441998988, 0.6213639666933637, -15.210157031780033},
                      {-5.771858903369015, 0.341777417223832, -18.147706349891926}};
  assert_partials(exact, 0.5, 0.5, &e);
  cag_surface_release(exact);
  cag_surface_release(s);
  cag_curve_release(c1);
  cag_curve_release(c2);
}

static void extrusions_twist_and_scale(void **state) {
  (void)state;
  CagCurve *c =
      new_arc(2, 1, 0, 2 * M_PI, cag_vec3(1, 0, 0), cag_vec3(0, 1, 0), cag_vec3(0.5, 0, 0));
  CagSurface *plain, *twisted, *tapered, *exact;
  MUST(cag_surface_extrude(c, cag_vec3(1, 0, 5), 0, 1, &plain, err));
  MUST(cag_surface_extrude(c, cag_vec3(0, 0, 5), M_PI / 2, 0.5, &twisted, err));
  MUST(cag_surface_extrude(c, cag_vec3(0, 1, 5), 0, 0.25, &tapered, err));
  assert_point(surface_at(twisted, 0, 1), cag_vec3(0, 1.25, 5), 1e-14, "end of the twist");
  CagSurface *all[] = {plain, twisted, tapered};
  for (int k = 0; k < 3; k++) {
    assert_true(all[k]->closed_u);
    assert_consistent(all[k]);
    assert_transforms(all[k]);
  }
  MUST(cag_surface_to_nurbs(tapered, &exact, err));
  // On the exact form: the ellipse of the section, scaled by 1 - 3/4 v and moved along by v.
  for (int i = 0; i <= 12; i++)
    for (int j = 0; j <= 4; j++) {
      double v = j / 4.0, k = 1 - 0.75 * v;
      CagVec3 p = surface_at(exact, exact->u0 + (exact->u1 - exact->u0) * i / 12, v);
      double x = (p.x / k - 0.5) / 2, y = (p.y - v) / k;
      assert_near(p.z, 5 * v, 1e-13, "height");
      assert_near(x * x + y * y, 1, 1e-12, "section");
    }
  cag_surface_release(exact);
  MUST_FAIL(cag_surface_to_nurbs(twisted, &exact, err), "no-exact-form");
  for (int k = 0; k < 3; k++) cag_surface_release(all[k]);
  MUST_FAIL(cag_surface_extrude(c, cag_vec3(0, 0, 0), 0, 1, &plain, err), "degenerate-direction");
  MUST_FAIL(cag_surface_extrude(c, cag_vec3(0, 0, 1), 0, -1, &plain, err), "scale-negative");
  cag_curve_release(c);
}

static void translational_surfaces_add_curves(void **state) {
  (void)state;
  CagCurve *a = new_arc(2, 2, 0, 1, cag_vec3(1, 0, 0), cag_vec3(0, 1, 0), cag_vec3(0, 0, 0));
  CagCurve *b = new_arc(1, 3, 0.2, 2, cag_vec3(0, 1, 0), cag_vec3(0, 0, 1), cag_vec3(1, 1, 1));
  CagSurface *s, *exact;
  MUST(cag_surface_translational(a, b, &s, err));
  assert_consistent(s);
  assert_transforms(s);
  MUST(cag_surface_to_nurbs(s, &exact, err));
  double area, other;
  MUST(cag_surface_area(s, &area, NULL, err));
  MUST(cag_surface_area(exact, &other, NULL, err));
  assert_near(other, area, 1e-8, "area");
  assert_point(surface_at(exact, exact->u1, exact->v1), surface_at(s, s->u1, s->v1), 1e-12,
               "corner");
  cag_surface_release(exact);
  cag_surface_release(s);
  cag_curve_release(a);
  cag_curve_release(b);
}

static void the_torus_has_its_area_volume_and_implicit_form(void **state) {
  (void)state;
  double R = 3, r = 1;
  CagSurface *s, *exact;
  MUST(cag_surface_torus(R, r, &s, err));
  assert_area(s, 4 * M_PI * M_PI * R * r);
  double terms[10] = {0};
  MUST(cag_surface_volume_terms(s, terms, err));
  assert_near(terms[0], 2 * M_PI * M_PI * R * r * r, 1e-9, "volume, positive: outward");
  assert_bounds(s, cag_vec3(-4, -4, -1), cag_vec3(4, 4, 1));
  assert_true(cag_surface_is_closed(s));
  assert_consistent(s);
  assert_transforms(s);
  MUST(cag_surface_to_nurbs(s, &exact, err));
  for (int i = 0; i <= 24; i++)
    for (int j = 0; j <= 24; j++) {
      CagVec3 p = surface_at(exact, 4.0 * i / 24, 4.0 * j / 24);
      double q = hypot(p.x, p.y) - R;
      assert_near(q * q + p.z * p.z, r * r, 1e-13, "implicit form");
    }
  cag_surface_release(exact);
  cag_surface_release(s);
  MUST_FAIL(cag_surface_torus(3, -1, &s, err), "size-not-positive");
}

// --- Tubes ---

static void a_tube_keeps_its_radius_square_to_the_path(void **state) {
  (void)state;
  CagCurve *helix;
  CagSurface *s;
  double radius = 5, pitch = 4, turns = 2.5, r = 0.8;
  MUST(cag_curve_helix(radius, pitch, turns, 0, &helix, err));
  MUST(cag_surface_tube(helix, r, &s, err));
  assert_consistent(s);
  assert_transforms(s);
  for (int j = 0; j <= 40; j++) {
    double v = s->v0 + (s->v1 - s->v0) * j / 40;
    CagVec3 c[2], d[9];
    MUST(cag_curve_eval(helix, v, 1, CAG_SIDE_RIGHT, c, err));
    for (int i = 0; i < 8; i++) {
      MUST(cag_surface_eval(s, i * M_PI / 4, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
      CagVec3 spoke = cag_sub(d[0], c[0]);
      assert_near(cag_norm(spoke), r, 1e-12, "radius");
      assert_near(cag_dot(spoke, c[1]) / cag_norm(c[1]), 0, 1e-12, "square to the tangent");
      // Rotation minimizing: the spokes move only along the tangent, so S_v is parallel to it.
      CagVec3 along = cag_cross(d[cag_partial(2, 0, 1)], cag_unit(c[1]));
      assert_near(cag_norm(along) / cag_norm(c[1]), 0, 1e-10, "no turn about the tangent");
    }
  }
  // The frame rotates relative to Frenet's by minus torsion times length (reference 06a, 6.3).
  double b = pitch / (2 * M_PI), torsion = b / (radius * radius + b * b);
  double length = hypot(radius, b) * 2 * M_PI * turns;
  double angle[2];
  for (int k = 0; k < 2; k++) {
    CagFrenet f;
    double v = k == 0 ? s->v0 : s->v1;
    MUST(cag_curve_frenet(helix, v, &f, err));
    CagVec3 spoke = cag_sub(surface_at(s, 0, v), f.point);
    angle[k] = atan2(cag_dot(spoke, f.binormal), cag_dot(spoke, f.normal));
  }
  assert_near(remainder(angle[1] - angle[0] + torsion * length, 2 * M_PI), 0, 1e-9, "turn");
  // Pappus: the tube of a curve of constant curvature has the area of a straight one.
  assert_area(s, 2 * M_PI * r * length);
  cag_surface_release(s);
  MUST_FAIL(cag_surface_tube(helix, 0, &s, err), "size-not-positive");
  cag_curve_release(helix);
}

static void a_tube_along_a_circle_is_a_torus(void **state) {
  (void)state;
  CagCurve *c = new_arc(4, 4, 0, 2 * M_PI, cag_vec3(0, 1, 0), cag_vec3(0, 0, 1), cag_vec3(1, 2, 3));
  CagSurface *s;
  MUST(cag_surface_tube(c, 1, &s, err));
  assert_true(s->closed_u && s->closed_v && cag_surface_is_closed(s));
  assert_area(s, 16 * M_PI * M_PI);
  for (int i = 0; i < 5; i++)
    assert_point(surface_at(s, i, s->v0), surface_at(s, i, s->v1), 1e-12, "seam");
  cag_surface_release(s);
  cag_curve_release(c);
}

// On a closed path that is not planar, the frame returns rotated, but the seam must still meet.
static void closed_tubes_give_back_the_closing_twist(void **state) {
  (void)state;
  CagVec3 points[7];
  for (int i = 0; i < 7; i++)
    points[i] = cag_vec3(5 * cos(i * 2 * M_PI / 7), 4 * sin(i * 2 * M_PI / 7), 2 * sin(i * 1.9));
  CagCurve *c;
  CagSurface *s;
  MUST(cag_curve_nurbs_closed(points, NULL, 7, 3, 3, &c, err));
  MUST(cag_surface_tube(c, 0.5, &s, err));
  for (int i = 0; i < 7; i++) {
    CagVec3 a[4], b[4];
    MUST(cag_surface_eval(s, i, s->v0, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, a, err));
    MUST(cag_surface_eval(s, i, s->v1, 1, CAG_SIDE_RIGHT, CAG_SIDE_LEFT, b, err));
    assert_point(b[0], a[0], 1e-11, "seam");
    assert_point(b[cag_partial(1, 0, 1)], a[cag_partial(1, 0, 1)], 1e-9, "S_v across the seam");
  }
  assert_consistent(s);
  cag_surface_release(s);
  cag_curve_release(c);
}

// Two straight pieces cut by the bisecting plane: each is a cylinder of the length of its axis.
static void tubes_are_mitered_at_corners(void **state) {
  (void)state;
  const CagVec3 points[] = {{0, 0, 0}, {10, 0, 0}, {10, 6, 0}, {10, 6, 8}};
  CagCurve *c;
  CagSurface *s;
  MUST(cag_curve_polyline(points, 4, false, 3, &c, err));
  MUST(cag_surface_tube(c, 1, &s, err));
  double breaks[4];
  assert_int_equal(s->kind->breaks(s, 1, breaks, 4), 2);
  for (int i = 0; i < 9; i++)
    for (int k = 0; k < 2; k++) {
      CagVec3 a, b;
      MUST(cag_surface_eval(s, i * 0.7, breaks[k], 0, CAG_SIDE_RIGHT, CAG_SIDE_LEFT, &a, err));
      MUST(cag_surface_eval(s, i * 0.7, breaks[k], 0, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, &b, err));
      assert_point(a, b, 1e-13, "both sides of the corner");
    }
  assert_area(s, 2 * M_PI * 24);
  // A point halfway along the first piece is at distance 1 from its axis.
  CagVec3 p = surface_at(s, 1, breaks[0] / 2);
  assert_near(hypot(p.y, p.z), 1, 1e-13, "cylinder");
  assert_consistent(s);
  cag_surface_release(s);
  cag_curve_release(c);
  const CagVec3 back[] = {{0, 0, 0}, {10, 0, 0}, {5, 0, 0}};
  MUST(cag_curve_polyline(back, 3, false, 3, &c, err));
  MUST_FAIL(cag_surface_tube(c, 1, &s, err), "path-turns-back");
  cag_curve_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_line_revolves_to_a_frustum),
      cmocka_unit_test(a_semicircle_revolves_to_a_sphere_with_normals_at_its_poles),
      cmocka_unit_test(a_rational_profile_has_the_net_of_the_reference),
      cmocka_unit_test(partial_turns_are_exact_and_keep_their_angle),
      cmocka_unit_test(a_bilinear_surface_is_a_saddle),
      cmocka_unit_test(ruled_surfaces_walk_both_curves_by_fractions),
      cmocka_unit_test(ruled_nurbs_form_raises_the_lower_degree),
      cmocka_unit_test(extrusions_twist_and_scale),
      cmocka_unit_test(translational_surfaces_add_curves),
      cmocka_unit_test(the_torus_has_its_area_volume_and_implicit_form),
      cmocka_unit_test(a_tube_keeps_its_radius_square_to_the_path),
      cmocka_unit_test(a_tube_along_a_circle_is_a_torus),
      cmocka_unit_test(closed_tubes_give_back_the_closing_twist),
      cmocka_unit_test(tubes_are_mitered_at_corners),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
