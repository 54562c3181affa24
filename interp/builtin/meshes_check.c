// Reports in numbers what prevents faces from being the boundary of a solid.

#include "geom/mesh/check.h"
#include "interp/builtin/solids.h"

static bool check_result(CagCall *call, CagStatus status, const CagMeshCheck *c, CagValue *result) {
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
  if (!cag_geometry_ok(call, status)) return false;
  const bool whole = c->closed && c->oriented;
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
  *result = cag_record_new(call->vm, names, values, sizeof values / sizeof *values);
  return true;
}

bool cag_checks_check_mesh(CagCall *call, const struct cag_checks_check_mesh *a, CagValue *result) {
  CagMeshCheck check = {0};
  return check_result(call, cag_mesh_check(a->M, &check, call->err), &check, result);
}

bool cag_checks_check_faces(CagCall *call, const struct cag_checks_check_faces *a,
                            CagValue *result) {
  CagMeshCheck check = {0};
  size_t faces;
  uint32_t *counts, *indices;
  if (!cag_arg_faces(call, 1, a->vertices.count, &counts, &indices, &faces)) return false;
  CagStatus status = cag_faces_check(a->vertices.items, a->vertices.count, indices, counts, faces,
                                     &check, call->err);
  return check_result(call, status, &check, result);
}
