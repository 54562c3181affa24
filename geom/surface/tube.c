// Sweeps and tubes: S(u, v) = origin(v) + x(u) X(v) + y(u) Y(v) + z(u) Z(v).
//
// A tube is the sweep of a circle without twist, scaled by the radius if that varies.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/surface/family.h"
#include "geom/surface/swept.h"

typedef struct Sweep {
  CagSurface base;
  CagCurve *section; // as given: dimension 2 or 3
  CagMotion *motion;
  CagCurve *center; // for a tube of constant radius; otherwise NULL
  double radius;
} Sweep;

static const CagSurfaceKind sweep_kind, tube_kind;

static CagVec3 carried(CagVec3 p, const CagMotionSeries *f, int j) {
  return cag_madd(cag_madd(cag_scaled(f->x[j], p.x), p.y, f->y[j]), p.z, f->z[j]);
}

static CagStatus sweep_eval(const CagSurface *surface, double u, double v, int n, CagSide su,
                            CagSide sv, CagVec3 *out, CagError *err) {
  const Sweep *s = (const Sweep *)surface;
  CagVec3 c[CAG_MAX_PARTIAL + 1];
  CagMotionSeries f;
  CagStatus status = cag_curve_eval(s->section, u, n, su, c, err);
  if (!status) status = cag_motion_at(s->motion, v, n, sv, &f, err);
  if (status) return status;
  for (int i = 0; i <= n; i++) {
    double factorial = 1;
    for (int j = 0; i + j <= n; j++) {
      if (j > 0) factorial *= j;
      CagVec3 p = carried(c[i], &f, j);
      if (i == 0) p = cag_add(p, f.origin[j]);
      out[cag_partial(n, i, j)] = cag_scaled(p, factorial);
    }
  }
  return CAG_OK;
}

static CagStatus sweep_grid(const CagSurface *surface, const double *us, size_t nu,
                            const double *vs, size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                            CagError *err) {
  const Sweep *s = (const Sweep *)surface;
  CagVec3 *c = cag_malloc((2 * nu + 1) * sizeof *c);
  if (!c) return cag_fail_memory(err);
  CagStatus status = cag_curve_eval_many(s->section, us, nu, 1, c, err);
  for (size_t j = 0; !status && j < nv; j++) {
    CagMotionSeries f;
    CagSide side = vs[j] >= surface->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    status = cag_motion_at(s->motion, vs[j], dv ? 1 : 0, side, &f, err);
    for (size_t i = 0; !status && i < nu; i++) {
      size_t at = i * nv + j;
      points[at] = cag_add(f.origin[0], carried(c[2 * i], &f, 0));
      if (du) du[at] = carried(c[2 * i + 1], &f, 0);
      if (dv) dv[at] = cag_add(f.origin[1], carried(c[2 * i], &f, 1));
    }
  }
  cag_free(c);
  return status;
}

static size_t sweep_breaks(const CagSurface *surface, int direction, double *out, size_t capacity) {
  const Sweep *s = (const Sweep *)surface;
  if (direction == 1) return cag_motion_breaks(s->motion, out, capacity);
  return s->section->kind->breaks ? s->section->kind->breaks(s->section, out, capacity) : 0;
}

static void sweep_describe(const CagSurface *surface, char *buffer, size_t size) {
  const Sweep *s = (const Sweep *)surface;
  static const char *const orients[] = {"", ", Frenet frame", ", fixed", ", upright"};
  const CagCurve *path = cag_motion_path(s->motion);
  if (!path) {
    snprintf(buffer, size, "of %s %s by transforms", cag_article(s->section->kind->name),
             s->section->kind->name);
    return;
  }
  snprintf(buffer, size, "of %s %s along %s %s%s", cag_article(s->section->kind->name),
           s->section->kind->name, cag_article(path->kind->name), path->kind->name,
           orients[cag_motion_how(s->motion)->orient]);
}

static void tube_describe(const CagSurface *surface, char *buffer, size_t size) {
  const Sweep *s = (const Sweep *)surface;
  const CagCurve *path = cag_motion_path(s->motion);
  double a, b;
  CagTransform frame;
  char text[32];
  cag_curve_arc_view(s->section, &a, &b, &frame);
  if (cag_motion_is_plain(s->motion))
    snprintf(buffer, size, "along %s %s, radius %s", cag_article(path->kind->name),
             path->kind->name, cag_number_text(a, text));
  else
    snprintf(buffer, size, "along %s %s, radius changing", cag_article(path->kind->name),
             path->kind->name);
}

static void sweep_destroy(CagSurface *surface) {
  Sweep *s = (Sweep *)surface;
  cag_curve_release(s->section);
  cag_motion_release(s->motion);
  cag_curve_release(s->center);
}

// --- Exact forms ---

static bool is_untwisted(const CagMotion *m) {
  const CagPathMotion *how = cag_motion_how(m);
  return cag_motion_path(m) && !how->twist.function && how->twist.start == 0 && how->twist.end == 0;
}

// Whether every smooth piece of the path is straight (a line, or a polyline).
static bool is_straight(const CagCurve *path) {
  const CagVec3 *points;
  size_t n;
  bool closed;
  return cag_curve_vertices(path, &points, &n, &closed);
}

static CagStatus rows_to_nurbs(const Sweep *s, const CagNurbsView *c, size_t rows,
                               const double *cuts, CagSurface **out, CagError *err) {
  double *net = cag_malloc(c->count * rows * 4 * sizeof *net),
         *knots = cag_malloc((rows + 2) * sizeof *knots);
  CagStatus status = net && knots ? CAG_OK : cag_fail_memory(err);
  for (size_t j = 0; !status && j < rows; j++) {
    CagTransform frame;
    status = cag_motion_frame(s->motion, cuts[j], &frame, err);
    for (size_t i = 0; !status && i < c->count; i++)
      cag_transform_homogeneous(&frame, c->homogeneous + 4 * i, net + 4 * (i * rows + j));
    knots[j + 1] = cuts[j];
  }
  if (!status) {
    knots[0] = cuts[0];
    knots[rows + 1] = cuts[rows - 1];
    status =
        cag_surface_from_homogeneous(net, c->count, rows, c->degree, 1, c->knots, knots, out, err);
  }
  cag_free(net);
  cag_free(knots);
  return status;
}

// Along straight pieces the section moves linearly from frame to frame.
static CagStatus straight_to_nurbs(const Sweep *s, CagSurface **out, CagError *err) {
  size_t inner = cag_motion_breaks(s->motion, NULL, 0);
  double *cuts = cag_malloc((inner + 2) * sizeof *cuts);
  if (!cuts) return cag_fail_memory(err);
  cuts[0] = s->base.v0;
  cag_motion_breaks(s->motion, cuts + 1, inner);
  cuts[inner + 1] = s->base.v1;
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(s->section, &exact, err);
  if (!status) {
    CagNurbsView c;
    cag_curve_nurbs_view(exact, &c);
    status = rows_to_nurbs(s, &c, inner + 2, cuts, out, err);
    cag_curve_release(exact);
  }
  cag_free(cuts);
  return status;
}

static CagStatus placed_section(const Sweep *s, CagCurve **out, CagError *err) {
  CagTransform frame;
  CagCurve *space;
  CagStatus status = cag_motion_frame(s->motion, s->base.v0, &frame, err);
  if (!status) status = cag_surface_space_curve(s->section, &space, err);
  if (status) return status;
  status = cag_curve_transform(space, &frame, out, err);
  cag_curve_release(space);
  return status;
}

// A section that is fixed in the frame of a circle is revolved about the circle's axis.
static CagStatus round_to_nurbs(const Sweep *s, const CagCurve *path, const CagTransform *circle,
                                CagSurface **out, CagError *err) {
  CagCurve *section;
  CagSurface *turned;
  CagStatus status = placed_section(s, &section, err);
  if (status) return status;
  CagVec3 x = cag_transform_vector(circle, cag_vec3(1, 0, 0));
  CagVec3 y = cag_transform_vector(circle, cag_vec3(0, 1, 0));
  status =
      cag_surface_revolve(section, cag_cross(x, y), cag_transform_point(circle, cag_vec3(0, 0, 0)),
                          0, path->end - path->start, &turned, err);
  cag_curve_release(section);
  if (status) return status;
  status = cag_surface_to_nurbs(turned, out, err);
  cag_surface_release(turned);
  return status;
}

static CagStatus fixed_to_nurbs(const Sweep *s, const CagCurve *path, CagSurface **out,
                                CagError *err) {
  CagCurve *section;
  CagSurface *sum;
  CagStatus status = placed_section(s, &section, err);
  if (status) return status;
  status = cag_surface_translational(section, path, &sum, err);
  cag_curve_release(section);
  if (status) return status;
  status = cag_surface_to_nurbs(sum, out, err);
  cag_surface_release(sum);
  return status;
}

static CagStatus sweep_to_nurbs(const CagSurface *surface, CagSurface **out, CagError *err) {
  const Sweep *s = (const Sweep *)surface;
  const CagCurve *path = cag_motion_path(s->motion);
  if (path && is_untwisted(s->motion)) {
    const CagPathMotion *how = cag_motion_how(s->motion);
    double a, b;
    CagTransform circle;
    if (!how->scale.function && is_straight(path)) return straight_to_nurbs(s, out, err);
    if (cag_motion_is_plain(s->motion) && how->orient == CAG_ORIENT_FIXED)
      return fixed_to_nurbs(s, path, out, err);
    if (cag_motion_is_plain(s->motion) && how->orient != CAG_ORIENT_UP &&
        cag_curve_arc_view(path, &a, &b, &circle) && a == b)
      return round_to_nurbs(s, path, &circle, out, err);
  }
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "path", -1,
                  "%s %s has an exact NURBS form only without twist along straight pieces, "
                  "unscaled along an arc, or fixed; approximate it to a tolerance",
                  cag_article(surface->kind->name), surface->kind->name);
}

// --- Construction ---

static void sweep_digest(const CagSurface *surface, CagDigest *d) {
  const Sweep *s = (const Sweep *)surface;
  cag_curve_digest(s->section, d);
  cag_motion_digest(s->motion, d);
}

static const CagSurfaceKind sweep_kind = {
    .name = "sweep",
    .eval = sweep_eval,
    .eval_grid = sweep_grid,
    .to_nurbs = sweep_to_nurbs,
    .breaks = sweep_breaks,
    .describe = sweep_describe,
    .destroy = sweep_destroy,
    .digest = sweep_digest,
};

static const CagSurfaceKind tube_kind = {
    .name = "tube",
    .eval = sweep_eval,
    .eval_grid = sweep_grid,
    .to_nurbs = sweep_to_nurbs,
    .breaks = sweep_breaks,
    .describe = tube_describe,
    .destroy = sweep_destroy,
    .digest = sweep_digest,
};

static CagStatus make(const CagSurfaceKind *kind, const CagCurve *section, const CagMotion *motion,
                      CagSurface **out, CagError *err) {
  double start, end;
  bool angular;
  cag_motion_domain(motion, &start, &end, &angular);
  CagSurface *surface;
  CagStatus status = cag_surface_block(sizeof(Sweep), kind, section->start, section->end, start,
                                       end, &surface, err);
  if (status) return status;
  Sweep *s = (Sweep *)surface;
  s->section = cag_curve_retain(section);
  s->motion = cag_motion_retain(motion);
  surface->angular_u = section->angular;
  surface->angular_v = angular;
  cag_surface_judge(surface);
  *out = surface;
  return CAG_OK;
}

// A space section with nonzero z leaves the plane in which mitered pieces meet.
static CagStatus check_plane(const CagCurve *section, const CagMotion *motion, CagError *err) {
  if (section->dimension == 2 || !cag_motion_has_corner(motion)) return CAG_OK;
  CagBounds box;
  CagStatus status = cag_curve_bounds(section, &box, err);
  if (status) return status;
  double size = cag_norm(cag_sub(box.max, box.min));
  char low[32], high[32];
  if (fmax(fabs(box.min.z), fabs(box.max.z)) <= CAG_SURFACE_SAME * size) return CAG_OK;
  return cag_fail(
      err, CAG_E_ARGUMENT, CAG_ERR_section_not_plane, "section", -1,
      "the section must lie in z = 0 to pass a corner of `path`: its z ranges from %s to %s",
      cag_number_text(box.min.z, low), cag_number_text(box.max.z, high));
}

CagStatus cag_surface_sweep(const CagCurve *section, const CagMotion *motion, CagSurface **out,
                            CagError *err) {
  CagStatus status = check_plane(section, motion, err);
  return status ? status : make(&sweep_kind, section, motion, out, err);
}

static CagStatus circle(double radius, CagCurve **out, CagError *err) {
  CagTransform plane = cag_transform_identity();
  return cag_curve_arc(radius, radius, 0, 2 * M_PI, &plane, out, err);
}

static CagStatus tube_of(const CagCurve *path, double radius, const CagAlong *scale,
                         CagSurface **out, CagError *err) {
  CagPathMotion how = {.orient = CAG_ORIENT_RMF, .scale = *scale};
  CagMotion *motion;
  CagCurve *section;
  CagStatus status = cag_motion_along(path, &how, &motion, err);
  if (status) return status;
  status = circle(radius, &section, err);
  if (!status) {
    status = make(&tube_kind, section, motion, out, err);
    cag_curve_release(section);
  }
  cag_motion_release(motion);
  return status;
}

CagStatus cag_surface_tube(const CagCurve *path, double radius, CagSurface **out, CagError *err) {
  char text[32];
  if (!(radius > 0) || !isfinite(radius))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, "radius", -1,
                    "`radius` must be positive, found %s", cag_number_text(radius, text));
  CagAlong one = {1, 1, NULL};
  CagStatus status = tube_of(path, radius, &one, out, err);
  if (status) return status;
  Sweep *s = (Sweep *)*out;
  s->center = cag_curve_retain(path);
  s->radius = radius;
  return CAG_OK;
}

bool cag_surface_tube_view(const CagSurface *surface, const CagCurve **center, double *radius) {
  const Sweep *s = (const Sweep *)surface;
  if (surface->kind != &tube_kind || !s->center || cag_motion_has_corner(s->motion)) return false;
  *center = s->center;
  *radius = s->radius;
  return true;
}

CagStatus cag_surface_tube_along(const CagCurve *path, const CagAlong *radius, CagSurface **out,
                                 CagError *err) {
  CagStatus status = tube_of(path, 1, radius, out, err);
  if (status && strcmp(err->argument, "scale") == 0) {
    char at[sizeof err->message];
    const char *where = strstr(err->message, ": at ");
    snprintf(at, sizeof at, "%s", where ? where : "");
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, "radius", -1,
                    "`radius` must be positive along the path (0 only at an end)%s", at);
  }
  return status;
}

bool cag_surface_swept_view(const CagSurface *surface, const CagCurve **section,
                            const CagMotion **motion) {
  if (surface->kind != &sweep_kind && surface->kind != &tube_kind) return false;
  const Sweep *s = (const Sweep *)surface;
  *section = s->section;
  *motion = s->motion;
  return true;
}
