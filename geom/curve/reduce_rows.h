// Knot removal and degree reduction of B-splines whose coefficients are rows of homogeneous points:
// single points of a curve, or the rows of a surface's net.

#ifndef CAG_GEOM_CURVE_REDUCE_ROWS_H
#define CAG_GEOM_CURVE_REDUCE_ROWS_H

#include "base/status.h"

typedef struct CagRows {
  int degree;
  size_t count, across; // rows, and points in each
  bool rational;        // otherwise all weights are 1
  double *h;            // count x across x 4
  double *knots;        // count + degree + 1
} CagRows;

CagStatus cag_rows_new(int degree, size_t count, size_t across, bool rational, CagRows *out,
                       CagError *err); // contents unset
void cag_rows_free(CagRows *rows);

// Removes the knot t `times` times. *moved bounds the distance of new and old points at equal
// parameters; if it exceeds the tolerance, fails with "tolerance-exceeded". Fails with
// "no-such-knot".
CagStatus cag_rows_remove(CagRows *rows, double t, int times, double tolerance, double *moved,
                          CagError *err);

// A B-spline by its Bezier pieces, one for each non-empty knot interval.
typedef struct CagRowPieces {
  int degree;
  size_t pieces, across;
  bool rational;
  const double *h;         // (pieces x degree + 1) x across x 4: the pieces share their ends
  const double *cuts;      // pieces + 1
  const int *multiplicity; // of each cut; those of the ends are not used
} CagRowPieces;

// Lowers the degree by one, keeping both ends and, within the tolerance, the smoothness at the
// knots. In each piece, the new points, elevated again, are the least-squares approximation of the
// old ones. *moved and failures are as for cag_rows_remove. Fails with "order-range" at degree 1.
CagStatus cag_rows_reduce(const CagRowPieces *in, double tolerance, CagRows *out, double *moved,
                          CagError *err);

#endif
