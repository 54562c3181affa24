// Values at the vertices of meshes: curvatures and slopes of a graph in closed form, on both sides
// of a jump. Ranges of values, and reflected directions, compared with their definitions.

#include "geom/meet/value_map.h"

#include "geom/surface/function.h"
#include "geom/surface/reshape.h"
#include "tests/geom/function_support.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// z = height sin(often x) cos(often y) / 2 + slant x y, with derivatives.
static double height = 1, often = 1, slant = 0.2;

static CagStatus hills(void *context, double x, double y, int n, CagVec3 *out, CagError *e) {
  (void)context;
  (void)e;
  const double sx = sin(often * x), cx = cos(often * x), sy = sin(often * y), cy = cos(often * y);
  const double a = height / 2, b = a * often, c = b * often;
  out[0] = cag_vec3(x, y, a * sx * cy + slant * x * y);
  if (n == 0) return CAG_OK;
  out[cag_partial(n, 1, 0)] = cag_vec3(1, 0, b * cx * cy + slant * y);
  out[cag_partial(n, 0, 1)] = cag_vec3(0, 1, -b * sx * sy + slant * x);
  if (n == 1) return CAG_OK;
  out[cag_partial(n, 2, 0)] = out[cag_partial(n, 0, 2)] = cag_vec3(0, 0, -c * sx * cy);
  out[cag_partial(n, 1, 1)] = cag_vec3(0, 0, -c * cx * sy + slant);
  return CAG_OK;
}
static CagStatus hills_row(void *context, double u, const double *vs, size_t nv, int n,
                           CagVec3 *out, CagError *e) {
  return row_by_points(hills, context, u, vs, nv, n, out, e);
}

// Monge's formulas, with the normal upward.
static double value_of_hills(CagSurfaceValue kind, double x, double y) {
  CagVec3 d[9];
  hills(NULL, x, y, 2, d, NULL);
  const double p = d[cag_partial(2, 1, 0)].z, q = d[cag_partial(2, 0, 1)].z;
  const double r = d[cag_partial(2, 2, 0)].z, s = d[cag_partial(2, 1, 1)].z,
               t = d[cag_partial(2, 0, 2)].z;
  const double g = 1 + p * p + q * q;
  const double gauss = (r * t - s * s) / (g * g);
  const double mean = ((1 + q * q) * r - 2 * p * q * s + (1 + p * p) * t) / (2 * pow(g, 1.5));
  const double half = sqrt(fmax(0, mean * mean - gauss));
  switch (kind) {
  case CAG_VALUE_GAUSSIAN: return gauss;
  case CAG_VALUE_MEAN: return mean;
  case CAG_VALUE_PRINCIPAL_MAX: return mean + half;
  case CAG_VALUE_PRINCIPAL_MIN: return mean - half;
  default: return atan(hypot(p, q)) * 180 / M_PI;
  }
}

static void values_of_a_graph_have_closed_forms(void **state) {
  (void)state;
  const CagSurfaceFunction f = {
      .eval = hills, .eval_row = hills_row, .release = NULL, .context = NULL};
  CagSurface *s, *flipped;
  OK(cag_surface_function(&f, -1.5, 2, false, -1, 1.5, false, &s, &err));
  OK(cag_surface_flip(s, &flipped, &err));
  for (int side = 0; side < 2; side++)
    for (CagSurfaceValue kind = CAG_VALUE_GAUSSIAN; kind <= CAG_VALUE_SLOPE; kind++) {
      // The opposite normal changes the sign, and exchanges the principal curvatures.
      const bool turned = side == 1 && kind != CAG_VALUE_GAUSSIAN && kind != CAG_VALUE_SLOPE;
      const CagSurfaceValue of = !turned                           ? kind
                                 : kind == CAG_VALUE_PRINCIPAL_MAX ? CAG_VALUE_PRINCIPAL_MIN
                                 : kind == CAG_VALUE_PRINCIPAL_MIN ? CAG_VALUE_PRINCIPAL_MAX
                                                                   : kind;
      CagTessellation how = CAG_TESSELLATION_DEFAULT;
      CagMesh *m;
      OK(cag_surface_value_mesh(side ? flipped : s, kind, &how, &m, &err));
      double low = INFINITY, high = -INFINITY;
      for (size_t v = 0; v < m->vertex_count; v++) {
        const double expected = value_of_hills(of, m->positions[v].x, m->positions[v].y);
        // Near an umbilic, the error of principal curvatures is the square root of rounding.
        NEAR(m->uv[2 * v], turned ? -expected : expected, 1e-7);
        NEAR(m->uv[2 * v + 1], 0, 0);
        low = fmin(low, m->uv[2 * v]);
        high = fmax(high, m->uv[2 * v]);
      }
      // Over 98 % of the triangles, the values differ only slightly, and edges are short.
      size_t wide = 0;
      for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *k = m->triangles + 3 * t;
        const double a = m->uv[2 * k[0]], b = m->uv[2 * k[1]], c = m->uv[2 * k[2]];
        wide += fmax(a, fmax(b, c)) - fmin(a, fmin(b, c)) > 0.0501 * (high - low);
        for (int j = 0; j < 3; j++)
          assert_true(cag_norm(cag_sub(m->positions[k[j]], m->positions[k[(j + 1) % 3]])) <
                      1.5 * 0.02 * 4.6);
      }
      assert_true((double)wide <= 0.02 * (double)m->triangle_count);
      cag_mesh_release(m);
      // A limit of triangles is respected when the mesh is refined.
      how.max_triangles = 40000;
      OK(cag_surface_value_mesh(s, kind, &how, &m, &err));
      assert_true(m->triangle_count <= how.max_triangles);
      cag_mesh_release(m);
    }
  cag_surface_release(flipped);
  cag_surface_release(s);
}

// The fraction of triangles over which the values differ by more than a twentieth of the range.
static double coarse_part(CagMesh *m, CagSurfaceValue kind) {
  size_t coarse = 0;
  double from, to;
  for (size_t v = 0; v < m->vertex_count; v++) {
    m->uv[2 * v] = value_of_hills(kind, m->positions[v].x, m->positions[v].y);
    m->uv[2 * v + 1] = 0;
  }
  cag_mesh_value_span(&m, 1, 0, &from, &to);
  for (size_t t = 0; t < m->triangle_count; t++) {
    double x[3];
    for (int k = 0; k < 3; k++)
      x[k] = fmin(fmax(m->uv[2 * m->triangles[3 * t + (size_t)k]], from), to);
    const double low = fmin(x[0], fmin(x[1], x[2])), high = fmax(x[0], fmax(x[1], x[2]));
    coarse += high - low > (to - from) / 20;
  }
  return (double)coarse / (double)m->triangle_count;
}

// Edges of a fiftieth of the size, or half or a quarter of that, until few triangles are coarse or
// too many would be needed.
static void meshes_are_made_finer_as_needed(void **state) {
  (void)state;
  const CagSurfaceFunction f = {
      .eval = hills, .eval_row = hills_row, .release = NULL, .context = NULL};
  static const size_t LIMITS[] = {1000000, 34000, 60000, 100000};
  int of[3] = {0, 0, 0};
  for (int round = 0; round < 12; round++) {
    // Larger hills, and then ripples that hardly bend the surface, finally on a ribbon.
    const double wide = round < 8 ? 0.5 + 6 * (round / 4) : 0.5;
    often = round < 8 ? 1 : 10 * pow(3, round - 8);
    height = round < 8 ? 1 : 0.01 / often;
    slant = round < 8 ? 0.2 : 0;
    const CagSurfaceValue kind = (CagSurfaceValue)(round % 5);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagSurface *s;
    CagBounds box;
    CagMesh *m, *plain;
    OK(cag_surface_function(&f, -wide, wide / 2, false, 0.1, 0.1 + (round < 11 ? wide : 0.01),
                            false, &s, &err));
    OK(cag_surface_bounds(s, &box, &err));
    how.max_triangles = LIMITS[round < 8 ? round % 4 : 0];
    CagTessellation fine = how;
    fine.angle = fmin(how.angle, 0.07);
    fine.max_edge = 0.02 * cag_norm(cag_sub(box.max, box.min));
    const CagStatus status = cag_surface_value_mesh(s, kind, &how, &m, &err);
    if (status) {
      assert_int_equal(cag_surface_tessellate(s, &fine, &plain, &err), status);
      cag_surface_release(s);
      continue;
    }
    int k = 0;
    for (;; k++, fine.max_edge /= 2) {
      OK(cag_surface_tessellate(s, &fine, &plain, &err));
      const size_t next = 4 * plain->triangle_count;
      const bool last = k == 2 || next > 250000 || next > how.max_triangles;
      if (last || coarse_part(plain, kind) <= 0.02) break;
      cag_mesh_release(plain);
    }
    of[k]++;
    assert_int_equal(m->triangle_count, plain->triangle_count);
    assert_int_equal(m->vertex_count, plain->vertex_count);
    assert_int_equal(m->weld != NULL, plain->weld != NULL);
    for (size_t v = 0; v < m->vertex_count; v++) {
      near_vec(m->positions[v], plain->positions[v], 0);
      near_vec(m->normals[v], plain->normals[v], 0);
    }
    cag_mesh_release(plain);
    cag_mesh_release(m);
    cag_surface_release(s);
  }
  assert_true(of[0] > 0 && of[1] > 0 && of[2] > 0);
  often = height = 1;
  slant = 0.2;
}

// z = 0 for x < 1 and a (x - 1)^2 otherwise: its curvature jumps from 0 to 2 a. The blossoms at the
// pairs of knots 00, 01, 12, 22 are the control points.
static void both_sides_of_a_jump_have_their_values(void **state) {
  (void)state;
  const double a = 0.4, ku[] = {0, 0, 0, 1, 2, 2, 2}, kv[] = {0, 0, 3, 3};
  const double x[] = {0, 0.5, 1.5, 2};
  for (int round = 0; round < 6; round++) {
    const int direction = round % 2;
    const double size = round < 2 ? 1 : round < 4 ? 1000 : 0.001;
    CagVec3 net[8];
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 2; j++)
        net[2 * i + j] = cag_vec3(size * x[i], size * 3 * j, i == 3 ? size * a : 0);
    CagSurface *s, *t;
    OK(cag_surface_nurbs(net, NULL, 4, 2, 2, 1, ku, kv, &s, &err));
    if (direction == 1) {
      OK(cag_surface_transpose(s, &t, &err));
      cag_surface_release(s);
      OK(cag_surface_flip(t, &s, &err));
      cag_surface_release(t);
    }
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m;
    OK(cag_surface_value_mesh(s, CAG_VALUE_PRINCIPAL_MAX, &how, &m, &err));
    for (size_t v = 0; v < m->vertex_count; v++) {
      m->positions[v] = cag_scaled(m->positions[v], 1 / size);
      m->uv[2 * v] *= size;
    }
    size_t twice = 0;
    assert_non_null(m->weld);
    for (size_t k = 0; k < 3 * m->triangle_count; k++) {
      const uint32_t *t3 = m->triangles + k / 3 * 3;
      const double middle =
          (m->positions[t3[0]].x + m->positions[t3[1]].x + m->positions[t3[2]].x) / 3;
      const uint32_t v = m->triangles[k];
      const double at = m->positions[v].x - 1;
      const double expected = middle < 1 ? 0 : 2 * a / pow(1 + 4 * a * a * at * at, 1.5);
      NEAR(m->uv[2 * v], expected, 1e-5);
    }
    for (size_t v = 0; v < m->vertex_count; v++) {
      const uint32_t w = m->weld[v];
      near_vec(m->positions[w], m->positions[v], 0);
      near_vec(m->normals[w], m->normals[v], 0);
      if (w != v) {
        NEAR(m->positions[v].x, 1, 1e-12);
        twice++;
      }
    }
    // Every vertex on the break, from one end of the edge to the other, occurs twice.
    size_t on_break = 0;
    for (size_t v = 0; v < m->vertex_count; v++) on_break += fabs(m->positions[v].x - 1) < 1e-12;
    assert_int_equal(on_break, 2 * twice);
    assert_true(twice >= 2);
    cag_mesh_release(m);
    cag_surface_release(s);
  }
}

// --- Ranges ---

enum { MESHES = 3, MOST_TRIANGLES = 40 };

// Separate triangles, each with a value and an area of `weight` / 2.
static CagMesh *mesh_of(const double *values, const double *weights, size_t n) {
  CagMesh *m;
  OK(cag_mesh_new(3 * n, n, false, true, false, &m, &err));
  for (size_t i = 0; i < 3 * n; i++) {
    m->positions[i] = cag_vec3(i % 3 == 1 ? weights[i / 3] : 0, i % 3 == 2, (double)(i / 3));
    m->uv[2 * i] = values[i];
    m->uv[2 * i + 1] = 0;
    m->triangles[i] = (uint32_t)i;
  }
  return m;
}

// The range by its definition, with a sum over all samples for each.
static void span_by_sums(const double *x, const double *w, size_t n, double *from, double *to) {
  double total = 0, least = INFINITY, most = -INFINITY, low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < n; i++) {
    total += w[i / 3];
    least = fmin(least, x[i]);
    most = fmax(most, x[i]);
  }
  for (size_t i = 0; i < n; i++) {
    double below = 0;
    for (size_t k = 0; k < n; k++)
      if (x[k] <= x[i]) below += w[k / 3];
    if (below >= 0.02 * total) low = fmin(low, x[i]);
    if (below <= 0.98 * total) high = fmax(high, x[i]);
  }
  const double rest = fmax(high - low, 0);
  *from = high >= low && least < low - 0.5 * rest ? low : least;
  *to = high >= low && most > high + 0.5 * rest ? high : most;
}

static void spans_leave_rare_extremes_out(void **state) {
  (void)state;
  seed = 21;
  int cut[2] = {0, 0}, whole[2] = {0, 0};
  for (int round = 0; round < 400; round++) {
    double x[3 * MESHES * MOST_TRIANGLES], w[MESHES * MOST_TRIANGLES];
    CagMesh *meshes[MESHES];
    size_t n = 0;
    const double unit = round % 3 ? 1 : 0.001;
    for (int k = 0; k < MESHES; k++) {
      // Each of 50 equal triangles has exactly 2 % of the area.
      const size_t first = n, some = (size_t)uniform(k ? 0 : 5, MOST_TRIANGLES);
      const size_t count = round % 4 > 0 ? some : k < 2 ? 20 : 10;
      for (size_t i = 0; i < count; i++, n++) {
        // Small triangles may have outliers.
        const bool small = uniform(0, 1) < 0.15;
        w[n] = round % 4 == 0 ? 1 : small ? uniform(0.001, 0.2) : uniform(1, 2);
        const double off = small ? uniform(-4, 4) : 0;
        for (int j = 0; j < 3; j++) x[3 * n + (size_t)j] = unit * (uniform(1, 3) + off);
      }
      meshes[k] = mesh_of(x + 3 * first, w + first, count);
    }
    double from, to, low, high;
    cag_mesh_value_span(meshes, MESHES, 0, &from, &to);
    span_by_sums(x, w, 3 * n, &low, &high);
    NEAR(from, low, 0);
    NEAR(to, high, 0);
    double least = INFINITY, most = -INFINITY;
    for (size_t i = 0; i < 3 * n; i++) {
      least = fmin(least, x[i]);
      most = fmax(most, x[i]);
    }
    from > least ? cut[0]++ : whole[0]++;
    to < most ? cut[1]++ : whole[1]++;
    for (int k = 0; k < MESHES; k++) cag_mesh_release(meshes[k]);
  }
  assert_true(cut[0] > 20 && cut[1] > 20 && whole[0] > 20 && whole[1] > 20);
}

static void single_values_get_a_span_around_them(void **state) {
  (void)state;
  // Two values, the rounding tolerance, and the range.
  static const double OF[][5] = {
      {0, 0, 0, -1, 1},  {4, 4, 0, 2, 6},         {-4, -4, 0, -6, -2},
      {4, 4, 5, -1, 1},  {4, 4.000001, 0, 2, 6},  {4, 4.00001, 0, 4, 4.00001},
      {1, 2, 0.5, 1, 2}, {1, 1.4, 0.5, 0.5, 1.9}, {0.2, 0.4, 0.5, -1, 1},
      {-3, 1, 0, -3, 1}, {-0.2, 0.2, 0.5, -1, 1}, {-1, -1.000001, 0, -1.5, -0.5},
  };
  for (size_t i = 0; i < sizeof OF / sizeof *OF; i++) {
    const double x[] = {OF[i][0], OF[i][1], OF[i][0], OF[i][1], OF[i][0], OF[i][1]}, w[] = {1, 1};
    CagMesh *m = mesh_of(x, w, 2);
    double from, to;
    cag_mesh_value_span(&m, 1, OF[i][2], &from, &to);
    NEAR(from, OF[i][3], 2e-6);
    NEAR(to, OF[i][4], 2e-6);
    cag_mesh_release(m);
  }
  double from = 7, to = 7;
  cag_mesh_value_span(NULL, 0, 0, &from, &to);
  assert_true(from == 0 && to == 1);
}

static void mirrored_directions_have_their_component(void **state) {
  (void)state;
  seed = 22;
  CagMesh *m;
  OK(cag_mesh_new(50, 0, true, false, false, &m, &err));
  const CagVec3 eye = cag_unit(cag_vec3(1, -2, 3)), across = cag_unit(cag_vec3(1, 2, 1));
  for (size_t i = 0; i < 50; i++) {
    CagVec3 n;
    n.x = uniform(-1, 1);
    n.y = uniform(-1, 1);
    n.z = uniform(-1, 1);
    m->normals[i] = cag_unit(n);
    m->positions[i] = n;
  }
  for (int twice = 0; twice < 2; twice++) {
    OK(cag_mesh_reflect(m, eye, across, &err));
    for (size_t i = 0; i < 50; i++) {
      // A half turn about the normal.
      CagTransform turn;
      OK(cag_rotate(m->normals[i], M_PI, cag_vec3(0, 0, 0), &turn, &err));
      NEAR(m->uv[2 * i], cag_dot(cag_transform_vector(&turn, eye), across), 1e-14);
      NEAR(m->uv[2 * i + 1], 0, 0);
    }
  }
  cag_mesh_release(m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_of_a_graph_have_closed_forms),
      cmocka_unit_test(meshes_are_made_finer_as_needed),
      cmocka_unit_test(both_sides_of_a_jump_have_their_values),
      cmocka_unit_test(spans_leave_rare_extremes_out),
      cmocka_unit_test(single_values_get_a_span_around_them),
      cmocka_unit_test(mirrored_directions_have_their_component),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
