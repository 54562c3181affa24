// Lines in the plane of a drawing, and where they are divided.

#ifndef CAG_GEOM_VIEW_DRAWN_H
#define CAG_GEOM_VIEW_DRAWN_H

#include "geom/view/view_lines.h"

// Lines that are closer to each other in the drawing than this fraction of the size coincide.
#define CAG_DRAWN_NEAR 1e-6

// A line of a body in the plane of the drawing. If it is straight, `flat` is the line between the
// images of two parameters of the curve in space, `from` < `to`, between which the image does not turn
// back; `to` may be beyond the end of a closed curve. Else `flat` has the parameter of that curve.
typedef struct CagDrawnLine {
  const CagViewLine *line;
  CagCurve *flat;
  bool straight;
  double from, to;
  CagVec3 start, end; // of `flat`
  CagBounds box;      // of `flat`
  double *cuts;       // parameters of `flat`, ascending; the first and the last are its ends
  size_t cut_count, cut_room;
} CagDrawnLine;

typedef struct CagDrawing {
  const CagViewLines *lines;
  const CagViewBody *bodies;
  CagTransform frame;
  double size;
  CagDrawnLine *items;
  size_t count, capacity;
  size_t *order; // of the items: by box.min.x
  double widest; // of their boxes
} CagDrawing;

// Projects all lines, and finds where they are divided.
CagStatus cag_drawing_of(const CagViewLines *lines, const CagViewBody *bodies,
                         const CagTransform *frame, CagDrawing *out, CagError *err);
void cag_drawing_free(CagDrawing *d);
// The parameter of the line's curve in space at a parameter of its flat one.
CagStatus cag_drawn_parameter(const CagDrawing *d, const CagDrawnLine *l, double s, double *t,
                              CagError *err);
// The point of the flat curve nearest to p.
CagStatus cag_drawn_nearest(const CagDrawnLine *l, CagVec3 p, double *s, double *distance,
                            CagError *err);
// The first position in `order` of an item that may reach x; those that begin after the end of a box
// are not near it.
size_t cag_drawing_from(const CagDrawing *d, double x);

#endif
