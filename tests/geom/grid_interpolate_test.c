// Surfaces through grids of random points, with parameters and knots according to the definitions,
// and grids that are rejected.

#include <stdio.h>

#include "geom/surface/loft.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 9, POINTS = MOST * MOST };

typedef struct Subject {
  CagGridData g;
  CagVec3 points[POINTS];
  double parameters[2][POINTS], knots[2][2 * MOST];
} Subject;

static int whole(int low, int high) { return low + (int)uniform(0, high - low + 1); }

static int degree_of(const Subject *s, int k) { return k ? s->g.degree_v : s->g.degree_u; }
static size_t lines_of(const Subject *s, int k) { return k ? s->g.s : s->g.r; }

// Points of a patch, a tube, or a torus. In some cases, the first row is a single point.
static void set_points(Subject *s, bool pole) {
  *s = (Subject){.g = s->g};
  s->g.r = (size_t)whole(5, MOST);
  s->g.s = (size_t)whole(5, MOST);
  s->g.degree_u = whole(1, 4);
  s->g.degree_v = whole(1, 4);
  for (int k = 0; k < 2; k++) // degree 4 is not used in closed directions
    if (s->g.closed[k] && degree_of(s, k) == 4) *(k ? &s->g.degree_v : &s->g.degree_u) = 2;
  for (size_t i = 0; i < s->g.r; i++)
    for (size_t j = 0; j < s->g.s; j++) {
      const double x = (double)i, y = (double)j;
      const double a = 2 * M_PI * x / (double)s->g.r, b = 2 * M_PI * y / (double)s->g.s;
      CagVec3 p = cag_vec3(x, y, sin(x + y));
      if (s->g.closed[1]) p = cag_vec3(3 * cos(b), 3 * sin(b), x);
      if (s->g.closed[0]) p = cag_vec3(3 * cos(a), 3 * sin(a), y);
      if (s->g.closed[0] && s->g.closed[1])
        p = cag_vec3((6 + 2 * cos(b)) * cos(a), (6 + 2 * cos(b)) * sin(a), 2 * sin(b));
      p.x += uniform(-0.2, 0.2);
      p.y += uniform(-0.2, 0.2);
      p.z += uniform(-0.2, 0.2);
      s->points[i * s->g.s + j] = pole && i == 0 ? cag_vec3(-2, 1, 1) : p;
    }
}

// Every second subject has parameters of its own.
static void set_parameters(Subject *s, int k) {
  double at[MOST] = {0};
  const size_t n = lines_of(s, k);
  for (size_t i = 1; i < n; i++) at[i] = at[i - 1] + uniform(0.7, 1.3);
  for (size_t i = 0; i < s->g.r * s->g.s; i++)
    s->parameters[k][i] = at[k ? i % s->g.s : i / s->g.s];
}

// The length of a line of points up to one of them, as a fraction. Coincident points are
// distributed evenly. A closed line includes the way back.
static double part_of(const Subject *s, int k, size_t line, size_t upto) {
  const size_t n = lines_of(s, k), steps = s->g.closed[k] ? n : n - 1;
  double part = 0, all = 0;
  for (size_t i = 0; i < steps; i++) {
    const size_t a = k ? line * s->g.s + i : i * s->g.s + line;
    const size_t next = (i + 1) % n, b = k ? line * s->g.s + next : next * s->g.s + line;
    const double step =
        s->g.spacing == CAG_GRID_UNIFORM ? 1 : cag_norm(cag_sub(s->points[b], s->points[a]));
    if (i < upto) part += step;
    all += step;
  }
  return all > 0 ? part / all : (double)upto / (double)steps;
}

static double parameter_of(const Subject *s, int k, size_t i) {
  if (s->g.parameters[k]) return s->g.parameters[k][i];
  const size_t along = k ? i % s->g.s : i / s->g.s, lines = lines_of(s, 1 - k);
  double sum = 0;
  for (size_t l = 0; l < lines; l++) sum += part_of(s, k, l, along) / (double)lines;
  if (s->g.closed[k]) {
    const double wide = (double)lines_of(s, k), half = degree_of(s, k) % 2 ? 0 : 0.5;
    return fmod(sum * wide + half, wide);
  }
  return s->g.knots[k] ? s->knots[k][0] + sum * (s->knots[k][2 * MOST - 1] - s->knots[k][0]) : sum;
}

// The knots between the ends are averages of `degree` parameters.
static void check_knots(const Subject *s, int k, const double *knots, double tolerance) {
  const size_t n = lines_of(s, k), p = (size_t)degree_of(s, k);
  for (size_t i = 0; i < n + p + 1; i++) {
    double wanted = 0;
    const size_t from = i <= p ? 0 : i >= n ? n - 1 : i - p, count = i <= p || i >= n ? 1 : p;
    for (size_t j = from; j < from + count; j++)
      wanted += parameter_of(s, k, k ? j : j * s->g.s) / (double)count;
    NEAR(knots[i], wanted, tolerance);
  }
}

static void check_surface(const Subject *s, const CagSurface *f, const CagGridReport *report) {
  CagSurfaceNurbsView view;
  assert_true(cag_surface_nurbs_view(f, &view));
  assert_true(!view.rational && view.distinct_u == s->g.r && view.distinct_v == s->g.s);
  assert_true(view.degree_u == s->g.degree_u && view.degree_v == s->g.degree_v);
  assert_true(view.periodic_u == s->g.closed[0] && view.periodic_v == s->g.closed[1]);
  for (size_t i = 0; i < view.nu * view.nv; i++) NEAR(view.homogeneous[4 * i + 3], 1, 0);
  for (int k = 0; k < 2; k++)
    if (!s->g.closed[k] && !s->g.knots[k])
      check_knots(s, k, k ? view.knots_v : view.knots_u, 1e-14);
  for (size_t i = 0; i < s->g.r * s->g.s; i++) {
    const double u = parameter_of(s, 0, i), v = parameter_of(s, 1, i);
    CagVec3 p;
    if (report) NEAR(report->u[i], u, 1e-13);
    if (report) NEAR(report->v[i], v, 1e-13);
    OK(cag_surface_point(f, fmin(fmax(u, f->u0), f->u1), fmin(fmax(v, f->v0), f->v1), &p, &err));
    near_vec(p, s->points[i], 1e-9);
  }
}

static void surfaces_pass_all_points(void **state) {
  (void)state;
  seed = 21;
  int given = 0, poles = 0;
  for (int round = 0; round < 200; round++) {
    Subject s = {0};
    s.g.spacing = (CagGridSpacing)(round % 3);
    s.g.closed[0] = round % 5 == 1 || round % 5 == 3;
    s.g.closed[1] = round % 5 >= 2 && round % 5 <= 3;
    const bool pole = !s.g.closed[0] && round % 7 < 2;
    set_points(&s, pole);
    s.g.points = s.points;
    for (int k = 0; k < 2; k++) {
      if (s.g.closed[k] || whole(0, 3)) continue;
      set_parameters(&s, k);
      s.g.parameters[k] = s.parameters[k];
      given++;
    }
    poles += pole;
    CagSurface *f[2];
    CagGridReport report;
    OK(cag_surface_interpolate(&s.g, &f[0], &err));
    OK(cag_surface_interpolate_report(&s.g, &f[1], &report, &err));
    check_surface(&s, f[0], NULL);
    check_surface(&s, f[1], &report);
    assert_true(report.rounds == 0 && report.largest < 1e-9 && report.rms <= report.largest);
    cag_surface_release(f[0]);
    cag_surface_release(f[1]);
    cag_grid_report_free(&report);
  }
  assert_true(given > 40 && poles > 30);
}

// Given knots, with given parameters or with those of the spacing over the domain of the knots.
static void given_knots_are_kept(void **state) {
  (void)state;
  seed = 22;
  for (int round = 0; round < 60; round++) {
    Subject s = {0};
    set_points(&s, false);
    s.g.points = s.points;
    s.g.spacing = CAG_GRID_UNIFORM;
    for (int k = 0; k < 2; k++) {
      const size_t n = lines_of(&s, k), p = (size_t)degree_of(&s, k);
      const double from = uniform(-3, 3), wide = uniform(1, 4);
      // Uniform knots, whose averages are close enough to evenly spaced points.
      for (size_t i = 0; i < n + p + 1; i++) {
        const double at = i <= p ? 0 : i >= n ? 1 : (double)(i - p) / (double)(n - p);
        s.knots[k][i] = from + wide * at;
      }
      s.knots[k][2 * MOST - 1] = s.knots[k][n];
      if (round % 3 != k) s.g.knots[k] = s.knots[k];
    }
    CagSurface *f;
    CagSurfaceNurbsView view;
    OK(cag_surface_interpolate(&s.g, &f, &err));
    check_surface(&s, f, NULL);
    assert_true(cag_surface_nurbs_view(f, &view));
    for (int k = 0; k < 2; k++)
      for (size_t i = 0; s.g.knots[k] && i < lines_of(&s, k) + (size_t)degree_of(&s, k) + 1; i++)
        NEAR((k ? view.knots_v : view.knots_u)[i], s.knots[k][i], 0);
    cag_surface_release(f);
  }
}

static void assert_says(const char *text) {
  if (!strstr(err.message, text)) fail_msg("\"%s\" has no \"%s\"", err.message, text);
}

static void grids_that_cannot_be_met_are_refused(void **state) {
  (void)state;
  seed = 23;
  for (int k = 0; k < 2; k++) {
    CagSurface *f;
    CagGridReport report;
    Subject s = {0};
    set_points(&s, false);
    s.g.points = s.points;
    s.g.r = 4;
    s.g.s = 5;
    s.g.degree_u = s.g.degree_v = 2;
    s.g.spacing = CAG_GRID_UNIFORM;
    const CagGridData good = s.g;
    size_t *const points = k ? &s.g.s : &s.g.r;
    int *const degree = k ? &s.g.degree_v : &s.g.degree_u;
    for (int with = 0; with < 2; with++) {
#define INTERPOLATE                                                                                \
  (with ? cag_surface_interpolate_report(&s.g, &f, &report, &err)                                  \
        : cag_surface_interpolate(&s.g, &f, &err))
      for (*points = 0; *points < 2; ++*points) {
        FAILS_AT(INTERPOLATE, "order-range", k);
        assert_says(*points == 1 ? "there is 1" : "there are 0");
      }
      *points = 2;
      *degree = 1;
      OK(INTERPOLATE);
      cag_surface_release(f);
      if (with) cag_grid_report_free(&report);
      s.g = good;
      for (*degree = -1; *degree < 7; ++*degree) {
        if (*degree < 1 || *degree >= (int)*points) {
          FAILS_AT(INTERPOLATE, "order-range", k);
          assert_says(k ? "must lie in 1..4 for 5 control points" : "must lie in 1..3 for 4");
          continue;
        }
        OK(INTERPOLATE);
        cag_surface_release(f);
        if (with) cag_grid_report_free(&report);
      }
      s.g = good;
      // Parameters must ascend.
      for (size_t i = 1; i < *points; i++)
        for (int equal = 0; equal < 2; equal++) {
          for (size_t j = 0; j < 20; j++) s.parameters[k][j] = (double)(k ? j % 5 : j / 5);
          for (size_t j = 0; j < 20; j++)
            if ((k ? j % 5 : j / 5) == i) s.parameters[k][j] = (double)i - (equal ? 1 : 1.5);
          s.g.parameters[k] = s.parameters[k];
          FAILS_AT(INTERPOLATE, "knots-not-monotone", (long)i);
        }
      s.g = good;
    }
    // For fits, the number of control points.
    for (size_t n = 0; n < 7; n++) {
      const size_t count[2] = {k ? 4 : n, k ? n : 4};
      s.g.degree_u = s.g.degree_v = 1;
      CagStatus status = cag_surface_fit(&s.g, count[0], count[1], &f, NULL, &err);
      if (n >= 2 && n <= *points) {
        OK(status);
        cag_surface_release(f);
        continue;
      }
      assert_int_not_equal(status, CAG_OK);
      assert_string_equal(cag_error_info(err.id)->reason,
                          n < 2 ? "order-range" : "fit-underdetermined");
      assert_int_equal(err.index, k);
    }
    s.g = good;
    // Parameters outside the knots by more than rounding.
    for (int over = 0; over < 4; over++)
      for (size_t i = 0; i < 20; i++) {
        set_parameters(&s, k);
        const double end = k ? 3 : 2, off = over < 2 ? 0.9e-12 : 1.1e-12;
        for (size_t j = 0; j < 20; j++)
          s.parameters[k][j] = (k ? (double)(j % 5) / 4 : (double)(j / 5) / 3) * end;
        s.parameters[k][i] = over % 2 ? end * (1 + off) : -off * end;
        s.g.parameters[k] = s.parameters[k];
        CagStatus status = cag_surface_fit(&s.g, 4, 4 + (size_t)k, &f, &report, &err);
        if (over >= 2) {
          char text[40];
          assert_int_not_equal(status, CAG_OK);
          assert_string_equal(cag_error_info(err.id)->reason, "parameter-range");
          assert_int_equal(err.index, (long)i);
          snprintf(text, sizeof text, "that of point [%d, %d] is", (int)i / 5, (int)i % 5);
          assert_says(text);
        } else if (!status) {
          NEAR((k ? report.v : report.u)[i], over % 2 ? end : 0, 0);
          cag_surface_release(f);
          cag_grid_report_free(&report);
        } else {
          assert_string_equal(cag_error_info(err.id)->reason, "fit-singular");
        }
      }
  }
}

// Where a row of points coincides and the surface passes through it, the parameters do not change,
// because there is no direction in which to move.
static void poles_keep_their_parameters(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    CagVec3 points[64];
    for (size_t i = 0; i < 64; i++) {
      const double up = (double)(k ? i % 8 : i / 8), at = (double)(k ? i / 8 : i % 8);
      points[i] = cag_vec3(up * cos(at / 3), up * sin(at / 3), 0.2 * up * up * sin(1.3 * at));
    }
    CagGridData g = {.points = points, .r = 8, .s = 8, .degree_u = 2, .degree_v = 2};
    g.spacing = CAG_GRID_UNIFORM;
    CagSurface *f;
    CagGridReport report;
    g.corrections = 1;
    OK(cag_surface_fit(&g, k ? 5 : 8, k ? 8 : 5, &f, &report, &err));
    assert_int_equal(report.rounds, 1);
    for (size_t i = 0; i < 8; i++)
      NEAR((k ? report.u : report.v)[k ? i * 8 : i], 3 * (double)i / 7, 1e-13);
    cag_surface_release(f);
    cag_grid_report_free(&report);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(surfaces_pass_all_points),
      cmocka_unit_test(given_knots_are_kept),
      cmocka_unit_test(grids_that_cannot_be_met_are_refused),
      cmocka_unit_test(poles_keep_their_parameters),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
