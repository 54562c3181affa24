// Runs of points converted to curves: lines and conics anywhere in space are recognized, and
// nothing else is.

#include "geom/curve/curve.h"
#include "geom/meet/section.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 40 };

typedef enum Kind { LINE, ELLIPSE, PARABOLA, HYPERBOLA } Kind;

// A curve in its own axes, its parameter range, and the position of the axes.
typedef struct Subject {
  Kind kind;
  double a, b, from, to, size;
  CagVec3 axis[3], origin;
  CagTrace trace;
  CagVec3 points[MOST], tangents[MOST], checks[MOST];
} Subject;

static int whole(int low, int high) { return low + (int)uniform(0, high - low + 1); }

static CagVec3 random_vector(double most) {
  const double x = uniform(-most, most), y = uniform(-most, most);
  return cag_vec3(x, y, uniform(-most, most));
}

static CagVec3 subject_point(const Subject *s, double x, double y) {
  return cag_madd(cag_madd(s->origin, x, s->axis[0]), y, s->axis[1]);
}

static CagVec3 point(const Subject *s, double t) {
  switch (s->kind) {
  case ELLIPSE: return subject_point(s, s->a * cos(t), s->b * sin(t));
  case PARABOLA: return subject_point(s, s->a * t * t, 2 * s->a * t);
  case HYPERBOLA: return subject_point(s, s->a * cosh(t), s->b * sinh(t));
  default: return subject_point(s, s->a * t, s->b * t);
  }
}

static CagVec3 derivative(const Subject *s, double t) {
  double x, y;
  switch (s->kind) {
  case ELLIPSE: x = -s->a * sin(t), y = s->b * cos(t); break;
  case PARABOLA: x = 2 * s->a * t, y = 2 * s->a; break;
  case HYPERBOLA: x = s->a * sinh(t), y = s->b * cosh(t); break;
  default: x = s->a, y = s->b;
  }
  return cag_add(cag_scaled(s->axis[0], x), cag_scaled(s->axis[1], y));
}

// By Simpson's rule.
static double length_of(const Subject *s) {
  enum { PARTS = 400 };
  double sum = 0;
  for (int i = 0; i <= PARTS; i++) {
    const double t = s->from + (s->to - s->from) * i / PARTS;
    sum += cag_norm(derivative(s, t)) * (i == 0 || i == PARTS ? 1 : i % 2 ? 4 : 2);
  }
  return sum * fabs(s->to - s->from) / PARTS / 3;
}

static void set_curve(Subject *s, Kind kind) {
  *s = (Subject){.kind = kind};
  s->size = pow(10, uniform(-4, 4));
  s->axis[0] = cag_unit(random_vector(1));
  s->axis[2] = cag_unit(cag_cross(s->axis[0], random_vector(1)));
  s->axis[1] = cag_cross(s->axis[2], s->axis[0]);
  s->origin = random_vector(s->size);
  s->a = uniform(0.3, 1) * s->size;
  s->b = uniform(0.3, 1) * s->size;
  s->from = kind == ELLIPSE ? uniform(-4, 4) : uniform(-1.5, 1);
  s->to = s->from + (kind == ELLIPSE ? uniform(1, 6) : uniform(1, 1.5));
  if (whole(0, 1)) {
    const double from = s->from;
    s->from = s->to;
    s->to = from;
  }
}

static void set_trace(Subject *s, size_t points, size_t checks, bool closed) {
  if (closed) s->to = s->from + 2 * M_PI;
  for (size_t i = 0; i < points; i++) {
    const double t = s->from + (s->to - s->from) * (double)i / (double)(points - 1);
    s->points[i] = point(s, t);
    s->tangents[i] = cag_unit(cag_scaled(derivative(s, t), s->to - s->from));
  }
  if (closed) s->points[points - 1] = s->points[0];
  for (size_t i = 0; i < checks; i++)
    s->checks[i] = point(s, s->from + (s->to - s->from) * ((double)i + 0.6) / (double)checks);
  s->trace = (CagTrace){points, checks, closed, s->points, s->tangents, s->checks};
}

// A quadric whose section with the curve's plane is the curve: the equation in its own axes, plus
// any terms with z.
static CagQuadric quadric_of(const Subject *s) {
  // The curve's own coordinates as linear forms of x, y, z, 1.
  double f[4][4] = {{0}}, m[4][4] = {{0}}, q[4][4] = {{0}};
  for (int i = 0; i < 3; i++) {
    f[i][0] = s->axis[i].x;
    f[i][1] = s->axis[i].y;
    f[i][2] = s->axis[i].z;
    f[i][3] = -cag_dot(s->axis[i], s->origin);
  }
  f[3][3] = 1;
  const double aa = s->a * s->a, bb = s->b * s->b;
  if (s->kind == PARABOLA) {
    m[1][1] = 1 / aa;
    m[0][3] = -4 / s->a;
  } else {
    m[0][0] = 1 / aa;
    m[1][1] = (s->kind == ELLIPSE ? 1 : -1) / bb;
    m[3][3] = -1;
  }
  for (int i = 0; i < 3; i++) m[i][2] = uniform(-1, 1) / s->size / s->size;
  m[2][3] = uniform(-1, 1) / s->size;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 4; k++)
        for (int l = 0; l < 4; l++) q[k][l] += m[i][j] * f[i][k] * f[j][l];
  return (CagQuadric){{q[0][0], q[1][1], q[2][2], q[0][1] + q[1][0], q[1][2] + q[2][1],
                       q[0][2] + q[2][0], q[0][3] + q[3][0], q[1][3] + q[3][1], q[2][3] + q[3][2],
                       q[3][3]}};
}

static CagCurve *curve_of(const Subject *s, const CagQuadric *q) {
  CagCurve *c = NULL;
  OK(cag_trace_curve(&s->trace, q, s->size, &c, &err));
  return c;
}

static const char *name_of(const Subject *s) {
  static const char *const NAMES[] = {"line", "arc", "parabola", "hyperbola"};
  if (s->trace.closed) return s->a == s->b ? "circle" : "ellipse";
  return NAMES[s->kind];
}

static bool is_conic(const CagCurve *c) {
  static const char *const NAMES[] = {"arc", "circle", "ellipse", "parabola", "hyperbola"};
  for (int i = 0; i < 5; i++)
    if (!strcmp(c->kind->name, NAMES[i])) return true;
  return false;
}

// Checks that the curve is on the subject, ends at its ends, and has the same length.
static void check_curve(const Subject *s, const CagCurve *c) {
  if (strcmp(c->kind->name, name_of(s))) fail_msg("%s, not %s", c->kind->name, name_of(s));
  const double low = fmin(s->from, s->to), high = fmax(s->from, s->to), near = 1e-8 * s->size;
  double length;
  OK(cag_curve_length(c, c->start, c->end, &length, &err));
  NEAR(length, length_of(s), 1e-7 * s->size);
  if (s->kind == ELLIPSE) assert_true(c->start > -M_PI);
  CagVec3 ends[2];
  assert_int_equal(c->dimension, 3);
  for (int i = 0; i <= 20; i++) {
    CagVec3 p, own;
    OK(cag_curve_point(c, c->start + (c->end - c->start) * i / 20, &p, &err));
    if (i == 0) ends[0] = p;
    if (i == 20) ends[1] = p;
    p = cag_sub(p, s->origin);
    own = cag_vec3(cag_dot(p, s->axis[0]), cag_dot(p, s->axis[1]), cag_dot(p, s->axis[2]));
    NEAR(own.z, 0, near);
    double t = own.x / s->a;
    if (s->kind == ELLIPSE) {
      t = atan2(own.y / s->b, own.x / s->a);
      while (t > low - 1e-6) t -= 2 * M_PI;
      while (t < low - 1e-6) t += 2 * M_PI;
    } else if (s->kind == PARABOLA) t = own.y / s->a / 2;
    else if (s->kind == HYPERBOLA) t = asinh(own.y / s->b);
    near_vec(point(s, t), cag_add(p, s->origin), near);
    assert_true(t >= low - 1e-6 && t <= high + 1e-6);
  }
  if (s->trace.closed) return;
  const CagVec3 first = s->points[0], last = s->points[s->trace.count - 1];
  const int turned = cag_norm(cag_sub(ends[0], first)) > cag_norm(cag_sub(ends[0], last));
  near_vec(ends[turned], first, near);
  near_vec(ends[1 - turned], last, near);
}

static void conics_are_known_by_their_points(void **state) {
  (void)state;
  seed = 91;
  for (int round = 0; round < 400; round++) {
    Subject s;
    set_curve(&s, (Kind)(round % 4));
    // At least seven points, of either sort.
    const bool few = round % 3 == 0;
    const size_t points = (size_t)(few ? whole(3, 5) : whole(7, 12));
    set_trace(&s, points, (size_t)(few ? 7 - (int)points + whole(0, 3) : whole(0, 3)), false);
    CagCurve *c = curve_of(&s, NULL);
    check_curve(&s, c);
    cag_curve_release(c);
    if (s.kind == LINE) continue;
    const CagQuadric q = quadric_of(&s);
    c = curve_of(&s, &q);
    check_curve(&s, c);
    cag_curve_release(c);
  }
}

static void closed_runs_are_whole_ellipses(void **state) {
  (void)state;
  seed = 92;
  for (int round = 0; round < 100; round++) {
    Subject s;
    set_curve(&s, ELLIPSE);
    if (round % 4 == 0) s.b = s.a;
    // If there are few points, the first is not repeated at the end.
    const bool few = round % 3 == 0;
    const size_t points = (size_t)(few ? whole(4, 5) : whole(8, 20));
    set_trace(&s, points, (size_t)(few ? 8 - (int)points : whole(0, 3)), true);
    const CagQuadric q = quadric_of(&s);
    CagCurve *c = curve_of(&s, round % 2 ? &q : NULL);
    check_curve(&s, c);
    NEAR(c->end - c->start, 2 * M_PI, 1e-15);
    cag_curve_release(c);
  }
}

// A deviation below 1e-10 leaves the point on the curve, and a larger one does not. In the latter
// case, the result is a cubic through the points.
static void one_point_beside_the_curve_tells(void **state) {
  (void)state;
  seed = 93;
  for (int round = 0; round < 600; round++) {
    Subject s;
    set_curve(&s, (Kind)(round % 4));
    set_trace(&s, (size_t)whole(7, 12), (size_t)whole(1, 5), false);
    const size_t i = (size_t)whole(0, (int)(s.trace.count + s.trace.check_count) - 1);
    const bool known = round / 4 % 2;
    CagVec3 *p = i < s.trace.count ? &s.points[i] : &s.checks[i - s.trace.count];
    const double t = i < s.trace.count
                         ? (double)i / (double)(s.trace.count - 1)
                         : ((double)(i - s.trace.count) + 0.6) / (double)s.trace.check_count;
    const CagVec3 along = cag_unit(derivative(&s, s.from + (s.to - s.from) * t));
    // In the plane or perpendicular to it; inner points determine a line.
    const CagVec3 beside = round / 8 % 2 ? s.axis[2] : cag_cross(s.axis[2], along);
    if (s.kind == LINE && (i == 0 || i + 1 == s.trace.count)) continue;
    // For a given conic, and for a line through the ends, only the distance counts.
    const bool given = s.kind != LINE && round / 16 % 2 == 0;
    const bool sharp = s.kind == LINE || (given && round / 8 % 2 == 0);
    const double off = known ? (sharp ? 9e-11 : 5e-12) : sharp ? 1.1e-10 : 5e-9;
    *p = cag_madd(*p, off * s.size, beside);
    const CagQuadric q = quadric_of(&s);
    CagCurve *c = curve_of(&s, given ? &q : NULL);
    if ((s.kind == LINE ? !strcmp(c->kind->name, "line") : is_conic(c)) != known)
      fail_msg("round %d: %s of a run of %s, point %zu", round, c->kind->name, name_of(&s), i);
    for (int last = 0; last < 2; last++) {
      CagVec3 at;
      OK(cag_curve_point(c, last ? c->end : c->start, &at, &err));
      if (!known) near_vec(at, s.points[last ? s.trace.count - 1 : 0], 1e-13 * s.size);
    }
    cag_curve_release(c);
  }
}

// A conic through five of six points exists, which proves nothing.
static void six_points_are_no_conic(void **state) {
  (void)state;
  seed = 94;
  for (int round = 0; round < 60; round++) {
    Subject s;
    set_curve(&s, (Kind)(1 + round % 3));
    const size_t points = (size_t)whole(3, 6);
    set_trace(&s, points, 6 - points, false);
    CagCurve *c = curve_of(&s, NULL);
    assert_false(is_conic(c));
    cag_curve_release(c);
    set_curve(&s, ELLIPSE);
    set_trace(&s, points, 7 - points, true); // the last point equals the first
    c = curve_of(&s, NULL);
    assert_false(is_conic(c));
    cag_curve_release(c);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(conics_are_known_by_their_points),
      cmocka_unit_test(closed_runs_are_whole_ellipses),
      cmocka_unit_test(one_point_beside_the_curve_tells),
      cmocka_unit_test(six_points_are_no_conic),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
