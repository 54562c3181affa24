// The torus about Z: u the angle around the axis, v the angle around the section, so that normals
// point outward.
//
// S(u, v) = [(R + r cos v) cos u, (R + r cos v) sin u, r sin v]. R > r is a ring, R = r a horn
// torus with a point on the axis, R < r a spindle torus that crosses itself; all are exact.

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/surface/family.h"

typedef struct Torus {
  CagSurface base;
  double major, minor;
} Torus;

static const CagSurfaceKind torus_kind;

static CagStatus torus_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                            CagVec3 *out, CagError *err) {
  (void)su;
  (void)sv;
  (void)err;
  const Torus *t = (const Torus *)s;
  double sine_u, cosine_u, sine_v, cosine_v;
  cag_sincos(u, &sine_u, &cosine_u);
  cag_sincos(v, &sine_v, &cosine_v);
  double a = cosine_u, b = sine_u; // turned by i right angles
  for (int i = 0; i <= n; i++) {
    double c = cosine_v, d = sine_v; // turned by j right angles
    for (int j = 0; i + j <= n; j++) {
      double radius = (j == 0 ? t->major : 0) + t->minor * c;
      out[cag_partial(n, i, j)] = cag_vec3(radius * a, radius * b, i == 0 ? t->minor * d : 0);
      double next = -d;
      d = c;
      c = next;
    }
    double next = -b;
    b = a;
    a = next;
  }
  return CAG_OK;
}

static CagStatus torus_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  const Torus *t = (const Torus *)s;
  double *turn = cag_malloc((2 * nv + 1) * sizeof *turn);
  if (!turn) return cag_fail_memory(err);
  for (size_t j = 0; j < nv; j++) cag_sincos(vs[j], &turn[2 * j], &turn[2 * j + 1]);
  for (size_t i = 0; i < nu; i++) {
    double b, a;
    cag_sincos(us[i], &b, &a);
    for (size_t j = 0; j < nv; j++) {
      double d = turn[2 * j], c = turn[2 * j + 1], radius = t->major + t->minor * c;
      size_t at = i * nv + j;
      points[at] = cag_vec3(radius * a, radius * b, t->minor * d);
      if (du) du[at] = cag_vec3(-radius * b, radius * a, 0);
      if (dv) dv[at] = cag_vec3(-t->minor * d * a, -t->minor * d * b, t->minor * c);
    }
  }
  cag_free(turn);
  return CAG_OK;
}

static CagStatus torus_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Torus *t = (const Torus *)s;
  CagConicNurbs around, section;
  cag_conic_nurbs(CAG_ARC_CIRCLE, s->u0, s->u1, &around);
  cag_conic_nurbs(CAG_ARC_CIRCLE, s->v0, s->v1, &section);
  double net[CAG_CONIC_ARC_POINTS * CAG_CONIC_ARC_POINTS * 4];
  for (size_t i = 0; i < around.count; i++)
    for (size_t j = 0; j < section.count; j++) {
      const double *a = around.points[i], *b = section.points[j];
      double *h = net + 4 * (i * section.count + j), radius = t->major * b[2] + t->minor * b[0];
      h[0] = radius * a[0];
      h[1] = radius * a[1];
      h[2] = t->minor * b[1] * a[2];
      h[3] = a[2] * b[2];
    }
  return cag_surface_from_homogeneous(net, around.count, section.count, around.degree,
                                      section.degree, around.knots, section.knots, out, err);
}

static void torus_describe(const CagSurface *s, char *buffer, size_t size) {
  const Torus *t = (const Torus *)s;
  char a[32], b[32];
  snprintf(buffer, size, "major %s, minor %s", cag_number_text(t->major, a),
           cag_number_text(t->minor, b));
}

static void torus_digest(const CagSurface *surface, CagDigest *d) {
  const Torus *s = (const Torus *)surface;
  cag_digest_number(d, s->major);
  cag_digest_number(d, s->minor);
}

static const CagSurfaceKind torus_kind = {
    .name = "torus",
    .eval = torus_eval,
    .eval_grid = torus_grid,
    .to_nurbs = torus_to_nurbs,
    .describe = torus_describe,
    .digest = torus_digest,
};

CagStatus cag_surface_torus(double major, double minor, CagSurface **out, CagError *err) {
  const double sizes[2] = {major, minor};
  const char *names[2] = {"major", "minor"};
  for (int i = 0; i < 2; i++)
    if (!(sizes[i] > 0) || !isfinite(sizes[i])) {
      char text[32];
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_size_not_positive, names[i], -1,
                      "`%s` must be a positive radius, found %s", names[i],
                      cag_number_text(sizes[i], text));
    }
  CagSurface *s;
  CagStatus status =
      cag_surface_block(sizeof(Torus), &torus_kind, 0, 2 * M_PI, 0, 2 * M_PI, &s, err);
  if (status) return status;
  Torus *t = (Torus *)s;
  t->major = major;
  t->minor = minor;
  s->angular_u = s->angular_v = true;
  s->closed_u = s->closed_v = true;
  *out = s;
  return CAG_OK;
}

bool cag_surface_torus_view(const CagSurface *s, double *major, double *minor) {
  if (s->kind != &torus_kind) return false;
  *major = ((const Torus *)s)->major;
  *minor = ((const Torus *)s)->minor;
  return true;
}
