// The negative side of random conics within rectangles. Compares areas with integrals for all
// classes, with integer coefficients, and with conics far larger than the rectangle.

#include "box_integral.h"
#include "geom/curve/conic_side.h"
#include "quadric_support.h"

static double area_of_parts(const CagConic *c, const CagBounds *box, size_t *n) {
  CagRegion *parts[CAG_CONIC_PARTS];
  bool decided = false;
  double sum = 0;
  MUST(cag_conic_negative_parts(c, box, parts, n, &decided, err));
  assert_true(decided);
  for (size_t i = 0; i < *n; i++) {
    double area;
    MUST(cag_region_area(parts[i], &area, NULL, err));
    assert_true(area > 0);
    sum += area;
    cag_region_release(parts[i]);
  }
  return sum;
}

static CagConic product_of_lines(const double p[3], const double q[3], double sign) {
  return (CagConic){{sign * p[0] * q[0], sign * (p[0] * q[1] + p[1] * q[0]), sign * p[1] * q[1],
                     sign * (p[0] * q[2] + p[2] * q[0]), sign * (p[1] * q[2] + p[2] * q[1]),
                     sign * p[2] * q[2]}};
}

// General conics, conics with integer coefficients, crossing lines, parabolas, parallel lines, and
// ellipses.
static CagConic random_conic(int kind) {
  CagConic c;
  double p[3], q[3];
  for (int k = 0; k < 6; k++) c.c[k] = random_in(-1, 1);
  for (int k = 0; k < 3; k++) p[k] = random_in(-1, 1), q[k] = random_in(-1, 1);
  const double sign = random_in(-1, 1) < 0 ? -1 : 1;
  switch (kind) {
  case 1:
    for (int k = 0; k < 6; k++) c.c[k] = floor(3 * c.c[k]);
    return c;
  case 2: return product_of_lines(p, q, sign);
  case 3:
    c.c[0] = p[0] * p[0];
    c.c[1] = 2 * p[0] * p[1];
    c.c[2] = p[1] * p[1];
    return c;
  case 4:
    q[0] = p[0];
    q[1] = p[1];
    return product_of_lines(p, q, sign);
  case 5: return (CagConic){{1, random_in(-0.5, 0.5), 1, c.c[3], c.c[4], -random_in(0, 2)}};
  default: return c;
  }
}

static void parts_have_the_area_of_the_negative_side(void **state) {
  (void)state;
  const int rounds = 200;
  size_t most = 0;
  for (int i = 0; i < 6 * rounds; i++) {
    state_of_random = 77 + (uint64_t)i * 1000003;
    const CagConic c = random_conic(i % 6);
    const double *k = c.c;
    CagBounds box = {{random_in(-3, 0), random_in(-3, 0), -1},
                     {random_in(0.1, 3), random_in(0.1, 3), 1}};
    if (i % 6 == 1) box = (CagBounds){{-1, -1, -1}, {1, 2, 1}}; // through many corners
    if (k[0] == 0 && k[1] == 0 && k[2] == 0) continue;
    const CagQuadric form = {{k[0], k[2], 0, k[1], 0, 0, k[3], k[4], 0, k[5]}};
    const CagVec3 size = cag_sub(box.max, box.min);
    size_t n;
    const double area = area_of_parts(&c, &box, &n);
    assert_near(area / (size.x * size.y), area_at_z(&form, &box, 0) / (size.x * size.y), 1e-9,
                "area");
    if (n > most) most = n;
  }
  assert_true(most >= 2);
}

// A circle of radius r that touches y = 0 at the origin. In a square of side 1 above, the part
// outside the circle is the integral of x^2 / (2 r) + x^4 / (8 r^3) + ..., and the rest is inside.
static void large_conics_keep_their_digits(void **state) {
  (void)state;
  const CagBounds box = {{0, 0, 0}, {1, 1, 0}};
  size_t n;
  for (double r = 1e2; r < 1e9; r *= 10) {
    const CagConic circle = {{1 / (2 * r), 0, 1 / (2 * r), 0, -1, 0}};
    const double outside = 1 / (6 * r) + 1 / (40 * r * r * r);
    assert_near(1 - area_of_parts(&circle, &box, &n), outside, 1e-12, "large circle");
    assert_int_equal(n, 1);
  }
}

// Two lines through the center of a square of side 2 bound two triangles. A circle inside the
// square is one part, and its outside has a hole.
static void parts_are_separate(void **state) {
  (void)state;
  const CagBounds box = {{-1, -1, 0}, {1, 1, 0}};
  const CagConic cross = {{1, 0, -1, 0, 0, 0}};
  const CagConic inside = {{1, 0, 1, 0, 0, -0.25}}, outside = {{-1, 0, -1, 0, 0, 0.25}};
  size_t n;
  assert_near(area_of_parts(&cross, &box, &n), 2, 1e-12, "triangles");
  assert_int_equal(n, 2);
  assert_near(area_of_parts(&inside, &box, &n), M_PI / 4, 1e-12, "disc");
  assert_int_equal(n, 1);
  assert_near(area_of_parts(&outside, &box, &n), 4 - M_PI / 4, 1e-12, "hole");
  assert_int_equal(n, 1);
  // A circle through all four corners contains the square, and one that touches all four sides is a
  // disk.
  const CagConic around = {{1, 0, 1, 0, 0, -2}}, touching = {{1, 0, 1, 0, 0, -1}};
  assert_near(area_of_parts(&around, &box, &n), 4, 1e-12, "through the corners");
  assert_near(area_of_parts(&touching, &box, &n), M_PI, 1e-12, "touching the sides");
  assert_int_equal(n, 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_have_the_area_of_the_negative_side),
      cmocka_unit_test(large_conics_keep_their_digits),
      cmocka_unit_test(parts_are_separate),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
