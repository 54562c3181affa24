// The table of the types of values.

#include "interp/builtin/types.h"

const CagValueType *const cag_value_types[] = {
    [CAG_NONE] = &cag_type_none,        [CAG_BOOL] = &cag_type_bool,
    [CAG_NUMBER] = &cag_type_number,    [CAG_ANGLE] = &cag_type_angle,
    [CAG_JET] = &cag_type_jet,          [CAG_TEXT] = &cag_type_text,
    [CAG_LIST] = &cag_type_list,        [CAG_RANGE] = &cag_type_range,
    [CAG_RECORD] = &cag_type_record,    [CAG_CLOSURE] = &cag_type_closure,
    [CAG_BUILTIN] = &cag_type_builtin,  [CAG_TRANSFORM] = &cag_type_transform,
    [CAG_CURVE] = &cag_type_curve,      [CAG_REGION] = &cag_type_region,
    [CAG_SURFACE] = &cag_type_surface,  [CAG_SOLID] = &cag_type_solid,
    [CAG_MESH] = &cag_type_mesh,        [CAG_LABEL] = &cag_type_label,
    [CAG_GROUP] = &cag_type_group,      [CAG_PLANE] = &cag_type_plane,
    [CAG_LINK] = &cag_type_link,        [CAG_ROBOT] = &cag_type_robot,
    [CAG_CAMERA] = &cag_type_camera,    [CAG_LIGHT] = &cag_type_light,
    [CAG_SETTING] = &cag_type_setting,  [CAG_IMAGE] = &cag_type_image,
    [CAG_MODULE] = &cag_type_module,    [CAG_UNSET] = &cag_type_internal,
    [CAG_INTERNAL] = &cag_type_internal};
