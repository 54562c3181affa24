// Set operations of boxes on a grid, some of them nested. The expected bounds, mass, and emptiness
// are those of the occupied cells.

#include "geom/solid/csg.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { SIDE = 7, MARGIN = 1, CELLS = SIDE + 2 * MARGIN };

// The cells (x, y, z) of the grid that belong to a solid; the margin stays empty.
typedef struct Body {
  CagSolid *solid;
  bool in[CELLS][CELLS][CELLS];
} Body;

static int random_int(int below) { return (int)uniform(0, below); }

static Body box_between(const int low[3], const int high[3]) {
  Body b = {0};
  CagSolid *s;
  const CagVec3 size = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
  const CagTransform t = cag_translate(cag_vec3(low[0], low[1], low[2]));
  OK(cag_solid_box(size, false, &s, &err));
  OK(cag_solid_transform(s, &t, &b.solid, &err));
  cag_solid_release(s);
  for (int x = low[0]; x < high[0]; x++)
    for (int y = low[1]; y < high[1]; y++)
      for (int z = low[2]; z < high[2]; z++) b.in[x + MARGIN][y + MARGIN][z + MARGIN] = true;
  return b;
}

static Body random_box(int longest) {
  int low[3], high[3];
  for (int k = 0; k < 3; k++) {
    const int length = 1 + random_int(longest);
    low[k] = random_int(SIDE - length + 1);
    high[k] = low[k] + length;
  }
  return box_between(low, high);
}

// Takes ownership of the operands.
static Body combined(CagSetOperation op, Body *operands, size_t n) {
  enum { MOST = 8 };
  Body out = operands[0];
  CagSolid *solids[MOST] = {NULL};
  for (size_t i = 0; i < n; i++) solids[i] = operands[i].solid;
  OK(cag_solid_combine(op, solids, n, NULL, &out.solid, &err));
  for (size_t i = 0; i < n; i++) cag_solid_release(solids[i]);
  for (size_t i = 1; i < n; i++)
    for (int x = 0; x < CELLS; x++)
      for (int y = 0; y < CELLS; y++)
        for (int z = 0; z < CELLS; z++) {
          bool *in = &out.in[x][y][z];
          const bool other = operands[i].in[x][y][z];
          *in = op == CAG_UNION        ? *in || other
                : op == CAG_DIFFERENCE ? *in && !other
                                       : *in && other;
        }
  return out;
}

static Body random_body(int depth, int longest) {
  const int n = 2 + random_int(3);
  Body operands[4] = {0};
  if (depth == 0) return random_box(longest);
  const CagSetOperation op =
      (CagSetOperation[]){CAG_UNION, CAG_DIFFERENCE, CAG_UNION, CAG_INTERSECTION}[random_int(4)];
  for (int i = 0; i < n; i++)
    operands[i] =
        random_body(random_int(2) ? depth - 1 : 0, op == CAG_INTERSECTION ? SIDE : longest);
  return combined(op, operands, (size_t)n);
}

// Sums over the cells, and over the faces between an occupied and an empty cell.
typedef struct Sums {
  double volume, area, inertia[3][3];
  CagVec3 center, area_center;
  CagBounds box;
} Sums;

static Sums sums_of(const Body *b) {
  Sums s = {.box = CAG_BOUNDS_EMPTY};
  static const int WAYS[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double second[3][3] = {{0}};
  CagVec3 first = {0, 0, 0}, moment = {0, 0, 0};
  for (int x = 0; x + 1 < CELLS; x++)
    for (int y = 0; y + 1 < CELLS; y++)
      for (int z = 0; z + 1 < CELLS; z++) {
        const CagVec3 low = {x - MARGIN, y - MARGIN, z - MARGIN};
        const CagVec3 middle = cag_add(low, cag_vec3(0.5, 0.5, 0.5));
        const bool in = b->in[x][y][z];
        for (int k = 0; k < 3; k++) {
          const int *way = WAYS[k];
          if (in == b->in[x + way[0]][y + way[1]][z + way[2]]) continue;
          s.area += 1;
          moment = cag_add(moment, cag_madd(middle, 0.5, cag_vec3(way[0], way[1], way[2])));
        }
        if (!in) continue;
        const double c[3] = {middle.x, middle.y, middle.z};
        for (int i = 0; i < 3; i++)
          for (int k = 0; k < 3; k++) second[i][k] += c[i] * c[k] + (i == k ? 1 / 12.0 : 0);
        s.volume += 1;
        first = cag_add(first, middle);
        cag_bounds_add(&s.box, low);
        cag_bounds_add(&s.box, cag_add(low, cag_vec3(1, 1, 1)));
      }
  s.center = cag_scaled(first, 1 / s.volume);
  s.area_center = cag_scaled(moment, 1 / s.area);
  const double c[3] = {s.center.x, s.center.y, s.center.z};
  double trace = 0;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) second[i][k] -= s.volume * c[i] * c[k];
  for (int i = 0; i < 3; i++) trace += second[i][i];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) s.inertia[i][k] = (i == k ? trace : 0) - second[i][k];
  return s;
}

// Checks the body itself, and a copy that is rotated, translated, and scaled, whose sums are
// multiplied by powers of the scale.
static void check_mass(const CagSolid *s, const Sums *sums, const CagTransform *place,
                       double scale) {
  CagMassProperties mass;
  const double far = cag_norm(cag_transform_point(place, cag_vec3(0, 0, 0))) + 20 * scale;
  const double noise = 1e-12 * far / scale;
  OK(cag_solid_mass(s, &mass, &err));
  NEAR(mass.volume / pow(scale, 3), sums->volume, 1e3 * noise);
  NEAR(mass.area / pow(scale, 2), sums->area, 1e3 * noise);
  near_vec(mass.volume_centroid, cag_transform_point(place, sums->center), 1e2 * noise * scale);
  near_vec(mass.area_centroid, cag_transform_point(place, sums->area_center), 1e2 * noise * scale);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double turned = 0;
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
          turned += place->m[i][k] * place->m[j][l] * sums->inertia[k][l] / (scale * scale);
      NEAR(mass.inertia[i][j] / pow(scale, 5), turned, 1e4 * noise);
    }
}

static void operations_have_the_mass_and_bounds_of_their_cells(void **state) {
  (void)state;
  seed = 61;
  int empty = 0, separate = 0;
  for (int k = 0; k < 90; k++) {
    // Small boxes are more often disjoint.
    const int longest = k % 4 == 0 ? 2 : 5;
    Body b = random_body(1 + k % 3, longest);
    const Sums sums = sums_of(&b);
    CagBounds box;
    bool none;
    if (b.solid->face_count > 0) { // a single box
      OK(cag_solid_is_empty(b.solid, &none, &err));
      assert_false(none);
      cag_solid_release(b.solid);
      continue;
    }
    OK(cag_solid_is_empty(b.solid, &none, &err));
    assert_int_equal(none, sums.volume == 0);
    if (none) {
      CagMassProperties mass;
      empty++;
      FAILS(cag_solid_bounds(b.solid, &box, &err), "empty-shape");
      if (cag_solid_mass(b.solid, &mass, &err) == CAG_OK) assert_true(mass.volume == 0);
      cag_solid_release(b.solid);
      continue;
    }
    separate += b.solid->kind == CAG_SOLID_UNION;
    OK(cag_solid_bounds(b.solid, &box, &err));
    near_vec(box.min, sums.box.min, 1e-12);
    near_vec(box.max, sums.box.max, 1e-12);
    const CagVec3 way = {random_int(20) - 15, random_int(20) - 15, random_int(20) - 15};
    const CagTransform lift = cag_translate(way);
    CagSolid *moved;
    OK(cag_solid_transform(b.solid, &lift, &moved, &err));
    OK(cag_solid_bounds(moved, &box, &err));
    near_vec(box.min, cag_add(sums.box.min, way), 1e-12);
    near_vec(box.max, cag_add(sums.box.max, way), 1e-12);
    cag_solid_release(moved);
    const CagTransform same = cag_transform_identity();
    check_mass(b.solid, &sums, &same, 1);
    const double scale = exp(uniform(-3, 3));
    const double x = uniform(-3, 3);
    const double y = uniform(-3, 3);
    const double z = uniform(-3, 3);
    CagTransform place = cag_rpy(x, y, z);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) place.m[i][j] *= (k % 2 && j == 0 ? -1 : 1) * scale;
    for (int i = 0; i < 3; i++) place.m[i][3] = uniform(-30, 30) * scale;
    OK(cag_solid_transform(b.solid, &place, &moved, &err));
    check_mass(moved, &sums, &place, scale);
    cag_solid_release(moved);
    cag_solid_release(b.solid);
  }
  assert_true(empty > 2);
  assert_true(separate > 10);
}

// Two boxes with a common face, which is not a face of their union.
static void boxes_that_touch_have_one_surface(void **state) {
  (void)state;
  for (int k = 0; k < 6; k++) {
    const int axis = k / 2;
    int low[3] = {1, 2, 3}, high[3] = {2, 4, 6};
    Body b[2] = {{0}};
    b[k % 2] = box_between(low, high);
    low[axis] = high[axis];
    high[axis] += 1;
    b[1 - k % 2] = box_between(low, high);
    Body both = combined(CAG_UNION, b, 2);
    const Sums sums = sums_of(&both);
    const CagTransform same = cag_transform_identity();
    check_mass(both.solid, &sums, &same, 1);
    cag_solid_release(both.solid);
  }
}

// Copies at other locations share the operands; releasing the last copy releases them.
static void the_last_copy_lets_operands_go(void **state) {
  (void)state;
  const int low[2][3] = {{0, 0, 0}, {1, 1, 1}}, high[2][3] = {{3, 4, 5}, {4, 5, 6}};
  for (int op = 0; op < 3; op++) {
    const Body a = box_between(low[0], high[0]), b = box_between(low[1], high[1]);
    const CagTransform t = cag_translate(cag_vec3(1, 2, 3));
    CagSolid *s, *moved;
    OK(cag_solid_combine((CagSetOperation[]){CAG_UNION, CAG_DIFFERENCE, CAG_INTERSECTION}[op],
                         (CagSolid *[]){a.solid, b.solid}, 2, NULL, &s, &err));
    OK(cag_solid_transform(s, &t, &moved, &err));
    assert_true(a.solid->references > 1 && b.solid->references > 1);
    cag_solid_release(s);
    assert_true(a.solid->references > 1 && b.solid->references > 1);
    cag_solid_release(moved);
    assert_int_equal(a.solid->references, 1);
    assert_int_equal(b.solid->references, 1);
    cag_solid_release(a.solid);
    cag_solid_release(b.solid);
  }
}

// A box without one of its sides, or with a notch, at any location.
static void cuts_across_a_side_move_that_side_alone(void **state) {
  (void)state;
  seed = 64;
  for (int k = 0; k < 48; k++) {
    const int axis = k % 3;
    const bool upper = k / 3 % 2, across = k / 6 % 2;
    int low[3], high[3];
    for (int i = 0; i < 3; i++) {
      low[i] = across || i == axis ? -1 : 1;
      high[i] = across || i == axis ? SIDE + 1 : 3;
    }
    if (upper) low[axis] = 5;
    else high[axis] = 2;
    Body b[2] = {box_between((int[]){0, 0, 0}, (int[]){SIDE, SIDE, SIDE}), box_between(low, high)};
    Body cut = combined(CAG_DIFFERENCE, b, 2);
    const Sums sums = sums_of(&cut);
    const CagVec3 way = {random_int(40) - 30, random_int(40) - 30, random_int(40) - 30};
    const CagTransform lift = cag_translate(way);
    CagSolid *moved;
    CagBounds box;
    OK(cag_solid_transform(cut.solid, &lift, &moved, &err));
    OK(cag_solid_bounds(moved, &box, &err));
    near_vec(box.min, cag_add(sums.box.min, way), 1e-12);
    near_vec(box.max, cag_add(sums.box.max, way), 1e-12);
    cag_solid_release(moved);
    cag_solid_release(cut.solid);
  }
}

static void empty_differences_name_their_operands(void **state) {
  (void)state;
  CagSolid *box, *ball, *none;
  CagBounds bounds;
  OK(cag_solid_box(cag_vec3(1, 2, 3), true, &box, &err));
  OK(cag_solid_sphere(5, &ball, &err));
  OK(cag_solid_combine(CAG_DIFFERENCE, (CagSolid *[]){box, ball}, 2, NULL, &none, &err));
  FAILS(cag_solid_bounds(none, &bounds, &err), "empty-shape");
  assert_non_null(strstr(err.message, "difference of (box, 1 x 2 x 3, centered) and (sphere, "));
  assert_null(strstr(err.message, "others"));
  bool empty;
  OK(cag_solid_is_empty(ball, &empty, &err));
  assert_false(empty);
  cag_solid_release(box);
  cag_solid_release(ball);
  cag_solid_release(none);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operations_have_the_mass_and_bounds_of_their_cells),
      cmocka_unit_test(cuts_across_a_side_move_that_side_alone),
      cmocka_unit_test(empty_differences_name_their_operands),
      cmocka_unit_test(boxes_that_touch_have_one_surface),
      cmocka_unit_test(the_last_copy_lets_operands_go),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
