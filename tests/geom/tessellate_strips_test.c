// Meshes of twisted bodies need few triangles: cells become strips whose edges follow the
// directions in which the surface bends least. Counts are compared with those of polygons around a
// circle, and the meshes are sampled densely.

#include <complex.h>
#include <stdio.h>

#include "geom/curve/function.h"
#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/reshape.h"
#include "tests/geom/dense_support.h"

// --- Sections ---

// (a + b t) e^(i t), from which arcs and Archimedean spirals are made.
typedef struct Spiral {
  double a, b;
} Spiral;

static CagStatus spiral_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)e;
  const Spiral *s = context;
  double complex turn = cexp(I * t), lower = 0;
  for (int k = 0; k <= order; k++) {
    const double complex p = (s->a + s->b * t) * turn + k * s->b * lower;
    out[k] = cag_vec3(creal(p), cimag(p), 0);
    lower = turn;
    turn *= I;
  }
  return CAG_OK;
}

static CagCurve *spiral(double from, double to, double r_from, double r_to) {
  Spiral *s = malloc(sizeof *s);
  assert_non_null(s);
  s->b = (r_to - r_from) / (to - from);
  s->a = r_from - s->b * from;
  CagCurve *c;
  OK(cag_curve_function(&(CagCurveFunction){.eval = spiral_eval, .release = free, .context = s}, 2,
                        from, to, false, &c, &err));
  return c;
}

enum { PARTS = 4 };

// A section around the axis: crest, flank, root, flank. `ends` are their ends as fractions of a
// turn.
static CagCurve *thread_section(const double ends[PARTS], double outer, double inner) {
  const double radii[PARTS + 1] = {outer, outer, inner, inner, outer};
  CagCurve *parts[PARTS], *c;
  for (int k = 0; k < PARTS; k++)
    parts[k] = spiral(2 * M_PI * (k ? ends[k - 1] : 0), 2 * M_PI * ends[k], radii[k], radii[k + 1]);
  OK(cag_curve_join(parts, PARTS, &c, &err));
  for (int k = 0; k < PARTS; k++) cag_curve_release(parts[k]);
  return c;
}

static CagCurve *wavy_section(double radius, double wave) {
  enum { POINTS_AROUND = 8 };
  CagVec3 p[POINTS_AROUND];
  for (int k = 0; k < POINTS_AROUND; k++) {
    const double r = radius * between(1 - wave, 1 + wave), a = 2 * M_PI * k / POINTS_AROUND;
    p[k] = cag_vec3(r * cos(a), r * sin(a), 0);
  }
  CagCurve *c;
  OK(cag_curve_nurbs_closed(p, NULL, POINTS_AROUND, 3, 2, &c, &err));
  return c;
}

static CagSolid *twisted(CagCurve *section, double height, double turns, double scale) {
  CagRegion *r;
  CagSolid *s;
  OK(cag_region_new(section, NULL, 0, &r, &err));
  OK(cag_solid_extrude(r, cag_vec3(0, 0, height), 2 * M_PI * turns, scale, &s, &err));
  cag_region_release(r);
  cag_curve_release(section);
  return s;
}

// --- The thread M10 ---

// Crest, flanks, and root of a metric thread take 2/16, 5/16, 4/16, and 5/16 of its pitch. The
// angle between the flanks is 60 degrees.
static const double metric[PARTS] = {2 / 16.0, 7 / 16.0, 11 / 16.0, 1};
static const double pitch = 1.5, outer = 5;
enum { TURNS = 27 };

static double inner_radius(void) { return outer - 5 * pitch / 16 * sqrt(3); }

static CagSolid *m10(void) {
  return twisted(thread_section(metric, outer, inner_radius()), pitch * TURNS, TURNS, 1);
}

// The area of the section, the integral of r^2 / 2, times the height.
static double m10_volume(void) {
  const double r = inner_radius();
  const double area = M_PI * (2 * outer * outer + 4 * r * r) / 16 +
                      M_PI * 10 / 16 * (outer * outer + outer * r + r * r) / 3;
  return area * pitch * TURNS;
}

static CagMesh *mesh_of(const CagSolid *s, double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  how.tolerance = tolerance;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  return m;
}

// The area of a polygon with n sides is less than that of its circle by the fraction (2 pi / n)^2 /
// 6. With 30 quadrilaterals per turn, each of the four strips of the thread misses less than 0.77
// %. Each quadrilateral has two triangles, and there are 27 turns. The limit is 1.5 times this
// count, because of the ends, the flanks, and the tolerance that is not fully used.
static void a_thread_takes_few_triangles_for_its_volume(void **state) {
  (void)state;
  const double n = 30, most_missed = 0.0077;
  assert_true(pow(2 * M_PI / n, 2) / 6 < most_missed);
  const double most = 1.5 * 2 * n * TURNS * PARTS;
  CagSolid *s = m10();
  double missed = 1;
  size_t count = 0;
  for (double tolerance = 0.05; missed > most_missed; tolerance *= 0.9) {
    CagMesh *m = mesh_of(s, tolerance);
    double terms[10];
    cag_mesh_volume_terms(m, terms);
    missed = fabs(terms[0] / m10_volume() - 1);
    count = m->triangle_count;
    cag_mesh_release(m);
  }
  if (!(count <= most)) fail_msg("%zu triangles, more than %g", count, most);
  cag_solid_release(s);
}

// The limit is from the sagitta of a chord at distance r from the axis, r (1 - cos(pi / n)).
static void coarser_tolerances_take_fewer_triangles(void **state) {
  (void)state;
  CagSolid *s = m10();
  double last = INFINITY;
  for (double tolerance = 1e-3; tolerance < 0.05; tolerance *= 2) {
    CagMesh *m = mesh_of(s, tolerance);
    const double n = M_PI / acos(1 - tolerance / outer), count = (double)m->triangle_count;
    if (!(count < 2 * 2 * n * TURNS * PARTS && count < last))
      fail_msg("%g at %g, %g before", count, tolerance, last);
    last = count;
    cag_mesh_release(m);
  }
  cag_solid_release(s);
}

// --- Any twisted body ---

static void check_body(const char *name, const CagSolid *s, double tolerance) {
  const CagTessellation how = {
      .tolerance = tolerance, .angle = M_PI / 12, .max_triangles = 10 * 1000 * 1000};
  double worst[2];
  CagMesh *m;
  CagVec3 edge[2];
  OK(cag_solid_tessellate(s, &how, &m, &err));
  if (!cag_mesh_is_watertight(m, edge)) fail_msg("%s at %g has a gap", name, tolerance);
  cag_mesh_release(m);
  for (size_t k = 0; k < s->face_count; k++) {
    const CagSurface *side = s->faces[k];
    if (cag_surface_planar_view(side, NULL, NULL)) continue;
    OK(cag_surface_tessellate(side, &how, &m, &err));
    const double d = largest_distance(side, m, tolerance, worst);
    if (!(d <= tolerance))
      fail_msg("%s at %g: %g off at %g, %g", name, tolerance, d, worst[0], worst[1]);
    check_edges(name, m, how.angle, 0.2 * tolerance, INFINITY);
    cag_mesh_release(m);
  }
}

static void twisted_bodies_keep_tolerance_and_angle(void **state) {
  (void)state;
  enum { BODIES = 8 };
  chance_state = 4711;
  for (int k = 0; k < BODIES; k++) {
    char name[64];
    const double r = between(3, 12), depth = between(0.05, 0.4);
    const double a = between(0.05, 0.4), b = a + between(0.05, 0.3), c = b + between(0.05, 0.2);
    const double ends[PARTS] = {a, b, c, 1};
    const double turns = (k % 4 < 2 ? 1 : -1) * between(1, 8);
    CagCurve *section =
        k % 2 ? wavy_section(r, depth / 2) : thread_section(ends, r, r * (1 - depth));
    CagSolid *s = twisted(section, between(10, 50), turns, k % 3 == 2 ? between(0.5, 1.5) : 1);
    snprintf(name, sizeof name, "body %d", k);
    check_body(name, s, 0.2);
    check_body(name, s, 0.02);
    cag_solid_release(s);
  }
}

// --- A spring ---

// A bar that follows an arc of 300 degrees, with straight sides.
enum { CHORDS = 16 };
static const double bar[2] = {105, 95}; // radii

static CagCurve *bent_bar(void) {
  CagVec3 p[2 * CHORDS + 2];
  size_t n = 0;
  for (int side = 0; side < 2; side++)
    for (int k = 0; k <= CHORDS; k++) {
      const double a = 5 * M_PI / 3 * (side ? CHORDS - k : k) / CHORDS;
      p[n++] = cag_vec3(bar[side] * cos(a), bar[side] * sin(a), 0);
    }
  CagCurve *c;
  OK(cag_curve_polyline(p, n, true, 2, &c, &err));
  return c;
}

// As meshes of exports are made: the normal may turn farther along edges of up to four tolerances.
// The rails of corners are circles as seen from above, with the sagitta r (1 - cos(pi / n)). Between
// two rails, sides are hollow: the sagitta of their chords is divided among the strips.
static void springs_take_few_triangles(void **state) {
  (void)state;
  const double tolerance = 0.25, turns = 25.0 / 6, step = M_PI / 6 * 5 / CHORDS;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagSolid *s = twisted(bent_bar(), 100, turns, 1);
  CagMesh *m;
  CagVec3 edge[2];
  double most = 0, worst[2];
  how.tolerance = tolerance;
  how.short_edge = 4;
  for (int k = 0; k < 2; k++) {
    const double around = M_PI / acos(1 - tolerance / bar[k]) * turns;
    const double strips = ceil(sqrt(bar[k] * (1 - cos(step)) / tolerance));
    most += 2 * 2 * around * strips * CHORDS; // twice the triangles
  }
  OK(cag_solid_tessellate(s, &how, &m, &err));
  if (!((double)m->triangle_count < most)) fail_msg("%zu triangles, %g", m->triangle_count, most);
  assert_true(cag_mesh_is_watertight(m, edge));
  cag_mesh_release(m);
  for (size_t k = 0; k < s->face_count; k++) {
    if (cag_surface_planar_view(s->faces[k], NULL, NULL)) continue;
    OK(cag_surface_tessellate(s->faces[k], &how, &m, &err));
    assert_true(largest_distance(s->faces[k], m, tolerance, worst) <= tolerance);
    cag_mesh_release(m);
  }
  cag_solid_release(s);
}

// Swaps the parameters and changes nothing else.
static void strips_run_along_either_parameter(void **state) {
  (void)state;
  const CagTessellation how = {
      .tolerance = 0.02, .angle = M_PI / 12, .max_triangles = 10 * 1000 * 1000};
  CagCurve *c = thread_section(metric, outer, inner_radius());
  CagSurface *s, *t;
  CagMesh *m, *n;
  double worst[2];
  OK(cag_surface_extrude(c, cag_vec3(0, 0, 4 * pitch), 8 * M_PI, 1, &s, &err));
  OK(cag_surface_transpose(s, &t, &err));
  OK(cag_surface_tessellate(s, &how, &m, &err));
  OK(cag_surface_tessellate(t, &how, &n, &err));
  NEAR((double)n->triangle_count, (double)m->triangle_count, 0.02 * (double)m->triangle_count);
  assert_true(largest_distance(t, n, how.tolerance, worst) <= how.tolerance);
  check_edges("transposed", n, how.angle, 0, INFINITY);
  cag_mesh_release(m);
  cag_mesh_release(n);
  cag_surface_release(s);
  cag_surface_release(t);
  cag_curve_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_thread_takes_few_triangles_for_its_volume),
      cmocka_unit_test(coarser_tolerances_take_fewer_triangles),
      cmocka_unit_test(twisted_bodies_keep_tolerance_and_angle),
      cmocka_unit_test(springs_take_few_triangles),
      cmocka_unit_test(strips_run_along_either_parameter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
