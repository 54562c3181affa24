// Surfaces: worked examples of the reference, closed forms, and what must hold for every kind.

#include "geom/surface/loft.h"
#include "geom/surface/patches.h"
#include "geom/surface/reshape.h"
#include "surface_support.h"

// The net of reference example 14 (06b, bezier-surface.ex14); `moved` replaces B11.
static void ex14_net(CagVec3 net[16], bool moved) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      bool corner = (i == 0 || i == 3) && (j == 0 || j == 3);
      net[4 * i + j] = cag_vec3(-15 + 10 * i, corner ? 0 : 5, 15 - 10 * j);
    }
  if (moved) net[5] = cag_vec3(0, 10, 0);
}

typedef struct Expected {
  CagVec3 point, du, dv, duv, duu, dvv;
} Expected;

static void assert_partials(const CagSurface *s, double u, double v, const Expected *e) {
  CagVec3 d[9];
  MUST(cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
  assert_point(d[0], e->point, 1e-9, "point");
  assert_point(d[cag_partial(2, 1, 0)], e->du, 1e-9, "du");
  assert_point(d[cag_partial(2, 0, 1)], e->dv, 1e-9, "dv");
  assert_point(d[cag_partial(2, 1, 1)], e->duv, 1e-9, "duv");
  assert_point(d[cag_partial(2, 2, 0)], e->duu, 1e-9, "duu");
  assert_point(d[cag_partial(2, 0, 2)], e->dvv, 1e-9, "dvv");
}

// bezier-surface.ex14, bezier-surface.ex14.modified
static void bezier_patches_have_the_partials_of_the_worked_example(void **state) {
  (void)state;
  const Expected base = {{0, 4.6875, 0}, {30, 0, 0},   {0, 0, -30},
                         {0, 0, 0},      {0, -7.5, 0}, {0, -7.5, 0}};
  const Expected moved = {{0.703125, 5.390625, -0.703125}, {28.59375, -1.40625, 1.40625},
                          {-1.40625, -1.40625, -28.59375}, {2.8125, 2.8125, -2.8125},
                          {-5.625, -13.125, 5.625},        {-5.625, -13.125, 5.625}};
  for (int k = 0; k < 2; k++) {
    CagVec3 net[16];
    CagSurface *s;
    ex14_net(net, k == 1);
    MUST(cag_surface_bezier(net, NULL, 4, 4, &s, err));
    assert_string_equal(s->kind->name, "bezier");
    assert_partials(s, 0.5, 0.5, k == 1 ? &moved : &base);
    assert_consistent(s);
    assert_transforms(s);
    cag_surface_release(s);
  }
}

// bezier-surface.fig40.5x3
static void bezier_patches_may_have_different_degrees(void **state) {
  (void)state;
  const CagVec3 net[] = {{0, 0, 0}, {0, 2, 4}, {0, 0, 8},  {3, 2, 0},  {3, 4, 4},
                         {3, 2, 8}, {6, 5, 0}, {6, 3, 4},  {6, 2, 8},  {9, 2, 0},
                         {9, 4, 4}, {9, 2, 8}, {12, 0, 0}, {12, 2, 4}, {12, 0, 8}};
  const Expected e = {{3, 2.412109375, 4}, {12, 3.53125, 0}, {0, -0.6328125, 8},
                      {0, -3.375, 0},      {0, -15.375, 0},  {0, -5.890625, 0}};
  CagSurface *s;
  MUST(cag_surface_bezier(net, NULL, 5, 3, &s, err));
  assert_partials(s, 0.25, 0.5, &e);
  assert_consistent(s);
  cag_surface_release(s);
}

// bspline-surface.ex15
static void bspline_surface_of_example_15(void **state) {
  (void)state;
  CagVec3 net[16];
  ex14_net(net, false);
  for (int i = 1; i < 3; i++)
    for (int j = 1; j < 3; j++) net[4 * i + j].y = 10;
  const double ku[] = {0, 0, 0, 0, 1, 1, 1, 1}, kv[] = {0, 0, 0, 1, 2, 2, 2};
  CagSurface *s;
  MUST(cag_surface_nurbs(net, NULL, 4, 4, 3, 2, ku, kv, &s, err));
  assert_string_equal(s->kind->name, "bspline");
  assert_point(surface_at(s, 0.5, 1), cag_vec3(0, 8.75, 0), 1e-12, "point");
  char text[80];
  s->kind->describe(s, text, sizeof text);
  assert_string_equal(text, "degree 3 x 2, 4 x 4 points");
  cag_surface_release(s);
}

static const CagVec3 RATIONAL[] = {{-20, 0, 15}, {-20, 4, 5}, {-20, 4, -5}, {-20, 0, -15},
                                   {-10, 3, 15}, {-10, 8, 5}, {-10, 8, -5}, {-10, 2, -15},
                                   {0, 2, 15},   {0, 7, 5},   {0, 9, -5},   {0, 3, -15},
                                   {10, 3, 15},  {10, 6, 5},  {10, 8, -5},  {10, 2, -15},
                                   {20, 0, 15},  {20, 4, 5},  {20, 4, -5},  {20, 0, -15}};
static const double RATIONAL_WEIGHTS[] = {1, 2, 1, 1, 1, 3, 1, 1, 2, 1,
                                          4, 1, 1, 1, 1, 1, 1, 1, 1, 3};
static const double RATIONAL_U[] = {0, 0, 0, 0, 1, 2, 2, 2, 2}, CUBIC[] = {0, 0, 0, 0, 1, 1, 1, 1};

// rational-surface.derivatives
static void rational_surfaces_follow_the_quotient_rule(void **state) {
  (void)state;
  const Expected e = {{-5.037430702833471, 6.701738575276921, 3.786581286567784},
                      {13.310747226441878, 0.04967234165335072, -1.6062360884621785},
                      {2.1331751041756997, 5.499495136248865, -25.000056549492886},
                      {-1.63232194644396, 5.913817651680027, -15.167514214282214},
                      {-8.656501410371096, -6.212149553017374, 1.4136071872400442},
                      {18.36075298969561, -27.583087678362475, 22.856607586374196}};
  CagSurface *s;
  MUST(cag_surface_nurbs(RATIONAL, RATIONAL_WEIGHTS, 5, 4, 3, 3, RATIONAL_U, CUBIC, &s, err));
  assert_partials(s, 0.7, 0.35, &e);
  assert_consistent(s);
  assert_transforms(s);
  cag_surface_release(s);
}

// bspline-surface.fig48.closed-torus: lines around x, each a closed polygon.
static void closed_surfaces_meet_themselves(void **state) {
  (void)state;
  const double px[] = {0, 2, 2, 2, 0, -2, -2, -2}, py[] = {4, 4, 6, 8, 8, 8, 6, 4};
  CagVec3 net[64];
  for (int i = 0; i < 8; i++)
    for (int j = 0; j < 8; j++)
      net[8 * i + j] = cag_vec3(px[j], py[j] * cos(i * M_PI / 4), py[j] * sin(i * M_PI / 4));
  CagSurface *s;
  MUST(cag_surface_nurbs_closed(net, NULL, 8, 8, 3, 3, NULL, NULL, true, true, &s, err));
  const Expected e = {{1.9583333333333333, 1.7389915377765535, 4.1982969553522},
                      {0, -3.303955849694966, 1.368543322425578},
                      {0.25, 0.6036168974100433, 1.4572601002048957},
                      {0, -1.1468276503073436, 0.4750315664617709},
                      {0, -1.0441633551488438, -2.5208333333333335},
                      {-1, 0.34492394137716764, 0.8327200572599405}};
  assert_near(s->u1 - s->u0, 8, 0, "range");
  assert_true(s->closed_u && s->closed_v && cag_surface_is_closed(s));
  assert_partials(s, 0.5, 0.5, &e);
  assert_point(surface_at(s, 8, 8),
               cag_vec3(1.6666666666666667, 2.764975145650026, 2.764975145650026), 1e-12, "seam");
  assert_point(surface_at(s, 4.25, 2.5),
               cag_vec3(0.9583333333333334, -3.9887619876683544, -5.9662049987809045), 1e-12,
               "point");
  assert_consistent(s);
  cag_surface_release(s);
}

// A grid of points and derivatives over `side` by 1 against single points. Rational ones divide in
// another order.
static void assert_grid(const CagSurface *s, double side, bool rational) {
  enum { NU = 37, NV = 131 };
  double us[NU], vs[NV];
  static CagVec3 p[NU * NV], du[NU * NV], dv[NU * NV], alone[NU * NV];
  for (int i = 0; i < NU; i++) us[i] = side * i / (NU - 1);
  for (int j = 0; j < NV; j++) vs[j] = 1.0 * j / (NV - 1);
  MUST(cag_surface_eval_grid(s, us, NU, vs, NV, p, du, dv, err));
  MUST(cag_surface_eval_grid(s, us, NU, vs, NV, alone, NULL, NULL, err));
  for (int i = 0; i < NU; i++)
    for (int j = 0; j < NV; j++) {
      CagVec3 d[4];
      MUST(cag_surface_eval(s, us[i], vs[j], 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
      int at = i * NV + j;
      assert_point(p[at], d[0], rational ? 1e-14 : 0, "point");
      assert_point(alone[at], d[0], rational ? 1e-14 : 0, "point alone");
      assert_point(du[at], d[cag_partial(1, 1, 0)], rational ? 1e-13 : 0, "du");
      assert_point(dv[at], d[cag_partial(1, 0, 1)], rational ? 1e-13 : 0, "dv");
    }
}

static void a_grid_has_the_values_of_single_points_to_the_last_bit(void **state) {
  (void)state;
  for (int r = 0; r < 2; r++) {
    CagSurface *s;
    MUST(cag_surface_nurbs(RATIONAL, r ? RATIONAL_WEIGHTS : NULL, 5, 4, 3, 3, RATIONAL_U, CUBIC, &s,
                           err));
    assert_grid(s, 2, r);
    cag_surface_release(s);
  }
}

static void a_grid_of_degree_6_has_the_values_of_single_points(void **state) {
  (void)state;
  enum { ROWS = 5, COLUMNS = 7 };
  CagVec3 net[ROWS * COLUMNS];
  double weights[ROWS * COLUMNS];
  for (int i = 0; i < ROWS; i++)
    for (int j = 0; j < COLUMNS; j++) {
      net[i * COLUMNS + j] = cag_vec3(0.25 * i, j / 6.0, 0.1 * (i * i % 3) - 0.2 * (j % 2));
      weights[i * COLUMNS + j] = 1 + 0.5 * ((i + 2 * j) % 3);
    }
  for (int r = 0; r < 2; r++) {
    CagSurface *s;
    MUST(cag_surface_bezier(net, r ? weights : NULL, ROWS, COLUMNS, &s, err));
    assert_grid(s, 1, r);
    cag_surface_release(s);
  }
}

// bspline-surface.error.*, rational-surface.error.negative-weight
static void bad_nurbs_data_are_refused_by_name(void **state) {
  (void)state;
  CagVec3 net[16];
  CagSurface *s;
  ex14_net(net, false);
  const double fifth[] = {0, 0, 0, 0, 0, 1, 1, 1, 1}, falling[] = {0, 0, 0, 0, 1, 1, 0.5, 1};
  const double empty[] = {0, 0, 0, 1, 1, 2, 2, 2};
  double weights[16];
  for (int i = 0; i < 16; i++) weights[i] = i == 10 ? -1 : 1;
  MUST_FAIL(cag_surface_nurbs(net, NULL, 4, 4, 4, 3, fifth, CUBIC, &s, err), "order-range");
  MUST_FAIL(cag_surface_nurbs(net, NULL, 4, 4, 3, 3, CUBIC, falling, &s, err),
            "knots-not-monotone");
  MUST_FAIL(cag_surface_nurbs(net, NULL, 4, 4, 3, 3, empty, CUBIC, &s, err), "empty-range");
  MUST_FAIL(cag_surface_bezier(net, weights, 4, 4, &s, err), "negative-weight");
  net[7].y = NAN;
  MUST_FAIL(cag_surface_bezier(net, NULL, 4, 4, &s, err), "not-finite");
  ex14_net(net, false);
  MUST(cag_surface_bezier(net, NULL, 4, 4, &s, err));
  CagVec3 p;
  MUST_FAIL(cag_surface_point(s, -0.1, 0.5, &p, err), "parameter-range");
  MUST(cag_surface_point(s, 1 + 1e-15, 0, &p, err));
  cag_surface_release(s);
}

// bezier-surface.isocurves
static void isocurves_of_a_bezier_patch_are_bezier_curves(void **state) {
  (void)state;
  CagVec3 net[16];
  CagSurface *s;
  CagCurve *c;
  CagNurbsView view;
  ex14_net(net, false);
  MUST(cag_surface_bezier(net, NULL, 4, 4, &s, err));
  const CagVec3 u_half[] = {{0, 3.75, 15}, {0, 5, 5}, {0, 5, -5}, {0, 3.75, -15}};
  const CagVec3 v_quarter[] = {{-15, 2.8125, 7.5}, {-5, 5, 7.5}, {5, 5, 7.5}, {15, 2.8125, 7.5}};
  for (int direction = 0; direction < 2; direction++) {
    MUST(cag_surface_isocurve(s, direction, direction == 0 ? 0.5 : 0.25, &c, err));
    assert_true(cag_curve_nurbs_view(c, &view));
    for (int i = 0; i < 4; i++) {
      const double *h = view.homogeneous + 4 * i;
      assert_point(cag_vec3(h[0], h[1], h[2]), direction == 0 ? u_half[i] : v_quarter[i], 1e-12,
                   "control point");
    }
    cag_curve_release(c);
  }
  cag_surface_release(s);
}

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

// Every point of the exact form lies on the surface of revolution: same radius and height as the
// profile at its u.
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
  // There u runs around; here v does.
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
  const Expected e = {{0.5, 0.5, 0.5}, {0, 0, -1}, {0, 1, 0}, {-2, 0, 0}, {0, 0, 0}, {0, 0, 0}};
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
  const Expected e = {{1.6336633663366336, 0.26590501446090115, 7.623762376237623},
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
  // On the exact form the section's ellipse, scaled by 1 - 3/4 v and moved by v along.
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
      // Rotation minimizing: spokes move along the tangent only, so S_v is parallel to it.
      CagVec3 along = cag_cross(d[cag_partial(2, 0, 1)], cag_unit(c[1]));
      assert_near(cag_norm(along) / cag_norm(c[1]), 0, 1e-10, "no turn about the tangent");
    }
  }
  // Frame turns against Frenet's by minus torsion times length (reference 06a, 6.3).
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
  // Pappus: the tube of a curve of constant curvature has the area of the straight one.
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

// A closed path that is not plane brings the frame home turned; the seam must meet all the same.
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
  // A point half way along the first piece is at distance 1 from its axis.
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

// --- Planar pieces, isocurves ---

static void planar_pieces_measure_their_region(void **state) {
  (void)state;
  CagTransform frame, identity = cag_transform_identity();
  CagCurve *outer, *hole;
  CagRegion *region;
  CagSurface *s;
  const CagVec3 square[] = {{0, 0, 0}, {6, 0, 0}, {6, 4, 0}, {0, 4, 0}};
  MUST(cag_curve_polyline(square, 4, true, 2, &outer, err));
  identity.m[0][3] = 2;
  identity.m[1][3] = 2;
  MUST(cag_curve_arc(1, 1, 0, 2 * M_PI, &identity, &hole, err));
  MUST(cag_region_new(outer, &hole, 1, &region, err));
  MUST(cag_axes(cag_vec3(0, 0, 5), cag_vec3(1, 0, 0), cag_vec3(0, 0, 1), &frame, err));
  MUST(cag_surface_planar(region, &frame, &s, err));
  assert_area(s, 24 - M_PI);
  assert_bounds(s, cag_vec3(0, 0, 5), cag_vec3(6, 0, 9));
  assert_false(cag_surface_is_closed(s));
  CagVec3 n;
  MUST(cag_surface_normal(s, 1, 1, &n, err));
  assert_point(n, cag_vec3(0, -1, 0), 1e-15, "normal");
  CagSurface *flipped;
  MUST(cag_surface_flip(s, &flipped, err));
  MUST(cag_surface_normal(flipped, 1, 1, &n, err));
  assert_point(n, cag_vec3(0, 1, 0), 1e-15, "normal of the flip");
  assert_area(flipped, 24 - M_PI);
  assert_transforms(s);
  cag_surface_release(flipped);
  cag_surface_release(s);
  cag_region_release(region);
  cag_curve_release(outer);
  cag_curve_release(hole);
}

static void isocurves_run_on_the_surface(void **state) {
  (void)state;
  CagSurface *s;
  CagCurve *c, *part;
  double length;
  MUST(cag_surface_torus(3, 1, &s, err));
  MUST(cag_surface_isocurve(s, 1, M_PI / 2, &c, err));
  assert_true(c->closed && c->angular);
  MUST(cag_curve_length(c, c->start, c->end, &length, err));
  assert_near(length, 6 * M_PI, 1e-9, "top circle");
  MUST(cag_curve_trim(c, 1, 2, &part, err));
  MUST(cag_curve_length(part, 1, 2, &length, err));
  assert_near(length, 3, 1e-9, "its part");
  CagBounds box; // sin has its maximum inside, cos falls
  MUST(cag_curve_bounds(part, &box, err));
  assert_near(box.max.y, 3, 1e-9, "bounds");
  assert_near(box.min.y, 3 * sin(1), 1e-9, "bounds");
  assert_near(box.min.x, 3 * cos(2), 1e-9, "bounds");
  assert_near(box.max.x, 3 * cos(1), 1e-9, "bounds");
  assert_near(box.min.z, 1, 1e-12, "bounds");
  cag_curve_release(part);
  MUST(cag_curve_reverse(c, &part, err));
  CagVec3 p;
  MUST(cag_curve_point(part, 1, &p, err));
  assert_point(p, surface_at(s, 2 * M_PI - 1, M_PI / 2), 1e-14, "reversed");
  cag_curve_release(part);
  cag_curve_release(c);
  cag_surface_release(s);
}

// A paraboloid-like cap whose height has an inner maximum that no grid point hits.
static void bounds_are_tight_between_samples(void **state) {
  (void)state;
  const CagVec3 net[] = {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {1, 0, 0}, {1, 1, 5},
                         {1, 2, 1}, {2, 0, 0}, {2, 1, 2}, {2, 2, 0}};
  CagSurface *s;
  CagBounds box;
  MUST(cag_surface_bezier(net, NULL, 3, 3, &s, err));
  MUST(cag_surface_bounds(s, &box, err));
  double best = 0;
  enum { N = 1500 };
  for (int i = 0; i <= N; i++)
    for (int j = 0; j <= N; j += 1) {
      double u = (double)i / N, v = (double)j / N;
      double z =
          4 * u * (1 - u) * v * (1 - v) * 5 + 2 * u * (1 - u) * v * v + u * u * 2 * v * (1 - v) * 2;
      best = fmax(best, z);
    }
  assert_true(box.max.z >= best);
  assert_near(box.max.z, best, 1e-6, "height");
  cag_surface_release(s);
}

// The parabola [0, 0], [1, 1], [2, 0] with the middle weight w turned about the x axis, its length
// extruded and its area as a prism, against mpmath with 40 digits.
static void integrals_of_uneven_surfaces_are_right(void **state) {
  (void)state;
  static const struct {
    double weight, length, area, turned_area, turned_volume;
  } cases[] = {
      {1e2, 2.8165856059646152, 0.99957010128011681, 8.8097363770118865, 2.0919031593887972},
      {1e4, 2.8283073248631982, 0.99999991096512311, 8.8850127849046535, 2.0943945639145109},
      {1e6, 2.8284259266073696, 0.99999999998649134, 8.8857583481313851, 2.0943951023104125},
  };
  const CagVec3 p[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, x_axis = {1, 0, 0}, o = {0, 0, 0};
  for (size_t i = 0; i < 3; i++) {
    const double weights[3] = {1, cases[i].weight, 1};
    CagCurve *both[2], *outline;
    CagSurface *s;
    CagRegion *region;
    double area = 0, terms[10] = {0};
    MUST(cag_curve_bezier(p, weights, 3, 2, &both[0], err));
    MUST(cag_curve_line(p[2], p[0], 2, &both[1], err));
    MUST(cag_surface_extrude(both[0], cag_vec3(0, 0, 3), 0, 1, &s, err));
    MUST(cag_surface_area(s, &area, NULL, err));
    assert_near(area, 3 * cases[i].length, 1e-8, "wall");
    cag_surface_release(s);
    MUST(cag_surface_revolve(both[0], x_axis, o, 0, 2 * M_PI, &s, err));
    MUST(cag_surface_area(s, &area, NULL, err));
    MUST(cag_surface_volume_terms(s, terms, err));
    assert_near(area, cases[i].turned_area, 1e-8, "turned area");
    assert_near(fabs(terms[0]), cases[i].turned_volume, 1e-8, "turned volume");
    cag_surface_release(s);
    MUST(cag_curve_join(both, 2, &outline, err));
    MUST(cag_region_new(outline, NULL, 0, &region, err));
    MUST(cag_region_area(region, &area, NULL, err));
    assert_near(area, cases[i].area, 1e-10, "region");
    // The flux through the lid of a prism of height 3 is the area times 3 / 3.
    const CagTransform lid = cag_translate(cag_vec3(0, 0, 3));
    double flux[10] = {0};
    MUST(cag_surface_planar(region, &lid, &s, err));
    MUST(cag_surface_volume_terms(s, flux, err));
    assert_near(flux[0], cases[i].area, 1e-10, "lid");
    cag_surface_release(s);
    cag_region_release(region);
    cag_curve_release(outline);
    cag_curve_release(both[0]);
    cag_curve_release(both[1]);
  }
}

// --- Breaks ---

static void assert_cuts(const CagSurface *s, int direction, const double *wanted, size_t n,
                        const char *what) {
  double *cuts;
  size_t found;
  MUST(cag_surface_cuts(s, direction, &cuts, &found, err));
  if (found + 1 != n)
    fail_msg("%s by %c: %zu stretches, not %zu", what, "uv"[direction], found, n - 1);
  for (size_t i = 0; i < n; i++) assert_near(cuts[i], wanted[i], 1e-12, what);
  free(cuts);
}

// The surface, its transpose, flip, image, offset and part have the breaks of the curves.
static void assert_breaks(CagSurface *s, const double *u, size_t nu, const double *v, size_t nv,
                          const char *what) {
  CagSurface *t;
  double back[16], part[16];
  size_t n = 0;
  assert_cuts(s, 0, u, nu, what);
  assert_cuts(s, 1, v, nv, what);
  MUST(cag_surface_transpose(s, &t, err));
  assert_cuts(t, 0, v, nv, what);
  assert_cuts(t, 1, u, nu, what);
  cag_surface_release(t);
  MUST(cag_surface_flip(s, &t, err));
  for (size_t i = 0; i < nv; i++) back[i] = v[0] + v[nv - 1] - v[nv - 1 - i];
  assert_cuts(t, 0, u, nu, what);
  assert_cuts(t, 1, back, nv, what);
  cag_surface_release(t);
  CagTransform map = cag_shear(0.3, -0.2, 0.5, 0.1, 0, 0.4);
  MUST(cag_surface_transform(s, &map, &t, err));
  assert_cuts(t, 0, u, nu, what);
  assert_cuts(t, 1, v, nv, what);
  cag_surface_release(t);
  MUST(cag_surface_offset(s, 0.1, &t, err));
  assert_cuts(t, 0, u, nu, what);
  assert_cuts(t, 1, v, nv, what);
  cag_surface_release(t);
  // From the middle of the first stretch by u to that of the last.
  part[n++] = (u[0] + u[1]) / 2;
  for (size_t i = 1; i + 1 < nu; i++) part[n++] = u[i];
  const double end = (u[nu - 2] + 2 * u[nu - 1]) / 3;
  part[n++] = end;
  MUST(cag_surface_part(s, part[0], end, v[0], v[nv - 1], &t, err));
  assert_cuts(t, 0, part, n, what);
  assert_cuts(t, 1, v, nv, what);
  cag_surface_release(t);
  cag_surface_release(s);
}

static void breaks_are_those_of_the_curves(void **state) {
  (void)state;
  const CagVec3 p[] = {{1, 0, 0}, {3, 0, 1}, {2, 0, 2}, {4, 0, 3}},
                q[] = {{1, 5, 0}, {3, 5, 1}, {4, 6, 4}};
  const CagVec3 r[] = {{1, 0, 0}, {1, 2, 0}, {0, 5, 1}};
  const double thirds[] = {0, 1, 2, 3}, whole[] = {0, 1}, halves[] = {0, 1, 2};
  const double both[] = {0, 1.0 / 3, 0.5, 2.0 / 3, 1}, turn[] = {-1, 2};
  CagCurve *a, *b, *c, *d, *e;
  CagSurface *s;
  MUST(cag_curve_polyline(p, 4, false, 3, &a, err));
  MUST(cag_curve_polyline(q, 3, false, 3, &b, err));
  MUST(cag_curve_polyline(r, 3, false, 3, &c, err));
  MUST(cag_surface_extrude(a, cag_vec3(0, 2, 0), 0, 1, &s, err));
  assert_breaks(s, thirds, 4, whole, 2, "extrusion");
  MUST(cag_surface_extrude(a, cag_vec3(0, 2, 1), 0.4, 1.5, &s, err));
  assert_breaks(s, thirds, 4, whole, 2, "twisted extrusion");
  MUST(cag_surface_revolve(a, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), -1, 2, &s, err));
  assert_breaks(s, thirds, 4, turn, 2, "revolution");
  MUST(cag_surface_ruled(a, b, &s, err));
  assert_breaks(s, whole, 2, both, 5, "ruled");
  MUST(cag_surface_translational(a, c, &s, err));
  assert_breaks(s, thirds, 4, halves, 3, "translational");
  // Along v = 0 and v = 1 polylines, between them lines.
  MUST(cag_curve_line(p[0], q[0], 3, &d, err));
  MUST(cag_curve_line(p[3], q[2], 3, &e, err));
  MUST(cag_surface_coons(d, e, a, b, &s, err));
  assert_breaks(s, both, 5, whole, 2, "Coons");
  cag_curve_release(d);
  cag_curve_release(e);
  // Lofts through curves without an exact form: means of three successive parameters are the knots,
  // and a curve of two pieces breaks in the middle.
  CagCurve *coil[7];
  for (int i = 0; i < 7; i++) {
    CagTransform up = cag_translate(cag_vec3(0.3 * i, 0, 4.0 * i));
    MUST(cag_curve_helix(2 + 0.3 * i, 1, 0.75, 0, &d, err));
    MUST(cag_curve_transform(d, &up, &coil[i], err));
    cag_curve_release(d);
  }
  const double knots[] = {0, 2, 3, 4, 6}, middle[] = {0, 0.5, 1};
  MUST(cag_surface_loft((const CagCurve *const *)coil, 7, 3, false, &s, err));
  assert_breaks(s, whole, 2, knots, 5, "loft");
  cag_curve_release(coil[6]);
  const CagVec3 bent[] = {{4, 0, 25}, {2, 3, 26}, {-1, 3, 25}};
  MUST(cag_curve_polyline(bent, 3, false, 3, &coil[6], err));
  MUST(cag_surface_loft((const CagCurve *const *)coil, 7, 3, false, &s, err));
  assert_breaks(s, middle, 3, knots, 5, "loft to a polyline");
  for (int i = 0; i < 7; i++) cag_curve_release(coil[i]);
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(c);
}

// --- The largest degree, and maps that are not affine ---

// z = (x^2 + y^2)^16 on the unit square has degree 32; elevated to 63, the control values of x^k
// are binomial(i, k) / binomial(63, k).
static void grids_of_the_largest_degree_are_their_points(void **state) {
  (void)state;
  enum { DEGREE = 63, N = 7 };
  static CagVec3 net[(DEGREE + 1) * (DEGREE + 1)];
  static double power[DEGREE + 1][33];
  for (int i = 0; i <= DEGREE; i++) {
    power[i][0] = 1;
    for (int k = 1; k <= 32; k++)
      power[i][k] = power[i][k - 1] * fmax(0, i - k + 1) / (DEGREE - k + 1);
  }
  for (int i = 0; i <= DEGREE; i++)
    for (int j = 0; j <= DEGREE; j++) {
      double z = 0, binomial = 1;
      for (int k = 0; k <= 16; k++) {
        z += binomial * power[i][2 * k] * power[j][32 - 2 * k];
        binomial = binomial * (16 - k) / (k + 1);
      }
      net[i * (DEGREE + 1) + j] = cag_vec3((double)i / DEGREE, (double)j / DEGREE, z);
    }
  CagSurface *s;
  MUST(cag_surface_bezier(net, NULL, DEGREE + 1, DEGREE + 1, &s, err));
  double at[N];
  CagVec3 points[N * N], du[N * N], dv[N * N];
  for (int i = 0; i < N; i++) at[i] = (double)i / (N - 1);
  for (int round = 0; round < 2; round++) {
    MUST(cag_surface_eval_grid(s, at, N, at, N, points, round ? du : NULL, round ? dv : NULL, err));
    for (int i = 0; i < N; i++)
      for (int j = 0; j < N; j++) {
        const double x = at[i], y = at[j], sum = x * x + y * y;
        assert_point(points[i * N + j], cag_vec3(x, y, pow(sum, 16)), 1e-10, "point");
        if (!round) continue;
        assert_point(du[i * N + j], cag_vec3(1, 0, 32 * x * pow(sum, 15)), 1e-9, "along u");
        assert_point(dv[i * N + j], cag_vec3(0, 1, 32 * y * pow(sum, 15)), 1e-9, "along v");
      }
  }
  cag_surface_release(s);
}

static void translational_surfaces_move_point_by_point(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {1, 2, 0.5}, {3, 0, 1}}, q[] = {{0, 0, 0}, {-1, 1, 2}, {0, 3, 4}};
  CagCurve *a, *b;
  CagSurface *s;
  MUST(cag_curve_bezier(p, NULL, 3, 3, &a, err));
  MUST(cag_curve_bezier(q, NULL, 3, 3, &b, err));
  MUST(cag_surface_translational(a, b, &s, err));
  for (int projective = 0; projective < 2; projective++) {
    CagTransform t = cag_transform_identity();
    CagSurface *moved;
    t.planar = false;
    t.m[0][1] = 0.5;
    t.m[1][2] = -0.25;
    t.m[2][3] = 3;
    t.m[3][0] = projective ? 0.05 : 0;
    t.m[3][2] = projective ? 0.02 : 0;
    MUST(cag_surface_transform(s, &t, &moved, err));
    if (!projective) assert_string_equal(moved->kind->name, s->kind->name);
    for (int i = 0; i <= 4; i++)
      for (int j = 0; j <= 4; j++)
        assert_point(surface_at(moved, i / 4.0, j / 4.0),
                     cag_transform_point(&t, surface_at(s, i / 4.0, j / 4.0)), 1e-13, "moved");
    cag_surface_release(moved);
  }
  cag_surface_release(s);
  cag_curve_release(a);
  cag_curve_release(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bezier_patches_have_the_partials_of_the_worked_example),
      cmocka_unit_test(bezier_patches_may_have_different_degrees),
      cmocka_unit_test(bspline_surface_of_example_15),
      cmocka_unit_test(rational_surfaces_follow_the_quotient_rule),
      cmocka_unit_test(closed_surfaces_meet_themselves),
      cmocka_unit_test(a_grid_has_the_values_of_single_points_to_the_last_bit),
      cmocka_unit_test(a_grid_of_degree_6_has_the_values_of_single_points),
      cmocka_unit_test(bad_nurbs_data_are_refused_by_name),
      cmocka_unit_test(isocurves_of_a_bezier_patch_are_bezier_curves),
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
      cmocka_unit_test(planar_pieces_measure_their_region),
      cmocka_unit_test(isocurves_run_on_the_surface),
      cmocka_unit_test(integrals_of_uneven_surfaces_are_right),
      cmocka_unit_test(breaks_are_those_of_the_curves),
      cmocka_unit_test(bounds_are_tight_between_samples),
      cmocka_unit_test(grids_of_the_largest_degree_are_their_points),
      cmocka_unit_test(translational_surfaces_move_point_by_point),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
