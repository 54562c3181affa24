// Hidden lines: the drawing of shapes as they are seen along a direction.

#ifndef CAG_GEOM_VIEW_HIDDEN_H
#define CAG_GEOM_VIEW_HIDDEN_H

#include "geom/meet/section.h"
#include "geom/view/view_lines.h"

// The lines of bodies (view_lines.h) in the plane z = 0 of a frame, seen from far away on the
// positive side of its z axis. They are plane curves in the x and y of the frame.
//
//   frame    orthonormal
//   visible  what no body covers: of several lines that coincide in the drawing, one
//   hidden   the other lines, as far as they do not coincide with visible ones
//
// Both lists must be empty. Lines project to lines, circles to arcs of circles and ellipses or to
// segments, and NURBS curves to NURBS curves; what projects to a point is left out. A line is divided
// where it crosses others in the drawing, where it passes through other bodies, and where it turns
// back. Between these places, rays to the eye decide whether it is visible (Appel 1967). They start
// beside the line, at 1e-6 of the size of all bodies, so details smaller than that may be wrong.
CagStatus cag_hidden_lines(const CagViewBody *bodies, size_t n, const CagTransform *frame,
                           CagCurveList *visible, CagCurveList *hidden, CagError *err);

#endif
