// Solids swept from random regions, compared with integrals over the region and the path.

#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 12, STEPS = 48 };

typedef struct Loop {
  CagVec3 p[MOST];
  size_t n;
} Loop;

static const double NODES[3] = {0.11270166537925831, 0.5, 0.88729833462074169};
static const double WEIGHTS[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

// A loop around the center, whose corners are at distances from `least` to `most`.
static Loop random_loop(CagVec3 center, double least, double most) {
  Loop l = {.n = 5 + (size_t)uniform(0, 4)};
  for (size_t i = 0; i < l.n; i++) {
    const double angle = 2 * M_PI * ((double)i + uniform(0, 0.4)) / (double)l.n;
    const double radius = uniform(least, most);
    l.p[i] = cag_add(center, cag_vec3(radius * cos(angle), radius * sin(angle), 0));
  }
  return l;
}

// The corners in either direction, from any start.
static CagCurve *curve_of(const Loop *l) {
  CagVec3 p[MOST];
  CagCurve *c;
  const size_t first = (size_t)uniform(0, (double)l->n);
  const bool back = uniform(0, 1) < 0.5;
  for (size_t i = 0; i < l->n; i++)
    p[i] = l->p[back ? (first + l->n - i) % l->n : (first + i) % l->n];
  OK(cag_curve_polyline(p, l->n, true, 2, &c, &err));
  return c;
}

static CagRegion *region_of(const Loop *outer, const Loop *hole) {
  CagCurve *a = curve_of(outer), *b = hole ? curve_of(hole) : NULL;
  CagRegion *r;
  OK(cag_region_new(a, &b, hole ? 1 : 0, &r, &err));
  cag_curve_release(a);
  cag_curve_release(b);
  return r;
}

// How a region moves: the map at a fraction of the path, and the volume swept by a small part of
// the region, divided by its area.
typedef struct Way {
  CagTransform plane;
  CagVec3 axis, through, shift;
  double from, angle, scale, twist;
  bool turns;
} Way;

static CagVec3 moved_point(const Way *w, CagVec3 p, double t) {
  if (w->turns) {
    CagTransform turn;
    OK(cag_rotate(w->axis, w->from + t * w->angle, w->through, &turn, &err));
    return cag_transform_point(&turn, cag_transform_point(&w->plane, p));
  }
  const double size = 1 + t * (w->scale - 1), c = size * cos(t * w->twist),
               s = size * sin(t * w->twist);
  return cag_madd(cag_vec3(c * p.x - s * p.y, s * p.x + c * p.y, 0), t, w->shift);
}

static double density(const Way *w, CagVec3 p, double t) {
  if (w->turns) {
    const CagVec3 off = cag_sub(cag_transform_point(&w->plane, p), w->through);
    return w->angle * cag_norm(cag_cross(cag_unit(w->axis), off));
  }
  const double size = 1 + t * (w->scale - 1);
  return fabs(w->shift.z) * size * size;
}

typedef struct Sums {
  double volume, second[3][3];
  CagVec3 first;
} Sums;

// Adds the volume swept by a triangle of the plane.
static void add_triangle(Sums *s, const Way *w, const CagVec3 corner[3], double sign) {
  const CagVec3 x = cag_sub(corner[1], corner[0]), y = cag_sub(corner[2], corner[0]);
  const double twice = sign * (x.x * y.y - x.y * y.x);
  for (int i = 0; i < 9; i++) {
    const double a = NODES[i / 3], b = NODES[i % 3] * (1 - a);
    const CagVec3 p = cag_madd(cag_madd(corner[0], a, x), b, y);
    for (int k = 0; k < 3 * STEPS; k++) {
      const double t = (k / 3 + NODES[k % 3]) / STEPS;
      const CagVec3 at = moved_point(w, p, t);
      const double part = WEIGHTS[i / 3] * WEIGHTS[i % 3] * (1 - a) * twice * WEIGHTS[k % 3] /
                          STEPS * density(w, p, t);
      const double c[3] = {at.x, at.y, at.z};
      s->volume += part;
      s->first = cag_madd(s->first, part, at);
      for (int j = 0; j < 9; j++) s->second[j / 3][j % 3] += part * c[j / 3] * c[j % 3];
    }
  }
}

static double area_of(const Loop *l) {
  double area = 0;
  for (size_t i = 0; i < l->n; i++) {
    const CagVec3 a = l->p[i], b = l->p[(i + 1) % l->n];
    area += (a.x * b.y - a.y * b.x) / 2;
  }
  return area;
}

static void add_loop(Sums *s, const Way *w, const Loop *l, double sign) {
  sign *= area_of(l) > 0 ? 1 : -1;
  for (size_t i = 1; i + 1 < l->n; i++)
    add_triangle(s, w, (CagVec3[]){l->p[0], l->p[i], l->p[i + 1]}, sign);
}

static void check(const CagSolid *s, const Sums *sums, double slack) {
  CagMassProperties m;
  OK(cag_solid_mass(s, &m, &err));
  NEAR(m.volume, sums->volume, slack);
  const CagVec3 middle = cag_scaled(sums->first, 1 / sums->volume);
  near_vec(m.volume_centroid, middle, slack);
  const double c[3] = {middle.x, middle.y, middle.z};
  double second[3][3], trace = 0;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) second[i][k] = sums->second[i][k] - sums->volume * c[i] * c[k];
  for (int i = 0; i < 3; i++) trace += second[i][i];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      NEAR(m.inertia[i][k], (i == k ? trace : 0) - second[i][k], 10 * slack);
  // The mesh is closed and oriented outward.
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *mesh;
  double terms[10] = {0};
  how.tolerance = 0.03;
  OK(cag_solid_tessellate(s, &how, &mesh, &err));
  assert_true(cag_mesh_is_watertight(mesh, NULL));
  cag_mesh_volume_terms(mesh, terms);
  NEAR(terms[0], m.volume, how.tolerance * m.area);
  cag_mesh_release(mesh);
}

static void extrusions_have_the_moments_of_their_sections(void **state) {
  (void)state;
  static const double SCALES[] = {1, 0, 0.5, 1.7};
  seed = 301;
  for (int k = 0; k < 12; k++) {
    const CagVec3 center = cag_vec3(uniform(-2, 2), uniform(-2, 2), 0);
    const Loop outer = random_loop(center, 0.8, 1.2), hole = random_loop(center, 0.2, 0.4);
    const bool holed = k % 3 > 0;
    Way w = {.scale = SCALES[k % 4], .twist = k % 2 ? uniform(-2, 2) : 0};
    w.shift = cag_vec3(uniform(-1, 1), uniform(-1, 1), (k / 2 % 2 ? -1 : 1) * uniform(0.5, 3));
    CagRegion *r = region_of(&outer, holed ? &hole : NULL);
    Sums sums = {0};
    CagSolid *s;
    add_loop(&sums, &w, &outer, 1);
    if (holed) add_loop(&sums, &w, &hole, -1);
    OK(cag_solid_extrude(r, w.shift, w.twist, w.scale, &s, &err));
    assert_int_equal(s->face_count, r->count + (w.scale > 0 ? 2 : 1));
    check(s, &sums, 1e-9);
    cag_solid_release(s);
    cag_region_release(r);
  }
}

// Converts the coordinates (distance from the axis, distance along it) to those of the plane.
static void put_beside(Loop *l, CagVec3 along, CagVec3 off, CagVec3 origin) {
  for (size_t i = 0; i < l->n; i++)
    l->p[i] = cag_madd(cag_madd(origin, l->p[i].x, off), l->p[i].y, along);
}

static double length_times_distance(const Loop *l) {
  double sum = 0;
  for (size_t i = 0; i < l->n; i++) {
    const CagVec3 a = l->p[i], b = l->p[(i + 1) % l->n];
    sum += cag_norm(cag_sub(b, a)) * (a.x + b.x) / 2;
  }
  return sum;
}

// Revolutions about any axis in the plane of the region, on either side of it. Some regions have
// one side or two on the axis.
static void revolutions_have_the_moments_of_their_regions(void **state) {
  (void)state;
  static const Loop one = {{{0, -1, 0}, {1.2, -0.7, 0}, {1.4, 0.9, 0}, {0.6, 0.8, 0}, {0, 1.3, 0}},
                           5};
  static const Loop two = {{{0, 0, 0},
                            {1.5, -0.3, 0},
                            {2, 1, 0},
                            {1.4, 3, 0},
                            {0, 3.2, 0},
                            {0, 2.1, 0},
                            {0.7, 1.5, 0},
                            {0, 1, 0}},
                           8};
  seed = 302;
  for (int k = 0; k < 36; k++) {
    const int kind = k % 3;
    const CagVec3 center = cag_vec3(uniform(1.3, 3), uniform(-1, 1), 0);
    Loop outer = kind == 0 ? random_loop(center, 0.8, 1.2) : kind == 1 ? one : two;
    Loop hole = random_loop(kind == 0 ? center : cag_vec3(0.9, 0.3, 0), 0.1, 0.25);
    const bool holed = k / 3 % 2, upright = k / 6 % 2;
    const bool full = k % 4 == 0;
    Way w = {.turns = true, .from = uniform(-3, 3), .plane = cag_transform_identity()};
    w.angle = full ? 2 * M_PI : uniform(0.3, 6);
    w.plane.planar = false;
    // The axis in the coordinates of the region.
    const double turn = upright ? (k % 2 ? 1 : -1) * M_PI / 2 : uniform(-M_PI, M_PI);
    const CagVec3 along = cag_vec3(cos(turn), sin(turn), 0);
    const CagVec3 off = cag_scaled(cag_vec3(-along.y, along.x, 0), uniform(0, 1) < 0.5 ? -1 : 1);
    const CagVec3 origin = cag_vec3(uniform(-3, 3), uniform(-3, 3), 0);
    if (upright) {
      w.plane.m[1][1] = w.plane.m[2][2] = 0;
      w.plane.m[2][1] = 1;
      w.plane.m[1][2] = -1;
    }
    w.axis =
        upright ? cag_vec3(0, 0, uniform(0.5, 2) * along.y) : cag_scaled(along, uniform(0.5, 2));
    w.through = cag_transform_point(&w.plane, origin);
    double area =
        w.angle * (length_times_distance(&outer) + (holed ? length_times_distance(&hole) : 0));
    if (!full) area += 2 * (fabs(area_of(&outer)) - (holed ? fabs(area_of(&hole)) : 0));
    put_beside(&outer, along, off, origin);
    put_beside(&hole, along, off, origin);
    CagRegion *r = region_of(&outer, holed ? &hole : NULL);
    Sums sums = {0};
    CagSolid *s;
    CagMassProperties m;
    add_loop(&sums, &w, &outer, 1);
    if (holed) add_loop(&sums, &w, &hole, -1);
    OK(cag_solid_revolve(r, w.axis, w.through, w.from, w.from + w.angle, &s, &err));
    check(s, &sums, 1e-9);
    OK(cag_solid_mass(s, &m, &err));
    NEAR(m.area, area, 1e-9);
    cag_solid_release(s);
    cag_region_release(r);
  }
}

// A region may extend beyond the axis by rounding, but not more.
static void regions_beyond_the_axis_are_refused(void **state) {
  (void)state;
  for (int side = -1; side <= 1; side += 2)
    for (int k = 0; k < 4; k++) {
      const double beyond = (double[]){-1e-9, 1e-10, 1e-7, 0.5}[k];
      const CagVec3 p[4] = {
          {-side * beyond, 0, 0}, {side * 3, 0, 0}, {side * 3, 4, 0}, {-side * beyond, 4, 0}};
      const CagVec3 z = {0, 0, 1}, origin = {0, 0, 0};
      CagCurve *c;
      CagRegion *r;
      CagSolid *s;
      OK(cag_curve_polyline(p, 4, true, 2, &c, &err));
      OK(cag_region_new(c, NULL, 0, &r, &err));
      if (k < 2) {
        OK(cag_solid_revolve(r, z, origin, 0, 2 * M_PI, &s, &err));
        cag_solid_release(s);
      } else {
        FAILS(cag_solid_revolve(r, z, origin, 0, 2 * M_PI, &s, &err), "region-crosses-axis");
        assert_non_null(strstr(err.message, k == 2 ? " 1e-07 beyond" : " 0.5 beyond"));
      }
      cag_curve_release(c);
      cag_region_release(r);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(extrusions_have_the_moments_of_their_sections),
      cmocka_unit_test(revolutions_have_the_moments_of_their_regions),
      cmocka_unit_test(regions_beyond_the_axis_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
