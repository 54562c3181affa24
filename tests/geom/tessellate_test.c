// Tessellation: every mesh satisfies its tolerance, is closed, and does not have excess triangles.
//
// Distances from the surface to the mesh are measured at 100 x 100 points of each smooth cell, to
// the closest of all triangles (found through a grid of cubes). The surfaces have known shapes or
// are difficult: poles, cusps, extreme weights, and many turns without a break.

#include "geom/mesh/distance.h"
#include "geom/solid/tessellate.h"
#include "tests/geom/support.h"

// --- Nearest triangle ---

typedef struct Cubes {
  const CagMesh *mesh;
  CagVec3 origin;
  double side;
  int count[3];
  size_t *start; // of each cube's triangles
  uint32_t *triangles;
} Cubes;

static int cube_of(const Cubes *c, double x, double origin, int axis) {
  double k = floor((x - origin) / c->side);
  return k < 0 ? 0 : k >= c->count[axis] ? c->count[axis] - 1 : (int)k;
}

static void cubes_of_triangle(const Cubes *c, size_t t, int low[3], int high[3]) {
  CagBounds b = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 3; k++) cag_bounds_add(&b, c->mesh->positions[c->mesh->triangles[3 * t + k]]);
  const double least[3] = {b.min.x, b.min.y, b.min.z}, most[3] = {b.max.x, b.max.y, b.max.z},
               origin[3] = {c->origin.x, c->origin.y, c->origin.z};
  for (int k = 0; k < 3; k++) {
    low[k] = cube_of(c, least[k], origin[k], k);
    high[k] = cube_of(c, most[k], origin[k], k);
  }
}

static size_t cube_index(const Cubes *c, int i, int j, int k) {
  return ((size_t)i * (size_t)c->count[1] + (size_t)j) * (size_t)c->count[2] + (size_t)k;
}

static Cubes sort_into_cubes(const CagMesh *m) {
  Cubes c = {.mesh = m};
  CagBounds b = cag_mesh_bounds(m);
  CagVec3 size = cag_sub(b.max, b.min);
  c.origin = b.min;
  c.side = cag_norm(size) / fmin(80, 2 + cbrt(4 * (double)m->triangle_count));
  c.count[0] = (int)(size.x / c.side) + 1;
  c.count[1] = (int)(size.y / c.side) + 1;
  c.count[2] = (int)(size.z / c.side) + 1;
  size_t cubes = cube_index(&c, c.count[0], 0, 0);
  c.start = calloc(cubes + 2, sizeof *c.start);
  for (int pass = 0; pass < 2; pass++) {
    for (size_t t = 0; t < m->triangle_count; t++) {
      int low[3], high[3];
      cubes_of_triangle(&c, t, low, high);
      for (int i = low[0]; i <= high[0]; i++)
        for (int j = low[1]; j <= high[1]; j++)
          for (int k = low[2]; k <= high[2]; k++) {
            size_t at = cube_index(&c, i, j, k);
            if (pass == 0) c.start[at + 2]++;
            else c.triangles[c.start[at + 1]++] = (uint32_t)t;
          }
    }
    if (pass == 1) break;
    for (size_t k = 2; k < cubes + 2; k++) c.start[k] += c.start[k - 1];
    c.triangles = malloc((c.start[cubes + 1] + 1) * sizeof *c.triangles);
  }
  return c;
}

static double distance_in_cube(const Cubes *c, int i, int j, int k, CagVec3 p) {
  double least = INFINITY;
  const CagMesh *m = c->mesh;
  size_t at = cube_index(c, i, j, k);
  for (size_t x = c->start[at]; x < c->start[at + 1]; x++) {
    const uint32_t *corner = m->triangles + 3 * (size_t)c->triangles[x];
    least = fmin(least, cag_distance_to_triangle(p, m->positions[corner[0]],
                                                 m->positions[corner[1]], m->positions[corner[2]]));
  }
  return least;
}

static double distance_to_mesh(const Cubes *c, CagVec3 p) {
  int at[3] = {cube_of(c, p.x, c->origin.x, 0), cube_of(c, p.y, c->origin.y, 1),
               cube_of(c, p.z, c->origin.z, 2)};
  double least = INFINITY;
  for (int ring = 0; least > (ring - 1) * c->side; ring++)
    for (int i = at[0] - ring; i <= at[0] + ring; i++)
      for (int j = at[1] - ring; j <= at[1] + ring; j++)
        for (int k = at[2] - ring; k <= at[2] + ring; k++) {
          if (i < 0 || j < 0 || k < 0 || i >= c->count[0] || j >= c->count[1] || k >= c->count[2])
            continue;
          if (abs(i - at[0]) < ring && abs(j - at[1]) < ring && abs(k - at[2]) < ring) continue;
          least = fmin(least, distance_in_cube(c, i, j, k, p));
        }
  return least;
}

// --- Checks ---

static size_t ends_of_cells(const CagSurface *s, int direction, double ends[64]) {
  size_t n = s->kind->breaks ? s->kind->breaks(s, direction, ends + 1, 62) : 0;
  assert_true(n <= 62);
  ends[0] = direction == 0 ? s->u0 : s->v0;
  ends[n + 1] = direction == 0 ? s->u1 : s->v1;
  return n + 1;
}

static double largest_distance(const CagSurface *s, const Cubes *c) {
  enum { SAMPLES = 100 };
  double us[64], vs[64], largest = 0;
  size_t nu = ends_of_cells(s, 0, us), nv = ends_of_cells(s, 1, vs);
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++)
      for (int a = 0; a <= SAMPLES; a++)
        for (int b = 0; b <= SAMPLES; b++) {
          CagVec3 p;
          OK(cag_surface_point(s, us[i] + (us[i + 1] - us[i]) * a / SAMPLES,
                               vs[j] + (vs[j + 1] - vs[j]) * b / SAMPLES, &p, &err));
          largest = fmax(largest, distance_to_mesh(c, p));
        }
  return largest;
}

// Checks that welded vertices have exactly the same position, normals are unit vectors, and
// triangles are not degenerate.
static void check_mesh(const CagMesh *m) {
  for (size_t v = 0; v < m->vertex_count; v++) {
    assert_true(m->weld[v] <= v);
    assert_memory_equal(&m->positions[v], &m->positions[m->weld[v]], sizeof m->positions[v]);
    NEAR(cag_norm(m->normals[v]), 1, 1e-12);
  }
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    assert_true(m->weld[k[0]] != m->weld[k[1]] && m->weld[k[1]] != m->weld[k[2]] &&
                m->weld[k[2]] != m->weld[k[0]]);
  }
}

static CagTessellation to_tolerance(double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = tolerance;
  return how;
}

// Returns the checked mesh of the surface, which the caller releases. The measured distance must be
// below the tolerance, and above `least_use` of it.
static CagMesh *mesh_of(const CagSurface *s, double tolerance, double least_use) {
  CagTessellation how = to_tolerance(tolerance);
  CagMesh *m;
  OK(cag_surface_tessellate(s, &how, &m, &err));
  check_mesh(m);
  Cubes c = sort_into_cubes(m);
  double found = largest_distance(s, &c) / tolerance;
  free(c.start);
  free(c.triangles);
  if (!(found <= 1 && found >= least_use))
    fail_msg("distance is %g of the tolerance %g (%zu triangles)", found, tolerance,
             m->triangle_count);
  return m;
}

static bool is_closed(const CagMesh *m) {
  CagVec3 edge[2];
  return cag_mesh_is_watertight(m, edge);
}

// --- Surfaces by functions ---

typedef struct Formula {
  CagSurface base;
  void (*at)(double u, double v, CagVec3 *p, CagVec3 *du, CagVec3 *dv);
} Formula;

static CagStatus formula_eval(const CagSurface *s, double u, double v, int n, CagSide side_u,
                              CagSide side_v, CagVec3 *out, CagError *e) {
  (void)side_u, (void)side_v, (void)e;
  CagVec3 du, dv;
  ((const Formula *)s)->at(u, v, &out[0], &du, &dv);
  if (n < 1) return CAG_OK;
  out[cag_partial(n, 1, 0)] = du;
  out[cag_partial(n, 0, 1)] = dv;
  return CAG_OK;
}

static const CagSurfaceKind formula_kind = {.name = "formula", .eval = formula_eval};

static Formula formula(void (*at)(double, double, CagVec3 *, CagVec3 *, CagVec3 *), double u0,
                       double u1, double v0, double v1) {
  return (Formula){{.kind = &formula_kind, .references = 1, .u0 = u0, .u1 = u1, .v0 = v0, .v1 = v1},
                   at};
}

// A tube of radius 1 around a helix of radius 10, with a rise of 3 per turn.
static void helix_tube(double u, double v, CagVec3 *p, CagVec3 *du, CagVec3 *dv) {
  const double rise = 3 / (2 * M_PI), length = sqrt(100 + rise * rise);
  CagVec3 n = {-cos(v), -sin(v), 0}, dn = {sin(v), -cos(v), 0};
  CagVec3 tangent = {-10 * sin(v) / length, 10 * cos(v) / length, rise / length},
          dtangent = {-10 * cos(v) / length, -10 * sin(v) / length, 0};
  CagVec3 b = cag_cross(tangent, n), db = cag_add(cag_cross(dtangent, n), cag_cross(tangent, dn));
  *p = cag_madd(cag_madd(cag_vec3(10 * cos(v), 10 * sin(v), rise * v), cos(u), n), sin(u), b);
  *du = cag_madd(cag_scaled(n, -sin(u)), cos(u), b);
  *dv = cag_madd(cag_madd(cag_scaled(tangent, length), cos(u), dn), sin(u), db);
}

// A bump whose width is 1/30 of the square.
static void bump(double u, double v, CagVec3 *p, CagVec3 *du, CagVec3 *dv) {
  double x = u - 0.37, y = v - 0.61, g = exp(-400 * (x * x + y * y));
  *p = cag_vec3(10 * u, 10 * v, 2 * g);
  *du = cag_vec3(10, 0, -1600 * x * g);
  *dv = cag_vec3(0, 10, -1600 * y * g);
}

static void waves(double u, double v, CagVec3 *p, CagVec3 *du, CagVec3 *dv) {
  *p = cag_vec3(u, v, sin(3 * u) * cos(2 * v));
  *du = cag_vec3(1, 0, 3 * cos(3 * u) * cos(2 * v));
  *dv = cag_vec3(0, 1, -2 * sin(3 * u) * sin(2 * v));
}

static void cone(double u, double v, CagVec3 *p, CagVec3 *du, CagVec3 *dv) {
  *p = cag_vec3(5 * u * cos(v), 5 * u * sin(v), -10 * u);
  *du = cag_vec3(5 * cos(v), 5 * sin(v), -10);
  *dv = cag_vec3(-5 * u * sin(v), 5 * u * cos(v), 0);
}

static void cylinder(double u, double v, CagVec3 *p, CagVec3 *du, CagVec3 *dv) {
  *p = cag_vec3(5 * cos(u), 5 * sin(u), v);
  *du = cag_vec3(-5 * sin(u), 5 * cos(u), 0);
  *dv = cag_vec3(0, 0, 1);
}

// --- Tests of surfaces ---

static void a_flat_patch_takes_two_triangles(void **state) {
  (void)state;
  CagSurface *s;
  OK(cag_surface_bilinear(cag_vec3(0, 0, 1), cag_vec3(0, 1, 1), cag_vec3(2, 0, 1),
                          cag_vec3(1, 3, 1), &s, &err));
  CagMesh *m = mesh_of(s, 1e-6, 0);
  assert_int_equal(m->triangle_count, 2);
  assert_int_equal(m->vertex_count, 4);
  cag_mesh_release(m);
  cag_surface_release(s);
}

static void a_cylinder_has_one_row(void **state) {
  (void)state;
  Formula f = formula(cylinder, 0, 2 * M_PI, 0, 20);
  f.base.closed_u = true;
  CagMesh *m = mesh_of(&f.base, 0.01, 0.7);
  // n chords of a circle deviate by r (1 - cos(pi / n)), so at least 50 are needed.
  assert_true(m->triangle_count >= 2 * 50 && m->triangle_count <= 2 * 56);
  assert_int_equal(cag_mesh_euler_characteristic(m), 0);
  cag_mesh_release(m);
}

static void a_cone_comes_to_one_point_with_a_normal_for_each_side(void **state) {
  (void)state;
  Formula f = formula(cone, 0, 1, 0, 2 * M_PI);
  f.base.closed_v = f.base.pole_u0 = true;
  CagMesh *m = mesh_of(&f.base, 0.01, 0.7);
  assert_int_equal(cag_mesh_euler_characteristic(m), 1);
  for (size_t t = 0; t < m->triangle_count; t++)
    for (int j = 0; j < 3; j++) {
      uint32_t k = m->triangles[3 * t + j];
      if (m->positions[k].z != 0) continue;
      // At the tip, too, the normal is perpendicular to the middle of its triangle: (2, 1)/sqrt 5
      // in the plane through the axis.
      NEAR(m->normals[k].z * m->normals[k].z, 0.2, 1e-4);
    }
  cag_mesh_release(m);
}

// A spindle: an arc of radius 5 about [-3, 0] in the half plane through the axis, revolved. One
// parameter is the arc's angle times `stretch`, from tip to tip, and the other is the rotation.
static double stretch;
static bool turn_first;

static void spindle(double u, double v, CagVec3 *p, CagVec3 *du, CagVec3 *dv) {
  const double a = (turn_first ? v : u) / stretch, t = turn_first ? u : v;
  const double r = 5 * cos(a) - 3, dr = -5 * sin(a) / stretch, dz = 5 * cos(a) / stretch;
  *p = cag_vec3(r * cos(t), r * sin(t), 5 * sin(a));
  *(turn_first ? dv : du) = cag_vec3(dr * cos(t), dr * sin(t), dz);
  *(turn_first ? du : dv) = cag_vec3(-r * sin(t), r * cos(t), 0);
}

// The normal at a tip is perpendicular to the arc, toward the middle of the triangle that uses it.
static void tips_of_curved_sides_have_the_normals_of_their_triangles(void **state) {
  (void)state;
  static const double stretches[] = {1e-3, 1, 500};
  const double end = acos(0.6);
  for (int k = 0; k < 6; k++) {
    stretch = stretches[k / 2];
    turn_first = k % 2;
    const double low = -end * stretch, high = end * stretch;
    Formula f = turn_first ? formula(spindle, 0, 2 * M_PI, low, high)
                           : formula(spindle, low, high, 0, 2 * M_PI);
    *(turn_first ? &f.base.closed_u : &f.base.closed_v) = true;
    *(turn_first ? &f.base.pole_v0 : &f.base.pole_u0) = true;
    *(turn_first ? &f.base.pole_v1 : &f.base.pole_u1) = true;
    CagMesh *m = mesh_of(&f.base, 0.01, 0.7);
    int tips[2] = {0, 0};
    assert_int_equal(cag_mesh_euler_characteristic(m), 2);
    for (size_t t = 0; t < m->triangle_count; t++)
      for (int j = 0; j < 3; j++) {
        const uint32_t *c = m->triangles + 3 * t;
        const CagVec3 at = m->positions[c[j]], n = m->normals[c[j]];
        if (fabs(fabs(at.z) - 4) > 1e-9) continue;
        const CagVec3 way = cag_add(m->positions[c[(j + 1) % 3]], m->positions[c[(j + 2) % 3]]);
        const double out = turn_first ? -1 : 1; // the orientation of the partial derivatives
        near_vec(cag_vec3(at.x, at.y, 0), cag_vec3(0, 0, 0), 1e-9);
        const CagVec3 want = {0.6 * way.x / hypot(way.x, way.y), 0.6 * way.y / hypot(way.x, way.y),
                              at.z > 0 ? 0.8 : -0.8};
        near_vec(n, cag_scaled(want, -out), 2e-4);
        tips[at.z > 0]++;
      }
    assert_int_equal(tips[0], tips[1]);
    assert_true(tips[0] > 10);
    cag_mesh_release(m);
  }
}

static void a_torus_closes_and_keeps_its_tolerance(void **state) {
  (void)state;
  CagSurface *s;
  OK(cag_surface_torus(10, 3, &s, &err));
  double last = 0;
  for (double tolerance = 0.1; tolerance > 5e-4; tolerance /= 10) {
    CagMesh *m = mesh_of(s, tolerance, 0.3);
    assert_true(is_closed(m));
    assert_int_equal(cag_mesh_euler_characteristic(m), 0);
    double terms[10];
    cag_mesh_volume_terms(m, terms);
    // 2 pi^2 R r^2; the error is proportional to the tolerance, and therefore to the square of the
    // step.
    double missing = 2 * M_PI * M_PI * 10 * 9 - terms[0];
    assert_true(missing > 0 && missing < tolerance * 4 * M_PI * M_PI * 30);
    if (tolerance < 5e-3) NEAR(last / missing, 10, 1.5);
    last = missing;
    cag_mesh_release(m);
  }
  cag_surface_release(s);
}

static void turns_without_breaks_are_seen(void **state) {
  (void)state;
  // 8 and 16 turns: samples at equal steps are at the same position in each turn.
  for (int turns = 8; turns <= 16; turns += 8) {
    Formula f = formula(helix_tube, 0, 2 * M_PI, 0, 2 * M_PI * turns);
    f.base.closed_u = true;
    CagMesh *m = mesh_of(&f.base, 0.02, 0.5);
    assert_int_equal(cag_mesh_euler_characteristic(m), 0);
    cag_mesh_release(m);
  }
}

static void triangles_go_where_the_curvature_is(void **state) {
  (void)state;
  Formula f = formula(bump, 0, 1, 0, 1);
  CagMesh *m = mesh_of(&f.base, 1e-3, 0.4);
  assert_int_equal(cag_mesh_euler_characteristic(m), 1);
  // A uniform grid for the top of the bump, where z'' = 1600/100, would need over 8000 triangles in
  // a square of the bump's width.
  assert_true(m->triangle_count < 25000);
  cag_mesh_release(m);
  f = formula(waves, -3, 3, -3, 3);
  cag_mesh_release(mesh_of(&f.base, 1e-3, 0.5));
}

static CagSurface *patch(const double z[4][4], const double *weights) {
  CagVec3 net[16];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) net[4 * i + j] = cag_vec3(i, j, z[i][j]);
  CagSurface *s;
  OK(cag_surface_bezier(net, weights, 4, 4, &s, &err));
  return s;
}

static void extreme_weights_keep_the_tolerance(void **state) {
  (void)state;
  const double z[4][4] = {{0}, {0, 5, 5, 0}, {0, 5, 5, 0}, {0}};
  double weights[16];
  for (int k = 0; k < 16; k++) weights[k] = 1;
  weights[6] = 100;
  weights[9] = 0.01;
  CagSurface *s = patch(z, weights);
  cag_mesh_release(mesh_of(s, 1e-2, 0.3)); // the angle decides in parts
  cag_mesh_release(mesh_of(s, 1e-3, 0.5));
  cag_surface_release(s);
}

static void a_patch_with_an_edge_of_one_point_is_a_disc(void **state) {
  (void)state;
  CagVec3 net[16];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      net[4 * i + j] = i == 0 ? cag_vec3(0, 0, 0) : cag_vec3(i, i * (j - 1.5), j % 2);
  CagSurface *s;
  OK(cag_surface_bezier(net, NULL, 4, 4, &s, &err));
  assert_true(s->pole_u0);
  CagMesh *m = mesh_of(s, 1e-3, 0.5);
  assert_int_equal(cag_mesh_euler_characteristic(m), 1);
  cag_mesh_release(m);
  cag_surface_release(s);
}

// A net of pseudorandom heights.
static CagSurface *rough_net(size_t n, double height) {
  CagVec3 *net = malloc(n * n * sizeof *net);
  double *knots = malloc((n + 4) * sizeof *knots);
  uint32_t x = 1;
  for (size_t k = 0; k < n * n; k++) {
    x = x * 1664525u + 1013904223u; // the generator of Numerical Recipes
    net[k] = cag_vec3((double)(k / n), (double)(k % n), height * (x >> 8) / (1 << 24));
  }
  for (size_t k = 0; k < n + 4; k++) knots[k] = fmin(fmax((double)k - 3, 0), (double)n - 3);
  CagSurface *s;
  OK(cag_surface_nurbs(net, NULL, n, n, 3, 3, knots, knots, &s, &err));
  free(net);
  free(knots);
  return s;
}

static void neighbors_of_unlike_curvature_share_their_edges(void **state) {
  (void)state;
  CagSurface *s = rough_net(7, 3);
  CagMesh *m = mesh_of(s, 2e-3, 0.7), *again;
  assert_int_equal(cag_mesh_euler_characteristic(m), 1); // without cracks or T-junctions
  CagTessellation how = to_tolerance(2e-3);
  OK(cag_surface_tessellate(s, &how, &again, &err));
  assert_int_equal(again->triangle_count, m->triangle_count);
  assert_memory_equal(again->positions, m->positions, m->vertex_count * sizeof *m->positions);
  assert_memory_equal(again->triangles, m->triangles, m->triangle_count * 12);
  cag_mesh_release(m);
  cag_mesh_release(again);
  cag_surface_release(s);
}

static void limits_are_kept(void **state) {
  (void)state;
  CagSurface *s = rough_net(7, 3);
  CagMesh *m;
  CagTessellation how = to_tolerance(1e-9);
  FAILS(cag_surface_tessellate(s, &how, &m, &err), "triangle-limit");
  how = to_tolerance(1e-3);
  how.max_triangles = 1000;
  FAILS(cag_surface_tessellate(s, &how, &m, &err), "triangle-limit");
  assert_int_equal(err.status, CAG_E_LIMIT);
  how = to_tolerance(1e-3);
  volatile int stop = 1;
  how.interrupt = &stop;
  FAILS(cag_surface_tessellate(s, &how, &m, &err), "interrupted");
  how = to_tolerance(10);
  how.max_edge = 0.2;
  OK(cag_surface_tessellate(s, &how, &m, &err));
  for (size_t t = 0; t < m->triangle_count; t++)
    for (int j = 0; j < 3; j++) {
      CagVec3 a = m->positions[m->triangles[3 * t + j]],
              b = m->positions[m->triangles[3 * t + (j + 1) % 3]];
      assert_true(cag_norm(cag_sub(a, b)) <= 0.2);
    }
  cag_mesh_release(m);
  cag_surface_release(s);
}

// --- Tests of solids ---

static CagTransform moved(double x, double y) {
  CagTransform t = cag_translate(cag_vec3(x, y, 0));
  t.planar = true;
  return t;
}

static CagRegion *plate_with_holes(double x) {
  const double radius[3] = {5, 1, 1.5}, at[3] = {0, 2, -2};
  CagCurve *circles[3];
  for (int k = 0; k < 3; k++) {
    CagTransform frame = moved(x + at[k], 0);
    OK(cag_curve_arc(radius[k], k == 2 ? 1 : radius[k], 0, 2 * M_PI, &frame, &circles[k], &err));
  }
  CagRegion *r;
  OK(cag_region_new(circles[0], circles + 1, 2, &r, &err));
  for (int k = 0; k < 3; k++) cag_curve_release(circles[k]);
  return r;
}

// Checks the solid's mesh and releases the solid. `volume` is from a closed form. The mesh's may
// differ by at most the tolerance times its area (and by at most twice that, for its own area).
static void check_solid(CagSolid *s, double tolerance, long euler, double volume) {
  CagTessellation how = to_tolerance(tolerance);
  CagMesh *m;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  check_mesh(m);
  if (!is_closed(m)) fail_msg("solid of kind %d is open", (int)s->kind);
  assert_int_equal(cag_mesh_euler_characteristic(m), euler);
  double terms[10];
  cag_mesh_volume_terms(m, terms);
  NEAR(terms[0], volume, fmax(tolerance * cag_mesh_area(m), 1e-12 * volume));
  Cubes c = sort_into_cubes(m);
  for (size_t f = 0; f < s->face_count; f++) {
    if (cag_surface_planar_view(s->faces[f], NULL, NULL)) continue;
    double found = largest_distance(s->faces[f], &c) / tolerance;
    if (!(found <= 1)) fail_msg("solid of kind %d: distance %g", (int)s->kind, found);
  }
  free(c.start);
  free(c.triangles);
  cag_mesh_release(m);
  cag_solid_release(s);
}

static void primitives_are_watertight(void **state) {
  (void)state;
  CagSolid *s;
  const double fine = 0.02;
  OK(cag_solid_box(cag_vec3(1, 2, 3), true, &s, &err));
  check_solid(s, fine, 2, 6);
  OK(cag_solid_sphere(5, &s, &err));
  check_solid(s, fine, 2, 4 * M_PI / 3 * 125);
  OK(cag_solid_cylinder(10, 3, 3, &s, &err));
  check_solid(s, fine, 2, 90 * M_PI);
  OK(cag_solid_cylinder(10, 3, 1, &s, &err));
  check_solid(s, fine, 2, 10 * M_PI / 3 * (9 + 3 + 1));
  OK(cag_solid_cylinder(10, 3, 0, &s, &err));
  check_solid(s, fine, 2, 30 * M_PI);
  OK(cag_solid_cylinder(10, 0, 3, &s, &err));
  check_solid(s, fine, 2, 30 * M_PI);
  OK(cag_solid_torus(10, 3, &s, &err));
  check_solid(s, fine, 0, 2 * M_PI * M_PI * 90);
}

static void extrusions_are_watertight(void **state) {
  (void)state;
  CagSolid *s;
  CagRegion *r = plate_with_holes(0);
  double area = M_PI * (25 - 1 - 1.5);
  OK(cag_solid_extrude(r, cag_vec3(0, 0, 5), 0, 1, &s, &err));
  check_solid(s, 0.02, -2, 5 * area);
  OK(cag_solid_extrude(r, cag_vec3(1, 2, -5), 0, 1, &s, &err));
  check_solid(s, 0.02, -2, 5 * area);
  // The sides of the section shrink to 0.7, so its area shrinks to the square of that.
  OK(cag_solid_extrude(r, cag_vec3(0, 0, 5), 2, 0.7, &s, &err));
  check_solid(s, 0.02, -2, 5 * area * (1 + 0.7 + 0.49) / 3);
  cag_region_release(r);
  OK(cag_region_rectangle(10, 6, 1, &r, &err));
  OK(cag_solid_extrude(r, cag_vec3(0, 0, 5), 1.5, 1, &s, &err));
  check_solid(s, 0.02, 2, 5 * (60 - 4 + M_PI));
  cag_region_release(r);
  OK(cag_region_regular_polygon(6, 4, &r, &err));
  OK(cag_solid_extrude(r, cag_vec3(0, 0, 5), 3, 1, &s, &err));
  check_solid(s, 0.02, 2, 5 * 1.5 * sqrt(3) * 16);
  cag_region_release(r);
}

static void revolutions_are_watertight(void **state) {
  (void)state;
  const CagVec3 z = {0, 0, 1}, origin = {0, 0, 0};
  CagSolid *s;
  CagRegion *r = plate_with_holes(8);
  // Pappus: area times the distance traveled by the centroid, for each loop.
  double way = M_PI * (25 * 8 - 1 * 10 - 1.5 * 6);
  OK(cag_solid_revolve(r, z, origin, 0, 2 * M_PI, &s, &err));
  check_solid(s, 0.02, 0, 2 * M_PI * way);
  OK(cag_solid_revolve(r, z, origin, 0.5, 3, &s, &err));
  check_solid(s, 0.02, -2, 2.5 * way);
  cag_region_release(r);
  // A profile with a side on the axis: a cone of radius 4 and height 3 on a cylinder of height 2.
  const CagVec3 profile[] = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 5, 0}};
  double volume = M_PI * 16 * (2 + 1);
  CagCurve *outline;
  OK(cag_curve_polyline(profile, 4, true, 2, &outline, &err));
  OK(cag_region_new(outline, NULL, 0, &r, &err));
  OK(cag_solid_revolve(r, z, origin, 0, 2 * M_PI, &s, &err));
  check_solid(s, 0.02, 2, volume);
  OK(cag_solid_revolve(r, z, origin, 0, 2, &s, &err));
  check_solid(s, 0.02, 2, volume / M_PI);
  cag_region_release(r);
  cag_curve_release(outline);
}

static void tubes_are_watertight(void **state) {
  (void)state;
  CagSolid *s;
  CagCurve *path;
  OK(cag_curve_helix(10, 4, 3, 0, &path, &err));
  OK(cag_solid_tube(path, 1, &s, &err));
  // Pappus again: the section is perpendicular to the path, with its center on it.
  check_solid(s, 0.02, 2, M_PI * 3 * sqrt(400 * M_PI * M_PI + 16));
  cag_curve_release(path);
  const CagVec3 corners[] = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {10, 10, 10}};
  OK(cag_curve_polyline(corners, 4, false, 3, &path, &err));
  OK(cag_solid_tube(path, 1, &s, &err));
  check_solid(s, 0.02, 2, M_PI * 30); // mitered corners preserve the length of the axis
  cag_curve_release(path);
}

static void a_shell_of_patches_in_any_sense_is_watertight(void **state) {
  (void)state;
  // The faces of a cube with a saddle as its top, each parametrized differently.
  CagVec3 c[8];
  for (int k = 0; k < 8; k++) c[k] = cag_vec3(4 * (k & 1), 4 * (k >> 1 & 1), 4 * (k >> 2 & 1));
  c[4].z = c[7].z = 6;
  const int corner[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                            {2, 6, 3, 7}, {0, 4, 2, 6}, {1, 3, 5, 7}};
  CagSurface *faces[6];
  for (int k = 0; k < 6; k++)
    OK(cag_surface_bilinear(c[corner[k][0]], c[corner[k][1]], c[corner[k][2]], c[corner[k][3]],
                            &faces[k], &err));
  CagSolid *s;
  OK(cag_solid_shell(faces, 6, &s, &err));
  check_solid(s, 0.01, 2, 16 * 5); // the mean height of a bilinear top is that of its corners
  for (int k = 0; k < 6; k++) cag_surface_release(faces[k]);
}

// All control points coincide up to rounding: neither the size nor the normals are meaningful.
static void a_surface_that_is_a_point_is_no_work(void **state) {
  (void)state;
  CagVec3 net[16];
  CagSurface *s;
  CagMesh *m;
  CagError error;
  for (int i = 0; i < 16; i++) net[i] = cag_vec3(1, 2, 3);
  assert_int_equal(cag_surface_bezier(net, NULL, 4, 4, &s, &error), CAG_OK);
  assert_int_equal(cag_surface_tessellate(s, &CAG_TESSELLATION_DEFAULT, &m, &error), CAG_OK);
  assert_true(m->triangle_count <= 2);
  cag_mesh_release(m);
  cag_surface_release(s);
}

// Each side of a crease has its own normals, wherever the corners of the leaves are along it.
static void creases_are_sharp_at_every_tolerance(void **state) {
  (void)state;
  const CagVec3 profile[] = {{0, 0, 2}, {20, 0, 0}, {30, 0, 25}, {28, 0, 25}, {15, 0, 5}};
  CagCurve *c;
  CagSurface *s;
  OK(cag_curve_polyline(profile, 5, false, 3, &c, &err));
  OK(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, &err));
  for (double tolerance = 1; tolerance > 1e-4; tolerance *= 0.7) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m;
    how.tolerance = tolerance;
    OK(cag_surface_tessellate(s, &how, &m, &err));
    for (size_t k = 0; k < m->triangle_count; k++) {
      const uint32_t *t = m->triangles + 3 * k;
      const CagVec3 *p = m->positions;
      const CagVec3 n = cag_unit(cag_cross(cag_sub(p[t[1]], p[t[0]]), cag_sub(p[t[2]], p[t[0]])));
      for (int i = 0; i < 3; i++) assert_true(cag_dot(n, m->normals[t[i]]) > cos(M_PI / 10));
    }
    cag_mesh_release(m);
  }
  cag_surface_release(s);
  cag_curve_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_flat_patch_takes_two_triangles),
      cmocka_unit_test(a_cylinder_has_one_row),
      cmocka_unit_test(a_cone_comes_to_one_point_with_a_normal_for_each_side),
      cmocka_unit_test(tips_of_curved_sides_have_the_normals_of_their_triangles),
      cmocka_unit_test(a_torus_closes_and_keeps_its_tolerance),
      cmocka_unit_test(turns_without_breaks_are_seen),
      cmocka_unit_test(triangles_go_where_the_curvature_is),
      cmocka_unit_test(extreme_weights_keep_the_tolerance),
      cmocka_unit_test(a_patch_with_an_edge_of_one_point_is_a_disc),
      cmocka_unit_test(neighbors_of_unlike_curvature_share_their_edges),
      cmocka_unit_test(limits_are_kept),
      cmocka_unit_test(primitives_are_watertight),
      cmocka_unit_test(extrusions_are_watertight),
      cmocka_unit_test(revolutions_are_watertight),
      cmocka_unit_test(tubes_are_watertight),
      cmocka_unit_test(a_shell_of_patches_in_any_sense_is_watertight),
      cmocka_unit_test(a_surface_that_is_a_point_is_no_work),
      cmocka_unit_test(creases_are_sharp_at_every_tolerance),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
