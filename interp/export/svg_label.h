// Texts and marks of an SVG picture.

#ifndef CAG_INTERP_EXPORT_SVG_LABEL_H
#define CAG_INTERP_EXPORT_SVG_LABEL_H

#include <stdio.h>

#include "interp/scene/scene.h"

// Writes a label whose place and direction (zero: none) in the picture, y up, are given, and adds
// what it covers to the box. `color`: as "#rrggbb". `unit`: the picture's diagonal.
//
// A text without a size is a fortieth of the diagonal high. A mark is a third of the size of the
// text it would have. The widths of letters are estimated, since fonts differ. False: a number in
// it is not finite.
bool cag_svg_label(FILE *out, const CagLabel *label, CagVec3 at, CagVec3 along, const char *color,
                   double unit, CagBounds *box);
// Text of an element: with & < > " and control characters replaced.
void cag_svg_escape(FILE *out, const char *text, size_t n);

#endif
