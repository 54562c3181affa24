// Distances of convex bodies and tori, against alternating projections: of two convex sets, the
// projections of a point onto one and the other in turn converge to the closest pair (Cheney,
// Goldstein 1959). The projections are formulas of this file. The nearest points of a torus are
// searched from all sides.

#include "geom/solid/convex_list.h"
#include "geom/solid/csg.h"
#include "tests/geom/random_point.h"
#include "tests/geom/support.h"

enum { BOX, BALL, CYLINDER, CONE, FRUSTUM, ELLIPSOID, PRISM, TORUS, KINDS };

typedef struct Piece {
  int kind;
  CagVec3 origin, axis[3]; // unit vectors
  double size[3];
  CagSolid *solid;
} Piece;

static CagVec3 to_own(const Piece *s, CagVec3 p) {
  const CagVec3 r = cag_sub(p, s->origin);
  return cag_vec3(cag_dot(r, s->axis[0]), cag_dot(r, s->axis[1]), cag_dot(r, s->axis[2]));
}

static CagVec3 to_world(const Piece *s, CagVec3 p) {
  return cag_madd(cag_madd(cag_madd(s->origin, p.x, s->axis[0]), p.y, s->axis[1]), p.z, s->axis[2]);
}

static double clamped(double x, double low, double high) { return fmin(fmax(x, low), high); }

// Onto a polygon in the plane of x and y, counter-clockwise.
static void project_polygon(const double (*corner)[2], int n, double *x, double *y) {
  bool inside = true;
  double best = INFINITY, at[2] = {*x, *y};
  for (int i = 0; i < n; i++) {
    const double *a = corner[i], *b = corner[(i + 1) % n];
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = dx * dx + dy * dy;
    if (length == 0) continue;
    if (dx * (*y - a[1]) - dy * (*x - a[0]) < 0) inside = false;
    const double t = clamped(((*x - a[0]) * dx + (*y - a[1]) * dy) / length, 0, 1);
    const double far = hypot(a[0] + t * dx - *x, a[1] + t * dy - *y);
    if (far >= best) continue;
    best = far;
    at[0] = a[0] + t * dx;
    at[1] = a[1] + t * dy;
  }
  if (inside) return;
  *x = at[0];
  *y = at[1];
}

// The multiplier t of (p / a)^2 a^4 / (a^2 + t)^2, summed over the axes, that makes it 1.
static CagVec3 project_ellipsoid(const double a[3], CagVec3 p) {
  const double q[3] = {p.x, p.y, p.z};
  double low = 0, high = 3 * (fabs(p.x) + fabs(p.y) + fabs(p.z)) * (a[0] + a[1] + a[2]), out[3];
  if (hypot(hypot(p.x / a[0], p.y / a[1]), p.z / a[2]) <= 1) return p;
  for (int round = 0; round < 200; round++) {
    const double t = (low + high) / 2;
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += pow(a[k] * q[k] / (a[k] * a[k] + t), 2);
    if (sum > 1) low = t;
    else high = t;
  }
  for (int k = 0; k < 3; k++) out[k] = a[k] * a[k] * q[k] / (a[k] * a[k] + high);
  return cag_vec3(out[0], out[1], out[2]);
}

static const double triangle[3][2] = {{0, 0}, {2, 0}, {0.5, 1.5}};

static CagVec3 project(const Piece *s, CagVec3 world) {
  CagVec3 p = to_own(s, world);
  const double *size = s->size, rho = hypot(p.x, p.y), norm = cag_norm(p);
  double r = rho, z = p.z;
  const double top = s->kind == CYLINDER ? size[0] : s->kind == CONE ? 0 : size[2];
  const double profile[4][2] = {{0, 0}, {size[0], 0}, {top, size[1]}, {0, size[1]}};
  switch (s->kind) {
  case BOX:
    p = cag_vec3(clamped(p.x, 0, size[0]), clamped(p.y, 0, size[1]), clamped(p.z, 0, size[2]));
    break;
  case BALL:
    if (norm > size[0]) p = cag_scaled(p, size[0] / norm);
    break;
  case ELLIPSOID: p = project_ellipsoid(size, p); break;
  case PRISM:
    project_polygon(triangle, 3, &p.x, &p.y);
    p.z = clamped(p.z, 0, size[1]);
    break;
  case TORUS: {
    const CagVec3 center = cag_vec3(p.x / rho * size[0], p.y / rho * size[0], 0);
    const CagVec3 off = cag_sub(p, center);
    if (cag_norm(off) > size[1]) p = cag_madd(center, size[1] / cag_norm(off), off);
    break;
  }
  default:
    project_polygon(profile, 4, &r, &z);
    if (rho > 0) p = cag_vec3(p.x / rho * r, p.y / rho * r, z);
    else p.z = z;
  }
  return to_world(s, p);
}

static double from_start(const Piece *a, const Piece *b, CagVec3 p) {
  double last = INFINITY;
  for (int round = 0; round < 20000; round++) {
    const CagVec3 q = project(b, p);
    p = project(a, q);
    const double d = cag_norm(cag_sub(p, q));
    if (d < 1e-13 || last - d < 1e-15 * d) return d;
    last = d;
  }
  return last;
}

static double expected_distance(const Piece *a, const Piece *b) {
  if (b->kind == TORUS && a->kind != TORUS) return expected_distance(b, a);
  if (a->kind != TORUS) return from_start(a, b, a->origin);
  double best = INFINITY;
  for (int i = 0; i < 24; i++) {
    const double t = 2 * M_PI * i / 24;
    const CagVec3 own = cag_vec3(a->size[0] * cos(t), a->size[0] * sin(t), 0);
    best = fmin(best, from_start(a, b, to_world(a, own)));
  }
  return best;
}

// --- Bodies ---

static CagTransform frame_of(const Piece *s) {
  CagTransform t = cag_transform_identity();
  const CagVec3 columns[4] = {s->axis[0], s->axis[1], s->axis[2], s->origin};
  t.planar = false;
  for (int k = 0; k < 4; k++) {
    t.m[0][k] = columns[k].x;
    t.m[1][k] = columns[k].y;
    t.m[2][k] = columns[k].z;
  }
  return t;
}

static CagStatus make_prism(const double (*corners)[2], size_t n, double height, CagSolid **out) {
  CagVec3 points[12];
  CagCurve *outline;
  CagRegion *region;
  for (size_t i = 0; i < n; i++) points[i] = cag_vec3(corners[i][0], corners[i][1], 0);
  OK(cag_curve_polyline(points, n, true, 2, &outline, &err));
  OK(cag_region_new(outline, NULL, 0, &region, &err));
  cag_curve_release(outline);
  CagStatus status = cag_solid_extrude(region, cag_vec3(0, 0, height), 0, 1, out, &err);
  cag_region_release(region);
  return status;
}

static CagSolid *own_solid(const Piece *s) {
  const double *k = s->size;
  CagSolid *out = NULL;
  switch (s->kind) {
  case BOX: OK(cag_solid_box(cag_vec3(k[0], k[1], k[2]), false, &out, &err)); break;
  case BALL: OK(cag_solid_sphere(k[0], &out, &err)); break;
  case CYLINDER: OK(cag_solid_cylinder(k[1], k[0], k[0], &out, &err)); break;
  case CONE: OK(cag_solid_cylinder(k[1], k[0], 0, &out, &err)); break;
  case FRUSTUM: OK(cag_solid_cylinder(k[1], k[0], k[2], &out, &err)); break;
  case PRISM: OK(make_prism(triangle, 3, k[1], &out)); break;
  case TORUS: OK(cag_solid_torus(k[0], k[1], &out, &err)); break;
  default: {
    CagSolid *ball;
    CagTransform t = cag_transform_identity();
    t.planar = false;
    for (int i = 0; i < 3; i++) t.m[i][i] = k[i];
    OK(cag_solid_sphere(1, &ball, &err));
    OK(cag_solid_transform(ball, &t, &out, &err));
    cag_solid_release(ball);
  }
  }
  return out;
}

// The piece at `at` whose axes are turned to z.
static Piece piece(int kind, double a, double b, double c, CagVec3 at, CagVec3 z) {
  Piece s = {.kind = kind, .origin = at, .size = {a, b, c}};
  const CagVec3 other = fabs(z.x) < 0.7 * cag_norm(z) ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  s.axis[2] = cag_unit(z);
  s.axis[1] = cag_unit(cag_cross(s.axis[2], other));
  s.axis[0] = cag_cross(s.axis[1], s.axis[2]);
  const CagTransform t = frame_of(&s);
  CagSolid *own = own_solid(&s);
  OK(cag_solid_transform(own, &t, &s.solid, &err));
  cag_solid_release(own);
  return s;
}

static double measured(const CagSolid *a, const CagSolid *b) {
  CagConvexList lists[2] = {{0}, {0}};
  double out[2];
  bool known[2], certain;
  OK(cag_solid_add_convex(a, &lists[0], &known[0], &err));
  OK(cag_solid_add_convex(b, &lists[1], &known[1], &err));
  assert_true(known[0] && known[1]);
  for (int k = 0; k < 2; k++) {
    OK(cag_convex_list_distance(&lists[k], &lists[1 - k], &out[k], NULL, &certain, &err));
    assert_true(certain);
  }
  NEAR(out[0], out[1], 1e-9 * (1 + out[0]));
  for (int k = 0; k < 2; k++) cag_convex_list_free(&lists[k]);
  return out[0];
}

static Piece random_piece(int kind, CagVec3 at) {
  // One after the other: the order in which arguments are evaluated depends on the compiler.
  const CagVec3 z = random_point(1);
  const double a = kind == TORUS ? uniform(1, 3) : uniform(0.3, 2);
  const double b = kind == TORUS ? uniform(0.1, 1) : uniform(0.3, 3);
  return piece(kind, a, b, kind == TORUS ? 0 : uniform(0.3, 2), at, z);
}

static void random_bodies_have_the_distance_of_alternating_projections(void **state) {
  (void)state;
  seed = 5;
  int apart = 0;
  for (int i = 0; i < KINDS; i++)
    for (int k = i; k < KINDS; k++)
      for (int round = 0; round < 100; round++) {
        const CagVec3 way = cag_scaled(cag_unit(random_point(1)), uniform(1, 9));
        const Piece a = random_piece(i, random_point(1));
        const Piece b = random_piece(k, cag_add(way, random_point(1)));
        const double expected = expected_distance(&a, &b), found = measured(a.solid, b.solid);
        // Projections of shapes that meet only tend to a common point.
        if (!(fabs(found - expected) <= (expected < 1e-2 ? 1e-2 : 1e-9)))
          fail_msg("kinds %d %d, round %d: %.17g is not %.17g", i, k, round, found, expected);
        // The bound of convex.h: 1e-10 of the size of the bodies, which is about 4, and the distance.
        assert_true(found <= expected + 1e-10 * (4 + expected));
        apart += expected > 1e-2;
        cag_solid_release(a.solid);
        cag_solid_release(b.solid);
      }
  assert_true(apart > 2000); // of 3600
}

static double apart(Piece a, Piece b) {
  const double out = measured(a.solid, b.solid);
  cag_solid_release(a.solid);
  cag_solid_release(b.solid);
  return out;
}

static void special_positions_have_distances_in_closed_form(void **state) {
  (void)state;
  const CagVec3 x = {1, 0, 0}, z = {0, 0, 1}, o = {0, 0, 0}, slanted = {1, 2, 2};
  // Parallel, crossing, and coaxial axes.
  NEAR(apart(piece(CYLINDER, 1, 4, 0, o, z), piece(CYLINDER, 2, 3, 0, cag_vec3(5, 0, 1), z)), 2,
       1e-10);
  NEAR(apart(piece(CYLINDER, 1, 4, 0, cag_vec3(-2, 0, 0), x),
             piece(CYLINDER, 0.5, 4, 0, cag_vec3(0, 3, -2), z)),
       1.5, 1e-10);
  NEAR(apart(piece(CYLINDER, 1, 4, 0, o, slanted),
             piece(CONE, 1, 3, 0, cag_scaled(slanted, 2), slanted)),
       2, 1e-10);
  // A ring around a cylinder, above a cone, and within a tube of other rings.
  NEAR(apart(piece(TORUS, 3, 0.5, 0, cag_vec3(0, 0, 1), z), piece(CYLINDER, 1, 2, 0, o, z)), 1.5,
       1e-10);
  NEAR(apart(piece(TORUS, 3, 0.25, 0, cag_vec3(0, 0, 4), z), piece(CONE, 3, 4, 0, o, z)),
       12 / 5. - 0.25, 1e-10);
  NEAR(apart(piece(TORUS, 3, 0.5, 0, o, slanted), piece(TORUS, 1, 0.25, 0, o, slanted)), 1.25,
       1e-10);
  NEAR(apart(piece(TORUS, 3, 0.5, 0, o, z), piece(TORUS, 3, 0.25, 0, cag_vec3(0, 0, 2), z)), 1.25,
       1e-10);
  // The smaller circle stands upright over a radius of the larger one.
  NEAR(apart(piece(TORUS, 4, 0.5, 0, o, z), piece(TORUS, 1, 0.5, 0, o, cag_vec3(0, 1, 0))), 2,
       1e-10);
  // A box lies on a ring; a ball in its hole.
  NEAR(apart(piece(TORUS, 3, 1, 0, o, z), piece(BOX, 4, 4, 1, cag_vec3(0, 0, 3), z)), 2, 1e-10);
  NEAR(apart(piece(TORUS, 3, 1, 0, o, z), piece(BALL, 0.5, 0, 0, o, z)), 1.5, 1e-10);
  // Touching, overlapping, and contained.
  assert_true(
      apart(piece(CYLINDER, 1, 4, 0, o, z), piece(CYLINDER, 2, 3, 0, cag_vec3(3, 0, 1), z)) == 0);
  assert_true(apart(piece(BOX, 2, 2, 2, o, z), piece(BOX, 1, 1, 1, cag_vec3(2, 1, 1), z)) == 0);
  assert_true(apart(piece(CYLINDER, 3, 9, 0, o, z), piece(CONE, 1, 2, 0, cag_vec3(0, 0, 3), z)) ==
              0);
  assert_true(apart(piece(TORUS, 3, 1, 0, o, z), piece(BALL, 0.5, 0, 0, cag_vec3(3, 0, 0), z)) ==
              0);
  assert_true(apart(piece(ELLIPSOID, 3, 2, 1, o, z), piece(PRISM, 1, 1, 0, o, z)) == 0);
}

// The axes of an upright piece are those of the world, turned about z, so its boxes need not lie in
// the first quadrant.
static double boxes_from_pin(void) {
  const CagVec3 z = {0, 0, 1}, at = {3, 3, 0};
  const Piece frame = piece(BOX, 1, 1, 1, cag_vec3(0, 0, 0), z);
  cag_solid_release(frame.solid);
  const CagVec3 own = to_own(&frame, at);
  const double far[2] = {
      hypot(own.x - clamped(own.x, 0, 4), own.y - clamped(own.y, 0, 1)),
      hypot(own.x - clamped(own.x, 0, 1), own.y - clamped(own.y, 0, 4)),
  };
  return fmin(far[0], far[1]) - 0.5;
}

static void unions_and_prisms_have_the_distance_of_their_nearest_part(void **state) {
  (void)state;
  // An L of width 1 around a cylinder that stands in its notch, and the same L of two boxes.
  static const double corners[6][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
  const CagVec3 z = {0, 0, 1};
  Piece pin = piece(CYLINDER, 0.5, 2, 0, cag_vec3(3, 3, 0), z);
  Piece boxes[2] = {piece(BOX, 4, 1, 2, cag_vec3(0, 0, 0), z),
                    piece(BOX, 1, 4, 2, cag_vec3(0, 0, 0), z)};
  CagSolid *bent, *both, *moved, *operands[2] = {boxes[0].solid, boxes[1].solid};
  const CagTransform shift = cag_translate(cag_vec3(0, 0, 10));
  OK(make_prism(corners, 6, 2, &bent));
  NEAR(measured(bent, pin.solid), 1.5, 1e-10);
  OK(cag_solid_combine(CAG_UNION, operands, 2, NULL, &both, &err));
  OK(cag_solid_transform(both, &shift, &moved, &err));
  NEAR(measured(both, moved), 8, 1e-10);
  NEAR(measured(both, pin.solid), boxes_from_pin(), 1e-10);
  NEAR(measured(moved, pin.solid), hypot(8, boxes_from_pin()), 1e-10);
  cag_solid_release(bent);
  cag_solid_release(both);
  cag_solid_release(moved);
  cag_solid_release(pin.solid);
  for (int k = 0; k < 2; k++) cag_solid_release(boxes[k].solid);
}

static void other_solids_are_not_known(void **state) {
  (void)state;
  const CagVec3 z = {0, 0, 1}, o = {0, 0, 0};
  Piece s[2] = {piece(BOX, 2, 2, 2, o, z), piece(TORUS, 2, 1, 0, o, z)};
  CagTransform flat = cag_transform_identity();
  CagSolid *operands[2] = {s[0].solid, s[1].solid}, *cut, *squeezed;
  CagConvexList list = {0};
  bool known;
  OK(cag_solid_combine(CAG_DIFFERENCE, operands, 2, NULL, &cut, &err));
  OK(cag_solid_add_convex(cut, &list, &known, &err));
  assert_false(known);
  flat.planar = false;
  flat.m[1][1] = 2;
  OK(cag_solid_transform(s[1].solid, &flat, &squeezed, &err));
  OK(cag_solid_add_convex(squeezed, &list, &known, &err));
  assert_false(known);
  assert_int_equal(list.n, 0);
  cag_convex_list_free(&list);
  cag_solid_release(cut);
  cag_solid_release(squeezed);
  for (int k = 0; k < 2; k++) cag_solid_release(s[k].solid);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_bodies_have_the_distance_of_alternating_projections),
      cmocka_unit_test(special_positions_have_distances_in_closed_form),
      cmocka_unit_test(unions_and_prisms_have_the_distance_of_their_nearest_part),
      cmocka_unit_test(other_solids_are_not_known)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
