// Solids as fields of messages (see put_solid.h).

#include "interp/kernel/put_solid.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/curve/region.h"
#include "geom/curve/strip.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/solid/form.h"
#include "geom/surface/approximate.h"
#include "geom/surface/quadric.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"
#include "interp/kernel/protocol.h"
#include "interp/kernel/put_curve.h"

// Gaps between faces that are sewn together, as a fraction of the solid's size. Shells of surfaces
// allow as much.
#define SEWING 1e-6
// How far half spaces are cut off, as a multiple of the size of everything that they meet.
#define FAR 4.0
// The kinds of faces in messages.
enum { SPLINE_FACE, FLAT_FACE, ROUND_FACE };

static CagStatus memory_of(const CagFields *f, CagError *err) {
  return f->failed ? cag_fail_memory(err) : CAG_OK;
}

static CagStatus exact_surface(CagFields *f, const CagSurface *s, CagSurface **out, CagError *err) {
  const CagSurface *inner = s;
  CagTransform map;
  const CagStatus status = cag_surface_to_nurbs(s, out, err);
  if (!cag_no_exact_form(status)) return status;
  cag_surface_placed_view(s, &inner, &map);
  if (!(f->tolerance > 0)) return cag_fail_inexact(inner->kind->name, err);
  f->approximate = true;
  return cag_surface_approximate(s, f->tolerance, out, err);
}

// --- Regions ---

static void put_direction(CagFields *f, const CagTransform *t, int column) {
  cag_put_f64(f, t->m[0][column]);
  cag_put_f64(f, t->m[1][column]);
}

// Whether the arc's axes are orthonormal.
static bool is_plain_frame(const CagTransform *t) {
  const CagVec3 x = cag_vec3(t->m[0][0], t->m[1][0], 0), y = cag_vec3(t->m[0][1], t->m[1][1], 0);
  return fabs(cag_norm(x) - 1) <= CAG_ROUNDING && fabs(cag_norm(y) - 1) <= CAG_ROUNDING &&
         fabs(cag_dot(x, y)) <= CAG_ROUNDING;
}

static bool put_arc(CagFields *f, const CagCurve *c) {
  double a, b;
  CagTransform t;
  if (!cag_curve_arc_view(c, &a, &b, &t) || !is_plain_frame(&t) || !(a > 0) || !(b > 0))
    return false;
  cag_put_u32(f, a == b ? CAG_BREP_CIRCLE : CAG_BREP_ELLIPSE);
  put_direction(f, &t, 3);
  put_direction(f, &t, 0);
  put_direction(f, &t, 1);
  cag_put_f64(f, a);
  if (a != b) cag_put_f64(f, b);
  cag_put_f64(f, c->start);
  cag_put_f64(f, c->end);
  return true;
}

static void put_segment(CagFields *f, CagVec3 p, CagVec3 q) {
  cag_put_u32(f, CAG_BREP_LINE);
  cag_put_plane_point(f, p);
  cag_put_plane_point(f, cag_unit(cag_sub(q, p)));
  cag_put_f64(f, 0);
  cag_put_f64(f, cag_norm(cag_sub(q, p)));
}

// Part of a circle that is known by its center: the angles follow from its ends.
static void put_round(CagFields *f, const CagStripPart *p) {
  const CagVec3 a = cag_sub(p->ends[0], p->center), b = cag_sub(p->ends[1], p->center);
  const CagVec3 x = cag_unit(a), y = cag_scaled(cag_vec3(-x.y, x.x, 0), p->sense);
  double turn = atan2(cag_dot(y, b), cag_dot(x, b));
  if (turn <= CAG_ROUNDING) turn += 2 * M_PI;
  cag_put_u32(f, CAG_BREP_CIRCLE);
  cag_put_plane_point(f, p->center);
  cag_put_plane_point(f, x);
  cag_put_plane_point(f, y);
  cag_put_f64(f, p->radius);
  cag_put_f64(f, 0);
  cag_put_f64(f, turn);
}

static CagStatus put_spline(CagFields *f, const CagCurve *c, CagError *err) {
  CagCurve *exact, *clamped;
  CagNurbsView v = {0};
  CagStatus status = cag_exact_curve(f, c, &exact, err);
  if (status) return status;
  status = cag_curve_clamp(exact, &clamped, err);
  cag_curve_release(exact);
  if (status) return status;
  cag_curve_nurbs_view(clamped, &v);
  cag_put_u32(f, CAG_BREP_SPLINE_CURVE);
  cag_put_u32(f, (size_t)v.degree);
  cag_put_u32(f, v.rational);
  cag_put_u32(f, v.count);
  for (size_t i = 0; i < v.count; i++) {
    const double *h = v.homogeneous + 4 * i;
    cag_put_f64(f, h[0] / h[3]);
    cag_put_f64(f, h[1] / h[3]);
    if (v.rational) cag_put_f64(f, h[3]);
  }
  for (size_t i = 0; i < v.count + (size_t)v.degree + 1; i++) cag_put_f64(f, v.knots[i]);
  cag_put_f64(f, clamped->start);
  cag_put_f64(f, clamped->end);
  cag_curve_release(clamped);
  return CAG_OK;
}

static CagStatus put_part(CagFields *f, const CagStripPart *p, CagError *err) {
  if (p->straight) put_segment(f, p->ends[0], p->ends[1]);
  else if (put_arc(f, p->curve)) return CAG_OK;
  else if (p->round) put_round(f, p);
  else return put_spline(f, p->curve, err);
  return CAG_OK;
}

static CagStatus put_loop(CagFields *f, const CagCurve *c, CagError *err) {
  CagStripParts parts = {0};
  CagStatus status = cag_strip_parts_add(&parts, c, 0, err);
  if (!status) cag_put_u32(f, parts.n);
  for (size_t i = 0; !status && i < parts.n; i++) status = put_part(f, &parts.items[i], err);
  cag_strip_parts_free(&parts);
  return status;
}

static CagStatus put_region(CagFields *f, const CagRegion *r, CagError *err) {
  CagStatus status = CAG_OK;
  cag_put_u32(f, r->count);
  for (size_t i = 0; !status && i < r->count; i++) status = put_loop(f, r->loops[i], err);
  return status;
}

// --- Solids with faces ---

static CagStatus put_net(CagFields *f, const CagSurface *s, CagError *err) {
  CagSurface *exact, *clamped;
  CagSurfaceNurbsView v = {0};
  CagStatus status = exact_surface(f, s, &exact, err);
  if (status) return status;
  status = cag_surface_nurbs_part(exact, exact->u0, exact->u1, exact->v0, exact->v1, &clamped, err);
  cag_surface_release(exact);
  if (status) return status;
  cag_surface_nurbs_view(clamped, &v);
  const size_t words[] = {
      CAG_BREP_SPLINE, (size_t)v.degree_u, (size_t)v.degree_v, v.rational, v.nu, v.nv};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) cag_put_u32(f, words[i]);
  for (size_t i = 0; i < v.nu * v.nv; i++) {
    const double *h = v.homogeneous + 4 * i;
    cag_put_vec(f, cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]));
    if (v.rational) cag_put_f64(f, h[3]);
  }
  for (size_t i = 0; i < v.nu + (size_t)v.degree_u + 1; i++) cag_put_f64(f, v.knots_u[i]);
  for (size_t i = 0; i < v.nv + (size_t)v.degree_v + 1; i++) cag_put_f64(f, v.knots_v[i]);
  cag_surface_release(clamped);
  return CAG_OK;
}

static CagStatus put_flat(CagFields *f, const CagRegion *r, const CagTransform *t, CagError *err) {
  CagTransform frame, map;
  CagRegion *own;
  CagStatus status = cag_flat_frame(t, &frame, &map, err);
  if (!status) status = cag_region_transform(r, &map, &own, err);
  if (status) return status;
  cag_put_frame(f, &frame);
  status = put_region(f, own, err);
  cag_region_release(own);
  return status;
}

// A parallelogram as a part of a plane.
static CagStatus put_parallelogram(CagFields *f, CagVec3 origin, CagVec3 x, CagVec3 y,
                                   CagError *err) {
  CagTransform frame;
  CagStatus status = cag_axes(origin, x, y, &frame, err);
  if (status) return status;
  const CagVec3 along = cag_vec3(cag_norm(x), 0, 0);
  const CagVec3 across =
      cag_vec3(cag_dot(y, cag_frame_column(&frame, 0)), cag_dot(y, cag_frame_column(&frame, 1)), 0);
  const CagVec3 corners[4] = {cag_vec3(0, 0, 0), along, cag_add(along, across), across};
  cag_put_u32(f, FLAT_FACE);
  cag_put_frame(f, &frame);
  cag_put_u32(f, 1);
  cag_put_u32(f, 4);
  for (int i = 0; i < 4; i++) put_segment(f, corners[i], corners[(i + 1) % 4]);
  return CAG_OK;
}

// Whether the axes of a quadric's frame are perpendicular, and the first two of them equal.
static bool is_round_frame(const CagTransform *t, double lengths[3]) {
  CagVec3 axes[3];
  bool good = true;
  for (int i = 0; i < 3; i++) {
    axes[i] = cag_frame_column(t, i);
    lengths[i] = cag_norm(axes[i]);
    good = good && lengths[i] > 0;
  }
  for (int i = 0; i < 3; i++) {
    const int next = (i + 1) % 3;
    good = good && fabs(cag_dot(axes[i], axes[next])) <= CAG_ROUNDING * lengths[i] * lengths[next];
  }
  return good && fabs(lengths[0] - lengths[1]) <= CAG_ROUNDING * lengths[0];
}

// Adds a piece of a cylinder, a cone, or a ball as such. Frames become right-handed, which may
// reverse u. *done: it is one.
static CagStatus put_round_patch(CagFields *f, const CagSurface *s, bool *done, CagError *err) {
  CagQuadricShape shape;
  CagTransform t, frame;
  double r[3];
  *done = false;
  if (!cag_surface_quadric_shape(s, &shape) || !cag_surface_quadric_frame(s, &t) ||
      !is_round_frame(&t, r))
    return CAG_OK;
  const bool ball = shape == CAG_SHAPE_ELLIPSOID && fabs(r[2] - r[0]) <= CAG_ROUNDING * r[0];
  const bool cone = shape == CAG_SHAPE_CONE && s->v0 >= 0;
  if (!ball && !cone && shape != CAG_SHAPE_ELLIPTIC_CYLINDER) return CAG_OK;
  const CagVec3 z = cag_frame_column(&t, 2), x = cag_frame_column(&t, 0),
                y = cag_frame_column(&t, 1);
  CagStatus status = cag_axes(cag_frame_column(&t, 3), x, cag_cross(z, x), &frame, err);
  if (status) return status;
  const bool mirrored = cag_dot(cag_cross(x, y), z) < 0;
  const double stretch = cone ? hypot(r[0], r[2]) : r[2];
  cag_put_u32(f, ROUND_FACE);
  cag_put_u32(f, ball ? CAG_BREP_SPHERICAL : cone ? CAG_BREP_CONICAL : CAG_BREP_CYLINDRICAL);
  cag_put_frame(f, &frame);
  cag_put_f64(f, cone ? 0 : r[0]);
  if (cone) cag_put_f64(f, atan2(r[0], r[2]));
  cag_put_f64(f, mirrored ? -s->u1 : s->u0);
  cag_put_f64(f, mirrored ? -s->u0 : s->u1);
  // The angle of a ball is measured from its pole, but from its equator in the message.
  cag_put_f64(f, ball ? M_PI / 2 - s->v1 : s->v0 * stretch);
  cag_put_f64(f, ball ? M_PI / 2 - s->v0 : s->v1 * stretch);
  *done = true;
  return CAG_OK;
}

static CagStatus put_face(CagFields *f, const CagSurface *s, CagError *err) {
  const CagRegion *region;
  CagTransform t;
  CagVec3 origin, x, y;
  bool done;
  if (cag_surface_trimmed_view(s, NULL, NULL))
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "", -1,
                    "a trimmed face cannot be joined with the others");
  if (cag_surface_planar_view(s, &region, &t)) {
    cag_put_u32(f, FLAT_FACE);
    return put_flat(f, region, &t, err);
  }
  if (cag_surface_parallelogram_view(s, &origin, &x, &y))
    return put_parallelogram(f, origin, x, y, err);
  CagStatus status = put_round_patch(f, s, &done, err);
  if (status || done) return status;
  cag_put_u32(f, SPLINE_FACE);
  return put_net(f, s, err);
}

static CagStatus put_faces(CagFields *f, const CagSolid *s, CagError *err) {
  CagBounds box;
  CagStatus status = cag_solid_bounds(s, &box, err);
  cag_put_u32(f, CAG_BREP_FACES);
  cag_put_u32(f, s->face_count);
  for (size_t i = 0; !status && i < s->face_count; i++) status = put_face(f, s->faces[i], err);
  // Two sides that were approximated separately may differ by twice the tolerance.
  if (!status)
    cag_put_f64(f, fmax(SEWING * cag_norm(cag_sub(box.max, box.min)),
                        f->approximate ? 2 * f->tolerance : 0));
  const CagTransform here = cag_transform_identity();
  if (!status) cag_put_placement(f, &here);
  return status;
}

// Put as what it is, so that its sides become planes and cylinders. *done: it is a prism.
static CagStatus put_prism(CagFields *f, const CagSolid *s, bool *done, CagError *err) {
  const CagRegion *region = NULL;
  CagRegion *own;
  CagTransform t, frame, map;
  CagVec3 along = {0, 0, 0};
  *done = s->kind == CAG_SOLID_EXTRUSION && cag_prism_of(s, &region, &t, &along);
  if (!*done) return CAG_OK;
  CagStatus status = cag_flat_frame(&t, &frame, &map, err);
  if (!status) status = cag_region_transform(region, &map, &own, err);
  if (status) return status;
  cag_put_u32(f, CAG_BREP_PRISM);
  status = put_region(f, own, err);
  cag_region_release(own);
  cag_put_vec(f, cag_vec3(cag_dot(along, cag_frame_column(&frame, 0)),
                          cag_dot(along, cag_frame_column(&frame, 1)),
                          cag_dot(along, cag_frame_column(&frame, 2))));
  cag_put_placement(f, &frame);
  return status;
}

// --- Revolutions ---

// Adds a loop of the profile, which is closed along the axis if it ends there. *fits: it is closed.
static CagStatus put_profile(CagFields *f, const CagCurve *c, double size, bool *fits,
                             CagError *err) {
  CagStripParts parts = {0};
  CagVec3 a, b;
  CagStatus status = cag_curve_point(c, c->start, &a, err);
  if (!status) status = cag_curve_point(c, c->end, &b, err);
  if (!status) status = cag_strip_parts_add(&parts, c, 0, err);
  if (status) return status;
  const bool closed = cag_norm(cag_sub(a, b)) <= CAG_COINCIDENT * size;
  *fits = closed || (fabs(a.x) <= CAG_COINCIDENT * size && fabs(b.x) <= CAG_COINCIDENT * size);
  cag_put_u32(f, parts.n + !closed);
  for (size_t i = 0; !status && i < parts.n; i++) status = put_part(f, &parts.items[i], err);
  if (!closed) put_segment(f, b, a);
  cag_strip_parts_free(&parts);
  return status;
}

// *done: the solid is a revolution whose loops are known. Otherwise, nothing is added.
static CagStatus put_revolution(CagFields *f, const CagSolid *s, bool *done, CagError *err) {
  CagTurnedForm turn;
  CagBounds box;
  size_t sides;
  *done = s->kind == CAG_SOLID_REVOLUTION && cag_turn_of_solid(s, &turn, &sides);
  if (!*done) return CAG_OK;
  const size_t before = f->length;
  CagStatus status = cag_solid_bounds(s, &box, err);
  cag_put_u32(f, CAG_BREP_REVOLUTION);
  cag_put_u32(f, sides);
  for (size_t i = 0; !status && *done && i < s->face_count; i++) {
    const CagCurve *profile;
    CagCurve *plane = NULL;
    CagTurnedForm own;
    if (!cag_turn_of_face(s->faces[i], &profile, &own)) continue;
    status = cag_turn_profile(profile, &own, &plane, err);
    if (!status) status = put_profile(f, plane, cag_norm(cag_sub(box.max, box.min)), done, err);
    // Pieces between parts of the axis would have to be joined.
    if (!status && !plane->closed) *done = *done && sides == 1;
    cag_curve_release(plane);
  }
  if (!*done) f->length = before;
  if (status || !*done) return status;
  cag_put_f64(f, turn.from);
  cag_put_f64(f, turn.to);
  cag_put_placement(f, &turn.frame);
  return CAG_OK;
}

// --- Primitives ---

// A rotation that maps a round primitive to itself, in its own coordinates. A sphere is turned such
// that a pole lies towards the other parts, or its seam away from them; others about z.
static CagTransform turn_in_place(const CagFields *f, const CagSolid *s, const CagBounds *window) {
  CagTransform back, turned = cag_transform_identity();
  CagError ignored;
  if (f->turn == 0 || s->kind == CAG_SOLID_BOX) return turned;
  const double z = 1.1 * f->turn; // radians; unlikely to meet the directions of other parts again
  if (s->kind != CAG_SOLID_SPHERE) return cag_rpy(0, 0, z);
  if (cag_transform_inverse(&s->placement, &back, &ignored)) return turned;
  const CagVec3 there = cag_transform_point(&back, cag_lerp(window->min, window->max, 0.5));
  const CagVec3 away = cag_scaled(there, -1), aside = cag_cross(there, cag_vec3(0.3, 0.5, 0.8));
  const CagVec3 other = cag_cross(there, aside);
  // The frame's x, y: the seam lies towards x, and the poles towards z.
  const bool by_seam = f->turn == 1;
  if (cag_axes(cag_vec3(0, 0, 0),
               by_seam        ? away
               : f->turn == 2 ? aside
                              : other,
               by_seam        ? aside
               : f->turn == 2 ? other
                              : away,
               &turned, &ignored))
    return cag_rpy(0.83, 0.47, z);
  return turned;
}

static CagStatus put_primitive(CagFields *f, const CagSolid *s, const CagBounds *window, bool *done,
                               CagError *err) {
  CagTransform t = s->placement;
  *done = true;
  switch (s->kind) {
  case CAG_SOLID_BOX:
    cag_put_u32(f, CAG_BREP_BOX);
    cag_put_vec(f, cag_vec3(s->a, s->b, s->c));
    if (s->centered) {
      const CagTransform half = cag_translate(cag_vec3(-s->a / 2, -s->b / 2, -s->c / 2));
      t = cag_transform_multiply(&t, &half);
    }
    break;
  case CAG_SOLID_SPHERE:
    cag_put_u32(f, CAG_BREP_SPHERE);
    cag_put_f64(f, s->a);
    break;
  case CAG_SOLID_CYLINDER:
    cag_put_u32(f, CAG_BREP_CYLINDER);
    cag_put_f64(f, s->a);
    cag_put_f64(f, s->b);
    cag_put_f64(f, s->c);
    break;
  case CAG_SOLID_TORUS:
    cag_put_u32(f, CAG_BREP_TORUS);
    cag_put_f64(f, s->a);
    cag_put_f64(f, s->b);
    break;
  default: *done = false; return CAG_OK;
  }
  const CagTransform turn = turn_in_place(f, s, window);
  t = cag_transform_multiply(&t, &turn);
  cag_put_placement(f, &t);
  return memory_of(f, err);
}

// --- Exact solids ---

void cag_put_body(CagFields *f, const CagBoundary *part, const CagTransform *placement) {
  cag_put_u32(f, CAG_BREP_BODY);
  cag_put_u32(f, part->body_length);
  cag_put_bytes(f, part->body, part->body_length);
  cag_put_placement(f, placement);
}

// Several parts are a union of separate bodies.
static CagStatus put_exact(CagFields *f, const CagSolid *s, CagError *err) {
  const CagTransform here = cag_transform_identity();
  size_t n = 0;
  const CagBoundary *parts = cag_solid_boundaries(s, &n);
  if (n > 1) {
    cag_put_u32(f, CAG_BREP_UNION);
    cag_put_u32(f, n);
  }
  for (size_t i = 0; i < n; i++) cag_put_body(f, &parts[i], &s->placement);
  if (n > 1) cag_put_placement(f, &here);
  return memory_of(f, err);
}

// --- Set operations ---

static CagStatus put_any(CagFields *f, const CagSolid *s, const CagBounds *window, CagError *err);

static CagStatus put_half_space(CagFields *f, const CagSolid *s, const CagBounds *window,
                                CagError *err) {
  CagQuadric form;
  CagTransform frame;
  if (!cag_solid_form(s, &form))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                    "a half space has no plane");
  const CagVec3 n = cag_vec3(form.c[6], form.c[7], form.c[8]);
  const CagVec3 middle = cag_lerp(window->min, window->max, 0.5);
  const double square = cag_dot(n, n), off = (cag_dot(n, middle) + form.c[9]) / square;
  const CagVec3 foot = cag_madd(middle, -off, n);
  const CagVec3 other = fabs(n.x) < 0.5 * sqrt(square) ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  const CagVec3 x = cag_cross(other, n);
  CagStatus status = cag_axes(foot, x, cag_cross(n, x), &frame, err);
  if (status) return status;
  cag_put_u32(f, CAG_BREP_HALF_SPACE);
  cag_put_f64(f, FAR * (cag_norm(cag_sub(window->max, window->min)) + fabs(off) * sqrt(square)));
  cag_put_placement(f, &frame);
  return CAG_OK;
}

static CagStatus put_operation(CagFields *f, const CagSolid *s, const CagBounds *window,
                               CagError *err) {
  const CagTransform *t = &s->placement;
  CagTransform back;
  CagStatus status = cag_transform_inverse(t, &back, err);
  if (status) return status;
  CagBounds own = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 8; k++)
    cag_bounds_add(&own,
                   cag_transform_point(&back, cag_vec3(k & 1 ? window->max.x : window->min.x,
                                                       k & 2 ? window->max.y : window->min.y,
                                                       k & 4 ? window->max.z : window->min.z)));
  cag_put_u32(f, s->kind == CAG_SOLID_UNION        ? CAG_BREP_UNION
                 : s->kind == CAG_SOLID_DIFFERENCE ? CAG_BREP_DIFFERENCE
                                                   : CAG_BREP_INTERSECTION);
  cag_put_u32(f, s->core->count);
  for (size_t i = 0; !status && i < s->core->count; i++) {
    status = put_any(f, s->core->operands[i], &own, err);
    if (!status) status = cag_stop_check(err);
  }
  cag_put_placement(f, t);
  return status;
}

static CagStatus put_any(CagFields *f, const CagSolid *s, const CagBounds *window, CagError *err) {
  bool done;
  CagStatus status = put_primitive(f, s, window, &done, err);
  if (!status && !done) status = put_prism(f, s, &done, err);
  if (!status && !done) status = put_revolution(f, s, &done, err);
  if (status || done) return status;
  if (s->kind == CAG_SOLID_MESH)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "", -1,
                    "a mesh consists of triangles and has no exact faces");
  if (s->kind == CAG_SOLID_EXACT) return put_exact(f, s, err);
  if (s->face_count > 0) return put_faces(f, s, err);
  if (s->kind == CAG_SOLID_HALF_SPACE) return put_half_space(f, s, window, err);
  if (s->kind == CAG_SOLID_QUADRIC)
    return cag_fail(
        err, CAG_E_UNSUPPORTED, CAG_ERR_no_boundary, "", -1,
        "an unbounded quadric has no faces: give `quadric` the box that bounds it (`within`)");
  return put_operation(f, s, window, err);
}

CagStatus cag_put_solid(CagFields *f, const CagSolid *s, CagError *err) {
  CagBounds box;
  CagStatus status = cag_solid_bounds(s, &box, err);
  return status ? status : cag_put_solid_within(f, s, &box, err);
}

CagStatus cag_put_solid_within(CagFields *f, const CagSolid *s, const CagBounds *window,
                               CagError *err) {
  const CagStatus status = put_any(f, s, window, err);
  return status ? status : memory_of(f, err);
}
