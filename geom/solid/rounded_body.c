// Boxes and cylinders with rounded edges: parts of planes, cylinders, spheres, and tori.

#include <math.h>

#include "geom/linalg/tolerance.h"
#include "geom/solid/build.h"
#include "geom/solid/rounded.h"

// Takes ownership of the solid.
static CagStatus finish(CagSolid *s, CagStatus status, CagSolid **out, CagError *err) {
  if (!status) status = cag_solid_match_edges(s, err);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

static CagStatus check_radius(double radius, double most, const char *name, const char *why,
                              CagError *err) {
  char found[32], limit[32];
  if (radius <= most) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_rounding_too_large, name, -1,
                  "`%s` must be at most %s, %s; found %s", name, cag_number_text(most, limit), why,
                  cag_number_text(radius, found));
}

// --- Box ---

// The box between the centers of its corners.
typedef struct Core {
  double low[3], high[3], radius;
} Core;

static bool has_length(const Core *c, int axis) {
  return c->high[axis] - c->low[axis] > CAG_ROUNDING * c->radius;
}

static void set_column(CagTransform *t, int column, int axis, double value) {
  for (int i = 0; i < 3; i++) t->m[i][column] = i == axis ? value : 0;
}

// A frame whose x and y are along two axes by these lengths and whose z is along the third one,
// exchanged if necessary to be left-handed (if `left`) or right-handed.
static CagTransform core_frame(const Core *c, const bool high[3], const int axes[3],
                               const double lengths[3], bool left) {
  CagTransform t = cag_transform_identity();
  t.planar = false;
  const bool cyclic = axes[1] == (axes[0] + 1) % 3;
  const bool reflected = (lengths[0] * lengths[1] * lengths[2] < 0) == cyclic;
  const int first = reflected == left ? 0 : 1;
  set_column(&t, 0, axes[first], lengths[first]);
  set_column(&t, 1, axes[1 - first], lengths[1 - first]);
  set_column(&t, 2, axes[2], lengths[2]);
  for (int i = 0; i < 3; i++) t.m[i][3] = high[i] ? c->high[i] : c->low[i];
  return t;
}

static CagStatus add_quadric(CagSolid *s, CagQuadricShape shape, const CagTransform *frame,
                             double v1, CagError *err) {
  CagSurface *face;
  const CagStatus status = cag_surface_quadric(shape, frame, 0, M_PI / 2, 0, v1, &face, err);
  if (!status) cag_solid_add(s, face);
  return status;
}

static CagStatus add_flat(CagSolid *s, const Core *c, int axis, bool up, CagError *err) {
  const int u = (axis + (up ? 1 : 2)) % 3, v = (axis + (up ? 2 : 1)) % 3;
  double origin[3] = {c->low[0], c->low[1], c->low[2]}, x[3] = {0}, y[3] = {0};
  CagSurface *face;
  origin[axis] = up ? c->high[axis] + c->radius : c->low[axis] - c->radius;
  x[u] = c->high[u] - c->low[u];
  y[v] = c->high[v] - c->low[v];
  const CagStatus status =
      cag_surface_parallelogram(cag_vec3(origin[0], origin[1], origin[2]),
                                cag_vec3(x[0], x[1], x[2]), cag_vec3(y[0], y[1], y[2]), &face, err);
  if (!status) cag_solid_add(s, face);
  return status;
}

// The face of the edge along the axis, on these sides of the other two.
static CagStatus add_edge_face(CagSolid *s, const Core *c, int axis, bool up_u, bool up_v,
                               CagError *err) {
  const int axes[3] = {(axis + 1) % 3, (axis + 2) % 3, axis};
  const double lengths[3] = {up_u ? c->radius : -c->radius, up_v ? c->radius : -c->radius, 1};
  bool high[3] = {false, false, false};
  high[axes[0]] = up_u;
  high[axes[1]] = up_v;
  const CagTransform frame = core_frame(c, high, axes, lengths, false);
  return add_quadric(s, CAG_SHAPE_ELLIPTIC_CYLINDER, &frame, c->high[axis] - c->low[axis], err);
}

// The ellipsoid's normals point outward in a left-handed frame.
static CagStatus add_corner_face(CagSolid *s, const Core *c, const bool high[3], CagError *err) {
  const int axes[3] = {0, 1, 2};
  double lengths[3];
  for (int i = 0; i < 3; i++) lengths[i] = high[i] ? c->radius : -c->radius;
  const CagTransform frame = core_frame(c, high, axes, lengths, true);
  return add_quadric(s, CAG_SHAPE_ELLIPSOID, &frame, M_PI / 2, err);
}

CagStatus cag_solid_rounded_box(CagVec3 size, double radius, bool centered, CagSolid **out,
                                CagError *err) {
  const double sizes[3] = {size.x, size.y, size.z};
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 3; i++) status = cag_solid_check_size(sizes[i], "size", i, err);
  if (!status) status = cag_solid_check_size(radius, "radius", -1, err);
  if (!status)
    status = check_radius(radius, fmin(size.x, fmin(size.y, size.z)) / 2, "radius",
                          "half of the smallest size", err);
  // A radius below rounding leaves the edges sharp.
  if (!status && radius <= CAG_ROUNDING * fmax(size.x, fmax(size.y, size.z)))
    return cag_solid_box(size, centered, out, err);
  CagSolid *s;
  if (!status) status = cag_solid_block(CAG_SOLID_SHELL, 26, &s, err);
  if (status) return status;
  Core c = {.radius = radius};
  for (int i = 0; i < 3; i++) {
    c.low[i] = (centered ? -sizes[i] / 2 : 0) + radius;
    c.high[i] = (centered ? sizes[i] / 2 : sizes[i]) - radius;
  }
  for (int axis = 0; !status && axis < 3; axis++)
    for (int k = 0; !status && k < 4; k++) {
      const bool flat = has_length(&c, (axis + 1) % 3) && has_length(&c, (axis + 2) % 3);
      if (has_length(&c, axis)) status = add_edge_face(s, &c, axis, k % 2, k / 2, err);
      if (!status && k < 2 && flat) status = add_flat(s, &c, axis, k, err);
    }
  for (int k = 0; !status && k < 8; k++) {
    const bool high[3] = {k & 1, k & 2, k & 4};
    status = add_corner_face(s, &c, high, err);
  }
  return finish(s, status, out, err);
}

// --- Cylinder ---

// The quarter of a circle about (x, z) in the plane y = 0 that starts at the angle.
static CagStatus rim_arc(double x, double z, double fillet, double from, CagCurve **out,
                         CagError *err) {
  CagTransform frame = cag_translate(cag_vec3(x, 0, z));
  frame.planar = false;
  set_column(&frame, 1, 2, 1);
  set_column(&frame, 2, 1, -1);
  CagCurve *upward;
  CagStatus status = cag_curve_arc(fillet, fillet, from, from + M_PI / 2, &frame, &upward, err);
  if (status) return status;
  status = cag_curve_reverse(upward, out, err);
  cag_curve_release(upward);
  return status;
}

// Revolves a profile that runs downward, so that the normal points outward.
static CagStatus add_turned(CagSolid *s, CagCurve *profile, CagError *err) {
  CagSurface *face;
  const CagStatus status =
      cag_surface_revolve(profile, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &face, err);
  cag_curve_release(profile);
  if (!status) cag_solid_add(s, face);
  return status;
}

static CagStatus add_disks(CagSolid *s, double height, double radius, CagError *err) {
  CagRegion *disk;
  CagStatus status = cag_solid_disk(radius, &disk, err);
  if (status) return status;
  for (int k = 0; !status && k < 2; k++) {
    CagTransform frame = cag_translate(cag_vec3(0, 0, k == 0 ? 0 : height));
    frame.planar = false;
    status = cag_solid_add_cap(s, disk, &frame, k == 0, err);
  }
  cag_region_release(disk);
  return status;
}

CagStatus cag_solid_rounded_cylinder(double height, double radius, double fillet, CagSolid **out,
                                     CagError *err) {
  CagStatus status = cag_solid_check_size(height, "height", -1, err);
  if (!status) status = cag_solid_check_size(radius, "radius", -1, err);
  if (!status) status = cag_solid_check_size(fillet, "fillet", -1, err);
  if (!status) status = check_radius(fillet, radius, "fillet", "the radius", err);
  if (!status) status = check_radius(fillet, height / 2, "fillet", "half of the height", err);
  if (!status && fillet <= CAG_ROUNDING * fmax(radius, height))
    return cag_solid_cylinder(height, radius, radius, out, err);
  CagSolid *s;
  if (!status) status = cag_solid_block(CAG_SOLID_SHELL, 5, &s, err);
  if (status) return status;
  const double x = radius - fillet, low = fillet, high = height - fillet;
  CagCurve *profile;
  status = rim_arc(x, high, fillet, 0, &profile, err);
  if (!status) status = add_turned(s, profile, err);
  if (!status && high - low > CAG_ROUNDING * height) {
    status = cag_curve_line(cag_vec3(radius, 0, high), cag_vec3(radius, 0, low), 3, &profile, err);
    if (!status) status = add_turned(s, profile, err);
  }
  if (!status) status = rim_arc(x, low, fillet, -M_PI / 2, &profile, err);
  if (!status) status = add_turned(s, profile, err);
  if (!status && x > CAG_ROUNDING * radius) status = add_disks(s, height, x, err);
  return finish(s, status, out, err);
}
