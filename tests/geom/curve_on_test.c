// Curves on surfaces, random ones: places and derivatives against the surface and differences,
// breaks against sign changes along the plane curve, sides against the limits from either side.

#include <stdio.h>

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/curve/family.h"
#include "geom/surface/curve_on.h"
#include "geom/surface/family.h"
#include "geom/surface/reshape.h"

enum { TORUS, PATCH, CLOSED_NET, BOX_WALL, TUBE, LATHE, OFFSET, TURNED_WALL, KINDS };

// A patch with breaks of all degrees of smoothness: its knots are simple, double and triple.
static CagSurface *patch(void) {
  enum { NU = 9, NV = 8 };
  const double ku[] = {-1, -1, -1, -1, 0, 1, 1, 2, 2, 3, 3, 3, 3};
  const double kv[] = {0, 0, 0, 0, 0.5, 0.5, 0.5, 1, 2, 2, 2, 2};
  CagVec3 p[NU * NV];
  CagSurface *s;
  for (int i = 0; i < NU * NV; i++) p[i] = cag_vec3(i / NV, i % NV, uniform(-1, 1));
  OK(cag_surface_nurbs(p, NULL, NU, NV, 3, 3, ku, kv, &s, &err));
  return s;
}

static CagSurface *closed_net(void) {
  enum { NU = 6, NV = 5 };
  CagVec3 p[NU * NV];
  CagSurface *s;
  const double kv[] = {0, 0, 0, 1, 2, 3, 3, 3};
  for (int i = 0; i < NU * NV; i++) {
    const double r = uniform(2, 3), a = 2 * M_PI * (i / NV) / NU;
    p[i] = cag_vec3(r * cos(a), r * sin(a), i % NV);
  }
  OK(cag_surface_nurbs_closed(p, NULL, NU, NV, 2, 2, NULL, kv, true, false, &s, &err));
  return s;
}

// Corners are breaks, and the seam is one of them.
static CagSurface *box_wall(void) {
  const CagVec3 corners[] = {{0, 0, 0}, {3, 0, 0}, {4, 2, 0}, {1, 3, 0}, {-1, 1, 0}};
  CagCurve *outline, *timed;
  CagSurface *s;
  OK(cag_curve_polyline(corners, 5, true, 2, &outline, &err));
  OK(cag_curve_reparametrize(outline, -1, 4, &timed, &err));
  OK(cag_surface_extrude(timed, cag_vec3(0.5, 0, 3), 0.7, 0.6, &s, &err));
  cag_curve_release(timed);
  cag_curve_release(outline);
  return s;
}

static CagSurface *surface_of(int kind) {
  CagSurface *s = NULL, *base;
  CagCurve *c;
  switch (kind) {
  case TORUS: OK(cag_surface_torus(4, 1.5, &s, &err)); return s;
  case PATCH: return patch();
  case CLOSED_NET: return closed_net();
  case BOX_WALL: return box_wall();
  case TUBE:
    OK(cag_curve_helix(3, 4, 1.5, 0, &c, &err));
    OK(cag_surface_tube(c, 0.7, &s, &err));
    cag_curve_release(c);
    return s;
  case LATHE:
    OK(cag_curve_line(cag_vec3(1, 0, -1), cag_vec3(2, 0, 1), 3, &c, &err));
    OK(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0.7, 0.7 + 2 * M_PI, &s, &err));
    cag_curve_release(c);
    return s;
  case OFFSET:
    base = patch();
    OK(cag_surface_offset(base, 0.05, &s, &err));
    break;
  default: base = box_wall(); OK(cag_surface_transpose(base, &s, &err));
  }
  cag_surface_release(base);
  return s;
}

// --- Plane curves ---

// Of [lo, hi], or with `closed` also some turns beside it.
static double coordinate(double lo, double hi, bool closed) {
  const double beside = closed ? 1.7 : 0;
  return lo + (hi - lo) * uniform(-beside, 1 + beside);
}

static CagVec3 place(const CagSurface *s) {
  const double u = coordinate(s->u0, s->u1, s->closed_u);
  return cag_vec3(u, coordinate(s->v0, s->v1, s->closed_v), 0);
}

static CagCurve *plane_curve(const CagSurface *s, int kind) {
  CagVec3 p[6];
  CagCurve *c;
  double weights[6];
  for (int i = 0; i < 6; i++) {
    p[i] = place(s);
    weights[i] = uniform(0.5, 2);
  }
  const double smooth[] = {0, 0, 0, 0, 0.3, 0.8, 1, 1, 1, 1};
  const double kinked[] = {2, 2, 2, 3.5, 3.5, 4, 5, 5, 5};
  switch (kind % 3) {
  case 0: OK(cag_curve_polyline(p, 4, kind % 2, 2, &c, &err)); break;
  case 1: OK(cag_curve_nurbs(p, weights, 6, 3, smooth, 2, &c, &err)); break;
  default: OK(cag_curve_nurbs(p, NULL, 6, 2, kinked, 2, &c, &err));
  }
  return c;
}

static double home(double x, double lo, double hi, bool closed) {
  if (closed) x -= (hi - lo) * floor((x - lo) / (hi - lo));
  return fmin(fmax(x, lo), hi);
}

static CagVec3 place_on(const CagSurface *s, const CagCurve *plane, double t) {
  CagVec3 at, p;
  OK(cag_curve_point(plane, t, &at, &err));
  OK(cag_surface_point(s, home(at.x, s->u0, s->u1, s->closed_u),
                       home(at.y, s->v0, s->v1, s->closed_v), &p, &err));
  return p;
}

// --- Checks ---

enum { ORDER = 4 };

// Each derivative is that of the one before, by differences of the fourth order; h: how far they
// reach.
static void check_derivatives(const CagCurve *c, double t, double h, const char *what) {
  CagVec3 d[ORDER + 1], at[4][ORDER + 1];
  const double step[4] = {-h, -h / 2, h / 2, h};
  double scale[ORDER + 1];
  OK(cag_curve_eval(c, t, ORDER, CAG_SIDE_RIGHT, d, &err));
  for (int i = 0; i < 4; i++)
    OK(cag_curve_eval(c, t + step[i], ORDER, CAG_SIDE_RIGHT, at[i], &err));
  for (int k = 0; k <= ORDER; k++) {
    scale[k] = cag_norm(d[k]);
    for (int i = 0; i < 4; i++) scale[k] = fmax(scale[k], cag_norm(at[i][k]));
  }
  for (int k = 0; k < ORDER; k++) {
    const CagVec3 wide = cag_scaled(cag_sub(at[3][k], at[0][k]), 1 / (2 * h)),
                  near = cag_scaled(cag_sub(at[2][k], at[1][k]), 1 / h);
    const CagVec3 slope = cag_madd(near, 1.0 / 3, cag_sub(near, wide));
    // How far the two differ tells the error of the differences.
    const double error = cag_norm(cag_sub(near, wide)) + 1e-13 * scale[k] / h;
    if (cag_norm(cag_sub(slope, d[k + 1])) > 1e-3 * scale[k + 1] + 0.3 * error)
      fail_msg("%s: derivative %d at %g is [%g %g %g], differences [%g %g %g]", what, k + 1, t,
               d[k + 1].x, d[k + 1].y, d[k + 1].z, slope.x, slope.y, slope.z);
  }
}

// From either side the derivatives are the limits of those beside, as far as both are smooth.
static void check_side(const CagCurve *c, double t, CagSide side, double room, const char *what) {
  CagVec3 here[ORDER], beside[2][ORDER];
  const double h = (side == CAG_SIDE_RIGHT ? 1e-4 : -1e-4) * room;
  OK(cag_curve_eval(c, t, ORDER - 1, side, here, &err));
  for (int i = 0; i < 2; i++)
    OK(cag_curve_eval(c, t + (i + 1) * h, ORDER - 1, side, beside[i], &err));
  for (int k = 0; k < ORDER; k++) {
    const CagVec3 limit = cag_sub(cag_scaled(beside[0][k], 2), beside[1][k]);
    if (cag_norm(cag_sub(limit, here[k])) > 1e-3 * (cag_norm(here[k]) + cag_norm(beside[1][k])))
      fail_msg("%s: derivative %d at %.17g, side %d, is [%g %g %g], not [%g %g %g]", what, k, t,
               (int)side, here[k].x, here[k].y, here[k].z, limit.x, limit.y, limit.z);
  }
}

// Places where a coordinate of the plane curve passes a break or a seam.
static size_t find_passes(const CagSurface *s, const CagCurve *plane, double *out) {
  enum { STEPS = 4000, MOST = 64 };
  size_t count = 0;
  for (int direction = 0; direction < 2; direction++) {
    double lines[MOST];
    const bool closed = direction ? s->closed_v : s->closed_u;
    const double lo = direction ? s->v0 : s->u0, hi = direction ? s->v1 : s->u1;
    size_t n = s->kind->breaks ? s->kind->breaks(s, direction, lines, MOST) : 0;
    if (closed) lines[n++] = lo;
    for (size_t k = 0; k < n; k++)
      for (int turn = closed ? -3 : 0; turn <= (closed ? 3 : 0); turn++) {
        const double at = lines[k] + turn * (hi - lo);
        double before = 0;
        for (int i = 0; i <= STEPS; i++) {
          double a = plane->start + (plane->end - plane->start) * (i - 1) / STEPS;
          double b = plane->start + (plane->end - plane->start) * i / STEPS;
          CagVec3 p;
          OK(cag_curve_point(plane, b, &p, &err));
          const double now = (direction ? p.y : p.x) - at;
          if (i > 0 && (before < 0) != (now < 0)) {
            for (int halving = 0; halving < 60; halving++) {
              const double m = (a + b) / 2;
              OK(cag_curve_point(plane, m, &p, &err));
              if (((direction ? p.y : p.x) < at) == (before < 0)) a = m;
              else b = m;
            }
            out[count++] = a;
          }
          before = now;
        }
      }
  }
  return count;
}

static bool among(const double *list, size_t n, double x) {
  for (size_t i = 0; i < n; i++)
    if (fabs(list[i] - x) < 1e-9) return true;
  return false;
}

static void check_breaks(const CagSurface *s, const CagCurve *plane, const CagCurve *c,
                         const char *what) {
  double passes[512], *own, *cuts;
  const size_t n = find_passes(s, plane, passes);
  size_t own_count, count;
  OK(cag_curve_cuts(plane, &own, &own_count, &err));
  OK(cag_curve_cuts(c, &cuts, &count, &err));
  for (size_t i = 0; i < n; i++)
    if (!among(cuts, count, passes[i])) fail_msg("%s: no break at %.17g", what, passes[i]);
  for (size_t i = 0; i < own_count; i++)
    if (!among(cuts, count, own[i])) fail_msg("%s: no break at its own %g", what, own[i]);
  for (size_t i = 0; i < count; i++)
    if (!among(passes, n, cuts[i]) && !among(own, own_count, cuts[i]))
      fail_msg("%s: a break at %.17g", what, cuts[i]);
  for (size_t i = 0; i + 1 < count; i++) {
    const double room = cuts[i + 1] - cuts[i];
    assert_true(room > 0);
    if (room < 1e-4) continue;
    // Breaks are exact but for rounding.
    check_side(c, cuts[i] + 1e-6 * room, CAG_SIDE_RIGHT, room, what);
    check_side(c, cuts[i + 1] - 1e-6 * room, CAG_SIDE_LEFT, room, what);
    for (int k = 0; k < 2; k++)
      check_derivatives(c, cuts[i] + uniform(0.1, 0.9) * room, 0.01 * room, what);
  }
  free(own);
  free(cuts);
  // No more are given than there is room for.
  double some[3] = {NAN, NAN, NAN};
  assert_int_equal(c->kind->breaks(c, some, 2), count - 2);
  assert_true(isnan(some[2]) && isnan(some[0]) == (count < 3) && isnan(some[1]) == (count < 4));
}

static void curves_on_surfaces_are_as_their_parts_tell(void **state) {
  (void)state;
  seed = 51;
  for (int round = 0; round < 12 * KINDS; round++) {
    CagSurface *s = surface_of(round % KINDS);
    CagCurve *plane = plane_curve(s, round / KINDS), *c;
    char what[64];
    snprintf(what, sizeof what, "round %d, %s", round, s->kind->name);
    OK(cag_curve_on_surface(s, plane, &c, &err));
    assert_true(c->start == plane->start && c->end == plane->end && c->dimension == 3);
    for (int i = 0; i <= 40; i++) {
      const double t = c->start + (c->end - c->start) * i / 40;
      CagVec3 p;
      OK(cag_curve_point(c, t, &p, &err));
      near_vec(p, place_on(s, plane, t), 1e-11);
    }
    assert_int_equal(c->closed, cag_norm(cag_sub(place_on(s, plane, c->start),
                                                 place_on(s, plane, c->end))) < 1e-9);
    check_breaks(s, plane, c, what);
    cag_curve_release(c);
    cag_curve_release(plane);
    cag_surface_release(s);
  }
}

// Images, affine and projective, and the curve reversed, in part and over another range.
static void images_of_curves_on_surfaces_are_those_of_their_points(void **state) {
  (void)state;
  seed = 52;
  for (int round = 0; round < 4 * KINDS; round++) {
    CagSurface *s = surface_of(round % KINDS);
    CagCurve *plane = plane_curve(s, round), *c, *image, *twice, *other[3];
    CagTransform t = cag_shear(0.3, -0.2, 0.5, 0.1, 0, 0.4), turn;
    OK(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(1, 0, -1), &turn, &err));
    if (round % 2) {
      t.m[3][0] = 0.02;
      t.m[3][1] = -0.03;
      t.m[3][2] = 0.01;
    }
    OK(cag_curve_on_surface(s, plane, &c, &err));
    OK(cag_curve_transform(c, &t, &image, &err));
    OK(cag_curve_transform(image, &turn, &twice, &err));
    const double a = c->start + 0.2 * (c->end - c->start), b = c->end - 0.3 * (c->end - c->start);
    OK(cag_curve_reverse(twice, &other[0], &err));
    OK(cag_curve_trim(twice, a, b, &other[1], &err));
    OK(cag_curve_reparametrize(twice, -1, 4, &other[2], &err));
    assert_true(other[1]->start == a && other[1]->end == b);
    for (int i = 0; i <= 20; i++) {
      const double x = a + (b - a) * i / 20;
      const CagVec3 p = cag_transform_point(&t, place_on(s, plane, x));
      const CagVec3 q = cag_transform_point(&turn, p);
      CagVec3 found;
      OK(cag_curve_point(image, x, &found, &err));
      near_vec(found, p, 1e-11);
      OK(cag_curve_point(twice, x, &found, &err));
      near_vec(found, q, 1e-11);
      OK(cag_curve_point(other[0], c->start + c->end - x, &found, &err));
      near_vec(found, q, 1e-9);
      OK(cag_curve_point(other[1], x, &found, &err));
      near_vec(found, q, 1e-9);
      OK(cag_curve_point(other[2], -1 + 5 * (x - c->start) / (c->end - c->start), &found, &err));
      near_vec(found, q, 1e-9);
    }
    check_breaks(s, plane, twice, "image");
    for (int i = 0; i < 3; i++) cag_curve_release(other[i]);
    cag_curve_release(twice);
    cag_curve_release(image);
    cag_curve_release(c);
    cag_curve_release(plane);
    cag_surface_release(s);
  }
}

// A curve that touches the line on which the surface has an edge stays on one side of it; one that
// ends at a seam, at whatever turn and in whatever direction, comes to it from its own side.
static void sides_are_those_that_the_curve_comes_from(void **state) {
  (void)state;
  seed = 53;
  CagSurface *s = box_wall();
  CagCurve *plane, *c;
  const double period = s->u1 - s->u0;
  double corner[8];
  assert_int_equal(s->kind->breaks(s, 0, corner, 8), 4);
  for (int round = 0; round < 40; round++) {
    // x = at + d (2 t - 1)^2, as a Bezier curve.
    const double turn = (round % 5 - 2) * period, d = 0.3 * (round % 2 ? 1 : -1);
    const double at = (round % 3 ? corner[round % 4] : s->u0) + turn;
    const CagVec3 p[] = {{at + d, 0.1, 0}, {at - d, 0.5, 0}, {at + d, 0.8, 0}};
    OK(cag_curve_bezier(p, NULL, 3, 2, &plane, &err));
    OK(cag_curve_on_surface(s, plane, &c, &err));
    check_side(c, 0.5, CAG_SIDE_RIGHT, 0.3, "touch");
    check_side(c, 0.5, CAG_SIDE_LEFT, 0.3, "touch");
    cag_curve_release(c);
    cag_curve_release(plane);
    // Straight to an edge, and back.
    const double aside = uniform(0.05, 0.4);
    const CagVec3 line[] = {{at + (round % 2 ? aside : -aside), 0.2, 0}, {at, 0.7, 0}};
    for (int back = 0; back < 2; back++) {
      OK(cag_curve_line(line[back], line[1 - back], 2, &plane, &err));
      OK(cag_curve_on_surface(s, plane, &c, &err));
      check_side(c, c->start, CAG_SIDE_RIGHT, 0.5 * (c->end - c->start), "start");
      check_side(c, c->end, CAG_SIDE_LEFT, 0.5 * (c->end - c->start), "end");
      cag_curve_release(c);
      cag_curve_release(plane);
    }
    // Along an edge it has no breaks, and rises with the wall.
    const CagVec3 upright[] = {{at, 0.2, 0}, {at, 0.7, 0}};
    double *cuts;
    size_t n;
    OK(cag_curve_line(upright[0], upright[1], 2, &plane, &err));
    OK(cag_curve_on_surface(s, plane, &c, &err));
    OK(cag_curve_cuts(c, &cuts, &n, &err));
    assert_int_equal(n, 2);
    free(cuts);
    cag_curve_release(c);
    cag_curve_release(plane);
  }
  cag_surface_release(s);
}

static void curves_must_stay_on_the_surface(void **state) {
  (void)state;
  seed = 54;
  CagSurface *s = patch(), *torus;
  CagCurve *plane, *c;
  const struct {
    CagVec3 a, b;
    const char *says; // NULL: it serves
  } CASES[] = {
      {{-1, 0, 0}, {3, 2, 0}, NULL},
      {{-1 - 1e-10, 0, 0}, {3 + 1e-10, 2 + 1e-10, 0}, NULL},
      {{-1.5, 0, 0}, {3, 2, 0}, "reaches x = -1.5, outside of the domain -1..3 of"},
      {{-1, 0, 0}, {3.5, 2, 0}, "reaches x = 3.5, outside of the domain -1..3 of"},
      {{-1, -0.25, 0}, {3, 2, 0}, "reaches y = -0.25, outside of the domain 0..2 of"},
      {{-1, 0, 0}, {3, 2.25, 0}, "reaches y = 2.25, outside of the domain 0..2 of"},
      {{-1 - 1e-7, 0, 0}, {3, 2, 0}, "reaches x"},
      {{-1, 0, 0}, {3, 2 + 1e-7, 0}, "reaches y"},
  };
  for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
    OK(cag_curve_line(CASES[i].a, CASES[i].b, 2, &plane, &err));
    if (CASES[i].says) {
      FAILS(cag_curve_on_surface(s, plane, &c, &err), "curve-outside");
      if (!strstr(err.message, CASES[i].says)) fail_msg("%s", err.message);
      assert_null(strstr(err.message, "radians"));
    } else {
      OK(cag_curve_on_surface(s, plane, &c, &err));
      assert_false(c->closed);
      CagVec3 d[CAG_MAX_PARTIAL + 2];
      OK(cag_curve_eval(c, 0.3, CAG_MAX_PARTIAL, CAG_SIDE_RIGHT, d, &err));
      FAILS(cag_curve_eval(c, 0.3, CAG_MAX_PARTIAL + 1, CAG_SIDE_RIGHT, d, &err),
            "derivative-order");
      // The plane on which the image is infinitely far away passes a point of the curve.
      CagTransform t = cag_transform_identity();
      CagVec3 p;
      CagCurve *image;
      t.planar = false;
      OK(cag_curve_point(c, 0.5 * (c->start + c->end), &p, &err));
      t.m[3][0] = 1;
      t.m[3][3] = -p.x;
      const CagStatus status = cag_curve_transform(c, &t, &image, &err);
      if (!status) {
        FAILS(cag_curve_eval(image, 0.5 * (c->start + c->end), 0, CAG_SIDE_RIGHT, d, &err),
              "not-finite");
        cag_curve_release(image);
      }
      cag_curve_release(c);
    }
    cag_curve_release(plane);
  }
  cag_surface_release(s);
  // Around a torus as often as it likes, but for a limit; closed where both are whole turns.
  OK(cag_surface_torus(4, 1.5, &torus, &err));
  // Whole turns count, whatever the surface's parameters are.
  CagCurve *outline, *timed;
  const CagVec3 corners[] = {{0, 0, 0}, {3, 0, 0}, {1, 3, 0}};
  OK(cag_curve_polyline(corners, 3, true, 2, &outline, &err));
  OK(cag_curve_reparametrize(outline, 0, 5000, &timed, &err));
  OK(cag_surface_extrude(timed, cag_vec3(0, 0, 3), 0, 1, &s, &err));
  OK(cag_curve_line(cag_vec3(10, 0.2, 0), cag_vec3(10010, 0.2, 0), 2, &plane, &err));
  OK(cag_curve_on_surface(s, plane, &c, &err));
  assert_true(c->closed);
  cag_curve_release(c);
  cag_curve_release(plane);
  cag_curve_release(outline);
  cag_curve_release(timed);
  cag_surface_release(s);
  const double turns[][2] = {{3, 2}, {3, 2.5}, {2.5, 1}, {1, 0}, {1, 1e-6}, {2e6, 0}, {0, 2e6}};
  for (int i = 0; i < 7; i++) {
    OK(cag_curve_line(cag_vec3(0.3, -0.8, 0),
                      cag_vec3(0.3 + 2 * M_PI * turns[i][0], -0.8 + 2 * M_PI * turns[i][1], 0), 2,
                      &plane, &err));
    if (i > 4) {
      FAILS(cag_curve_on_surface(torus, plane, &c, &err), "curve-outside");
      assert_non_null(strstr(err.message, "(radians)"));
    } else {
      OK(cag_curve_on_surface(torus, plane, &c, &err));
      assert_int_equal(c->closed, i == 0 || i == 3);
      cag_curve_release(c);
    }
    cag_curve_release(plane);
  }
  cag_surface_release(torus);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curves_on_surfaces_are_as_their_parts_tell),
      cmocka_unit_test(images_of_curves_on_surfaces_are_those_of_their_points),
      cmocka_unit_test(sides_are_those_that_the_curve_comes_from),
      cmocka_unit_test(curves_must_stay_on_the_surface),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
