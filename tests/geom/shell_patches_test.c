// Shells whose sides are cut into patches, each side in its own way: corners of patches end within
// the edges of their neighbors. Volume, area and meshes are those of the whole body.

#include "geom/mesh/tessellate.h"
#include "geom/solid/solid.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 200 };

typedef struct Faces {
  CagSurface *at[MOST];
  size_t n;
} Faces;

// A rectangle from its origin along x and y.
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

// A piece of the plane with its corner, x and y along the sides of the rectangle.
static CagSurface *region(const CagVec3 corner[4]) {
  const CagVec3 x = cag_sub(corner[2], corner[0]), y = cag_sub(corner[1], corner[0]);
  const double w = cag_norm(x), h = cag_norm(y);
  const CagVec3 columns[4] = {cag_unit(x), cag_unit(y), cag_unit(cag_cross(x, y)), corner[0]};
  const CagVec3 loop[4] = {{0, 0, 0}, {w, 0, 0}, {w, h, 0}, {0, h, 0}};
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

static void check_body(Faces *f, double volume, double area) {
  CagSolid *s;
  CagMassProperties mass;
  CagMesh *m;
  CagVec3 edge[2];
  double terms[10] = {0};
  OK(cag_solid_shell(f->at, f->n, &s, &err));
  OK(cag_solid_mass(s, &mass, &err));
  NEAR(mass.volume, volume, 1e-9 * volume);
  NEAR(mass.area, area, 1e-9 * area);
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.max_edge = random_int(2) ? uniform(0.5, 2) : 0;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  assert_true(cag_mesh_is_watertight(m, edge));
  assert_int_equal(cag_mesh_euler_characteristic(m), 2);
  cag_mesh_volume_terms(m, terms);
  NEAR(terms[0], volume, 1e-9 * volume);
  NEAR(cag_mesh_area(m), area, 1e-9 * area);
  cag_mesh_release(m);
  cag_solid_release(s);
  for (size_t i = 0; i < f->n; i++) cag_surface_release(f->at[i]);
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
    check_body(&f, e[0] * e[1] * e[2], 2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(boxes_of_patches_are_boxes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
