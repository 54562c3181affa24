// Half spaces and quadrics as closed meshes: the part of a form's negative side that a window may
// need.
//
// The solid is built from exact surfaces in the form's canonical frame, over ranges that contain
// the window with a margin, so that its closing faces lie outside of the window. Each class has one
// simple solid (inside the cylinder, between the planes, ...). If the form is positive there, the
// result is the complement in the window.

#include <math.h>
#include <stdlib.h>

#include "geom/curve/conic.h"
#include "geom/solid/build.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"

// Distance of the closing faces from the window, as a fraction of its size.
#define ROOM 0.0625

// Corners of a box are numbered with x, y, z as bits; faces are counter-clockwise from outside.
static const uint32_t BOX_TRIANGLES[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                           2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

CagStatus cag_box_mesh(const CagBounds *box, CagMesh **out, CagError *err) {
  CagMesh *m = NULL;
  CagStatus status = cag_mesh_new(8, 12, false, false, false, &m, err);
  if (status) return status;
  for (int k = 0; k < 8; k++)
    m->positions[k] = cag_vec3(k & 1 ? box->max.x : box->min.x, k & 2 ? box->max.y : box->min.y,
                               k & 4 ? box->max.z : box->min.z);
  for (int k = 0; k < 36; k++) m->triangles[k] = BOX_TRIANGLES[k];
  *out = m;
  return CAG_OK;
}

static CagStatus empty_mesh(CagMesh **out, CagError *err) {
  return cag_mesh_new(0, 0, false, false, false, out, err);
}

// --- Solids in the canonical frame ---

// The extent of a solid: canonical coordinates that contain the window.
typedef struct Range {
  CagVec3 lo, hi;
} Range;

// The distance of the window from the ends of the range is at least twice this: anything that ends
// within it lies outside of the window.
static double clearance(const Range *r) {
  return 0.5 * ROOM / (1 + 2 * ROOM) * (r->hi.x - r->lo.x);
}

typedef struct Bodies {
  CagSolid *s[2];
  size_t n;
} Bodies;

static CagTransform canonical(const CagQuadricForm *f, double a, double b, double c, double lift) {
  CagTransform t = f->frame;
  t.planar = false;
  for (int i = 0; i < 3; i++) {
    t.m[i][3] += lift * t.m[i][2];
    t.m[i][0] *= a;
    t.m[i][1] *= b;
    t.m[i][2] *= c;
  }
  return t;
}

// Takes ownership of the solid.
static CagStatus add_placed(Bodies *out, CagSolid *standing, const CagTransform *t, CagError *err) {
  CagStatus status = cag_solid_transform(standing, t, &out->s[out->n], err);
  cag_solid_release(standing);
  if (!status) out->n++;
  return status;
}

// An ellipse with these semi-axes at a height in the canonical frame.
static CagStatus elliptic_cap(const CagQuadricForm *f, double a, double b, double z,
                              CagSurface **out, CagError *err) {
  CagTransform plane = cag_transform_identity(), frame = canonical(f, 1, 1, 1, z);
  CagCurve *edge = NULL;
  CagRegion *disk = NULL;
  CagStatus status = cag_curve_arc(a, b, 0, 2 * M_PI, &plane, &edge, err);
  if (!status) status = cag_region_new(edge, NULL, 0, &disk, err);
  if (!status) status = cag_surface_planar(disk, &frame, out, err);
  cag_curve_release(edge);
  cag_region_release(disk);
  return status;
}

// A patch about the axis over [v0, v1] closed by flat caps; `half[i]`: semi-axes of the ellipse at
// each end relative to those of the form, 0 if the end is a point.
static CagStatus add_turned(Bodies *out, const CagQuadricForm *f, CagQuadricShape shape,
                            const CagTransform *frame, const double v[2], const double half[2],
                            const double z[2], CagError *err) {
  CagSurface *faces[3] = {NULL};
  CagSolid *s = NULL;
  size_t n = 1;
  CagStatus status = cag_surface_quadric(shape, frame, 0, 2 * M_PI, v[0], v[1], &faces[0], err);
  for (int i = 0; !status && i < 2; i++) {
    if (!(half[i] > 0)) continue;
    status = elliptic_cap(f, half[i] * f->semi[0], half[i] * f->semi[1], z[i], &faces[n], err);
    if (!status) n++;
  }
  if (!status) status = cag_solid_shell(faces, n, &s, err);
  for (size_t i = 0; i < n; i++) cag_surface_release(faces[i]);
  if (!status) out->s[out->n++] = s;
  return status;
}

static CagStatus hyperboloid_one(Bodies *out, const CagQuadricForm *f, const Range *r,
                                 CagError *err) {
  double c = f->semi[2];
  const double z[2] = {r->lo.z, r->hi.z}, v[2] = {asinh(z[0] / c), asinh(z[1] / c)};
  const double half[2] = {cosh(v[0]), cosh(v[1])};
  CagTransform frame = canonical(f, f->semi[0], f->semi[1], c, 0);
  return add_turned(out, f, CAG_SHAPE_HYPERBOLOID_ONE, &frame, v, half, z, err);
}

static CagStatus hyperboloid_two(Bodies *out, const CagQuadricForm *f, const Range *r,
                                 CagError *err) {
  double c = f->semi[2];
  CagStatus status = CAG_OK;
  for (int sheet = 0; !status && sheet < 2; sheet++) {
    double far = sheet ? -r->lo.z : r->hi.z;
    if (!(far > c + clearance(r))) continue;
    const double v[2] = {0, acosh(far / c)}, half[2] = {0, sinh(v[1])};
    const double z[2] = {0, sheet ? -far : far};
    CagTransform frame = canonical(f, f->semi[0], f->semi[1], sheet ? -c : c, 0);
    status = add_turned(out, f, CAG_SHAPE_HYPERBOLOID_TWO, &frame, v, half, z, err);
  }
  return status;
}

static CagStatus cones(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  CagStatus status = CAG_OK;
  for (int nappe = 0; !status && nappe < 2; nappe++) {
    double far = (nappe ? -r->lo.z : r->hi.z) / f->semi[2];
    if (!(far > 0)) continue;
    // Upside down: the apex at the origin.
    CagTransform t = canonical(f, f->semi[0], f->semi[1], nappe ? f->semi[2] : -f->semi[2],
                               (nappe ? -far : far) * f->semi[2]);
    CagSolid *cone;
    status = cag_solid_cylinder(far, far, 0, &cone, err);
    if (!status) status = add_placed(out, cone, &t, err);
  }
  return status;
}

static CagStatus paraboloid(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  if (!(r->hi.z > 0)) return CAG_OK;
  const double z[2] = {0, r->hi.z}, v[2] = {0, sqrt(z[1])}, half[2] = {0, v[1]};
  CagTransform frame = canonical(f, f->semi[0], f->semi[1], 1, 0);
  return add_turned(out, f, CAG_SHAPE_ELLIPTIC_PARABOLOID, &frame, v, half, z, err);
}

static CagStatus cylinder(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  CagSolid *s;
  CagTransform t = canonical(f, f->semi[0], f->semi[1], 1, r->lo.z);
  CagStatus status = cag_solid_cylinder(r->hi.z - r->lo.z, 1, 1, &s, err);
  return status ? status : add_placed(out, s, &t, err);
}

static CagStatus ellipsoid(Bodies *out, const CagQuadricForm *f, CagError *err) {
  CagSolid *s;
  CagTransform t = canonical(f, f->semi[0], f->semi[1], f->semi[2], 0);
  CagStatus status = cag_solid_sphere(1, &s, err);
  return status ? status : add_placed(out, s, &t, err);
}

// The part of the plane enclosed by connected curves, extruded along z over the range.
static CagStatus add_column(Bodies *out, const CagQuadricForm *f, CagCurve *const *sides, size_t n,
                            const CagTransform *place, const Range *r, CagError *err) {
  CagCurve *edge = NULL;
  CagRegion *region = NULL;
  CagSolid *s = NULL;
  CagTransform t = canonical(f, 1, 1, 1, r->lo.z);
  if (place) t = cag_transform_multiply(&t, place);
  CagStatus status = n > 1 ? cag_curve_join(sides, n, &edge, err) : CAG_OK;
  if (!status) status = cag_region_new(n > 1 ? edge : sides[0], NULL, 0, &region, err);
  if (!status) status = cag_solid_extrude(region, cag_vec3(0, 0, r->hi.z - r->lo.z), 0, 1, &s, err);
  cag_curve_release(edge);
  cag_region_release(region);
  return status ? status : add_placed(out, s, &t, err);
}

static double farther(double a, double b) { return fmax(fabs(a), fabs(b)); }

// Inside the parabola Y^2 = 4 a X: its arc as a Bezier curve, and the chord.
static CagStatus parabolic(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  if (!(r->hi.x > 0)) return CAG_OK;
  double x = r->hi.x, y = 2 * sqrt(f->semi[0] * x);
  const CagVec3 arc[3] = {{x, -y, 0}, {-x, 0, 0}, {x, y, 0}}, chord[2] = {{x, y, 0}, {x, -y, 0}};
  CagCurve *sides[2] = {NULL};
  CagStatus status = cag_curve_bezier(arc, NULL, 3, 2, &sides[0], err);
  if (!status) status = cag_curve_polyline(chord, 2, false, 2, &sides[1], err);
  if (!status) status = add_column(out, f, sides, 2, NULL, r, err);
  cag_curve_release(sides[0]);
  cag_curve_release(sides[1]);
  return status;
}

// Inside the branches of X^2/a^2 - Y^2/b^2 = 1: an arc as a rational Bezier curve whose middle
// control point is the intersection of the end tangents.
static CagStatus hyperbolic(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  double a = f->semi[0], b = f->semi[1];
  CagStatus status = CAG_OK;
  for (int branch = 0; !status && branch < 2; branch++) {
    double far = branch ? -r->lo.x : r->hi.x;
    if (!(far > a + clearance(r))) continue;
    double t = acosh(far / a), x = far, y = b * sinh(t);
    const CagVec3 arc[3] = {{x, -y, 0}, {a / cosh(t), 0, 0}, {x, y, 0}};
    const CagVec3 chord[2] = {{x, y, 0}, {x, -y, 0}};
    const double weights[3] = {1, cosh(t), 1};
    CagTransform mirror = cag_transform_identity();
    CagCurve *sides[2] = {NULL};
    if (branch) mirror.m[0][0] = -1;
    status = cag_curve_bezier(arc, weights, 3, 2, &sides[0], err);
    if (!status) status = cag_curve_polyline(chord, 2, false, 2, &sides[1], err);
    if (!status) status = add_column(out, f, sides, 2, branch ? &mirror : NULL, r, err);
    cag_curve_release(sides[0]);
    cag_curve_release(sides[1]);
  }
  return status;
}

static CagStatus add_polygon(Bodies *out, const CagQuadricForm *f, const CagVec3 *p, size_t n,
                             const Range *r, CagError *err) {
  CagCurve *edge;
  CagStatus status = cag_curve_polyline(p, n, true, 2, &edge, err);
  if (status) return status;
  status = add_column(out, f, &edge, 1, NULL, r, err);
  cag_curve_release(edge);
  return status;
}

// |X / a| < |Y / b|: two wedges with a common edge.
static CagStatus wedges(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  double a = f->semi[0], b = f->semi[1];
  // Large enough that the far side of each triangle is beyond the range.
  double k = 2 * farther(r->lo.y, r->hi.y) / b;
  CagStatus status = CAG_OK;
  for (int side = 0; !status && side < 2; side++) {
    double s = side ? -k : k;
    const CagVec3 p[3] = {{0, 0, 0}, {s * a, s * b, 0}, {-s * a, s * b, 0}};
    status = add_polygon(out, f, p, 3, r, err);
  }
  return status;
}

static CagStatus slab(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  double a = f->semi[0];
  const CagVec3 p[4] = {{-a, r->lo.y, 0}, {a, r->lo.y, 0}, {a, r->hi.y, 0}, {-a, r->hi.y, 0}};
  return add_polygon(out, f, p, 4, r, err);
}

// A side of the saddle's column: between an edge of the saddle, which is a parabola in a vertical
// plane, and the floor below it. The patches have four sides, so that they share whole edges.
static CagStatus column_side(const CagTransform *frame, const CagVec3 arc[3], double floor,
                             CagSurface **out, CagError *err) {
  const CagVec3 foot[2] = {{arc[0].x, arc[0].y, floor}, {arc[2].x, arc[2].y, floor}};
  CagCurve *roof = NULL, *base = NULL;
  CagSurface *standing = NULL;
  CagStatus status = cag_curve_bezier(arc, NULL, 3, 3, &roof, err);
  if (!status) status = cag_curve_bezier(foot, NULL, 2, 3, &base, err);
  if (!status) status = cag_surface_ruled(roof, base, &standing, err);
  if (!status) status = cag_surface_transform(standing, frame, out, err);
  cag_curve_release(roof);
  cag_curve_release(base);
  cag_surface_release(standing);
  return status;
}

// The solid below the saddle Z = X^2/a^2 - Y^2/b^2, where the form is positive.
static CagStatus saddle(Bodies *out, const CagQuadricForm *f, const Range *r, CagError *err) {
  double a = f->semi[0], b = f->semi[1];
  double x = farther(r->lo.x, r->hi.x), y = farther(r->lo.y, r->hi.y);
  double rise = x * x / (a * a), dip = y * y / (b * b), end = rise - dip;
  double floor = fmin(r->lo.z, -dip) - ROOM * (x + y + dip);
  CagSurface *faces[6] = {NULL};
  CagSolid *s = NULL;
  const CagTransform frame = canonical(f, a, b, 1, 0), place = canonical(f, 1, 1, 1, 0);
  CagStatus status = cag_surface_quadric(CAG_SHAPE_HYPERBOLIC_PARABOLOID, &frame, -x / a, x / a,
                                         -y / b, y / b, &faces[0], err);
  // The middle control point of the parabola h(t) = e + t^2/c^2 over [-t, t] lies at e - t^2/c^2.
  for (int side = 0; !status && side < 2; side++) {
    double at_x = side ? x : -x, at_y = side ? y : -y;
    const CagVec3 by_x[3] = {{-x, at_y, end}, {0, at_y, -dip - rise}, {x, at_y, end}};
    const CagVec3 by_y[3] = {{at_x, -y, end}, {at_x, 0, rise + dip}, {at_x, y, end}};
    status = column_side(&place, by_x, floor, &faces[1 + side], err);
    if (!status) status = column_side(&place, by_y, floor, &faces[3 + side], err);
  }
  if (!status)
    status = cag_surface_parallelogram(cag_transform_point(&place, cag_vec3(-x, -y, floor)),
                                       cag_transform_vector(&place, cag_vec3(2 * x, 0, 0)),
                                       cag_transform_vector(&place, cag_vec3(0, 2 * y, 0)),
                                       &faces[5], err);
  if (!status) status = cag_solid_shell(faces, 6, &s, err);
  for (int i = 0; i < 6; i++) cag_surface_release(faces[i]);
  if (!status) out->s[out->n++] = s;
  return status;
}

// The solid of a class; `inside`: a point in it, in canonical coordinates.
static CagStatus body_of(const CagQuadricForm *f, const Range *r, Bodies *out, CagVec3 *inside,
                         CagError *err) {
  *inside = cag_vec3(0, 0, 0);
  switch (f->class_id) {
  case CAG_QUADRIC_ELLIPSOID: return ellipsoid(out, f, err);
  case CAG_QUADRIC_HYPERBOLOID_ONE: return hyperboloid_one(out, f, r, err);
  case CAG_QUADRIC_HYPERBOLOID_TWO:
    inside->z = 2 * f->semi[2];
    return hyperboloid_two(out, f, r, err);
  case CAG_QUADRIC_CONE: inside->z = f->semi[2]; return cones(out, f, r, err);
  case CAG_QUADRIC_ELLIPTIC_PARABOLOID: inside->z = 1; return paraboloid(out, f, r, err);
  case CAG_QUADRIC_HYPERBOLIC_PARABOLOID: inside->z = -1; return saddle(out, f, r, err);
  case CAG_QUADRIC_ELLIPTIC_CYLINDER: return cylinder(out, f, r, err);
  case CAG_QUADRIC_HYPERBOLIC_CYLINDER:
    inside->x = 2 * f->semi[0];
    return hyperbolic(out, f, r, err);
  case CAG_QUADRIC_PARABOLIC_CYLINDER: inside->x = f->semi[0]; return parabolic(out, f, r, err);
  case CAG_QUADRIC_INTERSECTING_PLANES: inside->y = f->semi[1]; return wedges(out, f, r, err);
  case CAG_QUADRIC_PARALLEL_PLANES: return slab(out, f, r, err);
  default:
    // No solid: everywhere except on a plane, line, or point, the sign is the same.
    inside->x = 1;
    return CAG_OK;
  }
}

// Whether the class has no surface that separates space, so that one point decides for all.
static bool has_one_side(CagQuadricClass c) {
  switch (c) {
  case CAG_QUADRIC_IMAGINARY_ELLIPSOID:
  case CAG_QUADRIC_IMAGINARY_CONE:
  case CAG_QUADRIC_IMAGINARY_ELLIPTIC_CYLINDER:
  case CAG_QUADRIC_IMAGINARY_INTERSECTING_PLANES:
  case CAG_QUADRIC_IMAGINARY_PARALLEL_PLANES:
  case CAG_QUADRIC_COINCIDENT_PLANES:
  case CAG_QUADRIC_EMPTY: return true;
  default: return false;
  }
}

// --- Meshes ---

static CagBounds enlarged(const CagBounds *b, double by) {
  return (CagBounds){cag_sub(b->min, cag_vec3(by, by, by)), cag_add(b->max, cag_vec3(by, by, by))};
}

static CagStatus mesh_bodies(const Bodies *b, const CagTessellation *how, CagMesh **out,
                             CagError *err) {
  CagMesh *m[2] = {NULL};
  CagStatus status = CAG_OK;
  if (b->n == 0) return empty_mesh(out, err);
  for (size_t i = 0; !status && i < b->n; i++)
    status = cag_solid_tessellate(b->s[i], how, &m[i], err);
  if (!status && b->n == 1) *out = cag_mesh_retain(m[0]);
  else if (!status) status = cag_mesh_append(m, b->n, out, err);
  for (size_t i = 0; i < b->n; i++) cag_mesh_release(m[i]);
  return status;
}

// The complement of the mesh in the window; takes ownership of the mesh.
static CagStatus complement(CagMesh *m, const CagBounds *box, const CagTessellation *how,
                            CagMesh **out, CagError *err) {
  CagMesh *all = NULL;
  CagStatus status = cag_box_mesh(box, &all, err);
  if (!status && m->triangle_count == 0) *out = cag_mesh_retain(all);
  else if (!status) status = cag_mesh_boolean(CAG_DIFFERENCE, all, m, how->interrupt, out, err);
  cag_mesh_release(m);
  cag_mesh_release(all);
  return status;
}

static CagStatus range_of(const CagQuadricForm *f, const CagBounds *window, Range *out,
                          CagError *err) {
  CagTransform back;
  CagStatus status = cag_transform_inverse(&f->frame, &back, err);
  if (status) return status;
  double reach = (0.5 + ROOM) * cag_norm(cag_sub(window->max, window->min));
  CagVec3 middle = cag_transform_point(&back, cag_lerp(window->min, window->max, 0.5));
  CagVec3 most = cag_vec3(reach, reach, reach);
  *out = (Range){cag_sub(middle, most), cag_add(middle, most)};
  return CAG_OK;
}

// A half space: a box whose top face lies in the plane, above the projection of the window. The
// corners are computed only once, however far away the plane is.
static CagStatus plane_mesh(const CagQuadric *q, const CagBounds *window, CagMesh **out,
                            CagError *err) {
  double length = cag_norm(cag_vec3(q->c[6], q->c[7], q->c[8]));
  CagVec3 n = cag_scaled(cag_vec3(q->c[6], q->c[7], q->c[8]), 1 / length);
  CagVec3 middle = cag_lerp(window->min, window->max, 0.5);
  double reach = (0.5 + ROOM) * cag_norm(cag_sub(window->max, window->min));
  double above = cag_quadric_value(q, middle) / length;
  const CagBounds box = enlarged(window, reach);
  if (above >= reach) return empty_mesh(out, err);
  if (above <= -reach) return cag_box_mesh(&box, out, err);
  CagVec3 side = fabs(n.z) < 0.5 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
  CagVec3 x = cag_unit(cag_cross(side, n)), y = cag_cross(n, x);
  CagVec3 foot = cag_madd(middle, -above, n);
  CagStatus status = cag_box_mesh(&box, out, err);
  for (int k = 0; !status && k < 8; k++) {
    CagVec3 p = cag_madd(foot, k & 1 ? reach : -reach, x);
    p = cag_madd(p, k & 2 ? reach : -reach, y);
    (*out)->positions[k] = k & 4 ? p : cag_madd(p, -2 * reach, n);
  }
  return status;
}

CagStatus cag_side_mesh(const CagQuadric *form, const CagBounds *window, const CagTessellation *how,
                        CagMesh **out, CagError *err) {
  CagQuadricForm f;
  Range range;
  Bodies bodies = {{NULL}, 0};
  CagVec3 inside;
  CagMesh *m = NULL;
  double size = cag_norm(cag_sub(window->max, window->min));
  const CagBounds box = enlarged(window, ROOM * size);
  CagStatus status = cag_quadric_classify(form, &f, err);
  if (!status && f.class_id == CAG_QUADRIC_PLANE) return plane_mesh(form, window, out, err);
  if (!status) status = range_of(&f, window, &range, err);
  if (!status) status = body_of(&f, &range, &bodies, &inside, err);
  bool within = !status && cag_quadric_value(form, cag_transform_point(&f.frame, inside)) < 0;
  if (!status && has_one_side(f.class_id))
    status = within ? cag_box_mesh(&box, out, err) : empty_mesh(out, err);
  else if (!status) status = mesh_bodies(&bodies, how, &m, err);
  if (!status && m) status = within ? (*out = m, CAG_OK) : complement(m, &box, how, out, err);
  for (size_t i = 0; i < bodies.n; i++) cag_solid_release(bodies.s[i]);
  return status;
}
