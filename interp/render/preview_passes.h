// What a picture shows beside its colors: depths, normals, parts, materials, parameters, curvature.

#ifndef CAG_INTERP_RENDER_PREVIEW_PASSES_H
#define CAG_INTERP_RENDER_PREVIEW_PASSES_H

#include "interp/render/exr.h"
#include "interp/render/preview.h"

// X(NAME, text, channels)
#define CAG_PREVIEW_PASSES(X)                                                                      \
  X(COLOR, "color", "the picture: R, G, B")                                                        \
  X(DEPTH, "depth", "depth.Z, in mm along the view direction")                                     \
  X(NORMAL, "normal", "normal.X, normal.Y, normal.Z, of the world")                                \
  X(OBJECT, "object", "which parts are seen, by name, as Cryptomatte")                             \
  X(MATERIAL, "material", "which materials are seen, as Cryptomatte")                              \
  X(UV, "uv", "uv.U, uv.V, the parameters of the surface")                                         \
  X(CURVATURE, "curvature", "curvature.mean and curvature.gaussian, in 1/mm and 1/mm2")
typedef enum CagPreviewPass {
#define X(name, text, channels) CAG_PASS_##name,
  CAG_PREVIEW_PASSES(X)
#undef X
      CAG_PASS_COUNT
} CagPreviewPass;
extern const char *const cag_preview_pass_names[]; // ends with NULL

// Reads "color,depth". Returns false for an unknown pass; *wrong is its name.
bool cag_preview_read_passes(const char *text, bool out[CAG_PASS_COUNT], char wrong[32]);

// Renders the passes except color. Values that change along edges, such as depths, are those of the
// middle of a pixel, and NaN where nothing is seen; parts and materials are counted by samples.
// Adds what describes the parts to the metadata.
CagStatus cag_preview_passes(const CagScene *scene, const CagCamera *camera,
                             const CagPreviewOptions *options, const bool passes[CAG_PASS_COUNT],
                             CagImage *out, CagExrMetadata *metadata, CagError *err);

#endif
