// Trimmed graphs of random polynomials: integrals, bounds and other forms.

#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"
#include "tests/geom/polynomial_support.h"
#include "tests/geom/trimmed_support.h"

typedef struct Disks {
  double at[3][3]; // the outer one first, the holes within it
  int n;
} Disks;

static Disks random_disks(void) {
  const double x = uniform(0.4, 0.6), y = uniform(0.4, 0.6), r = uniform(0.3, 0.39);
  return (Disks){{{x, y, r}, {x - 0.4 * r, y + 0.2 * r, 0.3 * r}, {x + 0.5 * r, y, 0.25 * r}}, 3};
}

static Polynomial random_polynomial(double size) {
  Polynomial f = {{{0}}};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) f.c[i][j] = uniform(-size, size);
  return f;
}

// How far a place is inside.
static double inside_by(const Disks *d, double x, double y) {
  double in = d->at[0][2] - hypot(x - d->at[0][0], y - d->at[0][1]);
  for (int i = 1; i < d->n; i++)
    in = fmin(in, hypot(x - d->at[i][0], y - d->at[i][1]) - d->at[i][2]);
  return in;
}

static CagSurface *graph_within(const Polynomial *f, const Disks *d, const CagTransform *move,
                                bool knots) {
  const double per[2] = {1, 1};
  CagSurface *s = graph(f, per, move), *more, *out;
  // Knots that change nothing, where integrals are cut.
  for (int k = 0; knots && k < 4; k++) {
    MUST(cag_surface_insert_knot(s, k % 2, 0.37 + 0.1 * k, 4, &more, err));
    cag_surface_release(s);
    s = more;
  }
  CagRegion *r = disks(d->at, (size_t)d->n);
  MUST(cag_surface_trimmed(s, r, &out, err));
  cag_surface_release(s);
  cag_region_release(r);
  return out;
}

static CagTransform random_move(void) {
  CagTransform turn, move;
  MUST(cag_rotate(direction(), uniform(0, 6), direction(), &turn, err));
  move = cag_translate(direction());
  return cag_transform_multiply(&turn, &move);
}

// Area, moments, and the fluxes whose sums are volumes.
enum { SUMS = 14 };
static void add_place(const Polynomial *f, const CagTransform *move, double x, double y, double w,
                      double sum[SUMS]) {
  const double h = 1e-3; // exact for these degrees, by the fourth order
  const double fx = (8 * (value(f, x + h, y) - value(f, x - h, y)) -
                     (value(f, x + 2 * h, y) - value(f, x - 2 * h, y))) /
                    (12 * h),
               fy = (8 * (value(f, x, y + h) - value(f, x, y - h)) -
                     (value(f, x, y + 2 * h) - value(f, x, y - 2 * h))) /
                    (12 * h);
  const CagVec3 p = cag_transform_point(move, cag_vec3(x, y, value(f, x, y)));
  const CagVec3 n = cag_transform_vector(move, cag_vec3(-fx, -fy, 1));
  const double area = cag_norm(n), of[3] = {p.x, p.y, p.z}, by[3] = {n.x, n.y, n.z};
  sum[10] += w * area;
  sum[0] += w * cag_dot(p, n) / 3;
  for (int k = 0; k < 3; k++) {
    sum[11 + k] += w * area * of[k];
    sum[1 + k] += w * of[k] * of[k] * by[k] / 2;
    sum[4 + k] += w * of[k] * of[k] * of[k] * by[k] / 3;
    sum[7 + k] += w * of[k] * of[k] * of[(k + 1) % 3] * by[k] / 2;
  }
}

// By polar coordinates about each disk's center: the trapezoidal rule around, Simpson's outward.
static void sum_over(const Polynomial *f, const CagTransform *move, const Disks *d,
                     double sum[SUMS]) {
  enum { AROUND = 48, OUTWARD = 80 };
  for (int k = 0; k < SUMS; k++) sum[k] = 0;
  for (int disk = 0; disk < d->n; disk++)
    for (int i = 0; i <= OUTWARD; i++) {
      const double r = d->at[disk][2] * i / OUTWARD;
      const double simpson = (i == 0 || i == OUTWARD ? 1 : i % 2 ? 4 : 2) / 3.0;
      const double w = simpson * d->at[disk][2] / OUTWARD * r * 2 * M_PI / AROUND;
      for (int j = 0; j < AROUND; j++) {
        const double a = 2 * M_PI * j / AROUND;
        add_place(f, move, d->at[disk][0] + r * cos(a), d->at[disk][1] + r * sin(a), disk ? -w : w,
                  sum);
      }
    }
}

static void integrals_are_those_over_the_disks(void **state) {
  (void)state;
  seed = 95;
  for (int round = 0; round < 6; round++) {
    const Polynomial f = random_polynomial(0.5);
    const Disks d = random_disks();
    const CagTransform move = random_move();
    CagSurface *s = graph_within(&f, &d, &move, round % 2);
    double expected[SUMS], terms[10] = {0}, area;
    CagVec3 centroid;
    sum_over(&f, &move, &d, expected);
    MUST(cag_surface_volume_terms(s, terms, err));
    MUST(cag_surface_area(s, &area, &centroid, err));
    for (int k = 0; k < 10; k++) assert_near(terms[k], expected[k], 1e-7, "flux");
    assert_near(area, expected[10], 1e-7, "area");
    assert_near(centroid.x, expected[11] / expected[10], 1e-7, "centroid");
    assert_near(centroid.y, expected[12] / expected[10], 1e-7, "centroid");
    assert_near(centroid.z, expected[13] / expected[10], 1e-7, "centroid");
    // They add up, and turn their sign with the surface.
    CagSurface *flipped, *exchanged;
    MUST(cag_surface_flip(s, &flipped, err));
    MUST(cag_surface_volume_terms(flipped, terms, err));
    for (int k = 0; k < 10; k++) assert_near(terms[k], 0, 1e-8, "flux of both sides");
    MUST(cag_surface_transpose(s, &exchanged, err));
    MUST(cag_surface_volume_terms(exchanged, terms, err));
    for (int k = 0; k < 10; k++) assert_near(terms[k], -expected[k], 1e-7, "flux, exchanged");
    cag_surface_release(flipped);
    cag_surface_release(exchanged);
    cag_surface_release(s);
  }
}

// The highest place by a walk from the highest sample; how far inside that is.
static double highest(const Polynomial *f, const CagTransform *move, const Disks *d, CagVec3 way,
                      double *inside) {
  enum { N = 60 };
  double best = -INFINITY, x = 0, y = 0;
  for (int i = 0; i <= N * N; i++) {
    const double a = (double)(i % N) / N, b = (double)(i / N) / N;
    const double h = cag_dot(way, cag_transform_point(move, cag_vec3(a, b, value(f, a, b))));
    if (inside_by(d, a, b) < 0 || h <= best) continue;
    best = h;
    x = a;
    y = b;
  }
  for (double step = 0.5 / N; step > 1e-12;) {
    bool better = false;
    for (int k = 0; k < 8; k++) {
      const double a = x + step * cos(k * M_PI / 4), b = y + step * sin(k * M_PI / 4);
      const double h = cag_dot(way, cag_transform_point(move, cag_vec3(a, b, value(f, a, b))));
      if (inside_by(d, a, b) < 0 || h <= best) continue;
      best = h;
      x = a;
      y = b;
      better = true;
    }
    if (!better) step /= 2;
  }
  *inside = inside_by(d, x, y);
  return best;
}

static void bounds_are_reached_within_the_disks(void **state) {
  (void)state;
  seed = 96;
  int tops = 0;
  for (int round = 0; round < 12; round++) {
    const Disks d = random_disks();
    // A hill or a hollow over some place, steep enough for a summit.
    Polynomial f = random_polynomial(0.1);
    const Polynomial hill = circle(uniform(0.3, 0.7), uniform(0.3, 0.7), 0);
    f = sum(&f, &hill, round % 2 ? 3 : -3);
    const CagTransform move = random_move();
    CagSurface *s = graph_within(&f, &d, &move, round % 4 == 0);
    CagBounds box;
    MUST(cag_surface_bounds(s, &box, err));
    const double found[6] = {-box.min.x, box.max.x, -box.min.y, box.max.y, -box.min.z, box.max.z};
    for (int e = 0; e < 6; e++) {
      const double side = e % 2 ? 1 : -1;
      const CagVec3 way = {e / 2 == 0 ? side : 0, e / 2 == 1 ? side : 0, e / 2 == 2 ? side : 0};
      double inside;
      const double top = highest(&f, &move, &d, way, &inside);
      assert_true(found[e] >= top - 1e-11 && found[e] <= top + (inside > 1e-3 ? 1e-10 : 2e-2));
      tops += inside > 1e-3;
    }
    cag_surface_release(s);
  }
  assert_true(tops > 2);
}

static void outlines_stay_in_the_domain(void **state) {
  (void)state;
  const Polynomial f = {{{0}}};
  const double per[2] = {1, 1};
  const CagTransform stay = cag_transform_identity();
  CagSurface *all = graph(&f, per, &stay), *s;
  static const struct {
    double at[3];
    const char *says; // NULL: it serves
  } CASES[] = {
      {{0.5, 0.5, 0.5}, NULL},
      {{0.5, 0.5, 0.5 + 1e-10}, NULL},
      {{0.25, 0.5, 0.5}, "domain 0..1 of u, found -0.25..0.75 "},
      {{0.75, 0.5, 0.5}, "domain 0..1 of u, found 0.25..1.25 "},
      {{0.5, 0.25, 0.5}, "domain 0..1 of v, found -0.25..0.75 "},
      {{0.5, 0.75, 0.5}, "domain 0..1 of v, found 0.25..1.25 "},
      {{0.5 - 1e-7, 0.5, 0.5}, "of u"},
      {{0.5 + 1e-7, 0.5, 0.5}, "of u"},
      {{0.5, 0.5 - 1e-7, 0.5}, "of v"},
      {{0.5, 0.5 + 1e-7, 0.5}, "of v"},
  };
  for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
    CagRegion *r = disks(&CASES[i].at, 1);
    CagError e;
    const CagStatus status = cag_surface_trimmed(all, r, &s, &e);
    assert_int_equal(status, CASES[i].says ? CAG_E_DOMAIN : CAG_OK);
    if (status) {
      assert_string_equal(cag_error_info(e.id)->reason, "curve-outside");
      if (!strstr(e.message, CASES[i].says)) fail_msg("%s", e.message);
    } else {
      assert_true(s->u0 == 0 && s->u1 == 1 && s->v0 == 0 && s->v1 == 1);
      char text[80];
      s->kind->describe(s, text, sizeof text);
      assert_string_equal(text, "bezier within 1 closed curve");
      CagSurface *again;
      MUST_FAIL(cag_surface_trimmed(s, r, &again, err), "already-trimmed");
      cag_surface_release(s);
    }
    cag_region_release(r);
  }
  cag_surface_release(all);
}

// Other forms have the same points, at places that are moved as the parameters are.
static void other_forms_have_the_same_points(void **state) {
  (void)state;
  seed = 97;
  for (int round = 0; round < 8; round++) {
    const Polynomial f = random_polynomial(0.5);
    const Disks d = random_disks();
    const CagTransform move = random_move();
    CagSurface *s = graph_within(&f, &d, &move, false), *flipped, *exchanged, *raised, *seen;
    CagTransform look = cag_shear(0.3, -0.2, 0.5, 0.1, 0, 0.4);
    look.m[3][0] = 0.02;
    look.m[3][1] = round % 2 ? 0.03 : 0;
    MUST(cag_surface_flip(s, &flipped, err));
    MUST(cag_surface_transpose(s, &exchanged, err));
    MUST(cag_surface_offset(s, 0.1, &raised, err));
    MUST(cag_surface_transform(s, &look, &seen, err));
    const CagSurface *forms[4] = {flipped, exchanged, raised, seen};
    for (int i = 0; i < 60; i++) {
      const double x = uniform(0, 1), y = uniform(0, 1);
      const bool in = inside_by(&d, x, y) > 0;
      for (int k = 0; k < 4; k++) {
        const CagRegion *r;
        const CagSurface *inner;
        bool is;
        assert_true(cag_surface_trimmed_view(forms[k], &inner, &r));
        const double u = k == 1 ? y : x, v = k == 0 ? 1 - y : k == 1 ? x : y;
        MUST(cag_region_contains(r, cag_vec3(u, v, 0), &is, err));
        assert_int_equal(is, in);
        CagVec3 p = cag_transform_point(&move, cag_vec3(x, y, value(&f, x, y)));
        if (k == 2) {
          CagVec3 n;
          assert_true(cag_surface_trimmed_view(s, &inner, NULL));
          MUST(cag_surface_normal(inner, x, y, &n, err));
          assert_true(cag_surface_trimmed_view(raised, &inner, NULL));
          p = cag_madd(p, 0.1, n);
        }
        if (k == 3) p = cag_transform_point(&look, p);
        assert_point(surface_at(inner, u, v), p, 1e-12, "form");
      }
    }
    CagSurface *torus, *part, *none;
    CagRegion *r = disks((const double[][3]){{1.5, 2, 1.2}}, 1);
    MUST(cag_surface_torus(3, 1, &torus, err));
    MUST(cag_surface_trimmed(torus, r, &part, err));
    MUST_FAIL(cag_surface_transform(part, &look, &none, err), "no-exact-form");
    cag_region_release(r);
    cag_surface_release(torus);
    cag_surface_release(part);
    cag_surface_release(flipped);
    cag_surface_release(exchanged);
    cag_surface_release(raised);
    cag_surface_release(seen);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integrals_are_those_over_the_disks),
      cmocka_unit_test(bounds_are_reached_within_the_disks),
      cmocka_unit_test(outlines_stay_in_the_domain),
      cmocka_unit_test(other_forms_have_the_same_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
