// What several files of built-ins on cameras share.

#ifndef CAG_INTERP_BUILTIN_CAMERAS_H
#define CAG_INTERP_BUILTIN_CAMERAS_H

#include "geom/camera/camera.h"
#include "interp/builtin/scene.h"

// A camera, or its 3x4 matrix.
bool cag_arg_camera_map(CagCall *call, int argument, CagCameraMap *out);
// A 3x4 matrix.
bool cag_arg_camera_rows(CagCall *call, int argument, double out[3][4]);
// A list of `columns` rows of numbers.
CagValue cag_rows_value(CagVm *vm, const double *x, size_t rows, size_t columns);
// The pinhole with these parts, whose pixels are `pitch` mm wide.
CagValue cag_pinhole_value(CagVm *vm, const CagCameraParts *parts, CagVec3 center, double pitch,
                           const double size[2]);

#endif
