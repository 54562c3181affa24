// Meshes of exact solids with the faces of their triangles, and steps that move faces.

#include "geom/solid/face_mesh.h"

#include <math.h>

#include "base/memory.h"
#include "geom/boundary/mesh.h"
#include "geom/solid/exact.h"

// Directions of faces that are closer than the root of this are one.
#define RANK 1e-10

// --- Meshes ---

void cag_face_mesh_free(CagFaceMesh *m) {
  cag_mesh_release(m->mesh);
  cag_free(m->face);
}

static CagStatus append_mesh(CagFaceMesh *all, CagMesh *m, CagError *err) {
  CagMesh *both[2] = {all->mesh, m}, *joined = NULL;
  const CagStatus status = all->mesh ? cag_mesh_append(both, 2, &joined, err)
                                     : cag_mesh_append(both + 1, 1, &joined, err);
  if (status) return status;
  cag_mesh_release(all->mesh);
  all->mesh = joined;
  return CAG_OK;
}

static CagStatus append_part(CagFaceMesh *all, const CagBoundary *b, size_t part,
                             const CagTessellation *how, CagError *err) {
  const size_t before = all->mesh ? all->mesh->triangle_count : 0;
  CagMesh *m = NULL;
  CagStatus status = cag_boundary_mesh(b, how, true, &m, err);
  if (status) return status;
  CagSolidFace *longer = cag_realloc(all->face, (before + m->triangle_count + 1) * sizeof *longer);
  if (longer) {
    all->face = longer;
    for (size_t t = 0; t < m->triangle_count; t++)
      longer[before + t] = (CagSolidFace){part, (size_t)m->labels[t] - 1};
    status = append_mesh(all, m, err);
  } else status = cag_fail_memory(err);
  cag_mesh_release(m);
  return status;
}

CagStatus cag_solid_face_mesh(const CagSolid *s, double tolerance, CagFaceMesh *out,
                              CagError *err) {
  size_t parts;
  const CagBoundary *b = cag_solid_boundaries(s, &parts);
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *placed = NULL;
  CagStatus status = CAG_OK;
  *out = (CagFaceMesh){NULL, NULL};
  if (!b)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_boundary, "", -1,
                    "the solid has no boundary");
  how.tolerance = tolerance / cag_transform_stretch(&s->placement);
  for (size_t i = 0; !status && i < parts; i++) status = append_part(out, &b[i], i, &how, err);
  if (!status) status = cag_mesh_transform(out->mesh, &s->placement, &placed, err);
  if (status) {
    cag_face_mesh_free(out);
    return status;
  }
  cag_mesh_release(out->mesh);
  out->mesh = placed;
  return CAG_OK;
}

void cag_triangle_corners(const CagMesh *m, size_t triangle, CagCornerView out[3]) {
  CagVec3 p[3];
  for (size_t k = 0; k < 3; k++) p[k] = m->positions[cag_mesh_corner(m, 3 * triangle + k)];
  const CagVec3 n = cag_unit(cag_cross(cag_sub(p[1], p[0]), cag_sub(p[2], p[0])));
  for (int k = 0; k < 3; k++) {
    const CagVec3 a = cag_sub(p[(k + 1) % 3], p[k]), b = cag_sub(p[(k + 2) % 3], p[k]);
    out[k] = (CagCornerView){n, atan2(cag_norm(cag_cross(a, b)), cag_dot(a, b))};
  }
}

// --- Steps ---

void cag_face_steps_add(CagFaceSteps *f, double weight, CagVec3 normal, double distance) {
  const double x[3] = {normal.x, normal.y, normal.z};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) f->products.m[i][k] += weight * x[i] * x[k];
  f->sum = cag_madd(f->sum, weight * distance, normal);
}

bool cag_face_steps_solve(const CagFaceSteps *f, CagVec3 *step) {
  const double trace = f->products.m[0][0] + f->products.m[1][1] + f->products.m[2][2];
  CagTransform t = cag_transform_identity(), back;
  CagError err;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) t.m[i][k] = f->products.m[i][k] + (i == k ? RANK * trace : 0);
  if (!(trace > 0) || cag_transform_inverse(&t, &back, &err)) return false;
  *step = cag_transform_vector(&back, f->sum);
  return true;
}
