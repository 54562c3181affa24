// Helices compared with their definition, in any frame and direction.

#include "curve_random.h"

typedef struct Numbers {
  double radius, pitch, turns, taper;
} Numbers;

static Numbers random_numbers(int round) {
  Numbers n = {0};
  n.radius = uniform(0.2, 3);
  n.pitch = round % 5 ? uniform(-4, 4) : 0;
  n.turns = uniform(0.3, 4) * (round % 2 ? -1 : 1);
  if (round % 3) n.taper = uniform(-0.9, 2) * n.radius / fabs(n.turns);
  if (n.pitch == 0 && n.taper == 0) n.turns = fmin(1, fmax(-1, n.turns));
  return n;
}

// The defining point at a rotation angle.
static CagVec3 by_definition(const Numbers *n, double angle) {
  const double r = n->radius + n->taper * angle / (2 * M_PI);
  return cag_vec3(r * cos(angle), r * sin(angle) * (n->turns < 0 ? -1 : 1),
                  n->pitch * angle / (2 * M_PI));
}

static CagTransform random_map(void) {
  CagTransform t = random_frame();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) t.m[i][j] += uniform(-0.5, 0.5);
  return t;
}

// A helix that is transformed, trimmed, reversed, and reparametrized, with its frame and the map
// from its parameter to the angle.
typedef struct Sample {
  CagCurve *c;
  Numbers numbers;
  CagTransform map;
  double angle[2]; // at the start and the end
  bool plain;      // the parameter is the angle
} Sample;

static void replace(CagCurve **c, CagCurve *by) {
  cag_curve_release(*c);
  *c = by;
}

static Sample random_sample(int round) {
  Sample s = {.numbers = random_numbers(round), .map = random_map(), .plain = true};
  const Numbers *n = &s.numbers;
  CagCurve *next;
  OK(cag_curve_helix(n->radius, n->pitch, n->turns, n->taper, &s.c, &err));
  assert_true(s.c->angular);
  NEAR(s.c->start, 0, 0);
  NEAR(s.c->end, 2 * M_PI * fabs(n->turns), 1e-12);
  if (round % 7 == 0) s.map = cag_transform_identity();
  OK(cag_curve_transform(s.c, &s.map, &next, &err));
  replace(&s.c, next);
  if (round & 4) {
    const double a = uniform(0, 0.4), b = uniform(0.6, 1), end = s.c->end;
    OK(cag_curve_trim(s.c, a * end, b * end, &next, &err));
    replace(&s.c, next);
  }
  s.angle[0] = s.c->start;
  s.angle[1] = s.c->end;
  if (round & 8) {
    OK(cag_curve_reverse(s.c, &next, &err));
    replace(&s.c, next);
    s.angle[0] = s.c->end;
    s.angle[1] = s.c->start;
    s.plain = false;
  }
  if (round & 16) {
    const double a = uniform(-5, 5);
    OK(cag_curve_reparametrize(s.c, a, a + uniform(0.5, 8), &next, &err));
    replace(&s.c, next);
    s.plain = false;
  }
  return s;
}

static double angle_at(const Sample *s, double t) {
  const double part = (t - s->c->start) / (s->c->end - s->c->start);
  return s->angle[0] + part * (s->angle[1] - s->angle[0]);
}

static CagVec3 expected_at(const Sample *s, double t) {
  return cag_transform_point(&s->map, by_definition(&s->numbers, angle_at(s, t)));
}

static void points_are_those_of_the_definition(void **state) {
  (void)state;
  seed = 71;
  for (int round = 0; round < 320; round++) {
    Sample s = random_sample(round);
    CagCoil coil;
    assert_true(cag_curve_coil(s.c, &coil));
    for (int i = 0; i <= 10; i++) {
      const double t = s.c->start + (s.c->end - s.c->start) * i / 10;
      near_vec(at(s.c, t), expected_at(&s, t), 1e-11);
      const double angle = coil.phase + coil.rate * t, r = coil.radius + coil.growth * angle;
      CagVec3 p = cag_madd(coil.center, r * cos(angle), coil.x);
      p = cag_madd(cag_madd(p, r * sin(angle), coil.y), coil.climb * angle, coil.z);
      near_vec(p, expected_at(&s, t), 1e-11);
    }
    enum { MANY = 7, ORDER = 3 };
    CagVec3 many[MANY * (ORDER + 1)], one[ORDER + 1];
    double t[MANY];
    for (int i = 0; i < MANY; i++) t[i] = uniform(s.c->start, s.c->end);
    OK(cag_curve_eval_many(s.c, t, MANY, ORDER, many, &err));
    for (int i = 0; i < MANY; i++) {
      OK(cag_curve_eval(s.c, t[i], ORDER, CAG_SIDE_RIGHT, one, &err));
      for (int k = 0; k <= ORDER; k++) near_vec(many[i * (ORDER + 1) + k], one[k], 0);
    }
    // Only a helix whose parameter is the angle has these numbers.
    Numbers told;
    CagTransform frame;
    const bool view =
        cag_curve_helix_view(s.c, &told.radius, &told.pitch, &told.turns, &told.taper, &frame);
    assert_true(view == s.plain);
    if (view) {
      assert_true(told.radius == s.numbers.radius && told.pitch == s.numbers.pitch);
      assert_true(told.turns == s.numbers.turns && told.taper == s.numbers.taper);
      assert_false(frame.planar);
      for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) NEAR(frame.m[i][j], s.map.m[i][j], 1e-15);
    }
    cag_curve_release(s.c);
  }
}

// Boxes of parts contain their points, and are at most a third of the radius too wide. The bound of
// the second derivative is that of the larger end.
static void parts_have_close_boxes_and_bends(void **state) {
  (void)state;
  seed = 72;
  for (int round = 0; round < 160; round++) {
    Sample s = random_sample(round);
    const double way = s.c->end - s.c->start;
    const double a = s.c->start + way * (round % 3 ? uniform(0, 0.5) : 0);
    const double b = round % 2 ? a + (s.c->end - a) * uniform(0.05, 1) : s.c->end;
    enum { STEPS = 400 };
    CagBounds exact = CAG_BOUNDS_EMPTY, box = s.c->kind->hull(s.c, a, b);
    double bend, most = 0, rate;
    assert_true(cag_curve_helix_bend(s.c, a, b, &bend));
    for (int i = 0; i <= STEPS; i++) {
      CagVec3 d[3];
      const double t = i == STEPS ? b : a + (b - a) * i / STEPS;
      derivatives(s.c, t, 2, d);
      cag_bounds_add(&exact, d[0]);
      most = fmax(most, cag_norm(d[2]));
    }
    rate = fabs(s.angle[1] - s.angle[0]) / way;
    const double growth = s.numbers.taper / (2 * M_PI);
    const double r = fmax(fabs(s.numbers.radius + growth * angle_at(&s, a)),
                          fabs(s.numbers.radius + growth * angle_at(&s, b)));
    double stretch = 0; // of the frame, maximum over all directions
    for (int i = 0; i < 180; i++) {
      const double angle = i * M_PI / 180;
      const CagVec3 from = cag_vec3(cos(angle), sin(angle), 0);
      stretch = fmax(stretch, cag_norm(cag_sub(cag_transform_point(&s.map, from),
                                               cag_transform_point(&s.map, cag_vec3(0, 0, 0)))));
    }
    assert_true(most <= bend * (1 + 1e-12));
    NEAR(bend, rate * rate * hypot(r, 2 * growth) * stretch, 1e-3 * bend);
    const double over = hypot(r, 2 * growth) * stretch * 0.31; // (quarter turn)^2 / 8
    const double low[3] = {exact.min.x - box.min.x, exact.min.y - box.min.y,
                           exact.min.z - box.min.z};
    const double high[3] = {box.max.x - exact.max.x, box.max.y - exact.max.y,
                            box.max.z - exact.max.z};
    for (int k = 0; k < 3; k++) {
      assert_true(low[k] >= -1e-12 && low[k] <= over + 1e-3);
      assert_true(high[k] >= -1e-12 && high[k] <= over + 1e-3);
    }
    cag_curve_release(s.c);
  }
  CagCurve *line;
  double bend;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 2, 3), 3, &line, &err));
  assert_false(cag_curve_helix_bend(line, 0, 1, &bend));
  CagCoil coil;
  assert_false(cag_curve_coil(line, &coil));
  double n[4];
  CagTransform frame;
  assert_false(cag_curve_helix_view(line, &n[0], &n[1], &n[2], &n[3], &frame));
  cag_curve_release(line);
}

static void helices_that_would_stop_or_overlap_are_refused(void **state) {
  (void)state;
  static const struct {
    Numbers n;
    const char *reason;
  } cases[] = {
      {{0, 1, 2, 0}, "radius-not-positive"},
      {{-1, 1, 2, 1}, "radius-not-positive"},
      {{0, 1, 2, 0.5}, NULL},
      {{0, 1, -2, 0.5}, NULL},
      {{0, 1, -2, -0.5}, "radius-not-positive"},
      {{1, 1, 2, -0.5}, NULL},
      {{1, 1, -2, -0.5}, NULL},
      {{1, 1, 2, -0.501}, "radius-not-positive"},
      {{1, 1, -2, -0.501}, "radius-not-positive"},
      {{1, 1, 0, 0}, "empty-range"},
      {{1, 0, 1, 0}, NULL},
      {{1, 0, -1, 0}, NULL},
      {{1, 0, 1.01, 0}, "zero-pitch"},
      {{1, 0, -1.01, 0}, "zero-pitch"},
      {{1, 0, 2, 0.1}, NULL},
      {{1, 0, -2, 0.1}, NULL},
      {{1, -1, 2, 0}, NULL},
      {{1, 1, -2, 0}, NULL},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const Numbers *n = &cases[i].n;
    CagCurve *c;
    if (cases[i].reason) {
      FAILS(cag_curve_helix(n->radius, n->pitch, n->turns, n->taper, &c, &err), cases[i].reason);
    } else {
      OK(cag_curve_helix(n->radius, n->pitch, n->turns, n->taper, &c, &err));
      cag_curve_release(c);
    }
    for (int k = 0; k < 4; k++) {
      double bad[4] = {1, 1, 1, 0};
      bad[k] = i % 2 ? NAN : INFINITY;
      assert_int_not_equal(cag_curve_helix(bad[0], bad[1], bad[2], bad[3], &c, &err), CAG_OK);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_are_those_of_the_definition),
      cmocka_unit_test(parts_have_close_boxes_and_bends),
      cmocka_unit_test(helices_that_would_stop_or_overlap_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
