// The tolerances that most of the core shares.
//
// They are fractions of the size of the data, or sines of angles, so results do not depend on
// units. A double has a relative error of 1e-16. Three levels follow from it:
//
// - CAG_ROUNDING is the rounding error of some thousand operations, with a margin of 10. Values
//   that should be 0 and are below it are 0.
// - CAG_COINCIDENT is where two points, lengths, or parameters count as one that were computed in
//   different ways, or written in a file or a script with ten digits or more.
// - CAG_PARALLEL is the sine of the angle below which directions that were found in such ways count
//   as parallel, and a turn as none.
//
// A file that needs another tolerance defines it, and says why it differs.

#ifndef CAG_GEOM_TOLERANCE_H
#define CAG_GEOM_TOLERANCE_H

#define CAG_ROUNDING 1e-12
#define CAG_COINCIDENT 1e-9
#define CAG_PARALLEL 1e-9

#endif
