// Faces of meshes (see meshed.h).

#include "geom/boundary/meshed.h"

#include <math.h>

#include "base/memory.h"
#include "geom/boundary/carrier.h"

// The outward normal near a triangle.
static CagStatus normal_at(const CagBoundary *b, size_t face, size_t t, CagVec3 *out,
                           CagError *err) {
  const CagBoundaryFace *f = &b->faces[face];
  const double near[2] = {0, 0};
  double uv[2];
  *out = cag_unit(cag_meshed_cross(b->mesh, t));
  if (!cag_carrier_is_analytic(&f->carrier)) return CAG_OK;
  cag_carrier_parameters(&f->carrier, cag_meshed_middle(b->mesh, t), near, uv);
  CagStatus status = cag_carrier_normal(&f->carrier, uv[0], uv[1], out, err);
  if (!status && f->reversed) *out = cag_scaled(*out, -1);
  return status;
}

CagStatus cag_meshed_face(const CagBoundary *b, size_t face, CagFaceFeature *out, CagError *err) {
  const CagMesh *m = b->mesh;
  CagFaceFeature f = {.kind = cag_carrier_name(&b->faces[face].carrier),
                      .bounds = CAG_BOUNDS_EMPTY};
  size_t nearest = SIZE_MAX;
  double least = INFINITY;
  for (size_t t = 0; t < m->triangle_count; t++) {
    if (m->labels[t] != face + 1) continue;
    const double area = cag_norm(cag_meshed_cross(m, t)) / 2;
    f.area += area;
    for (int k = 0; k < 3; k++) {
      const CagVec3 p = m->positions[m->triangles[3 * t + (size_t)k]];
      cag_bounds_add(&f.bounds, p);
      f.center = cag_madd(f.center, area, p);
    }
  }
  // The sums are exact where areas and coordinates are whole numbers.
  const double weights = 3 * f.area;
  if (f.area > 0)
    f.center = cag_vec3(f.center.x / weights, f.center.y / weights, f.center.z / weights);
  for (size_t t = 0; t < m->triangle_count; t++) {
    if (m->labels[t] != face + 1) continue;
    const double distance = cag_norm(cag_sub(cag_meshed_middle(m, t), f.center));
    if (!(distance < least)) continue;
    least = distance;
    nearest = t;
  }
  CagStatus status = nearest < SIZE_MAX ? normal_at(b, face, nearest, &f.normal, err) : CAG_OK;
  if (!status) *out = f;
  return status;
}

CagStatus cag_meshed_copy(const CagBoundary *b, bool labeled, CagMesh **out, CagError *err) {
  const CagTransform same = cag_transform_identity();
  CagStatus status = cag_mesh_transform(b->mesh, &same, out, err);
  if (status || labeled) return status;
  cag_free((*out)->labels);
  (*out)->labels = NULL;
  return CAG_OK;
}
