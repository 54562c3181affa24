// Trial grids on a surface: their measured values are compared with the definitions on every cell.

#include "geom/tessellate/trial.h"

#include "geom/mesh/distance.h"
#include "geom/surface/function.h"
#include "tests/geom/function_support.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { NET = 4 };

// A bumpy patch of about 10 x 6. `pole` is the side that is a single point, if any.
static CagSurface *patch(double bumps, int pole) {
  CagVec3 p[NET * NET];
  CagSurface *s;
  for (int i = 0; i < NET; i++)
    for (int k = 0; k < NET; k++) {
      const double x = uniform(-1, 1);
      const double y = uniform(-1, 1);
      const double z = uniform(-1, 1);
      const bool tip = (pole == SIDE_U0 && i == 0) || (pole == SIDE_U1 && i == NET - 1) ||
                       (pole == SIDE_V0 && k == 0) || (pole == SIDE_V1 && k == NET - 1);
      p[i * NET + k] = tip ? cag_vec3(5, 3, 2) : cag_vec3(3.3 * i + x, 2 * k + y, bumps * z);
    }
  OK(cag_surface_bezier(p, NULL, NET, NET, &s, &err));
  return s;
}

// A trial of n cells on a part of a patch; every other one is sheared.
static TessTrial trial_on(const CagSurface *s, double nu, double nv, int k) {
  TessTrial t = {.surface = s, .n = {nu, nv}, .along = k / 2 % 2};
  for (int d = 0; d < 2; d++) {
    t.from[d] = uniform(0.2, 0.4);
    t.to[d] = uniform(0.6, 0.8);
  }
  const double slope = uniform(-0.5, 0.5);
  if (k % 2) t.slope = slope;
  return t;
}

// The parameters after x cells along u and y along v.
static void parameters(const TessTrial *t, double x, double y, double at[2]) {
  const double share[2] = {x / t->n[0], y / t->n[1]};
  for (int d = 0; d < 2; d++) at[d] = t->from[d] * (1 - share[d]) + t->to[d] * share[d];
  at[t->along] += t->slope * (at[1 - t->along] - t->from[1 - t->along]);
}

static CagVec3 point(const TessTrial *t, double x, double y) {
  double at[2];
  CagVec3 p;
  parameters(t, x, y, at);
  OK(cag_surface_point(t->surface, at[0], at[1], &p, &err));
  return p;
}

// --- Distances ---

// Computes the corners a, b, c, d around the cell at (i, k). Returns true if the shorter diagonal
// is that from a to c.
static bool corners(const TessTrial *t, int i, int k, CagVec3 c[4]) {
  c[0] = point(t, i, k);
  c[1] = point(t, i + 1, k);
  c[2] = point(t, i + 1, k + 1);
  c[3] = point(t, i, k + 1);
  return cag_norm(cag_sub(c[2], c[0])) <= cag_norm(cag_sub(c[3], c[1]));
}

// The distance to the two triangles of a cell divided by one diagonal.
static double to_triangles(CagVec3 p, const CagVec3 c[4], bool cut_ac) {
  return fmin(cag_distance_to_triangle(p, c[0], c[1], c[cut_ac ? 2 : 3]),
              cag_distance_to_triangle(p, c[cut_ac ? 0 : 1], c[2], c[3]));
}

// The largest distance at the center and at the centers of the two halves, in the parameters.
static double inner_distance(const TessTrial *t, int i, int k, const CagVec3 c[4], bool cut_ac) {
  const double third = 1.0 / 3, x = cut_ac ? 2 * third : third;
  return fmax(to_triangles(point(t, i + 0.5, k + 0.5), c, cut_ac),
              fmax(to_triangles(point(t, i + x, k + third), c, cut_ac),
                   to_triangles(point(t, i + 1 - x, k + 2 * third), c, cut_ac)));
}

// The distance to the half plane beyond the edge a b, where a neighbor continues at some angle.
// Only the sine of this angle counts beyond the edge.
static double edge_distance(CagVec3 p, CagVec3 a, CagVec3 b, CagVec3 c, double sine) {
  const double area = cag_norm(cag_cross(cag_sub(b, a), cag_sub(c, a)));
  if (area < 1e-9) return cag_distance_to_triangle(p, a, b, c);
  const CagVec3 x = cag_unit(cag_sub(b, a)), ac = cag_sub(c, a), ap = cag_sub(p, a);
  const CagVec3 y = cag_unit(cag_sub(ac, cag_scaled(x, cag_dot(ac, x))));
  const double off = fabs(cag_dot(ap, cag_cross(x, y))), beyond = fmax(0, -cag_dot(ap, y));
  return fmin(off + beyond * sine, hypot(off, beyond));
}

static double quad_distance(const TessTrial *t, int i, int k, const double sine[2]) {
  CagVec3 c[4];
  const bool ac = corners(t, i, k, c),
             rim = i == 0 || k == 0 || i == t->n[0] - 1 || k == t->n[1] - 1;
  double d = inner_distance(t, i, k, c, ac);
  if (rim) d = fmax(d, inner_distance(t, i, k, c, !ac));
  for (int e = 0; e < 4; e++) {
    const CagVec3 a = c[e], b = c[(e + 1) % 4],
                  opposite = c[ac == (e % 2 == 0) ? (e + 2) % 4 : (e + 3) % 4];
    const CagVec3 p =
        point(t, i + (double[4]){0.5, 1, 0.5, 0}[e], k + (double[4]){0, 0.5, 1, 0.5}[e]);
    d = fmax(d, edge_distance(p, a, b, opposite, sine[e % 2 == 0]));
  }
  return d;
}

static double grid_distance(const TessTrial *t, const double sine[2]) {
  double d = 0;
  for (int i = 0; i < t->n[0]; i++)
    for (int k = 0; k < t->n[1]; k++) d = fmax(d, quad_distance(t, i, k, sine));
  return d;
}

// So few cells that all are tested: 8 x 8, or as many in fewer rows.
static void distances_of_small_grids_are_those_of_all_quadrilaterals(void **state) {
  (void)state;
  static const int count[][2] = {{1, 1},  {2, 3}, {8, 8},  {1, 64},
                                 {21, 3}, {7, 9}, {2, 32}, {16, 4}};
  seed = 51;
  for (int k = 0; k < 96; k++) {
    CagSurface *s = patch(uniform(0, 2), -1);
    const TessTrial t = trial_on(s, count[k % 8][0], count[k % 8][1], k / 8);
    const double u = uniform(0, 1);
    const double v = uniform(0, 1);
    const double sine[2] = {u * u, v * v};
    double found;
    OK(cag_tess_try_distance(&t, sine, &found, &err));
    NEAR(found, grid_distance(&t, sine), 1e-12);
    cag_surface_release(s);
  }
}

static void distances_are_measured_up_to_poles(void **state) {
  (void)state;
  const double sine[2] = {0.1, 0.2};
  seed = 52;
  for (int k = 0; k < 24; k++) {
    const int pole = k % 4;
    CagSurface *s = patch(uniform(0, 2), pole);
    TessTrial t = trial_on(s, 1 + k % 3, 1 + k % 5, 0);
    double found;
    if (pole % 2 == 0) t.from[pole / 2] = 0;
    else t.to[pole / 2] = 1;
    OK(cag_tess_try_distance(&t, sine, &found, &err));
    NEAR(found, grid_distance(&t, sine), 1e-9);
    cag_surface_release(s);
  }
}

static double middle_distance(const TessTrial *t) {
  double d = 0;
  CagVec3 c[4];
  for (int i = 0; i < t->n[0]; i++)
    for (int k = 0; k < t->n[1]; k++) {
      const bool ac = corners(t, i, k, c);
      d = fmax(d, to_triangles(point(t, i + 0.5, k + 0.5), c, ac));
    }
  return d;
}

// With at most 12 cells in both directions, the first pass is sufficient.
static void distances_of_middles_are_those_of_all_quadrilaterals(void **state) {
  (void)state;
  static const int count[][2] = {{13, 1}, {16, 16}, {1, 256}, {51, 5}, {12, 12}, {2, 13}, {12, 1}};
  seed = 53;
  for (int k = 0; k < 42; k++) {
    CagSurface *s = patch(uniform(0, 2), -1);
    const TessTrial t = trial_on(s, count[k % 7][0], count[k % 7][1], k / 7);
    double found;
    OK(cag_tess_try_middles(&t, &found, &err));
    NEAR(found, t.n[0] <= 12 && t.n[1] <= 12 ? 0 : middle_distance(&t), 1e-12);
    cag_surface_release(s);
  }
}

// In large grids, only some cells are tested, distributed evenly from first to last. On a smooth
// surface, they come close to the worst one, and include it if it is at a corner.
static void distances_of_large_grids_are_nearly_those_of_all(void **state) {
  (void)state;
  static const int count[][2] = {{9, 12}, {20, 30}, {70, 2}, {3, 40}};
  const double sine[2] = {0.1, 0.1};
  seed = 54;
  for (int k = 0; k < 24; k++) {
    CagSurface *s = patch(uniform(1, 2), -1);
    TessTrial t = trial_on(s, count[k % 4][0], count[k % 4][1], k / 4);
    double found, all = grid_distance(&t, sine);
    OK(cag_tess_try_distance(&t, sine, &found, &err));
    assert_true(found <= all * (1 + 1e-9) && found >= 0.85 * all);
    all = middle_distance(&t);
    OK(cag_tess_try_middles(&t, &found, &err));
    if (t.n[0] > 12 || t.n[1] > 12) assert_true(found <= all * (1 + 1e-9) && found >= 0.97 * all);
    cag_surface_release(s);
  }
}

// --- Edges ---

typedef struct Limits {
  double angle, free, longest;
} Limits;

static CagVec3 normal(const TessTrial *t, double x, double y) {
  double at[2];
  CagVec3 n;
  parameters(t, x, y, at);
  OK(cag_surface_normal(t->surface, at[0], at[1], &n, &err));
  return n;
}

// How much an edge from (i, k) to (j, l) exceeds its limits. The normal rotates by more than a
// radian only abruptly.
static double excess(const TessTrial *t, const Limits *most, const int from[2], const int to[2]) {
  const double length = cag_norm(cag_sub(point(t, to[0], to[1]), point(t, from[0], from[1])));
  const CagVec3 a = normal(t, from[0], from[1]), b = normal(t, to[0], to[1]);
  const double turn = 2 * asin(fmin(1, cag_norm(cag_sub(a, b)) / 2));
  const bool turns = most->angle > 0 && length > most->free && turn <= 1;
  return fmax(most->longest > 0 ? length / most->longest : 0, turns ? turn / most->angle : 0);
}

static TessExcess grid_excess(const TessTrial *t, const Limits *most) {
  TessExcess out = {{0, 0}, 0};
  for (int i = 0; i < t->n[0]; i++)
    for (int k = 0; k < t->n[1]; k++) {
      const int c[4][2] = {{i, k}, {i + 1, k}, {i + 1, k + 1}, {i, k + 1}};
      CagVec3 at[4];
      const bool ac = corners(t, i, k, at), sheared = t->slope != 0;
      for (int e = 0; e < 4; e++)
        out.along[e % 2] = fmax(out.along[e % 2], excess(t, most, c[e], c[(e + 1) % 4]));
      Limits across = *most;
      if (fmin(cag_norm(cag_sub(at[1], at[0])), cag_norm(cag_sub(at[3], at[0]))) <= most->free)
        across.angle = 0;
      if (sheared || ac) out.diagonal = fmax(out.diagonal, excess(t, &across, c[0], c[2]));
      if (sheared || !ac) out.diagonal = fmax(out.diagonal, excess(t, &across, c[1], c[3]));
    }
  return out;
}

// Corners of the grid are evaluated slightly inside it.
static void excess_of_small_grids_is_that_of_all_edges(void **state) {
  (void)state;
  static const int count[][2] = {{1, 1}, {3, 2}, {24, 2}, {1, 24}, {9, 7}, {5, 12}};
  seed = 55;
  for (int k = 0; k < 120; k++) {
    CagSurface *s = patch(uniform(0, 3), -1);
    const TessTrial t = trial_on(s, count[k % 6][0], count[k % 6][1], k / 6);
    Limits most = {.angle = k % 5 ? 0.1 : 0, .longest = k % 3 ? 0 : uniform(0.1, 1)};
    const double size = cag_norm(cag_sub(point(&t, 1, 0), point(&t, 0, 0)));
    if (k % 4 > 1) most.free = size * uniform(0.7, 1.6);
    TessExcess found;
    OK(cag_tess_try_edges(&t, most.angle, most.free, most.longest, &found, &err));
    const TessExcess all = grid_excess(&t, &most);
    for (int d = 0; d < 2; d++) NEAR(found.along[d], all.along[d], 2e-4 * (1 + all.along[d]));
    NEAR(found.diagonal, all.diagonal, 2e-4 * (1 + all.diagonal));
    cag_surface_release(s);
  }
}

static void excess_of_large_grids_is_nearly_that_of_all(void **state) {
  (void)state;
  static const int count[][2] = {{25, 3}, {50, 60}, {2, 49}, {30, 30}};
  const Limits most = {.angle = 0.1, .longest = 0.5};
  seed = 56;
  for (int k = 0; k < 12; k++) {
    CagSurface *s = patch(uniform(0, 2), -1);
    const TessTrial t = trial_on(s, count[k % 4][0], count[k % 4][1], k / 4);
    TessExcess found;
    OK(cag_tess_try_edges(&t, most.angle, most.free, most.longest, &found, &err));
    const TessExcess all = grid_excess(&t, &most);
    for (int d = 0; d < 2; d++)
      assert_true(found.along[d] <= all.along[d] * 1.0002 && found.along[d] >= 0.98 * all.along[d]);
    assert_true(found.diagonal <= all.diagonal * 1.0002 && found.diagonal >= 0.98 * all.diagonal);
    cag_surface_release(s);
  }
}

// On either side of a crease at u = 1, only the normals of that side count.
static void creases_between_leaves_do_not_turn_edges(void **state) {
  (void)state;
  static const double knots_u[] = {0, 0, 1, 2, 2}, knots_v[] = {0, 0, 1, 1};
  const CagVec3 net[] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0.4}, {1, 1, 0.4}, {2, 0, 0}, {2, 1, 0}};
  CagSurface *s;
  OK(cag_surface_nurbs(net, NULL, 3, 2, 1, 1, knots_u, knots_v, &s, &err));
  for (int k = 0; k < 2; k++) {
    const TessTrial t = {.surface = s, .from = {k, 0}, .to = {k + 1, 1}, .n = {2, 2}};
    TessExcess found;
    OK(cag_tess_try_edges(&t, 0.1, 0, 0, &found, &err));
    NEAR(found.along[0] + found.along[1] + found.diagonal, 0, 1e-6);
  }
  cag_surface_release(s);
}

// --- Scattered points ---

// A surface z = f(u, v) over a plane in which the parameter lines may be curved and oblique.
typedef struct Sheet {
  double aslant, bent;    // x = u + aslant v
  double bend[2];         // z = (bend . (u, v))^2 / 2
  double lo[2], hi[2], z; // a raised box
} Sheet;

static CagVec3 sheet_at(const Sheet *s, double u, double v) {
  const double *b = s->bend, along = b[0] * u + b[1] * v;
  const double wave = s->bent * sin(2 * M_PI * u) * sin(2 * M_PI * v);
  const bool out = u > s->lo[0] && u < s->hi[0] && v > s->lo[1] && v < s->hi[1];
  return cag_vec3(u + s->aslant * v + wave, v + wave, along * along / 2 + (out ? s->z : 0));
}

static CagStatus sheet_eval(void *context, double u, double v, int n, CagVec3 *out, CagError *e) {
  (void)e;
  for (int k = 0; k < (n + 1) * (n + 2) / 2; k++) out[k] = cag_vec3(0, 0, 0);
  out[0] = sheet_at(context, u, v);
  if (n == 0) return CAG_OK;
  out[cag_partial(n, 1, 0)] = cag_vec3(1, 0, 0);
  out[cag_partial(n, 0, 1)] = cag_vec3(0, 1, 0);
  return CAG_OK;
}

static CagStatus sheet_row(void *context, double u, const double *vs, size_t nv, int n,
                           CagVec3 *out, CagError *e) {
  return row_by_points(sheet_eval, context, u, vs, nv, n, out, e);
}

static void release_nothing(void *context) { (void)context; }

static CagSurface *surface_of(Sheet *sheet, double u0, double u1, double v0, double v1) {
  CagSurface *s;
  const CagSurfaceFunction f = {
      .eval = sheet_eval, .eval_row = sheet_row, .release = release_nothing, .context = sheet};
  OK(cag_surface_function(&f, u0, u1, false, v0, v1, false, &s, &err));
  return s;
}

static bool is_missed(const TessTrial *t, double tolerance) {
  bool missed;
  OK(cag_tess_try_scattered(t, tolerance, &missed, &err));
  return missed;
}

// Places a box of this size around a point.
static void put_box(Sheet *sheet, double u, double v, double wide, double high) {
  const double at[2] = {u, v}, size[2] = {wide, high};
  for (int d = 0; d < 2; d++) {
    sheet->lo[d] = at[d] - size[d] / 2;
    sheet->hi[d] = at[d] + size[d] / 2;
  }
}

// Of 128 rows of 32 points, two are in a square of 1/51 of the side, separated by the golden
// section. Bands along u require the largest distance of all points in v, golden^9 / 32, in leaves
// of any width. Bands along v are hit by a row. After an earlier miss, there are four times as many
// rows, separated by a quarter of the golden section: six of them are in a square of 1/85 of the
// side.
static void what_is_wide_enough_is_met(void **state) {
  (void)state;
  Sheet sheet = {.z = 0.5};
  CagSurface *s = surface_of(&sheet, 3, 7, -2, 6);
  seed = 57;
  for (int k = 0; k < 1200; k++) {
    TessTrial t = {.surface = s, .from = {3, -2}, .to = {7, 6}, .n = {3, 5}};
    const double u = uniform(3.05, 6.95);
    const double v = uniform(-1.9, 5.9);
    t.suspect = k % 6 > 3;
    if (k % 6 == 0) put_box(&sheet, u, v, 4.0 / 51, 8.0 / 51);
    if (k % 6 < 3 && k % 6 > 0) put_box(&sheet, u, v, 100, 8.0 / 2400);
    if (k % 6 == 2) t.from[1] = v - 0.05, t.to[1] = v + 0.05;
    if (k % 6 == 3) put_box(&sheet, u, v, 4.0 / 127, 100);
    if (k % 6 == 4) put_box(&sheet, u, v, 4.0 / 511, 100);
    if (k % 6 == 5) put_box(&sheet, u, v, 4.0 / 85, 8.0 / 85);
    assert_true(is_missed(&t, 0.1));
  }
  cag_surface_release(s);
}

// Leaves examine only their own part, whether or not they are sheared.
static void boxes_beside_a_leaf_are_not_met(void **state) {
  (void)state;
  Sheet sheet = {.z = 0.5};
  CagSurface *s = surface_of(&sheet, 0, 1, 0, 1);
  int met = 0;
  seed = 58;
  for (int k = 0; k < 1000; k++) {
    TessTrial t = {.surface = s, .from = {0.25, 0.375}, .to = {0.625, 0.75}, .n = {2, 3}};
    t.along = k / 2 % 2;
    if (k % 2) t.slope = uniform(-0.6, 0.6);
    const double at[2] = {uniform(0.05, 0.95), uniform(0.05, 0.95)}, size = 1 / 50.0;
    double place[2] = {at[0], at[1]};
    put_box(&sheet, at[0], at[1], size, size);
    place[t.along] -= t.slope * (place[1 - t.along] - t.from[1 - t.along]);
    double inside = INFINITY;
    for (int d = 0; d < 2; d++)
      inside = fmin(inside, fmin(place[d] - t.from[d], t.to[d] - place[d]));
    if (fabs(inside) < size) continue;
    assert_true(is_missed(&t, 0.1) == (inside > 0));
    met += inside > 0;
  }
  assert_true(met > 50);
  cag_surface_release(s);
}

// Leaves with more cells than points are not examined.
static void fine_leaves_are_not_looked_at(void **state) {
  (void)state;
  Sheet sheet = {.z = 100};
  CagSurface *s = surface_of(&sheet, 1, 5, 3, 5);
  static const double counts[][2] = {{64, 64},  {128, 128}, {32, 32},
                                     {16, 256}, {1, 4096},  {4096, 1}};
  put_box(&sheet, 3.47, 4.48, 0.2, 0.3);
  for (int k = 0; k < 6; k++) {
    TessTrial t = {.surface = s, .from = {1, 3}, .to = {5, 5}, .n = {counts[k][0], counts[k][1]}};
    t.suspect = k == 1;
    if (k == 2) t.from[0] = 3, t.from[1] = 4;
    assert_true(is_missed(&t, 1e-3));
    t.n[0] *= k == 5 ? 4097.0 / 4096 : 1;
    t.n[1] *= k == 5 ? 1 : 1 + 1 / counts[k][1];
    assert_false(is_missed(&t, 1e-3));
  }
  for (int d = 0; d < 2; d++) {
    TessTrial t = {.surface = s, .from = {1, 3}, .to = {5, 5}, .n = {1, 1}, .suspect = true};
    t.n[d] = 4 * 4096;
    assert_true(is_missed(&t, 1e-3));
  }
  cag_surface_release(s);
}

// In a planar grid with curved lines, points are above cells next to their own.
static void points_lie_over_neighbors_as_well(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    Sheet sheet = {.bent = k % 2 ? 0.04 : -0.04};
    CagSurface *s = surface_of(&sheet, 0, 1, 0, 1);
    const TessTrial t = {.surface = s, .to = {1, 1}, .n = {k < 2 ? 8 : 7, k < 2 ? 9 : 8}};
    assert_false(is_missed(&t, 1e-12));
    cag_surface_release(s);
  }
}

// Over cells of size h, a surface with z'' = q along a chord deviates by q h^2 / 8. If it is
// straight along the shorter diagonals, or along the slants of sheared cells, that is the total.
static void what_is_off_by_more_than_the_tolerance_is_missed(void **state) {
  (void)state;
  for (int k = 0; k < 8; k++) {
    const bool sheared = k >= 4;
    const double q = 0.01, sign = k % 2 ? 1 : -1, h = sheared ? 0.5 / 8 : 1.0 / 8;
    const int along = k / 2 % 2;
    Sheet sheet = {.aslant = sheared ? 0 : 0.3 * sign};
    sheet.bend[0] = sqrt(q);
    sheet.bend[1] = sign * sqrt(q);
    CagSurface *s = surface_of(&sheet, 0, 1, 0, 1);
    TessTrial t = {.surface = s, .to = {1, 1}, .n = {8, 8}};
    if (sheared) {
      t.along = along;
      t.slope = -sign;
      t.from[1 - along] = 0.125;
      t.to[1 - along] = 0.25;
      t.n[1 - along] = 1;
      t.from[along] = 0.25;
      t.to[along] = 0.75;
    }
    assert_false(is_missed(&t, 1.02 * q * h * h / 8));
    assert_true(is_missed(&t, 0.9 * q * h * h / 8));
    cag_surface_release(s);
  }
}

static void formulas_are_known_by_points(void **state) {
  (void)state;
  Sheet sheet = {0};
  CagSurface *f = surface_of(&sheet, 0, 1, 0, 1), *p = patch(1, -1), *s;
  const CagTransform map = cag_shear(0, 2, 0, 0, 0, 0);
  assert_true(cag_tess_is_known_by_points(f));
  assert_false(cag_tess_is_known_by_points(p));
  OK(cag_surface_transform(f, &map, &s, &err));
  assert_true(cag_tess_is_known_by_points(s));
  cag_surface_release(s);
  cag_surface_release(f);
  cag_surface_release(p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(distances_of_small_grids_are_those_of_all_quadrilaterals),
      cmocka_unit_test(distances_are_measured_up_to_poles),
      cmocka_unit_test(distances_of_middles_are_those_of_all_quadrilaterals),
      cmocka_unit_test(distances_of_large_grids_are_nearly_those_of_all),
      cmocka_unit_test(excess_of_small_grids_is_that_of_all_edges),
      cmocka_unit_test(excess_of_large_grids_is_nearly_that_of_all),
      cmocka_unit_test(creases_between_leaves_do_not_turn_edges),
      cmocka_unit_test(what_is_wide_enough_is_met),
      cmocka_unit_test(boxes_beside_a_leaf_are_not_met),
      cmocka_unit_test(fine_leaves_are_not_looked_at),
      cmocka_unit_test(points_lie_over_neighbors_as_well),
      cmocka_unit_test(what_is_off_by_more_than_the_tolerance_is_missed),
      cmocka_unit_test(formulas_are_known_by_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
