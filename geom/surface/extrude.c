// Extrusions: a curve translated along a vector, with rotation about the z axis and scale.
//
// S(u, v) = [m(v) (x + i y), z](u) + v V with the complex factor m(v) = (1 + k v) e^(i a v), a the
// twist and 1 + k the scale reached at v = 1. Its j-th derivative is
// (i a)^j (1 + k v) e^(i a v) + j k (i a)^(j - 1) e^(i a v). z is neither rotated nor scaled.

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/linalg/complex.h"
#include "geom/surface/family.h"
#include "geom/surface/swept.h"

typedef struct Extrusion {
  CagSurface base;
  CagCurve *section; // of space
  CagVec3 along;
  double twist, scale;
} Extrusion;

static const CagSurfaceKind extrusion_kind;

static bool is_plain(const Extrusion *e) { return e->twist == 0 && e->scale == 1; }

static void factors(const Extrusion *e, double v, int n, double complex *out) {
  double sine, cosine, k = e->scale - 1, grown = v == 1 ? e->scale : 1 + k * v;
  cag_sincos(e->twist * v, &sine, &cosine);
  double complex turn = CMPLX(cosine, sine), power = 1, lower = 0; // (i a)^j, j (i a)^(j - 1)
  for (int j = 0; j <= n; j++) {
    out[j] = (power * grown + lower * k) * turn;
    lower = lower * (I * e->twist) + power;
    power *= I * e->twist;
  }
}

static CagVec3 turned(CagVec3 p, double complex m) {
  double x = creal(m), y = cimag(m);
  return cag_vec3(x * p.x - y * p.y, x * p.y + y * p.x, p.z);
}

static CagStatus extrusion_eval(const CagSurface *s, double u, double v, int n, CagSide su,
                                CagSide sv, CagVec3 *out, CagError *err) {
  (void)sv;
  const Extrusion *e = (const Extrusion *)s;
  CagVec3 c[CAG_MAX_PARTIAL + 1];
  double complex m[CAG_MAX_PARTIAL + 1];
  CagStatus status = cag_curve_eval(e->section, u, n, su, c, err);
  if (status) return status;
  factors(e, v, n, m);
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      CagVec3 d = turned(c[i], m[j]);
      if (j > 0) d.z = 0;
      out[cag_partial(n, i, j)] = d;
    }
  out[0] = cag_madd(out[0], v, e->along);
  if (n > 0) out[cag_partial(n, 0, 1)] = cag_add(out[cag_partial(n, 0, 1)], e->along);
  return CAG_OK;
}

static CagStatus extrusion_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                                size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                                CagError *err) {
  const Extrusion *e = (const Extrusion *)s;
  CagVec3 *c = cag_malloc((2 * nu + 1) * sizeof *c);
  double complex *m = cag_malloc((2 * nv + 1) * sizeof *m);
  CagStatus status =
      c && m ? cag_curve_eval_many(e->section, us, nu, 1, c, err) : cag_fail_memory(err);
  for (size_t j = 0; !status && j < nv; j++) factors(e, vs[j], 1, &m[2 * j]);
  for (size_t i = 0; !status && i < nu; i++)
    for (size_t j = 0; j < nv; j++) {
      size_t at = i * nv + j;
      points[at] = cag_madd(turned(c[2 * i], m[2 * j]), vs[j], e->along);
      if (du) du[at] = turned(c[2 * i + 1], m[2 * j]);
      if (dv) {
        CagVec3 d = turned(c[2 * i], m[2 * j + 1]);
        d.z = 0;
        dv[at] = cag_add(d, e->along);
      }
    }
  cag_free(c);
  cag_free(m);
  return status;
}

// Without twist S is linear in v between the section and its image at v = 1, with the same weights.
static CagStatus extrusion_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Extrusion *e = (const Extrusion *)s;
  char text[32];
  if (e->twist != 0)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "twist", -1,
                    "an extrusion with a twist (%s radians) has no exact NURBS form; approximate "
                    "it to a tolerance",
                    cag_number_text(e->twist, text));
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(e->section, &exact, err);
  if (status) return status;
  CagNurbsView c;
  cag_curve_nurbs_view(exact, &c);
  double *net = cag_malloc(8 * c.count * sizeof *net);
  if (!net) status = cag_fail_memory(err);
  else {
    for (size_t i = 0; i < c.count; i++) {
      const double *h = c.homogeneous + 4 * i;
      double *to = net + 8 * i;
      memcpy(to, h, 4 * sizeof *to);
      to[4] = e->scale * h[0] + h[3] * e->along.x;
      to[5] = e->scale * h[1] + h[3] * e->along.y;
      to[6] = h[2] + h[3] * e->along.z;
      to[7] = h[3];
    }
    const double knots[4] = {0, 0, 1, 1};
    status = cag_surface_from_homogeneous(net, c.count, 2, c.degree, 1, c.knots, knots, out, err);
  }
  cag_free(net);
  cag_curve_release(exact);
  return status;
}

static CagStatus extrusion_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                     CagError *err) {
  const Extrusion *e = (const Extrusion *)s;
  if (!is_plain(e) || !cag_transform_is_affine(t))
    return cag_surface_transform_placed(s, t, out, err);
  CagCurve *section;
  CagStatus status = cag_curve_transform(e->section, t, &section, err);
  if (status) return status;
  CagVec3 along = cag_transform_vector(t, e->along);
  if (cag_norm(along) > 0) status = cag_surface_extrude(section, along, 0, 1, out, err);
  else status = cag_surface_placed(s, t, false, out, err);
  cag_curve_release(section);
  return status;
}

static size_t extrusion_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Extrusion *e = (const Extrusion *)s;
  if (direction == 1 || !e->section->kind->breaks) return 0;
  return e->section->kind->breaks(e->section, out, capacity);
}

static void extrusion_describe(const CagSurface *s, char *buffer, size_t size) {
  const Extrusion *e = (const Extrusion *)s;
  char x[32], y[32], z[32], a[32];
  int n = snprintf(buffer, size, "of %s %s along [%s, %s, %s]", cag_article(e->section->kind->name),
                   e->section->kind->name, cag_number_text(e->along.x, x),
                   cag_number_text(e->along.y, y), cag_number_text(e->along.z, z));
  if (e->twist != 0 && n > 0 && (size_t)n < size)
    n += snprintf(buffer + n, size - (size_t)n, ", twist %sdeg",
                  cag_number_text(e->twist * (180 / M_PI), a));
  if (e->scale != 1 && n > 0 && (size_t)n < size)
    snprintf(buffer + n, size - (size_t)n, ", scale %s", cag_number_text(e->scale, a));
}

static void extrusion_destroy(CagSurface *s) { cag_curve_release(((Extrusion *)s)->section); }

static void extrusion_digest(const CagSurface *surface, CagDigest *d) {
  const Extrusion *s = (const Extrusion *)surface;
  cag_curve_digest(s->section, d);
  cag_vec3s_digest(&s->along, 1, d);
  cag_digest_number(d, s->twist);
  cag_digest_number(d, s->scale);
}

static const CagSurfaceKind extrusion_kind = {
    .name = "extrusion",
    .eval = extrusion_eval,
    .eval_grid = extrusion_grid,
    .to_nurbs = extrusion_to_nurbs,
    .transform = extrusion_transform,
    .breaks = extrusion_breaks,
    .describe = extrusion_describe,
    .destroy = extrusion_destroy,
    .digest = extrusion_digest,
};

CagStatus cag_surface_extrude(const CagCurve *c, CagVec3 v, double twist, double scale,
                              CagSurface **out, CagError *err) {
  char text[32];
  if (!(cag_norm(v) > 0) || !isfinite(cag_norm(v)))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_degenerate_direction, "height", -1,
                    "`height` must be a finite length or vector other than 0");
  if (!isfinite(twist))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "twist", -1, "`twist` must be finite");
  if (!(scale >= 0) || !isfinite(scale))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_scale_negative, "scale", -1,
                    "`scale` must be finite and not negative (0 ends in a point), found %s",
                    cag_number_text(scale, text));
  CagCurve *section;
  CagStatus status = cag_surface_space_curve(c, &section, err);
  if (status) return status;
  CagSurface *s;
  status = cag_surface_block(sizeof(Extrusion), &extrusion_kind, section->start, section->end, 0, 1,
                             &s, err);
  if (status) {
    cag_curve_release(section);
    return status;
  }
  Extrusion *e = (Extrusion *)s;
  e->section = section;
  e->along = v;
  e->twist = twist;
  e->scale = scale;
  s->angular_u = section->angular;
  cag_surface_judge(s);
  *out = s;
  return CAG_OK;
}

bool cag_surface_extrusion_view(const CagSurface *s, const CagCurve **section, CagVec3 *along) {
  const Extrusion *e = (const Extrusion *)s;
  if (s->kind != &extrusion_kind || !is_plain(e)) return false;
  *section = e->section;
  *along = e->along;
  return true;
}

bool cag_surface_twisted_view(const CagSurface *s, CagTwisted *out) {
  const Extrusion *e = (const Extrusion *)s;
  if (s->kind != &extrusion_kind) return false;
  *out = (CagTwisted){e->section, e->along, e->twist, e->scale};
  return true;
}
