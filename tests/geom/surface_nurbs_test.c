// Surfaces of Bezier, B-spline, and NURBS nets: worked examples of the reference, grids, and
// invalid data.

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

// bezier-surface.ex14, bezier-surface.ex14.modified
static void bezier_patches_have_the_partials_of_the_worked_example(void **state) {
  (void)state;
  const Partials base = {{0, 4.6875, 0}, {30, 0, 0},   {0, 0, -30},
                         {0, 0, 0},      {0, -7.5, 0}, {0, -7.5, 0}};
  const Partials moved = {{0.703125, 5.390625, -0.703125}, {28.59375, -1.40625, 1.40625},
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
  const Partials e = {{3, 2.412109375, 4}, {12, 3.53125, 0}, {0, -0.6328125, 8},
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
  const Partials e = {{-5.037430702833471, 6.701738575276921, 3.786581286567784},
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
  const Partials e = {{1.9583333333333333, 1.7389915377765535, 4.1982969553522},
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

// Compares a grid of points and derivatives over `side` by 1 with single points. Rational surfaces
// are evaluated in a different order.
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
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
