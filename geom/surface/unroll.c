// Unrolling of developable surfaces that are straight along one parameter.
//
// With S(s, t) = a(t) + s r(t), the plane image is p(t) + s R(t): R has the length of r and rotates
// as r does within the tangent plane, and p moves along and perpendicular to R as a does with
// respect to r. This preserves the first fundamental form, and so all lengths, if the tangent plane
// is constant along each ruling. The angle and the point are integrals over t, stored as series.

#include <math.h>

#include "base/memory.h"
#include "geom/basis/chebyshev.h"
#include "geom/basis/quadrature.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/reshape.h"
#include "geom/surface/swept.h"

#define SERIES 1e-13
#define INTEGRAL 1e-13
// The angle starts here rather than at 0, so that the series of a cylinder's angle, which is only
// rounding, has a nonzero size.
#define START 1.0
// Largest rotation (sine) of the tangent plane along a ruling of a developable surface.
#define SAME_PLANE 1e-7
// Largest second derivative along a straight direction, relative to the first.
#define STRAIGHT CAG_COINCIDENT

typedef struct Unrolling {
  const CagSurface *s;
  int direction; // the straight direction: 0: u
  double s0, s1, t0, t1;
  const CagChebyshev *angle;
  // Ends of the smooth intervals along t, and the integrals of the rotation and of the displacement
  // (three numbers) up to each of them: a point needs only the integrals over its own interval.
  double *cuts, *sums;
  size_t cut_count;
} Unrolling;

static CagStatus partials(const Unrolling *w, double s, double t, CagVec3 *d, CagError *err) {
  CagVec3 all[9];
  CagStatus status =
      w->direction == 0 ? cag_surface_eval(w->s, s, t, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, all, err)
                        : cag_surface_eval(w->s, t, s, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, all, err);
  if (status) return status;
  bool u = w->direction == 0;
  d[0] = all[0];
  d[1] = all[u ? cag_partial(2, 1, 0) : cag_partial(2, 0, 1)]; // by s
  d[2] = all[u ? cag_partial(2, 0, 1) : cag_partial(2, 1, 0)]; // by t
  d[3] = all[cag_partial(2, 1, 1)];
  d[4] = all[u ? cag_partial(2, 2, 0) : cag_partial(2, 0, 2)]; // by s twice
  return CAG_OK;
}

// Unit ruling e, and f perpendicular to it in the tangent plane. The plane is evaluated at the end
// of the ruling where the partials are less parallel, since the other may be an apex.
static CagStatus axes_at(const Unrolling *w, double t, CagVec3 d[5], CagVec3 *e, CagVec3 *f,
                         CagError *err) {
  CagVec3 far[5];
  CagStatus status = partials(w, w->s0, t, d, err);
  if (!status) status = partials(w, w->s1, t, far, err);
  if (status) return status;
  CagVec3 n0 = cag_cross(d[1], d[2]), n1 = cag_cross(far[1], far[2]);
  CagVec3 n = cag_unit(cag_norm(n0) >= cag_norm(n1) ? n0 : n1);
  *e = cag_unit(d[1]);
  *f = cag_cross(n, *e);
  return CAG_OK;
}

static CagStatus turning(void *context, double t, double *out, CagError *err) {
  const Unrolling *w = context;
  CagVec3 d[5], e, f;
  CagStatus status = axes_at(w, t, d, &e, &f, err);
  if (!status) out[0] = cag_dot(d[3], f) / cag_norm(d[1]);
  return status;
}

static CagStatus walking(void *context, double t, double *out, CagError *err) {
  const Unrolling *w = context;
  CagVec3 d[5], e, f;
  double angle;
  CagStatus status = axes_at(w, t, d, &e, &f, err);
  if (status) return status;
  cag_chebyshev_series(w->angle, t, false, 0, &angle);
  angle -= START;
  double along = cag_dot(d[2], e), across = cag_dot(d[2], f);
  out[0] = along * cos(angle) - across * sin(angle);
  out[1] = along * sin(angle) + across * cos(angle);
  return CAG_OK;
}

// The integral from t0 to t of the rotation (first = 0, one number) or the displacement (first = 1,
// two).
static CagStatus integral_to(Unrolling *w, double t, size_t first, double *out, CagError *err) {
  size_t k = 0;
  while (k + 1 < w->cut_count && w->cuts[k + 1] <= t) k++;
  const size_t parts = first + 1;
  double cuts[2] = {w->cuts[k], t}, rest[2] = {0, 0};
  CagStatus status = CAG_OK;
  if (t > cuts[0])
    status =
        cag_integrate(first == 0 ? turning : walking, w, cuts, 2, (int)parts, INTEGRAL, rest, err);
  for (size_t i = 0; i < parts; i++) out[i] = w->sums[3 * k + first + i] + rest[i];
  return status;
}

static CagStatus sum_up(Unrolling *w, size_t first, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t k = 1; !status && k < w->cut_count; k++) {
    const double cuts[2] = {w->cuts[k - 1], w->cuts[k]};
    double *before = w->sums + 3 * (k - 1) + first, *after = before + 3;
    double step[2];
    status = cag_integrate(first == 0 ? turning : walking, w, cuts, 2, (int)first + 1, INTEGRAL,
                           step, err);
    for (size_t i = 0; !status && i <= first; i++) after[i] = before[i] + step[i];
  }
  return status;
}

static CagStatus make_cuts(Unrolling *w, CagError *err) {
  const int across = 1 - w->direction;
  size_t inner = w->s->kind->breaks ? w->s->kind->breaks(w->s, across, NULL, 0) : 0;
  w->cuts = cag_malloc((inner + 2) * sizeof *w->cuts);
  w->sums = cag_calloc(3 * (inner + 2), sizeof *w->sums);
  if (!w->cuts || !w->sums) return cag_fail_memory(err);
  if (inner > 0) w->s->kind->breaks(w->s, across, w->cuts + 1, inner);
  w->cuts[0] = w->t0;
  w->cuts[inner + 1] = w->t1;
  w->cut_count = inner + 2;
  return CAG_OK;
}

static CagStatus angle_at(void *context, double t, double *out, CagError *err) {
  CagStatus status = integral_to(context, t, 0, out, err);
  out[0] += START;
  return status;
}

// Rows of the map [s - s0, 0, 0] -> p + (s - s0) R.
static CagStatus rows_at(void *context, double t, double *out, CagError *err) {
  Unrolling *w = context;
  double p[2], angle;
  CagVec3 d[5];
  CagStatus status = partials(w, w->s0, t, d, err);
  if (!status) status = integral_to(w, t, 1, p, err);
  if (status) return status;
  cag_chebyshev_series(w->angle, t, false, 0, &angle);
  angle -= START;
  double length = cag_norm(d[1]);
  const double rows[12] = {
      length * cos(angle), 0, 0, p[0], length * sin(angle), 0, 0, p[1], 0, 0, 0, 0};
  for (int i = 0; i < 12; i++) out[i] = rows[i];
  return CAG_OK;
}

// An odd number of probes avoids symmetric points.
#define PROBES 17

static CagStatus is_straight(const Unrolling *w, bool *out, CagError *err) {
  *out = true;
  for (int i = 0; *out && i < PROBES; i++)
    for (int j = 0; *out && j < PROBES; j++) {
      CagVec3 d[5];
      double s = w->s0 + (w->s1 - w->s0) * (i + 0.37) / PROBES;
      double t = w->t0 + (w->t1 - w->t0) * (j + 0.61) / PROBES;
      CagStatus status = partials(w, s, t, d, err);
      if (status) return status;
      *out = cag_norm(d[4]) * (w->s1 - w->s0) <= STRAIGHT * cag_norm(d[1]);
    }
  return CAG_OK;
}

static CagStatus check_planes(const Unrolling *w, CagError *err) {
  for (int j = 0; j < PROBES; j++) {
    CagVec3 a[5], b[5];
    double t = w->t0 + (w->t1 - w->t0) * (j + 0.61) / PROBES;
    CagStatus status = partials(w, w->s0 + 0.01 * (w->s1 - w->s0), t, a, err);
    if (!status) status = partials(w, w->s1, t, b, err);
    if (status) return status;
    CagVec3 n = cag_unit(cag_cross(a[1], a[2])), m = cag_unit(cag_cross(b[1], b[2]));
    char text[32];
    if (cag_norm(cag_cross(n, m)) > SAME_PLANE)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_developable, "", -1,
                      "the surface cannot be unrolled without stretching: its tangent plane turns "
                      "along the ruling at %c = %s",
                      w->direction == 0 ? 'v' : 'u', cag_number_text(t, text));
  }
  return CAG_OK;
}

static CagStatus build(Unrolling *w, CagSurface **out, CagError *err) {
  CagChebyshev *angle = NULL, *rows = NULL;
  CagMotion *motion = NULL;
  CagCurve *ruling = NULL, *shifted = NULL;
  CagSurface *made = NULL;
  CagStatus status = make_cuts(w, err);
  if (!status) status = sum_up(w, 0, err);
  if (!status)
    status = cag_chebyshev_fit(angle_at, w, w->t0, w->t1, 1, SERIES, "surface", &angle, err);
  w->angle = angle;
  if (!status) status = sum_up(w, 1, err);
  if (!status)
    status = cag_chebyshev_fit(rows_at, w, w->t0, w->t1, 12, SERIES, "surface", &rows, err);
  bool angular = w->direction == 0 ? w->s->angular_v : w->s->angular_u;
  if (!status) status = cag_motion_affine(rows, w->t0, w->t1, angular, &motion, err);
  if (!status)
    status = cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(w->s1 - w->s0, 0, 0), 2, &ruling, err);
  if (!status) status = cag_curve_reparametrize(ruling, w->s0, w->s1, &shifted, err);
  if (!status) status = cag_surface_sweep(shifted, motion, &made, err);
  if (!status && w->direction == 1) {
    status = cag_surface_transpose(made, out, err);
    cag_surface_release(made);
  } else if (!status) {
    *out = made;
  }
  cag_curve_release(ruling);
  cag_curve_release(shifted);
  cag_motion_release(motion);
  cag_chebyshev_release(rows);
  cag_chebyshev_release(angle);
  cag_free(w->cuts);
  cag_free(w->sums);
  return status;
}

CagStatus cag_surface_unroll(const CagSurface *s, CagSurface **out, CagError *err) {
  Unrolling u = {.s = s, .direction = 0, .s0 = s->u0, .s1 = s->u1, .t0 = s->v0, .t1 = s->v1};
  Unrolling v = {.s = s, .direction = 1, .s0 = s->v0, .s1 = s->v1, .t0 = s->u0, .t1 = s->u1};
  bool by_u, by_v;
  CagStatus status = is_straight(&u, &by_u, err);
  if (!status) status = is_straight(&v, &by_v, err);
  if (status) return status;
  if (!by_u && !by_v)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_developable, "", -1,
                    "the surface is straight along neither u nor v, so it cannot be unrolled: only "
                    "cylinders, cones, planes and ruled surfaces can");
  status = check_planes(by_v ? &v : &u, err);
  if (!status) status = build(by_v ? &v : &u, out, err);
  if (!status) (*out)->unrolled = true;
  return status;
}
