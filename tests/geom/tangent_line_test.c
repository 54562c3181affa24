// Tangent lines of plane curves, compared with the crossings of the curves' duals. A line is
// represented by the angle of its direction, from 0 to pi, and its distance from the origin.

#include "conic_support.h"
#include "geom/curve/circles.h"
#include "geom/curve/function.h"

static CagVec3 random_location(double size) {
  CagVec3 p = {0, 0, 0};
  p.x = uniform(-size, size);
  p.y = uniform(-size, size);
  return p;
}

static double cross2(CagVec3 a, CagVec3 b) { return a.x * b.y - a.y * b.x; }

// Sums of three waves as coordinates, over an interval of t or, as a closed curve, over full turns.
typedef struct Wave {
  double rate[2][3], height[2][3], shift[2][3], slope[2];
} Wave;

static CagStatus eval_wave(void *context, double t, int order, CagVec3 *out, CagError *e) {
  const Wave *w = context;
  (void)e;
  for (int k = 0; k <= order; k++) {
    double x[2];
    for (int i = 0; i < 2; i++) {
      x[i] = k == 0 ? w->slope[i] * t : k == 1 ? w->slope[i] : 0;
      for (int j = 0; j < 3; j++) {
        double height = w->height[i][j];
        for (int n = 0; n < k; n++) height *= w->rate[i][j];
        x[i] += height * sin(w->rate[i][j] * t + w->shift[i][j] + k * (M_PI / 2));
      }
    }
    out[k] = cag_vec3(x[0], x[1], 0);
  }
  return CAG_OK;
}

static CagCurve *wave_curve(double from, double way, double rate) {
  Wave *w = malloc(sizeof *w);
  assert_non_null(w);
  const CagCurveFunction f = {.eval = eval_wave, .release = free, .context = w};
  CagCurve *c;
  w->slope[0] = uniform(-1, 1);
  w->slope[1] = uniform(-1, 1);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 3; j++) {
      w->rate[i][j] = uniform(0, rate);
      w->height[i][j] = uniform(0.2, 2);
      w->shift[i][j] = uniform(-M_PI, M_PI);
    }
  OK(cag_curve_function(&f, 2, from, from + way, false, &c, &err));
  return c;
}

static CagCurve *random_spline(void) {
  enum { N = 7 };
  CagVec3 p[N];
  double w[N], knots[N + 4] = {-2, -2, -2, -2, 0, 0, 0, 3, 3, 3, 3};
  CagCurve *c;
  for (int i = 0; i < N; i++) {
    p[i] = random_location(3);
    w[i] = uniform(0.5, 2);
  }
  knots[4] = uniform(-1.8, -0.5);
  knots[5] = uniform(-0.4, 0.5);
  knots[6] = uniform(0.6, 2.5);
  OK(cag_curve_nurbs(p, uniform(0, 1) < 0.5 ? NULL : w, N, 3, knots, 2, &c, &err));
  return c;
}

static CagCurve *random_plane_curve(int kind) {
  const CagTransform f = plane_frame(uniform(-2, 2), uniform(-2, 2), uniform(-3, 3));
  CagVec3 p[5];
  CagCurve *c;
  for (int i = 0; i < 5; i++) p[i] = random_location(3);
  switch (kind) {
  case 0: OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err)); return c;
  case 1: OK(cag_curve_bezier(p, NULL, 5, 2, &c, &err)); return c;
  case 2: return random_spline();
  case 3: OK(cag_curve_arc(2, uniform(0.4, 1.8), -3, uniform(-1, 1), &f, &c, &err)); return c;
  case 4: return wave_curve(-5, uniform(2, 4), 3);
  default: return wave_curve(-5, uniform(5, 7), 3);
  }
}

enum { STEPS = 3000, BUCKETS = 100 };

typedef struct Dual {
  double angle[STEPS + 1], height[STEPS + 1]; // angle without jumps
  int first[BUCKETS], next[STEPS];            // segments sorted by their start angles
  double widest;
} Dual;

static int bucket_of(double angle) {
  const double part = angle / M_PI - floor(angle / M_PI);
  return (int)(part * BUCKETS) % BUCKETS;
}

static void make_dual(const CagCurve *c, Dual *out) {
  double last = 0;
  out->widest = 0;
  for (int i = 0; i < BUCKETS; i++) out->first[i] = -1;
  for (int i = 0; i <= STEPS; i++) {
    CagVec3 d[2];
    const double t = c->start + (c->end - c->start) * i / STEPS;
    OK(cag_curve_eval(c, t, 1, i == STEPS ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, &err));
    const CagVec3 along = cag_unit(d[1]);
    const double angle = atan2(along.y, along.x);
    const double turned = i == 0 ? 0 : remainder(angle - last, 2 * M_PI);
    out->widest = fmax(out->widest, fabs(turned));
    last = out->angle[i] = i == 0 ? angle : last + turned;
    out->height[i] = cross2(along, d[0]);
  }
  for (int i = 0; i < STEPS; i++) {
    const int k = bucket_of(out->angle[i]);
    out->next[i] = out->first[k];
    out->first[k] = i;
  }
}

// Whether two segments of duals cross. Sets *doubtful if they cross near an end or are nearly
// parallel.
static bool cross(const Dual *a, int i, const Dual *b, int j, bool *doubtful) {
  const double da = a->angle[i + 1] - a->angle[i], db = b->angle[j + 1] - b->angle[j];
  const double turns = rint((b->angle[j] - a->angle[i]) / M_PI);
  const double sign = fmod(turns, 2) == 0 ? 1 : -1;
  const double ha = a->height[i + 1] - a->height[i];
  const double hb = sign * (b->height[j + 1] - b->height[j]);
  // a + x (da, ha) = b + y (db, hb), b - a = (gap, lift)
  const double gap = b->angle[j] - a->angle[i] - turns * M_PI;
  const double lift = sign * b->height[j] - a->height[i];
  const double det = da * hb - ha * db;
  const double x = (gap * hb - lift * db) / det, y = (gap * ha - lift * da) / det;
  if (x > -1 && x < 2 && y > -1 && y < 2)
    *doubtful = *doubtful || i < 2 || j < 2 || i + 2 > STEPS || j + 2 > STEPS ||
                fabs(det) < 1e-3 * hypot(da, ha) * hypot(db, hb);
  return x >= 0 && x < 1 && y >= 0 && y < 1;
}

static size_t count_common(const Dual *a, const Dual *b, bool *doubtful) {
  const int reach = 1 + (int)ceil((a->widest + b->widest) / M_PI * BUCKETS);
  const int low = 2 * reach < BUCKETS ? -reach : 0,
            high = 2 * reach < BUCKETS ? reach : BUCKETS - 1;
  size_t count = 0;
  for (int i = 0; i < STEPS; i++)
    for (int k = low; k <= high; k++) {
      const int bucket = (bucket_of(a->angle[i]) + k + BUCKETS) % BUCKETS;
      for (int j = b->first[bucket]; j >= 0; j = b->next[j]) count += cross(a, i, b, j, doubtful);
    }
  return count;
}

// Checks that the curve's points and tangents are those of the lines, which are sorted.
static void check_lines(CagCurve *const c[2], const CagTangentLine *lines, size_t n) {
  for (size_t k = 0; k < n; k++) {
    CagVec3 one, two;
    const CagVec3 d = cag_unit(cag_sub(lines[k].q, lines[k].p));
    near_vec(lines[k].p, at(c[0], lines[k].t), 1e-12);
    near_vec(lines[k].q, at(c[1], lines[k].t2), 1e-12);
    OK(cag_curve_tangent(c[0], lines[k].t, CAG_SIDE_RIGHT, &one, &err));
    OK(cag_curve_tangent(c[1], lines[k].t2, CAG_SIDE_RIGHT, &two, &err));
    NEAR(cross2(one, d), 0, 1e-7);
    NEAR(cross2(two, d), 0, 1e-7);
    assert_true(k == 0 || lines[k - 1].t <= lines[k].t);
  }
}

static void random_curves_have_their_common_tangents(void **state) {
  (void)state;
  seed = 64;
  static Dual dual[2];
  size_t seen = 0;
  int clear = 0;
  for (int round = 0; round < 72; round++) {
    CagCurve *c[2];
    CagTangentLine *lines;
    size_t n;
    for (int k = 0; k < 2; k++) {
      c[k] = random_plane_curve((k ? round / 6 : round) % 6);
      make_dual(c[k], &dual[k]);
    }
    // If a curve almost stops, its dual is not sampled finely enough.
    bool doubtful = fmax(dual[0].widest, dual[1].widest) > 0.2;
    const size_t expected = count_common(&dual[0], &dual[1], &doubtful);
    OK(cag_tangents_of_two(c[0], c[1], &lines, &n, &err));
    if (!doubtful) {
      assert_int_equal(n, expected);
      clear++;
      seen += n;
    }
    check_lines(c, lines, n);
    free(lines);
    cag_curve_release(c[0]);
    cag_curve_release(c[1]);
  }
  assert_true(clear >= 50 && seen > 200);
}

// The tangents of [t, t^2] from [(u + v) / 2, u v] touch at u and v, whether or not these are ends
// of the curve or sample parameters.
static void tangents_of_a_parabola_touch_at_the_roots(void **state) {
  (void)state;
  const CagVec3 p[3] = {{-1, 1, 0}, {0, -1, 0}, {1, 1, 0}};
  const double knots[7] = {-1, -1, -1, 0.25, 1, 1, 1};
  const CagVec3 net[4] = {{-1, 1, 0}, {-0.375, -0.25, 0}, {0.625, 0.25, 0}, {1, 1, 0}};
  CagCurve *c[2];
  OK(cag_curve_bezier(p, NULL, 3, 2, &c[0], &err));
  OK(cag_curve_nurbs(net, NULL, 4, 2, knots, 2, &c[1], &err)); // t from -1, in two pieces
  for (int i = 0; i <= 48; i++)
    for (int j = i + 1; j <= 48; j++)
      for (int k = 0; k < 2; k++) {
        const double touched[2] = {i / 24.0 - 1, j / 24.0 - 1};
        const CagVec3 from = {(touched[0] + touched[1]) / 2, touched[0] * touched[1], 0};
        CagTangentLine *lines;
        size_t n;
        OK(cag_tangents_from_point(c[k], from, &lines, &n, &err));
        assert_int_equal(n, 2);
        for (int m = 0; m < 2; m++) {
          near_vec(lines[m].p, cag_vec3(touched[m], touched[m] * touched[m], 0), 1e-7);
          near_vec(lines[m].q, from, 0);
        }
        free(lines);
      }
  cag_curve_release(c[0]);
  cag_curve_release(c[1]);
}

// The tangents of two curves joined at a corner are those of both, even if a tangent at the corner
// passes through the point.
static void tangents_of_joined_curves_are_those_of_each(void **state) {
  (void)state;
  seed = 64;
  for (int i = 0; i < 200; i++) {
    CagVec3 net[7], p = random_location(5);
    CagCurve *c[3];
    CagTangentLine *lines[3];
    size_t n[3];
    for (int k = 0; k < 7; k++) net[k] = random_location(3);
    if (i % 4 == 1) p = cag_lerp(net[2], net[3], uniform(1.2, 3));
    if (i % 4 == 2) p = cag_lerp(net[4], net[3], uniform(1.2, 3));
    OK(cag_curve_bezier(net, NULL, 4, 2, &c[0], &err));
    OK(cag_curve_bezier(net + 3, NULL, 4, 2, &c[1], &err));
    OK(cag_curve_join(c, 2, &c[2], &err));
    for (int k = 0; k < 3; k++) OK(cag_tangents_from_point(c[k], p, &lines[k], &n[k], &err));
    assert_int_equal(n[2], n[0] + n[1]);
    bool corner = false;
    for (size_t k = 0; k < n[2]; k++) {
      const CagTangentLine *other = k < n[0] ? &lines[0][k] : &lines[1][k - n[0]];
      near_vec(lines[2][k].p, other->p, 1e-9);
      near_vec(lines[2][k].q, p, 0);
      corner = corner || cag_norm(cag_sub(lines[2][k].p, net[3])) < 1e-9;
    }
    assert_int_equal(corner, i % 4 == 1 || i % 4 == 2);
    for (int k = 0; k < 3; k++) {
      free(lines[k]);
      cag_curve_release(c[k]);
    }
  }
}

// A line has a tangent through a point only if the point is on it.
static void lines_have_no_tangents_from_their_extensions(void **state) {
  (void)state;
  seed = 65;
  for (int i = 0; i < 300; i++) {
    const double size = pow(10, uniform(-6, 6)), s = uniform(-2, 3);
    const CagVec3 a = random_location(size), b = random_location(size), p = cag_lerp(a, b, s);
    CagCurve *c;
    CagTangentLine *lines;
    size_t n;
    OK(cag_curve_line(a, b, 2, &c, &err));
    OK(cag_tangents_from_point(c, p, &lines, &n, &err));
    assert_int_equal(n, s > 0 && s < 1);
    for (size_t k = 0; k < n; k++) {
      near_vec(lines[k].p, p, 1e-12 * size);
      NEAR(fabs(cross2(cag_unit(cag_sub(lines[k].q, lines[k].p)), cag_unit(cag_sub(b, a)))), 0,
           1e-9 + 1e-12 / size); // q is at distance 1 from p
    }
    free(lines);
    cag_curve_release(c);
  }
}

// Circles of any size and location: 4 common tangents if they are disjoint, 3 if they touch, 2 if
// they cross, 1 if they touch from inside, and none if one is inside the other.
static void circles_touch_at_any_size(void **state) {
  (void)state;
  seed = 66;
  for (int i = 0; i < 300; i++) {
    const double size = pow(10, i % 3 * 6 - 6.0);
    const CagVec3 a = random_location(100 * size), e = cag_unit(random_location(1));
    const double r = size * uniform(0.5, 2), s = size * uniform(0.5, 2), much = 1e-6 * size;
    const double apart[5] = {fabs(r - s) - much, fabs(r - s), uniform(fabs(r - s) + much, r + s),
                             r + s, r + s + much};
    for (size_t k = 0; k < 5; k++) {
      const CagVec3 b = cag_madd(a, apart[k], e);
      const CagTransform f = plane_frame(a.x, a.y, uniform(-3, 3));
      const CagTransform g = plane_frame(b.x, b.y, uniform(-3, 3));
      CagCurve *c[2];
      CagTangentLine *lines;
      size_t n;
      OK(cag_curve_arc(r, r, -1, 2 * M_PI - 1, &f, &c[0], &err));
      OK(cag_curve_arc(s, s, -1, 2 * M_PI - 1, &g, &c[1], &err));
      OK(cag_tangents_of_two(c[0], c[1], &lines, &n, &err));
      assert_int_equal(n, k);
      size_t single = 0; // tangents at the common point of touching circles
      for (size_t j = 0; j < n; j++) {
        const CagVec3 d = cag_sub(lines[j].q, lines[j].p), u = cag_unit(d);
        assert_true(cag_norm(d) > 1e-7 * size);
        NEAR(cag_norm(cag_sub(lines[j].p, a)), r, 1e-9 * size);
        NEAR(cag_dot(cag_sub(lines[j].p, a), u), 0, 1e-5 * size);
        NEAR(fabs(cross2(cag_sub(a, lines[j].p), u)), r, 1e-9 * size);
        NEAR(fabs(cross2(cag_sub(b, lines[j].p), u)), s, 1e-9 * size);
        single += fabs(cag_norm(cag_sub(lines[j].q, b)) - s) > 1e-9 * size;
      }
      assert_int_equal(single, size > 1 ? 0 : k % 2); // q is at distance 1 from p
      free(lines);
      cag_curve_release(c[0]);
      cag_curve_release(c[1]);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_curves_have_their_common_tangents),
      cmocka_unit_test(tangents_of_a_parabola_touch_at_the_roots),
      cmocka_unit_test(tangents_of_joined_curves_are_those_of_each),
      cmocka_unit_test(lines_have_no_tangents_from_their_extensions),
      cmocka_unit_test(circles_touch_at_any_size),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
