// The rows of types outside the language, for the table of types in types.c.

#ifndef CAG_INTERP_BUILTIN_TYPES_H
#define CAG_INTERP_BUILTIN_TYPES_H

#include "interp/vm/value_type.h"

extern const CagValueType cag_type_transform, cag_type_plane, cag_type_curve, cag_type_region,
    cag_type_surface, cag_type_solid, cag_type_mesh, cag_type_label, cag_type_group;
extern const CagValueType cag_type_camera, cag_type_light, cag_type_setting;
extern const CagValueType cag_type_link, cag_type_robot;
extern const CagValueType cag_type_image;

// T * list: points, or any objects that can be moved (transforms_apply.c).
bool cag_move_list(CagCall *call, const CagTransform *t, CagValue list, CagValue *result);

#endif
