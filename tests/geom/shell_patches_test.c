// Shells whose sides are divided into patches, each side differently, so that corners of patches
// are inside the edges of their neighbors. Volume, area, and meshes are those of the whole body.
// Three or more sides meet at its corners.

#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 400 };

typedef struct Faces {
  CagSurface *at[MOST];
  size_t n;
} Faces;

// A parallelogram from its origin along x and y.
typedef struct Side {
  CagVec3 origin, x, y;
} Side;

static CagVec3 side_point(const Side *s, double x, double y) {
  return cag_madd(cag_madd(s->origin, x, s->x), y, s->y);
}

static int random_int(int below) { return (int)uniform(0, below); }

// The order and direction of the parameters vary: the shell must orient its faces outward.
static CagSurface *patch(const CagVec3 corner[4]) {
  static const int ORDERS[8][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {1, 0, 3, 2}, {2, 0, 3, 1},
                                   {2, 3, 0, 1}, {1, 3, 0, 2}, {3, 2, 1, 0}, {3, 1, 2, 0}};
  const int *o = ORDERS[random_int(8)];
  CagSurface *s;
  OK(cag_surface_bilinear(corner[o[0]], corner[o[1]], corner[o[2]], corner[o[3]], &s, &err));
  return s;
}

// A planar region with the origin at a corner, and x along a side of the parallelogram.
static CagSurface *region(const CagVec3 corner[4]) {
  const CagVec3 x = cag_sub(corner[2], corner[0]), y = cag_sub(corner[1], corner[0]);
  const CagVec3 along = cag_unit(x), up = cag_unit(cag_cross(x, y)), off = cag_cross(up, along);
  const CagVec3 columns[4] = {along, off, up, corner[0]};
  const double w = cag_norm(x), lean = cag_dot(y, along), h = cag_dot(y, off);
  const CagVec3 loop[4] = {{0, 0, 0}, {w, 0, 0}, {w + lean, h, 0}, {lean, h, 0}};
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  CagRegion *r;
  CagSurface *s;
  frame.planar = false;
  for (int k = 0; k < 4; k++) {
    frame.m[0][k] = columns[k].x;
    frame.m[1][k] = columns[k].y;
    frame.m[2][k] = columns[k].z;
  }
  OK(cag_curve_polyline(loop, 4, true, 2, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  OK(cag_surface_planar(r, &frame, &s, &err));
  cag_curve_release(c);
  cag_region_release(r);
  return s;
}

// Grid lines over 0 .. 1 at multiples of an eighth.
static size_t random_lines(int most, double *out) {
  bool cut[8] = {false};
  size_t n = 0;
  for (int i = 0; i < most; i++) cut[1 + random_int(7)] = random_int(2);
  for (int i = 0; i < 8; i++)
    if (i == 0 || cut[i]) out[n++] = i / 8.0;
  out[n] = 1;
  return n;
}

// Divides the side into the cells of a grid.
static void add_side(Faces *f, const Side *side, int most, bool planar) {
  double lines[2][9];
  const size_t n = random_lines(most, lines[0]), m = random_lines(most, lines[1]);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) {
      CagVec3 corner[4];
      for (size_t k = 0; k < 4; k++)
        corner[k] = side_point(side, lines[0][i + k / 2], lines[1][j + k % 2]);
      f->at[f->n++] = planar ? region(corner) : patch(corner);
    }
}

// unit: the magnitude of its size; slack and tolerance are relative to it.
static void check_solid(const CagSolid *s, double volume, double area, double unit, double slack,
                        double tolerance, long euler) {
  CagMassProperties mass;
  CagMesh *m;
  CagVec3 edge[2];
  double terms[10] = {0};
  OK(cag_solid_mass(s, &mass, &err));
  NEAR(mass.volume, volume, slack * unit * area);
  NEAR(mass.area, area, slack * area);
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.max_edge = random_int(2) ? unit * uniform(0.5, 2) : 0;
  how.tolerance = tolerance * unit;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  assert_true(cag_mesh_is_watertight(m, edge));
  assert_int_equal(cag_mesh_euler_characteristic(m), euler);
  cag_mesh_volume_terms(m, terms);
  NEAR(terms[0], volume, (slack + tolerance) * unit * area);
  NEAR(cag_mesh_area(m), area, (slack + 4 * tolerance) * area);
  cag_mesh_release(m);
}

static CagSolid *shell_of(Faces *f) {
  CagSolid *s;
  OK(cag_solid_shell(f->at, f->n, &s, &err));
  for (size_t i = 0; i < f->n; i++) cag_surface_release(f->at[i]);
  return s;
}

static void boxes_of_patches_are_boxes(void **state) {
  (void)state;
  seed = 91;
  for (int k = 0; k < 9; k++) {
    double e[3];
    for (int i = 0; i < 3; i++) e[i] = uniform(1, 4);
    Faces f = {.n = 0};
    const CagVec3 axis[3] = {{e[0], 0, 0}, {0, e[1], 0}, {0, 0, e[2]}};
    for (int i = 0; i < 6; i++) {
      const int d = i / 2;
      const Side side = {i % 2 ? axis[d] : cag_vec3(0, 0, 0), axis[(d + 1) % 3], axis[(d + 2) % 3]};
      const bool planar = k % 3 > 0 && random_int(3) == 0;
      add_side(&f, &side, planar ? 0 : 1 + k % 2, planar);
    }
    CagSolid *s = shell_of(&f);
    check_solid(s, e[0] * e[1] * e[2], 2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]), 1, 1e-9, 0,
                2);
    cag_solid_release(s);
  }
}

// The sums of some vectors with factors in 0..1. The body has two sides for each two of the
// vectors, one for each direction. A side begins at the sum of the vectors that point out of it.
// The sides do not meet exactly. The image of the body under a map that is not a similarity is
// closed, too.
static void sums_of_vectors_are_bodies(void **state) {
  (void)state;
  CagTransform stretch = cag_transform_identity();
  stretch.planar = false;
  stretch.m[0][0] = 0.5;
  stretch.m[1][1] = 1.8;
  stretch.m[0][2] = 0.4;
  stretch.m[0][3] = 5;
  seed = 92;
  for (int k = 0; k < 10; k++) {
    const int n = 3 + k % 3;
    const double unit = exp(uniform(-7, 7));
    const double gap = k % 4 == 0 ? 0 : unit * exp(uniform(log(1e-12), log(2e-8)));
    CagVec3 v[5];
    double volume = 0, area = 0, stretched = 0;
    Faces f = {.n = 0};
    for (int i = 0; i < n; i++) {
      const double z = uniform(-1, 1);
      const double angle = uniform(-M_PI, M_PI);
      const double length = unit * uniform(1, 2);
      const CagVec3 way = {sqrt(1 - z * z) * cos(angle), sqrt(1 - z * z) * sin(angle), z};
      v[i] = cag_scaled(way, length);
    }
    for (int i = 0; i < n; i++)
      for (int j = 0; j < i; j++) {
        const CagVec3 normal = cag_cross(v[i], v[j]);
        area += 2 * cag_norm(normal);
        stretched += 2 * cag_norm(cag_cross(cag_transform_vector(&stretch, v[i]),
                                            cag_transform_vector(&stretch, v[j])));
        for (int l = 0; l < j; l++) volume += fabs(cag_dot(normal, v[l]));
        for (int sense = -1; sense <= 1; sense += 2) {
          const double x = uniform(-gap, gap);
          const double y = uniform(-gap, gap);
          const double z = uniform(-gap, gap);
          Side side = {cag_vec3(x, y, z), v[i], v[j]};
          for (int l = 0; l < n; l++)
            if (l != i && l != j && sense * cag_dot(normal, v[l]) > 0)
              side.origin = cag_add(side.origin, v[l]);
          const bool planar = k % 5 > 0 && random_int(2);
          add_side(&f, &side, planar || k % 2 ? 0 : 1, planar);
        }
      }
    CagSolid *s = shell_of(&f), *image;
    check_solid(s, volume, area, unit, 1e-9 + 10 * gap / unit, 0, 2);
    OK(cag_solid_transform(s, &stretch, &image, &err));
    check_solid(image, 0.9 * volume, stretched, unit, 1e-9 + 20 * gap / unit, 0, 2);
    cag_solid_release(image);
    cag_solid_release(s);
  }
}

// --- Prisms ---

// A loop of lines and parabolas.
typedef struct Outline {
  CagVec3 corner[7], middle[7]; // middle control points
  bool bent[7];
  int n;
} Outline;

static Outline random_outline(double least, double most, bool back) {
  Outline o = {.n = 3 + random_int(4)};
  for (int i = 0; i < o.n; i++) {
    const double angle = 2 * M_PI * (i + uniform(0, 0.5)) / o.n, radius = uniform(least, most);
    o.corner[i] = cag_vec3(radius * cos(angle), (back ? -1 : 1) * radius * sin(angle), 0);
  }
  o.corner[o.n] = o.corner[0];
  for (int i = 0; i < o.n; i++) {
    const CagVec3 way = cag_sub(o.corner[i + 1], o.corner[i]);
    const double off = uniform(-0.12, 0.12);
    o.bent[i] = random_int(2);
    o.middle[i] = cag_madd(cag_lerp(o.corner[i], o.corner[i + 1], 0.5), o.bent[i] ? off : 0,
                           cag_vec3(-way.y, way.x, 0));
  }
  return o;
}

static double cross_of(CagVec3 a, CagVec3 b) { return a.x * b.y - a.y * b.x; }

static double area_of(const Outline *o) {
  double area = 0;
  for (int i = 0; i < o->n; i++) {
    const CagVec3 a = o->corner[i], b = o->corner[i + 1];
    // Archimedes: two thirds of the triangle with the middle control point.
    area += cross_of(a, b) / 2 + cross_of(cag_sub(o->middle[i], a), cag_sub(b, a)) / 3;
  }
  return fabs(area);
}

// The area that the loop sweeps along a vector.
static double wall_of(const Outline *o, CagVec3 way) {
  enum { STEPS = 400 };
  double area = 0;
  for (int i = 0; i < o->n; i++)
    for (int k = 0; k < STEPS; k++) {
      const double t = (k + 0.5) / STEPS;
      const CagVec3 d =
          cag_lerp(cag_sub(o->middle[i], o->corner[i]), cag_sub(o->corner[i + 1], o->middle[i]), t);
      area += 2 * cag_norm(cag_cross(d, way)) / STEPS;
    }
  return area;
}

static CagCurve *edge_of(const Outline *o, int i) {
  const CagVec3 p[3] = {o->corner[i], o->middle[i], o->corner[i + 1]};
  CagCurve *c;
  if (o->bent[i]) OK(cag_curve_bezier(p, NULL, 3, 2, &c, &err));
  else OK(cag_curve_line(p[0], p[2], 2, &c, &err));
  return c;
}

static CagCurve *loop_of(const Outline *o) {
  CagCurve *edges[7], *c;
  const int first = random_int(o->n);
  for (int i = 0; i < o->n; i++) edges[i] = edge_of(o, (first + i) % o->n);
  OK(cag_curve_join(edges, (size_t)o->n, &c, &err));
  for (int i = 0; i < o->n; i++) cag_curve_release(edges[i]);
  return c;
}

// The piece of an edge between two of its parameters. Weights change its parametrization.
static CagCurve *piece_of(const Outline *o, int i, double from, double to, CagVec3 shift,
                          double weight) {
  const double weights[3] = {1, weight, weight * weight};
  const double ends[3][2] = {{from, from}, {from, to}, {to, to}};
  CagVec3 p[3];
  CagCurve *c;
  for (int k = 0; k < 3; k++) {
    const CagVec3 a = cag_lerp(o->corner[i], o->middle[i], ends[k][0]);
    const CagVec3 b = cag_lerp(o->middle[i], o->corner[i + 1], ends[k][0]);
    p[k] = cag_add(cag_lerp(a, b, ends[k][1]), shift);
  }
  OK(cag_curve_bezier(p, weights, 3, 3, &c, &err));
  return c;
}

// A wall is a planar face, or is divided into ruled patches.
static void add_walls(Faces *f, const Outline *o, CagVec3 way, int most) {
  for (int i = 0; i < o->n; i++) {
    if (!o->bent[i] && random_int(2)) {
      const Side side = {o->corner[i], cag_sub(o->corner[i + 1], o->corner[i]), way};
      add_side(f, &side, 0, true);
      continue;
    }
    double lines[2][9];
    const size_t n = random_lines(most, lines[0]), m = random_lines(most, lines[1]);
    for (size_t k = 0; k < n; k++)
      for (size_t l = 0; l < m; l++) {
        const bool down = random_int(2);
        const double weight = random_int(2) ? 1 : exp(uniform(-1, 1));
        CagCurve *edges[2];
        for (size_t end = 0; end < 2; end++)
          edges[end] = piece_of(o, i, lines[0][k], lines[0][k + 1],
                                cag_scaled(way, lines[1][l + end]), weight);
        OK(cag_surface_ruled(edges[down], edges[!down], &f->at[f->n++], &err));
        cag_curve_release(edges[0]);
        cag_curve_release(edges[1]);
      }
  }
}

// Whether a point of the plane is on an edge whose tangent there is perpendicular to the vector.
static bool is_on_edge(const Outline *o, CagVec3 p, CagVec3 square) {
  for (int i = 0; i < o->n; i++) {
    // The middle control points are above the midpoint of the chord.
    const CagVec3 a = o->corner[i], b = o->corner[i + 1], chord = cag_sub(b, a);
    const double t = cag_dot(cag_sub(p, a), chord) / cag_dot(chord, chord);
    const CagVec3 x = cag_lerp(a, o->middle[i], t), y = cag_lerp(o->middle[i], b, t);
    if (cag_norm(cag_sub(cag_lerp(x, y, t), p)) < 1e-6 && t > -1e-6 && t < 1 + 1e-6 &&
        fabs(cag_dot(cag_unit(cag_sub(y, x)), square)) < 1e-5)
      return true;
  }
  return false;
}

// Checks that vertices have the normals of the walls.
static void check_normals(const CagSolid *s, const Outline *outer, const Outline *inner,
                          CagVec3 way) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  how.tolerance = 0.003;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  for (size_t i = 0; i < m->vertex_count; i++) {
    const CagVec3 p = m->positions[i], n = m->normals[i];
    const CagVec3 foot = cag_madd(p, -p.z / way.z, way);
    if (fabs(n.z) > 1 - 1e-12) continue; // on the base or top
    NEAR(cag_dot(n, way), 0, 1e-6);
    assert_true(is_on_edge(outer, foot, n) || is_on_edge(inner, foot, n));
  }
  cag_mesh_release(m);
}

// Prisms over regions of straight and curved edges, some with a hole. Their walls are planar faces
// and ruled patches, and their ends are planar faces.
static void prisms_of_flat_and_bent_walls_are_closed(void **state) {
  (void)state;
  seed = 93;
  for (int k = 0; k < 12; k++) {
    const Outline outer = random_outline(0.8, 2, false), inner = random_outline(0.1, 0.2, k % 2);
    const bool holed = k % 3 == 0 && outer.n > 3;
    const double x = uniform(-1, 1);
    const double y = uniform(-1, 1);
    const double z = uniform(0.5, 2);
    const CagVec3 way = cag_vec3(x, y, z);
    Faces f = {.n = 0};
    CagCurve *loop = loop_of(&outer), *hole = holed ? loop_of(&inner) : NULL;
    CagRegion *r;
    OK(cag_region_new(loop, &hole, holed ? 1 : 0, &r, &err));
    CagTransform place = cag_transform_identity(), lift = cag_translate(way);
    place.planar = lift.planar = false;
    OK(cag_surface_planar(r, &place, &f.at[f.n++], &err));
    OK(cag_surface_planar(r, &lift, &f.at[f.n++], &err));
    add_walls(&f, &outer, way, k % 4);
    if (holed) add_walls(&f, &inner, way, k % 4);
    CagSolid *s = shell_of(&f);
    const double area = area_of(&outer) - (holed ? area_of(&inner) : 0);
    const double wall = wall_of(&outer, way) + (holed ? wall_of(&inner, way) : 0);
    check_solid(s, area * z, 2 * area + wall, 1, 1e-5, 0.01, holed ? 0 : 2);
    check_normals(s, &outer, &inner, way);
    cag_solid_release(s);
    cag_region_release(r);
    cag_curve_release(loop);
    cag_curve_release(hole);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boxes_of_patches_are_boxes),
      cmocka_unit_test(sums_of_vectors_are_bodies),
      cmocka_unit_test(prisms_of_flat_and_bent_walls_are_closed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
