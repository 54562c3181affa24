// Declarations shared by the built-ins on scenes.

#ifndef CAG_INTERP_BUILTIN_SCENE_H
#define CAG_INTERP_BUILTIN_SCENE_H

#include "interp/builtin/shapes.h"
#include "interp/scene/scene.h"

// Reads a color from a text or [r, g, b]. Messages call it `what` and name the argument.
bool cag_color_read(CagCall *call, int argument, const char *what, CagValue v, CagColor *out);
CagValue cag_color_value(CagVm *vm, CagColor c);

// Copies the first argument, a shape, or a list of shapes as a group, in order to change it.
bool cag_scene_copy(CagCall *call, CagValue *result);

// Fields of a record that was checked when it was made; `fallback` if there is no such field, or r
// is NULL.
double cag_number_field(const CagRecord *r, const char *name, double fallback);
CagVec3 cag_point_field(const CagRecord *r, const char *name, CagVec3 fallback);
// Pixels along one side of a picture: more would be 10 GB.
#define CAG_PICTURE_PIXELS_MAX 65536
// Reads the size of a picture: two whole numbers of pixels.
bool cag_picture_size(CagCall *call, int argument, CagNumbers size, double out[2]);
// A camera as plain data, without a name.
CagCamera cag_camera_of_value(const CagSceneValue *v);
// A light as plain data.
CagLight cag_light_of_value(const CagSceneValue *v);

#endif
