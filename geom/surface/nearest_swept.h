// Lower bounds of the distances of cells of tubes, sweeps, and extrusions, from intervals of their
// derivatives.

#ifndef CAG_GEOM_SURFACE_NEAREST_SWEPT_H
#define CAG_GEOM_SURFACE_NEAREST_SWEPT_H

#include "geom/basis/interval.h"
#include "geom/surface/nearest_cells.h"

// Whether the derivatives of the surface can be bounded: true for a tube or sweep whose path and
// section are not known only by points, possibly placed by an affine map. Fills c->swept. `region`:
// cells must be bounded in both directions.
CagStatus cag_swept_cells_begin(CagDistanceCells *c, bool region, bool *known, CagError *err);
// Adds cells for the whole surface, known only by their boxes.
CagStatus cag_swept_cells_push(CagDistanceCells *c, CagError *err);
// Computes the bound and the other data of a cell.
CagStatus cag_swept_cell_bound(CagDistanceCells *c, CagDistanceCell *cell, CagError *err);

#endif
