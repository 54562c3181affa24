// Fits to grids of random points. With the reported parameters, the residuals are orthogonal to all
// basis functions with free control points.

#include "geom/surface/loft.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 12 };

typedef struct Subject {
  CagGridData g;
  size_t count[2]; // control points
  CagVec3 points[MOST * MOST];
  CagSurface *fit;
  CagGridReport report;
} Subject;

static double entry(CagVec3 p, int i) { return i == 0 ? p.x : i == 1 ? p.y : p.z; }

// The surface whose height is basis function number i of a direction.
static CagSurface *function_of(const Subject *s, int direction, size_t i) {
  CagVec3 net[MOST * MOST];
  for (size_t k = 0; k < s->count[0] * s->count[1]; k++) {
    const size_t line = direction == 0 ? k / s->count[1] : k % s->count[1];
    net[k] = cag_vec3((double)k, 0, line == i);
  }
  double knots[2][2 * MOST];
  for (int k = 0; k < 2; k++) {
    const size_t p = (size_t)(k ? s->g.degree_v : s->g.degree_u), n = s->count[k];
    for (size_t j = 0; j < n + p + 1; j++)
      knots[k][j] = j <= p ? 0 : j >= n ? (double)(n - p) : (double)(j - p);
  }
  CagSurface *out;
  OK(cag_surface_nurbs_closed(net, NULL, s->count[0], s->count[1], s->g.degree_u, s->g.degree_v,
                              s->g.closed[0] ? NULL : knots[0], s->g.closed[1] ? NULL : knots[1],
                              s->g.closed[0], s->g.closed[1], &out, &err));
  return out;
}

// The values of the basis of a direction at all points: [function * rows + point].
static void fill(const Subject *s, int direction, double *out) {
  const size_t rows = s->g.r * s->g.s;
  for (size_t i = 0; i < s->count[direction]; i++) {
    CagSurface *f = function_of(s, direction, i);
    for (size_t k = 0; k < rows; k++) {
      CagVec3 p;
      OK(cag_surface_point(f, s->report.u[k], s->report.v[k], &p, &err));
      out[i * rows + k] = p.z;
    }
    cag_surface_release(f);
  }
}

static bool is_end(const Subject *s, int direction, size_t i, size_t n) {
  return !s->g.closed[direction] && (i == 0 || i + 1 == n);
}

// If `edges` is set, the edges were fitted to the border alone, and the corners are those of the
// data.
static void check(const Subject *s, bool edges) {
  const size_t rows = s->g.r * s->g.s;
  static double basis[2][MOST * MOST * MOST];
  CagVec3 rest[MOST * MOST];
  double sum = 0, largest = 0;
  for (int k = 0; k < 2; k++) fill(s, k, basis[k]);
  for (size_t i = 0; i < rows; i++) {
    CagVec3 p;
    OK(cag_surface_point(s->fit, s->report.u[i], s->report.v[i], &p, &err));
    rest[i] = cag_sub(s->points[i], p);
    sum += cag_dot(rest[i], rest[i]);
    largest = fmax(largest, cag_norm(rest[i]));
    for (int c = 0; c < 3; c++)
      if (c == (int)s->g.hold - 1) assert_true(fabs(entry(rest[i], c)) <= fmax(s->g.slack, 1e-13));
  }
  NEAR(s->report.rms, sqrt(sum / (double)rows), 1e-13);
  NEAR(s->report.largest, largest, 1e-13);
  for (size_t i = 0; i < s->count[0]; i++)
    for (size_t j = 0; j < s->count[1]; j++) {
      const bool at[2] = {edges && is_end(s, 0, i, s->count[0]),
                          edges && is_end(s, 1, j, s->count[1])};
      double gradient[3] = {0, 0, 0};
      for (size_t k = 0; k < rows; k++) {
        // Only points of the same edge or corner.
        if (at[0] && k / s->g.s != (i ? s->g.r - 1 : 0)) continue;
        if (at[1] && k % s->g.s != (j ? s->g.s - 1 : 0)) continue;
        for (int c = 0; c < 3; c++)
          gradient[c] += basis[0][i * rows + k] * basis[1][j * rows + k] * entry(rest[k], c);
      }
      for (int c = 0; c < 3; c++)
        if (c != (int)s->g.hold - 1) NEAR(gradient[c], 0, 1e-11);
    }
}

static void end(Subject *s) {
  cag_surface_release(s->fit);
  cag_grid_report_free(&s->report);
}

// Points of a patch, a tube, or a torus, with noise.
static void set_points(Subject *s, double noise) {
  for (size_t i = 0; i < s->g.r; i++)
    for (size_t j = 0; j < s->g.s; j++) {
      const double t = (double)i, w = (double)j;
      const double a = 2 * M_PI * t / (double)s->g.r, b = 2 * M_PI * w / (double)s->g.s;
      CagVec3 p = cag_vec3(t + 0.7 * w, w - 0.6 * t, sin(0.4 * t) * cos(0.3 * w));
      if (s->g.closed[1]) p = cag_vec3((4 + 0.1 * t) * cos(b), 3 * sin(b), 2 * t);
      if (s->g.closed[0]) p = cag_vec3((4 + 0.1 * w) * cos(a), 3 * sin(a), 2 * w);
      if (s->g.closed[0] && s->g.closed[1])
        p = cag_vec3((6 + 2 * cos(b)) * cos(a), (6 + 2 * cos(b)) * sin(a), 2 * sin(b));
      p.x += uniform(-noise, noise);
      p.y += uniform(-noise, noise);
      // The ends of a tube are horizontal.
      if (s->g.closed[0] ? j > 0 && j + 1 < s->g.s : i > 0 && i + 1 < s->g.r)
        p.z += uniform(-noise, noise);
      s->points[i * s->g.s + j] = p;
    }
}

static void set_sizes(Subject *s) {
  s->g = (CagGridData){.points = s->points,
                       .r = (size_t)uniform(8, 11.99),
                       .s = (size_t)uniform(8, 11.99),
                       .degree_u = (int)uniform(1, 3.99),
                       .degree_v = (int)uniform(1, 3.99)};
  s->count[0] = (size_t)uniform(5, 6.99);
  s->count[1] = (size_t)uniform(5, 6.99);
}

// The length of a line of points up to one of them, as a fraction of the whole, which includes the
// way back of a closed line. `across` selects the line.
static double part_of(const Subject *s, int k, size_t across, size_t upto) {
  const size_t n = k ? s->g.s : s->g.r;
  double part = 0, whole = 0;
  for (size_t i = 1; i < n + s->g.closed[k]; i++) {
    const size_t a = i - 1, b = i % n;
    const CagVec3 p = s->points[k ? across * s->g.s + a : a * s->g.s + across];
    const CagVec3 q = s->points[k ? across * s->g.s + b : b * s->g.s + across];
    const double step = s->g.spacing == CAG_GRID_UNIFORM ? 1 : cag_norm(cag_sub(q, p));
    if (i <= upto) part += step;
    whole += step;
  }
  return part / whole;
}

static void check_parameters(const Subject *s) {
  for (int k = 0; k < 2; k++) {
    const int degree = k ? s->g.degree_v : s->g.degree_u;
    const double wide = (double)s->count[k] - (s->g.closed[k] ? 0 : degree);
    for (size_t i = 0; i < s->g.r * s->g.s; i++) {
      const size_t along = k ? i % s->g.s : i / s->g.s, across = k ? i / s->g.s : i % s->g.s;
      const size_t lines = s->g.spacing == CAG_GRID_MEAN ? (k ? s->g.r : s->g.s) : 1;
      double t = 0;
      for (size_t l = 0; l < lines; l++)
        t += part_of(s, k, lines > 1 ? l : across, along) / (double)lines;
      t = t * wide + (s->g.closed[k] && degree % 2 == 0 ? 0.5 : 0);
      NEAR(k ? s->report.v[i] : s->report.u[i], t < wide || !s->g.closed[k] ? t : t - wide, 1e-12);
    }
  }
}

static void what_fits_leave_over_is_orthogonal_to_the_basis(void **state) {
  (void)state;
  seed = 31;
  static const CagGridSpacing SPACING[] = {CAG_GRID_CHORD, CAG_GRID_MEAN, CAG_GRID_UNIFORM};
  for (int round = 0; round < 48; round++) {
    Subject s;
    set_sizes(&s);
    s.g.spacing = SPACING[round % 3];
    s.g.closed[0] = round / 3 % 2;
    s.g.closed[1] = round / 6 % 2;
    s.g.corrections = round / 12 % 2 * 3;
    set_points(&s, 0.2);
    OK(cag_surface_fit(&s.g, s.count[0], s.count[1], &s.fit, &s.report, &err));
    check(&s, false);
    if (!s.g.corrections) check_parameters(&s);
    end(&s);
  }
}

static void held_coordinates_are_met_and_edges_fitted_to_the_border(void **state) {
  (void)state;
  seed = 32;
  int moved = 0;
  for (int round = 0; round < 36; round++) {
    Subject s[2];
    set_sizes(&s[0]);
    // The height of a tube.
    CagGridData *g = &s[0].g;
    g->closed[0] = round % 3 == 1;
    g->closed[1] = round % 3 == 2;
    g->hold = round % 3 ? CAG_GRID_HOLD_Z : round % 2 ? CAG_GRID_HOLD_X : CAG_GRID_HOLD_Y;
    g->spacing = round / 3 % 2 ? CAG_GRID_CHORD : CAG_GRID_UNIFORM;
    g->slack = 1e-10;
    set_points(&s[0], 0.02);
    s[1] = s[0];
    s[1].g.corrections = 1 + round / 12;
    for (int k = 0; k < 2; k++) {
      s[k].g.points = s[k].points;
      OK(cag_surface_fit(&s[k].g, s[0].count[0], s[0].count[1], &s[k].fit, &s[k].report, &err));
      check(&s[k], true);
    }
    moved += s[0].report.rounds > 0;
    // Each correction improves the fit.
    assert_int_equal(s[1].report.rounds, s[0].report.rounds + s[1].g.corrections);
    assert_true(s[1].report.rms < s[0].report.rms);
    for (int k = 0; k < 2; k++) end(&s[k]);
  }
  assert_true(moved > 18);
}

// Interpolates between the values at the stations 0, 1, ....
static double between(const double *x, size_t n, double at) {
  const size_t i = at < (double)(n - 1) ? (size_t)at : n - 2;
  return x[i] + (at - (double)i) * (x[i + 1] - x[i]);
}

// Planes of control points, computed from the means of the stations or given.
static void control_points_lie_in_planes(void **state) {
  (void)state;
  seed = 33;
  for (int round = 0; round < 48; round++) {
    Subject s;
    set_sizes(&s);
    const int k = round % 2;
    const double sign = round / 2 % 2 ? -1 : 1;
    s.g.closed[1 - k] = round / 4 % 2;
    s.g.lines = round / 8 % 2 ? CAG_GRID_PLANES_EITHER : k ? CAG_GRID_PLANES_V : CAG_GRID_PLANES_U;
    s.g.hold = s.g.closed[1 - k] ? CAG_GRID_HOLD_Z : k ? CAG_GRID_HOLD_Y : CAG_GRID_HOLD_X;
    s.g.spacing = CAG_GRID_UNIFORM;
    s.g.slack = 1e-12;
    s.g.corrections = round / 16;
    set_points(&s, 0.1);
    const size_t n = k ? s.g.s : s.g.r, lines = k ? s.g.r : s.g.s, count = s.count[k];
    const size_t p = (size_t)(k ? s.g.degree_v : s.g.degree_u);
    // The stations of the held coordinate; some of them are equal.
    double mean[MOST] = {0}, least = INFINITY, most = -INFINITY, given[MOST];
    for (size_t i = 0; i < n; i++) {
      const bool level = uniform(0, 1) < 0.5;
      for (size_t l = 0; l < lines; l++) {
        CagVec3 *q = &s.points[k ? l * s.g.s + i : i * s.g.s + l];
        double *c = s.g.hold == CAG_GRID_HOLD_X   ? &q->x
                    : s.g.hold == CAG_GRID_HOLD_Y ? &q->y
                                                  : &q->z;
        *c = sign * (1 + (double)(i * i) / 8 + (double)i + (level ? 0 : uniform(-0.3, 0.3)));
        mean[i] += *c / (double)lines;
        least = fmin(least, *c);
        most = fmax(most, *c);
      }
    }
    for (size_t i = 0; i < count; i++) {
      double t = 0;
      for (size_t j = i + 1; j <= i + p; j++)
        t += (j <= p ? 0 : j >= count ? (double)(count - p) : (double)(j - p)) / (double)p;
      given[i] = between(mean, n, t / (double)(count - p) * (double)(n - 1));
    }
    given[0] = sign > 0 ? fmin(given[0], least) : fmax(given[0], most);
    given[count - 1] = sign > 0 ? fmax(given[count - 1], most) : fmin(given[count - 1], least);
    if (round % 3 == 0) {
      for (size_t i = 0; i < count; i++) given[i] += sign * (0.01 * (double)(i * i) - 0.02);
      s.g.planes = given;
      s.g.plane_count = count;
    }
    OK(cag_surface_fit(&s.g, s.count[0], s.count[1], &s.fit, &s.report, &err));
    check(&s, false);
    assert_int_equal(s.report.planes_along, k);
    CagSurfaceNurbsView v;
    assert_true(cag_surface_nurbs_view(s.fit, &v));
    for (size_t i = 0; i < count; i++) {
      NEAR(s.report.planes[i], given[i], 1e-12);
      for (size_t j = 0; j < s.count[1 - k]; j++) {
        const size_t stride = s.count[1] + (s.g.closed[1] ? (size_t)s.g.degree_v : 0);
        const double *h = v.homogeneous + 4 * (k ? j * stride + i : i * stride + j);
        NEAR(h[(int)s.g.hold - 1], s.report.planes[i], 0);
      }
    }
    end(&s);
  }
}

static bool on_border(const Subject *s, size_t i, int direction) {
  const size_t line = direction ? i % s->g.s : i / s->g.s, n = direction ? s->g.s : s->g.r;
  return !s->g.closed[direction] && (line == 0 || line + 1 == n);
}

// Compares two fits, the second of which has one more correction. Every point has moved to the
// closest point of the first fit's tangent plane. On a border, it moves along the border; with
// planes, perpendicular to their coordinate.
static void check_step(const Subject *a, const Subject *b) {
  const CagSurface *s = a->fit;
  for (size_t i = 0; i < a->g.r * a->g.s; i++) {
    const double *from[2] = {a->report.u, a->report.v}, *to[2] = {b->report.u, b->report.v};
    const double low[2] = {s->u0, s->v0}, high[2] = {s->u1, s->v1};
    CagVec3 d[4];
    OK(cag_surface_eval(s, from[0][i], from[1][i], 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err));
    const CagVec3 by[2] = {d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)]};
    CagVec3 rest = cag_sub(a->points[i], d[0]);
    bool moves[2], stopped = false;
    for (int k = 0; k < 2; k++) {
      double step = to[k][i] - from[k][i];
      if (a->g.closed[k]) step -= (high[k] - low[k]) * round(step / (high[k] - low[k]));
      moves[k] = a->report.planes ? k != a->report.planes_along : true;
      moves[k] = moves[k] && !on_border(a, i, k);
      if (!moves[k]) NEAR(step, 0, 0);
      stopped =
          stopped || (!a->g.closed[k] && moves[k] && (to[k][i] == low[k] || to[k][i] == high[k]));
      rest = cag_madd(rest, -step, by[k]);
    }
    for (int k = 0; k < 2; k++)
      if (moves[k] && !stopped) NEAR(cag_dot(rest, by[k]), 0, 1e-11);
  }
}

static void corrections_are_steps_to_the_nearest_points(void **state) {
  (void)state;
  seed = 34;
  int taken = 0;
  for (int round = 0; round < 80; round++) {
    Subject s[2];
    set_sizes(&s[0]);
    s[0].g.closed[0] = round % 2;
    s[0].g.closed[1] = round / 2 % 2;
    s[0].g.corrections = round / 4 % 4;
    set_points(&s[0], 0.1);
    // In some cases, the stations stay in their planes.
    const bool held = round >= 48 && round % 4 < 3;
    if (held) {
      const int k = s[0].g.closed[0];
      s[0].g.lines = k ? CAG_GRID_PLANES_V : CAG_GRID_PLANES_U;
      s[0].g.hold = s[0].g.closed[0] || s[0].g.closed[1] ? CAG_GRID_HOLD_Z : CAG_GRID_HOLD_X;
      s[0].g.slack = 1e-12;
      for (size_t i = 0; i < s[0].g.r * s[0].g.s; i++) {
        const double x = (double)(k ? i % s[0].g.s : i / s[0].g.s);
        *(s[0].g.hold == CAG_GRID_HOLD_Z ? &s[0].points[i].z : &s[0].points[i].x) = 2 * x;
      }
    }
    s[1] = s[0];
    s[1].g.corrections++;
    for (int k = 0; k < 2; k++) {
      s[k].g.points = s[k].points;
      OK(cag_surface_fit(&s[k].g, s[0].count[0], s[0].count[1], &s[k].fit, &s[k].report, &err));
      check(&s[k], false);
    }
    if (held) assert_true(s[1].report.rounds > s[0].report.rounds);
    if (s[1].report.rounds > s[0].report.rounds) {
      assert_true(s[1].report.rms < s[0].report.rms);
      check_step(&s[0], &s[1]);
      taken++;
    }
    for (int k = 0; k < 2; k++) end(&s[k]);
  }
  assert_true(taken > 60);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_fits_leave_over_is_orthogonal_to_the_basis),
      cmocka_unit_test(held_coordinates_are_met_and_edges_fitted_to_the_border),
      cmocka_unit_test(control_points_lie_in_planes),
      cmocka_unit_test(corrections_are_steps_to_the_nearest_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
