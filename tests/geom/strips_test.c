// Strips of twisted faces: their number agrees with closed forms, and does not depend on the
// domains, order, and directions of the parameters.

#include <complex.h>

#include "geom/surface/function.h"
#include "geom/tessellate/tessellation.h"
#include "tests/geom/function_support.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// A wavy section that rotates and climbs: radius R(x) = radius + wave cos(turns x + phase), angle
// around + skew x + twist y, height lean x + climb y, for x and y in 0..1, which are affine in the
// parameters.
typedef struct Twist {
  double radius, wave, waves, phase, skew, twist, lean, climb;
  bool swap, back;         // x is the second parameter; y is reversed
  double from[2], size[2]; // domains of the parameters x and y
} Twist;

static CagStatus twist_eval(void *context, double u, double v, int n, CagVec3 *out, CagError *e) {
  (void)e;
  const Twist *t = context;
  const double of[2] = {t->swap ? v : u, t->swap ? u : v};
  const double x = (of[0] - t->from[0]) / t->size[0], part = (of[1] - t->from[1]) / t->size[1];
  const double y = t->back ? 1 - part : part, a = t->waves * x + t->phase;
  const double r[3] = {t->radius + t->wave * cos(a), -t->wave * t->waves * sin(a),
                       -t->wave * t->waves * t->waves * cos(a)};
  const double complex turn = cexp(I * (t->skew * x + t->twist * y));
  const double complex along_x[3] = {r[0] * turn, (r[1] + I * t->skew * r[0]) * turn,
                                     (r[2] + 2 * I * t->skew * r[1] - t->skew * t->skew * r[0]) *
                                         turn};
  const double complex along_y[3] = {1, I * t->twist, -t->twist * t->twist};
  const double height[3][3] = {{t->lean * x + t->climb * y, t->climb}, {t->lean}};
  const double per[2] = {1 / t->size[0], (t->back ? -1 : 1) / t->size[1]};
  const double scale[2][3] = {{1, per[0], per[0] * per[0]}, {1, per[1], per[1] * per[1]}};
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      const double complex w = along_x[i] * along_y[j];
      out[cag_partial(n, t->swap ? j : i, t->swap ? i : j)] =
          cag_scaled(cag_vec3(creal(w), cimag(w), height[i][j]), scale[0][i] * scale[1][j]);
    }
  return CAG_OK;
}

static CagStatus twist_row(void *context, double u, const double *vs, size_t nv, int n,
                           CagVec3 *out, CagError *e) {
  return row_by_points(twist_eval, context, u, vs, nv, n, out, e);
}

static CagSurface *twisted(Twist *t) {
  const CagSurfaceFunction f = {
      .eval = twist_eval, .eval_row = twist_row, .release = NULL, .context = t};
  const double to[2] = {t->from[0] + t->size[0], t->from[1] + t->size[1]};
  CagSurface *s;
  OK(cag_surface_function(&f, t->from[t->swap], to[t->swap], false, t->from[!t->swap], to[!t->swap],
                          false, &s, &err));
  return s;
}

typedef struct Planned {
  Tessellator t;
  Face face;
  bool strips;
  double steps; // along the entire face
} Planned;

static void plan(Planned *p, Twist *t, const CagTessellation *how) {
  CagSurface *s = twisted(t);
  *p = (Planned){.face = {.surface = s}};
  p->t = (Tessellator){.how = *how, .size = 1, .faces = &p->face, .face_count = 1};
  OK(cag_tess_plan_face(&p->t, 0, &err));
  OK(cag_tess_plan_strips(&p->t, 0, &err));
  const Leaf *first = &p->t.leaves[0];
  p->strips = tess_is_strip(first);
  const int along = first->slants.along;
  p->steps = (first->to[along] - first->from[along]) / first->slants.step;
  cag_surface_release(s);
}

static void release(Planned *p) {
  free(p->t.leaves);
  free(p->face.breaks[0]);
  free(p->face.breaks[1]);
}

static CagTessellation limits(double tolerance, double angle, double max_edge) {
  return (CagTessellation){tolerance, angle, max_edge, 1000 * 1000, NULL, 0};
}

// --- Cylinders with oblique parameter lines ---

// The rulings are slanted. Chords of n steps deviate by r (1 - cos(turn / 2 n)).
static void rulings_of_cylinders_are_slants(void **state) {
  (void)state;
  seed = 81;
  size_t edged = 0;
  for (int k = 0; k < 60; k++) {
    const double r = uniform(0.5, 5), tolerance = r * pow(10, uniform(-4, -2.5));
    Twist t = {.radius = r, .size = {1, 1}, .swap = k % 2, .back = k / 2 % 2};
    t.twist = uniform(3, 9);
    t.skew = uniform(0.2, 0.6) * t.twist * (k / 4 % 2 ? 1 : -1);
    t.lean = r * uniform(1, 3);
    t.climb = uniform(-1, 1) * (k % 3 == 0);
    // With climb, x and z change along y, too, and the rulings are horizontal.
    const double ruling = hypot(0, t.lean - t.climb * t.skew / t.twist);
    Planned p;
    CagTessellation how = limits(tolerance, 0, 0);
    plan(&p, &t, &how);
    assert_true(p.strips);
    assert_int_equal(p.t.leaf_count, 1);
    const Leaf *l = &p.t.leaves[0];
    assert_int_equal(l->slants.along, !t.swap);
    NEAR(l->slants.slope, -t.skew / t.twist * (t.back ? -1 : 1), 1e-6);
    const double use = r * (1 - cos(t.twist / 2 / p.steps)) / tolerance;
    if (!(use >= 0.72 && use <= 0.9)) fail_msg("%g of the tolerance", use);
    release(&p);
    // A limit of the angle requires more steps.
    const double angle = t.twist / p.steps / uniform(1.5, 4);
    how = limits(tolerance, angle, 0);
    plan(&p, &t, &how);
    assert_true(p.strips && p.t.leaf_count == 1);
    const double turned = t.twist / p.steps / angle;
    if (!(turned >= 0.85 && turned <= 1)) fail_msg("%g of the angle", turned);
    release(&p);
    // Edges across the strips are shorter than their limit if there are several strips.
    const double edge = ruling / uniform(1.5, 6);
    how = limits(tolerance, 0, edge);
    plan(&p, &t, &how);
    if (p.strips && p.t.leaves[0].slants.along == !t.swap) {
      edged++;
      const double chord = hypot(t.twist * r, t.climb) / p.steps;
      const double most = ruling / p.t.leaf_count;
      assert_true(chord <= edge && most <= edge * (1 + 1e-6));
      // Samples at multiples of 1/256 of the cell determine the width of strips.
      const double least = sqrt(fmax(0, edge * edge - chord * chord)) - chord;
      if (!((double)p.t.leaf_count <= ceil(ruling / (least - ruling / 128)) + 1))
        fail_msg("%zu strips of %g, edges of %g and %g", p.t.leaf_count, ruling, edge, chord);
    }
    release(&p);
  }
  assert_true(edged > 20);
}

// --- The same face with other parameters ---
// Rounding may decide whether strips are worthwhile.

static Twist random_twist(void) {
  Twist t = {.radius = uniform(2, 6), .size = {1, 1}};
  t.wave = t.radius * uniform(0.02, 0.3);
  t.waves = uniform(1, 6);
  t.phase = uniform(0, 6);
  t.skew = uniform(1, 6);
  t.twist = uniform(2, 6) * (uniform(0, 1) < 0.5 ? 1 : -1);
  t.lean = uniform(-2, 2);
  t.climb = uniform(10, 40);
  return t;
}

static void strips_do_not_depend_on_the_parameters(void **state) {
  (void)state;
  seed = 82;
  size_t striped = 0, several = 0, all = 0, same = 0;
  for (int k = 0; k < 9; k++) {
    Twist t = random_twist();
    const double tolerance = t.radius * pow(10, uniform(-3.4, -2.8));
    const double angle = k % 3 == 1 ? uniform(0.05, 0.2) : 0;
    const CagTessellation how =
        limits(tolerance, angle, k % 3 == 2 ? t.radius * uniform(0.3, 1) : 0);
    Planned base;
    plan(&base, &t, &how);
    striped += base.strips;
    several += base.strips && base.t.leaf_count > 1;
    for (int v = 1; v < 8; v += 1 + k % 3) {
      Twist other = t;
      Planned p;
      other.swap = v & 1;
      other.back = v & 2;
      for (int d = 0; d < 2; d++) {
        if (!(v & 4)) continue;
        other.from[d] = uniform(-3, 3);
        other.size[d] = pow(10, uniform(-2, 2));
      }
      plan(&p, &other, &how);
      all++;
      if (base.strips == p.strips && base.t.leaf_count == p.t.leaf_count) same++;
      else p.strips = false;
      for (size_t i = 0; i < p.t.leaf_count && p.strips; i++) {
        const Leaf *a = &base.t.leaves[i], *b = &p.t.leaves[i];
        assert_int_equal(b->slants.along, other.swap ? 1 - a->slants.along : a->slants.along);
        NEAR(p.steps, base.steps, 1e-6 * base.steps);
      }
      release(&p);
    }
    release(&base);
  }
  assert_true(striped > 6 && several > 6 && same > 0.95 * (double)all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rulings_of_cylinders_are_slants),
      cmocka_unit_test(strips_do_not_depend_on_the_parameters),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
