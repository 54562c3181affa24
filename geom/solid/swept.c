// Solids swept by a motion, and lofts: side faces with flat caps at open ends.

#include <math.h>
#include <stdlib.h>

#include "geom/basis/bernstein.h"
#include "geom/solid/build.h"
#include "geom/solid/csg.h"
#include "geom/surface/family.h"
#include "geom/surface/loft.h"
#include "geom/surface/reshape.h"
#include "geom/surface/trimmed.h"

static CagStatus finish(CagSolid *s, CagStatus status, CagSolid **out, CagError *err) {
  if (!status && s->face_count > 1) status = cag_solid_match_edges(s, err);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

// --- Sweeps ---

// Whether the centroid of the region moves against the normal of its plane.
static CagStatus runs_back(const CagRegion *r, const CagMotion *m, bool *out, CagError *err) {
  double start, end, area;
  bool angular;
  CagVec3 c;
  CagMotionSeries f;
  CagStatus found = cag_region_area(r, &area, &c, err);
  if (found) return found;
  cag_motion_domain(m, &start, &end, &angular);
  double along = 0;
  for (int k = 0; k <= 8 && along == 0; k++) {
    CagStatus status = cag_motion_at(m, start + (end - start) * k / 8, 1,
                                     k == 8 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &f, err);
    if (status) return status;
    CagVec3 way = cag_madd(cag_madd(f.origin[1], c.x, f.x[1]), c.y, f.y[1]);
    along = cag_dot(cag_cross(f.x[0], f.y[0]), way);
  }
  *out = along < 0;
  return CAG_OK;
}

static CagStatus check_home(const CagSolid *s, const CagMotion *m, bool *closed, CagError *err) {
  const CagCurve *path = cag_motion_path(m);
  *closed = true;
  for (size_t i = 0; i < s->face_count; i++) *closed = *closed && s->faces[i]->closed_v;
  if (*closed || !path || !path->closed) return CAG_OK;
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_sweep_not_closed, "twist", -1,
      "the path is closed, but the section does not end as it started: `twist` must end at a multiple of 360deg and `scale` at 1, or use `caps: false`");
}

CagStatus cag_solid_sweep(const CagRegion *r, const CagMotion *motion, CagSolid **out,
                          CagError *err) {
  if (cag_region_is_empty(r)) return cag_solid_empty(out, err);
  CagSolid *s;
  CagStatus status = cag_solid_block(CAG_SOLID_SWEEP, r->count + 2, &s, err);
  if (status) return status;
  bool back = false, closed = false;
  if (!cag_motion_path(motion)) status = runs_back(r, motion, &back, err);
  for (size_t i = 0; !status && i < r->count; i++) {
    CagSurface *face;
    status = cag_surface_sweep(r->loops[i], motion, &face, err);
    if (!status) status = cag_solid_add_turned(s, face, back, err);
  }
  if (!status) status = check_home(s, motion, &closed, err);
  for (int end = 0; !status && !closed && end < 2; end++) {
    // A flip reverses v.
    const CagSurface *side = s->faces[0];
    if ((end == 0) != back ? side->pole_v0 : side->pole_v1) continue;
    double start, stop;
    bool angular;
    CagTransform frame;
    cag_motion_domain(motion, &start, &stop, &angular);
    status = cag_motion_frame(motion, end == 0 ? start : stop, &frame, err);
    if (!status) status = cag_solid_add_cap(s, r, &frame, (end == 0) != back, err);
  }
  return finish(s, status, out, err);
}

CagStatus cag_solid_tube_along(const CagCurve *path, const CagAlong *radius, CagSolid **out,
                               CagError *err) {
  CagSurface *side;
  CagRegion *disk;
  CagStatus status = cag_surface_tube_along(path, radius, &side, err);
  if (status) return status;
  const CagCurve *section;
  const CagMotion *motion;
  cag_surface_swept_view(side, &section, &motion);
  status = cag_solid_disk(1, &disk, err);
  if (!status) {
    status = cag_solid_sweep(disk, motion, out, err);
    cag_region_release(disk);
  }
  cag_surface_release(side);
  return status;
}

// --- Lofts ---

// The frame of the plane in which the edge lies.
static CagStatus edge_frame(const CagSurface *side, const CagCurve *edge, double v, int which,
                            CagTransform *frame, CagError *err) {
  CagPlane own = {{0, 0, 0}, {0, 0, 1}};
  bool planar;
  const CagStatus status = cag_curve_is_planar(edge, &planar, &own, err);
  if (status) return status;
  if (!planar)
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_section_not_plane, "curves", which,
        "the %s section must lie in a plane to get a cap: flatten it, or use `caps: false`",
        v == side->v0 ? "first" : "last");
  CagVec3 n = own.normal;
  CagVec3 x = fabs(n.x) < 0.8 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  x = cag_cross(cag_cross(n, x), n);
  return cag_axes(own.point, x, cag_cross(n, x), frame, err);
}

// The edge at v as a plane curve in the frame, with the parameter of the side face.
static CagStatus flat_edge(const CagSurface *side, double v, int which, CagRegion **out,
                           CagTransform *frame, CagError *err) {
  const CagCurve *end;
  CagCurve *edge = NULL, *flat = NULL;
  CagTransform into;
  CagStatus status = CAG_OK;
  if (cag_surface_across_end(side, v == side->v0, &end)) edge = cag_curve_retain(end);
  else status = cag_surface_isocurve(side, 1, v, &edge, err);
  if (!status) status = edge_frame(side, edge, v, which, frame, err);
  if (!status) status = cag_transform_inverse(frame, &into, err);
  if (!status) status = cag_curve_transform(edge, &into, &flat, err);
  if (!status) {
    cag_curve_lay_flat(flat);
    status = cag_region_new(flat, NULL, 0, out, err);
  }
  cag_curve_release(flat);
  cag_curve_release(edge);
  return status;
}

// The cap at an end, oriented so that its normal points along (or against) the direction of the
// sections.
static CagStatus add_loft_cap(CagSolid *s, const CagSurface *side, bool first, CagVec3 way,
                              CagError *err) {
  CagRegion *region;
  CagTransform frame;
  CagStatus status =
      flat_edge(side, first ? side->v0 : side->v1, first ? 0 : -1, &region, &frame, err);
  if (status) return status;
  CagVec3 normal = cag_vec3(frame.m[0][2], frame.m[1][2], frame.m[2][2]);
  bool ahead = cag_dot(normal, way) > 0;
  status = cag_solid_add_cap(s, region, &frame, ahead == first, err);
  cag_region_release(region);
  return status;
}

// Mean direction in which the section's points move with v at an end.
static CagStatus way_at(const CagSurface *side, double v, CagVec3 *out, CagError *err) {
  CagVec3 sum = {0, 0, 0};
  enum { STEPS = 16 };
  for (int i = 0; i < STEPS; i++) {
    CagVec3 d[4];
    double u = side->u0 + (side->u1 - side->u0) * i / STEPS;
    CagStatus status = cag_surface_eval(side, u, v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    sum = cag_add(sum, d[cag_partial(1, 0, 1)]);
  }
  *out = sum;
  return CAG_OK;
}

// Whether S_u x S_v points outward: the sections are counter-clockwise about the direction of v.
static CagStatus faces_outward(const CagSurface *side, bool *out, CagError *err) {
  if (side->closed_v) {
    double terms[10] = {0};
    CagStatus status = cag_surface_volume_terms(side, terms, err);
    *out = terms[0] >= 0;
    return status;
  }
  enum { STEPS = 64 };
  CagVec3 area = {0, 0, 0}, way = {0, 0, 0}, first = {0, 0, 0}, before = {0, 0, 0};
  double v = (side->v0 + side->v1) / 2;
  for (int i = 0; i < STEPS; i++) {
    CagVec3 d[4];
    double u = side->u0 + (side->u1 - side->u0) * i / STEPS;
    CagStatus status = cag_surface_eval(side, u, v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    if (i == 0) first = d[0];
    CagVec3 here = cag_sub(d[0], first);
    area = cag_add(area, cag_cross(before, here));
    way = cag_add(way, d[cag_partial(1, 0, 1)]);
    before = here;
  }
  *out = cag_dot(area, way) >= 0;
  return CAG_OK;
}

static CagStatus loft_faces(const CagSurface *side, bool flip, CagSolid **out, CagError *err) {
  CagSolid *s;
  CagStatus status = cag_solid_block(CAG_SOLID_LOFT, 3, &s, err);
  if (status) return status;
  status = cag_solid_add_turned(s, cag_surface_retain(side), flip, err);
  if (!status && !side->closed_v) {
    CagVec3 way;
    if (!side->pole_v0) {
      status = way_at(side, side->v0, &way, err);
      if (!status) status = add_loft_cap(s, side, true, way, err);
    }
    if (!status && !side->pole_v1) {
      status = way_at(side, side->v1, &way, err);
      if (!status) status = add_loft_cap(s, side, false, way, err);
    }
  }
  return finish(s, status, out, err);
}

CagStatus cag_solid_loft(const CagSurface *side, CagSolid **out, CagError *err) {
  if (!side->closed_u)
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_section_open, "curves", -1,
        "the sections must be closed to bound a solid; to make a surface, use `caps: false`");
  bool outward;
  CagStatus status = faces_outward(side, &outward, err);
  return status ? status : loft_faces(side, !outward, out, err);
}

const CagSurface *cag_solid_side(const CagSolid *s) {
  if (s->kind != CAG_SOLID_EXTRUSION && s->kind != CAG_SOLID_REVOLUTION &&
      s->kind != CAG_SOLID_TUBE && s->kind != CAG_SOLID_SWEEP && s->kind != CAG_SOLID_LOFT)
    return NULL;
  const CagSurface *side = NULL;
  for (size_t i = 0; i < s->face_count; i++) {
    if (cag_surface_planar_view(s->faces[i], NULL, NULL)) continue;
    if (side) return NULL;
    side = s->faces[i];
  }
  return side;
}

// --- Plates ---

static CagStatus plate_edge(const CagSurface *s, const CagSurface *over, int side, CagSurface **out,
                            CagError *err) {
  CagCurve *below = NULL, *above = NULL;
  int direction = side < 2 ? 0 : 1;
  double at = side == 0 ? s->u0 : side == 1 ? s->u1 : side == 2 ? s->v0 : s->v1;
  CagStatus status = cag_surface_isocurve(s, direction, at, &below, err);
  if (!status) status = cag_surface_isocurve(over, direction, at, &above, err);
  if (!status) status = cag_surface_ruled(above, below, out, err);
  cag_curve_release(below);
  cag_curve_release(above);
  return status;
}

CagStatus cag_solid_thicken(const CagSurface *s, double d, CagSolid **out, CagError *err) {
  if (cag_surface_trimmed_view(s, NULL, NULL))
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_trimmed_face, "", -1,
                    "a surface that is trimmed by curves cannot be thickened; trim it by ranges");
  if (cag_surface_planar_view(s, NULL, NULL))
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_not_nurbs, "surface", -1,
                    "to make a plate of a region, use `extrude`");
  CagSurface *faces[6];
  size_t n = 0;
  CagStatus status = cag_surface_offset(s, d, &faces[0], err);
  if (status) return status;
  n = 1;
  const bool open[4] = {!s->closed_u && !s->pole_u0, !s->closed_u && !s->pole_u1,
                        !s->closed_v && !s->pole_v0, !s->closed_v && !s->pole_v1};
  status = cag_surface_flip(s, &faces[n], err);
  if (!status) n++;
  for (int side = 0; !status && side < 4; side++) {
    if (!open[side]) continue;
    status = plate_edge(s, faces[0], side, &faces[n], err);
    if (!status) n++;
  }
  CagSolid *made = NULL;
  if (!status && n > 2) status = cag_solid_shell(faces, n, out, err);
  if (!status && n == 2) {
    // Closed: a hollow solid whose two faces have no edges.
    status = cag_solid_block(CAG_SOLID_SHELL, 2, &made, err);
    for (int k = 0; !status && k < 2; k++) {
      CagSurface *face = cag_surface_retain(faces[k]);
      if (d > 0) cag_solid_add(made, face);
      else status = cag_solid_add_turned(made, face, true, err);
    }
    if (status) cag_solid_release(made);
    else *out = made;
  }
  while (n > 0) cag_surface_release(faces[--n]);
  return status;
}
