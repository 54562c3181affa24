// Trimmed pieces that extend all around: rotated, translated, and of any size, their meshes close
// at seams and poles.

#include "tests/geom/random_point.h"
#include "tests/geom/trimmed_support.h"

#include "geom/linalg/transform.h"
#include "geom/surface/quadric.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/orient.h"
#include "geom/tessellate/tessellate.h"

// A piece of a quadric, or of the surface of revolution of a line from (foot, 0, 0) to (1, 0, 1)
// about the z axis.
typedef struct Piece {
  bool turns;
  CagQuadricShape shape;
  double foot;
  double from, to; // of v, or of z
  double area;     // for the size 1
  bool pole;       // at `from`
} Piece;

static CagTransform random_frame(double size) {
  CagTransform frame, turn;
  const double x = uniform(-1, 1), y = uniform(-1, 1);
  const CagVec3 axis = cag_vec3(x, y, uniform(0.1, 1)), to = random_point(5);
  MUST(cag_rotate(axis, uniform(-3, 3), cag_vec3(0, 0, 0), &turn, err));
  frame = cag_transform_multiply(&turn, &(CagTransform){.m = {{size, 0, 0, size * to.x},
                                                              {0, size, 0, size * to.y},
                                                              {0, 0, size, size * to.z},
                                                              {0, 0, 0, 1}}});
  frame.planar = false;
  return frame;
}

static CagSurface *surface_of(const Piece *p, const CagTransform *frame) {
  CagSurface *s = NULL;
  CagCurve *line = NULL;
  if (!p->turns) {
    MUST(cag_surface_quadric(p->shape, frame, 0, 2 * M_PI, fmin(p->from, p->to),
                             fmax(p->from, p->to), &s, err));
    return s;
  }
  const CagVec3 ends[2] = {cag_transform_point(frame, cag_vec3(p->foot, 0, 0)),
                           cag_transform_point(frame, cag_vec3(1, 0, 1))};
  const CagVec3 origin = cag_transform_point(frame, cag_vec3(0, 0, 0));
  const CagVec3 above = cag_transform_point(frame, cag_vec3(0, 0, 1));
  const double angle = uniform(-3, 3);
  MUST(cag_curve_polyline(ends, 2, false, 3, &line, err));
  MUST(cag_surface_revolve(line, cag_sub(above, origin), origin, angle, angle + 2 * M_PI, &s, err));
  cag_curve_release(line);
  return s;
}

// The whole piece, as a surface trimmed by a rectangle.
static CagSurface *trimmed_piece(const Piece *p, const CagTransform *frame) {
  CagSurface *all = surface_of(p, frame), *s = NULL;
  const CagVec3 corners[4] = {
      {all->u0, all->v0, 0}, {all->u1, all->v0, 0}, {all->u1, all->v1, 0}, {all->u0, all->v1, 0}};
  CagCurve *outline = NULL;
  CagRegion *region = NULL;
  MUST(cag_curve_polyline(corners, 4, true, 2, &outline, err));
  MUST(cag_region_from_loops(&outline, 1, &region, err));
  MUST(cag_surface_trimmed(all, region, &s, err));
  cag_region_release(region);
  cag_curve_release(outline);
  cag_surface_release(all);
  return s;
}

static void check_weld(const CagMesh *m, double size) {
  for (size_t v = 0; v < m->vertex_count; v++) {
    const uint32_t first = m->weld[v];
    assert_true(first <= v && m->weld[first] == first);
    assert_memory_equal(&m->positions[v], &m->positions[first], sizeof(CagVec3));
    for (size_t k = 0; k < v; k++)
      if (cag_norm(cag_sub(m->positions[k], m->positions[v])) < 1e-9 * size)
        assert_int_equal(m->weld[k], first);
  }
  for (size_t t = 0; t < m->triangle_count; t++)
    for (size_t k = 0; k < 3; k++)
      assert_int_not_equal(m->weld[m->triangles[3 * t + k]],
                           m->weld[m->triangles[3 * t + (k + 1) % 3]]);
}

// Checks that vertices are at their parameters, with the surface's normals, except at poles.
static void check_vertices(const CagMesh *m, const CagSurface *s, double size, bool pole) {
  size_t without = 0;
  for (size_t v = 0; v < m->vertex_count; v++) {
    CagVec3 p, normal;
    CagError ignored;
    MUST(cag_surface_point(s, m->uv[2 * v], m->uv[2 * v + 1], &p, err));
    assert_near(cag_norm(cag_sub(m->positions[v], p)) / size, 0, 1e-11, "distance");
    assert_near(cag_norm(m->normals[v]), 1, 1e-12, "length of the normal");
    if (cag_surface_normal(s, m->uv[2 * v], m->uv[2 * v + 1], &normal, &ignored) == CAG_OK)
      assert_near(cag_dot(normal, m->normals[v]), 1, 1e-9, "normal");
    else without++;
  }
  assert_true(pole || without == 0);
  // The normals of triangles are close to these. (At a pole, a triangle may lie along a meridian.)
  for (size_t t = 0; !pole && t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    const CagVec3 a = m->positions[k[0]];
    const CagVec3 flat =
        cag_unit(cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a)));
    for (int i = 0; i < 3; i++) assert_true(cag_dot(flat, m->normals[k[i]]) > 0.6);
  }
}

static void pieces_of_any_size_close(void **state) {
  (void)state;
  const Piece pieces[] = {
      {false, CAG_SHAPE_ELLIPSOID, 0, 0, 1, 2 * M_PI * (1 - cos(1)), true},
      {false, CAG_SHAPE_ELLIPSOID, 0, M_PI, M_PI - 1, 2 * M_PI * (1 - cos(1)), true},
      {false, CAG_SHAPE_ELLIPSOID, 0, 1, 2, 2 * M_PI * (cos(1) - cos(2)), false},
      {false, CAG_SHAPE_CONE, 0, 0, 1, M_PI * sqrt(2), true},
      {false, CAG_SHAPE_CONE, 0, 0.5, 1, 0.75 * M_PI * sqrt(2), false},
      {false, CAG_SHAPE_ELLIPTIC_CYLINDER, 0, -1, 1, 4 * M_PI, false},
      {true, CAG_SHAPE_CONE, 0, 0, 1, M_PI * sqrt(2), true},
      {true, CAG_SHAPE_CONE, 0.5, 0, 1, 1.5 * M_PI * hypot(0.5, 1), false},
  };
  seed = 1;
  for (int round = 0; round < 64; round++) {
    const Piece *p = &pieces[round % 8];
    const double size = exp(uniform(log(1e-4), log(1e5)));
    const CagTransform frame = random_frame(size);
    CagSurface *s = trimmed_piece(p, &frame);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m = NULL;
    size_t open = 0, rim = 0;
    how.tolerance = 0.01 * size;
    MUST(cag_surface_tessellate(s, &how, &m, err));
    check_weld(m, size);
    check_vertices(m, s, size, p->pole);
    assert_int_equal(cag_mesh_euler_characteristic(m), p->pole ? 1 : 0);
    assert_near(cag_mesh_area(m) / (size * size), p->area, 0.02 * p->area, "area");
    // Every vertex of the rims is the end of one open edge, and the start of another.
    CagTransform back;
    MUST(cag_transform_inverse(&frame, &back, err));
    const double ends[2] = {p->pole ? p->to : p->from, p->to};
    for (size_t v = 0; v < m->vertex_count; v++) {
      const double z = cag_transform_point(&back, m->positions[v]).z;
      for (int e = p->pole ? 1 : 0; e < 2; e++)
        rim += m->weld[v] == v &&
               fabs(z - (!p->turns && p->shape == CAG_SHAPE_ELLIPSOID ? cos(ends[e]) : ends[e])) <
                   1e-9;
    }
    MUST(cag_mesh_open_edges(m, &open, err));
    assert_int_equal(open, rim);
    cag_mesh_release(m);
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pieces_of_any_size_close),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
