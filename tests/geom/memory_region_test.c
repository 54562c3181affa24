// Fills, strokes, offsets, sums, relations, and simplification of regions with faults (faults.h).

#include "tests/geom/faults.h"

#include "geom/curve/minkowski.h"
#include "geom/curve/region_fill.h"
#include "geom/curve/region_relation.h"
#include "geom/curve/region_stroke.h"
#include "geom/curve/simplify.h"

static CagStatus make_loop(double x, double y, double size, bool round, CagCurve **out,
                           CagError *e) {
  const CagVec3 p[] = {
      {x, y, 0}, {x + size, y + 0.1, 0}, {x + size, y + size, 0}, {x, y + size, 0}};
  CagTransform frame = cag_translate(cag_vec3(x + size / 2, y + size / 2, 0));
  frame.planar = true;
  return round ? cag_curve_arc(size / 2, size / 2, 0, 2 * M_PI, &frame, out, e)
               : cag_curve_polyline(p, 4, true, 2, out, e);
}

// A polygon with a round hole, away from the origin by x.
static CagStatus make_region(double x, CagRegion **out, CagError *e) {
  CagCurve *outer = NULL, *hole = NULL;
  CagStatus status = make_loop(x, 0, 4, false, &outer, e);
  if (!status) status = make_loop(x + 1, 1, 2, true, &hole, e);
  if (!status) status = cag_region_new(outer, &hole, 1, out, e);
  cag_curve_release(outer);
  cag_curve_release(hole);
  return status;
}

static CagStatus note(CagStatus status, CagRegion *r, CagError *e) {
  double area = 0;
  if (!status) status = cag_region_area(r, &area, NULL, e);
  if (!status) fault_found(area);
  cag_region_release(r);
  return status;
}

static CagStatus fill(const void *given, CagError *e) {
  CagCurve *loops[2] = {NULL};
  CagRegion *out = NULL;
  CagStatus status = make_loop(0, 0, 4, false, &loops[0], e);
  if (!status) status = make_loop(2, 2, 3, true, &loops[1], e);
  if (!status)
    status = cag_region_fill((const CagCurve *const *)loops, 2, *(const CagFill *)given, &out, e);
  for (int i = 0; i < 2; i++) cag_curve_release(loops[i]);
  return note(status, out, e);
}

static CagStatus stroke(const void *given, CagError *e) {
  const CagVec3 p[] = {{0, 0, 0}, {4, 0, 0}, {2, 2, 0}};
  const CagStroke pen = {1, 1e-3, *(const CagCap *)given, {CAG_JOIN_MITER, 2}};
  CagCurve *curves[2] = {NULL};
  CagRegion *out = NULL;
  CagStatus status = cag_curve_polyline(p, 3, false, 2, &curves[0], e);
  if (!status) status = cag_curve_bezier(p, NULL, 3, 2, &curves[1], e);
  if (!status) status = cag_region_stroke((const CagCurve *const *)curves, 2, &pen, &out, e);
  for (int i = 0; i < 2; i++) cag_curve_release(curves[i]);
  return note(status, out, e);
}

static CagStatus offset(const void *given, CagError *e) {
  const CagJoins joins = {CAG_JOIN_SQUARE, 2};
  CagRegion *r = NULL, *out = NULL;
  CagStatus status = make_region(0, &r, e);
  if (!status) status = cag_region_offset_joined(r, *(const double *)given, 1e-3, &joins, &out, e);
  cag_region_release(r);
  return note(status, out, e);
}

static CagStatus sum(const void *given, CagError *e) {
  (void)given;
  CagRegion *a = NULL, *b = NULL, *out = NULL;
  CagStatus status = make_region(0, &a, e);
  if (!status) status = cag_region_rectangle(1, 1, 0.2, &b, e);
  if (!status) status = cag_region_minkowski(a, b, 1e-3, &out, e);
  cag_region_release(a);
  cag_region_release(b);
  return note(status, out, e);
}

static CagStatus relate(const void *given, CagError *e) {
  CagRegion *a = NULL, *b = NULL;
  CagRegionRelation relation = CAG_REGION_DISJOINT;
  CagStatus status = make_region(0, &a, e);
  if (!status) status = make_region(*(const double *)given, &b, e);
  if (!status) status = cag_region_relation(a, b, &relation, e);
  if (!status) fault_found(relation);
  cag_region_release(a);
  cag_region_release(b);
  return status;
}

static CagStatus find_inside(const void *given, CagError *e) {
  (void)given;
  CagRegion *r = NULL;
  CagVec3 p;
  CagStatus status = make_region(0, &r, e);
  if (!status) status = cag_region_interior_point(r, &p, e);
  if (!status) fault_found(p.x + p.y);
  cag_region_release(r);
  return status;
}

static CagStatus simplify(const void *given, CagError *e) {
  const double tolerance = *(const double *)given;
  CagRegion *r = NULL, *out = NULL;
  CagCurve *c = NULL, *simple = NULL;
  CagStatus status = make_region(0, &r, e);
  if (!status) status = cag_region_simplify(r, tolerance, &out, e);
  if (!status) status = make_loop(0, 0, 2, false, &c, e);
  if (!status) status = cag_curve_simplify(c, tolerance, &simple, e);
  cag_region_release(r);
  cag_curve_release(c);
  cag_curve_release(simple);
  return note(status, out, e);
}

// Runs the operation without a fault first.
static void check(const char *name, FaultyOperation operation, const void *given) {
  OK(operation(given, &err));
  try_faults(name, "regions", operation, given);
}

static void regions_report_faults(void **state) {
  (void)state;
  static const double numbers[] = {0.3, -0.3, 4, 1};
  fault_problems = 0;
  for (CagFill i = CAG_FILL_EVEN_ODD; i <= CAG_FILL_POSITIVE; i++) check("fill", fill, &i);
  for (CagCap i = CAG_CAP_ROUND; i <= CAG_CAP_SQUARE; i++) check("stroke", stroke, &i);
  for (int i = 0; i < 2; i++) check("offset", offset, &numbers[i]);
  check("sum", sum, NULL);
  for (int i = 2; i < 4; i++) check("relation", relate, &numbers[i]);
  check("interior point", find_inside, NULL);
  check("simplify", simplify, &numbers[3]);
  assert_int_equal(fault_problems, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(regions_report_faults)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
