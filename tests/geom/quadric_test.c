// Quadrics: the classes and numbers of the reference, invariance under motions, and real pieces.

#include "surface_support.h"

typedef struct Case {
  const char *id;
  double c[10];
  const char *name;
  int rank3, rank4;
  double semi[3];
} Case;

// quadric.std-* of the golden vectors, and the classes that they omit (closed forms).
static const Case CASES[] = {
    {"std-ellipsoid", {1, 4, 9, 0, 0, 0, 0, 0, 0, -36}, "ellipsoid", 3, 4, {6, 3, 2}},
    {"std-ellipsoid-of-revolution", {4, 4, 1, 0, 0, 0, 0, 0, 0, -16}, "ellipsoid", 3, 4, {2, 2, 4}},
    {"std-sphere", {4, 4, 4, 0, 0, 0, 0, 0, 0, -36}, "ellipsoid", 3, 4, {3, 3, 3}},
    {"std-elliptic-cylinder",
     {4, 1, 0, 0, 0, 0, 0, 0, 0, -4},
     "elliptic-cylinder",
     2,
     3,
     {1, 2, 0}},
    {"std-circular-cylinder",
     {4, 4, 0, 0, 0, 0, 0, 0, 0, -36},
     "elliptic-cylinder",
     2,
     3,
     {3, 3, 0}},
    {"std-cylinder-kappa-0", {4, 1, 0, 0, 0, 0, 0, 0, 0, 0}, "line", 2, 2, {0}},
    {"std-cylinder-kappa-negative",
     {4, 1, 0, 0, 0, 0, 0, 0, 0, 4},
     "imaginary-elliptic-cylinder",
     2,
     3,
     {1, 2, 0}},
    {"std-elliptic-cone", {4, 1, -4, 0, 0, 0, 0, 0, 0, 0}, "cone", 3, 3, {1, 2, 1}},
    {"std-circular-cone",
     {1, 1, -3, 0, 0, 0, 0, 0, 0, 0},
     "cone",
     3,
     3,
     {1.7320508075688772, 1.7320508075688772, 1}},
    {"std-point", {1, 2, 3, 0, 0, 0, 0, 0, 0, 0}, "point", 3, 3, {0}},
    {"std-imaginary-ellipsoid",
     {1, 2, 3, 0, 0, 0, 0, 0, 0, 5},
     "imaginary-ellipsoid",
     3,
     4,
     {2.23606797749979, 1.5811388300841898, 1.2909944487358056}},
    {"std-hyperboloid-1", {1, 4, -9, 0, 0, 0, 0, 0, 0, -36}, "hyperboloid-1", 3, 4, {6, 3, 2}},
    {"std-hyperboloid-1-of-revolution",
     {4, 4, -1, 0, 0, 0, 0, 0, 0, -4},
     "hyperboloid-1",
     3,
     4,
     {1, 1, 2}},
    {"std-hyperboloid-2", {-1, -4, 9, 0, 0, 0, 0, 0, 0, -36}, "hyperboloid-2", 3, 4, {6, 3, 2}},
    {"std-elliptic-paraboloid",
     {1, 4, 0, 0, 0, 0, 0, 0, -2, 0},
     "elliptic-paraboloid",
     2,
     4,
     {1.4142135623730951, 0.70710678118654757, 0}},
    {"std-paraboloid-of-revolution",
     {1, 1, 0, 0, 0, 0, 0, 0, 2, 0},
     "elliptic-paraboloid",
     2,
     4,
     {1.4142135623730951, 1.4142135623730951, 0}},
    {"std-hyperbolic-paraboloid",
     {1, -4, 0, 0, 0, 0, 0, 0, -2, 0},
     "hyperbolic-paraboloid",
     2,
     4,
     {1.4142135623730951, 0.70710678118654757, 0}},
    {"std-hyperbolic-paraboloid-equal",
     {1, -1, 0, 0, 0, 0, 0, 0, -2, 0},
     "hyperbolic-paraboloid",
     2,
     4,
     {1.4142135623730951, 1.4142135623730951, 0}},
    {"std-hyperbolic-paraboloid-gamma-0",
     {1, -4, 0, 0, 0, 0, 0, 0, 0, 0},
     "intersecting-planes",
     2,
     2,
     {1, 0.5, 0}},
    {"std-parabolic-cylinder",
     {1, 0, 0, 0, 0, 0, 0, 0, -2, 0},
     "parabolic-cylinder",
     1,
     3,
     {0.5, 0, 0}},
    {"hyperbolic cylinder",
     {1, -4, 0, 0, 0, 0, 0, 0, 0, -4},
     "hyperbolic-cylinder",
     2,
     3,
     {2, 1, 0}},
    {"parallel planes", {1, 0, 0, 0, 0, 0, 0, 0, 0, -9}, "parallel-planes", 1, 2, {3, 0, 0}},
    {"imaginary parallel planes",
     {1, 0, 0, 0, 0, 0, 0, 0, 0, 9},
     "imaginary-parallel-planes",
     1,
     2,
     {0}},
    {"coincident planes", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "coincident-planes", 1, 1, {0}},
    {"plane", {0, 0, 0, 0, 0, 0, 1, 2, 2, -9}, "plane", 0, 2, {0}},
    {"empty", {0, 0, 0, 0, 0, 0, 0, 0, 0, 5}, "empty", 0, 1, {0}},
};
#define CASE_COUNT (sizeof CASES / sizeof *CASES)

static int ascending(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void every_class_is_told_as_in_the_reference(void **state) {
  (void)state;
  for (size_t i = 0; i < CASE_COUNT; i++) {
    CagQuadric q;
    CagQuadricForm f;
    memcpy(q.c, CASES[i].c, sizeof q.c);
    MUST(cag_quadric_classify(&q, &f, err));
    if (strcmp(f.name, CASES[i].name) != 0)
      fail_msg("%s: expected %s, found %s", CASES[i].id, CASES[i].name, f.name);
    assert_int_equal(f.rank3, CASES[i].rank3);
    assert_int_equal(f.rank4, CASES[i].rank4);
    for (int k = 0; k < 3; k++) assert_near(f.semi[k], CASES[i].semi[k], 1e-12, CASES[i].id);
    // Standard equations are aligned with the world's axes.
    if (f.rank3 >= 2 && strcmp(CASES[i].id, "std-paraboloid-of-revolution") != 0)
      for (int k = 0; k < 3; k++) assert_near(f.frame.m[k][k], 1, 1e-15, CASES[i].id);
  }
}

// x^2/25 + y^2/9 + z^2/4 = 1 has exact semi-axes: the reduction scales units without losing digits.
static void round_semi_axes_come_out_round(void **state) {
  (void)state;
  const CagQuadric q = {{1 / 25.0, 1 / 9.0, 1 / 4.0, 0, 0, 0, 0, 0, 0, -1}};
  CagQuadricForm f;
  MUST(cag_quadric_classify(&q, &f, err));
  assert_true(f.semi[0] == 5 && f.semi[1] == 3 && f.semi[2] == 2);
}

// Class, ranks, and semi-axes do not change if the quadric is moved, its equation is multiplied by
// a negative number, or the drawing is scaled to other units.
static void classes_survive_motions_and_units(void **state) {
  (void)state;
  CagTransform turn, shift, scale, map;
  MUST(cag_rotate(cag_vec3(1, -2, 0.5), 1.1, cag_vec3(0, 0, 0), &turn, err));
  shift = cag_translate(cag_vec3(3, -7, 11));
  for (int unit = 0; unit < 3; unit++) {
    double k = unit == 0 ? 1 : unit == 1 ? 1e4 : 1e-4;
    MUST(cag_scale(cag_vec3(k, k, k), cag_vec3(0, 0, 0), &scale, err));
    map = cag_transform_multiply(&shift, &turn);
    map = cag_transform_multiply(&scale, &map);
    for (size_t i = 0; i < CASE_COUNT; i++) {
      CagQuadric q, moved;
      CagQuadricForm f;
      memcpy(q.c, CASES[i].c, sizeof q.c);
      MUST(cag_quadric_transform(&q, &map, &moved, err));
      for (int j = 0; j < 10; j++) moved.c[j] *= -3.5;
      MUST(cag_quadric_classify(&moved, &f, err));
      if (strcmp(f.name, CASES[i].name) != 0)
        fail_msg("%s, unit %g: expected %s, found %s", CASES[i].id, k, CASES[i].name, f.name);
      double found[3], expected[3];
      bool ratio = strcmp(f.name, "cone") == 0 || strcmp(f.name, "intersecting-planes") == 0;
      bool paraboloid = strstr(f.name, "paraboloid") != NULL;
      for (int j = 0; j < 3; j++) {
        found[j] = f.semi[j] / (ratio ? 1 : paraboloid ? sqrt(k) : k);
        expected[j] = CASES[i].semi[j];
      }
      // A pair of planes has no first axis: 1 : b and 1 : 1/b are equivalent.
      if (strcmp(f.name, "intersecting-planes") == 0 && found[1] > 1) found[1] = 1 / found[1];
      qsort(found, 3, sizeof *found, ascending);
      qsort(expected, 3, sizeof *expected, ascending);
      for (int j = 0; j < 3; j++) assert_near(found[j], expected[j], 1e-8, CASES[i].id);
      // The frame is rigid and right-handed.
      CagTransform rigid = f.frame;
      assert_near(cag_transform_determinant(&rigid), 1, 1e-12, "determinant of the frame");
    }
  }
}

// quadric.center-eq21, quadric.translate-eq19-20
static void centers_and_translations_have_the_numbers_of_the_reference(void **state) {
  (void)state;
  const CagQuadric q = {{2, 3, 4, 1, -2, 0.5, -1, 2, 3, -7}};
  CagQuadricForm f;
  MUST(cag_quadric_classify(&q, &f, err));
  assert_true(f.has_center);
  assert_point(f.center, cag_vec3(0.46808510638297873, -0.5957446808510638, -0.553191489361702),
               1e-12, "center");
  const double expected[10] = {2, 3, 4, 1, -2, 0.5, 1, -7.5, 21.25, 20};
  CagTransform back = cag_translate(cag_vec3(-0.5, 1, -2));
  CagQuadric moved;
  MUST(cag_quadric_transform(&q, &back, &moved, err));
  for (int i = 0; i < 10; i++) assert_near(moved.c[i], expected[i], 1e-12, "coefficient");
  const CagQuadric saddle = {{1, 4, 0, 0, 0, 0, 0, 0, -2, 0}};
  MUST(cag_quadric_classify(&saddle, &f, err));
  assert_false(f.has_center);
  const CagQuadric zero = {{0}};
  MUST_FAIL(cag_quadric_classify(&zero, &f, err), "zero-quadric");
}

// A small sphere far from the origin is still a sphere.
static void a_far_quadric_keeps_its_class(void **state) {
  (void)state;
  CagQuadric q = {{1, 1, 1, 0, 0, 0, 0, 0, 0, -1}}, moved;
  CagQuadricForm f;
  CagTransform t = cag_translate(cag_vec3(20000, 0, 5000));
  MUST(cag_quadric_transform(&q, &t, &moved, err));
  MUST(cag_quadric_classify(&moved, &f, err));
  assert_string_equal(f.name, "ellipsoid");
  assert_near(f.semi[0], 1, 1e-6, "radius");
}

typedef struct Param {
  CagQuadricShape shape;
  double scale[3], u, v;
  CagVec3 point, du, dv;
} Param;

#define DEG (M_PI / 180)
// quadric.param-*: a = 3, b = 2, c = 1.5, where they occur.
static const Param PARAMS[] = {
    {CAG_SHAPE_ELLIPSOID,
     {3, 2, 1.5},
     35 * DEG,
     0.8,
     {1.7628711250305122, 0.8229171004257306, 1.0450600640207481},
     {-1.234375650638596, 1.1752474166870082, 0},
     {1.7121261756947614, 0.7992291030584223, -1.0760341363492842}},
    {CAG_SHAPE_HYPERBOLOID_ONE,
     {3, 2, 1.5},
     35 * DEG,
     0.8,
     {3.286687711107455, 1.5342423407057706, 1.3321589732814347},
     {-2.3013635110586557, 2.1911251407383032, 0},
     {2.1824814925628235, 1.0187933287304447, 2.0061524194572673}},
    {CAG_SHAPE_ELLIPTIC_PARABOLOID,
     {3, 2, 1},
     35 * DEG,
     0.8,
     {1.965964906293581, 0.9177222981616735, 0.64},
     {-1.3765834472425105, 1.3106432708623872, 0},
     {2.4574561328669757, 1.1471528727020919, 1.6}},
    {CAG_SHAPE_CONE,
     {3, 2, 1.5},
     35 * DEG,
     0.8,
     {1.965964906293581, 0.9177222981616735, 1.2},
     {-1.3765834472425105, 1.3106432708623872, 0},
     {2.4574561328669757, 1.1471528727020919, 1.5}},
    {CAG_SHAPE_ELLIPTIC_CYLINDER,
     {3, 2, 1},
     35 * DEG,
     0.8,
     {2.4574561328669757, 1.1471528727020919, 0.8},
     {-1.7207293090531377, 1.6383040885779838, 0},
     {0, 0, 1}},
    {CAG_SHAPE_PARABOLIC_CYLINDER, {3, 3, 1}, 0.6, 0.8, {1.08, 3.6, 0.8}, {3.6, 6, 0}, {0, 0, 1}},
};

static CagTransform diagonal(const double d[3]) {
  CagTransform t = cag_transform_identity();
  t.planar = false;
  for (int i = 0; i < 3; i++) t.m[i][i] = d[i];
  return t;
}

static void parametric_forms_have_the_points_of_the_reference(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof PARAMS / sizeof *PARAMS; i++) {
    const Param *p = &PARAMS[i];
    CagTransform frame = diagonal(p->scale);
    CagSurface *s;
    CagVec3 d[4];
    MUST(cag_surface_quadric(p->shape, &frame, 0, 1, 0, 1, &s, err));
    MUST(cag_surface_eval(s, p->u, p->v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err));
    assert_point(d[0], p->point, 1e-12, "point");
    assert_point(d[cag_partial(1, 1, 0)], p->du, 1e-12, "d_theta");
    assert_point(d[cag_partial(1, 0, 1)], p->dv, 1e-12, "d_phi");
    cag_surface_release(s);
  }
}

// Points of all shapes, their exact NURBS forms, and their images satisfy the equation of the
// surface.
static void assert_on_equation(const CagSurface *s, const CagQuadric *q) {
  double largest = 0;
  for (int k = 0; k < 10; k++) largest = fmax(largest, fabs(q->c[k]));
  for (int i = 0; i <= 12; i++)
    for (int j = 0; j <= 12; j++) {
      CagVec3 p = surface_at(s, s->u0 + (s->u1 - s->u0) * i / 12, s->v0 + (s->v1 - s->v0) * j / 12);
      assert_near(cag_quadric_value(q, p) / (largest * (1 + cag_dot(p, p))), 0, 1e-13, "equation");
    }
}

static void all_shapes_lie_on_their_equation(void **state) {
  (void)state;
  for (int shape = CAG_SHAPE_ELLIPSOID; shape <= CAG_SHAPE_HYPERBOLIC_CYLINDER; shape++) {
    const double size[3] = {3, 2, 1.5};
    CagTransform frame = diagonal(size), turn;
    CagSurface *s, *moved, *exact;
    CagQuadric q;
    MUST(cag_surface_quadric((CagQuadricShape)shape, &frame, 0.2, 1.9, 0.3, 1.4, &s, err));
    assert_true(cag_surface_quadric_view(s, &q));
    assert_on_equation(s, &q);
    assert_consistent(s);
    assert_transforms(s);
    MUST(cag_surface_to_nurbs(s, &exact, err));
    assert_on_equation(exact, &q);
    for (int corner = 0; corner < 4; corner++)
      assert_point(
          surface_at(exact, corner & 1 ? exact->u1 : exact->u0, corner & 2 ? exact->v1 : exact->v0),
          surface_at(s, corner & 1 ? s->u1 : s->u0, corner & 2 ? s->v1 : s->v0), 1e-12, "corner");
    MUST(cag_rotate(cag_vec3(1, 1, 2), 2, cag_vec3(1, 0, 0), &turn, err));
    MUST(cag_surface_transform(s, &turn, &moved, err));
    assert_true(cag_surface_quadric_view(moved, &q));
    assert_on_equation(moved, &q);
    cag_surface_release(exact);
    cag_surface_release(moved);
    cag_surface_release(s);
  }
}

static size_t patches(const double c[10], const CagBounds *within, bool z_only, CagSurface ***out) {
  CagQuadric q;
  size_t n = 0;
  memcpy(q.c, c, sizeof q.c);
  MUST(cag_quadric_patches(&q, within, z_only, out, &n, err));
  for (size_t i = 0; i < n; i++) assert_on_equation((*out)[i], &q);
  return n;
}

static void release(CagSurface **list, size_t n) {
  for (size_t i = 0; i < n; i++) cag_surface_release(list[i]);
  free(list);
}

static void pieces_are_cut_at_the_range_of_z(void **state) {
  (void)state;
  const CagBounds range = {{0, 0, -1}, {0, 0, 3}};
  CagSurface **list;
  size_t n;
  // A sphere of radius 2 between z = -1 and its top: the area of the zone is 2 pi r h.
  const double sphere[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -4};
  n = patches(sphere, &range, true, &list);
  assert_int_equal(n, 1);
  assert_area(list[0], 2 * M_PI * 2 * 3);
  assert_bounds(list[0], cag_vec3(-2, -2, -1), cag_vec3(2, 2, 2));
  release(list, n);
  n = patches(sphere, NULL, false, &list);
  assert_area(list[0], 16 * M_PI);
  release(list, n);
  // A cone x^2 + y^2 = z^2: two nappes that meet at the apex, of slant sqrt 2.
  const double cone[10] = {1, 1, -1, 0, 0, 0, 0, 0, 0, 0};
  n = patches(cone, &range, true, &list);
  assert_int_equal(n, 2);
  assert_area(list[0], M_PI * 9 * sqrt(2));
  assert_area(list[1], M_PI * sqrt(2));
  assert_true(list[0]->pole_v0 && list[1]->pole_v1);
  release(list, n);
  // Two sheets z^2 - x^2 - y^2 = 1, of which only the upper one reaches -1..3.
  const double two[10] = {-1, -1, 1, 0, 0, 0, 0, 0, 0, -1};
  n = patches(two, &range, true, &list);
  assert_int_equal(n, 1);
  assert_bounds(list[0], cag_vec3(-sqrt(8), -sqrt(8), 1), cag_vec3(sqrt(8), sqrt(8), 3));
  release(list, n);
  // A paraboloid z = x^2 + y^2 up to 3: area pi / 6 ((1 + 4 z)^(3/2) - 1).
  const double bowl[10] = {1, 1, 0, 0, 0, 0, 0, 0, -1, 0};
  n = patches(bowl, &range, true, &list);
  assert_area(list[0], M_PI / 6 * (pow(13, 1.5) - 1));
  release(list, n);
  // x^2 + y^2 - z^2 = 1.
  const double one[10] = {1, 1, -1, 0, 0, 0, 0, 0, 0, -1};
  n = patches(one, &range, true, &list);
  assert_bounds(list[0], cag_vec3(-sqrt(10), -sqrt(10), -1), cag_vec3(sqrt(10), sqrt(10), 3));
  release(list, n);
  const double cylinder[10] = {1, 1, 0, 0, 0, 0, -4, 0, 0, 0};
  n = patches(cylinder, &range, true, &list);
  assert_area(list[0], 2 * M_PI * 2 * 4);
  release(list, n);
}

static void pieces_within_a_box(void **state) {
  (void)state;
  const CagBounds box = {{-3, -2, -1}, {3, 2, 5}};
  CagSurface **list;
  // z = x^2 - y^2, which meets all sides of the box.
  const double saddle[10] = {1, -1, 0, 0, 0, 0, 0, 0, -1, 0};
  size_t n = patches(saddle, &box, false, &list);
  CagBounds part;
  assert_int_equal(n, 1);
  MUST(cag_surface_bounds(list[0], &part, err));
  assert_point(part.min, cag_vec3(-3, -2, -1), 1e-9, "saddle");
  assert_point(part.max, cag_vec3(3, 2, 5), 1e-9, "saddle");
  release(list, n);
  // y^2 = 4 x within |y| <= 2, so up to x = 1, and between z = -1 and 5.
  const double parabolic[10] = {0, 1, 0, 0, 0, 0, -4, 0, 0, 0};
  n = patches(parabolic, &box, false, &list);
  assert_bounds(list[0], cag_vec3(0, -2, -1), cag_vec3(1, 2, 5));
  release(list, n);
  const double hyperbolic[10] = {1, -1, 0, 0, 0, 0, 0, 0, 0, -1};
  n = patches(hyperbolic, &box, false, &list);
  assert_int_equal(n, 2);
  assert_bounds(list[0], cag_vec3(1, -2, -1), cag_vec3(sqrt(5), 2, 5));
  assert_bounds(list[1], cag_vec3(-sqrt(5), -2, -1), cag_vec3(-1, 2, 5));
  release(list, n);
  // Planes are trimmed exactly: x = +-2 is 4 x 6 in the box, and x = y is 2 sqrt2 2 x 6.
  const double parallel[10] = {1, 0, 0, 0, 0, 0, 0, 0, 0, -4};
  n = patches(parallel, &box, false, &list);
  assert_int_equal(n, 2);
  assert_area(list[0], 24);
  release(list, n);
  const double crossing[10] = {1, -1, 0, 0, 0, 0, 0, 0, 0, 0};
  n = patches(crossing, &box, false, &list);
  assert_int_equal(n, 2);
  assert_area(list[1], 4 * sqrt(2) * 6);
  release(list, n);
  // x + y + z = 9 cuts off a corner: the triangle at [3, 2, 5].
  const double plane[10] = {0, 0, 0, 0, 0, 0, 1, 1, 1, -9};
  n = patches(plane, &box, false, &list);
  assert_area(list[0], sqrt(3) / 2);
  release(list, n);
}

// Elliptic cylinders in random boxes: their strips are inside, and as wide as the range of angles
// inside the box.
static void cylinders_end_at_all_sides_of_a_box(void **state) {
  (void)state;
  enum { ANGLES = 20000 };
  uint64_t random = 12;
  int cut = 0;
  for (int i = 0; i < 100; i++) {
    double r[6];
    for (int k = 0; k < 6; k++) {
      random = random * 6364136223846793005u + 1442695040888963407u;
      r[k] = (double)(random >> 11) / 9007199254740992.0;
    }
    const double radius = 3;
    const CagQuadric q = {{1, 1, 0, 0, 0, 0, 0, 0, 0, -radius * radius}};
    const CagBounds box = {{-4 + 6 * r[0], -4 + 6 * r[1], 1},
                           {-4 + 6 * r[0] + 1 + 5 * r[2], -4 + 6 * r[1] + 1 + 5 * r[3], 3}};
    int within = 0;
    for (int k = 0; k < ANGLES; k++) {
      const double t = 2 * M_PI * k / ANGLES, x = radius * cos(t), y = radius * sin(t);
      within += x >= box.min.x && x <= box.max.x && y >= box.min.y && y <= box.max.y;
    }
    CagSurface **list;
    CagError why;
    size_t n = 0;
    double sum = 0, area;
    if (cag_quadric_patches(&q, &box, false, &list, &n, &why)) {
      assert_string_equal(cag_error_info(why.id)->reason, "quadric-outside");
      assert_true(within <= 1);
      continue;
    }
    cut += within < ANGLES;
    for (size_t k = 0; k < n; k++) {
      CagBounds part;
      MUST(cag_surface_area(list[k], &area, NULL, err));
      MUST(cag_surface_bounds(list[k], &part, err));
      sum += area;
      const double slack = 1e-12;
      assert_true(part.min.x >= box.min.x - slack && part.max.x <= box.max.x + slack);
      assert_true(part.min.y >= box.min.y - slack && part.max.y <= box.max.y + slack);
      assert_near(part.min.z, 1, slack, "bottom");
      assert_near(part.max.z, 3, slack, "top");
    }
    // Each end of a strip is between two sampled angles.
    const double coarse = 8.0 / ANGLES;
    assert_near(sum / (2 * M_PI * radius * 2), (double)within / ANGLES, coarse, "area");
    release(list, n);
  }
  assert_true(cut > 30);
}

static void what_has_no_surface_says_why(void **state) {
  (void)state;
  CagSurface **list;
  size_t n;
  const CagBounds box = {{-1, -1, -1}, {1, 1, 1}};
  const CagQuadric imaginary = {{1, 1, 1, 0, 0, 0, 0, 0, 0, 1}};
  const CagQuadric cylinder = {{1, 1, 0, 0, 0, 0, 0, 0, 0, -1}};
  const CagQuadric saddle = {{1, -1, 0, 0, 0, 0, 0, 0, -1, 0}};
  const CagQuadric far = {{1, 1, 1, 0, 0, 0, 0, 0, -20, 99}};
  MUST_FAIL(cag_quadric_patches(&imaginary, NULL, false, &list, &n, err), "quadric-imaginary");
  MUST_FAIL(cag_quadric_patches(&cylinder, NULL, false, &list, &n, err), "quadric-unbounded");
  MUST_FAIL(cag_quadric_patches(&saddle, &box, true, &list, &n, err), "quadric-unbounded");
  MUST_FAIL(cag_quadric_patches(&far, &box, false, &list, &n, err), "quadric-outside");
}

// Affine maps preserve the class. Each standard form, also with other integers as its signs and
// zeros, is transformed by affine maps with small integers, which is exact. Many of the matrices
// are nearly singular.
static void integer_matrices_keep_their_class_under_congruence(void **state) {
  (void)state;
  static const struct {
    const char *name;
    int squares[3], linear_z, constant;
  } forms[] = {
      {"ellipsoid", {1, 1, 1}, 0, -1},
      {"imaginary-ellipsoid", {1, 1, 1}, 0, 1},
      {"hyperboloid-1", {1, 1, -1}, 0, -1},
      {"hyperboloid-2", {1, 1, -1}, 0, 1},
      {"cone", {1, 1, -1}, 0, 0},
      {"point", {1, 1, 1}, 0, 0},
      {"elliptic-paraboloid", {1, 1, 0}, -1, 0},
      {"hyperbolic-paraboloid", {1, -1, 0}, -1, 0},
      {"elliptic-cylinder", {1, 1, 0}, 0, -1},
      {"imaginary-elliptic-cylinder", {1, 1, 0}, 0, 1},
      {"hyperbolic-cylinder", {1, -1, 0}, 0, -1},
      {"parabolic-cylinder", {1, 0, 0}, -1, 0},
      {"intersecting-planes", {1, -1, 0}, 0, 0},
      {"line", {1, 1, 0}, 0, 0},
      {"parallel-planes", {1, 0, 0}, 0, -1},
      {"imaginary-parallel-planes", {1, 0, 0}, 0, 1},
      {"coincident-planes", {1, 0, 0}, 0, 0},
  };
  enum { FORMS = sizeof forms / sizeof *forms };
  uint64_t random = 8;
  for (int i = 0; i < 250 * FORMS; i++) {
    long r[24], t[4][4] = {{0}}, m[4][4] = {{0}}, moved[4][4] = {{0}};
    for (int k = 0; k < 24; k++) {
      random = random * 6364136223846793005u + 1442695040888963407u;
      r[k] = (long)(random >> 33);
    }
    const long sign = r[0] % 2 ? 1 : -1;
    for (int k = 0; k < 3; k++) m[k][k] = sign * forms[i % FORMS].squares[k] * (1 + r[1 + k] % 3);
    m[2][3] = m[3][2] = sign * forms[i % FORMS].linear_z;
    m[3][3] = sign * forms[i % FORMS].constant * (1 + r[4] % 3);
    for (int k = 0; k < 12; k++) t[k / 4][k % 4] = r[5 + k] % 9 - 4;
    t[3][3] = 1;
    if (t[0][0] * (t[1][1] * t[2][2] - t[1][2] * t[2][1]) -
            t[0][1] * (t[1][0] * t[2][2] - t[1][2] * t[2][0]) +
            t[0][2] * (t[1][0] * t[2][1] - t[1][1] * t[2][0]) ==
        0)
      continue;
    for (int k = 0; k < 256; k++)
      moved[k / 64][k / 16 % 4] +=
          t[k / 4 % 4][k / 64] * m[k / 4 % 4][k % 4] * t[k % 4][k / 16 % 4];
    double rows[4][4];
    CagQuadric q;
    CagQuadricForm f;
    for (int k = 0; k < 16; k++) rows[k / 4][k % 4] = (double)moved[k / 4][k % 4];
    MUST(cag_quadric_from_rows((const double(*)[4])rows, &q, err));
    MUST(cag_quadric_classify(&q, &f, err));
    if (strcmp(f.name, forms[i % FORMS].name) != 0)
      fail_msg("number %d: expected %s, found %s", i, forms[i % FORMS].name, f.name);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_class_is_told_as_in_the_reference),
      cmocka_unit_test(round_semi_axes_come_out_round),
      cmocka_unit_test(classes_survive_motions_and_units),
      cmocka_unit_test(centers_and_translations_have_the_numbers_of_the_reference),
      cmocka_unit_test(a_far_quadric_keeps_its_class),
      cmocka_unit_test(parametric_forms_have_the_points_of_the_reference),
      cmocka_unit_test(all_shapes_lie_on_their_equation),
      cmocka_unit_test(pieces_are_cut_at_the_range_of_z),
      cmocka_unit_test(pieces_within_a_box),
      cmocka_unit_test(integer_matrices_keep_their_class_under_congruence),
      cmocka_unit_test(cylinders_end_at_all_sides_of_a_box),
      cmocka_unit_test(what_has_no_surface_says_why),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
