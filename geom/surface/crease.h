// Divides a surface into patches along its creases, across which the normal jumps.

#ifndef CAG_GEOM_SURFACE_CREASE_H
#define CAG_GEOM_SURFACE_CREASE_H

#include "geom/surface/surface.h"

// The ends of the patches along a direction (n + 1 values, to be freed): the edges of the surface
// and the breaks across which the normal jumps, or all breaks.
CagStatus cag_surface_patch_ends(const CagSurface *s, bool all, int direction, double **out,
                                 size_t *n, CagError *err);

typedef struct CagPatches {
  const CagSurface *s;
  double *ends[2]; // n[d] + 1 of them
  size_t n[2];
  bool wraps[2]; // the direction has a single patch that continues smoothly across the seam
} CagPatches;

CagStatus cag_patches_open(const CagSurface *s, CagPatches *out, CagError *err);
void cag_patches_free(CagPatches *p);
// Index of the patch that contains a parameter.
size_t cag_patches_find(const CagPatches *p, int direction, double x);

typedef struct CagPatchPlace {
  size_t patch[2];
  double at[2];
} CagPatchPlace;
// The same point in all patches that contain it, the given patch first. Points within `near` of an
// edge, relative to the patch's width, count as on the edge. Returns the number, at most 9.
size_t cag_patches_beside(const CagPatches *p, const CagPatchPlace *place, double near,
                          CagPatchPlace out[9]);

#endif
