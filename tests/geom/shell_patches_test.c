// Shells whose sides are cut into patches, each side in its own way: corners of patches end within
// the edges of their neighbors. Volume, area and meshes are those of the whole body. Its corners
// have three sides or more.

#include "geom/mesh/tessellate.h"
#include "geom/solid/solid.h"
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

static CagVec3 place(const Side *s, double x, double y) {
  return cag_madd(cag_madd(s->origin, x, s->x), y, s->y);
}

static int random_int(int below) { return (int)uniform(0, below); }

// Parameters in either order and sense: the shell turns its faces outward.
static CagSurface *patch(const CagVec3 corner[4]) {
  static const int ORDERS[8][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {1, 0, 3, 2}, {2, 0, 3, 1},
                                   {2, 3, 0, 1}, {1, 3, 0, 2}, {3, 2, 1, 0}, {3, 1, 2, 0}};
  const int *o = ORDERS[random_int(8)];
  CagSurface *s;
  OK(cag_surface_bilinear(corner[o[0]], corner[o[1]], corner[o[2]], corner[o[3]], &s, &err));
  return s;
}

// A piece of the plane with its corner, and x along a side of the parallelogram.
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

// Lines of a grid over 0 .. 1, at eighths.
static size_t random_lines(int most, double *out) {
  bool cut[8] = {false};
  size_t n = 0;
  for (int i = 0; i < most; i++) cut[1 + random_int(7)] = random_int(2);
  for (int i = 0; i < 8; i++)
    if (i == 0 || cut[i]) out[n++] = i / 8.0;
  out[n] = 1;
  return n;
}

// Cuts the side into the cells of a grid.
static void add_side(Faces *f, const Side *side, int most, bool planar) {
  double lines[2][9];
  const size_t n = random_lines(most, lines[0]), m = random_lines(most, lines[1]);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < m; j++) {
      CagVec3 corner[4];
      for (size_t k = 0; k < 4; k++)
        corner[k] = place(side, lines[0][i + k / 2], lines[1][j + k % 2]);
      f->at[f->n++] = planar ? region(corner) : patch(corner);
    }
}

static void check_solid(const CagSolid *s, double volume, double area, double slack) {
  CagMassProperties mass;
  CagMesh *m;
  CagVec3 edge[2];
  double terms[10] = {0};
  OK(cag_solid_mass(s, &mass, &err));
  NEAR(mass.volume, volume, slack * area);
  NEAR(mass.area, area, slack * area);
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.max_edge = random_int(2) ? uniform(0.5, 2) : 0;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  assert_true(cag_mesh_is_watertight(m, edge));
  assert_int_equal(cag_mesh_euler_characteristic(m), 2);
  cag_mesh_volume_terms(m, terms);
  NEAR(terms[0], volume, slack * area);
  NEAR(cag_mesh_area(m), area, slack * area);
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
    check_solid(s, e[0] * e[1] * e[2], 2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]), 1e-9);
    cag_solid_release(s);
  }
}

// The sums of some vectors, each taken 0 to 1 times: a side for each two of them and either sense,
// which begins at the sum of those that point out of it. The sides stand off a little. The image of
// the body under a map that is not a similarity is closed, too.
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
    const double gap = k % 4 == 0 ? 0 : exp(uniform(log(1e-12), log(2e-8)));
    CagVec3 v[5];
    double volume = 0, area = 0, stretched = 0;
    Faces f = {.n = 0};
    for (int i = 0; i < n; i++) {
      const double z = uniform(-1, 1);
      const double angle = uniform(-M_PI, M_PI);
      const double length = uniform(1, 2);
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
    check_solid(s, volume, area, 1e-9 + 10 * gap);
    OK(cag_solid_transform(s, &stretch, &image, &err));
    check_solid(image, 0.9 * volume, stretched, 1e-9 + 20 * gap);
    cag_solid_release(image);
    cag_solid_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boxes_of_patches_are_boxes),
      cmocka_unit_test(sums_of_vectors_are_bodies),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
