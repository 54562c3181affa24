// The primitives: box, sphere, cylinder (including cones), torus. Faces are exact quadrics and
// planes.

#include <math.h>
#include <stdlib.h>

#include "geom/solid/build.h"

static CagStatus finish(CagSolid *s, CagStatus status, CagSolid **out, CagError *err) {
  if (!status) status = cag_solid_match_edges(s, err);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

static double entry(CagVec3 v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

static CagVec3 with_entries(int i, double a, int j, double b, int k, double c) {
  double e[3];
  e[i] = a;
  e[j] = b;
  e[k] = c;
  return cag_vec3(e[0], e[1], e[2]);
}

// Faces of a box are numbered 2 * axis, plus 1 on the high side. u x v points outward: u and v are
// the next two axes in cyclic order, exchanged on the low side.
static int face_u(int f) { return (f / 2 + 1 + (f % 2 == 0)) % 3; }
static int face_v(int f) { return (f / 2 + 1 + f % 2) % 3; }

// A side of a face lies at an end of one axis; the face at that end has the same edge on its side
// towards the first face. Both run in the direction of the third axis.
static CagStatus box_edges(CagSolid *s, CagError *err) {
  CagStatus status = CAG_OK;
  for (int f = 0; !status && f < 6; f++)
    for (int side = 0; !status && side < 4; side++) {
      int g = 2 * (side < 2 ? face_u(f) : face_v(f)) + side % 2;
      int back = (face_u(g) == f / 2 ? 0 : 2) + f % 2;
      if (f < g) status = cag_solid_add_edge(s, (size_t)f, side, (size_t)g, back, false, err);
    }
  return status;
}

CagStatus cag_solid_box(CagVec3 size, bool centered, CagSolid **out, CagError *err) {
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 3; i++)
    status = cag_solid_check_size(entry(size, i), "size", i, err);
  CagSolid *s;
  if (!status) status = cag_solid_block(CAG_SOLID_BOX, 6, &s, err);
  if (status) return status;
  s->a = size.x;
  s->b = size.y;
  s->c = size.z;
  s->centered = centered;
  CagVec3 lo = centered ? cag_scaled(size, -0.5) : cag_vec3(0, 0, 0);
  CagVec3 hi = centered ? cag_scaled(size, 0.5) : size;
  for (int f = 0; !status && f < 6; f++) {
    int axis = f / 2, u = face_u(f), v = face_v(f);
    double at = entry(f % 2 ? hi : lo, axis);
    const CagVec3 origin = with_entries(axis, at, u, entry(lo, u), v, entry(lo, v));
    const CagVec3 x = with_entries(axis, 0, u, entry(size, u), v, 0);
    const CagVec3 y = with_entries(axis, 0, u, 0, v, entry(size, v));
    CagSurface *face;
    status = cag_surface_parallelogram(origin, x, y, &face, err);
    if (!status) cag_solid_add(s, face);
  }
  if (!status) status = box_edges(s, err);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

static CagTransform diagonal(double x, double y, double z, double lift) {
  CagTransform t = cag_transform_identity();
  t.planar = false;
  t.m[0][0] = x;
  t.m[1][1] = y;
  t.m[2][2] = z;
  t.m[2][3] = lift;
  return t;
}

CagStatus cag_solid_sphere(double radius, CagSolid **out, CagError *err) {
  CagStatus status = cag_solid_check_size(radius, "radius", -1, err);
  CagSolid *s;
  if (!status) status = cag_solid_block(CAG_SOLID_SPHERE, 1, &s, err);
  if (status) return status;
  s->a = radius;
  // From the south pole upward, so that the normals point outward.
  CagTransform frame = diagonal(radius, radius, -radius, 0);
  CagSurface *face;
  status = cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, &face, err);
  if (!status) cag_solid_add(s, face);
  return finish(s, status, out, err);
}

// The lateral face, v upward: u is the angle; on a cone |v| is the radius.
static CagStatus side(double height, double radius, double top, CagSurface **out, CagError *err) {
  if (radius == top) {
    CagTransform frame = diagonal(radius, radius, 1, 0);
    return cag_surface_quadric(CAG_SHAPE_ELLIPTIC_CYLINDER, &frame, 0, 2 * M_PI, 0, height, out,
                               err);
  }
  double slope = height / fabs(top - radius);
  if (top > radius) {
    CagTransform frame = diagonal(1, 1, slope, -radius * slope);
    return cag_surface_quadric(CAG_SHAPE_CONE, &frame, 0, 2 * M_PI, radius, top, out, err);
  }
  CagTransform frame = diagonal(-1, -1, slope, radius * slope);
  return cag_surface_quadric(CAG_SHAPE_CONE, &frame, 0, 2 * M_PI, -radius, top > 0 ? -top : 0, out,
                             err);
}

static CagStatus add_disk(CagSolid *s, double radius, double z, bool down, CagError *err) {
  CagRegion *disk;
  CagStatus status = cag_solid_disk(radius, &disk, err);
  if (status) return status;
  CagTransform frame = diagonal(1, 1, 1, z);
  CagSurface *face = NULL, *turned = NULL;
  status = cag_surface_planar(disk, &frame, &face, err);
  cag_region_release(disk);
  if (!status && down) {
    status = cag_surface_flip(face, &turned, err);
    cag_surface_release(face);
    face = turned;
  }
  if (!status) cag_solid_add(s, face);
  return status;
}

CagStatus cag_solid_cylinder(double height, double radius, double top, CagSolid **out,
                             CagError *err) {
  CagStatus status = cag_solid_check_size(height, "height", -1, err);
  // One of the two circles may be a point.
  if (!status && !(radius == 0 && top > 0))
    status = cag_solid_check_size(radius, "radius", -1, err);
  if (!status && !(top == 0 && radius > 0)) status = cag_solid_check_size(top, "top", -1, err);
  CagSolid *s;
  if (!status) status = cag_solid_block(CAG_SOLID_CYLINDER, 3, &s, err);
  if (status) return status;
  s->a = height;
  s->b = radius;
  s->c = top;
  CagSurface *face;
  status = side(height, radius, top, &face, err);
  if (!status) cag_solid_add(s, face);
  if (!status && radius > 0) status = add_disk(s, radius, 0, true, err);
  if (!status && top > 0) status = add_disk(s, top, height, false, err);
  return finish(s, status, out, err);
}

CagStatus cag_solid_torus(double major, double minor, CagSolid **out, CagError *err) {
  char a[32], b[32];
  CagSurface *face;
  CagStatus status = cag_surface_torus(major, minor, &face, err);
  if (status) return status;
  CagSolid *s;
  if (major < minor)
    status = cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_self_intersection, "major", -1,
        "`major` must be at least `minor`, found %s and %s; for a torus that crosses itself, use torus_surface",
        cag_number_text(major, a), cag_number_text(minor, b));
  if (!status) status = cag_solid_block(CAG_SOLID_TORUS, 1, &s, err);
  if (status) {
    cag_surface_release(face);
    return status;
  }
  s->a = major;
  s->b = minor;
  cag_solid_add(s, face);
  return finish(s, status, out, err);
}
