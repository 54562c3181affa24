// Surfaces that cross themselves: profiles by the crossings of their edges, sweeps by the curvature
// of the path against the reach of the section (the surface folds where the section passes the
// centre of curvature).

#include "geom/surface/crossing.h"

#include <stdio.h>

#include "geom/surface/swept.h"

#define PROFILE_SAMPLES 400
#define PATH_SAMPLES 200
#define SECTION_SAMPLES 64
// Beyond the centre of curvature by more than this part.
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

// How far the section reaches towards the centre of curvature at parameter t, times the curvature.
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
  const CagVec3 to_centre = cag_unit(bend);
  *measure = 0;
  for (int i = 0; i < SECTION_SAMPLES; i++) {
    const double u = section->start + (section->end - section->start) * i / SECTION_SAMPLES;
    CagVec3 p;
    if (cag_curve_point(section, u, &p, &err)) return false;
    const CagVec3 out = cag_madd(cag_scaled(m.x[0], p.x), p.y, m.y[0]);
    *measure = fmax(*measure, curvature * cag_dot(out, to_centre));
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
    snprintf(what, size,
             "its section reaches %.3g times as far as the path bends at v = %.4g, so that it "
             "folds there",
             measure, t);
    return true;
  }
  return false;
}

bool cag_surface_crosses_itself(const CagSurface *s, char *what, size_t size) {
  const CagCurve *curve;
  const CagMotion *motion;
  CagVec3 axis, through;
  double from, to;
  if (cag_surface_revolution_view(s, &curve, &axis, &through, &from, &to))
    return profile_crosses(curve, cag_unit(axis), through, what, size);
  return cag_surface_swept_view(s, &curve, &motion) && sweep_folds(curve, motion, what, size);
}

bool cag_solid_crosses_itself(const CagSolid *s, char *what, size_t size) {
  for (size_t i = 0; i < s->face_count; i++)
    if (cag_surface_crosses_itself(s->faces[i], what, size)) return true;
  return false;
}
