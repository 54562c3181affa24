// Plane outlines for POV-Ray's lathes and prisms: cubic Bezier pieces.

#ifndef CAG_INTERP_FORMATS_POV_OUTLINE_H
#define CAG_INTERP_FORMATS_POV_OUTLINE_H

#include "interp/formats/pieces.h"
#include "interp/formats/pov_write.h"

typedef struct CagPovOutline {
  CagPieces all;
  bool linear; // all pieces are straight and consecutive
} CagPovOutline;
#define CAG_POV_OUTLINE_EMPTY ((CagPovOutline){.linear = true})

// Appends a curve: exactly if it is a polynomial of degree up to 3, else within a fraction of its
// size that is invisible in pictures. Returns false if it cannot be evaluated or memory ran out.
bool cag_pov_outline_add(CagPovOutline *o, const CagCurve *c);
bool cag_pov_outline_append(CagPovOutline *o, const CagPovOutline *part);
// Sets coordinates that are 0 up to rounding to 0.
void cag_pov_outline_tidy(CagPovOutline *o);
// Writes "  linear_spline" or "  bezier_spline", `between`, and the points.
void cag_pov_outline_write(CagPovWriter *w, const CagPovOutline *o, const char *between);
void cag_pov_outline_free(CagPovOutline *o);

#endif
