// Tests regions, solids, meshes, surface fits, and robots with exhausted memory and with
// interrupted work. Each fault is reported, and nothing leaks.

#include "faults.h"
#include "geom/boolean/boolean.h"
#include "geom/curve/region.h"
#include "geom/distance/separation.h"
#include "geom/meet/meet_surface.h"
#include "geom/meet/quadric_body.h"
#include "geom/meet/section.h"
#include "geom/mesh/check.h"
#include "geom/mesh/facets.h"
#include "geom/mesh/hull.h"
#include "geom/ray/mesh_surface.h"
#include "geom/robot/path.h"
#include "geom/robot/robot.h"
#include "geom/solid/clip.h"
#include "geom/solid/csg.h"
#include "geom/solid/general.h"
#include "geom/solid/inside.h"
#include "geom/solid/solid.h"
#include "geom/solid/tessellate.h"
#include "geom/surface/edit.h"
#include "geom/surface/loft.h"
#include "geom/surface/patches.h"
#include "geom/surface/quadric.h"
#include "geom/surface/reshape.h"
#include "geom/surface/swept.h"
#include "geom/tessellate/orient.h"
#include "geom/tessellate/split.h"

#define QUESTION(name) static CagStatus name(const void *given, CagError *e)
// They take the address because the caller evaluates it before the call that makes the object.
static CagStatus drop_region(CagStatus status, CagRegion *const *made) {
  if (status) return status;
  fault_found((double)(*made)->count);
  cag_region_release(*made);
  return status;
}
static CagStatus drop_surface(CagStatus status, CagSurface *const *made) {
  if (status) return status;
  fault_found((*made)->u1);
  cag_surface_release(*made);
  return status;
}
static CagStatus drop_solid(CagStatus status, CagSolid *const *made) {
  if (status) return status;
  fault_found((double)(*made)->face_count);
  cag_solid_release(*made);
  return status;
}
static CagStatus drop_mesh(CagStatus status, CagMesh *const *made) {
  if (status) return status;
  fault_found((double)(*made)->triangle_count);
  cag_mesh_release(*made);
  return status;
}

// --- Regions ---

typedef struct Regions {
  CagRegion *a, *b;
} Regions;

static CagStatus blob(CagVec3 center, CagRegion **out, CagError *e) {
  CagVec3 p[6];
  CagCurve *c;
  for (int i = 0; i < 6; i++) {
    const double a = 2 * M_PI * i / 6, r = i % 2 ? 2 : 1.4;
    p[i] = cag_add(center, cag_vec3(r * cos(a), r * sin(a), 0));
  }
  CagStatus status = cag_curve_nurbs_closed(p, NULL, 6, 3, 2, &c, e);
  if (status) return status;
  status = cag_region_new(c, NULL, 0, out, e);
  cag_curve_release(c);
  return status;
}

QUESTION(rectangle) {
  (void)given;
  CagRegion *made;
  return drop_region(cag_region_rectangle(4, 3, 0.5, &made, e), &made);
}
QUESTION(polygon) {
  (void)given;
  CagRegion *made;
  return drop_region(cag_region_regular_polygon(7, 2, &made, e), &made);
}
QUESTION(no_region) {
  (void)given;
  CagRegion *made;
  return drop_region(cag_region_empty(&made, e), &made);
}
QUESTION(region_with_a_hole) {
  (void)given;
  const CagTransform frame = cag_transform_identity();
  CagCurve *loops[2] = {0};
  CagRegion *made;
  CagStatus status = cag_curve_arc(3, 2, 0, 2 * M_PI, &frame, &loops[0], e);
  if (!status) status = cag_curve_arc(1, 1, 0, 2 * M_PI, &frame, &loops[1], e);
  if (!status) status = cag_region_new(loops[0], &loops[1], 1, &made, e);
  if (!status) status = drop_region(status, &made);
  if (!status) status = drop_region(cag_region_from_loops(loops, 2, &made, e), &made);
  for (int i = 0; i < 2; i++) cag_curve_release(loops[i]);
  return status;
}
QUESTION(region_sizes) {
  const Regions *r = given;
  double area, xx, xy, yy, perimeter;
  CagVec3 center;
  CagBounds box;
  bool in;
  CagStatus status = cag_region_area(r->a, &area, &center, e);
  if (!status) status = cag_region_second_moments(r->a, &area, &center, &xx, &xy, &yy, e);
  if (!status) status = cag_region_perimeter(r->a, &perimeter, e);
  if (!status) status = cag_region_bounds(r->a, &box, e);
  if (!status) status = cag_region_contains(r->a, cag_vec3(0.3, 0.2, 0), &in, e);
  if (!status) fault_found(area + xx + perimeter + box.max.x + in);
  return status;
}
QUESTION(region_moved) {
  const Regions *r = given;
  CagRegion *made;
  CagTransform t = cag_transform_identity();
  t.m[0][0] = -1;
  return drop_region(cag_region_transform(r->a, &t, &made, e), &made);
}
#define SET_OPERATION(name, op)                                                                    \
  QUESTION(name) {                                                                                 \
    const Regions *r = given;                                                                      \
    CagRegion *made;                                                                               \
    return drop_region(cag_region_boolean(op, r->a, r->b, &made, e), &made);                       \
  }
SET_OPERATION(region_union, CAG_REGION_UNION)
SET_OPERATION(region_difference, CAG_REGION_DIFFERENCE)
SET_OPERATION(region_intersection, CAG_REGION_INTERSECTION)
QUESTION(region_grown) {
  const Regions *r = given;
  CagRegion *made;
  return drop_region(cag_region_offset(r->b, 0.3, 1e-2, &made, e), &made);
}
QUESTION(region_shrunk) {
  const Regions *r = given;
  CagRegion *made;
  return drop_region(cag_region_offset(r->b, -0.3, 1e-2, &made, e), &made);
}

static void regions_report_faults(void **state) {
  (void)state;
  Regions r;
  fault_steps = FAULTS_OF_SLOW;
  OK(blob(cag_vec3(0, 0, 0), &r.a, &err));
  OK(cag_region_rectangle(3, 2, 0.5, &r.b, &err));
  try_faults("rectangle", "region", rectangle, NULL);
  try_faults("polygon", "region", polygon, NULL);
  try_faults("empty", "region", no_region, NULL);
  try_faults("hole", "region", region_with_a_hole, NULL);
  try_faults("sizes", "region", region_sizes, &r);
  try_faults("transform", "region", region_moved, &r);
  try_faults("union", "region", region_union, &r);
  try_faults("difference", "region", region_difference, &r);
  try_faults("intersection", "region", region_intersection, &r);
  try_faults("grown", "region", region_grown, &r);
  try_faults("shrunk", "region", region_shrunk, &r);
  cag_region_release(r.a);
  cag_region_release(r.b);
  assert_int_equal(fault_problems, 0);
}

// --- Solids ---

static CagStatus bent_path(CagCurve **out, CagError *e) {
  const CagVec3 p[4] = {{0, 0, 0}, {3, 0, 1}, {6, 4, 0}, {9, 4, 3}};
  return cag_curve_bezier(p, NULL, 4, 3, out, e);
}
#define MAKER(name) static CagStatus name(CagSolid **out, CagError *e)
MAKER(box) { return cag_solid_box(cag_vec3(3, 4, 2), true, out, e); }
MAKER(sphere) { return cag_solid_sphere(2, out, e); }
MAKER(cone) { return cag_solid_cylinder(3, 2, 0, out, e); }
MAKER(torus) { return cag_solid_torus(4, 1, out, e); }
static CagStatus of_region(CagStatus (*make)(const CagRegion *r, CagSolid **out, CagError *e),
                           CagVec3 center, CagSolid **out, CagError *e) {
  CagRegion *r;
  CagStatus status = blob(center, &r, e);
  if (status) return status;
  status = make(r, out, e);
  cag_region_release(r);
  return status;
}
static CagStatus pushed(const CagRegion *r, CagSolid **out, CagError *e) {
  return cag_solid_extrude(r, cag_vec3(0, 0.5, 3), 0, 1, out, e);
}
static CagStatus twisted(const CagRegion *r, CagSolid **out, CagError *e) {
  return cag_solid_extrude(r, cag_vec3(0, 0, -3), 1, 0.5, out, e);
}
static CagStatus turned(const CagRegion *r, CagSolid **out, CagError *e) {
  return cag_solid_revolve(r, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, out, e);
}
static CagStatus partly_turned(const CagRegion *r, CagSolid **out, CagError *e) {
  return cag_solid_revolve(r, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0.3, 2, out, e);
}
static CagStatus carried(const CagRegion *r, CagSolid **out, CagError *e) {
  CagCurve *path;
  CagMotion *motion = NULL;
  const CagPathMotion how = {.scale = {0.3, 0.2, NULL}};
  CagStatus status = bent_path(&path, e);
  if (status) return status;
  status = cag_motion_along(path, &how, &motion, e);
  if (!status) status = cag_solid_sweep(r, motion, out, e);
  cag_curve_release(path);
  cag_motion_release(motion);
  return status;
}
MAKER(extrusion) { return of_region(pushed, cag_vec3(0, 0, 0), out, e); }
MAKER(twist) { return of_region(twisted, cag_vec3(0, 0, 0), out, e); }
MAKER(revolution) { return of_region(turned, cag_vec3(4, 0, 0), out, e); }
MAKER(partial_revolution) { return of_region(partly_turned, cag_vec3(4, 0, 0), out, e); }
MAKER(sweep) { return of_region(carried, cag_vec3(0, 0, 0), out, e); }
MAKER(tube) {
  CagCurve *path;
  CagStatus status = bent_path(&path, e);
  if (status) return status;
  status = cag_solid_tube(path, 0.3, out, e);
  cag_curve_release(path);
  return status;
}
MAKER(tapered_tube) {
  CagCurve *path;
  const CagAlong radius = {0.3, 0.1, NULL};
  CagStatus status = bent_path(&path, e);
  if (status) return status;
  status = cag_solid_tube_along(path, &radius, out, e);
  cag_curve_release(path);
  return status;
}
MAKER(loft) {
  CagCurve *rings[3] = {0};
  CagSurface *side;
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 3; i++) {
    CagTransform frame = cag_translate(cag_vec3(0, 0, 2.0 * i));
    status = cag_curve_arc(1 + i % 2, 1 + i % 2, 0, 2 * M_PI, &frame, &rings[i], e);
  }
  const CagCurve *const curves[3] = {rings[0], rings[1], rings[2]};
  if (!status && !(status = cag_surface_loft(curves, 3, 2, false, &side, e))) {
    status = cag_solid_loft(side, out, e);
    cag_surface_release(side);
  }
  for (int i = 0; i < 3; i++) cag_curve_release(rings[i]);
  return status;
}
static CagStatus bump(CagSurface **out, CagError *e) {
  CagVec3 p[9];
  for (int i = 0; i < 9; i++) p[i] = cag_vec3(2 * (i / 3), 2 * (i % 3), i == 4);
  return cag_surface_bezier(p, NULL, 3, 3, out, e);
}
MAKER(thickened) {
  CagSurface *s;
  CagStatus status = bump(&s, e);
  if (status) return status;
  status = cag_solid_thicken(s, 0.2, out, e);
  cag_surface_release(s);
  return status;
}
MAKER(shell) { // the faces of a box
  CagSolid *from;
  CagStatus status = box(&from, e);
  if (status) return status;
  status = cag_solid_shell(from->faces, from->face_count, out, e);
  cag_solid_release(from);
  return status;
}
MAKER(half_space) {
  const CagPlane plane = {{0, 0, 0.2}, {0, 0.6, 0.8}};
  return cag_solid_half_space(&plane, out, e);
}
MAKER(quadric) {
  const CagQuadric form = {{1, 1, -0.5, 0, 0, 0, 0, 0, 0, -2}};
  return cag_solid_quadric(&form, out, e);
}
static CagStatus combined(CagSetOperation op, CagStatus (*of)(CagSolid **out, CagError *e),
                          CagSolid **out, CagError *e) {
  CagSolid *parts[2] = {0};
  CagStatus status = box(&parts[0], e);
  if (!status) status = of(&parts[1], e);
  if (!status) status = cag_solid_combine(op, parts, 2, NULL, out, e);
  for (int i = 0; i < 2; i++) cag_solid_release(parts[i]);
  return status;
}
MAKER(united) { return combined(CAG_UNION, cone, out, e); }
MAKER(cut) { return combined(CAG_DIFFERENCE, half_space, out, e); }
MAKER(common) { return combined(CAG_INTERSECTION, quadric, out, e); }
MAKER(in_mesh) {
  CagSolid *from;
  CagMesh *m;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagStatus status = box(&from, e);
  if (status) return status;
  status = cag_solid_tessellate(from, &how, &m, e);
  cag_solid_release(from);
  if (status) return status;
  status = cag_solid_from_mesh(m, out, e);
  cag_mesh_release(m);
  return status;
}

typedef struct Kind {
  const char *name;
  CagStatus (*make)(CagSolid **out, CagError *e);
} Kind;
#define ROW(name)                                                                                  \
  { #name, name }
static const Kind KINDS[] = {
    ROW(box),       ROW(sphere), ROW(cone),         ROW(torus),
    ROW(extrusion), ROW(twist),  ROW(revolution),   ROW(partial_revolution),
    ROW(sweep),     ROW(tube),   ROW(tapered_tube), ROW(loft),
    ROW(thickened), ROW(shell),  ROW(half_space),   ROW(quadric),
    ROW(united),    ROW(cut),    ROW(common),       ROW(in_mesh),
};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

#define SOLID const CagSolid *s = given
static CagTessellation coarse(void) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 0.3;
  how.angle = 1;
  return how;
}
QUESTION(solid_bounds) {
  SOLID;
  CagBounds b;
  const CagStatus status = cag_solid_bounds(s, &b, e);
  if (!status) fault_found(b.max.x);
  return status;
}
QUESTION(mass) {
  SOLID;
  CagMassProperties m;
  const CagStatus status = cag_solid_mass_within(s, 0.3, &m, e);
  if (!status) fault_found(m.volume);
  return status;
}
QUESTION(solid_moved) {
  SOLID;
  CagSolid *made;
  const CagTransform t = cag_rpy(0.3, 0.2, 0.1);
  return drop_solid(cag_solid_transform(s, &t, &made, e), &made);
}
QUESTION(solid_sheared) {
  SOLID;
  CagSolid *made;
  const CagTransform t = cag_shear(0.3, 0, 0, 0, 0.2, 0);
  return drop_solid(cag_solid_transform(s, &t, &made, e), &made);
}
QUESTION(solid_mesh) {
  SOLID;
  CagMesh *made;
  const CagTessellation how = coarse();
  return drop_mesh(cag_solid_tessellate(s, &how, &made, e), &made);
}
QUESTION(is_empty) {
  SOLID;
  bool is;
  const CagStatus status = cag_solid_is_empty(s, &is, e);
  if (!status) fault_found(is);
  return status;
}
QUESTION(reach) {
  SOLID;
  CagBounds b;
  const CagStatus status = cag_solid_reach(s, &b, e);
  if (!status) fault_found(isfinite(b.max.x));
  return status;
}
QUESTION(holds) {
  SOLID;
  CagInside *inside;
  const CagTessellation how = coarse();
  bool in = false;
  CagStatus status = cag_inside_new(s, &how, &inside, e);
  if (status) return status;
  status = cag_inside_holds(inside, cag_vec3(0.4, 0.3, 0.2), &in, e);
  cag_inside_free(inside);
  if (!status) fault_found(in);
  return status;
}
QUESTION(clipped_line) {
  SOLID;
  CagCurve *c, **parts;
  size_t n;
  CagStatus status = cag_curve_line(cag_vec3(-9, 0.3, 0.4), cag_vec3(9, 0.5, 0.3), 3, &c, e);
  if (status) return status;
  status = cag_curve_clip(c, s, NULL, &parts, &n, e);
  cag_curve_release(c);
  if (status) return status;
  for (size_t i = 0; i < n; i++) cag_curve_release(parts[i]);
  fault_found((double)n);
  free(parts);
  return CAG_OK;
}
QUESTION(clipped_surface) {
  SOLID;
  CagSurface *plane;
  CagMesh *made;
  const CagTessellation how = coarse();
  CagStatus status = cag_surface_bilinear(cag_vec3(-3, -3, 0.3), cag_vec3(-3, 3, 0.3),
                                          cag_vec3(3, -3, 0.3), cag_vec3(3, 3, 0.3), &plane, e);
  if (status) return status;
  status = cag_surface_clip(plane, s, &how, &made, e);
  cag_surface_release(plane);
  return drop_mesh(status, &made);
}
QUESTION(solid_section) {
  SOLID;
  CagCurveList list = {0};
  const CagPlane plane = {{0, 0, 0.3}, {0, 0, 1}};
  const CagStatus status = cag_solid_section(s, &plane, 0.1, &list, e);
  if (!status) fault_found((double)list.count);
  cag_curve_list_free(&list);
  return status;
}
QUESTION(in_general_position) {
  SOLID;
  (void)e;
  cag_solid_in_general_position(s, NULL);
  return CAG_OK;
}
// What the exact surface tells about the mesh.
QUESTION(mesh_against_surface) {
  SOLID;
  CagMesh *m;
  CagCaster *caster = NULL;
  const CagTessellation how = coarse();
  double farthest = 0;
  CagStatus status = cag_solid_tessellate(s, &how, &m, e);
  if (status) return status;
  const size_t n = m->triangle_count;
  float *values = __real_malloc((6 * n + 1) * sizeof *values);
  uint32_t *leaves = __real_malloc((n + 1) * sizeof *leaves);
  status = cag_mesh_leaves(s, m, leaves, e);
  if (!status) status = cag_caster_of_solid(s, &caster, e);
  if (!status) status = cag_mesh_curvature(caster, m, values, values + 3 * n, e);
  if (!status) status = cag_mesh_deviation(caster, m, values, &farthest, e);
  if (!status) fault_found(farthest + (n > 0 ? leaves[n - 1] : 0));
  cag_caster_free(caster);
  cag_mesh_release(m);
  __real_free(values);
  __real_free(leaves);
  return status;
}
typedef struct Question {
  const char *name;
  FaultyOperation ask;
} Question;
static const Question QUESTIONS[] = {
    ROW(solid_bounds),
    ROW(mass),
    ROW(solid_moved),
    ROW(solid_sheared),
    ROW(solid_mesh),
    ROW(is_empty),
    ROW(reach),
    ROW(holds),
    ROW(clipped_line),
    ROW(clipped_surface),
    ROW(solid_section),
    ROW(in_general_position),
    ROW(mesh_against_surface),
};

static CagStatus make_kind(const void *given, CagError *e) {
  const Kind *kind = given;
  CagSolid *s;
  return drop_solid(kind->make(&s, e), &s);
}
QUESTION(make_and_mesh) {
  const Kind *kind = given;
  CagSolid *s;
  CagStatus status = kind->make(&s, e);
  if (status) return status;
  status = solid_mesh(s, e);
  cag_solid_release(s);
  return status;
}
static void solids_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  for (int k = 0; k < KIND_COUNT; k++) {
    try_faults("making", KINDS[k].name, make_kind, &KINDS[k]);
    try_faults("mesh", KINDS[k].name, make_and_mesh, &KINDS[k]);
  }
  assert_int_equal(fault_problems, 0);
}
static void questions_to_solids_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_SLOW;
  for (int k = 0; k < KIND_COUNT; k++) {
    CagSolid *s;
    OK(KINDS[k].make(&s, &err));
    for (size_t q = 0; q < sizeof QUESTIONS / sizeof *QUESTIONS; q++) {
      QUESTIONS[q].ask(s, &err); // set operations keep the mesh that they create
      try_faults(QUESTIONS[q].name, KINDS[k].name, QUESTIONS[q].ask, s);
    }
    cag_solid_release(s);
  }
  assert_int_equal(fault_problems, 0);
}

// --- Meshes ---

typedef struct Meshes {
  CagMesh *a, *b;
} Meshes;
#define MESHES const Meshes *m = given

#define MESH_OPERATION(name, op)                                                                   \
  QUESTION(name) {                                                                                 \
    MESHES;                                                                                        \
    CagMesh *made;                                                                                 \
    return drop_mesh(cag_mesh_boolean(op, m->a, m->b, NULL, &made, e), &made);                     \
  }
MESH_OPERATION(mesh_union, CAG_UNION)
MESH_OPERATION(mesh_difference, CAG_DIFFERENCE)
MESH_OPERATION(mesh_intersection, CAG_INTERSECTION)
QUESTION(check) {
  MESHES;
  CagMeshCheck found;
  const CagStatus status = cag_mesh_check(m->a, &found, e);
  if (!status) fault_found((double)found.edges);
  return status;
}
QUESTION(facets) {
  MESHES;
  CagFacets found;
  const CagStatus status = cag_mesh_facets(m->a, 1e-9, &found, e);
  if (!status) fault_found((double)found.edge_count);
  if (!status) cag_facets_free(&found);
  return status;
}
QUESTION(weld) {
  MESHES;
  CagMesh *made;
  return drop_mesh(cag_mesh_weld(m->a, 1e-6, &made, e), &made);
}
QUESTION(mesh_flip) {
  MESHES;
  CagMesh *made;
  return drop_mesh(cag_mesh_flip(m->a, &made, e), &made);
}
QUESTION(mesh_moved) {
  MESHES;
  CagMesh *made;
  CagTransform t = cag_rpy(1, 2, 3);
  return drop_mesh(cag_mesh_transform(m->a, &t, &made, e), &made);
}
QUESTION(append) {
  MESHES;
  CagMesh *made, *const both[2] = {m->a, m->b};
  return drop_mesh(cag_mesh_append(both, 2, &made, e), &made);
}
QUESTION(mesh_outward) {
  MESHES;
  CagMesh *turned_over, *made;
  CagStatus status = cag_mesh_flip(m->a, &turned_over, e);
  if (status) return status;
  status = cag_mesh_outward(turned_over, &made, e);
  cag_mesh_release(turned_over);
  return drop_mesh(status, &made);
}
QUESTION(open_edges) {
  MESHES;
  size_t n;
  return cag_mesh_open_edges(m->a, &n, e);
}
QUESTION(split_edges) {
  MESHES;
  CagMesh *made;
  return drop_mesh(cag_mesh_split_edges(m->a, 1, 100000, &made, e), &made);
}
QUESTION(mesh_section) {
  MESHES;
  CagCurveList list = {0};
  const CagPlane plane = {{0, 0, 0.3}, {0, 0.6, 0.8}};
  const CagStatus status = cag_mesh_section(m->a, &plane, &list, e);
  if (!status) fault_found((double)list.count);
  cag_curve_list_free(&list);
  return status;
}
QUESTION(hull_in_space) {
  MESHES;
  CagMesh *made;
  return drop_mesh(cag_hull_space(m->b->positions, m->b->vertex_count, &made, e), &made);
}
QUESTION(hull_in_plane) {
  MESHES;
  size_t *corners, n;
  const CagStatus status = cag_hull_plane(m->b->positions, m->b->vertex_count, &corners, &n, e);
  if (!status) free(corners);
  return status;
}
QUESTION(distance) {
  MESHES;
  CagParts a = {0}, b = {0};
  double d;
  CagStatus status = cag_parts_add_mesh(&a, m->a, NULL, 0.1, e);
  if (!status) status = cag_parts_add_point(&b, cag_vec3(9, 8, 7), e);
  if (!status) status = cag_parts_distance(&a, &b, CAG_PARTS_PAIRS, &d, NULL, NULL, e);
  if (!status) fault_found(d);
  cag_parts_free(&a);
  cag_parts_free(&b);
  return status;
}
QUESTION(from_faces) {
  (void)given;
  static const CagVec3 corners[5] = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {1, 1, 3}};
  static const uint32_t indices[7] = {0, 1, 2, 3, 0, 1, 4}, counts[2] = {4, 3};
  CagMesh *made;
  return drop_mesh(cag_mesh_from_faces(corners, 5, indices, counts, 2, &made, e), &made);
}
static const Question MESH_QUESTIONS[] = {
    ROW(mesh_union),    ROW(mesh_difference), ROW(mesh_intersection), ROW(check),
    ROW(weld),          ROW(mesh_flip),       ROW(mesh_moved),        ROW(append),
    ROW(mesh_outward),  ROW(open_edges),      ROW(split_edges),       ROW(mesh_section),
    ROW(hull_in_space), ROW(hull_in_plane),   ROW(distance),          ROW(from_faces),
    ROW(facets),
};

static void meshes_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  CagSolid *s, *t;
  Meshes m;
  const CagTessellation how = coarse();
  OK(box(&s, &err));
  OK(cone(&t, &err));
  OK(cag_solid_tessellate(s, &how, &m.a, &err));
  OK(cag_solid_tessellate(t, &how, &m.b, &err));
  for (size_t q = 0; q < sizeof MESH_QUESTIONS / sizeof *MESH_QUESTIONS; q++)
    try_faults(MESH_QUESTIONS[q].name, "mesh", MESH_QUESTIONS[q].ask, &m);
  cag_mesh_release(m.a);
  cag_mesh_release(m.b);
  cag_solid_release(s);
  cag_solid_release(t);
  assert_int_equal(fault_problems, 0);
}

// --- Two surfaces, and surfaces of points ---

typedef struct Surfaces {
  CagSurface *a, *b;
} Surfaces;
#define SURFACES const Surfaces *s = given

QUESTION(where_surfaces_meet) {
  SURFACES;
  CagCurveList list = {0};
  const CagStatus status = cag_surface_intersect(s->a, s->b, 1e-2, NULL, &list, e);
  if (!status) fault_found((double)list.count);
  cag_curve_list_free(&list);
  return status;
}
QUESTION(surfaces_joined) {
  SURFACES;
  CagSurface *left, *right = NULL, *made;
  CagStatus status = cag_surface_part(s->a, 0, 0.5, 0, 1, &left, e);
  if (status) return status;
  status = cag_surface_part(s->a, 0.5, 1, 0, 1, &right, e);
  if (!status) status = cag_surface_join(left, right, 1e-9, &made, e);
  cag_surface_release(left);
  cag_surface_release(right);
  return drop_surface(status, &made);
}
QUESTION(seam) {
  SURFACES;
  CagSeam found;
  return cag_surface_seam(s->a, s->b, 1e-9, &found, e);
}
QUESTION(match) {
  SURFACES;
  CagSurface *made;
  const CagEdgeMatch how = {1, {0, 0}};
  const int sides[2] = {1, 0};
  return drop_surface(cag_surface_match(s->a, s->a, &how, sides, &made, e), &made);
}
static CagVec3 POINTS[36];
static CagGridData grid_data(void) {
  for (int i = 0; i < 36; i++)
    POINTS[i] = cag_vec3(i / 6, i % 6, sin(i / 6) * cos(i % 6)); // NOLINT
  return (CagGridData){.points = POINTS, .r = 6, .s = 6, .degree_u = 3, .degree_v = 2};
}
QUESTION(surface_through_points) {
  (void)given;
  CagSurface *made;
  CagGridReport report;
  const CagGridData data = grid_data();
  const CagStatus status = cag_surface_interpolate_report(&data, &made, &report, e);
  if (!status) cag_grid_report_free(&report);
  return drop_surface(status, &made);
}
QUESTION(surface_fitted) {
  CagSurface *made;
  CagGridReport report;
  CagGridData data = grid_data();
  data.hold = *(const CagGridHold *)given;
  data.slack = 1e-6;
  data.corrections = data.hold ? 0 : 2;
  const CagStatus status = cag_surface_fit(&data, 5, 4, &made, &report, e);
  if (!status) cag_grid_report_free(&report);
  return drop_surface(status, &made);
}
QUESTION(surface_hermite) {
  (void)given;
  CagSurface *made;
  CagHermiteCorners c = {.p = {{{0, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 1}}}};
  return drop_surface(cag_surface_hermite(&c, 0, 1, 0, 2, &made, e), &made);
}
QUESTION(surface_hermite_grid) {
  (void)given;
  CagSurface *made;
  const CagVec3 along[3] = {{1, 0, 0}, {1, 0, 1}, {1, 0, 0}};
  CagVec3 p[9];
  for (int i = 0; i < 9; i++) p[i] = cag_vec3(i / 3, i % 3, i % 2);
  const CagHermiteGrid g = {.nu = 3,
                            .nv = 3,
                            .points = p,
                            .u_start = along,
                            .u_end = along,
                            .v_start = along,
                            .v_end = along};
  return drop_surface(cag_surface_hermite_grid(&g, &made, e), &made);
}
QUESTION(surface_triangle) {
  (void)given;
  CagSurface *made;
  const CagVec3 p[6] = {{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {2, 0, 0}, {1, 1, 1}, {0, 2, 0}};
  return drop_surface(cag_surface_bezier_triangle(p, 2, &made, e), &made);
}
QUESTION(quadric_in_a_box) {
  CagSurface **made;
  size_t n;
  const CagBounds within = {{-2, -2, -1.5}, {2, 1.8, 2}};
  const CagStatus status = cag_quadric_patches(given, &within, false, &made, &n, e);
  if (status) return status;
  fault_found((double)n);
  for (size_t i = 0; i < n; i++) cag_surface_release(made[i]);
  free(made);
  return CAG_OK;
}

// A part of a paraboloid, which makes a body with faces if nothing fails.
typedef struct Cut {
  CagSurface **pieces;
  size_t n;
} Cut;
QUESTION(quadric_body) {
  const Cut *cut = given;
  CagSolid *made;
  const CagStatus status = cag_solid_quadric_body(cut->pieces, cut->n, NULL, &made, e);
  if (status) return status;
  fault_found((double)made->face_count);
  cag_solid_release(made);
  return CAG_OK;
}
static void bodies_of_quadrics_report_faults(void **state) {
  (void)state;
  static const CagQuadric PARABOLOID = {{1, 2, 0, 0, 0, 0, 0, 0, -1, 0}};
  const CagBounds within = {{-2, -2, -1.5}, {2, 1.8, 2}};
  Cut cut;
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  OK(cag_quadric_patches(&PARABOLOID, &within, false, &cut.pieces, &cut.n, &err));
  try_faults("body", "quadric", quadric_body, &cut);
  for (size_t i = 0; i < cut.n; i++) cag_surface_release(cut.pieces[i]);
  free(cut.pieces);
  assert_int_equal(fault_problems, 0);
}

static void surfaces_of_points_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_SLOW;
  Surfaces s;
  OK(bump(&s.a, &err));
  OK(cag_surface_bilinear(cag_vec3(0, 0, 0.2), cag_vec3(0, 4, 0.2), cag_vec3(4, 0, 0.1),
                          cag_vec3(4, 4, 0.2), &s.b, &err));
  static const Question TWO[] = {ROW(where_surfaces_meet), ROW(surfaces_joined), ROW(seam),
                                 ROW(match)};
  for (int q = 0; q < 4; q++) try_faults(TWO[q].name, "two surfaces", TWO[q].ask, &s);
  cag_surface_release(s.a);
  cag_surface_release(s.b);
  fault_steps = FAULTS_OF_QUICK;
  try_faults("interpolation", "grid", surface_through_points, NULL);
  for (CagGridHold i = CAG_GRID_HOLD_NONE; i <= CAG_GRID_HOLD_X; i++)
    try_faults("fit", "grid", surface_fitted, &i);
  try_faults("hermite", "corners", surface_hermite, NULL);
  try_faults("hermite", "grid", surface_hermite_grid, NULL);
  try_faults("bezier", "triangle", surface_triangle, NULL);
  static const CagQuadric QUADRICS[] = {
      {{1, 2, 3, 0, 0, 0, 0, 0, 0, -4}},  {{1, 1, -1, 0.2, 0, 0, 0, 0, 0, -1}},
      {{1, 1, -1, 0, 0, 0, 0, 0, 0, 1}},  {{1, 2, 0, 0, 0, 0, 0, 0, -1, 0}},
      {{1, -2, 0, 0, 0, 0, 0, 0, -1, 0}}, {{1, 2, 0, 0, 0, 0, 0, 0, 0, -1}},
      {{1, 0, 0, 0, 0, 0, 0, -1, 0, 0}},  {{1, -1, 0, 0, 0, 0, 0, 0, 0, -1}},
      {{1, -1, 0, 0, 0, 0, 0, 0, 0, 0}},  {{1, 1, -1, 0, 0, 0, 0, 0, 0, 0}},
      {{0, 0, 0, 0, 0, 0, 1, 1, 1, -1}}};
  fault_steps = FAULTS_OF_SLOW;
  for (size_t i = 0; i < sizeof QUADRICS / sizeof *QUADRICS; i++)
    try_faults("patches", "quadric", quadric_in_a_box, &QUADRICS[i]);
  assert_int_equal(fault_problems, 0);
}

// --- Robots ---

static CagStatus make_arm(CagRobot **out, CagError *e) {
  CagRobotLink links[3];
  const double coupling[9] = {1, 0, 0, 0.5, 1, 0, 0, 0, 2};
  for (int i = 0; i < 3; i++) {
    links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
    links[i].a = 1 + i;
  }
  const CagRobotSpec spec = {.links = links,
                             .link_count = 3,
                             .base = cag_transform_identity(),
                             .tool = cag_transform_identity(),
                             .coupling = coupling};
  return cag_robot_new(&spec, out, e);
}
QUESTION(arm) {
  (void)given;
  CagRobot *made;
  const CagStatus status = make_arm(&made, e);
  if (!status) cag_robot_release(made);
  return status;
}
QUESTION(line_path) {
  const CagRobot *r = given;
  double q[30];
  CagTransform from, to;
  const double a[3] = {0.3, 0.5, 0.4}, b[3] = {0.5, 0.7, 0.6};
  cag_robot_forward(r, a, &from);
  cag_robot_forward(r, b, &to);
  const CagRobotWay way = {.near = a};
  const CagStatus status = cag_robot_line_path(r, &from, &to, 10, &way, q, e);
  if (!status) fault_found(q[29]);
  return status;
}
QUESTION(follow) {
  const CagRobot *r = given;
  double q[15];
  CagTransform poses[5];
  for (int i = 0; i < 5; i++) {
    const double at[3] = {0.3 + 0.05 * i, 0.5, 0.4 + 0.03 * i};
    cag_robot_forward(r, at, &poses[i]);
  }
  const CagRobotWay way = {0};
  const CagStatus status = cag_robot_follow(r, poses, 5, &way, q, e);
  if (!status) fault_found(q[14]);
  return status;
}
static void robots_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  CagRobot *r;
  try_faults("making", "arm", arm, NULL);
  OK(make_arm(&r, &err));
  try_faults("line", "arm", line_path, r);
  try_faults("poses", "arm", follow, r);
  cag_robot_release(r);
  assert_int_equal(fault_problems, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(regions_report_faults),
      cmocka_unit_test(solids_report_faults),
      cmocka_unit_test(questions_to_solids_report_faults),
      cmocka_unit_test(meshes_report_faults),
      cmocka_unit_test(bodies_of_quadrics_report_faults),
      cmocka_unit_test(surfaces_of_points_report_faults),
      cmocka_unit_test(robots_report_faults),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
