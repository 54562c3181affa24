// Loops given in space: their common plane, and their images in it.

#include <math.h>
#include <stdlib.h>

#include "geom/meet/section.h"
#include "interp/builtin/curves.h"

// Tolerance for coplanar curves, as a fraction of the distance from the origin.
#define WITHIN 1e-9

// Moves the plane's point to the foot of the perpendicular from the origin, and turns the normal
// toward Z, or Y or X if it is horizontal.
static CagPlane upright(const CagPlane *plane) {
  const CagVec3 n = plane->normal;
  const double least = 1e-9, first = fabs(n.z) > least ? n.z : fabs(n.y) > least ? n.y : n.x;
  const CagVec3 normal = first < 0 ? cag_scaled(n, -1) : n;
  return (CagPlane){cag_scaled(normal, cag_dot(plane->point, normal)), normal};
}

static bool is_coplanar(const CagCurve *c, const CagPlane *plane, double size) {
  enum { LOOKS = 32 };
  for (int i = 0; i < LOOKS; i++) {
    CagVec3 p;
    CagError ignored;
    if (cag_curve_point(c, c->start + (c->end - c->start) * i / LOOKS, &p, &ignored) ||
        fabs(cag_dot(cag_sub(p, plane->point), plane->normal)) > WITHIN * size)
      return false;
  }
  return true;
}

static double distance_from_origin(const CagCurve *c) {
  const CagBounds b = c->kind->hull(c, c->start, c->end);
  return fmax(cag_norm(b.min), cag_norm(b.max));
}

bool cag_region_loops_plane(CagCall *call, CagCurve **loops, size_t n, CagTransform *frame,
                            bool *in_space) {
  CagPlane plane;
  *in_space = false;
  for (size_t i = 0; i < n; i++) *in_space = *in_space || loops[i]->dimension == 3;
  if (!*in_space) return true;
  bool common = true;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && common && i < n; i++) {
    status = cag_curve_is_planar(loops[i], &common, i == 0 ? &plane : NULL, call->err);
    if (status || !common) break;
    if (i == 0) plane = upright(&plane);
    common = is_coplanar(loops[i], &plane, distance_from_origin(loops[i]));
  }
  if (!cag_geometry_ok(call, status)) return false;
  if (!common) {
    status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_not_planar, "", -1,
                      "expected boundaries that lie in one plane, found %s of space",
                      n > 1 ? "curves" : "a curve");
    return cag_geometry_ok(call, status);
  }
  *frame = cag_plane_frame(&plane);
  *in_space = cag_norm(plane.point) > 0 || plane.normal.z != 1;
  for (size_t i = 0; i < n; i++) {
    CagCurve *flat = NULL;
    status = cag_curve_flatten(loops[i], frame, &flat, call->err);
    if (!cag_geometry_ok(call, status)) return false;
    cag_curve_release(loops[i]);
    loops[i] = flat;
  }
  return true;
}
