// The scene as POV-Ray 3.7 source, for rendering and for editing by hand.
//
// Shapes that POV-Ray supports are written natively (sphere, box, cylinder, cone, torus, quadric,
// lathe, prism, bicubic_patch, polygon). All others become a mesh2 with the normals of the exact
// surface, turned slightly along the silhouette (pov_facing.c). Set operations are written natively
// only if their operands have no coincident faces, which POV-Ray cannot handle (CagPovCsg). Each
// item is a #declare with its name, and each material one with the name M_name.
//
// Space: numbers are those of the script (millimeters, Z up). In POV-Ray, left-handedness is only a
// property of the default camera. The camera here has explicit right, up, and direction vectors,
// from cag_camera_frame, so that pictures are never mirrored. Rotated items have a `matrix`.
//
// Light: `assumed_gamma 1`; all colors are linear. A white matte face perpendicular to a light of
// strength 1 has the value 1.0 (white). Lights do not fade with distance, so a strength has the
// same effect everywhere. A sun is very far away and casts slightly soft shadows; the shadows of an
// area light depend on its size. Without radiosity (draft and normal quality), indirect light is
// approximated by the sky's mean color, or by a dim white if there is no sky.

#ifndef CAG_INTERP_FORMATS_POV_H
#define CAG_INTERP_FORMATS_POV_H

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

typedef enum CagPovQuality {
  CAG_POV_DRAFT,  // hard shadows, one ray per pixel, coarse bicubic patches
  CAG_POV_NORMAL, // soft shadows
  CAG_POV_FINAL   // with indirect light (radiosity), and finer everywhere
} CagPovQuality;

// How set operations of solids are written.
typedef enum CagPovCsg {
  CAG_POV_CSG_GENERAL, // natively if operands are in general position, else as meshes
  CAG_POV_CSG_NATIVE,  // natively
  CAG_POV_CSG_MESH
} CagPovCsg;

typedef struct CagPovOptions {
  CagPovQuality quality;
  int samples;      // lens samples per pixel; 0: depends on the quality (draft 1, normal 4, final
                    // 80)
  size_t camera;    // index into the scene's cameras
  int size[2];      // pixels; 0: as in the camera. Only the ratio is written
  bool meshes_only; // no native objects, for comparisons and readers that support only meshes
  CagPovCsg csg;
} CagPovOptions;

#define CAG_POV_OPTIONS_DEFAULT                                                                    \
  ((CagPovOptions){.quality = CAG_POV_NORMAL, .csg = CAG_POV_CSG_GENERAL})

// Writes the scene, which cag_scene_complete must have processed, to an open file. Geometry that
// cannot be meshed is an error. Write errors remain in the file until its commit.
CagStatus cag_export_pov(const CagScene *scene, const CagPovOptions *options, CagAtomicFile *file,
                         CagError *err);

#endif
