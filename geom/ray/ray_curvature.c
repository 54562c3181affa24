#include "geom/ray/ray_curvature.h"

#include "geom/linalg/tolerance.h"
#include "geom/ray/caster_parts.h"

// --- Parametric surfaces ---

CagStatus cag_surface_bend(const CagSurface *s, double u, double v, CagVec3 side, CagBend *out,
                           bool *known, CagError *err) {
  CagVec3 d[9];
  *known = false;
  CagStatus status = cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const CagVec3 du = d[cag_partial(2, 1, 0)], dv = d[cag_partial(2, 0, 1)];
  const CagVec3 across = cag_cross(du, dv);
  const double e = cag_dot(du, du), f = cag_dot(du, dv), g = cag_dot(dv, dv);
  const double area = cag_norm(across);
  if (!(area > CAG_ROUNDING * (e + g))) return CAG_OK;
  const CagVec3 n = cag_scaled(across, (cag_dot(across, side) < 0 ? -1 : 1) / area);
  const double l = cag_dot(d[cag_partial(2, 2, 0)], n), m = cag_dot(d[cag_partial(2, 1, 1)], n);
  const double k = cag_dot(d[cag_partial(2, 0, 2)], n), square = area * area;
  out->mean = -(e * k - 2 * f * m + g * l) / (2 * square);
  out->gaussian = (l * k - m * m) / square;
  *known = true;
  return CAG_OK;
}

// --- Equations ---

// A function that is 0 on the surface: its gradient, which points outward, and its second
// derivatives.
typedef struct Field {
  double g[3], h[3][3];
} Field;

// The curvature of the surface on which the function is 0 (Goldman 2005).
static CagBend field_bend(const Field *f) {
  double square = 0, trace = 0, bent = 0, adjugate = 0;
  for (int i = 0; i < 3; i++) {
    square += f->g[i] * f->g[i];
    trace += f->h[i][i];
    for (int j = 0; j < 3; j++) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double minor = f->h[i1][j1] * f->h[i2][j2] - f->h[i1][j2] * f->h[i2][j1];
      bent += f->g[i] * f->h[i][j] * f->g[j];
      adjugate += f->g[i] * minor * f->g[j];
    }
  }
  return (CagBend){(square * trace - bent) / (2 * square * sqrt(square)),
                   adjugate / (square * square)};
}

// The function in the world, if `back` maps from there to its own coordinates.
static Field moved_field(const Field *f, const CagTransform *back) {
  Field out = {{0}, {{0}}};
  for (int i = 0; i < 3; i++)
    for (int a = 0; a < 3; a++) {
      out.g[i] += back->m[a][i] * f->g[a];
      for (int j = 0; j < 3; j++)
        for (int b = 0; b < 3; b++) out.h[i][j] += back->m[a][i] * f->h[a][b] * back->m[b][j];
    }
  return out;
}

static Field frustum_field(const CagSolid *s, CagVec3 p) {
  const double slope = (s->c - s->b) / s->a, r = s->b + slope * p.z;
  return (Field){{2 * p.x, 2 * p.y, -2 * slope * r},
                 {{2, 0, 0}, {0, 2, 0}, {0, 0, -2 * slope * slope}}};
}

static Field torus_field(const CagSolid *s, CagVec3 at) {
  const double p[3] = {at.x, at.y, at.z}, ring = 8 * s->a * s->a;
  const double e = cag_dot(at, at) + s->a * s->a - s->b * s->b;
  Field f;
  for (int i = 0; i < 3; i++) {
    const double flat = i < 2 ? ring : 0;
    f.g[i] = (4 * e - flat) * p[i];
    for (int j = 0; j < 3; j++) f.h[i][j] = 8 * p[i] * p[j] + (i == j ? 4 * e - flat : 0);
  }
  return f;
}

static CagBend primitive_bend(const CagRayPrimitive *primitive, uint32_t face, CagVec3 at) {
  const CagSolid *s = primitive->solid;
  const CagVec3 p = cag_transform_point(&primitive->back, at);
  if (s->kind == CAG_SOLID_BOX || face > 0) return (CagBend){0, 0};
  Field own = {{2 * p.x, 2 * p.y, 2 * p.z}, {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
  if (s->kind == CAG_SOLID_CYLINDER) own = frustum_field(s, p);
  if (s->kind == CAG_SOLID_TORUS) own = torus_field(s, p);
  const Field moved = moved_field(&own, &primitive->back);
  return field_bend(&moved);
}

static CagBend form_bend(const CagQuadric *q, CagVec3 p) {
  const double *f = q->c;
  const Field field = {{2 * f[0] * p.x + f[3] * p.y + f[5] * p.z + f[6],
                        2 * f[1] * p.y + f[3] * p.x + f[4] * p.z + f[7],
                        2 * f[2] * p.z + f[4] * p.y + f[5] * p.x + f[8]},
                       {{2 * f[0], f[3], f[5]}, {f[3], 2 * f[1], f[4]}, {f[5], f[4], 2 * f[2]}}};
  return field_bend(&field);
}

// --- Crossings ---

// The normal of a part with its own coordinates, there: normals are mapped by the transpose of the
// inverse.
static CagVec3 own_normal(const CagCaster *c, CagVec3 normal) {
  return c->placed ? cag_transform_vector(&c->back, normal) : normal;
}

// How many times longer distances are in the coordinates of a part.
static double own_stretch(const CagCaster *c) {
  if (!c->placed) return 1;
  return cag_norm(cag_transform_vector(&c->back, cag_vec3(1, 0, 0))) / fabs(c->back.m[3][3]);
}

static CagStatus face_bend(const CagCrossing *c, CagBend *out, bool *known, CagError *err) {
  const CagRayPatch *patch = c->part->faces[c->face];
  CagStatus status =
      cag_surface_bend(patch->surface, c->u, c->v, own_normal(c->part, c->normal), out, known, err);
  const double stretch = own_stretch(c->part);
  out->mean *= stretch;
  out->gaussian *= stretch * stretch;
  return status;
}

CagStatus cag_crossing_bend(const CagCrossing *c, CagVec3 at, CagBend *out, bool *known,
                            CagError *err) {
  *known = false;
  *out = (CagBend){0, 0};
  if (!c->part || c->part->kind == CAG_CASTER_MESH) return CAG_OK;
  if (c->part->kind == CAG_CASTER_FACES) return face_bend(c, out, known, err);
  *out = c->part->kind == CAG_CASTER_FORM ? form_bend(&c->part->form, at)
                                          : primitive_bend(&c->part->primitive, c->face, at);
  *known = isfinite(out->mean) && isfinite(out->gaussian);
  // In a difference, the part may be outside.
  if (c->flipped) out->mean = -out->mean;
  return CAG_OK;
}
