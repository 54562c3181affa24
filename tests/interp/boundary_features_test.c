// Faces, edges, and corners of boundaries that cag-brep computed.

#include "geom/boundary/features.h"
#include "geom/boundary/measure.h"
#include "tests/interp/boundary_support.h"

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

typedef struct Part {
  CagBoundary b;
  CagFeatures f;
} Part;

static Part part_turned(CagSolid *s, int turn) {
  Part p;
  p.b = boundary_turned(s, turn);
  OK(cag_boundary_features(&p.b, &p.f, &err));
  return p;
}

static Part part_of(CagSolid *s) { return part_turned(s, 0); }

static void part_free(Part *p) {
  cag_features_free(&p->f);
  cag_boundary_free(&p->b);
}

static void check_counts(const Part *p, size_t faces, size_t edges, size_t corners) {
  assert_int_equal(p->f.face_count, faces);
  assert_int_equal(p->f.edge_count, edges);
  assert_int_equal(p->f.corner_count, corners);
}

static void near_box(CagBounds b, CagVec3 min, CagVec3 max, double tolerance) {
  near_vec(b.min, min, tolerance);
  near_vec(b.max, max, tolerance);
}

// The first face of a kind whose center is near a point.
static const CagFaceFeature *face_at(const Part *p, const char *kind, CagVec3 center) {
  for (size_t i = 0; i < p->f.face_count; i++)
    if (strcmp(p->f.faces[i].kind, kind) == 0 &&
        cag_norm(cag_sub(p->f.faces[i].center, center)) < 1e-6)
      return &p->f.faces[i];
  fail_msg("no %s at [%g %g %g]", kind, center.x, center.y, center.z);
  return NULL;
}

static size_t edges_of_kind(const Part *p, const char *kind) {
  size_t n = 0;
  for (size_t i = 0; i < p->f.edge_count; i++) n += strcmp(p->f.edges[i].kind, kind) == 0;
  return n;
}

static void a_box_has_convex_right_angles(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Part p = part_of(a_box(40, 30, 20));
  check_counts(&p, 6, 12, 8);
  const CagFaceFeature *top = face_at(&p, "plane", cag_vec3(0, 0, 10));
  NEAR(top->area, 1200, 1e-9);
  near_vec(top->normal, cag_vec3(0, 0, 1), 1e-15);
  near_box(top->bounds, cag_vec3(-20, -15, 10), cag_vec3(20, 15, 10), 1e-12);
  near_vec(face_at(&p, "plane", cag_vec3(-20, 0, 0))->normal, cag_vec3(-1, 0, 0), 1e-15);
  double sum = 0;
  for (size_t i = 0; i < 12; i++) {
    const CagEdgeFeature *e = &p.f.edges[i];
    assert_string_equal(e->kind, "line");
    assert_int_equal(e->bend, CAG_EDGE_CONVEX);
    assert_int_equal(e->count, 2);
    NEAR(e->angle, M_PI / 2, 1e-14);
    assert_true(e->direction.x + e->direction.y + e->direction.z > 0.999);
    near_vec(cag_madd(e->start, e->length, e->direction), e->end, 1e-12);
    sum += e->length;
  }
  NEAR(sum, 4 * 90, 1e-11);
  for (size_t i = 0; i < 8; i++) {
    const CagCornerFeature *c = &p.f.corners[i];
    assert_int_equal(c->count, 3);
    for (size_t k = 0; k < 3; k++) {
      const CagEdgeFeature *e = &p.f.edges[p.f.corner_edges[c->first + k]];
      assert_true(cag_norm(cag_sub(e->start, c->point)) < 1e-12 ||
                  cag_norm(cag_sub(e->end, c->point)) < 1e-12);
    }
  }
  part_free(&p);
}

static void a_hole_has_circles_and_a_wall(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    CagSolid *hole = shifted(a_cylinder(40, 5, 5), 8, 0, -20);
    Part p = part_turned(combined(CAG_DIFFERENCE, a_box(40, 30, 20), hole), turn);
    check_counts(&p, 7, 14, 8);
    const CagFaceFeature *wall = face_at(&p, "cylinder", cag_vec3(8, 0, 0));
    NEAR(wall->area, 200 * M_PI, 1e-9);
    near_box(wall->bounds, cag_vec3(3, -5, -10), cag_vec3(13, 5, 10), 1e-9);
    near_vec(wall->normal, cag_vec3(-1, 0, 0), 1e-12); // towards the axis, at the side along X
    assert_int_equal(edges_of_kind(&p, "circle"), 2);
    for (size_t i = 0; i < p.f.edge_count; i++) {
      const CagEdgeFeature *e = &p.f.edges[i];
      if (strcmp(e->kind, "circle") != 0) continue;
      NEAR(e->length, 10 * M_PI, 1e-12);
      NEAR(e->angle, M_PI / 2, 1e-12);
      assert_int_equal(e->bend, CAG_EDGE_CONVEX);
      near_vec(e->start, e->end, 1e-12);
    }
    part_free(&p);
  }
}

// An L of two boxes: one edge of 270 degrees.
static void a_notch_is_concave(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Part p =
      part_of(combined(CAG_DIFFERENCE, a_box(20, 20, 10), shifted(a_box(20, 20, 20), 10, 10, 0)));
  check_counts(&p, 8, 18, 12);
  size_t concave = 0;
  for (size_t i = 0; i < p.f.edge_count; i++) {
    const CagEdgeFeature *e = &p.f.edges[i];
    if (e->bend != CAG_EDGE_CONCAVE) {
      NEAR(e->angle, M_PI / 2, 1e-14);
      continue;
    }
    concave++;
    NEAR(e->angle, 3 * M_PI / 2, 1e-14);
    near_vec(e->start, cag_vec3(0, 0, -5), 1e-12);
    near_vec(e->end, cag_vec3(0, 0, 5), 1e-12);
  }
  assert_int_equal(concave, 1);
  part_free(&p);
}

// A cylinder between half balls meets them smoothly.
static void a_capsule_has_smooth_edges(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *body = combined(CAG_UNION, a_cylinder(20, 5, 5), a_sphere(5));
  Part p = part_of(combined(CAG_UNION, body, shifted(a_sphere(5), 0, 0, 20)));
  check_counts(&p, 3, 2, 0);
  for (size_t i = 0; i < 2; i++) {
    assert_int_equal(p.f.edges[i].bend, CAG_EDGE_SMOOTH);
    NEAR(p.f.edges[i].angle, M_PI, 1e-9);
    NEAR(p.f.edges[i].length, 10 * M_PI, 1e-9);
  }
  // The center of a half ball's area is at half its height.
  const CagFaceFeature *top = face_at(&p, "sphere", cag_vec3(0, 0, 22.5));
  near_vec(top->normal, cag_vec3(0, 0, 1), 1e-7);
  near_box(top->bounds, cag_vec3(-5, -5, 20), cag_vec3(5, 5, 25), 1e-9);
  part_free(&p);
}

static void round_bodies_have_no_seams(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    Part p = part_turned(a_sphere(7), turn);
    check_counts(&p, 1, 0, 0);
    near_box(p.f.faces[0].bounds, cag_vec3(-7, -7, -7), cag_vec3(7, 7, 7), 1e-9);
    near_vec(p.f.faces[0].center, cag_vec3(0, 0, 0), 1e-9);
    near_vec(p.f.faces[0].normal, cag_vec3(1, 0, 0), 1e-9);
    part_free(&p);
    p = part_turned(a_torus(10, 3), turn);
    check_counts(&p, 1, 0, 0);
    near_box(p.f.faces[0].bounds, cag_vec3(-13, -13, -3), cag_vec3(13, 13, 3), 1e-9);
    near_vec(p.f.faces[0].normal, cag_vec3(-1, 0, 0), 1e-9); // on its inner side
    part_free(&p);
    p = part_turned(a_cylinder(30, 10, 0), turn);
    check_counts(&p, 2, 1, 1); // with its apex
    near_vec(p.f.corners[0].point, cag_vec3(0, 0, 30), 1e-9);
    assert_int_equal(p.f.corners[0].count, 0);
    NEAR(p.f.edges[0].angle, atan2(30, 10), 1e-12);
    part_free(&p);
  }
}

// A torus turned by an angle reaches as far as its circle's projection, and its radius.
static void bounds_of_a_turned_torus(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Part p = part_of(turned(a_torus(10, 3), cag_vec3(1, 0, 0), 0.6));
  const CagVec3 reach = {13, 10 * cos(0.6) + 3, 10 * sin(0.6) + 3};
  near_box(p.f.faces[0].bounds, cag_scaled(reach, -1), reach, 1e-9);
  part_free(&p);
}

static void a_tilted_hole_has_ellipses(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *hole = turned(shifted(a_cylinder(60, 6, 6), 0, 0, -30), cag_vec3(0, 1, 0), M_PI / 6);
  Part p = part_of(combined(CAG_DIFFERENCE, a_box(60, 50, 10), hole));
  check_counts(&p, 7, 14, 8);
  assert_int_equal(edges_of_kind(&p, "ellipse"), 2);
  // Ramanujan's approximation of the perimeter is good to 1e-9 for so small an eccentricity.
  const double a = 6 / cos(M_PI / 6), h = pow((a - 6) / (a + 6), 2);
  const double length = M_PI * (a + 6) * (1 + 3 * h / (10 + sqrt(4 - 3 * h)));
  for (size_t i = 0; i < p.f.edge_count; i++)
    if (strcmp(p.f.edges[i].kind, "ellipse") == 0) {
      NEAR(p.f.edges[i].length, length, 1e-7);
      const double turn = p.f.edges[i].angle;
      assert_true(turn > M_PI / 3 - 1e-9 && turn < 2 * M_PI / 3 + 1e-9);
    }
  part_free(&p);
}

static void crossed_cylinders_have_spline_edges(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *a = shifted(a_cylinder(40, 6, 6), 0, 0, -20);
  CagSolid *b = turned(shifted(a_cylinder(40, 3, 3), 0, 0, -20), cag_vec3(1, 0, 0), M_PI / 2);
  Part p = part_of(combined(CAG_UNION, a, b));
  check_counts(&p, 7, 6, 0);
  for (size_t i = 0; i < p.f.edge_count; i++) {
    if (strcmp(p.f.edges[i].kind, "spline") != 0) continue;
    assert_int_equal(p.f.edges[i].bend, CAG_EDGE_CONCAVE);
  }
  assert_int_equal(edges_of_kind(&p, "circle"), 4);
  const CagFaceFeature *wall = face_at(&p, "cylinder", cag_vec3(0, 0, 0));
  near_box(wall->bounds, cag_vec3(-6, -6, -20), cag_vec3(6, 6, 20), 1e-7);
  part_free(&p);
}

// The scale of a ball along the axes: a spline.
static void bounds_of_an_ellipsoid(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagTransform t;
  OK(cag_scale(cag_vec3(1, 2, 3), cag_vec3(0, 0, 0), &t, &err));
  Part p = part_of(turned(moved(a_sphere(5), t), cag_vec3(1, 1, 0), 0.5));
  CagTransform r;
  OK(cag_rotate(cag_vec3(1, 1, 0), 0.5, cag_vec3(0, 0, 0), &r, &err));
  double reach[3];
  for (int i = 0; i < 3; i++)
    reach[i] = 5 * sqrt(pow(r.m[i][0], 2) + pow(2 * r.m[i][1], 2) + pow(3 * r.m[i][2], 2));
  CagBounds all = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < p.f.face_count; i++) {
    assert_string_equal(p.f.faces[i].kind, "spline");
    cag_bounds_add(&all, p.f.faces[i].bounds.min);
    cag_bounds_add(&all, p.f.faces[i].bounds.max);
  }
  const CagVec3 most = {reach[0], reach[1], reach[2]};
  near_box(all, cag_scaled(most, -1), most, 1e-8);
  part_free(&p);
}

// Positions sort the features, and small changes of the dimensions keep their order.
static void the_order_is_stable(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Part first = {0};
  for (int k = 0; k < 5; k++) {
    CagSolid *hole = shifted(a_cylinder(40, 5 + 0.01 * k, 5 + 0.01 * k), 8, 0, -20);
    CagSolid *box = a_box(40 + 0.03 * k, 30 - 0.02 * k, 20 + 0.05 * k);
    Part p = part_turned(combined(CAG_DIFFERENCE, box, hole), k % CAG_TURNS);
    if (k == 0) first = p;
    for (size_t i = 0; i < p.f.face_count; i++)
      near_vec(p.f.faces[i].center, first.f.faces[i].center, 1);
    for (size_t i = 0; i < p.f.edge_count; i++) {
      assert_string_equal(p.f.edges[i].kind, first.f.edges[i].kind);
      if (strcmp(p.f.edges[i].kind, "line") == 0)
        near_vec(p.f.edges[i].start, first.f.edges[i].start, 1);
    }
    if (k > 0) part_free(&p);
  }
  if (first.f.faces) part_free(&first);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_has_convex_right_angles),
      cmocka_unit_test(a_hole_has_circles_and_a_wall),
      cmocka_unit_test(a_notch_is_concave),
      cmocka_unit_test(a_capsule_has_smooth_edges),
      cmocka_unit_test(round_bodies_have_no_seams),
      cmocka_unit_test(bounds_of_a_turned_torus),
      cmocka_unit_test(a_tilted_hole_has_ellipses),
      cmocka_unit_test(crossed_cylinders_have_spline_edges),
      cmocka_unit_test(bounds_of_an_ellipsoid),
      cmocka_unit_test(the_order_is_stable),
  };
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
