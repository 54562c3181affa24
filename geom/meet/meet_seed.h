// Seeds for marching intersection curves of two surfaces: points where the triangles of their
// meshes intersect or are close to each other.

#ifndef CAG_GEOM_MEET_MEET_SEED_H
#define CAG_GEOM_MEET_MEET_SEED_H

#include "geom/mesh/mesh.h"
#include "geom/surface/crease.h"

typedef struct CagMarchSide {
  const CagSurface *s;
  const CagRegion *region; // only its inside counts; NULL: the whole surface
  CagMesh *mesh;
  CagPatches patches;
} CagMarchSide;

typedef struct CagMarchNode {
  CagVec3 x, tangent; // unit
  double at[2][2];    // u, v on each surface
  size_t patch[2][2]; // the patches that contain them, by u and v
} CagMarchNode;

typedef struct CagMarchSeeds {
  CagMarchNode *items;
  size_t count, capacity;
} CagMarchSeeds;

typedef enum CagMarchFound {
  CAG_MARCH_FOUND,
  CAG_MARCH_NONE,
  CAG_MARCH_TANGENT, // a point at which the curve has no direction
  CAG_MARCH_FAILED
} CagMarchFound;

typedef struct CagMarch CagMarch;
// Locates the point of a curve in the plane through q perpendicular to n, starting from the node's
// parameters. If n is zero, it locates the nearest point. The tangent is oriented along `along`.
typedef CagMarchFound CagMarchLocate(CagMarch *m, CagVec3 q, CagVec3 n, CagVec3 along,
                                     CagMarchNode *node);

struct CagMarch {
  CagMarchSide side[2];
  double size, tolerance, mesh_tolerance, step_most, step_first, least_run;
  CagMarchSeeds crossings, touches; // starting points of runs
  CagMarchSeeds *seeds;             // seeds of the current kind
  size_t touching;                  // number of crossing seeds at which the surfaces touch
  CagMarchLocate *locate;           // locates crossings or touches
  const volatile int *interrupt;
  CagError *err;
  CagStatus status; // of the failure that ends the march
};

// Records the status of a permanent failure; returns false.
bool cag_march_fail(CagMarch *m, CagStatus status);
// The range of the node's patch on side k in a direction: two values.
const double *cag_march_range(const CagMarch *m, int k, const CagMarchNode *node, int direction);
bool cag_march_add_seed(CagMarch *m, CagMarchSeeds *list, const CagMarchNode *seed);
// Adds seeds with their parameters on both sides. Crossings are points where triangles intersect.
// Touches are points where nearly parallel triangles are within `margin` of each other, one for
// each cell of space.
bool cag_march_find_seeds(CagMarch *m, double margin);

#endif
