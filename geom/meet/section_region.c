// The section of a set operation is found from the sections of its operands: cutting by a plane and
// set operations commute. Half spaces count as the part of them that the solid can reach.

#include "geom/meet/section_region.h"

#include "base/memory.h"
#include "base/stop.h"
#include "geom/meet/section.h"
#include "geom/solid/csg.h"
#include "geom/surface/quadric_equation.h"

// A half space is cut to this multiple of the size of the solid's bounds, so that its artificial
// edges lie outside.
#define BEYOND 4

typedef struct Cut {
  CagTransform frame;
  CagPlane plane;
  double tolerance;
  CagVec3 middle; // of the bounds of the whole solid, in the frame
  double reach;   // half the side of a square around `middle` that contains the section
  const CagTessellation *how;
} Cut;

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

// The region inside of closed curves in the plane.
static CagStatus region_of_curves(const Cut *c, const CagCurveList *curves, CagRegion **out,
                                  CagError *err) {
  CagCurve **flat = cag_calloc(curves->count + 1, sizeof *flat);
  if (!flat) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < curves->count; i++)
    status = cag_curve_flatten(curves->items[i], &c->frame, &flat[i], err);
  if (!status)
    status = curves->count == 0 ? cag_region_empty(out, err)
                                : cag_region_from_loops(flat, curves->count, out, err);
  for (size_t i = 0; i < curves->count; i++) cag_curve_release(flat[i]);
  cag_free(flat);
  return status;
}

static CagStatus leaf_region(const Cut *c, const CagSolid *s, CagRegion **out, CagError *err) {
  CagCurveList curves = {0};
  CagStatus status = cag_solid_section(s, &c->plane, c->tolerance, &curves, err);
  if (status && cag_is_empty_shape(err)) status = CAG_OK;
  if (!status) status = region_of_curves(c, &curves, out, err);
  cag_curve_list_free(&curves);
  return status;
}

// The solid known by its mesh, to the tolerance of that.
static CagStatus mesh_region(const Cut *c, const CagSolid *s, CagRegion **out, CagError *err) {
  CagCurveList curves = {0};
  CagMesh *mesh = NULL;
  CagStatus status = cag_solid_tessellate(s, c->how, &mesh, err);
  if (!status) status = cag_mesh_section(mesh, &c->plane, &curves, err);
  if (!status) status = region_of_curves(c, &curves, out, err);
  cag_curve_list_free(&curves);
  cag_mesh_release(mesh);
  return status;
}

// The part of a half plane a x + b y + k < 0 within the square, as a rectangle along its edge. A
// half space parallel to the plane is everything or nothing.
static CagStatus half_plane(const Cut *c, const CagQuadric *form, CagRegion **out, CagError *err) {
  const double *n = form->c + 6;
  const CagVec3 normal = cag_vec3(n[0], n[1], n[2]), origin = column(&c->frame, 3);
  const double size = cag_norm(normal), a = cag_dot(normal, column(&c->frame, 0)) / size,
               b = cag_dot(normal, column(&c->frame, 1)) / size;
  const double k = (cag_dot(normal, origin) + n[3]) / size, slope = hypot(a, b);
  const double r = BEYOND * c->reach, parallel = 1e-12; // rounding of a unit vector
  if (slope <= parallel) {
    // On the plane itself, what counts is what lies below it.
    const bool below = cag_dot(normal, c->plane.normal) > 0;
    if (k > 0 || (k == 0 && !below)) return cag_region_empty(out, err);
  }
  const CagVec3 out_of = slope <= parallel ? cag_vec3(1, 0, 0) : cag_vec3(a / slope, b / slope, 0);
  const CagVec3 along = cag_vec3(-out_of.y, out_of.x, 0);
  const double at = slope <= parallel ? r : -(k + a * c->middle.x + b * c->middle.y) / slope;
  if (at <= -r) return cag_region_empty(out, err);
  const CagVec3 edge = cag_madd(c->middle, fmin(at, r), out_of),
                far = cag_madd(c->middle, -r, out_of);
  const CagVec3 corners[4] = {cag_madd(far, r, along), cag_madd(far, -r, along),
                              cag_madd(edge, -r, along), cag_madd(edge, r, along)};
  CagCurve *outline = NULL;
  CagStatus status = cag_curve_polyline(corners, 4, true, 2, &outline, err);
  if (!status) status = cag_region_new(outline, NULL, 0, out, err);
  cag_curve_release(outline);
  return status;
}

static CagStatus exact_region(const Cut *c, const CagSolid *s, CagRegion **out, CagError *err);

static CagStatus placed_region(const Cut *c, const CagSolid *operand, const CagTransform *placement,
                               CagRegion **out, CagError *err) {
  CagSolid *placed = NULL;
  CagStatus status = cag_solid_transform(operand, placement, &placed, err);
  if (!status) status = exact_region(c, placed, out, err);
  cag_solid_release(placed);
  return status;
}

static CagStatus operation_region(const Cut *c, const CagSolid *s, CagRegion **out, CagError *err) {
  const CagRegionOp op = s->kind == CAG_SOLID_UNION        ? CAG_REGION_UNION
                         : s->kind == CAG_SOLID_DIFFERENCE ? CAG_REGION_DIFFERENCE
                                                           : CAG_REGION_INTERSECTION;
  const size_t n = s->core->count;
  if (n == 0) return cag_region_empty(out, err);
  CagRegion **parts = cag_calloc(n, sizeof *parts);
  if (!parts) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    status = placed_region(c, s->core->operands[i], &s->placement, &parts[i], err);
    if (!status) status = cag_stop_check(err);
  }
  if (!status) status = cag_region_combine(op, (const CagRegion *const *)parts, n, out, err);
  for (size_t i = 0; i < n; i++) cag_region_release(parts[i]);
  cag_free(parts);
  return status;
}

static CagStatus exact_region(const Cut *c, const CagSolid *s, CagRegion **out, CagError *err) {
  CagQuadric form;
  if (s->face_count > 0) return leaf_region(c, s, out, err); // also the body of a quadric
  switch (s->kind) {
  case CAG_SOLID_UNION:
  case CAG_SOLID_DIFFERENCE:
  case CAG_SOLID_INTERSECTION: return operation_region(c, s, out, err);
  case CAG_SOLID_HALF_SPACE:
    if (cag_solid_form(s, &form)) return half_plane(c, &form, out, err);
    break;
  case CAG_SOLID_QUADRIC: break; // its section may be unbounded
  default: return leaf_region(c, s, out, err);
  }
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_solid_unbounded, "", -1, "it is unbounded");
}

CagStatus cag_solid_section_region(const CagSolid *s, const CagTransform *frame, double tolerance,
                                   const CagTessellation *how, CagRegion **out, CagError *err) {
  CagBounds box;
  Cut c = {.frame = *frame,
           .plane = {column(frame, 3), column(frame, 2)},
           .tolerance = tolerance,
           .how = how};
  CagStatus status = cag_solid_bounds(s, &box, err);
  if (status) return status;
  const CagVec3 half = cag_scaled(cag_sub(box.max, box.min), 0.5),
                offset = cag_sub(cag_lerp(box.min, box.max, 0.5), c.plane.point);
  c.middle = cag_vec3(cag_dot(offset, column(frame, 0)), cag_dot(offset, column(frame, 1)), 0);
  c.reach = cag_norm(half);
  status = exact_region(&c, s, out, err);
  if (!status || cag_is_final(status)) return status;
  return mesh_region(&c, s, out, err);
}
