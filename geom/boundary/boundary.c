// The memory of boundaries.

#include "geom/boundary/boundary.h"

#include "base/memory.h"

void cag_boundary_free(CagBoundary *b) {
  for (size_t i = 0; i < b->edge_count; i++) cag_curve_release(b->edges[i].curve);
  for (size_t i = 0; i < b->use_count; i++) cag_curve_release(b->uses[i].trace);
  for (size_t i = 0; i < b->face_count; i++) {
    cag_surface_release(b->faces[i].carrier.spline);
    cag_curve_release(b->faces[i].carrier.profile);
  }
  cag_free(b->corners);
  cag_free(b->edges);
  cag_free(b->uses);
  cag_free(b->loops);
  cag_free(b->faces);
  cag_free(b->shells);
  cag_free(b->order);
  cag_free(b->name);
  cag_free(b->body);
  cag_mesh_release(b->mesh);
  *b = (CagBoundary){0};
}
