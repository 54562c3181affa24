// Surfaces of revolution: a curve revolved about an axis.
//
// S(u, v) = A + axial(u) + cos v radial(u) + sin v (w x radial(u)), where P(u) - A splits into its
// part along the unit axis w and the rest. Rotation by v acts in the plane perpendicular to w, so
// the j-th derivative by v is the radial part rotated by j further right angles.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/surface/family.h"

// A profile that leaves a plane with the axis by less than this fraction of the size is in it.
#define ON_MERIDIAN 1e-13

typedef struct Revolution {
  CagSurface base;
  CagCurve *profile; // of space
  CagVec3 axis;      // unit
  CagVec3 through;
  double on_axis; // a profile point closer to the axis than this lies on it
  // Parameters between the ends at which the profile crosses or touches the axis. The surface is a
  // single point there, and its normal is reversed.
  double *meets;
  size_t meet_count;
  // Whether the profile is in a plane with the axis; the unit direction from the axis to its farthest
  // point, and whether all of it is on this side.
  bool meridian;
  CagVec3 radial;
  bool one_sided;
} Revolution;

static const CagSurfaceKind revolution_kind;

// Splits a vector into its part along the axis and the rest.
static void split(const Revolution *r, CagVec3 p, CagVec3 *axial, CagVec3 *radial) {
  *axial = cag_scaled(r->axis, cag_dot(r->axis, p));
  *radial = cag_sub(p, *axial);
}

// The same for a profile point; a point on the axis has exactly no radial part, so that a pole is
// one point to the last bit.
static void split_point(const Revolution *r, CagVec3 p, CagVec3 *axial, CagVec3 *radial) {
  split(r, cag_sub(p, r->through), axial, radial);
  if (cag_norm(*radial) <= r->on_axis) *radial = (CagVec3){0, 0, 0};
  *axial = cag_add(*axial, r->through);
}

static CagStatus revolution_eval(const CagSurface *s, double u, double v, int n, CagSide su,
                                 CagSide sv, CagVec3 *out, CagError *err) {
  (void)sv;
  const Revolution *r = (const Revolution *)s;
  CagVec3 p[CAG_MAX_PARTIAL + 1];
  CagStatus status = cag_curve_eval(r->profile, u, n, su, p, err);
  if (status) return status;
  double sine, cosine;
  cag_sincos(v, &sine, &cosine);
  for (int i = 0; i <= n; i++) {
    CagVec3 axial, radial;
    if (i == 0) split_point(r, p[0], &axial, &radial);
    else split(r, p[i], &axial, &radial);
    CagVec3 across = cag_cross(r->axis, radial);
    double c = cosine, d = sine;
    for (int j = 0; i + j <= n; j++) {
      CagVec3 turned = cag_madd(cag_scaled(radial, c), d, across);
      out[cag_partial(n, i, j)] = j == 0 ? cag_add(axial, turned) : turned;
      double next = -d;
      d = c;
      c = next;
    }
  }
  return CAG_OK;
}

static CagStatus revolution_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                                 size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                                 CagError *err) {
  const Revolution *r = (const Revolution *)s;
  CagVec3 *p = cag_malloc((2 * nu + 1) * sizeof *p);
  double *turn = cag_malloc((2 * nv + 1) * sizeof *turn);
  CagStatus status = CAG_OK;
  if (!p || !turn) status = cag_fail_memory(err);
  else status = cag_curve_eval_many(r->profile, us, nu, 1, p, err);
  for (size_t j = 0; !status && j < nv; j++) cag_sincos(vs[j], &turn[2 * j], &turn[2 * j + 1]);
  for (size_t i = 0; !status && i < nu; i++) {
    CagVec3 axial, radial, axial_u, radial_u;
    split_point(r, p[2 * i], &axial, &radial);
    split(r, p[2 * i + 1], &axial_u, &radial_u);
    CagVec3 across = cag_cross(r->axis, radial), across_u = cag_cross(r->axis, radial_u);
    for (size_t j = 0; j < nv; j++) {
      double sine = turn[2 * j], cosine = turn[2 * j + 1];
      size_t at = i * nv + j;
      points[at] = cag_madd(cag_madd(axial, cosine, radial), sine, across);
      if (du) du[at] = cag_madd(cag_madd(axial_u, cosine, radial_u), sine, across_u);
      if (dv) dv[at] = cag_madd(cag_scaled(across, cosine), -sine, radial);
    }
  }
  cag_free(p);
  cag_free(turn);
  return status;
}

// The exact form: each control point of the profile is revolved by the control points of the arc.
static CagStatus revolution_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Revolution *r = (const Revolution *)s;
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(r->profile, &exact, err);
  if (status) return status;
  CagNurbsView view;
  cag_curve_nurbs_view(exact, &view);
  CagConicNurbs arc;
  cag_conic_nurbs(CAG_ARC_CIRCLE, s->v0, s->v1, &arc);
  double *net = cag_malloc(view.count * arc.count * 4 * sizeof *net);
  if (!net) {
    cag_curve_release(exact);
    return cag_fail_memory(err);
  }
  for (size_t i = 0; i < view.count; i++) {
    const double *h = view.homogeneous + 4 * i;
    // Homogeneous point minus w times the axis point.
    CagVec3 q = {h[0] - h[3] * r->through.x, h[1] - h[3] * r->through.y,
                 h[2] - h[3] * r->through.z};
    CagVec3 axial, radial;
    split(r, q, &axial, &radial);
    if (cag_norm(radial) <= r->on_axis * h[3]) radial = (CagVec3){0, 0, 0};
    CagVec3 across = cag_cross(r->axis, radial);
    for (size_t j = 0; j < arc.count; j++) {
      double x = arc.points[j][0], y = arc.points[j][1], w = arc.points[j][2];
      CagVec3 p = cag_madd(cag_madd(cag_scaled(axial, w), x, radial), y, across);
      double *at = net + 4 * (i * arc.count + j);
      at[3] = h[3] * w;
      at[0] = p.x + at[3] * r->through.x;
      at[1] = p.y + at[3] * r->through.y;
      at[2] = p.z + at[3] * r->through.z;
    }
  }
  status = cag_surface_from_homogeneous(net, view.count, arc.count, view.degree, arc.degree,
                                        view.knots, arc.knots, out, err);
  cag_free(net);
  cag_curve_release(exact);
  return status;
}

static CagStatus revolution_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                      CagError *err) {
  const Revolution *r = (const Revolution *)s;
  double scale;
  if (!cag_transform_is_affine(t) || !cag_transform_is_similarity(t, &scale))
    return cag_surface_transform_placed(s, t, out, err);
  CagCurve *profile;
  CagStatus status = cag_curve_transform(r->profile, t, &profile, err);
  if (status) return status;
  // Under a reflection the rotation about the image of the axis is reversed.
  CagVec3 axis = cag_scaled(cag_transform_vector(t, r->axis), cag_transform_mirrors(t) ? -1 : 1);
  status = cag_surface_revolve(profile, axis, cag_transform_point(t, r->through), s->v0, s->v1, out,
                               err);
  cag_curve_release(profile);
  return status;
}

static int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static size_t revolution_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Revolution *r = (const Revolution *)s;
  if (direction == 1) return 0;
  const CagCurveKind *kind = r->profile->kind;
  const size_t own = kind->breaks ? kind->breaks(r->profile, out, capacity) : 0;
  if (out && capacity >= own + r->meet_count && r->meet_count) {
    memcpy(out + own, r->meets, r->meet_count * sizeof *out);
    qsort(out, own + r->meet_count, sizeof *out, by_value);
  }
  return own + r->meet_count;
}

// --- Intersections of the profile with the axis ---

// Samples between two breaks of the profile, and steps that refine a minimum to rounding accuracy.
enum { MEET_SAMPLES = 32, MEET_STEPS = 90 };

static CagStatus axis_distance(const Revolution *r, double t, double *out, CagError *err) {
  CagVec3 p, axial, radial;
  CagStatus status = cag_curve_eval(r->profile, t, 0, CAG_SIDE_RIGHT, &p, err);
  if (status) return status;
  split(r, cag_sub(p, r->through), &axial, &radial);
  *out = cag_norm(radial);
  return CAG_OK;
}

// Finds the minimum distance from the axis between two parameters by golden-section search.
static CagStatus least_distance(const Revolution *r, double from, double to, double *at,
                                double *distance, CagError *err) {
  const double golden = 0.6180339887498949;
  double t[2] = {to - golden * (to - from), from + golden * (to - from)}, d[2];
  CagStatus status = axis_distance(r, t[0], &d[0], err);
  if (!status) status = axis_distance(r, t[1], &d[1], err);
  for (int i = 0; !status && i < MEET_STEPS; i++) {
    const int worse = d[0] < d[1] ? 1 : 0;
    *(worse ? &to : &from) = t[worse];
    t[worse] = t[!worse];
    d[worse] = d[!worse];
    t[!worse] = worse ? to - golden * (to - from) : from + golden * (to - from);
    status = axis_distance(r, t[!worse], &d[!worse], err);
  }
  *at = d[0] < d[1] ? t[0] : t[1];
  *distance = fmin(d[0], d[1]);
  return status;
}

// Searches between two breaks, which are breaks of the surface already.
static CagStatus find_meets(Revolution *r, double from, double to, CagError *err) {
  double d[MEET_SAMPLES + 1];
  const double step = (to - from) / MEET_SAMPLES;
  for (int i = 0; i <= MEET_SAMPLES; i++) {
    CagStatus status = axis_distance(r, i < MEET_SAMPLES ? from + i * step : to, &d[i], err);
    if (status) return status;
  }
  for (int i = 1; i < MEET_SAMPLES; i++) {
    if (d[i] > d[i - 1] || d[i] >= d[i + 1] || d[i - 1] <= r->on_axis) continue;
    double at, distance;
    CagStatus status =
        least_distance(r, from + (i - 1) * step, from + (i + 1) * step, &at, &distance, err);
    if (status) return status;
    if (distance > r->on_axis) continue;
    if (!CAG_RESIZE(r->meets, r->meet_count + 1)) return cag_fail_memory(err);
    r->meets[r->meet_count++] = at;
  }
  return CAG_OK;
}

static CagStatus find_all_meets(Revolution *r, CagError *err) {
  const CagCurve *c = r->profile;
  const size_t inner = c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0;
  double *cuts = cag_malloc((inner + 2) * sizeof *cuts);
  if (!cuts) return cag_fail_memory(err);
  if (inner) c->kind->breaks(c, cuts + 1, inner);
  cuts[0] = c->start;
  cuts[inner + 1] = c->end;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i <= inner; i++)
    if (cuts[i + 1] > cuts[i]) status = find_meets(r, cuts[i], cuts[i + 1], err);
  cag_free(cuts);
  return status;
}

static void revolution_describe(const CagSurface *s, char *buffer, size_t size) {
  const Revolution *r = (const Revolution *)s;
  char x[32], y[32], z[32];
  snprintf(buffer, size, "of %s %s about [%s, %s, %s]", cag_article(r->profile->kind->name),
           r->profile->kind->name, cag_number_text(r->axis.x, x), cag_number_text(r->axis.y, y),
           cag_number_text(r->axis.z, z));
}

static void revolution_destroy(CagSurface *s) {
  Revolution *r = (Revolution *)s;
  cag_curve_release(r->profile);
  cag_free(r->meets);
}

// Finds out whether the profile is in one plane with the axis, from points that determine this.
static CagStatus find_meridian(Revolution *r, double size, CagError *err) {
  CagVec3 *p, axial, radial;
  size_t n;
  CagStatus status = cag_curve_gather(r->profile, &p, &n, err);
  if (status) return status;
  double farthest = 0, off = 0;
  for (size_t i = 0; i < n; i++) {
    split_point(r, p[i], &axial, &radial);
    if (!(cag_norm(radial) > farthest)) continue;
    farthest = cag_norm(radial);
    r->radial = cag_scaled(radial, 1 / farthest);
  }
  const CagVec3 normal = cag_cross(r->axis, r->radial);
  for (size_t i = 0; i < n; i++) off = fmax(off, fabs(cag_dot(normal, cag_sub(p[i], r->through))));
  r->meridian = farthest > 0 && off <= ON_MERIDIAN * size;
  r->one_sided = r->meet_count == 0;
  cag_free(p);
  return CAG_OK;
}

static void revolution_digest(const CagSurface *surface, CagDigest *d) {
  const Revolution *s = (const Revolution *)surface;
  cag_curve_digest(s->profile, d);
  cag_vec3s_digest(&s->axis, 1, d);
  cag_vec3s_digest(&s->through, 1, d);
}

static const CagSurfaceKind revolution_kind = {
    .name = "revolution",
    .eval = revolution_eval,
    .eval_grid = revolution_grid,
    .to_nurbs = revolution_to_nurbs,
    .transform = revolution_transform,
    .breaks = revolution_breaks,
    .describe = revolution_describe,
    .destroy = revolution_destroy,
    .digest = revolution_digest,
};

// A revolution may overlap itself, but at most once.
#define MOST_TURN (4 * M_PI)

CagStatus cag_surface_revolve(const CagCurve *profile, CagVec3 axis, CagVec3 through, double from,
                              double to, CagSurface **out, CagError *err) {
  CagVec3 unit = cag_unit(axis);
  if (!(cag_norm(unit) > 0))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_axis, "axis", -1,
                    "`axis` must not be the zero vector: give a direction such as Z");
  if (!(to > from) || to - from > MOST_TURN) {
    char a[32], b[32];
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "angle", -1,
                    "`angle` must increase and span at most 720deg, found %sdeg..%sdeg",
                    cag_number_text(from * (180 / M_PI), a), cag_number_text(to * (180 / M_PI), b));
  }
  CagCurve *space;
  CagStatus status = cag_surface_space_curve(profile, &space, err);
  if (status) return status;
  CagSurface *s;
  status = cag_surface_block(sizeof(Revolution), &revolution_kind, space->start, space->end, from,
                             to, &s, err);
  if (status) {
    cag_curve_release(space);
    return status;
  }
  Revolution *r = (Revolution *)s;
  r->profile = space;
  r->axis = unit;
  r->through = through;
  s->angular_u = space->angular;
  s->angular_v = true;
  CagBounds box;
  status = cag_curve_bounds(space, &box, err);
  if (status) {
    cag_surface_release(s);
    return status;
  }
  double size = cag_norm(cag_sub(box.max, box.min)) + cag_norm(cag_sub(box.min, through));
  r->on_axis = CAG_SURFACE_SAME * size;
  status = find_all_meets(r, err);
  if (!status) status = find_meridian(r, size, err);
  if (status) {
    cag_surface_release(s);
    return status;
  }
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}

bool cag_surface_meridian_view(const CagSurface *s, CagVec3 *radial, bool *one_sided) {
  const Revolution *r = (const Revolution *)s;
  if (s->kind != &revolution_kind || !r->meridian) return false;
  *radial = r->radial;
  *one_sided = r->one_sided;
  return true;
}

bool cag_surface_revolution_view(const CagSurface *s, const CagCurve **profile, CagVec3 *axis,
                                 CagVec3 *through, double *from, double *to) {
  if (s->kind != &revolution_kind) return false;
  const Revolution *r = (const Revolution *)s;
  if (profile) *profile = r->profile;
  if (axis) *axis = r->axis;
  if (through) *through = r->through;
  if (from) *from = s->v0;
  if (to) *to = s->v1;
  return true;
}
