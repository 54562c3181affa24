// Tests whether points lie within a solid.
//
// Solids without an equation are meshed once; points outside of a mesh's bounds are decided without
// it.

#include "geom/solid/inside.h"
#include "geom/solid/tessellate.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/distance/separation.h"
#include "geom/linalg/tolerance.h"
#include "geom/solid/csg.h"
#include "geom/solid/kind.h"

// A point is on a boundary if it is closer than this fraction of the size: rounding of transforms.
#define ON_BOUNDARY CAG_ROUNDING

typedef struct LeafMesh {
  const CagSolid *leaf;
  CagMesh *mesh; // in the coordinates of the queried point
  CagBounds box;
} LeafMesh;

struct CagInside {
  const CagSolid *solid;
  CagTessellation how;
  double slack;
  LeafMesh *leaves; // filled on demand
  size_t count;
};

CagStatus cag_inside_new(const CagSolid *s, const CagTessellation *how, CagInside **out,
                         CagError *err) {
  CagBounds reach;
  CagStatus status = cag_solid_reach(s, &reach, err);
  if (status) return status;
  CagInside *inside = cag_calloc(1, sizeof *inside);
  if (!inside) return cag_fail_memory(err);
  double size = cag_norm(cag_sub(reach.max, reach.min));
  *inside = (CagInside){.solid = s, .how = *how, .slack = isfinite(size) ? ON_BOUNDARY * size : 0};
  *out = inside;
  return CAG_OK;
}

void cag_inside_free(CagInside *inside) {
  if (!inside) return;
  for (size_t i = 0; i < inside->count; i++) cag_mesh_release(inside->leaves[i].mesh);
  cag_free(inside->leaves);
  cag_free(inside);
}

// --- Meshes ---

static CagStatus leaf_mesh(CagInside *inside, const CagSolid *s, LeafMesh **out, CagError *err) {
  for (size_t i = 0; i < inside->count; i++)
    if (inside->leaves[i].leaf == s) {
      *out = &inside->leaves[i];
      return CAG_OK;
    }
  if (!CAG_RESIZE(inside->leaves, inside->count + 1)) return cag_fail_memory(err);
  LeafMesh *made = &inside->leaves[inside->count];
  CagStatus status = cag_solid_tessellate(s, &inside->how, &made->mesh, err);
  if (status) return status;
  made->leaf = s;
  made->box = cag_mesh_bounds(made->mesh);
  inside->count++;
  *out = made;
  return CAG_OK;
}

static bool outside_box(const CagBounds *b, CagVec3 p) {
  return p.x < b->min.x || p.y < b->min.y || p.z < b->min.z || p.x > b->max.x || p.y > b->max.y ||
         p.z > b->max.z;
}

static CagStatus side_of_leaf(void *context, const CagSolid *leaf, CagVec3 p, int *side,
                              CagError *err) {
  CagInside *inside = context;
  const CagSolidKindRow *kind = &cag_solid_kinds[leaf->kind];
  if (kind->beyond) { // no mesh is needed
    CagTransform back;
    CagStatus status = cag_transform_inverse(&leaf->placement, &back, err);
    if (status) return status;
    const double distance = kind->beyond(leaf, cag_transform_point(&back, p));
    *side = fabs(distance) <= inside->slack ? 0 : distance < 0 ? -1 : 1;
    return CAG_OK;
  }
  LeafMesh *m = NULL;
  CagStatus status = leaf_mesh(inside, leaf, &m, err);
  if (status) return status;
  *side = outside_box(&m->box, p) || cag_mesh_winding(m->mesh, p) < 0.5 ? 1 : -1;
  return CAG_OK;
}

CagStatus cag_inside_holds(CagInside *inside, CagVec3 p, bool *out, CagError *err) {
  int side = 1;
  CagStatus status =
      cag_csg_side(inside->solid, p, inside->slack, side_of_leaf, inside, &side, err);
  *out = side <= 0;
  return status;
}
