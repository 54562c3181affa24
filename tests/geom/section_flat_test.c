// Sections of planar faces: random polygons with holes, anywhere in space, compared with the sorted
// intersections with their edges.

#include "geom/curve/region.h"
#include "geom/meet/section.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { LOOPS = 3, CORNERS = 9, CROSSINGS = LOOPS * CORNERS };

static CagVec3 random_vector(double most) {
  const double x = uniform(-most, most), y = uniform(-most, most);
  return cag_vec3(x, y, uniform(-most, most));
}

static void set_star(CagVec3 *p, CagVec3 center, double least, double most) {
  for (int i = 0; i < CORNERS; i++) {
    const double a = 2 * M_PI * (i + uniform(-0.2, 0.2)) / CORNERS, r = uniform(least, most);
    p[i] = cag_vec3(center.x + r * cos(a), center.y + r * sin(a), 0);
  }
}

static CagSurface *face_of(const CagVec3 *corners, size_t loops, size_t each,
                           const CagTransform *frame) {
  CagCurve *c[LOOPS + 1];
  CagRegion *region;
  CagSurface *face;
  for (size_t l = 0; l < loops; l++)
    OK(cag_curve_polyline(corners + l * each, each, true, 2, &c[l], &err));
  OK(cag_region_from_loops(c, loops, &region, &err));
  OK(cag_surface_planar(region, frame, &face, &err));
  for (size_t l = 0; l < loops; l++) cag_curve_release(c[l]);
  cag_region_release(region);
  return face;
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Intersects a line with the edges, and sorts the parameters along it.
static size_t crossings(const CagVec3 *corners, size_t loops, const CagTransform *frame,
                        const CagPlane *plane, CagVec3 along, double *out) {
  size_t n = 0;
  for (size_t l = 0; l < loops; l++)
    for (size_t i = 0; i < CORNERS; i++) {
      const CagVec3 p = cag_transform_point(frame, corners[l * CORNERS + i]);
      const CagVec3 q = cag_transform_point(frame, corners[l * CORNERS + (i + 1) % CORNERS]);
      const double a = cag_dot(plane->normal, cag_sub(p, plane->point));
      const double b = cag_dot(plane->normal, cag_sub(q, plane->point));
      if ((a < 0) == (b < 0)) continue;
      out[n++] = cag_dot(along, cag_lerp(p, q, a / (a - b)));
    }
  qsort(out, n, sizeof *out, by_size);
  return n;
}

static void pieces_lie_between_crossings_of_the_edges(void **state) {
  (void)state;
  seed = 41;
  size_t cut = 0, pieces = 0;
  for (int round = 0; round < 300; round++) {
    CagVec3 corners[CROSSINGS];
    const size_t loops = (size_t)(1 + round % LOOPS);
    // The size of the face, and that of its coordinates, which determine the rounding errors. Faces
    // of any size are near (1, 2, 3).
    const double size = pow(10, uniform(-4, 4)), far = size + 4;
    CagTransform turn, grow, frame;
    set_star(corners, cag_vec3(0, 0, 0), 2.3, 4);
    set_star(corners + CORNERS, cag_vec3(-1.1, 0, 0), 0.2, 0.8);
    set_star(corners + 2 * CORNERS, cag_vec3(1.1, 0, 0), 0.2, 0.8);
    const CagVec3 axis = random_vector(1), center = random_vector(4);
    OK(cag_rotate(axis, uniform(0, 6), center, &turn, &err));
    OK(cag_scale(cag_vec3(size, size, size), cag_vec3(1, 2, 3), &grow, &err));
    frame = cag_transform_multiply(&grow, &turn);
    CagSurface *face = face_of(corners, loops, CORNERS, &frame);
    // Through a point of the face's plane, or beside it.
    CagPlane plane = {.normal = cag_unit(random_vector(1))};
    CagVec3 within = random_vector(3);
    within.z = 0;
    plane.point = cag_transform_point(&frame, within);
    const CagVec3 normal = cag_unit(cag_transform_vector(&frame, cag_vec3(0, 0, 1)));
    const CagVec3 along = cag_unit(cag_cross(plane.normal, normal));
    double places[CROSSINGS];
    const size_t n = crossings(corners, loops, &frame, &plane, along, places);
    CagCurveList list = {0};
    OK(cag_surface_section(face, &plane, 0, &list, &err));
    assert_int_equal(2 * list.count, n);
    for (size_t i = 0; i < list.count; i++) {
      const CagCurve *c = list.items[i];
      CagVec3 ends[2];
      OK(cag_curve_point(c, c->start, &ends[0], &err));
      OK(cag_curve_point(c, c->end, &ends[1], &err));
      for (int k = 0; k < 2; k++)
        NEAR(cag_dot(plane.normal, cag_sub(ends[k], plane.point)), 0, 1e-12 * far);
      const double a = cag_dot(along, ends[0]), b = cag_dot(along, ends[1]);
      // Each piece is found exactly once.
      size_t k = 0;
      while (k < n && fabs(places[k] - fmin(a, b)) > 1e-11 * far) k += 2;
      assert_true(k < n);
      NEAR(places[k + 1], fmax(a, b), 1e-11 * far);
      places[k] = INFINITY;
    }
    cut += n > 0;
    pieces += list.count;
    cag_curve_list_free(&list);
    cag_surface_release(face);
  }
  assert_true(cut > 200 && pieces > 250);
}

static void set_box(CagVec3 *p, double x0, double x1, double y0, double y1) {
  p[0] = cag_vec3(x0, y0, 0);
  p[1] = cag_vec3(x1, y0, 0);
  p[2] = cag_vec3(x1, y1, 0);
  p[3] = cag_vec3(x0, y1, 0);
}

// Planes along edges of holes, and along outer edges: the edge belongs to the section.
static void sections_along_edges_have_the_edges(void **state) {
  (void)state;
  seed = 42;
  for (int round = 0; round < 200; round++) {
    CagVec3 corners[4 * 4];
    double low[3], high[3];
    set_box(corners, 0, 6, 0, 6);
    for (int k = 0; k < 3; k++) {
      low[k] = floor(uniform(1, 5));
      high[k] = low[k] + 1 + floor(uniform(0, 5 - low[k]));
      set_box(corners + 4 + (size_t)4 * (size_t)k, low[k], high[k], 2 * k + 0.5, 2 * k + 1.5);
    }
    CagTransform frame = cag_transform_identity();
    if (round % 2) {
      const CagVec3 axis = random_vector(1);
      OK(cag_rotate(axis, uniform(0, 6), random_vector(4), &frame, &err));
    }
    CagSurface *face = face_of(corners, 4, 4, &frame);
    const double sign = round / 2 % 2 ? -1 : 1;
    for (int x = 0; x <= 6; x++) {
      const CagPlane plane = {cag_transform_point(&frame, cag_vec3(x, uniform(-9, 9), 0)),
                              cag_transform_vector(&frame, cag_vec3(sign, 0, 0))};
      double wanted = 6, found = 0;
      for (int k = 0; k < 3; k++) wanted -= low[k] < x && x < high[k];
      CagCurveList list = {0};
      OK(cag_surface_section(face, &plane, 0, &list, &err));
      for (size_t i = 0; i < list.count; i++) {
        double length;
        OK(cag_curve_length(list.items[i], list.items[i]->start, list.items[i]->end, &length,
                            &err));
        found += length;
      }
      NEAR(found, wanted, 1e-7);
      cag_curve_list_free(&list);
    }
    cag_surface_release(face);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pieces_lie_between_crossings_of_the_edges),
      cmocka_unit_test(sections_along_edges_have_the_edges),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
