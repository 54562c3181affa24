// Plane outlines as POV-Ray's lathes and prisms take them: cubic Bezier pieces.

#ifndef CAG_INTERP_FORMATS_POV_OUTLINE_H
#define CAG_INTERP_FORMATS_POV_OUTLINE_H

#include "interp/formats/pieces.h"
#include "interp/formats/pov_write.h"

typedef struct CagPovOutline {
  CagPieces all;
  bool linear; // every piece is straight, and they follow one another
} CagPovOutline;
#define CAG_POV_OUTLINE_EMPTY ((CagPovOutline){.linear = true})

// Adds a curve behind what is there: exactly where it is a polynomial of degree up to 3, else
// within a part of its size that no picture shows. False: it cannot be evaluated, or memory is out.
bool cag_pov_outline_add(CagPovOutline *o, const CagCurve *c);
bool cag_pov_outline_append(CagPovOutline *o, const CagPovOutline *part);
// Coordinates that are rounding of 0 become 0.
void cag_pov_outline_tidy(CagPovOutline *o);
// "  linear_spline" or "  bezier_spline", `between`, the points.
void cag_pov_outline_write(CagPovWriter *w, const CagPovOutline *o, const char *between);
void cag_pov_outline_free(CagPovOutline *o);

#endif
