// Surfaces, open meshes and curves clipped by solids, against the equations of the solids.

#include "geom/solid/clip.h"

#include "geom/solid/csg.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// A solid and its equation, negative inside. The gradient of the equation has length 1 near the
// boundary.
typedef struct Cutter {
  int kind;
  double a;
  CagTransform back;
  CagSolid *solid;
} Cutter;

static double value_at(const Cutter *c, CagVec3 world) {
  const CagVec3 p = cag_transform_point(&c->back, world);
  const double a = c->a;
  switch (c->kind) {
  case 0: return cag_norm(p) - a;
  case 1: return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) - a;
  case 2: return p.z;
  case 3: return fmax(fabs(p.z) - a, hypot(p.x, p.y) - a);
  case 4: return fmax(cag_norm(p) - a, 0.5 * a - cag_norm(p)); // a shell
  default: return hypot(hypot(p.x, p.y) - a, p.z) - 0.4 * a;
  }
}

static Cutter cutter(int kind, double a) {
  const CagPlane level = {{0, 0, 0}, {0, 0, 1}};
  Cutter c = {.kind = kind, .a = a};
  CagSolid *s = NULL, *two[2];
  switch (kind) {
  case 0: OK(cag_solid_sphere(a, &s, &err)); break;
  case 1: OK(cag_solid_box(cag_vec3(2 * a, 2 * a, 2 * a), true, &s, &err)); break;
  case 2: OK(cag_solid_half_space(&level, &s, &err)); break;
  case 3: {
    CagSolid *up;
    const CagTransform down = cag_translate(cag_vec3(0, 0, -a));
    OK(cag_solid_cylinder(2 * a, a, a, &up, &err));
    OK(cag_solid_transform(up, &down, &s, &err));
    cag_solid_release(up);
    break;
  }
  case 4:
    OK(cag_solid_sphere(a, &two[0], &err));
    OK(cag_solid_sphere(0.5 * a, &two[1], &err));
    OK(cag_solid_combine(CAG_DIFFERENCE, two, 2, NULL, &s, &err));
    cag_solid_release(two[0]);
    cag_solid_release(two[1]);
    break;
  default: OK(cag_solid_torus(a, 0.4 * a, &s, &err)); break;
  }
  double angle[3], way[3];
  for (int i = 0; i < 3; i++) angle[i] = uniform(-3, 3);
  for (int i = 0; i < 3; i++) way[i] = uniform(-0.5, 0.5);
  const CagTransform turn = cag_rpy(angle[0], angle[1], angle[2]);
  const CagTransform lift = cag_translate(cag_vec3(way[0], way[1], way[2]));
  const CagTransform place = cag_transform_multiply(&lift, &turn);
  OK(cag_transform_inverse(&place, &c.back, &err));
  OK(cag_solid_transform(s, &place, &c.solid, &err));
  cag_solid_release(s);
  return c;
}

static CagSurface *patch(int kind) {
  CagSurface *s = NULL;
  const CagTransform same = cag_transform_identity();
  CagTransform frame;
  OK(cag_scale(cag_vec3(1.2, 0.8, 1), cag_vec3(0, 0, 0), &frame, &err));
  frame.planar = false;
  switch (kind) {
  case 0:
    OK(cag_surface_bilinear(cag_vec3(-2, -2, 0.1), cag_vec3(-2, 2, 0.3), cag_vec3(2, -2, -0.2),
                            cag_vec3(2, 2, 0.4), &s, &err));
    break;
  case 1:
    OK(cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &same, 0, 2 * M_PI, 0, M_PI, &s, &err));
    break;
  case 2:
    OK(cag_surface_quadric(CAG_SHAPE_ELLIPTIC_CYLINDER, &frame, 0.2, 5, -1.5, 1.5, &s, &err));
    break;
  default:
    OK(cag_surface_quadric(CAG_SHAPE_HYPERBOLIC_PARABOLOID, &same, -1.3, 1.4, -1.5, 1.2, &s, &err));
    break;
  }
  return s;
}

// The area inside, by a grid of midpoints.
static double area_within(const CagSurface *s, const Cutter *c) {
  const int n = 160;
  const double du = (s->u1 - s->u0) / n, dv = (s->v1 - s->v0) / n;
  double area = 0;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) {
      CagVec3 d[4];
      OK(cag_surface_eval(s, s->u0 + (i + 0.5) * du, s->v0 + (k + 0.5) * dv, 1, CAG_SIDE_RIGHT,
                          CAG_SIDE_RIGHT, d, &err));
      if (value_at(c, d[0]) < 0)
        area += cag_norm(cag_cross(d[cag_partial(1, 1, 0)], d[cag_partial(1, 0, 1)])) * du * dv;
    }
  return area;
}

static bool on_border(const CagSurface *s, const double uv[2]) {
  const double slack = 1e-9;
  return uv[0] - s->u0 < slack || s->u1 - uv[0] < slack || uv[1] - s->v0 < slack ||
         s->v1 - uv[1] < slack;
}

typedef struct Use {
  uint32_t low, high;
  int sense;
} Use;

static int by_edge(const void *a, const void *b) {
  const Use *p = a, *q = b;
  return p->low != q->low ? (p->low > q->low) - (p->low < q->low)
                          : (p->high > q->high) - (p->high < q->high);
}

// Checks that triangles meet at whole edges in opposite directions, except at the boundaries of the
// surface and the solid. Returns the longest edge at the boundary of the solid.
static double check_edges(const CagMesh *m, const CagSurface *s, const Cutter *c,
                          double tolerance) {
  const size_t n = 3 * m->triangle_count;
  double longest = 0;
  Use *uses = malloc((n + 1) * sizeof *uses);
  for (size_t i = 0; i < n; i++) {
    const uint32_t a = m->triangles[i], b = m->triangles[i - i % 3 + (i + 1) % 3];
    uses[i] = (Use){a < b ? a : b, a < b ? b : a, a < b ? 1 : -1};
  }
  qsort(uses, n, sizeof *uses, by_edge);
  for (size_t i = 0; i < n; i++) {
    size_t same = 1;
    int sum = uses[i].sense;
    while (i + same < n && by_edge(&uses[i], &uses[i + same]) == 0) sum += uses[i + same++].sense;
    assert_true(same <= 2);
    if (same == 2) assert_int_equal(sum, 0);
    const uint32_t ends[2] = {uses[i].low, uses[i].high};
    const CagVec3 p = m->positions[ends[0]], q = m->positions[ends[1]];
    const bool border = s && on_border(s, m->uv + 2 * ends[0]) && on_border(s, m->uv + 2 * ends[1]);
    if (same == 1 && !border) {
      for (int k = 0; k < 2; k++) NEAR(value_at(c, m->positions[ends[k]]), 0, 1e-7);
      // The chord satisfies the tolerance, which is relative to the size and the smallest radius.
      const double off = value_at(c, cag_lerp(p, q, 0.5));
      if (c->kind != 1 && c->kind != 3) NEAR(off, 0, (c->kind > 3 ? 4 : 1.5) * tolerance);
      longest = fmax(longest, cag_norm(cag_sub(p, q)));
    }
    i += same - 1;
  }
  free(uses);
  return longest;
}

static double size_of_common(const CagBounds *a, const CagBounds *b) {
  const CagVec3 low =
      cag_vec3(fmax(a->min.x, b->min.x), fmax(a->min.y, b->min.y), fmax(a->min.z, b->min.z));
  const CagVec3 high =
      cag_vec3(fmin(a->max.x, b->max.x), fmin(a->max.y, b->max.y), fmin(a->max.z, b->max.z));
  return cag_norm(cag_sub(high, low));
}

static void clipped_surfaces_are_the_parts_within(void **state) {
  (void)state;
  seed = 81;
  for (int k = 0; k < 48; k++) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagSurface *s = patch(k % 4);
    // Some are so small that they fit in one triangle of the plane.
    const Cutter c =
        cutter(k / 4 % 6, k % 4 == 0 && k >= 24 ? uniform(0.1, 0.2) : uniform(0.6, 1.1));
    CagMesh *m, *whole;
    how.tolerance = k % 2 ? 2e-3 : 1e-3;
    OK(cag_surface_clip(s, c.solid, &how, &m, &err));
    const double expected = area_within(s, &c);
    NEAR(cag_mesh_area(m), expected, 0.012 * fmax(expected, 0.3));
    for (size_t i = 0; i < m->vertex_count; i++) {
      CagVec3 p, n;
      const double *uv = m->uv + 2 * i;
      OK(cag_surface_point(s, uv[0], uv[1], &p, &err));
      near_vec(m->positions[i], p, 1e-12);
      assert_true(value_at(&c, p) < 1e-9);
      if (cag_surface_normal(s, uv[0], uv[1], &n, &err) == CAG_OK) near_vec(m->normals[i], n, 1e-9);
    }
    for (size_t i = 0; i < m->triangle_count; i++) {
      const uint32_t *t = m->triangles + 3 * i;
      const CagVec3 a = m->positions[t[0]], b = m->positions[t[1]], d = m->positions[t[2]];
      const CagVec3 face = cag_cross(cag_sub(b, a), cag_sub(d, a));
      const double least = 1e-7; // ignore slivers at the cut
      for (int j = 0; j < 3; j++)
        if (cag_norm(face) > least) assert_true(cag_dot(cag_unit(face), m->normals[t[j]]) > 0.5);
    }
    const double longest = check_edges(m, s, &c, how.tolerance);
    OK(cag_surface_tessellate(s, &how, &whole, &err));
    const CagBounds box = cag_mesh_bounds(whole);
    CagBounds reach;
    OK(cag_solid_reach(c.solid, &reach, &err));
    // The sagitta of a chord of a circle of the common size is the tolerance: c^2 / 4 = 2 t (d /
    // 2).
    const double chord = sqrt(2 * how.tolerance * size_of_common(&box, &reach));
    if (longest > 0 && expected > 0.05) {
      assert_true(longest < 1.05 * chord);
      assert_true(longest > 0.3 * chord);
    }
    cag_mesh_release(whole);
    cag_mesh_release(m);
    cag_surface_release(s);
    cag_solid_release(c.solid);
  }
}

// A roof in a ball: at the ridge, too, triangles have the normals of their own sides.
static void ridges_keep_both_normals(void **state) {
  (void)state;
  const CagVec3 profile[3] = {{-2, 0, -2}, {0, 0, 0}, {2, 0, -2}};
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagCurve *line;
  CagSurface *roof;
  CagSolid *ball;
  CagMesh *m;
  how.tolerance = 1e-3;
  OK(cag_curve_polyline(profile, 3, false, 3, &line, &err));
  OK(cag_surface_extrude(line, cag_vec3(0, 4, 0), 0, 1, &roof, &err));
  const CagTransform back = cag_translate(cag_vec3(0, -2, 0));
  CagSurface *centered;
  OK(cag_surface_transform(roof, &back, &centered, &err));
  OK(cag_solid_sphere(1, &ball, &err));
  OK(cag_surface_clip(centered, ball, &how, &m, &err));
  NEAR(cag_mesh_area(m), M_PI, 5e-3); // two half disks
  size_t left = 0;
  for (size_t i = 0; i < m->triangle_count; i++) {
    const uint32_t *t = m->triangles + 3 * i;
    const CagVec3 a = m->positions[t[0]];
    const CagVec3 n = cag_cross(cag_sub(m->positions[t[1]], a), cag_sub(m->positions[t[2]], a));
    left += n.x < 0;
    for (int k = 0; k < 3 && cag_norm(n) > 1e-9; k++) near_vec(m->normals[t[k]], cag_unit(n), 1e-6);
  }
  assert_true(left > 0 && left < m->triangle_count);
  cag_mesh_release(m);
  cag_solid_release(ball);
  cag_surface_release(roof);
  cag_surface_release(centered);
  cag_curve_release(line);
}

// A sheet of triangles whose corners are moved randomly within z = 0, and its outline.
static CagMesh *sheet(int n) {
  CagMesh *m;
  OK(cag_mesh_new((size_t)(n + 1) * (size_t)(n + 1), 2 * (size_t)n * (size_t)n, false, false, false,
                  &m, &err));
  uint32_t *t = m->triangles;
  for (int i = 0; i <= n; i++)
    for (int k = 0; k <= n; k++) {
      const bool inner = i > 0 && i < n && k > 0 && k < n;
      double x = 2.0 * i / n - 1, y = 2.0 * k / n - 1;
      if (inner) {
        x += uniform(-0.3, 0.3) / n;
        y += uniform(-0.3, 0.3) / n;
      }
      const uint32_t at = (uint32_t)(i * (n + 1) + k), next = at + (uint32_t)n + 1;
      m->positions[at] = cag_vec3(x, y, 0);
      if (i == n || k == n) continue;
      const uint32_t faces[6] = {at, next, next + 1, at, next + 1, at + 1};
      memcpy(t, faces, sizeof faces);
      t += 6;
    }
  return m;
}

// The area of the square [-1, 1]^2 where a x + b y + c < 0 (Sutherland and Hodgman 1974).
static double area_of_part(double a, double b, double c) {
  const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  double p[8][2], area = 0;
  int n = 0;
  for (int i = 0; i < 4; i++) {
    const double *u = corner[i], *v = corner[(i + 1) % 4];
    const double s = a * u[0] + b * u[1] + c, t = a * v[0] + b * v[1] + c;
    if (s < 0) p[n][0] = u[0], p[n++][1] = u[1];
    if ((s < 0) != (t < 0)) {
      p[n][0] = u[0] + s / (s - t) * (v[0] - u[0]);
      p[n++][1] = u[1] + s / (s - t) * (v[1] - u[1]);
    }
  }
  for (int i = 0; i < n; i++)
    area += (p[i][0] * p[(i + 1) % n][1] - p[(i + 1) % n][0] * p[i][1]) / 2;
  return area;
}

static void sheets_cut_by_planes_are_exact(void **state) {
  (void)state;
  seed = 82;
  for (int k = 0; k < 40; k++) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *flat = sheet(1 + k % 6), *m, *out;
    CagPlane plane;
    CagSolid *by;
    double n[3];
    for (int i = 0; i < 3; i++) n[i] = uniform(-1, 1);
    const double at = uniform(-0.9, 0.9);
    const double angle[3] = {n[0], n[1], n[2]};
    const CagTransform place = cag_rpy(angle[0], angle[1], angle[2]);
    OK(cag_plane(cag_transform_point(&place, cag_scaled(cag_vec3(n[0], n[1], n[2]), at)),
                 cag_transform_vector(&place, cag_vec3(n[0], n[1], n[2])), &plane, &err));
    OK(cag_mesh_transform(flat, &place, &m, &err));
    OK(cag_solid_half_space(&plane, &by, &err));
    how.tolerance = k % 2 ? 1e-2 : 0;
    OK(cag_mesh_clip(m, by, &how, &out, &err));
    const double c = -at * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    NEAR(cag_mesh_area(out), area_of_part(n[0], n[1], c), 1e-9);
    assert_null(out->uv);
    cag_mesh_release(out);
    cag_mesh_release(m);
    cag_mesh_release(flat);
    cag_solid_release(by);
  }
}

// The boundary belongs to the solid: a sheet of two triangles in the plane of a face of a box keeps
// the part inside the face, on either side along each axis.
static void sheets_in_the_plane_of_a_face_keep_it(void **state) {
  (void)state;
  const double half = 0.2, shift[2] = {0.11, -0.23};
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 1e-4;
  for (int axis = 0; axis < 3; axis++)
    for (int side = -1; side <= 1; side += 2) {
      CagMesh *flat = sheet(1), *out;
      CagSolid *at_origin, *by;
      double way[3];
      for (size_t i = 0; i < flat->vertex_count; i++) {
        const CagVec3 p = flat->positions[i];
        flat->positions[i] = axis == 0   ? cag_vec3(0, p.x, p.y)
                             : axis == 1 ? cag_vec3(p.y, 0, p.x)
                                         : cag_vec3(p.x, p.y, 0);
      }
      way[axis] = side * half;
      way[(axis + 1) % 3] = shift[0];
      way[(axis + 2) % 3] = shift[1];
      const CagTransform place = cag_translate(cag_vec3(way[0], way[1], way[2]));
      OK(cag_solid_box(cag_vec3(2 * half, 2 * half, 2 * half), true, &at_origin, &err));
      OK(cag_solid_transform(at_origin, &place, &by, &err));
      OK(cag_mesh_clip(flat, by, &how, &out, &err));
      // An edge shorter than the chord cuts off the corners.
      NEAR(cag_mesh_area(out), 4 * half * half, 2e-4);
      cag_mesh_release(out);
      cag_mesh_release(flat);
      cag_solid_release(at_origin);
      cag_solid_release(by);
    }
}

static void nothing_within_is_an_empty_mesh(void **state) {
  (void)state;
  seed = 83;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *flat = sheet(2), *out;
  CagSolid *ball;
  OK(cag_solid_sphere(0.5, &ball, &err));
  static const double WAYS[7][3] = {{9, 0, 0}, {-9, 0, 0}, {0, 9, 0},      {0, -9, 0},
                                    {0, 0, 9}, {0, 0, -9}, {1.4, 1.4, 0.1}};
  for (int i = 0; i < 7; i++) {
    const CagTransform t = cag_translate(cag_vec3(WAYS[i][0], WAYS[i][1], WAYS[i][2]));
    CagSolid *by;
    OK(cag_solid_transform(ball, &t, &by, &err));
    OK(cag_mesh_clip(flat, by, &how, &out, &err));
    assert_int_equal(out->triangle_count, 0);
    assert_true(!out->normals && !out->uv && !out->weld);
    cag_mesh_release(out);
    cag_solid_release(by);
  }
  // Limits and interrupts are respected.
  static volatile int stop = 1;
  how.max_triangles = 100;
  how.tolerance = 1e-5;
  assert_int_equal(cag_mesh_clip(flat, ball, &how, &out, &err), CAG_E_LIMIT);
  assert_string_equal(cag_error_info(err.id)->reason, "triangle-limit");
  how = CAG_TESSELLATION_DEFAULT;
  how.interrupt = &stop;
  assert_int_equal(cag_mesh_clip(flat, ball, &how, &out, &err), CAG_E_CALLBACK);
  assert_string_equal(cag_error_info(err.id)->reason, "interrupted");
  cag_mesh_release(flat);
  cag_solid_release(ball);
}

// Polylines and a ball: the expected pieces are from the roots of |a + t (b - a)|^2 = r^2.
static void clipped_polylines_are_exact(void **state) {
  (void)state;
  enum { CORNERS = 7 };
  seed = 84;
  for (int k = 0; k < 60; k++) {
    const double r = uniform(0.8, 1.2);
    CagVec3 p[CORNERS], at;
    CagCurve *line, **pieces;
    CagSolid *ball;
    size_t n, count = 0;
    double ends[2 * CORNERS][2];
    for (int i = 0; i < CORNERS; i++) {
      double x[3];
      for (int j = 0; j < 3; j++) x[j] = uniform(-1.5, 1.5);
      p[i] = cag_vec3(x[0], x[1], x[2]);
    }
    OK(cag_solid_sphere(r, &ball, &err));
    OK(cag_curve_polyline(p, CORNERS, false, 3, &line, &err));
    OK(cag_curve_clip(line, ball, NULL, &pieces, &n, &err));
    bool skip = false;
    for (int i = 0; i + 1 < CORNERS; i++) {
      const CagVec3 d = cag_sub(p[i + 1], p[i]);
      const double a = cag_dot(d, d), b = cag_dot(p[i], d), c = cag_dot(p[i], p[i]) - r * r;
      if (b * b <= a * c) continue;
      const double root = sqrt(b * b - a * c), low = fmax(0, (-b - root) / a),
                   high = fmin(1, (-b + root) / a);
      if (high - low > 0 && high - low < 0.01) skip = true; // may be missed
      if (!(high > low)) continue;
      if (low == 0 && count > 0 && ends[count - 1][1] == i) ends[count - 1][1] = i + high;
      else ends[count][0] = i + low, ends[count++][1] = i + high;
    }
    if (!skip) assert_int_equal(n, count);
    for (size_t i = 0; !skip && i < n; i++)
      for (int e = 0; e < 2; e++) {
        OK(cag_curve_point(pieces[i], e ? pieces[i]->end : pieces[i]->start, &at, &err));
        const int from = (int)fmin(floor(ends[i][e]), CORNERS - 2);
        near_vec(at, cag_lerp(p[from], p[from + 1], ends[i][e] - from), 1e-9);
      }
    for (size_t i = 0; i < n; i++) cag_curve_release(pieces[i]);
    free(pieces);
    // A curve that lies entirely inside is not changed.
    CagSolid *large;
    OK(cag_solid_sphere(9, &large, &err));
    OK(cag_curve_clip(line, large, NULL, &pieces, &n, &err));
    assert_int_equal(n, 1);
    assert_ptr_equal(pieces[0], line);
    cag_curve_release(pieces[0]);
    free(pieces);
    static volatile int stop = 1;
    assert_int_equal(cag_curve_clip(line, ball, &stop, &pieces, &n, &err), CAG_E_CALLBACK);
    cag_solid_release(large);
    cag_solid_release(ball);
    cag_curve_release(line);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(clipped_surfaces_are_the_parts_within),
      cmocka_unit_test(ridges_keep_both_normals),
      cmocka_unit_test(sheets_cut_by_planes_are_exact),
      cmocka_unit_test(sheets_in_the_plane_of_a_face_keep_it),
      cmocka_unit_test(nothing_within_is_an_empty_mesh),
      cmocka_unit_test(clipped_polylines_are_exact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
