// Sections of tori by bitangent planes through their center: the Villarceau circles (1848).
//
// The section branches at the points of contact, so tracing cannot find it to rounding accuracy.
// The torus is recognized in any form: as a torus, possibly moved or stretched, or by its circular
// parameter lines, as in a revolution, a NURBS surface, or a tube. On a part of a torus, the
// circles are cut where they cross its edges.

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geom/curve/intersect.h"
#include "geom/linalg/tolerance.h"
#include "geom/meet/section_edges.h"
#include "geom/surface/family.h"
#include "geom/surface/nearest.h"
#include "geom/surface/trimmed.h"

// Fractions of the size: points within the first are on the torus, points within the second are on
// the surface.
#define ON_TORUS 1e-11
#define ON_SURFACE 1e-10
// The plane may miss the center by this fraction of the larger radius, and the sine of its
// inclination may differ by as much.
#define ROUNDING CAG_ROUNDING

#define FULL_TURN 6.283185307179586

typedef struct TorusForm {
  CagTransform map; // from the torus about Z at the origin
  double major, minor;
} TorusForm;

// --- Recognition ---

typedef struct Circle {
  CagVec3 center, normal;
  double radius;
} Circle;

static bool circle_through(CagVec3 p, CagVec3 q, CagVec3 r, Circle *out) {
  const CagVec3 a = cag_sub(q, p), b = cag_sub(r, p), n = cag_cross(a, b);
  const double aa = cag_dot(a, a), bb = cag_dot(b, b), nn = cag_dot(n, n);
  const double flat = CAG_ROUNDING;
  if (!(nn > flat * aa * bb)) return false;
  const CagVec3 to = cag_scaled(
      cag_add(cag_scaled(cag_cross(b, n), aa), cag_scaled(cag_cross(n, a), bb)), 1 / (2 * nn));
  *out = (Circle){cag_add(p, to), cag_unit(n), cag_norm(to)};
  return true;
}

static bool point_at(const CagSurface *s, int direction, double along, double across,
                     CagVec3 *out) {
  CagError ignored;
  const double u = direction ? across : along, v = direction ? along : across;
  return !cag_surface_point(s, s->u0 + u * (s->u1 - s->u0), s->v0 + v * (s->v1 - s->v0), out,
                            &ignored);
}

// Finds the circle through three points of a parameter line.
static bool circle_of_line(const CagSurface *s, int direction, double across, Circle *out) {
  static const double along[3] = {0.05, 0.37, 0.71};
  CagVec3 p[3];
  for (int i = 0; i < 3; i++)
    if (!point_at(s, direction, along[i], across, &p[i])) return false;
  return circle_through(p[0], p[1], p[2], out);
}

static bool lies_on_torus(const TorusForm *form, const Circle *axis, CagVec3 p, double near) {
  const CagVec3 d = cag_sub(p, axis->center);
  const double z = cag_dot(d, axis->normal);
  const double beside = cag_norm(cag_madd(d, -z, axis->normal)) - form->major;
  return fabs(hypot(beside, z) - form->minor) <= near;
}

// Finds a torus whose parameter lines in a direction are circles around its tube.
static bool is_torus_along(const CagSurface *s, int direction, double near, TorusForm *out) {
  enum { PLACES = 16 };
  static const double across[3] = {0.11, 0.43, 0.83};
  Circle tube[3], axis;
  for (int i = 0; i < 3; i++)
    if (!circle_of_line(s, direction, across[i], &tube[i])) return false;
  if (!circle_through(tube[0].center, tube[1].center, tube[2].center, &axis)) return false;
  out->major = axis.radius;
  out->minor = (tube[0].radius + tube[1].radius + tube[2].radius) / 3;
  const CagPlane plane = {axis.center, axis.normal};
  out->map = cag_plane_frame(&plane);
  for (int i = 0; i < PLACES * PLACES; i++) {
    CagVec3 p;
    if (!point_at(s, direction, (i / PLACES + 0.5) / PLACES, (i % PLACES + 0.5) / PLACES, &p) ||
        !lies_on_torus(out, &axis, p, near))
      return false;
  }
  return true;
}

static bool find_torus(const CagSurface *s, TorusForm *out) {
  const CagSurface *inner = s;
  CagTransform map = cag_transform_identity();
  CagBounds box;
  CagError ignored;
  cag_surface_trimmed_view(s, &inner, NULL);
  s = inner;
  cag_surface_placed_view(s, &inner, &map);
  out->map = map;
  out->map.planar = false;
  if (cag_surface_torus_view(inner, &out->major, &out->minor)) return true;
  if (cag_surface_bounds(s, &box, &ignored)) return false;
  const double near = ON_TORUS * cag_norm(cag_sub(box.max, box.min));
  return is_torus_along(s, 0, near, out) || is_torus_along(s, 1, near, out);
}

// --- The circles ---

// The frame of the plane in the coordinates of the torus, with x along its horizontal line. Returns
// false if the plane is not bitangent.
static bool touches_twice(const TorusForm *form, const CagPlane *plane, CagVec3 axes[3]) {
  const CagTransform *map = &form->map;
  const CagVec3 n = plane->normal, o = cag_vec3(map->m[0][3], map->m[1][3], map->m[2][3]);
  CagVec3 back; // the plane's normal in the coordinates of the torus
  back.x = n.x * map->m[0][0] + n.y * map->m[1][0] + n.z * map->m[2][0];
  back.y = n.x * map->m[0][1] + n.y * map->m[1][1] + n.z * map->m[2][1];
  back.z = n.x * map->m[0][2] + n.y * map->m[1][2] + n.z * map->m[2][2];
  const double stretch = cag_norm(back), off = cag_dot(n, cag_sub(o, plane->point)),
               slope = hypot(back.x, back.y) / stretch;
  axes[2] = cag_unit(back);
  axes[0] = cag_unit(cag_cross(cag_vec3(0, 0, 1), axes[2]));
  axes[1] = cag_cross(axes[2], axes[0]);
  return form->minor < form->major && fabs(off) <= ROUNDING * stretch * form->major &&
         fabs(slope - form->minor / form->major) <= ROUNDING;
}

// A plane through the center that is inclined by asin(r / R) touches a ring torus twice and cuts it
// in two circles of radius R. Their centers lie at the distance r from the torus center, on the
// plane's horizontal line.
static CagStatus circle_beside(const TorusForm *form, const CagVec3 axes[3], double side,
                               CagCurve **out, CagError *err) {
  const CagVec3 x = axes[0], y = axes[1], z = axes[2], c = cag_scaled(x, side * form->minor);
  const CagTransform frame = {
      .m = {{x.x, y.x, z.x, c.x}, {x.y, y.y, z.y, c.y}, {x.z, y.z, z.z, c.z}, {0, 0, 0, 1}}};
  CagCurve *circle = NULL;
  CagStatus status = cag_curve_arc(form->major, form->major, 0, FULL_TURN, &frame, &circle, err);
  if (!status) status = cag_curve_transform(circle, &form->map, out, err);
  cag_curve_release(circle);
  return status;
}

// --- Parts of a torus ---

typedef struct Cuts {
  double *t;
  size_t n;
} Cuts;

static CagStatus add_cuts(Cuts *cuts, const CagCurve *circle, const CagCurve *edge, CagError *err) {
  CagMeeting *found = NULL;
  size_t n = 0;
  CagStatus status = cag_curve_intersect(circle, edge, &found, &n, err);
  double *grown = status ? NULL : cag_realloc(cuts->t, (cuts->n + n + 2) * sizeof *grown);
  if (!status && !grown) status = cag_fail_memory(err);
  if (grown) cuts->t = grown;
  for (size_t i = 0; !status && i < n; i++) cuts->t[cuts->n++] = found[i].t;
  cag_free(found);
  return status;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static CagStatus is_on(const CagSurface *s, const CagCurve *circle, double t, double near,
                       bool *out, CagError *err) {
  CagVec3 p;
  CagSurfaceNearest nearest;
  const double range = circle->end - circle->start;
  CagStatus status = cag_curve_point(circle, t > circle->end ? t - range : t, &p, err);
  if (!status) status = cag_surface_closest(s, p, &nearest, err);
  *out = !status && nearest.distance <= near;
  return status;
}

// Adds the arcs of the circle on the surface, from one cut to the next. Neighbors are joined later.
static CagStatus add_arcs(const CagSurface *s, const CagCurve *circle, const Cuts *cuts,
                          double near, CagCurveList *out, CagError *err) {
  const double range = circle->end - circle->start;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < cuts->n; i++) {
    const double from = cuts->t[i], to = i + 1 < cuts->n ? cuts->t[i + 1] : cuts->t[0] + range;
    bool on;
    if (to - from <= ON_SURFACE * range) continue;
    status = is_on(s, circle, (from + to) / 2, near, &on, err);
    if (status || !on) continue;
    CagCurve *arc = NULL;
    status = cag_curve_trim(circle, from, to, &arc, err);
    if (!status) status = cag_curve_list_add(out, arc, err);
  }
  return status;
}

static CagStatus add_parts(const CagSurface *s, CagCurve *circle, const CagCurveList *edges,
                           double size, CagCurveList *out, CagError *err) {
  Cuts cuts = {NULL, 0};
  const double near = ON_SURFACE * size;
  bool on;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < edges->count; i++)
    status = add_cuts(&cuts, circle, edges->items[i], err);
  if (!status && cuts.n == 0) {
    status = is_on(s, circle, circle->start, near, &on, err);
    if (!status && on) status = cag_curve_list_add(out, cag_curve_retain(circle), err);
  } else if (!status) {
    qsort(cuts.t, cuts.n, sizeof *cuts.t, ascending);
    status = add_arcs(s, circle, &cuts, near, out, err);
  }
  cag_free(cuts.t);
  return status;
}

CagStatus cag_section_villarceau(const CagSurface *s, const CagPlane *plane, double size,
                                 CagCurveList *out, bool *is, CagError *err) {
  TorusForm form;
  CagVec3 axes[3];
  CagCurveList edges = {0}, found = {0};
  *is = find_torus(s, &form) && touches_twice(&form, plane, axes);
  if (!*is) return CAG_OK;
  CagStatus status = cag_surface_lines(s, &edges, err);
  for (int k = 0; !status && k < 2; k++) {
    CagCurve *circle = NULL;
    status = circle_beside(&form, axes, k ? -1 : 1, &circle, err);
    if (!status) status = add_parts(s, circle, &edges, size, &found, err);
    cag_curve_release(circle);
  }
  cag_curve_list_free(&edges);
  // If an edge runs along a circle, the section is traced instead.
  if (status && status != CAG_E_MEMORY) *is = false;
  for (size_t i = 0; *is && !status && i < found.count; i++)
    status = cag_curve_list_add(out, cag_curve_retain(found.items[i]), err);
  cag_curve_list_free(&found);
  return *is ? status : CAG_OK;
}
