// Random trees of set operations of regions: none of them fails, and areas agree with
// inclusion-exclusion.
//
// A tree combines a few leaves, each of them several times, so that its operands share boundaries
// that earlier operations have cut and rounded. The area of the result is a sum over the sets of
// leaves: a whole number times the common area of the leaves of the set. If all leaves are convex
// polygons, clipping finds that area without set operations. Otherwise, a single intersection of
// leaves finds it.
//
//   CAG_TREES=10000 build/tests/geom/region_trees_test      runs this many trees of each family

#include "tests/geom/support.h"

#include <stdio.h>

#include "geom/curve/region.h"

enum { LEAVES = 4, OPERATIONS = 6, CORNERS = 32, QUICK = 60 };
// Areas must agree up to this fraction of the area of a box around all leaves.
#define SAME_AREA 1e-9

// --- Random numbers, the same on every machine ---

static uint64_t random_state;

static unsigned random_below(unsigned n) {
  random_state = random_state * 6364136223846793005u + 1442695040888963407u;
  return (unsigned)((random_state >> 33) % n);
}

static double random_real(double low, double high) {
  return low + (high - low) * random_below(1u << 30) / (1u << 30);
}

// --- Leaves ---

typedef struct Leaf {
  CagRegion *region;
  CagVec3 corners[CORNERS]; // of a convex polygon, counter-clockwise
  size_t n;                 // 0: not a convex polygon
} Leaf;

static CagRegion *region_of_loop(CagCurve *c) {
  CagRegion *r;
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  return r;
}

static double cross_of(CagVec3 a, CagVec3 b, CagVec3 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static Leaf convex_leaf(const CagVec3 *p, size_t n) {
  Leaf leaf = {.n = n};
  const bool turned = cross_of(p[0], p[1], p[2]) < 0;
  for (size_t i = 0; i < n; i++) leaf.corners[i] = p[turned ? n - 1 - i : i];
  CagCurve *c;
  OK(cag_curve_polyline(leaf.corners, n, true, 2, &c, &err));
  leaf.region = region_of_loop(c);
  return leaf;
}

static Leaf grid_triangle(void) {
  for (;;) {
    CagVec3 p[3];
    for (int i = 0; i < 3; i++) p[i] = cag_vec3(random_below(4), random_below(4), 0);
    if (cross_of(p[0], p[1], p[2]) != 0) return convex_leaf(p, 3);
  }
}

static Leaf real_triangle(void) {
  for (;;) {
    CagVec3 p[3];
    for (int i = 0; i < 3; i++) p[i] = cag_vec3(random_real(0, 3), random_real(0, 3), 0);
    if (fabs(cross_of(p[0], p[1], p[2])) > 1e-3) return convex_leaf(p, 3);
  }
}

static Leaf grid_rectangle(double turn) {
  const double x = random_below(4), y = random_below(4), w = 1 + random_below(3),
               h = 1 + random_below(3);
  CagVec3 p[4] = {{x, y, 0}, {x + w, y, 0}, {x + w, y + h, 0}, {x, y + h, 0}};
  for (int i = 0; i < 4; i++)
    p[i] = cag_vec3(p[i].x * cos(turn) - p[i].y * sin(turn),
                    p[i].x * sin(turn) + p[i].y * cos(turn), 0);
  return convex_leaf(p, 4);
}

static Leaf turned_rectangle(void) { return grid_rectangle(M_PI / 4); }

// A disk, or half of one with a diameter.
static Leaf disc(void) {
  const double radius = 1 + random_below(3);
  CagTransform frame = cag_translate(cag_vec3(random_below(5), random_below(4), 0));
  frame.planar = true;
  const bool half = random_below(3) == 0;
  const double start = half ? random_below(8) * M_PI / 4 : 0;
  CagCurve *arc, *c;
  OK(cag_curve_arc(radius, radius, start, start + (half ? M_PI : 2 * M_PI), &frame, &arc, &err));
  if (!half) return (Leaf){.region = region_of_loop(arc)};
  CagVec3 p, q;
  OK(cag_curve_point(arc, arc->start, &p, &err));
  OK(cag_curve_point(arc, arc->end, &q, &err));
  CagCurve *parts[2] = {arc};
  OK(cag_curve_line(q, p, 2, &parts[1], &err));
  OK(cag_curve_join(parts, 2, &c, &err));
  for (int i = 0; i < 2; i++) cag_curve_release(parts[i]);
  return (Leaf){.region = region_of_loop(c)};
}

// Bezier curves of degree 1 to 3 whose control points run steadily around a center.
static Leaf beziers(void) {
  enum { MOST = 5 };
  const int n = 3 + (int)random_below(MOST - 2);
  const bool grid = random_below(2) == 0;
  const CagVec3 center = {random_below(4), random_below(4), 0};
  CagVec3 points[3 * MOST + 1];
  for (int i = 0; i < 3 * n; i++) {
    const double radius = grid ? 1 + random_below(3) : random_real(0.75, 3);
    const double angle = 2 * M_PI * i / (3 * n);
    points[i] = cag_madd(center, radius, cag_vec3(cos(angle), sin(angle), 0));
  }
  points[3 * n] = points[0];
  CagCurve *parts[MOST], *c;
  for (int i = 0; i < n; i++) {
    const CagVec3 *p = points + 3 * i;
    const CagVec3 bent[3] = {p[0], p[1], p[3]};
    switch (random_below(3)) {
    case 0: OK(cag_curve_line(p[0], p[3], 2, &parts[i], &err)); break;
    case 1: OK(cag_curve_bezier(bent, NULL, 3, 2, &parts[i], &err)); break;
    default: OK(cag_curve_bezier(p, NULL, 4, 2, &parts[i], &err)); break;
    }
  }
  OK(cag_curve_join(parts, (size_t)n, &c, &err));
  for (int i = 0; i < n; i++) cag_curve_release(parts[i]);
  return (Leaf){.region = region_of_loop(c)};
}

static Leaf any_leaf(void) {
  static Leaf (*const kinds[])(void) = {grid_triangle, real_triangle, turned_rectangle, disc,
                                        beziers};
  return random_below(6) == 0 ? grid_rectangle(0)
                              : kinds[random_below(sizeof kinds / sizeof *kinds)]();
}

// --- Areas without set operations ---

// Clips the polygon to the left of the line from a to b.
static size_t clip(CagVec3 *p, size_t n, CagVec3 a, CagVec3 b) {
  CagVec3 out[CORNERS];
  size_t m = 0;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 u = p[i], v = p[(i + 1) % n];
    const double s = cross_of(a, b, u), t = cross_of(a, b, v);
    if (s >= 0) out[m++] = u;
    if ((s > 0 && t < 0) || (s < 0 && t > 0)) out[m++] = cag_lerp(u, v, s / (s - t));
  }
  memcpy(p, out, m * sizeof *p);
  return m;
}

static double polygon_area(const CagVec3 *p, size_t n) {
  double sum = 0;
  for (size_t i = 1; i + 1 < n; i++) sum += cross_of(p[0], p[i], p[i + 1]) / 2;
  return sum;
}

static double area_of(const CagRegion *r) {
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  return area;
}

static double common_area(const Leaf *leaves, unsigned set) {
  const CagRegion *members[LEAVES];
  size_t n = 0, m = 0;
  CagVec3 p[CORNERS];
  bool convex = true;
  for (int i = 0; i < LEAVES; i++) {
    if (!(set >> i & 1)) continue;
    const Leaf *leaf = &leaves[i];
    convex = convex && leaf->n > 0;
    if (n == 0) {
      m = leaf->n;
      memcpy(p, leaf->corners, m * sizeof *p);
    } else if (convex) {
      for (size_t k = 0; k < leaf->n; k++)
        m = clip(p, m, leaf->corners[k], leaf->corners[(k + 1) % leaf->n]);
    }
    members[n++] = leaf->region;
  }
  if (convex) return polygon_area(p, m);
  CagRegion *common;
  OK(cag_region_combine(CAG_REGION_INTERSECTION, members, n, &common, &err));
  const double area = area_of(common);
  cag_region_release(common);
  return area;
}

// --- Trees ---

typedef struct Node {
  CagRegion *region;
  bool holds[1 << LEAVES]; // whether points in exactly these leaves are in it
} Node;

static bool combine_bits(CagRegionOp op, bool a, bool b) {
  if (op == CAG_REGION_UNION) return a || b;
  return op == CAG_REGION_DIFFERENCE ? a && !b : a && b;
}

// The area by inclusion-exclusion, from the common areas of sets of leaves.
static double expected_area(const Node *node, const double *common) {
  double sum = 0;
  for (unsigned set = 1; set < 1 << LEAVES; set++) {
    int factor = 0;
    for (unsigned part = set;; part = (part - 1) & set) {
      if (node->holds[part]) factor += __builtin_parity(set ^ part) ? -1 : 1;
      if (part == 0) break;
    }
    sum += factor * common[set];
  }
  return sum;
}

// Rotates the region and rotates it back, which changes it only by rounding.
static CagRegion *jolted(const CagRegion *r) {
  if (random_below(4)) return cag_region_retain(r);
  const double angle = random_real(0, 2 * M_PI);
  CagRegion *turned[2];
  for (int i = 0; i < 2; i++) {
    CagTransform t = cag_transform_identity();
    t.m[0][0] = t.m[1][1] = cos(angle);
    t.m[1][0] = i ? -sin(angle) : sin(angle);
    t.m[0][1] = -t.m[1][0];
    t.planar = true;
    OK(cag_region_transform(i ? turned[0] : r, &t, &turned[i], &err));
  }
  cag_region_release(turned[0]);
  return turned[1];
}

// Returns false and prints a message if an operation fails or an area differs.
static bool check_tree(Leaf (*make)(void), uint64_t seed) {
  random_state = seed * 0x9E3779B97F4A7C15u + 1;
  Leaf leaves[LEAVES];
  Node nodes[LEAVES + OPERATIONS];
  double common[1 << LEAVES];
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int i = 0; i < LEAVES; i++) {
    CagBounds one;
    leaves[i] = make();
    nodes[i].region = leaves[i].region;
    for (unsigned set = 0; set < 1 << LEAVES; set++) nodes[i].holds[set] = set >> i & 1;
    OK(cag_region_bounds(leaves[i].region, &one, &err));
    cag_bounds_add(&box, one.min);
    cag_bounds_add(&box, one.max);
  }
  for (unsigned set = 1; set < 1 << LEAVES; set++) common[set] = common_area(leaves, set);
  const double all = (box.max.x - box.min.x) * (box.max.y - box.min.y);
  bool good = true;
  int made = LEAVES;
  for (; good && made < LEAVES + OPERATIONS; made++) {
    Node *node = &nodes[made];
    // Recent nodes are chosen more often, so that trees become deep.
    const Node *a = &nodes[random_below(2) ? (unsigned)made - 1 : random_below((unsigned)made)],
               *b = &nodes[random_below((unsigned)made)];
    const CagRegionOp op = (CagRegionOp)random_below(3);
    for (unsigned set = 0; set < 1 << LEAVES; set++)
      node->holds[set] = combine_bits(op, a->holds[set], b->holds[set]);
    CagRegion *first = jolted(a->region), *second = jolted(b->region);
    const CagStatus status = cag_region_boolean(op, first, second, &node->region, &err);
    cag_region_release(first);
    cag_region_release(second);
    if (status) {
      print_message("tree %d, node %d: %s\n", (int)seed, made, err.message);
      node->region = NULL;
      good = false;
      continue;
    }
    const double expected = expected_area(node, common), area = area_of(node->region);
    good = fabs(area - expected) <= SAME_AREA * all;
    if (!good)
      print_message("tree %d, node %d: the area is %.17g, expected %.17g\n", (int)seed, made, area,
                    expected);
  }
  for (int i = 0; i < made; i++) cag_region_release(nodes[i].region);
  return good;
}

static void check_trees(Leaf (*make)(void)) {
  const char *given = getenv("CAG_TREES");
  const int n = given ? atoi(given) : QUICK;
  int failed = 0;
  for (int i = 0; i < n; i++) failed += !check_tree(make, (uint64_t)i);
  if (failed) fail_msg("%d of %d trees fail", failed, n);
}

static void triangles_of_a_grid(void **state) {
  (void)state;
  check_trees(grid_triangle);
}

static void triangles_anywhere(void **state) {
  (void)state;
  check_trees(real_triangle);
}

static void rectangles_turned_by_45_degrees(void **state) {
  (void)state;
  check_trees(turned_rectangle);
}

static void discs_and_half_discs(void **state) {
  (void)state;
  check_trees(disc);
}

static void loops_of_beziers(void **state) {
  (void)state;
  check_trees(beziers);
}

static void all_of_them(void **state) {
  (void)state;
  check_trees(any_leaf);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(triangles_of_a_grid),
      cmocka_unit_test(triangles_anywhere),
      cmocka_unit_test(rectangles_turned_by_45_degrees),
      cmocka_unit_test(discs_and_half_discs),
      cmocka_unit_test(loops_of_beziers),
      cmocka_unit_test(all_of_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
