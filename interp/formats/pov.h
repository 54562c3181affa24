// The scene as POV-Ray 3.7 source: for that renderer, and for people who go on by hand.
//
// What the shape has a name for in POV-Ray keeps it (sphere, box, cylinder, cone, torus, quadric,
// lathe, prism, bicubic_patch, polygon); everything else is a mesh2 with the exact surface's
// normals, turned a little along the outline that the camera sees (pov_facing.c). Set operations
// are the renderer's own only where operands have no faces in common, which it could not tell apart
// (CagPovCsg). Each thing is a #declare under its own name, each material one under M_name.
//
// Space: numbers are those of the script (millimeters, Z up). POV-Ray's left-handedness is a matter
// of its default camera only: the camera here gives its own right, up and direction, from
// cag_camera_frame, so that pictures are never mirrored. Turned things carry a `matrix`.
//
// Light: `assumed_gamma 1`; all colors are linear. A white matte face perpendicular to a light of
// strength 1 is 1.0 (white). No light fades with distance, so a strength says the same thing
// everywhere. A sun stands very far away and casts slightly soft shadows; an area light casts those
// of its size. Without radiosity (draft and normal quality) the sky's mean color, or where there
// is none a dim white, stands in for the light that comes from everywhere.

#ifndef CAG_INTERP_FORMATS_POV_H
#define CAG_INTERP_FORMATS_POV_H

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

typedef enum CagPovQuality {
  CAG_POV_DRAFT,  // hard shadows, one ray per pixel, coarse bicubic patches
  CAG_POV_NORMAL, // soft shadows
  CAG_POV_FINAL   // and light from everywhere (radiosity), finer everything
} CagPovQuality;

// What set operations of solids become.
typedef enum CagPovCsg {
  CAG_POV_CSG_GENERAL, // the renderer's own where operands are in general position, else meshes
  CAG_POV_CSG_NATIVE,  // the renderer's own
  CAG_POV_CSG_MESH
} CagPovCsg;

typedef struct CagPovOptions {
  CagPovQuality quality;
  int samples;      // lens samples per pixel; 0: by the quality (draft 1, normal 4, final 80)
  size_t camera;    // index into the scene's cameras
  int size[2];      // pixels; 0: those of the camera. Only their ratio is written
  bool meshes_only; // no native objects: to compare, or for a reader that knows meshes only
  CagPovCsg csg;
} CagPovOptions;

#define CAG_POV_OPTIONS_DEFAULT                                                                    \
  ((CagPovOptions){.quality = CAG_POV_NORMAL, .csg = CAG_POV_CSG_GENERAL})

// Writes the scene, which cag_scene_complete has gone over, to an open file. Geometry that cannot
// be meshed is an error; errors of writing stay in the file until its commit.
CagStatus cag_export_pov(const CagScene *scene, const CagPovOptions *options, CagAtomicFile *file,
                         CagError *err);

#endif
