// Circles tangent to three circles, lines, or points. Each result is checked by its distances. The
// numbers of results are the classical ones for each combination in general position, or follow from
// the position.

#include "conic_support.h"
#include "geom/curve/circles.h"

#define CIRCLE(x, y, r)                                                                            \
  { {x, y, 0}, {0, 0, 0}, r }
#define LINE(x, y, dx, dy)                                                                         \
  { {x, y, 0}, {dx, dy, 0}, 0 }
#define POINT(x, y)                                                                                \
  { {x, y, 0}, {0, 0, 0}, 0 }

// How far a circle is from touching.
static double gap_of(const CagTouched *t, const CagTangentCircle *c) {
  const CagVec3 d = cag_sub(c->center, t->p);
  if (t->radius == 0 && cag_norm(t->d) > 0)
    return fabs(fabs(cag_cross(cag_unit(t->d), d).z) - c->radius);
  return fmin(fabs(cag_norm(d) - c->radius - t->radius),
              fabs(cag_norm(d) - fabs(c->radius - t->radius)));
}

static size_t count_tangent(const CagTouched t[3], double size) {
  CagTangentCircle found[CAG_TANGENT_CIRCLES];
  size_t n;
  OK(cag_circles_tangent(t, found, &n, &err));
  for (size_t i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++)
      assert_true(gap_of(&t[k], &found[i]) <= 1e-9 * (size + found[i].radius));
    for (size_t k = 0; k < i; k++) {
      assert_true(found[k].radius <= found[i].radius * (1 + 1e-6));
      assert_true(cag_norm(cag_sub(found[i].center, found[k].center)) +
                      fabs(found[i].radius - found[k].radius) >
                  1e-6 * size);
    }
  }
  return n;
}

typedef struct Case {
  CagTouched touched[3];
  size_t count;
} Case;

static void the_classical_cases_have_their_numbers(void **state) {
  (void)state;
  static const Case cases[] = {
      {{CIRCLE(0, 0, 1), CIRCLE(6, 0, 1.5), CIRCLE(1, 7, 2)}, 8},
      {{CIRCLE(0, 0, 1), CIRCLE(6, 0, 1), CIRCLE(3, 5, 1)}, 8},
      {{POINT(0, 0), POINT(4, 0), POINT(1, 3)}, 1},
      {{POINT(0, 0), POINT(4, 0), LINE(0, 2, 1, 0)}, 1}, // parallel to the points
      {{POINT(0, 0), POINT(4, 1), LINE(0, 2, 1, 0)}, 2},
      {{POINT(0, 0), POINT(4, 1), LINE(0, 0.5, 1, 0)}, 0}, // the line is between the points
      {{POINT(3, 1), LINE(0, 0, 1, 0), LINE(0, 0, 0, 1)}, 2},
      {{LINE(0, 0, 1, 0), LINE(0, 0, 0, 1), LINE(4, 0, -4, 3)}, 4},
      {{LINE(0, 0, 1, 0), LINE(0, 2, 1, 0), LINE(0, 0, 1, 1)}, 2}, // two are parallel
      {{LINE(0, 0, 1, 0), LINE(0, 2, 1, 0), LINE(0, 5, 1, 0)}, 0},
      {{LINE(0, 0, 1, 0), LINE(0, 0, 1, 1), LINE(0, 0, -1, 2)}, 0}, // through one point
      {{POINT(5, 0), POINT(5, 1), CIRCLE(0, 0, 1)}, 2},
      {{POINT(0.2, 0), POINT(5, 1), CIRCLE(0, 0, 1)}, 0},
      {{POINT(5, 1), CIRCLE(0, 0, 1), CIRCLE(2, 6, 1.5)}, 4},
      {{POINT(4, 2), LINE(0, -3, 1, 0), CIRCLE(0, 0, 1)}, 4},
      {{LINE(0, 0, 1, 0), LINE(0, 0, 0, 1), CIRCLE(0.5, 0.25, 2)}, 8},
      {{LINE(0, -3, 1, 0), CIRCLE(0, 0, 1), CIRCLE(4, 1, 1.5)}, 8},
      {{LINE(0, 0, 1, 0), LINE(0, 2, 1, 0), CIRCLE(0, 1, 0.5)}, 4},
      {{CIRCLE(0, 0, 1), CIRCLE(0, 0, 3), CIRCLE(0, 0, 2)}, 0},   // concentric
      {{CIRCLE(0, 0, 1), CIRCLE(0, 0, 3), CIRCLE(2, 0, 0.5)}, 8}, // the third between the others
      {{CIRCLE(0, 0, 5), CIRCLE(1, 0, 1), CIRCLE(20, 0, 1)}, 0},  // separated by the first
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const size_t n = count_tangent(cases[i].touched, 10);
    if (n != cases[i].count) fail_msg("case %zu: %zu circles, not %zu", i, n, cases[i].count);
  }
}

// Soddy's circles of three unit circles that touch each other: radii 2 / sqrt(3) - 1 and 2 / sqrt(3)
// + 1 (Descartes' theorem). The given circles count as solutions too, but are left out.
static void touching_circles_have_two(void **state) {
  (void)state;
  const CagTouched t[3] = {CIRCLE(-1, 0, 1), CIRCLE(1, 0, 1), CIRCLE(0, sqrt(3), 1)};
  CagTangentCircle found[CAG_TANGENT_CIRCLES];
  size_t n;
  OK(cag_circles_tangent(t, found, &n, &err));
  assert_int_equal(n, 2);
  NEAR(found[0].radius, 2 / sqrt(3) - 1, 1e-9);
  NEAR(found[1].radius, 2 / sqrt(3) + 1, 1e-9);
}

static void families_without_end_are_refused(void **state) {
  (void)state;
  static const CagTouched cases[][3] = {
      {POINT(1, 2), POINT(1, 2), CIRCLE(0, 0, 1)},
      {CIRCLE(3, 1, 2), LINE(0, 9, 1, 1), CIRCLE(3, 1, 2)},
      {LINE(0, 0, 1, 0), LINE(5, 0, -2, 0), LINE(0, 2, 1, 0)},
      {CIRCLE(0, 1, 1), CIRCLE(0, 2, 2), LINE(0, 0, 1, 0)}, // all touch at the origin
      {CIRCLE(0, 1, 1), POINT(0, 0), CIRCLE(0, -3, 3)},
  };
  CagTangentCircle found[CAG_TANGENT_CIRCLES];
  size_t n;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    FAILS(cag_circles_tangent(cases[i], found, &n, &err), "infinitely-many");
}

// The number does not depend on the position, the size, or the order.
static void random_circles_that_are_apart_have_eight(void **state) {
  (void)state;
  for (int k = 0; k < 300; k++) {
    const double scale = pow(10, uniform(-6, 6)), shift = scale * uniform(-50, 50);
    CagTouched t[3];
    for (int i = 0; i < 3; i++) {
      const double angle = 2 * M_PI * (i + uniform(-0.1, 0.1)) / 3;
      t[i] = (CagTouched){{shift + scale * 5 * cos(angle), scale * 5 * sin(angle), 0},
                          {0, 0, 0},
                          scale * uniform(0.3, 2)};
    }
    assert_int_equal(count_tangent(t, scale * 60), 8);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_classical_cases_have_their_numbers),
      cmocka_unit_test(touching_circles_have_two),
      cmocka_unit_test(families_without_end_are_refused),
      cmocka_unit_test(random_circles_that_are_apart_have_eight),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
