// Plane sections in the core: meshes with vertices in the plane, defective meshes, and traced
// curves.

#include "geom/meet/curvature_line.h"
#include "geom/meet/section.h"
#include "geom/meet/section_edges.h"
#include "geom/surface/mapped.h"
#include "support.h"
#include "tests/geom/random.h"

static CagPlane plane_of(double x, double y, double z, double nx, double ny, double nz) {
  CagPlane p;
  OK(cag_plane(cag_vec3(x, y, z), cag_vec3(nx, ny, nz), &p, &err));
  return p;
}

static CagMesh *mesh_of(const CagVec3 *vertices, size_t n, const uint32_t *triangles,
                        size_t count) {
  CagMesh *m;
  OK(cag_mesh_new(n, count, false, false, false, &m, &err));
  memcpy(m->positions, vertices, n * sizeof *vertices);
  memcpy(m->triangles, triangles, 3 * count * sizeof *triangles);
  return m;
}

// The octahedron with its six vertices on the axes.
static CagMesh *octahedron(void) {
  static const CagVec3 p[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  static const uint32_t t[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                               2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  return mesh_of(p, 6, t, 8);
}

static double total_length(const CagCurveList *list) {
  double sum = 0, length;
  for (size_t i = 0; i < list->count; i++) {
    OK(cag_curve_length(list->items[i], list->items[i]->start, list->items[i]->end, &length, &err));
    sum += length;
  }
  return sum;
}

static void a_plane_through_vertices_and_edges_gives_one_closed_curve(void **state) {
  (void)state;
  CagMesh *m = octahedron();
  // z = 0 contains four vertices and four edges, and x = y contains two vertices.
  const CagPlane planes[] = {plane_of(0, 0, 0, 0, 0, 1), plane_of(0, 0, 0, 0, 0, -1),
                             plane_of(0, 0, 0, 1, -1, 0)};
  const double lengths[] = {4 * sqrt(2), 4 * sqrt(2), 4 * sqrt(1.5)};
  for (int i = 0; i < 3; i++) {
    CagCurveList list = {0};
    OK(cag_mesh_section(m, &planes[i], &list, &err));
    assert_int_equal(list.count, 1);
    assert_true(list.items[0]->closed);
    NEAR(total_length(&list), lengths[i], 1e-12);
    cag_curve_list_free(&list);
  }
  cag_mesh_release(m);
}

static void an_open_mesh_gives_open_curves_and_an_empty_one_none(void **state) {
  (void)state;
  static const CagVec3 p[] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  static const uint32_t t[] = {0, 1, 2, 0, 2, 3};
  CagMesh *sheet = mesh_of(p, 4, t, 2), *empty = mesh_of(p, 0, t, 0);
  CagPlane plane = plane_of(0.5, 0, 0, 1, 0, 0);
  CagCurveList list = {0};
  OK(cag_mesh_section(empty, &plane, &list, &err));
  assert_int_equal(list.count, 0);
  OK(cag_mesh_section(sheet, &plane, &list, &err));
  assert_int_equal(list.count, 1);
  assert_false(list.items[0]->closed);
  NEAR(total_length(&list), 2, 1e-15);
  // The sheet lies in the plane.
  plane = plane_of(0, 0, 0, 0, 0, 1);
  OK(cag_mesh_section(sheet, &plane, &list, &err));
  assert_int_equal(list.count, 1);
  cag_curve_list_free(&list);
  cag_mesh_release(sheet);
  cag_mesh_release(empty);
}

// If three triangles have a common edge, the first two are connected.
static void triangles_on_one_edge_are_joined_in_order(void **state) {
  (void)state;
  static const CagVec3 p[] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0.5}, {0, 1, 0.5}, {-1, -1, 0.5}};
  static const uint32_t t[][9] = {{0, 1, 2, 0, 1, 3, 0, 1, 4}, {4, 1, 0, 0, 1, 2, 3, 0, 1}};
  static const int ends[][2] = {{2, 3}, {4, 2}};
  for (int k = 0; k < 2; k++) {
    CagMesh *m = mesh_of(p, 5, t[k], 3);
    CagPlane plane = plane_of(0, 0, 0, 0, 0, 1);
    CagCurveList list = {0};
    OK(cag_mesh_section(m, &plane, &list, &err));
    assert_int_equal(list.count, 2);
    for (size_t i = 0; i < 2; i++) {
      const CagVec3 *points;
      size_t n;
      bool closed;
      assert_true(cag_curve_vertices(list.items[i], &points, &n, &closed) && !closed);
      if (n == 2) continue;
      assert_int_equal(n, 3);
      // At two thirds from the lowest vertex.
      for (int e = 0; e < 2; e++) {
        const CagVec3 q = cag_lerp(p[0], p[ends[k][e]], 2.0 / 3);
        NEAR(fmin(cag_norm(cag_sub(points[0], q)), cag_norm(cag_sub(points[2], q))), 0, 1e-15);
      }
    }
    cag_curve_list_free(&list);
    cag_mesh_release(m);
  }
}

// Three triangles on one edge, and two with the same direction.
static void meshes_that_are_no_surfaces_do_no_harm(void **state) {
  (void)state;
  static const CagVec3 p[] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0.5}, {0, 1, 0.5}, {-1, -1, 0.5}};
  static const uint32_t t[] = {0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 2};
  CagMesh *m = mesh_of(p, 5, t, 4);
  CagPlane plane = plane_of(0, 0, 0, 0, 0, 1);
  CagCurveList list = {0};
  OK(cag_mesh_section(m, &plane, &list, &err));
  assert_true(list.count >= 1);
  cag_curve_list_free(&list);
  cag_mesh_release(m);
}

static void solids_of_all_sizes_are_cut_alike(void **state) {
  (void)state;
  // The plane through the center of a cube perpendicular to its space diagonal: a hexagon of side
  // size / sqrt(2).
  for (double size = 1e-6; size < 1e7; size *= 1e3) {
    CagSolid *box;
    OK(cag_solid_box(cag_vec3(size, size, size), false, &box, &err));
    CagPlane plane = plane_of(size / 2, size / 2, size / 2, 1, 1, 1);
    CagCurveList list = {0};
    OK(cag_solid_section(box, &plane, 0, &list, &err));
    assert_int_equal(list.count, 1);
    NEAR(total_length(&list) / size, 3 * sqrt(2), 1e-9);
    cag_curve_list_free(&list);
    cag_solid_release(box);
  }
}

// The arc lengths of x^2 + y^2 = r^2 at the height of the plane, including near the ball's top.
static void balls_give_exact_circles_at_every_height(void **state) {
  (void)state;
  CagSolid *ball;
  OK(cag_solid_sphere(3, &ball, &err));
  for (int k = -29; k <= 29; k++) {
    CagPlane plane = plane_of(0, 0, k / 10.0, 0, 0, 1);
    CagCurveList list = {0};
    OK(cag_solid_section(ball, &plane, 0, &list, &err));
    assert_int_equal(list.count, 1);
    double a, b;
    CagTransform frame;
    assert_true(cag_curve_arc_view(list.items[0], &a, &b, &frame));
    NEAR(total_length(&list), 6.283185307179586 * sqrt(9 - k * k / 100.0), 1e-8);
    cag_curve_list_free(&list);
  }
  cag_solid_release(ball);
}

static void a_closed_mesh_laid_on_a_surface_stays_closed(void **state) {
  (void)state;
  CagSurface *torus;
  CagMesh *m = octahedron(), *image;
  OK(cag_surface_torus(5, 2, &torus, &err));
  for (size_t i = 0; i < m->vertex_count; i++) {
    m->positions[i].x += 3;
    m->positions[i].y += 3;
  }
  OK(cag_mesh_onto_surface(m, torus, 1e-3, false, 100000, &image, &err));
  CagVec3 edge[2];
  assert_true(cag_mesh_is_watertight(image, edge));
  assert_int_equal(cag_mesh_euler_characteristic(image), 2);
  cag_mesh_release(image);
  assert_int_equal(cag_mesh_onto_surface(m, torus, 1e-3, false, 100, &image, &err), CAG_E_LIMIT);
  m->positions[0].x = 100;
  FAILS(cag_mesh_onto_surface(m, torus, 1e-3, false, 100000, &image, &err), "parameter-range");
  cag_mesh_release(m);
  cag_surface_release(torus);
}

// Distance and normal of a torus in closed form.
static CagVec3 off_torus(CagVec3 p, double major, CagVec3 *normal) {
  const CagVec3 ring = cag_scaled(cag_unit(cag_vec3(p.x, p.y, 0)), major);
  *normal = cag_unit(cag_sub(p, ring));
  return cag_sub(p, ring);
}

// A square above the torus, projected as a sheet. It is on the torus with its normals, its edges
// satisfy the tolerance and are short, and its area is that of the torus there.
static void sheets_on_a_torus_keep_the_tolerance(void **state) {
  (void)state;
  CagSurface *torus;
  OK(cag_surface_torus(5, 2, &torus, &err));
  for (int round = 0; round < 4; round++) {
    const double tolerance = round == 0 ? 0 : pow(10, -round), height = round == 3 ? 0.5 : 0;
    const CagVec3 p[] = {{1, 2, height}, {4, 2, height}, {4, 5.5, height}, {1, 5.5, height}};
    const uint32_t corners[] = {0, 1, 2, 3}, count[] = {4};
    CagMesh *square, *image;
    OK(cag_mesh_from_faces(p, 4, corners, count, 1, &square, &err));
    OK(cag_mesh_onto_surface(square, torus, tolerance, height == 0, 1000000, &image, &err));
    // Projected points have no parameters, and those of sheets have normals.
    assert_null(image->uv);
    assert_null(image->weld);
    assert_true((image->normals != NULL) == (height == 0));
    CagBounds box = cag_mesh_bounds(image);
    const double most = tolerance > 0 ? tolerance : 1.0001e-3 * cag_norm(cag_sub(box.max, box.min));
    double side = 0;
    for (size_t v = 0; v < image->vertex_count; v++) {
      CagVec3 normal;
      const double off = cag_norm(off_torus(image->positions[v], 5, &normal)) - 2;
      // The normal of the parametrization, with u about the axis or about the tube, is outward or
      // inward.
      if (v == 0) side = off < 0 ? -1 : 1;
      NEAR(off, height == 0 ? 0 : side * height, 1e-12);
      if (height == 0) NEAR(fabs(cag_dot(image->normals[v], normal)), 1, 1e-12);
      if (height == 0) NEAR(cag_norm(image->normals[v]), 1, 1e-12);
    }
    assert_true((image->normals != NULL) == (height == 0));
    for (size_t t = 0; t < image->triangle_count; t++)
      for (int k = 0; k < 3; k++) {
        const CagVec3 a = image->positions[image->triangles[3 * t + (size_t)k]];
        const CagVec3 b = image->positions[image->triangles[3 * t + (size_t)(k + 1) % 3]];
        CagVec3 normal;
        const double off = cag_norm(off_torus(cag_lerp(a, b, 0.5), 5, &normal)) - 2 - side * height;
        assert_true(fabs(off) <= most);
        // 0.08 of both domains, which are 2 pi, at distances of at most 7.5 and 2.5 from their
        // axes.
        assert_true(cag_norm(cag_sub(a, b)) <= 0.08 * 2 * M_PI * 7.5);
      }
    // Over 3 radians in u and 3.5 in v: the integral of r (R + r cos w) dw dt, where w is one of
    // them.
    if (height == 0) {
      const double about_v = 3 * 2 * (5 * 3.5 + 2 * (sin(5.5) - sin(2)));
      const double about_u = 3.5 * 2 * (5 * 3 + 2 * (sin(4) - sin(1)));
      CagVec3 q;
      OK(cag_surface_point(torus, 0.7, 0, &q, &err));
      const bool u_is_tube = fabs(q.z) > 0.1;
      const double area = cag_mesh_area(image);
      const double wanted = u_is_tube ? about_u : about_v;
      assert_true(fabs(area - wanted) < 2 * most * wanted);
    }
    cag_mesh_release(square);
    cag_mesh_release(image);
  }
  cag_surface_release(torus);
}

static void principal_directions_are_square_and_of_unit_length(void **state) {
  (void)state;
  CagSurface *torus;
  OK(cag_surface_torus(5, 2, &torus, &err));
  CagPrincipal p;
  bool found;
  OK(cag_surface_principal(torus, 0.3, 0.4, &found, &p, &err));
  assert_true(found);
  NEAR(cag_dot(p.direction[0], p.direction[1]), 0, 1e-14);
  NEAR(cag_norm(p.direction[0]), 1, 1e-14);
  // One of them is that of the small circle.
  NEAR(fmax(fabs(p.k[0]), fabs(p.k[1])), 0.5, 1e-13);
  cag_surface_release(torus);
}

// --- Random meshes ---

// A grid of n by n squares over 0..n with heights, each divided into two triangles. If `welded` is
// set, every triangle has its own vertices, connected by the weld table.
static CagMesh *landscape(size_t n, const double *heights, bool welded) {
  const size_t count = 2 * n * n;
  CagMesh *m;
  OK(cag_mesh_new(welded ? 3 * count : (n + 1) * (n + 1), count, false, false, welded, &m, &err));
  for (size_t t = 0; t < count; t++) {
    const size_t i = t / 2 / n, j = t / 2 % n;
    const size_t corner[2][3][2] = {{{i, j}, {i + 1, j}, {i + 1, j + 1}},
                                    {{i, j}, {i + 1, j + 1}, {i, j + 1}}};
    for (size_t k = 0; k < 3; k++) {
      const size_t x = corner[t % 2][k][0], y = corner[t % 2][k][1], at = x * (n + 1) + y;
      const size_t v = welded ? 3 * t + k : at;
      m->triangles[3 * t + k] = (uint32_t)v;
      m->positions[v] = cag_vec3((double)x, (double)y, heights[at]);
    }
  }
  for (size_t v = 0; welded && v < m->vertex_count; v++) {
    m->weld[v] = (uint32_t)v;
    for (size_t w = 0; w < v; w++)
      if (cag_norm(cag_sub(m->positions[v], m->positions[w])) == 0) {
        m->weld[v] = (uint32_t)w;
        break;
      }
  }
  return m;
}

// The pieces of the plane inside the triangles, computed separately. A vertex on the plane counts
// as above.
typedef struct Pieces {
  size_t n;
  CagVec3 end[512][2];
  double length;
} Pieces;

static void find_pieces(const CagMesh *m, const CagPlane *plane, Pieces *out) {
  *out = (Pieces){0};
  for (size_t t = 0; t < m->triangle_count; t++) {
    size_t k = 0;
    for (size_t c = 0; c < 3; c++) {
      CagVec3 a = m->positions[m->triangles[3 * t + c]];
      CagVec3 b = m->positions[m->triangles[3 * t + (c + 1) % 3]];
      const double ha = cag_dot(plane->normal, cag_sub(a, plane->point));
      const double hb = cag_dot(plane->normal, cag_sub(b, plane->point));
      const bool below_a = ha < -1e-12, below_b = hb < -1e-12;
      if (below_a != below_b) out->end[out->n][k++] = cag_lerp(a, b, ha / (ha - hb));
    }
    if (k == 0) continue;
    assert_int_equal(k, 2);
    out->length += cag_norm(cag_sub(out->end[out->n][1], out->end[out->n][0]));
    out->n++;
    assert_true(out->n < 512);
  }
}

static bool is_at(CagVec3 a, CagVec3 b) { return cag_norm(cag_sub(a, b)) < 1e-9; }

// Finds the pieces that end at p, except those of length 0.
static int pieces_at(const Pieces *s, CagVec3 p, CagVec3 out[2]) {
  int n = 0;
  for (size_t i = 0; i < s->n; i++)
    for (int e = 0; e < 2; e++)
      if (is_at(s->end[i][e], p) && !is_at(s->end[i][0], s->end[i][1]))
        if (n++ < 2) out[n - 1] = cag_unit(cag_sub(s->end[i][1 - e], p));
  return n;
}

// Checks that the corners of the curves are ends of pieces where these turn or end, that the curves
// together are as long as the pieces, and that an end of an open curve is the end of one piece.
static void check_polylines(const CagMesh *m, const CagPlane *plane, int round) {
  static Pieces pieces;
  find_pieces(m, plane, &pieces);
  size_t corners = 0, ends = 0, open = 0;
  CagVec3 ways[2];
  for (size_t i = 0; i < pieces.n; i++)
    for (int e = 0; e < 2; e++) {
      if (is_at(pieces.end[i][0], pieces.end[i][1])) continue;
      const int n = pieces_at(&pieces, pieces.end[i][e], ways);
      assert_true(n == 1 || n == 2);
      // Each end is reached from every piece that ends there.
      if (n == 1) ends++;
      else corners += cag_norm(cag_add(ways[0], ways[1])) > 1e-9;
    }
  CagCurveList list = {0};
  OK(cag_mesh_section(m, plane, &list, &err));
  size_t found = 0;
  for (size_t i = 0; i < list.count; i++) {
    const CagVec3 *points;
    size_t n;
    bool closed;
    assert_true(cag_curve_vertices(list.items[i], &points, &n, &closed));
    assert_int_equal(closed, list.items[i]->closed);
    open += !closed;
    found += n;
    for (size_t k = 0; k < n; k++) {
      const int many = pieces_at(&pieces, points[k], ways);
      assert_int_equal(many, !closed && (k == 0 || k + 1 == n) ? 1 : 2);
      if (many == 2) assert_true(cag_norm(cag_add(ways[0], ways[1])) > 1e-9);
    }
  }
  if (found != corners / 2 + ends || open != ends / 2)
    fail_msg("round %d: %zu corners, %zu open, not %zu, %zu", round, found, open,
             corners / 2 + ends, ends / 2);
  NEAR(total_length(&list), pieces.length, 1e-9);
  cag_curve_list_free(&list);
}

static void sections_of_landscapes_are_the_pieces_in_their_triangles(void **state) {
  (void)state;
  enum { MOST = 8 };
  seed = 81;
  for (int round = 0; round < 90; round++) {
    double heights[(MOST + 1) * (MOST + 1)];
    const size_t n = 1 + (size_t)round % MOST;
    // Random heights; or steps of whole numbers, many of which are in the plane, and flat parts.
    for (size_t i = 0; i < (n + 1) * (n + 1); i++) {
      heights[i] = uniform(-2, 2);
      if (round % 3 == 1) heights[i] = floor(heights[i]) + 0.5;
      if (round % 3 == 2) heights[i] = fmax(0, heights[i]);
    }
    CagMesh *m = landscape(n, heights, round % 2);
    const double slope = round % 3 ? 0 : uniform(-0.3, 0.3);
    const CagPlane plane = plane_of(0, 0, round % 3 == 1 ? 0 : 0.25, slope, slope / 3, 1);
    check_polylines(m, &plane, round);
    cag_mesh_release(m);
  }
}

// A cube whose faces are grids has the sections of the cube, with corners only on its edges.
static void sections_of_divided_cubes_have_no_points_on_flat_faces(void **state) {
  (void)state;
  seed = 82;
  for (int round = 0; round < 60; round++) {
    enum { N = 3 };
    CagMesh *m;
    OK(cag_mesh_new(6 * (N + 1) * (N + 1), 12 * N * N, false, false, true, &m, &err));
    size_t t = 0;
    for (size_t face = 0; face < 6; face++)
      for (size_t i = 0; i <= N; i++)
        for (size_t j = 0; j <= N; j++) {
          const size_t v = (face * (N + 1) + i) * (N + 1) + j;
          const double x = (double)i, y = (double)j, z = face < 3 ? 0 : N;
          m->positions[v] = face % 3 == 0   ? cag_vec3(x, y, z)
                            : face % 3 == 1 ? cag_vec3(z, x, y)
                                            : cag_vec3(y, z, x);
          if (i == N || j == N) continue;
          const uint32_t a = (uint32_t)v, b = a + N + 1;
          const uint32_t corner[6] = {a, b, b + 1, a, b + 1, a + 1};
          memcpy(m->triangles + 3 * t, corner, sizeof corner);
          t += 2;
        }
    for (size_t v = 0; v < m->vertex_count; v++) {
      m->weld[v] = (uint32_t)v;
      for (size_t w = 0; w < v && m->weld[v] == v; w++)
        if (is_at(m->positions[v], m->positions[w])) m->weld[v] = (uint32_t)w;
    }
    // Through points of the grid, or anywhere.
    double n[3], p[3];
    for (int k = 0; k < 3; k++) {
      n[k] = uniform(-1, 1);
      p[k] = uniform(0.2, N - 0.2);
      if (round % 2) {
        n[k] = floor(uniform(-2, 3));
        p[k] = floor(uniform(0, N + 1));
      }
    }
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) n[2] = 1;
    const CagPlane plane = plane_of(p[0], p[1], p[2], n[0], n[1], n[2]);
    // If corners of the cube are in the plane, the part above it does not have unique edges.
    bool generic = true;
    size_t corners = 0;
    for (int a = 0; a < 8; a++) {
      const CagVec3 pa = cag_vec3(a & 1 ? N : 0, a & 2 ? N : 0, a & 4 ? N : 0);
      const double ha = cag_dot(plane.normal, cag_sub(pa, plane.point));
      if (fabs(ha) < 1e-9) generic = false;
      for (int axis = 1; axis < 8; axis *= 2) {
        if (a & axis) continue;
        const int b = a | axis;
        const CagVec3 pb = cag_vec3(b & 1 ? N : 0, b & 2 ? N : 0, b & 4 ? N : 0);
        corners += (ha < 0) != (cag_dot(plane.normal, cag_sub(pb, plane.point)) < 0);
      }
    }
    if (generic) {
      CagCurveList list = {0};
      OK(cag_mesh_section(m, &plane, &list, &err));
      assert_int_equal(list.count, corners > 0);
      for (size_t i = 0; i < list.count; i++) {
        const CagVec3 *points;
        size_t count;
        bool closed;
        assert_true(cag_curve_vertices(list.items[i], &points, &count, &closed));
        assert_true(closed);
        assert_int_equal(count, corners);
        for (size_t k = 0; k < count; k++) {
          const double at[3] = {points[k].x, points[k].y, points[k].z};
          int on = 0;
          for (int c = 0; c < 3; c++) on += fabs(at[c]) < 1e-12 || fabs(at[c] - N) < 1e-12;
          assert_true(on >= 2);
          NEAR(cag_dot(plane.normal, cag_sub(points[k], plane.point)), 0, 1e-12);
        }
      }
      cag_curve_list_free(&list);
    }
    cag_mesh_release(m);
  }
}

// --- Duplicates ---

// The number of two segments that are kept.
static size_t kept(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d, double near) {
  const CagVec3 ends[2][2] = {{a, b}, {c, d}};
  CagCurveList list = {0};
  for (int i = 0; i < 2; i++) {
    CagCurve *line;
    OK(cag_curve_polyline(ends[i], 2, false, 3, &line, &err));
    OK(cag_curve_list_add(&list, line, &err));
  }
  OK(cag_curve_list_drop_covered(&list, 0, near, &err));
  const size_t count = list.count;
  cag_curve_list_free(&list);
  return count;
}

static CagVec3 along(int axis, double x, double across) {
  const CagVec3 p[3] = {{x, across, across}, {across, x, across}, {across, across, x}};
  return p[axis];
}

static void curves_that_run_along_another_are_dropped(void **state) {
  (void)state;
  const double near = 0.01;
  // Even if `near` is lost in rounding.
  for (int axis = 0; axis < 3; axis++)
    for (int far = -1; far <= 1; far++) {
      const double w = far * 1e15;
      const CagVec3 a = along(axis, 0, w), b = along(axis, 8, w);
      assert_int_equal(kept(a, b, a, b, near), 1);
      assert_int_equal(kept(a, b, b, a, near), 1);
      assert_int_equal(kept(a, b, along(axis, 2, w), along(axis, 5, w), near), 1);
      assert_int_equal(kept(a, b, along(axis, 2, w), along(axis, 9, w), near), 2);
      assert_int_equal(kept(a, b, along(axis, -1, w), along(axis, 5, w), near), 2);
      assert_int_equal(kept(a, b, a, along((axis + 1) % 3, 8, w), near), 2);
    }
  // Beside it on each side, and beyond either end.
  const CagVec3 a = cag_vec3(0, 0, 0), b = cag_vec3(8, 4, 2);
  for (int side = 0; side < 6; side++) {
    const CagVec3 way = along(side % 3, side < 3 ? 1 : -1, 0);
    const CagVec3 less = cag_madd(a, 0.9 * near, way), more = cag_madd(a, 2 * near, way);
    assert_int_equal(kept(a, b, cag_add(a, less), cag_add(b, less), near), 1);
    assert_int_equal(kept(a, b, cag_add(a, more), cag_add(b, more), near), 2);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_plane_through_vertices_and_edges_gives_one_closed_curve),
      cmocka_unit_test(an_open_mesh_gives_open_curves_and_an_empty_one_none),
      cmocka_unit_test(triangles_on_one_edge_are_joined_in_order),
      cmocka_unit_test(meshes_that_are_no_surfaces_do_no_harm),
      cmocka_unit_test(solids_of_all_sizes_are_cut_alike),
      cmocka_unit_test(balls_give_exact_circles_at_every_height),
      cmocka_unit_test(a_closed_mesh_laid_on_a_surface_stays_closed),
      cmocka_unit_test(sheets_on_a_torus_keep_the_tolerance),
      cmocka_unit_test(principal_directions_are_square_and_of_unit_length),
      cmocka_unit_test(curves_that_run_along_another_are_dropped),
      cmocka_unit_test(sections_of_landscapes_are_the_pieces_in_their_triangles),
      cmocka_unit_test(sections_of_divided_cubes_have_no_points_on_flat_faces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
