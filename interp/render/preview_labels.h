// Labels in pictures of the built-in renderer: drawn over the finished picture.

#ifndef CAG_INTERP_RENDER_PREVIEW_LABELS_H
#define CAG_INTERP_RENDER_PREVIEW_LABELS_H

#include "geom/camera/camera.h"
#include "interp/render/image.h"
#include "interp/scene/scene.h"

// Draws the labels of the scene over a part of the camera's picture, whose upper left pixel is (x,
// y), with smooth edges. The first three channels of the part are colors in linear light.
CagStatus cag_preview_labels(const CagScene *scene, const CagCamera *camera,
                             const CagCameraMap *map, int x, int y, CagImage *part, CagError *err);

#endif
