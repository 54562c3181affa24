// Tessellation of solids: by their faces, by exact boundaries, or by the mesh of a set operation.

#include "geom/solid/tessellate.h"

#include "geom/solid/csg.h"
#include "geom/solid/exact.h"

CagStatus cag_solid_tessellate(const CagSolid *s, const CagTessellation *how, CagMesh **out,
                               CagError *err) {
  if (cag_solid_is_compound(s)) return cag_csg_mesh(s, how, out, err);
  if (s->exact) return cag_exact_mesh(s, how, out, err);
  CagBounds bounds;
  const CagFaces faces = {s->faces, s->face_count, s->edges, s->edge_count};
  CagStatus status = cag_solid_bounds(s, &bounds, err);
  return status ? status : cag_faces_tessellate(&faces, &bounds, how, out, err);
}
