// Cores of curves and surfaces: points and segments at a constant distance.

#include "geom/surface/core.h"

#include <math.h>

#include "geom/curve/family.h"
#include "geom/surface/quadric.h"
#include "geom/surface/swept.h"
#include "geom/surface/trimmed.h"

// Lengths are equal, and directions parallel or perpendicular, within this fraction: rounding of a
// few operations.
#define SAME 1e-13

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static bool are_equal(double a, double b) { return fabs(a - b) <= SAME * (fabs(a) + fabs(b)); }

static bool are_perpendicular(CagVec3 a, CagVec3 b) {
  return fabs(cag_dot(a, b)) <= SAME * cag_norm(a) * cag_norm(b);
}

static bool are_parallel(CagVec3 a, CagVec3 b) {
  return cag_norm(cag_cross(a, b)) <= SAME * cag_norm(a) * cag_norm(b);
}

// The ends of a straight piece.
static bool ends_of_line(const CagCurve *c, double a, double b, CagVec3 ends[2]) {
  CagError ignored;
  if (cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &ends[0], &ignored) ||
      cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &ends[1], &ignored))
    return false;
  return cag_curve_sag(c, a, b) <= SAME * cag_norm(cag_sub(ends[1], ends[0]));
}

static bool core_of_helix(const CagCurve *c, CagCore *out) {
  double radius, pitch, turns, taper;
  CagTransform frame;
  if (!cag_curve_helix_view(c, &radius, &pitch, &turns, &taper, &frame) || taper != 0) return false;
  const CagVec3 x = column(&frame, 0), y = column(&frame, 1), z = column(&frame, 2);
  if (!are_equal(cag_norm(x), cag_norm(y)) || !are_perpendicular(x, y) ||
      !are_perpendicular(x, z) || !are_perpendicular(y, z))
    return false;
  out->p[0] = column(&frame, 3);
  out->p[1] = cag_madd(out->p[0], pitch * fabs(turns), z);
  out->radius = radius * cag_norm(x);
  return true;
}

bool cag_curve_core(const CagCurve *c, double a, double b, CagCore *out) {
  CagVec3 center, x, y;
  double rate;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &a, &b, &rate);
  if (piece) return cag_curve_core(piece, a, b, out);
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate)) {
    *out = (CagCore){{center, center}, cag_norm(x)};
    return are_equal(cag_norm(x), cag_norm(y)) && are_perpendicular(x, y);
  }
  out->radius = 0;
  return core_of_helix(c, out) || ends_of_line(c, a, b, out->p);
}

static bool core_of_quadric(const CagSurface *s, const CagQuadric *equation, CagCore *out) {
  CagQuadricForm form;
  CagTransform frame;
  CagError ignored;
  if (!cag_surface_quadric_frame(s, &frame) || cag_quadric_classify(equation, &form, &ignored))
    return false;
  const CagVec3 x = column(&frame, 0), y = column(&frame, 1), z = column(&frame, 2);
  const CagVec3 center = column(&frame, 3);
  if (!are_equal(cag_norm(x), cag_norm(y)) || !are_perpendicular(x, y) ||
      !are_perpendicular(x, z) || !are_perpendicular(y, z))
    return false;
  out->radius = cag_norm(x);
  if (form.class_id == CAG_QUADRIC_ELLIPSOID) {
    out->p[0] = out->p[1] = center;
    return are_equal(cag_norm(x), cag_norm(z));
  }
  out->p[0] = cag_madd(center, s->v0, z);
  out->p[1] = cag_madd(center, s->v1, z);
  return form.class_id == CAG_QUADRIC_ELLIPTIC_CYLINDER;
}

// An arc about a point of the axis, or a line parallel to the axis.
static bool core_of_revolution(const CagCurve *profile, double low, double high, CagVec3 axis,
                               CagVec3 through, CagCore *out) {
  if (!cag_curve_core(profile, low, high, out)) return false;
  CagVec3 foot[2], off[2];
  axis = cag_unit(axis);
  for (int k = 0; k < 2; k++) {
    foot[k] = cag_madd(through, cag_dot(cag_sub(out->p[k], through), axis), axis);
    off[k] = cag_sub(out->p[k], foot[k]);
  }
  if (out->radius > 0)
    return cag_norm(cag_sub(out->p[1], out->p[0])) == 0 && cag_norm(off[0]) <= SAME * out->radius;
  if (!are_parallel(cag_sub(out->p[1], out->p[0]), axis)) return false;
  *out = (CagCore){{foot[0], foot[1]}, cag_norm(off[0])};
  return true;
}

// An arc extruded perpendicular to its plane.
static bool core_of_extrusion(const CagCurve *section, double low, double high, CagVec3 along,
                              CagCore *out) {
  CagVec3 d[2];
  CagError ignored;
  if (!cag_curve_core(section, low, high, out) || out->radius == 0 ||
      cag_norm(cag_sub(out->p[1], out->p[0])) > 0)
    return false;
  // Both radii span the plane.
  for (int k = 0; k < 2; k++) {
    const double at = low + (high - low) * (k ? 0.3 : 0.1); // less than half a turn apart
    if (cag_curve_eval(section, at, 0, CAG_SIDE_RIGHT, &d[k], &ignored) ||
        !are_perpendicular(cag_sub(d[k], out->p[0]), along))
      return false;
  }
  out->p[1] = cag_add(out->p[0], along);
  return true;
}

bool cag_surface_core(const CagSurface *s, double u_low, double u_high, CagCore *out) {
  const CagSurface *inner;
  const CagCurve *curve;
  const CagRegion *region;
  CagVec3 axis, through;
  CagTransform map;
  CagQuadric equation;
  double scale, radius;
  if (cag_surface_trimmed_view(s, &inner, &region))
    return cag_surface_core(inner, u_low, u_high, out);
  if (cag_surface_placed_view(s, &inner, &map)) {
    if (!cag_transform_is_similarity(&map, &scale) || !cag_surface_core(inner, u_low, u_high, out))
      return false;
    for (int k = 0; k < 2; k++) out->p[k] = cag_transform_point(&map, out->p[k]);
    out->radius *= fabs(scale);
    return true;
  }
  if (cag_surface_quadric_view(s, &equation)) return core_of_quadric(s, &equation, out);
  if (cag_surface_revolution_view(s, &curve, &axis, &through, NULL, NULL))
    return core_of_revolution(curve, u_low, u_high, axis, through, out);
  if (cag_surface_extrusion_view(s, &curve, &axis))
    return core_of_extrusion(curve, u_low, u_high, axis, out);
  if (!cag_surface_tube_view(s, &curve, &radius) ||
      !ends_of_line(curve, curve->start, curve->end, out->p))
    return false;
  out->radius = radius;
  return true;
}

bool cag_surface_is_straight(const CagSurface *s, double u_low, double u_high) {
  const CagSurface *inner;
  const CagCurve *section;
  CagTransform map;
  CagVec3 along, ends[2];
  if (cag_surface_placed_view(s, &inner, &map)) s = inner;
  return cag_surface_extrusion_view(s, &section, &along) &&
         ends_of_line(section, u_low, u_high, ends);
}
