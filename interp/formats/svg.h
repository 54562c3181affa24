// The curves, regions, and labels of a scene as an SVG drawing.
//
// If all of them lie in one plane z = constant, they are drawn from above at their true size in
// millimeters, y up. Otherwise they are drawn as the camera sees them; for a perspective camera, a
// millimeter keeps its size at the distance of its target. The picture is cropped to its contents
// with a margin of 5%.
//
// Polynomial curves of degree up to 3 become exact cubic paths, and arcs of circles and ellipses
// exact elliptic arcs. All others are approximated by cubics within a 20,000th of the picture's
// size. Regions are filled, except for their holes. Stroke and fill have the color of the material,
// and the stroke width is twice the radius of the line. A region is as transparent as the
// transmission of its material. Labels are on top. Other shapes have no outline and are omitted.

#ifndef CAG_INTERP_FORMATS_SVG_H
#define CAG_INTERP_FORMATS_SVG_H

#include <stdio.h>

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

// Writes the picture to an open file. `camera` is an index into the scene's cameras. A scene
// without curves, regions, and labels is an error ("svg-without-curves").
CagStatus cag_export_svg(const CagScene *scene, size_t camera, CagAtomicFile *file, CagError *err);

// Writes the boundary of a region as the data of a path, with y down. Numbers are rounded to a power
// of ten below a thousandth of `size`.
CagStatus cag_svg_path(const CagRegion *r, double size, FILE *out, CagError *err);

#endif
