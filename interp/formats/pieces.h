// A curve taken apart into cubic Bezier pieces, as lathes, prisms and flat pictures want it.

#ifndef CAG_INTERP_FORMATS_PIECES_H
#define CAG_INTERP_FORMATS_PIECES_H

#include "geom/curve/curve.h"

typedef struct CagPieces {
  CagVec3 *points; // four a piece; from malloc, to be freed by the owner
  size_t count, capacity;
  bool linear; // every piece is straight and evenly run
} CagPieces;

// The curve's pieces in order: exact, for polynomials of degree up to 3. False: it is another curve
// (rational, of higher degree, without such a form), or memory is out; nothing to free then.
bool cag_pieces_of_curve(const CagCurve *c, CagPieces *out);

// Adds one piece of four points, or all of another list. False: memory is out.
bool cag_pieces_add(CagPieces *p, const CagVec3 cubic[4]);
bool cag_pieces_append(CagPieces *p, const CagPieces *more);

#endif
