// Meshes of shown items: tubes along curves, surfaces, and parts of meshes by material.

#include "interp/scene/item_mesh.h"
#include "interp/scene/scene.h"
#include "scene_checks.h"

// --- Tubes ---

static CagMesh *tube_of(const CagCurve *c, double radius, double dash) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m = NULL;
  OK(cag_curve_tube_mesh(c, radius, dash, &how, &m, &err));
  return m;
}

static const CagVec3 *sorted_positions;

static int by_position(const void *a, const void *b) {
  const CagVec3 *p = sorted_positions + *(const uint32_t *)a;
  const CagVec3 *q = sorted_positions + *(const uint32_t *)b;
  const double d[3] = {p->x - q->x, p->y - q->y, p->z - q->z};
  for (int k = 0; k < 3; k++)
    if (d[k] != 0) return d[k] < 0 ? -1 : 1;
  return 0;
}

typedef struct Edge {
  uint32_t low, high;
  int up; // 1: from low to high; -1 otherwise
} Edge;

static int by_ends(const void *a, const void *b) {
  const Edge *e = a, *f = b;
  if (e->low != f->low) return e->low < f->low ? -1 : 1;
  return e->high < f->high ? -1 : e->high > f->high;
}

// Whether each edge has two triangles, which traverse it in opposite directions.
static bool is_closed(const CagMesh *m) {
  const size_t n = 3 * m->triangle_count;
  uint32_t *order = malloc(m->vertex_count * sizeof *order);
  uint32_t *point = malloc(m->vertex_count * sizeof *point);
  Edge *edges = malloc(n * sizeof *edges);
  for (uint32_t v = 0; v < m->vertex_count; v++) order[v] = v;
  sorted_positions = m->positions;
  qsort(order, m->vertex_count, sizeof *order, by_position);
  for (size_t i = 0; i < m->vertex_count; i++)
    point[order[i]] =
        i > 0 && by_position(&order[i - 1], &order[i]) == 0 ? point[order[i - 1]] : order[i];
  for (size_t i = 0; i < n; i++) {
    const uint32_t a = point[m->triangles[i]], b = point[m->triangles[i % 3 == 2 ? i - 2 : i + 1]];
    edges[i] = (Edge){a < b ? a : b, a < b ? b : a, a < b ? 1 : -1};
  }
  qsort(edges, n, sizeof *edges, by_ends);
  bool good = n % 2 == 0;
  for (size_t i = 0; good && i + 1 < n; i += 2)
    good = by_ends(&edges[i], &edges[i + 1]) == 0 && edges[i].up + edges[i + 1].up == 0 &&
           (i + 2 == n || by_ends(&edges[i + 1], &edges[i + 2]) != 0);
  free(order);
  free(point);
  free(edges);
  return good;
}

// Checks that the mesh is closed, that its triangles have the orientation of the normals at their
// corners, that all vertices are used, and that no vertex is farther from the curve than `most`.
static void check_tube(const CagCurve *c, const CagMesh *m, double most) {
  assert_true(is_closed(m));
  bool *used = calloc(m->vertex_count, sizeof *used);
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 a = m->positions[k[0]];
    const CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    assert_true(cag_norm(n) > 0);
    for (int j = 0; j < 3; j++) {
      assert_true(cag_dot(n, m->normals[k[j]]) > 0);
      used[k[j]] = true;
    }
  }
  for (size_t v = 0; v < m->vertex_count; v++) {
    assert_true(used[v]);
    is_near(cag_norm(m->normals[v]), 1, 1e-9, "a normal's length");
    double least = INFINITY;
    CagVec3 before = {0, 0, 0};
    for (int i = 0; i <= 600; i++) {
      CagVec3 p;
      OK(cag_curve_eval(c, c->start + (c->end - c->start) * i / 600, 0, CAG_SIDE_LEFT, &p, &err));
      const CagVec3 d = i ? cag_sub(p, before) : cag_vec3(0, 0, 0);
      const double s = cag_dot(d, d);
      const double t = s > 0 ? cag_dot(cag_sub(m->positions[v], before), d) / s : 0;
      const CagVec3 q = i ? cag_madd(before, fmin(fmax(t, 0), 1), d) : p;
      least = fmin(least, cag_norm(cag_sub(m->positions[v], q)));
      before = p;
    }
    if (least > most) fail_msg("vertex %zu is %g off the curve", v, least);
  }
  free(used);
}

#define SECTION (6 * sin(M_PI / 6)) // of a dodecagon in a circle of radius 1

static void tubes_follow_curves_in_space(void **state) {
  (void)state;
  seed = 31;
  for (int round = 0; round < 12; round++) {
    CagCurve *c, *turned;
    CagTransform t;
    const double radius = 0.4;
    CagVec3 p[8];
    const double knots[] = {-3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7, 8};
    for (int i = 0; i < 8; i++) { // around a circle, up and down
      p[i].x = 20 * cos(2 * M_PI * i / 5);
      p[i].y = 20 * sin(2 * M_PI * i / 5);
      p[i].z = i % 5 == 1 ? 12 : i % 5 == 3 ? -9 : 2;
    }
    if (round % 3 == 0) OK(cag_curve_helix(15, 9, 2, 0, &c, &err));
    else if (round % 3 == 1) OK(cag_curve_bezier(p, NULL, 5, 3, &c, &err));
    else OK(cag_curve_nurbs(p, NULL, 8, 3, knots, 3, &c, &err));
    const CagVec3 axis = random_vec(1);
    OK(cag_rotate(axis, uniform(0, 6), cag_vec3(0, 0, 0), &t, &err));
    OK(cag_curve_transform(c, &t, &turned, &err));
    CagMesh *m = tube_of(turned, radius, 0);
    check_tube(turned, m, 1.1 * radius + 0.02);
    double length;
    OK(cag_curve_length(turned, turned->start, turned->end, &length, &err));
    const double volume = length * radius * radius * SECTION;
    is_near(volume_of(m), volume, 0.01 * volume, "volume");
    cag_mesh_release(m);
    cag_curve_release(c);
    cag_curve_release(turned);
  }
}

// The rings of a closed tube rotate relative to each other by the same small angle, including the
// last relative to the first.
static void closed_tubes_turn_evenly(void **state) {
  (void)state;
  CagVec3 p[10];
  double knots[14];
  for (int i = 0; i < 10; i++) {
    const double a = 2 * M_PI * (i % 7) / 7;
    p[i] = cag_vec3(20 * cos(a), 20 * sin(a), i % 7 == 1 ? 14 : i % 7 == 4 ? -11 : 3 * (i % 7 % 2));
  }
  for (int i = 0; i < 14; i++) knots[i] = i - 3;
  CagCurve *open, *c;
  OK(cag_curve_nurbs(p, NULL, 10, 3, knots, 3, &open, &err));
  c = open;
  if (!c->closed) fail_msg("the curve is not closed");
  CagMesh *m = tube_of(c, 0.5, 0);
  check_tube(c, m, 0.57);
  assert_int_equal(m->vertex_count % 12, 0);
  const size_t rings = m->vertex_count / 12;
  double least = INFINITY, most = -INFINITY;
  for (size_t i = 0; i < rings; i++) {
    const CagVec3 *a = m->normals + 12 * i, *b = m->normals + 12 * ((i + 1) % rings);
    // The mean rotation of all twelve vertices, seen along the ring's axis, does not depend on the
    // bend.
    double sum = 0;
    for (int k = 0; k < 12; k++) {
      const CagVec3 along = cag_unit(cag_cross(a[k], a[(k + 3) % 12]));
      sum += asin(cag_dot(cag_cross(a[k], b[k]), along));
    }
    least = fmin(least, sum / 12);
    most = fmax(most, sum / 12);
  }
  if (most - least > 0.005 || most > M_PI / (double)rings * 1.2 ||
      least < -M_PI / (double)rings * 1.2)
    fail_msg("rings turn by %g to %g", least, most);
  cag_mesh_release(m);
  cag_curve_release(c);
}

// Dashes along a line with arbitrary points: all vertices are in dashes, and both ends of each dash
// have a cap.
static void dashes_are_where_they_belong(void **state) {
  (void)state;
  seed = 33;
  for (int round = 0; round < 20; round++) {
    CagVec3 p[12];
    CagCurve *c;
    double x = 0;
    const int n = 2 + round % 10;
    for (int i = 0; i < n; i++) {
      p[i] = cag_vec3(x, 0, 0);
      x += uniform(0.5, 20);
    }
    const double length = p[n - 1].x, dash = uniform(0.5, length / 3), radius = 0.1;
    const double steps = 2 * floor((floor(length / dash) - 1) / 2) + 1, step = length / steps;
    OK(cag_curve_polyline(p, (size_t)n, false, 3, &c, &err));
    CagMesh *m = tube_of(c, radius, dash);
    check_tube(c, m, radius * (1 + 1e-9));
    size_t caps = 0;
    for (size_t v = 0; v < m->vertex_count; v++) {
      const CagVec3 q = m->positions[v];
      const double at = q.x / step, dashes = floor(at / 2 + 1e-9);
      assert_true(at - 2 * dashes > -1e-6 && at - 2 * dashes < 1 + 1e-6);
      if (hypot(q.y, q.z) > 1e-9) continue;
      caps++;
      assert_true(fabs(at - (double)lround(at)) < 1e-6);
      is_near(m->normals[v].x, lround(at) % 2 ? 1 : -1, 1e-9, "the side of a cap");
    }
    assert_int_equal(caps, (size_t)steps + 1);
    is_near(volume_of(m), (steps + 1) / 2 * step * radius * radius * SECTION, 1e-9 * length,
            "volume");
    cag_mesh_release(m);
    cag_curve_release(c);
  }
}

static double turn_at(CagVec3 a, CagVec3 b, CagVec3 c) {
  const CagVec3 t = cag_unit(cag_sub(b, a)), u = cag_unit(cag_sub(c, b));
  return atan2(cag_norm(cag_cross(t, u)), cag_dot(t, u));
}

// The volume that a corner adds to two tubes of radius 1 that end at it. A wedge in steps of at
// most 30 degrees fills the outer side: each step adds sin(step) / 2 times the integral of the
// squared width of half a section. The bisecting plane cuts both tubes on the inner side: each
// loses the first moment of that half times the tangent of half the turning angle.
static double corner_volume(double turn) {
  double moment = 0, squares = 0;
  const double steps = ceil(turn * 6 / M_PI - 1e-9);
  for (int k = -3; k < 3; k++) {
    const double a = M_PI * k / 6, b = M_PI * (k + 1) / 6;
    const double x0 = cos(a), y0 = sin(a), x1 = cos(b), y1 = sin(b);
    moment += (x0 * y1 - x1 * y0) / 2 * (x0 + x1) / 3;
    squares += (y1 - y0) * (x0 * x0 + x0 * x1 + x1 * x1) / 3;
  }
  return steps * sin(turn / steps) / 2 * squares - 2 * moment * tan(turn / 2);
}

// Polylines with corners of 30 to 160 degrees, open and closed. In a plane, the sides of tubes do
// not rotate. In space, they rotate by at most half the angle of a side, which hardly changes their
// volume.
static void corners_of_any_angle_are_closed(void **state) {
  (void)state;
  seed = 34;
  int tried[2] = {0, 0};
  for (int round = 0; round < 300; round++) {
    enum { N = 5 };
    CagVec3 p[N];
    CagCurve *c;
    const double radius = 0.5;
    const bool closed = round % 2, flat = round % 4 < 2;
    const CagVec3 x = random_vec(1), y = random_vec(1);
    for (int i = 0; i < N; i++) {
      CagVec3 d = random_vec(1);
      if (flat) d = cag_add(cag_scaled(x, d.x), cag_scaled(y, d.y));
      p[i] = i ? cag_madd(p[i - 1], uniform(10, 20), cag_unit(d)) : d;
    }
    double length = 0, corners = 0, least = 10, most = 0;
    for (int i = 1; i < N + closed; i++) {
      const double segment = cag_norm(cag_sub(p[i % N], p[i - 1]));
      length += segment;
      if (!closed && i == N - 1) continue;
      const double turn = turn_at(p[i - 1], p[i % N], p[(i + 1) % N]);
      corners += corner_volume(turn);
      least = fmin(fmin(least, turn), segment < 5 ? 0 : 10);
      most = fmax(most, turn);
    }
    if (least < M_PI / 6 || most > 160 * M_PI / 180) continue;
    OK(cag_curve_polyline(p, N, closed, 3, &c, &err));
    CagMesh *m = tube_of(c, radius, 0);
    check_tube(c, m, 6 * radius);
    const double volume = length * radius * radius * SECTION + corners * pow(radius, 3);
    is_near(volume_of(m), volume, (flat ? 1e-9 : 0.04) * volume, "volume");
    cag_mesh_release(m);
    cag_curve_release(c);
    tried[flat]++;
  }
  assert_true(tried[0] > 10 && tried[1] > 10);
}

// A closed square of 4 times 10 with dashes of 3: thirteen fit, so twelve steps are alternately
// dashes and gaps. Each dash has caps where it meets a gap.
static void dashes_of_a_square_go_around(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  CagCurve *c;
  OK(cag_curve_polyline(p, 4, true, 3, &c, &err));
  CagMesh *m = tube_of(c, 0.1, 3);
  check_tube(c, m, 0.2);
  int caps = 0;
  for (uint32_t v = 0; v < m->vertex_count; v++) {
    int uses = 0;
    for (size_t k = 0; k < 3 * m->triangle_count; k++) uses += m->triangles[k] == v;
    if (uses != 12) continue; // the center of a cap
    const CagVec3 q = m->positions[v];
    const double at = fabs(q.y) < 1e-9        ? q.x
                      : fabs(q.x - 10) < 1e-9 ? 10 + q.y
                      : fabs(q.y - 10) < 1e-9 ? 30 - q.x
                                              : 40 - q.y;
    const double steps = at / (40.0 / 12);
    if (fabs(steps - (double)lround(steps)) > 1e-6) fail_msg("a cap at %g", at);
    caps++;
  }
  assert_int_equal(caps, 12);
  cag_mesh_release(m);
  cag_curve_release(c);
}

// Tubes with any number of points: a ring of 12 for each point, and caps of 13 vertices at open
// ends.
static void tubes_of_every_count_have_their_rings(void **state) {
  (void)state;
  enum { MOST = 180 };
  for (size_t n = 2; n <= MOST; n++) {
    CagVec3 p[MOST];
    CagCurve *c;
    for (int closed = n > 14; closed >= 0;
         closed--) { // a polygon of 15 corners turns by 24 degrees
      const double part = 2 * M_PI / (double)(closed ? n : MOST);
      for (size_t i = 0; i < n; i++)
        p[i] = cag_vec3(90 * cos(part * (double)i), 90 * sin(part * (double)i), 0);
      OK(cag_curve_polyline(p, n, closed, 3, &c, &err));
      CagMesh *m = tube_of(c, 0.5, 0);
      assert_int_equal(m->vertex_count, closed ? 12 * n : 12 * n + 26);
      assert_int_equal(m->triangle_count, closed ? 24 * n : 24 * n);
      // The section is a polygon of 12 corners, and the path is that of its centers.
      const double section = 3 * 0.5 * 0.5, length = 2 * 90 * sin(part / 2) * (double)(n - !closed);
      is_near(volume_of(m), section * length, 0.03 * section * length, "volume");
      cag_mesh_release(m);
      cag_curve_release(c);
    }
    // A comb of right angles, with a joint at each corner.
    for (size_t i = 0; i < n; i++)
      p[i] = cag_vec3(9 * (double)(i / 2), 9 * (double)((i + 1) / 2 % 2), 0);
    OK(cag_curve_polyline(p, n, false, 3, &c, &err));
    CagMesh *m = tube_of(c, 0.5, 0);
    // Two rings, and two rows of five inside the wedge. A step has two triangles at the ends of the
    // wedge, and four elsewhere.
    const size_t corners = n - 2;
    assert_int_equal(m->vertex_count, 50 + corners * (24 + 10));
    assert_int_equal(m->triangle_count, 24 * (n - 1) + 24 + corners * 3 * 10);
    cag_mesh_release(m);
    cag_curve_release(c);
  }
}

// From an end to the only corner, the rings do not rotate: the sides are parallel to the tube.
static void tubes_with_one_corner_do_not_twist(void **state) {
  (void)state;
  seed = 21;
  for (int round = 0; round < 40; round++) {
    enum { STEPS = 4, N = 2 * STEPS + 1 };
    CagVec3 p[N], along[2];
    do {
      along[0] = cag_unit(random_vec(1));
      along[1] = cag_unit(random_vec(1));
    } while (fabs(cag_dot(along[0], along[1])) > 0.8);
    for (int i = 0; i < N; i++) p[i] = cag_scaled(along[i > STEPS], 10 * (i - STEPS));
    CagCurve *c;
    OK(cag_curve_polyline(p, N, false, 3, &c, &err));
    CagMesh *m = tube_of(c, 0.5, 0);
    check_tube(c, m, 3);
    size_t sides = 0;
    for (size_t t = 0; t < m->triangle_count; t++) {
      double straight = 0, longest = 0;
      for (int j = 0; j < 3; j++) {
        const CagVec3 a = m->positions[m->triangles[3 * t + (size_t)j]],
                      b = m->positions[m->triangles[3 * t + (size_t)(j + 1) % 3]];
        const CagVec3 d = cag_sub(b, a);
        const double length = cag_norm(d);
        longest = fmax(longest, length);
        for (int k = 0; k < 2; k++)
          if (length > 3) straight = fmax(straight, fabs(cag_dot(d, along[k])) / length);
      }
      if (longest <= 3) continue;
      sides++;
      is_near(straight, 1, 1e-12, "direction of a side");
    }
    assert_int_equal(sides, 24 * 2 * STEPS);
    cag_mesh_release(m);
    cag_curve_release(c);
  }
}

// A limit equal to the number of triangles is accepted, and one less is not.
static void the_limit_of_triangles_is_exact(void **state) {
  (void)state;
  static const CagVec3 line[] = {{0, 0, 0}, {5, 0, 0}},
                       corner[] = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}};
  static const CagVec3 back[] = {{0, 0, 0}, {9, 0, 0}, {3, 0, 0}};
  static const CagVec3 square[] = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 3}};
  const CagTransform frame = cag_transform_identity();
  for (int k = 0; k < 6; k++) {
    CagCurve *c;
    if (k == 0) OK(cag_curve_polyline(line, 2, false, 3, &c, &err));
    else if (k == 1) OK(cag_curve_polyline(corner, 3, false, 3, &c, &err));
    else if (k == 2) OK(cag_curve_polyline(back, 3, false, 3, &c, &err));
    else if (k == 3) OK(cag_curve_polyline(square, 4, true, 3, &c, &err));
    else OK(cag_curve_arc(9, 9, 0, k == 4 ? 2 * M_PI : 3, &frame, &c, &err));
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m, *again = NULL;
    CagError err = {0};
    OK(cag_curve_tube_mesh(c, 0.1, 0, &how, &m, &err));
    how.max_triangles = m->triangle_count;
    OK(cag_curve_tube_mesh(c, 0.1, 0, &how, &again, &err));
    cag_mesh_release(again);
    how.max_triangles--;
    assert_int_equal(cag_curve_tube_mesh(c, 0.1, 0, &how, &again, &err), CAG_E_LIMIT);
    assert_string_equal(cag_error_info(err.id)->reason, "triangle-limit");
    cag_mesh_release(m);
    cag_curve_release(c);
  }
}

// Closed surfaces and meshes are converted to meshes that are oriented outward; open ones keep
// their orientation.
static void surfaces_become_meshes(void **state) {
  (void)state;
  CagSession *session = shown("s = sphere_surface(2)\n"
                              "show s, flip(s), bilinear([0,0,0], [0,1,0], [1,0,0], [1,1,0]), "
                              "translate(rectangle(2, 3), [0, 0, 5]), sun(-Z)");
  static const double volumes[] = {32 * M_PI / 3, 32 * M_PI / 3, 0, 0};
  for (size_t i = 0; i < 4; i++) {
    CagMesh *m;
    OK(cag_item_mesh(&session->scene, &session->scene.items[i], &m, &err));
    if (i < 2) is_near(volume_of(m), volumes[i], 0.02 * volumes[i], "volume");
    double area = 0;
    for (size_t t = 0; t < m->triangle_count; t++) {
      const uint32_t *k = m->triangles + 3 * t;
      const CagVec3 a = m->positions[k[0]];
      area +=
          cag_norm(cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a))) / 2;
      if (i == 3) assert_true(a.z == 5);
    }
    static const double areas[] = {16 * M_PI, 16 * M_PI, 1, 6};
    is_near(area, areas[i], 0.02 * areas[i], "area");
    cag_mesh_release(m);
  }
  cag_session_free(session);
}

// The default width of lines is a fraction of the diagonal of the scene.
static void lines_have_a_width_by_the_scene(void **state) {
  (void)state;
  CagScene s = {.bounds = {{0, 0, 0}, {30, 40, 0}}};
  CagItem item = {.kind = CAG_ITEM_CURVE};
  is_near(cag_item_line_radius(&s, &item), 0.0025 * 50, 1e-12, "by the diagonal");
  item.line_radius = 3;
  assert_true(cag_item_line_radius(&s, &item) == 3);
  item.line_radius = 0;
  s.bounds = CAG_BOUNDS_EMPTY;
  is_near(cag_item_line_radius(&s, &item), 0.25, 1e-12, "of an empty scene");
  s.bounds = (CagBounds){{1, 1, 1}, {1, 1, 1}};
  is_near(cag_item_line_radius(&s, &item), 0.25, 1e-12, "of a point");
}

// --- Parts of meshes ---

// Each triangle is in the part of its label's material, with all data of its corners. Welded
// vertices remain welded.
static void parts_of_a_mesh_have_its_triangles(void **state) {
  (void)state;
  seed = 35;
  for (int features = 0; features < 8; features++) {
    enum { V = 40, T = 60 };
    CagMesh *m;
    const bool normals = features & 1, uv = features & 2, weld = features & 4;
    OK(cag_mesh_new(V, T, normals, uv, weld, &m, &err));
    m->scale = (CagColorScale){CAG_SCALE_STRIPES, 1, 2, 3};
    m->labels = malloc(T * sizeof *m->labels);
    for (uint32_t v = 0; v < V; v++) {
      m->positions[v] = random_vec(9);
      if (weld) m->weld[v] = v > 3 && v % 3 == 0 ? m->weld[v / 3] : v;
      if (weld) m->positions[v] = m->positions[m->weld[v]];
      if (normals) m->normals[v] = cag_unit(random_vec(1));
      if (uv) m->uv[2 * v] = uniform(0, 1);
      if (uv) m->uv[2 * v + 1] = uniform(0, 1);
    }
    for (size_t t = 0; t < T; t++) {
      m->labels[t] = (uint32_t)uniform(0, 4.999);
      for (size_t j = 0; j < 3; j++) m->triangles[3 * t + j] = (uint32_t)((7 * t + 13 * j) % V);
    }
    CagItemLabel labels[] = {{1, 4}, {3, 5}};
    const CagItem item = {.material = 3, .labels = labels, .label_count = 2};
    static const size_t material_of[] = {3, 4, 3, 5, 3}; // by label
    size_t seen = 0;
    for (size_t material = 2; material < 7; material++) {
      CagMesh *part;
      OK(cag_item_mesh_of(&item, m, material, &part, &err));
      assert_true(part->scale.kind == CAG_SCALE_STRIPES && part->scale.to == 2);
      size_t n = 0;
      uint32_t from[V];
      memset(from, 0xff, sizeof from);
      for (size_t t = 0; t < T; t++) {
        if (material_of[m->labels[t]] != material) continue;
        assert_true(n < part->triangle_count);
        for (size_t j = 0; j < 3; j++) {
          const uint32_t a = m->triangles[3 * t + j], b = part->triangles[3 * n + j];
          assert_true(b < part->vertex_count);
          assert_true(from[b] == UINT32_MAX || from[b] == a); // a vertex remains one vertex
          from[b] = a;
          is_point(part->positions[b], m->positions[a], "position");
          if (normals) is_point(part->normals[b], m->normals[a], "normal");
          if (uv) assert_memory_equal(part->uv + 2 * b, m->uv + 2 * a, 2 * sizeof *m->uv);
        }
        n++;
      }
      assert_int_equal(part->triangle_count, n);
      seen += n;
      for (uint32_t b = 0; b < part->vertex_count; b++) {
        assert_true(from[b] != UINT32_MAX);
        for (uint32_t a = 0; a < b; a++) assert_true(from[a] != from[b]);
        uint32_t first = 0;
        while (weld && m->weld[from[first]] != m->weld[from[b]]) first++;
        if (weld) assert_int_equal(part->weld[b], first);
      }
      assert_true((part->normals != NULL) == normals && (part->uv != NULL) == uv);
      assert_true((part->weld != NULL) == weld);
      cag_mesh_release(part);
    }
    assert_int_equal(seen, T);
    cag_mesh_release(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tubes_follow_curves_in_space),
      cmocka_unit_test(closed_tubes_turn_evenly),
      cmocka_unit_test(dashes_are_where_they_belong),
      cmocka_unit_test(corners_of_any_angle_are_closed),
      cmocka_unit_test(dashes_of_a_square_go_around),
      cmocka_unit_test(tubes_of_every_count_have_their_rings),
      cmocka_unit_test(tubes_with_one_corner_do_not_twist),
      cmocka_unit_test(the_limit_of_triangles_is_exact),
      cmocka_unit_test(surfaces_become_meshes),
      cmocka_unit_test(lines_have_a_width_by_the_scene),
      cmocka_unit_test(parts_of_a_mesh_have_its_triangles),
  };
  return cmocka_run_group_tests_name("item_mesh", tests, NULL, NULL);
}
