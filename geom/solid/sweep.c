// Solids swept from regions: extrusions, revolutions, and tubes.
//
// Each loop of the region sweeps one side face (a loop that lies partly on the axis of a revolution
// sweeps one for each piece off the axis), and the region itself forms flat caps at the ends. Loops
// run counter-clockwise around the material, holes clockwise, so all side faces are oriented
// outward in the same way.

#include <math.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/build.h"
#include "geom/solid/csg.h"

// A point closer to the axis than this fraction of the region's size lies on it.
#define ON_AXIS CAG_COINCIDENT

// --- Extrusion ---

CagStatus cag_solid_extrude(const CagRegion *r, CagVec3 v, double twist, double scale,
                            CagSolid **out, CagError *err) {
  if (v.z == 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_degenerate_direction, "height", -1,
                    "`height` must not be 0 or lie in the plane of the region");
  if (cag_region_is_empty(r)) return cag_solid_empty(out, err);
  CagSolid *s;
  CagStatus status = cag_solid_block(CAG_SOLID_EXTRUSION, r->count + 2, &s, err);
  if (status) return status;
  bool down = v.z < 0;
  for (size_t i = 0; !status && i < r->count; i++) {
    CagSurface *face;
    status = cag_surface_extrude(r->loops[i], v, twist, scale, &face, err);
    if (!status) status = cag_solid_add_turned(s, face, down, err);
  }
  CagTransform foot = cag_transform_identity(), top = cag_translate(v);
  top.planar = foot.planar = false;
  double sine, cosine;
  cag_sincos(twist, &sine, &cosine);
  top.m[0][0] = top.m[1][1] = scale * cosine;
  top.m[1][0] = scale * sine;
  top.m[0][1] = -scale * sine;
  if (!status) status = cag_solid_add_cap(s, r, &foot, !down, err);
  if (!status && scale > 0) status = cag_solid_add_cap(s, r, &top, down, err);
  if (!status) status = cag_solid_match_edges(s, err);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

// --- Revolution ---

// The position of the region's plane relative to the axis: columns of `plane` are the images of x
// and y, and the radius of a region point p is sense * (cross . p - offset).
typedef struct Setting {
  CagTransform plane;
  CagVec3 axis, through; // unit axis
  CagVec3 cross;         // in region coordinates: unit, perpendicular to the axis
  double offset, size;
  double sense; // +1 or -1: on which side of the axis the region lies
} Setting;

static CagStatus set_plane(CagVec3 axis, CagVec3 through, Setting *out, CagError *err) {
  CagVec3 w = cag_unit(axis);
  if (!(cag_norm(w) > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_axis, "axis", -1,
                    "`axis` must not be the zero vector: give a direction such as Z");
  out->axis = w;
  out->through = through;
  out->plane = cag_transform_identity();
  out->plane.planar = false;
  bool upright = fabs(w.x) + fabs(w.y) <= ON_AXIS;
  double off = upright ? through.y : fabs(w.z) + fabs(through.z);
  if (fabs(off) > ON_AXIS * (1 + cag_norm(through)))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_axis_not_in_plane, "axis", -1,
        "`axis` must lie in the plane of the region, which is y = 0 for an axis along Z, otherwise z = 0; for a skew axis, revolve the boundary as a surface");
  double a, b; // the axis in region coordinates
  if (upright) {
    // [x, y] means [x, 0, y].
    out->plane.m[1][1] = out->plane.m[2][2] = 0;
    out->plane.m[2][1] = 1;
    out->plane.m[1][2] = -1;
    a = 0;
    b = w.z;
    out->through = cag_vec3(through.x, 0, through.z);
  } else {
    a = w.x;
    b = w.y;
  }
  out->cross = cag_vec3(b, -a, 0);
  CagVec3 flat = upright ? cag_vec3(through.x, through.z, 0) : through;
  out->offset = cag_dot(out->cross, flat);
  return CAG_OK;
}

static double height_over_axis(const Setting *g, CagVec3 p) {
  return cag_dot(g->cross, p) - g->offset;
}

// The region must lie on one side of the axis. Bounds in a frame aligned with the axis are exact.
static CagStatus check_side(const CagRegion *r, Setting *g, CagError *err) {
  CagTransform turn = cag_transform_identity(); // x: over the axis, y: along it
  turn.m[0][0] = g->cross.x;
  turn.m[0][1] = g->cross.y;
  turn.m[1][0] = -g->cross.y;
  turn.m[1][1] = g->cross.x;
  turn.m[0][3] = -g->offset;
  CagRegion *turned;
  CagStatus status = cag_region_transform(r, &turn, &turned, err);
  CagBounds box;
  if (status) return status;
  status = cag_region_bounds(turned, &box, err);
  cag_region_release(turned);
  if (status) return status;
  g->size = cag_norm(cag_sub(box.max, box.min));
  double slack = ON_AXIS * g->size;
  g->sense = box.max.x > -box.min.x ? 1 : -1;
  double beyond = g->sense > 0 ? -box.min.x : box.max.x;
  char text[32];
  if (beyond > slack)
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_region_crosses_axis, "region", -1,
        "the region must lie on one side of the axis: it reaches %s beyond it; move it, or cut it along the axis",
        cag_number_text(beyond, text));
  return CAG_OK;
}

static CagStatus on_axis(const Setting *g, const CagCurve *c, double a, double b, bool *out,
                         CagError *err) {
  *out = true;
  for (int i = 0; *out && i <= 6; i++) {
    CagVec3 p;
    CagStatus status = cag_curve_point(c, i == 6 ? b : a + (b - a) * i / 6, &p, err);
    if (status) return status;
    *out = fabs(height_over_axis(g, p)) <= ON_AXIS * g->size;
  }
  return CAG_OK;
}

// A side face from the part [a, b] of a loop.
static CagStatus add_side(CagSolid *s, const Setting *g, const CagCurve *loop, double a, double b,
                          double from, double to, CagError *err) {
  CagCurve *part = NULL, *space = NULL, *placed = NULL, *run = NULL;
  CagSurface *face;
  CagStatus status = CAG_OK;
  if (a == loop->start && b == loop->end) part = cag_curve_retain(loop);
  else status = cag_curve_trim(loop, a, b, &part, err);
  // Convert the curve to a space curve before placing it, because a planar map would keep it in the
  // plane.
  CagTransform lift = cag_transform_identity();
  lift.planar = false;
  if (!status) status = cag_curve_transform(part, &lift, &space, err);
  if (!status) status = cag_curve_transform(space, &g->plane, &placed, err);
  // S_u x S_v = T x (w x r) points outward if w x (the direction away from the axis) is the
  // region's normal.
  bool backwards = g->sense > 0;
  if (!status && backwards) status = cag_curve_reverse(placed, &run, err);
  if (!status)
    status =
        cag_surface_revolve(backwards ? run : placed, g->axis, g->through, from, to, &face, err);
  if (!status) cag_solid_add(s, face);
  cag_curve_release(part);
  cag_curve_release(space);
  cag_curve_release(placed);
  cag_curve_release(run);
  return status;
}

// Range of one loop's faces among the faces of the solid.
typedef struct Sides {
  size_t first, count;
  bool on_axis; // a part of the loop lies on the axis
} Sides;

static CagStatus add_loop(CagSolid *s, const Setting *g, const CagCurve *loop, double from,
                          double to, Sides *out, CagError *err) {
  size_t inner = loop->kind->breaks ? loop->kind->breaks(loop, NULL, 0) : 0;
  double *ends = cag_malloc((inner + 2) * sizeof *ends);
  if (!ends) return cag_fail_memory(err);
  ends[0] = loop->start;
  if (inner > 0) loop->kind->breaks(loop, ends + 1, inner);
  ends[inner + 1] = loop->end;
  *out = (Sides){s->face_count, 0, false};
  CagStatus status = CAG_OK;
  // Groups of consecutive pieces between those on the axis.
  size_t start = 0;
  for (size_t i = 0; !status && i <= inner; i++) {
    bool lies;
    status = on_axis(g, loop, ends[i], ends[i + 1], &lies, err);
    if (status || !lies) continue;
    out->on_axis = true;
    if (start < i) status = add_side(s, g, loop, ends[start], ends[i], from, to, err);
    start = i + 1;
  }
  if (!status && start <= inner)
    status = add_side(s, g, loop, ends[start], ends[inner + 1], from, to, err);
  out->count = s->face_count - out->first;
  cag_free(ends);
  return status;
}

// The frame of a cap: the region's plane rotated by the angle.
static CagStatus turned_plane(const Setting *g, double angle, CagTransform *out, CagError *err) {
  CagTransform turn;
  CagStatus status = cag_rotate(g->axis, angle, g->through, &turn, err);
  if (!status) *out = cag_transform_multiply(&turn, &g->plane);
  return status;
}

static size_t most_faces(const CagRegion *r) {
  size_t n = 2;
  for (size_t i = 0; i < r->count; i++) {
    const CagCurve *c = r->loops[i];
    n += 1 + (c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0);
  }
  return n;
}

// Edges of partial revolutions: the sides v0 and v1 of each face lie along the loops of the caps,
// in order; a part of a loop on the axis joins the two caps. One cap is flipped, which reverses its
// loops, so that the first always runs against the faces and the second with them.
static CagStatus cap_edges(CagSolid *s, const Sides *sides, size_t loops, size_t caps,
                           CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t l = 0; !status && l < loops; l++) {
    int side = 4 + (int)l;
    for (size_t k = 0; !status && k < sides[l].count; k++) {
      size_t face = sides[l].first + k;
      status = cag_solid_add_edge(s, face, 2, caps, side, true, err);
      if (!status) status = cag_solid_add_edge(s, face, 3, caps + 1, side, false, err);
    }
    if (!status && sides[l].on_axis)
      status = cag_solid_add_edge(s, caps, side, caps + 1, side, true, err);
  }
  return status;
}

CagStatus cag_solid_revolve(const CagRegion *r, CagVec3 axis, CagVec3 through, double from,
                            double to, CagSolid **out, CagError *err) {
  Setting g;
  if (cag_region_is_empty(r)) return cag_solid_empty(out, err);
  CagStatus status = set_plane(axis, through, &g, err);
  if (!status) status = check_side(r, &g, err);
  CagSolid *s = NULL;
  Sides *sides = NULL;
  if (!status) {
    sides = cag_malloc(r->count * sizeof *sides);
    if (!sides) status = cag_fail_memory(err);
  }
  if (!status) status = cag_solid_block(CAG_SOLID_REVOLUTION, most_faces(r), &s, err);
  // A revolution of more than a full turn would overlap itself.
  bool full = to - from >= 2 * M_PI * (1 - 1e-12);
  if (!status && to - from > 2 * M_PI * (1 + 1e-12)) {
    char text[32];
    status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_self_intersection, "angle", -1,
                      "`angle` of a solid must span at most 360deg, found %sdeg",
                      cag_number_text((to - from) * (180 / M_PI), text));
  }
  for (size_t i = 0; !status && i < r->count; i++)
    status = add_loop(s, &g, r->loops[i], from, to, &sides[i], err);
  // Faces of one loop meet in circles if a group ends in the middle of the loop.
  if (!status) status = cag_solid_match_edges(s, err);
  if (!status && !full) {
    size_t caps = s->face_count;
    CagTransform frame;
    // The material moves along w x r: the first cap faces backward, the second forward.
    bool ahead = g.sense < 0; // whether the region's normal points in the direction of motion
    status = turned_plane(&g, from, &frame, err);
    if (!status) status = cag_solid_add_cap(s, r, &frame, ahead, err);
    if (!status) status = turned_plane(&g, to, &frame, err);
    if (!status) status = cag_solid_add_cap(s, r, &frame, !ahead, err);
    if (!status) status = cap_edges(s, sides, r->count, caps, err);
  }
  cag_free(sides);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

// --- Tube ---

static CagStatus add_tube_cap(CagSolid *s, const CagSurface *side, const CagCurve *path,
                              double radius, bool first, CagError *err) {
  double v = first ? side->v0 : side->v1;
  CagVec3 center, x, y;
  CagStatus status = cag_curve_point(path, v, &center, err);
  if (!status) status = cag_surface_point(side, 0, v, &x, err);
  if (!status) status = cag_surface_point(side, M_PI / 2, v, &y, err);
  CagTransform frame;
  if (!status) status = cag_axes(center, cag_sub(x, center), cag_sub(y, center), &frame, err);
  CagRegion *disk = NULL;
  if (!status) status = cag_solid_disk(radius, &disk, err);
  if (!status) status = cag_solid_add_cap(s, disk, &frame, first, err);
  cag_region_release(disk);
  return status;
}

CagStatus cag_solid_tube(const CagCurve *path, double radius, CagSolid **out, CagError *err) {
  CagSurface *side;
  CagStatus status = cag_surface_tube(path, radius, &side, err);
  if (status) return status;
  CagSolid *s;
  status = cag_solid_block(CAG_SOLID_TUBE, 3, &s, err);
  if (status) {
    cag_surface_release(side);
    return status;
  }
  s->a = radius;
  cag_solid_add(s, side);
  if (!side->closed_v) {
    status = add_tube_cap(s, side, path, radius, true, err);
    if (!status) status = add_tube_cap(s, side, path, radius, false, err);
    if (!status) status = cag_solid_match_edges(s, err);
  }
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}
