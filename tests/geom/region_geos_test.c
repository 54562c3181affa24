// Relations, set operations, and repair of polygons, compared with GEOS (tests/data/geos).

#include "tests/geom/support.h"

#include <stdio.h>

#include "geom/curve/region_fill.h"
#include "geom/curve/region_relation.h"
#include "tests/geom/region_support.h"

#define FOLDER "tests/data/geos/"

static char line[1 << 17];

// Adds the rings of an operand, and returns the text after it.
static char *read_rings(char *text, CagCurve **rings, size_t *n) {
  enum { MOST = 4096 };
  static CagVec3 p[MOST];
  *n = 0;
  for (;;) {
    size_t count = 0;
    double x, y;
    int used;
    while (sscanf(text, " %lf %lf%n", &x, &y, &used) == 2) {
      assert_true(count < MOST);
      p[count++] = cag_vec3(x, y, 0);
      text += used;
    }
    if (count > 2) OK(cag_curve_polyline(p, count, true, 2, &rings[(*n)++], &err));
    while (*text == ' ') text++;
    if (*text != ',') return *text == '|' ? text + 1 : text;
    text++;
  }
}

static CagRegion *read_region(char **text) {
  CagCurve *rings[64];
  size_t n;
  CagRegion *r;
  *text = read_rings(*text, rings, &n);
  OK(cag_region_fill((const CagCurve *const *)rings, n, CAG_FILL_EVEN_ODD, &r, &err));
  for (size_t i = 0; i < n; i++) cag_curve_release(rings[i]);
  return r;
}

static FILE *open_table(const char *name) {
  FILE *file = fopen(name, "r");
  assert_non_null(file);
  return file;
}

// The next case: the operands after its first field, in which `b` may be missing.
static bool next_case(FILE *file, CagRegion **a, CagRegion **b) {
  if (!fgets(line, sizeof line, file)) return false;
  char *text = strchr(line, '|');
  assert_non_null(text);
  text++;
  *a = read_region(&text);
  if (b) *b = read_region(&text);
  return true;
}

static double area_of(const CagRegion *r) {
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  return area;
}

static void relations_are_those_of_the_matrix(void **state) {
  (void)state;
  static const char *const names[] = {"disjoint", "touches",  "overlaps",
                                      "within",   "contains", "equals"};
  FILE *file = open_table(FOLDER "relations.txt");
  CagRegion *a, *b;
  for (int row = 1; next_case(file, &a, &b); row++) {
    CagRegionRelation found;
    OK(cag_region_relation(a, b, &found, &err));
    const char *name = names[found];
    if (strncmp(line, name, strlen(name)) != 0) fail_msg("row %d: %s, not %.8s", row, name, line);
    cag_region_release(a);
    cag_region_release(b);
  }
  fclose(file);
}

static void results_have_the_area_and_rings(void **state) {
  (void)state;
  static const char *const names[] = {[CAG_REGION_UNION] = "union",
                                      [CAG_REGION_DIFFERENCE] = "difference",
                                      [CAG_REGION_INTERSECTION] = "intersection"};
  FILE *file = open_table(FOLDER "overlays.txt");
  CagRegion *a, *b, *r;
  for (int row = 1; next_case(file, &a, &b); row++) {
    char name[16];
    double area;
    size_t rings;
    assert_int_equal(sscanf(line, "%15s %lf %zu", name, &area, &rings), 3);
    for (int op = CAG_REGION_UNION; op <= CAG_REGION_INTERSECTION; op++) {
      if (strcmp(names[op], name) != 0) continue;
      OK(cag_region_boolean(op, a, b, &r, &err));
      if (r->count != rings) fail_msg("row %d: %zu rings, not %zu", row, r->count, rings);
      if (fabs(area_of(r) - area) > 1e-8 * (1 + area))
        fail_msg("row %d: the area %.12g is not %.12g", row, area_of(r), area);
      cag_region_release(r);
    }
    cag_region_release(a);
    cag_region_release(b);
  }
  fclose(file);
}

static void inner_points_are_inside(void **state) {
  (void)state;
  static const char *const tables[] = {FOLDER "relations.txt", FOLDER "robust.txt"};
  for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
    FILE *file = open_table(tables[i]);
    CagRegion *pair[2];
    while (next_case(file, &pair[0], &pair[1]))
      for (int k = 0; k < 2; k++) {
        CagVec3 p;
        if (cag_region_is_empty(pair[k]))
          FAILS(cag_region_interior_point(pair[k], &p, &err), "empty-shape");
        else {
          OK(cag_region_interior_point(pair[k], &p, &err));
          assert_true(holds(pair[k], p.x, p.y));
          assert_true(distance_to_boundary(pair[k], p) > 0);
        }
        cag_region_release(pair[k]);
      }
    fclose(file);
  }
}

// Corners are moved by up to 1e-9 of the size, so the area changes by up to that times the length
// of the boundaries.
static double area_slack(const CagRegion *a, const CagRegion *b) {
  const double part = 2e-9;
  const CagRegion *const both[2] = {a, b};
  double around = 0;
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int i = 0; i < 2; i++) {
    double length;
    CagBounds one;
    if (cag_region_is_empty(both[i])) continue; // thinner than the tolerance
    OK(cag_region_perimeter(both[i], &length, &err));
    OK(cag_region_bounds(both[i], &one, &err));
    around += length;
    cag_bounds_add(&box, one.min);
    cag_bounds_add(&box, one.max);
  }
  return part * cag_norm(cag_sub(box.max, box.min)) * around;
}

static void hard_cases_have_the_area(void **state) {
  (void)state;
  FILE *file = open_table(FOLDER "robust.txt");
  CagRegion *a, *b;
  for (int row = 1; next_case(file, &a, &b); row++) {
    double areas[3];
    const CagRegionOp ops[3] = {CAG_REGION_UNION, CAG_REGION_INTERSECTION, CAG_REGION_DIFFERENCE};
    assert_int_equal(sscanf(line, "%lf %lf %lf", &areas[0], &areas[1], &areas[2]), 3);
    const double slack = area_slack(a, b);
    for (int i = 0; i < 3; i++) {
      CagRegion *r;
      OK(cag_region_boolean(ops[i], a, b, &r, &err));
      if (fabs(area_of(r) - areas[i]) > slack)
        print_message("row %d: the area %.12g is not %.12g\n", row, area_of(r), areas[i]);
      cag_region_release(r);
    }
    cag_region_release(a);
    cag_region_release(b);
  }
  fclose(file);
}

static void repaired_polygons_have_the_area_and_rings(void **state) {
  (void)state;
  FILE *file = open_table(FOLDER "repairs.txt");
  CagRegion *a;
  while (next_case(file, &a, NULL)) {
    double area;
    size_t rings;
    assert_int_equal(sscanf(line, "%lf %zu", &area, &rings), 2);
    NEAR(area_of(a), area, 1e-12);
    assert_int_equal(a->count, rings);
    cag_region_release(a);
  }
  fclose(file);
}

static void offsets_with_miters_have_the_area_and_rings(void **state) {
  (void)state;
  const CagJoins joins = {CAG_JOIN_MITER, 5};
  FILE *file = open_table(FOLDER "mitered.txt");
  CagRegion *a, *r;
  while (next_case(file, &a, NULL)) {
    double area, d;
    size_t rings;
    assert_int_equal(sscanf(line, "%lf %zu %lf", &area, &rings, &d), 3);
    OK(cag_region_offset_joined(a, d, 1e-6, &joins, &r, &err));
    // The first polygon has vertices at the distance 3e-6, which GEOS merges.
    NEAR(area_of(r), area, 1e-4);
    assert_int_equal(r->count, rings);
    cag_region_release(r);
    cag_region_release(a);
  }
  fclose(file);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(relations_are_those_of_the_matrix),
      cmocka_unit_test(results_have_the_area_and_rings),
      cmocka_unit_test(inner_points_are_inside),
      cmocka_unit_test(hard_cases_have_the_area),
      cmocka_unit_test(offsets_with_miters_have_the_area_and_rings),
      cmocka_unit_test(repaired_polygons_have_the_area_and_rings),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
