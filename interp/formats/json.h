// The scene as data, in JSON.
//
// The file is one object. Numbers are in the shortest form that reads back the same. Lengths are in
// millimeters, angles in radians, colors are linear [r, g, b], and transforms are four rows of four
// for column vectors. Infinite or missing values are null.
//
//   format "cag-scene", version 1, generator, script, units "mm", up "z"
//   bounds      {min, max} of everything but grounds, or null
//   tolerance   mm, 0: by the size of each item
//   materials   [{name, color, metallic, roughness, ior, transmission, emission, coat, texture,
//   color2,
//               texture_scale, pov}]; pov: text or null
//   items       [{name, kind, material (index), tolerance, ...}], by kind further:
//     "curve"   line_radius, dash, curve: CURVE
//     "region"  placement, region: REGION
//     "surface" surface: SURFACE; of a closed one the normals point outward
//     "solid"   solid: SOLID
//     "mesh"    mesh: MESH; likewise
//     "ground"  z, size (null: infinite)
//   cameras     [{name, projection "perspective" | "orthographic", eye, target, up, fov | width,
//   size,
//               focus, aperture, frame (camera to world: x right, y down, z view)}], of a pinhole
//               also focal, shift [right, down] (from the view axis to the middle of the picture, in
//               widths of it), skew and stretch (K[0][1]/K[0][0] and K[1][1]/K[0][0] - 1 of its
//               matrix)
//   lights      [{kind "sun" | "point" | "spot" | "area", position, direction, angle, size, color,
//               strength}], each with what its kind has
//   sky         {colors} or {image} or null;  background  color or null
//   studio, automatic_camera   true where the program added light or camera
//
//   CURVE   {type, dimension, domain [a, b], angular, closed, ...}: of lines and polylines
//   `points`; of arcs
//           `a`, `b`, `frame` (frame * [a cos t, b sin t, 0]); of helices `radius`, `pitch`,
//           `turns`, `taper`, `frame`; of NURBS kinds `degree`, `knots`, `points`, `weights` (null:
//           polynomial), `periodic`; of others `nurbs`: CURVE where there is an exact form, else
//           `samples`: {parameters, points}
//   REGION  {loops: [CURVE], outer: [index of the loop around each, or its own]}
//   SURFACE {type, u [a, b], v [a, b], closed [u, v], ...}: of NURBS kinds `degree` [u, v], `knots`
//   [u, v],
//           `points` (rows of u), `weights`, `periodic` [u, v]; of revolutions `profile`: CURVE,
//           `axis`, `through`, `angle` [from, to]; of quadrics `equation` [a b c d e f g h j k], a
//           x^2 + b y^2 + c z^2 + d xy + e yz + f xz + g x + h y + j z + k = 0; of flat ones
//           `region`, `frame`; of others `nurbs`: SURFACE where there is an exact form, else
//           `mesh`: MESH
//   SOLID   {type "box" | "sphere" | "cylinder" | "torus" | "extrusion" | "revolution" | "tube" |
//   "shell",
//           placement, ...}: `size`, `centered`; `radius`; `height`, `radius`, `top`; `major`,
//           `minor`; of the last four `faces`: [SURFACE], normals outward
//   MESH    {vertices: [[x, y, z]], normals: [[x, y, z]] or null, triangles: [[i, j, k]]}

#ifndef CAG_INTERP_FORMATS_JSON_H
#define CAG_INTERP_FORMATS_JSON_H

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

// Writes the scene to an open file. Write errors remain in the file until its commit.
CagStatus cag_export_json(const CagScene *scene, CagAtomicFile *file, CagError *err);

#endif
