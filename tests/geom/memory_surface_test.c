// Tests surfaces of every kind with exhausted memory, with failing functions of the caller, and
// with interrupted work. Each fault is reported, and nothing leaks.

#include <stdio.h>

#include "faults.h"
#include "function_support.h"
#include "geom/curve/function.h"
#include "geom/meet/crossing.h"
#include "geom/meet/curvature_contour.h"
#include "geom/meet/curvature_line.h"
#include "geom/meet/isophote.h"
#include "geom/meet/meet_curve.h"
#include "geom/meet/meet_surface.h"
#include "geom/meet/section.h"
#include "geom/meet/value_map.h"
#include "geom/surface/crease.h"
#include "geom/surface/curve_on.h"
#include "geom/surface/edit.h"
#include "geom/surface/frames.h"
#include "geom/surface/function.h"
#include "geom/surface/loft.h"
#include "geom/surface/mapped.h"
#include "geom/surface/nearest.h"
#include "geom/surface/patches.h"
#include "geom/surface/quadric.h"
#include "geom/surface/reshape.h"
#include "geom/surface/surface.h"
#include "geom/surface/swept.h"
#include "geom/surface/trimmed.h"
#include "geom/tessellate/orient.h"
#include "geom/tessellate/tessellate.h"

// S(u, v) = [u, v, sin(u) cos(v) / 2].
static CagStatus waves_eval(void *context, double u, double v, int n, CagVec3 *out, CagError *e) {
  (void)context;
  const CagStatus status = fault_in_call(e);
  if (status) return status;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++)
      out[cag_partial(n, i, j)] =
          cag_vec3(i + j == 0 ? u : i == 1 && j == 0, i + j == 0 ? v : j == 1 && i == 0,
                   sin(u + i * M_PI / 2) * cos(v + j * M_PI / 2) / 2);
  return CAG_OK;
}
static CagStatus waves_row(void *context, double u, const double *vs, size_t nv, int n,
                           CagVec3 *out, CagError *e) {
  return row_by_points(waves_eval, context, u, vs, nv, n, out, e);
}
static CagStatus wave_eval(void *context, double t, int order, CagVec3 *out, CagError *e) {
  (void)context;
  const CagStatus status = fault_in_call(e);
  if (status) return status;
  for (int k = 0; k <= order; k++)
    out[k] = cag_vec3(k == 0 ? t : k == 1, 2 * (k == 0) + sin(t + k * M_PI / 2) / 2, 0);
  return CAG_OK;
}
static void release_nothing(void *context) { (void)context; }

static CagStatus wave(CagCurve **out, CagError *e) {
  const CagCurveFunction f = {.eval = wave_eval, .release = release_nothing, .context = NULL};
  return cag_curve_function(&f, 2, 0, 2, false, out, e);
}
static CagStatus cubic(double z, CagCurve **out, CagError *e) {
  const CagVec3 p[4] = {{0, 1, z}, {1, 2, z}, {2, 0.5, z}, {3, 2, z}};
  return cag_curve_bezier(p, NULL, 4, z == 0 ? 2 : 3, out, e);
}
static CagStatus bent_path(CagCurve **out, CagError *e) {
  const CagVec3 p[4] = {{0, 0, 0}, {3, 0, 1}, {6, 4, 0}, {9, 4, 3}};
  return cag_curve_bezier(p, NULL, 4, 3, out, e);
}
static CagStatus triangle(double size, CagRegion **out, CagError *e) {
  const CagVec3 p[3] = {{-size, -size, 0}, {size, 0, 0}, {0, size, 0}};
  CagCurve *c;
  CagStatus status = cag_curve_polyline(p, 3, true, 2, &c, e);
  if (status) return status;
  status = cag_region_new(c, NULL, 0, out, e);
  cag_curve_release(c);
  return status;
}
static CagVec3 net_point(size_t i, size_t j) {
  return cag_vec3((double)i, (double)j, (double)((3 * i + 5 * j) % 4) / 2);
}

// The kinds of surfaces, each with the function that makes it.
#define MAKER(name) static CagStatus name(CagSurface **out, CagError *e)
MAKER(plane) {
  return cag_surface_bilinear(cag_vec3(0, 0, 0), cag_vec3(0, 4, 0), cag_vec3(4, 0, 0),
                              cag_vec3(4, 4, 0), out, e);
}
MAKER(bilinear) {
  return cag_surface_bilinear(cag_vec3(0, 0, 0), cag_vec3(0, 4, 1), cag_vec3(4, 0, 1),
                              cag_vec3(4, 4, 0), out, e);
}
static CagStatus net(bool rational, bool creased, CagSurface **out, CagError *e) {
  enum { N = 5 };
  CagVec3 p[N * N];
  double w[N * N];
  const double smooth[9] = {0, 0, 0, 0, 0.5, 1, 1, 1, 1};
  const double broken[8] = {0, 0, 0, 0.5, 0.5, 1, 1, 1};
  for (size_t i = 0; i < N; i++)
    for (size_t j = 0; j < N; j++) {
      p[i * N + j] = net_point(i, j);
      w[i * N + j] = 1 + (double)(i * j % 3) / 2;
    }
  const int degree = creased ? 2 : 3;
  const double *knots = creased ? broken : smooth;
  return cag_surface_nurbs(p, rational ? w : NULL, N, N, degree, degree, knots, knots, out, e);
}
MAKER(bspline) { return net(false, false, out, e); }
MAKER(nurbs) { return net(true, false, out, e); }
MAKER(creased) { return net(false, true, out, e); }
MAKER(bezier) {
  CagVec3 p[9];
  for (size_t i = 0; i < 9; i++) p[i] = net_point(i / 3, i % 3);
  return cag_surface_bezier(p, NULL, 3, 3, out, e);
}
MAKER(periodic) {
  const double knots[8] = {0, 0, 0, 1, 2, 3, 3, 3};
  CagVec3 p[30];
  for (size_t i = 0; i < 6; i++)
    for (size_t j = 0; j < 5; j++) {
      const double a = 2 * M_PI * (double)i / 6;
      p[i * 5 + j] =
          cag_vec3((2 + (double)(j % 2)) * cos(a), (2 + (double)(j % 2)) * sin(a), (double)j);
    }
  return cag_surface_nurbs_closed(p, NULL, 6, 5, 3, 2, NULL, knots, true, false, out, e);
}
MAKER(sphere) {
  const CagTransform frame = cag_transform_identity();
  return cag_surface_quadric(CAG_SHAPE_ELLIPSOID, &frame, 0, 2 * M_PI, 0, M_PI, out, e);
}
MAKER(cylinder) {
  const CagTransform frame = cag_transform_identity();
  return cag_surface_quadric(CAG_SHAPE_ELLIPTIC_CYLINDER, &frame, 0, 2 * M_PI, 0, 2, out, e);
}
MAKER(saddle) {
  const CagTransform frame = cag_transform_identity();
  return cag_surface_quadric(CAG_SHAPE_HYPERBOLIC_PARABOLOID, &frame, -1, 1, -1, 1, out, e);
}
MAKER(torus) { return cag_surface_torus(5, 2, out, e); }
static CagStatus of_curve(CagStatus (*make)(const CagCurve *c, CagSurface **out, CagError *e),
                          CagStatus made, CagCurve *const *c, CagSurface **out, CagError *e) {
  if (made) return made;
  const CagStatus status = make(*c, out, e);
  cag_curve_release(*c);
  return status;
}
static CagStatus turned(const CagCurve *c, CagSurface **out, CagError *e) {
  CagCurve *upright;
  const CagTransform up = {.m = {{1, 0, 0, 4}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
  CagStatus status = cag_curve_transform(c, &up, &upright, e);
  if (status) return status;
  status = cag_surface_revolve(upright, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 4, out, e);
  cag_curve_release(upright);
  return status;
}
static CagStatus pushed(const CagCurve *c, CagSurface **out, CagError *e) {
  return cag_surface_extrude(c, cag_vec3(0.5, 0, 3), 0, 1, out, e);
}
static CagStatus twisted(const CagCurve *c, CagSurface **out, CagError *e) {
  return cag_surface_extrude(c, cag_vec3(0, 0, 3), 1, 0.5, out, e);
}
static CagStatus piped(const CagCurve *c, CagSurface **out, CagError *e) {
  return cag_surface_tube(c, 0.3, out, e);
}
#define FROM(make, curve)                                                                          \
  CagCurve *c;                                                                                     \
  return of_curve(make, curve, &c, out, e)
MAKER(revolution) { FROM(turned, cubic(0, &c, e)); }
MAKER(revolution_of_function) { FROM(turned, wave(&c, e)); }
MAKER(extrusion) { FROM(pushed, cubic(0, &c, e)); }
MAKER(extrusion_of_function) { FROM(pushed, wave(&c, e)); }
MAKER(twist) { FROM(twisted, cubic(0, &c, e)); }
MAKER(tube) { FROM(piped, bent_path(&c, e)); }
static CagStatus of_two(CagStatus (*make)(const CagCurve *a, const CagCurve *b, CagSurface **out,
                                          CagError *e),
                        bool formula, CagSurface **out, CagError *e) {
  CagCurve *a = NULL, *b = NULL, *flat = NULL;
  CagStatus status = cubic(2, &a, e);
  if (!status && formula) {
    status = wave(&flat, e);
    if (!status) status = cag_curve_to_space(flat, &b, e);
  } else if (!status) {
    status = cubic(3, &b, e);
  }
  if (!status) status = make(a, b, out, e);
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(flat);
  return status;
}
static CagStatus lofted(const CagCurve *a, const CagCurve *b, CagSurface **out, CagError *e) {
  const CagCurve *curves[3];
  CagCurve *c;
  CagStatus status = cubic(5, &c, e);
  if (status) return status;
  curves[0] = b, curves[1] = a, curves[2] = c;
  status = cag_surface_loft(curves, 3, 2, false, out, e);
  cag_curve_release(c);
  return status;
}
MAKER(ruled) { return of_two(cag_surface_ruled, false, out, e); }
MAKER(ruled_to_function) { return of_two(cag_surface_ruled, true, out, e); }
MAKER(translational) { return of_two(cag_surface_translational, false, out, e); }
MAKER(translated_function) { return of_two(cag_surface_translational, true, out, e); }
MAKER(loft) { return of_two(lofted, false, out, e); }
MAKER(loft_of_function) { return of_two(lofted, true, out, e); }
MAKER(developable) { return of_two(cag_surface_developable, false, out, e); }
MAKER(function) {
  const CagSurfaceFunction f = {
      .eval = waves_eval, .eval_row = waves_row, .release = release_nothing, .context = NULL};
  return cag_surface_function(&f, 0, 3, false, 0, 3, false, out, e);
}
MAKER(planar) {
  CagRegion *r;
  CagStatus status = triangle(2, &r, e);
  if (status) return status;
  const CagTransform frame = cag_rpy(0.2, 0.1, 0.3);
  status = cag_surface_planar(r, &frame, out, e);
  cag_region_release(r);
  return status;
}
static CagStatus trim(CagStatus (*make)(CagSurface **out, CagError *e), CagVec3 center,
                      CagSurface **out, CagError *e) {
  CagSurface *s = NULL;
  CagRegion *r = NULL, *moved = NULL;
  const CagTransform t = cag_translate(center);
  CagTransform flat = t;
  flat.planar = true;
  CagStatus status = make(&s, e);
  if (!status) status = triangle(0.3, &r, e);
  if (!status) status = cag_region_transform(r, &flat, &moved, e);
  if (!status) status = cag_surface_trimmed(s, moved, out, e);
  cag_surface_release(s);
  cag_region_release(r);
  cag_region_release(moved);
  return status;
}
MAKER(trimmed) { return trim(bspline, cag_vec3(0.5, 0.4, 0), out, e); }
MAKER(trimmed_sphere) { return trim(sphere, cag_vec3(1, 1.5, 0), out, e); }
MAKER(trimmed_function) { return trim(function, cag_vec3(1, 1.5, 0), out, e); }
static CagStatus sweep(CagOrient orient, CagSurface **out, CagError *e) {
  CagCurve *path = NULL, *section = NULL;
  CagMotion *motion = NULL;
  const CagTransform frame = cag_transform_identity();
  const CagPathMotion how = {
      .orient = orient, .up = {0, 0, 1}, .twist = {0, 1, NULL}, .scale = {1, 0.5, NULL}};
  CagStatus status = bent_path(&path, e);
  if (!status) status = cag_curve_arc(0.5, 0.3, 0, 2 * M_PI, &frame, &section, e);
  if (!status) status = cag_motion_along(path, &how, &motion, e);
  if (!status) status = cag_surface_sweep(section, motion, out, e);
  cag_curve_release(path);
  cag_curve_release(section);
  cag_motion_release(motion);
  return status;
}
MAKER(swept) { return sweep(CAG_ORIENT_RMF, out, e); }
MAKER(swept_upright) { return sweep(CAG_ORIENT_UP, out, e); }
static CagStatus derive(CagStatus (*make)(CagSurface **out, CagError *e),
                        CagStatus (*change)(const CagSurface *s, CagSurface **out, CagError *e),
                        CagSurface **out, CagError *e) {
  CagSurface *s;
  CagStatus status = make(&s, e);
  if (status) return status;
  status = change(s, out, e);
  cag_surface_release(s);
  return status;
}
static CagStatus moved_out(const CagSurface *s, CagSurface **out, CagError *e) {
  return cag_surface_offset(s, 0.1, out, e);
}
static CagStatus placed(const CagSurface *s, CagSurface **out, CagError *e) {
  const CagTransform t = cag_shear(0.3, -0.2, 0.5, 0.1, 0, 0.4);
  return cag_surface_transform(s, &t, out, e);
}
MAKER(offset) { return derive(bspline, moved_out, out, e); }
MAKER(offset_of_function) { return derive(function, moved_out, out, e); }
MAKER(transposed) { return derive(tube, cag_surface_transpose, out, e); }
MAKER(placed_tube) { return derive(tube, placed, out, e); }
MAKER(flipped_function) { return derive(function, cag_surface_flip, out, e); }
MAKER(coons) {
  CagCurve *c[4] = {0};
  const CagVec3 corner[4] = {{0, 0, 0}, {4, 0, 1}, {0, 4, 1}, {4, 4, 0}};
  static const int ENDS[4][2] = {{0, 2}, {1, 3}, {0, 1}, {2, 3}};
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 4; k++) {
    const CagVec3 a = corner[ENDS[k][0]], b = corner[ENDS[k][1]];
    const CagVec3 p[3] = {a, cag_add(cag_lerp(a, b, 0.5), cag_vec3(0, 0, 1)), b};
    status = cag_curve_bezier(p, NULL, 3, 3, &c[k], e);
  }
  if (!status) status = cag_surface_coons(c[0], c[1], c[2], c[3], out, e);
  for (int k = 0; k < 4; k++) cag_curve_release(c[k]);
  return status;
}

typedef struct Kind {
  const char *name;
  CagStatus (*make)(CagSurface **out, CagError *e);
  bool quick; // slow operations are tested with it
} Kind;
#define ROW(name)                                                                                  \
  { #name, name, false }
#define MARKED(name)                                                                               \
  { #name, name, true }
static const Kind KINDS[] = {
    MARKED(plane),
    ROW(bilinear),
    ROW(bspline),
    ROW(nurbs),
    MARKED(creased),
    MARKED(bezier),
    ROW(periodic),
    ROW(sphere),
    MARKED(cylinder),
    ROW(saddle),
    ROW(torus),
    ROW(revolution),
    ROW(revolution_of_function),
    MARKED(extrusion),
    ROW(extrusion_of_function),
    ROW(twist),
    ROW(tube),
    ROW(ruled),
    ROW(ruled_to_function),
    ROW(translational),
    MARKED(translated_function),
    ROW(loft),
    ROW(loft_of_function),
    ROW(developable),
    MARKED(function),
    ROW(planar),
    MARKED(trimmed),
    ROW(trimmed_sphere),
    ROW(trimmed_function),
    ROW(swept),
    ROW(swept_upright),
    ROW(offset),
    ROW(offset_of_function),
    ROW(transposed),
    ROW(placed_tube),
    ROW(flipped_function),
    ROW(coons),
};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

static double along_u(const CagSurface *s, double f) { return s->u0 + f * (s->u1 - s->u0); }
static double along_v(const CagSurface *s, double f) { return s->v0 + f * (s->v1 - s->v0); }

// Operations on one surface. Each operation releases its result.
#define QUESTION(name) static CagStatus name(const void *given, CagError *e)
#define SURFACE const CagSurface *s = given
#define FOUND(call, ...)                                                                           \
  const CagStatus status = call;                                                                   \
  if (!status) fault_found(__VA_ARGS__);                                                           \
  return status
// Takes the address because the caller evaluates it before the call that makes the surface.
static CagStatus drop(CagStatus status, CagSurface *const *made) {
  if (status) return status;
  const Fault kind = fault.kind;
  fault.kind = FAULT_NONE;
  CagVec3 p;
  CagError e;
  if (!cag_surface_point(*made, along_u(*made, 0.4), along_v(*made, 0.7), &p, &e))
    fault_found(p.x + p.y + p.z);
  fault.kind = kind;
  cag_surface_release(*made);
  return status;
}
static CagStatus drop_curve(CagStatus status, CagCurve *const *made) {
  if (status) return status;
  fault_found((*made)->end);
  cag_curve_release(*made);
  return status;
}
static CagStatus drop_mesh(CagStatus status, CagMesh *const *made) {
  if (status) return status;
  fault_found((double)(*made)->triangle_count);
  cag_mesh_release(*made);
  return status;
}
static CagStatus drop_list(CagStatus status, CagCurveList *list) {
  if (!status) fault_found((double)list->count);
  cag_curve_list_free(list);
  return status;
}

QUESTION(partials) {
  SURFACE;
  CagVec3 d[25];
  FOUND(
      cag_surface_eval(s, along_u(s, 0.3), along_v(s, 0.6), 4, CAG_SIDE_LEFT, CAG_SIDE_RIGHT, d, e),
      d[1].x);
}
QUESTION(grid) {
  SURFACE;
  CagVec3 p[16], du[16], dv[16];
  double us[4], vs[4];
  for (int i = 0; i < 4; i++) us[i] = along_u(s, i / 3.0), vs[i] = along_v(s, i / 3.0);
  FOUND(cag_surface_eval_grid(s, us, 4, vs, 4, p, du, dv, e), p[7].x + du[5].y);
}
QUESTION(frames) {
  SURFACE;
  CagVec3 p[16], n[16];
  double us[4], vs[4];
  for (int i = 0; i < 4; i++) us[i] = along_u(s, i / 3.0), vs[i] = along_v(s, i / 3.0);
  FOUND(cag_surface_eval_frames(s, us, 4, vs, 4, p, NULL, NULL, n, e), n[7].x);
}
QUESTION(normal) {
  SURFACE;
  CagVec3 n;
  FOUND(cag_surface_normal(s, s->u0, s->v0, &n, e), n.x);
}
QUESTION(bounds) {
  SURFACE;
  CagBounds b;
  FOUND(cag_surface_bounds(s, &b, e), b.max.x + b.min.z);
}
QUESTION(area) {
  SURFACE;
  double a;
  CagVec3 center;
  FOUND(cag_surface_area(s, &a, &center, e), a);
}
QUESTION(volume_terms) {
  SURFACE;
  double terms[10] = {0};
  FOUND(cag_surface_volume_terms(s, terms, e), terms[0]);
}
QUESTION(to_nurbs) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_to_nurbs(s, &made, e), &made);
}
QUESTION(moved) {
  SURFACE;
  CagSurface *made;
  const CagTransform t = cag_rpy(1, 2, 3);
  return drop(cag_surface_transform(s, &t, &made, e), &made);
}
QUESTION(mirrored_and_sheared) {
  SURFACE;
  CagSurface *made;
  CagTransform t = cag_shear(0.5, 0, 0.2, 0, 0.1, 0);
  t.m[2][2] = -1;
  return drop(cag_surface_transform(s, &t, &made, e), &made);
}
QUESTION(seen_from_a_point) {
  SURFACE;
  CagSurface *made;
  CagTransform t = cag_transform_identity();
  t.m[3][0] = 0.01;
  t.m[3][3] = 3;
  return drop(cag_surface_transform(s, &t, &made, e), &made);
}
QUESTION(flip) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_flip(s, &made, e), &made);
}
QUESTION(transpose) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_transpose(s, &made, e), &made);
}
QUESTION(part) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_part(s, along_u(s, 0.2), along_u(s, 0.7), along_v(s, 0.1),
                               along_v(s, 0.6), &made, e),
              &made);
}
QUESTION(offset_of_it) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_offset(s, 0.05, &made, e), &made);
}
QUESTION(unroll) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_unroll(s, &made, e), &made);
}
QUESTION(outward) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_outward(s, &made, e), &made);
}
QUESTION(trimmed_by_a_disk) {
  SURFACE;
  CagSurface *made;
  CagCurve *c;
  CagRegion *r = NULL;
  CagTransform frame = cag_transform_identity();
  frame.m[0][3] = along_u(s, 0.5), frame.m[1][3] = along_v(s, 0.5);
  CagStatus status =
      cag_curve_arc(0.3 * (s->u1 - s->u0), 0.3 * (s->v1 - s->v0), 0, 2 * M_PI, &frame, &c, e);
  if (status) return status;
  status = cag_region_new(c, NULL, 0, &r, e);
  cag_curve_release(c);
  if (!status) status = cag_surface_trimmed(s, r, &made, e);
  cag_region_release(r);
  return drop(status, &made);
}
QUESTION(insert_knot) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_insert_knot(s, 0, along_u(s, 0.37), 2, &made, e), &made);
}
QUESTION(refine) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_refine(s, true, true, &made, e), &made);
}
QUESTION(elevate) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_elevate(s, 1, 2, &made, e), &made);
}
QUESTION(to_bezier) {
  SURFACE;
  CagSurface **made;
  size_t nu, nv;
  const CagStatus status = cag_surface_to_bezier(s, &made, &nu, &nv, e);
  if (status) return status;
  fault_found((double)(nu + nv));
  for (size_t i = 0; i < nu * nv; i++) cag_surface_release(made[i]);
  free(made);
  return CAG_OK;
}
QUESTION(isocurve_of_u) {
  SURFACE;
  CagCurve *made;
  return drop_curve(cag_surface_isocurve(s, 0, along_u(s, 0.3), &made, e), &made);
}
QUESTION(isocurve_of_v) {
  SURFACE;
  CagCurve *made;
  return drop_curve(cag_surface_isocurve(s, 1, along_v(s, 0.3), &made, e), &made);
}
QUESTION(curve_on_it) {
  SURFACE;
  CagCurve *c, *made;
  CagStatus status = cag_curve_line(cag_vec3(along_u(s, 0.1), along_v(s, 0.2), 0),
                                    cag_vec3(along_u(s, 0.9), along_v(s, 0.7), 0), 2, &c, e);
  if (status) return status;
  status = cag_curve_on_surface(s, c, &made, e);
  cag_curve_release(c);
  return drop_curve(status, &made);
}
QUESTION(corners) {
  SURFACE;
  CagHermiteCorners c;
  FOUND(cag_surface_corners(s, &c, e), c.p[0][1].x);
}
QUESTION(set_point) {
  SURFACE;
  CagSurface *made;
  return drop(cag_surface_set_point(s, 1, 1, cag_vec3(1, 1, 1), 2, &made, e), &made);
}
QUESTION(edit_corner) {
  SURFACE;
  CagSurface *made;
  const CagCornerEdit edit = {
      1, 0, {false, true, false}, {2, 1, 0.5}, {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}}};
  return drop(cag_surface_edit_corner(s, &edit, &made, e), &made);
}
QUESTION(join_lines) {
  SURFACE;
  double *lines;
  size_t count;
  const CagEdgeMatch how = {1, {0, 0}};
  const CagStatus status = cag_surface_join_lines(s, 1, 3, &how, &lines, &count, e);
  if (status) return status;
  fault_found(lines[0]);
  free(lines);
  return CAG_OK;
}
QUESTION(creases) {
  SURFACE;
  CagCrease *found;
  size_t n;
  const CagStatus status = cag_surface_creases(s, 0, &found, &n, e);
  if (status) return status;
  fault_found((double)n);
  free(found);
  return CAG_OK;
}
QUESTION(patches) {
  SURFACE;
  CagPatches p;
  const CagStatus status = cag_patches_open(s, &p, e);
  if (status) return status;
  fault_found((double)p.n[0]);
  cag_patches_free(&p);
  return CAG_OK;
}
QUESTION(closest) {
  SURFACE;
  CagSurfaceNearest at;
  FOUND(cag_surface_closest(s, cag_vec3(1, 2, 3), &at, e), at.u);
}
QUESTION(principal) {
  SURFACE;
  CagPrincipal p;
  bool found;
  FOUND(cag_surface_principal(s, along_u(s, 0.3), along_v(s, 0.4), &found, &p, e), found);
}
QUESTION(section) {
  SURFACE;
  CagCurveList list = {0};
  CagPlane plane = {{0, 0, 0}, {0.48, 0.6, 0.64}};
  CagStatus status = cag_surface_point(s, along_u(s, 0.37), along_v(s, 0.41), &plane.point, e);
  if (!status) status = cag_surface_section(s, &plane, 1e-2, &list, e);
  return drop_list(status, &list);
}
QUESTION(contour) {
  SURFACE;
  CagCurveList list = {0};
  const CagStatus status =
      cag_surface_contour(s, cag_vec3(0.8, 0, 0.6), cag_vec3(0, 0, 0), false, 1e-2, &list, e);
  return drop_list(status, &list);
}
QUESTION(contour_from_a_point) {
  SURFACE;
  CagCurveList list = {0};
  const CagStatus status =
      cag_surface_contour(s, cag_vec3(0, 0, 0), cag_vec3(20, 30, 9), true, 1e-2, &list, e);
  return drop_list(status, &list);
}
QUESTION(isophote) {
  SURFACE;
  CagCurveList list = {0};
  return drop_list(cag_surface_isophote(s, cag_vec3(0.8, 0, 0.6), 0.7, 1e-2, &list, e), &list);
}
QUESTION(curvature_contour) {
  SURFACE;
  CagCurveList list = {0};
  bool everywhere;
  return drop_list(
      cag_surface_curvature_contour(s, CAG_CURVATURE_MEAN, 0.1, 1e-1, &list, &everywhere, e),
      &list);
}
QUESTION(curvature_line) {
  SURFACE;
  CagCurve *made;
  return drop_curve(
      cag_surface_curvature_line(s, along_u(s, 0.4), along_v(s, 0.45), true, &made, e), &made);
}
QUESTION(crosses_itself) {
  SURFACE;
  char what[200];
  (void)e;
  fault_found(cag_surface_crosses_itself(s, what, sizeof what));
  return CAG_OK;
}
QUESTION(tessellate) {
  SURFACE;
  CagMesh *made;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 0.2;
  how.angle = 1;
  return drop_mesh(cag_surface_tessellate(s, &how, &made, e), &made);
}
QUESTION(value_mesh) {
  SURFACE;
  CagMesh *made;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  how.tolerance = 0.3;
  how.angle = 1;
  return drop_mesh(cag_surface_value_mesh(s, CAG_VALUE_MEAN, &how, &made, e), &made);
}
QUESTION(where_a_line_meets_it) {
  SURFACE;
  CagCurve *c;
  CagSurfaceMeeting *at;
  size_t n;
  CagVec3 p;
  CagStatus status = cag_surface_point(s, along_u(s, 0.37), along_v(s, 0.41), &p, e);
  if (!status)
    status =
        cag_curve_line(cag_sub(p, cag_vec3(1, 0.3, 9)), cag_add(p, cag_vec3(1, 0.3, 9)), 3, &c, e);
  if (status) return status;
  status = cag_surface_intersect_curve(s, c, &at, &n, e);
  cag_curve_release(c);
  if (status) return status;
  fault_found((double)n);
  free(at);
  return CAG_OK;
}
QUESTION(mesh_laid_on_it) {
  SURFACE;
  CagMesh *m, *made;
  CagStatus status = cag_mesh_new(3, 1, false, false, false, &m, e);
  if (status) return status;
  m->positions[0] = cag_vec3(along_u(s, 0.2), along_v(s, 0.2), 0);
  m->positions[1] = cag_vec3(along_u(s, 0.6), along_v(s, 0.2), 0.1);
  m->positions[2] = cag_vec3(along_u(s, 0.3), along_v(s, 0.6), 0);
  for (uint32_t i = 0; i < 3; i++) m->triangles[i] = i;
  status = cag_mesh_onto_surface(m, s, 0.2, false, 100000, &made, e);
  cag_mesh_release(m);
  return drop_mesh(status, &made);
}

typedef struct Question {
  const char *name;
  FaultyOperation ask;
  bool slow;
} Question;
static const Question QUESTIONS[] = {
    ROW(partials),
    ROW(grid),
    ROW(frames),
    ROW(normal),
    ROW(bounds),
    ROW(area),
    ROW(volume_terms),
    ROW(to_nurbs),
    ROW(moved),
    ROW(mirrored_and_sheared),
    ROW(seen_from_a_point),
    ROW(flip),
    ROW(transpose),
    ROW(part),
    ROW(offset_of_it),
    ROW(unroll),
    ROW(outward),
    ROW(trimmed_by_a_disk),
    ROW(insert_knot),
    ROW(refine),
    ROW(elevate),
    ROW(to_bezier),
    ROW(isocurve_of_u),
    ROW(isocurve_of_v),
    ROW(curve_on_it),
    ROW(corners),
    ROW(set_point),
    ROW(edit_corner),
    ROW(join_lines),
    ROW(creases),
    ROW(patches),
    MARKED(closest),
    ROW(principal),
    MARKED(section),
    MARKED(contour),
    MARKED(contour_from_a_point),
    MARKED(isophote),
    MARKED(curvature_contour),
    MARKED(curvature_line),
    ROW(crosses_itself),
    MARKED(tessellate),
    MARKED(value_mesh),
    MARKED(where_a_line_meets_it),
    ROW(mesh_laid_on_it),
};

static CagStatus make_kind(const void *given, CagError *e) {
  const Kind *kind = given;
  CagSurface *s;
  return drop(kind->make(&s, e), &s);
}
static void making_a_surface_reports_faults(void **state) {
  (void)state;
  for (int k = 0; k < KIND_COUNT; k++) try_faults("making", KINDS[k].name, make_kind, &KINDS[k]);
  assert_int_equal(fault_problems, 0);
}

static void questions_to_a_surface_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  for (int k = 0; k < KIND_COUNT; k++) {
    CagSurface *s;
    OK(KINDS[k].make(&s, &err));
    for (size_t q = 0; q < sizeof QUESTIONS / sizeof *QUESTIONS; q++) {
      if (QUESTIONS[q].slow && !KINDS[k].quick) continue;
      fault_steps = QUESTIONS[q].slow ? FAULTS_OF_SLOW : FAULTS_OF_QUICK;
      try_faults(QUESTIONS[q].name, KINDS[k].name, QUESTIONS[q].ask, s);
    }
    cag_surface_release(s);
  }
  assert_int_equal(fault_problems, 0);
}

// These have their own cells, and are not among the quick kinds.
static void nearest_points_of_swept_surfaces_report_faults(void **state) {
  (void)state;
  fault_problems = 0;
  fault_steps = FAULTS_OF_QUICK;
  int found = 0;
  for (int k = 0; k < KIND_COUNT; k++) {
    const char *name = KINDS[k].name;
    if (strcmp(name, "tube") && strcmp(name, "twist") && strncmp(name, "swept", 5)) continue;
    CagSurface *s;
    OK(KINDS[k].make(&s, &err));
    try_faults("closest", name, closest, s);
    cag_surface_release(s);
    found++;
  }
  assert_int_equal(found, 4);
  assert_int_equal(fault_problems, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(making_a_surface_reports_faults),
      cmocka_unit_test(questions_to_a_surface_report_faults),
      cmocka_unit_test(nearest_points_of_swept_surfaces_report_faults),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
