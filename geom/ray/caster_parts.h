// The parts of a caster, which the files of casters share.

#ifndef CAG_GEOM_RAY_CASTER_PARTS_H
#define CAG_GEOM_RAY_CASTER_PARTS_H

#include "geom/ray/nearest.h"
#include "geom/ray/ray_mesh.h"
#include "geom/ray/ray_patch.h"
#include "geom/ray/ray_primitive.h"

typedef enum CagCasterKind {
  CAG_CASTER_FACES,     // surfaces; those of a solid close it
  CAG_CASTER_MESH,      // triangles
  CAG_CASTER_PRIMITIVE, // a box, sphere, cylinder, or cone
  CAG_CASTER_FORM,      // the points at which a quadratic form is negative
  CAG_CASTER_OPERATION  // of other casters
} CagCasterKind;

struct CagCaster {
  CagCasterKind kind;
  bool closed;      // a solid or closed mesh
  CagBounds bounds; // in the world
  double size;      // diagonal of the bounds; 0 if they are infinite
  uint32_t label;
  // Of FACES and MESH in an operation that was moved: from the world to their own coordinates. A
  // similarity.
  bool placed;
  CagTransform back;
  CagRayPatch **faces;
  size_t face_count;
  CagRayMesh *mesh;
  CagRayPrimitive primitive;
  CagSolid *image; // of a PRIMITIVE in the world, if its nearest points are those of its faces
  CagQuadric form;
  CagSolidKind operation;
  CagCaster **operands;
  size_t operand_count;
  CagBvh boxes; // of the bounded operands, if they are many
};

// Whether the boundary of a set operation passes through a point of an operand's boundary whose
// normal passes through p.
CagStatus cag_operation_ends_at(const CagCaster *c, CagVec3 p, const CagNearest *found,
                                CagCrossings *work, bool *on, CagError *err);

#endif
