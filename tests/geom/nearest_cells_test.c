// Cells of surfaces for the search of the nearest point: their bounds hold for all of their points,
// the points that they report are correct, and the bounds become tight as the cells shrink, so that
// few cells suffice.

#include "geom/surface/nearest_cells.h"

#include "geom/surface/function.h"
#include "geom/surface/nearest.h"
#include "geom/surface/reshape.h"
#include "tests/geom/function_support.h"
#include "tests/geom/nearest_support.h"

static CagVec3 cell_point(const CagDistanceCells *c, double u, double v) {
  return surface_at(c->exact ? c->exact : c->s, u, v);
}

static void check_cell(const CagDistanceCells *c, const CagDistanceCell *cell, const char *what) {
  const double rounding = 1e-12 * c->size * c->size;
  const bool tube = c->swept.tube;
  // Random points, the middle, and the corners, where tangents are lowest.
  for (int k = 0; k < 17; k++) {
    const int corner = k - 13;
    const double x = k < 12 ? between(0, 1) : k == 12 ? 0.5 : corner & 1;
    const double y = k < 12 ? between(0, 1) : k == 12 ? 0.5 : corner >> 1;
    const double u = cell->u[0] + x * (cell->u[1] - cell->u[0]);
    const double v = cell->v[0] + y * (cell->v[1] - cell->v[0]);
    const CagVec3 r = cag_sub(cell_point(c, u, v), c->p);
    if (!(cell->bound <= cag_dot(r, r) + rounding))
      fail_msg("%s: the bound %.17g is above %.17g at %g, %g", what, cell->bound, cag_dot(r, r), u,
               v);
  }
  // The recorded properties of the cell are correct.
  const CagVec3 q = cell_point(c, cell->least_at[0], cell->least_at[1]);
  assert_point(q, cell->least_point, 1e-11 * (1 + c->size), what);
  const CagVec3 r = cag_sub(q, c->p);
  assert_near(cell->least, cag_dot(r, r), 1e-11 * (1 + c->size * c->size), what);
  assert_true(cell->bound <= cell->least + rounding);
  for (int k = 0; k < 2; k++) {
    const double *range = k ? cell->v : cell->u, slack = 1e-14 * (fabs(range[0]) + fabs(range[1]));
    const double low = range[0] - slack, high = range[1] + slack;
    assert_true(cell->least_at[k] >= low && cell->least_at[k] <= high);
    assert_true(cell->low_at[k] >= low && cell->low_at[k] <= high);
  }
  assert_true(!tube || cell->across);
}

// Divides the lowest cell until its bound differs from the squared distance by less than a hundred
// millionth of the squared size. Returns the number of cells. Bounds must not decrease.
static int cells_needed(const CagSurface *s, CagVec3 p, bool hinted, const char *what) {
  CagDistanceCells c;
  CagDistanceCell cell;
  CagSurfaceNearest nearest;
  bool found;
  int count = 0;
  MUST(cag_surface_closest(s, p, &nearest, err));
  MUST(cag_distance_cells_make(&c, s, p, false, err));
  double before = -INFINITY;
  while (count < 4000) {
    MUST(cag_distance_cells_next(&c, INFINITY, &cell, &found, err));
    assert_true(found && !cell.raw);
    check_cell(&c, &cell, what);
    // The halves of swept cells keep the bound of the whole.
    if (c.swept.section) assert_true(cell.bound >= before - 1e-12 * c.size * c.size);
    before = fmax(before, cell.bound);
    count++;
    const double distance = nearest.distance * nearest.distance;
    if (cell.bound >= distance - 1e-8 * c.size * c.size) break;
    // The search reports its best point as soon as it is known.
    if (hinted && c.same && !c.exact) {
      c.hint[0] = nearest.u;
      c.hint[1] = nearest.v;
    }
    MUST(cag_distance_cells_halve(&c, &cell, INFINITY, err));
  }
  cag_distance_cells_free(&c);
  return count;
}

// The initial bound of a patch is the distance of the box of its control points.
static void check_boxes(const CagDistanceCells *c) {
  CagSurfaceNurbsView v;
  if (!c->exact) return;
  assert_true(cag_surface_nurbs_view(c->exact, &v));
  for (size_t k = 0; k < c->count; k++) {
    const CagDistanceCell *cell = &c->items[k];
    const size_t i = cell->block / v.nv, j = cell->block % v.nv;
    double low[3], high[3], distance = 0;
    assert_true(cell->raw && cell->whole);
    assert_true(cell->u[0] == v.knots_u[i] && cell->u[1] == v.knots_u[i + 1]);
    assert_true(cell->v[0] == v.knots_v[j] && cell->v[1] == v.knots_v[j + 1]);
    for (int d = 0; d < 3; d++) {
      low[d] = INFINITY;
      high[d] = -INFINITY;
      for (size_t a = i - (size_t)v.degree_u; a <= i; a++)
        for (size_t b = j - (size_t)v.degree_v; b <= j; b++) {
          const double *h = v.homogeneous + 4 * (a * v.nv + b);
          low[d] = fmin(low[d], h[d] / h[3]);
          high[d] = fmax(high[d], h[d] / h[3]);
        }
      const double p = d == 0 ? c->p.x : d == 1 ? c->p.y : c->p.z;
      const double out = p < low[d] ? low[d] - p : p > high[d] ? p - high[d] : 0;
      distance += out * out;
    }
    assert_near(cell->bound, distance, 1e-13, "box");
  }
}

// The cells together cover the whole surface; halves are kept or dropped depending on their bound.
static void check_cover(const CagSurface *s, CagVec3 p, const char *what) {
  CagDistanceCells c;
  CagDistanceCell cell;
  bool found = true;
  MUST(cag_distance_cells_make(&c, s, p, false, err));
  const CagSurface *of = c.exact ? c.exact : s;
  check_boxes(&c);
  // Only surfaces of revolution have exact forms with another parametrization.
  assert_int_equal(c.same, strcmp(what, "torus") && strcmp(what, "sphere"));
  double whole = (of->u1 - of->u0) * (of->v1 - of->v0), area = 0, last = -INFINITY;
  for (int i = 0; i < 20; i++) {
    MUST(cag_distance_cells_next(&c, INFINITY, &cell, &found, err));
    if (found) MUST(cag_distance_cells_halve(&c, &cell, INFINITY, err));
  }
  for (;;) {
    MUST(cag_distance_cells_next(&c, INFINITY, &cell, &found, err));
    if (!found) break;
    // A patch that was bounded by its box may have a lower bound of its own.
    if (!cell.whole) {
      assert_true(cell.bound >= last);
      last = cell.bound;
    }
    area += (cell.u[1] - cell.u[0]) * (cell.v[1] - cell.v[0]);
    cag_distance_cells_drop(&c, &cell);
  }
  assert_near(area, whole, 1e-12, what);
  cag_distance_cells_free(&c);
  // With the limit 0, there are no cells, and only halves below the limit are kept.
  MUST(cag_distance_cells_make(&c, s, p, false, err));
  MUST(cag_distance_cells_next(&c, -INFINITY, &cell, &found, err));
  assert_false(found);
  MUST(cag_distance_cells_next(&c, INFINITY, &cell, &found, err));
  const size_t count = c.count;
  MUST(cag_distance_cells_halve(&c, &cell, -INFINITY, err));
  assert_int_equal(c.count, count);
  cag_distance_cells_free(&c);
}

static CagStatus bump(void *context, double u, double v, int n, CagVec3 *out, CagError *err) {
  (void)context;
  (void)err;
  out[0] = cag_vec3(u, v, sin(u) * cos(v));
  if (n == 0) return CAG_OK;
  out[cag_partial(n, 1, 0)] = cag_vec3(1, 0, cos(u) * cos(v));
  out[cag_partial(n, 0, 1)] = cag_vec3(0, 1, -sin(u) * sin(v));
  if (n == 1) return CAG_OK;
  out[cag_partial(n, 2, 0)] = out[cag_partial(n, 0, 2)] = cag_vec3(0, 0, -sin(u) * cos(v));
  out[cag_partial(n, 1, 1)] = cag_vec3(0, 0, -cos(u) * sin(v));
  return CAG_OK;
}
static CagStatus bump_row(void *context, double u, const double *vs, size_t nv, int n, CagVec3 *out,
                          CagError *err) {
  return row_by_points(bump, context, u, vs, nv, n, out, err);
}

static CagSurface *patch(int p, int q, bool rational) {
  enum { MOST = 7 };
  CagVec3 net[MOST * MOST];
  double weights[MOST * MOST], ku[2 * MOST], kv[2 * MOST];
  const int nu = p + 3, nv = q + 2;
  for (int i = 0; i < nu; i++)
    for (int j = 0; j < nv; j++) {
      const double z = between(-1.5, 1.5);
      net[i * nv + j] = cag_vec3(i * 4.0 / nu + 0.2 * z, j * 4.0 / nv, z);
      weights[i * nv + j] = between(0.5, 2);
    }
  for (int i = 0; i < nu + p + 1; i++) ku[i] = i <= p ? 0 : i >= nu ? 4 : i == p + 1 ? 1 : 2.5;
  for (int i = 0; i < nv + q + 1; i++) kv[i] = i <= q ? -1 : i >= nv ? 2 : 0.4;
  CagSurface *s;
  MUST(cag_surface_nurbs(net, rational ? weights : NULL, (size_t)nu, (size_t)nv, p, q, ku, kv, &s,
                         err));
  return s;
}

static CagCurve *coil(void) {
  CagCurve *c;
  MUST(cag_curve_helix(3, 4, 1.5, 0, &c, err));
  return c;
}

static CagSurface *swept(bool round, bool plain, bool tilted) {
  CagCurve *path = coil(), *section;
  CagMotion *motion;
  CagSurface *s;
  CagTransform frame = cag_transform_identity();
  frame.m[0][3] = round ? 0 : 0.3;
  if (tilted) {
    frame.planar = false;
    frame.m[2][0] = 0.4;
    frame.m[2][1] = -0.3;
    frame.m[2][3] = 0.2;
  }
  const CagPathMotion how = {.orient = CAG_ORIENT_RMF,
                             .twist = {0, plain ? 0 : 1.2, NULL},
                             .scale = {1, plain ? 1 : 0.6, NULL}};
  MUST(cag_curve_arc(0.9, round ? 0.9 : 0.4, 0, 2 * M_PI, &frame, &section, err));
  if (tilted) { // also over large and small parameters
    CagCurve *timed;
    MUST(cag_curve_reparametrize(path, 30, 1030, &timed, err));
    cag_curve_release(path);
    path = timed;
    MUST(cag_curve_reparametrize(section, 1, 1.01, &timed, err));
    cag_curve_release(section);
    section = timed;
  }
  MUST(cag_motion_along(path, &how, &motion, err));
  MUST(cag_surface_sweep(section, motion, &s, err));
  cag_motion_release(motion);
  cag_curve_release(section);
  cag_curve_release(path);
  return s;
}

enum { KINDS = 13, POINTS = 12 };
// The maximum average number of cells for a kind. Bounds with errors of the square of a cell's size
// need a few dozen, and those with errors of its size need hundreds.
static CagSurface *surface_of(int kind, const char **name, int *most) {
  static const struct {
    const char *name;
    int most;
  } OF[KINDS] = {
      {"bicubic", 50},
      {"rational", 50},
      {"uneven degrees", 50},
      {"torus", 55},
      {"sphere", 55},
      {"tube", 24},
      {"growing tube", 26},
      {"sweep", 110},
      {"extrusion", 42},
      {"function", 50},
      {"offset", 50},
      {"mirrored sweep", 120},
      {"sweep of a space curve", 150},
  };
  CagSurface *s = NULL, *base;
  CagCurve *c;
  CagTransform map;
  *name = OF[kind].name;
  *most = OF[kind].most;
  const CagSurfaceFunction f = {
      .eval = bump, .eval_row = bump_row, .release = NULL, .context = NULL};
  switch (kind) {
  case 0: return patch(3, 3, false);
  case 1: return patch(2, 3, true);
  case 2: return patch(1, 4, true);
  case 3: MUST(cag_surface_torus(3, 1, &s, err)); return s;
  case 4:
    map = cag_transform_identity();
    map.planar = false;
    map.m[1][1] = map.m[2][2] = 0;
    map.m[2][1] = map.m[1][2] = 1; // in the plane y = 0
    MUST(cag_curve_arc(2, 2, -M_PI / 2, M_PI / 2, &map, &c, err));
    MUST(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, err));
    cag_curve_release(c);
    return s;
  case 5:
    c = coil();
    MUST(cag_surface_tube(c, 0.7, &s, err));
    cag_curve_release(c);
    return s;
  case 6: {
    const CagAlong radius = {0.4, 1.1, NULL};
    c = coil();
    MUST(cag_surface_tube_along(c, &radius, &s, err));
    cag_curve_release(c);
    return s;
  }
  case 12: return swept(false, true, true);
  case 7: return swept(false, false, false);
  case 8:
    map = cag_transform_identity();
    map.m[0][3] = 0.5;
    map.m[1][3] = 0.3;
    MUST(cag_curve_arc(2, 0.7, 0.2, 4, &map, &c, err));
    MUST(cag_surface_extrude(c, cag_vec3(0.5, 0, 3), 1.7, 0.6, &s, err));
    cag_curve_release(c);
    return s;
  case 9: MUST(cag_surface_function(&f, -3, 3, false, -3, 3, false, &s, err)); return s;
  case 10:
    base = patch(3, 2, false);
    MUST(cag_surface_offset(base, 0.2, &s, err));
    break;
  default:
    base = swept(true, false, false);
    map = cag_shear(0.3, 0, 0, 0.2, 0, 0);
    map.m[1][1] = -1.3;
    MUST(cag_surface_transform(base, &map, &s, err));
  }
  cag_surface_release(base);
  return s;
}

static void few_cells_decide(void **state) {
  (void)state;
  state_of_random = 3;
  for (int kind = 0; kind < KINDS; kind++) {
    const char *name;
    int most, sum = 0;
    CagSurface *s = surface_of(kind, &name, &most);
    for (int i = 0; i < POINTS; i++) {
      const CagVec3 p = beside(s);
      sum += cells_needed(s, p, i % 3 > 0, name);
      if (i < 2) check_cover(s, p, name);
    }
    if (sum > POINTS * most) fail_msg("%s: %d cells for %d points", name, sum, POINTS);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(few_cells_decide)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
