// Lower bounds of the distances of cells of tubes, sweeps and extrusions, by ranges of their
// derivatives.

#ifndef CAG_GEOM_SURFACE_NEAREST_SWEPT_H
#define CAG_GEOM_SURFACE_NEAREST_SWEPT_H

#include "geom/basis/interval.h"
#include "geom/surface/nearest_cells.h"

// Whether the derivatives of the surface can be bounded: a tube or a sweep whose path and section
// are not known by points only, also seen through an affine map. Fills c->swept. `region`: cells
// must be bounded in both directions.
CagStatus cag_swept_cells_begin(CagDistanceCells *c, bool region, bool *known, CagError *err);
// Adds all of the surface, known by boxes alone.
CagStatus cag_swept_cells_push(CagDistanceCells *c, CagError *err);
// Sets what is known of a cell.
CagStatus cag_swept_cell_bound(CagDistanceCells *c, CagDistanceCell *cell, CagError *err);

#endif
