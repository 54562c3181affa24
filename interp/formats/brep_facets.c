// Solids with plane faces from meshes (see brep_facets.h).

#include "interp/formats/brep_facets.h"

#include <math.h>
#include <string.h>

#include "geom/mesh/facets.h"
#include "interp/formats/brep_build.h"

// Corners that are farther from a plane than this fraction of the mesh's largest coordinate are not
// on it: twice the rounding of coordinates with single precision, which many mesh files have.
#define COPLANAR 1.2e-7

static double largest_coordinate(const CagMesh *m) {
  const CagBounds box = cag_mesh_bounds(m);
  const double all[6] = {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
  double most = 0;
  for (int i = 0; i < 6; i++) most = fmax(most, fabs(all[i]));
  return most;
}

static bool reserve_facets(CagBrep *b, const CagFacets *f) {
  return cag_brep_reserve((void **)&b->vertices, b->vertex_count, f->vertex_count,
                          sizeof *b->vertices) &&
         cag_brep_reserve((void **)&b->edges, b->edge_count, f->edge_count, sizeof *b->edges) &&
         cag_brep_reserve((void **)&b->uses, b->use_count, f->use_count, sizeof *b->uses) &&
         cag_brep_reserve((void **)&b->loops, b->loop_count, f->loop_count, sizeof *b->loops) &&
         cag_brep_reserve((void **)&b->faces, b->face_count, f->face_count, sizeof *b->faces) &&
         cag_brep_reserve((void **)&b->shells, b->shell_count, f->shell_count, sizeof *b->shells);
}

static void add_edges(CagBrep *b, const CagFacets *f) {
  const size_t vertex = b->vertex_count;
  memcpy(b->vertices + vertex, f->vertices, f->vertex_count * sizeof *f->vertices);
  b->vertex_count += f->vertex_count;
  for (size_t i = 0; i < f->edge_count; i++)
    b->edges[b->edge_count++] = (CagBrepEdge){
        .from = vertex + f->edges[i].from, .to = vertex + f->edges[i].to, .straight = true};
}

// The plane of a face, with x along its first edge.
static CagStatus facet_plane(const CagBrep *b, const CagBrepFace *own, const CagFacet *f,
                             CagCarrier *out, CagError *err) {
  const CagBrepEdge *e = &b->edges[b->uses[b->loops[own->first].first].edge];
  const CagVec3 x = cag_sub(b->vertices[e->to], b->vertices[e->from]);
  *out = (CagCarrier){.kind = CAG_CARRIER_PLANE};
  return cag_axes(f->origin, x, cag_cross(f->normal, x), &out->frame, err);
}

static CagStatus add_plane_faces(CagBrep *b, const CagFacets *f, size_t edge, CagError *err) {
  const size_t use = b->use_count, loop = b->loop_count;
  for (size_t i = 0; i < f->use_count; i++)
    b->uses[b->use_count++] = (CagBrepUse){edge + f->uses[i].edge, f->uses[i].reversed, NULL};
  for (size_t i = 0; i < f->loop_count; i++)
    b->loops[b->loop_count++] = (CagBrepLoop){use + f->loops[i].first, f->loops[i].count};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < f->face_count; i++) {
    CagBrepFace own = {.first = loop + f->faces[i].first, .count = f->faces[i].count};
    status = facet_plane(b, &own, &f->faces[i], &own.carrier, err);
    b->faces[b->face_count++] = own;
  }
  return status;
}

CagStatus cag_brep_add_facets(CagBrep *b, const CagMesh *m, CagBrepShape *shape, CagError *err) {
  CagFacets f;
  CagStatus status = cag_mesh_facets(m, COPLANAR * largest_coordinate(m), &f, err);
  if (status) return status;
  const size_t edge = b->edge_count, face = b->face_count, shell = b->shell_count;
  status = reserve_facets(b, &f) ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    add_edges(b, &f);
    status = add_plane_faces(b, &f, edge, err);
  }
  for (size_t i = 0; !status && i < f.shell_count; i++)
    b->shells[b->shell_count++] = (CagBrepShell){face + f.shells[i].first, f.shells[i].count, true,
                                                 shell + f.shells[i].void_of};
  shape->kind = CAG_BREP_SOLID;
  shape->first = shell;
  shape->count = b->shell_count - shell;
  shape->facets = f.face_count;
  shape->flatness = f.flatness;
  b->accuracy = fmax(b->accuracy, 2 * f.flatness);
  cag_facets_free(&f);
  return status;
}
