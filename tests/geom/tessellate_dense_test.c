// Tessellation guarantees, by dense sampling of difficult surfaces: all points are within the
// tolerance of the mesh, vertices are on the surface with its normals and parameters, and the mesh
// is complete.

#include "geom/surface/function.h"
#include "geom/surface/patches.h"
#include "geom/surface/quadric.h"
#include "geom/surface/reshape.h"
#include "geom/tessellate/tessellate.h"
#include "tests/geom/dense_support.h"
#include "tests/geom/function_support.h"

static double smallest_angle(const CagMesh *m) {
  double least = M_PI;
  for (size_t t = 0; t < m->triangle_count; t++)
    for (size_t k = 0; k < 3; k++) {
      CagVec3 a = m->positions[m->triangles[3 * t + k]];
      CagVec3 x = cag_sub(m->positions[m->triangles[3 * t + (k + 1) % 3]], a);
      CagVec3 y = cag_sub(m->positions[m->triangles[3 * t + (k + 2) % 3]], a);
      least = fmin(least, atan2(cag_norm(cag_cross(x, y)), cag_dot(x, y)));
    }
  return least;
}

// The typical tolerance, for which angles are checked.
#define TYPICAL 1e-2
static const double tolerances[] = {1, TYPICAL, 1e-3, 1e-4};

typedef struct Subject {
  const char *name;
  CagSurface *(*make)(void);
  long euler;              // of the mesh
  bool smooth;             // it has a continuous normal everywhere
  double finest, coarsest; // tolerances
  double angle_least;      // degrees; smallest angle of triangles at the typical tolerance
} Subject;

// --- Subjects: nets ---

static CagSurface *spline(const CagVec3 *net, const double *weights, size_t n) {
  double knots[32];
  CagSurface *s;
  for (size_t k = 0; k < n + 4; k++) knots[k] = fmin(fmax((double)k - 3, 0), (double)n - 3);
  OK(cag_surface_nurbs(net, weights, n, n, 3, 3, knots, knots, &s, &err));
  return s;
}

static CagSurface *ridge(void) {
  CagVec3 net[144];
  for (int i = 0; i < 12; i++)
    for (int j = 0; j < 12; j++) {
      double along = i == 6 ? 8 : 0;
      net[12 * i + j] = cag_vec3(i == 5 ? 5.9 : i == 7 ? 6.1 : i, j, along + 0.2 * sin(j));
    }
  return spline(net, NULL, 12);
}

static CagSurface *wild_weights(void) {
  CagVec3 net[49];
  double weights[49];
  chance_state = 11;
  for (int k = 0; k < 49; k++) {
    net[k] = cag_vec3(k / 7, k % 7, between(-1, 1));
    weights[k] = pow(10, between(-3, 3));
  }
  return spline(net, weights, 7);
}

static CagSurface *patch(CagVec3 (*at)(int i, int j), const double *weights) {
  CagVec3 net[16];
  CagSurface *s;
  for (int k = 0; k < 16; k++) net[k] = at(k / 4, k % 4);
  OK(cag_surface_bezier(net, weights, 4, 4, &s, &err));
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
static CagVec3 heap(int i, int j) { return i % 3 && j % 3 ? cag_vec3(4.5, 4.5, 5) : plain(i, j); }
static CagVec3 cusp_line(int i, int j) {
  const double x[4] = {0, 9, 0, 9}, z[4] = {0, 6, 6, 0};
  return cag_vec3(x[i], 3 * j, z[i] + 0.3 * j * j);
}
static CagVec3 double_corner(int i, int j) { return i < 2 && j < 2 ? plain(0, 0) : plain(i, j); }

static CagSurface *pole_patch(void) { return patch(tip, NULL); }
static CagSurface *two_poles(void) { return patch(two_tips, NULL); }
static CagSurface *two_lines(void) { return patch(lens, NULL); }
static CagSurface *coincident(void) { return patch(heap, NULL); }
static CagSurface *cusps(void) { return patch(cusp_line, NULL); }
static CagSurface *flat_corner(void) { return patch(double_corner, NULL); }
static CagSurface *steep_weights(void) {
  const double w[16] = {1, 1e3, 1e-3, 1, 1e-3, 1, 1, 1e3, 1e3, 1, 1, 1e-3, 1, 1e-3, 1e3, 1};
  return patch(plain, w);
}

static CagSurface *periodic(void) {
  CagVec3 net[40];
  CagSurface *s;
  for (int i = 0; i < 8; i++)
    for (int j = 0; j < 5; j++) {
      double a = i * M_PI / 4, b = j * 2 * M_PI / 5, r = 10 + (3 + i % 2) * cos(b);
      net[5 * i + j] = cag_vec3(r * cos(a), r * sin(a), (3 + i % 3) * sin(b));
    }
  OK(cag_surface_nurbs_closed(net, NULL, 8, 5, 3, 3, NULL, NULL, true, true, &s, &err));
  return s;
}

static CagSurface *triangle(void) {
  CagVec3 net[10];
  CagSurface *s;
  chance_state = 5;
  size_t k = 0;
  for (int i = 3; i >= 0; i--)
    for (int j = 3 - i; j >= 0; j--, k++)
      net[k] = cag_vec3(3 * j + 1.5 * (3 - i - j), 3 * (3 - i - j), between(-2, 2));
  OK(cag_surface_bezier_triangle(net, 3, &s, &err));
  return s;
}

// --- Subjects: made of curves ---

static CagCurve *bow(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d) {
  const CagVec3 p[4] = {a, b, c, d};
  CagCurve *out;
  OK(cag_curve_bezier(p, NULL, 4, 3, &out, &err));
  return out;
}

static CagSurface *coons(void) {
  CagVec3 p00 = {0, 0, 0}, p10 = {10, 0, 1}, p01 = {0, 10, 2}, p11 = {10, 10, -3};
  // u = 0, u = 1, v = 0, v = 1
  CagCurve *c[4] = {bow(p00, cag_vec3(0, 3, 5), cag_vec3(0, 7, -4), p01),
                    bow(p10, cag_vec3(9, 3, 5), cag_vec3(12, 7, 0), p11),
                    bow(p00, cag_vec3(3, 1, 4), cag_vec3(7, -1, 4), p10),
                    bow(p01, cag_vec3(3, 10, -6), cag_vec3(7, 12, 4), p11)};
  CagSurface *s;
  OK(cag_surface_coons(c[0], c[1], c[2], c[3], &s, &err));
  for (int k = 0; k < 4; k++) cag_curve_release(c[k]);
  return s;
}

static CagSurface *twisted_rule(void) {
  CagCurve *a = bow(cag_vec3(0, 0, 0), cag_vec3(5, 5, 0), cag_vec3(5, -5, 0), cag_vec3(10, 0, 0)),
           *b = bow(cag_vec3(9, 1, 8), cag_vec3(5, -5, 9), cag_vec3(5, 5, 9), cag_vec3(1, -1, 8));
  CagSurface *s;
  OK(cag_surface_ruled(a, b, &s, &err));
  cag_curve_release(a);
  cag_curve_release(b);
  return s;
}

static CagSurface *tight_tube(void) {
  CagCurve *path;
  CagSurface *s;
  OK(cag_curve_helix(2, 1.5, 6, 0.1, &path, &err));
  OK(cag_surface_tube(path, 0.6, &s, &err));
  cag_curve_release(path);
  return s;
}

// The tube's radius exceeds the radius of curvature of its path, so it intersects itself.
static CagSurface *fat_tube(void) {
  CagCurve *path;
  CagSurface *s;
  OK(cag_curve_helix(1, 6, 3, 0, &path, &err));
  OK(cag_surface_tube(path, 2, &s, &err));
  cag_curve_release(path);
  return s;
}

static CagSurface *turned(CagCurve *profile) {
  CagSurface *s;
  OK(cag_surface_revolve(profile, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, &err));
  cag_curve_release(profile);
  return s;
}

static CagSurface *wiggly_revolution(void) {
  enum { N = 40 };
  CagVec3 p[N];
  double knots[N + 4];
  CagCurve *c;
  for (int k = 0; k < N; k++) p[k] = cag_vec3(k == 0 ? 0 : 5 + 1.5 * (k % 2) + sin(k), 0, 0.5 * k);
  for (int k = 0; k < N + 4; k++) knots[k] = fmin(fmax(k - 3, 0), N - 3);
  OK(cag_curve_nurbs(p, NULL, N, 3, knots, 3, &c, &err));
  return turned(c);
}

static CagSurface *ball(void) {
  CagTransform frame = cag_transform_identity();
  frame.m[1][1] = 0;
  frame.m[2][1] = 1;
  frame.m[1][2] = -1;
  frame.m[2][2] = 0;
  CagCurve *c;
  OK(cag_curve_arc(10, 10, -M_PI / 2, M_PI / 2, &frame, &c, &err));
  return turned(c);
}

static CagSurface *spun_twist(void) {
  CagTransform frame = cag_transform_identity();
  frame.planar = true;
  CagCurve *c;
  CagSurface *s;
  OK(cag_curve_arc(3, 2, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_surface_extrude(c, cag_vec3(0, 0, 20), 6 * M_PI, 0.4, &s, &err));
  cag_curve_release(c);
  return s;
}

static CagSurface *quadric(CagQuadricShape shape, double a, double b, double c, double u0,
                           double u1, double v0, double v1) {
  CagTransform frame = cag_transform_identity();
  frame.m[0][0] = a;
  frame.m[1][1] = b;
  frame.m[2][2] = c;
  CagSurface *s;
  OK(cag_surface_quadric(shape, &frame, u0, u1, v0, v1, &s, &err));
  return s;
}

static CagSurface *needle(void) {
  return quadric(CAG_SHAPE_ELLIPSOID, 0.3, 1, 12, 0, 2 * M_PI, 0, M_PI);
}
static CagSurface *disc_like(void) {
  return quadric(CAG_SHAPE_ELLIPSOID, 12, 8, 0.2, 0, 2 * M_PI, 0, M_PI);
}
static CagSurface *sheet(void) {
  return quadric(CAG_SHAPE_HYPERBOLOID_TWO, 1, 0.5, 2, 0, 2 * M_PI, 0, 3);
}
static CagSurface *waist(void) {
  return quadric(CAG_SHAPE_HYPERBOLOID_ONE, 1, 2, 2, 0, 2 * M_PI, -2, 2);
}
static CagSurface *full_cone(void) { return quadric(CAG_SHAPE_CONE, 3, 2, 6, 0, 2 * M_PI, 0, 2); }
static CagSurface *bowl(void) {
  return quadric(CAG_SHAPE_ELLIPTIC_PARABOLOID, 3, 1, 2, 0, 2 * M_PI, 0, 2);
}
static CagSurface *saddle(void) {
  return quadric(CAG_SHAPE_HYPERBOLIC_PARABOLOID, 3, 2, 1, -2, 2, -2, 2);
}

// --- Subjects: functions ---

typedef void Formula(double u, double v, CagVec3 *p);

// Partial derivatives by differences, with a step that loses at most half of the digits.
static CagStatus formula_eval(void *context, double u, double v, int n, CagVec3 *out, CagError *e) {
  const double h = 1e-6;
  Formula *f = *(Formula **)context;
  CagVec3 p[2];
  (void)e;
  if (n > 2)
    return cag_fail(e, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "only second partials");
  f(u, v, &out[0]);
  if (n == 0) return CAG_OK;
  f(u + h, v, &p[0]);
  f(u - h, v, &p[1]);
  out[cag_partial(n, 1, 0)] = cag_scaled(cag_sub(p[0], p[1]), 0.5 / h);
  f(u, v + h, &p[0]);
  f(u, v - h, &p[1]);
  out[cag_partial(n, 0, 1)] = cag_scaled(cag_sub(p[0], p[1]), 0.5 / h);
  for (int k = 0; n > 1 && k < 3; k++) {
    const double w = 1e-4, x = k < 2 ? w : 0, y = k > 0 ? w : 0;
    CagVec3 q[4];
    f(u + x, v + y, &q[0]);
    f(u + (k == 1 ? x : 0), v - (k == 1 ? y : 0), &q[1]);
    f(u - (k == 1 ? x : 0), v + (k == 1 ? y : 0), &q[2]);
    f(u - x, v - y, &q[3]);
    out[cag_partial(n, 2 - k, k)] = cag_scaled(cag_add(cag_sub(q[0], q[1]), cag_sub(q[3], q[2])),
                                               (k == 1 ? 0.25 : 1) / (w * w));
  }
  return CAG_OK;
}

static CagStatus formula_row(void *context, double u, const double *vs, size_t nv, int n,
                             CagVec3 *out, CagError *e) {
  return row_by_points(formula_eval, context, u, vs, nv, n, out, e);
}

static void release_nothing(void *context) { (void)context; }

static CagSurface *formula(Formula **f, double u0, double u1, double v0, double v1) {
  CagSurface *s;
  CagSurfaceFunction function = {
      .eval = formula_eval, .eval_row = formula_row, .release = release_nothing, .context = f};
  OK(cag_surface_function(&function, u0, u1, false, v0, v1, false, &s, &err));
  return s;
}

// Eight waves whose crests are at the points of equal steps.
static void crests(double u, double v, CagVec3 *p) {
  *p = cag_vec3(10 * u, 10 * v, cos(16 * M_PI * u) * cos(8 * M_PI * v));
}
static void spike(double u, double v, CagVec3 *p) {
  double x = u - 0.3391, y = v - 0.7713;
  *p = cag_vec3(10 * u, 10 * v, 3 * exp(-4000 * (x * x + y * y)));
}
static void enneper(double u, double v, CagVec3 *p) {
  *p = cag_vec3(u - u * u * u / 3 + u * v * v, v - v * v * v / 3 + v * u * u, u * u - v * v);
}
static void moebius(double u, double v, CagVec3 *p) {
  double r = 5 + v * cos(u / 2);
  *p = cag_vec3(r * cos(u), r * sin(u), v * sin(u / 2));
}
static void root(double u, double v, CagVec3 *p) {
  *p = cag_vec3(5 * u, 5 * v, 4 * sqrt(fabs(u - 0.41) + 1e-9));
}
static void whirl(double u, double v, CagVec3 *p) {
  *p = cag_vec3(3 * u * cos(40 * v), 3 * u * sin(40 * v), 9 * v + sin(7 * u));
}
static void step(double u, double v, CagVec3 *p) {
  *p = cag_vec3(10 * u, 10 * v, 2 * tanh(200 * (u - 0.5) + 20 * (v - 0.5)));
}

#define FORMULA(name, u0, u1, v0, v1)                                                              \
  static CagSurface *name##_surface(void) {                                                        \
    static Formula *f = name;                                                                      \
    return formula(&f, u0, u1, v0, v1);                                                            \
  }
FORMULA(crests, 0, 1, 0, 1)
FORMULA(spike, 0, 1, 0, 1)
FORMULA(enneper, -2, 2, -2, 2)
FORMULA(moebius, 0, 2 * M_PI, -2, 2)
FORMULA(root, 0, 1, 0, 1)
FORMULA(whirl, 0, 1, 0, 1)
FORMULA(step, 0, 1, 0, 1)

// --- Subjects: made of surfaces ---

static CagSurface *offset_patch(void) {
  CagSurface *s = patch(plain, NULL), *out;
  OK(cag_surface_offset(s, -2, &out, &err));
  cag_surface_release(s);
  return out;
}

static CagSurface *trimmed(CagSurface *inner, double u, double v, double a, double b) {
  CagTransform frame = cag_transform_identity(), hole = cag_transform_identity();
  frame.planar = hole.planar = true;
  frame.m[0][3] = u;
  frame.m[1][3] = v;
  hole.m[0][3] = u + a / 3;
  hole.m[1][3] = v;
  CagCurve *c[2];
  CagRegion *r;
  CagSurface *s;
  OK(cag_curve_arc(a, b, 0, 2 * M_PI, &frame, &c[0], &err));
  OK(cag_curve_arc(a / 4, b / 4, 0, 2 * M_PI, &hole, &c[1], &err));
  OK(cag_region_new(c[0], &c[1], 1, &r, &err));
  OK(cag_surface_trimmed(inner, r, &s, &err));
  cag_region_release(r);
  cag_curve_release(c[0]);
  cag_curve_release(c[1]);
  cag_surface_release(inner);
  return s;
}

static CagSurface *trimmed_ridge(void) { return trimmed(ridge(), 3.8, 4.4, 3, 4); }
static CagSurface *trimmed_ball(void) { return trimmed(ball(), 0.2, 3, 1, 2); }
static CagSurface *trimmed_weights(void) { return trimmed(wild_weights(), 2, 2, 1.7, 1.6); }

static CagSurface *scaled(CagSurface *s, double by, double away) {
  CagTransform t = cag_transform_identity();
  CagSurface *out;
  for (int k = 0; k < 3; k++) {
    t.m[k][k] = by;
    t.m[k][3] = away;
  }
  OK(cag_surface_transform(s, &t, &out, &err));
  cag_surface_release(s);
  return out;
}

static CagSurface *far_away(void) { return scaled(periodic(), 1, 1e5); }

enum { ANY = 99 }; // Euler characteristic: not checked

static const Subject subjects[] = {
    {"ridge", ridge, 1, true, 1e-4, 1, 0},
    {"weights of 1e-3 to 1e3", wild_weights, 1, false, 1e-4, 1, 0},
    {"steep weights", steep_weights, 1, false, 1e-4, 1, 0},
    {"an edge of one point", pole_patch, 1, false, 1e-4, 1, 2},
    {"two edges of one point", two_poles, 1, false, 1e-4, 1, 0},
    {"two edges that are lines", two_lines, ANY, false, 1e-4, 1, 0},
    {"coincident control points", coincident, 1, false, 1e-3, 1, 20},
    {"cusps", cusps, 1, false, 1e-4, 1, 0},
    {"a corner without tangents", flat_corner, 1, false, 1e-4, 1, 0},
    {"closed both ways", periodic, 0, true, 1e-3, 1, 15},
    {"Bezier triangle", triangle, 1, false, 1e-4, 1, 0},
    {"Coons", coons, 1, true, 1e-3, 1, 20},
    {"twisted rule", twisted_rule, 1, false, 1e-4, 1, 0},
    {"tight tube", tight_tube, 0, true, 1e-2, 1, 10},
    {"fat tube", fat_tube, 0, false, 1e-2, 1, 0},
    {"wiggly revolution", wiggly_revolution, 1, false, 1e-2, 1, 0},
    {"ball", ball, 2, true, 1e-3, 1, 20},
    {"twisted extrusion", spun_twist, 0, true, 1e-2, 1, 0},
    {"needle", needle, 2, true, 1e-4, 1, 0},
    {"lens", disc_like, 2, true, 1e-4, 1, 0},
    {"hyperboloid of two sheets", sheet, 1, true, 1e-4, 1, 0},
    {"hyperboloid of one sheet", waist, 0, true, 1e-3, 1, 10},
    {"cone", full_cone, 1, false, 1e-4, 1, 0},
    {"bowl", bowl, 1, true, 1e-4, 1, 3},
    {"saddle", saddle, 1, true, 1e-4, 1, 15},
    {"crests", crests_surface, 1, false, 1e-2, 1, 0},
    {"spike", spike_surface, 1, false, 1e-3, 1e-2, 0},
    {"Enneper", enneper_surface, 1, false, 1e-3, 1, 0},
    {"Moebius", moebius_surface, 1, false, 1e-3, 1, 0},
    {"root", root_surface, 1, false, 1e-2, 1, 0},
    {"whirl", whirl_surface, ANY, false, 1e-2, 1, 0},
    {"step", step_surface, 1, false, 1e-3, 1, 0},
    {"offset", offset_patch, 1, true, 1e-4, 1, 20},
    {"trimmed ridge", trimmed_ridge, 0, true, 1e-3, 1, 0},
    {"trimmed ball", trimmed_ball, 0, true, 1e-3, 1, 0},
    {"trimmed weights", trimmed_weights, 0, false, 1e-3, 1, 0},
    {"far away", far_away, 0, true, 1e-2, 1, 0},
};

// --- Tests ---

static void check_vertices(const Subject *x, const CagSurface *s, const CagMesh *m) {
  const CagBounds box = cag_mesh_bounds(m);
  const double size = cag_norm(box.min) + cag_norm(box.max);
  for (size_t v = 0; v < m->vertex_count; v++) {
    const double u = m->uv[2 * v], w = m->uv[2 * v + 1];
    CagVec3 p, n;
    assert_true(m->weld[v] <= v);
    assert_memory_equal(&m->positions[v], &m->positions[m->weld[v]], sizeof p);
    NEAR(cag_norm(m->normals[v]), 1, 1e-12);
    OK(cag_surface_point(s, u, w, &p, &err));
    near_vec(p, m->positions[v], 1e-13 * size);
    // At poles of surfaces of revolution, each side has a limit normal.
    if (x->smooth && cag_surface_normal(s, u, w, &n, &err) == CAG_OK)
      near_vec(n, m->normals[v], 1e-12);
  }
}

static void check_subject(const Subject *x, const CagSurface *s, double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m, *again;
  double worst[2] = {0, 0};
  how.tolerance = tolerance;
  OK(cag_surface_tessellate(s, &how, &m, &err));
  chance_state = 77;
  double d = largest_distance(s, m, tolerance, worst);
  if (!(d <= tolerance))
    fail_msg("%s at %g: %g off at %g, %g (%zu triangles)", x->name, tolerance, d, worst[0],
             worst[1], m->triangle_count);
  if (x->euler != ANY && cag_mesh_euler_characteristic(m) != x->euler)
    fail_msg("%s at %g: Euler characteristic %ld", x->name, tolerance,
             cag_mesh_euler_characteristic(m));
  check_vertices(x, s, m);
  double angle = smallest_angle(m) * 180 / M_PI;
  if (tolerance == TYPICAL && angle < x->angle_least)
    fail_msg("%s: an angle of %g degrees", x->name, angle);
  if (tolerance >= TYPICAL) {
    OK(cag_surface_tessellate(s, &how, &again, &err));
    assert_int_equal(again->triangle_count, m->triangle_count);
    assert_memory_equal(again->triangles, m->triangles, 12 * m->triangle_count);
    assert_memory_equal(again->positions, m->positions, sizeof(CagVec3) * m->vertex_count);
    cag_mesh_release(again);
  }
  cag_mesh_release(m);
}

static void no_point_is_farther_than_the_tolerance(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof subjects / sizeof *subjects; k++) {
    const Subject *x = &subjects[k];
    CagSurface *s = x->make();
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++)
      if (tolerances[i] >= x->finest && tolerances[i] <= x->coarsest)
        check_subject(x, s, tolerances[i]);
    cag_surface_release(s);
  }
}

static void angles_and_edges_are_kept(void **state) {
  (void)state;
  static const Subject smooth[] = {
      {"closed both ways", periodic, 0, true, 0, 0, 0},
      {"ball", ball, 0, true, 0, 0, 0},
      {"Coons", coons, 0, true, 0, 0, 0},
      {"tight tube", tight_tube, 0, true, 0, 0, 0},
      {"twisted extrusion", spun_twist, 0, true, 0, 0, 0},
      {"bowl", bowl, 0, true, 0, 0, 0},
      {"hyperboloid of one sheet", waist, 0, true, 0, 0, 0},
      {"hyperboloid of two sheets", sheet, 0, true, 0, 0, 0},
      {"saddle", saddle, 0, true, 0, 0, 0},
      {"an edge of one point", pole_patch, 0, true, 0, 0, 0},
      {"Bezier triangle", triangle, 0, true, 0, 0, 0},
      {"Moebius", moebius_surface, 0, true, 0, 0, 0},
      {"offset", offset_patch, 0, true, 0, 0, 0},
  };
  const double angles[] = {4, 8, 15, 25}, longest[] = {0, 0.7};
  const double free = 0.2; // fraction of the tolerance
  for (size_t k = 0; k < sizeof smooth / sizeof *smooth; k++) {
    CagSurface *s = smooth[k].make();
    for (int i = 0; i < 8; i++) {
      CagTessellation how = CAG_TESSELLATION_DEFAULT;
      CagMesh *m;
      how.tolerance = 0.1;
      how.angle = angles[i / 2] * M_PI / 180;
      how.max_edge = longest[i % 2];
      OK(cag_surface_tessellate(s, &how, &m, &err));
      check_edges(smooth[k].name, m, how.angle, free * how.tolerance,
                  how.max_edge > 0 ? how.max_edge : INFINITY);
      cag_mesh_release(m);
    }
    cag_surface_release(s);
  }
}

// In translated copies, cells are divided in the same way, although the rounding differs.
static void moved_copies_have_the_same_triangles(void **state) {
  (void)state;
  CagSurface *(*const makers[])(void) = {periodic, ball, waist, tight_tube, saddle};
  for (size_t k = 0; k < sizeof makers / sizeof *makers; k++) {
    CagSurface *s = makers[k](), *copy = scaled(makers[k](), 1, 137.3);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m, *n;
    how.tolerance = 0.02;
    OK(cag_surface_tessellate(s, &how, &m, &err));
    OK(cag_surface_tessellate(copy, &how, &n, &err));
    assert_int_equal(m->triangle_count, n->triangle_count);
    assert_memory_equal(m->triangles, n->triangles, 12 * m->triangle_count);
    cag_mesh_release(m);
    cag_mesh_release(n);
    cag_surface_release(s);
    cag_surface_release(copy);
  }
}

// A hundred turns need about a hundred times the triangles of one.
static void many_turns_take_no_more_than_they_need(void **state) {
  (void)state;
  size_t counts[2];
  for (int k = 0; k < 2; k++) {
    CagTransform frame = cag_transform_identity();
    frame.planar = true;
    CagCurve *c;
    CagSurface *s;
    CagMesh *m;
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    OK(cag_curve_arc(5, 5, 0, 2 * M_PI, &frame, &c, &err));
    OK(cag_surface_extrude(c, cag_vec3(0, 0, 10), 2 * M_PI * (k ? 100 : 1), 1, &s, &err));
    how.tolerance = 0.0173;
    OK(cag_surface_tessellate(s, &how, &m, &err));
    counts[k] = m->triangle_count;
    cag_mesh_release(m);
    how.tolerance = 1e-9;
    FAILS(cag_surface_tessellate(s, &how, &m, &err), "triangle-limit");
    cag_surface_release(s);
    cag_curve_release(c);
  }
  assert_true(counts[1] < 100 * counts[0]);
}

// A gentle wave with a thin feature at a random location: height 3, which decreases by a factor e
// at a distance of `width` along u and v (0: constant in that direction).
static struct { double u, v, width_u, width_v; } feature;

static void thin_feature(double u, double v, CagVec3 *p) {
  double x = feature.width_u > 0 ? (u - feature.u) / feature.width_u : 0,
         y = feature.width_v > 0 ? (v - feature.v) / feature.width_v : 0;
  *p = cag_vec3(10 * u, 10 * v, 0.3 * sin(2 * u + v) + 3 * exp(-x * x - y * y));
}

static void thin_features_of_formulas_are_met(void **state) {
  (void)state;
  static Formula *f = thin_feature;
  const double widths[][2] = {
      {1.0 / 60, 1.0 / 60}, {1.0 / 100, 1.0 / 100}, {1.0 / 100, 0}, {0, 1.0 / 200}};
  chance_state = 21;
  for (int k = 0; k < 120; k++) {
    feature.u = chance();
    feature.v = chance();
    feature.width_u = widths[k % 4][0];
    feature.width_v = widths[k % 4][1];
    CagSurface *s = formula(&f, 0, 1, 0, 1), *moved = scaled(formula(&f, 0, 1, 0, 1), 1, 50);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m, *n;
    CagVec3 top;
    how.tolerance = 0.2;
    OK(cag_surface_tessellate(s, &how, &m, &err));
    OK(cag_surface_point(s, feature.u, feature.v, &top, &err));
    double off = INFINITY;
    for (size_t t = 0; t < m->triangle_count; t++) off = fmin(off, to_triangle(m, t, top));
    if (!(off <= how.tolerance))
      fail_msg("a feature at %g, %g is %g off (%zu triangles)", feature.u, feature.v, off,
               m->triangle_count);
    OK(cag_surface_tessellate(moved, &how, &n, &err));
    assert_int_equal(m->triangle_count, n->triangle_count);
    cag_mesh_release(m);
    cag_mesh_release(n);
    cag_surface_release(s);
    cag_surface_release(moved);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_point_is_farther_than_the_tolerance),
      cmocka_unit_test(angles_and_edges_are_kept),
      cmocka_unit_test(moved_copies_have_the_same_triangles),
      cmocka_unit_test(many_turns_take_no_more_than_they_need),
      cmocka_unit_test(thin_features_of_formulas_are_met),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
