// Surfaces that intersect themselves: profiles by the crossings of their edges, sweeps by comparing
// the section's extent with the radius of curvature of the path (the surface folds where the
// section passes the center of curvature), and tubes by the distance between parts of their path.

#include "geom/meet/crossing.h"

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/swept.h"

#define PROFILE_SAMPLES 400
#define PATH_SAMPLES 200
#define SECTION_SAMPLES 64
// Number of disks for a tube, depending on its length and thickness.
#define TUBE_FEW 400
#define TUBE_MANY 4000
// Margin beyond the center of curvature, as a fraction.
#define BEYOND 1e-6

typedef struct Flat {
  double x, y;
} Flat;

static double side(Flat a, Flat b, Flat p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

static bool edges_cross(Flat a, Flat b, Flat c, Flat d) {
  if (fmax(a.y, b.y) < fmin(c.y, d.y) || fmax(c.y, d.y) < fmin(a.y, b.y)) return false;
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

// The profile in the half plane of the axis: distance and height.
static bool profile_crosses(const CagCurve *profile, CagVec3 axis, CagVec3 through, char *what,
                            size_t size) {
  Flat points[PROFILE_SAMPLES + 1];
  CagError err;
  for (int i = 0; i <= PROFILE_SAMPLES; i++) {
    const double t = profile->start + (profile->end - profile->start) * i / PROFILE_SAMPLES;
    CagVec3 p;
    if (cag_curve_point(profile, t, &p, &err)) return false;
    p = cag_sub(p, through);
    const double height = cag_dot(p, axis);
    points[i] = (Flat){cag_norm(cag_madd(p, -height, axis)), height};
  }
  for (int i = 0; i < PROFILE_SAMPLES; i++)
    for (int k = i + 2; k < PROFILE_SAMPLES; k++) {
      if (!edges_cross(points[i], points[i + 1], points[k], points[k + 1])) continue;
      snprintf(what, size, "its profile crosses itself near %.4g from the axis, %.4g along it",
               points[i].x, points[i].y);
      return true;
    }
  return false;
}

// The section's extent towards the center of curvature at parameter t, times the curvature.
static bool folds_at(const CagCurve *section, const CagMotion *motion, const CagCurve *path,
                     double t, double *measure) {
  CagMotionSeries m;
  CagVec3 d[3];
  CagError err;
  if (cag_curve_eval(path, t, 2, CAG_SIDE_RIGHT, d, &err) ||
      cag_motion_at(motion, t, 0, CAG_SIDE_RIGHT, &m, &err))
    return false;
  const double speed = cag_norm(d[1]);
  const CagVec3 bend = cag_cross(cag_cross(d[1], d[2]), d[1]);
  const double curvature = cag_norm(cag_cross(d[1], d[2])) / (speed * speed * speed);
  if (!(curvature > 0) || !isfinite(curvature)) return false;
  const CagVec3 to_center = cag_unit(bend);
  *measure = 0;
  for (int i = 0; i < SECTION_SAMPLES; i++) {
    const double u = section->start + (section->end - section->start) * i / SECTION_SAMPLES;
    CagVec3 p;
    if (cag_curve_point(section, u, &p, &err)) return false;
    const CagVec3 out = cag_madd(cag_scaled(m.x[0], p.x), p.y, m.y[0]);
    *measure = fmax(*measure, curvature * cag_dot(out, to_center));
  }
  return true;
}

static bool sweep_folds(const CagCurve *section, const CagMotion *motion, char *what, size_t size) {
  const CagCurve *path = cag_motion_path(motion);
  if (!path) return false;
  for (int i = 0; i <= PATH_SAMPLES; i++) {
    const double t = path->start + (path->end - path->start) * i / PATH_SAMPLES;
    double measure;
    if (!folds_at(section, motion, path, t, &measure) || measure <= 1 + BEYOND) continue;
    snprintf(
        what, size,
        "its section reaches %.3g times as far as the center of curvature of the path at v = %.4g, so the surface folds there",
        measure, t);
    return true;
  }
  return false;
}

// --- Tubes that intersect themselves ---

// The disk of a tube at a parameter of its path.
typedef struct Disk {
  CagVec3 p;
  double radius, t;
} Disk;

// A circle about the origin of the section's plane; false: another section.
static bool is_round_section(const CagCurve *section, double *radius) {
  CagVec3 center, x, y;
  double rate;
  if (!cag_curve_arc_axes(section, &center, &x, &y, &rate) || !section->closed) return false;
  *radius = cag_norm(x);
  return fabs(cag_norm(y) - *radius) <= BEYOND * *radius &&
         fabs(cag_dot(x, y)) <= BEYOND * *radius * *radius && cag_norm(center) <= BEYOND * *radius;
}

static bool disk_at(const CagMotion *motion, double radius, Disk *d) {
  CagMotionSeries m;
  CagError err;
  if (cag_curve_point(cag_motion_path(motion), d->t, &d->p, &err) ||
      cag_motion_at(motion, d->t, 0, CAG_SIDE_RIGHT, &m, &err))
    return false;
  d->radius = radius * cag_norm(m.x[0]);
  return true;
}

// n + 1 disks at equal steps of the parameter; false if an evaluation fails.
static bool sample_disks(const CagMotion *motion, double radius, Disk *out, int n) {
  const CagCurve *path = cag_motion_path(motion);
  for (int i = 0; i <= n; i++) {
    out[i].t = path->start + (path->end - path->start) * i / n;
    if (!disk_at(motion, radius, &out[i])) return false;
  }
  return true;
}

// Steps about a quarter of the smallest radius long, within limits.
static int steps_for(const Disk *disks) {
  double length = 0, least = INFINITY;
  for (int i = 0; i < TUBE_FEW; i++) {
    length += cag_norm(cag_sub(disks[i + 1].p, disks[i].p));
    if (disks[i].radius > 0) least = fmin(least, disks[i].radius);
  }
  return (int)fmin(TUBE_MANY, fmax(TUBE_FEW, 4 * length / least));
}

// Whether no pair of neighbors of i and k is closer: the line between them is then perpendicular to
// the path at both ends, and their disks are coplanar. For neighbors on the path the closer pair is
// between them.
static bool is_least_distance(const Disk *disks, int i, int k, double d) {
  const double alike = CAG_COINCIDENT; // relative to the distance: along a helix all are equal
  for (int a = -1; a <= 1; a++)
    for (int b = -1; b <= 1; b++)
      if (cag_norm(cag_sub(disks[i + a].p, disks[k + b].p)) < d * (1 - alike)) return false;
  return true;
}

// The first pair of parts of the path that are closer to each other than the tube is thick.
static bool find_meeting(const Disk *disks, int n, int *first, int *second) {
  for (int i = 1; i < n; i++)
    for (int k = i + 2; k < n; k++) {
      const CagVec3 apart = cag_sub(disks[k].p, disks[i].p);
      const double both = (disks[i].radius + disks[k].radius) * (1 - BEYOND);
      if (cag_dot(apart, apart) >= both * both) continue;
      if (!is_least_distance(disks, i, k, cag_norm(apart))) continue;
      *first = i;
      *second = k;
      return true;
    }
  return false;
}

static bool tube_meets_itself(const CagCurve *section, const CagMotion *motion, char *what,
                              size_t size) {
  Disk few[TUBE_FEW + 1], *disks;
  double radius;
  int i, k;
  if (!cag_motion_path(motion) || !is_round_section(section, &radius) ||
      !sample_disks(motion, radius, few, TUBE_FEW))
    return false;
  const int n = steps_for(few);
  disks = cag_malloc(((size_t)n + 1) * sizeof *disks);
  if (!disks) cag_note_memory();
  const bool meets =
      disks && sample_disks(motion, radius, disks, n) && find_meeting(disks, n, &i, &k);
  if (meets) {
    const bool angle = cag_motion_path(motion)->angular;
    const double shown = angle ? 180 / M_PI : 1;
    snprintf(
        what, size,
        "its path at v = %.4g%s is %.4g from that at v = %.4g%s, where the tube is %.4g thick, so it crosses itself",
        shown * disks[i].t, angle ? "deg" : "", cag_norm(cag_sub(disks[k].p, disks[i].p)),
        shown * disks[k].t, angle ? "deg" : "", disks[i].radius + disks[k].radius);
  }
  cag_free(disks);
  return meets;
}

// --- Lofts without thickness ---

static bool loft_is_flat(const CagSurface *side, char *what, size_t size) {
  enum { SAMPLES = 12 };
  const double flat = CAG_COINCIDENT; // of the size
  CagVec3 p[(SAMPLES + 1) * (SAMPLES + 1)];
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagError err;
  size_t n = 0;
  for (int i = 0; i <= SAMPLES; i++)
    for (int j = 0; j <= SAMPLES; j++, n++) {
      const double u = side->u0 + (side->u1 - side->u0) * i / SAMPLES;
      const double v = side->v0 + (side->v1 - side->v0) * j / SAMPLES;
      if (cag_surface_point(side, u, v, &p[n], &err)) return false;
      cag_bounds_add(&box, p[n]);
    }
  // The largest triangle with the first point and the one farthest from it.
  const double extent = cag_norm(cag_sub(box.max, box.min));
  CagVec3 far = {0, 0, 0}, normal = {0, 0, 0};
  for (size_t i = 1; i < n; i++)
    if (cag_norm(cag_sub(p[i], p[0])) > cag_norm(far)) far = cag_sub(p[i], p[0]);
  for (size_t i = 1; i < n; i++) {
    const CagVec3 across = cag_cross(far, cag_sub(p[i], p[0]));
    if (cag_norm(across) > cag_norm(normal)) normal = across;
  }
  normal = cag_unit(normal);
  for (size_t i = 1; i < n; i++)
    if (fabs(cag_dot(cag_sub(p[i], p[0]), normal)) > flat * extent) return false;
  snprintf(what, size, "its sections lie in one plane, so the loft has no volume");
  return true;
}

bool cag_surface_crosses_itself(const CagSurface *s, char *what, size_t size) {
  const CagCurve *curve;
  const CagMotion *motion;
  CagVec3 axis, through;
  double from, to;
  if (cag_surface_revolution_view(s, &curve, &axis, &through, &from, &to))
    return profile_crosses(curve, cag_unit(axis), through, what, size);
  return cag_surface_swept_view(s, &curve, &motion) &&
         (sweep_folds(curve, motion, what, size) || tube_meets_itself(curve, motion, what, size));
}

bool cag_solid_crosses_itself(const CagSolid *s, char *what, size_t size) {
  for (size_t i = 0; i < s->face_count; i++)
    if (cag_surface_crosses_itself(s->faces[i], what, size)) return true;
  return false;
}

bool cag_solid_is_flat(const CagSolid *s, char *what, size_t size) {
  const CagSurface *side = s->kind == CAG_SOLID_LOFT ? cag_solid_side(s) : NULL;
  return side && loft_is_flat(side, what, size);
}
