// Seams of oblique patches compared with closed forms, and surfaces that are split, changed, and
// joined again.

#include "tests/geom/random.h"
#include "tests/geom/surface_support.h"

#include "geom/surface/nearest.h"
#include "geom/surface/reshape.h"

// --- Curvature across oblique edges ---

// z = a x^2 + 2 b x y + c y^2 + k (x - s y)^2
typedef struct Bowl {
  double a, b, c, k, s;
} Bowl;

static double second_of(const Bowl *f, double x, double y, double z, double w) {
  return f->a * x * z + f->b * (x * w + y * z) + f->c * y * w +
         f->k * (x - f->s * y) * (z - f->s * w);
}

// The patch over x = s y + t u + q v u, y = r v, whose corners are at u = `from`..`to`, v = -1..1,
// and whose parameter lines are oblique. The control points of a quadratic form are its polar
// values.
static CagSurface *patch_over(const Bowl *f, double from, double to, double r, double lean) {
  const double u[3][2] = {{from, from}, {from, to}, {to, to}},
               v[3][2] = {{-1, -1}, {-1, 1}, {1, 1}};
  CagVec3 net[9];
  CagSurface *s;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double x[2], y[2], z[2], w[2];
      for (int k = 0; k < 2; k++) {
        y[k] = r * v[j][k] + lean * u[i][k];
        x[k] = u[i][k] + f->s * y[k];
        // The sum over both pairings of the two polar arguments, for bilinear terms.
        w[k] = r * v[j][k] + lean * u[i][1 - k];
        z[k] = u[i][1 - k] + f->s * w[k];
      }
      net[3 * i + j] = cag_vec3(
          (x[0] + x[1]) / 2, (y[0] + y[1]) / 2,
          (second_of(f, x[0], y[0], x[1], y[1]) + second_of(f, z[0], w[0], z[1], w[1])) / 2);
    }
  MUST(cag_surface_bezier(net, NULL, 3, 3, &s, err));
  return s;
}

// The difference of the normal curvatures across the edge x = s y at its point y. The patches have
// a common tangent plane there, so it is the difference of the second fundamental forms.
static double bend_at(const Bowl *f, double k, double y) {
  const double x = f->s * y;
  const double px = 2 * (f->a * x + f->b * y), py = 2 * (f->b * x + f->c * y);
  const CagVec3 normal = cag_unit(cag_vec3(-px, -py, 1));
  const CagVec3 along = cag_vec3(f->s, 1, f->s * px + py);
  const CagVec3 w = cag_unit(cag_cross(normal, along));
  return 2 * k * pow(w.x - f->s * w.y, 2) * normal.z;
}

static void seams_of_oblique_patches_have_their_curvature(void **state) {
  (void)state;
  seed = 21;
  for (int round = 0; round < 40; round++) {
    Bowl f = {0};
    f.a = uniform(-0.4, 0.4);
    f.b = uniform(-0.4, 0.4);
    f.c = uniform(-0.4, 0.4);
    f.s = uniform(-1, 1);
    Bowl g = f;
    g.k = round % 4 ? uniform(-1, 1) : 0;
    const double r = uniform(0.5, 2), far = uniform(0.5, 2), wide = uniform(0.5, 2);
    // Lines of constant v are the same on both sides of the edge, or have a corner there.
    const double lean = uniform(-0.5, 0.5), other = round % 2 ? lean : uniform(-0.5, 0.5);
    CagSurface *a = patch_over(&f, -wide, 0, r, lean), *b = patch_over(&g, 0, far, r, other);
    CagSeam seam;
    double curvature = 0, first = 0;
    // The seam is sampled in even steps, including both ends.
    for (int i = 0; i <= 32; i++) {
      const double y = r * (2 * i / 32.0 - 1), x = f.s * y;
      const double px = 2 * (f.a * x + f.b * y), py = 2 * (f.b * x + f.c * y);
      const CagVec3 du = cag_vec3(wide * (1 + f.s * lean), wide * lean, 0);
      const CagVec3 dv = cag_vec3(far * (1 + f.s * other), far * other, 0);
      const CagVec3 d = cag_sub(du, dv);
      curvature = fmax(curvature, fabs(bend_at(&f, g.k, y)));
      first = fmax(first, hypot(hypot(d.x, d.y), px * d.x + py * d.y));
    }
    const int sides[2] = {1, 0};
    MUST(cag_surface_seam_on(a, b, sides, 1e-9, &seam, err));
    assert_near(seam.gap, 0, 1e-12, "gap");
    assert_near(seam.angle, 0, 1e-7, "angle");
    assert_near(seam.curvature, curvature, 1e-9, "curvature");
    assert_near(seam.first, first, 1e-9, "first derivatives");
    assert_true(seam.c0 && seam.g1 && !seam.reversed && !seam.c1);
    assert_int_equal(seam.g2, g.k == 0);
    cag_surface_release(a);
    cag_surface_release(b);
  }
}

// --- Joining split surfaces ---

enum { NU = 6, NV = 5 };

static CagSurface *random_surface(bool rational) {
  const double ku[] = {-2, -2, -2, -2, -0.7, 0.4, 1.3, 1.3, 1.3, 1.3};
  const double kv[] = {5, 5, 5, 6.1, 6.8, 8, 8, 8};
  CagVec3 p[NU * NV];
  double weights[NU * NV];
  CagSurface *s;
  for (int i = 0; i < NU; i++)
    for (int j = 0; j < NV; j++) {
      p[i * NV + j].x = 2 * i + uniform(-0.4, 0.4);
      p[i * NV + j].y = 2 * j + uniform(-0.4, 0.4);
      p[i * NV + j].z = uniform(-1, 1);
      weights[i * NV + j] = uniform(0.6, 1.7);
    }
  MUST(cag_surface_nurbs(p, rational ? weights : NULL, NU, NV, 3, 2, ku, kv, &s, err));
  return s;
}

// Multiplies all weights by a factor, which does not change the points.
static CagSurface *reweighted(const CagSurface *s, double factor) {
  CagSurfaceNurbsView v;
  CagSurface *out;
  assert_true(cag_surface_nurbs_view(s, &v));
  CagVec3 *p = malloc(v.nu * v.nv * sizeof *p);
  double *w = malloc(v.nu * v.nv * sizeof *w);
  for (size_t k = 0; k < v.nu * v.nv; k++) {
    const double *h = v.homogeneous + 4 * k;
    w[k] = factor * h[3];
    p[k] = cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]);
  }
  MUST(
      cag_surface_nurbs(p, w, v.nu, v.nv, v.degree_u, v.degree_v, v.knots_u, v.knots_v, &out, err));
  free(p);
  free(w);
  return out;
}

static CagSurface *replaced(CagSurface *s, CagSurface *by) {
  cag_surface_release(s);
  return by;
}

// Another representation of the same points.
static CagSurface *in_other_form(CagSurface *s, int how, bool rational) {
  CagSurface *t;
  if (how & 1) {
    MUST(cag_surface_transpose(s, &t, err));
    s = replaced(s, t);
  }
  if (how & 2) {
    MUST(cag_surface_flip(s, &t, err));
    s = replaced(s, t);
  }
  if (how & 4) {
    MUST(cag_surface_elevate(s, how & 8 ? 1 : 0, how & 8 ? 0 : 2, &t, err));
    s = replaced(s, t);
  }
  if (how & 8) {
    MUST(cag_surface_insert_knot(
        s, how & 1, how & 1 ? inside(s->v0, s->v1, 1) : inside(s->u0, s->u1, 1), 1, &t, err));
    s = replaced(s, t);
  }
  if (rational && how & 16) s = replaced(s, reweighted(s, 2.5));
  return s;
}

static double area_of(const CagSurface *s) {
  double area;
  CagVec3 c;
  MUST(cag_surface_area(s, &area, &c, err));
  return area;
}

static void surfaces_in_two_parts_are_joined_in_any_form(void **state) {
  (void)state;
  seed = 22;
  for (int round = 0; round < 64; round++) {
    const bool rational = round % 3 > 0, by_u = round % 2;
    CagSurface *s = random_surface(rational), *a, *b, *joined;
    const double cut = by_u ? uniform(-1.5, 1) : uniform(5.5, 7.5);
    MUST(cag_surface_nurbs_part(s, s->u0, by_u ? cut : s->u1, s->v0, by_u ? s->v1 : cut, &a, err));
    MUST(cag_surface_nurbs_part(s, by_u ? cut : s->u0, s->u1, by_u ? s->v0 : cut, s->v1, &b, err));
    const int one = (int)uniform(0, 32), two = (int)uniform(0, 32);
    a = in_other_form(a, one, rational);
    b = in_other_form(b, two, rational);
    MUST(cag_surface_join(a, b, 1e-9, &joined, err));
    assert_near(area_of(joined), area_of(s), 1e-7, "area");
    // u covers the first surface, and then the second.
    for (int half = 0; half < 2; half++)
      for (int k = 0; k < 6; k++) {
        const double range = joined->u1 - joined->u0;
        const double x = half ? 1 - uniform(0, 0.02) : uniform(0, 0.02);
        const double v = joined->v0 + uniform(0, 1) * (joined->v1 - joined->v0);
        CagSurfaceNearest near;
        const CagVec3 p = surface_at(joined, joined->u0 + x * range, v);
        MUST(cag_surface_closest(half ? b : a, p, &near, err));
        assert_near(near.distance, 0, 1e-9, "part");
      }
    for (int k = 0; k < 4; k++) {
      CagSurfaceNearest near;
      const double u = uniform(s->u0, s->u1);
      MUST(cag_surface_closest(joined, surface_at(s, u, uniform(s->v0, s->v1)), &near, err));
      assert_near(near.distance, 0, 1e-9, "whole");
    }
    cag_surface_release(joined);
    cag_surface_release(a);
    cag_surface_release(b);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(seams_of_oblique_patches_have_their_curvature),
      cmocka_unit_test(surfaces_in_two_parts_are_joined_in_any_form),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
