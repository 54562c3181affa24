// Geometry held by built-ins (see builtin.h): single objects, and arrays of them.
//
//   cag_hold_curve(call, c)         releases c when the built-in ends; c may be NULL
//   cag_hold_curve_array(call, n)   an array of n curves, all NULL; its curves are released with it
//
// and the same for regions, surfaces, meshes, and solids. cag_release_held releases either early.

#ifndef CAG_INTERP_BUILTIN_HOLDS_H
#define CAG_INTERP_BUILTIN_HOLDS_H

#include "geom/meet/section.h"
#include "interp/vm/builtin.h"

// clang-format off
#define CAG_HELD_GEOMETRY(X) \
  X(CagCurve, curve) X(CagRegion, region) X(CagSurface, surface) X(CagMesh, mesh) X(CagSolid, solid)
// clang-format on

#define X(Type, name)                                                                              \
  void cag_hold_##name(CagCall *call, Type *what);                                                 \
  Type **cag_hold_##name##_array(CagCall *call, size_t n);
CAG_HELD_GEOMETRY(X)
#undef X

// Returns an empty list. The curves that are added to it are released with it.
CagCurveList *cag_hold_curve_list(CagCall *call);

#endif
