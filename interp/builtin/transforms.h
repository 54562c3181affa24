// Functions of the transforms' table (transforms.c), by the file that holds them.

#ifndef CAG_INTERP_BUILTIN_TRANSFORMS_H
#define CAG_INTERP_BUILTIN_TRANSFORMS_H

#include "interp/builtin/shapes.h"

extern const CagBuiltin cag_builtins_transforms[];

// clang-format off
#define CAG_TRANSFORM_FUNCTIONS(X) \
  /* transforms_move.c: also take what they move */ \
  X(translate) X(rotate) X(scale) X(reflect) X(shear) X(project) X(moved) \
  /* transforms_make.c */ \
  X(reflect_line) X(reflect_point) X(from_rows) X(axes) X(look_at) X(euler) X(rpy) \
  X(quaternion) X(axis_angle) X(cylindrical) X(spherical) X(dh) X(mdh) X(from_pairs) \
  X(solve_frame) \
  /* transforms_ask.c */ \
  X(inverse) X(determinant) X(transpose) X(position) X(rotation) X(euler_of) X(rpy_of) \
  X(axis_angle_of) X(quaternion_of) X(classify) X(homogeneous) X(dehomogenize) X(mix) \
  /* transforms_plane.c */ \
  X(plane) X(polar) X(intersect_lines) X(distance_to_line) X(area_of_points) \
  X(centroid_of_points) X(contains)
// clang-format on

#define X(name) bool cag_transforms_##name(CagCall *call, CagValue *result);
CAG_TRANSFORM_FUNCTIONS(X)
#undef X

#endif
