// Solids without faces: which parts operations keep, extents, point classification, and clipping.

#include <math.h>
#include <stdlib.h>

#include "geom/solid/clip.h"
#include "geom/solid/csg.h"
#include "geom/solid/inside.h"
#include "geom/solid/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static CagSolid *box(double size) {
  CagSolid *s = NULL;
  OK(cag_solid_box(cag_vec3(size, size, size), false, &s, &err));
  return s;
}

static CagSolid *sphere(double radius) {
  CagSolid *s = NULL;
  OK(cag_solid_sphere(radius, &s, &err));
  return s;
}

// Takes ownership of the solid.
static CagSolid *moved(CagSolid *s, double x, double y, double z) {
  CagSolid *out = NULL;
  CagTransform t = cag_translate(cag_vec3(x, y, z));
  OK(cag_solid_transform(s, &t, &out, &err));
  cag_solid_release(s);
  return out;
}

// Takes ownership of both.
static CagSolid *combined(CagSetOperation op, CagSolid *a, CagSolid *b) {
  CagSolid *out = NULL;
  OK(cag_solid_combine(op, (CagSolid *[]){a, b}, 2, NULL, &out, &err));
  cag_solid_release(a);
  cag_solid_release(b);
  return out;
}

static CagSolid *side_of(CagVec3 point, CagVec3 normal) {
  CagPlane plane;
  CagSolid *s = NULL;
  OK(cag_plane(point, normal, &plane, &err));
  OK(cag_solid_half_space(&plane, &s, &err));
  return s;
}

static double volume(const CagSolid *s) {
  CagMassProperties m;
  OK(cag_solid_mass(s, &m, &err));
  return m.volume;
}

static void operations_of_one_kind_are_one(void **state) {
  (void)state;
  CagSolid *s = box(1);
  for (int i = 1; i < 50; i++) s = combined(CAG_UNION, s, moved(box(1), i, 0, 0));
  assert_int_equal(s->core->count, 50);
  NEAR(volume(s), 50, 1e-10);
  // A moved union is kept as one operand, because its operands are elsewhere.
  CagSolid *t = combined(CAG_UNION, moved(s, 0, 5, 0), box(1));
  assert_int_equal(t->core->count, 2);
  cag_solid_release(t);
}

static void moved_operations_share_their_mesh(void **state) {
  (void)state;
  CagSolid *s = combined(CAG_DIFFERENCE, sphere(3), box(9)), *copy = NULL;
  CagTransform t = cag_translate(cag_vec3(10, 0, 0));
  OK(cag_solid_transform(s, &t, &copy, &err));
  assert_ptr_equal(s->core, copy->core);
  NEAR(volume(copy), 36 * M_PI * 7 / 8, 36 * M_PI * 2e-3);
  assert_non_null(s->core->mesh);
  const CagMesh *kept = s->core->mesh;
  NEAR(volume(s), volume(copy), 1e-9);
  assert_ptr_equal(s->core->mesh, kept);
  cag_solid_release(s);
  cag_solid_release(copy);
}

static void reach_of_sides(void **state) {
  (void)state;
  CagBounds b;
  CagSolid *s = side_of(cag_vec3(0, 0, 4), cag_vec3(0, 0, 2));
  OK(cag_solid_reach(s, &b, &err));
  NEAR(b.max.z, 4, 1e-15);
  assert_true(isinf(b.min.z) && isinf(b.max.x));
  s = combined(CAG_INTERSECTION, s, sphere(9));
  OK(cag_solid_reach(s, &b, &err));
  NEAR(b.max.z, 4, 1e-15);
  NEAR(b.min.z, -9, 1e-9);
  cag_solid_release(s);
  // For an ellipsoid rotated about z by a, half of the width is sqrt(a^2 cos^2 + b^2 sin^2).
  const CagQuadric q = {{(1.0 / 9 + 1) / 2, (1.0 / 9 + 1) / 2, 1, 1.0 / 9 - 1, 0, 0, 0, 0, 0, -1}};
  OK(cag_solid_quadric(&q, &s, &err));
  OK(cag_solid_reach(s, &b, &err));
  NEAR(b.max.x, sqrt(5), 1e-12);
  NEAR(b.min.y, -sqrt(5), 1e-12);
  cag_solid_release(s);
}

static void bounds_of_differences_that_keep_their_sides(void **state) {
  (void)state;
  CagBounds b;
  CagSolid *s = combined(CAG_DIFFERENCE, box(4), moved(sphere(1), 2, 2, 4));
  OK(cag_solid_bounds(s, &b, &err));
  near_vec(b.max, cag_vec3(4, 4, 4), 0);
  assert_null(s->core->mesh); // known without the operation
  cag_solid_release(s);
  s = combined(CAG_DIFFERENCE, box(4), moved(box(9), -1, -1, 3));
  OK(cag_solid_bounds(s, &b, &err));
  near_vec(b.max, cag_vec3(4, 4, 3), 1e-12);
  cag_solid_release(s);
}

static double *side_of_box(CagBounds *b, int axis, bool upper) {
  CagVec3 *corner = upper ? &b->max : &b->min;
  return axis == 0 ? &corner->x : axis == 1 ? &corner->y : &corner->z;
}

// At each of the six extremes of a ball, a slab removes a cap, a rod keeps the extremes on two
// sides and removes those on four, a distant box removes nothing, and a half space cuts.
static void each_side_of_a_difference_is_cut_alone(void **state) {
  (void)state;
  const CagVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int axis = 0; axis < 3; axis++)
    for (int upper = 0; upper < 2; upper++) {
      const CagVec3 way = cag_scaled(axes[axis], upper ? 1 : -1);
      const CagVec3 middle = cag_vec3(10, -20, 30);
      const struct {
        double shift, size, cut;
      } cases[] = {{6.2, 10, 1.2}, {0, 0, 3}, {14, 10, 3}, {9, 10, 3}};
      for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        CagSolid *tool, *s;
        CagBounds b, expected = {cag_vec3(7, -23, 27), cag_vec3(13, -17, 33)};
        if (cases[i].size > 0) {
          const double z = cases[i].size;
          OK(cag_solid_box(cag_vec3(z, z, z), true, &tool, &err));
          const CagVec3 at = cag_madd(middle, cases[i].shift, way);
          tool = moved(tool, at.x, at.y, at.z);
        } else {
          // Between the poles: a small ball on the surface.
          const CagVec3 slant = cag_add(way, cag_scaled(axes[(axis + 1) % 3], 1));
          const CagVec3 at = cag_madd(middle, 3, cag_unit(slant));
          tool = moved(sphere(0.5), at.x, at.y, at.z);
        }
        *side_of_box(&expected, axis, upper) += (cases[i].cut - 3) * (upper ? 1 : -1);
        s = combined(CAG_DIFFERENCE, moved(sphere(3), 10, -20, 30), tool);
        OK(cag_solid_bounds(s, &b, &err));
        // The extremes that the cut does not affect are exact.
        near_vec(b.min, expected.min, 1e-9);
        near_vec(b.max, expected.max, 1e-9);
        cag_solid_release(s);
      }
      // The reach of a half space perpendicular to an axis.
      CagBounds reach;
      CagSolid *s = side_of(cag_madd(middle, 2, way), cag_scaled(way, 7));
      OK(cag_solid_reach(s, &reach, &err));
      const double at = cag_dot(cag_madd(middle, 2, way), axes[axis]);
      for (int k = 0; k < 3; k++)
        for (int end = 0; end < 2; end++) {
          const double found = *side_of_box(&reach, k, end);
          if (k == axis && end == upper) NEAR(found, at, 1e-12);
          else assert_true(isinf(found) && (found > 0) == (end == 1));
        }
      if (upper) {
        s = combined(CAG_INTERSECTION, moved(sphere(3), 10, -20, 30), s);
        OK(cag_solid_bounds(s, &reach, &err));
        NEAR(*side_of_box(&reach, axis, true), at, 1e-9);
        NEAR(*side_of_box(&reach, axis, false), cag_dot(middle, axes[axis]) - 3, 1e-9);
      }
      cag_solid_release(s);
    }
  // Two operands whose difference is empty.
  CagBounds b;
  CagSolid *none[2];
  for (int i = 0; i < 2; i++)
    none[i] = combined(CAG_INTERSECTION, sphere(1), moved(sphere(1), 0, 5 + i, 0));
  CagSolid *s = combined(CAG_UNION, moved(none[0], 1, 0, 0), moved(none[1], 2, 0, 0));
  FAILS(cag_csg_bounds(s, &b, &err), "empty-shape");
  cag_solid_release(s);
}

static CagStatus no_leaf(void *context, const CagSolid *leaf, CagVec3 p, int *side, CagError *e) {
  (void)context;
  (void)e;
  double d = cag_norm(p) - leaf->a; // placed spheres
  *side = fabs(d) < 1e-12 ? 0 : d < 0 ? -1 : 1;
  return CAG_OK;
}

static void boundaries_belong_to_both_sides(void **state) {
  (void)state;
  int side;
  CagSolid *s = combined(CAG_DIFFERENCE, sphere(3), sphere(1));
  const struct {
    double x;
    int side;
  } cases[] = {{0, 1}, {1, 0}, {2, -1}, {3, 0}, {4, 1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    OK(cag_csg_side(s, cag_vec3(cases[i].x, 0, 0), 1e-12, no_leaf, NULL, &side, &err));
    assert_int_equal(side, cases[i].side);
  }
  cag_solid_release(s);
}

static void meshes_enclose_when_they_are_closed(void **state) {
  (void)state;
  CagMesh *m = NULL, *flipped = NULL;
  CagSolid *s = NULL, *b = box(2);
  OK(cag_solid_tessellate(b, NULL, &m, &err));
  OK(cag_mesh_flip(m, &flipped, &err));
  OK(cag_solid_from_mesh(flipped, &s, &err));
  NEAR(volume(s), 8, 1e-12);
  cag_solid_release(s);
  flipped->triangle_count--;
  assert_int_equal(cag_solid_from_mesh(flipped, &s, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "mesh-open");
  cag_mesh_release(m);
  cag_mesh_release(flipped);
  cag_solid_release(b);
}

// The mesh of a box with sides a, b, c, rotated and translated: I = V / 12 diag(b^2 + c^2, ...)
// along its edges.
static void meshes_have_the_inertia_of_boxes(void **state) {
  (void)state;
  const double e[3] = {2, 3, 5}, volume_of = 30;
  CagTransform place = cag_rpy(0.3, -0.8, 1.1);
  CagSolid *s, *t;
  CagMesh *m;
  CagMassProperties mass;
  place.m[0][3] = 40, place.m[1][3] = -20, place.m[2][3] = 10;
  OK(cag_solid_box(cag_vec3(e[0], e[1], e[2]), true, &s, &err));
  OK(cag_solid_tessellate(s, NULL, &m, &err));
  cag_solid_release(s);
  OK(cag_solid_from_mesh(m, &s, &err));
  cag_mesh_release(m);
  OK(cag_solid_transform(s, &place, &t, &err));
  OK(cag_csg_mass(t, 0, &mass, &err));
  NEAR(mass.volume, volume_of, 1e-10);
  NEAR(mass.area, 2 * (6 + 10 + 15), 1e-10);
  near_vec(mass.volume_centroid, cag_vec3(40, -20, 10), 1e-10);
  near_vec(mass.area_centroid, cag_vec3(40, -20, 10), 1e-10);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) {
        const double b = e[(k + 1) % 3], c = e[(k + 2) % 3];
        sum += place.m[i][k] * place.m[j][k] * volume_of / 12 * (b * b + c * c);
      }
      NEAR(mass.inertia[i][j], sum, 1e-9);
    }
  cag_solid_release(s);
  cag_solid_release(t);
}

static void what_is_empty_or_endless_says_so(void **state) {
  (void)state;
  CagMesh *m = NULL;
  CagBounds b;
  CagSolid *s = combined(CAG_INTERSECTION, sphere(1), moved(sphere(1), 5, 0, 0));
  NEAR(volume(s), 0, 0);
  FAILS(cag_solid_bounds(s, &b, &err), "empty-shape");
  OK(cag_solid_tessellate(s, NULL, &m, &err));
  assert_int_equal(m->triangle_count, 0);
  cag_mesh_release(m);
  bool empty;
  OK(cag_solid_is_empty(s, &empty, &err));
  assert_true(empty);
  // The union with a ball is the ball, and so is that with the ball removed.
  s = combined(CAG_UNION, sphere(2), s);
  OK(cag_solid_bounds(s, &b, &err));
  near_vec(b.max, cag_vec3(2, 2, 2), 1e-12);
  NEAR(volume(s), 32 * M_PI / 3, 32 * M_PI / 3 * 2e-3);
  OK(cag_solid_is_empty(s, &empty, &err));
  assert_false(empty);
  cag_solid_release(s);
  CagSolid *nothing;
  OK(cag_solid_empty(&nothing, &err));
  s = combined(CAG_DIFFERENCE, box(2), nothing);
  NEAR(volume(s), 8, 1e-12);
  cag_solid_release(s);
  s = side_of(cag_vec3(0, 0, 0), cag_vec3(1, 1, 0));
  OK(cag_solid_is_empty(s, &empty, &err));
  assert_false(empty);
  cag_solid_release(s);
  s = combined(CAG_UNION, sphere(1), side_of(cag_vec3(0, 0, 0), cag_vec3(1, 1, 0)));
  assert_int_equal(cag_solid_bounds(s, &b, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "solid-unbounded");
  // The intersection with a ball is the half ball and the part of the other half that the union
  // adds.
  s = combined(CAG_INTERSECTION, s, sphere(3));
  NEAR(volume(s), 18 * M_PI + 2 * M_PI / 3, 20 * M_PI * 2e-3);
  cag_solid_release(s);
}

static void an_interrupt_stops_operations(void **state) {
  (void)state;
  static volatile int stop = 1;
  CagSolid *s = NULL, *parts[2] = {sphere(3), box(2)};
  CagMesh *m = NULL;
  OK(cag_solid_combine(CAG_DIFFERENCE, parts, 2, &stop, &s, &err));
  assert_int_equal(cag_solid_tessellate(s, NULL, &m, &err), CAG_E_CALLBACK);
  for (int i = 0; i < 2; i++) cag_solid_release(parts[i]);
  cag_solid_release(s);
}

static void clipped_surfaces_end_on_the_solid(void **state) {
  (void)state;
  CagSolid *by = sphere(2);
  CagSurface *s = NULL;
  CagMesh *m = NULL;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 1e-3;
  OK(cag_surface_bilinear(cag_vec3(-5, -5, 1), cag_vec3(-5, 5, 1), cag_vec3(5, -5, 1),
                          cag_vec3(5, 5, 1), &s, &err));
  OK(cag_surface_clip(s, by, &how, &m, &err));
  NEAR(cag_mesh_area(m), 3 * M_PI, 3 * M_PI * 2e-3);
  double farthest = 0;
  for (size_t i = 0; i < m->vertex_count; i++) farthest = fmax(farthest, cag_norm(m->positions[i]));
  NEAR(farthest, 2, 1e-9);
  cag_mesh_release(m);
  cag_surface_release(s);
  cag_solid_release(by);
}

static void clipped_curves_end_on_the_solid(void **state) {
  (void)state;
  CagSolid *by = combined(CAG_DIFFERENCE, sphere(2), sphere(1));
  const CagVec3 ends[2] = {{-5, 0, 0}, {5, 0, 0}};
  CagCurve *line = NULL, **pieces = NULL;
  size_t n = 0;
  CagVec3 p;
  OK(cag_curve_polyline(ends, 2, false, 3, &line, &err));
  OK(cag_curve_clip(line, by, NULL, &pieces, &n, &err));
  assert_int_equal(n, 2);
  const double at[4] = {-2, -1, 1, 2};
  for (size_t i = 0; i < 4; i++) {
    const CagCurve *c = pieces[i / 2];
    OK(cag_curve_point(c, i % 2 ? c->end : c->start, &p, &err));
    near_vec(p, cag_vec3(at[i], 0, 0), 1e-10);
  }
  for (size_t i = 0; i < n; i++) cag_curve_release(pieces[i]);
  free(pieces);
  cag_curve_release(line);
  cag_solid_release(by);
}

// --- Random trees of operations, compared with equations of their operands ---

// A solid and its expected value: an equation in the coordinates of its placement, or two parts.
typedef struct Model {
  CagSolid *solid;
  int kind;          // kind of the equation; 10 and more: an operation
  double a, b, c;    // sizes
  CagTransform back; // from world coordinates
  int parts[2];
} Model;

static struct {
  Model at[32];
  int n;
} models;

static double between(double low, double high) { return uniform(low, high); }

static CagTransform random_placement(void) {
  double angles[3], way[3];
  for (int i = 0; i < 3; i++) angles[i] = between(-3, 3);
  for (int i = 0; i < 3; i++) way[i] = between(-1, 1);
  const CagTransform turn = cag_rpy(angles[0], angles[1], angles[2]),
                     lift = cag_translate(cag_vec3(way[0], way[1], way[2]));
  return cag_transform_multiply(&lift, &turn);
}

// Negative inside.
static double model_value(const Model *m, CagVec3 world) {
  const CagVec3 p = cag_transform_point(&m->back, world);
  const double a = m->a, b = m->b, c = m->c;
  double x = 0, y = 0;
  if (m->kind >= 10) {
    x = model_value(&models.at[m->parts[0]], p);
    y = model_value(&models.at[m->parts[1]], p);
  }
  switch (m->kind) {
  case 0: return fmax(fabs(p.x) - a / 2, fmax(fabs(p.y) - b / 2, fabs(p.z) - c / 2));
  case 1: return fmax(fmax(-p.x, p.x - a), fmax(fmax(-p.y, p.y - b), fmax(-p.z, p.z - c)));
  case 2: return cag_norm(p) - a;
  case 3: return fmax(fmax(-p.z, p.z - a), hypot(p.x, p.y) - (b + (c - b) * p.z / a));
  case 4: return hypot(hypot(p.x, p.y) - a, p.z) - b;
  case 5: return -p.z;
  case 6: return p.x * p.x / (a * a) + p.y * p.y / (b * b) - p.z * p.z / (c * c) - 1;
  case 7: return fmax(fmax(-p.x, -p.y), fmax(-p.z, p.x + p.y + p.z - a)); // a tetrahedron
  case 10: return fmin(x, y);
  case 11: return fmax(x, -y);
  default: return fmax(x, y);
  }
}

static CagSolid *primitive(Model *m) {
  static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  static const CagPlane level = {{0, 0, 0}, {0, 0, -1}};
  const double a = m->a, b = m->b, c = m->c;
  const CagQuadric form = {{1 / (a * a), 1 / (b * b), -1 / (c * c), 0, 0, 0, 0, 0, 0, -1}};
  CagSolid *s = NULL;
  CagMesh *mesh;
  switch (m->kind) {
  case 0:
  case 1: OK(cag_solid_box(cag_vec3(a, b, c), m->kind == 0, &s, &err)); break;
  case 2: OK(cag_solid_sphere(a, &s, &err)); break;
  case 3: OK(cag_solid_cylinder(a, b, c, &s, &err)); break;
  case 4: OK(cag_solid_torus(a, b, &s, &err)); break;
  case 5: OK(cag_solid_half_space(&level, &s, &err)); break;
  case 6: OK(cag_solid_quadric(&form, &s, &err)); break;
  default:
    OK(cag_mesh_new(4, 4, false, false, false, &mesh, &err));
    mesh->positions[0] = cag_vec3(0, 0, 0);
    mesh->positions[1] = cag_vec3(a, 0, 0);
    mesh->positions[2] = cag_vec3(0, a, 0);
    mesh->positions[3] = cag_vec3(0, 0, a);
    memcpy(mesh->triangles, faces, sizeof faces);
    OK(cag_solid_from_mesh(mesh, &s, &err));
    cag_mesh_release(mesh);
  }
  return s;
}

// Creates a tree of this depth, and returns its index.
static int random_model(int depth) {
  Model m = {.kind = depth > 0 ? 10 + (int)between(0, 3) : (int)between(0, 8)};
  m.a = between(0.8, 2), m.b = between(0.3, 0.8), m.c = between(0.3, 1.5);
  CagSolid *made = NULL;
  if (m.kind >= 10) {
    static const CagSetOperation operations[] = {CAG_UNION, CAG_DIFFERENCE, CAG_INTERSECTION};
    for (int i = 0; i < 2; i++) m.parts[i] = random_model(depth - 1);
    CagSolid *two[2] = {models.at[m.parts[0]].solid, models.at[m.parts[1]].solid};
    OK(cag_solid_combine(operations[m.kind - 10], two, 2, NULL, &made, &err));
  } else {
    made = primitive(&m);
  }
  CagTransform place = cag_transform_identity();
  if (m.kind < 10 || between(0, 1) < 0.5) place = random_placement();
  OK(cag_transform_inverse(&place, &m.back, &err));
  OK(cag_solid_transform(made, &place, &m.solid, &err));
  cag_solid_release(made);
  models.at[models.n] = m;
  return models.n++;
}

static void operations_hold_what_their_equations_say(void **state) {
  (void)state;
  seed = 61;
  size_t held = 0;
  for (int k = 0; k < 120; k++) {
    const CagTessellation how = CAG_TESSELLATION_DEFAULT;
    models.n = 0;
    const Model *top = &models.at[random_model(k % 4)];
    CagInside *inside;
    CagBounds reach;
    OK(cag_solid_reach(top->solid, &reach, &err));
    OK(cag_inside_new(top->solid, &how, &inside, &err));
    for (int i = 0; i < 300; i++) {
      double x[3];
      for (int j = 0; j < 3; j++) x[j] = between(-3, 3);
      const CagVec3 p = cag_vec3(x[0], x[1], x[2]);
      const double value = model_value(top, p);
      bool holds;
      OK(cag_inside_holds(inside, p, &holds, &err));
      if (fabs(value) < 1e-9) continue;
      if (holds != (value < 0)) fail_msg("tree %d: the point %d has the value %g", k, i, value);
      held += holds;
      if (!holds) continue;
      const double slack = 1e-9;
      assert_true(p.x >= reach.min.x - slack && p.y >= reach.min.y - slack &&
                  p.z >= reach.min.z - slack);
      assert_true(p.x <= reach.max.x + slack && p.y <= reach.max.y + slack &&
                  p.z <= reach.max.z + slack);
    }
    cag_inside_free(inside);
    // Pieces of a line: each is inside, and its ends are on the boundary or at an end of the line.
    // Together they are as long as the part of the line inside.
    const CagVec3 ends[2] = {{-4, between(-1, 1), 0.3}, {4, between(-1, 1), between(-1, 1)}};
    CagCurve *line, **pieces;
    size_t n;
    double length = 0, within = 0;
    const int samples = 2000;
    OK(cag_curve_polyline(ends, 2, false, 3, &line, &err));
    OK(cag_curve_clip(line, top->solid, NULL, &pieces, &n, &err));
    for (int i = 0; i < samples; i++)
      within += model_value(top, cag_lerp(ends[0], ends[1], (i + 0.5) / samples)) < 0;
    for (size_t i = 0; i < n; i++) {
      CagVec3 p[3];
      for (int j = 0; j < 3; j++) {
        const double t = pieces[i]->start + (pieces[i]->end - pieces[i]->start) * j / 2;
        OK(cag_curve_point(pieces[i], t, &p[j], &err));
        const bool end =
            cag_norm(cag_sub(p[j], ends[0])) < 1e-9 || cag_norm(cag_sub(p[j], ends[1])) < 1e-9;
        if (j != 1 && !end) NEAR(model_value(top, p[j]), 0, 1e-5);
      }
      length += cag_norm(cag_sub(p[2], p[0]));
      cag_curve_release(pieces[i]);
    }
    NEAR(length / cag_norm(cag_sub(ends[1], ends[0])), within / samples, 0.006);
    free(pieces);
    cag_curve_release(line);
    for (int i = 0; i < models.n; i++) cag_solid_release(models.at[i].solid);
  }
  assert_true(held > 1000);
}

// --- Meshes of random trees ---

// A tree inside a rotated box, as the last model.
static const Model *random_body(int depth) {
  Model box = {.kind = 0}, top = {.kind = 12};
  models.n = 0;
  const int tree = random_model(depth), other = models.n;
  box.a = between(1.5, 2.5), box.b = between(1.5, 2.5), box.c = between(1.5, 2.5);
  CagSolid *made = primitive(&box);
  const CagTransform place = random_placement();
  OK(cag_transform_inverse(&place, &box.back, &err));
  OK(cag_solid_transform(made, &place, &box.solid, &err));
  cag_solid_release(made);
  models.at[models.n++] = box;
  top.parts[0] = tree, top.parts[1] = other;
  top.back = cag_transform_identity();
  CagSolid *two[2] = {models.at[tree].solid, box.solid};
  OK(cag_solid_combine(CAG_INTERSECTION, two, 2, NULL, &top.solid, &err));
  models.at[models.n++] = top;
  return &models.at[models.n - 1];
}

static void meshes_of_operations_end_where_their_equations_say(void **state) {
  (void)state;
  seed = 67;
  enum { N = 12 };
  size_t held = 0;
  for (int k = 0; k < 30; k++) {
    const Model *top = random_body(k % 3);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m;
    CagMassProperties mass;
    double terms[10] = {0};
    how.tolerance = 2e-2;
    OK(cag_csg_mesh(top->solid, &how, &m, &err));
    assert_true(m->triangle_count == 0 || cag_mesh_is_watertight(m, NULL));
    // The forms of hyperboloids are not distances.
    for (size_t i = 0; i < m->vertex_count; i++)
      NEAR(model_value(top, m->positions[i]), 0, 1e-6 + 8 * how.tolerance);
    cag_mesh_volume_terms(m, terms);
    double sum = 0;
    CagVec3 low = cag_vec3(INFINITY, INFINITY, INFINITY), high = cag_scaled(low, -1);
    const double step = 6.0 / N;
    for (int i = 0; i < N * N * N; i++) {
      const double jitter[3] = {between(0, 1), between(0, 1), between(0, 1)};
      const CagVec3 p =
          cag_vec3(-3 + (i % N + jitter[0]) * step, -3 + (i / N % N + jitter[1]) * step,
                   -3 + (i / N / N + jitter[2]) * step);
      if (!(model_value(top, p) < 0)) continue;
      sum += step * step * step;
      low = cag_vec3(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
      high = cag_vec3(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
      held++;
    }
    // Stratified sampling with cells of 0.375: the standard deviation is at most that of the cells
    // at the boundary.
    const double slack =
        4 * sqrt(6 * pow(cbrt(sum) + step, 2) / (step * step) + 1) * pow(step, 3) / 2;
    NEAR(terms[0], sum, slack);
    OK(cag_csg_mass(top->solid, how.tolerance, &mass, &err));
    NEAR(mass.volume, terms[0], 1e-9);
    NEAR(mass.area, cag_mesh_area(m), 1e-9);
    const CagBounds b = cag_mesh_bounds(m);
    const double room = 1e-2;
    if (sum > 0) {
      assert_true(low.x > b.min.x - room && low.y > b.min.y - room && low.z > b.min.z - room);
      assert_true(high.x < b.max.x + room && high.y < b.max.y + room && high.z < b.max.z + room);
    }
    cag_mesh_release(m);
    for (int i = 0; i < models.n; i++) cag_solid_release(models.at[i].solid);
  }
  assert_true(held > 300);
}

// The mesh of a scaled copy is that of the original, with the tolerance divided by the scale.
static void tolerances_scale_with_copies(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    const double factor = k == 0 ? 8 : k == 1 ? 0.25 : 1;
    CagTransform scale;
    CagSolid *a = combined(CAG_DIFFERENCE, sphere(3), box(9)),
             *b = combined(CAG_DIFFERENCE, sphere(3), box(9)), *copy;
    CagMesh *m, *n;
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    OK(cag_scale(cag_vec3(factor, factor, factor), cag_vec3(0, 0, 0), &scale, &err));
    OK(cag_solid_transform(b, &scale, &copy, &err));
    how.tolerance = 2e-2;
    if (k == 2) how.max_edge = 0.9;
    OK(cag_csg_mesh(a, &how, &m, &err));
    how.tolerance *= factor;
    OK(cag_csg_mesh(copy, &how, &n, &err));
    assert_int_equal(m->triangle_count, n->triangle_count);
    NEAR(cag_mesh_area(n) / cag_mesh_area(m), factor * factor, 1e-9 * factor * factor);
    cag_mesh_release(m);
    cag_mesh_release(n);
    cag_solid_release(copy);
    // A stretched copy satisfies the tolerance: points of its mesh are on the ellipsoid or in the
    // planes.
    OK(cag_scale(cag_vec3(factor, 1, 2), cag_vec3(0, 0, 0), &scale, &err));
    OK(cag_solid_transform(b, &scale, &copy, &err));
    const double longest = 1.5 * fmax(1, factor);
    how.max_edge = longest;
    how.tolerance = 3e-2 * fmax(1, factor);
    OK(cag_csg_mesh(copy, &how, &n, &err));
    for (size_t i = 0; i < n->triangle_count; i++) {
      const uint32_t *t = n->triangles + 3 * i;
      CagVec3 middle = {0, 0, 0};
      for (int j = 0; j < 3; j++) {
        const CagVec3 p = n->positions[t[j]], q = n->positions[t[(j + 1) % 3]];
        assert_true(cag_norm(cag_sub(p, q)) <= longest * (1 + 1e-9));
        middle = cag_madd(middle, 1.0 / 3, p);
      }
      const CagVec3 back = cag_vec3(middle.x / factor, middle.y, middle.z / 2);
      const double flat = fmin(fabs(middle.x), fmin(fabs(middle.y), fabs(middle.z)));
      const double stretch = fmax(2, factor);
      if (flat > 1e-9) NEAR(3 - cag_norm(back), 0, how.tolerance * stretch);
    }
    cag_mesh_release(n);
    cag_solid_release(copy);
    cag_solid_release(a);
    cag_solid_release(b);
  }
}

// Random planes may bound a body although none of them does alone. Without one of them, the body is
// unbounded.
static void half_spaces_may_bound_a_body(void **state) {
  (void)state;
  seed = 68;
  for (int k = 0; k < 12; k++) {
    const CagVec3 n[4] = {{1, 0, -0.5}, {-0.6, 0.9, -0.4}, {-0.5, -0.8, -0.6}, {0.1, 0.1, 1}};
    const CagTransform place = random_placement();
    const double size = pow(10, between(-3, 3));
    CagTransform grow;
    CagSolid *parts[4], *s, *moved_too, *scaled;
    CagMassProperties m;
    CagBounds b;
    const size_t count = k % 4 == 3 ? 3 : 4;
    OK(cag_scale(cag_vec3(size, size, size), cag_vec3(0, 0, 0), &grow, &err));
    for (int i = 0; i < 4; i++) parts[i] = side_of(cag_scaled(cag_unit(n[i]), 1), n[i]);
    OK(cag_solid_combine(CAG_INTERSECTION, parts, count, NULL, &s, &err));
    OK(cag_solid_transform(s, &place, &moved_too, &err));
    OK(cag_solid_transform(moved_too, &grow, &scaled, &err));
    if (count < 4) {
      FAILS(cag_csg_bounds(scaled, &b, &err), "solid-unbounded");
      bool empty;
      OK(cag_solid_is_empty(scaled, &empty, &err));
      assert_false(empty);
    } else {
      // The corners from Cramer's rule, and the volume of the tetrahedron.
      CagVec3 corner[4];
      CagBounds box = CAG_BOUNDS_EMPTY;
      for (int i = 0; i < 4; i++) {
        const CagVec3 p = cag_unit(n[(i + 1) % 4]), q = cag_unit(n[(i + 2) % 4]),
                      r = cag_unit(n[(i + 3) % 4]);
        const CagVec3 sum = cag_add(cag_cross(p, q), cag_add(cag_cross(q, r), cag_cross(r, p)));
        corner[i] = cag_scaled(sum, 1 / cag_dot(p, cag_cross(q, r)));
        const CagVec3 at = cag_transform_point(&grow, cag_transform_point(&place, corner[i]));
        cag_bounds_add(&box, at);
      }
      const double volume_of =
          fabs(cag_dot(cag_sub(corner[1], corner[0]),
                       cag_cross(cag_sub(corner[2], corner[0]), cag_sub(corner[3], corner[0])))) /
          6;
      OK(cag_csg_mass(scaled, 0, &m, &err));
      NEAR(m.volume / (volume_of * size * size * size), 1, 1e-9);
      OK(cag_csg_bounds(scaled, &b, &err));
      near_vec(cag_scaled(b.min, 1 / size), cag_scaled(box.min, 1 / size), 1e-8);
      near_vec(cag_scaled(b.max, 1 / size), cag_scaled(box.max, 1 / size), 1e-8);
    }
    for (int i = 0; i < 4; i++) cag_solid_release(parts[i]);
    cag_solid_release(s);
    cag_solid_release(moved_too);
    cag_solid_release(scaled);
  }
}

// The form sum of (d_j (p - center))^2 / semi_j^2 - 1 over the first `ends` of the three
// directions, multiplied by `sense`.
static CagQuadric form_within(const CagVec3 d[3], const double *semi, int ends, CagVec3 center,
                              double sense) {
  CagQuadric q = {{0}};
  for (int j = 0; j < ends; j++) {
    const CagVec3 a = cag_scaled(d[j], 1 / semi[j]);
    const double k = -cag_dot(a, center);
    const double c[10] = {a.x * a.x,     a.y * a.y,   a.z * a.z,   2 * a.x * a.y, 2 * a.y * a.z,
                          2 * a.z * a.x, 2 * k * a.x, 2 * k * a.y, 2 * k * a.z,   k * k};
    for (int i = 0; i < 10; i++) q.c[i] += sense * c[i];
  }
  q.c[9] -= sense;
  return q;
}

static double part_of(CagVec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// Ellipsoids, elliptic cylinders, and slabs, in any direction, about an axis, and along the axes.
static void reach_of_turned_forms(void **state) {
  (void)state;
  seed = 21;
  for (int k = 0; k < 270; k++) {
    const int ends = 1 + k % 3, turns = k / 3 % 3, first = k / 9 % 3;
    const double x = uniform(-3, 3);
    const double y = uniform(-3, 3);
    const double z = uniform(-3, 3);
    CagTransform turn = cag_rpy(x, y, z);
    if (turns) {
      const double angle = turns == 1 ? x : 0;
      const CagVec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      OK(cag_rotate(axis[k / 27 % 3], angle, cag_vec3(0, 0, 0), &turn, &err));
    }
    CagVec3 d[3];
    double semi[3];
    for (int j = 0; j < 3; j++) {
      const int at = (j + first) % 3;
      d[j] = cag_scaled(cag_vec3(turn.m[0][at], turn.m[1][at], turn.m[2][at]), k % 2 ? -1 : 1);
      semi[j] = uniform(0.5, 3);
    }
    const CagVec3 center = {y, z, x};
    for (int out = 0; out < 2; out++) {
      const CagQuadric q = form_within(d, semi, ends, center, out ? -1 : 1);
      CagSolid *s;
      CagBounds b;
      OK(cag_solid_quadric(&q, &s, &err));
      OK(cag_solid_reach(s, &b, &err));
      for (int i = 0; i < 3; i++) {
        double square = 0;
        bool endless = out;
        for (int j = 0; j < 3; j++)
          if (j < ends) square += pow(semi[j] * part_of(d[j], i), 2);
          else endless = endless || fabs(part_of(d[j], i)) > 1e-9;
        const double low = part_of(b.min, i), high = part_of(b.max, i);
        if (endless) {
          assert_true(low == -INFINITY && high == INFINITY);
          continue;
        }
        NEAR(low, part_of(center, i) - sqrt(square), 1e-9);
        NEAR(high, part_of(center, i) + sqrt(square), 1e-9);
      }
      cag_solid_release(s);
    }
  }
  for (int k = 0; k < 6; k++) {
    const double sense = k % 2 ? -1 : 1;
    const CagVec3 n = {(k / 2 == 0) * sense, (k / 2 == 1) * sense, (k / 2 == 2) * sense};
    CagSolid *s = side_of(cag_vec3(2, 3, 4), n);
    CagBounds b;
    OK(cag_solid_reach(s, &b, &err));
    for (int i = 0; i < 3; i++) {
      assert_true(part_of(b.min, i) == (k == 2 * i + 1 ? 2.0 + i : -INFINITY));
      assert_true(part_of(b.max, i) == (k == 2 * i ? 2.0 + i : INFINITY));
    }
    cag_solid_release(s);
  }
}

// The distance of a point from a quadric is its value divided by the gradient, here from
// differences. Points within the slack are on the surface.
static void sides_of_forms_have_a_slack_in_space(void **state) {
  (void)state;
  const double slack = 1e-4, h = 1e-3;
  int tried = 0;
  seed = 22;
  for (int k = 0; k < 400; k++) {
    CagQuadric q;
    CagSolid *s;
    for (int i = 0; i < 10; i++) q.c[i] = uniform(-1, 1);
    double x[6];
    for (int i = 0; i < 6; i++) x[i] = uniform(-3, 3);
    CagVec3 p = {x[0], x[1], x[2]}, far = {x[3], x[4], x[5]};
    if (cag_quadric_value(&q, p) * cag_quadric_value(&q, far) > 0) continue;
    for (int i = 0; i < 100; i++) {
      const CagVec3 middle = cag_lerp(p, far, 0.5);
      if (cag_quadric_value(&q, p) * cag_quadric_value(&q, middle) > 0) p = middle;
      else far = middle;
    }
    double slope[3];
    for (int i = 0; i < 3; i++) {
      const CagVec3 step = {i == 0 ? h : 0, i == 1 ? h : 0, i == 2 ? h : 0};
      slope[i] =
          (cag_quadric_value(&q, cag_add(p, step)) - cag_quadric_value(&q, cag_sub(p, step))) /
          (2 * h); // exact for a quadratic form
    }
    const CagVec3 n = cag_vec3(slope[0], slope[1], slope[2]);
    if (cag_norm(n) < 0.5) continue;
    OK(cag_solid_quadric(&q, &s, &err));
    static const double shares[] = {-1.02, -0.98, 0.98, 1.02};
    for (int i = 0; i < 4; i++) {
      int side;
      OK(cag_csg_side(s, cag_madd(p, shares[i] * slack, cag_unit(n)), slack, no_leaf, NULL, &side,
                      &err));
      assert_int_equal(side, i == 0 ? -1 : i == 3 ? 1 : 0);
    }
    cag_solid_release(s);
    tried++;
  }
  assert_true(tried > 100);
}

static CagSolid *labeled(CagSolid *s, uint32_t label) {
  s->label = label;
  return s;
}

static uint32_t ten_times_more(void *context, uint32_t label) {
  ++*(int *)context;
  return 10 * (label + 1);
}

// Copies with other labels have the same faces, edges, and meshes.
static void copies_with_other_labels_are_alike(void **state) {
  (void)state;
  for (int k = 0; k < 7; k++) {
    CagSolid *s = box(2), *copy, *rod;
    int calls = 0;
    OK(cag_solid_cylinder(3, 0.4, k == 1 ? 0 : 0.4, &rod, &err));
    rod = moved(rod, 1, 1, -0.5);
    if (k < 2) {
      cag_solid_release(s);
      s = rod;
    } else if (k < 4) {
      s = combined(CAG_DIFFERENCE, s, rod); // labels of operands: neither, or both
      if (k == 3) {
        labeled(s->core->operands[0], 4);
        labeled(s->core->operands[1], 6);
      }
    } else if (k == 4) {
      CagSolid *both =
          combined(CAG_UNION, labeled(rod, 2), labeled(moved(sphere(0.7), 2, 0, 0), 3));
      s = moved(combined(CAG_DIFFERENCE, s, both), 5, 6, 7);
    } else cag_solid_release(rod);
    if (k == 6) s = labeled(s, 8);
    OK(cag_solid_relabel(s, ten_times_more, &calls, &copy, &err));
    assert_int_equal(calls, k == 3 ? 2 : k == 4 ? 3 : 1);
    assert_int_equal(cag_solid_first_label(copy), k == 3 ? 50 : k == 6 ? 90 : 10);
    assert_int_equal(cag_solid_first_label(s), k == 3 ? 4 : k == 4 ? 2 : k == 6 ? 8 : 0);
    assert_int_equal(copy->kind, s->kind);
    assert_int_equal(copy->face_count, s->face_count);
    assert_int_equal(copy->edge_count, s->edge_count);
    for (size_t i = 0; i < s->edge_count; i++)
      for (int side = 0; side < 2; side++) {
        assert_int_equal(copy->edges[i].face[side], s->edges[i].face[side]);
        assert_int_equal(copy->edges[i].side[side], s->edges[i].side[side]);
        assert_int_equal(copy->edges[i].reversed, s->edges[i].reversed);
      }
    CagMesh *m, *n;
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    how.tolerance = 0.01;
    OK(cag_csg_mesh(s, &how, &m, &err));
    OK(cag_csg_mesh(copy, &how, &n, &err));
    assert_int_equal(m->triangle_count, n->triangle_count);
    assert_memory_equal(m->positions, n->positions, m->vertex_count * sizeof *m->positions);
    for (size_t t = 0; t < m->triangle_count; t++) {
      assert_true(n->labels != NULL);
      assert_int_equal(n->labels[t], 10 * ((m->labels ? m->labels[t] : 0) + 1));
    }
    cag_mesh_release(m);
    cag_mesh_release(n);
    cag_solid_release(s);
    cag_solid_release(copy);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operations_of_one_kind_are_one),
      cmocka_unit_test(moved_operations_share_their_mesh),
      cmocka_unit_test(reach_of_sides),
      cmocka_unit_test(bounds_of_differences_that_keep_their_sides),
      cmocka_unit_test(each_side_of_a_difference_is_cut_alone),
      cmocka_unit_test(boundaries_belong_to_both_sides),
      cmocka_unit_test(meshes_enclose_when_they_are_closed),
      cmocka_unit_test(meshes_have_the_inertia_of_boxes),
      cmocka_unit_test(what_is_empty_or_endless_says_so),
      cmocka_unit_test(an_interrupt_stops_operations),
      cmocka_unit_test(clipped_surfaces_end_on_the_solid),
      cmocka_unit_test(clipped_curves_end_on_the_solid),
      cmocka_unit_test(operations_hold_what_their_equations_say),
      cmocka_unit_test(meshes_of_operations_end_where_their_equations_say),
      cmocka_unit_test(tolerances_scale_with_copies),
      cmocka_unit_test(half_spaces_may_bound_a_body),
      cmocka_unit_test(reach_of_turned_forms),
      cmocka_unit_test(sides_of_forms_have_a_slack_in_space),
      cmocka_unit_test(copies_with_other_labels_are_alike),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
