// Conversion of curves to cubic Bezier pieces, for lathes, prisms, and flat pictures.

#ifndef CAG_INTERP_FORMATS_PIECES_H
#define CAG_INTERP_FORMATS_PIECES_H

#include "geom/curve/curve.h"

typedef struct CagPieces {
  CagVec3 *points; // four per piece; allocated with malloc, freed by the owner
  size_t count, capacity;
  bool linear; // every piece is straight and has constant speed
} CagPieces;

// Returns the pieces of a polynomial curve of degree up to 3, in order, exactly. Returns false if
// the curve is of another kind or memory ran out; there is then nothing to free.
bool cag_pieces_of_curve(const CagCurve *c, CagPieces *out);

// Adds one piece of four points, or all of another list. Returns false if memory ran out.
bool cag_pieces_add(CagPieces *p, const CagVec3 cubic[4]);
bool cag_pieces_append(CagPieces *p, const CagPieces *more);

#endif
