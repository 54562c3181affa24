// Meshes: constructors from lists, data, checks, and tessellation.

#include <string.h>

#include "base/memory.h"
#include "geom/solid/csg.h"
#include "geom/solid/tessellate.h"
#include "geom/tessellate/split.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/solids.h"
#include "interp/vm/vm.h"

// Reads the mesh of a solid without a boundary mesh, which must be empty.
static bool read_empty(CagCall *call, const CagSolid *s, const CagMesh **m) {
  CagMesh *none = NULL;
  bool empty;
  if (!cag_geometry_ok(call, cag_solid_is_empty(s, &empty, call->err))) return false;
  if (!empty)
    return cag_fail_call(
        call, 0, CAG_ERR_type,
        "expects a mesh or a polyhedron, found another solid; `tessellate` makes a mesh of it");
  const CagStatus status = cag_mesh_new(0, 0, false, false, false, &none, call->err);
  cag_hold_mesh(call, none);
  *m = none;
  return cag_geometry_ok(call, status);
}

// Reads a mesh, or the boundary mesh of a polyhedron or an empty solid.
static bool read_mesh(CagCall *call, const CagMesh **m) {
  const CagShape *shape = CAG_AS_SHAPE(call->values[0]);
  *m = shape->as.mesh;
  if (call->values[0].type != CAG_SOLID) return true;
  const CagSolid *s = shape->as.solid;
  if (s->kind != CAG_SOLID_MESH) return read_empty(call, s, m);
  CagMesh *moved = NULL;
  CagStatus status = cag_mesh_transform(s->core->mesh, &s->placement, &moved, call->err);
  cag_hold_mesh(call, moved);
  *m = moved;
  return cag_geometry_ok(call, status);
}

// --- From lists ---

bool cag_arg_faces(CagCall *call, int argument, size_t vertices, uint32_t **counts,
                   uint32_t **indices, size_t *count) {
  CagList *faces;
  size_t total = 0, at = 0;
  if (!cag_arg_list(call, argument, &faces)) return false;
  *count = faces->length;
  for (size_t i = 0; i < faces->length; i++) {
    const double *x;
    size_t n;
    if (!cag_as_vector(cag_list_get(call->vm, faces, i), &x, &n) || n < 3)
      return cag_fail_call(call, argument, CAG_ERR_type,
                           "expects at least 3 vertex indices in each face; faces[%zu] has fewer",
                           i);
    total += n;
  }
  *counts = cag_hold(call, cag_malloc((faces->length + 1) * sizeof **counts));
  *indices = cag_hold(call, cag_malloc((total + 1) * sizeof **indices));
  for (size_t i = 0; i < faces->length; i++) {
    const double *x;
    size_t n;
    cag_as_vector(cag_list_get(call->vm, faces, i), &x, &n);
    (*counts)[i] = (uint32_t)n;
    for (size_t k = 0; k < n; k++) {
      if (x[k] < 0 || x[k] >= (double)vertices || x[k] != floor(x[k]))
        return cag_fail_call(
            call, argument, CAG_ERR_face_index,
            "expects whole numbers less than the number of vertices, %zu; found %g at faces[%zu][%zu]",
            vertices, x[k], i, k);
      (*indices)[at++] = (uint32_t)x[k];
    }
  }
  return true;
}

bool cag_solids_mesh(CagCall *call, const struct cag_solids_mesh *a, CagValue *result) {
  size_t faces;
  uint32_t *counts, *indices;
  CagMesh *m = NULL;
  if (!cag_arg_faces(call, 1, a->vertices.count, &counts, &indices, &faces)) return false;
  CagStatus status = cag_mesh_from_faces(a->vertices.items, a->vertices.count, indices, counts,
                                         faces, &m, call->err);
  return cag_mesh_result(call, status, &m, result);
}

// --- Data and checks ---

bool cag_solids_vertices(CagCall *call, CagValue *result) {
  const CagMesh *m;
  if (!read_mesh(call, &m)) return false;
  *result = cag_points_value(call->vm, m->positions, m->vertex_count, 3);
  return true;
}

bool cag_solids_faces(CagCall *call, CagValue *result) {
  const CagMesh *m;
  double *out;
  if (!read_mesh(call, &m)) return false;
  if (m->triangle_count == 0) {
    *result = cag_list_values(call->vm, NULL, 0);
    return true;
  }
  *result = cag_list_vectors(call->vm, m->triangle_count, 3, &out);
  for (size_t i = 0; i < 3 * m->triangle_count; i++) out[i] = m->triangles[i];
  return true;
}

// The vertex normals of a mesh without normals: those of the triangles, weighted by area.
static const CagVec3 *hold_face_normals(CagCall *call, const CagMesh *m) {
  CagVec3 *sum = cag_hold_array(call, m->vertex_count, sizeof *sum);
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]];
    CagVec3 n = cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a));
    for (int i = 0; i < 3; i++) sum[k[i]] = cag_add(sum[k[i]], n);
  }
  for (size_t i = 0; i < m->vertex_count; i++) sum[i] = cag_unit(sum[i]);
  return sum;
}

bool cag_solids_normals_of(CagCall *call, CagValue *result) {
  const CagMesh *m;
  if (!read_mesh(call, &m)) return false;
  const CagVec3 *normals = m->normals ? m->normals : hold_face_normals(call, m);
  *result = cag_points_value(call->vm, normals, m->vertex_count, 3);
  return true;
}

bool cag_solids_is_watertight(CagCall *call, CagValue *result) {
  const CagMesh *m;
  CagVec3 edge[2];
  if (!read_mesh(call, &m)) return false;
  *result = cag_bool(cag_mesh_is_watertight(m, edge));
  return true;
}

bool cag_solids_euler_characteristic(CagCall *call, CagValue *result) {
  const CagMesh *m;
  if (!read_mesh(call, &m)) return false;
  *result = cag_number((double)cag_mesh_euler_characteristic(m));
  return true;
}

bool cag_solids_weld(CagCall *call, const struct cag_solids_weld *a, CagValue *result) {
  CagMesh *out = NULL;
  return cag_changed_mesh_result(call, cag_mesh_weld(a->M, a->tolerance, &out, call->err), &out,
                                 result);
}

bool cag_solids_flip(CagCall *call, const struct cag_solids_flip *a, CagValue *result) {
  CagMesh *out = NULL;
  return cag_changed_mesh_result(call, cag_mesh_flip(a->M, &out, call->err), &out, result);
}

// --- Tessellation ---

static CagStatus tessellate_shape(CagValue v, const CagTessellation *how, CagMesh **out,
                                  CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagTessellation own = *how;
  if (own.tolerance <= 0) own.tolerance = shape->tolerance;
  switch (v.type) {
  case CAG_SURFACE: return cag_surface_tessellate(shape->as.surface, &own, out, err);
  case CAG_SOLID: return cag_solid_tessellate(shape->as.solid, &own, out, err);
  case CAG_MESH: *out = cag_mesh_retain(shape->as.mesh); return CAG_OK;
  case CAG_REGION: {
    CagSurface *flat = NULL;
    if (cag_region_is_empty(shape->as.region))
      return cag_mesh_new(0, 0, false, false, false, out, err);
    CagStatus status = cag_surface_planar(shape->as.region, shape->placement, &flat, err);
    if (!status) status = cag_surface_tessellate(flat, &own, out, err);
    cag_surface_release(flat);
    return status;
  }
  case CAG_LABEL: return cag_mesh_new(0, 0, false, false, false, out, err);
  default:
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_faces, "", -1,
                    "a curve has no faces; `tube` gives it a thickness");
  }
}

// Grids are created with the longest edge in mind, but flat faces and parts sewn to grids can
// exceed it.
static CagStatus keep_edges(CagMesh **mesh, const CagTessellation *how, CagError *err) {
  CagMesh *fine;
  if (!(how->max_edge > 0)) return CAG_OK;
  CagStatus status = cag_mesh_split_edges(*mesh, how->max_edge, how->max_triangles, &fine, err);
  if (status) return status;
  cag_mesh_release(*mesh);
  *mesh = fine;
  return CAG_OK;
}

CagTessellation cag_run_tessellation(CagVm *vm) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  if (vm->max_triangles > 0) how.max_triangles = vm->max_triangles;
  how.interrupt = cag_vm_stop(vm);
  return how;
}

bool cag_solids_tessellate(CagCall *call, const struct cag_solids_tessellate *a, CagValue *result) {
  CagTessellation how = cag_run_tessellation(call->vm);
  CagList *shapes;
  how.tolerance = a->tolerance;
  how.angle = a->angle;
  how.max_edge = a->max_edge;
  if (!(how.angle > 0))
    return cag_fail_call(call, 2, CAG_ERR_value, "expects an angle greater than 0");
  if (!cag_list_shapes(call, call->values[0], &shapes)) return false;
  if (shapes->length == 0) return cag_fail_call(call, 0, CAG_ERR_value, "expects a shape");
  const size_t n = shapes->length;
  CagMesh **meshes = cag_hold_mesh_array(call, n), *whole = NULL;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++)
    status = tessellate_shape(cag_list_get(call->vm, shapes, i), &how, &meshes[i], call->err);
  if (!status && n == 1) whole = cag_mesh_retain(meshes[0]);
  else if (!status) status = cag_mesh_append(meshes, n, &whole, call->err);
  cag_release_held(call, meshes);
  if (!status) status = keep_edges(&whole, &how, call->err);
  if (status) cag_mesh_release(whole);
  if (!cag_mesh_result(call, status, &whole, result)) return false;
  cag_shape_say_alike(*result, cag_list_get(call->vm, shapes, 0));
  return true;
}
