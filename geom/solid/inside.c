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

// --- Equations: signed distance measure of p outside of a primitive in its own coordinates;
// negative inside ---

static double beyond_box(const CagSolid *s, CagVec3 p) {
  CagVec3 half = cag_vec3(s->a / 2, s->b / 2, s->c / 2);
  if (!s->centered) p = cag_sub(p, half);
  return fmax(fabs(p.x) - half.x, fmax(fabs(p.y) - half.y, fabs(p.z) - half.z));
}

static double beyond_frustum(const CagSolid *s, CagVec3 p) {
  double height = s->a, radius = s->b, top = s->c, slope = (top - radius) / height;
  double side = (hypot(p.x, p.y) - radius - slope * p.z) / hypot(1, slope);
  return fmax(side, fmax(-p.z, p.z - height));
}

static bool beyond(const CagSolid *s, CagVec3 p, double *out) {
  switch (s->kind) {
  case CAG_SOLID_BOX: *out = beyond_box(s, p); return true;
  case CAG_SOLID_SPHERE: *out = cag_norm(p) - s->a; return true;
  case CAG_SOLID_CYLINDER: *out = beyond_frustum(s, p); return true;
  case CAG_SOLID_TORUS: *out = hypot(hypot(p.x, p.y) - s->a, p.z) - s->b; return true;
  default: return false;
  }
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
  double distance;
  if (beyond(leaf, p, &distance)) { // no mesh needed: called only to dispatch by the kind
    CagTransform back;
    CagStatus status = cag_transform_inverse(&leaf->placement, &back, err);
    if (status) return status;
    beyond(leaf, cag_transform_point(&back, p), &distance);
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
