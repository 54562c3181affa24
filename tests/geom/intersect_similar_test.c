// Curves that are transformed, scaled, reversed, and reparametrized meet at the images of the
// original intersections.

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/curve/curve.h"
#include "geom/curve/intersect.h"

enum { KINDS = 6, MOST_MEETINGS = 64 };

static CagVec3 random_point(int dimension) {
  CagVec3 p;
  p.x = uniform(-2, 2);
  p.y = uniform(-2, 2);
  p.z = dimension == 3 ? uniform(-2, 2) : 0;
  return p;
}

static CagCurve *random_curve(int kind, int dimension) {
  CagVec3 p[7];
  double w[7];
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  for (int i = 0; i < 7; i++) {
    p[i] = random_point(dimension);
    w[i] = uniform(0.3, 3);
  }
  frame.planar = dimension == 2;
  frame.m[0][3] = uniform(-1, 1);
  frame.m[1][3] = uniform(-1, 1);
  const double a = uniform(0.7, 2), b = uniform(0.7, 2), from = uniform(-3, 3);
  const double turn = uniform(3, 6);
  switch (kind) {
  case 0: OK(cag_curve_bezier(p, NULL, 6, dimension, &c, &err)); break;
  case 1: OK(cag_curve_bezier(p, w, 5, dimension, &c, &err)); break;
  case 2: OK(cag_curve_nurbs_closed(p, NULL, 7, 3, dimension, &c, &err)); break;
  case 3: OK(cag_curve_polyline(p, 6, from > 0, dimension, &c, &err)); break;
  case 4: OK(cag_curve_arc(a, b, from, from + turn, &frame, &c, &err)); break;
  default: OK(cag_curve_arc(a, b, from, from + 2 * M_PI, &frame, &c, &err)); break;
  }
  return c;
}

// A rotation about z or three axes, a scale, and a translation, of various sizes.
static CagTransform random_similarity(int dimension, double scale) {
  CagTransform t = cag_transform_identity();
  const double yaw = uniform(-3, 3), pitch = uniform(-1.5, 1.5), roll = uniform(-3, 3);
  if (dimension == 3) {
    t = cag_rpy(roll, pitch, yaw);
  } else {
    t.m[0][0] = t.m[1][1] = cos(yaw);
    t.m[1][0] = sin(yaw);
    t.m[0][1] = -sin(yaw);
  }
  for (int i = 0; i < dimension; i++) {
    for (int j = 0; j < dimension; j++) t.m[i][j] *= scale;
    t.m[i][3] = uniform(-5, 5) * scale;
  }
  if (dimension == 2) t.m[2][2] = scale;
  t.planar = dimension == 2;
  return t;
}

// The image over another domain, optionally reversed. Takes ownership of the curve.
static CagCurve *image_of(CagCurve *c, const CagTransform *t, bool back, double from, double to) {
  CagCurve *moved, *turned = NULL, *out;
  OK(cag_curve_transform(c, t, &moved, &err));
  if (back) OK(cag_curve_reverse(moved, &turned, &err));
  OK(cag_curve_reparametrize(back ? turned : moved, from, to, &out, &err));
  cag_curve_release(moved);
  cag_curve_release(turned);
  return out;
}

static CagVec3 image_point(const CagTransform *t, CagVec3 p) {
  CagVec3 out;
  out.x = t->m[0][0] * p.x + t->m[0][1] * p.y + t->m[0][2] * p.z + t->m[0][3];
  out.y = t->m[1][0] * p.x + t->m[1][1] * p.y + t->m[1][2] * p.z + t->m[1][3];
  out.z = t->m[2][0] * p.x + t->m[2][1] * p.y + t->m[2][2] * p.z + t->m[2][3];
  return out;
}

static double domain_fraction(const CagCurve *c, double t) {
  return (t - c->start) / (c->end - c->start);
}

// Checks that each intersection has its image at the same fraction of the domain, and that there
// are no others.
static void assert_images(const CagCurve *a, const CagMeeting *m, size_t n, const CagCurve *image,
                          const CagMeeting *o, size_t count, const CagTransform *t, double scale,
                          bool back) {
  bool taken[MOST_MEETINGS] = {false};
  assert_int_equal(count, n);
  for (size_t i = 0; i < n; i++) {
    const CagVec3 p = image_point(t, m[i].point);
    size_t nearest = 0;
    for (size_t k = 1; k < n; k++)
      if (cag_norm(cag_sub(o[k].point, p)) < cag_norm(cag_sub(o[nearest].point, p))) nearest = k;
    near_vec(o[nearest].point, p, 1e-8 * scale);
    // Random curves do not intersect themselves exactly where they meet the other curve.
    assert_false(taken[nearest]);
    taken[nearest] = true;
    assert_int_equal(o[nearest].multiplicity, m[i].multiplicity);
    const double at = domain_fraction(a, m[i].t), now = domain_fraction(image, o[nearest].t);
    const double off = fabs(now - (back ? 1 - at : at));
    assert_true(off < 1e-7 || (a->closed && fabs(off - 1) < 1e-7));
  }
}

static void similar_curves_meet_alike(void **state) {
  (void)state;
  static const double scales[] = {1, 1e-6, 1e5, 1e-3};
  seed = 401;
  int met = 0;
  for (int round = 0; round < 40 * KINDS * KINDS; round++) {
    const double scale = scales[round % 4];
    const bool back_a = round / 2 % 2, back_b = round / 3 % 2;
    CagCurve *a = random_curve(round % KINDS, 2), *b = random_curve(round / KINDS % KINDS, 2);
    const CagTransform t = random_similarity(2, scale);
    const double from = uniform(-3, 3), range = pow(10, uniform(-3, 3));
    CagCurve *c = image_of(a, &t, back_a, from, from + range),
             *d = image_of(b, &t, back_b, -from, range - from);
    CagMeeting *m, *o;
    size_t n, count;
    OK(cag_curve_intersect(a, b, &m, &n, &err));
    OK(cag_curve_intersect(c, d, &o, &count, &err));
    assert_images(a, m, n, c, o, count, &t, scale, back_a);
    free(o);
    // If the curves are exchanged, so are t and t2.
    OK(cag_curve_intersect(d, c, &o, &count, &err));
    assert_int_equal(count, n);
    for (size_t i = 0; i < count; i++) {
      CagVec3 p, q;
      OK(cag_curve_point(d, o[i].t, &p, &err));
      OK(cag_curve_point(c, o[i].t2, &q, &err));
      near_vec(p, o[i].point, 1e-9 * scale);
      near_vec(q, o[i].point, 1e-8 * scale);
      assert_true(i == 0 || o[i].t >= o[i - 1].t);
    }
    free(o);
    free(m);
    met += (int)n;
    cag_curve_release(a);
    cag_curve_release(b);
    cag_curve_release(c);
    cag_curve_release(d);
  }
  assert_true(met > 3000);
}

static void similar_curves_meet_planes_alike(void **state) {
  (void)state;
  static const double scales[] = {1, 1e-6, 1e5, 1e-3};
  seed = 402;
  int met = 0;
  for (int round = 0; round < 600 * KINDS; round++) {
    const double scale = scales[round % 4];
    const bool back = round / 2 % 2;
    CagCurve *a = random_curve(round % KINDS, 3);
    const CagTransform t = random_similarity(3, scale);
    const double from = uniform(-3, 3), range = pow(10, uniform(-3, 3));
    CagCurve *c = image_of(a, &t, back, from, from + range);
    const CagVec3 point = cag_scaled(random_point(3), 0.3), normal = random_point(3);
    const CagVec3 there = image_point(&t, point),
                  up = cag_sub(image_point(&t, cag_add(point, normal)), there);
    CagPlane before, after;
    OK(cag_plane(point, normal, &before, &err));
    OK(cag_plane(there, cag_scaled(up, 1 / scale), &after, &err));
    CagMeeting *m, *o;
    size_t n, count;
    OK(cag_curve_intersect_plane(a, &before, &m, &n, &err));
    OK(cag_curve_intersect_plane(c, &after, &o, &count, &err));
    assert_images(a, m, n, c, o, count, &t, scale, back);
    for (size_t i = 0; i < n; i++)
      NEAR(cag_dot(cag_sub(m[i].point, point), cag_unit(normal)), 0, 1e-12);
    free(o);
    free(m);
    met += (int)n;
    cag_curve_release(a);
    cag_curve_release(c);
  }
  assert_true(met > 3000);
}

// Segments that lie in the plane (alone, first or last, or between others), as lines and as
// splines.
static void segments_in_a_plane_are_refused(void **state) {
  (void)state;
  seed = 404;
  for (int round = 0; round < 400; round++) {
    const double scale = pow(10, uniform(-5, 5));
    const CagTransform t = random_similarity(3, scale);
    const int before = round % 3, after = round / 3 % 3;
    CagVec3 p[6];
    size_t n = 0;
    for (int i = 0; i < before; i++) {
      p[n] = random_point(3);
      p[n].z = uniform(0.1, 2) * ((round + i) % 2 ? 1 : -1);
      n++;
    }
    p[n++] = random_point(2);
    p[n++] = random_point(2);
    for (int i = 0; i < after; i++) {
      p[n] = random_point(3);
      p[n].z = uniform(0.1, 2) * ((round / 2 + i) % 2 ? 1 : -1);
      n++;
    }
    for (size_t i = 0; i < n; i++) p[i] = image_point(&t, p[i]);
    const CagVec3 zero = image_point(&t, cag_vec3(0, 0, 0)),
                  up = cag_sub(image_point(&t, cag_vec3(0, 0, 1)), zero);
    CagPlane plane;
    CagCurve *c;
    CagMeeting *m;
    size_t count;
    OK(cag_plane(zero, cag_scaled(up, 1 / scale), &plane, &err));
    OK(cag_curve_polyline(p, n, false, 3, &c, &err));
    if (round / 9 % 2) {
      CagCurve *spline;
      OK(cag_curve_to_nurbs(c, &spline, &err));
      cag_curve_release(c);
      c = spline;
    }
    FAILS(cag_curve_intersect_plane(c, &plane, &m, &count, &err), "overlap");
    cag_curve_release(c);
  }
}

// A closed curve that crosses a line, or a plane, at its start, or slightly before its end.
static void crossings_at_a_seam_are_told_at_its_start(void **state) {
  (void)state;
  seed = 403;
  for (int round = 0; round < 400; round++) {
    const double scale = pow(10, uniform(-4, 4)), range = pow(10, uniform(-3, 3)),
                 from = uniform(-3, 3) * range, a = uniform(0.5, 2), b = uniform(0.5, 2);
    // Distance from the seam, as a fraction of the domain.
    const double off = round % 4 == 3 ? pow(10, uniform(-8, -3)) : round % 4 == 2 ? 1e-11 : 0;
    const CagTransform t = random_similarity(2, scale);
    const double angle = -2 * M_PI * off;
    CagTransform frame = cag_transform_identity();
    frame.planar = true;
    CagCurve *ellipse, *line;
    OK(cag_curve_arc(a, b, 0, 2 * M_PI, &frame, &ellipse, &err));
    const CagVec3 seam = cag_vec3(a * cos(angle), b * sin(angle), 0);
    if (round / 4 % 2) { // a spline has uneven speed, so only the parameter of the seam is known
      CagCurve *spline;
      if (off > 1e-11) {
        cag_curve_release(ellipse);
        continue;
      }
      OK(cag_curve_to_nurbs(ellipse, &spline, &err));
      cag_curve_release(ellipse);
      ellipse = spline;
    }
    OK(cag_curve_line(cag_vec3(0, 0, 0), cag_scaled(seam, 2), 2, &line, &err));
    CagCurve *c = image_of(ellipse, &t, false, from, from + range),
             *d = image_of(line, &t, false, 0, 1);
    const double expected = off > 1e-9 ? c->end - off * range : c->start;
    CagMeeting *m;
    size_t n;
    OK(cag_curve_intersect(c, d, &m, &n, &err));
    assert_int_equal(n, 1);
    NEAR(m[0].t, expected, off > 1e-9 ? 1e-11 * (range + fabs(from)) : 0);
    NEAR(m[0].t2, 0.5, 1e-9);
    free(m);
    OK(cag_curve_intersect(d, c, &m, &n, &err));
    assert_int_equal(n, 1);
    NEAR(m[0].t2, expected, off > 1e-9 ? 1e-11 * (range + fabs(from)) : 0);
    free(m);
    const CagVec3 middle = image_point(&t, cag_vec3(0, 0, 0)), at = image_point(&t, seam),
                  along = cag_unit(cag_sub(at, middle));
    CagPlane plane;
    OK(cag_plane(at, cag_vec3(-along.y, along.x, 0), &plane, &err));
    OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
    assert_int_equal(n, 2); // the other one is on the opposite side
    const double here = off > 1e-9 ? m[1].t : m[0].t;
    NEAR(here, expected, off > 1e-9 ? 1e-11 * (range + fabs(from)) : 0);
    free(m);
    cag_curve_release(c);
    cag_curve_release(d);
    cag_curve_release(ellipse);
    cag_curve_release(line);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(similar_curves_meet_alike),
      cmocka_unit_test(similar_curves_meet_planes_alike),
      cmocka_unit_test(segments_in_a_plane_are_refused),
      cmocka_unit_test(crossings_at_a_seam_are_told_at_its_start),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
