// Planes that touch a torus twice: the Villarceau circles, whole and in parts, compared with
// samples of the circles. Also planes and surfaces that are almost of this kind.

#include "surface_support.h"
#include "tests/geom/random.h"

#include "geom/meet/section_edges.h"
#include "geom/surface/family.h"
#include "geom/surface/reshape.h"
#include "geom/surface/swept.h"
#include "geom/surface/trimmed.h"

typedef struct Torus {
  double major, minor;
  CagTransform map; // from the torus about Z
  CagPlane plane;   // after the map
  CagVec3 x, y;     // axes of the plane before the map; x is horizontal
} Torus;

static CagVec3 direction(void) {
  const double x = uniform(-1, 1), y = uniform(-1, 1);
  return cag_unit(cag_vec3(x, y, uniform(-1, 1)));
}

// The plane through the center whose normal has this slope relative to the axis, mapped.
static CagPlane slanted(const Torus *t, double slope, double turn, double off, double *size) {
  // Planes are mapped by their points.
  const double rise = sqrt(1 - slope * slope);
  const CagVec3 x = {-sin(turn), cos(turn), 0}, n = {slope * cos(turn), slope * sin(turn), rise};
  const CagVec3 y = cag_cross(n, x), o = cag_scaled(n, off);
  const CagVec3 p = cag_transform_point(&t->map, o);
  CagPlane plane;
  MUST(cag_plane_through(p, cag_transform_point(&t->map, cag_add(o, x)),
                         cag_transform_point(&t->map, cag_add(o, y)), &plane, err));
  *size = t->major + t->minor;
  return plane;
}

static Torus random_torus(bool stretched) {
  Torus t;
  CagTransform turn, move;
  t.major = uniform(3, 6);
  t.minor = t.major * uniform(0.15, 0.9);
  MUST(cag_rotate(direction(), uniform(0, 6), direction(), &turn, err));
  move = cag_translate(cag_scaled(direction(), 3));
  t.map = cag_transform_multiply(&move, &turn);
  if (stretched) {
    const CagTransform stretch = cag_shear(0.3, -0.2, 0.5, 0.1, 0, 0.4);
    t.map = cag_transform_multiply(&stretch, &t.map);
  }
  const double angle = uniform(0, 6), slope = t.minor / t.major;
  double size;
  t.plane = slanted(&t, slope, angle, 0, &size);
  t.x = cag_vec3(-sin(angle), cos(angle), 0);
  t.y = cag_cross(cag_vec3(slope * cos(angle), slope * sin(angle), sqrt(1 - slope * slope)), t.x);
  return t;
}

// A point of one of the two circles, before the map.
static CagVec3 on_circle(const Torus *t, int which, double angle) {
  const CagVec3 center = cag_scaled(t->x, which ? t->minor : -t->minor);
  return cag_madd(cag_madd(center, t->major * cos(angle), t->x), t->major * sin(angle), t->y);
}

// The distance of a point of the plane from the closer of the circles.
static double off_circles(const Torus *t, CagVec3 p) {
  double off = INFINITY;
  CagTransform back;
  MUST(cag_transform_inverse(&t->map, &back, err));
  p = cag_transform_point(&back, p);
  for (int k = 0; k < 2; k++) {
    const CagVec3 d = cag_sub(p, cag_scaled(t->x, k ? t->minor : -t->minor));
    const double x = cag_dot(d, t->x), y = cag_dot(d, t->y);
    const double above = cag_norm(cag_madd(cag_madd(d, -x, t->x), -y, t->y));
    off = fmin(off, hypot(hypot(x, y) - t->major, above));
  }
  return off;
}

static CagSurface *torus_form(const Torus *t, int form) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c = NULL;
  CagSurface *s, *moved;
  frame.planar = false;
  switch (form) {
  case 0: MUST(cag_surface_torus(t->major, t->minor, &s, err)); break;
  case 1: // about the z axis, from a circle in the plane y = 0
    frame.m[1][1] = frame.m[2][2] = 0;
    frame.m[2][1] = 1;
    frame.m[1][2] = -1;
    frame.m[0][3] = t->major;
    MUST(cag_curve_arc(t->minor, t->minor, 0, 2 * M_PI, &frame, &c, err));
    MUST(cag_surface_revolve(c, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, err));
    break;
  case 2:
    MUST(cag_curve_arc(t->major, t->major, 0, 2 * M_PI, &frame, &c, err));
    MUST(cag_surface_tube(c, t->minor, &s, err));
    break;
  default: {
    CagSurface *plain = torus_form(
        &(Torus){.major = t->major, .minor = t->minor, .map = cag_transform_identity()}, 0);
    MUST(cag_surface_to_nurbs(plain, &s, err));
    cag_surface_release(plain);
  }
  }
  cag_curve_release(c);
  MUST(cag_surface_transform(s, &t->map, &moved, err));
  cag_surface_release(s);
  return moved;
}

static void whole_tori_have_two_circles_in_every_form(void **state) {
  (void)state;
  seed = 91;
  for (int round = 0; round < 12; round++) {
    const bool stretched = round % 8 == 4;
    const Torus t = random_torus(stretched);
    CagSurface *s = torus_form(&t, round % 4);
    CagCurveList list = {0};
    MUST(cag_surface_section(s, &t.plane, 0, &list, err));
    assert_int_equal(list.count, 2);
    CagVec3 middle[2];
    for (int i = 0; i < 2; i++) {
      const CagCurve *c = list.items[i];
      double a, b;
      CagTransform frame;
      assert_true(c->closed && cag_curve_arc_view(c, &a, &b, &frame));
      if (!stretched) {
        assert_near(a, t.major, 1e-12, "radius");
        assert_near(b, t.major, 1e-12, "radius");
      }
      for (int k = 0; k <= 12; k++) {
        CagVec3 p;
        MUST(cag_curve_point(c, c->start + (c->end - c->start) * k / 12, &p, err));
        assert_near(off_circles(&t, p), 0, 1e-11, "circle");
      }
      middle[i] = cag_vec3(frame.m[0][3], frame.m[1][3], frame.m[2][3]);
    }
    const CagVec3 apart = cag_sub(cag_transform_point(&t.map, cag_scaled(t.x, t.minor)),
                                  cag_transform_point(&t.map, cag_scaled(t.x, -t.minor)));
    assert_near(cag_norm(cag_sub(middle[0], middle[1])), cag_norm(apart), 1e-11, "centers");
    cag_curve_list_free(&list);
    cag_surface_release(s);
  }
}

// --- Parts ---

static double turned(double angle) { return angle - 2 * M_PI * floor(angle / (2 * M_PI)); }

typedef struct Part {
  double range[4]; // of the azimuth and the angle about the tube
  bool disk;       // instead, a disk of these angles: its center and radius
  double center[2], radius;
} Part;

// How far a point is inside the part, in angles.
static double inside_by(const Part *p, double azimuth, double tube) {
  if (p->disk) return p->radius - hypot(azimuth - p->center[0], tube - p->center[1]);
  return fmin(fmin(azimuth - p->range[0], p->range[1] - azimuth),
              fmin(tube - p->range[2], p->range[3] - tube));
}

static double inside_part(const Torus *t, const Part *part, CagVec3 p) {
  const double azimuth = turned(atan2(p.y, p.x));
  return inside_by(part, azimuth, turned(atan2(p.z, hypot(p.x, p.y) - t->major)));
}

static CagSurface *part_of(const Torus *t, const Part *p, int form) {
  CagSurface *s, *part, *out;
  const double *r = p->range;
  MUST(cag_surface_torus(t->major, t->minor, &s, err));
  const CagVec3 q = surface_at(s, 1, 0);
  const bool tube_first = fabs(q.z) > 1e-9; // u is the angle about the tube
  if (p->disk) {
    CagTransform frame = cag_transform_identity();
    CagCurve *c;
    CagRegion *region;
    frame.m[0][3] = p->center[tube_first];
    frame.m[1][3] = p->center[!tube_first];
    MUST(cag_curve_arc(p->radius, p->radius, 0, 2 * M_PI, &frame, &c, err));
    MUST(cag_region_new(c, NULL, 0, &region, err));
    MUST(cag_surface_trimmed(s, region, &part, err));
    cag_region_release(region);
    cag_curve_release(c);
  } else if (tube_first) MUST(cag_surface_part(s, r[2], r[3], r[0], r[1], &part, err));
  else MUST(cag_surface_part(s, r[0], r[1], r[2], r[3], &part, err));
  cag_surface_release(s);
  if (form == 1 && !p->disk) {
    MUST(cag_surface_to_nurbs(part, &s, err));
    cag_surface_release(part);
    part = s;
  }
  MUST(cag_surface_transform(part, &t->map, &out, err));
  cag_surface_release(part);
  return out;
}

// Finds the arcs of samples on the part and their length. Clears *clear if the circles come too
// close to its edges without crossing them clearly.
static int find_runs(const Torus *t, const Part *part, double *length, bool *clear) {
  enum { SAMPLES = 2000 };
  int runs = 0;
  *length = 0;
  *clear = true;
  for (int which = 0; which < 2; which++) {
    int changes = 0, count = 0, since = SAMPLES;
    double before = inside_part(t, part, on_circle(t, which, -2 * M_PI / SAMPLES));
    for (int i = 0; i < SAMPLES; i++, since++) {
      const double in = inside_part(t, part, on_circle(t, which, 2 * M_PI * i / SAMPLES));
      count += in > 0;
      if ((in > 0) != (before > 0)) {
        changes++;
        if (since < SAMPLES / 60) *clear = false;
        since = 0;
      }
      before = in;
    }
    runs += changes ? changes / 2 : count > 0;
    *length += 2 * M_PI * t->major * count / SAMPLES;
  }
  return runs;
}

static void parts_have_the_arcs_that_lie_on_them(void **state) {
  (void)state;
  seed = 92;
  int told = 0, arcs = 0;
  for (int round = 0; round < 18; round++) {
    const Torus t = random_torus(false);
    Part part = {.disk = round % 3 == 2};
    for (int k = 0; k < 2; k++) {
      const double a = uniform(0, 2 * M_PI), b = uniform(0, 2 * M_PI);
      const bool all = !part.disk && (round / 3 + k) % 3 == 0;
      part.range[2 * k] = all ? 0 : fmin(a, b);
      part.range[2 * k + 1] = all ? 2 * M_PI : fmax(a, b);
      part.center[k] = uniform(2.1, 4.1);
    }
    part.radius = uniform(0.8, 2);
    double wanted, length = 0;
    bool clear;
    const int runs = find_runs(&t, &part, &wanted, &clear);
    if (!clear) continue;
    told++;
    CagSurface *s = part_of(&t, &part, round % 2);
    CagCurveList list = {0}, exact = {0};
    bool is;
    MUST(cag_surface_section(s, &t.plane, 0, &list, err));
    MUST(cag_section_villarceau(s, &t.plane, t.major + t.minor, &exact, &is, err));
    assert_true(is);
    cag_curve_list_free(&exact);
    if (list.count != (size_t)runs) fail_msg("round %d: %zu arcs, not %d", round, list.count, runs);
    CagTransform back;
    MUST(cag_transform_inverse(&t.map, &back, err));
    for (size_t i = 0; i < list.count; i++) {
      const CagCurve *c = list.items[i];
      double a, b, own;
      CagTransform frame;
      assert_true(cag_curve_arc_view(c, &a, &b, &frame) && fabs(a - t.major) < 1e-11 && a == b);
      MUST(cag_curve_length(c, c->start, c->end, &own, err));
      length += own;
      for (int k = 0; k <= 20; k++) {
        CagVec3 p;
        MUST(cag_curve_point(c, c->start + (c->end - c->start) * k / 20, &p, err));
        assert_near(off_circles(&t, p), 0, 1e-11, "circle");
        const double in = inside_part(&t, &part, cag_transform_point(&back, p));
        // A closed arc may begin at the seam of the torus, inside the part.
        if ((k == 0 || k == 20) && !c->closed) assert_near(in, 0, 1e-8, "end");
        else assert_true(in > -1e-8 || (in < -6 && part.range[1] - part.range[0] > 6));
      }
      arcs += !c->closed;
    }
    assert_near(length, wanted, 2e-3 * t.major, "length");
    cag_curve_list_free(&list);
    cag_surface_release(s);
  }
  assert_true(told > 10 && arcs > 12);
}

// --- Nearly tangent planes ---

static bool is_villarceau(const CagSurface *s, const CagPlane *plane, double size) {
  CagCurveList list = {0};
  bool is;
  MUST(cag_section_villarceau(s, plane, size, &list, &is, err));
  assert_int_equal(list.count, is ? 2 : 0);
  cag_curve_list_free(&list);
  return is;
}

static void planes_that_are_almost_so_are_traced(void **state) {
  (void)state;
  seed = 93;
  for (int round = 0; round < 8; round++) {
    const Torus t = random_torus(false);
    CagSurface *s = torus_form(&t, round % 4);
    const double slope = t.minor / t.major, turn = uniform(0, 6);
    double size;
    CagPlane plane = slanted(&t, slope, turn, 0, &size);
    assert_true(is_villarceau(s, &plane, size));
    for (int side = -1; side < 2; side += 2) {
      plane = slanted(&t, slope, turn, side * 1e-9, &size);
      assert_false(is_villarceau(s, &plane, size));
      plane = slanted(&t, slope + side * 1e-9, turn, 0, &size);
      assert_false(is_villarceau(s, &plane, size));
    }
    plane = slanted(&t, t.minor / (t.major + t.minor), turn, 0, &size);
    assert_false(is_villarceau(s, &plane, size));
    cag_surface_release(s);
  }
}

// The circle through three points, by the frame of their plane.
static Torus torus_through(const CagVec3 p[3], double minor) {
  const CagVec3 a = cag_sub(p[1], p[0]), b = cag_sub(p[2], p[0]), x = cag_unit(a),
                z = cag_unit(cag_cross(a, b)), y = cag_cross(z, x);
  // In (u, v): |a| = 2 u, and the projection of b.
  const double u = cag_norm(a) / 2, bx = cag_dot(b, x), by = cag_dot(b, y);
  const double v = (bx * bx + by * by - 2 * u * bx) / (2 * by);
  const CagVec3 o = cag_madd(cag_madd(p[0], u, x), v, y);
  return (Torus){
      .major = hypot(u, v),
      .minor = minor,
      .map.m = {{x.x, y.x, z.x, o.x}, {x.y, y.y, z.y, o.y}, {x.z, y.z, z.z, o.z}, {0, 0, 0, 1}}};
}

// Tubes along other paths or of varying radius, and other kinds of surfaces, are not tori, even if
// some of their circles are on one.
static void surfaces_other_than_tori_are_traced(void **state) {
  (void)state;
  static const double places[3] = {0.11, 0.43, 0.83};
  for (int kind = 0; kind < 4; kind++) {
    CagCurve *path;
    CagSurface *s;
    const double minor = 0.7;
    const CagAlong radius = {minor, minor + (kind == 1 ? 0.2 : kind == 2 ? 1e-6 : 0), NULL};
    if (kind == 0) MUST(cag_curve_helix(3, 4, 0.7, 0, &path, err));
    else {
      CagTransform frame = cag_transform_identity();
      frame.planar = false;
      const double b = kind == 3 ? 2.9 : 3;
      MUST(cag_curve_arc(3, b, 0, 4, &frame, &path, err));
    }
    MUST(cag_surface_tube_along(path, &radius, &s, err));
    CagVec3 centers[3];
    for (int i = 0; i < 3; i++)
      MUST(cag_curve_point(path, path->start + places[i] * (path->end - path->start), &centers[i],
                           err));
    double least = radius.start, most = radius.end;
    for (int i = 0; i <= 8; i++) {
      const Torus t = torus_through(centers, least + (most - least) * i / 8);
      double size;
      const CagPlane plane = slanted(&t, t.minor / t.major, 0.3 * i, 0, &size);
      assert_false(is_villarceau(s, &plane, size));
    }
    cag_surface_release(s);
    cag_curve_release(path);
  }
  // No plane touches a spindle or horn torus twice.
  for (int k = 0; k < 2; k++) {
    CagSurface *s;
    MUST(cag_surface_torus(2, 2 + 0.5 * k, &s, err));
    const CagPlane upright = {{0, 0, 0}, {1, 0, 0}};
    assert_false(is_villarceau(s, &upright, 4));
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(whole_tori_have_two_circles_in_every_form),
      cmocka_unit_test(parts_have_the_arcs_that_lie_on_them),
      cmocka_unit_test(planes_that_are_almost_so_are_traced),
      cmocka_unit_test(surfaces_other_than_tori_are_traced),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
