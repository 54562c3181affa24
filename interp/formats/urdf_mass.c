// Mass properties of bodies, and of joined bodies.
//
// Shapes without a volume (curves, regions, open surfaces and meshes) have no mass.

#include "geom/mesh/mesh.h"
#include "geom/solid/csg.h"
#include "interp/formats/urdf.h"

#define CUBIC_METERS 1e-9 // of a cubic millimeter

// Computes the mass properties from the integrals of 1; x, y, z; xx, yy, zz, xy, yz, zx about a
// point near the body. An inside-out body counts as the same body.
static CagUrdfMass mass_of_terms(const double given[10], CagVec3 about, double density) {
  double t[10], sign = given[0] < 0 ? -1 : 1;
  for (int i = 0; i < 10; i++) t[i] = sign * density * CUBIC_METERS * given[i];
  CagUrdfMass m = {.mass = t[0]};
  if (!(m.mass > 0)) return (CagUrdfMass){0};
  double c[3] = {t[1] / t[0], t[2] / t[0], t[3] / t[0]}, second[3];
  m.center = cag_add(about, cag_vec3(c[0], c[1], c[2]));
  for (int i = 0; i < 3; i++) second[i] = t[4 + i] - t[0] * c[i] * c[i];
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    m.inertia[i][i] = second[j] + second[k];
    m.inertia[i][j] = m.inertia[j][i] = -(t[7 + i] - t[0] * c[i] * c[j]);
  }
  return m;
}

static CagStatus solid_mass(const CagSolid *s, double tolerance, double density, CagUrdfMass *out,
                            CagError *err) {
  CagMassProperties p;
  CagStatus status = cag_solid_mass_within(s, tolerance, &p, err);
  if (status || !(p.volume > 0)) return status;
  out->mass = p.volume * density * CUBIC_METERS;
  out->center = p.volume_centroid;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) out->inertia[i][j] = p.inertia[i][j] * density * CUBIC_METERS;
  return CAG_OK;
}

// Integrals are computed about the center of the bounds, because a distant origin would cause loss
// of precision.
static CagStatus mesh_mass(const CagMesh *m, double density, CagUrdfMass *out, CagError *err) {
  bool closed;
  CagStatus status = cag_mesh_watertight(m, &closed, NULL, err);
  if (status || !closed) return status;
  CagBounds box = cag_mesh_bounds(m);
  CagVec3 middle = cag_lerp(box.min, box.max, 0.5);
  CagTransform shift = cag_translate(cag_scaled(middle, -1));
  CagMesh *near;
  double terms[10] = {0};
  status = cag_mesh_transform(m, &shift, &near, err);
  if (status) return status;
  cag_mesh_volume_terms(near, terms);
  cag_mesh_release(near);
  *out = mass_of_terms(terms, middle, density);
  return CAG_OK;
}

static CagStatus surface_mass(const CagSurface *s, double density, CagUrdfMass *out,
                              CagError *err) {
  CagBounds box;
  CagSurface *near;
  double terms[10] = {0};
  if (!cag_surface_is_closed(s)) return CAG_OK;
  CagStatus status = cag_surface_bounds(s, &box, err);
  if (status) return status;
  CagVec3 middle = cag_lerp(box.min, box.max, 0.5);
  CagTransform shift = cag_translate(cag_scaled(middle, -1));
  status = cag_surface_transform(s, &shift, &near, err);
  if (status) return status;
  status = cag_surface_volume_terms(near, terms, err);
  cag_surface_release(near);
  if (!status) *out = mass_of_terms(terms, middle, density);
  return status;
}

CagStatus cag_urdf_item_mass(const CagItem *item, double density, CagUrdfMass *out, CagError *err) {
  *out = (CagUrdfMass){0};
  switch (item->kind) {
  case CAG_ITEM_SOLID: return solid_mass(item->as.solid, item->tolerance, density, out, err);
  case CAG_ITEM_MESH: return mesh_mass(item->as.mesh, density, out, err);
  case CAG_ITEM_SURFACE: return surface_mass(item->as.surface, density, out, err);
  default: return CAG_OK;
  }
}

// The parallel axis theorem (Steiner) for the common center.
static void add_offset(CagUrdfMass *m, CagVec3 from_center, double mass) {
  const double d[3] = {from_center.x, from_center.y, from_center.z};
  const double square = cag_dot(from_center, from_center);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) m->inertia[i][j] += mass * ((i == j ? square : 0) - d[i] * d[j]);
}

void cag_urdf_mass_join(CagUrdfMass *whole, const CagUrdfMass *part) {
  double sum = whole->mass + part->mass;
  if (!(part->mass > 0)) return;
  CagVec3 center = cag_lerp(whole->center, part->center, part->mass / sum);
  add_offset(whole, cag_sub(whole->center, center), whole->mass);
  add_offset(whole, cag_sub(part->center, center), part->mass);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) whole->inertia[i][j] += part->inertia[i][j];
  whole->mass = sum;
  whole->center = center;
}

CagUrdfMass cag_urdf_plain_mass(const CagUrdfShape *s, double density) {
  double principal[3];
  const double *size = s->size;
  CagUrdfMass m = {.center = cag_transform_point(&s->place, cag_vec3(0, 0, 0))};
  if (s->kind == CAG_URDF_CYLINDER) {
    double r = size[0], h = size[1];
    m.mass = M_PI * r * r * h;
    principal[0] = principal[1] = (3 * r * r + h * h) / 12;
    principal[2] = r * r / 2;
  } else {
    m.mass = size[0] * size[1] * size[2];
    for (int i = 0; i < 3; i++) {
      double a = size[(i + 1) % 3], b = size[(i + 2) % 3];
      principal[i] = (a * a + b * b) / 12;
    }
  }
  m.mass *= density * CUBIC_METERS;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        m.inertia[i][j] += s->place.m[i][k] * m.mass * principal[k] * s->place.m[j][k];
  return m;
}
