// Writes surfaces for which POV-Ray has objects: bicubic Bezier patches, quadrics, tori, spheres,
// lathes, and flat polygons.

#include "geom/surface/reshape.h"
#include "interp/formats/pov_write.h"

// A sampled point fits a sphere or torus up to this fraction of its size, which allows for rounding
// in the evaluation.
#define FITS 1e-9

#define FULL_TURN (2 * 3.14159265358979323846)

static bool is_bezier(const CagSurfaceNurbsView *v) {
  return !v->rational && !v->periodic_u && !v->periodic_v && v->nu == (size_t)v->degree_u + 1 &&
         v->nv == (size_t)v->degree_v + 1 && v->degree_u <= 3 && v->degree_v <= 3;
}

// Writes a Bezier patch of degree up to 3, elevated to 3. Flat quadrilaterals are better as meshes.
static bool try_bicubic(CagPovWriter *w, const CagSurface *s) {
  CagSurfaceNurbsView v;
  CagError err;
  CagSurface *raised;
  if (!cag_surface_nurbs_view(s, &v) || !is_bezier(&v) || v.degree_u + v.degree_v < 3) return false;
  if (cag_surface_elevate(s, 3 - v.degree_u, 3 - v.degree_v, &raised, &err)) return false;
  cag_surface_nurbs_view(raised, &v);
  // 2^steps cells in each direction; normals are exact at their corners.
  int steps = w->options->quality == CAG_POV_DRAFT ? 3 : 5;
  cag_pov_printf(w, "bicubic_patch {\n  type 1 flatness 0 u_steps %d v_steps %d,\n", steps, steps);
  for (int i = 0; i < 16; i++) {
    const double *h = v.homogeneous + 4 * i;
    cag_pov_text(w, i % 4 == 0 ? "  " : " ");
    cag_pov_vec(w, cag_vec3(h[0], h[1], h[2]));
    cag_pov_text(w, i == 15 ? "\n" : i % 4 == 3 ? ",\n" : ",");
  }
  cag_pov_text(w, "}");
  cag_surface_release(raised);
  return true;
}

// --- Tori, by sampling: R, r, and the frame follow from a few points, and others must fit ---

typedef struct Ring {
  const CagSurface *s;
  bool swapped; // u runs around the section
} Ring;

static CagVec3 ring_point(const Ring *r, double turn, double section) {
  CagError err;
  CagVec3 p;
  double u = r->s->u0 + (r->swapped ? section : turn) * FULL_TURN;
  double v = r->s->v0 + (r->swapped ? turn : section) * FULL_TURN;
  if (cag_surface_point(r->s, fmin(u, r->s->u1), fmin(v, r->s->v1), &p, &err))
    return cag_vec3(NAN, NAN, NAN);
  return p;
}

static CagVec3 section_center(const Ring *r, double turn) {
  return cag_lerp(ring_point(r, turn, 0), ring_point(r, turn, 0.5), 0.5);
}

static bool ring_fits(const Ring *r, const CagTransform *frame, double major, double minor) {
  CagError err;
  CagTransform inverse;
  const int turns = 7, sections = 5;
  if (cag_transform_inverse(frame, &inverse, &err)) return false;
  for (int i = 0; i < turns * sections; i++) {
    CagVec3 p = ring_point(r, (double)(i / sections) / turns, (double)(i % sections) / sections);
    CagVec3 q = cag_transform_point(&inverse, p);
    double off = hypot(hypot(q.x, q.y) - major, q.z) - minor;
    if (!(fabs(off) <= FITS * (major + minor))) return false;
  }
  return true;
}

bool cag_pov_try_torus(CagPovWriter *w, const CagSurface *s) {
  CagTransform map;
  s = cag_pov_unplaced(s, &map);
  if (!cag_pov_takes(&map)) return false;
  if (fabs(s->u1 - s->u0 - FULL_TURN) > FITS || fabs(s->v1 - s->v0 - FULL_TURN) > FITS)
    return false;
  Ring r = {s, cag_surface_revolution_view(s, NULL, NULL, NULL, NULL, NULL)};
  CagVec3 center = cag_lerp(section_center(&r, 0), section_center(&r, 0.5), 0.5);
  CagVec3 x = cag_sub(section_center(&r, 0), center), y = cag_sub(section_center(&r, 0.25), center);
  double major = cag_norm(x);
  double minor = cag_norm(cag_sub(ring_point(&r, 0, 0), ring_point(&r, 0, 0.5))) / 2;
  if (!(major > 0) || !(minor > 0)) return false;
  x = cag_scaled(x, 1 / major);
  y = cag_scaled(y, 1 / major);
  CagVec3 z = r.swapped
                  ? cag_cross(x, y)
                  : cag_scaled(cag_sub(ring_point(&r, 0, 0.25), section_center(&r, 0)), 1 / minor);
  CagTransform frame = {.m = {{x.x, y.x, z.x, center.x},
                              {x.y, y.y, z.y, center.y},
                              {x.z, y.z, z.z, center.z},
                              {0, 0, 0, 1}}};
  if (!ring_fits(&r, &frame, major, minor)) return false;
  cag_pov_text(w, "torus {\n  ");
  cag_pov_number(w, major);
  cag_pov_text(w, ", ");
  cag_pov_number(w, minor);
  cag_pov_text(w, "\n  rotate 90*x // POV-Ray's own lie about y\n");
  CagTransform placed = cag_transform_multiply(&map, &frame);
  cag_pov_placement(w, "  ", &placed);
  cag_pov_text(w, "}");
  return true;
}

// Recognizes a half circle about a center on the axis, revolved by a full turn.
static bool try_sphere(CagPovWriter *w, const CagSurface *s) {
  const CagCurve *profile;
  double from, to, a, b;
  CagTransform frame, map;
  s = cag_pov_unplaced(s, &map);
  if (!cag_pov_takes(&map)) return false;
  if (!cag_surface_revolution_view(s, &profile, NULL, NULL, &from, &to)) return false;
  if (fabs(fabs(to - from) - FULL_TURN) > FITS) return false;
  if (!cag_curve_arc_view(profile, &a, &b, &frame) || a != b) return false;
  CagError err;
  CagVec3 low, high, side;
  if (!(s->pole_u0 && s->pole_u1) || cag_surface_point(s, s->u0, s->v0, &low, &err) ||
      cag_surface_point(s, s->u1, s->v0, &high, &err) ||
      cag_surface_point(s, (s->u0 + s->u1) / 2, s->v0, &side, &err))
    return false;
  CagVec3 center = cag_lerp(low, high, 0.5);
  double radius = cag_norm(cag_sub(high, low)) / 2;
  if (fabs(cag_norm(cag_sub(side, center)) - radius) > FITS * radius) return false;
  cag_pov_text(w, "sphere {\n  ");
  cag_pov_vec(w, center);
  cag_pov_text(w, ", ");
  cag_pov_number(w, radius);
  cag_pov_text(w, "\n");
  cag_pov_placement(w, "  ", &map);
  cag_pov_text(w, "}");
  return true;
}

static bool try_planar(CagPovWriter *w, const CagSurface *s) {
  const CagRegion *region;
  CagTransform frame;
  return cag_surface_planar_view(s, &region, &frame) && cag_pov_try_polygon(w, region, &frame);
}

bool cag_pov_try_surface(CagPovWriter *w, const CagSurface *s) {
  const CagSurface *const one[] = {s};
  return try_bicubic(w, s) || try_planar(w, s) || cag_pov_try_quadric(w, one, 1) ||
         try_sphere(w, s) || cag_pov_try_torus(w, s) || cag_pov_try_lathe(w, one, 1);
}
