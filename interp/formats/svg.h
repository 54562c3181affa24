// The curves, regions and labels of a scene as a flat picture in SVG.
//
// Where all of them lie in one plane z = constant they are seen from above, at their true size in
// millimeters, y up. Otherwise they are seen by the camera; of a perspective one, a millimeter is
// one at the distance of its target. The picture is cut to what is drawn, with a margin of 5%.
//
// Curves that are polynomials of degree up to 3 become exact cubic paths, arcs of circles and
// ellipses exact elliptic arcs; everything else is drawn by cubics that stay within a 20,000th of
// the picture's size. Regions are filled, their holes left out. Stroke and fill are the material's
// color, the stroke twice the line's radius wide; the transmission of a region's material is how
// much of what lies below shows through. Labels stand over everything. Other shapes have no outline
// and are left out.

#ifndef CAG_INTERP_FORMATS_SVG_H
#define CAG_INTERP_FORMATS_SVG_H

#include "base/atomic_file.h"
#include "interp/scene/scene.h"

// Writes the picture to an open file. `camera`: index into the scene's cameras. A scene without
// curves, regions and labels is an error ("svg-without-curves").
CagStatus cag_export_svg(const CagScene *scene, size_t camera, CagAtomicFile *file, CagError *err);

#endif
