// Texts and marks of an SVG drawing.

#ifndef CAG_INTERP_FORMATS_SVG_LABEL_H
#define CAG_INTERP_FORMATS_SVG_LABEL_H

#include <stdio.h>

#include "interp/scene/scene.h"

// Writes a label at a location and along a direction (zero: none) in the picture, with y up, and
// extends the box by its area. `color` has the form "#rrggbb". `unit` is the picture's diagonal.
//
// The default height of a text is a fortieth of the diagonal. A mark has a third of the size that
// its text would have. The widths of letters are estimated because fonts differ. Returns false if a
// number in the label is not finite.
bool cag_svg_label(FILE *out, const CagLabel *label, CagVec3 at, CagVec3 along, const char *color,
                   double unit, CagBounds *box);
// Writes text, escaping & < > " and control characters.
void cag_svg_escape(FILE *out, const char *text, size_t n);

#endif
