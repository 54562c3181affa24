// What is wrong with faces as the boundary of a solid, in numbers.

#include "geom/mesh/check.h"
#include "interp/builtin/solids.h"

static CagValue check_value(CagVm *vm, const CagMeshCheck *c) {
  static const char *const names[] = {"vertices",
                                      "edges",
                                      "faces",
                                      "euler",
                                      "shells",
                                      "boundary_edges",
                                      "nonmanifold_edges",
                                      "nonmanifold_vertices",
                                      "closed",
                                      "oriented",
                                      "solid",
                                      "genus",
                                      "volume"};
  bool whole = c->closed && c->oriented;
  const CagValue values[] = {cag_number((double)c->vertices),
                             cag_number((double)c->edges),
                             cag_number((double)c->faces),
                             cag_number((double)c->euler),
                             cag_number((double)c->shells),
                             cag_number((double)c->boundary_edges),
                             cag_number((double)c->nonmanifold_edges),
                             cag_number((double)c->nonmanifold_vertices),
                             cag_bool(c->closed),
                             cag_bool(c->oriented),
                             cag_bool(c->solid),
                             whole ? cag_number((double)c->genus) : cag_none(),
                             whole ? cag_number(c->volume) : cag_none()};
  return cag_record_new(vm, names, values, sizeof values / sizeof *values);
}

bool cag_checks_check_mesh(CagCall *call, CagValue *result) {
  CagMeshCheck check = {0};
  const CagMesh *m = CAG_AS_SHAPE(call->values[0])->as.mesh;
  if (!cag_geometry_ok(call, cag_mesh_check(m, &check, call->err))) return false;
  *result = check_value(call->vm, &check);
  return true;
}

bool cag_checks_check_faces(CagCall *call, CagValue *result) {
  CagMeshCheck check = {0};
  CagVec3 *vertices;
  size_t n, faces;
  uint32_t *counts, *indices;
  if (!cag_arg_points(call, 0, &vertices, &n, NULL)) return false;
  cag_hold(call, vertices);
  if (!cag_arg_faces(call, 1, n, &counts, &indices, &faces)) return false;
  CagStatus status = cag_faces_check(vertices, n, indices, counts, faces, &check, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = check_value(call->vm, &check);
  return true;
}
