// The tolerances that most of the core shares.
//
// They are fractions of the size of the data, or sines of angles, so results do not depend on
// units. A double has a relative error of 1e-16. Three levels follow from it:
//
// - CAG_ROUNDING is the rounding error of some thousand operations, with a margin of 10. Values
//   below it count as 0.
// - CAG_COINCIDENT is the distance below which points, lengths, or parameters count as equal if
//   they were computed in different ways, or written to a file or script with at least ten digits.
// - CAG_PARALLEL is the sine of the angle below which such directions count as parallel, and
//   rotations as 0.
//
// A file that needs another tolerance defines it, and states why it differs.

#ifndef CAG_GEOM_TOLERANCE_H
#define CAG_GEOM_TOLERANCE_H

#define CAG_ROUNDING 1e-12
#define CAG_COINCIDENT 1e-9
#define CAG_PARALLEL 1e-9

#endif
