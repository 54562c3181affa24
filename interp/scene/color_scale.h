// Colors of values, with which exporters color a mesh that has a scale.

#ifndef CAG_INTERP_SCENE_COLOR_SCALE_H
#define CAG_INTERP_SCENE_COLOR_SCALE_H

#include "interp/scene/scene.h"

// Returns the color of a value. NaN is gray.
CagColor cag_color_scale_at(const CagColorScale *scale, double value);

// Converts a scale to stops at 0..1 (`from` to `to`) with colors, linear light between them. Two
// stops at the same value form an edge.
#define CAG_SCALE_STOPS_MAX 160
#define CAG_SCALE_STRIPES_MAX ((CAG_SCALE_STOPS_MAX) / 4)
typedef struct CagColorStop {
  double at;
  CagColor color;
} CagColorStop;
size_t cag_color_scale_stops(const CagColorScale *scale, CagColorStop out[CAG_SCALE_STOPS_MAX]);

#endif
