// The shapes of a value as what rays are cast at.

#ifndef CAG_INTERP_BUILTIN_TARGETS_H
#define CAG_INTERP_BUILTIN_TARGETS_H

#include "geom/ray/bvh.h"
#include "geom/ray/caster.h"
#include "geom/solid/tessellate.h"
#include "interp/vm/builtin.h"

typedef struct CagTargetPart {
  CagValue value; // the shape, which the memo of the target keeps alive
  const CagShape *shape;
  CagCaster *caster; // owned by the target
  size_t number;     // among the parts in the order of the script
} CagTargetPart;

// Curves and labels, which have no surface, and hidden shapes are left out, and so are cameras,
// lights, and settings in lists.
typedef struct CagTarget {
  CagTargetPart *parts;
  size_t count;
  size_t bounded; // the first parts are bounded, and in `boxes`
  CagBvh boxes;
  CagBounds bounds; // of the bounded ones
  double size;      // diagonal of the bounds
  CagValue *others; // of a target for distances: curves and labels
  size_t other_count;
} CagTarget;

// What a ray meets: the number of the part, and where.
typedef struct CagTargetHit {
  size_t part;
  CagCrossing at;
} CagTargetHit;

// Finds or makes the target of an argument: a shape, group, or robot, or a list of these. It belongs
// to the machine and is valid until the next call of this function, or of a built-in.
bool cag_arg_ray_target(CagCall *call, int argument, const CagTarget **out);
// The same for distances: hidden shapes are parts as well, and curves and labels are kept.
bool cag_arg_near_target(CagCall *call, int argument, const CagTarget **out);
// The caster of a solid, surface, or mesh, in the same way.
bool cag_shape_caster(CagCall *call, CagValue shape, const CagCaster **out);

// The first part that the ray meets. `work` is a list whose memory is reused; start with {0}.
CagStatus cag_target_first(const CagTarget *t, const CagRay *ray, CagCrossings *work,
                           CagTargetHit *out, bool *met, CagError *err);
// What is closer to p than this is at p: a ray that starts there skips it.
double cag_target_skipped(const CagTarget *t, CagVec3 p);
// Whether the segment from p to q meets no part, apart from points at its ends.
CagStatus cag_target_sees(const CagTarget *t, CagVec3 p, CagVec3 q, CagCrossings *work, bool *sees,
                          CagError *err);
// The point of a target nearest to p, if it is at most `most` away. Inside of a solid or closed mesh,
// it is p. Where the operands of a set operation do not decide, the search starts from its mesh.
typedef struct CagTargetNearest {
  bool found;
  size_t part; // from the number of parts on: one of the other shapes
  CagVec3 point;
  double distance;
} CagTargetNearest;
bool cag_target_closest(CagCall *call, const CagTarget *t, CagVec3 p, double most,
                        CagTargetNearest *out);

// A mesh of a solid, surface, or mesh to a tolerance; 0: by its size.
CagStatus cag_shape_mesh(const CagVm *vm, CagValue v, double tolerance, CagMesh **out,
                         CagError *err);
CagTessellation cag_shape_tessellation(const CagVm *vm, double tolerance);
// The tolerance for replacing a shape by points or triangles, as a fraction of its size.
#define CAG_SHAPE_TOLERANCE 1e-4

// The name of a part, or of one of the other shapes: a text, or none.
CagValue cag_target_name(const CagTarget *t, size_t part);
// The material of the part where it was met: a record, or none.
CagValue cag_target_material(const CagVm *vm, const CagTarget *t, const CagTargetHit *hit);

#endif
