// Patches: golden numbers of the reference (05a, 8 and 9; 06a, 6.9 and 6.10), and consequences.

#include "geom/surface/patches.h"
#include "tests/geom/random.h"
#include "tests/geom/surface_support.h"

static CagCurve *spline(const CagVec3 *points, size_t n) {
  CagCurve *c = NULL;
  double knots[16];
  MUST(cag_knots_make("open", n, 2, points, knots, err));
  MUST(cag_curve_nurbs(points, NULL, n, 2, knots, 3, &c, err));
  return c;
}

// coons-linear.ex12, ex12-grid: B-splines of order 3 on open uniform knots.
static void coons_of_example_12(void **state) {
  (void)state;
  CagVec3 v0[] = {{0, 0, 3}, {1, 1, 3}, {2, 1, 3}, {2, 1, 3}, {3, 0, 3}};
  CagVec3 v1[] = {{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}};
  CagVec3 u0[] = {{0, 0, 3}, {0, 1, 2}, {0, 1, 1}, {0, 0, 0}};
  CagVec3 u1[] = {{3, 0, 3}, {3, 1, 2}, {3, 1, 2}, {3, 1, 1}, {3, 0, 0}};
  CagCurve *a = spline(u0, 4), *b = spline(u1, 5), *c = spline(v0, 5), *d = spline(v1, 4);
  CagSurface *s = NULL, *exact = NULL;
  MUST(cag_surface_coons(a, b, c, d, &s, err));
  MUST(cag_surface_to_nurbs(s, &exact, err));
  static const double AT[][2] = {{0.25, 0.25}, {0.25, 0.75}, {0.75, 0.25}, {0.9, 0.1}, {0.5, 0.0},
                                 {0.0, 0.5},   {1.0, 0.5},   {0.5, 1.0},   {0.5, 0.5}};
  static const CagVec3 POINT[] = {{1.1328125, 1.6875, 2.109375},
                                  {0.9609375, 1.59375, 0.9609375},
                                  {2.078125, 1.78125, 2.078125},
                                  {2.503, 0.9899999999999998, 2.5029999999999997},
                                  {1.875, 1.0, 3.0},
                                  {0.0, 1.0, 1.5},
                                  {3.0, 1.0, 1.875},
                                  {1.5, 1.0, 0.0},
                                  {1.6875, 2.0, 1.6875}};
  for (size_t i = 0; i < sizeof AT / sizeof *AT; i++) {
    assert_point(surface_at(s, AT[i][0], AT[i][1]), POINT[i], 1e-12, "coons-linear.ex12");
    assert_point(surface_at(exact, AT[i][0], AT[i][1]), POINT[i], 1e-12, "exact form");
  }
  assert_consistent(s);
  assert_transforms(s);
  cag_surface_release(exact);
  cag_surface_release(s);
  // If one edge is reversed, the error names it and the fix.
  CagCurve *turned;
  MUST(cag_curve_reverse(c, &turned, err));
  CagError e;
  assert_int_equal(cag_surface_coons(a, b, turned, d, &s, &e), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(e.id)->reason, "coons-corner-mismatch");
  assert_non_null(strstr(e.message, "3 apart; reversing `v0` closes the patch"));
  cag_curve_release(turned);
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(c);
  cag_curve_release(d);
}

// Sides with domains other than 0..1: two parts of cubics, and lines between their ends.
static void coons_patches_blend_sides_of_any_range(void **state) {
  (void)state;
  seed = 70;
  for (int round = 0; round < 6; round++) {
    CagCurve *side[4];
    CagVec3 corner[2][2], e[4];
    for (int k = 0; k < 2; k++) {
      CagVec3 p[4];
      CagCurve *whole;
      for (int i = 0; i < 4; i++) {
        const double y = uniform(-0.3, 0.3), z = uniform(-1, 1);
        p[i] = cag_vec3(3 * k + z / 3, i + y, z);
      }
      MUST(cag_curve_bezier(p, NULL, 4, 3, &whole, err));
      const double from = uniform(0.1, 0.3), to = uniform(0.6, 0.9);
      MUST(cag_curve_trim(whole, from, to, &side[k], err));
      cag_curve_release(whole);
      MUST(cag_curve_point(side[k], side[k]->start, &corner[k][0], err));
      MUST(cag_curve_point(side[k], side[k]->end, &corner[k][1], err));
    }
    for (int m = 0; m < 2; m++) {
      const CagVec3 way = cag_sub(corner[1][m], corner[0][m]);
      const CagVec3 ends[2] = {cag_madd(corner[0][m], -1, way), cag_madd(corner[1][m], 2, way)};
      CagCurve *line;
      MUST(cag_curve_bezier(ends, NULL, 2, 3, &line, err));
      MUST(cag_curve_trim(line, 0.25, 0.5, &side[2 + m], err));
      cag_curve_release(line);
    }
    CagSurface *s;
    MUST(cag_surface_coons(side[0], side[1], side[2], side[3], &s, err));
    for (int i = 0; i <= 4; i++)
      for (int j = 0; j <= 4; j++) {
        const double u = i / 4.0, v = j / 4.0;
        for (int k = 0; k < 4; k++) {
          const CagCurve *c = side[k];
          const double f = k < 2 ? v : u;
          MUST(cag_curve_point(c, (1 - f) * c->start + f * c->end, &e[k], err));
        }
        const CagVec3 across = cag_lerp(e[0], e[1], u), along = cag_lerp(e[2], e[3], v);
        const CagVec3 flat = cag_lerp(cag_lerp(corner[0][0], corner[1][0], u),
                                      cag_lerp(corner[0][1], corner[1][1], u), v);
        assert_point(surface_at(s, u, v), cag_sub(cag_add(across, along), flat), 1e-12, "blend");
      }
    assert_consistent(s);
    cag_surface_release(s);
    for (int k = 0; k < 4; k++) cag_curve_release(side[k]);
  }
}

static CagSurface *bicubic(const CagVec3 p[4], const CagVec3 pu[4], const CagVec3 pv[4],
                           const CagVec3 puv[4]) {
  CagHermiteCorners c;
  memcpy(c.p, p, sizeof c.p);
  memcpy(c.pu, pu, sizeof c.pu);
  memcpy(c.pv, pv, sizeof c.pv);
  memcpy(c.puv, puv, sizeof c.puv);
  CagSurface *s = NULL;
  MUST(cag_surface_hermite(&c, 0, 1, 0, 1, &s, err));
  return s;
}

// coons-bicubic.ex13 with its derivatives, and figures 33 to 35: heights at the center.
static void bicubic_patches_of_the_reference(void **state) {
  (void)state;
  const CagVec3 P[] = {{-100.0, 0.0, 100.0},
                       {-100.0, -100.0, -100.0},
                       {100.0, -100.0, 100.0},
                       {100.0, 0.0, -100.0}},
                U[] = {{100.0, 100.0, 0.0}, {1.0, 1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}},
                V[] = {{0.0, 10.0, -10.0}, {0.0, -1.0, -1.0}, {0.0, 1.0, -1.0}, {0.0, -1.0, -1.0}},
                T[] = {{0.0, 0.0, 0.0}, {0.1, 0.1, 0.1}, {0.1, -0.1, -0.1}, {0.0, 0.0, 0.0}};
  CagSurface *s = bicubic(P, U, V, T);
  CagVec3 d[9];
  MUST(cag_surface_eval(s, 0.5, 0.5, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
  assert_point(d[cag_partial(2, 0, 0)], (CagVec3){6.184374999999999, -42.75, -0.5625}, 1e-11,
               "coons-bicubic.ex13 point");
  assert_point(d[cag_partial(2, 1, 0)], (CagVec3){287.125, -14.056249999999999, 1.69375}, 1e-11,
               "coons-bicubic.ex13 d_u");
  assert_point(d[cag_partial(2, 0, 1)], (CagVec3){-18.5625, -19.69375, -298.38125}, 1e-11,
               "coons-bicubic.ex13 d_w");
  assert_point(d[cag_partial(2, 1, 1)], (CagVec3){37.1375, 490.5, -3.375}, 1e-11,
               "coons-bicubic.ex13 d_uw");
  assert_point(d[cag_partial(2, 2, 0)], (CagVec3){-49.474999999999994, -51.5, 0.0}, 1e-11,
               "coons-bicubic.ex13 d_uu");
  assert_point(d[cag_partial(2, 0, 2)], (CagVec3){0.025, -6.5, 4.5}, 1e-11,
               "coons-bicubic.ex13 d_ww");
  cag_surface_release(s);
  const CagVec3 FLAT[] = {{-100, 0, 100}, {-100, 0, -100}, {100, 0, 100}, {100, 0, -100}};
  CagVec3 twist[4] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  static const double M[] = {1, 10, 100, 1000};
  for (int i = 0; i < 4; i++) {
    double m = M[i];
    CagVec3 u[] = {{m, m, 0}, {m, m, 0}, {m, -m, 0}, {m, -m, 0}};
    CagVec3 v[] = {{0, m, -m}, {0, -m, -m}, {0, m, -m}, {0, -m, -m}};
    s = bicubic(FLAT, u, v, twist);
    assert_near(surface_at(s, 0.5, 0.5).y, m / 2, 1e-12, "coons-bicubic.fig33");
    cag_surface_release(s);
  }
  CagVec3 u[] = {{100, 100, 0}, {100, -100, 0}, {100, -100, 0}, {100, -100, 0}};
  CagVec3 v[] = {{0, 100, -100}, {0, 100, -100}, {0, 100, -100}, {0, -100, -100}};
  s = bicubic(FLAT, u, v, twist);
  assert_near(surface_at(s, 0.5, 0.5).y, 25, 1e-12, "coons-bicubic.fig34");
  cag_surface_release(s);
}

// With Adini's twists, a patch with straight edges is bilinear.
static void adini_twists_keep_bilinear_patches(void **state) {
  (void)state;
  CagHermiteCorners c = {.p = {{{0, 0, 0}, {0, 2, 1}}, {{3, 0, -1}, {4, 5, 2}}}};
  for (int k = 0; k < 2; k++) {
    c.pu[0][k] = c.pu[1][k] = cag_sub(c.p[1][k], c.p[0][k]);
    c.pv[k][0] = c.pv[k][1] = cag_sub(c.p[k][1], c.p[k][0]);
  }
  cag_hermite_adini(&c);
  CagSurface *s = NULL, *flat = NULL;
  MUST(cag_surface_hermite(&c, 0, 1, 0, 1, &s, err));
  MUST(cag_surface_bilinear(c.p[0][0], c.p[0][1], c.p[1][0], c.p[1][1], &flat, err));
  for (int k = 0; k < 4; k++) {
    double u = inside(0, 1, k), w = inside(0, 1, 3 - k);
    assert_point(surface_at(s, u, w), surface_at(flat, u, w), 1e-13, "bilinear");
  }
  cag_surface_release(s);
  cag_surface_release(flat);
}

// hermite-surface.3x2: tangents, twists, and samples. The curvature is continuous at the knots.
static void composite_surface_uniform(void **state) {
  (void)state;
  static const CagVec3 P[4][3] = {{{0.0, 0.0, 0.61}, {0.0, 1.0, 0.62}, {0.0, 2.0, 0.03}},
                                  {{1.0, 0.0, -0.43}, {1.0, 1.0, -0.89}, {1.0, 2.0, -0.23}},
                                  {{2.0, 0.0, -0.18}, {2.0, 1.0, -0.91}, {2.0, 2.0, -0.9}},
                                  {{3.0, 0.0, 1.0}, {3.0, 1.0, 0.3}, {3.0, 2.0, -0.53}}};
  static const CagVec3 Q0[] = {{1.0, 0.0, -0.13}, {1.0, 0.0, 0.95}, {1.0, 0.0, 0.8}},
                       Q1[] = {{1.0, 0.0, 0.69}, {1.0, 0.0, -0.22}, {1.0, 0.0, -0.01}};
  static const CagVec3 R0[] = {{0.0, 1.0, 0.35},
                               {0.0, 1.0, -0.88},
                               {0.0, 1.0, 0.11},
                               {0.0, 1.0, -0.46}},
                       R1[] = {
                           {0.0, 1.0, 0.76}, {0.0, 1.0, -0.87}, {0.0, 1.0, 0.36}, {0.0, 1.0, 0.74}};
  static const CagVec3 Q[4][3] = {
      {{1.0, 0.0, -0.13}, {1.0, 0.0, 0.95}, {1.0, 0.0, 0.8}},
      {{1.0, 0.0, -0.8373333333333334}, {1.0, 0.0, -1.73}, {1.0, 0.0, -0.8979999999999999}},
      {{1.0, 0.0, 1.1093333333333333}, {1.0, 0.0, 1.38}, {1.0, 0.0, 0.001999999999999955}},
      {{1.0, 0.0, 0.69}, {1.0, 0.0, -0.22}, {1.0, 0.0, -0.01}}};
  static const CagVec3 R[4][3] = {
      {{0.0, 1.0, 0.35}, {0.0, 1.0, -0.7124999999999999}, {0.0, 1.0, 0.76}},
      {{0.0, 1.0, -0.88}, {0.0, 1.0, 0.5875}, {0.0, 1.0, -0.87}},
      {{0.0, 1.0, 0.11}, {0.0, 1.0, -0.6575}, {0.0, 1.0, 0.36}},
      {{0.0, 1.0, -0.46}, {0.0, 1.0, -1.2175}, {0.0, 1.0, 0.74}}};
  static const CagVec3 T[4][3] = {
      {{0.0, 0.0, -0.27}, {0.0, 0.0, 0.6650000000000001}, {0.0, 0.0, 0.4}},
      {{0.0, 0.0, -0.17933333333333332},
       {0.0, 0.0, 0.1944999999999998},
       {0.0, 0.0, -0.7806666666666666}},
      {{0.0, 0.0, 0.2673333333333333},
       {0.0, 0.0, -1.2780000000000002},
       {0.0, 0.0, 1.5226666666666668}},
      {{0.0, 0.0, 0.37}, {0.0, 0.0, -0.49749999999999994}, {0.0, 0.0, -0.48}}};
  static const double U[] = {1.0, 1.0, 1.0}, V[] = {1.0, 1.0};
  CagHermiteGrid g = {4, 3, P[0], Q0, Q1, R0, R1, {{T[0][0], T[0][2]}, {T[3][0], T[3][2]}}, U, V};
  CagSurface *s = NULL;
  MUST(cag_surface_hermite_grid(&g, &s, err));
  double u = 0;
  for (int i = 0; i <= 3; i++) {
    double v = 0;
    for (int j = 0; j <= 2; j++) {
      CagVec3 d[9], l[9];
      MUST(cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
      MUST(cag_surface_eval(s, u, v, 2, CAG_SIDE_LEFT, CAG_SIDE_LEFT, l, err));
      assert_point(d[0], P[i][j], 1e-12, "point");
      assert_point(d[cag_partial(2, 1, 0)], Q[i][j], 1e-11, "tangent by u");
      assert_point(d[cag_partial(2, 0, 1)], R[i][j], 1e-11, "tangent by v");
      assert_point(d[cag_partial(2, 1, 1)], T[i][j], 1e-11, "twist");
      for (int k = 2; k < 8; k += 2) assert_point(l[k], d[k], 1e-10, "C2");
      if (j < 2) v += V[j];
    }
    if (i < 3) u += U[i];
  }
  cag_surface_release(s);
}

// hermite-surface.nonuniform: tangents, twists, and samples. The curvature is continuous at the
// knots.
static void composite_surface_nonuniform(void **state) {
  (void)state;
  static const CagVec3 P[4][3] = {{{0.0, 0.0, 0.08}, {0.0, 1.0, -0.31}, {0.0, 2.0, -0.26}},
                                  {{1.0, 0.0, -0.25}, {1.0, 1.0, 0.97}, {1.0, 2.0, 0.27}},
                                  {{2.0, 0.0, 0.35}, {2.0, 1.0, -0.34}, {2.0, 2.0, 0.36}},
                                  {{3.0, 0.0, -0.75}, {3.0, 1.0, -0.9}, {3.0, 2.0, 0.7}}};
  static const CagVec3 Q0[] = {{1.0, 0.0, -0.98}, {1.0, 0.0, 0.96}, {1.0, 0.0, 0.65}},
                       Q1[] = {{1.0, 0.0, 0.57}, {1.0, 0.0, -0.9}, {1.0, 0.0, -0.59}};
  static const CagVec3
      R0[] = {{0.0, 1.0, 0.7}, {0.0, 1.0, -0.14}, {0.0, 1.0, 0.25}, {0.0, 1.0, -0.76}},
      R1[] = {{0.0, 1.0, -0.63}, {0.0, 1.0, -0.01}, {0.0, 1.0, 0.52}, {0.0, 1.0, 0.08}};
  static const CagVec3 Q[4][3] = {{{1.0000000000000002, 0.0, -0.9799999999999998},
                                   {1.0000000000000002, 0.0, 0.96},
                                   {1.0000000000000002, 0.0, 0.6500000000000002}},
                                  {{0.5677966101694916, 0.0, 0.6199999999999999},
                                   {0.5677966101694916, 0.0, 0.8433050847457626},
                                   {0.5677966101694916, 0.0, 0.1609322033898305}},
                                  {{2.0932203389830506, 0.0, -2.84},
                                   {2.0932203389830506, 0.0, -1.2648305084745763},
                                   {2.0932203389830506, 0.0, 1.0494067796610167}},
                                  {{1.0, 0.0, 0.57}, {1.0, 0.0, -0.9}, {1.0, 0.0, -0.59}}};
  static const CagVec3 R[4][3] = {
      {{0.0, 1.0, 0.7}, {0.0, 0.8, -0.06199999999999997}, {0.0, 1.0, -0.63}},
      {{0.0, 1.0, -0.14}, {0.0, 0.8, -0.11099999999999999}, {0.0, 1.0, -0.01}},
      {{0.0, 1.0, 0.25}, {0.0, 0.8, 0.148}, {0.0, 1.0, 0.52}},
      {{0.0, 1.0, -0.76}, {0.0, 0.8, 1.508}, {0.0, 1.0, 0.08}}};
  static const CagVec3 T[4][3] = {
      {{0.0, 0.0, -0.3900000000000001},
       {0.0, 0.0, 0.4640000000000004},
       {0.0, 0.0, 0.3700000000000001}},
      {{0.0, 0.0, -0.24635593220338983},
       {0.0, 0.0, -0.7159237288135594},
       {0.0, 0.0, 0.8012711864406779}},
      {{0.0, 0.0, -2.1968644067796608},
       {0.0, 0.0, 3.4620423728813554},
       {0.0, 0.0, -1.0326271186440676}},
      {{0.0, 0.0, -0.36}, {0.0, 0.0, -0.21899999999999992}, {0.0, 0.0, -0.06}}};
  static const double U[] = {1.0, 2.0, 0.5}, V[] = {1.5, 1.0};
  CagHermiteGrid g = {4, 3, P[0], Q0, Q1, R0, R1, {{T[0][0], T[0][2]}, {T[3][0], T[3][2]}}, U, V};
  CagSurface *s = NULL;
  MUST(cag_surface_hermite_grid(&g, &s, err));
  double u = 0;
  for (int i = 0; i <= 3; i++) {
    double v = 0;
    for (int j = 0; j <= 2; j++) {
      CagVec3 d[9], l[9];
      MUST(cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
      MUST(cag_surface_eval(s, u, v, 2, CAG_SIDE_LEFT, CAG_SIDE_LEFT, l, err));
      assert_point(d[0], P[i][j], 1e-12, "point");
      assert_point(d[cag_partial(2, 1, 0)], Q[i][j], 1e-11, "tangent by u");
      assert_point(d[cag_partial(2, 0, 1)], R[i][j], 1e-11, "tangent by v");
      assert_point(d[cag_partial(2, 1, 1)], T[i][j], 1e-11, "twist");
      for (int k = 2; k < 8; k += 2) assert_point(l[k], d[k], 1e-10, "C2");
      if (j < 2) v += V[j];
    }
    if (i < 3) u += U[i];
  }
  cag_surface_release(s);
}

// bezier-triangle: the points at barycentric coordinates.
static void bezier_triangles_of_the_reference(void **state) {
  (void)state;
  {
    static const CagVec3 P[] = {{2.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {1.0, 0.0, 1.0},
                                {0.0, 2.0, 0.0}, {0.0, 1.0, 2.0}, {0.0, 0.0, 0.0}};
    static const CagVec3 AT[] = {{1.0, 0.0, 0.0},
                                 {0.0, 1.0, 0.0},
                                 {0.0, 0.0, 1.0},
                                 {0.3333333333333333, 0.3333333333333333, 0.3333333333333333},
                                 {0.5, 0.25, 0.25}};
    static const CagVec3 POINT[] = {{2.0, 0.0, 0.0},
                                    {0.0, 2.0, 0.0},
                                    {0.0, 0.0, 0.0},
                                    {0.6666666666666666, 0.6666666666666666, 0.8888888888888888},
                                    {1.0, 0.5, 0.75}};
    CagSurface *s = NULL;
    MUST(cag_surface_bezier_triangle(P, 2, &s, err));
    for (size_t i = 0; i < sizeof AT / sizeof *AT; i++) {
      double u = 1 - AT[i].x, v = u > 0 ? AT[i].z / u : 0;
      assert_point(surface_at(s, u, v), POINT[i], 1e-12, "lecture.bezier-triangle-n2");
    }
    assert_true(s->pole_u0);
    cag_surface_release(s);
  }
  {
    static const CagVec3 P[] = {{3.0, 0.0, 0.0}, {2.0, 1.0, 1.0}, {2.0, 0.0, 1.0}, {1.0, 2.0, 1.0},
                                {1.0, 1.0, 3.0}, {1.0, 0.0, 1.0}, {0.0, 3.0, 0.0}, {0.0, 2.0, 1.0},
                                {0.0, 1.0, 1.0}, {0.0, 0.0, 0.0}};
    static const CagVec3 AT[] = {{0.2, 0.3, 0.5},
                                 {0.3333333333333333, 0.3333333333333333, 0.3333333333333333},
                                 {0.6, 0.4, 0.0}};
    static const CagVec3 POINT[] = {{0.6000000000000001, 0.9, 1.2000000000000002},
                                    {0.9999999999999998, 1.0, 1.3333333333333335},
                                    {1.8, 1.2000000000000002, 0.7200000000000001}};
    CagSurface *s = NULL;
    MUST(cag_surface_bezier_triangle(P, 3, &s, err));
    for (size_t i = 0; i < sizeof AT / sizeof *AT; i++) {
      double u = 1 - AT[i].x, v = u > 0 ? AT[i].z / u : 0;
      assert_point(surface_at(s, u, v), POINT[i], 1e-12, "lecture.bezier-triangle-n3");
    }
    assert_true(s->pole_u0);
    cag_surface_release(s);
  }
}

// --- Developable surfaces ---

static CagCurve *elliptic_arc(double a, double b, double from, double to, CagVec3 center) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  frame.planar = false;
  frame.m[0][3] = center.x;
  frame.m[1][3] = center.y;
  frame.m[2][3] = center.z;
  MUST(cag_curve_arc(a, b, from, to, &frame, &c, err));
  return c;
}

static CagVec3 on_ellipse(double a, double b, double t, CagVec3 center) {
  return cag_add(center, cag_vec3(a * cos(t), b * sin(t), 0));
}

// Between arcs of ellipses in parallel planes, rulings join points with parallel tangents: s on the
// first curve and t on the second, where tan t = k tan s. The surface covers all s for which both
// exist.
static void developables_join_parallel_tangents(void **state) {
  (void)state;
  seed = 71;
  for (int round = 0; round < 30; round++) {
    double size[4], ends[4];
    for (int i = 0; i < 4; i++) size[i] = uniform(0.5, 3);
    const double k = size[3] * size[0] / (size[2] * size[1]);
    for (int i = 0; i < 4; i++) ends[i] = i % 2 ? uniform(0.2, 1.3) : uniform(-1.3, -0.2);
    CagVec3 low = {1, 2, 3}, high = {1, 2, 5};
    high.x += uniform(-2, 2);
    high.y += uniform(-2, 2);
    CagCurve *a = elliptic_arc(size[0], size[1], ends[0], ends[1], low);
    CagCurve *b = elliptic_arc(size[2], size[3], ends[2], ends[3], high);
    CagSurface *s;
    MUST(cag_surface_developable(a, b, &s, err));
    const double from = fmax(ends[0], atan(tan(ends[2]) / k));
    const double to = fmin(ends[1], atan(tan(ends[3]) / k));
    for (int i = 0; i <= 10; i++) {
      const double v = s->v0 + (s->v1 - s->v0) * i / 10, at = from + (to - from) * i / 10;
      const double other = atan(k * tan(at));
      assert_point(surface_at(s, 1, v), on_ellipse(size[0], size[1], at, low), 1e-10, "first");
      assert_point(surface_at(s, 0, v), on_ellipse(size[2], size[3], other, high), 1e-10, "second");
      CagVec3 n[3];
      for (int j = 0; j < 3; j++) MUST(cag_surface_normal(s, 0.1 + 0.4 * j, v, &n[j], err));
      assert_point(n[1], n[0], 1e-9, "normal");
      assert_point(n[2], n[0], 1e-9, "normal");
    }
    if (round % 5 == 0) assert_consistent(s);
    if (round % 5 == 1) assert_transforms(s);
    cag_surface_release(s);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// The angle t with tan t = k tan s, k > 0, in the quadrant and turn of s.
static double parallel_angle(double k, double s) {
  const double turn = M_PI * round(s / M_PI);
  return turn + atan(k * tan(s - turn));
}

// The same for whole ellipses that begin at any angle: the rulings cross the seam of the second.
static void developables_of_closed_curves_go_round(void **state) {
  (void)state;
  seed = 72;
  for (int round = 0; round < 12; round++) {
    double size[4], starts[2];
    for (int i = 0; i < 4; i++) size[i] = uniform(0.8, 2.5);
    for (int i = 0; i < 2; i++) starts[i] = uniform(-3, 3);
    const double k = size[3] * size[0] / (size[2] * size[1]);
    CagVec3 low = {0, 1, -1}, high = {0, 1, 2};
    high.x += uniform(-2, 2);
    high.y += uniform(-2, 2);
    CagCurve *a = elliptic_arc(size[0], size[1], starts[0], starts[0] + 2 * M_PI, low);
    CagCurve *b = elliptic_arc(size[2], size[3], starts[1], starts[1] + 2 * M_PI, high);
    CagSurface *s;
    MUST(cag_surface_developable(a, b, &s, err));
    for (int i = 0; i <= 20; i++) {
      const double v = s->v0 + (s->v1 - s->v0) * i / 20, at = starts[0] + 2 * M_PI * i / 20;
      const CagVec3 first = on_ellipse(size[0], size[1], at, low);
      const CagVec3 second = on_ellipse(size[2], size[3], parallel_angle(k, at), high);
      assert_point(surface_at(s, 1, v), first, 1e-9, "first");
      assert_point(surface_at(s, 0, v), second, 1e-9, "second");
      assert_point(surface_at(s, 0.3, v), cag_lerp(second, first, 0.3), 1e-9, "between");
    }
    if (round == 0) assert_consistent(s);
    cag_surface_release(s);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

// Rulings of an elliptic cylinder between two plane sections, over all angles common to both.
static void developables_of_oblique_sections_are_cylinders(void **state) {
  (void)state;
  seed = 73;
  for (int round = 0; round < 12; round++) {
    double ends[4], tilt[4];
    for (int i = 0; i < 4; i++) ends[i] = i % 2 ? uniform(0.5, 3) : uniform(-3, -0.5);
    for (int i = 0; i < 4; i++) tilt[i] = uniform(-0.4, 0.4);
    const double half[2] = {1.5, 0.8};
    CagCurve *c[2];
    for (int i = 0; i < 2; i++) {
      CagTransform frame = cag_transform_identity();
      frame.planar = false;
      frame.m[2][0] = tilt[2 * i];
      frame.m[2][1] = tilt[2 * i + 1];
      frame.m[2][3] = i ? 4 : 0;
      CagCurve *flat =
          elliptic_arc(half[0], half[1], ends[2 * i], ends[2 * i + 1], cag_vec3(0, 0, 0));
      MUST(cag_curve_transform(flat, &frame, &c[i], err));
      cag_curve_release(flat);
    }
    CagSurface *s;
    MUST(cag_surface_developable(c[0], c[1], &s, err));
    const double from = fmax(ends[0], ends[2]), to = fmin(ends[1], ends[3]);
    for (int i = 0; i <= 12; i++) {
      const double v = s->v0 + (s->v1 - s->v0) * i / 12, at = from + (to - from) * i / 12;
      for (int k = 0; k < 2; k++) {
        CagVec3 p = on_ellipse(half[0], half[1], at, cag_vec3(0, 0, 0));
        p.z = (k ? 4 : 0) + tilt[2 * k] * p.x + tilt[2 * k + 1] * p.y;
        assert_point(surface_at(s, k ? 0 : 1, v), p, 1e-9, "section");
      }
      CagVec3 n;
      const CagVec3 out = cag_unit(cag_vec3(cos(at) / half[0], sin(at) / half[1], 0));
      MUST(cag_surface_normal(s, 0.4, v, &n, err));
      assert_near(fabs(cag_dot(n, out)), 1, 1e-9, "normal");
    }
    cag_surface_release(s);
    // A curve and itself, or skew lines, have no rulings.
    MUST_FAIL(cag_surface_developable(c[0], c[0], &s, err), "no-rulings");
    for (int i = 0; i < 2; i++) cag_curve_release(c[i]);
    const double way = uniform(0.3, 2.8);
    MUST(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 3, &c[0], err));
    MUST(cag_curve_line(cag_vec3(0, 0, 1), cag_vec3(cos(way), sin(way), 1), 3, &c[1], err));
    MUST_FAIL(cag_surface_developable(c[0], c[1], &s, err), "no-rulings");
    for (int i = 0; i < 2; i++) cag_curve_release(c[i]);
  }
}

// A spline on a cone with its tip at the origin, or its image under x / (1 + n . x), which has the
// same rulings. Weights that grow by a constant factor only change the parametrization.
static CagCurve *on_cone(const CagVec3 *points, const double *weights, size_t n, int degree,
                         const double *knots, CagVec3 image, double growth) {
  CagVec3 p[8];
  double w[8];
  CagCurve *c;
  for (size_t i = 0; i < n; i++) {
    const double near = 1 + cag_dot(image, points[i]);
    p[i] = cag_scaled(points[i], 1 / near);
    w[i] = weights[i] * near * pow(growth, (double)i);
  }
  MUST(cag_curve_nurbs(p, w, n, degree, knots, 3, &c, err));
  return c;
}

static void developables_of_curves_on_a_cone_are_the_cone(void **state) {
  (void)state;
  seed = 74;
  for (int round = 0; round < 40; round++) {
    const bool one_piece = round % 2;
    const size_t n = one_piece ? 4 : 7;
    const int degree = one_piece ? 3 : 2 + round / 2 % 2;
    CagVec3 points[8];
    double weights[8], knots[12];
    for (size_t i = 0; i < n; i++) {
      const double turn = 2.2 / (double)(n - 1) * ((double)i + uniform(-0.2, 0.2));
      points[i] = cag_scaled(cag_vec3(cos(turn), sin(turn), 1.5), uniform(0.8, 1.2));
      weights[i] = uniform(0.8, 1.2);
    }
    for (size_t i = 0; i < n + (size_t)degree + 1; i++)
      knots[i] = i <= (size_t)degree ? 0
                 : i >= n            ? 1
                                     : ((double)(i - (size_t)degree) + uniform(-0.3, 0.3)) /
                                (double)(n - (size_t)degree);
    const CagVec3 image = cag_vec3(uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(0.2, 0.5));
    const double growth = one_piece ? uniform(0.5, 2) : 1;
    const CagVec3 none = {0, 0, 0};
    CagCurve *whole[2] = {on_cone(points, weights, n, degree, knots, none, 1),
                          on_cone(points, weights, n, degree, knots, image, growth)};
    // Parts of both. The second is faster by the factor `growth`: a ruling at s on the first is at
    // t on the second, where t / (1 - t) = s / (1 - s) / growth.
    CagCurve *part[2];
    double from = 0, to = 1;
    for (int k = 0; k < 2; k++) {
      const double low = uniform(0.02, 0.35), high = uniform(0.65, 0.98);
      const double g = k ? growth : 1, rest[2] = {1 - low, 1 - high};
      MUST(cag_curve_trim(whole[k], low, high, &part[k], err));
      from = fmax(from, g * low / (rest[0] + g * low));
      to = fmin(to, g * high / (rest[1] + g * high));
    }
    CagSurface *s;
    // The tangent plane at the start of the first curve contains another point of the second one,
    // too. From there, the rulings begin to cross at a knot, where the second curve's curvature
    // jumps.
    if (round == 12) {
      MUST_FAIL(cag_surface_developable(part[0], part[1], &s, err), "no-rulings");
      for (int k = 0; k < 2; k++) {
        cag_curve_release(part[k]);
        cag_curve_release(whole[k]);
      }
      continue;
    }
    MUST(cag_surface_developable(part[0], part[1], &s, err));
    for (int i = 0; i <= 20; i++) {
      const double v = s->v0 + (s->v1 - s->v0) * i / 20, at = from + (to - from) * i / 20;
      CagVec3 p, n0, n1;
      MUST(cag_curve_point(whole[0], at, &p, err));
      assert_point(surface_at(s, 1, v), p, 1e-10, "first");
      assert_point(surface_at(s, 0, v), cag_scaled(p, 1 / (1 + cag_dot(image, p))), 1e-10,
                   "second");
      MUST(cag_surface_normal(s, 0.2, v, &n0, err));
      MUST(cag_surface_normal(s, 0.9, v, &n1, err));
      assert_point(n1, n0, 1e-9, "normal");
      assert_near(cag_dot(n0, cag_unit(p)), 0, 1e-9, "ruling");
    }
    if (one_piece) assert_consistent(s);
    // The knots of the first curve are breaks.
    double *cuts;
    size_t pieces;
    MUST(cag_surface_cuts(s, 1, &cuts, &pieces, err));
    for (size_t i = (size_t)degree + 1; i < n; i++) {
      const double v = (knots[i] - from) / (to - from);
      double nearest = INFINITY;
      for (size_t k = 0; k <= pieces; k++) nearest = fmin(nearest, fabs(cuts[k] - v));
      if (v > 0 && v < 1) assert_near(nearest, 0, 1e-12, "break");
    }
    free(cuts);
    cag_surface_release(s);
    for (int k = 0; k < 2; k++) {
      cag_curve_release(part[k]);
      cag_curve_release(whole[k]);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(coons_of_example_12),
      cmocka_unit_test(coons_patches_blend_sides_of_any_range),
      cmocka_unit_test(bicubic_patches_of_the_reference),
      cmocka_unit_test(adini_twists_keep_bilinear_patches),
      cmocka_unit_test(composite_surface_uniform),
      cmocka_unit_test(composite_surface_nonuniform),
      cmocka_unit_test(developables_join_parallel_tangents),
      cmocka_unit_test(developables_of_closed_curves_go_round),
      cmocka_unit_test(developables_of_oblique_sections_are_cylinders),
      cmocka_unit_test(developables_of_curves_on_a_cone_are_the_cone),
      cmocka_unit_test(bezier_triangles_of_the_reference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
