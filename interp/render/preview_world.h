// A scene as the built-in renderer sees it: shapes that rays meet, materials, and lights.

#ifndef CAG_INTERP_RENDER_PREVIEW_WORLD_H
#define CAG_INTERP_RENDER_PREVIEW_WORLD_H

#include "geom/ray/bvh.h"
#include "geom/ray/caster.h"
#include "geom/ray/ray_mesh.h"
#include "geom/ray/ray_rods.h"
#include "interp/render/preview_pattern.h"
#include "interp/render/preview_sky.h"
#include "interp/scene/scene.h"

// How a material reflects light, as in interp/formats/pov_material.c.
typedef struct CagPreviewSurface {
  CagColor color, emission;
  double diffuse;
  double highlight, exponent; // of the surface, and its power of N.H, normalized
  double coat;                // highlight of the clear coat, normalized
  double mirror;              // the largest part that is reflected like a mirror
  double passed;              // the part of the light that passes, in the material's color
  double ior;
  bool metal; // reflections have its color
  const CagMaterial *material;
  const CagPreviewPattern *pattern; // NULL: none
} CagPreviewSurface;

typedef struct CagPreviewPart {
  size_t item; // of the scene
  // One of these is not NULL.
  CagCaster *caster; // exact surfaces
  CagRayRods *rods;  // a curve
  CagRayMesh *mesh;
  bool closed; // transparent parts refract
  CagBounds bounds;
  // Patterns move with primitive solids, as in POV-Ray's source: from the world to the pattern, a
  // rigid motion.
  bool moved;
  CagTransform to_pattern;
} CagPreviewPart;

// A light, prepared.
typedef struct CagPreviewLamp {
  const CagLight *light;
  CagColor color;       // with its strength
  CagVec3 direction;    // of the light, unit
  CagVec3 across, over; // perpendicular to it, of the length of the source
  CagVec3 to_sun;       // SUN: from any point to its middle
  bool wide;            // the source is not a point
  double inner, outer;  // SPOT: cosines of the cone with full light, and of all of it
} CagPreviewLamp;

typedef struct CagPreviewWorld {
  const CagScene *scene;
  CagPreviewPart *parts;
  size_t count;
  CagBvh boxes;
  CagPreviewSurface *surfaces; // by index of the material
  double *planes;              // heights of the unbounded grounds
  size_t *plane_items;
  size_t plane_count;
  CagPreviewLamp *lamps; // of the lights of the scene that shine
  size_t lamp_count;
  bool transparent; // some material passes light
  double radius;    // of the scene
  CagVec3 center;
  CagColor ambient; // light from everywhere, in a sketch
  CagPreviewSky sky;
} CagPreviewWorld;

// What a ray meets.
typedef struct CagPreviewHit {
  double t;
  CagVec3 point, normal; // the normal is that of shading; unit, towards the outside
  CagVec3 flat;          // the normal of the surface that the ray meets
  double u, v;
  size_t item, material;
  bool leaves; // the ray goes out of the part
  bool closed;
  double scale_value;             // of a mesh with a color scale
  const CagColorScale *scale;     // NULL: none
  const CagMesh *mesh;            // NULL: an exact surface
  uint32_t face;                  // the triangle of the mesh, or the face of CagCrossing
  const CagTransform *to_pattern; // NULL: patterns are in world coordinates
  const CagPreviewPart *part;     // NULL: an unbounded ground
  const CagCaster *operand;       // of an exact part, and whether the normal is opposite to its own
  bool flipped;
} CagPreviewHit;

CagStatus cag_preview_world(const CagScene *scene, CagPreviewWorld *out, CagError *err);
void cag_preview_world_free(CagPreviewWorld *w);
// Finds the first part that the ray meets. *met is false if there is none.
CagStatus cag_preview_meet(const CagPreviewWorld *w, const CagRay *ray, CagCrossings *work,
                           CagPreviewHit *out, bool *met, CagError *err);
// The light that passes along a ray, by color: 1 if nothing is in its way, 0 behind opaque parts.
CagStatus cag_preview_passage(const CagPreviewWorld *w, const CagRay *ray, CagCrossings *work,
                              CagColor *out, CagError *err);
// The color of the surface at a hit: of the material's pattern or the mesh's scale.
CagColor cag_preview_color(const CagPreviewWorld *w, const CagPreviewHit *hit);
// The normal of shading at a hit, with the bumps of the material.
CagVec3 cag_preview_normal(const CagPreviewWorld *w, const CagPreviewHit *hit);

#endif
