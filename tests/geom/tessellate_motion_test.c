// The mesh of a shape does not depend on its location: after rigid motions up to ten thousand times
// its size away, the number of triangles is the same. Degenerate edges, double lines, and cusps are
// sensitive, because rounding makes quantities that vanish there nonzero.

#include "geom/surface/patches.h"
#include "geom/surface/quadric.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/support.h"

static uint64_t chance_state = 1;

// Park and Miller's generator, for the same motions on every machine.
static double between(double a, double b) {
  chance_state = chance_state * 48271 % 2147483647;
  return a + (b - a) * (double)chance_state / 2147483647;
}

// A random rotation (by a quaternion), and a translation of up to `away` along each axis.
static CagTransform motion(double away) {
  double q[4], length = 0;
  for (int k = 0; k < 4; k++) {
    q[k] = between(-1, 1);
    length += q[k] * q[k];
  }
  for (int k = 0; k < 4; k++) q[k] /= sqrt(length);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double turn[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
      {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
      {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)},
  };
  CagTransform t = cag_transform_identity();
  for (int i = 0; i < 3; i++) {
    memcpy(t.m[i], turn[i], sizeof turn[i]);
    t.m[i][3] = between(-away, away);
  }
  return t;
}

// --- Subjects ---

static CagSurface *exact(CagSurface *s) {
  CagSurface *n;
  OK(cag_surface_to_nurbs(s, &n, &err));
  cag_surface_release(s);
  return n;
}

static CagSurface *turned(CagCurve *profile) {
  CagSurface *s;
  OK(cag_surface_revolve(profile, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, &err));
  cag_curve_release(profile);
  return exact(s);
}

static CagSurface *cone(void) {
  const CagVec3 p[2] = {{16, 0, 0}, {0, 0, 34}};
  const double knots[4] = {0, 0, 1, 1};
  CagCurve *line;
  OK(cag_curve_nurbs(p, NULL, 2, 1, knots, 3, &line, &err));
  return turned(line);
}

static CagSurface *double_cone(void) {
  const CagVec3 p[3] = {{0, 0, -5}, {9, 0, 2}, {0, 0, 8}};
  const double knots[5] = {0, 0, 1, 2, 2};
  CagCurve *line;
  OK(cag_curve_nurbs(p, NULL, 3, 1, knots, 3, &line, &err));
  return turned(line);
}

static CagSurface *ball(void) {
  CagTransform frame = cag_transform_identity();
  CagSurface *s;
  for (int k = 0; k < 3; k++) frame.m[k][k] = 7;
  OK(cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, &s, &err));
  return exact(s);
}

static CagSurface *needle(void) {
  CagTransform frame = cag_transform_identity();
  CagSurface *s;
  frame.m[0][0] = 0.3;
  frame.m[2][2] = 12;
  OK(cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, &s, &err));
  return exact(s);
}

static CagSurface *patch(CagVec3 (*at)(int i, int j), bool rational) {
  const double weights[16] = {1, 2, 0.5, 1, 3, 1, 1, 0.3, 2, 1, 1, 0.7, 1, 0.6, 2, 1};
  CagVec3 net[16];
  CagSurface *s;
  for (int k = 0; k < 16; k++) net[k] = at(k / 4, k % 4);
  OK(cag_surface_bezier(net, rational ? weights : NULL, 4, 4, &s, &err));
  return s;
}

static CagVec3 plain(int i, int j) { return cag_vec3(3 * i, 3 * j, (i - 1.5) * (j - 1) * 2); }
static CagVec3 tip(int i, int j) { return i == 0 ? cag_vec3(0, 0, 2) : plain(i, j); }
static CagVec3 two_tips(int i, int j) {
  return i == 0 ? cag_vec3(0, 4, 2) : i == 3 ? cag_vec3(9, 4, -2) : plain(i, j);
}
static CagVec3 lens(int i, int j) {
  return j == 0 || j == 3 ? cag_vec3(3 * i, 4 + 2 * sin(i), 0) : plain(i, j);
}
static CagVec3 cusp_line(int i, int j) {
  const double x[4] = {0, 9, 0, 9}, z[4] = {0, 6, 6, 0};
  return cag_vec3(x[i], 3 * j, z[i] + 0.3 * j * j);
}
static CagVec3 double_corner(int i, int j) { return i < 2 && j < 2 ? plain(0, 0) : plain(i, j); }

static CagSurface *one_edge(void) { return patch(tip, false); }
static CagSurface *rational_edge(void) { return patch(tip, true); }
static CagSurface *two_edges(void) { return patch(two_tips, true); }
static CagSurface *two_lines(void) { return patch(lens, false); }
static CagSurface *cusps(void) { return patch(cusp_line, false); }
static CagSurface *corner(void) { return patch(double_corner, false); }

static CagSurface *triangle(void) {
  CagVec3 net[10];
  CagSurface *s;
  size_t k = 0;
  for (int i = 3; i >= 0; i--)
    for (int j = 3 - i; j >= 0; j--, k++)
      net[k] = cag_vec3(3 * j + 1.5 * (3 - i - j), 3 * (3 - i - j), 2 * sin(5.0 * (double)k));
  OK(cag_surface_bezier_triangle(net, 3, &s, &err));
  return s;
}

typedef struct Subject {
  const char *name;
  CagSurface *(*make)(void);
} Subject;

static const Subject subjects[] = {
    {"cone", cone},
    {"double cone", double_cone},
    {"ball", ball},
    {"needle", needle},
    {"an edge of one point", one_edge},
    {"a rational edge of one point", rational_edge},
    {"two edges of one point", two_edges},
    {"two edges that are one line", two_lines},
    {"cusps", cusps},
    {"a corner without tangents", corner},
    {"Bezier triangle", triangle},
};
enum { SUBJECTS = sizeof subjects / sizeof *subjects };

// --- Tests ---

static CagMesh *mesh_of(const CagSurface *s, double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  how.tolerance = tolerance;
  OK(cag_surface_tessellate(s, &how, &m, &err));
  return m;
}

static double size_of(const CagSurface *s) {
  CagBounds box;
  OK(cag_surface_bounds(s, &box, &err));
  return cag_norm(cag_sub(box.max, box.min));
}

static void motions_keep_the_number_of_triangles(void **state) {
  (void)state;
  const double shares[] = {1e-2, 1e-3, 1e-4},
               distances[] = {0, 1, 100, 1e4}; // relative to the size
  const double few = 0.03;
  enum { MOTIONS = 4 };
  chance_state = 4;
  for (size_t k = 0; k < SUBJECTS; k++) {
    CagSurface *s = subjects[k].make();
    double size = size_of(s);
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
      CagMesh *home = mesh_of(s, shares[i] * size);
      for (int n = 0; n < 4 * MOTIONS; n++) {
        CagTransform t = motion(distances[n % 4] * size);
        CagSurface *moved;
        OK(cag_surface_transform(s, &t, &moved, &err));
        CagMesh *m = mesh_of(moved, shares[i] * size);
        double change = (double)m->triangle_count / (double)home->triangle_count - 1;
        if (!(fabs(change) <= few))
          fail_msg("%s, tolerance %g of its size, %g sizes away: %zu triangles, not %zu",
                   subjects[k].name, shares[i], distances[n % 4], m->triangle_count,
                   home->triangle_count);
        cag_mesh_release(m);
        cag_surface_release(moved);
      }
      cag_mesh_release(home);
    }
    cag_surface_release(s);
  }
}

// If the triangles are the same, their normals rotate along, also at poles and cusps. The normals
// at the tip of a cone are evaluated at a distance of 1e-5 of the domain.
static void motions_turn_the_normals(void **state) {
  (void)state;
  chance_state = 8;
  for (size_t k = 0; k < SUBJECTS; k++) {
    CagSurface *s = subjects[k].make(), *moved;
    double size = size_of(s);
    CagMesh *home = mesh_of(s, 1e-3 * size);
    for (int n = 0; n < 6; n++) {
      double away = n % 2 ? 1e3 : 1;
      CagTransform t = motion(away * size);
      OK(cag_surface_transform(s, &t, &moved, &err));
      CagMesh *m = mesh_of(moved, 1e-3 * size);
      double worst = 0;
      assert_int_equal(m->vertex_count, home->vertex_count);
      for (size_t v = 0; v < m->vertex_count; v++) {
        CagVec3 a = cag_transform_vector(&t, home->normals[v]);
        worst = fmax(worst, cag_norm(cag_sub(a, m->normals[v])));
      }
      if (!(worst <= 1e-6))
        fail_msg("%s, %g sizes away: a normal is off by %g", subjects[k].name, away, worst);
      cag_mesh_release(m);
      cag_surface_release(moved);
    }
    cag_mesh_release(home);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(motions_keep_the_number_of_triangles),
      cmocka_unit_test(motions_turn_the_normals),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
