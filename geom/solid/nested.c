// Orientation of the parts of a closed shell: outward, or inward if a part is a cavity of another.

#include <math.h>

#include "base/memory.h"
#include "geom/distance/separation.h"
#include "geom/solid/build.h"
#include "geom/tessellate/tessellate.h"

// A connected part of a shell.
typedef struct Part {
  double terms[10]; // volume terms with the current orientation of its faces
  CagMesh *mesh;
  CagBounds box;
} Part;

static CagStatus add_mesh(const CagSurface *face, Part *p, CagError *err) {
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *both[2] = {p->mesh, NULL};
  CagStatus status = cag_surface_tessellate(face, &how, &both[1], err);
  if (status) return status;
  p->mesh = NULL;
  status = both[0] ? cag_mesh_append(both, 2, &p->mesh, err) : CAG_OK;
  if (!both[0]) p->mesh = cag_mesh_retain(both[1]);
  cag_mesh_release(both[0]);
  cag_mesh_release(both[1]);
  return status;
}

static bool holds(const CagBounds *a, const CagBounds *b) {
  return a->min.x <= b->min.x && a->min.y <= b->min.y && a->min.z <= b->min.z &&
         a->max.x >= b->max.x && a->max.y >= b->max.y && a->max.z >= b->max.z;
}

// Parts at most touch, so one point decides; the centroid of a triangle is not on an edge.
static bool is_within(const Part *inner, const Part *outer) {
  const CagMesh *m = inner->mesh;
  if (m->triangle_count == 0 || !holds(&outer->box, &inner->box) ||
      !(fabs(outer->terms[0]) > fabs(inner->terms[0])))
    return false;
  const uint32_t *k = m->triangles + 3 * (m->triangle_count / 2);
  CagVec3 sum = cag_add(cag_add(m->positions[k[0]], m->positions[k[1]]), m->positions[k[2]]);
  return fabs(cag_mesh_winding(outer->mesh, cag_scaled(sum, 1.0 / 3))) > 0.5;
}

CagStatus cag_solid_nest(CagSurface *const *faces, size_t n, const size_t *part, size_t parts,
                         bool *turn, CagError *err) {
  Part *all = cag_calloc(parts + 1, sizeof *all);
  if (!all) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t f = 0; !status && f < n; f++) {
    status = cag_surface_volume_terms(faces[f], all[part[f]].terms, err);
    if (!status && parts > 1) status = add_mesh(faces[f], &all[part[f]], err);
  }
  for (size_t i = 0; i < parts; i++)
    if (all[i].mesh) all[i].box = cag_mesh_bounds(all[i].mesh);
  for (size_t i = 0; !status && i < parts; i++) {
    size_t around = 0;
    for (size_t k = 0; k < parts; k++)
      around += k != i && all[i].mesh && all[k].mesh && is_within(&all[i], &all[k]);
    const bool wrong = (all[i].terms[0] < 0) != (around % 2 == 1);
    for (size_t f = 0; f < n; f++)
      if (part[f] == i) turn[f] = wrong;
  }
  for (size_t i = 0; i < parts; i++) cag_mesh_release(all[i].mesh);
  cag_free(all);
  return status;
}
