// Surfaces that ask another one: parts, exchanged parameters and offsets, against the surface
// itself and closed forms.

#include <stdio.h>

#include "surface_support.h"
#include "tests/geom/random.h"

#include "geom/surface/family.h"
#include "geom/surface/nearest.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"

// A curve over start .. start + 4.
static CagCurve *wave_from(double start) {
  double knots[] = {0, 0, 0, 1.25, 1.25, 3.5, 4, 4, 4};
  CagVec3 p[6];
  CagCurve *c;
  for (int i = 0; i < 9; i++) knots[i] += start;
  for (int i = 0; i < 6; i++) p[i] = cag_vec3(1 + uniform(0, 1), i, 0);
  MUST(cag_curve_nurbs(p, NULL, 6, 2, knots, 2, &c, err));
  return c;
}

static CagCurve *wave(void) { return wave_from(-1); }

enum { TORUS, LATHE, EXTRUDED, TWISTED, TUBE, MOVED, RULED, KINDS };
static const bool has_exact_form[KINDS] = {true, true, true, false, false, true, true};

// None of them is a NURBS surface.
static CagSurface *surface_of(int kind) {
  CagSurface *s = NULL, *base;
  CagCurve *c = NULL, *d;
  CagTransform move;
  if (kind == LATHE || kind == EXTRUDED || kind == TWISTED || kind == RULED) c = wave();
  switch (kind) {
  case TORUS: MUST(cag_surface_torus(4, 1.5, &s, err)); break;
  case LATHE:
    MUST(cag_surface_revolve(c, cag_vec3(0, 1, 0), cag_vec3(0, 0, 0), 0.5, 4.5, &s, err));
    break;
  case EXTRUDED: MUST(cag_surface_extrude(c, cag_vec3(0.5, 0.2, 3), 0, 1, &s, err)); break;
  case TWISTED: MUST(cag_surface_extrude(c, cag_vec3(0, 0, 3), 1, 0.6, &s, err)); break;
  case TUBE:
    MUST(cag_curve_helix(3, 4, 1.5, 0, &c, err));
    MUST(cag_surface_tube(c, 0.7, &s, err));
    break;
  case MOVED:
    MUST(cag_surface_torus(4, 1.5, &base, err));
    MUST(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(1, 0, -1), &move, err));
    MUST(cag_surface_transform(base, &move, &s, err));
    cag_surface_release(base);
    break;
  default:
    d = wave();
    MUST(cag_surface_ruled(c, d, &s, err));
    cag_curve_release(d);
  }
  cag_curve_release(c);
  return s;
}

// Ends of the smooth stretches of s within lo..hi, these included.
static size_t expected_cuts(const CagSurface *s, int direction, double lo, double hi, double *out) {
  double *all;
  size_t n, count = 0;
  MUST(cag_surface_cuts(s, direction, &all, &n, err));
  out[count++] = lo;
  for (size_t i = 0; i <= n; i++)
    if (all[i] > lo && all[i] < hi) out[count++] = all[i];
  out[count++] = hi;
  free(all);
  return count;
}

static void check_cuts(const CagSurface *s, int direction, const double *expected, size_t count) {
  double *cuts;
  size_t n;
  MUST(cag_surface_cuts(s, direction, &cuts, &n, err));
  assert_int_equal(n + 1, count);
  for (size_t i = 0; i < count; i++) assert_true(cuts[i] == expected[i]);
  free(cuts);
}

static double some(double lo, double hi) { return lo + (hi - lo) * uniform(0, 1); }

enum { ORDER = 3, SQUARE = (ORDER + 1) * (ORDER + 1) };

static void eval_all(const CagSurface *s, double u, double v, CagVec3 out[SQUARE]) {
  MUST(cag_surface_eval(s, u, v, ORDER, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, out, err));
}

static void assert_text(const CagSurface *s, const char *expected) {
  char text[160];
  s->kind->describe(s, text, sizeof text);
  assert_string_equal(text, expected);
}

// The exact form of a part has its corners, its edges, and no points beside it.
static void check_exact_part(const CagSurface *part) {
  CagSurface *exact;
  CagSurfaceNearest near;
  MUST(cag_surface_to_nurbs(part, &exact, err));
  for (int i = 0; i < 4; i++)
    assert_point(surface_at(exact, i & 1 ? exact->u1 : exact->u0, i & 2 ? exact->v1 : exact->v0),
                 surface_at(part, i & 1 ? part->u1 : part->u0, i & 2 ? part->v1 : part->v0), 1e-9,
                 "corner");
  for (int i = 0; i < 6; i++) {
    const double x = some(exact->u0, exact->u1), y = some(exact->v0, exact->v1);
    MUST(cag_surface_closest(part, surface_at(exact, x, y), &near, err));
    assert_near(near.distance, 0, 1e-9, "exact form");
    const double u = some(part->u0, part->u1), v = some(part->v0, part->v1);
    MUST(cag_surface_closest(exact, surface_at(part, u, v), &near, err));
    assert_near(near.distance, 0, 1e-9, "part");
  }
  cag_surface_release(exact);
}

static void parts_are_the_surface_over_smaller_ranges(void **state) {
  (void)state;
  seed = 71;
  for (int round = 0; round < 3 * KINDS; round++) {
    CagSurface *s = surface_of(round % KINDS), *part, *smaller, *direct;
    double at[4], cuts[16];
    for (int k = 0; k < 2; k++) {
      const double lo = k ? s->v0 : s->u0, hi = k ? s->v1 : s->u1;
      const double a = some(lo, hi), b = some(lo, hi);
      // Some begin or end where the whole does.
      at[2 * k] = (round + k) % 3 ? fmin(a, b) : lo;
      at[2 * k + 1] = (round + k) % 3 == 2 ? hi : fmax(a, b);
    }
    MUST(cag_surface_part(s, at[0], at[1], at[2], at[3], &part, err));
    assert_true(part->u0 == at[0] && part->u1 == at[1] && part->v0 == at[2] && part->v1 == at[3]);
    assert_int_equal(part->angular_u, s->angular_u);
    assert_int_equal(part->angular_v, s->angular_v);
    for (int k = 0; k < 2; k++)
      check_cuts(part, k, cuts, expected_cuts(s, k, at[2 * k], at[2 * k + 1], cuts));
    for (int i = 0; i < 5; i++) {
      CagVec3 a[SQUARE], b[SQUARE];
      const double u = some(at[0], at[1]), v = some(at[2], at[3]);
      eval_all(part, u, v, a);
      eval_all(s, u, v, b);
      for (int j = 0; j <= ORDER; j++)
        for (int k = 0; j + k <= ORDER; k++)
          assert_true(cag_norm(cag_sub(a[cag_partial(ORDER, j, k)], b[cag_partial(ORDER, j, k)])) ==
                      0);
    }
    assert_consistent(part);
    // A part of a part is one of the whole.
    MUST(cag_surface_part(part, at[0], (at[0] + at[1]) / 2, at[2], at[3], &smaller, err));
    MUST(cag_surface_part(s, at[0], (at[0] + at[1]) / 2, at[2], at[3], &direct, err));
    char text[160];
    direct->kind->describe(direct, text, sizeof text);
    assert_text(smaller, text);
    if (has_exact_form[round % KINDS]) {
      check_exact_part(part);
      check_exact_part(smaller);
    } else {
      CagSurface *none;
      MUST_FAIL(cag_surface_to_nurbs(part, &none, err), "no-exact-form");
    }
    cag_surface_release(direct);
    cag_surface_release(smaller);
    cag_surface_release(part);
    cag_surface_release(s);
  }
}

// Ends that are those of the other direction are nothing special, and parameters that are those of
// the exact form stay exactly so.
static void parts_of_extrusions_keep_their_parameters(void **state) {
  (void)state;
  seed = 75;
  CagSurface *s = surface_of(EXTRUDED), *part, *exact;
  const double ends[][4] = {
      {0, 1, 0, 1}, {-1, 1, 0.5, 1}, {1, 3, 0, 0.5}, {0, 3, 0.3, 0.8}, {-0.3, 0.7, 0.1, 0.9}};
  for (int i = 0; i < 5; i++)
    for (int turned = 0; turned < 2; turned++) {
      const double *e = ends[i];
      CagSurface *base;
      if (turned) MUST(cag_surface_transpose(s, &base, err));
      else base = cag_surface_retain(s);
      if (turned) MUST(cag_surface_part(base, e[2], e[3], e[0], e[1], &part, err));
      else MUST(cag_surface_part(base, e[0], e[1], e[2], e[3], &part, err));
      MUST(cag_surface_to_nurbs(part, &exact, err));
      assert_true(exact->u0 == part->u0 && exact->u1 == part->u1);
      assert_true(exact->v0 == part->v0 && exact->v1 == part->v1);
      for (int k = 0; k < 5; k++) {
        const double u = some(part->u0, part->u1), v = some(part->v0, part->v1);
        assert_point(surface_at(exact, u, v), surface_at(part, u, v), 1e-12, "exact form");
      }
      cag_surface_release(exact);
      cag_surface_release(part);
      cag_surface_release(base);
    }
  cag_surface_release(s);
}

// Where a range lies about zero makes no difference: parts of parts, and their exact forms.
static void parts_over_negative_ranges_have_exact_forms(void **state) {
  (void)state;
  seed = 76;
  static const double START[] = {-2, -4, -5, -9, 6};
  for (int round = 0; round < 15; round++) {
    CagCurve *c = wave_from(START[round % 5]), *d = wave_from(START[round % 5]);
    CagSurface *s, *turned, *part;
    const double turn = uniform(0.5, 3);
    if (round < 5) MUST(cag_surface_ruled(c, d, &s, err));
    else if (round < 10)
      MUST(cag_surface_revolve(c, cag_vec3(0, 1, 0), cag_vec3(0, 0, 0), -turn, turn, &s, err));
    else MUST(cag_surface_extrude(c, cag_vec3(0.5, 0.2, 3), 0, 1, &s, err));
    MUST(cag_surface_transpose(s, &turned, err));
    for (int k = 0; k < 2; k++) {
      const CagSurface *of = k ? turned : s;
      double a[2], b[2];
      for (int i = 0; i < 2; i++) a[i] = uniform(0.1, 0.4), b[i] = uniform(0.6, 0.9);
      const double u = of->u1 - of->u0, v = of->v1 - of->v0;
      MUST(cag_surface_part(of, of->u0 + a[0] * u, of->u0 + b[0] * u, of->v0 + a[1] * v,
                            of->v0 + b[1] * v, &part, err));
      check_exact_part(part);
      cag_surface_release(part);
    }
    cag_surface_release(turned);
    cag_surface_release(s);
    cag_curve_release(c);
    cag_curve_release(d);
  }
}

static void ranges_of_parts_are_checked(void **state) {
  (void)state;
  seed = 72;
  static const struct {
    double at[4]; // in parts of both ranges
    const char *reason;
  } CASES[] = {
      {{0, 1, 0, 1}, NULL},
      {{0.25, 0.75, 0, 1}, NULL},
      {{-0.001, 0.5, 0, 1}, "parameter-range"},
      {{0.5, 1.001, 0, 1}, "parameter-range"},
      {{0, 1, -0.001, 1}, "parameter-range"},
      {{0, 1, 0.5, 1.001}, "parameter-range"},
      {{0.5, 0.5, 0, 1}, "empty-range"},
      {{0.5, 0.25, 0, 1}, "empty-range"},
      {{0, 1, 0.5, 0.5}, "empty-range"},
  };
  CagSurface *s = surface_of(EXTRUDED), *part;
  CagError e;
  const double u = s->u1 - s->u0, v = s->v1 - s->v0;
  for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
    const double *at = CASES[i].at;
    const CagStatus status = cag_surface_part(s, s->u0 + at[0] * u, s->u0 + at[1] * u,
                                              s->v0 + at[2] * v, s->v0 + at[3] * v, &part, &e);
    assert_int_equal(status, CASES[i].reason ? CAG_E_DOMAIN : CAG_OK);
    if (status) assert_string_equal(cag_error_info(e.id)->reason, CASES[i].reason);
    else cag_surface_release(part);
  }
  assert_int_not_equal(cag_surface_part(s, 0.5, 4.5, 0, 1, &part, &e), CAG_OK);
  assert_string_equal(e.message, "`u` must be a range within -1..3, found 0.5..4.5");
  cag_surface_release(s);
  s = surface_of(TORUS);
  assert_int_not_equal(cag_surface_part(s, 0, M_PI, -M_PI / 2, M_PI, &part, &e), CAG_OK);
  assert_string_equal(e.message, "`v` must be a range within 0deg..360deg, found -90deg..180deg");
  cag_surface_release(s);
}

static void exchanged_parameters_exchange_everything(void **state) {
  (void)state;
  seed = 73;
  for (int kind = 0; kind < KINDS; kind++) {
    CagSurface *s = surface_of(kind), *t, *back;
    double cuts[16];
    char text[160];
    MUST(cag_surface_transpose(s, &t, err));
    assert_true(t->u0 == s->v0 && t->u1 == s->v1 && t->v0 == s->u0 && t->v1 == s->u1);
    assert_int_equal(t->angular_u, s->angular_v);
    assert_int_equal(t->angular_v, s->angular_u);
    assert_int_equal(t->closed_u, s->closed_v);
    assert_int_equal(t->closed_v, s->closed_u);
    check_cuts(t, 0, cuts, expected_cuts(s, 1, s->v0, s->v1, cuts));
    check_cuts(t, 1, cuts, expected_cuts(s, 0, s->u0, s->u1, cuts));
    for (int i = 0; i < 5; i++) {
      CagVec3 a[SQUARE], b[SQUARE];
      const double u = some(s->u0, s->u1), v = some(s->v0, s->v1);
      eval_all(t, v, u, a);
      eval_all(s, u, v, b);
      for (int j = 0; j <= ORDER; j++)
        for (int k = 0; j + k <= ORDER; k++)
          assert_true(cag_norm(cag_sub(a[cag_partial(ORDER, k, j)], b[cag_partial(ORDER, j, k)])) ==
                      0);
    }
    assert_consistent(t);
    snprintf(text, sizeof text, "of %s %s surface", cag_article(s->kind->name), s->kind->name);
    assert_text(t, text);
    MUST(cag_surface_transpose(t, &back, err));
    assert_true(back == s);
    cag_surface_release(back);
    if (has_exact_form[kind]) {
      CagSurface *exact, *plain;
      MUST(cag_surface_to_nurbs(t, &exact, err));
      MUST(cag_surface_to_nurbs(s, &plain, err));
      for (int i = 0; i < 5; i++) {
        const double x = some(plain->u0, plain->u1), y = some(plain->v0, plain->v1);
        assert_point(surface_at(exact, y, x), surface_at(plain, x, y), 1e-13, "exact form");
      }
      cag_surface_release(exact);
      cag_surface_release(plain);
    }
    cag_surface_release(t);
    cag_surface_release(s);
  }
}

// Between the two sides of a kink the derivatives from either side are those of the inner surface.
static void sides_are_exchanged_as_well(void **state) {
  (void)state;
  const CagVec3 corners[] = {{0, 0, 0}, {3, 0, 0}, {4, 2, 0}, {1, 3, 0}};
  CagCurve *c;
  CagSurface *s, *t, *part;
  double *cuts;
  size_t n;
  MUST(cag_curve_polyline(corners, 4, false, 2, &c, err));
  MUST(cag_surface_extrude(c, cag_vec3(0.5, 0, 3), 0.7, 0.6, &s, err));
  MUST(cag_surface_transpose(s, &t, err));
  MUST(cag_surface_part(s, s->u0, s->u1, 0.1, 0.9, &part, err));
  MUST(cag_surface_cuts(s, 0, &cuts, &n, err));
  assert_int_equal(n, 3);
  for (int side = 0; side < 2; side++) {
    CagVec3 a[4], b[4], d[4];
    const CagSide of = side ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    MUST(cag_surface_eval(s, cuts[1], 0.3, 1, of, CAG_SIDE_RIGHT, a, err));
    MUST(cag_surface_eval(t, 0.3, cuts[1], 1, CAG_SIDE_RIGHT, of, b, err));
    MUST(cag_surface_eval(part, cuts[1], 0.3, 1, of, CAG_SIDE_RIGHT, d, err));
    assert_point(b[cag_partial(1, 0, 1)], a[cag_partial(1, 1, 0)], 0, "transposed");
    assert_point(b[cag_partial(1, 1, 0)], a[cag_partial(1, 0, 1)], 0, "transposed");
    assert_point(d[cag_partial(1, 1, 0)], a[cag_partial(1, 1, 0)], 0, "part");
    MUST(cag_surface_eval(s, cuts[1], 0.3, 1, side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, CAG_SIDE_RIGHT,
                          d, err));
    assert_true(cag_norm(cag_sub(d[cag_partial(1, 1, 0)], a[cag_partial(1, 1, 0)])) > 0.1);
  }
  free(cuts);
  cag_surface_release(part);
  cag_surface_release(t);
  cag_surface_release(s);
  cag_curve_release(c);
}

// --- Offsets ---

enum { HIGH = CAG_MAX_PARTIAL - 1, MANY = (CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1) };

// All partials of two surfaces with the same parameters, of all orders.
static void assert_same_partials(const CagSurface *a, const CagSurface *b, double u, double v,
                                 int order, double tolerance) {
  static CagVec3 x[MANY], y[MANY];
  for (int side = 0; side < 4; side++) {
    const CagSide su = side & 1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                  sv = side & 2 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    MUST(cag_surface_eval(a, u, v, order, su, sv, x, err));
    MUST(cag_surface_eval(b, u, v, order, su, sv, y, err));
    for (int i = 0; i <= order; i++)
      for (int j = 0; i + j <= order; j++)
        assert_point(x[cag_partial(order, i, j)], y[cag_partial(order, i, j)], tolerance,
                     "partial of an offset");
  }
}

static CagSurface *ball(double radius) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  CagSurface *s;
  frame.planar = false;
  frame.m[1][1] = frame.m[2][2] = 0;
  frame.m[2][1] = 1;
  frame.m[1][2] = -1;
  MUST(cag_curve_arc(radius, radius, -M_PI / 2, M_PI / 2, &frame, &c, err));
  MUST(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, err));
  cag_curve_release(c);
  return s;
}

// An offset of a torus is one with another minor radius; of a ball, a ball, also at its poles.
static void offsets_of_tori_and_balls_are_tori_and_balls(void **state) {
  (void)state;
  seed = 74;
  for (int round = 0; round < 12; round++) {
    const double d = uniform(0.1, 0.8) * (round % 2 ? 1 : -1);
    CagSurface *s, *o, *expected;
    CagVec3 n;
    if (round % 4 < 2) MUST(cag_surface_torus(4, 1.5, &s, err));
    else s = ball(2);
    // Whether the normal is outward.
    MUST(cag_surface_normal(s, 0.3, 0.4, &n, err));
    const CagVec3 p = surface_at(s, 0.3, 0.4);
    const CagVec3 center =
        round % 4 < 2 ? cag_scaled(cag_unit(cag_vec3(p.x, p.y, 0)), 4) : cag_vec3(0, 0, 0);
    const double side = cag_dot(n, cag_sub(p, center)) > 0 ? d : -d;
    if (round % 4 < 2) MUST(cag_surface_torus(4, 1.5 + side, &expected, err));
    else expected = ball(2 + side);
    MUST(cag_surface_offset(s, d, &o, err));
    for (int i = 0; i < 6; i++) {
      // Well off the poles, where rounding grows.
      const double u = s->u0 + uniform(0.1, 0.9) * (s->u1 - s->u0);
      const double v = s->v0 + uniform(0.1, 0.9) * (s->v1 - s->v0);
      assert_same_partials(o, expected, u, v, round % (HIGH + 1), 1e-8);
      assert_same_partials(o, expected, u, v, 2, 1e-11);
    }
    if (round % 4 >= 2) {
      // Where the normal is a limit, derivatives are those close by.
      assert_true(s->pole_u0 || s->pole_v0);
      for (int i = 0; i < 5; i++) {
        const double along = s->pole_v0 ? some(s->u0, s->u1) : some(s->v0, s->v1);
        for (int end = 0; end < 2; end++) {
          const double pole = s->pole_v0 ? (end ? s->v1 : s->v0) : end ? s->u1 : s->u0;
          assert_same_partials(o, expected, s->pole_v0 ? along : pole, s->pole_v0 ? pole : along, 1,
                               1e-5);
          assert_point(surface_at(o, s->pole_v0 ? along : pole, s->pole_v0 ? pole : along),
                       cag_vec3(0, 0, (end ? 1 : -1) * (2 + side)), 1e-12, "pole");
        }
      }
    }
    assert_consistent(o);
    const CagSurface *inner;
    double by;
    assert_true(cag_surface_offset_view(o, &inner, &by) && inner == s && by == d);
    assert_false(cag_surface_offset_view(s, &inner, &by));
    CagVec3 all[MANY];
    MUST_FAIL(cag_surface_eval(o, 0.3, 0.4, HIGH + 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, all, err),
              "derivative-order");
    MUST_FAIL(cag_surface_offset(s, INFINITY, &expected, err), "not-finite");
    cag_surface_release(o);
    cag_surface_release(expected);
    cag_surface_release(s);
  }
}

// The tube of a horn torus reaches the axis, where the surface has no normal along a whole line.
static void offsets_have_derivatives_on_the_axis_of_a_torus(void **state) {
  (void)state;
  CagSurface *s, *o, *expected;
  CagVec3 n;
  MUST(cag_surface_torus(2, 2, &s, err));
  MUST(cag_surface_offset(s, 0.5, &o, err));
  MUST(cag_surface_normal(s, 0.3, 0.4, &n, err));
  const CagVec3 p = surface_at(s, 0.3, 0.4);
  const CagVec3 center = cag_scaled(cag_unit(cag_vec3(p.x, p.y, 0)), 2);
  const bool outward = cag_dot(n, cag_sub(p, center)) > 0;
  MUST(cag_surface_torus(2, outward ? 2.5 : 1.5, &expected, err));
  for (int i = 0; i < 8; i++) {
    // The angle about the tube is u or v.
    const double about = 0.1 + 0.7 * i;
    const bool is_v = cag_norm(surface_at(s, about, M_PI)) < 1e-9;
    assert_near(cag_norm(surface_at(s, is_v ? about : M_PI, is_v ? M_PI : about)), 0, 1e-9, "axis");
    assert_same_partials(o, expected, is_v ? about : M_PI, is_v ? M_PI : about, 1, 1e-4);
  }
  cag_surface_release(o);
  cag_surface_release(expected);
  cag_surface_release(s);
}

// Moved by whole numbers and back, or turned over twice: a surface of the same kind with the same
// points. Other moves stay.
static void maps_that_undo_each_other_leave_the_surface(void **state) {
  (void)state;
  seed = 77;
  for (int kind = 0; kind < KINDS; kind++) {
    CagSurface *s = surface_of(kind), *base, *moved, *back;
    MUST(cag_surface_transpose(s, &base, err)); // moved only as a whole
    const CagTransform away = cag_translate(cag_vec3(4, -8, 16));
    for (int axis = 0; axis < 3; axis++) {
      const double one = axis == 0 ? -4 : -3, two = axis == 1 ? 8 : 7, three = axis == 2 ? -16 : 5;
      const CagTransform other = cag_translate(cag_vec3(one, two, three));
      MUST(cag_surface_transform(base, &away, &moved, err));
      assert_string_equal(moved->kind->name, "transformed");
      MUST(cag_surface_transform(moved, &other, &back, err));
      assert_string_equal(back->kind->name, "transformed");
      cag_surface_release(back);
      const CagTransform home = cag_translate(cag_vec3(-4, 8, -16));
      MUST(cag_surface_transform(moved, &home, &back, err));
      assert_true(back == base);
      cag_surface_release(back);
      cag_surface_release(moved);
    }
    MUST(cag_surface_flip(base, &moved, err));
    assert_string_equal(moved->kind->name, "transformed");
    MUST(cag_surface_flip(moved, &back, err));
    assert_true(back == base);
    cag_surface_release(back);
    cag_surface_release(moved);
    cag_surface_release(base);
    cag_surface_release(s);
  }
}

static void flipped_surfaces_have_their_breaks_in_reverse(void **state) {
  (void)state;
  seed = 47;
  for (int round = 0; round < 12; round++) {
    const int direction = round % 2;
    // A spline that is moved, with up to six pieces.
    double knots[12] = {0, 0, 0};
    const size_t n = 3 + (size_t)(round / 2);
    for (size_t i = 3; i < n; i++) knots[i] = knots[i - 1] + uniform(0.2, 1);
    for (size_t i = n; i < n + 3; i++) knots[i] = knots[n - 1] + 1;
    CagVec3 p[8];
    for (size_t i = 0; i < n; i++) p[i] = cag_vec3((double)i, uniform(0, 1), uniform(0, 1));
    CagCurve *c;
    CagSurface *s, *flipped;
    MUST(cag_curve_nurbs(p, NULL, n, 2, knots, 3, &c, err));
    MUST(cag_surface_extrude(c, cag_vec3(0, 1, 5), 0, 1, &s, err));
    if (direction) {
      CagSurface *other;
      MUST(cag_surface_transpose(s, &other, err));
      cag_surface_release(s);
      s = other;
    }
    const CagTransform stay = cag_transform_identity();
    MUST(cag_surface_placed(s, &stay, true, &flipped, err));
    for (int k = 0; k < 2; k++) {
      double *cuts, *turned;
      size_t pieces, count;
      MUST(cag_surface_cuts(s, k, &cuts, &pieces, err));
      MUST(cag_surface_cuts(flipped, k, &turned, &count, err));
      assert_int_equal(pieces, k == direction ? n - 2 : 1);
      assert_int_equal(count, pieces);
      for (size_t i = 0; i <= count; i++)
        assert_near(turned[i], k ? s->v0 + s->v1 - cuts[count - i] : cuts[i], 1e-14, "break");
      free(cuts);
      free(turned);
    }
    cag_surface_release(flipped);
    cag_surface_release(s);
    cag_curve_release(c);
  }
}

// The sides of a crease are told apart only exactly at it, also where the parameter of the crease
// in the flipped surface is rounded.
static void flipped_surfaces_are_creased_exactly(void **state) {
  (void)state;
  seed = 53;
  for (int round = 0; round < 40; round++) {
    CagVec3 p[12];
    for (int i = 0; i < 12; i++) {
      const double y = uniform(-1, 1);
      p[i] = cag_vec3(i, y, uniform(-1, 1));
    }
    const double from = uniform(-3, 3);
    double knots[14] = {from, from};
    for (int i = 2; i < 13; i++) knots[i] = knots[i - 1] + uniform(0.1, 1);
    knots[13] = knots[12];
    CagCurve *c;
    CagSurface *s, *turned, *flipped;
    MUST(cag_curve_nurbs(p, NULL, 12, 1, knots, 2, &c, err));
    MUST(cag_surface_extrude(c, cag_vec3(0, 1, 5), 0, 1, &s, err));
    MUST(cag_surface_transpose(s, &turned, err));
    const CagTransform stay = cag_transform_identity();
    MUST(cag_surface_placed(turned, &stay, true, &flipped, err));
    double *cuts;
    size_t pieces;
    MUST(cag_surface_cuts(flipped, 1, &cuts, &pieces, err));
    assert_int_equal(pieces, 11);
    const double u = flipped->u0 + 0.3 * (flipped->u1 - flipped->u0);
    for (size_t i = 1; i < pieces; i++)
      for (int side = 0; side < 2; side++) {
        // The flipped polyline runs from the last point to the first.
        const CagVec3 a = p[pieces - i - side + 1], b = p[pieces - i - side];
        const double span = knots[pieces - i - side + 2] - knots[pieces - i - side + 1];
        CagVec3 d[3];
        MUST(cag_surface_eval(flipped, u, cuts[i], 1, CAG_SIDE_RIGHT,
                              side ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT, d, err));
        const CagVec3 dv = d[cag_partial(1, 0, 1)];
        assert_near(cag_norm(cag_sub(dv, cag_scaled(cag_sub(b, a), 1 / span))), 0, 1e-10, "dv");
      }
    free(cuts);
    cag_surface_release(flipped);
    cag_surface_release(turned);
    cag_surface_release(s);
    cag_curve_release(c);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_are_the_surface_over_smaller_ranges),
      cmocka_unit_test(parts_of_extrusions_keep_their_parameters),
      cmocka_unit_test(parts_over_negative_ranges_have_exact_forms),
      cmocka_unit_test(ranges_of_parts_are_checked),
      cmocka_unit_test(exchanged_parameters_exchange_everything),
      cmocka_unit_test(sides_are_exchanged_as_well),
      cmocka_unit_test(maps_that_undo_each_other_leave_the_surface),
      cmocka_unit_test(flipped_surfaces_have_their_breaks_in_reverse),
      cmocka_unit_test(flipped_surfaces_are_creased_exactly),
      cmocka_unit_test(offsets_of_tori_and_balls_are_tori_and_balls),
      cmocka_unit_test(offsets_have_derivatives_on_the_axis_of_a_torus),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
