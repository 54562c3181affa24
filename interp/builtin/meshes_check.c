// What is wrong with faces as the boundary of a solid, in numbers.

#include "geom/mesh/check.h"
#include "interp/builtin/solids.h"

static const char meshes[] = "Meshes";

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

static bool check_mesh(CagCall *call, CagValue *result) {
  CagMeshCheck check = {0};
  CagError err;
  const CagMesh *m = CAG_AS_SHAPE(call->values[0])->as.mesh;
  if (!cag_geometry_ok(call, cag_mesh_check(m, &check, &err), &err)) return false;
  *result = check_value(call->vm, &check);
  return true;
}

static bool check_faces(CagCall *call, CagValue *result) {
  CagMeshCheck check = {0};
  CagError err;
  CagVec3 *vertices;
  size_t n, faces;
  uint32_t *counts, *indices;
  if (!cag_arg_points(call, 0, &vertices, &n, NULL)) return false;
  cag_hold(call, vertices);
  if (!cag_arg_faces(call, 1, n, &counts, &indices, &faces)) return false;
  CagStatus status = cag_faces_check(vertices, n, indices, counts, faces, &check, &err);
  if (!cag_geometry_ok(call, status, &err)) return false;
  *result = check_value(call->vm, &check);
  return true;
}

#define REPORT                                                                                     \
  "vertices (those that faces name), edges, faces, euler (vertices - edges + faces), shells "      \
  "(parts connected over edges), boundary_edges (of one face), nonmanifold_edges (of three or "    \
  "more), nonmanifold_vertices (where the faces around are several fans), closed (each edge is "   \
  "of two faces), oriented (no two faces run an edge in the same sense), solid (closed, "          \
  "oriented, no such vertices and a volume above 0), and if closed and oriented genus (handles, "  \
  "touching vertices taken apart) and volume (mm3, negative inside out), else none."

const CagBuiltin cag_builtins_checks[] = {
    {"mesh_check(M: mesh)", check_mesh, "record",
     "Whether a mesh is the boundary of a solid: " REPORT,
     "print mesh_check(tessellate(torus(3, 1))).genus // expect: 1", CAG_TAKES(MESH), meshes},
    {"mesh_check(vertices: list of points, faces: list of lists of integers)", check_faces,
     "record",
     "The same of faces with any number of corners, as mesh takes them, before they are cut into "
     "triangles: " REPORT,
     "square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]\n"
     "print mesh_check(square, [[0, 1, 2, 3]]).boundary_edges // expect: 4",
     CAG_TAKES_LISTS, meshes},
    {0}};
