// Guarantees of meshes of solids, compared with closed forms: set operations, caps with holes,
// copies, tight bends, and any unit. Each mesh is closed and oriented outward, its points are on
// the correct surfaces within the tolerance and vice versa, and its volume and area converge to the
// exact ones as the tolerance decreases.

#include "geom/mesh/check.h"
#include "geom/mesh/distance.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/loft.h"
#include "tests/geom/support.h"

static uint64_t chance_state = 1;

// Park and Miller's generator, for the same points on every machine.
static double chance(void) {
  chance_state = chance_state * 48271 % 2147483647;
  return (double)chance_state / 2147483647;
}

static double between(double a, double b) { return a + (b - a) * chance(); }

static CagVec3 direction(void) {
  double z = between(-1, 1), a = between(0, 2 * M_PI), r = sqrt(1 - z * z);
  return cag_vec3(r * cos(a), r * sin(a), z);
}

// --- Constructors ---

static CagSolid *ball(double radius) {
  CagSolid *s;
  OK(cag_solid_sphere(radius, &s, &err));
  return s;
}

static CagSolid *box(double x, double y, double z) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(x, y, z), true, &s, &err));
  return s;
}

// Takes ownership of the solid.
static CagSolid *mapped(CagSolid *s, const CagTransform *t) {
  CagSolid *out;
  OK(cag_solid_transform(s, t, &out, &err));
  cag_solid_release(s);
  return out;
}

static CagSolid *moved(CagSolid *s, double x, double y, double z) {
  CagTransform t = cag_translate(cag_vec3(x, y, z));
  return mapped(s, &t);
}

// A cylinder about axis k, from -half to half.
static CagSolid *rod(double radius, double half, int k) {
  CagSolid *s;
  CagTransform t = cag_transform_identity();
  OK(cag_solid_cylinder(2 * half, radius, radius, &s, &err));
  s = moved(s, 0, 0, -half);
  // A cyclic permutation of the axes: z to x, or z to y.
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) t.m[i][j] = (j + k + 1) % 3 == i;
  return k == 2 ? s : mapped(s, &t);
}

// Takes ownership of the operands.
static CagSolid *combined(CagSetOperation op, size_t n, CagSolid **operands) {
  CagSolid *out;
  OK(cag_solid_combine(op, operands, n, NULL, &out, &err));
  for (size_t k = 0; k < n; k++) cag_solid_release(operands[k]);
  return out;
}
#define COMBINED(op, ...)                                                                          \
  combined(op, sizeof((CagSolid *[]){__VA_ARGS__}) / sizeof(CagSolid *),                           \
           (CagSolid *[]){__VA_ARGS__})

// --- Set operations ---

// The distance from p to the surfaces of the operands, for small distances.
typedef double Distance(CagVec3 p);

static double from_rod(CagVec3 p, int k, double radius) {
  const double along[3] = {p.x, p.y, p.z};
  return fabs(sqrt(fmax(0, cag_dot(p, p) - along[k] * along[k])) - radius);
}
static double to_ring(CagVec3 p) { return fmin(fabs(cag_norm(p) - 10), from_rod(p, 2, 6)); }
static double to_two_rods(CagVec3 p) { return fmin(from_rod(p, 0, 5), from_rod(p, 1, 5)); }
static double to_three_rods(CagVec3 p) { return fmin(to_two_rods(p), from_rod(p, 2, 5)); }
static double to_hollow(CagVec3 p) {
  double r = cag_norm(p);
  return fmin(fabs(r - 10), fabs(r - 9));
}
static double to_boxes(CagVec3 p) {
  const double x[4] = {-3, 3, -2, 4}, y[4] = {-4, 4, -3, 5}, z[4] = {-5, 5, -4, 6};
  double least = INFINITY;
  for (int k = 0; k < 4; k++) {
    least = fmin(least, fmin(fabs(p.x - x[k]), fabs(p.y - y[k])));
    least = fmin(least, fabs(p.z - z[k]));
  }
  return least;
}
static double to_two_balls(CagVec3 p) {
  CagVec3 q = cag_sub(p, cag_vec3(6, 0, 0));
  return fmin(fabs(cag_norm(p) - 5), fabs(cag_norm(q) - 5));
}

static CagSolid *napkin_ring(void) { return COMBINED(CAG_DIFFERENCE, ball(10), rod(6, 20, 2)); }
static CagSolid *two_rods(void) { return COMBINED(CAG_INTERSECTION, rod(5, 9, 0), rod(5, 9, 1)); }
static CagSolid *three_rods(void) {
  return COMBINED(CAG_INTERSECTION, rod(5, 9, 0), rod(5, 9, 1), rod(5, 9, 2));
}
static CagSolid *hollow(void) { return COMBINED(CAG_DIFFERENCE, ball(10), ball(9)); }
static CagSolid *two_boxes(void) {
  return COMBINED(CAG_INTERSECTION, box(6, 8, 10), moved(box(6, 8, 10), 1, 1, 1));
}
static CagSolid *two_balls(void) { return COMBINED(CAG_UNION, ball(5), moved(ball(5), 6, 0, 0)); }

typedef struct Operation {
  const char *name;
  CagSolid *(*make)(void);
  Distance *distance;
  double volume, area;
  long genus;
  size_t shells;
} Operation;

// Heights: 16 for the ring, and 2 for the caps cut from two balls of radius 5 at distance 6.
static const Operation operations[] = {
    {"napkin ring", napkin_ring, to_ring, M_PI * 4096 / 6, M_PI *(2 * 10 + 2 * 6) * 16, 1, 1},
    {"two cylinders", two_rods, to_two_rods, 16.0 / 3 * 125, 16 * 25, 0, 1},
    {"three cylinders", three_rods, to_three_rods, 8 * (2 - M_SQRT2) * 125, 24 * (2 - M_SQRT2) * 25,
     0, 1},
    {"hollow ball", hollow, to_hollow, 4 * M_PI / 3 * (1000 - 729), 4 * M_PI * 181, 0, 2},
    {"two boxes", two_boxes, to_boxes, 5 * 7 * 9, 2 * (35 + 45 + 63), 0, 1},
    {"two balls", two_balls, to_two_balls, 2 * (4 * M_PI / 3 * 125 - M_PI * 4 * (15 - 2) / 3),
     2 * (100 * M_PI - 2 * M_PI * 5 * 2), 0, 1},
};
enum { OPERATIONS = sizeof operations / sizeof *operations };

static CagMesh *mesh_of(const CagSolid *s, double tolerance) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  how.tolerance = tolerance;
  how.angle = 0;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  return m;
}

static double volume_of(const CagMesh *m) {
  double terms[10];
  cag_mesh_volume_terms(m, terms);
  return terms[0];
}

static void check_closed(const char *name, const CagMesh *m, long genus, size_t shells) {
  CagMeshCheck c;
  OK(cag_mesh_check(m, &c, &err));
  if (!c.closed || !c.oriented || c.nonmanifold_edges > 0 || !(c.volume > 0))
    fail_msg("%s: %zu open and %zu crowded edges, volume %g", name, c.boundary_edges,
             c.nonmanifold_edges, c.volume);
  if (c.genus != genus || c.shells != shells)
    fail_msg("%s: genus %ld, %zu shells", name, c.genus, c.shells);
}

static CagVec3 point_in(const CagMesh *m, size_t t) {
  const uint32_t *k = m->triangles + 3 * t;
  double a = chance(), b = chance();
  if (a + b > 1) a = 1 - a, b = 1 - b;
  CagVec3 p = m->positions[k[0]];
  return cag_madd(cag_madd(p, a, cag_sub(m->positions[k[1]], p)), b,
                  cag_sub(m->positions[k[2]], p));
}

static void points_of_operations_lie_on_their_operands(void **state) {
  (void)state;
  const double tolerances[] = {0.3, 0.05, 0.01};
  chance_state = 3;
  for (size_t k = 0; k < OPERATIONS; k++) {
    CagSolid *s = operations[k].make();
    for (int i = 0; i < 3; i++) {
      CagMesh *m = mesh_of(s, tolerances[i]);
      check_closed(operations[k].name, m, operations[k].genus, operations[k].shells);
      for (size_t t = 0; t < m->triangle_count; t++)
        for (int n = 0; n < 4; n++) {
          double d = operations[k].distance(point_in(m, t));
          if (!(d <= tolerances[i] * (1 + 1e-9)))
            fail_msg("%s at %g: a point is %g off", operations[k].name, tolerances[i], d);
        }
      cag_mesh_release(m);
    }
    cag_solid_release(s);
  }
}

// A ray from the center of the solid leaves it through the mesh: no part of the boundary is
// missing. (The ring and the shell do not contain their centers; the ray from the origin crosses
// all of their surfaces.)
static double crossing_volume(const CagMesh *m, CagVec3 way) {
  double sum =
      0; // of signed cubes of distances: the volume as an integral over the solid angle, by rays
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]], b = m->positions[k[1]], c = m->positions[k[2]];
    double x = cag_dot(cag_cross(b, c), way), y = cag_dot(cag_cross(c, a), way),
           z = cag_dot(cag_cross(a, b), way), whole = x + y + z;
    if (!(x * y > 0 && y * z > 0)) continue;
    double distance = cag_dot(cag_cross(a, b), c) / whole;
    if (distance < 0) continue; // on the opposite side
    sum += (whole > 0 ? 1 : -1) * distance * distance * distance;
  }
  return sum;
}

// The known radii of the crossings along a ray from the origin.
static double ring_steps(CagVec3 w) {
  double flat = hypot(w.x, w.y);
  return flat <= 0.6 ? 0 : 1000 - pow(6 / flat, 3);
}
static double rods_steps(CagVec3 w, int n) {
  double reach = 5 / fmax(hypot(w.y, w.z), hypot(w.x, w.z));
  if (n == 3) reach = fmin(reach, 5 / hypot(w.x, w.y));
  return pow(reach, 3);
}

static void rays_through_operations_cross_the_exact_surfaces(void **state) {
  (void)state;
  const double tolerance = 0.02, steepest = 8; // a ray meets a surface at this slope at least
  chance_state = 9;
  CagMesh *m[4];
  for (int k = 0; k < 4; k++) {
    CagSolid *s = operations[k].make();
    m[k] = mesh_of(s, tolerance);
    cag_solid_release(s);
  }
  for (int k = 0; k < 400; k++) {
    CagVec3 w = direction();
    const double found[4] = {crossing_volume(m[0], w), crossing_volume(m[1], w),
                             crossing_volume(m[2], w), crossing_volume(m[3], w)};
    const double exact[4] = {ring_steps(w), rods_steps(w, 2), rods_steps(w, 3), 1000 - 729};
    for (int i = 0; i < 4; i++) {
      // Near the ring's rim, rays graze it; near a pole of the rods, they are long.
      if (i == 0 && fabs(hypot(w.x, w.y) - 0.6) < 0.05) continue;
      double slack = steepest * tolerance * 3 * 100 * 2;
      if (!(fabs(found[i] - exact[i]) <= slack))
        fail_msg("%s along %g %g %g: %g, not %g", operations[i].name, w.x, w.y, w.z, found[i],
                 exact[i]);
    }
  }
  for (int k = 0; k < 4; k++) cag_mesh_release(m[k]);
}

// The deviation of chords, and therefore that of volume and area, is quadratic in their length. A
// tolerance that is 16 times finer leaves about a sixteenth, plus a little for edges between
// surfaces.
static void volumes_and_areas_converge(void **state) {
  (void)state;
  for (size_t k = 0; k < OPERATIONS; k++) {
    const Operation *o = &operations[k];
    CagSolid *s = o->make();
    double before[2] = {INFINITY, INFINITY};
    for (double tolerance = 0.32; tolerance > 0.001; tolerance /= 16) {
      CagMesh *m = mesh_of(s, tolerance);
      double off[2] = {fabs(volume_of(m) - o->volume), fabs(cag_mesh_area(m) - o->area)};
      double rounding = 1e-9 * o->volume;
      if (!(off[0] <= tolerance * o->area + rounding))
        fail_msg("%s at %g: the volume is %g off", o->name, tolerance, off[0]);
      for (int i = 0; i < 2; i++)
        if (!(off[i] <= before[i] / 6 + rounding))
          fail_msg("%s at %g: %s is off by %g after %g", o->name, tolerance,
                   i ? "the area" : "the volume", off[i], before[i]);
      memcpy(before, off, sizeof off);
      cag_mesh_release(m);
    }
    cag_solid_release(s);
  }
}

// --- Caps ---

static CagCurve *ellipse(double x, double y, double a, double b) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  frame.planar = true;
  frame.m[0][3] = x;
  frame.m[1][3] = y;
  OK(cag_curve_arc(a, b, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

// An ellipse with two holes, one of which is an ellipse. The area is (40 - 1 - 1.5) pi.
static CagRegion *holed(void) {
  CagCurve *loops[3] = {ellipse(0, 0, 8, 5), ellipse(3, 0, 1, 1), ellipse(-3, 1, 1.5, 1)};
  CagRegion *r;
  OK(cag_region_new(loops[0], loops + 1, 2, &r, &err));
  for (int k = 0; k < 3; k++) cag_curve_release(loops[k]);
  return r;
}
static const double holed_area = M_PI * (40 - 1 - 1.5);

// The area of the triangles in the plane z = height.
static double area_at(const CagMesh *m, double height) {
  double area = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]], b = m->positions[k[1]], c = m->positions[k[2]];
    if (fabs(a.z - height) + fabs(b.z - height) + fabs(c.z - height) > 1e-9) continue;
    area += cag_cross(cag_sub(b, a), cag_sub(c, a)).z / 2;
  }
  return area;
}

static void caps_with_holes_have_their_area(void **state) {
  (void)state;
  const double twists[] = {0, M_PI / 3, 4 * M_PI}, scales[] = {1, 0.4, 1.7};
  const double height = 12, perimeter = 60; // an upper bound
  CagRegion *r = holed();
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (double tolerance = 0.1; tolerance > 1e-3; tolerance /= 10) {
        CagSolid *s;
        double k = scales[j];
        OK(cag_solid_extrude(r, cag_vec3(1, -2, height), twists[i], k, &s, &err));
        CagMesh *m = mesh_of(s, tolerance);
        check_closed("extrusion", m, 2, 1);
        NEAR(area_at(m, 0), -holed_area, tolerance * perimeter);
        NEAR(area_at(m, height), k * k * holed_area, tolerance * perimeter * k);
        NEAR(volume_of(m), holed_area * height * (1 + k + k * k) / 3, tolerance * cag_mesh_area(m));
        cag_mesh_release(m);
        cag_solid_release(s);
      }
  cag_region_release(r);
}

// --- Copies, units, nonuniform scales ---

static CagSolid *subject(int k) {
  CagSolid *s;
  CagRegion *r = holed();
  CagTransform off_axis = cag_translate(cag_vec3(9, 0, 0));
  off_axis.planar = true;
  switch (k) {
  case 0: s = ball(3); break;
  case 1: OK(cag_solid_cylinder(5, 3, 0, &s, &err)); break;
  case 2: OK(cag_solid_torus(5, 2, &s, &err)); break;
  case 3: OK(cag_solid_extrude(r, cag_vec3(0, 0, 9), 1, 0.5, &s, &err)); break;
  case 4: {
    CagRegion *off;
    OK(cag_region_transform(r, &off_axis, &off, &err));
    OK(cag_solid_revolve(off, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 4, &s, &err));
    cag_region_release(off);
    break;
  }
  default: s = COMBINED(CAG_DIFFERENCE, ball(5), rod(2, 9, 0), rod(2, 9, 1));
  }
  cag_region_release(r);
  return s;
}
enum { SUBJECTS = 6 };

static double size_of(const CagSolid *s) {
  CagBounds box;
  OK(cag_solid_bounds(s, &box, &err));
  return cag_norm(cag_sub(box.max, box.min));
}

static void mirrored_and_stretched_copies_are_closed(void **state) {
  (void)state;
  const double stretch[][3] = {{-1, 1, 1},    {1, 1, -1},       {-1, -1, -1},
                               {1, 0.05, 20}, {0.01, -1, 0.01}, {100, 1, 0.3}};
  for (int k = 0; k < SUBJECTS; k++)
    for (size_t i = 0; i < sizeof stretch / sizeof *stretch; i++) {
      CagSolid *s = subject(k);
      CagTransform t = cag_transform_identity();
      for (int j = 0; j < 3; j++) t.m[j][j] = stretch[i][j];
      CagMesh *m = mesh_of(s, size_of(s) * 2e-3);
      CagSolid *copy = mapped(s, &t);
      CagMesh *n = mesh_of(copy, size_of(copy) * 2e-3);
      CagMeshCheck a, b;
      double factor = fabs(stretch[i][0] * stretch[i][1] * stretch[i][2]);
      OK(cag_mesh_check(m, &a, &err));
      OK(cag_mesh_check(n, &b, &err));
      if (!b.closed || !b.oriented || b.genus != a.genus || b.shells != a.shells)
        fail_msg("subject %d stretched by %g %g %g: genus %ld and %ld, %zu open edges", k,
                 stretch[i][0], stretch[i][1], stretch[i][2], a.genus, b.genus, b.boundary_edges);
      // Both deviate from the exact volume as much as the tolerance allows.
      double allowed = size_of(copy) * 2e-3 * cag_mesh_area(n) +
                       factor * cag_mesh_area(m) * 2e-3 * cag_norm(cag_mesh_bounds(m).max) * 4;
      NEAR(volume_of(n), factor * volume_of(m), allowed);
      cag_mesh_release(m);
      cag_mesh_release(n);
      cag_solid_release(copy);
    }
}

static void units_do_not_matter(void **state) {
  (void)state;
  const double units[] = {1e-6, 1e-3, 1e3, 1e6};
  for (int k = 0; k < SUBJECTS; k++) {
    CagSolid *s = subject(k);
    double tolerance = size_of(s) * 1e-3;
    CagMesh *m = mesh_of(s, tolerance);
    for (int i = 0; i < 4; i++) {
      CagTransform t = cag_transform_identity();
      double u = units[i];
      CagSolid *copy;
      for (int j = 0; j < 3; j++) t.m[j][j] = u;
      OK(cag_solid_transform(s, &t, &copy, &err));
      CagMesh *n = mesh_of(copy, tolerance * u);
      CagMeshCheck c;
      OK(cag_mesh_check(n, &c, &err));
      assert_true(c.closed && c.oriented);
      if (n->triangle_count != m->triangle_count)
        fail_msg("subject %d in units of %g: %zu triangles, not %zu", k, u, n->triangle_count,
                 m->triangle_count);
      NEAR(volume_of(n) / (u * u * u), volume_of(m), 1e-9 * volume_of(m));
      cag_mesh_release(n);
      cag_solid_release(copy);
    }
    cag_mesh_release(m);
    cag_solid_release(s);
  }
}

static void what_is_smaller_than_the_tolerance_is_closed(void **state) {
  (void)state;
  const double shares[] = {0.2, 1, 10};
  for (int k = 0; k + 1 < SUBJECTS; k++)
    for (int i = 0; i < 3; i++) {
      CagSolid *s = subject(k);
      CagMesh *m = mesh_of(s, shares[i] * size_of(s));
      CagMeshCheck c;
      OK(cag_mesh_check(m, &c, &err));
      if (!c.closed || !c.oriented || m->triangle_count == 0)
        fail_msg("subject %d at %g of its size: %zu triangles, %zu open edges", k, shares[i],
                 m->triangle_count, c.boundary_edges);
      cag_mesh_release(m);
      cag_solid_release(s);
    }
}

// --- Tubes ---

// Pappus: if the radius of the tube is less than the radius of curvature, its volume is that of a
// straight one.
static void tubes_with_tight_bends_keep_their_volume(void **state) {
  (void)state;
  const double pitch = 3, turns = 4, path = 2;
  const double length = turns * hypot(2 * M_PI * path, pitch);
  const double bend = path + pitch * pitch / (4 * M_PI * M_PI * path); // radius of curvature
  // Turns are 3 apart, so radii must be less than half of that.
  const double radii[] = {0.1, 0.7, 1.4};
  CagCurve *c;
  OK(cag_curve_helix(path, pitch, turns, 0, &c, &err));
  for (int k = 0; k < 3; k++) {
    double r = radii[k];
    CagSolid *s;
    assert_true(r < bend);
    OK(cag_solid_tube(c, r, &s, &err));
    for (double tolerance = 0.05; tolerance > 4e-4; tolerance /= 10) {
      CagMesh *m = mesh_of(s, tolerance);
      check_closed("tube", m, 0, 1);
      NEAR(volume_of(m), M_PI * r * r * length, tolerance * cag_mesh_area(m));
      cag_mesh_release(m);
    }
    cag_solid_release(s);
  }
  cag_curve_release(c);
}

// --- Clipped solids, lofts, tubes, nonuniform scales: points on the surfaces ---

static const double helix_radius = 2, helix_pitch = 3, helix_turns = 4;

static double to_helix_tube(CagVec3 p) {
  // The closest point of the helix has about the angle of p, on the turn of its height.
  double end = helix_turns * 2 * M_PI, rise = helix_pitch / (2 * M_PI), best = INFINITY;
  double near = atan2(p.y, p.x);
  for (int turn = -1; turn <= helix_turns + 1; turn++) {
    double t = near + turn * 2 * M_PI, step = 0.7;
    for (int k = 0; k < 60; k++, step *= 0.7)
      for (int side = -1; side <= 1; side += 2) {
        double d[2];
        for (int i = 0; i < 2; i++) {
          double x = fmin(fmax(t + i * side * step, 0), end);
          d[i] = cag_norm(
              cag_sub(p, cag_vec3(helix_radius * cos(x), helix_radius * sin(x), rise * x)));
        }
        if (d[1] < d[0]) t = fmin(fmax(t + side * step, 0), end);
        best = fmin(best, fmin(d[0], d[1]));
      }
  }
  double off = fabs(best - 0.7);
  // The caps, perpendicular to both ends.
  double slope = hypot(helix_radius, rise);
  CagVec3 first = {0, helix_radius / slope, rise / slope};
  off = fmin(off, fabs(cag_dot(cag_sub(p, cag_vec3(helix_radius, 0, 0)), first)));
  return fmin(off, fabs(cag_dot(cag_sub(p, cag_vec3(helix_radius, 0, rise * end)), first)));
}
static double to_clipped_torus(CagVec3 p) {
  return fmin(fabs(p.x), fabs(hypot(hypot(p.x, p.y) - 5, p.z) - 2));
}
// To first order, which suffices near it.
static double to_ellipsoid(CagVec3 p) {
  CagVec3 g = {p.x / 64, p.y, p.z / 9};
  return fabs(cag_dot(p, g) - 1) / (2 * cag_norm(g));
}
static double to_frustum(CagVec3 p) {
  double side = fabs(hypot(p.x, p.y) - (4 - p.z / 3)) * 3 / hypot(1, 3);
  return fmin(side, fmin(fabs(p.z), fabs(p.z - 6)));
}

static CagSolid *helix_tube(void) {
  CagCurve *c;
  CagSolid *s;
  OK(cag_curve_helix(helix_radius, helix_pitch, helix_turns, 0, &c, &err));
  OK(cag_solid_tube(c, 0.7, &s, &err));
  cag_curve_release(c);
  return s;
}
static CagSolid *clipped_torus(void) {
  CagPlane plane;
  CagSolid *torus, *side;
  OK(cag_solid_torus(5, 2, &torus, &err));
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
  OK(cag_solid_half_space(&plane, &side, &err));
  return COMBINED(CAG_INTERSECTION, torus, side);
}
static CagSolid *ellipsoid(void) {
  CagTransform t = cag_transform_identity();
  t.m[0][0] = 8;
  t.m[2][2] = 3;
  return mapped(ball(1), &t);
}
// A cone from three circles, the middle one of which is redundant.
static CagSolid *frustum(void) {
  CagCurve *circles[3];
  CagSurface *side;
  CagSolid *s;
  const double height[3] = {0, 2, 6};
  for (int k = 0; k < 3; k++) {
    CagTransform frame = cag_translate(cag_vec3(0, 0, height[k]));
    double r = 4 - height[k] / 3;
    frame.planar = false;
    OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &circles[k], &err));
  }
  OK(cag_surface_loft((const CagCurve *const *)circles, 3, 1, false, &side, &err));
  OK(cag_solid_loft(side, &s, &err));
  cag_surface_release(side);
  for (int k = 0; k < 3; k++) cag_curve_release(circles[k]);
  return s;
}

static void points_of_other_solids_lie_on_their_surfaces(void **state) {
  (void)state;
  static const struct {
    const char *name;
    CagSolid *(*make)(void);
    Distance *distance;
    long genus;
  } others[] = {{"tube", helix_tube, to_helix_tube, 0},
                {"clipped torus", clipped_torus, to_clipped_torus, 0},
                {"ellipsoid", ellipsoid, to_ellipsoid, 0},
                {"loft", frustum, to_frustum, 0}};
  const double tolerances[] = {0.1, 0.02};
  const double first_order = 1.1; // allowance for the first-order approximation
  chance_state = 17;
  for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
    CagSolid *s = others[k].make();
    for (int i = 0; i < 2; i++) {
      CagMesh *m = mesh_of(s, tolerances[i]);
      check_closed(others[k].name, m, others[k].genus, 1);
      for (size_t t = 0; t < m->triangle_count; t++) {
        CagVec3 p = point_in(m, t);
        double d = others[k].distance(p);
        if (!(d <= tolerances[i] * first_order))
          fail_msg("%s at %g: %g %g %g is %g off", others[k].name, tolerances[i], p.x, p.y, p.z, d);
      }
      cag_mesh_release(m);
    }
    cag_solid_release(s);
  }
}

// --- Seams ---

// Coincident vertices have bit for bit the same position, and each vertex at one end of a closed
// direction has a counterpart at the other end.
static void seams_agree_to_the_bit(void **state) {
  (void)state;
  for (int k = 0; k < SUBJECTS; k++) {
    CagSolid *s = subject(k);
    CagMesh *m = mesh_of(s, size_of(s) * 1e-3);
    size_t doubled = 0;
    for (size_t v = 0; m->weld && v < m->vertex_count; v++) {
      assert_memory_equal(&m->positions[v], &m->positions[m->weld[v]], sizeof(CagVec3));
      doubled += m->weld[v] != v;
    }
    assert_true(doubled > 0);
    cag_mesh_release(m);
    for (size_t f = 0; f < s->face_count; f++) {
      const CagSurface *face = s->faces[f];
      if (!face->closed_u && !face->closed_v) continue;
      CagTessellation how = CAG_TESSELLATION_DEFAULT;
      OK(cag_surface_tessellate(face, &how, &m, &err));
      for (int d = 0; d < 2; d++) {
        if (d == 0 ? !face->closed_u : !face->closed_v) continue;
        double low = d == 0 ? face->u0 : face->v0, high = d == 0 ? face->u1 : face->v1;
        for (size_t v = 0; v < m->vertex_count; v++) {
          double across = m->uv[2 * v + 1 - (size_t)d];
          bool at_pole =
              d == 0
                  ? (face->pole_v0 && across == face->v0) || (face->pole_v1 && across == face->v1)
                  : (face->pole_u0 && across == face->u0) || (face->pole_u1 && across == face->u1);
          if (m->uv[2 * v + (size_t)d] != high || at_pole) continue;
          bool found = false;
          for (size_t w = 0; !found && w < m->vertex_count; w++)
            found = m->uv[2 * w + (size_t)d] == low &&
                    memcmp(&m->positions[v], &m->positions[w], sizeof(CagVec3)) == 0;
          assert_true(found);
        }
      }
      cag_mesh_release(m);
    }
    cag_solid_release(s);
  }
}

// --- Shells whose faces are parametrized independently ---

// A unit cube deformed by a quadratic map, so that faces and edges are curved.
typedef struct Bend {
  double mixed[3], squared[3];
} Bend;

static CagVec3 bent(const Bend *b, CagVec3 p) {
  return cag_vec3(p.x + b->mixed[0] * p.y * p.z + b->squared[0] * p.y * p.y,
                  p.y + b->mixed[1] * p.z * p.x + b->squared[1] * p.z * p.z,
                  p.z + b->mixed[2] * p.x * p.y + b->squared[2] * p.x * p.x);
}

// The integral of the map's Jacobian determinant, for which two Gauss points in each direction are
// exact.
static double bent_volume(const Bend *b) {
  const double at[2] = {0.5 - sqrt(3) / 6, 0.5 + sqrt(3) / 6};
  double sum = 0;
  for (int k = 0; k < 8; k++) {
    const double x = at[k & 1], y = at[k >> 1 & 1], z = at[k >> 2];
    const CagVec3 dx = cag_vec3(1, b->mixed[1] * z, b->mixed[2] * y + 2 * b->squared[2] * x),
                  dy = cag_vec3(b->mixed[0] * z + 2 * b->squared[0] * y, 1, b->mixed[2] * x),
                  dz = cag_vec3(b->mixed[0] * y, b->mixed[1] * x + 2 * b->squared[1] * z, 1);
    sum += cag_dot(dx, cag_cross(dy, dz)) / 8;
  }
  return sum;
}

// The distance of the point's preimage in the cube from the cube's surface. The map is close to the
// identity, so fixed-point iteration inverts it.
static double off_bent_cube(const Bend *b, CagVec3 p) {
  CagVec3 at = p;
  for (int k = 0; k < 200; k++) at = cag_add(at, cag_sub(p, bent(b, at)));
  const double x = fabs(at.x - 0.5), y = fabs(at.y - 0.5), z = fabs(at.z - 0.5);
  return fabs(fmax(x, fmax(y, z)) - 0.5);
}

// Face k as a patch of degree 2 in both directions, in any order and direction, over any domain.
// Weights in a geometric series change only the parametrization, and not affinely.
static CagSurface *bent_face(const Bend *b, int k, bool rational) {
  const double at[3] = {0, 0.5, 1};
  const bool swapped = chance() < 0.5, turned[2] = {chance() < 0.5, chance() < 0.5};
  const double ratio[2] = {between(0.6, 1.6), between(0.6, 1.6)};
  CagVec3 on[3][3], net[9];
  double weights[9], knots[2][6];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int s = turned[0] ? 2 - i : i, t = turned[1] ? 2 - j : j;
      double p[3];
      p[k / 2] = k % 2;
      p[(k / 2 + 1) % 3] = at[swapped ? t : s];
      p[(k / 2 + 2) % 3] = at[swapped ? s : t];
      on[i][j] = bent(b, cag_vec3(p[0], p[1], p[2]));
      weights[3 * i + j] = pow(ratio[0], i) * pow(ratio[1], j);
    }
  // A parabola through a, m, and c at 0, 1/2, and 1 has the middle control point 2 m - (a + c) / 2.
  for (int i = 0; i < 3; i++)
    on[i][1] = cag_sub(cag_scaled(on[i][1], 2), cag_lerp(on[i][0], on[i][2], 0.5));
  for (int j = 0; j < 3; j++)
    on[1][j] = cag_sub(cag_scaled(on[1][j], 2), cag_lerp(on[0][j], on[2][j], 0.5));
  for (int i = 0; i < 9; i++) net[i] = on[i / 3][i % 3];
  for (int d = 0; d < 2; d++) {
    const double from = between(-9, 9), to = from + between(0.1, 9);
    for (int i = 0; i < 6; i++) knots[d][i] = i < 3 ? from : to;
  }
  CagSurface *s;
  OK(cag_surface_nurbs(net, rational ? weights : NULL, 3, 3, 2, 2, knots[0], knots[1], &s, &err));
  return s;
}

static void faces_with_parameters_of_their_own_join(void **state) {
  (void)state;
  chance_state = 31;
  for (int round = 0; round < 60; round++) {
    Bend b;
    CagSurface *faces[6];
    CagSolid *s;
    for (int k = 0; k < 3; k++) b.mixed[k] = between(0.05, 0.2), b.squared[k] = between(-0.2, 0.2);
    for (int k = 0; k < 6; k++) faces[k] = bent_face(&b, k, round % 2);
    OK(cag_solid_shell(faces, 6, &s, &err));
    CagMesh *m = mesh_of(s, 1e-3);
    check_closed("bent cube", m, 0, 1);
    NEAR(volume_of(m), bent_volume(&b), 4e-3); // the area is about 6
    for (size_t v = 0; v < m->vertex_count; v++)
      assert_true(off_bent_cube(&b, m->positions[v]) < 1e-9);
    cag_mesh_release(m);
    cag_solid_release(s);
    for (int k = 0; k < 6; k++) cag_surface_release(faces[k]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_of_operations_lie_on_their_operands),
      cmocka_unit_test(rays_through_operations_cross_the_exact_surfaces),
      cmocka_unit_test(volumes_and_areas_converge),
      cmocka_unit_test(caps_with_holes_have_their_area),
      cmocka_unit_test(mirrored_and_stretched_copies_are_closed),
      cmocka_unit_test(units_do_not_matter),
      cmocka_unit_test(what_is_smaller_than_the_tolerance_is_closed),
      cmocka_unit_test(tubes_with_tight_bends_keep_their_volume),
      cmocka_unit_test(points_of_other_solids_lie_on_their_surfaces),
      cmocka_unit_test(seams_agree_to_the_bit),
      cmocka_unit_test(faces_with_parameters_of_their_own_join),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
