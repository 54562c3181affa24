// Hierarchies of boxes: a walk finds each item whose box is met or near, once. The walks of this
// program use plain C instead of vector instructions.

#define CAG_PLAIN_LANES
#include "geom/ray/bvh_walk.h"

#include <stdlib.h>

#include "tests/geom/random.h"
#include "tests/geom/surface_support.h"

static double signed_random(void) { return 2 * uniform(0, 1) - 1; }

static CagVec3 random_in_cube(double side) {
  return cag_vec3(side * signed_random(), side * signed_random(), side * signed_random());
}

// Boxes around a center, of very different sizes, some of them flat, some equal.
static CagBounds *random_boxes(size_t n, CagVec3 center, double side) {
  CagBounds *boxes = malloc(n * sizeof *boxes);
  for (size_t i = 0; i < n; i++) {
    const CagVec3 at = cag_add(center, random_in_cube(side));
    CagVec3 half = cag_scaled(random_in_cube(1), 0.1 * side * pow(uniform(0, 1), 4));
    if (i % 5 == 0) half.x = 0;
    boxes[i] = CAG_BOUNDS_EMPTY;
    cag_bounds_add(&boxes[i], cag_add(at, half));
    cag_bounds_add(&boxes[i], cag_sub(at, half));
    if (i % 7 == 0 && i > 0) boxes[i] = boxes[i - 1];
  }
  return boxes;
}

// Whether the line meets the box: by the range of parameters between its planes.
static bool box_is_met(const CagBounds *b, CagVec3 origin, CagVec3 direction) {
  const double low[3] = {b->min.x, b->min.y, b->min.z}, high[3] = {b->max.x, b->max.y, b->max.z};
  const double o[3] = {origin.x, origin.y, origin.z};
  const double d[3] = {direction.x, direction.y, direction.z};
  double in = -INFINITY, out = INFINITY;
  for (int k = 0; k < 3; k++) {
    if (d[k] == 0 && (o[k] < low[k] || o[k] > high[k])) return false;
    if (d[k] == 0) continue;
    in = fmax(in, fmin((low[k] - o[k]) / d[k], (high[k] - o[k]) / d[k]));
    out = fmin(out, fmax((low[k] - o[k]) / d[k], (high[k] - o[k]) / d[k]));
  }
  return in <= out;
}

static double box_distance(const CagBounds *b, CagVec3 p) {
  const double x = fmax(fmax(b->min.x - p.x, p.x - b->max.x), 0);
  const double y = fmax(fmax(b->min.y - p.y, p.y - b->max.y), 0);
  const double z = fmax(fmax(b->min.z - p.z, p.z - b->max.z), 0);
  return sqrt(x * x + y * y + z * z);
}

// A third of the directions have a component of 0 or two.
static CagVec3 random_direction(int k) {
  CagVec3 d = random_in_cube(1);
  if (k % 3 == 0) d.y = 0;
  if (k % 6 == 0) d.z = 0;
  return cag_unit(d);
}

static void assert_ray_finds_boxes(const CagBvh *b, const CagBounds *boxes, size_t n, int *visits,
                                   CagVec3 origin, CagVec3 direction) {
  CagBvhRay ray;
  CagBvhWalk walk;
  size_t first, count, visited = 0;
  for (size_t i = 0; i < n; i++) visits[i] = 0;
  if (cag_bvh_ray(b, origin, direction, -INFINITY, INFINITY, &ray)) {
    cag_bvh_start(b, &walk);
    while (cag_bvh_next(b, &ray, &walk, &first, &count))
      for (size_t i = first; i < first + count; i++, visited++) visits[b->order[i]]++;
  }
  for (size_t i = 0; i < n; i++) {
    if (visits[i] > 1) fail_msg("item %zu is visited %d times", i, visits[i]);
    if (!visits[i] && box_is_met(&boxes[i], origin, direction)) fail_msg("item %zu is missed", i);
  }
  // Rays meet few of many boxes.
  if (n >= 1000 && visited > n / 10) fail_msg("%zu of %zu items are visited", visited, n);
}

static void assert_point_finds_boxes(const CagBvh *b, const CagBounds *boxes, size_t n, int *visits,
                                     CagVec3 p, double reach) {
  const CagVec3 local = cag_sub(p, b->origin);
  const float at[3] = {(float)local.x, (float)local.y, (float)local.z};
  const double limit = reach + CAG_BVH_SLACK * (cag_norm(local) + b->radius);
  CagBvhWalk walk;
  size_t first, count;
  for (size_t i = 0; i < n; i++) visits[i] = 0;
  cag_bvh_start(b, &walk);
  while (cag_bvh_near(b, at, limit * limit, &walk, &first, &count))
    for (size_t i = first; i < first + count; i++) visits[b->order[i]]++;
  for (size_t i = 0; i < n; i++) {
    if (visits[i] > 1) fail_msg("item %zu is visited %d times", i, visits[i]);
    if (!visits[i] && box_distance(&boxes[i], p) <= reach) fail_msg("item %zu is missed", i);
  }
}

static void walks_find_each_box_once(void **state) {
  (void)state;
  const size_t counts[] = {1, 2, 3, 8, 9, 57, 3000};
  const double sides[] = {1, 1e-20, 1e12};
  for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
    for (int s = 0; s < 3; s++)
      for (size_t leaf = 1; leaf <= CAG_BVH_LEAF_MAX; leaf += 3) {
        const size_t n = counts[c];
        const CagVec3 center = random_in_cube(100 * sides[s]);
        CagBounds *boxes = random_boxes(n, center, sides[s]);
        int *visits = malloc(n * sizeof *visits);
        CagBvh b;
        MUST(cag_bvh_build(boxes, n, leaf, &b, err));
        for (int k = 0; k < 150; k++) {
          const CagVec3 to = k % 2
                                 ? cag_lerp(boxes[(size_t)k % n].min, boxes[(size_t)k % n].max, 0.5)
                                 : cag_add(center, random_in_cube(sides[s]));
          const CagVec3 d = random_direction(k);
          assert_ray_finds_boxes(&b, boxes, n, visits, cag_madd(to, -3 * sides[s], d), d);
          assert_point_finds_boxes(&b, boxes, n, visits, to, 0.2 * sides[s] * uniform(0, 1));
        }
        cag_bvh_free(&b);
        free(visits);
        free(boxes);
      }
}

// Planes of a node are steps of at most 1/127 of its box apart, so the box of a child is at most
// that much larger than those of its items.
static void boxes_of_nodes_are_tight(void **state) {
  (void)state;
  CagBounds *boxes = random_boxes(8, cag_vec3(0, 0, 0), 1);
  CagBvh b;
  MUST(cag_bvh_build(boxes, 8, 1, &b, err));
  assert_int_equal(b.node_count, 1);
  assert_int_equal(b.nodes[0].count, 8);
  assert_int_equal((uintptr_t)b.nodes % CAG_BVH_NODE_ALIGN, 0);
  for (int i = 0; i < 8; i++) {
    size_t first, count;
    cag_bvh_leaf(b.nodes[0].child[i], &first, &count);
    assert_int_equal(count, 1);
    const CagBounds *box = &boxes[b.order[first]];
    const double extent = b.bounds.max.x - b.bounds.min.x;
    const double step = cag_bvh_step(b.nodes[0].exponent[0]);
    const double base = b.nodes[0].base[0] + b.origin.x;
    const double low = base + step * b.nodes[0].planes[0][0][i];
    const double high = base + step * b.nodes[0].planes[1][0][i];
    // The padding is 1e-6 of the radius.
    if (step > (extent + 4e-6 * b.radius) / 127) fail_msg("a step of %g in %g", step, extent);
    if (!(low <= box->min.x && low >= box->min.x - step - 3e-6 * b.radius)) fail_msg("low");
    if (!(high >= box->max.x && high <= box->max.x + step + 3e-6 * b.radius)) fail_msg("high");
  }
  cag_bvh_free(&b);
  free(boxes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(walks_find_each_box_once),
      cmocka_unit_test(boxes_of_nodes_are_tight),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
