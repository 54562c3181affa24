// The subdivision planned for the parts of a face, before a mesh is made: compared with the
// smallest grids that closed forms allow, and with those of the same face with other parameters.

#include "geom/surface/function.h"
#include "geom/tessellate/trial.h"
#include "tests/geom/function_support.h"
#include "tests/geom/net_support.h"
#include "tests/geom/random.h"

typedef struct Planned {
  Tessellator t;
  Face face;
} Planned;

static void plan(Planned *p, const CagSurface *s, const CagTessellation *how) {
  *p = (Planned){.face = {.surface = s}};
  p->t = (Tessellator){.how = *how, .size = 1, .faces = &p->face, .face_count = 1};
  OK(cag_tess_plan_face(&p->t, 0, &err));
}

static void release(Planned *p) {
  free(p->t.leaves);
  free(p->face.breaks[0]);
  free(p->face.breaks[1]);
}

static CagTessellation limits(double tolerance, double angle, double max_edge) {
  return (CagTessellation){tolerance, angle, max_edge, 1000 * 1000, NULL, 0};
}

// --- Nets whose rows and columns can be exchanged or reversed ---

// Converts a leaf to the parameters of the net itself.
static Leaf turned(const Leaf *leaf, int turn) {
  Leaf out = *leaf;
  for (int d = 0; d < 2; d++) {
    const int from = turn & 1 ? 1 - d : d;
    const bool back = turn & (d == 0 ? 2 : 4);
    out.from[d] = back ? 1 - leaf->to[from] : leaf->from[from];
    out.to[d] = back ? 1 - leaf->from[from] : leaf->to[from];
    out.n[d] = leaf->n[from];
  }
  return out;
}

// Counts the leaves of p that are leaves of q as well, and those that also have the same counts.
static void count_alike(const Planned *p, int turn_p, const Planned *q, int turn_q,
                        size_t alike[2]) {
  alike[0] = alike[1] = 0;
  for (size_t k = 0; k < p->t.leaf_count; k++)
    for (size_t i = 0; i < q->t.leaf_count; i++) {
      const Leaf a = turned(&p->t.leaves[k], turn_p), b = turned(&q->t.leaves[i], turn_q);
      if (memcmp(a.from, b.from, sizeof a.from) || memcmp(a.to, b.to, sizeof a.to)) continue;
      alike[0]++;
      alike[1] += a.n[0] == b.n[0] && a.n[1] == b.n[1];
    }
}

// A cap whose first row is a single point, or a patch with one bump.
static Net cap_or_bump(int k) {
  Net net = {.n = {3, 4}};
  const double wide = uniform(0.3, 1.5);
  const double high = uniform(0.5, 3);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) {
      const double angle = (j - 1.5) * wide, radius = (i + uniform(0, 0.3)) * (i > 0) * 5;
      const double bump = i == 1 && j == 1 ? 6 * high : 0;
      net.p[i][j] = k % 3 ? cag_vec3(radius * cos(angle), radius * sin(angle), -high * i * i)
                          : cag_vec3(5 * i + uniform(-1, 1), 3 * j + uniform(-1, 1), bump);
    }
  return net;
}

// Reversing rows or columns does not change the subdivision. A count that is whole up to rounding
// may be rounded up in one of the cases.
static void plans_do_not_depend_on_where_parameters_begin(void **state) {
  (void)state;
  size_t all = 0, same = 0, parts = 0;
  seed = 61;
  for (int k = 0; k < 45; k++) {
    const Net net = cap_or_bump(k);
    const CagTessellation how = limits(exp(uniform(-7, -4)), 0, k % 5 ? 0 : 2);
    for (int swap = 0; swap < 2; swap++) {
      CagSurface *s = surface_of(&net, swap);
      Planned p, q;
      plan(&p, s, &how);
      for (int turn = 2; turn < 8; turn += 2) {
        CagSurface *r = surface_of(&net, turn + swap);
        size_t alike[2];
        plan(&q, r, &how);
        count_alike(&p, swap, &q, turn + swap, alike);
        assert_true(p.t.leaf_count == q.t.leaf_count && alike[0] == q.t.leaf_count);
        all += alike[0];
        same += alike[1];
        parts += q.t.leaf_count > 1;
        release(&q);
        cag_surface_release(r);
      }
      release(&p);
      cag_surface_release(s);
    }
  }
  assert_true(parts > 180 && same > 0.95 * (double)all);
}

// --- Smallest grids ---

// z = (a x^2 + b y^2) / 2 over [0, width] x [0, height].
typedef struct Parabolic {
  double size[2], bend[2];
} Parabolic;

static Leaf only_leaf(const Parabolic *f, int turn, const CagTessellation *how) {
  Net net = {.n = {3, 3}};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      net.p[i][k] = cag_vec3(f->size[0] * i / 2.0, f->size[1] * k / 2.0,
                             (i == 2) * f->bend[0] * f->size[0] * f->size[0] / 2 +
                                 (k == 2) * f->bend[1] * f->size[1] * f->size[1] / 2);
  CagSurface *s = surface_of(&net, turn);
  Planned p;
  plan(&p, s, how);
  assert_int_equal(p.t.leaf_count, 1);
  const Leaf leaf = turned(p.t.leaves, turn);
  release(&p);
  cag_surface_release(s);
  return leaf;
}

// The deviation of h x m triangles is the second form of an edge divided by 8.
static double parabolic_use(const Parabolic *f, const CagTessellation *how, double h, double m) {
  const double a = f->bend[0] * h * h, b = f->bend[1] * m * m;
  return fmax(fabs(a + b), fmax(fabs(a), fabs(b))) / 8 / (0.9 * how->tolerance);
}

// The slopes are small, so they are the rotation of the normals.
static double turn_use(const Parabolic *f, const CagTessellation *how, double h, double m) {
  return hypot(f->bend[0] * h, f->bend[1] * m) / how->angle;
}

// Edges of triangles may be as long as both sides together.
static double edge_use(const Parabolic *f, const CagTessellation *how, double h, double m) {
  (void)f;
  return (h + m) / how->max_edge;
}

typedef double Use(const Parabolic *f, const CagTessellation *how, double h, double m);

// The ratio of the planned grid to the smallest one that satisfies the limits.
static double ratio_to_smallest(const Parabolic *f, int turn, const CagTessellation *how,
                                Use *use) {
  enum { MOST = 400 };
  const Leaf leaf = only_leaf(f, turn, how);
  double fewest = INFINITY;
  assert_true(use(f, how, f->size[0] / leaf.n[0], f->size[1] / leaf.n[1]) <= 1);
  for (int x = 1; x < MOST; x++)
    for (int y = 1; y < MOST && x * y < fewest; y++)
      if (use(f, how, f->size[0] / x, f->size[1] / y) <= 1) fewest = x * y;
  return (double)leaf.n[0] * leaf.n[1] / fewest;
}

static Parabolic random_parabolic(double bend, int sign) {
  Parabolic f = {{uniform(3, 12), 0}, {0, 0}};
  f.size[1] = uniform(3, 12);
  f.bend[0] = bend * uniform(0.2, 1);
  f.bend[1] = bend * sign * uniform(0.2, 1);
  return f;
}

static void grids_are_little_larger_than_the_smallest(void **state) {
  (void)state;
  static const struct {
    double bend, tolerance, angle, max_edge, most, average;
    Use *use;
    int sign;
  } cases[] = {
      {0.02, 1e-3, 0, 0, 1.25, 1.065, parabolic_use, 1},
      {0.02, 1e-3, 0, 0, 2, 1.235, parabolic_use, -1},
      {0.01, 0.02, 1e-3, 0, 1.4, 1.13, turn_use, 1},
      {0.01, 0.02, 1e-3, 0, 1.4, 1.095, turn_use, -1},
      {1e-9, 1, 0, 0.3, 1.2, 1.115, edge_use, 1},
  };
  seed = 62;
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    double sum = 0;
    for (int k = 0; k < 64; k++) {
      const Parabolic f = random_parabolic(cases[c].bend, cases[c].sign);
      const double fine = exp(uniform(-2, 2));
      const CagTessellation how =
          limits(cases[c].tolerance * fine, cases[c].angle * fine, cases[c].max_edge * fine);
      const double share = ratio_to_smallest(&f, k % 8, &how, cases[c].use);
      if (!(share <= cases[c].most)) fail_msg("case %zu: %g times as many", c, share);
      sum += share / 64;
    }
    if (!(sum <= cases[c].average)) fail_msg("case %zu: %g times as many on average", c, sum);
  }
}

// The tolerance for the angle does not force edges shorter than a fifth of the distance tolerance.
static void angles_do_not_make_edges_shorter_than_a_fifth_of_the_tolerance(void **state) {
  (void)state;
  seed = 63;
  for (int k = 0; k < 32; k++) {
    const Parabolic f = random_parabolic(0.002, 1);
    const double tolerance = uniform(3, 8);
    const CagTessellation how = limits(tolerance, 1e-5, 0);
    const Leaf leaf = only_leaf(&f, k % 8, &how);
    for (int d = 0; d < 2; d++) NEAR((double)leaf.n[d], ceil(f.size[d] / (0.2 * tolerance)), 0);
  }
}

// --- Limits ---

// Several pieces with any knots: a bumpy sheet, or a twisted band with oblique parameter lines.
static CagSurface *pieces(bool twisted) {
  enum { U = 6, V = 5 };
  CagVec3 p[U * V];
  CagSurface *s;
  const double a = uniform(1.2, 2), b = uniform(2.2, 3), c = uniform(-4.9, -4),
               lean = uniform(-4, 4);
  const double knots_u[] = {1, 1, 1, 1, a, b, 4, 4, 4, 4},
               knots_v[] = {-5, -5, -5, c, -3, -2, -2, -2};
  for (int i = 0; i < U; i++)
    for (int k = 0; k < V; k++) {
      const double x = uniform(-0.6, 0.6);
      const double y = uniform(-0.6, 0.6);
      const double z = uniform(-0.6, 0.6);
      p[i * V + k] =
          twisted ? cag_vec3(3 * i + lean * k + x / 9, 2 * k, 0.4 * (i - 2) * (k - 1) + z / 9)
                  : cag_vec3(3 * i + x, 2 * k + y, z);
    }
  OK(cag_surface_nurbs(p, NULL, U, V, 3, 2, knots_u, knots_v, &s, &err));
  return s;
}

// Two planar sides and a round edge between them, which is sharper at one end.
static CagSurface *round_edge(int k) {
  const double sharp = exp(uniform(0, 2.5)), wide = uniform(2, 6), lean = uniform(-1, 1);
  const CagVec3 profile[3] = {{0, 0, 0}, {wide, 0, 0}, {wide, 0, 4}};
  CagVec3 p[6];
  double weights[6];
  CagSurface *s;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 2; j++) {
      const int at = k % 2 ? 3 * j + i : 2 * i + j;
      p[at] = cag_add(profile[i], cag_vec3(lean * j, (k % 4 < 2 ? 3 : -3) * j, 0));
      weights[at] = i == 1 ? sharp * (1 + j) : 1;
    }
  OK(cag_surface_bezier(p, weights, k % 2 ? 2 : 3, k % 2 ? 3 : 2, &s, &err));
  return s;
}

// Finds the largest rotation of the normal along, and the largest length of, the edges of a leaf's
// cells and their shorter diagonals. Short edges, and diagonals of cells with a short side, may
// have any rotation.
static void edges_of(const CagSurface *s, const Leaf *leaf, double free_of_turn, double *turn,
                     double *length) {
  enum { MOST = 300 };
  static CagVec3 p[MOST + 1][MOST + 1], q[MOST + 1][MOST + 1];
  assert_true(leaf->n[0] <= MOST && leaf->n[1] <= MOST);
  for (size_t i = 0; i <= leaf->n[0]; i++)
    for (size_t k = 0; k <= leaf->n[1]; k++) {
      // Slightly inside the leaf, the normals are its own.
      const double x = fmin(fmax((double)i / leaf->n[0], 1e-6), 1 - 1e-6),
                   y = fmin(fmax((double)k / leaf->n[1], 1e-6), 1 - 1e-6),
                   u = leaf->from[0] + (leaf->to[0] - leaf->from[0]) * x,
                   v = leaf->from[1] + (leaf->to[1] - leaf->from[1]) * y;
      OK(cag_surface_point(s, u, v, &p[i][k], &err));
      OK(cag_surface_normal(s, u, v, &q[i][k], &err));
    }
  for (size_t i = 0; i < leaf->n[0]; i++)
    for (size_t k = 0; k < leaf->n[1]; k++) {
      const bool ac = cag_norm(cag_sub(p[i + 1][k + 1], p[i][k])) <=
                      cag_norm(cag_sub(p[i + 1][k], p[i][k + 1]));
      const size_t ends[5][4] = {{i, k, i + 1, k},
                                 {i, k + 1, i + 1, k + 1},
                                 {i, k, i, k + 1},
                                 {i + 1, k, i + 1, k + 1},
                                 {i, ac ? k : k + 1, i + 1, ac ? k + 1 : k}};
      double shortest = INFINITY;
      for (int e = 0; e < 5; e++) {
        const size_t *x = ends[e];
        const CagVec3 a = q[x[0]][x[1]], b = q[x[2]][x[3]];
        const double l = cag_norm(cag_sub(p[x[0]][x[1]], p[x[2]][x[3]]));
        *length = fmax(*length, l);
        shortest = fmin(shortest, l);
        if ((e < 4 ? l : shortest) > free_of_turn)
          *turn = fmax(*turn, 2 * asin(fmin(1, cag_norm(cag_sub(a, b)) / 2)));
      }
    }
}

static void check_leaves(const Planned *p, const CagSurface *s, const CagTessellation *how) {
  double area = 0;
  for (size_t k = 0; k < p->t.leaf_count; k++) {
    const Leaf *leaf = &p->t.leaves[k];
    TessTrial t = {.surface = s};
    const double sine[2] = {0, 0};
    double off, turn = 0, length = 0;
    for (int d = 0; d < 2; d++) {
      t.from[d] = leaf->from[d];
      t.to[d] = leaf->to[d];
      t.n[d] = leaf->n[d];
      for (size_t i = 0; i < p->face.break_count[d]; i++)
        assert_true(p->face.breaks[d][i] <= leaf->from[d] || p->face.breaks[d][i] >= leaf->to[d]);
    }
    OK(cag_tess_try_distance(&t, sine, &off, &err));
    assert_true(off <= 0.9 * how->tolerance);
    area += (leaf->to[0] - leaf->from[0]) * (leaf->to[1] - leaf->from[1]);
    if (!(how->angle > 0 || how->max_edge > 0)) continue;
    edges_of(s, leaf, 0.2 * how->tolerance, &turn, &length);
    if (how->angle > 0) assert_true(turn <= 0.951 * how->angle);
    if (how->max_edge > 0) assert_true(length <= how->max_edge);
  }
  NEAR(area, (s->u1 - s->u0) * (s->v1 - s->v0), 1e-9);
}

// Returns the number of cells.
static double check_plan(const CagSurface *s, const CagTessellation *how) {
  Planned p;
  plan(&p, s, how);
  check_leaves(&p, s, how);
  const double n = p.t.quads;
  release(&p);
  return n;
}

// All leaves satisfy the limits, with a bounded number of cells.
static void leaves_keep_limits_with_few_quadrilaterals(void **state) {
  (void)state;
  static const struct {
    double tolerance, angle, max_edge, most;
  } cases[] = {
      {0.004, 0, 0, 25100}, {0.3, 0.07, 0, 26700}, {0.3, 0, 1.5, 17100}, {0.03, 0.3, 2.5, 7560}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    const CagTessellation how = limits(cases[c].tolerance, cases[c].angle, cases[c].max_edge);
    double sum = 0;
    seed = 64;
    for (int k = 0; k < 36; k++) {
      CagSurface *s = k % 3 == 2 ? round_edge(k / 3) : k % 4 ? pieces(k % 2) : NULL;
      if (!s) {
        const Net net = cap_or_bump(k % 3 + 1);
        s = surface_of(&net, k % 8);
      }
      sum += check_plan(s, &how);
      cag_surface_release(s);
    }
    if (!(sum <= cases[c].most)) fail_msg("case %zu: %g quadrilaterals", c, sum);
  }
}

// Waves on a plane that decay along u or v.
typedef struct Ripple {
  double size[2], wave[2], high, slide, fade[2]; // slide: waves along x that do not decay
} Ripple;

static CagStatus ripple_eval(void *context, double u, double v, int n, CagVec3 *out, CagError *e) {
  const Ripple *r = context;
  const double at = r->wave[0] * u + r->wave[1] * v, fade = 1 - r->fade[0] * u - r->fade[1] * v;
  const double z[2] = {r->high * fade * sin(at), r->high * fade * cos(at)};
  (void)e;
  for (int k = 0; k < (n + 1) * (n + 2) / 2; k++) out[k] = cag_vec3(0, 0, 0);
  out[0] = cag_vec3(r->size[0] * u + r->slide * sin(at), r->size[1] * v, z[0]);
  if (n == 0) return CAG_OK;
  const double slid[2] = {r->slide * cos(at) * r->wave[0], r->slide * cos(at) * r->wave[1]};
  out[cag_partial(n, 1, 0)] =
      cag_vec3(r->size[0] + slid[0], 0, z[1] * r->wave[0] - r->high * r->fade[0] * sin(at));
  out[cag_partial(n, 0, 1)] =
      cag_vec3(slid[1], r->size[1], z[1] * r->wave[1] - r->high * r->fade[1] * sin(at));
  return CAG_OK;
}

static CagStatus ripple_row(void *context, double u, const double *vs, size_t nv, int n,
                            CagVec3 *out, CagError *e) {
  return row_by_points(ripple_eval, context, u, vs, nv, n, out, e);
}

static void release_nothing(void *context) { (void)context; }

// Only the limits for normals and edge lengths detect waves below the tolerance.
static void ripples_within_the_tolerance_keep_limits_of_edges(void **state) {
  (void)state;
  double sum = 0;
  seed = 65;
  for (int k = 0; k < 60; k++) {
    Ripple r = {.size = {uniform(6, 12), uniform(6, 12)}, .high = uniform(0.02, 0.1)};
    CagTessellation how = limits(1, uniform(0.1, 0.3), 0);
    const double slow = uniform(0, 8);
    if (k % 4 == 3) {
      r.slide = uniform(0.02, 0.08);
      how = limits(1, 0, uniform(0.3, 1));
    }
    CagSurface *s;
    r.wave[k % 2] = uniform(10, 60);
    r.wave[1 - k % 2] = k % 3 ? 0 : slow;
    r.fade[k / 2 % 2] = uniform(0, 0.9);
    const CagSurfaceFunction f = {
        .eval = ripple_eval, .eval_row = ripple_row, .release = release_nothing, .context = &r};
    OK(cag_surface_function(&f, 0, 1, false, 0, 1, false, &s, &err));
    sum += check_plan(s, &how);
    cag_surface_release(s);
  }
  assert_true(sum <= 28450);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plans_do_not_depend_on_where_parameters_begin),
      cmocka_unit_test(grids_are_little_larger_than_the_smallest),
      cmocka_unit_test(leaves_keep_limits_with_few_quadrilaterals),
      cmocka_unit_test(ripples_within_the_tolerance_keep_limits_of_edges),
      cmocka_unit_test(angles_do_not_make_edges_shorter_than_a_fifth_of_the_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
